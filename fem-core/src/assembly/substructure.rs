//! Substructures: parts of a plate condensed on their outlines, equal parts once (AFWAL-TR-87-4117, eqs 27-30).

use super::alike::GRAIN;
use super::cell_map::CellMap;
use super::inside::Inside;
use super::pattern::Cliques;
use super::{AssemblyError, FactorError, Matrix, Symmetric, assemble, elimination_order, ordering, pattern};
use crate::contracts::element::Element;
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;
use crate::words::counters::Counters;
use crate::words::domain::Corners;
use std::collections::{BTreeMap, HashMap};
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Which cells are condensed together, and what stays beside their outlines.
#[derive(Debug, Clone, PartialEq)]
pub struct Division {
    /// Substructure of each quad; quads of none are assembled as they are.
    pub quads: Vec<Option<u32>>,
    /// Unknowns (before constraints) that stay, wherever they are.
    pub kept: Vec<usize>,
}

/// K* = TᵀKT and M* = TᵀMT of a plate on its masters, and the way back.
#[derive(Debug)]
pub struct Condensed {
    /// K*.
    pub k: Symmetric,
    /// M* on the same pattern; zero where inertia was not wanted.
    pub m: Symmetric,
    /// From the masters to all unknowns.
    pub way: Condensation,
}

/// Why a plate could not be condensed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum CondensationError {
    /// A cell that the element refuses.
    Assembly(AssemblyError),
    /// The inside of a substructure whose stiffness has no factor.
    Factor {
        /// A cell of the substructure.
        quad_tag: u64,
        /// Why.
        why: FactorError,
    },
    /// The condensed matrices would not fit.
    TooLarge {
        /// Their entries.
        entries: usize,
    },
}

impl fmt::Display for CondensationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Assembly(why) => write!(f, "{why}"),
            Self::TooLarge { entries } => write!(
                f,
                "the condensed matrices need {:.1} GB: divide the plate into substructures with shorter outlines",
                8e-9 * *entries as f64
            ),
            Self::Factor { quad_tag, why } => {
                write!(f, "the stiffness inside the substructure of cell {quad_tag} cannot be factorised: {why}")
            }
        }
    }
}
impl std::error::Error for CondensationError {}

impl From<AssemblyError> for CondensationError {
    fn from(why: AssemblyError) -> Self {
        Self::Assembly(why)
    }
}

/// From masters to all independent unknowns: u = T u_m, substructure by substructure T = [−K_ii⁻¹ K_ib; I].
///
/// Masters are what belongs to node columns on the outline of a substructure, what an equation or support names, and what a
/// [`Division`] keeps; all else is inside.
#[derive(Debug)]
pub struct Condensation {
    constraints: Constraints,
    /// Independent unknown of each master.
    masters: Vec<usize>,
    /// Master of each independent unknown, [`INSIDE`] for those that are none.
    numbers: Vec<usize>,
    parts: Vec<Part>,
    insides: Vec<Inside>,
}

const INSIDE: usize = usize::MAX;

/// A substructure in its place.
#[derive(Debug)]
struct Part {
    class: usize,
    /// Unknowns of the plate: those inside, then those of the outline.
    unknowns: Vec<usize>,
}

/// Substructures that are equal but for their place.
#[derive(Debug)]
struct Class {
    plate: Plate,
    /// The unknowns of `plate` in the order in which they are eliminated: those inside come first.
    order: Vec<usize>,
    inside: usize,
}

/// What equal substructures have in common: quads, their regions, how many each stands for, and vertices from the first one, in units of `GRAIN` of their size, that size
/// as an exponent of 2, and the unknowns inside; last the columns where strains jump.
type Shape = (Vec<Corners<u32>>, Vec<usize>, Vec<u32>, Vec<[i64; 2]>, i32, Vec<usize>, Vec<usize>);

