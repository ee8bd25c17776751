//! The book says what the program does.

mod links;
mod readme;

use crate::registry::criteria;
use crate::snapshots::element;
use crate::support::{Case, root, strip};
use fem::Registry;
use fem::core::dof::Dof;
use fem::core::element::Tables;
use fem::core::failure::Site;
use fem::core::plugin::{Built, Kind, Params, PluginInfo};
use std::fmt::Write;
use std::fs;

/// The head of what the tests write.
const WRITTEN: &str = "<!-- Written by `UPDATE_BOOK=1 cargo test --test all book`. -->\n\n";

/// Every criterion of the registry, in Markdown.
fn criteria_table() -> String {
    let mut text = WRITTEN.to_owned();
    text.push_str("| criterion | judges | modes | strengths | axes |\n| --- | --- | --- | --- | --- |\n");
    let all = criteria();
    for (info, criterion) in &all {
        let about = criterion.info();
        let judges = match (info.name, about.site) {
            ("expression", _) => "ply or interface",
            (_, Site::Ply) => "ply",
            (_, Site::Interface) => "interface",
        };
        let strengths: Vec<_> = about.strengths.iter().map(|s| s.name()).collect();
        let (modes, strengths) = match info.name {
            "expression" => ("one per formula".to_owned(), "those it names".to_owned()),
            _ => (about.modes.join(", "), if strengths.is_empty() { "none".into() } else { strengths.join(" ") }),
        };
        let axes = if about.invariant_about_fibre { "any" } else { "the ply's" };
        writeln!(text, "| [`{0}`](#{0}) | {judges} | {modes} | {strengths} | {axes} |", info.name).unwrap();
    }
    for (info, criterion) in &all {
        let [name, summary, source] = [info.name, info.summary, info.source];
        let scope = criterion.scope();
        write!(text, "\n## {name}\n\n{summary}\n\nSource: {source}. It takes {scope}.\n").unwrap();
        for (k, p) in info.params.iter().enumerate() {
            writeln!(text, "{}* `{}`: {}", if k == 0 { "\n" } else { "" }, p.name, p).unwrap();
        }
    }
    text
}

/// Every element of the registry with its default parameters, in Markdown.
fn elements_table() -> String {
    let mut text = WRITTEN.to_owned();
    text.push_str("| element | is a | stands on | nodes | unknowns of a node | what for | parameters | source |\n");
    text.push_str("| --- | --- | --- | ---: | --- | --- | --- | --- |\n");
    for info in Registry::standard().list(Kind::Element) {
        let element = element(info.name, &Params::default());
        let about = element.info();
        let is_a = match (about.is_section(), about.is_shell()) {
            (true, _) => "section",
            (_, true) => "shell",
            _ => "solid",
        };
        let unknowns: Vec<_> = about.dofs.iter().map(Dof::to_string).collect();
        let params = parameters_of(info);
        let forms = [Some(&*element), element.triangular()].into_iter().flatten();
        let nodes: Vec<_> = forms.map(|form| form.info().nodes.len().to_string()).collect();
        let (nodes, unknowns, on) = (nodes.join(", "), unknowns.join(" "), Tables::from(&*element).cells());
        let cells = [&format!("`{}`", info.name), is_a, on, &nodes, &unknowns, info.summary, &params, info.source];
        writeln!(text, "| {} |", cells.join(" | ")).unwrap();
    }
    text
}

/// Every plug-in of a kind in the registry, in Markdown.
fn plain_table(kind: Kind, called: &str) -> String {
    let mut text = WRITTEN.to_owned();
    writeln!(text, "| {called} | what it is | parameters | source |\n| --- | --- | --- | --- |").unwrap();
    for info in Registry::standard().list(kind) {
        writeln!(text, "| `{}` | {} | {} | {} |", info.name, info.summary, parameters_of(info), info.source).unwrap();
    }
    text
}

