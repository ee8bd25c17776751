//! The factors on a preload at which a structure buckles.

use crate::lanczos::Lanczos;
use crate::modes::{BLOCK, rough};
use fem_core::structure::{SolveError, Structure};

/// Load factors and shapes of buckling, by the size of the factors.
#[derive(Debug, Clone, PartialEq)]
pub struct Buckling {
    /// Factors λ on the preload; negative where the opposite load buckles the structure.
    pub factors: Vec<f64>,
    /// Shapes, `ndof × factors`, column-major, whose largest entry is 1.
    pub shapes: Vec<f64>,
}

/// The `count` load factors of (K + λ G) φ = 0 nearest to zero, of either sign, K the stiffness of `structure` and G the geometric
/// stiffness of the preload, which `geometric(scale, x, y)` applies: y ← y + scale · G x. Fewer where there are no more.
///
/// Block Lanczos on −K⁻¹ G K⁻¹ in the metric of K, whose eigenvalues are 1/λ: G need not be definite.
///
/// # Errors
/// A structure that is not held, or no convergence in a space of 5 `count` + 80 vectors.
pub fn factors(
    structure: &mut dyn Structure,
    geometric: impl Fn(f64, &[f64], &mut [f64]),
    count: usize,
) -> Result<Buckling, SolveError> {
    let n = structure.ndof();
    let start: Vec<f64> = (0..BLOCK).flat_map(|k| rough(n, k)).collect();
    let inverse = |structure: &mut dyn Structure, x: &mut [f64]| {
        let columns = x.len() / n.max(1);
        structure.solve_shifted(0.0, x, columns)?;
        let bent = x.to_vec();
        x.fill(0.0);
        geometric(-1.0, &bent, x);
        structure.solve_shifted(0.0, x, columns)
    };
    let (theta, mut shapes) =
        Lanczos::excited(&mut Energy(structure), inverse, &start)?.largest(count, |theta| theta.abs())?;
    for shape in shapes.chunks_exact_mut(n.max(1)) {
        let largest = shape.iter().fold(0.0_f64, |a, b| if b.abs() > a.abs() { *b } else { a });
        shape.iter_mut().for_each(|x| *x /= largest);
    }
    Ok(Buckling { factors: theta.iter().map(|theta| theta.recip()).collect(), shapes })
}

/// A structure whose metric is that of its strain energy: K stands for M.
#[derive(Debug)]
struct Energy<'a>(&'a mut dyn Structure);

impl Structure for Energy<'_> {
    fn ndof(&self) -> usize {
        self.0.ndof()
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.0.add_stiffness(scale, x, y);
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        self.0.add_stiffness(scale, x, y);
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        self.0.solve_shifted(shift, x, columns)
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        self.0.solve_shifted(0.0, x, 1)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// Springs of stiffness k, each alone.
    #[derive(Debug)]
    struct Springs(Vec<f64>);

    impl Structure for Springs {
        fn ndof(&self) -> usize {
            self.0.len()
        }

        fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
            x.iter().zip(y).enumerate().for_each(|(i, (x, y))| *y += scale * self.0[i % self.0.len()] * x);
        }

        fn add_mass(&self, _: f64, _: &[f64], _: &mut [f64]) {}

        fn solve_shifted(&mut self, _: f64, x: &mut [f64], _: usize) -> Result<(), SolveError> {
            x.iter_mut().enumerate().for_each(|(i, x)| *x /= self.0[i % self.0.len()]);
            Ok(())
        }

        fn solve_mass(&mut self, _: &mut [f64]) -> Result<(), SolveError> {
            Ok(())
        }
    }

    #[test]
    fn factors_have_either_sign() {
        let mut springs = Springs((1..=40).map(f64::from).collect());
        // Of the unknowns 0, 1, 2 …: factors 1/g.
        let g = |i: usize| [-2.0, 3.0, -0.5, 0.0, 0.25][i % 5] / (1.0 + (i / 5) as f64);
        let geometric = |scale: f64, x: &[f64], y: &mut [f64]| {
            for (i, (x, y)) in x.iter().zip(y).enumerate() {
                *y += scale * g(i % 40) * (1.0 + (i % 40) as f64) * x;
            }
        };
        let found = factors(&mut springs, geometric, 4).unwrap();
        for (factor, expected) in found.factors.iter().zip([-1.0 / 3.0, 0.5, -2.0 / 3.0, 1.0]) {
            assert!((factor - expected).abs() < 1e-9, "{:?}", found.factors);
        }
        let first = &found.shapes[..40];
        assert!((first[1] - 1.0).abs() < 1e-9 && first.iter().map(|x| x.abs()).sum::<f64>() < 1.0 + 1e-6);
    }
}
