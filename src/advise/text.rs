//! Advice as people read it.

use super::Advice;
use crate::effect::{Answer, Number};
use fem_core::plugin::{Dimension, digits};
use std::fmt;

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mass, velocity, plate, estimate, .. } = self;
        let name = self.impactor.as_ref().map_or(String::new(), |name| format!("{name}: "));
        let energy = 0.5 * mass * velocity * velocity;
        let (inside, a) = (plate.mass(), plate.rim.radius());
        writeln!(
            f,
            "  impact    {name}{} at {} = {} on {} inside the supports",
            Dimension::MASS.of(*mass),
            Dimension::VELOCITY.of(*velocity),
            Dimension::ENERGY.of(energy),
            Dimension::MASS.of(inside)
        )?;
        let held = plate.rim.held.map_or("does not surround the impact", |held| held.name());
        let circle = plate.rim.held.map_or(String::new(), |held| {
            let stiffness = held.circle_stiffness(plate.bending_stiffness, plate.poisson, a);
            format!(" (a circle of this area: {}/mm)", Dimension::FORCE.of(stiffness * 1e-3))
        });
        writeln!(
            f,
            "  edge      {held}; radius of a circle as large a = {}, {:.1} thicknesses",
            Dimension::LENGTH.of(a),
            a / plate.thickness
        )?;
        writeln!(
            f,
            "  plate     stiffness at rest Kb = {}/mm{circle}, D* = {} N m",
            Dimension::FORCE.of(plate.stiffness * 1e-3),
            digits(plate.bending_stiffness)
        )?;
        writeln!(
            f,
            "  expected  force up to {} after {}; deflection up to {} = {:.2} thicknesses until the march ends",
            Dimension::FORCE.of(estimate.force()),
            Dimension::TIME.of(estimate.time_of_peak),
            Dimension::LENGTH.of(estimate.deflection),
            estimate.deflection / plate.thickness
        )?;
        self.answers.iter().zip(1..).try_for_each(|(answer, number)| write_answer(f, answer, number))
    }
}

fn write_answer(f: &mut fmt::Formatter<'_>, answer: &Answer, number: usize) -> fmt::Result {
    writeln!(f, "\n  {number} {:<13} {}", answer.question, answer.choice)?;
    for Number { formula, value, threshold, source } in &answer.numbers {
        let line = format!("      {formula:<32} {value:<24} {threshold}");
        writeln!(f, "{}", line.trim_end())?;
        if !source.is_empty() {
            writeln!(f, "      {:<32} {source}", "")?;
        }
    }
    let cost = answer.cost.map(|cost| format!("with it {cost:.3} times the work"));
    let both: Vec<String> = answer.error.iter().cloned().chain(cost).collect();
    if both.is_empty() { Ok(()) } else { writeln!(f, "      {}: {}", answer.effect, both.join("; ")) }
}
