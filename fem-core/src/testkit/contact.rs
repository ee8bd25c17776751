//! The contract of a contact law.

use crate::contracts::contact::{Branches, ContactForce, ContactHistory, ContactLaw};
use crate::words::energy::Energy;

/// Checks `law` on a path of loading, unloading, reloading and separation up to the indentation `largest` (m).
///
/// Demanded along the path: a force that is finite, never negative, continuous and never falling with α, none for α ≤ 0; a
/// tangent that agrees with differences on one side at least; a commit that changes neither the force nor the energy at
/// the indentation it takes, however often it is called; stored and dissipated energy not negative, nothing stored
/// where there is no force, dissipation that never falls; the sum of the two equal to ∫ F dα; branches as the law names
/// them; mean forces that lie between those at the ends, with the work of the law. NaN must come back as NaN, and a fresh history as the
/// first contact, whatever the law has seen before.
///
/// # Errors
/// The first violation, with the place on the path.
pub fn check_contact_law(law: &dyn ContactLaw, largest: f64) -> Result<(), String> {
    let turns = [0.1, -0.1, 0.5, 0.3, 0.4, 0.05, 0.7, -0.2, 0.3, 0.1, 0.75, 0.6, 1.0, -0.1, 0.9, -0.1, 0.2, 1.0, 0.0];
    let mut h = ContactHistory::default();
    if law.energy(&h, 0.0) != Energy::default() {
        return Err("energy before the first contact is not zero".into());
    }
    if !law.force(&h, f64::NAN).force.is_nan() {
        return Err("an indentation of NaN gives a force".into());
    }
    let fresh = |part: f64| law.force(&ContactHistory::default(), part * largest);
    let first = [0.3, 0.8].map(fresh);
    let mut walk = Walk { law, from: 0.0, work: 0.0, dissipated: 0.0 };
    for to in turns {
        let start = walk.from;
        for k in 1..=STEPS {
            let alpha = start + (largest * to - start) * f64::from(k) / f64::from(STEPS);
            walk.step(&mut h, alpha, largest).map_err(|why| {
                format!(
                    "{why}; at indentation {alpha:e} of the branch from {start:e} to {:e}, history {h:?}",
                    to * largest
                )
            })?;
        }
    }
    if [0.3, 0.8].map(fresh) != first {
        return Err("the law remembers outside the history: a fresh one does not give the first contact".into());
    }
    Ok(())
}

/// Steps of a branch.
const STEPS: u32 = 400;

struct Walk<'a> {
    law: &'a dyn ContactLaw,
    from: f64,
    work: f64,
    dissipated: f64,
}

impl Walk<'_> {
    fn step(&mut self, h: &mut ContactHistory, alpha: f64, largest: f64) -> Result<(), String> {
        let law = self.law;
        let here = law.force(h, alpha);
        let before = law.energy(h, alpha);
        check_force(law, h, alpha, here, largest)?;
        let highest = law.force(&ContactHistory::default(), largest).force;
        let jump = jump(|a| law.force(h, a).force, self.from, alpha);
        if jump > 1e-6 * highest {
            return Err(format!("the force jumps by {jump:e}"));
        }

        self.work += integral(|a| law.force(h, a).force, self.from, alpha);
        let begin = std::mem::replace(&mut self.from, alpha);
        let scale = largest * highest;
        let total = before.stored + before.dissipated;
        // The quadrature meets kinks of the force where a branch ends inside a step.
        if (total - self.work).abs() > 1e-6 * scale {
            return Err(format!("stored + dissipated = {total:e}, but the work is {:e}", self.work));
        }
        check_branches(law, h, alpha)?;
        for from in [begin, 0.0, alpha] {
            check_mean(law, h, from, alpha, scale)?;
        }
        for again in ["the", "a second"] {
            law.commit(h, alpha);
            let (force, energy) = (law.force(h, alpha), law.energy(h, alpha));
            if (force.force - here.force).abs() > 1e-9 * here.force {
                return Err(format!("{again} commit changes the force from {:e} to {:e}", here.force, force.force));
            }
            if (energy.stored + energy.dissipated - total).abs() > 1e-9 * scale {
                return Err(format!("{again} commit changes the energy from {before:?} to {energy:?}"));
            }
            if energy.stored < 0.0 || energy.dissipated < self.dissipated - 1e-12 * scale {
                return Err(format!("stored energy is negative or dissipated energy has fallen: {energy:?}"));
            }
            if here.force == 0.0 && energy.stored > 1e-12 * scale {
                return Err(format!("{:e} is stored without a force", energy.stored));
            }
            self.dissipated = energy.dissipated;
        }
        Ok(())
    }
}

