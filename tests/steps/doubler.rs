//! Doublers: plates with a thicker part, against the same plate filled up with a material that weighs and resists nothing.

use super::{case, lines, mesh};
use crate::support::{Case, root};
use std::fs;

/// What the filling adds, over the stiffness of the plies.
const AIR: f64 = 1e-7;

const TAPE: &str = "materials.tape = { library = 'AS4/3502' }\n";
const PLIES: &str = "material = 'tape', ply_thickness = '0.13 mm'";

fn inside(p: [f64; 2]) -> bool {
    (12e-3..28e-3).contains(&p[0]) && (8e-3..20e-3).contains(&p[1])
}

/// A plate of 40 x 28 mm with eight plies, the group `base`, and eight more on 16 x 12 mm of it.
fn plate(size: f64, text: &str) -> Case {
    let base = |p: [f64; 2]| !inside(p);
    case(text, mesh(&lines(&[12.0, 28.0, 40.0], size), &lines(&[8.0, 20.0, 28.0], size), &[("base", &base)]))
}

fn scene(laminate: &str, rest: &str) -> String {
    format!(
        "title = 'a doubler'\nmesh = {{ file = 'plate.msh', unit = 'mm' }}\nelement = {{ kind = 'hermite-prism' }}\n{TAPE}{laminate}\n{rest}"
    )
}

/// Plies that end around the doubler.
fn stepped() -> String {
    format!(
        "laminate = [{{ plies = '[(0/90)2s/(0/90)2s]', {PLIES} }}, \
         {{ group = 'base', align = 'bottom', plies = '[0/90]2s', {PLIES} }}]"
    )
}

/// The same height everywhere, eight plies of air around the doubler.
fn filled() -> String {
    let (e, g) = (130e9 * AIR, 5e9 * AIR);
    format!(
        "materials.air = {{ e1 = '{e} Pa', e2 = '{} Pa', nu12 = 0.3, nu23 = 0.4, g12 = '{g} Pa' }}\n\
         laminate = [{{ plies = '[(0/90)2s/(0/90)2s]', layers = [4, 4, 8], {PLIES} }}, \
         {{ group = 'base', plies = '[0/90/0/90/90/0/90/0/0{{air}}_8]', layers = [4, 4, 8], ply.air = {{ material = 'air' }}, {PLIES} }}]",
        0.07 * e
    )
}

/// Clamped, the deflection held at one height in either: the middle of the edge is another one with the filling.
const AT_REST: &str = "analysis = 'static'\neffects = { damage = 'off' }\nload = [{ pressure = '10 kPa', face = 'bottom' }]\n\
                       support = [{ group = 'x-min', kind = 'guided' }, { group = 'x-max', kind = 'guided' }, \
                       { group = 'x-min', kind = 'roller' }, { group = 'x-max', kind = 'roller' }]\n\
                       profile = [{ name = 'doubler', at = { x = '19 mm', y = '15 mm' } }]\n";

/// Displacement along z and stress σ₁₁ (MPa) of the bottom, and σ₁₁ of ply 12, where the profile is.
fn at_rest(size: f64, laminate: &str) -> [f64; 3] {
    let case = plate(size, &scene(laminate, AT_REST));
    case.fem("run", &["--out", "out"]).good();
    let (header, rows) = case.table("out/profile-doubler.csv");
    let column = |name: &str| header.iter().position(|own| own == name).unwrap();
    let number = |row: &Vec<String>, name: &str| row[column(name)].parse::<f64>().unwrap();
    let twelfth = rows.iter().find(|row| row[column("ply")] == "12").unwrap();
    [number(&rows[0], "w_m") * 1e6, number(&rows[0], "sxx_Pa") * 1e-6, number(twelfth, "sxx_Pa") * 1e-6]
}

#[test]
fn a_doubler_is_the_plate_filled_up_with_nothing() {
    let (stepped, filled) = (at_rest(4.0, &stepped()), at_rest(4.0, &filled()));
    for (ours, theirs) in stepped.iter().zip(filled) {
        assert!((ours / theirs - 1.0).abs() < 1e-5, "{stepped:?}, not {filled:?}");
    }
}

