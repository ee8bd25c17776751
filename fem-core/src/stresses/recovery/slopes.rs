//! What the tension of a plate adds to stresses: von Kármán's strains ½ w,x², ½ w,y² and w,x w,y, alike in all plies of a cell.

use super::{Parts, Recovery};
use crate::contracts::element::{Cell, Element, ElementError, ElementInfo, Point, Scratch, form, positive};
use crate::plates::plate::Plate;
use crate::plates::slopes::add_slopes;
use crate::plates::window::Source;
use crate::words::domain::Domain;
use crate::words::tensor::apply;
use std::borrow::Cow;
use std::ops::Range;

/// Strains Σ b_t ε_t of the tension of a plate, ε_t a combination of those of pairs of deflections, which count by rows of the upper
/// triangle.
#[derive(Debug, Clone, Copy)]
pub struct Tension<'a> {
    /// The deflections, before elimination of constraints, one after the other.
    pub deflections: &'a [f64],
    /// `pairs × patterns`.
    pub combinations: &'a [f64],
    /// b_t, `patterns × fields`.
    pub amounts: &'a [f64],
}

impl Tension<'_> {
    /// The share of each of so many `pairs` in the strains of these amounts.
    fn shares(&self, amounts: &[f64], pairs: usize) -> Vec<f64> {
        let mut shares = vec![0.0; pairs];
        for (amount, column) in amounts.iter().zip(self.combinations.chunks_exact(pairs.max(1))) {
            shares.iter_mut().zip(column).for_each(|(share, c)| *share += amount * c);
        }
        shares
    }

    /// Its strains in a cell at the in-plane points, of the first field.
    pub(super) fn of_cell(&self, plate: &Plate, element: &dyn Element, cell: usize) -> Vec<f64> {
        let (quad, _) = plate.place(cell);
        let element = form(element, plate.plane.quads[quad].domain());
        let (mut shape, mut rows, mut dofs) = (Vec::new(), Vec::new(), Vec::new());
        plate.cell_dofs(cell, &mut dofs);
        let fields: Vec<&[f64]> = self.deflections.chunks_exact(plate.ndof()).collect();
        let pairs = || (0..fields.len()).flat_map(|i| (i..fields.len()).map(move |j| (i, j)));
        let shares = self.shares(self.amounts, pairs().count());
        let mut strains = Vec::new();
        for (r, s, _) in element.info().plane_points() {
            rows.clear();
            add_slopes(element, &plate.cell(cell), [r, s], &mut shape, &mut rows);
            let (by_x, by_y) = rows.split_at(rows.len() / 2);
            let of = |row: &[f64], u: &[f64]| row.iter().zip(&dofs).map(|(g, dof)| g * u[*dof]).sum::<f64>();
            let slopes: Vec<[f64; 2]> = fields.iter().map(|u| [of(by_x, u), of(by_y, u)]).collect();
            let mut strain = [0.0; 3];
            for ((i, j), share) in pairs().zip(&shares) {
                let ([ax, ay], [bx, by], share) = (slopes[i], slopes[j], if i == j { 0.5 * share } else { *share });
                strain[0] += share * ax * bx;
                strain[1] += share * ay * by;
                strain[2] += share * (ax * by + ay * bx);
            }
            strains.extend(strain);
        }
        strains
    }
}

/// Stress of a site per unit of each of the three strains, Pa, on the axes of its station.
type Response = [[f64; 6]; 3];

/// Slopes of several deflections where a [`Recovery`] looks, and what their products do at its sites.
struct Slopes {
    fields: usize,
    /// ∂w/∂x of all fields at each point, then ∂w/∂y.
    rows: Vec<f64>,
    /// Points of each window in each of its layers, with their shares in the mean.
    points: Vec<(u32, f64)>,
    /// First of `points` of each window's layer, and the number of all at the end.
    starts: Vec<usize>,
    /// Of each site the layer of its window, counted over all, and its response, counted over all regions.
    sites: Vec<(u32, u32)>,
    responses: Vec<Response>,
}

