//! What a static analysis says and writes.

mod files;
mod path;
mod plans;

pub use files::{ProfileTable, profile, write};
pub use path::PathFigures;

use crate::advise::hindsight_at_rest;
use crate::analyses::assembled::Substructures;
use crate::analyses::statics::{StaticSolution, Stressed, dof_of};
use crate::analyses::stress::Margin;
use crate::cost::Cost;
use crate::model::{Model, NamedProfile};
use crate::output::preload::PreloadFigures;
use crate::output::slopes::warn_of_slopes;
use crate::output::summary::{Advised, hindsights, placed};
use crate::words::{append, append_symmetry, describe_condition, warn_of_condition, warn_of_softness};
use fem_core::plugin::Dimension;
use fem_core::profile::{Choice, Resultants, Way};
use serde::Serialize;
use std::fmt::Write as _;

/// Residual beyond which it is worth a warning.
const NOTABLE_RESIDUAL: f64 = 1e-4;

fn warn_of_residual(residual: f64) -> Option<String> {
    (residual > NOTABLE_RESIDUAL).then(|| {
        format!(
            "the stiffness is ill-conditioned: the loads are balanced to {residual:.1e} of their size, and the \
             displacements are hardly better"
        )
    })
}

/// The summary of a static analysis; units are in the key names.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct StaticSummary {
    pub title: String,
    pub version: &'static str,
    /// [`fem_io::results::FORMAT`].
    pub format: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<&'static str>,
    pub unknowns: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub substructures: Option<Substructures>,
    pub factor_entries: usize,
    #[serde(flatten)]
    pub preload: PreloadFigures,
    pub resultant_N: [f64; 3],
    pub strain_energy_J: f64,
    pub largest_deflection: Deflection,
    #[serde(skip_serializing_if = "Option::is_none")]
    #[serde(rename = "large_displacements")]
    pub large_deflections: Option<Newton>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ply_laws: Option<LawsSummary>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<PathFigures>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub profiles: Vec<ProfileResultants>,
    pub margins: Vec<Margin>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub advised: Vec<Advised>,
    pub residual_relative: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub condition_estimate: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_error_relative: Option<f64>,
    pub elements: u64,
    pub elements_reused: u64,
    pub warnings: Vec<String>,
}

/// Largest deflection of a node, and where.
#[derive(Debug, Clone, Copy, Serialize)]
#[allow(missing_docs)]
pub struct Deflection {
    pub w_m: f64,
    pub x_m: f64,
    pub y_m: f64,
    pub z_m: f64,
}

/// How Newton's method ended.
#[derive(Debug, Clone, Copy, Serialize)]
#[allow(missing_docs)]
pub struct Newton {
    pub iterations: usize,
    /// Newton decrement over the work of the load: twice the relative error of the energy before the last step.
    pub last_decrement: f64,
}

/// How plies that follow laws were found, and what is lost in them.
#[derive(Debug, Clone, Copy, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct LawsSummary {
    #[serde(flatten)]
    pub newton: Newton,
    pub dissipated_J: f64,
}

/// Forces and moments per length at a profile: components 11, 22, 12, and 31, 23 of the shear force.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct ProfileResultants {
    pub name: String,
    pub x_m: f64,
    pub y_m: f64,
    pub N_N_per_m: [f64; 3],
    pub M_N: [f64; 3],
    pub Q_N_per_m: [f64; 2],
    pub szz_from: &'static str,
    pub szz_missed_relative: f64,
    pub shear_from: &'static str,
    pub shear_missed_relative: f64,
}

/// What to say of stresses in the plane that a linear plate leaves out.
fn warn_of_stresses(Stressed { takes, buckles }: Stressed) -> String {
    let takes = takes.map(|share| {
        let does = if share > 0.0 { "take" } else { "add" };
        format!("they would {does} some {:.0} % of its stiffness against this deflection", 100.0 * share.abs())
    });
    let buckles = buckles.map(|part| format!("{part:.2} of them buckle it"));
    let both: Vec<String> = takes.into_iter().chain(buckles).collect();
    format!(
        "loads or strains of cure act in the plane of a plate that is computed for small displacements: {}, which is left out; \
         effects.membrane = \"on\" has it",
        both.join(", and ")
    )
}

