//! Whether stacks, or elements, lie side by side without gaps and none over another.

use super::ElementCard;
use super::placing::SAME;
use crate::deck::reader::Reader;
use crate::deck::source::{DeckError, DeckPlace, Fault};
use fem_core::mesh::{FlawKind, PlaneMesh};

/// What the stacks of LAMSUB stand on.
pub(super) struct Ground<'a> {
    /// Position of each column, and where the deck says so.
    pub(super) columns: Vec<([f64; 2], &'a DeckPlace)>,
    /// Columns of each stack, from 0, and where the deck names them.
    pub(super) stacks: Vec<([usize; 4], DeckPlace)>,
}

impl Ground<'_> {
    /// Refuses stacks that overlap or are not joined where they touch; warns of those that nothing or a single column joins.
    ///
    /// # Errors
    /// The worst of what is wrong.
    pub(super) fn check(&self, reader: &mut Reader<'_>) -> Result<(), DeckError> {
        let mesh = PlaneMesh {
            points: self.columns.iter().map(|(at, _)| *at).collect(),
            quads: self.stacks.iter().map(|(stack, _)| stack.map(|column| column as u32).into()).collect(),
            node_tags: (1..=self.columns.len() as u64).collect(),
            quad_tags: (1..=self.stacks.len() as u64).collect(),
            ..PlaneMesh::default()
        };
        let column = |index: u32| self.columns[index as usize].1;
        let stack = |index: u32| &self.stacks[index as usize].1;
        let at = |place: &DeckPlace| reader.line_of(place);
        if let Some(flaw) = mesh.flaws(&[]).first() {
            let (place, found, help) = match flaw.kind {
                FlawKind::SameSide { cells: [a, b], .. } | FlawKind::Overlap { cells: [a, b] } => (
                    stack(b),
                    format!("stack {} lies over stack {} (line {})", b + 1, a + 1, at(stack(a))),
                    "name each stack once, and stacks beside each other by the columns that both have",
                ),
                FlawKind::Hanging { node, cell, side } => (
                    column(node),
                    format!(
                        "column {} lies on the side of stack {} (line {}) between its columns {} and {}, and is not joined to it",
                        node + 1,
                        cell + 1,
                        at(stack(cell)),
                        side[0] + 1,
                        side[1] + 1
                    ),
                    "let stacks beside each other have whole sides in common: divide that one there",
                ),
                FlawKind::Doubled { nodes: [a, b] } => (
                    column(b),
                    format!(
                        "column {} lies where column {} (line {}) does: nothing joins them",
                        b + 1,
                        a + 1,
                        at(column(a))
                    ),
                    "name one column in all stacks that meet there",
                ),
                FlawKind::Pinched { node } => {
                    let text =
                        format!("stacks have no more than column {} in common: the plate is a hinge there", node + 1);
                    reader.warn(column(node), &text);
                    return Ok(());
                }
            };
            return reader.error(place, Fault::Geometry, found, help);
        }
        let pieces = mesh.pieces();
        if let Some(other) = pieces.iter().position(|piece| *piece != pieces[0]) {
            reader.warn(&self.stacks[other].1, &format!("nothing joins stack {} to the first", other + 1));
        }
        Ok(())
    }
}

/// Elements of LAMCEL, as boxes along the axes.
pub(super) struct Box3 {
    low: [f64; 3],
    high: [f64; 3],
    nodes: Vec<usize>,
}

impl Box3 {
    pub(super) fn new(card: &ElementCard, [bottom, top]: [f64; 2]) -> Self {
        let [[x0, y0], _, [x1, y1], _] = card.plane;
        Self { low: [x0, y0, bottom], high: [x1, y1, top], nodes: card.nodes.clone() }
    }

    /// What counts as nothing along X, Y, Z.
    fn tolerance(&self, k: usize) -> f64 {
        SAME * (self.high[k] - self.low[k])
    }

    /// Whether two have more than a face in common.
    fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|k| {
            let common = self.high[k].min(other.high[k]) - self.low[k].max(other.low[k]);
            common > self.tolerance(k).max(other.tolerance(k))
        })
    }

    fn holds(&self, at: &[f64; 3]) -> bool {
        (0..3).all(|k| {
            let tolerance = self.tolerance(k);
            self.low[k] - tolerance <= at[k] && at[k] <= self.high[k] + tolerance
        })
    }
}

/// What is wrong with elements of LAMCEL.
#[derive(Debug, PartialEq)]
pub(super) enum Misfit {
    /// Two lie over each other.
    Overlap([usize; 2]),
    /// A node lies on an element that it is no corner of.
    Hanging { node: usize, element: usize },
}

/// The first misfit of `elements`, whose nodes lie at `nodes`: neighbours are searched for along X.
pub(super) fn misfit(elements: &[Box3], nodes: &[[f64; 3]]) -> Option<Misfit> {
    let mut order: Vec<usize> = (0..elements.len()).collect();
    order.sort_by(|a, b| elements[*a].low[0].total_cmp(&elements[*b].low[0]));
    for (i, a) in order.iter().enumerate() {
        let near = order[i + 1..].iter().take_while(|b| elements[**b].low[0] < elements[*a].high[0]);
        if let Some(b) = near.copied().find(|b| elements[*a].overlaps(&elements[*b])) {
            return Some(Misfit::Overlap([*a.min(&b), *a.max(&b)]));
        }
    }
    let mut along: Vec<usize> = (0..nodes.len()).collect();
    along.sort_by(|a, b| nodes[*a][0].total_cmp(&nodes[*b][0]));
    for (number, element) in elements.iter().enumerate() {
        let from = along.partition_point(|node| nodes[*node][0] < element.low[0] - element.tolerance(0));
        let near = along[from..].iter().take_while(|node| nodes[**node][0] <= element.high[0] + element.tolerance(0));
        let mut strangers = near.filter(|node| !element.nodes.contains(node));
        if let Some(node) = strangers.find(|node| element.holds(&nodes[**node])) {
            return Some(Misfit::Hanging { node: *node, element: number });
        }
    }
    None
}
