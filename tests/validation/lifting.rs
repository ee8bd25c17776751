//! Supports that a plate lifts off, against closed forms and against plates without them.

use super::scene::{MeshFile, gmsh_file, isotropic};
use super::springs::{E, ELEMENTS, NEAR, NU, SIDE, THICKNESS, bending, deflections, model, text};
use fem::analyses::{impact, statics};
use fem::io::tables::HistoryRow;
use std::num::NonZeroUsize;

/// A strip of 120 by 5 mm with lines `a`, `b` and `c` across it at 0, 60 and 120 mm, and the cells between `a` and `b` in `left`.
fn strip(cells: usize) -> MeshFile {
    let node = |i: usize, j: usize| 1 + i + j * (2 * cells + 1);
    let size = 60.0 / cells as f64;
    let nodes: Vec<_> = (0..2).flat_map(|j| (0..=2 * cells).map(move |i| [size * i as f64, 5.0 * j as f64])).collect();
    let across = |i: usize| vec![vec![node(i, 0), node(i, 1)]];
    let along = |j: usize| (0..2 * cells).map(|i| vec![node(i, j), node(i + 1, j)]).collect::<Vec<_>>();
    let cell = |i: usize| vec![node(i, 0), node(i + 1, 0), node(i + 1, 1), node(i, 1)];
    gmsh_file(
        &nodes,
        &[
            ("a", across(0)),
            ("b", across(cells)),
            ("c", across(2 * cells)),
            ("front", along(0)),
            ("back", along(1)),
            ("left", (0..cells).map(cell).collect()),
            ("right", (cells..2 * cells).map(cell).collect()),
        ],
    )
}

/// A strip that lies on three lines and is loaded on one span lifts off the third: what is left is a beam on two supports, whose end
/// turns up by q l³/(24 D). Lines that press from above carry the same load upwards; with equal loads on both spans none lifts, and the
/// strip is that on three lines that hold both ways.
#[test]
fn strips_lift_off() {
    let (h, l, q) = (2e-3, 0.06_f64, 1e5);
    let (d, shear) = (bending(h), 5.0 / 6.0 * E / (2.0 * (1.0 + NU)) * h);
    let middle = 5.0 * q * l.powi(4) / (384.0 * d) + q * l * l / (8.0 * shear);
    let end = -q * l.powi(4) / (24.0 * d);
    let section = ("kind = 'webster-beam', state = 'plane-strain'", 12);
    for (element, cells) in ELEMENTS.map(|(element, _)| (element, 12)).into_iter().chain([section]) {
        let mesh = strip(if element.contains("mitc4") { 30 } else { cells });
        let file = format!("{{ file = '{}', unit = 'mm' }}", mesh.path().join("plate.msh").display());
        let plane = match element.contains("webster") {
            true => "",
            false => "{ group = 'front', kind = 'symmetry' }, { group = 'back', kind = 'symmetry' }, ",
        };
        let strip = |support: &str, face: &str, group: &str| {
            let lines = ["a", "b", "c"].map(|line| format!("{{ group = '{line}', {support} }}"));
            let supports = format!("{plane}{}, {{ restrain = 'rigid-motions' }}", lines.join(", "));
            let load = format!("pressure = '0.1 MPa'\nface = '{face}'{group}");
            deflections(&text(&file, element, 0.5e3 * h, &supports, &load), [[0.5 * l, 0.0], [2.0 * l, 0.0]])
        };
        for (at, face, up) in [("bottom", "top", 1.0), ("top", "bottom", -1.0)] {
            let found = strip(&format!("kind = 'rest', at = '{at}'"), face, "\ngroup = 'left'");
            for (found, exact) in found.into_iter().zip([middle, end]) {
                assert!((up * found / exact - 1.0).abs() < NEAR, "{element} {at}: {found:e}, not {exact:e}");
            }
        }
        let [pushed, held] = ["rest", "roller"]
            .map(|kind| strip(&format!("kind = '{kind}', at = 'bottom', stiffness = '1e4 N/mm^2'"), "top", ""));
        let same = |(a, b): (f64, f64)| (a / b - 1.0).abs() < 1e-9;
        assert!(pushed.into_iter().zip(held).all(same), "{element}: {pushed:?} {held:?}");
    }
}

