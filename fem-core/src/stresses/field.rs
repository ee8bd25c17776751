//! A displacement field of a plate, evaluated in its plies.

use crate::contracts::element::{Element, ElementError, Part, form};
use crate::plates::laminate::Laminate;
use crate::plates::plate::Plate;
use crate::words::tensor::{Global, Strain6, Stress6, stress};

/// A displacement field.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    plate: &'a Plate,
    laminates: &'a [Laminate],
    element: &'a dyn Element,
    /// Unknowns, before elimination of constraints.
    u: &'a [f64],
    large: bool,
}

/// Where a field is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Number of the quad.
    pub quad: usize,
    /// Natural coordinates in it.
    pub at: [f64; 2],
    /// Ply, counted from the bottom: at an interface strains belong to one of two.
    pub ply: usize,
    /// Height, m.
    pub z: f64,
}

impl<'a> Field<'a> {
    /// The field of the unknowns `u`, with small strains; one laminate for each region of the plate.
    pub fn new(plate: &'a Plate, laminates: &'a [Laminate], element: &'a dyn Element, u: &'a [f64]) -> Self {
        Self { plate, laminates, element, u, large: false }
    }

    /// The same with the strains of large deflections, where the element knows them.
    #[must_use]
    pub fn with_large_strains(self) -> Self {
        Self { large: true, ..self }
    }

    /// The plate.
    pub fn plate(&self) -> &'a Plate {
        self.plate
    }

    /// The laminate over a quad.
    pub fn laminate(&self, quad: usize) -> &'a Laminate {
        &self.laminates[self.plate.region(quad)]
    }

    /// Stress in `ply` at the height `z` over `quad` of a strain, both in the plate's frame, Pa. Under large deflections S = C E, on axes that turn with
    /// the plate. Free strains count.
    pub fn stress(&self, quad: usize, (ply, z): (usize, f64), strain: &Strain6<Global>) -> Stress6<Global> {
        let (layer, slice) = self.slice(quad, ply);
        let stack = &self.plate.stacks(self.plate.region(quad))[layer];
        let q = self.plate.cell(self.plate.cell_over(quad, layer)).natural_height(z);
        let held = self.form(quad).held_stress(stack, &Part { slice, q: [q, q] });
        let moved = stress(&stack.slices[slice].c, strain);
        Stress6::new(std::array::from_fn(|k| moved.0[k] + held[k]))
    }

    /// Strain in the plate's frame and displacement, m.
    ///
    /// # Errors
    /// Under large deflections, a cell that the element refuses.
    pub fn at(&self, spot: Spot) -> Result<(Strain6<Global>, [f64; 3]), ElementError> {
        let Spot { quad, at: [r, s], ply, z } = spot;
        let (layer, slice) = self.slice(quad, ply);
        let number = self.plate.cell_over(quad, layer);
        let cell = self.plate.cell(number);
        let xi = [r, s, cell.natural_height(z)];
        let mut dofs = Vec::new();
        self.plate.cell_dofs(number, &mut dofs);
        let mut operator = vec![0.0; 6 * dofs.len()];
        let element = self.form(quad);
        let strain = match element.large_deflections().filter(|_| self.large) {
            Some(large) => {
                let local: Vec<f64> = dofs.iter().map(|dof| self.u[*dof]).collect();
                large.large_strain(&cell, slice, xi, &local)?
            }
            None => {
                element.strain_operator(&cell, slice, xi, &mut operator);
                self.product(&dofs, &operator)
            }
        };
        let shape = &mut operator[..3 * dofs.len()];
        element.shape(&cell, xi, shape);
        let displacement = self.product(&dofs, shape);
        Ok((Strain6::new(strain), displacement))
    }

    fn form(&self, quad: usize) -> &'a dyn Element {
        form(self.element, self.plate.plane.quads[quad].domain())
    }

    /// The layer of cells that holds a ply, and its number there.
    fn slice(&self, quad: usize, ply: usize) -> (usize, usize) {
        let laminate = self.laminate(quad);
        let mut layers = 0..laminate.layers.len();
        let layer = layers.find(|l| laminate.plies_of(*l).contains(&ply)).unwrap_or(0);
        (layer, ply - laminate.plies_of(layer).start)
    }

    /// What an operator of `N` rows makes of the unknowns of a cell.
    fn product<const N: usize>(&self, dofs: &[usize], operator: &[f64]) -> [f64; N] {
        let mut all = [0.0; N];
        for (dof, column) in dofs.iter().zip(operator.chunks_exact(N)) {
            all.iter_mut().zip(column).for_each(|(sum, b)| *sum += b * self.u[*dof]);
        }
        all
    }
}
