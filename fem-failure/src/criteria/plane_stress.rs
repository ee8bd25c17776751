//! What a criterion for plane stress does with the stresses that it does not know.

use crate::prelude::*;

/// Treatment of σ33, σ23 and σ31 by a criterion for plane stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OutOfPlane {
    /// Refuse a stress of which one of them exceeds 1 % of the largest of σ11, σ22, σ12.
    #[default]
    Refuse,
    /// Judge σ11, σ22 and σ12, whatever the others are.
    Ignore,
}

impl OutOfPlane {
    pub(crate) const PARAM: ParamInfo = ParamInfo::word(
        "out_of_plane",
        "what becomes of stresses 33, 23, 31 above 1 % of the largest of 11, 22, 12",
        &[("refuse", "the run stops"), ("ignore", "they are not looked at")],
    );

    pub(crate) fn from_params(params: &Params) -> Result<Self, ParamError> {
        Ok(match params.word(&Self::PARAM)? {
            "ignore" => Self::Ignore,
            _ => Self::Refuse,
        })
    }

    pub(crate) fn scope(self) -> &'static str {
        match self {
            Self::Refuse => {
                "plane stress: 33, 23 and 31 within 1 % of the largest of 11, 22 and 12; choose a three-dimensional \
                 criterion, or set out_of_plane = \"ignore\""
            }
            Self::Ignore => "every finite stress, of which it sees 11, 22 and 12",
        }
    }

    #[inline]
    pub(crate) fn admits(self, s: &Stress6<Ply>) -> bool {
        let seen = s.s11().abs().max(s.s22().abs()).max(s.s12().abs());
        self == Self::Ignore || [s.s33(), s.s23(), s.s31()].iter().all(|c| c.abs() <= 0.01 * seen)
    }

    /// Whether it surely admits every stress of a range.
    #[inline]
    pub(crate) fn admits_all(self, s: &StressRange) -> bool {
        let seen = [s.s11(), s.s22(), s.s12()].iter().fold(0.0, |seen: f64, of| seen.max(of.abs().low));
        self == Self::Ignore || [s.s33(), s.s23(), s.s31()].iter().all(|c| c.magnitude() <= 0.01 * seen)
    }
}
