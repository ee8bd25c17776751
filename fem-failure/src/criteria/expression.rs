//! A criterion written as formulas in the scene.

mod formula;

use crate::prelude::*;
use fem_core::formula::FormulaError;
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
/// Everything is in SI units, so that a formula should name ratios. `-s1^2` is −(s1²). What could be read in two ways
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
            formulas.push(formula.map_err(refused)?);
        }
        let needed = |s: &Strength| formulas.iter().any(|f| f.strengths().any(|used| used == *s));
        let strengths = Strength::ALL.iter().copied().filter(needed).collect();
        Ok(Self { info: describe(site, modes, strengths), formulas })
    }
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
