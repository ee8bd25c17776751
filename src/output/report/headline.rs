//! What is read first on a page: what failed first, and what speaks against the numbers.

use fem_core::plugin::{Dimension, digits};
use serde::Serialize;
use serde_json::{Map, Value};

/// The first lines of a page.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Headline {
    /// What happened first.
    first: String,
    /// Whether something speaks against the results.
    doubt: bool,
    /// What it is, and how well the results are known.
    verdict: String,
}

impl Headline {
    /// `None` of results that say nothing of the kind.
    pub(super) fn new(summary: &Map<String, Value>) -> Option<Self> {
        let first =
            first_damage(summary).or_else(|| path(summary)).or_else(|| margin(summary)).or_else(|| frequency(summary));
        let first = first.or_else(|| load_factor(summary)).or_else(|| deflection(summary))?;
        let count = |key: &str| list(summary, key).len();
        let (cautions, warnings) = (count("cautions"), count("warnings"));
        let several = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
        let error = number(summary, "/accuracy/results/peak_force_relative");
        let unknown = error.is_none() && summary.contains_key("impact");
        let against = match (summary.contains_key("stopped"), cautions, warnings) {
            (true, ..) => "The march stopped early: all of it holds up to then.".to_owned(),
            (_, 0, 0) if unknown => "No caution and no warning.".to_owned(),
            (_, 0, 0) => "Nothing speaks against it: no caution, no warning.".to_owned(),
            (_, 0, n) => format!("To be read with {}, below.", several(n, "warning")),
            (_, n, 0) => format!("Not to be trusted as it is: {}, below.", several(n, "caution")),
            (_, n, m) => {
                format!("Not to be trusted as it is: {} and {}, below.", several(n, "caution"), several(m, "warning"))
            }
        };
        let known = match error {
            Some(error) => format!(" Peak force within about {:.2} %.", 1e2 * error),
            None if unknown => " How well the force is known was not estimated: `fem study` shows it.".to_owned(),
            None => String::new(),
        };
        let doubt = cautions + warnings > 0 || unknown || summary.contains_key("stopped");
        Some(Self { first, doubt, verdict: against + &known })
    }
}

fn list<'a>(summary: &'a Map<String, Value>, key: &str) -> &'a [Value] {
    summary.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// A number of the summary by its path.
fn number(summary: &Map<String, Value>, path: &str) -> Option<f64> {
    let mut keys = path.trim_start_matches('/').split('/');
    let first = summary.get(keys.next()?)?;
    keys.try_fold(first, |value, key| value.get(key))?.as_f64()
}

/// Of an impact: mode, ply, time, force and place of the first damage.
fn first_damage(summary: &Map<String, Value>) -> Option<String> {
    summary.get("first_damage")?;
    let of = |event: &Value, key: &str| event.get(key).and_then(Value::as_f64).unwrap_or(f64::NAN);
    let text = |event: &Value, key: &str| event.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
    let events = list(summary, "first_damage").iter();
    let Some(event) = events.min_by(|a, b| of(a, "time_s").total_cmp(&of(b, "time_s"))) else {
        let judged = !list(summary, "not_reached").is_empty();
        return Some(
            delaminated(summary, "/delamination").unwrap_or_else(|| {
                if judged { "No damage".to_owned() } else { "Damage was not looked for".to_owned() }
            }),
        );
    };
    let ply = text(event, "ply");
    let place = match ply.contains('|') {
        true => format!("interface {ply}"),
        false => format!("ply {ply} ({}°)", digits(of(event, "angle_deg"))),
    };
    Some(format!(
        "First damage: {} in {place} at {} under {}, at x, y = {} ({})",
        text(event, "mode"),
        Dimension::TIME.of(of(event, "time_s")),
        Dimension::FORCE.of(of(event, "contact_force_N")),
        Dimension::LENGTH.list(&[of(event, "x_m"), of(event, "y_m")]),
        text(event, "criterion")
    ))
}

/// The area that delaminations have taken in plan, where they may grow.
fn delaminated(summary: &Map<String, Value>, path: &str) -> Option<String> {
    let area = number(summary, &format!("{path}/projected_area_mm2"))?;
    Some(match area > 0.0 {
        true => format!("{} delaminated in plan", Dimension::AREA.of(1e-6 * area)),
        false => "No delamination".to_owned(),
    })
}

/// Of loads that are followed through growth: the largest force, and what has delaminated in the end.
fn path(summary: &Map<String, Value>) -> Option<String> {
    let of = |key: &str| number(summary, &format!("/path/{key}"));
    let (force, at) = (Dimension::FORCE.of(of("peak_force_N")?), Dimension::LENGTH.of(of("displacement_at_peak_m")?));
    Some(format!("Largest force {force} at {at}; {} in the end", delaminated(summary, "/path/delamination")?))
}

