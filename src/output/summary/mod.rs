//! The summary of a run: for machines (`summary.json`) and for people.

mod cautions;
mod delamination;
mod onset;
mod text;
mod warnings;

pub(crate) use cautions::{follows_mesh, placed};
pub use onset::OnsetBand;

use crate::advise::hindsight;
use crate::analyses::assembled::Substructures;
pub use delamination::{DelaminationFigures, InterfaceFigures};

use crate::analyses::impact::{self, ContactRecord, Differences, ModeShare, Outcome, Sizes};
use crate::effect::{AdviceRule, Decision, Hindsight, LedgerColumn};
use crate::model::{Model, NamedCriterion, Plan};
use crate::output::preload::PreloadFigures;
use crate::output::slopes::warn_of_slopes;
use crate::words::{name_ply, name_ply_of};
use fem_core::counters::Counters;
use fem_core::material::Material;
use fem_core::tensor::{Ply, Stress6};
use fem_failure::scan::{FailureEvent, Peak, PlyOrInterface, first_per_mode};
use fem_io::scene;
use fem_io::tables::EventRow;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt::{self, Display};

/// The summary of a run; units are in the key names.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct ImpactSummary {
    pub title: String,
    pub version: &'static str,
    /// [`fem_io::results::FORMAT`].
    pub format: u32,
    pub fidelity: &'static str,
    pub completed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
    /// Why a headline is not to be trusted.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cautions: Vec<String>,
    pub model: ModelSize,
    #[serde(flatten)]
    pub preload: PreloadFigures,
    #[serde(serialize_with = "one_or_list")]
    pub impact: Vec<ImpactFigures>,
    pub first_damage: Vec<DamageSummary>,
    pub not_reached: Vec<MarginSummary>,
    /// How far the times of `first_damage` are known.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub onsets: Vec<OnsetBand>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delamination_threshold: Option<Threshold>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delamination: Option<DelaminationFigures>,
    /// What plies that follow laws have dissipated, J, mode by mode.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub plies_J: BTreeMap<&'static str, f64>,
    /// Energies that effects have taken or hold at the end, J, by their columns of the history.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub energies_of_effects: BTreeMap<&'static str, f64>,
    /// The same with words, for people.
    #[serde(skip)]
    labelled: Vec<(&'static str, f64)>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub modes: Vec<ModeShare>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub advised: Vec<Advised>,
    pub accuracy: AccuracySummary,
    pub work: Work,
    pub warnings: Vec<String>,
}

/// Sizes.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct ModelSize {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<&'static str>,
    /// What the cells of the plane mesh are called.
    #[serde(skip)]
    pub shape: &'static str,
    pub quads: usize,
    pub layers: usize,
    pub cells: usize,
    pub nodes: usize,
    pub plies: usize,
    pub thickness_mm: f64,
    pub plate_mass_g: f64,
    pub unknowns: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub substructures: Option<Substructures>,
    pub unknowns_marched: usize,
    pub stiffness_entries: usize,
    pub factor_entries: usize,
    pub stress_sites: usize,
    pub static_stiffness_N_m: f64,
    /// What effects say of it.
    #[serde(flatten)]
    pub of_effects: BTreeMap<&'static str, f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lowest_frequency_Hz: Option<f64>,
}

/// The response to an impactor; `name` and `start_time_s` where there are several.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct ImpactFigures {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    pub mass_kg: f64,
    pub velocity_m_s: f64,
    pub energy_J: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_time_s: Option<f64>,
    pub end_time_s: f64,
    pub peak_force_N: f64,
    pub peak_force_time_s: f64,
    pub peak_plate_displacement_m: f64,
    pub peak_plate_displacement_over_thickness: f64,
    pub peak_indentation_m: f64,
    /// That the contact law leaves, where it leaves one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dent_m: Option<f64>,
    /// The largest, under a spherical tip.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_radius_m: Option<f64>,
    pub impulse_N_s: f64,
    pub final_impactor_velocity_m_s: f64,
    /// What of its energy it does not have at the end, the work of its weight counted.
    pub absorbed_energy_J: f64,
    pub contacts: u32,
    pub contact_time_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub squeeze_m_N: Option<f64>,
}

