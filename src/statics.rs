//! Displacements, stresses and margins under loads at rest.

use crate::cost::{Cost, Phase, Stopwatch};
use crate::error::Error;
use crate::memory;
use crate::model::{Model, NamedProfile, Plan};
use crate::run::{self, Substructures};
use crate::stress::{self, Margin};
use crate::summary::{Advised, and, in_words};
use fem_core::assembly::{LargePlate, free_forces, pattern};
use fem_core::counters::Counters;
use fem_core::dof::Dof;
use fem_core::element::ElementError;
use fem_core::estimate::mesh_error;
use fem_core::field::Field as Displacements;
use fem_core::profile::{ProfilePoint, Resultants};
use fem_core::reduction::Functional;
use fem_core::structure::Structure;
use fem_io::files::OutputDir;
use fem_io::plot::{self, Axis, LinePlot, Series, Style};
use fem_io::tables::{self, Field};
use serde::Serialize;
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Residual of the loads beyond which displacements are no result: they are about as wrong, for rounding in K alone.
const MOST_RESIDUAL: f64 = 1e-2;

/// Residual beyond which it is worth a warning.
const NOTABLE_RESIDUAL: f64 = 1e-4;

/// Condition of the stiffness beyond which its digits are worth a warning: six of 16 are left.
const NOTABLE_CONDITION: f64 = 1e10;

/// What a static analysis found.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Displacements, before elimination of constraints; one per unknown.
    pub u: Vec<f64>,
    /// Independent unknowns.
    pub unknowns: usize,
    /// How the plate is divided, if it is.
    pub substructures: Option<Substructures>,
    /// Entries of the factor of K.
    pub factor_entries: usize,
    /// ½ uᵀ K u, J, or ½ ∫ Eᵀ C E dV.
    pub strain_energy: f64,
    /// ‖f − K u‖ / ‖f‖ of the independent unknowns, K u being the internal force.
    pub residual: f64,
    /// Condition number of K, or of its tangent at the end, estimated
    /// ([`condition`](fem_core::assembly::SparseStructure::condition)).
    pub condition: f64,
    /// Under large displacements, the Newton decrement of each iteration
    /// ([`Equilibrium::decrements`](fem_core::assembly::Equilibrium::decrements)).
    pub decrements: Option<Vec<f64>>,
    /// Error of the mesh in the energy norm, relative, where [`mesh_error`] can say; never under large
    /// displacements or with free strains.
    pub mesh_error: Option<f64>,
    /// Sum of the loads along x, y, z, N.
    pub resultant: [f64; 3],
    /// Per criterion, the smallest reserve factor and where.
    pub margins: Vec<Margin>,
    /// The states along the profiles of the model.
    pub profiles: Vec<Vec<ProfilePoint>>,
    /// Forces and moments per length at each of them.
    pub resultants: Vec<Resultants>,
    /// Work done.
    pub counters: Counters,
    /// Time per phase.
    pub phases: Vec<Phase>,
}

/// Displacements of the independent unknowns, and how they were found.
struct Found {
    independent: Vec<f64>,
    substructures: Option<Substructures>,
    factor_entries: usize,
    strain_energy: f64,
    residual: f64,
    condition: f64,
    decrements: Option<Vec<f64>>,
}

