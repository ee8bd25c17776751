//! Steps that are none, and scenes that do not say how laminates lie.

use super::{mesh, refusal};

fn scene(laminate: &str, rest: &str) -> String {
    format!(
        "title = 'steps'\nmesh = {{ file = 'plate.msh', unit = 'mm' }}\nelement = {{ kind = 'hermite-prism' }}\n\
         materials.tape = {{ library = 'AS4/3502' }}\nlaminate = [{laminate}]\n\
         support = [{{ group = 'x-min', kind = 'clamped' }}]\n{rest}"
    )
}

const LOAD: &str = "analysis = 'static'\neffects = { damage = 'off' }\nload = [{ pressure = '1 kPa' }]\n";
const THIN: &str = "plies = '[0/90]s', material = 'tape', ply_thickness = '0.25 mm'";
const THICK: &str = "group = 'thick', plies = '[0/90]2s', material = 'tape', ply_thickness = '0.25 mm'";

#[track_caller]
fn refused(laminate: &str, rest: &str, words: &[&str]) {
    let thick = |p: [f64; 2]| p[0] < 10e-3;
    let all: Vec<f64> = (0..=8).map(|i| 2.5 * f64::from(i)).collect();
    let said = refusal(&scene(laminate, rest), mesh(&all, &[0.0, 2.5, 5.0, 7.5, 10.0], &[("thick", &thick)]));
    words.iter().for_each(|words| assert!(said.contains(words), "{words:?}: {said}"));
}

#[test]
fn steps_that_do_not_fit_are_refused() {
    let with = |more: &str| format!("{{ {THIN} }}, {{ {more}{THICK} }}");
    refused(&with(""), LOAD, &["1.000000 and 2.000000 mm thick", "nothing says how one lies", "align = \"bottom\""]);
    refused(&with("align = 'botom', "), LOAD, &["botom", "bottom"]);
    refused(&with("align = 'top', offset = '1 mm', "), LOAD, &["both say where the laminate lies"]);
    refused(
        &format!("{{ align = 'top', {THIN} }}, {{ {THICK} }}"),
        LOAD,
        &["heights count from the mid-plane of this laminate"],
    );
    refused(&with("offset = '1.5 mm', "), LOAD, &["faces of a step do not touch", "`thick`", "z = 0.5 mm to 2.5 mm"]);
    refused(&with("offset = '-4 mm', "), LOAD, &["faces of a step do not touch"]);
    // A face in the middle of a ply.
    refused(
        &with("offset = '0.625 mm', "),
        LOAD,
        &["end inside ply 1 of `rest`", "0.125 mm above its lower face", "write this ply as two"],
    );
}

#[test]
fn what_steps_do_not_go_with_is_refused_by_name() {
    let plate = format!("{{ {THIN} }}, {{ align = 'bottom', {THICK} }}");
    let preload = "analysis = 'static'\neffects = { damage = 'off', preload = [{ group = 'x-max', force = '-1 N/mm' }] }\n\
                   load = [{ pressure = '1 kPa' }]\n";
    refused(
        &plate,
        preload,
        &["bends a plate whose regions have their mid-planes at different heights", "align = \"middle\""],
    );
    let patch = "effects = { damage = 'off' }\n\
                 impactor = { mass = '1 g', velocity = '1 m/s', at = { x = '10 mm', y = '5 mm' }, patch_radius = '1 mm' }\n\
                 contact = { law = 'hertz', k = '1e8 N/m^1.5' }\nmarch = { step = '1 us', end = '5 us' }\n";
    refused(&plate, patch, &["reaches over a step of 1 mm in the face", "move it off the step"]);
    let ply = patch.replace("x = '10 mm'", "x = '4 mm'").replace("'off' }", "'onset' }")
        + "failure = { criteria = ['hashin-report'], watch = [{ at = { x = '16 mm', y = '5 mm' }, ply = 5 }] }\n";
    refused(&plate, &ply, &["the laminate has 4 plies"]);
}

/// From below the face is plane, whatever lies above.
#[test]
fn the_side_without_a_step_can_be_struck_under_it() {
    let thick = |p: [f64; 2]| p[0] < 10e-3;
    let all: Vec<f64> = (0..=8).map(|i| 2.5 * f64::from(i)).collect();
    let rest = "effects = { damage = 'off' }\n\
                impactor = { mass = '1 g', velocity = '1 m/s', face = 'bottom', at = { x = '10 mm', y = '5 mm' }, patch_radius = '1 mm' }\n\
                contact = { law = 'hertz', k = '1e8 N/m^1.5' }\nmarch = { step = '1 us', end = '5 us' }\n";
    let text = scene(&format!("{{ {THIN} }}, {{ align = 'bottom', {THICK} }}"), rest);
    super::case(&text, mesh(&all, &[0.0, 2.5, 5.0, 7.5, 10.0], &[("thick", &thick)]))
        .fem("run", &["--out", "out"])
        .good();
}
