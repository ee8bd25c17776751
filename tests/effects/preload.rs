//! Loads in the plane before an impact.

use super::{EDGES, Struck, deflection, difference, force, said};
use crate::pictures::pictures;
use crate::support::{impact_of, plate, root};
use fem::advise::advise;
use fem::core::tensor::Stress6;
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

const COMPRESSED: &str = "preload = [{ group = 'x-min', force = '-8 N/mm' }, { group = 'x-max', force = '-8 N/mm' }, \
     { group = 'y-min', force = '0 N/mm' }, { group = 'y-max', force = '0 N/mm' }]";
const STRETCHED: &str = "preload = [{ group = 'x-min', force = '20 N/mm' }, { group = 'x-max', force = '20 N/mm' }, \
     { group = 'y-min', force = '0 N/mm' }, { group = 'y-max', force = '0 N/mm' }]";
const NOTHING: &str = "preload = [{ group = 'x-min', force = '0 N/mm' }]";

fn largest(rows: &[HistoryRow], value: fn(&HistoryRow) -> f64) -> f64 {
    rows.iter().map(value).fold(0.0, f64::max)
}

#[test]
fn tension_stiffens_and_compression_softens() {
    let [pressed, bare, pulled] = [COMPRESSED, "", STRETCHED].map(|effects| Struck::new(effects).outcome());
    let [a, b, c] = [&pressed, &bare, &pulled].map(|outcome| largest(&outcome.history, deflection));
    assert!(a > 1.02 * b && b > 1.02 * c, "{a:e} {b:e} {c:e}");
    for outcome in [pressed, pulled] {
        assert!(outcome.energy_error < 1e-4, "the balance closes: {:e}", outcome.energy_error);
    }
}

/// A load near that of buckling takes the stiffness of bending and not that of stretching, which then counts for as much more.
#[test]
fn stretching_counts_for_more_near_buckling() {
    let advised = |effects: &'static str| {
        let advice = advise(&Struck::new(effects).model().unwrap(), NonZeroUsize::MIN).unwrap().remove(0);
        (advice.plate.stiffness, advice.expected.coefficient, advice.plate.buckling)
    };
    let ((bare, a, none), (pressed, more, share)) = (advised(""), advised(COMPRESSED));
    let share = share.unwrap();
    assert!(none.is_none() && share > 0.1 && share < 0.9, "{share}");
    assert!((a / more + share - 1.0).abs() < 1e-12, "{a} {more} {share}");
    // The deflection under the impactor is not quite the shape in which it buckles.
    let held = pressed / bare;
    assert!((more / a * held - 1.0).abs() < 0.2, "{more} {a} {held}");
    assert_eq!(advised(STRETCHED).1, a);
}

#[test]
fn a_preload_of_nothing_changes_no_bit() {
    let histories = ["", NOTHING].map(|effects| Struck::new(effects).history());
    let values = histories.each_ref().map(|rows| rows.iter().flat_map(HistoryRow::values).collect::<Vec<f64>>());
    assert_eq!(values[0], values[1]);
}

#[test]
fn a_reduced_plate_meets_the_full_one() {
    let of = |reduction| Struck { reduction, ..Struck::new(COMPRESSED) }.history();
    let (full, reduced) = (of("method = 'none'"), of("method = 'ritz', vectors = 120"));
    for value in [force, deflection] {
        assert!(difference(&reduced, &full, value) < 1e-3, "{:e}", difference(&reduced, &full, value));
    }
}

/// Deflections of half a thickness: both the preload and what stretches the plate count.
#[test]
fn tension_of_large_deflections_adds_to_the_preload() {
    let of = |effects, reduction| {
        Struck { reduction, impactor: "mass = '20 g', velocity = '6 m/s'", march: MARCH.into(), ..Struck::new(effects) }
            .history()
    };
    const MARCH: &str = "integrator = 'newmark', step = '1 us', end = '200 us'";
    const TENSE: &str = "preload = [{ group = 'x-min', force = '60 N/mm' }, { group = 'x-max', force = '60 N/mm' }, \
         { group = 'y-min', force = '0 N/mm' }, { group = 'y-max', force = '0 N/mm' }]";
    const BOTH: &str = "membrane = 'on', preload = [{ group = 'x-min', force = '60 N/mm' }, { group = 'x-max', force = '60 N/mm' }, \
         { group = 'y-min', force = '0 N/mm' }, { group = 'y-max', force = '0 N/mm' }]";
    let (full, reduced) = (of(BOTH, "method = 'none'"), of(BOTH, "method = 'ritz', vectors = 60"));
    let [linear, stretched] = [TENSE, "membrane = 'on'"].map(|effects| of(effects, "method = 'ritz', vectors = 60"));
    let off = difference(&reduced, &full, deflection);
    assert!(off < 5e-3, "{off:e}");
    let apart = [&linear, &stretched].map(|other| difference(other, &full, deflection));
    assert!(apart.iter().all(|apart| *apart > 1e-2), "{apart:?}");
}

