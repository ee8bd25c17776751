//! Residual stresses against classical lamination theory and Timoshenko's bimetal.

use super::scene::{AS4, Plate, Side, isotropic};
use crate::support::strip;
use fem::core::profile::ProfilePoint;
use fem::core::residual::Residual;
use fem::io::scene;
use fem::{Error, Model, Registry};

const CHANGE: f64 = -150.0;
const EXPANSION: &str = "alpha1 = '-1e-6 1/K'\nalpha2 = '26e-6 1/K'\nalpha3 = '30e-6 1/K'\n";
const MITC4: &str = "kind = 'mitc4'";
const PRISM: &str = "z_derivatives = 'layer-wise'";

fn cooled(more: &str) -> String {
    format!("[effects]\ncure = '{CHANGE} K'\n{more}")
}

/// A free square of AS4 plies, 20 mm wide, 0.5 mm thick at most, without a load.
fn free(plies: &str, layers: Vec<usize>, element: &str, more: &str) -> Plate {
    Plate::new(&format!("{AS4}{EXPANSION}"), plies, 0.125, layers)
        .element(element)
        .rectangle([20.0; 2], [8; 2])
        .sides([Side::Free; 4])
        .probe([10.0; 2])
        .with(&cooled(more))
}

/// The state of a laminate far from its edges.
fn lamination(model: &Model) -> Residual {
    Residual::new(&model.laminate, &model.materials, CHANGE).unwrap()
}

/// Largest difference of ply stresses from lamination theory, relative to the largest of them.
fn difference(model: &Model, points: &[ProfilePoint]) -> f64 {
    let theory = lamination(model);
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for p in points {
        let ply = &model.laminate.plies[p.ply];
        let want = theory.stress(&model.materials[ply.material], ply.angle, p.z).unwrap();
        for (got, want) in p.in_ply.0.iter().zip(want.0) {
            worst = worst.max((got - want).abs());
            largest = largest.max(want.abs());
        }
    }
    worst / largest
}

#[test]
fn ply_stresses_of_free_laminates() {
    for plies in ["[0/90]s", "[0/45/-45/90]s", "[30/-30]s"] {
        let count = if plies.contains("45") { 8 } else { 4 };
        let plate = free(plies, vec![count], MITC4, "");
        let error = difference(&plate.model("static"), &plate.solve().profiles[0]);
        assert!(error < 1e-9, "{plies}: {error:e}");
        // In the plane alone von Karman's strains are linear.
        let plate = free(plies, vec![count], MITC4, "membrane = 'on'");
        let error = difference(&plate.model("static"), &plate.solve().profiles[0]);
        assert!(error < 1e-9, "{plies}, large: {error:e}");
    }
}

/// Solids know of the border, which spoils some cells.
#[test]
fn ply_stresses_of_a_free_laminate_of_solids() {
    for (plies, tolerance) in [("[0/90]s", 2e-3), ("[30/-30]s", 1e-2)] {
        let plate = free(plies, vec![1; 4], PRISM, "").rectangle([20.0; 2], [14; 2]);
        let error = difference(&plate.model("static"), &plate.solve().profiles[0]);
        assert!(error < tolerance, "{plies}: {error:e}");
    }
}

/// No force and no moment is left, and the energy is that of the stresses.
#[test]
fn residual_stresses_have_no_resultant_but_an_energy() {
    let plate = free("[0/90]s", vec![4], MITC4, "");
    let (model, solution) = (plate.model("static"), plate.solve());
    let resultants = &solution.resultants[0];
    let scale = 30e6 * 0.5e-3;
    assert!(resultants.membrane.iter().all(|n| n.abs() < 1e-9 * scale), "{resultants:?}");
    // Plane stress, constant in each ply: ½ σ S σ over the volume.
    let compliance = model.materials[0].elastic.compliance();
    let density = |p: &ProfilePoint| {
        let [s1, s2, ..] = p.in_ply.0;
        0.5 * (compliance[0][0] * s1 * s1 + 2.0 * compliance[0][1] * s1 * s2 + compliance[1][1] * s2 * s2)
    };
    let want: f64 = solution.profiles[0].chunks_exact(2).map(|ply| density(&ply[0]) * 0.125e-3 * 4e-4).sum();
    assert!((solution.strain_energy / want - 1.0).abs() < 1e-9, "{} {want}", solution.strain_energy);
    let large = free("[0/90]s", vec![4], MITC4, "membrane = 'on'").solve();
    assert!((large.strain_energy / want - 1.0).abs() < 1e-9, "{} {want}", large.strain_energy);
}

