//! What a study found.

use super::axes::{AxisKind, LADDERS, Level, StudyAxis, judges};
use super::converge::{Convergence, ErrorBar};
use super::ladder::Ladder;
use super::plan::{Planned, SPENT, TOGETHER, below};
use super::quantity::FORCE_HISTORY;
use super::record::RunRecord;
use crate::forecast::nominal;
use crate::model::Model;
use fem_io::scene::{ContactLoad, Scene, Setting};
use std::collections::BTreeSet;

/// What a study found.
#[derive(Debug, Clone)]
pub struct Report {
    /// Title of the scene.
    pub title: String,
    /// The quantities that accuracy is asked of.
    pub asked: Vec<String>,
    /// Relative error to which the reference must have converged.
    pub tolerance: f64,
    /// The runs, in the order in which they were made.
    pub rows: Vec<Row>,
    /// The ladders, climbed.
    pub ladders: Vec<Ladder>,
    /// Axis and level of what was not run, and why.
    pub left_out: Vec<(String, String, String)>,
    /// What errors count from.
    pub reference: Reference,
    /// What the user should know.
    pub notes: Vec<String>,
    singular: bool,
    straight: bool,
}

/// A run.
#[derive(Debug, Clone)]
pub struct Row {
    /// Name of its axis.
    pub axis: String,
    /// What the levels of the axis are.
    pub kind: AxisKind,
    /// The level.
    pub level: Level,
    /// Its place on every ladder, if it is of levels of all ladders together.
    pub rungs: Vec<usize>,
    /// What it gave, or why it gave nothing.
    pub result: Result<RunRecord, String>,
    /// Expected processor time, s.
    pub expected_s: f64,
    /// Relative error of each quantity that its axis alone leaves, or what it changes, which has no bar.
    pub own: Vec<Option<ErrorBar>>,
    /// Relative error of each quantity, counted from the reference; what the reference leaves, where it is below that.
    pub errors: Vec<Option<ErrorBar>>,
    /// Whether no cheaper run has a smaller worst error.
    pub front: bool,
}

/// What errors count from.
#[derive(Debug, Clone, Default)]
pub struct Reference {
    /// Its place among the rows.
    pub row: usize,
    /// Per quantity: its value extrapolated along every ladder, where it is a number.
    pub values: Vec<Option<f64>>,
    /// Per quantity: the relative error that is left; infinite where something does not converge.
    pub left: Vec<ErrorBar>,
    /// Per quantity: relative difference of the run that is a level coarser along every ladder.
    pub agreement: Vec<Option<f64>>,
}

impl Row {
    fn new(axis: &str, kind: AxisKind, level: Level, result: Result<RunRecord, String>, expected_s: f64) -> Self {
        let (rungs, own, errors) = (Vec::new(), Vec::new(), Vec::new());
        Self { axis: axis.to_owned(), kind, level, rungs, result, expected_s, own, errors, front: false }
    }

    /// The largest of its errors of `quantities` (counted in those that are asked); `None` where one has none.
    pub fn worst_of(&self, quantities: &[usize]) -> Option<ErrorBar> {
        let each: Option<Vec<ErrorBar>> = quantities.iter().map(|q| self.errors.get(*q).copied().flatten()).collect();
        ErrorBar::worst(each?)
    }

    /// The largest of its errors; `None` where it has none of a quantity.
    pub fn worst(&self) -> Option<ErrorBar> {
        self.worst_of(&(0..self.errors.len()).collect::<Vec<_>>())
    }

    /// The largest of its errors and differences along its axis.
    pub fn own_worst(&self) -> Option<ErrorBar> {
        ErrorBar::worst(self.own.iter().copied().flatten())
    }

    /// Nominal seconds: what it costs, whatever the machine.
    pub fn work(&self) -> f64 {
        self.result.as_ref().map_or(f64::INFINITY, |record| nominal(&record.size).iter().sum())
    }

    /// Whether it solves the problem of the scene, and not another one.
    pub(super) fn is_candidate(&self) -> bool {
        self.kind != AxisKind::Problems
    }
}

