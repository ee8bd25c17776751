//! What a choice costs, by counts of work: nominal seconds of a run with it over those of one without.

use crate::forecast::{FILL, Size, nominal};
use crate::model::{Impact, Model};
use fem_core::counters::Counters;
use fem_core::failure::Site;

/// Unknowns of a shell's node.
const SHELL: f64 = 5.0;

/// Sizes of the march of a model, before it is run.
#[derive(Debug, Clone, Copy)]
pub(super) struct MarchSize(pub(super) Size);

impl MarchSize {
    pub(super) fn of(model: &Model, impact: &Impact, factor_entries: usize) -> Self {
        let (plate, march) = (&model.plate, &impact.spec.march);
        let cells = plate.kept_cells().count();
        let solves = impact.vectors;
        let interfaces = model.laminate.plies.len() - 1;
        let judged = |site| model.criteria.iter().any(|(_, criterion)| criterion.info().site == site);
        let places = [(Site::Ply, model.heights.sites(&model.laminate)), (Site::Interface, interfaces)]
            .map(|(s, n)| if judged(s) { n } else { 0 });
        let unknowns = model.constraints.ndof();
        Self(Size {
            cells,
            layers: plate.layers(),
            columns: plate.columns.len(),
            unknowns,
            marched: solves.unwrap_or(unknowns).min(unknowns),
            reduced: solves.is_some(),
            factor_entries,
            sites: (model.watched.len() + model.centres.len()) * places.iter().sum::<usize>(),
            step_s: march.step.value,
            samples: (march.end.value / model.sample_every) as u64,
            work: Counters {
                elements: cells as u64,
                solves: solves.unwrap_or(0) as u64,
                steps: (march.end.value / march.step.value).ceil() as u64,
                ..Counters::default()
            },
            ..Size::default()
        })
    }

    fn seconds(&self) -> f64 {
        nominal(&self.0).iter().sum()
    }

    /// A march over a static solution.
    pub(super) fn march(&self) -> f64 {
        let mut rest = Size { reduced: false, samples: 1, ..self.0 };
        rest.work.steps = 0;
        self.seconds() / nominal(&rest).iter().sum::<f64>()
    }

    /// The model over a shell on the same mesh.
    pub(super) fn solid(&self) -> f64 {
        let Size { unknowns, columns, layers, cells, factor_entries, sites, .. } = self.0;
        let per_column = SHELL * columns as f64 / unknowns as f64;
        let mut shell = Size {
            cells: cells / layers,
            layers: 1,
            unknowns: (SHELL * columns as f64) as usize,
            factor_entries: (factor_entries as f64 * per_column.powi(2)) as usize,
            sites,
            ..self.0
        };
        shell.work.elements = shell.cells as u64;
        self.seconds() / Self(shell).seconds()
    }

    /// Cells of an edge shorter by `cells` and a step shorter by `step`, over the model.
    pub(super) fn finer(&self, cells: f64, step: f64) -> f64 {
        let squares = cells * cells;
        let times = |n: usize, by: f64| (n as f64 * by) as usize;
        let mut finer = Size {
            cells: times(self.0.cells, squares),
            columns: times(self.0.columns, squares),
            unknowns: times(self.0.unknowns, squares),
            factor_entries: times(self.0.factor_entries, squares.powf(FILL)),
            sites: times(self.0.sites, squares),
            ..self.0
        };
        finer.work.elements = (self.0.work.elements as f64 * squares) as u64;
        finer.work.steps = (self.0.work.steps as f64 * step) as u64;
        Self(finer).seconds() / self.seconds()
    }
}
