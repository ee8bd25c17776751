//! What a modal analysis says and writes.

use crate::analyses::assembled::Substructures;
use crate::analyses::modes::ModesSolution;
use crate::cost::Cost;
use crate::error::Error;
use crate::model::Model;
use crate::output::preload::PreloadFigures;
use crate::output::shapes::shapes;
use crate::words::{append, append_symmetry, warn_of_softness};
use fem_core::plugin::Dimension;
use fem_io::files::OutputDir;
use fem_io::plot;
use fem_io::tables::{self, TableValue};
use serde::Serialize;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// The summary of a modal analysis; units are in the key names.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct ModesSummary {
    pub title: String,
    pub version: &'static str,
    /// [`fem_io::results::FORMAT`].
    pub format: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<&'static str>,
    pub unknowns: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub substructures: Option<Substructures>,
    #[serde(flatten)]
    pub preload: PreloadFigures,
    pub held: bool,
    pub frequencies_Hz: Vec<f64>,
    pub effective_masses_kg: Vec<[f64; 3]>,
    pub elements: u64,
    pub elements_reused: u64,
    pub solves: u64,
    pub warnings: Vec<String>,
}

impl ModesSummary {
    /// Sums up a modal analysis.
    pub fn new(model: &Model, solution: &ModesSolution) -> Self {
        Self {
            title: model.origin.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            format: fem_io::results::FORMAT,
            symmetry: model.plate.symmetry().name(),
            unknowns: solution.unknowns,
            substructures: solution.substructures,
            preload: PreloadFigures::new(model, solution.buckling),
            held: model.held,
            frequencies_Hz: solution.modes.omega.iter().map(|w| w / TAU).collect(),
            effective_masses_kg: solution.effective_masses.clone(),
            elements: solution.counters.elements,
            elements_reused: solution.counters.elements_reused,
            solves: solution.counters.solves,
            warnings: model.warnings.iter().cloned().chain(solution.softness.map(warn_of_softness)).collect(),
        }
    }

    /// The summary as people read it.
    pub fn text(&self, cost: &Cost) -> String {
        let alone = if self.symmetry.is_some() { ": its symmetric modes alone" } else { "" };
        let symmetry = append_symmetry(self.symmetry);
        let divided = append(self.substructures);
        let mut t = format!("{}\n  model     {} unknowns{divided}{symmetry}{alone}\n", self.title, self.unknowns);
        self.preload.line().iter().for_each(|line| t.push_str(&format!("{line}\n")));
        t.push_str("  mode        frequency   mass along x, y, z\n");
        let largest = self.effective_masses_kg.iter().flatten().fold(0.0, |most: f64, m| most.max(*m));
        let rounded = |m: &f64| if *m < EXACT * largest { 0.0 } else { *m };
        for (i, (f, m)) in self.frequencies_Hz.iter().zip(&self.effective_masses_kg).enumerate() {
            let (frequency, masses) = (Dimension::FREQUENCY.of(*f), Dimension::MASS.list(&m.each_ref().map(rounded)));
            let _ = writeln!(t, "  {:>4}   {frequency:>14}   {masses}", i + 1);
        }
        let Self { elements, elements_reused, solves, .. } = self;
        let _ = writeln!(t, "  work      {elements} element matrices, {elements_reused} reused, {solves} solves");
        let _ = writeln!(t, "  time      {cost}");
        self.warnings.iter().for_each(|w| t.push_str(&format!("  warning   {w}\n")));
        t
    }
}

/// Share of the largest mass below which one is rounding.
const EXACT: f64 = 1e-9;

/// Writes `summary.json`, `modes.csv` and, unless the scene wants no pictures, `mode_shapes` as SVG and PNG.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub fn write(dir: &OutputDir, model: &Model, solution: &ModesSolution, summary: &ModesSummary) -> Result<(), Error> {
    tables::write_json(dir, "summary.json", summary)?;
    let header =
        ["mode", "frequency_Hz", "omega_rad_s", "effective_mass_x_kg", "effective_mass_y_kg", "effective_mass_z_kg"];
    let row = |(i, (omega, mass)): (usize, (&f64, &[f64; 3]))| {
        let numbers = [omega / TAU, *omega].into_iter().chain(*mass).map(TableValue::Number);
        [TableValue::Count(i as u64 + 1)].into_iter().chain(numbers).collect()
    };
    let each = solution.modes.omega.iter().zip(&solution.effective_masses).enumerate();
    tables::write_columns(dir, "modes.csv", &header, each.map(row))?;
    if model.output.plots && !solution.modes.omega.is_empty() {
        let each = solution.modes.omega.iter().enumerate();
        let titles = each.map(|(k, omega)| format!("mode {}: {}", k + 1, Dimension::FREQUENCY.of(omega / TAU)));
        plot::map_plot(&shapes(model, &solution.modes.shapes, titles))?.write(dir, "mode_shapes")?;
    }
    Ok(())
}
