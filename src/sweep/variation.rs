//! What a key becomes, from words.

use super::distribution::{Distribution, NAMES};
use fem_core::plugin::unknown_key;
use fem_io::scene::unit;
use std::fmt;

/// What a key of the scene becomes in the cases of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub enum Variation {
    /// These values, as `--set` takes them.
    Levels(Vec<String>),
    /// Numbers at equal distances, or, without a count, any number between the two.
    Range {
        /// The first.
        from: f64,
        /// The last.
        to: f64,
        /// How many.
        count: Option<usize>,
        /// Their unit; none of a pure number.
        unit: Option<String>,
    },
    /// Numbers that scatter.
    Scatter {
        /// By what they do.
        by: Distribution,
        /// Least and largest: beyond them there is none, as if they were drawn again.
        within: Option<[f64; 2]>,
        /// Their unit; none of a pure number.
        unit: Option<String>,
    },
}

/// Most values of a range.
const MOST: usize = 1_000_000;

impl Variation {
    /// Reads `words`: values with commas between them, `1..5:9`, or a distribution, `normal(50 MPa, 8 %) within 30..70`. Numbers
    /// without unit have that of `given`, the value in the scene.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn parse(words: &str, given: Option<&str>) -> Result<Self, String> {
        let words = words.trim();
        let own = given.and_then(unit);
        if words.is_empty() {
            return Err("it becomes nothing".into());
        }
        if let Some((name, rest)) = words.split_once('(')
            && !name.is_empty()
            && name.chars().all(|c| c.is_ascii_lowercase())
        {
            return scatter(name, rest, own);
        }
        match words.split_once("..") {
            Some((from, rest)) => {
                let (to, count) = rest.rsplit_once(':').map_or((rest, None), |(to, count)| (to, Some(count)));
                let (from, to, unit) = interval(from, to, own)?;
                let count = count.map(|count| match count.trim().parse::<usize>() {
                    Ok(count) if (2..=MOST).contains(&count) => Ok(count),
                    _ => Err(format!("`{}` is no number of values: write from 2 to {MOST}", count.trim())),
                });
                Ok(Self::Range { from, to, count: count.transpose()?, unit })
            }
            None => Ok(Self::Levels(split(words).map(|value| value.trim().to_owned()).collect())),
        }
    }

    /// The unit of its numbers, where they have one in common.
    pub fn unit(&self) -> Option<&str> {
        match self {
            Self::Range { unit, .. } | Self::Scatter { unit, .. } => unit.as_deref(),
            Self::Levels(levels) => {
                let mut units = levels.iter().map(|level| unit(level));
                let first = units.next()??;
                units.all(|other| other == Some(first)).then_some(first)
            }
        }
    }

    /// How many values it has; `None` where there is no end of them.
    pub fn count(&self) -> Option<usize> {
        match self {
            Self::Levels(levels) => Some(levels.len()),
            Self::Range { count, .. } => *count,
            Self::Scatter { .. } => None,
        }
    }

    /// Whether there is a least and a largest value.
    pub(super) fn has_ends(&self) -> bool {
        !matches!(self, Self::Scatter { within: None, .. })
    }

    /// Value number `k` of those that it has, as `--set` takes it.
    pub fn level(&self, k: usize) -> String {
        match self {
            Self::Levels(levels) => levels[k.min(levels.len() - 1)].clone(),
            Self::Range { from, to, count, unit } => {
                let last = count.map_or(1, |count| count - 1);
                // The ends are what was written.
                let value = if k >= last { *to } else { from + (to - from) * k as f64 / last as f64 };
                written(value, unit.as_deref())
            }
            Self::Scatter { .. } => self.at(0.5),
        }
    }

    /// The value below which the share `p` of all lies, 0 ≤ p ≤ 1.
    pub fn at(&self, p: f64) -> String {
        match (self, self.count()) {
            (_, Some(count)) => self.level(((p * count as f64) as usize).min(count - 1)),
            (Self::Scatter { by, within, unit }, _) => {
                let [low, high] = within.map_or([0.0, 1.0], |within| within.map(|x| by.share_below(x)));
                let p = (low + p * (high - low)).clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON);
                let value = by.quantile(p);
                let value = within.map_or(value, |[least, most]| value.clamp(least, most));
                written(value, unit.as_deref())
            }
            (Self::Range { from, to, unit, .. }, _) => written(from + p * (to - from), unit.as_deref()),
            (Self::Levels(_), None) => String::new(),
        }
    }
}

/// As words that [`Variation::parse`] reads.
impl fmt::Display for Variation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = match self {
            Self::Levels(levels) => return f.write_str(&levels.join(", ")),
            Self::Range { from, to, count, unit } => {
                write!(f, "{from}..{to}")?;
                count.map_or(Ok(()), |count| write!(f, ":{count}"))?;
                unit
            }
            Self::Scatter { by, within, unit } => {
                write!(f, "{by}")?;
                within.map_or(Ok(()), |[least, most]| write!(f, " within {least}..{most}"))?;
                unit
            }
        };
        unit.as_ref().map_or(Ok(()), |unit| write!(f, " {unit}"))
    }
}

fn written(value: f64, unit: Option<&str>) -> String {
    unit.map_or_else(|| value.to_string(), |unit| format!("{value} {unit}"))
}

/// A number with its unit, if it has one.
fn quantity(text: &str) -> Result<(f64, Option<&str>), String> {
    let text = text.trim();
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number.trim(), Some("%")),
        None => (text.split_whitespace().next().unwrap_or(text), unit(text)),
    };
    match number.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((value, unit)),
        _ => Err(format!("`{text}` is no number with its unit")),
    }
}

