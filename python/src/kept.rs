//! Texts and lists that live until the program ends, once however often they are kept: what registries list and events carry.

use fem::core::material::{Strength, Toughness};
use fem::core::plugin::unknown_key;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// Lists of one kind.
type Lists<T> = Mutex<Vec<&'static [T]>>;

pub(crate) fn text(text: &str) -> &'static str {
    static KEPT: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.get(text) {
        return known;
    }
    let text: &'static str = text.to_owned().leak();
    kept.insert(text);
    text
}

pub(crate) fn texts(texts: &[String]) -> &'static [&'static str] {
    static KEPT: Lists<&'static str> = Mutex::new(Vec::new());
    list(&KEPT, texts.iter().map(|each| text(each)).collect())
}

/// Strengths by their names.
pub(crate) fn strengths(names: &[String]) -> PyResult<&'static [Strength]> {
    static KEPT: Lists<Strength> = Mutex::new(Vec::new());
    let each = names.iter().map(|name| find("strength", name, Strength::ALL, Strength::name));
    Ok(list(&KEPT, each.collect::<PyResult<_>>()?))
}

/// Toughnesses by their names.
pub(crate) fn toughnesses(names: &[String]) -> PyResult<&'static [Toughness]> {
    static KEPT: Lists<Toughness> = Mutex::new(Vec::new());
    let each = names.iter().map(|name| find("toughness", name, Toughness::ALL, Toughness::name));
    Ok(list(&KEPT, each.collect::<PyResult<_>>()?))
}

fn find<T: Copy>(what: &str, name: &str, all: &[T], name_of: impl Fn(T) -> &'static str) -> PyResult<T> {
    all.iter().copied().find(|each| name_of(*each) == name).ok_or_else(|| {
        let known = all.iter().map(|each| name_of(*each));
        PyValueError::new_err(format!("{what} `{name}` {}", unknown_key(name, known)))
    })
}

fn list<T: PartialEq>(kept: &Lists<T>, list: Vec<T>) -> &'static [T] {
    let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.iter().find(|known| ***known == list[..]) {
        return known;
    }
    let list: &'static [T] = list.leak();
    kept.push(list);
    list
}
