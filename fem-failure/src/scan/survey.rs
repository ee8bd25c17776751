//! A scan that judges only what can be first or largest.

use super::{BLOCK, First, Scan, ScanError, ScanSite, Seen, Sighting, Spot, Watch, refusal};
use fem_core::failure::StressRange;
use fem_core::material::Material;
use fem_core::tensor::{Ply, Stress6};
use std::ops::Range;

/// Samples of a window: those that it judges, and the one before them.
pub(super) const WINDOW: usize = 16;

/// Share of a bound that rounding may take.
pub(super) const ROUNDING: f64 = 1e-9;

/// A bound with what rounding may take.
fn beyond(bound: f64) -> f64 {
    bound + ROUNDING * bound.abs()
}

/// Components of stress beyond which a bound might overflow, Pa.
pub(super) const IMMENSE: f64 = 1e60;

/// Stresses over a batch of samples, site by site.
pub trait Samples {
    /// Into `out`, one for each of the [`windows`] of the batch, what holds every stress of `site` there.
    fn ranges(&mut self, site: usize, out: &mut [StressRange]);

    /// Into `out`, the stresses of `site` at the samples of window number `window`.
    fn stresses(&mut self, site: usize, window: usize, out: &mut [Stress6<Ply>]);
}

/// The windows of a batch of `samples`; each begins with the last sample of the one before it.
pub fn windows(samples: usize) -> impl ExactSizeIterator<Item = Range<usize>> {
    let end = move |start: usize| (start + WINDOW).min(samples);
    (0..samples.saturating_sub(1).max(1)).step_by(WINDOW - 1).map(move |start| start..end(start))
}

/// What no index exceeds: of each row of a watch, window and mode.
struct Bounds {
    of: Vec<f64>,
    /// The largest of each [`BLOCK`] of rows.
    of_blocks: Vec<f64>,
    windows: usize,
    modes: usize,
}

impl Bounds {
    /// Of so many rows, no bounds yet.
    fn new(rows: usize, windows: usize, modes: usize) -> Self {
        let size = windows * modes;
        let (of, of_blocks) = (vec![f64::INFINITY; rows * size], vec![f64::INFINITY; rows.div_ceil(BLOCK) * size]);
        Self { of, of_blocks, windows, modes }
    }

    /// Once all rows have their bounds.
    fn block(&mut self) {
        let size = (self.windows * self.modes).max(1);
        for (block, rows) in self.of_blocks.chunks_exact_mut(size).zip(self.of.chunks(BLOCK * size)) {
            block.fill(f64::NEG_INFINITY);
            for row in rows.chunks_exact(size) {
                // A bound that is not a number bounds nothing.
                block.iter_mut().zip(row).for_each(|(b, r)| *b = b.max(if r.is_nan() { f64::INFINITY } else { *r }));
            }
        }
    }

    fn at(&self, row: usize, window: usize) -> &[f64] {
        &self.of[(row * self.windows + window) * self.modes..][..self.modes]
    }

    fn of_block(&self, block: usize, window: usize) -> &[f64] {
        &self.of_blocks[(block * self.windows + window) * self.modes..][..self.modes]
    }

    fn rows(&self) -> usize {
        self.of.len() / (self.windows * self.modes).max(1)
    }

    /// The row and window of the largest bound of `mode` in `within`.
    fn top(&self, mode: usize, within: Range<usize>) -> Option<(usize, usize)> {
        let blocks =
            (0..self.rows().div_ceil(BLOCK)).flat_map(|block| within.clone().map(move |window| (block, window)));
        let of_block = |at: (usize, usize)| self.of_block(at.0, at.1)[mode];
        let (block, window) = blocks.reduce(|a, b| if of_block(b) > of_block(a) { b } else { a })?;
        let rows = block * BLOCK..((block + 1) * BLOCK).min(self.rows());
        let of_row = |row: usize| self.at(row, window)[mode];
        rows.reduce(|a, b| if of_row(b) > of_row(a) { b } else { a }).map(|row| (row, window))
    }
}

/// What a survey is to find.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// What is first or largest anywhere.
    Extremes,
    /// That, and what is first and largest at every site ([`Scan::maxima`]).
    EverySite,
}

