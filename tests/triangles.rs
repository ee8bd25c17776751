//! Plates of triangles: the wedge on every path, held against the hexahedron of as many nodes along each side.

use crate::support::{Case, plate, root, strip};
use fem::core::domain::Corners;
use fem::core::mesh::PlaneMesh;
use fem::io::gmsh::{self, Encoding};
use serde_json::Value;
use std::fs;

/// A rectangle of 60 x 40 mm, m, whose cells are cut along diagonals that are mirror images of each other.
fn triangles(nx: usize, ny: usize) -> Vec<u8> {
    let lines = |n: usize, side: f64| -> Vec<f64> { (0..=n).map(|i| side * i as f64 / n as f64).collect() };
    let mut mesh = PlaneMesh::rectangle(&lines(nx, 60e-3), &lines(ny, 40e-3));
    let halves = |(k, quad): (usize, &Corners<u32>)| {
        let [a, b, c, d] = quad.four();
        let rising = (2 * (k % nx) < nx) == (2 * (k / nx) < ny);
        let pair = if rising { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        pair.map(Corners::from)
    };
    mesh.quads = mesh.quads.iter().enumerate().flat_map(halves).collect();
    mesh.quad_tags = (1..=mesh.quads.len() as u64).collect();
    mesh.groups.values_mut().filter(|group| group.dim == 2).for_each(|group| {
        group.quads = (0..mesh.quads.len() as u32).collect();
    });
    let mut file = Vec::new();
    gmsh::write(&mut file, &mesh, 1e-3, Encoding::Ascii).unwrap();
    file
}

/// A scene of `tests/data/scenes` with hexahedra on its own mesh of `nx` x `ny` cells, and with wedges on triangles.
fn both(name: &str, [nx, ny]: [usize; 2], edits: &[(&str, &str)]) -> [Case; 2] {
    let text = fs::read_to_string(root().join("tests/data/scenes").join(name)).unwrap();
    let text = edits.iter().fold(text, |text, (from, to)| {
        assert_eq!(text.matches(from).count(), 1, "{from:?}");
        text.replace(from, to)
    });
    let lines = |mesh: &str, element: &str| -> String {
        let keep = text.lines().filter(|line| !line.starts_with("mesh = ") && !line.starts_with("element = "));
        let mut lines: Vec<&str> = keep.collect();
        lines.splice(1..1, [mesh, element]);
        lines.join("\n")
    };
    let quads = format!("mesh = {{ rectangle = [\"60 mm\", \"40 mm\"], cells = [{nx}, {ny}] }}");
    let of_file = "mesh = { file = \"plate.msh\", unit = \"mm\" }";
    let hexahedra = plate().text(&lines(&quads, "element = { kind = \"hex20\" }"));
    let wedges = plate().text(&lines(of_file, "element = { kind = \"wedge15\" }")).mesh_bytes(triangles(nx, ny));
    [hexahedra, wedges]
}

/// The number of a key, wherever it stands in a summary.
fn number(value: &Value, key: &str) -> Option<f64> {
    let object = value.as_object()?;
    object.get(key).and_then(Value::as_f64).or_else(|| object.values().find_map(|inner| number(inner, key)))
}

/// Runs both and holds numbers of their summaries against each other.
#[track_caller]
fn agree(cases: &[Case; 2], keys: &[&str], tolerance: f64) {
    let [hexahedra, wedges] = cases.each_ref().map(|case| {
        case.fem("run", &["--out", "out"]).good();
        case.summary("out")
    });
    for key in keys {
        let [a, b] = [&hexahedra, &wedges].map(|summary| number(summary, key).unwrap());
        assert!((b / a - 1.0).abs() < tolerance, "{key}: {a} of hexahedra, {b} of wedges");
    }
}

#[test]
fn an_impact_with_everything_that_is_written() {
    let cases = both("impact-everything-written.toml", [8, 6], &[]);
    agree(&cases, &["peak_force_N"], 0.03);
    let [hexahedra, wedges] = cases;
    assert_eq!(wedges.names("out"), hexahedra.names("out"));
    let count = |case: &Case| case.read("out/fields/plate.pvd").matches("DataSet ").count();
    assert_eq!(count(&wedges), count(&hexahedra));
    let said = wedges.fem("check", &[]).good().stdout;
    assert!(said.contains("96 triangles, 63 nodes"), "{said}");
}

#[test]
fn large_deflections_of_the_full_plate_and_reduced() {
    // Close to the longest stable step: a march of the full plate evaluates its forces at each.
    let full = both("impact-membrane-full.toml", [12, 8], &[("0.02 us", "0.05 us")]);
    let reduced = both("impact-membrane-reduced.toml", [12, 8], &[]);
    [full, reduced].iter().for_each(|cases| agree(cases, &["peak_force_N"], 0.03));
}

#[test]
fn a_plate_at_rest_folded_by_half_a_turn() {
    let cases = both("static-hex20-half-turn.toml", [12, 8], &[]);
    agree(&cases, &["w_m"], 0.02);
}

#[test]
fn delaminations_grow_between_triangles_as_between_quadrilaterals() {
    let edges = ["x-min", "x-max", "y-min", "y-max"]
        .map(|edge| format!("{{ group = \"{edge}\", at = \"bottom\", fix = [\"U30\"] }}"))
        .join(", ");
    let scene = |mesh: &str| {
        format!(
            "title = \"growth\"\nsymmetry = \"quarter\"\nmesh = {mesh}\n\
             effects = {{ damage = \"off\", delamination = \"growth\" }}\ndelamination = {{ penalty = \"2e4 N/mm^3\" }}\n\
             support = [{edges}, {{ restrain = \"rigid-motions\" }}]\n\
             impactor = {{ mass = \"1 kg\", velocity = \"5 m/s\", at = {{ x = \"30 mm\", y = \"20 mm\" }}, patch_radius = \"3 mm\" }}\n\
             contact = {{ law = \"hertz\", k = \"4e9 N/m^1.5\" }}\n\
             march = {{ integrator = {{ name = \"generalized-alpha\", rho = 0.5 }}, step = \"2 us\", end = \"450 us\" }}\n\
             laminate = {{ plies = \"[0/90/0]\", material = \"tape\", ply_thickness = \"1 mm\", layers = 3 }}\n\
             materials.tape = {{ library = \"IM7/8552\", Zt = \"20 MPa\", S13 = \"25 MPa\" }}\n"
        )
    };
    let quads = plate().text(&scene("{ rectangle = [\"60 mm\", \"40 mm\"], cells = [12, 10] }"));
    let wedges = plate().text(&scene("{ file = \"plate.msh\", unit = \"mm\" }")).mesh_bytes(triangles(12, 10));
    agree(&[quads, wedges], &["peak_force_N", "projected_area_mm2", "dissipated_J"], 0.03);
}

#[test]
fn elements_and_meshes_that_do_not_fit_are_refused_with_what_helps() {
    let refused = |case: Case, words: &[&str]| {
        let said = case.fem("check", &[]);
        let text = said.stderr.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert_eq!(said.status, 1, "{said:#?}");
        words.iter().for_each(|words| assert!(text.contains(words), "{words:?}: {text}"));
    };
    let [quads, wedges] = both("modes-mirror.toml", [4, 4], &[("symmetry = \"mirror-x\"\n", "")]);
    refused(wedges.scene("wedge15", "mitc4"), &["stands on quadrilaterals,", "hermite-prism", "Recombine Surface"]);
    refused(quads.scene("hex20", "wedge15"), &["stands on triangles", "hex20"]);
    let mixed = strip().mesh_bytes(fs::read(root().join("tests/data/odd-meshes/mixed.msh")).unwrap());
    let said = mixed.fem("check", &[]).good().stdout;
    assert!(said.contains(" cells, "), "{said}");
}

/// A scene on a mesh of `tests/data/meshes`, whose cells are divided in four `refine` times.
fn of_gmsh(mesh: &str, refine: usize, scene: &str) -> Case {
    let bytes = fs::read(root().join("tests/data/meshes").join(format!("{mesh}.msh"))).unwrap();
    plate()
        .text(&format!("mesh = {{ file = \"plate.msh\", unit = \"mm\", refine = {refine} }}\n{scene}"))
        .mesh_bytes(bytes)
}

#[test]
fn impacts_on_meshes_straight_out_of_gmsh() {
    for (mesh, [x, y]) in
        [("rectangle", [30, 20]), ("disc", [0, 0]), ("hole", [20, 20]), ("l-shape", [12, 12]), ("mixed", [30, 20])]
    {
        let case = of_gmsh(
            mesh,
            0,
            &format!(
                "title = \"{mesh}\"\nmaterials.tape = {{ library = \"AS4/3502\" }}\n\
                 laminate = {{ plies = \"[0/45/-45/90]s\", material = \"tape\", ply_thickness = \"0.13208 mm\", layers = [8] }}\n\
                 impactor = {{ mass = \"100 g\", velocity = \"2 m/s\", at = {{ x = \"{x} mm\", y = \"{y} mm\" }} }}\n\
                 contact = {{ law = \"hertz\", k = \"1.07e5 N/mm^1.5\" }}\nreduction = {{ method = \"ritz\", vectors = 20 }}\n\
                 march = {{ step = \"1 us\", end = \"100 us\" }}\n\
                 support = [{{ group = \"rim\", at = \"all\", fix = [\"U10\", \"U20\", \"U30\"] }}]\n\
                 {}",
                if mesh == "mixed" {
                    "failure = { criteria = [\"puck\"] }\noutput = { maps = true, fields = { every = \"50 us\" } }\n"
                } else {
                    "effects = { damage = \"off\" }\n"
                }
            ),
        );
        case.fem("run", &["--out", "out"]).good();
        let summary = case.summary("out");
        let force = number(&summary, "peak_force_N").unwrap();
        assert!(force > 50.0 && force < 300.0, "{mesh}: {force} N");
        let fields = |case: &Case| case.read("out/fields/plies.pvd").matches("DataSet ").count();
        assert!(mesh != "mixed" || fields(&case) == 3);
    }
}

#[test]
fn clamped_plates_straight_out_of_gmsh_have_the_frequencies_of_theory() {
    // ω a² √(ρh/D) of the lowest mode: 10.2158 of a circle of radius a; of a rectangle by series, 27.01 for sides of 1.5 a and a.
    let lowest = |mesh: &str| {
        let case = of_gmsh(
            mesh,
            1,
            "title = \"steel\"\nanalysis = \"modes\"\n\
             materials.steel = { e1 = \"206 GPa\", e2 = \"206 GPa\", e3 = \"206 GPa\", nu12 = 0.3, nu13 = 0.3, nu23 = 0.3, \
             g12 = \"79.2307692 GPa\", g13 = \"79.2307692 GPa\", g23 = \"79.2307692 GPa\", density = \"7.9 g/cm^3\" }\n\
             laminate = { plies = \"[0]\", material = \"steel\", ply_thickness = \"0.8 mm\", layers = [1] }\n\
             support = [{ group = \"rim\", at = \"all\", fix = [\"U10\", \"U20\", \"U30\", \"U13\", \"U23\", \"U31\", \"U32\"] }]\n\
             modes = { count = 2 }\n",
        );
        case.fem("run", &["--out", "out"]).good();
        let (_, rows) = case.table("out/modes.csv");
        rows[0][1].parse::<f64>().unwrap()
    };
    let factor = |hz: f64, a: f64| {
        let h = 0.8e-3_f64;
        std::f64::consts::TAU * hz * a * a * (7900.0 * 12.0 * (1.0 - 0.09) / (206e9 * h * h)).sqrt()
    };
    let circle = factor(lowest("disc"), 30e-3) / 10.2158 - 1.0;
    // Between the nodes of the rim the plate moves a little, and shear is not in the theory: both make it softer.
    assert!((-1e-2..0.0).contains(&circle), "{circle:e}");
    for mesh in ["rectangle", "mixed"] {
        let error = factor(lowest(mesh), 40e-3) / 27.01 - 1.0;
        assert!((-1e-2..0.0).contains(&error), "{mesh}: {error:e}");
    }
}
