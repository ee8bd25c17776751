//! Each kind of load: its resultant and moments, and a problem with a closed form.

use super::scene::{MeshFile, Plate, Side, gmsh_grid, isotropic};
use fem::Plan;
use fem::io::scene;
use fem::{Model, Registry};
use std::f64::consts::PI;

/// Where the element holds the exact solution.
const EXACT: f64 = 1e-9;
/// Cantilevers, against beam theory with shear.
const BEAM: f64 = 5e-4;
/// The same on distorted cells: an error that finer cells of the same distortion do not remove.
const DISTORTED_BEAM: f64 = 5e-3;
/// A thin plate under a small circle, against Navier's series of a point force.
const POINT: f64 = 5e-3;

/// 20 x 10 mm, 1 mm thick, E = 70 GPa, ν = 0 where nothing else is said.
const E: f64 = 70e9;

/// Held at x-min.
const CLAMPED: [Side; 4] = [Side::Clamped, Side::Free, Side::Free, Side::Free];

fn distorted() -> MeshFile {
    gmsh_grid(&[0.0, 4.0, 10.0, 15.0, 20.0], &[0.0, 3.0, 7.0, 10.0], 0.25)
}

fn regular() -> MeshFile {
    gmsh_grid(&[0.0, 5.0, 10.0, 15.0, 20.0], &[0.0, 5.0, 10.0], 0.0)
}

fn plate(mesh: &MeshFile, nu: f64) -> Plate {
    Plate::new(&isotropic(E * 1e-9, nu, 2.7), "[0_2]", 0.5, vec![1, 1]).on(mesh).sides([Side::Free; 4])
}

/// The load does the work of `force` at `point` on every rigid motion.
#[track_caller]
fn resultant(load: &str, force: [f64; 3], point: [f64; 3]) {
    let mesh = distorted();
    let model = plate(&mesh, 0.3).sides(CLAMPED).load(load).model("static");
    let Plan::Static { forces, .. } = &model.plan else { panic!("{:?}", model.plan) };
    let mut work = [0.0; 6];
    for (dof, f) in forces.iter().enumerate() {
        let motions = model.plate.rigid_motions(dof, [0.0; 3], 1.0);
        work.iter_mut().zip(motions).for_each(|(w, m)| *w += f * m);
    }
    let ([x, y, z], [fx, fy, fz]) = (point, force);
    let want = [fx, fy, fz, y * fz - z * fy, z * fx - x * fz, x * fy - y * fx];
    let size = force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    for (got, want) in work.iter().zip(want) {
        assert!((got - want).abs() < EXACT * size, "{load}: {work:?}, not {want:?}");
    }
}

#[test]
fn every_load_has_its_resultant_and_moments() {
    resultant("pressure = '2 MPa'", [0.0, 0.0, -400.0], [10e-3, 5e-3, 0.5e-3]);
    resultant("pressure = '2 MPa'\nface = 'bottom'\ngroup = 'plate'", [0.0, 0.0, 400.0], [10e-3, 5e-3, -0.5e-3]);
    let edge = "force_per_length = ['10 N/mm', '0 N/mm', '-3 N/mm']\ngroup = 'x-max'";
    resultant(edge, [100.0, 0.0, -30.0], [20e-3, 5e-3, 0.0]);
    let corner = "force = ['1 N', '2 N', '3 N']\ngroup = 'corner'\nat = 'top'";
    resultant(corner, [1.0, 2.0, 3.0], [20e-3, 10e-3, 0.5e-3]);
    resultant(
        "patch_radius = '2 mm'\nforce = '100 N'\nat = { x = '8 mm', y = '4 mm' }",
        [0.0, 0.0, -100.0],
        [8e-3, 4e-3, 0.5e-3],
    );
    let weight = 2700.0 * 20e-3 * 10e-3 * 1e-3;
    let gravity = "gravity = ['1 m/s^2', '0 m/s^2', '-9.81 m/s^2']";
    resultant(gravity, [weight, 0.0, -9.81 * weight], [10e-3, 5e-3, 0.0]);
}

#[test]
fn edge_loads_pull_a_distorted_mesh_evenly() {
    let mesh = distorted();
    let nu = 0.3;
    let pull = |plate: Plate, group: &str, force: &str| {
        plate.load(&format!("force_per_length = ['{force} N/mm', '0 N/mm', '0 N/mm']\ngroup = '{group}'"))
    };
    let loaded = pull(pull(plate(&mesh, nu), "x-max", "10"), "x-min", "-10");
    let solution = loaded.profile([7.0, 4.0], 3).profile([19.0, 4.0], 3).solve();
    // 10 N/mm over 1 mm.
    let stress = 10e6;
    for p in solution.profiles.iter().flatten() {
        let off = p.global.0.iter().zip([stress, 0.0, 0.0, 0.0, 0.0, 0.0]).map(|(s, want)| (s - want).abs());
        assert!(off.fold(0.0, f64::max) < EXACT * stress, "{:?}", p.global);
    }
    let stretch = solution.profiles[1][0].displacement[0] - solution.profiles[0][0].displacement[0];
    assert!((stretch / (stress / E * 12e-3) - 1.0).abs() < EXACT, "{stretch}");
}

