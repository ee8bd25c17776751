//! What a model is for: an impact, loads at rest, natural modes, buckling.

use super::NamedCriterion;
use super::builder::Builder;
use super::path::PathPlan;
use crate::effect::Effects;
use crate::error::Error;
use crate::registry::NO_REDUCTION;
use fem_core::constraint::Constraints;
use fem_core::contact::ContactLaw;
use fem_core::dof::Dof;
use fem_core::element::Element;
use fem_core::failure::Site;
use fem_core::functional::Functional;
use fem_core::load::{self, Face};
use fem_core::material::{Elastic, Material, Strength};
use fem_core::patch;
use fem_core::plate::{Plate, PlateError};
use fem_core::plugin::{Dimension, Value};
use fem_core::profile::{Mirrors, Profile};
use fem_core::reduction::Reduction;
use fem_core::time::Integrator;
use fem_dynamics::impact::Tip;
use fem_io::scene::{
    self, Analysis, ContactLoad, ImpactPoint, Load, LoadKind, Located, Place, ProfileLine, SceneError, Window,
};
use fem_io::units::parse_as;
use std::collections::BTreeMap;

/// Fewest cells whose stresses can be differentiated.
const LEAST_CELLS: usize = 4;

/// Distance of two places that are the same, m.
const SAME: f64 = 1e-9;

/// Relative difference of two moduli that count as one.
const ALIKE: f64 = 1e-3;

/// What is computed, made concrete.
#[derive(Debug, Clone)]
pub enum Plan {
    /// The response to an impact.
    Impact(Box<Impact>),
    /// Displacements and stresses under loads at rest.
    Static {
        /// Nodal forces, one per unknown before elimination of constraints: N, or N m for derivatives.
        forces: Vec<f64>,
        /// How loads are followed while interfaces open, where they may.
        path: Option<PathPlan>,
    },
    /// The lowest natural frequencies.
    Modes {
        /// How many.
        count: usize,
    },
    /// The factors on the preload that buckle the plate.
    Buckling {
        /// How many.
        count: usize,
    },
}

/// An impact: what strikes where, and the march.
#[derive(Debug, Clone)]
pub struct Impact {
    /// What the scene says of it.
    pub spec: scene::ImpactSpec,
    /// The contact of each impactor of the scene.
    pub strikes: Vec<Strike>,
    /// The reduction, if any.
    pub reduction: Option<Box<dyn Reduction>>,
    /// Governors that the scene names, independent unknowns.
    pub keep: Vec<usize>,
    /// How many vectors the reduction makes, about, if any.
    pub vectors: Option<usize>,
    /// The integrator.
    pub integrator: Box<dyn Integrator>,
}

/// The contact of an impactor with the plate.
#[derive(Debug, Clone)]
pub struct Strike {
    /// Weights of the deflection under the impactor over the independent unknowns.
    pub contact: Functional,
    /// Where the impactor strikes, m.
    pub centre: [f64; 2],
    /// Weights of the squeeze, the deflection under the impactor less that of the surface below, which its indentation counts from; `None`
    /// where that is the face itself.
    pub squeeze: Option<Functional>,
    /// Radius of the spherical tip, m, and weights of the deflections under its rings, if it has one.
    pub tip: Option<(f64, Vec<Functional>)>,
    /// The contact law.
    pub law: Box<dyn ContactLaw>,
}

/// A profile of the scene and its place in the plate.
#[derive(Debug, Clone)]
pub struct NamedProfile {
    /// What the scene says of it.
    pub line: ProfileLine,
    /// Where it is, m.
    pub point: [f64; 2],
    /// The line through the plate.
    pub profile: Profile,
    /// Pressure on the bottom and on the top face there, Pa.
    pub pressures: [f64; 2],
}

/// An impact on a node at the edge, where supports are those of a plane of symmetry: on a part of a plate, as it is made by hand.
pub(super) fn warn_of_parts(strikes: &[Strike], plate: &Plate, constraints: &Constraints) -> Vec<String> {
    let outline = plate.outline();
    let part = |strike: &Strike| {
        let column = *outline.iter().find(|column| plate.columns[**column as usize] == strike.centre)? as usize;
        let held = |n: u8| {
            let level = plate.reference_level(column);
            let dof = Dof::new(n, 0).and_then(|dof| plate.dofs_at(column, level, dof).next())?;
            constraints.implies(&[(dof, 1.0)]).then(|| format!("U{n}0"))
        };
        let held: Vec<String> = [1, 2].into_iter().filter_map(held).collect();
        let share = ["a half", "a quarter"].get(held.len().checked_sub(1)?)?;
        let [x, y] = strike.centre.map(|x| x * 1e3);
        Some(format!(
            "the impact at ({x:.4}, {y:.4}) mm is on the edge, where supports hold {} as in {share} of a symmetric plate: if the \
             mesh is that, its impactor must have {share} of the mass; or give the whole plate and a `symmetry`",
            held.join(" and ")
        ))
    };
    strikes.iter().filter_map(part).collect()
}

