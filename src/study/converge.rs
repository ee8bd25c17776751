//! What a sequence of finer and finer results says of its limit.

/// Least ratio of two successive differences of a sequence that is said to converge: order 0.3, with more than four times
/// the last difference left. Those of a logarithm do not shrink at all.
const SHRINKS: f64 = 1.23;

/// Highest order that is believed; a larger one is a difference that happens to vanish.
const HIGHEST: f64 = 8.0;

/// Two successive ratios of differences confirm each other where the later is so much of the earlier.
const CONFIRMS: std::ops::RangeInclusive<f64> = 0.75..=1.05;

/// Share of what is extrapolated that is never believed, and of an error to which it counts as known.
const DOUBTED: f64 = 0.25;
const KNOWN: f64 = 1.0 / 3.0;

/// A relative error, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorBar {
    /// The error; a difference, where nothing better is known.
    pub error: f64,
    /// How much larger it may be; infinite where nothing says so.
    pub bar: f64,
}

impl ErrorBar {
    /// A difference that is what it is.
    pub(super) fn exact(error: f64) -> Self {
        Self { error, bar: 0.0 }
    }

    /// Whether it is known to a third.
    pub fn is_known(self) -> bool {
        self.bar.is_finite() && self.bar <= KNOWN * self.error
    }

    /// The most that it may be.
    pub fn most(self) -> f64 {
        self.error + self.bar
    }

    /// The largest of several, and the most that any of them may be; `None` of none, or where one is no number.
    pub fn worst(all: impl IntoIterator<Item = Self>) -> Option<Self> {
        let worst = |a: Self, b: Self| {
            let error = a.error.max(b.error);
            Self { error, bar: a.most().max(b.most()) - error }
        };
        let mut all = all.into_iter().peekable();
        all.peek()?;
        let all = all.map(|e| Some(e).filter(|e| e.error.is_finite()));
        all.collect::<Option<Vec<_>>>()?.into_iter().reduce(worst)
    }
}

/// What is known of the end of a sequence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Convergence {
    /// Successive differences shrink.
    Converges {
        /// Observed order p of the error C hᵖ, h halved from level to level.
        order: f64,
        /// Error that is left in the last level.
        left: f64,
        /// How much more that may be.
        bar: f64,
    },
    /// Differences do not shrink any more, but the last is smaller than what matters, and so is the error of the last level.
    Settled {
        /// The last difference, or the one before where that matters no more and is larger.
        left: f64,
    },
    /// Successive differences do not shrink: there is no limit in sight, and none is extrapolated.
    Stalls {
        /// The last difference.
        difference: f64,
    },
    /// Fewer than three levels.
    Unknown {
        /// The last difference, if there are two.
        difference: Option<f64>,
    },
}

impl Convergence {
    /// From the differences of successive levels, coarse to fine; none is of interest that is below `matters`.
    ///
    /// Where differences d shrink by q from level to level, d q / (1 − q) is left. A q that the difference before confirms
    /// is believed; any other may become as poor as its root, which is half the order, and three times as much may be left,
    /// which holds of 1, 1/2, 1/3, ... and of what begins fast and goes on slowly.
    pub fn of(differences: &[f64], matters: f64) -> Self {
        match *differences {
            [] => Self::Unknown { difference: None },
            [.., before, last] if before / last >= SHRINKS => {
                let shrinks = last / before;
                let earlier = differences.len().checked_sub(3).map(|k| before / differences[k]);
                let earlier = earlier.filter(|q| *q <= 1.0 / SHRINKS);
                // Over two halvings where both shrink: a single difference may be small or large by chance.
                let usual = earlier.map_or(shrinks, |q| (q * shrinks).sqrt());
                let order = (-usual.log2()).min(HIGHEST);
                let left = last / (order.exp2() - 1.0);
                let (feared, least) = match earlier {
                    Some(q) if CONFIRMS.contains(&(shrinks / q)) => (q.max(shrinks), (1.0 + DOUBTED) * left),
                    _ => (shrinks.max(earlier.unwrap_or(0.0)).sqrt(), 3.0 * left),
                };
                let feared = feared.max((-HIGHEST).exp2());
                // The last difference may be small by chance: what the one before it promises counts, too.
                let most = last.max(before * feared) * feared / (1.0 - feared);
                Self::Converges { order, left, bar: most.max(least) - left }
            }
            [.., before, last] if last <= matters && before <= matters => Self::Settled { left: last.max(before) },
            [.., last] if last <= matters => Self::Settled { left: last },
            [difference] => Self::Unknown { difference: Some(difference) },
            [.., difference] => Self::Stalls { difference },
        }
    }

