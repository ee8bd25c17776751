//! A plate whose layers may separate: K and M of its cells, and the tractions of the interfaces that are open.

mod growth;
mod path;
mod structure;
mod tied;

use super::cell_map::CellMap;
use super::krylov::Krylov;
use super::released::Released;
use super::{AssemblyError, FactorError, LawPlate, Matrix, Pattern, PatternError, Symmetric, assemble, pattern};
use crate::contracts::element::{Element, ElementError};
use crate::contracts::interface_law::Jump;
use crate::contracts::structure::Stretching;
use crate::plates::constraint::{ConstraintError, Constraints, Equation};
use crate::plates::interfaces::{InterfaceAnswer, InterfaceCell, Interfaces};
use crate::plates::plate::Plate;
use crate::plates::springs::SupportSpring;
use crate::words::counters::Counters;
use crate::words::energy::Energy;
use std::collections::BTreeMap;
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::Arc;
use tied::{Factored, Left, Tied};

pub use growth::Growth;
pub use path::{Path, PathEnd, PathError, PathPoint};

/// Residual at which a system with the tangent counts as solved, relative, in the norm of the energy on the factor.
const SOLVED: f64 = 1e-4;

/// Directions before a system counts as not to be solved with the factor at hand.
const MOST: usize = 150;

/// Directions from which on the factor is renewed at the next tangent.
const STALE: usize = 25;

/// Why a plate cannot separate.
#[derive(Debug, Clone)]
pub enum SeparableError {
    /// Supports that contradict each other.
    Constraints(ConstraintError),
    /// A cell that cannot be integrated, a law that finds no traction.
    Assembly(AssemblyError),
    /// A stiffness that is not positive definite, or too large.
    Factor(FactorError),
    /// A spring that holds what no cell holds together.
    Springs(PatternError),
    /// A system with the tangent that was not solved; its residual, relative.
    Unsolved(f64),
}

impl fmt::Display for SeparableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constraints(error) => error.fmt(f),
            Self::Assembly(error) => error.fmt(f),
            Self::Factor(FactorError::NotPositive { .. }) => {
                f.write_str("the stiffness is not positive definite: a part of the plate is not held, or has come off")
            }
            Self::Factor(error) => error.fmt(f),
            Self::Springs(error) => error.fmt(f),
            Self::Unsolved(residual) => {
                write!(f, "a system with the tangent of the interfaces was solved to {residual:.1e} only")
            }
        }
    }
}
impl std::error::Error for SeparableError {}

/// Work done on a plate that separates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SeparableWork {
    /// Cells integrated or answered.
    pub cells: u64,
    /// Factorisations.
    pub factorisations: u64,
    /// Right-hand sides solved for.
    pub solves: u64,
    /// Times that interfaces were opened.
    pub openings: u64,
}

/// How a plate that may separate is held, and by what.
#[derive(Debug, Clone)]
pub struct SeparableParts {
    /// The plate, whose layers are [separate](Plate::separate) where they may come apart.
    pub plate: Plate,
    /// Its element.
    pub element: Box<dyn Element>,
    /// Its supports.
    pub supports: Vec<Equation>,
    /// The same eliminated, the layers apart.
    pub constraints: Constraints,
    /// Its springs, of the independent unknowns; those that only push let go where it lifts.
    pub springs: Vec<SupportSpring>,
    /// The interfaces.
    pub interfaces: Interfaces,
    /// When they open.
    pub growth: Growth,
    /// The plies that follow laws, if some do; their states follow those of the interfaces.
    pub plies: Option<LawPlate>,
    /// Motions as a whole that the supports leave free, of the independent unknowns; `ndof × any`, column-major.
    pub motions: Vec<f64>,
}

