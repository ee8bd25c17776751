//! The elastic power law.

use fem_core::contact::{ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};

/// `F = k αⁿ` for α > 0, no force otherwise; elastic, so it remembers nothing.
///
/// With n = 1.5 it is Hertz's law. Then k may come from the bodies instead: a tip of radius R on a plate whose modulus
/// across its plane is E₂ (Sun and Yang's reading for laminates) has `k = 4/3 √R / ((1 − ν²)/E_tip + 1/E₂)`.
#[derive(Debug, Clone, Copy)]
pub struct Hertz {
    k: f64,
    n: f64,
}

const FROM_BODIES: [&str; 4] = ["radius", "e_tip", "nu_tip", "e_plate"];

impl Hertz {
    pub(super) const K: ParamInfo = ParamInfo { name: "k", doc: "contact stiffness, N/m^n" };
    pub(super) const N: ParamInfo = ParamInfo { name: "n", doc: "exponent of loading, 1 to 4, default 1.5" };

    pub(super) fn new(k: f64, n: f64) -> Self {
        Self { k, n }
    }

    /// The power law of the parameters `k` and `n`.
    pub(super) fn power(params: &Params) -> Result<Self, ParamError> {
        let n = params.number("n", Some(1.5))?;
        if !(1.0..=4.0).contains(&n) {
            return Err(ParamError::new("n", format!("must lie between 1 and 4, got {n}")));
        }
        Ok(Self::new(params.positive("k", Dimension::contact_stiffness(n), None)?, n))
    }

    fn of_bodies(params: &Params) -> Result<Self, ParamError> {
        if let Some(key) = ["k", "n"].into_iter().find(|key| params.get(key).is_some()) {
            return Err(ParamError::new(key, format!("and {} exclude each other", FROM_BODIES.join(", "))));
        }
        let radius = params.positive("radius", Dimension::LENGTH, None)?;
        let e_tip = params.positive("e_tip", Dimension::PRESSURE, None)?;
        let nu_tip = params.number("nu_tip", None)?;
        let e_plate = params.positive("e_plate", Dimension::PRESSURE, None)?;
        if !(0.0..=0.5).contains(&nu_tip) {
            return Err(ParamError::new("nu_tip", format!("must lie between 0 and 0.5, got {nu_tip}")));
        }
        let compliance = (1.0 - nu_tip * nu_tip) / e_tip + 1.0 / e_plate;
        Ok(Self::new(4.0 / 3.0 * radius.sqrt() / compliance, 1.5))
    }

    pub(super) fn n(&self) -> f64 {
        self.n
    }

    pub(super) fn at(&self, alpha: f64) -> ContactForce {
        if alpha <= 0.0 {
            return ContactForce::default();
        }
        // The usual exponent without the library's power, whose last digits differ from system to system.
        let power = if self.n == 1.5 { alpha.sqrt() } else { alpha.powf(self.n - 1.0) };
        let slope = self.k * power;
        ContactForce { force: slope * alpha, tangent: self.n * slope }
    }

    /// Work from first touch to `alpha`.
    pub(super) fn work(&self, alpha: f64) -> f64 {
        self.at(alpha).force * alpha / (self.n + 1.0)
    }
}

impl ContactLaw for Hertz {
    fn force(&self, _: &ContactHistory, alpha: f64) -> ContactForce {
        self.at(alpha)
    }

    fn commit(&self, _: &mut ContactHistory, _: f64) {}

    fn energy(&self, _: &ContactHistory, alpha: f64) -> Energy {
        Energy { stored: self.work(alpha), dissipated: 0.0 }
    }
}

impl Plugin for Hertz {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Contact,
        name: "hertz",
        summary: "elastic power law F = k a^n, from k or from tip and plate",
        source: "Hertz 1882; modulus across the plate after Yang and Sun 1982",
        params: &[
            Self::K,
            Self::N,
            ParamInfo { name: "radius", doc: "tip radius, m; with the three below instead of k and n" },
            ParamInfo { name: "e_tip", doc: "Young's modulus of the tip, Pa" },
            ParamInfo { name: "nu_tip", doc: "Poisson's ratio of the tip, 0 to 0.5" },
            ParamInfo { name: "e_plate", doc: "modulus of the plate across its plane, Pa" },
        ],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let of_bodies = FROM_BODIES.iter().any(|key| params.get(key).is_some());
        let law = if of_bodies { Self::of_bodies(params)? } else { Self::power(params)? };
        Ok(Built::Contact(Box::new(law)))
    }
}
