//! Static condensation (AFWAL-TR-87-4117, eqs 27-29): unknowns inside follow those that stay.

use super::{Cholesky, FactorError, Symbolic, Symmetric};
use std::num::NonZeroUsize;
use std::ops::Range;

/// Unit displacements of those that stay whose static shapes are found together.
const BLOCK: usize = 64;

/// A stiffness whose first unknowns, those inside, follow the others statically: u_i = −K_ii⁻¹ K_ib u_b.
///
/// ```
/// use fem_core::assembly::{Inside, assemble_blocks, block_pattern};
/// use fem_core::constraint::Constraints;
/// use std::{num::NonZeroUsize, sync::Arc};
///
/// // Two springs of 2 and 3 N/m in a row, the node between them inside: 6/5 N/m in all.
/// let (blocks, springs) = ([[1, 0], [0, 2]], [[2.0, -2.0, -2.0, 2.0], [3.0, -3.0, -3.0, 3.0]]);
/// let all = Constraints::following(&[0, 1, 2], [])?;
/// let pattern = Arc::new(block_pattern(blocks.iter().map(|b| &b[..]), &all));
/// let k = assemble_blocks(&pattern, blocks.iter().map(|b| &b[..]).zip(springs.iter().map(|k| &k[..])), &all);
/// let inside = Inside::new(k, 1, NonZeroUsize::MIN)?;
/// let [k, _] = inside.condense(None);
/// assert!((k[0] - 1.2).abs() < 1e-15 && (k[1] + 1.2).abs() < 1e-15);
/// let mut u = [0.0, 1.0, 0.0];
/// inside.follow(&mut u);
/// assert!((u[0] - 0.4).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Inside {
    pub(super) count: usize,
    k: Symmetric,
    weakest: Option<(usize, f64)>,
    factor: Cholesky,
}

impl Inside {
    /// Of `k`, whose first `count` unknowns are inside.
    ///
    /// # Errors
    /// A stiffness inside that is not positive definite.
    pub fn new(k: Symmetric, count: usize, threads: NonZeroUsize) -> Result<Self, FactorError> {
        let leading = k.leading(count);
        let mut factor = Cholesky::new(Symbolic::new(leading.pattern().clone())?, threads);
        factor.factorise(leading.lower())?;
        Ok(Self { count, weakest: factor.weakest(leading.lower()), k, factor })
    }

    /// The unknown inside that is held least and its pivot, [`Cholesky::weakest`].
    pub fn weakest(&self) -> Option<(usize, f64)> {
        self.weakest
    }

    /// K* = TᵀKT and M* = TᵀMT of those that stay, both triangles, column-major; M* is zero without a mass.
    pub fn condense(&self, mass: Option<&Symmetric>) -> [Vec<f64>; 2] {
        let (n, count) = (self.k.ndof(), self.count);
        let outline = n - count;
        let mut condensed = [vec![0.0; outline * outline], vec![0.0; outline * outline]];
        for first in (0..outline).step_by(BLOCK) {
            let columns = BLOCK.min(outline - first);
            let mut shapes = vec![0.0; n * columns];
            (0..columns).for_each(|c| shapes[c * n + count + first + c] = 1.0);
            self.follow_units(first..first + columns, &mut shapes);
            let mut take = |which: usize, forces: &[f64]| {
                let columns = condensed[which][first * outline..].chunks_exact_mut(outline);
                columns.zip(forces.chunks_exact(n)).for_each(|(to, from)| to.copy_from_slice(&from[count..]));
            };
            let mut forces = vec![0.0; n * columns];
            self.k.add_product(1.0, &shapes, &mut forces);
            take(0, &forces);
            if let Some(mass) = mass {
                // TᵀMT = (M T)_b − K_bi K_ii⁻¹ (M T)_i
                forces.fill(0.0);
                mass.add_product(1.0, &shapes, &mut forces);
                self.condense_load(&mut forces);
                take(1, &forces);
            }
        }
        condensed.iter_mut().for_each(|a| symmetrise(a, outline));
        condensed
    }

    /// `X_i ← K_ii⁻¹ X_i`, column by column.
    fn solve(&self, x: &mut [f64]) {
        let n = self.k.ndof();
        let mut inner: Vec<f64> = x.chunks_exact(n).flat_map(|x| &x[..self.count]).copied().collect();
        self.factor.solve_in(&mut inner, x.len() / n, &mut Vec::new());
        for (x, inner) in x.chunks_exact_mut(n).zip(inner.chunks_exact(self.count.max(1))) {
            x[..self.count].copy_from_slice(inner);
        }
    }

    /// As [`Inside::follow`] of unit displacements of these of the outline: −K_ib needs no product.
    fn follow_units(&self, units: Range<usize>, x: &mut [f64]) {
        let (n, lower) = (self.k.ndof(), self.k.lower());
        for j in 0..self.count {
            let entries = lower.col_range(j);
            for (row, value) in lower.row_idx()[entries.clone()].iter().zip(&lower.val()[entries]) {
                if let Some(b) = row.checked_sub(self.count).filter(|b| units.contains(b)) {
                    x[(b - units.start) * n + j] = -value;
                }
            }
        }
        self.solve(x);
    }

    /// `X_i ← −K_ii⁻¹ K_ib X_b`, column by column, where X_i = 0.
    pub fn follow(&self, x: &mut [f64]) {
        let mut forces = vec![0.0; x.len()];
        self.k.add_product(-1.0, x, &mut forces);
        self.solve(&mut forces);
        let n = self.k.ndof();
        for (x, response) in x.chunks_exact_mut(n).zip(forces.chunks_exact(n)) {
            x[..self.count].copy_from_slice(&response[..self.count]);
        }
    }

    /// `F_b ← F_b − K_bi K_ii⁻¹ F_i`, column by column; returns `[K_ii⁻¹ F_i; 0]`.
    pub(super) fn condense_load(&self, f: &mut [f64]) -> Vec<f64> {
        let mut x = f.to_vec();
        self.solve(&mut x);
        x.chunks_exact_mut(self.k.ndof()).for_each(|x| x[self.count..].fill(0.0));
        self.k.add_product(-1.0, &x, f);
        x
    }
}

/// `A ← (A + Aᵀ)/2`
fn symmetrise(a: &mut [f64], n: usize) {
    for j in 0..n {
        for i in j + 1..n {
            let mean = 0.5 * (a[j * n + i] + a[i * n + j]);
            (a[j * n + i], a[i * n + j]) = (mean, mean);
        }
    }
}
