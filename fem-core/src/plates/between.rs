//! What a support that fixes values at nodes leaves free between them.

use crate::plates::mesh::Group;
use crate::plates::plate::Plate;
use crate::plates::support::axes_at;
use crate::words::dof::Dof;

/// Derivatives along a held line or face of the displacements that are zero at its nodes, as sums over all unknowns: where these
/// are unknowns of their own, the plate moves between the nodes. The sides and cells of `group` are held in the values among
/// `dofs`, in axes turned by `angle` (radians), at the `levels` of each node; over the height where these are two or more.
pub fn between(
    plate: &Plate,
    group: &Group,
    levels: impl Fn(u32) -> Vec<usize>,
    dofs: &[Dof],
    angle: f64,
) -> Vec<Vec<(usize, f64)>> {
    let turn = axes_at(angle);
    let mut found = Vec::new();
    let of_vertices = plate.plane.courses(group);
    for column in plate.columns_of_group(group) {
        // The nodes of a section stand between two vertices.
        let vertex = plate.ends(column as usize).map_or(column, |[end, _]| end);
        let Some(courses) = of_vertices.get(&vertex) else { continue };
        let levels = levels(column);
        let column = column as usize;
        for level in &levels {
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
                // A second set belongs to the other side of a line, or of an interface that may open.
                found
                    .extend(courses.iter().flat_map(|course| [0, 1].map(|side| along(axes_at(course.angle)[0], side))));
                found.extend(up.into_iter().flatten());
            }
        }
    }
    found.retain(|terms| !terms.is_empty());
    found
}
