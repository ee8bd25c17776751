//! Forces of free strains, such as those of a change of temperature.

use super::AssemblyError;
use super::cell_map::CellMap;
use crate::contracts::element::{Element, Scratch, form};
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;

/// The forces on the independent unknowns by which the free strains of the plies
/// ([`Slice::free`](crate::contracts::element::Slice::free)) move the plate, and the strain energy, J, of the plate held against them.
///
/// # Errors
/// A cell that the element refuses.
pub fn free_forces(
    plate: &Plate,
    element: &dyn Element,
    constraints: &Constraints,
) -> Result<(Vec<f64>, f64), AssemblyError> {
    let mut forces = vec![0.0; constraints.ndof()];
    let mut energy = 0.0;
    let mut of_cell = Vec::new();
    let (mut map, mut scratch) = (CellMap::default(), Scratch::default());
    for (cell, weight) in plate.kept_cells() {
        let view = plate.cell(cell);
        let element = form(element, view.corners.domain());
        of_cell.resize(element.info().ndof(), 0.0);
        let held = element.free_force(&view, &mut scratch, &mut of_cell).map_err(|error| {
            let (quad, layer) = plate.place(cell);
            AssemblyError { quad_tag: plate.plane.quad_tags[quad], layer, error }
        })?;
        energy += weight * held;
        map.set(plate, constraints, cell);
        map.scatter_vector(&of_cell, weight, &mut forces);
    }
    Ok((forces, energy))
}
