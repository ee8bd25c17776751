//! What fields take on the disk.

use super::Layout;
use crate::error::Error;
use crate::model::Model;
use fem_io::vtu::{Array, Grid};

/// XML and headers of a file, bytes.
const FILE: f64 = 2500.0;

/// What `frames` frames take, in words, where the scene asks for fields.
///
/// # Errors
/// A criterion whose material lacks a constant.
pub(crate) fn expected(model: &Model, frames: usize) -> Result<Option<String>, Error> {
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
    let s = if frames == 1 { "" } else { "s" };
    let size = if bytes < 1e6 { format!("{:.2}", bytes * 1e-6) } else { format!("{:.1}", bytes * 1e-6) };
    Ok(Some(format!("{frames} frame{s} of {} series, about {size} MB", series.len())))
}
