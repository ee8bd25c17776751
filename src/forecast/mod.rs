//! What a run will take, from counts alone: memory, time, and what finer settings cost.

mod memory;
mod size;
mod time;

pub(crate) use memory::analyse;
pub use memory::{Demand, MemoryEstimate};
pub use size::Size;
pub(crate) use time::FILL;
pub use time::{PHASES, nominal, one_level_better, seconds_per_phase};
