//! How a plug-in introduces itself and receives its parameters.

use crate::contracts::contact::ContactLaw;
use crate::contracts::element::Element;
use crate::contracts::failure::FailureCriterion;
use crate::contracts::interface_law::InterfaceLaw;
use crate::contracts::ply_law::PlyLaw;
use crate::contracts::reduction::Reduction;
use crate::contracts::time::Integrator;
use std::collections::BTreeMap;
use std::fmt;

pub use crate::words::spelling::unknown_key;

/// Exponents of length, mass, time and temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dimension(pub [f64; 4]);

#[allow(missing_docs)]
impl Dimension {
    pub const NONE: Self = Self([0.0; 4]);
    pub const LENGTH: Self = Self([1.0, 0.0, 0.0, 0.0]);
    pub const MASS: Self = Self([0.0, 1.0, 0.0, 0.0]);
    pub const TIME: Self = Self([0.0, 0.0, 1.0, 0.0]);
    pub const TEMPERATURE: Self = Self([0.0, 0.0, 0.0, 1.0]);
    pub const EXPANSION: Self = Self([0.0, 0.0, 0.0, -1.0]);
    pub const VELOCITY: Self = Self([1.0, 0.0, -1.0, 0.0]);
    pub const ACCELERATION: Self = Self([1.0, 0.0, -2.0, 0.0]);
    pub const FREQUENCY: Self = Self([0.0, 0.0, -1.0, 0.0]);
    pub const FORCE: Self = Self([1.0, 1.0, -2.0, 0.0]);
    pub const ENERGY: Self = Self([2.0, 1.0, -2.0, 0.0]);
    pub const PRESSURE: Self = Self([-1.0, 1.0, -2.0, 0.0]);
    pub const DENSITY: Self = Self([-3.0, 1.0, 0.0, 0.0]);
    /// Energy per area, as of a fracture toughness.
    pub const TOUGHNESS: Self = Self([0.0, 1.0, -2.0, 0.0]);

    /// Force per length to the power `n`: the stiffness of a contact law F = k αⁿ.
    pub fn contact_stiffness(n: f64) -> Self {
        Self([1.0 - n, 1.0, -2.0, 0.0])
    }

    /// Equal to rounding (exponents may be fractions).
    pub fn matches(&self, other: &Self) -> bool {
        self.0.iter().zip(other.0).all(|(a, b)| (a - b).abs() < 1e-9)
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut first = true;
        for (exponent, unit) in self.0.iter().zip(["m", "kg", "s", "K"]) {
            if *exponent != 0.0 {
                write!(f, "{}{unit}", if first { "" } else { " " })?;
                if *exponent != 1.0 {
                    write!(f, "^{exponent}")?;
                }
                first = false;
            }
        }
        if first { write!(f, "a pure number") } else { Ok(()) }
    }
}

/// A parameter's value as a scene gives it.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A bare number.
    Number(f64),
    /// A number with its unit, in SI.
    Quantity(f64, Dimension),
    /// A text that is not a quantity.
    Text(String),
    /// `true` or `false`.
    Flag(bool),
    /// Several values.
    List(Vec<Value>),
}

/// What a plug-in says of one of its parameters.
#[derive(Debug, Clone, Copy)]
pub struct ParamInfo {
    /// Key in the scene.
    pub name: &'static str,
    /// Meaning, unit and default in a few words.
    pub doc: &'static str,
}

/// Parameters of one plug-in, SI units.
#[derive(Debug, Clone, Default)]
pub struct Params(BTreeMap<String, Value>);

/// A parameter that a plug-in cannot take.
#[derive(Debug, Clone, PartialEq)]
pub struct ParamError {
    /// The key it is about; empty when it is about the whole table.
    pub key: String,
    /// What is wrong and what would be right.
    pub why: String,
}

impl ParamError {
    /// An error about `key`.
    pub fn new(key: impl Into<String>, why: impl Into<String>) -> Self {
        Self { key: key.into(), why: why.into() }
    }
}

impl fmt::Display for ParamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.key.is_empty() { write!(f, "{}", self.why) } else { write!(f, "`{}`: {}", self.key, self.why) }
    }
}
impl std::error::Error for ParamError {}

