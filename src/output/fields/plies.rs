//! Plies and interfaces with their stresses and failure indices.

use super::Frame;
use super::lattice::{Height, Lattice};
use super::so_far::SoFar;
use crate::analyses::impact::Maximum;
use crate::analyses::stress;
use crate::error::Error;
use crate::model::{FieldPlan, Model, Plan};
use fem_core::domain::Domain;
use fem_core::failure::Site;
use fem_core::recovery::{Recovery, Station};
use fem_core::tensor::{Ply, Stress6};
use fem_failure::scan::Scan;
use fem_io::scene::FieldSeries;
use fem_io::vtu::{Array, Contents, Grid, Shape};

/// Points over the corners of a quad at a height of a lattice of one interval.
fn face(lattice: &Lattice<'_>, quad: usize, height: usize) -> Vec<u32> {
    let corners = lattice.domain(quad).lattice_cells(1)[0];
    corners.into_iter().map(|corner| lattice.point(quad, corner, height)).collect()
}

/// Linear cells over the quads of a lattice, `sheets` over each: prisms, or their faces.
fn shapes(lattice: &Lattice<'_>, sheets: usize, prisms: bool) -> Vec<Shape> {
    let of = |quad: usize| match (lattice.domain(quad), prisms) {
        (Domain::Quadrilateral, true) => Shape::Hexahedron,
        (Domain::Quadrilateral, false) => Shape::Quad,
        (Domain::Triangle, true) => Shape::Wedge,
        (Domain::Triangle, false) => Shape::Triangle,
    };
    (0..lattice.quads()).flat_map(|quad| std::iter::repeat_n(of(quad), sheets)).collect()
}

const COMPONENTS: [&str; 6] = ["11", "22", "33", "12", "23", "31"];
/// Positions of the shear tractions (31, 23) of an interface among the components.
const SHEAR: [usize; 2] = [5, 4];
const NORMAL: usize = 2;

/// The series `plies` and `interfaces`.
#[derive(Debug)]
pub(super) struct Plies<'a> {
    model: &'a Model,
    lattice: Lattice<'a>,
    recovery: Recovery,
    /// Cells and the windows that lie in them or their images, both by number, beside that around the centre of each.
    around: Vec<(usize, usize)>,
    residual: Vec<f64>,
    /// Finds indices; a natural mode has none.
    scan: Option<Scan>,
    so_far: SoFar<'a>,
    pub(super) sheets: Vec<Sheets>,
    states: Vec<Stress6<Ply>>,
}

/// One of the two series: cells over the quads, one above the other.
#[derive(Debug)]
pub(super) struct Sheets {
    series: FieldSeries,
    site: Site,
    pub(super) grid: Grid,
    pub(super) fixed: Vec<Array>,
    /// Points of the lattice that the grid has.
    points: Vec<u32>,
    /// Stations of each sheet: an interface between layers of cells has one on either side.
    stations: Vec<Vec<usize>>,
}

impl<'a> Plies<'a> {
    /// # Errors
    /// A criterion whose material lacks a constant.
    pub(super) fn new(model: &'a Model, plan: &FieldPlan, plies: bool, interfaces: bool) -> Result<Self, Error> {
        let recovery = stress::recovery(model, &plan.quads, &model.centres, interfaces);
        let shown = |quads: &[usize]| -> Vec<usize> {
            plan.quads.iter().enumerate().filter(|(_, quad)| quads.contains(quad)).map(|(cell, _)| cell).collect()
        };
        let windows = model.centre_cells.iter().zip(plan.quads.len()..);
        let around =
            windows.flat_map(|(quads, window)| shown(quads).into_iter().map(move |cell| (cell, window))).collect();
        let stacks = model.plate.stacks(0).iter().enumerate();
        let tops = stacks.flat_map(|(layer, stack)| stack.slices.iter().map(move |s| Height { layer, q: s.q[1] }));
        let heights = [Height { layer: 0, q: -1.0 }].into_iter().chain(tops).collect();
        let lattice = Lattice::new(model, &plan.quads, 1, heights);
        let judged = !matches!(model.plan, Plan::Modes { .. } | Plan::Buckling { .. });
        let scan = || Scan::new(model.criteria.clone(), stress::sites(&recovery), model.materials.clone());
        let residual = if judged { stress::residual(model, &recovery)? } else { Vec::new() };
        let mut sheets = Vec::new();
        sheets.extend(plies.then(|| Sheets::plies(model, plan, &lattice, &recovery)));
        sheets.extend(interfaces.then(|| Sheets::interfaces(model, plan, &lattice, &recovery)));
        Ok(Self {
            scan: if judged { Some(scan()?) } else { None },
            so_far: SoFar::new(model, plan),
            states: vec![Stress6::new([0.0; 6]); recovery.sites()],
            model,
            lattice,
            recovery,
            around,
            residual,
            sheets,
        })
    }

    /// What the stresses and displacements of a frame take, bytes.
    pub(super) fn bytes_of_frame(&self) -> usize {
        (6 * self.recovery.sites() + 3 * self.lattice.len()) * size_of::<f64>()
    }

