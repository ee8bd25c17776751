//! Failure envelopes from the command line.

use crate::support::{Case, Done, fem};
use std::path::Path;
use tempfile::tempdir;

fn draw(folder: &Path, arguments: &str) -> Done {
    let arguments: Vec<&str> = ["envelope"].into_iter().chain(arguments.split_whitespace()).collect();
    fem(folder, &arguments)
}

fn table(folder: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_path(folder.join("envelope.csv")).unwrap();
    let row = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
    (row(reader.headers().unwrap()), reader.records().map(|r| row(&r.unwrap())).collect())
}

#[test]
fn several_criteria_share_one_table_and_one_picture() {
    let folder = tempdir().unwrap();
    let done = draw(folder.path(), "AS4/3502 --criteria hashin-1980,tsai-wu:f12=-0.3,puck --plane s2-s12").good();
    assert!(done.stdout.contains("hashin-1980") && done.stdout.contains("64.0      138.0      109.0"), "{done:#?}");
    let results = folder.path().join("results/envelope-as4-3502-s2-s12");
    let (header, rows) = table(&results);
    assert_eq!(header, ["criterion", "mode", "angle_deg", "s2_MPa", "s12_MPa"]);
    for criterion in ["hashin-1980", "tsai-wu:f12=-0.3", "puck"] {
        let of: Vec<_> = rows.iter().filter(|r| r[0] == criterion).collect();
        assert!(of.len() >= 361, "{criterion}: {}", of.len());
        assert_eq!(of.first().unwrap()[3..], of.last().unwrap()[3..], "{criterion} closes");
    }
    let matrix = |r: &&Vec<String>| r[0] == "hashin-1980" && r[1] == "matrix tension";
    for row in rows.iter().filter(matrix) {
        let [s2, s12]: [f64; 2] = [&row[3], &row[4]].map(|v| v.parse().unwrap());
        assert!(((s2 / 64.0).powi(2) + (s12 / 109.0).powi(2) - 1.0).abs() < 1e-12, "{row:?}");
    }
    let svg = std::fs::read_to_string(results.join("envelope.svg")).unwrap();
    assert!(svg.contains(">puck</text>") && svg.contains(">Stress s12 (MPa)</text>"));
    assert!(std::fs::read(results.join("envelope.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn a_scene_lends_its_materials_and_its_criteria() {
    let formula = "{ name = \"expression\", expression = \"(s2/Yt)^2 + (s12/S12)^2\" }, \"hashin-1980\"";
    let case = Case::example("as4-3502-8ply-25mm").scene("\"hashin-report\", \"octahedral\"", formula);
    let scene = case.write();
    draw(case.folder(), &format!("as4-3502 --scene {scene} --out own")).good();
    let (_, rows) = table(&case.folder().join("own"));
    let count = |name: &str| rows.iter().filter(|r| r[0] == name).count();
    assert!(count("expression") >= 361 && count("hashin-1980") >= 361);
    assert!(rows.iter().filter(|r| r[0] == "expression").all(|r| r[1] == "failure"));
    let done = draw(case.folder(), &format!("as4-3502 --scene {scene} --out one --criteria expression")).good();
    assert!(done.stdout.contains("expression") && !done.stdout.contains("hashin-1980"), "{done:#?}");
}

/// An envelope needs no density, nor does one of a material in a file of its own.
#[test]
fn every_tape_of_the_library_has_its_envelopes() {
    let folder = tempdir().unwrap();
    for name in ["AS4/3501-6", "T300/BSL914C", "E-glass/LY556", "E-glass/MY750", "IM7/8551-7"] {
        let material = fem::io::materials::library(name).unwrap();
        let done = draw(folder.path(), &format!("{name} --criteria hashin-1980,puck,cuntze --out drawn")).good();
        let yt = material.material.strengths.yt() * 1e-6;
        assert!(done.stdout.contains(&format!(" {yt:.1} ")), "{name}: {}", done.stdout);
    }
    let case = Case::example("as4-3502-8ply-25mm");
    let own = "mine = { file = \"mine.toml\", name = \"my tape\" }\nmaterials.as4-3502 = {";
    let case = case.scene("as4-3502 = {", own);
    let scene = case.write();
    let constant = |key: &str, value: &str| {
        format!("{key} = {{ value = {value}, status = \"measured\", source = \"our laboratory\" }}\n")
    };
    let constants = [
        ("e1", "\"140 GPa\""),
        ("e2", "\"9 GPa\""),
        ("nu12", "0.3"),
        ("nu23", "0.4"),
        ("g12", "\"5 GPa\""),
        ("Yt", "\"51 MPa\""),
        ("Yc", "\"180 MPa\""),
        ("S23", "\"60 MPa\""),
    ]
    .map(|(key, value)| constant(key, value));
    let text = format!(
        "[materials.\"my tape\"]\nsummary = \"ours\"\n[materials.\"my tape\".constants]\n{}",
        constants.concat()
    );
    std::fs::write(case.folder().join("plate/mine.toml"), text).unwrap();
    let done = draw(case.folder(), &format!("mine --scene {scene} --criteria choi-chang --plane s2-s23")).good();
    assert!(done.stdout.contains("51.0      180.0       60.0"), "{}", done.stdout);
}

#[test]
fn what_cannot_be_drawn_is_refused_with_the_reason() {
    let folder = tempdir().unwrap();
    for (arguments, words) in [
        ("AS4/3503 --criteria puck", "did you mean `AS4/3502`"),
        ("AS4/3502 --criteria pukc", "did you mean `puck`"),
        ("AS4/3502 --criteria tsai-wu:f12=2", "`f12`"),
        ("AS4/3502 --criteria tsai-wu:g12=0", "did you mean `f12`"),
        ("AS4/3502 --criteria tsai-wu:f12", "is not a parameter"),
        ("AS4/3502 --criteria tsai-hill --plane s1-s13", "refuses stresses of the plane s1-s13"),
        ("AS4/3502 --criteria max-stress-interface", "needs the strength Zt"),
        ("AS4/3502 --criteria octahedral,puck --scene none.toml", "none.toml"),
    ] {
        let done = draw(folder.path(), arguments);
        let words_of_error = done.stderr.replace("│ ", "").split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(done.status, 1, "{arguments}: {done:#?}");
        assert!(words_of_error.contains(words), "{arguments}: {done:#?}");
    }
    let done = draw(folder.path(), "AS4/3502 --criteria puck --plane s1-t2");
    assert_eq!(done.status, 2);
    assert!(done.stderr.contains("is not a plane"), "{done:#?}");
    assert_eq!(draw(folder.path(), "AS4/3502").status, 2);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "a refusal leaves nothing");
}
