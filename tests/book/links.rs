//! The pages hold together: what they link to, include and name is there, and every chapter stands in the table of the book.

use crate::support::root;
use fem::io::scene;
use std::fs;
use std::path::{Path, PathBuf};

const BOOK: &str = "docs/book/src";

/// A page as it is read: with what it includes.
struct Page {
    /// From the repository.
    path: PathBuf,
    text: String,
}

impl Page {
    fn read(path: &Path) -> Result<Self, String> {
        let source = file(path)?;
        let (mut text, mut rest) = (String::new(), &*source);
        while let Some((before, after)) = rest.split_once("{{#include ") {
            let (target, after) = after.split_once("}}").ok_or("an include without an end")?;
            let (name, anchor) = target.split_once(':').unwrap_or((target, ""));
            text.push_str(before);
            text.push_str(&part(&file(&beside(path, name))?, anchor).ok_or(format!("no anchor: {target}"))?);
            rest = after;
        }
        Ok(Self { path: path.to_owned(), text: text + rest })
    }

    /// Targets of links and pictures.
    fn links(&self) -> impl Iterator<Item = &str> {
        let prose = self.text.split("```").step_by(2);
        let targets = prose.flat_map(|prose| prose.split("](").skip(1)).filter_map(|rest| rest.split(')').next());
        targets.filter(|target| !target.contains("://"))
    }

    /// Whether a link to this part of it leads somewhere.
    fn has(&self, heading: &str) -> bool {
        heading.is_empty() || self.text.lines().filter(|line| line.starts_with('#')).any(|line| slug(line) == heading)
    }

    /// Blocks of TOML that are whole scenes.
    fn scenes(&self) -> impl Iterator<Item = &str> {
        let blocks = self.text.split("```").skip(1).step_by(2).filter_map(|block| block.split_once('\n'));
        let toml = blocks.filter_map(|(language, text)| Some((language.strip_prefix("toml")?, text)));
        toml.filter(|(mark, text)| *mark == ",scene" || text.lines().any(|line| line.starts_with("title = ")))
            .map(|(_, text)| text)
    }

    /// Files of the repository that it names, in prose and in commands.
    fn names(&self) -> impl Iterator<Item = &str> {
        let words = self.text.split(|c: char| c.is_whitespace() || "`\"'()[]{},;|<>".contains(c));
        words.map(|word| word.trim_end_matches(['.', ':'])).filter(|word| {
            let top = word.split('/').next().unwrap_or(word);
            top != *word && !word.contains(['*', '…']) && TOP.contains(&top)
        })
    }
}

/// Folders of the repository that pages speak of.
const TOP: [&str; 10] = [
    "benches",
    "docs",
    "examples",
    "fem-core",
    "fem-dynamics",
    "fem-elements",
    "fem-failure",
    "fem-io",
    "src",
    "tests",
];

fn file(path: &Path) -> Result<String, String> {
    let text = fs::read_to_string(root().join(path)).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(text.replace("\r\n", "\n"))
}

/// `name` as seen from `page`, without `..`.
fn beside(page: &Path, name: &str) -> PathBuf {
    let mut path = page.parent().unwrap_or(Path::new("")).to_owned();
    for step in name.split('/') {
        match step {
            ".." => assert!(path.pop(), "{name} leaves the repository"),
            step => path.push(step),
        }
    }
    path
}

/// What stands between the marks of `anchor`, or all, without marks.
fn part(text: &str, anchor: &str) -> Option<String> {
    let is =
        |line: &str, mark: &str| line.split_once(mark).is_some_and(|(_, name)| name.split(' ').next() == Some(anchor));
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    if !anchor.is_empty() {
        let begin = lines.iter().position(|line| is(line.trim_end(), "ANCHOR: "))?;
        let length = lines[begin..].iter().position(|line| is(line.trim_end(), "ANCHOR_END: "))?;
        lines = lines[begin + 1..begin + length].to_vec();
    }
    lines.retain(|line| !line.contains("ANCHOR: ") && !line.contains("ANCHOR_END: "));
    Some(lines.concat())
}

/// The anchor of a heading.
fn slug(heading: &str) -> String {
    let kept = |c: char| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || "-_".contains(c) => Some(c.to_ascii_lowercase()),
        _ => None,
    };
    heading.trim_start_matches('#').trim().chars().filter_map(kept).collect()
}

