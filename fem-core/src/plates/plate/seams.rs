//! Lines between regions, where strains jump.

use super::Plate;
use crate::plates::constraint::Equation;
use crate::plates::mesh::{Group, Sides};
use crate::words::dof::Dof;
use std::collections::BTreeMap;

/// Where two regions meet along a smooth line.
#[derive(Debug, Clone, Copy)]
struct Seam {
    /// The two, ascending.
    regions: [usize; 2],
    /// Angle of its tangent from the x axis, radians.
    angle: f64,
}

/// Columns on seams, and which nodes of theirs have cells of both regions.
#[derive(Debug, Clone, Default)]
pub(super) struct Seams {
    columns: BTreeMap<usize, Seam>,
    /// By node, which of the two regions have cells there; both, once it is settled that derivatives there are of two sets.
    met: BTreeMap<usize, [bool; 2]>,
}

impl Seams {
    pub(super) fn clear(&mut self) {
        self.met.clear();
    }

    /// Notes that a cell of `region` has a node, of a column.
    pub(super) fn meet(&mut self, node: usize, column: usize, region: usize) {
        if let Some(seam) = self.columns.get(&column) {
            self.met.entry(node).or_default()[usize::from(seam.regions[1] == region)] = true;
        }
    }

    /// Leaves the nodes where both regions meet and layers do not separate.
    pub(super) fn settle(&mut self, is_separable: impl Fn(usize) -> bool) {
        self.met.retain(|node, met| *met == [true; 2] && !is_separable(*node));
    }

    /// Whether a region is the later of the two that meet at a column.
    pub(super) fn is_later(&self, column: usize, region: usize) -> bool {
        self.columns.get(&column).is_some_and(|seam| seam.regions[1] == region)
    }

    /// The same for the columns of a part, `whole` saying which each of them is.
    pub(super) fn of_part(&self, whole: &[Option<usize>]) -> Self {
        let seam = |column: &Option<usize>| self.columns.get(column.as_ref()?).copied();
        let columns = whole.iter().enumerate().filter_map(|(own, column)| Some((own, seam(column)?)));
        Self { columns: columns.collect(), met: BTreeMap::new() }
    }
}

/// Whether an unknown is a derivative that jumps where stiffness does: along x and y, but for the slopes of a shell.
pub(super) fn jumps(dof: &Dof, of_shell: bool) -> bool {
    matches!(dof.m(), 1 | 2) && (dof.n() < 3 || !of_shell)
}

impl Plate {
    /// Gives the nodes on lines between regions that are `unlike` derivatives along x and y for each side: displacements are continuous
    /// there, and with them their derivatives along the line and along z, but those across it jump where stiffness does. Until
    /// [`Plate::seam_ties`] hold the derivatives along the line together, they are free.
    ///
    /// Nodes at which layers may [separate](Self::separate) share them. Where lines meet or turn at a corner, displacements that are continuous along both leave no derivative that could jump.
    ///
    /// To be done when all regions are assigned, and before the plate is folded.
    pub fn let_strains_jump(&mut self, unlike: impl Fn(usize, usize) -> bool) {
        self.seams.columns = self.find_seams(unlike);
        self.number();
    }

    /// Whether cells share such derivatives at their nodes.
    pub fn shares_strains(&self) -> bool {
        self.info().dofs.iter().any(|dof| jumps(dof, self.info().is_shell()))
    }

