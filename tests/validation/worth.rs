//! What runs say of their own errors, against finer runs: `cargo bench --bench worth` has the table of all scenes.

#[path = "../../benches/worth/scenes.rs"]
mod scenes;

use scenes::{SCENES, statements};

/// Errors below this are of no interest.
const SMALL: f64 = 1e-3;

/// The report's first case in nine settings and a small mass.
#[test]
#[ignore = "long"]
fn errors_are_said_to_be_as_large_as_they_are() {
    let mut all = Vec::new();
    for (name, count) in [("as4-3502-16ply-50mm", usize::MAX), ("im6-934-32ply-small-mass", 1)] {
        let (_, variants) = SCENES.iter().find(|scene| scene.0 == name).unwrap();
        let mut known = Vec::new();
        for variant in variants.iter().take(count) {
            all.extend(statements((name, *variant), &mut known));
        }
    }
    let notable: Vec<_> = all.iter().filter(|s| s.truth > SMALL).collect();
    let text = |s: &scenes::Statement| format!("{}, {}: said {:?}, true {:.2e}", s.scene, s.result, s.said, s.truth);
    assert!(notable.len() >= 15, "{}", notable.len());
    let least = |ratio: f64| {
        notable.iter().filter(|s| s.ratio().is_none_or(|r| r < ratio)).map(|s| text(s)).collect::<Vec<_>>()
    };
    assert!(least(0.2).is_empty(), "{:#?}", least(0.2));
    assert!(10 * least(0.5).len() <= notable.len(), "{:#?}", least(0.5));
}
