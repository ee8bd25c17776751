//! What fuzzing found worth keeping, read again: `fuzz/README.md`.

use crate::case::{Case, Room};
use crate::support::root;
use fem::io::{scene, units};
use std::fs;
use std::panic::catch_unwind;
use std::path::Path;

#[path = "../../fuzz/src/targets.rs"]
#[allow(unreachable_pub, reason = "a module of another crate")]
mod targets;

pub(crate) fn cases() -> Vec<Case> {
    let case = |name, varied, worst| {
        Room::Input.case(name, varied, "inputs that panic or break a promise of the reader", 0.0, worst)
    };
    vec![
        case("corpus of the mesh reader", "14 inputs by hand, 200 found by fuzzing", || {
            replayed("mesh", [14, 200], targets::mesh)
        }),
        case("corpus of the readers of Abaqus and Nastran", "12 inputs by hand", || {
            replayed("lines", [12, 0], targets::lines)
        }),
        case("corpus of the scene reader", "8 inputs by hand, 200 found by fuzzing", || {
            replayed("scene", [8, 200], targets::scene)
        }),
        case("corpus of the reader of decks", "74 inputs by hand, 200 found by fuzzing", || {
            replayed("deck", [74, 200], targets::deck)
        }),
        case("corpus of the layup notation", "15 inputs by hand, 200 found by fuzzing", || {
            replayed("layup", [15, 200], targets::layup)
        }),
        case("corpus of the formulas", "10 inputs by hand, 200 found by fuzzing", || {
            replayed("expression", [10, 200], targets::expression)
        }),
        case("corpus of the units", "11 inputs by hand, 200 found by fuzzing", || {
            replayed("units", [11, 200], targets::units)
        }),
        Room::Input.case(
            "nesting without end",
            "100 000 brackets: lists and tables of a scene, layups, formulas, units",
            "texts that are not refused",
            0.0,
            nested,
        ),
    ]
}

/// Inputs of `name`, by hand and found, `counts` of them, for which `target` panics.
fn replayed(name: &str, counts: [usize; 2], target: fn(&[u8])) -> f64 {
    let inputs = ["seeds", "corpus"].map(|kind| {
        let folder = root().join("fuzz").join(kind).join(name);
        // One that holds nothing is no folder of a repository.
        fs::read_dir(&folder).into_iter().flatten().map(|entry| entry.unwrap().path()).collect::<Vec<_>>()
    });
    let [seeds, corpus] = &inputs;
    assert_eq!([seeds.len(), corpus.len()], counts);
    let broken = inputs.iter().flatten().filter(|path| {
        let data = fs::read(path).unwrap();
        let panics = catch_unwind(|| target(&data)).is_err();
        if panics {
            eprintln!("{}", path.display());
        }
        panics
    });
    broken.count() as f64
}

fn nested() -> f64 {
    const DEEP: usize = 100_000;
    let deep = |open: &str, within: &str, close: &str| [open.repeat(DEEP), within.into(), close.repeat(DEEP)].concat();
    let scene = |text: String| scene::parse(&text, Path::new("scene.toml")).is_ok();
    let formula =
        |text: &str| fem::failure::Expression::new(fem::core::failure::Site::Ply, &[("failure", text)]).is_ok();
    let taken = [
        scene(format!("title = {}", deep("[", "1", "]"))),
        scene(format!("title = {}", deep("{ a = ", "1", "}"))),
        scene(format!("[{}a]", "a.".repeat(DEEP))),
        scene(format!("{}a = 1", "a.".repeat(DEEP))),
        fem::core::layup::parse(&deep("[", "0", "]")).is_ok(),
        fem::core::layup::parse(&format!("[{}]", deep("(", "0", ")"))).is_ok(),
        formula(&deep("(", "s1", ")")),
        formula(&deep("abs(", "s1", ")")),
        units::parse_quantity(&format!("1 {}", deep("(", "m", ")"))).is_ok(),
    ];
    taken.into_iter().filter(|taken| *taken).count() as f64
}
