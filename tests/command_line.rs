//! What the command prints and writes when all is well.

use crate::support::{Case, fem, fem_reading, plate, root, strip};
use fem::Registry;
use fem::core::failure::{CriterionInfo, FailureCriterion, Site};
use fem::core::material::Material;
use fem::core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem::core::tensor::{Ply, Stress6};
use serde_json::Value;
use std::process::ExitCode;

/// A case that takes little time and meets damage.
fn quick() -> Case {
    Case::example("as4-3502-8ply-25mm").scene("end = \"1 ms\"", "end = \"0.4 ms\"")
}

#[test]
fn help_and_version() {
    let folder = root();
    for (arguments, words) in [
        (&["--help"][..], "Usage: fem [OPTIONS] <COMMAND>"),
        (&["run", "--help"], "[default: results/<folder of the scene>]"),
        (&["check", "--help"], "<SCENE>"),
        (&["list", "--help"], "contact-laws"),
        (&["--version"], env!("CARGO_PKG_VERSION")),
    ] {
        let done = fem(&folder, arguments).good();
        assert!(done.stdout.contains(words) && done.stderr.is_empty(), "{arguments:?} {done:#?}");
    }
}

#[test]
fn list_shows_the_registry() {
    let registry = Registry::standard();
    for (what, kind) in [
        ("elements", Kind::Element),
        ("criteria", Kind::Criterion),
        ("contact-laws", Kind::Contact),
        ("integrators", Kind::Integrator),
        ("reductions", Kind::Reduction),
    ] {
        let listed = fem(&root(), &["list", what]).good().stdout;
        let mut lines = listed.lines();
        for info in registry.list(kind) {
            let line = lines.next().unwrap();
            for words in [info.name, info.summary, info.source] {
                assert!(line.contains(words), "{words:?} is not in {line:?}");
            }
            assert!(line.starts_with(&format!("{} ", info.name)), "{line}");
            if kind == Kind::Element {
                assert!(lines.next().unwrap().trim().starts_with("stands on "));
            }
            for parameter in info.params {
                assert_eq!(lines.next().unwrap().trim(), format!("{}: {parameter}", parameter.name));
            }
        }
        if kind == Kind::Reduction {
            assert!(lines.next().unwrap().starts_with("none "));
        }
        assert_eq!(lines.next(), None);
    }
}