/// Windows of means that are cut off at a plane of symmetry, behind which the plate goes on, at the cells `watched`.
pub(super) fn warn_of_cut_windows(
    window: Window,
    watched: &[usize],
    plate: &Plate,
    mirrors: &Mirrors,
) -> Option<String> {
    let Window::Square(side) = window else { return None };
    let is_cut = |quad: &&usize| {
        let corners = plate.plane.corners(**quad);
        plate.plane.quality(**quad).area < side * side && mirrors.are_near(corners.centroid(), 0.5 * side)
    };
    let cut = watched.iter().filter(is_cut).count();
    (cut > 0).then(|| {
        format!(
            "at {cut} cells near an edge whose supports are those of a plane of symmetry, `failure.window` of {} is cut off with the \
             plate: indices there may be some 10 % too small; give the whole plate and a `symmetry`, or window = \"element\"",
            Dimension::LENGTH.of(side)
        )
    })
}

/// Strengths of an interface that differ along x and y of the plate, which its plies do not know.
pub(super) fn warn_of_axes(resin: &Material, criteria: &[NamedCriterion]) -> Option<String> {
    let along = [Strength::S13, Strength::S23];
    let [Some(s13), Some(s23)] = along.map(|which| resin.strengths.get(which)) else { return None };
    let asks = |(_, criterion): &&NamedCriterion| {
        let info = criterion.info();
        info.site == Site::Interface && along.iter().all(|which| info.strengths.contains(which))
    };
    let (label, _) = criteria.iter().find(asks).filter(|_| s13 != s23)?;
    let [s13, s23] = [s13, s23].map(|strength| Dimension::PRESSURE.of(strength));
    Some(format!(
        "`{label}` judges tractions between plies along x and y of the plate, whatever the plies beside them, and `{}` has an S13 of \
         {s13} and an S23 of {s23}: its indices hang on how the plate lies; give both the same",
        resin.name
    ))
}

/// A material between plies whose moduli differ along x and y of the plate, which its plies do not know.
pub(super) fn warn_of_stiffness(resin: &Material, criteria: &[NamedCriterion]) -> Option<String> {
    let Elastic { e1, e2, nu13, nu23, g13, g23, .. } = resin.elastic;
    let alike = |a: f64, b: f64| (a - b).abs() <= ALIKE * a.abs().max(b.abs());
    let (label, _) = criteria.iter().find(|(_, criterion)| criterion.info().site == Site::Interface)?;
    (!(alike(e1, e2) && alike(nu13, nu23) && alike(g13, g23))).then(|| {
        format!(
            "`{label}` judges stresses between plies of `{}`, whose moduli along x and y of the plate differ, whatever the plies beside \
             it: its indices hang on how the plate lies; name a resin as `laminate.interface`",
            resin.name
        )
    })
}

/// Profiles where laminates meet: on either side stresses are others.
pub(super) fn warn_of_sides(profiles: &[NamedProfile], plate: &Plate) -> Vec<String> {
    let side = |named: &NamedProfile| {
        let quad = named.profile.quads().next()?;
        let [x, y] = plate.plane.corners(quad).centroid().map(|x| x * 1e3);
        Some(format!(
            "profile `{}` is where laminates meet: its stresses are those on the side of cell {}, about ({x:.4}, {y:.4}) mm; move it off \
             the line to choose a side",
            named.line.name.value, plate.plane.quad_tags[quad]
        ))
    };
    profiles.iter().filter(|named| named.profile.is_between_regions()).filter_map(side).collect()
}

