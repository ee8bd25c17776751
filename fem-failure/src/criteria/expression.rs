//! A criterion written as formulas in the scene.

mod formula;

use crate::prelude::*;
use fem_core::formula::{FormulaError, PowerError};
use fem_core::plugin::Value;
use formula::IndexFormula;
use std::sync::{Mutex, PoisonError};

/// One formula per mode, each giving the mode's index.
///
/// ```toml
/// [[failure.criteria]]
/// name = "expression"
/// site = "ply"
/// expression = [
///     "fibre tension: (s1 >= 0) * (s1/Xt)^2",
///     "matrix tension: (s2 >= 0) * ((s2/Yt)^2 + (s12/S12)^2)",
/// ]
/// ```
///
/// A formula knows
///
/// * the stress: `s1 s2 s3 s12 s23 s13`, also as `s11 s22 s33 s21 s32 s31`;
/// * the strengths `Xt Xc Yt Yc S12 S23 Zt Zc S13`, of which those that it names are required of the material;
/// * the elastic constants `E1 E2 E3 nu12 nu13 nu23 G12 G13 G23`;
/// * `+ - * / ^`, round brackets, numbers such as `0.5` and `2e-3`;
/// * `abs sqrt exp ln sin cos tan` (radians) and `pos(x)`, which is x where positive and otherwise 0;
/// * comparisons `< <= > >=` in brackets of their own, 1 where they hold and otherwise 0.
///
/// * the units of stress `Pa kPa MPa GPa`, so that a limit of its own reads `abs(s1)/(50*MPa)`.
///
/// An index is a pure number: a formula whose value changes with the unit of stress (`s1/50`, `s1/Xt + s2`, `exp(s1)`) is
/// refused; numbers are pure but for 0, with which a stress may be compared. `-s1^2` is −(s1²). What could be read in two ways
/// (`a^b^c`, `a < b < c`, `2 s1`) is refused, as is every symbol not listed, before a run begins. An index that is not
/// a number stops the run. Invariance about the fibre is not claimed, and the reserve factor comes from
/// [`search_reserve`](fem_core::failure::search_reserve).
#[derive(Debug, Clone)]
pub struct Expression {
    formulas: Vec<IndexFormula>,
    info: &'static CriterionInfo,
}

/// Why formulas do not make a criterion.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExpressionError {
    /// There is no formula.
    #[error("needs at least one formula")]
    NoModes,
    /// Two formulas have the same mode.
    #[error("two modes are called `{0}`")]
    RepeatedMode(String),
    /// The formula of a mode cannot be read.
    #[error("mode `{mode}`, `{formula}`: {why}")]
    Formula {
        /// The mode.
        mode: String,
        /// Its formula.
        formula: String,
        /// What is wrong with it.
        why: FormulaError,
    },
    /// The value of a formula is no pure number.
    #[error(
        "mode `{mode}`, `{formula}`: {why}: divide stresses by strengths (`s1/Xt`), moduli or units (`s1/(50*MPa)`)"
    )]
    Unit {
        /// The mode.
        mode: String,
        /// Its formula.
        formula: String,
        /// Why not.
        why: String,
    },
    /// An element of the list that does not give a mode its formula.
    #[error("each element of the list must be a text \"mode: formula\", got {0}")]
    NotNamed(String),
}

impl Expression {
    /// A criterion from (mode, formula) pairs.
    ///
    /// # Errors
    /// No mode, two of one name, or a formula that cannot be read: which, where and why.
    pub fn new(site: Site, modes: &[(&str, &str)]) -> Result<Self, ExpressionError> {
        if modes.is_empty() {
            return Err(ExpressionError::NoModes);
        }
        let mut formulas = Vec::new();
        for (k, (mode, text)) in modes.iter().enumerate() {
            if modes[..k].iter().any(|(other, _)| other == mode) {
                return Err(ExpressionError::RepeatedMode((*mode).into()));
            }
            let formula = IndexFormula::parse(text);
            let refused = |why| ExpressionError::Formula { mode: (*mode).into(), formula: (*text).into(), why };
            let formula = formula.map_err(refused)?;
            let unit = |why| ExpressionError::Unit { mode: (*mode).into(), formula: (*text).into(), why };
            match formula.power().map_err(|why| unit(describe_power_error(&why)))? {
                power if power.abs() < 1e-9 => formulas.push(formula),
                power => {
                    return Err(unit(format!("its value is {}, and an index is a pure number", name_power(power))));
                }
            }
        }
        let needed = |s: &Strength| formulas.iter().any(|f| f.strengths().any(|used| used == *s));
        let strengths = Strength::ALL.iter().copied().filter(needed).collect();
        Ok(Self { info: describe(site, modes, strengths), formulas })
    }
}

/// A power of stress in words.
fn name_power(power: f64) -> String {
    match power {
        p if p.abs() < 1e-9 => "a pure number".into(),
        p if (p - 1.0).abs() < 1e-9 => "a stress".into(),
        p => format!("a stress to the power of {}", (p * 1e6).round() / 1e6),
    }
}

