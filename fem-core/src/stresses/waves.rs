//! Straight-crested waves in a plate of cells, and what its layers of cells add to their stiffness.

use super::band::Band;
use crate::contracts::element::{Element, ElementError, Scratch};
use crate::plates::laminate::Laminate;
use crate::plates::mesh::PlaneMesh;
use crate::plates::plate::{Plate, ZDerivatives};
use crate::words::dof::Dof;
use crate::words::domain::Domain;
use crate::words::material::Material;
use std::f64::consts::{FRAC_PI_8, PI};

/// Wave numbers times the thickness, from waves of sixty thicknesses to one of two.
const NUMBERS: [f64; 4] = [0.1, 0.3, 1.0, 3.0];

/// Directions in which they run, over π.
const DIRECTIONS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Phase across a cell: small enough that the division of the plane does not matter.
const PHASE: f64 = FRAC_PI_8;

/// Error that layers leave over what halving them changes: their error falls with the square of their height, at least.
const LEFT: f64 = 4.0 / 3.0;

/// Iterations of the lowest frequency, each of which brings it nearer by the square of its ratio to the next.
const ITERATIONS: usize = 12;

/// Shares of their stiffness that waves have from the division of the thickness into layers of cells, by frequency.
///
/// ```text
/// share(ω) = (4/3) (1 − ω₂²/ω²)      ω of a wave of the plate, ω₂ with each layer cut in two, the mean over four directions
/// ```
///
/// Waves of four lengths, between which and zero the share is linear in ω: what a layer's polynomials cannot follow is a zigzag, whose
/// share of a long bending wave's energy grows with the square of its number, as ω does. A share may be negative: assumed stresses
/// make plates too soft as well.
///
/// Limits: the laminate is that of an infinite plate; the wave is its lowest, in bending. Modes of the plane, and what is as
/// short as the thickness, are judged by the bending wave of the same frequency or by the shortest.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerShares(Vec<(f64, f64)>);

impl LayerShares {
    /// Of plates of `laminate`, none for a theory of plates, which has no layers; nothing for a section, or where a wave finds no
    /// answer.
    ///
    /// # Errors
    /// A cell that the element refuses.
    pub fn of(
        element: &dyn Element,
        z_derivatives: ZDerivatives,
        laminate: &Laminate,
        materials: &[Material],
    ) -> Result<Option<Self>, ElementError> {
        let info = element.info();
        if info.is_shell() || info.is_section() {
            return Ok(info.is_shell().then(|| Self(Vec::new())));
        }
        let finer = halved(laminate);
        let mut known = Vec::new();
        for number in NUMBERS.map(|number| number / laminate.thickness()) {
            let [mut own, mut other] = [[0.0; DIRECTIONS.len()]; 2];
            for (laminate, squares) in [(laminate, &mut own), (&finer, &mut other)] {
                let Some(wave) = Wave::new(element, z_derivatives, laminate, materials, PHASE / number)? else {
                    return Ok(None);
                };
                for (square, direction) in squares.iter_mut().zip(DIRECTIONS) {
                    let (sine, cosine) = (PI * direction).sin_cos();
                    let Some(found) = wave.lowest([number * cosine, number * sine]) else { return Ok(None) };
                    *square = found;
                }
            }
            let mean = |of: &dyn Fn(usize) -> f64| (0..own.len()).map(of).sum::<f64>() / own.len() as f64;
            known.push((mean(&|i| own[i].sqrt()), LEFT * mean(&|i| 1.0 - other[i] / own[i])));
        }
        Ok(known.iter().all(|(omega, share)| omega.is_finite() && share.is_finite()).then_some(Self(known)))
    }

    /// The waves' angular frequencies, rad/s, and shares.
    pub fn waves(&self) -> &[(f64, f64)] {
        &self.0
    }

    /// At the angular frequency `omega`, rad/s.
    pub fn at(&self, omega: f64) -> f64 {
        let (mut below, last) = ((0.0, 0.0), self.0.last().map_or(0.0, |last| last.1));
        for &(next, share) in &self.0 {
            if omega < next {
                return below.1 + (share - below.1) * (omega - below.0) / (next - below.0);
            }
            below = (next, share);
        }
        last
    }
}

/// Each layer of cells as two, between plies where it has several.
fn halved(laminate: &Laminate) -> Laminate {
    let (mut plies, mut layers) = (Vec::new(), Vec::new());
    for layer in 0..laminate.layers.len() {
        let mut own = laminate.plies[laminate.plies_of(layer)].to_vec();
        if let [ply] = own[..] {
            let half = crate::plates::laminate::LaminaPly { thickness: 0.5 * ply.thickness, ..ply };
            own = vec![half; 2];
        }
        layers.extend([own.len() / 2, own.len() - own.len() / 2]);
        plies.extend(own);
    }
    Laminate { plies, layers, middle: laminate.middle }
}

/// One cell of an infinite plate, and the amplitudes of a wave in it: of u, v, w at each level, and of their z-derivatives.
struct Wave {
    plate: Plate,
    amplitudes: usize,
    /// Of each unknown, its amplitude.
    numbers: Vec<usize>,
    stiffness: Vec<Entry>,
    mass: Vec<Entry>,
}

/// Two unknowns and what couples them.
type Entry = (usize, usize, f64);

