//! Failure of all elements of a model over time, by stresses at the print steps.

use super::back::{Place, stations};
use super::march::Print;
use super::model::Model;
use super::piece::{Parts, generate};
use super::project::Project;
use super::units::UnitSystem;
use crate::error::Error;
use crate::model::NamedCriterion;
use fem_core::failure::check_material;
use fem_core::material::Material;
use fem_core::tensor::{Ply, Stress6};
use fem_failure::scan::{PlyOrInterface, Scan, ScanSite};
use fem_io::deck::{self, Deck, DeckSource, ImpactDeck, NoResults, Prints};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// Most bytes of stresses per unit of each governor.
const MOST_BYTES: usize = 1 << 30;

/// What failed.
pub(super) struct Judged {
    pub(super) scan: Scan,
    /// Substructure and element, both from 1, of each cell of the scan.
    pub(super) cells: Vec<[u64; 2]>,
    /// In SI units.
    pub(super) materials: Vec<Material>,
    /// Those that judge, and why others do not.
    pub(super) criteria: Vec<NamedCriterion>,
    pub(super) left_out: Vec<String>,
    /// Of the thickest piece, m.
    pub(super) thickness: f64,
}

/// Judges plies and interfaces of all elements at all print steps by `criteria`, in SI units; the motion begins at `begin`.
///
/// # Errors
/// A piece that cannot be made again, a stress that is not finite.
pub(super) fn judge(
    project: &Project,
    deck: &ImpactDeck,
    model: &Model,
    (begin, prints): (f64, &[Print]),
    units: UnitSystem,
    criteria: &[NamedCriterion],
) -> Result<Judged, Error> {
    let mut places =
        Places { units, sites: Vec::new(), cells: Vec::new(), materials: Vec::new(), rows: Vec::new(), thickness: 0.0 };
    let governors = deck.freedom.kept.len();
    let unit = |g: usize| (0..governors).map(|k| if k == g { 1.0 } else { 0.0 }).collect::<Vec<_>>();
    let shapes: Vec<Vec<f64>> = (0..governors).map(|g| model.way.expand(&unit(g))).collect();
    let all = places.find(project, deck, &shapes)?;
    let Places { sites, cells, materials, rows, thickness, .. } = places;

    let (mut judging, mut left_out) = (Vec::new(), Vec::new());
    if !all {
        left_out.push(format!(
            "failure was not judged: stresses of all plies per unit of {governors} governors take more than {} MB; back substitution \
             judges single elements",
            MOST_BYTES >> 20
        ));
    }
    for (name, criterion) in criteria.iter().filter(|_| all) {
        let looks = |site: &&ScanSite| site.place.site() == criterion.info().site;
        let mut refused = sites
            .iter()
            .filter(looks)
            .map(|site| check_material(&**criterion, name, &materials[usize::from(site.material)]));
        match refused.find_map(Result::err) {
            Some(why) => left_out.push(format!("`{name}` judges nothing: {why}")),
            None => judging.push((name.clone(), criterion.clone())),
        }
    }
    let operator = DMatrix::from_row_slice(6 * sites.len(), governors, &rows);
    let mut scan = Scan::new(judging.clone(), sites, materials.clone())?;
    let mut sample = |time: f64, motion: &DVector<f64>| {
        let stresses = &operator * motion;
        let states: Vec<Stress6<Ply>> =
            stresses.as_slice().as_chunks::<6>().0.iter().map(|s| Stress6::new(*s)).collect();
        scan.sample(time, &states)
    };
    if begin == 0.0 {
        sample(0.0, &DVector::zeros(governors))?;
    }
    for print in prints {
        sample(
            print.time,
            &DVector::from_iterator(governors, deck.freedom.kept.iter().map(|dof| print.motion[0][*dof])),
        )?;
    }
    Ok(Judged { scan, cells, materials, criteria: judging, left_out, thickness })
}

