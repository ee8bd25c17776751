//! The range of impacts that a plate bears: where, over two numbers of a scene, damage begins, by which mode.
//!
//! The lines are found from few impacts, each on a point of which it is known least where it lies.

mod interpolant;
mod lines;
mod picture;
mod plane;
mod record;
mod search;

pub use picture::write_map_picture;
pub use plane::MapAxis;
pub use record::{MapLine, MapRecord, write_map, write_map_page};

use crate::analyses::saved::{self, Keys};
use crate::error::Error;
use crate::job::folder;
use crate::model::Model;
use crate::registry::Registry;
use crate::sweep::{CaseFigures, Marcher, Variation};
use fem_io::files::OutputDir;
use fem_io::scene::{Scene, Setting, Written, under};
use interpolant::Interpolant;
use search::{Lines, Search};
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;

/// Name of the file from which a map goes on.
const FILE: &str = "map.bin";
/// Logarithms of indices beyond which it does not matter how far a point is from a line.
const FAR: f64 = 9.0;
/// What mass and velocity become where nothing is said: between these times what the scene has.
const AROUND: [f64; 2] = [0.25, 4.0];
/// What the force over its threshold of delamination is called.
const DELAMINATION: &str = "delamination threshold";

/// What is asked of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapRequest {
    /// Keys with what they become: one value, a range without a count for one or two, a list for one.
    pub set: Vec<(String, String)>,
    /// Error of the lines: relative on axes that count in ratios, a share of the others.
    pub tolerance: f64,
    /// Most impacts, for each value of a list.
    pub most: usize,
}

/// What a map is over, of a scene.
#[derive(Debug)]
pub struct BorderMap<'a> {
    /// One number, or two.
    pub axes: Vec<MapAxis>,
    /// A key with its values, for each of which there is a map of its own.
    pub list: Option<(String, Vec<String>)>,
    asked: MapRequest,
    fixed: Vec<(String, String)>,
    scene: &'a Scene,
    registry: &'a Registry,
    written: Written,
    identity: Keys,
}

/// An impact of a map.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct MapPoint {
    /// Number of the value of the list, 0 without one.
    pub strip: usize,
    /// Its values of the axes.
    pub values: Vec<f64>,
    /// What it found, or why it failed.
    pub result: Result<CaseFigures, String>,
}

impl MapPoint {
    fn is_at(&self, other: &Self) -> bool {
        (self.strip, &self.values) == (other.strip, &other.values)
    }
}

/// What a map found.
#[derive(Debug, Default)]
pub struct MapFound {
    /// All impacts.
    pub points: Vec<MapPoint>,
    /// Names of the lines: modes of criteria, and the threshold of delamination where there is one.
    pub names: Vec<String>,
    /// Lines for each value of the list.
    strips: Vec<Lines>,
}

