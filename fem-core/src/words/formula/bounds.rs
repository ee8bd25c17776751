//! What the values of a formula do not leave, over ranges of what it is made of.

use super::{Formula, Step};
use crate::words::interval::Interval;

/// What functions of the mathematical library may be off by, relative.
const ROUNDING: f64 = 1e-15;

/// From the least to the largest of some numbers.
fn hull(values: &[f64]) -> Interval {
    let low = values.iter().fold(f64::INFINITY, |least, v| least.min(*v));
    let high = values.iter().fold(f64::NEG_INFINITY, |most, v| most.max(*v));
    Interval { low, high }
}

/// The same with what a library may be off by.
fn around(values: &[f64]) -> Interval {
    let Interval { low, high } = hull(values);
    Interval { low: low - ROUNDING * low.abs(), high: high + ROUNDING * high.abs() }
}

impl Formula {
    /// What its value does not leave where each of its names (in the order of [`Formula::names`]) lies in an interval; it is a number
    /// everywhere there. `None` where the formula does not say so much: a divisor that may be zero, a root of what may be negative, the
    /// tangent of a range, what overflows.
    pub fn bounds(&self, values: &[Interval]) -> Option<Interval> {
        if values.len() != self.names.len() {
            return None;
        }
        let mut stack: Vec<Interval> = Vec::with_capacity(self.depth);
        for (step, &(symbol, _)) in self.steps.iter().zip(&self.sources) {
            let next = match *step {
                Step::Number(number) => Interval::exactly(number),
                Step::Value(k) => values[k],
                Step::Apply(function) => apply(symbol, function, stack.pop()?)?,
                Step::Combine(operator) => {
                    let (b, a) = (stack.pop()?, stack.pop()?);
                    combine(symbol, operator, a, b)?
                }
            };
            if !(next.low.is_finite() && next.high.is_finite()) {
                return None;
            }
            stack.push(next);
        }
        stack.pop()
    }
}

fn apply(symbol: &str, function: super::Function, of: Interval) -> Option<Interval> {
    let ends = [function(of.low), function(of.high)];
    let grows = || around(&ends);
    match symbol {
        "abs" => Some(of.abs()),
        "pos" => Some(of.positive()),
        "sqrt" => (of.low >= 0.0).then(|| hull(&ends)),
        "ln" => (of.low > 0.0).then(grows),
        "exp" => Some(grows()),
        "sin" | "cos" if of.low < of.high => Some(Interval { low: -1.0, high: 1.0 }),
        _ => (of.low == of.high).then(grows),
    }
}

fn combine(symbol: &str, operator: super::Binary, a: Interval, b: Interval) -> Option<Interval> {
    let truth = |always: bool, never: bool| match (always, never) {
        (true, _) => Interval::exactly(1.0),
        (_, true) => Interval::exactly(0.0),
        _ => Interval { low: 0.0, high: 1.0 },
    };
    let corners =
        || [operator(a.low, b.low), operator(a.low, b.high), operator(a.high, b.low), operator(a.high, b.high)];
    let powers = || around(&corners());
    match symbol {
        "<" => Some(truth(a.high < b.low, a.low >= b.high)),
        "<=" => Some(truth(a.high <= b.low, a.low > b.high)),
        ">" => Some(truth(a.low > b.high, a.high <= b.low)),
        ">=" => Some(truth(a.low >= b.high, a.high < b.low)),
        "+" => Some(a + b),
        "-" => Some(a - b),
        "*" => Some(a * b),
        "/" => (b.low > 0.0 || b.high < 0.0).then(|| hull(&corners())),
        "^" if b == Interval::exactly(2.0) => Some(a.squared()),
        // Of positive numbers a power goes one way in either.
        "^" if a.low > 0.0 => Some(powers()),
        "^" if b.low == b.high && b.low >= 0.0 && b.low.fract() == 0.0 => {
            let whole = powers();
            let passes_zero = b.low % 2.0 == 0.0 && a.low < 0.0 && a.high > 0.0;
            Some(if passes_zero { Interval { low: whole.low.min(0.0), ..whole } } else { whole })
        }
        "^" if b.low >= 0.0 && a.low >= 0.0 => Some(powers()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_cannot_be_said_is_not() {
        let over = |text: &str, low: f64, high: f64| {
            Formula::parse(text, &["x"]).unwrap().bounds(&vec![Interval { low, high }; usize::from(text.contains('x'))])
        };
        for text in ["1/x", "sqrt(x)", "ln(x + 1)", "tan(x)", "x^(-1)", "x^0.5", "x^x", "exp(1000*x)", "1/(x^2)"] {
            assert_eq!(over(text, -1.0, 2.0), None, "{text}");
        }
        assert_eq!(over("(x >= 0)*x^2", -3.0, 2.0), Some(Interval { low: 0.0, high: 9.0 }));
        assert_eq!(over("(x > 0)*x^2", -3.0, 0.0), Some(Interval { low: 0.0, high: 0.0 }));
        assert_eq!(over("pos(-x)/2 + abs(x)", -3.0, 2.0), Some(Interval { low: 0.0, high: 4.5 }));
        assert_eq!(over("2*3", 0.0, 0.0), Some(Interval::exactly(6.0)));
    }

    proptest! {
        /// Values within the ranges stay within the bounds, and are numbers.
        #[test]
        fn values_stay_within(
            text in "\\(?[xy23]([+*/^-]|\\)[+*/-]\\()[xy2](\\)?[+*/-](pos|abs|sqrt|exp|sin)?\\([xy][<+*/-][xy2]\\)){0,2}",
            (x, y) in ((-3.0..3.0, 0.0..2.0), (-3.0..3.0, 0.0..2.0)),
            places in prop::collection::vec((0.0..=1.0, 0.0..=1.0), 9),
        ) {
            if let Ok(formula) = Formula::parse(&text, &["x", "y"]) {
                let ranges = [x, y].map(|(low, width): (f64, f64)| Interval { low, high: low + width });
                let own: Vec<Interval> = formula.names().iter().map(|k| ranges[*k]).collect();
                if let Some(bounds) = formula.bounds(&own) {
                    for (a, b) in places.iter().copied().chain([(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)]) {
                        let at = |range: Interval, share: f64| (range.low + share * (range.high - range.low)).clamp(range.low, range.high);
                        let both = [at(ranges[0], a), at(ranges[1], b)];
                        let values: Vec<f64> = formula.names().iter().map(|k| both[*k]).collect();
                        let value = formula.value(&values);
                        prop_assert!((bounds.low..=bounds.high).contains(&value), "{text} at {values:?}: {value}, {bounds:?}");
                    }
                }
            }
        }
    }
}
