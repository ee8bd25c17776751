//! One JSON document on standard output, and nothing else there.

use crate::support::{Case, Done, fem, root, strip};
use serde_json::Value;

fn document(done: Done) -> Value {
    let Done { stdout, .. } = done.good();
    let data: Value = serde_json::from_str(&stdout).unwrap_or_else(|why| panic!("{why}: {stdout}"));
    let versions = stdout.lines().filter(|line| line.starts_with("  \"format\":")).count();
    let version = data.get("format").and_then(Value::as_u64);
    assert_eq!((versions, version), if data.is_array() { (0, None) } else { (1, Some(1)) }, "{stdout}");
    data
}

/// The same scene in another analysis.
fn at_rest() -> Case {
    let scene = std::fs::read_to_string(root().join("src/cli/templates/pagano.toml")).unwrap();
    strip().text(&scene)
}

#[test]
fn run_of_an_impact() {
    let case = strip();
    let data = document(case.fem("run", &["--out", "out", "--json"]));
    let file = |name: &str| -> Value { serde_json::from_str(&case.read(name)).unwrap() };
    assert_eq!(data["summary"], file("out/summary.json"));
    assert_eq!(data["cost"], file("out/cost.json"));
    assert_eq!(data["results"], "out");
}

#[test]
fn run_at_rest() {
    let case = at_rest();
    let data = document(case.fem("run", &["--out", "out", "--json"]));
    let summary: Value = serde_json::from_str(&case.read("out/summary.json")).unwrap();
    assert_eq!(data["summary"], summary);
}

#[test]
fn modes() {
    let case = strip();
    let data = document(case.fem("modes", &["--count", "3", "--out", "out", "--json"]));
    let summary: Value = serde_json::from_str(&case.read("out/summary.json")).unwrap();
    assert_eq!(data["summary"], summary);
    assert_eq!(data["summary"]["frequencies_Hz"].as_array().unwrap().len(), 3);
}

#[test]
fn check() {
    let quick = document(strip().fem("check", &["--json"]));
    assert!(quick["not_looked_at"].is_array() && quick["march"].get("static_stiffness_N_m").is_none(), "{quick}");
    let data = document(strip().fem("check", &["--full", "--json"]));
    assert!(data.get("not_looked_at").is_none() && data["march"]["static_stiffness_N_m"].is_f64(), "{data}");
    assert_eq!(data["memory_MB"], quick["memory_MB"]);
    assert_eq!((&data["quads"], &data["layers"], &data["plies"]), (&8.into(), &2.into(), &16.into()));
    assert_eq!(data["march"]["integrator"], "newmark");
    assert_eq!(data["march"]["steps"], 200);
    assert!(data["march"].get("longest_step_s").is_none() && data.get("keys").is_none(), "{data}");
    let at_rest = document(at_rest().fem("check", &["--full", "--json"]));
    assert!(at_rest["condition"].as_f64().is_some_and(|c| c > 1.0) && at_rest.get("march").is_none(), "{at_rest}");
}

#[test]
fn advise() {
    let data = document(Case::example("as4-3502-8ply-25mm").fem("advise", &["--json"]));
    let impact = &data["impact"][0];
    assert_eq!(impact["mass_kg"], 2.49);
    assert!(impact["peak_force_N"].as_f64().is_some_and(|f| f > 100.0));
    let questions: Vec<_> =
        impact["answers"].as_array().unwrap().iter().map(|a| a["question"].as_str().unwrap()).collect();
    assert_eq!(questions.len(), 6, "{questions:?}");
}

#[test]
fn envelope() {
    let folder = tempfile::tempdir().unwrap();
    let data = document(fem(folder.path(), &["envelope", "AS4/3502", "--criteria", "max-stress", "--json"]));
    let rows = data["envelope"].as_array().unwrap();
    let on_the_axis = rows.iter().find(|row| row["angle_deg"] == 0.0).unwrap();
    assert!((on_the_axis["s2_MPa"].as_f64().unwrap() - 64.0).abs() < 1e-9, "{on_the_axis}");
    let lines =
        std::fs::read_to_string(folder.path().join(data["results"].as_str().unwrap()).join("envelope.csv")).unwrap();
    assert_eq!(rows.len(), lines.lines().count() - 1);
}

#[test]
fn list() {
    let data = document(fem(&root(), &["list", "contact-laws", "--json"]));
    let hertz = data.as_array().unwrap().iter().find(|law| law["name"] == "hertz").unwrap();
    assert_eq!(hertz["parameters"][0]["name"], "k");
    let materials = document(fem(&root(), &["list", "materials", "--json"]));
    assert_eq!(materials[0]["name"], "AS4/3502");
    assert!(materials[0]["constants"].as_array().unwrap().iter().any(|c| c["value"] == "130.3 GPa"), "{materials}");
}

#[test]
fn matrices() {
    let case = strip();
    let data = document(case.fem("matrices", &["--out", "out", "--json"]));
    let unknowns = case.read("out/unknowns.csv").lines().count() - 1;
    assert_eq!(data["unknowns"], unknowns);
}

#[test]
fn study() {
    let case = strip();
    let options = ["--axis", "layers", "--budget", "2s", "--out", "out", "--json"];
    let data = document(case.fem("study", &options));
    let (header, rows) = case.table("out/study.csv");
    let runs = data["runs"].as_array().unwrap();
    assert_eq!(runs.len(), rows.len());
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    for (run, row) in runs.iter().zip(&rows) {
        assert_eq!(run["setting"], row[column("setting")]);
        assert_eq!(run["unknowns"].to_string(), row[column("unknowns")]);
    }
    assert!(!data["asked"].as_array().unwrap().is_empty());
}

#[test]
fn templates() {
    let folder = tempfile::tempdir().unwrap();
    let listed = document(fem(folder.path(), &["new", "--list", "--json"]));
    assert_eq!(listed[0]["name"], "drop-weight");
    let written = document(fem(folder.path(), &["new", "plate", "--template", "ring", "--json"]));
    assert_eq!(written["files"], serde_json::json!(["scene.toml", "scene.schema.json", "plate.msh"]));
}
