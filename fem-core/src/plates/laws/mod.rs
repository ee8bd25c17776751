//! Plies of a plate that follow laws: what their stresses differ from those of linear elasticity.

mod means;

use crate::contracts::element::{Cell, Element, ElementError, ElementInfo, Slice, form, positive};
use crate::contracts::ply_law::{LawPoint, PlyLaw, PlyResponse, check_law};
use crate::plates::laminate::Laminate;
use crate::plates::plate::Plate;
use crate::words::energy::Energy;
use crate::words::material::{Material, MaterialError};
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::{Matrix6, Ply, Strain6, Stress6, apply, multiply, strain_rotation, transpose};
use crate::words::vectorised::{add_rows, rows_times};
use means::{Faces, faces, wanted};
use std::fmt;
use std::ops::Range;

/// Where strains of a cell are compared with the polynomials through the levels, in natural coordinates.
const TRIED: [[f64; 3]; 3] = [[0.3, -0.7, -0.95], [-0.6, 0.2, 0.1], [0.9, 0.8, 0.6]];

/// Levels that an element may have.
const MOST_LEVELS: usize = 8;

/// Length of cells over their width up to which a crack takes what it should to half as much again.
const SLENDER: f64 = 2.0;

/// Deviation from them, relative, that is rounding.
const ROUNDING: f64 = 1e-9;

/// A ply that follows a law.
#[derive(Debug, Clone)]
struct LawfulPly {
    name: String,
    law: Box<dyn PlyLaw>,
    material: Material,
    stiffness: Matrix6,
    /// Strain in the plate's frame to strain in the ply's.
    rotation: Matrix6,
    /// Stress in the ply's frame to stress in the plate's.
    back: Matrix6,
    /// Of the ply and of those about it that are alike, m.
    thickness: f64,
    /// The slices of its layer that break as one: those about it that are alike, or itself alone.
    group: Range<usize>,
}

impl LawfulPly {
    /// A point of it, alone, in a cell of this width.
    fn point(&self, length: f64) -> LawPoint<'_> {
        LawPoint { material: &self.material, stiffness: &self.stiffness, length, thickness: self.thickness, means: &[] }
    }
}

/// The plies of a plate that follow laws.
///
/// A cell's strains are those of its element at Gauss points, as those of its stiffness are. They are polynomials in q of a
/// degree below [`ElementInfo::ply_order`], so that as many levels tell them in all plies: what a cell costs beside its
/// laws does not depend on how many plies it has.
///
/// Forces and energies are those beyond linear elasticity, σ − C ε, which K has already.
#[derive(Debug, Clone)]
pub struct PlyLaws {
    /// By layer of cells and slice of its stack; and none at all, of the quads beyond.
    plies: Vec<Vec<Option<LawfulPly>>>,
    none: Vec<Vec<Option<LawfulPly>>>,
    /// Quads whose plies follow no law.
    beyond: Vec<bool>,
    /// First state variable of each cell, and their number at the end.
    first: Vec<usize>,
}

/// Why plies of a plate cannot follow their laws.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum LawsError {
    /// The element is a plate theory or a section, whose strains through the thickness follow from linear elasticity.
    Theory,
    /// The strains of the element are no polynomials of the degree that its Gauss points through a ply integrate.
    Strains,
    /// A law does not take its material, or the size of a cell.
    Material(MaterialError),
}

impl fmt::Display for LawsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Theory => f.write_str(
                "the element is a plate theory or a section: some of its strains follow from linear elasticity and not from \
                 displacements",
            ),
            Self::Strains => f.write_str(
                "the strains of the element are not polynomials through the thickness of the degree that its Gauss points \
                 integrate",
            ),
            Self::Material(error) => error.fmt(f),
        }
    }
}
impl std::error::Error for LawsError {}

