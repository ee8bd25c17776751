//! `fem mesh`.

use super::{Console, Format};
use crate::error::Error;
use crate::mesh::Summary;
use crate::model;
use clap::Args;
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::gmsh::{self, Encoding, GmshMesh};
use fem_io::{scene, units};
use miette::miette;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Mesh file of gmsh (MSH 4.1), or a scene (.toml) whose mesh is meant.
    file: PathBuf,
    /// Unit of the coordinates in a mesh file, of lengths that are printed, and of the file that is written.
    #[arg(long, default_value = "mm")]
    unit: String,
    /// Writes the mesh to a file (MSH 4.1), with its groups.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Writes it binary instead of as text.
    #[arg(long, requires = "out")]
    binary: bool,
    #[command(flatten)]
    format: Format,
}

pub(super) fn mesh(arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let metres = units::parse_as(&format!("1 {}", arguments.unit), Dimension::LENGTH)
        .map_err(|_| miette!(help = "write --unit mm, m or in", "`{}` is no unit of length", arguments.unit))?;
    let GmshMesh { mesh, warnings } = read(&arguments.file, metres)?;
    let summary = Summary::new(&mesh, warnings);
    if let Some(out) = &arguments.out {
        let encoding = if arguments.binary { Encoding::Binary } else { Encoding::Ascii };
        let name = out.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| miette!("`{}` is no name of a file", out.display()))?;
        let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let write = |dir: OutputDir| dir.write(name, |file| gmsh::write(file, &mesh, metres, encoding));
        OutputDir::create(folder).and_then(write).map_err(Error::from)?;
    }
    console.show(arguments.format, &summary, || {
        let mut text = format!("{}\n{}", arguments.file.display(), summary.text(&arguments.unit, metres));
        if let Some(out) = &arguments.out {
            let _ = writeln!(text, "  written   {}", out.display());
        }
        text
    })?;
    Ok(ExitCode::SUCCESS)
}

fn read(file: &Path, metres: f64) -> Result<GmshMesh, Error> {
    if file.extension().is_some_and(|extension| extension == "toml") {
        return model::mesh(&scene::read(file)?);
    }
    Ok(gmsh::read(file, metres)?)
}
