//! Contact forces of an implicit step, from how the structure responds to each.

use super::tip::{Remembering, Tip, Yielding};
use super::{Impactor, add, value};
use crate::lifting::Lifting;
use fem_core::contact::{ContactForce, ContactHistory};
use fem_core::structure::SolveError;
use fem_core::time::{Histories, StepError};
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;
use std::ops::Range;

/// Change of an indentation by its own force, relative, at which several contacts count as solved: ten times the
/// tolerance of one.
const TOLERANCE: f64 = 1e-14;
/// The same of the rings of a tip, whose forces are known less well: 16 of them share a place.
const TIP_TOLERANCE: f64 = 1e-11;
/// Sweeps over several contacts before they count as unsolvable.
const MOST_SWEEPS: usize = 20_000;

/// Evaluations of a contact law until Newton's method counts as running in circles, as it may about a kink, and every second
/// trial halves the bracket; and at most.
const PATIENCE: u64 = 20;
const MOST_CALLS: u64 = 200;

/// What strikes a structure: impactors, and the tips of those that have one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Strikers<'a> {
    pub(super) impactors: &'a [Impactor],
    pub(super) tips: &'a [Option<Tip>],
}

impl<'a> Strikers<'a> {
    pub(super) fn tip(self, i: usize) -> Option<&'a Tip> {
        self.tips.get(i).and_then(Option::as_ref)
    }

    /// Where the rings of impactor `i` are in the histories of all beds.
    pub(super) fn bed(self, i: usize) -> Range<usize> {
        let count = |i: usize| self.tip(i).map_or(0, Tip::count);
        let first = (0..i).map(count).sum();
        first..first + count(i)
    }

    /// The law of impactor `i` with what it remembers.
    pub(super) fn remembering(self, i: usize, h: &'a Histories) -> Remembering<'a> {
        Remembering { law: &*self.impactors[i].law, whole: &h.contacts[i], bed: &h.beds[self.bed(i)] }
    }

    /// Loads of all contacts, one of an impactor or one of each ring of its tip.
    fn loads(self) -> impl Iterator<Item = (usize, &'a Vec<(usize, f64)>)> {
        self.impactors.iter().enumerate().flat_map(move |(i, impactor)| {
            let tip = self.tip(i);
            let own = tip.is_none().then_some(&impactor.load);
            own.into_iter().chain(tip.into_iter().flat_map(Tip::loads)).map(move |load| (i, load))
        })
    }

    /// Numbers of the loads of impactor `i`.
    fn of(self, i: usize) -> Range<usize> {
        let count = |i: usize| self.tip(i).map_or(1, Tip::count);
        let first = (0..i).map(count).sum();
        first..first + count(i)
    }
}

/// Responses X = (K + cm M + cc C)⁻¹ p to the contact loads, for one (cm, cc); of a structure that is not linear, to its tangent.
#[derive(Debug, Default)]
pub(super) struct Influence {
    pub(super) cm: f64,
    pub(super) cc: f64,
    /// That of the structure.
    pub(super) revision: u64,
    pub(super) x: Vec<f64>,
    /// Approach at load i per force of load j, pᵢᵀ Xⱼ and 1/(cm m) where they are of one impactor, by rows.
    approach: Vec<f64>,
    /// Approach at each load without forces.
    free: Vec<f64>,
    forces: Vec<f64>,
    /// Springs that only push, their deflections without forces, and those by a unit force of each load.
    pub(super) lifting: Lifting,
    lifts: Vec<f64>,
    across: Vec<Vec<f64>>,
}

