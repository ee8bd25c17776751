//! How loads at rest are followed while interfaces open.

use crate::document::keys::{Form, Keys, key};
use crate::document::reader::SceneValue;
use crate::document::source::{Located, SceneError};
use fem_core::plugin::Dimension;

/// How loads at rest are followed while interfaces open.
#[derive(Debug, Clone, PartialEq)]
pub struct PathSpec {
    /// Displacement of the loads at which it ends, m; that which they prescribe if `None`.
    pub until: Option<Located<f64>>,
    /// Energy that a step dissipates, J; from the toughness, the cells and the width of the plate if `None`.
    pub step: Option<f64>,
    /// Most steps.
    pub steps: usize,
    /// Force that the loads stand for, N; the largest that one of them exerts if `None`.
    pub force: Option<f64>,
}

impl Default for PathSpec {
    fn default() -> Self {
        Self { until: None, step: None, steps: STEPS, force: None }
    }
}

const STEPS: usize = 500;

pub(super) const KEYS: Keys = &[
    key(
        "until",
        Form::Quantity(Dimension::LENGTH),
        r#""4 mm""#,
        "displacement of the loads at which it ends; that which they prescribe if left out",
    ),
    key(
        "step",
        Form::Quantity(Dimension::ENERGY),
        r#""1 mJ""#,
        "energy that a step dissipates; what half a cell across the plate takes if left out",
    ),
    key("steps", Form::Count(1), "500", "most steps").default("500"),
    key(
        "force",
        Form::Quantity(Dimension::FORCE),
        r#""1 N""#,
        "force that the loads stand for; the largest that one of them exerts if left out",
    ),
];

pub(super) fn read(field: &SceneValue<'_>) -> Result<PathSpec, SceneError> {
    let table = field.table(KEYS)?;
    let until = table.optional("until").map(|field| Ok(field.at(field.positive(Dimension::LENGTH)?))).transpose()?;
    let positive = |key, dimension| table.optional(key).map(|field| field.positive(dimension)).transpose();
    Ok(PathSpec {
        until,
        step: positive("step", Dimension::ENERGY)?,
        steps: table.optional("steps").map_or(Ok(STEPS), |field| field.count())?,
        force: positive("force", Dimension::FORCE)?,
    })
}
