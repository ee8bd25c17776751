//! Plates that nothing holds: they fly on with what the impactor gives them.

use crate::support::{impact_of, plate};
use fem::analyses::modes;
use fem::io::scene::{self, Scene};
use fem::{Model, Registry};
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::path::Path;

const STEEL: &str = "materials.steel = { e = '210 GPa', nu = 0.3, density = '7.8 g/cm^3' }";

/// A block of steel of 20 x 20 x 10 mm that nothing holds, struck by a ball of `grams` at 1 m/s through a spring of `k` N/mm.
fn block(grams: f64, k: f64, x_mm: f64, element: &str, reduction: &str) -> String {
    format!(
        "title = 'block'\n{STEEL}\nmesh = {{ rectangle = ['20 mm', '20 mm'], cells = [4, 4] }}\n\
         laminate = {{ plies = '[0]', material = 'steel', ply_thickness = '10 mm', layers = [1] }}\n\
         element = {{ kind = '{element}' }}\nsupport = [{{ restrain = 'rigid-motions' }}]\n\
         impactor = {{ mass = '{grams} g', velocity = '1 m/s', at = {{ x = '{x_mm} mm', y = '10 mm' }} }}\n\
         contact = {{ law = 'linear', k = '{k} N/mm' }}\nmarch = {{ step = '1 us', end = '2 ms' }}\n\
         effects = {{ damage = 'off' }}\n{reduction}\n"
    )
}

fn parsed(text: &str) -> Scene {
    scene::parse(text, Path::new("scene.toml")).unwrap()
}

/// Two bodies and a spring between them: F = V √(k μ) sin(√(k/μ) t), 1/μ = 1/M + 1/m + d²/I, I that of the block about its
/// centre; both part with the relative velocity with which they met.
#[test]
fn a_block_recoils_as_a_rigid_body() {
    let (ball, mass) = (20e-3, 7800.0 * 20e-3 * 20e-3 * 10e-3);
    let k: f64 = 5e4;
    let reductions = [
        ("hermite-prism", "reduction = { method = 'ritz', vectors = 20 }"),
        ("hermite-prism", "reduction = { method = 'ritz', vectors = 20, space = 'krylov' }"),
        ("hermite-prism", "reduction = { method = 'craig-bampton', modes = 12 }"),
        ("hermite-prism", "reduction = { method = 'modal', modes = 12 }"),
        ("hermite-prism", "reduction = { method = 'guyan', governors = 12 }"),
        ("hermite-prism", "reduction = { method = 'none' }"),
        ("mitc4", "reduction = { method = 'ritz', vectors = 20 }"),
        ("mitc4", "reduction = { method = 'none' }"),
        ("hex20", ""),
    ];
    for (element, reduction) in reductions {
        for offset in [0.0, 5e-3] {
            // mitc4 leaves out the inertia of rotation of sections that are not thin.
            let inertia = mass * (20e-3_f64.powi(2) + 10e-3_f64.powi(2)) / 12.0;
            let mobility = 1.0 / mass + offset * offset / inertia;
            let reduced = 1.0 / (1.0 / ball + mobility);
            let scene = block(20.0, k * 1e-3, 10.0 + 1e3 * offset, element, reduction);
            let (_, found) = impact_of(parsed(&scene)).unwrap();
            let one = &found.summary.impact[0];
            let case = format!("{element}, {reduction}, {offset} m");
            let peak = (k * reduced).sqrt();
            assert!((one.peak_force_N / peak - 1.0).abs() < 5e-3, "{case}: {} for {peak} N", one.peak_force_N);
            let impulse = 2.0 * reduced;
            assert!((one.impulse_N_s / impulse - 1.0).abs() < 2e-3, "{case}: {} for {impulse} N s", one.impulse_N_s);
            let end = PI * (reduced / k).sqrt();
            assert!((one.peak_force_time_s / (0.5 * end) - 1.0).abs() < 2e-2, "{case}: {}", one.peak_force_time_s);
            let plate = impulse * impulse * mobility / 2.0;
            let kinetic = found.outcome.history.last().unwrap().plate_kinetic_j;
            assert!((kinetic / plate - 1.0).abs() < 5e-3, "{case}: {kinetic} for {plate} J");
        }
    }
}

const TAPE: &str = "materials.tape = { library = 'AS4/3502' }";

/// A strip of two plies, which is not symmetric about its middle, on a line across it.
fn strip(plies: &str, analysis: &str, more: &str) -> String {
    format!(
        "title = 'strip'\n{TAPE}\n{analysis}\nmesh = {{ rectangle = ['40 mm', '20 mm'], cells = [6, 4] }}\n\
         laminate = {{ plies = '{plies}', material = 'tape', ply_thickness = '0.5 mm', layers = [2] }}\n\
         effects = {{ damage = 'off' }}\n{more}\n"
    )
}