#[test]
fn list_shows_the_materials() {
    let listed = fem(&root(), &["list", "materials"]).good().stdout;
    let mut lines = listed.lines();
    for name in fem::io::materials::names() {
        let material = fem::io::materials::library(name).unwrap();
        let line = lines.next().unwrap();
        assert!(line.starts_with(&format!("{name} ")) && line.ends_with(&material.summary), "{line}");
        for c in &material.constants {
            let range = c.range.as_ref().map_or_else(String::new, |[low, high]| format!(" ({low} to {high})"));
            let constant = format!("{}: {}{range}, {} [{}]", c.key, c.value, c.status, c.source);
            assert_eq!(lines.next().unwrap().trim(), constant);
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn list_shows_the_materials_that_suffice() {
    let complete = |wanted: &str| {
        let listed = fem(&root(), &["list", "materials", "--complete-for", wanted]).good().stdout;
        listed.lines().filter(|line| !line.starts_with(' ')).map(str::to_owned).collect::<Vec<_>>()
    };
    let has = |all: &[String], name: &str| all.iter().any(|line| line.starts_with(&format!("{name} ")));
    assert_eq!(complete("impact").len(), fem::io::materials::names().count());
    let opens = complete("delamination");
    assert!(has(&opens, "IM7/8552") && has(&opens, "HTA/6376") && !has(&opens, "AS4/3502") && !has(&opens, "steel"));
    let cracks = complete("damage");
    assert!(has(&cracks, "T700/M21") && !has(&cracks, "AS4/8552"));
    assert!(has(&complete("cure"), "steel") && has(&complete("failure"), "S-glass/epoxy"));
    let refused = fem(&root(), &["list", "criteria", "--complete-for", "cure"]);
    assert!(refused.status != 0 && refused.stderr.contains("of materials, not of criteria"), "{refused:#?}");
}

#[test]
fn check_of_every_example() {
    let folders = root().join("examples").read_dir().unwrap().map(|entry| entry.unwrap().path());
    // The scene of an outside crate names what only that crate knows.
    let own = folders.filter(|folder| !folder.join("Cargo.toml").exists());
    let mut scenes: Vec<_> = own.map(|folder| folder.join("scene.toml")).filter(|scene| scene.exists()).collect();
    scenes.sort();
    assert!(scenes.len() >= 8, "{scenes:?}");
    for scene in scenes {
        let done = fem(&root(), &["check", "--full", scene.to_str().unwrap()]).good();
        let at_rest = done.stdout.contains("analysis  ");
        let limit = if at_rest { "static" } else { "stability limit" };
        for words in ["quads", "plies", "unknowns", limit, "the scene is valid"] {
            assert!(done.stdout.contains(words), "{words:?} is not in {done:#?}");
        }
        assert!(!done.stdout.contains("warning"), "{done:#?}");
    }
}

#[test]
fn check_prints_sizes_and_the_stable_step() {
    let case = strip().scene("[march]", "[march]\nintegrator = \"rk4\"\nstep = \"0.01 us\"");
    // The frequencies of a reduced model depend on rounding in their last digits.
    let shown = |options| case.fem("check", options).good().stdout.replace(|c: char| c.is_ascii_digit(), "#");
    insta::assert_snapshot!(shown(&["--full"]));
    insta::assert_snapshot!("check_without_the_stiffness", shown(&[]));
    assert_eq!(case.names("."), ["plate"], "a check writes nothing");
}

/// Everything about the folder of the results of one run.
#[test]
fn run_writes_its_results_to_a_folder_named_like_that_of_the_scene() {
    let case = quick();
    let done = case.fem("run", &[]).good();
    assert!(done.stdout.ends_with("  results   results/plate\n"), "{done:#?}");
    assert_eq!(done.stderr, "");
    assert_eq!(case.names("."), ["plate", "results"]);
    assert_eq!(case.names("results"), ["plate"]);
    let files = [
        ".fem",
        "checkpoint.bin",
        "contact_force.png",
        "contact_force.svg",
        "cost.json",
        "damage.json",
        "damage_map.png",
        "damage_map.svg",
        "damage_section.png",
        "damage_section.svg",
        "displacement.png",
        "displacement.svg",
        "energy.png",
        "energy.svg",
        "events.csv",
        "force_displacement.png",
        "force_displacement.svg",
        "history.csv",
        "scene.toml",
        "summary.json",
    ];
    assert_eq!(case.names("results/plate"), files);

    let (header, rows) = case.table("results/plate/history.csv");
    assert_eq!(header[..2], ["time_s", "contact_force_N"]);
    assert_eq!(rows.len(), 2001);
    let numbers: Vec<Vec<f64>> = rows.iter().map(|r| r.iter().map(|v| v.parse().unwrap()).collect()).collect();
    assert!(numbers.iter().flatten().all(|v| v.is_finite()));
    assert!(numbers.windows(2).all(|pair| pair[0][0] < pair[1][0]), "times grow");
    assert!((numbers[2000][0] - 0.4e-3).abs() < 1e-12, "the last row is the end");

    let (header, rows) = case.table("results/plate/events.csv");
    assert_eq!(header[..5], ["time_s", "criterion", "mode", "cell", "ply"]);
    assert!(!rows.is_empty());
    let times: Vec<f64> = rows.iter().map(|r| r[0].parse().unwrap()).collect();
    assert!(times.is_sorted(), "{times:?}");

    let svg = case.read("results/plate/contact_force.svg");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{svg}");
    let png = std::fs::read(case.folder().join("results/plate/contact_force.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));

    let summary = case.summary("results/plate");
    let peak = numbers.iter().fold(0.0_f64, |m, r| m.max(r[1]));
    let found = summary["impact"]["peak_force_N"].as_f64().unwrap();
    assert!((peak..1.001 * peak).contains(&found), "a row is every other step: {found}, {peak}");
    assert_eq!(summary["completed"], true);
    assert_eq!(summary["work"]["steps"], 4000);
    check_summary(&summary);
    assert!(summary.as_object().is_some_and(|s| s.len() > 10), "{summary}");

    let cost: Value = serde_json::from_str(&case.read("results/plate/cost.json")).unwrap();
    check_summary(&cost);
    let phases: Vec<_> = cost["phases"].as_array().unwrap().iter().map(|p| p["name"].as_str().unwrap()).collect();
    assert_eq!(phases, ["assemble", "reduce", "accuracy", "prepare stresses", "march", "scan", "checkpoint"]);
    assert_eq!(cost["threads"], std::thread::available_parallelism().unwrap().get());
}

/// Numbers of the summary that have no unit.
const PURE: &[&str] = &[
    "quads",
    "layers",
    "cells",
    "nodes",
    "plies",
    "unknowns",
    "unknowns_marched",
    "stiffness_entries",
    "factor_entries",
    "stress_sites",
    "contacts",
    "cell",
    "elements",
    "factorisations",
    "solves",
    "steps",
    "contact_calls",
    "criterion_calls",
    "reserve_factor",
    "threads",
    "format",
];

/// Ends of the names of quantities: their units, or what makes them pure.
const UNITS: &[&str] = &[
    "_mm",
    "_g",
    "_Hz",
    "_kg",
    "_m_s",
    "_J",
    "_s",
    "_N",
    "_m",
    "_over_thickness",
    "_N_s",
    "_deg",
    "_MB",
    "_relative",
    "_index",
    "_MPa",
    "_J_m2",
    "_share",
];

/// Every number has its unit in its name, and what is absent is left out.
fn check_summary(summary: &Value) {
    fn check(key: &str, value: &Value) {
        match value {
            Value::Null => panic!("{key} is null"),
            Value::Number(_) => {
                assert!(PURE.contains(&key) || UNITS.iter().any(|unit| key.ends_with(unit)), "{key} has no unit");
            }
            Value::Object(entries) => entries.iter().for_each(|(key, value)| check(key, value)),
            Value::Array(items) => items.iter().for_each(|value| check(key, value)),
            Value::String(_) | Value::Bool(_) => {}
        }
    }
    check("summary", summary);
}

#[test]
fn without_plots_there_are_tables_alone() {
    let case = strip().append("[output]\nplots = false\n");
    case.fem("run", &["--out", "out"]).good();
    let files = [".fem", "checkpoint.bin", "cost.json", "events.csv", "history.csv", "scene.toml", "summary.json"];
    assert_eq!(case.names("out"), files);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let case = quick();
    for threads in ["1", "2"] {
        case.fem("run", &["--threads", threads, "--out", threads]).good();
    }
    for file in ["history.csv", "events.csv", "summary.json"] {
        let one = case.read(&format!("1/{file}"));
        assert!(one.lines().count() > 1, "{file}");
        assert!(case.read(&format!("2/{file}")) == one, "{file} with two threads");
    }
}

/// A criterion of somebody else's: stress along the fibres against a limit of its own.
#[derive(Debug, Clone)]
struct FibreLimit {
    limit: f64,
}

impl FailureCriterion for FibreLimit {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["along the fibres"],
            strengths: &[],
            invariant_about_fibre: true,
        };
        &INFO
    }

    fn indices(&self, s: &Stress6<Ply>, _: &Material, out: &mut [f64]) {
        out[0] = s.s11().abs() / self.limit;
    }
}

const LIMIT: ParamInfo = ParamInfo::quantity("limit", "stress at failure", Dimension::PRESSURE).above(0.0);

impl Plugin for FibreLimit {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "fibre-limit",
        summary: "stress along the fibres",
        source: "a test",
        params: &[LIMIT],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self { limit: params.number(&LIMIT)? })))
    }
}