#[test]
#[ignore = "a fine mesh"]
fn a_doubler_converges() {
    let fine = at_rest(1.0, &filled());
    let errors: Vec<f64> =
        [4.0, 2.0].iter().map(|size| (at_rest(*size, &stepped())[0] / fine[0] - 1.0).abs()).collect();
    assert!(errors[1] < 0.4 * errors[0] && errors[1] < 1e-2, "{errors:?}");
}

/// A uniaxial stress along a step is exact whatever the thickness: the faces of the step are free of it. Layers of 3 and 5 plies
/// meet those of 1 and 3.
#[test]
fn a_uniform_stress_passes_along_a_step() {
    let side = |p: [f64; 2]| p[0] < 4e-3;
    let beside = |p: [f64; 2]| p[0] > 4e-3;
    for element in ["hermite-prism", "hex20", "hermite-hex"] {
        let text = format!(
            "title = 'patch test'\nanalysis = 'static'\nmesh = {{ file = 'plate.msh', unit = 'mm' }}\nelement = {{ kind = '{element}' }}\n\
             effects = {{ damage = 'off' }}\nmaterials.steel = {{ e = '200 GPa', nu = 0.3 }}\n\
             laminate = [{{ plies = '[0_8]', material = 'steel', ply_thickness = '0.25 mm', layers = [3, 5] }}, \
             {{ group = 'thin', align = 'bottom', plies = '[0_4]', material = 'steel', ply_thickness = '0.25 mm', layers = [1, 3] }}]\n\
             support = [{{ group = 'y-min', kind = 'symmetry' }}, {{ restrain = 'rigid-motions' }}]\n\
             load = [{{ group = 'y-max thin', force_per_length = ['0 N/mm', '100 N/mm', '0 N/mm'] }}, \
             {{ group = 'y-max thick', force_per_length = ['0 N/mm', '200 N/mm', '0 N/mm'] }}]\n\
             profile = [{{ name = 'thin', at = {{ x = '3.1 mm', y = '3 mm' }}, equilibrium = false }}, \
             {{ name = 'thick', at = {{ x = '4.2 mm', y = '3 mm' }}, equilibrium = false }}]\n"
        );
        let case = case(
            &text,
            mesh(&[0.0, 2.5, 4.0, 5.5, 9.0], &[0.0, 2.0, 5.0, 6.0], &[("thin", &side), ("thick", &beside)]),
        );
        case.fem("run", &["--out", "out"]).good();
        for name in ["thin", "thick"] {
            let (header, rows) = case.table(&format!("out/profile-{name}.csv"));
            for row in &rows {
                for (column, value) in header.iter().zip(row) {
                    let want = if column == "syy_Pa" { 100e6 } else { 0.0 };
                    if ["sxx_Pa", "syy_Pa", "sxy_Pa", "szz_strains_Pa", "syz_strains_Pa", "szx_strains_Pa"]
                        .contains(&column.as_str())
                    {
                        let got: f64 = value.parse().unwrap();
                        assert!((got - want).abs() < 1e-10 * 100e6, "{element} {name} {column}: {got}");
                    }
                }
            }
        }
        let (header, rows) = case.table("out/displacements.csv");
        let column = |name: &str| header.iter().position(|own| own == name).unwrap();
        for row in &rows {
            let [y, v] = ["y_m", "v_m"].map(|name| row[column(name)].parse::<f64>().unwrap());
            assert!((v - y * 100e6 / 200e9).abs() < 1e-10 * 3e-6, "{element}: {v} at {y}");
        }
    }
}

