//! Plates that are loaded in their plane, against exact elasticity with initial stresses and first-order plate theory.

use super::impact::{Strike, shell};
use super::scene::Side::{self, Supported, Symmetric};
use super::scene::{AS4, Cells, Plate, gmsh_cells, isotropic, reference};
use crate::support::impact_of;
use fem::analyses::buckling;
use fem::io::scene;
use std::f64::consts::{PI, TAU};
use std::num::NonZeroUsize;

/// Side, mm.
const SIDE: f64 = 75.0;
const PLIES: &str = "[0/90/0/90]2s";

/// Buckling factors, frequencies and deflections, relative.
const CLOSE: f64 = 5e-3;

/// Elements, and the columns of the tables that they meet.
const SOLID: (&str, &[usize], usize) = ("z_derivatives = 'layer-wise'", &[8, 8], 5);
const SHELL: (&str, &[usize], usize) = ("kind = 'mitc4'", &[16], 18);

/// A quarter of the plate under `n`, N/m, along x; planes in the middle are of symmetry or antisymmetry.
fn quarter(model: (&str, &[usize], usize), n: f64, middle: [Side; 2]) -> Plate {
    pressed(model, [n, 0.0], middle)
}

/// The same along x and y.
fn pressed((element, layers, cells): (&str, &[usize], usize), [x, y]: [f64; 2], middle: [Side; 2]) -> Plate {
    let sides = [Supported, middle[0], Supported, middle[1]];
    let loaded = [("x-min", x), ("x-max", x), ("y-min", y), ("y-max", y)].into_iter().zip(sides);
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

/// Peaks of the series, N: 9 g at 10 m/s on plates of classical theory under a point load, which come in a second contact. A tenth of the
/// thickness, of a thousand times the modulus and ten times the density, has the same bending stiffness and mass, 1 % of the rotary
/// inertia and 100 times the stiffness in shear.
#[test]
fn small_masses() {
    for (share, peak) in [(0.0, 1500.536), (0.5, 1123.727), (-0.5, 1386.858)] {
        let n = share * 222_857.221_774;
        let strike = format!(
            "title = '9 g'\nsymmetry = 'quarter'\nmesh = {{ rectangle = ['{SIDE} mm', '{SIDE} mm'], cells = [72, 72] }}\n\
             element = {{ kind = 'mitc4' }}\nsupport = [{}]\n\
             impactor = {{ mass = '9 g', velocity = '10 m/s', at = {{ x = '37.5 mm', y = '37.5 mm' }}, load = 'node' }}\n\
             contact = {{ law = 'hertz', k = '984150713.641 N/m^1.5' }}\n\
             effects = {{ damage = 'off', preload = [{{ group = 'x-min', force = '{n} N/m' }}, {{ group = 'x-max', force = '{n} N/m' }}, \
             {{ group = 'y-min', force = '0 N/m' }}, {{ group = 'y-max', force = '0 N/m' }}] }}\n\
             reduction = {{ method = 'ritz', vectors = 150 }}\nmarch = {{ integrator = 'newmark', step = '0.2 us', end = '460 us' }}\n\
             laminate = {{ plies = '{PLIES}', material = 'm', ply_thickness = '0.013 mm', layers = 1 }}\n[materials.m]\n{}",
            ["x-min", "x-max", "y-min", "y-max"]
                .map(|side| format!("{{ group = '{side}', kind = 'simply-supported' }}"))
                .join(", "),
            "e1 = '130300 GPa'\ne2 = '9650 GPa'\ne3 = '9650 GPa'\nnu12 = 0.35\nnu13 = 0.35\nnu23 = 0.4\ng12 = '5930 GPa'\n\
             g13 = '5930 GPa'\ng23 = '3446.428571428571 GPa'\ndensity = '15.8 g/cm^3'\n"
        );
        let (_, found) = impact_of(scene::parse(&strike, "scene.toml".as_ref()).unwrap()).unwrap();
        let force = found.outcome.history.iter().fold(0.0_f64, |most, row| most.max(row.contact_force_n()));
        let off = force / peak - 1.0;
        assert!(off.abs() < 1e-2, "{share}: {off:.2e}");
        let buckles = found.sizes.buckling.map(|share| -n / share);
        let classical = reference("preload_buckling_as4x16.csv")[0]["N_CLT_N_per_m"];
        assert_eq!(buckles.is_some(), n != 0.0);
        assert!(buckles.is_none_or(|found| (found / classical - 1.0).abs() < CLOSE), "{buckles:?} {classical}");
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

/// The load factors of `plate`.
fn factors(plate: &Plate, count: usize) -> Vec<f64> {
    buckling::solve(&plate.model("buckling"), count, NonZeroUsize::MIN).unwrap().buckling.factors
}

/// An isotropic plate of 70 GPa and ν = 0.3, its `edges` as entries of a preload.
fn square(side: f64, h: f64, cells: usize, edges: &[&str]) -> Plate {
    Plate::new(&isotropic(70.0, 0.3, 2.7), "[0]", 1e3 * h, vec![1])
        .element("kind = 'mitc4'")
        .rectangle([1e3 * side; 2], [cells; 2])
        .with(&format!("[effects]\npreload = [{}]", edges.join(", ")))
}

/// π² D/a² of a square plate, N/m.
fn euler(side: f64, h: f64) -> f64 {
    PI.powi(2) * 70e9 * h.powi(3) / 12.0 / 0.91 / side.powi(2)
}

#[test]
fn buckling_loads_are_those_of_elasticity_and_of_first_order_theory() {
    // Nine rows of each load, whose name is a text.
    let rows = reference("preload_buckling_as4x16.csv");
    for (rows, [x, y]) in rows.chunks(9).zip([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]) {
        for (model, column) in [(SOLID, "N_exact3d_N_per_m"), (SHELL, "N_FSDT_N_per_m")] {
            for middle in [[Symmetric, Symmetric], [Supported, Symmetric], [Symmetric, Supported]] {
                // Of the load along y the lowest of these, (2, 3), is not in the table.
                if x == 0.0 && middle[0] == Supported {
                    continue;
                }
                let class = |waves: f64| if waves % 2.0 == 1.0 { Symmetric } else { Supported };
                let of_class = rows.iter().filter(|row| [class(row["m"]), class(row["n"])] == middle);
                let exact = of_class.map(|row| row[column]).fold(f64::INFINITY, f64::min);
                let found = factors(&pressed(model, [-x, -y], middle), 1)[0];
                let off = found / exact - 1.0;
                assert!(off.abs() < CLOSE, "{x} {y} {column} {middle:?}: {off:.2e}");
            }
        }
    }
}

#[test]
fn cells_of_both_shapes_and_serendipity_buckle_as_well() {
    let lines: Vec<f64> = (0..=8).map(|i| SIDE / 16.0 * f64::from(i)).collect();
    let mixed = gmsh_cells(&lines, &lines, 0.1, Cells::Mixed);
    let exact = reference("preload_buckling_as4x16.csv")[0]["N_exact3d_N_per_m"];
    for element in [SOLID.0, "kind = 'hex20'"] {
        let plate = pressed((element, SOLID.1, SOLID.2), [-1.0, 0.0], [Symmetric; 2]).on(&mixed);
        let off = factors(&plate, 1)[0] / exact - 1.0;
        assert!(off.abs() < CLOSE, "{element}: {off:.2e}");
    }
}

#[test]
fn isotropic_plates_buckle_as_in_timoshenko_and_gere() {
    let (a, h) = (0.1, 1e-3);
    // A quarter: under compression along x, k = 4 simply supported, 10.07 clamped.
    let quarter = |edges: &[&str]| square(0.5 * a, h, 12, edges);
    let pressed = ["{ group = 'x-min', force = '-1 N/m' }", "{ group = 'y-min', force = '0 N/m' }"];
    let clamped = [Side::Clamped, Symmetric, Side::Clamped, Symmetric];
    for (plate, k) in [(quarter(&pressed), 4.0), (quarter(&pressed).sides(clamped), 10.07)] {
        let off = factors(&plate, 1)[0] / (k * euler(a, h)) - 1.0;
        assert!(off.abs() < 2.0 * CLOSE, "{k}: {off:.2e}");
    }
    // An edge that is moved: N = E h ε.
    let moved = ["{ group = 'x-min', displacement = '-1 um' }", "{ group = 'y-min', force = '0 N/m' }"];
    let n = 70e9 * h * 1e-6 / (0.5 * a);
    let off = factors(&quarter(&moved), 1)[0] * n / (4.0 * euler(a, h)) - 1.0;
    assert!(off.abs() < CLOSE, "{off:.2e}");
}

/// Stein and Neff 1947: k = 9.34 either way.
#[test]
fn a_plate_under_shear_buckles_either_way() {
    let (a, h) = (0.1, 1e-3);
    let edges = [("x-min", 1), ("x-max", 1), ("y-min", -1), ("y-max", -1)]
        .map(|(group, shear)| format!("{{ group = '{group}', shear = '{shear} N/m' }}"));
    let edges = edges.each_ref().map(String::as_str);
    let found = factors(&square(a, h, 30, &edges).sides([Supported; 4]), 4);
    assert!(found[0] * found[1] < 0.0 && found[2] * found[3] < 0.0, "{found:?}");
    assert!((found[0] + found[1]).abs() < 1e-6 * found[0].abs(), "{found:?}");
    let off = found[0].abs() / (9.34 * euler(a, h)) - 1.0;
    assert!(off.abs() < 2.0 * CLOSE, "{off:.2e}");
}

#[test]
fn a_strip_buckles_as_euler_says() {
    let (length, h) = (0.2, 2e-3_f64);
    let strip = Plate::new(&isotropic(70.0, 0.3, 2.7), "[0]", 1e3 * h, vec![1])
        .element("kind = 'webster-beam'")
        .rectangle([1e3 * length, 10.0], [16, 1])
        .sides([Side::Clamped, Side::Free, Side::Free, Side::Free])
        .with("[effects]\npreload = [{ group = 'x-max', force = '-1 N/m' }]");
    let exact = PI.powi(2) * 70e9 * h.powi(3) / 12.0 / (4.0 * length * length);
    let found = factors(&strip, 2);
    for (found, half_waves) in found.iter().zip([1.0, 3.0_f64]) {
        let off = found / (exact * half_waves.powi(2)) - 1.0;
        assert!(off.abs() < CLOSE, "{half_waves}: {off:.2e}");
    }
}

/// A strip between ends that do not move, simply supported, under a pressure and a tension N₀ before it: with S = N₀ + E h ∫ ½ w′² dx/L
/// its deflection is that of a beam under S.
#[test]
fn large_deflections_of_a_tense_strip_are_those_of_a_beam_under_all_of_its_tension() {
    let (length, h, e, q, tense) = (0.2, 1e-3_f64, 70e9, 5e4, 5e4);
    let d = e * h.powi(3) / 12.0;
    // Slopes and the deflection in the middle, of a beam from −L/2 to L/2 under the tension s.
    let beam = |s: f64| {
        let (k, half) = ((s / d).sqrt(), 0.5 * length);
        let slope = |x: f64| q / s * (x - (k * x).sinh() / (k * (k * half).cosh()));
        let steps = 2000;
        let stretch = (0..steps).map(|i| slope(half * (f64::from(i) + 0.5) / f64::from(steps)).powi(2)).sum::<f64>();
        let w = q * length * length / (8.0 * s) - q / (s * k * k) * (1.0 - (k * half).cosh().recip());
        (0.5 * stretch / f64::from(steps), w)
    };
    let (mut low, mut high) = (tense, 100.0 * tense);
    for _ in 0..100 {
        let s = 0.5 * (low + high);
        if tense + e * h * beam(s).0 > s { low = s } else { high = s }
    }
    let (tension, exact) = (low, beam(low).1);
    assert!(tension > 1.5 * tense, "both count: {tension}");
    let strip = Plate::new(&isotropic(70.0, 0.3, 2.7), "[0_2]", 500.0 * h, vec![1, 1])
        .element("kind = 'webster-beam'")
        .rectangle([500.0 * length, 10.0], [20, 1])
        .sides([Side::Free, Symmetric, Side::Free, Side::Free])
        .pressure(&format!("{}", 1e-6 * q))
        .probe([500.0 * length, 5.0])
        .with("[[support]]\ngroup = 'x-min'\nkind = 'hinged'\n")
        .with(&format!("[effects]\nmembrane = 'on'\npreload = [{{ group = 'x-min', force = '{tense} N/m' }}]"));
    let solution = strip.solve();
    let profile = &solution.profiles[0];
    let off = profile[profile.len() / 2].displacement[2].abs() / exact - 1.0;
    assert!(off.abs() < CLOSE, "{off:.2e} of {exact:e}, S = {tension}");
}

#[test]
fn turned_and_scaled_plates_have_the_same_factors() {
    let plies = |plies: &str, load| Plate { plies: plies.into(), ..pressed(SOLID, load, [Symmetric; 2]) };
    let (along, across) = (plies(PLIES, [-1.0, 0.0]), plies("[90/0/90/0]2s", [0.0, -1.0]));
    let [a, b] = [&along, &across].map(|plate| factors(plate, 3));
    assert!(a.iter().zip(&b).all(|(a, b)| (a / b - 1.0).abs() < 1e-6), "{a:?} {b:?}");
    let scaled = Plate { ply_mm: 1.3, ..along.clone() }.rectangle([5.0 * SIDE; 2], [5; 2]);
    let c = factors(&scaled, 3);
    assert!(a.iter().zip(&c).all(|(a, c)| (10.0 * a / c - 1.0).abs() < 1e-6), "{a:?} {c:?}");
}
