//! Thornton's elastic-plastic contact law: a plug-in in one file.
//!
//! What to look at: all functions ask one curve, that of unloading from the largest indentation so far. It is all that the
//! law remembers, so that force and energy follow from it and from the present indentation alone.
use fem_core::contact::{Branches, ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

/// A sphere on a half-space that yields where the pressure reaches its limit.
///
/// ```text
/// elastic     F = k α^(3/2)                                α ≤ α_y
/// plastic     F = k √α_y (3α − α_y)/2                      α_y < α, growing
/// unloading   F = F_max ((α − α_p)/(α_max − α_p))^(3/2)    α ≤ α_max; no force for α ≤ α_p
/// dent        α_p = α_max − F_max/(k √α_max)
/// ```
///
/// The pressure stays at its limit in the middle, so that force grows linearly; unloading is elastic on a surface that the
/// yielding has made flatter, with the same contact radius. It is followed in both directions.
///
/// History: 0 α_max, m.
#[derive(Debug, Clone, Copy)]
pub struct ElasticPlastic {
    /// Contact stiffness k, N/m^1.5.
    pub k: f64,
    /// Indentation at which it yields, α_y, m.
    pub yields: f64,
}

// ANCHOR: unloading
/// Unloading from the largest indentation: F = peak (x/depth)^(3/2), x from the dent.
struct Unloading {
    dent: f64,
    depth: f64,
    peak: f64,
}

impl Unloading {
    fn at(&self, alpha: f64) -> ContactForce {
        if alpha <= self.dent {
            return ContactForce::default();
        }
        let x = (alpha - self.dent) / self.depth;
        ContactForce { force: self.peak * x * x.sqrt(), tangent: 1.5 * self.peak * x.sqrt() / self.depth }
    }

    /// What comes back by separating from `alpha`.
    fn work(&self, alpha: f64) -> f64 {
        0.4 * self.at(alpha).force * (alpha - self.dent)
    }
}
// ANCHOR_END: unloading

// ANCHOR: loading
impl ElasticPlastic {
    fn loading(&self, alpha: f64) -> ContactForce {
        let slope = 1.5 * self.k * alpha.min(self.yields).sqrt();
        if alpha <= self.yields {
            return ContactForce { force: slope * alpha / 1.5, tangent: slope };
        }
        ContactForce { force: slope * (alpha - self.yields / 3.0), tangent: slope }
    }

    /// ∫ F dα of the loading from 0 to `alpha`.
    fn work(&self, alpha: f64) -> f64 {
        let elastic = alpha.min(self.yields);
        let [before, here] = [elastic, alpha].map(|a| self.loading(a).force);
        0.4 * before * elastic + 0.5 * (before + here) * (alpha - elastic)
    }

    fn unloading(&self, from: f64) -> Unloading {
        let peak = self.loading(from).force;
        let depth = if from <= self.yields { from } else { peak / (self.k * from.sqrt()) };
        Unloading { dent: from - depth, depth, peak }
    }
}
// ANCHOR_END: loading

// ANCHOR: law
impl ContactLaw for ElasticPlastic {
    fn force(&self, history: &ContactHistory, alpha: f64) -> ContactForce {
        if alpha > history[0] { self.loading(alpha) } else { self.unloading(history[0]).at(alpha) }
    }

    fn commit(&self, history: &mut ContactHistory, alpha: f64) {
        history[0] = history[0].max(alpha);
    }

    fn energy(&self, history: &ContactHistory, alpha: f64) -> Energy {
        let largest = history[0].max(alpha);
        let unloading = self.unloading(largest);
        Energy { stored: unloading.work(alpha), dissipated: (self.work(largest) - unloading.work(largest)).max(0.0) }
    }

    fn branches(&self, history: &ContactHistory) -> Branches {
        Branches { touch: self.unloading(history[0]).dent, peak: Some(history[0]) }
    }
}
// ANCHOR_END: law

// ANCHOR: plugin
const K: ParamInfo = ParamInfo::quantity("k", "contact stiffness", Dimension::contact_stiffness(1.5)).above(0.0);
const YIELD: ParamInfo = ParamInfo::quantity("yield", "indentation at which it yields", Dimension::LENGTH).above(0.0);

impl Plugin for ElasticPlastic {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Contact,
        name: "elastic-plastic",
        summary: "Hertz up to yield, linear beyond it, Hertzian unloading to a permanent dent",
        source: "Thornton, J. Appl. Mech. 64 (1997) 383",
        params: &[K, YIELD],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let (k, yields) = (params.number(&K)?, params.number(&YIELD)?);
        Ok(Built::Contact(Box::new(Self { k, yields })))
    }
}
// ANCHOR_END: plugin
