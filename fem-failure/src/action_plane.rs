//! The plane, among all that contain an axis, on which a function of the angle is largest.

use std::f64::consts::PI;

/// Largest value of `f` over the angles `from + k step`, k < `count`, and between neighbours, with its angle.
///
/// The step must be short beside the distance of the maxima of `f`. Every sample that is no lower than its neighbours and
/// within a tenth of the best one is refined by golden section until the value settles to rounding: the best sample need
/// not stand by the best maximum. A NaN anywhere is returned. With `periodic` the ends are neighbours.
pub(crate) fn maximise<const N: usize>(from: f64, step: f64, periodic: bool, f: impl Fn(f64) -> f64) -> (f64, f64) {
    let sample: [f64; N] = std::array::from_fn(|k| f(from + step * k as f64));
    let mut best = (from, sample[0]);
    for (k, &v) in sample.iter().enumerate() {
        if v.is_nan() {
            return (from + step * k as f64, v);
        }
        if v > best.1 {
            best = (from + step * k as f64, v);
        }
    }
    let threshold = best.1 - 0.1 * best.1.abs();
    for k in 0..N {
        let (left, right) = if periodic {
            (sample[(k + N - 1) % N], sample[(k + 1) % N])
        } else {
            (sample[k.saturating_sub(1)], sample[(k + 1).min(N - 1)])
        };
        if sample[k] >= threshold && sample[k] >= left && sample[k] >= right {
            let (mut a, mut b) = (from + step * (k as f64 - 1.0), from + step * (k as f64 + 1.0));
            if !periodic {
                (a, b) = (a.max(from), b.min(from + step * (N - 1) as f64));
            }
            let refined = golden_section(a, b, &f);
            if refined.1 > best.1 {
                best = refined;
            }
        }
    }
    best
}

/// Maximum of a function with one maximum in [a, b].
fn golden_section(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    let (mut x, mut y) = (b - RATIO * (b - a), a + RATIO * (b - a));
    let (mut fx, mut fy) = (f(x), f(y));
    while b - a > 1e-12 * PI {
        if fx > fy {
            (b, y, fy) = (y, x, fx);
            x = b - RATIO * (b - a);
            fx = f(x);
        } else {
            (a, x, fx) = (x, y, fy);
            y = a + RATIO * (b - a);
            fy = f(y);
        }
    }
    if fx > fy { (x, fx) } else { (y, fy) }
}
