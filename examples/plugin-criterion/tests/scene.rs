//! A scene uses the plug-in by its name; what is wrong with its parameters is shown in the scene.

use std::path::Path;
use std::process::Command;

/// Exit status, standard output and standard error of `fem check` on the scene with `from` replaced.
fn check(from: &str, to: &str) -> (Option<i32>, String, String) {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = std::fs::read_to_string(here.join("impact.toml")).unwrap();
    assert_eq!(scene.matches(from).count(), 1, "{from}");
    let mesh = here.join("../as4-3502-16ply-50mm/plate.msh").canonicalize().unwrap();
    let scene = scene.replace("../as4-3502-16ply-50mm/plate.msh", &mesh.to_string_lossy().replace('\\', "/"));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.toml");
    std::fs::write(&file, scene.replace(from, to)).unwrap();
    let run = Command::new(env!("CARGO_BIN_EXE_plugin-criterion")).arg("check").arg(&file).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (run.status.code(), text(run.stdout), text(run.stderr))
}

const SHEAR: &str = "shear = \"160 MPa\"";

#[test]
fn a_scene_uses_it_beside_the_others() {
    let (status, stdout, stderr) = check(SHEAR, SHEAR);
    assert_eq!(status, Some(0), "{stderr}");
    assert!(stdout.contains("yamada-sun, hashin-report"), "{stdout}");
}

#[test]
fn wrong_parameters_are_shown_in_the_scene() {
    for (line, words) in [
        ("", "`shear`: is missing"),
        ("shear = 160e6", "must be a quantity in Pa, above 0, got the bare number 1.6e8"),
        ("shear = \"160 mm\"", "must be a quantity in Pa, above 0, got 0.16 m"),
        ("shear = \"-160 MPa\"", "must be a quantity in Pa, above 0, got -1.6e8 Pa"),
        ("sheer = \"160 MPa\"", "did you mean `shear`"),
    ] {
        let (status, _, stderr) = check(SHEAR, line);
        assert_eq!(status, Some(1), "{line}");
        let words_of_error = stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words_of_error.contains("criterion `yamada-sun`"), "{stderr}");
        assert!(words_of_error.replace("│ ", "").contains(words), "{words}: {stderr}");
        assert!(stderr.contains(if line.is_empty() { "name = \"yamada-sun\"" } else { line }), "{stderr}");
    }
}

#[test]
fn a_misspelt_name_is_shown_with_the_nearest() {
    let (status, _, stderr) = check("\"yamada-sun\"", "\"yamada-son\"");
    assert_eq!(status, Some(1));
    assert!(stderr.contains("did you mean `yamada-sun`"), "{stderr}");
}
