//! One plate by several writers and in several formats, and what is wrong with files of lines.

use std::collections::BTreeSet;

use super::*;

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/other-meshes"))
}

fn of(name: &str) -> FileMesh {
    read(&folder().join(name), 1e-3).unwrap_or_else(|e| panic!("{e}"))
}

fn contents(name: &str) -> String {
    std::fs::read_to_string(folder().join(name)).unwrap()
}

/// Edges of a group, whatever their order and direction.
fn edges(mesh: &PlaneMesh, group: &str) -> BTreeSet<[u32; 2]> {
    mesh.groups[group].edges.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect()
}

/// File, names of the groups of the cells and of the clamped side, all names.
type Case = (&'static str, [&'static str; 2], &'static [&'static str]);

#[test]
fn one_plate_in_every_format_is_one_mesh() {
    const GMSH: &[&str] = &["clamped", "plate", "tip"];
    const INP: &[&str] = &["Line4", "Surface1", "clamped", "plate", "tip"];
    let of_both: [Case; 11] = [
        ("gmsh-SHAPE-22.msh", ["plate", "clamped"], GMSH),
        ("gmsh-SHAPE-22-binary.msh", ["plate", "clamped"], GMSH),
        ("gmsh-SHAPE-40.msh", ["plate", "clamped"], GMSH),
        ("gmsh-SHAPE-41-binary.msh", ["plate", "clamped"], GMSH),
        ("gmsh-SHAPE.inp", ["plate", "clamped"], INP),
        ("gmsh-SHAPE-free.bdf", ["pid-1", "pid-2"], &["pid-1", "pid-2"]),
        ("gmsh-SHAPE-small.bdf", ["pid-1", "pid-2"], &["pid-1", "pid-2"]),
        ("gmsh-SHAPE-large.bdf", ["pid-1", "pid-2"], &["pid-1", "pid-2"]),
        ("meshio-SHAPE.inp", ["plate", "clamped"], &["clamped", "plate"]),
        ("meshio-SHAPE-fixed-small.bdf", ["", ""], &[]),
        ("meshio-SHAPE-fixed-large.bdf", ["", ""], &[]),
    ];
    let of_quads: [Case; 2] = [
        ("hand-cae.inp", ["Set-1", "clamped/edges"], &["Set-1", "clamped/cells", "clamped/edges", "right", "tip"]),
        ("hand-nastran.bdf", ["plate", "clamped"], &["clamped", "plate", "set-3", "set-7"]),
    ];
    for shape in ["quads", "triangles"] {
        let expected = of(&format!("gmsh-{shape}-41.msh")).mesh;
        for (name, [cells, clamped], names) in of_both.iter().chain(of_quads.iter().filter(|_| shape == "quads")) {
            let name = name.replace("SHAPE", shape);
            let mesh = of(&name).mesh;
            assert_eq!((&mesh.points, &mesh.quads), (&expected.points, &expected.quads), "{name}");
            assert_eq!(mesh.groups.keys().collect::<Vec<_>>(), *names, "{name}");
            if !cells.is_empty() {
                assert_eq!(mesh.groups[*cells], expected.groups["plate"], "{name}");
                assert_eq!(mesh.groups[*clamped].nodes, expected.groups["clamped"].nodes, "{name}");
                assert_eq!(edges(&mesh, clamped), edges(&expected, "clamped"), "{name}");
            }
        }
    }
}