impl<'a> BorderMap<'a> {
    /// A map of `scene`, by default of mass by velocity.
    ///
    /// # Errors
    /// What makes no sense, a key that the scene does not take, a scene without an impact or without a criterion.
    pub fn new(scene: &'a Scene, registry: &'a Registry, asked: &MapRequest) -> Result<Self, Error> {
        let Some(impactor) = scene.impact().and_then(|impact| impact.impactors.first()) else {
            return Err(Error::NoImpact);
        };
        if !(asked.tolerance > 0.0 && asked.tolerance < 1.0) {
            return Err(refuse("a tolerance lies between 0 and 100 %".into()));
        }
        let written = Written::in_scene(scene);
        if let Some(hidden) = written.hidden(asked.set.iter().map(|(key, _)| key.as_str())) {
            return Err(refuse(format!("`{hidden}` sets nothing: other keys set all of its places")));
        }
        let mut axes = Vec::new();
        let (mut list, mut fixed) = (None, Vec::new());
        for (key, words) in &asked.set {
            let variation =
                Variation::parse(words, written.text(key)).map_err(|why| refuse(format!("`{key}`: {why}")))?;
            match (MapAxis::of(key, &variation), variation) {
                (Some(axis), _) => axes.push(axis),
                (None, Variation::Levels(levels)) if levels.len() == 1 => fixed.push((key.clone(), levels[0].clone())),
                (None, Variation::Levels(levels)) if list.is_none() => list = Some((key.clone(), levels)),
                (None, Variation::Levels(_)) => return Err(refuse(format!("`{key}` is a second list"))),
                _ => return Err(refuse(format!("`{key}`: a map finds its own values; write a range as in 1..5"))),
            }
        }
        if axes.is_empty() && list.is_none() {
            let around = |key: &str, value: f64, unit: &str| MapAxis {
                key: key.to_owned(),
                unit: Some(unit.to_owned()),
                ends: AROUND.map(|factor| format!("{:.3e}", factor * value).parse().unwrap_or(value)),
                logarithmic: true,
            };
            axes.push(around("impactor.mass", impactor.mass, "kg"));
            axes.push(around("impactor.velocity", impactor.velocity, "m/s"));
        }
        match axes.len() {
            1 if list.is_some() => {}
            2 if list.is_none() => {}
            n => {
                let keys = if n == 1 { "one key has a range".to_owned() } else { format!("{n} keys have a range") };
                let list = if list.is_some() { " beside the list" } else { "" };
                return Err(refuse(format!("a map wants two ranges, or one beside a list, and {keys}{list}")));
            }
        }
        let set = fixed.iter().map(|(key, value)| (key.clone(), written.toml(key, value))).collect();
        let judged = Model::new(under(&scene.source, &set)?, registry)?;
        if judged.criteria.is_empty() && judged.threshold.is_none() {
            let message = "a map needs a criterion, and the scene has none".to_owned();
            let help = "name one in `failure.criteria`, and leave `effects.damage` on";
            return Err(Error::Sweep { message, help: help.into() });
        }
        let mut identity = saved::identity(&Model::new(scene, registry)?)?;
        // Points are looked for as the tolerance wants them, but each is the same whoever wants it.
        identity.extend(axes.iter().map(|axis| (format!("map over {}", axis.key), axis.to_string())));
        identity.extend(list.iter().map(|(key, values)| (format!("map for {key}"), values.join(", "))));
        identity.extend(fixed.iter().map(|(key, value)| (format!("map of {key}"), value.clone())));
        let map = Self { axes, list, asked: asked.clone(), fixed, scene, registry, written, identity };
        map.check()?;
        Ok(map)
    }

    /// Reads the scene at both ends of all axes.
    fn check(&self) -> Result<(), Error> {
        let strips = self.list.as_ref().map_or(1, |(_, values)| values.len());
        for (strip, share) in (0..strips).flat_map(|strip| [(strip, 0.0), (strip, 1.0)]) {
            let values: Vec<f64> = self.axes.iter().map(|axis| axis.value(share)).collect();
            under(&self.scene.source, &self.setting(strip, &values))?;
        }
        Ok(())
    }

    /// What a point of the map sets in the scene.
    pub fn setting(&self, strip: usize, values: &[f64]) -> Setting {
        let of_axes = self.axes.iter().zip(values).map(|(axis, value)| (axis.key.clone(), axis.words(*value)));
        let of_list = self.list.as_ref().map(|(key, values)| (key.clone(), values[strip].clone()));
        let all = of_axes.chain(of_list).chain(self.fixed.iter().cloned());
        all.map(|(key, value)| (key.clone(), self.written.toml(&key, &value))).collect()
    }

    /// Impacts that a map left in `folder` before.
    ///
    /// # Errors
    /// Nothing of a map, or of another one.
    pub fn saved(&self, folder: &Path) -> Result<Vec<MapPoint>, Error> {
        Ok(folder::saved(folder, saved::read(folder, FILE, &self.identity))?.unwrap_or_default())
    }

