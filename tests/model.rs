//! The model between scene and march: assembly, constraints, contact patch, reductions.

use crate::support::{root, whole};
use fem::analyses::impact;
use fem::analyses::matrices::PlateMatrices;
use fem::core::assembly::{Matrix, Symmetric, assemble, elimination_order, pattern};
use fem::core::constraint::Constraints;
use fem::core::counters::Counters;
use fem::io::scene;
use fem::{Error, Model, Registry};
use std::num::NonZeroUsize;
use std::sync::Arc;

const EXAMPLE: &str = "as4-3502-16ply-50mm";

fn model_of(edits: &[(&str, &str)]) -> Result<Model, Error> {
    let path = root().join("examples").join(EXAMPLE).join("scene.toml");
    let mut text = whole(&std::fs::read_to_string(&path).unwrap());
    for (from, to) in edits {
        assert!(text.contains(from), "no `{from}`");
        text = text.replace(from, to);
    }
    Model::new(scene::parse(&text, &path).unwrap(), &Registry::standard())
}

fn stiffness_at_contact(edits: &[(&str, &str)]) -> f64 {
    impact::prepare(&model_of(edits).unwrap(), NonZeroUsize::MIN).unwrap().sizes.static_stiffness
}

/// The matrices of the example without any constraint.
fn free_matrices(model: &Model, threads: usize) -> (Symmetric, Symmetric) {
    let order: Vec<usize> = elimination_order(&model.plate);
    let free = Constraints::eliminate(&order, &[]).unwrap();
    let pattern = Arc::new(pattern(&model.plate, &free));
    let threads = NonZeroUsize::new(threads).unwrap();
    let make = |which| {
        assemble(&model.plate, &*model.element, &free, &pattern, which, threads, &mut Counters::default()).unwrap()
    };
    (make(Matrix::Stiffness), make(Matrix::Mass))
}

#[test]
fn rigid_motions_cost_no_energy_and_carry_the_mass() {
    let model = model_of(&[]).unwrap();
    let (k, m) = free_matrices(&model, 1);
    let order = elimination_order(&model.plate);
    let length = 25e-3;
    let stiffest = k.lower().val().iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let mass = model.areal_mass * model.plate.plane.area();
    for motion in 0..6 {
        let u: Vec<f64> = order.iter().map(|d| model.plate.rigid_motions(*d, [0.0; 3], length)[motion]).collect();
        let (mut force, mut momentum) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        k.add_product(1.0, &u, &mut force);
        m.add_product(1.0, &u, &mut momentum);
        let worst = force.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        assert!(worst < 1e-10 * stiffest, "motion {motion}: force {worst:e} of {stiffest:e}");
        let carried: f64 = u.iter().zip(&momentum).map(|(a, b)| a * b).sum();
        if motion < 3 {
            assert!((carried / mass - 1.0).abs() < 1e-10, "motion {motion}: {carried} of {mass}");
        }
    }
}

#[test]
fn assembly_is_the_same_for_any_number_of_threads() {
    let model = model_of(&[]).unwrap();
    let one = free_matrices(&model, 1);
    for threads in [2, 3, 4] {
        assert!(free_matrices(&model, threads) == one, "{threads} threads");
    }
}

#[test]
fn a_contact_patch_is_a_mean_around_its_centre() {
    let model = model_of(&[("at = { group = \"impact\" }", "at = { x = \"3 mm\", y = \"-2 mm\" }")]).unwrap();
    let patch =
        fem::core::patch::hertz(&model.plate, &*model.element, (fem::core::load::Face::Top, 0.0), [3e-3, -2e-3], 3e-3)
            .unwrap();
    let value = |motion: usize| -> f64 {
        patch.0.iter().map(|(d, w)| w * model.plate.rigid_motions(*d, [0.0; 3], 1.0)[motion]).sum()
    };
    // w counts downwards; a rotation about x lifts y > 0, one about y lowers x > 0.
    for (motion, want) in [(0, 0.0), (1, 0.0), (2, -1.0), (3, 2e-3), (4, 3e-3), (5, 0.0)] {
        assert!((value(motion) - want).abs() < 1e-12, "motion {motion}: {}", value(motion));
    }
}

