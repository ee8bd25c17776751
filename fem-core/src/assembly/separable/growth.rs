//! Which closed cells of an interface are opened, and what they have carried.

use super::Separable;
use crate::contracts::interface_law::Jump;
use crate::plates::interfaces::Interfaces;
use crate::plates::plate::Plate;
use std::collections::{BTreeMap, BTreeSet};

/// When interfaces are opened.
///
/// An interface is rigid until damage comes near: ahead of every damaged point lies a band of open and undamaged cells, so wide that
/// what the rigid interface does at its border does not reach the damage. Where nothing is damaged yet, the mean tractions at the nodes
/// say where it will be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// Width of the band, m: from one to two process zones, and two cells at least.
    pub margin: f64,
    /// Share of the tractions at which the law begins to damage from which on a node is opened, and the band around it.
    pub trigger: f64,
}

/// Columns beside the corner columns of a plate, and what of the forces there belongs to those, for as many of each as their symmetry makes.
pub(super) fn beside(plate: &Plate) -> BTreeMap<usize, Vec<(usize, f64)>> {
    let of = |column: usize| plate.symmetry().column(column as u32);
    let mut images: BTreeMap<u32, f64> = BTreeMap::new();
    (0..plate.columns.len()).for_each(|column| *images.entry(of(column)).or_default() += 1.0);
    let mut beside = plate.columns_beside();
    for (corner, others) in &mut beside {
        others.iter_mut().for_each(|(other, share)| *share *= images[&of(*corner)] / images[&of(*other)]);
    }
    beside
}

/// How much farther than it must an opening goes, because each costs a factorisation.
const AHEAD: f64 = 1.5;

impl Separable {
    /// Opens the closed cells near damage and near what is about to be, in `states`, with the tractions that they carry.
    ///
    /// Of the forces that the cells above exert at a corner of the interface, divided by its area, the traction is linear in
    /// each cell. What they exert at the middle of a side is that of its ends: a uniform traction pulls the corners of quadratic cells
    /// the other way. It is not that of the closed interface, which is singular at its border, but what that comes to.
    pub(super) fn grow(&mut self, u: &[f64], states: &mut [f64]) {
        let tractions = self.nodal_tractions(u);
        let growth = self.parts.growth;
        if self.reached(&tractions, states, growth).is_empty() {
            return;
        }
        let ahead = Growth { margin: AHEAD * growth.margin, trigger: growth.trigger / AHEAD };
        let fresh = self.reached(&tractions, states, ahead);
        let parts = &self.parts;
        for number in fresh {
            let cell = &parts.interfaces.cells()[number];
            let corners = parts.plate.plane.cell(cell.quad);
            let domain = corners.domain();
            let at_corner: Vec<Jump> = parts
                .plate
                .corner_columns(cell.quad)
                .map(|column| tractions.get(&(column as usize, cell.face)).copied().unwrap_or_default())
                .collect();
            let positions = parts.interfaces.positions(number).to_vec();
            let own = self.first[number]..self.first[number + 1];
            parts.interfaces.carry(number, &mut states[own], |point| {
                let shares = domain.vertex_functions(corners.locate(positions[point]).unwrap_or(domain.centre()));
                std::array::from_fn(|i| shares.into_iter().zip(&at_corner).map(|(share, t)| share * t[i]).sum())
            });
        }
    }

    /// Closed cells nearer to damage, or to a node whose tractions are near those of damage, than the band is wide.
    fn reached(&self, tractions: &BTreeMap<(usize, usize), Jump>, states: &[f64], growth: Growth) -> Vec<usize> {
        let plate = &self.parts.plate;
        let interfaces = &self.parts.interfaces;
        let centre = |quad: usize| plate.plane.cell(quad).centroid();
        let mut sources: BTreeMap<usize, Vec<[f64; 2]>> = BTreeMap::new();
        let mut hurt: BTreeSet<(usize, usize)> = BTreeSet::new();
        for (number, cell) in interfaces.cells().iter().enumerate() {
            let own = &states[self.states_of(number)];
            if Interfaces::is_open(own) && interfaces.damage(number, own).any(|(_, damage)| damage > 0.0) {
                hurt.insert((cell.face, cell.quad));
                sources.entry(cell.face).or_default();
            }
        }
        for (face, at) in &mut sources {
            let all = 0..plate.plane.quads.len();
            at.extend(all.filter(|quad| hurt.contains(&(*face, plate.symmetry().quad(*quad)))).map(centre));
        }
        for ((column, face), node) in tractions {
            if interfaces.begins_to_fail(&node.map(|t| t / growth.trigger)) {
                sources.entry(*face).or_default().push(plate.columns[*column]);
            }
        }
        let near = |face: usize, quad: usize| {
            let [x, y] = centre(quad);
            let within = |p: &[f64; 2]| (p[0] - x).hypot(p[1] - y) <= growth.margin;
            sources.get(&face).is_some_and(|sources| sources.iter().any(within))
        };
        let closed = interfaces
            .cells()
            .iter()
            .enumerate()
            .filter(|(number, _)| !Interfaces::is_open(&states[self.states_of(*number)]));
        closed.filter(|(_, cell)| near(cell.face, cell.quad)).map(|(number, _)| number).collect()
    }

    /// Mean tractions at the corners (column, face) of closed cells.
    fn nodal_tractions(&self, u: &[f64]) -> BTreeMap<(usize, usize), Jump> {
        let mut nodes: BTreeMap<(usize, usize), Jump> = BTreeMap::new();
        let parts = &self.parts;
        let plate = &parts.plate;
        let mut force = vec![0.0; u.len()];
        self.k.add_product(1.0, u, &mut force);
        if let Some(stretched) = &self.stretched {
            stretched.tear(u, &mut force);
        }
        let symmetry = plate.symmetry();
        let mut areas: BTreeMap<(u32, usize), f64> = BTreeMap::new();
        for cell in parts.interfaces.cells() {
            let corners = plate.plane.cell(cell.quad);
            let share = cell.weight * corners.area() / corners.len() as f64;
            for column in plate.corner_columns(cell.quad) {
                nodes.entry((column as usize, cell.face)).or_default();
                *areas.entry((symmetry.column(column), cell.face)).or_default() += share;
            }
        }
        for ((column, face), node) in &mut nodes {
            let area = areas[&(symmetry.column(*column as u32), *face)];
            let beside = self.beside.get(column).map_or(&[][..], Vec::as_slice);
            for (slot, n) in [(0, 3), (1, 1), (2, 2)] {
                let terms = |column: usize| Some(parts.constraints.row(plate.above(column, *face, n)?).0);
                let pull = |terms: &[(usize, f64)]| terms.iter().map(|(i, c)| c * force[*i]).sum::<f64>();
                let Some(own) = terms(*column) else { continue };
                // What is held has no force here, which those beside it would be short of.
                let free = beside.iter().filter(|_| !own.is_empty());
                let others: f64 = free.filter_map(|(other, share)| Some(share * pull(terms(*other)?))).sum();
                // What the interface does to the layer above balances what its cells do.
                node[slot] = -(pull(own) + others) / area;
            }
        }
        nodes
    }
}
