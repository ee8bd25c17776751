//! `fem run --set` and `fem sweep`: a row is a run.

use crate::support::{Case, coming_apart, fem, read_under};
use fem::Registry;
use fem::io::scene::Setting;
use fem::job::{self, Found, Options};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;

/// A case that takes little time and meets damage.
fn quick() -> Case {
    let case = Case::example("as4-3502-8ply-25mm").scene("end = \"1 ms\"", "end = \"0.3 ms\"");
    case.append("\n[reduction]\nmethod = \"ritz\"\nvectors = 20\n\n[output]\nplots = false\n")
}

/// The rows of sweep.csv by column.
fn rows(case: &Case, folder: &str) -> Vec<BTreeMap<String, String>> {
    let (header, rows) = case.table(&format!("{folder}/sweep.csv"));
    rows.into_iter().map(|row| header.iter().cloned().zip(row).collect()).collect()
}

fn bits(row: &BTreeMap<String, String>, column: &str) -> Option<u64> {
    row[column].parse::<f64>().ok().map(f64::to_bits)
}

/// Impactor, contact and strengths share a plate; a layup has its own. Each row is to the bit what a run of its own finds.
#[test]
fn rows_are_runs_to_the_bit() {
    let case = quick();
    let axes = [
        ("laminate.plies", "[0/45/-45/90]s,[45/-45/0/90]s"),
        ("impactor.velocity", "1.5..3:2"),
        ("materials.as4-3502.Yt", "40 MPa,60 MPa"),
        ("contact.beta", "0.4,0.5"),
    ];
    let set: Vec<String> = axes.iter().flat_map(|(key, words)| ["--set".into(), format!("{key}={words}")]).collect();
    let set: Vec<&str> = set.iter().map(String::as_str).collect();
    case.fem("sweep", &[&set[..], &["--out", "one"]].concat()).good();
    case.fem("sweep", &[&set[..], &["--out", "two", "--threads", "2"]].concat()).good();
    assert_eq!(case.read("one/sweep.csv"), case.read("two/sweep.csv"));
    let rows = rows(&case, "one");
    assert_eq!(rows.len(), 16);

    let path = case.folder().join("plate/scene.toml");
    // Both layups, a case of each in the middle of those that share its plate.
    for row in [&rows[2], &rows[13]] {
        let value = |key: &str, unit: &str| match unit {
            "" => format!("\"{}\"", row[key]),
            unit => format!("\"{} {unit}\"", row[&format!("{key} [{unit}]")]),
        };
        let setting: Setting = [
            ("laminate.plies".to_owned(), value("laminate.plies", "")),
            ("impactor.velocity".to_owned(), value("impactor.velocity", "m/s")),
            ("materials.as4-3502.Yt".to_owned(), value("materials.as4-3502.Yt", "MPa")),
            ("contact.beta".to_owned(), row["contact.beta"].clone()),
        ]
        .into();
        let scene = read_under(&path, &setting);
        let done = job::run(&scene, &Registry::standard(), &Options::default(), &mut ()).unwrap();
        let Found::Impact(found) = done.found else { panic!("an impact") };
        let impact = &found.summary.impact[0];
        let same = [
            ("peak_force_N", impact.peak_force_N),
            ("peak_force_time_s", impact.peak_force_time_s),
            ("impulse_N_s", impact.impulse_N_s),
            ("deflection_m", impact.peak_plate_displacement_m),
            ("contact_time_s", impact.contact_time_s),
            ("damage_time_s", found.outcome.events[0].time),
            ("damage_force_N", found.outcome.forces.at(found.outcome.events[0].time)),
            ("energy_error", found.outcome.energy_error),
        ];
        for (column, value) in same {
            assert_eq!(bits(row, column), Some(value.to_bits()), "{column}: {} {value:e}", row[column]);
        }
        for peak in &found.outcome.peaks {
            let column = format!("{} {} index", peak.criterion, peak.mode);
            assert_eq!(bits(row, &column), Some(peak.index.to_bits()), "{column}");
        }
    }
    // The strength acts: the weaker plate is damaged at the smaller force.
    assert!(rows[0]["damage_force_N"].parse::<f64>().unwrap() < rows[2]["damage_force_N"].parse::<f64>().unwrap());
}