impl Report {
    pub(super) fn new(scene: &Scene, model: &Model, base: RunRecord, asked: Vec<String>, tolerance: f64) -> Self {
        let node =
            |impact: &fem_io::scene::ImpactSpec| impact.impactors.iter().any(|i| i.load.value == ContactLoad::Node);
        let level = Level { label: "as it is".into(), setting: Setting::new(), at_limit: false };
        Self {
            title: scene.title.clone(),
            asked,
            tolerance,
            rows: vec![Row::new("scene", AxisKind::Ways, level, Ok(base), 0.0)],
            ladders: Vec::new(),
            left_out: Vec::new(),
            reference: Reference::default(),
            notes: Vec::new(),
            singular: !model.plate.info().is_shell() && scene.impact().is_some_and(node),
            straight: scene.keys.get("mesh.curves").is_some_and(|curves| curves == "\"straight\""),
        }
    }

    /// The scene itself.
    pub fn base(&self) -> &Row {
        &self.rows[0]
    }

    pub(super) fn add(&mut self, planned: &Planned, result: Result<RunRecord, String>) {
        // The scene's own level is there already.
        if planned.level.setting.is_empty() && planned.axis != TOGETHER {
            return;
        }
        let Planned { axis, kind, level, seconds, rungs, .. } = planned;
        self.rows.push(Row { rungs: rungs.clone(), ..Row::new(axis, *kind, level.clone(), result, *seconds) });
    }

    /// The run at `level` of `axis`, which may be the scene itself.
    pub(super) fn row_of(&self, axis: &str, level: &Level) -> Option<&Row> {
        match level.setting.is_empty() {
            true => self.rows.first(),
            false => self.rows.iter().find(|row| row.axis == axis && row.level == *level),
        }
    }

    /// The runs of an axis of which there are results, in the order of its levels.
    fn runs(&self, axis: &StudyAxis) -> Vec<(Level, RunRecord)> {
        let run = |level: &Level| {
            let row = self.row_of(&axis.name, level)?;
            Some((level.clone(), row.result.as_ref().ok()?.clone()))
        };
        axis.levels.iter().filter_map(run).collect()
    }

    /// Sees what the ladders among `axes` say; differences below `matters` are of no interest.
    pub(super) fn climb(&mut self, axes: &[StudyAxis], matters: f64) {
        let ladders = axes.iter().filter(|axis| axis.kind == AxisKind::Ladder);
        let climbed = ladders.map(|axis| Ladder::new(&axis.name, &self.runs(axis), &self.asked, matters));
        self.ladders = climbed.filter(|ladder| ladder.levels.len() > 1).collect();
    }

    /// Says of every ladder why no finer level ran.
    pub(super) fn end_ladders(&mut self, axes: &[StudyAxis]) {
        for ladder in &mut self.ladders {
            let levels = axes.iter().find(|axis| axis.name == ladder.axis).map_or(&[][..], |axis| &axis.levels);
            let finest = ladder.levels.last().and_then(|rung| levels.iter().position(|level| *level == rung.level));
            let Some(next) = finest.and_then(|k| levels.get(k + 1)) else {
                "there is no finer level".clone_into(&mut ladder.end);
                continue;
            };
            let planned = self.left_out.iter().find(|(axis, label, _)| *axis == ladder.axis && *label == next.label);
            let ran = self.rows.iter().find(|row| row.axis == ladder.axis && row.level == *next);
            let why = planned
                .map(|left_out| left_out.2.as_str())
                .or(ran.and_then(|row| row.result.as_ref().err()).map(String::as_str));
            ladder.end = format!("{}: {}", next.label, why.unwrap_or(SPENT));
        }
    }

    /// The rows whose runs were made for them: levels of all ladders together may be those of a single one.
    pub(super) fn made(&self) -> impl Iterator<Item = &Row> {
        let of = |row: &Row| (row.level.setting.clone(), row.level.at_limit);
        let first = move |k: usize| self.rows[..k].iter().all(|before| of(before) != of(&self.rows[k]));
        (0..self.rows.len()).filter(move |k| first(*k)).map(|k| &self.rows[k])
    }

    /// The ladder of `axis`, if it was climbed.
    pub(super) fn ladder(&self, axis: &str) -> Option<&Ladder> {
        self.ladders.iter().find(|ladder| ladder.axis == axis)
    }

    /// What is asked and converges along every ladder; all of it, if nothing does.
    pub(super) fn convergent(&self) -> Vec<String> {
        let stalls = |name: &&String| {
            let limits = self.ladders.iter().flat_map(|ladder| &ladder.limits);
            limits.filter(|l| l.quantity == **name).any(|l| matches!(l.convergence, Convergence::Stalls { .. }))
        };
        let sure: Vec<String> = self.asked.iter().filter(|name| !stalls(name)).cloned().collect();
        if sure.is_empty() { self.asked.clone() } else { sure }
    }