impl StaticSummary {
    /// Sums up a static analysis.
    pub fn new(model: &Model, solution: &StaticSolution) -> Self {
        let nodes = nodes(model, &solution.u);
        let largest = nodes.iter().max_by(|a, b| a.u[2].abs().total_cmp(&b.u[2].abs()));
        let [w_m, x_m, y_m, z_m] = largest.map_or([0.0; 4], |n| [n.u[2], n.x[0], n.x[1], n.x[2]]);
        let newton = solution.decrements.as_ref().map(|decrements| Newton {
            iterations: decrements.len(),
            last_decrement: decrements.last().copied().unwrap_or(0.0),
        });
        let path = solution.followed.as_ref().and_then(PathFigures::of);
        // What is followed through delaminations is known to be of small deflections.
        let seen =
            path.is_none().then(|| hindsights(model, |_| hindsight_at_rest(model, w_m, [x_m, y_m], solution.buckling)));
        let profiles = || model.profiles.iter().zip(&solution.transverse);
        Self {
            title: model.origin.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            format: fem_io::results::FORMAT,
            symmetry: model.plate.symmetry().name(),
            unknowns: solution.unknowns,
            substructures: solution.substructures,
            factor_entries: solution.factor_entries,
            preload: PreloadFigures::new(model, solution.buckling),
            resultant_N: solution.resultant,
            strain_energy_J: solution.strain_energy,
            largest_deflection: Deflection { w_m, x_m, y_m, z_m },
            large_deflections: newton.filter(|_| model.effects.nature().large),
            ply_laws: newton.zip(solution.dissipated).map(|(newton, lost)| LawsSummary { newton, dissipated_J: lost }),
            path: path.clone(),
            profiles: profiles().zip(&solution.resultants).map(in_summary).collect(),
            margins: solution.margins.clone(),
            advised: Advised::of(model, |_| None),
            residual_relative: solution.residual,
            condition_estimate: solution.condition,
            mesh_error_relative: solution.mesh_error,
            elements: solution.counters.elements,
            elements_reused: solution.counters.elements_reused,
            warnings: model
                .warnings
                .iter()
                .cloned()
                .chain(seen.iter().flatten().filter_map(|seen| seen.warning(model)))
                .chain(warn_of_residual(solution.residual))
                .chain(warn_of_slopes(model, w_m))
                .chain(solution.condition.and_then(warn_of_condition))
                .chain(path.iter().flat_map(PathFigures::warnings))
                .chain(solution.softness.map(warn_of_softness))
                .chain(solution.stressed.map(warn_of_stresses))
                .chain(profiles().flat_map(warn_of_transverse))
                .chain(solution.margins.iter().filter_map(|margin| {
                    let quad = model.plate.plane.quad_tags.iter().position(|tag| *tag == margin.cell)?;
                    placed(model, (&margin.criterion, &margin.mode, "margin"), quad, [margin.x_m, margin.y_m])
                }))
                .collect(),
        }
    }

    /// The summary as people read it.
    pub fn text(&self, cost: &Cost) -> String {
        let d = &self.largest_deflection;
        let mut t = format!(
            "{}\n  model     {} unknowns{}{}\n  loads     {} along x, y, z\n  \
             response  largest deflection {} at x, y, z = {}; strain energy {}\n",
            self.title,
            self.unknowns,
            append_symmetry(self.symmetry),
            append(self.substructures),
            Dimension::FORCE.list(&self.resultant_N),
            Dimension::LENGTH.of(d.w_m),
            Dimension::LENGTH.list(&[d.x_m, d.y_m, d.z_m]),
            Dimension::ENERGY.of(self.strain_energy_J)
        );
        self.preload.line().iter().for_each(|line| t.push_str(&format!("{line}\n")));
        if let Some(Newton { iterations, last_decrement }) = self.large_deflections {
            let _ = writeln!(
                t,
                "  membrane  large deflections, found in {iterations} Newton iterations (last decrement {last_decrement:.1e} of \
                 the work of the loads); reserve factors are those of the stresses, not of the loads"
            );
        }
        if let Some(LawsSummary { newton: Newton { iterations, last_decrement }, dissipated_J: lost }) = self.ply_laws {
            let _ = writeln!(
                t,
                "  plies     follow laws, found in {iterations} Newton iterations (last decrement {last_decrement:.1e} of the work \
                 of the loads); {} lost in them; reserve factors are those of the stresses, not of the loads",
                Dimension::ENERGY.of(lost)
            );
        }
        self.path.iter().flat_map(PathFigures::lines).for_each(|line| t.push_str(&format!("{line}\n")));
        for m in &self.margins {
            let _ = writeln!(
                t,
                "  margin    {} {}: reserve factor {:.4} in ply {} at x, y = {}",
                m.criterion,
                m.mode,
                m.reserve_factor,
                m.ply,
                Dimension::LENGTH.list(&[m.x_m, m.y_m])
            );
        }
        self.advised.iter().for_each(|advised| t.push_str(&format!("  advised   {advised}\n")));
        let mesh = self.mesh_error_relative.map_or(String::new(), |error| {
            format!("; mesh about {:.2} % in the energy norm (strains against a smooth fit of them)", 100.0 * error)
        });
        let condition = self.condition_estimate.map_or(String::new(), |c| format!("; {}", describe_condition(c)));
        let _ = writeln!(t, "  accuracy  residual {:.1e} of the loads{condition}{mesh}", self.residual_relative);
        let what = if self.large_deflections.is_some() { "integrations of cells" } else { "element matrices" };
        let _ = writeln!(t, "  work      {} {what}, {} reused", self.elements, self.elements_reused);
        let _ = writeln!(t, "  time      {cost}");
        self.warnings.iter().for_each(|w| t.push_str(&format!("  warning   {w}\n")));
        t
    }
}