    /// Error of the last level; infinite for one that stalls. Of two levels alone it is taken to be of first order.
    pub fn left(self) -> f64 {
        match self {
            Self::Converges { left, .. } | Self::Settled { left } => left,
            Self::Stalls { .. } | Self::Unknown { difference: None } => f64::INFINITY,
            Self::Unknown { difference: Some(difference) } => difference,
        }
    }

    /// How much more may be left: where no order is known, what the slowest sequence that converges leaves.
    pub fn bar(self) -> f64 {
        match self {
            Self::Converges { bar, .. } => bar,
            Self::Settled { left: d } | Self::Unknown { difference: Some(d) } => d / (SHRINKS - 1.0) - d,
            Self::Stalls { .. } | Self::Unknown { difference: None } => f64::INFINITY,
        }
    }

    /// What may be left, as far as a plan can count on it: of a sequence that stalls as if it just converged.
    pub(super) fn feared(self) -> f64 {
        match self {
            Self::Stalls { difference } => difference / (SHRINKS - 1.0),
            other => other.left() + other.bar(),
        }
    }

    /// The observed order.
    pub fn order(self) -> Option<f64> {
        match self {
            Self::Converges { order, .. } => Some(order),
            _ => None,
        }
    }
}

/// The limit of `values`, coarse to fine, by Richardson's extrapolation where they converge from one side; the last of
/// them otherwise. `convergence` is that of their differences over `scale`.
pub fn limit(values: &[f64], convergence: Convergence, scale: f64) -> Option<f64> {
    let [.., a, b, c] = values else { return values.last().copied() };
    let steady = (b - a) * (c - b) > 0.0;
    Some(match convergence {
        Convergence::Converges { left, .. } if steady => c + (left * scale).copysign(c - b),
        _ => *c,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn differences(values: &[f64]) -> Vec<f64> {
        values.windows(2).map(|v| (v[1] - v[0]).abs()).collect()
    }

    #[test]
    fn a_power_of_the_step_is_extrapolated_to_its_limit() {
        for (order, sign) in [(1.0, 1.0), (2.0, -1.0), (3.7, 1.0)] {
            let values: Vec<f64> = (0..4).map(|k| 5.0 + sign * 0.3 * (-order * f64::from(k)).exp2()).collect();
            let found = Convergence::of(&differences(&values), 1e-12);
            assert!((found.order().unwrap() - order).abs() < 1e-9, "{found:?}");
            assert!((limit(&values, found, 1.0).unwrap() - 5.0).abs() < 1e-12);
            assert!((found.left() - (values[3] - 5.0).abs()).abs() < 1e-12);
        }
    }

    /// Second order, with a difference that is small by chance: the last ratio alone would be of order 0.4, and leave 3e-3.
    #[test]
    fn a_difference_by_chance_does_not_set_the_order() {
        let found = Convergence::of(&[1.2e-2, 1.3e-3, 1e-3], 1e-6);
        assert!(found.order().unwrap() > 1.5 && found.left() < 6e-4, "{found:?}");
    }

    #[test]
    fn a_logarithm_and_a_pole_have_no_limit() {
        for values in [[1.0, 1.1, 1.2, 1.3], [1.0, 1.1, 1.3, 1.7], [1.0, 1.1, f64::NAN, 1.2]] {
            let found = Convergence::of(&differences(&values), 1e-4);
            assert!(matches!(found, Convergence::Stalls { .. }) && found.left().is_infinite(), "{found:?}");
        }
    }

    #[test]
    fn what_is_below_interest_has_settled() {
        let found = Convergence::of(&differences(&[2.0, 1.000_01, 1.0, 1.000_01]), 1e-4);
        assert!(matches!(found, Convergence::Settled { .. }));
        assert_eq!(limit(&[2.0, 1.1, 1.0, 1.05], Convergence::Stalls { difference: 0.05 }, 1.0), Some(1.05));
        assert_eq!(limit(&[], Convergence::Unknown { difference: None }, 1.0), None);
        assert_eq!(Convergence::of(&[0.1], 1e-4).left(), 0.1);
    }

    #[test]
    fn from_alternating_sides_the_last_counts() {
        let values = [1.0 + 0.4, 1.0 - 0.1, 1.0 + 0.025];
        let found = Convergence::of(&differences(&values), 1e-6);
        assert_eq!(limit(&values, found, 1.0), Some(values[2]));
    }

    /// What sequences leave at their last level, of two to six levels, is within the bar.
    #[test]
    fn what_is_left_is_within_the_bar() {
        let held = |errors: &dyn Fn(f64) -> f64, levels: u32| {
            let values: Vec<f64> = (0..levels).map(|k| 3.0 + errors(f64::from(k))).collect();
            let found = Convergence::of(&differences(&values), 1e-9);
            let exact = errors(f64::from(levels - 1)).abs();
            assert!(exact <= (found.left() + found.bar()) * (1.0 + 1e-9), "{levels} levels: {exact:e}, {found:?}");
            ErrorBar { error: found.left(), bar: found.bar() }
        };
        for levels in 2..=6 {
            for order in [0.5, 1.0, 2.0, 3.7] {
                let found = held(&|k| (-order * k).exp2(), levels);
                // Two ratios confirm each other, one alone is not believed to a third.
                assert_eq!(found.is_known(), levels > 3, "{levels} levels of order {order}: {found:?}");
            }
            for sign in [2.0_f64, 4.0] {
                held(&|k| (1.0 - 2.0 * (k % 2.0)) * sign.powf(-k), levels);
            }
            let slow: [&dyn Fn(f64) -> f64; 3] =
                [&|k| 1.0 / (k + 1.0), &|k| 4.0_f64.powf(-k) + 0.05 * (-0.5 * k).exp2(), &|k| {
                    4.0_f64.powf(-k) - 0.3 * (-k).exp2()
                }];
            for errors in slow {
                let found = held(errors, levels);
                assert!(!found.is_known(), "{levels} levels: {found:?}");
            }
            let log = held(&|k| -k, levels);
            assert!(levels == 2 || log.bar.is_infinite());
        }
    }

    /// Errors of second order under a noise as large as the last differences: most of them are within the bar.
    #[test]
    fn a_floor_of_noise_is_seen() {
        let mut random = {
            let mut state = 1_u64;
            move || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
            }
        };
        let (mut kept, mut all) = (0, 0);
        for (noise, levels, _) in
            [1e-3, 1e-4].into_iter().flat_map(|a| (3..8).flat_map(move |n| (0..500).map(move |i| (a, n, i))))
        {
            let values: Vec<f64> = (0..levels).map(|k| 0.1 * 4.0_f64.powi(-k) + noise * random()).collect();
            let found = Convergence::of(&differences(&values), 3e-4);
            kept += i32::from(values.last().unwrap().abs() <= found.left() + found.bar());
            all += 1;
        }
        assert!(f64::from(kept) > 0.88 * f64::from(all), "{kept} of {all}");
    }

    #[test]
    fn the_worst_of_several_errors() {
        let of = |error, bar| ErrorBar { error, bar };
        let worst = ErrorBar::worst([of(1e-2, 0.0), of(5e-3, 2e-2)]).unwrap();
        assert!(worst.error == 1e-2 && (worst.bar - 1.5e-2).abs() < 1e-15 && !worst.is_known());
        assert!(ErrorBar::worst([of(1e-2, 3e-3)]).unwrap().is_known());
        assert!(ErrorBar::worst([]).is_none() && ErrorBar::worst([of(f64::NAN, 0.0)]).is_none());
        assert!(ErrorBar::worst([of(0.1, f64::INFINITY), of(0.2, 0.0)]).unwrap().bar.is_infinite());
    }
}
