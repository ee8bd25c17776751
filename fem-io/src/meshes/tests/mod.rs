mod odd;
mod others;
mod plates;
mod refusals;
mod written;

use std::path::PathBuf;

use super::*;
use fem_core::mesh::PlaneMesh;

fn path(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/mesh")).join(name)
}

fn data(name: &str) -> Vec<u8> {
    std::fs::read(path(name)).unwrap()
}

fn text(name: &str) -> String {
    String::from_utf8(data(name)).unwrap()
}

/// A mesh file, read in mm.
fn mesh(name: &str) -> FileMesh {
    parse(&data(name), name, 1e-3).unwrap_or_else(|e| panic!("{e}"))
}

/// Edits of a text that must each apply, exactly once.
fn edited(text: &str, edits: &[(&str, &str)]) -> String {
    edits.iter().fold(text.to_owned(), |text, (old, new)| {
        assert_eq!(text.matches(old).count(), 1, "{old:?}");
        text.replace(old, new)
    })
}

/// Middles of the cells in micrometres, sorted: what a mesh covers, whatever its numbering.
fn middles(mesh: &PlaneMesh) -> Vec<[i64; 2]> {
    let middle = |q: usize| [0, 1].map(|d| (mesh.corners(q).iter().map(|p| p[d]).sum::<f64>() * 0.25e6).round() as i64);
    let mut all: Vec<_> = (0..mesh.quads.len()).map(middle).collect();
    all.sort_unstable();
    all
}

fn points_of(mesh: &PlaneMesh, group: &str) -> Vec<[i64; 2]> {
    let mut all: Vec<_> =
        mesh.groups[group].nodes.iter().map(|n| mesh.points[*n as usize].map(|x| (x * 1e6).round() as i64)).collect();
    all.sort_unstable();
    all
}

#[test]
fn a_strip_is_read() {
    let FileMesh { mesh, warnings } = mesh("ascii.msh");
    assert_eq!(warnings, [""; 0]);
    assert_eq!((mesh.points.len(), mesh.quads.len()), (15, 8));
    assert_eq!(mesh.node_tags, (1..=15).collect::<Vec<u64>>());
    assert_eq!(mesh.quad_tags, (4..=11).collect::<Vec<u64>>());
    assert_eq!(mesh.quads[0], [0, 4, 12, 11].into());
    assert_eq!(mesh.points[2], [0.03, 0.01]);
    assert!((mesh.area() - 3e-4).abs() < 1e-15);
    let x = [3750, 3750, 11250, 11250, 18750, 18750, 26250, 26250];
    let expected: Vec<_> = x.into_iter().zip([2500, 7500].into_iter().cycle()).map(|(x, y)| [x, y]).collect();
    assert_eq!(middles(&mesh), expected);

    assert_eq!(mesh.groups.keys().collect::<Vec<_>>(), ["clamped", "plate", "tip"]);
    let plate = &mesh.groups["plate"];
    assert_eq!((plate.dim, plate.nodes.len(), plate.edges.len()), (2, 15, 0));
    assert_eq!(plate.quads, (0..8).collect::<Vec<u32>>());
    let clamped = &mesh.groups["clamped"];
    assert_eq!((clamped.dim, &clamped.edges[..]), (1, &[[3, 11], [11, 0]][..]));
    assert_eq!(clamped.nodes, [0, 3, 11]);
    assert_eq!(points_of(&mesh, "clamped"), [[0, 0], [0, 5000], [0, 10000]]);
    let tip = &mesh.groups["tip"];
    assert_eq!((tip.dim, &tip.nodes[..]), (0, &[2][..]));
}

#[test]
fn the_unit_scales_lengths() {
    let inches = parse(&data("ascii.msh"), "strip", 0.0254).unwrap().mesh;
    assert_eq!(inches.points[2], [30.0 * 0.0254, 10.0 * 0.0254]);
    for unit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = parse(&data("ascii.msh"), "strip", unit).unwrap_err();
        assert!(matches!(error.fault, MeshFault::Unit(_)), "{error}");
    }
}

