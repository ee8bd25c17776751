//! `fem modes` and `fem matrices` write what they say.

use super::scene::{Plate, Side, isotropic};
use crate::support::fem;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A free aluminium plate of 30 x 20 x 2 mm.
fn plate() -> Plate {
    Plate::new(&isotropic(70.0, 0.3, 2.7), "[0]", 2.0, vec![1]).rectangle([30.0, 20.0], [3, 2]).sides([Side::Free; 4])
}

const MASS: f64 = 2700.0 * 30e-3 * 20e-3 * 2e-3;

/// Runs a command on it; its folder of results is `out`.
fn run(command: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), plate().text("modes")).unwrap();
    fem(folder.path(), &[command, &["scene.toml", "--out", "out"]].concat()).good();
    folder
}

fn table(path: &Path) -> Vec<HashMap<String, String>> {
    csv::Reader::from_path(path).unwrap().deserialize().map(|row| row.unwrap()).collect()
}

/// A Matrix Market file: its size and its entries.
fn matrix(path: &Path) -> (usize, HashMap<(usize, usize), f64>) {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.starts_with("%%MatrixMarket matrix coordinate real symmetric"), "{}", &text[..60]);
    let mut lines = text.lines().filter(|l| !l.starts_with('%')).map(|l| l.split_whitespace().collect::<Vec<_>>());
    let head: Vec<usize> = lines.next().unwrap().iter().map(|n| n.parse().unwrap()).collect();
    let index = |text: &str| text.parse::<usize>().unwrap();
    let lower: HashMap<_, f64> = lines.map(|l| ((index(l[0]), index(l[1])), l[2].parse().unwrap())).collect();
    assert_eq!((head[0], head[2]), (head[1], lower.len()));
    assert!(lower.iter().all(|((i, j), value)| i > j && *value != 0.0 || i == j));
    let upper = lower.iter().map(|((i, j), value)| ((*j, *i), *value)).collect::<Vec<_>>();
    (head[0], lower.into_iter().chain(upper).collect())
}

#[test]
fn modes_lists_as_many_as_asked_for() {
    let folder = run(&["modes", "--count", "8"]);
    let rows = table(&folder.path().join("out/modes.csv"));
    let column = |name: &str| -> Vec<f64> { rows.iter().map(|r| r[name].parse().unwrap()).collect() };
    let (hertz, omega) = (column("frequency_Hz"), column("omega_rad_s"));
    assert_eq!(hertz.len(), 8);
    assert!(hertz.iter().zip(&omega).all(|(f, w)| (f * TAU - w).abs() <= 1e-12 * w), "{hertz:?} {omega:?}");
    assert!(omega.is_sorted() && omega[6] > 1e3 * omega[5], "{omega:?}");
    // The six rigid motions carry the whole mass along each axis.
    for axis in ["x", "y", "z"] {
        let carried: f64 = column(&format!("effective_mass_{axis}_kg"))[..6].iter().sum();
        assert!((carried / MASS - 1.0).abs() < 1e-6, "{axis}: {carried} of {MASS}");
    }
}

#[test]
fn matrices_can_be_read_back() {
    let folder = run(&["matrices"]);
    let out = folder.path().join("out");
    let ((n, k), (size, m)) = (matrix(&out.join("stiffness.mtx")), matrix(&out.join("mass.mtx")));
    let unknowns = table(&out.join("unknowns.csv"));
    assert_eq!((size, unknowns.len()), (n, n));
    let stiffest = k.values().fold(0.0_f64, |a, b| a.max(b.abs()));
    for translation in ["U10", "U20", "U30"] {
        let moves = |i: usize| unknowns[i - 1]["unknown"] == translation;
        let mut forces = vec![0.0; n];
        k.iter().filter(|((_, j), _)| moves(*j)).for_each(|((i, _), value)| forces[i - 1] += value);
        assert!(forces.iter().all(|f| f.abs() < 1e-10 * stiffest), "{translation}");
        let mass: f64 = m.iter().filter(|((i, j), _)| moves(*i) && moves(*j)).map(|(_, value)| value).sum();
        assert!((mass / MASS - 1.0).abs() < 1e-10, "{translation}: {mass} of {MASS}");
    }
}
