//! States at rest and natural modes.

use super::{close, series, volume};
use crate::support::{Case, plate};
use fem::analyses::statics::{self, StaticSolution};
use fem::core::field::{Field, Spot};
use fem::core::quadrature::gauss_legendre;
use fem::io::scene;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

const PLATE: &str = r#"
title = "a plate at rest"
analysis = "static"
mesh = { rectangle = ["12 mm", "6 mm"], cells = [3, 2] }
materials.tape = { library = "AS4/3502" }
materials.resin = { library = "3502 resin" }
laminate = { plies = "[0/45/90]", material = "tape", ply_thickness = "0.2 mm", layers = [2, 1], interface = "resin" }
element = { kind = "hermite-prism", z_derivatives = "layer-wise" }
failure = { criteria = ["hashin-1980", "octahedral"], window = "element", plies = "mean" }
[[support]]
group = "x-min"
at = "all"
fix = ["U10", "U20", "U30"]
[[load]]
pressure = "10 kPa"
face = "top"
"#;

/// The plate at rest with fields as `fields` says.
fn at_rest(fields: &str) -> (Case, Model, StaticSolution) {
    let case = plate().text(&format!("{PLATE}[output]\nfields = {fields}\n"));
    case.fem("run", &["--out", "out"]).good();
    let path = case.folder().join("plate/scene.toml");
    let model = Model::new(scene::read(&path).unwrap(), &Registry::standard()).unwrap();
    let solution = statics::solve(&model, NonZeroUsize::MIN).unwrap();
    (case, model, solution)
}

/// A quad that holds a point, and the place in it.
fn locate(model: &Model, x: f64, y: f64) -> (usize, [f64; 2]) {
    let plane = &model.plate.plane;
    (0..plane.quads.len()).find_map(|q| Some((q, plane.corners(q).locate([x, y])?))).unwrap()
}

fn ply_at(model: &Model, z: f64) -> usize {
    let boundaries = model.laminate.boundaries();
    boundaries[1..boundaries.len() - 1].iter().take_while(|b| **b < z).count()
}

#[test]
fn displacements_are_those_of_the_model_at_every_point() {
    for cells in ["lagrange", "subdivided"] {
        let (case, model, solution) = at_rest(&format!("{{ cells = \"{cells}\" }}"));
        let field = Field::new(&model.plate, &model.laminates, &*model.element, &solution.u);
        let largest = solution.u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for name in ["plate", "plies", "interfaces"] {
            let frames = series(&case, "out", name);
            let [(time, grid)] = &frames[..] else { panic!("{name}: {} frames", frames.len()) };
            assert_eq!((*time, grid.array("FieldData", "TimeValue").values[0]), (0.0, 0.0));
            let displacement = grid.points("displacement");
            assert_eq!((grid.positions().len(), displacement.len()), (grid.points, grid.points));
            for ([x, y, z], u) in grid.positions().iter().zip(displacement) {
                let (quad, at) = locate(&model, *x, *y);
                let (_, want) = field.at(Spot { quad, at, ply: ply_at(&model, *z), z: *z }).unwrap();
                let same = u.iter().zip(want).all(|(u, want)| close(*u, want, want.abs() + 1e-9 * largest));
                assert!(same, "{name} at {x} {y} {z}: {u:?}, not {want:?}");
            }
        }
        let plate = &series(&case, "out", "plate")[0].1;
        // 6 quads by 2 layers; 10 x 7 points in the plane, 7 levels.
        let (version, count, points) = if cells == "lagrange" { ("2.2", 12, 64) } else { ("1.0", 12 * 27, 8) };
        assert_eq!((plate.version.as_str(), plate.cells, plate.points), (version, count, 10 * 7 * 7));
        assert!(plate.connectivity().iter().all(|cell| cell.len() == points));
        assert!(plate.array("Points", "Points").kind == "Float64" && plate.names("PointData") == ["displacement"]);
        if cells == "subdivided" {
            assert!((volume(plate) / (12e-3 * 6e-3 * 0.6e-3) - 1.0).abs() < 1e-12);
        }
    }
}