impl Wave {
    fn new(
        element: &dyn Element,
        z_derivatives: ZDerivatives,
        laminate: &Laminate,
        materials: &[Material],
        side: f64,
    ) -> Result<Option<Self>, ElementError> {
        let mut plane = PlaneMesh::rectangle(&[0.0, side], &[0.0, side]);
        if element.info().domain == Domain::Triangle {
            plane.quads = vec![[0, 1, 3].into(), [0, 3, 2].into()];
            plane.quad_tags = vec![1, 2];
            plane.groups.clear();
        }
        let info = *element.info();
        let stacks = laminate.stacks(materials).ok();
        let plate = stacks.and_then(|stacks| Plate::new(plane, laminate.levels(), stacks, info, z_derivatives).ok());
        let Some(plate) = plate else { return Ok(None) };
        let (numbers, amplitudes) = number(&plate);
        let mut wave = Self { plate, amplitudes, numbers, stiffness: Vec::new(), mass: Vec::new() };
        let n = info.ndof();
        let (mut scratch, mut matrix, mut dofs) = (Scratch::default(), vec![0.0; n * n], Vec::new());
        for number in wave.plate.cell_numbers() {
            wave.plate.cell_dofs(number, &mut dofs);
            let cell = wave.plate.cell(number);
            let add = |entries: &mut Vec<Entry>, matrix: &[f64]| {
                let each = matrix.chunks_exact(n).zip(&dofs);
                entries.extend(each.flat_map(|(column, j)| column.iter().zip(&dofs).map(|(k, i)| (*i, *j, *k))));
            };
            element.stiffness(&cell, &mut scratch, &mut matrix)?;
            add(&mut wave.stiffness, &matrix);
            element.mass(&cell, &mut scratch, &mut matrix)?;
            add(&mut wave.mass, &matrix);
        }
        Ok(Some(wave))
    }

    /// ω² of the lowest wave u = Re U(z) exp(i k·x); `None` where K or M of its amplitudes is not definite.
    ///
    /// The energy of a cell is Uᴴ Tᴴ K T U with T the values of the wave at the cell's unknowns, a Hermitian form; real and imaginary
    /// parts of U make a symmetric one of twice the size.
    fn lowest(&self, k: [f64; 2]) -> Option<f64> {
        // Value of a unit wave at each unknown, real and imaginary.
        let values: Vec<[f64; 2]> = (0..self.plate.ndof())
            .map(|dof| {
                let (column, _, name) = self.plate.locate(dof);
                let [x, y] = self.plate.columns[column];
                let (sine, cosine) = (k[0] * x + k[1] * y).sin_cos();
                match name.m() {
                    1 => [-k[0] * sine, k[0] * cosine],
                    2 => [-k[1] * sine, k[1] * cosine],
                    _ => [cosine, sine],
                }
            })
            .collect();
        // Real and imaginary part of an amplitude lie side by side, those of a level near each other: entries are near the diagonal.
        let apart = |(i, j, _): &Entry| self.numbers[*i].abs_diff(self.numbers[*j]);
        let width = 2 * (self.stiffness.iter().chain(&self.mass).map(apart).max()? + 1);
        let form = |entries: &[Entry]| {
            let mut form = Band::zero(2 * self.amplitudes, width);
            for &(i, j, entry) in entries {
                let ([a, b], [c, d]) = (values[i], values[j]);
                let (real, imaginary) = (entry * (a * c + b * d), entry * (a * d - b * c));
                let (i, j) = (2 * self.numbers[i], 2 * self.numbers[j]);
                form.add(i, j, real);
                form.add(i + 1, j + 1, real);
                form.add(i, j + 1, -imaginary);
                form.add(i + 1, j, imaginary);
            }
            form
        };
        let (stiffness, mass) = (form(&self.stiffness), form(&self.mass));
        let factor = stiffness.cholesky()?;
        // The whole thickness moves along z.
        let mut u = vec![0.0; 2 * self.amplitudes];
        for (dof, number) in self.numbers.iter().enumerate() {
            let (.., name) = self.plate.locate(dof);
            if name.n() == 3 && name.m() == 0 {
                u[2 * number] = 1.0;
            }
        }
        for _ in 0..ITERATIONS {
            u = mass.product(&u);
            factor.solve(&mut u);
            let largest = u.iter().fold(0.0_f64, |largest, u| largest.max(u.abs()));
            u.iter_mut().for_each(|u| *u /= largest);
        }
        let energy = |form: &Band| form.product(&u).iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
        let square = energy(&stiffness) / energy(&mass);
        (square > 0.0).then_some(square)
    }
}

/// Number of each unknown's amplitude, and how many there are: derivatives along x and y follow from those of the values.
fn number(plate: &Plate) -> (Vec<usize>, usize) {
    let mut numbers = vec![0; plate.ndof()];
    let mut count = 0;
    for level in 0..plate.levels.len() {
        for n in 1..=3 {
            let mut kinds: Vec<Vec<usize>> = vec![Vec::new(); 3];
            for column in 0..plate.columns.len() {
                let at = |m| Dof::new(n, m).into_iter().flat_map(move |dof| plate.dofs_at(column, level, dof));
                kinds[0].extend((0..3).flat_map(at));
                kinds[1].extend(at(3).next());
                kinds[2].extend(at(3).nth(1));
            }
            for kind in kinds.iter().filter(|kind| !kind.is_empty()) {
                kind.iter().for_each(|dof| numbers[*dof] = count);
                count += 1;
            }
        }
    }
    (numbers, count)
}
