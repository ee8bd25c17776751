//! What a study runs within its limits.

use super::axes::{AxisKind, Level, StudyAxis, judges};
use super::ladder::Ladder;
use super::predict::{self, Rates};
use super::record::RunRecord;
use super::report::Report;
use super::session::Session;
use crate::cost::processor_time;
use crate::error::Error;
use crate::forecast::Size;
use crate::model::Model;
use fem_core::plugin::Dimension;
use fem_io::scene;

/// Nominal seconds of a study without a budget, and of its largest run.
const LIMIT: f64 = 240.0;
const LARGEST: f64 = 60.0;

/// Shares of the time for ladders and for levels of them together; the rest is for other ways and problems.
const LADDERS: f64 = 0.65;
const JOINT: f64 = 0.25;

/// Levels of a ladder without one of the scene's own that are run before any ladder is chosen.
const FIRST: usize = 3;

/// Share of what all ladders leave below which none of them is climbed further.
const WORTH: f64 = 0.1;

/// Largest share of the time that one run may take.
const ONE: f64 = 0.25;

/// Entries of a factor beyond which no run is planned: 8 bytes each, and as much again on the way.
pub(super) const MOST_ENTRIES: usize = 400_000_000;

/// Cells beyond which a model is not even made to be measured.
pub(super) const MOST_CELLS: f64 = 200_000.0;

/// Errors that levels of all ladders together are sought for, and how much smaller the sum of their errors is to be.
const TARGETS: [f64; 10] = [0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5];
const SAFETY: f64 = 0.7;

/// Share of their time that the finest of them may take.
const FINEST: f64 = 0.7;

/// Why a run was left out.
pub(super) const SPENT: &str = "beyond the time of the study";

/// A run that is planned.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// Name of its axis; `joint` for levels of all ladders together.
    pub axis: String,
    /// What the levels of the axis are.
    pub kind: AxisKind,
    /// The level.
    pub level: Level,
    /// Expected sizes.
    pub size: Size,
    /// Expected processor time, s.
    pub seconds: f64,
    /// Its place on every ladder, if it is of levels of all ladders together.
    pub rungs: Vec<usize>,
}

/// Name of the axis of levels of all ladders together.
pub(super) const TOGETHER: &str = "joint";

/// What a study is going to run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StudyPlan {
    /// The first levels of the ladders and the runs beside them, in order.
    pub runs: Vec<Planned>,
    /// The finer levels of the ladders, of which those are run whose ladder leaves most a second.
    pub finer: Vec<Planned>,
    /// Runs beside the ladders for which time may be left.
    pub spare: Vec<Planned>,
    /// Axis and level of what is not run, and why.
    pub left_out: Vec<(String, String, String)>,
    /// Seconds that finer levels, and levels of all ladders together, may take.
    pub further: f64,
}

impl StudyPlan {
    /// Expected processor time of all, s.
    pub fn seconds(&self) -> f64 {
        self.runs.iter().map(|run| run.seconds).sum::<f64>() + self.further
    }
}

/// Decides what is run.
#[derive(Debug)]
pub(super) struct Planner {
    base: Size,
    budget: Option<f64>,
    /// Processor time of the process when the study began, s; negative by what ran before the process.
    began: f64,
    /// Nominal seconds, or seconds, granted so far.
    spent: f64,
}

impl Planner {
    pub(super) fn new(session: &Session<'_>, base: &RunRecord, budget: Option<f64>) -> Self {
        // What another process has run counts, too.
        let before: f64 = session.records().map(RunRecord::total).sum();
        let mut planner = Self { base: base.size, budget, began: processor_time() - before, spent: 0.0 };
        planner.spent = planner.rates(session).seconds(&base.size);
        planner
    }

    fn whole(&self) -> f64 {
        self.budget.unwrap_or(LIMIT)
    }

    fn largest(&self) -> f64 {
        self.budget.map_or(LARGEST, |budget| ONE * budget)
    }

