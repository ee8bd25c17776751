//! Looks up what a scene names: mesh, plug-ins, groups, supports.

use super::NamedCriterion;
use super::path::Driven;
use super::springs::Springs;
use super::supports::describe;
use crate::registry::{NO_REDUCTION, Registry, RegistryError};
use fem_core::assembly::elimination_order;
use fem_core::axes::Turns;
use fem_core::between;
use fem_core::constraint::{Constraints, Equation};
use fem_core::contact::ContactLaw;
use fem_core::dof::Dof;
use fem_core::element::Element;
use fem_core::failure::{FailureCriterion, Site, check_material};
use fem_core::functional::{Functional, orthogonalise};
use fem_core::hold::SupportKind;
use fem_core::material::Material;
use fem_core::mesh::Group;
use fem_core::pieces;
use fem_core::plate::Plate;
use fem_core::plugin::{Built, Dimension, Kind, Role, unknown_key};
use fem_core::reduction::Reduction;
use fem_core::springs::SupportSpring;
use fem_core::support::{self, ColumnLevels, FreeMotions};
use fem_core::tensor::Stress6;
use fem_core::time::Integrator;
use fem_core::window::{Centre, Windows};
use fem_dynamics::integrate::{divided, located};
use fem_io::scene::{
    self, Analysis, CriterionSpec, LoadKind, Located, NodeSet, Place, PluginSpec, Scene, SceneError, Support, Window,
};
use std::collections::BTreeSet;

/// Vectors of a reduction that does not declare how many.
const VECTORS: usize = 60;

/// How far around an impact windows are centred that do not follow the mesh, in sides of a window.
const REACH: f64 = 2.0;

/// A stress so small that only its kind can be out of scope, Pa.
const SMALL: f64 = 1.0;

/// Looks things up for a scene and turns what is missing into errors that show the scene.
pub(super) struct Builder<'a> {
    pub(super) scene: &'a Scene,
    pub(super) registry: &'a Registry,
    /// Groups of the mesh of which nothing moves.
    pub(super) still: BTreeSet<String>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(scene: &'a Scene, registry: &'a Registry) -> Self {
        Self { scene, registry, still: BTreeSet::new() }
    }
}

/// How a plate is held.
pub(super) struct Held<'a> {
    pub(super) constraints: Constraints,
    /// What was eliminated.
    pub(super) equations: Vec<Equation>,
    /// How the independent unknowns of a plate that moves can do so as a whole.
    pub(super) motions: Vec<f64>,
    /// What supports of nodal values leave free between the nodes, sums of the independent unknowns.
    pub(super) between: Vec<Functional>,
    /// What each support holds, in words.
    pub(super) described: Vec<String>,
    /// Displacements that the scene prescribes.
    pub(super) driven: Option<Driven>,
    /// What gives way of them.
    pub(super) springs: Springs,
    /// What a restraint holds, and where it stands in the scene.
    pub(super) restraint: Option<(FreeMotions, &'a Place)>,
}

impl Held<'_> {
    /// Refuses loads at rest that only a restraint could carry.
    pub(super) fn check_balance(&self, scene: &Scene, plate: &Plate, forces: &[f64]) -> Result<(), SceneError> {
        let Some((free, place)) = &self.restraint else { return Ok(()) };
        match free.pushed(plate, forces) {
            None => Ok(()),
            Some(motions) => Err(scene.source.error_at(
                place,
                format!("the loads push the plate where only this restraint would hold it: {motions}"),
                "a restraint carries no load: support the plate against this motion, or balance the loads",
            )),
        }
    }
}

