//! A plate that is struck in another way.

use super::builder::Builder;
use super::{Model, Origin, Plan};
use crate::error::Error;
use crate::registry::Registry;
use fem_core::material::Strength;
use fem_failure::delamination::DelaminationThreshold;
use fem_io::scene::Scene;

/// Keys of an impactor by which its march differs, and nothing before it. The place and the patch of the contact shape the
/// reduction.
const OF_IMPACTOR: [&str; 8] = ["mass", "velocity", "energy", "drop_height", "start", "name", "diameter", "material"];

/// Keys on which no number of a march depends.
const FREE: [&str; 3] = ["title", "study", "sweep"];

/// Whether a scene that differs in the key `path` alone has the same plate before its march: the impactor, the constants of its
/// contact and the strengths of materials.
pub(crate) fn leaves_plate(path: &str) -> bool {
    let parts: Vec<&str> = path.split('.').map(|part| part.split('[').next().unwrap_or(part)).collect();
    // What follows the word may choose one of several impactors.
    match parts[..] {
        ["contact", ..] | ["impactor", "contact", ..] | ["impactor", _, "contact", ..] => true,
        ["impactor", key] | ["impactor", _, key] => OF_IMPACTOR.contains(&key),
        ["materials", ..] => leaves_march(path),
        [first, ..] => FREE.contains(&first),
        [] => false,
    }
}

/// Whether a scene that differs in the key `path` alone has the same march on a plate that impacts share: the strengths of materials.
pub(crate) fn leaves_march(path: &str) -> bool {
    let mut parts = path.split('.');
    let (first, _, key) = (parts.next(), parts.next(), parts.next());
    first == Some("materials") && Strength::ALL.iter().any(|strength| Some(strength.name()) == key)
}

impl Model {
    /// The model of `scene` on this plate; `None` where the scene has another plate.
    ///
    /// # Errors
    /// As [`Model::new`], for what is new in the scene.
    pub(crate) fn struck_anew(&self, scene: &Scene, registry: &Registry) -> Result<Option<Self>, Error> {
        let (old, new) = (&self.origin.keys, &scene.keys);
        let differs = |(key, value): (&String, &String), other: &std::collections::BTreeMap<String, String>| {
            other.get(key) != Some(value) && !leaves_plate(key)
        };
        let another = old.iter().any(|key| differs(key, new)) || new.iter().any(|key| differs(key, old));
        // Laws and interfaces that open have strengths within the plate.
        if another || self.laws.is_some() || self.separation.is_some() {
            return Ok(None);
        }
        let (Plan::Impact(impact), Some(spec)) = (&self.plan, scene.impact()) else { return Ok(None) };
        let builder = Builder::new(scene, registry);
        let mut impact = impact.clone();
        for (strike, impactor) in impact.strikes.iter_mut().zip(&spec.impactors) {
            strike.law = builder.law(impactor)?;
        }
        impact.spec = spec.clone();
        let materials: Vec<_> = scene.materials.iter().map(|material| material.value.clone()).collect();
        let criteria = match self.criteria.is_empty() {
            true => Vec::new(),
            false => builder.criteria(&*self.element)?,
        };
        let threshold = DelaminationThreshold::of(&self.laminate, &materials, self.interface);
        Ok(Some(Self {
            origin: Origin::of(scene),
            threshold: builder.threshold(threshold)?,
            plan: Plan::Impact(impact),
            materials,
            criteria,
            ..self.clone()
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::leaves_plate;

    #[test]
    fn impactors_leave_the_plate_by_whatever_name() {
        let keys =
            ["impactor.mass", "impactor[1].velocity", "impactor.2.start", "impactor.splinter.contact.k", "contact.k"];
        keys.iter().for_each(|key| assert!(leaves_plate(key), "{key}"));
        let others =
            ["impactor.at.x", "impactor.2.at.x", "impactor.splinter.patch_radius", "march.step", "support.1.mass"];
        others.iter().for_each(|key| assert!(!leaves_plate(key), "{key}"));
    }
}
