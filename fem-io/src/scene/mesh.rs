//! Where the mesh comes from: a file of gmsh, or a plate that is built in.

use crate::document::keys::{Form, Key, Keys, key, words};
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Located, SceneError};
use crate::document::tree::Node;
use crate::units;
use fem_core::mesh::{Curves, Graded, MAX_CELLS, Outline};
use fem_core::plugin::Dimension;
use std::path::{Path, PathBuf};

/// Where the mesh comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshSource {
    /// A file of gmsh.
    File {
        /// Its path, resolved against the folder of the scene.
        file: Located<PathBuf>,
        /// Size of the file's unit of length, m.
        metres_per_unit: f64,
        /// How often every cell is divided into four; [`refined_cells`] says whether that is too often.
        refine: Located<u32>,
        /// What becomes of curved edges then.
        curves: Curves,
        /// Groups along which the plate is cut: nodes of theirs may lie where others do.
        cuts: Vec<Located<String>>,
    },
    /// A rectangle from the origin with equal cells.
    Rectangle {
        /// Edges along x and y, m.
        size: [f64; 2],
        /// Cells along x and y, refined as the scene asks for.
        cells: [usize; 2],
        /// Parts of it that have names.
        parts: Vec<NamedPart>,
    },
    /// A disc or a rectangle about the origin whose cells grow from the impact.
    Graded {
        /// The plate; it can be divided.
        plate: Located<Graded>,
        /// How often every cell is divided into four.
        refine: u32,
        /// What becomes of curved edges then.
        curves: Curves,
    },
}

/// A rectangle with a name, within a mesh: its cells, or the edges or the node where it is a line or a point.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPart {
    /// Its name.
    pub name: Located<String>,
    /// Its corners with the least and the greatest x and y, m.
    pub corners: [[f64; 2]; 2],
}

/// Where a mesh may come from.
pub(super) const MESHES: &[Form] =
    &[Form::Table(FILE), Form::Table(RECTANGLE), Form::Table(BUILT_DISC), Form::Table(BUILT_PLATE)];
