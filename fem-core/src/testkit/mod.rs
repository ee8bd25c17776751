//! Checks of the plug-in contracts: each returns the first violation in words. For the tests of plug-in crates.

mod card;
mod contact;
mod criterion;
mod element;
mod integrator;
mod interface_law;
mod law;
mod ply_law;

pub use card::card;
pub use contact::check_contact_law;
pub use criterion::check_criterion;
pub use element::{Provided, check_element};
pub use integrator::{Mode, Oscillators, check_integrator};
pub use interface_law::check_interface_law;
pub use law::Units;
pub use ply_law::check_ply_law;
