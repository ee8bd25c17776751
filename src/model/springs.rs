//! Supports that give way, or that the plate lifts off.

use super::builder::Builder;
use crate::effect::Effects;
use fem_core::constraint::Constraints;
use fem_core::element::Element;
use fem_core::functional::Functional;
use fem_core::hold::SupportKind;
use fem_core::plate::Plate;
use fem_core::plugin::Dimension;
use fem_core::springs::{Spread, SupportSpring, Surface, merged};
use fem_core::support::Levels;
use fem_io::scene::{Analysis, Located, Place, SceneError, Support, SupportArea};

/// What a stiffness is of: its dimension, and a unit with its size in SI units.
#[derive(Debug, Clone, Copy)]
struct Kind {
    dimension: Dimension,
    unit: &'static str,
    size: f64,
}

/// A spring at a node, or what is spread along an edge or over an area.
const OF_NODE: Kind = Kind { dimension: Dimension([0.0, 1.0, -2.0, 0.0]), unit: "N/mm", size: 1e3 };
const OF_EDGE: Kind = Kind { dimension: Dimension([-1.0, 1.0, -2.0, 0.0]), unit: "N/mm^2", size: 1e6 };
const OF_AREA: Kind = Kind { dimension: Dimension([-2.0, 1.0, -2.0, 0.0]), unit: "N/mm^3", size: 1e9 };

/// Springs that only push, at most: a step of an impact asks each of them how all others move it.
const MOST_ONE_SIDED: usize = 2000;

/// Stiffness of springs over that of a support that does not give way, below which rounding of the plate's own stiffness hides them.
const SOFTEST: f64 = 1e-11;

/// The springs of all supports, of all unknowns, and what describes each support that has some.
#[derive(Debug, Default)]
pub(super) struct Springs {
    pub(super) all: Vec<SupportSpring>,
    pub(super) place: Option<Place>,
}

impl Springs {
    /// The same of the independent unknowns; what acts on one displacement is one spring.
    pub(super) fn restrict(&self, constraints: &Constraints) -> Vec<SupportSpring> {
        let restrict = |spring: &SupportSpring| SupportSpring {
            at: Functional(constraints.restrict(&spring.at.0)),
            ..spring.clone()
        };
        merged(self.all.iter().map(restrict).filter(|spring| !spring.at.0.is_empty()).collect())
    }
}

