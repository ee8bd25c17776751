//! `fem envelope`.

use super::{Console, Format};
use crate::envelope::{self, MaterialEnvelopes};
use crate::registry::Registry;
use clap::Args;
use fem_failure::envelope::StressPlane;
use fem_io::files::OutputDir;
use fem_io::plot::{self, Axis, LinePlot, Series, Style};
use fem_io::scene;
use fem_io::tables::{self, EnvelopeRow};
use miette::IntoDiagnostic;
use serde::Serialize;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "Example: fem envelope AS4/3502 --criteria puck,tsai-wu:f12=-0.3 --plane s2-s12")]
pub(super) struct Arguments {
    /// The material: a name of the library or, with --scene, of the scene.
    material: String,
    /// Criteria by name, parameters after colons [default: those of the scene]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', required_unless_present = "scene")]
    criteria: Vec<String>,
    /// Two of s1, s2, s3, s12, s23, s13; the other stresses are zero.
    #[arg(long, default_value = "s2-s12")]
    plane: StressPlane,
    /// A scene whose materials can be named, and whose criteria with their parameters.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Folder of the results [default: results/envelope-<material>-<plane>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    format: Format,
}

/// What is found, as envelope.csv holds it, and where that lies.
#[derive(Serialize)]
struct Document<'a> {
    material: &'a str,
    plane: String,
    envelope: Vec<Map<String, Value>>,
    results: &'a Path,
}

/// Where the picture of an envelope that is open towards some stresses ends, over the largest strength of each axis.
const FAR: f64 = 3.0;

pub(super) fn envelope(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let scene = arguments.scene.as_deref().map(scene::read).transpose()?;
    let material = envelope::material(&arguments.material, scene.as_ref())?;
    let criteria = envelope::criteria(registry, &arguments.criteria, scene.as_ref())?;
    let found = MaterialEnvelopes::new(material, criteria, arguments.plane)?;

    let folder = || format!("results/envelope-{}-{}", file_name(&material.name), found.plane).into();
    let dir = OutputDir::create(arguments.out.clone().unwrap_or_else(folder)).into_diagnostic()?;
    let rows = found.rows();
    tables::write_envelopes(&dir, &rows).into_diagnostic()?;
    plot::line_plot(&picture(&found)).into_diagnostic()?.write(&dir, "envelope").into_diagnostic()?;
    let data = Document {
        material: &material.name,
        plane: found.plane.to_string(),
        envelope: rows.iter().map(EnvelopeRow::named).collect(),
        results: dir.path(),
    };
    console.show(arguments.format, &data, || format!("{}  results   {}\n", summary(&found), dir.path().display()))?;
    Ok(ExitCode::SUCCESS)
}

/// One curve per criterion, in pieces where it is open; every other one dashed, so that equal ones are both seen.
fn picture(found: &MaterialEnvelopes<'_>) -> LinePlot {
    let mut series = Vec::new();
    for (k, ((name, _), curve)) in found.criteria.iter().zip(&found.curves).enumerate() {
        let style = if k % 2 == 0 { Style::Solid } else { Style::Dashed };
        for piece in curve.split(|p| !(p.radius <= FAR)).filter(|piece| !piece.is_empty()) {
            let points = piece.iter().map(|p| (p.stress[0] * 1e-6, p.stress[1] * 1e-6)).collect();
            series.push(Series { label: name.clone(), points, style });
        }
    }
    let axis = |name: &str| Axis::linear(format!("Stress {name}"), "MPa");
    let [x, y] = found.plane.names();
    LinePlot {
        title: format!("Failure envelopes of {}", found.material.name),
        x: axis(x),
        y: axis(y),
        series,
        marks: Vec::new(),
        doubts: Vec::new(),
    }
}

/// Strengths along the axes, per criterion.
fn summary(found: &MaterialEnvelopes<'_>) -> String {
    let [x, y] = found.plane.names();
    let heads = [format!("+{x}"), format!("-{x}"), format!("+{y}"), format!("-{y}")];
    let (name, plane) = (&found.material.name, found.plane);
    let mut text = format!("Failure envelopes of {name} in the plane {plane}, strengths along its axes in MPa\n");
    let line = |name: &str, values: [String; 4]| {
        let [a, b, c, d] = values;
        format!("  {name:<28} {a:>10} {b:>10} {c:>10} {d:>10}\n")
    };
    text.push_str(&line("criterion", heads));
    for ((name, _), curve) in found.criteria.iter().zip(&found.curves) {
        let at = |quarter: usize, axis: usize| {
            let angle = quarter as f64 / 4.0 * std::f64::consts::TAU;
            let bound = curve.iter().find(|p| p.angle == angle && p.mode.is_some());
            bound.map_or("none".to_owned(), |p| format!("{:.1}", p.stress[axis].abs() * 1e-6))
        };
        text.push_str(&line(name, [at(0, 0), at(2, 0), at(1, 1), at(3, 1)]));
    }
    text
}

/// A name as part of a folder's name.
fn file_name(name: &str) -> String {
    let part = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    name.chars().map(part).collect()
}
