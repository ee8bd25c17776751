//! Runs at raised settings, and the cheapest of their combinations that is good enough.

use super::TellSearch;
use super::climb::Climb;
use crate::cost::{Attained, FURTHER, RaisedPart, Worth, processor_time};
use crate::error::Error;
use crate::forecast::Size;
use crate::job::Follow;
use crate::model::Model;
use crate::registry::Registry;
use crate::study::axes::StudyAxis;
use crate::study::plan::{MOST_CELLS, MOST_ENTRIES, below};
use crate::study::predict::{self, Rates};
use crate::study::record::RunRecord;
use fem_core::plugin::Dimension;
use fem_io::scene::{self, SceneSource, Setting};
use tracing::info;

/// Nominal seconds of a search without a budget.
const LIMIT: f64 = 600.0;

/// Levels beyond the highest that was run whose cost is told.
const BEYOND: usize = 3;

pub(super) struct Search<'a> {
    source: &'a SceneSource,
    registry: &'a Registry,
    asked: f64,
    budget: Option<f64>,
    /// Processor time at its beginning, s.
    began: f64,
    climbs: Vec<Climb>,
    /// Of what accuracy is asked.
    pub(super) names: Vec<String>,
    /// Runs by the level of each part; that of the scene as it is first.
    runs: Vec<(Vec<usize>, RunRecord)>,
    /// What parts raised together change more than each alone, of every quantity.
    together: Vec<f64>,
    follow: &'a mut dyn Follow,
    /// How `follow` broke it off.
    broken_off: Option<Error>,
}

impl<'a> Search<'a> {
    /// Runs the scene as it is.
    ///
    /// # Errors
    /// Those of a run.
    pub(super) fn new(
        (source, registry): (&'a SceneSource, &'a Registry),
        ladders: Vec<StudyAxis>,
        asked: f64,
        budget: Option<f64>,
        follow: &'a mut dyn Follow,
    ) -> Result<Self, Error> {
        let began = processor_time();
        let climbs: Vec<Climb> = ladders.into_iter().filter_map(Climb::new).collect();
        let own = climbs.iter().map(|climb| climb.own).collect();
        let runs = vec![(own, RunRecord::of(source, &Setting::new(), registry, follow)?)];
        let (names, together) = (Vec::new(), Vec::new());
        Ok(Self { source, registry, asked, budget, began, climbs, names, runs, together, follow, broken_off: None })
    }

    pub(super) fn base(&self) -> &RunRecord {
        &self.runs[0].1
    }

    fn setting(&self, rungs: &[usize]) -> Setting {
        let levels = self.climbs.iter().zip(rungs).filter_map(|(climb, rung)| climb.levels.get(*rung));
        levels.flat_map(|level| level.setting.clone()).collect()
    }

    fn known(&self, rungs: &[usize]) -> Option<&RunRecord> {
        self.runs.iter().find(|run| run.0 == rungs).map(|run| &run.1)
    }

    /// The level `rung` of the part `k` alone.
    fn single(&self, k: usize, rung: usize) -> Vec<usize> {
        let mut rungs = self.runs[0].0.clone();
        rungs[k] = rung;
        rungs
    }

    /// Seconds; nominal ones without a budget, so that the same is run on every machine.
    fn seconds(&self, size: &Size) -> f64 {
        let nominal = self.budget.is_none();
        let rates = if nominal { Rates::NOMINAL } else { Rates::of(self.runs.iter().map(|run| &run.1)) };
        rates.seconds(size)
    }

    fn rest(&self) -> f64 {
        match self.budget {
            Some(budget) => budget - (processor_time() - self.began),
            None => LIMIT - self.runs.iter().map(|run| self.seconds(&run.1.size)).sum::<f64>(),
        }
    }

    /// Sizes of the levels of each part alone, up to `beyond` above those that were run; or why there are none.
    fn sizes(&self, beyond: usize) -> Vec<Vec<Result<Size, String>>> {
        let each = self.climbs.iter().enumerate();
        each.map(|(k, climb)| (0..=climb.top() + beyond).map(|rung| self.size(k, rung)).collect()).collect()
    }

    fn size(&self, k: usize, rung: usize) -> Result<Size, String> {
        let (rungs, base) = (self.single(k, rung), &self.base().size);
        if let Some(run) = self.known(&rungs) {
            return Ok(run.size);
        }
        if self.climbs[k].levels.get(rung).is_none() {
            return Err("there is no finer level".to_owned());
        }
        if self.climbs[k].name == "mesh"
            && base.cells as f64 * 4.0_f64.powi(rung as i32 - self.climbs[k].own as i32) > MOST_CELLS
        {
            return Err("more cells than a study runs".to_owned());
        }
        let scene = scene::under(self.source, &self.setting(&rungs)).map_err(Error::from);
        let model = scene.and_then(|scene| Model::new(scene, self.registry)).map_err(|why| why.to_string())?;
        Ok(predict::size(&model, base))
    }

