//! How loads at rest are followed while interfaces open.

use super::builder::{Builder, Held};
use super::cracks::cell_length;
use crate::error::Error;
use fem_core::constraint::{Constraints, Equation};
use fem_core::element::Element;
use fem_core::functional::Functional;
use fem_core::laminate::Laminate;
use fem_core::material::{Material, Toughness};
use fem_core::plate::Plate;
use fem_io::scene::{Analysis, Load, LoadKind, Place, SceneError};
use std::collections::BTreeMap;

/// What of the length of a cell a crack grows in a step, unless the scene says how long steps are.
const ADVANCE: f64 = 0.5;

/// Loads that grow together through what interfaces do.
#[derive(Debug, Clone)]
pub struct PathPlan {
    /// Loads that stand for 1 N, by unknowns before elimination: their work on displacements, J, is how far that force moves, m.
    pub load: Functional,
    /// Of the forces that the scene gives, how many N the loads stand for; 1 where it prescribes displacements.
    pub unit: f64,
    /// How far it moves, m.
    pub until: f64,
    /// Energy that a step dissipates, J.
    pub step: f64,
    /// Most steps.
    pub steps: usize,
}

/// Displacements that a scene prescribes, all in proportion to that of one unknown.
#[derive(Debug, Clone)]
pub(super) struct Driven {
    /// The unknown.
    unknown: usize,
    /// Sum of the prescribed displacements, without their signs, m.
    sum: f64,
    /// Displacement of the unknown over that sum.
    share: f64,
}

