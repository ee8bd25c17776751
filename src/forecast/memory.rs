//! Memory: what a computation takes at its peak.

use crate::cost::{refuse, require};
use crate::error::Error;
use crate::words::describe_bytes;
use fem_core::assembly::{FactorError, Pattern, Symbolic};
use std::fmt;
use std::sync::Arc;

// Measured on plates of 6000 to 47 000 unknowns; a row of `docs/stability.md` holds them against what runs take.
/// The program and the smallest of models, bytes.
const PROGRAM: f64 = 2e7;
/// Pattern, K, M, and M without its zeros, bytes per entry of the pattern.
const PER_ENTRY: f64 = 32.0;
/// Another pattern and one matrix on it, bytes per entry.
const PER_FACTORISED: f64 = 16.0;

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
    /// What effects need beside.
    pub effects: f64,
    /// Histories: what a march keeps of its steps, rows and samples.
    pub histories: f64,
    /// Stresses where criteria look: those of samples and what is kept of them, and what the operator that makes them takes beyond
    /// the factor, which is gone by then.
    pub stresses: f64,
}

/// Sizes of the parts for people, largest first.
impl fmt::Display for MemoryEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { model, matrices, factor, vectors, effects, histories, stresses } = *self;
        let mut parts = [
            ("model", model),
            ("stiffness and mass", matrices),
            ("factor", factor),
            ("vectors", vectors),
            ("effects", effects),
            ("histories", histories),
            ("stresses", stresses),
        ];
        parts.sort_by(|a, b| b.1.total_cmp(&a.1));
        let parts = parts.iter().filter(|(_, bytes)| *bytes > 0.0);
        let parts: Vec<_> = parts.map(|(name, bytes)| format!("{name} {}", describe_bytes(*bytes))).collect();
        f.write_str(&parts.join(", "))
    }
}

/// What a computation is, as far as its memory hangs on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Unknowns before the elimination of constraints.
    pub all: usize,
    /// Independent unknowns that are assembled.
    pub unknowns: usize,
    /// Vectors over these.
    pub vectors: usize,
    /// Vectors among them that are there for the sake of springs that let go.
    pub answers: usize,
    /// Contacts, where a reduced plate is marched.
    pub contacts: Option<usize>,
    /// What a march keeps of its steps, rows and samples, bytes.
    pub kept: f64,
    /// Places whose stresses are judged.
    pub sites: usize,
    /// Indices of all of them.
    pub indices: usize,
}

impl Demand {
    /// A basis, and what it is made from.
    pub const BASES: f64 = 3.0;
    /// Mesh and constraints, bytes per unknown.
    pub const PER_UNKNOWN: f64 = 200.0;
    /// Samples of the stresses that are recovered together.
    pub const BATCH: usize = 16;
    /// Largest stress operator that is kept, bytes; beyond it stresses are recovered from expanded displacements.
    pub const OPERATOR_LIMIT: usize = 256 << 20;
    /// Of a stress, bytes.
    const STRESS: usize = 6 * size_of::<f64>();
    /// What a scan keeps per site and per index, bytes.
    const PER_SITE: usize = 3 * Self::STRESS;
    const PER_INDEX: usize = 4 * size_of::<f64>();

    /// Stresses of samples with what is kept of them, and the operator while it is made, bytes. Either comes from as many
    /// strains.
    fn stresses(&self) -> [f64; 2] {
        let samples = self.sites * Self::BATCH * Self::STRESS;
        let kept = self.sites * Self::PER_SITE + self.indices * Self::PER_INDEX;
        let operator = self.sites * Self::STRESS * self.vectors;
        let [samples, operator] = match self.contacts.is_some() && operator <= Self::OPERATOR_LIMIT {
            true => [samples, 2 * operator],
            false => [2 * samples, 0],
        };
        [(samples + kept) as f64, operator as f64]
    }
}

impl MemoryEstimate {
    /// Of a computation with these matrices, and what effects take beside.
    fn new(demand: &Demand, symbolic: &Symbolic, effects: f64) -> Self {
        let entries = symbolic.pattern().entries() as f64;
        let [tables, operator] = demand.stresses();
        Self {
            model: PROGRAM + Demand::PER_UNKNOWN * demand.all as f64,
            matrices: PER_ENTRY * entries,
            factor: symbolic.bytes(),
            vectors: 8.0 * Demand::BASES * demand.vectors as f64 * demand.unknowns as f64,
            effects,
            histories: demand.kept,
            stresses: tables + (operator - symbolic.bytes()).max(0.0),
        }
    }

    /// All of it.
    pub fn bytes(&self) -> f64 {
        self.model + self.matrices + self.factor + self.vectors + self.effects + self.histories + self.stresses
    }
}

/// The analysis of `pattern`, and what a computation with it takes, of which `effects` is beside; `joined` is factorised in its place, if
/// it is given.
///
/// # Errors
/// More memory than there is.
pub(crate) fn analyse(
    pattern: Arc<Pattern>,
    demand: &Demand,
    effects: f64,
    joined: Option<Arc<Pattern>>,
) -> Result<(Symbolic, MemoryEstimate), Error> {
    let analysed = |pattern| {
        Symbolic::new(pattern).map_err(|error| match error {
            FactorError::NoRoom { bytes } => refuse(bytes, "the factor alone, of which this is a part".into()),
            other => other.into(),
        })
    };
    let symbolic = analysed(pattern)?;
    let mut estimate = MemoryEstimate::new(demand, &symbolic, effects);
    if let Some(joined) = joined {
        estimate.matrices += PER_FACTORISED * joined.entries() as f64;
        estimate.factor = analysed(joined)?.bytes();
    }
    require(estimate.bytes(), || estimate.to_string())?;
    Ok((symbolic, estimate))
}
