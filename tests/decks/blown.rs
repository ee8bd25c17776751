//! Marches of decks that blow up are refused or stopped, as those of scenes are.

use super::folder;
use crate::support::{Done, fem};

/// The beam of the first example with other lines in its impact: outcome, and what the folder of the impact holds.
fn struck(changes: &[(&str, &str)]) -> (Done, Option<serde_json::Value>, tempfile::TempDir) {
    let home = tempfile::tempdir().unwrap();
    let folder = folder("a-beam-plane-strain");
    std::fs::copy(folder.join("1-lamcel.dat"), home.path().join("1-lamcel.dat")).unwrap();
    let mut text = std::fs::read_to_string(folder.join("2-tradyr.dat")).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    std::fs::write(home.path().join("2-tradyr.dat"), text).unwrap();
    fem(home.path(), &["lamcel", "1-lamcel.dat", "--project", "p"]).good();
    let done = fem(home.path(), &["tradyr", "2-tradyr.dat", "--project", "p", "--units", "N-mm-s"]);
    let summary = std::fs::read(home.path().join("p/2-tradyr/summary.json")).ok();
    (done, summary.map(|bytes| serde_json::from_slice(&bytes).unwrap()), home)
}

#[test]
fn a_contact_too_stiff_for_the_step_is_refused() {
    for k in ["1.58E7", "5.E9"] {
        let (done, summary, _home) = struck(&[("500.,1.5", &format!("{k},1.5"))]);
        assert!(done.status == 1 && summary.is_none(), "{done:?}");
        for part in ["highest frequency of plate and contact times DELTA", "DELTA of ", "K, M, I and C"] {
            assert!(done.stderr.contains(part), "{part}: {}", done.stderr);
        }
    }
}

#[test]
fn a_march_whose_energy_grows_stops_and_keeps_what_it_had() {
    // A scheme of second order under a contact: nothing bounds its step.
    let (done, summary, home) =
        struck(&[("4,2000,100,0", "2,2000,10,0"), ("2.E-7", "2.E-8"), ("500.,1.5", "1.E9,1.5")]);
    assert_eq!(done.status, 1, "{done:?}");
    for part in ["the march stopped in step ", "a smaller DELTA", "What was found up to then"] {
        assert!(done.stderr.contains(part), "{part}: {}", done.stderr);
    }
    assert!(!done.stderr.contains("march.step"), "{}", done.stderr);
    let summary = summary.unwrap();
    assert!(summary["completed"] == false && summary["stopped"].as_str().is_some_and(|why| why.contains("energy")));
    let read = |file: &str| std::fs::read_to_string(home.path().join("p").join(file)).unwrap();
    assert!(read("2-tradyr.listing.txt").contains("the march stopped in step "));
    assert!(read("2-tradyr.history.csv").lines().count() > 2);
    fem(home.path(), &["deck", "show", "BEAMDISP", "--project", "p"]).good();
}

#[test]
fn a_march_says_its_energy_error() {
    let (done, summary, home) = struck(&[]);
    assert!(done.good().stdout.contains("  energy    error "));
    assert!(summary.unwrap()["accuracy"]["energy_error_relative"].as_f64().unwrap() < 1e-2);
    let listing = std::fs::read_to_string(home.path().join("p/2-tradyr.listing.txt")).unwrap();
    assert!(listing.contains("change of the energy, of that of the impact "));
}
