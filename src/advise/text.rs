//! Advice as people read it.

use super::Advice;
use crate::effect::{Answer, Number};
use std::fmt;

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mass, velocity, plate, estimate, .. } = self;
        let name = self.impactor.as_ref().map_or(String::new(), |name| format!("{name}: "));
        let energy = 0.5 * mass * velocity * velocity;
        let (inside, a) = (plate.mass() * 1e3, plate.rim.radius());
        writeln!(
            f,
            "  impact    {name}{mass:.4} kg at {velocity:.4} m/s = {energy:.4} J on {inside:.4} g inside the supports"
        )?;
        let held = plate.rim.held.map_or("does not surround the impact", |held| held.name());
        let circle = plate.rim.held.map_or(String::new(), |held| {
            let stiffness = held.circle_stiffness(plate.bending_stiffness, plate.poisson, a);
            format!(" (a circle of this area: {:.2} N/mm)", stiffness * 1e-3)
        });
        writeln!(
            f,
            "  edge      {held}; radius of a circle as large a = {:.4} mm, {:.1} thicknesses",
            a * 1e3,
            a / plate.thickness
        )?;
        writeln!(
            f,
            "  plate     stiffness at rest Kb = {:.2} N/mm{circle}, D* = {:.4} N m",
            plate.stiffness * 1e-3,
            plate.bending_stiffness
        )?;
        writeln!(
            f,
            "  expected  force up to {:.1} N after {:.4} ms; deflection up to {:.4} mm = {:.2} thicknesses until the march ends",
            estimate.force(),
            estimate.time_of_peak * 1e3,
            estimate.deflection * 1e3,
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
