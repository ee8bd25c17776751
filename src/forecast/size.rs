//! Sizes from which the time of a run follows.

use fem_core::counters::Counters;
use serde::{Deserialize, Serialize};

/// Sizes of a model and the work that it takes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Size {
    /// Cells.
    pub cells: usize,
    /// Layers of cells.
    pub layers: usize,
    /// Edge of a square as large as a cell is on average, m; of a section, a cell's mean length.
    pub cell_m: f64,
    /// Columns of nodes.
    pub columns: usize,
    /// Independent unknowns.
    pub unknowns: usize,
    /// Unknowns of the march.
    pub marched: usize,
    /// Whether the march is that of a reduced model.
    pub reduced: bool,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// Places whose stresses are judged.
    pub sites: usize,
    /// Step, s; zero where nothing is marched.
    pub step_s: f64,
    /// Samples of the stresses.
    pub samples: u64,
    /// Work done.
    pub work: Counters,
}
