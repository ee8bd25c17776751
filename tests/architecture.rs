//! Rooms import one way: the table of `docs/architecture.md` is the only list of what may import what, and sources and
//! manifests are held to it.

use crate::support::root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The crate on top, which alone may depend on others than the lowest.
const TOP: &str = "fem";
const LOWEST: &str = "fem-core";

/// Names of rooms with those that they may import; of crates likewise.
type Arrows = BTreeMap<String, BTreeSet<String>>;

/// What the table says.
#[derive(Default)]
struct Plan {
    crates: Arrows,
    rooms: BTreeMap<String, Arrows>,
}

impl Plan {
    /// The table of `page` whose columns begin with crate, room, may import. A row without a room is about the crate, a crate
    /// that is left out is that of the row above.
    fn read(page: &str) -> Self {
        let cells = |line: &str| line.split('|').skip(1).map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
        let names = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<BTreeSet<_>>();
        let mut lines = page
            .lines()
            .skip_while(|line| !cells(line).starts_with(&["crate", "room", "may import"].map(String::from)));
        lines.next();
        let (mut plan, mut own) = (Self::default(), String::new());
        for row in lines.take_while(|line| line.starts_with('|')).map(cells).filter(|row| !row[0].starts_with("---")) {
            if !row[0].is_empty() {
                row[0].clone_into(&mut own);
            }
            let (rooms, imports) = (names(&row[1]), names(&row[2]));
            if rooms.is_empty() {
                plan.crates.insert(own.clone(), imports.clone());
            }
            let arrows = plan.rooms.entry(own.clone()).or_default();
            arrows.extend(rooms.into_iter().map(|room| (room, imports.clone())));
        }
        plan
    }
}

/// What is wrong in the workspace at `root`, whose plan stands on `page`.
fn faults(root: &Path, page: &str) -> Vec<String> {
    let plan = Plan::read(page);
    let mut faults = circle(&plan.crates);
    for name in members(root) {
        let folder = if name == TOP { root.to_owned() } else { root.join(&name) };
        let Some(allowed) = plan.crates.get(&name) else {
            faults.push(format!("{name} is no crate of the table"));
            continue;
        };
        for dependency in dependencies(&read(&folder.join("Cargo.toml"))) {
            if !allowed.contains(&dependency) {
                faults.push(format!("{name} depends on {dependency}"));
            }
            if name != TOP && dependency != LOWEST {
                faults.push(format!("{name} and {dependency} are wings that know each other"));
            }
        }
        let own = plan.rooms.get(&name).cloned().unwrap_or_default();
        faults.extend(
            in_crate(&folder.join("src"), &own).into_iter().chain(circle(&own)).map(|fault| format!("{name}: {fault}")),
        );
    }
    faults
}

/// The crates of a workspace.
fn members(root: &Path) -> Vec<String> {
    let names = fs::read_dir(root).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> =
        names.filter(|name| name.starts_with("fem-") && root.join(name).join("src").exists()).collect();
    names.push(TOP.to_owned());
    names.sort();
    names
}

/// Crates of the workspace that a manifest names; those of its tests do not count.
fn dependencies(manifest: &str) -> Vec<String> {
    let lines = manifest.lines().skip_while(|line| *line != "[dependencies]").skip(1);
    let names = lines.take_while(|line| !line.starts_with('[')).filter_map(|line| line.split(['.', ' ', '=']).next());
    names.filter(|name| name.starts_with("fem-")).map(str::to_owned).collect()
}

/// What in the sources below `src` does not agree with the rooms of the plan.
fn in_crate(src: &Path, plan: &Arrows) -> Vec<String> {
    let mut found = BTreeMap::new();
    collect(src, &mut Vec::new(), &mut found);
    let mut faults = Vec::new();
    let there: BTreeSet<&String> = found.keys().filter_map(|path| path.first()).collect();
    for room in plan.keys().filter(|room| !there.contains(room)) {
        faults.push(format!("there is no room `{room}`"));
    }
    for missing in plan.values().flatten().filter(|room| !plan.contains_key(*room)).collect::<BTreeSet<_>>() {
        faults.push(format!("`{missing}` may be imported and is no room of the table"));
    }
    let shown = exports(&found[&Vec::new()]);
    for (path, text) in found.iter().filter(|(path, _)| !path.is_empty()) {
        let Some(allowed) = plan.get(&path[0]) else {
            faults.push(format!("`{}` is no room of the table", path[0]));
            continue;
        };
        for name in imports(text, path.len()) {
            let room = shown.get(&name).unwrap_or(&name);
            if *room != path[0] && !allowed.contains(room) {
                faults.push(format!("`{}` imports `{room}`", path.join("::")));
            }
        }
    }
    faults.sort();
    faults.dedup();
    faults
}

