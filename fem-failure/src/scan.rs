//! First damage: which criterion reaches 1 where and when.

mod climb;
mod hulls;
mod survey;

pub use climb::{Climb, Crests};
pub use hulls::{Extremes, Hulls, StressesOf};
pub use survey::{Samples, Wanted, windows};

use fem_core::failure::{FailureCriterion, Site, check_material};
use fem_core::material::{Material, MaterialError};
use fem_core::tensor::{Ply, Stress6};
use fem_core::vectorised::vectorised;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;

/// Sites that are looked through together for something new.
const BLOCK: usize = 16;

/// A ply or the resin between two plies, counted from 0 at the bottom.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum PlyOrInterface {
    /// Ply `k`.
    Ply(u16),
    /// Between ply `k` and the ply above it.
    Interface(u16),
}

impl PlyOrInterface {
    /// What kind of criterion looks here.
    pub fn site(self) -> Site {
        match self {
            PlyOrInterface::Ply(_) => Site::Ply,
            PlyOrInterface::Interface(_) => Site::Interface,
        }
    }
}

/// For people, who count plies from 1.
impl fmt::Display for PlyOrInterface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            PlyOrInterface::Ply(k) => write!(f, "ply {} from the bottom", u32::from(k) + 1),
            PlyOrInterface::Interface(k) => {
                write!(f, "the interface of plies {} and {} from the bottom", u32::from(k) + 1, u32::from(k) + 2)
            }
        }
    }
}

/// Where a stress is watched.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScanSite {
    /// Cell of the mesh.
    pub cell: u32,
    /// Region of plies of its own that the cell lies in: the same ply of two regions is two.
    pub region: u16,
    /// Ply or interface.
    pub place: PlyOrInterface,
    /// Centre, m, in the plate's frame.
    pub position: [f64; 3],
    /// Angle of the axes in which the stress is given, radians from x towards y.
    pub angle: f64,
    /// Index into the scan's materials.
    pub material: u16,
}

/// The first time at which a mode reached index 1 at a place: what failed, where, when and under which stress.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureEvent {
    /// Time of the crossing, s, by linear interpolation of the index between the two samples around it.
    pub time: f64,
    /// Name under which the criterion was given.
    pub criterion: String,
    /// Its mode.
    pub mode: &'static str,
    /// Cell of the mesh.
    pub cell: u32,
    /// Ply or interface.
    pub place: PlyOrInterface,
    /// Angle of the ply, radians.
    pub angle: f64,
    /// Centre of the site, m.
    pub position: [f64; 3],
    /// Index at the sample that ended the crossing; at least 1.
    pub index: f64,
    /// Stress at the crossing, in the axes of the site, interpolated like the index.
    pub stress: Stress6<Ply>,
    /// Index into the scan's materials.
    pub material: u16,
}

/// First event of every criterion and mode; `events` are sorted by time.
pub fn first_per_mode(events: &[FailureEvent]) -> Vec<&FailureEvent> {
    let mut firsts: Vec<&FailureEvent> = Vec::new();
    for e in events {
        if !firsts.iter().any(|f| f.criterion == e.criterion && f.mode == e.mode) {
            firsts.push(e);
        }
    }
    firsts
}

/// The largest index that a mode reached anywhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Peak {
    /// Name under which the criterion was given.
    pub criterion: String,
    /// Its mode.
    pub mode: &'static str,
    /// The index.
    pub index: f64,
    /// Sample at which it was reached, s.
    pub time: f64,
    /// Where.
    pub site: ScanSite,
    /// How the largest index anywhere came there.
    pub climb: Climb,
}

