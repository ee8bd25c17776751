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
use std::num::NonZeroUsize;
use std::sync::Arc;

/// The plies of a plate that follow laws, as forces on the independent unknowns.
///
/// f(ũ) = K ũ + Cᵀ Σ ∫ Bᵀ (σ − C ε) dV, the sum over the cells with such plies: cells without cost nothing beyond their part of K. In a
/// plate that is [stretched](LawPlate::stretch) ε has the strains of that as well, and σ does work on them.
///
/// Threads share the cells; what they find is added in the order of the cells, so that sums are the same for any number of threads.
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
    /// Displacements before elimination.
    all: Vec<f64>,
    /// One for each thread.
    askers: Vec<Asker>,
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

/// Cells that a thread asks at a time, of which it keeps the answers until they are added.
const TOGETHER: usize = 64;

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
            element,
            askers: vec![Asker::default()],
            integrated: 0,
            stretched: None,
        }
    }

    /// Has its cells shared by so many threads.
    pub fn share(&mut self, threads: NonZeroUsize) {
        self.askers.resize_with(threads.get(), Asker::default);
    }

    /// Has the plate stretched by its deflections.
    ///
    /// # Errors
    /// A cell that is folded.
    pub fn stretch(&mut self, by: Arc<dyn Stretching>) -> Result<(), AssemblyError> {
        let Self { plate, element, constraints, cells, .. } = self;
        let patterns = MembraneStrains::new(plate, &**element, constraints, by.deflections());
        let of = |LawCell { cell, .. }: &LawCell| {
            patterns.of_cell(*cell, by.combinations()).map_err(|why| failed(plate, *cell, why))
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
        if points.is_empty() { Ok(()) } else { self.each(u, States::Taken(points), None, None).map(|_| ()) }
    }

    /// Adds the force beyond that of K to `force`; returns the energies beyond those of K, J.
    ///
    /// # Errors
    /// A law that finds no stress.
    pub fn add(&mut self, u: &[f64], points: &[f64], force: &mut [f64]) -> Result<Energy, AssemblyError> {
        self.each(u, States::Tried(points), Some(force), None)
    }

    /// The plate with K, at the states `points`.
    pub fn on<'a>(&'a mut self, k: &'a Symmetric, points: &'a [f64]) -> LawForce<'a> {
        LawForce { k, laws: self, points }
    }

    /// Finds the operators of the shapes for which there is room.
    fn know_shapes(&mut self) -> Result<(), AssemblyError> {
        let Self { plate, element, cells, shapes, room, .. } = self;
        for LawCell { cell, shape, .. } in cells {
            if *room > 0 && shapes[*shape].is_none() {
                let element = form(&**element, plate.plane.quads[plate.place(*cell).0].domain());
                let found = CellOperators::new(element, &plate.cell(*cell)).map_err(|why| failed(plate, *cell, why))?;
                shapes[*shape] = Some(found);
                *room -= 1;
            }
        }
        // Those that are left are found whenever they are needed.
        *room = 0;
        Ok(())
    }

    /// Asks all cells; takes what is wanted of their answers, and the energies beyond those of K.
    fn each(
        &mut self,
        u: &[f64],
        mut states: States<'_>,
        mut force: Option<&mut [f64]>,
        mut tangent: Option<&mut Symmetric>,
    ) -> Result<Energy, AssemblyError> {
        if self.room > 0 {
            self.know_shapes()?;
        }
        let Self { plate, element, constraints, laws, cells, shapes, all, askers, integrated, stretched, .. } = self;
        *integrated += cells.len() as u64;
        match stretched {
            Some(stretched) => constraints.expand(stretched.begin(u), all),
            None => constraints.expand(u, all),
        }
        let (mut energy, mut seen, mut number) = (Energy::default(), 0, 0);
        for cells in cells.chunks_mut(TOGETHER * askers.len()) {
            let share = cells.len().div_ceil(askers.len());
            let part = |cells: &[LawCell]| {
                let own = laws.states_of(cells[0].cell).start..laws.states_of(cells[cells.len() - 1].cell).end;
                states.split_off(own.start - seen);
                seen = own.end;
                (own.start, states.split_off(own.len()))
            };
            let parts: Vec<_> = cells.chunks(share).map(part).collect();
            let tangents = tangent.is_some();
            let common =
                Asking { plate, element: &**element, laws, shapes, all, stretched: stretched.as_ref(), tangents };
            let asking = askers
                .iter_mut()
                .zip(cells.chunks(share))
                .zip(parts)
                .zip((number..number + cells.len()).step_by(share));
            let asking = asking.map(|(((asker, cells), states), number)| (asker, cells, states, number));
            common.all(asking)?;
            for (asker, cells) in askers.iter().zip(cells.chunks_mut(share)) {
                let amounts = stretched.as_ref().map_or(0, |stretched| stretched.amounts.len());
                let (mut forces, mut moduli) = (&asker.forces[..], &asker.tangents[..]);
                for (k, (LawCell { cell, weight, map, .. }, found)) in cells.iter_mut().zip(&asker.energies).enumerate()
                {
                    energy.stored += *weight * found.stored;
                    energy.dissipated += *weight * found.dissipated;
                    let n = plate.info_of(plate.place(*cell).0).ndof();
                    let own = forces.split_off(..n).unwrap_or_default();
                    match (&mut force, &mut *stretched) {
                        (Some(_), Some(stretched)) => {
                            stretched.take(map, *weight, (own, &asker.works[k * amounts..][..amounts]));
                        }
                        (Some(force), None) => map.scatter_vector(own, *weight, force),
                        (None, _) => {}
                    }
                    if let Some(tangent) = &mut tangent {
                        map.scatter(moduli.split_off(..n * n).unwrap_or_default(), *weight, tangent);
                    }
                }
            }
            number += cells.len();
        }
        if let (Some(force), Some(Stretched { by, on_completed, on_amounts, .. })) = (force, stretched) {
            by.restrict(u, on_completed, on_amounts, force);
        }
        Ok(energy)
    }
}

