//! The first and the largest indices of one march under many strengths.

use super::survey::{IMMENSE, ROUNDING, WINDOW};
use super::{FailureEvent, First, Reading, ScanError, ScanSite, Sighting, crossing, refusal};
use fem_core::failure::{FailureCriterion, Site, StressRange, check_material};
use fem_core::material::{Material, Strengths};
use fem_core::tensor::{Ply, Stress6};
use std::ops::Range;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Parts of a group.
const BRANCH: usize = 4;

/// Stresses of a march, kept so that what they come to under any strengths follows from a look at few of them.
///
/// Of every site it knows within what its stresses lie over each window of samples. Such pieces of one material with like stresses at
/// like times stand together, four in a group, four groups in a larger one, up to all, and of each group it knows within what all its
/// stresses lie and when they begin. A group whose bound ([`FailureCriterion::bounds`]) neither passes the largest index so far, nor
/// reaches 1 before the first failure so far, is passed over with all that is in it. What is found is to the bit what a
/// [`Scan`](super::Scan) of all samples finds.
#[derive(Debug)]
pub struct Hulls {
    sites: Vec<ScanSite>,
    times: Vec<f64>,
    /// Samples of each; all but the first judge all but their first.
    windows: Vec<Range<usize>>,
    trees: Vec<Tree>,
    /// Where first and largest indices were found the last time: who begins there passes over most of the rest.
    likely: Mutex<Vec<Leaf>>,
}

/// A site over a window.
#[derive(Debug, Clone, Copy)]
struct Piece {
    site: u32,
    window: u32,
}

/// Pieces or groups of them, [`BRANCH`] neighbours of which are one of the next level.
#[derive(Debug)]
struct Level {
    /// Within what the stresses of each lie.
    ranges: Vec<StressRange>,
    /// The window in which each begins.
    begins: Vec<u32>,
}

/// The sites of one material that one kind of criterion looks at.
#[derive(Debug)]
struct Tree {
    kind: Site,
    material: u16,
    /// Like ones together.
    pieces: Vec<Piece>,
    /// From the pieces to at most [`BRANCH`] groups of all.
    levels: Vec<Level>,
    /// The stresses of each piece, once they were looked at.
    known: Vec<OnceLock<Box<[Stress6<Ply>]>>>,
}

impl Tree {
    fn new(
        kind: Site,
        (material, strengths): (u16, &Strengths),
        sites: &[u32],
        windows: usize,
        of: impl Fn(Piece) -> StressRange,
    ) -> Self {
        let all = sites.iter().flat_map(|site| (0u32..).take(windows).map(|window| Piece { site: *site, window }));
        let mut featured: Vec<(Piece, Feature)> = all.map(|piece| (piece, feature(piece, &of(piece)))).collect();
        arrange(&mut featured, &scales(strengths));
        let pieces: Vec<Piece> = featured.into_iter().map(|(piece, _)| piece).collect();
        let (ranges, begins) = pieces.iter().map(|piece| (of(*piece), piece.window)).unzip();
        let mut levels = vec![Level { ranges, begins }];
        while let Some(below) = levels.last().filter(|level| level.ranges.len() > BRANCH) {
            let ranges = below.ranges.chunks(BRANCH).map(hull).collect();
            let begins = below.begins.chunks(BRANCH).map(|of| of.iter().copied().min().unwrap_or(0)).collect();
            levels.push(Level { ranges, begins });
        }
        let known = pieces.iter().map(|_| OnceLock::new()).collect();
        Self { kind, material, pieces, levels, known }
    }
}

/// A piece of a tree, by numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Leaf {
    tree: usize,
    piece: usize,
}

/// Computes the stresses of a site at the samples of a window.
pub type StressesOf<'a> = &'a (dyn Fn(usize, usize, &mut [Stress6<Ply>]) + Sync);

/// What a march comes to under some strengths.
#[derive(Debug, Clone, PartialEq)]
pub struct Extremes {
    /// Of each criterion, of each of its modes the largest index; −∞ where it looked nowhere.
    pub largest: Vec<Vec<f64>>,
    /// The first failure of each mode of each criterion, by time.
    pub firsts: Vec<FailureEvent>,
}

/// What a mode has come to so far.
#[derive(Debug, Clone, Copy)]
struct Extreme {
    largest: f64,
    at: Option<Leaf>,
    first: First,
    first_at: Option<Leaf>,
}

const NOTHING: Extreme = Extreme { largest: f64::NEG_INFINITY, at: None, first: None, first_at: None };

/// Which stresses may change what is known of a mode.
#[derive(Debug, Clone, Copy)]
struct Aim {
    /// What a bound exceeds where the largest index may be.
    largest: f64,
    /// Where 1 was reached, the last window in which that may have been for the first time.
    last: Option<u32>,
}

