//! Random impacts, told another way: turned, mirrored, moved, renumbered, in other units, with plies in halves, larger, denser,
//! stiffer.

use crate::support::impact_of;
use fem::analyses::impact::Outcome;
use fem::core::mesh::{Group, PlaneMesh};
use fem::io::gmsh::{self, Encoding};
use fem::io::scene;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::fmt::Write as _;
use std::fs;

/// An impact on a cantilever, in SI units.
#[derive(Debug, Clone)]
struct Told {
    mesh: PlaneMesh,
    /// Where it is struck, at a node.
    at: [f64; 2],
    /// Axes, degrees, in which its end is tied and the corners of that are in an equation.
    ties: Option<[f64; 2]>,
    /// Angles, degrees, and how many plies of one thickness are each.
    plies: Vec<f64>,
    thickness: f64,
    /// Side of the windows, m.
    window: f64,
    element: &'static str,
    reduction: &'static str,
    /// E1, E2, G12, density.
    material: [f64; 4],
    mass: f64,
    velocity: f64,
    contact: f64,
    step: f64,
    /// Length of the mesh file's unit, and the units of mass and of velocity.
    units: (&'static str, f64, (&'static str, f64), (&'static str, f64)),
}

const STEPS: f64 = 60.0;
const SI: (&str, f64, (&str, f64), (&str, f64)) = ("m", 1.0, ("kg", 1.0), ("m/s", 1.0));
const OTHERS: (&str, f64, (&str, f64), (&str, f64)) = ("in", 0.0254, ("mg", 1e-6), ("mm/s", 1e-3));

impl Told {
    fn outcome(&self) -> Outcome {
        let folder = tempfile::tempdir().unwrap();
        let (unit, metres, mass, velocity) = self.units;
        let mut file = Vec::new();
        gmsh::write(&mut file, &self.mesh, metres, Encoding::Binary).unwrap();
        fs::write(folder.path().join("plate.msh"), file).unwrap();
        let [e1, e2, g12, density] = self.material;
        let plies: Vec<String> = self.plies.iter().map(|angle| format!("{angle:?}")).collect();
        let mut text = format!(
            "title = 't'\nmesh = {{ file = 'plate.msh', unit = '{unit}' }}\nelement = {{ kind = '{}' }}\n\
             support = [{{ group = 'x-min', at = 'all', fix = ['U10', 'U20', 'U30'] }}]\n\
             failure = {{ criteria = ['max-stress'], every = '{:?} s', window = '{:?} m' }}\n{}\n",
            self.element, self.step, self.window, self.reduction
        );
        if let Some([end, corner]) = self.ties {
            let _ = write!(
                text,
                "couple = [{{ group = 'x-max', at = 'top', dofs = ['U20', 'U11'], axes = '{end:?} deg' }}]\n\
                 equation = [{{ terms = [{{ group = 'a', at = 'bottom', dof = 'U10', factor = 1.0, axes = '{end:?} deg' }}, \
                 {{ group = 'b', at = 'bottom', dof = 'U10', factor = -0.5, axes = '{corner:?} deg' }}] }}]\n"
            );
        }
        let _ = write!(
            text,
            "[materials.m]\ne1 = '{e1:?} Pa'\ne2 = '{e2:?} Pa'\ne3 = '{e2:?} Pa'\nnu12 = 0.3\nnu13 = 0.3\nnu23 = 0.4\n\
             g12 = '{g12:?} Pa'\ng13 = '{g12:?} Pa'\ng23 = '{:?} Pa'\ndensity = '{density:?} kg/m^3'\n\
             Xt = '2 GPa'\nXc = '1 GPa'\nYt = '50 MPa'\nYc = '200 MPa'\nS12 = '80 MPa'\nS23 = '60 MPa'\nS13 = '80 MPa'\n\
             Zt = '50 MPa'\nZc = '200 MPa'\n",
            e2 / 2.8
        );
        let _ = write!(
            text,
            "[laminate]\nplies = '[{}]'\nmaterial = 'm'\nply_thickness = '{:?} m'\nlayers = [{}]\n\
             [impactor]\nmass = '{:?} {}'\nvelocity = '{:?} {}'\nat = {{ x = '{:?} m', y = '{:?} m' }}\nload = 'node'\n\
             [contact]\nlaw = 'hertz'\nk = '{:?} N/m^1.5'\n[march]\nstep = '{:?} s'\nend = '{:?} s'\n",
            plies.join("/"),
            self.thickness,
            self.plies.len(),
            self.mass / mass.1,
            mass.0,
            self.velocity / velocity.1,
            velocity.0,
            self.at[0],
            self.at[1],
            self.contact,
            self.step,
            STEPS * self.step
        );
        let scene = scene::parse(&text, &folder.path().join("scene.toml")).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
        impact_of(scene).unwrap_or_else(|e| panic!("{e:?}\n{text}")).1.outcome
    }

