//! `fem laminate`.

use crate::support::{fem, plate, root};
use fem::analyses::statics;
use fem::io::scene;
use fem::{Model, Registry};
use serde_json::Value;
use std::num::NonZeroUsize;

fn found(arguments: &[&str]) -> Value {
    let done = fem(&root(), &[&["laminate"], arguments, &["--json"]].concat()).good();
    serde_json::from_str(&done.stdout).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

const TAPE: [&str; 4] = ["--material", "AS4/3502", "--ply-thickness", "0.125 mm"];

#[test]
fn a_quasi_isotropic_laminate() {
    let found = found(&[&["[45/0/-45/90]s"], &TAPE[..]].concat());
    let plane = &found["in_plane"];
    let [ex, ey, gxy, nuxy] = ["Ex_Pa", "Ey_Pa", "Gxy_Pa", "nuxy"].map(|key| number(&plane[key]));
    // Isotropic in its plane: G = E/2(1 + nu).
    assert!((ex / ey - 1.0).abs() < 1e-12 && (gxy / (ex / (2.0 * (1.0 + nuxy))) - 1.0).abs() < 1e-12);
    assert_eq!((&found["uncoupled"], &found["balanced"]), (&Value::Bool(true), &Value::Bool(true)));
    assert!((number(&found["thickness_m"]) - 1e-3).abs() < 1e-15 && number(&found["bend_twist"]) > 0.05);
    assert!(number(&found["flexural"]["Ex_Pa"]) != ex);
}

/// Along the fibres of a single ply all there is is its strength; across them, too.
#[test]
fn the_first_failure_of_one_ply_is_its_strength() {
    let strengths = &fem::io::materials::library("AS4/3502").unwrap().material.strengths;
    for (force, strength) in [("1,0,0", strengths.xt()), ("-1,0,0", strengths.xc()), ("0,1,0", strengths.yt())] {
        let found = found(&[&["[0]"], &TAPE[..], &["--force", force, "--criteria", "max-stress,tsai-wu"]].concat());
        for first in found["first_failure"].as_array().unwrap() {
            // 1 N/mm on 0.125 mm is 8 MPa.
            assert!((number(&first["reserve"]) * 8e6 / strength - 1.0).abs() < 1e-9, "{force}: {first}");
        }
    }
    let found = found(&[&["[0]"], &TAPE[..], &["--moment", "1,0,0", "--criteria", "max-stress"]].concat());
    // 6 M/h² = 384 MPa at the faces.
    let first = &found["first_failure"][0];
    let (least, face) =
        if strengths.xt() < strengths.xc() { (strengths.xt(), "upper") } else { (strengths.xc(), "lower") };
    assert!((number(&first["reserve"]) * 384e6 / least - 1.0).abs() < 1e-9 && first["face"] == face, "{first}");
}

#[test]
fn scenes_have_laminates() {
    let scene = "examples/as4-3502-16ply-50mm/scene.toml";
    let of_scene = found(&[scene]);
    let plies = found(&["[0/45/-45/90]2s", "--material", "AS4/3502", "--ply-thickness", "0.13208 mm"]);
    assert_eq!(of_scene["A_N_m"], plies["A_N_m"]);
    let text = fem(&root(), &["laminate", scene]).good().stdout;
    assert!(text.starts_with("16 plies, 2.1133 mm, 3.3284 kg/m^2\n") && text.contains("A, N/mm"), "{text}");
    // What a scene has and the command does not count is said.
    let case = plate().append("[effects]\ncure = \"-100 K\"\n");
    let said = |loads: &[&str]| case.fem("laminate", loads).good().stderr;
    assert!(said(&["--force", "100,0,0"]).contains("residual stresses of `effects.cure`") && said(&[]).is_empty());
}

#[test]
fn what_is_wrong_is_said() {
    for (arguments, words) in [
        (vec!["[0/90]s"], "need a material and a thickness"),
        (vec!["[0/90", "--material", "AS4/3502", "--ply-thickness", "1 mm"], "plies run from the bottom up"),
        (vec!["[0]", "--material", "AS4", "--ply-thickness", "1 mm"], "the library has no material `AS4`"),
        (vec!["[0]", "--material", "AS4/3502", "--ply-thickness", "1 mm", "--force", "1,2"], "takes three numbers"),
        (vec!["examples/pagano-0-90-0/scene.toml", "--material", "AS4/3502"], "materials and thicknesses of its own"),
    ] {
        let done = fem(&root(), &[&["laminate"], &arguments[..]].concat());
        assert!(done.status == 1 && done.stderr.contains(words), "{arguments:?}: {done:#?}");
    }
    for thickness in ["1e200 mm", "0 mm"] {
        let done = fem(&root(), &["laminate", "[0]", "--material", "AS4/3502", "--ply-thickness", thickness]);
        assert!(done.status == 2 && done.stderr.contains("must be from 1 nm to 1 m"), "{thickness}: {done:#?}");
    }
}

/// A strip of plies of 0.125 mm of IM7/8552 that its weight pulls along x.
fn pulled(plies: &str, strengths: &str, law: &str) -> String {
    format!(
        "title = 'pulled'\nanalysis = 'static'\nmesh = {{ rectangle = ['40 mm', '10 mm'], cells = [8, 2] }}\n\
         laminate = {{ plies = '{plies}', material = 'tape', ply_thickness = '0.125 mm', layers = 1{strengths} }}\n\
         support = [{{ group = 'x-min', kind = 'clamped' }}]\n\
         load = [{{ gravity = ['1e6 m/s^2', '0 m/s^2', '0 m/s^2'] }}]\nfailure = {{ criteria = ['max-stress'] }}\n\
         materials.tape = {{ library = 'IM7/8552', Xt = '9 GPa'{law} }}\n"
    )
}

const IN_SITU: &str = ", strengths = 'in-situ'";

/// As Camanho, Maimí and Dávila publish them, and as the plates of scenes have them.
#[test]
fn plies_have_their_strengths_in_situ() {
    let lists = |law: &str, lines: [&str; 2]| {
        let case = plate().text(&pulled("[0/45/0]", IN_SITU, law));
        let said = case.fem("laminate", &["--force", "1,0,0", "--criteria", "max-stress"]).good().stdout;
        for line in lines {
            assert!(said.contains(line), "{line} is not in {said}");
        }
    };
    lists("", ["in situ   ply 1: Yt 101.4 MPa, S12 107.0 MPa", "in situ   ply 2: Yt 160.2 MPa, S12 130.2 MPa"]);
    // The root of 8 G12 GIIc/(pi t), and half of it at a face, where the curve of the shear is all but straight.
    let straight = ", law = { name = 'hahn-tsai', alpha = '1e-14 1/MPa^3' }";
    lists(straight, ["ply 1: Yt 101.4 MPa, S12 206.0 MPa", "ply 2: Yt 160.2 MPa, S12 291.4 MPa"]);

    // The same stresses, and so a reserve in the ratio of the strengths.
    let reserve = |plies: &str, strengths: &str| {
        let scene = scene::parse(&pulled(plies, strengths, ""), &root().join("scene.toml")).unwrap();
        let solution = statics::solve(&Model::new(scene, &Registry::standard()).unwrap(), NonZeroUsize::MIN).unwrap();
        let tension = solution.margins.iter().find(|margin| margin.mode == "transverse tension").unwrap();
        tension.reserve_factor
    };
    for (plies, strength) in [("[90/0/90]", 101.37), ("[0/90/0]", 160.17), ("[0/90_2/0]", 113.26), ("[90_3]", 62.3)] {
        let ratio = reserve(plies, IN_SITU) / reserve(plies, "");
        assert!((ratio * 62.3 / strength - 1.0).abs() < 1e-4, "{plies}: {ratio}");
    }
}

#[test]
fn strengths_in_situ_ask_for_what_they_need() {
    let refused = |constants: &str, words: &[&str]| {
        let text = pulled("[0/90/0]", IN_SITU, constants).replace("IM7/8552", "AS4/3502");
        let said = plate().text(&text).fem("check", &[]);
        assert_eq!(said.status, 1);
        for words in words {
            assert!(said.stderr.contains(words), "{words} is not in {}", said.stderr);
        }
    };
    refused("", &["strength S12 in situ needs `shear_alpha` of material `tape`", "2.98e-8 1/MPa^3"]);
    refused(
        ", shear_alpha = '0 1/MPa^3'",
        &["strength Yt in situ needs the toughness Gmt or GIc", "leave `strengths` out"],
    );
    refused(", shear_alpha = '-1e-8 1/MPa^3'", &["`materials.tape.shear_alpha`: is below 0"]);
    refused(", shear_alpha = '1e-8 1/MPa'", &["shear_alpha"]);
    // Also where nothing asks for it.
    let stray = pulled("[0/90/0]", "", ", shear_alpha = '-1e-8 1/MPa^3'");
    let said = plate().text(&stray).fem("check", &[]);
    assert!(said.status == 1 && said.stderr.contains("is below 0"), "{}", said.stderr);
}