impl Aim {
    /// Whether stresses with this `bound` that begin in a window are of interest; a bound that is not a number bounds nothing.
    fn is_met_by(&self, bound: f64, begins: u32) -> bool {
        let passed_over = bound <= self.largest;
        let reaches = || !(bound < under(1.0)) && self.last.is_some_and(|last| begins <= last);
        !passed_over || reaches()
    }
}

/// What a bound must exceed so that an index may, with what rounding may take.
fn under(index: f64) -> f64 {
    index - index.abs() * ROUNDING
}

impl Hulls {
    /// Bytes that those of so many `sites` and `windows` take, without the stresses that are looked at.
    pub fn size(sites: usize, windows: usize) -> usize {
        // The ranges twice, once with what the groups add to them; what pieces are arranged by is gone when stresses are looked at.
        let ranges = (2 * BRANCH - 1) * size_of::<StressRange>() / (BRANCH - 1);
        sites * windows * (ranges + size_of::<(Piece, Feature)>() + size_of::<OnceLock<Box<[Stress6<Ply>]>>>())
    }

    /// Of a march that was sampled at `times`, s, in these `windows`, each of which but the first begins with the last sample of
    /// the one before; `ranges` puts within what the stresses of a site lie, window by window. Strengths of the `materials` say which
    /// differences of stresses weigh; what is found does not depend on them. `None` where stresses are so large that bounds of them may
    /// overflow.
    pub fn new(
        sites: Vec<ScanSite>,
        times: Vec<f64>,
        windows: Vec<Range<usize>>,
        materials: &[Material],
        mut ranges: impl FnMut(usize, &mut [StressRange]),
    ) -> Option<Self> {
        let rest = StressRange { low: Stress6::new([0.0; 6]), high: Stress6::new([0.0; 6]) };
        let mut all = vec![rest; sites.len() * windows.len()];
        for (site, out) in all.chunks_exact_mut(windows.len().max(1)).enumerate() {
            ranges(site, out);
        }
        if !all.iter().all(is_moderate) {
            return None;
        }
        let of_piece = |piece: Piece| all[piece.site as usize * windows.len() + piece.window as usize];
        let mut kinds: Vec<(Site, u16)> = Vec::new();
        for site in &sites {
            let kind = (site.place.site(), site.material);
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        let tree = |(kind, material): (Site, u16)| {
            let own = (0u32..).zip(&sites).filter(|(_, s)| (s.place.site(), s.material) == (kind, material));
            let own: Vec<u32> = own.map(|(k, _)| k).collect();
            let strengths = &materials[usize::from(material)].strengths;
            Tree::new(kind, (material, strengths), &own, windows.len(), of_piece)
        };
        let trees = kinds.into_iter().map(tree).collect();
        Some(Self { trees, sites, times, windows, likely: Mutex::default() })
    }

    /// First and largest indices by these criteria and materials; `stresses` are those of the march.
    ///
    /// # Errors
    /// A material that a criterion cannot judge, a stress that is not finite, an index that is not a number.
    pub fn judge(
        &self,
        criteria: &[(String, Box<dyn FailureCriterion>)],
        materials: &[Material],
        stresses: StressesOf<'_>,
    ) -> Result<Extremes, ScanError> {
        let likely = self.likely.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let (mut largest, mut firsts, mut found) = (Vec::new(), Vec::new(), Vec::new());
        for (name, criterion) in criteria {
            let modes = criterion.info().modes;
            let mut seen = vec![NOTHING; modes.len()];
            for (number, tree) in self.trees.iter().enumerate().filter(|(_, tree)| tree.kind == criterion.info().site) {
                let material = &materials[usize::from(tree.material)];
                let Some(first) = tree.pieces.first().map(|piece| &self.sites[piece.site as usize]) else { continue };
                check_material(&**criterion, name, material).map_err(|source| ScanError::Material {
                    criterion: name.clone(),
                    cell: first.cell,
                    place: first.place,
                    source,
                })?;
                let mut search = Search {
                    hulls: self,
                    number,
                    tree,
                    name,
                    criterion: &**criterion,
                    material,
                    stresses,
                    seen: &mut seen,
                    indices: vec![f64::NAN; WINDOW * modes.len()],
                    aims: vec![Aim { largest: f64::NEG_INFINITY, last: None }; modes.len()],
                };
                search.run(&likely)?;
            }
            found.extend(seen.iter().flat_map(|of| [of.at, of.first_at]).flatten());
            for (mode, of) in modes.iter().zip(&seen) {
                let Some((Reading { time, index, site }, stress)) = of.first else { continue };
                let ScanSite { cell, place, angle, position, material, .. } = self.sites[site as usize];
                let criterion = name.clone();
                firsts.push(FailureEvent {
                    time,
                    criterion,
                    mode,
                    cell,
                    place,
                    angle,
                    position,
                    index,
                    stress,
                    material,
                });
            }
            largest.push(seen.iter().map(|of| of.largest).collect());
        }
        // Of equal times the order of criteria and modes stays.
        firsts.sort_by(|a, b| a.time.total_cmp(&b.time));
        found.dedup();
        *self.likely.lock().unwrap_or_else(PoisonError::into_inner) = found;
        Ok(Extremes { largest, firsts })
    }
}

/// Looks through a tree by one criterion.
struct Search<'a> {
    hulls: &'a Hulls,
    number: usize,
    tree: &'a Tree,
    name: &'a str,
    criterion: &'a dyn FailureCriterion,
    material: &'a Material,
    stresses: StressesOf<'a>,
    seen: &'a mut [Extreme],
    indices: Vec<f64>,
    aims: Vec<Aim>,
}

