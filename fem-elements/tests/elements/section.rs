//! Webster's beam element against an independent implementation (tests/data/element-2d.json; units N, mm, tonne; unit
//! width) and against polynomials.

use crate::common::{eight_plies, interpolation_error, mass, monomials, scaled_error, stiffness, zero_modes};
use fem_core::element::{Cell, Element, Part, Scratch, Slice, Stack};
use fem_core::material::Elastic;
use fem_core::plugin::{Built, Params, Plugin, Value as ParamValue};
use fem_core::tensor::{Global, Strain6, rotate_stiffness, stress};
use fem_elements::{Mass, PlaneState, WebsterBeam};
use serde_json::Value;

const N: usize = 24;
const TOLERANCE: f64 = 1e-10;

fn numbers(v: &Value) -> Vec<f64> {
    match v {
        Value::Array(a) => a.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().unwrap()],
    }
}

fn strip(length: f64, width: f64) -> [[f64; 2]; 4] {
    [[0.4, -1.1], [0.4 + length, -1.1], [0.4 + length, width - 1.1], [0.4, width - 1.1]]
}

#[test]
fn the_independent_implementation_is_matched() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/element-2d.json");
    let file: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let material = |k: &str| file["materials"]["AS4_3502"][k].as_f64().unwrap();
    let [e1, e2, nu12, nu23, g12, density] = ["E1", "E2", "nu12", "nu23", "G12", "rho"].map(material);
    let c = Elastic::transversely_isotropic(e1, e2, nu12, nu23, g12).stiffness();
    let elements = file["elements"].as_array().unwrap();
    assert_eq!(elements.len(), 3);
    for reference in elements {
        let name = reference["name"].as_str().unwrap();
        let [z0, z1, length] = ["z0", "z1", "length"].map(|k| reference[k].as_f64().unwrap());
        let mut z = z0;
        let slice = |ply: &Value| {
            let low = z;
            z += ply["t"].as_f64().unwrap();
            let q = [low, z].map(|z| 2.0 * (z - z0) / (z1 - z0) - 1.0);
            Slice { q, c: rotate_stiffness(&c, ply["angle"].as_f64().unwrap().to_radians()), density, free: [0.0; 6] }
        };
        let stack = Stack::new(reference["plies"].as_array().unwrap().iter().map(slice).collect());
        let state = match reference["mode"].as_str().unwrap() {
            "plane strain" => PlaneState::Strain,
            _ => PlaneState::Stress,
        };
        let width = 2.5;
        let cell = Cell { corners: strip(length, width).into(), z: [z0, z1], stack: &stack };
        let element = WebsterBeam::new(state, Mass::Cubic, 4).unwrap();

        let upper = numbers(&reference["K_upper"]);
        let want = |i: usize, j: usize| {
            let (i, j) = (i.min(j), i.max(j));
            width * upper[i * N - i * (i + 1) / 2 + j]
        };
        let ke = stiffness(&element, &cell);
        let error = scaled_error(N, |i, j| ke[i + N * j], want);
        assert!(error < TOLERANCE, "{name}: stiffness {error:e}");

        let u: Vec<f64> = (0..N).map(|k| 1e-3 * (k as f64 + 1.0).sin()).collect();
        let energy: f64 = (0..N * N).map(|k| 0.5 * u[k / N] * ke[k] * u[k % N]).sum();
        let want = width * reference["energy"].as_f64().unwrap();
        assert!((energy - want).abs() < TOLERANCE * want, "{name}: energy {energy} {want}");

        for (functions, key) in [(Mass::Cubic, "M_cubic_scalar"), (Mass::Linear, "M_linear_scalar")] {
            let want = numbers(&reference[key]);
            let me = mass(&WebsterBeam::new(state, functions, 4).unwrap(), &cell);
            let dof = |f: usize, component: usize| 6 * (f / 3) + 3 * component + f % 3;
            for component in 0..2 {
                let got = |i, j| me[dof(i, component) + N * dof(j, component)];
                let error = scaled_error(12, got, |i, j| width * want[12 * i + j]);
                assert!(error < TOLERANCE, "{name}: {key} {error:e}");
            }
            assert!((0..144).all(|k| me[dof(k / 12, 0) + N * dof(k % 12, 1)] == 0.0));
        }

        let averages = reference["ply_average"].as_array().unwrap();
        assert_eq!(averages.len(), stack.slices.len());
        for (slice, (ply, average)) in stack.slices.iter().zip(averages).enumerate() {
            let mut b = vec![f64::NAN; 6 * N];
            let part = Part { slice, q: ply.q };
            element.mean_strains(&cell, &[part], element.info().plane(), &mut Scratch::default(), &mut b).unwrap();
            let strain: [f64; 6] = std::array::from_fn(|i| (0..N).map(|j| b[i + 6 * j] * u[j]).sum());
            let stress = stress(&ply.c, &Strain6::<Global>::new(strain)).0;
            for (got, key) in [(strain, "strain"), (stress, "stress")] {
                let want = numbers(&average[key]);
                let scale = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                for (row, want) in [0, 2, 5].into_iter().zip(want) {
                    assert!((got[row] - want).abs() < TOLERANCE * scale, "{name}: {key} {} {want}", got[row]);
                }
            }
            let (vanish, scale) = match state {
                PlaneState::Stress => (stress, stress[0].abs()),
                PlaneState::Strain => (strain, strain[0].abs()),
            };
            assert!([1, 3, 4].into_iter().all(|i| vanish[i].abs() < 1e-14 * scale), "{name}: {vanish:?}");
        }
    }
}

