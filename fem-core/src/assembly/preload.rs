//! A plate that is loaded before anything else happens to it: its displacements, and what its stresses add to its stiffness.

use super::cell_map::CellMap;
use super::{AssemblyError, Matrix, SparseStructure, Symbolic, Symmetric, assemble, pattern};
use crate::contracts::element::{Cell, Element, ElementError, Scratch, form};
use crate::contracts::structure::{SolveError, Structure};
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;
use crate::words::counters::Counters;
use crate::words::functional::Functional;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Displacements at rest, one per unknown, under `forces`, one per unknown as well, and under the displacements that
/// `constraints` prescribe: with u = C ũ + g, Cᵀ K C ũ = Cᵀ (f − K g).
///
/// # Errors
/// A cell that the element refuses, a plate that is not held.
pub fn displacements_at_rest(
    plate: &Plate,
    element: &dyn Element,
    constraints: &Constraints,
    forces: &[f64],
    threads: NonZeroUsize,
) -> Result<Vec<f64>, SolveError> {
    let n = constraints.ndof();
    let nodal: Vec<(usize, f64)> = forces.iter().copied().enumerate().filter(|(_, force)| *force != 0.0).collect();
    let (mut u, mut all) = (vec![0.0; n], vec![0.0; plate.ndof()]);
    Functional(constraints.restrict(&nodal)).add_to(1.0, &mut u);
    constraints.expand(&vec![0.0; n], &mut all);
    let (mut scratch, mut stiffness, mut given, mut force) = (Scratch::default(), Vec::new(), Vec::new(), Vec::new());
    each_cell(plate, element, constraints, |element, cell, map, weight| {
        let n = element.info().ndof();
        given.resize(n, 0.0);
        map.gather(&all, &mut given);
        if given.iter().all(|u| *u == 0.0) {
            return Ok(());
        }
        stiffness.resize(n * n, 0.0);
        element.stiffness(cell, &mut scratch, &mut stiffness)?;
        force.clear();
        force.extend(
            stiffness.chunks_exact(n).map(|column| -column.iter().zip(&given).map(|(k, u)| k * u).sum::<f64>()),
        );
        map.scatter_vector(&force, weight, &mut u);
        Ok(())
    })
    .map_err(SolveError::other)?;
    let pattern = Arc::new(pattern(plate, constraints));
    let assembled =
        assemble(plate, element, constraints, &pattern, Matrix::Stiffness, threads, &mut Counters::default());
    let (k, m) = (assembled.map_err(SolveError::other)?, Symmetric::zero(pattern.clone()));
    let (described, originals) = (plate.clone(), constraints.clone());
    let name = move |i: usize| described.describe(originals.original(i));
    let symbolic = Symbolic::new(pattern).map_err(SolveError::other)?;
    SparseStructure::new(symbolic, k, m, threads, name).solve_shifted(0.0, &mut u, 1)?;
    constraints.expand(&u, &mut all);
    Ok(all)
}

/// Adds to `sum`, on the pattern of K, the geometric stiffness of the stresses of small displacements `u`, one per unknown
/// ([`LargeDeflection::geometric_stiffness`](crate::contracts::large::LargeDeflection::geometric_stiffness)).
///
/// # Errors
/// A cell that the element refuses, an element that knows no large deflections.
pub fn add_geometric_stiffness(
    plate: &Plate,
    element: &dyn Element,
    constraints: &Constraints,
    u: &[f64],
    sum: &mut Symmetric,
) -> Result<(), AssemblyError> {
    let (mut scratch, mut of_cell, mut local) = (Scratch::default(), Vec::new(), Vec::new());
    each_cell(plate, element, constraints, |element, cell, map, weight| {
        let large = element.large_deflections().ok_or_else(|| ElementError(NO_PRELOAD.into()))?;
        let n = element.info().ndof();
        local.resize(n, 0.0);
        of_cell.resize(n * n, 0.0);
        map.gather(u, &mut local);
        large.geometric_stiffness(cell, &local, &mut scratch, &mut of_cell)?;
        map.scatter(&of_cell, weight, sum);
        Ok(())
    })
}

const NO_PRELOAD: &str = "the element carries no preload: it knows no large deflections";

/// Calls `each` for every cell that counts, with what it counts for.
fn each_cell(
    plate: &Plate,
    element: &dyn Element,
    constraints: &Constraints,
    mut each: impl FnMut(&dyn Element, &Cell<'_>, &mut CellMap, f64) -> Result<(), ElementError>,
) -> Result<(), AssemblyError> {
    let mut map = CellMap::default();
    for (cell, weight) in plate.kept_cells() {
        let view = plate.cell(cell);
        map.set(plate, constraints, cell);
        each(form(element, view.corners.domain()), &view, &mut map, weight).map_err(|error| {
            let (quad, layer) = plate.place(cell);
            AssemblyError { quad_tag: plate.plane.quad_tags[quad], layer, error }
        })?;
    }
    Ok(())
}