fn failed(plate: &Plate, cell: usize, error: ElementError) -> AssemblyError {
    let (quad, layer) = plate.place(cell);
    AssemblyError { quad_tag: plate.plane.quad_tags[quad], layer, error }
}

/// States of points, in which answers leave theirs or not.
enum States<'a> {
    Tried(&'a [f64]),
    Taken(&'a mut [f64]),
}

impl<'a> States<'a> {
    /// The first `count` of them, without which they go on.
    fn split_off(&mut self, count: usize) -> Self {
        match self {
            Self::Tried(all) => Self::Tried(all.split_off(..count).unwrap_or_default()),
            Self::Taken(all) => Self::Taken(all.split_off_mut(..count).unwrap_or_default()),
        }
    }

    fn all(&self) -> &[f64] {
        match self {
            Self::Tried(all) => all,
            Self::Taken(all) => all,
        }
    }
}

/// A thread's answers of some cells, and its work arrays.
#[derive(Debug, Clone, Default)]
struct Asker {
    u: Vec<f64>,
    answer: CellAnswer,
    energies: Vec<Energy>,
    forces: Vec<f64>,
    works: Vec<f64>,
    tangents: Vec<f64>,
}

/// What all cells have in common.
struct Asking<'a> {
    plate: &'a Plate,
    element: &'a dyn Element,
    laws: &'a PlyLaws,
    shapes: &'a [Option<CellOperators>],
    all: &'a [f64],
    stretched: Option<&'a Stretched>,
    tangents: bool,
}

/// Who asks which cells, with their states, which begin at a place of all, and the number of the first cell.
type Part<'a> = (&'a mut Asker, &'a [LawCell], (usize, States<'a>), usize);

impl Asking<'_> {
    /// Each part by a thread of its own.
    fn all<'a>(&self, mut parts: impl ExactSizeIterator<Item = Part<'a>>) -> Result<(), AssemblyError> {
        if parts.len() == 1 {
            return parts.try_for_each(|part| self.ask(part));
        }
        std::thread::scope(|scope| {
            let threads: Vec<_> = parts.map(|part| scope.spawn(|| self.ask(part))).collect();
            threads.into_iter().try_for_each(|thread| match thread.join() {
                Ok(result) => result,
                Err(panic) => std::panic::resume_unwind(panic),
            })
        })
    }

    fn ask(&self, (asker, cells, (from, mut states), first): Part<'_>) -> Result<(), AssemblyError> {
        let Self { plate, element, laws, shapes, all, stretched, tangents } = *self;
        let Asker { u, answer, energies, forces, works, tangents: found } = asker;
        energies.clear();
        [&mut *forces, &mut *works, &mut *found].into_iter().for_each(Vec::clear);
        for (LawCell { cell, shape, map, .. }, number) in cells.iter().zip(first..) {
            let failed = |error| failed(plate, *cell, error);
            let element = form(element, plate.plane.quads[plate.place(*cell).0].domain());
            u.resize(element.info().ndof(), 0.0);
            map.gather(all, u);
            let passing;
            let operators = match &shapes[*shape] {
                Some(operators) => operators,
                None => {
                    passing = CellOperators::new(element, &plate.cell(*cell)).map_err(failed)?;
                    &passing
                }
            };
            let own = laws.states_of(*cell);
            let own = own.start - from..own.end - from;
            let stretched = stretched.map(|stretched| stretched.of(number));
            let asked =
                Asked { plate, element, cell: *cell, operators, u, stretched, states: &states.all()[own.clone()] };
            laws.respond(asked, tangents, answer).map_err(failed)?;
            if !answer.energy.total().is_finite() {
                return Err(failed(ElementError("its strain energy is not finite".into())));
            }
            if let States::Taken(states) = &mut states {
                states[own].copy_from_slice(&answer.states);
            }
            energies.push(answer.energy);
            forces.extend_from_slice(&answer.force);
            works.extend_from_slice(&answer.on_patterns);
            found.extend_from_slice(&answer.tangent);
        }
        Ok(())
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

    /// Takes the force of a cell and its work on the patterns.
    fn take(&mut self, map: &CellMap, weight: f64, (force, works): (&[f64], &[f64])) {
        map.scatter_vector(force, weight, &mut self.on_completed);
        self.on_amounts.iter_mut().zip(works).for_each(|(sum, work)| *sum += weight * work);
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
        let Energy { stored, dissipated } = laws.each(u, States::Tried(points), Some(force), tangent)?;
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
