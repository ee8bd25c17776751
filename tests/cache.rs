//! Plates that are kept: what comes from them is what would come without, and nothing in the folder is trusted.

use crate::support::{Case, failing, fem, read_under, root};
use fem::Registry;
use fem::io::cache::Cache;
use fem::io::checkpoint;
use fem::io::files::OutputDir;
use fem::io::scene::Setting;
use fem::job::{self, Found, Options};
use std::fs;
use std::path::Path;

fn quick() -> Case {
    let case = Case::example("as4-3502-8ply-25mm").scene("end = \"1 ms\"", "end = \"0.1 ms\"");
    case.append("\n[reduction]\nmethod = \"ritz\"\nvectors = 20\n\n[output]\nplots = false\n")
}

/// All numbers of a run, by the plates in `cache`.
fn run(case: &Case, cache: Option<&Cache>, set: &[(&str, &str)]) -> (String, String) {
    let path = case.folder().join("plate/scene.toml");
    let setting: Setting = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let scene = read_under(&path, &setting);
    let registry = Registry::standard().with_cache(cache.cloned());
    let done = job::run(&scene, &registry, &Options::default(), &mut ()).unwrap();
    let Found::Impact(found) = &done.found else { panic!("no impact") };
    (serde_json::to_string(&found.summary).unwrap(), format!("{:?}", found.outcome.history))
}

fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

/// With estimates of errors and counts of work; damping acts on modes that are kept without it.
#[test]
fn a_plate_that_is_kept_changes_no_bit() {
    let case = quick().append("\n[effects]\ndamping = { ratio = 0.02 }\n");
    case.write();
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::new(folder.path().to_owned(), 1 << 30);
    let plain = run(&case, None, &[]);
    assert!(run(&case, Some(&cache), &[]) == plain, "the run that makes it");
    let made = names(folder.path());
    assert_eq!(made.len(), 2, "modes and stresses");
    assert!(run(&case, Some(&cache), &[]) == plain, "one that takes it");
    // What comes after the plate takes the same.
    let after: &[&[(&str, &str)]] = &[
        &[("impactor.velocity", "\"2 m/s\""), ("contact.beta", "0.5")],
        &[("march.step", "\"0.25 us\""), ("materials.as4-3502.Yt", "\"40 MPa\"")],
    ];
    for set in after {
        assert!(run(&case, Some(&cache), set) == run(&case, None, set), "{set:?}");
        assert_eq!(names(folder.path()), made, "{set:?}");
    }
    // What shapes it does not.
    for (k, set) in [
        ("laminate.ply_thickness", "\"0.13 mm\""),
        ("reduction.vectors", "18"),
        ("materials.as4-3502.e1", "\"120 GPa\""),
    ]
    .iter()
    .enumerate()
    {
        assert!(run(&case, Some(&cache), &[*set]) == run(&case, None, &[*set]), "{set:?}");
        assert_eq!(names(folder.path()).len(), 2 * (k + 2), "{set:?}");
    }
    assert_eq!(cache.words(), [""; 0]);
}

