//! From a scene to a model: everything that is decided before the first matrix.

mod builder;
mod constants;
mod cracks;
mod effects;
mod fields;
mod gauge;
mod heights;
mod jumps;
mod laws;
mod loaded;
mod locked;
mod memory;
mod mesh;
mod origin;
mod path;
mod plan;
mod preload;
mod regions;
mod separation;
mod spacing;
mod span;
mod springs;
mod still;
mod strike;
mod substructures;
mod supports;
mod symmetry;
mod turns;

pub(crate) use cracks::mean_cell;
pub use fields::FieldPlan;
pub use gauge::Gauge;
pub(crate) use mesh::examined_mesh;
pub use mesh::mesh;
pub use origin::Origin;
pub use path::PathPlan;
pub use plan::{Impact, NamedProfile, Plan, Strike};
pub(crate) use separation::Separation;
pub(crate) use spacing::count_steps;
pub(crate) use strike::{leaves_march, leaves_plate};

use crate::effect::{Decision, Effects};
use crate::effects::{GrowingDelaminations, NonlinearPlies};
use crate::error::Error;
use crate::registry::Registry;
use builder::Builder;
use fem_core::assembly::Division;
use fem_core::constraint::Constraints;
use fem_core::dof::Dof;
use fem_core::element::{Element, Tables};
use fem_core::failure::FailureCriterion;
use fem_core::functional::{Functional, orthogonalise};
use fem_core::laminate::Laminate;
use fem_core::laws::PlyLaws;
use fem_core::material::{Material, MaterialError};
use fem_core::mesh::PlaneMesh;
use fem_core::pieces;
use fem_core::plate::Plate;
use fem_core::plugin::Dimension;
use fem_core::profile::Mirrors;
use fem_core::recovery::PlyHeights;
use fem_core::springs::SupportSpring;
use fem_core::warping;
use fem_core::window::Centre;
use fem_failure::delamination::DelaminationThreshold;
use fem_io::cache::Cache;
use fem_io::scene::{self, Analysis, Damage, Located, Output, Place, Scene, SceneError, Window};
use separation::Split;
use std::borrow::Borrow;
use tracing::info;

