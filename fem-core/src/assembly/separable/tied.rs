//! The unknowns that are left where both sides of what is closed are one, and a factor in them.

use super::{Local, SeparableError, SeparableParts};
use crate::assembly::cell_map::CellMap;
use crate::assembly::ordering::joined_order;
use crate::assembly::pattern::joined_pattern;
use crate::assembly::{Cholesky, Matrix, Pattern, Symbolic, Symmetric, assemble};
use crate::plates::constraint::{Constraints, Equation};
use crate::plates::interfaces::Interfaces;
use crate::plates::plate::Plate;
use crate::words::counters::Counters;
use crate::words::functional::Functional;
use std::collections::HashSet;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// What is open, the unknowns that are left, and a factor of what is near the tangent in them.
pub(super) struct Tied {
    /// Which cells of the interfaces are open.
    pub(super) open: Vec<bool>,
    pub(super) way: Way,
    constraints: Constraints,
    maps: Vec<(usize, CellMap)>,
    near: Symmetric,
    pub(super) factor: Cholesky,
    /// Entries of the factor.
    pub(super) entries: usize,
    pub(super) factored: Factored,
    /// Whether the factor has become too different from the tangent.
    pub(super) stale: bool,
    /// Whether it is that of the tangent.
    pub(super) exact: bool,
    /// What was factorised beside K and M.
    local: Local,
}

/// What a factor is of; with its factor on the mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Factored {
    Nothing,
    Mass,
    /// The plate with what is open undamaged.
    Undamaged(f64),
    /// What is near the tangent.
    Near(f64),
}

/// ũ = T y.
#[derive(Debug, Default)]
pub(super) struct Way {
    starts: Vec<usize>,
    terms: Vec<(usize, f64)>,
}

impl Way {
    /// What an unknown of both sides is, in those that are left.
    fn of(&self, i: usize) -> &[(usize, f64)] {
        &self.terms[self.starts[i]..self.starts[i + 1]]
    }

    pub(super) fn expand(&self, y: &[f64], x: &mut [f64]) {
        for (x, row) in x.iter_mut().zip(self.starts.windows(2)) {
            *x = self.terms[row[0]..row[1]].iter().map(|(i, c)| c * y[*i]).sum();
        }
    }

    /// `y ← Tᵀ x`.
    pub(super) fn restrict(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for (x, row) in x.iter().zip(self.starts.windows(2)) {
            self.terms[row[0]..row[1]].iter().for_each(|(i, c)| y[*i] += c * x);
        }
    }
}

/// What is left where both sides of what is closed are one.
pub(super) struct Left {
    constraints: Constraints,
    /// Of the open cells of the interfaces, with their numbers.
    maps: Vec<(usize, CellMap)>,
    pub(super) pattern: Arc<Pattern>,
}

impl Left {
    pub(super) fn new(
        plate: &Plate,
        supports: &[Equation],
        interfaces: &Interfaces,
        open: &[bool],
    ) -> Result<Self, SeparableError> {
        let cells = || interfaces.cells().iter().enumerate().filter(|(cell, _)| open[*cell]);
        let closed = closed_nodes(plate, interfaces, open);
        let ties = plate.ties(|column, face| closed.contains(&(column, face)));
        let mut joined: Vec<usize> = (0..plate.ndof()).collect();
        ties.iter().for_each(|tie| joined[tie.terms[0].0] = tie.terms[1].0);
        let sets: Vec<Vec<usize>> =
            cells().map(|(_, cell)| [&cell.unknowns.below[..], &cell.unknowns.above[..]].concat()).collect();
        let order = joined_order(plate, &joined, sets.iter().map(Vec::as_slice));
        let equations = [supports, &ties[..]].concat();
        let constraints = Constraints::eliminate(&order, &equations).map_err(SeparableError::Constraints)?;
        let map = |((number, _), dofs): ((usize, _), &Vec<usize>)| {
            let mut map = CellMap::default();
            map.set_unknowns(dofs, &constraints);
            (number, map)
        };
        let maps: Vec<(usize, CellMap)> = cells().zip(&sets).map(map).collect();
        let coupled = maps.iter().map(|(_, map)| &map.reduced[..]);
        let pattern = Arc::new(joined_pattern(plate, &constraints, coupled));
        Ok(Self { constraints, maps, pattern })
    }
}

