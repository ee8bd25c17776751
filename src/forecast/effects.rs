//! What an effect costs, by counts of work: nominal seconds of a run with it over those of one
//! without.

use super::memory::vectors;
use super::{FILL, Size, nominal};
use crate::model::{Impact, Model};
use fem_core::counters::Counters;
use fem_core::failure::Site;

/// Turns of Newton's method in an implicit step, and steps that one tangent serves.
const TURNS: f64 = 3.0;
const KEPT: f64 = 20.0;

/// Time of an internal force over that of a stiffness.
const FORCE: f64 = 1.0 / 3.0;

/// Of a reduced plate: seconds per cell of the strains of its modes and of their work, directions of these that are solved
/// for, patterns of stress, and seconds per entry of their forms and turn (case 5 of the report's table 1, 60 vectors).
const STRAINS: f64 = 2e-3;
const DIRECTIONS: u64 = 20;
const PATTERNS: f64 = 13.0;
const ENTRY: f64 = 8e-10;

/// Unknowns of a shell's node.
const SHELL: f64 = 5.0;

/// Sizes of the march of a model, before it is run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Work(Size);

impl Work {
    pub(crate) fn of(model: &Model, impact: &Impact, factor_entries: usize) -> Self {
        let (plate, march) = (&model.plate, &impact.spec.march);
        let cells = plate.kept_cells().count();
        let solves = impact.reduction.as_ref().map(|_| vectors(&impact.spec.reduction.params));
        let plies = model.laminate.plies.len();
        let judged = |site| model.criteria.iter().any(|(_, criterion)| criterion.info().site == site);
        let places = [(Site::Ply, plies), (Site::Interface, plies - 1)].map(|(s, n)| if judged(s) { n } else { 0 });
        let unknowns = model.constraints.ndof();
        Self(Size {
            cells,
            layers: plate.layers(),
            columns: plate.columns.len(),
            unknowns,
            marched: solves.unwrap_or(unknowns).min(unknowns),
            reduced: solves.is_some(),
            factor_entries,
            sites: model.watched.len() * places.iter().sum::<usize>(),
            step_s: march.step.value,
            samples: (march.end.value / model.scene.failure.every) as u64,
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
    pub(crate) fn inertia(&self) -> f64 {
        let mut rest = Size { reduced: false, samples: 1, ..self.0 };
        rest.work.steps = 0;
        self.seconds() / nominal(&rest).iter().sum::<f64>()
    }

    /// A march by Newton's method over the linear one: [`TURNS`] internal forces and solves a step, of a full plate a new
    /// tangent every [`KEPT`] steps, of a reduced one the patterns of its membrane stresses before.
    pub(crate) fn membrane(&self) -> f64 {
        let steps = self.0.work.steps as f64;
        if self.0.reduced {
            let mut more = self.0;
            more.work.solves += DIRECTIONS;
            let modes = self.0.marched as f64;
            let turns = TURNS * steps * PATTERNS * modes * modes * ENTRY;
            return 1.0
                + (Self(more).seconds() - self.seconds() + self.0.cells as f64 * STRAINS + turns) / self.seconds();
        }
        let [assemble, factor, stresses, solves, judge] = nominal(&self.0);
        let turns = TURNS * (solves + steps * FORCE * assemble);
        let tangents = steps / KEPT * (assemble + factor);
        (assemble + factor + stresses + turns + tangents + judge) / self.seconds()
    }

    /// The model over a shell on the same mesh.
    pub(crate) fn solid(&self) -> f64 {
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
    pub(crate) fn finer(&self, cells: f64, step: f64) -> f64 {
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
