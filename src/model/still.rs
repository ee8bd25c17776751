//! Cells that cannot move.

use super::builder::Builder;
use fem_core::hold::SupportKind;
use fem_core::mesh::{Group, PlaneMesh};
use fem_core::support::Levels;
use fem_io::scene::{Support, SupportArea};

impl Builder<'_> {
    /// Leaves the cells that are clamped over their whole height out of `mesh`, keeps the groups of which nothing is left, and says which
    /// cells: their edge is clamped in their place.
    /// Elements that share strains at nodes would carry those beside the clamp into it. A plate that is clamped everywhere stays, and
    /// so do cells that a couple holds others to.
    pub(super) fn leave_out_clamped(&mut self, mesh: &mut PlaneMesh) -> Option<String> {
        let mut gone = vec![false; mesh.quads.len()];
        let mut names = Vec::new();
        for support in &self.scene.supports {
            let Support::Kind { area, kind: SupportKind::Clamped, levels: Levels::All, stiffness: None, .. } = support
            else {
                continue;
            };
            let disc;
            let group = match &area.value {
                SupportArea::Group(name) => mesh.groups.get(name),
                SupportArea::Disc { centre, radius } => {
                    disc = mesh.within(*centre, *radius);
                    Some(&disc)
                }
            };
            let quads = group.map_or(&[][..], |group| &group.quads);
            if !quads.is_empty() {
                quads.iter().for_each(|quad| gone[*quad as usize] = true);
                names.push(area.value.to_string());
            }
        }
        let count = gone.iter().filter(|gone| **gone).count();
        if count == 0 || count == gone.len() || self.couples_any(mesh, &gone) {
            return None;
        }
        let parts = |group: &Group| [group.nodes.len(), group.edges.len(), group.quads.len()];
        let whole = std::mem::replace(mesh, mesh.without(&gone));
        let lost = |(name, group): (&String, &Group)| {
            let left = mesh.groups.get(name).map_or([0; 3], parts)[usize::from(group.dim)];
            (left == 0 && parts(group)[usize::from(group.dim)] > 0).then(|| name.clone())
        };
        self.still = whole.groups.iter().filter_map(lost).collect();
        Some(format!("{count} cells of {}, which do not move", names.join(", ")))
    }

    /// Whether a couple has nodes that only cells that are `gone` have.
    fn couples_any(&self, mesh: &PlaneMesh, gone: &[bool]) -> bool {
        let mut left = vec![false; mesh.points.len()];
        let stay = mesh.quads.iter().zip(gone).filter(|(_, gone)| !**gone);
        stay.flat_map(|(corners, _)| corners.iter()).for_each(|node| left[*node as usize] = true);
        let coupled = self.scene.couples.iter().filter_map(|couple| mesh.groups.get(&couple.nodes.group.value));
        coupled.flat_map(|group| &group.nodes).any(|node| !left[*node as usize])
    }
}
