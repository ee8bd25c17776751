//! The error of the reduction, from the full plate.

use super::super::prepare::Full;
use super::companion::{Companion, Differences, Instant, Pace};
use fem_core::functional::Functional;
use fem_core::structure::Structure;
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::{Modal, Reduced};

/// Instants that the full plate is asked about. A single one may find a vector that does nothing.
const INSTANTS: usize = 3;

/// Steps of this fraction of a span, taken modulo the span, fall evenly and never into the rhythm of a vibration.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Error of the flexibility up to which a static response counts as held.
const HELD: f64 = 1e-6;

/// What a reduction leaves out, relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReductionAccuracy {
    /// Largest error of the static deflection under a force at a contact.
    pub flexibility: f64,
    /// What is left in the full model.
    pub residual: Option<ReductionResidual>,
    /// What changes as what is left joins the vectors; where the residual says more of the force, the geometric mean of both, and all other
    /// results as much more.
    pub response: Option<Differences>,
}

/// The residual of the reduced solution u = Φ q in the full model, at some instants of the contact.
///
/// ```text
/// r = Σ F w − K Φ q − M Φ q̈        q̈ from the reduced equations, so that Φᵀ r = 0
/// ε = rᵀ K⁻¹ r                      twice the strain energy of K⁻¹ r, what is missing if it follows at rest
/// ```
///
/// K⁻¹ r does not move the contacts of a reduction that holds their static responses K⁻¹ w, as all do but `irs`: wᵀ K⁻¹ r is
/// then a sum of products Φᵀ r. So its energy is measured, the quasi-static part of what is left out. What vibrates with that
/// energy exchanges it with the contact, a spring of stiffness k: (δF)² ≈ k ε.
///
/// Against 320 Ritz vectors of the exact space (three examples with large and small masses; `ritz`, `craig-bampton`, `modal`)
/// the estimate of the force was 0.2 to 5 times its error, and 0.9 to 10 times with `guyan`; the error in energy was 0.03 to 1.6
/// times that of the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReductionResidual {
    /// Largest of √ε over the largest √(uᵀ K u): error of the displacements in the norm of the energy.
    pub energy: f64,
    /// Root of the sum of k ε over that of F², an estimate of the error of the contact force; nothing where the static
    /// response is not held: it would be up to 40 times too large.
    pub force: Option<f64>,
}

/// A richer model: marched at a pace, to be compared with the march of the model itself.
pub(super) struct Richer<'a> {
    /// Makes the plate of vectors a system.
    pub(super) couple: &'a dyn Fn(Reduced) -> (ImpactSystem, Modal),
    pub(super) pace: &'a Pace,
    pub(super) base: &'a Companion,
}

impl Richer<'_> {
    /// Marches the plate of the vectors of `reduced` and `more`.
    fn march(&self, full: &Full, reduced: &Reduced, more: &[f64]) -> Option<Differences> {
        let (mut system, modal) = (self.couple)(reduced.with(&full.structure, more).ok()?);
        self.base.against(&self.pace.march(&mut system, &modal, |_| ())?)
    }
}

/// Asks the full plate; nothing where it gives no finite answer.
pub(super) fn estimate(
    mut full: Full,
    reduced: &Reduced,
    instants: &[Instant],
    richer: Option<Richer<'_>>,
) -> Option<ReductionAccuracy> {
    let chosen = choose_evenly(instants, INSTANTS);
    let n = full.structure.ndof();
    let restrict = |w| reduced.restrict(w);
    let modes: Vec<Vec<f64>> = full.contacts.iter().map(restrict).collect();
    let lifted: Vec<Vec<f64>> = full.springs.iter().map(|spring| restrict(&spring.at)).collect();
    // w, then Σ F w − M Φ q̈ of each instant; K⁻¹ of the latter is u + K⁻¹ r.
    let mut loads = vec![0.0; n * full.contacts.len()];
    for (w, load) in full.contacts.iter().zip(loads.chunks_exact_mut(n)) {
        w.add_to(1.0, load);
    }
    for instant in &chosen {
        loads.extend(inertial_load(&full, reduced, (&modes, &lifted), instant));
    }
    let mut solved = loads.clone();
    full.structure.solve_shifted(0.0, &mut solved, full.contacts.len() + chosen.len()).ok()?;

    let (at_rest, moving) = solved.split_at_mut(n * full.contacts.len());
    let flexibility = flexibility(&full.contacts, reduced, &modes, at_rest);
    let (mut left, mut energy, mut change, mut size) = (0.0_f64, 0.0_f64, 0.0, 0.0);
    let mut u = vec![0.0; n];
    for ((instant, load), solved) in
        chosen.iter().zip(loads[at_rest.len()..].chunks_exact(n)).zip(moving.chunks_exact_mut(n))
    {
        reduced.expand(&instant.q, &mut u);
        // What is left alone: beside the modes u + K⁻¹ r would be lost in rounding.
        solved.iter_mut().zip(&u).for_each(|(x, u)| *x -= u);
        // rᵀ K⁻¹ r = (load − K u)ᵀ K⁻¹ r, of which uᵀ r = 0.
        let epsilon: f64 = load.iter().zip(&*solved).map(|(f, x)| f * x).sum();
        left = left.max(epsilon);
        let held: f64 = reduced.modal.stiffnesses().iter().zip(&instant.q).map(|(k, q)| k * q * q).sum();
        let pulled = full.springs.iter().zip(&instant.reliefs).map(|(spring, force)| force * force / spring.stiffness);
        energy = energy.max(held - pulled.sum::<f64>());
        change += instant.stiffness * epsilon.max(0.0);
        size += instant.forces.iter().sum::<f64>().powi(2);
    }
    let (energy, force) = ((left / energy).sqrt(), (change / size).sqrt());
    let force = Some(force).filter(|force| force.is_finite() && flexibility < HELD);
    // There is no energy without an instant in contact.
    let residual = energy.is_finite().then_some(ReductionResidual { energy, force });
    let response = richer.filter(|_| !chosen.is_empty()).and_then(|richer| richer.march(&full, reduced, moving));
    // What one has missed by chance the other sees; springs that let go are in the march alone.
    let response = response.map(|response| match force {
        Some(force) if full.springs.is_empty() && response.force > 0.0 && response.force < force => {
            response.times((force / response.force).sqrt())
        }
        _ => response,
    });
    flexibility.is_finite().then_some(ReductionAccuracy { flexibility, residual, response })
}

