//! Viscous damping.

/// C of `M ü + C u̇ + K u = f`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// As the matrices themselves are.
    Rayleigh(Rayleigh),
    /// The same ratio ζ to critical damping for every natural mode, φᵀ C φ = 2 ζ ω φᵀ M φ: for structures in modal
    /// coordinates. A mode without inertia has none.
    Ratio(f64),
}

impl Damping {
    /// ζ of a natural mode of the angular frequency `omega`, 1/s.
    pub fn ratio(&self, omega: f64) -> f64 {
        match self {
            Self::Rayleigh(Rayleigh { mass, stiffness }) => 0.5 * (mass / omega + stiffness * omega),
            Self::Ratio(ratio) => *ratio,
        }
    }
}

/// C = a M + b K: a natural mode is damped by the ratio ζ = (a/ω + b ω)/2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rayleigh {
    /// a, 1/s.
    pub mass: f64,
    /// b, s.
    pub stiffness: f64,
}

impl Rayleigh {
    /// (s, shift) of K + cm M + cc C = s (K + shift M).
    pub fn with_stiffness(&self, cm: f64, cc: f64) -> (f64, f64) {
        let s = 1.0 + cc * self.stiffness;
        (s, (cm + cc * self.mass) / s)
    }

    /// (mass, stiffness) factors of M + cc C = mass M + stiffness K.
    pub fn with_mass(&self, cc: f64) -> (f64, f64) {
        (1.0 + cc * self.mass, cc * self.stiffness)
    }
}