impl Builder<'_> {
    /// Adds the springs of a support, if it has some, and says what they are.
    pub(super) fn add_springs(
        &self,
        (plate, element): (&Plate, &dyn Element),
        support: &Support,
        springs: &mut Springs,
    ) -> Result<Option<String>, SceneError> {
        let Support::Kind { area, kind, levels, stiffness, place } = support else { return Ok(None) };
        let one_sided = *kind == SupportKind::Rest;
        if !one_sided && stiffness.is_none() {
            return Ok(None);
        }
        let Some(surface) = Surface::at(*levels) else {
            let message = format!("the support of {}: springs hold one surface of the plate", area.value);
            return Err(self.scene.source.error_at(place, message, "write at = \"bottom\", for example"));
        };
        if let SupportArea::Group(name) = &area.value
            && self.still.contains(name)
        {
            return Ok(Some(format!("{}, {}: nothing that moves", area.value, kind.name())));
        }
        if self.scene.delamination.is_some() && *levels == Levels::MidPlane {
            let message =
                format!("the springs of {} hold the mid-plane of a plate that may come apart there", area.value);
            return Err(self.scene.source.error_at(place, message, "write at = \"bottom\", for example"));
        }
        let (spread, of) = self.spread((plate, element), area, (surface, *levels))?;
        let value = match stiffness {
            None => self.hard(of),
            Some(Located { value: (value, dimension), .. }) if dimension.matches(&of.dimension) => *value,
            Some(given) => {
                let what = format!("the stiffness of {} has another dimension", area.value);
                let help = format!(
                    "at nodes it is a force per deflection, along edges that per length, over cells and discs per area: write \
                     stiffness = \"50 {}\", for example",
                    of.unit
                );
                return Err(self.error(given, what, help));
            }
        };
        let least = SOFTEST * self.hard(of);
        if let Some(given) = stiffness.as_ref().filter(|_| value < least) {
            let what = format!("the springs of {} are lost in the rounding of the plate's own stiffness", area.value);
            let help = format!(
                "write at least {:.1e} {}, or kind = \"free\" where nothing holds the plate",
                least / of.size,
                of.unit
            );
            return Err(self.error(given, what, help));
        }
        if spread.is_empty() {
            let help =
                "the element has no deflection there, or the group has neither edges nor cells nor nodes of the plate";
            return Err(self.scene.source.error_at(
                place,
                format!("the support of {} holds nothing", area.value),
                help,
            ));
        }
        let count = spread.len();
        springs.all.extend(spread.into_iter().map(|(at, share)| SupportSpring {
            at,
            stiffness: value * share,
            one_sided,
        }));
        springs.place.get_or_insert_with(|| place.clone());
        let (name, unit) = (kind.name(), of.unit);
        let pushes = if one_sided { " that only push" } else { "" };
        Ok(Some(format!(
            "{}, {name}: w, by springs{pushes} at {count} points, {:.4} {unit}",
            area.value,
            value / of.size
        )))
    }

    /// Stiffness of a support that does not give way and pushes: that of a layer as thick as the plate, of its stiffest ply across the
    /// plies, which is next to nothing beside the bending: E₃/h of an area, E₃ of a length, E₃ h of a node.
    fn hard(&self, of: Kind) -> f64 {
        let plies = || self.scene.laminates.iter().map(|laminate| &laminate.laminate.value.plies);
        let modulus =
            plies().flatten().map(|ply| self.scene.materials[ply.material].value.elastic.e3).fold(0.0, f64::max);
        let height = plies().map(|plies| plies.iter().map(|ply| ply.thickness).sum()).fold(0.0, f64::max);
        modulus * height.powf(1.0 + of.dimension.0[0])
    }

    /// Where the springs of a support are, and what a stiffness of theirs is of.
    fn spread(
        &self,
        (plate, element): (&Plate, &dyn Element),
        area: &Located<SupportArea>,
        (surface, levels): (Surface, Levels),
    ) -> Result<(Spread, Kind), SceneError> {
        if let SupportArea::Disc { centre, radius } = area.value {
            let Some(spread) = surface.within(plate, element, centre, radius) else {
                return Err(self.error(
                    area,
                    format!("{} leaves the plate", area.value),
                    "move it, or make it smaller; cells that are clamped as a whole are no part of what moves",
                ));
            };
            return Ok((spread, OF_AREA));
        }
        let group = self.area(plate, area)?;
        if !group.quads.is_empty() {
            return Ok((surface.under(plate, element, &group.quads), OF_AREA));
        }
        if !group.edges.is_empty() {
            return Ok((surface.along(plate, element, &group.edges), OF_EDGE));
        }
        let nodes = levels
            .at(plate, &plate.columns_of_group(&group))
            .map_err(|why| self.error(area, why.to_string(), "write at = \"bottom\", for example"))?;
        Ok((surface.at_nodes(plate, &nodes), OF_NODE))
    }

    /// Refuses springs that break the symmetry, and what cannot stand beside them.
    pub(super) fn check_springs(&self, plate: &Plate, springs: &Springs, effects: &Effects) -> Result<(), SceneError> {
        let Some(place) = &springs.place else { return Ok(()) };
        let mut forces = vec![0.0; plate.ndof()];
        springs.all.iter().for_each(|spring| spring.at.add_to(spring.stiffness, &mut forces));
        self.symmetric_forces(plate, "the supports break", &forces, place)?;
        let count = springs.all.iter().filter(|spring| spring.one_sided).count();
        let wants = |name: &str| effects.wanted().any(|effect| effect.info().key.name == name);
        let growth = self.scene.delamination.is_some();
        let beside = [
            (self.scene.substructures.is_some(), "condensed substructures", "leave `substructures` out"),
            (wants("preload"), "a preload", "leave `effects.preload` out"),
            (
                wants("membrane") && self.scene.impact().is_none() && !growth,
                "large deflections at rest",
                "leave `effects.membrane` out",
            ),
        ];
        let static_strains = effects.nature().strained && matches!(self.scene.analysis, Analysis::Static(_));
        let beside_rests = [
            (self.has_laws() && !growth, "plies that follow laws", "hold the plate by kind = \"roller\""),
            (wants("gravity"), "gravity", "leave `effects.gravity` out"),
            (wants("damping"), "damping", "leave `effects.damping` out"),
            (static_strains, "residual strains at rest", "leave `effects.cure` out"),
            (
                count > MOST_ONE_SIDED && !growth,
                "more than 2000 points",
                "let it lie on fewer or larger cells, on edges instead of an area, or on discs",
            ),
        ];
        let beside = beside.into_iter().chain(beside_rests.into_iter().filter(|_| count > 0));
        match { beside }.find(|(has, ..)| *has) {
            None => Ok(()),
            Some((_, what, help)) => {
                let kind = if count > 0 { "a support that the plate lifts off" } else { "a support that gives way" };
                Err(self.scene.source.error_at(place, format!("{kind} does not go with {what} yet"), help))
            }
        }
    }
}