impl Search<'_> {
    fn run(&mut self, likely: &[Leaf]) -> Result<(), ScanError> {
        let number = self.number;
        for leaf in likely.iter().filter(|leaf| leaf.tree == number) {
            self.judge(leaf.piece)?;
        }
        self.descend()
    }

    /// Finds what is of interest from now on.
    fn aim(&mut self) {
        let begins = |leaf: Leaf| self.hulls.trees[leaf.tree].pieces[leaf.piece].window;
        for (aim, seen) in self.aims.iter_mut().zip(&*self.seen) {
            // Where an index is 1 or more it has reached 1 within that window or before.
            let windows = seen.at.into_iter().chain(seen.first_at).map(begins);
            let last = if seen.largest < 1.0 { None } else { windows.min() };
            *aim = Aim { largest: under(seen.largest), last };
        }
    }

    /// Judges all pieces that may change what was seen.
    fn descend(&mut self) -> Result<(), ScanError> {
        let (tree, modes) = (self.tree, self.seen.len());
        let mut bounds = vec![f64::INFINITY; BRANCH * modes];
        self.aim();
        // Neighbours: their level, and the first of them.
        let mut open = vec![(tree.levels.len() - 1, 0)];
        while let Some((level, first)) = open.pop() {
            let Level { ranges, begins } = &tree.levels[level];
            let parts = first..(first + BRANCH).min(ranges.len());
            let bounds = &mut bounds[..parts.len() * modes];
            bounds.fill(f64::INFINITY);
            self.criterion.bounds_many(&ranges[parts.clone()], self.material, bounds);
            // What begins first comes first: where that fails, the later is passed over.
            let mut order: [usize; BRANCH] = std::array::from_fn(|k| k);
            let order = &mut order[..parts.len()];
            order.sort_unstable_by_key(|k| begins[first + k]);
            let met = |aims: &[Aim], k: usize| {
                let mut pairs = bounds[k * modes..(k + 1) * modes].iter().zip(aims);
                pairs.any(|(bound, aim)| aim.is_met_by(*bound, begins[first + k]))
            };
            if let Some(below) = level.checked_sub(1) {
                let next = order.iter().rev().filter(|k| met(&self.aims, **k));
                open.extend(next.map(|k| (below, (first + k) * BRANCH)));
                continue;
            }
            for k in order {
                if met(&self.aims, *k) {
                    self.judge(first + *k)?;
                    self.aim();
                }
            }
        }
        Ok(())
    }

    /// Takes all samples of a piece.
    fn judge(&mut self, piece: usize) -> Result<(), ScanError> {
        let (hulls, modes, leaf) = (self.hulls, self.seen.len(), Leaf { tree: self.number, piece });
        let Piece { site, window: number } = self.tree.pieces[piece];
        let window = &hulls.windows[number as usize];
        let times = &hulls.times[window.clone()];
        let of_site = &hulls.sites[site as usize];
        let stress = match self.tree.known[piece].get() {
            Some(stress) => stress,
            None => {
                let mut stress = vec![Stress6::new([0.0; 6]); window.len()];
                (self.stresses)(site as usize, number as usize, &mut stress);
                if let Some((s, time)) = stress.iter().zip(times).find(|(s, _)| !s.is_finite()) {
                    return Err(ScanError::Stress { time: *time, site: Box::new(*of_site), stress: *s });
                }
                self.tree.known[piece].get_or_init(|| stress.into())
            }
        };
        let indices = &mut self.indices[..window.len() * modes];
        indices.fill(f64::NAN);
        self.criterion.indices_many(stress, self.material, indices);
        if !indices.iter().fold(true, |sound, index| sound & (*index > f64::NEG_INFINITY)) {
            let bad = indices.iter().position(|index| !(*index > f64::NEG_INFINITY)).unwrap_or(0);
            let (sample, mode) = (bad / modes, bad % modes);
            return Err(refusal(self.name, self.criterion, of_site, times[sample], mode, stress[sample]));
        }
        let judged = usize::from(number > 0)..window.len();
        for (mode, seen) in self.seen.iter_mut().enumerate() {
            let of_mode = || judged.clone().map(|sample| indices[sample * modes + mode]);
            let largest = of_mode().fold(f64::NEG_INFINITY, |a, b| if b > a { b } else { a });
            if largest > seen.largest {
                (seen.largest, seen.at) = (largest, Some(leaf));
            }
            if largest < 1.0 || seen.first.is_some_and(|(first, _)| first.time < times[0]) {
                continue;
            }
            let at = |sample: usize| Sighting {
                time: times[sample],
                index: indices[sample * modes + mode],
                stress: &stress[sample],
            };
            for sample in judged.clone() {
                let Some((time, stress)) = crossing(sample.checked_sub(1).map(at), at(sample)) else { continue };
                let here = Reading { time, index: indices[sample * modes + mode], site };
                if seen.first.is_none_or(|(first, _)| here.precedes(&first)) {
                    (seen.first, seen.first_at) = (Some((here, stress)), Some(leaf));
                }
            }
        }
        Ok(())
    }
}

