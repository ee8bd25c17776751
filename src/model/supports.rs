//! What the supports of a scene hold.

use super::builder::Builder;
use fem_core::axes::Turns;
use fem_core::dof::Dof;
use fem_core::hold::{Hold, SupportKind, What};
use fem_core::mesh::Group;
use fem_core::plate::Plate;
use fem_io::scene::{Located, SceneError, Support, SupportArea};
use std::collections::{BTreeMap, BTreeSet};

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
                let angle = turns.settle(*axes);
                let hold = |(columns, levels)| Hold {
                    columns,
                    levels,
                    dofs: dofs.clone(),
                    angle,
                    curvature: 0.0,
                    what: What::Each,
                };
                let holds = self.nodes(plate, nodes, dofs)?.into_iter().map(hold).collect();
                Ok((format!("`{}`", nodes.group.value), holds))
            }
            Support::Kind { kind: SupportKind::Free | SupportKind::Rest, .. }
            | Support::Kind { stiffness: Some(_), .. } => {
                self.check_kind(plate, support)?;
                Ok((String::new(), Vec::new()))
            }
            Support::Kind { area, kind, levels, .. } => {
                let name = area.value.to_string();
                let group = self.check_kind(plate, support)?;
                levels
                    .at(plate, &plate.columns_of_group(&group))
                    .map_err(|why| self.error(area, why.to_string(), "write at = \"bottom\", for example"))?;
                Ok((name, Hold::of_kind(plate, &group, *kind, *levels, turns)))
            }
            Support::RestrainRigidMotions { .. } => Ok((String::new(), Vec::new())),
        }
    }

    /// What a support by name acts on, where its kind can act there.
    fn check_kind(&self, plate: &Plate, support: &Support) -> Result<Group, SceneError> {
        let Support::Kind { area, kind, levels, stiffness, place } = support else { return Ok(Group::default()) };
        // Springs of a disc are spread over it, wherever nodes are.
        let sprung = stiffness.is_some() || *kind == SupportKind::Rest;
        let spread = matches!(area.value, SupportArea::Disc { .. }) && sprung;
        let group = if spread { Group::default() } else { self.area(plate, area)? };
        match kind.refuses(&plate.plane, &group, *levels) {
            None => {
                let in_plane = !matches!(kind, SupportKind::Free | SupportKind::Rest | SupportKind::Roller);
                if in_plane {
                    self.check_height(plate, *levels, &[Dof::SOLID[0]], place)?;
                }
                Ok(group)
            }
            Some([why, help]) => {
                let message = format!("the support of {}: {why}", area.value);
                Err(self.scene.source.error_at(place, message, help))
            }
        }
    }

    /// Refuses edges that one support says to be free and another one by name holds.
    pub(super) fn free_edges(&self, plate: &Plate) -> Result<(), SceneError> {
        let ends = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut free = BTreeMap::new();
        let mut held = Vec::new();
        for support in &self.scene.supports {
            let Support::Kind { area, kind, place, .. } = support else { continue };
            let group = self.check_kind(plate, support)?;
            let edges = group.edges.into_iter().map(ends);
            match kind {
                SupportKind::Free => free.extend(edges.map(|edge| (edge, (area, place)))),
                _ => held.push((area, kind, edges.collect::<Vec<_>>())),
            }
        }
        for (area, kind, edges) in held {
            if let Some((said, place)) = edges.iter().find_map(|edge| free.get(edge)) {
                let why = format!(
                    "edges of {} are said to be free, and {} holds them, {}",
                    said.value,
                    area.value,
                    kind.name()
                );
                let help = "leave one of the two supports out, or name groups without common edges";
                return Err(self.scene.source.error_at(place, why, help));
            }
        }
        Ok(())
    }

    /// The part of the plate that a support by name acts on.
    pub(super) fn area(&self, plate: &Plate, area: &Located<SupportArea>) -> Result<Group, SceneError> {
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
    for (column, level, dof) in holds.iter().filter(|hold| hold.what != What::Jumps).flat_map(Hold::each) {
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