#[test]
fn a_symmetric_plate_is_a_part_of_the_whole() {
    let whole = Struck { reduction: "method = 'none'", ..Struck::new(COMPRESSED) };
    let part = whole.text().replace("element =", "symmetry = 'quarter'\nelement =");
    let (_, part) = impact_of(scene::parse(&part, &root().join("scene.toml")).unwrap()).unwrap();
    let (whole, part) = (whole.history(), part.outcome.history);
    let off = difference(&part, &whole, deflection);
    assert!(off < 1e-6, "{off:e}");
}

/// A laminate of as many plies along x as across: its plies have the strains of their mean stiffness.
#[test]
fn plies_start_with_the_stresses_of_the_preload() {
    let failure = "[failure]\ncriteria = ['max-stress']\nevery = '5 us'\n";
    let struck = Struck { damage: "onset", more: failure, ..Struck::new(STRETCHED) };
    let struck = Struck { impactor: "mass = '1 mg', velocity = '1 um/s'", ..struck };
    let (model, found) = (struck.model().unwrap(), struck.outcome());
    let material = &model.materials[0];
    let s = material.elastic.compliance();
    let (e1, e2, nu) = (1.0 / s[0][0], 1.0 / s[1][1], -s[0][1] / s[0][0]);
    let reduced = 1.0 - nu * nu * e2 / e1;
    let [q11, q22, q12] = [e1, e2, nu * e2].map(|q| q / reduced);
    let mean = 0.5 * (q11 + q22);
    // 20 N/mm along x of 1 mm.
    let strain = 20e6 * mean / (mean * mean - q12 * q12);
    let contraction = -strain * q12 / mean;
    let along = [q11 * strain + q12 * contraction, q12 * strain + q22 * contraction];
    let across = [q11 * contraction + q12 * strain, q12 * contraction + q22 * strain];
    let indices = |[s11, s22]: [f64; 2]| {
        let mut indices = vec![0.0; model.criteria[0].1.info().modes.len()];
        model.criteria[0].1.indices(&Stress6::new([s11, s22, 0.0, 0.0, 0.0, 0.0]), material, &mut indices);
        indices.into_iter().fold(0.0, f64::max)
    };
    let expected = indices(along).max(indices(across));
    let peak = found.peaks.iter().map(|peak| peak.index).fold(0.0, f64::max);
    assert!((peak / expected - 1.0).abs() < 1e-3, "{peak} {expected}");
}

#[test]
fn what_buckles_the_plate_is_refused_with_its_factor() {
    const BEYOND: &str = "preload = [{ group = 'x-min', force = '-80 N/mm' }, { group = 'x-max', force = '-80 N/mm' }, \
         { group = 'y-min', force = '0 N/mm' }, { group = 'y-max', force = '0 N/mm' }]";
    Struck::new(BEYOND).refused(&["buckles the plate", "at 0.", "lower the preload"]);
}

