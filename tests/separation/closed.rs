//! What is closed is as if it could not open; what is open and sound is a spring between two plates.

use super::specimens::law;
use fem_core::assembly::{Growth, Matrix, Separable, SeparableParts, SparseStructure, Symbolic, assemble};
use fem_core::assembly::{elimination_order, pattern};
use fem_core::constraint::{Constraints, Equation};
use fem_core::counters::Counters;
use fem_core::dof::Dof;
use fem_core::domain::Corners;
use fem_core::element::Element;
use fem_core::interfaces::{InterfaceMaterial, Interfaces};
use fem_core::laminate::{LaminaPly, Laminate};
use fem_core::load::{self, Face};
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};
use fem_core::mesh::PlaneMesh;
use fem_core::plate::{Plate, ZDerivatives};
use fem_core::structure::Structure;
use fem_elements::{HermitePrism, Hex20, Mass};
use std::num::NonZeroUsize;
use std::sync::Arc;

const PENALTY: f64 = 1e14;

fn material() -> Material {
    Material {
        name: "carbon".into(),
        elastic: Elastic::transversely_isotropic(130e9, 9.65e9, 0.3, 0.35, 5e9),
        density: Some(1600.0),
        strengths: Strengths::default().with(Strength::Zt, 60e6).with(Strength::S13, 90e6),
        toughness: Toughnesses::default().with(Toughness::GIc, 300.0).with(Toughness::GIIc, 900.0),
        eta: Some(1.5),
        expansion: None,
    }
}

/// Whether every second cell is cut in two.
#[derive(Clone, Copy)]
enum Cells {
    Quads,
    Mixed,
}

/// A plate of 12 mm by 8 mm, `[0/45/90]`, whose two interfaces may open where `separate` says so.
fn plate(element: &dyn Element, cells: Cells, separate: bool) -> Plate {
    let mut mesh = PlaneMesh::rectangle(&[0.0, 3e-3, 5e-3, 9e-3, 12e-3], &[0.0, 3e-3, 5e-3, 8e-3]);
    if let Cells::Mixed = cells {
        let parts = |(number, quad): (usize, &Corners<u32>)| {
            let [a, b, c, d] = quad.four();
            if number % 2 == 0 { vec![*quad] } else { vec![[a, b, c].into(), [a, c, d].into()] }
        };
        mesh.quads = mesh.quads.iter().enumerate().flat_map(parts).collect();
        mesh.quad_tags = (1..=mesh.quads.len() as u64).collect();
    }
    let ply = |angle_deg: f64| LaminaPly { angle_deg, angle: angle_deg.to_radians(), thickness: 0.5e-3, material: 0 };
    let laminate = Laminate { plies: [0.0, 45.0, 90.0].map(ply).to_vec(), layers: vec![1, 1, 1], middle: 0.0 };
    let stacks = laminate.stacks(&[material()]).unwrap();
    let mut plate = Plate::new(mesh, laminate.levels(), stacks, element, ZDerivatives::LayerWise).unwrap();
    let all: Vec<u32> = (0..plate.plane.quads.len() as u32).collect();
    if separate {
        (1..3).for_each(|face| plate.separate(face, &all));
    }
    plate
}

/// Held at x = 0 over the height.
fn clamp(plate: &Plate) -> Vec<Equation> {
    let columns = (0..plate.columns.len()).filter(|c| plate.columns[*c][0] == 0.0);
    let nodes = columns.flat_map(|column| (0..plate.levels.len()).map(move |level| (column, level)));
    let dofs = nodes.flat_map(|(column, level)| (1..=3).map(move |n| (column, level, Dof::new(n, 0).unwrap())));
    dofs.flat_map(|(column, level, dof)| plate.dofs_at(column, level, dof)).map(|i| Equation::fix(i, "clamp")).collect()
}

