//! Work counters: what a run cost, without a clock.

/// Counts of the expensive operations of a run; equal from run to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Counters {
    /// Element matrices integrated.
    pub elements: u64,
    /// Cells whose matrices were copied from an identical cell.
    pub elements_reused: u64,
    /// Sparse factorisations.
    pub factorisations: u64,
    /// Right-hand sides of sparse back-substitutions.
    pub solves: u64,
    /// Time steps.
    pub steps: u64,
    /// Evaluations of contact laws.
    pub contact_calls: u64,
    /// Iterations of Newton's method in time steps: internal forces of large deflections.
    pub iterations: u64,
    /// Evaluations of criteria, one per stress state and criterion.
    pub criterion_calls: u64,
}
