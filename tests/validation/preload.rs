//! Plates that are loaded in their plane, against exact elasticity with initial stresses and first-order plate theory.

use super::impact::{Strike, shell};
use super::scene::Side::{self, Supported, Symmetric};
use super::scene::{AS4, Plate, isotropic, reference};
use std::f64::consts::{PI, TAU};

/// Side, mm.
const SIDE: f64 = 75.0;
const PLIES: &str = "[0/90/0/90]2s";

/// Buckling factors, frequencies and deflections, relative.
const CLOSE: f64 = 5e-3;

/// Elements, and the columns of the tables that they meet.
const SOLID: (&str, &[usize], usize) = ("z_derivatives = 'layer-wise'", &[8, 8], 5);
const SHELL: (&str, &[usize], usize) = ("kind = 'mitc4'", &[16], 18);

/// A quarter of the plate under `n`, N/m, along x; planes in the middle are of symmetry or antisymmetry.
fn quarter((element, layers, cells): (&str, &[usize], usize), n: f64, middle: [Side; 2]) -> Plate {
    let sides = [Supported, middle[0], Supported, middle[1]];
    let loaded = [("x-min", n), ("x-max", n), ("y-min", 0.0), ("y-max", 0.0)].into_iter().zip(sides);
    let edges: Vec<String> = loaded
        .filter(|(_, side)| *side == Supported)
        .map(|((group, n), _)| format!("{{ group = '{group}', force = '{n} N/m' }}"))
        .collect();
    Plate::new(AS4, PLIES, 0.13, layers.to_vec())
        .element(element)
        .rectangle([0.5 * SIDE; 2], [cells; 2])
        .sides(sides)
        .with(&format!("[effects]\npreload = [{}]", edges.join(", ")))
}

/// Holds the lowest frequencies of each class of symmetry to a column.
fn frequencies(model: (&str, &[usize], usize), column: &str, shares: &[f64]) {
    let rows = reference("preload_frequencies_as4x16.csv");
    for share in shares {
        let rows: Vec<_> = rows.iter().filter(|row| row["N_over_Ncr"] == *share).collect();
        let class = |waves: f64| if waves % 2.0 == 1.0 { Symmetric } else { Supported };
        for middle in [[Symmetric, Symmetric], [Supported, Symmetric]] {
            let of_class = rows.iter().filter(|row| [class(row["m"]), class(row["n"])] == middle);
            let mut exact: Vec<f64> = of_class.map(|row| row[column]).collect();
            exact.sort_by(f64::total_cmp);
            let found = quarter(model, rows[0]["Nx_N_per_m"], middle).frequencies(2);
            for (omega, exact) in found.iter().zip(exact) {
                let off = omega / TAU / exact - 1.0;
                assert!(off.abs() < CLOSE, "{column} {share} {middle:?}: {exact} Hz {off:.2e}");
            }
        }
    }
}

#[test]
fn frequencies_of_solids_are_those_of_elasticity_with_initial_stresses() {
    frequencies(SOLID, "f_exact3d_Hz", &[-0.9, -0.5, 0.0, 0.5, 1.0]);
}

#[test]
fn frequencies_of_shells_are_those_of_first_order_theory() {
    frequencies(SHELL, "f_FSDT_RI_Hz", &[-0.9, -0.5, 0.0, 0.5, 1.0]);
}

#[test]
fn deflections() {
    for row in reference("preload_static_as4x16.csv") {
        for (model, column) in [(SOLID, "w_sine_exact3d_mid"), (SHELL, "w_sine_FSDT")] {
            let plate = quarter(model, row["Nx_N_per_m"], [Symmetric; 2])
                .pressure("sin(3.141592653589793*x/75)*sin(3.141592653589793*y/75)")
                .probe([0.5 * SIDE; 2]);
            let solution = plate.solve();
            let profile = &solution.profiles[0];
            let w = profile[profile.len() / 2].displacement[2] / 1e6;
            let off = w.abs() / row[column] - 1.0;
            assert!(off.abs() < CLOSE, "{column} {}: {off:.2e}", row["N_over_Ncr"]);
        }
    }
}

/// Peaks of the series, N: 500 g at 2 m/s on first-order plates, without a preload and with half of the buckling load either way.
#[test]
fn impacts() {
    for (share, peak) in [(0.0, 1172.2), (0.5, 1297.5), (-0.5, 963.3)] {
        let n = share * 222_857.221_774;
        let strike = Strike {
            half: 0.5 * SIDE,
            mass: 0.5,
            velocity: 2.0,
            k: 984_150_713.641,
            longest: 2.0,
            vectors: 100,
            step: 0.5,
            end: 2600.0,
            effects: format!(
                "preload = [{{ group = 'x-min', force = '{n} N/m' }}, {{ group = 'y-min', force = '0 N/m' }}]"
            ),
            ..shell(AS4.into(), PLIES, 0.13, &[16])
        };
        let off = strike.peak() / peak - 1.0;
        assert!(off.abs() < 1e-2, "{share}: {off:.2e}");
    }
}

/// A plate so tense that its bending hardly counts, thin-plate theory: ρ h ω² = D k⁴ + N k².
#[test]
fn a_tense_plate_is_a_membrane() {
    let (side, h) = (0.1, 2e-4_f64);
    let (k2, d) = (2.0 * (PI / side).powi(2), 70e9 * h.powi(3) / 12.0 / 0.91);
    let n = 200.0 * d * k2;
    let exact = ((d * k2 * k2 + n * k2) / (2700.0 * h)).sqrt();
    let plate = Plate::new(&isotropic(70.0, 0.3, 2.7), "[0]", 1e3 * h, vec![1])
        .element("kind = 'mitc4'")
        .rectangle([500.0 * side; 2], [10; 2])
        .with(&format!(
            "[effects]\npreload = [{{ group = 'x-min', force = '{n} N/m' }}, {{ group = 'y-min', force = '{n} N/m' }}]"
        ));
    let off = plate.frequencies(1)[0] / exact - 1.0;
    assert!(off.abs() < CLOSE, "{off:.2e}");
}
