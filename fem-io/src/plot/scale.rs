//! The range of an axis and its ticks.

use super::Scale;

/// A stretch of an axis, from `lo` to `hi`: values on a linear scale, their decimal logarithms on a logarithmic one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    scale: Scale,
    lo: f64,
    hi: f64,
}

/// Magnitudes that are drawn; below the first a value counts as zero, and as the first where there is no zero.
const MAGNITUDES: [f64; 2] = [1e-250, 1e250];

/// Most decades with lines between them.
const LINED: f64 = 3.5;

impl Scale {
    fn coordinate(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => value.max(MAGNITUDES[0]).log10(),
        }
    }
}

impl Range {
    /// Range of finite `values`, positive ones on a logarithmic scale.
    ///
    /// One of (nearly) equal values reaches to zero, one of zeros to 1; on a logarithmic scale it is a decade. The
    /// error is the largest magnitude.
    pub(super) fn of(scale: Scale, values: impl Iterator<Item = f64>) -> Result<Self, f64> {
        let (lo, hi) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi): (f64, f64), v| (lo.min(v), hi.max(v)));
        let largest = lo.abs().max(hi.abs());
        if largest > MAGNITUDES[1] {
            return Err(largest);
        }
        let [lo, hi] = [lo, hi].map(|value| scale.coordinate(value));
        let (lo, hi) = match scale {
            Scale::Linear if largest < MAGNITUDES[0] => (0.0, 1.0),
            Scale::Linear if hi - lo < 1e-9 * largest => (lo.min(0.0), hi.max(0.0)),
            Scale::Logarithmic if hi - lo < 1e-6 => (lo - 0.5, hi + 0.5),
            _ => (lo, hi),
        };
        Ok(Self { scale, lo, hi })
    }

    /// Leaves some air at both ends; a linear range takes in zero instead where that is near.
    pub(super) fn with_margins(self) -> Self {
        let Self { scale, lo, hi } = self;
        let near = |distance: f64| scale == Scale::Linear && (0.0..0.5 * (hi - lo)).contains(&distance);
        let (from_zero, to_zero) = (near(lo), near(-hi));
        let (lo, hi) = (if from_zero { 0.0 } else { lo }, if to_zero { 0.0 } else { hi });
        let air = 0.05 * (hi - lo);
        Self { scale, lo: if from_zero { lo } else { lo - air }, hi: if to_zero { hi } else { hi + air } }
    }

    /// Distance of the ends, of their logarithms on a logarithmic scale.
    pub(super) fn length(self) -> f64 {
        self.hi - self.lo
    }

    /// Whether zero lies between the ends.
    pub(super) fn crosses_zero(self) -> bool {
        self.scale == Scale::Linear && self.lo < 0.0 && self.hi > 0.0
    }

    /// Where `value` lies, 0 at the lower end and 1 at the upper.
    pub(super) fn fraction(self, value: f64) -> f64 {
        (self.scale.coordinate(value) - self.lo) / (self.hi - self.lo)
    }

    /// Round values in at most `most` intervals, with their labels.
    ///
    /// On a logarithmic scale they are powers of ten; where fewer than two of these are inside, 1, 2 and 5 · 10ᵏ; and
    /// where that is too few as well, values at equal distances, as on a linear scale.
    pub(super) fn ticks(self, most: usize) -> Vec<(f64, String)> {
        let Self { scale, lo, hi } = self;
        if scale == Scale::Linear {
            return even_ticks(lo, hi, most);
        }
        let step = ((hi - lo) / most as f64).ceil();
        let decades = multiples(lo, hi, step).map(|exponent| decimal(1, exponent as i32)).collect();
        let thirds = self.decimals(&[1, 2, 5]).collect();
        let enough = |ticks: &Vec<_>| (2..=most + 1).contains(&ticks.len());
        [decades, thirds].into_iter().find(enough).unwrap_or_else(|| even_ticks(10_f64.powf(lo), 10_f64.powf(hi), most))
    }

    /// Values between the powers of ten of a logarithmic range, unless that has too many decades for them.
    pub(super) fn minor_ticks(self) -> Vec<f64> {
        if self.scale == Scale::Linear || self.hi - self.lo > LINED {
            return Vec::new();
        }
        self.decimals(&[2, 3, 4, 5, 6, 7, 8, 9]).map(|tick| tick.0).collect()
    }

    /// All `digits` · 10ᵏ inside a logarithmic range, with their labels.
    fn decimals(self, digits: &[u8]) -> impl Iterator<Item = (f64, String)> {
        let decades = self.lo.floor() as i32..=self.hi.floor() as i32;
        let ticks = decades.flat_map(move |exponent| digits.iter().map(move |&digit| decimal(digit, exponent)));
        ticks.filter(move |(value, _)| (-1e-9..=1.0 + 1e-9).contains(&self.fraction(*value)))
    }
}

