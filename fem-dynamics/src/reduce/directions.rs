//! The deflections by which contacts stretch a reduced plate.

use nalgebra::{Cholesky, DMatrix, DVector};

/// Membrane tensions under which the static responses to a contact are directions: their stiffness against a mode over its
/// bending stiffness, of the lowest mode, 0 for none. That of tension grows with k², that of bending with k⁴.
const TENSIONS: [f64; 7] = [0.0, 1.0, 4.0, 16.0, 64.0, 256.0, 1024.0];

/// Stiffness of eased springs, all together, over that of the plate under the contact. Ten times and a tenth of it and two tensions beside
/// found the force of a thin plate that lifts off no better (1.3 % against Newton's method).
const EASED: f64 = 1.0;

/// Share of a direction beside those before it below which it does not count as one of its own.
const SAME: f64 = 1e-8;

/// Combinations P of the modes of a reduced plate whose deflections stretch it, orthonormal in its stiffness: the static
/// responses to each contact of the plate under no tension and more and more, q_i = p_i/(λ_i + ν √λ_i), and of the plate whose springs
/// that only push are eased: where some let go it bends in other shapes.
pub(super) struct Directions {
    pub(super) vectors: DMatrix<f64>,
    /// Largest coordinate of each in the static responses.
    pub(super) reach: Vec<f64>,
}

impl Directions {
    /// Of modes of these stiffnesses under `loads`, on springs that only push, each with what it holds of them and its stiffness.
    pub(super) fn new(stiffness: &[f64], loads: &[Vec<f64>], springs: &[(Vec<f64>, f64)]) -> Self {
        let n = stiffness.len();
        let bends: Vec<usize> = (0..n).filter(|i| stiffness[*i].is_finite()).collect();
        let dot =
            |a: &DVector<f64>, b: &DVector<f64>| -> f64 { bends.iter().map(|i| a[*i] * stiffness[*i] * b[*i]).sum() };
        let lowest = bends.first().map_or(0.0, |i| stiffness[*i].sqrt());
        let under = |load: &[f64], tension: f64| {
            let response = |i: usize| load[i] / (stiffness[i] + tension * lowest * stiffness[i].sqrt());
            DVector::from_fn(n, |i, _| if stiffness[i].is_finite() { response(i) } else { 0.0 })
        };
        let mut family: Vec<_> = loads.iter().flat_map(|load| TENSIONS.map(|tension| under(load, tension))).collect();
        family.extend(loads.iter().filter_map(|load| Self::eased(&bends, stiffness, load, springs)));
        let mut kept: Vec<DVector<f64>> = Vec::new();
        for candidate in &family {
            let mut rest = candidate.clone();
            // Twice is enough.
            for _ in 0..2 {
                kept.iter().for_each(|vector| rest.axpy(-dot(vector, &rest), vector, 1.0));
            }
            let left = dot(&rest, &rest);
            if left > SAME * dot(candidate, candidate) {
                kept.push(rest / left.sqrt());
            }
        }
        let reach = |v: &DVector<f64>| family.iter().map(|shape| dot(v, shape).abs()).fold(0.0, f64::max);
        Self { reach: kept.iter().map(reach).collect(), vectors: DMatrix::from_columns(&kept) }
    }

    /// Static response to a load of the modes that bend, on springs that only push and are eased; nothing where there are none, or none
    /// that is stiff.
    fn eased(bends: &[usize], stiffness: &[f64], load: &[f64], springs: &[(Vec<f64>, f64)]) -> Option<DVector<f64>> {
        let of = |values: &[f64]| DVector::from_iterator(bends.len(), bends.iter().map(|i| values[*i]));
        let (own, sound) = (of(load), of(stiffness));
        let flexibility: f64 = own.iter().zip(&sound).map(|(p, k)| p * p / k).sum();
        let held: f64 = springs.iter().map(|(_, k)| k).sum();
        let left = EASED / (flexibility * held);
        if !(left < 1.0) {
            return None;
        }
        let mut eased = DMatrix::from_diagonal(&sound);
        for (spring, k) in springs {
            let spring = of(spring);
            eased.ger((left - 1.0) * k, &spring, &spring, 1.0);
        }
        let found = Cholesky::new(eased)?.solve(&own);
        let mut shape = DVector::zeros(stiffness.len());
        bends.iter().zip(&found).for_each(|(i, value)| shape[*i] = *value);
        Some(shape)
    }
}
