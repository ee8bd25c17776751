//! Several impactors in one scene.

use crate::support::{impact_of, root, strip};
use fem::Error;
use fem::analyses::impact::Outcome;
use fem::core::plugin::Dimension;
use fem::failure::scan::PlyOrInterface;
use fem::io::scene;

const LAW: &str = "{ law = 'hertz', k = '1e4 N/mm^1.5' }";

/// A plate of 60 mm by 40 mm, simply supported, under `impactors`.
fn outcome(impactors: &str, reduction: &str, march: &str) -> Result<Outcome, Error> {
    let edges = ["x-min", "x-max", "y-min", "y-max"]
        .map(|edge| format!("[[support]]\ngroup = '{edge}'\nat = 'all'\nfix = ['U10', 'U20', 'U30']\n"));
    let text = format!(
        "title = 'impactors'\nmesh = {{ rectangle = ['60 mm', '40 mm'], cells = [12, 8] }}\n\
         element = {{ kind = 'mitc4' }}\nmaterials.tape = {{ library = 'AS4/3502' }}\nreduction = {{ {reduction} }}\n\
         march = {{ {march} }}\neffects.damage = 'off'\ncontact = {LAW}\n\
         [laminate]\nplies = '[0/90/90/0]'\nmaterial = 'tape'\nply_thickness = '0.25 mm'\nlayers = 1\n{}{impactors}",
        edges.concat()
    );
    Ok(impact_of(scene::parse(&text, &root().join("scene.toml"))?)?.1.outcome)
}

fn impactor(mass: &str, x: u32, more: &str) -> String {
    format!("[[impactor]]\nmass = '{mass}'\nvelocity = '2 m/s'\nat = {{ x = '{x} mm', y = '20 mm' }}\n{more}\n")
}

const FULL: &str = "method = 'none'";
const RITZ: &str = "method = 'ritz', vectors = 40";
const MARCH: &str = "integrator = 'newmark', step = '0.5 us', end = '150 us'";

fn forces(outcome: &Outcome, i: usize) -> Vec<f64> {
    outcome.history.iter().map(|row| row.impactors[i].contact_force_n).collect()
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, v| m.max(v.abs()))
}

#[test]
fn mirrored_ones_feel_equal_forces() {
    // A basis of a few vectors is not quite symmetric.
    for (reduction, tolerance) in [(FULL, 1e-7), (RITZ, 1e-3)] {
        let outcome = outcome(&[impactor("1 g", 20, ""), impactor("1 g", 40, "")].concat(), reduction, MARCH).unwrap();
        let [left, right] = [0, 1].map(|i| forces(&outcome, i));
        let peak = largest(left.iter().copied());
        let off = largest(left.iter().zip(&right).map(|(a, b)| a - b));
        assert!(peak > 20.0 && off < tolerance * peak, "{reduction}: {off:e} of {peak}");
        assert!(outcome.energy_error < 1e-3, "{reduction}: {}", outcome.energy_error);
    }
}

#[test]
fn a_late_one_changes_nothing_before() {
    let alone = forces(&outcome(&impactor("1 g", 20, ""), FULL, MARCH).unwrap(), 0);
    let late = impactor("2 g", 40, "start = '70 us'\ncontact = { law = 'linear', k = '1e3 N/mm' }");
    let outcome = outcome(&[impactor("1 g", 20, ""), late].concat(), FULL, MARCH).unwrap();
    let first = forces(&outcome, 0);
    let second = forces(&outcome, 1);
    let touch = second.iter().position(|f| *f > 0.0).unwrap();
    // The plate has moved by then, and so has the time of the touch.
    let time = outcome.history[touch].time_s;
    assert!((60e-6..90e-6).contains(&time) && time != 70e-6, "{time}");
    let off = |rows| largest(alone.iter().zip(&first).take(rows).map(|(a, b)| a - b));
    assert!(off(touch) < 1e-9, "{:e}", off(touch));
    assert!(off(alone.len()) > 0.1, "waves do arrive");
    assert!(outcome.energy_error < 1e-3, "{}", outcome.energy_error);
    assert!(outcome.contacts.iter().all(|contact| contact.count > 0));
}

