//! What each effect of an impact costs: `cargo bench --bench effects`.
//!
//! Shipped examples with each effect off and on, alone and together: a Markdown table of processor time and largest memory of a
//! whole run, one thread. Every run is a process of its own, because a process never gives back what it held; the fastest
//! of several counts.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use cpu_time::ProcessTime;
use fem::analyses::impact;
use fem::io::scene;
use fem::{Model, Registry};
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::Command;

const EXAMPLES: [&str; 2] = ["as4-3502-16ply-50mm", "im6-934-32ply-drop-weight"];

/// Runs of each, one after the other, so that a busy machine is busy for all.
const SAMPLES: usize = 4;

/// Keys of a scene and their values.
type Keys = &'static [(&'static str, &'static str)];

const RATIO: (&str, &str) = ("effects.damping", "{ ratio = 0.02 }");
const RAYLEIGH: (&str, &str) = ("effects.damping", "{ mass = \"30 1/s\", stiffness = \"2e-8 s\" }");
const GRAVITY: (&str, &str) = ("effects.gravity", "\"9.81 m/s^2\"");
const NO_INERTIA: (&str, &str) = ("effects.inertia", "\"off\"");
const MEMBRANE: (&str, &str) = ("effects.membrane", "\"on\"");
const NO_ONSET: (&str, &str) = ("effects.damage", "\"off\"");
const NO_DELAMINATION: (&str, &str) = ("effects.delamination", "\"off\"");

const VARIANTS: [(&str, Keys); 12] = [
    ("as shipped", &[]),
    ("damage off", &[NO_ONSET, NO_DELAMINATION]),
    ("delamination off", &[NO_DELAMINATION]),
    ("damping by ratio", &[RATIO]),
    ("damping by Rayleigh", &[RAYLEIGH]),
    ("gravity", &[GRAVITY]),
    ("damping and gravity", &[RATIO, GRAVITY]),
    ("inertia off", &[NO_INERTIA]),
    ("inertia and damage off", &[NO_INERTIA, NO_ONSET, NO_DELAMINATION]),
    ("membrane", &[MEMBRANE]),
    ("membrane, damage off", &[MEMBRANE, NO_ONSET, NO_DELAMINATION]),
    ("membrane, damping and gravity", &[MEMBRANE, RATIO, GRAVITY]),
];

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, example, variant] = &arguments[..]
        && let Ok(variant) = variant.parse::<usize>()
    {
        return measure(example, VARIANTS[variant].1);
    }
    println!("| example | effects | time, s | relative | memory, MB |\n| --- | --- | ---: | ---: | ---: |");
    for example in EXAMPLES {
        let mut least = [[f64::INFINITY; 2]; VARIANTS.len()];
        for number in (0..SAMPLES).flat_map(|_| 0..VARIANTS.len()) {
            let sample = process(example, number);
            least[number].iter_mut().zip(sample).for_each(|(least, value)| *least = least.min(value));
        }
        let shipped = least[0][0];
        for ((name, _), [seconds, memory]) in VARIANTS.iter().zip(least) {
            println!("| {example} | {name} | {seconds:.3} | {:.2} | {memory:.0} |", seconds / shipped);
        }
    }
}

/// Seconds and megabytes of a run in a process of its own.
fn process(example: &str, variant: usize) -> [f64; 2] {
    let this = std::env::current_exe().unwrap();
    let output = Command::new(this).args([example, &variant.to_string()]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let mut numbers = text.split_whitespace().map(|word| word.parse().unwrap());
    [numbers.next().unwrap(), numbers.next().unwrap()]
}

/// Runs an example with other keys; prints seconds and megabytes.
fn measure(example: &str, keys: Keys) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(example).join("scene.toml");
    let setting = keys.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let started = ProcessTime::now();
    let model = Model::new(scene::under(&scene::read(&path).unwrap().source, &setting).unwrap(), &Registry::standard())
        .unwrap();
    let outcome = impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
    let seconds = started.elapsed().as_secs_f64();
    assert_eq!(outcome.stopped, None);
    println!("{seconds} {}", peak_memory());
}

/// Largest memory that the process has held so far, MB.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kb| kb.parse().ok()).map_or(f64::NAN, |kb: f64| kb * 1024.0 / 1e6)
}
