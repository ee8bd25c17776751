//! The stresses of a plate that is marched, as its criteria see them, and all that a march showed them.

use super::expansion::Expansion;
use super::kept::KeptPart;
use super::operator::{LANES, SURVEYED, Sampled, StressOperator, put};
use super::stress::{build_recovery, of_cells, residual, sites};
use crate::error::Error;
use crate::forecast::Demand;
use crate::model::{Model, NamedCriterion};
use fem_core::failure::StressRange;
use fem_core::material::Material;
use fem_core::recovery::{Recovery, Tension};
use fem_core::tensor::{Ply, Stress6};
use fem_dynamics::reduce::TensionPatterns;
use fem_failure::scan::{Extremes, Hulls, Samples, Scan, ScanError, ScanSite, Wanted, windows};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Instants of a march at which it is asked where the plate is hot.
const INSTANTS: usize = 64;

/// Cells in which stresses that were kept are held against those that are computed.
const LOOKED_AT: usize = 8;

/// What the criteria see of a plate, whatever strikes it.
#[derive(Debug)]
pub(super) struct PlateStresses {
    pub(super) recovery: Recovery,
    pub(super) way: Way,
}

/// How stresses follow from coordinates.
#[derive(Debug)]
pub(super) enum Way {
    /// By a product with them, and with what follows from them.
    Product(StressOperator),
    /// From displacements; six a site that do not follow from them, none where there are none.
    Recovery(Vec<f64>),
}

impl PlateStresses {
    /// Those of `model`, which is marched in the coordinates of `expansion`.
    ///
    /// # Errors
    /// A material that lacks a constant, or a cell that the element refuses.
    pub(super) fn new(model: &Model, expansion: &Expansion<'_>) -> Result<Self, Error> {
        let recovery = build_recovery(model);
        let residual = residual(model, &recovery)?;
        let Some((basis, modes)) = expansion.basis() else {
            return Ok(Self { recovery, way: Way::Recovery(residual) });
        };
        let fits = |columns: usize| 6 * recovery.sites() * columns * size_of::<f64>() <= Demand::OPERATOR_LIMIT;
        if let Some(tensions) = expansion.tensions().filter(|of| fits(modes + of.follow().terms())) {
            let operator = stretched(model, &recovery, expansion, tensions, residual)?;
            return Ok(Self { recovery, way: Way::Product(operator) });
        }
        if !model.effects.nature().large && fits(modes) {
            let kept = KeptPart::of_stresses(model);
            if let Some(rows) = kept.as_ref().and_then(KeptPart::read) {
                let operator = StressOperator::of_rows(rows, recovery.sites(), modes, residual.clone());
                match operator {
                    Some(operator) if agrees(model, &recovery, &operator, expansion, basis)? => {
                        return Ok(Self { recovery, way: Way::Product(operator) });
                    }
                    _ => kept.iter().for_each(|kept| kept.refuse("its stresses are not those of the plate")),
                }
            }
            let mut product = vec![0.0; 6 * recovery.sites() * modes];
            recovery.small_stresses(&model.plate, &*model.element, &expansion.nodal(basis), modes, &mut product)?;
            let operator = StressOperator::new(&product, modes, residual);
            if let Some(kept) = &kept {
                kept.write(&operator.rows());
            }
            return Ok(Self { recovery, way: Way::Product(operator) });
        }
        Ok(Self { recovery, way: Way::Recovery(residual) })
    }
}

/// The operator of a plate whose deflections stretch it.
///
/// # Errors
/// A cell that the element refuses.
fn stretched(
    model: &Model,
    recovery: &Recovery,
    expansion: &Expansion<'_>,
    tensions: &Arc<TensionPatterns>,
    residual: Vec<f64>,
) -> Result<StressOperator, Error> {
    let Some((basis, modes)) = expansion.basis() else { return Ok(StressOperator::new(&[], 0, residual)) };
    let (plate, element, terms) = (&model.plate, &*model.element, tensions.follow().terms());
    let mut fields = vec![0.0; 6 * recovery.sites() * (modes + terms)];
    let (of_modes, of_terms) = fields.split_at_mut(6 * recovery.sites() * modes);
    recovery.small_stresses(plate, element, &expansion.nodal(basis), modes, of_modes)?;
    recovery.small_stresses(plate, element, &expansion.nodal(tensions.follow().shapes()), terms, of_terms)?;
    let mut amounts = vec![0.0; terms * terms];
    amounts.iter_mut().step_by(terms + 1).for_each(|amount| *amount = 1.0);
    let (deflections, combinations) = (expansion.nodal(tensions.deflections()), tensions.combinations());
    recovery.add_tension(
        plate,
        element,
        Tension { deflections: &deflections, combinations, amounts: &amounts },
        of_terms,
    )?;
    Ok(StressOperator::new(&fields, modes + terms, residual).with_tensions(tensions))
}

