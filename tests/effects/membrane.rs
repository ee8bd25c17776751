//! Membrane stiffening of a plate that is struck.

use super::{EDGES, Struck, TAPE, difference, force};
use crate::support::{Case, root, strip};
use fem::analyses::impact::{self, Outcome};
use fem::failure::scan::first_per_mode;
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Model, Registry};
use serde_json::Value;
use std::fs;
use std::num::NonZeroUsize;

const OFF: &str = "membrane = 'off'";
const ON: &str = "membrane = 'on'";

fn run(scene: &str, folder: &str) -> Outcome {
    let scene = scene::parse(scene, &root().join(folder).join("scene.toml")).unwrap();
    let model = Model::new(scene, &Registry::standard()).unwrap();
    let outcome = impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
    assert_eq!(outcome.stopped, None);
    outcome
}

/// Largest contact force (N), its time and the end of the contact, s.
fn peak(history: &[HistoryRow]) -> [f64; 3] {
    let most = history.iter().max_by(|a, b| force(a).total_cmp(&force(b))).unwrap();
    let last = history.iter().rev().find(|row| force(row) > 0.0).unwrap();
    [force(most), most.time_s, last.time_s]
}

/// A pinned plate without inertia under a heavy mass: `nonlin_impact_qs_square75_xply8_as4.json`, von Karman's theory in
/// global polynomials. The side and all that goes with it is scaled up until the plate is as thin as that theory has it.
#[test]
fn a_large_mass_meets_von_karmans_plate() {
    let scale = 8.0_f64;
    let text =
        fs::read_to_string(root().join("tests/data/reference/nonlin_impact_qs_square75_xply8_as4.json")).unwrap();
    let reference: Value = serde_json::from_str(&text).unwrap();
    for (effects, theory) in [(OFF, "linear"), (ON, "von_karman")] {
        let value = |key: &str| reference["results"][theory][key].as_f64().unwrap();
        // The stiffness of the plate at the same w/h falls with the square of the scale: so do forces, and the contact has to;
        // times are longer, speeds lower by the scale.
        let square = scale * scale;
        let scene = format!(
            "title = 'large mass'\nmesh = {{ rectangle = ['{side} mm', '{side} mm'], cells = [30, 30] }}\nsymmetry = 'quarter'\n\
             element = {{ kind = 'mitc4' }}\n\
             impactor = {{ mass = '2.49 kg', velocity = '{speed} m/s', at = {{ x = '{half} mm', y = '{half} mm' }}, patch_side = '{patch} mm' }}\n\
             contact = {{ law = 'hertz', k = '{k} N/mm^1.5' }}\n\
             effects = {{ damage = 'off', inertia = 'off', {effects} }}\n\
             march = {{ integrator = 'newmark', step = '{step} us', end = '{end} ms' }}\n\
             laminate = {{ plies = '[0/90/0/90]s', material = 'tape', ply_thickness = '0.13 mm', layers = 1 }}\n\
             [materials.tape]\nlibrary = 'AS4/3502'\n{}",
            EDGES.concat(),
            side = 75.0 * scale,
            half = 37.5 * scale,
            patch = 10.0 * scale,
            speed = 1.0 / scale,
            k = 1.07e5 / square,
            step = 10.0 * scale,
            end = 1.05 * value("contact_time_ms") * scale,
        );
        let found = peak(&run(&scene, "").history);
        let expected =
            [value("Fmax_N") / square, value("t_Fmax_ms") * 1e-3 * scale, value("contact_time_ms") * 1e-3 * scale];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-2, "{theory}: {found} {expected}");
        }
    }
}

/// Case 5 of the report's table 1 on its ring, which holds the mid-plane as `fix` says, to an end in ms by steps in us.
fn case_5(fix: &str, effects: &str, [end_ms, step_us]: [f64; 2], more: &str) -> Outcome {
    let folder = "examples/as4-3502-8ply-75mm";
    let text = fs::read_to_string(root().join(folder).join("scene.toml")).unwrap();
    let mut text = text
        .replace("fix = [\"U30\"]", fix)
        .replace("end = \"4 ms\"", &format!("end = \"{end_ms} ms\"\nstep = \"{step_us} us\""));
    if fix.contains("U10") {
        // The edge does what this did.
        text = text.replace("[[support]]\nrestrain = \"rigid-motions\"\n", "");
    }
    let criteria = text.lines().find(|line| line.starts_with("criteria = ")).unwrap().to_owned();
    text = text.replace(&criteria, more);
    run(&format!("{text}\n[effects]\n{effects}\n"), folder)
}

