//! The part of a shear along the fibres that stays.

use crate::laws::shear;

/// What is left of the shears 12 and 13, and the length of the way there.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Permanent {
    pub(super) left: [f64; 2],
    pub(super) way: f64,
}

/// How far shears yield, and what comes then.
#[derive(Debug, Clone, Copy)]
pub(super) struct Yielding {
    /// Hahn and Tsai's α, 1/Pa³.
    pub(super) alpha: f64,
    /// The strength at which the curve ends, Pa.
    pub(super) strength: f64,
    /// Whether shears yield on at the strength; otherwise they are elastic from there on, and cracks take over.
    pub(super) on: bool,
}

impl Yielding {
    /// The length of the way at which the curve ends.
    fn most(&self) -> f64 {
        self.alpha * self.strength.powi(3)
    }

    /// Energy lost on a way, undamaged, J/m³.
    pub(super) fn lost(&self, way: f64) -> f64 {
        let curved = way.min(self.most());
        shear::lost(self.alpha, curved) + self.strength * (way - curved)
    }
}

/// Effective shears 12 and 13, their tangent and what they leave.
pub(super) struct Sheared {
    pub(super) t: [f64; 2],
    pub(super) tangent: [[f64; 2]; 2],
    pub(super) left: Permanent,
}

impl Permanent {
    /// Shears of a material that is isotropic about the fibre, hardening isotropic.
    pub(super) fn shear(&self, yielding: &Yielding, g: f64, strain: [f64; 2]) -> Sheared {
        let Yielding { alpha, strength, on } = *yielding;
        let most = yielding.most();
        let elastic = [strain[0] - self.left[0], strain[1] - self.left[1]];
        let size = (elastic[0] * elastic[0] + elastic[1] * elastic[1]).sqrt();
        let curving = self.way < most;
        let beyond = if curving { alpha * (g * size).powi(3) > self.way } else { on && g * size > strength };
        if !beyond {
            let tangent = [[g, 0.0], [0.0, g]];
            return Sheared { t: elastic.map(|e| g * e), tangent, left: *self };
        }
        let direction = elastic.map(|e| e / size);
        let curved = shear::on_curve(alpha, g, size + self.way);
        let reached = alpha * curved.powi(3);
        let (stress, way, slope) = if reached < most {
            (curved, reached, g / (1.0 + 3.0 * alpha * g * curved * curved))
        } else if on {
            (strength, self.way + (size - strength / g), 0.0)
        } else {
            (g * (size - (most - self.way)), most, g)
        };
        let across = stress / size;
        let tangent = [0, 1].map(|i| {
            [0, 1].map(|j| direction[i] * direction[j] * (slope - across) + if i == j { across } else { 0.0 })
        });
        let left = [0, 1].map(|k| self.left[k] + (way - self.way) * direction[k]);
        Sheared { t: direction.map(|d| stress * d), tangent, left: Permanent { left, way } }
    }
}