/// A scene made concrete: mesh extruded, plug-ins built, supports turned into constraints, impact or loads placed.
#[derive(Debug, Clone)]
pub struct Model {
    /// Where it comes from.
    pub origin: Origin,
    /// Materials; layups and stations refer to them by index.
    pub materials: Vec<Material>,
    /// Why there is no mass, where nothing that the scene asks for needs one and a material gives none.
    pub weightless: Option<Located<String>>,
    /// The laminate under the first impactor, or the first where nothing strikes.
    pub laminate: Laminate,
    /// The laminates of the plate's regions.
    pub laminates: Vec<Laminate>,
    /// What results call these, where plies of one number do not lie at one height in all of them.
    pub region_names: Vec<String>,
    /// Mass per area of that laminate, kg/m².
    pub areal_mass: f64,
    /// Mass of the plate, kg.
    pub mass: f64,
    /// Cells and unknowns.
    pub plate: Plate,
    /// The element of all cells.
    pub element: Box<dyn Element>,
    /// The laws that plies follow, if some are not linear elastic.
    pub laws: Option<PlyLaws>,
    /// The interfaces that may open, if some may.
    pub separation: Option<Separation>,
    /// Supports and other equations, eliminated.
    pub constraints: Constraints,
    /// What each support holds, in words.
    pub supports: Vec<String>,
    /// What supports of nodal values leave free between the nodes, sums of the independent unknowns.
    pub between: Vec<Functional>,
    /// How the plate can move as a whole, by its independent unknowns, one motion after the other; at rest it cannot.
    pub motions: Vec<f64>,
    /// Springs of supports that give way, of the independent unknowns.
    pub springs: Vec<SupportSpring>,
    /// Whether the supports, or a restraint, stop all rigid motions. One that moves is restrained to the frame that goes with it.
    pub held: bool,
    /// The substructures, if the scene divides the plate into some.
    pub division: Option<Division>,
    /// What is computed.
    pub plan: Plan,
    /// Lines through the thickness along which stresses are wanted.
    pub profiles: Vec<NamedProfile>,
    /// Criteria by name; none when damage is off.
    pub criteria: Vec<NamedCriterion>,
    /// What stresses are averaged over in the plane.
    pub window: Window,
    /// Where in its height a ply is judged.
    pub heights: PlyHeights,
    /// Time between two scans of a march, s.
    pub sample_every: f64,
    /// Material of the resin between plies, for criteria that look there; counts in `materials`.
    pub interface: Option<usize>,
    /// Quads whose stresses the criteria judge; of those that a symmetry maps onto each other one.
    pub watched: Vec<usize>,
    /// Centres of windows around impacts and narrow loads, where stresses are computed as well.
    pub centres: Vec<Centre>,
    /// The cells that each of these, or an image of it, lies in.
    pub centre_cells: Vec<Vec<usize>>,
    /// Places whose indices are kept over time.
    pub gauges: Vec<Gauge>,
    /// What is written.
    pub output: Output,
    /// Fields that are written.
    pub fields: Option<FieldPlan>,
    /// Force at which the laminate delaminates, where that is looked for and a material gives the toughness.
    pub threshold: Option<DelaminationThreshold>,
    /// The same with delaminations that grow, where the scene leaves them to the advisor, who has not decided yet. Until then they
    /// do not.
    pub grown: Option<Box<Model>>,
    /// The same impact on a plate that does not come apart, where delaminations grow: what formulas and modes are of.
    pub sound: Option<Box<Model>>,
    /// Why there is none where delaminations grow.
    unsound: Option<String>,
    /// What is simulated beyond the linear elastic plate.
    pub effects: Effects,
    /// What the advisor decided of that.
    pub decisions: Vec<Decision>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Which cells are no part of the plate, since supports keep them still.
    pub left_out: Option<String>,
    /// Where plates are kept for later runs, if they are.
    pub cache: Option<Cache>,
}

/// A criterion under the name by which the scene calls it.
pub type NamedCriterion = (String, Box<dyn FailureCriterion>);

/// Thickness over size of the plate outside of which the mesh's unit is probably wrong.
const PLAUSIBLE_THICKNESS: std::ops::Range<f64> = 1e-4..0.5;

/// The same outside of which there is no plate.
const POSSIBLE_THICKNESS: std::ops::Range<f64> = 1e-6..2.0;

/// Error of a deflection by straight edges along a curve that is worth a warning, and its size over θ², θ the turn from
/// edge to edge: the area that the edges cut off, θ²/6, or three times that where an element has nodes in the middle of
/// edges, because a support at these holds a polygon (16 edges round a circle: 7.5 %).
const POLYGON_ERROR: f64 = 3e-3;
const POLYGON: [f64; 2] = [1.0 / 6.0, 0.5];

/// Error of a deflection by flat solid cells that is worth a warning, and its size over (b/h)² (b/a)⁴, b the width of a
/// cell, h the thickness, a the side of the plate (measured: 18 % with b/h = 125, b/a = 1/8).
const FLAT_ERROR: f64 = 5e-3;
const FLAT: f64 = 0.05;

/// Share of its stretch along one axis that a material under equal pressure from all sides yields, below which solid cells
/// misjudge stresses: 1 − 2ν of an isotropic one, ν > 0.45 (measured in strips: 3 % at 0.44, 20 % at 0.49).
const INCOMPRESSIBLE: f64 = 0.1;

/// Excess of a shell's deflections that is worth a warning.
const WARPING_ERROR: f64 = 0.02;

/// Inner angle of a cell (degrees) beyond which its strains are poor.
const POOR_ANGLE: f64 = 150.0;