impl Slopes {
    /// The strains of all pairs of deflections in the `place`-th window's layer.
    fn pairs(&self, place: usize, strains: &mut Vec<[f64; 3]>) {
        let fields = self.fields;
        strains.clear();
        strains.resize(fields * (fields + 1) / 2, [0.0; 3]);
        for (point, share) in &self.points[self.starts[place]..self.starts[place + 1]] {
            let (x, y) = self.rows[2 * fields * *point as usize..][..2 * fields].split_at(fields);
            let pairs = (0..fields).flat_map(|i| (i..fields).map(move |j| (i, j)));
            for ((i, j), strain) in pairs.zip(&mut *strains) {
                let share = if i == j { 0.5 * share } else { *share };
                let products = [x[i] * x[j], y[i] * y[j], x[i] * y[j] + y[i] * x[j]];
                strain.iter_mut().zip(products).for_each(|(sum, product)| *sum += share * product);
            }
        }
    }
}

impl Recovery {
    /// Slopes of the deflections of displacement fields, `u` as of [`Recovery::stresses`], in the middle of the cells' heights.
    ///
    /// A mean over a cell is one over its [samples](Domain::samples): exact for the products of slopes that are linear in it.
    ///
    /// # Errors
    /// A cell that the element refuses.
    fn slopes(&self, plate: &Plate, element: &dyn Element, u: &[f64], fields: usize) -> Result<Slopes, ElementError> {
        let (mut rows, mut shares) = (Vec::new(), Vec::new());
        // Points of each source, layer by layer.
        let (mut of_sources, mut first): (Vec<Vec<Range<usize>>>, usize) = (Vec::new(), 0);
        let (mut shape, mut gradients, mut dofs) = (Vec::new(), Vec::new(), Vec::new());
        for source in &self.sources {
            let element = form(element, plate.plane.quads[source.quad].domain());
            let points = samples(element.info(), *source);
            let mut of_source = Vec::new();
            for number in plate.cells_over(source.quad) {
                let cell = plate.cell(number);
                plate.cell_dofs(number, &mut dofs);
                let start = first;
                for point in &*points {
                    gradients.clear();
                    add_slopes(element, &cell, point.at, &mut shape, &mut gradients);
                    shares.push(positive(cell.plane(point.at[0], point.at[1]).det)? * point.weight());
                    for row in gradients.chunks_exact(dofs.len()) {
                        let of = |u: &[f64]| row.iter().zip(&dofs).map(|(g, dof)| g * u[*dof]).sum::<f64>();
                        rows.extend(u.chunks_exact(plate.ndof()).take(fields).map(of));
                    }
                    first += 1;
                }
                let area: f64 = shares[start..].iter().sum();
                shares[start..].iter_mut().for_each(|share| *share /= area);
                of_source.push(start..first);
            }
            of_sources.push(of_source);
        }
        let (firsts, responses) = self.responses(plate, element)?;
        let (mut points, mut starts, mut sites) = (Vec::new(), vec![0], Vec::new());
        for (i, window) in self.windows.iter().enumerate() {
            let place = starts.len() - 1;
            let stations = self.stations_over(i);
            let of_region = firsts[self.region_of[i]];
            let of_station = |(at, layer): (usize, usize)| ((place + layer) as u32, (of_region + at) as u32);
            sites.extend(stations.iter().map(|station| station.layer).enumerate().map(of_station));
            let layers = plate.stacks(self.region_of[i]).len();
            (0..layers).for_each(|layer| {
                for (source, share) in window {
                    let of_source = of_sources[*source][layer].clone();
                    points.extend(of_source.map(|point| (point as u32, share * shares[point])));
                }
                starts.push(points.len());
            });
        }
        Ok(Slopes { fields, rows, points, starts, sites, responses })
    }

