//! A scene uses the plug-in by its name; its restitution is the published one; errors stand with the line of the scene.

use fem::dynamics::integrate::Newmark;
use fem_core::contact::ContactLaw;
use fem_core::plugin::{Built, Params, Plugin};
use fem_core::testkit::Oscillators;
use plugin_contact_law::ElasticPlastic;
use std::path::Path;
use std::process::{Command, Output};

const YIELD: &str = "yield = \"5 um\"";

/// `fem COMMAND` in `folder` on the scene with another line for the yield.
fn fem(command: &str, yields: &str, folder: &Path, options: &[&str]) -> Output {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = std::fs::read_to_string(here.join("scene.toml")).unwrap();
    let mesh = here.join("../as4-3502-8ply-25mm/plate.msh").canonicalize().unwrap();
    let scene = scene.replace("../as4-3502-8ply-25mm/plate.msh", &mesh.to_string_lossy().replace('\\', "/"));
    assert_eq!(scene.matches(YIELD).count(), 1);
    let file = folder.join("scene.toml");
    std::fs::write(&file, scene.replace(YIELD, yields)).unwrap();
    let fem = Command::new(env!("CARGO_BIN_EXE_plugin-contact-law"))
        .arg(command)
        .arg(&file)
        .args(options)
        .current_dir(folder)
        .output();
    fem.unwrap()
}

/// Last row of the history: energy lost in the contact, velocity of the impactor and energy balance, by column.
fn last(yields: &str) -> [f64; 3] {
    let folder = tempfile::tempdir().unwrap();
    let run = fem("run", yields, folder.path(), &["--out", "results"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let history = std::fs::read_to_string(folder.path().join("results/history.csv")).unwrap();
    let rows: Vec<Vec<&str>> = history.lines().map(|line| line.split(',').collect()).collect();
    ["contact_dissipated_J", "impactor_velocity_m_s", "energy_balance_J"].map(|name| {
        let column = rows[0].iter().position(|c| *c == name).unwrap_or_else(|| panic!("{name}: {:?}", rows[0]));
        rows[rows.len() - 1][column].parse().unwrap()
    })
}

#[test]
fn a_contact_that_yields_takes_energy_from_the_rebound() {
    let [lost, velocity, balance] = last(YIELD);
    let [nothing, faster, _] = last("yield = \"1 mm\"");
    assert_eq!(nothing, 0.0);
    // Of 20 mJ.
    assert!(lost > 1e-4 && balance.abs() < 1e-4 * 0.02, "{lost} {balance}");
    assert!(faster < velocity && velocity < 0.0, "{faster} {velocity}");
}

/// Thornton's closed form of the rebound of a sphere from a rigid body, ρ = v_y/v:
/// e² = (6√3/5) (1 − ρ²/6) √(ρ/(ρ + 2 √((6 − ρ²)/5))).
#[test]
fn the_restitution_is_thorntons() {
    let law = ElasticPlastic { k: 1.0, yields: 1.0 };
    for speed in [1.5_f64, 3.0, 10.0] {
        let Ok(Built::Integrator(mut scheme)) = Newmark::build(&Params::default()) else { panic!() };
        // Of unit mass it yields from v_y²/2 = 2/5.
        let rho = 0.8_f64.sqrt() / speed;
        let mut sys = Oscillators::sphere(1.0, Box::new(law));
        let mut s = sys.state();
        s.v[0] = speed;
        scheme.start(&mut sys, &mut s).unwrap();
        while s.t < 0.01 || law.force(&s.histories.contacts[0], s.u[0]).force > 0.0 {
            scheme.step(&mut sys, &mut s, 1e-3).unwrap();
        }
        let square = 1.2 * 3.0_f64.sqrt() * (1.0 - rho * rho / 6.0);
        let e = (square * (rho / (rho + 2.0 * ((6.0 - rho * rho) / 5.0).sqrt())).sqrt()).sqrt();
        assert!((-s.v[0] / speed - e).abs() < 1e-5, "{speed}: {} {e}", -s.v[0] / speed);
    }
}

#[test]
fn wrong_parameters_are_shown_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    for (line, words) in [
        ("", "`yield`: is missing"),
        ("yield = \"5 MPa\"", "must be a quantity in m, above 0, got 5e6 Pa"),
        ("yield = \"-5 um\"", "must be a quantity in m, above 0, got -5e-6 m"),
        ("yields = \"5 um\"", "did you mean `yield`"),
    ] {
        let check = fem("check", line, folder.path(), &[]);
        let stderr = String::from_utf8(check.stderr).unwrap();
        assert_eq!(check.status.code(), Some(1), "{stderr}");
        let words_of_error = stderr.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words_of_error.contains(words), "{words}: {stderr}");
        assert!(stderr.contains(if line.is_empty() { "law = \"elastic-plastic\"" } else { line }), "{stderr}");
    }
}