/// Whether the rows of `operator` give the stresses of a combination of all modes in some cells, [`LOOKED_AT`].
///
/// # Errors
/// A cell that the element refuses.
fn agrees(
    model: &Model,
    recovery: &Recovery,
    operator: &StressOperator,
    expansion: &Expansion<'_>,
    basis: &[f64],
) -> Result<bool, Error> {
    let modes = operator.width();
    let q: Vec<f64> = (0..modes).map(|k| 1.0 / (1.0 + k as f64)).collect();
    let mut u = vec![0.0; basis.len() / modes];
    for (q, mode) in q.iter().zip(basis.chunks_exact(u.len())) {
        u.iter_mut().zip(mode).for_each(|(u, mode)| *u += q * mode);
    }
    let count = model.watched.len();
    let mut chosen: Vec<usize> = (0..LOOKED_AT).map(|k| k * count.saturating_sub(1) / (LOOKED_AT - 1)).collect();
    chosen.dedup();
    let quads: Vec<usize> = chosen.iter().filter_map(|k| model.watched.get(*k)).copied().collect();
    let some = of_cells(model, &quads);
    let mut field = vec![0.0; 6 * some.sites()];
    some.small_stresses(&model.plate, &*model.element, &expansion.nodal(&u), 1, &mut field)?;
    let begin = |k: usize| (0..k).map(|k| recovery.stations_over(k).len()).sum::<usize>();
    let sites = chosen.iter().take(quads.len()).flat_map(|k| begin(*k)..begin(k + 1));
    Ok(operator.gives(sites, &q, &field))
}

/// The coordinates that a plate had at the samples of a march, from which its stresses are judged.
#[derive(Debug)]
pub struct PlateSamples {
    of_plate: Arc<PlateStresses>,
    times: Vec<f64>,
    coordinates: Vec<f64>,
    /// What is the same for all strengths: made once it is wanted; `None` where it cannot be, or would be too large.
    hulls: OnceLock<Option<Hulls>>,
}

impl PlateSamples {
    /// Of a plate that had these `coordinates` at `times`, s.
    pub(super) fn new(of_plate: Arc<PlateStresses>, times: Vec<f64>, coordinates: Vec<f64>) -> Self {
        let coordinates = match &of_plate.way {
            Way::Product(operator) => operator.extended(&coordinates).into_owned(),
            Way::Recovery(_) => coordinates,
        };
        Self { of_plate, times, coordinates, hulls: OnceLock::new() }
    }

    /// First and largest indices by these criteria and materials, which have the march that was sampled; `None` where it has to be
    /// marched for that.
    ///
    /// # Errors
    /// A criterion whose material lacks a constant, a stress or an index that is not finite.
    pub(super) fn judge(&self, criteria: &[NamedCriterion], materials: &[Material]) -> Result<Option<Extremes>, Error> {
        let Way::Product(operator) = &self.of_plate.way else { return Ok(None) };
        let Some(hulls) = self.hulls.get_or_init(|| self.make_hulls(materials)) else { return Ok(None) };
        let stresses = |site: usize, window: usize, out: &mut [Stress6<Ply>]| {
            let batch = self.batches().nth(window / LANES).unwrap_or_default();
            let within = windows(batch.len()).nth(window % LANES).unwrap_or_default();
            let columns = operator.columns(self.coordinates(batch.start + within.start..batch.start + within.end));
            put(&operator.stresses(site, &columns), out);
        };
        Ok(Some(hulls.judge(criteria, materials, &stresses)?))
    }

