//! What the advisor predicts against runs that leave nothing out.

use super::impact::{on_steel, on_ten_plies};
use crate::advise::{CLAMPED_ALL, Square, advice, computed, karas, sun_and_chen};
use fem::advise::Regime;

/// What a run found: the largest force, N, and deflection under the impactor, m.
#[derive(Debug, Clone, Copy)]
struct Run {
    force: f64,
    deflection: f64,
}

/// Runs a plate as it is; `effects: ", membrane = 'on'"` has it stiffen as it deflects.
fn run(plate: &Square) -> Run {
    let rows = computed(&plate.text()).2.history;
    let largest = |of: &dyn Fn(&fem::io::tables::HistoryRow) -> f64| rows.iter().map(of).fold(0.0, f64::max);
    Run {
        force: largest(&|row| row.contact_force_n()),
        deflection: largest(&|row| row.impactors[0].plate_displacement_m),
    }
}

/// A mass on a sheet of steel that stays linear.
fn heavy(impactor: &'static str, end: f64) -> Square {
    Square { side_mm: 100.0, cells: 16, ply_mm: 2.0, impactor, k: 1e9, step: 1.0, end, ..karas() }
}

/// Heavier and heavier: the run comes to the force without inertia, nearer than the advisor promises.
#[test]
fn a_large_mass_is_quasi_static() {
    let mut last = f64::INFINITY;
    for (impactor, end) in [
        ("mass = '1 kg'\nvelocity = '0.2 m/s'", 3000.0),
        ("mass = '10 kg'\nvelocity = '0.06 m/s'", 9000.0),
        ("mass = '100 kg'\nvelocity = '0.02 m/s'", 28000.0),
    ] {
        let plate = heavy(impactor, end);
        let (advice, run) = (advice(&plate.text()), run(&plate));
        let estimate = advice.estimate;
        assert_eq!(estimate.regime, Regime::QuasiStatic);
        let error = (run.force / estimate.linear.force - 1.0).abs();
        assert!(error < estimate.inertia_error(), "{error} {advice}");
        assert!(estimate.inertia_error() < last, "{advice}");
        last = estimate.inertia_error();
    }
}

/// Plates that shear give way more than Kirchhoff's: Navier's series of first-order theory lie 3 to 4 % (steel) and 6 to 7 %
/// (laminate) below those of the latter.
#[test]
fn a_small_mass_sees_an_infinite_plate() {
    for (plate, strike, yields) in [(karas(), on_steel(), -0.035), (sun_and_chen(), on_ten_plies(), -0.065)] {
        let estimate = advice(&plate.text()).estimate;
        let error = strike.peak() / estimate.force() - 1.0;
        assert!((error - yields).abs() < 0.01, "{error}");
    }
}

#[test]
fn supports_do_not_matter_to_a_small_mass() {
    let coarse = || Square { cells: 24, end: 90.0, step: 0.2, ..karas() };
    let [supported, clamped] = [run(&coarse()), run(&Square { fix: CLAMPED_ALL, ..coarse() })];
    assert!((clamped.force / supported.force - 1.0).abs() < 2e-3, "{supported:?} {clamped:?}");
    // While they do to a large one.
    let large = heavy("mass = '10 kg'\nvelocity = '0.06 m/s'", 9000.0);
    let [supported, clamped] = [run(&large), run(&Square { fix: CLAMPED_ALL, ..large })];
    assert!(clamped.force > 1.2 * supported.force, "{supported:?} {clamped:?}");
}

#[test]
fn a_contact_twice_as_stiff_changes_the_force_as_expected() {
    // Of a lighter mass the ripple of the plate stands on the force.
    let large = heavy("mass = '1000 kg'\nvelocity = '0.006 m/s'", 90000.0);
    let small = Square { cells: 24, end: 90.0, step: 0.2, ..karas() };
    for plate in [large, small] {
        let expected = advice(&plate.text()).contact;
        let [once, twice] = [run(&plate), run(&Square { k: 2.0 * plate.k, ..plate })];
        let change = twice.force / once.force - 1.0;
        assert!(
            (change - expected.sensitivity).abs() < 0.25 * expected.sensitivity.abs() + 0.005,
            "{change} {expected:?}"
        );
    }
}

/// Deflection and force of the linear plate are those of the balance without a membrane; with it, those of the other.
#[test]
fn the_energy_balance_meets_a_run() {
    let large = heavy("mass = '10 kg'\nvelocity = '0.06 m/s'", 9000.0);
    let (estimate, run) = (advice(&large.text()).estimate, run(&large));
    assert!(
        (run.deflection / estimate.linear.deflection - 1.0).abs() < estimate.inertia_error(),
        "{run:?} {estimate:?}"
    );
}
