//! Indentations that count from a surface below the face: the squeeze of the plate is in the contact law, and counts once.

use crate::support::impact_of;
use fem::io::scene;
use std::path::Path;

/// A plate of a material without Poisson's effect, 1 mm thick, at rest under a mass on a spring of `k` N/mm and a square of 20 mm.
fn plate(k: f64, more: &str) -> String {
    format!(
        "title = 'plate'\n\
         materials.plain = {{ e = '2 GPa', nu = 0.0, density = '2 g/cm^3' }}\n\
         mesh = {{ rectangle = ['40 mm', '40 mm'], cells = [8, 8] }}\n\
         laminate = {{ plies = '[0/0]', material = 'plain', ply_thickness = '0.5 mm', layers = [1, 1] }}\n\
         support = [{{ group = 'x-min', kind = 'roller' }}, {{ group = 'x-max', kind = 'roller' }}, {{ restrain = 'rigid-motions' }}]\n\
         contact = {{ law = 'linear', k = '{k} N/mm' }}\n\
         impactor = {{ mass = '1 kg', velocity = '10 mm/s', at = {{ x = '20 mm', y = '20 mm' }}, patch_side = '20 mm'{more} }}\n\
         effects = {{ damage = 'off', inertia = 'off' }}\n\
         march = {{ step = '0.05 ms', end = 'separation', latest = '1 s' }}\noutput = {{ plots = false }}\n"
    )
}

/// Peak force, N, squeeze, m/N, and flexibility of the face, m/N.
fn struck(text: &str) -> (f64, Option<f64>, f64) {
    let (_, run) = impact_of(scene::parse(text, Path::new("scene.toml")).unwrap()).unwrap();
    assert!(run.summary.cautions.is_empty(), "{:?}", run.summary.cautions);
    let one = &run.summary.impact[0];
    (one.peak_force_N, one.squeeze_m_N, 1.0 / run.summary.model.static_stiffness_N_m)
}

/// A uniform pressure p on one face makes the stress across the plate −p (1/2 + 3 s/4 − s³/4), s = 2 z/h, which shortens its struck half by
/// 13/32 p h/E and all of it by p h/(2 E). At the border of the patch the squeeze fades within a cell, so that its mean converges to first
/// order.
#[test]
fn the_squeeze_is_that_of_elasticity() {
    let (e, h, area) = (2e9, 0.25e-3, 4e-4);
    for (surface, face, share) in [("mid-plane", "top", 13.0 / 32.0), ("opposite-face", "bottom", 0.5)] {
        let expected = share * h / (e * area);
        let [coarse, fine] = [8, 16].map(|cells| {
            let thin = plate(1e3, &format!(", indentation_from = '{surface}', face = '{face}'"))
                .replace("cells = [8, 8]", &format!("cells = [{cells}, {cells}]"))
                .replace("ply_thickness = '0.5 mm'", "ply_thickness = '0.125 mm'")
                .replace("velocity = '10 mm/s'", "velocity = '0.1 mm/s'");
            struck(&thin).1.unwrap() / expected
        });
        assert!((0.9..1.0).contains(&coarse) && coarse < fine, "{surface}: {coarse}, {fine}");
        assert!((2.0 * fine - coarse - 1.0).abs() < 1e-2, "{surface}: {coarse}, {fine}");
    }
}

/// A mass on springs in series that lose nothing: F = v √(m/(1/k + C)), C the flexibility of the plate at the surface that k counts from.
#[test]
fn what_is_squeezed_counts_once() {
    // As stiff as a tenth of the squeeze, so that the difference shows.
    let k = 4e7;
    let force = |flexibility: f64| 0.01 / (1.0 / k + flexibility).sqrt();
    let (peak, none, face) = struck(&plate(1e-3 * k, ""));
    assert_eq!(none, None);
    assert!((peak / force(face) - 1.0).abs() < 1e-3, "{peak}");
    let (peak, squeeze, same) = struck(&plate(1e-3 * k, ", indentation_from = 'mid-plane'"));
    let squeeze = squeeze.unwrap();
    assert!((same / face - 1.0).abs() < 1e-12);
    assert!((peak / force(face - squeeze) - 1.0).abs() < 1e-3, "{peak}");
    let (word, _, _) = struck(&plate(1e-3 * k, ", indentation_from = 'face'"));
    assert_eq!(word, struck(&plate(1e-3 * k, "")).0);
}