#[test]
fn a_plug_in_from_outside() {
    let criteria = "criteria = [{ name = \"fibre-limit\", limit = \"10 MPa\" }]";
    let case = strip().scene("criteria = [\"hashin-report\", \"octahedral\"]", criteria);
    case.write();
    let scene = case.folder().join("plate/scene.toml");
    let out = case.folder().join("out");
    let arguments = ["fem", "run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let registry = Registry::standard().with::<FibreLimit>();
    assert_eq!(fem::cli::run_with(registry, arguments), ExitCode::SUCCESS);
    let (_, events) = case.table("out/events.csv");
    assert!(events.iter().any(|e| e[1..3] == ["fibre-limit", "along the fibres"]), "{events:?}");

    let done = case.fem("run", &[]);
    assert!(done.status == 1 && done.stderr.contains("there is no criterion `fibre-limit`"), "{done:#?}");
}

/// Whoever reads a scene takes keys over those that stand in it, from a file or from standard input.
#[test]
fn what_is_set_is_as_if_it_stood_in_the_scene() {
    let scene = std::fs::read_to_string(root().join("tests/data/scenes/study.toml")).unwrap();
    let other = |text: &str| text.replace("\"0.25 mm\"", "\"0.3 mm\"").replace("\"2 m/s\"", "\"1.5 m/s\"");
    let set = ["--set", "laminate.ply_thickness=0.3", "--set", "impactor.velocity=1.5"];
    for (command, options, file) in [
        ("run", &["--accuracy", "20 %"][..], "summary.json"),
        ("check", &[], ""),
        ("advise", &[], ""),
        ("modes", &["--count", "3"], "modes.csv"),
        ("study", &["--axis", "step", "--tolerance", "50 %"], "scene.toml"),
        ("matrices", &[], "stiffness.mtx"),
    ] {
        let (written, as_it_is) = (plate().text(&other(&scene)), plate().text(&scene));
        let out = if file.is_empty() { &[][..] } else { &["--out", "out"] };
        let options = [options, out].concat();
        let expected = written.fem(command, &options).good();
        let found = |case: &Case| case.read(&format!("out/{file}")).replace(&case.folder().display().to_string(), "");
        for piped in [false, true] {
            let options = [&options[..], &set].concat();
            let done = match piped {
                false => as_it_is.fem(command, &options),
                true => fem_reading(as_it_is.folder(), &[&[command, "-"], &options[..]].concat(), &scene),
            };
            let done = done.good();
            match file {
                "" => assert_eq!(done.stdout, expected.stdout, "{command}"),
                _ => assert_eq!(found(&as_it_is), found(&written), "{command}"),
            }
        }
    }
}
