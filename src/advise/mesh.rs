//! What mesh and step an impact asks for.

use super::estimate::{Blow, Estimate};
use super::held::Held;
use super::plate::PlateConstants;
use super::regime::Regime;
use crate::effect::{Answer, Number};
use crate::model::Model;
use fem_core::dof::Dof;
use std::f64::consts::TAU;

/// Cells per wavelength by the degree of deflections in them: ten nodes, four cubic cells.
const LINEAR: f64 = 10.0;
const QUADRATIC: f64 = 5.0;
const CUBIC: f64 = 4.0;

/// Steps per period: an error of (2π/20)²/12 = 0.8 % in it by the trapezoidal rule.
const STEPS: f64 = 20.0;

/// Mesh and step of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Highest frequency that matters, Hz.
    pub frequency: f64,
    /// Length of its bending wave, m.
    pub wavelength: f64,
    /// Cells per wavelength where cells are largest.
    pub cells: f64,
    /// Cells per wavelength that the element needs.
    pub needed: f64,
    /// Step of the scene, s.
    pub step: f64,
    /// Longest step that resolves the frequency, s.
    pub longest_step: f64,
}

impl Resolution {
    pub(super) fn new(model: &Model, plate: &PlateConstants, step: f64, estimate: &Estimate) -> Self {
        // A rise to the peak is a quarter of a period on a half-space, less of one on a plate.
        let of_contact = 1.0 / (2.0 * estimate.wave.time);
        let third = plate.rim.held.unwrap_or(Held { slope: false, in_plane: false }).third_mode();
        let root = (plate.bending_stiffness / plate.areal_mass).sqrt();
        let of_plate = third / plate.rim.radius().powi(2) * root / TAU;
        let frequency = match estimate.regime {
            Regime::SmallMass => of_contact,
            Regime::QuasiStatic => of_plate,
            Regime::Dynamic => of_contact.max(of_plate),
        };
        let wavelength = TAU * root.sqrt() / (TAU * frequency).sqrt();
        let mesh = &model.plate.plane;
        let widest = (0..mesh.quads.len()).map(|q| mesh.quality(q).area.sqrt()).fold(0.0, f64::max);
        let has = |n, m| Dof::new(n, m).is_some_and(|dof| model.plate.info().dofs.contains(&dof));
        let needed = match (has(3, 1), model.plate.columns.len() > mesh.points.len()) {
            (true, _) => CUBIC,
            (_, true) => QUADRATIC,
            _ => LINEAR,
        };
        Self {
            frequency,
            wavelength,
            cells: wavelength / widest,
            needed,
            step,
            longest_step: 1.0 / (STEPS * frequency),
        }
    }

    /// Whether cells are small enough.
    pub fn fine_enough(&self) -> bool {
        self.cells >= self.needed
    }

    /// Whether steps are short enough.
    pub fn short_enough(&self) -> bool {
        self.step <= self.longest_step
    }

    /// By what cells and steps should be shorter, at least 1.
    pub(super) fn lacking(&self) -> [f64; 2] {
        [(self.needed / self.cells).max(1.0), (self.step / self.longest_step).max(1.0)]
    }

    pub(super) fn answer(&self, blow: &Blow<'_>, estimate: &Estimate, cost: f64) -> Answer {
        let mesh =
            if self.fine_enough() { "the mesh is fine enough" } else { "the mesh is too coarse for these waves" };
        let step = if self.short_enough() { "the step short enough" } else { "the step too long" };
        let end = if blow.time < estimate.time_of_peak { "; the march ends before the peak" } else { "" };
        let period = (TAU * self.frequency * self.step).powi(2) / 12.0;
        let coarse = if self.fine_enough() { "" } else { "; the mesh cannot carry the shortest waves" };
        Answer {
            question: "mesh and step",
            numbers: vec![
                Number::new("f", format!("{:.1} Hz", self.frequency))
                    .source("1/(2 time to peak) of the contact; third axisymmetric mode of the plate (Leissa 1969)"),
                Number::new("2 pi (D*/m)^(1/4)/sqrt(2 pi f)", format!("{:.3} mm", 1e3 * self.wavelength))
                    .source("length of bending waves"),
                Number::new("wavelength / cell", format!("{:.2}", self.cells))
                    .threshold(format!("{}: ten nodes, or four cubic cells", self.needed)),
                Number::new("step", format!("{:.4} us", 1e6 * self.step))
                    .threshold(format!("{:.4} us = 1/(20 f)", 1e6 * self.longest_step)),
            ],
            choice: format!("{mesh}, {step}{end}"),
            effect: "mesh and step as asked for",
            error: Some(format!("the step changes the period by {period:.1e}{coarse}")),
            cost: Some(cost),
        }
    }
}
