//! A scene uses the effect by its key: its column stands in the history, and what it excludes is refused.

use std::path::Path;
use std::process::{Command, Output};

/// `fem COMMAND` on the scene with `effects` in the place of its foundation.
fn fem(command: &str, effects: &str, folder: &Path, options: &[&str]) -> Output {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = std::fs::read_to_string(here.join("scene.toml")).unwrap();
    let mesh = here.join("../as4-3502-8ply-25mm/plate.msh").canonicalize().unwrap();
    let scene = scene.replace("../as4-3502-8ply-25mm/plate.msh", &mesh.to_string_lossy().replace('\\', "/"));
    let file = folder.join("scene.toml");
    std::fs::write(&file, scene.replace("foundation = \"20 N/mm^3\"", effects)).unwrap();
    let fem = Command::new(env!("CARGO_BIN_EXE_plugin-effect"))
        .arg(command)
        .arg(&file)
        .args(options)
        .current_dir(folder)
        .output();
    fem.unwrap()
}

#[test]
fn the_column_stands_in_the_history() {
    let folder = tempfile::tempdir().unwrap();
    let run = fem("run", "foundation = \"20 N/mm^3\"", folder.path(), &["--out", "results"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let history = std::fs::read_to_string(folder.path().join("results/history.csv")).unwrap();
    let rows: Vec<Vec<&str>> = history.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| -> Vec<f64> {
        let column = rows[0].iter().position(|c| *c == name).unwrap_or_else(|| panic!("{name}: {:?}", rows[0]));
        rows[1..].iter().map(|row| row[column].parse().unwrap()).collect()
    };
    let (foundation, strain) = (column("foundation_J"), column("plate_strain_J"));
    assert!(foundation.iter().zip(&strain).all(|(part, whole)| (0.0..=whole * (1.0 + 1e-9) + 1e-15).contains(part)));
    assert!(foundation.iter().any(|energy| *energy > 1e-5), "of 20 mJ");
    assert!(column("energy_balance_J").iter().all(|error| error.abs() < 1e-4 * 0.02));
}

#[test]
fn lists_and_errors_know_it() {
    let folder = tempfile::tempdir().unwrap();
    for (effects, words) in [
        ("foundation = \"20 N/mm^2\"", "`effects.foundation`"),
        ("fundation = \"20 N/mm^3\"", "did you mean `foundation`"),
        (
            "foundation = \"20 N/mm^3\"\nmembrane = \"on\"",
            "leave one of `effects.membrane` and `effects.foundation` out",
        ),
    ] {
        let check = fem("check", effects, folder.path(), &[]);
        let stderr = String::from_utf8(check.stderr).unwrap().replace('│', " ");
        let said = stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(check.status.code() == Some(1) && said.contains(words), "{words}: {stderr}");
    }
    let listed = Command::new(env!("CARGO_BIN_EXE_plugin-effect")).args(["list", "effects"]).output().unwrap();
    assert!(String::from_utf8_lossy(&listed.stdout).lines().any(|line| line.starts_with("foundation ")));
}