impl Params {
    /// Sets a parameter; used by scene readers and tests.
    #[must_use]
    pub fn with(mut self, key: &str, value: Value) -> Self {
        self.0.insert(key.to_owned(), value);
        self
    }

    /// Sets a parameter.
    pub fn insert(&mut self, key: impl Into<String>, value: Value) {
        self.0.insert(key.into(), value);
    }

    /// Sets a parameter unless it is there.
    pub fn insert_default(&mut self, key: &str, value: Value) {
        self.0.entry(key.to_owned()).or_insert(value);
    }

    /// The keys, sorted.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// The value as it was given.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.get(key)
    }

    /// A pure number; finite.
    ///
    /// # Errors
    /// Missing without a default, or no finite pure number.
    pub fn number(&self, key: &str, default: Option<f64>) -> Result<f64, ParamError> {
        match self.0.get(key) {
            None => default.ok_or_else(|| ParamError::new(key, "is missing (a number)")),
            Some(Value::Number(v)) if v.is_finite() => Ok(*v),
            Some(other) => Err(ParamError::new(key, format!("must be a finite number, got {other}"))),
        }
    }

    /// A whole number of at least `least`.
    ///
    /// # Errors
    /// Missing without a default, or no whole number in range.
    pub fn count(&self, key: &str, least: usize, default: Option<usize>) -> Result<usize, ParamError> {
        let v = self.number(key, default.map(|d| d as f64))?;
        if v.fract() != 0.0 || v < least as f64 || v > 1e9 {
            return Err(ParamError::new(key, format!("must be a whole number of at least {least}, got {v}")));
        }
        Ok(v as usize)
    }

    /// A quantity of dimension `dim`, in SI; finite.
    ///
    /// # Errors
    /// Missing without a default, a bare number, another dimension.
    pub fn quantity(&self, key: &str, dim: Dimension, default: Option<f64>) -> Result<f64, ParamError> {
        match self.0.get(key) {
            None => default.ok_or_else(|| ParamError::new(key, format!("is missing (a quantity in {dim})"))),
            Some(Value::Quantity(v, d)) if d.matches(&dim) && v.is_finite() => Ok(*v),
            Some(Value::Quantity(_, d)) => {
                Err(ParamError::new(key, format!("has the wrong dimension: {d} where {dim} is needed")))
            }
            Some(other) => Err(ParamError::new(key, format!("needs a number with a unit ({dim}), got {other}"))),
        }
    }

    /// A quantity that must be positive.
    ///
    /// # Errors
    /// As [`Params::quantity`], and zero or negative values.
    pub fn positive(&self, key: &str, dim: Dimension, default: Option<f64>) -> Result<f64, ParamError> {
        let v = self.quantity(key, dim, default)?;
        if v > 0.0 { Ok(v) } else { Err(ParamError::new(key, format!("must be positive, got {v} (SI)"))) }
    }

    /// One word out of `choices`; the first is the default.
    ///
    /// # Errors
    /// Any other word.
    pub fn choice<'a>(&self, key: &str, choices: &[&'a str]) -> Result<&'a str, ParamError> {
        let Some(value) = self.0.get(key) else { return Ok(choices[0]) };
        let text = match value {
            Value::Text(t) => t.as_str(),
            _ => "",
        };
        choices
            .iter()
            .find(|c| **c == text)
            .copied()
            .ok_or_else(|| ParamError::new(key, format!("must be one of {}, got {value}", choices.join(", "))))
    }

    /// Refuses keys that `known` does not list.
    ///
    /// # Errors
    /// The first unknown key, with the keys that are known.
    pub fn only(&self, known: &[ParamInfo]) -> Result<(), ParamError> {
        match self.0.keys().find(|k| known.iter().all(|p| p.name != k.as_str())) {
            None => Ok(()),
            Some(key) => Err(ParamError::new(key.clone(), unknown_key(key, known.iter().map(|p| p.name)))),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Number(v) => write!(f, "the bare number {v}"),
            Value::Quantity(v, d) => write!(f, "{v} in {d}"),
            Value::Text(t) => write!(f, "`{t}`"),
            Value::Flag(b) => write!(f, "{b}"),
            Value::List(l) => write!(f, "a list of {} values", l.len()),
        }
    }
}

