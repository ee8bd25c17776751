//! Where loads at rest act, and how well the cells see them.

use super::builder::Builder;
use fem_core::load;
use fem_core::plate::Plate;
use fem_io::scene::{Load, LoadKind, Located, Pressure, SceneError};

/// Share of a pressure that the cells may lose.
const LOST: f64 = 0.01;

impl Builder<'_> {
    /// Places around which loads that act on a part of the plate press on it: where a formula has its peak, in the middle of a group.
    pub(super) fn loaded(&self, plate: &Plate, loads: &[Load]) -> Result<Vec<[f64; 2]>, SceneError> {
        let mut places = Vec::new();
        for Load { kind, .. } in loads {
            match kind {
                LoadKind::Patch { at, .. } => places.push(self.point(plate, at)?.0),
                LoadKind::Point { node, .. } => {
                    places.extend(self.columns(plate, &node.group)?.into_iter().map(|c| plate.columns[c as usize]));
                }
                LoadKind::Pressure { pressure: pressure @ Pressure::Formula { .. }, group, .. } => {
                    places.extend(
                        load::peak(plate, &self.pressed(plate, group)?, |at| pressure.at(at)).map(|peak| peak.0),
                    );
                }
                LoadKind::Pressure { pressure: Pressure::Uniform(_), group: group @ Some(_), .. } => {
                    places.extend(middle(plate, &self.pressed(plate, group)?));
                }
                LoadKind::Pressure { .. }
                | LoadKind::Edge { .. }
                | LoadKind::Displacement { .. }
                | LoadKind::Gravity { .. } => {}
            }
        }
        Ok(places)
    }

    /// What is lost of pressures that change faster than the cells are integrated.
    pub(super) fn unresolved(&self, plate: &Plate, loads: &[Load]) -> Result<Vec<String>, SceneError> {
        let mut warnings = Vec::new();
        for (number, Load { kind, .. }) in loads.iter().enumerate() {
            let LoadKind::Pressure { pressure: pressure @ Pressure::Formula { .. }, group, .. } = kind else {
                continue;
            };
            let missed = load::unresolved(plate, &self.pressed(plate, group)?, |at| pressure.at(at));
            if !(missed <= LOST) {
                warnings.push(format!(
                    "the pressure of `load[{number}]` changes faster than the cells are integrated: with twice as many points its force differs \
                     by {:.1} %; make the cells smaller where it changes",
                    1e2 * missed
                ));
            }
        }
        Ok(warnings)
    }

    /// The cells that a pressure presses on.
    pub(super) fn pressed(&self, plate: &Plate, group: &Option<Located<String>>) -> Result<Vec<usize>, SceneError> {
        let Some(name) = group else { return Ok((0..plate.plane.quads.len()).collect()) };
        let quads: Vec<usize> = self.group(plate, name)?.quads.iter().map(|q| *q as usize).collect();
        match quads.is_empty() {
            true => Err(self.error(
                name,
                "the group has no cells that can move",
                "a pressure acts on a surface that is not clamped",
            )),
            false => Ok(quads),
        }
    }
}

/// Centroid of some cells.
fn middle(plate: &Plate, quads: &[usize]) -> Option<[f64; 2]> {
    let mut sum = [0.0; 3];
    for quad in quads {
        let ([x, y], area) = (plate.plane.corners(*quad).centroid(), plate.plane.quality(*quad).area);
        [x * area, y * area, area].iter().zip(&mut sum).for_each(|(part, sum)| *sum += part);
    }
    let [x, y, area] = sum;
    (area > 0.0).then(|| [x / area, y / area])
}
