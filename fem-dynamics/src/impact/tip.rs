//! A spherical tip, round which the structure may bend: its contact is where they touch.

use super::value;
use fem_core::contact::{ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// Rings of the bed, and the share of the radius of the tip that they cover: there a sphere lies 13 % deeper than its paraboloid.
const RINGS: usize = 16;
const WIDEST: f64 = 0.7;
/// Turns of Newton's method, halvings of a step of it, and the share of the approach that is left when it ends.
const MOST: usize = 100;
const HALVINGS: usize = 30;
const EXACT: f64 = 1e-14;
/// The same where rounding stops it before.
const ENOUGH: f64 = 1e-9;
/// Rounding of sums, relative to their largest term.
const ROUNDING: f64 = 1e-15;

/// A tip of radius R that indents a bed of springs and, in series with it, what a contact law F(α) gives: half and half.
///
/// ```text
/// δ = z − α(F)/2 − r²/(2R) − w(r)                  depth of the tip in the bed, where it touches the face
/// p = F'(2δ)/(π R) of the law's first loading      pressure of the bed
/// F = ∫ p dA                                       α(F) with the law's history
/// ```
///
/// A ring carries F(2δ) of its inner less that of its outer edge, each with the history of a law that was as deep as the bed was there: the
/// bed keeps what the law keeps.
///
/// On a plane δ₀ = α/2, and F is that of the law on any path, if F(α_max − Δ) does not fall as α_max grows; with Hertz' law p is his pressure on a² = 2R δ₀ = R α.
/// Where the face is bent to 1/ρ, with 1/R' = 1/R − 1/ρ, the patch is a² = 2R' δ and wider, by less than Hertz' (R' = 2R: by 12 %, and F by
/// 4 %), because the bed is but half of the indentation; where it is bent as the tip is, they touch all over, and where it is bent more, along
/// the rim. Where it is bent a law loses what its pressure does, which need not be what it loses on a plane.
///
/// w is a mean over each of sixteen rings of equal width, which reach to 0.7 R; the last one stands for what is beyond.
#[derive(Debug, Clone)]
pub struct Tip {
    rings: Vec<Ring>,
}

/// A ring of the bed: f = F(2d) − F(2d − 2 rise), d the depth of the tip at its inner edge.
#[derive(Debug, Clone)]
struct Ring {
    /// r²/(2R) at the inner edge, and how much more at the outer one, m.
    gap: f64,
    rise: f64,
    /// Mean of r², m².
    square: f64,
    /// Load of a unit force on it.
    load: Vec<(usize, f64)>,
}

/// A law with what it remembers under a tip: as a whole, and of each ring of the bed at its inner and its outer edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Remembering<'a> {
    pub(super) law: &'a dyn ContactLaw,
    pub(super) whole: &'a ContactHistory,
    pub(super) bed: &'a [[ContactHistory; 2]],
}

impl Remembering<'_> {
    /// At a depth of the tip in the bed, where it was as deep as `h` says.
    fn at(&self, h: &ContactHistory, depth: f64) -> ContactForce {
        if depth > 0.0 { self.law.force(h, 2.0 * depth) } else { ContactForce::default() }
    }

    fn energy_at(&self, h: &ContactHistory, depth: f64) -> Energy {
        self.law.energy(h, 2.0 * depth.max(0.0))
    }

    /// Indentation that is left when the force is gone, m.
    pub(super) fn dent(&self) -> f64 {
        let deepest = self.bed.first().map_or(0.0, |[inner, _]| self.law.branches(inner).touch);
        0.5 * (self.law.branches(self.whole).touch + deepest)
    }
}

/// How a plate gives way to the forces of the rings, and an impactor.
pub(super) trait Yielding {
    /// What forces take back of the approaches, m.
    fn back(&mut self, forces: &DVector<f64>) -> DVector<f64>;

    /// Its derivative by the forces that were last asked about, m/N.
    fn derivative(&mut self) -> Cow<'_, DMatrix<f64>>;
}

/// A tip in a state.
#[derive(Debug, Clone)]
pub(super) struct Pressed {
    /// Forces of the rings, N, and the depths of the tip at their inner edges, m.
    pub(super) forces: Vec<f64>,
    depths: Vec<f64>,
    /// Indentation of the law, m.
    pub(super) alpha: f64,
}

