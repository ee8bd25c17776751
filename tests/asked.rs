//! An accuracy that is asked for: settings are raised until it is reached, and it is.

use crate::support::{Case, plate, root};
use serde_json::Value;

/// Deflection of Pagano's plate at its centre, mm (N. J. Pagano, J. Compos. Mater. 4 (1970) 20-34).
const PAGANO: f64 = 0.075_30;

fn asked(case: &Case, folder: &str) -> Value {
    let cost: Value = serde_json::from_str(&case.read(&format!("{folder}/cost.json"))).unwrap();
    cost["accuracy_asked"].clone()
}

/// A quarter of his plate in four cells.
fn pagano() -> Case {
    let scene = std::fs::read_to_string(root().join("examples/pagano-0-90-0/scene.toml")).unwrap();
    plate().text(&scene.replace("cells = [6, 6]", "cells = [2, 2]")).append("[study]\nquantities = [\"deflection\"]\n")
}

#[test]
fn of_loads_at_rest_it_is_reached() {
    for (accuracy, most) in [("5 %", 0.05), ("0.5%", 0.005)] {
        let case = pagano();
        let done = case.fem("run", &["--accuracy", accuracy, "--out", "out"]).good();
        let deflection = case.summary("out")["largest_deflection"]["w_m"].as_f64().unwrap() * 1e3;
        let error = (deflection.abs() / PAGANO - 1.0).abs();
        let asked = asked(&case, "out");
        let said = asked["reached"].as_f64().unwrap();
        assert!(error < said + 1e-4 && said <= most, "{error:.2e}: {asked:#}");
        assert!(done.stdout.contains("by what changes in"), "{done:#?}");
    }
}

/// The scene that was found stands alone, and asks for nothing any more.
#[test]
fn a_scene_asks_for_it_and_the_one_that_is_found_gives_the_same() {
    let case = pagano();
    let case = case.scene("analysis = ", "accuracy = 0.005\nanalysis = ");
    case.fem("run", &["--out", "out"]).good();
    let found = case.read("out/scene.toml");
    assert!(!found.contains("accuracy") && found.contains("refine"), "{found}");
    let again = case.text(&found);
    again.fem("run", &["--out", "again"]).good();
    assert_eq!(again.read("out/summary.json"), again.read("again/summary.json"));
}

/// A plate of shells that is struck, in cells of 10 mm.
fn struck() -> Case {
    let scene = std::fs::read_to_string(root().join("tests/data/scenes/study.toml")).unwrap();
    plate().text(scene.split("[study]").next().unwrap())
}

#[test]
fn of_an_impact_it_is_reached() {
    let case = struck();
    case.fem("run", &["--accuracy", "2%", "--out", "out"]).good();
    let said = asked(&case, "out");
    let impact = |case: &Case, folder: &str| case.summary(folder)["impact"].clone();
    let run = impact(&case, "out");
    let fine = case
        .scene("cells = [6, 4]", "cells = [48, 32]")
        .scene("vectors = 20", "vectors = 160")
        .scene("step = \"1 us\"", "step = \"0.1 us\"");
    fine.fem("run", &["--out", "fine"]).good();
    let fine = impact(&fine, "fine");
    for (name, key) in
        [("peak-force", "peak_force_N"), ("impulse", "impulse_N_s"), ("deflection", "peak_plate_displacement_m")]
    {
        let error = (run[key].as_f64().unwrap() / fine[key].as_f64().unwrap() - 1.0).abs();
        let each = said["quantities"].as_array().unwrap();
        let said = each.iter().find(|q| q["name"] == name).unwrap_or_else(|| panic!("{name}: {said:#}"))["error"]
            .as_f64()
            .unwrap();
        assert!(error < said + 1e-4 && said <= 0.02, "{name}: {error:.2e}, said {said:.2e}");
    }
}

#[test]
fn what_is_not_reached_has_its_reason_and_the_best_is_run() {
    let case = struck();
    let done = case.fem("run", &["--accuracy", "0.001%", "--budget", "2e0 s", "--out", "out"]);
    let asked = asked(&case, "out");
    assert!(done.status == 1 && done.stdout.contains("not reached: "), "{done:#?}");
    assert!(asked["stopped"].is_string() && asked["reached"].as_f64().unwrap() > 1e-5, "{asked:#}");
    assert!(case.summary("out")["completed"].as_bool().unwrap());
}

/// What was raised is taken from the folder, the rest from the scene, which must be the one that was begun.
#[test]
fn a_run_goes_on_with_what_was_raised() {
    let case = struck();
    case.fem("run", &["--accuracy", "5%", "--out", "out"]).good();
    let before = case.read("out/summary.json");
    case.fem("run", &["--accuracy", "5%", "--resume", "--out", "out"]).good();
    assert_eq!(case.read("out/summary.json"), before);
    let other = case.scene("2 m/s", "3 m/s").fem("run", &["--accuracy", "5%", "--resume", "--out", "out"]);
    assert!(other.status == 1 && other.stderr.contains("belongs to another run"), "{other:#?}");
}

#[test]
fn a_budget_without_an_accuracy_is_refused() {
    let done = struck().fem("run", &["--budget", "5s", "--out", "out"]);
    assert!(done.status == 1 && done.stderr.contains("none is asked for"), "{done:#?}");
}
