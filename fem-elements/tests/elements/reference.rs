//! Element matrices against an independent implementation (tests/data/element-3d.json; units N, mm, tonne).

use crate::common::{scaled_error, stiffness};
use fem_core::element::{Cell, Element, Part, Scratch, Slice, Stack};
use fem_core::material::Elastic;
use fem_core::tensor::{Strain6, rotate_stiffness, stress};
use fem_core::testkit::Provided;
use fem_elements::{HermitePrism, Mass, TransverseStresses};
use serde_json::Value;

const TOLERANCE: f64 = 1e-10;

struct Case {
    name: String,
    corners: [[f64; 2]; 4],
    z: [f64; 2],
    stack: Stack,
    angles: Vec<f64>,
    reference: Value,
}

impl Case {
    fn cell(&self) -> Cell<'_> {
        Cell { corners: self.corners.into(), z: self.z, stack: &self.stack }
    }
}

fn numbers(v: &Value) -> Vec<f64> {
    match v {
        Value::Array(a) => a.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().unwrap()],
    }
}

fn cases() -> Vec<Case> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/element-3d.json");
    let file: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let material = &file["materials"]["AS4_3502"];
    let m = |k: &str| material[k].as_f64().unwrap();
    let c = Elastic::transversely_isotropic(m("E1"), m("E2"), m("nu12"), m("nu23"), m("G12")).stiffness();
    let read = |e: &Value| {
        let (z0, z1) = (e["z0"].as_f64().unwrap(), e["z1"].as_f64().unwrap());
        let xy = numbers(&e["xy"]);
        let corners = std::array::from_fn(|i| [xy[2 * i], xy[2 * i + 1]]);
        let plies = e["plies"].as_array().unwrap();
        let (mut z, mut slices, mut angles) = (z0, vec![], vec![]);
        for ply in plies {
            let (t, angle) = (ply["t"].as_f64().unwrap(), ply["angle"].as_f64().unwrap().to_radians());
            let q = |z: f64| 2.0 * (z - z0) / (z1 - z0) - 1.0;
            slices.push(Slice {
                q: [q(z), q(z + t)],
                c: rotate_stiffness(&c, angle),
                density: m("rho"),
                free: [0.0; 6],
            });
            angles.push(angle);
            z += t;
        }
        let name = e["name"].as_str().unwrap().to_owned();
        Case { name, corners, z: [z0, z1], stack: Stack::new(slices), angles, reference: e.clone() }
    };
    let cases: Vec<_> = file["elements"].as_array().unwrap().iter().map(read).collect();
    assert_eq!(cases.len(), 3);
    cases
}

