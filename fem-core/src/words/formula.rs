//! Formulas that people write: checked, compiled, evaluated.
//!
//! What could be read in two ways (`2 s1`, `a^b^c`, a comparison without brackets) is refused. `-s1^2` is −(s1²).

mod bounds;
mod powers;

pub use powers::PowerError;

use crate::words::spelling::unknown_key;
use std::fmt;

type Function = fn(f64) -> f64;
type Binary = fn(f64, f64) -> f64;

const FUNCTIONS: [(&str, Function); 8] = [
    ("abs", f64::abs),
    ("sqrt", f64::sqrt),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("pos", positive_part),
];

/// Longest formula, bytes, and deepest brackets: more is a mistake, and would take long to compile.
const MAX_LENGTH: usize = 4096;
const MAX_DEPTH: usize = 64;

/// Operators with their priority: the higher, the tighter they bind.
const OPERATORS: [(&str, u8, Binary); 9] = [
    ("<", 0, |a, b| truth(a, b, a < b)),
    ("<=", 0, |a, b| truth(a, b, a <= b)),
    (">", 0, |a, b| truth(a, b, a > b)),
    (">=", 0, |a, b| truth(a, b, a >= b)),
    ("+", 1, |a, b| a + b),
    ("-", 1, |a, b| a - b),
    ("*", 2, |a, b| a * b),
    ("/", 2, |a, b| a / b),
    ("^", 3, power),
];

/// The argument where it is positive, else 0; NaN stays NaN.
fn positive_part(x: f64) -> f64 {
    if x < 0.0 { 0.0 } else { x }
}

/// a to the power of b; NaN where one of the two is NaN, also for b = 0 and a = 1.
fn power(a: f64, b: f64) -> f64 {
    match b {
        2.0 => a * a,
        _ if a.is_nan() || b.is_nan() => f64::NAN,
        _ => a.powf(b),
    }
}

/// 1 or 0; NaN where one of the two is NaN.
fn truth(a: f64, b: f64, holds: bool) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { f64::from(u8::from(holds)) }
}

/// Why a text is not a formula.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum FormulaError {
    /// There is nothing in it.
    Empty,
    /// It is longer than a formula may be.
    TooLong,
    /// Its brackets nest deeper than a formula's may.
    TooDeep,
    /// Two values follow each other; the second begins with this.
    MissingOperator(String),
    /// A value should stand before this, or at the end.
    MissingValue(Option<String>),
    /// A function without brackets.
    MissingBrackets(String),
    /// A number that cannot be read or is not finite.
    Number(String),
    /// A name that stands for nothing, with the names that do.
    Name(String),
    /// A symbol that formulas do not have.
    Symbol(String),
    /// `)` without `(`.
    Unopened,
    /// `(` without `)`.
    Unclosed,
    /// `a^b^c`.
    TwoPowers,
    /// A comparison with this that does not stand in brackets of its own.
    Comparison(String),
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "it is empty"),
            Self::TooLong => write!(f, "it has more than {MAX_LENGTH} characters"),
            Self::TooDeep => write!(f, "brackets nest at most {MAX_DEPTH} deep"),
            Self::MissingOperator(token) => write!(f, "an operator is missing before `{token}`"),
            Self::MissingValue(None) => write!(f, "a value is missing at the end"),
            Self::MissingValue(Some(token)) => {
                let signed = matches!(token.as_str(), "+" | "-");
                let help = if signed { ": put the signed value in brackets" } else { "" };
                write!(f, "a value is missing before `{token}`{help}")
            }
            Self::MissingBrackets(function) => write!(f, "`{function}` needs its argument in brackets"),
            Self::Number(token) => write!(f, "`{token}` is not a number"),
            Self::Name(unknown) => write!(f, "{unknown}"),
            Self::Symbol(token) => write!(f, "`{token}` means nothing in a formula"),
            Self::Unopened => write!(f, "a bracket is closed that was not opened"),
            Self::Unclosed => write!(f, "a bracket is not closed"),
            Self::TwoPowers => write!(f, "`a^b^c` can be read in two ways: use brackets"),
            Self::Comparison(operator) => write!(f, "the comparison with `{operator}` needs brackets of its own"),
        }
    }
}
impl std::error::Error for FormulaError {}

/// A step of a formula on a stack of values.
#[derive(Debug, Clone, Copy)]
enum Step {
    Number(f64),
    /// Counts in [`Formula::names`].
    Value(usize),
    Apply(Function),
    Combine(Binary),
}

