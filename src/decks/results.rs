//! What an impact by decks leaves like any impact: tables, a summary and pictures in SI units, from which `fem report` makes its
//! page.

use super::judge::{Judged, judge};
use super::listing::Listing;
use super::march::Marched;
use super::model::Model;
use super::project::Project;
use super::units::UnitSystem;
use crate::cost::{Cost, Provenance, Stopwatch};
use crate::error::Error;
use crate::model::NamedCriterion;
use crate::output::pictures::{Drawn, first_of_modes, write_curves};
use crate::output::report::DECK;
use crate::output::summary::{DamageSummary, ImpactFigures, MarginSummary, Work, not_reached, reserve};
use crate::words::name_ply;
use fem_core::counters::Counters;
use fem_failure::scan::{FailureEvent, PlyOrInterface, first_per_mode};
use fem_io::deck::{DeckSource, ImpactDeck, MarchCard};
use fem_io::tables::{self, EventRow, HistoryRow, write_json};
use serde::Serialize;
use std::f64::consts::TAU;
use std::num::NonZeroUsize;

/// What came of an impact, in SI units; of a model that symmetry cuts, of the part that is there.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct DeckImpact {
    pub title: String,
    pub version: &'static str,
    /// [`fem_io::results::FORMAT`].
    pub format: u32,
    pub completed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
    pub model: DeckSize,
    pub impact: ImpactFigures,
    pub first_damage: Vec<DamageSummary>,
    pub not_reached: Vec<MarginSummary>,
    pub accuracy: DeckAccuracy,
    pub work: Work,
    pub warnings: Vec<String>,
}

/// Sizes of a model of pieces.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct DeckSize {
    pub substructures: usize,
    pub elements: usize,
    pub nodes: usize,
    pub masters: usize,
    pub governors: usize,
    pub stress_sites: usize,
    pub lowest_frequency_Hz: f64,
    pub highest_frequency_Hz: f64,
}

/// What is known of the error: the change of the energy, relative to that of the impact.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct DeckAccuracy {
    pub energy_error_relative: f64,
    pub step_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stable_step_s: Option<f64>,
}

/// An impact that was marched, and what is to be made of it.
pub(super) struct Impact<'a> {
    pub(super) source: &'a DeckSource,
    pub(super) deck: &'a ImpactDeck,
    pub(super) march: &'a MarchCard,
    pub(super) model: &'a Model,
    pub(super) marched: &'a Marched,
    pub(super) units: UnitSystem,
    pub(super) criteria: &'a [NamedCriterion],
    pub(super) provenance: Option<&'a Provenance>,
}

