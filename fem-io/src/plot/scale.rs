//! The range of an axis and its ticks.

/// Values from `lo` to `hi`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub(super) lo: f64,
    pub(super) hi: f64,
}

/// Magnitudes that are drawn; below the first a value counts as zero.
const MAGNITUDES: [f64; 2] = [1e-250, 1e250];

impl Range {
    /// Range of finite `values`; one of (nearly) equal values reaches to zero, one of zeros to 1.
    ///
    /// The error is the largest magnitude.
    pub(super) fn of(values: impl Iterator<Item = f64>) -> Result<Self, f64> {
        let (lo, hi) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi): (f64, f64), v| (lo.min(v), hi.max(v)));
        let largest = lo.abs().max(hi.abs());
        if largest > MAGNITUDES[1] {
            Err(largest)
        } else if largest < MAGNITUDES[0] {
            Ok(Self { lo: 0.0, hi: 1.0 })
        } else if hi - lo < 1e-9 * largest {
            Ok(Self { lo: lo.min(0.0), hi: hi.max(0.0) })
        } else {
            Ok(Self { lo, hi })
        }
    }

    /// Takes in zero if it is near, and leaves some air at the other ends.
    pub(super) fn with_air(self) -> Self {
        let near_zero = |end: f64| if end.abs() < 0.5 * (self.hi - self.lo) { 0.0 } else { end };
        let (lo, hi) = if self.lo >= 0.0 {
            (near_zero(self.lo), self.hi)
        } else if self.hi <= 0.0 {
            (self.lo, near_zero(self.hi))
        } else {
            (self.lo, self.hi)
        };
        let air = 0.05 * (hi - lo);
        Self { lo: if lo == 0.0 { lo } else { lo - air }, hi: if hi == 0.0 { hi } else { hi + air } }
    }

    /// Where `value` lies, 0 at `lo` and 1 at `hi`.
    pub(super) fn fraction(self, value: f64) -> f64 {
        (value - self.lo) / (self.hi - self.lo)
    }

    /// Round values 1, 2 or 5 · 10ᵏ apart in at most `most` intervals, with their labels.
    pub(super) fn ticks(self, most: usize) -> Vec<(f64, String)> {
        let smallest = (self.hi - self.lo) / most as f64;
        let mut exponent = smallest.log10().floor() as i32;
        let mut step = 10_f64.powi(exponent);
        step *= [1.0, 2.0, 5.0].into_iter().find(|m| m * step >= smallest * (1.0 - 1e-9)).unwrap_or_else(|| {
            exponent += 1;
            10.0
        });
        let first = (self.lo / step - 1e-6).ceil() as i64;
        let last = (self.hi / step + 1e-6).floor() as i64;
        let largest = self.lo.abs().max(self.hi.abs());
        let label = |value: f64| {
            let text = if value == 0.0 {
                "0".to_owned()
            } else if largest >= 1e6 || exponent < -5 {
                format!("{value:.*e}", (largest.log10().floor() as i32 - exponent).max(0) as usize)
            } else {
                format!("{value:.*}", (-exponent).max(0) as usize)
            };
            text.replace('-', "−")
        };
        (first..=last).map(|k| k as f64 * step).map(|value| (value, label(value))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(lo: f64, hi: f64, most: usize) -> Vec<String> {
        Range { lo, hi }.ticks(most).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(
            labels(0.0, 1000.0, 10),
            ["0", "100", "200", "300", "400", "500", "600", "700", "800", "900", "1000"]
        );
        assert_eq!(labels(-0.31, 0.52, 5), ["−0.2", "0", "0.2", "0.4"]);
        assert_eq!(labels(0.0, 1.05, 3), ["0", "0.5", "1.0"]);
        assert_eq!(
            labels(100_000.0, 100_000.002, 4),
            ["100000.0000", "100000.0005", "100000.0010", "100000.0015", "100000.0020"]
        );
        assert_eq!(labels(0.0, 3.1e7, 4), ["0", "1e7", "2e7", "3e7"]);
        assert_eq!(labels(-2.1e-8, 0.0, 5), ["−2.0e−8", "−1.5e−8", "−1.0e−8", "−5.0e−9", "0"]);
    }

    #[test]
    fn any_range_has_a_few_ticks_inside() {
        for lo in [-1e249, -1e6, -3.3, -1e-200, 0.0, 1e-240, 7.7, 1e12] {
            for span in [1e-248, 1e-12, 0.3, 1.0, 9.99, 1e5, 1e249] {
                let Ok(range) = Range::of([lo, lo + span].into_iter()) else { continue };
                for range in [range, range.with_air()] {
                    for most in 3..=10 {
                        let ticks = range.ticks(most);
                        assert!((1..=most + 1).contains(&ticks.len()), "{range:?} {most} {ticks:?}");
                        assert!(ticks.iter().all(|t| (-1e-6..=1.0 + 1e-6).contains(&range.fraction(t.0))), "{range:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn flat_curves_get_a_range() {
        let of = |values: &[f64]| Range::of(values.iter().copied());
        assert_eq!(of(&[0.0, -0.0, 1e-300]), Ok(Range { lo: 0.0, hi: 1.0 }));
        assert_eq!(of(&[5.0, 5.0]), Ok(Range { lo: 0.0, hi: 5.0 }));
        assert_eq!(of(&[-5.0]), Ok(Range { lo: -5.0, hi: 0.0 }));
        assert_eq!(of(&[1.0, -2e250]), Err(2e250));
    }

    #[test]
    fn zero_is_taken_in_when_near() {
        assert_eq!(Range { lo: 1.0, hi: 21.0 }.with_air(), Range { lo: 0.0, hi: 22.05 });
        assert_eq!(Range { lo: -21.0, hi: -1.0 }.with_air(), Range { lo: -22.05, hi: 0.0 });
        assert_eq!(Range { lo: 100.0, hi: 120.0 }.with_air(), Range { lo: 99.0, hi: 121.0 });
        assert_eq!(Range { lo: -10.0, hi: 10.0 }.with_air(), Range { lo: -11.0, hi: 11.0 });
    }
}
