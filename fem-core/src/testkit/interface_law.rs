//! The contract of a law of an interface.

use super::law::{Subject, Units, same_in};
use crate::contracts::interface_law::{InterfaceLaw, InterfaceResponse, Jump};
use crate::contracts::plugin::Dimension;
use crate::contracts::ply_law::{LawError, LawPoint, check_law};
use crate::words::material::Material;

/// Components that change their sign in a mirror image along either axis of the plane.
const MIRRORS: [Jump; 2] = [[1.0, -1.0, 1.0], [1.0, 1.0, -1.0]];

/// Checks a law of an interface as [`check_ply_law`](super::check_ply_law) checks one of a ply, along paths of jumps that reach
/// `largest` (m) in each component, and as deep into each other.
///
/// The tangent of a virgin interface is free; energies are per area, and what is dissipated in each sink never falls and is
/// what the state says.
///
/// # Errors
/// The first violation, with the place on the path.
pub fn check_interface_law(
    make: impl Fn(&Units) -> Box<dyn InterfaceLaw>,
    material: &Material,
    length: f64,
    largest: &Jump,
) -> Result<(), String> {
    let answers = |units: &Units| {
        let (law, material) = (make(units), units.material(material));
        let stiffness = material.elastic.stiffness();
        let length = units.number(length, Dimension::LENGTH);
        let point = LawPoint { material: &material, stiffness: &stiffness, length, thickness: 0.0, means: &[] };
        check_law(law.info(), "under test", &point, law.check(&point)).map_err(|e| e.to_string())?;
        let respond = |jump: &Jump, old: &[f64], new: &mut [f64], tangent: Option<&mut [Jump; 3]>| {
            let InterfaceResponse { traction, stored, dissipated } = law.respond(&point, jump, old, new, tangent)?;
            if law.dissipated(new) != dissipated {
                return Err(LawError("what its state says that it dissipated is not what it answered".into()));
            }
            Ok((traction, [stored, dissipated.opening, dissipated.shear, dissipated.friction]))
        };
        let largest = largest.map(|v| units.number(v, Dimension::LENGTH));
        Subject { info: law.info(), largest, respond: &respond, cell: false }.check(&MIRRORS)
    };
    same_in(&Units::ODD, &answers(&Units::SI)?, &answers(&Units::ODD)?, Dimension::TOUGHNESS)
}

#[cfg(test)]
mod tests;
