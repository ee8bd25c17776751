//! A formula over the stress and the constants of a material.

use fem_core::failure::StressRange;
use fem_core::formula::{Formula, FormulaError, PowerError};
use fem_core::interval::Interval;
use fem_core::material::{Elastic, Material, Strength};
use fem_core::tensor::{Ply, Stress6};

/// What a symbol stands for.
#[derive(Debug, Clone, Copy)]
enum Symbol {
    /// A component, by its place in [`Stress6`].
    Stress(usize),
    Strength(Strength),
    Elastic(fn(&Elastic) -> f64),
    /// A unit of stress, Pa.
    Unit(f64),
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

/// One of the elastic constants.
type Constant = fn(&Elastic) -> f64;

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

const UNITS: [(&str, f64); 4] = [("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9)];

/// Every symbol with its name.
fn symbols() -> impl Iterator<Item = (&'static str, Symbol)> {
    let stresses = STRESSES.iter().map(|(name, i)| (*name, Symbol::Stress(*i)));
    let strengths = Strength::ALL.iter().map(|s| (s.name(), Symbol::Strength(*s)));
    let elastic = ELASTIC.iter().map(|(name, constant)| (*name, Symbol::Elastic(*constant)));
    stresses.chain(strengths).chain(elastic).chain(UNITS.iter().map(|(name, unit)| (*name, Symbol::Unit(*unit))))
}

/// The index of a mode: a formula over the stress and the constants of a material.
#[derive(Debug, Clone)]
pub(super) struct IndexFormula {
    formula: Formula,
    /// What to hand over, in the order that `formula` wants.
    symbols: Vec<Symbol>,
    /// Of each the power of stress in its unit.
    powers: Vec<f64>,
}

impl IndexFormula {
    pub(super) fn parse(text: &str) -> Result<Self, FormulaError> {
        let (names, known): (Vec<_>, Vec<_>) = symbols().unzip();
        let formula = Formula::parse(text, &names)?;
        let symbols = formula.names().iter().map(|k| known[*k]).collect();
        let power = |k: &usize| if names[*k].starts_with("nu") { 0.0 } else { 1.0 };
        let powers = formula.names().iter().map(power).collect();
        Ok(Self { formula, symbols, powers })
    }

    /// The power of stress in the unit of its value; 0 for a pure number.
    pub(super) fn power(&self) -> Result<f64, PowerError> {
        self.formula.power(&self.powers)
    }

    /// Strengths that it names.
    pub(super) fn strengths(&self) -> impl Iterator<Item = Strength> {
        self.symbols.iter().filter_map(|s| match s {
            Symbol::Strength(which) => Some(*which),
            _ => None,
        })
    }

    pub(super) fn value(&self, s: &Stress6<Ply>, m: &Material) -> f64 {
        let values = self.values(m, f64::NAN, |i| s.0[i], |constant| constant);
        self.formula.value(&values[..self.symbols.len()])
    }

    /// What its value does not exceed over a range of stresses; infinite where it does not say.
    pub(super) fn bound(&self, s: &StressRange, m: &Material) -> f64 {
        let stress = |i: usize| Interval { low: s.low.0[i], high: s.high.0[i] };
        let values = self.values(m, Interval::exactly(f64::NAN), stress, Interval::exactly);
        self.formula.bounds(&values[..self.symbols.len()]).map_or(f64::INFINITY, |bounds| bounds.high)
    }

    /// What stands for its symbols: components of stress, and constants.
    fn values<T: Copy>(
        &self,
        m: &Material,
        nothing: T,
        stress: impl Fn(usize) -> T,
        constant: impl Fn(f64) -> T,
    ) -> [T; MOST_SYMBOLS] {
        let mut values = [nothing; MOST_SYMBOLS];
        for (value, symbol) in values.iter_mut().zip(&self.symbols) {
            *value = match symbol {
                Symbol::Stress(i) => stress(*i),
                Symbol::Strength(which) => constant(m.strengths.get(*which).unwrap_or(f64::NAN)),
                Symbol::Elastic(of) => constant(of(&m.elastic)),
                Symbol::Unit(unit) => constant(*unit),
            };
        }
        values
    }
}

/// Aliases may be there beside what they stand for.
const MOST_SYMBOLS: usize = STRESSES.len() + Strength::ALL.len() + ELASTIC.len() + UNITS.len();

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use fem_core::material::{Strengths, Toughnesses};
    use proptest::prelude::*;

    fn material() -> Material {
        let strengths = [(Strength::Xt, 100.0), (Strength::Yt, 10.0), (Strength::S12, 8.0)];
        Material {
            name: "m".into(),
            elastic: Elastic::transversely_isotropic(130.0, 10.0, 0.3, 0.4, 5.0),
            density: None,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
            strengths: strengths.iter().fold(Strengths::default(), |s, (which, v)| s.with(*which, *v)),
        }
    }

    fn value(text: &str) -> f64 {
        let s = Stress6::new([2.0, 3.0, 5.0, 7.0, 11.0, 13.0]);
        IndexFormula::parse(text).unwrap().value(&s, &material())
    }

    #[test]
    fn values() {
        for (text, want) in [
            ("s1 + 10*s2 + 100*s3", 532.0),
            ("s12 + 100*s23 + 10000*s13", 131_107.0),
            ("s11 - s1 + s22 - s2 + s33 - s3 + s21 - s12 + s32 - s23 + s31 - s13", 0.0),
            ("Xt + Yt/S12", 101.25),
            ("E1 + E2 + E3 + G12 + G13", 160.0),
            ("kPa + MPa/Pa + GPa", 1.001_001e9),
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
        for text in ["pos(s1)", "(s1 < 1)", "abs(s2)", "(s1 >= 0)*0", "s1^0", "1^s1", "s1^2"] {
            assert!(IndexFormula::parse(text).unwrap().value(&nan, &material()).is_nan(), "{text}");
        }
        assert!(value("s1/Zt").is_nan(), "a strength that is missing");
    }

    #[test]
    fn texts_that_are_not_formulas_are_refused_with_the_reason() {
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
            ("1..2", "`1..2` is not a number"),
            ("1e999", "not a number"),
            ("1e", "an operator is missing before `e`"),
            ("{s1}", "`{` means nothing"),
            ("s1 = 2", "`=` means nothing"),
            ("max(s1, s2)", "`max` is not known"),
            ("σ1", "`σ` means nothing"),
        ] {
            let why = IndexFormula::parse(text).unwrap_err().to_string();
            assert!(why.contains(words), "{text:?}: {why:?}");
        }
    }

    #[test]
    fn no_text_takes_long() {
        let refused = |text: &str| IndexFormula::parse(text).unwrap_err().to_string();
        assert!(refused(&["(".repeat(65), "s1".into(), ")".repeat(65)].concat()).contains("64 deep"));
        assert!(refused(&"s1+".repeat(1400)).contains("more than 4096"));
        assert!(IndexFormula::parse(&["(".repeat(64), "s1".into(), ")".repeat(64)].concat()).is_ok());
    }

    proptest! {
        /// Whatever stands in a scene is a formula or an error, never a panic.
        #[test]
        fn any_text_is_read_or_refused(text in "[ s1-3XtY()<>=.+*/^eabs{},σ\\n-]{0,40}") {
            if let Ok(formula) = IndexFormula::parse(&text) {
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
