//! Formulas that people write: checked, compiled, evaluated (feature `formula`).
//!
//! `exmex` compiles and evaluates. It reads generously (`2 s1 -` loses an operator, `-s1^2` is (−s1)², a comparison may
//! stand anywhere), so that only texts in which every symbol and bracket has its place reach it.

use exmex::{BinOp, Express, FlatEx, MakeOperators, MatchLiteral, Operator, literal_matcher_from_pattern};

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

/// Longest formula, bytes, and deepest brackets: more is a slip, and would take long to compile.
const MAX_LENGTH: usize = 4096;
const MAX_DEPTH: usize = 64;

/// Operators with their priority: the higher, the tighter they bind.
const OPERATORS: [(&str, i64, Binary); 9] = [
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

/// a to the power of b; NaN where one of the two is none, also for b = 0 and a = 1.
fn power(a: f64, b: f64) -> f64 {
    match b {
        2.0 => a * a,
        _ if a.is_nan() || b.is_nan() => f64::NAN,
        _ => a.powf(b),
    }
}

/// 1 or 0; NaN where one of the two is none.
fn truth(a: f64, b: f64, holds: bool) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { f64::from(u8::from(holds)) }
}

#[derive(Debug, Clone)]
struct Language;

impl MakeOperators<f64> for Language {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        let binary = OPERATORS
            .iter()
            .map(|&(name, prio, apply)| Operator::make_bin(name, BinOp { apply, prio, is_commutative: false }));
        binary.chain(FUNCTIONS.iter().map(|&(name, apply)| Operator::make_unary(name, apply))).collect()
    }
}

literal_matcher_from_pattern!(Numbers, r"^([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?");

/// A formula over named values.
///
/// Numbers, names, `+ - * / ^`, comparisons in brackets (1 or 0), and the functions of [`Formula::functions`]; `pos(x)` is x
/// where it is positive, else 0. NaN in, NaN out.
#[derive(Debug, Clone)]
pub struct Formula {
    compiled: FlatEx<f64, Language, Numbers>,
}

impl Formula {
    /// Reads a formula; `name` says why a name is unknown.
    ///
    /// # Errors
    /// What is no formula, or could be read in two ways, with the reason.
    pub fn parse(text: &str, name: impl Fn(&str) -> Result<(), String>) -> Result<Self, String> {
        let text = checked(text, &name)?;
        let compiled = FlatEx::<f64, Language, Numbers>::parse(&text).map_err(|e| e.to_string())?;
        Ok(Self { compiled })
    }

    /// Names of the functions that a formula may call.
    pub fn functions() -> impl Iterator<Item = &'static str> {
        FUNCTIONS.iter().map(|f| f.0)
    }

    /// The names in it, in the order in which [`Formula::value`] wants their values.
    pub fn names(&self) -> &[String] {
        self.compiled.var_names()
    }

    /// Its value; NaN unless there is one value for each name.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.compiled.eval(values).unwrap_or(f64::NAN)
    }
}

/// A bracket, or the whole text.
#[derive(Default)]
struct Level {
    /// The operator before the last value.
    operator: &'static str,
    compared: bool,
}

/// The text with a 0 before every sign, so that the sign is a subtraction: −x² then is −(x²).
///
/// Refuses what is no formula or could be read in two ways.
fn checked(text: &str, name: &dyn Fn(&str) -> Result<(), String>) -> Result<String, String> {
    if text.len() > MAX_LENGTH {
        return Err(format!("it has more than {MAX_LENGTH} characters"));
    }
    let mut out = String::new();
    let mut levels = vec![Level::default()];
    // A value must come next, else an operator or a closing bracket.
    let mut value_next = true;
    // Nothing stands yet in this bracket or on this side of the comparison.
    let mut opened = true;
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let (token, after) = rest.split_at(token_length(rest));
        let inner = levels.len() > 1;
        let Some(level) = levels.last_mut() else { break };
        if first.is_ascii_alphanumeric() || matches!(first, '_' | '.' | '(') {
            if !value_next {
                return Err(format!("an operator is missing before `{token}`"));
            }
            opened = false;
            value_next = false;
            let function = FUNCTIONS.iter().any(|f| f.0 == token);
            if first == '(' {
                if levels.len() > MAX_DEPTH {
                    return Err(format!("brackets nest at most {MAX_DEPTH} deep"));
                }
                levels.push(Level::default());
                (value_next, opened) = (true, true);
            } else if function {
                if !after.trim_start().starts_with('(') {
                    return Err(format!("`{token}` needs its argument in brackets"));
                }
                value_next = true;
            } else if first.is_ascii_alphabetic() || first == '_' {
                name(token)?;
            } else if !token.parse::<f64>().is_ok_and(f64::is_finite) {
                return Err(format!("`{token}` is no number"));
            }
        } else if first == ')' {
            if value_next {
                return Err("a value is missing before `)`".into());
            }
            levels.pop();
            if levels.is_empty() {
                return Err("a bracket is closed that was not opened".into());
            }
        } else if let Some((operator, priority, _)) = OPERATORS.iter().find(|o| o.0 == token) {
            let sign = opened && matches!(first, '+' | '-');
            if value_next && !sign {
                let help = if matches!(first, '+' | '-') { ": put the signed value in brackets" } else { "" };
                return Err(format!("a value is missing before `{token}`{help}"));
            }
            if sign {
                out.push('0');
            }
            if *operator == "^" && level.operator == "^" {
                return Err("`a^b^c` can be read in two ways: use brackets".into());
            }
            let comparison = *priority == 0;
            if comparison && (!inner || std::mem::replace(&mut level.compared, true)) {
                return Err(format!("the comparison with `{token}` needs brackets of its own"));
            }
            level.operator = operator;
            (value_next, opened) = (true, comparison);
        } else {
            return Err(format!("`{token}` means nothing in a formula"));
        }
        out.push_str(token);
        out.push(' ');
        rest = after.trim_start();
    }
    if levels.len() > 1 {
        return Err("a bracket is not closed".into());
    }
    if value_next {
        return Err(if out.is_empty() { "it is empty".into() } else { "a value is missing at the end".into() });
    }
    Ok(out)
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