/// A plate whose layers may separate.
///
/// f(ũ) = K ũ + Cᵀ Σ ∫ Nᵀ t(N (u⁺ − u⁻)) dA, the sum over the open cells of its [`Interfaces`], ũ with both sides of all nodes that may
/// separate. Where a cell around a node is closed, its two sides move as one: u⁺ = u⁻ there, ũ = T y with y the unknowns that are
/// left. What is closed is rigid and costs no unknown of a factorisation; which cells are open is part of their state. K has the springs,
/// those that only push as if they pulled, and f has not what they would pull.
///
/// Systems with the tangent A = K + cm M + D, D of the interfaces and of springs that have let go, are solved in y by GMRES with the
/// factor of an older Tᵀ (K + cm M + D̄) T, D̄ without what makes it indefinite. D is multiplied cell by cell: no tangent is ever assembled.
pub struct Separable {
    parts: SeparableParts,
    /// States of each cell of the interfaces.
    first: Vec<usize>,
    /// What of the forces beside the corners of cells belongs to them.
    beside: BTreeMap<usize, Vec<(usize, f64)>>,
    threads: NonZeroUsize,
    /// K and M of both sides.
    k: Symmetric,
    m: Symmetric,
    released: Released,
    stretched: Option<Arc<dyn Stretching>>,
    /// Of each cell of the interfaces.
    maps: Vec<CellMap>,
    tied: Tied,
    /// The tangent: factor on the mass, and what it has beside K and M.
    cm: f64,
    local: Local,
    /// What of the dissipation of the last internal force was friction, J.
    friction: f64,
    krylov: Krylov,
    arrays: Arrays,
    work: SeparableWork,
}

/// What a tangent has beside K and M.
#[derive(Debug, Clone, PartialEq, Default)]
struct Local {
    /// Of each cell of the interfaces, times its weight; none where it is closed.
    moduli: Vec<Vec<[Jump; 3]>>,
    /// Which springs have let go.
    lifted: Vec<bool>,
}

impl Local {
    /// Whether interfaces resist every opening; springs that hold always do.
    fn is_definite(&self) -> bool {
        let definite =
            |m: &[Jump; 3]| (0..3).all(|i| (0..3).all(|j| if i == j { m[i][j] >= 0.0 } else { m[i][j] == 0.0 }));
        self.moduli.iter().flatten().all(definite)
    }

    /// Springs by whether they have let go.
    fn springs<'a>(&'a self, parts: &'a SeparableParts, lifted: bool) -> impl Iterator<Item = &'a SupportSpring> {
        parts.springs.iter().zip(&self.lifted).filter(move |(_, own)| **own == lifted).map(|(spring, _)| spring)
    }
}

#[derive(Debug, Default)]
struct Arrays {
    all: Vec<f64>,
    both: Vec<f64>,
    apart: Vec<f64>,
    answer: InterfaceAnswer,
    right: Vec<f64>,
    full: Vec<f64>,
    image: Vec<f64>,
}

impl fmt::Debug for Separable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let open = self.tied.open.iter().filter(|open| **open).count();
        f.debug_struct("Separable").field("ndof", &self.ndof()).field("open", &open).finish_non_exhaustive()
    }
}

impl Separable {
    /// The plate with those interfaces open that `states` say; M is left zero where `inertia` is not wanted.
    ///
    /// # Errors
    /// See [`SeparableError`].
    pub fn new(
        mut parts: SeparableParts,
        states: &[f64],
        inertia: bool,
        threads: NonZeroUsize,
    ) -> Result<Self, SeparableError> {
        parts.plies.iter_mut().for_each(|plies| plies.share(threads));
        let SeparableParts { plate, element, constraints, interfaces, .. } = &parts;
        let first = interfaces.first_states();
        let pattern = Arc::new(pattern(plate, constraints));
        let mut counters = Counters::default();
        let mut matrix = |which| {
            assemble(plate, &**element, constraints, &pattern, which, threads, &mut counters)
                .map_err(SeparableError::Assembly)
        };
        let mut k = matrix(Matrix::Stiffness)?;
        for spring in &parts.springs {
            k.add_spring(spring.stiffness, &spring.at).map_err(SeparableError::Springs)?;
        }
        let m = if inertia { matrix(Matrix::Mass)? } else { Symmetric::zero(pattern.clone()) };
        let map = |cell: &InterfaceCell| {
            let mut map = CellMap::default();
            map.set_unknowns(&[&cell.unknowns.below[..], &cell.unknowns.above[..]].concat(), constraints);
            map
        };
        let maps = interfaces.cells().iter().map(map).collect();
        let tied = Tied::new(&parts, open_cells(&first, states), threads)?;
        let released = Released::new(&k, &m, &parts.motions);
        let beside = growth::beside(&parts.plate);
        Ok(Self {
            parts,
            beside,
            first,
            threads,
            k,
            m,
            released,
            stretched: None,
            maps,
            tied,
            cm: 0.0,
            local: Local::default(),
            friction: 0.0,
            krylov: Krylov::default(),
            arrays: Arrays::default(),
            work: SeparableWork { cells: counters.elements, ..SeparableWork::default() },
        })
    }

