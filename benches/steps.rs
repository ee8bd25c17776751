//! What steps cost: error of the contact force over processor time for every integrator and length of the step, and for divided
//! steps: `cargo bench --bench steps`, with names of cases if not all.
//!
//! Each case is an impact on a reduced plate, which is prepared once. The force is compared at the ends of steps (L2, relative) with that of
//! `rk4` at a short step, the speed of the first impactor at the end of the march; with `--all` each march is shown. Seconds are of the
//! march alone, of one thread.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, missing_docs)]

use cpu_time::ThreadTime;
use fem::analyses::impact::{self, Prepared};
use fem::core::plugin::{Built, Kind, Params, Value};
use fem::core::time::Integrator;
use fem::dynamics::impact::ImpactSystem;
use fem::dynamics::integrate::{divided, located};
use fem::dynamics::limit::longest_step;
use fem::io::scene;
use fem::{Model, Registry};
use std::num::NonZeroUsize;
use std::path::Path;

/// Name, scene, what is replaced in it, end of the march in us, how often the step of the reference is doubled.
type Case = (&'static str, &'static str, &'static [(&'static str, &'static str)], f64, u32);

const LARGE: &str = "examples/as4-3502-16ply-50mm/scene.toml";
const STIFFNESS: &str = "k = \"1.07e5 N/mm^1.5\"";
const CASES: [Case; 6] = [
    ("large mass", LARGE, &[], 1000.0, 4),
    ("small mass", "docs/accuracy/small-mass.toml", &[], 150.0, 3),
    ("contact 100 times as stiff", LARGE, &[(STIFFNESS, "k = \"1.07e7 N/mm^1.5\"")], 1000.0, 2),
    ("contact 1e4 times as stiff", LARGE, &[(STIFFNESS, "k = \"1.07e9 N/mm^1.5\"")], 400.0, 0),
    ("two impactors", "examples/two-impactors/scene.toml", &[], 300.0, 3),
    ("membrane", LARGE, &[("[march]", "[effects]\nmembrane = \"on\"\n\n[march]")], 200.0, 5),
];

/// Steps in us are powers of two over this.
const FINEST: f64 = 1.0 / 1280.0;
const DOUBLINGS: [u32; 12] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12];
/// Of divided steps, with the length of the whole ones.
const TOLERANCES: [f64; 8] = [3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];
const WHOLE: u32 = 12;

/// Errors asked for: of the force (0) or the speed at the end (1).
const ASKED: [(&str, usize, f64); 4] =
    [("force within 1 %", 0, 1e-2), ("0.1 %", 0, 1e-3), ("0.01 %", 0, 1e-4), ("speed within 0.01 %", 1, 1e-4)];

/// One march.
struct Found {
    /// Force of all impactors at the ends of steps, N.
    forces: Vec<f64>,
    /// Speed of the first impactor at the end, m/s.
    speed: f64,
    seconds: f64,
    doublings: u32,
}

impl Found {
    /// Error of the force, L2 and relative.
    fn off(&self, exact: &Self) -> f64 {
        let each = |found: &Self, us: usize| found.forces[(us >> found.doublings) - 1];
        let coarse = self.doublings.max(exact.doublings);
        let times = (1..=(self.forces.len() << self.doublings) >> coarse).map(|k| k << coarse);
        let pairs = times.map(|time| (each(self, time), each(exact, time)));
        let [off, size] = pairs.fold([0.0, 0.0], |[off, size], (a, b)| [off + (a - b).powi(2), size + b * b]);
        (off / size).sqrt()
    }
}

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|name| !name.starts_with('-')).collect();
    for case in CASES.iter().filter(|case| asked.is_empty() || asked.iter().any(|name| case.0.contains(name))) {
        measure(case);
    }
}

