//! How the cost of a run grows with layers of cells and with cells, phase by phase, and what limits it: `cargo bench --bench growth`.
//!
//! Case 1 of the report without pictures, in memory, on one thread. Each phase has the processor time of the best of three runs, and
//! an exponent of the number of unknowns over the ladder. Under `factor` and `stresses` stands what the dense operations of a phase
//! take at the rate of a large product of the same process: no order of the same operations is faster. What the phase takes beyond
//! that is handled entry by entry. Arguments are the layers and the refinements of the mesh: `growth 2,4,8 0,1`.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod rates;

use fem::Registry;
use fem::core::assembly::{Symbolic, pattern};
use fem::io::scene::{self, Setting};
use fem::job::{self, Found, Options};
use std::path::Path;
use std::sync::Arc;

const EXAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/as4-3502-16ply-50mm/scene.toml");

const RUNS: usize = 3;

/// A size, and what each phase took, s.
struct Level {
    name: String,
    unknowns: f64,
    phases: Vec<(&'static str, f64)>,
}

fn main() {
    let given: Vec<Vec<usize>> = std::env::args()
        .filter(|a| a.starts_with(|c: char| c.is_ascii_digit()))
        .map(|list| list.split(',').map(|n| n.parse().unwrap()).collect())
        .collect();
    let layers = given.first().map_or(&[2, 4, 8, 16][..], Vec::as_slice);
    let refined = given.get(1).map_or(&[0, 1, 2][..], Vec::as_slice);
    let product = 1e9 * rates::product();
    println!("a product of two 1024 x 1024 matrices: {:.1} GFLOP/s", product / 1e9);
    let layer = |n: &usize| measure(format!("{n} layers"), product, &[("laminate.layers", n)]);
    table(&layers.iter().map(layer).collect::<Vec<_>>());
    let refine = |n: &usize| measure(format!("cells over {}", 1 << n), product, &[("mesh.refine", n)]);
    table(&refined.iter().map(refine).collect::<Vec<_>>());
}

fn measure(name: String, product: f64, set: &[(&str, &usize)]) -> Level {
    let settings: Setting = set.iter().map(|(key, value)| ((*key).to_owned(), value.to_string())).collect();
    let scene = scene::under(&scene::read(Path::new(EXAMPLE)).unwrap().source, &settings).unwrap();
    let mut level = Level { name, unknowns: 0.0, phases: Vec::new() };
    for _ in 0..RUNS {
        let done = job::run(&scene, &Registry::standard(), &Options::default(), &mut ()).unwrap();
        let Found::Impact(impact) = &done.found else { continue };
        let sizes = &impact.sizes;
        level.unknowns = sizes.unknowns as f64;
        let symbolic = Symbolic::new(Arc::new(pattern(&done.model.plate, &done.model.constraints))).unwrap();
        let samples = (sizes.steps as f64 * sizes.step / done.model.sample_every).floor();
        let stresses = 2.0 * 6.0 * impact.outcome.sites as f64 * sizes.marched as f64 * samples;
        let least = [("factor", symbolic.flops() / product), ("stresses", stresses / product)];
        let phases = impact.outcome.phases.iter().map(|phase| (phase.name, phase.cpu_s));
        for (name, seconds) in phases.chain(least) {
            match level.phases.iter_mut().find(|(known, _)| *known == name) {
                Some((_, best)) => *best = best.min(seconds),
                None => level.phases.push((name, seconds)),
            }
        }
    }
    level
}

/// A row for each phase, with the slope of its logarithm over that of the unknowns (least squares).
fn table(levels: &[Level]) {
    let cells =
        |each: &dyn Fn(&Level) -> String| levels.iter().map(|level| format!(" {} |", each(level))).collect::<String>();
    println!("\n| |{} exponent |", cells(&|level| level.name.clone()));
    println!("| --- |{} --- |", cells(&|_| "---".to_owned()));
    println!("| unknowns |{} |", cells(&|level| format!("{}", level.unknowns)));
    for (name, _) in &levels[0].phases {
        let of = |level: &Level| level.phases.iter().find(|phase| phase.0 == *name).map_or(f64::NAN, |phase| phase.1);
        let count = levels.len() as f64;
        let points: Vec<[f64; 2]> = levels.iter().map(|level| [level.unknowns.ln(), of(level).ln()]).collect();
        let mean = [0, 1].map(|d| points.iter().map(|p| p[d]).sum::<f64>() / count);
        let product = |d: usize| points.iter().map(|p| (p[0] - mean[0]) * (p[d] - mean[d])).sum::<f64>();
        println!("| {name} |{} {:.2} |", cells(&|level| format!("{:.3}", of(level))), product(1) / product(0));
    }
}