/// w = −½ κ₁₁ x² − ½ κ₂₂ y² about the middle.
#[test]
fn an_unsymmetric_laminate_warps() {
    for (element, layers, tolerance) in [(MITC4, vec![2], 1e-9), (PRISM, vec![1, 1], 1e-2)] {
        let plate = free("[0/90]", layers, element, "").probe([5.0, 10.0]).probe([15.0, 10.0]);
        let plate = plate.probe([10.0, 5.0]).probe([10.0, 15.0]);
        let kappa = lamination(&plate.model("static")).curvature;
        let solution = plate.solve();
        let w: Vec<f64> = solution.profiles.iter().map(|p| p[0].displacement[2]).collect();
        for (kappa, ends) in [(kappa[0], w[1] + w[2]), (kappa[1], w[3] + w[4])] {
            let got = (2.0 * w[0] - ends) / 5e-3_f64.powi(2);
            assert!((got / kappa - 1.0).abs() < tolerance, "{element}: {got} {kappa}");
        }
        assert!(kappa[0] * kappa[1] < 0.0 && kappa[0].abs() > 1.0, "{kappa:?}");
    }
}

/// A narrow strip of two materials (Timoshenko, J. Opt. Soc. Am. 11 (1925) 233-255), κ = 24 Δα ΔT / (h (14 + n + 1/n)), as
/// plies along and across of one material: small displacements, and such that it rolls up to an arc.
#[test]
fn a_bimetal_strip_bends_to_an_arc() {
    let (along, across, h, length) = ([100e3, 20e-6], [50e3, 0.0], 1.0, 100.0);
    let n: f64 = along[0] / across[0];
    let bend = |change: f64, membrane: &str| {
        let material = format!(
            "e1 = '{} MPa'\ne2 = '{} MPa'\ne3 = '{} MPa'\nnu12 = 0.0\nnu13 = 0.0\nnu23 = 0.0\ng12 = '20 GPa'\ng13 = '20 GPa'\n\
             g23 = '20 GPa'\ndensity = '1 g/cm^3'\nalpha1 = '{} 1/K'\nalpha2 = '{} 1/K'\n",
            along[0], across[0], across[0], along[1], across[1]
        );
        let strip = Plate::new(&material, "[0/90]", 0.5 * h, vec![1, 1])
            .element(&format!("kind = 'webster-beam', {PRISM}"))
            .rectangle([length, 2.0], [40, 1])
            .sides([Side::Symmetric, Side::Free, Side::Free, Side::Free])
            .probe([0.0, 0.0])
            .probe([0.5 * length, 0.0])
            .with(&format!("[effects]\ncure = '{change} K'\nmembrane = '{membrane}'"));
        let solution = strip.solve();
        let moved = |k: usize| solution.profiles[k][1].displacement.map(|u| u * 1e3);
        let ([_, _, w0], [u, _, w]) = (moved(0), moved(1));
        (24.0 * along[1] * change / (h * (14.0 + n + 1.0 / n)), w - w0, u)
    };
    let (kappa, w, _) = bend(10.0, "off");
    // The lower ply grows more: the ends go up.
    let want = 0.5 * kappa * (0.5 * length).powi(2);
    assert!((w / want - 1.0).abs() < 1e-3, "{w} {want}");
    let (kappa, w, u) = bend(400.0, "on");
    let angle: f64 = kappa * 0.5 * length;
    let [up, along] = [(1.0 - angle.cos()) / kappa, angle.sin() / kappa - 0.5 * length];
    assert!(angle > 0.5 && (w / up - 1.0).abs() < 1e-2, "{angle}: {w} {up}");
    // It grows a little as well, by some 0.5 %.
    assert!((u - along).abs() < 6e-3 * 0.5 * length, "{u} {along}");
}

