//! The contract of effects: what a scene may have computed beyond the linear elastic plate, or left out of it.
//!
//! An effect is one file: a type that is an [`Effect`], with a hook for each stage of an analysis at which it acts, and an
//! [`EffectPlugin`], its key in scenes. Whoever computes goes through the effects that act and calls their hooks; nobody asks
//! for one by its name.

mod advice;
mod facts;
mod set;
mod stages;

pub use advice::{AdviceRule, Answer, Decision, Expected, Hindsight, Judgement, Number};
pub use facts::{Body, Exclusion, Facts, Feature};
pub use set::Effects;
pub use stages::{EdgeLoad, Gripped, Marched, Nature};

use crate::error::Error;
use crate::forecast::Demand;
use dyn_clone::DynClone;
use fem_core::assembly::{Separable, SparseStructure, Symmetric};
use fem_core::element::Stack;
use fem_core::functional::Functional;
use fem_core::laminate::Laminate;
use fem_core::material::{Material, MaterialError};
use fem_core::recovery::Recovery;
use fem_core::time::State;
use fem_dynamics::impact::{Energies, ImpactSystem};
use fem_dynamics::reduce::{Reduced, Stretch};
use fem_io::scene::{Key, SceneError, SceneValue};
use std::fmt::Debug;

/// What lists, schema, explanation and pages show of an effect.
#[derive(Debug, Clone, Copy)]
pub struct EffectInfo {
    /// Its key in `effects`, with the form of its value.
    pub key: Key,
    /// Where it comes from.
    pub source: &'static str,
    /// Its columns in `history.csv`.
    pub columns: &'static [LedgerColumn],
    /// What the advisor says of it, where it has a say.
    pub advice: Option<AdviceRule>,
}

/// A column of `history.csv`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LedgerColumn {
    /// Its heading.
    pub name: &'static str,
    /// Its unit; energies, `J`, are drawn with the others.
    pub unit: &'static str,
    /// Its name in pictures.
    pub label: &'static str,
    /// Whether it is part of the sum of all energies, and no share of another column.
    pub counts: bool,
}

/// What a scene wants of an effect.
#[derive(Debug, Clone)]
pub enum Wish {
    /// It does not act.
    Off,
    /// It acts.
    On(Box<dyn Effect>),
    /// It acts where the advisor finds that it matters.
    Auto(Box<dyn Effect>),
}

/// An effect as the registry knows it.
pub trait EffectPlugin: Effect {
    /// Its entry.
    const INFO: EffectInfo;

    /// Reads its value.
    ///
    /// # Errors
    /// A value that it does not take.
    fn read(value: &SceneValue<'_>) -> Result<Wish, SceneError>;
}

/// An effect that acts. Every hook but the first does nothing unless it is written; they are called in the order in which
/// they stand here, each for all effects in the order of the registry.
pub trait Effect: DynClone + Debug + Send + Sync {
    /// Its entry in the registry.
    fn info(&self) -> &'static EffectInfo;

    /// What it cannot stand beside, and why.
    fn excludes(&self) -> &'static [Exclusion] {
        &[]
    }

    /// Refuses a scene that it does not suit for other reasons.
    ///
    /// # Errors
    /// Why, with a way out.
    fn check(&self, _facts: &Facts<'_>) -> Result<(), SceneError> {
        Ok(())
    }

    /// Whether it stands beside delaminations that grow.
    fn goes_with_growth(&self) -> bool {
        false
    }

    /// Changes what is computed of the plate.
    fn alter(&self, _nature: &mut Nature) {}

    /// What it takes at the peak beside a computation without it, bytes.
    fn memory(&self, _body: &Body<'_>, _demand: &Demand) -> f64 {
        0.0
    }

    /// Changes the stacks of plies before cells are made of them; `at_rest` under loads at rest.
    ///
    /// # Errors
    /// A material that lacks a constant.
    fn on_stacks(
        &self,
        _at_rest: bool,
        _laminate: &Laminate,
        _materials: &[Material],
        _stacks: &mut [Stack],
    ) -> Result<(), MaterialError> {
        Ok(())
    }

