//! Every option of gmsh that changes a file, and files that no program writes: read, or refused with a remedy.

use std::collections::BTreeSet;

use super::*;

/// Result expected of a file.
enum Want {
    /// Cells, and whether groups are `plate` of all of them, `clamped` of 2 edges and `tip` of a node; part of the one
    /// warning, or "" for none.
    Read(usize, Have, &'static str),
    /// What the message holds.
    Refused(&'static [&'static str]),
}
use Want::{Read, Refused};

#[derive(PartialEq)]
enum Have {
    Usual,
    /// These names.
    Named(&'static [&'static str]),
}
use Have::{Named, Usual};

const PLAIN: Want = Read(8, Usual, "");

const FILES: &[(&str, Want)] = &[
    ("plain", PLAIN),
    ("binary", PLAIN),
    ("version-1", Refused(&["not a mesh of gmsh, Abaqus or Nastran", "msh41"])),
    ("version-22", PLAIN),
    ("version-22-binary", PLAIN),
    ("version-40", PLAIN),
    ("save-all", PLAIN),
    ("save-all-no-groups", Refused(&["no physical group holds a cell", "Physical Surface(\"plate\")"])),
    ("save-parametric", PLAIN),
    ("save-parametric-binary", PLAIN),
    ("save-groups-of-nodes", PLAIN),
    ("save-groups-of-elements", PLAIN),
    ("save-topology", PLAIN),
    ("scaled", PLAIN),
    ("reclassified", PLAIN),
    ("serendipity", PLAIN),
    ("second-order", PLAIN),
    ("third-order", Refused(&["has the type Lin4", "Mesh.ElementOrder = 1"])),
    ("triangles", Read(0, Usual, "")),
    ("partitioned", PLAIN),
    ("partitioned-binary", PLAIN),
    ("partitioned-ghosts", PLAIN),
    ("partitioned-physicals", PLAIN),
    ("partitioned-old-style", PLAIN),
    ("partitioned-split_1", Refused(&["one of several files", "Mesh.PartitionSplitMeshFiles = 0"])),
    ("partitioned-split_2", Refused(&["one of several files", "Mesh.PartitionSplitMeshFiles = 0"])),
    ("periodic", PLAIN),
    ("periodic-binary", PLAIN),
    ("renumbered", PLAIN),
    ("huge-tags", PLAIN),
    ("embedded-point", Read(0, Named(&["inside", "plate"]), "")),
    ("embedded-line", Read(0, Named(&["inside", "plate"]), "")),
    ("offset", PLAIN),
    ("tilted", Refused(&["lies at z = 2", "must be flat in x and y"])),
    ("upright", Refused(&["must be flat in x and y"])),
    ("clockwise", Read(8, Usual, "8 of 8 cells were clockwise")),
    ("two-surfaces", PLAIN),
    ("doubled-nodes", Refused(&["lie at the same point", "removeDuplicateNodes()"])),
    ("joined-nodes", Read(8, Named(&["plate"]), "")),
    ("mixed", Read(12, Named(&["clamped", "plate", "tip"]), "")),
    ("extruded", Refused(&["has the type Hex8", "save no volumes", "plies come from the scene"])),
    ("extruded-bottom", Read(8, Named(&["plate"]), "surface elements belong to no physical group")),
    ("overlapping-groups", Read(8, Named(&["clamped", "left half", "plate", "tip"]), "")),
    ("names", Read(8, Named(&["a \"quoted\" Pläte, 板 ", "clamped", "tip"]), "")),
    ("one-name-two-dimensions", Refused(&["\"plate\" occurs with dimension 1 and 2", "its own name"])),
    // gmsh gives a name to one group of a dimension; the other one is called by its number.
    ("one-name-twice", Read(8, Named(&["9", "clamped", "plate", "tip"]), "")),
    ("no-groups", Refused(&["no physical group holds a cell"])),
    ("node-data", PLAIN),
    ("appended", Refused(&["a second section $PhysicalNames", "save once"])),
    ("other-stl", Refused(&["not a mesh of gmsh, Abaqus or Nastran"])),
    ("other-vtk", Refused(&["not a mesh of gmsh, Abaqus or Nastran"])),
    ("other-unv", Refused(&["not a mesh of gmsh, Abaqus or Nastran"])),
    ("other-inp", Read(8, Named(&["Line1", "Surface1", "clamped", "plate"]), "")),
    // Both the line and the surface of the clamped side have the number 1.
    ("other-bdf", Read(8, Named(&["pid-1/cells", "pid-1/edges"]), "stands for sets of several kinds")),
    ("other-geo-unrolled", Refused(&["not a mesh of gmsh, Abaqus or Nastran"])),
    ("crlf", PLAIN),
    ("comments", PLAIN),
    ("trailing", PLAIN),
    ("empty", Refused(&["not a mesh of gmsh, Abaqus or Nastran"])),
    ("size-4", Refused(&[":2: unusable header", "`1 8`"])),
    ("big-endian", Refused(&[":2: unusable header", "little-endian"])),
    ("huge-count", Refused(&["$Nodes announces 999999999999999999 entries and holds 15"])),
    ("huge-block", Refused(&["element definition (9 of 18446744073709551615)"])),
];

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/odd-meshes"))
}