/// In cells far larger than the patch the plate thickens by Poisson's effect of its bending more than it is squeezed; the run says that the law
/// stays as it is.
#[test]
fn cells_that_let_no_squeeze_through_are_named() {
    let coarse = |more: &str| {
        let text =
            plate(1e3, more).replace("nu = 0.0", "nu = 0.3").replace("patch_side = '20 mm'", "patch_side = '1 mm'");
        impact_of(scene::parse(&text, Path::new("scene.toml")).unwrap()).unwrap().1
    };
    let (plain, asked) = (coarse(""), coarse(", indentation_from = 'mid-plane'"));
    assert!(asked.summary.impact[0].squeeze_m_N.unwrap() < 0.0);
    assert_eq!(asked.summary.impact[0].peak_force_N, plain.summary.impact[0].peak_force_N);
    assert!(asked.summary.cautions.iter().any(|caution| caution.contains("`indentation_from` changes nothing")));
    assert!(plain.summary.cautions.is_empty(), "{:?}", plain.summary.cautions);
}

/// A shell has no thickness to be squeezed.
#[test]
fn a_shell_has_none() {
    let shell =
        |more: &str| plate(1e3, more).replace("layers = [1, 1] }", "layers = [2] }\nelement = { kind = 'mitc4' }");
    let (plain, ..) = struck(&shell(""));
    assert_eq!(struck(&shell(", indentation_from = 'mid-plane'")).1, None);
    assert_eq!(struck(&shell(", indentation_from = 'opposite-face'")).0, plain);
}

/// The energy of a blow with waves is balanced, whether the plate is reduced or not, and with growing delaminations the squeeze is the same.
#[test]
fn energy_is_balanced() {
    let moving = plate(1e3, ", indentation_from = 'mid-plane'")
        .replace("inertia = 'off'", "inertia = 'on'")
        .replace("step = '0.05 ms', end = 'separation', latest = '1 s'", "step = '2 us', end = '2 ms'")
        .replace(
            "law = 'linear', k = '1000 N/mm'",
            "law = 'sun-yang', k = '1e5 N/mm^1.5', m = 2.5, critical = '0.01 um', beta = 0.4",
        );
    let mut peaks = Vec::new();
    for reduction in ["", "reduction = { method = 'none' }\n"] {
        let text = format!("{moving}{reduction}");
        let (_, run) = impact_of(scene::parse(&text, Path::new("scene.toml")).unwrap()).unwrap();
        // That of Newmark's steps, which meet the kinks of a contact.
        assert!(run.outcome.energy_error < 1e-5, "{}", run.outcome.energy_error);
        assert!(run.outcome.history.last().unwrap().contact_dissipated_j > 0.0);
        peaks.push((run.outcome.contacts[0].force.0, run.summary.impact[0].squeeze_m_N.unwrap()));
    }
    let [reduced, full] = peaks[..] else { unreachable!() };
    assert!((reduced.1 / full.1 - 1.0).abs() < 1e-9, "{peaks:?}");
    assert!((reduced.0 / full.0 - 1.0).abs() < 2e-3, "{peaks:?}");
}

#[test]
fn what_cannot_be_taken_from_a_law_is_refused() {
    let refused = |text: &str| {
        let error = scene::parse(text, Path::new("scene.toml"))
            .map_err(fem::Error::from)
            .and_then(|scene| impact_of(scene).map(|_| ()));
        error.unwrap_err().to_string()
    };
    let stiff = refused(&plate(1e7, ", indentation_from = 'mid-plane'"));
    assert!(stiff.contains("its squeeze is no part of such a law"), "{stiff}");
    let node =
        refused(&plate(1e3, ", indentation_from = 'mid-plane'").replace("patch_side = '20 mm'", "load = 'node'"));
    assert!(node.contains("a force at one node squeezes a solid without limit"), "{node}");
}

/// Each would have to know how the other squeezes the plate.
#[test]
fn impactors_that_squeeze_for_each_other_are_refused() {
    let two = |x: &str| {
        let text = plate(1e3, ", indentation_from = 'mid-plane'");
        let (before, rest) = text.split_once("impactor = {").unwrap();
        let (one, after) = rest.split_once("}\n").unwrap();
        let one = one.replace("'20 mm'", "'2 mm'").replace("x = '2 mm', y = '2 mm'", "x = '20 mm', y = '20 mm'");
        let other = one.replace("x = '20 mm'", &format!("x = '{x}'"));
        let text = format!("{before}impactor = [{{ name = 'a',{one}}}, {{ name = 'b',{other}}}]\n{after}");
        let scene = scene::parse(&text, Path::new("scene.toml")).unwrap();
        fem::Model::new(scene, &fem::Registry::standard()).map(|_| ()).map_err(|why| why.to_string())
    };
    let refused = two("21 mm").unwrap_err();
    assert!(refused.contains("`a` and `b` strike less than a thickness apart"), "{refused}");
    assert_eq!(two("30 mm"), Ok(()));
}
