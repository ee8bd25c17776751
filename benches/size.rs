//! Cost of everything between a mesh and a march against the number of unknowns: `cargo bench --bench size`.
//!
//! Rectangles of distinct hermite-prism cells in two layers, simply supported. Arguments are cells a side. Processor time
//! of one thread, except where the factor is shared by two: that is wall time. The fastest of several samples counts.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod plate;
mod rates;

use cpu_time::ThreadTime;
use fem::analyses::impact;
use fem::core::assembly::{Cholesky, Matrix, SparseStructure, Symbolic, assemble, column_order, pattern};
use fem::core::counters::Counters;
use fem::core::functional::Functional;
use fem::core::load::Face;
use fem::core::patch;
use fem::core::plugin::{Built, Params, Plugin, Value};
use fem::core::prolongation::Prolongation;
use fem::core::structure::Structure;
use fem::dynamics::contact::Hertz;
use fem::dynamics::guard::Guard;
use fem::dynamics::impact::{ImpactSystem, Impactor};
use fem::dynamics::integrate::Newmark;
use fem::dynamics::reduce::{Reduced, Ritz};
use plate::{Subject, subject};
use std::hint::black_box;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::time::{Duration, Instant};

const ONE: NonZeroUsize = NonZeroUsize::MIN;
const TWO: NonZeroUsize = ONE.saturating_add(1);

/// Right-hand sides of a block.
const COLUMNS: usize = 40;

/// Steps of a march.
const STEPS: usize = 2000;

fn main() {
    let mut sides: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    if sides.is_empty() {
        sides = vec![15, 27, 50, 87];
    }
    let rows: Vec<Vec<(&'static str, f64)>> = sides.into_iter().map(measure).collect();
    println!("\n{:<34} exponent of the number of unknowns", "");
    let points = |k: usize| rows.iter().map(move |r| (r[0].1.ln(), r[k].1.ln()));
    for (k, (name, _)) in rows[0].iter().enumerate().skip(1) {
        let count = rows.len() as f64;
        let mean = points(k).fold((0.0, 0.0), |m, p| (m.0 + p.0 / count, m.1 + p.1 / count));
        let slope = points(k).map(|p| (p.0 - mean.0) * (p.1 - mean.1)).sum::<f64>()
            / points(k).map(|p| (p.0 - mean.0).powi(2)).sum::<f64>();
        println!("{name:<34} {slope:>8.2}");
    }
}

/// Least processor time of this thread and least wall time over `samples`, s.
fn clocks<T>(samples: usize, mut work: impl FnMut() -> T) -> [f64; 2] {
    let mut least = [Duration::MAX; 2];
    for _ in 0..samples {
        let (processor, wall) = (ThreadTime::now(), Instant::now());
        black_box(work());
        least = [least[0].min(processor.elapsed()), least[1].min(wall.elapsed())];
    }
    least.map(|d| d.as_secs_f64())
}

/// Least processor time of this thread over `samples`, s.
fn seconds<T>(samples: usize, work: impl FnMut() -> T) -> f64 {
    clocks(samples, work)[0]
}

/// GB/s at which one core adds up numbers that no cache holds.
fn stream() -> f64 {
    let numbers = vec![1.0_f64; 1 << 24];
    let sum = || {
        let mut sums = [0.0; 16];
        for chunk in numbers.chunks_exact(16) {
            sums.iter_mut().zip(chunk).for_each(|(s, v)| *s += v);
        }
        sums
    };
    8.0 * numbers.len() as f64 / seconds(5, sum) / 1e9
}

/// Largest memory that the process has held so far, GB.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kb| kb.parse().ok()).map_or(f64::NAN, |kb: f64| kb * 1024.0 / 1e9)
}

