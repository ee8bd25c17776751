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

const RADIUS: ParamInfo =
    ParamInfo::quantity("radius", "tip radius; with the three below instead of k and n", Dimension::LENGTH)
        .above(0.0)
        .optional();
const E_TIP: ParamInfo =
    ParamInfo::quantity("e_tip", "Young's modulus of the tip", Dimension::PRESSURE).above(0.0).optional();
const NU_TIP: ParamInfo =
    ParamInfo::number("nu_tip", "Poisson's ratio of the tip").at_least(0.0).at_most(0.5).optional();
const E_PLATE: ParamInfo =
    ParamInfo::quantity("e_plate", "modulus of the plate across its plane", Dimension::PRESSURE).above(0.0).optional();
const OF_BODIES: [ParamInfo; 4] = [RADIUS, E_TIP, NU_TIP, E_PLATE];

impl Hertz {
    pub(super) const K: ParamInfo =
        ParamInfo::quantity_by("k", "contact stiffness", &Self::N, Dimension::contact_stiffness).above(0.0);
    pub(super) const N: ParamInfo =
        ParamInfo::number("n", "exponent of loading").at_least(1.0).at_most(4.0).default(1.5);

    pub(super) fn new(k: f64, n: f64) -> Self {
        Self { k, n }
    }

    /// The power law of the parameters `k` and `n`.
    pub(super) fn power(params: &Params) -> Result<Self, ParamError> {
        Ok(Self::new(params.number(&Self::K)?, params.number(&Self::N)?))
    }

    fn of_bodies(params: &Params) -> Result<Self, ParamError> {
        if let Some(row) = [Self::K, Self::N].iter().find(|row| params.has(row)) {
            let others = OF_BODIES.map(|row| row.name).join(", ");
            return Err(ParamError::new(
                row.name,
                format!("says what {others} say as well: leave one or the others out"),
            ));
        }
        let (radius, e_tip) = (params.number(&RADIUS)?, params.number(&E_TIP)?);
        let (nu_tip, e_plate) = (params.number(&NU_TIP)?, params.number(&E_PLATE)?);
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
        params: &[Self::K.optional(), Self::N, RADIUS, E_TIP, NU_TIP, E_PLATE],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let of_bodies = OF_BODIES.iter().any(|row| params.has(row));
        let law = if of_bodies { Self::of_bodies(params)? } else { Self::power(params)? };
        Ok(Built::Contact(Box::new(law)))
    }
}
