//! Other ways to the answer of a scene, and other problems.

use super::axes::{LADDER, Level, STEP, quoted, reduced, seconds, value};
use crate::model::{Model, Plan};
use crate::registry::{NO_REDUCTION, Registry};
use fem_core::mesh::PlaneMesh;
use fem_core::plate::ZDerivatives;
use fem_core::plugin::Dimension;
use fem_core::plugin::{Built, Kind, ParamDefault, ParamForm, ParamInfo, Params, PluginInfo, Role};
use fem_core::time::StepLimit;
use fem_io::scene::{Analysis, ContactLoad, Scene, Window};

/// The mesh refined without regard to the curves that its boundary follows, or with regard where the scene has none.
pub(super) fn geometry(scene: &Scene, plane: &PlaneMesh) -> Vec<Level> {
    if plane.curved_turn() == 0.0 {
        return Vec::new();
    }
    let refined = value(scene, "mesh.refine").unwrap_or(0) + 1;
    let other =
        if scene.keys.get("mesh.curves").is_some_and(|kept| kept == "\"straight\"") { "kept" } else { "straight" };
    let keys = [("mesh.refine", refined.to_string()), ("mesh.curves", quoted(other))];
    vec![Level::new(format!("refine {refined}, curves {other}"), keys)]
}

pub(super) fn reductions(registry: &Registry) -> Vec<Level> {
    let mut all = vec![Level::new(NO_REDUCTION, reduced(NO_REDUCTION, None, ""))];
    let complete = |info: &&PluginInfo| info.params.iter().all(|row| row.default != ParamDefault::Required);
    for info in registry.list(Kind::Reduction).filter(complete) {
        let name = info.name;
        let size = info.params_of(Role::Size).next().map(|row| row.name);
        let others = info.params_of(Role::Way).flat_map(|row| other_words(row).map(|word| (row.name, word)));
        for way in [None].into_iter().chain(others.map(Some)) {
            let label = way.map_or(name.to_owned(), |(_, word)| format!("{name} {word}"));
            let choice = way.map_or(String::new(), |(key, word)| format!(", {key} = \"{word}\""));
            match size {
                None => all.push(Level::new(label, reduced(name, None, &choice))),
                Some(size) => all.extend(
                    LADDER.map(|n| Level::new(format!("{label} {n}"), reduced(name, Some((size, n)), &choice))),
                ),
            }
        }
    }
    all
}

/// The words of a parameter but its default.
fn other_words(row: &ParamInfo) -> impl Iterator<Item = &'static str> + use<> {
    let (words, default) = match row.form {
        ParamForm::Word(words) => (words, row.default),
        _ => (&[][..], row.default),
    };
    words.iter().map(|(word, _)| *word).filter(move |word| default != ParamDefault::Word(word))
}

pub(super) fn integrators(scene: &Scene, registry: &Registry) -> Option<Vec<Level>> {
    let step = scene.impact()?.march.step.value;
    let each = |name: &'static str| {
        let keys = |step| [("march.integrator", quoted(name)), (STEP, seconds(step))];
        let limited = match registry.build(Kind::Integrator, name, &Params::default()) {
            Ok(Built::Integrator(integrator)) => integrator.limit() != StepLimit::None,
            _ => false,
        };
        let steps = [4.0, 2.0, 1.0, 0.5].map(|share| step * share);
        let each = steps.map(|step| Level::new(format!("{name} {}", Dimension::TIME.of(step)), keys(step)));
        let longest = Level { at_limit: true, ..Level::new(format!("{name} at its limit"), keys(step)) };
        each.into_iter().chain(limited.then_some(longest))
    };
    Some(registry.list(Kind::Integrator).flat_map(|info| each(info.name)).collect())
}

