//! Cases of a scene that are asked for one after the other.

use super::PATIENCE;
use super::figures::CaseFigures;
use super::runner::{Base, describe, march, plain};
use crate::advise;
use crate::analyses::impact::{self, SharedPlate};
use crate::error::Error;
use crate::model::Model;
use crate::registry::Registry;
use fem_io::scene::{Scene, SceneSource, Setting, under};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

/// Runs cases of a scene as a sweep does, each when it is asked for; it keeps the plate of the last one for those that have the same.
#[derive(Debug)]
pub struct Marcher<'a> {
    registry: &'a Registry,
    source: Arc<SceneSource>,
    base: Mutex<Option<Base>>,
}

impl<'a> Marcher<'a> {
    /// Of the cases of `scene`.
    pub fn new(scene: &Scene, registry: &'a Registry) -> Self {
        Self { registry, source: Arc::clone(&scene.source), base: Mutex::default() }
    }

    /// What the scene finds with each of the `settings` over it, to the bit what [`run`](crate::job::run) finds, or why it fails;
    /// `None` where `follow`, which hears how many are done, broke off.
    pub fn all(
        &self,
        settings: &[Setting],
        threads: NonZeroUsize,
        follow: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Option<Vec<Result<CaseFigures, String>>> {
        let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
        let mut found: Vec<Option<Result<CaseFigures, String>>> = settings.iter().map(|_| None).collect();
        let (send, receive) = mpsc::channel();
        std::thread::scope(|scope| {
            for _ in 0..threads.get().min(settings.len()) {
                let (send, next, stop) = (send.clone(), &next, &stop);
                scope.spawn(move || {
                    let mine = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)));
                    for (k, setting) in mine.map_while(|k| Some((k, settings.get(k)?))) {
                        let result = self.compute(setting, stop).map_err(|why| describe(&why));
                        if stop.load(Ordering::Relaxed) || send.send((k, result)).is_err() {
                            break;
                        }
                    }
                });
            }
            drop(send);
            loop {
                match receive.recv_timeout(PATIENCE) {
                    Ok((k, result)) => found[k] = Some(result),
                    Err(mpsc::RecvTimeoutError::Timeout) => {}
                    Err(mpsc::RecvTimeoutError::Disconnected) => break,
                }
                if follow(found.iter().flatten().count()).is_break() {
                    stop.store(true, Ordering::Relaxed);
                }
            }
        });
        found.into_iter().collect()
    }

    fn compute(&self, setting: &Setting, stop: &AtomicBool) -> Result<CaseFigures, Error> {
        let scene = under(&self.source, setting)?;
        let on_plate = self.on_plate(&scene)?;
        let Some((model, plate)) = on_plate else {
            let model = advise::decided(plain(&scene, self.registry)?, NonZeroUsize::MIN)?;
            let prepared = || Ok(impact::prepare(&model, NonZeroUsize::MIN)?.without_estimates());
            let (sizes, mut outcome) = march(prepared, stop)?;
            return Ok(CaseFigures::of(&model, &sizes, &mut outcome));
        };
        let model = advise::decided(model, NonZeroUsize::MIN)?;
        let (sizes, mut outcome) = march(|| plate.struck(&model), stop)?;
        Ok(CaseFigures::of(&model, &sizes, &mut outcome))
    }

    /// The model of `scene` on the plate that is kept, or on one that is kept from now on; `None` where it cannot be shared.
    fn on_plate(&self, scene: &Scene) -> Result<Option<(Model, Arc<SharedPlate>)>, Error> {
        let mut base = self.base.lock().unwrap_or_else(PoisonError::into_inner);
        for fresh in [false, true] {
            if fresh || base.is_none() {
                let model = plain(scene, self.registry)?;
                let plate = SharedPlate::new(&model, NonZeroUsize::MIN)?.map(Arc::new);
                *base = Some(Base { model, plate });
            }
            let Some(Base { model, plate: Some(plate) }) = &*base else { return Ok(None) };
            if let Some(model) = model.struck_anew(scene, self.registry)? {
                return Ok(Some((model, Arc::clone(plate))));
            }
        }
        Ok(None)
    }
}
