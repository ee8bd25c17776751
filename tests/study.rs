//! `fem study`: its figures are errors against the full model, and its refusals are said.

use crate::support::{root, strip};

/// Reductions of a cantilever of 8 cells.
#[test]
fn of_reductions() {
    let case = strip();
    let done = case.fem("study", &["--axis", "reduction", "--out", "study"]).good();
    assert!(
        done.stdout.starts_with("Errors against the full model of 558 unknowns at steps of 0.0250 us"),
        "{done:#?}"
    );
    let (header, rows) = case.table("study/study.csv");
    assert_eq!(header[..5], ["axis", "setting", "unknowns_marched", "step_s", "force_L2_error"]);
    let error = |setting: &str| -> f64 {
        let row = rows.iter().find(|r| r[1] == setting).unwrap_or_else(|| panic!("no {setting}"));
        row[4].parse().unwrap_or_else(|_| panic!("{row:?}"))
    };
    // The full model at four times the step of the reference.
    assert!(error("none") > 0.0 && error("none") < 2e-3, "{}", error("none"));
    assert!(
        error("ritz 80") < error("ritz 20") && error("ritz 80") < 5e-3,
        "{} {}",
        error("ritz 80"),
        error("ritz 20")
    );
    // More governors than nodes.
    let refused = rows.iter().find(|r| r[1] == "guyan 20").unwrap();
    assert!(
        refused[4].is_empty() && refused[10].contains("20 governors are asked for, but the model offers only 12"),
        "{refused:?}"
    );
    assert!(done.stdout.contains("| guyan 20 |"), "{done:#?}");
}

#[test]
fn of_integrators() {
    let case =
        strip().scene("end = \"20 us\"", "end = \"4 us\"").append("[reduction]\nmethod = \"ritz\"\nvectors = 10\n");
    case.fem("study", &["--axis", "integrator", "--out", "study"]).good();
    let (_, rows) = case.table("study/study.csv");
    let row = |setting: &str| rows.iter().find(|r| r[1] == setting).unwrap_or_else(|| panic!("no {setting}: {rows:?}"));
    let limited: Vec<_> =
        rows.iter().filter(|r| r[1].starts_with("rk4") && r[10].contains("stability limit")).collect();
    let at_limit: f64 = row("rk4 at its limit")[3].parse().unwrap();
    assert!(limited.iter().all(|r| r[1][4..r[1].len() - 3].parse::<f64>().unwrap() * 1e-6 > at_limit), "{limited:?}");
    let at_limits: Vec<_> = rows.iter().filter(|r| r[1].ends_with("at its limit")).map(|r| &r[1]).collect();
    let limited = ["rk1", "rk2", "rk3", "rk4", "central-difference"].map(|name| format!("{name} at its limit"));
    assert!(at_limits.iter().copied().eq(&limited), "{at_limits:?}");
    assert_eq!(row("newmark 0.1000 us")[2], "10");
}

#[test]
fn of_a_scene_without_an_impact() {
    let scene = std::fs::read_to_string(root().join("examples/pagano-0-90-0/scene.toml")).unwrap();
    let case = strip().text(&scene);
    let done = case.fem("study", &[]);
    assert!(done.status == 1 && done.stderr.contains("the scene describes no impact"), "{done:#?}");
    assert_eq!(case.names("."), ["plate"], "a refusal leaves no folder");
}