impl Pressed {
    pub(super) fn force(&self) -> f64 {
        self.forces.iter().sum()
    }
}

impl Tip {
    /// Inner and outer radii of the rings (m) of a tip of radius `radius` (m).
    pub fn radii(radius: f64) -> impl Iterator<Item = [f64; 2]> {
        let width = WIDEST * radius / RINGS as f64;
        (0..RINGS).map(move |k| [k as f64 * width, (k + 1) as f64 * width])
    }

    /// A tip of radius `radius` (m); `loads` are those of a unit force on each ring.
    pub fn new(radius: f64, loads: Vec<Vec<(usize, f64)>>) -> Self {
        let count = loads.len();
        let ring = |(i, ([inner, outer], load)): (usize, ([f64; 2], _))| {
            let last = i + 1 == count;
            let rise = if last { f64::INFINITY } else { 0.5 * (outer * outer - inner * inner) / radius };
            Ring { gap: 0.5 * inner * inner / radius, rise, square: 0.5 * (inner * inner + outer * outer), load }
        };
        Self { rings: Self::radii(radius).zip(loads).enumerate().map(ring).collect() }
    }

    /// Loads of unit forces on the rings.
    pub(super) fn loads(&self) -> impl Iterator<Item = &Vec<(usize, f64)>> {
        self.rings.iter().map(|ring| &ring.load)
    }

    /// How many rings its bed has.
    pub(super) fn count(&self) -> usize {
        self.rings.len()
    }

    /// Force of a ring at depth `d`, N, and its derivative; no ring pulls, whatever its edges remember.
    fn ring(&self, by: Remembering<'_>, k: usize, d: f64) -> ContactForce {
        let [at_inner, at_outer] = &by.bed[k];
        let (inner, outer) = (by.at(at_inner, d), by.at(at_outer, d - self.rings[k].rise));
        if outer.force > inner.force {
            return ContactForce::default();
        }
        let tangent = 2.0 * (inner.tangent - outer.tangent);
        ContactForce { force: inner.force - outer.force, tangent: tangent.max(0.0) }
    }

    /// Tip at `z` above the displacements `u`.
    pub(super) fn press(&self, by: Remembering<'_>, z: f64, u: &[f64]) -> Pressed {
        let free: Vec<f64> = self.rings.iter().map(|ring| z - value(&ring.load, u)).collect();
        self.press_from(by, &free)
    }

    /// Takes a state into what law and bed remember. An edge that is apart while others bear is no contact that has ended.
    pub(super) fn commit(
        &self,
        law: &dyn ContactLaw,
        pressed: &Pressed,
        whole: &mut ContactHistory,
        bed: &mut [[ContactHistory; 2]],
    ) {
        law.commit(whole, pressed.alpha);
        let ended = pressed.force() == 0.0;
        let take = |h: &mut ContactHistory, depth: f64| {
            if ended || 2.0 * depth > law.branches(h).touch {
                law.commit(h, 2.0 * depth);
            }
        };
        for ((ring, depth), [inner, outer]) in self.rings.iter().zip(&pressed.depths).zip(bed) {
            take(inner, *depth);
            if ring.rise.is_finite() {
                take(outer, depth - ring.rise);
            }
        }
    }

    /// Tip at these approaches of the rings: the indentation of the law at which law and bed have the same force.
    fn press_from(&self, by: Remembering<'_>, free: &[f64]) -> Pressed {
        let depths = |alpha: f64| self.rings.iter().zip(free).map(move |(ring, free)| free - ring.gap - 0.5 * alpha);
        let forces = |alpha: f64| depths(alpha).enumerate().map(|(k, d)| self.ring(by, k, d).force);
        // What the bed has more than the law falls with the indentation of the law.
        let more = |alpha: f64| forces(alpha).sum::<f64>() - by.law.force(by.whole, alpha).force;
        let touch = by.law.branches(by.whole).touch;
        let mut alpha = touch;
        if more(touch) > 0.0 {
            let mut step = (free[0] - touch).abs().max(f64::MIN_POSITIVE);
            let (mut low, mut high) = (touch, touch + step);
            while more(high) > 0.0 && high.is_finite() {
                step *= 2.0;
                (low, high) = (high, touch + step);
            }
            for _ in 0..2 * MOST {
                let middle = 0.5 * (low + high);
                if !(low < middle && middle < high) {
                    break;
                }
                if more(middle) > 0.0 { low = middle } else { high = middle }
            }
            alpha = low;
        }
        // Apart, law and bed are as far from a touch as the tip is.
        let apart = depths(alpha).fold(f64::NEG_INFINITY, f64::max).min(0.0);
        Pressed { forces: forces(alpha).collect(), depths: depths(alpha).collect(), alpha: alpha + 2.0 * apart }
    }