    /// The pattern of what is factorised of a plate whose interfaces are in `states`: both sides of what is closed are one.
    ///
    /// # Errors
    /// Supports that contradict each other.
    pub fn joined(
        plate: &Plate,
        supports: &[Equation],
        interfaces: &Interfaces,
        states: &[f64],
    ) -> Result<Arc<Pattern>, SeparableError> {
        let open = open_cells(&interfaces.first_states(), states);
        Ok(Left::new(plate, supports, interfaces, &open)?.pattern)
    }

    /// Number of unknowns, both sides of what is closed counted.
    pub fn ndof(&self) -> usize {
        self.parts.constraints.ndof()
    }

    /// What it is made of.
    pub fn parts(&self) -> &SeparableParts {
        &self.parts
    }

    /// Has the laws of the plies, and the tractions at which interfaces open, see how deflections stretch the plate.
    ///
    /// # Errors
    /// A cell that is folded.
    pub fn stretch(&mut self, by: &Arc<dyn Stretching>) -> Result<(), SeparableError> {
        self.stretched = Some(by.clone());
        self.parts.plies.iter_mut().try_for_each(|plies| plies.stretch(by.clone())).map_err(SeparableError::Assembly)
    }

    /// States of a cell of the interfaces among those of all.
    pub fn states_of(&self, cell: usize) -> std::ops::Range<usize> {
        self.first[cell]..self.first[cell + 1]
    }

    /// Which cells of the interfaces are open, as it was last asked about them.
    pub fn open(&self) -> &[bool] {
        &self.tied.open
    }

    /// Unknowns that are left where both sides of what is closed are one, and entries of their factor.
    pub fn size(&self) -> (usize, usize) {
        (self.tied.ndof(), self.tied.entries)
    }

    /// Norm of forces on the unknowns that are left.
    fn size_of(&self, forces: &[f64]) -> f64 {
        let mut left = vec![0.0; self.tied.ndof()];
        self.tied.restrict(forces, &mut left);
        super::equilibrium::dot(&left, &left).sqrt()
    }

    /// Work done so far.
    pub fn work(&self) -> SeparableWork {
        self.work
    }

    /// Opens and closes cells as `states` say.
    fn take(&mut self, states: &[f64]) -> Result<(), SeparableError> {
        let open = open_cells(&self.first, states);
        if open != self.tied.open {
            self.tied = Tied::new(&self.parts, open, self.threads)?;
            self.work.openings += 1;
        }
        Ok(())
    }

    /// Internal force at the displacements `u`, of interfaces in the states `states`; returns the work done, J.
    ///
    /// # Errors
    /// A law that finds no traction.
    pub fn internal(&mut self, u: &[f64], states: &[f64], force: &mut [f64]) -> Result<Energy, SeparableError> {
        self.take(states)?;
        force.fill(0.0);
        self.k.add_product(1.0, u, force);
        let mut energy = Energy { stored: 0.5 * super::equilibrium::dot(u, force), dissipated: 0.0 };
        for (spring, w) in self.parts.springs.iter().filter_map(|spring| Some((spring, spring.lift(u)?))) {
            spring.at.add_to(-spring.stiffness * w, force);
            energy.stored -= 0.5 * spring.stiffness * w * w;
        }
        if let Some(plies) = &mut self.parts.plies {
            let own = &states[self.first[self.first.len() - 1]..];
            let Energy { stored, dissipated } = plies.add(u, own, force).map_err(SeparableError::Assembly)?;
            energy.stored += stored;
            energy.dissipated += dissipated;
        }
        let mut friction = 0.0;
        self.each(u, states, None, false, |arrays, weight, map, cell| {
            friction += weight * arrays.answer.dissipated.friction;
            energy.stored += weight * (arrays.answer.stored - Interfaces::lent(cell));
            energy.dissipated += weight * arrays.answer.dissipated.total();
            map.scatter_vector(&arrays.both, weight, force);
        })?;
        self.friction = friction;
        Ok(energy)
    }

    /// Takes `u` into the states, and opens what is then to be opened.
    ///
    /// # Errors
    /// As [`Separable::internal`].
    pub fn commit(&mut self, u: &[f64], states: &mut [f64]) -> Result<(), SeparableError> {
        let (own, points) = states.split_at_mut(self.first[self.first.len() - 1]);
        let old = own.to_vec();
        self.each(u, &old, Some(own), false, |_, _, _, _| ())?;
        if let Some(plies) = &mut self.parts.plies {
            plies.commit(u, points).map_err(SeparableError::Assembly)?;
        }
        self.grow(u, states);
        Ok(())
    }

