//! Memory: what a computation takes at its peak, and what there is.

use crate::error::Error;
use crate::model::{Model, Plan};
use fem_core::assembly::{FactorError, Pattern, Symbolic};
use fem_core::plate::Plate;
use fem_core::plugin::{Params, Value};
use std::fmt;
use std::sync::Arc;
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

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
pub struct Estimate {
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
impl fmt::Display for Estimate {
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
        let parts: Vec<_> = parts.map(|(name, bytes)| format!("{name} {}", size(*bytes))).collect();
        f.write_str(&parts.join(", "))
    }
}

impl Estimate {
    /// Of `model`, whose matrices have this pattern; from counts alone.
    fn new(model: &Model, symbolic: &Symbolic) -> Self {
        let (n, all) = (symbolic.pattern().ndof() as f64, model.plate.ndof() as f64);
        let entries = symbolic.pattern().rows.len() as f64;
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
pub(crate) fn analysed(model: &Model, pattern: Arc<Pattern>) -> Result<(Symbolic, Estimate), Error> {
    let symbolic = Symbolic::new(pattern).map_err(|error| match error {
        FactorError::NoRoom { bytes } => refused(bytes, "the factor alone, of which this is a part".into()),
        other => other.into(),
    })?;
    let estimate = Estimate::new(model, &symbolic);
    check(estimate.bytes(), || estimate.to_string())?;
    Ok((symbolic, estimate))
}

/// Vectors of a reduction: the largest count among its parameters.
pub(crate) fn vectors(params: &Params) -> usize {
    let counts = params.keys().filter_map(|key| match params.get(key) {
        Some(Value::Number(n)) if *n >= 1.0 => Some(*n as usize),
        _ => None,
    });
    counts.max().unwrap_or(VECTORS)
}

/// Refuses a plate of which the matrices alone would be more than there is: before anything is made that grows with them.
pub(crate) fn check_plate(plate: &Plate) -> Result<(), Error> {
    let kept = plate.kept_cells().count() as f64 / plate.cells() as f64;
    let unknowns = plate.ndof() as f64 * kept;
    // Those of a cell lie in 4 columns and on 2 levels. One unknown meets those of 9 columns on its own and both adjacent
    // levels, and half of these entries are stored.
    let layers = plate.layers() as f64;
    let levels = (3.0 * layers + 1.0) / (layers + 1.0);
    let entries = unknowns * plate.info().ndof() as f64 * 9.0 / 4.0 * levels / 2.0 / 2.0;
    check(24.0 * entries, || format!("its stiffness has about {entries:.1e} entries"))
}

fn check(needed: f64, parts: impl Fn() -> String) -> Result<(), Error> {
    // What the process holds already is part of what is needed.
    let held = crate::cost::status("VmRSS").unwrap_or(0);
    let fits = available().is_none_or(|available| needed <= (available + held) as f64);
    if fits { Ok(()) } else { Err(refused(needed, parts())) }
}

fn refused(needed: f64, parts: String) -> Error {
    let available = available().map_or("less".into(), |bytes| size(bytes as f64));
    Error::Memory { needed: size(needed), available, parts }
}

/// Memory that the process can still be given, bytes: of the machine, of its control group, of its limit on addresses,
/// whichever is least. `None` where the system does not tell.
fn available() -> Option<u64> {
    let memory = RefreshKind::nothing().with_memory(MemoryRefreshKind::everything());
    let system = System::new_with_specifics(memory);
    let machine = Some(system.available_memory()).filter(|bytes| *bytes > 0).map(|bytes| bytes + system.free_swap());
    // What a group keeps of files it gives back when asked, and is not counted.
    let group = system.cgroup_limits().map(|limits| limits.total_memory.saturating_sub(limits.rss));
    [machine, group, addresses()].into_iter().flatten().min()
}

/// What `ulimit -v` leaves.
#[cfg(target_os = "linux")]
fn addresses() -> Option<u64> {
    let limit = rlimit::Resource::AS.get_soft().ok().filter(|limit| *limit != rlimit::INFINITY)?;
    Some(limit.saturating_sub(crate::cost::status("VmSize")?))
}

#[cfg(not(target_os = "linux"))]
fn addresses() -> Option<u64> {
    None
}

/// `bytes` for people.
fn size(bytes: f64) -> String {
    if bytes < 1e9 { format!("{:.0} MB", bytes * 1e-6) } else { format!("{:.1} GB", bytes * 1e-9) }
}
