use super::*;

/// Every file of the list must be refused at the place given with a message that holds the words given.
#[test]
fn files_of_gmsh_that_cannot_be_used() {
    let cases: [(&str, FilePlace, &[&str]); 4] = [
        ("third-order.msh", FilePlace::Line(311), &["group \"rim\"", "Lin4", "Mesh.ElementOrder = 1"]),
        ("hexahedra.msh", FilePlace::Line(69), &["element 1 of group \"block\"", "Hex8", "volumes"]),
        ("no-groups.msh", FilePlace::File, &["no physical group holds a cell", "Physical Surface(\"plate\")"]),
        ("not-joined.msh", FilePlace::Line(44), &["nodes 2 and 5 lie at the same point", "Coherence"]),
    ];
    let wrong = cases.iter().filter_map(|(name, place, words)| check(name, &data(name), *place, words));
    assert_eq!(wrong.collect::<Vec<_>>(), [""; 0]);
}

#[test]
fn files_that_are_no_meshes() {
    let cases: [(&str, &[u8], FilePlace, &[&str]); 12] = [
        ("empty", b"", FilePlace::File, &["not a mesh of gmsh, Abaqus or Nastran", "msh41"]),
        ("other", b"solid cube\n", FilePlace::File, &["not a mesh of gmsh, Abaqus or Nastran"]),
        ("garbage", b"$MeshFormat\x00\xff\xfe", FilePlace::File, &["not a mesh of gmsh, Abaqus or Nastran"]),
        ("cut", b"$MeshFormat\n", FilePlace::Line(2), &["unusable header \"\""]),
        ("words", b"$MeshFormat\nfour one\n", FilePlace::Line(2), &["unusable header \"four one\""]),
        ("4 bytes", b"$MeshFormat\n4.1 1 4\n\x01\0\0\0\n$EndMeshFormat\n", FilePlace::Line(2), &["unusable header"]),
        ("0 bytes", b"$MeshFormat\n4.1 1 0\n\x01\0\0\0\n$EndMeshFormat\n", FilePlace::Line(2), &["unusable header"]),
        ("big", b"$MeshFormat\n4.1 1 8\n\0\0\0\x01\n$EndMeshFormat\n", FilePlace::Line(2), &["little-endian"]),
        (
            "huge",
            b"$MeshFormat\n4.1 0 99999999999999999999\n$EndMeshFormat\n",
            FilePlace::Line(2),
            &["unusable header"],
        ),
        ("bare", b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", FilePlace::File, &["$Elements is missing"]),
        (
            "nodes",
            b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Elements\n1 1 1 1\n",
            FilePlace::File,
            &["$Nodes is missing"],
        ),
        (
            "no",
            b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Elements\n0 0 0 0\n",
            FilePlace::Line(5),
            &["$Elements is missing or empty"],
        ),
    ];
    let wrong = cases.iter().filter_map(|(name, bytes, place, words)| check(name, bytes, *place, words));
    assert_eq!(wrong.collect::<Vec<_>>(), [""; 0]);
}

/// A sound file made wrong by edits.
#[test]
fn damaged_files() {
    type Case<'a> = (&'a [(&'a str, &'a str)], FilePlace, &'a [&'a str]);
    let cases: &[Case<'_>] = &[
        // Numbers.
        (&[("30 0 2\n0 3", "nan 0 2\n0 3")], FilePlace::Line(29), &["node 2 has the coordinate NaN"]),
        (&[("30 0 2\n0 3", "30 inf 2\n0 3")], FilePlace::Line(29), &["node 2 has the coordinate inf"]),
        (&[("30 0 2\n0 3", "30 1e999 2\n0 3")], FilePlace::Line(29), &["node 2 has the coordinate inf"]),
        (&[("22.49999999998463 0 2", "1e200 0 2")], FilePlace::Line(76), &["cell 8"]),
        (&[("30 0 2\n0 3", "30 zero 2\n0 3")], FilePlace::Line(29), &["not valid MSH", "node"]),
        // Counts.
        (&[("9 15 1 15", "9 14 1 15")], FilePlace::File, &["$Nodes announces 14 entries and holds 15"]),
        (&[("9 15 1 15", "9 1000000000000 1 15")], FilePlace::File, &["$Nodes announces 1000000000000"]),
        (&[("9 15 1 15", "1000000000000 15 1 15")], FilePlace::Line(63), &["not valid", "node entity block (10 of"]),
        (&[("1 1 0 3\n", "1 1 0 1000000000000\n")], FilePlace::Line(40), &["not valid MSH", "node tags"]),
        (&[("3 11 1 11", "3 1000000000000 1 11")], FilePlace::File, &["$Elements announces 1000000000000"]),
        (&[("2 1 3 8", "2 1 3 1000000000000")], FilePlace::Line(80), &["not valid", "element definition (9 of"]),
        (&[("4 4 1 0\n", "4 4 1000000000000 0\n")], FilePlace::Line(21), &["not valid", "surface entity"]),
        (&[("4 4 1 0\n", "99999999999999999999 4 1 0\n")], FilePlace::Line(11), &["not valid", "out of range"]),
        (&[("1 1 4 1 2 3 4", "1000000000000 1 4 1 2 3 4")], FilePlace::Line(21), &["not valid", "physical tags"]),
        (&[("9 15 1 15", "9 0 1 15")], FilePlace::Line(23), &["$Nodes is missing or empty"]),
        (&[("9 15 1 15", "nine 15 1 15")], FilePlace::Line(23), &["not valid", "number of node entity blocks"]),
        (&[("9 15 1 15", "9 fifteen 1 15")], FilePlace::Line(23), &["not begin with four whole numbers"]),
        (&[("9 15 1 15", "9 15 3 3")], FilePlace::File, &["range of node numbers"]),
        (&[("\n3\n0 3", "\n1000000000000\n0 3")], FilePlace::Line(9), &["a physical name"]),
        (&[("\n3\n0 3", "\n2\n0 3")], FilePlace::Line(5), &["more physical names than announced"]),
        (&[("\n3\n0 3", "\nthree\n0 3")], FilePlace::Line(5), &["number of physical names"]),
        // Sections.
        (&[("$EndNodes", "$EndNodes\n$Nodes\n$EndNodes")], FilePlace::Line(64), &["a second section $Nodes"]),
        (&[("$Entities", "$Entries"), ("$EndEntities", "$EndEntries")], FilePlace::File, &["$Entities is missing"]),
        (&[("$EndElements", "")], FilePlace::Line(81), &["not valid"]),
        (&[("\n$Nodes", "\nnodes")], FilePlace::File, &["$Nodes is missing"]),
        // Tags.
        (&[("5\n6\n7\n", "5\n6\n6\n")], FilePlace::Line(38), &["the file has node 6 twice"]),
        (&[("5\n6\n7\n", "5\n6\n3\n")], FilePlace::Line(31), &["node 3 twice"]),
        (&[("5 12 13 11 4 ", "4 12 13 11 4 ")], FilePlace::Line(72), &["element 4 twice"]),
        (&[("4 1 5 13 12 ", "4 1 5 13 16 ")], FilePlace::Line(72), &["element 4 refers to node 16"]),
        (&[("2 4 12 \n", "2 4 0 \n")], FilePlace::Line(69), &["element 2 refers to node 0"]),
        (&[("1 4 1 2\n", "1 7 1 2\n")], FilePlace::Line(69), &["entity 7 of dimension 1, which is not in $Entities"]),
        (&[("\n2 30 0 2 0 ", "\n1 30 0 2 0 ")], FilePlace::File, &["entity 1 of dimension 0 twice"]),
        // Groups.
        (&[("\"tip\"", "\"plate\"")], FilePlace::Line(8), &["\"plate\" occurs with dimension 0 and 2"]),
        (&[("2 1 \"plate\"\n", "1 2 \"plate\"\n")], FilePlace::Line(8), &["group 2 of dimension 1 is named twice"]),
        (&[("2 1 \"plate\"", "2 1 plate")], FilePlace::Line(8), &["a physical name"]),
        (&[("2 1 \"plate\"", "2 1 \"")], FilePlace::Line(8), &["a physical name"]),
        (
            &[("2 1 \"plate\"", "2 2 \"2\""), ("1 1 4 1 2 3 4", "1 2 4 1 2 3 4"), ("1 2 \"clamped\"", "1 9 \"x\"")],
            FilePlace::File,
            &["\"2\" occurs with dimension 2 and 1"],
        ),
        (&[("2 1 3 8\n", "1 4 3 8\n")], FilePlace::Line(72), &["element 4 of group \"clamped\"", "Qua4"]),
        (&[("0 3 15 1\n1 3", "0 3 1 1\n1 3 3")], FilePlace::Line(67), &["element 1 of group \"tip\"", "Lin2"]),
        // Geometry.
        (&[("30 10 2\n0 4", "30 10 2.001\n0 4")], FilePlace::Line(32), &["node 3 lies at z = 2.001, node 1 at z = 2"]),
        (&[("4 1 5 13 12 ", "4 1 13 5 12 ")], FilePlace::Line(72), &["cell 4 is folded"]),
        (&[("4 1 5 13 12 ", "4 1 5 5 12 ")], FilePlace::Line(72), &["cell 4", "at node 5"]),
        (
            &[("7.500000000007727 4.999999999998101 2", "3 2 2")],
            FilePlace::Line(72),
            &["cell 4", "180 degrees", "node 13"],
        ),
        (&[("7.500000000007727 4.999999999998101 2", "3.75 2.5 2")], FilePlace::Line(72), &["cell 4", "node 13"]),
        (&[("5 12 13 11 4 ", "5 1 5 13 12 ")], FilePlace::Line(73), &["cells 4 and 5 lie on the same side"]),
        (&[("5 12 13 11 4 ", "5 1 12 13 5 ")], FilePlace::Line(73), &["cells 4 and 5 lie on the same side"]),
        (&[("2 4 12 \n", "2 4 5 \n")], FilePlace::Line(69), &["element 2 of group \"clamped\", from node 4 to node 5"]),
        (&[("3 12 1 \n", "3 12 4 \n")], FilePlace::Line(70), &["elements 2 and 3 of group \"clamped\""]),
    ];
    let strip = text("ascii.msh");
    let wrong = cases.iter().filter_map(|(edits, place, words)| {
        check(&format!("{edits:?}"), edited(&strip, edits).as_bytes(), *place, words)
    });
    assert_eq!(wrong.collect::<Vec<_>>(), [""; 0]);
}

