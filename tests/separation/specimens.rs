//! Double cantilever beam and end notched flexure: cubic sections on a bilinear interface that is rigid until damage comes near,
//! against Timoshenko beams on that interface, solved in closed form (tests/data/damage).

use fem_core::assembly::{Growth, Path, PathEnd, PathPoint, Separable, SeparableParts, elimination_order};
use fem_core::constraint::{Constraints, Equation};
use fem_core::dof::Dof;
use fem_core::element::Element;
use fem_core::interface_law::InterfaceLaw;
use fem_core::interfaces::{InterfaceMaterial, Interfaces};
use fem_core::laminate::{LaminaPly, Laminate};
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};
use fem_core::mesh::PlaneMesh;
use fem_core::plate::{Plate, ZDerivatives};
use fem_core::plugin::{Built, Dimension, Params, Plugin, Value};
use fem_elements::{Mass, PlaneState, WebsterBeam};
use fem_failure::laws::Bilinear;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

pub(super) const WIDTH: f64 = 0.025;
const ARM: f64 = 0.0015;

/// Normal and shear stiffness of the sound interface, Pa/m.
pub(super) const PENALTY: f64 = 1e14;

/// Length of its process zones, m: as the references have it.
const ZONES: [f64; 2] = [1.71e-3, 5.18e-3];

/// A specimen: where its cells end along x, what is cracked, and how it is held and loaded.
pub(super) struct Specimen {
    pub(super) x: Vec<f64>,
    pub(super) cracked: f64,
    pub(super) margin: f64,
    pub(super) shear_strength: f64,
    /// Normal and shear stiffness of the sound interface, Pa/m.
    pub(super) penalty: f64,
    /// Unknowns (x, level, axis, side) that are held.
    pub(super) held: Vec<(f64, usize, u8, usize)>,
    /// The same with forces of the load of factor 1, N.
    pub(super) load: Vec<(f64, usize, u8, usize, f64)>,
}

/// What was seen along a path.
struct Seen {
    point: PathPoint,
    /// Length that holds no more, m.
    open: f64,
}

fn material(shear_strength: f64) -> Material {
    Material {
        name: "IM7/8552".into(),
        elastic: Elastic { e3: 11e9, ..Elastic::transversely_isotropic(150e9, 11e9, 0.3, 0.4, 6e9) },
        density: Some(1600.0),
        strengths: Strengths::default().with(Strength::Zt, 25e6).with(Strength::S13, shear_strength),
        toughness: Toughnesses::default().with(Toughness::GIc, 210.0).with(Toughness::GIIc, 770.0),
        eta: Some(2.1),
        expansion: None,
    }
}

pub(super) fn law(penalty: f64) -> Box<dyn InterfaceLaw> {
    let k = |v: f64| Value::Quantity(v, Dimension([-2.0, 1.0, -2.0, 0.0]));
    let params = Params::default().with("penalty", k(penalty)).with("shear_penalty", k(penalty));
    let Built::InterfaceLaw(law) = Bilinear::build(&params).unwrap() else { panic!() };
    law
}

impl Specimen {
    /// The plate, and the states of its interface.
    pub(super) fn build(&self) -> (Separable, Vec<f64>) {
        let element = WebsterBeam::new(PlaneState::Stress, Mass::Cubic, 4).unwrap();
        let ply = LaminaPly { angle_deg: 0.0, angle: 0.0, thickness: ARM, material: 0 };
        let laminate = Laminate { plies: vec![ply; 2], layers: vec![1, 1], middle: 0.0 };
        let material = material(self.shear_strength);
        let stacks = laminate.stacks(std::slice::from_ref(&material)).unwrap();
        let mesh = PlaneMesh::rectangle(&self.x, &[0.0, WIDTH]);
        let info = *element.info();
        let mut plate = Plate::new(mesh, laminate.levels(), stacks, info, ZDerivatives::LayerWise).unwrap();
        let quads: Vec<u32> = (0..plate.plane.quads.len() as u32).collect();
        plate.separate(1, &quads);
        let of = InterfaceMaterial { name: "bilinear".into(), law: law(self.penalty), material };
        let interfaces = Interfaces::new(&plate, &element, of, &[(1, quads)], 12).unwrap();
        let mut states = vec![0.0; interfaces.states()];
        let first = interfaces.first_states();
        for (number, cell) in interfaces.cells().iter().enumerate() {
            if plate.plane.corners(cell.quad).centroid()[0] < self.cracked + self.margin {
                let own = &mut states[first[number]..first[number + 1]];
                interfaces.crack(number, own, |[x, _]| x < self.cracked);
            }
        }
        let hold = |(x, level, n, side): &(f64, usize, u8, usize)| {
            Equation::fix(unknown(&plate, *x, *level, *n, *side).unwrap(), "support")
        };
        let supports: Vec<Equation> = self.held.iter().map(hold).collect();
        let constraints = Constraints::eliminate(&elimination_order(&plate), &supports).unwrap();
        let growth = Growth { margin: self.margin, trigger: 0.2 };
        let parts = SeparableParts {
            plate,
            element: Box::new(element),
            supports,
            constraints,
            springs: Vec::new(),
            interfaces,
            growth,
            plies: None,
            motions: Vec::new(),
        };
        (Separable::new(parts, &states, true, NonZeroUsize::MIN).unwrap(), states)
    }

