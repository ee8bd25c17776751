//! From a scene to a model: everything that is decided before the first matrix.

mod gauge;

use crate::error::Error;
use crate::registry::{NO_REDUCTION, Registry, RegistryError};
use fem_core::assembly::elimination_order;
use fem_core::constraint::{Constraints, Equation};
use fem_core::contact::ContactLaw;
use fem_core::dof::Dof;
use fem_core::element::Element;
use fem_core::failure::{FailureCriterion, Site, check_material};
use fem_core::laminate::Laminate;
use fem_core::material::{Material, MaterialError};
use fem_core::mesh::QuadMesh;
use fem_core::patch;
use fem_core::plate::Plate;
use fem_core::plugin::{Built, Kind, unknown_key};
use fem_core::reduction::{Functional, Reduction};
use fem_core::support::{self, FreeMotions};
use fem_core::time::Integrator;
use fem_core::window;
use fem_failure::delamination::DelaminationThreshold;
use fem_io::gmsh::{self, GmshMesh, MeshFault};
use fem_io::scene::{
    CriterionSpec, Damage, ImpactPoint, Load, Located, NodeSet, Place, PluginSpec, Scene, SceneError, Support,
};
use std::collections::BTreeSet;

/// A scene made concrete: mesh extruded, plug-ins built, supports turned into constraints, the contact placed.
#[derive(Debug, Clone)]
pub struct Model {
    /// The scene it was made from.
    pub scene: Scene,
    /// Materials; layups and stations refer to them by index.
    pub materials: Vec<Material>,
    /// The laminate.
    pub laminate: Laminate,
    /// Cells and unknowns.
    pub plate: Plate,
    /// The element of all cells.
    pub element: Box<dyn Element>,
    /// Supports and other equations, eliminated.
    pub constraints: Constraints,
    /// The contact: weights of the deflection under the impactor over the independent unknowns.
    pub contact: Functional,
    /// Where the impactor strikes, m.
    pub centre: [f64; 2],
    /// The contact law.
    pub law: Box<dyn ContactLaw>,
    /// The reduction, if any.
    pub reduction: Option<Box<dyn Reduction>>,
    /// The integrator.
    pub integrator: Box<dyn Integrator>,
    /// Criteria by name; none when damage is off.
    pub criteria: Vec<NamedCriterion>,
    /// Quads whose stresses the criteria judge.
    pub watched: Vec<usize>,
    /// Places whose indices are kept over time.
    pub gauges: Vec<Gauge>,
    /// Force at which the laminate delaminates, where damage is looked for and a material gives the toughness.
    pub threshold: Option<DelaminationThreshold>,
    /// Mass per area, kg/m².
    pub areal_mass: f64,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// A criterion under the name by which the scene calls it.
pub type NamedCriterion = (String, Box<dyn FailureCriterion>);

pub use gauge::Gauge;

/// Thickness over size of the plate outside of which the mesh's unit is probably wrong.
const PLAUSIBLE_THICKNESS: std::ops::Range<f64> = 1e-4..0.5;

/// Inner angle of a cell (degrees) beyond which its strains are poor.
const POOR_ANGLE: f64 = 150.0;

impl Model {
    /// Builds the model of `scene` with the plug-ins of `registry`.
    ///
    /// # Errors
    /// Whatever the scene names and the mesh or the registry does not have, and supports that do not fit together or
    /// leave a rigid motion.
    pub fn new(scene: Scene, registry: &Registry) -> Result<Self, Error> {
        let builder = Builder { scene: &scene, registry };
        let read = builder.mesh()?;
        let mut warnings = read.warnings;
        let mesh = read.mesh;
        let materials: Vec<Material> = scene.materials.iter().map(|m| m.value.clone()).collect();
        let laminate = scene.laminate.value.clone();
        warnings.extend(implausible(&mesh, &laminate));

        let element = builder.element()?;
        let law = builder.contact()?;
        let reduction = builder.reduction()?;
        let integrator = builder.integrator()?;
        let criteria = match scene.damage {
            Damage::Off => Vec::new(),
            Damage::Onset => builder.criteria()?,
        };

        let levels = laminate.levels();
        let lacks = |why: MaterialError| {
            let material = scene.materials.iter().find(|m| m.value.name == why.material).unwrap_or(&scene.materials[0]);
            builder.error(material, why.to_string(), "add its `density`, for example: density = \"1.58 g/cm^3\"")
        };
        let areal_mass = laminate.areal_mass(&materials).map_err(lacks)?;
        let stacks = laminate.stacks(&materials).map_err(lacks)?;
        let plate = Plate::new(mesh, levels, stacks, *element.info(), scene.z_derivatives.value)
            .map_err(|why| builder.error(&scene.element.name, why, "choose a solid element"))?;
        let constraints = builder.constraints(&plate)?;
        let (centre, contact) = builder.contact_place(&plate, &*element)?;
        let watched = builder.watched(&plate.plane, centre)?;
        let gauges = builder.gauges(&plate, &watched, &criteria)?;
        let resin = scene.interface.as_ref().map(|resin| resin.value);
        let threshold = match scene.damage {
            Damage::Off => None,
            Damage::Onset => DelaminationThreshold::of(&laminate, &materials, resin),
        };
        let contact = Functional(constraints.restrict(&contact.0));
        if contact.0.is_empty() {
            return Err(builder
                .error(
                    &scene.impactor.at,
                    "the supports hold the plate exactly where the impactor strikes",
                    "move the impact or the support",
                )
                .into());
        }
        Ok(Self {
            materials,
            laminate,
            plate,
            element,
            constraints,
            contact,
            centre,
            law,
            reduction,
            integrator,
            criteria,
            watched,
            gauges,
            threshold,
            areal_mass,
            warnings,
            scene,
        })
    }