/// As a scene has it: a single impactor as a table, several as a list.
fn one_or_list<S: Serializer>(impact: &[ImpactFigures], serializer: S) -> Result<S::Ok, S::Error> {
    match impact {
        [one] => one.serialize(serializer),
        several => several.serialize(serializer),
    }
}

/// First event of a criterion's mode, with the stress there at that time and how much of it the criterion would bear: 1 where
/// this mode is what fails first, less where another mode of the criterion failed before.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct DamageSummary {
    #[serde(flatten)]
    pub event: EventRow,
    pub contact_force_N: f64,
    pub stress: PlyStress,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reserve_factor: Option<f64>,
}

/// Stress in a ply's axes; of an interface in the plate's.
#[derive(Debug, Clone, Copy, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct PlyStress {
    pub s11_MPa: f64,
    pub s22_MPa: f64,
    pub s33_MPa: f64,
    pub s12_MPa: f64,
    pub s23_MPa: f64,
    pub s13_MPa: f64,
}

impl From<&Stress6<Ply>> for PlyStress {
    fn from(s: &Stress6<Ply>) -> Self {
        let [a, b, c, d, e, f] = s.0.map(|v| v * 1e-6);
        Self { s11_MPa: a, s22_MPa: b, s33_MPa: c, s12_MPa: d, s23_MPa: e, s13_MPa: f }
    }
}

/// The contact force at which one delamination of the laminate grows, by energies and not by stresses, and that at which all of its
/// interfaces between unlike plies do, which is the least; when they were first reached, the least by which impactor, where there are
/// several.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct Threshold {
    pub force_N: f64,
    pub interfaces: usize,
    pub force_of_all_N: f64,
    pub bending_stiffness_N_m: f64,
    pub toughness_GIIc_J_m2: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_of_all_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impactor: Option<String>,
}

/// A choice that the scene left to the advisor: what it asked before the run, and what came.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct Advised {
    pub effect: &'static str,
    pub on: bool,
    pub number: &'static str,
    pub threshold: f64,
    pub expected: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reached: Option<f64>,
}

impl Advised {
    /// As it was decided; `reached` says what came of an effect.
    pub(crate) fn of(model: &Model, reached: impl Fn(&str) -> Option<f64>) -> Vec<Self> {
        let each = model.decisions.iter().map(|decision| {
            let Decision { effect, on, formula, expected, threshold } = *decision;
            Self { effect, on, number: formula, threshold, expected, reached: reached(effect) }
        });
        each.collect()
    }
}

/// As people read it.
impl Display for Advised {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { effect, number, threshold, expected, .. } = self;
        let choice = if self.on { "on" } else { "off" };
        write!(f, "{effect} {choice}: {number} expected {expected:.4}, needed above {threshold}")?;
        self.reached.map_or(Ok(()), |reached| write!(f, "; reached {reached:.4}"))
    }
}

/// Largest index of a mode that did not reach 1.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct MarginSummary {
    pub criterion: String,
    pub mode: String,
    pub largest_index: f64,
    pub time_s: f64,
    pub ply: String,
}

/// What is known of the error: where the estimates come from and what they are worth, say [`impact::StepAccuracy`] and
/// [`impact::ReductionResidual`]. The step compared with is that of the second march, its force the difference from that of the run.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct AccuracySummary {
    pub energy_error_relative: f64,
    pub step_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stable_step_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_parts: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shortest_part_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub longest_part_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_error_force_L2_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_error_peak_force_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compared_step_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compared_force_L2_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction_error_force_L2_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction_residual_energy_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction_flexibility_error_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_error_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub results: Option<ResultErrors>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub results_of_step: Option<ResultErrors>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub results_of_reduction: Option<ResultErrors>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub results_of_mesh: Option<ResultErrors>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub results_of_layers: Option<ResultErrors>,
}

/// Estimated errors of the main results, relative, that of the force's history in L2: of step, reduction, mesh and layers together,
/// and of each.
#[derive(Debug, Clone, Copy, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct ResultErrors {
    pub force_history_L2_relative: f64,
    pub peak_force_relative: f64,
    pub impulse_relative: f64,
    pub deflection_relative: f64,
}

impl ResultErrors {
    fn of(differences: Option<Differences>) -> Option<Self> {
        let Differences { force, peak, impulse, deflection } = differences?;
        Some(Self {
            force_history_L2_relative: force,
            peak_force_relative: peak,
            impulse_relative: impulse,
            deflection_relative: deflection,
        })
    }
}

