//! Which cells are condensed together where a scene divides its plate, and what stays of them.

use super::builder::Builder;
use super::plan::Plan;
use fem_core::assembly::Division;
use fem_core::constraint::Constraints;
use fem_core::plate::Plate;
use fem_core::plugin::{Kind, Value};
use fem_io::scene::{ImpactPoint, ImpactSpec, Located, MeshSource, Parts, PluginSpec, SceneError, Unknowns};

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
            kept.extend(self.unknowns(plate, masters)?);
        }
        if let Plan::Impact(impact) = plan {
            let functionals = impact.strikes.iter().flat_map(|strike| [Some(&strike.contact), strike.squeeze.as_ref()]);
            let touched = functionals.flatten().flat_map(|functional| functional.0.iter().map(|(i, _)| i));
            kept.extend(touched.chain(&impact.keep).map(|i| constraints.original(*i)));
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

    /// Unknowns (before constraints) that a scene names.
    pub(super) fn unknowns(&self, plate: &Plate, named: &Unknowns) -> Result<Vec<usize>, SceneError> {
        let at = &named.at;
        let columns = match &at.value {
            ImpactPoint::Group(name) => {
                self.columns(plate, &Located { value: name.clone(), place: at.place.clone() })?
            }
            ImpactPoint::Point([x, y]) => {
                let column = self.point(plate, at)?.1.ok_or_else(|| {
                    let message = format!("no node of the mesh lies at ({:.6}, {:.6}) mm", x * 1e3, y * 1e3);
                    self.error(at, message, "give the coordinates of a node, or name a group")
                })?;
                vec![column as u32]
            }
        };
        self.check_height(plate, named.levels, &named.dofs, &at.place)?;
        let nodes = named.levels.at(plate, &columns).map_err(|why| self.error(at, why.to_string(), ""))?;
        let nodes = nodes.iter().flat_map(|(columns, levels)| {
            columns.iter().flat_map(move |column| levels.iter().map(move |level| (*column as usize, *level)))
        });
        let each =
            nodes.flat_map(|(column, level)| named.dofs.iter().flat_map(move |dof| plate.dofs_at(column, level, *dof)));
        let found: Vec<usize> = each.collect();
        if found.is_empty() {
            let name = match &at.value {
                ImpactPoint::Group(name) => format!("`{name}`"),
                ImpactPoint::Point([x, y]) => format!("the node at ({:.6}, {:.6}) mm", x * 1e3, y * 1e3),
            };
            let message = format!("{name} has none of these unknowns");
            return Err(self.error(at, message, "the element has none of the unknowns of `dofs`"));
        }
        Ok(found)
    }

    /// Governors that the scene names, as independent unknowns.
    pub(super) fn keep(
        &self,
        spec: &ImpactSpec,
        plate: &Plate,
        constraints: &Constraints,
    ) -> Result<Vec<usize>, SceneError> {
        let (Some(keep), PluginSpec { name, params, .. }) = (&spec.keep, &spec.reduction) else {
            return Ok(Vec::new());
        };
        if !self
            .registry
            .info(Kind::Reduction, &name.value)
            .is_some_and(|info| info.params.iter().any(|row| row.name == "governors"))
        {
            let message = format!("`{}` keeps no governors", name.value);
            return Err(self.error(keep, message, "choose method = \"guyan\" or \"irs\", or leave `keep` out"));
        }
        if params.get("select").is_some_and(|select| *select == Value::Text("ratio".into())) {
            let help = "leave `select` or `keep` out";
            return Err(self.error(keep, "governors are named, and to be selected by their ratios", help));
        }
        let mut kept = Vec::new();
        for named in &keep.value {
            let unknowns = self.unknowns(plate, named)?;
            // Of a group, what is held is left out.
            let free: Vec<usize> = unknowns.iter().filter_map(|dof| constraints.position(*dof)).collect();
            if free.is_empty() {
                let first = plate.describe(unknowns[0]);
                let message = format!("{first} is held, or follows from others: it cannot govern");
                return Err(self.error(&named.at, message, "name unknowns that are free"));
            }
            for position in free {
                if !kept.contains(&position) {
                    kept.push(position);
                }
            }
        }
        match self.vectors(&spec.reduction) {
            Some(count) if count < kept.len() => {
                let message = format!("{} governors are named, and `governors` keeps {count}", kept.len());
                Err(self.error(
                    keep,
                    message,
                    format!("write governors = {} or more: those beyond spread over the plate", kept.len()),
                ))
            }
            _ => Ok(kept),
        }
    }
}
