//! Where nodes stand: columns over the plane mesh, and the nodes of a cell among them.

use super::PlateError;
use crate::contracts::element::{ElementInfo, Tables};
use crate::plates::mesh::PlaneMesh;
use crate::words::domain::{Corners, Domain};
use std::collections::HashMap;

/// Where an element has its nodes in cells of a shape.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub(super) info: ElementInfo,
    /// Of each node of the element: which of the quad's columns, and how many levels above the cell's lower face.
    pub(super) slots: Vec<(usize, usize)>,
    /// In-plane natural coordinates of a quad's columns.
    pub(super) places: Vec<[f64; 2]>,
}

impl Layout {
    pub(super) fn new(info: ElementInfo, pitch: usize) -> Self {
        let mut places: Vec<[f64; 2]> = Vec::new();
        let slots = info.nodes.iter().map(|&[r, s, q]| {
            let place = places.iter().position(|p| *p == [r, s]).unwrap_or_else(|| {
                places.push([r, s]);
                places.len() - 1
            });
            (place, ((q + 1.0) * 0.5 * pitch as f64) as usize)
        });
        Self { slots: slots.collect(), info, places }
    }
}

/// Columns over the places (r, s) of each quad.
pub(super) struct Columns {
    pub(super) positions: Vec<[f64; 2]>,
    /// Of each quad, from the place on that `starts` has for it.
    pub(super) of_quads: Vec<u32>,
    pub(super) starts: Vec<u32>,
    /// The vertices that columns on edges stand between.
    pub(super) edges: Vec<[u32; 2]>,
}

impl Columns {
    pub(super) fn of(plane: &PlaneMesh, layouts: &[Layout]) -> Self {
        let mut positions = plane.points.clone();
        let mut edges: Vec<[u32; 2]> = Vec::new();
        let mut numbers = HashMap::new();
        let middle = |of: &[u32]| -> [f64; 2] {
            std::array::from_fn(|d| of.iter().map(|v| plane.points[*v as usize][d]).sum::<f64>() / of.len() as f64)
        };
        let corners = |layout: &Layout| -> Vec<Vec<usize>> {
            layout.places.iter().map(|place| layout.info.domain.corners_around(*place)).collect()
        };
        let of_layouts: Vec<_> = layouts.iter().map(|layout| (layout.info.domain, corners(layout))).collect();
        let around = |quad: &Corners<u32>| {
            let own = of_layouts.iter().find(|(domain, _)| *domain == quad.domain());
            own.map_or(&[][..], |(_, around)| around)
        };
        for quad in &plane.quads {
            for ends in around(quad).iter().filter_map(|around| <[usize; 2]>::try_from(&around[..]).ok()) {
                let ends = ordered(ends.map(|i| quad[i]));
                numbers.entry(ends).or_insert_with(|| {
                    edges.push(ends);
                    let (straight, bend) = (middle(&ends), plane.bends.get(&ends));
                    positions.push(bend.map_or(straight, |bend| [0, 1].map(|d| straight[d] + bend[d])));
                    positions.len() as u32 - 1
                });
            }
        }
        let first_centre = positions.len() as u32;
        if of_layouts.iter().any(|(_, around)| around.iter().any(|around| around.len() > 2)) {
            positions.extend(plane.quads.iter().map(|quad| middle(quad)));
        }
        let (mut of_quads, mut starts) = (Vec::new(), vec![0]);
        for (q, quad) in plane.quads.iter().enumerate() {
            of_quads.extend(around(quad).iter().map(|around| match around[..] {
                [corner] => quad[corner],
                [a, b] => numbers[&ordered([quad[a], quad[b]])],
                _ => first_centre + q as u32,
            }));
            starts.push(of_quads.len() as u32);
        }
        Self { positions, of_quads, starts, edges }
    }
}

pub(super) fn ordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The tables for the shapes that the cells have, quadrilaterals first.
///
/// # Errors
/// A cell of a shape that there is none for.
pub(super) fn forms(plane: &PlaneMesh, tables: &Tables) -> Result<Vec<ElementInfo>, PlateError> {
    let mut found = Vec::new();
    for domain in [Domain::Quadrilateral, Domain::Triangle] {
        let Some(first) = plane.quads.iter().position(|corners| corners.domain() == domain) else { continue };
        found.push(*tables.on(domain).ok_or_else(|| PlateError::OtherShape {
            of_element: tables.cells(),
            quad_tag: plane.quad_tags[first],
            of_cell: domain.name(),
        })?);
    }
    Ok(if found.is_empty() { vec![tables.own] } else { found })
}
