//! Delaminations that a scene leaves to the advisor.

use super::scenes::{Plate, forces};
use crate::support::{impact_of, root};
use fem::advise;
use fem::analyses::impact::Outcome;
use fem::analyses::modes;
use fem::effect::Decision;
use fem::io::scene;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

/// The plate of the other tests, whose plies nobody judges, under a blow of this velocity, m/s, with `what` done about delamination.
fn struck(what: &str, velocity: f64) -> (Model, Outcome) {
    let plate = Plate { effects: "delamination = WHAT", velocity, end_us: 250, ..Plate::new() };
    let mut text = plate.text().replace("WHAT", &format!("'{what}'"));
    if what == "threshold" {
        // The table means nothing where nothing grows.
        text = text.replace(&plate.delamination, "");
    }
    let (model, found) = impact_of(scene::parse(&text, &root().join("scene.toml")).unwrap()).unwrap();
    (model, found.outcome)
}

fn decision(model: &Model) -> Decision {
    let of = model.decisions.iter().find(|decision| decision.effect == "delamination");
    *of.expect("it is the advisor's")
}

#[test]
fn interfaces_that_hold_stay_closed_and_cost_nothing() {
    let ((model, left), (_, closed)) = (struck("auto", 0.5), struck("threshold", 0.5));
    let decision = decision(&model);
    assert!(!decision.on && decision.expected > 0.2 && decision.expected < 0.5, "{decision:?}");
    assert!(left.delaminated.is_none() && model.separation.is_none());
    assert_eq!(forces(&left), forces(&closed));
    assert_eq!(left.peaks, closed.peaks);
    assert_eq!(left.counters.factorisations, closed.counters.factorisations);
}

#[test]
fn interfaces_that_give_way_are_followed() {
    let ((model, left), (_, open)) = (struck("auto", 3.0), struck("growth", 3.0));
    let decision = decision(&model);
    assert!(decision.on && decision.expected > 1.0, "{decision:?}");
    assert_eq!(forces(&left), forces(&open));
    let [left, open] = [&left, &open].map(|outcome| outcome.delaminated.as_ref().unwrap());
    assert!(open.dissipated.total() > 0.0 && left.dissipated == open.dissipated, "{:?} {:?}", left, open);
    assert_eq!(left.projected, open.projected);
}

/// Formulas, modes and what is left to the advisor are of the plate that holds together.
#[test]
fn the_advisor_and_modes_know_the_plate_that_holds_together() {
    let model = |what: &str| {
        let plate = Plate { effects: "delamination = WHAT, membrane = 'auto'", ..Plate::new() };
        let mut text = plate.text().replace("WHAT", &format!("'{what}'"));
        if what == "threshold" {
            text = text.replace(&plate.delamination, "");
        }
        Model::new(scene::parse(&text, &root().join("scene.toml")).unwrap(), &Registry::standard()).unwrap()
    };
    let one = NonZeroUsize::MIN;
    let [whole, growth] = ["threshold", "growth"].map(model);
    let stiffness = |model: &Model| advise::advise(model, one).unwrap()[0].plate.stiffness;
    assert_eq!(stiffness(&whole), stiffness(&growth));
    let decided = |what: &str| {
        let model = advise::decided(model(what), one).unwrap();
        model.decisions.into_iter().find(|decision| decision.effect == "membrane").unwrap()
    };
    assert_eq!(decided("threshold"), decided("growth"));
    let lowest = |model: &Model| modes::solve(model, 1, one).unwrap().modes.omega[0];
    assert_eq!(lowest(&whole), lowest(growth.whole().unwrap()));
}

/// Steps and penalties under which faces that come off are too heavy to, and cells that are long where a front may run.
#[test]
fn what_holds_faces_together_or_hides_their_zone_is_warned_of() {
    let warned = |changes: &[[&str; 2]], word: &str| {
        let mut text = Plate::new().text();
        for [old, new] in changes {
            assert!(text.contains(old), "{old}");
            text = text.replace(old, new);
        }
        let model = Model::new(scene::parse(&text, &root().join("scene.toml")).unwrap(), &Registry::standard());
        model.unwrap().warnings.iter().any(|warning| warning.contains(word))
    };
    let heavy = |changes: &[[&str; 2]]| warned(changes, "times the mass of the plate");
    // 0.4 dt^2 times the penalty are 8 kg/m^2 beside the 4.8 of the plate.
    assert!(!heavy(&[]));
    assert!(!heavy(&[["step = '1 us'", "step = '2 us'"]]));
    assert!(heavy(&[["step = '1 us'", "step = '8 us'"]]));
    assert!(heavy(&[["2e4 N/mm^3", "1e6 N/mm^3"]]));
    // The zone is some millimetres long: cells of 16 by 0.5 mm have the area of a square of 2.8 mm.
    let long = |cells: &str| warned(&[["cells = [12, 10]", cells]], "wide may open");
    assert!(!long("cells = [48, 40]"));
    assert!(long("cells = [3, 80]"));
}

