//! Interfaces between plies that open.

use super::plugin::PluginSpec;
use super::run::{AT, ImpactPoint, read_point};
use crate::document::keys::{Form, Keys, key};
use crate::document::reader::SceneValue;
use crate::document::source::{Located, SceneError};
use fem_core::plugin::{Dimension, Kind};

/// Which interfaces may open, and by which law.
#[derive(Debug, Clone)]
pub struct DelaminationSpec {
    /// The law of the interfaces.
    pub law: PluginSpec,
    /// The interfaces that may open, counted from 0: k lies between the plies k and k + 1; those between unlike plies if `None`.
    pub interfaces: Option<Located<Vec<Located<usize>>>>,
    /// How far from where something strikes they may, m; everywhere if `None`.
    pub radius: Option<Located<f64>>,
    /// Points of integration of a cell, each way.
    pub points: usize,
    /// Share of the tractions at which damage begins from which on an interface is opened.
    pub trigger: f64,
    /// Width of what is open ahead of damage, m; from the process zone and the cells if `None`.
    pub margin: Option<f64>,
    /// Delaminations at the start.
    pub starting: Vec<StartingDelamination>,
}

/// A delamination at the start.
#[derive(Debug, Clone)]
pub struct StartingDelamination {
    /// Its interface, counted from 0.
    pub interface: Located<usize>,
    /// Where it is.
    pub extent: StartingExtent,
}

/// Where a delamination is at the start.
#[derive(Debug, Clone)]
pub enum StartingExtent {
    /// In a circle.
    Disc {
        /// Its centre.
        at: Located<ImpactPoint>,
        /// Its radius, m.
        radius: f64,
    },
    /// In the cells of a group of the mesh.
    Group(Located<String>),
}

/// Points of integration of a cell each way.
const POINTS: usize = 4;

impl DelaminationSpec {
    /// Most points of integration of a cell, each way.
    pub const MOST_POINTS: usize = 16;
    /// Fewer leave motions between the faces of a cell that no point sees: a double cantilever took twice its force.
    pub const LEAST_POINTS: usize = 3;
}

/// Share of the tractions of damage at which interfaces are opened. The mean at a node misses the peak beside it.
const TRIGGER: f64 = 0.2;

const OWN: &[&str] = &["interfaces", "radius", "points", "trigger", "margin", "start"];

/// The table but for its plug-in, the law.
pub(super) const KEYS: Keys = &[
    key(
        "interfaces",
        Form::List(&Form::Count(1)),
        "[2, 4, 6]",
        "interfaces that may open: k lies between the plies k and k + 1; those between unlike plies if left out",
    ),
    key(
        "radius",
        Form::Quantity(Dimension::LENGTH),
        r#""30 mm""#,
        "how far from where something strikes they may open; everywhere if left out",
    ),
    key("points", Form::Count(1), "4", "points of integration of a cell, each way").default("4"),
    key("trigger", Form::Number, "0.2", "share of the strengths at which an interface is opened").default("0.2"),
    key(
        "margin",
        Form::Quantity(Dimension::LENGTH),
        r#""4 mm""#,
        "what is open ahead of damage; two cells or one and a half process zones if left out",
    ),
    key(
        "start",
        Form::List(&Form::Table(START)),
        r#"[{ interface = 4, at = { x = "75 mm", y = "50 mm" }, radius = "5 mm" }]"#,
        "delaminations that are there at the beginning",
    ),
];
const START: Keys = &[
    key("interface", Form::Count(1), "4", "which: k lies between the plies k and k + 1").required(),
    key("at", Form::Table(AT), r#"{ x = "75 mm", y = "50 mm" }"#, "centre of a round one"),
    key("radius", Form::Quantity(Dimension::LENGTH), r#""5 mm""#, "its radius"),
    key("group", Form::Text, r#""crack""#, "its cells, a group of the mesh, where it is not round"),
];

/// The form of the table.
pub(super) const FORM: Form = Form::Plugin(Kind::InterfaceLaw, "law", KEYS);

pub(super) fn read(field: &SceneValue<'_>) -> Result<DelaminationSpec, SceneError> {
    let law = PluginSpec::read(field, "law", OWN)?;
    let entries = field.entries()?;
    let own = |name: &str| entries.iter().find(|(key, _)| *key == name).map(|(_, value)| value);
    let share = |field: &SceneValue<'_>| match field.number()? {
        share if share > 0.0 && share < 1.0 => Ok(share),
        other => Err(field.error(format!("{other} is not a share"), "give a number between 0 and 1, such as 0.2")),
    };
    let points = |field: &SceneValue<'_>| match field.count()? {
        count if (DelaminationSpec::LEAST_POINTS..=DelaminationSpec::MOST_POINTS).contains(&count) => Ok(count),
        count => Err(field.error(
            format!("{count} points each way"),
            format!(
                "4 to 8 are enough at cells as wide as the process zone, {} are the least, {} are the most",
                DelaminationSpec::LEAST_POINTS,
                DelaminationSpec::MOST_POINTS
            ),
        )),
    };
    let interface = |field: &SceneValue<'_>| Ok(field.at(field.count()? - 1));
    Ok(DelaminationSpec {
        law,
        interfaces: match own("interfaces") {
            Some(field) => {
                let each = field.list()?.iter().map(interface).collect::<Result<Vec<_>, SceneError>>()?;
                Some(field.at(each))
            }
            None => None,
        },
        radius: match own("radius") {
            Some(field) => Some(field.at(field.positive(Dimension::LENGTH)?)),
            None => None,
        },
        points: own("points").map_or(Ok(POINTS), points)?,
        trigger: own("trigger").map_or(Ok(TRIGGER), share)?,
        margin: own("margin").map(|field| field.positive(Dimension::LENGTH)).transpose()?,
        starting: match own("start") {
            Some(field) => field.list()?.iter().map(read_start).collect::<Result<_, _>>()?,
            None => Vec::new(),
        },
    })
}

fn read_start(field: &SceneValue<'_>) -> Result<StartingDelamination, SceneError> {
    let table = field.table(START)?;
    let interface = table.required("interface")?;
    let extent = match (table.optional("group"), table.optional("at"), table.optional("radius")) {
        (Some(group), None, None) => StartingExtent::Group(group.at(group.text()?.to_owned())),
        (None, _, _) => StartingExtent::Disc {
            at: read_point(&table.required("at")?)?,
            radius: table.required("radius")?.positive(Dimension::LENGTH)?,
        },
        (Some(group), ..) => {
            let help = "leave out `group`, or `at` and `radius`";
            return Err(group.error("is round or the cells of a group, not both", help));
        }
    };
    Ok(StartingDelamination { interface: interface.at(interface.count()? - 1), extent })
}