    /// Work on law and bed, J.
    pub(super) fn energy(&self, by: Remembering<'_>, pressed: &Pressed) -> Energy {
        let Energy { mut stored, mut dissipated } = by.law.energy(by.whole, pressed.alpha);
        for ((ring, depth), [at_inner, at_outer]) in self.rings.iter().zip(&pressed.depths).zip(by.bed) {
            let (inner, outer) = (by.energy_at(at_inner, *depth), by.energy_at(at_outer, depth - ring.rise));
            stored += inner.stored - outer.stored;
            dissipated += inner.dissipated - outer.dissipated;
        }
        Energy { stored: 0.5 * stored, dissipated: 0.5 * dissipated }
    }

    /// Radius (m) of the Hertz pressure that is as far spread as these forces: a² = 5/2 of the mean square of their radii.
    pub(super) fn radius(&self, pressed: &Pressed) -> f64 {
        let force = pressed.force();
        if force == 0.0 {
            return 0.0;
        }
        let moment: f64 = self.rings.iter().zip(&pressed.forces).map(|(ring, f)| ring.square * f).sum();
        (2.5 * moment / force).sqrt()
    }

    /// Forces of the rings where `free` are the approaches without them and `yielding` says what of these they take back, y(f), and then
    /// its derivative A there (m/N): Newton's method, each step as long as it brings it nearer, for
    ///
    /// ```text
    /// d + gap + α(Σ f(d))/2 + y(f(d)) = free
    /// ```
    ///
    /// Returns the evaluations of the law, `None` where it does not end.
    pub(super) fn solve(
        &self,
        by: Remembering<'_>,
        yielding: &mut impl Yielding,
        free: &[f64],
        forces: &mut [f64],
    ) -> Option<u64> {
        let n = self.rings.len();
        let mut calls = 0;
        let mut at = |yielding: &mut dyn Yielding, d: &DVector<f64>| {
            let ring = d.iter().enumerate().map(|(k, d)| self.ring(by, k, *d));
            let (f, slopes): (Vec<f64>, Vec<f64>) = ring.map(|ring| (ring.force, ring.tangent)).unzip();
            let f = DVector::from_vec(f);
            let (alpha, soft) = inverse(by.law, by.whole, f.sum(), &mut calls);
            let mut residual = yielding.back(&f);
            for (k, r) in residual.iter_mut().enumerate() {
                *r += d[k] + self.rings[k].gap + 0.5 * alpha - free[k];
            }
            (f, slopes, residual, 0.5 * soft)
        };
        let scale = free.iter().fold(0.0_f64, |m, free| m.max(free.abs()));
        let mut d = DVector::from_vec(self.press_from(by, free).depths);
        let (mut f, mut slopes, mut residual, mut soft) = at(yielding, &d);
        for _ in 0..MOST {
            let left = residual.amax();
            if !(left > EXACT * scale) {
                break;
            }
            let approach = yielding.derivative();
            let tangent =
                DMatrix::from_fn(n, n, |k, l| (approach[(k, l)] + soft) * slopes[l] + if k == l { 1.0 } else { 0.0 });
            let step = tangent.lu().solve(&residual)?;
            let mut share = 1.0;
            let mut tried = &d - &step;
            let mut found = at(yielding, &tried);
            while !(found.2.amax() < left) && share > 0.5_f64.powi(HALVINGS as i32) {
                share *= 0.5;
                tried = &d - share * &step;
                found = at(yielding, &tried);
            }
            if !(found.2.amax() < left) {
                break;
            }
            (d, (f, slopes, residual, soft)) = (tried, found);
        }
        forces.copy_from_slice(f.as_slice());
        // Of a tip that is about to touch nothing is left but the rounding of its gaps.
        let sizes = d.iter().zip(&self.rings).map(|(d, ring)| d.abs() + ring.gap);
        let rounding = ROUNDING * sizes.fold(0.0, f64::max);
        (residual.amax() <= rounding.max(ENOUGH * scale)).then_some(calls)
    }
}