/// Files with a right checksum about something that is no such plate.
#[test]
fn what_was_forged_is_refused() {
    let case = quick();
    case.write();
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::new(folder.path().to_owned(), 1 << 30);
    let plain = run(&case, Some(&cache), &[]);
    type Forge = fn(&mut Vec<u8>);
    let forges: [(&str, Forge); 7] = [
        ("longer", |bytes| bytes.extend([0; 4])),
        ("cut", |bytes| bytes.truncate(bytes.len() / 2)),
        ("a huge length", |bytes| {
            drop(bytes.splice(0..1, [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01]))
        }),
        ("nothing", Vec::clear),
        ("no number", |bytes| {
            let middle = bytes.len() / 2;
            bytes[middle..middle + 16].fill(0xff);
        }),
        ("other exponents", |bytes| {
            // Of the first list, before which stands its length: seven bits a byte.
            let digits = 1 + bytes.iter().position(|byte| byte & 0x80 == 0).unwrap();
            let length = bytes[..digits].iter().rev().fold(0, |sum, byte| (sum << 7) | usize::from(byte & 0x7f));
            for number in bytes[digits..].chunks_exact_mut(8).take(length).filter(|number| number[7] & 0x7f != 0) {
                number[7] ^= 0x10;
            }
        }),
        ("numbers moved", |bytes| {
            let end = bytes.len() - 16;
            bytes[64..end].rotate_left(80);
        }),
    ];
    let dir = OutputDir::open(folder.path()).unwrap();
    for name in names(folder.path()).iter().filter(|name| name.starts_with("plate-")) {
        let payload = checkpoint::read(&folder.path().join(name)).unwrap();
        for (what, forge) in forges {
            let mut forged = payload.clone();
            forge(&mut forged);
            fs::remove_file(folder.path().join(name)).unwrap();
            checkpoint::write(&dir, name, &forged).unwrap();
            assert!(run(&case, Some(&cache), &[]) == plain, "{name}, {what}");
            let words = cache.words();
            assert!(what == "longer" || words.len() == 1 && words[0].contains(name), "{name}, {what}: {words:?}");
            // It was made anew.
            assert_eq!(checkpoint::read(&folder.path().join(name)).unwrap().len(), forged_length(&payload, what));
        }
    }
}

/// What follows a sound beginning is not looked at.
fn forged_length(payload: &[u8], what: &str) -> usize {
    if what == "longer" { payload.len() + 4 } else { payload.len() }
}

/// The command says what it keeps, and keeps nothing unasked.
#[test]
fn the_command_keeps_what_it_is_told_to() {
    let case = quick();
    let cache = case.folder().join("kept");
    let folder = cache.to_str().unwrap();
    let scene = case.write();
    let run = |words: &[&str], of: &str| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_fem"));
        let done = command.args(words).current_dir(case.folder()).env("FEM_CACHE", of).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        String::from_utf8(done.stdout).unwrap()
    };
    fem(case.folder(), &["run", scene, "--out", "plain"]).good();
    run(&["run", scene, "--out", "out", "--no-cache"], folder);
    assert!(!cache.exists());
    run(&["run", scene, "--out", "out"], folder);
    run(&["run", scene, "--out", "again"], folder);
    for file in ["summary.json", "history.csv", "events.csv"] {
        assert!(case.read(&format!("again/{file}")) == case.read(&format!("plain/{file}")), "{file}");
    }
    assert!(run(&["cache"], folder).contains("plates    2, "), "{}", run(&["cache"], folder));
    assert!(run(&["cache", "--clear", "--json"], folder).contains("\"removed\": true"));
    assert_eq!(names(&cache).len(), 0);
}

/// The page marches on the plate of the results, or says why not.
#[test]
fn a_page_asks_what_if() {
    let case = failing();
    case.fem("run", &["--out", "out"]).good();
    fem(case.folder(), &["report", "out", "--what-if"]).good();
    let page = case.read("out/report.html");
    assert!(page.len() < 3_000_000 && page.contains("id=\"what-if-settings\"") && page.contains("\"operator\":\""));
    let two = fem(case.folder(), &["report", "out", "out", "--what-if"]);
    assert!(two.stderr.contains("one run"), "{}", two.stderr);

    case.fem("run", &["--out", "other", "--set", "march.integrator=energy-conserving"]).good();
    fem(case.folder(), &["report", "other", "--what-if"]).good();
    assert!(case.read("other/report.html").contains("the scene names another integrator"));
    // A mesh that has changed since is another plate.
    let case = quick();
    case.fem("run", &["--out", "out"]).good();
    fs::copy(root().join("examples/as4-3502-8ply-50mm/plate.msh"), case.folder().join("plate/plate.msh")).unwrap();
    let refused = fem(case.folder(), &["report", "out", "--what-if"]);
    assert!(refused.status == 1 && refused.stderr.contains("peak force"), "{}", refused.stderr);
}
