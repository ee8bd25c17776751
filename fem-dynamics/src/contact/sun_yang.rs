//! The indentation law of Sun and Yang.

use super::Hertz;
use fem_core::contact::{Branches, ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

/// Loading along a power law, unloading along a steeper one to a permanent dent (report eqs 24-26).
///
/// ```text
/// loading beyond α_max          F = k αⁿ
/// below α_max                   F = F_max ((α − α₀)/(α_max − α₀))^p     F_max = k α_maxⁿ, p = m; no force for α ≤ α₀
/// dent, when α_max > α_cr       α₀ = α_max (1 − (α_cr/α_max)^β)         otherwise 0; continuous at α_cr
/// ```
///
/// α_max is the largest indentation so far. The curve below it is followed in both directions. The report prints no
/// law for a second contact: `reloading = "unloading-curve"` keeps p = m, `"loading-exponent"` takes p = n once the
/// bodies have been apart (α ≤ α₀), until α_max is exceeded again.
///
/// Stored is what the bodies would give back by separating along the present curve; the rest of the work is
/// dissipated. m ≥ n makes it grow with α_max and never fall.
///
/// History: 0 α_max, m; 1 is 1 while the curve with exponent n is followed; 2 energy dissipated, J.
#[derive(Debug, Clone, Copy)]
pub struct SunYang {
    loading: Hertz,
    m: f64,
    critical: f64,
    beta: f64,
    reload_by_n: bool,
}

/// What lies below the largest indentation: F = peak (x/depth)^p, x from the dent.
struct Curve {
    dent: f64,
    depth: f64,
    peak: f64,
    p: f64,
}

/// x^e; the usual exponents, 1/2 of loading and 3/2 of unloading, without the library's power, whose last digits differ from system to
/// system.
fn power(x: f64, e: f64) -> f64 {
    if e == 1.5 {
        x * x.sqrt()
    } else if e == 0.5 {
        x.sqrt()
    } else {
        x.powf(e)
    }
}

impl Curve {
    fn at(&self, alpha: f64) -> ContactForce {
        if alpha <= self.dent {
            return ContactForce::default();
        }
        let x = (alpha - self.dent) / self.depth;
        let slope = self.peak * power(x, self.p - 1.0);
        ContactForce { force: slope * x, tangent: self.p * slope / self.depth }
    }

    /// Work from the dent to `alpha`.
    fn work(&self, alpha: f64) -> f64 {
        self.at(alpha).force * (alpha - self.dent) / (self.p + 1.0)
    }
}

impl SunYang {
    /// Loading k αⁿ, unloading with the exponent `m`, a dent of exponent `beta` beyond `critical`; β = 0 leaves no dent. A second
    /// contact follows the curve of unloading.
    pub fn new([k, n]: [f64; 2], m: f64, critical: f64, beta: f64) -> Self {
        Self { loading: Hertz::new(k, n), m, critical, beta, reload_by_n: false }
    }

    fn curve(&self, alpha_max: f64, p: f64) -> Curve {
        let dent = alpha_max - alpha_max * (self.critical / alpha_max).min(1.0).powf(self.beta);
        Curve { dent, depth: alpha_max - dent, peak: self.loading.at(alpha_max).force, p }
    }

    fn present(&self, history: &ContactHistory) -> Curve {
        self.curve(history[0], if history[1] == 0.0 { self.m } else { self.loading.n() })
    }
}

impl ContactLaw for SunYang {
    fn force(&self, history: &ContactHistory, alpha: f64) -> ContactForce {
        if alpha <= history[0] { self.present(history).at(alpha) } else { self.loading.at(alpha) }
    }

    fn commit(&self, history: &mut ContactHistory, alpha: f64) {
        if alpha > history[0] {
            *history = [alpha, 0.0, self.energy(history, alpha).dissipated, 0.0, 0.0, 0.0, 0.0, 0.0];
        } else if self.reload_by_n && history[0] > 0.0 && alpha <= self.present(history).dent {
            history[1] = 1.0;
        }
    }

    fn energy(&self, history: &ContactHistory, alpha: f64) -> Energy {
        let [alpha_max, _, dissipated, ..] = *history;
        let before = self.present(history);
        if alpha <= alpha_max {
            return Energy { stored: before.work(alpha), dissipated };
        }
        let work = before.work(alpha_max) + self.loading.work(alpha) - self.loading.work(alpha_max);
        let stored = self.curve(alpha, self.m).work(alpha);
        Energy { stored, dissipated: dissipated + work - stored }
    }

    fn branches(&self, history: &ContactHistory) -> Branches {
        Branches { touch: self.present(history).dent, peak: Some(history[0]) }
    }
}

const M: ParamInfo =
    ParamInfo::number("m", "exponent of unloading, not below n").at_least(1.0).at_most(10.0).default(2.5);
const CRITICAL: ParamInfo =
    ParamInfo::quantity("critical", "indentation from which on a dent remains", Dimension::LENGTH).above(0.0);
const BETA: ParamInfo = ParamInfo::number("beta", "exponent of the dent").above(0.0).at_most(1.0).default(0.4);
const RELOADING: ParamInfo = ParamInfo::word(
    "reloading",
    "curve of a second contact",
    &[("unloading-curve", "that of unloading"), ("loading-exponent", "from the dent, with the exponent n")],
);

impl Plugin for SunYang {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Contact,
        name: "sun-yang",
        summary: "power law with steeper unloading and a permanent dent",
        source: "Yang and Sun 1982; AFWAL-TR-87-4117 eqs 24-26",
        params: &[Hertz::K, Hertz::N, M, CRITICAL, BETA, RELOADING],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let loading = Hertz::power(params)?;
        let m = params.number(&M)?;
        if m < loading.n() {
            return Err(ParamError::new(M.name, format!("must not be below n = {}, got {m}", loading.n())));
        }
        let (critical, beta) = (params.number(&CRITICAL)?, params.number(&BETA)?);
        let reload_by_n = params.word(&RELOADING)? == "loading-exponent";
        Ok(Built::Contact(Box::new(Self { loading, m, critical, beta, reload_by_n })))
    }
}
