//! Quantities that are formulas of what cases set and find.

use super::design::SweepAxis;
use super::figures::{CaseFigures, GrownFigures, StruckFigures};
use crate::error::Error;
use crate::model::{Model, Plan};
use fem_core::formula::{Formula, PowerError};
use fem_core::plugin::Dimension;
use fem_io::scene::{Written, unit};
use fem_io::units::parse_quantity;

/// A figure of an impactor: its name, its unit at the end of a column, what it is, where it stands.
type OfImpactor = (&'static str, &'static str, Dimension, fn(&StruckFigures) -> f64);

/// The same of what has delaminated.
type OfGrowth = (&'static str, &'static str, Dimension, fn(&GrownFigures) -> f64);

/// What is known of each impactor.
pub(super) const OF_IMPACTOR: [OfImpactor; 7] = [
    ("energy", "J", Dimension::ENERGY, |of| of.energy),
    ("peak_force", "N", Dimension::FORCE, |of| of.peak_force),
    ("peak_force_time", "s", Dimension::TIME, |of| of.peak_force_time),
    ("impulse", "N_s", Dimension([1.0, 1.0, -1.0, 0.0]), |of| of.impulse),
    ("deflection", "m", Dimension::LENGTH, |of| of.deflection),
    ("contact_time", "s", Dimension::TIME, |of| of.contact_time),
    ("absorbed_energy", "J", Dimension::ENERGY, |of| of.absorbed_energy),
];

/// What is known of delaminations that grow, as of an impactor.
pub(super) const OF_GROWTH: [OfGrowth; 3] = [
    ("delaminated_area", "m2", Dimension::AREA, |of| of.projected_area),
    ("delaminated_areas", "m2", Dimension::AREA, |of| of.area),
    ("dissipated_energy", "J", Dimension::ENERGY, |of| of.dissipated_energy),
];

/// Units that formulas know.
const UNITS: [&str; 14] = ["kg", "g", "m", "mm", "s", "ms", "us", "N", "kN", "J", "mJ", "MPa", "GPa", "Hz"];

/// A number of a case.
#[derive(Debug, Clone)]
enum Figure {
    /// What a key becomes, by its place among the axes, with the unit that it has in the scene.
    Set(usize, Option<String>),
    Impactor(usize, fn(&StruckFigures) -> f64),
    DamageTime,
    DamageForce,
    /// Index, onset and force of a mode, by its place.
    Index(usize),
    Onset(usize),
    Force(usize),
    OverThreshold,
    Grown(fn(&GrownFigures) -> f64),
    EnergyError,
    Warnings,
    Unit(f64),
}

/// A formula of what a case sets and finds, in SI units.
#[derive(Debug, Clone)]
pub struct CaseQuantity {
    /// What it is called: a name of its own, or the formula.
    pub name: String,
    /// Of what its values are.
    pub dimension: Dimension,
    formula: Formula,
    /// What the formula wants, in its order.
    figures: Vec<Figure>,
}

/// What formulas over the cases of a sweep may name.
pub(super) struct Known {
    names: Vec<String>,
    all: Vec<(Dimension, Figure)>,
}

impl Known {
    /// Of cases of `model` in which `axes` are varied, over what is `written` in the scene.
    pub(super) fn new(model: &Model, axes: &[SweepAxis], written: &Written) -> Self {
        let mut known = Self { names: Vec::new(), all: Vec::new() };
        let impactors = match &model.plan {
            Plan::Impact(impact) => &impact.spec.impactors[..],
            _ => &[],
        };
        for (k, spec) in impactors.iter().enumerate() {
            let of = model.label(spec).map_or_else(String::new, |name| format!("{name} "));
            for (name, _, is, at) in OF_IMPACTOR {
                known.add(&format!("{of}{name}"), is, Figure::Impactor(k, at));
            }
        }
        known.add("damage_time", Dimension::TIME, Figure::DamageTime);
        known.add("damage_force", Dimension::FORCE, Figure::DamageForce);
        let modes = model
            .criteria
            .iter()
            .flat_map(|(name, criterion)| criterion.info().modes.iter().map(move |mode| format!("{name} {mode}")));
        for (k, mode) in modes.enumerate() {
            known.add(&format!("{mode} index"), Dimension::NONE, Figure::Index(k));
            known.add(&format!("{mode} time"), Dimension::TIME, Figure::Onset(k));
            known.add(&format!("{mode} force"), Dimension::FORCE, Figure::Force(k));
        }
        known.add("force_over_delamination_threshold", Dimension::NONE, Figure::OverThreshold);
        for (name, _, is, at) in OF_GROWTH.into_iter().filter(|_| model.separation.is_some() || model.grown.is_some()) {
            known.add(name, is, Figure::Grown(at));
        }
        known.add("energy_error", Dimension::NONE, Figure::EnergyError);
        known.add("warnings", Dimension::NONE, Figure::Warnings);
        for (k, axis) in axes.iter().enumerate() {
            let own = written.text(&axis.key).and_then(unit).map(str::to_owned);
            if let Some((_, is)) = number(&axis.variation.at(0.5), own.as_deref()) {
                known.add(&axis.key, is, Figure::Set(k, own));
            }
        }
        for unit in UNITS {
            if let Ok((value, is)) = parse_quantity(&format!("1 {unit}")) {
                known.add(unit, is, Figure::Unit(value));
            }
        }
        known
    }

    /// What formulas call it: letters, digits and `_`.
    fn add(&mut self, name: &str, is: Dimension, figure: Figure) {
        self.names.push(name.replace(|c: char| !c.is_ascii_alphanumeric(), "_"));
        self.all.push((is, figure));
    }

