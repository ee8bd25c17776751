//! Interfaces of a plate that may open: their tractions as forces on the faces of the layers that they join.

use crate::contracts::element::{Element, ElementError, form, positive};
use crate::contracts::interface_law::{InterfaceLaw, InterfaceResponse, Jump, Sinks};
use crate::contracts::ply_law::{LawPoint, check_law};
use crate::plates::plate::{FaceUnknowns, Plate};
use crate::words::dof::Dof;
use crate::words::domain::Domain;
use crate::words::material::{Material, MaterialError};
use crate::words::tensor::Matrix6;
use std::collections::BTreeMap;
use std::fmt;

/// Shares of a displacement that an unknown of another component may have, relative, for rounding.
const ROUNDING: f64 = 1e-12;

/// Numbers that a cell keeps before those of its points.
const HEADER: usize = 2;

/// Numbers that a point keeps before the state of its law: the jump that its traction was carried over with.
const CARRIED: usize = 3;

/// What an interface is made of.
#[derive(Debug, Clone)]
pub struct InterfaceMaterial {
    /// The law, by its name in the scene.
    pub name: String,
    /// The law.
    pub law: Box<dyn InterfaceLaw>,
    /// The material whose toughness and strengths it follows.
    pub material: Material,
}

/// Interfaces that may open, cell by cell: quads at a face between two layers.
///
/// The jump across a cell is that of the displacements on its two faces, δ = N (u⁺ − u⁻), N the shape functions of the element on
/// its upper face; forces on the two are ± ∫ Nᵀ t dA. The traction is the law's at δ + δ₀, δ₀ the jump at which the law carries
/// what the closed interface has carried before ([`Interfaces::carry`]).
///
/// State of a cell: whether it is open, 0 or 1, the energy that it was lent (what is stored in the law at δ₀ was the plate's before,
/// J), then δ₀ and the state of the law of each of its points.
#[derive(Debug, Clone)]
pub struct Interfaces {
    of: InterfaceMaterial,
    stiffness: Matrix6,
    cells: Vec<InterfaceCell>,
    shapes: Vec<FaceShape>,
    /// Component of the displacement, counted from 0, that each unknown of a face of a cell is of.
    components: Vec<usize>,
    per_point: usize,
}

/// A quad at a face between layers.
#[derive(Debug, Clone)]
pub struct InterfaceCell {
    /// The quad.
    pub quad: usize,
    /// The face: the layer above it.
    pub face: usize,
    /// How many cells it stands for by symmetry.
    pub weight: f64,
    /// Its unknowns.
    pub unknowns: FaceUnknowns,
    shape: usize,
}

/// Shape functions on the upper face of a cell at the points of integration.
#[derive(Debug, Clone)]
struct FaceShape {
    /// Area of each point, m².
    areas: Vec<f64>,
    /// Where each is, m.
    positions: Vec<[f64; 2]>,
    /// `points × unknowns`.
    functions: Vec<f64>,
    /// Side of the square of the cell's area, m.
    length: f64,
}

/// Why an interface cannot open.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum InterfacesError {
    /// The displacements on a face of the element follow from more than those of the nodes there, or mix their components.
    Element,
    /// A folded cell.
    Cell {
        /// Number of the quad in the file.
        quad_tag: u64,
        /// What is wrong.
        error: ElementError,
    },
    /// The law does not take the material.
    Material(MaterialError),
}

impl fmt::Display for InterfacesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Element => f.write_str(
                "the displacements on the faces of the element are not those of its nodes there, component by component",
            ),
            Self::Cell { quad_tag, error } => write!(f, "cell {quad_tag} of the mesh: {error}"),
            Self::Material(error) => error.fmt(f),
        }
    }
}
impl std::error::Error for InterfacesError {}

/// What a cell of an interface is asked for beside its forces.
#[derive(Debug, Default)]
pub struct InterfaceAnswer {
    /// ∫ Nᵀ t dA, N: on the face below; on that above the opposite sign acts on the structure as internal force.
    pub force: Vec<f64>,
    /// ∂t/∂δ of each point times its area, N/m, row by row.
    pub moduli: Vec<[Jump; 3]>,
    /// What comes back of the work done, J.
    pub stored: f64,
    /// What does not.
    pub dissipated: Sinks,
}

impl Interfaces {
    /// Share of its cohesion from which on a point counts as delaminated: all but the rounding of a law that tends to 1.
    pub const BROKEN: f64 = 0.99;