/// Strengths in situ follow from those that a case has.
#[test]
fn strengths_in_situ_follow_those_of_a_case() {
    let tough = "library = \"AS4/3502\", GIc = \"0.1 N/mm\", GIIc = \"0.6 N/mm\", shear_alpha = \"0 1/MPa^3\" }";
    let case =
        quick().scene("[laminate]", "[laminate]\nstrengths = \"in-situ\"").scene("library = \"AS4/3502\" }", tough);
    let values = ["300 MPa", "900 MPa"];
    case.fem("sweep", &["--set", &format!("materials.as4-3502.Xc={}", values.join(",")), "--out", "both"]).good();
    let column = "hashin-report fibre compression index";
    for (value, row) in values.iter().zip(rows(&case, "both")) {
        case.fem("sweep", &["--set", &format!("materials.as4-3502.Xc={value}"), "--out", "alone"]).good();
        assert_eq!(row[column], rows(&case, "alone")[0][column], "{value}");
    }
    let [weak, strong] = [0, 1].map(|k| rows(&case, "both")[k][column].parse::<f64>().unwrap());
    assert!(weak > 2.0 * strong, "{weak} and {strong}");
}

/// Parts that are gathered, a sweep that goes on and one in one piece make the same table; `show` runs a case of it.
#[test]
fn parts_and_what_goes_on_make_the_same_table() {
    let case = quick();
    let samples = ["--set", "impactor.velocity=uniform(1, 3)", "--set", "materials.as4-3502.Yt=normal(50 MPa, 10 %)"];
    let options = |more: &[&'static str]| [&samples[..], &["--samples", "6", "--seed", "5"], more].concat();
    case.fem("sweep", &options(&["--out", "whole"])).good();
    case.fem("sweep", &options(&["--out", "parts", "--part", "1/2"])).good();
    let early = case.fem("sweep", &options(&["--out", "parts", "--gather"]));
    assert!(early.status == 1 && early.stderr.contains("3 of 6 cases are missing"), "{early:#?}");
    case.fem("sweep", &options(&["--out", "parts", "--part", "2/2"])).good();
    case.fem("sweep", &options(&["--out", "parts", "--gather"])).good();
    assert_eq!(case.read("whole/sweep.csv"), case.read("parts/sweep.csv"));
    let done = case.fem("sweep", &options(&["--out", "whole", "--resume"])).good();
    assert!(done.stdout.contains("6 cases are there from before"), "{done:#?}");
    assert_eq!(case.read("whole/sweep.csv"), case.read("parts/sweep.csv"));

    let record: Value = serde_json::from_str(&case.read("whole/sweep.json")).unwrap();
    assert_eq!((record["cases"].as_u64(), record["failed"].as_u64()), (Some(6), Some(0)));
    let any = &record["scatter"]["damage"][0];
    let [low, share, high] = ["low", "probability", "high"].map(|key| any[key].as_f64().unwrap());
    assert!(low <= share && share <= high, "{any}");

    fem(case.folder(), &["sweep", "show", "whole", "4", "--out", "shown"]).good();
    let row = &rows(&case, "whole")[3];
    let shown = case.summary("shown");
    assert_eq!(bits(row, "peak_force_N"), shown["impact"]["peak_force_N"].as_f64().map(f64::to_bits));
    let refused = fem(case.folder(), &["sweep", "show", "whole", "7"]);
    assert!(refused.stderr.contains("no case 7") && refused.status == 1, "{refused:#?}");
}

/// The table of the scene says the same as the command line, and a case that fails has a row that says why.
#[test]
fn a_scene_may_have_its_sweep() {
    let sweep = "\n[sweep]\nset = { contact.n = [1.5], impactor.patch_radius = \"1 mm, 1 m\" }\n";
    let case = quick().append(sweep);
    let done = case.fem("sweep", &["--out", "out"]);
    assert_eq!(done.status, 1, "{done:#?}");
    let rows = rows(&case, "out");
    assert!(rows[0]["failed"].is_empty() && rows[0]["peak_force_N"].parse::<f64>().is_ok(), "{rows:?}");
    assert!(rows[1]["failed"].contains("patch") && rows[1]["peak_force_N"].is_empty(), "{rows:?}");
    assert!(done.stdout.contains("failed    case 2"), "{done:#?}");
}

#[test]
fn what_makes_no_sense_is_refused_before_anything_runs() {
    let case = quick();
    let big =
        ["--set", "impactor.velocity=1..5:1000", "--set", "impactor.mass=1..5:1000", "--set", "contact.n=1..2:1000"];
    for (options, words) in [
        (&["--set", "impactor.speed=1..5:3"][..], &["unknown key `impactor.speed`"][..]),
        (&["--set", "impactor.velocity=1..5 kg:3"], &["`impactor.velocity`", "is a mass, not a velocity"]),
        (&["--set", "impactor.velocity=5..1:3"], &["`impactor.velocity`: its range from 5 to 1 is empty"]),
        (&["--set", "impactor.velocity=1..5"], &["numbers without end", "1..5:9", "--design"]),
        (
            &["--set", "impactor.velocity=normal(2, -1)"],
            &["`impactor.velocity`", "deviation is -1 and must be above 0"],
        ),
        (&["--set", "impactor.velocity=1,-1"], &["`impactor.velocity`", "must be positive"]),
        (&big, &["1000000000 cases", "at most 1000000"]),
        (&["--set", "title=a", "--set", "title=b"], &["`title`: is varied twice"]),
        (&["--set", "effects.damage=onset,off"], &["`effects.damage` says what is looked for"]),
        (&[], &["nothing is varied", "--set impactor.velocity=1..5:9"]),
    ] {
        let given = if options.first().is_some_and(|_| options.len() == 2 && options[1].ends_with("1..5")) {
            [options, &["--design", "grid"]].concat()
        } else {
            options.to_vec()
        };
        let done = case.fem("sweep", &[&given[..], &["--out", "out"]].concat());
        let said = done.stderr.split_whitespace().collect::<Vec<_>>().join(" ").replace(" │ ", " ");
        assert!(done.status == 1 && words.iter().all(|word| said.contains(word)), "{options:?} {done:#?}");
        assert!(!case.folder().join("out").exists(), "{options:?}");
    }
}

/// The scene in the results has what was set, so that it can be run again.
#[test]
fn what_is_set_is_the_scene() {
    let case = quick();
    let set = ["--set", "impactor.energy=2 J", "--set", "march.end=0.05", "--out"];
    case.fem("run", &[&set[..], &["a"]].concat()).good();
    let impact = &case.summary("a")["impact"];
    let [mass, velocity] = ["mass_kg", "velocity_m_s"].map(|key| impact[key].as_f64().unwrap());
    assert!((0.5 * mass * velocity * velocity / 2.0 - 1.0).abs() < 1e-12);
    assert!((impact["end_time_s"].as_f64().unwrap() / 5e-5 - 1.0).abs() < 1e-12);
    let written = case.read("a/scene.toml");
    assert!(written.contains("energy = \"2 J\"") && !written.contains("velocity ="), "{written}");
    fs::copy(case.folder().join("a/scene.toml"), case.folder().join("plate/again.toml")).unwrap();
    fem(case.folder(), &["run", "plate/again.toml", "--out", "b"]).good();
    assert_eq!(case.summary("a")["impact"], case.summary("b")["impact"]);
}

/// Formulas are columns of their own, of what each case sets and finds; what no case beats is marked; both are drawn.
#[test]
fn formulas_are_columns_and_what_nothing_beats_is_marked() {
    let case = quick().scene("plots = false", "plots = true");
    let set = [
        "--set",
        "laminate.plies=[0/45/-45/90]s,[0/90]2s",
        "--set",
        "impactor.velocity=1,2",
        "--set",
        "impactor.mass=1 kg,2000 g",
    ];
    let formulas = [
        "--quantity=lost = absorbed_energy / energy",
        "--quantity=energy - 0.5*impactor_mass*impactor_velocity^2",
        "--quantity=share = damage_force / (2*kN)",
    ];
    let pareto = ["--pareto", "least deflection, most peak_force/energy", "--out", "out"];
    let nowhere = ["--quantity=none = energy / (energy - energy)"];
    let done = case.fem("sweep", &[&set[..], &formulas, &nowhere, &pareto].concat()).good();
    assert!(done.stdout.contains("none: in no case a number"), "{done:#?}");
    let rows = rows(&case, "out");
    assert_eq!(rows.len(), 8);
    let number = |row: &BTreeMap<String, String>, column: &str| row[column].parse::<f64>().ok();
    let points: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| {
            [
                number(row, "deflection_m").unwrap(),
                -number(row, "peak_force_N").unwrap() / number(row, "energy_J").unwrap(),
            ]
        })
        .collect();
    for (row, point) in rows.iter().zip(&points) {
        let of = |column: &str| number(row, column).unwrap();
        assert_eq!(of("lost"), of("absorbed_energy_J") / of("energy_J"));
        assert!(of("energy - 0.5*impactor_mass*impactor_velocity^2 [J]").abs() < 1e-12, "{row:?}");
        // A case without damage has no force of it.
        assert_eq!(number(row, "share"), number(row, "damage_force_N").map(|force| force / 2e3));
        let beaten = points.iter().any(|other| other != point && other[0] <= point[0] && other[1] <= point[1]);
        assert_eq!(of("on_pareto_front"), f64::from(u8::from(!beaten)), "{row:?}");
    }
    let front = case.read("out/pareto_front.svg");
    assert!(["front", "[0/90]2s", "deflection, least (mm)"].iter().all(|words| front.contains(words)), "{front}");

    let samples = ["--design", "saltelli", "--samples", "8", "--set", "impactor.velocity=1..3"];
    case.fem("sweep", &[&samples[..], &formulas[..1], &["--out", "out"]].concat()).good();
    let bars = case.read("out/importance_lost.svg");
    assert!(["alone", "in all", "95 % interval", "impactor.velocity"].iter().all(|words| bars.contains(words)));

    for (option, words) in [
        ("--quantity=peak_force + energy", "`+` at character 12 has different units"),
        ("--quantity=sin(energy)", "`sin` at character 1 takes a pure number"),
        ("--quantity=a = peak_forc", "did you mean `peak_force`"),
        ("--quantity=energy^deflection", "`^` at character 7"),
        ("--quantity=energy = peak_force", "`energy` is known already"),
        ("--quantity=share = energy/energy", "two quantities are called `share`"),
        ("--pareto=least deflection", "does not say two quantities"),
        ("--pareto=least deflection, largest energy", "does not say two quantities"),
    ] {
        let always = "--quantity=share = damage_force / (2*kN)";
        let done = case.fem("sweep", &["--set", "impactor.velocity=1,2", always, option, "--out", "refused"]);
        let said = done.stderr.split_whitespace().collect::<Vec<_>>().join(" ").replace(" │ ", " ");
        assert!(done.status == 1 && said.contains(words), "{option} {done:#?}");
        assert!(!case.folder().join("refused").exists(), "{option}");
    }
}