/// A formula over named values.
///
/// Numbers, names, `+ - * / ^`, comparisons in brackets (1 or 0), and the functions `abs sqrt exp ln sin cos tan` and
/// `pos`; `pos(x)` is x where it is positive, else 0. NaN in, NaN out.
///
/// ```
/// use fem_core::formula::Formula;
///
/// let formula = Formula::parse("(b/2)^2 + pos(-b)", &["a", "b"])?;
/// assert_eq!(formula.names(), [1]); // of the two names it holds the second
/// assert_eq!(formula.value(&[-4.0]), 8.0);
/// assert!(Formula::parse("2 b", &["a", "b"]).is_err());
/// # Ok::<(), fem_core::formula::FormulaError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Formula {
    /// In the order in which they are carried out.
    steps: Vec<Step>,
    /// What each step stands for.
    sources: Vec<Source>,
    names: Vec<usize>,
    /// Values that the stack holds at most.
    depth: usize,
}

impl Formula {
    /// Reads a formula over values of these names.
    ///
    /// # Errors
    /// A text that is not a formula or can be read in two ways, and a name that is not among `names`.
    pub fn parse(text: &str, names: &[&str]) -> Result<Self, FormulaError> {
        Compiler::default().compile(text, names)
    }

    /// The names in it by their place in the list given to [`Formula::parse`], in the order in which [`Formula::value`]
    /// wants their values.
    pub fn names(&self) -> &[usize] {
        &self.names
    }

    /// Its value; NaN unless there is one value for each name.
    pub fn value(&self, values: &[f64]) -> f64 {
        if values.len() != self.names.len() {
            return f64::NAN;
        }
        let (mut few, mut many) = ([0.0; 16], Vec::new());
        let stack = if self.depth <= few.len() {
            &mut few[..]
        } else {
            many.resize(self.depth, 0.0);
            &mut many[..]
        };
        let mut top = 0;
        for step in &self.steps {
            match *step {
                Step::Number(number) => stack[top] = number,
                Step::Value(k) => stack[top] = values[k],
                Step::Apply(function) => {
                    top -= 1;
                    stack[top] = function(stack[top]);
                }
                Step::Combine(operator) => {
                    top -= 2;
                    stack[top] = operator(stack[top], stack[top + 1]);
                }
            }
            top += 1;
        }
        stack[0]
    }
}

