//! Decks that somebody has mistyped are read or refused with a place, whatever the mistake.

use super::folder;
use fem::io::deck::{DeckSource, NoResults, Program, parse};
use miette::Diagnostic as _;
use proptest::prelude::*;
use std::time::{Duration, Instant};

const PROGRAMS: [Program; 3] = [Program::Lamcel, Program::Lamsub, Program::Tradyr];

/// What may come in the place of an item.
const ITEMS: [&str; 18] = [
    "2000000000",
    "-1",
    "",
    "0",
    "1",
    "1e308",
    "nan",
    "ALL",
    "u30",
    "'U10'",
    ",",
    "1 2",
    "\u{e9}",
    "3*0.",
    "99999999999999999999",
    "2.D-7",
    "! a comment",
    "8.",
];

/// A deck of every kind.
fn decks() -> Vec<String> {
    let read = |(example, deck): &(&str, &str)| std::fs::read_to_string(folder(example).join(deck)).unwrap();
    [
        ("a-beam-plane-strain", "1-lamcel.dat"),
        ("a-beam-plane-strain", "3-back-all.dat"),
        ("b-plate-cells", "1-lamcel.dat"),
        ("d-restart", "3-restart-same-name.dat"),
        ("h-one-dof-a-node", "2-tradyr-rk1.dat"),
        ("i-three-dofs-a-node", "2-tradyr.dat"),
        ("j-turned-axes", "1-lamsub.dat"),
        ("k-other-spelling", "1-lamcel.dat"),
    ]
    .iter()
    .map(read)
    .collect()
}

/// One way to mistype a deck: (what, line, item, with what).
fn mistyped(deck: &str, (what, line, item, with): (u8, usize, usize, usize)) -> String {
    let mut lines: Vec<String> = deck.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return deck.to_owned();
    }
    let at = line % lines.len();
    let mut items: Vec<&str> = lines[at].split(',').collect();
    let place = item % items.len();
    match what {
        0 => lines.truncate(at),
        1 => drop(lines.remove(at)),
        2 => lines.insert(at, lines[at].clone()),
        3 => lines.insert(at, ITEMS[with].to_owned()),
        4 => {
            items.insert(place, ITEMS[with]);
            lines[at] = items.join(",");
        }
        _ => {
            items[place] = ITEMS[with];
            lines[at] = items.join(",");
        }
    }
    lines.join("\n")
}

/// Reads `text` as a deck of every program: whatever is refused has words, a remedy and a place in the text.
fn sound(text: &str) {
    let source = DeckSource::new("mistyped.dat", text.to_owned());
    for program in PROGRAMS {
        if let Err(error) = parse(&source, program, &NoResults) {
            assert!(!error.to_string().is_empty() && !error.remedy().is_empty(), "{error}");
            assert!(error.line() <= text.lines().count() + 1, "{error}");
            if text.is_empty() {
                continue;
            }
            let span = error.labels().into_iter().flatten().next().unwrap();
            assert!(
                error.source_code().unwrap().read_span(span.inner(), 0, 0).is_ok(),
                "{error} at {span:?} of {text:?}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mistyped_decks_are_read_or_refused(
        deck in 0..8_usize,
        changes in proptest::collection::vec((0..8_u8, 0..400_usize, 0..12_usize, 0..ITEMS.len()), 1..4),
    ) {
        sound(&changes.into_iter().fold(decks().swap_remove(deck), |deck, change| mistyped(&deck, change)));
    }

    #[test]
    fn any_text_is_read_or_refused(text in "[ -~\n,0-9]{0,200}") {
        sound(&text);
    }
}

/// Every whole number of every deck by turns, so large that its things would fill any memory.
#[test]
fn no_count_takes_memory() {
    let begun = Instant::now();
    for deck in decks() {
        let lines: Vec<&str> = deck.lines().collect();
        for at in 0..lines.len() {
            for item in 0..lines[at].split(',').count() {
                let mut items: Vec<&str> = lines[at].split(',').collect();
                items[item] = "2000000000";
                let line = items.join(",");
                let mut changed = lines.clone();
                changed[at] = &line;
                sound(&changed.join("\n"));
            }
        }
    }
    assert!(begun.elapsed() < Duration::from_secs(30), "{:?}", begun.elapsed());
}
