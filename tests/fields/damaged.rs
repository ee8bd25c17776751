//! Damage of plies and interfaces, and the jumps across these.

use super::series;
use crate::support::strip;

const SCENE: &str = r#"
title = "damaged"
mesh = { rectangle = ["24 mm", "20 mm"], cells = [6, 5] }
element = { kind = "hermite-prism" }
effects = { damage = "off", delamination = "growth" }
delamination = { penalty = "2e4 N/mm^3", interfaces = [1] }
support = [
  { group = "x-min", at = "bottom", fix = ["U30"] },
  { group = "x-max", at = "bottom", fix = ["U30"] },
  { group = "y-min", at = "bottom", fix = ["U30"] },
  { group = "y-max", at = "bottom", fix = ["U30"] },
  { restrain = "rigid-motions" },
]
impactor = { mass = "0.2 kg", velocity = "3 m/s", at = { x = "12 mm", y = "10 mm" }, patch_radius = "3 mm" }
contact = { law = "sun-yang", k = "4e9 N/m^1.5", critical = "0.01 mm" }
march = { step = "1 us", end = "150 us" }
laminate = { plies = "[0/90/0]", material = "tape", ply_thickness = "1 mm" }
output = { fields = { every = "50 us" } }

[materials.tape]
library = "IM7/8552"
Zt = "20 MPa"
S13 = "25 MPa"
Gft = "80 N/mm"
Gfc = "80 N/mm"
Gmt = "0.28 N/mm"
Gms = "0.8 N/mm"
law = { name = "crack-band", breaks = "splits", alpha = "2.44e-8 1/MPa^3", lower_strengths = true }
"#;

/// The fields say of each cell what `delaminations.csv` says; the modes of plies make up what `history.csv` counts; the dent is that of
/// the closed form of Yang and Sun.
#[test]
fn damage_and_openings_are_fields_and_energies_are_told_by_mode() {
    let case = strip().text(SCENE);
    case.fem("run", &["--out", "out"]).good();
    let (_, interfaces) = series(&case, "out", "interfaces").pop().unwrap();
    let of = |name: &str| interfaces.cells(name);
    let (cells, below, damage) = (of("cell"), of("ply_below"), of("damage"));
    let (_, table) = case.table("out/delaminations.csv");
    let mut damaged = 0;
    for row in &table {
        let (tag, want): (f64, f64) = (row[1].parse().unwrap(), row[6].parse().unwrap());
        let at = (0..cells.len()).find(|i| cells[*i] == tag && below[*i] == 1.0).unwrap();
        assert!((damage[at] - want).abs() < 1e-6, "{row:?}: {}", damage[at]);
        damaged += 1;
    }
    assert!(damaged > 10 && damaged == damage.iter().filter(|d| **d > 0.0).count(), "{damaged}");
    // The interface that may not open says nothing; faces slide most where most is damaged, by more than the law lets them while sound.
    let sliding = of("sliding");
    assert!((0..below.len()).all(|i| (below[i] == 2.0) == sliding[i].is_nan()));
    let worst =
        (0..damage.len()).filter(|i| below[*i] == 1.0).max_by(|a, b| damage[*a].total_cmp(&damage[*b])).unwrap();
    assert!(damage[worst] > 0.9 && sliding[worst] > 25e6 / 2e13, "{} {}", damage[worst], sliding[worst]);
    assert!(interfaces.names("CellData").iter().all(|name| !name.contains("traction")), "of no material");

    let (_, plies) = series(&case, "out", "plies").pop().unwrap();
    let split = plies.cells("matrix tension damage");
    assert!(split.iter().all(|d| (0.0..=1.0).contains(d)) && split.iter().any(|d| *d > 0.1));
    assert!(plies.cells("fibre tension damage").iter().all(|d| *d == 0.0));

    let summary = case.summary("out");
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let modes: f64 = summary["plies_J"].as_object().unwrap().values().map(number).sum();
    let (names, rows) = case.table("out/history.csv");
    let column = names.iter().position(|name| name == "ply_dissipated_J").unwrap();
    let lost: f64 = rows.last().unwrap()[column].parse().unwrap();
    assert!(lost > 1e-3 && (modes / lost - 1.0).abs() < 1e-9, "{modes} {lost}");
    let deepest = number(&summary["impact"]["peak_indentation_m"]);
    let dent = deepest * (1.0 - (1e-5 / deepest).powf(0.4));
    assert!((number(&summary["impact"]["dent_m"]) / dent - 1.0).abs() < 1e-9);
}
