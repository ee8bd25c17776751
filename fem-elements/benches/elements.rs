//! Stiffness matrices of cells that are all distinct, eight plies each, on one thread; beside them a large matrix product,
//! which shows what the core gives.
//!
//! `cargo bench -p fem-elements` prints per line the time of one matrix, matrices a second (`item/s`) and, where the
//! element's work is one or more matrix products, multiply-adds a second in them (`Hz`); a multiply-add is two operations.
#![allow(missing_docs, clippy::unwrap_used)]

use divan::counter::{CyclesCount, ItemsCount};
use divan::{Bencher, black_box};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use fem_core::element::{Cell, Element, Scratch, Slice, Stack};
use fem_core::material::Elastic;
use fem_core::tensor::rotate_stiffness;
use fem_elements::{HermiteHex, HermitePrism, Hex20, Mass, Mitc4, PlaneState, WebsterBeam};

fn main() {
    divan::main();
}

type Corners = [[f64; 2]; 4];

/// What is measured: an element, the kind of its cells, and the multiply-adds of its matrix products.
struct Subject {
    name: &'static str,
    element: Box<dyn Element>,
    corners: fn(f64) -> Corners,
    multiply_adds: Option<u64>,
}

/// Elements by name; `distort` runs from 0 to 1 over the cells.
fn subjects() -> Vec<Subject> {
    let prism = HermitePrism::new(Mass::Cubic, 4).unwrap();
    let beam = |state| WebsterBeam::new(state, Mass::Cubic, 4).unwrap();
    // 16 points × 16 functions × 11 × 6 · 11 for G H, and for (G H) Gᵀ six blocks of even and odd rows, 16 × (11 · 16) × 16.
    let general = 16 * 16 * 11 * 66 + 6 * 2 * 16 * 176 * 16;
    // Six blocks × 63 terms × 32².
    let constant = 6 * 63 * 32 * 32;
    let mut all = Vec::new();
    let mut add = |name, element: Box<dyn Element>, corners, multiply_adds| {
        all.push(Subject { name, element, corners, multiply_adds });
    };
    add("hermite-prism", Box::new(prism), quadrilateral as fn(f64) -> Corners, Some(general));
    add("hermite-hex", Box::new(HermiteHex::new(Mass::Cubic)), parallelogram, Some(constant));
    add("hex20", Box::new(Hex20::new(3).unwrap()), quadrilateral, None);
    add("mitc4", Box::<Mitc4>::default(), quadrilateral, None);
    add("webster-beam, plane stress", Box::new(beam(PlaneState::Stress)), rectangle, None);
    add("webster-beam, plane strain", Box::new(beam(PlaneState::Strain)), rectangle, None);
    all
}

fn rectangle(t: f64) -> Corners {
    let x = 1e-3 * (1.0 + t);
    [[0.0, 0.0], [x, 0.0], [x, 1e-3], [0.0, 1e-3]]
}

fn parallelogram(t: f64) -> Corners {
    let [a, b, c, d] = rectangle(t);
    let shear = |p: [f64; 2]| [p[0] + 0.3 * p[1], p[1] + 0.2 * t * p[0]];
    [shear(a), shear(b), shear(c), shear(d)]
}

fn quadrilateral(t: f64) -> Corners {
    let mut corners = parallelogram(t);
    corners[2][0] += 2e-4 * (1.0 + t);
    corners
}

fn eight_plies() -> Stack {
    let c = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9).stiffness();
    let ply = |(i, angle): (usize, f64)| {
        let q = -1.0 + 0.25 * i as f64;
        Slice { q: [q, q + 0.25], c: rotate_stiffness(&c, angle.to_radians()), density: 1575.0, free: [0.0; 6] }
    };
    Stack::new([0.0, 45.0, -45.0, 90.0, 90.0, -45.0, 45.0, 0.0].into_iter().enumerate().map(ply).collect())
}

#[divan::bench(sample_count = 1000, args = subjects().into_iter().map(|s| s.name))]
fn stiffness(bencher: Bencher, name: &str) {
    let Some(Subject { element, corners, multiply_adds, .. }) = subjects().into_iter().find(|s| s.name == name) else {
        return;
    };
    const CELLS: usize = 1000;
    let cells: Vec<Corners> = (0..CELLS).map(|i| corners(i as f64 / CELLS as f64)).collect();
    let stack = eight_plies();
    let mut scratch = Scratch::default();
    let mut ke = vec![0.0; element.info().ndof().pow(2)];
    let mut next = cells.iter().cycle();
    let mut bencher = bencher.counter(ItemsCount::new(1_u32));
    if let Some(count) = multiply_adds {
        bencher = bencher.counter(CyclesCount::new(count));
    }
    bencher.bench_local(|| {
        let corners = *black_box(next.next().unwrap_or(&cells[0]));
        let cell = Cell { corners: corners.into(), z: [0.0, 1e-3], stack: &stack };
        element.stiffness(&cell, &mut scratch, &mut ke).unwrap();
        black_box(ke[0])
    });
}

#[divan::bench(args = [1024], sample_count = 20)]
fn matrix_product(bencher: Bencher, n: usize) {
    let a = Mat::from_fn(n, n, |i, j| ((i * 7 + j * 3) % 11) as f64);
    let mut out = Mat::zeros(n, n);
    bencher.counter(CyclesCount::new(n.pow(3))).bench_local(|| {
        matmul(&mut out, Accum::Replace, black_box(&a), &a, 1.0, Par::Seq);
        black_box(out[(0, 0)])
    });
}