#[test]
fn stiffness_mass_and_averages_agree_with_the_independent_implementation() {
    for case in cases() {
        let r = &case.reference;
        let upper = numbers(&r["K_upper"]);
        let k_ref = |i: usize, j: usize| {
            let (i, j) = (i.min(j), i.max(j));
            upper[i * 96 - i * (i + 1) / 2 + j]
        };
        let fine = HermitePrism::new(Mass::Cubic, 16).unwrap().with_transverse_stresses(TransverseStresses::OfStrains);
        let elements: [&dyn Element; 2] = [&fine, &Provided(&fine)];
        for element in elements {
            let ke = stiffness(element, &case.cell());
            let error = scaled_error(96, |i, j| ke[i + 96 * j], k_ref);
            assert!(error < TOLERANCE, "{}: stiffness {error:e}", case.name);
            let u: Vec<f64> = (0..96).map(|k| 1e-3 * f64::from(k + 1).sin()).collect();
            let energy: f64 =
                0.5 * (0..96).map(|j| u[j] * (0..96).map(|i| u[i] * ke[i + 96 * j]).sum::<f64>()).sum::<f64>();
            let want = r["energy"].as_f64().unwrap();
            assert!((energy - want).abs() < TOLERANCE * want, "{}: energy {energy} {want}", case.name);

            let cell = case.cell();
            let mean = |slice: usize, q: [f64; 2]| {
                let mut b = vec![0.0; 6 * 96];
                element
                    .mean_strains(&cell, &[Part { slice, q }], element.info().plane(), &mut Scratch::default(), &mut b)
                    .unwrap();
                let e: [f64; 6] = std::array::from_fn(|i| (0..96).map(|j| b[i + 6 * j] * u[j]).sum());
                e
            };
            let close = |got: &[f64], want: &[f64], what: &str| {
                let scale = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                for (g, w) in got.iter().zip(want) {
                    assert!((g - w).abs() < TOLERANCE * scale, "{} {what}: {g} {w}", case.name);
                }
            };
            for (i, average) in r["ply_average"].as_array().unwrap().iter().enumerate() {
                let slice = &case.stack.slices[i];
                let e = mean(i, slice.q);
                close(&e, &numbers(&average["strain"]), "ply strain");
                let want = numbers(&average["stress"]);
                close(&stress(&slice.c, &Strain6::<fem_core::tensor::Global>::new(e)).0, &want, "ply stress");
                // The same through the ply's own frame.
                let ply = Strain6::<fem_core::tensor::Global>::new(e).to_ply(case.angles[i]);
                let c_ply = rotate_stiffness(&slice.c, -case.angles[i]);
                close(&stress(&c_ply, &ply).to_global(case.angles[i]).0, &want, "ply stress by rotation");
            }
            let (z0, z1) = (r["z0"].as_f64().unwrap(), r["z1"].as_f64().unwrap());
            for interface in r["interface_average_strain"].as_array().unwrap() {
                let q = 2.0 * (interface["z"].as_f64().unwrap() - z0) / (z1 - z0) - 1.0;
                close(&mean(0, [q, q]), &numbers(&interface["strain"]), "interface strain");
            }
            for (mass, key) in [(Mass::Cubic, "M_cubic_scalar"), (Mass::Linear, "M_linear_scalar")] {
                let want = numbers(&r[key]);
                let prism = HermitePrism::new(mass, 16).unwrap();
                let mut me = vec![f64::NAN; 96 * 96];
                prism.mass(&cell, &mut Scratch::default(), &mut me).unwrap();
                let dof = |f: usize, c: usize| 12 * (f / 4) + 4 * c + f % 4;
                for c in 0..3 {
                    let error = scaled_error(32, |i, j| me[dof(i, c) + 96 * dof(j, c)], |i, j| want[32 * i + j]);
                    assert!(error < TOLERANCE, "{}: {key} {error:e}", case.name);
                }
                let other = me[dof(0, 0) + 96 * dof(0, 1)];
                assert_eq!(other, 0.0);
            }
        }
    }
}

#[test]
fn order_four_is_exact_on_rectangles_and_close_on_distorted_cells() {
    for case in cases() {
        let fine = stiffness(&HermitePrism::new(Mass::Cubic, 16).unwrap(), &case.cell());
        let four = stiffness(&HermitePrism::new(Mass::Cubic, 4).unwrap(), &case.cell());
        let error = scaled_error(96, |i, j| four[i + 96 * j], |i, j| fine[i + 96 * j]);
        let rectangle = case.reference["K_upper_inplane_gauss4"].is_string();
        assert!(error < if rectangle { 1e-12 } else { 1e-5 }, "{}: {error:e}", case.name);
    }
}

#[test]
fn bad_cells_and_orders_are_refused() {
    assert!(HermitePrism::new(Mass::Cubic, 2).unwrap_err().0.contains("zero-energy"));
    let case = &cases()[0];
    let element = HermitePrism::new(Mass::Cubic, 4).unwrap();
    let mut ke = vec![0.0; 96 * 96];
    let mut refused = |corners: [[f64; 2]; 4], z: [f64; 2]| {
        let cell = Cell { corners: corners.into(), z, stack: &case.stack };
        element.stiffness(&cell, &mut Scratch::default(), &mut ke).is_err()
    };
    let mut folded = case.corners;
    folded.swap(1, 2);
    assert!(refused(folded, case.z));
    let mut nan = case.corners;
    nan[0][0] = f64::NAN;
    assert!(refused(nan, case.z));
    assert!(refused(case.corners, [case.z[1], case.z[0]]));
    assert!(refused(case.corners, [case.z[0], case.z[0]]));
    assert!(!refused(case.corners, case.z));
}
