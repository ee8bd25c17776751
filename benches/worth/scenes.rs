//! Impacts whose statements of their own errors are held against finer runs.

use fem::Registry;
use fem::analyses::impact::Differences;
use fem::io::scene::{self, Setting};
use fem::job::{self, Found, Options};
use fem::study::{FORCE_HISTORY, RunRecord};
use std::path::{Path, PathBuf};

/// An example, and settings of it.
type Scene = (&'static str, &'static [Variant]);
/// A name and what it sets.
pub(crate) type Variant = (&'static str, &'static [(&'static str, &'static str)]);

const AS_GIVEN: Variant = ("as given", &[]);
const FEW: Variant = ("15 vectors", &[("reduction", "{ method = 'ritz', vectors = 15 }")]);
const GOVERNORS: Variant = ("40 governors", &[("reduction", "{ method = 'guyan', governors = 40 }")]);
const THREE: Variant = ("3 governors", &[("reduction", "{ method = 'guyan', governors = 3 }")]);
const MODES: Variant = ("20 modes", &[("reduction", "{ method = 'modal', modes = 20 }")]);
const CRAIG: Variant = ("30 interface modes", &[("reduction", "{ method = 'craig-bampton', modes = 30 }")]);
const LONG_STEP: Variant = ("steps of 1 us", &[("march.step", "'1 us'")]);
const SHELL: Variant = ("mitc4", &[("element", "{ kind = 'mitc4' }"), ("laminate.layers", "1")]);
const STRETCHED: Variant = ("membrane", &[("effects.membrane", "'on'")]);
const STRETCHED_FEW: Variant =
    ("membrane, 15 vectors", &[("effects.membrane", "'on'"), ("reduction", "{ method = 'ritz', vectors = 15 }")]);
const HEAVY: Variant = ("gravity", &[("effects.gravity", "'9.81 m/s^2'")]);
const UNREDUCED: Variant =
    ("not reduced, to 0.1 ms", &[("reduction", "{ method = 'none' }"), ("march.end", "'0.1 ms'")]);
const SERENDIPITY: Variant = ("hex20", &[("element", "{ kind = 'hex20' }")]);

pub(crate) const SCENES: [Scene; 8] = [
    ("as4-3502-16ply-50mm", &[AS_GIVEN, FEW, GOVERNORS, THREE, MODES, CRAIG, LONG_STEP, SHELL, SERENDIPITY, UNREDUCED]),
    ("as4-3502-16ply-75mm", &[AS_GIVEN, FEW, LONG_STEP, SHELL, STRETCHED, HEAVY]),
    ("as4-3502-8ply-25mm", &[AS_GIVEN, FEW, GOVERNORS, LONG_STEP, SERENDIPITY, STRETCHED]),
    ("as4-3502-8ply-50mm", &[AS_GIVEN, FEW, MODES, SHELL]),
    ("as4-3502-8ply-75mm", &[AS_GIVEN, LONG_STEP, CRAIG, STRETCHED, STRETCHED_FEW]),
    ("im6-934-32ply-small-mass", &[AS_GIVEN, FEW, LONG_STEP, SHELL]),
    ("im6-934-32ply-large-mass", &[AS_GIVEN, FEW, SHELL]),
    ("im6-934-32ply-drop-weight", &[STRETCHED]),
];

/// A result, the figure of a study that it is, and its error.
type Result = (&'static str, &'static str, fn(Differences) -> f64);

/// A result, what was said of its error, and the error.
pub(crate) struct Statement {
    pub(crate) scene: String,
    pub(crate) result: &'static str,
    pub(crate) said: Option<f64>,
    pub(crate) truth: f64,
}

impl Statement {
    /// Said over true; below 1 where too little is said.
    pub(crate) fn ratio(&self) -> Option<f64> {
        self.said.map(|said| said / self.truth)
    }
}

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name).join("scene.toml")
}

fn setting(of: &[(&str, &str)]) -> Setting {
    // Nothing is asked of stresses.
    [("effects.damage", "'off'")]
        .iter()
        .chain(of)
        .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
        .collect()
}

/// All statements of a variant of an example, of which the finer runs are in `known`.
pub(crate) fn statements((name, variant): (&str, Variant), known: &mut Vec<(String, RunRecord)>) -> Vec<Statement> {
    let (scene, registry) = (scene::read(&example(name)).unwrap(), Registry::standard());
    let own = setting(variant.1);
    // What makes another plate, and not the same one less well.
    let kind: Vec<_> = variant
        .1
        .iter()
        .filter(|(key, _)| ["element", "march.end"].contains(key) || key.starts_with("effects."))
        .collect();
    let key = format!("{name} {kind:?}");
    let finer = known.iter().position(|(other, _)| *other == key).unwrap_or_else(|| {
        let mut fine = setting(&[("mesh.refine", "1"), ("reduction", "{ method = 'ritz', vectors = 160 }")]);
        fine.extend(kind.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())));
        let shell = kind.iter().any(|(_, value)| value.contains("mitc4"));
        fine.insert("laminate.layers".to_owned(), if shell { "1" } else { "4" }.to_owned());
        let step = scene.impact().unwrap().march.step.value;
        fine.insert("march.step".to_owned(), format!("'{:e} s'", 0.5 * step));
        known.push((key, RunRecord::of(&scene.source, &fine, &registry, &mut ()).unwrap()));
        known.len() - 1
    });
    let finer = &known[finer].1;
    let run = RunRecord::of(&scene.source, &own, &registry, &mut ()).unwrap();
    let found = job::run(&scene::under(&scene.source, &own).unwrap(), &registry, &Options::default(), &mut ()).unwrap();
    let Found::Impact(impact) = found.found else { return Vec::new() };
    let said: Option<Differences> = impact.outcome.accuracy.results();
    let results: [Result; 4] = [
        ("force history", FORCE_HISTORY, |d| d.force),
        ("peak force", "peak-force", |d| d.peak),
        ("impulse", "impulse", |d| d.impulse),
        ("deflection", "deflection", |d| d.deflection),
    ];
    let statement = |(result, figure, of): Result| {
        let truth = run.difference(finer, figure).unwrap().abs();
        Statement { scene: format!("{name}, {}", variant.0), result, said: said.map(of), truth }
    };
    results.into_iter().map(statement).collect()
}
