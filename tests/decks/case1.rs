//! The report's case 1, typed as decks and told as a scene.

use super::{Table, number, program, run};
use crate::report::Computed;
use crate::support::root;

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
    let first = |ply: u16, equation: &str| {
        stresses.iter().map(|table| onset(table, ply, equation)).fold(f64::INFINITY, f64::min)
    };
    let scene =
        Computed::of(&std::fs::read_to_string(folder.join("case-1.toml")).unwrap(), &folder.join("case-1.toml"));
    for (ply, equation, mode) in [(1, "eq40", "matrix tension"), (16, "eq41", "matrix compression")] {
        let (decks, scene) = (first(ply, equation), scene.onset(mode, Some(ply)).unwrap());
        assert!((decks / scene - 1.0).abs() < 0.01, "ply {ply}: {decks} s by decks, {scene} s by the scene");
    }
}