/// Solves K u = f, or f(u) = f where the model has large displacements.
///
/// # Errors
/// A scene without loads at rest, a cell that the element refuses, a structure that is not held, buckles or is too
/// ill-conditioned, a result that is not finite, a criterion whose material lacks a constant.
pub fn solve(model: &Model, threads: NonZeroUsize) -> Result<Solution, Error> {
    let Plan::Static { forces } = &model.plan else { return Err(Error::NoLoads) };
    if model.undecided() {
        return Err(Error::Undecided);
    }
    let mut stopwatch = Stopwatch::default();
    let mut counters = Counters::default();
    let constraints = &model.constraints;
    // u = C ũ + g, so that Cᵀ K C ũ = Cᵀ f; supports hold at zero, g = 0.
    let nodal: Vec<(usize, f64)> = forces.iter().copied().enumerate().filter(|(_, force)| *force != 0.0).collect();
    let mut f = vec![0.0; constraints.ndof()];
    Functional(constraints.restrict(&nodal)).add_to(1.0, &mut f);
    let resultant = [1, 2, 3].map(|n| {
        let along = |(dof, f): (usize, &f64)| if model.plate.locate(dof).2 == dof_of(n) { *f } else { 0.0 };
        forces.iter().enumerate().map(along).sum()
    });
    let solver = if model.effects.membrane { nonlinear } else { linear };
    let found = solver(model, &f, threads, &mut counters, &mut stopwatch)?;
    if !found.strain_energy.is_finite() {
        return Err(Error::NotFinite("displacement"));
    }
    if !(found.residual <= MOST_RESIDUAL) {
        return Err(Error::IllConditioned { residual: found.residual });
    }
    let mut u = vec![0.0; model.plate.ndof()];
    constraints.expand(&found.independent, &mut u);
    stopwatch.lap("solve");
    let margins = stress::margins(model, &u)?;
    let mut field = Displacements::new(&model.plate, &model.laminate, &*model.element, &u);
    if model.effects.membrane {
        field = field.with_large_strains();
    }
    let sample = |named: &NamedProfile| {
        let line = &named.line;
        let bottom = line.equilibrium.then_some(named.bottom);
        Ok((named.profile.sample(&field, line.points, bottom)?, named.profile.resultants(&field)?))
    };
    let sampled: Vec<_> = model.profiles.iter().map(sample).collect::<Result<_, ElementError>>()?;
    let (profiles, resultants) = sampled.into_iter().unzip();
    stopwatch.lap("stresses");
    // The estimate knows no strains but those that stress.
    let mesh_error = if model.effects.membrane || model.effects.cure.is_some() {
        None
    } else {
        mesh_error(&model.plate, &*model.element, &u)?
    };
    stopwatch.lap("mesh error");
    let phases = stopwatch.phases().to_vec();
    Ok(Solution {
        unknowns: constraints.ndof(),
        substructures: found.substructures,
        factor_entries: found.factor_entries,
        strain_energy: found.strain_energy,
        residual: found.residual,
        condition: found.condition,
        decrements: found.decrements,
        u,
        mesh_error,
        resultant,
        margins,
        profiles,
        resultants,
        counters,
        phases,
    })
}

/// Small displacements.
fn linear(
    model: &Model,
    f: &[f64],
    threads: NonZeroUsize,
    counters: &mut Counters,
    stopwatch: &mut Stopwatch,
) -> Result<Found, Error> {
    let mut assembled = run::structure(model, false, threads, counters)?;
    stopwatch.lap("assemble");
    let (mut f, mut thermal, mut at_rest) = (f.to_vec(), vec![0.0; f.len()], 0.0);
    if model.effects.cure.is_some() {
        let (forces, energy) = free_forces(&model.plate, &*model.element, &model.constraints)?;
        f.iter_mut().zip(&forces).for_each(|(f, free)| *f += free);
        (thermal, at_rest) = (forces, energy);
    }
    let (mut rest, own) = assembled.load(&f);
    let mut solved = rest.clone();
    assembled.structure.solve_shifted(0.0, &mut solved, 1)?;
    assembled.structure.add_stiffness(-1.0, &solved, &mut rest);
    // One step of iterative refinement, for a solve beside the factor.
    let mut more = rest.clone();
    assembled.structure.solve_shifted(0.0, &mut more, 1)?;
    assembled.structure.add_stiffness(-1.0, &more, &mut rest);
    solved.iter_mut().zip(&more).for_each(|(u, more)| *u += more);
    let mut independent = assembled.expand(solved);
    independent.iter_mut().zip(own.iter().flatten()).for_each(|(u, own)| *u += own);
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let condition = assembled.structure.condition()?;
    (counters.factorisations, counters.solves) = assembled.structure.work();
    Ok(Found {
        // ½ uᵀ K u − uᵀ f₀ + ½ ∫ ε₀ C ε₀ dV with K u = f and f₀ that of the free strains.
        strain_energy: at_rest
            + f.iter().zip(&thermal).zip(&independent).map(|((f, free), u)| (0.5 * f - free) * u).sum::<f64>(),
        independent,
        substructures: assembled.substructures(),
        factor_entries: assembled.factor_entries,
        residual: norm(&rest) / norm(&f).max(f64::MIN_POSITIVE),
        condition,
        decrements: None,
    })
}