/// Why a scan cannot start or continue.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScanError {
    /// A site's material does not suit a criterion.
    #[error("criterion `{criterion}` cannot judge {place} of cell {cell}")]
    Material {
        /// Name of the criterion.
        criterion: String,
        /// First cell with that material.
        cell: u32,
        /// Its place.
        place: PlyOrInterface,
        /// What is missing or wrong.
        source: MaterialError,
    },
    /// A site names a material that was not given.
    #[error("{place} of cell {cell} is of material {material}, but only {given} materials are given")]
    NoSuchMaterial {
        /// Cell.
        cell: u32,
        /// Place.
        place: PlyOrInterface,
        /// The index it names.
        material: u16,
        /// How many there are.
        given: usize,
    },
    /// Not one stress per site.
    #[error("{got} stresses are given for {want} sites")]
    Length {
        /// Stresses given.
        got: usize,
        /// Sites.
        want: usize,
    },
    /// A time that is not a number or does not follow the last one.
    #[error("a sample at {time} s cannot follow one at {last:?} s: times must be finite and grow")]
    Time {
        /// The time.
        time: f64,
        /// The sample before, if there is one.
        last: Option<f64>,
    },
    /// A stress that is infinite or not a number.
    #[error("the stress {} is not finite at {time} s: {}", spot(site), components(stress))]
    Stress {
        /// Time, s.
        time: f64,
        /// Where.
        site: Box<ScanSite>,
        /// The components.
        stress: Stress6<Ply>,
    },
    /// An index that is not a number or −∞.
    #[error(
        "criterion `{criterion}`, mode `{mode}` has no index {} at {time} s for {}; it takes {scope}",
        spot(site),
        components(stress)
    )]
    Index {
        /// Time, s.
        time: f64,
        /// Name of the criterion.
        criterion: String,
        /// Its mode.
        mode: &'static str,
        /// Where.
        site: Box<ScanSite>,
        /// Of this stress.
        stress: Stress6<Ply>,
        /// [`FailureCriterion::scope`].
        scope: &'static str,
    },
}

/// A site in words.
fn spot(site: &ScanSite) -> String {
    let [x, y, _] = site.position.map(|x| x * 1e3);
    format!("in {} at ({x:.4}, {y:.4}) mm", site.place)
}

/// A stress in words.
fn components(stress: &Stress6<Ply>) -> String {
    let each = ["σ11", "σ22", "σ33", "σ12", "σ23", "σ31"].iter().zip(stress.0);
    each.map(|(name, value)| format!("{name} {} MPa", value * 1e-6)).collect::<Vec<_>>().join(", ")
}

/// Follows criteria through time and keeps what failed first.
///
/// For every criterion, mode and place (a ply or an interface over all cells of its region) it keeps the first crossing of index 1;
/// among the sites that cross between the same two samples the one that the interpolation puts first, then the one of
/// larger index, then the one given first. A site that is at 1 in the first sample gets that sample's time. Results
/// depend on nothing but the order of the sites.
///
/// [`Scan::sample`] allocates nothing.
#[derive(Debug, Clone)]
pub struct Scan {
    sites: Vec<ScanSite>,
    materials: Vec<Material>,
    watches: Vec<Watch>,
    /// Site numbers, sorted so that a criterion meets each material in one run.
    order: Vec<u32>,
    /// Stresses in that order.
    stress: Vec<Stress6<Ply>>,
    /// Number of each site's place, in that order.
    slots: Vec<u32>,
    record: ScanRecord,
}

/// What a scan has seen: with its sites, criteria and materials all that a later process needs to continue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScanRecord {
    /// Time of the last sample.
    time: Option<f64>,
    /// Its stresses, in the order of `Scan::order`.
    stress: Vec<Stress6<Ply>>,
    evaluations: u64,
    /// One per criterion.
    seen: Vec<Seen>,
}

/// Evaluations beyond this are of no march, and a sum of them would overflow.
const MOST_EVALUATIONS: u64 = 1 << 53;

/// What one criterion saw. Tables have a row of one number per mode for each site that it looks at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Seen {
    /// Indices of the last sample.
    last: Vec<f64>,
    maxima: Vec<f64>,
    /// When each index first reached 1, s; infinite where it did not.
    reached: Vec<f64>,
    peaks: Vec<Option<Reading>>,
    /// One per mode.
    climbs: Vec<Climb>,
    /// Row per place.
    first: Vec<First>,
}

/// The first crossing of 1 and the stress there.
type First = Option<(Reading, Stress6<Ply>)>;

/// A mode of a criterion at a site.
#[derive(Debug, Clone, Copy)]
struct Spot {
    mode: usize,
    /// Of the place among those of [`Seen::first`].
    first: usize,
    site: u32,
}

