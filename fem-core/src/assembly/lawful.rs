//! Internal forces of a plate whose plies follow laws.

use super::alike::Alike;
use super::cell_map::CellMap;
use super::equilibrium::{EquilibriumError, InternalForce, dot};
use super::{AssemblyError, Symmetric};
use crate::contracts::element::{Element, ElementError, form};
use crate::plates::constraint::Constraints;
use crate::plates::laws::{Asked, CellAnswer, CellOperators, PlyLaws};
use crate::plates::plate::Plate;
use crate::words::energy::Energy;

/// The plies of a plate that follow laws, as forces on the independent unknowns.
///
/// f(ũ) = K ũ + Cᵀ Σ ∫ Bᵀ (σ − C ε) dV, the sum over the cells with such plies: cells without cost nothing beyond their part of K.
/// Nothing is allocated after the first call but a few numbers per cell.
#[derive(Debug, Clone)]
pub struct LawPlate {
    plate: Plate,
    element: Box<dyn Element>,
    constraints: Constraints,
    laws: PlyLaws,
    cells: Vec<LawCell>,
    /// Operators by shape of cell, as far as there is room.
    shapes: Vec<Option<CellOperators>>,
    room: usize,
    /// Displacements before elimination, and of a cell.
    all: Vec<f64>,
    u: Vec<f64>,
    answer: CellAnswer,
    integrated: u64,
}

/// Memory that operators may take, bytes; those of other cells are found whenever they are needed.
const ROOM: usize = 256 << 20;

/// A cell with plies that follow laws.
#[derive(Debug, Clone)]
struct LawCell {
    cell: usize,
    /// How many it stands for.
    weight: f64,
    shape: usize,
    map: CellMap,
}

impl LawPlate {
    /// `laws` are those of `plate`.
    pub fn new(plate: &Plate, element: Box<dyn Element>, constraints: &Constraints, laws: PlyLaws) -> Self {
        let alike = Alike::of(plate);
        let mut cells = Vec::new();
        for shape in 0..alike.len() {
            for (cell, weight) in alike.cells(shape) {
                let cell = *cell as usize;
                if laws.concern(plate, cell) {
                    let mut map = CellMap::default();
                    map.set(plate, constraints, cell);
                    cells.push(LawCell { cell, weight: *weight, shape, map });
                }
            }
        }
        cells.sort_by_key(|cell| cell.cell);
        Self {
            cells,
            shapes: vec![None; alike.len()],
            room: ROOM / CellOperators::bytes(&*element),
            plate: plate.clone(),
            constraints: constraints.clone(),
            laws,
            all: vec![0.0; plate.ndof()],
            u: Vec::new(),
            element,
            answer: CellAnswer::default(),
            integrated: 0,
        }
    }

    /// State variables of all points.
    pub fn states(&self) -> usize {
        self.laws.states()
    }

    /// Cells integrated so far.
    pub fn integrated(&self) -> u64 {
        self.integrated
    }

    /// The states `points` after `u`.
    ///
    /// # Errors
    /// A law that finds no stress.
    pub fn commit(&mut self, u: &[f64], points: &mut [f64]) -> Result<(), AssemblyError> {
        if points.is_empty() {
            return Ok(());
        }
        let old = points.to_vec();
        self.each(u, &old, Some(points), false, |_, _, _| ())
    }

    /// Adds the force beyond that of K to `force`; returns the energies beyond those of K, J.
    ///
    /// # Errors
    /// A law that finds no stress.
    pub fn add(&mut self, u: &[f64], points: &[f64], force: &mut [f64]) -> Result<Energy, AssemblyError> {
        let mut energy = Energy::default();
        self.each(u, points, None, false, |weight, answer, map| {
            energy.stored += weight * answer.energy.stored;
            energy.dissipated += weight * answer.energy.dissipated;
            map.scatter_vector(&answer.force, weight, force);
        })?;
        Ok(energy)
    }

