//! A circular delamination under a central load: whatever its size, it grows at one force (Kirchhoff plate, closed form).

use super::specimens::{PENALTY, law};
use fem_core::assembly::{Growth, Path, PathEnd, Separable, SeparableParts, elimination_order};
use fem_core::constraint::{Constraints, Equation};
use fem_core::dof::Dof;
use fem_core::element::Element;
use fem_core::interfaces::{InterfaceMaterial, Interfaces};
use fem_core::laminate::{LaminaPly, Laminate};
use fem_core::load::Face;
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};
use fem_core::mesh::PlaneMesh;
use fem_core::patch;
use fem_core::plate::{Plate, ZDerivatives};
use fem_core::symmetry::SymmetryGroup;
use fem_elements::{HermitePrism, Mass};
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

const THICKNESS: f64 = 4e-3;
const E: f64 = 60e9;
const GIIC: f64 = 800.0;

/// Radius of the delamination at first, m.
const START: f64 = 10e-3;

/// Radius of the load, m.
const LOADED: f64 = 2e-3;

#[test]
#[ignore = "a minute"]
fn a_circular_delamination_grows_at_one_force() {
    let (half, cell, zone) = (45e-3, 2.5e-3, 27.5e-3);
    let mut x: Vec<f64> = (0..=(zone / cell) as usize).map(|i| i as f64 * cell).collect();
    x.extend([32e-3, 38e-3, half]);
    let x: Vec<f64> = x[1..].iter().rev().map(|v| -v).chain(x.iter().copied()).collect();
    let material = Material {
        name: "isotropic".into(),
        elastic: Elastic::isotropic(E, 0.3),
        density: Some(1600.0),
        strengths: Strengths::default().with(Strength::Zt, 40e6).with(Strength::S13, 100e6),
        toughness: Toughnesses::default().with(Toughness::GIc, 400.0).with(Toughness::GIIc, GIIC),
        eta: Some(1.5),
        expansion: None,
    };
    let element = HermitePrism::new(Mass::Cubic, 4).unwrap();
    let ply = LaminaPly { angle_deg: 0.0, angle: 0.0, thickness: 0.5 * THICKNESS, material: 0 };
    let laminate = Laminate { plies: vec![ply; 2], layers: vec![1, 1], middle: 0.0 };
    let stacks = laminate.stacks(std::slice::from_ref(&material)).unwrap();
    let mesh = PlaneMesh::rectangle(&x, &x);
    let mut plate = Plate::new(mesh, laminate.levels(), stacks, *element.info(), ZDerivatives::LayerWise).unwrap();
    let inside = |q: &usize| plate.plane.corners(*q).into_iter().flatten().all(|v| v.abs() < zone + 1e-9);
    let quads: Vec<u32> = (0..plate.plane.quads.len()).filter(inside).map(|q| q as u32).collect();
    plate.separate(1, &quads);
    plate.fold(SymmetryGroup::Quarter).unwrap();
    let of = InterfaceMaterial { name: "bilinear".into(), law: law(PENALTY), material };
    let interfaces = Interfaces::new(&plate, &element, of, &[(1, quads)], 6).unwrap();
    let margin = 3.0 * cell;
    let mut states = vec![0.0; interfaces.states()];
    let first = interfaces.first_states();
    for (number, cell) in interfaces.cells().iter().enumerate() {
        let [x, y] = plate.plane.corners(cell.quad).centroid();
        if x.hypot(y) < START + margin {
            interfaces.crack(number, &mut states[first[number]..first[number + 1]], |[x, y]| x.hypot(y) < START);
        }
    }
    let edge = |c: &usize| plate.columns[*c].iter().any(|v| (v.abs() - half).abs() < 1e-9);
    let mut supports: Vec<Equation> = Vec::new();
    for column in (0..plate.columns.len()).filter(edge) {
        for level in 0..3 {
            for dof in Dof::SOLID.into_iter().filter(|dof| dof.m() != 3) {
                supports.extend(plate.dofs_at(column, level, dof).map(|dof| Equation::fix(dof, "clamp")));
            }
        }
    }
    supports.extend(plate.symmetry().equations(&plate));
    let constraints = Constraints::eliminate(&elimination_order(&plate), &supports).unwrap();
    let load = patch::hertz(&plate, &element, (Face::Top, 0.0), [0.0; 2], LOADED).unwrap();
    let growth = Growth { margin, trigger: 0.2 };
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
    let mut plate = Separable::new(parts, &states, false, NonZeroUsize::MIN).unwrap();
    let area = |radius: f64| PI * (radius * radius - START * START);
    let critical = PI * (8.0 * E * THICKNESS.powi(3) * GIIC / (9.0 * (1.0 - 0.09))).sqrt();
    let mut path = Path::new(&mut plate, load.0, GIIC * area(16e-3) / 12.0, states);
    let end = PathEnd { opening: f64::INFINITY, dissipated: GIIC * area(17e-3), steps: 100 };
    let mut grown = Vec::new();
    path.follow(end, |point, _| {
        // The front by its energy: the middle of the process zone.
        let radius = (point.energy.dissipated / (GIIC * PI) + START * START).sqrt();
        let exact = critical / (1.0 - LOADED * LOADED / (2.0 * radius * radius));
        if radius > 12e-3 {
            grown.push(point.load / exact);
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(grown.len() > 5 && grown.iter().all(|share| (share - 1.0).abs() < 0.04), "{grown:?}");
}