/// What a mode must reach within a window to be recorded.
struct Sought {
    /// Level that none passed before the window.
    open: f64,
    /// That, or the largest index so far where it is less.
    record: f64,
}

impl Sought {
    /// With the largest index so far, in a window that begins at `start`.
    fn update(&mut self, seen: &Seen, mode: usize, start: f64) {
        let peak = seen.peaks[mode].map_or(f64::NEG_INFINITY, |peak| match peak.time < start {
            true => peak.index.next_up(),
            false => peak.index,
        });
        self.record = self.open.min(peak);
    }
}

impl Scan {
    /// Takes a batch of samples at `times` (s), of which the first is the last of the batch before, if there was one: events, peaks
    /// and climbs, and [`Scan::maxima`] where [`Wanted::EverySite`] says so, are afterwards to the bit what [`Scan::sample`] makes
    /// them, but only sites that can add to them are judged. [`Scan::latest`] is not kept, so that nothing else than further batches
    /// for the same may follow.
    ///
    /// A mode is judged where its bound ([`FailureCriterion::bounds`](fem_core::failure::FailureCriterion::bounds)) over a window of
    /// samples reaches its largest index so far, or a level that no index passed before, or 1 where its place has not failed before;
    /// for every site, where it exceeds the largest index of the site, or reaches 1 before the site did.
    ///
    /// # Errors
    /// A time that does not grow, a stress that is not finite, an index that is not a number. The scan is then of no use.
    pub fn survey(&mut self, times: &[f64], samples: &mut dyn Samples, wanted: Wanted) -> Result<(), ScanError> {
        let last = self.record.time;
        let follows = last.is_none_or(|last| times.first() == Some(&last));
        if let Some(time) = times.iter().find(|t| !t.is_finite()).or(times.first().filter(|_| !follows)) {
            return Err(ScanError::Time { time: *time, last });
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(ScanError::Time { time: pair[1], last: Some(pair[0]) });
        }
        let windows: Vec<_> = windows(times.len()).collect();
        if times.len() < if last.is_some() { 2 } else { 1 } {
            return Ok(());
        }
        let bounds = self.bounds(windows.len(), samples);
        let Self { sites, materials, watches, order, slots, record, .. } = self;
        let mut judge = Judge {
            times,
            begins: last.is_none(),
            sites,
            materials,
            order,
            slots,
            samples,
            windows: windows.len(),
            done: Vec::new(),
            indices: Vec::new(),
            evaluations: 0,
        };
        for ((watch, seen), bounds) in watches.iter().zip(&mut record.seen).zip(&bounds) {
            judge.done.clear();
            judge.done.resize(bounds.rows() * windows.len(), false);
            judge.look(watch, seen, bounds, &windows)?;
            if wanted == Wanted::EverySite {
                judge.look_everywhere(watch, seen, bounds, &windows)?;
            }
        }
        record.evaluations += judge.evaluations;
        record.time = times.last().copied();
        Ok(())
    }

    /// Those of every watch.
    fn bounds(&self, windows: usize, samples: &mut dyn Samples) -> Vec<Bounds> {
        let rest = StressRange { low: Stress6::new([0.0; 6]), high: Stress6::new([0.0; 6]) };
        let of = |watch: &Watch| Bounds::new(watch.span.len(), windows, watch.modes.len());
        let mut all: Vec<Bounds> = self.watches.iter().map(of).collect();
        let says = |watch: &&Watch| {
            let mut of_rest = vec![f64::INFINITY; watch.modes.len()];
            let material = watch.runs.first().map(|(material, _)| &self.materials[usize::from(*material)]);
            material.is_some_and(|material| {
                watch.criterion.bounds(&rest, material, &mut of_rest);
                of_rest.iter().any(|bound| bound.is_finite())
            })
        };
        let says: Vec<bool> = self.watches.iter().map(|watch| says(&watch)).collect();
        let mut ranges = vec![rest; windows];
        for (k, &site) in self.order.iter().enumerate() {
            let mut looks = self
                .watches
                .iter()
                .zip(&mut all)
                .zip(&says)
                .filter(|((watch, _), says)| **says && watch.span.contains(&k))
                .peekable();
            if looks.peek().is_none() {
                continue;
            }
            samples.ranges(site as usize, &mut ranges);
            let material = &self.materials[usize::from(self.sites[site as usize].material)];
            let moderate = |s: &Stress6<Ply>| s.0.iter().all(|c| c.abs() < IMMENSE);
            if !ranges.iter().all(|range| moderate(&range.low) && moderate(&range.high)) {
                continue;
            }
            for ((watch, bounds), _) in looks {
                let size = windows * bounds.modes;
                let out = &mut bounds.of[(k - watch.span.start) * size..][..size];
                watch.criterion.bounds_many(&ranges, material, out);
            }
        }
        all.iter_mut().for_each(Bounds::block);
        all
    }
}

