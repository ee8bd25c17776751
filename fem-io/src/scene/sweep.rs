//! What a sweep of the scene varies.

use crate::document::keys::{Form, Keys, key, words};
use crate::document::reader::SceneValue;
use crate::document::source::SceneError;
use toml_edit::Value;

/// What a scene says of sweeps of it.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSpec {
    /// Keys of the scene with what they become.
    pub set: Vec<(String, Varied)>,
    /// How cases are chosen.
    pub design: Option<Sampling>,
    /// How many cases a design of samples has.
    pub samples: usize,
    /// What random numbers follow from.
    pub seed: u64,
    /// Correlations of pairs of keys, in words.
    pub correlate: Vec<String>,
    /// Formulas of what cases set and find.
    pub quantities: Vec<String>,
    /// Two of them that are weighed against each other, in words.
    pub pareto: Option<String>,
}

impl Default for SweepSpec {
    fn default() -> Self {
        Self {
            set: Vec::new(),
            design: None,
            samples: 100,
            seed: 1,
            correlate: Vec::new(),
            quantities: Vec::new(),
            pareto: None,
        }
    }
}

/// What a key becomes in the cases of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub enum Varied {
    /// In words: a list with commas, a range `1..5:9`, a distribution.
    Words(String),
    /// One value after the other.
    Levels(Vec<String>),
}

/// How the cases of a sweep are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// Every value of a key with every value of the others.
    Grid,
    /// Independent random numbers.
    Random,
    /// One random number in each of as many parts of equal probability as there are cases, for every key.
    LatinHypercube,
    /// Sobol's sequence, scrambled: the parts of equal probability of several keys together are filled evenly.
    Sobol,
    /// Blocks of it from which Sobol's indices follow (Saltelli et al. 2010): two more cases than keys for each sample.
    Saltelli,
}

impl Sampling {
    /// All of them by name.
    pub const ALL: [(&'static str, Self); 5] = [
        ("grid", Self::Grid),
        ("random", Self::Random),
        ("latin-hypercube", Self::LatinHypercube),
        ("sobol", Self::Sobol),
        ("saltelli", Self::Saltelli),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, of)| *of == self).map_or("", |(name, _)| name)
    }
}

pub(super) const KEYS: Keys = &[
    key(
        "set",
        Form::Setting,
        r#"{ impactor.velocity = "1..5:9", materials.as4-3502.Yt = "normal(50 MPa, 8 %)" }"#,
        "keys of the scene with what they become: a list, a range, a distribution",
    ),
    key(
        "design",
        Form::Words(&words(&Sampling::ALL)),
        r#""sobol""#,
        "how cases are chosen: by default a grid, or `random` of distributions",
    ),
    key("samples", Form::Count(1), "200", "how many cases a design of samples has").default("100"),
    key("seed", Form::Count(0), "1", "what random numbers follow from").default("1"),
    key(
        "correlate",
        Form::List(&Form::Text),
        r#"["materials.as4-3502.Yt, materials.as4-3502.S12 = 0.6"]"#,
        "correlations of pairs of keys that scatter, between -1 and 1",
    ),
    key(
        "quantities",
        Form::List(&Form::Text),
        r#"["lost = absorbed_energy / energy"]"#,
        "formulas of columns of the table and keys that vary, each a column of its own",
    ),
    key(
        "pareto",
        Form::Text,
        r#""least deflection, most damage_force""#,
        "two quantities that cases are weighed by: those that no other case beats are marked and drawn",
    ),
];

pub(super) fn read(field: &SceneValue<'_>) -> Result<SweepSpec, SceneError> {
    let table = field.table(KEYS)?;
    let plain = SweepSpec::default();
    let set = |field: SceneValue<'_>| {
        let help = "write keys of the scene with what they become: { impactor.velocity = \"1..5:9\" }";
        let setting = field.any_table()?.setting().filter(|keys| !keys.is_empty());
        let setting = setting.ok_or_else(|| field.error("sets nothing", help))?;
        let each = |(key, value): (String, String)| (key, varied(&value));
        Ok::<_, SceneError>(setting.into_iter().map(each).collect())
    };
    Ok(SweepSpec {
        set: table.optional("set").map(set).transpose()?.unwrap_or_default(),
        design: table.optional("design").map(|field| field.choice(&Sampling::ALL)).transpose()?,
        samples: table.optional("samples").map(|field| field.count()).transpose()?.unwrap_or(plain.samples),
        correlate: table.optional("correlate").map(texts).transpose()?.unwrap_or_default(),
        quantities: table.optional("quantities").map(texts).transpose()?.unwrap_or_default(),
        pareto: table.optional("pareto").map(|field| Ok(field.text()?.to_owned())).transpose()?,
        seed: table.optional("seed").map(|field| field.at_least(0)).transpose()?.map_or(plain.seed, |seed| seed as u64),
    })
}

fn texts(field: SceneValue<'_>) -> Result<Vec<String>, SceneError> {
    field.list()?.iter().map(|text| Ok(text.text()?.to_owned())).collect()
}

/// A value of TOML: texts in words, the items of a list as levels, anything else as its only level.
fn varied(toml: &str) -> Varied {
    let plain = |value: &Value| value.as_str().map_or_else(|| value.to_string().trim().to_owned(), str::to_owned);
    match toml.parse::<Value>() {
        Ok(Value::String(words)) => Varied::Words(words.value().clone()),
        Ok(Value::Array(items)) => Varied::Levels(items.iter().map(plain).collect()),
        _ => Varied::Levels(vec![toml.trim().to_owned()]),
    }
}
