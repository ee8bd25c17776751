//! Failure envelopes.

use crate::criterion::Raised;
use crate::json;
use crate::mistakes::raise;
use crate::own::{Own, raised, registry};
use crate::scene::Scene;
use fem::envelope::{EnvelopeRefused, MaterialEnvelopes, criteria, material};
use fem::failure::envelope::StressPlane;
use fem::io::tables::EnvelopeRow;
use miette::MietteDiagnostic;
use pyo3::prelude::*;

/// The rows of `envelope.csv`, as JSON: of a material, or the first of the scene, by criteria, or those of the scene, in `plane`.
#[pyfunction]
pub(crate) fn envelope(
    py: Python<'_>,
    of: Option<&str>,
    names: Vec<String>,
    plane: &str,
    scene: Option<PyRef<'_, Scene>>,
    own: Vec<Own>,
) -> PyResult<String> {
    let plane: StressPlane = plane.parse().map_err(|error| raise(&MietteDiagnostic::new(format!("{error}"))))?;
    let scene = scene.as_ref().map(|scene| scene.read_one());
    let registry = registry(&own);
    let found = py.detach(|| -> Result<_, EnvelopeRefused> {
        let criteria = criteria(&registry, &names, scene)?;
        let first = || Some(scene?.materials.first()?.value.name.as_str());
        let of = of.or_else(first).unwrap_or_default();
        Ok(MaterialEnvelopes::new(material(of, scene)?, criteria, plane)?
            .rows()
            .iter()
            .map(EnvelopeRow::named)
            .collect::<Vec<_>>())
    });
    match (raised(&own).iter().find_map(Raised::take), found) {
        (Some(raised), _) => Err(raised),
        (None, found) => json(&found.map_err(|error| raise(&error))?),
    }
}
