//! What a run says of its own errors, against the errors.

use crate::parts::{CLAMPED, struck};
use crate::report::Computed;
use crate::support::{self, Case, fem, root, strip};
use fem::analyses::impact::{self, Accuracy, Checkpoint, March};
use fem::io::files::OutputDir;
use fem::io::scene;
use fem::{Model, Registry};
use serde_json::Value;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;

const PLATE: &str = "as4-3502-8ply-25mm";

/// The first 0.5 ms of a stiff plate by an integrator, with other keys; stresses are looked at in the end alone.
fn plate_by(integrator: &str, step: &str, keys: &str) -> Computed {
    let march = format!("integrator = \"{integrator}\"\nstep = \"{step}\"\nend = \"0.5 ms\"");
    let seldom = "criteria = [\"octahedral\"]\nevery = \"1 s\"\n[output]\nhistory_every = \"0.4 us\"";
    let edits = [("end = \"1 ms\"", march.as_str()), ("criteria = [\"hashin-report\", \"octahedral\"]", seldom)];
    Computed::example(PLATE, keys, &edits)
}

fn plate(step: &str, keys: &str) -> Computed {
    plate_by("newmark", step, keys)
}

fn small_mass(step: &str) -> Computed {
    let (step, seldom) = (format!("step = \"{step}\""), "every = \"1 s\"");
    let edits = [("step = \"0.1 us\"", step.as_str()), ("every = \"0.5 us\"", seldom)];
    Computed::example("im6-934-32ply-small-mass", "", &edits)
}

/// ‖F − F_ref‖/‖F_ref‖ at equal times.
fn error(run: &Computed, reference: &Computed) -> f64 {
    let rows = || run.outcome.history.iter().zip(&reference.outcome.history);
    assert!(rows().all(|(a, b)| (a.time_s - b.time_s).abs() < 1e-12) && rows().count() > 300);
    let difference: f64 = rows().map(|(a, b)| (a.contact_force_n() - b.contact_force_n()).powi(2)).sum();
    let size: f64 = rows().map(|(_, b)| b.contact_force_n().powi(2)).sum();
    (difference / size).sqrt()
}

/// What the summary says.
fn said(case: &Case) -> Value {
    let summary: Value = serde_json::from_str(&case.read("out/summary.json")).unwrap();
    summary["accuracy"].clone()
}

#[track_caller]
fn within(factor: f64, estimate: f64, truth: f64) {
    assert!((1.0 / factor..factor).contains(&(estimate / truth)), "{estimate:.3e} for {truth:.3e}");
}

#[test]
fn the_error_of_the_step_is_found_within_a_factor_of_three() {
    let (fine, run) = (plate("0.0125 us", ""), plate("0.1 us", ""));
    let step = run.outcome.accuracy.step.unwrap();
    within(3.0, step.error.force, error(&run, &fine));
    assert_eq!(step.compared, 2.0 * run.sizes.step);

    let run = small_mass("0.1 us");
    within(3.0, run.outcome.accuracy.step.unwrap().error.force, error(&run, &small_mass("0.0125 us")));
}

#[test]
fn the_error_of_divided_steps_is_found_within_a_factor_of_four() {
    let fine = plate("0.0125 us", "");
    // The first leaves steps of 0.2 us as they are, the last divides them.
    for tolerance in ["0.1", "1e-2", "1e-3"] {
        let run = plate_by(&format!("energy-conserving\"\ntolerance = {tolerance}\n#\""), "0.4 us", "");
        let (step, parts) = (run.outcome.accuracy.step.unwrap(), run.outcome.parts.unwrap());
        assert!(parts.count >= 2500 && parts.longest == 2e-7 && parts.shortest <= 2e-7, "{parts:?}");
        within(4.0, step.error.force, error(&run, &fine));
    }
}

#[test]
fn twice_an_unstable_step_is_not_tried() {
    let explicit = |step| plate_by("central-difference", step, "reduction = { method = \"ritz\", vectors = 40 }");
    let run = explicit("0.1 us");
    let (step, sizes) = (run.outcome.accuracy.step.unwrap(), run.sizes);
    assert!(sizes.step < sizes.longest_step && 2.0 * sizes.step > sizes.longest_step, "{sizes:?}");
    assert_eq!(step.compared, 0.5 * sizes.step);
    within(3.0, step.error.force, error(&run, &explicit("0.0125 us")));
}

