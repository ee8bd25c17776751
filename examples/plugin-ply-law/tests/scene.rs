//! A scene uses the plug-in by its name: a plate in pure shear has the law's own strain and energy.

use std::path::Path;
use std::process::Command;

const G: f64 = 5.93e9;
const TAU: f64 = 60e6;

#[test]
fn a_plate_in_shear_loses_what_the_cracks_take() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scene.toml");
    let fem = Command::new(env!("CARGO_BIN_EXE_plugin-ply-law"))
        .args(["run", &scene.to_string_lossy(), "--out", "results"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(fem.status.success(), "{}", String::from_utf8_lossy(&fem.stderr));
    let summary = std::fs::read_to_string(folder.path().join("results/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();

    // (1 − d(γ)) G γ = τ by bisection, and the energy under the curve less the triangle by the trapezoidal rule.
    let damage = |gamma: f64| 0.4 * (1.0 - (-(gamma - 0.005_f64).max(0.0) / 0.02).exp());
    let tau = |gamma: f64| (1.0 - damage(gamma)) * G * gamma;
    let (mut low, mut high) = (0.0, 0.05);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if tau(middle) < TAU { low = middle } else { high = middle }
    }
    let steps = 100_000;
    let under: f64 =
        (0..steps).map(|k| tau(low * (f64::from(k) + 0.5) / f64::from(steps))).sum::<f64>() * low / f64::from(steps);
    let lost = (under - 0.5 * TAU * low) * 80e-9;
    let found = summary["ply_laws"]["dissipated_J"].as_f64().unwrap_or_else(|| panic!("{summary}"));
    assert!((found / lost - 1.0).abs() < 1e-6, "{found} {lost}");
}
