//! The row of a parameter: all that is said of it, once.

use super::dimension::Dimension;
use super::value::{ParamError, Value, short};
use std::fmt;
use std::ops::Bound::{self, Excluded, Included, Unbounded};
use std::ops::RangeBounds as _;

/// A parameter of a plug-in: name, meaning, type, range, default.
///
/// Lists, the schema of scenes, explanations and errors are made from it, and [`Params`](super::Params) reads by it. What
/// no value could satisfy does not compile as a constant: an empty range, a default outside of it, a quantity without
/// dimension, no words to choose from.
///
/// ```
/// use fem_core::plugin::{Dimension, ParamInfo};
///
/// const WEIGHT: ParamInfo = ParamInfo::number("beta", "weight of the new acceleration").above(0.0).at_most(1.0).default(0.25);
/// const LIMIT: ParamInfo = ParamInfo::quantity("limit", "stress at failure", Dimension::PRESSURE).above(0.0);
/// const RULE: ParamInfo = ParamInfo::word("mass", "inertia of a cell", &[("cubic", "consistent"), ("linear", "lumped")]);
/// assert_eq!(WEIGHT.to_string(), "weight of the new acceleration; a number above 0 and at most 1; default 0.25");
/// assert_eq!(LIMIT.to_string(), "stress at failure; a quantity in Pa, above 0; required");
/// assert_eq!(RULE.to_string(), "inertia of a cell; `cubic`: consistent, or `linear`: lumped; default `cubic`");
/// ```
///
/// ```compile_fail
/// # use fem_core::plugin::ParamInfo;
/// const WEIGHT: ParamInfo = ParamInfo::number("beta", "a default outside of the range").at_most(1.0).default(2.0);
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct ParamInfo {
    /// Key in the scene.
    pub name: &'static str,
    /// What it means; type, range and default are said by the other fields.
    pub about: &'static str,
    /// What a value is.
    pub form: ParamForm,
    /// Smallest and largest number, count or quantity in SI.
    pub range: (Bound<f64>, Bound<f64>),
    /// What holds where it is not given.
    pub default: ParamDefault,
    /// What it is to those who know no single plug-in.
    pub role: Role,
}

/// What a value of a parameter is.
#[derive(Debug, Clone, Copy)]
pub enum ParamForm {
    /// A number without unit.
    Number,
    /// A whole number, not negative.
    Count,
    /// A number with a unit.
    Quantity(Unit),
    /// One of these words, each with what it means.
    Word(&'static [(&'static str, &'static str)]),
    /// `true` or `false`.
    Flag,
    /// A text such as a formula, or a list of texts.
    Texts,
}

/// The dimension of a quantity.
#[derive(Debug, Clone, Copy)]
pub enum Unit {
    /// Always this one.
    Of(Dimension),
    /// That which follows from the number of another parameter: of k in F = k αⁿ from n.
    Follows(&'static ParamInfo, fn(f64) -> Dimension),
}

/// What holds where a parameter is not given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParamDefault {
    /// The scene is refused.
    Required,
    /// Nothing: the plug-in does without, or finds the value itself.
    Nothing,
    /// A number, a count, or a quantity in SI.
    Number(f64),
    /// A word.
    Word(&'static str),
    /// A flag.
    Flag(bool),
}

/// What a parameter is to studies and forecasts, which know no single plug-in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Its plug-in's own affair.
    Own,
    /// A count: how many vectors a reduction makes, contacts aside. Memory and time follow from it, studies halve and double it.
    Size,
    /// A count: Gauss points of an element per in-plane direction, which studies vary.
    Quadrature,
    /// Words: forms of an element's inertia. Studies compare them, where anything moves.
    Inertia,
    /// Words: other ways to the same answer, which studies compare.
    Way,
}

/// Largest count: more is a slip.
const MOST_COUNT: f64 = 1e9;

impl ParamInfo {
    const fn new(name: &'static str, about: &'static str, form: ParamForm, default: ParamDefault) -> Self {
        Self { name, about, form, range: (Unbounded, Unbounded), default, role: Role::Own }
    }

    /// A number without unit; required unless more is said.
    pub const fn number(name: &'static str, about: &'static str) -> Self {
        Self::new(name, about, ParamForm::Number, ParamDefault::Required)
    }

    /// A whole number, not negative; required unless more is said.
    pub const fn count(name: &'static str, about: &'static str) -> Self {
        let row = Self::new(name, about, ParamForm::Count, ParamDefault::Required);
        Self { range: (Included(0.0), Included(MOST_COUNT)), ..row }
    }

    /// A quantity of a dimension; required unless more is said.
    ///
    /// # Panics
    /// Where there is no dimension (a constant does not compile): a pure number is [`ParamInfo::number`].
    pub const fn quantity(name: &'static str, about: &'static str, dimension: Dimension) -> Self {
        let [m, kg, s, kelvin] = dimension.0;
        assert!(m != 0.0 || kg != 0.0 || s != 0.0 || kelvin != 0.0, "a quantity needs a dimension");
        Self::new(name, about, ParamForm::Quantity(Unit::Of(dimension)), ParamDefault::Required)
    }

