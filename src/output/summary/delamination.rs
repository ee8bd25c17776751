//! Delaminations that have grown, in figures.

use super::ImpactFigures;
use crate::analyses::delamination::Delaminated;
use crate::analyses::impact::Outcome;
use fem_core::interface_law::Sinks;
use fem_core::plugin::Dimension;
use serde::Serialize;

/// Delaminations that have grown: their areas, what they took, what impactors lost altogether.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct DelaminationFigures {
    pub projected_area_mm2: f64,
    pub area_mm2: f64,
    pub dissipated_J: f64,
    pub dissipated_by_opening_J: f64,
    pub dissipated_by_shear_J: f64,
    pub dissipated_by_friction_J: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub absorbed_J: Option<f64>,
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
    pub(super) fn of_impact(outcome: &Outcome, impact: &[ImpactFigures]) -> Option<Self> {
        let absorbed = Some(impact.iter().map(|of| of.absorbed_energy_J).sum());
        outcome.delaminated.as_ref().map(|grown| Self { absorbed_J: absorbed, ..Self::of(grown) })
    }

    /// Of loads at rest.
    pub(crate) fn of(grown: &Delaminated) -> Self {
        let Sinks { opening, shear, friction } = grown.dissipated;
        let interfaces = grown.interfaces.iter().map(|one| InterfaceFigures {
            interface: format!("{}|{}", one.below, one.below + 1),
            area_mm2: one.area * 1e6,
            since_s: one.since,
        });
        Self {
            projected_area_mm2: grown.projected * 1e6,
            area_mm2: grown.interfaces.iter().map(|one| one.area * 1e6).sum(),
            dissipated_J: grown.dissipated.total(),
            dissipated_by_opening_J: opening,
            dissipated_by_shear_J: shear,
            dissipated_by_friction_J: friction,
            absorbed_J: None,
            cells: grown.cells.len(),
            interfaces: interfaces.collect(),
        }
    }

    /// As people read it, a line each.
    pub(crate) fn lines(&self) -> Vec<String> {
        let absorbed =
            self.absorbed_J.map_or(String::new(), |energy| format!(", {} absorbed", Dimension::ENERGY.of(energy)));
        let all = format!(
            "  delam.    {} projected, {} of all interfaces; {} dissipated in them ({} by friction){absorbed}",
            Dimension::AREA.of(self.projected_area_mm2 * 1e-6),
            Dimension::AREA.of(self.area_mm2 * 1e-6),
            Dimension::ENERGY.of(self.dissipated_J),
            Dimension::ENERGY.of(self.dissipated_by_friction_J),
        );
        let each = self.interfaces.iter().filter(|one| one.area_mm2 > 0.0).map(|one| {
            let since = one.since_s.map_or(String::new(), |t| format!(", from {}", Dimension::TIME.of(t)));
            let area = Dimension::AREA.of(one.area_mm2 * 1e-6);
            format!("            interface {:>7} {area:>14}{since}", one.interface)
        });
        [all].into_iter().chain(each).collect()
    }
}