/// Stresses are means over a ply of a cell, and tractions over an interface, here integrated point by point.
#[test]
fn stresses_are_means_over_plies_and_interfaces() {
    let (case, model, solution) = at_rest("true");
    let field = Field::new(&model.plate, &model.laminates, &*model.element, &solution.u);
    let plies = &series(&case, "out", "plies")[0].1;
    assert_eq!(plies.array("CellData", "stress").component_names, ["11", "22", "33", "12", "23", "31"]);
    assert!((volume(plies) / (12e-3 * 6e-3 * 0.6e-3) - 1.0).abs() < 1e-12);
    let boundaries = model.laminate.boundaries();
    let rule = gauss_legendre(6);
    // Cells are rectangles: weights are those of the rule.
    let mean = |quad: usize, ply: usize, z: &[(f64, f64)]| {
        let mut sum = [0.0; 6];
        for (&(r, wr), &(s, ws)) in rule.iter().flat_map(|r| rule.iter().map(move |s| (r, s))) {
            for (z, wz) in z {
                let (strain, _) = field.at(Spot { quad, at: [r, s], ply, z: *z }).unwrap();
                let stress = field.stress(quad, (ply, *z), &strain).to_ply(model.laminate.plies[ply].angle);
                sum.iter_mut().zip(stress.0).for_each(|(sum, s)| *sum += wr * ws * wz / 8.0 * s);
            }
        }
        sum
    };
    let largest = plies.cells("stress").iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    assert!(largest > 1e5, "{largest}");
    let stresses = plies.tuples::<6>("CellData", "stress");
    for (cell, stress) in stresses.iter().enumerate() {
        let (quad, ply) = (cell / 3, cell % 3);
        assert_eq!(plies.cells("ply")[cell], ply as f64 + 1.0);
        assert_eq!(plies.cells("angle_deg")[cell], [0.0, 45.0, 90.0][ply]);
        assert_eq!((plies.cells("cell")[cell], plies.cells("material")[cell]), (quad as f64 + 1.0, 0.0));
        let half = 0.5 * (boundaries[ply + 1] - boundaries[ply]);
        let middle = boundaries[ply] + half;
        let z: Vec<(f64, f64)> = rule.iter().map(|(q, w)| (middle + half * q, *w)).collect();
        let want = mean(quad, ply, &z);
        let same = stress.iter().zip(want).all(|(s, want)| close(*s, want, want.abs() + 1e-6 * largest));
        assert!(same, "{cell}: {stress:?}, not {want:?}");
        // The cell lies where the quad and the ply do.
        let centre = model.plate.plane.corners(quad).centroid();
        let points = plies.connectivity()[cell].iter().map(|p| plies.positions()[*p]).collect::<Vec<_>>();
        let at = |d: usize| points.iter().map(|p| p[d]).sum::<f64>() / 8.0;
        assert!((at(0) - centre[0]).abs() + (at(1) - centre[1]).abs() + (at(2) - middle).abs() < 1e-12);
    }
    // Tractions follow from the stiffness of the resin, of both sides of an interface.
    let interfaces = &series(&case, "out", "interfaces")[0].1;
    assert_eq!((interfaces.cells, interfaces.array("CellData", "shear_traction").component_names.len()), (12, 2));
    let resin = model.materials[1].elastic.stiffness();
    let normal = interfaces.cells("normal_traction");
    let shear = interfaces.tuples::<2>("CellData", "shear_traction");
    let largest = normal.iter().chain(shear.as_flattened()).fold(0.0_f64, |m, s| m.max(s.abs()));
    for (cell, (normal, shear)) in normal.iter().zip(shear).enumerate() {
        let (quad, below) = (cell / 2, cell % 2);
        assert_eq!(interfaces.cells("ply_below")[cell], below as f64 + 1.0);
        // Plies 1 and 2 share a cell, ply 3 has a layer of cells of its own: strains jump everywhere.
        let sides = [below, below + 1];
        let mut want = [0.0; 6];
        for (side, &(r, wr), &(s, ws)) in
            sides.iter().flat_map(|side| rule.iter().flat_map(move |r| rule.iter().map(move |s| (*side, r, s))))
        {
            let (strain, _) = field.at(Spot { quad, at: [r, s], ply: side, z: boundaries[below + 1] }).unwrap();
            let stress = fem::core::tensor::stress(&resin, &strain);
            want.iter_mut().zip(stress.0).for_each(|(w, s)| *w += wr * ws / 4.0 / sides.len() as f64 * s);
        }
        let same = [(*normal, want[2]), (shear[0], want[5]), (shear[1], want[4])];
        assert!(same.iter().all(|(a, b)| close(*a, *b, b.abs() + 1e-6 * largest)), "{cell}: {same:?}");
    }
}

