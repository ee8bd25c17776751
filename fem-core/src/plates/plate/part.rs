//! Some of the cells of a plate as a plate of their own.

use super::seams::Seams;
use super::{Columns, Plate};
use crate::plates::mesh::{Group, PlaneMesh};
use std::collections::BTreeMap;

impl Plate {
    /// The cells over `quads`, of which each stands for as many as here, and which unknown of this plate each of its unknowns is. Vertices and cells keep their order, so
    /// that equal parts of a regular mesh have equal numbers.
    pub fn part(&self, quads: &[u32]) -> (Self, Vec<usize>) {
        let whole = &self.plane;
        let mut vertices: Vec<u32> = quads.iter().flat_map(|q| whole.quads[*q as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let number = |vertex: u32| vertices.partition_point(|v| *v < vertex) as u32;
        let is_own = |end: &u32| vertices.binary_search(end).is_ok();
        let own = whole.bends.iter().filter(|(ends, _)| ends.iter().all(is_own));
        let bends = own.map(|(ends, bend)| (ends.map(number), *bend));
        let plane = PlaneMesh {
            points: vertices.iter().map(|v| whole.points[*v as usize]).collect(),
            quads: quads.iter().map(|q| whole.quads[*q as usize].map(number)).collect(),
            groups: BTreeMap::new(),
            node_tags: vertices.iter().map(|v| whole.node_tags[*v as usize]).collect(),
            quad_tags: quads.iter().map(|q| whole.quad_tags[*q as usize]).collect(),
            bends: bends.collect(),
        };
        let Columns { positions: columns, of_quads: quad_columns, starts, edges } = Columns::of(&plane, &self.layouts);
        let mut part = Self {
            symmetry: self.symmetry.part(columns.len(), quads),
            plane,
            columns,
            levels: self.levels.clone(),
            regions: self.regions.clone(),
            region_of: quads.iter().map(|q| self.region_of[*q as usize]).collect(),
            layouts: self.layouts.clone(),
            z_derivatives: self.z_derivatives,
            quad_columns,
            starts,
            edges,
            pitch: self.pitch,
            offsets: Vec::new(),
            separable: Vec::new(),
            seams: Seams::default(),
        };
        let mut columns_of_whole = vec![None; part.columns.len()];
        for (own, quad) in quads.iter().enumerate() {
            let both = part.columns_of_quad(own).iter().zip(self.columns_of_quad(*quad as usize));
            both.for_each(|(own, whole)| columns_of_whole[*own as usize] = Some(*whole as usize));
        }
        part.seams = self.seams.of_part(&columns_of_whole);
        part.number();
        let mut unknowns = vec![0; part.ndof()];
        let (mut own, mut of_whole) = (Vec::new(), Vec::new());
        for cell in part.cell_numbers() {
            let (quad, layer) = part.place(cell);
            part.cell_dofs(cell, &mut own);
            self.cell_dofs(self.cell_over(quads[quad] as usize, layer), &mut of_whole);
            own.iter().zip(&of_whole).for_each(|(own, whole)| unknowns[*own] = *whole);
        }
        (part, unknowns)
    }

    /// Columns on edges that a single quad has, ascending.
    pub fn outline(&self) -> Vec<u32> {
        let edges = self.plane.boundary();
        let nodes = edges.iter().flatten().copied().collect();
        self.columns_of_group(&Group { dim: 1, nodes, edges, quads: Vec::new() })
    }
}
