//! The response: reductions, contact laws, the coupled system of structure and impactors, time integration.

pub mod contact;
pub mod impact;
pub mod integrate;
pub mod limit;
pub mod reduce;
