//! Stresses along a march: sampled, recovered in batches, handed to the scan.

use super::expansion::{Expansion, Stressed};
use super::operator::{LANES, put};
use super::samples::{PlateSamples, PlateStresses, Way};
use crate::error::Error;
use crate::forecast::Demand;
use crate::model::{Model, NamedCriterion, Plan};
use crate::words::name_ply_of;
use fem_core::failure::Site;
use fem_core::laws::PlyLaws;
use fem_core::recovery::{Recovery, Station, Strains};
use fem_core::tensor::{Ply, Stress6};
use fem_core::window::{self, Centre, Windows};
use fem_failure::scan::{self, PlyOrInterface, Probe, Scan, ScanSite, Wanted};
use fem_io::scene::Window;
use serde::{Deserialize, Serialize};
use std::rc::Rc;
use std::sync::Arc;

/// Indices of one criterion at one place over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct IndexHistory {
    /// Number of the criterion in the model.
    pub criterion: usize,
    /// The place.
    pub site: ScanSite,
    /// Times of the samples, s.
    pub times: Vec<f64>,
    /// One index per mode for each of them; where two layers of cells meet, the larger of the two sides.
    pub indices: Vec<f64>,
}

impl IndexHistory {
    /// Takes the indices at time `t` from every side of the place: the largest of each mode.
    fn take<'a>(&mut self, t: f64, sides: impl Iterator<Item = &'a [f64]>) {
        self.times.push(t);
        let start = self.indices.len();
        for side in sides {
            self.indices.resize(start + side.len(), f64::NEG_INFINITY);
            for (largest, index) in self.indices[start..].iter_mut().zip(side) {
                *largest = largest.max(*index);
            }
        }
    }
}

/// Watches the stresses of a march with the criteria of a model.
#[derive(Debug)]
pub(super) struct Watch<'a> {
    model: &'a Model,
    expansion: Rc<Expansion<'a>>,
    of_plate: Arc<PlateStresses>,
    scan: Scan,
    /// What is wanted, where only what can add to it is judged, when all samples are there.
    sparing: Option<Wanted>,
    samples: Option<PlateSamples>,
    /// Where the scan keeps the indices of each history.
    probes: Vec<Vec<Probe>>,
    stresses: Vec<f64>,
    states: Vec<Stress6<Ply>>,
    record: Record,
}

/// What a watch keeps beside its scan.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Record {
    /// What the gauges saw.
    histories: Vec<IndexHistory>,
    /// Times of the samples waiting, and their coordinates. They are saved as they are, because a sum in another batch may
    /// differ in its last bit.
    times: Vec<f64>,
    waiting: Vec<f64>,
    /// Their states of plies that follow laws.
    points: Vec<f64>,
}

impl<'a> Watch<'a> {
    /// Prepares the scan of `model`, which is marched in the coordinates of `expansion`; where `wanted` says what may be looked for
    /// when all samples are there, it judges only what can add to that, if the stresses are products and no single place is followed.
    ///
    /// # Errors
    /// A criterion whose material lacks a constant.
    pub(super) fn new(
        model: &'a Model,
        expansion: Rc<Expansion<'a>>,
        of_plate: Arc<PlateStresses>,
        wanted: Option<Wanted>,
    ) -> Result<Self, Error> {
        let recovery = &of_plate.recovery;
        let scan = Scan::new(model.criteria.clone(), sites(recovery), model.materials.clone())?;
        let of_cells = (0..model.watched.len()).map(|window| recovery.sites_over(window).len()).sum();
        let (probes, histories): (Vec<_>, Vec<_>) = gauges(model, &scan, of_cells).into_iter().unzip();
        let sparing = wanted.filter(|_| histories.is_empty() && matches!(of_plate.way, Way::Product(_)));
        Ok(Self {
            model,
            expansion,
            sparing,
            samples: None,
            probes,
            scan,
            record: Record { histories, ..Record::default() },
            stresses: Vec::new(),
            states: vec![Stress6::new([0.0; 6]); recovery.sites()],
            of_plate,
        })
    }

    /// Takes a sample: coordinates of the march at time `t`, states of plies that follow laws.
    ///
    /// # Errors
    /// A stress or an index that is not finite.
    pub(super) fn sample(&mut self, t: f64, coordinates: &[f64], points: &[f64]) -> Result<(), Error> {
        self.record.points.extend_from_slice(points);
        self.record.times.push(t);
        self.record.waiting.extend_from_slice(coordinates);
        if self.sparing.is_none() && self.record.times.len() >= Demand::BATCH { self.flush() } else { Ok(()) }
    }