/// A square on four elastic sides that only push, k = 1000 D/a³, under uniform pressure q: its corners rise. Of a thin plate
/// w D/(q a⁴) is 4.92994e-3 in the middle and −7.5518e-4 in the corners: Ritz's method with products of Legendre polynomials up to the
/// degree of 20 in each direction, sides at 120 Gauss points each, those that push found by trial; a degree of 16 changes 1e-5 of either.
#[test]
fn corners_rise() {
    let d = bending(THICKNESS);
    let stiffness = 1e3 * d / SIDE.powi(3);
    let sides = ["x-min", "x-max", "y-min", "y-max"]
        .map(|side| format!("{{ group = '{side}', kind = 'rest', stiffness = '{stiffness:.9e} N/m^2' }}"));
    let supports = format!("{}, {{ restrain = 'rigid-motions' }}", sides.join(", "));
    let unit = 1e3 * SIDE.powi(4) / d;
    for (element, cells) in ELEMENTS {
        let mesh = format!("{{ rectangle = ['100 mm', '100 mm'], cells = [{cells}, {cells}] }}");
        let load = "pressure = '1 kPa'\nface = 'top'";
        let text = text(&mesh, element, 500.0 * THICKNESS, &supports, load);
        let [middle, corner] = deflections(&text, [[0.5 * SIDE; 2], [0.0; 2]]).map(|w| w / unit);
        assert!((middle / 4.92994e-3 - 1.0).abs() < NEAR, "{element}: {middle:e}");
        // Thick plates rise less: twist is spread over an edge as wide as they are thick.
        assert!((corner / -7.5518e-4 - 1.0).abs() < 2.5e-2, "{element}: {corner:e}");
    }
}

/// 500 g at 1 m/s on a square that lies on its edges.
fn blow(kind: &str, reduction: &str, integrator: &str, step: &str) -> String {
    let sides = ["x-min", "x-max", "y-min", "y-max"]
        .map(|side| format!("{{ group = '{side}', kind = '{kind}', at = 'bottom', stiffness = '1e3 N/mm^2' }}"));
    format!(
        "title = 'struck'\nmesh = {{ rectangle = ['60 mm', '60 mm'], cells = [6, 6] }}\nelement = {{ kind = 'mitc4' }}\n\
         laminate = {{ plies = '[0/0]', material = 'm', ply_thickness = '1 mm', layers = [2] }}\n\
         support = [{}, {{ restrain = 'rigid-motions' }}]\nreduction = {{ {reduction} }}\n\
         impactor = {{ mass = '500 g', velocity = '1 m/s', at = {{ x = '30 mm', y = '30 mm' }} }}\n\
         contact = {{ law = 'hertz', k = '1e4 N/mm^1.5' }}\neffects = {{ damage = 'off' }}\n\
         march = {{ step = '{step}', end = '3 ms', integrator = '{integrator}' }}\n[materials.m]\n{}",
        sides.join(", "),
        isotropic(E * 1e-9, NU, 2.7)
    )
}

fn struck(kind: &str, reduction: &str, integrator: &str, step: &str) -> impact::Outcome {
    let model = model(&blow(kind, reduction, integrator, step)).unwrap();
    impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap()
}

fn peak(outcome: &impact::Outcome) -> f64 {
    outcome.history.iter().map(HistoryRow::contact_force_n).fold(0.0, f64::max)
}

/// Corners lift off under the blow and the plate leaves its frame after it; nothing of the energy is lost, and a plate reduced to few
/// vectors does what the full one does, and what a march of small steps does that knows no more of springs than their forces.
#[test]
fn struck_plates_lift_off() {
    let few = "method = 'ritz', vectors = 20";
    let exact = struck("rest", "method = 'none'", "energy-conserving", "1 us");
    assert_eq!(exact.stopped, None);
    assert!(exact.energy_error < 1e-9, "{:e}", exact.energy_error);
    for (reduction, integrator, step, near) in [
        (few, "energy-conserving", "1 us", 1e-5),
        ("method = 'none'", "newmark", "1 us", 1e-3),
        (few, "central-difference", "20 ns", 3e-3),
    ] {
        let other = struck("rest", reduction, integrator, step);
        assert_eq!(other.stopped, None);
        assert!(other.energy_error < 1e-3, "{integrator}: {:e}", other.energy_error);
        let found = peak(&other) / peak(&exact) - 1.0;
        assert!(found.abs() < near, "{reduction} {integrator}: {found:e}");
    }
    // Held at its corners the plate is stiffer.
    let held = struck("roller", few, "newmark", "1 us");
    assert!(peak(&held) > 1.02 * peak(&exact), "{} {}", peak(&held), peak(&exact));
}

/// Cells that are clamped as a whole do not move, nor do springs of theirs: areas, and lines in them.
#[test]
fn springs_of_what_does_not_move_hold_nothing() {
    let mesh = strip(12);
    let file = format!("{{ file = '{}', unit = 'mm' }}", mesh.path().join("plate.msh").display());
    let tip = |more: &str| {
        let supports = format!("{{ group = 'left', kind = 'clamped' }}{more}");
        let load = "pressure = '0.1 MPa'\nface = 'top'\ngroup = 'right'";
        deflections(&text(&file, ELEMENTS[0].0, 1.0, &supports, load), [[0.12, 0.0]])
    };
    let [own] = tip("");
    assert!(own > 1e-6, "{own}");
    for more in [
        ", { group = 'left', kind = 'roller', at = 'bottom', stiffness = '5 N/mm^3' }",
        ", { group = 'a', kind = 'roller', at = 'bottom', stiffness = '5 N/mm^2' }",
        ", { group = 'left', kind = 'rest' }",
    ] {
        assert_eq!(tip(more), [own], "{more}");
    }
}

