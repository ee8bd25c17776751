//! A scene uses the plug-in by its name: deflections against hex20 and a closed form, errors with the line of the scene.

use std::path::Path;
use std::process::{Command, Output};

const ELEMENT: &str = "element = { kind = \"hex8\", shear = \"assumed\" }";
const FULL: &str = "element = { kind = \"hex8\", shear = \"full\" }";
const HEX20: &str = "element = { kind = \"hex20\" }";
const PLY: &str = "ply_thickness = \"0.25 mm\"";

/// `fem COMMAND` in `folder` on the scene with other lines for element and ply thickness.
fn fem(command: &str, element: &str, ply: &str, folder: &Path, options: &[&str]) -> Output {
    let mut scene = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scene.toml")).unwrap();
    for (from, to) in [(ELEMENT, element), (PLY, ply)] {
        assert_eq!(scene.matches(from).count(), 1, "{from}");
        scene = scene.replace(from, to);
    }
    let file = folder.join("scene.toml");
    std::fs::write(&file, scene).unwrap();
    let fem = Command::new(env!("CARGO_BIN_EXE_plugin-element"))
        .arg(command)
        .arg(&file)
        .args(options)
        .current_dir(folder)
        .output();
    fem.unwrap()
}

/// Deflection of the centre, m.
fn deflection(element: &str, ply: &str) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let run = fem("run", element, ply, folder.path(), &["--out", "results"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let summary = std::fs::read_to_string(folder.path().join("results/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    summary["largest_deflection"]["w_m"].as_f64().unwrap()
}

/// The quadratic brick is converged on this mesh: 0.12216 mm, 4e-5 less than on one twice as fine. Of the difference, 0.6 %
/// remains on that: the strain across the plies, constant through each.
#[test]
fn the_deflection_is_that_of_hex20() {
    let hex20 = deflection(HEX20, PLY);
    let assumed = deflection(ELEMENT, PLY) / hex20 - 1.0;
    assert!(assumed.abs() < 0.01, "{assumed}");
    // Shears of the displacements: 8 % too stiff.
    let full = deflection(FULL, PLY) / hex20 - 1.0;
    assert!((-0.10..-0.07).contains(&full), "{full}");
}

/// A plate of a/h = 200 bends by classical laminate theory (Navier): w = q₀ a⁴ / (π⁴ (D₁₁ + 2 (D₁₂ + 2 D₆₆) + D₂₂)).
#[test]
fn a_thin_plate_bends_and_locks_only_with_full_shears() {
    let (e1, e2, nu12, g12) = (130.3e9, 9.65e9, 0.35, 5.93e9);
    let (ply, side, pressure) = (0.025e-3_f64, 20e-3_f64, 1e6);
    let c = 1.0 - nu12 * nu12 * e2 / e1;
    let (q11, q22, q12) = (e1 / c, e2 / c, nu12 * e2 / c);
    // ∫ z² dz of the inner two plies, at 90 degrees, and of all four.
    let [inner, all] = [1, 2].map(|k| 2.0 / 3.0 * (f64::from(k) * ply).powi(3));
    let (d11, d22) = (q11 * (all - inner) + q22 * inner, q22 * (all - inner) + q11 * inner);
    let d = d11 + 2.0 * (q12 + 2.0 * g12) * all + d22;
    let exact = -pressure * side.powi(4) / (std::f64::consts::PI.powi(4) * d);
    let ply = "ply_thickness = \"0.025 mm\"";
    let assumed = deflection(ELEMENT, ply) / exact;
    assert!((assumed - 1.0).abs() < 0.01, "{assumed}");
    let full = deflection(FULL, ply) / exact;
    assert!(full < 0.2, "{full}");
}

#[test]
fn wrong_parameters_are_shown_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    for (element, words) in [
        (
            "element = { kind = \"hex8\", shear = \"reduced\" }",
            "must be `assumed`: thin cells bend, or `full`: they lock, got `reduced`",
        ),
        ("element = { kind = \"hex8\", sheer = \"full\" }", "did you mean `shear`"),
        ("element = { kind = \"hex9\" }", "did you mean `hex8`"),
    ] {
        let check = fem("check", element, PLY, folder.path(), &[]);
        let stderr = String::from_utf8(check.stderr).unwrap();
        assert_eq!(check.status.code(), Some(1), "{stderr}");
        let words_of_error = stderr.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words_of_error.contains(words), "{words}: {stderr}");
        assert!(stderr.contains(element), "{stderr}");
    }
}
