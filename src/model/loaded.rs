//! Where loads at rest act, and how well the cells see them.

use super::builder::Builder;
use fem_core::load::{self, Unresolved};
use fem_core::plate::Plate;
use fem_io::scene::{Load, LoadKind, Located, Pressure, SceneError, Window};
use std::f64::consts::PI;

/// Share of a pressure that the cells may lose.
const LOST: f64 = 0.01;

/// Cells or windows up to as large as whose area a load is narrow.
const NARROW: f64 = 8.0;

impl Builder<'_> {
    /// Where loads press that are no wider than some cells or windows: a formula at its peak, a group in its middle. Nobody looks there
    /// where windows follow the cells.
    pub(super) fn loaded(&self, plate: &Plate, loads: &[Load]) -> Result<Vec<[f64; 2]>, SceneError> {
        let mut places = Vec::new();
        if self.scene.failure.criteria.is_empty() || self.scene.failure.window == Window::Element {
            return Ok(places);
        }
        for Load { kind, .. } in loads {
            match kind {
                LoadKind::Patch { at, radius, .. } => {
                    let (at, _) = self.point(plate, at)?;
                    places.extend(self.is_narrow(plate, at, PI * radius * radius).then_some(at));
                }
                LoadKind::Point { node, .. } => {
                    places.extend(self.columns(plate, &node.group)?.into_iter().map(|c| plate.columns[c as usize]));
                }
                LoadKind::Pressure { pressure: pressure @ Pressure::Formula { .. }, group, .. } => {
                    places.extend(self.narrow_peak(plate, &self.pressed(plate, group)?, |at| pressure.at(at)));
                }
                LoadKind::Pressure { pressure: Pressure::Uniform(_), group, .. } => {
                    let quads = self.pressed(plate, group)?;
                    let (at, area) = middle(plate, &quads);
                    // Of a ring the middle lies in the hole.
                    let inside = quads.iter().any(|quad| plate.plane.corners(*quad).locate(at).is_some());
                    places.extend((inside && self.is_narrow(plate, at, area)).then_some(at));
                }
                LoadKind::Edge { .. } | LoadKind::Displacement { .. } | LoadKind::Gravity { .. } => {}
            }
        }
        Ok(places)
    }

    /// Where |p| is largest, if ∫ |p| dA is narrow there. Of cells that a symmetry maps onto each other one stands for all.
    fn narrow_peak(&self, plate: &Plate, quads: &[usize], p: impl Fn([f64; 2]) -> f64) -> Option<[f64; 2]> {
        let kept: Vec<usize> = quads.iter().copied().filter(|quad| plate.symmetry().quad(*quad) == *quad).collect();
        let (at, peak) = load::peak(plate, &kept, &p)?;
        self.is_narrow(plate, at, load::size(plate, quads, &p) / peak).then_some(at)
    }

    /// Whether a load over this area is no wider than some cells or windows at a place.
    fn is_narrow(&self, plate: &Plate, at: [f64; 2], area: f64) -> bool {
        let plane = &plate.plane;
        let window = match self.scene.failure.window {
            Window::Square(side) => side * side,
            Window::Element => 0.0,
        };
        let cell = (0..plane.quads.len()).find(|quad| plane.corners(*quad).locate(at).is_some());
        cell.is_some_and(|quad| area <= NARROW * plane.quality(quad).area.max(window))
    }

    /// What is lost of pressures that change faster than the cells are integrated.
    pub(super) fn unresolved(&self, plate: &Plate, loads: &[Load]) -> Result<Vec<String>, SceneError> {
        let mut warnings = Vec::new();
        for (number, Load { kind, .. }) in loads.iter().enumerate() {
            let LoadKind::Pressure { pressure: pressure @ Pressure::Formula { .. }, group, .. } = kind else {
                continue;
            };
            let how = match load::unresolved(plate, &self.pressed(plate, group)?, |at| pressure.at(at)) {
                Unresolved::Share(missed) if missed <= LOST => continue,
                Unresolved::Share(missed) => {
                    format!("with twice as many points its force differs by {:.1} %", 1e2 * missed)
                }
                Unresolved::Peak => "no point of the integration sees its peak".to_owned(),
            };
            warnings.push(format!(
                "the pressure of `load[{number}]` changes faster than the cells are integrated: {how}; make the cells smaller where it \
                 changes"
            ));
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

/// Centroid and area of some cells.
fn middle(plate: &Plate, quads: &[usize]) -> ([f64; 2], f64) {
    let mut sum = [0.0; 3];
    for quad in quads {
        let ([x, y], area) = (plate.plane.corners(*quad).centroid(), plate.plane.quality(*quad).area);
        [x * area, y * area, area].iter().zip(&mut sum).for_each(|(part, sum)| *sum += part);
    }
    let [x, y, area] = sum;
    ([x / area, y / area], area)
}