/// An operator or a function, and the character where it stands, counted from 1.
type Source = (&'static str, usize);

/// Of numbers and names.
const NOWHERE: Source = ("", 0);

/// A bracket, or the whole text.
#[derive(Default)]
struct Level {
    /// Operators that wait for their second value, each of higher priority than the one before.
    waiting: Vec<(u8, Binary, Source)>,
    /// The operator before the last value.
    operator: &'static str,
    compared: bool,
    /// What the value of the bracket goes into.
    function: Option<(Function, Source)>,
}

#[derive(Default)]
struct Compiler {
    steps: Vec<Step>,
    sources: Vec<Source>,
    names: Vec<usize>,
    held: usize,
    depth: usize,
}

impl Compiler {
    fn push(&mut self, step: Step, source: Source) {
        match step {
            Step::Number(_) | Step::Value(_) => self.held += 1,
            Step::Apply(_) => {}
            Step::Combine(_) => self.held -= 1,
        }
        self.depth = self.depth.max(self.held);
        self.steps.push(step);
        self.sources.push(source);
    }

    /// Carries out what waits in `level` and binds at least as tightly as `priority`.
    fn combine(&mut self, level: &mut Level, priority: u8) {
        while let Some((_, operator, source)) = level.waiting.pop_if(|(waiting, ..)| *waiting >= priority) {
            self.push(Step::Combine(operator), source);
        }
    }

    fn compile(mut self, text: &str, known: &[&str]) -> Result<Formula, FormulaError> {
        if text.len() > MAX_LENGTH {
            return Err(FormulaError::TooLong);
        }
        let mut outer: Vec<Level> = Vec::new();
        let mut level = Level::default();
        let mut function = None;
        // A value must come next, else an operator or a closing bracket.
        let mut value_next = true;
        // Nothing stands yet in this bracket or on this side of the comparison.
        let mut opened = true;
        let mut rest = text.trim_start();
        while let Some(first) = rest.chars().next() {
            let (token, after) = rest.split_at(token_length(rest));
            let place = text[..text.len() - rest.len()].chars().count() + 1;
            if first.is_ascii_alphanumeric() || matches!(first, '_' | '.' | '(') {
                if !value_next {
                    return Err(FormulaError::MissingOperator(token.into()));
                }
                opened = false;
                value_next = false;
                if first == '(' {
                    if outer.len() == MAX_DEPTH {
                        return Err(FormulaError::TooDeep);
                    }
                    let inner = Level { function: function.take(), ..Level::default() };
                    outer.push(std::mem::replace(&mut level, inner));
                    (value_next, opened) = (true, true);
                } else if let Some((name, apply)) = FUNCTIONS.iter().find(|f| f.0 == token) {
                    if !after.trim_start().starts_with('(') {
                        return Err(FormulaError::MissingBrackets(token.into()));
                    }
                    function = Some((*apply, (*name, place)));
                    value_next = true;
                } else if first.is_ascii_alphabetic() || first == '_' {
                    self.push_name(token, known)?;
                } else {
                    let number = token.parse().ok().filter(|number: &f64| number.is_finite());
                    let number = number.ok_or_else(|| FormulaError::Number(token.into()))?;
                    self.push(Step::Number(number), NOWHERE);
                }
            } else if first == ')' {
                if value_next {
                    return Err(FormulaError::MissingValue(Some(token.into())));
                }
                let mut inner = std::mem::replace(&mut level, outer.pop().ok_or(FormulaError::Unopened)?);
                self.combine(&mut inner, 0);
                if let Some((function, source)) = inner.function {
                    self.push(Step::Apply(function), source);
                }
            } else if let Some((operator, priority, combine)) = OPERATORS.iter().find(|o| o.0 == token) {
                let sign = opened && matches!(first, '+' | '-');
                if value_next && !sign {
                    return Err(FormulaError::MissingValue(Some(token.into())));
                }
                if *operator == "^" && level.operator == "^" {
                    return Err(FormulaError::TwoPowers);
                }
                let comparison = *priority == 0;
                if comparison && (outer.is_empty() || std::mem::replace(&mut level.compared, true)) {
                    return Err(FormulaError::Comparison(token.into()));
                }
                if sign {
                    // A sign is a subtraction from 0, so that −x² is −(x²).
                    self.push(Step::Number(0.0), NOWHERE);
                }
                self.combine(&mut level, *priority);
                level.waiting.push((*priority, *combine, (*operator, place)));
                level.operator = operator;
                (value_next, opened) = (true, comparison);
            } else {
                return Err(FormulaError::Symbol(token.into()));
            }
            rest = after.trim_start();
        }
        if !outer.is_empty() {
            return Err(FormulaError::Unclosed);
        }
        if value_next {
            return Err(if text.trim().is_empty() { FormulaError::Empty } else { FormulaError::MissingValue(None) });
        }
        self.combine(&mut level, 0);
        let Self { steps, sources, names, depth, .. } = self;
        Ok(Formula { steps, sources, names, depth })
    }

    fn push_name(&mut self, name: &str, known: &[&str]) -> Result<(), FormulaError> {
        let Some(place) = known.iter().position(|k| *k == name) else {
            let names = known.iter().copied().chain(FUNCTIONS.iter().map(|f| f.0));
            return Err(FormulaError::Name(format!("`{name}` {}", unknown_key(name, names))));
        };
        let k = self.names.iter().position(|k| *k == place).unwrap_or_else(|| {
            self.names.push(place);
            self.names.len() - 1
        });
        self.push(Step::Value(k), NOWHERE);
        Ok(())
    }
}

/// Bytes of the number, word, operator or other character at the beginning of `text`.
fn token_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let run = |from: usize, part: fn(&u8) -> bool| bytes[from..].iter().take_while(|b| part(b)).count();
    match bytes.first() {
        Some(b'0'..=b'9' | b'.') => {
            let mut end = run(0, |b| b.is_ascii_digit() || *b == b'.');
            if matches!(bytes.get(end), Some(b'e' | b'E')) {
                let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
                let digits = run(end + 1 + sign, u8::is_ascii_digit);
                end += if digits > 0 { 1 + sign + digits } else { 0 };
            }
            end
        }
        Some(b'a'..=b'z' | b'A'..=b'Z' | b'_') => run(0, |b| b.is_ascii_alphanumeric() || *b == b'_'),
        Some(b'<' | b'>') if bytes.get(1) == Some(&b'=') => 2,
        _ => text.chars().next().map_or(0, char::len_utf8),
    }
}
