//! What holds the plate: supports by name, fixed unknowns, linear equations between unknowns, coupled sets.

use super::run::{self, ImpactPoint};
use crate::document::keys::{Form, Key, Keys, key, words};
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Located, Place, SceneError};
use crate::document::tree::Node;
use fem_core::dof::{Dof, DofError};
use fem_core::hold::SupportKind;
use fem_core::plugin::Dimension;
use fem_core::support::Levels;

/// Nodes of a group of the mesh, at some levels of the plate.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeSet {
    /// Physical name of the group.
    pub group: Located<String>,
    /// Which of the nodes above each other.
    pub levels: Levels,
}

/// A support.
#[derive(Debug, Clone, PartialEq)]
pub enum Support {
    /// Unknowns that stay zero.
    Fix {
        /// Of which nodes.
        nodes: NodeSet,
        /// Which unknowns.
        dofs: Vec<Dof>,
        /// Turn of the nodes' own axes about z that the unknowns refer to, radians.
        axes: f64,
        /// Where it stands.
        place: Place,
    },
    /// A support by name, of the nodes of a group or of a disc.
    Kind {
        /// Where on the plate.
        area: Located<SupportArea>,
        /// What is held there.
        kind: SupportKind,
        /// Which of the nodes above each other.
        levels: Levels,
        /// Force per deflection of what gives way, and per length or area of it, in SI units.
        stiffness: Option<Located<(f64, Dimension)>>,
        /// Where it stands.
        place: Place,
    },
    /// A statically determinate hold on whatever rigid motions all other supports leave free.
    RestrainRigidMotions {
        /// Where it stands.
        place: Place,
    },
}

impl Support {
    /// Where it stands.
    pub fn place(&self) -> &Place {
        match self {
            Self::Fix { place, .. } | Self::Kind { place, .. } | Self::RestrainRigidMotions { place } => place,
        }
    }
}

/// Where a support by name acts.
#[derive(Debug, Clone, PartialEq)]
pub enum SupportArea {
    /// On this group of the mesh.
    Group(String),
    /// Within a circle.
    Disc {
        /// Its middle, m.
        centre: [f64; 2],
        /// Its radius, m.
        radius: f64,
    },
}

impl std::fmt::Display for SupportArea {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Group(name) => write!(f, "`{name}`"),
            Self::Disc { centre, .. } => {
                let [x, y] = centre.map(|x| x * 1e3);
                write!(f, "the disc at ({x:.4}, {y:.4}) mm")
            }
        }
    }
}

/// Σ factor · unknown = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct EquationSpec {
    /// Its terms, each at a single node.
    pub terms: Vec<Term>,
    /// Where it stands.
    pub place: Place,
}

/// A term of an equation.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// The node: the group has one node and the levels are one.
    pub node: NodeSet,
    /// The unknown.
    pub dof: Dof,
    /// Turn of the node's own axes about z that the unknown refers to, radians.
    pub axes: f64,
    /// Its factor in SI units; all products factor · unknown of an equation have one dimension.
    pub factor: f64,
}

/// Nodes that share the value of each of some unknowns.
#[derive(Debug, Clone, PartialEq)]
pub struct Couple {
    /// The nodes.
    pub nodes: NodeSet,
    /// The unknowns.
    pub dofs: Vec<Dof>,
    /// Turn of the nodes' own axes about z that the unknowns refer to, radians.
    pub axes: f64,
    /// Where it stands.
    pub place: Place,
}

const LEVELS: [(&str, Levels); 4] =
    [("mid-plane", Levels::MidPlane), ("bottom", Levels::Bottom), ("top", Levels::Top), ("all", Levels::All)];

