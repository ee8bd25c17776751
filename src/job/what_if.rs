//! What a page of results needs to march impacts by itself.

use crate::advise;
use crate::analyses::impact::{SharedPlate, march};
use crate::error::Error;
use crate::model::{Impact, Model, Plan, count_steps};
use crate::output::report::{WhatIf, WhatIfCriterion, WhatIfImpact, WhatIfLaw, WhatIfPlate, WhatIfUnloading};
use crate::registry::Registry;
use fem_core::contact::ContactHistory;
use fem_core::failure::Site;
use fem_core::material::Material;
use fem_core::plugin::{Kind, ParamInfo, Params};
use fem_io::scene::{CriterionSpec, PluginSpec, Scene};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;

/// Criteria that the page computes; it has a function of the same name for each.
const JUDGED: [&str; 7] = [
    "hashin-report",
    "hashin-1980",
    "max-stress",
    "octahedral",
    "quadratic-stress",
    "max-stress-interface",
    "brewer-lagace",
];

/// Most bytes of the stresses of places before they are written as text, a third longer.
const BYTES: usize = 1_300_000;

/// Most products of a number of these with a coordinate, over all samples: a browser makes one in two nanoseconds.
const PRODUCTS: usize = 8_000_000;

/// Factors on mass and velocity of further impacts, of which the hottest places are carried too.
const FURTHER: [[f64; 2]; 2] = [[4.0, 1.0], [0.25, 2.0]];

/// The impact of `scene` and its force peak, N, as a page marches it.
///
/// # Errors
/// What [`run`](super::run) is refused for.
pub fn what_if(scene: &Scene, registry: &Registry, threads: NonZeroUsize) -> Result<(WhatIf, Option<f64>), Error> {
    let model = advise::decided(Model::new(scene, registry)?, threads)?;
    let Plan::Impact(impact) = &model.plan else { return Ok((missing("it has no impact"), None)) };
    if let Some(why) = refused(impact) {
        return Ok((missing(why), None));
    }
    if model.one_sided().next().is_some() {
        return Ok((missing("the plate may lift off a support"), None));
    }
    let law = match law(impact, registry) {
        Ok(law) => law,
        Err(why) => return Ok((missing(why), None)),
    };
    let Some(plate) = SharedPlate::new(&model, threads)? else {
        return Ok((missing("the plate is not reduced to its modes, or changes as it is struck"), None));
    };
    let prepared = plate.struck(&model)?.firsts_alone();
    let (steps, step, marched) = (prepared.sizes.steps, prepared.sizes.step, prepared.sizes.marched);
    let buckling = prepared.sizes.buckling;
    let outcome = march(prepared, |_| ())?;
    if let Some(why) = outcome.stopped {
        return Ok((missing(&format!("its march stopped: {why}")), None));
    }
    let sample = count_steps(model.sample_every, step);
    let samples = (steps / sample) as usize + 2;
    let most = (BYTES / (48 * marched)).min(PRODUCTS / (6 * marched * samples)).max(1);
    let carried = match plate.carried(&impacts(&model), most)? {
        Ok(carried) => carried,
        Err(why) => return Ok((missing(why), None)),
    };
    let judged = |spec: &&CriterionSpec| JUDGED.contains(&spec.plugin.name.value.as_str());
    let specs =
        || scene.failure.criteria.iter().filter(|spec| model.criteria.iter().any(|(name, _)| *name == spec.label));
    let criteria: Vec<WhatIfCriterion> =
        specs().filter(judged).filter_map(|spec| criterion(&model, registry, spec)).collect();
    let spec = &impact.spec.impactors[0];
    let newmark = Given::of(registry, Kind::Integrator, &impact.spec.march.integrator);
    let weight = |name: &str| newmark.as_ref()?.number(name);
    let whatif = WhatIfPlate {
        impact: WhatIfImpact {
            mass: spec.mass,
            velocity: spec.velocity,
            start: spec.start,
            step,
            steps,
            sample,
            until_separation: impact.spec.march.until_separation,
            beta: weight("beta").unwrap_or(0.25),
            gamma: weight("gamma").unwrap_or(0.5),
        },
        law,
        strengths: strengths(&model),
        unjudged: specs().filter(|spec| !judged(spec)).map(|spec| spec.label.clone()).collect(),
        stretch: advise::hindsight(&model, &outcome.contacts, buckling, f64::INFINITY)
            .map(|hindsight| (hindsight.coefficient, model.laminate.thickness())),
        criteria,
        plate: carried,
    };
    let peak = outcome.contacts.first().map(|contact| contact.force.0);
    Ok((WhatIf::Plate(Box::new(whatif)), peak))
}