    /// The interfaces at `faces` of `plate`, each over its quads, where [`Plate::separate`] has been called for them; `order` points
    /// of integration each way. A symmetry of the plate leaves one cell for all its images.
    ///
    /// # Errors
    /// An element whose faces are not told by their nodes, a folded cell, a law that refuses its material.
    pub fn new(
        plate: &Plate,
        element: &dyn Element,
        of: InterfaceMaterial,
        faces: &[(usize, Vec<u32>)],
        order: usize,
    ) -> Result<Self, InterfacesError> {
        let components: Vec<usize> = plate.face_slots(None).map(|(_, dof)| dof.n() - 1).collect();
        let per_point = CARRIED + of.law.info().state.len();
        let stiffness = of.material.elastic.stiffness();
        let mut shape_of = vec![None; plate.plane.quads.len()];
        let (mut cells, mut shapes) = (Vec::new(), Vec::new());
        let kept: Vec<(usize, f64)> = plate.symmetry().quads().collect();
        for (face, quads) in faces {
            for (quad, weight) in kept.iter().filter(|(quad, _)| quads.contains(&(*quad as u32))) {
                let shape = match shape_of[*quad] {
                    Some(shape) => shape,
                    None => {
                        let shape = FaceShape::new(plate, element, *quad, order)?;
                        let point = LawPoint {
                            material: &of.material,
                            stiffness: &stiffness,
                            length: shape.length,
                            thickness: 0.0,
                            means: &[],
                        };
                        check_law(of.law.info(), &of.name, &point, of.law.check(&point))
                            .map_err(InterfacesError::Material)?;
                        shapes.push(shape);
                        *shape_of[*quad].insert(shapes.len() - 1)
                    }
                };
                let unknowns = plate.face_unknowns(*quad, *face);
                cells.push(InterfaceCell { quad: *quad, face: *face, weight: *weight, unknowns, shape });
            }
        }
        Ok(Self { of, stiffness, cells, shapes, components, per_point })
    }

    /// The cells.
    pub fn cells(&self) -> &[InterfaceCell] {
        &self.cells
    }

    /// State variables of all cells.
    pub fn states(&self) -> usize {
        self.cells.iter().map(|cell| HEADER + self.points(cell) * self.per_point).sum()
    }

    /// Where the states of each cell begin, and their number at the end.
    pub fn first_states(&self) -> Vec<usize> {
        let mut first = vec![0];
        for cell in &self.cells {
            first.push(first[first.len() - 1] + HEADER + self.points(cell) * self.per_point);
        }
        first
    }

    fn points(&self, cell: &InterfaceCell) -> usize {
        self.shapes[cell.shape].areas.len()
    }

