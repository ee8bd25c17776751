//! `fem new`.

use super::{Console, Format};
use crate::error::Error;
use crate::model::Model;
use crate::registry::Registry;
use clap::Args;
use fem_core::plugin::unknown_key;
use fem_io::{materials, scene, tables};
use miette::{Context as _, IntoDiagnostic, miette};
use serde::Serialize;
use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem new coupon --template drop-weight && fem run coupon/scene.toml")]
pub(super) struct Arguments {
    /// Folder to create; it must not exist yet.
    #[arg(value_name = "NAME", required_unless_present = "list")]
    folder: Option<PathBuf>,
    /// What the scene begins with, see --list.
    #[arg(long, value_name = "TEMPLATE", default_value = "drop-weight")]
    template: String,
    /// Material of the plies, one of the library (`fem list materials`), instead of the template's.
    #[arg(long, value_name = "MATERIAL")]
    material: Option<String>,
    /// Lists the templates.
    #[arg(long, conflicts_with = "folder")]
    list: bool,
    #[command(flatten)]
    format: Format,
}

/// A scene to begin with.
#[derive(Debug, Serialize)]
struct Template {
    name: &'static str,
    summary: &'static str,
    #[serde(skip)]
    scene: &'static str,
    #[serde(skip)]
    mesh: Option<&'static [u8]>,
}

const TEMPLATES: &[Template] = &[
    Template {
        name: "drop-weight",
        summary: "a falling mass of some kilograms on a supported rectangle: low velocity, long contact",
        scene: include_str!("templates/drop-weight.toml"),
        mesh: None,
    },
    Template {
        name: "astm-d7136",
        summary: "the drop-weight test of ASTM D7136: a window of 125 x 75 mm, four clamps, a tip of 16 mm, 6.7 J/mm",
        scene: include_str!("templates/astm-d7136.toml"),
        mesh: None,
    },
    Template {
        name: "aitm-1-0010",
        summary: "the impact of AITM 1-0010: the fixture of ASTM D7136, 2 kg with 30 J",
        scene: include_str!("templates/aitm-1-0010.toml"),
        mesh: None,
    },
    Template {
        name: "astm-d6264",
        summary: "quasi-static indentation after ASTM D6264: an opening of 125 mm, a tip of 12.7 mm, 4 J/mm",
        scene: include_str!("templates/astm-d6264.toml"),
        mesh: None,
    },
    Template {
        name: "ball",
        summary: "a small steel ball on a clamped plate: over before waves come back from the edge",
        scene: include_str!("templates/ball.toml"),
        mesh: None,
    },
    Template {
        name: "ring",
        summary: "a mass on a plate that lies on a ring, with a mesh of gmsh: a case of AFWAL-TR-87-4117",
        scene: include_str!("templates/ring.toml"),
        mesh: Some(include_bytes!("../../examples/as4-3502-16ply-50mm/plate.msh")),
    },
    Template {
        name: "pagano",
        summary: "a thick laminate under a sinusoidal pressure at rest: stresses through the thickness",
        scene: include_str!("templates/pagano.toml"),
        mesh: None,
    },
    Template {
        name: "modes",
        summary: "the lowest natural frequencies of a clamped plate",
        scene: include_str!("templates/modes.toml"),
        mesh: None,
    },
];

/// How a template names the material of its plies.
const TAPE: &str = "[materials.tape]\nlibrary = \"";

impl Template {
    /// Its scene, with the plies of this material of the library, where it runs with that.
    fn with(&self, material: Option<&str>, registry: &Registry) -> miette::Result<Cow<'static, str>> {
        let Some(material) = material else { return Ok(self.scene.into()) };
        if materials::library(material).is_none() {
            let hint = unknown_key(material, materials::names());
            return Err(miette!(help = format!("`{material}` {hint}"), "the library has no material `{material}`"));
        }
        let (before, after) = self.scene.split_once(TAPE).ok_or_else(|| {
            miette!(
                help = "change it in the scene",
                "the plies of the template `{}` have a material of their own",
                self.name
            )
        })?;
        let end = after.find('"').unwrap_or(after.len());
        let scene = format!("{before}{TAPE}{material}{}", &after[end..]);
        let runs =
            scene::parse(&scene, SCENE.as_ref()).map_err(Error::from).and_then(|scene| Model::new(scene, registry));
        runs.wrap_err_with(|| format!("the template `{}` does not run with `{material}`", self.name))?;
        Ok(scene.into())
    }
}

/// What is written, and where.
#[derive(Debug, Serialize)]
struct Written<'a> {
    template: &'static str,
    folder: &'a Path,
    files: Vec<&'static str>,
}

pub(super) fn new(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let Some(folder) = &arguments.folder else {
        let line = |t: &Template| format!("{:<20} {}\n", t.name, t.summary);
        console.show_plain(arguments.format, &TEMPLATES, || TEMPLATES.iter().map(line).collect())?;
        return Ok(ExitCode::SUCCESS);
    };
    let asked = &arguments.template;
    let template = TEMPLATES.iter().find(|template| template.name == *asked).ok_or_else(|| {
        let hint = unknown_key(asked, TEMPLATES.iter().map(|template| template.name));
        miette!(help = format!("`{asked}` {hint}"), "there is no template `{asked}`")
    })?;
    let written = Written { template: template.name, folder, files: write(registry, template, arguments, folder)? };
    console.show(arguments.format, &written, || {
        let scene = folder.join(SCENE);
        format!("{}: {}\n  to run it: fem run {}\n", template.name, written.files.join(", "), scene.display())
    })?;
    Ok(ExitCode::SUCCESS)
}

const SCENE: &str = "scene.toml";
const SCHEMA: &str = "scene.schema.json";
const MESH: &str = "plate.msh";

/// Writes the folder, whole or not at all.
fn write(
    registry: &Registry,
    template: &Template,
    arguments: &Arguments,
    folder: &Path,
) -> miette::Result<Vec<&'static str>> {
    if folder.symlink_metadata().is_ok() {
        let help = "choose another name, or remove it yourself";
        return Err(miette!(help = help, "`{}` exists already and is not overwritten", folder.display()));
    }
    let (plugins, effects) = (|kind| registry.choices(kind), registry.effect_keys());
    let scene = format!(
        "#:schema ./{SCHEMA}\n{}",
        scene::annotate(&template.with(arguments.material.as_deref(), registry)?, &plugins, &effects)?
    );
    let schema = tables::json_text(SCHEMA, &scene::schema(&plugins, &effects)).into_diagnostic()?;
    let mut files = vec![(SCENE, scene.as_bytes()), (SCHEMA, schema.as_bytes())];
    files.extend(template.mesh.map(|mesh| (MESH, mesh)));

    let name = folder.file_name().ok_or_else(|| miette!("`{}` cannot name a folder", folder.display()))?;
    let mut partial = std::ffi::OsString::from(".");
    partial.push(name);
    partial.push(format!(".{}.partial", std::process::id()));
    let partial = folder.with_file_name(partial);
    let put = || {
        fs::create_dir_all(folder.with_file_name(""))?;
        // Not all of it: what has that name already is somebody else's.
        fs::create_dir(&partial)?;
        files.iter().try_for_each(|(name, bytes)| fs::write(partial.join(name), bytes))?;
        fs::rename(&partial, folder)
    };
    let made = put().into_diagnostic().wrap_err_with(|| format!("cannot write the folder `{}`", folder.display()));
    if made.is_err() {
        // What is left of a failure is of no use to anyone.
        let _ = fs::remove_dir_all(&partial);
    }
    made.map(|()| files.iter().map(|(name, _)| *name).collect())
}
