//! Supports of one node in axes that are all but the same.

use super::builder::Builder;
use fem_core::axes::Turns;
use fem_core::dof::Dof;
use fem_core::plate::Plate;
use fem_io::scene::SceneError;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// Axes that are turned by less than this against each other, radians, are hardly meant to be two.
const NEARLY: f64 = 1.0 / 180.0 * std::f64::consts::PI;

/// What is nearer was made one before, up to rounding, radians.
const ROUNDING: f64 = 1e-12;

/// What a support holds of a node.
struct Turned {
    /// Which support, by number.
    support: usize,
    column: u32,
    level: usize,
    dofs: Vec<Dof>,
    angle: f64,
}

impl Turned {
    /// Directions 0, 1 of its axes, turned on by so many quarters, along which it holds displacements, their derivatives along z or
    /// the slopes of the deflection.
    fn held(&self, what: fn(&Dof) -> Option<usize>, quarters: usize) -> [bool; 2] {
        let mut held = [false; 2];
        self.dofs.iter().filter_map(what).for_each(|direction| held[(direction + quarters) % 2] = true);
        held
    }

    /// By how much the axes of another one are turned against these, radians, where the two hold the node along one direction each,
    /// which are all but the same.
    fn all_but(&self, other: &Self) -> Option<f64> {
        let quarters = ((other.angle - self.angle) / FRAC_PI_2).round();
        let off = (other.angle - self.angle - quarters * FRAC_PI_2).abs();
        let turned = quarters.rem_euclid(2.0) as usize;
        let both = |what: &fn(&Dof) -> Option<usize>| {
            let (own, others) = (self.held(*what, 0), other.held(*what, turned));
            own == others && own[0] != own[1]
        };
        ((ROUNDING..=NEARLY).contains(&off) && VECTORS.iter().any(both)).then_some(off)
    }
}

/// Displacements along the axes, their derivatives along z, slopes of the deflection: each a vector in the plane.
const VECTORS: [fn(&Dof) -> Option<usize>; 3] = [
    |dof| (dof.n() < 3 && dof.m() == 0).then(|| dof.n() - 1),
    |dof| (dof.n() < 3 && dof.m() == 3).then(|| dof.n() - 1),
    |dof| (dof.n() == 3 && (1..3).contains(&dof.m())).then(|| dof.m() - 1),
];

impl Builder<'_> {
    /// What the user should know of supports that hold a node along one direction each, which are all but the same: together they
    /// hold it along both.
    pub(super) fn nearly_turned(&self, plate: &Plate) -> Result<Vec<String>, SceneError> {
        let (mut turns, mut names, mut all) = (Turns::default(), Vec::new(), Vec::new());
        for (number, support) in self.scene.supports.iter().enumerate() {
            let (name, holds) = self.holds(plate, support, &mut turns)?;
            names.push(name);
            for hold in holds {
                let nodes = hold.columns.iter().flat_map(|column| hold.levels.iter().map(|level| (*column, *level)));
                all.extend(nodes.map(|(column, level)| Turned {
                    support: number,
                    column,
                    level,
                    dofs: hold.dofs.clone(),
                    angle: hold.angle,
                }));
            }
        }
        all.sort_by_key(|turned| (turned.column, turned.level));
        let mut found: BTreeMap<[usize; 2], (u32, f64)> = BTreeMap::new();
        for node in all.chunk_by(|a, b| (a.column, a.level) == (b.column, b.level)) {
            for (k, b) in node.iter().enumerate() {
                for a in node[..k].iter().filter(|a| a.support != b.support) {
                    if let Some(off) = a.all_but(b) {
                        found.entry([a.support, b.support]).or_insert((b.column, off));
                    }
                }
            }
        }
        let warn = |([a, b], (column, off)): ([usize; 2], (u32, f64))| {
            let [x, y] = plate.columns[column as usize].map(|x| x * 1e3);
            format!(
                "the supports of {} and {} hold {} at ({x:.4}, {y:.4}) mm along axes {:.2e} degrees apart, and so in both directions: \
                 give both the same `axes`, or keep the node out of one of the groups",
                names[a],
                names[b],
                plate.describe_column(column as usize),
                off.to_degrees()
            )
        };
        Ok(found.into_iter().map(warn).collect())
    }
}