/// A group of the mesh, and which of its nodes above each other.
const GROUP: Key = key("group", Form::Text, r#""edge""#, "a group of the mesh").required();
pub(super) const LEVEL: Key =
    key("at", Form::Words(&words(&LEVELS)), r#""mid-plane""#, "which of the nodes above each other").required();
const DOFS: Form = Form::List(&Form::Text);

/// What a support may be.
pub(super) const SUPPORTS: &[Form] = &[Form::Table(KIND), Form::Table(FIX), Form::Table(RESTRAIN)];
const KIND: Keys = &[
    key("group", Form::Text, r#""edge""#, "a group of the mesh: edges, nodes or cells"),
    key(
        "disc",
        Form::Table(DISC),
        r#"{ x = "0 mm", y = "0 mm", radius = "5 mm" }"#,
        "the nodes within a circle, instead of a group, as under a clamp",
    ),
    key("kind", Form::Words(&words(&SupportKind::ALL)), r#""clamped""#, "what is held there").required(),
    key(
        "at",
        Form::Words(&words(&LEVELS)),
        r#""bottom""#,
        "which of the nodes above each other; \"all\", of a hinge and a roller \"mid-plane\", of a rest \"bottom\", if left out",
    ),
    key(
        "stiffness",
        Form::Text,
        r#""50 N/mm^2""#,
        "of a roller or a rest that gives way: force per deflection, and per length of an edge or per area of cells and discs",
    ),
];
const DISC: Keys = &[
    key("x", Form::Quantity(Dimension::LENGTH), r#""0 mm""#, "x of its middle").required(),
    key("y", Form::Quantity(Dimension::LENGTH), r#""0 mm""#, "y of its middle").required(),
    key("radius", Form::Quantity(Dimension::LENGTH), r#""5 mm""#, "its radius").required(),
];
const FIX: Keys = &[
    GROUP,
    LEVEL,
    key("fix", DOFS, r#"["U30"]"#, "unknowns that stay zero: Unm is displacement n, derived along m (0: not derived)")
        .required(),
    AXES,
];
const AXES: Key =
    key("axes", Form::Quantity(Dimension::NONE), r#""30 deg""#, "turn about z of the axes that the unknowns refer to")
        .default(r#""0 deg""#);
const RESTRAIN: Keys = &[key(
    "restrain",
    Form::Words(&["rigid-motions"]),
    r#""rigid-motions""#,
    "at rest: holds what other supports leave free, without straining the plate; in motion: leaves it free",
)
.required()];
pub(super) const EQUATION: Keys = &[key(
    "terms",
    Form::List(&Form::Table(TERM)),
    r#"[{ group = "a", at = "top", dof = "U10", factor = 1.0 }]"#,
    "the sum of factor times unknown that is zero",
)
.required()];
const TERM: Keys = &[
    GROUP,
    LEVEL,
    key("dof", Form::Text, r#""U10""#, "the unknown").required(),
    AXES,
    key(
        "factor",
        Form::OneOf(&[Form::Number, Form::Text]),
        "1.0",
        "its factor: a number, or one with a unit where displacements and slopes meet",
    )
    .required(),
];
/// Unknowns that are named: of the nodes of a group, or of the node at a point.
pub(super) const UNKNOWNS: Keys =
    &[run::AT[0], run::AT[1], run::AT[2], LEVEL, key("dofs", DOFS, r#"["U30"]"#, "unknowns of these nodes").required()];
pub(super) const COUPLE: Keys =
    &[GROUP, LEVEL, key("dofs", DOFS, r#"["U30"]"#, "unknowns that all these nodes share").required(), AXES];

pub(super) fn read_all(field: &SceneValue<'_>) -> Result<Vec<Support>, SceneError> {
    field.list()?.iter().map(read).collect()
}

/// Whether one of the supports only pushes; of those that can be read.
pub(super) fn may_lift_off(field: &SceneValue<'_>) -> bool {
    let pushes = |support: &Support| matches!(support, Support::Kind { kind: SupportKind::Rest, .. });
    field.list().is_ok_and(|all| all.iter().filter_map(|field| read(field).ok()).any(|support| pushes(&support)))
}

fn read(field: &SceneValue<'_>) -> Result<Support, SceneError> {
    let table = field.table_of(SUPPORTS)?;
    let place = table.place().clone();
    if table.optional("restrain").is_some() {
        field.table(RESTRAIN)?.required("restrain")?.choice(&[("rigid-motions", ())])?;
        return Ok(Support::RestrainRigidMotions { place });
    }
    if table.optional("kind").is_some() {
        return read_kind(&field.table(KIND)?, place);
    }
    if table.optional("fix").is_none() {
        return Err(field.error(
            "says where the plate is held, and not how",
            "add `kind`, for example kind = \"clamped\", or name unknowns: fix = [\"U30\"]",
        ));
    }
    Ok(Support::Fix { nodes: nodes(&table)?, dofs: dofs(&table.required("fix")?)?, axes: axes(&table)?, place })
}

fn read_kind(table: &Reader<'_>, place: Place) -> Result<Support, SceneError> {
    let field = table.required("kind")?;
    let kind = field.choice(&SupportKind::ALL)?;
    let area = match (table.optional("group"), table.optional("disc")) {
        (Some(group), None) => group.at(SupportArea::Group(group.text()?.to_owned())),
        (None, Some(disc)) => {
            let keys = disc.table(DISC)?;
            let [x, y] = ["x", "y"].map(|key| keys.required(key)?.quantity(Dimension::LENGTH));
            let radius = keys.required("radius")?.positive(Dimension::LENGTH)?;
            disc.at(SupportArea::Disc { centre: [x?, y?], radius })
        }
        _ => {
            return Err(
                field.error("is of a group or of a disc, of one of them", "write group = \"edge\", for example")
            );
        }
    };
    let levels = table.optional("at").map_or(Ok(kind.levels()), |at| at.choice(&LEVELS))?;
    let stiffness = table.optional("stiffness").map(|field| stiffness(&field, kind)).transpose()?;
    Ok(Support::Kind { area, kind, levels, stiffness, place })
}

fn stiffness(field: &SceneValue<'_>, kind: SupportKind) -> Result<Located<(f64, Dimension)>, SceneError> {
    if !matches!(kind, SupportKind::Roller | SupportKind::Rest) {
        let message = format!("a support of kind \"{}\" does not give way", kind.name());
        return Err(field.error(message, "write kind = \"roller\", or kind = \"rest\" where the plate may lift off"));
    }
    let (value, dimension) = field.any_quantity(field.text()?)?;
    if !(value > 0.0 && value.is_finite()) {
        return Err(field.error("a stiffness is positive", "leave it out for a support that does not give way"));
    }
    Ok(field.at((value, dimension)))
}

fn axes(table: &Reader<'_>) -> Result<f64, SceneError> {
    table.optional("axes").map_or(Ok(0.0), |field| field.quantity(Dimension::NONE))
}

pub(super) fn read_equations(field: &SceneValue<'_>) -> Result<Vec<EquationSpec>, SceneError> {
    let read = |field: &SceneValue<'_>| {
        let table = field.table(EQUATION)?;
        Ok(EquationSpec { terms: terms(&table.required("terms")?)?, place: table.place().clone() })
    };
    field.list()?.iter().map(read).collect()
}

pub(super) fn read_couples(field: &SceneValue<'_>) -> Result<Vec<Couple>, SceneError> {
    let read = |field: &SceneValue<'_>| {
        let table = field.table(COUPLE)?;
        let (nodes, dofs) = (nodes(&table)?, dofs(&table.required("dofs")?)?);
        Ok(Couple { nodes, dofs, axes: axes(&table)?, place: table.place().clone() })
    };
    field.list()?.iter().map(read).collect()
}

/// Unknowns of some nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknowns {
    /// The nodes of a group, or the one at a point.
    pub at: Located<ImpactPoint>,
    /// Which of the nodes above each other.
    pub levels: Levels,
    /// Which unknowns.
    pub dofs: Vec<Dof>,
}

pub(super) fn unknowns(field: &SceneValue<'_>) -> Result<Unknowns, SceneError> {
    let table = field.table(UNKNOWNS)?;
    let (at, levels) = (field.at(run::point(&table)?), table.required("at")?.choice(&LEVELS)?);
    Ok(Unknowns { at, levels, dofs: dofs(&table.required("dofs")?)? })
}

pub(super) fn nodes(table: &Reader<'_>) -> Result<NodeSet, SceneError> {
    let group = table.required("group")?;
    Ok(NodeSet { group: group.at(group.text()?.to_owned()), levels: table.required("at")?.choice(&LEVELS)? })
}

pub(super) fn dofs(field: &SceneValue<'_>) -> Result<Vec<Dof>, SceneError> {
    field.list()?.iter().map(dof).collect()
}

pub(super) fn dof(field: &SceneValue<'_>) -> Result<Dof, SceneError> {
    field
        .text()?
        .parse()
        .map_err(|why: DofError| field.error(why.to_string(), "U30 is the deflection along z, U31 its slope along x"))
}

fn terms(field: &SceneValue<'_>) -> Result<Vec<Term>, SceneError> {
    let mut product = None;
    let mut read = |field: &SceneValue<'_>| {
        let table = field.table(TERM)?;
        let dof = dof(&table.required("dof")?)?;
        let factor_field = table.required("factor")?;
        let (factor, Dimension(mut exponents)) = factor(&factor_field)?;
        // U₁₀ is a length, its derivatives are pure numbers.
        exponents[0] += f64::from(dof.m() == 0);
        if !product.get_or_insert(Dimension(exponents)).matches(&Dimension(exponents)) {
            return Err(factor_field.error(
                "the terms of an equation have different dimensions",
                "a displacement Un0 is a length and a derivative a pure number: give one of them a factor with unit, \"1 mm\"",
            ));
        }
        Ok(Term { node: nodes(&table)?, dof, axes: axes(&table)?, factor })
    };
    field.list()?.iter().map(&mut read).collect()
}

/// A factor and its dimension: a bare number is a pure one.
fn factor(field: &SceneValue<'_>) -> Result<(f64, Dimension), SceneError> {
    let (value, dimension) = match field.node() {
        Node::Text(text) => field.any_quantity(text)?,
        _ => (field.number()?, Dimension::NONE),
    };
    if value == 0.0 {
        return Err(field.error("a factor of zero takes the term out of the equation", "leave the term out"));
    }
    Ok((value, dimension))
}
