//! The report's own input: LAMCEL, LAMSUB and TRADYR run from their decks (AFWAL-TR-87-4117, appendix).
//!
//! A deck says what a scene does not: pieces that are condensed once and put together by node numbers, constraints inside a
//! piece, masters and governors one by one, stresses of single elements at single print steps. It has no second mechanics: elements,
//! condensation, contact law, Runge-Kutta schemes and criteria are those of scenes. Numbers stay in the deck's units.
//!
//! ```text
//! deck ── fem_io::deck::parse ──> Generation ── piece::generate ──> Matrices, kept in the Project under NAME6
//!                                 ImpactDeck, Restart ── Model ── march ──> DisplacementSet, kept under NAME1
//!                                 BackSubstitution ── back::recover ──> tables of stresses
//! ```

mod axes;
mod back;
mod check;
mod element;
mod fits;
mod judge;
mod listing;
mod march;
mod model;
mod piece;
mod project;
mod reduced;
mod results;
mod show;
mod tables;
mod units;

pub use check::{Checked, Mistake, check};
pub use project::{Matrices, Project};
pub use results::{DeckAccuracy, DeckImpact, DeckSize};
pub use show::{Shown, export, show};
pub use units::UnitSystem;

use crate::cost::{Provenance, Stopwatch};
use crate::error::Error;
use crate::model::NamedCriterion;
use fem_io::deck::{
    self, BackSubstitution, Deck, DeckSource, Fault, Generation, ImpactDeck, MarchCard, NoResults, Program,
};
use listing::Listing;
use march::Marched;
use model::Model;
use piece::Parts;
use project::{Analysis, DisplacementSet};
use results::Impact;
use serde::{Serialize, Serializer};
use tables::Substituted;

/// How a deck is run.
#[derive(Debug, Clone, Default)]
pub struct DeckOptions {
    /// What its numbers are called, where it is said.
    pub units: Option<UnitSystem>,
    /// The displacement set whose analysis a restart goes on with; the last analysis where none is named.
    pub restart_of: Option<String>,
    /// Criteria that judge an impact, and whose indices back substitution prints besides those of the report.
    pub criteria: Vec<NamedCriterion>,
    /// Everything is done but the march in time and back substitution.
    pub check: bool,
    /// What it takes to run it again.
    pub provenance: Option<Provenance>,
}

