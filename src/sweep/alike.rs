//! Cases that differ in strengths alone: one march, judged for each.

use super::design::SweepAxis;
use super::figures::CaseFigures;
use crate::analyses::impact::{Outcome, Sizes};
use crate::error::Error;
use crate::model::{Model, NamedCriterion, leaves_march};
use crate::output::summary::follows_mesh;
use fem_core::material::{Material, Strength};
use fem_core::plugin::Dimension;
use fem_failure::scan::{FailureEvent, first_per_mode};
use fem_io::scene::unit;
use fem_io::units::parse_as;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A march, and what its first case found.
pub(super) struct Marched {
    outcome: Outcome,
    figures: CaseFigures,
    /// Its criteria and materials are those of the first case.
    model: Mutex<Model>,
    criteria: Vec<NamedCriterion>,
    materials: Vec<Material>,
    in_situ: bool,
    /// How many of its warnings are not about places of first damage.
    warnings: u64,
    /// Whether a place, by its cell and position, is one to warn of.
    doubted: Mutex<BTreeMap<(u32, [u64; 3]), bool>>,
}

impl Marched {
    /// That of `model`.
    pub(super) fn new(model: Model, sizes: &Sizes, mut outcome: Outcome) -> Self {
        let figures = CaseFigures::of(&model, sizes, &mut outcome);
        let firsts = first_per_mode(&outcome.events);
        let doubts = firsts.into_iter().filter(|event| follows_mesh(&model, event)).count() as u64;
        Self {
            warnings: figures.warnings - doubts,
            outcome,
            figures,
            criteria: model.criteria.clone(),
            in_situ: model.origin.in_situ,
            materials: model.materials.clone(),
            model: Mutex::new(model),
            doubted: Mutex::default(),
        }
    }

    /// What the first case found.
    pub(super) fn figures(&self) -> &CaseFigures {
        &self.figures
    }

    /// What a case found of which keys have these values; `None` where that takes a run of its own.
    ///
    /// # Errors
    /// A strength that a criterion refuses, an index that is not a number.
    pub(super) fn judged(&self, axes: &[SweepAxis], values: &[String]) -> Result<Option<CaseFigures>, Error> {
        let Some(materials) = self.materials(axes, values) else { return Ok(None) };
        let Some(found) = self.outcome.judged_anew(&self.criteria, &materials)? else { return Ok(None) };
        let doubts = found.firsts.iter().filter(|event| self.doubts(event)).count() as u64;
        let figures = self.figures.judged(&self.criteria, &found, &self.outcome.forces);
        Ok(Some(CaseFigures { warnings: self.warnings + doubts, ..figures }))
    }

    /// With the strengths of a case; `None` where they stand in words that the whole scene is needed for, or others follow from them.
    fn materials(&self, axes: &[SweepAxis], values: &[String]) -> Option<Vec<Material>> {
        if self.in_situ {
            return None;
        }
        let mut materials = self.materials.clone();
        for (axis, value) in axes.iter().zip(values).filter(|(axis, _)| leaves_march(&axis.key)) {
            let (_, key) = axis.key.split_once('.')?;
            let (name, key) = key.split_once('.')?;
            unit(value)?;
            let strength = Strength::ALL.iter().find(|strength| strength.name() == key)?;
            let pascals = parse_as(value, Dimension::PRESSURE).ok().filter(|pascals| *pascals > 0.0)?;
            let material = materials.iter_mut().find(|material| material.name == name)?;
            material.strengths = material.strengths.with(*strength, pascals);
        }
        Some(materials)
    }

    fn doubts(&self, event: &FailureEvent) -> bool {
        let place = (event.cell, event.position.map(f64::to_bits));
        let mut doubted = self.doubted.lock().unwrap_or_else(PoisonError::into_inner);
        *doubted
            .entry(place)
            .or_insert_with(|| follows_mesh(&self.model.lock().unwrap_or_else(PoisonError::into_inner), event))
    }
}