/// A cell's forces beyond linear elasticity, and work arrays.
#[derive(Debug, Clone, Default)]
pub struct CellAnswer {
    /// ∫ Bᵀ (σ − C ε) dV, N, conjugate to the unknowns.
    pub force: Vec<f64>,
    /// ∫ ε_t · (σ − C ε) dV of each pattern that stretches the cell, J; conjugate to their amounts.
    pub on_patterns: Vec<f64>,
    /// Its derivative, symmetric part, where it is asked for; column-major.
    pub tangent: Vec<f64>,
    /// What is stored beyond linear elasticity, which may be negative, and what is dissipated, J.
    pub energy: Energy,
    /// Mean stress of each ply that follows a law, its own axes, Pa, and the volume, m³; by slice.
    pub means: Vec<([f64; 6], f64)>,
    /// The states that are left.
    pub states: Vec<f64>,
    /// What laws want the means of: by slice, as many of each, those of faces next, with the volume behind them.
    shared: Vec<f64>,
    /// Of all points at which laws are asked, and of the faces that they want, in the axes of their plies.
    own: Vec<Strain6<Ply>>,
    on_faces: Vec<Strain6<Ply>>,
    /// Of the levels at an in-plane point, six each; stresses weighted, moduli between all pairs.
    strains: Vec<f64>,
    stresses: Vec<f64>,
    moduli: Vec<f64>,
    /// Of the points through a ply.
    responses: Vec<PlyResponse>,
    tangents: Vec<Matrix6>,
    through: Vec<Through>,
    faces: Vec<Faces>,
}

/// Strain operators of a cell; equal of cells of one shape.
#[derive(Debug, Clone, PartialEq)]
pub struct CellOperators {
    /// Jacobian times weight of each in-plane point.
    weights: Vec<f64>,
    /// Of all levels at each in-plane point, `6 levels × ndof`, row by row.
    operators: Vec<f64>,
}

impl CellOperators {
    /// Those of `cell`.
    ///
    /// # Errors
    /// A folded cell.
    pub fn new(element: &dyn Element, cell: &Cell<'_>) -> Result<Self, ElementError> {
        let element = form(element, cell.corners.domain());
        let info = element.info();
        let levels = gauss_legendre(info.ply_order);
        let (n, rows) = (info.ndof(), 6 * levels.len());
        let points: Vec<_> = info.plane_points().collect();
        let mut found =
            Self { weights: Vec::with_capacity(points.len()), operators: vec![0.0; points.len() * rows * n] };
        let mut operator = vec![0.0; 6 * n];
        for ((r, s, w), all) in points.into_iter().zip(found.operators.chunks_exact_mut(rows * n)) {
            let mut jacobian = 0.0;
            for (k, (q, _)) in levels.iter().enumerate() {
                jacobian = positive(element.strain_operator(cell, 0, [r, s, *q], &mut operator))?;
                for (j, b) in operator.chunks_exact(6).enumerate() {
                    all[6 * k * n..6 * (k + 1) * n].chunks_exact_mut(n).zip(b).for_each(|(row, b)| row[j] = *b);
                }
            }
            found.weights.push(jacobian * w);
        }
        Ok(found)
    }

    /// Memory that those of a cell take, bytes.
    pub fn bytes(element: &dyn Element) -> usize {
        let info = element.info();
        8 * info.plane_points().count() * 6 * info.ply_order * info.ndof()
    }
}

/// What a cell is asked about.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// The plate.
    pub plate: &'a Plate,
    /// Its element.
    pub element: &'a dyn Element,
    /// Number of the cell.
    pub cell: usize,
    /// Its operators.
    pub operators: &'a CellOperators,
    /// Displacements of the cell.
    pub u: &'a [f64],
    /// How it is stretched beside, if it is.
    pub stretched: Option<Patterns<'a>>,
    /// States of the cell ([`PlyLaws::states_of`]).
    pub states: &'a [f64],
}

/// Membrane strains of a cell, Σ b_t ε_t: 11, 22 and 12 at each in-plane point, the same through the thickness.
#[derive(Debug, Clone, Copy)]
pub struct Patterns<'a> {
    /// ε_t at all in-plane points, one pattern after the other.
    pub strains: &'a [f64],
    /// b_t.
    pub amounts: &'a [f64],
}

/// Rows of the strains in the plane of the plate, 11, 22 and 12.
const PLANE: [usize; 3] = [0, 1, 3];

