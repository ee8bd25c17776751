//! What accuracy costs in time: a scene run under many settings, against a reference that the study proves.
//!
//! 1. The scene runs as it is.
//! 2. Every [`StudyAxis`] varies one part of the settings. A ladder of finer and finer levels shows its order of convergence,
//!    what error each level leaves, and how well that is known ([`Convergence`], [`ErrorBar`]). After its first levels, the
//!    ladder is climbed that leaves most a second.
//! 3. Levels of all ladders together, the cheapest whose errors add up to a tenth, a hundredth, ..., run jointly. The finest
//!    of them that the limit allows is the reference: it is proven where the run a level coarser on
//!    every ladder agrees to the tolerance.
//! 4. Errors of all runs count from the reference, extrapolated along every ladder that converges (Richardson).
//!
//! What is run is decided by nominal seconds, which follow from sizes alone, so that studies of one scene are equal but for
//! their seconds; a budget is kept by the seconds of the machine.

mod attain;
mod axes;
mod converge;
mod document;
mod force;
mod ladder;
mod picture;
mod plan;
mod predict;
mod quantity;
mod record;
mod report;
mod session;
mod table;
mod text;
mod ways;

pub use attain::{TellSearch, attain, raised};
pub use axes::{AxisKind, Level, NAMES, StudyAxis, axes};
pub use converge::{Convergence, ErrorBar, limit};
pub use document::{Document, write_results};
pub use ladder::{Ladder, Limit};
pub use plan::{Planned, StudyPlan};
pub use quantity::{FORCE_HISTORY, Figure};
pub use record::RunRecord;
pub use report::{Report, Row};
pub use session::Session;
pub use text::text;

use crate::error::Error;
use crate::job::Follow;
use crate::model::Model;
use axes::{STEP, seconds};
use fem_io::scene::{Scene, Setting};
use force::Force;
use plan::Planner;

/// Relative error to which a reference must have converged unless the scene says otherwise.
const TOLERANCE: f64 = 1e-2;

/// Share of the tolerance below which differences are of no interest.
const MATTERS: f64 = 0.03;

/// Share of its limit at which an integrator is tried.
const AT_LIMIT: f64 = 0.99;

/// Why there is nothing of which an error would be a part.
const NOTHING: &str = "all that accuracy could be asked of is 0: an impactor that does not reach the plate before `march.end`, or \
     loads that do nothing";

/// A step that no limit forbids, s.
const TINY: f64 = 1e-11;

/// What a study tells while it runs.
#[derive(Debug)]
pub enum Progress<'a> {
    /// What will be run.
    Planned(&'a StudyPlan),
    /// The levels of all ladders together that will be run.
    Together(&'a [Planned]),
    /// What runs now, and how much of the plan is done.
    Runs {
        /// In words.
        what: String,
        /// Share of the plan's time.
        share: f64,
    },
}

/// Whom a study tells of its progress.
pub type Tell<'a> = &'a mut dyn FnMut(Progress<'_>);

/// Studies `scene`, that of `session`, whose model is `model`, along `axes`, in `budget` seconds of processor time if given.
/// `follow` is heard before every run and at every step of its march.
///
/// # Errors
/// A quantity that the scene does not have, a scene that does not run as it is, a folder that cannot be
/// written; [`Error::Cancelled`] where `follow` broke the study off, whose runs so far are kept. A level that does not run is a row
/// of the report.
pub fn study(
    session: &mut Session<'_>,
    scene: &Scene,
    model: &Model,
    axes: &[StudyAxis],
    budget: Option<f64>,
    tell: Tell<'_>,
    follow: &mut dyn Follow,
) -> Result<Report, Error> {
    tell(Progress::Runs { what: "the scene as it is".into(), share: 0.0 });
    let base = session.run(&Setting::new(), follow)?;
    let base = base.map_err(|why| Error::Study(format!("the scene itself does not run: {why}")))?;
    let asked = quantity::choose_quantities(scene, &base.figures, base.force.as_ref().is_some_and(Force::acts))?;
    if asked.is_empty() {
        return Err(Error::Study(NOTHING.to_owned()));
    }
    let tolerance = scene.study.tolerance.unwrap_or(TOLERANCE);

    let mut planner = Planner::new(session, &base, budget);
    let mut plan = planner.plan(session, axes);
    tell(Progress::Planned(&plan));
    let whole = plan.seconds();
    let mut report = Report::new(scene, model, base, asked, tolerance);
    report.left_out.extend(plan.left_out.iter().cloned());

    let mut done = 0.0;
    let mut run =
        |session: &mut Session<'_>, report: &mut Report, tell: Tell<'_>, planned: &Planned| -> Result<(), Error> {
            tell(Progress::Runs { what: format!("{} {}", planned.axis, planned.level.label), share: done / whole });
            done += planned.seconds;
            let setting = match planned.level.at_limit {
                true => at_limit(session, &planned.level.setting),
                false => Ok(planned.level.setting.clone()),
            };
            let result = match setting {
                Ok(setting) => session.run(&setting, follow)?,
                Err(why) => Err(why.to_string()),
            };
            report.add(planned, result);
            Ok(())
        };
    let mut finer = std::mem::take(&mut plan.finer);
    for planned in plan.runs.iter().filter(|planned| planned.kind == AxisKind::Ladder) {
        run(session, &mut report, tell, planned)?;
    }
    report.climb(axes, MATTERS * tolerance);
    while let Some(planned) = planner.next(session, &report, &mut finer) {
        run(session, &mut report, tell, &planned)?;
        report.climb(axes, MATTERS * tolerance);
    }
    report.left_out.extend(planner.explain(session, &report, &finer));
    report.end_ladders(axes);
    let together = planner.joint(session, &report);
    tell(Progress::Together(&together));
    for planned in &together {
        run(session, &mut report, tell, planned)?;
    }
    let beside = plan.runs.iter().filter(|planned| planned.kind != AxisKind::Ladder);
    let beside = beside.map(|planned| (planned, false)).chain(plan.spare.iter().map(|planned| (planned, true)));
    for (planned, spare) in beside {
        match planner.refuse(session, &report, planned, spare) {
            None => run(session, &mut report, tell, planned)?,
            Some(why) => report.left_out.push((planned.axis.clone(), planned.level.label.clone(), why.into())),
        }
    }
    report.compare(axes);
    Ok(report)
}

/// The keys of `setting` with the longest stable step.
fn at_limit(session: &Session<'_>, setting: &Setting) -> Result<Setting, Error> {
    let with = |step: f64| {
        let mut setting = setting.clone();
        setting.insert(STEP.to_owned(), seconds(step));
        setting
    };
    let longest = record::longest_step(session.source(), &with(TINY), session.registry())?;
    Ok(with(AT_LIMIT * longest))
}
