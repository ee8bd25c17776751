//! A plate that the benchmarks have in common.

use fem::core::assembly::elimination_order;
use fem::core::constraint::Constraints;
use fem::core::dof::Dof;
use fem::core::element::Element;
use fem::core::hold::{Hold, What};
use fem::core::laminate::{LaminaPly, Laminate};
use fem::core::mesh::PlaneMesh;
use fem::core::plate::{Plate, ZDerivatives};
use fem::elements::{HermitePrism, Mass};
use fem::io::materials;

pub(crate) struct Subject {
    pub(crate) plate: Plate,
    pub(crate) element: HermitePrism,
    pub(crate) constraints: Constraints,
}

/// Two layers of eight plies on `side × side` distinct hermite-prism cells, simply supported: 100 839 unknowns for 50.
pub(crate) fn subject(side: usize) -> Subject {
    let line: Vec<f64> = (0..=side).map(|i| i as f64 * 2e-3).collect();
    let mut mesh = PlaneMesh::rectangle(&line, &line);
    for (i, p) in mesh.points.iter_mut().enumerate() {
        let i = i as f64;
        *p = [p[0] + 2e-4 * (1.7 * i).sin(), p[1] + 2e-4 * (2.9 * i).cos()];
    }
    let material = materials::library("AS4/3502").unwrap().material.clone();
    let ply = |k: usize| {
        let angle_deg = [0.0, 45.0, -45.0, 90.0][k % 4];
        LaminaPly { angle: f64::to_radians(angle_deg), angle_deg, thickness: 0.13e-3, material: 0 }
    };
    let laminate = Laminate { plies: (0..16).map(ply).collect(), layers: vec![8, 8], middle: 0.0 };
    let element = HermitePrism::new(Mass::Cubic, HermitePrism::IN_PLANE_ORDER).unwrap();
    let stacks = laminate.stacks(&[material]).unwrap();
    let plate = Plate::new(mesh, laminate.levels(), stacks, *element.info(), ZDerivatives::LayerWise).unwrap();
    let held: Vec<Dof> = (1..=3).filter_map(|n| Dof::new(n, 0)).collect();
    let edges = ["x-min", "x-max", "y-min", "y-max"];
    let mut columns: Vec<u32> = edges.iter().flat_map(|e| plate.columns_of_group(&plate.plane.groups[*e])).collect();
    columns.sort_unstable();
    columns.dedup();
    let held = Hold { columns, levels: vec![1], dofs: held, angle: 0.0, curvature: 0.0, what: What::Each };
    let supports = held.equations(&plate, "edges");
    let constraints = Constraints::eliminate(&elimination_order(&plate), &supports).unwrap();
    Subject { plate, element, constraints }
}