    /// Expected seconds of a run at these levels, from the sizes of those of each part alone.
    fn price(&self, sizes: &[Vec<Result<Size, String>>], rungs: &[usize]) -> Result<f64, String> {
        let each = sizes.iter().zip(rungs).map(|(sizes, rung)| sizes[*rung].clone());
        let each: Vec<Size> = each.collect::<Result<_, _>>()?;
        let size = predict::together(&self.base().size, each.iter());
        if size.factor_entries > MOST_ENTRIES {
            return Err(format!("about {} unknowns are more than a study runs", size.unknowns));
        }
        Ok(self.seconds(&size))
    }

    /// Estimated error of a run at these levels in the quantity `q`.
    fn error_in(&self, q: usize, rungs: &[usize]) -> f64 {
        let each: f64 = self.climbs.iter().zip(rungs).map(|(climb, rung)| climb.leaves(q, *rung)).sum();
        each + self.together.get(q).copied().unwrap_or(0.0)
    }

    /// The worst quantity of a run at these levels, and its estimated error.
    fn worst(&self, rungs: &[usize]) -> (usize, f64) {
        let each = (0..self.names.len()).map(|q| (q, self.error_in(q, rungs)));
        each.reduce(|a, b| if b.1 > a.1 { b } else { a }).unwrap_or((0, 0.0))
    }

    /// All combinations of levels up to `beyond` above those that were run, with their expected seconds.
    fn combinations(&self, beyond: usize) -> Vec<(Vec<usize>, f64)> {
        let sizes = self.sizes(beyond);
        let all = self.climbs.iter().fold(vec![Vec::new()], |all: Vec<Vec<usize>>, climb| {
            let top = (climb.top() + beyond).min(climb.levels.len() - 1);
            let raised = |rungs: Vec<usize>| (climb.own..=top).map(move |rung| [&rungs[..], &[rung]].concat());
            all.into_iter().flat_map(raised).collect()
        });
        all.into_iter().filter_map(|rungs| self.price(&sizes, &rungs).ok().map(|seconds| (rungs, seconds))).collect()
    }

