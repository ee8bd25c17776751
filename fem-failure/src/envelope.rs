//! Failure envelopes: the stresses of a plane that bring a material to failure.
//!
//! ```
//! use fem_failure::envelope::StressPlane;
//!
//! let plane: StressPlane = "s2-s12".parse()?; // across the fibres, and shear along them
//! assert_eq!(plane.names(), ["s2", "s12"]);
//! assert!("s2-s2".parse::<StressPlane>().is_err());
//! # Ok::<(), fem_failure::envelope::StressPlaneError>(())
//! ```

use fem_core::failure::{FailureCriterion, check_material};
use fem_core::material::{Material, MaterialError};
use fem_core::tensor::{Ply, Stress6};
use std::fmt;
use std::str::FromStr;

/// Two components of the stress; the others are zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StressPlane([usize; 2]);

/// Names of the components, in the order of [`Stress6`].
const COMPONENTS: [&str; 6] = ["s1", "s2", "s3", "s12", "s23", "s13"];

impl StressPlane {
    /// Names of the two components.
    pub fn names(self) -> [&'static str; 2] {
        self.0.map(|i| COMPONENTS[i])
    }

    fn stress(self, values: [f64; 2]) -> Stress6<Ply> {
        let mut s = [0.0; 6];
        (s[self.0[0]], s[self.0[1]]) = (values[0], values[1]);
        Stress6::new(s)
    }
}

/// A text that does not name two components of the stress.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not a plane: write two different ones of {components} with a dash", components = COMPONENTS.join(", "))]
pub struct StressPlaneError(pub String);

impl FromStr for StressPlane {
    type Err = StressPlaneError;

    /// Reads `s2-s12`.
    fn from_str(text: &str) -> Result<Self, StressPlaneError> {
        let component = |name: &str| COMPONENTS.iter().position(|c| *c == name);
        let read = |(a, b)| Some([component(a)?, component(b)?]);
        match text.split_once('-').and_then(read) {
            Some([a, b]) if a != b => Ok(Self([a, b])),
            _ => Err(StressPlaneError(text.to_owned())),
        }
    }
}

impl fmt::Display for StressPlane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.names().join("-"))
    }
}

/// A criterion with the name that errors give it.
pub type Named<'a> = (&'a str, &'a dyn FailureCriterion);

/// The envelopes of several criteria over the same directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Envelopes {
    /// Largest stress, Pa, that a criterion bears in either sense of each component alone.
    pub scale: [f64; 2],
    /// Per criterion its points by growing angle, from 0 to a whole turn.
    pub curves: Vec<Vec<EnvelopePoint>>,
}

/// Failure in one direction of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvelopePoint {
    /// Angle, radians, of the direction once each component is divided by its scale.
    pub angle: f64,
    /// Distance from zero in the same measure; infinite where nothing fails up to 1000.
    pub radius: f64,
    /// The two components, Pa; meaningless where nothing fails.
    pub stress: [f64; 2],
    /// The mode that governs, where there is failure.
    pub mode: Option<usize>,
}

/// Why there is no envelope.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvelopeError {
    /// A criterion cannot judge the material.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// A criterion refuses stresses of the plane.
    #[error("criterion `{criterion}` refuses stresses of the plane {plane}: it takes {scope}")]
    Scope {
        /// Its name.
        criterion: String,
        /// The plane.
        plane: StressPlane,
        /// [`FailureCriterion::scope`].
        scope: &'static str,
    },
    /// No criterion sees one of the components.
    #[error("none of the criteria fails under {0} alone: choose another plane")]
    Unbounded(&'static str),
}

