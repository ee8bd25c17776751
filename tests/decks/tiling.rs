//! Pieces of decks whose stacks or elements do not lie side by side.

use super::{folder, program, run};
use fem::Error;
use fem::decks::DeckOutcome;
use fem::io::deck::Program;

/// A piece of four plies, of records D and what follows.
fn piece(program: Program, body: &str) -> Result<DeckOutcome, Error> {
    let kind = if program == Program::Lamcel { 3 } else { 1 };
    let text = format!(
        "A piece\n1,{kind},4,1\nP.B\nP.L\nP.E\nP.C\nP.S\nP.K\n2\nAS4/3502\n130300.,9650.,0.35,0.40,5930.,1.575E-9\n\
         1793.,1724.,64.,138.,109.,69.\n3502 resin\n3790.,3790.,0.36,0.36,1393.382352941,1.26E-9\n38.,69.,38.,69.,62.,62.\n\
         4,2\n1,0.25,0.\n1,0.25,45.\n1,0.25,-45.\n1,0.25,90.\n{body}\n0\n0\n0\n1\n0,ALL\n"
    );
    let home = tempfile::tempdir().unwrap();
    let deck = home.path().join("deck.dat");
    std::fs::write(&deck, text).unwrap();
    run(&deck, program, home.path())
}

/// The line that a refusal names, and what it says.
#[track_caller]
fn refused(program: Program, body: &str, line: usize, said: &str) {
    match piece(program, body) {
        Err(Error::Deck(error)) => {
            assert!(error.line() == line && error.to_string().contains(said), "line {}: {error}", error.line());
            assert!(!error.remedy().is_empty());
        }
        other => panic!("{other:?}"),
    }
}

const FOUR: &str = "1,4\n4\n1,0.,0.,0.\n2,10.,0.,0.\n3,10.,8.,0.\n4,0.,8.,0.";

#[test]
fn stacks_that_do_not_tile() {
    let lamsub = |columns: &str, stacks: &str, line, said| {
        refused(Program::Lamsub, &format!("1\n{columns}\n{stacks}"), line, said);
    };
    lamsub(FOUR, "2\n1,2,3,4\n1,2,3,4", 30, "stack 2 lies over stack 1 (line 29)");
    let more = |count: usize, columns: &str| FOUR.replacen("\n4\n", &format!("\n{count}\n"), 1) + columns;
    lamsub(
        &more(7, "\n5,15.,0.,0.\n6,15.,4.,0.\n7,10.,4.,0."),
        "2\n1,2,3,4\n2,5,6,7",
        30,
        "column 7 lies on the side of stack 1 (line 32) between its columns 2 and 3",
    );
    lamsub(
        &more(8, "\n5,10.,0.,0.\n6,40.,0.,0.\n7,40.,8.,0.\n8,10.,8.,0."),
        "2\n1,2,3,4\n5,6,7,8",
        28,
        "column 5 lies where column 2 (line 25) does: nothing joins them",
    );
    // Pieces apart may be meant.
    let apart = more(8, "\n5,20.,0.,0.\n6,40.,0.,0.\n7,40.,8.,0.\n8,20.,8.,0.");
    let loose = piece(Program::Lamsub, &format!("1\n{apart}\n2\n1,2,3,4\n5,6,7,8"));
    assert!(loose.unwrap().warnings.iter().any(|warning| warning.contains("nothing joins stack 2 to the first")));
    let beside = more(6, "\n5,15.,0.,0.\n6,15.,4.,0.");
    assert!(piece(Program::Lamsub, &format!("1\n{beside}\n2\n1,2,3,4\n2,5,6,3")).unwrap().warnings.is_empty());
}

#[test]
fn elements_that_do_not_tile() {
    let lamcel = |neighbour: &str, line, said| {
        refused(Program::Lamcel, &format!("2\n10.,8.,1,4\n1,2,3,4,5,6,7,8\n{neighbour}"), line, said);
    };
    lamcel("10.,8.,1,4\n1,2,3,4,5,6,7,8", 25, "element 2 lies over element 1");
    lamcel("5.,4.,1,4\n1,9,10,11,5,12,13,14", 25, "element 2 lies over element 1");
    lamcel("10.,4.,1,4\n2,9,10,11,6,12,13,14", 23, "node 11 lies on element 1, which does not name it");
    piece(Program::Lamcel, "2\n10.,8.,1,4\n1,2,3,4,5,6,7,8\n10.,8.,1,4\n2,9,10,3,6,11,12,7").unwrap();
}

/// The beam of the first example with other nodes of its pieces: what is said of them.
fn beam(changes: &[(&str, &str)]) -> Vec<String> {
    let home = tempfile::tempdir().unwrap();
    let example = folder("a-beam-plane-strain");
    run(&example.join("1-lamcel.dat"), program("lamcel"), home.path()).unwrap();
    let mut text =
        std::fs::read_to_string(example.join("2-tradyr.dat")).unwrap().replacen("4,2000,100,0", "4,10,10,0", 1);
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let deck = home.path().join("2-tradyr.dat");
    std::fs::write(&deck, text).unwrap();
    let said = run(&deck, program("tradyr"), home.path()).unwrap().warnings;
    said.into_iter().filter(|warning| warning.contains("substructure")).collect()
}

#[test]
fn pieces_that_do_not_fit() {
    assert_eq!(beam(&[]), [""; 0]);
    let upside_down = beam(&[("\n4,5,6,7,8,9\n", "\n6,5,4,9,8,7\n")]);
    assert!(
        upside_down[0].contains("substructure 2 does not fit: with the first node that it shares in its place, node "),
        "{upside_down:?}"
    );
    let reversed = beam(&[("\n4,5,6,7,8,9\n", "\n7,8,9,4,5,6\n")]);
    assert!(reversed[0].contains("substructure 2 puts node 7 where node 1 lies"), "{reversed:?}");
    let twice = beam(&[("\n10\n", "\n11\n"), ("\n1,2,3,4,5,6\n", "\n1,2,3,4,5,6\nBEAMCELL.KM\n6\n1,2,3,4,5,6\n")]);
    assert_eq!(twice, ["substructures 1 and 2 stand on the same nodes: both count"]);
}