/// What a strip of 10 mm carries from its tip, 1 N: forces and moments about z = 0 a millimetre from a step on either side, less
/// what they are, relative.
fn resultants(size: f64) -> Vec<[f64; 3]> {
    let inside = |p: [f64; 2]| p[0] > 10e-3;
    let at = [9.0, 11.0];
    let text = format!(
        "title = 'tractions at a step'\nanalysis = 'static'\nmesh = {{ file = 'plate.msh', unit = 'mm' }}\n\
         element = {{ kind = 'webster-beam', z_derivatives = 'layer-wise' }}\neffects = {{ damage = 'off' }}\n{TAPE}\
         laminate = [{{ plies = '[0/90]4s', layers = 16, {PLIES} }}, \
         {{ group = 'thin', align = 'bottom', plies = '[0/90]2s', layers = 8, {PLIES} }}]\n\
         support = [{{ group = 'x-min', kind = 'clamped' }}]\n\
         load = [{{ group = 'x-max', force_per_length = ['0 N/mm', '0 N/mm', '0.1 N/mm'] }}]\n\
         profile = [{{ name = 'left', at = {{ x = '{} mm', y = '5 mm' }} }}, {{ name = 'right', at = {{ x = '{} mm', y = '5 mm' }} }}]\n",
        at[0], at[1]
    );
    let case = case(&text, mesh(&lines(&[10.0, 20.0], size), &[0.0, 10.0], &[("thin", &inside)]));
    case.fem("run", &["--out", "out"]).good();
    let profiles = case.summary("out")["profiles"].as_array().unwrap().clone();
    let found = profiles.iter().zip(at).map(|(profile, x)| {
        let number = |key: &str| profile[key][0].as_f64().unwrap();
        // N = 0, M₁₁ = ∫ σ z dz = -(L - x) F/b for F along z, Q = F/b.
        let moment = 100.0 * (20.0 - x) * 1e-3;
        [number("N_N_per_m") * 1e-3 / moment, number("M_N").abs() / moment - 1.0, number("Q_N_per_m") / 100.0 - 1.0]
    });
    found.collect()
}

#[test]
fn what_one_side_of_a_step_carries_the_other_does() {
    let worst = |all: &[[f64; 3]]| all.iter().flatten().fold(0.0_f64, |most, e| most.max(e.abs()));
    let (coarse, fine) = (worst(&resultants(0.5)), worst(&resultants(0.2)));
    assert!(fine < 2e-3 && fine < 0.1 * coarse, "{coarse} {fine}");
}

#[test]
fn an_impact_on_a_doubler_keeps_its_energy_and_names_its_plies() {
    let scenes = root().join("tests/data/scenes");
    let text = fs::read_to_string(scenes.join("impact-doubler.toml")).unwrap().replace("doubler.msh", "plate.msh");
    let case = case(&text, fs::read(scenes.join("doubler.msh")).unwrap());
    let said = case.fem("check", &[]).good();
    let said = said.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("region `rest`: 8 plies in 2 layers of cells, z from -0.52 mm to 0.52 mm"), "{said}");
    assert!(said.contains("region `doubler`: 16 plies in 3 layers of cells, z from -0.52 mm to 1.56 mm"), "{said}");
    case.fem("run", &["--out", "out"]).good();
    let summary = case.summary("out");
    let area = 40.0 * 28.0 * 1.04 + 16.0 * 12.0 * 1.04;
    let density = 1.58;
    let mass = summary["model"]["plate_mass_g"].as_f64().unwrap();
    assert!((mass / (area * density * 1e-3) - 1.0).abs() < 0.05, "{mass}");
    let lost = summary["accuracy"]["energy_error_relative"].as_f64().unwrap();
    assert!(lost.abs() < 1e-5, "{lost}");
    let (header, rows) = case.table("out/index_maxima.csv");
    let column = |name: &str| header.iter().position(|own| own == name).unwrap();
    let most = |region: &str| {
        let own = rows.iter().filter(|row| row[column("region")] == region);
        own.filter_map(|row| row[column("ply")].parse::<usize>().ok()).max()
    };
    assert_eq!((most("rest"), most("doubler")), (Some(8), Some(16)));
    let heights = |region: &str, ply: &str| {
        let row = rows.iter().find(|row| row[column("region")] == region && row[column("ply")] == ply).unwrap();
        row[column("z_m")].parse::<f64>().unwrap() * 1e3
    };
    assert!((heights("rest", "8") - 0.455).abs() < 1e-9 && (heights("doubler", "16") - 1.495).abs() < 1e-9);
}