/// Σ F w − M Φ q̈, with the forces that relieve springs of their pull.
fn inertial_load(
    full: &Full,
    reduced: &Reduced,
    (modes, lifted): (&[Vec<f64>], &[Vec<f64>]),
    instant: &Instant,
) -> Vec<f64> {
    let acceleration = |(j, (omega, q)): (usize, (f64, &f64))| {
        let forces = modes.iter().zip(&instant.forces).chain(lifted.iter().zip(&instant.reliefs));
        let force: f64 = forces.map(|(mode, force)| mode[j] * force).sum();
        if omega.is_finite() { force - omega * omega * q } else { 0.0 }
    };
    let accelerations: Vec<f64> = reduced.modal.frequencies().zip(&instant.q).enumerate().map(acceleration).collect();
    let n = full.structure.ndof();
    let (mut field, mut load) = (vec![0.0; n], vec![0.0; n]);
    reduced.expand(&accelerations, &mut field);
    full.structure.add_mass(-1.0, &field, &mut load);
    let springs = full.springs.iter().map(|spring| &spring.at).zip(&instant.reliefs);
    for (w, force) in full.contacts.iter().zip(&instant.forces).chain(springs) {
        w.add_to(*force, &mut load);
    }
    load
}

/// Largest relative error of the flexibilities wᵀ K⁻¹ w, with `solved` = K⁻¹ w of the full plate.
fn flexibility(contacts: &[Functional], reduced: &Reduced, modes: &[Vec<f64>], solved: &[f64]) -> f64 {
    let each = contacts.iter().zip(modes).zip(solved.chunks_exact(solved.len() / contacts.len()));
    let error = |((w, mode), solved): ((&Functional, &Vec<f64>), &[f64])| {
        let of_reduced: f64 = reduced.modal.compliances().zip(mode).map(|(c, m)| m * m * c).sum();
        (of_reduced / w.of(solved) - 1.0).abs()
    };
    each.map(error).fold(0.0, f64::max)
}

/// At most `count` of some, evenly but without rhythm.
fn choose_evenly<T>(all: &[T], count: usize) -> Vec<&T> {
    let number = |i: usize| (((i as f64 + 0.5) * GOLDEN).fract() * all.len() as f64) as usize;
    (0..count.min(all.len())).filter_map(|i| all.get(number(i))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_lie_all_over_the_contact() {
        let all: Vec<usize> = (0..60).collect();
        let mut chosen: Vec<usize> = choose_evenly(&all, INSTANTS).into_iter().copied().collect();
        chosen.sort_unstable();
        assert!(chosen.len() == INSTANTS && chosen[0] < 20 && chosen[INSTANTS - 1] >= 40, "{chosen:?}");
        let gaps: Vec<usize> = chosen.windows(2).map(|w| w[1] - w[0]).collect();
        assert!(gaps.iter().all(|g| *g >= 5) && gaps.iter().any(|g| *g != gaps[0]), "{gaps:?}");
        assert_eq!(choose_evenly(&all[..2], INSTANTS).len(), 2);
        assert!(choose_evenly::<usize>(&[], INSTANTS).is_empty());
    }
}