impl Impact<'_> {
    /// Writes it into a folder of its own in the project, named as the deck.
    ///
    /// # Errors
    /// A folder that cannot be written, a stress that is not finite.
    pub(super) fn write(&self, project: &Project, listing: &mut Listing, mut watch: Stopwatch) -> Result<(), Error> {
        let Some(dir) = project.dir() else { return Ok(()) };
        let Marched { prints, rows, begin, .. } = self.marched;
        let judged = judge(project, self.deck, self.model, (*begin, prints), self.units, self.criteria)?;
        watch.lap("stresses");
        judged.left_out.iter().for_each(|why| listing.warn(why.clone()));
        let rows: Vec<HistoryRow> = rows.iter().map(|row| self.units.row(row)).collect();
        let events = judged.scan.events();
        let summary = self.summary(project, listing, &rows, &judged, &events);

        let dir = dir.folder(listing.stem())?;
        dir.begin_run();
        tables::write_history(&dir, &[""], &[], &rows)?;
        let listed: Vec<EventRow> = events.iter().map(|event| event_row(&judged, event)).collect();
        tables::write_events(&dir, &listed)?;
        write_json(&dir, "summary.json", &summary)?;
        dir.write(DECK, |out| out.write_all(self.source.text().as_bytes()))?;
        let title = &self.march.title;
        let drawn = Drawn { title, names: vec![""], columns: Vec::new(), rows: &rows, marks: first_of_modes(&events) };
        write_curves(&dir, &drawn)?;
        watch.lap("pictures");
        let cost = Cost::new(NonZeroUsize::MIN, watch.phases().to_vec());
        write_json(&dir, "cost.json", &Cost { provenance: self.provenance.cloned(), ..cost })?;
        dir.remove_older()?;
        listing.found(summary);
        Ok(())
    }

    fn summary(
        &self,
        project: &Project,
        listing: &Listing,
        rows: &[HistoryRow],
        judged: &Judged,
        events: &[FailureEvent],
    ) -> DeckImpact {
        let Self { deck, march, model, marched, units, .. } = self;
        let force = |t: f64| marched.forces.at(t - marched.begin) * units.newtons();
        let damage = |event: &FailureEvent| DamageSummary {
            event: event_row(judged, event),
            contact_force_N: force(event.time),
            stress: (&event.stress).into(),
            reserve_factor: reserve(&judged.criteria, &judged.materials, event),
        };
        let contact = units.contact(&marched.contact);
        let mass = deck.impactor.mass * units.kilograms();
        let velocity = rows.first().map_or(0.0, |row| row.impactors[0].impactor_velocity_m_s);
        let end = rows.last().map_or((0.0, 0.0), |row| (row.time_s, row.impactors[0].impactor_velocity_m_s));
        let figures = ImpactFigures::new([mass, velocity], &contact, end, judged.thickness);
        let pieces = deck.substructures.iter().filter_map(|piece| project.matrices(&piece.name.value));
        let freedom = &deck.freedom;
        DeckImpact {
            title: march.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            format: fem_io::results::FORMAT,
            completed: marched.stopped.is_none(),
            stopped: marched.stopped.clone(),
            model: DeckSize {
                substructures: deck.substructures.len(),
                elements: pieces.map(|matrices| matrices.elements).sum(),
                nodes: freedom.nodes.len(),
                masters: freedom.ndof() - freedom.relations.len(),
                governors: freedom.kept.len(),
                stress_sites: judged.scan.sites().len(),
                lowest_frequency_Hz: hertz(model.omega.first()),
                highest_frequency_Hz: hertz(model.omega.last()),
            },
            first_damage: first_per_mode(events).into_iter().map(damage).collect(),
            not_reached: not_reached(&judged.scan.peaks(), |_| None),
            accuracy: DeckAccuracy {
                energy_error_relative: marched.error,
                step_s: march.step.value,
                stable_step_s: (march.order > 2).then(|| model.longest_step(march)),
            },
            impact: ImpactFigures { start_time_s: (marched.begin > 0.0).then_some(marched.begin), ..figures },
            work: Counters { criterion_calls: judged.scan.evaluations(), ..marched.counters }.into(),
            warnings: listing.warnings().to_vec(),
        }
    }
}

/// An event as tables and summaries hold it; its place is that in the piece.
fn event_row(judged: &Judged, event: &FailureEvent) -> EventRow {
    let [substructure, element] = judged.cells[event.cell as usize];
    let [x_m, y_m, z_m] = event.position;
    let angle_deg = match event.place {
        PlyOrInterface::Ply(_) => event.angle.to_degrees(),
        PlyOrInterface::Interface(_) => 0.0,
    };
    EventRow {
        criterion: event.criterion.clone(),
        mode: event.mode.to_owned(),
        time_s: event.time,
        substructure: Some(substructure),
        region: None,
        cell: element,
        ply: name_ply(event.place),
        angle_deg,
        x_m,
        y_m,
        z_m,
        index: event.index,
    }
}

/// Hertz of a circular frequency, 0 where there is none.
fn hertz(omega: Option<&f64>) -> f64 {
    omega.map_or(0.0, |omega| omega / TAU)
}