    /// The cheapest of some combinations whose error is at most `most`.
    fn cheapest<'c>(&self, all: &'c [(Vec<usize>, f64)], most: f64) -> Option<&'c (Vec<usize>, f64)> {
        let good = all.iter().filter(|(rungs, _)| self.worst(rungs).1 <= most);
        good.reduce(|a, b| if b.1 < a.1 { b } else { a })
    }

    /// Raises parts alone until some of their levels together are good enough; those, and otherwise the best that time allows
    /// with why they are not.
    ///
    /// # Errors
    /// A search that was broken off.
    pub(super) fn raise(&mut self, tell: TellSearch<'_>) -> Result<(Vec<usize>, Option<String>), Error> {
        let found = self.raise_to_the_end(tell);
        self.broken_off.take().map_or(Ok(found), Err)
    }

    /// The same; what is broken off comes to its end without further runs.
    fn raise_to_the_end(&mut self, tell: TellSearch<'_>) -> (Vec<usize>, Option<String>) {
        self.together = vec![0.0; self.names.len()];
        (0..self.climbs.len()).for_each(|k| self.climb(k, None, tell));
        loop {
            let all = self.combinations(0);
            if let Some((chosen, _)) = self.cheapest(&all, self.asked) {
                if self.prove(chosen, tell) && self.worst(chosen).1 > self.asked {
                    continue;
                }
                return (chosen.clone(), None);
            }
            let tops: Vec<usize> = self.climbs.iter().map(Climb::top).collect();
            let (q, error) = self.worst(&tops);
            let left = |k: usize| self.climbs[k].leaves(q, tops[k]);
            let closed = |k: &usize| self.climbs[*k].closed.is_some();
            let hopeless = (0..tops.len()).filter(closed).map(left).sum::<f64>() > self.asked;
            let open = (0..tops.len()).filter(|k| !hopeless && !closed(k));
            match open.reduce(|a, b| if left(b) > left(a) { b } else { a }) {
                Some(k) => self.climb(k, Some(error), tell),
                None => {
                    let rest = self.rest();
                    let error = |rungs: &(Vec<usize>, f64)| self.worst(&rungs.0).1;
                    let affordable = all.iter().filter(|(_, seconds)| *seconds <= rest);
                    let best = affordable.reduce(|a, b| if error(b) < error(a) { b } else { a });
                    let best = best.map_or_else(|| self.runs[0].0.clone(), |best| best.0.clone());
                    return (best, Some(self.describe_end(q)));
                }
            }
        }
    }

    /// Runs the next level of a part alone.
    fn climb(&mut self, k: usize, error: Option<f64>, tell: TellSearch<'_>) {
        let rungs = self.climbs[k].next();
        let [here, next] = rungs.map(|rung| self.single(k, rung));
        if let Err(why) = self.run(&here, error, tell).and_then(|()| self.run(&next, error, tell)) {
            self.climbs[k].closed = Some(why);
            return;
        }
        if let (Some(coarse), Some(fine)) = (self.known(&here), self.known(&next)) {
            let changes = self.names.iter().map(|name| difference(coarse, fine, name)).collect();
            info!(quantities = ?self.names, ?changes, "{} {}", self.climbs[k].name, self.climbs[k].levels[rungs[1]].label);
            self.climbs[k].take(changes);
        }
    }

    /// Runs a level below the chosen one in every part that is raised, to see what parts change together; false where that says
    /// nothing new.
    fn prove(&mut self, chosen: &[usize], tell: TellSearch<'_>) -> bool {
        let own = self.runs[0].0.clone();
        let below: Vec<usize> = below(chosen).into_iter().zip(&own).map(|(rung, own)| rung.max(*own)).collect();
        let error = self.worst(chosen).1;
        if below.iter().zip(&own).filter(|(rung, own)| rung > own).count() < 2 || self.known(&below).is_some() {
            return false;
        }
        if let Err(why) = self.run(&below, Some(error), tell) {
            info!(why, "levels together are not proven");
            return false;
        }
        let Some(joint) = self.known(&below) else { return false };
        let more = |(q, name): (usize, &String)| {
            let raised = self.climbs.iter().zip(own.iter().zip(&below));
            let alone: f64 = raised.map(|(climb, (own, rung))| climb.change(q, *own, *rung)).sum();
            (difference(self.base(), joint, name) - alone).max(self.together[q])
        };
        self.together = self.names.iter().enumerate().map(more).collect();
        true
    }

    /// Runs the scene at these levels; otherwise, why it cannot.
    fn run(&mut self, rungs: &[usize], error: Option<f64>, tell: TellSearch<'_>) -> Result<(), String> {
        if self.known(rungs).is_some() {
            return Ok(());
        }
        if let Some(broken_off) = &self.broken_off {
            return Err(broken_off.to_string());
        }
        let sizes = self.sizes(1);
        let (seconds, rest) = (self.price(&sizes, rungs)?, self.rest().max(0.0));
        // What has been found is still to be run together.
        let tops: Vec<usize> = self.climbs.iter().map(Climb::top).collect();
        let whole = self.price(&sizes, &tops).unwrap_or(0.0);
        if seconds + whole > rest {
            return Err(format!(
                "the next level takes about {}, and a run of all {}; {} are left",
                Dimension::TIME.of(seconds),
                Dimension::TIME.of(whole),
                Dimension::TIME.of(rest)
            ));
        }
        let levels = self.climbs.iter().zip(rungs).filter(|(climb, rung)| **rung != climb.own);
        let what = levels.map(|(climb, rung)| format!("{} {}", climb.name, climb.levels[*rung].label));
        tell(&what.collect::<Vec<_>>().join(", "), error.filter(|error| error.is_finite()));
        match RunRecord::of(self.source, &self.setting(rungs), self.registry, &mut *self.follow) {
            Ok(record) => {
                self.runs.push((rungs.to_vec(), record));
                Ok(())
            }
            Err(why) => {
                let told = why.to_string();
                self.broken_off = Some(why).filter(|why| matches!(why, Error::Cancelled { .. }));
                Err(told)
            }
        }
    }

    /// Why nothing can be raised that `q` needs.
    fn describe_end(&self, q: usize) -> String {
        let left = |climb: &&Climb| climb.leaves(q, climb.top()) > 0.1 * self.asked;
        let closed = |climb: &Climb| {
            let label = climb.levels.get(climb.top()).map_or("", |level| &level.label);
            let stalls =
                if climb.stalls(q) { format!("{} hardly converges by it; ", self.names[q]) } else { String::new() };
            Some(format!("{} beyond {label}: {stalls}{}", climb.name, climb.closed.as_ref()?))
        };
        let each: Vec<String> = self.climbs.iter().filter(left).filter_map(closed).collect();
        each.join("; ")
    }

    pub(super) fn attained(self, chosen: &[usize], stopped: Option<String>) -> Attained {
        let finite = |error: f64| error.is_finite().then_some(error);
        let (worst, error) = self.worst(chosen);
        let part = |(climb, rung): (&Climb, &usize)| RaisedPart {
            axis: climb.name.clone(),
            level: climb.levels.get(*rung).map_or_else(String::new, |level| level.label.clone()),
            leaves: finite(climb.leaves(worst, *rung)),
        };
        let quantity =
            |(q, name): (usize, &String)| Worth { name: name.clone(), error: finite(self.error_in(q, chosen)) };
        let further = self.combinations(BEYOND);
        let further = self.cheapest(&further, FURTHER * self.asked);
        Attained {
            asked: self.asked,
            reached: finite(error),
            quantities: self.names.iter().enumerate().map(quantity).collect(),
            parts: self.climbs.iter().zip(chosen).map(part).collect(),
            runs: self.runs.len(),
            cpu_s: processor_time() - self.began,
            expected_cpu_s: self.price(&self.sizes(0), chosen).ok(),
            not_judged: None,
            stopped,
            further_cpu_s: further.map(|(_, seconds)| *seconds),
            setting: self.setting(chosen),
        }
    }
}

/// Relative difference of two runs in the quantity `name`; infinite where one of them lacks it.
fn difference(coarse: &RunRecord, fine: &RunRecord, name: &str) -> f64 {
    coarse.difference(fine, name).map_or(f64::INFINITY, f64::abs)
}