    /// What the criteria of a march have found, for each of the series.
    pub(super) fn so_far(&self, maxima: &[Maximum]) -> Vec<(FieldSeries, Vec<Array>)> {
        let arrays = |sheets: &Sheets| self.so_far.arrays(self.model, maxima, sheets.site, sheets.stations.len());
        self.sheets.iter().map(|sheets| (sheets.series, arrays(sheets))).collect()
    }

    pub(super) fn has(&self, series: FieldSeries) -> bool {
        self.sheets.iter().any(|sheets| sheets.series == series)
    }

    pub(super) fn write(&mut self, frames: &[Frame<'_>]) -> Result<(), Error> {
        let rows = 6 * self.recovery.sites();
        let mut stresses = vec![0.0; rows * frames.len()];
        let fields: Vec<&[f64]> = frames.iter().map(|frame| frame.state.displacements).collect();
        let points: Option<Vec<&[f64]>> = frames.iter().map(|frame| frame.state.points).collect();
        let points = points.map(|points| points.concat());
        let (model, count) = (self.model, frames.len());
        stress::recover(model, &self.recovery, &fields.concat(), count, points.as_deref(), &mut stresses)?;
        stress::add(&mut stresses, &self.residual);
        let displacements = self.lattice.values(&fields);
        let each = frames.iter().zip(&displacements).zip(stresses.chunks_exact(rows));
        each.into_iter()
            .try_for_each(|((frame, displacements), stresses)| self.write_one(frame, displacements, stresses))
    }

    fn write_one(&mut self, frame: &Frame<'_>, displacements: &[f64], stresses: &[f64]) -> Result<(), Error> {
        let Self { model, recovery, states, .. } = self;
        for (state, s) in states.iter_mut().zip(stresses.chunks_exact(6)) {
            *state = Stress6::new([s[0], s[1], s[2], s[3], s[4], s[5]]);
        }
        if let Some(scan) = &mut self.scan {
            scan.sample(frame.time(), states)?;
        }
        for sheets in &self.sheets {
            let of_points = sheets.points.iter().flat_map(|p| &displacements[3 * *p as usize..][..3]);
            let points = [Array::reals("displacement", 3, &of_points.copied().collect::<Vec<_>>())];
            let mut cells = sheets.stresses(recovery, stresses);
            if let Some(scan) = &self.scan {
                sheets.indices(model, recovery, &self.around, scan, &mut cells);
            }
            let known = frame.so_far.iter().filter(|(series, _)| *series == sheets.series);
            cells.extend(known.flat_map(|(_, arrays)| arrays).cloned());
            let contents = Contents { points: &points, cells: &cells, fixed: &sheets.fixed, ..Contents::default() };
            frame.write(sheets.series, &sheets.grid, contents)?;
        }
        Ok(())
    }

    /// Numbers for each cell of a series that change from frame to frame.
    pub(super) fn changing(&self, sheets: &Sheets) -> usize {
        let stress = if sheets.site == Site::Ply { COMPONENTS.len() } else { 1 + SHEAR.len() };
        let judged = self.model.criteria.iter().filter(|(_, criterion)| criterion.info().site == sheets.site);
        // Beside the index of the frame that of all samples so far; times of onsets are few.
        let indices = match self.model.plan {
            Plan::Impact(_) => 2,
            Plan::Static { .. } => 1,
            Plan::Modes { .. } | Plan::Buckling { .. } => 0,
        };
        stress + indices * judged.count()
    }
}

impl Sheets {
    fn plies(model: &Model, plan: &FieldPlan, lattice: &Lattice<'_>, recovery: &Recovery) -> Self {
        let plies = &model.laminate.plies;
        let over = |quad: &usize| model.laminates[model.plate.region(*quad)].plies.iter();
        let face = |quad: usize, height: usize| face(lattice, quad, height);
        let cells = (0..plan.quads.len()).flat_map(|quad| (0..plies.len()).map(move |ply| (quad, ply)));
        let cells: Vec<u32> = cells.flat_map(|(quad, ply)| [face(quad, ply), face(quad, ply + 1)].concat()).collect();
        let angles: Vec<f64> = plan.quads.iter().flat_map(|quad| over(quad).map(|ply| ply.angle_deg)).collect();
        let materials: Vec<i64> =
            plan.quads.iter().flat_map(|quad| over(quad).map(|ply| ply.material as i64)).collect();
        Self {
            series: FieldSeries::Plies,
            site: Site::Ply,
            grid: Grid::new(&lattice.positions(), &shapes(lattice, plies.len(), true), &cells),
            fixed: vec![
                tags(model, plan, plies.len()),
                numbers("ply", plan, plies.len()),
                Array::reals("angle_deg", 1, &angles),
                Array::integers("material", materials.into_iter()),
            ],
            points: (0..lattice.len() as u32).collect(),
            stations: stations(recovery, plies.len(), false),
        }
    }

