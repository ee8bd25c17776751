//! Values of parameters, and what is wrong with one.

use super::dimension::Dimension;
use std::fmt;

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

impl Value {
    /// As a scene writes it, in TOML.
    pub fn in_scene(&self) -> String {
        match self {
            Value::Number(v) => decimal(*v),
            Value::Quantity(v, d) if *d == Dimension::NONE => format!("\"{} rad\"", decimal(*v)),
            Value::Quantity(v, d) => format!("\"{} {d}\"", decimal(*v)),
            Value::Text(text) => format!("{text:?}"),
            Value::Flag(flag) => flag.to_string(),
            Value::List(items) => {
                format!("[{}]", items.iter().map(Value::in_scene).collect::<Vec<_>>().join(", "))
            }
        }
    }
}

/// For errors.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Number(v) => write!(f, "the bare number {}", short(*v)),
            Value::Quantity(v, d) if *d == Dimension::NONE => write!(f, "{} rad", short(*v)),
            Value::Quantity(v, d) => write!(f, "{} {d}", short(*v)),
            Value::Text(t) => write!(f, "`{t}`"),
            Value::Flag(b) => write!(f, "{b}"),
            Value::List(l) => write!(f, "a list of {} values", l.len()),
        }
    }
}

/// A number in its shorter form, decimal or with a power of ten.
fn decimal(v: f64) -> String {
    let (plain, power) = (v.to_string(), format!("{v:e}"));
    if plain.len() <= power.len() { plain } else { power }
}

/// A number for people; thirds as such, where they are exact.
pub(super) fn short(v: f64) -> String {
    let (decimal, thirds) = (decimal(v), 3.0 * v);
    let third = format!("{thirds}/3");
    let exact = thirds.fract() == 0.0 && thirds / 3.0 == v;
    if exact && third.len() < decimal.len() { third } else { decimal }
}

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
