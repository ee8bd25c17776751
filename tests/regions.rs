//! Plates of several laminates.

use crate::support::{Case, plate, root};
use fem::core::mesh::{Group, PlaneMesh};
use fem::io::gmsh::{self, Encoding};
use std::collections::BTreeSet;
use std::fs;

/// A rectangle of `sides`, m, with the group `left` of its cells in the half at small x.
fn halves(sides: [f64; 2], cells: [usize; 2]) -> Vec<u8> {
    let lines = |d: usize| -> Vec<f64> { (0..=cells[d]).map(|i| sides[d] * i as f64 / cells[d] as f64).collect() };
    let mut mesh = PlaneMesh::rectangle(&lines(0), &lines(1));
    let quads: Vec<u32> =
        (0..mesh.quads.len() as u32).filter(|quad| 2 * (*quad as usize % cells[0]) < cells[0]).collect();
    let nodes: BTreeSet<u32> = quads.iter().flat_map(|quad| mesh.quads[*quad as usize]).collect();
    let left = Group { dim: 2, nodes: nodes.into_iter().collect(), quads, ..Group::default() };
    mesh.groups.insert("left".into(), left);
    let mut file = Vec::new();
    gmsh::write(&mut file, &mesh, 1e-3, Encoding::Ascii).unwrap();
    file
}

/// A scene of `tests/data/scenes` on halves of a plate, with these laminates.
fn scene(name: &str, laminate: &str) -> Case {
    let text = fs::read_to_string(root().join("tests/data/scenes").join(name)).unwrap();
    let line = |line: &str| match line.split(' ').next() {
        Some("mesh") => "mesh = { file = \"plate.msh\", unit = \"mm\" }".to_owned(),
        Some("laminate") => format!("laminate = {laminate}"),
        _ => line.to_owned(),
    };
    let lines: Vec<String> = text.lines().map(line).collect();
    plate().text(&lines.join("\n")).mesh_bytes(halves([60e-3, 40e-3], [8, 6]))
}

const PLIES: &str = "plies = \"[0/45/-45/90]s\", material = \"tape\", ply_thickness = \"0.13208 mm\", layers = [4, 4], \
                     interface = \"resin\"";

#[test]
fn two_regions_of_one_laminate_are_the_undivided_plate_bit_for_bit() {
    let name = "impact-everything-written.toml";
    let [whole, divided] =
        [format!("{{ {PLIES} }}"), format!("[{{ group = \"left\", align = \"bottom\", {PLIES} }}, {{ {PLIES} }}]")]
            .map(|laminate| scene(name, &laminate));
    for case in [&whole, &divided] {
        case.fem("run", &["--out", "out"]).good();
    }
    assert_eq!(whole.names("out"), divided.names("out"));
    let mut compared = 0;
    for file in
        whole.names("out").iter().filter(|file| !["checkpoint.bin", "cost.json", "scene.toml"].contains(&file.as_str()))
    {
        let read = |case: &Case| fs::read(case.folder().join("out").join(file)).ok();
        assert!(read(&whole) == read(&divided), "{file}");
        compared += 1;
    }
    assert!(compared > 8, "{compared}");
}

/// Two bars in series: a cantilever of length L under a force F at its end, the clamped half of modulus E₁, the other of
/// E₂, w = F/(3 I) ((L³ − c³)/E₁ + c³/E₂) + F (a/G₁ + c/G₂)/(5/6 A), with a = c = L/2.
#[test]
fn a_cantilever_of_two_materials_bends_as_bars_in_series() {
    let (length, width, height, force) = (80.0_f64, 4.0_f64, 2.0_f64, 1.0);
    let (e1, e2) = (200e3, 70e3);
    let text = r#"
title = "two bars in series"
analysis = "static"
mesh = { file = "plate.msh", unit = "mm" }
element = { kind = "hex20" }
effects = { damage = "off" }
materials.stiff = { e = "200 GPa", nu = 0.0, density = "1 g/cm^3" }
materials.soft = { e = "70 GPa", nu = 0.0, density = "1 g/cm^3" }

[[laminate]]
plies = "[0_2]"
material = "soft"
ply_thickness = "1 mm"
layers = 1

[[laminate]]
group = "left"
plies = "[0_2]"
material = "stiff"
ply_thickness = "1 mm"
layers = 1

[[support]]
group = "x-min"
at = "all"
fix = ["U10", "U20", "U30"]

[[load]]
force_per_length = ["0 N/mm", "0 N/mm", "-0.25 N/mm"]
group = "x-max"
"#;
    let case = plate().text(text).mesh_bytes(halves([80e-3, 4e-3], [40, 2]));
    case.fem("run", &["--out", "out"]).good();
    let got = case.summary("out")["largest_deflection"]["w_m"].as_f64().unwrap().abs() * 1e3;
    let (inertia, c) = (width * height.powi(3) / 12.0, 0.5 * length);
    let bending = force / (3.0 * inertia) * ((length.powi(3) - c.powi(3)) / e1 + c.powi(3) / e2);
    let shear = force * (c / (0.5 * e1) + c / (0.5 * e2)) / (5.0 / 6.0 * width * height);
    assert!((got / (bending + shear) - 1.0).abs() < 2e-3, "{got} mm, not {}", bending + shear);
}