/// Every integrator of the registry with its default parameters, in Markdown.
fn integrators_table() -> String {
    let mut text = WRITTEN.to_owned();
    text.push_str(
        "| integrator | what it is | ω Δt at most | parameters | source |\n| --- | --- | ---: | --- | --- |\n",
    );
    let registry = Registry::standard();
    for info in registry.list(Kind::Integrator) {
        let limit = match registry.build(Kind::Integrator, info.name, &Params::default()) {
            Ok(Built::Integrator(integrator)) => integrator.limit(),
            other => panic!("{}: {other:?}", info.name),
        };
        let limit = match limit.product() {
            None => "any".to_owned(),
            Some(limit) => format!("{limit:.4}").trim_end_matches('0').to_owned(),
        };
        let cells = [&format!("`{}`", info.name), info.summary, &limit, &parameters_of(info), info.source];
        writeln!(text, "| {} |", cells.join(" | ")).unwrap();
    }
    text
}

fn parameters_of(info: &PluginInfo) -> String {
    let params: Vec<_> = info.params.iter().map(|p| format!("`{}`: {p}", p.name)).collect();
    if params.is_empty() { "none".to_owned() } else { params.join("<br>") }
}

#[test]
fn the_tables_are_those_of_the_registry() {
    for (file, table) in [
        ("criteria-table.md", criteria_table()),
        ("elements-table.md", elements_table()),
        ("contact-laws-table.md", plain_table(Kind::Contact, "law")),
        ("ply-laws-table.md", plain_table(Kind::PlyLaw, "law")),
        ("interface-laws-table.md", plain_table(Kind::InterfaceLaw, "law")),
        ("reductions-table.md", plain_table(Kind::Reduction, "reduction")),
        ("integrators-table.md", integrators_table()),
    ] {
        let file = root().join("docs/book/src").join(file);
        if std::env::var_os("UPDATE_BOOK").is_some() {
            fs::write(&file, &table).unwrap();
        }
        let written = fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
        assert_eq!(written, table, "write the tables anew: UPDATE_BOOK=1 cargo test --test all book");
    }
}

/// The book explains whatever `check_element` and the matrices may say, and nothing that they do not.
/// Who cites it, and who reads what changed, finds the version that is built, and one date.
#[test]
fn the_version_is_the_same_everywhere() {
    let version = env!("CARGO_PKG_VERSION");
    let citation = fs::read_to_string(root().join("CITATION.cff")).unwrap();
    assert!(citation.contains(&format!("\nversion: {version}\n")), "{citation}");
    let date = citation.split_once("\ndate-released: ").and_then(|(_, rest)| rest.lines().next()).unwrap();
    let changes = fs::read_to_string(root().join("CHANGELOG.md")).unwrap();
    assert!(changes.contains(&format!("\n## [{version}] - {date}\n")), "{version}, {date}");
}

#[test]
fn the_messages_about_elements_are_explained() {
    let read = |file: &str| fs::read_to_string(root().join(file)).unwrap().replace("\r\n", "\n");
    let source = read("fem-core/src/testkit/element.rs") + &read("fem-core/src/contracts/element.rs");
    let pieces: Vec<&str> = source.split('"').collect();
    let messages: Vec<&str> = pieces
        .windows(2)
        .filter(|w| ["Err(", "format!("].iter().any(|call| w[0].trim_end().ends_with(call)))
        .map(|w| w[1])
        // Where it was found stands before every message.
        .filter(|message| !message.starts_with("{name} cell, {plies}"))
        .collect();
    let chapter = read("docs/book/src/own-element.md");
    let (_, table) = chapter.split_once("| it says |").unwrap();
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let explained: Vec<&str> = rows.map(|row| row.split('`').nth(1).unwrap()).collect();
    // The longest of what stands between the values of a message.
    let fixed = |message: &str| {
        let parts = message.split(['{', '}', '…']).step_by(if message.contains('{') { 2 } else { 1 });
        parts.max_by_key(|part| part.len()).unwrap().to_owned()
    };
    for message in &messages {
        assert!(explained.iter().any(|e| e.contains(&fixed(message))), "{message:?} is not in the book");
    }
    for message in &explained {
        assert!(messages.iter().any(|m| m.contains(&fixed(message))), "{message:?} is only in the book");
    }
    assert_eq!(messages.len(), explained.len(), "{messages:?} {explained:?}");
}

