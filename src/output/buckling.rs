//! What an analysis of buckling says and writes.

use crate::analyses::buckling::BucklingSolution;
use crate::cost::Cost;
use crate::error::Error;
use crate::model::Model;
use crate::output::preload::PreloadFigures;
use crate::output::shapes::shapes;
use crate::words::{append_symmetry, warn_of_softness};
use fem_io::files::OutputDir;
use fem_io::plot;
use fem_io::tables::{self, TableValue};
use serde::Serialize;
use std::fmt::Write as _;

/// The summary of an analysis of buckling; units are in the key names.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct BucklingSummary {
    pub title: String,
    pub version: &'static str,
    /// [`fem_io::results::FORMAT`].
    pub format: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<&'static str>,
    pub unknowns: usize,
    #[serde(flatten)]
    pub preload: PreloadFigures,
    /// Factors on the preload, by size; negative where the opposite load buckles the plate.
    pub load_factors: Vec<f64>,
    pub elements: u64,
    pub elements_reused: u64,
    pub solves: u64,
    pub warnings: Vec<String>,
}

impl BucklingSummary {
    /// Sums up an analysis of buckling.
    pub fn new(model: &Model, solution: &BucklingSolution) -> Self {
        Self {
            title: model.origin.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            format: fem_io::results::FORMAT,
            symmetry: model.plate.symmetry().name(),
            unknowns: solution.unknowns,
            preload: PreloadFigures::new(model, None),
            load_factors: solution.buckling.factors.clone(),
            elements: solution.counters.elements,
            elements_reused: solution.counters.elements_reused,
            solves: solution.counters.solves,
            warnings: model.warnings.iter().cloned().chain(solution.softness.map(warn_of_softness)).collect(),
        }
    }

    /// The summary as people read it.
    pub fn text(&self, cost: &Cost) -> String {
        let alone = if self.symmetry.is_some() { ": its symmetric shapes alone" } else { "" };
        let symmetry = append_symmetry(self.symmetry);
        let mut t = format!("{}\n  model     {} unknowns{symmetry}{alone}\n", self.title, self.unknowns);
        self.preload.line().iter().for_each(|line| t.push_str(&format!("{line}\n")));
        t.push_str("  shape     load factor\n");
        for (i, factor) in self.load_factors.iter().enumerate() {
            let opposite = if *factor < 0.0 { "   under the opposite load" } else { "" };
            let _ = writeln!(t, "  {:>4}   {factor:>14.4}{opposite}", i + 1);
        }
        let Self { elements, elements_reused, solves, .. } = self;
        let _ = writeln!(t, "  work      {elements} element matrices, {elements_reused} reused, {solves} solves");
        let _ = writeln!(t, "  time      {cost}");
        self.warnings.iter().for_each(|w| t.push_str(&format!("  warning   {w}\n")));
        t
    }
}

/// Writes `summary.json`, `buckling.csv` and, unless the scene wants no pictures, `buckling_shapes` as SVG and PNG.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub fn write(
    dir: &OutputDir,
    model: &Model,
    solution: &BucklingSolution,
    summary: &BucklingSummary,
) -> Result<(), Error> {
    tables::write_json(dir, "summary.json", summary)?;
    let factors = || solution.buckling.factors.iter().enumerate();
    let row = |(i, factor): (usize, &f64)| vec![TableValue::Count(i as u64 + 1), TableValue::Number(*factor)];
    tables::write_columns(dir, "buckling.csv", &["shape", "load_factor"], factors().map(row))?;
    if model.output.plots && !solution.buckling.factors.is_empty() {
        let titles = factors().map(|(k, factor)| format!("shape {}: load factor {factor:.4}", k + 1));
        plot::map_plot(&shapes(model, &solution.buckling.shapes, titles))?.write(dir, "buckling_shapes")?;
    }
    Ok(())
}
