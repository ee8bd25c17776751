//! Sets of case control and of bulk data.

use super::card::Card;
use crate::raw::{Gathered, Members, Mention, MeshError, Place};

/// `SET 3 = 1, 2, 5 THRU 9 EXCEPT 7`; nodes or elements, as the numbers are. Sets of other things are passed over.
pub(super) fn case_control(text: &str, place: Place, gathered: &mut Gathered) -> Result<(), MeshError> {
    let Some((head, items)) = text.split_once('=') else {
        gathered.pass_over("SET", place);
        return Ok(());
    };
    let number = head.split_whitespace().nth(1).and_then(|word| word.parse::<u64>().ok());
    let words: Vec<&str> = items.split([',', ' ', '\t']).filter(|word| !word.is_empty()).collect();
    let is_known = |word: &&str| is(word, "THRU") || is(word, "EXCEPT") || word.parse::<u64>().is_ok();
    match number {
        Some(number) if !words.is_empty() && words.iter().all(is_known) => {
            put(&words, Members::Either, number, place, gathered)
        }
        _ => {
            gathered.pass_over("SET", place);
            Ok(())
        }
    }
}

/// `SET1, 3, 1, 2, THRU, 9` and `SET3, 3, GRID, 1, THRU, 9, BY, 2`.
pub(super) fn bulk(card: &Card, place: Place, gathered: &mut Gathered) -> Result<(), MeshError> {
    let number = card.whole(1).map_err(|what| gathered.wrong(place, what))?;
    let (of, first) = match (card.name(), card.field(2)) {
        ("SET3", kind) if is(kind, "GRID") => (Members::Nodes, 3),
        ("SET3", kind) if is(kind, "ELEM") || is(kind, "ELEMENT") => (Members::Elements, 3),
        ("SET3", kind) => {
            gathered.pass_over(&format!("SET3 of {kind}"), place);
            return Ok(());
        }
        _ => (Members::Either, 2),
    };
    let words: Vec<&str> = (first..card.len()).map(|at| card.field(at)).filter(|word| !word.is_empty()).collect();
    put(&words, of, number, place, gathered)
}

fn put(words: &[&str], of: Members, number: u64, place: Place, gathered: &mut Gathered) -> Result<(), MeshError> {
    let name = format!("set-{number}");
    let mentions = mentions(words).ok_or_else(|| {
        let what = format!("the set {number} should list numbers, FIRST THRU LAST, and EXCEPT or BY behind it");
        gathered.wrong(place, what)
    })?;
    for mention in mentions {
        gathered.member(of, &name, mention, place);
    }
    Ok(())
}

fn mentions(words: &[&str]) -> Option<Vec<Mention>> {
    let mut all = Vec::new();
    let mut words = words.iter().copied().peekable();
    while let Some(word) = words.next() {
        let first: u64 = word.parse().ok()?;
        if words.next_if(|word| is(word, "THRU")).is_none() {
            all.push(Mention::Number(first));
            continue;
        }
        let last: u64 = words.next()?.parse().ok().filter(|last| *last >= first)?;
        let step = match words.next_if(|word| is(word, "BY")) {
            Some(_) => words.next()?.parse().ok().filter(|step| *step > 0)?,
            None => 1,
        };
        let mut from = first;
        if words.next_if(|word| is(word, "EXCEPT")).is_some() {
            // What is excepted ascends and lies within.
            while let Some(except) =
                words.peek().and_then(|word| word.parse::<u64>().ok()).filter(|n| (from..=last).contains(n))
            {
                words.next();
                if except > from {
                    all.push(Mention::Range([from, except - 1, step]));
                }
                from = except + 1;
            }
        }
        if from <= last {
            all.push(Mention::Range([from, last, step]));
        }
    }
    Some(all)
}

fn is(word: &str, keyword: &str) -> bool {
    word.eq_ignore_ascii_case(keyword)
}