fn separable(plate: Plate, element: Box<dyn Element>, supports: Vec<Equation>, open: bool) -> (Separable, Vec<f64>) {
    let all: Vec<u32> = (0..plate.plane.quads.len() as u32).collect();
    let of = InterfaceMaterial { name: "bilinear".into(), law: law(PENALTY), material: material() };
    let faces: Vec<(usize, Vec<u32>)> = (1..plate.layers()).map(|face| (face, all.clone())).collect();
    let interfaces = Interfaces::new(&plate, &*element, of, &faces, 4).unwrap();
    let mut states = vec![0.0; interfaces.states()];
    if open {
        let first = interfaces.first_states();
        (0..interfaces.cells().len())
            .for_each(|cell| interfaces.carry(cell, &mut states[first[cell]..first[cell + 1]], |_| [0.0; 3]));
    }
    let constraints = Constraints::eliminate(&elimination_order(&plate), &supports).unwrap();
    let growth = Growth { margin: 1e-3, trigger: 0.5 };
    let parts = SeparableParts {
        plate,
        element,
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

#[test]
fn a_closed_plate_is_one_that_cannot_open() {
    let elements: [Box<dyn Element>; 2] =
        [Box::new(HermitePrism::new(Mass::Cubic, 4).unwrap()), Box::new(Hex20::new(3).unwrap())];
    for (element, cells) in elements.into_iter().flat_map(|e| [(e.clone(), Cells::Quads), (e, Cells::Mixed)]) {
        let whole = plate(&*element, cells, false);
        let supports = clamp(&whole);
        let constraints = Constraints::eliminate(&elimination_order(&whole), &supports).unwrap();
        let pattern = Arc::new(pattern(&whole, &constraints));
        let matrix = |which| {
            let mut counters = Counters::default();
            assemble(&whole, &*element, &constraints, &pattern, which, NonZeroUsize::MIN, &mut counters).unwrap()
        };
        let (k, m) = (matrix(Matrix::Stiffness), matrix(Matrix::Mass));
        let symbolic = Symbolic::new(pattern.clone()).unwrap();
        let mut structure = SparseStructure::new(symbolic, k, m, NonZeroUsize::MIN, |i| i.to_string());
        // Deflections of both under a pressure, at rest and with inertia.
        let deflections = |plate: &Plate, constraints: &Constraints, solve: &mut dyn FnMut(f64, &mut [f64])| {
            let quads: Vec<usize> = (0..plate.plane.quads.len()).collect();
            let mut forces = vec![0.0; plate.ndof()];
            load::pressure(plate, &*element, Face::Top, quads, |_| 1e5, &mut forces);
            let nodal: Vec<(usize, f64)> = forces.into_iter().enumerate().collect();
            [0.0, 1e12].map(|shift| {
                let mut u = vec![0.0; constraints.ndof()];
                constraints.restrict(&nodal).into_iter().for_each(|(i, f)| u[i] += f);
                solve(shift, &mut u);
                let mut all = vec![0.0; plate.ndof()];
                constraints.expand(&u, &mut all);
                let mut found = Vec::new();
                for (column, level) in
                    (0..plate.columns.len()).flat_map(|c| (0..plate.levels.len()).map(move |l| (c, l)))
                {
                    for side in plate.dofs_at(column, level, Dof::new(3, 0).unwrap()) {
                        found.push(((column, level), all[side]));
                    }
                }
                found
            })
        };
        let want = deflections(&whole, &constraints, &mut |shift, x| structure.solve_shifted(shift, x, 1).unwrap());
        let apart = plate(&*element, cells, true);
        let supports = clamp(&apart);
        let constraints = Constraints::eliminate(&elimination_order(&apart), &supports).unwrap();
        let (mut closed, _) = separable(apart.clone(), element.clone(), supports, false);
        assert_eq!(closed.size().0, structure.ndof());
        assert!(closed.ndof() > structure.ndof());
        let got = deflections(&apart, &constraints, &mut |shift, x| closed.solve_shifted(shift, x, 1).unwrap());
        for (want, got) in want.iter().zip(&got) {
            let scale = want.iter().fold(0.0_f64, |m, (_, w)| m.max(w.abs()));
            for (at, w) in got {
                let same = want.iter().find(|(place, _)| place == at).unwrap().1;
                assert!((w - same).abs() < 1e-9 * scale, "{at:?}: {w} {same}");
            }
        }
    }
}

#[test]
fn sound_interfaces_are_springs_in_series() {
    [Cells::Quads, Cells::Mixed].into_iter().for_each(springs_in_series);
}

fn springs_in_series(cells: Cells) {
    let element: Box<dyn Element> = Box::new(HermitePrism::new(Mass::Cubic, 4).unwrap());
    let plate = plate(&*element, cells, true);
    // Held on its lower face, and in its plane everywhere, so that it is only pulled through its thickness.
    let mut supports = Vec::new();
    for (column, level) in (0..plate.columns.len()).flat_map(|c| (0..plate.levels.len()).map(move |l| (c, l))) {
        for dof in Dof::SOLID.into_iter().filter(|dof| dof.n() != 3 || (level == 0 && dof.m() != 3)) {
            supports.extend(plate.dofs_at(column, level, dof).map(|i| Equation::fix(i, "support")));
        }
    }
    let pressure = -1e6;
    let quads: Vec<usize> = (0..plate.plane.quads.len()).collect();
    let mut forces = vec![0.0; plate.ndof()];
    load::pressure(&plate, &*element, Face::Top, quads, |_| pressure, &mut forces);
    let (mut open, states) = separable(plate, element, supports, true);
    let constraints = open.parts().constraints.clone();
    let nodal: Vec<(usize, f64)> = forces.into_iter().enumerate().collect();
    let mut u = vec![0.0; open.ndof()];
    constraints.restrict(&nodal).into_iter().for_each(|(i, f)| u[i] += f);
    let load = u.clone();
    open.linearise(&vec![0.0; u.len()], &states, 0.0).unwrap();
    open.solve(&mut u).unwrap();
    let c33 = material().elastic.stiffness()[2][2];
    let expected = -pressure * (1.5e-3 / c33 + 2.0 / PENALTY);
    let plate = &open.parts().plate;
    let mut all = vec![0.0; plate.ndof()];
    constraints.expand(&u, &mut all);
    for column in 0..plate.columns.len() {
        let top = plate.dofs_at(column, plate.levels.len() - 1, Dof::new(3, 0).unwrap()).next();
        let Some(top) = top else { continue };
        assert!((all[top] / expected - 1.0).abs() < 1e-9, "{} {expected}", all[top]);
    }
    // The internal force is the load, and the energy half its work.
    let mut force = vec![0.0; u.len()];
    let energy = open.internal(&u, &states, &mut force).unwrap();
    let work: f64 = load.iter().zip(&u).map(|(f, u)| f * u).sum();
    assert!((energy.stored / (0.5 * work) - 1.0).abs() < 1e-9 && energy.dissipated == 0.0);
    let size = load.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    assert!(force.iter().zip(&load).all(|(a, b)| (a - b).abs() < 1e-8 * size));
}
