//! Scenes of rectangular plates, and tables to hold their results against.

use crate::support::root;
use fem::analyses::modes;
use fem::analyses::statics::{self, StaticSolution};
use fem::core::profile::ProfilePoint;
use fem::io::scene;
use fem::{Model, Registry};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use tempfile::TempDir;

/// Pagano's material; his E₂ is 1 MPa here.
pub(super) const PAGANO: &str = "e1 = '25 MPa'\ne2 = '1 MPa'\ne3 = '1 MPa'\nnu12 = 0.25\nnu13 = 0.25\nnu23 = 0.25\n\
     g12 = '0.5 MPa'\ng13 = '0.5 MPa'\ng23 = '0.2 MPa'\ndensity = '1e9 g/cm^3'\n";

/// AS4/3502 of AFWAL-TR-87-4117.
pub(super) const AS4: &str = "e1 = '130.3 GPa'\ne2 = '9.65 GPa'\ne3 = '9.65 GPa'\nnu12 = 0.35\nnu13 = 0.35\nnu23 = 0.4\n\
     g12 = '5.93 GPa'\ng13 = '5.93 GPa'\ng23 = '3.446428571428571 GPa'\ndensity = '1.58 g/cm^3'\n";

/// Constants of an isotropic material.
pub(super) fn isotropic(gpa: f64, nu: f64, density: f64) -> String {
    let g = 0.5 * gpa / (1.0 + nu);
    let axis = |i| format!("e{i} = '{gpa} GPa'\n");
    let plane = |ij| format!("nu{ij} = {nu}\ng{ij} = '{g} GPa'\n");
    format!("{}{}density = '{density} g/cm^3'\n", [1, 2, 3].map(axis).concat(), [12, 13, 23].map(plane).concat())
}

/// How a side is held, over its whole face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Side {
    Free,
    /// Displacements are zero, with their derivatives along the side and along z.
    Clamped,
    /// Deflection and displacement along the side are zero, with their derivatives along it and along z: a simple
    /// support, and a plane of antisymmetry.
    Supported,
    /// A plane of symmetry.
    Symmetric,
}
use Side::{Supported, Symmetric};

/// A quarter of a simply supported plate.
pub(super) const QUARTER: [Side; 4] = [Supported, Symmetric, Supported, Symmetric];

/// A rectangular plate with the groups x-min, x-max, y-min, y-max, plate.
#[derive(Debug, Clone)]
pub(super) struct Plate {
    pub(super) material: String,
    /// In the notation of scenes.
    pub(super) plies: String,
    pub(super) ply_mm: f64,
    /// Plies per layer of cells.
    pub(super) layers: Vec<usize>,
    /// The scene's table `mesh`.
    pub(super) mesh: String,
    /// Keys of the scene's `element`.
    pub(super) element: String,
    /// x-min, x-max, y-min, y-max.
    pub(super) sides: [Side; 4],
    /// Loads, profiles and other tables.
    pub(super) more: String,
}

impl Plate {
    pub(super) fn new(material: &str, plies: &str, ply_mm: f64, layers: Vec<usize>) -> Self {
        Self {
            material: material.into(),
            plies: plies.into(),
            ply_mm,
            layers,
            mesh: String::new(),
            element: "z_derivatives = 'layer-wise'".into(),
            sides: QUARTER,
            more: String::new(),
        }
    }

    /// The same of equal cells, mm.
    pub(super) fn rectangle(mut self, [x, y]: [f64; 2], [nx, ny]: [usize; 2]) -> Self {
        self.mesh = format!("{{ rectangle = ['{x} mm', '{y} mm'], cells = [{nx}, {ny}] }}");
        self
    }

    /// The same on a mesh of [`gmsh_grid`].
    pub(super) fn on(mut self, file: &MeshFile) -> Self {
        self.mesh = format!("{{ file = '{}', unit = 'mm' }}", file.0.path().join("plate.msh").display());
        self
    }