    /// Takes the tangent at `u`: `cm` M + ∂f/∂u.
    ///
    /// # Errors
    /// As [`Separable::internal`]; a factor that is not positive definite.
    pub fn linearise(&mut self, u: &[f64], states: &[f64], cm: f64) -> Result<(), SeparableError> {
        self.take(states)?;
        let Local { mut moduli, mut lifted } = std::mem::take(&mut self.local);
        moduli.resize_with(self.maps.len(), Vec::new);
        moduli.iter_mut().for_each(Vec::clear);
        let mut number = 0;
        let open = self.tied.open.clone();
        self.each(u, states, None, true, |arrays, weight, _, _| {
            while !open[number] {
                number += 1;
            }
            moduli[number].extend(arrays.answer.moduli.iter().map(|m| m.map(|row| row.map(|v| weight * v))));
            number += 1;
        })?;
        lifted.clear();
        lifted.extend(self.parts.springs.iter().map(|spring| spring.lift(u).is_some()));
        self.local = Local { moduli, lifted };
        self.cm = cm;
        if self.tied.factored != Factored::Near(cm) || self.tied.stale {
            self.factorise()?;
        }
        self.tied.compare(&self.local);
        Ok(())
    }

    fn factorise(&mut self) -> Result<(), SeparableError> {
        self.work.factorisations += 1;
        let near = Factored::Near(self.cm);
        self.tied.factorise(&self.parts, near, &self.local, self.released.springs(), self.threads)
    }

    /// `x ← T (Tᵀ A T)⁻¹ Tᵀ x` with the last tangent: the displacements under forces x; at rest (cm = 0) in the frame that moves with the
    /// plate, where that is free to.
    ///
    /// # Errors
    /// [`SeparableError::Unsolved`].
    pub fn solve(&mut self, x: &mut [f64]) -> Result<(), SeparableError> {
        let at_rest = self.cm == 0.0;
        if at_rest {
            self.released.balance(x, 1);
        }
        self.solve_tied(x)?;
        if at_rest {
            self.released.deform(x, 1);
        }
        Ok(())
    }

    fn solve_tied(&mut self, x: &mut [f64]) -> Result<(), SeparableError> {
        let mut right = vec![0.0; self.tied.ndof()];
        self.tied.restrict(x, &mut right);
        if self.tied.exact {
            self.tied.factor.solve(&mut right, 1);
            self.work.solves += 1;
            self.tied.way.expand(&right, x);
            return Ok(());
        }
        let mut y = Vec::new();
        for renewed in [false, true] {
            if renewed {
                self.factorise()?;
            }
            y.clear();
            y.extend_from_slice(&right);
            let Self { parts, k, m, maps, tied, cm, local, krylov, arrays, .. } = self;
            let Tied { way, factor, .. } = tied;
            let tangent = Tangent { parts, k, m, cm: *cm, maps, local };
            let product = |x: &[f64], y: &mut [f64]| {
                let (mut full, mut image) = (std::mem::take(&mut arrays.full), std::mem::take(&mut arrays.image));
                full.resize(k.ndof(), 0.0);
                image.clear();
                image.resize(k.ndof(), 0.0);
                way.expand(x, &mut full);
                tangent.add_product(&full, &mut image, arrays);
                way.restrict(&image, y);
                (arrays.full, arrays.image) = (full, image);
            };
            let (count, residual) = krylov.solve(product, |x| factor.solve(x, 1), &mut y, SOLVED, MOST);
            self.work.solves += 1 + count as u64;
            self.tied.stale |= count > STALE;
            if residual <= SOLVED {
                self.tied.way.expand(&y, x);
                return Ok(());
            }
            if renewed {
                return Err(SeparableError::Unsolved(residual));
            }
        }
        Ok(())
    }

