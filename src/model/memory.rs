//! A plate that is too large is refused before anything is made that grows with it.

use crate::cost::require;
use crate::error::Error;
use fem_core::plate::Plate;

/// Refuses a plate of which the matrices alone would be more than there is: before anything is made that grows with them.
pub(super) fn check(plate: &Plate) -> Result<(), Error> {
    let kept = plate.kept_cells().count() as f64 / plate.cells() as f64;
    let unknowns = plate.ndof() as f64 * kept;
    // Those of a cell lie in 4 columns and on 2 levels. One unknown meets those of 9 columns on its own and both adjacent
    // levels, and half of these entries are stored.
    let layers = plate.layers() as f64;
    let levels = (3.0 * layers + 1.0) / (layers + 1.0);
    let entries = unknowns * plate.info().ndof() as f64 * 9.0 / 4.0 * levels / 2.0 / 2.0;
    require(24.0 * entries, || format!("its stiffness has about {entries:.1e} entries"))
}
