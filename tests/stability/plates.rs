//! Plates on meshes of any shape.

use crate::scene::Plate;
use fem::analyses::statics::{self, StaticSolution};
use fem::core::domain::{Corners, Domain};
use fem::core::mesh::{Group, PlaneMesh};
use fem::io::scene;
use fem::{Error, Model, Registry};
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use tempfile::TempDir;

/// Solids for cells of any shape, as keys of a scene's `element`.
pub(crate) const SOLIDS: [&str; 3] =
    ["kind = 'hermite-prism'", "kind = 'hermite-prism', z_derivatives = 'layer-wise'", "kind = 'hex20'"];
/// A solid for parallelograms.
pub(crate) const HEX: &str = "kind = 'hermite-hex', z_derivatives = 'layer-wise'";
pub(crate) const SHELL: &str = "kind = 'mitc4'";
/// A section of a strip in plane strain.
pub(crate) const SECTION: &str = "kind = 'webster-beam', state = 'plane-strain', z_derivatives = 'layer-wise'";

/// A rectangle of equal cells.
pub(crate) fn rectangle([x, y]: [f64; 2], [nx, ny]: [usize; 2]) -> PlaneMesh {
    let line = |length: f64, n: usize| -> Vec<f64> { (0..=n).map(|i| length * i as f64 / n as f64).collect() };
    PlaneMesh::rectangle(&line(x, nx), &line(y, ny))
}

/// The mesh with its points moved.
pub(crate) fn moved(mut mesh: PlaneMesh, to: impl Fn([f64; 2]) -> [f64; 2]) -> PlaneMesh {
    mesh.points.iter_mut().for_each(|p| *p = to(*p));
    mesh
}

/// Its inner nodes moved by up to `share` of the distance to the nearest other node, without order.
pub(crate) fn jiggled(mut mesh: PlaneMesh, share: f64) -> PlaneMesh {
    let (low, high) = mesh.bounds();
    let old = mesh.points.clone();
    let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    for (i, point) in mesh.points.iter_mut().enumerate() {
        if (0..2).any(|d| old[i][d] == low[d] || old[i][d] == high[d]) {
            continue;
        }
        let others = old.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, p)| distance(*p, old[i]));
        let reach = share * others.fold(f64::INFINITY, f64::min);
        let angle = (i * 7919 % 1009) as f64;
        let length = reach * (i * 31 % 17) as f64 / 16.0;
        *point = [point[0] + length * angle.cos(), point[1] + length * angle.sin()];
    }
    mesh
}

/// Its cells cut along one of their diagonals or, of every fifth, left whole.
pub(crate) fn cut(mut mesh: PlaneMesh) -> PlaneMesh {
    let parts = |(number, quad): (usize, &Corners<u32>)| {
        let [a, b, c, d] = quad.four();
        match number * 7919 % 5 {
            0 => vec![*quad],
            1 | 3 => vec![[a, b, c].into(), [a, c, d].into()],
            _ => vec![[a, b, d].into(), [b, c, d].into()],
        }
    };
    mesh.quads = mesh.quads.iter().enumerate().flat_map(parts).collect();
    mesh.quad_tags = (1..=mesh.quads.len() as u64).collect();
    mesh
}

/// Nodes and cells in another order, cells from another corner.
pub(crate) fn shuffled(mesh: &PlaneMesh, seed: usize) -> PlaneMesh {
    let order = |n: usize| -> Vec<usize> {
        let mut all: Vec<usize> = (0..n).collect();
        all.sort_by_key(|i| (i * 7919 + 13) * (104_729 + 2 * seed) % 1_000_003);
        all
    };
    let (nodes, cells) = (order(mesh.points.len()), order(mesh.quads.len()));
    let mut number = vec![0; nodes.len()];
    (0..).zip(&nodes).for_each(|(new, old)| number[*old] = new);
    let of = |n: &u32| number[*n as usize];
    let mut other = mesh.clone();
    other.points = nodes.iter().map(|old| mesh.points[*old]).collect();
    other.quads = cells
        .iter()
        .map(|old| std::array::from_fn::<_, 4, _>(|k| of(&mesh.quads[*old][(k + seed) % 4])).into())
        .collect();
    for group in other.groups.values_mut() {
        group.nodes.iter_mut().for_each(|n| *n = of(n));
        group.edges.iter_mut().for_each(|e| *e = [of(&e[0]), of(&e[1])]);
    }
    other
}

/// A group of single nodes.
pub(crate) fn with_nodes(mut mesh: PlaneMesh, name: &str, nodes: &[u32]) -> PlaneMesh {
    mesh.groups.insert(name.to_owned(), Group { dim: 0, nodes: nodes.to_vec(), ..Group::default() });
    mesh
}