fn describe_power_error(PowerError { symbol, place, powers: (a, b) }: &PowerError) -> String {
    let (a, b) = (name_power(*a), b.map(name_power));
    let what = match (*symbol, b) {
        (_, None) => format!("takes {a}, and wants a pure number"),
        ("^", Some(b)) => format!("raises {a} to {b} that is not written as one"),
        ("+" | "-", Some(b)) => format!("adds {a} and {b}"),
        (_, Some(b)) => format!("compares {a} with {b}"),
    };
    format!("`{symbol}` at character {place} {what}")
}

/// The description of such a criterion. Each lives until the program ends, once however often it is asked for: events
/// carry the names of modes freely, which for every other criterion are part of the program.
fn describe(site: Site, modes: &[(&str, &str)], strengths: Vec<Strength>) -> &'static CriterionInfo {
    static KNOWN: Mutex<Vec<&'static CriterionInfo>> = Mutex::new(Vec::new());
    let names = || modes.iter().map(|m| m.0);
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let same = |i: &&&CriterionInfo| i.site == site && i.modes.iter().copied().eq(names()) && i.strengths == strengths;
    if let Some(info) = known.iter().find(same) {
        return info;
    }
    let modes: Vec<&'static str> = names().map(|name| &*name.to_owned().leak()).collect();
    let info = Box::leak(Box::new(CriterionInfo {
        site,
        modes: modes.leak(),
        strengths: strengths.leak(),
        invariant_about_fibre: false,
    }));
    known.push(info);
    info
}

impl FailureCriterion for Expression {
    fn info(&self) -> &CriterionInfo {
        self.info
    }

    fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
        for (out, formula) in out.iter_mut().zip(&self.formulas) {
            *out = formula.value(s, m);
        }
    }

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        for (out, formula) in out.iter_mut().zip(&self.formulas) {
            *out = formula.bound(s, m);
        }
    }

    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        let rest = Stress6::new([0.0; 6]);
        for (formula, mode) in self.formulas.iter().zip(self.info.modes) {
            let index = formula.value(&rest, m);
            if !(index < 1.0 && index.is_finite()) {
                return Err(UnmetCondition {
                    condition: "an index below 1 without stress",
                    reason: "otherwise everything fails before it is loaded",
                    values: vec![(format!("index of mode `{mode}`"), index, "")],
                });
            }
        }
        Ok(())
    }

    fn scope(&self) -> &'static str {
        "stresses for which its formulas give a number"
    }
}

const SITE: ParamInfo = ParamInfo::word("site", "where it looks", &[("ply", ""), ("interface", "")]);
const FORMULAS: ParamInfo =
    ParamInfo::texts("expression", "a formula such as \"(s2/Yt)^2 + (s12/S12)^2\", or several as \"mode: formula\"");

impl Plugin for Expression {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "expression",
        summary: "formulas of your own, one per mode",
        source: "the scene",
        params: &[SITE, FORMULAS],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let refuse = |why: String| ParamError::new(FORMULAS.name, why);
        let refused = |error: ExpressionError| refuse(error.to_string());
        let site = match params.word(&SITE)? {
            "interface" => Site::Interface,
            _ => Site::Ply,
        };
        let formulas = params.value(&FORMULAS)?;
        let modes = match &formulas {
            Some(Value::Text(formula)) => vec![("failure", formula.as_str())],
            Some(Value::List(items)) => items.iter().map(split_mode).collect::<Result<_, _>>().map_err(refused)?,
            _ => Vec::new(),
        };
        Ok(Built::Criterion(Box::new(Self::new(site, &modes).map_err(refused)?)))
    }
}

