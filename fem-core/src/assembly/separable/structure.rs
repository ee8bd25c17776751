//! A plate that separates, as dynamics see it.

use super::tied::Factored;
use super::{Separable, SeparableError};
use crate::assembly::LawPlate;
use crate::contracts::structure::{Nonlinear, SolveError, Structure};
use crate::words::energy::Energy;

impl From<SeparableError> for SolveError {
    fn from(error: SeparableError) -> Self {
        SolveError::other(error)
    }
}

impl Structure for Separable {
    fn ndof(&self) -> usize {
        Separable::ndof(self)
    }

    fn name(&self, i: usize) -> String {
        self.parts.plate.describe(self.parts.constraints.original(i))
    }

    fn free_motions(&self) -> &[f64] {
        self.released.motions()
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.k.add_product(scale, x, y);
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.m.add_product(scale, x, y);
    }

    /// Of the interfaces that are open, undamaged.
    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        let n = Separable::ndof(self);
        x.chunks_exact_mut(n).take(columns).try_for_each(|x| self.solve_with(Factored::Undamaged(shift), x))?;
        Ok(())
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        Ok(self.solve_with(Factored::Mass, x)?)
    }

    fn states(&self) -> usize {
        self.first[self.first.len() - 1] + self.parts.plies.as_ref().map_or(0, LawPlate::states)
    }

    fn nonlinear(&mut self) -> Option<&mut dyn Nonlinear> {
        Some(self)
    }

    fn revision(&self) -> u64 {
        self.work.openings
    }

    fn work(&self) -> (u64, u64) {
        (self.work.factorisations, self.work.solves)
    }
}

impl Nonlinear for Separable {
    fn internal(&mut self, u: &[f64], points: &[f64], force: &mut [f64]) -> Result<Energy, SolveError> {
        Ok(Separable::internal(self, u, points, force)?)
    }

    fn commit(&mut self, u: &[f64], points: &mut [f64]) -> Result<(), SolveError> {
        Ok(Separable::commit(self, u, points)?)
    }
}
