//! What lies in a project: names, what is stale, exports, the folder's check.

use super::{folder, program, run};
use crate::support::{fem, root};
use std::path::Path;

/// The beam of the first example: its cell, and its impact.
fn beam(results: &Path) {
    let folder = folder("a-beam-plane-strain");
    for (deck, of) in [("1-lamcel.dat", "lamcel"), ("2-tradyr.dat", "tradyr")] {
        run(&folder.join(deck), program(of), results).unwrap();
    }
}

/// A deck of the first example with another text in it, in a folder of its own.
fn edited(results: &Path, deck: &str, from: &str, to: &str) -> std::path::PathBuf {
    let text = std::fs::read_to_string(folder("a-beam-plane-strain").join(deck)).unwrap();
    assert!(text.contains(from), "{deck} has no {from}");
    let path = results.join(deck);
    std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
    path
}

#[test]
fn what_was_computed_from_older_matrices_is_stale() {
    let (results, decks) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    beam(results.path());
    let back = folder("a-beam-plane-strain").join("4-back-loop.dat");
    run(&back, program("lamcel"), results.path()).unwrap();
    let thicker = edited(decks.path(), "1-lamcel.dat", "1,0.13208,0.", "1,0.14,0.");
    run(&thicker, program("lamcel"), results.path()).unwrap();
    let error = run(&back, program("lamcel"), results.path()).unwrap_err().to_string();
    assert!(error.contains("`BEAMDISP` is stale: the matrices `BEAMCELL.KM` were made anew since"), "{error}");
    let restart = folder("d-restart").join("3-restart-same-name.dat");
    let error = run(&restart, program("tradyr"), results.path()).unwrap_err().to_string();
    assert!(error.contains("cannot go on: the matrices `BEAMCELL.KM` were made anew since"), "{error}");
}

#[test]
fn names_that_differ_by_capitals_are_refused() {
    let (results, decks) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    beam(results.path());
    let other = edited(decks.path(), "1-lamcel.dat", "BEAMCELL.KM", "BeamCell.KM");
    let error = run(&other, program("lamcel"), results.path()).unwrap_err().to_string();
    assert!(error.contains("holds `BEAMCELL.KM`, from which `BeamCell.KM` differs by capitals alone"), "{error}");
}

#[test]
fn a_damaged_result_says_what_to_do() {
    let results = tempfile::tempdir().unwrap();
    beam(results.path());
    let file = results.path().join("BEAMCELL.KM.matrices");
    let mut bytes = std::fs::read(&file).unwrap();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    std::fs::write(&file, &bytes).unwrap();
    let deck = folder("a-beam-plane-strain").join("1-lamcel.dat");
    let error = run(&deck, program("lamcel"), results.path()).unwrap_err().to_string();
    assert!(error.contains("remove it, and run the deck that made it again"), "{error}");
    std::fs::remove_file(&file).unwrap();
    run(&deck, program("lamcel"), results.path()).unwrap();
}

#[test]
fn ends_of_lines_and_marks_of_bytes_change_nothing() {
    let text = std::fs::read_to_string(folder("a-beam-plane-strain").join("1-lamcel.dat")).unwrap();
    let title = |text: String| {
        let results = tempfile::tempdir().unwrap();
        let deck = results.path().join("deck.dat");
        std::fs::write(&deck, text).unwrap();
        run(&deck, program("lamcel"), results.path()).unwrap().title
    };
    let plain = title(text.clone());
    assert_eq!(title(format!("\u{feff}{text}")), plain);
    assert_eq!(title(text.replace('\n', "\r")), plain);
}

