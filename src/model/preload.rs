//! Edges that are loaded before the supports hold them.

use super::builder::{Builder, Held};
use crate::effect::{EdgeLoad, Effects, Gripped};
use crate::error::Error;
use fem_core::assembly::elimination_order;
use fem_core::axes::Turns;
use fem_core::constraint::{Constraints, Equation};
use fem_core::dof::Dof;
use fem_core::element::Element;
use fem_core::hold::{Hold, SupportKind, What};
use fem_core::load;
use fem_core::mesh::Group;
use fem_core::plate::Plate;
use fem_core::support::{FreeMotions, Levels, turned};
use fem_io::scene::{Analysis, Located, Place, SceneError, Support, SupportArea};
use std::collections::{BTreeMap, BTreeSet};

/// Sine of the angle between two edges of one line.
const SAME_LINE: f64 = 1e-6;

/// An edge, whatever its direction.
fn undirected([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Builder<'_> {
    /// Tells effects that load edges before all else how the plate is held and loaded meanwhile: what supports hold in the plane
    /// of these edges they hold afterwards alone, and what is left free of rigid motions is restrained.
    pub(super) fn preload(
        &self,
        plate: &Plate,
        element: &dyn Element,
        held: &Held<'_>,
        effects: &mut Effects,
    ) -> Result<(), Error> {
        let buckles = matches!(self.scene.analysis, Analysis::Buckling { .. });
        let Some(edges) = effects.edges().map(<[EdgeLoad]>::to_vec) else {
            let help = "write, for example: effects = { preload = [{ group = \"x-max\", force = \"-1 N/mm\" }] }";
            let missing =
                || self.scene.source.error_at(&Place::TOP, "`effects.preload` is missing: nothing buckles", help);
            return if buckles { Err(missing().into()) } else { Ok(()) };
        };
        let normals = outer_normals(plate);
        let mut named = BTreeSet::new();
        let mut forces = vec![0.0; plate.ndof()];
        for one in &edges {
            let group = self.loaded_edges(plate, one, &normals)?;
            for edge in &group.edges {
                if !named.insert(undirected(*edge)) {
                    let message = format!("edges of `{}` belong to another entry as well", one.group.value);
                    return Err(self.error(&one.group, message, "load every edge once").into());
                }
            }
            let EdgeLoad { force, shear, .. } = one;
            let traction = |[x, y]: [f64; 2]| [force * x - shear * y, force * y + shear * x, 0.0];
            load::tractions(plate, element, &group.edges, traction, &mut forces);
        }
        let first = &edges[0].group;
        self.symmetric_load(plate, &forces, &first.place)?;
        if !held.motions.is_empty() {
            let message =
                "the supports leave the plate free to move, and forces that keep their direction would turn it";
            let help = "support it against rigid motions, also in its plane";
            return Err(self.error(first, message, help).into());
        }
        let mut turns = Turns::default();
        let mut equations = self.supports_beside(plate, &named, &mut turns)?;
        let (mut ties, mut places) = (Vec::new(), Vec::new());
        self.ties(plate, &mut turns, &mut ties, &mut places)?;
        equations.extend(ties);
        let mut prescribed = Vec::new();
        for one in &edges {
            prescribed.extend(self.prescribed(plate, one, &normals, &mut turns)?);
        }
        let symmetric = plate.symmetry().equations(plate);
        let free = FreeMotions::of(plate, &[&equations[..], &symmetric].concat());
        if free.follow(plate, &prescribed) {
            let message = format!("its displacements move the plate as a whole and strain nothing: {}", free.names());
            let help = "move the opposite edge as well, or leave it to supports that hold it across";
            return Err(self.error(first, message, help).into());
        }
        equations.extend(prescribed);
        equations.extend(plate.seam_ties());
        equations.extend(symmetric);
        let free = FreeMotions::of(plate, &equations);
        if let Some(motions) = free.pushed(plate, &forces) {
            let message = format!("the preload pushes the plate where nothing holds it: {motions}");
            let help = "load the opposite edge as well, or leave it to the supports by not naming it";
            return Err(self.error(first, message, help).into());
        }
        equations.extend(free.restrain(plate).map_err(|why| self.error(first, why.to_string(), ""))?);
        let constraints = Constraints::eliminate(&elimination_order(plate), &equations).map_err(|why| {
            let help =
                "where a neighbouring edge is held by a support, name it too: force = \"0 N/mm\" frees it meanwhile";
            self.error(first, format!("`effects.preload`: {why}"), help)
        })?;
        let loaded: Vec<_> = forces.iter().copied().enumerate().filter(|(_, force)| *force != 0.0).collect();
        if !loaded.is_empty() && constraints.implies(&loaded) {
            let help = "name the edges beside it too: force = \"0 N/mm\" frees them while others are loaded";
            return Err(self.error(first, "the supports take all of the preload: it moves nothing", help).into());
        }
        let moved = edges.iter().any(|one| one.displacement.is_some_and(|by| by != 0.0));
        if buckles && loaded.is_empty() && !moved {
            return Err(self.error(first, "the preload is zero: nothing buckles", "give it a force").into());
        }
        effects.on_edges(&Gripped { constraints, forces });
        Ok(())
    }

    /// The group of an entry: edges of the plate's outline.
    fn loaded_edges<'p>(&self, plate: &'p Plate, one: &EdgeLoad, normals: &Normals) -> Result<&'p Group, SceneError> {
        let group = self.group(plate, &one.group)?;
        if group.edges.is_empty() {
            return Err(self.error(&one.group, "the group has no edges", "name a physical curve, such as `x-max`"));
        }
        if group.edges.iter().any(|edge| !normals.contains_key(&undirected(*edge))) {
            let message = format!("`{}` lies inside the plate", one.group.value);
            return Err(self.error(&one.group, message, "a preload acts on edges of the plate's outline"));
        }
        Ok(group)
    }

    /// What the supports hold of a plate whose edges `named` are left to themselves in the plane. A node where a support goes on
    /// along another edge stays held, and so do planes of symmetry.
    fn supports_beside(
        &self,
        plate: &Plate,
        named: &BTreeSet<[u32; 2]>,
        turns: &mut Turns,
    ) -> Result<Vec<Equation>, SceneError> {
        let columns = |edges: Vec<[u32; 2]>| -> BTreeSet<u32> {
            let nodes: BTreeSet<u32> = edges.iter().flatten().copied().collect();
            let group = Group { dim: 1, nodes: nodes.into_iter().collect(), edges, quads: Vec::new() };
            plate.columns_of_group(&group).into_iter().collect()
        };
        let of_named = columns(named.iter().copied().collect());
        let mut equations = Vec::new();
        for support in &self.scene.supports {
            let (name, holds) = self.holds(plate, support, turns)?;
            let edges: &[[u32; 2]] = match support {
                // A cut through the plate is no edge.
                Support::Kind { kind: SupportKind::Symmetry, .. } => {
                    equations.extend(holds.iter().flat_map(|hold| hold.equations(plate, &name)));
                    continue;
                }
                Support::Kind { area: Located { value: SupportArea::Group(group), .. }, .. } => edges_of(plate, group),
                Support::Fix { nodes, .. } => edges_of(plate, &nodes.group.value),
                Support::Kind { .. } | Support::RestrainRigidMotions { .. } => &[],
            };
            let beside = columns(edges.iter().filter(|edge| !named.contains(&undirected(**edge))).copied().collect());
            let is_released = |column: &&u32| of_named.contains(column) && !beside.contains(column);
            let (jumps, holds): (Vec<Hold>, Vec<Hold>) = holds.into_iter().partition(|hold| hold.what == What::Jumps);
            equations.extend(jumps.iter().flat_map(|hold| hold.equations(plate, &name)));
            for hold in holds {
                let (released, held): (Vec<u32>, _) = hold.columns.iter().partition(is_released);
                let column = hold.columns.first().map_or(0, |column| *column as usize);
                let middle: Vec<usize> =
                    Hold::middle(plate, column, &hold.levels).into_iter().map(|(level, _)| level).collect();
                let of = |keep: fn(&&Dof) -> bool| hold.dofs.iter().filter(keep).copied().collect();
                let turns =
                    Hold { columns: released.clone(), dofs: of(|dof| dof.n() < 3 && dof.m() == 3), ..hold.clone() };
                // The thickness is free: stresses across it would press on the slopes of the plate.
                let deflection = Hold {
                    columns: released,
                    what: if middle.len() == 2 { What::Between } else { What::Each },
                    levels: middle,
                    dofs: of(|dof| dof.n() == 3 && dof.m() < 3),
                    ..hold.clone()
                };
                let holds = [Hold { columns: held, ..hold }, turns, deflection];
                let origin = format!("support of {name}");
                equations.extend(holds.iter().flat_map(|hold| hold.equations(plate, &origin)));
            }
        }
        Ok(equations)
    }

    /// The displacement along its normal that an entry prescribes, over all of the height.
    fn prescribed(
        &self,
        plate: &Plate,
        one: &EdgeLoad,
        normals: &Normals,
        turns: &mut Turns,
    ) -> Result<Vec<Equation>, SceneError> {
        let Some(displacement) = one.displacement else { return Ok(Vec::new()) };
        let group = self.group(plate, &one.group)?;
        let along: Vec<[f64; 2]> = group.edges.iter().map(|edge| normals[&undirected(*edge)]).collect();
        let [x, y] = along[0];
        if along.iter().any(|[a, b]| (x * b - y * a).abs() > SAME_LINE || x * a + y * b < 0.0) {
            let message = format!("`{}` is not straight, and a `displacement` has one direction", one.group.value);
            return Err(self.error(&one.group, message, "give every straight part an entry of its own, or a `force`"));
        }
        let angle = turns.settle(y.atan2(x));
        // The face moves as a whole, but turns with a shell.
        let derivatives: &[u8] = if plate.info().is_shell() { &[0, 2] } else { &[0, 2, 3] };
        let mut equations = Vec::new();
        for column in plate.columns_of_group(group) {
            let levels = Levels::All.of(plate, column as usize);
            for level in &levels.map_err(|why| self.error(&one.group, why.to_string(), ""))? {
                for m in derivatives {
                    let Some(dof) = Dof::new(1, *m) else { continue };
                    let value = if *m == 0 { displacement } else { 0.0 };
                    let sides = turned(plate, column as usize, *level, dof, angle);
                    let origin = format!("displacement of `{}`", one.group.value);
                    equations.extend(sides.into_iter().map(|terms| Equation {
                        terms,
                        value,
                        origin: origin.clone(),
                        holds: true,
                    }));
                }
            }
        }
        Ok(equations)
    }
}

fn edges_of<'a>(plate: &'a Plate, group: &str) -> &'a [[u32; 2]] {
    plate.plane.groups.get(group).map_or(&[], |group| &group.edges)
}

/// Normals of the edges of the outline, out of the plate.
type Normals = BTreeMap<[u32; 2], [f64; 2]>;

fn outer_normals(plate: &Plate) -> Normals {
    let mut normals: BTreeMap<[u32; 2], Option<[f64; 2]>> = BTreeMap::new();
    for corners in &plate.plane.quads {
        for [a, b] in corners.sides() {
            let [p, q] = [a, b].map(|node| plate.plane.points[node as usize]);
            let length = (q[0] - p[0]).hypot(q[1] - p[1]);
            let normal = [(q[1] - p[1]) / length, (p[0] - q[0]) / length];
            normals.entry(undirected([a, b])).and_modify(|known| *known = None).or_insert(Some(normal));
        }
    }
    normals.into_iter().filter_map(|(edge, normal)| Some((edge, normal?))).collect()
}
