//! Closed-form reserve factors of indices that are polynomials of degree two in the stress.

use fem_core::failure::{Reserve, moderate};
use fem_core::tensor::{Ply, Stress6};

/// An index by its degrees in the stress: f = linear + quadratic. The load factor R scales them by R and R².
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Terms {
    pub(crate) linear: f64,
    pub(crate) quadratic: f64,
}

impl Terms {
    /// The mode does not apply.
    pub(crate) const NONE: Self = Self { linear: 0.0, quadratic: 0.0 };

    /// The stress is outside the criterion's theory.
    pub(crate) const REFUSED: Self = Self { linear: f64::NAN, quadratic: 0.0 };

    pub(crate) fn linear(linear: f64) -> Self {
        Self { linear, quadratic: 0.0 }
    }

    pub(crate) fn quadratic(quadratic: f64) -> Self {
        Self { linear: 0.0, quadratic }
    }

    /// These terms while `on`, none otherwise.
    pub(crate) fn when(self, on: bool) -> Self {
        if on { self } else { Self::NONE }
    }

    fn index(self) -> f64 {
        self.linear + self.quadratic
    }

    /// Smallest R > 0 with linear R + quadratic R² = 1, +∞ if there is none; neither form cancels digits.
    fn reserve(self) -> f64 {
        let Self { linear: b, quadratic: a } = self;
        let discriminant = b * b + 4.0 * a;
        if b.is_nan() || a.is_nan() {
            f64::NAN
        } else if discriminant < 0.0 {
            f64::INFINITY
        } else if b >= 0.0 {
            2.0 / (b + discriminant.sqrt())
        } else if a > 0.0 {
            (discriminant.sqrt() - b) / (2.0 * a)
        } else {
            f64::INFINITY
        }
    }
}

/// Indices of a criterion from its terms.
#[inline]
pub(crate) fn indices<const N: usize>(terms: [Terms; N], out: &mut [f64]) {
    for (out, terms) in out.iter_mut().zip(terms) {
        *out = terms.index();
    }
}

/// Reserve factor of a criterion from its terms.
pub(crate) fn reserve<const N: usize>(s: &Stress6<Ply>, terms: impl Fn(&Stress6<Ply>) -> [Terms; N]) -> Reserve {
    let (unit, k) = moderate(s);
    let mut least = Reserve::UNBOUNDED;
    for (mode, terms) in terms(&unit).into_iter().enumerate() {
        let factor = terms.reserve() / k;
        if factor.is_nan() {
            return Reserve { factor, mode: None };
        }
        if factor < least.factor {
            least = Reserve { factor, mode: Some(mode) };
        }
    }
    least
}

/// The two methods of a criterion that has an inherent `terms(&self, &Stress6<Ply>, &Material) -> [Terms; N]`.
macro_rules! from_terms {
    () => {
        #[inline]
        fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
            crate::terms::indices(self.terms(s, m), out);
        }

        fn reserve_factor(&self, s: &Stress6<Ply>, m: &Material) -> fem_core::failure::Reserve {
            crate::terms::reserve(s, |s| self.terms(s, m))
        }
    };
}
pub(crate) use from_terms;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_keep_their_digits() {
        let root = |linear, quadratic| Terms { linear, quadratic }.reserve();
        assert_eq!(root(2.0, 0.0), 0.5);
        assert_eq!(root(0.0, 4.0), 0.5);
        assert_eq!(root(0.0, 0.0), f64::INFINITY);
        assert_eq!(root(-1.0, 0.0), f64::INFINITY);
        // Never reached, and reached at 2 before the parabola turns.
        assert_eq!(root(0.5, -0.1), f64::INFINITY);
        assert_eq!(root(0.75, -0.125), 2.0);
        // R² 1e-20 − R = 1 has its root at 1e20 + 1.
        assert_eq!(root(-1.0, 1e-20), 1e20);
        assert!((root(1.0, 1e-20) - 1.0).abs() < 1e-15);
        assert!(root(f64::NAN, 1.0).is_nan() && root(0.0, f64::NAN).is_nan());
    }
}