    /// Governors that a reduction may choose from, best first: deflections (U30 at the mid-plane or the lowest level),
    /// each as far as possible from the contact and from those before it, so that any first few cover the plate evenly.
    pub fn governors(&self, count: usize) -> Vec<usize> {
        let level = self.plate.mid_level().unwrap_or(0);
        let Some(deflection) = Dof::new(3, 0) else { return Vec::new() };
        let candidates: Vec<(usize, [f64; 2])> = (0..self.plate.plane.points.len())
            .filter_map(|column| {
                let dof = self.plate.dofs_at(column, level, deflection).next()?;
                Some((self.constraints.position(dof)?, self.plate.plane.points[column]))
            })
            .collect();
        let square = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        let mut distance: Vec<f64> = candidates.iter().map(|c| square(c.1, self.centre)).collect();
        let mut chosen = Vec::new();
        for _ in 0..count.min(candidates.len()) {
            // On a symmetric mesh many are equally far: take the first of them, whatever the last bit says.
            let farthest = distance.iter().fold(0.0_f64, |m, d| m.max(*d));
            let Some(next) = distance.iter().position(|d| *d > 0.0 && *d >= farthest * (1.0 - 1e-9)) else { break };
            chosen.push(candidates[next].0);
            for (d, c) in distance.iter_mut().zip(&candidates) {
                *d = d.min(square(c.1, candidates[next].1));
            }
        }
        chosen
    }
}

fn implausible(mesh: &QuadMesh, laminate: &Laminate) -> Vec<String> {
    let mut warnings = Vec::new();
    let (low, high) = mesh.bounds();
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let ratio = laminate.thickness() / size;
    if !PLAUSIBLE_THICKNESS.contains(&ratio) {
        warnings.push(format!(
            "the plate is {:.4} mm wide and {:.4} mm thick: is `mesh.unit` the unit of the mesh file?",
            size * 1e3,
            laminate.thickness() * 1e3
        ));
    }
    let poor: Vec<u64> = (0..mesh.quads.len())
        .filter(|q| mesh.quality(*q).largest_angle.to_degrees() > POOR_ANGLE)
        .map(|q| mesh.quad_tags[q])
        .collect();
    if let Some(first) = poor.first() {
        warnings.push(format!(
            "{} cells have an inner angle above {POOR_ANGLE} degrees (first: cell {first}): their strains are poor",
            poor.len()
        ));
    }
    warnings
}

/// Looks things up for a scene and turns what is missing into errors that show the scene.
struct Builder<'a> {
    scene: &'a Scene,
    registry: &'a Registry,
}