    /// A quantity whose dimension follows from the number of `other`, a row with a default; required unless more is said.
    ///
    /// # Panics
    /// Where `other` has no default (a constant does not compile).
    pub const fn quantity_by(
        name: &'static str,
        about: &'static str,
        other: &'static Self,
        dimension: fn(f64) -> Dimension,
    ) -> Self {
        assert!(matches!(other.default, ParamDefault::Number(_)), "the other parameter needs a default");
        Self::new(name, about, ParamForm::Quantity(Unit::Follows(other, dimension)), ParamDefault::Required)
    }

    /// One of some words; the first is the default.
    ///
    /// # Panics
    /// Without a word (a constant does not compile).
    pub const fn word(name: &'static str, about: &'static str, words: &'static [(&'static str, &'static str)]) -> Self {
        assert!(!words.is_empty(), "there must be a word to choose");
        Self::new(name, about, ParamForm::Word(words), ParamDefault::Word(words[0].0))
    }

    /// `true` or `false`, by default `false`.
    pub const fn flag(name: &'static str, about: &'static str) -> Self {
        Self::new(name, about, ParamForm::Flag, ParamDefault::Flag(false))
    }

    /// A text, or a list of texts; required unless more is said.
    pub const fn texts(name: &'static str, about: &'static str) -> Self {
        Self::new(name, about, ParamForm::Texts, ParamDefault::Required)
    }

    /// Not below `least`.
    ///
    /// # Panics
    /// Where no value is left, or the default is none (a constant does not compile). So do all the following.
    #[must_use]
    pub const fn at_least(self, least: f64) -> Self {
        Self { range: (Included(least), self.range.1), ..self }.sound()
    }

    /// Above `least`.
    #[must_use]
    pub const fn above(self, least: f64) -> Self {
        Self { range: (Excluded(least), self.range.1), ..self }.sound()
    }

    /// Not above `most`.
    #[must_use]
    pub const fn at_most(self, most: f64) -> Self {
        Self { range: (self.range.0, Included(most)), ..self }.sound()
    }

    /// Below `most`.
    #[must_use]
    pub const fn below(self, most: f64) -> Self {
        Self { range: (self.range.0, Excluded(most)), ..self }.sound()
    }

    /// This number, count or quantity in SI where it is not given.
    #[must_use]
    pub const fn default(self, value: f64) -> Self {
        Self { default: ParamDefault::Number(value), ..self }.sound()
    }

    /// May be left out, without a default.
    #[must_use]
    pub const fn optional(self) -> Self {
        Self { default: ParamDefault::Nothing, ..self }
    }

    /// What it is to studies and forecasts.
    #[must_use]
    pub const fn role(self, role: Role) -> Self {
        Self { role, ..self }
    }

    const fn sound(self) -> Self {
        let numeric = matches!(self.form, ParamForm::Number | ParamForm::Count | ParamForm::Quantity(_));
        assert!(numeric, "only numbers have a range or a number as default");
        let (least, most) = self.range;
        let some = match (least, most) {
            (Included(least), Included(most)) => least <= most,
            (Included(least) | Excluded(least), Included(most) | Excluded(most)) => least < most,
            _ => true,
        };
        assert!(some, "the range is empty");
        if let ParamDefault::Number(value) = self.default {
            let fits_below = match most {
                Included(most) => value <= most,
                Excluded(most) => value < most,
                Unbounded => true,
            };
            let fits_above = match least {
                Included(least) => value >= least,
                Excluded(least) => value > least,
                Unbounded => true,
            };
            assert!(fits_below && fits_above, "the default is out of range");
        }
        self
    }

    /// Dimension of a quantity, where another parameter decides it at that one's default.
    pub fn dimension(&self) -> Option<Dimension> {
        match self.form {
            ParamForm::Quantity(Unit::Of(dimension)) => Some(dimension),
            ParamForm::Quantity(Unit::Follows(other, of)) => match other.default {
                ParamDefault::Number(value) => Some(of(value)),
                _ => None,
            },
            _ => None,
        }
    }

    /// The default of a number, a count or a quantity in SI.
    ///
    /// # Panics
    /// Where there is none (a constant does not compile).
    pub const fn default_number(&self) -> f64 {
        assert!(matches!(self.default, ParamDefault::Number(_)), "no number holds by default");
        if let ParamDefault::Number(value) = self.default { value } else { f64::NAN }
    }

    /// The default as a scene could give it.
    pub fn default_value(&self) -> Option<Value> {
        match (self.default, self.dimension()) {
            (ParamDefault::Required | ParamDefault::Nothing, _) => None,
            (ParamDefault::Number(value), None) => Some(Value::Number(value)),
            (ParamDefault::Number(value), Some(dimension)) => Some(Value::Quantity(value, dimension)),
            (ParamDefault::Word(word), _) => Some(Value::Text(word.to_owned())),
            (ParamDefault::Flag(flag), _) => Some(Value::Flag(flag)),
        }
    }

