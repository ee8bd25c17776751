//! What supports leave free.

use super::assembled::Assembled;
use crate::model::Model;
use fem_core::assembly::softness;

/// Share of the work of a load from which on the user should know of it.
const WORTH: f64 = 0.01;

/// Share of the work of a load on its displacements, both of the structure's unknowns, that supports of nodal values cost between the
/// nodes; none below one in a hundred, of condensed plates, and of a structure that has no answer.
pub(super) fn soft(model: &Model, assembled: &mut Assembled, at_rest: (&[f64], &[f64])) -> Option<f64> {
    if model.between.is_empty() || assembled.condensation.is_some() {
        return None;
    }
    softness(&mut assembled.structure, &model.between, at_rest, WORTH).ok().flatten()
}
