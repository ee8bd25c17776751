//! `fem list`.

use super::print;
use crate::registry::{NO_REDUCTION, Registry};
use clap::{Args, ValueEnum};
use fem_core::plugin::{Kind, PluginInfo};
use fem_io::materials::{self, LibraryMaterial};
use fem_io::scene::{self, EffectInfo};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// What to list.
    what: What,
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
    /// For `effects`.
    Effects,
    /// For `library` of a material.
    Materials,
}

pub(super) fn list(registry: &Registry, arguments: &Arguments) -> miette::Result<ExitCode> {
    let kind = match arguments.what {
        What::Elements => Kind::Element,
        What::Criteria => Kind::Criterion,
        What::ContactLaws => Kind::Contact,
        What::Integrators => Kind::Integrator,
        What::Reductions => Kind::Reduction,
        What::Effects => {
            scene::EFFECTS.iter().for_each(|info| print(&effect(info)));
            return Ok(ExitCode::SUCCESS);
        }
        What::Materials => {
            materials::names().filter_map(materials::library).for_each(|m| print(&material(m)));
            return Ok(ExitCode::SUCCESS);
        }
    };
    registry.list(kind).for_each(|info| print(&entry(info)));
    if kind == Kind::Reduction {
        print(&format!("{NO_REDUCTION:<20} the full model\n"));
    }
    Ok(ExitCode::SUCCESS)
}

fn entry(info: &PluginInfo) -> String {
    let mut text = format!("{:<20} {} [{}]\n", info.name, info.summary, info.source);
    for p in info.params {
        text.push_str(&format!("{:<20}   {}: {}\n", "", p.name, p.doc));
    }
    text
}

fn effect(EffectInfo { name, values, summary, source }: &EffectInfo) -> String {
    format!("{name:<20} {summary} [{source}]\n{:<20}   {values}\n", "")
}

fn material(material: &LibraryMaterial) -> String {
    let mut text = format!("{:<20} {}\n", material.material.name, material.summary);
    for c in &material.constants {
        text.push_str(&format!("{:<20}   {}: {}, {} [{}]\n", "", c.key, c.value, c.status, c.source));
    }
    text
}