macro_rules! build {
    ($self:ident, $spec:expr, $kind:ident) => {{
        let spec: &PluginSpec = $spec;
        match $self.registry.build(Kind::$kind, &spec.name.value, &spec.params) {
            Ok(Built::$kind(built)) => Ok(built),
            Ok(_) => Err($self.error(
                &spec.name,
                format!("the plug-in registered as {} `{}` builds something else", Kind::$kind, spec.name.value),
                "mend the plug-in",
            )),
            Err(RegistryError::Param(e)) => {
                let known = $self.registry.param(Kind::$kind, &spec.name.value, &e.key);
                let help = known.map_or(String::new(), |p| format!("`{}`: {}", p.name, p.doc));
                let message = format!("{} `{}`: {e}", Kind::$kind, spec.name.value);
                Err($self.scene.source.error_at(spec.place_of(&e.key), message, help))
            }
            Err(error) => {
                let hint = match &error {
                    RegistryError::Unknown { hint, .. } => hint.clone(),
                    _ => String::new(),
                };
                Err($self.error(&spec.name, error.to_string(), hint))
            }
        }
    }};
}

impl Builder<'_> {
    fn error<T>(&self, at: &Located<T>, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        self.scene.source.error_at(&at.place, message, help)
    }

    fn element(&self) -> Result<Box<dyn Element>, SceneError> {
        build!(self, &self.scene.element, Element)
    }

    fn contact(&self) -> Result<Box<dyn ContactLaw>, SceneError> {
        build!(self, &self.scene.contact, Contact)
    }

    fn integrator(&self) -> Result<Box<dyn Integrator>, SceneError> {
        build!(self, &self.scene.march.integrator, Integrator)
    }

    fn reduction(&self) -> Result<Option<Box<dyn Reduction>>, SceneError> {
        let spec = &self.scene.reduction;
        if spec.name.value == NO_REDUCTION {
            return match spec.params.keys().next() {
                None => Ok(None),
                Some(key) => Err(self.scene.source.error_at(
                    spec.place_of(key),
                    format!("`{key}` means nothing without a reduction"),
                    "remove it or choose a method",
                )),
            };
        }
        build!(self, spec, Reduction).map(Some)
    }

    fn criteria(&self) -> Result<Vec<NamedCriterion>, SceneError> {
        let each = |spec: &CriterionSpec| {
            let criterion = build!(self, &spec.plugin, Criterion)?;
            self.check_criterion(&spec.plugin, &*criterion)?;
            Ok((spec.label.clone(), criterion))
        };
        self.scene.failure.criteria.iter().map(each).collect()
    }

    /// Refuses a criterion that has nothing to judge, or that a material does not suit.
    fn check_criterion(&self, spec: &PluginSpec, criterion: &dyn FailureCriterion) -> Result<(), SceneError> {
        let name = &spec.name.value;
        let judged: BTreeSet<usize> = match (criterion.info().site, &self.scene.interface) {
            (Site::Ply, _) => self.scene.laminate.value.plies.iter().map(|ply| ply.material).collect(),
            (Site::Interface, Some(resin)) => BTreeSet::from([resin.value]),
            (Site::Interface, None) => {
                return Err(self.error(
                    &spec.name,
                    format!("criterion `{name}` judges the resin between plies, and the laminate names none"),
                    "give `laminate.interface` the name of a material",
                ));
            }
        };
        for material in judged.into_iter().map(|m| &self.scene.materials[m]) {
            if let Err(why) = check_material(criterion, name, &material.value) {
                return Err(self.error(
                    material,
                    why.to_string(),
                    "complete or correct the material, or remove the criterion",
                ));
            }
        }
        Ok(())
    }

    fn watched(&self, mesh: &QuadMesh, centre: [f64; 2]) -> Result<Vec<usize>, SceneError> {
        let failure = &self.scene.failure;
        let near = |q: &usize| {
            let c = window::centroid(&mesh.corners(*q));
            failure.radius.is_none_or(|r| (c[0] - centre[0]).hypot(c[1] - centre[1]) <= r)
        };
        let watched: Vec<usize> = (0..mesh.quads.len()).filter(near).collect();
        if watched.is_empty() {
            let message = "no cell has its centre within `failure.radius` of the impact";
            return Err(self.scene.source.error_at(&failure.place, message, "enlarge the radius or leave it out"));
        }
        Ok(watched)
    }

    fn mesh(&self) -> Result<GmshMesh, Error> {
        let file = &self.scene.mesh.file;
        gmsh::read(&file.value, self.scene.mesh.metres_per_unit).map_err(|error| match error.fault {
            MeshFault::Unreadable(_) => {
                self.error(file, error.to_string(), "`mesh.file` counts from the folder of the scene").into()
            }
            _ => error.into(),
        })
    }

    /// Columns of a group.
    fn columns<'p>(&self, plate: &'p Plate, group: &Located<String>) -> Result<&'p [u32], SceneError> {
        match plate.plane.groups.get(&group.value) {
            Some(found) => Ok(&found.nodes),
            None => Err(self.error(
                group,
                format!("the mesh has no group `{}`", group.value),
                format!(
                    "`{}` {}",
                    group.value,
                    unknown_key(&group.value, plate.plane.groups.keys().map(String::as_str))
                ),
            )),
        }
    }

    fn nodes<'p>(&self, plate: &'p Plate, set: &NodeSet) -> Result<(&'p [u32], Vec<usize>), SceneError> {
        let levels = set.levels.of(plate).map_err(|why| self.error(&set.group, why, ""))?;
        Ok((self.columns(plate, &set.group)?, levels))
    }

    fn constraints(&self, plate: &Plate) -> Result<Constraints, SceneError> {
        let source = &self.scene.source;
        let mut equations = Vec::new();
        // Of each equation, where it stands in the scene.
        let mut places = Vec::new();
        let mut restraint = None;
        for entry in &self.scene.supports {
            match entry {
                Support::Fix { nodes, dofs, axes, place } => {
                    let (columns, levels) = self.nodes(plate, nodes)?;
                    let origin = format!("support of `{}`", nodes.group.value);
                    let fixed = support::fix(plate, columns, &levels, dofs, *axes, &origin);
                    if fixed.is_empty() {
                        let message = format!("the support of `{}` fixes nothing", nodes.group.value);
                        return Err(source.error_at(place, message, "the element has none of the unknowns of `fix`"));
                    }
                    equations.extend(fixed);
                    places.resize(equations.len(), place);
                }
                Support::RestrainRigidMotions { place } => restraint = Some(place),
            }
        }
        for couple in &self.scene.couples {
            let (columns, levels) = self.nodes(plate, &couple.nodes)?;
            let origin = format!("couple of `{}`", couple.nodes.group.value);
            equations.extend(support::couple(plate, columns, &levels, &couple.dofs, &origin));
            places.resize(equations.len(), &couple.place);
        }
        for (number, equation) in self.scene.equations.iter().enumerate() {
            equations.push(self.equation(plate, equation, number)?);
            places.push(&equation.place);
        }
        let free = FreeMotions::of(plate, &equations);
        match restraint {
            _ if free.is_empty() => {}
            Some(place) => {
                equations.extend(free.restrain(plate).map_err(|why| source.error_at(place, why, ""))?);
                places.resize(equations.len(), place);
            }
            None => {
                return Err(source.error_at(
                    self.scene.supports.first().map_or(&Place::TOP, Support::place),
                    format!("the supports leave the plate free: {}", free.names()),
                    "support the plate against it, or add `{ restrain = \"rigid-motions\" }` to `support`",
                ));
            }
        }
        Constraints::eliminate(&elimination_order(plate), &equations).map_err(|why| {
            let at = equations.iter().position(|e| e.origin == why.origin()).and_then(|i| places.get(i));
            source.error_at(at.copied().unwrap_or(&Place::TOP), why.to_string(), "")
        })
    }

    fn equation(
        &self,
        plate: &Plate,
        equation: &fem_io::scene::Equation,
        number: usize,
    ) -> Result<Equation, SceneError> {
        let mut terms = Vec::new();
        for term in &equation.terms {
            let (columns, levels) = self.nodes(plate, &term.node)?;
            let ([column], [level]) = (columns, &levels[..]) else {
                return Err(self.error(
                    &term.node.group,
                    format!("a term of an equation stands at one node, but `{}` has more", term.node.group.value),
                    "name a group of one node and one level",
                ));
            };
            let dof = plate.dofs_at(*column as usize, *level, term.dof).next().ok_or_else(|| {
                self.error(&term.node.group, format!("the element has no {}", term.dof), "choose another unknown")
            })?;
            terms.push((dof, term.factor));
        }
        Ok(Equation { terms, value: 0.0, origin: format!("equation {}", number + 1), holds: false })
    }

    /// A place on the plate, and the column of the node there if there is one.
    fn point(&self, plate: &Plate, at: &Located<ImpactPoint>) -> Result<([f64; 2], Option<usize>), SceneError> {
        Ok(match &at.value {
            ImpactPoint::Group(name) => {
                let group = Located { value: name.clone(), place: at.place.clone() };
                let columns = self.columns(plate, &group)?;
                let [column] = columns else {
                    let dim = plate.plane.groups.get(name).map_or(0, |g| g.dim);
                    return Err(self.error(
                        at,
                        format!("the group `{name}` (dimension {dim}) has {} nodes, a point has one", columns.len()),
                        "make a physical point of the place in gmsh, or give `at = { x = ..., y = ... }`",
                    ));
                };
                (plate.plane.points[*column as usize], Some(*column as usize))
            }
            ImpactPoint::Point(p) => {
                let (low, high) = plate.plane.bounds();
                let reach = 1e-9 * (high[0] - low[0]).hypot(high[1] - low[1]);
                let near = |q: &[f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]) <= reach;
                (*p, plate.plane.points.iter().position(near))
            }
        })
    }

    /// Where the impactor strikes, and the deflection there as weights of the unknowns.
    fn contact_place(&self, plate: &Plate, element: &dyn Element) -> Result<([f64; 2], Functional), SceneError> {
        let at = &self.scene.impactor.at;
        let (centre, column) = self.point(plate, at)?;
        let contact = match (self.scene.impactor.load.value, column) {
            (Load::Patch { radius }, _) => patch::hertz(plate, element, centre, radius).map_err(|why| {
                let (low, high) = plate.plane.bounds();
                let [width, depth] = [0, 1].map(|d| (high[d] - low[d]) * 1e3);
                let size = format!("the plate is {width:.4} mm by {depth:.4} mm, if `mesh.unit` is right");
                self.error(&self.scene.impactor.load, why, format!("choose a smaller `impactor.patch_radius`; {size}"))
            })?,
            (Load::Node, Some(column)) => patch::node(plate, column)
                .ok_or_else(|| self.error(at, "the element has no U30 to strike", "choose another element"))?,
            (Load::Node, None) => {
                return Err(self.error(
                    at,
                    "no node of the mesh lies at the impact point",
                    "put a node there, name a group, or use a patch (`patch_radius`)",
                ));
            }
        };
        Ok((centre, contact))
    }
}
