//! An effect that the program does not know, in the one file of an example: an elastic foundation.

// Public there, for its own main.
#[allow(unreachable_pub)]
#[path = "../../examples/plugin-effect/src/lib.rs"]
mod plugin;

use super::{Struck, deflection, said};
use crate::support::root;
use fem::analyses::{impact, statics};
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Model, Registry};
use plugin::Foundation;
use std::f64::consts::PI;
use std::num::NonZeroUsize;

fn registry() -> Registry {
    Registry::standard().with_effect::<Foundation>()
}

/// A square of aluminium, simply supported, 1 mm thick; side in mm, `load` and `effects` of a scene.
fn deflection_of(side: f64, cells: usize, load: &str, effects: &str) -> f64 {
    let edges = [("x-min", "U20"), ("x-max", "U20"), ("y-min", "U10"), ("y-max", "U10")];
    let supports =
        edges.map(|(group, along)| format!("[[support]]\ngroup = '{group}'\nat = 'all'\nfix = ['{along}', 'U30']\n"));
    let text = format!(
        "title = 'foundation'\nanalysis = 'static'\nmesh = {{ rectangle = ['{side} mm', '{side} mm'], cells = [{cells}, {cells}] }}\n\
         laminate = {{ plies = '[0]', material = 'm', ply_thickness = '1 mm', layers = 1 }}\nelement = {{ kind = 'mitc4' }}\n\
         materials.m = {{ e = '70 GPa', nu = 0.3, density = '2700 kg/m^3' }}\neffects = {{ damage = 'off', {effects} }}\nload = [{{ {load} }}]\n\
         support = [{{ restrain = 'rigid-motions' }}]\n"
    );
    let text = text.replace("support = [{ restrain = 'rigid-motions' }]\n", &supports.concat());
    let model = Model::new(scene::parse(&text, &root().join("scene.toml")).unwrap(), &registry()).unwrap();
    let solution = statics::solve(&model, NonZeroUsize::MIN).unwrap();
    let middle = (0..model.plate.columns.len()).min_by(|a, b| {
        let far = |c: usize| model.plate.columns[c].map(|x| (x - side * 5e-4).powi(2)).iter().sum::<f64>();
        far(*a).total_cmp(&far(*b))
    });
    let dof = fem::core::dof::Dof::new(3, 0).unwrap();
    let middle = middle.unwrap();
    let at = model.plate.dofs_at(middle, model.plate.outer_levels(middle)[0], dof).next().unwrap();
    -solution.u[at]
}

/// Bending stiffness of 1 mm of aluminium, N m.
const D: f64 = 70e9 * 1e-9 / 12.0 / 0.91;

/// Navier: a pressure sin(πx/a) sin(πy/a) deflects a plate by q/(4 π⁴D/a⁴), and by q/(4 π⁴D/a⁴ + k) on a foundation.
#[test]
fn a_foundation_carries_its_share_of_a_load() {
    let load = "pressure = { formula = \"sin(3.141592653589793*x/100)*sin(3.141592653589793*y/100)\", unit = 'kPa', length = 'mm' }, \
                face = 'top'";
    let plate = 4.0 * PI.powi(4) * D / 0.1_f64.powi(4);
    let free = deflection_of(100.0, 16, load, "cure = 'off'");
    let held = deflection_of(100.0, 16, load, &format!("foundation = '{plate} N/m^3'"));
    assert!((free * plate / 1e3 - 1.0).abs() < 1e-2, "{free:e}");
    assert!((free / held - 2.0).abs() < 1e-2, "{free:e} {held:e}");
}

/// Westergaard: a force P deflects an unbounded plate on a foundation by P/(8 √(kD)), and its reach is ℓ = (D/k)^(1/4).
#[test]
fn a_force_deflects_an_unbounded_plate_as_the_closed_form_says() {
    let (reach, side) = (0.01_f64, 100.0);
    let k = D / reach.powi(4);
    let load = "force = '10 N', at = { x = '50 mm', y = '50 mm' }, patch_radius = '1 mm'";
    let found = deflection_of(side, 40, load, &format!("foundation = '{k} N/m^3'"));
    let theory = 10.0 / (8.0 * (k * D).sqrt());
    assert!((found / theory - 1.0).abs() < 3e-2, "{found:e}, not {theory:e}");
}

/// The history of an impact on a foundation, and its energy error.
fn struck(reduction: &'static str, effects: &'static str) -> (Vec<HistoryRow>, f64) {
    let text = Struck { reduction, ..Struck::new(effects) }.text();
    let model = Model::new(scene::parse(&text, &root().join("scene.toml")).unwrap(), &registry()).unwrap();
    let columns: Vec<_> = model.effects.columns().map(|column| column.name).collect();
    assert_eq!(columns, if effects.is_empty() { vec![] } else { vec!["foundation_J"] });
    let outcome = impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
    assert_eq!(outcome.stopped, None);
    (outcome.history, outcome.energy_error)
}

#[test]
fn an_impact_keeps_account_of_the_foundation() {
    const SOFT: &str = "foundation = '5 N/mm^3'";
    let largest = |rows: &[HistoryRow], value: fn(&HistoryRow) -> f64| rows.iter().map(value).fold(0.0, f64::max);
    let (bare, _) = struck("method = 'ritz', vectors = 30", "");
    let (reduced, error) = struck("method = 'ritz', vectors = 30", SOFT);
    assert!(error < 1e-3, "{error:e}");
    assert!(largest(&reduced, deflection) < 0.9 * largest(&bare, deflection), "it is felt");
    // Part of the strain energy, never more.
    let share = |row: &HistoryRow| row.effects[0];
    assert!(reduced.iter().all(|row| share(row) >= 0.0 && share(row) <= row.plate_strain_j * (1.0 + 1e-9) + 1e-15));
    let (full, _) = struck("method = 'none'", SOFT);
    let peaks = [&reduced, &full].map(|rows| largest(rows, |row| row.effects[0]));
    assert!(peaks[0] > 1e-4 && (peaks[0] / peaks[1] - 1.0).abs() < 1e-2, "{peaks:?}");
}

#[test]
fn what_it_excludes_is_refused_at_its_key() {
    let refused = |more: &str| {
        let text = Struck::new("foundation = '5 N/mm^3', cure = 'off'").text().replace("cure = 'off'", more);
        let scene = scene::parse(&text, &root().join("scene.toml")).unwrap();
        said(Model::new(scene, &registry()).expect_err(more))
    };
    let membrane = refused("membrane = 'on'");
    assert!(membrane.contains("forces of large deflections") && membrane.contains("leave one of"), "{membrane}");
    let unknown = refused("fundation = '1 N/mm^3'");
    assert!(
        unknown.contains("unknown key `effects.fundation`") && unknown.contains("did you mean `foundation`"),
        "{unknown}"
    );
    let unit = refused("gravity = '1 N/mm^3'");
    assert!(unit.contains("effects.gravity"), "{unit}");
}
