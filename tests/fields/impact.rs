//! Fields of a march.

use super::{close, folder, series, struck};
use crate::support::{Case, OFTEN, watched};
use std::collections::HashMap;
use std::fs;

fn times(case: &Case, name: &str) -> Vec<f64> {
    series(case, "out", name).iter().map(|frame| frame.0).collect()
}

/// Whether times are those wanted, us.
#[track_caller]
fn at(times: &[f64], want: &[f64]) {
    let same = times.len() == want.len() && times.iter().zip(want).all(|(t, us)| (t * 1e6 - us).abs() < 1e-6);
    assert!(same, "{times:?}, not {want:?} us");
}

/// Largest difference over the frames between the displacement of the node that is struck and the history.
fn beside_history(case: &Case) -> f64 {
    let (_, history) = case.table("out/history.csv");
    let history: Vec<[f64; 2]> = history.iter().map(|row| [0, 4].map(|k| row[k].parse().unwrap())).collect();
    let mut worst = 0.0_f64;
    for (time, grid) in series(case, "out", "plate") {
        let row = history.iter().find(|row| (row[0] - time).abs() < 1e-12).unwrap();
        let top = grid.positions().iter().fold(f64::MIN, |m, p| m.max(p[2]));
        let struck = |p: &[f64; 3]| (p[0] - 15e-3).abs() + (p[1] - 5e-3).abs() + (p[2] - top).abs() < 1e-9;
        let point = grid.positions().iter().position(struck).unwrap();
        let w = -grid.points("displacement")[point][2];
        worst = worst.max((w - row[1]).abs() / row[1].abs().max(1e-12));
    }
    worst
}

#[test]
fn frames_follow_the_history_however_the_plate_is_computed() {
    let variants: [(&str, &str); 5] = [
        ("[march]", "[march]"),
        ("[march]", "[reduction]\nmethod = \"none\"\n[march]"),
        ("[march]", "[effects]\nmembrane = \"on\"\n[march]"),
        ("[march]", "[effects]\nmembrane = \"on\"\n[reduction]\nmethod = \"none\"\n[march]"),
        ("[march]", "[effects]\ngravity = \"9.81 m/s^2\"\n[march]"),
    ];
    for (from, to) in variants {
        let case = struck("true").scene(from, to);
        case.fem("run", &["--out", "out"]).good();
        for name in ["plate", "plies", "interfaces"] {
            at(&times(&case, name), &[0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0]);
        }
        let phases = case.read("out/cost.json");
        assert!(phases.contains("\"fields\""), "{phases}");
        if !to.contains("gravity") {
            assert!(beside_history(&case) < 2e-7, "{to}: {}", beside_history(&case));
        }
        // Velocity is the rate of the displacement: by the trapezoidal rule from frame to frame.
        let frames = series(&case, "out", "plate");
        let (a, b) = (&frames[9].1, &frames[10].1);
        let moved = |k: usize, grid: &super::Vtu| grid.points("displacement")[k][2];
        let rate = |k: usize| 0.5 * (a.points("velocity")[k][2] + b.points("velocity")[k][2]) * 2e-6;
        let largest = (0..a.points).map(|k| (moved(k, b) - moved(k, a)).abs()).fold(0.0, f64::max);
        let far = (0..a.points).map(|k| (moved(k, b) - moved(k, a) - rate(k)).abs()).fold(0.0, f64::max);
        assert!(far < 0.05 * largest, "{to}: {far:e} of {largest:e}");
    }
}

#[test]
fn substructures_come_back_with_their_insides() {
    let divided = struck("true")
        .scene(
            "mesh = { file = \"plate.msh\", unit = \"mm\" }",
            "mesh = { rectangle = [\"30 mm\", \"10 mm\"], cells = [4, 2] }",
        )
        .scene("group = \"clamped\"", "group = \"x-min\"")
        .scene("[march]", "[substructures]\ncells = [2, 2]\n[march]");
    divided.fem("run", &["--out", "out"]).good();
    assert!(beside_history(&divided) < 2e-7);
    let (_, last) = series(&divided, "out", "plate").pop().unwrap();
    let still = last.positions().iter().zip(last.points("displacement")).filter(|(_, u)| u[2] == 0.0);
    assert!(still.clone().all(|(p, _)| p[0] == 0.0), "{:?}", still.collect::<Vec<_>>());
}

