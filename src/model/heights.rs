//! Displacements that are named at heights where a shell has no nodes.

use super::builder::Builder;
use fem_core::dof::Dof;
use fem_core::plate::Plate;
use fem_core::support::Levels;
use fem_io::scene::{NodeSet, Place, SceneError, Support};

impl Builder<'_> {
    /// Refuses displacements in the plane at heights where a shell has no nodes: there they differ by the turn of its section.
    pub(super) fn check_height(
        &self,
        plate: &Plate,
        levels: Levels,
        dofs: &[Dof],
        place: &Place,
    ) -> Result<(), SceneError> {
        let stray = dofs.iter().find(|dof| dof.n() < 3 && dof.m() == 0);
        let elsewhere = matches!(levels, Levels::Bottom | Levels::Top) && plate.info().is_shell();
        let (Some(dof), true) = (stray, elsewhere) else {
            return Ok(());
        };
        let element = &self.scene.element.name.value;
        let message =
            format!("`{element}` has nodes in its mid-plane alone, where {dof} is not what it is at other heights");
        let help = "write at = \"mid-plane\" if that is meant, hold a section by kind = \"clamped\", or take an element with nodes \
                    there, such as kind = \"hermite-prism\"";
        Err(self.scene.source.error_at(place, message, help))
    }

    /// What the user should know of displacements in the plane that are held at all heights, of which a shell has one.
    pub(super) fn turning(&self, plate: &Plate) -> Vec<String> {
        let held = self.scene.supports.iter().filter_map(|support| match support {
            Support::Fix { nodes, dofs, .. } => Some(("support", nodes, dofs)),
            _ => None,
        });
        let coupled = self.scene.couples.iter().map(|couple| ("couple", &couple.nodes, &couple.dofs));
        let all: Vec<_> = held.chain(coupled).collect();
        let warn = |(what, nodes, dofs): &(&str, &NodeSet, &Vec<Dof>)| {
            // The turn may be held by a support of its own.
            let of_group = |other: &&(&str, &NodeSet, &Vec<Dof>)| {
                (other.0 == "support" || other.0 == *what) && other.1.group.value == nodes.group.value
            };
            let held = |dof: &Dof| {
                all.iter().filter(of_group).any(|(.., dofs)| dofs.iter().any(|d| d.n() == dof.n() && d.m() == 3))
            };
            let turns = |dof: &&Dof| dof.m() == 0 && dof.n() < 3 && !held(dof);
            let dof = dofs.iter().find(turns)?;
            let turn = Dof::new(dof.n() as u8, 3)?;
            Some(format!(
                "`{}` has nodes in its mid-plane alone: the {what} of `{}` at all heights holds {dof} there, and the section may turn; \
                 where it may not, hold {turn} as well",
                self.scene.element.name.value, nodes.group.value
            ))
        };
        let everywhere =
            |(_, nodes, _): &&(&str, &NodeSet, &Vec<Dof>)| nodes.levels == Levels::All && plate.info().is_shell();
        all.iter().filter(everywhere).filter_map(warn).collect()
    }
}
