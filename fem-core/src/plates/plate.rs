//! A plate of cells: a plane mesh extruded through the layers of a laminate, and the numbers of its unknowns.

mod layout;
mod part;
mod region;
mod seams;
mod separation;

use crate::contracts::element::{Cell, ElementInfo, Stack, Tables};
use crate::plates::laminate::SAME_HEIGHT;
use crate::plates::mesh::{Group, PlaneMesh};
use crate::plates::symmetry::{self, Symmetry};
use crate::words::dof::Dof;
use layout::{Columns, Layout, forms, ordered};
use region::Region;
use seams::{Seams, jumps};
use std::fmt::Write;

pub use separation::{CLOSED, FaceUnknowns};

pub use crate::plates::error::{Asymmetry, PlateError};

/// How the layers of cells share the derivatives along z at the faces between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ZDerivatives {
    /// One set for both layers (the report): u,z is continuous, which a jump of stiffness contradicts.
    Shared,
    /// Each layer its own: only what must be continuous is.
    LayerWise,
}

/// Cells `quad × layer`, nodes `column × level`, unknowns node by node.
///
/// * columns: the vertices of the plane mesh, then, where the element has nodes there, the middles of its edges and of
///   its quads
/// * levels: the faces of the layers from the bottom, and their middles where the element has nodes there
/// * node number: `column · levels + level`; the element's table says which of them exist, the others have no unknowns
/// * cell number: `quad · layers + layer`; where regions differ in thickness, layers of the plate that a region does not reach have no
///   cells there, and layers of a region count from its own bottom
/// * unknowns of a node: those of the element in its order; with layer-wise z-derivatives a node between layers has a
///   second set of its `Un3`, which belongs to the cells above it; where the layers may [separate](Plate::separate), of all its
///   unknowns; one between two regions whose [strains jump](Plate::let_strains_jump) has a last set of its `Un1` and `Un2`, which
///   belongs to the cells of the region of higher number
#[derive(Debug, Clone)]
pub struct Plate {
    /// The plane mesh.
    pub plane: PlaneMesh,
    /// Positions of the columns, m.
    pub columns: Vec<[f64; 2]>,
    /// z of the levels, m.
    pub levels: Vec<f64>,
    regions: Vec<Region>,
    /// Region of each quad.
    region_of: Vec<u16>,
    /// Of each shape of its cells, quadrilaterals first.
    layouts: Vec<Layout>,
    z_derivatives: ZDerivatives,
    /// Columns of each quad, from the place on that `starts` has for it.
    quad_columns: Vec<u32>,
    starts: Vec<u32>,
    /// The two vertices that an edge column stands between, from column `points` on.
    edges: Vec<[u32; 2]>,
    /// Levels per layer of cells: 1, or 2 with nodes at mid-height.
    pitch: usize,
    /// First unknown of each node, and the total at the end.
    offsets: Vec<usize>,
    symmetry: Symmetry,
    /// By node, whether the layers above and below may separate there; empty where they may nowhere.
    separable: Vec<bool>,
    seams: Seams,
}

impl Plate {
    /// Extrudes `plane` through the faces at heights `faces`, one stack of plies between two of them.
    ///
    /// # Errors
    /// A mesh or layers that do not fit the element.
    pub fn new(
        mut plane: PlaneMesh,
        faces: Vec<f64>,
        stacks: Vec<Stack>,
        tables: impl Into<Tables>,
        z_derivatives: ZDerivatives,
    ) -> Result<Self, PlateError> {
        let tables = tables.into();
        let info = tables.own;
        if !info.nodes.iter().flatten().all(|c| [-1.0, 0.0, 1.0].contains(c)) {
            return Err(PlateError::NodeOffGrid);
        }
        let forms = forms(&plane, &tables)?;
        if info.is_shell() && stacks.len() != 1 {
            return Err(PlateError::LayersOfShell);
        }
        if info.is_section() {
            along_x(&mut plane)?;
        }
        let pitch = if info.nodes.iter().any(|n| n[2] == 0.0) { 2 } else { 1 };
        let layouts: Vec<Layout> = forms.into_iter().map(|info| Layout::new(info, pitch)).collect();
        let Columns { positions: columns, of_quads: quad_columns, starts, edges } = Columns::of(&plane, &layouts);
        let mut plate = Self {
            symmetry: Symmetry::none(columns.len(), plane.quads.len()),
            region_of: vec![0; plane.quads.len()],
            plane,
            columns,
            levels: Vec::new(),
            regions: vec![Region::new(faces, stacks)?],
            layouts,
            z_derivatives,
            quad_columns,
            starts,
            edges,
            pitch,
            offsets: Vec::new(),
            separable: Vec::new(),
            seams: Seams::default(),
        };
        plate.stack_up()?;
        plate.number();
        Ok(plate)
    }

