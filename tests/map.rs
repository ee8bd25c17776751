//! `fem map`: the lines are where runs say they are.

use crate::support::{Case, read_under};
use fem::Registry;
use fem::io::scene::Setting;
use fem::job::{self, Found, Options};
use serde_json::Value;

/// A case that takes little time and meets damage.
fn quick() -> Case {
    let case = Case::example("as4-3502-8ply-25mm").scene("end = \"1 ms\"", "end = \"0.3 ms\"");
    case.append("\n[reduction]\nmethod = \"ritz\"\nvectors = 20\n")
}

/// Whether a run with these values is damaged.
fn damaged(case: &Case, mass: f64, velocity: f64) -> bool {
    let set = [("impactor.mass", format!("\"{mass} kg\"")), ("impactor.velocity", format!("\"{velocity} m/s\""))];
    let setting: Setting = set.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    let scene = read_under(&case.folder().join("plate/scene.toml"), &setting);
    let done = job::run(&scene, &Registry::standard(), &Options::default(), &mut ()).unwrap();
    let Found::Impact(found) = done.found else { panic!("an impact") };
    !found.outcome.events.is_empty()
}

/// Two percent to either side of the line of the first damage, runs are damaged or not.
#[test]
fn the_first_damage_is_where_the_map_has_it() {
    let case = quick();
    let set = ["--set", "impactor.mass=0.2..4", "--set", "impactor.velocity=0.3..3", "--tolerance", "2%"];
    case.fem("map", &[&set[..], &["--out", "one"]].concat()).good();
    case.fem("map", &[&set[..], &["--out", "two", "--threads", "2"]].concat()).good();
    for file in ["map.json", "border.csv", "impacts.csv"] {
        assert_eq!(case.read(&format!("one/{file}")), case.read(&format!("two/{file}")), "{file}");
    }
    // What was broken off goes on to the same map.
    let early = case.fem("map", &[&set[..], &["--out", "three", "--impacts", "18"]].concat());
    assert!(early.status == 1 && early.stdout.contains("18 computed"), "{early:#?}");
    case.fem("map", &[&set[..], &["--out", "three", "--resume"]].concat()).good();
    for file in ["map.json", "border.csv", "impacts.csv"] {
        assert_eq!(case.read(&format!("one/{file}")), case.read(&format!("three/{file}")), "{file}");
    }
    // A map that asks for fewer impacts loses none that are there.
    let kept = || case.folder().join("three/map.bin").metadata().unwrap().len();
    let all = kept();
    let fewer = case.fem("map", &[&set[..], &["--out", "three", "--impacts", "16", "--resume"]].concat());
    assert!(fewer.stdout.contains("16 computed"), "{fewer:#?}");
    assert_eq!(kept(), all);
    let other = case.fem(
        "map",
        &["--set", "impactor.mass=0.2..5", "--set", "impactor.velocity=0.3..3", "--out", "three", "--resume"],
    );
    assert!(other.status == 1 && other.stderr.contains("`map over impactor.mass` was 0.2..4 kg and is"), "{other:#?}");
    let record: Value = serde_json::from_str(&case.read("one/map.json")).unwrap();
    assert_eq!((record["reached"].as_bool(), record["failed"].as_u64()), (Some(true), Some(0)));
    assert!(record["impacts"].as_u64().is_some_and(|count| count <= 100), "{}", record["impacts"]);
    let first = &record["lines"][0];
    assert_eq!(first["name"], "first damage");
    assert!(first["error"].as_f64().is_some_and(|error| error <= 0.02), "{first}");
    let points = first["points"].as_array().unwrap();
    for at in [points.len() / 5, points.len() / 2] {
        let [mass, velocity] = [0, 1].map(|k| points[at][k].as_f64().unwrap());
        assert!(!damaged(&case, mass, 0.98 * velocity) && damaged(&case, mass, 1.02 * velocity), "{mass} {velocity}");
    }
    let page = case.read("one/report.html");
    assert!(page.contains("equal energy") && page.contains("\"histories\":[[[0.0,"), "picture and histories");
}

/// Over one number for each value of a list.
#[test]
fn layups_have_lines_of_their_own() {
    let case = quick();
    let set = ["--set", "laminate.plies=[0/45/-45/90]s,[0/90]2s", "--set", "impactor.energy=0.2..6 J"];
    let done = case.fem("map", &[&set[..], &["--tolerance", "2%", "--out", "out"]].concat()).good();
    assert!(done.stdout.contains("[0/90]2s: first damage at"), "{done:#?}");
    let (header, rows) = case.table("out/border.csv");
    assert_eq!(header, ["line", "laminate.plies", "impactor.energy [J]", "error"]);
    let first: Vec<f64> =
        rows.iter().filter(|row| row[0] == "first damage").map(|row| row[2].parse().unwrap()).collect();
    assert!(first.len() == 2 && first[0] != first[1], "{rows:?}");
}

#[test]
fn what_is_no_map_is_refused() {
    let case = quick();
    for (options, words) in [
        (&["--set", "impactor.mass=1..5:9"][..], &["a map finds its own values", "1..5"][..]),
        (&["--set", "impactor.mass=1..5"], &["a map wants two ranges", "one key has a range"]),
        (&["--set", "impactor.mass=1..5 m", "--set", "impactor.velocity=1..5"], &["is a length, not a mass"]),
        (&["--set", "impactor.speed=1..5", "--set", "impactor.mass=1..5"], &["unknown key `impactor.speed`"]),
        (&["--set", "impactor.mass=normal(1, 0.1)", "--set", "impactor.velocity=1..5"], &["finds its own values"]),
        (&["--tolerance", "200%"], &["between 0 and 1"]),
    ] {
        let done = case.fem("map", &[options, &["--out", "out"]].concat());
        let said = done.stderr.split_whitespace().collect::<Vec<_>>().join(" ").replace(" │ ", " ");
        assert!(done.status != 0 && words.iter().all(|word| said.contains(word)), "{options:?} {done:#?}");
        assert!(!case.folder().join("out").exists(), "{options:?}");
    }
    let case = case.append("\n[effects]\ndelamination = \"off\"\n");
    let nothing = case.fem("map", &["--set", "effects.damage=off", "--out", "out"]);
    assert!(nothing.status == 1 && nothing.stderr.contains("a map needs a criterion"), "{nothing:#?}");
}
