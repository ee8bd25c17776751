//! What a run says of its own errors: those of its time step, of its reduction, of its mesh and of its layers of cells.
//!
//! They come from marches of the reduced plate without stresses beside the run, made before the run's own march, while the full
//! plate is still at hand: with another step, with what the reduction leaves out, and as much softer as mesh and layers are too
//! stiff.
//! Nothing depends on where a march was stopped and resumed, and whether an estimate is cheap enough
//! is decided by counts, not by a clock, so that results are the same on every machine.

mod companion;
pub(super) mod layers;
pub(super) mod mesh;
mod reduction;
mod step;
pub(super) mod unreduced;

pub use companion::Differences;
pub use mesh::MeshAccuracy;
pub use reduction::{ReductionAccuracy, ReductionResidual};
pub use step::StepAccuracy;

use super::prepare::Full;
use super::{ContactRecord, Sizes, StepForces};
use companion::{Companion, Pace};
use fem_core::structure::Structure;
use fem_core::time::Integrator;
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::{MembranePlate, Modal, Reduced};
use mesh::OfFields;
use reduction::Richer;

/// Least error of the peak over that of the history: the difference of two single values passes through zero by chance.
const PEAK: f64 = 0.25;

/// What half of the motions change in the tension of large deflections, over what all of them leave: 2³ − 1. Against 160 vectors
/// of `as4-3502-8ply-75mm` 15 and 60 of them left a nineteenth and a seventh of it in the impulse.
const HALVED: f64 = 7.0;

/// Estimated errors of a run; nothing where no honest estimate is cheap.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Accuracy {
    /// Of the time step.
    pub step: Option<StepAccuracy>,
    /// Whether there is no reduction, which then leaves nothing.
    pub unreduced: bool,
    /// Of the reduction.
    pub reduction: Option<ReductionAccuracy>,
    /// Of the mesh.
    pub mesh: Option<MeshAccuracy>,
    /// Of the layers of cells: what changes as they lose what they add to the stiffness.
    pub layers: Option<Differences>,
}

impl Accuracy {
    /// Errors of the main results: those of step, reduction, mesh and layers together, where all of them are known;
    /// of the peak at least a quarter of that of the history.
    pub fn results(&self) -> Option<Differences> {
        let left = if self.unreduced { Differences::default() } else { self.reduction?.response? };
        let sum = |a: Differences, b: Differences| a.with(b, |a, b| a + b);
        let all = [left, self.mesh?.response?, self.layers?].into_iter().fold(self.step?.error, sum);
        Some(Differences { peak: all.peak.max(PEAK * all.force), ..all })
    }
}

/// What is known before the march itself.
#[derive(Debug, Default)]
pub(super) struct Estimates {
    other_step: Option<OtherStep>,
    unreduced: bool,
    reduction: Option<ReductionAccuracy>,
    mesh: Option<MeshAccuracy>,
    layers: Option<Differences>,
}

/// A march with another step, and what it was of.
#[derive(Debug)]
struct OtherStep {
    pace: Pace,
    companion: Companion,
    system: ImpactSystem,
    modal: Modal,
}

impl OtherStep {
    /// How far the run is from a march of half its step, if that is as much less than from this one as it is where steps converge; otherwise
    /// from one of twice the step of the run.
    fn judge(mut self, forces: &StepForces, contact: &ContactRecord) -> Option<StepAccuracy> {
        let found = self.against(forces, contact)?;
        let Some(halved) = self.pace.halved() else { return Some(found) };
        let half = self.at(halved, forces, contact)?;
        match self.pace.shorter(2) {
            Some(twice) if !half.follows(&found) => self.at(twice, forces, contact),
            _ => Some(half),
        }
    }

    /// The same of a march at another pace, in place of this one.
    fn at(&mut self, pace: Pace, forces: &StepForces, contact: &ContactRecord) -> Option<StepAccuracy> {
        self.companion = pace.march(&mut self.system, &self.modal, |_| ())?;
        self.pace = pace;
        self.against(forces, contact)
    }

    fn against(&self, forces: &StepForces, contact: &ContactRecord) -> Option<StepAccuracy> {
        let difference = self.companion.against_run(forces, contact)?;
        self.companion.follows.then(|| StepAccuracy::of(&self.pace, difference))
    }
}