impl Tied {
    pub(super) fn new(parts: &SeparableParts, open: Vec<bool>, threads: NonZeroUsize) -> Result<Self, SeparableError> {
        let SeparableParts { plate, supports, constraints: full, interfaces, .. } = parts;
        let Left { constraints, maps, pattern } = Left::new(plate, supports, interfaces, &open)?;
        let symbolic = Symbolic::new(pattern.clone()).map_err(SeparableError::Factor)?;
        let mut way = Way { starts: vec![0], terms: Vec::new() };
        for i in 0..full.ndof() {
            way.terms.extend_from_slice(constraints.row(full.original(i)).0);
            way.starts.push(way.terms.len());
        }
        Ok(Self {
            open,
            way,
            constraints,
            maps,
            near: Symmetric::zero(pattern),
            entries: symbolic.entries(),
            factor: Cholesky::new(symbolic, threads),
            factored: Factored::Nothing,
            stale: false,
            exact: false,
            local: Local::default(),
        })
    }

    /// Sees whether the factor is that of a tangent that has this beside K and M.
    pub(super) fn compare(&mut self, local: &Local) {
        self.exact = self.local == *local && local.is_definite();
    }

    pub(super) fn ndof(&self) -> usize {
        self.constraints.ndof()
    }

    /// `y ← Tᵀ x`.
    pub(super) fn restrict(&self, x: &[f64], y: &mut [f64]) {
        self.way.restrict(x, y);
    }

    /// Factorises `what`, with the stiffness of interfaces that `local` leaves definite and the springs that have not let go; at rest
    /// `springs` at unknowns hold a plate that is free to move as a whole.
    pub(super) fn factorise(
        &mut self,
        parts: &SeparableParts,
        what: Factored,
        local: &Local,
        springs: &[(usize, f64)],
        threads: NonZeroUsize,
    ) -> Result<(), SeparableError> {
        let SeparableParts { plate, element, interfaces, .. } = parts;
        let pattern = self.near.pattern().clone();
        let mut counters = Counters::default();
        let mut matrix = |which| {
            assemble(plate, &**element, &self.constraints, &pattern, which, threads, &mut counters)
                .map_err(SeparableError::Assembly)
        };
        self.factored = Factored::Nothing;
        match what {
            Factored::Nothing => return Ok(()),
            Factored::Mass => self.near = matrix(Matrix::Mass)?,
            Factored::Undamaged(cm) | Factored::Near(cm) => {
                self.near = matrix(Matrix::Stiffness)?;
                for held in local.springs(parts, false) {
                    let left =
                        held.at.0.iter().flat_map(|&(i, w)| self.way.of(i).iter().map(move |(j, c)| (*j, w * c)));
                    let at = Functional(left.collect());
                    self.near.add_spring(held.stiffness, &at).map_err(SeparableError::Springs)?;
                }
                if cm != 0.0 {
                    let mass = matrix(Matrix::Mass)?;
                    let near = self.near.lower_mut().val_mut();
                    near.iter_mut().zip(mass.lower().val()).for_each(|(k, m)| *k += cm * m);
                } else {
                    let first = |(i, spring): &(usize, f64)| Some((self.way.of(*i).first()?.0, *spring));
                    self.near.add_to_diagonal(&springs.iter().filter_map(first).collect::<Vec<_>>());
                }
                let mut secant = Vec::new();
                for (cell, map) in &mut self.maps {
                    interfaces.secant(*cell, &local.moduli[*cell], &mut secant);
                    map.scatter(&secant, 1.0, &mut self.near);
                }
                self.local.clone_from(local);
            }
        }
        self.factor.factorise(self.near.lower()).map_err(SeparableError::Factor)?;
        (self.factored, self.stale) = (what, false);
        Ok(())
    }
}

/// Nodes (column, face) around which a cell is closed, or lies beyond what may open.
fn closed_nodes(plate: &Plate, interfaces: &Interfaces, open: &[bool]) -> HashSet<(usize, usize)> {
    let symmetry = plate.symmetry();
    let cells = interfaces.cells().iter().zip(open);
    let open: HashSet<(usize, usize)> = cells.filter(|(_, open)| **open).map(|(c, _)| (c.quad, c.face)).collect();
    let mut faces: Vec<usize> = interfaces.cells().iter().map(|cell| cell.face).collect();
    faces.sort_unstable();
    faces.dedup();
    let mut closed = HashSet::new();
    for face in faces {
        for quad in (0..plate.plane.quads.len()).filter(|quad| !open.contains(&(symmetry.quad(*quad), face))) {
            closed.extend(plate.columns_of_quad(quad).iter().map(|column| (*column as usize, face)));
        }
    }
    closed
}