/// Share of a transverse stress that may be missed without a word.
const NOTABLE_MISS: f64 = 0.05;

fn warn_of_transverse((named, [normal, shear]): (&NamedProfile, &[Choice; 2])) -> Vec<String> {
    let stresses = [("\u{3c3}zz", *normal), ("transverse shear", *shear)];
    let missed = stresses.into_iter().filter(|(_, choice)| choice.missed > NOTABLE_MISS);
    let tell = |(name, Choice { way, missed }): (&str, Choice)| {
        let what = match way {
            Way::Strains => "jumps between plies, or differs from what acts on a face, by",
            Way::Equilibrium => "follows from in-plane stresses whose changes from cell to cell a cubic misses by",
        };
        format!(
            "profile `{}`: {name}, from {}, {what} {:.0} % and is about as wrong: use smaller cells around it",
            named.line.name.value,
            way.name(),
            100.0 * missed
        )
    };
    missed.map(tell).collect()
}

fn in_summary(
    ((named, [normal, shear]), resultants): ((&NamedProfile, &[Choice; 2]), &Resultants),
) -> ProfileResultants {
    ProfileResultants {
        name: named.line.name.value.clone(),
        x_m: named.point[0],
        y_m: named.point[1],
        N_N_per_m: resultants.membrane,
        M_N: resultants.bending,
        Q_N_per_m: resultants.shear,
        szz_from: normal.way.name(),
        szz_missed_relative: normal.missed,
        shear_from: shear.way.name(),
        shear_missed_relative: shear.missed,
    }
}

/// A node with its displacement.
#[derive(Debug, Clone, PartialEq)]
pub struct MovedNode {
    /// Its number in the mesh file.
    pub tag: u64,
    /// Its place, m.
    pub x: [f64; 3],
    /// Its displacement, m.
    pub u: [f64; 3],
}

/// The nodes above and below each other at the vertices of the mesh, at the outermost levels and the mid-plane: the rows of
/// `displacements.csv`.
pub fn nodes(model: &Model, u: &[f64]) -> Vec<MovedNode> {
    let plate = &model.plate;
    let levels = |column: usize| {
        let mut levels = plate.outer_levels(column).to_vec();
        levels.extend(plate.mid_level());
        levels.sort_unstable();
        levels.dedup();
        levels
    };
    let at = |column: usize, level: usize| -> Option<MovedNode> {
        let value = |n: u8| plate.dofs_at(column, level, dof_of(n)).next().map(|d| u[d]);
        let all = [1, 2, 3].map(value);
        all.iter().any(Option::is_some).then(|| MovedNode {
            tag: plate.plane.node_tags.get(column).copied().unwrap_or(0),
            x: [plate.columns[column][0], plate.columns[column][1], plate.levels[level]],
            u: all.map(|v| v.unwrap_or(0.0)),
        })
    };
    (0..plate.columns.len()).flat_map(|c| levels(c).into_iter().filter_map(move |l| at(c, l))).collect()
}
