//! Whether a plate shears, and whether its thickness must be resolved.

use super::plate::PlateConstants;
use crate::effect::{Answer, Number};
use std::f64::consts::PI;

/// D*/(κ G h a²) from which on elements must be flexible in shear.
const FLEXIBLE: f64 = 0.01;

/// Contact radius over thickness, and thickness over the radius of the plate, from which on stresses are those of a solid.
const PATCH: f64 = 0.3;
const THICK: f64 = 0.2;

/// Shear of an impact. Thresholds are working rules without a source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shear {
    /// D*/(κ G h a²).
    pub number: f64,
    /// Part of the deflection under the impactor that shear makes, about.
    pub share: f64,
    /// Radius of the contact over the thickness.
    pub patch: f64,
    /// Thickness over the radius of the plate.
    pub thick: f64,
    /// Whether the element is a shell.
    pub shell: bool,
}

impl Shear {
    /// w_s = F/(4 π κ G h) (1 + 2 ln(a/a_c)) is the deflection by shear of a circle of radius a under a uniform pressure
    /// within a_c.
    pub(super) fn new(plate: &PlateConstants, contact_radius: f64, shell: bool) -> Self {
        let (h, a) = (plate.thickness, plate.rim.radius());
        // At a point the deflection by shear has no limit; a force at a node spreads over about a thickness in a real plate.
        let spread = if contact_radius > 0.0 { contact_radius.min(a) } else { h.min(a) };
        let flexibility = (1.0 + 2.0 * (a / spread).ln()) / (4.0 * PI * plate.shear_stiffness);
        Self {
            number: plate.bending_stiffness / (plate.shear_stiffness * a * a),
            share: (flexibility * plate.stiffness).min(1.0),
            patch: contact_radius / h,
            thick: h / a,
            shell,
        }
    }

    /// Whether elements must be flexible in shear.
    pub fn flexible(&self) -> bool {
        self.number > FLEXIBLE
    }

    /// Whether stresses near the contact are those of a solid.
    pub fn solid(&self) -> bool {
        self.patch > PATCH || self.thick > THICK
    }

    pub(super) fn answer(&self, cost: f64) -> Answer {
        let deflection = if self.flexible() { "shear-flexible elements" } else { "a thin plate would do" };
        let stresses = match (self.solid(), self.shell) {
            (true, true) => "stresses near the contact need solid elements, and the scene has a shell",
            (true, false) => "stresses near the contact need solid elements",
            (false, _) => "a shell gives the stresses",
        };
        let percent = 100.0 * self.share;
        Answer {
            question: "shear",
            numbers: vec![
                Number::new("Kb/(4 pi kG h) (1+2 ln(a/r))", format!("{:.4}", self.share))
                    .source("share of shear in the deflection; circle under a uniform pressure within r"),
                Number::new("D*/(kappa G h a^2)", format!("{:.5}", self.number))
                    .threshold(format!("{FLEXIBLE}: elements flexible in shear"))
                    .source("working rule"),
                Number::new("radius / h", format!("{:.2}", self.patch))
                    .threshold(format!("{PATCH}: solid"))
                    .source("working rule"),
                Number::new("h / a", format!("{:.3}", self.thick))
                    .threshold(format!("{THICK}: solid"))
                    .source("working rule"),
            ],
            choice: format!("{deflection}; {stresses}"),
            effect: "shear in solids rather than a shell",
            error: Some(format!("shear makes about {percent:.1} % of the deflection")),
            cost: (!self.shell).then_some(cost),
        }
    }
}