/// Places as they are found.
struct Places {
    units: UnitSystem,
    sites: Vec<ScanSite>,
    cells: Vec<[u64; 2]>,
    materials: Vec<Material>,
    /// Stresses, Pa, per unit of each governor: six rows of each site.
    rows: Vec<f64>,
    thickness: f64,
}

impl Places {
    /// All places of all pieces; none, and `false`, where they are too many.
    fn find(&mut self, project: &Project, deck: &ImpactDeck, shapes: &[Vec<f64>]) -> Result<bool, Error> {
        let (mut pieces, mut bytes) = (BTreeMap::new(), 0_usize);
        let per_node = deck.freedom.directions.len();
        for (number, placed) in deck.substructures.iter().enumerate() {
            let name = placed.name.value.as_str();
            let Some(matrices) = project.matrices(name) else { continue };
            if !pieces.contains_key(name) {
                let source = DeckSource::new(&matrices.deck.0, matrices.deck.1.clone());
                let Deck::Generation(piece) = deck::parse(&source, matrices.program(), &NoResults)?.deck else {
                    continue;
                };
                let way = generate(&source, &piece)?;
                let first = self.materials.len();
                let top = piece.laminate.heights().last().copied().unwrap_or(0.0);
                self.thickness = self.thickness.max(top * self.units.metres());
                self.materials.extend(piece.laminate.materials.iter().map(|own| self.units.material(own)));
                pieces.insert(name, (source, piece, way, first));
            }
            let (source, piece, way, first) = &pieces[name];
            // Plies, and interfaces on either side of each.
            let places: usize = piece.piece.elements.iter().map(|card| 2 * card.plies.len() + 1).sum();
            bytes = bytes.saturating_add(places.saturating_mul(6 * size_of::<f64>() * shapes.len()));
            if bytes > MOST_BYTES || piece.laminate.plies.len() > usize::from(u16::MAX) {
                self.sites.clear();
                self.rows.clear();
                return Ok(false);
            }
            let parts = Parts::new(source, piece)?;
            let masters = |u: &Vec<f64>| -> Vec<f64> {
                placed.nodes.iter().flat_map(|n| &u[n * per_node..(n + 1) * per_node]).copied().collect()
            };
            let motions: Vec<Vec<f64>> = shapes.iter().map(|u| way.expand(&masters(u))).collect();
            for element in 0..piece.piece.elements.len() {
                let cell = self.cells.len() as u32;
                self.cells.push([number as u64 + 1, element as u64 + 1]);
                let own: Vec<Vec<f64>> = motions.iter().map(|u| parts.displacements(element, u)).collect();
                let card = &piece.piece.elements[element];
                let [x, y] = [0, 1].map(|d| 0.25 * card.plane.iter().map(|corner| corner[d]).sum::<f64>());
                let z = parts.cell(element).z;
                for station in
                    stations(piece, &parts, element, &Prints { plies: true, interfaces: true, ..Prints::default() })?
                {
                    let ply = station.ply as u16;
                    let height = z[0] + 0.25 * (2.0 + station.part.q[0] + station.part.q[1]) * (z[1] - z[0]);
                    let (place, material) = match station.place {
                        Place::Interface => (PlyOrInterface::Interface(ply), piece.laminate.interfaces),
                        _ => (PlyOrInterface::Ply(ply), piece.laminate.plies[station.ply].material),
                    };
                    self.sites.push(ScanSite {
                        cell,
                        region: 0,
                        place,
                        position: [x, y, height].map(|v| v * self.units.metres()),
                        angle: station.angle,
                        material: (first + material) as u16,
                    });
                    let columns: Vec<[f64; 6]> = own.iter().map(|u| station.stress(u).0).collect();
                    let pressure = self.units.pascals();
                    self.rows.extend((0..6).flat_map(|i| columns.iter().map(move |column| column[i] * pressure)));
                }
            }
        }
        Ok(true)
    }
}