    /// Nominal ones without a budget: the same runs on every machine.
    fn rates(&self, session: &Session<'_>) -> Rates {
        if self.budget.is_some() { Rates::of(session.records()) } else { Rates::NOMINAL }
    }

    /// What the study has taken so far.
    fn used(&self) -> f64 {
        if self.budget.is_some() { processor_time() - self.began } else { self.spent }
    }

    /// What a run takes of the time: nothing, where a budget counts what is done already.
    fn cost(&self, session: &Session<'_>, planned: &Planned, rates: Rates) -> f64 {
        let done = self.budget.is_some() && session.has(&planned.level.setting);
        if done { 0.0 } else { rates.seconds(&planned.size) }
    }

    /// The levels of `axes` that fit the time: of the ladders those up to the scene's own, and of the rest the cheapest.
    pub(super) fn plan(&mut self, session: &Session<'_>, axes: &[StudyAxis]) -> StudyPlan {
        let rates = self.rates(session);
        let mut plan = StudyPlan::default();
        let (mut first, mut beside) = (Vec::new(), Vec::new());
        for axis in axes {
            let own = axis.levels.iter().position(|level| level.setting.is_empty());
            // Two levels at least, and all that are coarser than the scene and hence cheaper.
            let until = own.map_or(FIRST, |own| own.max(1) + 1);
            for (k, level) in axis.levels.iter().enumerate() {
                match self.expect(session, axis, level, rates) {
                    Ok(planned) if axis.kind != AxisKind::Ladder => beside.push(planned),
                    Ok(planned) if k < until => first.push(planned),
                    Ok(planned) => plan.finer.push(planned),
                    Err(why) => plan.left_out.push((axis.name.clone(), level.label.clone(), why)),
                }
            }
        }
        let by_time = |a: &Planned, b: &Planned| a.seconds.total_cmp(&b.seconds);
        // Without ladders to combine, their time is for the rest.
        let ladders = !first.is_empty();
        let mut time = LADDERS * self.whole();
        first.sort_by(by_time);
        for planned in first {
            if planned.level.setting.is_empty() || self.take(session, &planned, &mut time, rates) {
                plan.runs.push(planned);
            } else {
                plan.finer.insert(0, planned);
            }
        }
        plan.further = if ladders { time + JOINT * self.whole() } else { 0.0 };
        let mut time = if ladders { 1.0 - LADDERS - JOINT } else { 1.0 } * self.whole();
        beside.sort_by(by_time);
        for planned in beside {
            if planned.level.setting.is_empty() || self.take(session, &planned, &mut time, rates) {
                plan.runs.push(planned);
            } else if planned.seconds <= self.largest() {
                plan.spare.push(planned);
            } else {
                plan.left_out.push((planned.axis, planned.level.label, SPENT.into()));
            }
        }
        let place = |planned: &Planned| {
            let axis = axes.iter().position(|a| a.name == planned.axis);
            (axis, axis.and_then(|axis| axes[axis].levels.iter().position(|level| *level == planned.level)))
        };
        plan.runs.sort_by_key(|planned| (planned.kind != AxisKind::Ladder, place(planned)));
        plan.finer.sort_by_key(place);
        self.spent += plan.runs.iter().filter(|run| run.kind == AxisKind::Ladder).map(|run| run.seconds).sum::<f64>();
        plan
    }

    /// Whether a run fits `time`, which it takes then.
    fn take(&self, session: &Session<'_>, planned: &Planned, time: &mut f64, rates: Rates) -> bool {
        let cost = self.cost(session, planned, rates);
        let fits = cost <= time.min(self.largest());
        *time -= if fits { cost } else { 0.0 };
        fits
    }