impl Influence {
    /// The responses for `cm` and `cc`, found by `solve`, of a structure of `n` unknowns.
    pub(super) fn set(
        &mut self,
        cm: f64,
        cc: f64,
        n: usize,
        strikers: Strikers<'_>,
        mut solve: impl FnMut(&mut [f64], usize) -> Result<(), SolveError>,
    ) -> Result<(), StepError> {
        let count = strikers.loads().count();
        let Self { x, approach, free, forces, lifting, lifts, across, .. } = self;
        x.clear();
        x.resize(n * count, 0.0);
        for ((_, load), column) in strikers.loads().zip(x.chunks_exact_mut(n)) {
            add(load, 1.0, column);
        }
        solve(x, count).map_err(StepError::Factorisation)?;
        approach.clear();
        for (i, load) in strikers.loads() {
            let own = |j| if i == j { 1.0 / (cm * strikers.impactors[i].mass) } else { 0.0 };
            approach.extend(strikers.loads().zip(x.chunks_exact(n)).map(|((j, _), x)| value(load, x) + own(j)));
        }
        free.resize(count, 0.0);
        forces.resize(count, 0.0);
        lifts.resize(lifting.springs().len(), 0.0);
        lifting.set(n, &mut solve).map_err(StepError::Factorisation)?;
        *across = x.chunks_exact(n).map(|x| lifting.deflections(x)).collect();
        (self.cm, self.cc) = (cm, cc);
        Ok(())
    }

    /// Forgets the approaches without forces; forces are means over a step that begins with the displacements `start`, if these are given.
    pub(super) fn begin(&mut self, start: Option<&[f64]>) {
        self.free.fill(0.0);
        self.lifts.fill(0.0);
        self.lifting.begin(start);
    }

    /// Adds what the displacements `x` add to the approaches without forces.
    pub(super) fn set_approaches(&mut self, strikers: Strikers<'_>, x: &[f64]) {
        let n = x.len() - strikers.impactors.len();
        for ((i, load), free) in strikers.loads().zip(&mut self.free) {
            *free += x[n + i] - value(load, x);
        }
        if !self.lifting.is_empty() {
            self.lifts.iter_mut().zip(self.lifting.deflections(x)).for_each(|(lift, w)| *lift += w);
        }
    }

    /// Work of the contact forces, and of those that relieve springs, along `d`.
    pub(super) fn work(&self, strikers: Strikers<'_>, d: &[f64]) -> f64 {
        let contacts: f64 = strikers.loads().zip(&self.forces).map(|((_, load), force)| force * value(load, d)).sum();
        contacts + along(&self.lifting.deflections(d), self.lifting.forces())
    }

    /// Finds the contact forces for the response `d` without contact, and adds that to each, F (X, −1/(cm m)), and that to the relief of
    /// springs, found by `solve` as in [`Self::set`]; returns the evaluations of contact laws. Forces are means over a step that begins
    /// with the displacements `start`, if these are given; of a tip they are those in its middle.
    pub(super) fn touch(
        &mut self,
        strikers: Strikers<'_>,
        t: f64,
        h: &Histories,
        start: Option<&[f64]>,
        d: &mut [f64],
        solve: impl FnOnce(&mut [f64], usize) -> Result<(), SolveError>,
    ) -> Result<u64, StepError> {
        self.lifting.expect(&self.lifts);
        self.set_approaches(strikers, d);
        let calls = self.balance(strikers, t, h, start)?;
        let n = d.len() - strikers.impactors.len();
        for (((i, _), force), x) in strikers.loads().zip(&self.forces).zip(self.x.chunks_exact(n)) {
            if *force != 0.0 {
                for (d, x) in d.iter_mut().zip(x) {
                    *d += force * x;
                }
                d[n + i] -= force / (self.cm * strikers.impactors[i].mass);
            }
        }
        if self.lifting.is_empty() {
            return Ok(calls);
        }
        let lifts = pressed(&self.lifts, &self.across, &self.forces);
        if !self.lifting.relieve(&lifts) {
            return Err(StepError::NoConvergence { t, what: "the forces of the supports that only push".into() });
        }
        if self.lifting.forces().iter().any(|force| *force != 0.0) {
            let mut x = vec![0.0; n];
            self.lifting.add_load(&mut x);
            solve(&mut x, 1).map_err(StepError::Factorisation)?;
            d.iter_mut().zip(&x).for_each(|(d, x)| *d += x);
        }
        Ok(calls)
    }

