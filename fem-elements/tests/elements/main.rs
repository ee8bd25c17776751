//! The elements against their contract, polynomials, plate and beam theory, exact elasticity and independent implementations.
#![allow(clippy::unwrap_used)]

mod bent;
mod common;
mod contract;
mod delaunay;
mod dense;
mod hermite_wedge;
mod hex;
mod hex20;
mod large;
mod mitc4;
mod reference;
mod section;
mod wedge15;
