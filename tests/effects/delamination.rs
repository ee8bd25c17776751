//! The threshold of delamination as an effect of its own.

use super::Struck;

const TOUGH: &str = "[materials.tape]\nlibrary = 'AS4/3502'\nGIIc = '0.6 kJ/m^2'\n";
const CRITERIA: &str = "[failure]\ncriteria = ['max-stress']\n";

/// The threshold of a plate with or without a toughness, N.
fn threshold(damage: &'static str, effects: &'static str, tough: bool) -> Option<f64> {
    struck(damage, effects, tough).model().unwrap().threshold.map(|threshold| threshold.force)
}

fn struck(damage: &'static str, effects: &'static str, tough: bool) -> Struck {
    Struck { damage, material: if tough { TOUGH } else { super::TAPE }, more: CRITERIA, ..Struck::new(effects) }
}

#[test]
fn it_follows_damage_unless_it_is_given() {
    let force = threshold("onset", "", true);
    assert!(force.unwrap() > 100.0);
    assert_eq!(threshold("off", "", true), None);
    for damage in ["onset", "off"] {
        assert_eq!(threshold(damage, "delamination = 'threshold'", true), force);
        assert_eq!(threshold(damage, "delamination = 'off'", true), None);
    }
    assert_eq!(threshold("onset", "", false), None);
}

#[test]
fn it_is_found_without_criteria() {
    let outcome = Struck { more: "", ..struck("off", "delamination = 'threshold'", true) }.outcome();
    let peak = outcome.history.iter().map(super::force).fold(0.0, f64::max);
    let force = threshold("off", "delamination = 'threshold'", true).unwrap();
    assert_eq!(outcome.contacts[0].threshold_times[0].is_some(), peak > force, "{peak} {force}");
    assert!(outcome.events.is_empty());
}

#[test]
fn refusals_help() {
    struck("off", "delamination = 'threshold'", false).refused(&["no material gives the toughness", "GIIc"]);
    struck("off", "delamination = 'progressive'", true).refused(&["not one of the known words", "threshold"]);
}
