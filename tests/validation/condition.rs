//! Whether pivots alone notice every stiffness that is worth a warning: plates that all but move freely, that are very thin, of moduli
//! far apart.

use super::springs::{ELEMENTS, model, text};
use fem::analyses::{assembled, statics};
use fem::core::assembly::NOTABLE_CONDITION;
use fem::core::counters::Counters;
use fem::output::statics::StaticSummary;
use std::num::NonZeroUsize;

const LOAD: &str = "pressure = '1 kPa'\nface = 'top'";

/// The condition of the stiffness estimated by solves, and where pivots call for it; none where the plate is refused.
fn conditions(text: &str) -> Option<[Option<f64>; 2]> {
    let model = model(text).ok()?;
    let mut structure =
        assembled::structure(&model, false, NonZeroUsize::MIN, &mut Counters::default()).ok()?.structure;
    let noticed = structure.notable_condition().ok()?;
    Some([structure.condition().ok(), noticed])
}

/// How many of these are beyond what is worth a word, and how many are not even estimated.
#[track_caller]
fn noticed(texts: impl Iterator<Item = String>) -> (usize, usize) {
    let (mut notable, mut spared) = (0, 0);
    for text in texts {
        let Some([Some(condition), noticed]) = conditions(&text) else { continue };
        notable += usize::from(condition > NOTABLE_CONDITION);
        spared += usize::from(noticed.is_none());
        assert!(condition <= NOTABLE_CONDITION || noticed == Some(condition), "{condition:e} {noticed:?}\n{text}");
    }
    (notable, spared)
}

/// Softness of a support, in powers of ten down from where it is part of a sound plate to where rounding alone remains.
fn powers() -> impl Iterator<Item = String> + Clone {
    (1..=12).map(|p| format!("1e{p}"))
}

fn square(cells: usize) -> String {
    format!("{{ rectangle = ['100 mm', '100 mm'], cells = [{cells}, {cells}] }}")
}

#[test]
fn plates_that_all_but_move_freely() {
    let beds = |k: &str| {
        let rest = "{ restrain = 'rigid-motions' }";
        let disc = |x: f64, y: f64| {
            format!(
                "{{ disc = {{ x = '{x} mm', y = '{y} mm', radius = '6 mm' }}, kind = 'roller', at = 'bottom', stiffness = '{k} N/m^3' }}"
            )
        };
        [
            // Sinks; tilts about one side; tilts about the other diagonal.
            format!("{{ group = 'plate', kind = 'roller', at = 'bottom', stiffness = '{k} N/m^3' }}, {rest}"),
            format!("{{ group = 'x-min', kind = 'simply-supported' }}, {}, {rest}", disc(85.0, 40.0)),
            format!("{}, {}, {}, {rest}", disc(15.0, 15.0), disc(85.0, 85.0), disc(15.0, 85.0)),
        ]
    };
    let elements = ELEMENTS.iter().flat_map(|(element, cells)| [4, *cells].map(|cells| (*element, cells)));
    let cases = elements.flat_map(|(element, cells)| powers().map(move |k| (element, cells, k)));
    let texts =
        cases.flat_map(|(element, cells, k)| beds(&k).map(|bed| text(&square(cells), element, 0.5, &bed, LOAD)));
    let (notable, spared) = noticed(texts);
    assert!(notable > 40 && spared > 20, "{notable} {spared}");
}

#[test]
fn plates_ever_thinner() {
    let sides = |kind: &str, n: usize| {
        let side = |side: &&str| format!("{{ group = '{side}', kind = '{kind}' }}");
        ["x-min", "y-max", "x-max", "y-min"][..n].iter().map(side).collect::<Vec<_>>().join(", ")
    };
    let ways = [("clamped", 1), ("clamped", 4), ("simply-supported", 4), ("simply-supported", 2)];
    let plies = [50.0, 5.0, 0.5, 5e-2, 5e-3, 1e-3];
    let cases = ELEMENTS.iter().flat_map(|(element, cells)| ways.map(|(kind, n)| (*element, *cells, sides(kind, n))));
    let texts = cases.flat_map(|(element, cells, held)| {
        plies.map(|ply| text(&square(cells), element, ply, &format!("{held}, {{ restrain = 'rigid-motions' }}"), LOAD))
    });
    let (notable, spared) = noticed(texts);
    assert!(notable > 10 && spared > 20, "{notable} {spared}");
}

/// A static run warns of a plate that is all but none, and says nothing of a number that nobody asked for of a sound one.
#[test]
fn a_run_warns_and_is_silent() {
    let summary = |ply: f64| {
        let held = "{ group = 'x-min', kind = 'clamped' }";
        let model = model(&text(&square(12), ELEMENTS[0].0, ply, held, LOAD)).unwrap();
        StaticSummary::new(&model, &statics::solve(&model, NonZeroUsize::MIN).unwrap())
    };
    let (sound, thin) = (summary(5.0), summary(5e-2));
    assert_eq!((sound.condition_estimate, sound.warnings), (None, Vec::new()));
    assert!(thin.condition_estimate.is_some_and(|c| c > NOTABLE_CONDITION), "{:?}", thin.condition_estimate);
    assert!(thin.warnings.iter().any(|w| w.contains("rounding costs")), "{:?}", thin.warnings);
}
