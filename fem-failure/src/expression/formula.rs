//! One formula: checked, compiled, evaluated.
//!
//! `exmex` compiles and evaluates. It reads generously (`2 s1 -` loses an operator, `-s1^2` is (−s1)², a comparison may
//! stand anywhere), so that only texts in which every symbol and bracket has its place reach it.

use exmex::{BinOp, Express, FlatEx, MakeOperators, MatchLiteral, Operator, literal_matcher_from_pattern};
use fem_core::material::{Elastic, Material, Strength};
use fem_core::plugin::unknown_key;
use fem_core::tensor::{Ply, Stress6};

type Constant = fn(&Elastic) -> f64;
type Function = fn(f64) -> f64;
type Binary = fn(f64, f64) -> f64;

/// What a symbol stands for.
#[derive(Debug, Clone, Copy)]
enum Symbol {
    /// A component, by its place in [`Stress6`].
    Stress(usize),
    Strength(Strength),
    Elastic(Constant),
}

const STRESSES: [(&str, usize); 12] = [
    ("s1", 0),
    ("s2", 1),
    ("s3", 2),
    ("s12", 3),
    ("s23", 4),
    ("s13", 5),
    ("s11", 0),
    ("s22", 1),
    ("s33", 2),
    ("s21", 3),
    ("s32", 4),
    ("s31", 5),
];

const ELASTIC: [(&str, Constant); 9] = [
    ("E1", |e| e.e1),
    ("E2", |e| e.e2),
    ("E3", |e| e.e3),
    ("nu12", |e| e.nu12),
    ("nu13", |e| e.nu13),
    ("nu23", |e| e.nu23),
    ("G12", |e| e.g12),
    ("G13", |e| e.g13),
    ("G23", |e| e.g23),
];

const FUNCTIONS: [(&str, Function); 8] = [
    ("abs", f64::abs),
    ("sqrt", f64::sqrt),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("pos", crate::prelude::macaulay),
];

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
    ("^", 3, |a, b| if b == 2.0 { a * a } else { a.powf(b) }),
];

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

/// A formula over the stress and the constants of a material.
#[derive(Debug, Clone)]
pub(super) struct Formula {
    compiled: FlatEx<f64, Language, Numbers>,
    /// What to hand over, in the order that `compiled` wants.
    symbols: Vec<Symbol>,
}

impl Formula {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let compiled = FlatEx::<f64, Language, Numbers>::parse(&checked(text)?).map_err(|e| e.to_string())?;
        let symbols = compiled.var_names().iter().map(|name| symbol(name)).collect::<Result<_, _>>()?;
        Ok(Self { compiled, symbols })
    }

    /// Strengths that it names.
    pub(super) fn strengths(&self) -> impl Iterator<Item = Strength> {
        self.symbols.iter().filter_map(|s| match s {
            Symbol::Strength(which) => Some(*which),
            _ => None,
        })
    }

    pub(super) fn value(&self, s: &Stress6<Ply>, m: &Material) -> f64 {
        // Aliases may be there beside what they stand for.
        let mut values = [f64::NAN; STRESSES.len() + Strength::ALL.len() + ELASTIC.len()];
        for (value, symbol) in values.iter_mut().zip(&self.symbols) {
            *value = match symbol {
                Symbol::Stress(i) => s.0[*i],
                Symbol::Strength(which) => m.strengths.get(*which).unwrap_or(f64::NAN),
                Symbol::Elastic(constant) => constant(&m.elastic),
            };
        }
        self.compiled.eval(&values[..self.symbols.len()]).unwrap_or(f64::NAN)
    }
}