#[test]
fn the_scene_says_when_where_and_what() {
    let case =
        struck(r#"{ every = "7 us", times = ["2.04 us", "20 us"], parts = ["plies"], region = { radius = "6 mm" } }"#);
    case.fem("run", &["--out", "out"]).good();
    at(&times(&case, "plies"), &[0.0, 2.0, 7.0, 14.0, 20.0]);
    let beside = [".fem", "all.pvd", "names.json", "view.py"];
    let foreign = |name: &&String| !name.starts_with("plies") && !beside.contains(&name.as_str());
    assert_eq!(case.names("out/fields").iter().find(foreign), None);
    let (_, grid) = series(&case, "out", "plies").remove(0);
    // Of 4 x 2 cells of 7.5 mm by 5 mm the four around the middle.
    assert_eq!(grid.cells, 4 * 16);
    assert!(grid.positions().iter().all(|p| (7e-3..23e-3).contains(&p[0])));

    let case = struck(r#"{ times = ["0 us"], parts = ["plate", "plate"], region = { group = "plate" } }"#);
    case.fem("run", &["--out", "out"]).good();
    at(&times(&case, "plate"), &[0.0]);
    let (_, grid) = series(&case, "out", "plate").remove(0);
    assert!(grid.points("displacement").iter().flatten().all(|u| *u == 0.0));
    assert_eq!(grid.cells, 16);

    for fields in ["false", "{ times = [\"3 us\"] }\nplots = false"] {
        let case = struck(fields);
        case.fem("run", &["--out", "out"]).good();
        assert_eq!(case.folder().join("out/fields").exists(), fields != "false");
    }
}

/// Half a plate is computed, and the fields are those of the whole.
#[test]
fn a_folded_plate_is_written_whole() {
    let title = "title = \"AS4/3502, 16 plies, 50 mm circular support, 2.49 kg at 1.56 m/s\"";
    let whole = crate::support::plate().scene("end = \"1 ms\"", "step = \"0.5 us\"\nend = \"20 us\"");
    let whole = whole.append("[output]\nfields = { times = [\"20 us\"], parts = [\"plies\"] }\n");
    let case = whole.scene(title, &format!("{title}\nsymmetry = \"half-turn\""));
    case.fem("run", &["--out", "out"]).good();
    let (_, grid) = series(&case, "out", "plies").remove(0);
    assert_eq!((grid.cells, grid.points), (288 * 16, grid.positions().len()));
    let key = |p: [f64; 3]| p.map(|x| (x * 1e9).round() as i64);
    let at: HashMap<_, _> = grid.positions().iter().enumerate().map(|(k, p)| (key(*p), k)).collect();
    let u = grid.points("displacement");
    let largest = u.iter().flatten().fold(0.0_f64, |m, u| m.max(u.abs()));
    for ([x, y, z], u1) in grid.positions().iter().zip(u) {
        let u2 = u[at[&key([-x, -y, *z])]];
        let turned = [-u2[0], -u2[1], u2[2]];
        assert!(u1.iter().zip(turned).all(|(a, b)| close(*a, b, largest)), "{x} {y} {z}: {u1:?} {turned:?}");
    }
    // The criteria look at the half that is computed, at the end of the march as at the frame.
    let largest = grid.cells("hashin-report index").iter().fold(0.0_f64, |m, i| m.max(*i));
    let peak = |d: &serde_json::Value| d["criterion"].as_str() == Some("hashin-report");
    let summary = case.summary("out");
    let peaks = summary["not_reached"].as_array().unwrap().iter().filter(|d| peak(d));
    let peak = peaks.map(|d| d["largest_index"].as_f64().unwrap()).fold(0.0, f64::max);
    assert!(largest > 0.0 && (largest / peak - 1.0).abs() < 1e-6, "{largest} {peak}");
}

/// A frame at every sample: the largest index of the frames is that of the map.
#[test]
fn indices_of_all_samples_are_those_of_the_map() {
    let case = struck("{ every = \"5 us\" }\nmaps = true");
    case.fem("run", &["--out", "out"]).good();
    // Of all windows of a cell, four digits.
    let map: serde_json::Value = serde_json::from_str(&case.read("out/damage.json")).unwrap();
    let list = |key: &str| map[key].as_array().unwrap();
    for (name, criterion) in [("plies", "hashin-report"), ("interfaces", "octahedral")] {
        let frames = series(&case, "out", name);
        for cell in 0..frames[0].1.cells {
            let grid = &frames[0].1;
            let sheet = match name {
                "plies" => grid.cells("ply")[cell].to_string(),
                _ => format!("{}|{}", grid.cells("ply_below")[cell], grid.cells("ply_below")[cell] + 1.0),
            };
            let index = |grid: &super::Vtu| grid.cells(&format!("{criterion} index"))[cell];
            let largest = frames.iter().map(|frame| index(&frame.1)).fold(0.0, f64::max);
            let tag = grid.cells("cell")[cell] as u64;
            let judged = list("judged").iter().position(|quad| map["cells"][quad.as_u64().unwrap() as usize] == tag);
            let place = list("places").iter().find(|place| place["ply"] == sheet.as_str()).unwrap();
            let want = place["index"][judged.unwrap()].as_f64().unwrap();
            assert!((largest - want).abs() <= 6e-4 * want, "{name} {cell}: {largest}, not {want}");
        }
    }
}

/// A frame at every sample again: what is known so far follows from the frames up to there.
#[test]
fn what_failed_so_far_follows_from_the_frames_before() {
    let case = struck("{ every = \"1 us\" }")
        .scene("library = \"AS4/3502\"", "library = \"AS4/3502\", Yt = \"0.5 MPa\"")
        .scene("[failure]", "[failure]\nevery = \"1 us\"");
    case.fem("run", &["--out", "out"]).good();
    let names: serde_json::Value = serde_json::from_str(&case.read("out/fields/names.json")).unwrap();
    let mut onsets = 0;
    for criterion in names["criteria"].as_array().unwrap() {
        let name = criterion["name"].as_str().unwrap();
        let modes: Vec<&str> =
            criterion["modes"].as_array().unwrap().iter().map(|mode| mode.as_str().unwrap()).collect();
        let frames = series(&case, "out", criterion["series"].as_str().unwrap());
        let mut largest = vec![0.0_f64; frames[0].1.cells];
        let mut before = vec![(0.0, 0.0); largest.len()];
        for (time, grid) in &frames {
            let (index, so_far) = (grid.cells(&format!("{name} index")), grid.cells(&format!("{name} index so far")));
            let mode = grid.cells(&format!("{name} mode"));
            let onset: Vec<&[f64]> = modes.iter().map(|mode| grid.cells(&format!("{name} {mode} onset"))).collect();
            for cell in 0..largest.len() {
                largest[cell] = largest[cell].max(index[cell]);
                assert!(close(so_far[cell], largest[cell], largest[cell]), "{name} {time} {cell}");
                let first = onset.iter().map(|onset| onset[cell]).fold(f64::NAN, f64::min);
                assert_eq!(first.is_finite(), largest[cell] >= 1.0, "{name} {time} {cell}");
                // Where one mode leads, its line between the two samples crosses 1.
                let (t, i) = before[cell];
                if largest[cell] == index[cell] && i < 1.0 && index[cell] >= 1.0 && first > t {
                    let of_mode = onset[mode[cell] as usize - 1][cell];
                    assert!(t < of_mode && of_mode <= *time * (1.0 + 1e-6), "{name} {cell}: {of_mode}");
                    onsets += 1;
                }
                before[cell] = (*time, largest[cell]);
            }
        }
    }
    assert!(onsets > 10, "{onsets} onsets");
    let all = super::collection(&folder(&case, "out").join("all.pvd"));
    assert!(all.len() == 3 * 21 && all.iter().all(|(_, file)| file.exists()), "{}", all.len());
}

#[test]
fn a_later_end_goes_on_with_the_frames() {
    let until = |end: &str| struck("{ every = \"3 us\" }").scene("end = \"20 us\"", &format!("end = \"{end}\""));
    let (long, short) = (until("41.5 us"), until("20.5 us"));
    long.fem("run", &["--out", "straight"]).good();
    short.fem("run", &["--out", "out"]).good();
    fs::rename(short.folder().join("out"), long.folder().join("out")).unwrap();
    let first = folder(&long, "out").join("plate-0001.vtu");
    let written = fs::metadata(&first).unwrap().modified().unwrap();
    long.fem("run", &["--out", "out", "--resume"]).good();
    assert_eq!(fs::metadata(&first).unwrap().modified().unwrap(), written, "frames of before stay");
    assert_eq!(long.names("out/fields").len(), 4 + 3 * (14 + 1));
    assert_eq!(long.differing("straight/fields", "out/fields"), [""; 0]);
    assert_eq!(long.differing("straight", "out"), [""; 0]);
}

#[test]
fn a_killed_run_leaves_valid_series_and_ends_as_if_nothing_had_been() {
    let fields = "output]\nfields = { every = \"5 us\" }\n";
    let case = watched().scene("end = \"20 us\"", "end = \"300 us\"").scene("output]\n", &format!("{fields}{OFTEN}"));
    let (mut arguments, mut before, mut kills) = (vec!["--out", "out"], None, 0);
    for wait in 0..4 {
        let mut run = case.spawn(&arguments);
        if !case.new_checkpoint(&mut run, &before) {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(20 * wait));
        run.kill().unwrap();
        run.wait().unwrap();
        before = Some(fs::read(case.folder().join("out/checkpoint.bin")).unwrap());
        arguments = vec!["--out", "out", "--resume"];
        kills += 1;
        for name in ["plate", "plies"] {
            assert!(!series(&case, "out", name).is_empty(), "files of the list are there and whole");
        }
    }
    assert!(kills >= 2, "{kills} kills");
    let case = case.scene(OFTEN, "");
    case.fem("run", &["--out", "out", "--resume"]).good();
    case.fem("run", &["--out", "straight"]).good();
    assert_eq!(case.names("out/fields").len(), 4 + 3 * (61 + 1));
    assert_eq!(case.differing("straight/fields", "out/fields"), [""; 0]);
}

#[test]
fn the_size_is_known_before() {
    for (case, frames) in
        [(struck("true"), "11 frames of 3 series"), (struck("{ times = [\"9 us\"] }"), "1 frame of 3 series")]
    {
        let checked = case.fem("check", &[]).good().stdout;
        let line = checked.lines().find(|line| line.trim_start().starts_with("fields")).unwrap();
        assert!(line.contains(frames), "{line}");
        let words: Vec<&str> = line.split_whitespace().collect();
        let expected: f64 = words[words.iter().position(|word| *word == "about").unwrap() + 1].parse().unwrap();
        case.fem("run", &["--out", "out"]).good();
        let size = |name: &String| fs::metadata(folder(&case, "out").join(name)).unwrap().len() as f64 * 1e-6;
        let written: f64 = case.names("out/fields").iter().map(size).sum();
        assert!((1.0 / 1.5..1.5).contains(&(expected / written)), "{line}: {written} MB");
    }
    assert!(!crate::support::strip().fem("check", &[]).good().stdout.contains("  fields"));
}

/// A stress that a criterion does not take stops the march at the frame, as it does at a sample.
#[test]
fn a_frame_that_makes_no_sense_stops_the_march() {
    let no_index = "criteria = [{ name = \"expression\", expression = \"0.5 * sqrt(1 - abs(s1) / (100*kPa))\" }]\nevery = \"10 us\"";
    let case = struck("{ every = \"1 us\" }").scene("criteria = [\"hashin-report\", \"octahedral\"]", no_index);
    let done = case.fem("run", &["--out", "out"]);
    assert!(done.status == 1 && done.stdout.contains("STOPPED") && done.stdout.contains("has no index"), "{done:#?}");
    let frames = series(&case, "out", "plies").len();
    assert!((1..11).contains(&frames), "{frames}");
}