    /// The load, by unknowns before elimination.
    pub(super) fn load(&self, plate: &Separable) -> Vec<(usize, f64)> {
        let of = |(x, level, n, side, f): &(f64, usize, u8, usize, f64)| {
            (unknown(&plate.parts().plate, *x, *level, *n, *side).unwrap(), *f)
        };
        self.load.iter().map(of).collect()
    }

    /// The path to `end`, which dissipates `step` (J) at a time.
    fn follow(&self, step: f64, end: PathEnd) -> Vec<Seen> {
        let (mut plate, states) = self.build();
        let load = self.load(&plate);
        let mut seen = Vec::new();
        let mut path = Path::new(&mut plate, load, step, states);
        path.follow(end, |point, path| {
            let open = path.plate().parts().interfaces.lost_area(path.states(), 0.9999)[&1] / WIDTH;
            seen.push(Seen { point: *point, open });
            ControlFlow::Continue(())
        })
        .unwrap();
        seen
    }
}

fn unknown(plate: &Plate, x: f64, level: usize, n: u8, side: usize) -> Option<usize> {
    let near = |p: &[f64; 2]| (p[0] - x).abs() < 1e-9;
    let columns = (0..plate.columns.len()).filter(|c| near(&plate.columns[*c]));
    columns.flat_map(|c| plate.dofs_at(c, level, Dof::new(n, 0).unwrap()).nth(side)).next()
}

/// Cells of a given length and ends at each of `at`.
fn cells(at: &[f64], length: f64) -> Vec<f64> {
    let mut x = vec![at[0]];
    for pair in at.windows(2) {
        let n = ((pair[1] - pair[0]) / length).round().max(1.0);
        x.extend((1..=n as usize).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / n));
    }
    x
}