#[test]
fn laminates_that_do_not_fit_are_refused() {
    let name = "impact-everything-written.toml";
    let refused = |laminates: &str, words: &[&str]| {
        let said = scene(name, laminates).fem("check", &[]);
        let text = said.stderr.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert_eq!(said.status, 1, "{said:#?}");
        words.iter().for_each(|words| assert!(text.contains(words), "{words:?}: {text}"));
    };
    let other = |from: &str, to: &str| format!("[{{ {PLIES} }}, {{ group = \"left\", {} }}]", PLIES.replace(from, to));
    refused(&other("0.13208", "0.2"), &["laminates 1 and 2", "1.056640 and 1.600000 mm thick", "nothing says how"]);
    refused(&other("45/-45", "45"), &["the layers hold 8 plies, the laminate has 6"]);
    refused(&other(", interface = \"resin\"", ""), &["different materials between their plies"]);
    refused(&format!("[{{ {PLIES} }}, {{ {PLIES} }}]"), &["a second laminate has no `group`"]);
    refused(&format!("[{{ group = \"left\", {PLIES} }}]"), &["24 cells, among them cell 5, have no laminate"]);
    refused(&other("plies", "plies").replace("left", "lift"), &["no group `lift`", "left"]);
    let twice = format!("[{{ group = \"left\", {PLIES} }}, {{ group = \"plate\", {PLIES} }}]");
    refused(&twice, &["cell 1 has two laminates, those of `left` and `plate`"]);
}

#[test]
fn a_symmetry_that_the_regions_break_is_refused() {
    let text = |laminate: String| {
        let case = scene("impact-everything-written.toml", &laminate);
        let folded = format!("symmetry = \"half-turn\"\n{}", case.read(case.write()));
        let said = case.text(&folded).fem("check", &[]);
        said.stderr.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
    };
    let broken = text(format!("[{{ {PLIES} }}, {{ group = \"left\", {} }}]", PLIES.replace("45/-45", "-45/45")));
    assert!(broken.contains("make the mesh symmetric"), "{broken}");
    let kept = text(format!("{{ {PLIES} }}"));
    assert!(!kept.contains("make the mesh symmetric"), "{kept}");
}

#[test]
fn the_mass_is_that_of_all_laminates() {
    for x in ["15 mm", "45 mm"] {
        let text = format!(
            r#"
title = "a heavy half"
mesh = {{ file = "plate.msh", unit = "mm" }}
element = {{ kind = "mitc4" }}
effects = {{ damage = "off" }}
materials.heavy = {{ e = "70 GPa", nu = 0.3, density = "3 g/cm^3" }}
materials.light = {{ e = "70 GPa", nu = 0.3, density = "1 g/cm^3" }}
laminate = [
    {{ plies = "[0_2]", material = "light", ply_thickness = "0.5 mm", layers = 1 }},
    {{ group = "left", plies = "[0_2]", material = "heavy", ply_thickness = "0.5 mm", layers = 1 }},
]
support = [{{ group = "x-min", at = "mid-plane", fix = ["U10", "U20", "U30", "U13", "U23"] }}]
impactor = {{ mass = "1 g", velocity = "1 m/s", at = {{ x = "{x}", y = "20 mm" }} }}
contact = {{ law = "hertz", k = "1e8 N/m^1.5" }}
march = {{ step = "1 us", end = "5 us" }}
"#
        );
        let case = plate().text(&text).mesh_bytes(halves([60e-3, 40e-3], [8, 6]));
        case.fem("run", &["--out", "out"]).good();
        let mass = case.summary("out")["model"]["plate_mass_g"].as_f64().unwrap();
        assert!((mass / 4.8 - 1.0).abs() < 1e-9, "{mass} g");
    }
}

#[test]
fn a_profile_where_laminates_meet_says_on_which_side_it_is() {
    let text = r#"
title = "halves"
analysis = "static"
mesh = { file = "plate.msh", unit = "mm" }
element = { kind = "mitc4" }
materials.tape = { library = "AS4/3502" }
laminate = [
    { plies = "[0/90]s", material = "tape", ply_thickness = "0.25 mm", layers = 1 },
    { group = "left", plies = "[90/0]s", material = "tape", ply_thickness = "0.25 mm", layers = 1 },
]
effects = { damage = "off" }
support = [{ group = "x-min", at = "mid-plane", fix = ["U10", "U20", "U30", "U13", "U23"] }]
load = [{ pressure = "1 kPa" }]
profile = [{ name = "line", at = { x = "30 mm", y = "20 mm" } }, { name = "beside", at = { x = "22 mm", y = "20 mm" } }]
"#;
    let case = plate().text(text).mesh_bytes(halves([60e-3, 40e-3], [8, 6]));
    let said = case.fem("check", &[]).good();
    let said = format!("{}{}", said.stdout, said.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("profile `line` is where laminates meet") && said.contains("on the side of cell"), "{said}");
    assert!(!said.contains("profile `beside`"), "{said}");
}

