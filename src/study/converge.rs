//! What a sequence of finer and finer results says of its limit.

/// Least ratio of two successive differences of a sequence that is said to converge: order 0.3, with more than four times
/// the last difference left. Those of a logarithm do not shrink at all.
const SHRINKS: f64 = 1.23;

/// Highest order that is believed; a larger one is a difference that happens to vanish.
const HIGHEST: f64 = 8.0;

/// What is known of the end of a sequence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Convergence {
    /// Successive differences shrink.
    Converges {
        /// Observed order p of the error C hᵖ, h halved from level to level.
        order: f64,
        /// Error that is left in the last level.
        left: f64,
    },
    /// Differences do not shrink any more, but the last is smaller than what matters, and so is the error of the last level.
    Settled {
        /// The last difference.
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
    pub fn of(differences: &[f64], matters: f64) -> Self {
        match *differences {
            [] => Self::Unknown { difference: None },
            [.., before, last] if before / last >= SHRINKS => {
                // Over two halvings where both shrink: a single difference may be small or large by chance.
                let ratio = match *differences {
                    [.., earlier, before, last] if earlier / before >= SHRINKS => (earlier / last).sqrt(),
                    _ => before / last,
                };
                let order = ratio.log2().min(HIGHEST);
                Self::Converges { order, left: last / (order.exp2() - 1.0) }
            }
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
}
