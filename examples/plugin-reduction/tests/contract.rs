//! What the reduction promises, on a chain of masses: dynamic flexibilities at rest and about its frequency.

use fem::dynamics::reduce::Reduced;
use fem_core::functional::Functional;
use fem_core::plugin::{Built, Dimension, Params, Plugin, Value};
use fem_core::reduction::Reduction;
use fem_core::structure::{SolveError, Structure};
use plugin_reduction::ShiftedKrylov;
use std::f64::consts::TAU;

/// Unit masses on unit springs, the first one held to the ground.
#[derive(Debug)]
struct Chain(usize);

impl Structure for Chain {
    fn ndof(&self) -> usize {
        self.0
    }

    fn add_stiffness(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        for (x, y) in x.chunks_exact(self.0).zip(y.chunks_exact_mut(self.0)) {
            for i in 0..self.0 {
                let below = if i == 0 { 0.0 } else { x[i - 1] };
                y[i] += scale * (x[i] - below);
                if i + 1 < self.0 {
                    y[i] += scale * (x[i] - x[i + 1]);
                }
            }
        }
    }

    fn add_mass(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        x.iter().zip(y).for_each(|(x, y)| *y += scale * x);
    }

    /// Gauss's elimination of a tridiagonal matrix.
    fn solve_shifted(&mut self, shift: f64, x: &mut [f64], _: usize) -> Result<(), SolveError> {
        for x in x.chunks_exact_mut(self.0) {
            let diagonal = |i: usize| shift + if i + 1 < self.0 { 2.0 } else { 1.0 };
            let mut pivots = vec![diagonal(0)];
            for i in 1..self.0 {
                x[i] += x[i - 1] / pivots[i - 1];
                pivots.push(diagonal(i) - 1.0 / pivots[i - 1]);
            }
            let mut above = 0.0;
            for (x, pivot) in x.iter_mut().zip(&pivots).rev() {
                *x = (*x + above) / pivot;
                above = *x;
            }
        }
        Ok(())
    }

    fn solve_mass(&mut self, _: &mut [f64]) -> Result<(), SolveError> {
        Ok(())
    }
}

const ABOUT: f64 = 0.1;

fn reduction(vectors: f64) -> Box<dyn Reduction> {
    let params = Params::default()
        .with("vectors", Value::Number(vectors))
        .with("about", Value::Quantity(ABOUT, Dimension::FREQUENCY));
    match ShiftedKrylov::build(&params) {
        Ok(Built::Reduction(reduction)) => reduction,
        other => panic!("{other:?}"),
    }
}

/// pᵀ (K + s² M)⁻¹ p at s = 2π `frequency`.
fn flexibility(structure: &mut dyn Structure, p: &[f64], frequency: f64) -> f64 {
    let mut x = p.to_vec();
    structure.solve_shifted((TAU * frequency).powi(2), &mut x, 1).unwrap();
    p.iter().zip(x).map(|(p, x)| p * x).sum()
}

/// Relative error of the reduced chain's dynamic flexibility under a load on two masses, at each frequency.
fn errors<const N: usize>(vectors: f64, frequencies: [f64; N]) -> [f64; N] {
    let mut chain = Chain(60);
    let contact = Functional(vec![(30, 0.25), (31, 0.75)]);
    let basis = reduction(vectors).basis(&mut chain, std::slice::from_ref(&contact), &[]).unwrap();
    let mut reduced = Reduced::project(&chain, &basis).unwrap();
    let mut p = vec![0.0; 60];
    contact.add_to(1.0, &mut p);
    let q = reduced.restrict(&contact);
    frequencies.map(|f| (flexibility(&mut reduced.modal, &q, f) / flexibility(&mut chain, &p, f) - 1.0).abs())
}

// ANCHOR: contract
#[test]
fn flexibilities_are_exact_at_rest_and_about_the_frequency() {
    let [rest, here, near, far] = errors(3.0, [0.0, ABOUT, 1.1 * ABOUT, 3.0 * ABOUT]);
    assert!(rest < 1e-10 && here < 1e-10, "{rest:e} {here:e}");
    assert!(near < 1e-3 && far > 10.0 * near, "{near:e} {far:e}");
}

#[test]
fn elsewhere_they_converge() {
    let [rest, few, more] =
        [1.0, 4.0, 12.0].map(|vectors| errors(vectors, [0.01, 0.3]).into_iter().fold(0.0, f64::max));
    assert!(rest > 0.1 && few < 0.1 && more < 1e-2 * few, "{rest:e} {few:e} {more:e}");
}

#[test]
fn no_more_vectors_are_made_than_there_are_unknowns() {
    let mut chain = Chain(60);
    let basis = reduction(100.0).basis(&mut chain, &[Functional::dof(59)], &[]).unwrap();
    assert!(basis.len() <= 60 * 60 && basis.iter().all(|x| x.is_finite()), "{}", basis.len());
}
// ANCHOR_END: contract
