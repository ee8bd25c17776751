//! What the registry has, built, for the tests that go over all of it.

use fem::Registry;
use fem::core::failure::FailureCriterion;
use fem::core::material::{Material, Strength};
use fem::core::plugin::{Built, Kind, Params, PluginInfo, Value};

/// Parameters of a criterion that cannot be built without.
fn parameters(name: &str) -> Params {
    let required: &[(&str, Value)] = match name {
        "max-strain" => &["e1t", "e1c", "e2t", "e2c", "g12", "g23"].map(|key| (key, Value::Number(0.01))),
        "expression" => &[("expression", Value::Text("s1/E1".into()))],
        _ => &[],
    };
    required.iter().fold(Params::default(), |params, (key, value)| params.with(key, value.clone()))
}

/// All criteria of the registry, built.
pub(crate) fn criteria() -> Vec<(PluginInfo, Box<dyn FailureCriterion>)> {
    let registry = Registry::standard();
    let build = |info: &PluginInfo| match registry.build(Kind::Criterion, info.name, &parameters(info.name)) {
        Ok(Built::Criterion(criterion)) => (*info, criterion),
        other => panic!("{}: {other:?}", info.name),
    };
    registry.list(Kind::Criterion).map(build).collect()
}

/// Tapes of the library with what interfaces need; S23 far from Yc/2 in all but one of them.
pub(crate) fn tapes() -> Vec<Material> {
    let tapes = fem::io::materials::names().filter_map(fem::io::materials::library).map(|m| m.material.clone());
    tapes
        .filter(|m| m.strengths.get(Strength::Yt).is_some())
        .map(|m| {
            let (s, yt, yc, s12) = (m.strengths, m.strengths.yt(), m.strengths.yc(), m.strengths.s12());
            let strengths = s.with(Strength::Zt, yt).with(Strength::Zc, yc).with(Strength::S13, s12);
            Material { strengths, ..m }
        })
        .collect()
}
