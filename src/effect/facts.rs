//! What an effect is told of a scene and of the plate, and what it excludes.

use fem_core::constraint::Constraints;
use fem_core::element::Element;
use fem_core::failure::FailureCriterion;
use fem_core::laminate::Laminate;
use fem_core::load::Face;
use fem_core::material::Material;
use fem_core::plate::Plate;
use fem_io::scene::{Analysis, Place, Scene, SceneError};

/// A plate on which effects act.
#[derive(Debug, Clone, Copy)]
pub struct Body<'a> {
    /// Cells and unknowns.
    pub plate: &'a Plate,
    /// The element of all cells.
    pub element: &'a (dyn Element + 'static),
    /// The laminates of its regions.
    pub laminates: &'a [Laminate],
    /// Its materials.
    pub materials: &'a [Material],
    /// Supports and other equations, eliminated.
    pub constraints: &'a Constraints,
    /// Whether the plate is at rest under loads, and not struck or vibrating.
    pub at_rest: bool,
}

/// A scene for which an effect is checked.
#[derive(Debug, Clone, Copy)]
pub struct Facts<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its element.
    pub element: &'a dyn Element,
    /// Its criteria by name.
    pub criteria: &'a [(String, Box<dyn FailureCriterion>)],
    /// Whether an impact is marched without a reduction.
    pub full: bool,
    /// Keys of the effects that act or may.
    pub effects: &'a [&'static str],
    /// Where the value of the effect stands.
    pub place: &'a Place,
}

/// A thing of a scene beside which an effect cannot stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// An analysis that is no impact.
    NoImpact,
    /// Natural modes, and buckling.
    Modes,
    /// Substructures.
    Substructures,
    /// An impact without a reduction.
    FullModel,
    /// `output.modes`.
    FollowedModes,
    /// A profile with stresses from equilibrium.
    EquilibriumProfile,
    /// An integrator that needs the inverse of the mass matrix, which the first step finds out.
    ExplicitIntegrator,
    /// An impactor that strikes the bottom face.
    StruckFromBelow,
    /// Plies that follow laws.
    PlyLaws,
    /// Plies that follow laws in a plate whose delaminations do not grow.
    PlyLawsAlone,
    /// Regions whose mid-planes lie at different heights.
    EccentricSteps,
    /// Another effect.
    Effect(&'static str),
}

/// What an effect cannot stand beside.
#[derive(Debug, Clone, Copy)]
pub struct Exclusion {
    /// The thing.
    pub with: Feature,
    /// Why.
    pub because: &'static str,
    /// A way out.
    pub instead: &'static str,
    /// Whether an effect that is left to the advisor is refused as well.
    pub even_auto: bool,
}

impl Exclusion {
    /// Of an effect that is on or left to the advisor.
    pub const fn new(with: Feature, because: &'static str, instead: &'static str) -> Self {
        Self { with, because, instead, even_auto: true }
    }

    /// Of an effect that is on; the advisor may leave it out.
    #[must_use]
    pub const fn unless_auto(self) -> Self {
        Self { even_auto: false, ..self }
    }
}

impl<'a> Facts<'a> {
    /// An error at the value of the effect.
    pub fn refuse(&self, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        self.scene.source.error_at(self.place, message, help)
    }

    /// Refuses what an effect excludes.
    pub(super) fn exclude(&self, exclusions: &[Exclusion], auto: bool) -> Result<(), SceneError> {
        for Exclusion { with, because, instead, .. } in exclusions.iter().filter(|e| e.even_auto || !auto) {
            if let Some(place) = self.find(*with) {
                return Err(self.scene.source.error_at(place, *because, *instead));
            }
        }
        Ok(())
    }

    /// Where an error about `feature` is shown, where the scene has it.
    fn find(&self, feature: Feature) -> Option<&'a Place> {
        let Self { scene, place, .. } = *self;
        let own = |has: bool| has.then_some(place);
        let lawful = || scene.plies().any(|ply| scene.laws[ply.material].is_some());
        match feature {
            Feature::NoImpact => own(scene.impact().is_none()),
            Feature::Modes => own(matches!(scene.analysis, Analysis::Modes { .. } | Analysis::Buckling { .. })),
            Feature::Substructures => own(scene.substructures.is_some()),
            Feature::FullModel => own(self.full),
            Feature::FollowedModes => scene.output.modes.as_ref().map(|modes| &modes.place),
            Feature::EquilibriumProfile => {
                scene.profiles.iter().find(|line| line.equilibrium == Some(true)).map(|line| &line.name.place)
            }
            Feature::ExplicitIntegrator => None,
            Feature::StruckFromBelow => {
                own(scene.impact().is_some_and(|impact| impact.impactors.iter().any(|one| one.face == Face::Bottom)))
            }
            Feature::EccentricSteps => {
                let off = |laminate: &Laminate| laminate.middle != 0.0;
                scene.laminates.iter().map(|spec| &spec.laminate).find(|one| off(&one.value)).map(|one| &one.place)
            }
            Feature::PlyLaws => own(lawful()),
            Feature::PlyLawsAlone => own(lawful() && scene.delamination.is_none()),
            Feature::Effect(name) => own(self.effects.contains(&name)),
        }
    }
}