    /// Counts errors from the reference, and what each axis changes from its judge.
    pub(super) fn compare(&mut self, axes: &[StudyAxis]) {
        let place = |row: &Row| {
            let axis = axes.iter().position(|axis| axis.name == row.axis);
            let level = axis.and_then(|k| axes[k].levels.iter().position(|level| *level == row.level));
            // The scene itself stays first, levels of all ladders together come behind them.
            (row.kind != AxisKind::Ladder, axis.is_none(), axis, level)
        };
        self.rows[1..].sort_by(|a, b| place(a).cmp(&place(b)).then(a.work().total_cmp(&b.work())));
        self.count_errors();
        let finest = |axis: &str| {
            let axis = axes.iter().find(|a| a.name == axis)?;
            self.runs(axis).pop().map(|run| run.1)
        };
        // Edges along curves are judged by the same cells with the edges of the scene.
        let twin = |row: &Row| {
            let mut setting = row.level.setting.clone();
            setting.remove("mesh.curves")?;
            self.rows.iter().find(|other| other.level.setting == setting)?.result.clone().ok()
        };
        let finest = |row: &Row| judges(&row.axis).first().and_then(|name| finest(name));
        let judge: Vec<Option<RunRecord>> = self.rows.iter().map(|row| twin(row).or_else(|| finest(row))).collect();
        let (asked, reference) = (self.asked.clone(), self.reference.clone());
        let exact = self.rows[reference.row].result.clone();
        let base = self.rows[0].result.clone();
        let ladders = self.ladders.clone();
        for (row, judge) in self.rows.iter_mut().zip(judge) {
            let Ok(record) = &row.result else { continue };
            row.errors = asked
                .iter()
                .zip(reference.values.iter().zip(&reference.left))
                .map(|(quantity, (value, left))| {
                    let error = match (value, record.value(quantity)) {
                        (Some(value), Some(own)) if quantity != FORCE_HISTORY && *value != 0.0 => {
                            ((own - value) / value).abs()
                        }
                        _ => record.difference(exact.as_ref().ok()?, quantity)?.abs(),
                    };
                    // An error below what is left of the reference is not known to be smaller.
                    let error = if error < left.error && left.error.is_finite() { left.error } else { error };
                    Some(ErrorBar { error, bar: left.bar })
                })
                .collect();
            let ladder = ladders.iter().find(|ladder| ladder.axis == row.axis);
            let rung = ladder.and_then(|ladder| ladder.levels.iter().find(|rung| rung.level == row.level));
            let other = judge.or_else(|| base.clone().ok());
            row.own = match rung {
                Some(rung) => rung.errors.iter().map(|e| Some(e.1)).collect(),
                None => {
                    let change = |q: &String| Some(ErrorBar::exact(record.difference(other.as_ref()?, q)?.abs()));
                    asked.iter().map(change).collect()
                }
            };
        }
        self.mark_front();
        self.add_notes();
    }

    /// The finest joint run is the reference; the scene itself, where there is none.
    fn count_errors(&mut self) {
        let sure = self.convergent();
        let total = |row: &Row| -> f64 {
            let each = self.ladders.iter().zip(&row.rungs).map(|(ladder, k)| ladder.levels[*k].worst(&sure));
            each.map(|worst| worst.map_or(f64::INFINITY, |worst| worst.error)).sum()
        };
        let joint = self.rows.iter().enumerate().filter(|(_, row)| row.axis == TOGETHER && row.result.is_ok());
        let finest = joint.map(|(k, row)| (k, total(row))).min_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        let row = finest.map_or(0, |finest| finest.0);
        let finest = &self.rows[row];
        let Ok(record) = &finest.result else { return };
        let below = below(&finest.rungs);
        let second = self.rows.iter().find(|row| row.axis == TOGETHER && row.rungs == below);
        let second = second.and_then(|row| row.result.as_ref().ok()).filter(|_| finest.rungs.iter().all(|k| *k > 0));
        let mut reference = Reference { row, ..Reference::default() };
        for quantity in &self.asked {
            let each = self.ladders.iter().zip(&finest.rungs).map(|(ladder, k)| ladder.correction(quantity, *k));
            let unknown = ErrorBar { error: f64::INFINITY, bar: f64::INFINITY };
            let (mut correction, mut left) = (0.0, ErrorBar::exact(0.0));
            for found in each {
                let (by, of_ladder) = found.unwrap_or((0.0, unknown));
                correction += by;
                left = ErrorBar { error: left.error + of_ladder.error, bar: left.bar + of_ladder.bar };
            }
            if finest.rungs.is_empty() {
                left = unknown;
            }
            let value = record.value(quantity);
            reference.values.push(value.map(|value| value + correction * value.abs()));
            reference.left.push(left);
            reference.agreement.push(second.and_then(|second| second.difference(record, quantity)).map(f64::abs));
        }
        self.reference = reference;
    }

