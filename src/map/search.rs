//! Where to look next: the border of damage from few points.
//!
//! A line of the map is where a *level* is 0, the logarithm of an index for example. Levels are smooth, so that a smooth function
//! through the points that are known says where the line is; the next point is where it says so with the least right. What it said
//! there before, against what is found, measures it: its error e at a distance d from the nearest point that was known is taken to
//! grow like d², which it does at least wherever levels have bounded curvature, corners apart. Corners show as a bent level, so that the
//! search ends with a point on each line where it is bent most, far from known ones, and goes on where that says otherwise.

use super::interpolant::{Interpolant, distance};
use super::lines::zeros;

/// Points along each side of the first grid.
const FIRST: usize = 4;
/// Points that are marched between two looks; it does not depend on threads, so that the map does not.
const TOGETHER: usize = 4;
/// Comparisons without which nothing is known of an error.
const CHECKS: usize = 3;
/// Times what is measured is taken, because it is not measured where it is largest.
const SAFETY: f64 = 4.0;
/// Level from which on a comparison is too far off a line to say much of it, where there are nearer ones.
const NEAR: f64 = 1.0;
/// Share of the plane from every line within which there is a point.
const FARTHEST: f64 = 0.25;

/// What a point said.
#[derive(Debug, Clone, PartialEq)]
struct Known {
    at: [f64; 2],
    levels: Vec<f64>,
}

/// What was said of a point before it was known, against what was found.
#[derive(Debug, Clone)]
struct Check {
    at: [f64; 2],
    /// From the nearest point that was known then.
    distance: f64,
    levels: Vec<f64>,
    errors: Vec<f64>,
}

/// A search for lines in the unit square, or on the unit line.
#[derive(Debug)]
pub(super) struct Search {
    pub(super) dimensions: usize,
    /// What the whole of each axis counts, in units of the tolerance.
    pub(super) lengths: [f64; 2],
    pub(super) tolerance: f64,
    /// Most points.
    pub(super) most: usize,
}

/// What a search found.
#[derive(Debug)]
pub(super) struct Lines {
    /// The level of each line; none where too few points are known.
    pub(super) levels: Vec<Interpolant>,
    /// Of each line the largest error that is expected along it; none where the line is nowhere.
    pub(super) errors: Vec<Option<f64>>,
    known: Vec<Known>,
    checks: Vec<Check>,
    lengths: [f64; 2],
    tolerance: f64,
}

impl Search {
    /// Looks until each line is known to the tolerance, or points are used up. `march` says the levels at points, one after the other,
    /// none where there are none; nothing at all where it was stopped.
    pub(super) fn run(&self, mut march: impl FnMut(&[[f64; 2]]) -> Option<Vec<Option<Vec<f64>>>>) -> Lines {
        let mut lines = Lines {
            levels: Vec::new(),
            errors: Vec::new(),
            known: Vec::new(),
            checks: Vec::new(),
            lengths: self.lengths,
            tolerance: self.tolerance,
        };
        let mut next = self.first();
        let mut marched = 0;
        let mut confirming = false;
        while !next.is_empty() {
            next.truncate(self.most.saturating_sub(marched));
            let Some(found) = (!next.is_empty()).then(|| march(&next)).flatten() else { break };
            marched += next.len();
            lines.take(&next, found);
            next = self.look(&mut lines, &mut confirming);
        }
        lines
    }

    fn first(&self) -> Vec<[f64; 2]> {
        let share = |k: usize| k as f64 / (FIRST - 1) as f64;
        let rows = if self.dimensions > 1 { FIRST } else { 1 };
        (0..rows).flat_map(|j| (0..FIRST).map(move |i| [share(i), if rows > 1 { share(j) } else { 0.0 }])).collect()
    }

