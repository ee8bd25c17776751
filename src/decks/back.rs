//! Back substitution: stresses and strains of single elements at a print step.

use super::piece::Parts;
use crate::error::Error;
use crate::model::NamedCriterion;
use fem_core::element::{Cell, ElementError, Part, Scratch, Stack};
use fem_core::failure::{FailureCriterion as _, Site};
use fem_core::material::Material;
use fem_core::tensor::{Global, Matrix6, Ply, Strain6, Stress6, rotate_stiffness, stress};
use fem_failure::{HashinReport, Octahedral};
use fem_io::deck::{Generation, Prints};

/// Where in an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Ply,
    Interface,
    Surface,
}

impl Place {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ply => "ply",
            Self::Interface => "interface",
            Self::Surface => "surface",
        }
    }
}

/// A place of an element: which, how it is averaged, and what it is made of.
#[derive(Debug)]
pub(super) struct Station<'a> {
    pub(super) place: Place,
    pub(super) which: String,
    /// Its ply, from 0; of an interface the one below.
    pub(super) ply: usize,
    pub(super) part: Part,
    pub(super) material: &'a Material,
    /// Fibre direction of its local axes, radians.
    pub(super) angle: f64,
    /// Mean strains in global axes per displacement of the element, six each.
    operator: Vec<f64>,
}

impl Station<'_> {
    /// Mean strains for the displacements `u` of the element in the plate's axes.
    fn strain(&self, u: &[f64]) -> Strain6<Global> {
        let mut strain = [0.0; 6];
        for (column, u) in self.operator.as_chunks::<6>().0.iter().zip(u) {
            strain.iter_mut().zip(column).for_each(|(e, b)| *e += b * u);
        }
        Strain6::new(strain)
    }

    /// Stress there in the axes of the ply.
    pub(super) fn stress(&self, u: &[f64]) -> Stress6<Ply> {
        stress(&self.material.elastic.stiffness(), &self.strain(u).to_ply(self.angle))
    }
}

/// What is found at a place.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub(super) place: Place,
    pub(super) which: String,
    pub(super) strain: Strain6<Global>,
    pub(super) stress: Stress6<Global>,
    pub(super) local_strain: Strain6<Ply>,
    pub(super) local_stress: Stress6<Ply>,
    /// Left sides of eqs 38 to 42; those of other places, and those that want a strength of 0, are not there.
    pub(super) indices: [Option<f64>; 5],
    /// Criterion, mode and index of others that were asked for.
    pub(super) others: Vec<(String, &'static str, f64)>,
}

/// What the displacements `u` of a piece, all of its degrees of freedom in nodal axes, make of element `number` (from 0).
///
/// # Errors
/// A cell that the element refuses.
pub(super) fn recover(
    deck: &Generation,
    parts: &Parts<'_>,
    number: usize,
    prints: &Prints,
    u: &[f64],
    criteria: &[NamedCriterion],
) -> Result<Vec<Found>, Error> {
    let u = parts.displacements(number, u);
    let found = stations(deck, parts, number, prints)?.into_iter().map(|station| {
        let c = station.material.elastic.stiffness();
        let strain = station.strain(&u);
        let local_strain = strain.to_ply(station.angle);
        let local_stress = stress(&c, &local_strain);
        Found {
            place: station.place,
            stress: stress(&rotate_stiffness(&c, station.angle), &strain),
            strain,
            local_strain,
            local_stress,
            indices: indices(station.place, &local_stress, station.material),
            others: others(criteria, station.place, &local_stress, station.material),
            which: station.which,
        }
    });
    Ok(found.collect())
}