const MOVABLE: &str = "fix = [\"U30\"]";
const IMMOVABLE: &str = "fix = [\"U10\", \"U20\", \"U30\"]";
/// Strain along the fibres of the lowest ply, 2.54 mm from the impact: report, figure 19.
const STRAIN: &str = "criteria = [{ name = 'expression', expression = ['strain: (s1 - nu12*s2)/E1'] }]\nwindow = 'element'\n\
     every = '20 us'\nwatch = [{ at = { x = '2.54 mm', y = '0 mm' }, ply = 1 }]";

/// Mean force between two times, N.
fn mean(history: &[HistoryRow], from: f64, to: f64) -> f64 {
    let within: Vec<f64> = history.iter().filter(|r| (from..to).contains(&r.time_s)).map(force).collect();
    within.iter().sum::<f64>() / within.len() as f64
}

#[test]
#[ignore = "half a minute"]
fn the_reports_thin_plate_stiffens() {
    let on = case_5(MOVABLE, "membrane = 'on'", [5.0, 1.0], STRAIN);
    let off = case_5(MOVABLE, "membrane = 'off'", [10.0, 1.0], STRAIN);
    let held = case_5(IMMOVABLE, "membrane = 'on'\ndamage = 'off'", [4.5, 1.0], "criteria = ['tsai-wu']");
    let [linear, movable, immovable] = [&off, &on, &held].map(|outcome| peak(&outcome.history)[0]);
    // The estimates of the energy balance for an isotropic plate are 670 N, 2.2 kN and 3.5 kN.
    assert!((600.0..740.0).contains(&linear), "{linear}");
    assert!((2000.0..2400.0).contains(&movable), "{movable}");
    assert!((1.3 * movable..4000.0).contains(&immovable), "{immovable}");
    for outcome in [&on, &held] {
        assert!(outcome.energy_error < 1e-3, "{:e}", outcome.energy_error);
        assert!(outcome.counters.iterations > outcome.counters.steps);
    }
    // The report sees linear theory part from its tests after about 1 ms.
    let apart =
        |from: f64, to: f64| mean(&on.history, from * 1e-3, to * 1e-3) / mean(&off.history, from * 1e-3, to * 1e-3);
    assert!(apart(0.05, 0.2) < 1.05, "{}", apart(0.05, 0.2));
    assert!((1.3..2.0).contains(&apart(0.8, 1.2)), "{}", apart(0.8, 1.2));
    let strain = |outcome: &Outcome, t: f64| {
        let history = &outcome.histories[0];
        history.indices[history.times.iter().position(|at| *at >= t - 1e-9).unwrap()]
    };
    let [early, late] = [4e-5, 1e-3].map(|t| strain(&on, t) / strain(&off, t));
    assert!((early - 1.0).abs() < 0.03 && late > 1.1, "{early} {late}");
}

/// A plate of 1 mm under a mass that bends it by some thicknesses.
fn heavy(effects: &'static str) -> Struck {
    Struck {
        impactor: "mass = '0.2 kg', velocity = '2.5 m/s', patch_radius = '4 mm'",
        ..Struck::new(effects).march("integrator = 'newmark', step = '4 us', end = '1.2 ms'")
    }
}

#[test]
fn the_reduced_plate_is_the_full_one() {
    let full = Struck { reduction: "method = 'none'", ..heavy(ON) }.outcome();
    let reduced = Struck { reduction: "method = 'ritz', vectors = 60", ..heavy(ON) }.outcome();
    let deepest = full.history.iter().map(super::deflection).fold(0.0, f64::max);
    assert!(deepest > 1.5e-3, "{deepest}");
    assert!(difference(&full.history, &Struck { reduction: "method = 'none'", ..heavy(OFF) }.history(), force) > 0.3);
    for (value, most) in [(force as fn(&HistoryRow) -> f64, 1e-2), (super::deflection, 1e-3)] {
        let found = difference(&reduced.history, &full.history, value);
        assert!(found < most, "{found:e}");
    }
    for outcome in [full, reduced] {
        assert!(outcome.energy_error < 1e-3, "{:e}", outcome.energy_error);
    }
}

