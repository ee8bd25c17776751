//! Decks with one mistake each are refused with its line and kind.

use super::{folder, program, run};
use crate::support::{fem, root};
use fem::Error;

/// Where the governor without inertia is named, rather than the last line of the deck.
const BETTER: [(&str, &str); 1] = [("48-tradyr-all-governors.dat", "45")];

#[test]
fn every_mistake_is_found_where_it_can_first_be_known() {
    let folder = folder("g-malformed");
    let mut wrong = Vec::new();
    let setup = tempfile::tempdir().unwrap();
    for (deck, program) in [("setup-1-lamcel.dat", "lamcel"), ("setup-2-tradyr.dat", "tradyr")] {
        run(&folder.join(deck), self::program(program), setup.path()).unwrap();
    }
    let mut cases = csv::Reader::from_path(folder.join("expected.csv")).unwrap();
    for case in cases.records().map(Result::unwrap) {
        let empty = tempfile::tempdir().unwrap();
        let results = if case[0].contains("no-restart") { empty.path() } else { setup.path() };
        match run(&folder.join(&case[0]), program(&case[1]), results) {
            Err(Error::Deck(error)) => {
                let found = (error.line().to_string(), error.fault().to_string());
                let better = BETTER.iter().find(|(deck, _)| *deck == &case[0]).map(|(_, line)| *line);
                if found != (better.unwrap_or(&case[2]).to_owned(), case[3].to_owned()) {
                    wrong.push(format!("{}: {found:?}, {error}; expected {} {}", &case[0], &case[2], &case[3]));
                }
                assert!(!error.to_string().is_empty() && !error.remedy().is_empty(), "{}", &case[0]);
            }
            Err(error) => wrong.push(format!("{}: {error}", &case[0])),
            Ok(_) => wrong.push(format!("{}: accepted", &case[0])),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_kind_of_a_mistake_heads_its_message() {
    let deck = folder("g-malformed").join("09-lamcel-too-many-items.dat");
    let told = fem(&root(), &["lamcel", deck.to_str().unwrap()]).stderr;
    assert!(told.starts_with("Error: too-many-items\n"), "{told}");
}
