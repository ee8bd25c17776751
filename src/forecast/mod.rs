//! What a run will take, from counts alone: memory, time, and what effects and finer settings cost.

mod effects;
mod memory;
mod size;
mod time;

pub(crate) use effects::Work;
pub use memory::MemoryEstimate;
pub(crate) use memory::analysed;
pub use size::Size;
pub(crate) use time::{FILL, nominal};
pub use time::{PHASES, one_level_better, seconds_per_phase};
