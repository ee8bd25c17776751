//! What of a reduced plate another program needs to march impacts on it, and to judge them where it is hottest.

use super::{March, SharedPlate};
use crate::analyses::samples::{PlateStresses, Way};
use crate::error::Error;
use crate::model::Model;
use fem_core::structure::Structure as _;
use fem_failure::scan::ScanSite;

/// Share of the largest index of a mode below which an instant says nothing of where it is hot.
const COLD: f64 = 0.01;

/// Score of a place where a mode is first or largest: above all shares.
const FOREMOST: f64 = 2.0;

/// A linear reduced plate with one contact: M q̈ + C q̇ + K q = F p, diagonal, and σ = S q + σ₀ at some places.
#[derive(Debug, Clone, PartialEq)]
pub struct CarriedPlate {
    /// K of each mode.
    pub stiffness: Vec<f64>,
    /// M of each mode: 1, or 0 without inertia.
    pub mass: Vec<f64>,
    /// C of each mode; empty without damping.
    pub damping: Vec<f64>,
    /// p.
    pub load: Vec<f64>,
    /// The places that are carried, the hottest first.
    pub sites: Vec<ScanSite>,
    /// S of these, Pa: six rows a place (11, 22, 33, 12, 23, 31), a number for each mode.
    pub operator: Vec<f64>,
    /// σ₀ of these, Pa, six a place.
    pub residual: Vec<f64>,
    /// Number of all places that are watched.
    pub watched: usize,
    /// What no index at a place that is left out exceeded in the impacts told of: its share in the largest that its mode had anywhere at
    /// the same time. 0 where all are carried.
    pub left: f64,
}

impl SharedPlate {
    /// This plate with its `most` hottest places, or why it cannot be carried. It is asked with several impacts on it, those of
    /// `models`: a place is as hot as the largest share that an index there has, in any of them and at any time, in the largest
    /// that its mode has anywhere.
    ///
    /// # Errors
    /// As [`SharedPlate::struck`]; a march that stops early.
    pub fn carried(&self, models: &[Model], most: usize) -> Result<Result<CarriedPlate, &'static str>, Error> {
        let Some(first) = models.first() else { return Err(Error::NoImpact) };
        let prepared = self.struck(first)?;
        let (system, modal) = (&prepared.system, &self.reduced.modal);
        let offsets: Vec<Vec<f64>> = prepared.effects.iter().filter_map(|e| e.offset().map(<[f64]>::to_vec)).collect();
        let [impactor] = system.impactors() else { return Ok(Err("several impactors strike the plate")) };
        if self.membrane.is_some() || first.effects.nature().large {
            return Ok(Err("the plate is not linear: its deflections stretch it"));
        }
        if !first.effects.nature().inertia {
            return Ok(Err("the plate has no inertia"));
        }
        if system.weight().is_some() {
            return Ok(Err("gravity pulls at the impactor"));
        }
        let mut load = vec![0.0; modal.ndof()];
        impactor.load.iter().for_each(|(i, p)| load[*i] += p);
        let mut plate = CarriedPlate {
            stiffness: modal.stiffnesses().to_vec(),
            mass: modal.masses().to_vec(),
            damping: modal.dampings().to_vec(),
            load,
            sites: Vec::new(),
            operator: Vec::new(),
            residual: Vec::new(),
            watched: 0,
            left: 0.0,
        };
        if let Some(of_plate) = &self.stresses {
            let scores = self.hotness(models)?;
            plate.carry(of_plate, &scores, most, &offsets);
        }
        Ok(Ok(plate))
    }

    /// How hot each place is, at most 1, or [`FOREMOST`].
    fn hotness(&self, models: &[Model]) -> Result<Vec<f64>, Error> {
        let mut scores = Vec::new();
        for model in models {
            let mut march = March::start(self.struck(model)?.firsts_alone())?;
            while !march.done() {
                march.advance();
            }
            let outcome = march.finish();
            if let Some(why) = outcome.stopped {
                return Err(Error::Stopped(why));
            }
            let Some(samples) = outcome.samples else { continue };
            let peaks: Vec<(&str, &str, f64)> =
                outcome.peaks.iter().map(|peak| (&*peak.criterion, peak.mode, COLD * peak.index)).collect();
            let warm = |criterion: &str, mode: &str| {
                let own = peaks.iter().find(|(c, m, _)| (*c, *m) == (criterion, mode));
                own.map_or(f64::INFINITY, |(.., least)| *least)
            };
            samples.add_hotness(model, &warm, &mut scores);
            let foremost = |site: &ScanSite| {
                outcome.peaks.iter().any(|peak| peak.site == *site)
                    || fem_failure::scan::first_per_mode(&outcome.events)
                        .iter()
                        .any(|e| (e.cell, e.place, e.position) == (site.cell, site.place, site.position))
            };
            for (score, site) in scores.iter_mut().zip(samples.sites()) {
                if foremost(&site) {
                    *score = FOREMOST;
                }
            }
        }
        Ok(scores)
    }
}

impl CarriedPlate {
    fn carry(&mut self, of_plate: &PlateStresses, scores: &[f64], most: usize, offsets: &[Vec<f64>]) {
        let Way::Product(operator) = &of_plate.way else { return };
        let sites = crate::analyses::stress::sites(&of_plate.recovery);
        let mut order: Vec<usize> = (0..scores.len()).collect();
        order.sort_by(|a, b| scores[*b].total_cmp(&scores[*a]).then(a.cmp(b)));
        self.watched = sites.len();
        self.left = order.get(most).map_or(0.0, |next| scores[*next].min(1.0));
        for site in order.into_iter().take(most) {
            let (rows, mut residual) = operator.of(site);
            for offset in offsets {
                for (sum, row) in residual.iter_mut().zip(rows.chunks_exact(self.load.len())) {
                    *sum += row.iter().zip(offset).map(|(s, q)| s * q).sum::<f64>();
                }
            }
            self.sites.push(sites[site]);
            self.operator.extend_from_slice(rows);
            self.residual.extend(residual);
        }
    }
}
