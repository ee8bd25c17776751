//! The plies of one layer of cells.

use crate::contracts::transverse::SmoothTransverse;
use crate::words::tensor::Matrix6;

/// One ply (or the part of it) inside a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// Natural bounds, −1 ≤ q₀ < q₁ ≤ 1.
    pub q: [f64; 2],
    /// Stiffness in the plate's frame, Pa.
    pub c: Matrix6,
    /// Density, kg/m³.
    pub density: f64,
    /// Strain in the plate's frame that the ply has where nothing stresses it, engineering shears.
    pub free: [f64; 6],
}

/// The plies of one layer of cells, with their thickness moments (computed once for all cells of the layer).
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    /// Plies from the bottom up; they fill −1 ≤ q ≤ 1, or a part of it in a shell whose plies lie to one side of its reference surface.
    pub slices: Vec<Slice>,
    /// Mₘ = ∫ C qᵐ dq, m = 0 … 6.
    pub stiffness_moments: [Matrix6; 7],
    /// ∫ ρ qᵐ dq, m = 0 … 6.
    pub density_moments: [f64; 7],
    /// Transverse stresses that are smooth across the plies; none where all plies are of one stiffness, whose strains have
    /// such stresses anyway.
    pub transverse: Option<SmoothTransverse>,
}

impl Stack {
    /// Computes the moments of `slices`.
    pub fn new(slices: Vec<Slice>) -> Self {
        let mut stiffness_moments = [[[0.0; 6]; 6]; 7];
        let mut density_moments = [0.0; 7];
        for slice in &slices {
            for m in 0..7 {
                let p = m as i32 + 1;
                let moment = (slice.q[1].powi(p) - slice.q[0].powi(p)) / f64::from(p);
                density_moments[m] += slice.density * moment;
                for (row, c) in stiffness_moments[m].iter_mut().zip(&slice.c) {
                    for (a, b) in row.iter_mut().zip(c) {
                        *a += b * moment;
                    }
                }
            }
        }
        let transverse = SmoothTransverse::new(&slices);
        Self { slices, stiffness_moments, density_moments, transverse }
    }

    /// Natural heights between which the plies lie.
    pub fn extent(&self) -> [f64; 2] {
        [self.slices.first().map_or(-1.0, |slice| slice.q[0]), self.slices.last().map_or(1.0, |slice| slice.q[1])]
    }
}
