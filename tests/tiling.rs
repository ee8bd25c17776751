//! Meshes that are not one plate are refused with the place, shown in a picture, and told how to be mended.

use crate::support::{Case, Done, fem, plate};
use fem_core::mesh::{Group, PlaneMesh};
use fem_io::gmsh::{self, Encoding};
use std::fs;

/// Plates of 1 mm, held at `x-min`, under pressure.
const SCENE: &str = r#"
title = "two halves"
analysis = "static"
mesh = { file = "plate.msh", unit = "mm" }
element = { kind = "mitc4" }
materials.tape = { library = "AS4/3502" }
laminate = { plies = "[0/90]s", material = "tape", ply_thickness = "0.25 mm", layers = [4] }
support = [{ group = "left", at = "mid-plane", fix = ["U10", "U20", "U30", "U13", "U23"] }]
load = [{ pressure = "1 kPa" }]
output = { plots = false }
"#;

/// A plate from `low` to `high`, mm.
fn half(low: [f64; 2], high: [f64; 2], cells: [usize; 2]) -> PlaneMesh {
    let [x, y] = [0, 1].map(|d| -> Vec<f64> {
        (0..=cells[d]).map(|i| 1e-3 * (low[d] + (high[d] - low[d]) * i as f64 / cells[d] as f64)).collect()
    });
    PlaneMesh::rectangle(&x, &y)
}

/// Two plates in one mesh: groups `left`, `right` (the outer edges along y), `seam` (the left plate's) and `plate`; nodes of the
/// second one that lie where one of the first does are that one, where `joined` says so.
fn both(a: &PlaneMesh, b: &PlaneMesh, joined: impl Fn([f64; 2]) -> bool) -> Vec<u8> {
    let mut mesh = a.clone();
    let near = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-9;
    let mut number = Vec::new();
    for p in &b.points {
        let known = a.points.iter().position(|q| near(*p, *q)).filter(|_| joined(p.map(|x| x * 1e3)));
        number.push(known.unwrap_or_else(|| {
            mesh.points.push(*p);
            mesh.points.len() - 1
        }) as u32);
    }
    mesh.quads.extend(b.quads.iter().map(|quad| quad.map(|n| number[n as usize])));
    mesh.node_tags = (1..=mesh.points.len() as u64).collect();
    mesh.quad_tags = (1..=mesh.quads.len() as u64).collect();
    let edge = |mesh: &PlaneMesh, name: &str, number: &dyn Fn(u32) -> u32| {
        let edges: Vec<_> = mesh.groups[name].edges.iter().map(|edge| edge.map(number)).collect();
        let mut nodes: Vec<u32> = edges.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        Group { dim: 1, nodes, edges, ..Group::default() }
    };
    let all = Group {
        dim: 2,
        nodes: (0..mesh.points.len() as u32).collect(),
        quads: (0..mesh.quads.len() as u32).collect(),
        ..Group::default()
    };
    mesh.groups = [
        ("left".to_owned(), edge(a, "x-min", &|n| n)),
        ("seam".to_owned(), edge(a, "x-max", &|n| n)),
        ("right".to_owned(), edge(b, "x-max", &|n| number[n as usize])),
        ("plate".to_owned(), all),
    ]
    .into();
    let mut bytes = Vec::new();
    gmsh::write(&mut bytes, &mesh, 1e-3, Encoding::Ascii).unwrap();
    bytes
}

fn case(mesh: Vec<u8>) -> Case {
    plate().text(SCENE).mesh_bytes(mesh)
}

