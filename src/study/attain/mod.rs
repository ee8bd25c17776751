//! An accuracy that is asked for: the settings of a scene are raised until differences of runs say that it is reached.

mod climb;
mod search;

use super::NOTHING;
use super::axes::{LADDERS, LAYERS, STEP, TOLERANCE, axes};
use super::force::Force;
use super::quantity::choose_quantities;
use crate::cost::Attained;
use crate::error::Error;
use crate::job::Follow;
use crate::model::Model;
use crate::registry::Registry;
use fem_io::scene::{Scene, Setting};
use search::Search;

/// Keys that levels of these parts set, beside those of the reduction.
const RAISED: [&str; 4] = ["mesh.refine", "laminate.layers", STEP, TOLERANCE];

/// What of the scene `found` a search may have raised.
pub fn raised(found: &Scene) -> Setting {
    let raised = |key: &str| RAISED.contains(&key) || key.starts_with("reduction.");
    found.keys.iter().filter(|(key, _)| raised(key)).map(|(key, value)| (key.clone(), value.clone())).collect()
}

/// What a search tells while it runs: what runs now, and the error so far, where it is known.
pub type TellSearch<'a> = &'a mut dyn FnMut(&str, Option<f64>);

/// Raises mesh, layers of cells, reduction and step of `scene`, whose model is `model`, until the error of
/// what a study asks for is at most `asked`; in `budget` seconds of processor time, or in ten minutes of a common machine.
///
/// Every part of the settings is raised by a level at a time, alone, and its levels are judged by what they change:
///
/// ```text
/// error of level j ≈ Σ dᵢ + left      dᵢ what the levels above it change, left what the last of these leaves: as a study says it
///                                     (`Convergence`), first order of a single change, four times the last of a ladder that stalls
/// ```
///
/// Errors of all parts add up; of the combinations of levels that are good enough the cheapest is chosen, and where there is none, the
/// part that leaves most is raised. A run a level below the chosen one in all parts shows what they change together, which adds
/// to the error where it is more than the sum. Nothing is made coarser than the scene has it; sampling in time and
/// the windows of stresses stay as they are. The run at the chosen levels is for whoever asked. `follow` is heard before every run and
/// at every step of its march.
///
/// # Errors
/// A scene that does not run as it is, quantities that are all 0; [`Error::Cancelled`] where `follow` broke the search off.
pub fn attain(
    (scene, model): (&Scene, &Model),
    registry: &Registry,
    asked: f64,
    budget: Option<f64>,
    tell: TellSearch<'_>,
    follow: &mut dyn Follow,
) -> Result<Attained, Error> {
    let ladders = axes(scene, model, registry, &LADDERS.map(str::to_owned))?;
    // A single ply, or the laminates of a list.
    let layers = model.plate.info().is_shell() || ladders.iter().any(|axis| axis.name == LAYERS);
    tell("the scene as it is", None);
    let mut search = Search::new((&scene.source, registry), ladders, asked, budget, follow)?;
    let base = search.base();
    let forced = base.force.as_ref().is_some_and(Force::acts);
    search.names = choose_quantities(scene, &base.figures, forced)?;
    if search.names.is_empty() {
        return Err(Error::Study(NOTHING.to_owned()));
    }
    let (chosen, stopped) = search.raise(tell)?;
    let not_judged = (!layers).then_some("layers of cells, of which no key makes more");
    Ok(Attained { not_judged, ..search.attained(&chosen, stopped) })
}