#[test]
fn the_criterion_of_the_book_runs() {
    let formulas = fs::read_to_string(root().join("docs/book/src/criterion.toml")).unwrap().replace("\r\n", "\n");
    let case = Case::example("as4-3502-8ply-25mm")
        .scene("criteria = [\"hashin-report\", \"octahedral\"]\n", "")
        .scene("end = \"1 ms\"", "end = \"0.05 ms\"")
        .append(&format!("\n{formulas}"));
    case.fem("run", &["--out", "results"]).good();
    let summary = case.summary("results");
    let entries = |key: &str| summary[key].as_array().unwrap().clone();
    let modes = [entries("first_damage"), entries("not_reached")].concat();
    let mut names: Vec<_> = modes.iter().map(|m| m["mode"].as_str().unwrap()).collect();
    names.sort_unstable();
    assert_eq!(names, ["fibre", "matrix compression", "matrix tension"]);
}

#[test]
fn the_element_of_the_book_is_taken() {
    let element = fs::read_to_string(root().join("docs/book/src/element.toml")).unwrap().replace("\r\n", "\n");
    let case = Case::example("as4-3502-8ply-25mm").append(&format!("\n{element}"));
    let done = case.fem("check", &["--full"]).good();
    // Derivatives without inertia vibrate infinitely fast.
    assert_ne!(done.stdout, Case::example("as4-3502-8ply-25mm").fem("check", &["--full"]).good().stdout);
}

#[test]
fn the_contact_of_the_book_is_taken() {
    let contact = fs::read_to_string(root().join("docs/book/src/contact.toml")).unwrap().replace("\r\n", "\n");
    let example = fs::read_to_string(root().join("examples/as4-3502-8ply-25mm/scene.toml")).unwrap();
    let (_, from) = example.split_once("[contact]").unwrap();
    let from = format!("[contact]{}", from.split_once("\n\n").unwrap().0);
    Case::example("as4-3502-8ply-25mm").scene(&from, &contact).fem("check", &[]).good();
}

#[test]
fn the_reduction_of_the_book_is_taken() {
    let reduction = fs::read_to_string(root().join("docs/book/src/reduction.toml")).unwrap().replace("\r\n", "\n");
    let done = Case::example("as4-3502-8ply-25mm").append(&format!("\n{reduction}")).fem("check", &["--full"]).good();
    assert!(done.stdout.contains("  march     83 unknowns"), "{}", done.stdout);
}

#[test]
fn the_mesh_of_the_book_is_refined() {
    let mesh = fs::read_to_string(root().join("docs/book/src/mesh.toml")).unwrap();
    let quads = |case: Case| {
        let done = case.fem("check", &[]).good();
        let words: Vec<_> = done.stdout.split_whitespace().collect();
        let at = words.iter().position(|word| word.starts_with("quads")).unwrap_or_else(|| panic!("{}", done.stdout));
        words[at - 1].parse::<usize>().unwrap()
    };
    let example = || Case::example("as4-3502-8ply-25mm");
    let refined = example().scene("mesh = { file = \"plate.msh\", unit = \"mm\" }", mesh.trim());
    assert_eq!(quads(refined), 4 * quads(example()));
}