impl Model {
    /// Builds the model of `scene` with the plug-ins of `registry`.
    ///
    /// # Errors
    /// Whatever the scene names and the mesh or the registry does not have, and supports that do not fit together or
    /// leave a rigid motion.
    pub fn new(scene: impl Borrow<Scene>, registry: &Registry) -> Result<Self, Error> {
        let scene = scene.borrow();
        let mut builder = Builder::new(scene, registry);
        let read = mesh(scene)?;
        let mut warnings = read.warnings;
        let mut mesh = read.mesh;
        let left_out = builder.leave_out_clamped(&mut mesh);
        info!(quads = mesh.quads.len(), nodes = mesh.points.len(), "mesh");
        let materials: Vec<Material> = scene.materials.iter().map(|m| m.value.clone()).collect();
        let (mut laminates, of_specs) = regions::distinct(&scene.laminates);
        let element = builder.element()?;
        let shell = element.info().is_shell();
        let mut split = builder.split(&mut laminates)?;
        if shell && split.is_none() {
            builder.hold_whole(&mut laminates, &of_specs);
        }
        warnings.extend(check_sizes(&builder, &mesh, &laminates)?);
        if !shell {
            builder.share_levels(&mut laminates, &of_specs)?;
        }
        warnings.extend(mesh::straighten(&mut mesh, &*element));
        let criteria = match scene.effects.damage {
            Damage::Off => Vec::new(),
            Damage::Onset => builder.criteria(&*element)?,
        };
        if criteria.is_empty() && scene.effects.damage == Damage::Onset && scene.keys.contains_key("effects.damage") {
            warnings.push(
                "`effects.damage` is \"onset\", and no criterion is named: damage is not looked for; name one, for example \
                 failure = { criteria = [\"hashin-1980\"] }"
                    .into(),
            );
        }
        let mut effects = builder.effects(&*element, &criteria)?;
        builder.goes_with_growth(&effects)?;

        // A shell has one reference surface, about which its plies may lie to one side.
        let levels = |laminate: &Laminate| match laminate.layers.len() {
            1 if shell => laminate.about_reference().to_vec(),
            _ => laminate.levels(),
        };
        let lacks = |why: MaterialError| {
            let material = scene.materials.iter().find(|m| m.value.name == why.material).unwrap_or(&scene.materials[0]);
            builder.error(material, why.to_string(), origin::DENSITY)
        };
        let at_rest = matches!(scene.analysis, Analysis::Static(_));
        let (weights, weightless) = builder.weights(&materials);
        let stacks = |laminate: &Laminate| {
            let mut stacks = laminate.stacks_between(&levels(laminate), &weights).map_err(lacks)?;
            if builder.has_laws() {
                builder.check_contrast(&stacks)?;
                // A law needs the strains where it is asked, and what it takes off is measured against theirs.
                stacks.iter_mut().for_each(|stack| stack.transverse = None);
            }
            for effect in effects.acting() {
                effect.on_stacks(at_rest, laminate, &materials, &mut stacks).map_err(lacks)?;
            }
            Ok::<_, Error>(stacks)
        };
        let help = mesh::other_shape(&mesh, &Tables::from(&*element));
        let own = stacks(&laminates[0])?;
        let mut plate = Plate::new(mesh, levels(&laminates[0]), own, &*element, scene.z_derivatives.value)
            .map_err(|why| builder.error(&scene.element.name, why.to_string(), help))?;
        for (quads, laminate) in builder.regions(&plate, &of_specs)?.iter().zip(&laminates).skip(1) {
            plate
                .assign(quads, levels(laminate), stacks(laminate)?)
                .map_err(|why| builder.error(&scene.laminates[0].laminate, why.to_string(), ""))?;
        }
        plate.let_strains_jump(|a, b| jumps::are_unlike(&laminates[a], &laminates[b]));
        builder.check_steps(&plate, &of_specs)?;
        if let Some(split) = &mut split {
            builder.separate(split, &mut plate)?;
        }
        builder.fold(&mut plate, &laminates, &materials, &criteria)?;
        memory::check(&plate)?;
        warnings.extend(warn_of_pieces(&plate));
        warnings.extend(polygon(&plate));
        warnings.extend(plate.plane.coarse_circles().into_iter().map(warn_of_corners));
        warnings.extend(warn_of_flat_cells(&plate));
        warnings.extend(incompressible(&plate, &laminates, &materials));
        warnings.extend(constants::unlikely(&laminates, &materials));
        warnings.extend(constants::twice(&laminates, &materials, &scene.laws));
        let mut supports = builder.constraints(&plate, &*element)?;
        if shell {
            let span = span::of(&plate, &supports);
            warnings.extend(laminates.iter().find_map(|laminate| warn_of_warping(laminate, &materials, span)));
        }
        builder.check_springs(&plate, &supports.springs, &effects)?;
        builder.preload(&plate, &*element, &supports, &mut effects)?;
        let constraints = &supports.constraints;
        warnings.extend(builder.locked(&plate)?);
        warnings.extend(builder.jumps(&plate)?);
        warnings.extend(builder.lacking(&plate)?);
        warnings.extend(builder.turning(&plate));
        warnings.extend(builder.nearly_turned(&plate)?);
        let plan = match &scene.analysis {
            Analysis::Impact(spec) => Plan::Impact(Box::new(builder.impact(spec, &plate, &*element, constraints)?)),
            Analysis::Static(loads) => {
                let forces = builder.forces(loads, &effects, &plate, &*element, constraints)?;
                warnings.extend(builder.unresolved(&plate, loads)?);
                supports.check_balance(scene, &plate, &forces)?;
                let of = (&plate, &*element);
                let path = builder.path(of, &laminates[0], &materials, (&supports, &forces))?;
                Plan::Static { forces, path }
            }
            Analysis::Modes { count } => Plan::Modes { count: *count },
            Analysis::Buckling { count } => Plan::Buckling { count: *count },
        };
        let centres: Vec<_> = match &plan {
            Plan::Impact(impact) => impact.strikes.iter().map(|strike| strike.centre).collect(),
            _ => Vec::new(),
        };
        if let Plan::Impact(impact) = &plan {
            warnings.extend(plan::warn_of_parts(&impact.strikes, &plate, constraints));
        }
        let struck =
            |centre: [f64; 2]| (0..plate.plane.quads.len()).find(|q| plate.plane.corners(*q).locate(centre).is_some());
        let region = centres.first().and_then(|centre| struck(*centre)).map_or(0, |quad| plate.region(quad));
        let laminate = laminates[region].clone();
        let areal_masses: Vec<f64> = laminates
            .iter()
            .map(|of_region| of_region.areal_mass(&weights))
            .collect::<Result<_, _>>()
            .map_err(lacks)?;
        let areal_mass = areal_masses[region];
        let mass = match areal_masses[..] {
            [everywhere] => everywhere * plate.plane.area(),
            _ => (0..plate.plane.quads.len())
                .map(|quad| areal_masses[plate.region(quad)] * plate.plane.quality(quad).area)
                .sum(),
        };
        builder.modes(&plan)?;
        if let Plan::Impact(impact) = &plan {
            // Looks at every step are all that there can be.
            let every = scene.failure.every;
            let looks = Some(every).filter(|_| !criteria.is_empty() && every > impact.spec.march.step.value);
            let intervals = [("output.history_every", scene.output.history_every), ("failure.every", looks)];
            warnings.extend(spacing::check(&impact.spec.march, &intervals));
            warnings.extend(spacing::check_parts(impact));
        }
        let division = builder.division(&plate, constraints, &plan)?;
        let watched = builder.find_watched(&plate, &centres)?;
        warnings.extend(builder.spread_window(&plate, &watched));
        let gauges = builder.gauges(&plate, &laminates, &watched, &criteria)?;
        let fields = builder.fields(&plate, &centres, split.is_some())?;
        let loaded = match &scene.analysis {
            Analysis::Static(loads) => builder.loaded(&plate, loads)?,
            _ => centres.clone(),
        };
        let around = builder.find_centres((&plate, laminate.plies[0].angle), &watched, &loaded);
        let (centres, centre_cells) = around.into_iter().unzip();
        let resin = scene.interface.as_ref().map(|resin| resin.value);
        warnings.extend(resin.and_then(|resin| plan::warn_of_axes(&materials[resin], &criteria)));
        warnings.extend(resin.and_then(|resin| plan::warn_of_stiffness(&materials[resin], &criteria)));
        let threshold = builder.threshold(DelaminationThreshold::of(&laminate, &materials, resin))?;
        let mirrors = Mirrors::of(&plate, constraints);
        let judged: &[usize] = if criteria.is_empty() { &[] } else { &watched };
        warnings.extend(plan::warn_of_cut_windows(scene.failure.window, judged, &plate, &mirrors));
        let profiles = builder.profiles(&plate, &mirrors)?;
        warnings.extend(plan::warn_of_sides(&profiles, &plate));
        let zone = split.as_ref().and_then(Split::zone);
        let laws = builder.laws(&plate, &laminates, &materials, &*element, zone)?;
        warnings.extend(laws.iter().flat_map(|laws| laws.warnings(&plate, &*element)));
        let mut separation = None;
        if let Some(split) = &split {
            let equations = std::mem::take(&mut supports.equations);
            let built = builder.separation(split, &plate, &*element, &laminate, &materials, equations)?;
            let step = scene.impact().map(|impact| impact.march.step.value);
            warnings.extend(built.warnings(step));
            warnings.extend(step.and_then(|step| Separation::held_down(&supports.springs.all, mass, step)));
            let (interfaces, plies) = (built.interfaces.clone(), laws.is_some());
            effects.act(Box::new(GrowingDelaminations { interfaces, plies }));
            separation = Some(built);
        } else if let Some(laws) = &laws {
            effects.act(Box::new(NonlinearPlies(laws.clone())));
        }
        let (sound, unsound) = match builder.other(scene.sound.as_deref()) {
            Err(why) if effects.undecided() => return Err(why),
            Err(why) => (None, Some(why.to_string())),
            Ok(sound) => (sound, None),
        };
        let names: Vec<_> = criteria.iter().map(|(name, _)| name.as_str()).collect();
        info!(element = scene.element.name.value, criteria = names.join(", "), unknowns = constraints.ndof(), "model");
        Ok(Self {
            origin: Origin::of(scene),
            weightless,
            materials,
            laminate,
            region_names: regions::names(&laminates, &scene.laminates, &of_specs),
            laminates,
            areal_mass,
            mass,
            plate,
            element,
            laws,
            separation,
            held: supports.motions.is_empty() || supports.restraint.is_some(),
            springs: supports.springs.restrict(&supports.constraints),
            constraints: supports.constraints,
            supports: supports.described,
            left_out,
            between: supports.between,
            motions: supports.motions,
            division,
            plan,
            profiles,
            criteria,
            window: scene.failure.window,
            heights: scene.failure.plies,
            sample_every: scene.failure.every,
            interface: resin,
            watched,
            centres,
            centre_cells,
            gauges,
            output: scene.output.clone(),
            fields,
            threshold,
            grown: builder.other(scene.grown.as_deref())?,
            sound,
            unsound,
            effects,
            decisions: Vec::new(),
            warnings,
            cache: registry.cache().cloned(),
        })
    }