/// The node of the mesh nearest to a point.
pub(crate) fn nearest(mesh: &PlaneMesh, at: [f64; 2]) -> u32 {
    let distance = |n: &usize| (mesh.points[*n][0] - at[0]).hypot(mesh.points[*n][1] - at[1]);
    (0..mesh.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap() as u32
}

/// Middles of its cells.
pub(crate) fn middles(mesh: &PlaneMesh) -> Vec<[f64; 2]> {
    let middle = |q| [0, 1].map(|d| mesh.corners(q).iter().map(|p| p[d]).sum::<f64>() / mesh.quads[q].len() as f64);
    (0..mesh.quads.len()).map(middle).collect()
}

/// The mesh as a file of gmsh; cells belong to all their groups.
pub(crate) fn gmsh(mesh: &PlaneMesh) -> String {
    let groups: Vec<_> = mesh.groups.iter().filter(|(name, _)| *name != "plate").collect();
    let of = |dim: u8| groups.iter().enumerate().filter(move |(_, (_, g))| g.dim == dim);
    let mut t = format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n", groups.len() + 1);
    groups.iter().enumerate().for_each(|(i, (name, g))| t += &format!("{} {} \"{name}\"\n", g.dim, i + 2));
    let _ = writeln!(t, "2 1 \"plate\"\n$EndPhysicalNames\n$Entities\n{} {} 1 0", of(0).count(), of(1).count());
    of(0).for_each(|(i, _)| t += &format!("{0} 0 0 0 1 {0}\n", i + 2));
    of(1).for_each(|(i, _)| t += &format!("{0} 0 0 0 0 0 0 1 {0} 0\n", i + 2));
    let n = mesh.points.len();
    let _ = writeln!(t, "1 0 0 0 0 0 0 1 1 0\n$EndEntities\n$Nodes\n1 {n} 1 {n}\n2 1 0 {n}");
    (1..=n).for_each(|i| t += &format!("{i}\n"));
    mesh.points.iter().for_each(|[x, y]| t += &format!("{x} {y} 0\n"));
    let mut blocks: Vec<(String, Vec<Vec<u32>>)> = Vec::new();
    for (i, (_, g)) in of(0) {
        blocks.push((format!("0 {} 15", i + 2), g.nodes.iter().map(|n| vec![*n]).collect()));
    }
    for (i, (_, g)) in of(1) {
        blocks.push((format!("1 {} 1", i + 2), g.edges.iter().map(|e| e.to_vec()).collect()));
    }
    for cells in mesh.quads.chunk_by(|a, b| a.domain() == b.domain()) {
        let kind = if cells[0].domain() == Domain::Triangle { 2 } else { 3 };
        blocks.push((format!("2 1 {kind}"), cells.iter().map(|q| q.to_vec()).collect()));
    }
    let count: usize = blocks.iter().map(|b| b.1.len()).sum();
    let _ = writeln!(t, "$EndNodes\n$Elements\n{} {count} 1 {count}", blocks.len());
    let mut tag = 0;
    for (head, elements) in blocks {
        let _ = writeln!(t, "{head} {}", elements.len());
        for nodes in elements {
            tag += 1;
            let nodes: Vec<String> = nodes.iter().map(|n| (n + 1).to_string()).collect();
            let _ = writeln!(t, "{tag} {}", nodes.join(" "));
        }
    }
    t + "$EndElements\n"
}

/// A plate on a mesh, in mm, and the file of it.
pub(crate) struct Meshed {
    pub(crate) plate: Plate,
    _folder: TempDir,
}

pub(crate) fn on(mut plate: Plate, mesh: &PlaneMesh) -> Meshed {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plate.msh");
    std::fs::write(&file, gmsh(mesh)).unwrap();
    plate.mesh = format!("{{ file = '{}', unit = 'mm' }}", file.display());
    Meshed { plate, _folder: folder }
}

/// The plate with a profile of two points per ply, mm.
pub(crate) fn probe(mut plate: Plate, [x, y]: [f64; 2]) -> Plate {
    let name = plate.more.matches("[[profile]]").count();
    let _ = writeln!(plate.more, "[[profile]]\nname = '{name}'\nat = {{ x = '{x} mm', y = '{y} mm' }}\npoints = 2");
    plate
}

/// The model of a scene, or why there is none.
pub(crate) fn model(text: &str) -> Result<Model, Error> {
    Model::new(scene::parse(text, "scene.toml".as_ref())?, &Registry::standard())
}

pub(crate) fn solve(text: &str) -> Result<(Model, StaticSolution), Error> {
    let model = model(text)?;
    let solution = statics::solve(&model, NonZeroUsize::MIN)?;
    Ok((model, solution))
}

/// All that an error and its causes say.
pub(crate) fn said(error: &dyn std::error::Error) -> String {
    std::iter::successors(Some(error), |e| e.source()).map(|e| e.to_string()).collect::<Vec<_>>().join(": ")
}

/// The largest of all; what is not a number is larger than all.
pub(crate) fn worst(all: impl IntoIterator<Item = f64>) -> f64 {
    all.into_iter().fold(0.0, |worst: f64, e| if e <= worst || worst.is_nan() { worst } else { e })
}
