//! Materials of a scene: from the library, from constants, or from constants over the library's.

use super::reader::{Field, Keys, Reader};
use super::source::{Located, SceneError};
use crate::materials;
use fem_core::material::{Elastic, Material, Strength, Strengths};
use fem_core::plugin::Dimension;

pub(crate) const KEYS: Keys = &[
    ("library", r#""AS4/3502""#),
    ("e", r#""70 GPa""#),
    ("nu", "0.3"),
    ("e1", r#""130.3 GPa""#),
    ("e2", r#""9.65 GPa""#),
    ("e3", r#""9.65 GPa""#),
    ("nu12", "0.35"),
    ("nu13", "0.35"),
    ("nu23", "0.40"),
    ("g12", r#""5.93 GPa""#),
    ("g13", r#""5.93 GPa""#),
    ("g23", r#""3.45 GPa""#),
    ("density", r#""1.575 g/cm^3""#),
    ("Xt", r#""1793 MPa""#),
    ("Xc", r#""1724 MPa""#),
    ("Yt", r#""64 MPa""#),
    ("Yc", r#""138 MPa""#),
    ("S12", r#""109 MPa""#),
    ("S23", r#""69 MPa""#),
    ("Zt", r#""60 MPa""#),
    ("Zc", r#""138 MPa""#),
    ("S13", r#""90 MPa""#),
];

const ELASTIC: &str = "give e and nu (isotropic), or e1, e2, nu12, nu23, g12 (isotropic across the fibres), \
                       or all nine of e1, e2, e3, nu12, nu13, nu23, g12, g13, g23";

/// All materials of the table `materials`.
pub(super) fn read_all(field: &Field<'_>) -> Result<Vec<Located<Material>>, SceneError> {
    field.entries()?.iter().map(|(name, field)| Ok(field.at(read(name, field)?))).collect()
}

/// Position of the material that `field` names.
pub(super) fn find(field: &Field<'_>, materials: &[Located<Material>]) -> Result<usize, SceneError> {
    field.word(materials.iter().map(|m| m.value.name.as_str()))
}

fn read(name: &str, field: &Field<'_>) -> Result<Material, SceneError> {
    let own = field.table(KEYS)?;
    let Some(library) = own.optional("library") else { return from_constants(name, &own) };
    let below = &materials::all()[library.word(materials::names())?];
    let merged = field.any_table()?.clone().over(below.table.clone());
    from_constants(name, &own.of(&merged, KEYS)?)
}

/// A material from its constants alone.
pub(crate) fn from_constants(name: &str, table: &Reader<'_>) -> Result<Material, SceneError> {
    let elastic = elastic(table)?;
    let density = table.required("density")?.positive(Dimension::DENSITY)?;
    let mut strengths = Strengths::default();
    for &strength in Strength::ALL {
        if let Some(field) = table.optional(strength.name()) {
            strengths = strengths.with(strength, field.positive(Dimension::PRESSURE)?);
        }
    }
    let material = Material { name: name.to_owned(), elastic, density, strengths };
    match material.check() {
        Ok(()) => Ok(material),
        Err(e) => Err(table.error(e.to_string(), "no solid has these constants: look for a slip in one of them")),
    }
}

fn elastic(table: &Reader<'_>) -> Result<Elastic, SceneError> {
    let given = |keys: &[&'static str]| keys.iter().copied().find(|key| table.optional(key).is_some());
    let constant = |key| table.optional(key).ok_or_else(|| table.missing(key, ELASTIC));
    let modulus = |key| constant(key)?.positive(Dimension::PRESSURE);
    let ratio = |key| constant(key)?.number();
    if given(&["e", "nu"]).is_some() {
        return match given(&["e1", "e2", "e3", "nu12", "nu13", "nu23", "g12", "g13", "g23"]) {
            None => Ok(Elastic::isotropic(modulus("e")?, ratio("nu")?)),
            Some(stray) => Err(constant(stray)?.error("does not go with e and nu", ELASTIC)),
        };
    }
    let (e1, e2, nu12) = (modulus("e1")?, modulus("e2")?, ratio("nu12")?);
    let (nu23, g12) = (ratio("nu23")?, modulus("g12")?);
    if given(&["e3", "nu13", "g13", "g23"]).is_none() {
        return Ok(Elastic::transversely_isotropic(e1, e2, nu12, nu23, g12));
    }
    let (e3, nu13, g13, g23) = (modulus("e3")?, ratio("nu13")?, modulus("g13")?, modulus("g23")?);
    Ok(Elastic { e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_strength_that_a_criterion_may_ask_for_can_be_given() {
        for strength in Strength::ALL {
            assert!(KEYS.iter().any(|(key, _)| *key == strength.name()), "{}", strength.name());
        }
    }
}
