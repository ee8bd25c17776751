//! What the contact does to an impact.

use super::estimate::{Blow, Estimate};
use super::plate::PlateConstants;
use crate::effect::{Answer, Number};
use fem_core::contact::{Branches, ContactForce, ContactHistory, ContactLaw};
use fem_core::energy::Energy;
use fem_core::plugin::Dimension;
use fem_io::scene::ContactLoad;
use std::f64::consts::PI;

/// Shares of the energy in the contact: below the first the law hardly matters, above the second it rules.
const LITTLE: f64 = 0.05;
const MUCH: f64 = 0.20;

/// Contact radius over the edge of a cell beyond which the force spreads over several of them, and over the thickness beyond
/// which a plate is not a half-space.
const CELL: f64 = 0.5;
const HALF_SPACE: f64 = 1.0;

/// The contact of an impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Energy in the contact at the peak over that of the impact.
    pub share: f64,
    /// Change of the largest force, relative, by a contact twice as stiff.
    pub sensitivity: f64,
    /// Largest indentation, m.
    pub indentation: f64,
    /// Dent that it leaves, m.
    pub dent: f64,
    /// Energy that the contact keeps, over that of the impact.
    pub lost: f64,
    /// Radius over which the force acts in the model, m; 0 at a node.
    pub radius: f64,
    /// Edge of the cell there, m.
    pub cell: f64,
}

impl Contact {
    pub(super) fn new(
        plate: &PlateConstants,
        blow: &Blow<'_>,
        estimate: &Estimate,
        load: ContactLoad,
        cell: f64,
    ) -> Self {
        let stiffer = Twice(blow.law);
        let again = Estimate::new(plate, &Blow { law: &stiffer, ..*blow });
        // In the same regime: a law twice as stiff may lie beyond a border of it.
        let other = Estimate { regime: estimate.regime, ..again };
        let mut history = ContactHistory::default();
        blow.law.commit(&mut history, estimate.indentation);
        Self {
            share: estimate.contact_share,
            sensitivity: other.force() / estimate.force() - 1.0,
            indentation: estimate.indentation,
            dent: blow.law.branches(&history).touch,
            lost: blow.law.energy(&history, estimate.indentation).dissipated / blow.energy(),
            radius: match load {
                ContactLoad::Node => 0.0,
                ContactLoad::Patch { radius } => radius,
                ContactLoad::Tip { radius } => ContactLoad::OF_TIP * radius,
                ContactLoad::Square { side } => side / PI.sqrt(),
            },
            cell,
        }
    }

    pub(super) fn answer(&self, plate: &PlateConstants) -> Answer {
        let law = match self.share {
            share if share < LITTLE => "any stiffness within a factor of two will do",
            share if share <= MUCH => "the contact stiffness matters",
            _ => "the contact law governs the force: calibrate it",
        };
        let unloading = if self.dent > 0.0 { "a dent remains: unloading matters after the peak" } else { "no dent" };
        let place = match self.radius {
            0.0 => "at a node the force is singular: use a patch",
            radius if radius > CELL * self.cell => "the patch spreads over cells",
            _ => "the patch lies within a cell: a node would do",
        };
        let half_space =
            if self.radius > HALF_SPACE * plate.thickness { " and is wider than the plate is thick" } else { "" };
        Answer {
            question: "contact",
            numbers: vec![
                Number::new("E_contact / E", format!("{:.2} %", 100.0 * self.share))
                    .threshold(format!("little below {:.0} %, much above {:.0} %", 100.0 * LITTLE, 100.0 * MUCH))
                    .source("work of the law at the peak; (2/5) F^(5/3)/k^(2/3) for Hertz"),
                Number::new("dent", Dimension::LENGTH.of(self.dent))
                    .threshold(format!("0; indentation {}", Dimension::LENGTH.of(self.indentation)))
                    .source("of the law: 0 up to its critical indentation"),
                Number::new("E_lost / E", format!("{:.2} %", 100.0 * self.lost)).source("of the law, from the peak on"),
                Number::new("radius / cell", format!("{:.2}", self.radius / self.cell))
                    .threshold(format!("{CELL}: node or patch"))
                    .source("radius of the scene's patch; sqrt(R a) of a sphere"),
                Number::new("radius / h", format!("{:.2}", self.radius / plate.thickness))
                    .threshold(format!("{HALF_SPACE}: beyond it a plate is not the half-space of Hertz's law")),
            ],
            choice: format!("{law}; {unloading}; {place}{half_space}"),
            effect: "contact law",
            error: Some(format!("twice as stiff it changes the force by {:+.1} %", 100.0 * self.sensitivity)),
            cost: Some(1.0),
        }
    }
}

/// A law with twice the force.
#[derive(Debug, Clone)]
struct Twice<'a>(&'a dyn ContactLaw);

impl ContactLaw for Twice<'_> {
    fn force(&self, history: &ContactHistory, alpha: f64) -> ContactForce {
        let ContactForce { force, tangent } = self.0.force(history, alpha);
        ContactForce { force: 2.0 * force, tangent: 2.0 * tangent }
    }

    fn commit(&self, history: &mut ContactHistory, alpha: f64) {
        self.0.commit(history, alpha);
    }

    fn energy(&self, history: &ContactHistory, alpha: f64) -> Energy {
        let Energy { stored, dissipated } = self.0.energy(history, alpha);
        Energy { stored: 2.0 * stored, dissipated: 2.0 * dissipated }
    }

    fn branches(&self, history: &ContactHistory) -> Branches {
        self.0.branches(history)
    }
}
