#![allow(clippy::unwrap_used)]

use super::cover::Shores;
use super::*;
use crate::assembly::{Pattern, pattern};
use crate::contracts::element::{ElementInfo, Slice, Stack};
use crate::plates::constraint::Constraints;
use crate::plates::mesh::PlaneMesh;
use crate::plates::plate::ZDerivatives;
use crate::words::dof::Dof;
use crate::words::domain::Domain;
use faer::Side;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{CholeskySymbolicParams, SymmetricOrdering, factorize_symbolic_cholesky};

/// Numbers that look random, each less than `below`.
fn numbers() -> impl FnMut(u64) -> u64 {
    let mut state = 7_u64;
    move |below| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    }
}

/// Two shores with random weights and links: no set of less weight touches every link.
#[test]
fn covers_are_smallest() {
    let mut random = numbers();
    for _ in 0..500 {
        let sizes = [1 + random(6) as usize, 1 + random(6) as usize];
        let weights = sizes.map(|size| (0..size).map(|_| 1 + random(9) as u32).collect::<Vec<u32>>());
        let links: Vec<Vec<u32>> =
            (0..sizes[0]).map(|_| (0..sizes[1] as u32).filter(|_| random(3) == 0).collect()).collect();
        let covers = |chosen: &dyn Fn(usize, usize) -> bool| {
            let mut all = links.iter().enumerate().flat_map(|(l, links)| links.iter().map(move |r| (l, *r as usize)));
            all.all(|(l, r)| chosen(0, l) || chosen(1, r))
        };
        let weight = |chosen: &dyn Fn(usize, usize) -> bool| -> u32 {
            let all = (0..2).flat_map(|side| (0..sizes[side]).map(move |k| (side, k)));
            all.filter(|(side, k)| chosen(*side, *k)).map(|(side, k)| weights[side][k]).sum()
        };
        let shores = Shores::new(&links, weights.clone());
        let bound = shores.bound();
        let found = shores.cover();
        let found = |side: usize, k: usize| found[side][k];
        assert!(covers(&found));
        let bit = |set: u32| move |side: usize, k: usize| set >> (side * sizes[0] + k) & 1 == 1;
        let least = (0..1_u32 << (sizes[0] + sizes[1])).filter(|set| covers(&bit(*set))).map(|set| weight(&bit(set)));
        let least = least.min().unwrap();
        assert_eq!(weight(&found), least);
        assert!(bound <= least);
    }
}

/// Any graph anywhere in space, its separators no clique between the halves: all of the set, once.
#[test]
fn every_vertex_is_ordered_once() {
    let mut random = numbers();
    for round in 0..200 {
        let n = 1 + random(60) as usize;
        // Places of few different values, and cliques that no place explains.
        let places = (0..n).map(|_| [random(4) as f64, random(1 + round) as f64, random(2) as f64]).collect();
        let mut cliques = Cliques::default();
        for _ in 0..random(40) {
            let mut clique: Vec<usize> = (0..1 + random(6)).map(|_| random(n as u64) as usize).collect();
            clique.sort_unstable();
            clique.dedup();
            cliques.push(&clique);
        }
        let weights = (0..n).map(|_| 1 + random(15) as u32).collect();
        let mut order = Graph::new(places, weights, &cliques).dissect((0..n as u32).collect());
        order.sort_unstable();
        assert_eq!(order, (0..n as u32).collect::<Vec<_>>());
    }
}

const NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
const INFO: ElementInfo =
    ElementInfo { domain: Domain::Quadrilateral, nodes: &NODES, dofs: &Dof::SOLID, in_plane_order: 2, ply_order: 2 };

/// Cells of unequal size, so that no two lines of nodes are alike.
fn plate(cells: [usize; 2], layers: usize, z_derivatives: ZDerivatives) -> Plate {
    let lines = |n: usize| -> Vec<f64> { (0..=n).map(|i| i as f64 + 0.3 * (1.7 * i as f64).sin()).collect() };
    let slices = || vec![Slice { q: [-1.0, 1.0], c: [[0.0; 6]; 6], density: 1.0, free: [0.0; 6] }];
    let stacks = (0..layers).map(|_| Stack::new(slices())).collect();
    let faces = (0..=layers).map(|face| face as f64).collect();
    Plate::new(PlaneMesh::rectangle(&lines(cells[0]), &lines(cells[1])), faces, stacks, INFO, z_derivatives).unwrap()
}

#[test]
fn unknowns_that_the_same_cells_have_stay_together() {
    for (z_derivatives, between_layers) in [(ZDerivatives::Shared, 1), (ZDerivatives::LayerWise, 3)] {
        let plate = plate([5, 4], 3, z_derivatives);
        let order = elimination_order(&plate);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..plate.ndof()).collect::<Vec<_>>());
        let mut runs = vec![0; plate.columns.len() * plate.levels.len()];
        let node = |dof: &usize| plate.locate(*dof).0 * plate.levels.len() + plate.locate(*dof).1;
        order.chunk_by(|a, b| node(a) == node(b)).for_each(|run| runs[node(&run[0])] += 1);
        for (node, runs) in runs.into_iter().enumerate() {
            let most = if [1, 2].contains(&(node % plate.levels.len())) { between_layers } else { 1 };
            assert!(runs <= most, "node {node} is in {runs} pieces");
        }
    }
}

/// Against minimum degree on the unknowns, by faer (Amestoy, Davis, Duff 1996): entries of the factor by faer's own count.
#[test]
fn factors_are_as_small_as_by_minimum_degree_and_far_smaller_in_thick_plates() {
    for (cells, layers, most) in
        [([24, 12], 1, 1.06), ([12, 12], 2, 1.01), ([10, 10], 4, 0.85), ([8, 6], 8, 0.88), ([3, 3], 12, 1.1)]
    {
        let plate = plate(cells, layers, ZDerivatives::LayerWise);
        let order = elimination_order(&plate);
        let pattern = pattern(&plate, &Constraints::none(&order));
        let own: Vec<usize> = (0..plate.ndof()).collect();
        let own = entries(&pattern, SymmetricOrdering::Custom(PermRef::new_checked(&own, &own, own.len())));
        let amd = entries(&pattern, SymmetricOrdering::Amd);
        let ratio = own as f64 / amd as f64;
        assert!(ratio < most, "{cells:?} cells in {layers} layers: {own} entries, {amd} by minimum degree, {ratio}");
    }
}

fn entries(pattern: &Pattern, order: SymmetricOrdering<'_, usize>) -> usize {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
        ..Default::default()
    };
    factorize_symbolic_cholesky(pattern.symbolic(), Side::Lower, order, params).unwrap().len_val()
}