    /// Finds the contact forces, those of each impactor in turn until none changes; returns the evaluations of contact laws.
    ///
    /// The approaches are symmetric and positive and no force falls with its indentation, so that this converges,
    /// slowly where stiff contacts share a place. With each force the springs that only push find theirs.
    fn balance(
        &mut self,
        strikers: Strikers<'_>,
        t: f64,
        h: &Histories,
        start: Option<&[f64]>,
    ) -> Result<u64, StepError> {
        let impactors = strikers.impactors;
        let count = self.forces.len();
        let mut evaluations = 0;
        self.forces.fill(0.0);
        for _ in 0..MOST_SWEEPS {
            let mut settled = true;
            for (i, impactor) in impactors.iter().enumerate() {
                let loads = strikers.of(i);
                let (c, Self { approach, free, forces, lifting, lifts, across, .. }) = (loads.start, &mut *self);
                if let Some(tip) = strikers.tip(i) {
                    let (same, calls) = self.press(tip, strikers.remembering(i, h), loads).ok_or_else(|| {
                        StepError::NoConvergence { t, what: "the pressure under the tip of an impactor".into() }
                    })?;
                    evaluations += calls;
                    settled &= same;
                    continue;
                }
                let row = &approach[c * count..(c + 1) * count];
                let others = (0..count).filter(|j| *j != c).map(|j| row[j] * forces[j]);
                let mut free = free[c] - others.sum::<f64>();
                let before = forces[c];
                let (mut at_others, mut given) = (Vec::new(), 0.0);
                if !lifting.is_empty() {
                    forces[c] = 0.0;
                    at_others = pressed(lifts, across, forces);
                    lifting.relieve(&at_others);
                    given = along(&across[c], lifting.forces());
                    free -= given;
                }
                // Approach that its own force takes back, and its derivative.
                let yielding = |force: f64| {
                    if at_others.is_empty() {
                        return (row[c] * force, row[c]);
                    }
                    let w: Vec<f64> = at_others.iter().zip(&across[c]).map(|(w, across)| w + across * force).collect();
                    lifting.relieve(&w);
                    let more = along(&across[c], lifting.forces()) - given;
                    (row[c] * force + more, row[c] + lifting.slopes(&across[c..=c])[(0, 0)])
                };
                let (force, calls) = match start {
                    None => contact(|alpha| impactor.law.force(&h.contacts[i], alpha), free, yielding),
                    Some(u) => {
                        let start = u[u.len() - impactors.len() + i] - value(&impactor.load, u);
                        contact(|middle| mean_force(impactor, &h.contacts[i], start, middle), free, yielding)
                    }
                };
                evaluations += calls;
                if !force.is_finite() {
                    return Err(StepError::NotFinite { t });
                }
                settled &= row[c] * (force - before).abs() <= TOLERANCE * free.abs();
                forces[c] = force;
            }
            if impactors.len() < 2 || settled {
                return Ok(evaluations);
            }
        }
        Err(StepError::NoConvergence { t, what: "the contact forces of several impactors".into() })
    }

    /// Finds the forces under a tip, those of the others being what they are and those of springs what follows; returns whether they are
    /// what they were, and the evaluations of the law.
    fn press(&mut self, tip: &Tip, by: Remembering<'_>, loads: Range<usize>) -> Option<(bool, u64)> {
        let Self { approach, free, forces, lifting, lifts, across, .. } = self;
        let count = forces.len();
        let outside = |c: usize| {
            (0..count).filter(|j| !loads.contains(j)).map(|j| approach[c * count + j] * forces[j]).sum::<f64>()
        };
        let mut free: Vec<f64> = loads.clone().map(|c| free[c] - outside(c)).collect();
        let own =
            DMatrix::from_fn(loads.len(), loads.len(), |k, l| approach[(loads.start + k) * count + loads.start + l]);
        let before = forces[loads.clone()].to_vec();
        let rings = &across[loads.clone()];
        let (mut at_others, mut given) = (Vec::new(), Vec::new());
        if !lifting.is_empty() {
            forces[loads.clone()].fill(0.0);
            at_others = pressed(lifts, across, forces);
            lifting.relieve(&at_others);
            given = rings.iter().map(|across| along(across, lifting.forces())).collect();
            free.iter_mut().zip(&given).for_each(|(free, given)| *free -= given);
        }
        let mut yielding = UnderTip { own: &own, rings, lifting, at_others, given };
        let calls = tip.solve(by, &mut yielding, &free, &mut forces[loads.clone()])?;
        let change = DVector::from_iterator(loads.len(), forces[loads].iter().zip(before).map(|(now, old)| now - old));
        let scale = free.iter().fold(0.0_f64, |most, free| most.max(free.abs()));
        Some(((own * change).amax() <= TIP_TOLERANCE * scale, calls))
    }
}

