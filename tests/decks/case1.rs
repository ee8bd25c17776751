//! The report's case 1, typed as decks and told as a scene.

use super::{Table, number, program, run};
use crate::report::Computed;
use crate::support::{fem, root};

/// DELTA times NPRINT of the deck, s.
const PRINTED: f64 = 5e-6;

/// When an index of a ply first reaches 1, between print steps, s.
fn onset(table: &Table, ply: u16, equation: &str) -> f64 {
    let [step, which, index] = ["ndisp", "which", equation].map(|name| table.column(name));
    let rows = table.rows.iter().filter(|row| row[which] == ply.to_string());
    let found: Vec<(f64, f64)> = rows.map(|row| (PRINTED * number(&row[step]), number(&row[index]))).collect();
    let after = found.iter().position(|(_, index)| *index >= 1.0).unwrap();
    assert!(after > 0, "{equation} of ply {ply} is reached before the first step that is printed");
    let ((t, before), (_, now)) = (found[after - 1], found[after]);
    t + PRINTED * (1.0 - before) / (now - before)
}

#[test]
fn decks_and_scene_fail_at_the_same_time() {
    let (folder, results) = (root().join("examples/report-decks"), tempfile::tempdir().unwrap());
    for (deck, of) in [
        ("1-quarter-1", "lamsub"),
        ("2-quarter-2", "lamsub"),
        ("3-impact", "tradyr"),
        ("4-stresses-1", "lamsub"),
        ("5-stresses-2", "lamsub"),
    ] {
        run(&folder.join(format!("{deck}.dat")), program(of), results.path()).unwrap();
    }
    let stresses =
        ["4-stresses-1", "5-stresses-2"].map(|deck| Table::read(&results.path().join(format!("{deck}.failure.csv"))));
    // The command judges all elements on its way.
    let project = results.path().to_str().unwrap();
    let done = fem(&folder, &["tradyr", "3-impact.dat", "--project", project, "--units", "N-mm-s", "--json"]).good();
    let impact = &serde_json::from_str::<serde_json::Value>(&done.stdout).unwrap()["impact"];
    assert!(impact["accuracy"]["energy_error_relative"].as_f64().unwrap() < 1e-8, "{impact}");
    let events = Table::read(&results.path().join("3-impact/events.csv"));
    let event = |mode: &str, ply: u16| {
        let [criterion, by, place, time] = ["criterion", "mode", "ply", "time_s"].map(|name| events.column(name));
        let found = events
            .rows
            .iter()
            .find(|row| row[criterion] == "hashin-report" && row[by] == mode && row[place] == ply.to_string());
        number(&found.unwrap()[time])
    };
    let first = |ply: u16, equation: &str| {
        stresses.iter().map(|table| onset(table, ply, equation)).fold(f64::INFINITY, f64::min)
    };
    let scene =
        Computed::of(&std::fs::read_to_string(folder.join("case-1.toml")).unwrap(), &folder.join("case-1.toml"));
    for (ply, equation, mode) in [(1, "eq40", "matrix tension"), (16, "eq41", "matrix compression")] {
        let (decks, scene) = (first(ply, equation), scene.onset(mode, Some(ply)).unwrap());
        assert!((decks / scene - 1.0).abs() < 0.01, "ply {ply}: {decks} s by decks, {scene} s by the scene");
        let judged = event(mode, ply);
        assert!(
            (judged / decks - 1.0).abs() < 1e-9,
            "ply {ply}: {judged} s by the impact, {decks} s by back substitution"
        );
    }
}