    /// Areas of the points of a cell, m², and the state of the law of each, of the states of the cell.
    pub fn laws<'a>(&'a self, cell: usize, states: &'a [f64]) -> impl Iterator<Item = (f64, &'a [f64])> {
        let areas = &self.shapes[self.cells[cell].shape].areas;
        areas.iter().copied().zip(states[HEADER..].chunks_exact(self.per_point).map(|point| &point[CARRIED..]))
    }

    /// Places of the points of a cell, m.
    pub fn positions(&self, cell: usize) -> &[[f64; 2]] {
        &self.shapes[self.cells[cell].shape].positions
    }

    /// Share of its cohesion that each point of a cell has lost, with its area, m².
    pub fn damage<'a>(&'a self, cell: usize, states: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
        let at = self.point(cell);
        self.laws(cell, states).map(move |(area, state)| (area, self.of.law.damage(&at, state)))
    }

    /// Mean jump across a cell, m: along its normal, along x, along y; `u` are the displacements of the plate before elimination.
    pub fn mean_jump(&self, cell: usize, u: &[f64]) -> Jump {
        let (InterfaceCell { unknowns, shape, .. }, components) = (&self.cells[cell], self.components(cell));
        let shape = &self.shapes[*shape];
        let apart = unknowns.above.iter().zip(&unknowns.below).map(|(above, below)| u[*above] - u[*below]);
        let whole: f64 = shape.areas.iter().sum();
        let mut jump = [0.0; 3];
        for ((unknown, apart), component) in apart.enumerate().zip(components) {
            let functions = shape.functions.iter().skip(unknown).step_by(components.len());
            let mean = shape.areas.iter().zip(functions).map(|(area, function)| area * function).sum::<f64>() / whole;
            jump[SLOT[*component]] += mean * apart;
        }
        jump
    }

    /// Area of the points that have lost more than `share` of their cohesion, m², face by face.
    pub fn lost_area(&self, states: &[f64], share: f64) -> BTreeMap<usize, f64> {
        let mut areas = BTreeMap::new();
        let first = self.first_states();
        for (number, cell) in self.cells.iter().enumerate() {
            let own = &states[first[number]..first[number + 1]];
            let lost = self.damage(number, own).filter(|(_, damage)| *damage > share);
            *areas.entry(cell.face).or_insert(0.0) += cell.weight * lost.map(|(area, _)| area).sum::<f64>();
        }
        areas
    }

    /// What all cells have dissipated, J.
    pub fn dissipated(&self, states: &[f64]) -> Sinks {
        let first = self.first_states();
        let mut sum = Sinks::default();
        for (number, cell) in self.cells.iter().enumerate() {
            let own = &states[first[number]..first[number + 1]];
            if Self::is_open(own) {
                for (area, state) in self.laws(number, own) {
                    sum = sum.plus(cell.weight * area, self.of.law.dissipated(state));
                }
            }
        }
        sum
    }

    /// Area of the plane under which some face has points that have lost more than `share` of their cohesion, m².
    pub fn projected_area(&self, states: &[f64], share: f64) -> f64 {
        let first = self.first_states();
        let mut lost: BTreeMap<usize, (f64, Vec<f64>)> = BTreeMap::new();
        for (number, cell) in self.cells.iter().enumerate() {
            let own = &states[first[number]..first[number + 1]];
            if !Self::is_open(own) {
                continue;
            }
            let (_, areas) = lost.entry(cell.quad).or_insert_with(|| (cell.weight, vec![0.0; self.points(cell)]));
            for (lost, (area, damage)) in areas.iter_mut().zip(self.damage(number, own)) {
                if damage > share {
                    *lost = area;
                }
            }
        }
        lost.values().fold(0.0, |sum, (weight, areas)| sum + weight * areas.iter().sum::<f64>())
    }

    /// Whether a cell is open, from its states.
    pub fn is_open(states: &[f64]) -> bool {
        states[0] != 0.0
    }

    /// Energy that a cell was lent when it was opened, from its states, J.
    pub fn lent(states: &[f64]) -> f64 {
        states[1]
    }

    /// Opens a cell, of those `states`, with the `traction` (Pa) that it has carried, at each of its points: normal, along x, along y.
    /// What a law cannot carry without damage is cut to what it can.
    pub fn carry(&self, cell: usize, states: &mut [f64], mut traction: impl FnMut(usize) -> Jump) {
        let at = self.point(cell);
        let stiffness = self.virgin(&at);
        let mut left = [0.0; MOST_STATES];
        let mut lent = 0.0;
        let areas = &self.shapes[self.cells[cell].shape].areas;
        let count = self.per_point - CARRIED;
        for ((point, area), state) in areas.iter().enumerate().zip(states[HEADER..].chunks_exact_mut(self.per_point)) {
            let mut jump = jump_of(&stiffness, &traction(point));
            for _ in 0..MOST_CUTS {
                let (carried, old) = state.split_at_mut(CARRIED);
                let Ok(answer) = self.of.law.respond(&at, &jump, old, &mut left[..count], None) else { break };
                if self.of.law.damage(&at, &left[..count]) == 0.0 {
                    carried.copy_from_slice(&jump);
                    lent += area * answer.stored;
                    break;
                }
                jump = jump.map(|j| CUT * j);
            }
        }
        (states[0], states[1]) = (1.0, lent);
    }

    /// Whether a virgin interface is damaged under a traction, Pa: normal, along x, along y.
    pub fn begins_to_fail(&self, traction: &Jump) -> bool {
        if self.cells.is_empty() {
            return false;
        }
        let at = self.point(0);
        let mut left = [0.0; MOST_STATES];
        let (old, left) = ([0.0; MOST_STATES], &mut left[..self.per_point - CARRIED]);
        let jump = jump_of(&self.virgin(&at), traction);
        self.of.law.respond(&at, &jump, &old[..left.len()], left, None).is_ok() && self.of.law.damage(&at, left) > 0.0
    }

    /// Opens a cell where nothing holds it any more at the points whose places, m, are `broken`.
    pub fn crack(&self, cell: usize, states: &mut [f64], mut broken: impl FnMut([f64; 2]) -> bool) {
        states[0] = 1.0;
        let (at, positions) = (self.point(cell), &self.shapes[self.cells[cell].shape].positions);
        for (position, state) in positions.iter().zip(states[HEADER..].chunks_exact_mut(self.per_point)) {
            if broken(*position) {
                self.of.law.broken(&at, &mut state[CARRIED..]);
            }
        }
    }

    /// Shape functions at a point of a cell, one per unknown of its faces.
    pub fn functions(&self, cell: usize, point: usize) -> &[f64] {
        let n = self.components(cell).len();
        &self.shapes[self.cells[cell].shape].functions[point * n..(point + 1) * n]
    }

    /// Component of the displacement, counted from 0, that each unknown of a face of a cell is of.
    pub fn components(&self, cell: usize) -> &[usize] {
        let shape = &self.shapes[self.cells[cell].shape];
        // Nodes have the same unknowns: those of a triangle are the first of those of a quadrilateral.
        &self.components[..shape.functions.len() / shape.areas.len()]
    }

    /// Stiffness of an interface that opens for the first time, Pa/m.
    fn virgin(&self, at: &LawPoint<'_>) -> [Jump; 3] {
        let mut tangent = [[0.0; 3]; 3];
        let old = [0.0; MOST_STATES];
        let mut new = [0.0; MOST_STATES];
        let count = self.per_point - CARRIED;
        let jump = [f64::MIN_POSITIVE, 0.0, 0.0];
        match self.of.law.respond(at, &jump, &old[..count], &mut new[..count], Some(&mut tangent)) {
            Ok(_) => tangent,
            Err(_) => [[0.0; 3]; 3],
        }
    }

    /// Moduli of a cell to which nothing has happened, as [`InterfaceAnswer::moduli`] times the cells that it stands for.
    pub fn undamaged(&self, cell: usize, moduli: &mut Vec<[Jump; 3]>) {
        let stiffness = self.virgin(&self.point(cell));
        let InterfaceCell { shape, weight, .. } = self.cells[cell];
        let areas = self.shapes[shape].areas.iter();
        moduli.clear();
        moduli.extend(areas.map(|area| stiffness.map(|row| row.map(|k| weight * area * k))));
    }

    fn point(&self, cell: usize) -> LawPoint<'_> {
        let length = self.shapes[self.cells[cell].shape].length;
        LawPoint { material: &self.of.material, stiffness: &self.stiffness, length, thickness: 0.0, means: &[] }
    }

    /// Tractions of a cell under the differences `apart` of its unknowns, above minus below; with their moduli where these are wanted,
    /// with the states that are left where `new` has room for them.
    ///
    /// # Errors
    /// A law that finds no traction.
    pub fn respond(
        &self,
        cell: usize,
        apart: &[f64],
        states: &[f64],
        mut new: Option<&mut [f64]>,
        moduli: bool,
        answer: &mut InterfaceAnswer,
    ) -> Result<(), ElementError> {
        let shape = &self.shapes[self.cells[cell].shape];
        let (n, count) = (self.components(cell).len(), self.per_point - CARRIED);
        answer.force.clear();
        answer.force.resize(n, 0.0);
        answer.moduli.clear();
        (answer.stored, answer.dissipated) = (0.0, Sinks::default());
        if let Some(new) = &mut new {
            new[..HEADER].copy_from_slice(&states[..HEADER]);
        }
        let at = self.point(cell);
        let mut left = [0.0; MOST_STATES];
        for (point, (area, functions)) in shape.areas.iter().zip(shape.functions.chunks_exact(n)).enumerate() {
            let here = HEADER + point * self.per_point;
            let (carried, old) = states[here..here + self.per_point].split_at(CARRIED);
            let mut jump = [carried[0], carried[1], carried[2]];
            for ((function, component), apart) in functions.iter().zip(&self.components).zip(apart) {
                jump[SLOT[*component]] += function * apart;
            }
            let mut modulus = [[0.0; 3]; 3];
            let left = &mut left[..count];
            let InterfaceResponse { traction, stored, dissipated } = self
                .of
                .law
                .respond(&at, &jump, old, left, moduli.then_some(&mut modulus))
                .map_err(|why| ElementError(why.to_string()))?;
            answer.stored += area * stored;
            answer.dissipated = answer.dissipated.plus(*area, dissipated);
            for ((force, function), component) in answer.force.iter_mut().zip(functions).zip(&self.components) {
                *force += area * function * traction[SLOT[*component]];
            }
            if moduli {
                answer.moduli.push(modulus.map(|row| row.map(|m| area * m)));
            }
            if let Some(new) = &mut new {
                new[here..here + CARRIED].copy_from_slice(carried);
                new[here + CARRIED..here + self.per_point].copy_from_slice(left);
            }
        }
        Ok(())
    }

    /// `force ← ∫ Nᵀ D N dA apart` of a cell with these `moduli`.
    pub fn apply(&self, cell: usize, moduli: &[[Jump; 3]], apart: &[f64], force: &mut [f64]) {
        force.fill(0.0);
        let n = self.components(cell).len();
        let shape = &self.shapes[self.cells[cell].shape];
        for (modulus, functions) in moduli.iter().zip(shape.functions.chunks_exact(n)) {
            let mut jump = [0.0; 3];
            for ((function, component), apart) in functions.iter().zip(&self.components).zip(apart) {
                jump[SLOT[*component]] += function * apart;
            }
            let traction = modulus.map(|row| row[0] * jump[0] + row[1] * jump[1] + row[2] * jump[2]);
            for ((force, function), component) in force.iter_mut().zip(functions).zip(&self.components) {
                *force += function * traction[SLOT[*component]];
            }
        }
    }

    /// Stiffness of a cell on the unknowns below and then above, column-major, of the symmetric parts of `moduli` without what
    /// couples the components, and nowhere negative.
    pub fn secant(&self, cell: usize, moduli: &[[Jump; 3]], matrix: &mut Vec<f64>) {
        let n = self.components(cell).len();
        matrix.clear();
        matrix.resize(4 * n * n, 0.0);
        let shape = &self.shapes[self.cells[cell].shape];
        for (modulus, functions) in moduli.iter().zip(shape.functions.chunks_exact(n)) {
            let diagonal: Jump = std::array::from_fn(|i| modulus[i][i].max(0.0));
            for (j, (fj, cj)) in functions.iter().zip(&self.components).enumerate() {
                let factor = diagonal[SLOT[*cj]] * fj;
                for (i, (fi, ci)) in functions.iter().zip(&self.components).enumerate() {
                    if ci == cj {
                        matrix[j * 2 * n + i] += factor * fi;
                    }
                }
            }
        }
        for j in 0..n {
            for i in 0..n {
                let value = matrix[j * 2 * n + i];
                matrix[j * 2 * n + n + i] = -value;
                matrix[(n + j) * 2 * n + i] = -value;
                matrix[(n + j) * 2 * n + n + i] = value;
            }
        }
    }
}

