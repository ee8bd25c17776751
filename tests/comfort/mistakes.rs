//! What is said to typical mistakes, for people to judge.

use crate::support::{Case, fem_reading, strip};
use serde_json::Value;
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

/// Mistakes that have nothing to do with each other are said at once, by their lines; what follows from one is not said.
#[test]
fn several_mistakes_at_once() {
    let case = strip()
        .scene("mass = \"2.49 kg\"", "mas = \"2.49 kg\"")
        .scene("\"1.56 m/s\"", "1.56")
        .scene("end = \"20 us\"", "end = \"20 usec\"")
        .scene("at = \"all\"", "at = \"everything\"");
    let said = case.fem("check", &[]).stderr;
    let order = ["support[0].at", "unknown key `impactor.mas`", "`impactor.velocity`", "`march.end`"];
    let places: Vec<_> =
        order.iter().map(|words| said.find(words).unwrap_or_else(|| panic!("{words}: {said}"))).collect();
    assert!(places.is_sorted(), "{said}");
    assert_eq!(said.matches('×').count(), 4, "{said}");

    let done = case.fem("check", &["--message-format", "json"]);
    let messages: Vec<Value> = done.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!((done.status, messages.len()), (1, 4), "{}", done.stderr);
    let lines: Vec<_> = case.read("plate/scene.toml").lines().map(str::to_owned).collect();
    for (message, words) in messages.iter().zip(["everything", "mas = ", "1.56", "20 usec"]) {
        assert_eq!((&message["level"], &message["file"]), (&"error".into(), &"plate/scene.toml".into()));
        let line = &lines[message["line"].as_u64().unwrap() as usize - 1];
        let from = message["column"].as_u64().unwrap() as usize - 1;
        let shown = &line[from..from + message["length"].as_u64().unwrap() as usize];
        assert!(line.contains(words) && words.contains(shown.trim_matches('"').trim_end_matches(" =")), "{message}");
        assert!(message["help"].as_str().is_some_and(|help| !help.is_empty()), "{message}");
    }
}

#[test]
fn a_scene_on_standard_input() {
    let case = strip();
    let scene = case.write();
    let text = case.read(scene).replace("file = \"plate.msh\"", "file = \"plate/plate.msh\"");
    let run = |arguments: &[&str], text: &str| fem_reading(case.folder(), arguments, text);
    let from_file = case.fem("check", &[]).good().stdout;
    assert_eq!(run(&["check", "-"], &text).good().stdout, from_file);
    run(&["run", "-", "--out", "out"], &text).good();
    assert_eq!(case.read("out/scene.toml"), text);
    let wrong = run(&["check", "-"], &text.replace("2.49 kg", "2.49"));
    assert!(wrong.status == 1 && wrong.stderr.contains("standard input:"), "{wrong:#?}");
    let again = run(&["map", "-"], &text);
    assert!(again.status == 1 && again.stderr.contains("give the scene as a file"), "{again:#?}");
}
