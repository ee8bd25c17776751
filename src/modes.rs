//! Natural frequencies.

use crate::cost::{Cost, Phase, Stopwatch};
use crate::error::Error;
use crate::model::Model;
use crate::run::{self, Substructures};
use crate::summary::{and, in_words};
use fem_core::assembly::{Matrix, assemble, pattern};
use fem_core::counters::Counters;
use fem_core::structure::Structure;
use fem_dynamics::modes::{self, Modes};
use fem_io::files::OutputDir;
use fem_io::tables::{self, Field};
use serde::Serialize;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::num::NonZeroUsize;

/// The lowest modes of a model and what finding them cost.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Frequencies, and shapes over the independent unknowns.
    pub modes: Modes,
    /// Mass that moves with each mode along x, y and z, kg: (φᵀ M r)² for unit modal mass.
    pub effective_masses: Vec<[f64; 3]>,
    /// Independent unknowns.
    pub unknowns: usize,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// How the plate is divided, if it is.
    pub substructures: Option<Substructures>,
    /// Work done.
    pub counters: Counters,
    /// Time per phase.
    pub phases: Vec<Phase>,
}

/// Finds the `count` lowest modes.
///
/// # Errors
/// A cell that the element refuses, a matrix that cannot be factorised, modes that do not converge.
pub fn solve(model: &Model, count: usize, threads: NonZeroUsize) -> Result<Solution, Error> {
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let mut assembled = run::structure(model, true, threads, &mut counters)?;
    stopwatch.lap("assemble");
    let mut modes = modes::lowest(&mut assembled.structure, count, model.held)?;
    (counters.factorisations, counters.solves) = assembled.structure.work();
    modes.shapes = assembled.expand(modes.shapes);
    let n = model.constraints.ndof();
    // Substructures that are condensed have forgotten how their mass is spread.
    let whole = match &assembled.condensation {
        None => None,
        Some(_) => {
            let Model { plate, element, constraints, .. } = model;
            let pattern = pattern(plate, constraints);
            let m = assemble(plate, &**element, constraints, &pattern, Matrix::Mass, threads, &mut counters)?;
            Some((pattern, m))
        }
    };
    let mut momenta = [0, 1, 2].map(|_| vec![0.0; n]);
    // Symmetric modes have no net motion across a mirror, or off the axis of a half-turn.
    let open = |axis: usize| model.plate.symmetry().operations().all(|o| o.keeps_axis(axis));
    for (axis, momentum) in momenta.iter_mut().enumerate().filter(|(axis, _)| open(*axis)) {
        let moves = |i: usize| {
            let dof = model.plate.locate(model.constraints.original(i)).2;
            f64::from(u8::from(dof.m() == 0 && dof.n() == axis + 1))
        };
        let moves: Vec<f64> = (0..n).map(moves).collect();
        match &whole {
            None => assembled.structure.add_mass(1.0, &moves, momentum),
            Some((pattern, m)) => pattern.add_product(m, 1.0, &moves, momentum),
        }
    }
    let mass = |shape: &[f64], m: &[f64]| shape.iter().zip(m).map(|(a, b)| a * b).sum::<f64>().powi(2);
    let effective_masses = modes.shapes.chunks_exact(n.max(1)).map(|s| [0, 1, 2].map(|d| mass(s, &momenta[d])));
    let effective_masses = effective_masses.collect();
    stopwatch.lap("modes");
    let (substructures, phases) = (assembled.substructures(), stopwatch.phases().to_vec());
    let factor_entries = assembled.factor_entries;
    Ok(Solution { modes, effective_masses, unknowns: n, factor_entries, substructures, counters, phases })
}

/// The summary of a modal analysis; units are in the key names.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct Summary {
    pub title: String,
    pub version: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<&'static str>,
    pub unknowns: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub substructures: Option<Substructures>,
    pub held: bool,
    pub frequencies_Hz: Vec<f64>,
    pub effective_masses_kg: Vec<[f64; 3]>,
    pub elements: u64,
    pub elements_reused: u64,
    pub solves: u64,
    pub warnings: Vec<String>,
}

impl Summary {
    /// Sums up a modal analysis.
    pub fn new(model: &Model, solution: &Solution) -> Self {
        Self {
            title: model.scene.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            symmetry: model.plate.symmetry().name(),
            unknowns: solution.unknowns,
            substructures: solution.substructures,
            held: model.held,
            frequencies_Hz: solution.modes.omega.iter().map(|w| w / TAU).collect(),
            effective_masses_kg: solution.effective_masses.clone(),
            elements: solution.counters.elements,
            elements_reused: solution.counters.elements_reused,
            solves: solution.counters.solves,
            warnings: model.warnings.clone(),
        }
    }

    /// The summary as people read it.
    pub fn text(&self, cost: &Cost) -> String {
        let alone = if self.symmetry.is_some() { ": its symmetric modes alone" } else { "" };
        let symmetry = in_words(self.symmetry);
        let divided = and(self.substructures);
        let mut t = format!("{}\n  model     {} unknowns{divided}{symmetry}{alone}\n", self.title, self.unknowns);
        t.push_str("  mode   frequency (Hz)   mass along x, y, z (g)\n");
        for (i, (f, m)) in self.frequencies_Hz.iter().zip(&self.effective_masses_kg).enumerate() {
            let [x, y, z] = m.map(|m| m * 1e3);
            let _ = writeln!(t, "  {:>4}   {f:>14.4}   {x:.4}, {y:.4}, {z:.4}", i + 1);
        }
        let Self { elements, elements_reused, solves, .. } = self;
        let _ = writeln!(t, "  work      {elements} element matrices, {elements_reused} reused, {solves} solves");
        let _ = writeln!(t, "  time      {cost}");
        self.warnings.iter().for_each(|w| t.push_str(&format!("  warning   {w}\n")));
        t
    }
}

/// Writes `summary.json` and `modes.csv`.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub fn write(dir: &OutputDir, solution: &Solution, summary: &Summary) -> Result<(), Error> {
    tables::write_json(dir, "summary.json", summary)?;
    let header =
        ["mode", "frequency_Hz", "omega_rad_s", "effective_mass_x_kg", "effective_mass_y_kg", "effective_mass_z_kg"];
    let row = |(i, (omega, mass)): (usize, (&f64, &[f64; 3]))| {
        let numbers = [omega / TAU, *omega].into_iter().chain(*mass).map(Field::Number);
        [Field::Count(i as u64 + 1)].into_iter().chain(numbers).collect()
    };
    let each = solution.modes.omega.iter().zip(&solution.effective_masses).enumerate();
    tables::write_columns(dir, "modes.csv", &header, each.map(row))?;
    Ok(())
}
