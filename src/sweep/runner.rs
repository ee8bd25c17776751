//! Cases are marched, on plates that those with the same one share.

use super::Sweep;
use super::figures::CaseFigures;
use crate::advise;
use crate::analyses::impact::{self, March, Prepared, SharedPlate};
use crate::error::Error;
use crate::model::{Model, leaves_plate};
use cpu_time::ThreadTime;
use fem_io::scene::{Scene, parse_under};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

/// A case that was run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseRow {
    /// Its number, counted from 1.
    pub case: usize,
    /// What it found, or why it failed.
    pub result: Result<CaseFigures, String>,
    /// Processor time, s.
    pub seconds: f64,
}

/// A plate with the model that it was made of.
struct Base {
    model: Model,
    plate: Option<Arc<SharedPlate>>,
}

/// Cases of one plate: made by the first, given back by the last.
#[derive(Default)]
struct Group {
    base: Mutex<Option<Base>>,
    left: AtomicUsize,
}

/// Runs the cases `wanted`, counted from 0, on so many `threads`; `heard` takes each row as it comes, and may break off: cases that
/// are under way are then given up.
pub(super) fn run(
    sweep: &Sweep<'_>,
    wanted: &[usize],
    threads: NonZeroUsize,
    heard: &mut dyn FnMut(Option<CaseRow>) -> ControlFlow<()>,
) {
    let mut groups: Vec<Group> = Vec::new();
    let mut of_plate: BTreeMap<Vec<String>, usize> = BTreeMap::new();
    let mut cases: Vec<(usize, usize)> = Vec::new();
    for &case in wanted {
        let values = sweep.design.case(case).into_iter().zip(&sweep.design.axes);
        let plate = values.filter(|(_, axis)| !leaves_plate(&axis.key)).map(|(value, _)| value).collect();
        let group = *of_plate.entry(plate).or_insert_with(|| {
            groups.push(Group::default());
            groups.len() - 1
        });
        *groups[group].left.get_mut() += 1;
        cases.push((group, case));
    }
    // Those of a plate one after the other, so that few plates are held at a time.
    cases.sort_unstable();
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads.get().min(cases.len()) {
            let (send, groups, cases, next, stop) = (send.clone(), &groups, &cases, &next, &stop);
            scope.spawn(move || {
                while let Some(&(group, case)) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let Some(row) = row(sweep, &groups[group], case, stop) else { break };
                    if send.send(row).is_err() {
                        break;
                    }
                }
            });
        }
        drop(send);
        loop {
            let row = match receive.recv_timeout(super::PATIENCE) {
                Ok(row) => Some(row),
                Err(mpsc::RecvTimeoutError::Timeout) => None,
                Err(mpsc::RecvTimeoutError::Disconnected) => break,
            };
            if heard(row).is_break() {
                stop.store(true, Ordering::Relaxed);
            }
        }
    });
}

/// Runs a case; `None` where it is to `stop`.
fn row(sweep: &Sweep<'_>, group: &Group, case: usize, stop: &AtomicBool) -> Option<CaseRow> {
    let begun = ThreadTime::now();
    let result = compute(sweep, group, case, stop);
    if group.left.fetch_sub(1, Ordering::Relaxed) == 1 {
        *group.base.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
    if stop.load(Ordering::Relaxed) {
        return None;
    }
    let seconds = begun.elapsed().as_secs_f64();
    Some(CaseRow { case: case + 1, result: result.map_err(|why| describe(&why)), seconds })
}

fn compute(sweep: &Sweep<'_>, group: &Group, case: usize, stop: &AtomicBool) -> Result<CaseFigures, Error> {
    let scene = parse_under(sweep.source.text(), Path::new(sweep.source.name()), &sweep.setting(case))?;
    if let Some((model, plate)) = on_shared_plate(sweep, group, &scene)? {
        let model = advise::decided(model, NonZeroUsize::MIN)?;
        return march(&model, || plate.struck(&model), stop);
    }
    let model = advise::decided(plain(&scene, sweep)?, NonZeroUsize::MIN)?;
    march(&model, || Ok(impact::prepare(&model, NonZeroUsize::MIN)?.without_estimates()), stop)
}

/// The model of `scene` on the plate that the cases of `group` share, made by the first of them; `None` where there is but one, or
/// where the plate cannot be shared.
fn on_shared_plate(
    sweep: &Sweep<'_>,
    group: &Group,
    scene: &Scene,
) -> Result<Option<(Model, Arc<SharedPlate>)>, Error> {
    let mut base = group.base.lock().unwrap_or_else(PoisonError::into_inner);
    if base.is_none() && group.left.load(Ordering::Relaxed) > 1 {
        let model = plain(scene, sweep)?;
        let plate = SharedPlate::new(&model, NonZeroUsize::MIN)?.map(Arc::new);
        *base = Some(Base { model, plate });
    }
    let Some(Base { model, plate: Some(plate) }) = &*base else { return Ok(None) };
    Ok(model.struck_anew(scene, sweep.registry)?.map(|model| (model, Arc::clone(plate))))
}

/// The model of a case, which writes no pictures.
fn plain(scene: &Scene, sweep: &Sweep<'_>) -> Result<Model, Error> {
    let mut model = Model::new(scene, sweep.registry)?;
    (model.output.plots, model.output.maps, model.output.fields) = (false, false, None);
    Ok(model)
}

fn march<'a>(
    model: &'a Model,
    prepared: impl Fn() -> Result<Prepared<'a>, Error>,
    stop: &AtomicBool,
) -> Result<CaseFigures, Error> {
    let run = |prepared: Prepared<'a>| {
        let sizes = prepared.sizes;
        let mut march = March::start(prepared)?;
        while !march.done() && !stop.load(Ordering::Relaxed) {
            march.advance();
        }
        Ok::<_, Error>((sizes, march.finish()))
    };
    let (mut sizes, mut outcome) = run(prepared()?.firsts_alone())?;
    if outcome.stopped.is_some() {
        // The first that is refused anywhere says why, as in `fem run`.
        (sizes, outcome) = run(prepared()?)?;
    }
    match outcome.stopped.clone() {
        Some(why) => Err(Error::Stopped(why)),
        None => Ok(CaseFigures::of(model, &sizes, outcome)),
    }
}

/// An error with its causes and what helps, on one line.
fn describe(error: &Error) -> String {
    let causes = std::iter::successors(std::error::Error::source(error), |cause| cause.source());
    let mut text = causes.fold(error.to_string(), |text, cause| format!("{text}: {cause}"));
    if let Some(help) = miette::Diagnostic::help(error) {
        text = format!("{text}; {help}");
    }
    text.replace('\n', " ")
}
