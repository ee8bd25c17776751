//! A rational Krylov space as reduction: a plug-in in one file.
//!
//! What to look at: a reduction only chooses the columns of a basis. It sees the structure through products and solves, and the
//! contacts as functionals; projection, modes and the way back are common to all reductions.
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::reduction::{Functional, Reduction, ReductionError};
use fem_core::structure::Structure;
use std::f64::consts::TAU;
use std::iter::once;

/// Responses to contact forces that grow as e^(st) at several rates s, and to those at rest.
///
/// ```text
/// T = [(K + s₁² M)⁻¹ P, (K + s₂² M)⁻¹ P, …, K⁻¹ P]      s = 2π f, f from `fastest` down to `slowest`, evenly by ratio
/// ```
///
/// The dynamic flexibility Pᵀ (K + s² M)⁻¹ P of the reduced structure is then exact at every s of these, its derivative too, and
/// with s = 0 the static flexibility at the contacts. A fast rate sees what is near the contact, a slow one the whole plate.
///
/// Every rate costs a factorisation, where Krylov vectors cost a solve, and none waits for the one before it.
#[derive(Debug, Clone)]
pub struct RationalKrylov {
    /// Vectors per contact.
    vectors: usize,
    /// Frequencies that stand for the slowest and the fastest rate, Hz.
    slowest: f64,
    fastest: f64,
}

/// Each is a factorisation.
const MOST: usize = 200;

// ANCHOR: basis
impl RationalKrylov {
    /// Squares of the rates, the fastest first.
    fn squares(&self) -> impl Iterator<Item = f64> + '_ {
        let rates = self.vectors - 1;
        let ratio = self.slowest / self.fastest;
        let share = move |i: usize| i as f64 / rates.saturating_sub(1).max(1) as f64;
        (0..rates).map(move |i| (TAU * self.fastest * ratio.powf(share(i))).powi(2))
    }
}

impl Reduction for RationalKrylov {
    fn basis(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        _candidates: &[usize],
    ) -> Result<Vec<f64>, ReductionError> {
        let n = structure.ndof();
        let mut loads = vec![0.0; n * keep.len()];
        for (contact, load) in keep.iter().zip(loads.chunks_exact_mut(n.max(1))) {
            contact.add_to(1.0, load);
        }
        let mut basis = Vec::new();
        // Rest comes last: its factor is kept, and others ask for it.
        for square in self.squares().chain(once(0.0)) {
            let mut responses = loads.clone();
            structure.solve_shifted(square, &mut responses, keep.len()).map_err(|e| ReductionError(e.0))?;
            basis.extend(responses);
        }
        Ok(basis)
    }
}
// ANCHOR_END: basis

// ANCHOR: plugin
impl Plugin for RationalKrylov {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Reduction,
        name: "rational-krylov",
        summary: "responses to contact forces that grow at several rates; exact static flexibility at the contact",
        source: "Gallivan, Grimme and Van Dooren, Numer. Algorithms 12 (1996) 33",
        params: &[
            ParamInfo { name: "vectors", doc: "vectors per contact, 1 to 200, default 16" },
            ParamInfo { name: "slowest", doc: "frequency that stands for the slowest rate, Hz" },
            ParamInfo { name: "fastest", doc: "frequency that stands for the fastest rate, Hz" },
        ],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let vectors = params.count("vectors", 1, Some(16))?;
        if vectors > MOST {
            return Err(ParamError::new("vectors", format!("must not exceed {MOST}, got {vectors}")));
        }
        let slowest = params.positive("slowest", Dimension::FREQUENCY, None)?;
        let fastest = params.positive("fastest", Dimension::FREQUENCY, None)?;
        if fastest <= slowest {
            return Err(ParamError::new("fastest", format!("must lie above `slowest`, {slowest} Hz, got {fastest} Hz")));
        }
        Ok(Built::Reduction(Box::new(Self { vectors, slowest, fastest })))
    }
}
// ANCHOR_END: plugin
