//! Gravity on impactors and plate.

use super::{EDGES, Struck, TAPE, deflection, difference, force, said};
use crate::support::{root, strip};
use fem::analyses::statics;
use fem::core::dof::Dof;
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Error, Model, Registry};
use std::num::NonZeroUsize;

const LINEAR: &str = "law = 'linear', k = '2e3 N/mm'";

#[test]
fn an_impactor_falls_freely_before_it_touches() {
    let struck = Struck {
        impactor: "mass = '20 g', velocity = '0.1 m/s', start = '200 us'",
        ..Struck::new("gravity = '500 m/s^2'").march("integrator = 'newmark', step = '0.5 us', end = '300 us'")
    };
    for integrator in ["newmark", "rk4", "central-difference"] {
        let march = format!("integrator = '{integrator}', step = '0.1 us', end = '300 us'");
        let outcome = Struck { reduction: "method = 'ritz', vectors = 12", ..struck.clone().march(&march) }.outcome();
        let fall = |t: f64| 0.1 * t + 0.5 * 500.0 * t * t;
        let touch = fall(200e-6);
        for row in outcome.history.iter().filter(|row| row.time_s < 199.9e-6) {
            let [z, v] = [row.impactors[0].impactor_displacement_m, row.impactors[0].impactor_velocity_m_s];
            assert!((z + touch - fall(row.time_s)).abs() < 1e-12 * touch, "{integrator}: {z:e} at {}", row.time_s);
            assert!((v - 0.1 - 500.0 * row.time_s).abs() < 1e-12);
            assert_eq!((deflection(row), force(row)), (0.0, 0.0), "the sag is where the plate rests");
        }
        let potential = outcome.history[0].effects[0];
        assert!((potential / (0.02 * 500.0 * touch) - 1.0).abs() < 1e-12, "{potential:e}");
        assert!(outcome.history.iter().any(|row| force(row) > 0.0));
        assert!(outcome.energy_error < 1e-3, "{integrator}: {:e}", outcome.energy_error);
    }
}

/// m z̈ = m g − k z: F = m g (1 − cos ω t) + v √(k m) sin ω t as long as it presses.
fn two_springs(history: &[HistoryRow], [m, v, g, k]: [f64; 4]) -> Vec<HistoryRow> {
    let omega = (k / m).sqrt();
    let mut history = history.to_vec();
    for row in &mut history {
        let (sin, cos) = (omega * row.time_s).sin_cos();
        row.impactors[0].contact_force_n = (m * g * (1.0 - cos) + v * (k * m).sqrt() * sin).max(0.0);
    }
    history
}

#[test]
fn a_mass_that_is_laid_down_swings_about_its_rest() {
    let laid = Struck {
        impactor: "mass = '2 kg', velocity = '1e-6 m/s'",
        contact: LINEAR,
        ..Struck::new("inertia = 'off', gravity = '9.81 m/s^2'")
            .march("integrator = 'newmark', step = '2 us', end = '50 ms'")
    };
    let (sizes, outcome) = laid.run().unwrap();
    let k = 2e6 * sizes.static_stiffness / (2e6 + sizes.static_stiffness);
    let found = difference(&outcome.history, &two_springs(&outcome.history, [2.0, 1e-6, 9.81, k]), force);
    assert!(found < 1e-4, "{found:e}");
    let deepest = outcome.history.iter().map(|row| row.impactors[0].impactor_displacement_m).fold(0.0, f64::max);
    assert!((deepest / (2.0 * 2.0 * 9.81 / k) - 1.0).abs() < 1e-4, "{deepest:e}");
    assert!(outcome.energy_error < 1e-3, "{:e}", outcome.energy_error);
}

#[test]
fn weight_adds_to_the_force_of_a_drop_weight() {
    let (m, v, g) = (20.0, 0.05, 9.81);
    let run = |effects| {
        let impactor = "mass = '20 kg', velocity = '0.05 m/s'";
        let march = "integrator = 'newmark', step = '5 us', end = '60 ms'";
        Struck { impactor, contact: LINEAR, ..Struck::new(effects).march(march) }.run().unwrap()
    };
    let peak = |history: &[HistoryRow]| history.iter().map(force).fold(0.0, f64::max);
    let ((sizes, off), (_, on)) = (run(""), run("gravity = '9.81 m/s^2'"));
    let k = 2e6 * sizes.static_stiffness / (2e6 + sizes.static_stiffness);
    let [without, with] = [v * (k * m).sqrt(), m * g + (m * m * g * g + v * v * k * m).sqrt()];
    assert!(with > 1.5 * without, "{with} {without}");
    // The plate has inertia here, the closed form none: what it takes at the touch swings in the contact.
    let ripple = v * (2e6 * 1575.0 * 0.06 * 0.04 * 1e-3_f64).sqrt();
    assert!(ripple < 0.1 * without);
    for (outcome, want) in [(off, without), (on, with)] {
        let found = peak(&outcome.history);
        assert!((found - want).abs() < ripple, "{found} N, {want} N");
        assert!(outcome.energy_error < 1e-3, "{:e}", outcome.energy_error);
    }
}