#[test]
fn the_supports_of_the_book_hold() {
    let supports = fs::read_to_string(root().join("docs/book/src/supports.toml")).unwrap();
    let scene = fs::read_to_string(root().join("examples/pagano-0-90-0/scene.toml")).unwrap();
    let (start, end) = (scene.find("[[support]]").unwrap(), scene.find("[[load]]").unwrap());
    let rectangle = scene[..start].replace("\"5 mm\", \"5 mm\"", "\"80 mm\", \"50 mm\"").replace("[6, 6]", "[16, 10]");
    let case = strip().text(&format!("{supports}{rectangle}{}", &scene[end..scene.find("[[profile]]").unwrap()]));
    let done = case.fem("check", &["--explain"]).good();
    for line in [
        "`x-min`, clamped: U10 U11 U13 U20 U21 U23 U30 U31 at 44 nodes, 1 along the edge and 2 across it",
        "the disc at (60.0000, 40.0000) mm, roller: U30 U31",
    ] {
        assert!(done.stdout.contains(line), "{}", done.stdout);
    }
}

/// Axes, keys and quantities of studies are those of the program.
#[test]
fn the_studies_of_the_book_are_made() {
    let read = |file: &str| fs::read_to_string(root().join("docs/book/src").join(file)).unwrap().replace("\r\n", "\n");
    let chapter = read("study.md");
    for axis in fem::study::NAMES {
        assert!(chapter.contains(&format!("`{axis}`")), "{axis}");
    }
    let case = Case::example("as4-3502-8ply-25mm")
        .scene("end = \"1 ms\"", "end = \"0.4 ms\"")
        .append(&format!("\n{}", read("study.toml")));
    case.fem("study", &["--axis", "samples,tip", "--out", "study"]).good();
    let (header, rows) = case.table("study/study.csv");
    let settings: Vec<_> = rows.iter().map(|row| (&*row[0], &*row[3])).collect();
    // The scene, two levels beside its own every 5 us, these and its own together, and two other problems.
    assert!(settings.iter().all(|(_, refused)| refused.is_empty()), "{settings:?}");
    let count = |axis: &str| settings.iter().filter(|row| row.0 == axis).count();
    assert!(count("samples") == 3 && count("joint") >= 2 && count("tip") == 2, "{settings:?}");
    for quantity in ["peak-force error", "impulse error", "first-damage error"] {
        assert!(header.iter().any(|column| column == quantity), "{header:?}");
    }

    let plate = fs::read_to_string(root().join("examples/pagano-0-90-0/scene.toml")).unwrap();
    let plate = strip().text(&plate.replace("cells = [6, 6]", "cells = [2, 2]"));
    let plate = plate.append(&format!("\n{}", read("study-stress.toml")));
    plate.fem("study", &["--axis", "mesh", "--budget", "1s", "--out", "study"]).good();
    let (header, _) = plate.table("study/study.csv");
    assert!(header.iter().any(|column| column == "sxx at the top error"), "{header:?}");
}

/// The example of the book of what may be watched, with a material of the book's own file.
#[test]
fn what_the_book_watches_is_written() {
    let book = root().join("docs/book/src");
    let watch = fs::read_to_string(book.join("watch.toml")).unwrap().replace("\r\n", "\n");
    let case = Case::example("as4-3502-8ply-25mm")
        .scene("[failure]\ncriteria = [\"hashin-report\", \"octahedral\"]\n", "")
        .scene("{ library = \"AS4/3502\" }", "{ file = \"materials.toml\", name = \"our tape\" }")
        .scene("end = \"1 ms\"", "end = \"0.05 ms\"")
        .append(&format!("\n{watch}"));
    case.write();
    fs::copy(book.join("materials.toml"), case.folder().join("plate/materials.toml")).unwrap();
    case.fem("run", &["--out", "results"]).good();
    let (_, rows) = case.table("results/index_history.csv");
    let histories: std::collections::BTreeSet<_> = rows.iter().map(|row| (&*row[1], &*row[4])).collect();
    assert_eq!(
        histories.into_iter().collect::<Vec<_>>(),
        [("hashin-report", "1"), ("octahedral", "4|5"), ("puck", "1")]
    );
    assert!(case.names("results").contains(&"index_maxima.csv".to_owned()));
    assert_eq!(case.summary("results")["delamination_threshold"]["toughness_GIIc_J_m2"], 600.0);
}