/// Place in a jump of each component of the displacement.
const SLOT: [usize; 3] = [1, 2, 0];

/// Times that a carried traction is cut, and to which share.
const MOST_CUTS: usize = 40;
const CUT: f64 = 0.9;

/// The jump under a traction; none along a direction in which nothing holds.
fn jump_of(stiffness: &[Jump; 3], traction: &Jump) -> Jump {
    std::array::from_fn(|i| if stiffness[i][i] > 0.0 { traction[i] / stiffness[i][i] } else { 0.0 })
}

/// State variables that a law of an interface may have.
pub const MOST_STATES: usize = 16;

impl FaceShape {
    fn new(plate: &Plate, element: &dyn Element, quad: usize, order: usize) -> Result<Self, InterfacesError> {
        let slots: Vec<(usize, Dof)> = plate.face_slots(Some(quad)).collect();
        let cell = plate.cell(plate.cell_over(quad, 0));
        let element = form(element, cell.corners.domain());
        let ndof = element.info().ndof();
        let mut n = vec![0.0; 3 * ndof];
        let on_face: Vec<usize> = slots.iter().map(|(slot, _)| *slot).collect();
        let (mut areas, mut positions, mut functions) = (Vec::new(), Vec::new(), Vec::new());
        let info = element.info();
        let points = if info.is_section() { Domain::section_points(order) } else { info.domain.points(order) };
        for point in points {
            let [r, s] = point.at;
            element.shape(&cell, [r, s, 1.0], &mut n);
            let area = positive(cell.plane(r, s).det)
                .map_err(|error| InterfacesError::Cell { quad_tag: plate.plane.quad_tags[quad], error })?;
            areas.push(area * point.weight());
            positions.push(cell.corners.position([r, s]));
            let size = n.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for dof in 0..ndof {
                let own = on_face.iter().position(|slot| *slot == dof).map(|k| slots[k].1.n() - 1);
                let strange = (0..3).filter(|c| Some(*c) != own).any(|c| n[3 * dof + c].abs() > ROUNDING * size);
                if strange {
                    return Err(InterfacesError::Element);
                }
            }
            functions.extend(slots.iter().map(|(slot, dof)| n[3 * slot + dof.n() - 1]));
        }
        let length = areas.iter().sum::<f64>().sqrt();
        Ok(Self { areas, positions, functions, length })
    }
}
