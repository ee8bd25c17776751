//! What a model takes: a plate that is too large is refused before anything is made that grows with it.

use super::{Model, Plan, mean_cell};
use crate::cost::require;
use crate::error::Error;
use crate::forecast::{Demand, MemoryEstimate, Size, analyse};
use fem_core::assembly::{Pattern, Separable, Symbolic};
use fem_core::counters::Counters;
use fem_core::failure::Site;
use fem_core::plate::Plate;
use fem_core::structure::SolveError;
use std::sync::Arc;

/// Refuses a plate of which the matrices alone would be more than there is: before anything is made that grows with them.
pub(super) fn check(plate: &Plate) -> Result<(), Error> {
    let kept = plate.kept_cells().count() as f64 / plate.cells() as f64;
    let unknowns = plate.ndof() as f64 * kept;
    // Those of a cell lie in 4 columns and on 2 levels. One unknown meets those of 9 columns on its own and both adjacent
    // levels, and half of these entries are stored.
    let layers = plate.layers() as f64;
    let levels = (3.0 * layers + 1.0) / (layers + 1.0);
    let entries = unknowns * plate.info().ndof() as f64 * 9.0 / 4.0 * levels / 2.0 / 2.0;
    require(24.0 * entries, || format!("its stiffness has about {entries:.1e} entries"))
}

impl Model {
    /// The analysis of `pattern`, and what a computation of the model with it takes.
    ///
    /// # Errors
    /// More memory than there is.
    pub(crate) fn analyse(&self, pattern: Arc<Pattern>) -> Result<(Symbolic, MemoryEstimate), Error> {
        let answers = self.lifting().len();
        let (vectors, contacts) = match &self.plan {
            Plan::Impact(impact) => match impact.vectors {
                Some(vectors) => (vectors + answers, Some(impact.strikes.len())),
                None => (2, None),
            },
            Plan::Modes { count } | Plan::Buckling { count } => (2 * count, None),
            Plan::Static { .. } => (2, None),
        };
        let kept = match &self.plan {
            Plan::Impact(impact) => self.kept(impact),
            _ => 0.0,
        };
        let judged = |of: Site| self.criteria.iter().filter(move |(_, c)| c.info().site == of);
        let modes = |of: Site| judged(of).map(|(_, c)| c.info().modes.len()).sum::<usize>();
        let looks = self.interface.is_some() && judged(Site::Interface).next().is_some();
        let counts = |region: usize| {
            let laminate = &self.laminates[region];
            let plies = laminate.plies.len();
            let layers = laminate.layers.len();
            // An interface between two layers of cells, or within a shell, has a stress from either side.
            let sides = if self.plate.info().is_shell() { 2 * (plies - 1) } else { plies + layers - 2 };
            [self.heights.sites(laminate), if looks { sides } else { 0 }]
        };
        let centres = self.centres.iter().map(|centre| centre.quad);
        let windows = self.watched.iter().copied().chain(centres).filter(|_| !self.criteria.is_empty());
        let [plies, interfaces] = windows.fold([0, 0], |[plies, interfaces], quad| {
            let [own, between] = counts(self.plate.region(quad));
            [plies + own, interfaces + between]
        });
        let demand = Demand {
            all: self.plate.ndof(),
            unknowns: pattern.ndof(),
            vectors,
            answers,
            contacts,
            kept,
            sites: plies + interfaces,
            indices: plies * modes(Site::Ply) + interfaces * modes(Site::Interface),
        };
        let joined = self.separation.as_ref().map(|separation| {
            Separable::joined(&self.plate, &separation.supports, &separation.interfaces, &separation.states)
        });
        let joined = joined.transpose().map_err(SolveError::from)?;
        analyse(pattern, &demand, self.effects.memory(&self.body(), &demand), joined)
    }

    /// Its sizes, and the work that was done on it; what is marched and judged is left at zero.
    pub(crate) fn size(&self, counters: &Counters) -> Size {
        Size {
            cells: self.plate.cells(),
            layers: self.plate.layers(),
            cell_m: mean_cell(&self.plate),
            columns: self.plate.columns.len(),
            unknowns: self.constraints.ndof(),
            work: *counters,
            ..Size::default()
        }
    }
}
