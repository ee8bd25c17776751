//! What a folder of results shows of delaminations.

use super::scenes::Plate;
use crate::support::root;
use fem::io::scene;
use fem::job::{self, Options, Results};
use fem::{Registry, io::units::parse_as};
use fem_core::plugin::Dimension;

/// Runs `plate` with pictures, and gives the folder of its results.
fn drawn(plate: &Plate) -> tempfile::TempDir {
    let text = plate.text().replace("output = {", "output = { plots = true,");
    let folder = tempfile::tempdir().unwrap();
    let options = Options { results: Results::Folder(folder.path().to_owned()), ..Options::default() };
    let scene = scene::parse(&text, &root().join("scene.toml")).unwrap();
    job::run(&scene, &Registry::standard(), &options, &mut ()).unwrap();
    folder
}

#[test]
fn c_scans_say_where_and_when() {
    let plate = Plate { more: "", ..Plate::new() };
    let folder = drawn(&plate);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(read("c_scan.svg").contains("projection: "));

    // The spans of the legend end with the last cell of the table, and begin with the first.
    let mut reader = csv::Reader::from_reader(std::io::Cursor::new(read("delaminations.csv")));
    let column = reader.headers().unwrap().iter().position(|name| name == "since_s").unwrap();
    let times: Vec<f64> = reader.records().filter_map(|row| row.unwrap()[column].parse().ok()).collect();
    let [first, last] =
        [times.iter().copied().fold(f64::INFINITY, f64::min), times.iter().copied().fold(0.0, f64::max)];
    let svg = read("c_scan_times.svg");
    let said = |before: &str| -> Vec<f64> {
        let after = svg.split(before).skip(1).map(|text| text.split('<').next().unwrap());
        after.map(|text| parse_as(text, Dimension::TIME).unwrap()).collect()
    };
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    near(said("first of all, from ")[0], first);
    near(said("until ").into_iter().fold(0.0, f64::max), last);
    assert!(last > first && last <= 400e-6);

    // What is damaged is shown before anything has delaminated.
    let end_us = (first * 1e6) as u32 - 4;
    let folder = drawn(&Plate { end_us, ..plate });
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name));
    let svg = read("c_scan.svg").unwrap();
    assert!(svg.contains("none delaminated") && svg.contains("mean damage") && svg.contains("interface 1|2"), "{svg}");
    assert!(!svg.contains("projection: ") && read("c_scan_times.svg").is_err());
}
