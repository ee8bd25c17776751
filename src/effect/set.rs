//! The effects of a model.

use super::{Body, Decision, EdgeLoad, Effect, EffectInfo, Facts, Feature, Gripped, LedgerColumn, Nature, Wish};
use crate::error::Error;
use crate::forecast::Demand;
use fem_core::assembly::{Pattern, Symmetric};
use fem_core::recovery::Recovery;
use fem_io::scene::SceneError;
use std::sync::Arc;

/// The effects that act on a model, those that are left to the advisor, and all that could.
#[derive(Debug, Clone, Default)]
pub struct Effects {
    known: Vec<&'static EffectInfo>,
    acting: Vec<Box<dyn Effect>>,
    left: Vec<Box<dyn Effect>>,
}

impl Effects {
    /// No effects, of those that are `known`.
    pub(crate) fn new(known: Vec<&'static EffectInfo>) -> Self {
        Self { known, ..Self::default() }
    }

    /// Takes an effect as the scene wants it.
    ///
    /// # Errors
    /// One that the scene does not suit.
    pub(crate) fn add(&mut self, wish: Wish, facts: &Facts<'_>) -> Result<(), SceneError> {
        let auto = matches!(wish, Wish::Auto(_));
        let (Wish::On(effect) | Wish::Auto(effect)) = wish else { return Ok(()) };
        facts.exclude(effect.excludes(), auto)?;
        effect.check(facts)?;
        if auto {
            self.left.push(effect)
        } else {
            self.acting.push(effect)
        }
        self.sort();
        Ok(())
    }

    /// Takes an effect that a scene asks for elsewhere than under `effects`.
    pub(crate) fn act(&mut self, effect: Box<dyn Effect>) {
        self.acting.push(effect);
        self.sort();
    }

    /// In the order of the registry, whatever that of the scene.
    fn sort(&mut self) {
        let Self { known, acting, left } = self;
        let number = |effect: &dyn Effect| known.iter().position(|info| info.key.name == effect.info().key.name);
        acting.sort_by_key(|effect| number(&**effect));
        left.sort_by_key(|effect| number(&**effect));
    }

    /// Every effect of the registry.
    pub fn known(&self) -> &[&'static EffectInfo] {
        &self.known
    }

    /// Those that act, in the order of the registry.
    pub fn acting(&self) -> &[Box<dyn Effect>] {
        &self.acting
    }

    /// Those that act or are left to the advisor.
    pub(crate) fn wanted(&self) -> impl Iterator<Item = &dyn Effect> + '_ {
        self.acting.iter().chain(&self.left).map(|effect| &**effect)
    }

    /// Whether the effect `name` acts.
    pub fn has(&self, name: &str) -> bool {
        self.acting.iter().any(|effect| effect.info().key.name == name)
    }

    /// Whether some are left to the advisor, who has not decided yet. Until then they do not act.
    pub fn undecided(&self) -> bool {
        !self.left.is_empty()
    }

    /// Decides those that are left to the advisor by the number that each asks for.
    pub(crate) fn decide(&mut self, number: impl Fn(&super::AdviceRule) -> f64) -> Vec<Decision> {
        let mut decisions = Vec::new();
        for effect in std::mem::take(&mut self.left) {
            let Some(advice) = &effect.info().advice else { continue };
            let expected = number(advice);
            let on = expected > advice.threshold;
            let (formula, threshold) = (advice.formula, advice.threshold);
            decisions.push(Decision { effect: effect.info().key.name, on, formula, expected, threshold });
            if on == advice.acts_above {
                self.acting.push(effect);
            }
        }
        self.sort();
        decisions
    }

    /// What is computed of the plate.
    pub fn nature(&self) -> Nature {
        let mut nature = Nature::default();
        self.acting.iter().for_each(|effect| effect.alter(&mut nature));
        nature
    }

    /// The columns of those that act.
    pub fn columns(&self) -> impl Iterator<Item = &'static LedgerColumn> + '_ {
        self.acting.iter().flat_map(|effect| effect.info().columns)
    }

    /// The way out for an effect that acts where the scene turns out to have `feature`.
    pub(crate) fn way_out(&self, feature: Feature) -> Option<&'static str> {
        let mut all = self.acting.iter().flat_map(|effect| effect.excludes());
        all.find(|exclusion| exclusion.with == feature).map(|exclusion| exclusion.instead)
    }

    /// What they take beside a computation without them, bytes.
    pub(crate) fn memory(&self, body: &Body<'_>, demand: &Demand) -> f64 {
        self.acting.iter().fold(0.0, |sum, effect| sum + effect.memory(body, demand))
    }

    /// Adds what they add to the stiffness.
    pub(crate) fn on_stiffness(&self, body: &Body<'_>, stiffness: &mut Symmetric) -> Result<(), Error> {
        self.acting.iter().try_for_each(|effect| effect.on_stiffness(body, stiffness))
    }

    /// What acts on edges before all else, where an effect says so; one of them does at most.
    pub(crate) fn edges(&self) -> Option<&[EdgeLoad]> {
        self.acting.iter().map(|effect| effect.edges()).find(|edges| !edges.is_empty())
    }

    /// Tells the effect that loads edges before all else how the plate is held meanwhile.
    pub(crate) fn on_edges(&mut self, gripped: &Gripped) {
        let loading = self.acting.iter_mut().filter(|effect| !effect.edges().is_empty());
        loading.for_each(|effect| effect.on_edges(gripped.clone()));
    }

    /// Displacements before all else, one per unknown.
    pub(crate) fn displaced(&self, body: &Body<'_>) -> Result<Option<Vec<f64>>, Error> {
        let mut each = self.acting.iter().filter_map(|effect| effect.displaced(body).transpose());
        each.next().transpose()
    }

    /// The geometric stiffness on `pattern` of stresses before all else; `None` without.
    pub(crate) fn geometric(&self, body: &Body<'_>, pattern: &Arc<Pattern>) -> Result<Option<Symmetric>, Error> {
        let mut sum = None;
        for effect in self.acting.iter().filter(|effect| !effect.edges().is_empty()) {
            let sum = sum.get_or_insert_with(|| Symmetric::zero(pattern.clone()));
            effect.add_geometric(body, sum)?;
        }
        Ok(sum)
    }

    /// Stresses that do not follow from displacements, six per site; empty without.
    pub(crate) fn stresses(&self, body: &Body<'_>, recovery: &Recovery) -> Result<Vec<f64>, Error> {
        let mut sum: Vec<f64> = Vec::new();
        for effect in &self.acting {
            let Some(stresses) = effect.stresses(body, recovery)? else { continue };
            if sum.is_empty() {
                sum = stresses;
            } else {
                sum.iter_mut().zip(stresses).for_each(|(sum, stress)| *sum += stress);
            }
        }
        Ok(sum)
    }
}
