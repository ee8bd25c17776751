//! A scene uses the plug-in by its name: a crack that grows takes the law's toughness, at the force of beams.

use std::path::Path;
use std::process::Command;

/// Beams on an elastic foundation that softens: what the chapter on validation holds the shipped law to.
const PEAK: f64 = 70.03;
const TOUGHNESS: f64 = 210.0;
const CRACK: f64 = 0.025 * 30e-3;

#[test]
fn a_double_cantilever_takes_the_toughness() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scene.toml");
    let fem = Command::new(env!("CARGO_BIN_EXE_plugin-interface-law"))
        .args(["run", &scene.to_string_lossy(), "--out", "results"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(fem.status.success(), "{}", String::from_utf8_lossy(&fem.stderr));
    let summary = std::fs::read_to_string(folder.path().join("results/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let number = |pointer: &str| summary.pointer(pointer).and_then(serde_json::Value::as_f64).unwrap();

    let peak = number("/path/peak_force_N");
    assert!((peak / PEAK - 1.0).abs() < 0.02, "{peak}");
    // A zone before the tip has taken a part.
    let grown = number("/path/delamination/projected_area_mm2") * 1e-6 - CRACK;
    let taken = number("/path/dissipated_J") / (TOUGHNESS * grown);
    assert!((taken - 1.0).abs() < 0.1, "{taken}");
}