    fn interfaces(model: &Model, plan: &FieldPlan, lattice: &Lattice<'_>, recovery: &Recovery) -> Self {
        let count = model.laminate.plies.len() - 1;
        let face = |quad: usize, height: usize| face(lattice, quad, height);
        let cells = (0..plan.quads.len()).flat_map(|quad| (1..=count).map(move |height| (quad, height)));
        let mut cells: Vec<u32> = cells.flat_map(|(quad, height)| face(quad, height)).collect();
        // The two faces of the plate are not interfaces.
        let inside = |point: &u32| (1..=count).contains(&(*point as usize % (count + 2)));
        let points: Vec<u32> = (0..lattice.len() as u32).filter(inside).collect();
        cells.iter_mut().for_each(|point| *point = points.partition_point(|p| p < point) as u32);
        let all = lattice.positions();
        let positions: Vec<[f64; 3]> = points.iter().map(|point| all[*point as usize]).collect();
        Self {
            series: FieldSeries::Interfaces,
            site: Site::Interface,
            grid: Grid::new(&positions, &shapes(lattice, count, false), &cells),
            fixed: vec![tags(model, plan, count), numbers("ply_below", plan, count)],
            points,
            stations: stations(recovery, count, true),
        }
    }

    /// Sites of each cell.
    fn sites<'a>(&'a self, recovery: &'a Recovery) -> impl Iterator<Item = impl Iterator<Item = usize> + Clone> {
        let width = recovery.stations.len();
        let quads = 0..self.grid.cells() / self.stations.len();
        quads.flat_map(move |quad| self.stations.iter().map(move |of| of.iter().map(move |s| quad * width + s)))
    }

    /// Stresses of a ply in its axes, tractions of an interface in the plate's: means of both sides.
    fn stresses(&self, recovery: &Recovery, stresses: &[f64]) -> Vec<Array> {
        let mut means = Vec::with_capacity(6 * self.grid.cells());
        for sites in self.sites(recovery) {
            let share = 1.0 / sites.clone().count() as f64;
            let mean = |k: usize| sites.clone().map(|site| share * stresses[6 * site + k]).sum::<f64>();
            means.extend((0..6).map(mean));
        }
        if self.site == Site::Ply {
            return vec![Array::reals("stress", 6, &means).with_components(&COMPONENTS)];
        }
        let some =
            |of: &[usize]| -> Vec<f64> { means.chunks_exact(6).flat_map(|s| of.iter().map(|k| s[*k])).collect() };
        vec![
            Array::reals("normal_traction", 1, &some(&[NORMAL])),
            Array::reals("shear_traction", 2, &some(&SHEAR)).with_components(&["31", "23"]),
        ]
    }

    /// Adds the largest index of each criterion in all windows of a cell, and the number of its mode.
    fn indices(
        &self,
        model: &Model,
        recovery: &Recovery,
        around: &[(usize, usize)],
        scan: &Scan,
        cells: &mut Vec<Array>,
    ) {
        for (number, (name, criterion)) in model.criteria.iter().enumerate() {
            if criterion.info().site != self.site {
                continue;
            }
            let mut of_sites = vec![(0, f64::NEG_INFINITY); recovery.sites()];
            for (site, indices) in scan.latest(number) {
                of_sites[site] = (1..).zip(indices.iter().copied()).fold((0, f64::NEG_INFINITY), larger);
            }
            let width = recovery.stations.len();
            for (cell, window) in around {
                for station in 0..width {
                    let here = cell * width + station;
                    of_sites[here] = larger(of_sites[here], of_sites[window * width + station]);
                }
            }
            let largest = self.sites(recovery).map(|sites| {
                let (mode, index) = sites.map(|site| of_sites[site]).fold((0, f64::NEG_INFINITY), larger);
                if index > 0.0 { (mode, index.min(f64::from(f32::MAX))) } else { (0, index) }
            });
            let (modes, indices): (Vec<i64>, Vec<f64>) = largest.unzip();
            cells.push(Array::reals(format!("{name} index"), 1, &indices));
            cells.push(Array::integers(format!("{name} mode"), modes.into_iter()));
        }
    }
}

/// The first of two modes, unless the index of the second is larger.
fn larger(a: (i64, f64), b: (i64, f64)) -> (i64, f64) {
    if b.1 > a.1 { b } else { a }
}

/// Number of each cell's quad in the mesh file.
fn tags(model: &Model, plan: &FieldPlan, sheets: usize) -> Array {
    let tag = |quad: &usize| model.plate.plane.quad_tags[*quad] as i64;
    let tags: Vec<i64> = plan.quads.iter().flat_map(|quad| std::iter::repeat_n(tag(quad), sheets)).collect();
    Array::integers("cell", tags.into_iter())
}

/// 1, 2, … from the bottom of each quad.
fn numbers(name: &str, plan: &FieldPlan, sheets: usize) -> Array {
    Array::integers(name, plan.quads.iter().flat_map(|_| 1..=sheets as i64))
}

/// Stations of each ply, or of the interface above it.
fn stations(recovery: &Recovery, sheets: usize, interface: bool) -> Vec<Vec<usize>> {
    let of = |sheet: usize| {
        let here = |(_, s): &(usize, &Station)| s.interface == interface && s.ply == sheet;
        recovery.stations.iter().enumerate().filter(here).map(|(station, _)| station).collect()
    };
    (0..sheets).map(of).collect()
}