    /// What it may be, in words: "a quantity in N/m^1.5 (n = 1.5), above 0". `at` is the number that decides the dimension,
    /// where another parameter does, else its default.
    pub(super) fn allowed(&self, at: Option<f64>) -> String {
        let (unit, what) = match self.form {
            ParamForm::Number => (String::new(), "a number".to_owned()),
            ParamForm::Count => (String::new(), "a whole number".to_owned()),
            ParamForm::Quantity(Unit::Of(dimension)) => (format!(" {dimension}"), format!("a quantity in {dimension}")),
            ParamForm::Quantity(Unit::Follows(other, of)) => {
                let at = match (at, other.default) {
                    (Some(at), _) | (None, ParamDefault::Number(at)) => at,
                    _ => f64::NAN,
                };
                let unit = of(at);
                (format!(" {unit}"), format!("a quantity in {unit} ({} = {})", other.name, short(at)))
            }
            ParamForm::Word(words) => {
                let each = words.iter().map(|(word, means)| match *means {
                    "" => format!("`{word}`"),
                    means => format!("`{word}`: {means}"),
                });
                return each.collect::<Vec<_>>().join(", or ");
            }
            ParamForm::Flag => return "`true` or `false`".to_owned(),
            ParamForm::Texts => return "a text or a list of texts".to_owned(),
        };
        let number = |v: f64| if v == 0.0 { "0".to_owned() } else { format!("{}{unit}", short(v)) };
        // The bounds that every count has need no words.
        let count = matches!(self.form, ParamForm::Count);
        let (least, most) = match self.range {
            (Included(0.0), Included(MOST_COUNT)) if count => (Unbounded, Unbounded),
            (least, Included(MOST_COUNT)) if count => (least, Unbounded),
            range => range,
        };
        let range = match (least, most) {
            (Included(a), Included(b)) => format!("{} to {}", number(a), number(b)),
            (a, b) => {
                let least = match a {
                    Included(a) => Some(format!("at least {}", number(a))),
                    Excluded(a) => Some(format!("above {}", number(a))),
                    Unbounded => None,
                };
                let most = match b {
                    Included(b) => Some(format!("at most {}", number(b))),
                    Excluded(b) => Some(format!("below {}", number(b))),
                    Unbounded => None,
                };
                [least, most].into_iter().flatten().collect::<Vec<_>>().join(" and ")
            }
        };
        match (&self.form, range.as_str()) {
            (_, "") => what,
            (ParamForm::Quantity(_), range) => format!("{what}, {range}"),
            (ParamForm::Number | ParamForm::Count, range) if range.starts_with(['a', 'b']) => format!("{what} {range}"),
            (_, range) => format!("{what} from {range}"),
        }
    }

    /// Holds a value against the row; `at` as in [`ParamInfo::allowed`].
    pub(super) fn check(&self, value: &Value, at: Option<f64>) -> Result<(), ParamError> {
        let inside = |v: &f64| v.is_finite() && self.range.contains(v);
        let fits = match (self.form, value) {
            (ParamForm::Number, Value::Number(v)) => inside(v),
            (ParamForm::Count, Value::Number(v)) => inside(v) && v.fract() == 0.0,
            (ParamForm::Quantity(Unit::Of(dimension)), Value::Quantity(v, d)) => inside(v) && d.matches(&dimension),
            (ParamForm::Quantity(Unit::Follows(_, of)), Value::Quantity(v, d)) => {
                inside(v) && at.is_some_and(|at| d.matches(&of(at)))
            }
            (ParamForm::Word(words), Value::Text(text)) => words.iter().any(|(word, _)| word == text),
            (ParamForm::Flag, Value::Flag(_)) | (ParamForm::Texts, Value::Text(_)) => true,
            (ParamForm::Texts, Value::List(items)) => items.iter().all(|item| matches!(item, Value::Text(_))),
            _ => false,
        };
        let why = || format!("must be {}, got {value}", self.allowed(at));
        if fits { Ok(()) } else { Err(ParamError::new(self.name, why())) }
    }
}

/// Meaning, what is allowed, default.
impl fmt::Display for ParamInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.about, self.allowed(None))?;
        match (self.default, self.dimension()) {
            (ParamDefault::Required, _) => write!(f, "; required"),
            (ParamDefault::Nothing, _) => Ok(()),
            (ParamDefault::Number(value), None) => write!(f, "; default {}", short(value)),
            (ParamDefault::Number(value), Some(unit)) => write!(f, "; default {} {unit}", short(value)),
            (ParamDefault::Word(word), _) => write!(f, "; default `{word}`"),
            (ParamDefault::Flag(flag), _) => write!(f, "; default `{flag}`"),
        }
    }
}
