//! Intervals of numbers, by which a criterion bounds its indices over many stresses at once.

use std::ops::{Add, Mul, Sub};

/// All numbers from `low` to `high`.
///
/// Sums, differences and products hold every rounded result of numbers in between, because rounding never changes an order: what
/// is computed of intervals bounds what the same operations in the same order compute of numbers. Ends must be finite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

/// The smaller of two numbers: one instruction, where `f64::min` takes more to see to what is not a number.
#[inline]
fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline]
fn more(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

impl Interval {
    /// One number alone.
    #[inline]
    pub fn exactly(number: f64) -> Self {
        Self { low: number, high: number }
    }

    /// The squares of its numbers.
    #[inline]
    pub fn squared(self) -> Self {
        let (a, b) = (self.low * self.low, self.high * self.high);
        Self { low: if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { less(a, b) }, high: more(a, b) }
    }

    /// The largest of its numbers without their signs.
    #[inline]
    pub fn magnitude(self) -> f64 {
        more(self.low.abs(), self.high.abs())
    }

    /// Its numbers without their signs.
    #[inline]
    pub fn abs(self) -> Self {
        Self { low: more(more(self.low, -self.high), 0.0), high: self.magnitude() }
    }

    /// Whether some of its numbers are zero or more.
    #[inline]
    pub fn reaches_positive(self) -> bool {
        self.high >= 0.0
    }

    /// Whether some of its numbers are below zero.
    #[inline]
    pub fn reaches_negative(self) -> bool {
        self.low < 0.0
    }

    /// Those of its numbers that are not above zero, or zero.
    #[inline]
    pub fn negative(self) -> Self {
        Self { low: less(self.low, 0.0), high: less(self.high, 0.0) }
    }

    /// Those of its numbers that are not below zero, or zero.
    #[inline]
    pub fn positive(self) -> Self {
        Self { low: more(self.low, 0.0), high: more(self.high, 0.0) }
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { low: self.low - other.high, high: self.high - other.low }
    }
}

impl Mul for Interval {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let [a, b, c, d] = [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        Self { low: less(less(a, b), less(c, d)), high: more(more(a, b), more(c, d)) }
    }
}

impl Mul<f64> for Interval {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        let (a, b) = (self.low * factor, self.high * factor);
        Self { low: less(a, b), high: more(a, b) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_hold_those_of_numbers_in_between() {
        let ends = [-3.0, -0.7, 0.0, 0.1, 2.0];
        let intervals = || ends.iter().flat_map(|&low| ends.iter().map(move |&high| Interval { low, high }));
        let within = |i: Interval| [i.low, (0.3 * i.low + 0.7 * i.high).clamp(i.low, i.high), i.high];
        for a in intervals().filter(|i| i.low <= i.high) {
            for x in within(a) {
                let holds =
                    |i: Interval, v: f64| assert!((i.low..=i.high).contains(&v), "{v} is not in {i:?} of {a:?}");
                holds(a.squared(), x * x);
                holds(a.negative(), x.min(0.0));
                holds(a.positive(), x.max(0.0));
                holds(a * -1.5, x * -1.5);
                holds(a.abs(), x.abs());
                assert!(x.abs() <= a.magnitude());
                for b in intervals().filter(|i| i.low <= i.high) {
                    for y in within(b) {
                        holds(a + b, x + y);
                        holds(a - b, x - y);
                        holds(a * b, x * y);
                    }
                }
            }
        }
    }
}
