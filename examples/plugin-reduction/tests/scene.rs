//! A scene uses the plug-in by its name: forces against those of many Krylov vectors, errors with the line of the scene.

use std::path::Path;
use std::process::{Command, Output};

const REDUCTION: &str = "method = \"shifted-krylov\"\nvectors = 16\nabout = \"50 kHz\"";

/// `fem COMMAND` in `folder` on the scene with another reduction.
fn fem(command: &str, reduction: &str, folder: &Path, options: &[&str]) -> Output {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = std::fs::read_to_string(here.join("scene.toml")).unwrap();
    let mesh = here.join("../as4-3502-8ply-25mm/plate.msh").canonicalize().unwrap();
    let scene = scene.replace("../as4-3502-8ply-25mm/plate.msh", &mesh.to_string_lossy().replace('\\', "/"));
    assert_eq!(scene.matches(REDUCTION).count(), 1);
    let file = folder.join("scene.toml");
    std::fs::write(&file, scene.replace(REDUCTION, reduction)).unwrap();
    let fem = Command::new(env!("CARGO_BIN_EXE_plugin-reduction"))
        .arg(command)
        .arg(&file)
        .args(options)
        .current_dir(folder)
        .output();
    fem.unwrap()
}

/// The contact force over time, N.
fn force(reduction: &str) -> Vec<f64> {
    let folder = tempfile::tempdir().unwrap();
    let run = fem("run", reduction, folder.path(), &["--out", "results"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let history = std::fs::read_to_string(folder.path().join("results/history.csv")).unwrap();
    let rows: Vec<Vec<&str>> = history.lines().map(|line| line.split(',').collect()).collect();
    let column = rows[0].iter().position(|name| *name == "contact_force_N").unwrap();
    rows[1..].iter().map(|row| row[column].parse().unwrap()).collect()
}

/// ‖a − b‖ / ‖b‖.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (off / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

#[test]
fn the_force_converges_to_that_of_many_krylov_vectors() {
    let converged = force("method = \"ritz\"\nvectors = 100\nspace = \"krylov\"");
    let of = |vectors: usize| {
        let few = REDUCTION.replace("vectors = 16", &format!("vectors = {vectors}"));
        difference(&force(&few), &converged)
    };
    let [few, many] = [8, 16].map(of);
    assert!(many < 1e-2 && many < 0.5 * few, "{few:e} {many:e}");
}

#[test]
fn wrong_parameters_are_shown_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    for (from, to, words) in [
        ("shifted-krylov", "shifted-kyrlov", "did you mean `shifted-krylov`"),
        ("about", "around", "`around`: is not known"),
        ("50 kHz", "50 mm", "must be a quantity in 1/s, above 0, got 0.05 m"),
        ("vectors = 16", "vectors = 1000000000", "must be a whole number from 1 to 1e3"),
    ] {
        let check = fem("check", &REDUCTION.replace(from, to), folder.path(), &[]);
        let stderr = String::from_utf8(check.stderr).unwrap();
        assert_eq!(check.status.code(), Some(1), "{stderr}");
        assert!(stderr.contains(words) && stderr.contains("scene.toml"), "{words}: {stderr}");
    }
}
