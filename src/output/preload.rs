//! What loads in the plane a plate was under before all else.

use crate::model::Model;
use fem_core::plugin::{Dimension, digits};
use serde::Serialize;

/// The preload of a plate; units are in the key names.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct PreloadFigures {
    #[serde(rename = "preload", skip_serializing_if = "Vec::is_empty")]
    pub edges: Vec<PreloadedEdge>,
    /// Of the load that buckles the plate; negative where only the opposite one does.
    #[serde(rename = "preload_over_buckling", skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// Whether that load is one of shapes that have the symmetry of the model, among which the lowest need not be.
    #[serde(skip)]
    pub symmetric: bool,
}

/// What acts on an edge.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct PreloadedEdge {
    pub group: String,
    /// Tension is positive; none where the displacement is prescribed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_N_per_m: Option<f64>,
    pub shear_N_per_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacement_m: Option<f64>,
}

impl PreloadFigures {
    /// That of a model, `share` of the load that buckles it.
    pub(super) fn new(model: &Model, share: Option<f64>) -> Self {
        let edges = model.effects.acting().iter().flat_map(|effect| effect.edges()).map(|edge| PreloadedEdge {
            group: edge.group.value.clone(),
            force_N_per_m: edge.displacement.is_none().then_some(edge.force),
            shear_N_per_m: edge.shear,
            displacement_m: edge.displacement,
        });
        Self { edges: edges.collect(), share, symmetric: model.plate.symmetry().name().is_some() }
    }

    /// The same as a line for people, if there is some.
    pub(super) fn line(&self) -> Option<String> {
        let edge = |edge: &PreloadedEdge| {
            let per_mm = |force: f64| format!("{} N/mm", digits(force * 1e-3));
            let force = edge.force_N_per_m.map(per_mm);
            let moved = edge.displacement_m.map(|by| Dimension::LENGTH.of(by));
            let shear = (edge.shear_N_per_m != 0.0).then(|| format!("shear {}", per_mm(edge.shear_N_per_m)));
            let all: Vec<String> = force.into_iter().chain(moved).chain(shear).collect();
            format!("{} {}", edge.group, all.join(" and "))
        };
        let alone = if self.symmetric { " into a symmetric shape" } else { "" };
        let share = match self.share {
            None => String::new(),
            Some(share) if share > 0.0 => format!("; {} of the load that buckles the plate{alone}", digits(share)),
            Some(share) => {
                format!("; the opposite load buckles the plate{alone} at {} times its size", digits(-1.0 / share))
            }
        };
        let edges: Vec<String> = self.edges.iter().map(edge).collect();
        (!edges.is_empty()).then(|| format!("  preload   {}{share}", edges.join(", ")))
    }
}