    pub(super) fn sides(mut self, sides: [Side; 4]) -> Self {
        self.sides = sides;
        self
    }

    pub(super) fn element(mut self, keys: &str) -> Self {
        self.element = keys.into();
        self
    }

    /// The same under a pressure on the top face, a formula in MPa and mm.
    pub(super) fn pressure(self, formula: &str) -> Self {
        self.load(&format!("pressure = {{ formula = '{formula}', unit = 'MPa', length = 'mm' }}"))
    }

    pub(super) fn load(mut self, keys: &str) -> Self {
        let _ = writeln!(self.more, "[[load]]\n{keys}");
        self
    }

    /// The same with a profile at a point, mm.
    pub(super) fn profile(mut self, [x, y]: [f64; 2], points: usize) -> Self {
        let name = self.more.matches("[[profile]]").count();
        let _ = writeln!(
            self.more,
            "[[profile]]\nname = '{name}'\nat = {{ x = '{x} mm', y = '{y} mm' }}\npoints = {points}\nequilibrium = true"
        );
        self
    }

    /// The same with a profile at a point, mm, of what the element itself says.
    pub(super) fn probe(mut self, [x, y]: [f64; 2]) -> Self {
        let name = self.more.matches("[[profile]]").count();
        let _ = writeln!(self.more, "[[profile]]\nname = '{name}'\nat = {{ x = '{x} mm', y = '{y} mm' }}\npoints = 2");
        self
    }

    /// The same with more of the scene's text.
    pub(super) fn with(mut self, text: &str) -> Self {
        let _ = writeln!(self.more, "{text}");
        self
    }

    /// The scene.
    pub(super) fn text(&self, analysis: &str) -> String {
        let mut text = format!(
            "title = 'plate'\nanalysis = '{analysis}'\nmesh = {}\nelement = {{ {} }}\n",
            self.mesh, self.element
        );
        let mut supports = String::new();
        for (side, group) in self.sides.iter().zip(["x-min", "x-max", "y-min", "y-max"]) {
            let (across, along) = if group.starts_with('x') { (1, 2) } else { (2, 1) };
            let held = |components: &[i32]| -> Vec<String> {
                components.iter().flat_map(|n| [0, along, 3].map(|m| format!("U{n}{m}"))).collect()
            };
            let fix = match side {
                Side::Free => continue,
                Side::Clamped => held(&[across, along, 3]),
                Supported => held(&[along, 3]),
                Symmetric => {
                    let slopes = [along, 3].map(|n| format!("U{n}{across}"));
                    held(&[across]).into_iter().chain(slopes).collect()
                }
            };
            let _ = writeln!(supports, "[[support]]\ngroup = '{group}'\nat = 'all'\nfix = {fix:?}");
        }
        if analysis == "static" {
            supports.push_str("[[support]]\nrestrain = 'rigid-motions'\n");
        }
        let _ = write!(
            text,
            "[materials.m]\n{}[laminate]\nplies = '{}'\nmaterial = 'm'\nply_thickness = '{} mm'\nlayers = {:?}\n{supports}{}",
            self.material, self.plies, self.ply_mm, self.layers, self.more
        );
        text
    }

    pub(super) fn model(&self, analysis: &str) -> Model {
        let scene = scene::parse(&self.text(analysis), "scene.toml".as_ref()).unwrap();
        Model::new(scene, &Registry::standard()).unwrap()
    }

    pub(super) fn solve(&self) -> StaticSolution {
        statics::solve(&self.model("static"), NonZeroUsize::MIN).unwrap()
    }

    /// Circular frequencies, rad/s.
    pub(super) fn frequencies(&self, count: usize) -> Vec<f64> {
        modes::solve(&self.model("modes"), count, NonZeroUsize::MIN).unwrap().modes.omega
    }
}

/// A mesh file that lives as long as this.
pub(super) struct MeshFile(TempDir);

impl MeshFile {
    /// The folder of `plate.msh`.
    pub(super) fn path(&self) -> &std::path::Path {
        self.0.path()
    }
}