/// What is wrong with what became of a file, if anything.
fn wrong(name: &str, want: &Want) -> Option<String> {
    let bytes = std::fs::read(folder().join(format!("{name}.msh"))).unwrap();
    let unit = if name == "scaled" { 1e-6 } else { 1e-3 };
    match (parse(&bytes, "plate.msh", unit), want) {
        (Err(error), Refused(words)) => {
            let message = error.to_string();
            let right = message.starts_with("plate.msh") && words.iter().all(|word| message.contains(word));
            (!right).then(|| format!("{name}: {message}"))
        }
        (Ok(FileMesh { mesh, warnings }), Read(cells, groups, warning)) => {
            let names: Vec<&str> = mesh.groups.keys().map(String::as_str).collect();
            let group = |name: &str| mesh.groups.get(name).map_or((0, 0), |g| (g.nodes.len(), g.edges.len()));
            let usual = *groups != Usual
                || names == ["clamped", "plate", "tip"]
                    && [group("clamped"), group("plate"), group("tip")] == [(3, 2), (15, 0), (1, 0)]
                    && points_of(&mesh, "tip") == [[20_000, 10_000]];
            let named = match groups {
                Usual => true,
                Named(wanted) => names == *wanted,
            };
            // Embedded geometry is meshed as gmsh likes.
            let counted = *cells == 0 || mesh.quads.len() == *cells;
            let warned = match &warnings[..] {
                [] => warning.is_empty(),
                [one] => !warning.is_empty() && one.contains(warning),
                _ => false,
            };
            let whole = (mesh.area() / 2e-4 - 1.0).abs() < 1e-9;
            (!(usual && named && counted && warned && whole)).then(|| {
                format!("{name}: {} cells, {} m2, groups {names:?}, {warnings:?}", mesh.quads.len(), mesh.area())
            })
        }
        (Ok(read), Refused(_)) => Some(format!("{name} was read, {} cells", read.mesh.quads.len())),
        (Err(error), Read(..)) => Some(format!("{name}: {error}")),
    }
}

#[test]
fn every_file_is_read_or_refused_with_a_remedy() {
    let all = FILES.iter().filter_map(|(name, want)| wrong(name, want));
    assert_eq!(all.collect::<Vec<_>>(), [""; 0]);
    let listed: BTreeSet<String> = FILES.iter().map(|(name, _)| format!("{name}.msh")).collect();
    let names = std::fs::read_dir(folder()).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap());
    assert_eq!(names.filter(|name| name.ends_with(".msh")).collect::<BTreeSet<_>>(), listed);
}