#[test]
fn matrices_and_displacements_are_shown_and_exported() {
    let results = tempfile::tempdir().unwrap();
    beam(results.path());
    let in_project = |command: &[&str]| fem(results.path(), command).good();
    let shown = in_project(&["deck", "show", "BEAMCELL.KM"]).stdout;
    assert!(shown.contains("matrices of 36 masters, 4 elements") && shown.contains("LAMCEL"), "{shown}");
    assert!(in_project(&["deck", "show", "BEAMDISP"]).stdout.contains("20 print steps to 4.000000e-4"));
    let missing = fem(results.path(), &["deck", "show", "NOTHING"]);
    assert!(missing.status == 1 && missing.stderr.contains("known are BEAMCELL.KM, BEAMDISP"), "{missing:?}");
    in_project(&["deck", "export", "BEAMCELL.KM"]);
    in_project(&["deck", "export", "BEAMDISP"]);
    let read = |file: &str| std::fs::read(results.path().join(file)).unwrap();
    let market = String::from_utf8(read("BEAMCELL.KM.stiffness.mtx")).unwrap();
    let array = read("BEAMCELL.KM.stiffness.npy");
    let values: Vec<f64> = array[128..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    let mut written = vec![f64::NAN; values.len()];
    for line in market.lines().filter(|line| !line.starts_with('%')).skip(1) {
        let [i, j, value] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let (i, j): (usize, usize) = (i.parse().unwrap(), j.parse().unwrap());
        for at in [36 * (j - 1) + i - 1, 36 * (i - 1) + j - 1] {
            written[at] = value.parse().unwrap();
        }
    }
    assert_eq!(values, written);
    assert_eq!(read("BEAMDISP.displacements.npy").len(), 128 + 8 * 20 * 198);
}

#[test]
fn a_folder_of_decks_is_checked_in_the_order_in_which_they_need_each_other() {
    let empty = tempfile::tempdir().unwrap();
    let examples = ["a-beam-plane-strain", "c1-quarter-plates-coupled", "d-restart", "h-one-dof-a-node"].map(folder);
    for decks in examples {
        let good = fem(empty.path(), &["deck", "check", decks.to_str().unwrap()]);
        assert_eq!(good.status, 0, "{good:?}");
    }
    let bad = fem(empty.path(), &["deck", "check", "--json", folder("g-malformed").to_str().unwrap()]);
    let checked: serde_json::Value = serde_json::from_str(&bad.stdout).unwrap();
    let good = checked.as_array().unwrap().iter().filter(|deck| deck["error"].is_null());
    // The restart finds the analysis of the second, which is there in this folder.
    let names: Vec<&str> = good.map(|deck| deck["deck"].as_str().unwrap().rsplit('/').next().unwrap()).collect();
    assert_eq!((bad.status, names), (1, vec!["63-tradyr-no-restart.dat", "setup-1-lamcel.dat", "setup-2-tradyr.dat"]));
    assert_eq!(std::fs::read_dir(empty.path()).unwrap().count(), 0);
}

#[test]
fn units_name_numbers_and_find_weight_densities() {
    let (results, decks) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let deck = edited(decks.path(), "1-lamcel.dat", "1.575E-9", "1.5E-2");
    let (deck, results) = (deck.to_str().unwrap(), results.path().to_str().unwrap());
    let done = fem(&root(), &["lamcel", deck, "--project", results, "--units", "N-mm-s", "--json"]).good();
    assert!(done.stderr.contains("looks like a weight density"), "{done:?}");
    let outcome: serde_json::Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(outcome["counts"]["masters"], 36);
    let unknown = fem(&root(), &["lamcel", deck, "--project", results, "--units", "SI"]);
    assert!(unknown.status == 2 && unknown.stderr.contains("known are N-mm-s, N-m-s, lbf-in-s"), "{unknown:?}");
}

#[test]
fn any_criterion_judges_stresses_of_a_deck() {
    let results = tempfile::tempdir().unwrap();
    beam(results.path());
    let deck = folder("a-beam-plane-strain").join("3-back-all.dat");
    let project = results.path().to_str().unwrap();
    fem(&root(), &["lamcel", deck.to_str().unwrap(), "--project", project, "--criteria", "hashin-report,max-stress"])
        .good();
    let [failure, indices] =
        ["failure", "indices"].map(|table| super::Table::read(&results.path().join(format!("3-back-all.{table}.csv"))));
    let keys = ["ndisp", "nsubs", "element", "where", "which", "criterion", "mode"];
    let (judged, equation, index) = (indices.by(&keys), failure.column("eq40"), indices.column("index"));
    let plies: Vec<_> = failure.rows.iter().filter(|row| row[3] == "ply").collect();
    assert_eq!(plies.len(), 16);
    for row in plies {
        let mut key = row[..5].to_vec();
        key.extend(["hashin-report".to_owned(), "matrix tension".to_owned()]);
        assert_eq!(judged[&key][index], row[equation]);
    }
    assert!(indices.rows.iter().any(|row| row[5] == "max-stress"));
    assert!(results.path().join("2-tradyr.force.svg").exists());
}

#[test]
fn criteria_that_would_judge_nothing_are_refused() {
    let results = tempfile::tempdir().unwrap();
    let folder = folder("a-beam-plane-strain");
    let project = results.path().to_str().unwrap();
    let refused = |arguments: &[&str], part: &str| {
        let done = fem(&folder, &[arguments, &["--project", project, "--criteria", "max-stress"]].concat());
        assert!(done.status == 1 && done.stderr.contains(part), "{done:?}");
    };
    refused(&["lamcel", "1-lamcel.dat"], "a generation finds none");
    beam(results.path());
    refused(&["tradyr", "2-tradyr.dat"], "give `--units` as well");
}

/// The quarters of an example, and its impact with options.
fn quarters(results: &Path, options: &[&str]) -> serde_json::Value {
    let folder = folder("c1-quarter-plates-coupled");
    for deck in ["1-lamsub-q1.dat", "2-lamsub-q2.dat"] {
        run(&folder.join(deck), program("lamsub"), results).unwrap();
    }
    let impact = ["tradyr", "3-tradyr.dat", "--json", "--project", results.to_str().unwrap()];
    serde_json::from_str(&fem(&folder, &[&impact[..], options].concat()).good().stdout).unwrap()
}

#[test]
fn an_impact_of_named_units_leaves_what_any_impact_does() {
    let results = tempfile::tempdir().unwrap();
    let impact =
        quarters(results.path(), &["--units", "N-mm-s", "--criteria", "hashin-report,max-stress"])["impact"].clone();
    let own = super::Table::read(&results.path().join("3-tradyr.history.csv"));
    let si = super::Table::read(&results.path().join("3-tradyr/history.csv"));
    assert_eq!(si.rows.len(), own.rows.len() + 1, "and the beginning");
    let last =
        |table: &super::Table, name: &str| -> f64 { super::number(&table.rows.last().unwrap()[table.column(name)]) };
    for (name, own_name, factor) in [
        ("contact_force_N", "F", 1.0),
        ("impactor_displacement_m", "u impactor", -1e-3),
        ("impactor_velocity_m_s", "v impactor", -1e-3),
        ("time_s", "t", 1.0_f64),
    ] {
        let (si, own) = (last(&si, name), last(&own, own_name));
        assert!((si - factor * own).abs() <= 1e-14 * si.abs(), "{name}: {si}, {own}");
    }
    // The indentation of the deck is what impactor and plate differ by.
    let gap = last(&si, "impactor_displacement_m") - last(&si, "plate_displacement_m");
    assert!((gap - 1e-3 * last(&own, "delta")).abs() < 1e-15, "{gap}");
    let energies: f64 =
        ["impactor_kinetic_J", "plate_kinetic_J", "plate_strain_J", "contact_stored_J", "contact_dissipated_J"]
            .iter()
            .map(|name| last(&si, name))
            .sum();
    assert!((energies / impact["impact"]["energy_J"].as_f64().unwrap() - 1.0).abs() < 1e-6, "{energies} {impact}");
    // Indices have no units: the same deck read in pounds and inches fails alike.
    let again = tempfile::tempdir().unwrap();
    let pounds =
        quarters(again.path(), &["--units", "lbf-in-s", "--criteria", "hashin-report,max-stress"])["impact"].clone();
    let ratio = |key: &str| pounds["impact"][key].as_f64().unwrap() / impact["impact"][key].as_f64().unwrap();
    assert!((ratio("peak_force_N") / 4.448_221_615_260_5 - 1.0).abs() < 1e-12);
    assert!((ratio("energy_J") / (4.448_221_615_260_5 * 25.4) - 1.0).abs() < 1e-12);
    for kind in ["first_damage", "not_reached"] {
        let times = |of: &serde_json::Value| -> Vec<(String, f64)> {
            let each = of[kind].as_array().unwrap().iter();
            each.map(|row| (row["mode"].to_string(), row["time_s"].as_f64().unwrap())).collect()
        };
        let (a, b) = (times(&impact), times(&pounds));
        assert_eq!(a.len(), b.len());
        assert!(a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-12), "{a:?} {b:?}");
    }
    fem(results.path(), &["report", "3-tradyr"]).good();
    let page = std::fs::read_to_string(results.path().join("3-tradyr/report.html")).unwrap();
    for part in ["id=\"deck\"", "id=\"result-model\"", "contact_force", "force_displacement", "peak force"] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn a_criterion_without_its_strengths_is_left_out_and_said() {
    let results = tempfile::tempdir().unwrap();
    let done = quarters(results.path(), &["--units", "N-mm-s", "--criteria", "hashin-report,brewer-lagace"]);
    let warnings = done["warnings"].to_string();
    assert!(warnings.contains("judges nothing"), "{warnings}");
    assert!(done["impact"]["not_reached"].to_string().contains("hashin-report"));
}

#[test]
fn nodes_that_pieces_share_in_unlike_axes_are_told() {
    let (results, decks) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let folder = folder("c1-quarter-plates-coupled");
    run(&folder.join("1-lamsub-q1.dat"), program("lamsub"), results.path()).unwrap();
    let text = std::fs::read_to_string(folder.join("2-lamsub-q2.dat")).unwrap();
    let warned = |text: &str| {
        let path = decks.path().join("2-lamsub-q2.dat");
        std::fs::write(&path, text).unwrap();
        run(&path, program("lamsub"), results.path()).unwrap();
        run(&folder.join("3-tradyr.dat"), program("tradyr"), results.path()).unwrap().warnings
    };
    assert_eq!(warned(&text), Vec::<String>::new(), "columns that only their images share may have axes of their own");
    let shared =
        text.lines().find(|line| line.split(',').nth(1).is_some_and(|x| x == "0.") && line.contains(",25.,")).unwrap();
    let turned = format!("{},90.", shared.rsplit_once(',').unwrap().0);
    let warnings = warned(&text.replace(shared, &turned));
    assert!(
        warnings.iter().any(|w| w.starts_with("substructures 1 and 2 share node ") && w.contains("BETA 0 and 90")),
        "{warnings:?}"
    );
}

#[test]
fn a_project_of_its_own_stands_beside_results_of_scenes() {
    let home = tempfile::tempdir().unwrap();
    std::fs::create_dir(home.path().join("decks")).unwrap();
    for deck in ["1-lamcel.dat", "2-tradyr.dat"] {
        std::fs::copy(folder("a-beam-plane-strain").join(deck), home.path().join("decks").join(deck)).unwrap();
    }
    fem(home.path(), &["lamcel", "decks/1-lamcel.dat"]).good();
    let said = fem(home.path(), &["tradyr", "decks/2-tradyr.dat"]).good().stdout;
    assert!(said.contains("with `--units`"), "{said}");
    let said = fem(home.path(), &["tradyr", "decks/2-tradyr.dat", "--units", "N-mm-s"]).good().stdout;
    assert!(!said.contains("with `--units`") && said.contains("  force     peak "), "{said}");
    for file in ["BEAMCELL.KM.matrices", "BEAMDISP.displacements", "2-tradyr/summary.json"] {
        assert!(home.path().join("results/decks-project").join(file).exists(), "{file}");
    }
}
