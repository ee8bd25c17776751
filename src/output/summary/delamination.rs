//! Delaminations that have grown, in figures.

use super::ImpactFigures;
use crate::analyses::impact::Outcome;
use fem_core::interface_law::Sinks;
use serde::Serialize;

/// Delaminations that have grown: their areas, what they took, what the impactors lost altogether.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct DelaminationFigures {
    pub projected_area_mm2: f64,
    pub area_mm2: f64,
    pub dissipated_J: f64,
    pub dissipated_by_opening_J: f64,
    pub dissipated_by_shear_J: f64,
    pub dissipated_by_friction_J: f64,
    pub absorbed_J: f64,
    pub cells: usize,
    pub interfaces: Vec<InterfaceFigures>,
}

/// An interface, by the plies that it lies between.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct InterfaceFigures {
    pub interface: String,
    pub area_mm2: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub since_s: Option<f64>,
}

impl DelaminationFigures {
    pub(super) fn of(outcome: &Outcome, impact: &[ImpactFigures]) -> Option<Self> {
        let grown = outcome.delaminated.as_ref()?;
        let Sinks { opening, shear, friction } = grown.dissipated;
        let left = |f: &ImpactFigures| f.energy_J - 0.5 * f.mass_kg * f.final_impactor_velocity_m_s.powi(2);
        let interfaces = grown.interfaces.iter().map(|one| InterfaceFigures {
            interface: format!("{}|{}", one.below, one.below + 1),
            area_mm2: one.area * 1e6,
            since_s: one.since,
        });
        Some(Self {
            projected_area_mm2: grown.projected * 1e6,
            area_mm2: grown.interfaces.iter().map(|one| one.area * 1e6).sum(),
            dissipated_J: grown.dissipated.total(),
            dissipated_by_opening_J: opening,
            dissipated_by_shear_J: shear,
            dissipated_by_friction_J: friction,
            absorbed_J: impact.iter().map(left).sum(),
            cells: grown.cells.len(),
            interfaces: interfaces.collect(),
        })
    }
}