/// A plate and an impactor under the forces of the rings of a tip.
struct UnderTip<'a> {
    own: &'a DMatrix<f64>,
    /// Deflections of springs by a unit force of each ring.
    rings: &'a [Vec<f64>],
    lifting: &'a mut Lifting,
    /// The same by all other forces; none where no spring lets go.
    at_others: Vec<f64>,
    /// What springs that have let go under these give to the rings.
    given: Vec<f64>,
}

impl Yielding for UnderTip<'_> {
    fn back(&mut self, forces: &DVector<f64>) -> DVector<f64> {
        let Self { own, rings, lifting, at_others, given } = self;
        let mut back = *own * forces;
        if !at_others.is_empty() {
            lifting.relieve(&pressed(at_others, rings, forces.as_slice()));
            for ((back, across), given) in back.iter_mut().zip(*rings).zip(given) {
                *back += along(across, lifting.forces()) - *given;
            }
        }
        back
    }

    fn derivative(&mut self) -> Cow<'_, DMatrix<f64>> {
        match self.at_others.is_empty() {
            true => Cow::Borrowed(self.own),
            false => Cow::Owned(self.own + self.lifting.slopes(self.rings)),
        }
    }
}

/// Deflections of springs under contact forces.
fn pressed(lifts: &[f64], across: &[Vec<f64>], forces: &[f64]) -> Vec<f64> {
    let mut w = lifts.to_vec();
    for (across, force) in across.iter().zip(forces) {
        w.iter_mut().zip(across).for_each(|(w, across)| *w += force * across);
    }
    w
}

fn along(across: &[f64], forces: &[f64]) -> f64 {
    across.iter().zip(forces).map(|(across, force)| across * force).sum()
}

/// Mean force of a step from indentation `start` as a function of that in the middle.
fn mean_force(impactor: &Impactor, h: &ContactHistory, start: f64, middle: f64) -> ContactForce {
    let mean = impactor.law.mean_force(h, start, 2.0 * middle - start);
    ContactForce { tangent: 2.0 * mean.tangent, ..mean }
}

/// Solves α + y(F(α)) = `free` for the force, y and its derivative by `yielding`: Newton's method kept inside a bracket, because F and y
/// never fall. Returns the force and the number of evaluations.
fn contact(law: impl Fn(f64) -> ContactForce, free: f64, mut yielding: impl FnMut(f64) -> (f64, f64)) -> (f64, u64) {
    let at_free = law(free);
    if at_free.force == 0.0 {
        return (0.0, 1);
    }
    let (mut yielded, mut soft) = yielding(at_free.force);
    let (mut low, mut high) = (free - yielded, free);
    let mut alpha = free - yielded / (1.0 + soft * at_free.tangent);
    let mut beside = 0.0;
    for calls in 2..MOST_CALLS {
        let c = law(alpha);
        (yielded, soft) = yielding(c.force);
        // What y has beside its tangent through 0.
        beside = yielded - soft * c.force;
        let residual = alpha + yielded - free;
        if residual > 0.0 {
            high = alpha
        } else {
            low = alpha
        }
        let correction = -residual / (1.0 + soft * c.tangent);
        let next = alpha + correction;
        // Before the bracket is asked: at the solution rounding decides on which side of it the next value lies.
        if (next - alpha).abs() <= 1e-15 * (free.abs() + alpha.abs()) || !residual.is_finite() {
            // Not (free - next)/soft, which has the error of α over that of a short step's small `soft`.
            return (c.force + c.tangent * correction, calls);
        }
        let halve = calls > PATIENCE && calls % 2 == 0;
        alpha = if next > low && next < high && !halve { next } else { 0.5 * (low + high) };
    }
    ((free - alpha - beside) / soft, MOST_CALLS)
}