/// Two numbers with a unit that either may have, or that of the scene.
fn interval(from: &str, to: &str, own: Option<&str>) -> Result<(f64, f64, Option<String>), String> {
    let ((from, a), (to, b)) = (quantity(from)?, quantity(to)?);
    if let (Some(a), Some(b)) = (a, b)
        && a != b
    {
        return Err(format!("it goes from {a} to {b}: write both in one unit"));
    }
    match from < to {
        true => Ok((from, to, a.or(b).or(own).map(str::to_owned))),
        false => Err(format!("its range from {from} to {to} is empty: write the least first")),
    }
}

/// What follows `name(`.
fn scatter(name: &str, rest: &str, own: Option<&str>) -> Result<Variation, String> {
    if NAMES.iter().all(|(known, _)| *known != name) {
        return Err(format!("`{name}` {}", unknown_key(name, NAMES.iter().map(|(name, _)| *name))));
    }
    let takes = NAMES.iter().find(|(known, _)| *known == name).map_or("", |(_, takes)| takes);
    let wrong = || format!("write {name}({takes}), for example normal(50 MPa, 8 %) within 30..70");
    let (inside, after) = rest.split_once(')').ok_or_else(wrong)?;
    let numbers: Vec<&str> = inside.split(',').collect();
    let [a, b] = numbers[..] else { return Err(wrong()) };
    let ((a, of_a), (b, of_b)) = (quantity(a)?, quantity(b)?);
    let (b, of_b) = match (name, of_b) {
        ("weibull", Some(unit)) => {
            return Err(format!(
                "its shape is a number without a unit, and not in {unit}: about 1.2 over the share that scatters"
            ));
        }
        // A coefficient of variation.
        ("normal" | "lognormal", Some("%")) => (0.01 * b * a.abs(), None),
        (_, Some("%")) => return Err(wrong()),
        (_, unit) => (b, unit),
    };
    if let (Some(x), Some(y)) = (of_a, of_b)
        && x != y
    {
        return Err(format!("its numbers are in {x} and {y}: write both in one unit"));
    }
    let unit = of_a.or(of_b).or(own);
    let by = Distribution::new(name, [a, b]).map_err(|why| format!("{name}({inside}): {why}"))?;
    let within = match after.trim() {
        "" => None,
        bounds => {
            let bounds = bounds.strip_prefix("within").and_then(|bounds| bounds.split_once("..")).ok_or_else(wrong)?;
            let (least, most, of_bounds) = interval(bounds.0, bounds.1, unit)?;
            if of_bounds.as_deref() != unit {
                return Err("its bounds are in another unit than its numbers".into());
            }
            if !(by.share_below(most) - by.share_below(least) > 1e-9) {
                return Err(format!("nothing of {name}({inside}) lies within {least} and {most}"));
            }
            Some([least, most])
        }
    };
    Ok(Variation::Scatter { by, within, unit: unit.map(str::to_owned) })
}

/// The parts between commas that no bracket and no quotes enclose.
fn split(words: &str) -> impl Iterator<Item = &str> {
    let (mut depth, mut quoted) = (0_i32, false);
    words.split(move |c: char| {
        match c {
            '"' | '\'' => quoted = !quoted,
            '[' | '(' | '{' => depth += 1,
            ']' | ')' | '}' => depth -= 1,
            _ => {}
        }
        c == ',' && depth == 0 && !quoted
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn levels(words: &str, given: Option<&str>) -> Vec<String> {
        let of = Variation::parse(words, given).unwrap();
        (0..of.count().unwrap()).map(|k| of.level(k)).collect()
    }

    #[test]
    fn words_become_values() {
        assert_eq!(levels("1..3:3", Some("1.5 m/s")), ["1 m/s", "2 m/s", "3 m/s"]);
        assert_eq!(levels("1..2 km/h:2", Some("1.5 m/s")), ["1 km/h", "2 km/h"]);
        assert_eq!(levels("[0/90]4s,[45/-45]4s", Some("[0]")), ["[0/90]4s", "[45/-45]4s"]);
        assert_eq!(levels("[8, 8], [4, 4]", None), ["[8, 8]", "[4, 4]"]);
        assert_eq!(levels("20..60:3", None), ["20", "40", "60"]);
        let cut = Variation::parse("normal(50 MPa, 10 %) within 45..60", None).unwrap();
        for (p, want) in [(0.0, 45.0), (1.0, 60.0)] {
            let value = cut.at(p);
            let number: f64 = value.strip_suffix(" MPa").unwrap().parse().unwrap();
            assert!((number / want - 1.0).abs() < 1e-9, "{value}");
        }
        assert_eq!(Variation::parse("uniform(1, 3)", Some("2 kg")).unwrap().at(0.25), "1.5 kg");
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        for (words, why) in [
            ("", "nothing"),
            ("5..1:3", "empty"),
            ("1..5:1", "from 2 to"),
            ("1 m..5 s:3", "one unit"),
            ("a..b:3", "no number"),
            ("normal(50, -5)", "above 0"),
            ("normal(50)", "write normal(mean, deviation)"),
            ("gauss(50, 5)", "not known"),
            ("normal(50, 5) within 500..600", "nothing of"),
            ("weibull(64 MPa, 10 %)", "without a unit"),
            ("weibull(64 MPa, 6.4 MPa)", "without a unit"),
            ("uniform(5, 120 %)", "write uniform(least, largest)"),
        ] {
            let got = Variation::parse(words, None).unwrap_err();
            assert!(got.contains(why), "{words}: {got}");
        }
    }
}