    fn map(mut self, map: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        self.mesh.points.iter_mut().for_each(|point| *point = map(*point));
        self.at = map(self.at);
        self
    }

    fn turned(mut self, degrees: f64) -> Self {
        let (sin, cos) = degrees.to_radians().sin_cos();
        self.plies.iter_mut().chain(self.ties.iter_mut().flatten()).for_each(|angle| *angle += degrees);
        self.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y])
    }

    fn mirrored(mut self) -> Self {
        self.plies.iter_mut().chain(self.ties.iter_mut().flatten()).for_each(|angle| *angle = -*angle);
        for quad in &mut self.mesh.quads {
            let [a, b, c, d] = <[u32; 4]>::try_from(&quad[..]).unwrap();
            *quad = [a, d, c, b].into();
        }
        self.map(|[x, y]| [x, -y])
    }

    /// Nodes and cells in another order and with other numbers.
    fn renumbered(mut self) -> Self {
        let (nodes, cells) = (self.mesh.points.len(), self.mesh.quads.len());
        let to = |i: usize, n: usize| (i * 7 + 3) % n;
        assert!(!nodes.is_multiple_of(7) && !cells.is_multiple_of(7));
        let mut mesh = self.mesh.clone();
        for (i, point) in self.mesh.points.iter().enumerate() {
            mesh.points[to(i, nodes)] = *point;
        }
        let node = |i: u32| to(i as usize, nodes) as u32;
        for (i, quad) in self.mesh.quads.iter().enumerate() {
            let corners: Vec<u32> = quad.iter().map(|i| node(*i)).collect();
            mesh.quads[to(i, cells)] = [corners[2], corners[3], corners[0], corners[1]].into();
        }
        for group in mesh.groups.values_mut() {
            group.nodes.iter_mut().for_each(|i| *i = node(*i));
            group.nodes.sort_unstable();
            group.edges.iter_mut().flatten().for_each(|i| *i = node(*i));
            group.quads.iter_mut().for_each(|i| *i = to(*i as usize, cells) as u32);
            group.quads.sort_unstable();
        }
        mesh.node_tags.iter_mut().for_each(|tag| *tag = 10 * *tag + 5);
        self.mesh = mesh;
        self
    }

    /// All lengths and times larger; forces grow with the square.
    fn larger(mut self, by: f64) -> Self {
        self.thickness *= by;
        self.window *= by;
        self.mass *= by.powi(3);
        self.contact *= by.sqrt();
        self.step *= by;
        self.map(|point| point.map(|x| by * x))
    }

    /// All masses larger by the square, all times by the number itself.
    fn slower(mut self, by: f64) -> Self {
        self.material[3] *= by * by;
        self.mass *= by * by;
        self.velocity /= by;
        self.step *= by;
        self
    }
}

fn told() -> impl Strategy<Value = Told> {
    let sizes = (0.02..0.06, 0.02..0.05, 2e-4..8e-4);
    let plies = prop::collection::vec(-90.0..90.0, 2..5);
    let element = prop::sample::select(vec!["hermite-prism", "hex20"]);
    let node = (1_usize..=4, 0_usize..=3);
    (sizes, plies, element, node, 1e-3..0.1, 1.0..20.0, 7.0..9.0).prop_map(
        |((a, b, thickness), plies, element, node, mass, velocity, stiff): (_, _, _, (usize, usize), f64, f64, f64)| {
            let lines = |size: f64, n: usize| (0..=n).map(|i| size * i as f64 / n as f64).collect::<Vec<f64>>();
            let (x, y) = (lines(a, 4), lines(b, 3));
            Told {
                at: [x[node.0], y[node.1]],
                ties: None,
                mesh: PlaneMesh::rectangle(&x, &y),
                plies: plies.iter().map(|angle: &f64| angle.round()).collect(),
                thickness,
                window: 2.54e-3,
                element,
                reduction: "reduction = { method = 'none' }",
                material: [130e9, 9e9, 5e9, 1600.0],
                mass,
                velocity,
                contact: 10_f64.powf(stiff),
                step: 1e-6,
                units: SI,
            }
        },
    )
}

