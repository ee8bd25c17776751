//! Where and when the criteria reached 1: `damage.json`, from which damage is drawn.

use super::outlines::{PlanOutline, outlines};
use crate::analyses::impact::Outcome;
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::words::name_ply;
use fem_core::laminate::{LaminaPly, Laminate};
use fem_failure::scan::{PlyOrInterface, ScanSite};
use fem_io::files::{FileError, OutputDir};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};

/// Name of the file.
pub const FILE: &str = "damage.json";

/// Indices beyond are written as this, since JSON has no infinity.
const LARGEST: f64 = 1e9;

/// Largest failure indices over the plate, place by place, and when each cell failed; the content of `damage.json`.
///
/// Where a symmetry was computed it is unfolded: every cell of the mesh stands for itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DamageMap {
    /// [`fem_io::results::FORMAT`].
    #[serde(default)]
    pub format: u32,
    /// End of the march, s.
    pub end_s: f64,
    /// Modes of all criteria, what `places` count in.
    pub modes: Vec<ModeName>,
    /// Plies from the bottom up.
    pub plies: Vec<PlyBand>,
    /// Where impactors strike, m.
    pub impacts_m: Vec<[f64; 2]>,
    /// What holds and what strikes the plate, in plan.
    #[serde(default)]
    pub outlines: Vec<PlanOutline>,
    /// Nodes of the mesh and, behind them, places that divide bent sides, m.
    pub points_m: Vec<[f64; 2]>,
    /// Corners of the cells, anticlockwise, and the places along bent sides between them, numbers in `points_m`.
    pub quads: Vec<Vec<u32>>,
    /// Number of each cell in the mesh file.
    pub cells: Vec<u64>,
    /// Region of each cell, where `places` say theirs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<String>,
    /// Cells that the criteria judged, ascending, numbers in `quads`.
    pub judged: Vec<u32>,
    /// Plies and interfaces from the bottom up.
    pub places: Vec<PlaceDamage>,
}

/// A mode of a criterion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModeName {
    /// Name of the criterion in the scene.
    pub criterion: String,
    /// Its mode.
    pub mode: String,
}

/// A ply.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlyBand {
    /// Region of the plate, where plies of one number do not lie at one height in all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<String>,
    /// Angle of its fibres from x towards y, degrees.
    pub angle_deg: f64,
    /// Its lower and upper face, m.
    pub z_m: [f64; 2],
}

/// What the criteria found in a ply or in an interface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlaceDamage {
    /// `3`, or `3|4` for an interface, counted from the bottom of its region.
    pub ply: String,
    /// That region, where plies of one number do not lie at one height in all of them: `index` is 0 in cells of others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<String>,
    /// Largest index of all modes in each of the judged cells, four digits; at most 1e9.
    pub index: Vec<f64>,
    /// What reached 1, by time.
    pub failed: Vec<Failed>,
}

/// By position in `judged` and number in `modes`, s.
type FirstTimes = BTreeMap<(u32, u32), f64>;

/// A mode that reached 1 in a cell: position in `judged`, number in `modes`, first time (s).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Failed(pub u32, pub u32, pub f64);