/// The point group names the node in the middle of the arc's edge, which the corners leave out.
#[test]
fn a_group_of_a_node_that_no_cell_has() {
    let file = edited(&text("second-order.msh"), &[("1 2 \"rim\"", "0 2 \"rim\""), ("2 4 4 0 0", "2 4 4 0 1 2")]);
    let file = file.replace(" 1 2 2 6 -7", " 0 2 6 -7").replace(" 1 2 2 7 -8", " 0 2 7 -8");
    let file = file.replace(" 1 2 2 8 -9", " 0 2 8 -9").replace(" 1 2 2 9 -6", " 0 2 9 -6");
    let elements = file.find("$Elements\n").unwrap();
    let file =
        file[..elements].to_owned() + &edited(&file[elements..], &[("9 20 1 20\n", "10 21 1 21\n0 2 15 1\n21 25\n")]);
    check(
        "middle",
        file.as_bytes(),
        FilePlace::Line(120),
        &["node 25 of group \"rim\" is not a corner of a cell", "In Surface"],
    );
}

#[test]
fn a_length_unit_that_blows_up() {
    let error = parse(&data("ascii.msh"), "strip", 1e307).unwrap_err();
    assert!(error.to_string().contains("node 2 has the coordinate inf"), "{error}");
}

/// Wherever a file is cut behind its header, it is refused as cut, unless nothing but the last line end is missing.
#[test]
fn truncated_files() {
    for name in ["ascii.msh", "crlf.msh", "binary.msh"] {
        let bytes = data(name);
        let last = bytes.trim_ascii_end().len();
        for cut in 0..last {
            let said = parse(&bytes[..cut], name, 1e-3).unwrap_err().to_string();
            assert!(cut < 60 || said.contains("cut short"), "{name} cut at {cut}: {said}");
        }
        assert!(parse(&bytes[..last], name, 1e-3).is_ok());
    }
}

