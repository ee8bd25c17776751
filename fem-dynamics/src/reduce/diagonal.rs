//! A structure in its modal coordinates.

use fem_core::damping::{Damping, Rayleigh};
use fem_core::structure::{SolveError, Structure};
use fem_core::vectorised::vectorised;

/// A structure in the coordinates in which its K and M are diagonal.
///
/// A mode with inertia is scaled to unit mass, so its stiffness is ω²; a mode without (from a singular M) to unit
/// stiffness and no mass. The free motions of the structure come first, without stiffness.
#[derive(Debug, Clone, PartialEq)]
pub struct Modal {
    pub(super) stiffness: Vec<f64>,
    pub(super) mass: Vec<f64>,
    /// Empty without damping.
    pub(super) damping: Vec<f64>,
}

impl Modal {
    /// Circular frequencies, rad/s, ascending; infinite for modes without inertia.
    pub fn frequencies(&self) -> impl Iterator<Item = f64> + '_ {
        self.stiffness.iter().zip(&self.mass).map(|(k, m)| if *m > 0.0 { k.sqrt() } else { f64::INFINITY })
    }

    /// The lowest of the frequencies that are not zero.
    pub fn lowest_frequency(&self) -> Option<f64> {
        self.frequencies().find(|omega| *omega > 0.0)
    }

    /// Deformation of each mode under a unit force on it: one over its stiffness, none of a free motion.
    pub fn compliances(&self) -> impl Iterator<Item = f64> + '_ {
        self.stiffness.iter().map(|k| if *k > 0.0 { 1.0 / k } else { 0.0 })
    }

    /// Modal stiffnesses: ω², and 1 of modes without inertia.
    pub fn stiffnesses(&self) -> &[f64] {
        &self.stiffness
    }

    /// Modal masses: 1, and 0 of modes without inertia.
    pub fn masses(&self) -> &[f64] {
        &self.mass
    }

    /// Modal dampings; none of a structure without.
    pub fn dampings(&self) -> &[f64] {
        &self.damping
    }

    /// Takes the inertia of all modes away; they keep their stiffness.
    pub fn without_inertia(&mut self) {
        self.mass.fill(0.0);
    }

    /// Takes a share of its stiffness from each mode, as from a plate that is softer.
    pub fn soften(&mut self, shares: &[f64]) {
        self.stiffness.iter_mut().zip(shares).for_each(|(k, share)| *k *= 1.0 - share);
    }

    /// Gives the structure viscous damping, which leaves its modes as they are.
    pub fn damp(&mut self, damping: Damping) {
        let each = self.stiffness.iter().zip(&self.mass);
        self.damping = match damping {
            Damping::Rayleigh(Rayleigh { mass, stiffness }) => each.map(|(k, m)| mass * m + stiffness * k).collect(),
            Damping::Ratio(ratio) => each.map(|(k, m)| 2.0 * ratio * (k * m).sqrt()).collect(),
        };
    }
}

impl Structure for Modal {
    fn ndof(&self) -> usize {
        self.stiffness.len()
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        let n = self.stiffness.len();
        for (y, x) in y.chunks_exact_mut(n).zip(x.chunks_exact(n)) {
            vectorised(|| y.iter_mut().zip(&self.stiffness).zip(x).for_each(|((y, k), x)| *y += scale * k * x));
        }
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        let n = self.mass.len();
        for (y, x) in y.chunks_exact_mut(n).zip(x.chunks_exact(n)) {
            vectorised(|| y.iter_mut().zip(&self.mass).zip(x).for_each(|((y, m), x)| *y += scale * m * x));
        }
    }

    fn add_damping(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        y.iter_mut().zip(&self.damping).zip(x).for_each(|((y, c), x)| *y += scale * c * x);
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        for column in x.chunks_exact_mut(self.stiffness.len()).take(columns) {
            vectorised(|| {
                for ((x, k), m) in column.iter_mut().zip(&self.stiffness).zip(&self.mass) {
                    let stiffness = k + shift * m;
                    *x = if stiffness == 0.0 { 0.0 } else { *x / stiffness };
                }
            });
        }
        Ok(())
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        for (i, (x, m)) in x.iter_mut().zip(&self.mass).enumerate() {
            if *m == 0.0 {
                return Err(SolveError::NoInertia { unknown: format!("mode {} of the reduced structure", i + 1) });
            }
            *x /= m;
        }
        Ok(())
    }

    fn solve_damped(&mut self, cm: f64, cc: f64, x: &mut [f64], columns: usize) -> Result<(), SolveError> {
        if self.damping.is_empty() {
            return self.solve_shifted(cm, x, columns);
        }
        for column in x.chunks_exact_mut(self.stiffness.len()).take(columns) {
            let matrices = self.stiffness.iter().zip(&self.mass).zip(&self.damping);
            column.iter_mut().zip(matrices).for_each(|(x, ((k, m), c))| *x /= k + cm * m + cc * c);
        }
        Ok(())
    }

    fn solve_damped_mass(&mut self, cc: f64, x: &mut [f64]) -> Result<(), SolveError> {
        self.solve_mass(x)?;
        let matrices = self.mass.iter().zip(&self.damping);
        x.iter_mut().zip(matrices).for_each(|(x, (m, c))| *x /= 1.0 + cc * c / m);
        Ok(())
    }

    fn damping_rate(&self, _: f64) -> f64 {
        self.damping.iter().zip(&self.mass).map(|(c, m)| c / m).fold(0.0, f64::max)
    }

    fn highest_frequency(&mut self) -> Result<f64, SolveError> {
        Ok(self.frequencies().fold(0.0, f64::max))
    }
}
