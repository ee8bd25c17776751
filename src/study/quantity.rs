//! What accuracy is asked of.

use crate::job::{ImpactFound, StaticFound};
use crate::model::Model;
use crate::words::name_ply_of;
use fem_core::plugin::unknown_key;
use fem_core::profile::ProfilePoint;
use fem_failure::scan::first_per_mode;
use fem_io::scene::{Quantity, Scene, SceneError};
use serde::{Deserialize, Serialize};

/// The force over time, whose error is the L2 norm of a difference.
pub const FORCE_HISTORY: &str = "force-history";

/// A number that a run found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Its name.
    pub name: String,
    /// Its value, SI units.
    pub value: f64,
    /// Whether accuracy is asked of it where a scene does not say of what.
    pub asked: bool,
}

impl Figure {
    fn new(name: impl Into<String>, value: f64, asked: bool) -> Self {
        Self { name: name.into(), value, asked }
    }
}

/// Of an impact.
pub(super) fn of_impact(model: &Model, found: &ImpactFound) -> Vec<Figure> {
    let ImpactFound { sizes, outcome, summary } = found;
    let mut figures = Vec::new();
    for impact in &summary.impact {
        let name = |what: &str| impact.name.as_ref().map_or(what.to_owned(), |name| format!("{name} {what}"));
        figures.push(Figure::new(name("peak-force"), impact.peak_force_N, true));
        figures.push(Figure::new(name("peak-time"), impact.peak_force_time_s, false));
        figures.push(Figure::new(name("impulse"), impact.impulse_N_s, true));
        figures.push(Figure::new(name("deflection"), impact.peak_plate_displacement_m, true));
    }
    if let Some(grown) = &summary.delamination {
        figures.push(Figure::new("delaminated-area", grown.projected_area_mm2 * 1e-6, true));
        figures.push(Figure::new("delaminated-areas", grown.area_mm2 * 1e-6, false));
        figures.push(Figure::new("dissipated-energy", grown.dissipated_J, true));
        figures.extend(grown.absorbed_J.map(|energy| Figure::new("absorbed-energy", energy, true)));
    }
    figures.push(Figure::new("compliance", 1.0 / sizes.static_stiffness, false));
    let first = outcome.events.iter().map(|e| e.time).reduce(f64::min);
    figures.extend(first.map(|time| Figure::new("first-damage", time, true)));
    for event in first_per_mode(&outcome.events) {
        figures.push(Figure::new(format!("onset {} {}", event.criterion, event.mode), event.time, false));
    }
    for history in &outcome.histories {
        let [x, y, _] = history.site.position;
        let ply = name_ply_of(history.site.place, model.region_of(history.site.cell as usize));
        let place = format!("{ply} at ({:.2}, {:.2}) mm", x * 1e3, y * 1e3);
        let name = format!("index {} {place}", model.criteria[history.criterion].0);
        figures.push(Figure::new(name, history.indices.iter().fold(0.0, |m: f64, i| m.max(*i)), false));
    }
    figures
}

/// Stresses below this share of the largest of their profile are not asked for, unless by name.
const NOTABLE: f64 = 0.1;

const COMPONENTS: [&str; 12] = ["sxx", "syy", "szz", "sxy", "syz", "szx", "s1", "s2", "s3", "s12", "s23", "s13"];

