//! Built-in discs against the exact deflections of circular plates.

use super::scene::{Plate, Side, isotropic, order};
use fem::core::dof::Dof;
use std::fmt::Write as _;

const E: f64 = 70e9;
const NU: f64 = 0.3;
const H: f64 = 0.5e-3;
const RADIUS: f64 = 25e-3;
const RING: f64 = 20e-3;
/// Pa
const PRESSURE: f64 = 1e4;

/// Deflection at the middle of a disc of 25 mm under pressure.
fn middle(mesh: &str, refine: usize, support: &str) -> f64 {
    let mut plate = Plate::new(&isotropic(E * 1e-9, NU, 2.7), "[0]", H * 1e3, vec![1])
        .element("kind = 'mitc4'")
        .sides([Side::Free; 4])
        .load("pressure = '0.01 MPa'")
        .with(&format!("[[support]]\nat = 'mid-plane'\n{support}"));
    let _ = write!(plate.mesh, "{{ disc = {{ radius = '25 mm', {mesh} }}, refine = {refine} }}");
    let model = plate.model("static");
    let node = model.plate.plane.groups["impact"].nodes[0] as usize;
    let [level, _] = model.plate.outer_levels(node);
    let dof = model.plate.dofs_at(node, level, Dof::new(3, 0).unwrap()).next().unwrap();
    -fem::analyses::statics::solve(&model, std::num::NonZeroUsize::MIN).unwrap().u[dof]
}

fn flexural_rigidity() -> f64 {
    E * H.powi(3) / (12.0 * (1.0 - NU * NU))
}

/// What shear adds inside a circle that is held: q a² / (4 κ G h).
fn shear(radius: f64) -> f64 {
    PRESSURE * radius.powi(2) / (4.0 * 5.0 / 6.0 * E / (2.0 * (1.0 + NU)) * H)
}

/// Errors relative to `exact` with every cell divided by four none, one and two times: second order, small.
#[track_caller]
fn converges(mesh: &str, support: &str, exact: f64, last: f64) {
    let errors = [0, 1, 2].map(|refine| middle(mesh, refine, support) / exact - 1.0);
    let rate = order(&[1, 2, 4], &errors.map(f64::abs));
    assert!((1.85..2.3).contains(&rate) && errors[2].abs() < last, "order {rate}, errors {errors:?}");
}

/// w = q R⁴ / (64 D), and shear.
#[test]
fn a_clamped_disc() {
    let exact = PRESSURE * RADIUS.powi(4) / (64.0 * flexural_rigidity()) + shear(RADIUS);
    converges("size = '4 mm'", "group = 'edge'\nfix = ['U10', 'U20', 'U30', 'U13', 'U23']", exact, 5e-4);
}

/// Simply supported on a ring of radius a inside its edge R. Inside w = q r⁴/(64 D) + B r² + const., outside also
/// c (r² ln r + a² ln r), c = -q R²/(8 D): shear force at R zero, slope and moment at a continuous; no moment at R.
#[test]
fn a_disc_on_a_ring() {
    let d = flexural_rigidity();
    let c = -PRESSURE * RADIUS.powi(2) / (8.0 * d);
    let load = PRESSURE * (3.0 + NU) * RADIUS.powi(2) / (16.0 * d);
    let ring = (NU - 1.0) * c * (RING / RADIUS).powi(2) + c * (2.0 * (1.0 + NU) * RADIUS.ln() + 3.0 + NU);
    let outside = -(load + ring) / (2.0 * (1.0 + NU));
    let inside = outside + c * (1.0 + RING.ln());
    // Upwards positive at the ring, so that the middle lies below it.
    let exact = (PRESSURE * RING.powi(4) / (64.0 * d) + inside * RING.powi(2)).abs() + shear(RING);
    converges("support = '20 mm', size = '4 mm'", "group = 'support'\nfix = ['U30']", exact, 5e-4);
}

/// The same place off the middle, whatever the mesh: by the deflection there of the clamped disc, w ~ (1 - r²/R²)².
#[test]
fn a_disc_struck_off_its_middle() {
    let at = 1.0 - (10e-3 / RADIUS).powi(2);
    let bending = PRESSURE * RADIUS.powi(4) / (64.0 * flexural_rigidity()) * at * at;
    let exact = bending + shear(RADIUS) * at;
    let clamped = "group = 'edge'\nfix = ['U10', 'U20', 'U30', 'U13', 'U23']";
    converges("size = '4 mm', impact = ['8 mm', '-6 mm']", clamped, exact, 5e-4);
}