/// A sample of an index and of the stress that it follows from.
#[derive(Debug, Clone, Copy)]
struct Sighting<'a> {
    time: f64,
    index: f64,
    stress: &'a Stress6<Ply>,
}

impl Seen {
    /// Takes what an index is `now` and was at the sample `before`, unless `now` is the first; when it reached 1 in between, s. The
    /// order in which sites and samples are taken does not matter.
    fn take(&mut self, spot: Spot, before: Option<Sighting<'_>>, now: Sighting<'_>) -> Option<f64> {
        let (t, index) = (now.time, now.index);
        self.climbs[spot.mode].take(before.map_or((t, 0.0), |before| (before.time, before.index)), (t, index));
        let peak = &mut self.peaks[spot.mode];
        let here = Reading { time: t, index, site: spot.site };
        if peak.is_none_or(|p| index > p.index || (index == p.index && here.precedes(&p))) {
            *peak = Some(here);
        }
        let (time, stress) = crossing(before, now)?;
        let (here, first) = (Reading { time, ..here }, &mut self.first[spot.first]);
        if first.is_none_or(|(f, _)| here.precedes(&f)) {
            *first = Some((here, stress));
        }
        Some(time)
    }
}

/// When an index reached 1 between the sample `before`, unless `now` is the first, and `now`, s, and the stress then.
fn crossing(before: Option<Sighting<'_>>, now: Sighting<'_>) -> Option<(f64, Stress6<Ply>)> {
    // A site that has crossed already left its record then. An infinite index crosses at the sample before.
    if !(now.index >= 1.0 && before.is_none_or(|before| before.index < 1.0)) {
        return None;
    }
    let Some(before) = before else { return Some((now.time, *now.stress)) };
    let share = (1.0 - before.index) / (now.index - before.index);
    let between = |i| (1.0 - share) * before.stress.0[i] + share * now.stress.0[i];
    let time = (before.time + (now.time - before.time) * share).min(now.time);
    Some((time, Stress6::new(std::array::from_fn(between))))
}

/// That mode number `mode` of `criterion`, called `name`, has no usable index of `stress`.
fn refusal(
    name: &str,
    criterion: &dyn FailureCriterion,
    site: &ScanSite,
    time: f64,
    mode: usize,
    stress: Stress6<Ply>,
) -> ScanError {
    ScanError::Index {
        time,
        criterion: name.to_owned(),
        mode: criterion.info().modes[mode],
        site: Box::new(*site),
        stress,
        scope: criterion.scope(),
    }
}

/// One criterion and where it looks.
#[derive(Debug, Clone)]
struct Watch {
    name: String,
    criterion: Box<dyn FailureCriterion>,
    modes: &'static [&'static str],
    /// The part of `Scan::order` that it looks at.
    span: Range<usize>,
    /// Parts of `span` of one material each, from its start.
    runs: Vec<(u16, Range<usize>)>,
    /// Indices of the present sample, a row for each site of `span`.
    now: Vec<f64>,
}

/// Where a scan keeps the indices of one criterion at one site.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Probe {
    watch: usize,
    row: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Reading {
    time: f64,
    index: f64,
    site: u32,
}

impl Reading {
    /// Earlier, else larger, else of the lower site number.
    fn precedes(&self, other: &Reading) -> bool {
        let order = self.time.total_cmp(&other.time).then(other.index.total_cmp(&self.index));
        order.then(self.site.cmp(&other.site)).is_lt()
    }
}