/// Changes of one to three bytes anywhere: either result will do, but it must come.
#[test]
fn mutated_files() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut refused = 0;
    for name in ["ascii.msh", "binary.msh", "second-order.msh"] {
        let bytes = data(name);
        for _ in 0..2000 {
            let mut changed = bytes.clone();
            for _ in 0..=random(3) {
                let at = random(changed.len());
                match random(4) {
                    0 => changed[at] = random(256) as u8,
                    1 => changed[at] = b"0123456789 -.$\n"[random(15)],
                    2 => drop(changed.remove(at)),
                    _ => changed.insert(at, b"0123456789 -.$\n"[random(15)]),
                }
            }
            refused += usize::from(parse(&changed, name, 1e-3).is_err());
        }
    }
    assert!((1000..6000).contains(&refused), "{refused} of 6000 refused");
}

/// What is wrong with the refusal of a file, if anything.
fn check(name: &str, bytes: &[u8], place: FilePlace, words: &[&str]) -> Option<String> {
    let Err(error) = parse(bytes, "plate.msh", 1e-3) else { return Some(format!("{name} was read")) };
    let message = error.to_string();
    let right = error.place == place
        && message.starts_with(&format!("plate.msh{place}: "))
        && words.iter().all(|word| message.contains(word));
    (!right).then(|| format!("{name}: {message}; should stand at {place} and hold {words:?}"))
}