/// A gmsh file of the quads between lines at `x` and `y`, mm, whose inner nodes are moved by up to `distortion` of the
/// distance to their neighbours. The upper right corner is a group `corner`.
pub(super) fn gmsh_grid(x: &[f64], y: &[f64], distortion: f64) -> MeshFile {
    gmsh_cells(x, y, distortion, Cells::Quads)
}

/// What a mesh is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cells {
    Quads,
    /// Each quad cut along a diagonal, which one in turn.
    Triangles,
    /// Quads left whole or cut along the one or the other diagonal, which looks random.
    Mixed,
}

impl Cells {
    fn of(self, [i, j]: [usize; 2], [a, b, c, d]: [usize; 4]) -> Vec<Vec<usize>> {
        let kind = match self {
            Self::Quads => 2,
            Self::Triangles => (i + j) % 2,
            Self::Mixed => c * 7919 % 101 % 3,
        };
        match kind {
            0 => vec![vec![a, b, c], vec![a, c, d]],
            1 => vec![vec![a, b, d], vec![b, c, d]],
            _ => vec![vec![a, b, c, d]],
        }
    }
}

/// [`gmsh_grid`] of other cells.
pub(super) fn gmsh_cells(x: &[f64], y: &[f64], distortion: f64, cells: Cells) -> MeshFile {
    let (nx, ny) = (x.len(), y.len());
    let node = |i: usize, j: usize| 1 + i + j * nx;
    let mut nodes = Vec::new();
    for j in 0..ny {
        for i in 0..nx {
            let inner = (1..nx - 1).contains(&i) && (1..ny - 1).contains(&j);
            let moved = |line: &[f64], k: usize, seed: usize| {
                let share = if inner { distortion * ((seed * 7919 % 101) as f64 / 50.0 - 1.0) } else { 0.0 };
                line[k] + share * (line[(k + 1).min(line.len() - 1)] - line[k])
            };
            nodes.push([moved(x, i, 3 * node(i, j)), moved(y, j, 5 * node(i, j) + 1)]);
        }
    }
    let quad = |i: usize, j: usize| cells.of([i, j], [node(i - 1, j - 1), node(i, j - 1), node(i, j), node(i - 1, j)]);
    gmsh_file(
        &nodes,
        &[
            ("corner", vec![vec![nx * ny]]),
            ("x-min", (1..ny).map(|j| vec![node(0, j - 1), node(0, j)]).collect()),
            ("x-max", (1..ny).map(|j| vec![node(nx - 1, j - 1), node(nx - 1, j)]).collect()),
            ("y-min", (1..nx).map(|i| vec![node(i - 1, 0), node(i, 0)]).collect()),
            ("y-max", (1..nx).map(|i| vec![node(i - 1, ny - 1), node(i, ny - 1)]).collect()),
            ("plate", (1..ny).flat_map(|j| (1..nx).map(move |i| (i, j))).flat_map(|(i, j)| quad(i, j)).collect()),
        ],
    )
}