    fn number(&mut self) {
        let inner = match self.z_derivatives {
            ZDerivatives::Shared => 0,
            ZDerivatives::LayerWise => self.info().dofs.iter().filter(|d| d.m() == 3).count(),
        };
        // How often a node is in a cell's lower half and upper half: both, where it lies between layers.
        let mut below = vec![false; self.columns.len() * self.levels.len()];
        let mut above = below.clone();
        let mut seams = std::mem::take(&mut self.seams);
        seams.clear();
        for cell in self.cell_numbers() {
            let quad = self.place(cell).0;
            for (i, (_, up)) in self.layout(quad).slots.iter().enumerate() {
                let node = self.cell_node(cell, i);
                let at = if *up == 0 { &mut above } else { &mut below };
                at[node] = true;
                seams.meet(node, node / self.levels.len(), self.region(quad));
            }
        }
        seams.settle(|node| self.is_separable(node));
        self.seams = seams;
        let mut next = 0;
        self.offsets = Vec::with_capacity(below.len() + 1);
        self.offsets.push(0);
        let nd = self.info().dofs.len();
        for (node, (below, above)) in below.into_iter().zip(above).enumerate() {
            next += if below || above { nd } else { 0 };
            next += match below && above {
                true if self.is_separable(node) => nd,
                true => inner,
                false => 0,
            };
            next += self.last_set(node).count();
            self.offsets.push(next);
        }
    }

    /// Folds the plate by a symmetry: matrices then are those of its symmetric motions, which
    /// [`Symmetry::equations`] must be among the constraints to make.
    ///
    /// # Errors
    /// A mesh that is not symmetric.
    pub fn fold(&mut self, group: symmetry::SymmetryGroup) -> Result<(), PlateError> {
        self.symmetry = Symmetry::of(group, self)?;
        Ok(())
    }

    /// How the plate is folded.
    pub fn symmetry(&self) -> &Symmetry {
        &self.symmetry
    }

    /// Number of unknowns before constraints.
    pub fn ndof(&self) -> usize {
        self.offsets[self.offsets.len() - 1]
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.offsets.windows(2).filter(|o| o[1] > o[0]).count()
    }

    /// The element's table; where there are quadrilaterals and triangles, the one for quadrilaterals. Unknowns and the heights of
    /// nodes are the same in both.
    pub fn info(&self) -> &ElementInfo {
        &self.layouts[0].info
    }

    /// The element's table for the shape of a quad.
    pub fn info_of(&self, quad: usize) -> &ElementInfo {
        &self.layout(quad).info
    }

    /// Most unknowns that a cell has.
    pub fn most_unknowns(&self) -> usize {
        self.layouts.iter().map(|layout| layout.info.ndof()).fold(0, usize::max)
    }

    fn layout(&self, quad: usize) -> &Layout {
        let domain = self.plane.quads[quad].domain();
        let own = self.layouts.iter().find(|layout| layout.info.domain == domain);
        own.unwrap_or(&self.layouts[0])
    }

    /// Columns of a quad.
    pub fn columns_of_quad(&self, quad: usize) -> &[u32] {
        &self.quad_columns[self.starts[quad] as usize..self.starts[quad + 1] as usize]
    }

    /// Columns with nodes of a group: its vertices, and the middles of its edges and quads.
    pub fn columns_of_group(&self, group: &Group) -> Vec<u32> {
        let vertices = self.plane.points.len() as u32;
        let mut found: Vec<u32> = group.nodes.iter().copied().filter(|c| self.exists(*c as usize)).collect();
        let own: std::collections::HashSet<[u32; 2]> = group.edges.iter().map(|e| ordered(*e)).collect();
        found.extend((0..self.edges.len()).filter(|e| own.contains(&self.edges[*e])).map(|e| vertices + e as u32));
        let inner = group.quads.iter().flat_map(|q| self.columns_of_quad(*q as usize));
        found.extend(inner.filter(|c| **c >= vertices));
        found.sort_unstable();
        found.dedup();
        found
    }

