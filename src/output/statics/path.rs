//! The path that loads at rest take while interfaces open.

use crate::analyses::statics::{Followed, PathState};
use crate::error::Error;
use crate::model::Model;
use crate::output::delamination;
use crate::output::summary::DelaminationFigures;
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::plot::{self, Axis, LinePlot, Series};
use fem_io::tables::{self, TableValue};
use serde::Serialize;

/// Share of the work that may be missing without a word.
const NOTABLE_ERROR: f64 = 1e-2;

/// A path of equilibrium, in figures.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct PathFigures {
    pub states: usize,
    pub iterations: usize,
    pub peak_force_N: f64,
    pub displacement_at_peak_m: f64,
    pub final_force_N: f64,
    pub final_displacement_m: f64,
    pub work_J: f64,
    pub stored_J: f64,
    pub dissipated_J: f64,
    /// Work less what is stored and dissipated, relative to the largest work.
    pub energy_error_relative: f64,
    pub snaps_back: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
    pub delamination: DelaminationFigures,
}

impl PathFigures {
    pub(super) fn of(followed: &Followed) -> Option<Self> {
        let states = &followed.states;
        let (last, peak) = (states.last()?, states.iter().max_by(|a, b| a.force.total_cmp(&b.force))?);
        let largest = states.iter().fold(0.0_f64, |most, state| most.max(state.work.abs()));
        let missing = |state: &PathState| (state.work - state.stored - state.dissipated).abs() / largest;
        Some(Self {
            states: states.len(),
            iterations: states.iter().map(|state| state.iterations).sum(),
            peak_force_N: peak.force,
            displacement_at_peak_m: peak.displacement,
            final_force_N: last.force,
            final_displacement_m: last.displacement,
            work_J: last.work,
            stored_J: last.stored,
            dissipated_J: last.dissipated,
            energy_error_relative: states.iter().map(missing).fold(0.0, f64::max),
            snaps_back: states.windows(2).any(|pair| pair[1].displacement < pair[0].displacement),
            stopped: followed.stopped.clone(),
            delamination: DelaminationFigures::of(&followed.delaminated),
        })
    }

    pub(super) fn lines(&self) -> Vec<String> {
        let [force, length, energy] = [Dimension::FORCE, Dimension::LENGTH, Dimension::ENERGY];
        let back = if self.snaps_back { "; the displacement turns back on the way" } else { "" };
        let mut lines = vec![
            format!(
                "  path      {} states, {} iterations: largest force {} at {}, at the end {} at {}{back}",
                self.states,
                self.iterations,
                force.of(self.peak_force_N),
                length.of(self.displacement_at_peak_m),
                force.of(self.final_force_N),
                length.of(self.final_displacement_m)
            ),
            format!(
                "  energy    work {}: {} stored, {} dissipated; error {:.1e} of the largest work",
                energy.of(self.work_J),
                energy.of(self.stored_J),
                energy.of(self.dissipated_J),
                self.energy_error_relative
            ),
        ];
        lines.extend(self.delamination.lines());
        lines
    }

    pub(super) fn warnings(&self) -> Vec<String> {
        let stopped = self.stopped.as_ref().map(|why| {
            let end = Dimension::LENGTH.of(self.final_displacement_m);
            format!("the path ended at {end}, before the loads had moved as far as they were to: {why}")
        });
        let coarse = (self.energy_error_relative > NOTABLE_ERROR).then(|| {
            format!(
                "the work along the path differs from what is stored and dissipated by {:.1} %: give a smaller `path.step`",
                100.0 * self.energy_error_relative
            )
        });
        stopped.into_iter().chain(coarse).collect()
    }
}

const HEADER: [&str; 8] =
    ["force_N", "displacement_m", "work_J", "stored_J", "dissipated_J", "delaminated_m2", "projected_m2", "iterations"];

/// Writes `path.csv` and `delaminations.csv`; unless the scene wants no pictures, `force_displacement` and `c_scan`.
pub(super) fn write(dir: &OutputDir, model: &Model, followed: &Followed) -> Result<(), Error> {
    let row = |state: &PathState| {
        let PathState { force, displacement, work, stored, dissipated, delaminated, projected, iterations } = *state;
        let numbers = [force, displacement, work, stored, dissipated, delaminated, projected].map(TableValue::Number);
        numbers.into_iter().chain([TableValue::Count(iterations as u64)]).collect()
    };
    tables::write_columns(dir, "path.csv", &HEADER, followed.states.iter().map(row))?;
    delamination::write_table(dir, model, Some(&followed.delaminated))?;
    if !model.output.plots {
        return Ok(());
    }
    let points = || followed.states.iter().map(|state| (state.displacement, state.force));
    let (x, length) = Axis::fitting("Displacement", Dimension::LENGTH, points().map(|p| p.0));
    let (y, force) = Axis::fitting("Force", Dimension::FORCE, points().map(|p| p.1));
    let curve = [(0.0, 0.0)].into_iter().chain(points().map(|p| (p.0 * length, p.1 * force))).collect();
    plot::line_plot(&LinePlot {
        title: model.origin.title.clone(),
        x,
        y,
        series: vec![Series::solid("path of equilibrium".to_owned(), curve)],
        marks: Vec::new(),
        doubts: Vec::new(),
    })?
    .write(dir, "force_displacement")?;
    delamination::write_plot(dir, model, Some(&followed.delaminated))
}
