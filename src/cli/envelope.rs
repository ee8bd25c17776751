//! `fem envelope`.

use super::{Console, Format};
use crate::model::NamedCriterion;
use crate::registry::{Registry, RegistryError};
use clap::Args;
use fem_core::material::Material;
use fem_core::plugin::{self, Built, Kind, Params, unknown_key};
use fem_failure::envelope::{self, EnvelopePoint, Envelopes, StressPlane};
use fem_io::files::OutputDir;
use fem_io::materials;
use fem_io::plot::{self, Axis, LinePlot, Series, Style};
use fem_io::scene::{self, CriterionSpec, Scene};
use fem_io::tables::{self, EnvelopeRow};
use miette::{IntoDiagnostic, miette};
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

/// Directions of an envelope, besides its corners.
const DIRECTIONS: usize = 360;

/// Where the picture of an envelope that is open towards some stresses ends, over the largest strength of each axis.
const FAR: f64 = 3.0;

pub(super) fn envelope(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let scene = arguments.scene.as_deref().map(scene::read).transpose()?;
    let material = material(&arguments.material, scene.as_ref())?;
    let criteria = criteria(registry, &arguments.criteria, scene.as_ref())?;
    let named: Vec<_> = criteria.iter().map(|(name, criterion)| (name.as_str(), &**criterion)).collect();
    let plane = arguments.plane;
    let found = envelope::envelopes(&named, material, plane, DIRECTIONS).into_diagnostic()?;

    let folder = || format!("results/envelope-{}-{plane}", file_name(&material.name)).into();
    let dir = OutputDir::create(arguments.out.clone().unwrap_or_else(folder)).into_diagnostic()?;
    let rows = rows(&criteria, &found, plane);
    tables::write_envelopes(&dir, &rows).into_diagnostic()?;
    let picture = plot::line_plot(&picture(&criteria, &found, material, plane)).into_diagnostic()?;
    picture.write(&dir, "envelope").into_diagnostic()?;
    let data = Document {
        material: &material.name,
        plane: plane.to_string(),
        envelope: rows.iter().map(EnvelopeRow::named).collect(),
        results: dir.path(),
    };
    console.show(arguments.format, &data, || {
        format!("{}  results   {}\n", summary(&criteria, &found, material, plane), dir.path().display())
    })?;
    Ok(ExitCode::SUCCESS)
}