#[test]
fn the_error_of_a_reduction_is_found_within_a_factor_of_six() {
    let full = plate("0.1 us", "reduction = { method = \"ritz\", vectors = 160, space = \"krylov\" }");
    for keys in [
        "reduction = { method = \"ritz\", vectors = 20 }",
        "reduction = { method = \"ritz\", vectors = 60 }",
        "reduction = { method = \"craig-bampton\", modes = 40 }",
        "reduction = { method = \"guyan\", governors = 40 }",
    ] {
        let run = plate("0.1 us", keys);
        let reduction = run.outcome.accuracy.reduction.unwrap();
        let (residual, truth) = (reduction.residual.unwrap(), error(&run, &full));
        let force = residual.force.unwrap();
        within(6.0, force, truth);
        assert!(residual.energy < force, "{keys}: the contact is stiffer than the plate");
        assert!(reduction.flexibility < 1e-9, "{keys} holds the static response: {:e}", reduction.flexibility);
    }
    let irs = plate("0.1 us", "reduction = { method = \"irs\", governors = 40 }");
    let flexibility = irs.sizes.static_stiffness / full.sizes.static_stiffness;
    let reduction = irs.outcome.accuracy.reduction.unwrap();
    assert!((reduction.flexibility - (1.0 / flexibility - 1.0).abs()).abs() < 1e-9, "{reduction:?}, {flexibility}");
    assert!(reduction.flexibility > 1e-4 && reduction.residual.unwrap().force.is_none(), "{reduction:?}");
}

#[test]
fn a_resumed_run_says_the_same() {
    let path = root().join("examples").join(PLATE).join("scene.toml");
    let model = Model::new(scene::read(&path).unwrap(), &Registry::standard()).unwrap();
    let prepared = || impact::prepare(&model, NonZeroUsize::MIN).unwrap();
    let straight = impact::march(impact::prepare(&model, NonZeroUsize::new(2).unwrap()).unwrap(), |_| {}).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let dir = OutputDir::create(folder.path().join("out")).unwrap();
    let mut march = March::start(prepared()).unwrap();
    for _ in 0..2001 {
        march.advance();
    }
    march.save(&dir).unwrap();
    let cut = march.finish();
    assert!(cut.counters.steps == 2001 && cut.accuracy == Accuracy::default(), "{:?}", cut.accuracy);
    let mut march = March::resume(prepared(), Checkpoint::read(dir.path(), &model).unwrap()).unwrap();
    while !march.done() {
        march.advance();
    }
    let resumed = march.finish();
    assert!(straight.accuracy.step.is_some() && straight.accuracy.reduction.is_some());
    assert_eq!(resumed.accuracy, straight.accuracy);
    assert_eq!(resumed.counters, straight.counters);
}

#[test]
fn nothing_is_said_that_is_not_known() {
    // Every unknown is marched, by a march that is all the run.
    let full = strip().append("[reduction]\nmethod = \"none\"\n").fem("run", &["--out", "out"]).good();
    assert!(full.stdout.contains("reduction: none, all unknowns are marched"), "{full:#?}");
    assert!(full.stdout.contains("step: error not estimated; a run with half the step would show it"), "{full:#?}");

    // The tolerance of an integrator that divides its steps decides, not their length.
    let divided = plate_by("dormand-prince", "0.4 us", "").outcome.accuracy;
    assert!(divided.step.is_none(), "{divided:?}");
}

/// A plate that is not reduced, and one under gravity, say what the reduced one without weight says: hardly anything of it is the reduction's.
#[test]
fn full_plates_and_weights_say_what_their_results_are_worth() {
    let said = |more: &str| {
        let case = strip().scene("end = \"20 us\"", "end = \"0.2 ms\"\nstep = \"0.2 us\"").append(more);
        case.fem("run", &["--out", "out"]).good();
        let accuracy = said(&case);
        ["force_history_L2", "impulse", "deflection"].map(|result| {
            let each = ["results", "results_of_mesh", "results_of_layers"];
            each.map(|of| accuracy[of][format!("{result}_relative")].as_f64().unwrap_or_else(|| panic!("{accuracy:#}")))
        })
    };
    let reduced = said("");
    let full = said("[reduction]\nmethod = \"none\"\n");
    for (reduced, full) in reduced.iter().flatten().zip(full.iter().flatten()) {
        assert!((0.5..2.0).contains(&(full / reduced)), "{full:.2e} for {reduced:.2e}");
    }
    let light = said("[effects]\ngravity = \"1e-6 m/s^2\"\n");
    for (none, light) in reduced.iter().flatten().zip(light.iter().flatten()) {
        assert!((light / none - 1.0).abs() < 1e-2, "{light:.4e} for {none:.4e}");
    }
}