    /// Takes from `finer` the level that is run next: the one of the ladder that leaves most a second, of those that are
    /// worth it. `None` where there is none, or no time for any.
    pub(super) fn next(&mut self, session: &Session<'_>, report: &Report, finer: &mut Vec<Planned>) -> Option<Planned> {
        let rates = self.rates(session);
        let time = LADDERS * self.whole() - self.used();
        let mut best: Option<(usize, f64, f64)> = None;
        for k in next_levels(finer) {
            let planned = &finer[k];
            let (left, mut time) = (report.ladder(&planned.axis).map_or(f64::INFINITY, leaves), time.max(0.0));
            if !is_worth(report, &planned.axis) || !self.take(session, planned, &mut time, rates) {
                continue;
            }
            let seconds = rates.seconds(&planned.size);
            let better = |(_, most, taken): (usize, f64, f64)| {
                (left / seconds).total_cmp(&most).then(taken.total_cmp(&seconds)).is_gt()
            };
            if best.is_none_or(better) {
                best = Some((k, left / seconds, seconds));
            }
        }
        let (k, _, seconds) = best?;
        self.spent += seconds;
        Some(Planned { seconds, ..finer.remove(k) })
    }

    /// Why none of `finer` was run: axis, level, reason.
    pub(super) fn explain(
        &self,
        session: &Session<'_>,
        report: &Report,
        finer: &[Planned],
    ) -> Vec<(String, String, String)> {
        let rates = self.rates(session);
        let why = |planned: &Planned| match is_worth(report, &planned.axis) {
            false => format!("the ladder leaves less than {:.0} % of what all leave", WORTH * 100.0),
            true => format!("{SPENT}, about {}", Dimension::TIME.of(rates.seconds(&planned.size))),
        };
        finer.iter().map(|planned| (planned.axis.clone(), planned.level.label.clone(), why(planned))).collect()
    }

    fn expect(&self, session: &Session<'_>, axis: &StudyAxis, level: &Level, rates: Rates) -> Result<Planned, String> {
        let size = if level.setting.is_empty() { self.base } else { self.size(session, level)? };
        if size.factor_entries > MOST_ENTRIES {
            return Err(format!("about {} unknowns are more than a study runs", size.unknowns));
        }
        let seconds = rates.seconds(&size);
        let (axis, kind, level) = (axis.name.clone(), axis.kind, level.clone());
        Ok(Planned { axis, kind, level, size, seconds, rungs: Vec::new() })
    }

    /// Sizes under the setting of `level`.
    fn size(&self, session: &Session<'_>, level: &Level) -> Result<Size, String> {
        let size = || -> Result<Size, Error> {
            let scene = scene::under(session.source(), &level.setting)?;
            Ok(predict::size(&Model::new(scene, session.registry())?, &self.base))
        };
        let refined = level.setting.get("mesh.refine").and_then(|n| n.parse::<i32>().ok()).unwrap_or(0);
        if self.base.cells as f64 * 4.0_f64.powi(refined) > MOST_CELLS {
            return Err("more cells than a study runs".into());
        }
        size().map_err(|why| why.to_string())
    }