fn measure((name, file, replaced, end, finest): &Case) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let text = std::fs::read_to_string(&path).unwrap();
    let text = replaced.iter().fold(text, |text, (from, to)| text.replacen(from, to, 1));
    let model = Model::new(scene::parse(&text, &path).unwrap(), &Registry::standard()).unwrap();
    let prepared = impact::prepare(&model, NonZeroUsize::MIN).unwrap();
    // So that halves of the longest step end with it.
    let end = (end / (FINEST * f64::from(1 << WHOLE))).ceil() * f64::from(1 << WHOLE);
    let [half, exact] = [1, 0].map(|more| {
        let found = march(&prepared, scheme("rk4", &[]), finest + more, end).unwrap();
        Found { doublings: finest + more, ..found }
    });
    println!("\n## {name}: {} unknowns, {:.0} us\n", prepared.sizes.marched, end * FINEST);
    println!("twice the step changes the reference by {:.0e}\n", half.off(&exact));
    println!("| integrator |{}", ASKED.map(|(title, ..)| format!(" {title} |")).concat());
    println!("| --- |{}", " --- |".repeat(ASKED.len()));
    let whole = [
        ("newmark", &[][..]),
        ("energy-conserving", &[]),
        ("generalized-alpha", &[]),
        ("hht-alpha", &[]),
        ("central-difference", &[]),
        ("rk4", &[]),
    ];
    for (name, params) in whole {
        let runs = DOUBLINGS.iter().filter(|doublings| *doublings + 1 >= *finest).filter_map(|doublings| {
            let found = march(&prepared, scheme(name, params), *doublings, end)?;
            Some((format!("{:.4} us", FINEST * f64::from(1 << doublings)), found))
        });
        row(name, &exact, runs.collect());
    }
    let longest = |name: &str| {
        let (longest, _) = longest_step(&mut prepared.copy().unwrap(), scheme(name, &[]).limit()).unwrap();
        (0..=WHOLE).rev().find(|doublings| step(*doublings) <= longest).unwrap()
    };
    for name in ["newmark", "energy-conserving", "rk4"] {
        let runs = TOLERANCES.iter().filter_map(|tolerance| {
            let found = march(&prepared, divided(scheme(name, &[]), *tolerance), longest(name), end)?;
            Some((format!("{tolerance:.0e}"), found))
        });
        row(&format!("{name}, tolerance"), &exact, runs.collect());
    }
    let runs = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3].iter().filter_map(|tolerance| {
        let params = [("tolerance", Value::Number(*tolerance))];
        let found = march(&prepared, scheme("dormand-prince", &params), WHOLE, end)?;
        Some((format!("{tolerance:.0e}"), found))
    });
    row("dormand-prince", &exact, runs.collect());
}

fn scheme(name: &str, params: &[(&'static str, Value)]) -> Box<dyn Integrator> {
    let params = params.iter().fold(Params::default(), |params, (key, value)| params.with(key, value.clone()));
    match Registry::standard().build(Kind::Integrator, name, &params) {
        Ok(Built::Integrator(integrator)) => located(integrator),
        other => panic!("{name}: {other:?}"),
    }
}

/// The step of the finest march doubled so often, s.
fn step(doublings: u32) -> f64 {
    1e-6 * FINEST * f64::from(1 << doublings)
}

/// A march with steps of `FINEST` doubled so often, to `end` of them; nothing beyond the limit of the integrator, or where it stops.
fn march(prepared: &Prepared<'_>, mut scheme: Box<dyn Integrator>, doublings: u32, end: f64) -> Option<Found> {
    let mut system: ImpactSystem = prepared.copy().unwrap();
    let dt = step(doublings);
    if dt > longest_step(&mut system, scheme.limit()).ok()?.0 {
        return None;
    }
    let mut state = system.initial();
    let start = ThreadTime::now();
    scheme.start(&mut system, &mut state).ok()?;
    let mut forces = Vec::new();
    for _ in 0..(end as u64 >> doublings) {
        scheme.step(&mut system, &mut state, dt).ok()?;
        forces.push((0..system.impactors().len()).map(|i| system.contact_force(i, &state)).sum());
    }
    let seconds = start.elapsed().as_secs_f64();
    Some(Found { forces, speed: state.v[prepared.sizes.marched], seconds, doublings })
}

/// Prints the coarsest march for each error, none finer than which has a larger one; the finest come first.
fn row(name: &str, exact: &Found, runs: Vec<(String, Found)>) {
    let runs: Vec<_> = runs
        .iter()
        .map(|(setting, found)| ([found.off(exact), ((found.speed - exact.speed) / exact.speed).abs()], found, setting))
        .collect();
    if std::env::args().any(|argument| argument == "--all") {
        for ([force, speed], found, setting) in &runs {
            println!("  {name} {setting}: {force:.1e} {speed:.1e} {:.2} ms", 1e3 * found.seconds);
        }
    }
    let cells = ASKED.map(|(_, quantity, asked)| match runs.iter().take_while(|run| run.0[quantity] <= asked).last() {
        Some((_, found, setting)) => format!(" {:.2} ms, {setting} |", 1e3 * found.seconds),
        None => " - |".to_owned(),
    });
    println!("| {name} |{}", cells.concat());
}