#[test]
fn binary_and_windows_files_give_the_same_mesh() {
    let expected = mesh("ascii.msh");
    assert_eq!(mesh("crlf.msh"), expected);
    let binary = mesh("binary.msh");
    let nearly = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-17;
    assert!(binary.mesh.points.iter().zip(&expected.mesh.points).all(|(a, b)| nearly(a, b)));
    assert_eq!((binary.mesh.quads, binary.mesh.groups), (expected.mesh.quads, expected.mesh.groups));
}

#[test]
fn nodes_are_numbered_by_tag_and_not_by_file_order() {
    let (strip, renumbered) = (mesh("ascii.msh").mesh, mesh("rcm.msh").mesh);
    assert_eq!(renumbered.node_tags, (1..=15).collect::<Vec<u64>>());
    assert_eq!(renumbered.points[0], [0.03, 0.01], "the first node of the file has the number 15");
    assert_eq!(middles(&renumbered), middles(&strip));
    for group in ["clamped", "tip", "plate"] {
        assert_eq!(points_of(&renumbered, group), points_of(&strip, group));
    }
}

#[test]
fn partitions_are_joined_and_parametric_coordinates_skipped() {
    let strip = mesh("ascii.msh");
    assert_eq!(mesh("parametric.msh"), strip);
    let FileMesh { mesh: joined, warnings } = mesh("partitioned.msh");
    assert_eq!((joined.points.len(), joined.quads.len(), warnings), (15, 8, vec![]));
    assert_eq!(middles(&joined), middles(&strip.mesh));
    for group in ["clamped", "tip", "plate"] {
        assert_eq!(points_of(&joined, group), points_of(&strip.mesh, group));
    }
}

#[test]
fn sparse_numbers_are_kept_as_tags_only() {
    let (strip, sparse) = (mesh("ascii.msh").mesh, mesh("sparse.msh").mesh);
    assert_eq!(sparse.node_tags, (0..15).map(|i| 1007 + 10 * i).collect::<Vec<u64>>());
    assert_eq!((&sparse.points, &sparse.quads, &sparse.groups), (&strip.points, &strip.quads, &strip.groups));
}

#[test]
fn order_in_the_file_does_not_matter() {
    let shuffled = edited(
        &text("ascii.msh"),
        &[
            (
                "5\n6\n7\n7.499999999996563 0 2\n14.99999999996962 0 2\n",
                "6\n5\n7\n14.99999999996962 0 2\n7.499999999996563 0 2\n",
            ),
            ("4 1 5 13 12 \n5 12 13 11 4 \n", "5 12 13 11 4 \n4 1 5 13 12 \n"),
            ("2 4 12 \n3 12 1 \n", "3 12 1 \n2 4 12 \n"),
            ("0 3 \"tip\"\n1 2 \"clamped\"\n", "1 2 \"clamped\"\n0 3 \"tip\"\n"),
        ],
    );
    assert_eq!(parse(shuffled.as_bytes(), "shuffled", 1e-3).unwrap(), mesh("ascii.msh"));
}

#[test]
fn clockwise_cells_are_turned_round() {
    let all = mesh("clockwise.msh");
    assert_eq!(middles(&all.mesh), middles(&mesh("ascii.msh").mesh));
    assert!((0..8).all(|q| all.mesh.quality(q).area > 0.0));
    assert_eq!(all.warnings, ["8 of 8 cells were clockwise (the first is 4) and turned round"]);

    let one = edited(&text("ascii.msh"), &[("5 12 13 11 4 \n", "5 4 11 13 12 \n")]);
    let one = parse(one.as_bytes(), "one", 1e-3).unwrap();
    assert_eq!(middles(&one.mesh), middles(&all.mesh));
    assert_eq!(one.warnings, ["1 of 8 cells was clockwise (the first is 5) and turned round"]);
}