/// Large displacements.
fn nonlinear(
    model: &Model,
    f: &[f64],
    threads: NonZeroUsize,
    counters: &mut Counters,
    stopwatch: &mut Stopwatch,
) -> Result<Found, Error> {
    let Model { plate, element, constraints, .. } = model;
    let pattern = Arc::new(pattern(plate, constraints));
    let (symbolic, _) = memory::analysed(model, pattern.clone())?;
    let factor_entries = symbolic.entries();
    let mut large = LargePlate::new(plate, element.clone(), constraints, &pattern).ok_or(Error::SmallOnly)?;
    // A plate that is hot and has not moved is pressed in its plane more than it bears.
    let start = match model.effects.cure {
        Some(_) => linear(model, f, threads, counters, stopwatch)?.independent,
        None => vec![0.0; f.len()],
    };
    let found = large.equilibrium(symbolic, f, start, threads)?;
    counters.elements += large.integrated();
    counters.factorisations += found.decrements.len() as u64;
    counters.solves += found.solves;
    Ok(Found {
        independent: found.u,
        substructures: None,
        factor_entries,
        strain_energy: found.energy,
        residual: found.residual,
        condition: found.condition,
        decrements: Some(found.decrements),
    })
}

fn notable(residual: f64) -> Option<String> {
    (residual > NOTABLE_RESIDUAL).then(|| {
        format!("the stiffness is ill-conditioned: the loads are met to {residual:.1e} of their size, displacements hardly better")
    })
}

/// What the condition of the stiffness costs, in words.
pub(crate) fn digits(condition: f64) -> String {
    let lost = condition.log10().clamp(0.0, 16.0);
    format!("condition {condition:.1e}: rounding costs up to {lost:.0} of 16 digits")
}

/// A warning of a condition that leaves few digits.
pub(crate) fn few_digits(condition: f64) -> Option<String> {
    let enough = condition <= NOTABLE_CONDITION;
    (!enough).then(|| {
        format!(
            "the stiffness has the {}: supports that all but leave a motion free, cells much wider than thick and moduli far \
             apart do that",
            digits(condition)
        )
    })
}

fn dof_of(n: u8) -> Dof {
    Dof::SOLID[4 * (usize::from(n) - 1)]
}

/// The summary of a static analysis; units are in the key names.
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
    pub factor_entries: usize,
    pub resultant_N: [f64; 3],
    pub strain_energy_J: f64,
    pub largest_deflection: Deflection,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub large_displacements: Option<Newton>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub profiles: Vec<ProfileResultants>,
    pub margins: Vec<Margin>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub advised: Vec<Advised>,
    pub residual_relative: f64,
    pub condition_estimate: f64,
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

/// How large displacements were found.
#[derive(Debug, Clone, Copy, Serialize)]
#[allow(missing_docs)]
pub struct Newton {
    pub iterations: usize,
    /// Newton decrement over the work of the load: twice the relative error of the energy before the last step.
    pub last_decrement: f64,
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
}