/// What a deck came to.
#[derive(Debug, Clone, Serialize)]
pub struct DeckOutcome {
    /// Its title.
    pub title: String,
    /// Whether more than a data check was asked for.
    pub analysed: bool,
    /// What is odd.
    pub warnings: Vec<String>,
    /// Numbers by name, as printed.
    #[serde(serialize_with = "as_map")]
    pub counts: Vec<(&'static str, usize)>,
    /// Largest change of the energy of an impact that was marched, relative to that of the impact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_error: Option<f64>,
    /// What came of an impact, where its units are named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impact: Option<DeckImpact>,
    /// What it left in the project.
    pub files: Vec<String>,
}

fn as_map<S: Serializer>(counts: &[(&'static str, usize)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(counts.iter().map(|(name, count)| (name.replace(' ', "_"), count)))
}

/// Runs a deck of `program` in `project`.
///
/// # Errors
/// The first mistake of the deck with its place; a project that cannot be written.
pub fn run(
    source: &DeckSource,
    program: Program,
    project: &mut Project,
    options: &DeckOptions,
) -> Result<DeckOutcome, Error> {
    let parsed = deck::parse(source, program, project)?;
    let mut listing = Listing::new(source.name(), program, &parsed, options.units);
    let mut run = Run { source, project, listing: &mut listing, options };
    match &parsed.deck {
        Deck::Generation(deck) => run.generate(deck)?,
        Deck::Impact(deck) => run.analyse(deck)?,
        Deck::Restart(march) => run.restart(march, options.restart_of.as_deref())?,
        Deck::BackSubstitution(deck) => run.substitute(deck)?,
    }
    listing.write(project)
}

/// A deck at work.
struct Run<'a> {
    source: &'a DeckSource,
    project: &'a mut Project,
    listing: &'a mut Listing,
    options: &'a DeckOptions,
}

impl Run<'_> {
    fn generate(&mut self, deck: &Generation) -> Result<(), Error> {
        if !self.options.criteria.is_empty() {
            let found = "criteria judge stresses, and a generation finds none";
            let help = "leave `--criteria` out here, and give it to the back substitution or to the impact";
            return Err(self.source.error(0..0, Fault::NothingToJudge, found, help).into());
        }
        self.listing.generation(deck);
        if !deck.analyse {
            return Ok(());
        }
        let [k, m] = piece::generate(self.source, deck)?.condensed();
        let matrices = Matrices::new(self.source, deck, k, m);
        self.listing.matrices(self.project, &matrices)?;
        self.project.keep_matrices(self.source, deck, matrices)
    }

    fn analyse(&mut self, deck: &ImpactDeck) -> Result<(), Error> {
        self.listing.model(deck, self.project);
        if !deck.march.analyse {
            return Ok(());
        }
        let part =
            |name: &str| (name.to_owned(), self.project.matrices(name).map(Matrices::checksum).unwrap_or_default());
        let parts = deck.substructures.iter().map(|piece| part(&piece.name.value)).collect();
        let deck_of = (self.source.name().to_owned(), self.source.text().to_owned());
        self.go_on(deck, &deck.march, Analysis { deck: deck_of, parts, state: None }, false)
    }

    fn restart(&mut self, march: &MarchCard, of: Option<&str>) -> Result<(), Error> {
        let refuse = |found: String, help: &str| self.source.error(0..0, Fault::NoRestart, found, help);
        let Some(analysis) = self.project.analysis(of).cloned() else {
            let found = format!("there is no displacement set `{}` to go on with", of.unwrap_or_default());
            return Err(refuse(found, "name the NAME1 of an analysis in this project").into());
        };
        self.project.fresh(&analysis.parts).map_err(|why| {
            refuse(format!("the analysis cannot go on: {why}"), "analyse the model again, with NRSTRT 0")
        })?;
        let begun = DeckSource::new(&analysis.deck.0, analysis.deck.1.clone());
        let Deck::Impact(deck) = deck::parse(&begun, Program::Tradyr, &NoResults)?.deck else {
            return Err(refuse("the analysis was begun by another deck".into(), "analyse the model again").into());
        };
        self.listing.model(&deck, self.project);
        if march.analyse { self.go_on(&deck, march, analysis, true) } else { Ok(()) }
    }

    /// Marches `analysis` on by `march` and keeps what it comes to; a restart continues a set that the analysis wrote before.
    fn go_on(
        &mut self,
        deck: &ImpactDeck,
        march: &MarchCard,
        mut analysis: Analysis,
        restart: bool,
    ) -> Result<(), Error> {
        // Places are those of the deck at hand, but for the model's, which is that of the deck that began.
        let begun = DeckSource::new(&analysis.deck.0, analysis.deck.1.clone());
        let mut watch = Stopwatch::default();
        let model = Model::new(&begun, deck, self.project)?;
        watch.lap("model");
        let growth = model.check_step(self.source, march)?;
        self.listing.frequencies(&model, march, growth);
        self.listing.triangles(self.project, "governors", deck.freedom.kept.len(), &model.k, &model.m)?;
        let earlier = march.set.as_ref().and_then(|name| self.project.set(name));
        let continued = earlier
            .filter(|set| restart && (&set.analysis.deck, &set.analysis.parts) == (&analysis.deck, &analysis.parts));
        let (mut count, mut steps) = continued.map_or((0, Vec::new()), |set| (set.count, set.steps.clone()));
        if !self.options.check {
            let marched = march::march(self.source, deck, march, &model, analysis.state.take())?;
            watch.lap("march");
            let stopped = marched.stopped.clone().map(|why| {
                let help = "a smaller DELTA; where that changes nothing, look at K, N, M, I and C. What was found up to then is in the project";
                self.source.error(march.step.place.clone(), Fault::Unstable, why, help)
            });
            self.listing.marched(marched.error, stopped);
            self.listing.history(self.project, deck, &marched.prints)?;
            self.listing.motion(self.project, deck, march, &marched.prints)?;
            if let Some(units) = self.options.units {
                let DeckOptions { criteria, provenance, .. } = self.options;
                let (source, model, marched) = (self.source, &model, &marched);
                let impact =
                    Impact { source, deck, march, model, marched, units, criteria, provenance: provenance.as_ref() };
                impact.write(self.project, self.listing, watch)?;
            }
            let Marched { prints, state, .. } = marched;
            count += prints.len();
            steps.extend(
                prints.into_iter().map(|print| (print.time, print.motion.into_iter().next().unwrap_or_default())),
            );
            analysis.state = Some(state);
        } else {
            count += march.steps / march.every;
        }
        let set = DisplacementSet { analysis, count, steps };
        self.project.keep_analysis(self.source, march.set.as_deref(), set)
    }

    fn substitute(&mut self, deck: &BackSubstitution) -> Result<(), Error> {
        let (Some(matrices), Some(set)) = (self.project.generation(&deck.names), self.project.set(&deck.names[5]))
        else {
            return Ok(());
        };
        if !deck.analyse || self.options.check {
            return Ok(());
        }
        let own = DeckSource::new(&matrices.deck.0, matrices.deck.1.clone());
        let begun = DeckSource::new(&set.analysis.deck.0, set.analysis.deck.1.clone());
        let (Deck::Generation(piece), Deck::Impact(model)) = (
            deck::parse(&own, matrices.program(), &NoResults)?.deck,
            deck::parse(&begun, Program::Tradyr, &NoResults)?.deck,
        ) else {
            return Ok(());
        };
        let way = piece::generate(&own, &piece)?;
        let parts = Parts::new(&own, &piece)?;
        let mut substituted = Vec::new();
        for asked in &deck.sets {
            let Some((_, u)) = set.steps.get(asked.step - 1).filter(|(_, u)| u.len() == model.freedom.ndof()) else {
                let found =
                    format!("`{}` has no displacements of its model at print step {}", deck.names[5], asked.step);
                let help = "analyse the model again";
                return Err(self.source.error(0..0, Fault::NoSuchResult, found, help).into());
            };
            let per_node = model.freedom.directions.len();
            let nodes = model.substructures[asked.substructure - 1].nodes.iter();
            let masters: Vec<f64> = nodes.flat_map(|n| &u[n * per_node..(n + 1) * per_node]).copied().collect();
            let u = way.expand(&masters);
            let found = asked.elements.iter().map(|number| {
                Ok((*number, back::recover(&piece, &parts, number - 1, &asked.prints, &u, &self.options.criteria)?))
            });
            let found = found.collect::<Result<Vec<_>, Error>>()?;
            substituted.push(Substituted { asked, u, found });
        }
        self.listing.substitution(self.project, &piece.freedom, &substituted)
    }
}
