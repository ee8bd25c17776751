//! What a run will cost, from its sizes.
//!
//! Seconds of a phase are a rate times its nominal seconds: those that its work takes on the machine of
//! `docs/performance.md`. Nominal seconds are the same everywhere, so that what is decided by them is decided equally from
//! run to run; a study measures rates by its runs as they come in.

use super::Size;
use crate::cost::{Better, Phase};

/// Parts of a run: their times grow with different work.
pub const PHASES: [&str; 5] = ["assemble", "solve", "stresses", "march", "scan"];

/// Entries of a factor, GFLOP that make it, and the exponent between the two (cells of two layers, 30 000 to 300 000
/// unknowns).
const ENTRIES: f64 = 24e6;
const GFLOP: f64 = 18.0;
const GROWTH: f64 = 1.32;
/// GFLOP a second of a factorisation, with what belongs to it.
const FACTOR: f64 = 13.0;
/// Seconds per entry of a factor and right-hand side, many of these together, and one alone.
const SOLVE: f64 = 0.7e-9;
const SOLVE_ALONE: f64 = 1.0e-9;
/// Seconds per unknown and pair of vectors of a basis.
const ORTHOGONALISE: f64 = 0.6e-9;
/// Seconds of an element's matrices, and of adding those of a cell to the whole.
const ELEMENT: f64 = 1.2e-4;
const CELL: f64 = 5e-5;
/// Seconds per site of the stresses of one mode.
const RECOVER: f64 = 5.5e-7;
/// Seconds of a step, and per mode.
const STEP: f64 = 0.4e-6;
const MODE: f64 = 1.5e-8;
/// Seconds per site and sample, and per mode of these.
const JUDGE: f64 = 8e-8;
const COMBINE: f64 = 2e-9;
/// Growth of the entries of a factor with the columns of nodes.
pub(crate) const FILL: f64 = 1.2;

/// Nominal seconds per phase.
pub fn nominal(size: &Size) -> [f64; PHASES.len()] {
    let (entries, modes, n) = (size.factor_entries as f64, size.marched as f64, size.unknowns as f64);
    let factor = |entries: f64| GFLOP / FACTOR * (entries / ENTRIES).powf(GROWTH);
    let (sites, steps, samples) = (size.sites as f64, size.work.steps as f64, size.samples as f64);
    let marched = size.reduced || size.marched == 0;
    let solves = if marched { size.work.solves as f64 } else { 0.0 };
    let basis = if size.reduced { solves * SOLVE * entries + modes * modes * n * ORTHOGONALISE } else { 0.0 };
    let step = if marched { STEP + MODE * modes } else { entries * SOLVE_ALONE };
    let stresses = if size.reduced { modes } else { 1.0 };
    [
        size.work.elements as f64 * ELEMENT + size.cells as f64 * CELL,
        factor(entries) + basis,
        sites * stresses * RECOVER,
        steps * step,
        samples * sites * (JUDGE + COMBINE * if size.reduced { modes } else { 100.0 }),
    ]
}

/// What a setting one level finer than that of a run of `size`, which took `seconds` per phase, would cost in addition.
pub fn one_level_better(size: &Size, seconds: [f64; PHASES.len()]) -> Vec<Better> {
    let now = nominal(size);
    let more = |what: &'static str, finer: Size| {
        let each = nominal(&finer).into_iter().zip(now).zip(seconds);
        let more = each.map(|((then, now), s)| if now > 0.0 { s * (then / now - 1.0) } else { 0.0 });
        Better { what, more_cpu_s: more.sum() }
    };
    let with = |cells: f64, columns: f64, per_column: f64| {
        let times = |n: usize, by: f64| (n as f64 * by) as usize;
        let mut finer = Size {
            cells: times(size.cells, cells),
            unknowns: times(size.unknowns, columns * per_column),
            factor_entries: times(size.factor_entries, columns.powf(FILL) * per_column.powi(2)),
            sites: times(size.sites, columns),
            ..*size
        };
        finer.work.elements = (size.work.elements as f64 * cells) as u64;
        if !size.reduced && size.marched > 0 {
            finer.marched = finer.unknowns;
        }
        finer
    };
    let mut all = Vec::new();
    if size.work.steps > 0 {
        let mut finer = *size;
        finer.work.steps *= 2;
        all.push(more("half the step", finer));
    }
    if size.reduced {
        let mut finer = Size { marched: 2 * size.marched, ..*size };
        finer.work.solves *= 2;
        all.push(more("twice the vectors", finer));
    }
    all.push(more("cells of half the edge", with(4.0, 4.0, 1.0)));
    let levels = (2 * size.layers + 1) as f64 / (size.layers + 1) as f64;
    all.push(more("twice the layers", with(2.0, 1.0, levels)));
    all
}

/// Seconds per [`PHASES`] of what a run calls its phases.
pub fn seconds_per_phase(phases: &[Phase]) -> [f64; PHASES.len()] {
    let mut seconds = [0.0; PHASES.len()];
    for phase in phases {
        let place = match phase.name {
            "assemble" => 0,
            "reduce" | "solve" | "modes" | "accuracy" => 1,
            "prepare stresses" | "stresses" => 2,
            "march" => 3,
            _ => 4,
        };
        seconds[place] += phase.cpu_s;
    }
    seconds
}