const FILE: Keys = &[
    key("file", Form::Text, r#""plate.msh""#, "a mesh of gmsh, Abaqus or Nastran; counts from the folder of the scene")
        .required(),
    key("unit", Form::Text, r#""mm""#, "unit of its coordinates").required(),
    REFINE,
    CURVES,
    key(
        "cuts",
        Form::List(&Form::Text),
        r#"["slit"]"#,
        "groups of edges along which the plate is cut on purpose, each face with nodes of its own at the same places",
    ),
];
const RECTANGLE: Keys = &[
    key(
        "rectangle",
        Form::Several(2, &Form::Quantity(Dimension::LENGTH)),
        r#"["100 mm", "50 mm"]"#,
        "edges along x and y, from the origin; its groups are x-min, x-max, y-min, y-max and plate",
    )
    .required(),
    key("cells", Form::Several(2, &Form::Count(1)), "[8, 4]", "cells along x and y").required(),
    REFINE,
    key(
        "groups",
        Form::Named(&Form::Table(PART)),
        r#"{ crack = { x = ["0 mm", "30 mm"] }, roller = { x = "50 mm" } }"#,
        "more groups by names of your own: the cells of a part, the edges of a line, the node at a point",
    ),
];
const PART: Keys = &[
    key("x", SPAN, r#"["0 mm", "30 mm"]"#, "from where to where along x, or at which x; everywhere if left out"),
    key("y", SPAN, r#""5 mm""#, "the same along y"),
];
const SPAN: Form =
    Form::OneOf(&[Form::Quantity(Dimension::LENGTH), Form::Several(2, &Form::Quantity(Dimension::LENGTH))]);
const BUILT_DISC: Keys = &[
    key(
        "disc",
        Form::Table(DISC),
        r#"{ radius = "25 mm", size = "1 mm" }"#,
        "a disc about the origin, its cells growing from the impact; groups plate, edge, impact, support",
    )
    .required(),
    REFINE,
    CURVES,
];
const BUILT_PLATE: Keys = &[
    key(
        "plate",
        Form::Table(PLATE),
        r#"{ sides = ["100 mm", "100 mm"], support = "25 mm", size = "1 mm" }"#,
        "a rectangle about the origin, cells growing from the impact; groups plate, edge, x-min …, impact, support, window",
    )
    .required(),
    REFINE,
    CURVES,
];
const DISC: Keys = &[
    key("radius", Form::Quantity(Dimension::LENGTH), r#""25 mm""#, "radius of the disc").required(),
    SUPPORT,
    IMPACT,
    SIZE,
    EDGE_SIZE,
];
const PLATE: Keys = &[
    key(
        "sides",
        Form::Several(2, &Form::Quantity(Dimension::LENGTH)),
        r#"["100 mm", "100 mm"]"#,
        "edges along x and y",
    )
    .required(),
    SUPPORT,
    key(
        "window",
        Form::Several(2, &Form::Quantity(Dimension::LENGTH)),
        r#"["75 mm", "75 mm"]"#,
        "lengths along x and y of the window of a frame about the origin, whose sides become the group `window`",
    ),
    IMPACT,
    SIZE,
    EDGE_SIZE,
];
const SUPPORT: Key = key(
    "support",
    Form::Quantity(Dimension::LENGTH),
    r#""20 mm""#,
    "radius of a ring, which becomes the group `support`",
);
const IMPACT: Key = key(
    "impact",
    Form::Several(2, &Form::Quantity(Dimension::LENGTH)),
    r#"["0 mm", "0 mm"]"#,
    "where cells are smallest; a node there is the group `impact`",
)
.default(r#"["0 mm", "0 mm"]"#);
const SIZE: Key = key("size", Form::Quantity(Dimension::LENGTH), r#""1 mm""#, "size of the cells there").required();
const EDGE_SIZE: Key = key(
    "edge_size",
    Form::Quantity(Dimension::LENGTH),
    r#""3 mm""#,
    "size of the cells at the edge; three times `size` if left out",
);
const REFINE: Key = key("refine", Form::Count(0), "1", "how often every cell is divided into four").default("0");
const CURVES: Key = key(
    "curves",
    Form::Words(&words(&Curves::ALL)),
    r#""kept""#,
    "what becomes of curved edges when cells are divided",
)
.default(r#""kept""#);

/// `edge_size` over `size` unless a scene says otherwise.
const COARSENING: f64 = 3.0;

/// A mesh that would have too many cells when refined.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("refining {times} times makes more than {MAX_CELLS} cells of {cells}")]
pub struct TooManyCells {
    /// Cells of the mesh.
    pub cells: usize,
    /// How often each is to be divided into four.
    pub times: u32,
}

/// Number of cells when each of `cells` is divided into four, `times` in a row.
///
/// # Errors
/// More than four million.
pub fn refined_cells(cells: usize, times: u32) -> Result<usize, TooManyCells> {
    let refined = 4_usize.checked_pow(times).and_then(|parts| cells.checked_mul(parts));
    refined.filter(|n| *n <= MAX_CELLS).ok_or(TooManyCells { cells, times })
}

pub(super) fn read(field: &SceneValue<'_>, scene: &Path) -> Result<MeshSource, SceneError> {
    let any = field.table_of(MESHES)?;
    let has = |key| any.optional(key).is_some();
    if has("rectangle") {
        return rectangle(&field.table(RECTANGLE)?);
    }
    if has("disc") {
        let table = field.table(BUILT_DISC)?;
        let disc = table.required("disc")?;
        let keys = disc.table(DISC)?;
        let outline = Outline::Disc { radius: keys.required("radius")?.positive(Dimension::LENGTH)? };
        return graded(&table, &disc, &keys, outline);
    }
    if has("plate") {
        let table = field.table(BUILT_PLATE)?;
        let plate = table.required("plate")?;
        let keys = plate.table(PLATE)?;
        let sides = pair(&keys.required("sides")?, |field| field.positive(Dimension::LENGTH))?;
        return graded(&table, &plate, &keys, Outline::Rectangle { sides });
    }
    let table = field.table(FILE)?;
    let file = table.required("file")?;
    let path = scene.parent().unwrap_or(Path::new("")).join(file.text()?);
    let unit = table.required("unit")?;
    let metres_per_unit = units::parse_as(&format!("1 {}", unit.text()?), Dimension::LENGTH)
        .map_err(|_| unit.error("must be a unit of length", "write the unit of the file's coordinates: mm, m, in"))?;
    let refine = refine(&table, 1)?;
    let cut = |field: &SceneValue<'_>| Ok(field.at(field.text()?.to_owned()));
    let cuts = table.optional("cuts").map_or(Ok(Vec::new()), |field| field.list()?.iter().map(cut).collect())?;
    Ok(MeshSource::File { file: file.at(path), metres_per_unit, refine, curves: curves(&table)?, cuts })
}

fn rectangle(table: &Reader<'_>) -> Result<MeshSource, SceneError> {
    let size = pair(&table.required("rectangle")?, |field| field.positive(Dimension::LENGTH))?;
    let field = table.required("cells")?;
    let cells = pair(&field, |field| field.count())?;
    let all = match cells[0].checked_mul(cells[1]) {
        Some(n) if n <= MAX_CELLS => n,
        _ => {
            return Err(
                field.error(format!("{} x {} cells", cells[0], cells[1]), format!("at most {MAX_CELLS} in all"))
            );
        }
    };
    let refine = refine(table, all)?;
    let parts = match table.optional("groups") {
        Some(field) => {
            field.entries()?.iter().map(|(name, field)| part(name, field, size)).collect::<Result<_, _>>()?
        }
        None => Vec::new(),
    };
    Ok(MeshSource::Rectangle { size, cells: cells.map(|n| n << refine.value), parts })
}

/// A part of a rectangle of this `size` that is called `name`.
fn part(name: &str, field: &SceneValue<'_>, size: [f64; 2]) -> Result<NamedPart, SceneError> {
    if BUILT.contains(&name) {
        return Err(field.error(format!("`{name}` is a group of every rectangle"), "choose another name"));
    }
    let table = field.table(PART)?;
    let span = |key: &str, whole: f64| {
        let Some(field) = table.optional(key) else { return Ok([0.0, whole]) };
        let ends = match field.node() {
            Node::List(_) => pair(&field, |end| end.quantity(Dimension::LENGTH))?,
            _ => [field.quantity(Dimension::LENGTH)?; 2],
        };
        if ends[0] > ends[1] {
            return Err(field.error("ends before it begins", "write the smaller end first"));
        }
        Ok(ends)
    };
    let [x, y] = [span("x", size[0])?, span("y", size[1])?];
    Ok(NamedPart { name: field.at(name.to_owned()), corners: [0, 1].map(|end| [x[end], y[end]]) })
}

/// Groups of every rectangle.
const BUILT: [&str; 5] = ["x-min", "x-max", "y-min", "y-max", "plate"];

/// A plate of the mesh `table`, described by `keys`, the value of `field`.
fn graded(
    table: &Reader<'_>,
    field: &SceneValue<'_>,
    keys: &Reader<'_>,
    outline: Outline,
) -> Result<MeshSource, SceneError> {
    let length = |field: SceneValue<'_>| field.positive(Dimension::LENGTH);
    let size = length(keys.required("size")?)?;
    let at_impact = |field: SceneValue<'_>| pair(&field, |field| field.quantity(Dimension::LENGTH));
    let plate = Graded {
        outline,
        support: keys.optional("support").map(length).transpose()?,
        window: match outline {
            Outline::Disc { .. } => None,
            Outline::Rectangle { .. } => keys
                .optional("window")
                .map(|field| pair(&field, |field| field.positive(Dimension::LENGTH)))
                .transpose()?,
        },
        impact: keys.optional("impact").map_or(Ok([0.0; 2]), at_impact)?,
        size,
        edge_size: keys.optional("edge_size").map_or(Ok(COARSENING * size), length)?,
    };
    let cells = plate.cells().map_err(|wrong| {
        let at = keys.optional(&wrong.key);
        let help = "`fem mesh` shows what becomes of a scene's mesh";
        at.as_ref().unwrap_or(field).error(wrong.why, help)
    })?;
    Ok(MeshSource::Graded { plate: field.at(plate), refine: refine(table, cells)?.value, curves: curves(table)? })
}

fn curves(table: &Reader<'_>) -> Result<Curves, SceneError> {
    table.optional("curves").map_or(Ok(Curves::Kept), |field| field.choice(&Curves::ALL))
}

/// How often a mesh of at least `cells` cells is refined.
fn refine(table: &Reader<'_>, cells: usize) -> Result<Located<u32>, SceneError> {
    let Some(field) = table.optional("refine") else { return Ok(Located { value: 0, place: table.place().clone() }) };
    let times = field.at_least(0)? as u32;
    refined_cells(cells, times).map_err(|why| field.error(why.to_string(), "refine less often"))?;
    Ok(field.at(times))
}

/// Two values: along x and along y.
pub(super) fn pair<T>(
    field: &SceneValue<'_>,
    read: impl Fn(&SceneValue<'_>) -> Result<T, SceneError>,
) -> Result<[T; 2], SceneError> {
    let parts = field.list()?;
    match &parts[..] {
        [x, y] => Ok([read(x)?, read(y)?]),
        _ => Err(field.error(format!("has {} values", parts.len()), "give two: along x and y")),
    }
}