    /// Scans the samples still waiting.
    ///
    /// # Errors
    /// As [`Watch::sample`].
    pub(super) fn flush(&mut self) -> Result<(), Error> {
        if let Some(wanted) = self.sparing {
            let Record { times, waiting, .. } = std::mem::take(&mut self.record);
            let samples = PlateSamples::new(Arc::clone(&self.of_plate), times, waiting);
            return Ok(self.samples.insert(samples).survey(&mut self.scan, wanted)?);
        }
        let [times, waiting, points] =
            [&mut self.record.times, &mut self.record.waiting, &mut self.record.points].map(std::mem::take);
        let mut stresses = std::mem::take(&mut self.stresses);
        stresses.resize(6 * self.sites() * Demand::BATCH, 0.0);
        let [width, states] = [&waiting, &points].map(|all| all.len() / times.len().max(1));
        // A watch that judged all samples at its end may have left more of them than a batch.
        let done = (0..).step_by(Demand::BATCH).zip(times.chunks(Demand::BATCH)).try_for_each(|(first, times)| {
            let end = first + times.len();
            let (waiting, points) = (&waiting[first * width..end * width], &points[first * states..end * states]);
            self.scan_batch(times, waiting, points, &mut stresses)
        });
        self.stresses = stresses;
        done
    }

    /// The scan as it would be with the samples still waiting; these wait on, because a sum in another batch may differ in its last
    /// bit.
    ///
    /// # Errors
    /// As [`Watch::sample`].
    pub(super) fn so_far(&self) -> Result<Scan, Error> {
        let Record { times, waiting, points, .. } = &self.record;
        let (mut scan, rows) = (self.scan.clone(), 6 * self.sites());
        let (mut stresses, mut states) = (vec![0.0; rows * times.len()], self.states.clone());
        self.recover_batch(waiting, points, times.len(), &mut stresses)?;
        for (t, stresses) in times.iter().zip(stresses.chunks_exact(rows)) {
            fill(&mut states, stresses);
            scan.sample(*t, &states)?;
        }
        Ok(scan)
    }

    fn scan_batch(
        &mut self,
        times: &[f64],
        waiting: &[f64],
        points: &[f64],
        stresses: &mut [f64],
    ) -> Result<(), Error> {
        let rows = 6 * self.sites();
        let stresses = &mut stresses[..rows * times.len()];
        self.recover_batch(waiting, points, times.len(), stresses)?;
        for (t, stresses) in times.iter().zip(stresses.chunks_exact(rows)) {
            fill(&mut self.states, stresses);
            self.scan.sample(*t, &self.states)?;
            for (probes, history) in self.probes.iter().zip(&mut self.record.histories) {
                history.take(*t, probes.iter().map(|probe| self.scan.read(*probe)));
            }
        }
        Ok(())
    }

    /// Stresses of all sites in `count` samples, sample by sample.
    fn recover_batch(&self, waiting: &[f64], points: &[f64], count: usize, out: &mut [f64]) -> Result<(), Error> {
        if count == 0 {
            return Ok(());
        }
        let PlateStresses { recovery, way } = &*self.of_plate;
        let rows = 6 * recovery.sites();
        match way {
            Way::Product(operator) => {
                let columns = operator.columns(&operator.extended(waiting));
                let mut samples = [Stress6::new([0.0; 6]); LANES];
                for site in 0..recovery.sites() {
                    put(&operator.stresses(site, &columns), &mut samples[..count]);
                    for (out, sample) in out.chunks_exact_mut(rows).zip(&samples) {
                        out[6 * site..6 * site + 6].copy_from_slice(&sample.0);
                    }
                }
            }
            Way::Recovery(residual) => {
                recover(self.model, recovery, &self.expansion.stressed(waiting, count), count, Some(points), out)?;
                add(out, residual);
            }
        }
        Ok(())
    }

    /// What the scan found.
    pub(super) fn scan(&self) -> &Scan {
        &self.scan
    }

    /// All samples, where only what can be first or largest was judged.
    pub(super) fn into_samples(self) -> Option<PlateSamples> {
        self.samples
    }

    /// What the gauges saw.
    pub(super) fn histories(&self) -> &[IndexHistory] {
        &self.record.histories
    }

    /// What scan and watch have seen, to be kept.
    pub(super) fn record(&self) -> (&scan::ScanRecord, &Record) {
        (self.scan.record(), &self.record)
    }