/// A bar that is held at both ends: σ = −E α ΔT, nothing moves.
#[test]
fn a_held_plate_is_stressed_without_moving() {
    let material = format!("{}alpha = '10e-6 1/K'\n", isotropic(70.0, 0.0, 2.7));
    for element in ["kind = 'hex20'", PRISM, MITC4, "kind = 'webster-beam'"] {
        let layers = if element == MITC4 { vec![2] } else { vec![1, 1] };
        for membrane in ["off", "on"] {
            let solution = Plate::new(&material, "[0_2]", 0.5, layers.clone())
                .element(element)
                .rectangle([10.0, 5.0], [4, 1])
                .sides([Side::Symmetric, Side::Symmetric, Side::Free, Side::Free])
                .probe([6.0, 2.0])
                .with(&cooled(&format!("membrane = '{membrane}'")))
                .solve();
            let s = solution.profiles[0][0].global.s11();
            assert!((s / (70e9 * 10e-6 * 150.0) - 1.0).abs() < 1e-9, "{element} {membrane}: {s}");
            assert!(solution.mesh_error.is_none());
        }
    }
}

/// Before an impact moves anything, the plies have the stresses of their cure.
#[test]
fn an_impact_starts_from_residual_stresses() {
    let watch =
        r#"watch = [{ at = { x = "15 mm", y = "5 mm" }, ply = 16 }, { at = { x = "15 mm", y = "5 mm" }, ply = 15 }]"#;
    let case = strip()
        .scene("library = \"AS4/3502\"", "library = \"AS4/3502\", alpha1 = \"-1e-6 1/K\", alpha2 = \"26e-6 1/K\"")
        .scene("criteria = [\"hashin-report\", \"octahedral\"]", &format!("criteria = [\"hashin-report\"]\n{watch}"))
        .append("\n[effects]\ncure = \"-150 K\"\n");
    case.fem("run", &["--out", "out"]).good();
    let (_, rows) = case.table("out/index_history.csv");
    let model = Model::new(scene::read(&case.folder().join(case.write())).unwrap(), &Registry::standard()).unwrap();
    let (theory, (_, criterion)) = (lamination(&model), &model.criteria[0]);
    let mut compared = 0;
    for ply in [14, 15] {
        let p = &model.laminate.plies[ply];
        let stress = theory.stress(&model.materials[p.material], p.angle, 0.0).unwrap();
        let mut want = vec![0.0; criterion.info().modes.len()];
        criterion.indices(&stress, &model.materials[p.material], &mut want);
        for (mode, want) in criterion.info().modes.iter().zip(want) {
            let here = |row: &&Vec<String>| row[2] == *mode && row[4] == (ply + 1).to_string();
            let first: f64 = rows.iter().find(here).unwrap()[8].parse().unwrap();
            assert!((first - want).abs() < 1e-9 * want.max(1e-3), "ply {ply} {mode}: {first} {want}");
            compared += usize::from(want > 0.1);
        }
    }
    assert!(compared >= 2, "{compared}");
}

#[test]
fn what_cannot_be_cooled_is_refused() {
    let refused = |text: String| {
        let scene = scene::parse(&text, "scene.toml".as_ref()).unwrap();
        let Err(Error::Scene(refused)) = Model::new(scene, &Registry::standard()) else { panic!() };
        (refused.to_string(), refused.remedy().to_owned())
    };
    let plate = free("[0/90]s", vec![4], MITC4, "");
    let (message, remedy) = refused(plate.text("static").replace(EXPANSION, ""));
    assert!(
        message.contains("`m`") && message.contains("expansion") && remedy.contains("alpha2"),
        "{message}; {remedy}"
    );
    let (message, remedy) = refused(Plate { more: cooled(""), ..plate }.text("modes"));
    assert!(message.contains("modes") && remedy.contains("cure"), "{message}; {remedy}");
    for (keys, word) in
        [("alpha1 = '1e-6 1/K'\n", "along its other axes"), ("alpha = '1e-6 1/K'\nalpha2 = '1e-6 1/K'\n", "alpha1")]
    {
        let text = free("[0/90]s", vec![4], MITC4, "").text("static").replace(EXPANSION, keys);
        let error = scene::parse(&text, "scene.toml".as_ref()).unwrap_err();
        assert!(format!("{error}; {}", error.remedy()).contains(word), "{error}");
    }
}
