//! Every wrong key of `output.fields` is said with its line and a remedy.

use super::struck;
use crate::support::Case;

#[track_caller]
fn refused(case: &Case, words: &[&str]) {
    let done = case.fem("check", &[]);
    assert_eq!((done.status, done.stdout.as_str()), (1, ""), "{done:#?}");
    let said = done.stderr.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    let text = case.read("plate/scene.toml");
    let line = text.lines().position(|line| line.starts_with("fields = ")).unwrap() + 1;
    let place = format!("[plate/scene.toml:{line}:");
    for words in words.iter().chain([&place.as_str()]) {
        assert!(said.contains(words), "{words:?} is not in {said}");
    }
}

#[test]
fn of_an_impact() {
    for (fields, words) in [
        ("1", &["`output.fields`: must be a table", "got"] as &[&str]),
        ("{ evry = \"1 us\" }", &["unknown key `output.fields.evry`", "every"]),
        ("{ every = 5 }", &["`output.fields.every`", "unit"]),
        ("{ every = \"0 us\" }", &["must be positive"]),
        ("{ every = \"5 mm\" }", &["`output.fields.every`", "time"]),
        ("{ times = [] }", &["`output.fields.times`: the list is empty"]),
        (
            "{ times = [\"21 us\"] }",
            &["2.1e-5 s is not within the march, which ends at 2e-5 s", "from 0 to `march.end`"],
        ),
        ("{ times = [\"-1 us\"] }", &["is not within the march"]),
        ("{ region = {} }", &["`output.fields.region.radius` is missing", "a group of cells"]),
        ("{ region = { radius = \"1 mm\", group = \"plate\" } }", &["cannot be combined with `radius`"]),
        ("{ region = { radius = \"1 um\" } }", &["no cell has its centre within this radius", "enlarge it"]),
        ("{ region = { group = \"core\" } }", &["the mesh has no group `core`", "plate"]),
        ("{ region = { group = \"tip\" } }", &["group `tip` has no cells", "name a group of cells"]),
        ("{ parts = [\"ply\"] }", &["`ply` is not one of the known words", "plies"]),
        ("{ parts = [] }", &["the list is empty"]),
        ("{ cells = \"cubic\" }", &["`cubic` is not one of the known words", "lagrange"]),
    ] {
        refused(&struck(fields), words);
    }
    let fine = struck("{ every = \"1 us\" }").scene("end = \"20 us\"", "end = \"11 ms\"");
    refused(&fine, &["a frame every 1e-6 s makes 11000 frames", "at most 10000", "lengthen the interval"]);
    let bare = struck("{ parts = [\"interfaces\"] }").scene("interface = \"resin\"\n", "");
    let bare = bare.scene("criteria = [\"hashin-report\", \"octahedral\"]", "criteria = [\"hashin-report\"]");
    refused(&bare, &["the scene has no interfaces between plies", "`laminate.interface`"]);
}

#[test]
fn of_a_state_at_rest() {
    let example = |fields: &str| {
        let scene = std::fs::read_to_string(crate::support::root().join("examples/pagano-0-90-0/scene.toml")).unwrap();
        crate::support::plate().text(&format!("{scene}[output]\nfields = {fields}\n"))
    };
    for key in ["every = \"1 us\"", "times = [\"0 us\"]"] {
        refused(&example(&format!("{{ {key} }}")), &["only an impact is marched in time", "leave it out"]);
    }
    refused(
        &example("{ region = { radius = \"1 mm\" } }"),
        &["is measured from the impact, and this analysis has none", "`group`"],
    );
}

#[test]
fn a_resumed_run_keeps_its_fields() {
    let case = struck("true");
    case.fem("run", &["--out", "out"]).good();
    let other = case.scene("fields = true", "fields = false");
    let done = other.fem("run", &["--out", "out", "--resume"]);
    assert!(done.status == 1 && done.stderr.contains("`output.fields` was true and is false"), "{done:#?}");
}