#[test]
fn complete_cubics_are_reproduced() {
    let stack = eight_plies();
    let cell = Cell { corners: strip(1.3, 0.9).into(), z: [-0.3, 0.5], stack: &stack };
    let element = WebsterBeam::new(PlaneState::Strain, Mass::Cubic, 4).unwrap();
    for component in [0, 2] {
        for powers in monomials([3, 0, 3], 3) {
            let error = interpolation_error(&element, &cell, component, powers);
            assert!(error < 1e-13, "{powers:?}: {error:e}");
        }
        assert!(interpolation_error(&element, &cell, component, [2, 0, 2]) > 1e-3);
    }
}

#[test]
fn only_rigid_motions_are_free_of_energy() {
    let stack = eight_plies();
    let cell = Cell { corners: strip(1.3, 0.9).into(), z: [-0.3, 0.5], stack: &stack };
    for state in [PlaneState::Stress, PlaneState::Strain] {
        for order in [3, 4] {
            assert_eq!(zero_modes(&WebsterBeam::new(state, Mass::Cubic, order).unwrap(), &cell), 3);
        }
    }
}

#[test]
fn the_choices_of_a_scene_are_taken_and_checked() {
    let text = |t: &str| ParamValue::Text(t.into());
    let stack = eight_plies();
    let cell = Cell { corners: strip(1.3, 0.9).into(), z: [-0.3, 0.5], stack: &stack };
    let build = |params: Params| match WebsterBeam::build(&params).unwrap() {
        Built::Element(element) => element,
        other => panic!("{other:?}"),
    };
    let matrices = |e: &dyn Element| (stiffness(e, &cell), mass(e, &cell));
    let new = |state, mass| matrices(&WebsterBeam::new(state, mass, 4).unwrap());
    let default = build(Params::default());
    assert!(default.info().is_section());
    assert_eq!(matrices(&*default), new(PlaneState::Stress, Mass::Cubic));
    let other = build(Params::default().with("state", text("plane-strain")).with("mass", text("linear")));
    assert_eq!(matrices(&*other), new(PlaneState::Strain, Mass::Linear));
    assert_ne!(matrices(&*other), matrices(&*default));

    assert!(WebsterBeam::new(PlaneState::Stress, Mass::Cubic, 2).unwrap_err().0.contains("4 zero-energy"));
    for order in [2.0, 33.0] {
        let error = WebsterBeam::build(&Params::default().with("in_plane_order", ParamValue::Number(order)));
        assert_eq!(error.unwrap_err().key, "in_plane_order");
    }
    assert_eq!(WebsterBeam::build(&Params::default().with("state", text("free"))).unwrap_err().key, "state");
}
