//! Extremes and events are those of the steps, whatever a history keeps of them.

use crate::support::{Case, strip};
use serde_json::Value;

/// A cantilever that a light ball strikes and leaves.
fn blow() -> Case {
    strip()
        .scene("mass = \"2.49 kg\"", "mass = \"0.2 g\"")
        .scene("velocity = \"1.56 m/s\"", "velocity = \"20 m/s\"")
        .scene("end = \"20 us\"", "step = \"0.1 us\"\nend = \"100 us\"")
        .scene("criteria = [\"hashin-report\", \"octahedral\"]", WEAK)
}

/// Plies that break along the fibres.
const WEAK: &str =
    "criteria = [\"octahedral\", { name = \"expression\", expression = \"abs(s1) / 5e7\" }]\nevery = \"0.5 us\"";

fn summary(case: &Case) -> Value {
    case.fem("run", &["--out", "out"]).good();
    case.summary("out")
}

fn warned(summary: &Value, words: &str) -> bool {
    summary["warnings"].as_array().unwrap().iter().any(|warning| warning.as_str().unwrap().contains(words))
}

#[test]
fn a_blow_is_what_it_is_whatever_rows_and_end() {
    let said = |case: &Case| {
        let Value::Object(mut summary) = summary(case) else { panic!() };
        let mut impact = summary["impact"].take();
        impact.as_object_mut().unwrap().retain(|key, _| key != "end_time_s" && !key.starts_with("peak_plate"));
        (impact, summary["first_damage"].take(), summary["accuracy"]["energy_error_relative"].take())
    };
    let seldom = "[output]\nhistory_every = \"1 s\"\n";
    let straight = said(&blow());
    let (peak, contact) = (&straight.0["peak_force_N"], &straight.0["contact_time_s"]);
    assert!(peak.as_f64() > Some(500.0) && straight.0["contacts"] == 1, "{straight:?}");
    assert!(straight.1.as_array().is_some_and(|modes| !modes.is_empty()), "{straight:?}");
    assert!(contact.as_f64() > Some(3e-6) && contact.as_f64() < Some(60e-6), "{contact}");
    assert_eq!(said(&blow().append(seldom)), straight);
    let later = said(&blow().scene("end = \"100 us\"", "end = \"700 us\"").append(seldom));
    assert_eq!((later.0, later.1), (straight.0, straight.1));
}

#[test]
fn a_history_that_misses_the_peak_says_so() {
    let words = "`output.history_every` to ";
    assert!(!warned(&summary(&blow()), words));
    let seldom = summary(&blow().append("[output]\nhistory_every = \"20 us\"\n"));
    assert!(warned(&seldom, words), "{seldom:#}");
}

/// The strip fails under the ball, which the criteria are not asked to look at.
#[test]
fn a_blow_between_two_looks_is_seen() {
    let seldom = |every: &str| summary(&blow().scene("every = \"0.5 us\"", &format!("every = \"{every}\"")));
    let (often, never) = (seldom("0.1 us"), seldom("1 s"));
    assert!(warned(&never, "the criteria look every") && !warned(&often, "the criteria look"), "{never:#}");
    let index = |summary: &Value| {
        let modes = summary["not_reached"].as_array().unwrap().iter();
        modes.map(|mode| mode["largest_index"].as_f64().unwrap()).fold(0.0, f64::max)
    };
    let first = |summary: &Value| summary["first_damage"][0]["time_s"].as_f64().unwrap();
    assert!((first(&never) / first(&often) - 1.0).abs() < 0.05, "{} {}", first(&never), first(&often));
    assert!((index(&never) / index(&often) - 1.0).abs() < 0.05, "{} {}", index(&never), index(&often));
}

#[test]
fn a_study_needs_no_rows() {
    let step = "[study]\naxes = [\"step\"]\n[output]\nhistory_every = \"1 s\"\n";
    let case = blow().append(step).append("[reduction]\nmethod = \"ritz\"\nvectors = 20\n");
    let done = case.fem("study", &["--out", "study"]).good();
    assert!(!done.stdout.contains("NaN") && !case.read("study/study.csv").contains("NaN"), "{done:#?}");
    let rows = crate::study::rows(&case, "study");
    let ran = || rows.values().filter(|row| row["refused"].is_empty());
    assert!(ran().count() > 3 && ran().all(|row| row["force-history error"].parse::<f64>().is_ok()), "{rows:#?}");
}
