//! Internal forces of a plate whose plies follow laws.

use super::alike::Alike;
use super::cell_map::CellMap;
use super::equilibrium::{EquilibriumError, InternalForce, dot};
use super::membrane::MembraneStrains;
use super::{AssemblyError, Symmetric};
use crate::contracts::element::{Element, ElementError, form};
use crate::contracts::structure::Stretching;
use crate::plates::constraint::Constraints;
use crate::plates::laws::{Asked, CellAnswer, CellOperators, Patterns, PlyLaws};
use crate::plates::plate::Plate;
use crate::words::energy::Energy;
use std::sync::Arc;

/// The plies of a plate that follow laws, as forces on the independent unknowns.
///
/// f(ũ) = K ũ + Cᵀ Σ ∫ Bᵀ (σ − C ε) dV, the sum over the cells with such plies: cells without cost nothing beyond their part of K. In a
/// plate that is [stretched](LawPlate::stretch) ε has the strains of that as well, and σ does work on them.
///
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
    stretched: Option<Stretched>,
}

/// A plate that its deflections stretch, with arrays to work in.
#[derive(Debug, Clone)]
struct Stretched {
    by: Arc<dyn Stretching>,
    /// Strains of the patterns in each cell that follows laws.
    strains: Vec<Vec<f64>>,
    completed: Vec<f64>,
    amounts: Vec<f64>,
    /// Forces conjugate to both.
    on_completed: Vec<f64>,
    on_amounts: Vec<f64>,
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
            stretched: None,
        }
    }

    /// Has the plate stretched by its deflections.
    ///
    /// # Errors
    /// A cell that is folded.
    pub fn stretch(&mut self, by: Arc<dyn Stretching>) -> Result<(), AssemblyError> {
        let Self { plate, element, constraints, cells, .. } = self;
        let patterns = MembraneStrains::new(plate, &**element, constraints, by.deflections());
        let of = |LawCell { cell, .. }: &LawCell| {
            patterns.of_cell(*cell, by.combinations()).map_err(|error| {
                let (quad, layer) = plate.place(*cell);
                AssemblyError { quad_tag: plate.plane.quad_tags[quad], layer, error }
            })
        };
        let strains = cells.iter().map(of).collect::<Result<_, _>>()?;
        let zero = vec![0.0; constraints.ndof()];
        let (on_completed, amounts, on_amounts) = (zero.clone(), Vec::new(), Vec::new());
        self.stretched = Some(Stretched { by, strains, completed: zero, amounts, on_completed, on_amounts });
        Ok(())
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
        self.each(u, &old, Some(points), None, None)?;
        Ok(())
    }

    /// Adds the force beyond that of K to `force`; returns the energies beyond those of K, J.
    ///
    /// # Errors
    /// A law that finds no stress.
    pub fn add(&mut self, u: &[f64], points: &[f64], force: &mut [f64]) -> Result<Energy, AssemblyError> {
        self.each(u, points, None, Some(force), None)
    }

    /// The plate with K, at the states `points`.
    pub fn on<'a>(&'a mut self, k: &'a Symmetric, points: &'a [f64]) -> LawForce<'a> {
        LawForce { k, laws: self, points }
    }

    /// Asks all cells; takes what is wanted of their answers, and the energies beyond those of K.
    fn each(
        &mut self,
        u: &[f64],
        points: &[f64],
        mut new: Option<&mut [f64]>,
        mut force: Option<&mut [f64]>,
        mut tangent: Option<&mut Symmetric>,
    ) -> Result<Energy, AssemblyError> {
        let Self {
            plate,
            element,
            constraints,
            laws,
            cells,
            shapes,
            room,
            all,
            u: local,
            answer,
            integrated,
            stretched,
        } = self;
        *integrated += cells.len() as u64;
        match stretched {
            Some(stretched) => constraints.expand(stretched.begin(u), all),
            None => constraints.expand(u, all),
        }
        let mut energy = Energy::default();
        let mut passing = None;
        for (number, LawCell { cell, weight, shape, map }) in cells.iter_mut().enumerate() {
            let states = laws.states_of(*cell);
            let element = form(&**element, plate.plane.quads[plate.place(*cell).0].domain());
            let n = element.info().ndof();
            local.resize(n, 0.0);
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
            let patterns = stretched.as_ref().map(|stretched| stretched.of(number));
            let states = &points[states];
            let asked = Asked { plate, element, cell: *cell, operators, u: local, stretched: patterns, states };
            let finite = |answer: &CellAnswer| answer.energy.total().is_finite();
            let refused = || ElementError("its strain energy is not finite".into());
            laws.respond(asked, new, tangent.is_some(), answer)
                .and_then(|()| if finite(answer) { Ok(()) } else { Err(refused()) })
                .map_err(failed)?;
            energy.stored += *weight * answer.energy.stored;
            energy.dissipated += *weight * answer.energy.dissipated;
            match (&mut force, &mut *stretched) {
                (Some(_), Some(stretched)) => stretched.take(map, *weight, answer),
                (Some(force), None) => map.scatter_vector(&answer.force, *weight, force),
                (None, _) => {}
            }
            if let Some(tangent) = &mut tangent {
                map.scatter(&answer.tangent, *weight, tangent);
            }
        }
        if let (Some(force), Some(Stretched { by, on_completed, on_amounts, .. })) = (force, stretched) {
            by.restrict(u, on_completed, on_amounts, force);
        }
        Ok(energy)
    }
}

impl Stretched {
    /// The displacements at `u`, with what follows at once.
    fn begin(&mut self, u: &[f64]) -> &[f64] {
        self.by.expand(u, &mut self.completed, &mut self.amounts);
        self.on_completed.fill(0.0);
        self.on_amounts.clear();
        self.on_amounts.resize(self.amounts.len(), 0.0);
        &self.completed
    }

    fn of(&self, cell: usize) -> Patterns<'_> {
        Patterns { strains: &self.strains[cell], amounts: &self.amounts }
    }

    fn take(&mut self, map: &mut CellMap, weight: f64, answer: &CellAnswer) {
        map.scatter_vector(&answer.force, weight, &mut self.on_completed);
        self.on_amounts.iter_mut().zip(&answer.on_patterns).for_each(|(sum, work)| *sum += weight * work);
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
        let Energy { stored, dissipated } = laws.each(u, points, None, Some(force), tangent)?;
        energy.stored += stored;
        energy.dissipated += dissipated;
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