impl Patterns<'_> {
    /// ε_t at a point, pattern by pattern.
    fn at(&self, point: usize) -> impl Iterator<Item = &[f64]> {
        let each = self.strains.len() / self.amounts.len().max(1);
        self.strains.chunks_exact(each.max(1)).map(move |pattern| &pattern[3 * point..3 * point + 3])
    }
}

impl PlyLaws {
    /// The plies of `laminate` whose material has one of `laws`, by material, in the cells of `quads`, or in all; `None` where there
    /// is none.
    ///
    /// # Errors
    /// An element that gives up strains, a law that refuses its material.
    pub fn new(
        plate: &Plate,
        laminate: &Laminate,
        materials: &[Material],
        laws: &[Option<(String, Box<dyn PlyLaw>)>],
        element: &dyn Element,
        quads: Option<&[u32]>,
    ) -> Result<Option<Self>, LawsError> {
        let lawful = |ply: usize, layer: &Range<usize>| {
            let (alike, slice) = (laminate.alike(ply), ply - layer.start);
            let (thickness, ply) = (laminate.thickness_of(alike.clone()), &laminate.plies[ply]);
            let (name, law) = laws.get(ply.material)?.clone()?;
            let material = materials[ply.material].clone();
            let (stiffness, rotation) = (material.elastic.stiffness(), strain_rotation(ply.angle));
            let within = alike.start.max(layer.start) - layer.start..alike.end.min(layer.end) - layer.start;
            let group = if law.faces() { within } else { slice..slice + 1 };
            let back = transpose(&rotation);
            Some(LawfulPly { name, law, material, stiffness, rotation, back, thickness, group })
        };
        let layers = (0..laminate.layers.len()).map(|layer| laminate.plies_of(layer));
        let plies: Vec<Vec<_>> = layers.map(|layer| layer.clone().map(|ply| lawful(ply, &layer)).collect()).collect();
        if plies.iter().flatten().all(Option::is_none) {
            return Ok(None);
        }
        let info = element.info();
        if info.is_shell() || info.is_section() {
            return Err(LawsError::Theory);
        }
        let mut beyond = vec![quads.is_some(); plate.plane.quads.len()];
        quads.into_iter().flatten().for_each(|quad| beyond[*quad as usize] = false);
        let none = plies.iter().map(|layer| vec![None; layer.len()]).collect();
        let mut all = Self { plies, none, beyond, first: Vec::with_capacity(plate.cells() + 1) };
        let mut next = 0;
        for cell in 0..plate.cells() {
            all.first.push(next);
            let view = plate.cell(cell);
            let element = form(element, view.corners.domain());
            let info = element.info();
            let points = info.plane_points().count() * info.ply_order;
            let length = width(info, &view);
            for ply in all.of(plate, cell).iter().flatten() {
                next += points * ply.law.info().state.len();
                let point = ply.point(length);
                check_law(ply.law.info(), &ply.name, &point, ply.law.check(&point)).map_err(LawsError::Material)?;
            }
            if info.ply_order > MOST_LEVELS || !polynomial(element, &view) {
                return Err(LawsError::Strains);
            }
        }
        all.first.push(next);
        Ok(Some(all))
    }

    /// What laws say of the widest cell of each material that follows one, and what there is to be said of the most slender.
    pub fn warnings(&self, plate: &Plate, element: &dyn Element) -> Vec<String> {
        let (mut widest, mut slender) = (vec![0.0_f64; self.plies.len()], vec![1.0_f64; self.plies.len()]);
        for cell in 0..plate.cells() {
            let ((quad, layer), view) = (plate.place(cell), plate.cell(cell));
            if self.beyond[quad] {
                continue;
            }
            widest[layer] = widest[layer].max(width(form(element, view.corners.domain()).info(), &view));
            slender[layer] = slender[layer].max(plate.plane.quality(quad).aspect);
        }
        let mut said = Vec::new();
        for ((plies, length), slender) in self.plies.iter().zip(widest).zip(slender) {
            for ply in plies.iter().flatten() {
                let point = ply.point(length);
                let warning = ply.law.warning(&point);
                let warning = warning.map(|why| format!("material `{}`, law `{}`: {why}", ply.material.name, ply.name));
                said.extend(warning.filter(|warning| !said.contains(warning)));
                let smeared = slender > SLENDER && !ply.law.info().toughness.is_empty();
                let warning = smeared.then(|| {
                    format!(
                        "material `{}`, law `{}`: cells are up to {slender:.1} times as long as wide, and cracks are smeared over the side of a \
                         square as large: what they dissipate is off by up to {:.1} times; take cells at most {SLENDER} times as long as wide",
                        ply.material.name,
                        ply.name,
                        slender.sqrt()
                    )
                });
                said.extend(warning.filter(|warning| !said.contains(warning)));
            }
        }
        said
    }

