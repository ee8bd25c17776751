//! Assembly against the integration of its element matrices, one thread, all cells distinct:
//! `cargo bench --bench assembly`.
#![allow(clippy::unwrap_used, missing_docs)]

use divan::Bencher;
use fem::core::assembly::{Matrix, Pattern, assemble, elimination_order, pattern};
use fem::core::constraint::Constraints;
use fem::core::counters::Counters;
use fem::core::element::{Element, Scratch};
use fem::core::laminate::{LaminaPly, Laminate};
use fem::core::mesh::PlaneMesh;
use fem::core::plate::{Plate, ZDerivatives};
use fem::elements::{HermitePrism, Mass};
use fem::io::materials;
use std::num::NonZeroUsize;
use std::sync::Arc;

fn main() {
    divan::main();
}

/// Two layers of eight plies on 50 x 50 cells with their nodes moved about: 101 439 unknowns.
struct Subject {
    plate: Plate,
    element: HermitePrism,
    constraints: Constraints,
    pattern: Arc<Pattern>,
}

fn subject() -> Subject {
    let line: Vec<f64> = (0..=50).map(|i| f64::from(i) * 2e-3).collect();
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
    let laminate = Laminate { plies: (0..16).map(ply).collect(), layers: vec![8, 8] };
    let element = HermitePrism::new(Mass::Cubic, HermitePrism::IN_PLANE_ORDER).unwrap();
    let stacks = laminate.stacks(&[material]).unwrap();
    let plate = Plate::new(mesh, laminate.levels(), stacks, *element.info(), ZDerivatives::LayerWise).unwrap();
    let constraints = Constraints::eliminate(&elimination_order(&plate), &[]).unwrap();
    let pattern = Arc::new(pattern(&plate, &constraints));
    Subject { plate, element, constraints, pattern }
}

#[divan::bench(sample_count = 5)]
fn element_matrices(bencher: Bencher<'_, '_>) {
    let s = subject();
    let mut ke = vec![0.0; s.element.info().ndof().pow(2)];
    let mut scratch = Scratch::default();
    bencher.bench_local(|| {
        for cell in 0..s.plate.cells() {
            s.element.stiffness(&s.plate.cell(cell), &mut scratch, &mut ke).unwrap();
        }
        ke[0]
    });
}

#[divan::bench(sample_count = 5)]
fn assembly_on_a_known_pattern(bencher: Bencher<'_, '_>) {
    let s = subject();
    let one = NonZeroUsize::MIN;
    bencher.bench_local(|| {
        let counters = &mut Counters::default();
        assemble(&s.plate, &s.element, &s.constraints, &s.pattern, Matrix::Stiffness, one, counters).unwrap()
    });
}
