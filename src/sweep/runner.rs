//! Cases are marched, on plates that those with the same one share.

use super::Sweep;
use super::alike::Marched;
use super::design::Design;
use super::figures::CaseFigures;
use super::page;
use crate::advise;
use crate::analyses::impact::{self, March, Outcome, Prepared, SharedPlate, Sizes};
use crate::error::Error;
use crate::model::{Model, leaves_march, leaves_plate};
use crate::registry::Registry;
use cpu_time::ThreadTime;
use fem_io::scene::{Scene, under};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};

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

/// Rows that come within this time are handed on together.
const TOGETHER: Duration = Duration::from_millis(2);

/// A plate with the model that it was made of; none where impacts cannot share it.
#[derive(Debug)]
pub(super) struct Base {
    pub(super) model: Model,
    pub(super) plate: Option<Arc<SharedPlate>>,
}

/// Cases of one plate: made by the first, given back by the last.
#[derive(Default)]
struct Group {
    base: Mutex<Option<Base>>,
    left: AtomicUsize,
}

/// Cases of one march on such a plate, which the first makes as well.
#[derive(Default)]
struct Alike {
    marched: Mutex<Option<Arc<Marched>>>,
    left: AtomicUsize,
}

/// A case, and what it shares with others.
#[derive(Clone, Copy)]
struct Shared<'a> {
    group: &'a Group,
    alike: &'a Alike,
    case: usize,
    /// By how many threads a plate is made: the others wait for it.
    threads: NonZeroUsize,
}

/// Numbers of those that have the same values, in the order in which they are first met.
#[derive(Default)]
struct Numbers(BTreeMap<Vec<String>, usize>);

impl Numbers {
    fn of(&mut self, values: Vec<String>) -> usize {
        let next = self.0.len();
        *self.0.entry(values).or_insert(next)
    }
}

/// The cases `wanted`, counted from 0, each after the numbers of its plate and of its march: those of a plate one after the other, and
/// those of a march, so that little is held at a time.
pub(super) fn in_order(design: &Design, wanted: &[usize]) -> Vec<(usize, usize, usize)> {
    let (mut of_plate, mut of_march) = (Numbers::default(), Numbers::default());
    let numbered = wanted.iter().map(|&case| {
        let values = design.case(case);
        let but = |leaves: fn(&str) -> bool| {
            let changed = values.iter().zip(&design.axes).filter(|(_, axis)| !leaves(&axis.key));
            changed.map(|(value, _)| value.clone()).collect::<Vec<_>>()
        };
        (of_plate.of(but(leaves_plate)), of_march.of(but(leaves_march)), case)
    });
    let mut cases: Vec<_> = numbered.collect();
    cases.sort_unstable();
    cases
}

/// Runs the cases `wanted`, counted from 0, on so many `threads`; `heard` takes each row as it comes, and may break off: cases that
/// are under way are then given up.
pub(super) fn run(
    sweep: &Sweep<'_>,
    wanted: &[usize],
    threads: NonZeroUsize,
    heard: &mut dyn FnMut(Option<CaseRow>) -> ControlFlow<()>,
) {
    let cases = in_order(&sweep.design, wanted);
    let plates = cases.iter().map(|(plate, ..)| plate + 1).max().unwrap_or(0);
    let marches = cases.iter().map(|(_, march, _)| march + 1).max().unwrap_or(0);
    let mut groups: Vec<Group> = (0..plates).map(|_| Group::default()).collect();
    let mut alike: Vec<Alike> = (0..marches).map(|_| Alike::default()).collect();
    for &(group, march, _) in &cases {
        *groups[group].left.get_mut() += 1;
        *alike[march].left.get_mut() += 1;
    }
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads.get().min(cases.len()) {
            let (send, groups, alike, cases, next, stop) = (send.clone(), &groups, &alike, &cases, &next, &stop);
            scope.spawn(move || {
                let (mut rows, mut sent) = (Vec::new(), Instant::now());
                while let Some(&(group, march, case)) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let shared = Shared { group: &groups[group], alike: &alike[march], case, threads };
                    let Some(row) = row(sweep, shared, stop) else { break };
                    rows.push(row);
                    // To wake who listens takes as long as to judge a case of other strengths.
                    if sent.elapsed() > TOGETHER {
                        sent = Instant::now();
                        if send.send(std::mem::take(&mut rows)).is_err() {
                            return;
                        }
                    }
                }
                // Who listens may be gone.
                let _ = send.send(rows);
            });
        }
        drop(send);
        loop {
            let rows = match receive.recv_timeout(super::PATIENCE) {
                Ok(rows) => rows,
                Err(mpsc::RecvTimeoutError::Timeout) => Vec::new(),
                Err(mpsc::RecvTimeoutError::Disconnected) => break,
            };
            // A listener without a row may still break off.
            let quiet = rows.is_empty().then_some(None);
            for row in rows.into_iter().map(Some).chain(quiet) {
                if heard(row).is_break() {
                    stop.store(true, Ordering::Relaxed);
                }
            }
        }
    });
}

