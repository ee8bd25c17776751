//! Contact laws whose indentation counts from a surface below the face: what the plate is squeezed in between is taken from them.

use crate::error::Error;
use crate::model::{Impact, Model, Strike};
use fem_core::contact::ContactLaw;
use fem_core::functional::Functional;
use fem_core::plugin::Dimension;
use fem_dynamics::contact::WithoutSqueeze;
use fem_io::scene;

/// What a contact law leaves to the plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Squeeze {
    /// Approach of the face and the surface that the indentation counts from, per force at rest, m/N. It is negative where the plate thickens
    /// under its bending by more than the cells let it be squeezed; then nothing is taken from the law.
    pub compliance: f64,
    /// Force up to which it is taken from the law, N.
    pub force_limit: f64,
}

/// What every contact squeezes per force at rest, m/N; `None` where nothing of the plate lies between the surfaces. `solve` answers a load
/// on `ndof` unknowns with the displacements at rest.
///
/// # Errors
/// A plate that is not held.
pub(super) fn compliances(
    squeezes: &[Functional],
    contacts: &[Functional],
    ndof: usize,
    mut solve: impl FnMut(&mut [f64]) -> Result<(), Error>,
) -> Result<Vec<Option<f64>>, Error> {
    let compliance = |(squeeze, contact): (&Functional, &Functional)| {
        if squeeze.0.is_empty() {
            return Ok(None);
        }
        let mut u = vec![0.0; ndof];
        contact.add_to(1.0, &mut u);
        solve(&mut u)?;
        Ok(Some(squeeze.of(&u)))
    };
    squeezes.iter().zip(contacts).map(compliance).collect()
}

/// The contact laws of `impact` as they are marched, and what they leave to the plate.
///
/// # Errors
/// A law that is no softer than the plate under its patch.
#[allow(clippy::type_complexity)]
pub(super) fn laws(
    model: &Model,
    impact: &Impact,
    compliances: &[Option<f64>],
) -> Result<(Vec<Box<dyn ContactLaw>>, Vec<Option<Squeeze>>), Error> {
    let of = |((spec, strike), compliance): ((&scene::ImpactorSpec, &Strike), &Option<f64>)| {
        let Some(compliance) = *compliance else { return Ok((strike.law.clone(), None)) };
        if !(compliance > 0.0) {
            return Ok((strike.law.clone(), Some(Squeeze { compliance, force_limit: f64::INFINITY })));
        }
        let Some(law) = WithoutSqueeze::new(strike.law.clone(), compliance) else {
            let message = format!(
                "the plate between there and the face gives {} a newton, half of what the contact law gives from the first touch on, or all of \
                 it on the way back from deep down: its squeeze is no part of such a law",
                Dimension::LENGTH.of(compliance)
            );
            let place = spec.indentation_from.as_ref().map_or(&spec.at.place, |from| &from.place);
            return Err(model.origin.source.error_at(place, message, "leave `indentation_from` out").into());
        };
        let squeeze = Squeeze { compliance, force_limit: law.force_limit() };
        Ok((Box::new(law) as Box<dyn ContactLaw>, Some(squeeze)))
    };
    impact.spec.impactors.iter().zip(&impact.strikes).zip(compliances).map(of).collect()
}