/// The share is proportional to the blow where shear alone strains the interfaces, and the threshold lies where it is said to.
#[test]
fn the_share_follows_the_blow() {
    let share = |velocity| decision(&struck("auto", velocity).0).expected;
    let [weak, twice] = [0.3, 0.6].map(share);
    // A contact of Hertz's is stiffer under more force, so that twice the velocity gives a little more than twice.
    assert!((1.9..2.4).contains(&(twice / weak)), "{weak} {twice}");
    // What the threshold leaves closed has nothing to lose.
    let (_, open) = struck("growth", 0.3 * 0.5 / weak);
    assert_eq!(open.delaminated.unwrap().dissipated.total(), 0.0);
}

#[test]
fn what_is_open_from_the_beginning_is_followed() {
    let mut plate = Plate { effects: "delamination = 'auto'", velocity: 0.05, end_us: 20, ..Plate::new() };
    plate.delamination = "delamination = { penalty = '2e4 N/mm^3', \
        start = [{ interface = 1, at = { x = '24 mm', y = '20 mm' }, radius = '10 mm' }] }\n"
        .into();
    let (model, found) = impact_of(scene::parse(&plate.text(), &root().join("scene.toml")).unwrap()).unwrap();
    assert!(decision(&model).on && found.outcome.delaminated.is_some());
}

#[test]
fn what_nobody_can_decide_is_refused() {
    // What cannot grow cannot be left to the advisor either.
    let left = || Plate { effects: "delamination = 'auto'", ..Plate::new() };
    let refuse = |find: &str, put: &str, word: &str| {
        let text = left().text().replace(find, put);
        let read = scene::parse(&text, &root().join("scene.toml")).map_err(fem::Error::from);
        let error = read.and_then(|scene| Model::new(scene, &Registry::standard())).map(|_| ()).expect_err("refused");
        let report = format!("{:?}", miette::Report::new(error));
        assert!(report.contains(word), "{word:?} is not in {report}");
    };
    refuse("'hermite-prism'", "'mitc4'", "a shell holds");
    refuse("library = 'IM7/8552'", "library = 'AS4/3502'", "the toughness between the plies");
    refuse("penalty = '2e4 N/mm^3'", "points = 99", "points");
    refuse("penalty = '2e4 N/mm^3'", "points = 2", "2 points each way");
    let started = |starts: &[[f64; 3]]| {
        let each = |[x, y, radius]: &[f64; 3]| {
            format!("{{ interface = 1, at = {{ x = '{x} mm', y = '{y} mm' }}, radius = '{radius} mm' }}")
        };
        let starts: Vec<String> = starts.iter().map(each).collect();
        let text = left().text().replace("penalty = '2e4 N/mm^3'", &format!("start = [{}]", starts.join(", ")));
        let read = scene::parse(&text, &root().join("scene.toml")).unwrap();
        Model::new(read, &Registry::standard()).map(|_| ()).map_err(|error| error.to_string())
    };
    let lacks =
        |starts: &[[f64; 3]]| assert!(started(starts).unwrap_err().contains("lack the `symmetry`"), "{starts:?}");
    lacks(&[[26.0, 20.0, 6.0]]);
    lacks(&[[36.0, 20.0, 5.0]]);
    lacks(&[[36.0, 20.0, 5.0], [12.0, 20.0, 4.0]]);
    // Each other's images, but too small to hold a point; beside two that do.
    let pair = |radius: f64| [[36.0, 20.0, radius], [12.0, 20.0, radius]];
    assert_eq!(started(&pair(5.0)), Ok(()));
    let corners = |x: f64, y: f64, radius: f64| {
        [[x, y, radius], [48.0 - x, y, radius], [x, 40.0 - y, radius], [48.0 - x, 40.0 - y, radius]]
    };
    for small in [pair(0.01).to_vec(), [&pair(5.0)[..], &corners(8.0, 8.0, 0.01)].concat()] {
        assert!(started(&small).unwrap_err().contains("holds no point"), "{small:?}");
    }
    assert_eq!(started(&[&pair(5.0)[..], &corners(8.0, 8.0, 3.0)].concat()), Ok(()));
}