#[test]
fn indices_are_those_of_the_criteria_for_the_stresses_beside_them() {
    let (case, model, _) = at_rest("true");
    for (name, number, stress) in [("plies", 0, "stress"), ("interfaces", 1, "")] {
        let grid = &series(&case, "out", name)[0].1;
        let (label, criterion) = &model.criteria[number];
        let (index, mode) = (grid.cells(&format!("{label} index")), grid.cells(&format!("{label} mode")));
        assert!(index.iter().all(|i| *i > 0.0), "{index:?}");
        assert!(mode.iter().all(|m| (1.0..=criterion.info().modes.len() as f64).contains(m)), "{mode:?}");
        if stress.is_empty() {
            continue;
        }
        for ((s, index), mode) in grid.tuples::<6>("CellData", stress).iter().zip(index).zip(mode) {
            let mut all = vec![0.0; criterion.info().modes.len()];
            criterion.indices(&fem::core::tensor::Stress6::new(*s), &model.materials[0], &mut all);
            let want = all.iter().fold(0.0_f64, |m, i| m.max(*i));
            assert!((index / want - 1.0).abs() < 1e-5, "{index}, not {want}");
            assert_eq!(all.iter().position(|i| *i == want).unwrap() as f64 + 1.0, *mode);
        }
    }
}

/// A strip of one material under tension: its displacement is linear, to the last digit that a file keeps.
#[test]
fn a_linear_displacement_comes_back_exactly() {
    let scene = PLATE
        .replace(
            "materials.tape = { library = \"AS4/3502\" }",
            "materials.tape = { e = \"70 GPa\", nu = 0.3, density = \"2.7 g/cm^3\" }",
        )
        .replace("[0/45/90]", "[0]3")
        .replace("fix = [\"U10\", \"U20\", \"U30\"]", "fix = [\"U10\", \"U12\", \"U13\"]")
        .replace("criteria = [\"hashin-1980\", \"octahedral\"], ", "")
        .replace(
            "pressure = \"10 kPa\"\nface = \"top\"",
            "group = \"x-max\"\nforce_per_length = [\"42 N/mm\", \"0 N/mm\", \"0 N/mm\"]",
        );
    let hold = "[[support]]\nrestrain = \"rigid-motions\"\n";
    for cells in ["lagrange", "subdivided"] {
        let case = plate().text(&format!("{scene}{hold}[output]\nfields = {{ cells = \"{cells}\" }}\n"));
        case.fem("run", &["--out", "out"]).good();
        let grid = &series(&case, "out", "plate")[0].1;
        // 42 N/mm on 0.6 mm: 70 MPa, a strain of 1e-3.
        for ([x, ..], u) in grid.positions().iter().zip(grid.points("displacement")) {
            assert!(close(u[0], 1e-3 * x, 1e-3 * x + 1e-11), "{x}: {u:?}");
        }
        let stresses = &series(&case, "out", "plies")[0].1;
        for s in stresses.tuples::<6>("CellData", "stress") {
            let want = [70e6, 0.0, 0.0, 0.0, 0.0, 0.0];
            assert!(s.iter().zip(want).all(|(s, want)| close(*s, want, 70e6)), "{s:?}");
        }
    }
}

#[test]
fn every_natural_mode_is_a_frame() {
    let modes = PLATE.replace("\"static\"", "\"modes\"\nmodes = { count = 3 }");
    let modes = format!("{}[output]\nfields = true\n", &modes[..modes.find("[[load]]").unwrap()]);
    let case = plate().text(&modes);
    case.fem("run", &["--out", "out"]).good();
    let frequencies = case.summary("out")["frequencies_Hz"].as_array().unwrap().clone();
    for name in ["plate", "plies", "interfaces"] {
        let frames = series(&case, "out", name);
        assert_eq!(frames.iter().map(|f| f.0).collect::<Vec<_>>(), [1.0, 2.0, 3.0]);
        for ((_, grid), frequency) in frames.iter().zip(&frequencies) {
            assert_eq!(grid.array("FieldData", "frequency_Hz").values, [frequency.as_f64().unwrap()]);
            assert!(grid.points("displacement").iter().flatten().any(|u| u.abs() > 1e-3), "unit modal mass");
            assert!(!grid.names("CellData").iter().any(|name| name.ends_with("index")), "a mode has no size");
        }
    }
}