/// The integrator that the page has, that of scenes that name none.
const NEWMARK: &str = "newmark";

fn missing(why: &str) -> WhatIf {
    WhatIf::Missing { why: why.to_owned() }
}

/// What of an impact the page does not march.
fn refused(impact: &Impact) -> Option<&'static str> {
    let march = &impact.spec.march;
    let [spec] = &impact.spec.impactors[..] else { return Some("several impactors strike the plate") };
    if march.integrator.name.value != NEWMARK {
        return Some("the page marches with Newmark's method alone, and the scene names another integrator");
    }
    if march.tolerance.is_some() {
        return Some("its steps are divided by `march.tolerance`, and the page marches with equal ones");
    }
    spec.indentation_from.is_some().then_some("its contact law counts from a surface inside the plate")
}

/// The contact law by its parameters, or why the page does not have it.
fn law(impact: &Impact, registry: &Registry) -> Result<WhatIfLaw, &'static str> {
    let spec = &impact.spec.impactors[0].contact;
    let given = Given::of(registry, Kind::Contact, spec);
    let number = |name: &str| given.as_ref()?.number(name);
    let unloading = || {
        let word = given.as_ref()?.word("reloading");
        Some(WhatIfUnloading {
            m: number("m")?,
            critical: number("critical")?,
            beta: number("beta")?,
            reload_by_n: word == Some("loading-exponent"),
        })
    };
    // Of k αⁿ, which the scene may give by the bodies instead.
    let k = impact.strikes[0].law.force(&ContactHistory::default(), 1.0).force;
    let (n, unloading) = match spec.name.value.as_str() {
        "linear" => (Some(1.0), None),
        "hertz" => (number("n"), None),
        "sun-yang" => (number("n"), Some(unloading().ok_or("its contact law lacks a parameter")?)),
        _ => return Err("the page has the contact laws linear, hertz and sun-yang, and the scene names another"),
    };
    Ok(WhatIfLaw { name: spec.name.value.clone(), k, n: n.ok_or("its contact law lacks a parameter")?, unloading })
}

/// Parameters of a plug-in as they hold, in SI.
struct Given {
    params: Params,
    rows: &'static [ParamInfo],
}

impl Given {
    fn of(registry: &Registry, kind: Kind, spec: &PluginSpec) -> Option<Self> {
        let (params, rows) = registry.in_si(kind, &spec.name.value, &spec.params)?;
        Some(Self { params, rows })
    }

    fn row(&self, name: &str) -> Option<&ParamInfo> {
        self.rows.iter().find(|row| row.name == name)
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.params.number(self.row(name)?).ok()
    }

    fn word(&self, name: &str) -> Option<&'static str> {
        self.params.word(self.row(name)?).ok()
    }
}

fn criterion(model: &Model, registry: &Registry, spec: &CriterionSpec) -> Option<WhatIfCriterion> {
    let (_, criterion) = model.criteria.iter().find(|(name, _)| *name == spec.label)?;
    let plugin = &spec.plugin.name.value;
    let given = Given::of(registry, Kind::Criterion, &spec.plugin)?;
    Some(WhatIfCriterion {
        name: spec.label.clone(),
        plugin: plugin.clone(),
        plus: given.word("product") == Some("plus"),
        interface: criterion.info().site == Site::Interface,
        modes: criterion.info().modes,
    })
}

/// Of each material the strengths that the criteria ask for where it is judged.
fn strengths(model: &Model) -> Vec<(String, BTreeMap<&'static str, f64>)> {
    let judges = |site: Site, k: usize| match site {
        Site::Interface => model.interface == Some(k),
        Site::Ply => model.laminates.iter().flat_map(|laminate| &laminate.plies).any(|ply| ply.material == k),
    };
    let of = |(k, material): (usize, &Material)| {
        let infos = model.criteria.iter().map(|(_, criterion)| criterion.info());
        let asked = infos.filter(|info| judges(info.site, k)).flat_map(|info| info.strengths);
        let given = asked.filter_map(|which| Some((which.name(), material.strengths.get(*which)?)));
        (material.name.clone(), given.collect())
    };
    model.materials.iter().enumerate().map(of).collect()
}

/// The impact of `model` and [`FURTHER`] ones on the same plate.
fn impacts(model: &Model) -> Vec<Model> {
    let further = FURTHER.iter().map(|[mass, velocity]| {
        let mut other = model.clone();
        if let Plan::Impact(impact) = &mut other.plan {
            for spec in &mut impact.spec.impactors {
                spec.mass *= mass;
                spec.velocity *= velocity;
            }
        }
        other
    });
    std::iter::once(model.clone()).chain(further).collect()
}
