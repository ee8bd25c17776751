//! The parameters of one plug-in, read by their rows.

use super::row::{ParamDefault, ParamForm, ParamInfo, Unit};
use super::value::{ParamError, Value};
use crate::words::spelling::unknown_key;
use std::collections::BTreeMap;

/// Parameters of one plug-in as a scene gives them, SI units; read by the rows that describe them.
#[derive(Debug, Clone, Default)]
pub struct Params(BTreeMap<String, Value>);

impl Params {
    /// Sets a parameter; used by scene readers and tests.
    #[must_use]
    pub fn with(mut self, key: &str, value: Value) -> Self {
        self.insert(key, value);
        self
    }

    /// Sets a parameter.
    pub fn insert(&mut self, key: impl Into<String>, value: Value) {
        self.0.insert(key.into(), value);
    }

    /// The keys, sorted.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// The value as it was given.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.get(key)
    }

    /// Whether the parameter of a row was given.
    pub fn has(&self, row: &ParamInfo) -> bool {
        self.0.contains_key(row.name)
    }

    /// Holds all parameters against the rows of their plug-in.
    ///
    /// # Errors
    /// A key without a row, a value that its row does not allow, a required one that is missing.
    pub fn check(&self, rows: &[ParamInfo]) -> Result<(), ParamError> {
        if let Some(key) = self.0.keys().find(|key| rows.iter().all(|row| row.name != key.as_str())) {
            return Err(ParamError::new(key.clone(), unknown_key(key, rows.iter().map(|row| row.name))));
        }
        rows.iter().try_for_each(|row| self.value(row).map(|_| ()))
    }

    /// The value of a row or its default; nothing for one that may be left out and is.
    ///
    /// # Errors
    /// A value that the row does not allow, a required one that is missing.
    pub fn value(&self, row: &ParamInfo) -> Result<Option<Value>, ParamError> {
        let at = match row.form {
            ParamForm::Quantity(Unit::Follows(other, _)) => Some(self.number(other)?),
            _ => None,
        };
        match self.0.get(row.name) {
            Some(value) => row.check(value, at).map(|()| Some(value.clone())),
            None if row.default == ParamDefault::Required => Err(missing(row, at)),
            None => Ok(row.default_value()),
        }
    }

    /// A number, or a quantity in SI.
    ///
    /// # Errors
    /// As [`Params::value`], and none where there is no default either.
    pub fn number(&self, row: &ParamInfo) -> Result<f64, ParamError> {
        match self.value(row)? {
            Some(Value::Number(v) | Value::Quantity(v, _)) => Ok(v),
            other => Err(unread(row, other)),
        }
    }

    /// A count.
    ///
    /// # Errors
    /// As [`Params::number`].
    pub fn count(&self, row: &ParamInfo) -> Result<usize, ParamError> {
        match (row.form, self.value(row)?) {
            (ParamForm::Count, Some(Value::Number(v))) => Ok(v as usize),
            (_, other) => Err(unread(row, other)),
        }
    }

    /// One of the words of a row.
    ///
    /// # Errors
    /// As [`Params::number`].
    pub fn word(&self, row: &ParamInfo) -> Result<&'static str, ParamError> {
        let value = self.value(row)?;
        match (row.form, &value) {
            (ParamForm::Word(words), Some(Value::Text(text))) => {
                words.iter().map(|(word, _)| *word).find(|word| word == text).ok_or_else(|| unread(row, value))
            }
            _ => Err(unread(row, value)),
        }
    }

    /// A flag.
    ///
    /// # Errors
    /// As [`Params::number`].
    pub fn flag(&self, row: &ParamInfo) -> Result<bool, ParamError> {
        match self.value(row)? {
            Some(Value::Flag(flag)) => Ok(flag),
            other => Err(unread(row, other)),
        }
    }
}

fn missing(row: &ParamInfo, at: Option<f64>) -> ParamError {
    ParamError::new(row.name, format!("is missing; it must be {}", row.allowed(at)))
}