    /// The plate that does not come apart, where delaminations grow: that of formulas, modes and matrices.
    ///
    /// # Errors
    /// There is none: what the scene asks for is only for plates that come apart.
    pub fn whole(&self) -> Result<&Self, Error> {
        match (&self.sound, &self.separation) {
            (Some(sound), _) => Ok(sound),
            (None, Some(_)) => {
                let why = self.unsound.as_ref().map_or_else(String::new, |why| format!(": {why}"));
                let message = format!(
                    "formulas, modes and matrices are of a plate that holds together, and this scene makes none{why}"
                );
                let help =
                    "set effects = { delamination = \"off\" } and see what else goes only with plates that come apart";
                Err(self.origin.source.error_at(&Place::TOP, message, help).into())
            }
            (None, None) => Ok(self),
        }
    }

    /// The springs that only push.
    pub fn one_sided(&self) -> impl Iterator<Item = &SupportSpring> {
        self.springs.iter().filter(|spring| spring.one_sided)
    }

    /// What a reduced plate answers to beside its contacts: where a spring that only pushes has let go, the force that it does not get.
    pub(crate) fn lifting(&self) -> Vec<Functional> {
        orthogonalise(self.one_sided().map(|spring| spring.at.clone()).collect())
    }

    /// Whether a mass can be made.
    ///
    /// # Errors
    /// A material that lacks a density.
    pub(crate) fn check_mass(&self) -> Result<(), Error> {
        let Some(why) = &self.weightless else { return Ok(()) };
        Err(self.origin.source.error_at(&why.place, why.value.clone(), origin::DENSITY).into())
    }