#[test]
fn opposite_pressures_squeeze_a_distorted_mesh_evenly() {
    let mesh = distorted();
    let loaded = plate(&mesh, 0.3).load("pressure = '5 MPa'").load("pressure = '5 MPa'\nface = 'bottom'");
    let solution = loaded.profile([7.0, 4.0], 3).solve();
    let [bottom, .., top] = &solution.profiles[0][..] else { panic!("an empty profile") };
    let shortening = bottom.displacement[2] - top.displacement[2];
    assert!((shortening / (5e6 / E * 1e-3) - 1.0).abs() < EXACT, "{shortening}");
    assert!((bottom.global.0[2] / -5e6 - 1.0).abs() < EXACT, "{:?}", bottom.global);
    // Nothing varies in the plane: equilibrium carries the pressure of the bottom through to the top.
    for p in &solution.profiles[0] {
        let [normal, ..] = p.equilibrium.unwrap();
        assert!((normal / -5e6 - 1.0).abs() < EXACT, "{normal} at {}", p.z);
    }
}

#[test]
fn a_hanging_bar_is_stretched_by_its_weight() {
    // Without Poisson's ratio u = ρ g (L x − x²/2) / E, which rectangular cells hold exactly.
    let bar = Plate::new(&isotropic(E * 1e-9, 0.0, 2.7), "[0]", 1.0, vec![1])
        .rectangle([20.0, 10.0], [3, 2])
        .sides([Side::Symmetric, Side::Free, Side::Free, Side::Free])
        .load("gravity = ['9.81 m/s^2', '0 m/s^2', '0 m/s^2']")
        .profile([20.0, 5.0], 2);
    let u = bar.solve().profiles[0][0].displacement[0];
    let want = 2700.0 * 9.81 * 20e-3 * 20e-3 / (2.0 * E);
    assert!((u / want - 1.0).abs() < EXACT, "{u} {want}");
}

/// Mean deflection of the free end of a cantilever of 20 x 10 x 0.5 mm under a load of 1 N, over that of a beam.
fn cantilever(load: &str, mesh: &MeshFile) -> f64 {
    let mut beam = plate(mesh, 0.0).sides([Side::Clamped, Side::Free, Side::Free, Side::Free]);
    beam.ply_mm = 0.25;
    let ends = [0.0, 5.0, 10.0];
    let beam = ends.iter().fold(beam.load(load), |beam, y| beam.profile([20.0, *y], 2));
    let solution = beam.solve();
    let [a, b, c] = [0, 1, 2].map(|i| solution.profiles[i][1].displacement[2]);
    let (l, width, h) = (20e-3, 10e-3, 0.5e-3_f64);
    let bending = -l * l * l / (3.0 * E * width * h.powi(3) / 12.0);
    let shear = -1.2 * l / (0.5 * E * width * h);
    (a + 4.0 * b + c) / 6.0 / (bending + shear)
}

#[test]
fn a_cantilever_bends_under_a_load_along_its_edge() {
    let load = "force_per_length = ['0 N/mm', '0 N/mm', '-0.1 N/mm']\ngroup = 'x-max'";
    let even = cantilever(load, &regular());
    assert!((even - 1.0).abs() < BEAM, "{even}");
    let uneven = cantilever(load, &distorted());
    assert!((uneven - 1.0).abs() < DISTORTED_BEAM, "{uneven}");
}

#[test]
fn a_force_at_a_corner_lowers_the_end_on_average_as_if_spread_along_it() {
    // Betti: the mean over the end under a force at the corner is the corner's deflection under a force spread along it.
    let ratio = cantilever("force = ['0 N', '0 N', '-1 N']\ngroup = 'corner'\nat = 'mid-plane'", &regular());
    assert!((ratio - 1.0).abs() < BEAM, "{ratio}");
}