    /// The laws of all plies, from the bottom up.
    pub fn laws(&self) -> impl Iterator<Item = &dyn PlyLaw> {
        self.plies.iter().flatten().flatten().map(|ply| &*ply.law)
    }

    /// State variables of all cells.
    pub fn states(&self) -> usize {
        self.first[self.first.len() - 1]
    }

    /// The state variables of a cell among those of all.
    pub fn states_of(&self, cell: usize) -> std::ops::Range<usize> {
        self.first[cell]..self.first[cell + 1]
    }

    /// Shows `see` the points of a cell at which laws are asked: the ply, counted from the bottom of the layer, its law, the volume, m³,
    /// and the state of the law, of the `states` of the cell.
    pub fn visit(
        &self,
        plate: &Plate,
        element: &dyn Element,
        cell: usize,
        states: &[f64],
        mut see: impl FnMut(usize, &dyn PlyLaw, f64, &[f64]),
    ) {
        let (view, plies) = (plate.cell(cell), self.of(plate, cell));
        let info = form(element, view.corners.domain()).info();
        let through = through(gauss_legendre(info.ply_order), &view.stack.slices, plies);
        let mut at = 0;
        for (r, s, w) in info.plane_points() {
            let height = w * view.plane(r, s).det * view.half_height();
            for Through { slice, weight, .. } in &through {
                let Some(ply) = &plies[*slice] else { continue };
                let count = ply.law.info().state.len();
                see(*slice, &*ply.law, height * weight, &states[at..at + count]);
                at += count;
            }
        }
    }

