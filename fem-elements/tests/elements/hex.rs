//! The solid elements against polynomials, and the quick way of parallelograms against plain integration.

use crate::common::{eight_plies, interpolation_error, mass, monomials, scaled_error, stiffness, zero_modes};
use fem_core::element::{Cell, Element, Part, Scratch, Stack};
use fem_core::testkit::Provided;
use fem_elements::{HermiteHex, HermitePrism, Mass, TransverseStresses};

const RECTANGLE: [[f64; 2]; 4] = [[0.2, -0.4], [1.5, -0.4], [1.5, 0.7], [0.2, 0.7]];
const PARALLELOGRAM: [[f64; 2]; 4] = [[0.1, -0.3], [1.2, 0.1], [1.7, 1.3], [0.6, 0.9]];
const QUADRILATERAL: [[f64; 2]; 4] = [[0.1, -0.3], [1.2, 0.1], [1.6, 1.5], [0.3, 0.8]];

fn cell(corners: [[f64; 2]; 4], stack: &Stack) -> Cell<'_> {
    Cell { corners: corners.into(), z: [-0.3, 0.5], stack }
}

/// With the transverse stresses of its strains, as the quick form has them.
fn prism() -> HermitePrism {
    HermitePrism::new(Mass::Cubic, 4).unwrap().with_transverse_stresses(TransverseStresses::OfStrains)
}