/// Judges sites over windows.
struct Judge<'a> {
    times: &'a [f64],
    /// Whether the first of the times is of the march, not of the batch before.
    begins: bool,
    sites: &'a [ScanSite],
    materials: &'a [Material],
    order: &'a [u32],
    slots: &'a [u32],
    samples: &'a mut dyn Samples,
    windows: usize,
    /// Whether each window of each row of a watch was judged.
    done: Vec<bool>,
    indices: Vec<f64>,
    evaluations: u64,
}

impl Judge<'_> {
    /// All that `watch` must look at: what may be largest first, because it says of most others that they need not be looked at.
    fn look(
        &mut self,
        watch: &Watch,
        seen: &mut Seen,
        bounds: &Bounds,
        windows: &[Range<usize>],
    ) -> Result<(), ScanError> {
        for mode in 0..bounds.modes {
            if let Some((row, window)) = bounds.top(mode, 0..windows.len()) {
                let all = vec![f64::NEG_INFINITY; bounds.modes];
                self.judge(watch, seen, row, (window, &windows[window]), &all)?;
            }
        }
        for (number, window) in windows.iter().enumerate() {
            let (from, start) = (self.times[window.start], self.times[self.judged(window).start]);
            let open = seen.climbs.iter().map(|climb| Sought { open: climb.open(from), record: f64::NEG_INFINITY });
            let mut sought: Vec<Sought> = open.collect();
            (0..).zip(&mut sought).for_each(|(mode, sought)| sought.update(seen, mode, start));
            let tops: Vec<_> = (0..bounds.modes).filter_map(|mode| bounds.top(mode, number..number + 1)).collect();
            for (row, _) in tops {
                self.judge_if(watch, seen, (bounds, row), (number, window), &mut sought)?;
            }
            for block in 0..bounds.rows().div_ceil(BLOCK) {
                // Of a place that has not failed 1 is enough.
                let reaches = |(bound, sought): (&f64, &Sought)| !(beyond(*bound) < sought.record.min(1.0));
                if bounds.of_block(block, number).iter().zip(&sought).any(reaches) {
                    for row in block * BLOCK..((block + 1) * BLOCK).min(bounds.rows()) {
                        self.judge_if(watch, seen, (bounds, row), (number, window), &mut sought)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// All sites whose bounds say that they can add to what is known of them: windows that may hold their largest index first.
    fn look_everywhere(
        &mut self,
        watch: &Watch,
        seen: &mut Seen,
        bounds: &Bounds,
        windows: &[Range<usize>],
    ) -> Result<(), ScanError> {
        // Of indices below 1 all that is not of a site alone is known.
        let least = vec![1.0; bounds.modes];
        for row in 0..bounds.rows() {
            let top = |mode: usize| {
                let of = |number: usize| bounds.at(row, number)[mode];
                (0..windows.len()).reduce(|a, b| if of(b) > of(a) { b } else { a })
            };
            let tops = (0..bounds.modes).filter_map(top);
            for number in tops.chain(0..windows.len()) {
                let window = &windows[number];
                let of_site = row * bounds.modes..(row + 1) * bounds.modes;
                let known = seen.maxima[of_site.clone()].iter().zip(&seen.reached[of_site]);
                let adds = |(bound, (largest, reached)): (&f64, (&f64, &f64))| {
                    let most = beyond(*bound);
                    !(most <= *largest) || (!(most < 1.0) && *reached > self.times[window.start])
                };
                if bounds.at(row, number).iter().zip(known).any(adds) {
                    self.judge(watch, seen, row, (number, window), &least)?;
                }
            }
        }
        Ok(())
    }

    /// Takes the site of `row` over a window if its bounds say that it can add something to what is `sought`.
    fn judge_if(
        &mut self,
        watch: &Watch,
        seen: &mut Seen,
        (bounds, row): (&Bounds, usize),
        (number, window): (usize, &Range<usize>),
        sought: &mut [Sought],
    ) -> Result<(), ScanError> {
        let from = self.times[window.start];
        let place = self.slots[watch.span.start + row] as usize * bounds.modes;
        let reaches = |((bound, sought), first): ((&f64, &Sought), &First)| {
            let failed = first.is_some_and(|(first, _)| first.time < from);
            !(beyond(*bound) < if failed { sought.record } else { sought.record.min(1.0) })
        };
        if bounds.at(row, number).iter().zip(&*sought).zip(&seen.first[place..]).any(reaches) {
            let start = self.times[self.judged(window).start];
            let least: Vec<f64> = sought.iter().map(|sought| sought.record.min(1.0)).collect();
            self.judge(watch, seen, row, (number, window), &least)?;
            (0..).zip(sought).for_each(|(mode, sought)| sought.update(seen, mode, start));
        }
        Ok(())
    }

    /// The samples of `window` that it judges.
    fn judged(&self, window: &Range<usize>) -> Range<usize> {
        let before = !(self.begins && window.start == 0);
        window.start + usize::from(before)..window.end
    }

    /// Takes the site of `row` over a window; indices below the `least` of their modes say nothing.
    fn judge(
        &mut self,
        watch: &Watch,
        seen: &mut Seen,
        row: usize,
        (number, window): (usize, &Range<usize>),
        least: &[f64],
    ) -> Result<(), ScanError> {
        if std::mem::replace(&mut self.done[row * self.windows + number], true) {
            return Ok(());
        }
        let (k, modes, count) = (watch.span.start + row, watch.modes.len(), window.len());
        let site = &self.sites[self.order[k] as usize];
        let mut stress = [Stress6::new([0.0; 6]); WINDOW];
        let mut indices = std::mem::take(&mut self.indices);
        indices.clear();
        indices.resize(count * modes, f64::NAN);
        self.samples.stresses(self.order[k] as usize, number, &mut stress[..count]);
        let times = &self.times[window.clone()];
        if let Some((s, time)) = stress.iter().zip(times).find(|(s, _)| !s.is_finite()) {
            return Err(ScanError::Stress { time: *time, site: Box::new(*site), stress: *s });
        }
        watch.criterion.indices_many(&stress[..count], &self.materials[usize::from(site.material)], &mut indices);
        if let Some(bad) = indices.iter().position(|index| !(*index > f64::NEG_INFINITY)) {
            let (sample, mode) = (bad / modes, bad % modes);
            return Err(refusal(&watch.name, &*watch.criterion, site, times[sample], mode, stress[sample]));
        }
        let judged = self.judged(window);
        self.evaluations += judged.len() as u64;
        for sample in judged.map(|sample| sample - window.start) {
            for mode in (0..modes).filter(|mode| indices[sample * modes + mode] >= least[*mode]) {
                let at = |sample: usize| Sighting {
                    time: times[sample],
                    index: indices[sample * modes + mode],
                    stress: &stress[sample],
                };
                let spot = Spot { mode, first: self.slots[k] as usize * modes + mode, site: self.order[k] };
                if let Some(time) = seen.take(spot, sample.checked_sub(1).map(at), at(sample)) {
                    let reached = &mut seen.reached[row * modes + mode];
                    *reached = reached.min(time);
                }
            }
            let maxima = &mut seen.maxima[row * modes..(row + 1) * modes];
            maxima.iter_mut().zip(&indices[sample * modes..]).for_each(|(most, index)| *most = most.max(*index));
        }
        self.indices = indices;
        Ok(())
    }
}
