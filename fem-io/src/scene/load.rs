//! Loads of a static analysis.

use super::run::{self, ImpactPoint};
use super::support::{self, NodeSet};
use crate::document::keys::{Form, Key, Keys, key, words};
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Located, Place, SceneError};
use crate::document::tree::Node;
use crate::units;
use fem_core::dof::Dof;
use fem_core::formula::Formula;
use fem_core::load::Face;
use fem_core::plugin::Dimension;

/// A load.
#[derive(Debug, Clone)]
pub struct Load {
    /// What acts where.
    pub kind: LoadKind,
    /// Where it stands.
    pub place: Place,
}

/// What acts where.
#[derive(Debug, Clone)]
pub enum LoadKind {
    /// A pressure, Pa, that presses on a face.
    Pressure {
        /// Its distribution.
        pressure: Pressure,
        /// Which face.
        face: Face,
        /// Cells that it acts on; all if `None`.
        group: Option<Located<String>>,
    },
    /// A force on a circle of the top face, spread like the pressure of Hertz' contact; pressing down.
    Patch {
        /// Total, N.
        force: f64,
        /// Centre of the circle.
        at: Located<ImpactPoint>,
        /// Radius of the circle, m.
        radius: f64,
    },
    /// A force per length of an edge, N/m, spread evenly through the thickness.
    Edge {
        /// Along x, y, z.
        force_per_length: [f64; 3],
        /// A group of edges.
        group: Located<String>,
    },
    /// A force at one node, N.
    Point {
        /// Along x, y, z.
        force: [f64; 3],
        /// The node.
        node: NodeSet,
    },
    /// A displacement of nodes, m, all alike: the force that it takes is found.
    Displacement {
        /// How far.
        displacement: f64,
        /// Which component.
        dof: Dof,
        /// The nodes.
        nodes: NodeSet,
    },
    /// Weight: an acceleration of all masses, m/s².
    Gravity {
        /// Along x, y, z.
        acceleration: [f64; 3],
    },
}

/// A pressure over the plane.
#[derive(Debug, Clone)]
pub enum Pressure {
    /// The same everywhere, Pa.
    Uniform(f64),
    /// A formula of x and y.
    Formula {
        /// The formula.
        formula: Box<Formula>,
        /// Unit of its value, Pa.
        pascals: f64,
        /// Unit of x and y, m.
        metres: f64,
    },
}

impl Pressure {
    /// Pressure at (x, y) in m, Pa.
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        match self {
            Self::Uniform(p) => *p,
            Self::Formula { formula, pascals, metres } => {
                let coordinates = [x / metres, y / metres];
                pascals * formula.value(&formula.names().iter().map(|k| coordinates[*k]).collect::<Vec<_>>())
            }
        }
    }
}

/// A line through the thickness along which stresses are written.
#[derive(Debug, Clone)]
pub struct ProfileLine {
    /// Part of the names of its files.
    pub name: Located<String>,
    /// Where it pierces the plane.
    pub at: Located<ImpactPoint>,
    /// Heights per ply.
    pub points: usize,
    /// Whether transverse stresses are also found from equilibrium; where cells allow it, if the scene does not say.
    pub equilibrium: Option<bool>,
}

pub(super) const FACES: [(&str, Face); 2] = [("top", Face::Top), ("bottom", Face::Bottom)];
/// Force per length.
const LINE: Dimension = Dimension([0.0, 1.0, -2.0, 0.0]);
const FORCE: Form = Form::Several(3, &Form::Quantity(Dimension::FORCE));
const LEVEL: Key = support::LEVEL;

