//! What a map is over.

use crate::sweep::Variation;
use std::fmt;

/// Ratio of the ends from which on an axis counts in ratios.
const WIDE: f64 = 3.0;
/// Digits of the values that are marched.
const DIGITS: usize = 6;

/// A number of the scene that a map is over. Its *share* is 0 at one end and 1 at the other.
#[derive(Debug, Clone, PartialEq)]
pub struct MapAxis {
    /// The path of its key.
    pub key: String,
    /// Its unit, if it has one.
    pub unit: Option<String>,
    /// Its ends.
    pub ends: [f64; 2],
    /// Whether equal ratios are equally far apart, and not equal differences.
    pub logarithmic: bool,
}

impl fmt::Display for MapAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [from, to] = self.ends;
        write!(f, "{from}..{to}")?;
        self.unit.as_ref().map_or(Ok(()), |unit| write!(f, " {unit}"))
    }
}

impl MapAxis {
    /// Of a range without a count; `None` of anything else.
    pub(super) fn of(key: &str, variation: &Variation) -> Option<Self> {
        let Variation::Range { from, to, count: None, unit } = variation else { return None };
        let logarithmic = *from > 0.0 && to / from >= WIDE;
        Some(Self { key: key.to_owned(), unit: unit.clone(), ends: [*from, *to], logarithmic })
    }

    /// The value at a share, to six digits.
    pub fn value(&self, share: f64) -> f64 {
        let [from, to] = self.ends;
        let value = match self.logarithmic {
            true => from * (to / from).powf(share),
            false => from + (to - from) * share,
        };
        let near = format!("{value:.*e}", DIGITS - 1).parse::<f64>().unwrap_or(value);
        near.clamp(from, to)
    }

    /// The share of a value.
    pub fn share(&self, value: f64) -> f64 {
        let [from, to] = self.ends;
        if self.logarithmic { (value / from).ln() / (to / from).ln() } else { (value - from) / (to - from) }
    }

    /// What the whole axis is in units of an error: a relative one where it counts in ratios, else a share of the axis.
    pub(super) fn length(&self) -> f64 {
        if self.logarithmic { (self.ends[1] / self.ends[0]).ln() } else { 1.0 }
    }

    /// A value as a scene writes it.
    pub fn words(&self, value: f64) -> String {
        self.unit.as_ref().map_or_else(|| value.to_string(), |unit| format!("{value} {unit}"))
    }

    /// Its key with its unit.
    pub(super) fn column(&self) -> String {
        self.unit.as_ref().map_or_else(|| self.key.clone(), |unit| format!("{} [{unit}]", self.key))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn shares_and_values_go_both_ways() {
        for (words, logarithmic) in [("0.5..8 kg", true), ("-10..10 mm", false), ("2..3 m/s", false), ("1..3 J", true)]
        {
            let axis = MapAxis::of("k", &Variation::parse(words, None).unwrap()).unwrap();
            assert_eq!(axis.logarithmic, logarithmic, "{words}");
            assert_eq!([0.0, 1.0].map(|share| axis.value(share)), axis.ends, "{words}");
            for share in [0.2, 0.77] {
                assert!((axis.share(axis.value(share)) - share).abs() < 1e-5, "{words}");
            }
        }
        assert_eq!(MapAxis::of("k", &Variation::parse("1..5:9", None).unwrap()), None);
    }
}
