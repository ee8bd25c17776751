//! Small types that everything speaks: tensors, unknowns, materials, plies, counts. They do not depend on elements or
//! plates.

pub mod counters;
pub mod damping;
pub mod dof;
pub mod domain;
pub mod energy;
pub mod formula;
pub mod functional;
pub mod in_situ;
pub mod interval;
pub mod layup;
pub mod material;
pub mod prolongation;
pub mod quadrature;
pub(crate) mod spelling;
pub mod tensor;
pub mod vectorised;
