//! Failure envelopes of a material by criteria, all of them called by their names.

use crate::model::NamedCriterion;
use crate::registry::{Registry, RegistryError};
use fem_core::material::Material;
use fem_core::plugin::{self, Built, Kind, Params, unknown_key};
use fem_failure::envelope::{self, EnvelopeError, EnvelopePoint, StressPlane};
use fem_io::materials;
use fem_io::scene::{CriterionSpec, Scene};
use fem_io::tables::EnvelopeRow;
use miette::Diagnostic;

/// Directions of an envelope, besides its corners.
const DIRECTIONS: usize = 360;

/// A name that means nothing, or a plane without an envelope.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
pub enum EnvelopeRefused {
    /// Nothing has the name.
    #[error("there is no {what} `{name}`")]
    #[diagnostic(help("{help}"))]
    Unknown {
        /// A material or a criterion.
        what: &'static str,
        /// What it was called.
        name: String,
        /// The nearest name, and what there is.
        help: String,
    },
    /// What stands after a colon is no `key=value`.
    #[error("`{0}` is not a parameter")]
    #[diagnostic(help("write, for example: tsai-wu:f12=-0.3"))]
    NoParameter(String),
    /// A criterion cannot be built.
    #[error("criterion `{name}`: {why}")]
    Criterion {
        /// What it was called.
        name: String,
        /// Why not.
        why: String,
    },
    /// There is no envelope.
    #[error(transparent)]
    Plane(#[from] EnvelopeError),
}

/// The material `name` of `scene`, or else of the library.
///
/// # Errors
/// No such material.
pub fn material<'a>(name: &str, scene: Option<&'a Scene>) -> Result<&'a Material, EnvelopeRefused> {
    let own = scene.into_iter().flat_map(|s| &s.materials).map(|m| &m.value);
    let library = || -> Option<&'a Material> { Some(&materials::library(name)?.material) };
    own.clone().find(|m| m.name == name).or_else(library).ok_or_else(|| {
        let known = own.map(|m| m.name.as_str()).chain(materials::names().map(|name| -> &'a str { name }));
        let help = format!("`{name}` {}", unknown_key(name, known));
        EnvelopeRefused::Unknown { what: "material", name: name.to_owned(), help }
    })
}

/// The criteria that are `asked` for, `tsai-wu:f12=-0.3` with parameters after colons or as `scene` calls them; those of
/// `scene` where none are.
///
/// # Errors
/// A criterion that there is not, or whose parameters are refused.
pub fn criteria(
    registry: &Registry,
    asked: &[String],
    scene: Option<&Scene>,
) -> Result<Vec<NamedCriterion>, EnvelopeRefused> {
    let specs = || scene.into_iter().flat_map(|s| &s.failure.criteria);
    if asked.is_empty() {
        return specs().map(|spec| build_as(registry, spec)).collect();
    }
    let each = |text: &String| match specs().find(|spec| spec.label == *text) {
        Some(spec) => build_as(registry, spec),
        None => {
            let mut parts = text.split(':');
            let name = parts.next().unwrap_or_default();
            let params = parts.map(parameter).collect::<Result<Vec<_>, _>>()?;
            let params = params.into_iter().fold(Params::default(), |all, (key, value)| all.with(key, value));
            build(registry, name, &params).map(|(_, criterion)| (text.clone(), criterion))
        }
    };
    asked.iter().map(each).collect()
}

/// `key=value`, the value a number, a flag or a text.
fn parameter(text: &str) -> Result<(&str, plugin::Value), EnvelopeRefused> {
    let (key, value) = text.split_once('=').ok_or_else(|| EnvelopeRefused::NoParameter(text.to_owned()))?;
    let number = value.parse().ok().map(plugin::Value::Number);
    let flag = || value.parse().ok().map(plugin::Value::Flag);
    Ok((key, number.or_else(flag).unwrap_or_else(|| plugin::Value::Text(value.to_owned()))))
}

/// A criterion of a scene under the name that it has there.
fn build_as(registry: &Registry, spec: &CriterionSpec) -> Result<NamedCriterion, EnvelopeRefused> {
    let (_, criterion) = build(registry, &spec.plugin.name.value, &spec.plugin.params)?;
    Ok((spec.label.clone(), criterion))
}

fn build(registry: &Registry, name: &str, params: &Params) -> Result<NamedCriterion, EnvelopeRefused> {
    let refused = |why: String| EnvelopeRefused::Criterion { name: name.to_owned(), why };
    match registry.build(Kind::Criterion, name, params) {
        Ok(Built::Criterion(criterion)) => Ok((name.to_owned(), criterion)),
        Ok(_) => Err(refused("what is registered under the name builds something else".to_owned())),
        Err(RegistryError::Unknown { hint, .. }) => {
            Err(EnvelopeRefused::Unknown { what: "criterion", name: name.to_owned(), help: hint })
        }
        Err(error) => Err(refused(error.to_string())),
    }
}

/// Envelopes of one material in one plane.
#[derive(Debug)]
pub struct MaterialEnvelopes<'a> {
    /// The material.
    pub material: &'a Material,
    /// Two components of the stress; the others are zero.
    pub plane: StressPlane,
    /// The criteria, by the names that they were asked for by.
    pub criteria: Vec<NamedCriterion>,
    /// Of each of them its points by growing angle.
    pub curves: Vec<Vec<EnvelopePoint>>,
}

impl<'a> MaterialEnvelopes<'a> {
    /// Those of `material` by `criteria` in `plane`.
    ///
    /// # Errors
    /// A material or a plane that a criterion refuses; a component under which none fails.
    pub fn new(
        material: &'a Material,
        criteria: Vec<NamedCriterion>,
        plane: StressPlane,
    ) -> Result<Self, EnvelopeRefused> {
        let named: Vec<_> = criteria.iter().map(|(name, criterion)| (name.as_str(), &**criterion)).collect();
        let curves = envelope::envelopes(&named, material, plane, DIRECTIONS)?.curves;
        Ok(Self { material, plane, criteria, curves })
    }

    /// Bounded points as the rows of `envelope.csv`.
    pub fn rows(&self) -> Vec<EnvelopeRow> {
        let of_each = self.criteria.iter().zip(&self.curves).flat_map(|((name, criterion), curve)| {
            curve.iter().filter_map(|point| {
                Some(EnvelopeRow {
                    criterion: name.clone(),
                    mode: criterion.info().modes[point.mode?].to_owned(),
                    angle_deg: point.angle.to_degrees(),
                    components: self.plane.names(),
                    stresses_mpa: point.stress.map(|s| s * 1e-6),
                })
            })
        });
        of_each.collect()
    }
}