/// Runs a case; `None` where it is to `stop`.
fn row(sweep: &Sweep<'_>, shared: Shared<'_>, stop: &AtomicBool) -> Option<CaseRow> {
    let begun = ThreadTime::now();
    let Shared { group, alike, case, .. } = shared;
    let mut result = compute(sweep, shared, stop);
    if alike.left.fetch_sub(1, Ordering::Relaxed) == 1 {
        *alike.marched.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
    if group.left.fetch_sub(1, Ordering::Relaxed) == 1 {
        *group.base.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
    if stop.load(Ordering::Relaxed) {
        return None;
    }
    if let Ok(figures) = &mut result
        && sweep.design.count > page::MOST
    {
        figures.history = Vec::new();
    }
    let seconds = begun.elapsed().as_secs_f64();
    Some(CaseRow { case: case + 1, result: result.map_err(|why| describe(&why)), seconds })
}

fn compute(sweep: &Sweep<'_>, shared: Shared<'_>, stop: &AtomicBool) -> Result<CaseFigures, Error> {
    let mut marched = shared.alike.marched.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = marched.clone() {
        drop(marched);
        // One that is refused is marched, which says why as `fem run` does.
        let judged = known.judged(&sweep.design.axes, &sweep.design.case(shared.case));
        if let Ok(Some(figures)) = judged {
            return Ok(figures);
        }
        marched = shared.alike.marched.lock().unwrap_or_else(PoisonError::into_inner);
    }
    let scene = under(&sweep.source, &sweep.setting(shared.case))?;
    let Some((model, plate)) = on_shared_plate(sweep, shared, &scene)? else {
        drop(marched);
        let model = advise::decided(plain(&scene, sweep.registry)?, NonZeroUsize::MIN)?;
        let prepared = || Ok(impact::prepare(&model, NonZeroUsize::MIN)?.without_estimates());
        let (sizes, mut outcome) = march(prepared, stop)?;
        return Ok(CaseFigures::of(&model, &sizes, &mut outcome));
    };
    let model = advise::decided(model, NonZeroUsize::MIN)?;
    if marched.is_some() || shared.alike.left.load(Ordering::Relaxed) == 1 {
        drop(marched);
        let (sizes, mut outcome) = march(|| plate.struck(&model), stop)?;
        return Ok(CaseFigures::of(&model, &sizes, &mut outcome));
    }
    let (sizes, outcome) = march(|| plate.struck(&model), stop)?;
    let first = Arc::new(Marched::new(model, &sizes, outcome));
    *marched = Some(Arc::clone(&first));
    Ok(first.figures().clone())
}

/// The model of `scene` on the plate that the cases of `group` share, made by the first of them; `None` where there is but one, or
/// where the plate cannot be shared.
fn on_shared_plate(
    sweep: &Sweep<'_>,
    Shared { group, threads, .. }: Shared<'_>,
    scene: &Scene,
) -> Result<Option<(Model, Arc<SharedPlate>)>, Error> {
    let mut base = group.base.lock().unwrap_or_else(PoisonError::into_inner);
    if base.is_none() && group.left.load(Ordering::Relaxed) > 1 {
        let model = plain(scene, sweep.registry)?;
        let plate = SharedPlate::new(&model, threads)?.map(Arc::new);
        *base = Some(Base { model, plate });
    }
    let Some(Base { model, plate: Some(plate) }) = &*base else { return Ok(None) };
    Ok(model.struck_anew(scene, sweep.registry)?.map(|model| (model, Arc::clone(plate))))
}

/// The model of a case, which writes no pictures.
pub(super) fn plain(scene: &Scene, registry: &Registry) -> Result<Model, Error> {
    let mut model = Model::new(scene, registry)?;
    (model.output.plots, model.output.maps, model.output.fields) = (false, false, None);
    Ok(model)
}

/// Marches what is `prepared` to its end.
pub(super) fn march<'a>(
    prepared: impl Fn() -> Result<Prepared<'a>, Error>,
    stop: &AtomicBool,
) -> Result<(Sizes, Outcome), Error> {
    let run = |prepared: Prepared<'a>| {
        let sizes = prepared.sizes;
        let mut march = March::start(prepared)?;
        while !march.done() && !stop.load(Ordering::Relaxed) {
            march.advance();
        }
        Ok::<_, Error>((sizes, march.finish()))
    };
    let mut marched = run(prepared()?.firsts_alone())?;
    if marched.1.stopped.is_some() {
        // The first that is refused anywhere says why, as in `fem run`.
        marched = run(prepared()?)?;
    }
    match marched.1.stopped.clone() {
        Some(why) => Err(Error::Stopped(why)),
        None => Ok(marched),
    }
}

/// An error with its causes and what helps, on one line.
pub(super) fn describe(error: &Error) -> String {
    let causes = std::iter::successors(std::error::Error::source(error), |cause| cause.source());
    let mut text = causes.fold(error.to_string(), |text, cause| format!("{text}: {cause}"));
    if let Some(help) = miette::Diagnostic::help(error) {
        text = format!("{text}; {help}");
    }
    text.replace('\n', " ")
}