#[test]
fn turned_axes_and_ties_mean_what_they_say() {
    let all = "at = \"all\"\nfix = [\"U10\", \"U30\"]";
    let swapped = "at = \"all\"\nfix = [\"U20\", \"U30\"]";
    let turned = "at = \"all\"\nfix = [\"U20\", \"U30\"]\naxes = \"-90 deg\"";
    let old = "at = \"mid-plane\"\nfix = [\"U30\"]";
    let plain = stiffness_at_contact(&[(old, all)]);
    let same = stiffness_at_contact(&[(old, turned)]);
    assert!((plain / same - 1.0).abs() < 1e-9, "{plain} {same}");
    // The laminate is stiffer along 0 than along 90: the other direction must not give the same number.
    let other = stiffness_at_contact(&[(old, swapped)]);
    assert!((plain / other - 1.0).abs() > 1e-6, "{plain} {other}");
    // Any turn of a direction in which all three translations are held changes nothing.
    let held = "at = \"all\"\nfix = [\"U10\", \"U20\", \"U30\"]";
    let held_turned = "at = \"all\"\nfix = [\"U10\", \"U20\", \"U30\"]\naxes = \"33 deg\"";
    let (a, b) = (stiffness_at_contact(&[(old, held)]), stiffness_at_contact(&[(old, held_turned)]));
    assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
}

#[test]
fn every_reduction_keeps_the_static_flexibility() {
    let reduction = |text: &str| {
        stiffness_at_contact(&[
            ("[march]", &format!("[reduction]\n{text}\n\n[march]")),
            ("end = \"1 ms\"", "end = \"1 us\""),
        ])
    };
    let full = reduction("method = \"none\"");
    for text in [
        "method = \"guyan\"\ngovernors = 0",
        "method = \"guyan\"\ngovernors = 20",
        "method = \"guyan\"\ngovernors = 20\nselect = \"ratio\"",
        "method = \"modal\"\nmodes = 0",
        "method = \"modal\"\nmodes = 10",
        "method = \"craig-bampton\"\nmodes = 0",
        "method = \"craig-bampton\"\nmodes = 10",
        "method = \"ritz\"\nvectors = 1",
        "method = \"ritz\"\nvectors = 12",
    ] {
        let reduced = reduction(text);
        assert!((reduced / full - 1.0).abs() < 1e-8, "{text}: {reduced} {full}");
    }
}

#[test]
fn what_a_support_leaves_free_is_named() {
    let without = model_of(&[("[[support]]\nrestrain = \"rigid-motions\"", "")]).unwrap_err().to_string();
    for motion in ["translation along x", "translation along y", "rotation about z"] {
        assert!(without.contains(motion), "{without}");
    }
    assert!(!without.contains("translation along z"), "{without}");
}

/// Springs hold the plate of the files as they do that of a run.
#[test]
fn matrices_have_the_springs_of_supports() {
    let text = r#"
title = "bed"
analysis = "modes"
mesh = { rectangle = ["20 mm", "12 mm"], cells = [4, 4] }
materials = { t = { library = "AS4/3502" } }
laminate = { plies = "[0/90]s", material = "t", ply_thickness = "0.25 mm", layers = 2 }
support = [
  { group = "plate", kind = "roller", at = "bottom", stiffness = "1 N/mm^3" },
  { group = "x-min", kind = "roller", at = "bottom", stiffness = "2 N/mm^2" },
  { restrain = "rigid-motions" },
]
"#;
    let model = Model::new(scene::parse(text, "scene.toml".as_ref()).unwrap(), &Registry::standard()).unwrap();
    let PlateMatrices { stiffness, unknowns, .. } = PlateMatrices::new(&model, NonZeroUsize::MIN).unwrap();
    let raised: Vec<f64> = unknowns.iter().map(|unknown| f64::from(unknown.name == "U30")).collect();
    let mut force = vec![0.0; raised.len()];
    stiffness.add_product(1.0, &raised, &mut force);
    let held: f64 = raised.iter().zip(&force).map(|(u, f)| u * f).sum();
    // N/m: 1 N/mm³ over 20 × 12 mm and 2 N/mm² along 12 mm.
    assert!((held / 264_000.0 - 1.0).abs() < 1e-9, "{held}");
}