/// Forces by the nanosecond at the rows of a run of `case` under `settings`, and what the summary says.
fn sampled(case: &Case, settings: &[&str]) -> (BTreeMap<i64, f64>, Value) {
    let set: Vec<&str> = settings.iter().flat_map(|key| ["--set", *key]).collect();
    case.fem("run", &[&["--out", "out"][..], &set].concat()).good();
    let (names, rows) = case.table("out/history.csv");
    let column = |name: &str| names.iter().position(|other| other == name).unwrap();
    let (time, force) = (column("time_s"), column("contact_force_N"));
    let number = |row: &Vec<String>, k: usize| row[k].parse::<f64>().unwrap();
    let each = rows.iter().map(|row| ((1e9 * number(row, time)).round() as i64, number(row, force)));
    (each.collect(), said(case))
}

/// ‖F − F_ref‖/‖F_ref‖ at the times that both have, nearly all of them.
fn apart(forces: &BTreeMap<i64, f64>, fine: &BTreeMap<i64, f64>) -> f64 {
    let shared: Vec<(f64, f64)> = forces.iter().filter_map(|(time, force)| Some((*force, *fine.get(time)?))).collect();
    assert!(shared.len() + 5 > forces.len(), "{} of {}", shared.len(), forces.len());
    let difference: f64 = shared.iter().map(|(a, b)| (a - b).powi(2)).sum();
    (difference / shared.iter().map(|(_, b)| b * b).sum::<f64>()).sqrt()
}

/// The template of a drop weight.
fn drop_weight() -> Case {
    let folder = tempfile::tempdir().unwrap();
    fem(folder.path(), &["new", "dw", "--template", "drop-weight"]).good();
    support::plate().text(&std::fs::read_to_string(folder.path().join("dw/scene.toml")).unwrap())
}

/// Steps that do not show the ripple of the force: what two of them differ by says nothing of a shorter one.
#[test]
fn long_steps_are_said_to_be_long() {
    let case = drop_weight();
    let of = |step: &str| {
        let step = format!("march.step={step}");
        sampled(&case, &[&step, "effects.damage=off", "output.plots=false", "output.history_every=32 us"])
    };
    let (fine, _) = of("0.5 us");
    for step in ["16 us", "4 us"] {
        let (forces, accuracy) = of(step);
        within(3.0, accuracy["step_error_force_L2_relative"].as_f64().unwrap(), apart(&forces, &fine));
    }
}

/// A plate that rattles on a frame: in steps that are long beside that a scheme that keeps what is too fast for them gains energy, and
/// the one that is taken where a scene names none does not.
#[test]
fn plates_that_rattle_are_marched_by_default() {
    let case = drop_weight();
    let rest = ["support.1.kind=rest", "support.1.at=bottom", "mesh.plate.size=3.6 mm", "march.end=1 ms"];
    let quiet = ["effects.damage=off", "output.plots=false", "output.history_every=4 us"];
    let of = |step| sampled(&case, &[&rest[..], &quiet, &[step]].concat());
    let (fine, _) = of("march.step=0.25 us");
    let (forces, accuracy) = of("march.step=2 us");
    assert!(apart(&forces, &fine) < 0.04, "{}", apart(&forces, &fine));
    within(3.0, accuracy["step_error_force_L2_relative"].as_f64().unwrap(), apart(&forces, &fine));

    let set = [&rest[..], &quiet, &["march.step=2 us", "march.integrator=newmark"]].concat();
    let set: Vec<&str> = set.iter().flat_map(|key| ["--set", *key]).collect();
    let stopped = case.fem("run", &[&["--out", "out"][..], &set].concat());
    assert!(stopped.status != 0 && stopped.stdout.contains("leave `march.integrator` out"), "{stopped:#?}");
}

/// Few vectors, of which those that join them by chance do nothing.
#[test]
fn few_vectors_are_said_to_be_few() {
    let case = struck(
        5,
        CLAMPED,
        "end = '0.3 ms', step = '0.5 us'",
        "effects = { damage = 'off' }\noutput.history_every = '1 us'",
    )
    .scene("output = { plots = false }", "output.plots = false");
    let of = |reduction: &str| sampled(&case, &[&format!("reduction={{ {reduction} }}"), "impactor.velocity=5"]);
    let (full, _) = of("method = \"none\"");
    for vectors in [8, 11, 12, 14, 16, 18] {
        let (forces, accuracy) = of(&format!("method = \"ritz\", vectors = {vectors}"));
        let told = accuracy["results_of_reduction"]["force_history_L2_relative"].as_f64().unwrap();
        within(6.0, told, apart(&forces, &full));
    }
}

