//! What the advisor answers.

use crate::mistakes::raise;
use crate::own::registry;
use fem::io::scene::Scene;
use fem::{Model, advise};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::num::NonZeroUsize;

/// Of each impactor its impact and the answers, as JSON.
pub(crate) fn advise(py: Python<'_>, scene: &Scene, threads: NonZeroUsize) -> PyResult<String> {
    let all =
        py.detach(|| advise::advise(&Model::new(scene, &registry(&[]))?, threads)).map_err(|error| raise(&error))?;
    let each = all.iter().map(|advice| {
        json!({
            "impactor": advice.impactor,
            "mass_kg": advice.mass,
            "velocity_m_s": advice.velocity,
            "peak_force_N": advice.estimate.force(),
            "answers": advice.answers,
            "text": advice.to_string(),
        })
    });
    Ok(each.collect::<Value>().to_string())
}
