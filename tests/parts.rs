//! Steps that are divided by an estimate of their error.

use crate::support::{Case, plate};
use serde_json::Value;

/// A shell of 16 plies under an impactor of so many grams at 2 m/s.
pub(crate) fn struck(grams: u32, support: &str, march: &str, more: &str) -> Case {
    plate().text(&format!(
        "title = 'parts'\nmesh = {{ plate = {{ sides = ['80 mm', '60 mm'], size = '10 mm', edge_size = '10 mm' }} }}\n\
         materials.tape = {{ library = 'AS4/3502' }}\nelement = {{ kind = 'mitc4' }}\noutput = {{ plots = false }}\n\
         laminate = {{ plies = '[0/90/0/90]2s', material = 'tape', ply_thickness = '0.13208 mm', layers = 1 }}\n\
         support = [{{ group = 'edge', {support} }}, {{ restrain = 'rigid-motions' }}]\n\
         impactor = {{ mass = '{grams} g', velocity = '2 m/s', at = {{ x = '0 mm', y = '0 mm' }} }}\n\
         contact = {{ law = 'hertz', k = '1.07e5 N/mm^1.5' }}\nmarch = {{ {march} }}\n{more}\n"
    ))
}

fn summary(case: &Case) -> Value {
    case.fem("run", &["--out", "out"]).good();
    case.summary("out")
}

pub(crate) const CLAMPED: &str = "kind = 'clamped'";
const ELASTIC: &str = "effects = { damage = 'off' }";

/// Impacts of some 10 us, in steps of 50 us: what is between the steps is not missed.
#[test]
fn contacts_shorter_than_a_step_are_seen() {
    let of = |march: &str| summary(&struck(1, CLAMPED, march, ELASTIC));
    let long = of("end = '0.5 ms', step = '50 us', tolerance = 1e-4");
    let short = of("end = '0.5 ms', step = '0.1 us'");
    for key in ["peak_force_N", "peak_plate_displacement_m", "contact_time_s"] {
        let [long, short] = [&long, &short].map(|all| all["impact"][key].as_f64().unwrap());
        assert!((long / short - 1.0).abs() < 1e-2, "{key}: {long}, in short steps {short}");
    }
    assert_eq!(long["impact"]["contacts"], short["impact"]["contacts"]);
    assert!(long["cautions"].to_string().contains("miss what lies between"), "{}", long["cautions"]);
    let apart = of("end = 'separation', step = '50 us', tolerance = 1e-4");
    assert!(apart["impact"]["peak_force_N"].as_f64().unwrap() > 100.0);
}

/// A ball leaves a plate long before this has deflected most, and is struck again.
#[test]
fn a_plate_that_may_deflect_further_after_the_separation_is_told_of() {
    let of =
        |grams: u32, end: &str| summary(&struck(grams, CLAMPED, &format!("end = '{end}', step = '0.5 us'"), ELASTIC));
    let [early, late] = ["separation", "2 ms"].map(|end| of(1, end));
    let said = |run: &Value| run["cautions"].to_string().contains("it may strike the impactor again");
    assert!(said(&early) && !said(&late), "{early}");
    let deflection = |run: &Value| run["impact"]["peak_plate_displacement_m"].as_f64().unwrap();
    assert!(deflection(&late) > 1.3 * deflection(&early));
    assert!(!said(&of(200, "separation")));
}

/// Modes of high frequency have amplitudes far below any displacement that one would name as a tolerance: with one of 1e-12 m the force of
/// this example was 10 % too large, whatever the relative tolerance.
#[test]
fn error_control_knows_no_scale() {
    let case = Case::example("as4-3502-8ply-50mm");
    let of = |integrator: &str, step: &str| {
        let set = [format!("march.integrator={integrator}"), format!("march.step={step}")];
        let set = [&set[0], &set[1], "effects.damage=off", "output.plots=false"].map(|key| ["--set", key]).concat();
        case.fem("run", &[&["--out", integrator][..], &set].concat()).good();
        case.summary(integrator)["impact"]["peak_force_N"].as_f64().unwrap()
    };
    let (ours, fine) = (of("dormand-prince", "2"), of("rk4", "0.05"));
    assert!((ours / fine - 1.0).abs() < 3e-3, "{ours}, not {fine}");
}

/// More vectors than the impact excites modes: springs that only push still answer as they do without a reduction.
#[test]
fn many_vectors_keep_what_springs_answer() {
    let of = |reduction: &str| {
        let more = format!("{ELASTIC}\nreduction = {{ {reduction} }}");
        let march = "end = '0.5 ms', step = '0.1 us', integrator = 'energy-conserving'";
        summary(&struck(20, "kind = 'rest'", march, &more))["impact"]["peak_force_N"].as_f64().unwrap()
    };
    let full = of("method = 'none'");
    for vectors in [60, 130, 150] {
        let reduced = of(&format!("method = 'ritz', vectors = {vectors}"));
        assert!((reduced / full - 1.0).abs() < 5e-3, "{vectors}: {reduced}, not {full}");
    }
}

/// A plate that lies on foam all over: with springs at all nodes hardly any vector is left that is none of their answers.
#[test]
fn plates_on_foam_are_reduced() {
    let of = |reduction: &str| {
        let more = format!("{ELASTIC}\nreduction = {{ {reduction} }}");
        let march = "end = '0.2 ms', step = '0.2 us', integrator = 'energy-conserving'";
        let case = struck(20, "kind = 'rest', stiffness = '1 N/mm^3'", march, &more)
            .scene("group = 'edge'", "group = 'plate'");
        summary(&case)["impact"]["peak_force_N"].as_f64().unwrap()
    };
    let full = of("method = 'none'");
    for vectors in [20, 60] {
        let reduced = of(&format!("method = 'ritz', vectors = {vectors}"));
        assert!((reduced / full - 1.0).abs() < 5e-3, "{vectors}: {reduced}, not {full}");
    }
}

#[test]
fn windows_that_plies_with_laws_do_not_have_are_named() {
    let warned = |more: &str| {
        let case = struck(20, CLAMPED, "end = '50 us', step = '2 us'", more);
        case.fem("check", &[]).good().stdout.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let criteria = "failure = { criteria = ['hashin-1980'], every = '2 us', window = '2.54 mm' }";
    assert!(!warned(criteria).contains("failure.window"));
    let law =
        struck(20, CLAMPED, "end = '50 us', step = '2 us'", &format!("{criteria}\nreduction = {{ method = 'none' }}"))
            .scene("kind = 'mitc4'", "kind = 'hermite-prism'")
            .scene("'AS4/3502' }", "'AS4/3502', law = { name = 'hahn-tsai', alpha = '1e-16 1/MPa^3' } }")
            .fem("check", &[])
            .good()
            .stdout;
    let law = law.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(law.contains("not over the `failure.window` of 2.54 mm"), "{law}");
}