/// Mode and formula of "mode: formula".
fn split_mode(item: &Value) -> Result<(&str, &str), ExpressionError> {
    let parts = match item {
        Value::Text(text) => text.split_once(':').map(|(mode, formula)| (mode.trim(), formula.trim())),
        _ => None,
    };
    parts.filter(|(mode, _)| !mode.is_empty()).ok_or_else(|| ExpressionError::NotNamed(item.to_string()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use fem_core::material::{Elastic, Strengths, Toughnesses};

    fn build(value: Value) -> Result<Box<dyn FailureCriterion>, ParamError> {
        let built = Expression::build(&Params::default().with("expression", value))?;
        match built {
            Built::Criterion(c) => Ok(c),
            other => Err(ParamError::new("", format!("{other:?}"))),
        }
    }

    fn list(items: &[&str]) -> Value {
        Value::List(items.iter().map(|t| Value::Text((*t).into())).collect())
    }

    #[test]
    fn modes_and_strengths_follow_from_the_formulas() {
        let c = build(list(&["matrix: (s2/Yt)^2 + (s12/S12)^2", "fibre: abs(s1)/Xt"])).unwrap();
        assert_eq!(c.info().modes, ["matrix", "fibre"]);
        assert_eq!(c.info().strengths, [Strength::Xt, Strength::Yt, Strength::S12]);
        let again = build(list(&["matrix: s2/Yt * (s12/S12)", "fibre: (s1/Xt)^2"])).unwrap();
        assert!(std::ptr::eq(c.info(), again.info()), "a description is kept once");
        assert_eq!(build(Value::Text("s1/Xt".into())).unwrap().info().modes, ["failure"]);
    }

    #[test]
    fn an_index_is_a_pure_number() {
        for (text, words) in [
            ("s11/1", "its value is a stress"),
            ("abs(s1)/5e7", "its value is a stress"),
            ("Xt/s1*s2/E1^2", "to the power of -1"),
            ("s1*s2/Xt", "its value is a stress"),
            ("sqrt(s1)/Xt", "to the power of -0.5"),
            ("s1/Xt + s2", "`+` at character 7 adds a pure number and a stress"),
            ("(s1 - 1e6)/Xt", "`-` at character 5 adds a stress and a pure number"),
            ("(s1 > 1e6)*s1/Xt", "`>` at character 5 compares a stress with a pure number"),
            ("exp(s1)", "`exp` at character 1 takes a stress"),
            ("abs(ln(s2*s1/Xt))", "`ln` at character 5 takes a stress"),
            ("(s1/Xt)^s2", "`^` at character 8 raises a pure number to a stress"),
            ("s1^nu12/Xt^nu12", "`^` at character 3 raises a stress to a pure number that is not written as one"),
            ("s1", "its value is a stress"),
        ] {
            let why = build(Value::Text(text.into())).unwrap_err().to_string();
            assert!(why.contains(words) && why.contains("s1/(50*MPa)"), "{text}: {why}");
        }
        for text in [
            "0",
            "0.5",
            "(s1 >= 0)*(s1/Xt)^2",
            "-s1/(50*MPa)",
            "(s1*s2)^(1/2)/Xt",
            "(s1^2 - s1*s2 + 0)/Xt^2",
            "pos(-s2)/sqrt(Yt*Yc)",
            "(-s1 < E1*2e-2)*exp(-s1/Xt) + nu12 - 1",
            "(s1/Xt)^(1 + nu12)",
            "0*s1",
        ] {
            assert!(build(Value::Text(text.into())).is_ok(), "{text}");
        }
    }

    /// What passes does not change with the unit of stress, and what would is refused: random formulas, by their value.
    #[test]
    fn what_passes_is_the_same_in_every_unit_of_stress() {
        let scaled = |unit: f64| Material {
            name: "m".into(),
            elastic: Elastic::transversely_isotropic(130.0 * unit, 10.0 * unit, 0.3, 0.4, 5.0 * unit),
            density: None,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
            strengths: Strengths::default().with(Strength::Xt, 3.0 * unit).with(Strength::Yt, 0.7 * unit),
        };
        let leaves = ["s1", "s2", "Xt", "Yt", "E1", "nu12", "2", "0.5"];
        let operators = ["+", "-", "*", "/"];
        let (mut passed, mut seed) = (0, 1_u64);
        let mut draw = |n: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % n
        };
        for _ in 0..20_000 {
            let [a, b, c, d] = [0; 4].map(|_| leaves[draw(8)]);
            let [f, g, h] = [0; 3].map(|_| operators[draw(4)]);
            let text = format!("({a} {f} {b}) {g} ({c} {h} {d})");
            let formula = IndexFormula::parse(&text).unwrap();
            let at =
                |unit: f64| formula.value(&Stress6::new([1.1 * unit, 0.3 * unit, 0.0, 0.0, 0.0, 0.0]), &scaled(unit));
            let (one, other) = (at(1.0), at(1024.0));
            let same = (one - other).abs() <= 1e-12 * one.abs() || !one.is_finite();
            let pure = formula.power().is_ok_and(|power| power.abs() < 1e-9);
            assert!(same || !pure, "{text} passes: {one} {other}");
            passed += usize::from(pure);
        }
        assert!((1000..10_000).contains(&passed), "{passed}");
    }

    #[test]
    fn other_values_than_lists_of_formulas_are_refused() {
        let why = |value| build(value).unwrap_err().to_string();
        assert!(why(list(&["(s2/Yt)^2"])).contains("mode: formula"));
        assert!(why(list(&[": s1/Xt"])).contains("mode: formula"));
        assert!(why(list(&[])).contains("at least one"));
        assert!(why(list(&["a: s1/Xt", "a: s2/Yt"])).contains("two modes are called `a`"));
        assert!(why(Value::Number(1.0)).contains("bare number"));
        let unknown = why(list(&["a: s1/Xt", "b: s2/Yd"]));
        assert!(unknown.contains("mode `b`") && unknown.contains("did you mean `Yc`"), "{unknown}");
        assert!(Expression::build(&Params::default()).unwrap_err().why.contains("missing"));
    }
}
