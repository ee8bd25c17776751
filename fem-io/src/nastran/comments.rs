//! Names that pre-processors write into comments.

use super::card::Card;
use crate::raw::Gathered;
use std::collections::BTreeMap;

/// Names of properties and sets, by the names that they have without one.
#[derive(Debug, Default)]
pub(super) struct Names {
    known: BTreeMap<String, String>,
    /// Of the property whose card comes next, as Patran says it.
    region: Option<String>,
}

impl Names {
    /// HyperMesh `$HMNAME PROP 3"plate"` and `$HMSET 3 1 "edge"`, Femap `$ Femap Property 3 : plate`, ANSA
    /// `$ANSA_NAME_COMMENT;3;PSHELL;plate;`, Patran `$ Elements and Element Properties for region : plate`.
    pub(super) fn comment(&mut self, text: &str) {
        let text = text.trim();
        let quoted = || text.split('"').nth(1).map(str::trim);
        let number = |text: &str| {
            let digits = text.trim_start();
            digits[..digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len())].parse::<u64>().ok()
        };
        let named = if let Some(rest) = text.strip_prefix("$HMNAME PROP") {
            number(rest).zip(quoted()).map(|(n, name)| (format!("pid-{n}"), name))
        } else if let Some(rest) = text.strip_prefix("$HMSET") {
            number(rest).zip(quoted()).map(|(n, name)| (format!("set-{n}"), name))
        } else if let Some(rest) = text.strip_prefix("$ Femap Property ") {
            number(rest).zip(rest.split_once(':')).map(|(n, (_, name))| (format!("pid-{n}"), name.trim()))
        } else if let Some(rest) = text.strip_prefix("$ANSA_NAME_COMMENT;") {
            let mut items = rest.split(';');
            let (n, kind, name) = (items.next().and_then(number), items.next(), items.next());
            n.zip(name)
                .filter(|_| kind.is_some_and(|kind| kind.starts_with('P')))
                .map(|(n, name)| (format!("pid-{n}"), name))
        } else {
            if let Some(rest) = text.strip_prefix("$ Elements and Element Properties for region :") {
                self.region = Some(rest.trim().to_owned());
            }
            None
        };
        if let Some((key, name)) = named.filter(|(_, name)| !name.is_empty()) {
            self.known.insert(key, name.to_owned());
        }
    }

    /// The card of a property.
    pub(super) fn property(&mut self, card: &Card) {
        if let (Some(region), Ok(number)) = (self.region.take(), card.whole(1)) {
            self.known.insert(format!("pid-{number}"), region);
        }
    }

    /// Calls the sets by their names.
    pub(super) fn give(&self, gathered: &mut Gathered) {
        for (key, name) in &self.known {
            gathered.rename(key, name);
        }
    }
}
