//! Shear cracks along the fibres: a ply law in one file.
//!
//! What to look at: the law remembers one number, the largest shear so far, from which stress, tangent and energies follow.
use fem_core::energy::Energy;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::ply_law::{LawError, LawInfo, LawPoint, PlyLaw, PlyResponse};
use fem_core::tensor::{Matrix6, Ply, Strain6, Stress6, apply};

/// A ply that loses a share of its shear stiffness to many small cracks along its fibres.
///
/// ```text
/// τ = (1 − d) G γ                              all else is linear elasticity
/// d = D (1 − exp(−(γ_max − γ_0)/γ_c))          of the largest |γ12| so far, from γ_0 on
/// ```
///
/// Cracks close when the shear goes back, so that nothing is left of it; what they take is ∫ ½ G γ² dd.
///
/// State: 0 how far |γ12| has been beyond γ_0.
#[derive(Debug, Clone, Copy)]
pub struct ShearCracks {
    /// γ_0.
    pub onset: f64,
    /// γ_c.
    pub spread: f64,
    /// D, below 1.
    pub most: f64,
}

/// Row of the shear 12.
const SHEAR: usize = 3;

// ANCHOR: curves
impl ShearCracks {
    /// Damage and its derivative where the largest shear is `beyond` the onset.
    fn damage(&self, beyond: f64) -> (f64, f64) {
        let sound = (-beyond / self.spread).exp();
        (self.most * (1.0 - sound), self.most * sound / self.spread)
    }

    /// ∫ ½ γ² dd, which times G is the energy that the cracks have taken.
    fn taken(&self, beyond: f64) -> f64 {
        let rest = |gamma: f64| gamma * gamma + 2.0 * self.spread * (gamma + self.spread);
        0.5 * self.most * (rest(self.onset) - rest(self.onset + beyond) * (-beyond / self.spread).exp())
    }
}
// ANCHOR_END: curves

// ANCHOR: law
impl PlyLaw for ShearCracks {
    fn info(&self) -> &LawInfo {
        const INFO: LawInfo = LawInfo { state: &["shear beyond the onset"], strengths: &[], toughness: &[] };
        &INFO
    }

    fn respond(
        &self,
        point: &LawPoint<'_>,
        strain: &Strain6<Ply>,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut Matrix6>,
    ) -> Result<PlyResponse, LawError> {
        let (gamma, g) = (strain.g12(), point.stiffness[SHEAR][SHEAR]);
        let grows = gamma.abs() - self.onset > old[0];
        let beyond = if grows { gamma.abs() - self.onset } else { old[0] };
        new[0] = beyond;
        let (damage, slope) = self.damage(beyond);
        if let Some(tangent) = tangent {
            *tangent = *point.stiffness;
            tangent[SHEAR][SHEAR] = (1.0 - damage - if grows { slope * gamma.abs() } else { 0.0 }) * g;
        }
        let mut stress = apply(point.stiffness, &strain.0);
        stress[SHEAR] *= 1.0 - damage;
        let stored = 0.5 * stress.iter().zip(strain.0).map(|(s, e)| s * e).sum::<f64>();
        let energy = Energy { stored, dissipated: g * self.taken(beyond) };
        Ok(PlyResponse { stress: Stress6::new(stress), energy })
    }
}
// ANCHOR_END: law

// ANCHOR: plugin
const ONSET: ParamInfo = ParamInfo::number("onset", "shear strain at which cracks begin").above(0.0);
const SPREAD: ParamInfo = ParamInfo::number("spread", "shear strain over which they multiply").above(0.0);
const MOST: ParamInfo =
    ParamInfo::number("most", "share of the shear stiffness that they take in the end").at_least(0.0).below(1.0);

impl Plugin for ShearCracks {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::PlyLaw,
        name: "shear-cracks",
        summary: "shear stiffness that many small cracks along the fibres take, up to a share of it",
        source: "an example",
        params: &[ONSET, SPREAD, MOST],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let [onset, spread, most] = [params.number(&ONSET)?, params.number(&SPREAD)?, params.number(&MOST)?];
        Ok(Built::PlyLaw(Box::new(Self { onset, spread, most })))
    }
}
// ANCHOR_END: plugin