    /// What the modes of laws have dissipated in the cells that symmetry leaves, all of them counted, J, by their names; `points` are the
    /// states of all cells. Laws that do not tell their modes are left out.
    pub fn dissipated(&self, plate: &Plate, element: &dyn Element, points: &[f64]) -> Vec<(&'static str, f64)> {
        let mut sums: Vec<(&'static str, f64)> = Vec::new();
        for (cell, weight) in plate.kept_cells() {
            self.visit(plate, element, cell, &points[self.states_of(cell)], |_, law, volume, state| {
                for k in law.sinks() {
                    let (name, lost) = (law.info().state[k], weight * volume * state[k]);
                    match sums.iter_mut().find(|(known, _)| *known == name) {
                        Some((_, sum)) => *sum += lost,
                        None => sums.push((name, lost)),
                    }
                }
            });
        }
        sums
    }

    /// Mean damages of each ply of a cell, by their names; `states` are those of the cell.
    pub fn damages(
        &self,
        plate: &Plate,
        element: &dyn Element,
        cell: usize,
        states: &[f64],
    ) -> Vec<(usize, &'static str, f64)> {
        let mut means: Vec<(usize, &'static str, f64)> = Vec::new();
        let mut whole = vec![0.0; plate.cell(cell).stack.slices.len()];
        self.visit(plate, element, cell, states, |slice, law, volume, state| {
            whole[slice] += volume;
            for k in law.damages() {
                let (name, lost) = (law.info().state[k], volume * state[k]);
                match means.iter_mut().find(|(ply, known, _)| (*ply, *known) == (slice, name)) {
                    Some((.., sum)) => *sum += lost,
                    None => means.push((slice, name, lost)),
                }
            }
        });
        means.iter_mut().for_each(|(slice, _, mean)| *mean /= whole[*slice]);
        means
    }

    /// Whether a ply of the cell follows a law.
    pub fn concern(&self, plate: &Plate, cell: usize) -> bool {
        self.of(plate, cell).iter().any(Option::is_some)
    }

    fn of(&self, plate: &Plate, cell: usize) -> &[Option<LawfulPly>] {
        let (quad, layer) = plate.place(cell);
        if self.beyond[quad] { &self.none[layer] } else { &self.plies[layer] }
    }

    /// The answer of a cell; with its tangent where that is wanted.
    ///
    /// # Errors
    /// A folded cell, a law that finds no stress.
    pub fn respond(&self, asked: Asked<'_>, tangent: bool, answer: &mut CellAnswer) -> Result<(), ElementError> {
        let Asked { plate, element, cell, operators, u, stretched, states } = asked;
        let (view, plies) = (plate.cell(cell), self.of(plate, cell));
        let element = form(element, view.corners.domain());
        let info = element.info();
        let (levels, n) = (gauss_legendre(info.ply_order), info.ndof());
        let rows = 6 * levels.len();
        answer.clear(n, rows, plies.len(), states.len(), tangent);
        answer.on_patterns.clear();
        answer.on_patterns.resize(stretched.map_or(0, |patterns| patterns.amounts.len()), 0.0);
        answer.through = through(levels, &view.stack.slices, plies);
        answer.faces = faces(levels, &view.stack.slices, plies);
        let (length, mut at, mut place) = (width(info, &view), 0, 0);
        let points = || operators.weights.iter().zip(operators.operators.chunks_exact(rows * n)).enumerate();
        for (number, (_, operators)) in points() {
            answer.strain(operators, u);
            stretched.iter().for_each(|patterns| answer.stretch(patterns, number));
            answer.turn(plies);
        }
        answer.share(plies, &operators.weights, length, states);
        let shared = std::mem::take(&mut answer.shared);
        let each = shared.len() / plies.len();
        for (number, (dv, operators)) in points() {
            answer.begin();
            for (slice, ply) in plies.iter().enumerate() {
                let Some(ply) = ply else { continue };
                let means = &shared[slice * each..][..wanted(ply)];
                let point = LawPoint { means, ..ply.point(length) };
                let count = ply.law.info().state.len() * levels.len();
                answer.ask(ply, &point, (place, levels.len()), *dv, (&states[at..at + count], at))?;
                (at, place) = (at + count, place + levels.len());
            }
            answer.add(operators, n);
            stretched.iter().for_each(|patterns| answer.work(patterns, number));
        }
        answer.shared = shared;
        for (mean, volume) in answer.means.iter_mut().filter(|(_, volume)| *volume > 0.0) {
            mean.iter_mut().for_each(|s| *s /= *volume);
        }
        Ok(())
    }
}

impl CellAnswer {
    fn clear(&mut self, n: usize, rows: usize, slices: usize, states: usize, tangent: bool) {
        let moduli = if tangent { rows * rows } else { 0 };
        for (all, size) in [
            (&mut self.force, n),
            (&mut self.tangent, if tangent { n * n } else { 0 }),
            (&mut self.states, states),
            (&mut self.strains, rows),
            (&mut self.stresses, rows),
            (&mut self.moduli, moduli),
        ] {
            all.clear();
            all.resize(size, 0.0);
        }
        self.energy = Energy::default();
        self.own.clear();
        self.on_faces.clear();
        self.means.clear();
        self.means.resize(slices, ([0.0; 6], 0.0));
    }

    /// Takes the strains of the levels at an in-plane point.
    fn strain(&mut self, operators: &[f64], u: &[f64]) {
        rows_times(operators, u, &mut self.strains);
    }

    /// Adds the strains of patterns at an in-plane point.
    fn stretch(&mut self, patterns: &Patterns<'_>, point: usize) {
        let mut sum = [0.0; 3];
        for (strain, amount) in patterns.at(point).zip(patterns.amounts) {
            sum.iter_mut().zip(strain).for_each(|(sum, e)| *sum += amount * e);
        }
        for level in self.strains.chunks_exact_mut(6) {
            PLANE.iter().zip(sum).for_each(|(row, e)| level[*row] += e);
        }
    }

    /// Keeps the strains of the plies at an in-plane point.
    fn turn(&mut self, plies: &[Option<LawfulPly>]) {
        let Self { own, on_faces, strains, through, faces, .. } = self;
        let strain = |slice: usize, shares: &[f64]| {
            let ply = plies[slice].as_ref()?;
            let mut strain = [0.0; 6];
            for (level, share) in strains.chunks_exact(6).zip(shares) {
                strain.iter_mut().zip(level).for_each(|(sum, e)| *sum += *share * e);
            }
            Some(Strain6::new(apply(&ply.rotation, &strain)))
        };
        own.extend(through.iter().filter_map(|Through { slice, shares, .. }| strain(*slice, shares)));
        for Faces { group, shares, .. } in faces {
            on_faces.extend(shares.iter().filter_map(|shares| strain(group.start, shares)));
        }
    }

    /// Makes ready for another in-plane point.
    fn begin(&mut self) {
        self.stresses.fill(0.0);
        self.moduli.fill(0.0);
    }

    /// Adds the work on patterns at an in-plane point.
    fn work(&mut self, patterns: &Patterns<'_>, point: usize) {
        let mut forces = [0.0; 3];
        for level in self.stresses.chunks_exact(6) {
            forces.iter_mut().zip(PLANE).for_each(|(n, row)| *n += level[row]);
        }
        for (strain, work) in patterns.at(point).zip(&mut self.on_patterns) {
            *work += strain.iter().zip(forces).map(|(e, n)| e * n).sum::<f64>();
        }
    }

    /// Asks the law of a ply at the `count` points through it from `place` of all on; `old` are its states there, from the place `at` on.
    fn ask(
        &mut self,
        ply: &LawfulPly,
        point: &LawPoint<'_>,
        (place, count): (usize, usize),
        dv: f64,
        (old, at): (&[f64], usize),
    ) -> Result<(), ElementError> {
        let (strains, new) = (&self.own[place..place + count], &mut self.states[at..at + old.len()]);
        let silent = PlyResponse { stress: Stress6::new([0.0; 6]), energy: Energy::default() };
        self.responses.resize(count, silent);
        self.tangents.resize(if self.moduli.is_empty() { 0 } else { count }, [[0.0; 6]; 6]);
        let first = place % self.through.len();
        let slice = self.through[first].slice;
        ply.law
            .respond_all(point, strains, (old, new), &mut self.responses, &mut self.tangents)
            .map_err(|why| ElementError(format!("ply {} of the layer: {why}", slice + 1)))?;
        for k in 0..count {
            let Through { weight, shares, .. } = self.through[first + k];
            let (weight, strain) = (dv * weight, self.own[place + k].0);
            let PlyResponse { stress, energy } = self.responses[k];
            let linear = apply(&ply.stiffness, &strain);
            let elastic: f64 = linear.iter().zip(strain).map(|(s, e)| 0.5 * s * e).sum();
            self.energy.stored += weight * (energy.stored - elastic);
            self.energy.dissipated += weight * energy.dissipated;
            let (mean, volume) = &mut self.means[slice];
            *volume += weight;
            mean.iter_mut().zip(stress.0).for_each(|(m, s)| *m += weight * s);
            let beyond = apply(&ply.back, &std::array::from_fn(|i| stress.0[i] - linear[i]));
            for (share, level) in shares.iter().zip(self.stresses.chunks_exact_mut(6)) {
                level.iter_mut().zip(beyond).for_each(|(s, b)| *s += weight * share * b);
            }
            if let Some(modulus) = self.tangents.get(k) {
                let beyond = std::array::from_fn(|i| std::array::from_fn(|j| modulus[i][j] - ply.stiffness[i][j]));
                self.add_modulus(&multiply(&ply.back, &multiply(&beyond, &ply.rotation)), &shares, weight);
            }
        }
        Ok(())
    }

    /// Adds the symmetric part of a modulus between all pairs of levels.
    fn add_modulus(&mut self, modulus: &Matrix6, shares: &[f64], weight: f64) {
        let rows = self.stresses.len();
        for (k, a) in shares.iter().take(rows / 6).enumerate() {
            for (l, b) in shares.iter().take(rows / 6).enumerate() {
                for (i, row) in modulus.iter().enumerate() {
                    for (j, entry) in row.iter().enumerate() {
                        let symmetric = 0.5 * (entry + modulus[j][i]);
                        self.moduli[(6 * k + i) * rows + 6 * l + j] += weight * a * b * symmetric;
                    }
                }
            }
        }
    }

    /// Adds what stresses and moduli of the levels are worth to force and tangent.
    fn add(&mut self, operators: &[f64], n: usize) {
        let Self { force, tangent, stresses, moduli, .. } = self;
        add_rows(operators, stresses, force);
        let rows = stresses.len();
        let mut product = [0.0; 6 * MOST_LEVELS];
        // Of a tangent that nobody asked for there is no column.
        for (j, column) in tangent.chunks_exact_mut(n).enumerate() {
            for (product, moduli) in product.iter_mut().zip(moduli.chunks_exact(rows)) {
                *product = moduli.iter().zip(operators.chunks_exact(n)).map(|(m, row)| m * row[j]).sum();
            }
            add_rows(operators, &product[..rows], column);
        }
    }
}

/// A Gauss point through a ply.
#[derive(Debug, Clone, Copy)]
struct Through {
    slice: usize,
    /// Without the Jacobian and the weight in the plane.
    weight: f64,
    /// What each level has in a polynomial there.
    shares: [f64; MOST_LEVELS],
}

/// The Gauss points through the plies that follow laws.
fn through(levels: &[(f64, f64)], slices: &[Slice], plies: &[Option<LawfulPly>]) -> Vec<Through> {
    let lawful = slices.iter().enumerate().filter(|(slice, _)| plies[*slice].is_some());
    let points = lawful.flat_map(|(slice, ply)| {
        let (middle, half) = (0.5 * (ply.q[0] + ply.q[1]), 0.5 * (ply.q[1] - ply.q[0]));
        levels.iter().map(move |(t, w)| Through {
            slice,
            weight: w * half,
            shares: lagrange(levels, middle + half * t),
        })
    });
    points.collect()
}

/// Width of a cell, m: the side of the square of its area.
fn width(info: &ElementInfo, cell: &Cell<'_>) -> f64 {
    info.plane_points().map(|(r, s, w)| w * cell.plane(r, s).det).sum::<f64>().sqrt()
}

/// Whether the strains of an element are those between its levels, in every ply.
fn polynomial(element: &dyn Element, cell: &Cell<'_>) -> bool {
    let info = element.info();
    let (levels, n) = (gauss_legendre(info.ply_order), info.ndof());
    let operator = |slice: usize, xi: [f64; 3]| {
        let mut b = vec![0.0; 6 * n];
        element.strain_operator(cell, slice, xi, &mut b);
        b
    };
    TRIED.iter().enumerate().all(|(k, [r, s, q])| {
        let mut between = vec![0.0; 6 * n];
        for ((level, _), share) in levels.iter().zip(lagrange(levels, *q)) {
            between.iter_mut().zip(operator(0, [*r, *s, *level])).for_each(|(sum, b)| *sum += share * b);
        }
        let there = operator(k % cell.stack.slices.len(), [*r, *s, *q]);
        let size = there.iter().fold(0.0_f64, |m, b| m.max(b.abs()));
        there.iter().zip(between).all(|(a, b)| (a - b).abs() <= ROUNDING * size)
    })
}

/// Lagrange's polynomials of the levels at q.
fn lagrange(levels: &[(f64, f64)], q: f64) -> [f64; MOST_LEVELS] {
    std::array::from_fn(|k| match levels.get(k) {
        None => 0.0,
        Some((own, _)) => {
            let others = levels.iter().enumerate().filter(|(other, _)| *other != k);
            others.map(|(_, (p, _))| (q - p) / (own - p)).product()
        }
    })
}