    /// The plate with K, at the states `points`.
    pub fn on<'a>(&'a mut self, k: &'a Symmetric, points: &'a [f64]) -> LawForce<'a> {
        LawForce { k, laws: self, points }
    }

    fn each(
        &mut self,
        u: &[f64],
        points: &[f64],
        mut new: Option<&mut [f64]>,
        tangent: bool,
        mut take: impl FnMut(f64, &CellAnswer, &mut CellMap),
    ) -> Result<(), AssemblyError> {
        let Self { plate, element, constraints, laws, cells, shapes, room, all, u: local, answer, integrated } = self;
        *integrated += cells.len() as u64;
        constraints.expand(u, all);
        let mut passing = None;
        for LawCell { cell, weight, shape, map } in cells {
            let states = laws.states_of(*cell);
            let element = form(&**element, plate.plane.quads[plate.place(*cell).0].domain());
            local.resize(element.info().ndof(), 0.0);
            map.gather(all, local);
            let new = new.as_deref_mut().map(|new| &mut new[states.clone()]);
            let failed = |error| {
                let (quad, layer) = plate.place(*cell);
                AssemblyError { quad_tag: plate.plane.quad_tags[quad], layer, error }
            };
            if shapes[*shape].is_none() {
                let found = CellOperators::new(element, &plate.cell(*cell)).map_err(failed)?;
                if *room > 0 {
                    *room -= 1;
                    shapes[*shape] = Some(found);
                } else {
                    passing = Some(found);
                }
            }
            let Some(operators) = shapes[*shape].as_ref().or(passing.as_ref()) else { continue };
            let asked = Asked { plate, element, cell: *cell, operators, u: local, states: &points[states] };
            let finite = |answer: &CellAnswer| answer.energy.total().is_finite();
            let refused = || ElementError("its strain energy is not finite".into());
            laws.respond(asked, new, tangent, answer)
                .and_then(|()| if finite(answer) { Ok(()) } else { Err(refused()) })
                .map_err(failed)?;
            take(*weight, answer, map);
        }
        Ok(())
    }
}

/// The internal force of a plate with laws between two accepted steps.
#[derive(Debug)]
pub struct LawForce<'a> {
    k: &'a Symmetric,
    laws: &'a mut LawPlate,
    points: &'a [f64],
}

impl InternalForce for LawForce<'_> {
    fn internal(
        &mut self,
        u: &[f64],
        force: &mut [f64],
        mut tangent: Option<&mut Symmetric>,
    ) -> Result<Energy, AssemblyError> {
        let Self { k, laws, points } = self;
        force.fill(0.0);
        k.add_product(1.0, u, force);
        let mut energy = Energy { stored: 0.5 * dot(u, force), dissipated: 0.0 };
        if let Some(tangent) = &mut tangent {
            tangent.lower_mut().val_mut().copy_from_slice(k.lower().val());
        }
        laws.each(u, points, None, tangent.is_some(), |weight, answer, map| {
            energy.stored += weight * answer.energy.stored;
            energy.dissipated += weight * answer.energy.dissipated;
            map.scatter_vector(&answer.force, weight, force);
            if let Some(tangent) = &mut tangent {
                map.scatter(&answer.tangent, weight, tangent);
            }
        })?;
        Ok(energy)
    }

    /// A step as long as it is, or shorter where it leads beyond the equilibrium along it by more than half of the way.
    fn length(
        &mut self,
        _: f64,
        force: &[f64],
        load: &[f64],
        u: &[f64],
        d: &[f64],
        tried: &mut [f64],
    ) -> Result<f64, EquilibriumError> {
        let mut there = vec![0.0; u.len()];
        let begin = dot(load, d) - dot(force, d);
        let (mut low, mut high) = ((0.0, begin), None::<(f64, f64)>);
        let mut s = 1.0;
        for _ in 0..SEARCH {
            tried.iter_mut().zip(u).zip(d).for_each(|((t, u), d)| *t = u + s * d);
            self.internal(tried, &mut there, None).map_err(EquilibriumError::Assembly)?;
            let left = dot(load, d) - dot(&there, d);
            if left.abs() <= 0.5 * begin || (left > 0.0 && high.is_none()) {
                break;
            }
            if left > 0.0 {
                low = (s, left)
            } else {
                high = Some((s, left))
            }
            let (far, beyond) = high.unwrap_or((1.0, left));
            s = low.0 + (far - low.0) * (low.1 / (low.1 - beyond)).clamp(0.1, 0.9);
        }
        Ok(s)
    }
}

/// Trials of a line search.
const SEARCH: usize = 20;
