//! Plies and interfaces with their stresses and failure indices.

use super::Frame;
use super::damaged::Damaged;
use super::lattice::{Height, Lattice};
use super::so_far::SoFar;
use crate::analyses::Stressed;
use crate::analyses::impact::Maximum;
use crate::analyses::stress;
use crate::error::Error;
use crate::model::{FieldPlan, Model, Plan};
use fem_core::domain::Domain;
use fem_core::failure::Site;
use fem_core::recovery::{Recovery, Station};
use fem_core::tensor::{Ply, Stress6};
use fem_failure::scan::Scan;
use fem_io::scene::{FieldCells, FieldSeries};
use fem_io::vtu::{Array, Contents, Grid, Shape, lagrange_hexahedron, quadratic_wedge};

/// Points (i, j) of a sheet over a quad as VTK counts them: corners, then middles of sides and of the quad where it is of second order.
fn face_of(domain: Domain, order: usize) -> Vec<[usize; 2]> {
    match (domain, order) {
        (domain, 1) => domain.lattice_cells(1)[0].to_vec(),
        (Domain::Quadrilateral, _) => {
            vec![[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1], [1, 1]]
        }
        (Domain::Triangle, _) => vec![[0, 0], [2, 0], [0, 2], [1, 0], [1, 1], [0, 1]],
    }
}

/// Points (i, j, k) of a ply over a quad as VTK counts them.
fn prism_of(domain: Domain, order: usize) -> Vec<[usize; 3]> {
    match (domain, order) {
        (domain, 1) => {
            [0, 1].into_iter().flat_map(|k| face_of(domain, 1).into_iter().map(move |[i, j]| [i, j, k])).collect()
        }
        (Domain::Quadrilateral, _) => lagrange_hexahedron(2),
        (Domain::Triangle, _) => quadratic_wedge(),
    }
}

/// Cells over the quads of a lattice, `sheets` over each: prisms, or their faces.
fn shapes(lattice: &Lattice<'_>, sheets: impl Fn(usize) -> usize, prisms: bool) -> Vec<Shape> {
    let of = |quad: usize| match (lattice.domain(quad), prisms, lattice.intervals()) {
        (Domain::Quadrilateral, true, 1) => Shape::Hexahedron,
        (Domain::Quadrilateral, false, 1) => Shape::Quad,
        (Domain::Triangle, true, 1) => Shape::Wedge,
        (Domain::Triangle, false, 1) => Shape::Triangle,
        (Domain::Quadrilateral, true, order) => Shape::Lagrange(order),
        (Domain::Quadrilateral, false, _) => Shape::BiquadraticQuad,
        (Domain::Triangle, true, _) => Shape::QuadraticWedge,
        (Domain::Triangle, false, _) => Shape::QuadraticTriangle,
    };
    (0..lattice.quads()).flat_map(|quad| std::iter::repeat_n(of(quad), sheets(quad))).collect()
}

