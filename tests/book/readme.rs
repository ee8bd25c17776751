//! The README says what the program does: its commands run in an empty folder, and what it shows is what they print.

use crate::support::{fem, root};
use regex_lite::Regex;
use std::fs;

/// Begins what `fem run` prints, and ends it.
const FENCES: [&str; 2] = ["```text\n", "```\n"];

/// The commands of the block whose first line begins with `first`, without their comments.
fn commands(readme: &str, first: &str) -> Vec<String> {
    let (_, block) = readme.split_once(&format!("```sh\n{first}")).unwrap();
    let block = format!("{first}{}", block.split_once("```").unwrap().0);
    block.lines().map(|line| line.split('#').next().unwrap().trim().to_owned()).collect()
}

/// What is the machine's own as a mark: seconds and memory, and the last digits of what is counted. Where the last iteration of a
/// contact ends depends on how its processor rounds, and so on how wide its registers are.
fn masked(text: &str) -> String {
    let own = Regex::new(r"[0-9.e-]+ (s|ms|us|ns|MB|GB)\b").unwrap();
    let of_machine = |line: &str| line.starts_with("  time ") || line.starts_with("  better ");
    let count = Regex::new(r"([0-9]{3})([0-9]+)").unwrap();
    let leading = |found: &regex_lite::Captures| format!("{}{}", &found[1], "#".repeat(found[2].len()));
    let mask = |line: &str| match line {
        _ if of_machine(line) => own.replace_all(line, "# $1").into_owned(),
        _ if line.starts_with("  work ") => count.replace_all(line, leading).into_owned(),
        _ => line.to_owned(),
    };
    // What takes a tenth of a second here takes milliseconds there.
    let unit = Regex::new(r"# (s|ms|us|ns|MB|GB)").unwrap();
    text.lines().map(|line| unit.replace_all(&mask(line), "#").into_owned() + "\n").collect()
}

#[test]
fn the_three_commands_print_what_is_shown() {
    let file = root().join("README.md");
    let readme = fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
    let folder = tempfile::tempdir().unwrap();
    let commands = commands(&readme, "fem new");
    assert_eq!(commands.len(), 3);
    let mut printed = String::new();
    for command in &commands {
        let arguments: Vec<_> = command.split_whitespace().skip(1).collect();
        let done = fem(folder.path(), &arguments).good();
        assert_eq!(done.stderr, "", "{command}");
        if arguments[0] == "run" {
            printed = done.stdout;
        }
    }
    let (before, rest) = readme.split_once(FENCES[0]).unwrap();
    let (shown, after) = rest.split_once(FENCES[1]).unwrap();
    if std::env::var_os("UPDATE_BOOK").is_some() {
        fs::write(&file, format!("{before}{}{printed}{}{after}", FENCES[0], FENCES[1])).unwrap();
        return;
    }
    assert_eq!(masked(shown), masked(&printed), "write it anew: UPDATE_BOOK=1 cargo test --test all book");
}

/// The two commands for everything are there, and what must hold calls just these.
#[test]
fn the_main_job_and_all_tests_are_commands_of_the_checks() {
    let read = |file: &str| fs::read_to_string(root().join(file)).unwrap().replace("\r\n", "\n");
    let (readme, checks) = (read("README.md"), read(".ci/run"));
    let commands = commands(&readme, "cargo run");
    for command in &commands[..2] {
        assert!(checks.lines().any(|line| line.trim_start() == format!("stage {command}")), "{command}");
    }
}