fn flat(done: &Done) -> String {
    done.stderr.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

#[track_caller]
fn refused(case: &Case, words: &[&str]) -> String {
    let done = case.fem("check", &[]);
    let said = flat(&done);
    assert!(done.status == 1 && done.stdout.is_empty(), "{done:?}");
    for words in words {
        assert!(said.contains(words), "{words:?} is not in {said}");
    }
    said
}

fn deflection(case: &Case) -> f64 {
    case.fem("run", &["--out", "out"]).good();
    case.summary("out")["largest_deflection"]["w_m"].as_f64().unwrap().abs()
}

/// Two cells against three along a side of which the ends alone are shared, as `removeDuplicateNodes()` leaves them.
#[test]
fn a_plate_cut_in_two_by_hanging_nodes() {
    let halves = [half([0.0, 0.0], [20.0, 12.0], [4, 2]), half([20.0, 0.0], [40.0, 12.0], [4, 3])];
    let case = case(both(&halves[0], &halves[1], |_| true));
    let words = [
        "plate/plate.msh:",
        "lies on the side of cell",
        "at (20.0000, 6.0000) mm (one of 3 such places, which `fem mesh --picture` shows)",
        "share one curve (Coherence; or BooleanFragments)",
        "removeDuplicateNodes() cannot join them",
    ];
    refused(&case, &words);
    case.fem("mesh", &[]);
    let drawn = fem(case.folder(), &["mesh", "plate/plate.msh", "--picture", "drawn"]);
    assert!(drawn.status == 1 && drawn.stderr.contains("lies on the side of cell"), "{drawn:?}");
    assert_eq!(drawn.stdout, "  written   drawn/plate.svg\n  written   drawn/plate.png\n");
    let svg = fs::read_to_string(case.folder().join("drawn/plate.svg")).unwrap();
    assert!(svg.contains(">node on a side<"), "{svg}");
    assert_eq!(fem(case.folder(), &["mesh", "plate/plate.msh"]).status, 1);
}

#[test]
fn cells_over_each_other() {
    let large = half([0.0, 0.0], [20.0, 12.0], [4, 2]);
    for (low, high) in [([3.0, 2.0], [4.0, 3.0]), ([6.0, 3.0], [27.0, 8.0])] {
        let case = case(both(&large, &half(low, high, [2, 2]), |_| true));
        refused(&case, &["plate/plate.msh:", "lie over each other at (", "BooleanDifference", "`fem mesh --picture`"]);
    }
    // All of it twice.
    let twice = both(&large, &large, |_| true);
    refused(&case(twice), &["cells 1 and 9 lie on the same side of the edge", "one of 32 such places", "Coherence;"]);
}

#[test]
fn cells_joined_by_a_corner() {
    let halves = [half([0.0, 0.0], [20.0, 12.0], [4, 2]), half([20.0, 12.0], [40.0, 24.0], [4, 2])];
    refused(
        &case(both(&halves[0], &halves[1], |_| true)),
        &["joined by node 15 alone at (20.0000, 12.0000) mm", "a hinge", "OpenBoundaryPhysicalGroup"],
    );
}

#[test]
fn pieces_that_nothing_holds() {
    let halves = [half([0.0, 0.0], [20.0, 12.0], [4, 2]), half([25.0, 0.0], [45.0, 12.0], [2, 2])];
    let loose = case(both(&halves[0], &halves[1], |_| true));
    let words = ["a piece of the plate (4 of its cells, about (35.0000, 6.0000) mm) can move against the rest"];
    refused(&loose, &words);
    let right = SCENE.replace("group = \"left\"", "group = \"right\"");
    let modes = right
        .replace("\"static\"", "\"modes\"\nmodes = { count = 3 }")
        .replace("load = [{ pressure = \"1 kPa\" }]", "");
    for free in [right, modes] {
        let free = case(both(&halves[0], &halves[1], |_| true)).text(&free);
        refused(
            &free,
            &["a piece of the plate (8 of its cells, about (10.0000, 6.0000) mm) can move against the rest"],
        );
    }
    // Held each, they are two plates, which is worth a word.
    let held = SCENE.replace(
        "support = [",
        "support = [{ group = \"right\", at = \"mid-plane\", fix = [\"U10\", \"U20\", \"U30\", \"U13\", \"U23\"] }, ",
    );
    let held = case(both(&halves[0], &halves[1], |_| true)).text(&held);
    let said = held.fem("check", &[]).good();
    let said = format!("{} {}", said.stdout, said.stderr);
    assert!(
        said.split_whitespace().collect::<Vec<_>>().join(" ").contains("the mesh is 2 pieces that no side joins"),
        "{said}"
    );
    // Tied at an edge, the second follows the first.
    let tied = SCENE.to_owned()
        + "couple = [{ group = \"bridge\", at = \"mid-plane\", dofs = [\"U10\", \"U20\", \"U30\", \"U13\", \"U23\"] }]\n";
    let bridged = both(&halves[0], &halves[1], |_| true);
    let bridged = String::from_utf8(bridged).unwrap().replace("\"seam\"", "\"bridge\"");
    refused(&case(bridged.into_bytes()).text(&tied), &["a piece of the plate (4 of its cells"]);
}

/// A slit from one side to the middle of the plate: by its name it is one, otherwise a mesh that was not joined.
#[test]
fn a_cut_that_is_meant() {
    let halves = [half([0.0, 0.0], [20.0, 12.0], [5, 6]), half([20.0, 0.0], [40.0, 12.0], [5, 6])];
    let slit = both(&halves[0], &halves[1], |p| p[1] > 5.0);
    let whole = both(&halves[0], &halves[1], |_| true);
    refused(
        &case(slit.clone()),
        &["lie at the same point at (20.0000, 0.0000) mm (one of 3", "`mesh.cuts` of the scene"],
    );
    let named = |name: &str| SCENE.replace("unit = \"mm\"", &format!("unit = \"mm\", cuts = [\"{name}\"]"));
    refused(
        &case(slit.clone()).text(&named("seem")),
        &["the mesh has no group of edges `seem`", "did you mean `seam`?"],
    );
    refused(&case(slit.clone()).text(&named("left")), &["lie at the same point"]);
    let cut = case(slit).text(&named("seam"));
    cut.fem("mesh", &[]).good();
    let ratio = deflection(&cut) / deflection(&case(whole));
    assert!(ratio > 1.02, "a plate with a slit bends {ratio} times as far");
}
