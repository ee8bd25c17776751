//! What is said to typical mistakes, for people to judge.

use crate::support::{Case, strip};
use std::fs;

#[test]
fn typical_mistakes() {
    let mut report = String::new();
    for (what, from, to) in [
        ("a misspelt key", "velocity = ", "velosity = "),
        ("a misspelt table", "[laminate]", "[laminat]"),
        ("a wrong unit", "\"2.49 kg\"", "\"2.49 N\""),
        ("an unknown unit", "\"2.49 kg\"", "\"2.49 kgs\""),
        ("a bare number", "\"2.49 kg\"", "2.49"),
        ("a decimal comma", "\"2.49 kg\"", "\"2,49 kg\""),
        ("a missing key", "mass = \"2.49 kg\"\n", ""),
        ("a missing quote", "\"2.49 kg\"", "\"2.49 kg"),
        ("a key twice", "mass = \"2.49 kg\"", "mass = \"2.49 kg\"\nmass = \"2 kg\""),
        ("a table twice", "[march]", "[laminate]\n[march]"),
        ("an unknown group", "group = \"clamped\"", "group = \"clampd\""),
        ("an unknown criterion", "\"octahedral\"", "\"octohedral\""),
        ("an unknown parameter", "beta = 0.4", "betta = 0.4"),
        ("a wrong parameter", "beta = 0.4", "beta = \"0.4 mm\""),
        ("a missing parameter", "k = \"1.07e5 N/mm^1.5\"\n", ""),
        ("an unknown material", "material = \"as4-3502\"", "material = \"as4-3520\""),
        ("an unknown word", "at = \"all\"", "at = \"everything\""),
        ("a layup with a slip", "\"[0/45/-45/90]2s\"", "\"[0/45/-45//90]2s\""),
        ("plies that do not fit the layers", "layers = [8, 8]", "layers = [8, 7]"),
        ("a mesh that is not there", "file = \"plate.msh\"", "file = \"plat.msh\""),
        ("a mesh that is none", "file = \"plate.msh\"", "file = \"scene.toml\""),
        ("an impact beside the plate", "x = \"15 mm\"", "x = \"150 mm\""),
        ("an effect that does not exist", "[march]", "[effects]\nmembrane = true\n\n[march]"),
    ] {
        report += &said(what, &strip().scene(from, to));
    }
    insta::assert_snapshot!(report);
}

fn said(what: &str, case: &Case) -> String {
    let done = case.fem("check", &[]);
    assert_eq!((done.status, done.stdout.as_str()), (1, ""), "{what}: {done:#?}");
    format!("== {what}\n{}\n", done.stderr.trim_end())
}

/// How the text is written down makes no difference, as long as it is UTF-8; otherwise the message says so.
#[test]
fn line_ends_tabs_and_encodings() {
    let plain = strip();
    let want = plain.fem("check", &[]).good().stdout;
    let scene = plain.read("plate/scene.toml");
    for (what, text) in [
        ("line ends of Windows", scene.replace('\n', "\r\n")),
        ("a byte order mark", format!("\u{feff}{scene}")),
        ("tabs", scene.replace(" = ", "\t=\t")),
    ] {
        assert_eq!(strip().text(&text).fem("check", &[]).good().stdout, want, "{what}");
    }
    let utf16 = |text: &str| [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    let latin = |text: &str| text.replace("title = \"", "title = \"\u{e9}").chars().map(|c| c as u8).collect();
    let bytes: [(&str, Vec<u8>); 2] = [("UTF-16", utf16(&scene)), ("not UTF-8 from line 1 on", latin(&scene))];
    for (words, bytes) in bytes {
        let case = strip();
        case.write();
        fs::write(case.folder().join("plate/scene.toml"), bytes).unwrap();
        let done = crate::support::fem(case.folder(), &["check", "plate/scene.toml"]);
        assert!(done.status == 1 && done.stderr.contains(words), "{done:#?}");
        assert!(done.stderr.contains("save it as UTF-8"), "{done:#?}");
    }
}