    /// Continues from what a watch of the same model has seen, marched in coordinates of this `width`; `false` where the
    /// records are of another size.
    pub(super) fn resume(&mut self, scan: scan::ScanRecord, record: Record, width: usize) -> bool {
        let count = record.times.len();
        let states = self.model.laws.as_ref().map_or(0, PlyLaws::states);
        let same = |(now, then): (&IndexHistory, &IndexHistory)| {
            let modes = self.model.criteria[now.criterion].1.info().modes.len();
            let sound = then.indices.len() == then.times.len() * modes;
            sound && (now.criterion, now.site) == (then.criterion, then.site)
        };
        let fits = record.waiting.len() == count * width
            && record.points.len() == count * states
            && record.histories.len() == self.record.histories.len()
            && self.record.histories.iter().zip(&record.histories).all(same)
            && self.scan.resume(scan);
        if fits {
            self.record = record;
            self.sparing = self.sparing.filter(|_| !self.scan.has_begun());
        }
        fits
    }

    /// Number of sites watched.
    pub(super) fn sites(&self) -> usize {
        self.of_plate.recovery.sites()
    }
}

/// Stresses of all sites, six numbers each, as states.
fn fill(states: &mut [Stress6<Ply>], stresses: &[f64]) {
    for (state, s) in states.iter_mut().zip(stresses.chunks_exact(6)) {
        *state = Stress6::new([s[0], s[1], s[2], s[3], s[4], s[5]]);
    }
}

/// The smallest factor on the stresses that brings a criterion to failure, and where; without large deflections it is a
/// factor on the loads as well.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct Margin {
    pub criterion: String,
    pub mode: String,
    pub reserve_factor: f64,
    pub cell: u64,
    pub ply: String,
    pub x_m: f64,
    pub y_m: f64,
    pub z_m: f64,
}

/// The margin of each criterion for displacements `u` (before elimination of constraints); none for a criterion that no
/// multiple of the stresses brings to failure.
///
/// # Errors
/// A cell that the element refuses, a stress that is not finite.
pub(crate) fn margins(model: &Model, u: &[f64]) -> Result<Vec<Margin>, Error> {
    if model.criteria.is_empty() {
        return Ok(Vec::new());
    }
    let recovery = build_recovery(model);
    let mut stresses = vec![0.0; 6 * recovery.sites()];
    recover(model, &recovery, &Stressed::of(u.to_vec()), 1, Some(&virgin(model)), &mut stresses)?;
    add(&mut stresses, &residual(model, &recovery)?);
    if !stresses.iter().all(|s| s.is_finite()) {
        return Err(Error::NotFinite("stress"));
    }
    let sites = sites(&recovery);
    let smallest = |(name, criterion): &NamedCriterion| {
        let states = sites.iter().zip(stresses.chunks_exact(6));
        let judged = states.filter(|(site, _)| site.place.site() == criterion.info().site);
        let reserves = judged.filter_map(|(site, s)| {
            let state = Stress6::new([s[0], s[1], s[2], s[3], s[4], s[5]]);
            let reserve = criterion.reserve_factor(&state, &model.materials[usize::from(site.material)]);
            let mode = reserve.mode.filter(|_| reserve.factor.is_finite())?;
            Some((site, reserve.factor, mode))
        });
        let (site, reserve_factor, mode) = reserves.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Margin {
            criterion: name.clone(),
            mode: criterion.info().modes[mode].to_owned(),
            reserve_factor,
            cell: model.plate.plane.quad_tags[site.cell as usize],
            ply: name_ply_of(site.place, model.region_of(site.cell as usize)),
            x_m: site.position[0],
            y_m: site.position[1],
            z_m: site.position[2],
        })
    };
    Ok(model.criteria.iter().filter_map(smallest).collect())
}

/// Stresses of all sites that do not follow from displacements, six each; empty where there are none.
///
/// # Errors
/// A material that lacks a constant.
pub(crate) fn residual(model: &Model, recovery: &Recovery) -> Result<Vec<f64>, Error> {
    model.effects.stresses(&model.body(), recovery)
}

/// Adds the residual stresses of all sites to those of one field or several.
pub(crate) fn add(stresses: &mut [f64], residual: &[f64]) {
    if !residual.is_empty() {
        for field in stresses.chunks_exact_mut(residual.len()) {
            field.iter_mut().zip(residual).for_each(|(s, r)| *s += r);
        }
    }
}

/// States of plies to which nothing has happened.
pub(crate) fn virgin(model: &Model) -> Vec<f64> {
    vec![0.0; model.laws.as_ref().map_or(0, PlyLaws::states)]
}