/// Gmsh no longer writes version 4.0 in binary: the text as the format says.
#[test]
fn binary_files_of_version_4_0() {
    let text = contents("gmsh-quads-40.msh");
    let mut binary = [&b"$MeshFormat\n4 1 8\n"[..], &1_i32.to_le_bytes(), b"\n$EndMeshFormat\n"].concat();
    let section = |name: &str| text.split_once(&format!("${name}\n")).unwrap().1.split_once("$End").unwrap().0;
    binary.extend(format!("$PhysicalNames\n{}$EndPhysicalNames\n", section("PhysicalNames")).into_bytes());
    for (name, thing) in [("Entities", ""), ("Nodes", "iddd"), ("Elements", "iiiii")] {
        binary.extend(format!("${name}\n").into_bytes());
        let mut left = 0;
        for (number, line) in section(name).lines().enumerate() {
            let words = line.split_whitespace().collect::<Vec<_>>();
            let forms = match left {
                _ if number == 0 => "uuuu".to_owned(),
                // Two lists of whole numbers, each after its length; points have the first alone.
                _ if name == "Entities" => {
                    let first: usize = words[7].parse().unwrap();
                    format!("idddddduI{}", "i".repeat(4)).replace('I', &format!("{}u", "i".repeat(first)))
                }
                0 => {
                    left = words[3].parse().unwrap();
                    "iiiu".to_owned()
                }
                _ => {
                    left -= 1;
                    thing.to_owned()
                }
            };
            for (word, form) in words.iter().zip(forms.chars()) {
                match form {
                    'i' => binary.extend(word.parse::<i32>().unwrap().to_le_bytes()),
                    'u' => binary.extend(word.parse::<u64>().unwrap().to_le_bytes()),
                    _ => binary.extend(word.parse::<f64>().unwrap().to_le_bytes()),
                }
            }
        }
        binary.extend(format!("\n$End{name}\n").into_bytes());
    }
    assert_eq!(parse(&binary, "binary.msh", 1e-3).unwrap(), of("gmsh-quads-40.msh"));
}

#[test]
fn what_is_left_aside_is_named() {
    let [clamped, aside] = &of("hand-cae.inp").warnings[..] else { panic!("{:?}", of("hand-cae.inp").warnings) };
    assert!(clamped.contains("\"clamped/cells\" and \"clamped/edges\""), "{clamped}");
    for words in
        ["*SHELL SECTION (line 39)", "*NODE of the assembly (line 51)", "*MATERIAL (line 64)", "*BOUNDARY (line 70)"]
    {
        assert!(aside.contains(words), "{aside}");
    }
    let [aside] = &of("hand-nastran.bdf").warnings[..] else { panic!("{:?}", of("hand-nastran.bdf").warnings) };
    for words in ["SET (line 8)", "PSHELL (line 27)", "MAT1 (line 28)", "SPC1 (line 29)"] {
        assert!(aside.contains(words), "{aside}");
    }
}

#[test]
fn a_deck_with_its_nodes_in_another_file() {
    let FileMesh { mesh, warnings } = of("hand-calculix.inp");
    assert_eq!((mesh.points.len(), mesh.quads.len()), (4, 2));
    assert_eq!(mesh.points[1..], [[0.02, 0.0], [0.02, 0.01], [0.0, 0.01]]);
    assert_eq!(mesh.groups.keys().collect::<Vec<_>>(), ["Nall", "ends", "left", "plate"]);
    assert_eq!(edges(&mesh, "left"), [[0, 3]].into());
    assert_eq!(warnings.len(), 1, "{warnings:?}");

    let parsed = parse(contents("hand-calculix.inp").as_bytes(), "alone.inp", 1e-3).unwrap_err().to_string();
    assert!(parsed.starts_with("alone.inp:2: the file \"hand-calculix.msh\" cannot be included"), "{parsed}");
    let own = tempfile::tempdir().unwrap();
    let file = own.path().join("own.inp");
    std::fs::write(&file, "*NODE\n1, 0, 0\n*INCLUDE, INPUT=own.inp\n").unwrap();
    let endless = read(&file, 1.0).unwrap_err().to_string();
    assert!(endless.contains("own.inp:3: ") && endless.contains("without end"), "{endless}");
    std::fs::write(&file, "*NODE\n1, 0, 0\n*INCLUDE, INPUT=absent.inp\n").unwrap();
    let absent = read(&file, 1.0).unwrap_err().to_string();
    assert!(absent.contains("own.inp:3: ") && absent.contains("count from the folder"), "{absent}");
    std::fs::write(own.path().join("wrong.bdf"), "GRID,1,,zero\n").unwrap();
    std::fs::write(&file, "$\nINCLUDE 'wrong.bdf'\n").unwrap();
    let within = read(&file, 1.0).unwrap_err().to_string();
    assert!(within.contains("wrong.bdf:1: field 4 of GRID is \"zero\""), "{within}");
}