/// Code of the modules below `folder` by their paths, without that of tests; the crate's root has the empty path.
fn collect(folder: &Path, path: &mut Vec<String>, found: &mut BTreeMap<Vec<String>, String>) {
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = entry.file_stem().unwrap().to_str().unwrap().to_owned();
        if name == "tests" || name == "main" {
            continue;
        }
        path.push(name.clone());
        if entry.is_dir() {
            collect(&entry, path, found);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            let own = if ["mod", "lib"].contains(&&*name) { path[..path.len() - 1].to_vec() } else { path.clone() };
            found.insert(own, code(&read(&entry)));
        }
        path.pop();
    }
}

/// A source without comments and without its module of tests, which stands at its end.
fn code(text: &str) -> String {
    let plain = |line: &str| {
        let mut parts = line.match_indices("//").map(|(at, _)| &line[..at]);
        parts.find(|before| before.matches('"').count() % 2 == 0).unwrap_or(line).to_owned()
    };
    let lines: Vec<String> = text.lines().map(plain).collect();
    let opens = |line: &String| line.starts_with("mod ") && line.ends_with('{');
    let tests = (0..lines.len()).find(|i| {
        lines[*i] == "#[cfg(test)]" && lines[i + 1..].iter().find(|line| !line.starts_with('#')).is_some_and(opens)
    });
    lines[..tests.unwrap_or(lines.len())].join("\n")
}

/// Where the names that a crate's root exports come from.
fn exports(root: &str) -> BTreeMap<String, String> {
    let uses = root.split("use ").skip(1).filter_map(|rest| rest.split(';').next()?.split_once("::"));
    let each = uses.flat_map(|(room, names)| {
        let names = names.trim_matches(['{', '}', '\n', ' ']).split(',').map(str::trim).filter(|name| !name.is_empty());
        names.map(move |name| (name.rsplit([' ', ':']).next().unwrap_or(name).to_owned(), room.trim().to_owned()))
    });
    each.collect()
}

/// First names of all paths in a module `depth` steps from the root that begin there: `crate::room`, also of groups, and
/// `super` as often as it takes.
fn imports(code: &str, depth: usize) -> BTreeSet<String> {
    let begins = |at: usize| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
    let of = |word: &'static str| {
        code.match_indices(word).filter(move |(at, _)| begins(*at)).map(move |(at, _)| &code[at..])
    };
    let absolute = of("crate::").map(|path| &path["crate::".len()..]);
    let relative = of("super::").filter_map(|path| {
        let rest = path.trim_start_matches("super::");
        ((path.len() - rest.len()) / "super::".len() >= depth).then_some(rest)
    });
    absolute.chain(relative).flat_map(heads).collect()
}