/// Stresses of `count` fields, one after the other, without those that do not follow from displacements. `points` are the states of plies that follow laws, field by field; without them
/// stresses are those of linear elasticity.
///
/// # Errors
/// A cell that the element refuses.
pub(crate) fn recover(
    model: &Model,
    recovery: &Recovery,
    stressed: &Stressed,
    count: usize,
    points: Option<&[f64]>,
    out: &mut [f64],
) -> Result<(), Error> {
    let (plate, element, u) = (&model.plate, &*model.element, &stressed.u);
    recovery.stresses(plate, element, u, count, out)?;
    if let Some(tension) = stressed.tension(0, count) {
        recovery.add_tension(plate, element, tension, out)?;
    }
    let Some((laws, points)) = model.laws.as_ref().zip(points) else { return Ok(()) };
    let fields = u.chunks_exact(plate.ndof()).zip(out.chunks_exact_mut(6 * recovery.sites()));
    for (field, (u, out)) in fields.enumerate() {
        let points = &points[field * laws.states()..(field + 1) * laws.states()];
        recovery.put_lawful(plate, element, laws, (u, points, stressed.tension(field, 1)), out)?;
    }
    Ok(())
}

/// Where the criteria look.
pub(super) fn build_recovery(model: &Model) -> Recovery {
    recovery(model, &model.watched, &model.centres, looks_between(model))
}

/// The same in `quads` alone.
pub(super) fn of_cells(model: &Model, quads: &[usize]) -> Recovery {
    recovery(model, quads, &[], looks_between(model))
}

/// Whether a criterion looks between plies: where nobody looks there is nothing to recover.
pub(super) fn looks_between(model: &Model) -> bool {
    model.criteria.iter().any(|(_, criterion)| criterion.info().site == Site::Interface)
}

/// The stresses of `quads` as the criteria see them, and those around further `centres`; those of interfaces where these are wanted
/// and the scene has some.
pub(crate) fn recovery(model: &Model, quads: &[usize], centres: &[Centre], interfaces: bool) -> Recovery {
    let mesh = &model.plate.plane;
    let windows: Vec<_> = match model.window {
        Window::Element => quads.iter().map(|quad| window::own(mesh, *quad)).collect(),
        Window::Square(side) => {
            let windows = Windows::new(mesh, (side, model.laminate.plies[0].angle), |quad| model.plate.region(quad));
            let of_cells = quads.iter().map(|quad| windows.of_cell(*quad));
            of_cells.chain(centres.iter().map(|centre| windows.around(*centre))).collect()
        }
    };
    let resin = model.interface.filter(|_| interfaces);
    Recovery::new(&model.plate, (&model.laminates, model.heights), &model.materials, resin, &windows).of(strains(model))
}

/// The strains of displacements of a model: those of a plate in few vectors, or one whose layers come apart, are small beside its tensions.
pub(crate) fn strains(model: &Model) -> Strains {
    let few = match &model.plan {
        Plan::Impact(impact) => impact.reduction.is_some() || model.separation.is_some(),
        _ => false,
    };
    if model.effects.nature().large && !few { Strains::Large } else { Strains::Small }
}

pub(crate) fn sites(recovery: &Recovery) -> Vec<ScanSite> {
    let site = |Centre { quad, at: [x, y] }: Centre, region: usize, s: &Station| ScanSite {
        cell: quad as u32,
        region: region as u16,
        place: if s.interface { PlyOrInterface::Interface(s.ply as u16) } else { PlyOrInterface::Ply(s.ply as u16) },
        position: [x, y, s.z],
        angle: s.angle,
        material: s.material as u16,
    };
    let over = |(i, at): (usize, &Centre)| {
        let region = recovery.region_over(i);
        recovery.stations_over(i).iter().map(|s| site(*at, region, s)).collect::<Vec<_>>()
    };
    recovery.centres.iter().enumerate().flat_map(over).collect()
}

/// An empty history for every criterion of every gauge, and where the scan keeps its indices: an interface between two layers
/// of cells has a stress from either side. The first `of_cells` sites are those of cells.
fn gauges(model: &Model, scan: &Scan, of_cells: usize) -> Vec<(Vec<Probe>, IndexHistory)> {
    let mut all = Vec::new();
    for gauge in &model.gauges {
        let sides: Vec<usize> = (0..of_cells)
            .filter(|s| scan.sites()[*s].cell as usize == gauge.quad && scan.sites()[*s].place == gauge.place)
            .collect();
        let Some(first) = sides.first() else { continue };
        for &criterion in &gauge.criteria {
            let probes = sides.iter().filter_map(|side| scan.probe(criterion, *side)).collect();
            let history =
                IndexHistory { criterion, site: scan.sites()[*first], times: Vec::new(), indices: Vec::new() };
            all.push((probes, history));
        }
    }
    all
}