macro_rules! build {
    ($self:ident, $spec:expr, $kind:ident) => {{
        let spec: &PluginSpec = $spec;
        match $self.registry.build(Kind::$kind, &spec.name.value, &spec.params) {
            Ok(Built::$kind(built)) => Ok(built),
            Ok(_) => Err($self.error(
                &spec.name,
                format!("the plug-in registered as {} `{}` builds something else", Kind::$kind, spec.name.value),
                "correct the plug-in",
            )),
            Err(RegistryError::Param(e)) => {
                let known = $self.registry.param(Kind::$kind, &spec.name.value, &e.key);
                let help = known.map_or(String::new(), |row| format!("`{}`: {row}", row.name));
                let message = format!("{} `{}`: {e}", Kind::$kind, spec.name.value);
                Err($self.scene.source.error_at(spec.place_of(&e.key), message, help))
            }
            Err(RegistryError::Unit { key, error, help }) => {
                let message = format!("{} `{}`: `{key}`: {error}", Kind::$kind, spec.name.value);
                Err($self.scene.source.error_at(spec.place_of(&key), message, help))
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

pub(super) use build;

impl Builder<'_> {
    pub(super) fn error<T>(&self, at: &Located<T>, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        self.scene.source.error_at(&at.place, message, help)
    }

    pub(super) fn element(&self) -> Result<Box<dyn Element>, SceneError> {
        build!(self, &self.scene.element, Element)
    }

    /// `materials` with the densities that masses are made of: 0 where a material gives none and the scene needs none, loads at
    /// rest without weight; and why there is no mass then.
    pub(super) fn weights(&self, materials: &[Material]) -> (Vec<Material>, Option<Located<String>>) {
        let weighs = match &self.scene.analysis {
            Analysis::Static(loads) => loads.iter().any(|load| matches!(load.kind, LoadKind::Gravity { .. })),
            Analysis::Impact(_) | Analysis::Modes { .. } => true,
            Analysis::Buckling { .. } => false,
        };
        let mut weights = materials.to_vec();
        if weighs {
            return (weights, None);
        }
        weights.iter_mut().for_each(|material| material.density = material.density.or(Some(0.0)));
        let laminates = self.scene.laminates.iter();
        let mut plies =
            laminates.flat_map(|spec| &spec.laminate.value.plies).map(|ply| &self.scene.materials[ply.material]);
        let lacks = plies.find_map(|material| {
            let why = material.value.mass_density().err()?;
            Some(Located { place: material.place.clone(), value: why.to_string() })
        });
        (weights, lacks)
    }

    pub(super) fn law(&self, impactor: &scene::ImpactorSpec) -> Result<Box<dyn ContactLaw>, SceneError> {
        build!(self, &impactor.contact, Contact)
    }

    pub(super) fn integrator(&self, impact: &scene::ImpactSpec) -> Result<Box<dyn Integrator>, SceneError> {
        let integrator = build!(self, &impact.march.integrator, Integrator).map(located)?;
        Ok(match impact.march.tolerance {
            Some(tolerance) => divided(integrator, tolerance),
            None => integrator,
        })
    }

    pub(super) fn reduction(&self, impact: &scene::ImpactSpec) -> Result<Option<Box<dyn Reduction>>, SceneError> {
        let spec = &impact.reduction;
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

    /// How many vectors a reduction makes, by its parameter that says so; none without a reduction.
    pub(super) fn vectors(&self, spec: &PluginSpec) -> Option<usize> {
        let size = self.registry.info(Kind::Reduction, &spec.name.value)?.params_of(Role::Size).next();
        Some(size.and_then(|row| spec.params.count(row).ok()).unwrap_or(VECTORS).max(1))
    }

    pub(super) fn criteria(&self, element: &dyn Element) -> Result<Vec<NamedCriterion>, SceneError> {
        let each = |spec: &CriterionSpec| {
            let criterion = build!(self, &spec.plugin, Criterion)?;
            self.check_criterion(&spec.plugin, &*criterion)?;
            self.check_scope(&spec.plugin, &*criterion, element)?;
            Ok((spec.label.clone(), criterion))
        };
        self.scene.failure.criteria.iter().map(each).collect()
    }

    /// Refuses a criterion that has nothing to judge, or that a material does not suit.
    fn check_criterion(&self, spec: &PluginSpec, criterion: &dyn FailureCriterion) -> Result<(), SceneError> {
        let name = &spec.name.value;
        let judged: BTreeSet<usize> = match (criterion.info().site, &self.scene.interface) {
            (Site::Ply, _) => self.scene.plies().map(|ply| ply.material).collect(),
            (Site::Interface, Some(resin)) => BTreeSet::from([resin.value]),
            (Site::Interface, None) => {
                return Err(self.error(
                    &spec.name,
                    format!(
                        "criterion `{name}` judges the resin between plies, and the laminate names no material for it"
                    ),
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

    /// Refuses a criterion that an impact would sooner or later ask for stresses beyond its scope.
    fn check_scope(
        &self,
        spec: &PluginSpec,
        criterion: &dyn FailureCriterion,
        element: &dyn Element,
    ) -> Result<(), SceneError> {
        let squeezed = if element.info().is_shell() { 0.0 } else { -SMALL };
        let stress = Stress6::new([SMALL, SMALL, squeezed, SMALL, SMALL, SMALL]);
        let struck = matches!(self.scene.analysis, Analysis::Impact(_)) && criterion.info().site == Site::Ply;
        let refuses = |material: &Material| {
            let mut indices = vec![0.0; criterion.info().modes.len()];
            criterion.indices(&stress, material, &mut indices);
            indices.iter().all(|index| index.is_nan())
        };
        let mut plies = self.scene.plies().map(|ply| &self.scene.materials[ply.material].value);
        match struck && plies.any(refuses) {
            true => Err(self.error(
                &spec.name,
                format!("under an impact there are stresses that criterion `{}` does not judge", spec.name.value),
                format!("it takes {}", criterion.scope()),
            )),
            false => Ok(()),
        }
    }

    /// Quads near one of `centres` that the symmetry keeps; all of these where the scene gives no radius.
    pub(super) fn find_watched(&self, plate: &Plate, centres: &[[f64; 2]]) -> Result<Vec<usize>, SceneError> {
        let failure = &self.scene.failure;
        let (low, high) = plate.plane.bounds();
        let longer = (high[0] - low[0]).max(high[1] - low[1]);
        if let Window::Square(side) = failure.window
            && side > longer
            && !failure.criteria.is_empty()
        {
            let [side, longer] = [side, longer].map(|length| Dimension::LENGTH.of(length));
            let message = format!("`failure.window` of {side} is wider than the plate is long, {longer}");
            let help =
                "stresses would be means over all of the plate: take about the thickness of a ply, or \"element\"";
            return Err(self.scene.source.error_at(&failure.place, message, help));
        }
        let kept = plate.symmetry().quads().map(|(quad, _)| quad);
        let Some(radius) = failure.radius else { return Ok(kept.collect()) };
        if centres.is_empty() {
            let message = "`failure.radius` is measured from the impact, and this analysis has none";
            return Err(self.scene.source.error_at(&failure.place, message, "leave it out"));
        }
        let watched: Vec<usize> = kept.filter(is_within(plate, centres, radius)).collect();
        if watched.is_empty() {
            let message = "no cell has its centre within `failure.radius` of the impact";
            return Err(self.scene.source.error_at(&failure.place, message, "enlarge the radius or leave it out"));
        }
        Ok(watched)
    }

    /// Centres of windows, along the fibres of this `angle`, around `places` in the cells that are watched, where the scene's
    /// windows do not follow the mesh, and the cells that they and their images lie in.
    pub(super) fn find_centres(
        &self,
        (plate, angle): (&Plate, f64),
        watched: &[usize],
        places: &[[f64; 2]],
    ) -> Vec<(Centre, Vec<usize>)> {
        let Window::Square(side) = self.scene.failure.window else { return Vec::new() };
        if self.scene.failure.criteria.is_empty() {
            return Vec::new();
        }
        let windows = Windows::new(&plate.plane, (side, angle), |quad| plate.region(quad));
        let is_watched = |quad: usize| watched.binary_search(&quad).is_ok();
        let distinct = places.iter().enumerate().filter(|(k, place)| !places[..*k].contains(place));
        let lattices = distinct.flat_map(|(_, place)| windows.lattice(*place, REACH, is_watched));
        let symmetry = plate.symmetry();
        let with_images = |(centre, holding): (Centre, Vec<usize>)| {
            let kept: BTreeSet<usize> = holding.into_iter().map(|quad| symmetry.quad(quad)).collect();
            (centre, (0..plate.plane.quads.len()).filter(|quad| kept.contains(&symmetry.quad(*quad))).collect())
        };
        lattices.map(with_images).collect()
    }

    pub(super) fn group<'p>(&self, plate: &'p Plate, group: &Located<String>) -> Result<&'p Group, SceneError> {
        let groups = &plate.plane.groups;
        groups.get(&group.value).ok_or_else(|| {
            self.error(
                group,
                format!("the mesh has no group `{}`", group.value),
                format!("`{}` {}", group.value, unknown_key(&group.value, groups.keys().map(String::as_str))),
            )
        })
    }

    /// Columns of a group.
    pub(super) fn columns(&self, plate: &Plate, group: &Located<String>) -> Result<Vec<u32>, SceneError> {
        Ok(plate.columns_of_group(self.group(plate, group)?))
    }

    /// Columns and levels of the nodes that a set names, for the sake of these of their unknowns.
    pub(super) fn nodes(&self, plate: &Plate, set: &NodeSet, dofs: &[Dof]) -> Result<Vec<ColumnLevels>, SceneError> {
        let columns = self.columns(plate, &set.group)?;
        self.check_height(plate, set.levels, dofs, &set.group.place)?;
        set.levels.at(plate, &columns).map_err(|why| self.error(&set.group, why.to_string(), ""))
    }

    /// The same one by one.
    pub(super) fn each_node(
        &self,
        plate: &Plate,
        set: &NodeSet,
        dofs: &[Dof],
    ) -> Result<Vec<(u32, usize)>, SceneError> {
        let mut all = Vec::new();
        for (columns, levels) in self.nodes(plate, set, dofs)? {
            all.extend(columns.iter().flat_map(|column| levels.iter().map(move |level| (*column, *level))));
        }
        Ok(all)
    }

    pub(super) fn constraints(&self, plate: &Plate, element: &dyn Element) -> Result<Held<'_>, SceneError> {
        let source = &self.scene.source;
        let mut equations = Vec::new();
        // Of each equation, where it stands in the scene.
        let mut places = Vec::new();
        let (mut restraint, mut described) = (None, Vec::new());
        let mut turns = Turns::default();
        let mut springs = Springs::default();
        self.free_edges(plate)?;
        for entry in &self.scene.supports {
            match entry {
                Support::RestrainRigidMotions { place } => restraint = Some(place),
                Support::Kind { area, kind: kind @ SupportKind::Free, .. } => {
                    self.holds(plate, entry, &mut turns)?;
                    described.push(format!("{}, {}: nothing", area.value, kind.name()));
                }
                _ => {
                    let (name, holds) = self.holds(plate, entry, &mut turns)?;
                    if let Some(sprung) = self.add_springs((plate, element), entry, &mut springs)? {
                        described.push(sprung);
                        continue;
                    }
                    described.push(describe(plate, entry, &name, &holds));
                    let before = equations.len();
                    let origin = format!("support of {name}");
                    equations.extend(holds.iter().flat_map(|hold| hold.equations(plate, &origin)));
                    let nodes = holds.iter().any(|hold| !hold.columns.is_empty());
                    if equations.len() == before && nodes {
                        let help = "the element has none of the unknowns that it names";
                        return Err(source.error_at(entry.place(), format!("the {origin} fixes nothing"), help));
                    }
                    places.resize(equations.len(), entry.place());
                }
            }
        }
        self.ties(plate, &mut turns, &mut equations, &mut places)?;
        let driven = self.driven(plate, &mut equations, &mut places)?;
        self.symmetric_supports(plate, &equations, &places)?;
        equations.extend(plate.seam_ties());
        equations.extend(plate.symmetry().equations(plate));
        places.resize(equations.len(), self.scene.symmetry.as_ref().map_or(&Place::TOP, |symmetry| &symmetry.place));
        // What springs hold does not move as a whole either.
        let sprung = |spring: &SupportSpring| Equation {
            terms: spring.at.0.clone(),
            value: 0.0,
            origin: String::new(),
            holds: false,
        };
        let holding: Vec<Equation> = equations.iter().cloned().chain(springs.all.iter().map(sprung)).collect();
        self.hold_pieces(plate, &holding)?;
        let free = FreeMotions::of(plate, &holding);
        let at_rest = matches!(self.scene.analysis, Analysis::Static(_));
        match restraint {
            _ if free.is_empty() => {}
            // A plate at rest has to be somewhere; one that moves does so freely.
            Some(place) if at_rest => {
                equations.extend(free.restrain(plate).map_err(|why| source.error_at(place, why.to_string(), ""))?);
                places.resize(equations.len(), place);
            }
            Some(_) => {}
            // Rigid motions are modes like others.
            None if matches!(self.scene.analysis, Analysis::Modes { .. }) => {}
            None => {
                return Err(source.error_at(
                    self.scene.supports.first().map_or(&Place::TOP, Support::place),
                    format!("the supports leave the plate free: {}", free.names()),
                    "support the plate against it, or add `{ restrain = \"rigid-motions\" }` to `support`",
                ));
            }
        }
        let constraints = self.eliminate(plate, &equations, &places)?;
        let motions = if at_rest { Vec::new() } else { free.of_unknowns(plate, &constraints) };
        let between = self.between(plate, &constraints)?;
        Ok(Held {
            constraints,
            equations,
            motions,
            between,
            described,
            driven,
            springs,
            restraint: restraint.map(|place| (free, place)),
        })
    }

    /// Adds the couples and equations of the scene, and where they stand.
    pub(super) fn ties<'s>(
        &'s self,
        plate: &Plate,
        turns: &mut Turns,
        equations: &mut Vec<Equation>,
        places: &mut Vec<&'s Place>,
    ) -> Result<(), SceneError> {
        for couple in &self.scene.couples {
            let nodes = self.each_node(plate, &couple.nodes, &couple.dofs)?;
            let origin = format!("couple of `{}`", couple.nodes.group.value);
            let coupled = support::couple(plate, &nodes, &couple.dofs, turns.settle(couple.axes), &origin);
            if coupled.is_empty() {
                let message = format!("the {origin} ties nothing");
                let help = "a couple needs two nodes or more, and unknowns that the element has";
                return Err(self.scene.source.error_at(&couple.place, message, help));
            }
            equations.extend(coupled);
            places.resize(equations.len(), &couple.place);
        }
        for (number, equation) in self.scene.equations.iter().enumerate() {
            equations.push(self.equation(plate, equation, number, turns)?);
            places.push(&equation.place);
        }
        Ok(())
    }

    /// What supports and couples leave free between the nodes that they hold.
    fn between(&self, plate: &Plate, constraints: &Constraints) -> Result<Vec<Functional>, SceneError> {
        let mut found = Vec::new();
        let fixed = self.scene.supports.iter().filter_map(|entry| match entry {
            Support::Fix { nodes, dofs, axes, .. } => Some((nodes, dofs, axes)),
            _ => None,
        });
        let coupled = self.scene.couples.iter().map(|couple| (&couple.nodes, &couple.dofs, &couple.axes));
        for (nodes, dofs, axes) in fixed.chain(coupled) {
            let group = self.group(plate, &nodes.group)?;
            let levels = |column: u32| nodes.levels.of(plate, column as usize).unwrap_or_default();
            found.extend(between::between(plate, group, levels, dofs, *axes));
        }
        let left = found.iter().filter(|terms| !constraints.implies(terms));
        Ok(orthogonalise(left.map(|terms| Functional(constraints.restrict(terms))).collect()))
    }

    /// What the user should know of unknowns that supports and couples name and the element lacks.
    pub(super) fn lacking(&self, plate: &Plate) -> Result<Vec<String>, SceneError> {
        let fixed = self.scene.supports.iter().filter_map(|support| match support {
            // In turned axes an unknown is a sum of several.
            Support::Fix { nodes, dofs, axes, .. } if *axes == 0.0 => Some(("support", nodes, dofs)),
            _ => None,
        });
        let coupled = self.scene.couples.iter().map(|couple| ("couple", &couple.nodes, &couple.dofs));
        let mut warnings = Vec::new();
        for (what, nodes, dofs) in fixed.chain(coupled) {
            let nodes_of = self.each_node(plate, nodes, dofs)?;
            let has = |dof: &Dof| nodes_of.iter().any(|(c, l)| plate.dofs_at(*c as usize, *l, *dof).next().is_some());
            let names: Vec<_> = dofs.iter().filter(|dof| !has(dof)).map(Dof::to_string).collect();
            if !names.is_empty() && !nodes_of.is_empty() {
                warnings.push(format!(
                    "{} of {} unknowns in the {what} of `{}` are not of this element, and nothing holds them: {}; take them \
                     out, or choose an element that has them",
                    names.len(),
                    dofs.len(),
                    nodes.group.value,
                    names.join(", ")
                ));
            }
        }
        Ok(warnings)
    }

    /// Refuses a plate of pieces that move against each other.
    fn hold_pieces(&self, plate: &Plate, equations: &[Equation]) -> Result<(), SceneError> {
        let Some(piece) = pieces::loose(plate, equations) else { return Ok(()) };
        let [x, y] = piece.centre.map(|x| x * 1e3);
        let message = format!(
            "a piece of the plate ({} of its cells, about ({x:.4}, {y:.4}) mm) can move against the rest: neither cells nor \
             supports hold it",
            piece.cells
        );
        let help = "let its surface share curves with the others in gmsh (Coherence; or BooleanFragments), support it, or \
                    leave it out of the physical groups";
        Err(self.scene.source.error_at(self.scene.supports.first().map_or(&Place::TOP, Support::place), message, help))
    }

    /// Eliminates `equations`, which stand at `places`.
    pub(super) fn eliminate(
        &self,
        plate: &Plate,
        equations: &[Equation],
        places: &[&Place],
    ) -> Result<Constraints, SceneError> {
        Constraints::eliminate(&elimination_order(plate), equations).map_err(|why| {
            let at = equations.iter().position(|e| e.origin == why.origin()).and_then(|i| places.get(i));
            self.scene.source.error_at(at.copied().unwrap_or(&Place::TOP), why.to_string(), "")
        })
    }

    fn equation(
        &self,
        plate: &Plate,
        equation: &scene::EquationSpec,
        number: usize,
        turns: &mut Turns,
    ) -> Result<Equation, SceneError> {
        let mut terms = Vec::new();
        for term in &equation.terms {
            let nodes = self.each_node(plate, &term.node, &[term.dof])?;
            let [(column, level)] = nodes[..] else {
                let has = if nodes.is_empty() { "none that can move" } else { "more" };
                return Err(self.error(
                    &term.node.group,
                    format!("a term of an equation takes a single node, but `{}` has {has}", term.node.group.value),
                    "name a group of one node and one level",
                ));
            };
            let sides = support::turned(plate, column as usize, level, term.dof, turns.settle(term.axes));
            let own = sides.first().ok_or_else(|| {
                self.error(&term.node.group, format!("the element has no {}", term.dof), "choose another unknown")
            })?;
            if matches!(term.dof.m(), 1 | 2) && plate.is_on_seam(column as usize, level) {
                let message = format!(
                    "{} at {} is of two values: strains jump there, where laminates lie beside each other",
                    term.dof,
                    plate.describe_column(column as usize)
                );
                return Err(self.error(&term.node.group, message, "name a node beside the line"));
            }
            terms.extend(own.iter().map(|(dof, factor)| (*dof, term.factor * factor)));
        }
        Ok(Equation { terms, value: 0.0, origin: format!("equation {}", number + 1), holds: false })
    }
}

/// Whether the centre of a quad is within `radius` of one of `centres`.
pub(super) fn is_within(plate: &Plate, centres: &[[f64; 2]], radius: f64) -> impl Fn(&usize) -> bool {
    move |quad| {
        let c = plate.plane.corners(*quad).centroid();
        centres.iter().any(|centre| (c[0] - centre[0]).hypot(c[1] - centre[1]) <= radius)
    }
}
