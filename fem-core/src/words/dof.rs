//! The report's nodal unknowns `Unm`.
//!
//! ```
//! use fem_core::dof::Dof;
//!
//! let slope: Dof = "U31".parse()?; // ∂w/∂x
//! assert_eq!((slope.n(), slope.m()), (3, 1));
//! assert_eq!(Dof::SOLID.iter().position(|dof| *dof == slope), Some(9));
//! assert!("U41".parse::<Dof>().is_err());
//! # Ok::<(), fem_core::dof::DofError>(())
//! ```

use std::fmt;

/// The unknown `Unm` of the report: translation `n` (1 = x, 2 = y, 3 = z), derivative `m` (0 = the value itself,
/// 1, 2, 3 = derivative along x, y, z).
///
/// Metres for `Un0`, dimensionless for the derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Dof {
    n: u8,
    m: u8,
}

impl Dof {
    /// `Unm`; `None` unless 1 ≤ n ≤ 3 and 0 ≤ m ≤ 3.
    pub const fn new(n: u8, m: u8) -> Option<Self> {
        if n >= 1 && n <= 3 && m <= 3 { Some(Self { n, m }) } else { None }
    }

    /// The twelve unknowns of a node of the report's solid element, in element order U10 U11 ... U33.
    pub const SOLID: [Dof; 12] = {
        let mut all = [Dof { n: 1, m: 0 }; 12];
        let mut i = 0;
        while i < 12 {
            all[i] = Dof { n: 1 + (i / 4) as u8, m: (i % 4) as u8 };
            i += 1;
        }
        all
    };

    /// Translation, 1 to 3.
    pub const fn n(self) -> usize {
        self.n as usize
    }

    /// Derivative, 0 to 3.
    pub const fn m(self) -> usize {
        self.m as usize
    }
}

impl fmt::Display for Dof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "U{}{}", self.n, self.m)
    }
}

/// A text that names no degree of freedom.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DofError(pub String);

impl fmt::Display for DofError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "`{}` is not a degree of freedom: write Unm with n = 1, 2, 3 (x, y, z) and m = 0 (value), 1, 2, 3 \
                 (derivative)",
            self.0
        )
    }
}
impl std::error::Error for DofError {}

impl std::str::FromStr for Dof {
    type Err = DofError;
    fn from_str(s: &str) -> Result<Self, DofError> {
        let digit = |i: usize| s.as_bytes().get(i).map(|b| b.wrapping_sub(b'0'));
        match (s.len(), s.as_bytes().first(), digit(1), digit(2)) {
            (3, Some(b'U' | b'u'), Some(n), Some(m)) => Dof::new(n, m),
            _ => None,
        }
        .ok_or_else(|| DofError(s.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip() {
        for d in Dof::SOLID {
            assert_eq!(d.to_string().parse::<Dof>(), Ok(d));
        }
        for bad in ["U40", "U34", "V10", "U1", "", "U100"] {
            assert!(bad.parse::<Dof>().is_err(), "{bad}");
        }
    }
}