/// Places of element `number` (from 0) with what its displacements make of their strains.
///
/// # Errors
/// A cell that the element refuses.
pub(super) fn stations<'a>(
    deck: &'a Generation,
    parts: &Parts<'_>,
    number: usize,
    prints: &Prints,
) -> Result<Vec<Station<'a>>, ElementError> {
    let mut stations = places(deck, number, prints);
    let (mut scratch, cell) = (Scratch::default(), parts.cell(number));
    for station in &mut stations {
        station.operator = vec![0.0; 6 * parts.element.info().ndof()];
        let global = rotate_stiffness(&station.material.elastic.stiffness(), station.angle);
        // A section's strains across it follow from the stiffness of the place.
        let stack = with(cell.stack, station.part.slice, global);
        let cell = Cell { stack: &stack, ..cell };
        let plane = parts.element.info().plane();
        parts.element.mean_strains(&cell, &[station.part], plane, &mut scratch, &mut station.operator)?;
    }
    Ok(stations)
}

/// `stack` with another stiffness of one of its plies.
fn with(stack: &Stack, slice: usize, c: Matrix6) -> Stack {
    let mut stack = stack.clone();
    stack.slices[slice].c = c;
    stack
}

fn places<'a>(deck: &'a Generation, number: usize, prints: &Prints) -> Vec<Station<'a>> {
    let plies = &deck.piece.elements[number].plies;
    let laminate = &deck.laminate;
    let (first, end, all) = (plies.start, plies.end, laminate.plies.len());
    let z = laminate.heights();
    let q = |k: usize| 2.0 * (z[k] - z[first]) / (z[end] - z[first]) - 1.0;
    let of_ply = |place, which: String, ply: usize, q| Station {
        place,
        which,
        ply,
        operator: Vec::new(),
        part: Part { slice: ply - first, q },
        material: &laminate.materials[laminate.plies[ply].material],
        angle: laminate.plies[ply].angle,
    };
    let mut stations = Vec::new();
    if prints.plies {
        stations.extend(plies.clone().map(|ply| of_ply(Place::Ply, (ply + 1).to_string(), ply, [q(ply), q(ply + 1)])));
    }
    if prints.interfaces {
        // Boundary k lies below ply k, counted from 0.
        stations.extend((first.max(1)..=end.min(all - 1)).map(|k| Station {
            place: Place::Interface,
            which: format!("{k}|{}", k + 1),
            ply: k - 1,
            operator: Vec::new(),
            part: Part { slice: k.min(end - 1) - first, q: [q(k), q(k)] },
            material: &laminate.materials[laminate.interfaces],
            angle: 0.0,
        }));
    }
    if prints.surfaces {
        let bottom = (first == 0).then(|| of_ply(Place::Surface, "bottom".into(), 0, [-1.0, -1.0]));
        let top = (end == all).then(|| of_ply(Place::Surface, "top".into(), all - 1, [1.0, 1.0]));
        stations.extend(bottom.into_iter().chain(top));
    }
    stations
}

fn indices(place: Place, stress: &Stress6<Ply>, material: &Material) -> [Option<f64>; 5] {
    let mut found = [f64::NAN; 5];
    match place {
        Place::Ply => HashinReport::default().indices(stress, material, &mut found[..4]),
        Place::Interface => {
            Octahedral.indices(stress, material, &mut found[4..]);
            // The criterion is J2/τ², eq. 42 its root.
            found[4] = found[4].sqrt();
        }
        Place::Surface => {}
    }
    found.map(|index| index.is_finite().then_some(index))
}

/// Indices of `criteria` of this kind of place, as far as the material has the strengths that they require.
fn others(
    criteria: &[NamedCriterion],
    place: Place,
    stress: &Stress6<Ply>,
    material: &Material,
) -> Vec<(String, &'static str, f64)> {
    let site = match place {
        Place::Ply => Site::Ply,
        Place::Interface => Site::Interface,
        Place::Surface => return Vec::new(),
    };
    let mut found = Vec::new();
    for (name, criterion) in criteria.iter().filter(|(_, criterion)| criterion.info().site == site) {
        let info = criterion.info();
        if material.require(info.strengths, name).is_ok() && criterion.check(material).is_ok() {
            let mut indices = vec![f64::NAN; info.modes.len()];
            criterion.indices(stress, material, &mut indices);
            found.extend(info.modes.iter().zip(indices).map(|(mode, index)| (name.clone(), *mode, index)));
        }
    }
    found
}