/// Of loads at rest: the smallest reserve factor.
fn margin(summary: &Map<String, Value>) -> Option<String> {
    let of = |margin: &Value| margin.get("reserve_factor").and_then(Value::as_f64).unwrap_or(f64::INFINITY);
    let least = list(summary, "margins").iter().min_by(|a, b| of(a).total_cmp(&of(b)))?;
    let text = |key: &str| least.get(key).and_then(Value::as_str).unwrap_or_default();
    Some(format!(
        "Smallest reserve factor {}: {} in ply {} ({})",
        digits(of(least)),
        text("mode"),
        text("ply"),
        text("criterion")
    ))
}

/// Of loads at rest that no criterion judges: the largest deflection.
fn deflection(summary: &Map<String, Value>) -> Option<String> {
    let of = |key: &str| number(summary, &format!("/largest_deflection/{key}"));
    let place = Dimension::LENGTH.list(&[of("x_m")?, of("y_m")?]);
    Some(format!("Largest deflection {} at x, y = {place}", Dimension::LENGTH.of(of("w_m")?)))
}

/// Of natural modes: the lowest frequency.
fn frequency(summary: &Map<String, Value>) -> Option<String> {
    let lowest = list(summary, "frequencies_Hz").first()?.as_f64()?;
    Some(format!("Lowest natural frequency {}", Dimension::FREQUENCY.of(lowest)))
}

/// Of buckling: the load factor nearest to zero.
fn load_factor(summary: &Map<String, Value>) -> Option<String> {
    let first = list(summary, "load_factors").first()?.as_f64()?;
    Some(format!("The plate buckles at {first:.4} of the preload"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use serde_json::json;

    fn headline(summary: &Value) -> Headline {
        Headline::new(summary.as_object().unwrap()).unwrap()
    }

    #[test]
    fn the_first_screen_says_what_failed_first_and_what_speaks_against_it() {
        let event = |time: f64, ply: &str| {
            json!({ "criterion": "puck", "mode": "matrix tension", "time_s": time, "ply": ply, "angle_deg": -45.0, "x_m": 0.0,
                    "y_m": 1.5e-3, "contact_force_N": 849.06 })
        };
        let mut summary = json!({ "impact": {}, "first_damage": [event(2e-3, "3|4"), event(3.922e-4, "1")], "cautions": [],
            "warnings": [], "accuracy": { "results": { "peak_force_relative": 0.0045 } } });
        let good = headline(&summary);
        assert_eq!(
            good.first,
            "First damage: matrix tension in ply 1 (-45°) at 0.3922 ms under 849.1 N, at x, y = 0, 1.5 mm (puck)"
        );
        assert!(!good.doubt && good.verdict.ends_with("no warning. Peak force within about 0.45 %."), "{good:?}");
        let mut unknown = summary.clone();
        unknown["accuracy"] = json!({});
        assert!(headline(&unknown).doubt && headline(&unknown).verdict.contains("not estimated"));
        summary["warnings"] = json!(["w"]);
        summary["cautions"] = json!(["a", "b"]);
        let doubtful = headline(&summary);
        assert!(doubtful.doubt && doubtful.verdict.contains("2 cautions and 1 warning, below"), "{doubtful:?}");
        summary["first_damage"] = json!([event(1e-3, "3|4")]);
        assert!(headline(&summary).first.contains("in interface 3|4 at 1 ms"));
        summary["first_damage"] = json!([]);
        summary["not_reached"] = json!([{}]);
        assert_eq!(headline(&summary).first, "No damage");
    }

    #[test]
    fn plates_at_rest_and_modes_have_one_too() {
        let margins = json!({ "margins": [{ "reserve_factor": 3.0 }, { "reserve_factor": 1.234_56, "mode": "fibre", "ply": "2",
            "criterion": "c" }] });
        assert_eq!(headline(&margins).first, "Smallest reserve factor 1.235: fibre in ply 2 (c)");
        assert_eq!(headline(&json!({ "frequencies_Hz": [12_345.0] })).first, "Lowest natural frequency 12.35 kHz");
        let rest = json!({ "largest_deflection": { "w_m": 7.5e-5, "x_m": 0.005, "y_m": 0.01, "z_m": 0.0 } });
        assert_eq!(headline(&rest).first, "Largest deflection 75 um at x, y = 5, 10 mm");
        let path = json!({ "path": { "peak_force_N": 70.0, "displacement_at_peak_m": 1.7e-3,
            "delamination": { "projected_area_mm2": 1253.0 } }, "largest_deflection": {} });
        let said = "Largest force 70 N at 1.7 mm; 1253 mm^2 delaminated in plan in the end";
        assert_eq!(headline(&path).first, said);
        let grown = json!({ "first_damage": [], "delamination": { "projected_area_mm2": 0.0 } });
        assert_eq!(headline(&grown).first, "No delamination");
        assert_eq!(Headline::new(&Map::new()), None);
    }
}
