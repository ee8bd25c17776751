//! Whether the pieces of a model fit each other where they share nodes.

use super::project::{Matrices, Project};
use fem_io::deck::ImpactDeck;
use std::collections::BTreeMap;

/// Places that differ by less than this part of the size of a piece are one.
const SAME: f64 = 1e-6;

/// A warning for each piece that stands on the nodes of another one, or that puts a node elsewhere than those before it do, or where
/// another node lies: pieces are put together as they were made, shifted and not turned. Nothing of pieces whose axes are turned,
/// which fit in other ways.
pub(super) fn misfits(deck: &ImpactDeck, project: &Project) -> Vec<String> {
    let nodes = &deck.freedom.nodes;
    let mut made: BTreeMap<&str, Vec<[f64; 3]>> = BTreeMap::new();
    for placed in &deck.substructures {
        let name = placed.name.value.as_str();
        let Some(matrices) = project.matrices(name) else { continue };
        made.entry(name).or_insert_with(|| places(matrices, deck.freedom.directions.len()));
    }
    let mut warnings = Vec::new();
    let mut on: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
    let mut known: BTreeMap<usize, ([f64; 3], usize)> = BTreeMap::new();
    let mut left: Vec<usize> = (0..deck.substructures.len()).collect();
    while !left.is_empty() {
        // One that hangs on what is placed; otherwise the first, which begins a part of its own.
        let hangs = |number: &usize| deck.substructures[*number].nodes.iter().any(|node| known.contains_key(node));
        let number = left.remove(left.iter().position(hangs).unwrap_or(0));
        let placed = &deck.substructures[number];
        let mut sorted = placed.nodes.clone();
        sorted.sort_unstable();
        if let Some(other) = on.insert(sorted, number) {
            let [one, two] = [other.min(number) + 1, other.max(number) + 1];
            warnings.push(format!("substructures {one} and {two} stand on the same nodes: both count"));
            continue;
        }
        let Some(own) = made.get(placed.name.value.as_str()).filter(|own| own.len() == placed.nodes.len()) else {
            continue;
        };
        let shared = || placed.nodes.iter().zip(own).filter_map(|(node, at)| Some((*node, at, known.get(node)?)));
        let shift = shared().next().map_or([0.0; 3], |(_, at, (there, _))| [0, 1, 2].map(|k| there[k] - at[k]));
        let here = |at: &[f64; 3]| [0, 1, 2].map(|k| at[k] + shift[k]);
        let tolerance = SAME * size(own);
        let apart = |a: &[f64; 3], b: &[f64; 3]| (0..3).any(|k| (a[k] - b[k]).abs() > tolerance);
        if let Some((node, at, (there, other))) = shared().find(|(_, at, (there, _))| apart(&here(at), there)) {
            let [at, there] = [here(at), *there].map(|p| format!("({:.6}, {:.6}, {:.6})", p[0], p[1], p[2]));
            warnings.push(format!(
                "substructure {} does not fit: with the first node that it shares in its place, node {} is at {at}, and substructure {} \
                 has it at {there}; look at the order of the nodes of both",
                number + 1,
                nodes[node],
                other + 1
            ));
            continue;
        }
        let settled: Vec<_> = placed.nodes.iter().zip(own).map(|(node, at)| (*node, (here(at), number))).collect();
        let meets = |(node, (at, _)): &(usize, ([f64; 3], usize))| {
            let (other, _) = known.iter().find(|(other, (there, _))| *other != node && !apart(at, there))?;
            Some([nodes[*other], nodes[*node]])
        };
        if let Some([one, two]) = settled.iter().find_map(meets) {
            warnings.push(format!(
                "substructure {} puts node {two} where node {one} lies, and nothing joins the two: look at the order of its nodes, \
                 unless the plate is cut there",
                number + 1
            ));
        }
        for (node, at) in settled {
            known.entry(node).or_insert(at);
        }
    }
    warnings
}

/// Largest extent of some places.
fn size(places: &[[f64; 3]]) -> f64 {
    let of = |k: usize| places.iter().fold([f64::MAX, f64::MIN], |[low, high], p| [low.min(p[k]), high.max(p[k])]);
    (0..3).map(of).map(|[low, high]| high - low).fold(0.0, f64::max)
}

/// Place of the node behind each `per_node` masters; nothing of a piece whose axes are turned, or whose masters are not so many
/// a node.
fn places(matrices: &Matrices, per_node: usize) -> Vec<[f64; 3]> {
    let Some(piece) = matrices.piece() else { return Vec::new() };
    if piece.piece.nodes.iter().any(|node| node.beta != 0.0) {
        return Vec::new();
    }
    let at: BTreeMap<u32, [f64; 3]> = piece.piece.nodes.iter().map(|node| (node.number, node.at)).collect();
    let place = |masters: &[(u32, String)]| {
        let (node, _) = masters.first()?;
        masters.iter().all(|(other, _)| other == node).then(|| at.get(node).copied())?
    };
    matrices.masters.chunks(per_node).map(place).collect::<Option<_>>().unwrap_or_default()
}
