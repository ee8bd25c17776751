//! Clamps: layers that come apart in them.

use super::scenes::{Plate, STRONG, apart, forces};
use crate::support::{impact_of, root};
use fem::advise::{Held, hindsight};
use fem::io::scene;

const CLAMPED: &str = "kind = 'clamped'";
/// With the deflection at every height.
const EVERYWHERE: &str = "kind = 'clamped' }, { group = 'x-min', at = 'all', fix = ['U30'] }, { group = 'x-max', at = 'all', fix = ['U30'] }, \
                          { group = 'y-min', at = 'all', fix = ['U30'] }, { group = 'y-max', at = 'all', fix = ['U30']";

fn plate(hold: &'static str) -> Plate {
    Plate { hold, material: STRONG, ply_mm: 0.4, mass_kg: 0.1, end_us: 160, ..Plate::new() }
}

/// A plate whose layers have no bond at all is held by a clamp as by one that holds every deflection along it.
#[test]
fn layers_stay_together_in_a_clamp() {
    let start = [1, 2]
        .map(|below| format!("{{ interface = {below}, at = {{ x = '24 mm', y = '20 mm' }}, radius = '500 mm' }}"));
    let loose = |hold| {
        let delamination = format!("delamination = {{ penalty = '2e4 N/mm^3', start = [{}] }}\n", start.join(", "));
        forces(&Plate { delamination, ..plate(hold) }.outcome())
    };
    let [clamped, held] = [CLAMPED, EVERYWHERE].map(loose);
    assert!(apart(&clamped, &held) < 0.02, "{}", apart(&clamped, &held));
    let sound = forces(&plate(CLAMPED).outcome());
    assert!(apart(&clamped, &sound) > 0.2, "{}", apart(&clamped, &sound));
}

/// Where interfaces reach a clamp that has no level in its middle, it is known for a clamp all the same.
#[test]
fn a_clamp_in_which_layers_may_part_is_known() {
    let text = Plate { velocity: 6.0, ..plate(CLAMPED) }.text();
    let (model, found) = impact_of(scene::parse(&text, &root().join("scene.toml")).unwrap()).unwrap();
    let over = hindsight(&model, &found.outcome.contacts, None, 0.05).unwrap();
    assert_eq!(over.held, Held { slope: true, in_plane: true }.name());
    assert!(over.reached > 0.05, "{over:?}");
}