/// The envelopes of `criteria` in `plane` along `directions` evenly spread directions.
///
/// Every point is the stress at the reserve factor of its direction. Between two directions whose modes differ the switch
/// is found by bisection and both its sides are added, so that corners are sharp and a jump is a straight line
/// along its direction.
///
/// # Errors
/// A material or a plane that a criterion refuses; a component under which none fails.
pub fn envelopes(
    criteria: &[Named<'_>],
    m: &Material,
    plane: StressPlane,
    directions: usize,
) -> Result<Envelopes, EnvelopeError> {
    for (name, criterion) in criteria {
        check_material(*criterion, name, m)?;
    }
    let mut scale = [0.0_f64; 2];
    for (axis, scale) in scale.iter_mut().enumerate() {
        for (name, criterion) in criteria {
            for sense in [1.0, -1.0] {
                let mut unit = [0.0; 2];
                unit[axis] = sense;
                let bears = Ray { name, criterion: *criterion, m, plane, scale: [1.0; 2] }.find_failure(unit)?.0;
                *scale = if bears.is_finite() { scale.max(bears) } else { *scale };
            }
        }
        if *scale == 0.0 {
            return Err(EnvelopeError::Unbounded(plane.names()[axis]));
        }
    }
    let curve = |(name, criterion): &Named<'_>| {
        let ray = Ray { name, criterion: *criterion, m, plane, scale };
        let mut points: Vec<EnvelopePoint> = Vec::new();
        for k in 0..=directions {
            let next = ray.point(k as f64 / directions as f64)?;
            if let Some(last) = points.last().copied() {
                points.extend(ray.find_switch(last, next)?);
            }
            points.push(next);
        }
        Ok(points)
    };
    Ok(Envelopes { scale, curves: criteria.iter().map(curve).collect::<Result<_, EnvelopeError>>()? })
}

/// Radius from which an envelope counts as open: rounding alone bounds it somewhere.
const OPEN: f64 = 1e3;

/// One criterion in one plane.
struct Ray<'a> {
    name: &'a str,
    criterion: &'a dyn FailureCriterion,
    m: &'a Material,
    plane: StressPlane,
    scale: [f64; 2],
}

