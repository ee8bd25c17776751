//! What a deck prints: a listing for people, tables for programs.

use super::DeckOutcome;
use super::project::{Matrices, Project};
use super::results::DeckImpact;
use super::units::UnitSystem;
use crate::error::Error;
use fem_core::plugin::Dimension;
use fem_core::tensor::{Matrix6, rotate_stiffness};
use fem_io::deck::{DeckError, Freedom, Generation, Parsed, Program};
use fem_io::plot::{self, Axis, LinePlot, Series};
use fem_io::tables::{self, TableValue};
use std::fmt::Write as _;
use std::path::Path;

/// Speeds of waves along fibres that a solid may have, m/s.
const WAVES: std::ops::Range<f64> = 300.0..30e3;

/// A listing as it grows.
#[derive(Debug)]
pub(super) struct Listing {
    stem: String,
    units: Option<UnitSystem>,
    text: String,
    outcome: DeckOutcome,
    /// Why a march ended early.
    stopped: Option<DeckError>,
}

impl Listing {
    pub(super) fn new(deck: &str, program: Program, parsed: &Parsed, units: Option<UnitSystem>) -> Self {
        let stem =
            Path::new(deck).file_stem().map_or_else(|| "deck".into(), |stem| stem.to_string_lossy().into_owned());
        let (title, analysed) = (parsed.deck.title().to_owned(), parsed.deck.analyses());
        let outcome = DeckOutcome {
            title,
            analysed,
            warnings: parsed.warnings.clone(),
            counts: Vec::new(),
            energy_error: None,
            impact: None,
            files: Vec::new(),
        };
        let mut listing = Self { stem, units, text: String::new(), outcome, stopped: None };
        listing.line(&format!("{program}   {}", listing.outcome.title));
        listing.line(if analysed { "" } else { "data check only" });
        listing
    }

    pub(super) fn line(&mut self, line: &str) {
        self.text.push_str(line.trim_end());
        self.text.push('\n');
    }

    /// The deck's name without folder and ending.
    pub(super) fn stem(&self) -> &str {
        &self.stem
    }

    pub(super) fn units(&self) -> Option<UnitSystem> {
        self.units
    }

    pub(super) fn warnings(&self) -> &[String] {
        &self.outcome.warnings
    }

    /// Takes what came of an impact.
    pub(super) fn found(&mut self, impact: DeckImpact) {
        self.outcome.files.push(format!("{}/", self.stem));
        self.outcome.impact = Some(impact);
    }

    /// The largest change of the energy, relative to that of the impact, and why the march ended early, if it did.
    pub(super) fn marched(&mut self, energy_error: f64, stopped: Option<DeckError>) {
        self.line(&format!("\nchange of the energy, of that of the impact {energy_error:.3e}"));
        if let Some(why) = &stopped {
            self.line(&format!("\n{why}"));
        }
        self.outcome.energy_error = Some(energy_error);
        self.stopped = stopped;
    }

    pub(super) fn warn(&mut self, text: String) {
        self.outcome.warnings.push(text);
    }

    /// A number that is printed, and part of the outcome.
    pub(super) fn count(&mut self, name: &'static str, value: usize) {
        self.line(&format!("{name:<24}{value:>10}"));
        self.outcome.counts.push((name, value));
    }

    /// A unit in brackets, where units are known; `[force, length]` exponents.
    pub(super) fn unit(&self, [force, length]: [i32; 2]) -> String {
        let Some([f, l]) = self.units.map(UnitSystem::names) else { return String::new() };
        match (force, length) {
            (0, 1) => format!(" ({l})"),
            (1, 0) => format!(" ({f})"),
            (1, -2) => format!(" ({f}/{l}^2)"),
            _ => String::new(),
        }
    }

    /// Materials, geometry, the cross reference of a piece.
    pub(super) fn generation(&mut self, deck: &Generation) {
        self.check_density(deck);
        self.count("nodes", deck.freedom.nodes.len());
        self.count("elements", deck.piece.elements.len());
        self.totals(&deck.freedom, "masters", "slaves");
        if deck.print_materials {
            self.materials(deck);
        }
        self.cross_reference(&deck.freedom, "master", "slave");
    }

    /// Counts of degrees of freedom.
    pub(super) fn totals(&mut self, freedom: &Freedom, kept: &'static str, others: &'static str) {
        let (all, bound) = (freedom.ndof(), freedom.relations.len());
        self.count("degrees of freedom", all);
        self.count(kept, freedom.kept.len());
        self.count(others, all - bound - freedom.kept.len());
        self.count("constrained", bound);
    }

    /// √(E1/RHO) tells a mass density from a weight density, where units are known.
    fn check_density(&mut self, deck: &Generation) {
        let Some(units) = self.units else { return };
        for material in &deck.laminate.materials {
            let speed = (material.elastic.e1 / material.density.unwrap_or(f64::NAN)).sqrt() * units.metres();
            if !WAVES.contains(&speed) {
                self.warn(format!(
                    "waves run along the fibres of `{}` at {}: RHO is a mass density, force time^2 / length^4, and \
                     looks like a weight density",
                    material.name,
                    Dimension::VELOCITY.of(speed)
                ));
            }
        }
    }

