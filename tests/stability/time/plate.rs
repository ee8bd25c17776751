//! A plate whose modes are known.

use fem::core::structure::{SolveError, Structure};
use std::f64::consts::PI;

/// Units in which a plate is computed: those of mass, length and time, in SI units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    pub(super) mass: f64,
    pub(super) length: f64,
    pub(super) time: f64,
}

impl Units {
    pub(super) const SI: Self = Self { mass: 1.0, length: 1.0, time: 1.0 };

    pub(super) fn stiffness(self) -> f64 {
        self.mass / self.time.powi(2)
    }
}

/// Navier's simply supported square plate in its lowest modes: deflection Σ q sin(iπx/a) sin(jπy/a).
#[derive(Debug, Clone)]
pub(super) struct Navier {
    waves: Vec<[f64; 2]>,
    stiffness: Vec<f64>,
    mass: f64,
}

/// Edge, m; flexural rigidity, N m; mass, kg: about 16 plies of carbon fibre.
const EDGE: f64 = 0.05;
const RIGIDITY: f64 = 43.0;
pub(super) const MASS: f64 = 8.3e-3;

impl Navier {
    /// `count` waves along each edge.
    pub(super) fn new(count: u32, units: Units) -> Self {
        let waves = |of: u32| (1..=count).map(move |i| [f64::from(of), f64::from(i)]);
        let waves: Vec<[f64; 2]> = (1..=count).flat_map(waves).collect();
        let stiffness =
            |[i, j]: &[f64; 2]| 0.25 * RIGIDITY * (PI * PI * (i * i + j * j) / EDGE).powi(2) / units.stiffness();
        Self { stiffness: waves.iter().map(stiffness).collect(), waves, mass: 0.25 * MASS / units.mass }
    }

    /// One mode that nothing moves.
    pub(super) fn ground() -> Self {
        Self { waves: vec![[1.0, 1.0]], stiffness: vec![1e15], mass: MASS }
    }

    /// The deflection at a place, in edges.
    pub(super) fn load(&self, [x, y]: [f64; 2]) -> Vec<(usize, f64)> {
        let at = |[i, j]: &[f64; 2]| (PI * i * x).sin() * (PI * j * y).sin();
        self.waves.iter().map(at).enumerate().collect()
    }

    /// Static deflection of the middle per force.
    pub(super) fn flexibility(&self) -> f64 {
        self.load([0.5, 0.5]).iter().zip(&self.stiffness).map(|((_, p), k)| p * p / k).sum()
    }

    /// Lowest circular frequency.
    pub(super) fn lowest(&self) -> f64 {
        (self.stiffness[0] / self.mass).sqrt()
    }

    /// Largest modal stiffness.
    pub(super) fn stiffest(&self) -> f64 {
        self.stiffness.iter().fold(0.0, |a, b| a.max(*b))
    }

    /// Highest circular frequency.
    pub(super) fn highest(&self) -> f64 {
        (self.stiffest() / self.mass).sqrt()
    }
}

impl Structure for Navier {
    fn ndof(&self) -> usize {
        self.waves.len()
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        y.iter_mut().zip(&self.stiffness).zip(x).for_each(|((y, k), x)| *y += scale * k * x);
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        y.iter_mut().zip(x).for_each(|(y, x)| *y += scale * self.mass * x);
    }

    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], _: usize) -> Result<(), SolveError> {
        for column in x.chunks_exact_mut(self.waves.len()) {
            column.iter_mut().zip(&self.stiffness).for_each(|(x, k)| *x /= k + shift * self.mass);
        }
        Ok(())
    }

    fn solve_mass(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        x.iter_mut().for_each(|x| *x /= self.mass);
        Ok(())
    }

    fn highest_frequency(&mut self) -> Result<f64, SolveError> {
        Ok(self.highest())
    }
}
