//! What supports leave free.

use crate::model::Model;
use fem_core::assembly::softness;
use fem_core::structure::Structure;

/// Share of the work of a load from which on the user should know of it.
const WORTH: f64 = 0.01;

/// Share of the work of a `load` on its displacements, both of the structure's unknowns, that supports of nodal values cost between the
/// nodes; none below one in a hundred, of condensed plates, and of a structure that has no answer.
pub(super) fn soft(model: &Model, structure: &mut dyn Structure, at_rest: (&[f64], &[f64])) -> Option<f64> {
    if model.between.is_empty() || model.division.is_some() {
        return None;
    }
    softness(structure, &model.between, at_rest, WORTH).ok().flatten()
}

/// The same under a `load` whose displacements are still to be found: small ones, of a plate that nothing has happened to.
pub(super) fn soft_under(model: &Model, structure: &mut dyn Structure, load: &[f64]) -> Option<f64> {
    if model.between.is_empty() || model.division.is_some() {
        return None;
    }
    let mut u = load.to_vec();
    structure.solve_shifted(0.0, &mut u, 1).ok()?;
    soft(model, structure, (load, &u))
}

/// The largest of these shares among the loads K φ that hold the plate in one of `shapes` φ.
pub(super) fn soft_shapes(model: &Model, structure: &mut dyn Structure, shapes: &[f64]) -> Option<f64> {
    let share = |shape: &[f64]| {
        let mut load = vec![0.0; shape.len()];
        structure.add_stiffness(1.0, shape, &mut load);
        soft(model, structure, (&load, shape))
    };
    shapes.chunks_exact(model.constraints.ndof().max(1)).filter_map(share).reduce(f64::max)
}