impl Summary {
    /// Sums up a static analysis.
    pub fn new(model: &Model, solution: &Solution) -> Self {
        let nodes = nodes(model, &solution.u);
        let largest = nodes.iter().max_by(|a, b| a.u[2].abs().total_cmp(&b.u[2].abs()));
        let [w_m, x_m, y_m, z_m] = largest.map_or([0.0; 4], |n| [n.u[2], n.x[0], n.x[1], n.x[2]]);
        Self {
            title: model.scene.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            symmetry: model.plate.symmetry().name(),
            unknowns: solution.unknowns,
            substructures: solution.substructures,
            factor_entries: solution.factor_entries,
            resultant_N: solution.resultant,
            strain_energy_J: solution.strain_energy,
            largest_deflection: Deflection { w_m, x_m, y_m, z_m },
            large_displacements: solution.decrements.as_ref().map(|decrements| Newton {
                iterations: decrements.len(),
                last_decrement: decrements.last().copied().unwrap_or(0.0),
            }),
            profiles: model.profiles.iter().zip(&solution.resultants).map(in_summary).collect(),
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
                .chain(notable(solution.residual))
                .chain(few_digits(solution.condition))
                .collect(),
        }
    }

    /// The summary as people read it.
    pub fn text(&self, cost: &Cost) -> String {
        let d = &self.largest_deflection;
        let [fx, fy, fz] = self.resultant_N;
        let mut t = format!(
            "{}\n  model     {} unknowns{}{}\n  loads     {fx:.4}, {fy:.4}, {fz:.4} N along x, y, z\n  \
             response  largest deflection {:.6} mm at ({:.4}, {:.4}, {:.4}) mm; strain energy {:.6e} J\n",
            self.title,
            self.unknowns,
            in_words(self.symmetry),
            and(self.substructures),
            d.w_m * 1e3,
            d.x_m * 1e3,
            d.y_m * 1e3,
            d.z_m * 1e3,
            self.strain_energy_J
        );
        if let Some(Newton { iterations, last_decrement }) = self.large_displacements {
            let _ = writeln!(
                t,
                "  membrane  large displacements, found in {iterations} Newton iterations (last decrement {last_decrement:.1e} of \
                 the work of the loads); reserve factors are those of the stresses, not of the loads"
            );
        }
        for m in &self.margins {
            let _ = writeln!(
                t,
                "  margin    {} {}: reserve factor {:.4} in ply {} at ({:.3}, {:.3}) mm",
                m.criterion,
                m.mode,
                m.reserve_factor,
                m.ply,
                m.x_m * 1e3,
                m.y_m * 1e3
            );
        }
        self.advised.iter().for_each(|advised| t.push_str(&format!("  advised   {advised}\n")));
        let mesh = self.mesh_error_relative.map_or(String::new(), |error| {
            format!("; mesh about {:.2} % in the energy norm (strains against a smooth fit of them)", 100.0 * error)
        });
        let (residual, condition) = (self.residual_relative, digits(self.condition_estimate));
        let _ = writeln!(t, "  accuracy  residual {residual:.1e} of the loads; {condition}{mesh}");
        let what = if self.large_displacements.is_some() { "integrations of cells" } else { "element matrices" };
        let _ = writeln!(t, "  work      {} {what}, {} reused", self.elements, self.elements_reused);
        let _ = writeln!(t, "  time      {cost}");
        self.warnings.iter().for_each(|w| t.push_str(&format!("  warning   {w}\n")));
        t
    }
}

fn in_summary((named, resultants): (&NamedProfile, &Resultants)) -> ProfileResultants {
    ProfileResultants {
        name: named.line.name.value.clone(),
        x_m: named.point[0],
        y_m: named.point[1],
        N_N_per_m: resultants.membrane,
        M_N: resultants.bending,
        Q_N_per_m: resultants.shear,
    }
}

/// A node with its displacement.
struct Node {
    tag: u64,
    x: [f64; 3],
    u: [f64; 3],
}

/// The nodes above and below each other at the vertices of the mesh, at the outermost levels and the mid-plane.
fn nodes(model: &Model, u: &[f64]) -> Vec<Node> {
    let plate = &model.plate;
    let mut levels = plate.outer_levels().to_vec();
    levels.extend(plate.mid_level());
    levels.sort_unstable();
    levels.dedup();
    let at = |column: usize, level: usize| -> Option<Node> {
        let value = |n: u8| plate.dofs_at(column, level, dof_of(n)).next().map(|d| u[d]);
        let all = [1, 2, 3].map(value);
        all.iter().any(Option::is_some).then(|| Node {
            tag: plate.plane.node_tags.get(column).copied().unwrap_or(0),
            x: [plate.columns[column][0], plate.columns[column][1], plate.levels[level]],
            u: all.map(|v| v.unwrap_or(0.0)),
        })
    };
    (0..plate.columns.len()).flat_map(|c| levels.iter().filter_map(move |l| at(c, *l))).collect()
}