impl Scan {
    /// A scan of `sites` by named criteria; `materials` are what [`ScanSite::material`] counts.
    ///
    /// # Errors
    /// A site whose material was not given, or is refused by a criterion looking there.
    pub fn new(
        criteria: Vec<(String, Box<dyn FailureCriterion>)>,
        sites: Vec<ScanSite>,
        materials: Vec<Material>,
    ) -> Result<Self, ScanError> {
        for s in &sites {
            if usize::from(s.material) >= materials.len() {
                return Err(ScanError::NoSuchMaterial {
                    cell: s.cell,
                    place: s.place,
                    material: s.material,
                    given: materials.len(),
                });
            }
        }
        let place = |site: &ScanSite| (site.region, site.place);
        let mut places: Vec<(u16, PlyOrInterface)> = sites.iter().map(place).collect();
        places.sort_unstable();
        places.dedup();

        let is_interface = |i: u32| sites[i as usize].place.site() == Site::Interface;
        let mut order: Vec<u32> = (0u32..).take(sites.len()).collect();
        order.sort_by_key(|&i| (is_interface(i), sites[i as usize].material));
        let plies = order.partition_point(|&i| !is_interface(i));
        let slots = order
            .iter()
            .map(|&i| places.partition_point(|p| *p < place(&sites[i as usize])))
            .map(|slot| slot as u32)
            .collect();

        let (mut watches, mut seen) = (Vec::with_capacity(criteria.len()), Vec::with_capacity(criteria.len()));
        for (name, criterion) in criteria {
            let span = match criterion.info().site {
                Site::Ply => 0..plies,
                Site::Interface => plies..order.len(),
            };
            let mut runs = Vec::new();
            let mut start = 0;
            for run in order[span.clone()].chunk_by(|&a, &b| sites[a as usize].material == sites[b as usize].material) {
                let first = &sites[run[0] as usize];
                check_material(&*criterion, &name, &materials[usize::from(first.material)]).map_err(|source| {
                    ScanError::Material { criterion: name.clone(), cell: first.cell, place: first.place, source }
                })?;
                runs.push((first.material, start..start + run.len()));
                start += run.len();
            }
            let modes = criterion.info().modes;
            let size = span.len() * modes.len();
            watches.push(Watch { now: vec![0.0; size], name, criterion, modes, span, runs });
            seen.push(Seen {
                last: vec![0.0; size],
                maxima: vec![0.0; size],
                reached: vec![f64::INFINITY; size],
                peaks: vec![None; modes.len()],
                climbs: vec![Climb::default(); modes.len()],
                first: vec![None; places.len() * modes.len()],
            });
        }
        let stress = vec![Stress6::new([0.0; 6]); sites.len()];
        let record = ScanRecord { time: None, stress: stress.clone(), evaluations: 0, seen };
        Ok(Self { sites, materials, watches, order, stress, slots, record })
    }

    /// The sites, as given.
    pub fn sites(&self) -> &[ScanSite] {
        &self.sites
    }

    /// Takes the stresses of all sites at time `t` (s), each in its ply's axes, in the order of [`Scan::sites`].
    ///
    /// # Errors
    /// A time that does not grow, a stress that is not finite, an index that is not a number; the scan then is as
    /// before the call.
    pub fn sample(&mut self, t: f64, stress: &[Stress6<Ply>]) -> Result<(), ScanError> {
        if stress.len() != self.sites.len() {
            return Err(ScanError::Length { got: stress.len(), want: self.sites.len() });
        }
        let last = self.record.time;
        if !t.is_finite() || last.is_some_and(|last| t <= last) {
            return Err(ScanError::Time { time: t, last });
        }
        for (s, site) in stress.iter().zip(&self.sites) {
            if !s.is_finite() {
                return Err(ScanError::Stress { time: t, site: Box::new(*site), stress: *s });
            }
        }
        for (s, &i) in self.stress.iter_mut().zip(&self.order) {
            *s = stress[i as usize];
        }
        for watch in &mut self.watches {
            if let Err((row, mode)) = watch.evaluate(&self.stress, &self.materials) {
                let k = watch.span.start + row;
                let site = &self.sites[self.order[k] as usize];
                return Err(refusal(&watch.name, &*watch.criterion, site, t, mode, self.stress[k]));
            }
        }
        for (watch, seen) in self.watches.iter_mut().zip(&mut self.record.seen) {
            watch.record(seen, last, t, &self.order, &self.slots, [&self.record.stress, &self.stress]);
            self.record.evaluations += watch.span.len() as u64;
        }
        std::mem::swap(&mut self.record.stress, &mut self.stress);
        self.record.time = Some(t);
        Ok(())
    }

