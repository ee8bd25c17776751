//! Matrices of parts that say themselves which unknowns they join: no plate is needed.

use super::cell_map::CellMap;
use super::pattern::Cliques;
use super::{Pattern, Symmetric};
use crate::plates::constraint::Constraints;
use std::sync::Arc;

/// The pattern of parts with these unknowns (before constraints); every independent unknown belongs to one of them.
pub fn block_pattern<'a>(blocks: impl IntoIterator<Item = &'a [usize]>, constraints: &Constraints) -> Pattern {
    let (mut map, mut cliques) = (CellMap::default(), Cliques::default());
    for unknowns in blocks {
        map.set_unknowns(unknowns, constraints);
        cliques.push(&map.reduced);
    }
    cliques.pattern(constraints.ndof())
}

/// Σ Cᵀ A C of parts, A of the unknowns of each, both triangles, column-major.
pub fn assemble_blocks<'a>(
    pattern: &Arc<Pattern>,
    blocks: impl IntoIterator<Item = (&'a [usize], &'a [f64])>,
    constraints: &Constraints,
) -> Symmetric {
    let (mut sum, mut map) = (Symmetric::zero(pattern.clone()), CellMap::default());
    for (unknowns, matrix) in blocks {
        map.set_unknowns(unknowns, constraints);
        map.scatter(matrix, 1.0, &mut sum);
    }
    sum
}