/// An accuracy that is asked for where no reduction is to be had.
#[test]
fn full_plates_that_cannot_be_reduced_reach_an_accuracy() {
    let case = struck(
        50,
        CLAMPED,
        "end = '50 us', step = '1 us'",
        "effects = { damage = 'off' }\nreduction = { method = 'none' }",
    )
    .scene("impactor = {", "impactor = { tip_radius = '12 mm',");
    let done = case.fem("run", &["--out", "out", "--accuracy", "20%"]).good();
    assert!(done.stdout.contains("reached"), "{done:#?}");
}

/// A plate that rattles on a hard frame in steps that show it and in one that does not, reduced and as it is, and one under a tip.
#[test]
fn plates_that_lift_off_and_plates_under_tips_are_told_of_their_steps() {
    let run = |support: &str, impactor: &str, step: &str, more: &str| {
        let march = format!("end = '0.3 ms', integrator = 'energy-conserving', step = '{step}'");
        let more = format!("effects = {{ damage = 'off' }}\noutput.history_every = '0.5 us'\n{more}");
        let case = struck(20, support, &march, &more).scene("impactor = {", &format!("impactor = {{ {impactor}"));
        sampled(&case.scene("output = { plots = false }", "output.plots = false"), &[])
    };
    let (rest, full) = ("kind = 'rest'", "reduction = { method = 'none' }");
    let tip = "tip_radius = '12 mm', ";
    let reduced = "reduction = { method = 'ritz', vectors = 60 }";
    for (support, impactor, more, steps) in [
        (rest, "", reduced, ["0.5 us", "0.1 us"]),
        (rest, "", full, ["0.5 us", "0.1 us"]),
        (CLAMPED, tip, full, ["0.5 us", "0.25 us"]),
    ] {
        let (fine, _) = run(support, impactor, "0.025 us", more);
        for step in steps {
            let (forces, accuracy) = run(support, impactor, step, more);
            within(4.0, accuracy["step_error_force_L2_relative"].as_f64().unwrap(), apart(&forces, &fine));
            for of in ["results", "results_of_mesh", "results_of_layers"] {
                assert!(accuracy[of]["force_history_L2_relative"].as_f64().is_some(), "{of} {accuracy:#}");
            }
        }
    }
}

/// So small a plate, marched for so long, that a second march with twice the step would take as long as all the rest.
#[test]
fn a_march_that_is_all_the_run_is_compared_with_one_of_much_longer_steps() {
    let small = |step: &str| {
        let case = strip().scene("end = \"20 us\"", &format!("end = \"1 ms\"\nstep = \"{step}\""));
        let done = case.fem("run", &["--out", "out"]).good();
        let peak = case.summary("out")["impact"]["peak_force_N"].as_f64().unwrap();
        let impulse = case.summary("out")["impact"]["impulse_N_s"].as_f64().unwrap();
        (done.stdout, said(&case)["results_of_step"].clone(), [peak, impulse])
    };
    let ((text, errors, found), (.., exact)) = (small("0.1 us"), small("0.0125 us"));
    assert!(text.contains("(4 times the step changes it by "), "{text}");
    for (name, (found, exact)) in ["peak_force_relative", "impulse_relative"].iter().zip(found.iter().zip(exact)) {
        let (said, truth) = (errors[name].as_f64().unwrap(), (found / exact - 1.0).abs());
        assert!(said > 0.5 * truth && said < 0.1, "{name}: said {said:.1e}, true {truth:.1e}");
    }
}

#[test]
fn a_march_that_stops_has_no_estimates() {
    let case = strip().scene("end = \"20 us\"", "step = \"1 ms\"\nend = \"10 ms\"");
    let done = case.fem("run", &["--out", "out"]);
    assert!(done.status == 1 && done.stdout.contains("STOPPED"), "{done:#?}");
    assert!(done.stdout.contains("not estimated: the march has stopped"), "{done:#?}");
    let accuracy = said(&case);
    assert_eq!(accuracy.as_object().unwrap().len(), 2, "{accuracy}");
}
