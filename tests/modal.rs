//! The modal view of an impact.

use crate::support::{Case, strip};
use fem::analyses::{impact, modes};
use fem::io::scene;
use fem::{Model, Registry};
use std::f64::consts::TAU;
use std::num::NonZeroUsize;

fn followed(case: &Case) -> (Model, impact::Outcome) {
    let path = case.folder().join(case.write());
    let model = Model::new(scene::read(&path).unwrap(), &Registry::standard()).unwrap();
    let outcome = impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
    (model, outcome)
}

#[test]
fn parts_of_all_modes_are_the_deflection_and_their_energies_the_plates() {
    let reduction = "[reduction]\nmethod = \"ritz\"\nvectors = 2\n[march]";
    let (_, outcome) = followed(&strip().scene("[march]", reduction).append("[output]\nmodes = 38\n"));
    let modal = outcome.modal.unwrap();
    let n = modal.modes.len();
    assert_eq!((n, modal.coordinates.len()), (2, n * outcome.history.len()), "every mode is excited");
    for (row, parts) in outcome.history.iter().zip(modal.coordinates.chunks_exact(n)) {
        let sum: f64 = parts.iter().sum();
        assert!(
            (sum - row.impactors[0].plate_displacement_m).abs() <= 1e-12 * row.impactors[0].plate_displacement_m.abs(),
            "{row:?} {parts:?}"
        );
    }
    let shares: [fn(&impact::ModeShare) -> f64; 3] = [|m| m.static_share, |m| m.strain_share, |m| m.kinetic_share];
    for share in shares {
        let sum: f64 = modal.modes.iter().map(share).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    }
    let largest = |k: usize| modal.coordinates.iter().skip(k).step_by(n).fold(0.0_f64, |m, c| m.max(c.abs()));
    assert!(modal.modes.iter().enumerate().all(|(k, m)| m.largest_m == largest(k) && m.largest_m > 0.0));
}

#[test]
fn the_lowest_modes_are_natural_modes() {
    let (model, outcome) = followed(&strip().append("[output]\nmodes = 2\n"));
    let natural = modes::solve(&model, 6, NonZeroUsize::MIN).unwrap().modes.omega;
    for mode in outcome.modal.unwrap().modes {
        let error = |omega: &f64| (mode.frequency_Hz * TAU / omega - 1.0).abs();
        assert!(natural.iter().map(error).fold(f64::INFINITY, f64::min) < 1e-6, "{mode:?} {natural:?}");
    }
}

#[test]
fn a_table_and_pictures_of_the_modes() {
    let case = strip().append("[output]\nmodes = 2\n");
    let done = case.fem("run", &["--out", "out"]).good();
    assert!(done.stdout.contains("  modes     shares of each mode"), "{done:#?}");
    let (header, rows) = case.table("out/modal_coordinates.csv");
    assert_eq!(header, ["time_s", "C_1_m", "C_2_m"]);
    assert_eq!(rows.len(), case.table("out/history.csv").1.len());
    let svg = case.read("out/modal_coordinates.svg");
    assert!(["all modes", "mode 1, ", "mode 2, ", "the other modes"].iter().all(|name| svg.contains(name)));
    assert!(case.names("out").contains(&"modal_coordinates.png".to_owned()));
    assert_eq!(case.summary("out")["modes"].as_array().map(Vec::len), Some(2));
}

#[test]
fn modes_need_a_reduction() {
    let case = strip().scene("[march]", "[reduction]\nmethod = \"none\"\n[march]").append("[output]\nmodes = 2\n");
    let done = case.fem("run", &[]);
    assert!(done.status == 1 && done.stdout.is_empty(), "{done:#?}");
    for words in ["`output.modes` follows the modes of a reduced plate", "modes = 2", "method = \"ritz\""] {
        assert!(done.stderr.contains(words), "{words:?} is not in {}", done.stderr);
    }
}