/// Assembles K and M of `plate` substructure by substructure, each condensed on its masters; equal ones once.
///
/// Equal are substructures of the same quads in the same arrangement with the same unknowns inside; what supports do to an
/// outline makes no difference. Of a plate folded by a symmetry the quads that represent others are condensed, as many times as
/// they stand for; substructures that a fold cuts are what is left of them.
///
/// # Errors
/// A cell that the element refuses, an inside that cannot be factorised.
pub fn condense(
    plate: &Plate,
    element: &dyn Element,
    constraints: &Constraints,
    division: &Division,
    inertia: bool,
    threads: NonZeroUsize,
    counters: &mut Counters,
) -> Result<Condensed, CondensationError> {
    let Divided { parts, classes, loose } = divide(plate, constraints, division);
    let (beside, unknowns) = plate.part(&loose);
    let masters = masters(plate, constraints, &parts, &classes, &loose);
    let on_masters = constraints.only(&masters);
    let beside_on_masters = on_masters.of(&unknowns);
    fits(&parts, &classes)?;

    let (mut map, mut cliques) = (CellMap::default(), Cliques::default());
    for (cell, _) in beside.kept_cells() {
        map.set(&beside, &beside_on_masters, cell);
        cliques.push(&map.reduced);
    }
    let mut outlines = vec![Vec::new(); classes.len()];
    for part in &parts {
        let outline = &part.unknowns[classes[part.class].inside..];
        map.set_unknowns(outline, &on_masters);
        cliques.push(&map.reduced);
        outlines[part.class].push(outline);
    }
    let pattern = Arc::new(cliques.pattern(masters.len()));
    let mut matrix = |which| assemble(&beside, element, &beside_on_masters, &pattern, which, threads, counters);
    let mut k = matrix(Matrix::Stiffness)?;
    let mut m = if inertia { matrix(Matrix::Mass)? } else { Symmetric::zero(pattern.clone()) };
    let mut insides = Vec::with_capacity(classes.len());
    for (class, outlines) in classes.iter().zip(&outlines) {
        let (inside, [stiffness, mass]) = class.condense(element, inertia, threads, counters)?;
        insides.push(inside);
        counters.elements_reused += ((outlines.len() - 1) * class.plate.cells()) as u64;
        for outline in outlines {
            map.set_unknowns(outline, &on_masters);
            map.scatter(&stiffness, 1.0, &mut k);
            if inertia {
                map.scatter(&mass, 1.0, &mut m);
            }
        }
    }
    let mut numbers = vec![INSIDE; constraints.ndof()];
    masters.iter().enumerate().for_each(|(number, i)| numbers[*i] = number);
    Ok(Condensed { k, m, way: Condensation { constraints: constraints.clone(), masters, numbers, parts, insides } })
}

/// Refuses dense matrices of outlines that this machine could not hold beside their sum.
fn fits(parts: &[Part], classes: &[Class]) -> Result<(), CondensationError> {
    let entries = |part: &Part| (part.unknowns.len() - classes[part.class].inside).pow(2);
    let largest = parts.iter().map(entries).max().unwrap_or(0);
    let all = 2 * largest + 2 * parts.iter().map(entries).sum::<usize>();
    if Vec::<f64>::new().try_reserve_exact(all).is_ok() {
        Ok(())
    } else {
        Err(CondensationError::TooLarge { entries: all })
    }
}

/// A plate divided.
struct Divided {
    /// Substructures that have an inside, by the first of their quads.
    parts: Vec<Part>,
    classes: Vec<Class>,
    /// All other quads.
    loose: Vec<u32>,
}

fn divide(plate: &Plate, constraints: &Constraints, division: &Division) -> Divided {
    let stays = find_kept(plate, constraints, &division.kept);
    let (mut groups, mut loose): (BTreeMap<u32, Vec<u32>>, Vec<u32>) = (BTreeMap::new(), Vec::new());
    for (quad, _) in plate.symmetry().quads() {
        let (quad, group) = (quad as u32, division.quads[quad]);
        group.map_or(&mut loose, |group| groups.entry(group).or_default()).push(quad);
    }
    let mut classes: Vec<Class> = Vec::new();
    let mut numbers: HashMap<Shape, usize> = HashMap::new();
    let mut parts = Vec::new();
    for quads in groups.into_values() {
        let (part, unknowns) = plate.part(&quads);
        let mut inside: Vec<bool> = unknowns.iter().map(|dof| !stays[*dof]).collect();
        part.outline().iter().for_each(|column| inside[part.dofs_of_column(*column as usize)].fill(false));
        if !inside.contains(&true) {
            loose.extend(quads);
            continue;
        }
        let class = *numbers.entry(shape(&part, &inside)).or_insert_with(|| {
            classes.push(Class::new(part, &inside));
            classes.len() - 1
        });
        parts.push(Part { class, unknowns: classes[class].order.iter().map(|own| unknowns[*own]).collect() });
    }
    loose.sort_unstable();
    Divided { parts, classes, loose }
}

