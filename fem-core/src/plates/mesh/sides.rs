//! Sides of cells, by the node that each begins at.

use super::PlaneMesh;

/// The sides of all cells of a mesh, each from its first corner to the next with its cell to the left.
#[derive(Debug, Clone)]
pub struct Sides {
    /// Where the sides of each node begin in `sides`, and their number at the end.
    starts: Vec<u32>,
    sides: Vec<Side>,
}

/// A side of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Side {
    /// From which node to which.
    pub nodes: [u32; 2],
    /// The cell to the left.
    pub cell: u32,
}

impl Sides {
    /// Sorts the sides of `mesh`, in linear time.
    pub fn of(mesh: &PlaneMesh) -> Self {
        let mut starts = vec![0; mesh.points.len() + 1];
        mesh.quads.iter().flatten().for_each(|node| starts[*node as usize] += 1);
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut sides = vec![Side { nodes: [0; 2], cell: 0 }; sum as usize];
        for (cell, corners) in mesh.quads.iter().enumerate().rev() {
            for nodes in corners.sides() {
                let at = &mut starts[nodes[0] as usize];
                *at -= 1;
                sides[*at as usize] = Side { nodes, cell: cell as u32 };
            }
        }
        Self { starts, sides }
    }

    /// All of them, in the order of the nodes that they begin at, then of their cells.
    pub fn all(&self) -> &[Side] {
        &self.sides
    }

    /// Those that begin at `node`.
    pub fn from(&self, node: u32) -> &[Side] {
        let [start, end] = [0, 1].map(|k| self.starts[node as usize + k] as usize);
        &self.sides[start..end]
    }

    /// The side of a cell that leads from one node to another.
    pub fn find(&self, [a, b]: [u32; 2]) -> Option<&Side> {
        self.from(a).iter().find(|side| side.nodes[1] == b)
    }

    /// The side of the cell on the other side of a side; none where it is free.
    pub fn opposite(&self, [a, b]: [u32; 2]) -> Option<&Side> {
        self.find([b, a])
    }
}