/// A built plug-in of whichever kind.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Built {
    /// An element.
    Element(Box<dyn Element>),
    /// A failure criterion.
    Criterion(Box<dyn FailureCriterion>),
    /// A contact law.
    Contact(Box<dyn ContactLaw>),
    /// A time integrator.
    Integrator(Box<dyn Integrator>),
    /// A reduction.
    Reduction(Box<dyn Reduction>),
    /// A law of a ply.
    PlyLaw(Box<dyn PlyLaw>),
    /// A law of an interface.
    InterfaceLaw(Box<dyn InterfaceLaw>),
}

/// Kind of a plug-in; a name is unique within its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum Kind {
    Element,
    Criterion,
    Contact,
    Integrator,
    Reduction,
    PlyLaw,
    InterfaceLaw,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Kind::Element => "element",
            Kind::Criterion => "criterion",
            Kind::Contact => "contact law",
            Kind::Integrator => "integrator",
            Kind::Reduction => "reduction",
            Kind::PlyLaw => "ply law",
            Kind::InterfaceLaw => "interface law",
        })
    }
}

/// One entry of the registry: what lists, documentation and scene errors show.
#[derive(Debug, Clone, Copy)]
pub struct PluginInfo {
    /// What it is.
    pub kind: Kind,
    /// Name in scenes, kebab-case.
    pub name: &'static str,
    /// One line for people.
    pub summary: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// Its parameters.
    pub params: &'static [ParamInfo],
}

/// A plug-in: an entry for the registry and a constructor from parameters.
///
/// ```
/// use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
/// # use fem_core::contact::{ContactForce, ContactHistory, ContactLaw};
/// # use fem_core::energy::Energy;
/// # #[derive(Debug, Clone)] struct Spring;
/// # impl ContactLaw for Spring {
/// #   fn force(&self, _: &ContactHistory, a: f64) -> ContactForce { ContactForce { force: a.max(0.0), tangent: 1.0 } }
/// #   fn commit(&self, _: &mut ContactHistory, _: f64) {}
/// #   fn energy(&self, _: &ContactHistory, _: f64) -> Energy { Energy::default() }
/// # }
/// impl Plugin for Spring {
///     const INFO: PluginInfo = PluginInfo {
///         kind: Kind::Contact,
///         name: "my-spring",
///         summary: "unit spring",
///         source: "an example",
///         params: &[],
///     };
///     fn build(_: &Params) -> Result<Built, ParamError> {
///         Ok(Built::Contact(Box::new(Spring)))
///     }
/// }
/// ```
pub trait Plugin {
    /// Entry in the registry.
    const INFO: PluginInfo;

    /// Builds it; keys that [`PluginInfo::params`] does not list never arrive here.
    ///
    /// # Errors
    /// A parameter that is missing or out of range, by name.
    fn build(params: &Params) -> Result<Built, ParamError>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_checked() {
        let p = Params::default()
            .with("k", Value::Quantity(3.0, Dimension::PRESSURE))
            .with("n", Value::Number(1.5))
            .with("rule", Value::Text("elastic".into()));
        assert_eq!(p.quantity("k", Dimension::PRESSURE, None), Ok(3.0));
        assert!(p.quantity("k", Dimension::LENGTH, None).unwrap_err().why.contains("dimension"));
        assert!(p.quantity("n", Dimension::LENGTH, None).unwrap_err().why.contains("unit"));
        assert!(p.count("n", 1, None).is_err());
        assert_eq!(p.choice("rule", &["n", "elastic"]), Ok("elastic"));
        assert_eq!(p.choice("other", &["n", "elastic"]), Ok("n"));
        let known = [ParamInfo { name: "kk", doc: "" }, ParamInfo { name: "n", doc: "" }];
        assert!(p.only(&known).unwrap_err().why.contains("did you mean `kk`"));
        assert_eq!(Dimension::contact_stiffness(1.5).to_string(), "m^-0.5 kg s^-2");
    }
}