/// Indentation of `law` with `force`, the least, and dα/dF, 0 without a force.
fn inverse(law: &dyn ContactLaw, h: &ContactHistory, force: f64, calls: &mut u64) -> (f64, f64) {
    let touch = law.branches(h).touch;
    if !(force > 0.0) {
        return (touch, 0.0);
    }
    let mut step = 1e-6;
    let (mut low, mut high) = (touch, touch + step);
    while law.force(h, high).force < force && high.is_finite() {
        *calls += 1;
        step *= 4.0;
        (low, high) = (high, touch + step);
    }
    let mut alpha = high;
    for _ in 0..MOST {
        let there = law.force(h, alpha);
        *calls += 1;
        if there.force < force {
            low = alpha
        } else {
            high = alpha
        }
        let next = alpha + (force - there.force) / there.tangent;
        let next = if low < next && next < high { next } else { 0.5 * (low + high) };
        if (next - alpha).abs() <= f64::EPSILON * alpha.abs() || high - low <= f64::EPSILON * high.abs() {
            break;
        }
        alpha = next;
    }
    (alpha, 1.0 / law.force(h, alpha).tangent)
}

#[cfg(test)]
mod tests {
    use super::{Remembering, Tip};
    use crate::contact::{SunYang, YigitChristoforou};
    use fem_core::contact::{ContactHistory, ContactLaw};
    use fem_core::plugin::{Built, Dimension, Params, Plugin, Value};

    fn sun_yang(reloading: &str) -> Box<dyn ContactLaw> {
        let params = Params::default()
            .with("k", Value::Quantity(9.7e8, Dimension::contact_stiffness(1.5)))
            .with("critical", Value::Quantity(8e-5, Dimension::LENGTH))
            .with("reloading", Value::Text(reloading.into()));
        match SunYang::build(&params) {
            Ok(Built::Contact(law)) => law,
            other => panic!("{other:?}"),
        }
    }

    /// Of a rigid plane, on a way with turns in contact and apart from it: force, stored and lost energy are those of the law.
    #[test]
    fn on_any_path_the_bed_of_a_plane_is_the_law() {
        let laws =
            [sun_yang("unloading-curve"), sun_yang("loading-exponent"), Box::new(YigitChristoforou::new(9.7e8, 4e-5))];
        let turns = [0.4, 0.33, 0.38, 0.3, 0.42, -0.1, 0.32, 0.25, 0.35, -0.2, 0.5, 0.45, 0.5, 0.0];
        for law in laws {
            let tip = Tip::new(8e-3, vec![Vec::new(); Tip::radii(8e-3).count()]);
            let (mut whole, mut bed) = (ContactHistory::default(), vec![[ContactHistory::default(); 2]; tip.count()]);
            let (mut alone, mut from) = (ContactHistory::default(), 0.0);
            for to in turns {
                for part in 1..=50 {
                    let z = 1e-3 * (from + (to - from) * f64::from(part) / 50.0);
                    let by = Remembering { law: &*law, whole: &whole, bed: &bed };
                    let pressed = tip.press(by, z, &[]);
                    let (force, energy) = (law.force(&alone, z).force, law.energy(&alone, z));
                    let found = tip.energy(by, &pressed);
                    let close =
                        |a: f64, b: f64, scale: f64| assert!((a - b).abs() < 1e-9 * scale, "{law:?} {z}: {a} {b}");
                    close(pressed.force(), force, 1e4);
                    close(found.stored, energy.stored, 1.0);
                    close(found.dissipated, energy.dissipated, 1.0);
                    tip.commit(&*law, &pressed, &mut whole, &mut bed);
                    law.commit(&mut alone, z);
                }
                from = to;
            }
        }
    }
}