/// Rows of delaminations that grow say how far they have, as the summary of a run does.
#[test]
fn delaminations_have_columns() {
    let case = coming_apart(600).append("[output]\nplots = false\n");
    let asked =
        ["--set", "impactor.velocity=0.3 m/s,3 m/s", "--quantity", "per_area = dissipated_energy/delaminated_areas"];
    case.fem("sweep", &[&asked[..], &["--out", "sweep"]].concat()).good();
    case.fem("run", &["--out", "run"]).good();
    let rows = rows(&case, "sweep");
    let number = |row: usize, column: &str| rows[row][column].parse::<f64>().unwrap();
    assert_eq!((number(0, "delaminated_area_m2"), number(0, "dissipated_energy_J")), (0.0, 0.0));
    let grown = &case.summary("run")["delamination"];
    for (column, key, unit) in [
        ("delaminated_area_m2", "projected_area_mm2", 1e-6),
        ("delaminated_areas_m2", "area_mm2", 1e-6),
        ("dissipated_energy_J", "dissipated_J", 1.0),
    ] {
        let (found, want) = (number(1, column), unit * grown[key].as_f64().unwrap());
        assert!(want > 0.0 && (found / want - 1.0).abs() < 1e-9, "{column}: {found}, not {want}");
    }
    let column = rows[1].keys().find(|name| name.starts_with("per_area")).unwrap();
    assert!((200.0..2e3).contains(&number(1, column)), "{column}: {:?}", rows[1]);
}

/// Where the advisor opens the interfaces of some cases alone, the columns are there for all.
#[test]
fn delaminations_of_some_cases_are_columns_of_all() {
    let case = coming_apart(600).scene("delamination = 'growth'", "delamination = 'auto'");
    let asked = ["--set", "impactor.velocity=0.02 m/s,3 m/s", "--quantity", "area = delaminated_area"];
    case.fem("sweep", &[&asked[..], &["--out", "sweep"]].concat()).good();
    let rows = rows(&case, "sweep");
    assert_eq!((&rows[0]["dissipated_energy_J"][..], &rows[0]["delaminated_area_m2"][..]), ("", ""));
    assert!(rows[1]["dissipated_energy_J"].parse::<f64>().unwrap() >= 0.0, "{rows:?}");
    assert!(rows.iter().all(|row| row["energy_error"].parse::<f64>().unwrap() < 0.01), "{rows:?}");
}
