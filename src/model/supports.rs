//! What the supports of a scene hold.

use super::builder::Builder;
use fem_core::axes::Turns;
use fem_core::hold::Hold;
use fem_core::mesh::Group;
use fem_core::plate::Plate;
use fem_io::scene::{Located, SceneError, Support, SupportArea};
use std::collections::BTreeSet;

impl Builder<'_> {
    /// Where a support acts, for messages, and what it holds: unknowns in axes that it names, or node by node in axes along an edge.
    pub(super) fn holds(
        &self,
        plate: &Plate,
        support: &Support,
        turns: &mut Turns,
    ) -> Result<(String, Vec<Hold>), SceneError> {
        match support {
            Support::Fix { nodes, dofs, axes, .. } => {
                let (columns, levels) = self.nodes(plate, nodes)?;
                let (dofs, angle) = (dofs.clone(), turns.settle(*axes));
                Ok((format!("`{}`", nodes.group.value), vec![Hold { columns, levels, dofs, angle, curvature: 0.0 }]))
            }
            Support::Kind { area, kind, levels, place } => {
                let name = area.value.to_string();
                let group = self.area(plate, area)?;
                if let Some([why, help]) = kind.refuses(&plate.plane, &group, *levels) {
                    return Err(self.scene.source.error_at(place, format!("the support of {name}: {why}"), help));
                }
                levels
                    .of(plate)
                    .map_err(|why| self.error(area, why.to_string(), "write at = \"bottom\", for example"))?;
                Ok((name, Hold::of_kind(plate, &group, *kind, *levels, turns)))
            }
            Support::RestrainRigidMotions { .. } => Ok((String::new(), Vec::new())),
        }
    }

    /// The part of the plate that a support by name acts on.
    fn area(&self, plate: &Plate, area: &Located<SupportArea>) -> Result<Group, SceneError> {
        match &area.value {
            SupportArea::Group(name) => {
                let name = Located { value: name.clone(), place: area.place.clone() };
                self.group(plate, &name).cloned()
            }
            SupportArea::Disc { centre, radius } => {
                let group = plate.plane.within(*centre, *radius);
                if group.nodes.is_empty() {
                    let message = format!("no node of the mesh lies in {}", area.value);
                    return Err(self.error(area, message, "enlarge its radius, or make cells smaller there"));
                }
                Ok(group)
            }
        }
    }
}

/// "`edge`, clamped: U10 U11 ... at 48 nodes, 1 along the edge and 2 across it".
pub(super) fn describe(plate: &Plate, support: &Support, name: &str, holds: &[Hold]) -> String {
    let (mut nodes, mut held) = (BTreeSet::new(), BTreeSet::new());
    for (column, level, dof) in holds.iter().flat_map(Hold::each) {
        if plate.dofs_at(column, level, dof).next().is_some() {
            nodes.insert((column, level));
            held.insert(dof.to_string());
        }
    }
    let (held, nodes) = (held.into_iter().collect::<Vec<_>>().join(" "), nodes.len());
    match support {
        Support::Kind { kind, .. } => {
            format!("{name}, {}: {held} at {nodes} nodes, 1 along the edge and 2 across it", kind.name())
        }
        _ => format!("{name}, fixed unknowns: {held} at {nodes} nodes"),
    }
}