fn material<'a>(name: &str, scene: Option<&'a Scene>) -> miette::Result<&'a Material> {
    let own = scene.into_iter().flat_map(|s| &s.materials).map(|m| &m.value);
    let library = || -> Option<&'a Material> { Some(&materials::library(name)?.material) };
    own.clone().find(|m| m.name == name).or_else(library).ok_or_else(|| {
        let known = own.map(|m| m.name.as_str()).chain(materials::names().map(|name| -> &'a str { name }));
        miette!(help = format!("`{name}` {}", unknown_key(name, known)), "there is no material `{name}`")
    })
}

pub(super) fn criteria(
    registry: &Registry,
    asked: &[String],
    scene: Option<&Scene>,
) -> miette::Result<Vec<NamedCriterion>> {
    let specs = || scene.into_iter().flat_map(|s| &s.failure.criteria);
    if asked.is_empty() {
        return specs().map(|spec| build_as(registry, spec)).collect();
    }
    let each = |text: &String| match specs().find(|spec| spec.label == *text) {
        Some(spec) => build_as(registry, spec),
        None => {
            let mut parts = text.split(':');
            let name = parts.next().unwrap_or_default();
            let params = parts.map(parameter).collect::<miette::Result<Vec<_>>>()?;
            let params = params.into_iter().fold(Params::default(), |all, (key, value)| all.with(key, value));
            build(registry, name, &params).map(|(_, criterion)| (text.clone(), criterion))
        }
    };
    asked.iter().map(each).collect()
}

/// `key=value`, the value a number, a flag or a text.
fn parameter(text: &str) -> miette::Result<(&str, plugin::Value)> {
    let Some((key, value)) = text.split_once('=') else {
        return Err(miette!(help = "write, for example: tsai-wu:f12=-0.3", "`{text}` is not a parameter"));
    };
    let number = value.parse().ok().map(plugin::Value::Number);
    let flag = || value.parse().ok().map(plugin::Value::Flag);
    Ok((key, number.or_else(flag).unwrap_or_else(|| plugin::Value::Text(value.to_owned()))))
}

/// A criterion of a scene under the name that it has there.
fn build_as(registry: &Registry, spec: &CriterionSpec) -> miette::Result<NamedCriterion> {
    let (_, criterion) = build(registry, &spec.plugin.name.value, &spec.plugin.params)?;
    Ok((spec.label.clone(), criterion))
}

fn build(registry: &Registry, name: &str, params: &Params) -> miette::Result<NamedCriterion> {
    match registry.build(Kind::Criterion, name, params) {
        Ok(Built::Criterion(criterion)) => Ok((name.to_owned(), criterion)),
        Ok(_) => Err(miette!("the plug-in registered as the criterion `{name}` builds something else")),
        Err(RegistryError::Unknown { hint, .. }) => Err(miette!(help = hint, "there is no criterion `{name}`")),
        Err(error) => Err(miette!("criterion `{name}`: {error}")),
    }
}

/// Bounded points as a table.
fn rows(criteria: &[NamedCriterion], found: &Envelopes, plane: StressPlane) -> Vec<EnvelopeRow> {
    let mut rows = Vec::new();
    for ((name, criterion), curve) in criteria.iter().zip(&found.curves) {
        let row = |p: &EnvelopePoint| {
            Some(EnvelopeRow {
                criterion: name.clone(),
                mode: criterion.info().modes[p.mode?].to_owned(),
                angle_deg: p.angle.to_degrees(),
                components: plane.names(),
                stresses_mpa: p.stress.map(|s| s * 1e-6),
            })
        };
        rows.extend(curve.iter().filter_map(row));
    }
    rows
}

/// One curve per criterion, in pieces where it is open; every other one dashed, so that equal ones are both seen.
fn picture(criteria: &[NamedCriterion], found: &Envelopes, m: &Material, plane: StressPlane) -> LinePlot {
    let mut series = Vec::new();
    for (k, ((name, _), curve)) in criteria.iter().zip(&found.curves).enumerate() {
        let style = if k % 2 == 0 { Style::Solid } else { Style::Dashed };
        for piece in curve.split(|p| !(p.radius <= FAR)).filter(|piece| !piece.is_empty()) {
            let points = piece.iter().map(|p| (p.stress[0] * 1e-6, p.stress[1] * 1e-6)).collect();
            series.push(Series { label: name.clone(), points, style });
        }
    }
    let axis = |name: &str| Axis::linear(format!("Stress {name}"), "MPa");
    let [x, y] = plane.names();
    LinePlot {
        title: format!("Failure envelopes of {}", m.name),
        x: axis(x),
        y: axis(y),
        series,
        marks: Vec::new(),
        doubts: Vec::new(),
    }
}

/// Strengths along the axes, per criterion.
fn summary(criteria: &[NamedCriterion], found: &Envelopes, m: &Material, plane: StressPlane) -> String {
    let [x, y] = plane.names();
    let heads = [format!("+{x}"), format!("-{x}"), format!("+{y}"), format!("-{y}")];
    let mut text = format!("Failure envelopes of {} in the plane {plane}, strengths along its axes in MPa\n", m.name);
    let line = |name: &str, values: [String; 4]| {
        let [a, b, c, d] = values;
        format!("  {name:<28} {a:>10} {b:>10} {c:>10} {d:>10}\n")
    };
    text.push_str(&line("criterion", heads));
    for ((name, _), curve) in criteria.iter().zip(&found.curves) {
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
