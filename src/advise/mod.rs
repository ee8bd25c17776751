//! The advisor: which effects an impact calls for, before it is computed and after.
//!
//! Formulas of the literature say how a plate will respond ([`small_mass`], [`large_mass`], [`Held`]); what they need of
//! the plate comes from its model: stiffness under the impactor by one static solution, mass and edge by its mesh and supports
//! ([`PlateConstants`], [`Rim`]). An [`Estimate`] puts them together; every question then has an [`Answer`] with its number, threshold
//! and source, what goes wrong without the effect, and what it costs. `docs/advise.md` derives them.
//!
//! [`decided`] switches effects that a scene leaves to the advisor; [`hindsight()`] holds a choice against the run.

mod contact;
mod decide;
mod delamination;
mod estimate;
mod held;
mod hindsight;
mod interfaces;
pub mod large_mass;
mod mesh;
mod plate;
mod regime;
mod rim;
mod sampling;
mod shear;
pub mod small_mass;
mod text;
mod work;

pub use contact::Contact;
pub use decide::decided;
pub use delamination::{Delaminates, DelaminationAdvice};
pub use estimate::{Blow, Estimate};
pub use held::Held;
pub use hindsight::{hindsight, hindsight_at_rest};
pub use mesh::{Resolution, expect_coarse_cells, warn_of_coarse_cells};
pub use plate::PlateConstants;
pub use regime::Regime;
pub use rim::Rim;
pub use shear::Shear;

use crate::effect::{Answer, Expected};
use crate::error::Error;
use crate::model::{Model, Plan, Strike};
use fem_io::scene;
use plate::AtRest;
use std::num::NonZeroUsize;
use work::MarchSize;

/// The advisor's answers for one impactor, as if it struck alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice {
    /// Name of the impactor, where there are several.
    pub impactor: Option<String>,
    /// Its mass, kg.
    pub mass: f64,
    /// Its velocity, m/s.
    pub velocity: f64,
    /// The plate under it.
    pub plate: PlateConstants,
    /// What it will do.
    pub estimate: Estimate,
    /// Of that, what effects ask for.
    pub expected: Expected,
    /// What the contact does.
    pub contact: Contact,
    /// What shear does.
    pub shear: Shear,
    /// Whether the plate delaminates; `None` where no material gives GIIc.
    pub delamination: Option<DelaminationAdvice>,
    /// Whether mesh and step will do.
    pub resolution: Resolution,
    /// The answers, in the order in which they should be read.
    pub answers: Vec<Answer>,
}

impl Advice {
    /// Whether a plate without inertia gives the largest force to `tolerance`, relative.
    pub fn quasi_static(&self, tolerance: f64) -> bool {
        self.estimate.regime == Regime::QuasiStatic && self.estimate.inertia_error() <= tolerance
    }
}

/// Advises on each impactor of `model`.
///
/// # Errors
/// A scene without an impact, a section, a stiffness that cannot be assembled or factorised.
pub fn advise(model: &Model, threads: NonZeroUsize) -> Result<Vec<Advice>, Error> {
    let model = model.whole()?;
    let Plan::Impact(impact) = &model.plan else { return Err(Error::NoImpact) };
    let mut at_rest = AtRest::of(model, &impact.strikes, threads)?;
    let work = MarchSize::of(model, impact, at_rest.factor_entries());
    let mut each = |(spec, strike): (&scene::ImpactorSpec, &Strike)| {
        let plate = PlateConstants::under(model, strike, &mut at_rest)?;
        let march = &impact.spec.march;
        let blow =
            Blow { mass: spec.mass, velocity: spec.velocity, time: march.end.value - spec.start, law: &*strike.law };
        let estimate = Estimate::new(&plate, &blow);
        let contact = Contact::new(&plate, &blow, &estimate, spec.load.value, cell_at(model, strike.centre));
        let shear = Shear::new(&plate, contact.radius, model.plate.info().is_shell());
        let delamination = DelaminationAdvice::new(model, &estimate);
        let resolution = Resolution::new(model, &plate, march.step.value, &estimate);
        let [cells, steps] = resolution.lacking();
        let expected = Expected {
            thickness: plate.thickness,
            deflection: estimate.deflection,
            coefficient: plate.membrane_coefficient(),
            surrounded: plate.rim.held.is_some(),
            forces: [estimate.linear.force, estimate.with_membrane.force],
            first_wave: estimate.inertia_error(),
            quasi_static: estimate.regime == Regime::QuasiStatic && plate.free_mass.is_infinite(),
            vibrates: decide::vibrates(model),
        };
        let of_effects = model.effects.known().iter().filter_map(|info| {
            let answer = info.advice.as_ref()?.answer?;
            Some(answer(&expected, &work.0))
        });
        let mut answers = vec![estimate.regime_answer(work.march())];
        answers.extend(of_effects);
        answers.extend([
            contact.answer(&plate),
            shear.answer(work.solid()),
            delamination::answer(delamination.as_ref()),
            resolution.answer(&blow, &estimate, work.finer(cells, steps)),
        ]);
        let impactor = (impact.strikes.len() > 1).then(|| spec.name.clone());
        let Blow { mass, velocity, .. } = blow;
        Ok(Advice {
            impactor,
            mass,
            velocity,
            plate,
            estimate,
            expected,
            contact,
            shear,
            delamination,
            resolution,
            answers,
        })
    };
    impact.spec.impactors.iter().zip(&impact.strikes).map(&mut each).collect()
}

/// Edge of a square as large as the smallest cell around a place, m.
fn cell_at(model: &Model, centre: [f64; 2]) -> f64 {
    let mesh = &model.plate.plane;
    let holds = |q: &usize| mesh.corners(*q).locate(centre).is_some();
    (0..mesh.quads.len()).filter(holds).map(|q| mesh.quality(q).area.sqrt()).fold(f64::INFINITY, f64::min)
}
