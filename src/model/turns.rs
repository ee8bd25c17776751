//! Supports of one node in axes that are all but the same.

use super::builder::Builder;
use fem_core::axes::Turns;
use fem_core::dof::Dof;
use fem_core::plate::Plate;
use fem_io::scene::{SceneError, Support};
use std::collections::BTreeSet;
use std::f64::consts::FRAC_PI_2;

/// Axes that are turned by less than this against each other, radians, are hardly meant to be two.
const NEARLY: f64 = 1.0 / 180.0 * std::f64::consts::PI;

/// What is nearer was made one before, up to rounding, radians.
const ROUNDING: f64 = 1e-12;

/// A support as far as it matters here.
struct Turned<'a> {
    name: &'a str,
    nodes: BTreeSet<(u32, usize)>,
    dofs: &'a [Dof],
    angle: f64,
}

impl Turned<'_> {
    /// Directions 0, 1 of its axes, turned on by so many quarters, along which it holds displacements, their derivatives along z or
    /// the slopes of the deflection.
    fn held(&self, what: fn(&Dof) -> Option<usize>, quarters: usize) -> [bool; 2] {
        let mut held = [false; 2];
        self.dofs.iter().filter_map(what).for_each(|direction| held[(direction + quarters) % 2] = true);
        held
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
        let (mut turns, mut all) = (Turns::default(), Vec::new());
        for support in &self.scene.supports {
            let Support::Fix { nodes, dofs, axes, .. } = support else { continue };
            let (columns, levels) = self.nodes(plate, nodes)?;
            let nodes_of = columns.iter().flat_map(|c| levels.iter().map(|l| (*c, *l)));
            let name = nodes.group.value.as_str();
            all.push(Turned { name, nodes: nodes_of.collect(), dofs, angle: turns.settle(*axes) });
        }
        let mut warnings = Vec::new();
        for (k, a) in all.iter().enumerate() {
            warnings.extend(all[..k].iter().filter_map(|b| warn(plate, b, a)));
        }
        Ok(warnings)
    }
}

fn warn(plate: &Plate, a: &Turned<'_>, b: &Turned<'_>) -> Option<String> {
    let quarters = ((b.angle - a.angle) / FRAC_PI_2).round();
    let off = (b.angle - a.angle - quarters * FRAC_PI_2).abs();
    if !(ROUNDING..=NEARLY).contains(&off) {
        return None;
    }
    let turned = quarters.rem_euclid(2.0) as usize;
    let both = |what: &fn(&Dof) -> Option<usize>| {
        let (a, b) = (a.held(*what, 0), b.held(*what, turned));
        a == b && a[0] != a[1]
    };
    let (column, _) = a.nodes.intersection(&b.nodes).next().filter(|_| VECTORS.iter().any(both))?;
    let [x, y] = plate.columns[*column as usize].map(|x| x * 1e3);
    Some(format!(
        "the supports of `{}` and `{}` hold {} at ({x:.4}, {y:.4}) mm along axes {:.2e} degrees apart, and so in both directions: give \
         both the same `axes`, or keep the node out of one of the groups",
        a.name,
        b.name,
        plate.describe_column(*column as usize),
        off.to_degrees()
    ))
}
