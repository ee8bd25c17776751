//! The law of a sphere that crushes a laminate.

use super::Hertz;
use fem_core::contact::{Branches, ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use std::f64::consts::PI;

/// Hertz' law up to an indentation at which the plate yields, a straight line from there on, and Hertz' stiffness on the way back.
///
/// ```text
/// loading                F = k α^1.5                            up to α_y
///                        F = k α_y^1.5 + K (α − α_y)            beyond, K = 1.5 k √α_y, the tangent there
/// below α_max > α_y      F = F_max − k (α_max^1.5 − α^1.5)      none from the dent α₀ on, α₀^1.5 = α_max^1.5 − F_max/k
/// ```
///
/// α_y is given, or follows from the radius R of the tip and the shear strength S of the laminate: below a sphere the largest shear stress of an
/// elastic half-space, 0.30 of the largest pressure, is S (Tresca, yield stress 2 S) at
///
/// ```text
/// α_y = 0.68 π² (2 S)² R/E²,   E = 3 k/(4 √R)
/// ```
///
/// so that K = 10.4 S R, whatever k is. A second contact follows the way back. Stored is what the bodies give back by separating; the rest of the
/// work is dissipated.
///
/// Limits: one line for all that follows the first yielding, up to any depth; no rates, no creep. With the shear strength of a single ply for S it
/// yields early. On the way back from deep down it is stiffer than the squeeze of the plate, so that its indentation counts from the face.
///
/// History: 0 α_max, m.
#[derive(Debug, Clone, Copy)]
pub struct YigitChristoforou {
    elastic: Hertz,
    k: f64,
    yields: f64,
}

impl YigitChristoforou {
    /// Hertz' stiffness `k`, N/m^1.5, and the indentation `yields` from which on the plate is crushed.
    pub fn new(k: f64, yields: f64) -> Self {
        Self { elastic: Hertz::new(k, 1.5), k, yields }
    }

    /// α_y of a tip of `radius` on a laminate of the shear strength `strength`.
    fn yields(k: f64, radius: f64, strength: f64) -> f64 {
        let modulus = 0.75 * k / radius.sqrt();
        let ratio = 2.0 * PI * strength / modulus;
        0.68 * ratio * ratio * radius
    }

    fn loading(&self, alpha: f64) -> ContactForce {
        if alpha.is_nan() || alpha <= self.yields {
            return self.elastic.at(alpha);
        }
        let ContactForce { force, tangent } = self.elastic.at(self.yields);
        ContactForce { force: force + tangent * (alpha - self.yields), tangent }
    }

    /// Work of loading from the first touch to `alpha`.
    fn work(&self, alpha: f64) -> f64 {
        let elastic = self.elastic.work(alpha.min(self.yields));
        let beyond = (alpha - self.yields).max(0.0);
        elastic + beyond * (self.loading(self.yields).force + 0.5 * self.loading(alpha).tangent * beyond)
    }

    /// The dent α₀ that loading to `alpha_max` leaves.
    fn dent(&self, alpha_max: f64) -> f64 {
        if alpha_max <= self.yields {
            return 0.0;
        }
        let left = alpha_max * alpha_max.sqrt() - self.loading(alpha_max).force / self.k;
        left.max(0.0).cbrt().powi(2)
    }

    /// What the way back below `alpha_max` has stored at `alpha`.
    fn stored(&self, alpha_max: f64, alpha: f64) -> f64 {
        let dent = self.dent(alpha_max);
        if alpha <= dent {
            return 0.0;
        }
        self.elastic.work(alpha) - self.elastic.work(dent) - self.elastic.at(dent).force * (alpha - dent)
    }
}

impl ContactLaw for YigitChristoforou {
    fn force(&self, history: &ContactHistory, alpha: f64) -> ContactForce {
        let alpha_max = history[0];
        if alpha.is_nan() || alpha > alpha_max {
            return self.loading(alpha);
        }
        let dent = self.dent(alpha_max);
        if alpha <= dent {
            return ContactForce::default();
        }
        let ContactForce { force, tangent } = self.elastic.at(alpha);
        ContactForce { force: (force - self.elastic.at(dent).force).max(0.0), tangent }
    }

    fn commit(&self, history: &mut ContactHistory, alpha: f64) {
        history[0] = history[0].max(alpha);
    }

    fn energy(&self, history: &ContactHistory, alpha: f64) -> Energy {
        let alpha_max = history[0].max(alpha);
        let dissipated = self.work(alpha_max) - self.stored(alpha_max, alpha_max);
        Energy { stored: self.stored(alpha_max, alpha), dissipated: dissipated.max(0.0) }
    }

    fn branches(&self, history: &ContactHistory) -> Branches {
        // Until it yields it is one curve in both directions, up to where the line begins.
        Branches { touch: self.dent(history[0]), peak: Some(history[0].max(self.yields)) }
    }
}

const K: ParamInfo = ParamInfo::quantity("k", "contact stiffness", Dimension::contact_stiffness(1.5)).above(0.0);
const CRITICAL: ParamInfo =
    ParamInfo::quantity("critical", "indentation at which the plate yields", Dimension::LENGTH).above(0.0);
const RADIUS: ParamInfo =
    ParamInfo::quantity("radius", "tip radius; with `strength` instead of `critical`", Dimension::LENGTH)
        .above(0.0)
        .optional();
const STRENGTH: ParamInfo =
    ParamInfo::quantity("strength", "shear strength of the laminate; with `radius`", Dimension::PRESSURE)
        .above(0.0)
        .optional();

impl Plugin for YigitChristoforou {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Contact,
        name: "yigit-christoforou",
        summary: "Hertz' law up to yielding, a straight line beyond, Hertz' stiffness on the way back to a dent",
        source: "Yigit and Christoforou 1994",
        params: &[K, CRITICAL.optional(), RADIUS, STRENGTH],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let k = params.number(&K)?;
        let of_bodies = [RADIUS, STRENGTH].iter().any(|row| params.has(row));
        if of_bodies && params.has(&CRITICAL) {
            return Err(ParamError::new(
                CRITICAL.name,
                "says what radius and strength say as well: leave it or both of them out".to_owned(),
            ));
        }
        let yields = if of_bodies {
            Self::yields(k, params.number(&RADIUS)?, params.number(&STRENGTH)?)
        } else {
            params.number(&CRITICAL)?
        };
        Ok(Built::Contact(Box::new(Self::new(k, yields))))
    }
}