/// Forces over those of `of` times `scale`, and indices: the largest difference, relative to the largest of each. Plies in halves
/// are judged at other places.
fn difference(of: &Outcome, other: &Outcome, way: &str, scale: f64) -> f64 {
    let forces = |outcome: &Outcome| outcome.history.iter().map(|row| row.contact_force_n()).collect::<Vec<_>>();
    let peaks = |outcome: &Outcome| outcome.peaks.iter().map(|peak| peak.index).collect::<Vec<_>>();
    let worst = |a: Vec<f64>, b: Vec<f64>, scale: f64| {
        assert_eq!(a.len(), b.len());
        let largest = a.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
        a.iter().zip(&b).fold(0.0_f64, |m, (a, b)| m.max((a - b / scale).abs())) / largest
    };
    let of_forces = worst(forces(of), forces(other), scale);
    if way == HALVES { of_forces } else { of_forces.max(worst(peaks(of), peaks(other), 1.0)) }
}

const HALVES: &str = "plies in halves";

/// Each way to tell an impact, and by what its forces are larger.
fn ways(told: &Told) -> Vec<(&'static str, Told, f64)> {
    let halves = told.plies.iter().flat_map(|angle| [*angle; 2]).collect();
    vec![
        ("turned", told.clone().turned(37.0), 1.0),
        ("mirrored", told.clone().mirrored(), 1.0),
        ("renumbered", told.clone().renumbered(), 1.0),
        ("in other units", Told { units: OTHERS, ..told.clone() }, 1.0),
        (HALVES, Told { plies: halves, thickness: 0.5 * told.thickness, ..told.clone() }, 1.0),
        ("larger", told.clone().larger(3.0), 9.0),
        ("slower", told.clone().slower(5.0), 1.0),
    ]
}

fn for_some(cases: u32, check: impl Fn(Told)) {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    TestRunner::new_with_rng(config, rng)
        .run(&told(), |told| {
            check(told);
            Ok(())
        })
        .unwrap();
}

#[test]
fn full_plates_do_not_care_how_they_are_told() {
    for_some(6, |told| {
        let first = told.outcome();
        for (way, other, scale) in ways(&told) {
            let difference = difference(&first, &other.outcome(), way, scale);
            assert!(difference < 1e-9, "{way}: {difference:e}");
        }
        // Coordinates of 1 km have three digits less for the cells.
        let moved = told.clone().map(|[x, y]| [x + 1e3, y - 1e3]).outcome();
        let difference = difference(&first, &moved, "moved", 1.0);
        assert!(difference < 1e-7, "moved by a kilometre: {difference:e}");
    });
}

#[test]
fn reduced_plates_care_as_little_as_their_reduction_is_wrong() {
    for_some(4, |told| {
        let told = Told { reduction: "reduction = { method = 'ritz', vectors = 30 }", ..told };
        let first = told.outcome();
        let residual = first.accuracy.reduction.and_then(|reduction| reduction.residual);
        let own = residual.and_then(|residual| residual.force).unwrap_or(0.0);
        for (way, other, scale) in ways(&told) {
            let difference = difference(&first, &other.outcome(), way, scale);
            assert!(difference < own.max(1e-9), "{way}: {difference:e}, {own:e}");
        }
    });
}

/// Ties and equations in axes of their own turn and mirror with the plate.
#[test]
fn ties_in_turned_axes_turn_with_the_plate() {
    for_some(2, |mut told| {
        let last = told.mesh.points.len() as u32 - 1;
        for (name, node) in [("a", last), ("b", 4)] {
            told.mesh.groups.insert(name.into(), Group { dim: 0, nodes: vec![node], ..Group::default() });
        }
        told.ties = Some([0.0, 20.0]);
        let outcome = told.outcome();
        for (way, other) in [
            ("turned", told.clone().turned(37.0)),
            ("mirrored", told.clone().turned(-11.0).mirrored()),
            ("renumbered", told.clone().turned(90.0).renumbered()),
        ] {
            let off = difference(&outcome, &other.outcome(), way, 1.0);
            assert!(off < 1e-6, "{way}: {off:e} of {told:?}");
        }
        // They are not ties in other axes.
        let off = difference(&outcome, &Told { ties: Some([30.0, 50.0]), ..told.clone() }.outcome(), "", 1.0);
        assert!(off > 1e-6, "{off:e} of {told:?}");
    });
}