/// Deflections count in thicknesses of the place that is struck, in whatever order impactors are named.
#[test]
fn thicknesses_are_those_of_the_place() {
    let ply = "material = \"tape\", ply_thickness = \"0.25 mm\", layers = 1";
    let laminate = format!(
        "[{{ group = \"left\", align = \"bottom\", plies = \"[0/90]s\", {ply} }}, {{ plies = \"[0/90/0/90]2s\", {ply} }}]"
    );
    let blow = |x: u32| {
        format!(
            "[[impactor]]\nname = 'at-{x}'\nmass = '20 g'\nvelocity = '4 m/s'\nat = {{ x = '{x} mm', y = '20 mm' }}\npatch_radius = '1 mm'\n"
        )
    };
    let found = |first: u32, second: u32| {
        let only = "impactor = { mass = \"20 g\", velocity = \"2 m/s\", at = { x = \"30 mm\", y = \"20 mm\" } }";
        let case = scene("study.toml", &laminate).scene(only, "").append(&format!("\n{}{}", blow(first), blow(second)));
        case.fem("run", &["--out", "out"]).good();
        let summary = case.summary("out");
        let warned = summary["warnings"].to_string().contains("membrane");
        let impacts = summary["impact"].as_array().unwrap().clone();
        let of = |x: u32| impacts.iter().find(|impact| impact["name"] == format!("at-{x}")).unwrap().clone();
        for (x, thickness) in [(15, 1e-3), (45, 4e-3)] {
            let [w, over] = ["peak_plate_displacement_m", "peak_plate_displacement_over_thickness"]
                .map(|key| of(x)[key].as_f64().unwrap());
            assert!((w / thickness / over - 1.0).abs() < 1e-9, "{x}: {w} m is {over} thicknesses");
        }
        warned
    };
    assert_eq!(found(15, 45), found(45, 15));
}

/// The same number is another ply where plies are others: each has its own first failure.
#[test]
fn what_fails_first_is_asked_of_every_region() {
    let case = crate::support::plate().text(
        "title = 'step'\nmesh = { rectangle = ['60 mm', '30 mm'], cells = [12, 6], groups = { r = { x = ['30 mm', '60 mm'] } } }\n\
         element = { kind = 'mitc4' }\nmaterials.tape = { library = 'AS4/3502' }\noutput = { maps = true, plots = false }\n\
         support = [{ group = 'x-min', kind = 'clamped' }, { group = 'x-max', kind = 'clamped' }]\n\
         impactor = { mass = '20 g', velocity = '12 m/s', at = { x = '26 mm', y = '15 mm' }, patch_radius = '3 mm' }\n\
         contact = { law = 'hertz', k = '5e3 N/mm^1.5' }\nmarch = { step = '1 us', end = '0.7 ms' }\n\
         failure = { criteria = ['tsai-wu'], every = '2 us', window = 'element' }\n\
         [[laminate]]\nplies = '[90/0/0/90]'\nmaterial = 'tape'\nply_thickness = '0.2 mm'\n\
         [[laminate]]\ngroup = 'r'\nalign = 'top'\nplies = '[90/0/0/0/90]'\nmaterial = 'tape'\nply_thickness = '0.2 mm'\n",
    );
    case.fem("run", &["--out", "out"]).good();
    let of = |table: &str, key: &str| {
        let (head, rows) = case.table(table);
        let at = |name: &str| head.iter().position(|column| column == name).unwrap();
        let (x, ply, value) = (at("x_m"), at("ply"), at(key));
        let number = |row: &Vec<String>, k: usize| row[k].parse::<f64>().unwrap();
        rows.iter().map(|row| (number(row, x) > 30e-3, row[ply].clone(), number(row, value))).collect::<Vec<_>>()
    };
    let (events, maxima) = (of("out/events.csv", "index"), of("out/index_maxima.csv", "index"));
    let mut failed: Vec<_> = maxima.into_iter().filter(|row| row.2 >= 1.0).map(|row| (row.0, row.1)).collect();
    let mut told: Vec<_> = events.into_iter().map(|row| (row.0, row.1)).collect();
    failed.sort();
    failed.dedup();
    told.sort();
    assert!(failed.iter().any(|row| row.0) && failed.iter().any(|row| !row.0), "{failed:?}");
    assert_eq!(told, failed);
}