    fn exists(&self, column: usize) -> bool {
        !self.dofs_of_column(column).is_empty()
    }

    fn node(&self, column: usize, level: usize) -> usize {
        column * self.levels.len() + level
    }

    fn cell_node(&self, cell: usize, i: usize) -> usize {
        let (quad, layer) = (cell / self.layers(), cell % self.layers());
        let (place, up) = self.layout(quad).slots[i];
        self.node(self.columns_of_quad(quad)[place] as usize, layer * self.pitch + up)
    }

    /// A cell as an element sees it.
    pub fn cell(&self, cell: usize) -> Cell<'_> {
        let quad = cell / self.layers();
        Cell { corners: self.plane.cell(quad), z: self.faces_of(cell), stack: self.stack(cell) }
    }

    /// Unknowns of a cell, in element order.
    pub fn cell_dofs(&self, cell: usize, out: &mut Vec<usize>) {
        out.clear();
        let dofs = self.info().dofs;
        let nd = dofs.len();
        let quad = self.place(cell).0;
        for (i, (_, up)) in self.layout(quad).slots.iter().enumerate() {
            let node = self.cell_node(cell, i);
            let [first, last, end] = self.sets(node);
            // The second set of a node between layers serves the cells above it, the last one those of the later region.
            let upper = *up == 0 && last - first > nd;
            let later = last < end && self.seams.is_later(node / self.levels.len(), self.region(quad));
            let whole = self.is_separable(node);
            let (mut second, mut third) = (first + nd, last);
            for (k, dof) in dofs.iter().enumerate() {
                if later && jumps(dof, self.info().is_shell()) {
                    out.push(third);
                    third += 1;
                } else if upper && (whole || dof.m() == 3) {
                    out.push(second);
                    second += 1;
                } else {
                    out.push(first + k);
                }
            }
        }
    }

    /// All unknowns called `dof` at a node: none if there is no node or the element lacks it, two where layers or regions have their
    /// own.
    pub fn dofs_at(&self, column: usize, level: usize, dof: Dof) -> impl Iterator<Item = usize> + use<> {
        let node = self.node(column, level);
        let [first, last, end] = self.sets(node);
        let nd = self.info().dofs.len();
        let own = self.info().dofs.iter().position(|d| *d == dof).map(|k| first + k);
        let second = self.second_set(node).position(|d| *d == dof).map(|k| first + nd + k);
        let third = self.last_set(node).position(|d| *d == dof).map(|k| last + k);
        own.into_iter().chain(second).filter(move |i| *i < last).chain(third).filter(move |i| *i < end)
    }

    /// Where the unknowns of a node begin, its last set, and those of the next node.
    fn sets(&self, node: usize) -> [usize; 3] {
        let [first, end] = [self.offsets[node], self.offsets[node + 1]];
        [first, end - self.last_set(node).count(), end]
    }

    /// Unknowns of the nodes of a column, from the bottom.
    pub fn dofs_of_column(&self, column: usize) -> std::ops::Range<usize> {
        self.offsets[self.node(column, 0)]..self.offsets[self.node(column + 1, 0)]
    }

    /// Lowest and highest level with nodes at a column: the faces of the plate there, or the reference surface of a shell.
    pub fn outer_levels(&self, column: usize) -> [usize; 2] {
        let nodes = &self.offsets[self.node(column, 0)..=self.node(column + 1, 0)];
        let holds = |pair: &[usize]| pair[1] > pair[0];
        let first = nodes.windows(2).position(holds).unwrap_or(0);
        [first, nodes.windows(2).rposition(holds).unwrap_or(first)]
    }

    /// Level whose z is 0, if there is one: the mid-plane of the laminate from which heights count.
    pub fn mid_level(&self) -> Option<usize> {
        let h = self.levels[self.levels.len() - 1] - self.levels[0];
        self.levels.iter().position(|z| z.abs() < SAME_HEIGHT * h)
    }

    /// That level, or where a column has no node there its lowest.
    pub fn reference_level(&self, column: usize) -> usize {
        let [low, high] = self.outer_levels(column);
        self.mid_level().filter(|level| (low..=high).contains(level)).unwrap_or(low)
    }

    /// Column, level and name of an unknown.
    pub fn locate(&self, dof: usize) -> (usize, usize, Dof) {
        let node = self.offsets.partition_point(|o| *o <= dof) - 1;
        let [first, last, _] = self.sets(node);
        let (dofs, k) = (self.info().dofs, dof - first);
        let name = match dof.checked_sub(last) {
            Some(k) => self.last_set(node).nth(k),
            None => dofs.get(k).or_else(|| self.second_set(node).nth(k - dofs.len())),
        };
        let name = name.copied().unwrap_or(dofs[0]);
        (node / self.levels.len(), node % self.levels.len(), name)
    }

    /// The vertices that a column on a side stands between.
    pub fn ends(&self, column: usize) -> Option<[u32; 2]> {
        self.edges.get(column.checked_sub(self.plane.points.len())?).copied()
    }

    /// "node 17", "the middle of nodes 17 and 18", "the middle of cell 5": numbers of the mesh file.
    pub fn describe_column(&self, column: usize) -> String {
        let vertices = self.plane.points.len();
        let tag = |v: u32| self.plane.node_tags[v as usize];
        if column < vertices {
            return format!("node {}", self.plane.node_tags[column]);
        }
        match self.ends(column) {
            Some([a, b]) => format!("the middle of nodes {} and {}", tag(a), tag(b)),
            None => format!("the middle of cell {}", self.plane.quad_tags[column - vertices - self.edges.len()]),
        }
    }

    /// "U30 at node 17 (x, y, z in mm)".
    pub fn describe(&self, dof: usize) -> String {
        let (column, level, name) = self.locate(dof);
        let [x, y] = self.columns[column];
        let mut text = format!("{name} at {}", self.describe_column(column));
        let _ = write!(text, " ({:.6}, {:.6}, {:.6}) mm", x * 1e3, y * 1e3, self.levels[level] * 1e3);
        text
    }

    /// Whether layers share their z-derivatives.
    pub fn z_derivatives(&self) -> ZDerivatives {
        self.z_derivatives
    }

    /// Value of an unknown under the six rigid motions of unit size: translation along x, y, z, and rotation about x, y, z
    /// through `centre` by the angle 1/`length`, which moves a point at the distance `length` by 1.
    pub fn rigid_motions(&self, dof: usize, centre: [f64; 3], length: f64) -> [f64; 6] {
        let (column, level, name) = self.locate(dof);
        let [x, y] = self.columns[column];
        let p = [x - centre[0], y - centre[1], self.levels[level] - centre[2]];
        let n = name.n() - 1;
        let mut values = [0.0; 6];
        if name.m() == 0 {
            values[n] = 1.0;
        }
        for (axis, value) in values[3..].iter_mut().enumerate() {
            // u = e(axis) × p; ∂u/∂x(m) = e(axis) × e(m)
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            *value = match name.m() {
                0 if n == j => -p[k] / length,
                0 if n == k => p[j] / length,
                m if m > 0 && n == j && m - 1 == k => -1.0 / length,
                m if m > 0 && n == k && m - 1 == j => 1.0 / length,
                _ => 0.0,
            };
        }
        values
    }
}

/// Turns the quads of a strip so that their r runs along x.
///
/// # Errors
/// A mesh that is not a strip of rectangles along x, one cell across.
fn along_x(plane: &mut PlaneMesh) -> Result<(), PlateError> {
    let (low, high) = plane.bounds();
    let width = high[1] - low[1];
    for q in 0..plane.quads.len() {
        let p = plane.corners(q).four();
        let turn = (0..4).find(|i| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| p[(i + k) % 4]);
            let near = |u: f64, v: f64| (u - v).abs() <= 1e-9 * width;
            near(a[1], low[1])
                && near(b[1], low[1])
                && near(c[1], high[1])
                && near(d[1], high[1])
                && near(a[0], d[0])
                && near(b[0], c[0])
                && b[0] > a[0]
        });
        match turn {
            Some(turn) => plane.quads[q].rotate_left(turn),
            None => return Err(PlateError::NoStrip { quad_tag: plane.quad_tags[q] }),
        }
    }
    Ok(())
}
