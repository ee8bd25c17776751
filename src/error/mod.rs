//! What can go wrong between a scene and its results.

mod checkpoint;

pub use checkpoint::CheckpointError;
pub(crate) use checkpoint::WRITER;

use fem_core::assembly::{AssemblyError, EquilibriumError, FactorError};
use fem_core::element::ElementError;
use fem_core::material::MaterialError;
use fem_core::plugin::Dimension;
use fem_core::time::StepError;
use fem_dynamics::guard::Alarm;
use fem_failure::scan::ScanError;
use fem_io::files::FileError;
use fem_io::meshes::MeshError;
use fem_io::plot::PlotError;
use fem_io::scene::SceneError;
use miette::Diagnostic;
use std::path::PathBuf;

/// An error of the framework; those about the scene show its line.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum Error {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    #[error("cannot read the scene from standard input: {0}")]
    #[diagnostic(help("it must be UTF-8 and end"))]
    Input(std::io::Error),
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Deck(#[from] fem_io::deck::DeckError),
    #[error("the matrices cannot be assembled")]
    Assembly(#[from] AssemblyError),
    #[error("the substructures cannot be condensed")]
    Condensation(#[from] fem_core::assembly::CondensationError),
    #[error("the stresses cannot be recovered")]
    Element(#[from] ElementError),
    #[error("the model cannot be solved")]
    Solve(#[from] fem_core::structure::SolveError),
    #[error("an analysis of buckling needs `effects.preload`, and the scene has none")]
    NoPreload,
    #[error(
        "`effects.preload` buckles the plate{}",
        factor.map_or_else(String::new, |factor| format!(": at {factor:.4} of it the plate has no stiffness left"))
    )]
    #[diagnostic(help("lower the preload below that; analysis = \"buckling\" finds the load factors"))]
    Buckled {
        /// Factor on the preload, where it is among those nearest to zero.
        factor: Option<f64>,
    },
    #[error("the matrices cannot be analysed")]
    Factor(#[from] fem_core::assembly::FactorError),
    #[error("this takes about {needed} of memory, and {available} are free: {parts}")]
    #[diagnostic(help(
        "use fewer cells (a coarser mesh, a smaller `mesh.refine`), fewer `laminate.layers`, a `symmetry` of the \
         plate, `substructures`, or a machine with more memory; of histories a longer `output.history_every`, `failure.every` \
         and `march.step`, or a nearer `march.end`"
    ))]
    Memory {
        /// What it takes.
        needed: String,
        /// What there is.
        available: String,
        /// What takes it.
        parts: String,
    },
    #[error("the march failed")]
    #[diagnostic(help("{}", if matches!(.0, StepError::Factorisation(_)) { MATRIX } else { STEP }))]
    Step(#[from] StepError),
    #[error(transparent)]
    #[diagnostic(help("{}", remedy(.0)))]
    Guard(#[from] Alarm),
    #[error("the failure scan failed")]
    Scan(#[from] ScanError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error("there is nothing to resume: only an impact is marched in time")]
    #[diagnostic(help("run without `--resume`"))]
    NotMarched,
    #[error("the march was broken off at {}, {:.0} % of it", Dimension::TIME.of(*time), share * 1e2)]
    #[diagnostic(help("go on from the checkpoint in its folder, if it has one"))]
    Cancelled {
        /// Time reached, s.
        time: f64,
        /// Share of the steps done.
        share: f64,
    },
    #[error("the scene describes no impact")]
    #[diagnostic(help("set `analysis = \"impact\"` and describe impactor, contact and march"))]
    NoImpact,
    #[error("no plate can be kept for the impacts of this scene: they need more of it than its modes")]
    #[diagnostic(help(
        "give the scene a `reduction`, write \"on\" or \"off\" for effects that it leaves to the advisor, and leave out laws of plies \
         and interfaces that open; or run each impact by itself"
    ))]
    NotKept,
    #[error("`{key}` belongs to the plate, which is kept as it is")]
    #[diagnostic(help(
        "keep a plate of a scene with that value; on a plate the impactor may change but for its place and patch, the contact \
         law, and strengths"
    ))]
    OtherPlate {
        /// The first key that differs.
        key: String,
    },
    #[error("`{element}` is a section, and the advisor's formulas hold for plates only")]
    #[diagnostic(help(
        "write \"on\" or \"off\" where the scene says \"auto\", or use a plate and one of its elements, such as `mitc4`"
    ))]
    NoPlate {
        /// Name of the element.
        element: String,
    },
    #[error("the scene leaves effects to the advisor, which was not asked")]
    #[diagnostic(help("pass the model through `fem::advise::decided`, or write \"on\" or \"off\""))]
    Undecided,
    #[error("there is nothing to study: {0}")]
    Study(String),
    #[error("there is no axis `{name}`")]
    #[diagnostic(help("{help}"))]
    Axis {
        /// What was asked for.
        name: String,
        /// What there is.
        help: String,
    },
    #[error("{message}")]
    #[diagnostic(help("{help}"))]
    Sweep {
        /// What is wrong with it.
        message: String,
        /// What helps.
        help: String,
    },
    #[error("the ladders of the study have {together:.0} combinations of levels, too many to choose from")]
    #[diagnostic(help("name fewer of them with `--axis`, or give the scene's own axes fewer levels"))]
    TooManyLevels {
        /// How many.
        together: f64,
    },
    #[error("the march stopped: {0}")]
    Stopped(String),
    #[error("{load} pushes the plate where nothing but a restraint of rigid motions holds it")]
    #[diagnostic(help("support the plate against that motion{}", if *inertia { "" } else { ", or give it its inertia: effects.inertia = \"on\"" }))]
    Unheld {
        /// What pushes.
        load: &'static str,
        /// Whether the plate has inertia.
        inertia: bool,
    },
    #[error("the scene describes no static loads")]
    #[diagnostic(help("set `analysis = \"static\"` and give a `[[load]]`"))]
    NoLoads,
    #[error(transparent)]
    #[diagnostic(help("give it, or leave the effect out that needs it"))]
    Material(#[from] MaterialError),
    #[error("the element does not support large deflections")]
    #[diagnostic(help("use an element that does, such as `hermite-prism` or `mitc4`"))]
    SmallOnly,
    #[error("no equilibrium was found with large deflections")]
    #[diagnostic(help("{}", at_rest(.0)))]
    Equilibrium(#[from] EquilibriumError),
    #[error("no equilibrium was found in which the plies bear this load")]
    #[diagnostic(help(
        "lower it: at rest the plies are given all of the load at once, and what yields or breaks under it is not followed; an impact \
         follows it, and so do loads at rest beside `effects.delamination = \"growth\"`, step by step"
    ))]
    Softened(#[source] EquilibriumError),
    #[error("a {0} is not finite: the structure is singular, or a load is too large for floating-point numbers")]
    NotFinite(&'static str),
    #[error(
        "the loads are balanced to {residual:.1e} of their size only: the stiffness is too ill-conditioned for 16 \
         digits"
    )]
    #[diagnostic(help(
        "cells much wider than thick are stiff through their thickness and soft in bending: use the shell `mitc4`, or \
         fewer layers of narrower cells; springs that alone hold a plate have to be stiffer"
    ))]
    IllConditioned {
        /// ‖f − K u‖ / ‖f‖
        residual: f64,
    },
    #[error(transparent)]
    File(#[from] FileError),
    #[error("`{}` holds no results of `fem run`: there is no `summary.json` in it", folder.display())]
    #[diagnostic(help("name the folder that `fem run` printed after `results`"))]
    NoResults {
        /// The folder.
        folder: PathBuf,
    },
    #[error("`{}` is named twice: nothing differs", folder.display())]
    #[diagnostic(help("name each folder once"))]
    SameFolder {
        /// The folder.
        folder: PathBuf,
    },
    #[error("the page cannot be made")]
    Page(#[from] minijinja::Error),
    #[error("the plot failed")]
    Plot(#[from] PlotError),
}

const STEP: &str = "shorten `march.step`; on supports of the kind `rest` leave `march.integrator` out, elsewhere, where nothing separates, take `energy-conserving`";
const STEP_OR_LAW: &str = "shorten `march.step`; on supports of the kind `rest` leave `march.integrator` out, elsewhere, where nothing separates, take `energy-conserving`; if that changes nothing, look at the contact law: \
    `fem_core::testkit::check_contact_law` finds what is wrong with it";
const MATRIX: &str = "look at the supports, at the constants of the materials, at a `stiffness` of springs and at `delamination.penalty`, which may be too large, and at the \
     element if it is one of your own";
const LAW: &str = "look at the contact law: `fem_core::testkit::check_contact_law` finds what is wrong with it";

/// What helps where there is no equilibrium.
fn at_rest(error: &EquilibriumError) -> &'static str {
    match error {
        EquilibriumError::Factor(FactorError::NotPositive { .. }) => {
            "lower the load below the one that buckles the plate; if there is none in the plane, look at the supports: \
             they must stop every rigid motion"
        }
        EquilibriumError::NoConvergence(_) => "lower the load, or refine the mesh where the plate bends most",
        _ => MATRIX,
    }
}

/// What helps against an alarm.
fn remedy(alarm: &Alarm) -> &'static str {
    match alarm {
        Alarm::Pull { .. } => LAW,
        Alarm::NotFinite(_) | Alarm::Energy(0.0..) => STEP_OR_LAW,
        Alarm::Indefinite { .. } => MATRIX,
        _ => STEP,
    }
}
