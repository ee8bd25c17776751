//! What is written is read again.

use super::*;
use crate::gmsh::{Encoding, write};
use fem_core::mesh::{Graded, Outline};

fn read_again(mesh: &PlaneMesh, unit: f64, encoding: Encoding) -> FileMesh {
    let mut bytes = Vec::new();
    write(&mut bytes, mesh, unit, encoding).unwrap();
    parse(&bytes, "written.msh", unit).unwrap_or_else(|e| panic!("{e}"))
}

/// Coordinates may differ in the last bit where no number in the unit is read as that length.
fn same(a: &PlaneMesh, b: &PlaneMesh) -> bool {
    let near = |(p, q): (&[f64; 2], &[f64; 2])| (0..2).all(|d| (p[d] - q[d]).abs() <= f64::EPSILON * p[d].abs());
    let points = a.points.len() == b.points.len() && a.points.iter().zip(&b.points).all(near);
    points && PlaneMesh { points: b.points.clone(), ..a.clone() } == *b
}

/// With nodes in the middles of all sides.
#[test]
fn bent_sides() {
    for bent in [mesh("second-order.msh").mesh, parse(BENT.as_bytes(), "bent.inp", 1e-3).unwrap().mesh] {
        for encoding in [Encoding::Ascii, Encoding::Binary] {
            let again = read_again(&bent, 1e-3, encoding).mesh;
            assert!(again.bends.keys().eq(bent.bends.keys()));
            let near = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-17;
            assert!(again.bends.values().zip(bent.bends.values()).all(near));
            assert_eq!((&again.quads, &again.node_tags), (&bent.quads, &bent.node_tags));
        }
    }
}

#[test]
fn meshes_of_files() {
    for name in ["ascii.msh", "binary.msh", "rcm.msh", "sparse.msh", "disk.msh", "unnamed.msh", "circle-fine.msh"] {
        let read = mesh(name).mesh;
        for encoding in [Encoding::Ascii, Encoding::Binary] {
            let again = read_again(&read, 1e-3, encoding);
            assert_eq!((again.mesh, again.warnings), (read.clone(), vec![]), "{name} {encoding:?}");
        }
    }
}

#[test]
fn built_in_meshes() {
    let square = Outline::Rectangle { sides: [50e-3; 2] };
    let plates = [(Outline::Disc { radius: 25e-3 }, None), (square, Some(20e-3)), (square, None)];
    for (outline, support) in plates {
        let impact = [3e-3, -2e-3];
        let built = Graded { outline, support, window: None, impact, size: 2e-3, edge_size: 5e-3 }.mesh().unwrap();
        for encoding in [Encoding::Ascii, Encoding::Binary] {
            // In metres to the last bit.
            assert_eq!(read_again(&built, 1.0, encoding).mesh, built);
            let millimetres = read_again(&built, 1e-3, encoding).mesh;
            assert!(same(&millimetres, &built), "{outline:?}");
            assert_eq!(read_again(&millimetres, 1e-3, encoding).mesh, millimetres);
        }
    }
}

#[test]
fn groups_that_share_cells_edges_and_nodes() {
    let line: Vec<f64> = (0..4).map(f64::from).collect();
    let mut plate = PlaneMesh::rectangle(&line, &line);
    let group = |dim, nodes: &[u32]| fem_core::mesh::Group { dim, nodes: nodes.to_vec(), ..Default::default() };
    let left = fem_core::mesh::Group { quads: vec![0, 3], ..group(2, &[0, 1, 4, 5, 8, 9]) };
    let corner = fem_core::mesh::Group { edges: vec![[0, 1], [0, 4]], ..group(1, &[0, 1, 4]) };
    plate.groups.extend([
        ("left \"half\" Pläte".to_owned(), left),
        ("round the corner".to_owned(), corner),
        ("two".to_owned(), group(0, &[5, 10])),
        ("one".to_owned(), group(0, &[10])),
    ]);
    for encoding in [Encoding::Ascii, Encoding::Binary] {
        assert_eq!(read_again(&plate, 1.0, encoding).mesh, plate);
    }
    plate.node_tags[3] = 1;
    assert!(write(&mut Vec::new(), &plate, 1.0, Encoding::Ascii).unwrap_err().to_string().contains("twice"));
}
