//! Membrane stiffening of a model that is marched.

use crate::model::Model;
use fem_core::assembly::{AssemblyError, Stretch};
use fem_core::structure::SolveError;
use fem_dynamics::reduce::Stretching;

/// The quadratic strains of the plate of a model.
pub(super) struct StretchOf<'a>(pub(super) &'a Model);

impl StretchOf<'_> {
    fn of(&self, fields: &[f64]) -> Stretch<'_> {
        let Model { plate, element, constraints, .. } = self.0;
        Stretch::new(plate, &**element, constraints, fields)
    }
}

impl Stretching for StretchOf<'_> {
    fn gram(&self, fields: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.of(fields).gram().map_err(refused)
    }

    fn forces(&self, fields: &[f64], combinations: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.of(fields).forces(combinations).map_err(refused)
    }

    fn forms(
        &self,
        fields: &[f64],
        combinations: &[f64],
        shapes: Option<&[f64]>,
        modes: &[f64],
    ) -> Result<Vec<f64>, SolveError> {
        self.of(fields).forms(combinations, shapes, modes).map_err(refused)
    }
}

fn refused(e: AssemblyError) -> SolveError {
    SolveError(e.to_string())
}
