//! The plane, among those that contain an axis, on which a function of the angle is largest.

use crate::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Sine and cosine of 0°, 1°, … 180°.
static DEGREES: LazyLock<[(f64, f64); 181]> =
    LazyLock::new(|| std::array::from_fn(|k| (k as f64).to_radians().sin_cos()));

/// Distances from an end of the angles at which a maximum that stands on the end is known for one: the near one meets a
/// slope, the far one a maximum beside an end without a slope, which rises there by less than rounding. One that stands
/// nearer still exceeds the end by some 1e-13.
const BESIDE: [f64; 2] = [1e-7, 5e-4];

/// Largest value of `f(sin, cos)` from 0 to the angle `end`, at most π, and its angle.
///
/// Samples every degree and refines each sample that is no lower than its neighbours and within a tenth of the best: the
/// best sample need not stand by the best maximum. A NaN is returned where it is met.
#[inline]
pub(crate) fn maximise(end: f64, f: impl Fn(f64, f64) -> f64) -> (f64, f64) {
    let last = (end.to_degrees().ceil() as usize).min(180);
    let mut sample = [0.0; 181];
    for (v, (sin, cos)) in sample.iter_mut().zip(&DEGREES[..last]) {
        *v = f(*sin, *cos);
    }
    sample[last] = f(end.sin(), end.cos());
    let angle = |k: usize| (k as f64).to_radians().min(end);
    let sample = &sample[..=last];
    if let Some(k) = sample.iter().position(|v| v.is_nan()) {
        return (angle(k), sample[k]);
    }
    let highest = (0..=last).fold(0, |best, k| if sample[k] > sample[best] { k } else { best });
    let threshold = sample[highest] - 0.1 * sample[highest].abs();
    let mut best = (angle(highest), sample[highest]);
    for k in 0..=last {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
        if sample[k] >= threshold && sample[k] >= sample[before] && sample[k] >= sample[after] {
            let lower = |x: f64| x < 0.0 || x > end || f(x.sin(), x.cos()) <= sample[k];
            let at_an_end = match k {
                0 => BESIDE.into_iter().all(lower),
                _ if k == last => BESIDE.into_iter().map(|off| end - off).all(lower),
                _ => false,
            };
            if at_an_end {
                continue;
            }
            let refined = brent(angle(before), angle(k), angle(after), sample[k], |x| f(x.sin(), x.cos()));
            if refined.1 > best.1 {
                best = refined;
            }
        }
    }
    best
}

/// Maximum of a function in [a, b] from `x` inside, where it is `fx`: parabolas through the three best points, golden
/// section where they do not converge (Brent, Algorithms for Minimization without Derivatives, 1973, chapter 5).
#[inline]
fn brent(mut a: f64, mut x: f64, mut b: f64, mut fx: f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.381_966_011_250_105_2;
    const TOLERANCE: f64 = 1e-10;
    let (mut w, mut v, mut fw, mut fv) = (x, x, fx, fx);
    let (mut step, mut before_last) = (0.0_f64, 0.0_f64);
    loop {
        let middle = 0.5 * (a + b);
        if (x - middle).abs() + 0.5 * (b - a) <= 2.0 * TOLERANCE {
            return (x, fx);
        }
        let r = (x - w) * (fx - fv);
        let q = (x - v) * (fx - fw);
        let (p, q) = ((x - v) * q - (x - w) * r, 2.0 * (q - r));
        let parabola = -p / q;
        let inside = parabola > a - x && parabola < b - x;
        if inside && parabola.abs() < 0.5 * before_last.abs() {
            before_last = step;
            step = parabola;
            let u = x + step;
            if u - a < 2.0 * TOLERANCE || b - u < 2.0 * TOLERANCE {
                step = TOLERANCE.copysign(middle - x);
            }
        } else {
            before_last = if x < middle { b - x } else { a - x };
            step = GOLDEN * before_last;
        }
        let u = x + if step.abs() >= TOLERANCE { step } else { TOLERANCE.copysign(step) };
        let fu = f(u);
        if fu >= fx {
            if u >= x {
                a = x
            } else {
                b = x
            }
            (v, w, x) = (w, x, u);
            (fv, fw, fx) = (fw, fx, fu);
        } else {
            if u < x {
                a = u
            } else {
                b = u
            }
            if fu >= fw || w == x {
                (v, w) = (w, u);
                (fv, fw) = (fw, fu);
            } else if fu >= fv || v == x || v == w {
                (v, fv) = (u, fu);
            }
        }
    }
}

