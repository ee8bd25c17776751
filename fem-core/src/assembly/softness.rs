//! How much softer a structure is for what its supports leave free between nodes.

use crate::contracts::structure::{SolveError, Structure};
use crate::words::functional::Functional;

/// Solves after which the share is known to well under a tenth of it.
const MOST_SOLVES: usize = 12;
const ENOUGH: f64 = 0.02;

/// Share of the work of `load` on its displacements `u` = K⁻¹ f that would be missing if `free`, sums of unknowns, were zero: at
/// least that, to about 2 % of it. Shares below `least` are told apart from it without a solve where a bound says so: none then.
///
/// The sums must be orthogonal ([`orthogonalise`](crate::words::functional::orthogonalise)). With the columns l of L, the motions g = Lᵀ u cost λᵀ g, (Lᵀ K⁻¹ L) λ = g; conjugate gradients, whose preconditioner
/// L⁺ᵀ K L⁺ holds all but the motions themselves, approach it from below. What K takes to undo g alone is the bound.
///
/// # Errors
/// As [`Structure::solve_shifted`].
pub fn softness(
    structure: &mut dyn Structure,
    free: &[Functional],
    (load, u): (&[f64], &[f64]),
    least: f64,
) -> Result<Option<f64>, SolveError> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let work = dot(load, u);
    let sizes: Vec<f64> = free.iter().map(|l| l.0.iter().map(|(_, w)| w * w).sum()).collect();
    // L⁺ of orthogonal sums.
    let undo = |structure: &dyn Structure, g: &[f64]| -> Vec<f64> {
        let (mut x, mut f) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        free.iter().zip(&sizes).zip(g).for_each(|((l, size), g)| l.add_to(g / size, &mut x));
        structure.add_stiffness(1.0, &x, &mut f);
        free.iter().zip(&sizes).map(|(l, size)| l.of(&f) / size).collect()
    };
    let g: Vec<f64> = free.iter().map(|l| l.of(u)).collect();
    let mut z = undo(structure, &g);
    let mut rz = dot(&g, &z);
    if !(work > 0.0 && rz > least * work) {
        return Ok(None);
    }
    let (mut residual, mut direction, mut cost) = (g.clone(), z.clone(), 0.0);
    for _ in 0..MOST_SOLVES {
        let mut x = vec![0.0; u.len()];
        free.iter().zip(&direction).for_each(|(l, d)| l.add_to(*d, &mut x));
        structure.solve_shifted(0.0, &mut x, 1)?;
        let image: Vec<f64> = free.iter().map(|l| l.of(&x)).collect();
        let step = rz / dot(&direction, &image);
        let gained = step * rz;
        cost += gained;
        residual.iter_mut().zip(&image).for_each(|(r, a)| *r -= step * a);
        if !(gained > ENOUGH * cost) {
            break;
        }
        z = undo(structure, &residual);
        let next = dot(&residual, &z);
        direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + next / rz * *d);
        rz = next;
    }
    Ok(Some(cost / work).filter(|share| *share > least))
}