    /// Adds to `out`, stresses of as many fields as `tension` has amounts for, what that adds.
    ///
    /// # Errors
    /// As [`Recovery::stresses`].
    pub fn add_tension(
        &self,
        plate: &Plate,
        element: &dyn Element,
        tension: Tension<'_>,
        out: &mut [f64],
    ) -> Result<(), ElementError> {
        let Tension { deflections, combinations, amounts } = tension;
        let count = deflections.len() / plate.ndof();
        let pairs = count * (count + 1) / 2;
        let patterns = combinations.len() / pairs.max(1);
        if patterns == 0 {
            return Ok(());
        }
        let slopes = self.slopes(plate, element, deflections, count)?;
        let of_fields = amounts.chunks_exact(patterns).map(|amounts| tension.shares(amounts, pairs));
        let shares: Vec<Vec<f64>> = of_fields.collect();
        let (mut strains, mut of_pairs, mut known) = (vec![[0.0; 3]; shares.len()], Vec::new(), None);
        for (site, (place, response)) in slopes.sites.iter().enumerate() {
            if known.replace(*place) != Some(*place) {
                slopes.pairs(*place as usize, &mut of_pairs);
                for (strain, shares) in strains.iter_mut().zip(&shares) {
                    *strain = [0.0; 3];
                    for (share, pair) in shares.iter().zip(&of_pairs) {
                        strain.iter_mut().zip(pair).for_each(|(sum, e)| *sum += share * e);
                    }
                }
            }
            let response = &slopes.responses[*response as usize];
            for (strain, out) in strains.iter().zip(out.chunks_exact_mut(6 * self.sites())) {
                for (e, response) in strain.iter().zip(response) {
                    out[6 * site..].iter_mut().zip(response).for_each(|(s, c)| *s += c * e);
                }
            }
        }
        Ok(())
    }

    /// Where the stations of each region begin, and the responses of all: what the element makes of displacements that stretch a
    /// cell by one of the strains alone, so that a stress which its theory takes as zero stays so.
    fn responses(&self, plate: &Plate, element: &dyn Element) -> Result<(Vec<usize>, Vec<Response>), ElementError> {
        let (mut firsts, mut all) = (Vec::new(), Vec::new());
        let (mut scratch, mut operators) = (Scratch::default(), Vec::new());
        for (region, layers) in self.parts_of_layers().iter().enumerate() {
            firsts.push(all.len());
            let first = all.len();
            all.resize(first + self.regions[region].len(), [[0.0; 6]; 3]);
            let Some(quad) = (0..plate.plane.quads.len()).find(|quad| plate.region(*quad) == region) else { continue };
            let element = form(element, plate.plane.quads[quad].domain());
            let (info, mut station) = (element.info(), first);
            for (layer, Parts { parts, shares, stations }) in layers.iter().enumerate() {
                let cell = plate.cell(plate.cell_over(quad, layer));
                let size = 6 * info.ndof();
                operators.resize(size * parts.len(), 0.0);
                element.mean_strains(&cell, parts, info.plane(), &mut scratch, &mut operators)?;
                for (operator, (at, share)) in operators.chunks_exact(size).zip(shares) {
                    for (k, response) in all[station + at].iter_mut().enumerate() {
                        let strain = product(operator, &stretched(info, &cell, k));
                        let stress = apply(&self.regions[region][station - first + at].to_stress, &strain);
                        response.iter_mut().zip(stress).for_each(|(sum, s)| *sum += share * s);
                    }
                }
                station += stations;
            }
        }
        Ok((firsts, all))
    }
}

/// Points at which the slopes of a source are taken.
fn samples(info: &ElementInfo, source: Source) -> Cow<'static, [Point]> {
    match source.sample {
        None if info.is_section() => Cow::Borrowed(Domain::section_points(2)),
        None => Cow::Owned(info.domain.samples().iter().copied().collect()),
        Some(k) => Cow::Owned(vec![info.domain.samples()[k]]),
    }
}

/// Unknowns of a cell whose one strain is ε₁₁, ε₂₂ or γ₁₂ = 1; a section knows ε₁₁ alone.
fn stretched(info: &ElementInfo, cell: &Cell<'_>, strain: usize) -> Vec<f64> {
    // Displacement, and along which coordinate it grows.
    let (n, m) = [(1, 1), (2, 2), (1, 2)][strain];
    let of_node = |at: &[f64; 3]| {
        let x = cell.position(*at)[m - 1];
        info.dofs.iter().map(move |dof| match (dof.n() == n, dof.m()) {
            (true, 0) => x,
            (true, by) if by == m => 1.0,
            _ => 0.0,
        })
    };
    info.nodes.iter().flat_map(of_node).collect()
}

fn product(operator: &[f64], u: &[f64]) -> [f64; 6] {
    let mut strain = [0.0; 6];
    super::add_product(operator, u, &mut strain);
    strain
}