/// Files below a folder of the repository, by their ending.
fn below(folder: &str, ending: &str) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![PathBuf::from(folder)]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).unwrap() {
            let entry = entry.unwrap();
            let path = folder.join(entry.file_name());
            if entry.file_type().unwrap().is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Every page of the documentation.
fn pages() -> Vec<Page> {
    let paths = below("docs", "md").into_iter().chain([PathBuf::from("README.md")]);
    paths.map(|path| Page::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))).collect()
}

/// Complains of all faults at once.
#[track_caller]
fn none(faults: &[String]) {
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Whoever reads the files as they are, from the first page on, sees no `{{#include}}` of the book.
#[test]
fn the_readme_leads_to_pages_that_stand_alone() {
    let linked = Page::read(Path::new("README.md")).unwrap();
    let pages = linked.links().map(|link| link.split('#').next().unwrap_or(link)).filter(|link| link.ends_with(".md"));
    let unfilled: Vec<&str> = pages.filter(|page| file(Path::new(page)).unwrap().contains("{{#")).collect();
    assert_eq!(unfilled, [""; 0]);
}

#[test]
fn links_lead_somewhere() {
    let (mut links, mut faults) = (0, Vec::new());
    for page in pages() {
        for link in page.links() {
            let (name, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if name.is_empty() { page.path.clone() } else { beside(&page.path, name) };
            let found = if target.extension().is_some_and(|e| e == "md") {
                Page::read(&target).is_ok_and(|target| target.has(heading))
            } else {
                root().join(target).exists()
            };
            if !found {
                faults.push(format!("{}: {link}", page.path.display()));
            }
            links += 1;
        }
    }
    none(&faults);
    assert!(links >= 150, "{links}");
}

/// A file of the book is a chapter of its table or part of one, and no chapter stands there twice.
#[test]
fn every_chapter_is_in_the_table_of_the_book() {
    let summary = Page::read(&Path::new(BOOK).join("SUMMARY.md")).unwrap();
    let mut chapters: Vec<&str> = summary.links().collect();
    chapters.sort_unstable();
    let sources: String = below(BOOK, "md").iter().map(|path| file(path).unwrap()).collect();
    let mut faults: Vec<String> = chapters.windows(2).filter(|pair| pair[0] == pair[1]).map(|p| p[0].into()).collect();
    for path in below(BOOK, "md") {
        let name = path.strip_prefix(BOOK).unwrap().to_str().unwrap();
        let chapter = chapters.contains(&name);
        if name != "SUMMARY.md" && chapter == sources.contains(&format!("{{{{#include {name}}}}}")) {
            faults.push(format!("{name} is {} in the table of the book", if chapter { "twice" } else { "not" }));
        }
        if chapter && !file(&path).unwrap().starts_with(['#', '{']) {
            faults.push(format!("{name} has no heading"));
        }
    }
    none(&faults);
}

#[test]
fn the_scenes_of_the_pages_can_be_read() {
    let (mut scenes, mut faults) = (0, Vec::new());
    for page in pages() {
        for text in page.scenes() {
            if let Err(why) = scene::parse(text, &page.path) {
                faults.push(format!("{}: {why}", page.path.display()));
            }
            scenes += 1;
        }
    }
    none(&faults);
    assert!(scenes >= 2, "{scenes}");
}

#[test]
fn files_that_the_pages_name_are_there() {
    let (mut names, mut faults) = (0, Vec::new());
    for page in pages() {
        for name in page.names() {
            if !root().join(name).exists() {
                faults.push(format!("{}: {name}", page.path.display()));
            }
            names += 1;
        }
    }
    none(&faults);
    assert!(names >= 100, "{names}");
}

#[test]
fn anchors_and_headings_are_found() {
    let text = "a\n// ANCHOR: one\nb\n// ANCHOR: two\nc\n// ANCHOR_END: two\n// ANCHOR_END: one\nd\n";
    let of = |anchor| part(text, anchor);
    assert_eq!([of("one"), of("two"), of("")], ["b\nc\n", "c\n", "a\nb\nc\nd\n"].map(|t| Some(t.to_owned())));
    assert_eq!(of("three"), None);
    assert_eq!(slug("## What it's for: `Unm`, n_1"), "what-its-for-unm-n_1");
    assert_eq!(beside(Path::new("docs/book/src/a.md"), "../../b/c.md"), Path::new("docs/b/c.md"));
}