/// Work counters.
#[derive(Debug, Clone, Copy, Serialize)]
#[allow(missing_docs)]
pub struct Work {
    pub elements: u64,
    pub factorisations: u64,
    pub solves: u64,
    pub steps: u64,
    pub contact_calls: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub newton_iterations: Option<u64>,
    pub criterion_calls: u64,
}

impl MarginSummary {
    fn new(peak: &Peak, region: Option<&str>) -> Self {
        Self {
            criterion: peak.criterion.clone(),
            mode: peak.mode.to_owned(),
            largest_index: peak.index,
            time_s: peak.time,
            ply: name_ply_of(peak.site.place, region),
        }
    }
}

impl From<Counters> for Work {
    fn from(c: Counters) -> Self {
        Self {
            elements: c.elements,
            factorisations: c.factorisations,
            solves: c.solves,
            steps: c.steps,
            contact_calls: c.contact_calls,
            newton_iterations: Some(c.iterations).filter(|count| *count > 0),
            criterion_calls: c.criterion_calls,
        }
    }
}

/// What a run says of an effect that the advisor knows.
pub(in crate::output) struct Seen {
    effect: &'static str,
    advice: &'static AdviceRule,
    run: Hindsight,
}

/// What `run` went to, by the threshold of each effect.
pub(in crate::output) fn hindsights(model: &Model, run: impl Fn(f64) -> Option<Hindsight>) -> Vec<Seen> {
    let each = model.effects.known().iter().filter_map(|info| {
        let advice = info.advice.as_ref().filter(|advice| advice.hindsight.is_some())?;
        Some(Seen { effect: info.key.name, advice, run: run(advice.threshold)? })
    });
    each.collect()
}

impl Seen {
    /// What the user should know where the choice was wrong.
    pub(in crate::output) fn warning(&self, model: &Model) -> Option<String> {
        let decided = model.decisions.iter().any(|decision| decision.effect == self.effect);
        self.advice.hindsight?(&self.run, model.effects.has(self.effect), decided)
    }
}

