//! Memory: what a computation takes at its peak.

use crate::cost::{refuse, require};
use crate::error::Error;
use crate::model::{Model, Plan};
use crate::words::describe_bytes;
use fem_core::assembly::{FactorError, Pattern, Symbolic};
use fem_core::plugin::{Params, Value};
use std::fmt;
use std::sync::Arc;

/// Vectors of a reduction that does not say how many.
const VECTORS: usize = 60;

// Measured on plates of 6000 to 47 000 unknowns; a row of `docs/stability.md` holds them against what runs take.
/// The program and the smallest of models, bytes.
const PROGRAM: f64 = 2e7;
/// Mesh and constraints, bytes per unknown.
const PER_UNKNOWN: f64 = 200.0;
/// Pattern, K, M, and M without its zeros, bytes per entry of the pattern.
const PER_ENTRY: f64 = 32.0;
/// A basis, and what it is made from.
const BASES: f64 = 3.0;

/// Places of a cell's unknowns, kept under large displacements in lists that have grown, bytes per unknown of a cell.
const PER_PLACE: f64 = 96.0;
/// Of a reduced plate that stiffens, per contact: membrane strains, and forms of these and of its stresses.
const STRAINS: usize = 25;
const FORMS: usize = 40;

/// What a computation holds at its peak, bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemoryEstimate {
    /// Mesh, constraints, and the program.
    pub model: f64,
    /// Stiffness and mass with their pattern.
    pub matrices: f64,
    /// The factor and what its making needs.
    pub factor: f64,
    /// Vectors over all unknowns: the basis of a reduction, displacements.
    pub vectors: f64,
    /// What large displacements need beside.
    pub large: f64,
}

/// Sizes of the parts for people, largest first.
impl fmt::Display for MemoryEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { model, matrices, factor, vectors, large } = *self;
        let mut parts = [
            ("model", model),
            ("stiffness and mass", matrices),
            ("factor", factor),
            ("vectors", vectors),
            ("large displacements", large),
        ];
        parts.sort_by(|a, b| b.1.total_cmp(&a.1));
        let parts = parts.iter().filter(|(_, bytes)| *bytes > 0.0);
        let parts: Vec<_> = parts.map(|(name, bytes)| format!("{name} {}", describe_bytes(*bytes))).collect();
        f.write_str(&parts.join(", "))
    }
}

impl MemoryEstimate {
    /// Of `model`, whose matrices have this pattern; from counts alone.
    fn new(model: &Model, symbolic: &Symbolic) -> Self {
        let (n, all) = (symbolic.pattern().ndof() as f64, model.plate.ndof() as f64);
        let entries = symbolic.pattern().entries() as f64;
        let vectors = match &model.plan {
            Plan::Impact(impact) if impact.reduction.is_some() => vectors(&impact.spec.reduction.params),
            Plan::Modes { count } => 2 * count,
            _ => 2,
        };
        Self {
            model: PROGRAM + PER_UNKNOWN * all,
            matrices: PER_ENTRY * entries,
            factor: symbolic.bytes(),
            vectors: 8.0 * BASES * vectors as f64 * n,
            large: if model.effects.membrane { Self::large(model, n, vectors) } else { 0.0 },
        }
    }

    fn large(model: &Model, n: f64, vectors: usize) -> f64 {
        let plate = &model.plate;
        match &model.plan {
            Plan::Impact(impact) if impact.reduction.is_some() => {
                let [strains, forms] = [STRAINS, FORMS].map(|count| (count * impact.strikes.len()) as f64);
                // Forces and shapes of the strains; they and the modes before the elimination of constraints.
                let fields = BASES * strains * n + (strains + vectors as f64) * plate.ndof() as f64;
                8.0 * (fields + forms * (vectors * vectors) as f64)
            }
            // A copy of mesh and constraints as well.
            _ => {
                PER_PLACE * (plate.kept_cells().count() * plate.info().ndof()) as f64
                    + PER_UNKNOWN * plate.ndof() as f64
            }
        }
    }

    /// All of it.
    pub fn bytes(&self) -> f64 {
        self.model + self.matrices + self.factor + self.vectors + self.large
    }
}

/// The analysis of `pattern`, and what a computation of `model` with it takes.
///
/// # Errors
/// More memory than there is.
pub(crate) fn analysed(model: &Model, pattern: Arc<Pattern>) -> Result<(Symbolic, MemoryEstimate), Error> {
    let symbolic = Symbolic::new(pattern).map_err(|error| match error {
        FactorError::NoRoom { bytes } => refuse(bytes, "the factor alone, of which this is a part".into()),
        other => other.into(),
    })?;
    let estimate = MemoryEstimate::new(model, &symbolic);
    require(estimate.bytes(), || estimate.to_string())?;
    Ok((symbolic, estimate))
}

/// Vectors of a reduction: the largest count among its parameters.
pub(super) fn vectors(params: &Params) -> usize {
    let counts = params.keys().filter_map(|key| match params.get(key) {
        Some(Value::Number(n)) if *n >= 1.0 => Some(*n as usize),
        _ => None,
    });
    counts.max().unwrap_or(VECTORS)
}
