//! Many plies in a layer of cells, whose transverse stresses are smooth: against exact elasticity and against a layer per ply.

use super::pagano::{EIGHT, Mesh, SIXTEEN, THREE};
use super::scene::{PAGANO, Plate, Side, farthest, largest};
use fem::core::profile::ProfilePoint;
use std::f64::consts::PI;

const SMOOTH: &str = "transverse_stresses = 'smooth'";
const OF_STRAINS: &str = "transverse_stresses = 'of-strains'";

/// Largest errors of deflection and transverse shear over the thickness, relative to the largest of their columns, of a
/// cross-ply in so many plies a layer.
fn errors(laminate: &super::pagano::Laminate, ratio: f64, layers: &[usize], element: &str) -> [f64; 2] {
    let (rows, h) = (laminate.exact(ratio), laminate.height());
    let plies: usize = layers.iter().sum();
    let points = (rows.len() / plies - 1) + 1;
    let solution =
        Plate { layers: layers.to_vec(), ..laminate.plate(ratio, Mesh(6, 1), points) }.element(element).solve();
    let worst = |column: &str, profile: usize, value: &dyn Fn(&ProfilePoint) -> f64| {
        farthest(&rows, column, ("z_over_h", h), 1, &solution.profiles[profile], value) / largest(&rows, column)
    };
    let deflection = worst("W", 0, &|p| p.displacement[2] * 1e3);
    let shear = |column: &str, profile, k: usize| worst(column, profile, &|p| p.global.0[k] * 1e-6);
    [deflection, shear("txz", 1, 5).max(shear("tyz", 2, 4))]
}

/// Cross-plies: a layer of eight plies is as good as one of each, where strains of its own leave 5 to 13 % of the deflection.
#[test]
fn cross_plies_in_one_layer_and_in_two() {
    for (laminate, ratio, layers, bounds) in [
        (&EIGHT, 10.0, &[8][..], [1e-3, 0.05]),
        (&EIGHT, 10.0, &[4, 4], [1e-3, 0.05]),
        (&EIGHT, 4.0, &[4, 4], [3e-3, 0.06]),
        (&SIXTEEN, 10.0, &[16], [6e-4, 0.03]),
        (&SIXTEEN, 10.0, &[8, 8], [6e-4, 0.03]),
        (&SIXTEEN, 4.0, &[8, 8], [3e-3, 0.06]),
    ] {
        let [smooth, of_strains] = [SMOOTH, OF_STRAINS].map(|element| errors(laminate, ratio, layers, element));

        assert!(smooth[0] < bounds[0] && smooth[1] < bounds[1], "{ratio} {layers:?}: {smooth:?}");
        assert!(of_strains[0] > 3.0 * smooth[0], "{ratio} {layers:?}: {of_strains:?}");
    }
}

/// A sandwich.
fn cored(plies: &str, layers: &[usize], element: &str) -> Plate {
    const CORE: &str = "e1 = '0.1 MPa'\ne2 = '0.1 MPa'\ne3 = '0.1 MPa'\nnu12 = 0.25\nnu13 = 0.25\nnu23 = 0.25\n\
                        g12 = '0.04 MPa'\ng13 = '0.04 MPa'\ng23 = '0.04 MPa'\n";
    Plate::new(&format!("{PAGANO}[materials.core]\n{CORE}"), plies, 0.125, layers.to_vec())
        .with("[laminate.ply.core]\nmaterial = 'core'\nthickness = '2.5 mm'")
        .element(element)
}

/// The same, simply supported under a sine pressure.
fn sandwich(plies: &str, layers: &[usize], element: &str) -> Plate {
    let (side, wave) = (10.0, PI / 10.0);
    cored(plies, layers, element).rectangle([0.5 * side; 2], [6; 2]).pressure(&format!("-sin({wave}*x)*sin({wave}*y)"))
}

fn energy(plies: &str, layers: &[usize], element: &str) -> f64 {
    sandwich(plies, layers, element).solve().strain_energy
}

/// A sandwich in a single layer of cells, its core a hundredth as stiff as its faces.
#[test]
fn sandwiches_in_one_layer() {
    for (plies, count) in [("[0/90/0{core}/90/0]", 5), ("[45/-45/0{core}/-45/45]", 5)] {
        let exact = energy(plies, &vec![1; count], SMOOTH);
        let [smooth, plain] = [SMOOTH, OF_STRAINS].map(|element| energy(plies, &[count], element) / exact - 1.0);

        assert!(smooth.abs() < 2e-2, "{plies}: {smooth:e}");
        assert!(plain < -0.05, "{plies}: {plain:e}");
    }
}

/// A shell with a soft core says by how much it is too soft.
#[test]
fn a_shell_whose_section_warps_is_warned_of() {
    let plies = "[0/90/0{core}/90/0]";
    let plate = sandwich(plies, &[5], "kind = 'mitc4'").rectangle([5.0; 2], [16; 2]);
    let warnings = plate.model("static").warnings;
    let said = warnings.iter().find_map(|warning| {
        let (_, number) = warning.split_once("deflections are too large by about ")?;
        number.split_once(" %")?.0.parse::<f64>().ok()
    });
    // Of the middle of the core, which the pressure on the top squeezes below and above it as well: none of a shell's business.
    let deflection = |plate: Plate, at: [f64; 2]| {
        let middle = plate.profile(at, 3).solve().profiles[0].swap_remove(7);
        assert!(middle.z.abs() < 1e-9);
        middle.displacement[2]
    };
    let actual = 100.0 * (deflection(plate, [5.0; 2]) / deflection(sandwich(plies, &[1; 5], SMOOTH), [5.0; 2]) - 1.0);
    let said = said.unwrap_or_else(|| panic!("{actual} %: {warnings:?}"));
    assert!((0.5..2.0).contains(&(said / actual)), "{said} %, and it is {actual} %");
    // Of a strip it is the length between its supports that counts, and not its width.
    let strip = |element: &str, layers: &[usize], length: f64| {
        let strip = cored(plies, layers, element).rectangle([length, 2.0], [32, 2]).pressure("-1");
        strip.sides([Side::Supported, Side::Supported, Side::Free, Side::Free])
    };
    let warps = |plate: &Plate| plate.model("static").warnings.iter().any(|warning| warning.contains("warps"));
    for (length, warned) in [(7.0, true), (80.0, false)] {
        let [shell, solid] = [strip("kind = 'mitc4'", &[5], length), strip(SMOOTH, &[1; 5], length)];
        assert_eq!(warps(&shell), warned, "{length}");
        let [shell, solid] = [shell, solid].map(|plate| deflection(plate, [0.5 * length, 1.0]));
        let actual = shell / solid - 1.0;
        assert_eq!(actual > 0.02, warned, "{length}: {actual}");
    }
    let thin = THREE.plate(20.0, Mesh(4, 1), 2).element("kind = 'mitc4'");
    let thin = Plate { layers: vec![3], ..thin }.model("static").warnings;
    assert!(!thin.iter().any(|warning| warning.contains("warps")), "{thin:?}");
}
