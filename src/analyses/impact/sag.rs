//! The weight of a plate.

use crate::analyses::assembled::Assembled;
use crate::error::Error;
use crate::model::Model;
use fem_core::functional::Functional;
use fem_core::load;
use fem_core::structure::Structure;
use fem_dynamics::impact::Weight;
use fem_dynamics::reduce::Reduced;

/// A plate under its own weight.
#[derive(Debug)]
pub(super) struct Sag {
    /// Forces, N.
    load: Vec<f64>,
    /// Displacements.
    pub(super) u: Vec<f64>,
}

impl Sag {
    pub(super) fn of(model: &Model, gravity: f64, assembled: &mut Assembled) -> Result<Self, Error> {
        let mut forces = vec![0.0; model.plate.ndof()];
        load::gravity(&model.plate, &*model.element, [0.0, 0.0, -gravity], &mut forces)?;
        let forces: Vec<(usize, f64)> = forces.into_iter().enumerate().collect();
        let mut load = vec![0.0; model.constraints.ndof()];
        Functional(model.constraints.restrict(&forces)).add_to(1.0, &mut load);
        let mut u = load.clone();
        assembled.structure.solve_shifted(0.0, &mut u, 1)?;
        Ok(Self { load, u })
    }

    /// The same in the coordinates of a reduced plate that can sag.
    pub(super) fn within(self, reduced: &Reduced) -> Self {
        let load = reduced.restrict(&Functional(self.load.into_iter().enumerate().collect()));
        let u = load.iter().zip(reduced.modal.stiffnesses()).map(|(f, k)| f / k).collect();
        Self { load, u }
    }

    pub(super) fn weight(&self, acceleration: f64) -> Weight {
        let sag = 0.5 * self.load.iter().zip(&self.u).map(|(f, u)| f * u).sum::<f64>();
        Weight { acceleration, load: self.load.clone(), sag }
    }
}