/// A gmsh file of nodes, mm, and of groups of points, edges or cells, which number nodes from 1.
pub(super) fn gmsh_file(nodes: &[[f64; 2]], groups: &[(&str, Vec<Vec<usize>>)]) -> MeshFile {
    let dim = |elements: &[Vec<usize>]| [0, 0, 1, 2, 2][elements[0].len()];
    let count = |wanted: usize| groups.iter().filter(|g| dim(&g.1) == wanted).count();
    // Points, which come first, are numbered by themselves.
    let tagged = || (1..=count(0)).chain(1..).zip(groups);
    let mut t = format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n", groups.len());
    for (tag, (name, elements)) in tagged() {
        let _ = writeln!(t, "{} {tag} \"{name}\"", dim(elements));
    }
    let _ = writeln!(t, "$EndPhysicalNames\n$Entities\n{} {} {} 0", count(0), count(1), count(2));
    for (tag, (_, elements)) in tagged() {
        let _ = match dim(elements) {
            0 => writeln!(t, "{tag} {} {} 0 1 {tag}", nodes[elements[0][0] - 1][0], nodes[elements[0][0] - 1][1]),
            _ => writeln!(t, "{tag} 0 0 0 0 0 0 1 {tag} 0"),
        };
    }
    let n = nodes.len();
    let _ = writeln!(t, "$EndEntities\n$Nodes\n1 {n} 1 {n}\n2 {} 0 {n}", groups.len() - count(0));
    (1..=n).for_each(|i| t += &format!("{i}\n"));
    nodes.iter().for_each(|[x, y]| t += &format!("{x} {y} 0\n"));
    let m: usize = groups.iter().map(|g| g.1.len()).sum();
    let mut groups: Vec<_> = tagged().map(|(tag, (_, elements))| (tag, elements.clone())).collect();
    groups.iter_mut().for_each(|(_, elements)| elements.sort_by_key(Vec::len));
    let blocks = groups
        .iter()
        .flat_map(|(tag, elements)| elements.chunk_by(|a, b| a.len() == b.len()).map(move |elements| (tag, elements)));
    let _ = writeln!(t, "$EndNodes\n$Elements\n{} {m} 1 {m}", blocks.clone().count());
    let mut number = 0;
    for (tag, elements) in blocks {
        let kind = [15, 15, 1, 2, 3][elements[0].len()];
        let _ = writeln!(t, "{} {tag} {kind} {}", dim(elements), elements.len());
        for nodes in elements {
            number += 1;
            let nodes: Vec<String> = nodes.iter().map(usize::to_string).collect();
            let _ = writeln!(t, "{number} {}", nodes.join(" "));
        }
    }
    t.push_str("$EndElements\n");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("plate.msh"), t).unwrap();
    MeshFile(folder)
}

/// A row of a table by the names of its columns; texts are NaN.
pub(super) type Row = HashMap<String, f64>;

/// A table of `tests/data/reference`.
pub(super) fn reference(name: &str) -> Vec<Row> {
    let path = root().join("tests/data/reference").join(name);
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().clone();
    let number = |text: &str| text.parse().unwrap_or(f64::NAN);
    let row = |r: csv::StringRecord| header.iter().map(String::from).zip(r.iter().map(number)).collect();
    reader.records().map(|r| row(r.unwrap())).collect()
}

/// The largest absolute value of a column.
pub(super) fn largest(rows: &[Row], column: &str) -> f64 {
    rows.iter().fold(0.0_f64, |m, r| m.max(r[column].abs()))
}

/// The largest difference of `column` from `value` of the points of a profile, at every row's ply and height. `height` is
/// the column of z and its unit, mm; each ply of the table is `split` plies of the model.
pub(super) fn farthest<'r>(
    rows: impl IntoIterator<Item = &'r Row>,
    column: &str,
    height: (&str, f64),
    split: usize,
    profile: &[ProfilePoint],
    value: impl Fn(&ProfilePoint) -> f64,
) -> f64 {
    let mut worst = 0.0_f64;
    for row in rows {
        let same = |p: &&ProfilePoint| {
            p.ply / split + 1 == row["ply"] as usize && (p.z * 1e3 - row[height.0] * height.1).abs() < 1e-6
        };
        let mut here = profile.iter().filter(same).peekable();
        assert!(here.peek().is_some(), "nothing at ply {} z {}", row["ply"], row[height.0]);
        here.for_each(|p| worst = worst.max((value(p) - row[column]).abs()));
    }
    worst
}

/// The order p of errors C hᵖ by least squares, for meshes of `n` cells a side.
pub(super) fn order(n: &[usize], errors: &[f64]) -> f64 {
    let (x, y): (Vec<f64>, Vec<f64>) = n.iter().zip(errors).map(|(n, e)| (-(*n as f64).ln(), e.ln())).unzip();
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (mx, my) = (mean(&x), mean(&y));
    let top: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    top / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>()
}