pub(super) fn z_derivatives(scene: &Scene, model: &Model) -> Vec<Level> {
    let other = match scene.z_derivatives.value {
        ZDerivatives::Shared => "layer-wise",
        ZDerivatives::LayerWise => "shared",
    };
    let matter = model.plate.layers() > 1 && model.plate.info().dofs.iter().any(|dof| dof.m() == 3);
    if matter { vec![Level::new(other, [("element.z_derivatives", quoted(other))])] } else { Vec::new() }
}

pub(super) fn quadrature(scene: &Scene, registry: &Registry) -> Vec<Level> {
    const ORDERS: [usize; 4] = [3, 4, 5, 6];
    let info = registry.info(Kind::Element, &scene.element.name.value);
    let Some(row) = info.and_then(|info| info.params_of(Role::Quadrature).next()) else { return Vec::new() };
    let key = format!("element.{}", row.name);
    ORDERS.map(|n| Level::new(format!("{n} Gauss points"), [(key.as_str(), n.to_string())])).to_vec()
}

pub(super) fn mass(scene: &Scene, registry: &Registry) -> Vec<Level> {
    let inert = !matches!(scene.analysis, Analysis::Static(_) | Analysis::Buckling { .. });
    let info = registry.info(Kind::Element, &scene.element.name.value).filter(|_| inert);
    let Some(row) = info.and_then(|info| info.params_of(Role::Inertia).next()) else { return Vec::new() };
    let ParamForm::Word(words) = row.form else { return Vec::new() };
    let key = format!("element.{}", row.name);
    let own = scene.keys.get(&key);
    let differs = |word: &&'static str| own.map_or(row.default != ParamDefault::Word(word), |own| *own != quoted(word));
    let others = words.iter().map(|(word, _)| *word).filter(differs);
    others.map(|word| Level::new(word, [(key.as_str(), quoted(word))])).collect()
}

pub(super) fn elements(scene: &Scene, registry: &Registry) -> Vec<Level> {
    let others = registry.list(Kind::Element).map(|info| info.name).filter(|name| *name != scene.element.name.value);
    others
        .map(|name| {
            let mut level = Level::new(name, [("element.kind", quoted(name))]);
            let built = registry.build(Kind::Element, name, &Params::default());
            // A shell has one layer of cells.
            if let Ok(Built::Element(element)) = built
                && element.info().is_shell()
            {
                level.setting.insert("laminate.layers".into(), "1".into());
            }
            level
        })
        .collect()
}

pub(super) fn contact(scene: &Scene) -> Option<Vec<Level>> {
    let node = Level::new("node", [("impactor.load", quoted("node"))]);
    let side = |side: f64| {
        Level::new(
            format!("square {}", Dimension::LENGTH.of(side)),
            [("impactor.patch_side", quoted(format!("{side:e} m")))],
        )
    };
    let radius = |radius: f64| {
        Level::new(
            format!("radius {}", Dimension::LENGTH.of(radius)),
            [("impactor.patch_radius", quoted(format!("{radius:e} m")))],
        )
    };
    Some(match scene.impact()?.impactors.first()?.load.value {
        ContactLoad::Node => [1e-3, 2e-3, 4e-3].map(radius).to_vec(),
        ContactLoad::Patch { radius: own } => vec![node, radius(0.5 * own), radius(2.0 * own)],
        ContactLoad::Tip { radius: own } => vec![node, radius(0.25 * own), radius(0.5 * own)],
        ContactLoad::Square { side: own } => vec![node, side(0.5 * own), side(2.0 * own)],
    })
}

pub(super) fn window(model: &Model) -> Vec<Level> {
    if model.criteria.is_empty() || !matches!(model.plan, Plan::Impact(_)) {
        return Vec::new();
    }
    let side = |side: f64| Level::new(Dimension::LENGTH.of(side), [("failure.window", quoted(format!("{side:e} m")))]);
    match model.window {
        Window::Element => [1e-3, 2e-3, 4e-3].map(side).to_vec(),
        Window::Square(own) => {
            vec![Level::new("element", [("failure.window", quoted("element"))]), side(0.5 * own), side(2.0 * own)]
        }
    }
}