/// A static scene of the same plate under its weight, with more at its beginning.
fn at_rest(more: &str) -> Result<Model, Error> {
    let text = format!(
        "{more}\ntitle = 'weight'\nanalysis = 'static'\nmesh = {{ rectangle = ['60 mm', '40 mm'], cells = [12, 8] }}\n\
         element = {{ kind = 'mitc4' }}\nload = [{{ gravity = ['0 m/s^2', '0 m/s^2', '-1e6 m/s^2'] }}]\n\
         failure = {{ criteria = ['max-stress'] }}\n\
         laminate = {{ plies = '[0/90/90/0]', material = 'tape', ply_thickness = '0.25 mm', layers = 1 }}\n{TAPE}{}",
        EDGES.concat()
    );
    Model::new(scene::parse(&text, &root().join("scene.toml"))?, &Registry::standard())
}

#[test]
fn the_plate_sags_as_at_rest() {
    let model = at_rest("").unwrap();
    let solution = statics::solve(&model, NonZeroUsize::MIN).unwrap();
    let reserve = solution.margins.iter().map(|margin| margin.reserve_factor).fold(f64::INFINITY, f64::min);
    let u = solution.u;
    let column = model.plate.columns.iter().position(|c| (c[0] - 0.03).hypot(c[1] - 0.02) < 1e-9).unwrap();
    let level = model.plate.mid_level().unwrap_or(0);
    let want = -u[model.plate.dofs_at(column, level, Dof::new(3, 0).unwrap()).next().unwrap()];
    assert!(want > 1e-6, "{want:e}");
    for reduction in ["method = 'none'", "method = 'ritz', vectors = 5", "method = 'modal', modes = 3"] {
        let struck = Struck {
            damage: "onset",
            impactor: "mass = '1 g', velocity = '1 m/s', load = 'node', start = '3.9 us'",
            reduction,
            more: "[failure]\ncriteria = ['max-stress']\nevery = '10 us'\nwindow = 'element'\n",
            ..Struck::new("gravity = '1e6 m/s^2'").march("integrator = 'newmark', step = '0.5 us', end = '4 us'")
        };
        let outcome = struck.outcome();
        let [("plate_sag_m", sag)] = outcome.quantities[..] else { panic!("{:?}", outcome.quantities) };
        assert!((sag / want - 1.0).abs() < 1e-9, "{reduction}: {sag:e}, not {want:e}");
        let index = outcome.peaks.iter().map(|peak| peak.index).fold(0.0, f64::max);
        assert!((index * reserve - 1.0).abs() < 1e-6, "{reduction}: {index}, not {}", 1.0 / reserve);
        assert!(outcome.history.iter().take(7).all(|row| deflection(row) == 0.0 && row.plate_kinetic_j == 0.0));
    }
}

#[test]
fn resumed_it_is_the_same() {
    let until = |end: &str| {
        let scene = strip().scene("end = \"20 us\"", &format!("end = \"{end}\""));
        scene.append("[output]\nhistory_every = \"1 us\"\n[effects]\ngravity = \"1e4 m/s^2\"\n")
    };
    let (short, long) = (until("20.5 us"), until("61.5 us"));
    long.fem("run", &["--out", "straight"]).good();
    short.fem("run", &["--out", "out"]).good();
    std::fs::rename(short.folder().join("out"), long.folder().join("out")).unwrap();
    long.fem("run", &["--out", "out", "--resume"]).good();
    assert_eq!(long.differing("straight", "out"), [""; 0]);
    assert!(long.summary("out")["model"]["plate_sag_m"].as_f64().unwrap() > 0.0);
    assert!(long.table("out/history.csv").0.contains(&"gravity_potential_J".to_owned()));
}

#[test]
fn refusals_help() {
    Struck::new("gravity = 'on'").refused(&["does not begin with a number", "m/s^2"]);
    Struck::new("gravity = '9.81 m/s'").refused(&["is a velocity, not an acceleration"]);
    Struck::new("gravity = '-9.81 m/s^2'").refused(&["must be positive"]);
    Struck { more: "[substructures]\ncells = [4, 4]\n", ..Struck::new("gravity = '9.81 m/s^2'") }
        .refused(&["gravity is not carried", "leave one of `substructures`"]);
    for effects in
        ["gravity = '9.81 m/s^2'", "damping = { ratio = 0.02 }", "inertia = 'off'", "delamination = 'threshold'"]
    {
        let said = said(at_rest(&format!("effects = {{ {effects} }}")).expect_err(effects));
        let expected =
            if effects.starts_with("delamination") { "no material gives the toughness" } else { "needs an impact" };
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn falling_takes_no_energy() {
    let scene =
        strip().scene("velocity =", "start = \"59.99 us\"\nvelocity =").scene("end = \"20 us\"", "end = \"60 us\"");
    let scene = scene.append("[effects]\ngravity = \"1e4 m/s^2\"\n");
    scene.fem("run", &["--out", "out"]).good();
    let impact = &scene.summary("out")["impact"];
    let number = |key: &str| impact[key].as_f64().unwrap();
    let [before, after] = ["velocity_m_s", "final_impactor_velocity_m_s"].map(number);
    assert!(after > 1.1 * before, "{impact:#}");
    assert!(number("absorbed_energy_J").abs() < 1e-9 * number("energy_J"), "{impact:#}");
}