const DOMAINS: [Domain; 2] = [Domain::Quadrilateral, Domain::Triangle];
const COMPONENTS: [&str; 6] = ["11", "22", "33", "12", "23", "31"];
/// Positions of the shear tractions (31, 23) of an interface among the components.
const SHEAR: [usize; 2] = [5, 4];
const NORMAL: usize = 2;
/// Shares of the stresses at the faces and in the middle of a ply in its mean (Simpson's rule).
const FACES_AND_MIDDLE: [f64; 3] = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0];

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
    damaged: Damaged<'a>,
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
    /// Region of each quad.
    regions: Vec<usize>,
    /// Stations of each sheet of each region: an interface between layers of cells has one on either side.
    stations: Vec<Vec<Vec<usize>>>,
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
        // Cells of second order are bent as those of the mesh.
        let bent = !model.plate.plane.bends.is_empty() && plan.cells == FieldCells::Lagrange;
        let order = if bent { 2 } else { 1 };
        let heights = |region: usize| {
            let stacks = model.plate.stacks(region).iter().enumerate();
            let bottom = Height { layer: 0, q: model.plate.stacks(region)[0].extent()[0] };
            let slices = stacks.flat_map(|(layer, stack)| stack.slices.iter().map(move |slice| (layer, slice.q)));
            let up = |(layer, [low, high]): (usize, [f64; 2])| {
                let middle = bent.then_some(Height { layer, q: 0.5 * (low + high) });
                middle.into_iter().chain([Height { layer, q: high }])
            };
            std::iter::once(bottom).chain(slices.flat_map(up)).collect()
        };
        let lattice = Lattice::new(model, &plan.quads, order, heights);
        let judged = !matches!(model.plan, Plan::Modes { .. } | Plan::Buckling { .. });
        let scan = || Scan::new(model.criteria.clone(), stress::sites(&recovery), model.materials.clone());
        let residual = if judged { stress::residual(model, &recovery)? } else { Vec::new() };
        let mut sheets = Vec::new();
        sheets.extend(plies.then(|| Sheets::plies(model, plan, &lattice, &recovery)));
        sheets.extend(interfaces.then(|| Sheets::interfaces(model, plan, &lattice, &recovery)));
        Ok(Self {
            scan: if judged { Some(scan()?) } else { None },
            so_far: SoFar::new(model, plan),
            damaged: Damaged::new(model, plan),
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
        let arrays = |sheets: &Sheets| self.so_far.arrays(self.model, maxima, sheets.site, &sheets.starts());
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
        let all: Option<Vec<&Stressed>> = frames.iter().map(|frame| frame.state.stressed).collect();
        let stressed = match all.as_deref() {
            Some([first, others @ ..]) => {
                let mut stressed = Stressed::clone(first);
                others.iter().for_each(|other| stressed.extend(other));
                stressed
            }
            _ => Stressed::of(fields.concat()),
        };
        stress::recover(model, &self.recovery, &stressed, count, points.as_deref(), &mut stresses)?;
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
            let (state, starts) = (&frame.state, sheets.starts());
            match sheets.site {
                Site::Ply => {
                    cells.extend(state.points.into_iter().flat_map(|points| self.damaged.of_plies(points, &starts)))
                }
                Site::Interface => {
                    let damaged = |states| self.damaged.of_interfaces(states, state.displacements, &starts);
                    cells.extend(state.interfaces.into_iter().flat_map(damaged));
                }
            }
            let contents = Contents { points: &points, cells: &cells, fixed: &sheets.fixed, ..Contents::default() };
            frame.write(sheets.series, &sheets.grid, contents)?;
        }
        Ok(())
    }

    /// Numbers for each cell of a series that change from frame to frame.
    pub(super) fn changing(&self, sheets: &Sheets) -> usize {
        let [of_plies, of_interfaces] = self.damaged.changing();
        let stress = match sheets.site {
            Site::Ply => COMPONENTS.len() + of_plies,
            Site::Interface if sheets.is_stressed() => 1 + SHEAR.len() + of_interfaces,
            Site::Interface => of_interfaces,
        };
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
        let over = |quad: &usize| model.laminates[model.plate.region(*quad)].plies.iter();
        let count = |quad: usize| over(&plan.quads[quad]).len();
        let order = lattice.intervals();
        let prisms = DOMAINS.map(|domain| prism_of(domain, order));
        let prism = |quad: usize| prisms[usize::from(lattice.domain(quad) == DOMAINS[1])].iter();
        let cells = (0..plan.quads.len()).flat_map(|quad| (0..count(quad)).map(move |ply| (quad, ply)));
        let cells: Vec<u32> = cells
            .flat_map(|(quad, ply)| prism(quad).map(move |[i, j, k]| lattice.point(quad, [*i, *j], order * ply + k)))
            .collect();
        let angles: Vec<f64> = plan.quads.iter().flat_map(|quad| over(quad).map(|ply| ply.angle_deg)).collect();
        let materials: Vec<i64> =
            plan.quads.iter().flat_map(|quad| over(quad).map(|ply| ply.material as i64)).collect();
        Self {
            series: FieldSeries::Plies,
            site: Site::Ply,
            grid: Grid::new(&lattice.positions(), &shapes(lattice, count, true), &cells),
            fixed: vec![
                tags(model, plan, count),
                numbers("ply", plan, count),
                Array::reals("angle_deg", 1, &angles),
                Array::integers("material", materials.into_iter()),
            ],
            points: (0..lattice.len() as u32).collect(),
            regions: regions(model, plan),
            stations: stations(model, recovery, false),
        }
    }

    fn interfaces(model: &Model, plan: &FieldPlan, lattice: &Lattice<'_>, recovery: &Recovery) -> Self {
        let count = |quad: usize| model.laminates[model.plate.region(plan.quads[quad])].plies.len() - 1;
        let order = lattice.intervals();
        let faces = DOMAINS.map(|domain| face_of(domain, order));
        let face = |quad: usize| faces[usize::from(lattice.domain(quad) == DOMAINS[1])].iter();
        let cells = (0..plan.quads.len()).flat_map(|quad| (1..=count(quad)).map(move |height| (quad, height)));
        let mut cells: Vec<u32> = cells
            .flat_map(|(quad, height)| face(quad).map(move |point| lattice.point(quad, *point, order * height)))
            .collect();
        // The two faces of the plate are not interfaces.
        let mut points = cells.clone();
        points.sort_unstable();
        points.dedup();
        cells.iter_mut().for_each(|point| *point = points.partition_point(|p| p < point) as u32);
        let all = lattice.positions();
        let positions: Vec<[f64; 3]> = points.iter().map(|point| all[*point as usize]).collect();
        Self {
            series: FieldSeries::Interfaces,
            site: Site::Interface,
            grid: Grid::new(&positions, &shapes(lattice, count, false), &cells),
            fixed: vec![tags(model, plan, count), numbers("ply_below", plan, count)],
            points,
            regions: regions(model, plan),
            stations: stations(model, recovery, true),
        }
    }

    /// Sites of each cell.
    fn sites<'a>(&'a self, recovery: &'a Recovery) -> impl Iterator<Item = impl Iterator<Item = usize> + Clone> {
        let of_quad = move |(quad, region): (usize, &usize)| {
            let first = recovery.sites_over(quad).start;
            self.stations[*region].iter().map(move |of| of.iter().map(move |s| first + s))
        };
        self.regions.iter().enumerate().flat_map(of_quad)
    }

    /// First cell over each quad, and the number of all at the end.
    fn starts(&self) -> Vec<usize> {
        let mut starts = vec![0];
        self.regions.iter().for_each(|region| starts.push(starts[starts.len() - 1] + self.stations[*region].len()));
        starts
    }

    /// Whether stresses are known here: those of interfaces where they are of a material.
    fn is_stressed(&self) -> bool {
        self.stations.iter().flatten().any(|of| !of.is_empty())
    }

    /// Stresses of a ply in its axes, means over its height; tractions of an interface in the plate's, means of both sides.
    fn stresses(&self, recovery: &Recovery, stresses: &[f64]) -> Vec<Array> {
        if !self.is_stressed() {
            return Vec::new();
        }
        let mut means = Vec::with_capacity(6 * self.grid.cells());
        for sites in self.sites(recovery) {
            let shares: &[f64] = match sites.clone().count() {
                1 => &[1.0],
                2 => &[0.5; 2],
                _ => &FACES_AND_MIDDLE,
            };
            let mean =
                |k: usize| sites.clone().zip(shares).map(|(site, share)| share * stresses[6 * site + k]).sum::<f64>();
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
            for (cell, window) in around {
                // A window lies in one region: of cells of others that hold its centre it says nothing.
                let (here, there) = (recovery.sites_over(*cell), recovery.sites_over(*window));
                if model.plate.region(recovery.centres[*cell].quad)
                    == model.plate.region(recovery.centres[*window].quad)
                {
                    for (here, there) in here.zip(there) {
                        of_sites[here] = larger(of_sites[here], of_sites[there]);
                    }
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
fn tags(model: &Model, plan: &FieldPlan, sheets: impl Fn(usize) -> usize) -> Array {
    let tag = |quad: usize| model.plate.plane.quad_tags[plan.quads[quad]] as i64;
    let tags: Vec<i64> = (0..plan.quads.len()).flat_map(|quad| std::iter::repeat_n(tag(quad), sheets(quad))).collect();
    Array::integers("cell", tags.into_iter())
}

/// 1, 2, … from the bottom of each quad.
fn numbers(name: &str, plan: &FieldPlan, sheets: impl Fn(usize) -> usize) -> Array {
    let numbers: Vec<i64> = (0..plan.quads.len()).flat_map(|quad| 1..=sheets(quad) as i64).collect();
    Array::integers(name, numbers.into_iter())
}

/// Region of each quad.
fn regions(model: &Model, plan: &FieldPlan) -> Vec<usize> {
    plan.quads.iter().map(|quad| model.plate.region(*quad)).collect()
}

/// Stations of each ply of each region, or of the interface above it.
fn stations(model: &Model, recovery: &Recovery, interface: bool) -> Vec<Vec<Vec<usize>>> {
    let of = |region: usize, sheet: usize| {
        let here = |(_, s): &(usize, &Station)| s.interface == interface && s.ply == sheet;
        recovery.stations_of(region).iter().enumerate().filter(here).map(|(station, _)| station).collect()
    };
    let sheets = |region: usize| 0..model.laminates[region].plies.len() - usize::from(interface);
    (0..model.laminates.len()).map(|region| sheets(region).map(|sheet| of(region, sheet)).collect()).collect()
}
