//! What a study of the scene varies and looks at.

use super::setting::Setting;
use crate::document::keys::{Form, Keys, key};
use crate::document::reader::SceneValue;
use crate::document::source::{Located, SceneError};
use fem_core::plugin::Dimension;

/// What a scene says of studies of it.
#[derive(Debug, Clone, Default)]
pub struct Study {
    /// Axes by the names that the study gives them; those that fit the scene if `None`.
    pub axes: Option<Vec<Located<String>>>,
    /// Axes of the scene's own.
    pub own: Vec<OwnAxis>,
    /// What accuracy is asked of; what fits the analysis if empty.
    pub quantities: Vec<Located<Quantity>>,
    /// Relative error to which the reference must have converged.
    pub tolerance: Option<f64>,
}

/// An axis that a scene names.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnAxis {
    /// What results call it.
    pub name: Located<String>,
    /// Whether its levels grow finer, so that errors count from the last one; otherwise they are alternatives to the scene.
    pub ladder: bool,
    /// What each level sets in the scene.
    pub levels: Vec<Setting>,
}

/// Something that has an error.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// One that the study knows by this name, or all whose names begin so.
    Named(String),
    /// A stress at a place.
    Stress {
        /// What results call it.
        name: String,
        /// Name of the `[[profile]]` that it lies on.
        profile: String,
        /// Column of the profile's table without its unit: `sxx`, `s12`.
        component: String,
        /// Height, m.
        height: f64,
    },
}

pub(super) const KEYS: Keys = &[
    key(
        "axes",
        Form::List(&Form::Text),
        r#"["mesh", "layers", "reduction", "step"]"#,
        "what is varied, see `fem study --help`; all that fits the scene if left out",
    ),
    key(
        "axis",
        Form::List(&Form::Table(AXIS)),
        r#"[{ name = "patch", levels = [{ impactor.patch_radius = "2 mm" }] }]"#,
        "axes of your own",
    ),
    key(
        "quantities",
        Form::List(&Form::OneOf(&[Form::Text, Form::Table(STRESS)])),
        r#"["peak-force", "first-damage"]"#,
        "what accuracy is asked of; what fits the analysis if left out",
    ),
    key("tolerance", Form::Number, "1e-3", "relative error to which the reference must have converged"),
];
const AXIS: Keys = &[
    key("name", Form::Text, r#""patch""#, "what results call it").required(),
    key("ladder", Form::Flag, "true", "whether its levels grow finer; otherwise they are alternatives").default("true"),
    key(
        "levels",
        Form::List(&Form::Setting),
        r#"[{ impactor.patch_radius = "2 mm" }, { impactor.patch_radius = "1 mm" }]"#,
        "keys of the scene with their values, a table per level",
    )
    .required(),
];
const STRESS: Keys = &[
    key("name", Form::Text, r#""sxx-top""#, "what results call it").required(),
    key("profile", Form::Text, r#""centre""#, "name of the profile that it lies on").required(),
    key("component", Form::Text, r#""sxx""#, "column of the profile's table, without its unit").required(),
    key("height", Form::Quantity(Dimension::LENGTH), r#""0.5 mm""#, "height above the mid-plane").required(),
];

pub(super) fn read(field: &SceneValue<'_>) -> Result<Study, SceneError> {
    let table = field.table(KEYS)?;
    let names = |field: SceneValue<'_>| field.list()?.iter().map(name).collect::<Result<Vec<_>, _>>();
    let quantities = |field: SceneValue<'_>| field.list()?.iter().map(quantity).collect::<Result<Vec<_>, _>>();
    let own = |field: SceneValue<'_>| field.list()?.iter().map(axis).collect::<Result<Vec<_>, _>>();
    let tolerance = |field: SceneValue<'_>| match field.number()? {
        tolerance if tolerance > 0.0 && tolerance < 1.0 => Ok(tolerance),
        tolerance => {
            Err(field.error(format!("{tolerance} is not a relative error"), "give a number between 0 and 1: 1e-3"))
        }
    };
    Ok(Study {
        axes: table.optional("axes").map(names).transpose()?,
        own: table.optional("axis").map(own).transpose()?.unwrap_or_default(),
        quantities: table.optional("quantities").map(quantities).transpose()?.unwrap_or_default(),
        tolerance: table.optional("tolerance").map(tolerance).transpose()?,
    })
}

fn name(field: &SceneValue<'_>) -> Result<Located<String>, SceneError> {
    Ok(field.at(field.text()?.to_owned()))
}

fn axis(field: &SceneValue<'_>) -> Result<OwnAxis, SceneError> {
    let table = field.table(AXIS)?;
    let level = |field: &SceneValue<'_>| {
        let help = "write keys of the scene with their values: { impactor.patch_radius = \"2 mm\" }";
        field.any_table()?.setting().filter(|keys| !keys.is_empty()).ok_or_else(|| field.error("sets nothing", help))
    };
    Ok(OwnAxis {
        name: name(&table.required("name")?)?,
        ladder: table.optional("ladder").map_or(Ok(true), |field| field.flag())?,
        levels: table.required("levels")?.list()?.iter().map(level).collect::<Result<_, _>>()?,
    })
}

fn quantity(field: &SceneValue<'_>) -> Result<Located<Quantity>, SceneError> {
    if let crate::document::tree::Node::Text(_) = field.node() {
        return Ok(field.at(Quantity::Named(field.text()?.to_owned())));
    }
    let table = field.table(STRESS)?;
    let text = |key| Ok(table.required(key)?.text()?.to_owned());
    Ok(field.at(Quantity::Stress {
        name: text("name")?,
        profile: text("profile")?,
        component: text("component")?,
        height: table.required("height")?.quantity(Dimension::LENGTH)?,
    }))
}

/// A relative error, 0.01 or "1 %".
pub(super) fn read_accuracy(field: &SceneValue<'_>) -> Result<Located<f64>, SceneError> {
    let share = field.text().map_or_else(|_| field.number().ok(), |text| parse_share(text).ok());
    let wrong =
        || field.error("is no error that can be asked for", "give a part between 0 and 1, or per cent: 0.01, \"1 %\"");
    share.filter(|share| is_share(*share)).map(|share| field.at(share)).ok_or_else(wrong)
}

fn is_share(share: f64) -> bool {
    share > 0.0 && share < 1.0
}

/// A relative error between 0 and 1 from its text: `0.01`, `1%` or `1 %`.
///
/// # Errors
/// What is wrong with it.
pub fn parse_share(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let share = number.trim().parse::<f64>().ok().map(|share| share * unit);
    share
        .filter(|share| is_share(*share))
        .ok_or_else(|| "must be an error between 0 and 1, or in percent: 0.01 or 1%".into())
}
