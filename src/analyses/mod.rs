//! What a model can be asked: the response to an impact, loads at rest, natural modes, buckling, its matrices.

pub mod assembled;
pub mod buckling;
pub mod delamination;
mod expansion;
pub mod impact;
mod kept;
pub mod matrices;
pub mod modes;
mod operator;
mod path;
mod samples;
pub(crate) mod saved;
pub mod statics;
pub mod stress;
mod stressed;
mod supports;

pub(crate) use expansion::Stressed;