#[test]
fn nodes_in_the_middle_bend_the_sides_of_cells() {
    let linear = mesh("disk.msh");
    assert_eq!((linear.mesh.quads.len(), linear.mesh.groups["rim"].edges.len()), (12, 8));
    let octagon = 0.5 * 8.0 * 1e-4 * std::f64::consts::FRAC_PI_4.sin();
    assert!((linear.mesh.area() - octagon).abs() < 1e-12);
    // Eight parabolas through arcs of 45 degrees: 2/3 of chord times sagitta each.
    let half = 0.5 * std::f64::consts::FRAC_PI_4;
    let parabolas = octagon + 8.0 * 2.0 / 3.0 * 1e-4 * 2.0 * half.sin() * (1.0 - half.cos());
    for name in ["second-order.msh", "serendipity.msh"] {
        let FileMesh { mesh, warnings } = mesh(name);
        assert_eq!((mesh.points.len(), mesh.groups["rim"].edges.len()), (linear.mesh.points.len(), 8));
        assert_eq!(middles(&mesh), middles(&linear.mesh), "{name}");
        assert_eq!((mesh.bends.len(), warnings), (8, vec![]));
        assert!((mesh.area() / parabolas - 1.0).abs() < 1e-9, "{name}: {} {parabolas}", mesh.area());
    }
}

/// Two cells of 8 nodes side by side in a file of Abaqus; node 9 is in the middle of the side between them.
const BENT: &str =
    "*NODE\n1,0,0\n2,10,0\n3,20,0\n4,0,10\n5,10,10\n6,20,10\n7,5,0\n8,15,-2\n9,11,5\n10,15,10\n11,20,5\n12,5,10
13,0,5\n14,12,5\n*ELEMENT,TYPE=S8R,ELSET=plate\n1,1,2,5,4,7,9,12,13\n2,2,3,6,5,8,11,10,9\n";

#[test]
fn bent_sides_that_make_no_plate() {
    let sound = parse(BENT.as_bytes(), "bent.inp", 1e-3).unwrap();
    assert_eq!((sound.mesh.bends.len(), sound.warnings), (2, vec![]));
    assert!((sound.mesh.area() / (200e-6 + 2.0 / 3.0 * 20e-6) - 1.0).abs() < 1e-12, "the side between takes and gives");
    // A middle off the middle of a straight side bends nothing.
    let shifted = parse(edited(BENT, &[("7,5,0", "7,3,0")]).as_bytes(), "bent.inp", 1e-3).unwrap();
    assert_eq!((&shifted.mesh.bends, shifted.warnings), (&sound.mesh.bends, vec![]));
    let other = edited(BENT, &[("5,8,11,10,9", "5,8,11,10,14")]);
    let error = parse(other.as_bytes(), "bent.inp", 1e-3).unwrap_err();
    assert_eq!(error.place, FilePlace::Line(18));
    assert!(error.to_string().contains("node 9 in its middle in one cell and node 14 elsewhere"), "{error}");
    let folded = parse(edited(BENT, &[("9,11,5", "9,19,5")]).as_bytes(), "bent.inp", 1e-3).unwrap();
    assert_eq!(folded.mesh.bends.len(), 0, "all sides of the cell that folds");
    assert!(folded.warnings[0].starts_with("1 of 2 cells would fold") && folded.warnings[0].contains("first is 2"));
    let tilted = edited(BENT, &[("9,11,5", "9,11,5,1")]);
    assert!(parse(tilted.as_bytes(), "bent.inp", 1e-3).unwrap_err().to_string().contains("node 9 lies at z = 1"));
    // Left out, a middle is that of the chord.
    let partly = "GRID,1\nGRID,2,,10.\nGRID,3,,10.,10.\nGRID,4,,0.,10.\nGRID,5,,5.,-1.\nCQUAD8,1,1,1,2,3,4,5\n";
    assert!((parse(partly.as_bytes(), "p.bdf", 1.0).unwrap().mesh.area() - 100.0 - 20.0 / 3.0).abs() < 1e-12);
}

