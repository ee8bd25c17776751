//! Failure criteria of laminated composites and the scan for first damage.
//!
//! One file per criterion; each is a pure function of the stress in a ply's own axes, returns one index per failure
//! mode (1 at failure, 0 where the mode does not apply) and a reserve factor, and introduces itself through
//! [`Plugin::INFO`](fem_core::plugin::Plugin::INFO). [`scan::Scan`] follows any number of them through a run.
//!
//! Indices are of different degrees in the stress (1 for limits, 2 for quadratic forms, both for some) and must not be
//! compared between criteria; reserve factors may.
//!
//! ```
//! use fem_core::failure::assess;
//! use fem_core::material::{Elastic, Material, Strength, Strengths, Toughnesses};
//! use fem_core::tensor::Stress6;
//! use fem_failure::HashinReport;
//!
//! let tape = Material {
//!     name: "AS4/3502".into(),
//!     elastic: Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9),
//!     density: None,
//!     strengths: Strengths::default()
//!         .with(Strength::Xt, 1793e6)
//!         .with(Strength::Xc, 1724e6)
//!         .with(Strength::Yt, 64e6)
//!         .with(Strength::S12, 109e6)
//!         .with(Strength::S23, 69e6),
//!     toughness: Toughnesses::default(), eta: None,
//!     expansion: None,
//! };
//! // 32 MPa across the fibres, half of what the matrix bears; components are 11 22 33 12 23 31 in ply axes.
//! let found = assess(&HashinReport::default(), "hashin-report", &Stress6::new([0.0, 32e6, 0.0, 0.0, 0.0, 0.0]), &tape)?;
//! assert_eq!(found.indices, [0.0, 0.0, 0.25, 0.0]); // fibre tension, compression; matrix tension, compression
//! assert_eq!(found.reserve.factor, 2.0);
//! # Ok::<(), fem_core::failure::AssessError>(())
//! ```

mod criteria;
pub mod delamination;
pub mod envelope;
pub mod laws;
mod prelude;
pub mod scan;
mod terms;

pub use criteria::{
    BrewerLagace, ChangChang, ChangLessard, ChoiChang, Christensen, Cuntze, Cuntze2d, Expression, ExpressionError,
    FibreFailure, Hashin1980, HashinReport, HashinRotem, Hoffman, Interaction, Larc03, Larc05, MaxStrain, MaxStress,
    MaxStressInterface, Octahedral, OutOfPlane, Product, Puck, Puck2d, QuadraticStress, Transverse, TsaiHill, TsaiWu,
};
