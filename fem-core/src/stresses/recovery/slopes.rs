//! What the slopes of deflections add to stresses: von Kármán's strains ½ w,x², ½ w,y² and w,x w,y, alike in all plies of a cell.

use super::{Parts, Recovery};
use crate::contracts::element::{Cell, Element, ElementError, ElementInfo, Point, Scratch, form, positive};
use crate::plates::plate::Plate;
use crate::plates::slopes::add_slopes;
use crate::plates::window::Source;
use crate::words::domain::Domain;
use crate::words::tensor::apply;
use std::borrow::Cow;
use std::ops::Range;

/// Stress of a site per unit of each of the three strains, Pa, on the axes of its station.
pub type Response = [[f64; 6]; 3];

/// Slopes of several deflections where a [`Recovery`] looks, and what their products do at its sites.
#[derive(Debug, Clone)]
pub struct Slopes {
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
    /// Number of fields.
    pub fn fields(&self) -> usize {
        self.fields
    }

    /// ∂w/∂x of all fields at each point, then ∂w/∂y.
    pub fn rows(&self) -> &[f64] {
        &self.rows
    }

    /// Points over the `place`-th window's layer, with their shares in the mean.
    pub fn points(&self, place: usize) -> impl Iterator<Item = (usize, f64)> {
        self.points[self.starts[place]..self.starts[place + 1]].iter().map(|(point, share)| (*point as usize, *share))
    }

    /// Which window's layer a site lies in.
    pub fn place(&self, site: usize) -> usize {
        self.sites[site].0 as usize
    }

    /// Stress of a site per unit of ½ w,x², ½ w,y² and w,x w,y in its window's layer.
    pub fn response(&self, site: usize) -> &Response {
        &self.responses[self.sites[site].1 as usize]
    }
}

impl Recovery {
    /// Slopes of the deflections of displacement fields, `u` as of [`Recovery::stresses`], in the middle of the cells' heights.
    ///
    /// A mean over a cell is one over its [samples](Domain::samples): exact for the products of slopes that are linear in it.
    ///
    /// # Errors
    /// A cell that the element refuses.
    pub fn slopes(
        &self,
        plate: &Plate,
        element: &dyn Element,
        u: &[f64],
        fields: usize,
    ) -> Result<Slopes, ElementError> {
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
            for layer in 0..plate.stacks(self.region_of[i]).len() {
                for (source, share) in window {
                    let of_source = of_sources[*source][layer].clone();
                    points.extend(of_source.map(|point| (point as u32, share * shares[point])));
                }
                starts.push(points.len());
            }
        }
        Ok(Slopes { fields, rows, points, starts, sites, responses })
    }

    /// Adds to `out` what the slopes of each field add to its stresses; as [`Recovery::stresses`].
    pub(super) fn add_bent(
        &self,
        plate: &Plate,
        element: &dyn Element,
        u: &[f64],
        fields: usize,
        out: &mut [f64],
    ) -> Result<(), ElementError> {
        let slopes = self.slopes(plate, element, u, fields)?;
        let (mut strains, mut known) = (vec![[0.0; 3]; fields], None);
        for site in 0..self.sites() {
            let place = slopes.place(site);
            if known.replace(place) != Some(place) {
                strains.fill([0.0; 3]);
                for (point, share) in slopes.points(place) {
                    let (x, y) = slopes.rows[2 * fields * point..][..2 * fields].split_at(fields);
                    for ((strain, x), y) in strains.iter_mut().zip(x).zip(y) {
                        *strain = [
                            strain[0] + 0.5 * share * x * x,
                            strain[1] + 0.5 * share * y * y,
                            strain[2] + share * x * y,
                        ];
                    }
                }
            }
            let response = slopes.response(site);
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