    /// Whether it agrees to the tolerance, in all that is asked, with the run a level coarser along every ladder.
    pub fn is_proven(&self) -> bool {
        let agrees = |difference: &Option<f64>| difference.is_some_and(|d| d <= self.tolerance);
        !self.reference.agreement.is_empty() && self.reference.agreement.iter().all(agrees)
    }

    /// Rows that compete, by work, cheapest first.
    fn sort_by_work(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.rows.len()).filter(|k| self.rows[*k].is_candidate()).collect();
        order.sort_by(|a, b| self.rows[*a].work().total_cmp(&self.rows[*b].work()));
        order
    }

    fn mark_front(&mut self) {
        let mut best = f64::INFINITY;
        for k in self.sort_by_work() {
            let row = &mut self.rows[k];
            let worst = row.worst().map_or(f64::INFINITY, |worst| worst.error);
            row.front = worst < best;
            best = best.min(worst);
        }
    }

    /// The cheapest run whose error of every quantity in `quantities` (counted in `asked`) is within `tolerance`, what is
    /// left of the reference included.
    pub fn cheapest(&self, quantities: &[usize], tolerance: f64) -> Option<&Row> {
        let within = |row: &&Row| row.worst_of(quantities).is_some_and(|worst| worst.most() <= tolerance);
        self.sort_by_work().into_iter().map(|k| &self.rows[k]).find(within)
    }

    fn add_notes(&mut self) {
        let mut notes = Vec::new();
        for ladder in &self.ladders {
            let stalls = ladder.limits.iter().filter_map(|limit| match limit.convergence {
                Convergence::Stalls { difference } => Some((limit.quantity.as_str(), difference)),
                _ => None,
            });
            for (quantity, difference) in stalls {
                let why = match (ladder.axis.as_str(), self.singular) {
                    ("mesh" | "layers", true) => {
                        ": a force at a node of a solid is singular, and what is near it follows the mesh; use a patch"
                    }
                    _ => "",
                };
                notes.push(format!(
                    "{quantity} does not converge along {} as far as it was climbed: the last level changes it by \
                     {difference:.1e}, hardly less than the one before; nothing is extrapolated{why}; not run: {}",
                    ladder.axis, ladder.end
                ));
            }
        }
        if self.singular && !notes.iter().any(|note| note.contains("singular")) {
            notes.push(
                "the contact force acts at a node of a solid, where its deflection has no limit: errors near the contact are \
                 of this mesh only; use a patch"
                    .into(),
            );
        }
        if let Some(row) = self.rows.iter().find(|row| row.axis == "geometry") {
            let error = row.own_worst().map_or(0.0, |worst| worst.error);
            notes.push(match self.straight {
                true => format!(
                    "geometry: the mesh keeps straight edges along a curve, and refinement leads to the polygon's \
                     answer; the curve's is {error:.1e} away. None of the other figures holds this error: set \
                     `mesh.curves = \"kept\"`"
                ),
                false => format!(
                    "geometry: edges that stay straight along the curve would leave {error:.1e} on the next finer mesh; \
                     refinement follows the curve"
                ),
            });
        }
        let unclimbed: BTreeSet<&str> = self
            .left_out
            .iter()
            .filter(|(axis, _, why)| why.starts_with(SPENT) && LADDERS.contains(&axis.as_str()))
            .map(|(axis, ..)| axis.as_str())
            .filter(|axis| self.ladders.iter().all(|ladder| ladder.axis != *axis))
            .collect();
        for axis in unclimbed {
            notes.push(format!("there was no time for the ladder `{axis}`: its error is in none of the figures"));
        }
        self.notes = notes;
    }
}