    /// Where the lines are known least, too little for the tolerance; where all are known, once, where that is least certain.
    fn look(&self, lines: &mut Lines, confirming: &mut bool) -> Vec<[f64; 2]> {
        if !lines.fit(self.dimensions) {
            return Vec::new();
        }
        // The worst point of each line by its error, and among unknown ones by its distance.
        let mut worst: Vec<(f64, f64, [f64; 2])> = Vec::new();
        let mut bent: Vec<(f64, f64, [f64; 2])> = Vec::new();
        lines.errors = (0..lines.levels.len())
            .map(|line| {
                let level = &lines.levels[line];
                let of = |p: [f64; 2]| (lines.error(line, p), lines.distance(p), p);
                let points: Vec<_> = zeros(&|p| level.value(p), self.dimensions).into_iter().map(of).collect();
                let point = points.iter().max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)))?;
                worst.push(*point);
                let bend = |(_, near, p): &(f64, f64, [f64; 2])| near.powi(2) * level.bend(*p);
                bent.extend(points.iter().max_by(|a, b| bend(a).total_cmp(&bend(b))));
                Some(point.0)
            })
            .collect();
        worst.retain(|(error, ..)| !(*error <= self.tolerance));
        *confirming = worst.is_empty() && !*confirming;
        if *confirming {
            worst = bent;
        }
        worst.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)));
        let mut next: Vec<[f64; 2]> = Vec::new();
        for (_, near, p) in worst {
            // Two lines that run side by side need one point.
            if near > 1e-6 && next.iter().all(|q| distance(p, *q) > 0.7 * near) && next.len() < TOGETHER {
                next.push(p);
            }
        }
        next
    }
}

impl Lines {
    fn take(&mut self, points: &[[f64; 2]], found: Vec<Option<Vec<f64>>>) {
        let distances: Vec<f64> = points.iter().map(|p| self.distance(*p)).collect();
        for ((at, distance), levels) in points.iter().zip(distances).zip(found) {
            let Some(levels) = levels else { continue };
            if !self.levels.is_empty() {
                let errors = self.levels.iter().zip(&levels).map(|(said, found)| (said.value(*at) - found).abs());
                self.checks.push(Check { at: *at, distance, levels: levels.clone(), errors: errors.collect() });
            }
            self.known.push(Known { at: *at, levels });
        }
    }

    fn fit(&mut self, dimensions: usize) -> bool {
        let points: Vec<[f64; 2]> = self.known.iter().map(|known| known.at).collect();
        let lines = self.known.first().map_or(0, |known| known.levels.len());
        let of = |line: usize| self.known.iter().map(|known| known.levels[line]).collect();
        let values: Vec<Vec<f64>> = (0..lines).map(of).collect();
        self.levels = Interpolant::through(&points, &values, dimensions).unwrap_or_default();
        !self.levels.is_empty()
    }

    /// From the nearest point that is known.
    fn distance(&self, p: [f64; 2]) -> f64 {
        self.known.iter().map(|known| distance(known.at, p)).fold(f64::INFINITY, f64::min)
    }