impl Builder<'_> {
    pub(super) fn impact(
        &self,
        spec: &scene::ImpactSpec,
        plate: &Plate,
        element: &dyn Element,
        constraints: &Constraints,
    ) -> Result<Impact, SceneError> {
        let strike = |impactor: &scene::ImpactorSpec| {
            let (centre, contact) = self.contact_place(impactor, 0.0, plate, element)?;
            self.symmetric_impact(plate, &impactor.at, centre)?;
            let place = contact;
            let contact = Functional(constraints.restrict(&place.0));
            let held = held_below(plate, constraints, &place);
            let beside = held.is_some_and(|[x, y]| (x - centre[0]).hypot(y - centre[1]) > SAME);
            if beside && !contact.0.is_empty() {
                let message = "the supports hold the node that takes most of the impact";
                let help = "divide the cells there, so that the node nearest to the impact is free, or move the impact or the support";
                return Err(self.error(&impactor.at, message, help));
            }
            if held.is_some() || contact.0.is_empty() {
                let message = "the supports hold the plate exactly where the impactor strikes";
                return Err(self.error(&impactor.at, message, "move the impact or the support"));
            }
            let squeeze = match &impactor.indentation_from {
                Some(from) => Some(self.squeeze((impactor, from), (plate, element), constraints, &place)?),
                None => None,
            };
            let tip = match impactor.load.value {
                ContactLoad::Tip { radius } => {
                    Some((radius, self.rings((impactor, radius, spec), (plate, element), constraints)?))
                }
                _ => None,
            };
            Ok(Strike { contact, centre, squeeze, tip, law: self.law(impactor)? })
        };
        let strikes: Vec<Strike> = spec.impactors.iter().map(strike).collect::<Result<_, _>>()?;
        self.apart(spec, &strikes, plate)?;
        Ok(Impact {
            strikes,
            reduction: self.reduction(spec)?,
            keep: self.keep(spec, plate, constraints)?,
            vectors: self.vectors(&spec.reduction),
            integrator: self.integrator(spec)?,
            spec: spec.clone(),
        })
    }

    /// Refuses impactors so near to each other that one squeezes the plate where the indentation of another counts from inside it.
    fn apart(&self, spec: &scene::ImpactSpec, strikes: &[Strike], plate: &Plate) -> Result<(), SceneError> {
        let thickness = plate.levels.last().zip(plate.levels.first()).map_or(0.0, |(top, bottom)| top - bottom);
        for (i, (one, strike)) in spec.impactors.iter().zip(strikes).enumerate() {
            let Some(from) = &one.indentation_from else { continue };
            for (other, beside) in
                spec.impactors.iter().zip(strikes).enumerate().filter(|(k, _)| *k != i).map(|(_, of)| of)
            {
                let distance = (strike.centre[0] - beside.centre[0]).hypot(strike.centre[1] - beside.centre[1]);
                if strike.squeeze.is_some() && distance < one.load.value.reach() + other.load.value.reach() + thickness
                {
                    let message = format!(
                        "`{}` and `{}` strike less than a thickness apart, and each would have to know how the other squeezes the plate",
                        one.name, other.name
                    );
                    return Err(self.error(from, message, "take `indentation_from = \"face\"`, or move them apart"));
                }
            }
        }
        Ok(())
    }

    /// Refuses to follow modes that the plan does not have.
    pub(super) fn modes(&self, plan: &Plan) -> Result<(), SceneError> {
        let reduced = matches!(plan, Plan::Impact(impact) if impact.reduction.is_some());
        match &self.scene.output.modes {
            Some(modes) if !reduced => Err(self.error(
                modes,
                "`output.modes` follows the modes of a reduced plate, and this analysis has none",
                "name a reduction, for example: reduction = { method = \"ritz\", vectors = 40 }; or leave `output.modes` out",
            )),
            _ => Ok(()),
        }
    }

    pub(super) fn forces(
        &self,
        loads: &[Load],
        effects: &Effects,
        plate: &Plate,
        element: &dyn Element,
        constraints: &Constraints,
    ) -> Result<Vec<f64>, Error> {
        if loads.is_empty() && !effects.nature().strained {
            let help = "write, for example: load = [{ pressure = \"1 MPa\", face = \"top\" }]";
            return Err(self.scene.source.error_at(&Place::TOP, "`load` is missing", help).into());
        }
        let mut forces = vec![0.0; plate.ndof()];
        loads.iter().try_for_each(|load| self.add_load(load, plate, element, &mut forces))?;
        // The image of a load may be another one; where all together break the symmetry, one alone does.
        if let Some(why) = loads.last().and_then(|last| self.symmetric_load(plate, &forces, &last.place).err()) {
            for load in loads {
                let mut own = vec![0.0; plate.ndof()];
                self.add_load(load, plate, element, &mut own)?;
                self.symmetric_load(plate, &own, &load.place)?;
            }
            return Err(why.into());
        }
        let loaded: Vec<_> = forces.iter().copied().enumerate().filter(|(_, force)| *force != 0.0).collect();
        match loads.last() {
            Some(Load { place, .. }) if !loaded.is_empty() && constraints.implies(&loaded) => {
                let message = "the supports take all of the load: it moves nothing";
                let help = "load nodes that the supports do not hold in the direction of the load";
                Err(self.scene.source.error_at(place, message, help).into())
            }
            _ => Ok(forces),
        }
    }

    /// Adds the forces of a load.
    pub(super) fn add_load(
        &self,
        Load { kind, place }: &Load,
        plate: &Plate,
        element: &dyn Element,
        forces: &mut [f64],
    ) -> Result<(), Error> {
        match kind {
            LoadKind::Pressure { pressure, face, group } => {
                let quads = self.pressed(plate, group)?;
                load::pressure(plate, element, *face, quads, |at| pressure.at(at), forces);
            }
            LoadKind::Patch { force, at, radius } => {
                let (centre, _) = self.point(plate, at)?;
                let patch = patch::hertz(plate, element, (Face::Top, 0.0), centre, *radius).map_err(|why| {
                    self.scene.source.error_at(place, why.to_string(), "choose a smaller `patch_radius`, or move it")
                })?;
                patch.add_to(*force, forces);
            }
            LoadKind::Edge { force_per_length, group } => {
                let edges = &self.group(plate, group)?.edges;
                if edges.is_empty() {
                    return Err(self
                        .error(
                            group,
                            "the group has no edges that can move",
                            "name a physical curve that is not clamped",
                        )
                        .into());
                }
                load::edge(plate, element, edges, *force_per_length, forces);
            }
            LoadKind::Point { force, node } => {
                let along = (1..).zip(force).filter(|(_, f)| **f != 0.0);
                let along: Vec<Dof> = along.filter_map(|(n, _)| Dof::new(n, 0)).collect();
                let nodes = self.each_node(plate, node, &along)?;
                let [(column, level)] = nodes[..] else {
                    let has = if nodes.is_empty() { "none that can move" } else { "more" };
                    let message = format!("a force acts at one node, and `{}` has {has}", node.group.value);
                    return Err(self.error(&node.group, message, "name a group of one node and one level").into());
                };
                load::point(plate, column as usize, level, *force, forces)
                    .map_err(|why| self.error(&node.group, why.to_string(), ""))?;
            }
            // Those who follow a path find its force.
            LoadKind::Displacement { .. } => {}
            LoadKind::Gravity { acceleration } => {
                load::gravity(plate, element, *acceleration, forces)?;
            }
        }
        if !forces.iter().all(|f| f.is_finite()) {
            let help = "look for a division by zero, or a root of something negative, in the formula";
            return Err(self
                .scene
                .source
                .error_at(place, "the load is not finite somewhere on the plate", help)
                .into());
        }
        Ok(())
    }

    pub(super) fn profiles(&self, plate: &Plate, mirrors: &Mirrors) -> Result<Vec<NamedProfile>, SceneError> {
        let cells = plate.plane.quads.len();
        let each = |line: &ProfileLine| {
            let (point, _) = self.point(plate, &line.at)?;
            let Some(profile) = Profile::at(plate, mirrors, point) else {
                return Err(self.error(
                    &line.at,
                    "the point lies outside the plate, or in what is clamped of it",
                    "move it",
                ));
            };
            if line.equilibrium == Some(true) && cells < LEAST_CELLS {
                let message = format!("the stresses of {cells} cells cannot be differentiated for `equilibrium`");
                let help = format!("use at least {LEAST_CELLS} cells, or leave `equilibrium` out");
                return Err(self.error(&line.name, message, help));
            }
            let pressures = self.pressures(plate, &profile, point)?;
            Ok(NamedProfile { line: line.clone(), point, profile, pressures })
        };
        self.scene.profiles.iter().map(each).collect()
    }

    /// What presses on the bottom and on the top face at a point: where loaded and free cells meet, the mean over the cells.
    fn pressures(&self, plate: &Plate, profile: &Profile, point: [f64; 2]) -> Result<[f64; 2], SceneError> {
        let mut sums = [0.0; 2];
        let Analysis::Static(loads) = &self.scene.analysis else { return Ok(sums) };
        for load in loads {
            match &load.kind {
                LoadKind::Pressure { pressure, face, group } => {
                    let share = match group {
                        None => 1.0,
                        Some(name) => {
                            let loaded = &self.group(plate, name)?.quads;
                            let pressed = profile.quads().filter(|q| loaded.contains(&(*q as u32))).count();
                            pressed as f64 / profile.quads().len() as f64
                        }
                    };
                    if share > 0.0 {
                        sums[usize::from(*face == Face::Top)] += share * pressure.at(point);
                    }
                }
                LoadKind::Patch { force, at, radius } => {
                    let (centre, _) = self.point(plate, at)?;
                    sums[1] += force * patch::hertz_pressure(centre, *radius, point);
                }
                LoadKind::Edge { .. }
                | LoadKind::Point { .. }
                | LoadKind::Displacement { .. }
                | LoadKind::Gravity { .. } => {}
            }
        }
        Ok(sums)
    }

    /// A place on the plate, m, and the column of the node there if there is one.
    pub(super) fn point(
        &self,
        plate: &Plate,
        at: &Located<ImpactPoint>,
    ) -> Result<([f64; 2], Option<usize>), SceneError> {
        Ok(match &at.value {
            ImpactPoint::Group(name) => {
                let group = Located { value: name.clone(), place: at.place.clone() };
                let columns = self.columns(plate, &group)?;
                let [column] = columns[..] else {
                    let dim = plate.plane.groups.get(name).map_or(0, |g| g.dim);
                    return Err(self.error(
                        at,
                        format!("the group `{name}` (dimension {dim}) has {} nodes, a point has one", columns.len()),
                        "make a physical point of the place in gmsh, or give `at = { x = ..., y = ... }`",
                    ));
                };
                (plate.columns[column as usize], Some(column as usize))
            }
            ImpactPoint::Point(p) => {
                let reach = plate.plane.reach();
                let near = |q: &[f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]) <= reach;
                (*p, plate.columns.iter().position(near))
            }
        })
    }

    /// The deflection of a contact `place` less that of the surface that its indentation counts `from`.
    fn squeeze(
        &self,
        (impactor, from): (&scene::ImpactorSpec, &Located<f64>),
        (plate, element): (&Plate, &dyn Element),
        constraints: &Constraints,
        place: &Functional,
    ) -> Result<Functional, SceneError> {
        if impactor.load.value == ContactLoad::Node {
            return Err(self.error(
                from,
                "a force at one node squeezes a solid without limit as cells shrink",
                "give the impactor a patch (`patch_radius`), or leave `indentation_from` out",
            ));
        }
        let (_, Functional(mut below)) = self.contact_place(impactor, from.value, plate, element)?;
        below.iter_mut().for_each(|(_, weight)| *weight = -*weight);
        below.extend(&place.0);
        Ok(Functional(constraints.restrict(&below)))
    }

    /// The deflections under the rings of a tip of `radius`, m.
    fn rings(
        &self,
        (impactor, radius, spec): (&scene::ImpactorSpec, f64, &scene::ImpactSpec),
        (plate, element): (&Plate, &dyn Element),
        constraints: &Constraints,
    ) -> Result<Vec<Functional>, SceneError> {
        const PATCH: &str = "or give the impactor a `patch_radius` in the place of `tip_radius`";
        let refuse = |message: &str, help: &str| Err(self.error(&impactor.load, message, format!("{help}, {PATCH}")));
        if self.scene.substructures.is_some() || spec.reduction.name.value != NO_REDUCTION {
            let help = "march the full plate, reduction = { method = \"none\" } without `substructures`";
            return refuse("a reduced plate does not know how it is bent under a tip", help);
        }
        if self.integrator(spec)?.limit().product().is_some() {
            let help = "choose an implicit integrator, for example: integrator = \"newmark\"";
            return refuse("the stable step of an explicit integrator is not known under a tip", help);
        }
        if impactor.indentation_from.is_some() {
            return refuse("under a tip indentations count from the face", "leave `indentation_from` out");
        }
        let of_law = match impactor.contact.params.get("radius") {
            Some(Value::Text(text)) => parse_as(text, Dimension::LENGTH).ok(),
            _ => None,
        };
        if let Some(of_law) = of_law.filter(|of_law| (of_law - radius).abs() > SAME) {
            let [of_law, radius] = [of_law, radius].map(|radius| Dimension::LENGTH.of(radius));
            let message = format!("the `radius` of the contact law is {of_law}, and the tip's {radius}");
            return Err(self.error(&impactor.load, message, "a tip has one radius: give the same twice"));
        }
        let (centre, _) = self.point(plate, &impactor.at)?;
        let ring = |radii: [f64; 2]| {
            let found = patch::ring(plate, element, (impactor.face, 0.0), centre, radii);
            let mean = found.map_err(|why| self.beyond(impactor, plate, centre, why, "tip_radius"))?;
            Ok(Functional(constraints.restrict(&mean.0)))
        };
        Tip::radii(radius).map(ring).collect()
    }

    /// Where the impactor strikes, and the deflection there, or at a `depth` in thicknesses below it, as weights of the unknowns.
    fn contact_place(
        &self,
        impactor: &scene::ImpactorSpec,
        depth: f64,
        plate: &Plate,
        element: &dyn Element,
    ) -> Result<([f64; 2], Functional), SceneError> {
        let at = &impactor.at;
        let (centre, column) = self.point(plate, at)?;
        let too_large = |why: PlateError, key: &str| self.beyond(impactor, plate, centre, why, key);
        let face = impactor.face;
        let contact = match (impactor.load.value, column) {
            (ContactLoad::Patch { radius }, _) => patch::hertz(plate, element, (face, depth), centre, radius)
                .map_err(|why| too_large(why, "patch_radius"))?,
            (ContactLoad::Tip { radius }, _) => {
                patch::hertz(plate, element, (face, depth), centre, ContactLoad::OF_TIP * radius)
                    .map_err(|why| too_large(why, "tip_radius"))?
            }
            (ContactLoad::Square { side }, _) => patch::square(plate, element, (face, depth), centre, side)
                .map_err(|why| too_large(why, "patch_side"))?,
            (ContactLoad::Node, Some(column)) => patch::node(plate, face, column).ok_or_else(|| {
                let help = "strike between the edges, or choose another element or a patch (`patch_radius`)";
                self.error(at, "the element has no U30 at this node of the mesh", help)
            })?,
            (ContactLoad::Node, None) => {
                return Err(self.error(
                    at,
                    "no node of the mesh lies at the impact point",
                    "put a node there, name a group, or use a patch (`patch_radius`)",
                ));
            }
        };
        Ok((centre, contact))
    }

    /// A contact that leaves the plate, or the height at which it is struck.
    fn beyond(
        &self,
        impactor: &scene::ImpactorSpec,
        plate: &Plate,
        centre: [f64; 2],
        why: PlateError,
        key: &str,
    ) -> SceneError {
        let (low, high) = plate.plane.bounds();
        if (0..2).any(|d| !(low[d]..=high[d]).contains(&centre[d])) {
            let message = format!(
                "x, y = {} lies outside the plate, or in what is clamped of it",
                Dimension::LENGTH.list(&centre)
            );
            let help = format!(
                "x runs from {} to {} and y from {} to {}, if `mesh.unit` is right",
                Dimension::LENGTH.of(low[0]),
                Dimension::LENGTH.of(high[0]),
                Dimension::LENGTH.of(low[1]),
                Dimension::LENGTH.of(high[1])
            );
            return self.error(&impactor.at, message, help);
        }
        if matches!(why, PlateError::PatchOverStep { .. }) {
            let help = format!(
                "an impactor touches the higher side alone: move it off the step, or choose a smaller `impactor.{key}`"
            );
            return self.error(&impactor.load, why.to_string(), help);
        }
        let [width, depth] = [0, 1].map(|d| Dimension::LENGTH.of(high[d] - low[d]));
        let size = format!("the plate is {width} by {depth}, if `mesh.unit` is right");
        self.error(&impactor.load, why.to_string(), format!("choose a smaller `impactor.{key}`; {size}"))
    }
}

/// Where the node column is on which most of a contact is, if a support holds a deflection of that.
fn held_below(plate: &Plate, constraints: &Constraints, contact: &Functional) -> Option<[f64; 2]> {
    let mut shares: BTreeMap<usize, f64> = BTreeMap::new();
    contact.0.iter().for_each(|(dof, w)| *shares.entry(plate.locate(*dof).0).or_default() += w.abs());
    let (column, _) = shares.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut deflections = (0..plate.levels.len()).flat_map(|level| plate.dofs_at(column, level, Dof::SOLID[8]));
    deflections.any(|dof| constraints.row(dof).0.is_empty()).then(|| plate.columns[column])
}