#[test]
fn small_deflections_are_linear() {
    for reduction in ["method = 'ritz', vectors = 30", "method = 'none'"] {
        let struck = |effects| Struck {
            impactor: "mass = '20 g', velocity = '0.02 m/s'",
            reduction,
            ..Struck::new(effects).march("integrator = 'newmark', step = '2 us', end = '400 us'")
        };
        let (on, off) = (struck(ON).history(), struck(OFF).history());
        let deepest = on.iter().map(super::deflection).fold(0.0, f64::max);
        assert!((3e-6..3e-5).contains(&deepest), "{deepest}");
        let found = difference(&on, &off, force);
        assert!(found > 0.0 && found < 1e-4, "{found:e}");
    }
}

#[test]
fn explicit_and_implicit_marches_agree() {
    let implicit = heavy(ON).march("integrator = 'newmark', step = '1 us', end = '1.2 ms'").history();
    let explicit = heavy(ON).march("integrator = 'rk4', step = '0.1 us', end = '1.2 ms'").history();
    let [implicit, explicit] = [&implicit, &explicit].map(|history| {
        [0.3e-3, 0.6e-3, 0.9e-3, 1.1e-3]
            .map(|t| history.iter().find(|row| row.time_s >= t - 1e-9).unwrap().impactors[0].plate_displacement_m)
    });
    for (i, e) in implicit.iter().zip(explicit) {
        assert!((i / e - 1.0).abs() < 2e-3, "{i} {e}");
    }
}

#[test]
fn a_march_goes_on_from_a_checkpoint() {
    for reduction in ["{ method = \"none\" }", "{ method = \"ritz\", vectors = 8 }"] {
        let until = |end: &str| -> Case {
            strip()
                .scene("velocity = \"1.56 m/s\"", "velocity = \"8 m/s\"")
                .scene("end = \"20 us\"", &format!("step = \"5 us\"\nend = \"{end}\""))
                .append(&format!(
                    "[effects]\nmembrane = \"on\"\n[reduction]\n{}\n",
                    reduction.trim_matches(['{', '}', ' ']).replace(", ", "\n")
                ))
        };
        let long = until("1 ms");
        long.fem("run", &["--out", "straight"]).good();
        let short = until("0.4 ms");
        short.fem("run", &["--out", "out"]).good();
        fs::rename(short.folder().join("out"), long.folder().join("out")).unwrap();
        long.fem("run", &["--out", "out", "--resume"]).good();
        assert_eq!(long.differing("straight", "out"), [""; 0]);
        assert!(long.summary("out")["work"]["newton_iterations"].as_u64().unwrap() > 200);
    }
}

#[test]
#[ignore = "minutes: Newton's method on the whole of the report's case 5"]
fn case_5_reduced_and_full() {
    let with = |reduction: &str| {
        let effects = format!("membrane = 'on'\ndamage = 'off'\n[reduction]\n{reduction}");
        case_5(MOVABLE, &effects, [5.0, 5.0], "criteria = ['tsai-wu']")
    };
    let (full, reduced) = (with("method = 'none'"), with("method = 'ritz'\nvectors = 60"));
    for (value, most) in [(force as fn(&HistoryRow) -> f64, 1e-2), (super::deflection, 1e-3)] {
        let found = difference(&reduced.history, &full.history, value);
        assert!(found < most, "{found:e}");
    }
    for outcome in [full, reduced] {
        assert!(outcome.energy_error < 1e-3, "{:e}", outcome.energy_error);
    }
}

/// A plate of three plies, clamped and struck until it deflects by its thickness.
fn stretched(element: &str, reduction: &str, more: &str) -> String {
    let layers = if element == "mitc4" { 1 } else { 3 };
    let edges = EDGES.map(|edge| edge.replace("at = 'all'\nfix = ['U10', 'U20', 'U30']", "kind = 'clamped'"));
    format!(
        "title = 'stresses'\nmesh = {{ rectangle = ['60 mm', '40 mm'], cells = [12, 8] }}\nsymmetry = 'quarter'\n\
         element = {{ kind = '{element}' }}\nreduction = {{ {reduction} }}\n{more}\n\
         impactor = {{ mass = '50 g', velocity = '4 m/s', at = {{ x = '30 mm', y = '20 mm' }} }}\n\
         contact = {{ law = 'hertz', k = '4e9 N/m^1.5' }}\nmarch = {{ step = '1 us', end = '0.25 ms' }}\n\
         effects = {{ {ON} }}\n\
         laminate = {{ plies = '[0/90/0]', material = 'tape', ply_thickness = '0.5 mm', layers = {layers}, interface = 'resin' }}\n\
         [materials.tape]\nlibrary = 'IM7/8552'\n[materials.resin]\nlibrary = '3502 resin'\n{}",
        edges.concat()
    )
}