    fn materials(&mut self, deck: &Generation) {
        let unit = self.unit([1, -2]);
        for material in &deck.laminate.materials {
            self.line(&format!("\nstiffness{unit} of {} in its own axes, 11 22 33 12 23 31", material.name));
            self.matrix(&material.elastic.stiffness());
        }
        for (i, ply) in deck.laminate.plies.iter().enumerate() {
            let material = &deck.laminate.materials[ply.material];
            self.line(&format!(
                "\nstiffness{unit} of ply {} ({} at {} degrees), xx yy zz xy yz zx",
                i + 1,
                material.name,
                ply.angle_deg
            ));
            self.matrix(&rotate_stiffness(&material.elastic.stiffness(), ply.angle));
        }
    }

    fn matrix(&mut self, c: &Matrix6) {
        for row in c {
            let row: String = row.iter().fold(String::new(), |mut line, value| {
                let _ = write!(line, "{value:>14.5e}");
                line
            });
            self.line(&row);
        }
    }

    /// Index, node and direction: what is kept, the others by node and direction, then what is constrained.
    pub(super) fn cross_reference(&mut self, freedom: &Freedom, kept: &str, other: &str) {
        let mut bound = vec![false; freedom.ndof()];
        freedom.relations.iter().for_each(|relation| bound[relation.dof] = true);
        let mut taken = bound.clone();
        freedom.kept.iter().for_each(|dof| taken[*dof] = true);
        let others = (0..freedom.ndof()).filter(|dof| !taken[*dof]);
        let constrained = (0..freedom.ndof()).filter(|dof| bound[*dof]);
        let kinds = freedom.kept.iter().map(|dof| (kept, *dof)).chain(others.map(|dof| (other, dof)));
        let lines: Vec<String> = kinds
            .chain(constrained.map(|dof| ("constrained", dof)))
            .enumerate()
            .map(|(i, (kind, dof))| format!("{:>8}   {:<16}{kind}", i + 1, freedom.name(dof)))
            .collect();
        self.line("\n   index   node and DIR");
        lines.iter().for_each(|line| self.line(line));
    }

    /// The lower triangles of K̂ and M̂ as a table.
    pub(super) fn matrices(&mut self, project: &Project, matrices: &Matrices) -> Result<(), Error> {
        self.triangles(project, "matrices", matrices.masters.len(), &matrices.k, &matrices.m)
    }

    pub(super) fn triangles(
        &mut self,
        project: &Project,
        table: &str,
        n: usize,
        k: &[f64],
        m: &[f64],
    ) -> Result<(), Error> {
        let entries = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j)));
        let rows = entries.map(|(i, j)| {
            let at = j * n + i;
            vec![index(i), index(j), TableValue::Number(k[at]), TableValue::Number(m[at])]
        });
        self.table(project, table, &["i", "j", "K", "M"], rows)
    }

    /// A table beside the listing, where the project has a folder.
    pub(super) fn table<'a>(
        &mut self,
        project: &Project,
        name: &str,
        header: &[&str],
        rows: impl Iterator<Item = Vec<TableValue<'a>>> + Clone,
    ) -> Result<(), Error> {
        let Some(dir) = project.dir() else { return Ok(()) };
        let file = format!("{}.{name}.csv", self.stem);
        tables::write_columns(dir, &file, header, rows)?;
        self.outcome.files.push(file);
        Ok(())
    }

    /// Curves over time beside the listing, in the deck's units, which nobody has named.
    pub(super) fn picture(
        &mut self,
        project: &Project,
        name: &str,
        quantity: &str,
        series: Vec<Series>,
    ) -> Result<(), Error> {
        let Some(dir) = project.dir().filter(|_| series.iter().any(|curve| curve.points.len() > 1)) else {
            return Ok(());
        };
        let title = self.outcome.title.clone();
        let [x, y] = ["Time", quantity].map(|what| Axis::linear(what, "units of the deck"));
        let file = format!("{}.{name}", self.stem);
        plot::line_plot(&LinePlot { title, x, y, series, marks: Vec::new(), doubts: Vec::new() })?.write(dir, &file)?;
        self.outcome.files.extend(["svg", "png"].map(|ending| format!("{file}.{ending}")));
        Ok(())
    }

    /// Writes the listing.
    ///
    /// # Errors
    /// A folder that cannot be written; a march that ended early, whose listing is written all the same.
    pub(super) fn write(mut self, project: &Project) -> Result<DeckOutcome, Error> {
        for warning in self.outcome.warnings.clone() {
            self.line(&format!("\nwarning: {warning}"));
        }
        if let Some(dir) = project.dir() {
            let file = format!("{}.listing.txt", self.stem);
            dir.write(&file, |out| out.write_all(self.text.as_bytes()))?;
            self.outcome.files.push(file);
        }
        self.stopped.map_or(Ok(self.outcome), |why| Err(why.into()))
    }
}

/// A number from 1.
pub(super) fn index(i: usize) -> TableValue<'static> {
    TableValue::Count(i as u64 + 1)
}
