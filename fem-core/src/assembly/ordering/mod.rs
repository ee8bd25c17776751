//! In which order the unknowns of a plate are best eliminated.
//!
//! | step | where |
//! | --- | --- |
//! | unknowns to the vertices of a graph, and back | here |
//! | geometric nested dissection of a graph | `dissection` |
//! | the smallest separator at a cut | `cover` |

mod cover;
mod dissection;
#[cfg(test)]
mod tests;

use super::pattern::Cliques;
use crate::plates::plate::Plate;
use dissection::Graph;

/// Order in which the unknowns of `plate` are best eliminated: nested dissection of its nodes, across the plate and through
/// its thickness.
///
/// Unknowns of a node that the same cells have stay together: all of them where layers share their z-derivatives; of a node
/// between layers with z-derivatives of their own there are three such groups, those of the layer below, those of the layer
/// above and the rest, so that the rest alone separates two layers.
pub fn elimination_order(plate: &Plate) -> Vec<usize> {
    let alone: Vec<usize> = (0..plate.ndof()).collect();
    joined_order(plate, &alone, std::iter::empty())
}

/// The same where each unknown is one with that of number `joined`, and all of each set of `more` are coupled as those of a cell are.
pub(super) fn joined_order<'a>(plate: &Plate, joined: &[usize], more: impl Iterator<Item = &'a [usize]>) -> Vec<usize> {
    let symmetry = plate.symmetry();
    let (mut cliques, mut dofs) = (Cliques::default(), Vec::new());
    // Of unknowns that are one, as a symmetry makes them, one stands for all, with the neighbours of all.
    let stand_in = |dof: usize| {
        let column = plate.locate(dof).0;
        let first = |column: usize| plate.dofs_of_column(column).start;
        joined[first(symmetry.column(column as u32) as usize) + dof - first(column)]
    };
    for (cell, _) in plate.kept_cells() {
        plate.cell_dofs(cell, &mut dofs);
        dofs.iter_mut().for_each(|dof| *dof = stand_in(*dof));
        cliques.push(&dofs);
    }
    for set in more {
        dofs.clear();
        dofs.extend(set.iter().map(|dof| stand_in(*dof)));
        cliques.push(&dofs);
    }
    let mut order = order(plate, &cliques);
    let mut ordered = vec![false; plate.ndof()];
    order.iter().for_each(|dof| ordered[*dof] = true);
    order.extend((0..plate.ndof()).filter(|dof| !ordered[*dof]));
    order
}

/// Order in which the node columns of `plate` are best eliminated where all unknowns of a column are neighbours, as those of a
/// displacement that is linear in z are.
pub fn column_order(plate: &Plate) -> Vec<u32> {
    let symmetry = plate.symmetry();
    let mut cliques = Cliques::default();
    for (quad, _) in symmetry.quads() {
        let columns = plate.columns_of_quad(quad).iter().map(|column| symmetry.column(*column) as usize);
        cliques.push(&columns.collect::<Vec<_>>());
    }
    let places = plate.columns.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
    let (kept, tied): (Vec<u32>, _) = (0..plate.columns.len() as u32).partition(|c| symmetry.column(*c) == *c);
    let mut order = Graph::new(places, vec![1; plate.columns.len()], &cliques).dissect(kept);
    order.extend(tied);
    order
}

/// The unknowns of `plate` that are in `cliques`, in the order in which they are best eliminated.
pub(super) fn order(plate: &Plate, cliques: &Cliques) -> Vec<usize> {
    let (starts, of) = cliques.by_member(plate.ndof());
    let of = |dof: usize| &of[starts[dof] as usize..starts[dof + 1] as usize];
    // A vertex: the unknowns of a node that are in the same cliques.
    let mut unknowns: Vec<Vec<usize>> = Vec::new();
    let mut vertex_of = vec![0; plate.ndof()];
    let mut level_of = vec![0_u32; plate.ndof()];
    let (mut node, mut first) = (None, 0);
    for dof in (0..plate.ndof()).filter(|dof| !of(*dof).is_empty()) {
        let (column, level, _) = plate.locate(dof);
        if node.replace((column, level)) != Some((column, level)) {
            first = unknowns.len();
        }
        let alike = unknowns[first..].iter().position(|vertex| of(vertex[0]) == of(dof));
        let vertex = alike.map_or(unknowns.len(), |k| first + k);
        match unknowns.get_mut(vertex) {
            Some(others) => others.push(dof),
            None => unknowns.push(vec![dof]),
        }
        (vertex_of[dof], level_of[dof]) = (vertex, level as u32);
    }
    let mut ends = Vec::with_capacity(cliques.len());
    let mut between = Cliques::default();
    let mut vertices: Vec<usize> = Vec::new();
    for clique in cliques.iter() {
        let levels = clique.iter().map(|dof| level_of[*dof as usize]);
        ends.push([levels.clone().min().unwrap_or(0), levels.max().unwrap_or(0)]);
        vertices.clear();
        vertices.extend(clique.iter().map(|dof| vertex_of[*dof as usize]));
        vertices.sort_unstable();
        vertices.dedup();
        between.push(&vertices);
    }
    let place = |vertex: &Vec<usize>| {
        let [x, y] = plate.columns[plate.locate(vertex[0]).0];
        // Its height is that of what it is coupled to: that tells the z-derivatives of two layers in one node.
        let ends = || of(vertex[0]).iter().map(|clique| ends[*clique as usize]);
        let lowest = ends().map(|e| e[0]).min().unwrap_or(0);
        let highest = ends().map(|e| e[1]).max().unwrap_or(0);
        [x, y, f64::from(lowest + highest)]
    };
    let places = unknowns.iter().map(place).collect();
    let weights = unknowns.iter().map(|vertex| vertex.len() as u32).collect();
    let all = (0..unknowns.len() as u32).collect();
    let order = Graph::new(places, weights, &between).dissect(all);
    order.into_iter().flat_map(|vertex| std::mem::take(&mut unknowns[vertex as usize])).collect()
}