#[test]
fn what_it_cannot_be_is_refused_by_name() {
    let refused = |effects: &'static str, words: &[&str]| Struck::new(effects).refused(words);
    refused("preload = [{ group = 'left', force = '1 N/mm' }]", &["the mesh has no group `left`"]);
    refused("preload = [{ group = 'plate', force = '1 N/mm' }]", &["no edges", "physical curve"]);
    refused("preload = [{ group = 'x-min' }]", &["does not say how much", "`displacement`"]);
    refused("preload = [{ group = 'x-min', force = '1 N' }]", &["effects.preload", "N/mm"]);
    refused(
        "preload = [{ group = 'x-min', force = '1 N/mm', displacement = '1 mm' }]",
        &["both force and displacement", "keep one"],
    );
    refused(
        "preload = [{ group = 'x-min', force = '1 N/mm' }, { group = 'x-min', shear = '1 N/mm' }]",
        &["another entry", "once"],
    );
    refused(
        "preload = [{ group = 'x-min', force = '1 N/mm' }, { group = 'x-max', force = '2 N/mm' }, { group = 'y-min', force = '0 N/mm' }, \
         { group = 'y-max', force = '0 N/mm' }]",
        &["pushes the plate", "translation along x", "opposite edge"],
    );
    refused(
        "preload = [{ group = 'x-min', displacement = '0.01 mm' }, { group = 'x-max', displacement = '-0.01 mm' }, \
         { group = 'y-min', force = '0 N/mm' }, { group = 'y-max', force = '0 N/mm' }]",
        &["displacements move the plate", "opposite edge"],
    );
    let held = EDGES.concat();
    let text = Struck::new(NOTHING).text().replace(&held, "[[support]]\nrestrain = 'rigid-motions'\n");
    let scene = scene::parse(&text, &root().join("scene.toml")).unwrap();
    let free = said(Model::new(scene, &Registry::standard()).expect_err("it is free"));
    assert!(free.contains("supports leave the plate free"), "{free}");
}

#[test]
fn buckling_is_written_and_a_scene_without_a_preload_refused() {
    let text = Struck::new(COMPRESSED).text();
    let dropped = ["impactor", "contact", "reduction", "march"];
    let kept = text.lines().filter(|line| !dropped.iter().any(|key| line.trim_start().starts_with(key)));
    let buckling = format!(
        "analysis = 'buckling'\nbuckling = {{ count = 3 }}\n{}\n[output]\nfields = true\n",
        kept.collect::<Vec<_>>().join("\n")
    );
    let case = plate().text(&buckling);
    let printed = case.fem("run", &["--out", "out"]).good().stdout;
    let factors = case.summary("out")["load_factors"].as_array().unwrap().clone();
    assert!(factors.len() == 3 && printed.contains("load factor"), "{printed}");
    assert!(printed.contains("preload   x-min -8 N/mm, x-max -8 N/mm, y-min 0 N/mm, y-max 0 N/mm\n"), "{printed}");
    assert_eq!(case.summary("out")["preload"][0]["force_N_per_m"].as_f64(), Some(-8e3));
    assert!(factors.windows(2).all(|pair| pair[0].as_f64().unwrap().abs() <= pair[1].as_f64().unwrap().abs()));
    let (header, rows) = case.table("out/buckling.csv");
    assert_eq!((header, rows.len()), (vec!["shape".to_owned(), "load_factor".to_owned()], 3));
    pictures(&case, "out", &[]);
    let names = case.names("out/fields");
    assert!(names.iter().any(|name| name == "plate-0003.vtu"), "{names:?}");
    let frame = std::fs::read(case.folder().join("out/fields/plate-0001.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&frame).contains("load_factor"));
    // The plate is refused at that factor, and at none below.
    let at = |share: f64| {
        let force = format!("'{} N/mm'", -8.0 * share * factors[0].as_f64().unwrap());
        let effects = COMPRESSED.replace("'-8 N/mm'", &force);
        let scene = scene::parse(&text.replace(COMPRESSED, &effects), &root().join("scene.toml")).unwrap();
        impact_of(scene).map(|(_, found)| found.sizes.buckling)
    };
    let near = at(0.99).unwrap().unwrap();
    assert!((near / 0.99 - 1.0).abs() < 1e-6, "{near}");
    let beyond = said(at(1.25).expect_err("it buckles"));
    assert!(beyond.contains("at 0.8000 of it"), "{beyond}");
    let said = |text: &str| plate().text(text).fem("modes", &["--out", "modes"]).good().stdout;
    let quarter = said(&text.replace("element =", "symmetry = 'quarter'\nelement ="));
    assert!(quarter.contains("of the load that buckles the plate into a symmetric shape\n"), "{quarter}");
    assert!(said(&text).contains("of the load that buckles the plate\n"));
    let none = plate().text(&buckling.replace(COMPRESSED, "preload = 'off'"));
    let refused = none.fem("check", &[]);
    assert!(refused.stderr.contains("`effects.preload` is missing"), "{}", refused.stderr);
}
