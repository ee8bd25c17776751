//! The stresses of a plate that is marched, as its criteria see them, and all that a march showed them.

use super::expansion::Expansion;
use super::operator::{LANES, SURVEYED, Sampled, StressOperator};
use super::stress::{build_recovery, recover, residual, sites};
use crate::error::Error;
use crate::forecast::Demand;
use crate::model::Model;
use fem_core::failure::StressRange;
use fem_core::recovery::Recovery;
use fem_failure::scan::{Scan, ScanError};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// What the criteria see of a plate, whatever strikes it.
#[derive(Debug)]
pub(super) struct PlateStresses {
    pub(super) recovery: Recovery,
    pub(super) way: Way,
}

/// How stresses follow from coordinates.
#[derive(Debug)]
pub(super) enum Way {
    /// By a product.
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
        // Stresses of large deflections are not products with the coordinates.
        if let Some((basis, modes)) = expansion.basis().filter(|_| !model.effects.nature().large)
            && 6 * recovery.sites() * modes * size_of::<f64>() <= Demand::OPERATOR_LIMIT
        {
            let mut product = vec![0.0; 6 * recovery.sites() * modes];
            recover(model, &recovery, &expansion.nodal(basis), modes, None, &mut product)?;
            return Ok(Self { recovery, way: Way::Product(StressOperator::new(&product, modes, residual)) });
        }
        Ok(Self { recovery, way: Way::Recovery(residual) })
    }
}

/// The coordinates that a plate had at the samples of a march, from which its stresses are judged.
#[derive(Debug)]
pub struct PlateSamples {
    of_plate: Arc<PlateStresses>,
    times: Vec<f64>,
    coordinates: Vec<f64>,
    /// Of each batch the ranges of all sites, which are the same for all strengths: made once they are wanted again.
    ranges: OnceLock<Vec<Vec<StressRange>>>,
}

impl PlateSamples {
    /// Of a plate that had these `coordinates` at `times`, s.
    pub(super) fn new(of_plate: Arc<PlateStresses>, times: Vec<f64>, coordinates: Vec<f64>) -> Self {
        Self { of_plate, times, coordinates, ranges: OnceLock::new() }
    }

    /// Events and peaks by the criteria and strengths of `model`, which is that of the march but for these.
    ///
    /// # Errors
    /// A criterion whose material lacks a constant, a stress or an index that is not finite.
    pub(super) fn judge(&self, model: &Model) -> Result<Scan, Error> {
        let mut scan = Scan::new(model.criteria.clone(), sites(&self.of_plate.recovery), model.materials.clone())?;
        let all =
            || self.batches().filter_map(|batch| Some(self.sampled(batch)?.all_ranges(scan.sites().len()))).collect();
        let of_window = scan.sites().len() * size_of::<StressRange>();
        let known = match self.times.len() / (LANES - 1) * of_window <= Demand::OPERATOR_LIMIT {
            true => self.ranges.get_or_init(all).as_slice(),
            false => &[],
        };
        self.survey(&mut scan, known)?;
        Ok(scan)
    }

    /// Each begins with the last sample of the one before.
    fn batches(&self) -> impl Iterator<Item = Range<usize>> {
        let count = self.times.len();
        (0..count.saturating_sub(1).max(1)).step_by(SURVEYED - 1).map(move |start| start..(start + SURVEYED).min(count))
    }

    /// `None` where the stresses are no product with the coordinates, of which none are kept.
    fn sampled(&self, batch: Range<usize>) -> Option<Sampled<'_>> {
        let Way::Product(operator) = &self.of_plate.way else { return None };
        let width = self.coordinates.len() / self.times.len().max(1);
        Some(Sampled::new(operator, &self.coordinates[batch.start * width..batch.end * width], batch.len()))
    }

    /// `known` are the ranges of each batch, or none.
    pub(super) fn survey(&self, scan: &mut Scan, known: &[Vec<StressRange>]) -> Result<(), ScanError> {
        for (number, batch) in self.batches().enumerate() {
            let Some(sampled) = self.sampled(batch.clone()) else { continue };
            scan.survey(&self.times[batch], &mut sampled.knowing(known.get(number).map(Vec::as_slice)))?;
        }
        Ok(())
    }
}