    /// First crossing of every criterion, mode and place that failed, by time.
    pub fn events(&self) -> Vec<FailureEvent> {
        let mut found: Vec<(Reading, Stress6<Ply>, usize, usize)> = Vec::new();
        for (w, (watch, seen)) in self.watches.iter().zip(&self.record.seen).enumerate() {
            for (k, first) in seen.first.iter().enumerate() {
                found.extend(first.map(|(reading, stress)| (reading, stress, w, k % watch.modes.len())));
            }
        }
        found.sort_by(|(a, _, aw, am), (b, _, bw, bm)| {
            let mode = (aw, am).cmp(&(bw, bm));
            a.time.total_cmp(&b.time).then(mode).then(b.index.total_cmp(&a.index)).then(a.site.cmp(&b.site))
        });
        let event = |(r, stress, w, mode): (Reading, Stress6<Ply>, usize, usize)| {
            let (site, watch) = (&self.sites[r.site as usize], &self.watches[w]);
            FailureEvent {
                time: r.time,
                criterion: watch.name.clone(),
                mode: watch.modes[mode],
                cell: site.cell,
                place: site.place,
                angle: site.angle,
                position: site.position,
                index: r.index,
                stress,
                material: site.material,
            }
        };
        found.into_iter().map(event).collect()
    }

    /// Largest index of every criterion and mode over all samples and sites, failed or not, in the order of the
    /// criteria; a criterion that had nowhere to look has none.
    pub fn peaks(&self) -> Vec<Peak> {
        let mut peaks = Vec::new();
        for (watch, seen) in self.watches.iter().zip(&self.record.seen) {
            for ((mode, reading), climb) in watch.modes.iter().zip(&seen.peaks).zip(&seen.climbs) {
                peaks.extend(reading.map(|r| Peak {
                    climb: climb.clone(),
                    criterion: watch.name.clone(),
                    mode,
                    index: r.index,
                    time: r.time,
                    site: self.sites[r.site as usize],
                }));
            }
        }
        peaks
    }

    /// For maps: every site that criterion number `criterion` looks at, with its largest index over all samples per
    /// mode, and the time (s) at which each first reached 1. A mode that never applied has 0, one that never reached 1
    /// an infinite time.
    ///
    /// # Panics
    /// There is no criterion of that number.
    pub fn maxima(&self, criterion: usize) -> impl Iterator<Item = (&ScanSite, &[f64], &[f64])> {
        let (watch, seen) = (&self.watches[criterion], &self.record.seen[criterion]);
        let sites = self.order[watch.span.clone()].iter().map(|&i| &self.sites[i as usize]);
        let [maxima, reached] = [&seen.maxima, &seen.reached].map(|table| table.chunks_exact(watch.modes.len()));
        sites.zip(maxima).zip(reached).map(|((site, maxima), reached)| (site, maxima, reached))
    }

    /// For fields: every site, by its number, that criterion number `criterion` looks at, with its indices of the
    /// last sample.
    ///
    /// # Panics
    /// There is no criterion of that number.
    pub fn latest(&self, criterion: usize) -> impl Iterator<Item = (usize, &[f64])> {
        let watch = &self.watches[criterion];
        let sites = self.order[watch.span.clone()].iter().map(|&i| i as usize);
        sites.zip(self.record.seen[criterion].last.chunks_exact(watch.modes.len()))
    }

    /// For histories: where criterion number `criterion` leaves its indices of site number `site`; `None` if there is no
    /// such criterion or it does not look there.
    pub fn probe(&self, criterion: usize, site: usize) -> Option<Probe> {
        let span = self.watches.get(criterion)?.span.clone();
        let row = self.order[span].iter().position(|&i| i as usize == site)?;
        Some(Probe { watch: criterion, row })
    }

    /// The indices of the last sample where `probe` points, one per mode; zero before the first.
    pub fn read(&self, probe: Probe) -> &[f64] {
        let modes = self.watches[probe.watch].modes.len();
        &self.record.seen[probe.watch].last[probe.row * modes..][..modes]
    }

    /// Criteria evaluated so far, counted once per site and sample.
    pub fn evaluations(&self) -> u64 {
        self.record.evaluations
    }

    /// Whether there was a sample.
    pub fn has_begun(&self) -> bool {
        self.record.time.is_some()
    }

