//! Where the nodes of a cell lie: positions follow from how rectangles hang together.

use super::tiling::{Box3, Misfit, misfit};
use super::{DeckPiece, ElementCard, Node};
use crate::deck::reader::Reader;
use crate::deck::source::{DeckError, DeckPlace, Fault};
use std::collections::BTreeMap;
use std::ops::Range;

/// Places that differ by less than this part of an element's size are one.
pub(super) const SAME: f64 = 1e-6;

/// An element as the deck describes it.
#[derive(Debug)]
pub(super) struct Card {
    pub(super) number: usize,
    pub(super) plies: Range<usize>,
    pub(super) nodes: Vec<u32>,
    /// Along X and Y.
    pub(super) size: [f64; 2],
    pub(super) heights: [f64; 2],
    pub(super) place: DeckPlace,
}

impl Card {
    /// Corners from the first one, z from the bottom of the laminate.
    fn corners(&self) -> Vec<[f64; 3]> {
        let ([x, y], [low, high]) = (self.size, self.heights);
        match self.nodes.len() {
            4 => vec![[0.0, 0.0, low], [x, 0.0, low], [x, 0.0, high], [0.0, 0.0, high]],
            _ => [low, high].iter().flat_map(|z| [[0.0, 0.0, *z], [x, 0.0, *z], [x, y, *z], [0.0, y, *z]]).collect(),
        }
    }

    /// What counts as nothing along X, Y, Z.
    fn tolerance(&self) -> [f64; 3] {
        [self.size[0], self.size[1], self.heights[1] - self.heights[0]].map(|size| SAME * size)
    }
}

/// A cell that grows element by element.
#[derive(Debug, Default)]
pub(super) struct Placing {
    nodes: BTreeMap<u32, [f64; 3]>,
    /// Nodes by their places on a grid of `spacing`.
    grid: BTreeMap<[i64; 3], Vec<u32>>,
    spacing: [f64; 3],
    placed: Vec<(Card, [f64; 2])>,
    /// Elements that share no node with those placed yet.
    waiting: Vec<Card>,
}

impl Placing {
    pub(super) fn add(&mut self, reader: &Reader<'_>, card: Card) -> Result<(), DeckError> {
        if self.placed.is_empty() {
            self.spacing = card.tolerance().map(|t| t / SAME);
            self.put(reader, card, [0.0, 0.0])?;
        } else if let Some(origin) = self.origin(&card) {
            self.put(reader, card, origin)?;
        } else {
            self.waiting.push(card);
            return Ok(());
        }
        while let Some((i, origin)) =
            self.waiting.iter().enumerate().find_map(|(i, card)| Some((i, self.origin(card)?)))
        {
            let card = self.waiting.remove(i);
            self.put(reader, card, origin)?;
        }
        Ok(())
    }

    /// Where the first corner of an element lies, if one of its nodes is known.
    fn origin(&self, card: &Card) -> Option<[f64; 2]> {
        let known = card.nodes.iter().zip(card.corners()).find_map(|(node, c)| Some((self.nodes.get(node)?, c)));
        known.map(|(at, corner)| [at[0] - corner[0], at[1] - corner[1]])
    }

    fn put(&mut self, reader: &Reader<'_>, card: Card, origin: [f64; 2]) -> Result<(), DeckError> {
        let tolerance = card.tolerance();
        let same = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() <= tolerance[k]);
        for (node, [x, y, z]) in card.nodes.iter().zip(card.corners()) {
            let at = [origin[0] + x, origin[1] + y, z];
            let refuse = |message| {
                let help = "ELEN, EWID, plies and the order of the corners decide where nodes lie";
                reader.error(&card.place, Fault::Geometry, message, help)
            };
            match self.nodes.get(node) {
                Some(known) if same(known, &at) => continue,
                Some(known) => {
                    let [place, known] = [&at, known].map(|p| format!("({:.6}, {:.6}, {:.6})", p[0], p[1], p[2]));
                    return refuse(format!("element {} puts node {node} at {place}, others at {known}", card.number));
                }
                None => {}
            }
            if let Some(other) = self.near(&at).find(|other| same(&self.nodes[other], &at)) {
                return refuse(format!("element {} puts node {node} where node {other} lies", card.number));
            }
            self.grid.entry(self.square(&at)).or_default().push(*node);
            self.nodes.insert(*node, at);
        }
        self.placed.push((card, origin));
        Ok(())
    }

    fn square(&self, at: &[f64; 3]) -> [i64; 3] {
        std::array::from_fn(|k| (at[k] / self.spacing[k]).floor() as i64)
    }

    fn near(&self, at: &[f64; 3]) -> impl Iterator<Item = u32> + '_ {
        let [x, y, z] = self.square(at);
        let around = |k: i64| [k.saturating_sub(1), k, k.saturating_add(1)];
        let squares = around(x).into_iter().flat_map(move |x| around(y).into_iter().map(move |y| (x, y)));
        let squares = squares.flat_map(move |(x, y)| around(z).into_iter().map(move |z| [x, y, z]));
        squares.filter_map(|square| self.grid.get(&square)).flatten().copied()
    }

    pub(super) fn finish(mut self, reader: &Reader<'_>) -> Result<DeckPiece, DeckError> {
        if let Some(card) = self.waiting.first() {
            return reader.error(
                &card.place,
                Fault::NotConnected,
                format!("element {} shares no node with the others", card.number),
                "elements of a cell hang together",
            );
        }
        self.placed.sort_by_key(|(card, _)| card.number);
        let index: BTreeMap<u32, usize> = self.nodes.keys().enumerate().map(|(i, number)| (*number, i)).collect();
        let element = |(card, [x0, y0]): &(Card, [f64; 2])| {
            let (x1, y1) = (x0 + card.size[0], y0 + card.size[1]);
            ElementCard {
                plies: card.plies.clone(),
                nodes: card.nodes.iter().map(|node| index[node]).collect(),
                plane: [[*x0, *y0], [x1, *y0], [x1, y1], [*x0, y1]],
            }
        };
        let elements: Vec<ElementCard> = self.placed.iter().map(element).collect();
        let boxes: Vec<Box3> =
            elements.iter().zip(&self.placed).map(|(element, (card, _))| Box3::new(element, card.heights)).collect();
        let at: Vec<[f64; 3]> = self.nodes.values().copied().collect();
        let number = |element: usize| self.placed[element].0.number;
        match misfit(&boxes, &at) {
            None => {}
            Some(Misfit::Overlap([a, b])) => {
                let found = format!("element {} lies over element {}", number(b), number(a));
                let help =
                    "name each element once; ELEN, EWID, plies and the order of the corners decide where it lies";
                return reader.error(&self.placed[b].0.place, Fault::Geometry, found, help);
            }
            Some(Misfit::Hanging { node, element }) => {
                let node = self.nodes.keys().nth(node).copied().unwrap_or_default();
                let found = format!("node {node} lies on element {}, which does not name it", number(element));
                let help = "let elements beside each other have whole faces in common";
                return reader.error(&self.placed[element].0.place, Fault::Geometry, found, help);
            }
        }
        let nodes = self.nodes.iter().map(|(number, at)| Node { number: *number, at: *at, beta: 0.0 }).collect();
        Ok(DeckPiece { nodes, elements })
    }
}