impl Ray<'_> {
    /// Reserve factor and mode of a stress in units of the scale.
    fn find_failure(&self, values: [f64; 2]) -> Result<(f64, Option<usize>), EnvelopeError> {
        let s = self.plane.stress([values[0] * self.scale[0], values[1] * self.scale[1]]);
        let reserve = self.criterion.reserve_factor(&s, self.m);
        if reserve.factor.is_nan() {
            let (criterion, scope) = (self.name.to_owned(), self.criterion.scope());
            return Err(EnvelopeError::Scope { criterion, plane: self.plane, scope });
        }
        Ok((reserve.factor, reserve.mode))
    }

    /// The point in the direction after `turn` of a whole turn; quarter turns lie exactly on the axes.
    fn point(&self, turn: f64) -> Result<EnvelopePoint, EnvelopeError> {
        let angle = turn * std::f64::consts::TAU;
        let quarter = (4.0 * turn).round();
        let along = match (4.0 * turn == quarter, quarter as u8 % 4) {
            (true, 0) => [1.0, 0.0],
            (true, 1) => [0.0, 1.0],
            (true, 2) => [-1.0, 0.0],
            (true, _) => [0.0, -1.0],
            _ => [angle.cos(), angle.sin()],
        };
        let (radius, mode) = match self.find_failure(along)? {
            (radius, _) if radius > OPEN => (f64::INFINITY, None),
            bounded => bounded,
        };
        Ok(EnvelopePoint { angle, radius, stress: [0, 1].map(|i| radius * along[i] * self.scale[i]), mode })
    }

    /// Both sides of the switch between `a` and `b`; nothing if their modes are the same.
    fn find_switch(&self, mut a: EnvelopePoint, mut b: EnvelopePoint) -> Result<Vec<EnvelopePoint>, EnvelopeError> {
        let ends = [a.angle, b.angle];
        if a.mode == b.mode {
            return Ok(Vec::new());
        }
        for _ in 0..40 {
            let middle = self.point(0.5 * (a.angle + b.angle) / std::f64::consts::TAU)?;
            if middle.mode == a.mode { a = middle } else { b = middle }
        }
        Ok([a, b].into_iter().filter(|p| !ends.contains(&p.angle)).collect())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{Hashin1980, HashinReport, MaxStress, Octahedral, Puck, TsaiHill, TsaiWu};
    use fem_core::material::{Elastic, Strength, Strengths, Toughnesses};

    fn material() -> Material {
        let values = [1793e6, 1724e6, 64e6, 138e6, 109e6, 69e6];
        Material {
            name: "AS4/3502".into(),
            elastic: Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9),
            density: None,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
            strengths: Strength::ALL.iter().zip(values).fold(Strengths::default(), |s, (which, v)| s.with(*which, v)),
        }
    }

    fn compute(criterion: &dyn FailureCriterion, plane: &str, directions: usize) -> Result<Envelopes, EnvelopeError> {
        envelopes(&[("c", criterion)], &material(), plane.parse().unwrap(), directions)
    }

    #[test]
    fn limits_of_stress_make_a_box_with_its_corners() {
        let found = compute(&MaxStress, "s2-s12", 30).unwrap();
        assert_eq!(found.scale, [138e6, 109e6]);
        let corner =
            |p: &&EnvelopePoint| (p.stress[0] / 64e6 - 1.0).abs() < 1e-9 && (p.stress[1] / 109e6 - 1.0).abs() < 1e-9;
        assert_eq!(found.curves[0].iter().filter(corner).count(), 2, "{:?}", found.curves);
        for p in &found.curves[0] {
            let [a, b] = p.stress;
            assert!((a / 64e6).max(-a / 138e6).max(b.abs() / 109e6) - 1.0 < 1e-12, "{p:?}");
        }
        let (first, last) = (found.curves[0].first().unwrap(), found.curves[0].last().unwrap());
        assert_eq!(first.stress, last.stress, "it closes");
    }

    #[test]
    fn every_point_fails_exactly() {
        let criteria: [&dyn FailureCriterion; 4] =
            [&HashinReport::default(), &Hashin1980, &TsaiWu::default(), &Puck::default()];
        for criterion in criteria {
            for p in compute(criterion, "s2-s12", 48).unwrap().curves.remove(0) {
                let s = StressPlane([1, 3]).stress(p.stress);
                let reserve = criterion.reserve_factor(&s, &material());
                assert!((reserve.factor - 1.0).abs() < 1e-12 && p.mode.is_some(), "{criterion:?} {p:?} {reserve:?}");
            }
        }
    }

    #[test]
    fn an_envelope_may_be_open() {
        let found = compute(&Hashin1980, "s2-s3", 64).unwrap();
        let open: Vec<_> = found.curves[0].iter().filter(|p| p.mode.is_none()).map(|p| p.angle.to_degrees()).collect();
        assert!(open.contains(&225.0) && open.iter().all(|a| (180.0..270.0).contains(a)), "{open:?}");
    }

    #[test]
    fn what_has_no_envelope_is_refused_by_name() {
        let why = |criterion: &dyn FailureCriterion, plane| compute(criterion, plane, 8).unwrap_err().to_string();
        assert!(why(&TsaiHill::default(), "s1-s13").contains("criterion `c` refuses stresses of the plane s1-s13"));
        assert!(
            why(&crate::Puck2d { out_of_plane: crate::OutOfPlane::Ignore, ..Default::default() }, "s1-s3")
                .contains("fails under s3 alone")
        );
        let bare = Material { strengths: Strengths::default(), ..material() };
        let error = envelopes(&[("o", &Octahedral)], &bare, StressPlane([0, 1]), 8).unwrap_err().to_string();
        assert!(error.contains("`o` needs the strength S12"), "{error}");
        for plane in ["s2", "s2-s2", "s2-t12", "s2-s12-s1", ""] {
            assert!(plane.parse::<StressPlane>().unwrap_err().to_string().contains("is not a plane"), "{plane}");
        }
        assert_eq!("s1-s13".parse::<StressPlane>().unwrap().to_string(), "s1-s13");
    }
}
