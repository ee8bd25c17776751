//! `fem list`.

use super::{Console, Format};
use crate::registry::Registry;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use fem_core::element::Tables;
use fem_core::material::{Material, Strength, Toughness};
use fem_core::plugin::{Built, Kind, ParamDefault, ParamForm, ParamInfo, Params, PluginInfo};
use fem_io::materials::{self, LibraryMaterial};
use fem_io::scene::{Absent, EFFECT_SETTINGS, Form, Key};
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Bound;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  fem list contact-laws\n  fem list materials --complete-for delamination")]
pub(super) struct Arguments {
    /// What to list.
    #[arg(value_parser = topics())]
    what: String,
    /// Only materials that give all that this needs.
    #[arg(long, value_name = "USE", value_parser = uses())]
    complete_for: Option<String>,
    #[command(flatten)]
    format: Format,
}

const EFFECTS: &str = "effects";
const MATERIALS: &str = "materials";

/// The kinds of plug-ins, effects and materials, each with where a scene names one.
fn topics() -> PossibleValuesParser {
    let kinds = Kind::ALL.iter().map(|kind| (kind.plural(), kind.purpose()));
    let others = [(EFFECTS, "`effects`"), (MATERIALS, "`library` of a material")];
    let topic = |(name, purpose)| PossibleValue::new(name).help(format!("For {purpose}"));
    kinds.chain(others).map(topic).collect::<Vec<_>>().into()
}

/// What materials may be used for.
struct Use {
    name: &'static str,
    needs: &'static str,
    strengths: &'static [Strength],
    toughnesses: &'static [Toughness],
    others: fn(&Material) -> bool,
}

impl Use {
    /// Whether a material gives all that it needs.
    fn is_met(&self, material: &Material) -> bool {
        let Self { strengths, toughnesses, others, .. } = self;
        material.require(strengths, "").is_ok()
            && material.require_toughness(toughnesses, "").is_ok()
            && others(material)
    }
}

const OF_PLIES: &[Strength] = &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23];

const USES: [Use; 5] = [
    Use {
        name: "impact",
        needs: "a plate that moves: density",
        strengths: &[],
        toughnesses: &[],
        others: |material| material.density.is_some(),
    },
    Use {
        name: "failure",
        needs: "criteria of plies: Xt Xc Yt Yc S12 S23",
        strengths: OF_PLIES,
        toughnesses: &[],
        others: |_| true,
    },
    Use {
        name: "delamination",
        needs: "interfaces that open: Zt S13 GIc GIIc",
        strengths: &[Strength::Zt, Strength::S13],
        toughnesses: &[Toughness::GIc, Toughness::GIIc],
        others: |_| true,
    },
    Use {
        name: "damage",
        needs: "plies that crack: strengths as for failure, Gft Gfc Gmt Gmc",
        strengths: OF_PLIES,
        toughnesses: &[Toughness::Gft, Toughness::Gfc, Toughness::Gmt, Toughness::Gmc],
        others: |_| true,
    },
    Use {
        name: "cure",
        needs: "residual stresses: thermal expansion",
        strengths: &[],
        toughnesses: &[],
        others: |material| material.expansion.is_some(),
    },
];

fn uses() -> PossibleValuesParser {
    USES.iter().map(|of| PossibleValue::new(of.name).help(of.needs)).collect::<Vec<_>>().into()
}

/// A thing that a scene can name.
#[derive(Serialize)]
struct Entry {
    name: &'static str,
    summary: &'static str,
    #[serde(skip_serializing_if = "str::is_empty")]
    source: &'static str,
    #[serde(skip_serializing_if = "String::is_empty")]
    values: String,
    /// Shapes of plane cells that an element stands on.
    #[serde(skip_serializing_if = "str::is_empty")]
    stands_on: &'static str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parameters: Vec<Parameter>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    constants: Vec<Constant>,
}

#[derive(Serialize)]
struct Parameter {
    name: &'static str,
    about: &'static str,
    #[serde(rename = "type")]
    form: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    choices: Vec<&'static str>,
    #[serde(flatten)]
    range: BTreeMap<&'static str, f64>,
    required: bool,
    /// As a scene writes it.
    #[serde(skip_serializing_if = "Option::is_none")]
    default: Option<String>,
    /// For people.
    #[serde(skip)]
    text: String,
}

#[derive(Serialize)]
struct Constant {
    name: &'static str,
    value: &'static str,
    status: String,
    source: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<&'static [String; 2]>,
}

pub(super) fn list(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let wanted = arguments.complete_for.as_ref().and_then(|wanted| USES.iter().find(|of| of.name == wanted));
    if wanted.is_some() && arguments.what != MATERIALS {
        return Err(miette::miette!(
            help = "fem list materials --complete-for delamination",
            "`--complete-for` is of materials, not of {}",
            arguments.what
        ));
    }
    let entries: Vec<Entry> = match arguments.what.as_str() {
        EFFECTS => {
            let settings = EFFECT_SETTINGS.iter().map(|setting| Entry::effect(&setting.key, setting.source));
            settings.chain(registry.effects().map(|info| Entry::effect(&info.key, info.source))).collect()
        }
        MATERIALS => {
            let complete = |m: &&LibraryMaterial| wanted.is_none_or(|of| of.is_met(&m.material));
            materials::names().filter_map(materials::library).filter(complete).map(Entry::from).collect()
        }
        plural => {
            let kinds = Kind::ALL.iter().filter(|kind| kind.plural() == plural);
            let entry = |info: PluginInfo| Entry { stands_on: stands_on(registry, &info), ..Entry::from(&info) };
            kinds.flat_map(|kind| registry.choices(*kind)).map(entry).collect()
        }
    };
    console.show_plain(arguments.format, &entries, || entries.iter().map(Entry::text).collect())?;
    Ok(ExitCode::SUCCESS)
}

