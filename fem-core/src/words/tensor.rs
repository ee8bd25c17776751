//! Symmetric tensors with their frame in the type.
//!
//! Component order, here and nowhere else: **11 22 33 12 23 31** (report eq. 22), shear strains engineering.
//!
//! ```
//! use fem_core::tensor::{Global, Stress6};
//!
//! // Tension along x meets a ply at 45 degrees as tension along and across its fibres, and as shear.
//! let pull = Stress6::<Global>::new([100e6, 0.0, 0.0, 0.0, 0.0, 0.0]);
//! let ply = pull.to_ply(45.0_f64.to_radians());
//! for (stress, expected) in [(ply.s11(), 50e6), (ply.s22(), 50e6), (ply.s12(), -50e6), (ply.s33(), 0.0)] {
//!     assert!((stress - expected).abs() < 1e-6);
//! }
//! ```

use std::fmt::Debug;
use std::marker::PhantomData;

/// A frame of reference, used only as a type.
pub trait Frame: Copy + Debug + Send + Sync + 'static {}

/// The plate's frame: x, y in the plane, z through the thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Global {}
/// A ply's frame: 1 along the fibres, 2 across them in the plane, 3 through the thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ply {}
impl Frame for Global {}
impl Frame for Ply {}

/// A 6 × 6 matrix in the component order of this module, `c[row][column]`.
pub type Matrix6 = [[f64; 6]; 6];

macro_rules! tensor {
    ($(#[$doc:meta])* $name:ident, $($get:ident = $i:literal),+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent, bound = ""))]
        #[repr(transparent)]
        pub struct $name<F: Frame>(pub [f64; 6], PhantomData<F>);

        impl<F: Frame> $name<F> {
            /// From components in the order 11 22 33 12 23 31.
            #[inline]
            pub const fn new(c: [f64; 6]) -> Self {
                Self(c, PhantomData)
            }
            /// True when every component is finite.
            #[inline]
            pub fn is_finite(&self) -> bool {
                self.0.iter().all(|c| c.is_finite())
            }
            /// Every component times `factor`.
            #[inline]
            pub fn scaled(&self, factor: f64) -> Self {
                Self::new(self.0.map(|c| c * factor))
            }
            $(#[doc = concat!("Component ", stringify!($get), ".")]
            #[inline]
            pub const fn $get(&self) -> f64 { self.0[$i] })+
        }
        impl<F: Frame> Debug for $name<F> {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{}{:?}", stringify!($name), self.0)
            }
        }
    };
}

tensor!(
    /// Cauchy stress, Pa.
    Stress6, s11 = 0, s22 = 1, s33 = 2, s12 = 3, s23 = 4, s31 = 5
);
tensor!(
    /// Small strain with engineering shears.
    Strain6, e11 = 0, e22 = 1, e33 = 2, g12 = 3, g23 = 4, g31 = 5
);

impl Strain6<Global> {
    /// The same strain in the frame of a ply whose fibres lie at `angle` (radians, x towards y).
    pub fn to_ply(&self, angle: f64) -> Strain6<Ply> {
        Strain6::new(apply(&strain_rotation(angle), &self.0))
    }
}

impl Stress6<Global> {
    /// The same stress in the frame of a ply; `angle` as in [`Strain6::to_ply`].
    pub fn to_ply(&self, angle: f64) -> Stress6<Ply> {
        Stress6::new(apply(&transpose(&strain_rotation(-angle)), &self.0))
    }
}

impl Stress6<Ply> {
    /// The same stress in the plate's frame; `angle` as in [`Strain6::to_ply`].
    pub fn to_global(&self, angle: f64) -> Stress6<Global> {
        Stress6::new(apply(&transpose(&strain_rotation(angle)), &self.0))
    }
}

/// σ = C ε in one frame.
#[inline]
pub fn stress<F: Frame>(c: &Matrix6, e: &Strain6<F>) -> Stress6<F> {
    Stress6::new(apply(c, &e.0))
}

/// m v
#[inline]
pub fn apply(m: &Matrix6, v: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|i| (0..6).map(|j| m[i][j] * v[j]).sum())
}

pub(crate) fn transpose(m: &Matrix6) -> Matrix6 {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

pub(crate) fn multiply(a: &Matrix6, b: &Matrix6) -> Matrix6 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Rᵋ with ε(ply) = Rᵋ ε(global); σ(global) = Rᵋᵀ σ(ply), because work is the same in both frames.
pub fn strain_rotation(angle: f64) -> Matrix6 {
    let (s, c) = exact_sin_cos(angle);
    [
        [c * c, s * s, 0.0, s * c, 0.0, 0.0],
        [s * s, c * c, 0.0, -s * c, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        [-2.0 * s * c, 2.0 * s * c, 0.0, c * c - s * s, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, c, -s],
        [0.0, 0.0, 0.0, 0.0, s, c],
    ]
}

/// Stiffness of a ply at `angle` in the plate's frame: C(global) = Rᵋᵀ C(ply) Rᵋ.
pub fn rotate_stiffness(c_ply: &Matrix6, angle: f64) -> Matrix6 {
    let r = strain_rotation(angle);
    let c = multiply(&transpose(&r), &multiply(c_ply, &r));
    // Rounding must not make a symmetric tensor unsymmetric.
    std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (c[i][j] + c[j][i])))
}

/// Multiples of 90° give exact zeros, so that cross-ply laminates stay specially orthotropic to the last bit.
fn exact_sin_cos(angle: f64) -> (f64, f64) {
    let quarter = angle / std::f64::consts::FRAC_PI_2;
    let nearest = quarter.round();
    if (quarter - nearest).abs() < 1e-14 {
        match nearest.rem_euclid(4.0) as i32 {
            0 => (0.0, 1.0),
            1 => (1.0, 0.0),
            2 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        }
    } else {
        angle.sin_cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_the_same_in_both_frames() {
        let e = Strain6::<Global>::new([1.0, -2.0, 0.5, 0.3, 0.7, -0.4]);
        let c: Matrix6 = std::array::from_fn(|i| {
            std::array::from_fn(|j| if i == j { 5.0 + i as f64 } else { 1.0 / (1 + i + j) as f64 })
        });
        for angle in [0.3_f64, 1.2, -0.7, std::f64::consts::FRAC_PI_2] {
            let ply = e.to_ply(angle);
            let s = stress(&c, &ply);
            let global = stress(&rotate_stiffness(&c, angle), &e);
            for (a, b) in s.to_global(angle).0.iter().zip(global.0) {
                assert!((a - b).abs() < 1e-13, "{a} {b}");
            }
        }
    }

    #[test]
    fn right_angles_are_exact() {
        let r = strain_rotation(90.0_f64.to_radians());
        assert_eq!(r[0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(r[3][3], -1.0);
    }
}