/// A file made wrong by edits: where it is refused, and with which words.
type Mistake = (&'static [(&'static str, &'static str)], FilePlace, &'static str);

fn refused(file: &str, mistakes: &[Mistake]) {
    let sound = contents(file);
    let sound = sound.replace("INCLUDE 'hand-nastran-nodes.bdf'\n", &contents("hand-nastran-nodes.bdf"));
    let wrong = mistakes.iter().filter_map(|(edits, place, words)| {
        let text = edited(&sound, edits);
        match parse(text.as_bytes(), file, 1e-3) {
            Ok(_) => Some(format!("{edits:?} was read")),
            Err(error) if error.place == *place && error.to_string().contains(words) => None,
            Err(error) => Some(format!("{edits:?}: {error}; should stand at {place:?} and hold {words:?}")),
        }
    });
    assert_eq!(wrong.collect::<Vec<_>>(), [""; 0]);
}

#[test]
fn mistakes_in_input_files_of_abaqus() {
    use FilePlace::{File, Line};
    refused(
        "gmsh-quads.inp",
        &[
            (&[("15, 15, 5, 0", "14, 15, 5, 0")], Line(18), "node 14 twice"),
            (&[("15, 15, 5, 0", "15, nan, 5, 0")], Line(18), "node 15 has the coordinate NaN"),
            (&[("15, 15, 5, 0", "15, 1e999, 5, 0")], Line(18), "node 15 has the coordinate inf"),
            (&[("15, 15, 5, 0", "15, 15, 5, 1")], Line(18), "node 15 lies at z = 1"),
            (&[("15, 15, 5, 0", "15, fifteen, 5, 0")], Line(18), "a node should stand here"),
            (&[("15, 15, 5, 0", "15")], Line(18), "a node should stand here"),
            (&[("15, 15, 5, 0", "-15, 15, 5, 0")], Line(18), "a node should stand here"),
            (&[("15, 15, 5, 0", "99999999999999999999, 15, 5, 0")], Line(18), "a node should stand here"),
            (&[("*NODE", "*NODE, SYSTEM=C")], Line(3), "only rectangular coordinates"),
            (&[("*NODE", "*NGEN")], Line(3), "write them out"),
            (&[("11, 15, 8, 3, 9", "10, 15, 8, 3, 9")], Line(31), "element 10 (first line 30) twice"),
            (&[("11, 15, 8, 3, 9", "11, 15, 8, 3, 16")], Line(31), "element 11 refers to node 16"),
            (&[("11, 15, 8, 3, 9", "11, 15, 8, 3")], Line(31), "element 11 has 3 nodes, its type 4"),
            (&[("11, 15, 8, 3, 9", "11, 15, 8, three, 9")], Line(31), "\"three\" should be the number"),
            (&[("11, 15, 8, 3, 9", "11, 15, 3, 8, 9")], Line(31), "cell 11 is folded"),
            (&[("11, 15, 8, 3, 9", "11, 7, 2, 8, 15")], Line(31), "cells 10 and 11 lie on the same side"),
            (&[("type=CPS4", "type=C3D8R")], Line(23), "are solids"),
            (&[("type=CPS4", "type=SC8R")], Line(23), "are solids"),
            (&[("type=CPS4", "type=MASS")], File, "no shell, membrane or plane element"),
            (&[("11, 15, 8, 3, 9", "11, 15, 8, 3, 9, 14")], Line(31), "element 11 has more than the 4 nodes"),
            (&[("type=CPS4", "typ=CPS4")], Line(23), "without TYPE"),
            (&[("type=CPS4", "type=S8R")], Line(25), "element 4 has more than the 8 nodes"),
            (&[("*NSET,NSET=tip\n3,", "*NSET,NSET=tip\n16,")], Line(37), "the node 16, which the file does not have"),
            (&[("*NSET,NSET=tip\n3,", "*NSET,NSET=tip\nabsent,")], Line(37), "there is no set \"absent\" of nodes"),
            (&[("*NSET,NSET=tip\n3,", "*NSET,NSET=tip\ntip,")], Line(37), "names itself"),
            (&[("*NSET,NSET=tip\n3,", "*NSET,NSET=tip,GENERATE\n3,")], Line(37), "GENERATE should be followed"),
            (&[("*NSET,NSET=tip\n3,", "*NSET,NSET=tip,GENERATE\n5,4,1")], Line(37), "GENERATE should be followed"),
            (&[("*NSET,NSET=tip\n3,", "*NSET,NSET=tip,GENERATE\n1,9,0")], Line(37), "GENERATE should be followed"),
            (
                &[("*NSET,NSET=tip\n3,", "*NSET,NSET=tip,GENERATE\n99,9999999999999999999,1")],
                Line(37),
                "none of which the file has",
            ),
            (&[("*NSET,NSET=tip\n3,", "*NSET\n3,")], Line(36), "*NSET without a name"),
            (&[("*NSET,NSET=tip\n3,", "*NSET,NSET=tip,ELSET=plate")], Line(36), "list the nodes"),
            (&[("*NSET,NSET=tip\n3,", "*INCLUDE, INPUT=more.inp")], Line(36), "cannot be included"),
            (&[("*NSET,NSET=tip\n3,", "*ELSET,ELSET=tip\n99,")], Line(37), "the element 99, which"),
        ],
    );
    refused(
        "hand-cae.inp",
        &[
            (&[("3.\r\n*End Instance", "3.\r\n0., 0., 0., 0., 0., 1., 90.\r\n*End Instance")], Line(49), "is turned"),
            (&[("0.,           3.\r\n", "0.\r\n")], Line(48), "the shift of the instance"),
            (
                &[("*End Instance", "*End Instance\r\n*Instance, name=two, part=\"the plate\"")],
                Line(50),
                "a second instance",
            ),
            (&[("*End Part", "*End Part\r\n*Part, name=tool\r\n*Node\r\n1, 0., 0.")], Line(43), "both have nodes"),
        ],
    );
}