    /// How far the line is expected to lie off `p`, in units of the tolerance.
    pub(super) fn error(&self, line: usize, p: [f64; 2]) -> f64 {
        let slope = self.levels[line].gradient(p);
        let steepness = (slope[0] / self.lengths[0]).hypot(slope[1] / self.lengths[1]);
        let apart = self.distance(p);
        let mut all: Vec<(f64, &Check)> = self.checks.iter().map(|check| (distance(check.at, p), check)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = || all.iter().filter(|(_, check)| check.levels[line].abs() < NEAR);
        let enough = near().count() >= CHECKS;
        // At a known point the function is right, so that the line is no farther from `p` than about twice that point is.
        let close = self.known.iter().map(|known| {
            let [x, y] = [0, 1].map(|k| (known.at[k] - p[k]) * self.lengths[k]);
            2.0 * x.hypot(y)
        });
        let close = close.fold(f64::INFINITY, f64::min);
        let used: Vec<&Check> =
            all.iter().filter(|(_, c)| !enough || c.levels[line].abs() < NEAR).take(CHECKS).map(|(_, c)| *c).collect();
        if used.len() < CHECKS || apart > FARTHEST {
            return if close <= self.tolerance { close } else { f64::INFINITY };
        }
        let of = |check: &Check| SAFETY * check.errors[line] * (apart / check.distance).powi(2);
        (used.into_iter().map(of).fold(0.0, f64::max) / steepness).min(close)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marches of functions of the unit square; the points that were marched, and what was found.
    fn search(lines: &[impl Fn([f64; 2]) -> f64], tolerance: f64, most: usize) -> (usize, Lines) {
        let mut count = 0;
        let search = Search { dimensions: 2, lengths: [1.0; 2], tolerance, most };
        let found = search.run(|points| {
            count += points.len();
            Some(points.iter().map(|p| Some(lines.iter().map(|line| line(*p)).collect())).collect())
        });
        (count, found)
    }

    /// Distance along the gradient from each point of the line found to the true one.
    fn farthest(found: &Lines, line: usize, truth: impl Fn([f64; 2]) -> f64) -> f64 {
        let level = &found.levels[line];
        let points = zeros(&|p| level.value(p), 2);
        assert!(!points.is_empty());
        let off = |p: [f64; 2]| {
            let h = 1e-5;
            let slope = [0, 1].map(|k| {
                let at = |s: f64| truth([p[0] + if k == 0 { s } else { 0.0 }, p[1] + if k == 1 { s } else { 0.0 }]);
                (at(h) - at(-h)) / (2.0 * h)
            });
            truth(p).abs() / slope[0].hypot(slope[1])
        };
        points.into_iter().map(off).fold(0.0, f64::max)
    }

    fn hyperbola(p: [f64; 2]) -> f64 {
        ((0.2 + p[0]) * (0.2 + p[1]) / 0.3).ln()
    }
    fn circle(p: [f64; 2]) -> f64 {
        (((p[0] - 0.45).powi(2) + (p[1] - 0.55).powi(2)) / 0.09 + 0.05).ln()
    }
    fn corner(p: [f64; 2]) -> f64 {
        (p[0] + 0.3 * p[1] - 0.7).max(1.5 * p[1] + 0.2 * p[0] - 0.9)
    }

    #[test]
    fn lines_are_where_they_are_said_to_be() {
        let (count, found) = search(&[hyperbola as fn([f64; 2]) -> f64, circle, corner], 0.01, 200);
        for (line, truth) in [hyperbola as fn([f64; 2]) -> f64, circle, corner].into_iter().enumerate() {
            let (off, said) = (farthest(&found, line, truth), found.errors[line].unwrap_or(f64::INFINITY));
            assert!(said <= 0.01 && off <= 0.01, "line {line}: {off}, said {said}, {count} points");
        }
        assert!(count <= 140, "{count}");
        // Of a smooth line alone few points are needed.
        let (count, found) = search(&[hyperbola], 0.01, 150);
        assert!(count <= 60 && farthest(&found, 0, hyperbola) <= 0.01, "{count}");
    }

    /// Two planes that meet in an edge somewhere, on a saddle.
    #[derive(Clone, Copy)]
    struct Edge {
        directions: [f64; 2],
        through: [f64; 2],
        saddle: f64,
    }

    impl Edge {
        fn any(random: &mut impl FnMut() -> f64) -> Self {
            let first = random() * std::f64::consts::TAU;
            let directions = [first, first + 1.5 * (random() - 0.5)];
            Self { directions, through: [0.2 + 0.6 * random(), 0.2 + 0.6 * random()], saddle: 0.5 * random() }
        }

        fn level(&self, p: [f64; 2]) -> f64 {
            let plane = |a: f64| a.cos() * (p[0] - self.through[0]) + a.sin() * (p[1] - self.through[1]);
            let [a, b] = self.directions.map(plane);
            a.max(b) + self.saddle * (p[0] - 0.5) * (p[1] - 0.5)
        }
    }

    #[test]
    fn corners_of_lines_are_found() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as f64 / (1_u64 << 31) as f64
        };
        let (mut lines, mut points) = (0, 0);
        for _ in 0..100 {
            let edge = Edge::any(&mut random);
            let (count, found) = search(&[|p: [f64; 2]| edge.level(p)], 0.01, 200);
            if found.errors[0].is_some() {
                let off = farthest(&found, 0, |p| edge.level(p));
                assert!(off <= 0.01, "{off} at {:?} after {count}", edge.through);
                (lines, points) = (lines + 1, points + count);
            }
        }
        assert!(lines > 80 && points <= 30 * lines, "{points} points of {lines} lines");
    }

    #[test]
    fn what_is_not_reached_is_said() {
        let (count, found) = search(&[circle], 1e-6, 30);
        assert!(count == 30 && found.errors[0].is_some_and(|error| error > 1e-6));
        let (count, found) = search(&[|p: [f64; 2]| p[0] + p[1] + 1.0], 0.01, 100);
        assert!(count == FIRST * FIRST && found.errors == [None]);
    }
}