fn symbol(name: &str) -> Result<Symbol, String> {
    let stress = STRESSES.iter().find(|(n, _)| *n == name).map(|(_, i)| Symbol::Stress(*i));
    let strength = || Strength::ALL.iter().find(|s| s.name() == name).map(|s| Symbol::Strength(*s));
    let elastic = || ELASTIC.iter().find(|(n, _)| *n == name).map(|(_, f)| Symbol::Elastic(*f));
    stress.or_else(strength).or_else(elastic).ok_or_else(|| {
        let stresses = STRESSES[..6].iter().map(|s| s.0);
        let constants = Strength::ALL.iter().map(|s| s.name()).chain(ELASTIC.iter().map(|e| e.0));
        let known = stresses.chain(constants).chain(FUNCTIONS.iter().map(|f| f.0));
        format!("`{name}` {}", unknown_key(name, known))
    })
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
fn checked(text: &str) -> Result<String, String> {
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
                levels.push(Level::default());
                (value_next, opened) = (true, true);
            } else if function {
                if !after.trim_start().starts_with('(') {
                    return Err(format!("`{token}` needs its argument in brackets"));
                }
                value_next = true;
            } else if first.is_ascii_alphabetic() || first == '_' {
                symbol(token)?;
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use fem_core::material::Strengths;
    use proptest::prelude::*;

    fn material() -> Material {
        let strengths = [(Strength::Xt, 100.0), (Strength::Yt, 10.0), (Strength::S12, 8.0)];
        Material {
            name: "m".into(),
            elastic: Elastic::transversely_isotropic(130.0, 10.0, 0.3, 0.4, 5.0),
            density: None,
            giic: None,
            strengths: strengths.iter().fold(Strengths::default(), |s, (which, v)| s.with(*which, *v)),
        }
    }

    fn value(text: &str) -> f64 {
        let s = Stress6::new([2.0, 3.0, 5.0, 7.0, 11.0, 13.0]);
        Formula::parse(text).unwrap().value(&s, &material())
    }

    #[test]
    fn values() {
        for (text, want) in [
            ("s1 + 10*s2 + 100*s3", 532.0),
            ("s12 + 100*s23 + 10000*s13", 131_107.0),
            ("s11 - s1 + s22 - s2 + s33 - s3 + s21 - s12 + s32 - s23 + s31 - s13", 0.0),
            ("Xt + Yt/S12", 101.25),
            ("E1 + E2 + E3 + G12 + G13", 160.0),
            ("nu12 + 10*nu13 + 100*nu23", 43.3),
            ("2e2 + .5 + 1.", 201.5),
            ("1.5E-1*20", 3.0),
            ("-s1^2", -4.0),
            ("(-s1)^2", 4.0),
            ("+s1 - (-s2^2)", 11.0),
            ("6/3/2 - 4 - 1", -4.0),
            ("2*s1^2*3", 24.0),
            ("(2^3)^2", 64.0),
            ("abs(-s1)*sqrt(4)", 4.0),
            ("pos(s1) + 10*pos(-s1)", 2.0),
            ("exp(ln(s2))*cos(0) + sin(0) + tan(0)", 3.0),
            ("(s1 >= 2)*5 + (s1 > 2)*7 + (s1 < -1)*11 + (s1 <= s2 - 1)*13", 18.0),
            ("((s1 < s2)*(s2 < s3))", 1.0),
            ("(s1 + s2 > s3 - 1)", 1.0),
        ] {
            assert!((value(text) - want).abs() < 1e-12 * want.abs().max(1.0), "{text} = {}, not {want}", value(text));
        }
    }

    #[test]
    fn nan_is_never_lost() {
        let nan = Stress6::new([f64::NAN; 6]);
        for text in ["pos(s1)", "(s1 < 1)", "abs(s2)", "(s1 >= 0)*0"] {
            assert!(Formula::parse(text).unwrap().value(&nan, &material()).is_nan(), "{text}");
        }
        assert!(value("s1/Zt").is_nan(), "a strength that is missing");
    }

    #[test]
    fn what_is_no_formula_is_refused_with_the_reason() {
        for (text, words) in [
            ("", "empty"),
            ("  ", "empty"),
            ("s1/Xd", "did you mean `Xc`"),
            ("S1", "did you mean"),
            ("sigma1/Xt", "`sigma1` is not known"),
            ("2 s1", "an operator is missing before `s1`"),
            ("2s1", "an operator is missing before `s1`"),
            ("s1 (s2)", "an operator is missing before `(`"),
            ("(s1)(s2)", "an operator is missing before `(`"),
            ("abs s1^2", "brackets"),
            ("abs", "brackets"),
            ("abs()", "missing before `)`"),
            ("()", "missing before `)`"),
            ("s1 +", "missing at the end"),
            ("* s1", "missing before `*`"),
            ("s1 * -s2", "put the signed value in brackets"),
            ("s1 ** 2", "missing before `*`"),
            ("--s1", "missing before `-`"),
            ("(s1", "not closed"),
            ("s1)", "not opened"),
            ("s1 < 2", "brackets of its own"),
            ("(0 < s1 < 2)", "brackets of its own"),
            ("s1^2^3", "two ways"),
            ("1..2", "`1..2` is no number"),
            ("1e999", "no number"),
            ("1e", "an operator is missing before `e`"),
            ("{s1}", "`{` means nothing"),
            ("s1 = 2", "`=` means nothing"),
            ("max(s1, s2)", "`max` is not known"),
            ("σ1", "`σ` means nothing"),
        ] {
            let why = Formula::parse(text).err().unwrap_or_default();
            assert!(why.contains(words), "{text:?}: {why:?}");
        }
    }

    proptest! {
        /// Whatever stands in a scene is a formula or an error, never a panic.
        #[test]
        fn any_text_is_read_or_refused(text in "[ s1-3XtY()<>=.+*/^eabs{},σ\\n-]{0,40}") {
            if let Ok(formula) = Formula::parse(&text) {
                let _ = formula.value(&Stress6::new([1.0; 6]), &material());
            }
        }

        /// Sums of products keep their value, however they are written.
        #[test]
        fn precedence(a in -9i32..9, b in 1i32..9, c in 1i32..4, d in -9i32..9) {
            let text = format!("({a})*{b}^{c} - ({d})/{b} + (-{b}^{c})");
            let (a, b, d) = (f64::from(a), f64::from(b), f64::from(d));
            let want = a * b.powi(c) - d / b - b.powi(c);
            prop_assert!((value(&text) - want).abs() < 1e-9, "{text} = {}, not {want}", value(&text));
        }
    }
}
