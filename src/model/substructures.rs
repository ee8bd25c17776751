//! Which cells are condensed together where a scene divides its plate, and what stays of them.

use super::builder::Builder;
use super::plan::Plan;
use fem_core::assembly::Division;
use fem_core::constraint::Constraints;
use fem_core::plate::Plate;
use fem_io::scene::{Located, Masters, MeshSource, Parts, SceneError};

impl Builder<'_> {
    /// The division of the plate that the scene asks for; what a contact touches stays.
    pub(super) fn division(
        &self,
        plate: &Plate,
        constraints: &Constraints,
        plan: &Plan,
    ) -> Result<Option<Division>, SceneError> {
        let Some(spec) = &self.scene.substructures else { return Ok(None) };
        let quads = match &spec.parts {
            Parts::Groups(names) => self.groups_of_quads(plate, names)?,
            Parts::Cells(block) => self.blocks(block)?,
        };
        let mut kept = Vec::new();
        for masters in &spec.masters {
            kept.extend(self.masters(plate, masters)?);
        }
        if let Plan::Impact(impact) = plan {
            let touched = impact.strikes.iter().flat_map(|strike| &strike.contact.0);
            kept.extend(touched.map(|(i, _)| constraints.original(*i)));
        }
        Ok(Some(Division { quads, kept }))
    }

    fn groups_of_quads(&self, plate: &Plate, names: &[Located<String>]) -> Result<Vec<Option<u32>>, SceneError> {
        let mut quads: Vec<Option<u32>> = vec![None; plate.plane.quads.len()];
        for (number, name) in (0_u32..).zip(names) {
            let group = &self.group(plate, name)?.quads;
            if group.is_empty() {
                return Err(self.error(name, "the group has no cells", "a substructure is a physical surface"));
            }
            for quad in group {
                if let Some(other) = quads[*quad as usize].replace(number) {
                    let tag = plate.plane.quad_tags[*quad as usize];
                    let message = format!("cell {tag} belongs to `{}` too", names[other as usize].value);
                    return Err(self.error(
                        name,
                        message,
                        "a cell belongs to one substructure: name groups without common cells",
                    ));
                }
            }
        }
        Ok(quads)
    }

    fn blocks(&self, block: &Located<[usize; 2]>) -> Result<Vec<Option<u32>>, SceneError> {
        let MeshSource::Rectangle { cells, .. } = &self.scene.mesh else {
            let help = "name physical surfaces of the mesh: `groups = [\"left\", \"right\"]`";
            return Err(self.error(block, "blocks of cells need a built-in mesh, `mesh.rectangle`", help));
        };
        let ([nx, ny], [bx, by]) = (*cells, block.value);
        if !nx.is_multiple_of(bx) || !ny.is_multiple_of(by) {
            let message = format!("blocks of {bx} x {by} cells do not divide a mesh of {nx} x {ny}");
            return Err(self.error(block, message, "choose divisors of `mesh.cells`"));
        }
        let number = |quad: usize| (quad / nx / by) * (nx / bx) + quad % nx / bx;
        Ok((0..nx * ny).map(|quad| Some(number(quad) as u32)).collect())
    }

    fn masters(&self, plate: &Plate, masters: &Masters) -> Result<Vec<usize>, SceneError> {
        let (columns, levels) = self.nodes(plate, &masters.nodes)?;
        let mut kept = Vec::new();
        for (column, level) in columns.iter().flat_map(|column| levels.iter().map(move |level| (*column, *level))) {
            kept.extend(masters.dofs.iter().flat_map(|dof| plate.dofs_at(column as usize, level, *dof)));
        }
        if kept.is_empty() {
            let message = format!("`{}` adds no masters", masters.nodes.group.value);
            return Err(self.error(&masters.nodes.group, message, "the element has none of the unknowns of `dofs`"));
        }
        Ok(kept)
    }
}
