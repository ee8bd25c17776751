//! Constants of materials that no solid has, most likely because they are in another unit.

use fem_core::laminate::Laminate;
use fem_core::material::{Elastic, Material, Strength};
use fem_core::plugin::Dimension;
use std::collections::BTreeSet;

/// Densities between that of a light foam and that of osmium with some room, kg/m³.
const DENSITIES: [f64; 2] = [1.0, 3e4];

/// Young's moduli between that of a gel and that of diamond with some room, Pa.
const MODULI: [f64; 2] = [1e4, 1.5e12];

/// Strengths between that of a gel and that of a sheet of graphene, with some room, Pa.
const STRENGTHS: [f64; 2] = [1e3, 1e12];

/// A warning for each material of `laminates` whose density, moduli or strengths are beyond those of solids.
pub(super) fn unlikely(laminates: &[Laminate], materials: &[Material]) -> Vec<String> {
    let used: BTreeSet<usize> =
        laminates.iter().flat_map(|laminate| laminate.plies.iter().map(|ply| ply.material)).collect();
    used.into_iter().filter_map(|material| of(&materials[material])).collect()
}

fn of(material: &Material) -> Option<String> {
    let Elastic { e1, e2, e3, .. } = material.elastic;
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