    /// Finds the lines from impacts that are `known` and others, and saves all of them in `dir` as they come; `follow` hears how many are
    /// done and may break it off.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn run(
        &self,
        dir: &OutputDir,
        known: &[MapPoint],
        threads: NonZeroUsize,
        follow: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Result<MapFound, Error> {
        let mut found = MapFound::default();
        let search = Search {
            dimensions: self.axes.len(),
            lengths: std::array::from_fn(|k| self.axes.get(k).map_or(1.0, MapAxis::length)),
            tolerance: self.asked.tolerance,
            most: self.asked.most,
        };
        for strip in 0..self.list.as_ref().map_or(1, |(_, values)| values.len()) {
            let marcher = Marcher::new(self.scene, self.registry);
            let (mut stopped, mut failed) = (false, None);
            let lines = search.run(|shares| {
                let values = |share: &[f64; 2]| self.axes.iter().zip(share).map(|(axis, s)| axis.value(*s)).collect();
                let wanted: Vec<Vec<f64>> = shares.iter().map(values).collect();
                let same = |values: &Vec<f64>| known.iter().find(|of| of.strip == strip && of.values == *values);
                let missing: Vec<&Vec<f64>> = wanted.iter().filter(|values| same(values).is_none()).collect();
                let settings: Vec<Setting> = missing.iter().map(|values| self.setting(strip, values)).collect();
                let before = found.points.len() + wanted.len() - missing.len();
                let Some(results) = marcher.all(&settings, threads, &mut |done| follow(before + done)) else {
                    stopped = true;
                    return None;
                };
                let mut results = results.into_iter();
                let first = found.points.len();
                for values in wanted {
                    let result = same(&values).map(|of| of.result.clone()).or_else(|| results.next());
                    found.points.extend(result.map(|result| MapPoint { strip, values, result }));
                }
                // What another tolerance wanted may be wanted again.
                let unused = known.iter().filter(|of| !found.points.iter().any(|point| point.is_at(of)));
                let all: Vec<&MapPoint> = found.points.iter().chain(unused).collect();
                failed = saved::write(dir, FILE, &self.identity, &all).err();
                let levels = |point: &MapPoint| point.result.as_ref().ok().map(levels);
                failed.is_none().then(|| found.points[first..].iter().map(levels).collect())
            });
            found.strips.push(lines);
            if let Some(why) = failed {
                return Err(why.into());
            }
            if stopped {
                break;
            }
        }
        let first = found.points.iter().find_map(|point| point.result.as_ref().ok());
        found.names = first.map_or(Vec::new(), names);
        Ok(found)
    }
}

/// What a map is refused for.
fn refuse(message: String) -> Error {
    let help = "give one value, a range without a count `0.5..8 kg` for two keys, or for one beside a list `[0/90]4s,[45/-45]4s`";
    Error::Sweep { message, help: help.into() }
}

/// Names of the lines of a map of which one impact found `of`.
fn names(of: &CaseFigures) -> Vec<String> {
    let threshold = of.over_threshold.map(|_| DELAMINATION.to_owned());
    of.modes.iter().map(|mode| mode.name.clone()).chain(threshold).collect()
}

/// The levels of an impact: the logarithms of what is 1 on the lines.
fn levels(of: &CaseFigures) -> Vec<f64> {
    let all = of.modes.iter().map(|mode| mode.index).chain(of.over_threshold);
    all.map(|index| if index > 0.0 { index.ln().clamp(-FAR, FAR) } else { -FAR }).collect()
}

impl MapFound {
    /// Number of lines of failure, which come before that of delamination.
    fn failures(&self) -> usize {
        self.names.iter().filter(|name| *name != DELAMINATION).count()
    }

    /// The level of the first damage of all: the largest of all modes.
    fn damage(&self, strip: usize, p: [f64; 2]) -> f64 {
        let levels: &[Interpolant] = &self.strips[strip].levels;
        levels[..self.failures().min(levels.len())].iter().map(|level| level.value(p)).fold(f64::NEG_INFINITY, f64::max)
    }
}