impl Entry {
    fn new(name: &'static str, summary: &'static str, source: &'static str) -> Self {
        Self {
            name,
            summary,
            source,
            values: String::new(),
            stands_on: "",
            parameters: Vec::new(),
            constants: Vec::new(),
        }
    }

    fn text(&self) -> String {
        let Self { name, summary, source, .. } = self;
        let source = if source.is_empty() { String::new() } else { format!(" [{source}]") };
        let mut lines = vec![format!("{name:<20} {summary}{source}")];
        lines.extend(Some(&self.values).filter(|v| !v.is_empty()).map(|values| format!("{:<20}   {values}", "")));
        let stands_on = Some(self.stands_on).filter(|cells| !cells.is_empty());
        lines.extend(stands_on.map(|cells| format!("{:<20}   stands on {cells}", "")));
        lines.extend(self.parameters.iter().map(|p| format!("{:<20}   {}: {}", "", p.name, p.text)));
        let constant = |c: &Constant| {
            let range = c.range.map_or_else(String::new, |[low, high]| format!(" ({low} to {high})"));
            format!("{:<20}   {}: {}{range}, {} [{}]", "", c.name, c.value, c.status, c.source)
        };
        lines.extend(self.constants.iter().map(constant));
        lines.join("\n") + "\n"
    }
}

/// The shapes of plane cells that an element stands on; nothing for what is none, or needs parameters.
fn stands_on(registry: &Registry, info: &PluginInfo) -> &'static str {
    match registry.build(info.kind, info.name, &Params::default()) {
        Ok(Built::Element(element)) => Tables::from(&*element).cells(),
        _ => "",
    }
}

impl From<&PluginInfo> for Entry {
    fn from(info: &PluginInfo) -> Self {
        let parameters = info.params.iter().map(Parameter::from).collect();
        Self { parameters, ..Self::new(info.name, info.summary, info.source) }
    }
}

impl From<&ParamInfo> for Parameter {
    fn from(row: &ParamInfo) -> Self {
        let (form, choices) = match row.form {
            ParamForm::Number => ("number", Vec::new()),
            ParamForm::Count => ("count", Vec::new()),
            ParamForm::Quantity(_) => ("quantity", Vec::new()),
            ParamForm::Word(words) => ("word", words.iter().map(|(word, _)| *word).collect()),
            ParamForm::Flag => ("flag", Vec::new()),
            ParamForm::Texts => ("texts", Vec::new()),
        };
        let least = match row.range.0 {
            Bound::Included(v) => Some(("at_least", v)),
            Bound::Excluded(v) => Some(("above", v)),
            Bound::Unbounded => None,
        };
        let most = match row.range.1 {
            Bound::Included(v) => Some(("at_most", v)),
            Bound::Excluded(v) => Some(("below", v)),
            Bound::Unbounded => None,
        };
        Self {
            name: row.name,
            about: row.about,
            form,
            unit: row.dimension().map(|dimension| dimension.to_string()),
            choices,
            range: least.into_iter().chain(most).collect(),
            required: row.default == ParamDefault::Required,
            default: row.default_value().map(|value| value.in_scene()),
            text: row.to_string(),
        }
    }
}

impl Entry {
    fn effect(key: &Key, source: &'static str) -> Self {
        Self { values: values(key), ..Self::new(key.name, key.about, source) }
    }
}

/// What a key may be set to; what holds without it comes first.
fn values(key: &Key) -> String {
    let mut values = values_of(&key.form, key.example);
    if let Absent::Default(default) = key.absent {
        values.sort_by_key(|value| value != default);
    }
    values.join(", ")
}

fn values_of(form: &Form, example: &str) -> Vec<String> {
    match form {
        Form::Words(words) => words.iter().map(|word| format!("\"{word}\"")).collect(),
        Form::OneOf(forms) => forms.iter().flat_map(|form| values_of(form, example)).collect(),
        Form::Table(keys) => {
            let names: Vec<_> = keys.iter().map(|key| key.name).collect();
            vec![format!("{{ {} }}", names.join(", "))]
        }
        _ => vec![format!("such as {example}")],
    }
}

impl From<&'static LibraryMaterial> for Entry {
    fn from(material: &'static LibraryMaterial) -> Self {
        let constant = |c: &'static materials::Constant| Constant {
            name: &c.key,
            value: &c.value,
            status: c.status.to_string(),
            source: &c.source,
            range: c.range.as_ref(),
        };
        let constants = material.constants.iter().map(constant).collect();
        Self { constants, ..Self::new(&material.material.name, &material.summary, "") }
    }
}
