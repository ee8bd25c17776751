//! Failure indices over time and over the plate, what failed first and why, and the threshold of delamination.

use crate::support::{Case, plate, strip};
use fem::core::failure::FailureCriterion;
use fem::core::tensor::Stress6;
use fem::failure::HashinReport;

const CRITERIA: &str = "criteria = [\"hashin-report\", \"octahedral\"]";

/// The strip with lines about what is watched and written.
fn watching(watch: &str, output: &str) -> Case {
    strip().scene(CRITERIA, &format!("{CRITERIA}\nwatch = [{watch}]")).append(&format!("\n[output]\n{output}\n"))
}

fn numbers(row: &[String], columns: &[usize]) -> Vec<f64> {
    columns.iter().map(|c| row[*c].parse().unwrap()).collect()
}

#[test]
fn histories_and_maps_agree_with_each_other_and_with_the_events() {
    let watch =
        r#"{ at = { x = "15 mm", y = "5 mm" }, ply = 16 }, { at = { x = "5 mm", y = "2 mm" }, interface = "8|9" }"#;
    let case = watching(watch, "maps = true").scene("end = \"20 us\"", "end = \"100 us\"");
    let case = case.scene("library = \"AS4/3502\"", "library = \"AS4/3502\", Yt = \"2 MPa\"");
    case.fem("run", &["--out", "out"]).good();
    let (header, history) = case.table("out/index_history.csv");
    assert_eq!(header, ["time_s", "criterion", "mode", "cell", "ply", "x_m", "y_m", "z_m", "index"]);
    let (header, maxima) = case.table("out/index_maxima.csv");
    assert_eq!(header, ["criterion", "mode", "cell", "ply", "x_m", "y_m", "z_m", "index"]);

    // A sample every 5 us from 0 to 100 us, four modes in the ply, one in the interface.
    let of = |criterion: &str, ply: &str| {
        let of = |row: &&Vec<String>| row[1] == criterion && row[4] == ply;
        history.iter().filter(of).cloned().collect::<Vec<_>>()
    };
    let (ply, interface) = (of("hashin-report", "16"), of("octahedral", "8|9"));
    assert_eq!((ply.len(), interface.len(), history.len()), (4 * 21, 21, 5 * 21));
    assert_eq!((ply[0][0].as_str(), ply[83][0].as_str()), ("0.0", interface[20][0].as_str()));
    assert!((numbers(&ply[83], &[0])[0] - 1e-4).abs() < 1e-15);

    // The map holds every site once, and at the watched ones the largest index of the history.
    let sites = case.summary("out")["model"]["stress_sites"].as_u64().unwrap();
    let interfaces = maxima.iter().filter(|row| row[0] == "octahedral").count() as u64;
    assert_eq!(maxima.len() as u64, sites, "each criterion looks at its own sites");
    // 15 interfaces, the one between the layers of cells from either side, and 16 plies.
    assert_eq!(interfaces * 32, sites * 16);
    for (rows, sites) in [(&ply, "16"), (&interface, "8|9")] {
        let largest = rows.iter().map(|row| numbers(row, &[8])[0]).fold(0.0, f64::max);
        // Other windows of the cell have other places.
        let here = |row: &&Vec<String>| row[2] == rows[0][3] && row[3] == sites && row[4..6] == rows[0][5..7];
        let there: Vec<_> = maxima.iter().filter(here).collect();
        // Between the layers of cells there is a stress from either side.
        assert_eq!(there.len(), if sites == "16" { 1 } else { 2 }, "{there:?}");
        assert_eq!(there.iter().map(|row| numbers(row, &[7])[0]).fold(0.0, f64::max), largest);
        assert!(largest > 0.0);
    }

    let (_, events) = case.table("out/events.csv");
    assert!(!events.is_empty());
    for event in &events {
        let here = |row: &&Vec<String>| row[0] == event[1] && row[2] == event[3] && row[3] == event[4];
        let largest = maxima.iter().filter(here).map(|row| numbers(row, &[7])[0]).fold(0.0, f64::max);
        assert!(largest >= numbers(event, &[9])[0], "{event:?}: {largest:?}");
    }

    let svg = case.read("out/index_history.svg");
    for words in ["hashin-report, ply 16 at (", "octahedral, ply 8|9 at (", ">failure<", ">Failure index<"] {
        assert!(svg.contains(words), "{words}");
    }
    assert!(std::fs::read(case.folder().join("out/index_history.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn nothing_of_it_is_written_unless_asked_for() {
    let case = strip();
    case.fem("run", &["--out", "out"]).good();
    assert!(!case.names("out").iter().any(|name| name.starts_with("index")), "{:?}", case.names("out"));
    let case = watching(r#"{ at = { x = "15 mm", y = "5 mm" }, ply = 1 }"#, "plots = false");
    case.fem("run", &["--out", "out"]).good();
    let files = [
        ".fem",
        "checkpoint.bin",
        "cost.json",
        "events.csv",
        "history.csv",
        "index_history.csv",
        "scene.toml",
        "summary.json",
    ];
    assert_eq!(case.names("out"), files);
}

/// The stress of an event is the one at which its mode's index is 1, within what interpolation does to it.
#[test]
fn what_failed_first_comes_with_the_stress_that_explains_it() {
    let case = Case::example("as4-3502-8ply-25mm").scene("end = \"1 ms\"", "end = \"0.4 ms\"");
    let done = case.fem("run", &["--out", "out"]).good();
    assert!(done.stdout.contains("  why       stress there at that time, MPa"), "{}", done.stdout);
    let summary = case.summary("out");
    let first = summary["first_damage"].as_array().unwrap();
    let material = &fem::io::materials::library("AS4/3502").unwrap().material;
    let criterion = HashinReport::default();
    let mut seen = 0;
    for event in first.iter().filter(|event| event["criterion"] == "hashin-report") {
        let component = |name| event["stress"][name].as_f64().unwrap() * 1e6;
        let stress = Stress6::new(["s11_MPa", "s22_MPa", "s33_MPa", "s12_MPa", "s23_MPa", "s13_MPa"].map(component));
        let mut indices = [f64::NAN; 4];
        criterion.indices(&stress, material, &mut indices);
        let mode = criterion.info().modes.iter().position(|mode| event["mode"] == *mode).unwrap();
        assert!((indices[mode] - 1.0).abs() < 0.01, "{event}: {indices:?}");
        let factor = criterion.reserve_factor(&stress, material).factor;
        assert!((event["reserve_factor"].as_f64().unwrap() / factor - 1.0).abs() < 1e-12, "{event}: {factor}");
        seen += 1;
    }
    assert!(seen > 0, "{summary}");
}

/// F = π √(32 · 43.1 N·m · 500 J/m² / 3) = 1506 N, to the digits of 43.1.
#[test]
fn the_threshold_of_delamination_is_an_event_of_the_summary() {
    let tough = |case: Case, giic: &str| {
        case.scene("library = \"AS4/3502\"", &format!("library = \"AS4/3502\", GIIc = \"{giic}\""))
    };
    let case = tough(plate(), "0.5 N/mm").scene("end = \"1 ms\"", "end = \"0.9 ms\"");
    let case = case.append("[output]\nhistory_every = \"0.1 us\"\n");
    let done = case.fem("run", &["--out", "out"]).good();
    assert!(done.stdout.contains("a threshold, not a stress criterion"), "{}", done.stdout);
    let summary = case.summary("out");
    let threshold = |key: &str| summary["delamination_threshold"][key].as_f64().unwrap();
    assert!((threshold("force_N") - 1507.0).abs() < 1.0, "{summary}");
    // Of sixteen plies only the two in the middle are alike.
    assert_eq!(threshold("interfaces"), 14.0);
    assert!((threshold("force_of_all_N") / (threshold("force_N") * (3.0_f64 / 16.0).sqrt()) - 1.0).abs() < 1e-12);
    assert!(threshold("time_of_all_s") < threshold("time_s"), "{summary}");
    assert!(summary["cautions"].to_string().contains("all 14 interfaces between unlike plies"), "{summary}");
    assert!((threshold("bending_stiffness_N_m") - 43.1).abs() < 0.05, "{summary}");
    assert_eq!(threshold("toughness_GIIc_J_m2"), 500.0);
    // The history has every step, so that it brackets the crossing.
    let (_, rows) = case.table("out/history.csv");
    let rows: Vec<_> = rows.iter().map(|row| numbers(row, &[0, 1])).collect();
    let after = rows.iter().position(|row| row[1] >= threshold("force_N")).unwrap();
    let time = threshold("time_s");
    assert!(rows[after - 1][0] < time && time <= rows[after][0], "{time}: {:?}", &rows[after - 1..=after]);
    assert!(case.read("out/contact_force.svg").contains("delamination threshold"));

    let case = tough(strip(), "50 N/mm");
    let done = case.fem("run", &["--out", "out"]).good();
    assert!(done.stdout.contains("not reached: the peak is 0."), "{}", done.stdout);
    assert!(case.summary("out")["delamination_threshold"].get("time_s").is_none());
    let case = strip();
    case.fem("run", &["--out", "out"]).good();
    assert!(case.summary("out").get("delamination_threshold").is_none(), "no toughness, no threshold");
}

#[test]
fn one_criterion_may_judge_twice_under_two_names() {
    let criteria = r#"criteria = ["tsai-wu", { name = "tsai-wu", as = "no interaction", f12 = 0.0 }]"#;
    let case = strip().scene(CRITERIA, criteria);
    case.fem("run", &["--out", "out"]).good();
    let summary = case.summary("out");
    let judged = |key: &str| summary[key].as_array().unwrap().clone();
    let mut names: Vec<_> =
        [judged("first_damage"), judged("not_reached")].concat().iter().map(|d| d["criterion"].to_string()).collect();
    names.sort();
    assert_eq!(names, ["\"no interaction\"", "\"tsai-wu\""]);
}
