//! Quiet and talkative commands, completions, manual pages.

use crate::support::{fem, root, strip};

const COMMANDS: [&str; 14] = [
    "new",
    "run",
    "check",
    "advise",
    "envelope",
    "modes",
    "study",
    "report",
    "matrices",
    "mesh",
    "list",
    "schema",
    "completions",
    "man",
];

#[test]
fn quiet_says_nothing_but_errors() {
    let case = strip();
    let done = case.fem("run", &["--out", "out", "--quiet"]).good();
    assert_eq!((done.stdout.as_str(), done.stderr.as_str()), ("", ""));
    assert!(case.names("out").contains(&"summary.json".to_owned()));
    let data = case.fem("check", &["-q", "--json"]).good().stdout;
    assert!(data.starts_with('{'), "{data}");
    let done = strip().scene("\"2.49 kg\"", "2.49").fem("run", &["-q"]);
    assert!(done.status == 1 && done.stdout.is_empty() && done.stderr.contains("bare number"), "{done:#?}");
    assert_eq!(strip().fem("run", &["-q", "-v"]).status, 2, "one excludes the other");
}

#[test]
fn verbose_says_what_is_done_and_changes_no_result() {
    let case = strip();
    case.fem("run", &["--out", "silent"]).good();
    let [once, twice] = ["v", "vv"].map(|voice| case.fem("run", &["--out", voice, &format!("-{voice}")]).good());
    for words in [
        "mesh quads=8",
        "element=\"hermite-prism\"",
        "phase=\"assemble\"",
        "wall_s=",
        "summary.json",
        "march steps=200",
    ] {
        assert!(once.stderr.contains(words), "{words:?} is not in {}", once.stderr);
    }
    assert!(!once.stderr.contains("plug-in") && twice.stderr.contains("plug-in"), "{}", twice.stderr);
    for folder in ["v", "vv"] {
        assert_eq!(case.differing("silent", folder), Vec::<String>::new());
    }
    assert!(once.stdout.ends_with("results   v\n"), "{}", once.stdout);
}

#[test]
fn completions_know_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = fem(&root(), &["completions", shell]).good().stdout;
        for word in COMMANDS.iter().copied().chain(["--explain", "--template"]) {
            // fish and elvish write options without their hyphens.
            assert!(script.contains(word.trim_start_matches('-')), "{shell}: {word}");
        }
    }
}

#[test]
fn a_manual_page_per_command() {
    let folder = tempfile::tempdir().unwrap();
    let page = fem(folder.path(), &["man"]).good().stdout;
    assert!(page.contains(".TH fem 1") && page.contains("fem\\-run(1)"), "{page}");
    fem(folder.path(), &["man", "--out", "pages"]).good();
    for command in COMMANDS {
        let page = std::fs::read_to_string(folder.path().join(format!("pages/fem-{command}.1"))).unwrap();
        assert!(page.contains(&format!(".TH fem-{command} 1")), "{page}");
    }
    assert!(std::fs::read_to_string(folder.path().join("pages/fem-check.1")).unwrap().contains("explain"));
}

/// Every command says what it is for in a line, and how it is used.
#[test]
fn every_command_has_help() {
    let all = fem(&root(), &["--help"]).good().stdout;
    for command in COMMANDS {
        assert!(all.lines().any(|line| line.trim_start().starts_with(command)), "{command}: {all}");
        let help = fem(&root(), &[command, "--help"]).good().stdout;
        assert!(help.contains(&format!("Usage: fem {command}")), "{help}");
    }
}

/// What a log keeps: a line for each tenth, and no colour unless it is asked for.
#[test]
fn progress_and_colours_are_asked_for() {
    let case = strip();
    let done = case.fem("run", &["--out", "out", "--progress", "plain"]).good();
    let lines: Vec<_> = done.stderr.lines().collect();
    assert_eq!(lines.len(), 10, "{}", done.stderr);
    assert!(lines[0].starts_with("march: 10 %, after ") && lines[9].starts_with("march: 100 %"), "{}", done.stderr);
    assert_eq!(case.fem("run", &["--out", "out"]).good().stderr, "", "no bar outside a terminal");

    let wrong = strip().scene("\"2.49 kg\"", "2.49");
    let colored = |options: &[&str]| wrong.fem("check", options).stderr.contains('\u{1b}');
    assert!(colored(&["--color", "always"]) && !colored(&["--color", "never"]) && !colored(&[]));
}