/// The mean force lies between those at the ends, and its work is that of the law.
fn check_mean(law: &dyn ContactLaw, h: &ContactHistory, from: f64, to: f64, scale: f64) -> Result<(), String> {
    let [start, end] = [from, to].map(|alpha| law.force(h, alpha).force);
    let [before, after] = [from, to].map(|alpha| law.energy(h, alpha).total());
    let mean = law.mean_force(h, from, to).force;
    let work = mean * (to - from);
    if !(start.min(end)..=start.max(end)).contains(&mean) || (work - (after - before)).abs() > 1e-6 * scale {
        return Err(format!(
            "the mean force from {from:e} to {to:e} is {mean:e}, of work {work:e}: the forces at the ends are {start:e} and \
             {end:e}, the energy changes by {:e}",
            after - before
        ));
    }
    Ok(())
}

/// The force begins at `touch`; below the largest indentation it changes with a commit only if the law says `peak`.
fn check_branches(law: &dyn ContactLaw, h: &ContactHistory, alpha: f64) -> Result<(), String> {
    let Branches { touch, peak } = law.branches(h);
    let just_above = touch + 1e-3 * (alpha - touch);
    // An indentation may be so little beyond that no number lies between.
    if law.force(h, touch).force != 0.0 || (just_above > touch && !(law.force(h, just_above).force > 0.0)) {
        return Err(format!("the force does not begin at {touch:e}, where `branches` says it does"));
    }
    let mut after = *h;
    law.commit(&mut after, alpha);
    match (peak, law.branches(&after).peak) {
        // A march takes a contact that is loaded to be at its largest indentation or beyond it.
        (Some(before), Some(now)) if !(0.0..=1e-12 * alpha.abs()).contains(&(before.max(alpha) - now)) => {
            Err(format!("the largest indentation so far is {:e}, but `branches` says {now:e}", before.max(alpha)))
        }
        (Some(_), None) => Err("`branches` forgets the largest indentation".into()),
        (None, _)
            if (1..10)
                .any(|k| law.force(h, 0.1 * f64::from(k) * alpha) != law.force(&after, 0.1 * f64::from(k) * alpha)) =>
        {
            Err("a commit changes the force at smaller indentations, and `branches` names no peak".into())
        }
        _ => Ok(()),
    }
}

fn check_force(
    law: &dyn ContactLaw,
    h: &ContactHistory,
    alpha: f64,
    here: ContactForce,
    largest: f64,
) -> Result<(), String> {
    if !(here.force >= 0.0 && here.force.is_finite() && here.tangent.is_finite()) {
        return Err(format!("{here:?} is negative or not finite"));
    }
    if alpha <= 0.0 && here.force != 0.0 {
        return Err(format!("a force of {:e} without indentation", here.force));
    }
    if here.tangent < 0.0 {
        return Err(format!("the force falls as the indentation grows: {here:?}"));
    }
    let d = 1e-6 * largest;
    let [below, above] = [alpha - d, alpha + d].map(|a| law.force(h, a));
    let slopes = [(here.force - below.force) / d, (above.force - here.force) / d];
    // A power law's slope changes over d by at most about its second derivative.
    let curvature = (above.tangent - here.tangent).abs() + (here.tangent - below.tangent).abs();
    let noise = 1e-9 * here.force / d + 1e-4 * here.tangent.abs();
    if slopes.iter().all(|s| (s - here.tangent).abs() > curvature + noise) {
        return Err(format!("tangent {:e}, but differences give {slopes:?}", here.tangent));
    }
    Ok(())
}

/// What is left of the change of `f` from `a` to `b` in the steepest 2⁻⁴⁰ of the way.
fn jump(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let [mut at_a, mut at_b] = [f(a), f(b)];
    for _ in 0..40 {
        let middle = 0.5 * (a + b);
        let here = f(middle);
        if (here - at_a).abs() > (at_b - here).abs() {
            (b, at_b) = (middle, here);
        } else {
            (a, at_a) = (middle, here);
        }
    }
    (at_b - at_a).abs()
}

/// Three-point Gauss rule.
fn integral(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let x = 0.6_f64.sqrt() * half;
    half / 9.0 * (5.0 * f(middle - x) + 8.0 * f(middle) + 5.0 * f(middle + x))
}
