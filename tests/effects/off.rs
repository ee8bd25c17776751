//! What is off costs nothing and changes nothing.

use crate::support::{fem, watched};

#[test]
fn effects_that_are_off_change_no_bit() {
    let written = "[effects]\ndamage = \"onset\"\ndelamination = \"off\"\nmembrane = \"off\"\npreload = \"off\"\ndamping = \"off\"\n\
                   inertia = \"on\"\ngravity = \"off\"\n";
    let case = watched();
    case.fem("run", &["--out", "without"]).good();
    let case = case.append(written);
    case.fem("run", &["--out", "off"]).good();
    // A checkpoint knows the keys of its scene, of which a copy lies beside.
    assert_eq!(case.differing("without", "off"), ["checkpoint.bin", "scene.toml"]);
    for column in ["damping_dissipated_J", "gravity_potential_J"] {
        assert!(!case.table("off/history.csv").0.contains(&column.to_owned()), "{column}");
    }
    assert!(!case.read("off/summary.json").contains("plate_sag_m"));
}

#[test]
fn damage_that_nobody_looks_for_is_not_said_to_be_absent() {
    let said = watched().append("[effects]\ndamage = \"off\"\n").fem("run", &["--out", "off"]).good().stdout;
    assert!(said.contains("  damage    not looked for"), "{said}");
}

#[test]
fn effects_are_listed() {
    let listed = fem(&crate::support::root(), &["list", "effects"]).good().stdout;
    for effect in ["damage", "delamination", "membrane", "preload", "damping", "inertia", "gravity"] {
        assert!(listed.lines().any(|line| line.split_whitespace().next() == Some(effect)), "{effect}: {listed}");
    }
}