fn measure(side: usize) -> Vec<(&'static str, f64)> {
    let Subject { plate, element, constraints } = subject(side);
    let pattern = Arc::new(pattern(&plate, &constraints));
    let n = pattern.ndof();
    let samples = (2_000_000 / n).clamp(2, 20);
    let few = (200_000 / n).clamp(1, 5);
    let mut row = vec![("unknowns", n as f64)];
    let mut note = |name: &'static str, value: f64| {
        println!("{name:<34} {value:>12.5}");
        row.push((name, value));
    };
    println!("\n{n} unknowns, {} entries of K", pattern.entries());
    let matrix =
        |which| assemble(&plate, &element, &constraints, &pattern, which, ONE, &mut Counters::default()).unwrap();
    let start = ThreadTime::now();
    let k = matrix(Matrix::Stiffness);
    note("assembly of K, s", start.elapsed().as_secs_f64());
    let m = matrix(Matrix::Mass);

    let symbolic = Symbolic::new(pattern.clone()).unwrap();
    note("analysis, s", seconds(few, || Symbolic::new(pattern.clone())));
    let (entries, flops) = (symbolic.entries() as f64, symbolic.flops());
    note("factor entries", entries);
    note("factor flops", flops);
    let mut factor = Cholesky::new(symbolic.clone(), ONE);
    let [time, wall_one] = clocks(few, || factor.factorise(k.lower()));
    note("factor, s", time);
    let rate = flops / time / 1e9;
    note("factor, GFLOP/s", rate);
    note("factor, share of a product", rate / rates::product());
    drop(factor);
    let mut factor = Cholesky::new(symbolic.clone(), TWO);
    let [_, wall_two] = clocks(few, || factor.factorise(k.lower()));
    note("factor, wall s on one thread", wall_one);
    note("factor, wall s on two threads", wall_two);

    let mut x: Vec<f64> = (0..n * COLUMNS).map(|i| (i % 13) as f64 - 6.0).collect();
    let solve = seconds(samples, || factor.solve(&mut x[..n], 1));
    note("solve, s", solve);
    note("solve, GB/s", 16.0 * entries / solve / 1e9);
    note("solve, share of a stream", 16.0 * entries / solve / 1e9 / stream());
    let block = seconds(few, || factor.solve(&mut x, COLUMNS));
    note("solve of 40, s", block);
    note("solve of 40, share of a product", 4e-9 * entries * COLUMNS as f64 / block / rates::product());
    let mut y = vec![0.0; n];
    note("product with M, s", seconds(samples, || m.add_product(1.0, &x[..n], &mut y)));
    drop((factor, x, y));

    let (low, high) = plate.plane.bounds();
    let middle = |c: &usize| (0..2).map(|d| (2.0 * plate.columns[*c][d] - low[d] - high[d]).powi(2)).sum::<f64>();
    let struck = (0..plate.columns.len()).min_by(|a, b| middle(a).total_cmp(&middle(b))).unwrap();
    let contact = constraints.restrict(&patch::node(&plate, Face::Top, struck).unwrap().0);
    let contact = Functional(contact);
    let mut structure = SparseStructure::new(symbolic, k, m, ONE, |_| String::new());
    structure.offer_coarse(Prolongation::linear_in_z(&plate, &constraints, &column_order(&plate)));
    let Built::Reduction(ritz) = Ritz::build(&Params::default()).unwrap() else { unreachable!() };
    structure.solve_shifted(0.0, &mut vec![0.0; n], 1).unwrap();
    let start = ThreadTime::now();
    let basis = ritz.basis(&mut structure, std::slice::from_ref(&contact), &[]).unwrap();
    let reduced = Reduced::project(&structure, &basis).unwrap();
    note("reduction to 60, s", start.elapsed().as_secs_f64());
    let load = reduced.restrict(&contact).into_iter().enumerate().collect();
    let [reduced, guards] = step(Box::new(reduced.modal.clone()), load, STEPS);
    note("2000 reduced steps, s", STEPS as f64 * reduced);
    note("guards / reduced step", guards / reduced);
    let [full, guards] = step(Box::new(structure), contact.0.clone(), samples);
    note("full step, s", full);
    note("full step / solve", full / solve);
    note("guards / full step", guards / full);
    note("peak memory, GB", peak_memory());
    row
}

/// Least processor times (s) of a Newmark step of an impact on `structure`, of all steps where there are many, else of each,
/// and of the guards at a step.
fn step(structure: Box<dyn Structure>, load: Vec<(usize, f64)>, steps: usize) -> [f64; 2] {
    let stiffness = Value::Quantity(1e9, fem::core::plugin::Dimension::contact_stiffness(1.5));
    let Built::Contact(law) = Hertz::build(&Params::default().with("k", stiffness)).unwrap() else { unreachable!() };
    let Built::Integrator(mut newmark) = Newmark::build(&Params::default()).unwrap() else { unreachable!() };
    let mut system = ImpactSystem::new(structure, vec![Impactor { mass: 2.5, velocity: 1.5, start: 0.0, load, law }]);
    let mut state = system.initial();
    let mut one = |n: usize| (0..n).for_each(|_| newmark.step(&mut system, &mut state, 5e-7).unwrap());
    one(1);
    let march = if steps == STEPS { seconds(3, || one(steps)) / steps as f64 } else { seconds(steps, || one(1)) };

    // A march knows indentation, force and velocity for its record of the contacts.
    let (guard, touch, mut work) = (Guard::new(&mut system), system.touch(0, &state), Vec::new());
    let look = |_| guard.touch(0, black_box(touch)).unwrap();
    let touches = seconds(3, || (0..STEPS).for_each(look)) / STEPS as f64;
    let mut balance = || guard.balance(&system.energies(&state, &mut work)).unwrap();
    let balances = seconds(3, || (0..20).for_each(|_| _ = balance())) / 20.0;
    [march, touches + balances / impact::BALANCE_EVERY as f64]
}