/// Columns of a reference on a branch; where a file holds several specimens, "specimen,branch".
pub(super) fn reference<const N: usize>(name: &str, branch: &str, columns: [&str; N]) -> Vec<[f64; N]> {
    let path = format!("{}/tests/data/damage/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = |column: &str| names.iter().position(|name| *name == column).unwrap();
    let (last, columns) = (place("branch"), columns.map(place));
    let rows = lines.map(|line| line.split(',').collect::<Vec<_>>());
    rows.filter(|row| row[..=last].join(",") == branch).map(|row| columns.map(|c| row[c].parse().unwrap())).collect()
}

/// The second column of a reference at a value of the first, along straight lines of logarithms; where it has one.
pub(super) fn at(reference: &[[f64; 2]], x: f64) -> Option<f64> {
    let pair = reference.windows(2).find(|pair| pair[0][0] <= x && x <= pair[1][0])?;
    let share = (x / pair[0][0]).ln() / (pair[1][0] / pair[0][0]).ln();
    Some(pair[0][1] * (pair[1][1] / pair[0][1]).powf(share))
}

pub(super) fn mean_and_ripple(errors: &[f64]) -> [f64; 2] {
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    [mean, (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n).sqrt()]
}

fn double_cantilever(cell: f64) -> Specimen {
    Specimen {
        x: cells(&[0.0, 30e-3, 90e-3], cell),
        cracked: 30e-3,
        margin: (2.0 * ZONES[0]).max(2.0 * cell),
        shear_strength: 60e6,
        penalty: PENALTY,
        held: (0..3).flat_map(|level| [(90e-3, level, 1, 0), (90e-3, level, 3, 0)]).collect(),
        load: vec![(0.0, 1, 3, 1, 1.0), (0.0, 1, 3, 0, -1.0)],
    }
}

#[test]
fn a_double_cantilever_grows_as_beams_on_its_interface() {
    let exact = reference("specimens_cohesive_dcb_im7_8552", "crack_growth", ["delta_m", "P_N"]);
    // Cells of half a process zone and of a whole one: mean of the force's error, ripple, per cent.
    for (share, bounds) in [(0.5, [0.5, 0.6]), (1.0, [0.5, 1.5])] {
        let end = PathEnd { opening: 4.2e-3, dissipated: f64::INFINITY, steps: 500 };
        let seen = double_cantilever(share * ZONES[0]).follow(210.0 * WIDTH * 0.3e-3, end);
        let grown = seen.iter().filter(|seen| seen.open > 31.5e-3);
        let errors: Vec<f64> =
            grown.filter_map(|seen| Some(100.0 * (seen.point.load / at(&exact, seen.point.opening)? - 1.0))).collect();
        let [mean, ripple] = mean_and_ripple(&errors);
        assert!(errors.len() > 40 && mean.abs() < bounds[0] && ripple < bounds[1], "{share}: {mean} {ripple}");
        // What is dissipated is GIc times the area that has opened, but for the process zone.
        let [a, b] = [&seen[seen.len() / 2], &seen[seen.len() - 1]];
        let of_area = (b.point.energy.dissipated - a.point.energy.dissipated) / (210.0 * WIDTH * (b.open - a.open));
        assert!((of_area - 1.0).abs() < 0.03, "{of_area}");
        // Work of the load, by the trapezium rule, is what is stored and dissipated.
        let mut work = 0.0;
        let mut last = [0.0; 2];
        for seen in &seen {
            let [load, opening] = [seen.point.load, seen.point.opening];
            work += 0.5 * (load + last[0]) * (opening - last[1]);
            last = [load, opening];
        }
        let energy = seen[seen.len() - 1].point.energy.total();
        assert!((energy / work - 1.0).abs() < 5e-3, "{energy} {work}");
    }
}

/// Three-point bending of a strip that is cracked from its left end on.
pub(super) fn end_notched(a0: f64) -> Specimen {
    Specimen {
        x: cells(&[0.0, a0, 50e-3, 100e-3], 0.5 * ZONES[1]),
        cracked: a0,
        margin: 2.0 * ZONES[1],
        shear_strength: 60e6,
        penalty: PENALTY,
        held: vec![(0.0, 0, 3, 0), (100e-3, 0, 3, 0), (100e-3, 0, 1, 0)],
        load: vec![(50e-3, 2, 3, 0, -1.0)],
    }
}

#[test]
fn an_end_notched_flexure_snaps_back_as_beams_on_its_interface() {
    for (name, a0) in [("specimens_cohesive_enf_im7_8552", 36e-3), ("specimens_cohesive_enf_short_im7_8552", 25e-3)] {
        // Along the branch dissipation grows where the deflection may turn back.
        let [force, deflection] =
            ["P_N", "delta_m"].map(|column| reference(name, "crack_growth", ["dissipated_J", column]));
        let specimen = end_notched(a0);
        let end = PathEnd { opening: 5e-3, dissipated: 770.0 * WIDTH * 14e-3, steps: 300 };
        let seen = specimen.follow(770.0 * WIDTH * 0.5e-3, end);
        let errors = |exact: &[[f64; 2]], of: fn(&PathPoint) -> f64| -> Vec<f64> {
            let error = |s: &Seen| Some(100.0 * (of(&s.point) / at(exact, s.point.energy.dissipated)? - 1.0));
            seen.iter().filter_map(error).collect()
        };
        let [by_force, by_deflection] = [errors(&force, |p| p.load), errors(&deflection, |p| p.opening)];
        let [force, deflection] = [mean_and_ripple(&by_force), mean_and_ripple(&by_deflection)];
        assert!(by_force.len() > 10, "{}", by_force.len());
        for [mean, ripple] in [force, deflection] {
            assert!(mean.abs() < 1.0 && ripple < 1.0, "{name}: force {force:?}, deflection {deflection:?}");
        }
        let peak = seen.iter().fold(0.0_f64, |m, s| m.max(s.point.load));
        let exact = [527.3, 731.0][usize::from(a0 < 30e-3)];
        assert!((peak / exact - 1.0).abs() < 0.01, "{name}: peak {peak}");
        if a0 < 30e-3 {
            // The deflection turns back at the peak.
            let back = seen.windows(2).filter(|pair| pair[1].point.opening < pair[0].point.opening).count();
            assert!(back > 5, "{back} steps back");
        }
    }
}