/// Writes `summary.json`, `displacements.csv` and, per profile, `profile-<name>.csv` with pictures.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite.
pub fn write(dir: &OutputDir, model: &Model, solution: &Solution, summary: &Summary) -> Result<(), Error> {
    tables::write_json(dir, "summary.json", summary)?;
    let nodes = nodes(model, &solution.u);
    let row = |n: &Node| {
        let numbers = n.x.into_iter().chain(n.u).map(Field::Number);
        [Field::Count(n.tag)].into_iter().chain(numbers).collect()
    };
    let header = ["node", "x_m", "y_m", "z_m", "u_m", "v_m", "w_m"];
    tables::write_columns(dir, "displacements.csv", &header, nodes.iter().map(row))?;
    for (named, points) in model.profiles.iter().zip(&solution.profiles) {
        write_profile(dir, model, named, points)?;
    }
    Ok(())
}

const PROFILE: [&str; 18] = [
    "z_m",
    "ply",
    "angle_deg",
    "u_m",
    "v_m",
    "w_m",
    "sxx_Pa",
    "syy_Pa",
    "szz_Pa",
    "sxy_Pa",
    "syz_Pa",
    "szx_Pa",
    "s1_Pa",
    "s2_Pa",
    "s3_Pa",
    "s12_Pa",
    "s23_Pa",
    "s13_Pa",
];
const EQUILIBRIUM: [&str; 3] = ["szz_equilibrium_Pa", "syz_equilibrium_Pa", "szx_equilibrium_Pa"];

fn write_profile(dir: &OutputDir, model: &Model, named: &NamedProfile, points: &[ProfilePoint]) -> Result<(), Error> {
    let name = &named.line.name.value;
    let mut header = PROFILE.to_vec();
    if named.line.equilibrium {
        header.extend(EQUILIBRIUM);
    }
    let row = |p: &ProfilePoint| {
        let mut row = vec![
            Field::Number(p.z),
            Field::Count(p.ply as u64 + 1),
            Field::Number(model.laminate.plies[p.ply].angle_deg),
        ];
        let numbers = p.displacement.into_iter().chain(p.global.0).chain(p.in_ply.0);
        row.extend(numbers.chain(p.equilibrium.into_iter().flatten()).map(Field::Number));
        row
    };
    tables::write_columns(dir, &format!("profile-{name}.csv"), &header, points.iter().map(row))?;
    if !model.scene.output.plots {
        return Ok(());
    }
    // In-plane and transverse stresses differ by orders of magnitude: a picture each.
    let in_plane = [("\u{3c3}xx", 0), ("\u{3c3}yy", 1), ("\u{3c4}xy", 3)];
    let transverse = [("\u{3c4}zx", 5), ("\u{3c4}yz", 4), ("\u{3c3}zz", 2)];
    for (suffix, components) in [("in-plane", in_plane), ("transverse", transverse)] {
        let series = |(label, k): (&str, usize)| Series {
            label: label.into(),
            points: points.iter().map(|p| (p.global.0[k] * 1e-6, p.z * 1e3)).collect(),
            style: Style::Solid,
        };
        let picture = plot::line_plot(&LinePlot {
            title: format!("{}: {name}", model.scene.title),
            x: Axis::linear(format!("Stress, {suffix}"), "MPa"),
            y: Axis::linear("Height", "mm"),
            series: components.map(series).to_vec(),
            marks: Vec::new(),
        })?;
        dir.write(&format!("profile-{name}-{suffix}.svg"), |w| w.write_all(picture.svg.as_bytes()))?;
        dir.write(&format!("profile-{name}-{suffix}.png"), |w| w.write_all(&picture.png))?;
    }
    Ok(())
}