#[test]
fn two_in_one_place_are_one() {
    for reduction in [FULL, RITZ] {
        let one = outcome(&impactor("2 g", 30, ""), reduction, MARCH).unwrap();
        let half = impactor("1 g", 30, "contact = { law = 'hertz', k = '0.5e4 N/mm^1.5' }");
        let two = outcome(&[half.clone(), half].concat(), reduction, MARCH).unwrap();
        let peak = largest(forces(&one, 0).into_iter());
        let off = largest(one.history.iter().zip(&two.history).map(|(a, b)| a.contact_force_n() - b.contact_force_n()));
        assert!(off < 1e-7 * peak, "{reduction}: {off:e} of {peak}");
        // One that overlaps it, too near to tell apart.
        let near = impactor("1 g", 30, "").replace("'30 mm'", "'30.001 mm'");
        outcome(&[impactor("1 g", 30, ""), near].concat(), reduction, MARCH).unwrap();
    }
}

#[test]
fn explicit_steps_count_all_contacts() {
    let both = [impactor("1 g", 20, ""), impactor("0.01 g", 40, "")].concat();
    for integrator in ["rk3", "rk4", "central-difference"] {
        let march = |step: f64| format!("integrator = '{integrator}', step = '{step} us', end = '50 us'");
        let refused = outcome(&both, RITZ, &march(50.0)).unwrap_err().to_string();
        let (_, limit) = refused.split_once("stability limit of ").unwrap();
        let limit: f64 = limit.split(' ').next().unwrap().parse().unwrap();
        let alone = outcome(&impactor("1 g", 20, ""), RITZ, &march(50.0)).unwrap_err().to_string();
        assert_ne!(alone, refused, "the light one counts");
        assert!(outcome(&both, RITZ, &march(1.001 * limit)).is_err(), "{integrator}");
        let below = outcome(&both, RITZ, &march(0.999 * limit)).unwrap();
        assert!(below.energy_error < 1e-2, "{integrator}: {}", below.energy_error);
    }
}

#[test]
fn results_say_whose_is_what() {
    let case = strip().scene("[impactor]", "[[impactor]]").append(
        "[[impactor]]\nname = 'late'\nmass = '1 g'\nvelocity = '3 m/s'\nstart = '5 us'\nat = { x = '5 mm', y = '5 mm' }\n",
    );
    let done = case.fem("run", &["--out", "results"]).good();
    for words in ["  force     impactor-1: peak ", "  impact    late: 1 g at 3 m/s", "there at 5 us"] {
        assert!(done.stdout.contains(words), "{words:?} is not in {}", done.stdout);
    }
    let (header, rows) = case.table("results/history.csv");
    assert_eq!((header[1].as_str(), header[5].as_str()), ("impactor-1.contact_force_N", "late.contact_force_N"));
    let from: f64 = rows[0][6].parse().unwrap();
    assert!(header.len() == 15 && (from + 15e-6).abs() < 1e-18, "{from}");
    let summary = case.summary("results");
    let late = &summary["impact"][1];
    assert_eq!((late["name"].as_str(), late["start_time_s"].as_f64()), (Some("late"), Some(5e-6)));
    assert!(late["impulse_N_s"].as_f64().unwrap() > 0.0);
    assert!(late["contacts"].as_u64().unwrap() > 0);
    let picture = case.read("results/contact_force.svg");
    assert!(picture.contains(">impactor-1</text>") && picture.contains(">late</text>"));
}

#[test]
fn an_indentation_that_no_contact_law_describes_is_warned_of() {
    let soft =
        strip().scene("k = \"1.07e5 N/mm^1.5\"", "k = \"1 N/mm^1.5\"").scene("end = \"20 us\"", "end = \"0.5 ms\"");
    let done = soft.fem("run", &["--out", "out"]).good();
    let summary = soft.summary("out");
    let deepest = summary["impact"]["peak_indentation_m"].as_f64().unwrap();
    let words = format!("pressed {} deep into a plate of 2.113 mm", Dimension::LENGTH.of(deepest));
    let mut warnings = summary["warnings"].as_array().unwrap().iter().map(|warning| warning.as_str().unwrap());
    let warned = warnings.find(|warning| warning.contains(&words)).unwrap();
    assert!(done.stdout.contains(warned), "{done:#?}");
    assert!(deepest > 0.25 * 2.1133e-3, "{deepest}");
}

