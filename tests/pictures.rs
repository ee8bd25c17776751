//! No text of a picture is cut, and none lies on another, whatever command draws it.

use crate::support::{Case, fem, plate, root};
use roxmltree::{Document, Node};
use std::fs;
use std::path::Path;
use ttf_parser::Face;

/// Left, upper, right and lower edge of a text, in the font that the pictures of pixels use.
fn bounds(text: Node<'_, '_>, face: &Face<'_>) -> [f64; 4] {
    let number = |name: &str| text.attribute(name).unwrap().parse::<f64>().unwrap();
    let (x, y, size) = (number("x"), number("y"), number("font-size"));
    let advance = |c| face.glyph_index(c).and_then(|glyph| face.glyph_hor_advance(glyph)).unwrap_or_default();
    let units: f64 = text.text().unwrap_or_default().chars().map(|c| f64::from(advance(c))).sum();
    let long = units * size / f64::from(face.units_per_em());
    let before = match text.attribute("text-anchor") {
        Some("middle") => 0.5 * long,
        Some("end") => long,
        _ => 0.0,
    };
    let (above, below) = (0.75 * size, 0.2 * size);
    match text.has_attribute("transform") {
        false => [x - before, y - above, x - before + long, y + below],
        true => [x - above, y + before - long, x + below, y + before],
    }
}

fn check(file: &Path) {
    let svg = fs::read_to_string(file).unwrap();
    let document = Document::parse(&svg).unwrap();
    let face = Face::parse(epaint_default_fonts::UBUNTU_LIGHT, 0).unwrap();
    let size = |name: &str| document.root_element().attribute(name).unwrap().parse::<f64>().unwrap();
    let texts: Vec<_> = document.descendants().filter(|node| node.has_tag_name("text")).collect();
    let boxes: Vec<_> = texts.iter().map(|text| bounds(*text, &face)).collect();
    let said = |i: usize| texts[i].text().unwrap_or_default();
    assert!(texts.len() > 3, "{} says little", file.display());
    for (i, [left, top, right, bottom]) in boxes.iter().enumerate() {
        let inside = *left >= 0.0 && *top >= 0.0 && *right <= size("width") && *bottom <= size("height");
        assert!(inside, "`{}` is cut in {}", said(i), file.display());
        for (j, [l, t, r, b]) in boxes.iter().enumerate().skip(i + 1) {
            // Places are rounded to a tenth.
            let apart = *right <= l + 0.1 || *left >= r - 0.1 || *bottom <= t + 0.1 || *top >= b - 0.1;
            assert!(apart, "`{}` lies on `{}` in {}", said(i), said(j), file.display());
        }
    }
}

/// Checks all pictures of `folder`, and that these are among them.
pub(crate) fn pictures(case: &Case, folder: &str, some: &[&str]) {
    let names: Vec<_> = case.names(folder).into_iter().filter(|name| name.ends_with(".svg")).collect();
    assert!(!names.is_empty(), "no picture in {folder}");
    for name in some {
        assert!(names.iter().any(|found| found.strip_suffix(".svg") == Some(name)), "{name}: {names:?}");
    }
    names.iter().for_each(|name| check(&case.folder().join(folder).join(name)));
}

#[test]
fn texts_of_plates_at_rest_and_modes() {
    let case = plate();
    case.write();
    let run = |arguments: &[&str]| fem(case.folder(), arguments).good();
    let scene = |name: &str| root().join(name).to_str().unwrap().to_owned();
    let pagano = scene("examples/pagano-0-90-0/scene.toml");
    run(&["run", &pagano, "--out", "rest"]);
    pictures(&case, "rest", &["deflection", "ply_stresses", "profile-edge-x-in-plane"]);
    run(&["modes", &pagano, "--out", "modes"]);
    pictures(&case, "modes", &["mode_shapes"]);
    run(&["run", &scene("benches/specimens/dcb.toml"), "--out", "growth", "--set", "path.step=8 mJ"]);
    pictures(&case, "growth", &["force_displacement", "ply_stresses", "c_scan"]);
    // Its mid-plane stays where it is.
    assert!(!case.names("growth").iter().any(|name| name.starts_with("deflection")));
}

#[test]
fn texts_of_many_impacts() {
    let case = Case::example("as4-3502-8ply-25mm").scene("end = \"1 ms\"", "end = \"0.3 ms\"");
    let case = case.append("\n[reduction]\nmethod = \"ritz\"\nvectors = 20\n");
    case.fem("run", &["--out", "run"]).good();
    pictures(&case, "run", &["contact_force", "damage_map", "damage_section", "energy", "force_displacement"]);
    let set = ["--set", "impactor.mass=0.2..4", "--set", "impactor.velocity=0.3..3"];
    case.fem("map", &[&set[..], &["--tolerance", "20%", "--out", "map"]].concat()).good();
    pictures(&case, "map", &["border_map"]);
    let set = ["--set", "impactor.velocity=0.3..3:4", "--out", "sweep"];
    case.fem("sweep", &set).good();
    pictures(&case, "sweep", &["peak_force"]);
    let set = ["--set", "impactor.velocity=0.3..3:3", "--set", "impactor.mass=1..2:2", "--out", "grid"];
    case.fem("sweep", &set).good();
    pictures(&case, "grid", &[]);
}