/// What a load may be: each kind has keys of its own.
pub(super) const LOADS: &[Form] = &[
    Form::Table(PRESSURE),
    Form::Table(PATCH),
    Form::Table(EDGE),
    Form::Table(GRAVITY),
    Form::Table(POINT),
    Form::Table(DISPLACEMENT),
];
const PRESSURE: Keys = &[
    key(
        "pressure",
        Form::OneOf(&[Form::Quantity(Dimension::PRESSURE), Form::Table(FORMULA)]),
        r#""1 MPa""#,
        "presses on a face, or pulls where it is negative",
    )
    .required(),
    key("face", Form::Words(&words(&FACES)), r#""top""#, "face that it acts on").default(r#""top""#),
    key("group", Form::Text, r#""plate""#, "cells that it acts on, a group of the mesh; all if left out"),
];
const FORMULA: Keys = &[
    key("formula", Form::Text, r#""sin(3.14159*x/100)""#, "value of the pressure over x and y").required(),
    key("unit", Form::Text, r#""MPa""#, "unit of its value").required(),
    key("length", Form::Text, r#""mm""#, "unit of x and y").required(),
];
const PATCH: Keys = &[
    key("patch_radius", Form::Quantity(Dimension::LENGTH), r#""3 mm""#, "radius of the circle that the force acts on")
        .required(),
    key("force", Form::Quantity(Dimension::FORCE), r#""100 N""#, "total, pressing down on the top face").required(),
    key("at", Form::Table(run::AT), r#"{ x = "0 mm", y = "0 mm" }"#, "centre of the circle").required(),
];
const EDGE: Keys = &[
    key(
        "force_per_length",
        Form::Several(3, &Form::Quantity(LINE)),
        r#"["10 N/mm", "0 N/mm", "0 N/mm"]"#,
        "along x, y and z, spread evenly through the thickness",
    )
    .required(),
    key("group", Form::Text, r#""x-max""#, "a group of edges of the mesh").required(),
];
const POINT: Keys = &[
    key("force", FORCE, r#"["0 N", "0 N", "-5 N"]"#, "at one node, along x, y and z").required(),
    key("group", Form::Text, r#""impact""#, "the node, a group of the mesh").required(),
    LEVEL,
];
const DISPLACEMENT: Keys = &[
    key(
        "displacement",
        Form::Quantity(Dimension::LENGTH),
        r#""2 mm""#,
        "of all these nodes alike, while delaminations grow; the force that it takes is found",
    )
    .required(),
    key("dof", Form::Text, r#""U30""#, "which component: U10 along x, U20 along y, U30 along z").required(),
    key("group", Form::Text, r#""x-min""#, "the nodes, a group of the mesh").required(),
    LEVEL,
];
const GRAVITY: Keys = &[key(
    "gravity",
    Form::Several(3, &Form::Quantity(Dimension::ACCELERATION)),
    r#"["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]"#,
    "acceleration of all masses along x, y and z",
)
.required()];
pub(super) const PROFILE: Keys = &[
    key("name", Form::Text, r#""centre""#, "part of the names of its files").required(),
    key("at", Form::Table(run::AT), r#"{ x = "50 mm", y = "50 mm" }"#, "where it pierces the plate").required(),
    key("points", Form::Count(2), "5", "heights per ply").default("5"),
    key(
        "equilibrium",
        Form::Flag,
        "true",
        "transverse stresses from equilibrium as well; where cells allow it, if left out",
    ),
];

/// Most heights of a profile per ply.
const MAX_POINTS: usize = 1000;

pub(super) fn read_all(field: &SceneValue<'_>) -> Result<Vec<Load>, SceneError> {
    field.list()?.iter().map(read).collect()
}

fn read(field: &SceneValue<'_>) -> Result<Load, SceneError> {
    let any = field.table_of(LOADS)?;
    let has = |key| any.optional(key).is_some();
    // A level of nodes is a word, the centre of a circle a table.
    let round = || any.optional("at").is_some_and(|at| matches!(at.node(), Node::Table(_)));
    let kind = if has("pressure") {
        pressure(&field.table(PRESSURE)?)?
    } else if has("patch_radius") || (has("force") && round()) {
        let table = field.table(PATCH)?;
        LoadKind::Patch {
            force: table.required("force")?.quantity(Dimension::FORCE)?,
            at: run::read_point(&table.required("at")?)?,
            radius: table.required("patch_radius")?.positive(Dimension::LENGTH)?,
        }
    } else if has("force_per_length") {
        let table = field.table(EDGE)?;
        LoadKind::Edge {
            force_per_length: vector(&table.required("force_per_length")?, LINE)?,
            group: group(&table.required("group")?)?,
        }
    } else if has("gravity") {
        let table = field.table(GRAVITY)?;
        LoadKind::Gravity { acceleration: vector(&table.required("gravity")?, Dimension::ACCELERATION)? }
    } else if has("displacement") {
        let table = field.table(DISPLACEMENT)?;
        let (displacement, dof) = (table.required("displacement")?, table.required("dof")?);
        LoadKind::Displacement {
            displacement: match displacement.quantity(Dimension::LENGTH)? {
                0.0 => return Err(displacement.error("moves nothing", "hold nodes by `support`")),
                moved => moved,
            },
            dof: match support::dof(&dof)? {
                other if other.m() > 0 => {
                    return Err(dof.error(format!("{other} is a slope"), "name a displacement: U10, U20 or U30"));
                }
                moved => moved,
            },
            nodes: support::nodes(&table)?,
        }
    } else if has("force") {
        let table = field.table(POINT)?;
        LoadKind::Point { force: vector(&table.required("force")?, Dimension::FORCE)?, node: support::nodes(&table)? }
    } else {
        return Err(field.error(
            "does not say what acts",
            "a load has `pressure`, `force`, `patch_radius` with `force`, `force_per_length`, `displacement` or `gravity`",
        ));
    };
    Ok(Load { kind, place: any.place().clone() })
}

fn group(field: &SceneValue<'_>) -> Result<Located<String>, SceneError> {
    Ok(field.at(field.text()?.to_owned()))
}

fn pressure(table: &Reader<'_>) -> Result<LoadKind, SceneError> {
    let field = table.required("pressure")?;
    let pressure = match field.node() {
        Node::Table(_) => formula(&field.table(FORMULA)?)?,
        _ => Pressure::Uniform(field.quantity(Dimension::PRESSURE)?),
    };
    Ok(LoadKind::Pressure {
        pressure,
        face: face(table)?,
        group: table.optional("group").map(|f| group(&f)).transpose()?,
    })
}

/// The face that something acts on, the top unless another is named.
pub(super) fn face(table: &Reader<'_>) -> Result<Face, SceneError> {
    table.optional("face").map_or(Ok(Face::Top), |field| field.choice(&FACES))
}

fn formula(table: &Reader<'_>) -> Result<Pressure, SceneError> {
    let field = table.required("formula")?;
    let help = "a formula of x and y, the coordinates in the unit `length`";
    let formula = Formula::parse(field.text()?, &["x", "y"]).map_err(|why| field.error(why.to_string(), help))?;
    let unit = |key, dimension| {
        let field = table.required(key)?;
        units::parse_as(&format!("1 {}", field.text()?), dimension)
            .map_err(|e| field.error(e.to_string(), e.remedy(Some(dimension))))
    };
    Ok(Pressure::Formula {
        formula: Box::new(formula),
        pascals: unit("unit", Dimension::PRESSURE)?,
        metres: unit("length", Dimension::LENGTH)?,
    })
}

fn vector(field: &SceneValue<'_>, dimension: Dimension) -> Result<[f64; 3], SceneError> {
    let parts = field.list()?;
    let [x, y, z] = &parts[..] else {
        return Err(field.error(format!("has {} components", parts.len()), "give three: along x, y and z"));
    };
    Ok([x.quantity(dimension)?, y.quantity(dimension)?, z.quantity(dimension)?])
}

pub(super) fn read_profiles(field: &SceneValue<'_>) -> Result<Vec<ProfileLine>, SceneError> {
    let mut all: Vec<ProfileLine> = Vec::new();
    for field in field.list()? {
        let table = field.table(PROFILE)?;
        let name = table.required("name")?;
        let text = name.text()?;
        if !text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_')) {
            return Err(name.error(format!("`{text}` becomes part of a file name"), "use letters, digits, - and _"));
        }
        if all.iter().any(|p| p.name.value == text) {
            return Err(name.error(format!("two profiles are called `{text}`"), "give each a name of its own"));
        }
        let points = match table.optional("points") {
            None => 5,
            Some(field) => match field.count()? {
                n if (2..=MAX_POINTS).contains(&n) => n,
                n => return Err(field.error(format!("{n} heights per ply"), format!("between 2 and {MAX_POINTS}"))),
            },
        };
        all.push(ProfileLine {
            name: name.at(text.to_owned()),
            at: run::read_point(&table.required("at")?)?,
            points,
            equilibrium: table.optional("equilibrium").map(|field| field.flag()).transpose()?,
        });
    }
    Ok(all)
}