/// A plate without symmetry through its thickness, struck at a point by `load`.
fn thrown(plies: &str, layers: &str, y: f64, load: &str) -> Outcome {
    let edges = ["x-min", "x-max", "y-min", "y-max"]
        .map(|edge| format!("[[support]]\ngroup = '{edge}'\nat = 'all'\nfix = ['U10', 'U20', 'U30']\n"));
    let text = format!(
        "title = 'sides'\nmesh = {{ rectangle = ['60 mm', '40 mm'], cells = [6, 4] }}\n\
         materials.tape = {{ library = 'AS4/3502', Yt = '5 MPa' }}\nreduction = {{ method = 'ritz', vectors = 20 }}\n\
         march = {{ integrator = 'newmark', step = '1 us', end = '80 us' }}\ncontact = {LAW}\n\
         failure = {{ criteria = ['hashin-report'], radius = '15 mm' }}\n\
         [laminate]\nplies = '{plies}'\nmaterial = 'tape'\nply_thickness = '0.25 mm'\nlayers = {layers}\n{}\
         [impactor]\nmass = '20 g'\nvelocity = '2 m/s'\nat = {{ x = '20 mm', y = '{y} mm' }}\n{load}\n",
        edges.concat()
    );
    impact_of(scene::parse(&text, &root().join("scene.toml")).unwrap()).unwrap().1.outcome
}

/// A laminate turned over about the x axis, its plies in reverse with angles of the other sign, feels from above what it felt
/// from below.
#[test]
fn from_below_is_from_above_on_a_plate_turned_over() {
    for load in ["load = 'node'", "patch_radius = '4 mm'", "patch_side = '6 mm'"] {
        let below = thrown("[0/30/-45/90]", "[1, 3]", 10.0, &format!("{load}\nface = 'bottom'"));
        let above = thrown("[90/45/-30/0]", "[3, 1]", 30.0, load);
        let peak = largest(forces(&above, 0).into_iter());
        let off = largest(forces(&below, 0).iter().zip(forces(&above, 0)).map(|(a, b)| a - b));
        assert!(peak > 20.0 && off < 1e-6 * peak, "{load}: {off:e} of {peak}");
        assert!(below.contacts[0].deflection > 0.0 && below.energy_error < 1e-3);
        assert!(!above.events.is_empty(), "{:?}", above.peaks);
        assert_eq!(below.events.len(), above.events.len());
        let turned = |place: PlyOrInterface| match place {
            PlyOrInterface::Ply(k) => PlyOrInterface::Ply(3 - k),
            PlyOrInterface::Interface(k) => PlyOrInterface::Interface(2 - k),
        };
        for event in &below.events {
            let image =
                above.events.iter().find(|other| other.mode == event.mode && other.place == turned(event.place));
            let image = image.unwrap_or_else(|| panic!("{load}: {event:?}"));
            assert!((image.time - event.time).abs() < 1e-6 * 80e-6, "{event:?} {image:?}");
        }
        // From above the same plate is another one.
        let other = thrown("[0/30/-45/90]", "[1, 3]", 10.0, load);
        assert!(other.events.iter().map(|e| (e.place, e.mode)).ne(below.events.iter().map(|e| (e.place, e.mode))));
    }
}

#[test]
fn gravity_pulls_along_the_way_from_above_alone() {
    let heavy = "method = 'none' }\neffects.gravity = '9.81 m/s^2' #";
    outcome(&impactor("1 g", 20, ""), heavy, MARCH).unwrap();
    let below = [impactor("1 g", 20, ""), impactor("1 g", 40, "face = 'bottom'")].concat();
    let refused = outcome(&below, heavy, MARCH).unwrap_err().to_string();
    assert!(refused.contains("strikes the bottom face"), "{refused}");
}
