//! `fem list`.

use super::{Console, Format};
use crate::registry::Registry;
use clap::{Args, ValueEnum};
use fem_core::plugin::{Kind, ParamInfo, PluginInfo};
use fem_io::materials::{self, LibraryMaterial};
use fem_io::scene::{self, EffectInfo};
use serde::Serialize;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem list contact-laws")]
pub(super) struct Arguments {
    /// What to list.
    what: What,
    #[command(flatten)]
    format: Format,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum What {
    /// For `element.kind`.
    Elements,
    /// For `failure.criteria`.
    Criteria,
    /// For `contact.law`.
    ContactLaws,
    /// For `march.integrator`.
    Integrators,
    /// For `reduction.method`.
    Reductions,
    /// For `law` of a material.
    PlyLaws,
    /// For the interfaces between plies.
    InterfaceLaws,
    /// For `effects`.
    Effects,
    /// For `library` of a material.
    Materials,
}

/// A thing that a scene can name.
#[derive(Serialize)]
struct Entry {
    name: &'static str,
    summary: &'static str,
    #[serde(skip_serializing_if = "str::is_empty")]
    source: &'static str,
    #[serde(skip_serializing_if = "str::is_empty")]
    values: &'static str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parameters: Vec<Parameter>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    constants: Vec<Constant>,
}

#[derive(Serialize)]
struct Parameter {
    name: &'static str,
    about: &'static str,
}

#[derive(Serialize)]
struct Constant {
    name: &'static str,
    value: &'static str,
    status: String,
    source: &'static str,
}

pub(super) fn list(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let kind = |kind| registry.choices(kind).iter().map(Entry::from).collect();
    let entries: Vec<Entry> = match arguments.what {
        What::Elements => kind(Kind::Element),
        What::Criteria => kind(Kind::Criterion),
        What::ContactLaws => kind(Kind::Contact),
        What::Integrators => kind(Kind::Integrator),
        What::Reductions => kind(Kind::Reduction),
        What::PlyLaws => kind(Kind::PlyLaw),
        What::InterfaceLaws => kind(Kind::InterfaceLaw),
        What::Effects => scene::EFFECTS.iter().map(Entry::from).collect(),
        What::Materials => materials::names().filter_map(materials::library).map(Entry::from).collect(),
    };
    console.show(arguments.format, &entries, || entries.iter().map(Entry::text).collect())?;
    Ok(ExitCode::SUCCESS)
}

impl Entry {
    fn new(name: &'static str, summary: &'static str, source: &'static str) -> Self {
        Self { name, summary, source, values: "", parameters: Vec::new(), constants: Vec::new() }
    }

    fn text(&self) -> String {
        let Self { name, summary, source, .. } = self;
        let source = if source.is_empty() { String::new() } else { format!(" [{source}]") };
        let mut lines = vec![format!("{name:<20} {summary}{source}")];
        lines.extend(Some(self.values).filter(|v| !v.is_empty()).map(|values| format!("{:<20}   {values}", "")));
        lines.extend(self.parameters.iter().map(|p| format!("{:<20}   {}: {}", "", p.name, p.about)));
        let constant = |c: &Constant| format!("{:<20}   {}: {}, {} [{}]", "", c.name, c.value, c.status, c.source);
        lines.extend(self.constants.iter().map(constant));
        lines.join("\n") + "\n"
    }
}

impl From<&PluginInfo> for Entry {
    fn from(info: &PluginInfo) -> Self {
        let parameter = |p: &ParamInfo| Parameter { name: p.name, about: p.doc };
        let parameters = info.params.iter().map(parameter).collect();
        Self { parameters, ..Self::new(info.name, info.summary, info.source) }
    }
}

impl From<&EffectInfo> for Entry {
    fn from(info: &EffectInfo) -> Self {
        Self { values: info.values, ..Self::new(info.name, info.summary, info.source) }
    }
}

impl From<&'static LibraryMaterial> for Entry {
    fn from(material: &'static LibraryMaterial) -> Self {
        let constant = |c: &'static materials::Constant| Constant {
            name: &c.key,
            value: &c.value,
            status: c.status.to_string(),
            source: &c.source,
        };
        let constants = material.constants.iter().map(constant).collect();
        Self { constants, ..Self::new(&material.material.name, &material.summary, "") }
    }
}
