//! `fem new` and `fem check --explain`.

use crate::support::{fem, root, strip};
use fem::io::scene;
use std::fs;

const TEMPLATES: [&str; 8] =
    ["drop-weight", "astm-d7136", "aitm-1-0010", "astm-d6264", "ball", "ring", "pagano", "modes"];

#[test]
fn every_template_is_a_scene_that_says_the_same_with_its_comments() {
    let folder = tempfile::tempdir().unwrap();
    let listed = fem(folder.path(), &["new", "--list"]).good().stdout;
    let names: Vec<_> = listed.lines().map(|line| line.split(' ').next().unwrap()).collect();
    assert_eq!(names, TEMPLATES);
    for name in TEMPLATES {
        let done = fem(folder.path(), &["new", name, "--template", name]).good();
        assert!(done.stdout.contains(&format!("fem run {name}/scene.toml")) && done.stderr.is_empty(), "{done:#?}");
        let checked = fem(folder.path(), &["check", &format!("{name}/scene.toml")]).good().stdout;
        assert!(checked.contains("the scene is valid") && !checked.contains("warning"), "{checked}");

        let written = scene::read(&folder.path().join(name).join("scene.toml")).unwrap();
        let template = scene::read(&root().join(format!("src/cli/templates/{name}.toml"))).unwrap();
        assert_eq!(written.keys, template.keys, "{name}");
        let schema = fs::read_to_string(folder.path().join(name).join("scene.schema.json")).unwrap();
        assert_eq!(schema, fem(&root(), &["schema"]).good().stdout);
    }
    let mut names: Vec<_> = folder.path().read_dir().unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(
        names,
        ["aitm-1-0010", "astm-d6264", "astm-d7136", "ball", "drop-weight", "modes", "pagano", "ring"],
        "nothing else is left behind"
    );
}

#[test]
fn a_new_scene_runs_at_once() {
    let folder = tempfile::tempdir().unwrap();
    for (name, words) in [("pagano", "results/pagano"), ("modes", "results/modes"), ("ball", "results/ball")] {
        fem(folder.path(), &["new", name, "--template", name]).good();
        let done = fem(folder.path(), &["run", &format!("{name}/scene.toml")]).good();
        assert!(done.stdout.trim_end().ends_with(words), "{done:#?}");
    }
}

#[test]
fn a_template_takes_a_material_of_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let new = |arguments: &[&str]| fem(folder.path(), &[&["new", "plate"], arguments].concat());
    for (arguments, words) in [
        (["--template", "astm-d7136", "--material", "IM7/8553"], "did you mean `IM7/8552`?"),
        (["--template", "pagano", "--material", "IM7/8552"], "have a material of their own"),
        (["--template", "ball", "--material", "steel"], "the template `ball` does not run with `steel`"),
    ] {
        let done = new(&arguments);
        assert!(done.status == 1 && done.stderr.contains(words), "{done:#?}");
        assert!(!folder.path().join("plate").exists());
    }
    new(&["--template", "astm-d7136", "--material", "T700/M21"]).good();
    let scene = scene::read(&folder.path().join("plate/scene.toml")).unwrap();
    let template = scene::read(&root().join("src/cli/templates/astm-d7136.toml")).unwrap();
    let changed = scene.keys.iter().filter(|(key, value)| template.keys.get(*key) != Some(value));
    assert_eq!(changed.map(|(key, _)| key.as_str()).collect::<Vec<_>>(), ["materials.tape.library"]);
}

#[test]
fn a_new_scene_explains_every_key() {
    let folder = tempfile::tempdir().unwrap();
    fem(folder.path(), &["new", "plate"]).good();
    let scene = fs::read_to_string(folder.path().join("plate/scene.toml")).unwrap();
    assert!(scene.starts_with("#:schema ./scene.schema.json\n"), "{scene}");
    for line in ["#march", "#symmetry", "[effects]", "#gravity = \"off\"", "#integrator = \"newmark\"", "#watch = "] {
        assert!(
            scene.lines().any(|l| l.starts_with(line)) != (line == "#march" || line == "#symmetry"),
            "{line}: {scene}"
        );
    }
    let lines: Vec<_> = scene.lines().collect();
    for (above, line) in lines.iter().zip(&lines[1..]) {
        let key = line.trim_start_matches('#').split_once(" = ").is_some_and(|(key, _)| !key.contains(' '));
        assert!(!key || above.starts_with("# "), "{line} is not explained");
    }
}

#[test]
fn what_exists_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("taken"), "mine").unwrap();
    fs::create_dir(folder.path().join("empty")).unwrap();
    for name in ["taken", "empty", "."] {
        let done = fem(folder.path(), &["new", name]);
        assert!(done.status == 1 && done.stdout.is_empty() && done.stderr.contains("is not overwritten"), "{done:#?}");
    }
    assert_eq!(fs::read(folder.path().join("taken")).unwrap(), b"mine");
    let done = fem(folder.path(), &["new", "plate", "--template", "drop-wait"]);
    assert!(done.status == 1 && done.stderr.contains("did you mean `drop-weight`?"), "{done:#?}");
    assert!(!folder.path().join("plate").exists());
}

#[test]
fn a_scene_is_explained_key_by_key() {
    let case = strip().scene("[march]", "[march]\nstep = \"0.2 us\"");
    let shown = case.fem("check", &["--explain"]).good().stdout;
    let (_, keys) = shown.split_once("the scene is valid\n").unwrap();
    insta::assert_snapshot!(keys);
}

/// The way of a force that counts, the constants that a file gives, and nothing that means nothing here.
#[test]
fn only_what_holds_is_explained() {
    let keys = |case: &crate::support::Case| {
        let done = case.fem("check", &["--explain", "--json"]).good().stdout;
        let document: serde_json::Value = serde_json::from_str(&done).unwrap();
        let keys = document["keys"].as_array().unwrap().iter();
        keys.map(|key| (key["key"].as_str().unwrap().to_owned(), key["from"].as_str().unwrap().to_owned())).collect()
    };
    let at_a_node: Vec<(String, String)> = keys(&strip().scene("mass = ", "load = \"node\"\nmass = "));
    assert!(at_a_node.iter().any(|(key, from)| key == "impactor.load" && from.starts_with("line ")), "{at_a_node:?}");
    assert!(at_a_node.iter().all(|(key, _)| key != "impactor.patch_radius"), "{at_a_node:?}");
    let constant = |(key, from): &(String, String)| key == "materials.as4-3502.e1" && from == "materials library";
    assert!(at_a_node.iter().any(constant), "{at_a_node:?}");
    assert!(at_a_node.iter().all(|(key, _)| !key.starts_with("modes") && !key.starts_with("load")), "{at_a_node:?}");
}