    fn make_hulls(&self, materials: &[Material]) -> Option<Hulls> {
        let sites = sites(&self.of_plate.recovery);
        let all = |batch: Range<usize>| windows(batch.len()).map(move |w| batch.start + w.start..batch.start + w.end);
        let windows: Vec<Range<usize>> = self.batches().flat_map(all).collect();
        if Hulls::size(sites.len(), windows.len()) > Demand::OPERATOR_LIMIT {
            return None;
        }
        let mut sampled: Vec<Sampled<'_>> = self.batches().filter_map(|batch| self.sampled(batch)).collect();
        let ranges = |site: usize, out: &mut [StressRange]| {
            sampled.iter_mut().zip(out.chunks_mut(LANES)).for_each(|(batch, out)| batch.ranges(site, out));
        };
        Hulls::new(sites, self.times.clone(), windows, materials, ranges)
    }

    /// Where the stresses are judged.
    pub(super) fn sites(&self) -> Vec<ScanSite> {
        sites(&self.of_plate.recovery)
    }

    /// Raises the score of each place to the largest share, over instants of the march, that an index of `model` has there in the largest
    /// index of its mode at that instant; instants at which that is below what is `warm` for the mode (criterion, mode) do not count.
    pub(super) fn add_hotness(&self, model: &Model, warm: &dyn Fn(&str, &str) -> f64, scores: &mut Vec<f64>) {
        let Way::Product(operator) = &self.of_plate.way else { return };
        let (sites, width) = (self.sites(), self.coordinates.len() / self.times.len().max(1));
        scores.resize(sites.len(), 0.0);
        let chosen: Vec<usize> = (0..INSTANTS).map(|k| k * self.times.len() / INSTANTS).collect();
        for batch in chosen.chunks(LANES) {
            let at: Vec<f64> =
                batch.iter().flat_map(|k| &self.coordinates[k * width..(k + 1) * width]).copied().collect();
            let (columns, mut stresses) = (operator.columns(&at), [Stress6::new([0.0; 6]); LANES]);
            for (name, criterion) in &model.criteria {
                let info = criterion.info();
                let modes = info.modes.len();
                let judged: Vec<usize> = (0..sites.len()).filter(|i| sites[*i].place.site() == info.site).collect();
                let mut indices = vec![0.0; modes * batch.len() * judged.len()];
                for (site, out) in judged.iter().zip(indices.chunks_exact_mut(modes * batch.len())) {
                    put(&operator.stresses(*site, &columns), &mut stresses);
                    let material = &model.materials[usize::from(sites[*site].material)];
                    for (stress, out) in stresses.iter().zip(out.chunks_exact_mut(modes)) {
                        criterion.indices(stress, material, out);
                    }
                }
                for lane in 0..modes * batch.len() {
                    let of = || indices.iter().skip(lane).step_by(modes * batch.len());
                    let largest = of().fold(0.0_f64, |a, b| a.max(*b));
                    if largest > warm(name, info.modes[lane % modes]) {
                        judged.iter().zip(of()).for_each(|(site, v)| scores[*site] = scores[*site].max(v / largest));
                    }
                }
            }
        }
    }

    /// Each begins with the last sample of the one before.
    fn batches(&self) -> impl Iterator<Item = Range<usize>> {
        let count = self.times.len();
        (0..count.saturating_sub(1).max(1)).step_by(SURVEYED - 1).map(move |start| start..(start + SURVEYED).min(count))
    }

    fn coordinates(&self, samples: Range<usize>) -> &[f64] {
        let width = self.coordinates.len() / self.times.len().max(1);
        &self.coordinates[samples.start * width..samples.end * width]
    }

    /// `None` where the stresses are no product with the coordinates, of which none are kept.
    fn sampled(&self, batch: Range<usize>) -> Option<Sampled<'_>> {
        let Way::Product(operator) = &self.of_plate.way else { return None };
        Some(Sampled::new(operator, self.coordinates(batch.clone()), batch.len()))
    }

    /// Shows all samples to `scan`, of which this is `wanted`.
    ///
    /// # Errors
    /// A stress or an index that is not finite.
    pub(super) fn survey(&self, scan: &mut Scan, wanted: Wanted) -> Result<(), ScanError> {
        for batch in self.batches() {
            let Some(mut sampled) = self.sampled(batch.clone()) else { continue };
            scan.survey(&self.times[batch], &mut sampled, wanted)?;
        }
        Ok(())
    }
}