#[test]
fn mistakes_in_bulk_data_of_nastran() {
    use FilePlace::{File, Line};
    refused(
        "gmsh-quads-free.bdf",
        &[
            (&[("GRID,15,", "GRID,14,")], Line(16), "node 14 twice"),
            (&[("GRID,15,0,15.00000", "GRID,15,0,nan")], Line(16), "node 15 has the coordinate NaN"),
            (&[("GRID,15,0,15.00000", "GRID,15,0,1+999")], Line(16), "node 15 has the coordinate inf"),
            (&[("GRID,15,0,15.00000", "GRID,15,0,x")], Line(16), "field 4 of GRID is \"x\" and should be a number"),
            (&[("GRID,15,0,15.00000", "GRID,15,7,15.00000")], Line(16), "coordinates in the system 7"),
            (&[("GRID,15,0,15.00000", "GRID,0,0,15.00000")], Line(16), "field 2 of GRID is \"0\""),
            (&[("GRID,15,0,15.00000", "GRID,-3,0,15.00000")], Line(16), "field 2 of GRID is \"-3\""),
            (&[("GRID,15,0,15.00000,5.000000,0.00E+00", "GRID,15,0,15.0,5.0,1.0")], Line(16), "node 15 lies at z = 1"),
            (&[("GRID,15,0,15.00000", "GRDSET,,2\nGRID,15,0,15.00000")], Line(16), "GRDSET names a coordinate system"),
            (&[("CQUAD4,11,", "CQUAD4,10,")], Line(26), "element 10 (first line 25) twice"),
            (&[("CQUAD4,11,1,15,8,3,9", "CQUAD4,11,1,15,8,3,16")], Line(26), "element 11 refers to node 16"),
            (&[("CQUAD4,11,1,15,8,3,9", "CQUAD4,11,1,15,8,3")], Line(26), "field 7 of CQUAD4 is \"\""),
            (&[("CQUAD4,11,1,15,8,3,9", "CQUAD4,11,1,15,3,8,9")], Line(26), "cell 11 is folded"),
            (&[("CQUAD4,11,1,15,8,3,9", "CQUAD4,11,1,7,2,8,15")], Line(26), "cells 10 and 11 lie on the same side"),
            (&[("CQUAD4,11,1,15,8,3,9", "CHEXA,11,1,15,8,3,9")], Line(26), "CHEXA is a solid"),
            (&[("CQUAD4,11,1,15,8,3,9", "CSHEAR,11,1,15,8,3,9")], Line(26), "CSHEAR is no cell that is read"),
            (&[("CQUAD4,11,1,15,8,3,9", "=,*1,=,*1,*1,*1,*1")], Line(26), "a card that repeats the one before it"),
            (&[("CQUAD4,11,1,15,8,3,9", "=(1)")], Line(26), "a card that repeats the one before it"),
            (&[("CQUAD4,11,1,15,8,3,9", "SET1,5,1,THRU")], Line(26), "the set 5 should list numbers"),
            (&[("CQUAD4,11,1,15,8,3,9", "SET1,5,9,THRU,8")], Line(26), "the set 5 should list numbers"),
            (&[("CQUAD4,11,1,15,8,3,9", "SET1,5,3,99")], Line(26), "the node 99, which the file does not have"),
            (&[("CQUAD4,11,1,15,8,3,9", "SET3,5,ELEM,99")], Line(26), "the element 99, which"),
            (&[("CQUAD4,11,1,15,8,3,9", "SET1,5,90,THRU,99999999999999")], Line(26), "none of which the file has"),
            (&[("CQUAD4,11,1,15,8,3,9", "SET3,5,ELEM,4,THRU,11,BY,0")], Line(26), "the set 5 should list numbers"),
            (&[("CQUAD4,11,1,15,8,3,9", "CQUAD4,11,1,15,8,Ä,9")], Line(26), "ASCII"),
            (&[("CQUAD4,11,1,15,8,3,9", "INCLUDE 'more.bdf'")], Line(26), "cannot be included"),
        ],
    );
    refused(
        "hand-nastran.bdf",
        &[
            (&[("BEGIN BULK", "BEGIN BULK\n+Q1,5")], Line(12), "a line that goes on a card"),
            (&[("BEGIN BULK", "BEGIN BULK\nENDDATA")], File, "no shell"),
        ],
    );
}

/// Wherever a file is cut, and whatever bytes change, a result comes.
#[test]
fn files_of_lines_that_are_damaged() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for name in
        ["gmsh-quads.inp", "hand-cae.inp", "gmsh-quads-small.bdf", "hand-nastran.bdf", "gmsh-quads-22-binary.msh"]
    {
        let bytes = std::fs::read(folder().join(name)).unwrap();
        for cut in 0..bytes.len() {
            drop(parse(&bytes[..cut], name, 1e-3));
        }
        for _ in 0..1000 {
            let mut changed = bytes.clone();
            for _ in 0..=random(3) {
                let at = random(changed.len());
                match random(3) {
                    0 => changed[at] = random(256) as u8,
                    1 => changed[at] = b"0123456789 ,*$=\n"[random(16)],
                    _ => drop(changed.remove(at)),
                }
            }
            drop(parse(&changed, name, 1e-3));
        }
    }
}