    /// What acts on edges in the plane before all else, while supports do not hold these edges there.
    fn edges(&self) -> &[EdgeLoad] {
        &[]
    }

    /// Takes how the plate is held and loaded meanwhile.
    fn on_edges(&mut self, _gripped: Gripped) {}

    /// Adds to the stiffness of the assembled plate, of any analysis.
    ///
    /// # Errors
    /// What it adds has no place there.
    fn on_stiffness(&self, _body: &Body<'_>, _stiffness: &mut Symmetric) -> Result<(), Error> {
        Ok(())
    }

    /// Adds the geometric stiffness of the stresses of its edges: in an analysis of buckling what the load factors multiply, else a
    /// part of the stiffness.
    ///
    /// # Errors
    /// A cell that the element refuses, a plate that is not held.
    fn add_geometric(&self, _body: &Body<'_>, _sum: &mut Symmetric) -> Result<(), Error> {
        Ok(())
    }

    /// Displacements before all else, one per unknown, of which stresses of a plate at rest are part; `None` without.
    ///
    /// # Errors
    /// As [`Effect::add_geometric`].
    fn displaced(&self, _body: &Body<'_>) -> Result<Option<Vec<f64>>, Error> {
        Ok(None)
    }

    /// Forces under loads at rest, N, one per independent unknown, and the energy at no displacement, J; `None` without.
    ///
    /// # Errors
    /// A cell that the element refuses.
    fn forces(&self, _body: &Body<'_>) -> Result<Option<(Vec<f64>, f64)>, Error> {
        Ok(None)
    }

    /// Displacements that the basis of a reduced plate must hold, one after the other; called for a full plate as well.
    ///
    /// # Errors
    /// A structure that is not held.
    fn vectors(&mut self, _body: &Body<'_>, _structure: &mut SparseStructure) -> Result<Vec<f64>, Error> {
        Ok(Vec::new())
    }

    /// Changes a reduced plate.
    fn on_reduced(&mut self, _reduced: &mut Reduced) {}

    /// Changes the plate that is marched.
    ///
    /// # Errors
    /// A plate that cannot be changed so.
    fn on_structure(&mut self, _body: &Body<'_>, _plate: &mut Marched) -> Result<(), Error> {
        Ok(())
    }

    /// How its deflections stretch a plate whose layers may separate, struck at `contacts` and marched by steps of `step`,
    /// s; `None` where nothing of the kind is computed.
    ///
    /// # Errors
    /// A plate that is not held.
    fn stretch(
        &self,
        _body: &Body<'_>,
        _plate: &mut Separable,
        _contacts: &[Functional],
        _step: f64,
    ) -> Result<Option<Stretch>, Error> {
        Ok(None)
    }

    /// Changes plate and impactors as one system, of a full plate (`None`) or a reduced one.
    fn on_system(&mut self, _body: &Body<'_>, _reduced: Option<&Reduced>, system: ImpactSystem) -> ImpactSystem {
        system
    }

    /// Displacements at rest from which those of the march count, if there are some.
    fn offset(&self) -> Option<&[f64]> {
        None
    }

    /// What the summary says of the model, by key.
    fn quantities(&self, _system: &ImpactSystem) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Sees the end of a step; `work` is an array to work in.
    fn on_step(&mut self, _system: &ImpactSystem, _state: &State, _work: &mut Vec<f64>) {}

    /// Energy lost so far of which the system does not know, J: part of the balance.
    fn lost(&self) -> f64 {
        0.0
    }

    /// The values of its columns.
    fn values(&self, _system: &ImpactSystem, _state: &State, _energies: &Energies) -> Vec<f64> {
        Vec::new()
    }

    /// What a march that goes on from a checkpoint needs to know.
    fn saved(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes that again; `false` where it has another size.
    fn resume(&mut self, saved: &[f64]) -> bool {
        saved.is_empty()
    }

    /// Stresses that do not follow from displacements, six per site of `recovery`; `None` without.
    ///
    /// # Errors
    /// A material that lacks a constant.
    fn stresses(&self, _body: &Body<'_>, _recovery: &Recovery) -> Result<Option<Vec<f64>>, Error> {
        Ok(None)
    }
}

dyn_clone::clone_trait_object!(Effect);