/// Values 1, 2 or 5 · 10ᵏ apart from `lo` to `hi` in at most `most` intervals, with their labels.
fn even_ticks(lo: f64, hi: f64, most: usize) -> Vec<(f64, String)> {
    let smallest = (hi - lo) / most as f64;
    let mut exponent = smallest.log10().floor() as i32;
    let mut step = 10_f64.powi(exponent);
    step *= [1.0, 2.0, 5.0].into_iter().find(|m| m * step >= smallest * (1.0 - 1e-9)).unwrap_or_else(|| {
        exponent += 1;
        10.0
    });
    let largest = lo.abs().max(hi.abs());
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
    multiples(lo, hi, step).map(|value| (value, label(value))).collect()
}

/// All multiples of `step` from `lo` to `hi`.
fn multiples(lo: f64, hi: f64, step: f64) -> impl Iterator<Item = f64> {
    let first = (lo / step - 1e-6).ceil() as i64;
    let last = (hi / step + 1e-6).floor() as i64;
    (first..=last).map(move |k| k as f64 * step)
}

/// `digit` · 10ᵏ with its label.
fn decimal(digit: u8, exponent: i32) -> (f64, String) {
    let value = f64::from(digit) * 10_f64.powi(exponent);
    let label = if exponent.abs() <= 3 {
        format!("{value:.*}", (-exponent).max(0) as usize)
    } else {
        format!("{digit}e{exponent}").replace('-', "−")
    };
    (value, label)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn linear(lo: f64, hi: f64) -> Range {
        Range { scale: Scale::Linear, lo, hi }
    }

    fn logarithmic(lo: f64, hi: f64) -> Range {
        Range::of(Scale::Logarithmic, [lo, hi].into_iter()).unwrap()
    }

    fn labels_of(range: Range, most: usize) -> Vec<String> {
        range.ticks(most).into_iter().map(|(_, label)| label).collect()
    }

    fn labels(lo: f64, hi: f64, most: usize) -> Vec<String> {
        labels_of(linear(lo, hi), most)
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
                let Ok(range) = Range::of(Scale::Linear, [lo, lo + span].into_iter()) else { continue };
                for range in [range, range.with_margins()] {
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
        let of = |values: &[f64]| Range::of(Scale::Linear, values.iter().copied());
        assert_eq!(of(&[0.0, -0.0, 1e-300]), Ok(linear(0.0, 1.0)));
        assert_eq!(of(&[5.0, 5.0]), Ok(linear(0.0, 5.0)));
        assert_eq!(of(&[-5.0]), Ok(linear(-5.0, 0.0)));
        assert_eq!(of(&[1.0, -2e250]), Err(2e250));
    }

    #[test]
    fn zero_is_taken_in_when_near() {
        assert_eq!(linear(1.0, 21.0).with_margins(), linear(0.0, 22.05));
        assert_eq!(linear(-21.0, -1.0).with_margins(), linear(-22.05, 0.0));
        assert_eq!(linear(100.0, 120.0).with_margins(), linear(99.0, 121.0));
        assert_eq!(linear(-10.0, 10.0).with_margins(), linear(-11.0, 11.0));
    }

    #[test]
    fn logarithmic_ticks_are_decades_or_parts_of_one() {
        let labels = |lo, hi, most| labels_of(logarithmic(lo, hi), most);
        assert_eq!(labels(1e-5, 0.3, 9), ["1e−5", "1e−4", "0.001", "0.01", "0.1"]);
        assert_eq!(labels(0.05, 6e4, 9), ["0.1", "1", "10", "100", "1000", "1e4"]);
        assert_eq!(labels(1e-20, 1.0, 9), ["1e−18", "1e−15", "1e−12", "1e−9", "1e−6", "0.001", "1"]);
        assert_eq!(labels(0.03, 4.0, 9), ["0.1", "1"]);
        assert_eq!(labels(0.3, 4.0, 9), ["0.5", "1", "2"]);
        assert_eq!(labels(1.1e-5, 9e-4, 9), ["2e−5", "5e−5", "1e−4", "2e−4", "5e−4"]);
        assert_eq!(labels(2.1, 4.9, 6), ["2.5", "3.0", "3.5", "4.0", "4.5"]);
    }

    #[test]
    fn up_to_three_decades_and_a_half_have_ticks_between() {
        let between: Vec<_> = logarithmic(0.35, 22.0).minor_ticks().iter().map(|v| format!("{v:.1}")).collect();
        let want = "0.4 0.5 0.6 0.7 0.8 0.9 2.0 3.0 4.0 5.0 6.0 7.0 8.0 9.0 20.0";
        assert_eq!(between.join(" "), want);
        assert_eq!(logarithmic(1.0, 3e3).minor_ticks().len(), 8 * 3 + 2);
        assert!(logarithmic(1.0, 4e3).minor_ticks().is_empty());
        assert!(linear(1.0, 20.0).minor_ticks().is_empty());
    }

    #[test]
    fn a_logarithmic_range_has_its_geometric_mean_in_the_middle_and_air_at_both_ends() {
        let range = logarithmic(1.0, 100.0);
        assert_eq!([1.0, 10.0, 100.0].map(|v| range.fraction(v)), [0.0, 0.5, 1.0]);
        let airy = range.with_margins();
        assert!(
            (airy.fraction(10_f64.powf(-0.1))).abs() < 1e-12 && (airy.fraction(10_f64.powf(2.1)) - 1.0).abs() < 1e-12
        );
        let flat = logarithmic(10.0, 10.0);
        assert!(flat.fraction(10_f64.sqrt()).abs() < 1e-12 && (flat.fraction(10_f64.powf(1.5)) - 1.0).abs() < 1e-12);
        assert!(!logarithmic(0.1, 10.0).crosses_zero() && linear(-1.0, 1.0).crosses_zero());
    }

    proptest! {
        #[test]
        fn logarithmic_ticks_are_inside_apart_and_say_where_they_are(
            exponent in -249.0..249.0, span in prop_oneof![-6.0..0.7, 0.0..2.5], most in 3..=10_usize
        ) {
            let lo = 10_f64.powf(exponent);
            let hi = 10_f64.powf((exponent + 10_f64.powf(span)).min(250.0));
            for range in [logarithmic(lo, hi), logarithmic(lo, hi).with_margins()] {
                let ticks = range.ticks(most);
                prop_assert!((1..=most + 1).contains(&ticks.len()), "{:?} {:?}", range, ticks);
                prop_assert!(ticks.iter().all(|t| (-1e-6..=1.0 + 1e-6).contains(&range.fraction(t.0))), "{:?}", ticks);
                for (value, label) in &ticks {
                    let said: f64 = label.replace('−', "-").parse().unwrap();
                    prop_assert!((range.fraction(said) - range.fraction(*value)).abs() < 1e-6, "{value} {label}");
                }
                prop_assert!(ticks.windows(2).all(|t| range.fraction(t[1].0) - range.fraction(t[0].0) > 1e-3), "{:?}", ticks);
                let minor = range.minor_ticks();
                prop_assert!(minor.iter().all(|v| (-1e-6..=1.0 + 1e-6).contains(&range.fraction(*v))), "{:?}", minor);
            }
        }
    }
}
