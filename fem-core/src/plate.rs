//! A plate of solid cells: a plane mesh extruded through the layers of a laminate, and the numbers of its unknowns.

use crate::dof::Dof;
use crate::element::{ElementInfo, Stack};
use crate::mesh::QuadMesh;
use std::fmt::Write;

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
/// * node number: `column · levels + level`, levels from the bottom
/// * cell number: `quad · layers + layer`
/// * unknowns of a node: those of the element in its order; with layer-wise z-derivatives an inner node has a second
///   set of its `Un3`, which belongs to the cells above it
#[derive(Debug, Clone)]
pub struct Plate {
    /// The plane mesh.
    pub plane: QuadMesh,
    /// z of the levels, m.
    pub levels: Vec<f64>,
    /// Plies of each layer.
    pub stacks: Vec<Stack>,
    info: ElementInfo,
    z_derivatives: ZDerivatives,
    /// First unknown of each node, and the total at the end.
    offsets: Vec<usize>,
}

impl Plate {
    /// Extrudes `plane` through `levels`, one stack of plies between two levels.
    ///
    /// # Errors
    /// An element whose nodes are not the eight corners of a prism.
    pub fn new(
        plane: QuadMesh,
        levels: Vec<f64>,
        stacks: Vec<Stack>,
        info: ElementInfo,
        z_derivatives: ZDerivatives,
    ) -> Result<Self, String> {
        let corners = info.nodes.len() == 8 && info.nodes.iter().all(|n| n.iter().all(|c| c.abs() == 1.0));
        if !corners {
            return Err("a plate of solid cells needs an element with the eight corners of a prism as nodes".into());
        }
        let inner = match z_derivatives {
            ZDerivatives::Shared => 0,
            ZDerivatives::LayerWise => info.dofs.iter().filter(|d| d.m() == 3).count(),
        };
        let mut offsets = Vec::with_capacity(plane.points.len() * levels.len() + 1);
        let mut next = 0;
        offsets.push(0);
        for _ in &plane.points {
            for level in 0..levels.len() {
                next += info.dofs.len() + if level > 0 && level + 1 < levels.len() { inner } else { 0 };
                offsets.push(next);
            }
        }
        Ok(Self { plane, levels, stacks, info, z_derivatives, offsets })
    }

    /// Number of unknowns before constraints.
    pub fn ndof(&self) -> usize {
        self.offsets[self.offsets.len() - 1]
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.plane.quads.len() * self.layers()
    }

    /// Number of layers of cells.
    pub fn layers(&self) -> usize {
        self.stacks.len()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The element's table.
    pub fn info(&self) -> &ElementInfo {
        &self.info
    }

    /// Quad and layer of a cell.
    pub fn place(&self, cell: usize) -> (usize, usize) {
        (cell / self.layers(), cell % self.layers())
    }

    fn node(&self, column: usize, level: usize) -> usize {
        column * self.levels.len() + level
    }

    /// Column and level of the `i`-th node of a cell.
    fn corner(&self, cell: usize, i: usize) -> (usize, usize) {
        let (quad, layer) = self.place(cell);
        (self.plane.quads[quad][i % 4] as usize, layer + i / 4)
    }

    /// Node positions of a cell, in element order.
    pub fn points(&self, cell: usize) -> [[f64; 3]; 8] {
        std::array::from_fn(|i| {
            let (column, level) = self.corner(cell, i);
            let [x, y] = self.plane.points[column];
            [x, y, self.levels[level]]
        })
    }

    /// Unknowns of a cell, in element order.
    pub fn cell_dofs(&self, cell: usize, out: &mut Vec<usize>) {
        out.clear();
        let nd = self.info.dofs.len();
        for i in 0..8 {
            let (column, level) = self.corner(cell, i);
            let first = self.offsets[self.node(column, level)];
            // The second set at an inner node serves the cells for which the node is at the bottom.
            let upper = i < 4 && self.offsets[self.node(column, level) + 1] - first > nd;
            let mut extra = first + nd;
            for (k, dof) in self.info.dofs.iter().enumerate() {
                if upper && dof.m() == 3 {
                    out.push(extra);
                    extra += 1;
                } else {
                    out.push(first + k);
                }
            }
        }
    }

    /// All unknowns called `dof` at a node: none if the element lacks it, two where layers have their own.
    pub fn dofs_at(&self, column: usize, level: usize, dof: Dof) -> impl Iterator<Item = usize> + use<> {
        let node = self.node(column, level);
        let (first, end) = (self.offsets[node], self.offsets[node + 1]);
        let nd = self.info.dofs.len();
        let own = self.info.dofs.iter().position(|d| *d == dof).map(|k| first + k);
        let second = self
            .info
            .dofs
            .iter()
            .filter(|d| d.m() == 3)
            .position(|d| *d == dof)
            .map(|k| first + nd + k)
            .filter(|i| *i < end);
        own.into_iter().chain(second)
    }

    /// Unknowns of the nodes of a column, from the bottom.
    pub fn dofs_of_column(&self, column: usize) -> std::ops::Range<usize> {
        self.offsets[self.node(column, 0)]..self.offsets[self.node(column + 1, 0)]
    }

    /// Level whose z is the mid-plane of the laminate, if there is one.
    pub fn mid_level(&self) -> Option<usize> {
        let h = self.levels[self.levels.len() - 1] - self.levels[0];
        self.levels.iter().position(|z| z.abs() < 1e-9 * h)
    }

    /// Column, level and name of an unknown.
    pub fn locate(&self, dof: usize) -> (usize, usize, Dof) {
        let node = self.offsets.partition_point(|o| *o <= dof) - 1;
        let k = dof - self.offsets[node];
        let name = self.info.dofs.get(k).copied().unwrap_or_else(|| {
            let mut z = self.info.dofs.iter().filter(|d| d.m() == 3);
            z.nth(k - self.info.dofs.len()).copied().unwrap_or(self.info.dofs[0])
        });
        (node / self.levels.len(), node % self.levels.len(), name)
    }

    /// "U30 at node 17 of the mesh (x, y, z in mm)".
    pub fn describe(&self, dof: usize) -> String {
        let (column, level, name) = self.locate(dof);
        let [x, y] = self.plane.points[column];
        let mut text = format!("{name} at node {}", self.plane.node_tags[column]);
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
        let [x, y] = self.plane.points[column];
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
