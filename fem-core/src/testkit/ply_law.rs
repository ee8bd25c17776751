//! The contract of a law of a ply.

use super::law::{Subject, Units, same_in};
use crate::contracts::plugin::Dimension;
use crate::contracts::ply_law::{LawError, LawPoint, PlyLaw, PlyResponse, check_law};
use crate::words::material::Material;
use crate::words::tensor::{Matrix6, Ply, Strain6, Stress6};

/// Components that change their sign in a mirror image along 1, 2 and 3.
const MIRRORS: [[f64; 6]; 3] =
    [[1.0, 1.0, 1.0, -1.0, 1.0, -1.0], [1.0, 1.0, 1.0, -1.0, -1.0, 1.0], [1.0, 1.0, 1.0, 1.0, -1.0, -1.0]];

/// Checks the law that `make` builds, its constants in the units that it is given, on `material` and in a cell of width
/// `length` (m), along a dozen of paths whose strains reach `largest` in each component.
///
/// Demanded along the paths: answers that are finite, and the same bit for bit when asked again; every state variable written;
/// a tangent that agrees with differences on one side at least; stored energy that is not negative, dissipated energy
/// that never falls, the sum of both equal to ∫ σ dε within 10⁻³ of the largest work; the same answer at the same strain once its state is taken over, and to several points at once.
///
/// Demanded besides: in a virgin point no stress, energy or state without strain, and the stiffness of the material
/// as tangent; NaN that comes back as no number or as an error; stresses and energies that follow a mirror image of the path
/// in each plane of symmetry of the ply; the same answers in other units; a virgin point that answers as at first, whatever
/// the law has seen before.
///
/// A law that wants [means](PlyLaw::means) is asked as a point alone and as a cell of one point, whose means are its own
/// quantities; of the latter neither the tangent nor the same answer once its state is taken over is demanded.
///
/// # Errors
/// The first violation, with the place on the path.
pub fn check_ply_law(
    make: impl Fn(&Units) -> Box<dyn PlyLaw>,
    material: &Material,
    length: f64,
    largest: &[f64; 6],
) -> Result<(), String> {
    let answers = |units: &Units, cell: bool| {
        let (law, material) = (make(units), units.material(material));
        let stiffness = material.elastic.stiffness();
        let length = units.number(length, Dimension::LENGTH);
        let point = LawPoint { material: &material, stiffness: &stiffness, length, thickness: length, means: &[] };
        check_law(law.info(), "under test", &point, law.check(&point)).map_err(|e| e.to_string())?;
        let respond = |strain: &[f64; 6], old: &[f64], new: &mut [f64], tangent: Option<&mut Matrix6>| {
            let (strain, mut means) = (Strain6::new(*strain), vec![f64::NAN; if cell { law.means() } else { 0 }]);
            if cell {
                law.quantities(&point, &strain, old, &mut means);
                means.extend_from_within(..if law.faces() { law.means() } else { 0 });
            }
            let point = LawPoint { means: &means, ..point };
            let mut tangent = tangent;
            let PlyResponse { stress, energy } = law.respond(&point, &strain, old, new, tangent.as_deref_mut())?;
            same_of_all(&*law, &point, (&strain, old), (&PlyResponse { stress, energy }, new, tangent.as_deref()))?;
            Ok((stress.0, [energy.stored, energy.dissipated, 0.0, 0.0]))
        };
        let subject = Subject { info: law.info(), largest: *largest, respond: &respond, cell };
        let tangent = subject.virgin_tangent()?;
        let scale = stiffness.as_flattened().iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        let differ = |(a, b): (&f64, &f64)| !((a - b).abs() <= 1e-9 * scale);
        if tangent.as_flattened().iter().zip(stiffness.as_flattened()).any(differ) {
            return Err(format!("the tangent of a virgin ply is {tangent:?}, its stiffness {stiffness:?}"));
        }
        subject.check(&MIRRORS)
    };
    let cells: &[bool] = if make(&Units::SI).means() > 0 { &[false, true] } else { &[false] };
    cells.iter().try_for_each(|cell| {
        same_in(&Units::ODD, &answers(&Units::SI, *cell)?, &answers(&Units::ODD, *cell)?, Dimension::PRESSURE)
    })
}

/// Whether the law answers the same where it is asked about several points.
fn same_of_all(
    law: &dyn PlyLaw,
    point: &LawPoint<'_>,
    (strain, old): (&Strain6<Ply>, &[f64]),
    (answer, new, tangent): (&PlyResponse, &[f64], Option<&Matrix6>),
) -> Result<(), LawError> {
    let (mut answers, mut left) =
        ([PlyResponse { stress: Stress6::new([f64::NAN; 6]), ..*answer }; 2], vec![f64::NAN; 2 * new.len()]);
    let mut tangents = vec![[[f64::NAN; 6]; 6]; if tangent.is_some() { 2 } else { 0 }];
    law.respond_all(point, &[*strain, *strain], (&old.repeat(2), &mut left), &mut answers, &mut tangents)?;
    let numbers = |answer: &PlyResponse, new: &[f64], tangent: Option<&Matrix6>| {
        let energy = [answer.energy.stored, answer.energy.dissipated];
        let tangent = tangent.map_or(&[][..], |tangent| tangent.as_flattened());
        [&answer.stress.0[..], &energy, new, tangent].concat()
    };
    let one = numbers(answer, new, tangent);
    let differs = (0..2).any(|k| {
        let own = numbers(&answers[k], &left[k * new.len()..(k + 1) * new.len()], tangents.get(k));
        own.iter().zip(&one).any(|(a, b)| a != b && !(a.is_nan() && b.is_nan()))
    });
    if differs {
        Err(LawError("asked about two points at once it answers otherwise than about one".into()))
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests;
