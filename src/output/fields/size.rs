//! What fields take on the disk.

use super::Layout;
use crate::error::Error;
use crate::model::Model;
use fem_io::vtu::{Array, Grid};
use serde::Serialize;
use std::fmt;

/// XML and headers of a file, bytes.
const FILE: f64 = 2500.0;

/// What fields take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub(crate) struct Expected {
    frames: usize,
    series: usize,
    size_MB: f64,
}

/// As people read it.
impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames, series, size_MB } = self;
        let (s, digits) = (if *frames == 1 { "" } else { "s" }, if *size_MB < 1.0 { 2 } else { 1 });
        write!(f, "{frames} frame{s} of {series} series, about {size_MB:.digits$} MB")
    }
}

/// What `frames` frames take where the scene asks for fields.
///
/// # Errors
/// A criterion whose material lacks a constant.
pub(crate) fn expected(model: &Model, frames: usize) -> Result<Option<Expected>, Error> {
    let Some(Layout { plate, plies }) = Layout::new(model)? else { return Ok(None) };
    let fixed = |grid: &Grid, fixed: &[Array]| grid.size() + fixed.iter().map(Array::size).sum::<usize>();
    // Of each series the bytes that every frame has and the numbers that change.
    let mut series = Vec::new();
    if let Some(plate) = plate {
        let vectors = if model.moves() { 2 } else { 1 };
        series.push((fixed(&plate.grid, &plate.fixed), 3 * vectors * plate.grid.points()));
    }
    if let Some(plies) = &plies {
        for sheets in &plies.sheets {
            let numbers = 3 * sheets.grid.points() + plies.changing(sheets) * sheets.grid.cells();
            series.push((fixed(&sheets.grid, &sheets.fixed), numbers));
        }
    }
    let of_each = |(fixed, numbers): &(usize, usize)| FILE + (fixed + size_of::<f32>() * numbers) as f64;
    let bytes = frames as f64 * series.iter().map(of_each).sum::<f64>();
    Ok(Some(Expected { frames, series: series.len(), size_MB: bytes * 1e-6 }))
}
