//! Supports that give way, against closed forms, of every element.

use super::scene::isotropic;
use fem::analyses::statics;
use fem::core::dof::Dof;
use fem::io::scene;
use fem::{Error, Model, Registry};
use std::f64::consts::PI;
use std::num::NonZeroUsize;

/// Aluminium: Young's modulus, Pa, and Poisson's ratio; side and thickness, m.
pub(super) const E: f64 = 70e9;
pub(super) const NU: f64 = 0.3;
pub(super) const SIDE: f64 = 0.1;
pub(super) const THICKNESS: f64 = 1e-3;

pub(super) const ELEMENTS: [(&str, usize); 4] = [
    ("kind = 'hermite-prism', z_derivatives = 'layer-wise'", 12),
    ("kind = 'hermite-hex'", 12),
    ("kind = 'hex20'", 20),
    ("kind = 'mitc4'", 24),
];

pub(super) const NEAR: f64 = 5e-3;

pub(super) fn text(mesh: &str, element: &str, ply_mm: f64, supports: &str, load: &str) -> String {
    let layers = if element.contains("mitc4") { "[2]" } else { "[1, 1]" };
    format!(
        "title = 'plate'\nanalysis = 'static'\nmesh = {mesh}\nelement = {{ {element} }}\nsupport = [{supports}]\n\
         [materials.m]\n{}[laminate]\nplies = '[0/0]'\nmaterial = 'm'\nply_thickness = '{ply_mm} mm'\nlayers = {layers}\n\
         [[load]]\n{load}\n",
        isotropic(E * 1e-9, NU, 2.7)
    )
}

pub(super) fn model(text: &str) -> Result<Model, Error> {
    Model::new(scene::parse(text, "scene.toml".as_ref())?, &Registry::standard())
}

/// Deflections of the mid-plane downwards, m, at the nodes nearest to some places.
pub(super) fn deflections<const N: usize>(text: &str, places: [[f64; 2]; N]) -> [f64; N] {
    let model = model(text).unwrap();
    assert_eq!(model.warnings, Vec::<String>::new());
    let plate = &model.plate;
    let solved = statics::solve(&model, NonZeroUsize::MIN).unwrap();
    let middle = if plate.info().is_shell() { 1 } else { plate.mid_level().unwrap() };
    let w = |column: usize| plate.dofs_at(column, middle, Dof::new(3, 0).unwrap()).next();
    places.map(|at| {
        let distance = |c: &usize| (plate.columns[*c][0] - at[0]).hypot(plate.columns[*c][1] - at[1]);
        let columns = (0..plate.columns.len()).filter(|column| w(*column).is_some());
        -solved.u[w(columns.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()).unwrap()]
    })
}

pub(super) fn bending(h: f64) -> f64 {
    E * h.powi(3) / (12.0 * (1.0 - NU * NU))
}

/// Sides y simply supported, sides x on springs, under q sin(πy/b): w = (A cosh βx + B βx sinh βx + q/(D β⁴)) sin βy from the middle,
/// no moment and V = k w at the edges (Lévy).
#[test]
fn plates_on_elastic_edges() {
    let (d, beta, q) = (bending(THICKNESS), PI / SIDE, 1e3);
    let stiffness = d * beta.powi(3);
    let (s, c, x) = ((0.5 * PI).sinh(), (0.5 * PI).cosh(), 0.5 * PI);
    // Over D β² sin βy: −M = w″ − ν w, and V = −(w‴ − (2 − ν) w′) along x, all derivatives by βx; D β³ V(edge) = −k w there.
    let moment = [(1.0 - NU) * c, (1.0 - NU) * x * s + 2.0 * c];
    let edge = [c, x * s];
    let force = [(1.0 - (2.0 - NU)) * s, (x * c + 3.0 * s) - (2.0 - NU) * (x * c + s)];
    let own = q / (d * beta.powi(4));
    // D β³ (w‴ − (2 − ν) w′) = k w at x = a/2, with k = D β³.
    let [[a11, a12], [a21, a22]] = [moment, [force[0] - edge[0], force[1] - edge[1]]];
    let [b1, b2] = [NU * own, own];
    let det = a11 * a22 - a12 * a21;
    let (a, b) = ((b1 * a22 - b2 * a12) / det, (a11 * b2 - a21 * b1) / det);
    let exact = [a + own, a * c + b * x * s + own];
    let load = "pressure = { formula = \"sin(3.141592653589793*y/100)\", unit = 'kPa', length = 'mm' }\nface = 'top'";
    for (element, cells) in ELEMENTS {
        let sprung = format!("kind = 'roller', stiffness = '{stiffness:.9e} N/m^2'");
        let supports = format!(
            "{{ group = 'y-min', kind = 'simply-supported' }}, {{ group = 'y-max', kind = 'simply-supported' }}, \
             {{ group = 'x-min', {sprung} }}, {{ group = 'x-max', {sprung} }}, {{ restrain = 'rigid-motions' }}"
        );
        let mesh = format!("{{ rectangle = ['100 mm', '100 mm'], cells = [{cells}, {cells}] }}");
        let text = text(&mesh, element, 500.0 * THICKNESS, &supports, load);
        let found = deflections(&text, [[0.5 * SIDE; 2], [0.0, 0.5 * SIDE]]);
        for (found, exact) in found.into_iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < NEAR, "{element}: {found:e}, not {exact:e}");
        }
    }
}

