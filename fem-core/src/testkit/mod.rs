//! Checks of the plug-in contracts: each returns the first violation in words. For the tests of plug-in crates.

mod card;
mod contact;
mod criterion;
mod element;
mod integrator;

pub use card::card;
pub use contact::check_contact_law;
pub use criterion::check_criterion;
pub use element::{Provided, check_element};
pub use integrator::{Mode, Oscillators, check_integrator};
