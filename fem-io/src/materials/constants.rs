//! The constants of a material.

use crate::document::keys::{Form, Key, Keys, key};
use crate::document::reader::Reader;
use crate::document::source::SceneError;
use crate::units::SHEAR_ALPHA;
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};
use fem_core::plugin::{Dimension, Kind};

/// The keys of a material: where its constants come from, then the constants themselves.
pub(crate) const KEYS: Keys = &[
    key("library", Form::Library, r#""AS4/3502""#, "a material of the library; constants given here override its own"),
    key("file", Form::Text, r#""materials.toml""#, "a file of materials in the format of the library"),
    key("name", Form::Text, r#""my tape""#, "which material of `file`"),
    key(
        "law",
        Form::OneOf(&[Form::PluginName(Kind::PlyLaw), Form::Plugin(Kind::PlyLaw, "name", &[])]),
        r#"{ name = "hahn-tsai", alpha = "2.4e-8 1/MPa^3" }"#,
        "law that its plies follow beyond linear elasticity; without one they are linear elastic",
    ),
    stress("e", r#""70 GPa""#, "Young's modulus of an isotropic material"),
    key("nu", Form::Number, "0.3", "Poisson's ratio of an isotropic material"),
    stress("e1", r#""130.3 GPa""#, "Young's modulus along the fibres"),
    stress("e2", r#""9.65 GPa""#, "Young's modulus across the fibres, in the plane of the ply"),
    stress("e3", r#""9.65 GPa""#, "Young's modulus through the thickness"),
    key("nu12", Form::Number, "0.35", "Poisson's ratio: contraction along 2 under tension along 1"),
    key("nu13", Form::Number, "0.35", "Poisson's ratio: contraction along 3 under tension along 1"),
    key("nu23", Form::Number, "0.40", "Poisson's ratio: contraction along 3 under tension along 2"),
    stress("g12", r#""5.93 GPa""#, "shear modulus in the plane of the ply"),
    stress("g13", r#""5.93 GPa""#, "shear modulus 13"),
    stress("g23", r#""3.45 GPa""#, "shear modulus 23"),
    key(
        "shear_alpha",
        Form::Quantity(SHEAR_ALPHA),
        r#""2.98e-8 1/MPa^3""#,
        "of the curve gamma12 = tau/G12 + shear_alpha tau^3, for `laminate.strengths`; 0 if it is straight",
    ),
    expansion_key("alpha", r#""23e-6 1/K""#, "thermal expansion, the same along all axes"),
    expansion_key("alpha1", r#""-1e-6 1/K""#, "thermal expansion along the fibres"),
    expansion_key("alpha2", r#""26e-6 1/K""#, "thermal expansion across the fibres"),
    expansion_key("alpha3", r#""26e-6 1/K""#, "thermal expansion through the thickness; as alpha2 if left out"),
    key("density", Form::Quantity(Dimension::DENSITY), r#""1.575 g/cm^3""#, "mass per volume"),
    stress("Xt", r#""1793 MPa""#, "tensile strength along the fibres"),
    stress("Xc", r#""1724 MPa""#, "compressive strength along the fibres"),
    stress("Yt", r#""64 MPa""#, "tensile strength across the fibres"),
    stress("Yc", r#""138 MPa""#, "compressive strength across the fibres"),
    stress("S12", r#""109 MPa""#, "shear strength in the plane of the ply"),
    stress("S23", r#""69 MPa""#, "shear strength 23"),
    stress("Zt", r#""60 MPa""#, "tensile strength through the thickness"),
    stress("Zc", r#""138 MPa""#, "compressive strength through the thickness"),
    stress("S13", r#""90 MPa""#, "shear strength 13"),
    energy("GIc", r#""0.28 N/mm""#, "toughness of the interfaces in mode I"),
    energy("GIIc", r#""0.8 N/mm""#, "toughness of the interfaces in mode II"),
    key(
        "eta",
        Form::Number,
        "1.45",
        "Benzeggagh and Kenane's exponent: toughness of the interfaces between modes I and II",
    ),
    energy("Gft", r#""81.5 N/mm""#, "toughness of the ply: fibres that break in tension"),
    energy("Gfc", r#""106 N/mm""#, "toughness of the ply: fibres that kink in compression"),
    energy("Gmt", r#""0.28 N/mm""#, "toughness of the ply: a crack along the fibres that opens"),
    energy("Gmc", r#""1.3 N/mm""#, "toughness of the ply: compression across the fibres"),
    energy(
        "Gms",
        r#""0.8 N/mm""#,
        "toughness of the ply: a crack along the fibres that is sheared; without it that of tension or compression across them",
    ),
];

/// The keys of constants.
pub(crate) const CONSTANTS: Keys = KEYS.split_at(4).1;

const fn stress(name: &'static str, example: &'static str, about: &'static str) -> Key {
    key(name, Form::Quantity(Dimension::PRESSURE), example, about)
}

const fn energy(name: &'static str, example: &'static str, about: &'static str) -> Key {
    key(name, Form::Quantity(Dimension::TOUGHNESS), example, about)
}

const fn expansion_key(name: &'static str, example: &'static str, about: &'static str) -> Key {
    key(name, Form::Quantity(Dimension::EXPANSION), example, about)
}

const ELASTIC: &str = "give e and nu (isotropic), or e1, e2, nu12, nu23, g12 (isotropic across the fibres), \
                       or all nine of e1, e2, e3, nu12, nu13, nu23, g12, g13, g23";

/// A material from its constants alone.
pub(crate) fn from_constants(name: &str, table: &Reader<'_>) -> Result<Material, SceneError> {
    let elastic = elastic(table)?;
    let optional = |key, dimension| table.optional(key).map(|field| field.positive(dimension)).transpose();
    let mut strengths = Strengths::default();
    for &strength in Strength::ALL {
        if let Some(pascals) = optional(strength.name(), Dimension::PRESSURE)? {
            strengths = strengths.with(strength, pascals);
        }
    }
    let density = optional("density", Dimension::DENSITY)?;
    let mut toughness = Toughnesses::default();
    for &which in Toughness::ALL {
        if let Some(energy) = optional(which.name(), Dimension::TOUGHNESS)? {
            toughness = toughness.with(which, energy);
        }
    }
    let eta = table.optional("eta").map(|field| field.number()).transpose()?;
    let expansion = expansion(table)?;
    let material = Material { name: name.to_owned(), elastic, density, strengths, toughness, eta, expansion };
    match material.check() {
        Ok(()) => Ok(material),
        Err(e) => {
            Err(table.error(e.to_string(), "no solid has these constants: look for a typing error in one of them"))
        }
    }
}

/// Thermal expansion: one for all axes, or one along and one across the fibres, and a third through the thickness where it
/// differs.
fn expansion(table: &Reader<'_>) -> Result<Option<[f64; 3]>, SceneError> {
    const WANTED: &str =
        "give alpha (the same along all axes), or alpha1, alpha2 and, where it differs from alpha2, alpha3";
    let given = |key| table.optional(key).map(|field| Ok((field.quantity(Dimension::EXPANSION)?, field))).transpose();
    match (given("alpha")?, given("alpha1")?, given("alpha2")?, given("alpha3")?) {
        (None, None, None, None) => Ok(None),
        (Some((all, _)), None, None, None) => Ok(Some([all; 3])),
        (None, Some((along, _)), Some((across, _)), third) => Ok(Some([along, across, third.map_or(across, |t| t.0)])),
        (Some((_, stray)), ..) => Err(stray.error("cannot be combined with alpha1, alpha2, alpha3", WANTED)),
        (None, Some((_, stray)), None, _)
        | (None, None, Some((_, stray)), _)
        | (None, None, None, Some((_, stray))) => {
            Err(stray.error("does not say how the material expands along its other axes", WANTED))
        }
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
            Some(stray) => Err(constant(stray)?.error("cannot be combined with e and nu", ELASTIC)),
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
    fn every_constant_that_a_criterion_or_a_law_may_ask_for_can_be_given() {
        let strengths = Strength::ALL.iter().map(|s| s.name());
        for name in strengths.chain(Toughness::ALL.iter().map(|t| t.name())) {
            assert!(CONSTANTS.iter().any(|key| key.name == name), "{name}");
        }
    }
}
