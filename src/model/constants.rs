//! Constants of materials that no solid has, most likely because they are in another unit, and materials that are there twice.

use fem_core::laminate::{LaminaPly, Laminate};
use fem_core::material::{Elastic, Material, Strength};
use fem_core::plugin::Dimension;
use fem_io::scene::PluginSpec;
use std::collections::BTreeSet;

/// Densities between that of a light foam and that of osmium with some room, kg/m³.
const DENSITIES: [f64; 2] = [1.0, 3e4];

/// Young's moduli between that of a gel and that of diamond with some room, Pa.
const MODULI: [f64; 2] = [1e4, 1.5e12];

/// Strengths between that of a gel and that of a sheet of graphene, with some room, Pa.
const STRENGTHS: [f64; 2] = [1e3, 1e12];

/// Thermal expansion of soft rubbers with some room, 1/K.
const EXPANSION: f64 = 2e-3;

/// A warning for each material of `laminates` whose density, moduli or strengths are beyond those of solids.
pub(super) fn unlikely(laminates: &[Laminate], materials: &[Material]) -> Vec<String> {
    let used: BTreeSet<usize> =
        laminates.iter().flat_map(|laminate| laminate.plies.iter().map(|ply| ply.material)).collect();
    used.into_iter().filter_map(|material| of(&materials[material])).collect()
}

/// A warning of neighbouring plies of one angle whose materials differ in their names alone: interfaces may open between them, and each counts as
/// half as thick as both together. `laws` are those that they follow.
pub(super) fn twice(laminates: &[Laminate], materials: &[Material], laws: &[Option<PluginSpec>]) -> Option<String> {
    // Constants that nobody gave are NaN, which equals nothing.
    let constants = |k: usize| {
        let law = laws[k].as_ref().map(|law| (&law.name.value, &law.params));
        format!("{:?} {law:?}", Material { name: String::new(), ..materials[k].clone() })
    };
    let pairs = |laminate: &Laminate| {
        let pairs = laminate.unlike().map(|below| [&laminate.plies[below - 1], &laminate.plies[below]]);
        let turned = |[a, b]: &[&LaminaPly; 2]| a.material != b.material && (a.angle - b.angle).sin().abs() <= ALIKE;
        let mut pairs = pairs.filter(turned).map(|pair| pair.map(|ply| ply.material));
        pairs.find(|[a, b]| constants(*a) == constants(*b))
    };
    let [a, b] = laminates.iter().find_map(pairs)?.map(|k| &materials[k].name);
    Some(format!(
        "materials `{a}` and `{b}` have the same constants, but neighbouring plies of one angle count as different because of their names: interfaces \
         may open between them, and strengths in situ and splits take them for thinner than they are together; give both one name"
    ))
}

/// Sine of an angle between fibres that lie in one direction.
const ALIKE: f64 = 1e-6;

fn of(material: &Material) -> Option<String> {
    let Elastic { e1, e2, e3, .. } = material.elastic;
    if let Some(alpha) = material.expansion.into_iter().flatten().find(|alpha| alpha.abs() > EXPANSION) {
        return Some(format!(
            "material `{}`: a thermal expansion of {alpha} 1/K is none of a solid, which lie below {EXPANSION} 1/K: is there an e-6 missing?",
            material.name
        ));
    }
    let density = material.density.map(|density| ("density", density, Dimension::DENSITY, DENSITIES));
    let moduli = [("e1", e1), ("e2", e2), ("e3", e3)].map(|(name, e)| (name, e, Dimension::PRESSURE, MODULI));
    let strengths = Strength::ALL.iter().filter_map(|which| Some((which.name(), material.strengths.get(*which)?)));
    let strengths = strengths.map(|(name, strength)| (name, strength, Dimension::PRESSURE, STRENGTHS));
    let mut all = density.into_iter().chain(moduli).chain(strengths);
    let (name, value, is, [least, most]) = all.find(|(_, value, _, [least, most])| !(least..=most).contains(&value))?;
    Some(format!(
        "material `{}`: {name} = {} is none of a solid, which lie between {} and {}: is its unit right?",
        material.name,
        is.of(value),
        is.of(least),
        is.of(most)
    ))
}