    /// Whether the plate has velocities: in an impact, unless it follows the force at rest.
    pub fn moves(&self) -> bool {
        matches!(self.plan, Plan::Impact(_)) && self.effects.nature().inertia
    }

    /// The impactors of the scene.
    pub fn impactors(&self) -> &[scene::ImpactorSpec] {
        match &self.plan {
            Plan::Impact(impact) => &impact.spec.impactors,
            Plan::Static { .. } | Plan::Modes { .. } | Plan::Buckling { .. } => &[],
        }
    }

    /// What results call the region of a quad, where that says which plies are meant.
    pub fn region_of(&self, quad: usize) -> Option<&str> {
        self.region_names.get(self.plate.region(quad)).map(String::as_str)
    }

    /// Thickness of the laminate at a place, m; that of the one that is struck first where no cell is.
    pub fn thickness_at(&self, place: [f64; 2]) -> f64 {
        let plane = &self.plate.plane;
        let quad = (0..plane.quads.len()).find(|quad| plane.corners(*quad).locate(place).is_some());
        quad.map_or(&self.laminate, |quad| &self.laminates[self.plate.region(quad)]).thickness()
    }

    /// What results call an impactor: nothing where it is the only one.
    pub fn label<'a>(&self, impactor: &'a scene::ImpactorSpec) -> Option<&'a str> {
        (self.impactors().len() > 1).then_some(impactor.name.as_str())
    }

    /// Governors that a reduction may choose from, best first: those that the scene names, then deflections (U30 at the mid-plane or
    /// the lowest level), each as far as possible from the contacts and from those before it, so that any first few cover the plate
    /// evenly.
    pub fn governors(&self, impact: &Impact, count: usize) -> Vec<usize> {
        let Some(deflection) = Dof::new(3, 0) else { return Vec::new() };
        let candidates: Vec<(usize, [f64; 2])> = (0..self.plate.columns.len())
            .filter_map(|column| {
                let dof = self.plate.dofs_at(column, self.plate.reference_level(column), deflection).next()?;
                Some((self.constraints.position(dof)?, self.plate.columns[column]))
            })
            .collect();
        let square = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        let named = impact.keep.iter().map(|i| self.plate.columns[self.plate.locate(self.constraints.original(*i)).0]);
        let taken: Vec<[f64; 2]> = impact.strikes.iter().map(|strike| strike.centre).chain(named).collect();
        let from_taken = |c: &(usize, [f64; 2])| taken.iter().map(|p| square(c.1, *p)).fold(f64::INFINITY, f64::min);
        let mut distance: Vec<f64> = candidates.iter().map(from_taken).collect();
        let mut chosen = impact.keep.clone();
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

/// Pieces that are held each on their own are a plate each.
fn warn_of_pieces(plate: &Plate) -> Option<String> {
    let pieces = pieces::pieces(plate);
    let smallest = pieces.iter().min_by_key(|piece| piece.cells).filter(|_| pieces.len() > 1)?;
    let [x, y] = smallest.centre.map(|x| x * 1e3);
    Some(format!(
        "the mesh is {} pieces that no side joins, the smallest of {} cells about ({x:.4}, {y:.4}) mm: if they should be one \
         plate, let their surfaces share curves in gmsh (Coherence; or BooleanFragments)",
        pieces.len(),
        smallest.cells
    ))
}

fn polygon(plate: &Plate) -> Option<String> {
    let turn = plate.plane.curved_turn();
    let at_middles = plate.columns.len() > plate.plane.points.len();
    let error = POLYGON[usize::from(at_middles)] * turn * turn;
    (error > POLYGON_ERROR).then(|| {
        format!(
            "the edges along a curve turn by up to {:.1} degrees: straight edges cost about {:.1} % of a deflection; divide \
             the curve more finely",
            turn.to_degrees(),
            error * 100.0
        )
    })
}

fn warn_of_corners(([x, y], sides): ([f64; 2], usize)) -> String {
    let [x, y] = [x, y].map(|x| x * 1e3);
    format!(
        "the edges around ({x:.4}, {y:.4}) mm are taken for a polygon of {sides} corners: if they stand for a circle, divide it into 16 \
         edges or more, or write the mesh with sides of second order"
    )
}

/// Solids bend too stiffly where cells are much wider than the plate is thick.
fn warn_of_flat_cells(plate: &Plate) -> Option<String> {
    let mesh = &plate.plane;
    let widest = (0..mesh.quads.len()).map(|q| mesh.quality(q).area.sqrt()).fold(0.0, f64::max);
    let (low, high) = mesh.bounds();
    let side = (high[0] - low[0]).max(high[1] - low[1]);
    let over_thickness = widest / (plate.levels[plate.levels.len() - 1] - plate.levels[0]);
    let error = FLAT * over_thickness.powi(2) * (widest / side).powi(4);
    (!plate.info().is_shell() && error > FLAT_ERROR).then(|| {
        format!(
            "cells up to {over_thickness:.0} times as wide as the plate is thick bend too stiffly, by up to {:.1} %: \
             make them narrower or use the shell `mitc4`",
            error.min(1.0) * 100.0
        )
    })
}

/// A shell whose section warps more than first-order shear deformation knows.
fn warn_of_warping(laminate: &Laminate, materials: &[Material], span: f64) -> Option<String> {
    let excess = warping::shell_excess(laminate, materials, span);
    (excess > WARPING_ERROR).then(|| {
        format!(
            "the section of this laminate warps, which a shell cannot: deflections are too large by about {:.0} %; use the \
             solid `hermite-prism`",
            100.0 * excess
        )
    })
}

/// The pressure in a material that hardly changes its volume is not a function of the strains of a solid cell:
/// deflections are right, stresses swing about the right ones from point to point.
fn incompressible(plate: &Plate, laminates: &[Laminate], materials: &[Material]) -> Option<String> {
    let yields = |material: &&Material| {
        let s = material.elastic.compliance();
        let sum: f64 = s[..3].iter().flat_map(|row| &row[..3]).sum();
        sum / (s[0][0] + s[1][1] + s[2][2])
    };
    let used = laminates.iter().flat_map(|laminate| &laminate.plies).map(|ply| &materials[ply.material]);
    let worst = used.min_by(|a, b| yields(a).total_cmp(&yields(b))).filter(|m| yields(m) < INCOMPRESSIBLE)?;
    (!plate.info().is_shell()).then(|| {
        format!(
            "material `{}` is nearly incompressible: stresses in its cells may be far off; lower its Poisson's ratios \
             (those of an isotropic material below 0.45) or use the shell `mitc4`",
            worst.name
        )
    })
}

fn check_sizes(builder: &Builder<'_>, mesh: &PlaneMesh, laminates: &[Laminate]) -> Result<Vec<String>, SceneError> {
    let mut warnings = Vec::new();
    let (low, high) = mesh.bounds();
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let thickness = laminates.iter().map(Laminate::thickness).fold(0.0, f64::max);
    let ratio = thickness / size;
    let sizes = [size, thickness].map(|length| Dimension::LENGTH.of(length));
    let sizes = format!("the plate is {} wide and {} thick", sizes[0], sizes[1]);
    if !POSSIBLE_THICKNESS.contains(&ratio) {
        let help = "look at `laminate.ply_thickness` and at `mesh.unit`, the unit of the mesh file";
        return Err(builder.error(&builder.scene.laminates[0].laminate, sizes, help));
    }
    if !PLAUSIBLE_THICKNESS.contains(&ratio) {
        warnings.push(format!("{sizes}: is `mesh.unit` the unit of the mesh file?"));
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
    Ok(warnings)
}