    /// `x ← T (Tᵀ A T)⁻¹ Tᵀ x`, A = M, or K + cm M with the stiffness of what is open, undamaged, and all springs.
    fn solve_with(&mut self, what: Factored, x: &mut [f64]) -> Result<(), SeparableError> {
        let Self { parts, released, tied, arrays, work, threads, .. } = self;
        if tied.factored != what {
            let mut moduli = vec![Vec::new(); parts.interfaces.cells().len()];
            for (cell, moduli) in moduli.iter_mut().enumerate().filter(|(cell, _)| tied.open[*cell]) {
                parts.interfaces.undamaged(cell, moduli);
            }
            let local = Local { moduli, lifted: vec![false; parts.springs.len()] };
            tied.factorise(parts, what, &local, released.springs(), *threads)?;
            work.factorisations += 1;
        }
        let at_rest = what == Factored::Undamaged(0.0);
        if at_rest {
            released.balance(x, 1);
        }
        let y = &mut arrays.right;
        y.resize(tied.ndof(), 0.0);
        tied.restrict(x, y);
        tied.factor.solve(y, 1);
        work.solves += 1;
        tied.way.expand(y, x);
        if at_rest {
            released.deform(x, 1);
        }
        Ok(())
    }

    fn each(
        &mut self,
        u: &[f64],
        states: &[f64],
        mut new: Option<&mut [f64]>,
        moduli: bool,
        mut take: impl FnMut(&mut Arrays, f64, &mut CellMap, &[f64]),
    ) -> Result<(), SeparableError> {
        let Self { parts, first, maps, arrays, work, .. } = self;
        let SeparableParts { plate, constraints, interfaces, .. } = parts;
        arrays.all.resize(plate.ndof(), 0.0);
        constraints.expand(u, &mut arrays.all);
        for (number, (map, cell)) in maps.iter_mut().zip(interfaces.cells()).enumerate() {
            let own = first[number]..first[number + 1];
            if !Interfaces::is_open(&states[own.clone()]) {
                continue;
            }
            work.cells += 1;
            arrays.gather(map, interfaces.components(number).len());
            let new = new.as_deref_mut().map(|new| &mut new[own.clone()]);
            let failed = |error| {
                let quad_tag = plate.plane.quad_tags[cell.quad];
                SeparableError::Assembly(AssemblyError { quad_tag, layer: cell.face, error })
            };
            interfaces
                .respond(number, &arrays.apart, &states[own.clone()], new, moduli, &mut arrays.answer)
                .map_err(failed)?;
            if !(arrays.answer.stored + arrays.answer.dissipated.total()).is_finite() {
                return Err(failed(ElementError("the energy of its interface is not finite".into())));
            }
            arrays.spread();
            take(arrays, cell.weight, map, &states[own]);
        }
        Ok(())
    }
}

/// Which cells are open by their states.
fn open_cells(first: &[usize], states: &[f64]) -> Vec<bool> {
    first[..first.len() - 1].iter().map(|at| Interfaces::is_open(&states[*at..])).collect()
}

impl Arrays {
    /// Differences of the unknowns of a cell, above minus below.
    fn gather(&mut self, map: &CellMap, n: usize) {
        self.both.resize(2 * n, 0.0);
        map.gather(&self.all, &mut self.both);
        let (below, above) = self.both.split_at(n);
        self.apart.clear();
        self.apart.extend(above.iter().zip(below).map(|(above, below)| above - below));
    }

    /// The force on a face as forces on both.
    fn spread(&mut self) {
        let force = &self.answer.force;
        self.both.clear();
        self.both.extend(force.iter().map(|f| -f));
        self.both.extend_from_slice(force);
    }
}

/// A tangent that is multiplied cell by cell.
struct Tangent<'a> {
    parts: &'a SeparableParts,
    k: &'a Symmetric,
    m: &'a Symmetric,
    cm: f64,
    maps: &'a [CellMap],
    local: &'a Local,
}

impl Tangent<'_> {
    fn add_product(&self, x: &[f64], y: &mut [f64], arrays: &mut Arrays) {
        let SeparableParts { plate, constraints, interfaces, .. } = self.parts;
        self.k.add_product(1.0, x, y);
        if self.cm != 0.0 {
            self.m.add_product(self.cm, x, y);
        }
        for spring in self.local.springs(self.parts, true) {
            spring.at.add_to(-spring.stiffness * spring.at.of(x), y);
        }
        arrays.all.resize(plate.ndof(), 0.0);
        constraints.expand(x, &mut arrays.all);
        for (cell, (map, moduli)) in
            self.maps.iter().zip(&self.local.moduli).enumerate().filter(|(_, m)| !m.1.is_empty())
        {
            let n = interfaces.components(cell).len();
            arrays.gather(map, n);
            let Arrays { apart, answer, .. } = arrays;
            answer.force.resize(n, 0.0);
            interfaces.apply(cell, moduli, apart, &mut answer.force);
            arrays.spread();
            map.scatter_vector(&arrays.both, 1.0, y);
        }
    }
}
