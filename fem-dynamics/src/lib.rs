//! x
pub mod contact;
pub mod integrate;
