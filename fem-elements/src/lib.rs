//! Elements: one file each, all implementing [`Element`](fem_core::element::Element).
//!
//! [`HermitePrism`] is the solid element of AFWAL-TR-87-4117, [`HermiteWedge`] its form on triangles, [`HermiteHex`] its quick form
//! for parallelograms, [`WebsterBeam`] the section of a strip; [`hermite`] holds the polynomials that their family is made of.
//!
//! A uniform stretch stores the energy of its strain, whatever the number of plies:
//!
//! ```
//! use fem_core::element::{Cell, Element, Scratch, Slice, Stack};
//! use fem_core::material::Elastic;
//! use fem_elements::{HermitePrism, Mass};
//!
//! let element = HermitePrism::new(Mass::Cubic, HermitePrism::IN_PLANE_ORDER)?;
//! let c = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9).stiffness();
//! let slice = |q| Slice { q, c, density: 1575.0, free: [0.0; 6] };
//! let stack = Stack::new(vec![slice([-1.0, 0.2]), slice([0.2, 1.0])]);
//! // A cube of 1 mm.
//! let corners = [[0.0, 0.0], [1e-3, 0.0], [1e-3, 1e-3], [0.0, 1e-3]];
//! let cell = Cell { corners: corners.into(), z: [0.0, 1e-3], stack: &stack };
//!
//! let n = element.info().ndof();
//! let mut k = vec![0.0; n * n];
//! element.stiffness(&cell, &mut Scratch::default(), &mut k)?;
//!
//! // u = e x along x: U10 = e x and U11 = e at every node.
//! let e = 1e-3;
//! let mut u = vec![0.0; n];
//! for (u, node) in u.chunks_exact_mut(element.info().dofs.len()).zip(element.info().nodes) {
//!     (u[0], u[1]) = (e * cell.position(*node)[0], e);
//! }
//! let energy: f64 = (0..n * n).map(|i| 0.5 * u[i / n] * k[i] * u[i % n]).sum();
//! let expected = 0.5 * c[0][0] * e * e * 1e-9;
//! assert!((energy / expected - 1.0).abs() < 1e-12);
//! # Ok::<(), fem_core::element::ElementError>(())
//! ```

pub mod hermite;
mod hermite_hex;
mod hermite_prism;
mod hermite_solid;
mod hermite_wedge;
mod hex20;
mod lamination;
mod large;
mod mitc4;
mod prism;
mod serendipity;
mod transverse;
mod webster_beam;
mod wedge15;

pub use hermite_hex::HermiteHex;
pub use hermite_prism::HermitePrism;
pub use hermite_solid::{HermiteSolid, Mass};
pub use hermite_wedge::HermiteWedge;
pub use hex20::Hex20;
pub use mitc4::Mitc4;
pub use transverse::TransverseStresses;
pub use webster_beam::{PlaneState, WebsterBeam};
pub use wedge15::Wedge15;