impl DamageMap {
    /// The damage of an impact; `None` where no criterion judged anything, or no largest indices were kept.
    pub fn new(model: &Model, outcome: &Outcome) -> Option<Self> {
        let Plan::Impact(impact) = &model.plan else { return None };
        let (mesh, symmetry) = (&model.plate.plane, model.plate.symmetry());
        let first_mode: Vec<usize> = model
            .criteria
            .iter()
            .scan(0, |next, (_, criterion)| {
                let first = *next;
                *next += criterion.info().modes.len();
                Some(first)
            })
            .collect();
        let unfolding = Unfolding::new(model);
        let mut kept: Vec<u32> = outcome.maxima.iter().map(|m| m.site.cell).collect();
        kept.sort_unstable();
        kept.dedup();
        let judged: Vec<u32> = (0..mesh.quads.len() as u32)
            .filter(|q| kept.binary_search(&(symmetry.quad(*q as usize) as u32)).is_ok())
            .collect();
        if judged.is_empty() {
            return None;
        }

        let mut places: BTreeMap<(usize, u16, bool), (PlaceDamage, FirstTimes)> = BTreeMap::new();
        for m in &outcome.maxima {
            let own = m.site.cell as usize;
            let apart = !model.region_names.is_empty();
            let region = if apart { model.plate.region(own) } else { 0 };
            let key = match m.site.place {
                PlyOrInterface::Ply(k) => (region, k, false),
                PlyOrInterface::Interface(k) => (region, k, true),
            };
            let empty = || PlaceDamage {
                ply: name_ply(m.site.place),
                region: model.region_of(own).map(str::to_owned),
                index: vec![0.0; judged.len()],
                failed: Vec::new(),
            };
            let (place, failed) = places.entry(key).or_insert_with(|| (empty(), FirstTimes::new()));
            let here = |quad: &&usize| !apart || model.plate.region(**quad) == region;
            let cells = unfolding.quads(&m.site).iter().filter(here);
            for i in cells.filter_map(|quad| judged.binary_search(&(*quad as u32)).ok()) {
                place.index[i] = place.index[i].max(m.index);
                for &(mode, time) in &m.reached {
                    let first = failed.entry((i as u32, (first_mode[m.criterion] + mode) as u32)).or_insert(time);
                    *first = first.min(time);
                }
            }
        }
        let places = places.into_values().map(|(mut place, failed)| {
            place.index.iter_mut().for_each(|index| *index = four_digits(*index));
            place.failed = failed.into_iter().map(|((i, mode), time)| Failed(i, mode, time)).collect();
            place.failed.sort_by(|a, b| a.2.total_cmp(&b.2).then((a.0, a.1).cmp(&(b.0, b.1))));
            place
        });
        let places = places.collect();
        let modes = model.criteria.iter().flat_map(|(name, criterion)| {
            let named = |mode: &&str| ModeName { criterion: name.clone(), mode: (*mode).to_owned() };
            criterion.info().modes.iter().map(named).collect::<Vec<_>>()
        });
        let bands = |laminate: &Laminate, region: Option<&String>| -> Vec<PlyBand> {
            let z = laminate.boundaries();
            let band = |(ply, z): (&LaminaPly, &[f64])| PlyBand {
                region: region.cloned(),
                angle_deg: ply.angle_deg,
                z_m: [z[0], z[1]],
            };
            laminate.plies.iter().zip(z.windows(2)).map(band).collect()
        };
        let plies = match &model.region_names[..] {
            [] => bands(&model.laminate, None),
            names => model.laminates.iter().zip(names).flat_map(|(own, name)| bands(own, Some(name))).collect(),
        };
        let (points_m, quads) = mesh.outlines();
        Some(Self {
            format: fem_io::results::FORMAT,
            end_s: outcome.history.last().map_or(0.0, |row| row.time_s),
            modes: modes.collect(),
            plies,
            regions: (0..mesh.quads.len()).filter_map(|quad| model.region_of(quad)).map(str::to_owned).collect(),
            impacts_m: impact.strikes.iter().map(|strike| strike.centre).collect(),
            outlines: outlines(model),
            points_m,
            quads,
            cells: mesh.quad_tags.clone(),
            judged,
            places,
        })
    }

    /// Writes it to [`FILE`], on one line.
    ///
    /// # Errors
    /// As [`OutputDir::write`].
    pub fn write(&self, dir: &OutputDir) -> Result<(), Error> {
        let text = serde_json::to_string(self).map_err(|cause| FileError::Json { file: FILE.into(), cause })?;
        Ok(dir.write(FILE, |out| writeln!(out, "{text}"))?)
    }

    /// Whether all numbers that point somewhere do, and all others are finite; the error says what is wrong.
    ///
    /// # Errors
    /// A file that was cut or changed.
    pub fn check(&self) -> Result<(), String> {
        let good = |fits: bool, what: &str| if fits { Ok(()) } else { Err(what.to_owned()) };
        good(self.cells.len() == self.quads.len(), "`cells` and `quads` differ in length")?;
        let points = self.points_m.len();
        good(self.quads.iter().all(|corners| corners.len() > 2), "a cell of `quads` has fewer than three corners")?;
        good(self.quads.iter().flatten().all(|n| (*n as usize) < points), "`quads` names a node that does not exist")?;
        good(
            self.judged.iter().all(|q| (*q as usize) < self.quads.len()),
            "`judged` names a cell that does not exist",
        )?;
        good(
            self.regions.is_empty() || self.regions.len() == self.quads.len(),
            "`regions` and `quads` differ in length",
        )?;
        let lines = self.outlines.iter().flat_map(|outline| &outline.lines_m).flatten();
        let places = self.points_m.iter().chain(&self.impacts_m).chain(lines).flatten().copied();
        let heights = self.plies.iter().flat_map(|ply| [ply.angle_deg, ply.z_m[0], ply.z_m[1]]);
        good(places.chain(heights).chain([self.end_s]).all(f64::is_finite), "a coordinate is not finite")?;
        for place in &self.places {
            let ply = &place.ply;
            good(place.index.len() == self.judged.len(), &format!("`index` of ply {ply} is not as long as `judged`"))?;
            good(place.index.iter().all(|v| v.is_finite()), &format!("an index of ply {ply} is not finite"))?;
            let known = |f: &Failed| (f.0 as usize) < self.judged.len() && (f.1 as usize) < self.modes.len();
            good(place.failed.iter().all(|f| known(f) && f.2.is_finite()), &format!("`failed` of ply {ply} is wrong"))?;
        }
        Ok(())
    }

