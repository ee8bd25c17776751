//! A scene uses the plug-in by its name: forces against those of Newmark's method, errors with the line of the scene.

use std::path::Path;
use std::process::{Command, Output};

const INTEGRATOR: &str = "integrator = \"tr-bdf2\"\nstep = \"1 us\"";

/// `fem COMMAND` in `folder` on the scene with another integrator and step.
fn fem(command: &str, integrator: &str, folder: &Path, options: &[&str]) -> Output {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = std::fs::read_to_string(here.join("scene.toml")).unwrap();
    let mesh = here.join("../as4-3502-8ply-25mm/plate.msh").canonicalize().unwrap();
    let scene = scene.replace("../as4-3502-8ply-25mm/plate.msh", &mesh.to_string_lossy().replace('\\', "/"));
    assert_eq!(scene.matches(INTEGRATOR).count(), 1);
    let file = folder.join("scene.toml");
    std::fs::write(&file, scene.replace(INTEGRATOR, integrator)).unwrap();
    let fem = Command::new(env!("CARGO_BIN_EXE_plugin-integrator"))
        .arg(command)
        .arg(&file)
        .args(options)
        .current_dir(folder)
        .output();
    fem.unwrap()
}

/// Largest contact force, N.
fn peak(integrator: &str) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let run = fem("run", integrator, folder.path(), &["--out", "results"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let summary = std::fs::read_to_string(folder.path().join("results/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    summary["impact"]["peak_force_N"].as_f64().unwrap()
}

#[test]
fn the_force_converges_to_that_of_newmark() {
    let converged = peak("integrator = \"newmark\"\nstep = \"0.025 us\"");
    let [coarse, fine] = ["0.5 us", "0.05 us"]
        .map(|step| (peak(&format!("integrator = \"tr-bdf2\"\nstep = \"{step}\"")) / converged - 1.0).abs());
    assert!(fine < 2e-4 && fine < 0.1 * coarse, "{coarse:e} {fine:e}");
}

#[test]
fn wrong_parameters_are_shown_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    for (line, words) in [
        ("integrator = \"tr-bdf\"\nstep = \"1 us\"", "did you mean `tr-bdf2`"),
        ("integrator = { name = \"tr-bdf2\", rho = 0.5 }\nstep = \"1 us\"", "`rho`: is not known"),
    ] {
        let check = fem("check", line, folder.path(), &[]);
        let stderr = String::from_utf8(check.stderr).unwrap();
        assert_eq!(check.status.code(), Some(1), "{stderr}");
        assert!(stderr.contains(words) && stderr.contains("tr-bdf"), "{words}: {stderr}");
    }
}