#[test]
fn wrong_ways() {
    let plate = "{ rectangle = ['100 mm', '100 mm'], cells = [4, 4] }";
    let scene = |more: &str, supports: &str, load: &str| {
        format!("{more}\n{}", text(plate, "kind = 'mitc4'", 0.5, supports, load))
    };
    let refused = |more: &str, supports: &str, word: &str| {
        let shown = format!("{:?}", model(&scene(more, supports, "pressure = '1 kPa'\nface = 'top'")).unwrap_err());
        assert!(shown.contains(word), "{supports}: no `{word}` in {shown}");
    };
    refused("", "{ group = 'x-min', kind = 'rest', at = 'all' }", "rests on one of its faces");
    refused("", "{ group = 'x-min', kind = 'rest', stiffness = '5 N/mm^3' }", "another dimension");
    refused("", "{ group = 'x-min', kind = 'rest' }", "leave the plate free");
    refused("", "{ disc = { x = '0 mm', y = '0 mm', radius = '4 mm' }, kind = 'rest' }", "leaves the plate");
    refused("", "{ group = 'x-min', kind = 'rest', at = 'mid-plane' }", "rests on one of its faces");
    refused("", "{ group = 'x-min', kind = 'rest', stiffness = '0 N/mm^2' }", "is positive");
    refused("", "{ group = 'x-min', kind = 'rest', stiffness = '1e-12 N/mm^2' }", "write at least 7.0e-7 N/mm^2");
    let all = "{ group = 'plate', kind = 'rest' }, { restrain = 'rigid-motions' }";
    for (more, what) in [
        ("effects.membrane = 'on'", "large deflections"),
        ("effects.preload = [{ group = 'x-min', force = '1 N/mm' }]", "a preload"),
        ("substructures = { cells = [2, 2] }", "condensed substructures"),
    ] {
        refused(more, all, &format!("does not go with {what}"));
    }
    let mirrored = "{ group = 'x-min', kind = 'rest' }, { restrain = 'rigid-motions' }";
    refused("symmetry = 'mirror-x'", mirrored, "break the symmetry");
    let impact = blow("rest", "method = 'ritz', vectors = 20", "newmark", "1 us");
    for (text, with, what) in [
        ("damage = 'off'", "damage = 'off', gravity = '9.81 m/s^2'", "gravity"),
        ("damage = 'off'", "damage = 'off', damping = { ratio = 0.02 }", "damping"),
        (
            "[materials.m]",
            "[materials.m]\nlaw = { name = 'hahn-tsai', alpha = '2.4e-8 1/MPa^3' }",
            "plies that follow laws",
        ),
    ] {
        let shown = format!("{:?}", model(&impact.replacen(text, with, 1)).unwrap_err());
        assert!(shown.contains(&format!("does not go with {what}")), "{what}: {shown}");
    }
    let many = scene("", all, "pressure = '1 kPa'\nface = 'top'").replace("cells = [4, 4]", "cells = [46, 46]");
    let shown = format!("{:?}", model(&many).unwrap_err());
    assert!(shown.contains("does not go with more than 2000 points"), "{shown}");
    let cured = scene("effects = { cure = '-100 K' }", all, "pressure = '1 kPa'\nface = 'top'");
    let shown =
        format!("{:?}", model(&cured.replace("[materials.m]", "[materials.m]\nalpha = '1e-5 1/K'")).unwrap_err());
    assert!(shown.contains("does not go with residual strains at rest"), "{shown}");
    // Nothing holds it down, neither from above nor on its edges.
    let above = ["x-min", "x-max", "y-min", "y-max"]
        .map(|side| format!("{{ group = '{side}', kind = 'rest', at = 'top' }}"))
        .join(", ");
    let supports = format!("{above}, {{ restrain = 'rigid-motions' }}");
    let pressed = model(&scene("", &supports, "pressure = '1 kPa'\nface = 'top'")).unwrap();
    let lifted = format!("{:?}", statics::solve(&pressed, NonZeroUsize::MIN).unwrap_err());
    assert!(lifted.contains("lift the plate off"), "{lifted}");
    let up = model(&scene("", all, "pressure = '1 kPa'\nface = 'bottom'")).unwrap();
    let lifted = format!("{:?}", statics::solve(&up, NonZeroUsize::MIN).unwrap_err());
    assert!(lifted.contains("lift the plate off"), "{lifted}");
}