/// Whether an unknown of the plate is a master by itself: `kept`, held, or in an equation with others.
fn find_kept(plate: &Plate, constraints: &Constraints, kept: &[usize]) -> Vec<bool> {
    let (mut stays, mut used) = (vec![false; plate.ndof()], vec![false; plate.ndof()]);
    for column in plate.symmetry().quads().flat_map(|(quad, _)| plate.columns_of_quad(quad)) {
        used[plate.dofs_of_column(*column as usize)].fill(true);
    }
    // An image that no cell of a folded plate has is tied to what may well be inside.
    let tied = (0..plate.ndof()).filter(|dof| constraints.position(*dof).is_none() && used[*dof]);
    for dof in tied.chain(kept.iter().copied()) {
        stays[dof] = true;
        constraints.row(dof).0.iter().for_each(|(i, _)| stays[constraints.original(*i)] = true);
    }
    stays
}

fn shape(part: &Plate, inside: &[bool]) -> Shape {
    let points = &part.plane.points;
    let from_first = |p: &[f64; 2]| [p[0] - points[0][0], p[1] - points[0][1]];
    let size = points.iter().flat_map(from_first).fold(0.0_f64, |m, x| m.max(x.abs()));
    let exponent = size.log2().floor() as i32;
    let grain = f64::from(exponent).exp2() * GRAIN;
    let places = points.iter().map(|p| from_first(p).map(|x| (x / grain).round() as i64)).collect();
    let inside = (0..inside.len()).filter(|dof| inside[*dof]).collect();
    let regions = (0..part.plane.quads.len()).map(|quad| part.region(quad)).collect();
    let counts = part.symmetry().quads().map(|(_, count)| count as u32).collect();
    (part.plane.quads.clone(), regions, counts, places, exponent, inside, part.seam_columns())
}

/// The independent unknowns that are masters, in an order that is good to eliminate them in.
fn masters(plate: &Plate, constraints: &Constraints, parts: &[Part], classes: &[Class], loose: &[u32]) -> Vec<usize> {
    let mut inside = vec![false; plate.ndof()];
    let (mut cliques, mut dofs, mut clique) = (Cliques::default(), Vec::new(), Vec::new());
    let mut take = |dofs: &[usize]| {
        clique.clear();
        // What is held counts like any other, as in the order of the undivided plate.
        clique.extend(dofs);
        clique.extend(dofs.iter().flat_map(|dof| constraints.row(*dof).0).map(|(i, _)| constraints.original(*i)));
        clique.sort_unstable();
        clique.dedup();
        cliques.push(&clique);
    };
    for cell in loose.iter().flat_map(|quad| plate.cells_over(*quad as usize)) {
        plate.cell_dofs(cell, &mut dofs);
        take(&dofs);
    }
    for part in parts {
        let (own, outline) = part.unknowns.split_at(classes[part.class].inside);
        own.iter().for_each(|dof| inside[*dof] = true);
        take(outline);
    }
    let unknowns = ordering::order(plate, &cliques).into_iter().filter(|dof| !inside[*dof]);
    unknowns.filter_map(|dof| constraints.position(dof)).collect()
}

impl Class {
    fn new(plate: Plate, inside: &[bool]) -> Self {
        let mut order = elimination_order(&plate);
        order.retain(|dof| inside[*dof]);
        let count = order.len();
        order.extend((0..inside.len()).filter(|dof| !inside[*dof]));
        Self { plate, order, inside: count }
    }