/// A run before its march.
pub(super) struct Before<'a> {
    pub(super) system: &'a ImpactSystem,
    pub(super) reduced: &'a Reduced,
    pub(super) membrane: Option<&'a MembranePlate>,
    pub(super) integrator: Box<dyn Integrator>,
    pub(super) sizes: &'a Sizes,
    /// Makes a linear reduced plate a system, where only the tension of large deflections is beside it.
    pub(super) couple: Option<&'a dyn Fn(Reduced) -> (ImpactSystem, Modal)>,
    /// Errors of the mesh, where they are known.
    pub(super) mesh: Option<OfFields>,
    /// Shares of the stiffness of each mode that layers of cells add, where they are known.
    pub(super) layers: Option<Vec<f64>>,
}

impl Estimates {
    /// Marches copies of the reduced plate, and asks the full one what the reduction leaves out, if that is not what is marched; all beside a
    /// run that takes as long as so many `solves` of the full plate.
    pub(super) fn new(run: Before<'_>, full: Option<Full>, solves: u64) -> Self {
        let Before { system, reduced, membrane, integrator, sizes, couple, mesh, layers } = run;
        let plate: Box<dyn Structure> = match membrane {
            Some(membrane) => Box::new(membrane.clone()),
            None => Box::new(reduced.modal.clone()),
        };
        let mut pace = Pace::new(integrator.clone(), sizes, (solves, system.one_sided().len()), membrane);
        let mut instants = Vec::new();
        let mut copy = system.on(plate);
        let mut march = |pace: &Pace| {
            instants.clear();
            pace.march(&mut copy, &reduced.modal, |instant| instants.push(instant))
        };
        let mut base = march(&pace);
        // Steps may be too long to be marched at all.
        while let (None, Some(shorter)) = (&base, pace.halved_as_cheap().filter(Pace::is_cheap)) {
            pace = shorter;
            base = march(&pace);
        }
        // What a reduction leaves out is asked of the linear plate, at its own pace: tension is a matter of its slow vectors.
        let linear = membrane.and_then(|_| {
            let pace = Pace::new(integrator, sizes, (solves, system.one_sided().len()), None);
            instants.clear();
            let mut linear = system.on(Box::new(reduced.modal.clone()));
            let base = pace.march(&mut linear, &reduced.modal, |instant| instants.push(instant))?;
            Some((pace, base))
        });
        let linear = match membrane {
            Some(_) => linear.as_ref().map(|(pace, base)| (pace, base)),
            None => base.as_ref().map(|base| (&pace, base)),
        };
        if linear.is_none() {
            instants.clear();
        }
        let richer = couple.zip(linear).map(|(couple, (pace, base))| Richer { couple, pace, base });
        let unreduced = full.is_none();
        let mut reduction = full.and_then(|full| reduction::estimate(full, reduced, &instants, richer));
        if let (Some(found), Some(membrane)) = (&mut reduction, membrane) {
            // Of the tension, by what half of the motions change in it.
            let slow = membrane.stretched_by_half();
            let left = base
                .as_ref()
                .and_then(|base| base.against(&pace.march(&mut system.on(Box::new(slow)), &reduced.modal, |_| ())?));
            found.response = found.response.zip(left).map(|(a, b)| a.with(b, |a, b| a + b / HALVED));
        }
        let mesh = mesh.map(|errors| match &base {
            Some(base) => errors.judge(system, (reduced, membrane), &pace, base),
            None => MeshAccuracy { at_rest: errors.at_rest, response: None },
        });
        let soften = |shares: Vec<f64>| pace.soften(system, (reduced, membrane), base.as_ref()?, &shares);
        let layers = layers.and_then(soften);
        let modal = reduced.modal.clone();
        let other_step = base.map(|companion| OtherStep { pace, companion, system: copy, modal });
        Self { other_step, unreduced, reduction, mesh, layers }
    }

    /// The estimates for a march with these forces and first contact that reached its end.
    pub(super) fn finish(self, forces: &StepForces, contact: Option<&ContactRecord>) -> Accuracy {
        let Self { other_step, unreduced, reduction, mesh, layers } = self;
        let step = other_step.zip(contact).and_then(|(other, contact)| other.judge(forces, contact));
        Accuracy { step, unreduced, reduction, mesh, layers }
    }
}
