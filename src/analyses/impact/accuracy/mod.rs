//! What a run says of its own errors: those of its time step, of its reduction and of its mesh.
//!
//! The first two come from a second march of the reduced plate without stresses, made before the run's own march, while the full
//! plate is still at hand. Nothing depends on where a march was stopped and resumed, and whether an estimate is cheap enough
//! is decided by counts, not by a clock, so that results are the same on every machine.

pub(super) mod mesh;
mod reduction;
mod step;

pub use reduction::{ReductionAccuracy, ReductionResidual};
pub use step::StepAccuracy;

use super::prepare::Full;
use super::{Sizes, StepForces};
use fem_core::time::Integrator;
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::Reduced;
use step::Companion;

/// Estimated errors of a run; nothing where no honest estimate is cheap.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Accuracy {
    /// Of the time step.
    pub step: Option<StepAccuracy>,
    /// Of the reduction.
    pub reduction: Option<ReductionAccuracy>,
    /// Of the mesh, relative, in the energy norm of the deflection under a contact at rest; layers are not judged.
    pub mesh: Option<f64>,
}

/// What is known before the march itself.
#[derive(Debug, Default)]
pub(super) struct Estimates {
    companion: Option<Companion>,
    reduction: Option<ReductionAccuracy>,
    pub(super) mesh: Option<f64>,
}

impl Estimates {
    /// Marches `copy`, the reduced plate with its impactors, and asks the full one what the reduction leaves out of that.
    pub(super) fn new(
        mut copy: ImpactSystem,
        reduced: &Reduced,
        full: Full,
        integrator: Box<dyn Integrator>,
        sizes: &Sizes,
    ) -> Self {
        // The residual is that of a linear plate.
        let linear = !copy.is_nonlinear();
        let (companion, instants) = step::march(copy, &reduced.modal, integrator, sizes, full.solves()).unzip();
        let instants = instants.filter(|_| linear);
        let reduction = reduction::estimate(full, reduced, &instants.unwrap_or_default());
        Self { companion, reduction, mesh: None }
    }

    /// The estimates for a march with these forces that reached its end.
    pub(super) fn finish(self, forces: &StepForces) -> Accuracy {
        let step = self.companion.and_then(|companion| companion.compare(forces));
        Accuracy { step, reduction: self.reduction, mesh: self.mesh }
    }
}
