//! What mesh and step an impact asks for.

use super::cell_at;
use super::estimate::{Blow, Estimate, first_wave};
use super::held::Held;
use super::plate::PlateConstants;
use super::regime::{Regime, SMALL};
use crate::analyses::impact::ContactRecord;
use crate::effect::{Answer, Number};
use crate::model::{Model, Plan, Strike};
use fem_core::dof::Dof;
use fem_core::plugin::Dimension;
use fem_io::scene::ImpactorSpec;
use std::f64::consts::TAU;

/// Cells per wavelength by the degree of deflections in them: ten nodes, four cubic cells.
const LINEAR: f64 = 10.0;
const QUADRATIC: f64 = 5.0;
const CUBIC: f64 = 4.0;

/// Steps per period: an error of (2π/20)²/12 = 0.8 % in it by the trapezoidal rule.
const STEPS: f64 = 20.0;

/// Cells per wavelength under an impactor, of the frequency of its force: with N of them the force history of a small mass was wrong by
/// 0.6/N to 2.3/N, of `mitc4` and of `hermite-prism` (`docs/book/src/accuracy-statement.md`): what is round the patch of a force is
/// found to first order only, whatever the element.
const STRUCK_ERROR: f64 = 2.0;

/// How many times the cells that a wave needs elsewhere it needs there.
const STRUCK: f64 = 2.0;

/// A warning where cells are too large for the bending waves of a force with this frequency, Hz, that acts at `place`.
fn coarse(model: &Model, place: [f64; 2], frequency: f64) -> Option<String> {
    let stiffness = model.laminate.effective_bending_stiffness(&model.materials);
    let length = wavelength(stiffness / model.areal_mass, frequency);
    let (struck, widest, needed) = (cell_at(model, place), widest(model), needed(model));
    let (cell, cells, what) = match () {
        () if length < STRUCK * needed * struck => (struck, STRUCK * needed, "under the impactor"),
        () if length < needed * widest => (widest, needed, "where cells are largest"),
        () => return None,
    };
    let error = if cells > needed {
        format!(
            "the force over time may be wrong by up to about {:.0} %",
            100.0 * (STRUCK_ERROR * cell / length).min(1.0)
        )
    } else {
        "waves come back from there at a wrong time".to_owned()
    };
    Some(format!(
        "the contact force has a mean frequency of {}, whose bending wave of {} has {:.1} cells {what}: \
         {error}; cells of {} would do",
        Dimension::FREQUENCY.of(frequency),
        Dimension::LENGTH.of(length),
        length / cell,
        Dimension::LENGTH.of(length / cells)
    ))
}

/// A warning of cells that are too large for what a run of `model` excited.
pub fn warn_of_coarse_cells(model: &Model, contacts: &[ContactRecord]) -> Option<String> {
    let mut strikes = strikes(model).zip(contacts);
    strikes.find_map(|((_, strike), contact)| coarse(model, strike.centre, contact.frequency()?))
}

/// The same before a run, of impactors so small that the plate has no edges for them.
pub fn expect_coarse_cells(model: &Model) -> Option<String> {
    let stiffness = model.laminate.effective_bending_stiffness(&model.materials);
    strikes(model).filter(|(spec, _)| spec.mass <= SMALL * model.mass).find_map(|(spec, strike)| {
        let blow = Blow { mass: spec.mass, velocity: spec.velocity, time: f64::INFINITY, law: &*strike.law };
        coarse(model, strike.centre, first_wave(model.areal_mass, stiffness, &blow).0.frequency)
    })
}

fn strikes(model: &Model) -> impl Iterator<Item = (&ImpactorSpec, &Strike)> {
    let impact = match &model.plan {
        Plan::Impact(impact) => Some(impact),
        _ => None,
    };
    impact.into_iter().flat_map(|impact| impact.spec.impactors.iter().zip(&impact.strikes)).filter(|_| {
        // Neither a plate that follows its force at rest has waves, nor a section cells in the plane.
        model.moves() && !model.plate.info().is_section()
    })
}

/// Length of bending waves, m, of bending stiffness over mass per area, m⁴/s².
fn wavelength(ratio: f64, frequency: f64) -> f64 {
    TAU * ratio.sqrt().sqrt() / (TAU * frequency).sqrt()
}

/// Edge of a square as large as the largest cell, m.
fn widest(model: &Model) -> f64 {
    let mesh = &model.plate.plane;
    (0..mesh.quads.len()).map(|q| mesh.quality(q).area.sqrt()).fold(0.0, f64::max)
}

/// Cells per wavelength that the element needs.
fn needed(model: &Model) -> f64 {
    let has = |n, m| Dof::new(n, m).is_some_and(|dof| model.plate.info().dofs.contains(&dof));
    match (has(3, 1), model.plate.columns.len() > model.plate.plane.points.len()) {
        (true, _) => CUBIC,
        (_, true) => QUADRATIC,
        _ => LINEAR,
    }
}

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
        let ratio = plate.bending_stiffness / plate.areal_mass;
        let of_plate = third / plate.rim.radius().powi(2) * ratio.sqrt() / TAU;
        let frequency = match estimate.regime {
            Regime::SmallMass => of_contact,
            Regime::QuasiStatic => of_plate,
            Regime::Dynamic => of_contact.max(of_plate),
        };
        let wavelength = wavelength(ratio, frequency);
        Self {
            frequency,
            wavelength,
            cells: wavelength / widest(model),
            needed: needed(model),
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
                Number::new("f", Dimension::FREQUENCY.of(self.frequency))
                    .source("1/(2 time to peak) of the contact; third axisymmetric mode of the plate (Leissa 1969)"),
                Number::new("2 pi (D*/m)^(1/4)/sqrt(2 pi f)", Dimension::LENGTH.of(self.wavelength))
                    .source("length of bending waves"),
                Number::new("wavelength / cell", format!("{:.2}", self.cells))
                    .threshold(format!("{}: ten nodes, or four cubic cells", self.needed)),
                Number::new("step", Dimension::TIME.of(self.step))
                    .threshold(format!("{} = 1/(20 f)", Dimension::TIME.of(self.longest_step))),
            ],
            choice: format!("{mesh}, {step}{end}"),
            effect: "mesh and step as asked for",
            error: Some(format!("the step changes the period by {period:.1e}{coarse}")),
            cost: Some(cost),
        }
    }
}
