//! The part of a shear along the fibres that stays.

use crate::laws::shear;

/// What is left of the shears 12 and 13, and the length of the way there.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Permanent {
    pub(super) left: [f64; 2],
    pub(super) way: f64,
}

/// Effective shears 12 and 13, their tangent and what they leave.
pub(super) struct Sheared {
    pub(super) t: [f64; 2],
    pub(super) tangent: [[f64; 2]; 2],
    pub(super) left: Permanent,
    /// Energy lost on the way so far, undamaged, J/m³.
    pub(super) lost: f64,
}

impl Permanent {
    /// Hahn and Tsai's curve of α up to the length `most`, then elastic; isotropic about the fibre, hardening isotropic.
    pub(super) fn shear(&self, alpha: f64, most: f64, g: f64, strain: [f64; 2]) -> Sheared {
        let elastic = [strain[0] - self.left[0], strain[1] - self.left[1]];
        let size = elastic[0].hypot(elastic[1]);
        if !(g * size > (self.way / alpha).cbrt() && self.way < most) {
            let tangent = [[g, 0.0], [0.0, g]];
            return Sheared { t: elastic.map(|e| g * e), tangent, left: *self, lost: shear::lost(alpha, self.way) };
        }
        let direction = elastic.map(|e| e / size);
        let yielding = shear::on_curve(alpha, g, size + self.way);
        let reached = alpha * yielding.powi(3);
        let (stress, way, slope) = if reached < most {
            (yielding, reached, g / (1.0 + 3.0 * alpha * g * yielding * yielding))
        } else {
            (g * (size - (most - self.way)), most, g)
        };
        let across = stress / size;
        let tangent = [0, 1].map(|i| {
            [0, 1].map(|j| direction[i] * direction[j] * (slope - across) + if i == j { across } else { 0.0 })
        });
        let left = [0, 1].map(|k| self.left[k] + (way - self.way) * direction[k]);
        Sheared {
            t: direction.map(|d| stress * d),
            tangent,
            left: Permanent { left, way },
            lost: shear::lost(alpha, way),
        }
    }
}
