//! `fem mesh`.

use super::{Console, Format, SceneFile};
use crate::error::Error;
use crate::model;
use crate::output::mesh::MeshSummary;
use clap::Args;
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::gmsh::{self, Encoding};
use fem_io::meshes::{self, Examined, FileMesh};
use fem_io::scene::ImpactPoint;
use fem_io::{plot, units};
use miette::miette;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem mesh coupon/scene.toml --picture")]
pub(super) struct Arguments {
    /// Mesh file of gmsh, Abaqus (.inp) or Nastran (.bdf), or a scene (.toml) whose mesh is meant.
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
    /// Draws the cells, the groups, where a scene's impactors strike and where cells do not meet as they should, as SVG and PNG in this folder [default: .]
    #[arg(long, value_name = "DIR", num_args = 0..=1, default_missing_value = ".")]
    picture: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

pub(super) fn mesh(arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let metres = units::parse_as(&format!("1 {}", arguments.unit), Dimension::LENGTH)
        .map_err(|_| miette!(help = "write --unit mm, m or in", "`{}` is not a unit of length", arguments.unit))?;
    let (examined, impacts) = read(&arguments.file, metres)?;
    let draw = |folder: &PathBuf| draw(&arguments.file, folder, &examined, &impacts);
    let picture = arguments.picture.as_ref().map(draw).transpose()?;
    let FileMesh { mesh, warnings } = match examined.sound() {
        Ok(read) => read,
        Err(refusal) => {
            for file in picture.iter().flatten() {
                console.say(arguments.format, || format!("  written   {}\n", file.display()));
            }
            return Err(Error::from(refusal).into());
        }
    };
    let summary = MeshSummary::new(&mesh, warnings);
    if let Some(out) = &arguments.out {
        let encoding = if arguments.binary { Encoding::Binary } else { Encoding::Ascii };
        let name = out.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| miette!("`{}` cannot name a file", out.display()))?;
        let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let write = |dir: OutputDir| dir.write(name, |file| gmsh::write(file, &mesh, metres, encoding));
        OutputDir::open(folder).and_then(write).map_err(Error::from)?;
    }
    console.show(arguments.format, &summary, || {
        let mut text = format!("{}\n{}", arguments.file.display(), summary.text(&arguments.unit, metres));
        for file in arguments.out.iter().chain(picture.iter().flatten()) {
            let _ = writeln!(text, "  written   {}", file.display());
        }
        text
    })?;
    Ok(ExitCode::SUCCESS)
}

/// The mesh, and the points that impactors of a scene strike, m.
fn read(file: &Path, metres: f64) -> Result<(Examined, Vec<[f64; 2]>), Error> {
    if file.as_os_str() != "-" && file.extension().is_none_or(|extension| extension != "toml") {
        return Ok((meshes::examine(file, metres, &[])?, Vec::new()));
    }
    let scene = SceneFile { path: file.to_owned(), set: Vec::new() }.read()?;
    let examined = model::examined_mesh(&scene)?;
    let mesh = &examined.read.mesh;
    let impactors = scene.impact().map_or(&[][..], |impact| &impact.impactors);
    let struck = impactors.iter().filter_map(|impactor| match &impactor.at.value {
        ImpactPoint::Point(point) => Some(*point),
        ImpactPoint::Group(name) => {
            let node = mesh.groups.get(name)?.nodes.first()?;
            Some(mesh.points[*node as usize])
        }
    });
    let struck = struck.collect();
    Ok((examined, struck))
}

/// Draws the mesh of `file` into `folder`, and what is wrong with it; the files.
fn draw(file: &Path, folder: &Path, examined: &Examined, impacts: &[[f64; 2]]) -> Result<[PathBuf; 2], Error> {
    let name = file.file_stem().map_or("mesh".into(), |stem| stem.to_string_lossy());
    let map = plot::mesh_map(&file.display().to_string(), &examined.read.mesh, impacts, &examined.flaws);
    let picture = plot::map_plot(&map)?;
    picture.write(&OutputDir::open(folder)?, &name)?;
    Ok(["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}"))))
}