/// Planes that contain the fibre by the sign of σn = mean + radius cos 2(θ − principal).
pub(crate) struct Signs {
    /// The plane of the largest σn, radians.
    pub(crate) principal: f64,
    /// σn is not negative within this angle of it, from 0 to π/2.
    pub(crate) half: f64,
}

impl Signs {
    #[inline]
    pub(crate) fn of(s: &Stress6<Ply>) -> Self {
        let (mean, difference) = (0.5 * (s.s22() + s.s33()), 0.5 * (s.s22() - s.s33()));
        let radius = difference.hypot(s.s23());
        let half = if radius <= mean.abs() {
            if mean >= 0.0 { FRAC_PI_2 } else { 0.0 }
        } else {
            0.5 * (-mean / radius).acos()
        };
        Self { principal: 0.5 * s.s23().atan2(difference), half }
    }
}

/// What acts on planes that contain the fibre, over a range of stresses.
pub(crate) struct Tractions {
    /// σn.
    pub(crate) normal: Interval,
    /// The largest shear across the fibre, |τnt|.
    pub(crate) across: f64,
    /// The largest shear along it, |τn1|.
    pub(crate) along: f64,
}

impl Tractions {
    /// The circle of Mohr about (σ22 + σ33)/2, of the largest radius in the range.
    #[inline]
    pub(crate) fn of(s: &StressRange) -> Self {
        /// What sums of stresses may be off by.
        const ROUNDING: f64 = 1e-12;
        let (mean, difference) = ((s.s22() + s.s33()) * 0.5, (s.s22() - s.s33()) * 0.5);
        let radius = difference.magnitude().hypot(s.s23().magnitude());
        let reach = radius + ROUNDING * (radius + mean.magnitude());
        Self {
            normal: mean + Interval { low: -reach, high: reach },
            across: reach,
            along: (1.0 + ROUNDING) * s.s12().magnitude().hypot(s.s31().magnitude()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn close(got: (f64, f64), angle: f64, value: f64, tolerance: f64) {
        assert!((got.0 - angle).abs() < tolerance && (got.1 - value).abs() < 1e-14, "{got:?}, not {angle} {value}");
    }

    #[test]
    fn maxima_between_samples_at_the_seam_and_at_the_ends() {
        let wave = |at: f64| maximise(PI, move |s, c| (2.0 * (s.atan2(c) - at)).cos());
        close(wave(0.3333), 0.3333, 1.0, 1e-7);
        close(wave(0.005), 0.005, 1.0, 1e-7);
        close(wave(-0.005), PI - 0.005, 1.0, 1e-7);
        close(maximise(0.9, |s, _| s), 0.9, 0.9_f64.sin(), 1e-15);
        close(maximise(0.9, |_, c| c), 0.0, 1.0, 1e-15);
        close(maximise(PI, |s, _| s), 0.5 * PI, 1.0, 1e-7);
    }

    /// 1 + a x² − x⁴ from an end: the maximum stands √(a/2) beside it and is a²/4 higher.
    #[test]
    fn maxima_close_beside_an_end_without_a_slope() {
        let from_the_end = |a: f64| move |x: f64| 1.0 + a * x * x - x.powi(4);
        for a in (0..60).map(|k| 1e-9 * 1.3_f64.powi(k)) {
            let f = from_the_end(a);
            for found in [maximise(0.9, |s, c| f(s.atan2(c))), maximise(0.9, |s, c| f(0.9 - s.atan2(c)))] {
                assert!((found.1 - 1.0 - 0.25 * a * a).abs() < 1e-13, "{a}: {found:?}");
            }
        }
    }

    #[test]
    fn the_lower_sample_may_have_the_higher_maximum() {
        // A sharp peak of 1.01 between samples beside a blunt one of 1 on a sample.
        let f = |s: f64, c: f64| {
            let x = s.atan2(c).to_degrees();
            let peak = |at: f64, height: f64, width: f64| height * (-((x - at) / width).powi(2)).exp();
            peak(40.0, 1.0, 8.0) + peak(120.5, 1.01, 2.0)
        };
        assert!((maximise(PI, f).1 - 1.01).abs() < 1e-12);
    }

    #[test]
    fn kinks_constants_and_what_is_no_number() {
        let kink = maximise(PI, |s, c| 1.0 - (s.atan2(c) - 1.2345).abs());
        assert!((kink.1 - 1.0).abs() < 1e-9, "{kink:?}");
        assert_eq!(maximise(PI, |_, _| 0.0).1, 0.0);
        assert_eq!(maximise(PI, |s, _| if s > 0.5 { f64::INFINITY } else { s }).1, f64::INFINITY);
        assert!(maximise(PI, |s, _| if s > 0.9 { f64::NAN } else { s }).1.is_nan());
    }
}
