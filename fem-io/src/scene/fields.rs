//! Fields over the plate: which are written, when, and over which part of it.

use super::run::MarchSpec;
use crate::document::keys::{Form, Keys, key, words};
use crate::document::reader::SceneValue;
use crate::document::source::{Located, SceneError};
use crate::document::tree::Node;
use fem_core::plugin::Dimension;

/// Fields that are written as files of VTK.
#[derive(Debug, Clone, PartialEq)]
pub struct Fields {
    /// Time between two frames, s.
    pub every: Option<f64>,
    /// Times of further frames, s.
    pub times: Vec<f64>,
    /// The part of the plate; all of it if `None`.
    pub region: Option<Region>,
    /// The series; all that the scene has if `None`.
    pub parts: Option<Vec<Located<FieldSeries>>>,
    /// What the cells of the plate become.
    pub cells: FieldCells,
}

/// A part of a plate.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// Cells whose centres are within this distance of an impact, m.
    Radius(Located<f64>),
    /// Cells of this group of the mesh.
    Group(Located<String>),
}

/// A series of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldSeries {
    /// Cells of the elements with displacements.
    Plate,
    /// Plies with stresses.
    Plies,
    /// Interfaces with tractions.
    Interfaces,
}

impl FieldSeries {
    const ALL: [(&'static str, Self); 3] =
        [("plate", Self::Plate), ("plies", Self::Plies), ("interfaces", Self::Interfaces)];

    /// Its name in scenes and files.
    pub const fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }
}

/// What the cells of the elements become in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldCells {
    /// One cubic cell.
    Lagrange,
    /// 3 x 3 x 3 linear ones, which every reader knows.
    Subdivided,
}

pub(super) const KEYS: Keys = &[
    key(
        "every",
        Form::Quantity(Dimension::TIME),
        r#""50 us""#,
        "time between two frames; a tenth of the march if `times` is left out too",
    ),
    key("times", Form::List(&Form::Quantity(Dimension::TIME)), r#"["0.1 ms", "0.45 ms"]"#, "times of further frames"),
    key("region", Form::Table(REGION), r#"{ radius = "10 mm" }"#, "part of the plate; all if left out"),
    key(
        "parts",
        Form::List(&Form::Words(&words(&FieldSeries::ALL))),
        r#"["plate", "plies", "interfaces"]"#,
        "the series; all that the scene has if left out",
    ),
    key("cells", Form::Words(&words(&CELLS)), r#""lagrange""#, "what cells of the plate become")
        .default(r#""lagrange""#),
];
const REGION: Keys = &[
    key("radius", Form::Quantity(Dimension::LENGTH), r#""10 mm""#, "cells within this distance of an impact"),
    key("group", Form::Text, r#""core""#, "cells of a group of the mesh"),
];
const CELLS: [(&str, FieldCells); 2] = [("lagrange", FieldCells::Lagrange), ("subdivided", FieldCells::Subdivided)];

/// Intervals unless the scene says otherwise.
const INTERVALS: f64 = 10.0;

/// Most frames: more is a mistake, and would fill the disk.
const MOST_FRAMES: f64 = 1e4;

/// Reads `output.fields`: `None` for `false`. `march` is that of an impact.
pub(super) fn read(field: &SceneValue<'_>, march: Option<&MarchSpec>) -> Result<Option<Fields>, SceneError> {
    let cells = FieldCells::Lagrange;
    let every = march.map(|march| march.end.value / INTERVALS);
    let mut fields = Fields { every, times: Vec::new(), region: None, parts: None, cells };
    if let Node::Flag(wanted) = field.node() {
        return Ok(wanted.then_some(fields));
    }
    let table = field.table(KEYS)?;
    let [every, times] = ["every", "times"].map(|key| table.optional(key));
    if let (None, Some(stray)) = (march, every.as_ref().or(times.as_ref())) {
        return Err(stray.error("only an impact is marched in time", "leave it out: every state found is written"));
    }
    if let Some(march) = march {
        if times.is_some() {
            fields.every = None;
        }
        if let Some(field) = every {
            fields.every = Some(read_interval(&field, march)?);
        }
        if let Some(field) = times {
            fields.times = field.list()?.iter().map(|field| read_time(field, march)).collect::<Result<_, _>>()?;
        }
    }
    fields.region = table.optional("region").map(|field| read_region(&field)).transpose()?;
    if let Some(field) = table.optional("parts") {
        let series = field.list()?;
        let series = series.iter().map(|field| Ok(field.at(field.choice(&FieldSeries::ALL)?)));
        fields.parts = Some(series.collect::<Result<_, _>>()?);
    }
    if let Some(field) = table.optional("cells") {
        fields.cells = field.choice(&CELLS)?;
    }
    Ok(Some(fields))
}

fn read_interval(field: &SceneValue<'_>, march: &MarchSpec) -> Result<f64, SceneError> {
    let every = field.positive(Dimension::TIME)?;
    let frames = march.end.value / every.max(march.step.value);
    if frames > MOST_FRAMES {
        let message = format!("a frame every {every:e} s makes {frames:.0} frames");
        return Err(field.error(message, format!("at most {MOST_FRAMES:.0} are written: lengthen the interval")));
    }
    Ok(every)
}

fn read_time(field: &SceneValue<'_>, march: &MarchSpec) -> Result<f64, SceneError> {
    let (time, end) = (field.quantity(Dimension::TIME)?, march.end.value);
    if !(0.0..=end).contains(&time) {
        let message = format!("{time:e} s is not within the march, which ends at {end:e} s");
        return Err(field.error(message, "give times from 0 to `march.end`"));
    }
    Ok(time)
}

fn read_region(field: &SceneValue<'_>) -> Result<Region, SceneError> {
    let table = field.table(REGION)?;
    match table.either(["radius", "group"])? {
        [Some(radius), None] => Ok(Region::Radius(radius.at(radius.positive(Dimension::LENGTH)?))),
        [_, Some(group)] => Ok(Region::Group(group.at(group.text()?.to_owned()))),
        [None, None] => Err(table.missing("radius", "give a radius around the impact, or a group of cells")),
    }
}