    /// K* and M* of the outline, both triangles, column-major; M* is zero where `inertia` is not wanted.
    fn condense(
        &self,
        element: &dyn Element,
        inertia: bool,
        threads: NonZeroUsize,
        counters: &mut Counters,
    ) -> Result<(Inside, [Vec<f64>; 2]), CondensationError> {
        let free = Constraints::none(&self.order);
        let pattern = Arc::new(pattern(&self.plate, &free));
        let mut matrix = |which| assemble(&self.plate, element, &free, &pattern, which, threads, counters);
        let k = matrix(Matrix::Stiffness)?;
        let m = if inertia { matrix(Matrix::Mass)? } else { Symmetric::zero(pattern.clone()) };
        let refused = |why| CondensationError::Factor { quad_tag: self.plate.plane.quad_tags[0], why };
        let inside = Inside::new(k, self.inside, threads).map_err(refused)?;
        let condensed = inside.condense(inertia.then_some(&m));
        Ok((inside, condensed))
    }
}

impl Condensation {
    /// Number of masters.
    pub fn ndof(&self) -> usize {
        self.masters.len()
    }

    /// Number of independent unknowns.
    pub fn independents(&self) -> usize {
        self.numbers.len()
    }

    /// Independent unknown that a master stands for.
    pub fn independent(&self, master: usize) -> usize {
        self.masters[master]
    }

    /// Master of an independent unknown, if it is one.
    pub fn master(&self, independent: usize) -> Option<usize> {
        Some(self.numbers[independent]).filter(|number| *number != INSIDE)
    }

    /// Substructures that have an inside, and how many of them were condensed: the others are equal to one of these.
    pub fn counts(&self) -> (usize, usize) {
        (self.parts.len(), self.insides.len())
    }

    /// U = T U_m, column by column.
    pub fn expand(&self, masters: &[f64]) -> Vec<f64> {
        let (n, columns) = (self.numbers.len(), masters.len() / self.ndof().max(1));
        let mut all = vec![0.0; n * columns];
        for (all, masters) in all.chunks_exact_mut(n.max(1)).zip(masters.chunks_exact(self.ndof().max(1))) {
            self.masters.iter().zip(masters).for_each(|(i, u)| all[*i] = *u);
        }
        let mut local = Vec::new();
        for part in &self.parts {
            let inside = &self.insides[part.class];
            let value = |all: &[f64], dof: usize| self.constraints.row(dof).0.iter().map(|(i, c)| c * all[*i]).sum();
            local.clear();
            for all in all.chunks_exact(n) {
                local.resize(local.len() + inside.count, 0.0);
                local.extend(part.unknowns[inside.count..].iter().map(|dof| -> f64 { value(all, *dof) }));
            }
            inside.follow(&mut local);
            for (all, local) in all.chunks_exact_mut(n).zip(local.chunks_exact(part.unknowns.len())) {
                self.add_inside(part, local, all);
            }
        }
        all
    }

    /// Condenses a load on the independent unknowns: TᵀF, and the displacements [K_ii⁻¹ F_i; 0] that come on top of
    /// [`Condensation::expand`] where the load acts inside.
    pub fn load(&self, f: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (mut on_masters, mut own) = (f.to_vec(), vec![0.0; f.len()]);
        for part in &self.parts {
            let inside = &self.insides[part.class];
            let force = |dof: &usize| self.constraints.position(*dof).map_or(0.0, |i| f[i]);
            let mut local: Vec<f64> = part.unknowns[..inside.count].iter().map(force).collect();
            if local.iter().all(|f| *f == 0.0) {
                continue;
            }
            local.resize(part.unknowns.len(), 0.0);
            let response = inside.condense_load(&mut local);
            self.add_inside(part, &response, &mut own);
            for (dof, force) in part.unknowns.iter().zip(&local).skip(inside.count) {
                self.constraints.row(*dof).0.iter().for_each(|(i, c)| on_masters[*i] += c * force);
            }
        }
        (self.masters.iter().map(|i| on_masters[*i]).collect(), own)
    }

    fn add_inside(&self, part: &Part, local: &[f64], all: &mut [f64]) {
        let inside = &part.unknowns[..self.insides[part.class].count];
        for (i, u) in inside.iter().zip(local).filter_map(|(dof, u)| Some((self.constraints.position(*dof)?, u))) {
            all[i] += u;
        }
    }
}