impl ImpactSummary {
    /// Sums up a run.
    pub fn new(model: &Model, sizes: &Sizes, outcome: &Outcome) -> Self {
        let impact::Accuracy { step, reduction, mesh, layers, .. } = outcome.accuracy;
        let residual = reduction.and_then(|error| error.residual);
        let thickness = model.laminate.thickness();
        let seen = hindsights(model, |threshold| hindsight(model, &outcome.contacts, sizes.buckling, threshold));
        let reached = |effect: &str| Some(seen.iter().find(|seen| seen.effect == effect)?.run.reached);
        let damage = |e: &FailureEvent| DamageSummary {
            event: event_row(model, e),
            contact_force_N: outcome.forces.at(e.time),
            stress: (&e.stress).into(),
            reserve_factor: reserve(&model.criteria, &model.materials, e),
        };
        let impact: Vec<ImpactFigures> =
            model.impactors().iter().enumerate().map(|(i, spec)| figures(model, outcome, i, spec)).collect();
        let deflection = impact.iter().map(|figures| figures.peak_plate_displacement_m).fold(0.0, f64::max);
        let summary = Self {
            title: model.origin.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            format: fem_io::results::FORMAT,
            fidelity: model.origin.fidelity.name(),
            completed: outcome.stopped.is_none(),
            stopped: outcome.stopped.clone(),
            cautions: Vec::new(),
            model: ModelSize {
                symmetry: model.plate.symmetry().name(),
                shape: model.plate.plane.name_of_cells(),
                quads: model.plate.plane.quads.len(),
                layers: model.plate.layers(),
                cells: model.plate.cells(),
                nodes: model.plate.nodes(),
                plies: model.laminate.plies.len(),
                thickness_mm: thickness * 1e3,
                plate_mass_g: model.mass * 1e3,
                unknowns: sizes.unknowns,
                substructures: sizes.substructures,
                unknowns_marched: sizes.marched,
                stiffness_entries: sizes.stiffness_entries,
                factor_entries: sizes.factor_entries,
                stress_sites: outcome.sites,
                static_stiffness_N_m: sizes.static_stiffness,
                of_effects: outcome.quantities.iter().copied().collect(),
                lowest_frequency_Hz: sizes.lowest_frequency,
            },
            preload: PreloadFigures::new(model, sizes.buckling),
            delamination: DelaminationFigures::of_impact(outcome, &impact),
            plies_J: outcome.plies.iter().copied().collect(),
            energies_of_effects: energies(model, outcome).map(|(column, energy)| (column.name, energy)).collect(),
            labelled: energies(model, outcome).map(|(column, energy)| (column.label, energy)).collect(),
            impact,
            first_damage: first_per_mode(&outcome.events).into_iter().map(damage).collect(),
            not_reached: not_reached(&outcome.peaks, |quad| model.region_of(quad)),
            onsets: onset::bands(model, outcome),
            delamination_threshold: model.threshold.map(|threshold| {
                let first = |which| threshold_reached(model, outcome, which).min_by(|a, b| a.0.total_cmp(&b.0));
                let [all, one] = [0, 1].map(first);
                Threshold {
                    force_N: threshold.force,
                    interfaces: threshold.interfaces,
                    force_of_all_N: threshold.force_of_all,
                    bending_stiffness_N_m: threshold.bending_stiffness,
                    toughness_GIIc_J_m2: threshold.giic,
                    time_s: one.map(|first| first.0),
                    time_of_all_s: all.map(|first| first.0),
                    impactor: all.and_then(|first| first.1.map(str::to_owned)),
                }
            }),
            modes: outcome.modal.as_ref().map_or(Vec::new(), |modal| modal.modes.clone()),
            advised: Advised::of(model, reached),
            accuracy: AccuracySummary {
                energy_error_relative: outcome.energy_error,
                step_s: sizes.step,
                stable_step_s: Some(sizes.longest_step).filter(|s| s.is_finite()),
                step_parts: outcome.parts.map(|parts| parts.count),
                shortest_part_s: outcome.parts.map(|parts| parts.shortest),
                longest_part_s: outcome.parts.map(|parts| parts.longest),
                step_error_force_L2_relative: step.map(|e| e.error.force),
                step_error_peak_force_relative: step.map(|e| e.error.peak),
                compared_step_s: step.map(|e| e.compared),
                compared_force_L2_relative: step.map(|e| e.difference.force),
                reduction_error_force_L2_relative: residual.and_then(|r| r.force),
                reduction_residual_energy_relative: residual.map(|r| r.energy),
                reduction_flexibility_error_relative: reduction.map(|e| e.flexibility),
                mesh_error_relative: mesh.map(|e| e.at_rest),
                results: ResultErrors::of(outcome.accuracy.results()),
                results_of_step: ResultErrors::of(step.map(|e| e.error)),
                results_of_reduction: ResultErrors::of(reduction.and_then(|e| e.response)),
                results_of_mesh: ResultErrors::of(mesh.and_then(|e| e.response)),
                results_of_layers: ResultErrors::of(layers),
            },
            work: outcome.counters.into(),
            warnings: {
                let found = warnings::of_contacts(model, sizes, outcome)
                    .chain(seen.iter().filter_map(|seen| seen.warning(model)))
                    .chain(warn_of_slopes(model, deflection));
                model.warnings.iter().cloned().chain(found).collect()
            },
        };
        Self { cautions: cautions::cautions(model, outcome, &summary), ..summary }
    }
}

/// What effects have taken or hold at the end, J.
fn energies<'a>(model: &'a Model, outcome: &'a Outcome) -> impl Iterator<Item = (&'static LedgerColumn, f64)> + 'a {
    let last = outcome.history.last().into_iter().flat_map(|row| row.effects.iter().copied());
    model.effects.columns().zip(last).filter(|(column, _)| column.unit == "J")
}

/// The response to impactor `i`, which is `spec`.
fn figures(model: &Model, outcome: &Outcome, i: usize, spec: &scene::ImpactorSpec) -> ImpactFigures {
    let (end, fallen) = match (outcome.history.first(), outcome.history.last()) {
        (Some(first), Some(last)) => {
            let (from, to) = (&first.impactors[i], &last.impactors[i]);
            let fallen = to.impactor_displacement_m - from.impactor_displacement_m;
            ((last.time_s, to.impactor_velocity_m_s), fallen)
        }
        _ => ((0.0, 0.0), 0.0),
    };
    let struck = match &model.plan {
        Plan::Impact(impact) => model.thickness_at(impact.strikes[i].centre),
        _ => model.laminate.thickness(),
    };
    let weight = spec.mass * model.effects.nature().pull;
    let name = model.label(spec);
    let figures = ImpactFigures::new([spec.mass, spec.velocity], &outcome.contacts[i], end, struck);
    ImpactFigures {
        name: name.map(str::to_owned),
        start_time_s: name.map(|_| spec.start),
        impulse_N_s: figures.impulse_N_s + weight * end.0,
        absorbed_energy_J: figures.absorbed_energy_J + weight * fallen,
        squeeze_m_N: outcome.squeezes[i].map(|squeeze| squeeze.compliance),
        ..figures
    }
}