/// Of loads at rest.
///
/// # Errors
/// A stress that the scene asks for at a place that no profile has.
pub(super) fn of_statics(scene: &Scene, model: &Model, found: &StaticFound) -> Result<Vec<Figure>, SceneError> {
    let StaticFound { solution, summary } = found;
    let mut figures = vec![
        Figure::new("deflection", summary.largest_deflection.w_m, true),
        Figure::new("energy", solution.strain_energy, true),
    ];
    if let Some(path) = &summary.path {
        figures.push(Figure::new("peak-force", path.peak_force_N, true));
        figures.push(Figure::new("delaminated-area", path.delamination.projected_area_mm2 * 1e-6, true));
        figures.push(Figure::new("dissipated-energy", path.dissipated_J, true));
    }
    let reserve = solution.margins.iter().map(|m| m.reserve_factor).reduce(f64::min);
    figures.extend(reserve.map(|factor| Figure::new("reserve-factor", factor, false)));
    for (named, points) in model.profiles.iter().zip(&solution.profiles) {
        let extremes = [0, 1, 2, 3, 4, 5].map(|k| extreme(points.iter().map(|p| p.global.0[k])));
        let largest = extreme(extremes.into_iter()).abs();
        for (component, value) in COMPONENTS.into_iter().zip(extremes) {
            let name = format!("{} {component}", named.line.name.value);
            figures.push(Figure::new(name, value, value.abs() > NOTABLE * largest));
        }
    }
    for quantity in &scene.study.quantities {
        let Quantity::Stress { name, profile, component, height } = &quantity.value else { continue };
        let wrong = |message: String, help: String| scene.source.error_at(&quantity.place, message, help);
        let names = || model.profiles.iter().map(|p| p.line.name.value.as_str());
        let Some(p) = names().position(|p| p == profile) else {
            let help = format!("`{profile}` {}", unknown_key(profile, names()));
            return Err(wrong(format!("there is no profile `{profile}`"), help));
        };
        let Some(k) = COMPONENTS.iter().position(|c| c == component) else {
            let help = format!("`{component}` {}", unknown_key(component, COMPONENTS.into_iter()));
            return Err(wrong(format!("there is no stress `{component}`"), help));
        };
        let value = at(&solution.profiles[p], k, *height);
        let outside = || {
            wrong(
                format!("a height of {height:e} m lies outside the plate"),
                "heights are measured from the mid-plane".into(),
            )
        };
        figures.push(Figure::new(name, value.ok_or_else(outside)?, true));
    }
    Ok(figures)
}

fn extreme(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, v| if v.abs() > f64::abs(m) { v } else { m })
}

/// Stress `k` at `height`, between two points of a profile by a straight line.
fn at(points: &[ProfilePoint], k: usize, height: f64) -> Option<f64> {
    let stress = |p: &ProfilePoint| if k < 6 { p.global.0[k] } else { p.in_ply.0[k - 6] };
    let reach = 1e-9 * (points.last()?.z - points.first()?.z);
    points.windows(2).find_map(|pair| {
        let [a, b] = pair else { return None };
        let inside = height >= a.z - reach && height <= b.z + reach && b.z > a.z;
        inside.then(|| stress(a) + (stress(b) - stress(a)) * (height - a.z) / (b.z - a.z))
    })
}

/// Of natural modes.
pub(super) fn of_modes(omega: &[f64]) -> Vec<Figure> {
    let frequency =
        |(k, omega): (usize, &f64)| Figure::new(format!("frequency {}", k + 1), omega / std::f64::consts::TAU, true);
    omega.iter().enumerate().map(frequency).collect()
}

/// Of buckling.
pub(super) fn of_buckling(factors: &[f64]) -> Vec<Figure> {
    let figure = |(k, factor): (usize, &f64)| Figure::new(format!("buckling-factor {}", k + 1), *factor, true);
    factors.iter().enumerate().map(figure).collect()
}

/// Names of what accuracy is asked of, among those that the scene as it is has found: of what is 0 there, no error is a
/// part.
///
/// # Errors
/// A name that none has, or whose value is 0.
pub(super) fn choose_quantities(scene: &Scene, figures: &[Figure], forced: bool) -> Result<Vec<String>, SceneError> {
    let force = forced.then_some(FORCE_HISTORY);
    let known = || force.into_iter().chain(figures.iter().map(|f| f.name.as_str()));
    if scene.study.quantities.is_empty() {
        let by_default = figures.iter().filter(|f| f.asked && f.value != 0.0).map(|f| f.name.as_str());
        return Ok(force.into_iter().chain(by_default).map(str::to_owned).collect());
    }
    let mut names: Vec<String> = Vec::new();
    for quantity in &scene.study.quantities {
        let (Quantity::Named(word) | Quantity::Stress { name: word, .. }) = &quantity.value;
        let mut found = known().filter(|name| *name == word || name.starts_with(&format!("{word} "))).peekable();
        if found.peek().is_none() {
            let message = format!("the scene has no `{word}`");
            let help = format!("`{word}` {}", unknown_key(word, known()));
            return Err(scene.source.error_at(&quantity.place, message, help));
        }
        for name in found.map(str::to_owned) {
            if figures.iter().any(|f| f.name == name && f.value == 0.0) {
                let message = format!("`{name}` is 0 in the scene as it is");
                let help = "errors are parts of a value: ask for others, or change the scene until there is something";
                return Err(scene.source.error_at(&quantity.place, message, help));
            }
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    Ok(names)
}