    /// What the scan has seen, to be kept.
    pub fn record(&self) -> &ScanRecord {
        &self.record
    }

    /// Continues from what a scan of the same sites and criteria had seen; `false`, and nothing changes, where `record`
    /// is of another size or names sites that there are not.
    #[must_use]
    pub fn resume(&mut self, record: ScanRecord) -> bool {
        let size =
            |s: &Seen| [s.last.len(), s.maxima.len(), s.reached.len(), s.peaks.len(), s.climbs.len(), s.first.len()];
        let readings = |s: &Seen| {
            let first = s.first.iter().flatten().map(|(reading, _)| *reading);
            s.peaks.iter().flatten().copied().chain(first).all(|reading| (reading.site as usize) < self.sites.len())
        };
        let fits = record.stress.len() == self.sites.len()
            && record.evaluations < MOST_EVALUATIONS
            && record.seen.iter().all(readings)
            && record.seen.iter().flat_map(|seen| &seen.climbs).all(Climb::is_sound)
            && record.seen.iter().map(size).eq(self.record.seen.iter().map(size));
        if fits {
            self.record = record;
        }
        fits
    }
}

impl Watch {
    /// Fills `now`; an unusable index is an error with its row and mode.
    fn evaluate(&mut self, stress: &[Stress6<Ply>], materials: &[Material]) -> Result<(), (usize, usize)> {
        let stress = &stress[self.span.clone()];
        let modes = self.modes.len();
        // A mode that a criterion forgets to write must not pass for safe.
        self.now.fill(f64::NAN);
        for (material, run) in &self.runs {
            let out = &mut self.now[run.start * modes..run.end * modes];
            self.criterion.indices_many(&stress[run.clone()], &materials[usize::from(*material)], out);
        }
        let usable = |v: &f64| *v > f64::NEG_INFINITY;
        if vectorised(|| self.now.iter().fold(true, |all, v| all & usable(v))) {
            return Ok(());
        }
        let bad = self.now.iter().position(|v| !usable(v)).unwrap_or(0);
        Err((bad / modes, bad % modes))
    }

    /// Takes `now`, the indices at time `t`, into `seen`, whose last are those of the time `last`. `stress` are those of the
    /// two.
    fn record(
        &mut self,
        seen: &mut Seen,
        last: Option<f64>,
        t: f64,
        order: &[u32],
        slots: &[u32],
        stress: [&[Stress6<Ply>]; 2],
    ) {
        let modes = self.modes.len();
        let (order, slots) = (&order[self.span.clone()], &slots[self.span.clone()]);
        let stress = stress.map(|s| &s[self.span.clone()]);
        vectorised(|| seen.maxima.iter_mut().zip(&self.now).for_each(|(maximum, now)| *maximum = maximum.max(*now)));
        // Of an index below the largest so far and below 1 there is nothing more to say.
        let least = seen.peaks.iter().map(|peak| peak.map_or(f64::NEG_INFINITY, |peak| peak.index.min(1.0)));
        let least: Vec<f64> = least.cycle().take(BLOCK * modes).collect();
        let news = |block: &&[f64]| vectorised(|| block.iter().zip(&least).fold(false, |any, (i, l)| any | (i >= l)));
        let blocks = (0..).step_by(BLOCK).zip(self.now.chunks(BLOCK * modes)).filter(|(_, block)| news(block));
        let rows = blocks.flat_map(|(first, block)| (first..).zip(block.chunks_exact(modes)));
        for (row, indices) in rows {
            for (mode, &index) in indices.iter().enumerate() {
                let spot = Spot { mode, first: slots[row] as usize * modes + mode, site: order[row] };
                let was = seen.last[row * modes + mode];
                let before = last.map(|time| Sighting { time, index: was, stress: &stress[0][row] });
                if let Some(time) = seen.take(spot, before, Sighting { time: t, index, stress: &stress[1][row] }) {
                    let reached = &mut seen.reached[row * modes + mode];
                    *reached = reached.min(time);
                }
            }
        }
        std::mem::swap(&mut self.now, &mut seen.last);
    }
}

#[cfg(test)]
mod tests;