#[test]
fn parallelograms_agree_with_integration_ply_by_ply() {
    let stack = eight_plies();
    for corners in [RECTANGLE, PARALLELOGRAM] {
        let cell = cell(corners, &stack);
        for m in [Mass::Cubic, Mass::Linear] {
            let prism = HermitePrism::new(m, 4).unwrap().with_transverse_stresses(TransverseStresses::OfStrains);
            let plain = Provided(&prism);
            let elements: [&dyn Element; 2] = [&HermiteHex::new(m), &prism];
            for (matrix, name) in [(stiffness as fn(&dyn Element, &Cell<'_>) -> Vec<f64>, "stiffness"), (mass, "mass")]
            {
                let want = matrix(&plain, &cell);
                for element in elements {
                    let got = matrix(element, &cell);
                    let error = scaled_error(96, |i, j| got[i + 96 * j], |i, j| want[i + 96 * j]);
                    assert!(error < 1e-12, "{name} {m:?}: {error:e}");
                    assert!((0..96 * 96).all(|k| got[k] == got[k / 96 + 96 * (k % 96)]), "{name} is not symmetric");
                }
            }
        }
    }
}

#[test]
fn the_quick_way_and_the_general_one_meet() {
    let stack = eight_plies();
    let mut nearly = PARALLELOGRAM;
    nearly[2][0] += 1e-11;
    assert!(
        HermiteHex::new(Mass::Cubic)
            .stiffness(&cell(nearly, &stack), &mut Scratch::default(), &mut [0.0; 96 * 96])
            .is_err()
    );
    for matrix in [stiffness, mass] {
        let general = matrix(&prism(), &cell(nearly, &stack));
        let quick = matrix(&HermiteHex::new(Mass::Cubic), &cell(PARALLELOGRAM, &stack));
        let error = scaled_error(96, |i, j| quick[i + 96 * j], |i, j| general[i + 96 * j]);
        assert!(error < 1e-9, "{error:e}");
    }
}

#[test]
fn other_quadrilaterals_and_folded_cells_are_refused() {
    let stack = eight_plies();
    let hex = HermiteHex::new(Mass::Cubic);
    let refused = |corners: [[f64; 2]; 4], z: [f64; 2], why: &str| {
        let (cell, scratch) = (Cell { corners: corners.into(), z, stack: &stack }, &mut Scratch::default());
        let part = Part { slice: 0, q: stack.slices[0].q };
        let errors = [
            hex.stiffness(&cell, scratch, &mut [0.0; 96 * 96]),
            hex.mass(&cell, scratch, &mut [0.0; 96 * 96]),
            hex.mean_strains(&cell, &[part], hex.info().plane(), scratch, &mut [0.0; 6 * 96]),
        ];
        for error in errors {
            let error = error.unwrap_err().0;
            assert!(error.contains(why), "{error}");
        }
    };
    refused(QUADRILATERAL, [0.0, 1.0], "hermite-prism");
    let mut nan = RECTANGLE;
    nan[1][0] = f64::NAN;
    refused(nan, [0.0, 1.0], "hermite-prism");
    let [a, b, c, d] = RECTANGLE;
    refused([a, d, c, b], [0.0, 1.0], "folded");
    refused([a, a, d, d], [0.0, 1.0], "degenerate");
    refused([a; 4], [0.0, 1.0], "degenerate");
    refused(RECTANGLE, [1.0, 0.0], "folded");
}

#[test]
fn polynomials_are_reproduced() {
    let stack = eight_plies();
    let reproduced = |element: &dyn Element, corners, most, degree| {
        let error = |p| (0..3).map(|c| interpolation_error(element, &cell(corners, &stack), c, p)).fold(0.0, f64::max);
        monomials(most, degree).into_iter().map(error).fold(0.0, f64::max)
    };
    let elements: [&dyn Element; 2] = [&prism(), &HermiteHex::new(Mass::Cubic)];
    for element in elements {
        for corners in [RECTANGLE, PARALLELOGRAM] {
            let error = reproduced(element, corners, [3, 3, 3], 3);
            assert!(error < 1e-13, "{element:?} {error:e}");
        }
    }
    // On general quadrilaterals {1, x, y} times cubics in z, and no more.
    for most in [[1, 0, 3], [0, 1, 3]] {
        let error = reproduced(&prism(), QUADRILATERAL, most, 4);
        assert!(error < 1e-13, "{error:e}");
    }
    assert!(interpolation_error(&prism(), &cell(QUADRILATERAL, &stack), 0, [1, 1, 0]) > 1e-3);
}

#[test]
fn a_constant_strain_has_its_energy_in_any_cell() {
    let stack = eight_plies();
    let gradient = [[1.0, 0.3, -0.2], [0.7, -0.5, 0.4], [-0.6, 0.1, 0.8]];
    let strain = [1.0, -0.5, 0.8, 1.0, 0.5, -0.8];
    let elements: [(&dyn Element, _); 3] =
        [(&prism(), QUADRILATERAL), (&prism(), PARALLELOGRAM), (&HermiteHex::new(Mass::Cubic), PARALLELOGRAM)];
    for (element, corners) in elements {
        let cell = cell(corners, &stack);
        let ke = stiffness(element, &cell);
        let u: Vec<f64> = (element.info().nodes.iter())
            .flat_map(|node| {
                let at = cell.position(*node);
                gradient.into_iter().flat_map(move |[a, b, c]| [a * at[0] + b * at[1] + c * at[2], a, b, c])
            })
            .collect();
        let twice_energy: f64 = (0..96 * 96).map(|k| u[k % 96] * ke[k] * u[k / 96]).sum();
        let [a, b, c, d] = corners;
        let area = 0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0]));
        let density: f64 = (stack.slices.iter())
            .map(|s| {
                let eight = (0..36).map(|k| strain[k / 6] * s.c[k / 6][k % 6] * strain[k % 6]).sum::<f64>();
                0.5 * (s.q[1] - s.q[0]) * eight
            })
            .sum();
        let want = density * area * 0.8;
        assert!((twice_energy - want).abs() < 1e-12 * want, "{twice_energy} {want}");
    }
}

#[test]
fn only_rigid_motions_are_free_of_energy() {
    let stack = eight_plies();
    let coarse = HermitePrism::new(Mass::Cubic, 3).unwrap();
    for corners in [RECTANGLE, PARALLELOGRAM, QUADRILATERAL] {
        assert_eq!(zero_modes(&prism(), &cell(corners, &stack)), 6);
        assert_eq!(zero_modes(&coarse, &cell(corners, &stack)), 6);
    }
    assert_eq!(zero_modes(&HermiteHex::new(Mass::Cubic), &cell(PARALLELOGRAM, &stack)), 6);
}