/// Whether bounds of it cannot overflow.
fn is_moderate(range: &StressRange) -> bool {
    range.low.0.iter().chain(&range.high.0).all(|c| c.abs() < IMMENSE)
}

/// What holds all of them.
fn hull(parts: &[StressRange]) -> StressRange {
    let ends = |of: fn(&StressRange) -> &Stress6<Ply>, choose: fn(f64, f64) -> f64| {
        let all = parts.iter().map(|part| of(part).0);
        Stress6::new(all.reduce(|a, b| std::array::from_fn(|i| choose(a[i], b[i]))).unwrap_or([0.0; 6]))
    };
    StressRange { low: ends(|range| &range.low, f64::min), high: ends(|range| &range.high, f64::max) }
}

/// What pieces are arranged by: the middle of each component of the stress, and the window.
type Feature = [f32; 7];

fn feature(piece: Piece, range: &StressRange) -> Feature {
    let middle = |i: usize| (0.5 * (range.low.0[i] + range.high.0[i])) as f32;
    std::array::from_fn(|i| if i < 6 { middle(i) } else { piece.window as f32 })
}

/// What differences of features are held against: the least of the strengths that limit a component; NaN where none is known.
fn scales(of: &Strengths) -> Feature {
    let least = |strengths: &[f64]| strengths.iter().fold(f64::NAN, |a, b| a.min(*b)) as f32;
    let along = least(&[of.s12(), of.s13()]);
    [
        least(&[of.xt(), of.xc()]),
        least(&[of.yt(), of.yc()]),
        least(&[of.yt(), of.yc(), of.zt(), of.zc()]),
        along,
        least(&[of.s23()]),
        along,
        f32::NAN,
    ]
}

/// Orders pieces so that groups of [`BRANCH`] neighbours, and groups of these, have like features: halves along the one that differs
/// most, in relation to its scale, or to its largest where that has none.
fn arrange(pieces: &mut [(Piece, Feature)], scales: &Feature) {
    let zero: Feature = [0.0; 7];
    let most = pieces.iter().fold(zero, |a, (_, b)| std::array::from_fn(|i| a[i].max(b[i].abs())));
    let most: Feature = std::array::from_fn(|i| if scales[i] > 0.0 { scales[i] } else { most[i] });
    let mut parts = vec![pieces];
    while let Some(part) = parts.pop() {
        if part.len() <= BRANCH {
            continue;
        }
        let ends = part.iter().fold((part[0].1, part[0].1), |(low, high), (_, of)| {
            (std::array::from_fn(|i| low[i].min(of[i])), std::array::from_fn(|i| high[i].max(of[i])))
        });
        let spread = |i: usize| if most[i] > 0.0 { (ends.1[i] - ends.0[i]) / most[i] } else { 0.0 };
        let along =
            (0..zero.len()).map(|i| (i, spread(i))).reduce(|a, b| if b.1 > a.1 { b } else { a }).map_or(0, |of| of.0);
        // Whole groups to both sides.
        let mut unit = BRANCH;
        while unit * BRANCH < part.len() {
            unit *= BRANCH;
        }
        let middle = (part.len() / 2 / unit).max(1) * unit;
        let number = |piece: &Piece| (piece.site, piece.window);
        part.select_nth_unstable_by(middle, |a, b| {
            a.1[along].total_cmp(&b.1[along]).then(number(&a.0).cmp(&number(&b.0)))
        });
        let (left, right) = part.split_at_mut(middle);
        parts.extend([left, right]);
    }
}
