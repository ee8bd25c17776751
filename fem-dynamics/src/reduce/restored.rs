//! A reduction that was kept, held against its structure.

use super::diagonal::Modal;
use super::{LARGEST, Reduced};
use fem_core::structure::Structure;

/// What a product of modes may be off, relative, beside rounding.
const ENOUGH: f64 = 1e-8;

/// Rounding of products of modes, in units of what doubles resolve: it grows with the square of their frequency.
const ROUNDING: f64 = 1e3 * f64::EPSILON;

impl Reduced {
    /// The reduction with these K and M of its modes and Φ, `basis`; `None` where it cannot be one of `structure`.
    ///
    /// Sizes must fit, numbers be finite, and ΦᵀKΦ and ΦᵀMΦ be diagonal and those that are given, as one product of a vector with
    /// each says. That the columns of Φ are a good choice, nothing says.
    pub fn restored(structure: &dyn Structure, stiffness: Vec<f64>, mass: Vec<f64>, basis: Vec<f64>) -> Option<Self> {
        let (n, modes) = (structure.ndof(), stiffness.len());
        let most = LARGEST + structure.free_motions().len() / n.max(1);
        let sized = (1..=most).contains(&modes) && mass.len() == modes && Some(basis.len()) == n.checked_mul(modes);
        let sound = |k: &f64, m: &f64| k.is_finite() && *k >= 0.0 && (*m == 0.0 || *m == 1.0);
        let finite = stiffness.iter().zip(&mass).all(|(k, m)| sound(k, m)) && basis.iter().all(|v| v.is_finite());
        let restored = Self { modal: Modal { stiffness, mass, damping: Vec::new() }, basis, ndof: n };
        (sized && finite && restored.agrees(structure)).then_some(restored)
    }

    fn agrees(&self, structure: &dyn Structure) -> bool {
        let Modal { stiffness, mass, .. } = &self.modal;
        let lowest = stiffness.iter().zip(mass).filter(|(k, m)| **k > 0.0 && **m > 0.0).map(|(k, _)| *k);
        let lowest = lowest.fold(f64::INFINITY, f64::min);
        // Of either sign, so that what is off in two modes does not cancel.
        let sign = |i: usize| if i.wrapping_mul(0x9E37_79B9) >> 16 & 1 == 0 { 1.0 } else { -1.0 };
        let weight = |(i, k): (usize, &f64)| if *k > 0.0 { sign(i) / k.sqrt() } else { 0.0 };
        let q: Vec<f64> = stiffness.iter().enumerate().map(weight).collect();
        let mut u = vec![0.0; self.ndof];
        self.expand(&q, &mut u);
        let product = |add: &dyn Fn(&[f64], &mut [f64])| {
            let mut image = vec![0.0; self.ndof];
            add(&u, &mut image);
            let row = |mode: &[f64]| mode.iter().zip(&image).map(|(a, b)| a * b).sum::<f64>();
            self.basis.chunks_exact(self.ndof).map(row).collect::<Vec<f64>>()
        };
        let of_k = product(&|x, y| structure.add_stiffness(1.0, x, y));
        let of_m = product(&|x, y| structure.add_mass(1.0, x, y));
        let modes = stiffness.len() as f64;
        (0..stiffness.len()).filter(|i| stiffness[*i] > 0.0).all(|i| {
            let k = stiffness[i];
            let rounding = modes * ROUNDING * if mass[i] > 0.0 { k / lowest } else { 0.0 };
            let moves = mass[i] == 0.0 || (of_m[i] - q[i]).abs() <= (ENOUGH + rounding) * q[i].abs();
            moves && (of_k[i] - k * q[i]).abs() <= ENOUGH * modes * (k * q[i]).abs()
        })
    }
}
