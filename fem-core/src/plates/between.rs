//! What a support that fixes values at nodes leaves free between them.

use crate::plates::mesh::Group;
use crate::plates::plate::Plate;
use crate::words::dof::Dof;
use std::collections::BTreeMap;

/// Cosine of the angle between two sides up to which they are one smooth line.
const SMOOTH: f64 = 0.8;

/// Derivatives along a held line or face of the displacements that are zero at its nodes, as sums over all unknowns: where these
/// are unknowns of their own, the plate moves between the nodes. The sides and cells of `group` are held in the values among
/// `dofs`, in axes turned by `angle` (radians), at `levels`; over the height where these are two or more.
pub fn between(plate: &Plate, group: &Group, levels: &[usize], dofs: &[Dof], angle: f64) -> Vec<Vec<(usize, f64)>> {
    let (s, c) = angle.sin_cos();
    let turn = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]];
    let mut found = Vec::new();
    for (column, directions) in directions(plate, group) {
        for level in levels {
            for n in dofs.iter().filter(|dof| dof.m() == 0).map(|dof| turn[dof.n() - 1]) {
                let along = |t: [f64; 3], side: usize| -> Vec<(usize, f64)> {
                    let mut terms = Vec::new();
                    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                        let Some(dof) = Dof::new(i as u8 + 1, j as u8 + 1).filter(|_| n[i] * t[j] != 0.0) else {
                            continue;
                        };
                        let mut unknowns = plate.dofs_at(column, *level, dof);
                        terms.extend(unknowns.nth(side).map(|unknown| (unknown, n[i] * t[j])));
                    }
                    terms
                };
                let up = [0, 1].map(|side| (levels.len() > 1).then(|| along([0.0, 0.0, 1.0], side)));
                found.extend(directions.iter().map(|[x, y]| along([*x, *y, 0.0], 0)));
                found.extend(up.into_iter().flatten());
            }
        }
    }
    found.retain(|terms| !terms.is_empty());
    found
}

/// Directions in the plane, of length 1, in which the group goes on from each of its vertices.
fn directions(plate: &Plate, group: &Group) -> BTreeMap<usize, Vec<[f64; 2]>> {
    let mut all: BTreeMap<usize, Vec<[f64; 2]>> = BTreeMap::new();
    for [a, b] in &group.edges {
        let [p, q] = [a, b].map(|v| plate.plane.points[*v as usize]);
        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
        let direction = [(q[0] - p[0]) / length, (q[1] - p[1]) / length];
        for vertex in [a, b] {
            let here = all.entry(*vertex as usize).or_default();
            let cosine = |other: &[f64; 2]| direction[0] * other[0] + direction[1] * other[1];
            match here.iter_mut().find(|other| cosine(other).abs() > SMOOTH) {
                None => here.push(direction),
                Some(other) => {
                    let sign = cosine(other).signum();
                    let sum = [other[0] + sign * direction[0], other[1] + sign * direction[1]];
                    *other = sum.map(|x| x / sum[0].hypot(sum[1]));
                }
            }
        }
    }
    for vertex in group.quads.iter().flat_map(|quad| plate.columns_of_quad(*quad as usize)) {
        if (*vertex as usize) < plate.plane.points.len() {
            all.insert(*vertex as usize, vec![[1.0, 0.0], [0.0, 1.0]]);
        }
    }
    all
}