impl Builder<'_> {
    /// Ties all unknowns whose displacements the scene prescribes to one of them.
    pub(super) fn driven<'s>(
        &'s self,
        plate: &Plate,
        equations: &mut Vec<Equation>,
        places: &mut Vec<&'s Place>,
    ) -> Result<Option<Driven>, SceneError> {
        let Analysis::Static(loads) = &self.scene.analysis else { return Ok(None) };
        let (mut sum, mut leader): (f64, Option<(usize, f64)>) = (0.0, None);
        let mut taken = BTreeMap::new();
        for Load { kind, place } in loads {
            let LoadKind::Displacement { displacement, dof, nodes } = kind else { continue };
            if self.scene.delamination.is_none() {
                let message = "displacements are prescribed only while delaminations grow";
                let help = "load the plate by a force, whose displacements are proportional to it";
                return Err(self.scene.source.error_at(place, message, help));
            }
            let nodes_there = self.each_node(plate, nodes, &[*dof])?;
            let moved: Vec<usize> = nodes_there
                .into_iter()
                .flat_map(|(column, level)| plate.dofs_at(column as usize, level, *dof))
                .collect();
            if moved.is_empty() {
                let message = format!("the element has no {dof} at the nodes of `{}`", nodes.group.value);
                return Err(self.error(&nodes.group, message, "name nodes and an unknown that it has"));
            }
            for unknown in &moved {
                if let Some(first) = taken.insert(*unknown, &nodes.group.value) {
                    let message =
                        format!("{dof} of a node is prescribed twice, at `{first}` and at `{}`", nodes.group.value);
                    return Err(self.error(&nodes.group, message, "keep one displacement of each unknown"));
                }
            }
            sum += displacement.abs();
            for unknown in moved {
                let (first, by) = *leader.get_or_insert((unknown, *displacement));
                if unknown != first {
                    let terms = vec![(unknown, 1.0), (first, -displacement / by)];
                    let origin = format!("displacement of `{}`", nodes.group.value);
                    equations.push(Equation { terms, value: 0.0, origin, holds: false });
                }
            }
            places.resize(equations.len(), place);
        }
        Ok(leader.map(|(unknown, by)| Driven { unknown, sum, share: by / sum }))
    }

    /// How the loads of the scene are followed, where interfaces may open.
    pub(super) fn path(
        &self,
        (plate, element): (&Plate, &dyn Element),
        laminate: &Laminate,
        materials: &[Material],
        (held, forces): (&Held<'_>, &[f64]),
    ) -> Result<Option<PathPlan>, Error> {
        let (Some(_), Analysis::Static(loads)) = (&self.scene.delamination, &self.scene.analysis) else {
            return Ok(None);
        };
        let spec = self.scene.path.as_ref();
        let place = spec.map_or(&Place::TOP, |spec| &spec.place);
        let refuse = |message: &str, help: &str| self.scene.source.error_at(place, message, help);
        let spec = spec.map(|spec| spec.value.clone()).unwrap_or_default();
        let forced: Vec<(usize, f64)> = forces.iter().copied().enumerate().filter(|(_, f)| *f != 0.0).collect();
        let (load, unit, prescribed) = match (&held.driven, &forced[..]) {
            (None, []) => return Err(refuse("nothing is loaded", "add a `load`, a displacement or a force").into()),
            (Some(driven), []) => {
                self.moves(&held.constraints, driven, loads)?;
                let mut push = vec![0.0; plate.ndof()];
                push[driven.unknown] = 1.0;
                held.check_balance(self.scene, plate, &push)?;
                (vec![(driven.unknown, 1.0 / driven.share)], 1.0, Some(driven.sum))
            }
            (Some(_), _) => {
                let message = "displacements are prescribed beside forces, and only one of them can be followed";
                return Err(refuse(message, "keep the displacements or the forces").into());
            }
            (None, forced) => {
                let unit = match spec.force {
                    Some(force) => force,
                    None => self.largest((plate, element), loads)?,
                };
                (forced.iter().map(|(unknown, force)| (*unknown, force / unit)).collect(), unit, None)
            }
        };
        let until = spec.until.as_ref().map(|until| until.value).or(prescribed).ok_or_else(|| {
            let help = "say where it ends, for example: path = { until = \"4 mm\" }";
            refuse("a path along forces has no end of its own", help)
        })?;
        let step = spec.step.map_or_else(|| self.step(plate, laminate, materials), Ok)?;
        Ok(Some(PathPlan { load: Functional(load), unit, until, step, steps: spec.steps }))
    }

    /// Refuses displacements that supports do not let happen.
    fn moves(&self, constraints: &Constraints, driven: &Driven, loads: &[Load]) -> Result<(), SceneError> {
        if !constraints.implies(&[(driven.unknown, 1.0)]) {
            return Ok(());
        }
        let first = loads.iter().find(|load| matches!(load.kind, LoadKind::Displacement { .. }));
        let place = first.map_or(&Place::TOP, |load| &load.place);
        let message = "the supports hold nodes whose displacement is prescribed";
        Err(self.scene.source.error_at(place, message, "prescribe those of nodes that are free to move"))
    }

    /// The largest force that a load exerts, N.
    fn largest(&self, (plate, element): (&Plate, &dyn Element), loads: &[Load]) -> Result<f64, Error> {
        let mut largest = 0.0_f64;
        for load in loads {
            let mut forces = vec![0.0; plate.ndof()];
            self.add_load(load, plate, element, &mut forces)?;
            let mut sum = [0.0; 3];
            for (unknown, force) in forces.iter().enumerate().filter(|(_, force)| **force != 0.0) {
                let (_, _, dof) = plate.locate(unknown);
                if dof.m() == 0 {
                    sum[dof.n() - 1] += force;
                }
            }
            largest = largest.max(sum.iter().map(|f| f * f).sum::<f64>().sqrt());
        }
        if largest > 0.0 {
            return Ok(largest);
        }
        let message = "the loads balance each other, so that they stand for no force";
        let help = "say for which: path = { force = \"1 N\" }";
        Err(self.scene.source.error_at(&Place::TOP, message, help).into())
    }

    /// What a crack across the plate dissipates while it grows by a share of a cell, J.
    fn step(&self, plate: &Plate, laminate: &Laminate, materials: &[Material]) -> Result<f64, SceneError> {
        let resin = self.scene.interface.as_ref().map_or(laminate.plies[0].material, |resin| resin.value);
        let Some(toughness) = materials[resin].toughness.get(Toughness::GIc) else {
            let message = "no toughness GIc says how long the steps of the path may be";
            return Err(self.error(&self.scene.materials[resin], message, "give `path.step`, for example \"1 mJ\""));
        };
        let cell = (0..plate.plane.quads.len()).map(|quad| cell_length(plate, quad)).fold(f64::INFINITY, f64::min);
        let (low, high) = plate.plane.bounds();
        Ok(toughness * ADVANCE * cell * (high[0] - low[0]).min(high[1] - low[1]))
    }
}
