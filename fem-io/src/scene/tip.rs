//! What an impactor is in terms of a test: its energy for its velocity, its tip for a contact law.

use super::laminate::LaminateSpec;
use super::material;
use super::plugin::PluginSpec;
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Located, SceneError};
use fem_core::laminate::Laminate;
use fem_core::material::Material;
use fem_core::plugin::{Dimension, Value};

/// The plate that an impactor strikes.
pub(super) struct Struck<'a> {
    pub(super) materials: &'a [Located<Material>],
    /// Those of its regions; where an impactor strikes is known with the mesh.
    pub(super) laminates: &'a [LaminateSpec],
}

impl Struck<'_> {
    /// What `of` says of all laminates, where it says the same of each; `None` where it does not.
    fn alike(&self, of: impl Fn(&Laminate) -> f64) -> Option<f64> {
        let mut each = self.laminates.iter().map(|spec| of(&spec.laminate.value));
        let first = each.next()?;
        each.all(|other| (other / first - 1.0).abs() < SAME).then_some(first)
    }
}

/// Standard acceleration of free fall, m/s² (3rd CGPM, 1901).
const GRAVITY: f64 = 9.80665;

/// Difference of two moduli of an isotropic material, or of two laminates, that is rounding, relative.
const SAME: f64 = 1e-6;

/// The velocity, m/s, and the field that says it: itself, v = √(2 E/m) of an energy or of one per thickness of the laminate, or
/// v = √(2 g h) of a fall without friction.
pub(super) fn velocity<'a>(
    table: &Reader<'a>,
    mass: f64,
    struck: &Struck<'_>,
) -> Result<(SceneValue<'a>, f64), SceneError> {
    match table.either(["velocity", "energy", "drop_height"])? {
        [Some(field), ..] => {
            let velocity = field.positive(Dimension::VELOCITY)?;
            Ok((field, velocity))
        }
        [None, Some(field), _] => {
            let (value, dimension) = field.any_quantity(field.text()?)?;
            let energy = match dimension {
                of if of.matches(&Dimension::ENERGY) => value,
                of if of.matches(&Dimension::FORCE) => {
                    let thickness = struck.alike(Laminate::thickness).ok_or_else(|| {
                        let message =
                            "an energy per thickness is of one thickness, and the laminates of the scene have several";
                        field.error(message, "give the energy itself: \"28 J\"")
                    })?;
                    value * thickness
                }
                of => {
                    let message = format!("is an energy or an energy per thickness, not {of}");
                    return Err(field.error(message, "write \"28 J\" or \"6.7 J/mm\""));
                }
            };
            if !(energy > 0.0) {
                return Err(field.error("must be positive", "write \"28 J\" or \"6.7 J/mm\""));
            }
            Ok((field, (2.0 * energy / mass).sqrt()))
        }
        [None, None, Some(field)] => {
            let height = field.positive(Dimension::LENGTH)?;
            Ok((field, (2.0 * GRAVITY * height).sqrt()))
        }
        [None, None, None] => Err(table.missing("velocity", "write velocity = \"1.56 m/s\", or energy = \"6.7 J/mm\"")),
    }
}

/// Hertz's law of a spherical tip on the laminate, and the field of its diameter, where a scene gives the tip.
///
/// The modulus across the laminate is that of its plies in series, 1/E = Σ (hᵢ/h)/E₃ᵢ.
pub(super) fn law<'a>(
    table: &Reader<'a>,
    struck: &Struck<'_>,
) -> Result<Option<(PluginSpec, SceneValue<'a>)>, SceneError> {
    let (diameter, named) = match (table.optional("diameter"), table.optional("material")) {
        (None, None) => return Ok(None),
        (Some(diameter), Some(named)) => (diameter, named),
        (Some(_), None) => return Err(table.missing("material", "name the material of the tip: material = \"steel\"")),
        (None, Some(_)) => return Err(table.missing("diameter", "give that of the tip: diameter = \"16 mm\"")),
    };
    let tip = &struck.materials[material::find(&named, struck.materials)?].value;
    let [e, others] = [tip.elastic.e1, tip.elastic.e2.min(tip.elastic.e3)];
    if (others / e - 1.0).abs() > SAME {
        let message = format!("`{}` is not isotropic", tip.name);
        return Err(named.error(message, "a tip has one modulus, as metals have: steel = { library = \"steel\" }"));
    }
    let across = struck.alike(|laminate| {
        let e3 = |material: usize| struck.materials[material].value.elastic.e3;
        let compliance: f64 = laminate.plies.iter().map(|ply| ply.thickness / e3(ply.material)).sum();
        laminate.thickness() / compliance
    });
    let across = across.ok_or_else(|| {
        let message = "the laminates of the scene differ in their stiffness across the plies, of which Hertz's law has one";
        let help = "write contact = { law = \"hertz\", radius = ..., e_tip = ..., nu_tip = ..., e_plate = ... } with that of the struck one";
        diameter.error(message, help)
    })?;
    let radius = 0.5 * diameter.positive(Dimension::LENGTH)?;
    let values = [
        ("radius", Value::Text(format!("{radius} m"))),
        ("e_tip", Value::Text(format!("{e} Pa"))),
        ("nu_tip", Value::Number(tip.elastic.nu12)),
        ("e_plate", Value::Text(format!("{across} Pa"))),
    ];
    Ok(Some((PluginSpec::made("hertz", values, &diameter), diameter)))
}