#[test]
fn names_of_groups() {
    let unnamed = mesh("unnamed.msh").mesh;
    assert_eq!(unnamed.groups.keys().collect::<Vec<_>>(), ["1", "2", "3"], "called by their numbers");
    assert_eq!(unnamed.groups["2"].edges.len(), 2);

    let strip = text("ascii.msh");
    let odd = edited(&strip, &[("\"plate\"", "\"a \"quoted\" Pläte \"")]);
    assert!(parse(odd.as_bytes(), "odd", 1.0).unwrap().mesh.groups.contains_key("a \"quoted\" Pläte "));
    let reversed = edited(&strip, &[("30 10 2 1 1 4 1 2 3 4", "30 10 2 1 -1 4 1 2 3 4")]);
    assert_eq!(parse(reversed.as_bytes(), "reversed", 1e-3).unwrap(), mesh("ascii.msh"));
    let two = edited(
        &strip,
        &[("30 10 2 1 1 4 1 2 3 4", "30 10 2 2 1 9 4 1 2 3 4"), ("\n3\n0 3", "\n4\n2 9 \"weighed\"\n0 3")],
    );
    let two = parse(two.as_bytes(), "two", 1e-3).unwrap().mesh;
    assert_eq!((two.groups["weighed"].quads.len(), two.quads.len()), (8, 8), "one surface in two groups");
    let same = edited(
        &strip,
        &[("30 10 2 1 1 4 1 2 3 4", "30 10 2 2 1 9 4 1 2 3 4"), ("\n3\n0 3", "\n4\n2 9 \"plate\"\n0 3")],
    );
    assert_eq!(parse(same.as_bytes(), "same", 1e-3).unwrap(), mesh("ascii.msh"), "two groups of one name");
}

#[test]
fn what_is_left_out_is_said() {
    let strip = text("ascii.msh");
    let empty = edited(&strip, &[("\n3\n0 3", "\n4\n1 9 \"free side\"\n0 3")]);
    let warnings = parse(empty.as_bytes(), "empty", 1e-3).unwrap().warnings;
    assert_eq!(warnings, ["the physical group \"free side\" holds no elements and is left out"]);

    let half = edited(
        &strip,
        &[
            ("1 0 0 2 30 10 2 1 1 4 1 2 3 4 \n", "1 0 0 2 30 10 2 1 1 4 1 2 3 4 \n2 0 0 2 30 10 2 0 4 1 2 3 4 \n"),
            ("4 4 1 0\n", "4 4 2 0\n"),
            ("3 11 1 11\n", "4 11 1 11\n"),
            ("2 1 3 8\n", "2 1 3 4\n"),
            ("8 6 7 15 14 \n", "2 2 3 4\n8 6 7 15 14 \n"),
            ("0 3 15 1\n1 3 \n", "0 3 15 1\n1 4 \n"),
        ],
    );
    let half = parse(half.as_bytes(), "half", 1e-3).unwrap();
    assert_eq!((half.mesh.quads.len(), half.mesh.points.len()), (4, 9), "nodes that no cell uses are dropped");
    assert_eq!(half.mesh.node_tags, [1, 4, 5, 6, 10, 11, 12, 13, 14]);
    assert_eq!(half.mesh.groups["clamped"].nodes, [0, 1, 6]);
    let [warning] = &half.warnings[..] else { panic!("{:?}", half.warnings) };
    assert!(warning.starts_with("4 surface elements belong to no physical group"), "{warning}");
}

#[test]
fn a_file_is_read_from_disk() {
    assert_eq!(read(&path("ascii.msh"), 1e-3).unwrap(), mesh("ascii.msh"));
    let error = read(&path("absent.msh"), 1e-3).unwrap_err();
    assert!(matches!(error.fault, MeshFault::Unreadable(_)));
    assert!(error.to_string().contains("absent.msh: cannot read the file"), "{error}");
}