#[test]
fn stresses_of_the_reduced_plate_are_those_of_the_full_one() {
    const OF_CELLS: &str = "failure = { criteria = ['max-stress'] }";
    const OF_WINDOWS: &str = "failure = { criteria = ['max-stress'], window = '7 mm', plies = 'mean' }";
    for (element, failure) in
        [("hermite-prism", OF_CELLS), ("hermite-prism", OF_WINDOWS), ("hex20", OF_WINDOWS), ("mitc4", OF_CELLS)]
    {
        let peaks = |reduction: &str| run(&stretched(element, reduction, failure), "").peaks;
        let (full, reduced) = (peaks("method = 'none'"), peaks("method = 'ritz', vectors = 60"));
        for (full, reduced) in full.iter().zip(&reduced) {
            assert_eq!(full.mode, reduced.mode);
            let (mode, full, reduced) = (full.mode, full.index, reduced.index);
            // Across the plate, where vectors have no thinning to take it back, half the square of a slope would be an index of 0.4.
            let apart = (full - reduced).abs();
            assert!(apart < 0.015 * full + 0.012, "{element}, {failure}, {mode}: {full} {reduced}");
        }
    }
}

#[test]
fn bounds_of_stretched_plates_leave_nothing_out() {
    let outcome = |watch: &str| {
        let failure = format!(
            "failure = {{ criteria = ['max-stress', 'hashin-1980', 'octahedral'], every = '1 us'{watch} }}\noutput = {{ maps = false, plots = false }}"
        );
        let scene = stretched("hermite-prism", "method = 'ritz', vectors = 60", &failure);
        run(&scene, "")
    };
    // What is followed at one place is judged at all of them.
    let (spared, all) = (outcome(""), outcome(", watch = [{ at = { x = '31 mm', y = '21 mm' }, ply = 1 }]"));
    let calls = [&spared, &all].map(|outcome| outcome.counters.criterion_calls);
    assert!(calls[0] * 4 < calls[1], "{calls:?}");
    assert!(!all.events.is_empty());
    assert_eq!(first_per_mode(&spared.events), first_per_mode(&all.events));
    for (spared, all) in spared.peaks.iter().zip(&all.peaks) {
        assert_eq!((&spared.mode, spared.index, spared.time, spared.site), (&all.mode, all.index, all.time, all.site));
    }
}

/// Products of slopes that the plate gives way to in its plane are no stretching: raw, they made indices of 2 to 17 times these.
#[test]
fn a_plate_that_can_draw_in_has_no_tension_of_its_own() {
    let peaks = |reduction: &str| {
        let scene = format!(
            "title = 'corner'\nmesh = {{ rectangle = ['60 mm', '60 mm'], cells = [8, 8] }}\nelement = {{ kind = 'mitc4' }}\n\
             reduction = {{ {reduction} }}\neffects = {{ {ON} }}\n\
             support = [{{ group = 'x-min', kind = 'clamped' }}, {{ group = 'y-min', kind = 'clamped' }}]\n\
             impactor = {{ mass = '20 g', velocity = '5 m/s', at = {{ x = '48 mm', y = '50 mm' }}, patch_radius = '3 mm' }}\n\
             contact = {{ law = 'hertz', k = '1e4 N/mm^1.5' }}\nmarch = {{ integrator = 'newmark', step = '2 us', end = '0.8 ms' }}\n\
             failure = {{ criteria = ['max-stress'], every = '10 us', window = 'element' }}\n\
             laminate = {{ plies = '[30/-45/60/0]', material = 'tape', ply_thickness = '0.12 mm', layers = 1 }}\n{TAPE}"
        );
        run(&scene, "").peaks
    };
    let (full, reduced) = (peaks("method = 'none'"), peaks("method = 'ritz', vectors = 60"));
    for (full, reduced) in full.iter().zip(&reduced) {
        let (mode, full, reduced) = (full.mode, full.index, reduced.index);
        assert!((full - reduced).abs() < 0.2 * full + 0.02, "{mode}: {full} {reduced}");
    }
}