/// First names of a path, or of those of a group in braces.
fn heads(path: &str) -> Vec<String> {
    let name =
        |path: &str| path.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let Some(group) = path.strip_prefix('{') else { return vec![name(path)] };
    let (mut open, mut start, mut names) = (1, 0, Vec::new());
    for (at, c) in group.char_indices() {
        match c {
            '{' => open += 1,
            '}' => open -= 1,
            _ => {}
        }
        if open == 0 || (open == 1 && c == ',') {
            names.push(name(&group[start..at]));
            start = at + 1;
        }
        if open == 0 {
            break;
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

/// Those that import each other, if any do.
fn circle(arrows: &Arrows) -> Vec<String> {
    let mut left = arrows.clone();
    while let Some(free) = left
        .iter()
        .find(|(_, imports)| !imports.iter().any(|name| left.contains_key(name)))
        .map(|(name, _)| name.clone())
    {
        left.remove(&free);
    }
    let names: Vec<String> = left.into_keys().collect();
    if names.is_empty() { names } else { vec![format!("a circle among {}", names.join(", "))] }
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap().replace("\r\n", "\n")
}

#[test]
fn rooms_import_as_the_table_says() {
    let page = read(&root().join("docs/architecture.md"));
    let found = faults(&root(), &page);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A small workspace with the sources and manifests of `files`.
fn made_up(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (path, text) in files {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

const TABLE: &str = "\
| crate | room | may import | what |
| --- | --- | --- | --- |
| fem-core | | | |
| | `words` | | |
| fem-io | | `fem-core` | |
| | `files` | | |
| fem | | `fem-core` `fem-io` | |
| | `low` | | |
| | `mid` `side` | `low` | |
| | `high` | `low` `mid` | |
";

const SOUND: &[(&str, &str)] = &[
    ("Cargo.toml", "[dependencies]\nfem-core.workspace = true\nfem-io = { workspace = true }\n[features]\n"),
    ("src/lib.rs", "mod high;\nmod low;\nmod mid;\nmod side;\npub use mid::{Thing, inner::Other as Named};\n"),
    (
        "src/low.rs",
        "//! [`crate::high`]\nfn f() {} // crate::high\nconst A: &str = \"//\";\n#[cfg(test)]\nmod tests {\n    use crate::high;\n}\n",
    ),
    ("src/mid/mod.rs", "mod inner;\nuse crate::low::f;\n"),
    ("src/mid/inner.rs", "use super::f;\nuse super::super::low;\nuse crate::mid;\n"),
    ("src/side.rs", "use super::low;\n#[cfg(test)]\nmod tests;\n"),
    ("src/side/tests.rs", "use crate::high;\n"),
    ("src/high.rs", "use crate::{low::{self, f}, Thing};\nuse crate::Named;\n"),
    ("fem-core/Cargo.toml", "[dependencies]\n[dev-dependencies]\nfem-io = \"1\"\n"),
    ("fem-core/src/lib.rs", "pub mod words;\n"),
    ("fem-core/src/words.rs", ""),
    ("fem-io/Cargo.toml", "[dependencies]\nfem-core.workspace = true\n"),
    ("fem-io/src/lib.rs", "pub mod files;\n"),
    ("fem-io/src/files.rs", ""),
];

#[test]
fn a_wrong_arrow_is_found() {
    assert_eq!(faults(made_up(SOUND).path(), TABLE), [""; 0]);
    for (path, text, want) in [
        ("src/low.rs", "use crate::mid;\n", "fem: `low` imports `mid`"),
        (
            "src/low.rs",
            "#[cfg(test)]\nmod tests;\nuse crate::{\n    low,\n    high::{A, B},\n};\n",
            "fem: `low` imports `high`",
        ),
        ("src/low.rs", "fn f() { crate::side::g() }\n", "fem: `low` imports `side`"),
        ("src/low.rs", "use crate::Named;\n", "fem: `low` imports `mid`"),
        ("src/low.rs", "use crate::nothing;\n", "fem: `low` imports `nothing`"),
        ("src/mid/inner.rs", "use super::super::high;\n", "fem: `mid::inner` imports `high`"),
        ("src/new/mod.rs", "", "fem: `new` is no room of the table"),
        (
            "fem-io/Cargo.toml",
            "[dependencies]\nfem-dynamics.workspace = true\n",
            "fem-io depends on fem-dynamics\nfem-io and fem-dynamics are wings that know each other",
        ),
        ("fem-new/src/lib.rs", "", "fem-new is no crate of the table"),
    ] {
        let folder = made_up(&[SOUND, &[(path, text)]].concat());
        assert_eq!(faults(folder.path(), TABLE).join("\n"), want);
    }
}

#[test]
fn a_wrong_table_is_found() {
    let folder = made_up(SOUND);
    for (row, instead, want) in [
        ("| | `high` |", "| | `high` `attic` |", "fem: there is no room `attic`"),
        ("| | `low` | |", "| | `low` | `high` |", "fem: a circle among high, low, mid, side"),
        ("| | `low` | |", "| | `low` | `cellar` |", "fem: `cellar` may be imported and is no room of the table"),
        ("| fem-core | | |", "| fem-core | | `fem` |", "a circle among fem, fem-core, fem-io"),
    ] {
        assert_eq!(faults(folder.path(), &TABLE.replace(row, instead)).join("\n"), want);
    }
}