    /// Whether a place has the cell that is the `i`-th of those judged.
    pub fn holds(&self, place: &PlaceDamage, i: usize) -> bool {
        let region = self.regions.get(self.judged[i] as usize);
        place.region.is_none() || region.is_none() || place.region.as_ref() == region
    }

    /// The ply of this number, from 0, in the region of a place.
    pub fn band(&self, place: &PlaceDamage, ply: usize) -> Option<&PlyBand> {
        self.plies.iter().filter(|band| band.region == place.region).nth(ply)
    }

    /// A cell as a polygon, m.
    pub fn outline(&self, quad: u32) -> Vec<[f64; 2]> {
        self.quads[quad as usize].iter().map(|n| self.points_m[*n as usize]).collect()
    }
}

impl PlaceDamage {
    /// First mode that reached 1 in each judged cell.
    pub fn first_modes(&self) -> Vec<Option<usize>> {
        let mut first = vec![None; self.index.len()];
        for Failed(i, mode, _) in self.failed.iter().rev() {
            first[*i as usize] = Some(*mode as usize);
        }
        first
    }

    /// Largest of its indices.
    pub fn largest(&self) -> f64 {
        self.index.iter().fold(0.0, |m, v| m.max(*v))
    }
}

/// The cells of the whole plate that a site speaks for.
#[derive(Debug)]
pub(super) struct Unfolding<'a> {
    /// By the place of a window around an impact, which may lie in several cells.
    windows: HashMap<[u64; 2], &'a [usize]>,
    /// Of each computed cell itself and its images.
    images: Vec<Vec<usize>>,
}

impl<'a> Unfolding<'a> {
    pub(super) fn new(model: &'a Model) -> Self {
        let (count, symmetry) = (model.plate.plane.quads.len(), model.plate.symmetry());
        let mut images = vec![Vec::new(); count];
        (0..count).for_each(|quad| images[symmetry.quad(quad)].push(quad));
        let windows = model.centres.iter().zip(&model.centre_cells);
        Self { windows: windows.map(|(centre, cells)| (bits(centre.at), cells.as_slice())).collect(), images }
    }

    pub(super) fn quads(&self, site: &ScanSite) -> &[usize] {
        let [x, y, _] = site.position;
        self.windows.get(&bits([x, y])).copied().unwrap_or(&self.images[site.cell as usize])
    }
}

fn bits(at: [f64; 2]) -> [u64; 2] {
    at.map(f64::to_bits)
}

/// Four digits are more than a colour shows, and a third of the bytes.
fn four_digits(index: f64) -> f64 {
    let index = index.min(LARGEST);
    format!("{index:.3e}").parse().unwrap_or(index)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn map() -> DamageMap {
        DamageMap {
            format: fem_io::results::FORMAT,
            end_s: 1e-3,
            modes: vec![
                ModeName { criterion: "c".into(), mode: "m".into() },
                ModeName { criterion: "c".into(), mode: "n".into() },
            ],
            plies: vec![PlyBand { region: None, angle_deg: 0.0, z_m: [0.0, 1e-3] }],
            regions: Vec::new(),
            impacts_m: vec![[0.0, 0.0]],
            outlines: Vec::new(),
            points_m: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            quads: vec![vec![0, 1, 2, 3]],
            cells: vec![7],
            judged: vec![0],
            places: vec![PlaceDamage {
                ply: "1".into(),
                region: None,
                index: vec![1.5],
                failed: vec![Failed(0, 1, 1e-4), Failed(0, 0, 2e-4)],
            }],
        }
    }

    #[test]
    fn it_reads_back_and_the_first_mode_is_the_earliest() {
        let text = serde_json::to_string(&map()).unwrap();
        assert!(text.contains("\"failed\":[[0,1,0.0001],[0,0,0.0002]]"), "{text}");
        assert_eq!(serde_json::from_str::<DamageMap>(&text).unwrap(), map());
        assert_eq!(map().places[0].first_modes(), [Some(1)]);
        assert_eq!([1.23456, f64::INFINITY, 0.0].map(four_digits), [1.235, 1e9, 0.0]);
    }

    type Spoil = fn(&mut DamageMap);

    #[test]
    fn what_points_nowhere_is_refused() {
        assert_eq!(map().check(), Ok(()));
        let wrong: [(&str, Spoil); 6] = [
            ("`cells`", |m| m.cells.clear()),
            ("`quads`", |m| m.quads[0][2] = 4),
            ("`judged`", |m| m.judged[0] = 1),
            ("coordinate", |m| m.points_m[0][0] = f64::NAN),
            ("`index` of ply 1", |m| m.places[0].index.clear()),
            ("`failed` of ply 1", |m| m.places[0].failed[0].1 = 2),
        ];
        for (word, spoil) in wrong {
            let mut map = map();
            spoil(&mut map);
            let why = map.check().unwrap_err();
            assert!(why.contains(word), "{why}");
        }
    }
}