impl ImpactFigures {
    /// Of an only impactor of this mass and velocity, which nothing pulls: what its `contact` was, and the time and its velocity
    /// at the `end`, on a plate of this thickness.
    #[allow(non_snake_case)]
    pub(crate) fn new(
        [mass_kg, velocity_m_s]: [f64; 2],
        contact: &ContactRecord,
        end: (f64, f64),
        thickness: f64,
    ) -> Self {
        let (end_time_s, final_impactor_velocity_m_s) = end;
        let ContactRecord { force: (peak_force_N, peak_force_time_s), deflection, .. } = *contact;
        Self {
            name: None,
            mass_kg,
            velocity_m_s,
            energy_J: 0.5 * mass_kg * velocity_m_s.powi(2),
            start_time_s: None,
            end_time_s,
            peak_force_N,
            peak_force_time_s,
            peak_plate_displacement_m: deflection,
            peak_plate_displacement_over_thickness: deflection / thickness,
            peak_indentation_m: contact.deepest,
            dent_m: Some(contact.dent).filter(|dent| *dent > 0.0),
            contact_radius_m: Some(contact.radius).filter(|radius| *radius > 0.0),
            impulse_N_s: mass_kg * (velocity_m_s - final_impactor_velocity_m_s),
            final_impactor_velocity_m_s,
            absorbed_energy_J: 0.5 * mass_kg * (velocity_m_s.powi(2) - final_impactor_velocity_m_s.powi(2)),
            contacts: contact.count,
            contact_time_s: contact.duration,
            squeeze_m_N: None,
        }
    }
}

/// Largest indices of the modes that did not reach 1.
pub(crate) fn not_reached<'a>(peaks: &[Peak], region: impl Fn(usize) -> Option<&'a str>) -> Vec<MarginSummary> {
    let below = peaks.iter().filter(|peak| peak.index < 1.0);
    below.map(|peak| MarginSummary::new(peak, region(peak.site.cell as usize))).collect()
}

/// When each impactor first reached a delamination threshold, that of all interfaces (0) or of one delamination (1), and its name
/// where there are several.
pub(super) fn threshold_reached<'a>(
    model: &'a Model,
    outcome: &'a Outcome,
    which: usize,
) -> impl Iterator<Item = (f64, Option<&'a str>)> + use<'a> {
    let each = model.impactors().iter().zip(&outcome.contacts);
    each.filter_map(move |(impactor, contact)| Some((contact.threshold_times[which]?, model.label(impactor))))
}

/// Reserve factor of the stress of an event by its criterion, unless that has none.
pub(crate) fn reserve(criteria: &[NamedCriterion], materials: &[Material], event: &FailureEvent) -> Option<f64> {
    let (_, criterion) = criteria.iter().find(|(name, _)| *name == event.criterion)?;
    let material = &materials[usize::from(event.material)];
    Some(criterion.reserve_factor(&event.stress, material).factor).filter(|factor| factor.is_finite())
}

/// An event as tables and summaries hold it.
pub(super) fn event_row(model: &Model, event: &FailureEvent) -> EventRow {
    let angle_deg = match event.place {
        PlyOrInterface::Ply(k) => {
            model.laminates[model.plate.region(event.cell as usize)].plies[usize::from(k)].angle_deg
        }
        PlyOrInterface::Interface(_) => 0.0,
    };
    let [x_m, y_m, z_m] = event.position;
    EventRow {
        criterion: event.criterion.clone(),
        mode: event.mode.to_owned(),
        time_s: event.time,
        substructure: None,
        region: model.region_of(event.cell as usize).map(str::to_owned),
        cell: model.plate.plane.quad_tags[event.cell as usize],
        ply: name_ply(event.place),
        angle_deg,
        x_m,
        y_m,
        z_m,
        index: event.index,
    }
}
