//! Spherical tips, whose contact grows with the force and where the plate bends round them.

use super::scenes::{Plate, apart, forces, stretched};
use crate::support::{impact_of, root};
use fem::analyses::impact::{self, Checkpoint, March, Outcome};
use fem::io::files::OutputDir;
use fem::io::scene;
use fem::{Error, Model, Registry};
use std::num::NonZeroUsize;

const ELASTIC: &str = "delamination = 'off'";
const FULL: &str = "reduction = { method = 'none' }\n";

/// The scene of `plate` with another contact.
fn text(plate: &Plate, patch: &str) -> String {
    plate.text().replace("patch_radius = '3 mm'", patch)
}

fn model(text: &str) -> Result<Model, Error> {
    Model::new(scene::parse(text, &root().join("scene.toml"))?, &Registry::standard())
}

fn outcome(text: &str) -> Outcome {
    impact_of(scene::parse(text, &root().join("scene.toml")).unwrap()).unwrap().1.outcome
}

fn thick() -> Plate {
    Plate { effects: ELASTIC, delamination: String::new(), more: FULL, ..Plate::new() }
}

/// A plate that hardly bends under its tip: the contact is that of Hertz on a plane, a² = R α, and as much wider as the face is dented; the
/// force that of such a patch.
#[test]
fn on_a_thick_plate_a_tip_is_that_of_a_plane() {
    let grown = outcome(&text(&thick(), "tip_radius = '12 mm'"));
    let contact = &grown.contacts[0];
    let plane = (contact.force.0 * 12e-3_f64.powf(1.5) / 4e9).cbrt();
    assert!(contact.radius > plane && contact.radius < 1.5 * plane, "{} {plane}", contact.radius);
    let fixed = outcome(&text(&thick(), &format!("patch_radius = '{plane:e} m'")));
    assert!(apart(&forces(&grown), &forces(&fixed)) < 0.03, "{}", apart(&forces(&grown), &forces(&fixed)));
    assert!(grown.energy_error < 1e-3 && fixed.contacts[0].radius == 0.0, "{}", grown.energy_error);
}

/// A thin plate is wrapped round a wide tip: the contact is much wider than on a plane, nothing is lost, and steps of twice the length
/// cost no more than under a patch.
#[test]
fn a_thin_plate_is_wrapped_round_its_tip() {
    let thin =
        |step_us| Plate { delamination: String::new(), more: FULL, step_us, velocity: 10.0, ..stretched(ELASTIC, "") };
    let [long, short] = [1.0, 0.5].map(|step| outcome(&text(&thin(step), "tip_radius = '25 mm'")));
    let [l, s] = [1.0, 0.5].map(|step| forces(&outcome(&text(&thin(step), "patch_radius = '3 mm'"))));
    let contact = &short.contacts[0];
    let plane = (contact.force.0 * 25e-3_f64.powf(1.5) / 4e9).cbrt();
    assert!(contact.radius > 1.5 * plane, "{} {plane}", contact.radius);
    let error = apart(&forces(&long), &forces(&short));
    assert!(error < apart(&l, &s), "{error} {}", apart(&l, &s));
    assert!(short.energy_error < 1e-3, "{}", short.energy_error);
}

/// One that is about to touch, at the very time of a step, where nothing but rounding is left of its approach.
#[test]
fn a_tip_may_touch_at_a_step() {
    let later = |start: &str| forces(&outcome(&text(&thick(), &format!("tip_radius = '8 mm'{start}"))));
    let [at_once, after] = ["", ", start = '40 us'"].map(later);
    let largest = at_once.iter().fold(0.0_f64, |most, force| most.max(*force));
    let [one, other] = [&at_once, &after].map(|of| of.iter().skip_while(|force| **force < 1e-6 * largest));
    let apart = one.zip(other.clone()).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(other.count() > 20 && apart < 1e-6 * largest, "{apart} of {largest}");
}

