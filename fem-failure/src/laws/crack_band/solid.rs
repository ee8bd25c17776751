//! Stress of a cracked ply before the cracks are taken off it.

use fem_core::tensor::Matrix6;

/// Fibres in tension and compression, matrix in tension and compression.
pub(super) type Damage = [f64; 4];
pub(super) type Matrix3 = [[f64; 3]; 3];

/// Elastic constants as the law needs them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solid {
    /// E of the normal components.
    pub(super) e: [f64; 3],
    /// Eᵢ Sᵢⱼ off the diagonal, zero on it.
    pub(super) coupling: Matrix3,
    /// G of 12, 23, 13.
    pub(super) g: [f64; 3],
    /// Share of each normal stress that damage takes at most.
    pub(super) opened: [f64; 3],
}

/// Effective normal stresses, h = (I + E O A)⁻¹ E ε, σ = A h.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effective {
    pub(super) h: [f64; 3],
    /// Which damage acts on each.
    pub(super) by: [usize; 3],
    /// What it leaves, A.
    pub(super) left: [f64; 3],
    /// (I + E O A)⁻¹; of a sound ply nobody asks for it.
    pub(super) inverse: Matrix3,
}

impl Solid {
    /// Which damage acts on a normal component by its sign.
    fn mode(component: usize, h: f64) -> usize {
        // Zero counts as tension.
        2 * usize::from(component > 0) + usize::from(h < 0.0)
    }

    /// Effective normal stresses under a strain; the signs on which the damage depends are those of the result, of which there is
    /// one, as the complementary energy is strictly convex.
    pub(super) fn effective(&self, strain: &[f64; 3], damage: &Damage, c: &Matrix6) -> Effective {
        let signs = |h: &[f64; 3]| std::array::from_fn(|i| Self::mode(i, h[i]));
        let mut by = self.sound(strain, c).by;
        for _ in 0..4 {
            let found = self.with(strain, damage, by);
            by = signs(&found.h);
            // Where both damages are the same the sign does not matter.
            if by.map(|k| damage[k]) == found.by.map(|k| damage[k]) {
                return Effective { by, ..found };
            }
        }
        let all = (0..8_usize).map(|k| self.with(strain, damage, [k & 1, 2 + (k >> 1 & 1), 2 + (k >> 2 & 1)]));
        let consistent = all.into_iter().find(|one| signs(&one.h) == one.by);
        consistent.unwrap_or_else(|| self.with(strain, damage, by))
    }

    /// Those of a sound ply.
    pub(super) fn sound(&self, strain: &[f64; 3], c: &Matrix6) -> Effective {
        let h = std::array::from_fn(|i| c[i][0] * strain[0] + c[i][1] * strain[1] + c[i][2] * strain[2]);
        let by = std::array::from_fn(|i| Self::mode(i, h[i]));
        Effective { h, by, left: [1.0; 3], inverse: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] }
    }

    fn with(&self, strain: &[f64; 3], damage: &Damage, by: [usize; 3]) -> Effective {
        let left = std::array::from_fn(|i| 1.0 - self.opened[i] * damage[by[i]]);
        let inverse = invert(&std::array::from_fn(|i| {
            std::array::from_fn(|j| self.coupling[i][j] * left[j] + if i == j { 1.0 } else { 0.0 })
        }));
        let free: [f64; 3] = std::array::from_fn(|i| self.e[i] * strain[i]);
        Effective { h: multiply(&inverse, &free), by, left, inverse }
    }
}

impl Effective {
    /// ∂h/∂d of the damage `k`.
    pub(super) fn slope(&self, solid: &Solid, k: usize) -> [f64; 3] {
        let own: [f64; 3] = std::array::from_fn(|j| if self.by[j] == k { solid.opened[j] * self.h[j] } else { 0.0 });
        multiply(&self.inverse, &multiply(&solid.coupling, &own))
    }
}

pub(super) fn multiply(m: &Matrix3, v: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2])
}

pub(super) fn invert(m: &Matrix3) -> Matrix3 {
    let minor = |i: usize, j: usize| {
        let ([a, b], [c, d]) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let over = 1.0 / (m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2));
    std::array::from_fn(|i| std::array::from_fn(|j| over * minor(j, i)))
}