/// Nothing where a value is needed, or a value of another form than the plug-in reads.
fn unread(row: &ParamInfo, value: Option<Value>) -> ParamError {
    match value {
        None => missing(row, None),
        Some(value) => ParamError::new(row.name, format!("is declared as {}, but read as something else", value)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plugin::Dimension;

    const N: ParamInfo = ParamInfo::number("n", "exponent").at_least(1.0).below(4.0).default(1.5);
    const K: ParamInfo = ParamInfo::quantity_by("k", "stiffness", &N, Dimension::contact_stiffness).above(0.0);
    const SIZE: ParamInfo = ParamInfo::count("vectors", "vectors in all").at_least(2.0).default(60.0);
    const RULE: ParamInfo = ParamInfo::word("rule", "rule", &[("elastic", ""), ("plastic", "yields")]);
    const STRICT: ParamInfo = ParamInfo::flag("strict", "refuses");
    const FORMULA: ParamInfo = ParamInfo::texts("formula", "formula").optional();
    const DEPTH: ParamInfo = ParamInfo::quantity("depth", "depth", Dimension::LENGTH).at_least(1e-3).optional();
    const ROWS: [ParamInfo; 7] = [K, N, SIZE, RULE, STRICT, FORMULA, DEPTH];

    fn stiffness(n: f64) -> Params {
        Params::default().with("k", Value::Quantity(3.0, Dimension::contact_stiffness(n)))
    }

    fn text(text: &str) -> Value {
        Value::Text(text.into())
    }

    #[test]
    fn values_and_defaults_are_read() {
        let given = stiffness(3.0).with("n", Value::Number(3.0)).with("rule", text("plastic"));
        let given = given.with("vectors", Value::Number(5.0)).with("strict", Value::Flag(true));
        assert_eq!(given.check(&ROWS), Ok(()));
        assert_eq!((given.number(&K), given.number(&N)), (Ok(3.0), Ok(3.0)));
        assert_eq!((given.word(&RULE), given.count(&SIZE)), (Ok("plastic"), Ok(5)));
        assert_eq!(given.flag(&STRICT), Ok(true));
        let bare = stiffness(1.5);
        assert_eq!(bare.check(&ROWS), Ok(()));
        assert_eq!((bare.word(&RULE), bare.count(&SIZE)), (Ok("elastic"), Ok(60)));
        assert_eq!((bare.number(&N), bare.flag(&STRICT)), (Ok(1.5), Ok(false)));
        assert_eq!((bare.value(&FORMULA), bare.value(&DEPTH)), (Ok(None), Ok(None)));
    }

    #[test]
    fn what_a_row_does_not_allow_is_refused_with_what_it_allows() {
        let why = |params: Params| params.check(&ROWS).unwrap_err().to_string();
        assert_eq!(why(Params::default()), "`k`: is missing; it must be a quantity in N/m^1.5 (n = 1.5), above 0");
        let other = why(stiffness(1.5).with("n", Value::Number(3.0)));
        assert_eq!(other, "`k`: must be a quantity in N/m^3 (n = 3), above 0, got 3 N/m^1.5");
        let with = |key: &str, value: Value| why(stiffness(1.5).with(key, value));
        assert_eq!(
            with("n", Value::Number(4.0)),
            "`n`: must be a number at least 1 and below 4, got the bare number 4"
        );
        assert_eq!(
            with("n", Value::Number(f64::NAN)),
            "`n`: must be a number at least 1 and below 4, got the bare number NaN"
        );
        assert!(with("vectors", Value::Number(1.0)).contains("a whole number at least 2"));
        assert!(with("vectors", Value::Number(2.5)).contains("a whole number at least 2"));
        assert_eq!(with("rule", text("soft")), "`rule`: must be `elastic`, or `plastic`: yields, got `soft`");
        assert!(with("strict", text("true")).contains("must be `true` or `false`"));
        assert!(with("formula", Value::List(vec![Value::Number(1.0)])).contains("a text or a list of texts"));
        let depth = |value| with("depth", value);
        assert!(depth(Value::Number(1.0)).ends_with("a quantity in m, at least 1e-3 m, got the bare number 1"));
        assert!(depth(Value::Quantity(1e-4, Dimension::LENGTH)).ends_with("got 1e-4 m"));
        assert!(with("rul", text("soft")).contains("did you mean `rule`"));
    }

    #[test]
    fn a_row_read_as_something_else_is_an_error() {
        let params = stiffness(1.5);
        assert!(params.count(&N).is_err() && params.number(&RULE).is_err() && params.word(&N).is_err());
        assert!(params.flag(&SIZE).is_err() && params.number(&DEPTH).unwrap_err().why.contains("missing"));
    }
}