/// A march that is resumed, and one on two threads, find every bit, with what the bed under the tip remembers of having yielded.
#[test]
fn a_tip_finds_every_bit_again() {
    let plate = Plate { velocity: 4.0, end_us: 200, ..Plate::new() };
    let elastic = text(&plate, "tip_radius = '8 mm'");
    let plastic = elastic.replace("law = 'hertz'", "law = 'yigit-christoforou', critical = '0.01 mm'");
    assert_ne!(plastic, elastic);
    let model = model(&plastic).unwrap();
    let prepared = |threads| impact::prepare(&model, NonZeroUsize::new(threads).unwrap()).unwrap();
    let whole = impact::march(prepared(1), |_| {}).unwrap();
    let found = |outcome: &Outcome| (forces(outcome), outcome.contacts[0].radius);
    assert!(found(&whole).1 > 5e-4 && whole.contacts[0].dent > 1e-5, "{}", whole.contacts[0].dent);
    assert!(found(&impact::march(prepared(2), |_| {}).unwrap()) == found(&whole), "two threads");

    let folder = tempfile::tempdir().unwrap();
    let dir = OutputDir::create(folder.path().join("run")).unwrap();
    let mut march = March::start(prepared(1)).unwrap();
    (0..90).for_each(|_| march.advance());
    march.save(&dir).unwrap();
    let mut march = March::resume(prepared(1), Checkpoint::read(dir.path(), &model).unwrap()).unwrap();
    while !march.done() {
        march.advance();
    }
    assert!(found(&march.finish()) == found(&whole), "resumed");
}

/// Without inertia the plate is what its answers to the rings are, and a slow march with it finds the same; damage is looked for as under a patch.
#[test]
fn a_plate_at_rest_knows_its_tip() {
    let slow = Plate { mass_kg: 400.0, velocity: 0.2, step_us: 20.0, end_us: 8000, symmetry: "half-turn", ..thick() };
    let march = text(&slow, "tip_radius = '12 mm'");
    let march = march
        .replace("damage = 'off'", "damage = 'onset'")
        .replace("[materials.tape]", "failure = { criteria = ['max-stress'] }\n[materials.tape]");
    let [with, without] = ["", ", inertia = 'off'"]
        .map(|more| outcome(&march.replace("delamination = 'off'", &format!("delamination = 'off'{more}"))));
    assert!(apart(&forces(&without), &forces(&with)) < 0.02, "{}", apart(&forces(&without), &forces(&with)));
    assert!((without.contacts[0].radius / with.contacts[0].radius - 1.0).abs() < 0.02);
    assert!(!with.events.is_empty() && with.events.len() == without.events.len());
    let first = |outcome: &Outcome| outcome.events.iter().map(|event| event.time).fold(f64::INFINITY, f64::min);
    assert!((first(&without) / first(&with) - 1.0).abs() < 0.02, "{} {}", first(&without), first(&with));
}

#[test]
fn what_cannot_grow_is_refused() {
    let refused = |text: &str, words: &[&str]| {
        let error = model(text).map(|_| ()).expect_err("it is refused");
        let report = format!("{:?}", miette::Report::new(error));
        let said: String = report.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        words.iter().for_each(|word| assert!(said.contains(word), "{word:?} is not in {said}"));
    };
    let plate = thick();
    refused(&text(&plate, "patch_radius = '2 mm', tip_radius = '8 mm'"), &["cannot be combined", "patch_radius"]);
    refused(&text(&plate, "tip_radius = '0 mm'"), &["tip_radius"]);
    refused(&text(&plate, "tip_radius = '60 mm'"), &["patch of radius 21 mm", "smaller `impactor.tip_radius`"]);
    refused(&text(&plate, "tip_radius = '8 mm', indentation_from = 'mid-plane'"), &["count from the face"]);
    let other = "law = 'yigit-christoforou', radius = '12 mm', strength = '90 MPa'";
    let other = text(&plate, "tip_radius = '8 mm'").replace("law = 'hertz'", other);
    refused(&other, &["`radius` of the contact law is 12 mm, and the tip's 8 mm", "the same twice"]);
    let reduced = Plate { more: "reduction = { method = 'ritz', vectors = 20 }\n", ..thick() };
    refused(&text(&reduced, "tip_radius = '8 mm'"), &["reduced plate", "method = \"none\""]);
    let explicit = text(&plate, "tip_radius = '8 mm'")
        .replace("{ name = 'generalized-alpha', rho = 0.5 }", "'central-difference'");
    refused(&explicit, &["stable step", "implicit integrator"]);
}