#[test]
fn a_small_circle_of_pressure_acts_on_a_thin_plate_like_a_force_at_its_middle() {
    let (a, h, nu) = (100e-3, 1e-3_f64, 0.3);
    let plate = Plate::new(&isotropic(E * 1e-9, nu, 2.7), "[0_2]", 0.5, vec![2])
        .rectangle([a * 1e3; 2], [10; 2])
        .sides([Side::Supported; 4])
        .load("patch_radius = '1 mm'\nforce = '10 N'\nat = { x = '50 mm', y = '50 mm' }")
        .profile([50.0; 2], 2);
    let w = plate.solve().profiles[0][0].displacement[2];
    let d = E * h.powi(3) / (12.0 * (1.0 - nu * nu));
    let odd = || (0..200).map(|i| f64::from(2 * i + 1));
    let series: f64 = odd().map(|m| odd().map(|n| (m * m + n * n).powi(-2)).sum::<f64>()).sum();
    let want = -10.0 * 4.0 * a * a / (PI.powi(4) * d) * series;
    assert!((w / want - 1.0).abs() < POINT, "{w} {want}");
}

#[test]
fn equilibrium_in_one_cell_is_refused() {
    let one = plate(&regular(), 0.3).sides(CLAMPED).rectangle([20.0, 10.0], [1, 1]);
    let one = one.load("pressure = '5 MPa'").profile([10.0, 5.0], 3);
    let scene = scene::parse(&one.text("static"), "scene.toml".as_ref()).unwrap();
    let why = Model::new(scene, &Registry::standard()).unwrap_err().to_string();
    assert!(why.contains("the stresses of 1 cells cannot be differentiated"), "{why}");
}

#[test]
fn a_pressure_that_changes_faster_than_cells_is_warned_of() {
    let warned = |formula: &str| {
        let pressure = format!("pressure = {{ formula = '{formula}', unit = 'MPa', length = 'mm' }}");
        let plate = plate(&regular(), 0.3).sides(CLAMPED).rectangle([20.0, 10.0], [4, 2]);
        let text = plate.load(&pressure).text("static");
        let model = Model::new(scene::parse(&text, "scene.toml".as_ref()).unwrap(), &Registry::standard()).unwrap();
        model.warnings.iter().any(|warning| warning.contains("changes faster than the cells are integrated"))
    };
    for (formula, lost) in [
        ("exp(-((x-11.3)/0.2)^2)", true),
        ("1/(x-11.3)", true),
        // Of which no point of the integration sees anything.
        ("exp(-((x-10)^2+(y-5)^2)/1e-4)", true),
        ("exp(-((x-11.3)/2)^2)", false),
        // Not finite at a corner, and integrated well.
        ("-ln(x/100)", false),
        ("sin(3.14159*x/5)", false),
        ("0*x", false),
    ] {
        assert_eq!(warned(formula), lost, "{formula}");
    }
}

/// Under a load narrower than a cell windows hang on the load; what margins in large cells are off is said as well.
#[test]
fn margins_under_a_narrow_load() {
    let solve = |load: &str, cells: usize| {
        let edges =
            ["x-min", "x-max", "y-min", "y-max"].map(|edge| format!("{{ group = '{edge}', kind = 'clamped' }}"));
        let text = format!(
            "title = 'plate'\nanalysis = 'static'\nelement = {{ kind = 'hermite-prism' }}\n\
             mesh = {{ rectangle = ['45 mm', '45 mm'], cells = [{cells}, {cells}] }}\n\
             laminate = {{ plies = '[0/90]s', material = 'm', ply_thickness = '0.5 mm', layers = [4] }}\n\
             support = [{}]\nload = [{load}]\nfailure = {{ criteria = ['hashin-1980'] }}\n\
             [materials.m]\nlibrary = 'AS4/3502'\n",
            edges.join(", ")
        );
        let scene = scene::parse(&text, "scene.toml".as_ref()).unwrap();
        let model = Model::new(scene, &Registry::standard()).unwrap();
        let solution = fem::analyses::statics::solve(&model, std::num::NonZeroUsize::MIN).unwrap();
        let summary = fem::output::statics::StaticSummary::new(&model, &solution);
        let warned =
            summary.warnings.iter().any(|said| said.contains("longer than the window of 2.54 mm: its margin follows"));
        let margin = &summary.margins[0];
        assert_eq!(warned, cells < 16, "{cells}: {margin:?}");
        margin.reserve_factor
    };
    for load in [
        "{ force = '1 kN', at = { x = '22.5 mm', y = '22.5 mm' }, patch_radius = '3 mm' }",
        "{ pressure = { formula = 'exp(-((x-22.5)^2+(y-22.5)^2)/9)', unit = 'MPa', length = 'mm' } }",
    ] {
        let [large, coarse, fine] = [10, 16, 32].map(|cells| solve(load, cells));
        assert!((coarse / fine - 1.0).abs() < 0.05 && (large / fine - 1.0).abs() < 0.15, "{large} {coarse} {fine}");
    }
    solve("{ pressure = '1 kPa' }", 9);
}
