//! Axes of nodes that pieces share.

use super::project::{Matrices, Project};
use fem_io::deck::ImpactDeck;
use std::collections::BTreeMap;

/// What a turn about Z leaves as it is.
const UNTURNED: [&str; 2] = ["U30", "U33"];

/// Turns that differ by less are one, degrees.
const SAME: f64 = 1e-9;

/// A warning for each two substructures that share nodes whose axes have unlike BETA: unknowns are put together as they are, be
/// they components in other axes.
pub(super) fn unlike(deck: &ImpactDeck, project: &Project) -> Vec<String> {
    let mut turns: BTreeMap<&str, Vec<Option<f64>>> = BTreeMap::new();
    let mut seen: Vec<(usize, f64)> = vec![(usize::MAX, 0.0); deck.freedom.nodes.len()];
    let mut pairs: BTreeMap<[usize; 2], (usize, String)> = BTreeMap::new();
    for (number, placed) in deck.substructures.iter().enumerate() {
        let name = placed.name.value.as_str();
        let Some(matrices) = project.matrices(name) else { continue };
        let own = turns.entry(name).or_insert_with(|| turns_of(matrices, deck.freedom.directions.len()));
        for (node, turn) in placed.nodes.iter().zip(own) {
            let Some(turn) = *turn else { continue };
            let (first, other) = seen[*node];
            if first == usize::MAX {
                seen[*node] = (number, turn);
            } else if (turn - other).rem_euclid(360.0).min((other - turn).rem_euclid(360.0)) > SAME {
                let text = || format!("{} with BETA {other} and {turn}", deck.freedom.nodes[*node]);
                pairs.entry([first, number]).or_insert_with(|| (0, text())).0 += 1;
            }
        }
    }
    let warn = |([a, b], (count, node)): ([usize; 2], (usize, String))| {
        format!(
            "substructures {} and {} share node {node}, {count} such node{} in all: components in unlike axes are put together as if \
             they were the same; give the columns one BETA",
            a + 1,
            b + 1,
            if count == 1 { "" } else { "s" }
        )
    };
    pairs.into_iter().map(warn).collect()
}

/// BETA of the node behind each `per_node` masters; nothing where a turn would change none of them.
fn turns_of(matrices: &Matrices, per_node: usize) -> Vec<Option<f64>> {
    let Some(piece) = matrices.piece() else { return Vec::new() };
    let beta: BTreeMap<u32, f64> = piece.piece.nodes.iter().map(|node| (node.number, node.beta)).collect();
    let turn = |masters: &[(u32, String)]| {
        let turned = masters.iter().find(|(_, label)| !UNTURNED.contains(&label.as_str()))?;
        beta.get(&turned.0).copied()
    };
    matrices.masters.chunks(per_node).map(turn).collect()
}