/// Natural frequencies of a plate that is nowhere held, but for those of its motion as a whole.
#[test]
fn a_restraint_adds_no_modes() {
    let found = |support: &str, count: usize| {
        let scene = strip("[0/45]", "analysis = 'modes'", &format!("modes = {{ count = {count} }}\n{support}"));
        let model = Model::new(parsed(&scene), &Registry::standard()).unwrap();
        modes::solve(&model, count, NonZeroUsize::MIN).unwrap().modes.omega
    };
    let (free, restrained) = (found("", 10), found("support = [{ restrain = 'rigid-motions' }]", 4));
    assert_eq!(free[..6], [0.0; 6]);
    for (a, b) in free[6..].iter().zip(&restrained) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
    // What holds the strip along z leaves three motions in its plane free.
    let held = "{ group = 'x-min', at = 'bottom', fix = ['U30'] }, { group = 'x-max', at = 'bottom', fix = ['U30'] }";
    let free = found(&format!("support = [{held}]"), 5);
    assert!(free[..3] == [0.0; 3] && free[3] > 1.0, "{free:?}");
    let restrained = found(&format!("support = [{held}, {{ restrain = 'rigid-motions' }}]"), 2);
    assert!((free[3] / restrained[0] - 1.0).abs() < 1e-9, "{free:?} {restrained:?}");
}

/// The mirror image of an impact on a laminate that couples bending and stretching is the same impact.
#[test]
fn the_mirror_image_of_an_unsymmetric_plate_feels_the_same() {
    let force = |plies: &str, y: f64, reduction: &str| {
        let impact = format!(
            "impactor = {{ mass = '2 g', velocity = '3 m/s', at = {{ x = '13 mm', y = '{y} mm' }} }}\n\
             contact = {{ law = 'hertz', k = '1e4 N/mm^1.5' }}\nmarch = {{ step = '0.5 us', end = '150 us' }}\n{reduction}\n\
             support = [{{ group = 'x-min', at = 'bottom', fix = ['U30'] }}, \
             {{ group = 'x-max', at = 'bottom', fix = ['U30'] }}, {{ restrain = 'rigid-motions' }}]\n"
        );
        let (_, found) = impact_of(parsed(&strip(plies, "", &impact))).unwrap();
        found.outcome.history.iter().map(|row| row.contact_force_n()).collect::<Vec<_>>()
    };
    for (reduction, bound) in [("reduction = { method = 'none' }", 1e-9), ("", 1e-6)] {
        let (one, other) = (force("[0/45]", 7.0, reduction), force("[0/-45]", 13.0, reduction));
        let peak = one.iter().fold(0.0_f64, |m, f| m.max(*f));
        assert!(peak > 20.0, "{peak}");
        for (a, b) in one.iter().zip(&other) {
            assert!((a - b).abs() < bound * peak, "{reduction}: {a} {b} of {peak}");
        }
    }
}

#[test]
fn loads_that_only_a_restraint_would_carry_are_refused() {
    let refused = |scene: &str, words: &[&str]| {
        let model = Model::new(parsed(scene), &Registry::standard());
        let why = match model {
            Err(why) => format!("{:?}", miette::Report::from(why)),
            Ok(model) => {
                let found = fem::analyses::impact::prepare(&model, NonZeroUsize::MIN);
                format!("{:?}", miette::Report::from(found.err().unwrap()))
            }
        };
        let why = why.split_whitespace().collect::<Vec<_>>().join(" ");
        words.iter().for_each(|word| assert!(why.contains(word), "{word}: {why}"));
    };
    let support = "support = [{ restrain = 'rigid-motions' }]\n";
    let pressed =
        strip("[0/45]", "analysis = 'static'", &format!("{support}load = [{{ pressure = '1 kPa', face = 'top' }}]"));
    refused(&pressed, &["translation along z", "balance the loads"]);
    let struck = block(20.0, 50.0, 10.0, "hermite-prism", "");
    refused(&struck.replace("damage = 'off'", "damage = 'off', inertia = 'off'"), &["the impactor pushes", "inertia"]);
    refused(&struck.replace("damage = 'off'", "damage = 'off', gravity = '9.81 m/s^2'"), &["its weight pushes"]);
}

#[test]
fn what_no_impact_can_be_is_refused() {
    let line = "at = \"mid-plane\"\nfix = [\"U30\"]";
    for (from, to, words) in [
        ("[\"hashin-report\", \"octahedral\"]", "[\"tsai-hill\"]", "out_of_plane"),
        ("ply_thickness = \"0.13208 mm\"", "ply_thickness = \"132.08 mm\"", "2.113 m thick"),
        ("velocity = \"1.56 m/s\"", "velocity = \"15.6 km/s\"", "no impact at low velocity"),
        (line, &format!("{line}\n[[support]]\ngroup = \"impact\"\n{line}"), "exactly where the impactor strikes"),
    ] {
        let case = plate().scene(from, to);
        let done = case.fem("check", &[]);
        assert!(done.status != 0 && done.stderr.contains(words), "{to}: {done:#?}");
    }
    for threads in ["18446744073709551615", "100000000", "0"] {
        let done = plate().fem("run", &["--threads", threads]);
        assert!(done.status == 2 && done.stderr.contains("from 1 to 4096"), "{done:#?}");
    }
}