    /// Why a run beside the ladders is left out, unless it is granted: where `spare`, it must be judged by a ladder that is
    /// worth it, or by none.
    pub(super) fn refuse(
        &mut self,
        session: &Session<'_>,
        report: &Report,
        planned: &Planned,
        spare: bool,
    ) -> Option<&'static str> {
        if planned.level.setting.is_empty() || session.has(&planned.level.setting) {
            return None;
        }
        let judges = judges(&planned.axis);
        if spare && !judges.is_empty() && !judges.iter().any(|axis| is_worth(report, axis)) {
            return Some("the ladders that judge it leave a small part of what all leave");
        }
        let seconds = self.rates(session).seconds(&planned.size);
        let affordable = seconds <= self.whole() - self.used();
        self.spent += if affordable { seconds } else { 0.0 };
        (!affordable).then_some(SPENT)
    }

    /// Levels of all ladders of `report` together: the cheapest for each target, and the finest that the time allows.
    pub(super) fn joint(&mut self, session: &Session<'_>, report: &Report) -> Vec<Planned> {
        let ladders = &report.ladders;
        if ladders.is_empty() {
            return Vec::new();
        }
        let rates = self.rates(session);
        // What the ladders have left over is for these.
        let mut time = ((LADDERS + JOINT) * self.whole() - self.used()).max(0.0);
        let mut all = vec![Vec::new()];
        for ladder in ladders {
            all = all
                .iter()
                .flat_map(|levels: &Vec<usize>| (0..ladder.levels.len()).map(move |k| [&levels[..], &[k]].concat()))
                .collect();
        }
        let sure = report.convergent();
        let mut choices: Vec<(f64, Planned)> = all
            .into_iter()
            .map(|rungs| {
                let each = || ladders.iter().zip(&rungs).map(|(ladder, k)| &ladder.levels[*k]);
                let size = predict::together(&self.base, each().map(|level| &level.size));
                let label = each().map(|level| level.level.label.as_str()).collect::<Vec<_>>().join(", ");
                let setting = each().flat_map(|level| level.level.setting.clone()).collect();
                let level = Level { label, setting, at_limit: false };
                let error = each().map(|level| level.worst(&sure).map_or(f64::INFINITY, |worst| worst.error)).sum();
                let mut planned =
                    Planned { axis: TOGETHER.into(), kind: AxisKind::Ladder, level, size, seconds: 0.0, rungs };
                planned.seconds = self.cost(session, &planned, rates);
                (error, planned)
            })
            .filter(|(_, planned)| planned.size.factor_entries <= MOST_ENTRIES)
            .collect();
        choices.sort_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds));
        let mut chosen: Vec<Planned> = Vec::new();
        let mut choose = |planned: &Planned, time: &mut f64| {
            if chosen.iter().all(|other| other.level != planned.level) {
                *time -= planned.seconds;
                chosen.push(planned.clone());
            }
        };
        // The finest first, because everything is measured by it, and one that is coarser along every ladder, to prove it.
        let affordable = choices.iter().filter(|c| c.1.seconds <= FINEST * time);
        // Where errors are equal, the higher rungs count: a ladder that stalls leaves the same everywhere.
        let height = |planned: &Planned| planned.rungs.iter().sum::<usize>();
        let finest = affordable.min_by(|a, b| a.0.total_cmp(&b.0).then(height(&b.1).cmp(&height(&a.1))));
        if let Some((_, finest)) = finest {
            choose(finest, &mut time);
            let below = below(&finest.rungs);
            choices.iter().filter(|c| c.1.rungs == below).for_each(|(_, second)| choose(second, &mut time));
        }
        for target in TARGETS {
            let Some((_, cheapest)) = choices.iter().find(|(error, _)| *error <= SAFETY * target) else {
                continue;
            };
            if cheapest.seconds <= time {
                choose(cheapest, &mut time);
            }
        }
        chosen.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        self.spent += chosen.iter().map(|planned| planned.seconds).sum::<f64>();
        chosen
    }
}

/// What `ladder` may leave, as far as a plan can count on it.
fn leaves(ladder: &Ladder) -> f64 {
    ladder.leaves().map_or(0.0, |limit| limit.convergence.feared())
}

/// Whether `axis` leaves a notable part of what all ladders leave, or nobody knows what it leaves.
fn is_worth(report: &Report, axis: &str) -> bool {
    let total: f64 = report.ladders.iter().map(leaves).sum();
    report.ladder(axis).is_none_or(|ladder| ladder.stalls() || leaves(ladder) >= WORTH * total)
}

/// Places of the next level of every ladder in `finer`, whose levels are in order.
fn next_levels(finer: &[Planned]) -> impl Iterator<Item = usize> {
    (0..finer.len()).filter(|k| finer[..*k].iter().all(|before| before.axis != finer[*k].axis))
}

/// A level coarser along every ladder.
pub(super) fn below(rungs: &[usize]) -> Vec<usize> {
    rungs.iter().map(|k| k.saturating_sub(1)).collect()
}