    /// Reads quantities, each as [`Known::quantity`].
    ///
    /// # Errors
    /// As there, and two of one name.
    pub(super) fn quantities(&self, texts: &[String]) -> Result<Vec<CaseQuantity>, Error> {
        let mut all: Vec<CaseQuantity> = Vec::new();
        for text in texts {
            let quantity = self.quantity(text)?;
            if all.iter().any(|of| of.name == quantity.name) {
                return Err(Error::Sweep {
                    message: format!("two quantities are called `{}`", quantity.name),
                    help: "call one of them something else".into(),
                });
            }
            all.push(quantity);
        }
        Ok(all)
    }

    /// Reads `NAME = FORMULA`, or a formula alone.
    ///
    /// # Errors
    /// No formula, a name that nothing has, quantities that do not go together.
    pub(super) fn quantity(&self, text: &str) -> Result<CaseQuantity, Error> {
        let is_name = |name: &str| {
            let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
            plain && name.starts_with(|c: char| c.is_ascii_alphabetic())
        };
        let named = text.split_once('=').map(|(name, formula)| (name.trim(), formula.trim()));
        let (name, formula) = named.filter(|(name, _)| is_name(name)).unwrap_or((text.trim(), text.trim()));
        let refuse = |why: String| {
            Error::Sweep {
            message: format!("quantity `{formula}`: {why}"),
            help: "a formula has columns of the table without their units, keys that vary with `_` for points, and units, as in \
                   `absorbed_energy / energy` or `peak_force / (2*kN)`"
                .into(),
        }
        };
        let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        if name != formula && names.contains(&name) {
            return Err(refuse(format!("`{name}` is known already; call it something else")));
        }
        let compiled = Formula::parse(formula, &names).map_err(|why| refuse(why.to_string()))?;
        let several = |name: &&str| names.iter().filter(|of| of == &name).count() > 1;
        if let Some(name) = compiled.names().iter().map(|k| names[*k]).find(several) {
            return Err(refuse(format!(
                "`{name}` is more than one thing here; give impactors names that differ in letters or digits"
            )));
        }
        let used: Vec<&(Dimension, Figure)> = compiled.names().iter().map(|k| &self.all[*k]).collect();
        let mut dimension = Dimension::NONE;
        for (base, power) in dimension.0.iter_mut().enumerate() {
            let powers: Vec<f64> = used.iter().map(|(is, _)| is.0[base]).collect();
            *power = compiled.power(&powers).map_err(|why| refuse(describe(&why)))?;
        }
        let figures = used.iter().map(|(_, figure)| figure.clone()).collect();
        Ok(CaseQuantity { name: name.to_owned(), dimension, formula: compiled, figures })
    }
}

fn describe(PowerError { symbol, place, .. }: &PowerError) -> String {
    match *symbol {
        "+" | "-" => format!("`{symbol}` at character {place} has different units on its sides"),
        "<" | "<=" | ">" | ">=" => format!("`{symbol}` at character {place} compares different units"),
        "^" => format!("`^` at character {place} needs a pure number above, written as one where its base has a unit"),
        _ => format!("`{symbol}` at character {place} takes a pure number, and its argument has a unit"),
    }
}

/// A value of a key as a number, SI, and what it is, without a unit in its `own`; `None` of words.
fn number(value: &str, own: Option<&str>) -> Option<(f64, Dimension)> {
    match (value.trim().parse(), own) {
        (Ok(value), None) => Some((value, Dimension::NONE)),
        (Ok::<f64, _>(_), Some(own)) => parse_quantity(&format!("{} {own}", value.trim())).ok(),
        (Err(_), _) => parse_quantity(value).ok(),
    }
}

impl CaseQuantity {
    /// Its value for a case that sets `values` and found `case`; `None` where the case has not all that it is of.
    pub fn value(&self, values: &[String], case: &CaseFigures) -> Option<f64> {
        let onset = |mode: &usize| case.modes.get(*mode)?.onset;
        let figure = |of: &Figure| match of {
            Figure::Set(axis, own) => values.get(*axis).and_then(|value| Some(number(value, own.as_deref())?.0)),
            Figure::Impactor(k, at) => case.impactors.get(*k).map(at),
            Figure::DamageTime => case.first.as_ref().map(|first| first.time),
            Figure::DamageForce => case.first.as_ref().map(|first| first.force),
            Figure::Index(mode) => case.modes.get(*mode).map(|mode| mode.index),
            Figure::Onset(mode) => onset(mode).map(|onset| onset.0),
            Figure::Force(mode) => onset(mode).map(|onset| onset.1),
            Figure::OverThreshold => case.over_threshold,
            Figure::Grown(at) => case.grown.as_ref().map(at),
            Figure::EnergyError => Some(case.energy_error),
            Figure::Warnings => Some(case.warnings as f64),
            Figure::Unit(value) => Some(*value),
        };
        let values: Vec<f64> = self.figures.iter().map(figure).collect::<Option<_>>()?;
        Some(self.formula.value(&values)).filter(|value| value.is_finite())
    }

    /// Its unit; nothing for a pure number.
    pub(super) fn unit(&self) -> String {
        if self.dimension.matches(&Dimension::NONE) { String::new() } else { self.dimension.to_string() }
    }

    /// Its name with its unit.
    pub(super) fn column(&self) -> String {
        match self.unit() {
            unit if unit.is_empty() => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }
}