    fn find_seams(&self, unlike: impl Fn(usize, usize) -> bool) -> BTreeMap<usize, Seam> {
        let mut found = BTreeMap::new();
        if self.regions() < 2 || !self.shares_strains() {
            return found;
        }
        let sides = Sides::of(&self.plane);
        let lies_between = |nodes: [u32; 2], cell: u32| {
            let beside = sides.opposite(nodes).filter(|beside| beside.cell < cell);
            beside.is_some_and(|beside| {
                let [one, two] = [cell, beside.cell].map(|cell| self.region(cell as usize));
                one != two && unlike(one, two)
            })
        };
        let edges: Vec<[u32; 2]> =
            sides.all().iter().filter(|side| lies_between(side.nodes, side.cell)).map(|side| side.nodes).collect();
        if edges.is_empty() {
            return found;
        }
        let mut nodes: Vec<u32> = edges.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let line = Group { dim: 1, nodes, edges, quads: Vec::new() };
        let courses = self.plane.courses(&line);
        let mut around: BTreeMap<usize, Vec<usize>> =
            self.columns_of_group(&line).into_iter().map(|column| (column as usize, Vec::new())).collect();
        for quad in 0..self.plane.quads.len() {
            for column in self.columns_of_quad(quad) {
                if let Some(regions) = around.get_mut(&(*column as usize)) {
                    regions.push(self.region(quad));
                }
            }
        }
        for (column, mut regions) in around {
            regions.sort_unstable();
            regions.dedup();
            let Ok(regions) = <[usize; 2]>::try_from(regions) else { continue };
            let angle = match (self.ends(column), courses.get(&(column as u32)).map(Vec::as_slice)) {
                (Some([a, b]), _) => {
                    let [a, b] = [a, b].map(|vertex| self.plane.points[vertex as usize]);
                    (b[1] - a[1]).atan2(b[0] - a[0])
                }
                (None, Some([course])) => course.angle,
                _ => continue,
            };
            found.insert(column, Seam { regions, angle });
        }
        found
    }

    /// Names of the last set of unknowns of a node, of the cells of the later region.
    pub(super) fn last_set(&self, node: usize) -> impl Iterator<Item = &'static Dof> + use<> {
        let (seamed, shell) = (self.seams.met.contains_key(&node), self.info().is_shell());
        self.info().dofs.iter().filter(move |dof| seamed && jumps(dof, shell))
    }

    /// What holds the derivatives along the lines together on which strains may jump.
    pub fn seam_ties(&self) -> Vec<Equation> {
        let mut ties = Vec::new();
        for node in self.seams.met.keys() {
            let (column, level) = (node / self.levels.len(), node % self.levels.len());
            let Some(Seam { angle, .. }) = self.seams.columns.get(&column) else { continue };
            // The ties of images follow by symmetry: their own, from other nodes, would differ in the last digits and hold what jumps.
            if !self.symmetry.represents_itself(column) {
                continue;
            }
            let (sine, cosine) = angle.sin_cos();
            for n in 1..=3 {
                let mut terms = Vec::new();
                for (m, factor) in [(1, cosine), (2, sine)].into_iter().filter(|(_, c)| c.abs() > ALONG) {
                    let both: Vec<usize> =
                        Dof::new(n, m).map(|dof| self.dofs_at(column, level, dof).collect()).unwrap_or_default();
                    if let [own, later] = both[..] {
                        terms.extend([(later, factor), (own, -factor)]);
                    }
                }
                if !terms.is_empty() {
                    ties.push(Equation { terms, value: 0.0, origin: SEAM.into(), holds: false });
                }
            }
        }
        ties
    }

    /// Columns on lines between regions whose strains may jump.
    #[cfg(feature = "assembly")]
    pub(crate) fn seam_columns(&self) -> Vec<usize> {
        self.seams.columns.keys().copied().collect()
    }

    /// Whether a node has derivatives along x and y for both sides of a line.
    pub fn is_on_seam(&self, column: usize, level: usize) -> bool {
        self.seams.met.contains_key(&self.node(column, level))
    }
}

/// Cosine of an angle that is a right one but for how well nodes know it: beside a support that holds the other derivative, what is left of
/// a tie would hold the one that jumps.
const ALONG: f64 = 1e-4;

/// Origin of the equations of [`Plate::seam_ties`].
const SEAM: &str = "the line between two laminates";
