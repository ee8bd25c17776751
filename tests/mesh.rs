//! `fem mesh`, and built-in meshes under impact.

use crate::support::{Case, fem, plate, root};
use serde_json::Value;
use std::fs;

/// A scene on a built-in disc instead of the mesh of gmsh.
fn on_a_disc(keys: &str) -> Case {
    let disc = format!("mesh = {{ disc = {{ radius = \"25 mm\", {keys} }} }}");
    plate()
        .scene("mesh = { file = \"plate.msh\", unit = \"mm\" }", &disc)
        .scene("group = \"support\"", "group = \"edge\"")
}

fn json(case: &Case, arguments: &[&str]) -> Value {
    serde_json::from_str(&fem(case.folder(), &[&["mesh", "--json"], arguments].concat()).good().stdout).unwrap()
}

#[test]
fn a_mesh_is_shown() {
    let case = plate();
    let folder = root().join("examples/as4-3502-16ply-50mm");
    let done = fem(&folder, &["mesh", "plate.msh"]).good();
    insta::assert_snapshot!(done.stdout, @r"
    plate.msh
      mesh      288 quads, 313 nodes, area 1957.9 mm2
      bounds    x -25 to 25, y -25 to 25 mm
      cells     edges 2.0112 to 3.2702 mm
      quality   scaled Jacobian       0.85928 at worst (cell 248 at -14.534, 13.004 mm), 0.97824 in the mean
                inner angle, degrees  120.76 at worst (cell 248 at -14.534, 13.004 mm), 99.268 in the mean
                aspect                1.6259 at worst (cell 224 at 15.759, 17.911 mm), 1.1678 in the mean
      groups    impact   1 node
                plate    288 quads, 313 nodes, area 1957.9 mm2
                support  48 edges, 48 nodes, length 156.97 mm
    ");
    case.write();
    let of_file = json(&case, &["plate/plate.msh"]);
    assert_eq!(of_file, json(&case, &["plate/scene.toml"]));
    let polygon = 24.0 * 25e-3_f64.powi(2) * (std::f64::consts::TAU / 48.0).sin();
    assert!((of_file["area_m2"].as_f64().unwrap() / polygon - 1.0).abs() < 1e-9);
    assert_eq!(of_file["groups"][2]["edges"], 48);
    let inches = fem(case.folder(), &["mesh", "plate/plate.msh", "--unit", "in"]).good().stdout;
    assert!(inches.contains("x -25 to 25, y -25 to 25 in"), "{inches}");
}

#[test]
fn a_mesh_is_written_and_read_again() {
    let case = on_a_disc("size = \"1 mm\"");
    case.write();
    let built = json(&case, &["plate/scene.toml"]);
    for binary in [&[][..], &["--binary"]] {
        let written =
            fem(case.folder(), &[&["mesh", "plate/scene.toml", "--out", "made/disc.msh"], binary].concat()).good();
        assert!(written.stdout.ends_with("written   made/disc.msh\n"), "{}", written.stdout);
        let again = json(&case, &["made/disc.msh"]);
        assert_eq!([&built["quads"], &built["nodes"]], [&again["quads"], &again["nodes"]]);
        let area = |mesh: &Value| mesh["area_m2"].as_f64().unwrap();
        assert!((area(&again) / area(&built) - 1.0).abs() < 1e-14);
        // What was read is written again byte for byte.
        let bytes = fs::read(case.folder().join("made/disc.msh")).unwrap();
        fem(case.folder(), &[&["mesh", "made/disc.msh", "--out", "made/again.msh"], binary].concat()).good();
        assert_eq!(fs::read(case.folder().join("made/again.msh")).unwrap(), bytes);
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let case = plate();
    case.write();
    for (arguments, status, words) in [
        (&["mesh", "plate/plate.msh", "--unit", "kg"][..], 1, "`kg` is not a unit of length"),
        (&["mesh", "plate/absent.msh"], 1, "plate/absent.msh: cannot read the file"),
        (&["mesh", "plate/plate.msh", "--binary"], 2, "--out"),
        (&["mesh", "plate/plate.msh", "--out", "plate/.."], 1, "cannot name a file"),
        (&["mesh", "plate/absent.toml"], 1, "cannot read the scene"),
    ] {
        let done = fem(case.folder(), arguments);
        assert!(done.status == status && done.stderr.contains(words), "{arguments:?}: {done:?}");
    }
    let off = on_a_disc("size = \"1 mm\", impact = [\"0 mm\", \"20 mm\"]");
    let done = off.fem("check", &[]);
    assert!(done.status == 1 && done.stderr.contains("`mesh.disc.impact`: lies 20 mm from"), "{done:?}");
}

/// The report's case 1, by the mesh of gmsh and by a built-in one: 1.3e-3 apart.
#[test]
fn the_force_on_a_built_in_disc_is_that_on_a_mesh_of_gmsh() {
    let force = |case: &Case| -> Vec<f64> {
        case.fem("run", &["--out", "out"]).good();
        let (header, rows) = case.table("out/history.csv");
        let column = header.iter().position(|name| name == "contact_force_N").unwrap();
        rows.iter().map(|row| row[column].parse().unwrap()).collect()
    };
    let [gmsh, built] = [plate(), on_a_disc("size = \"2.54 mm\"")].map(|case| force(&case));
    assert_eq!(gmsh.len(), built.len());
    let off: f64 = gmsh.iter().zip(&built).map(|(a, b)| (a - b).powi(2)).sum();
    let relative = (off / gmsh.iter().map(|f| f * f).sum::<f64>()).sqrt();
    assert!(relative < 3e-3, "{relative:.2e}");
}

/// Cells, groups and the point that is struck, whatever the mesh comes from; nothing but the two files is written.
#[test]
fn a_mesh_is_drawn() {
    let case = on_a_disc("size = \"4 mm\", support = \"20 mm\"");
    case.write();
    let done = fem(case.folder(), &["mesh", "plate/scene.toml", "--picture", "drawn"]).good();
    assert!(done.stdout.ends_with("  written   drawn/scene.svg\n  written   drawn/scene.png\n"), "{}", done.stdout);
    assert_eq!(case.names("drawn"), [".fem", "scene.png", "scene.svg"]);
    let svg = case.read("drawn/scene.svg");
    for words in [">x (mm)<", ">edge<", ">support<", ">impact<", "plate/scene.toml"] {
        assert!(svg.contains(words), "{words}");
    }
    // A file says nothing of what strikes it: all but the cross is the same.
    fem(case.folder(), &["mesh", "plate/scene.toml", "--out", "disc.msh"]).good();
    fem(case.folder(), &["mesh", "disc.msh", "--picture", "drawn"]).good();
    let bare = case.read("drawn/disc.svg");
    assert!(svg.matches("<polyline").count() > bare.matches("<polyline").count(), "no cross");
}