/// Navier: a pressure q sin sin deflects a simply supported square on a foundation by q/(4 D β⁴ + k).
#[test]
fn plates_on_foundations() {
    let (d, beta) = (bending(THICKNESS), PI / SIDE);
    let k = 4.0 * d * beta.powi(4);
    let sine = "sin(3.141592653589793*x/100) * sin(3.141592653589793*y/100)";
    let load = format!("pressure = {{ formula = \"{sine}\", unit = 'kPa', length = 'mm' }}\nface = 'top'");
    for (element, cells) in ELEMENTS {
        let sides = ["x-min", "x-max", "y-min", "y-max"]
            .map(|side| format!("{{ group = '{side}', kind = 'simply-supported' }}"));
        let bed = format!("{{ group = 'plate', kind = 'roller', at = 'bottom', stiffness = '{k:.9e} N/m^3' }}");
        let mesh = format!("{{ rectangle = ['100 mm', '100 mm'], cells = [{cells}, {cells}] }}");
        let text = text(&mesh, element, 500.0 * THICKNESS, &format!("{}, {bed}", sides.join(", ")), &load);
        let [found] = deflections(&text, [[0.5 * SIDE; 2]]);
        assert!((found * 2.0 * k / 1e3 - 1.0).abs() < NEAR, "{element}: {found:e}");
    }
}

/// A stiff block on four tips sinks by its load over their stiffness.
#[test]
fn blocks_on_tips() {
    let (k, radius) = (1e9_f64, 4e-3_f64);
    let tips = [[15.0, 15.0], [85.0, 15.0], [15.0, 85.0], [85.0, 85.0]];
    let tips = tips.map(|[x, y]| {
        let disc = format!("disc = {{ x = '{x} mm', y = '{y} mm', radius = '4 mm' }}");
        format!("{{ {disc}, kind = 'roller', at = 'bottom', stiffness = '1 N/mm^3' }}")
    });
    let supports = format!("{}, {{ restrain = 'rigid-motions' }}", tips.join(", "));
    let mesh = "{ rectangle = ['100 mm', '100 mm'], cells = [4, 4] }";
    let text = text(mesh, ELEMENTS[0].0, 20.0, &supports, "pressure = '1 kPa'\nface = 'top'");
    let exact = 1e3 * SIDE * SIDE / (4.0 * k * PI * radius * radius);
    let [found] = deflections(&text, [[0.5 * SIDE; 2]]);
    assert!((found / exact - 1.0).abs() < NEAR, "{found:e}, not {exact:e}");
}

#[test]
fn wrong_ways() {
    let plate = "{ rectangle = ['100 mm', '100 mm'], cells = [4, 4] }";
    let refused = |more: &str, supports: &str, words: &[&str]| {
        let text = text(plate, "kind = 'mitc4'", 0.5, supports, "pressure = '1 kPa'\nface = 'top'");
        let shown = format!("{:?}", model(&format!("{more}\n{text}")).unwrap_err());
        for word in words {
            assert!(shown.contains(word), "{supports}: no `{word}` in {shown}");
        }
    };
    refused("", "{ group = 'x-min', kind = 'clamped', stiffness = '5 N/mm^2' }", &["does not give way", "roller"]);
    refused("", "{ group = 'x-min', kind = 'roller', stiffness = '5 N/mm^3' }", &["another dimension", "50 N/mm^2"]);
    refused("", "{ group = 'plate', kind = 'roller', at = 'bottom', stiffness = '5 N/mm' }", &["50 N/mm^3"]);
    refused("", "{ group = 'x-min', kind = 'roller', stiffness = '-5 N/mm^2' }", &["is positive"]);
    refused("", "{ group = 'x-min', kind = 'roller', at = 'all', stiffness = '5 N/mm^2' }", &["one surface"]);
    refused(
        "",
        "{ group = 'x-min', kind = 'roller', stiffness = '5 N/mm^2' }",
        &["leave the plate free", "rotation about"],
    );
    refused(
        "",
        "{ disc = { x = '0 mm', y = '0 mm', radius = '4 mm' }, kind = 'roller', stiffness = '5 N/mm^3' }",
        &["leaves the plate"],
    );
    let all = "{ group = 'plate', kind = 'roller', stiffness = '5 N/mm^3' }, { restrain = 'rigid-motions' }";
    refused("effects = { membrane = 'on' }", all, &["does not go with large deflections"]);
    refused(
        "symmetry = 'mirror-x'",
        "{ group = 'x-min', kind = 'roller', stiffness = '5 N/mm^2' }, { restrain = 'rigid-motions' }",
        &["break the symmetry"],
    );
}
