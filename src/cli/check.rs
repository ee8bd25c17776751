//! `fem check`.

use super::{Console, Format, SceneFile};
use crate::advise;
use crate::analyses::assembled::{self, Substructures};
use crate::analyses::impact::{self, Sizes};
use crate::error::Error;
use crate::forecast::MemoryEstimate;
use crate::model::{Impact, Model, Plan};
use crate::output::fields;
use crate::output::summary::Advised;
use crate::registry::Registry;
use crate::words::{append_symmetry, describe_condition, warn_of_condition, warn_of_softness};
use clap::Args;
use fem_core::counters::Counters;
use fem_core::laminate::Laminate;
use fem_core::plugin::Dimension;
use fem_core::time::StepLimit;
use fem_io::scene::{self, Explained};
use serde::Serialize;
use std::fmt::{self, Display, Write as _};
use std::num::NonZeroUsize;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fem check coupon/scene.toml\n  fem check coupon/scene.toml --full\n  fem check coupon/scene.toml --explain | less"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneFile,
    /// Assembles and reduces the plate as a run does: whether supports hold it, what the advisor answers, frequencies, the longest
    /// stable step. It takes seconds, of large plates more.
    #[arg(long)]
    full: bool,
    /// Prints every key that holds: its value, where that comes from (a line of the scene, the preset, a library, a
    /// default) and what it means.
    #[arg(long)]
    explain: bool,
    #[command(flatten)]
    format: Format,
}

pub(super) fn check(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let checked = sizes(registry, arguments, console)?;
    console.show(arguments.format, &checked, || checked.text())?;
    Ok(ExitCode::SUCCESS)
}

/// What a check finds; units are in the key names.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct Checked {
    title: String,
    #[serde(skip)]
    shape: &'static str,
    quads: usize,
    nodes: usize,
    groups: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    symmetry: Option<&'static str>,
    plies: usize,
    thickness_mm: f64,
    layers: usize,
    /// Regions, where plies of one number do not lie at one height in all of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    regions: Vec<RegionSize>,
    unknowns: usize,
    unknowns_before_constraints: usize,
    redundant_equations: usize,
    /// What each support holds, where that is explained.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    supports: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    memory_MB: Option<f64>,
    #[serde(skip)]
    memory: Option<MemoryEstimate>,
    #[serde(skip_serializing_if = "Option::is_none")]
    substructures: Option<Substructures>,
    #[serde(skip_serializing_if = "Option::is_none")]
    march: Option<MarchDocument>,
    /// Estimate of the condition of the stiffness, of a plate at rest that is held.
    #[serde(skip_serializing_if = "Option::is_none")]
    condition: Option<f64>,
    /// How many modes are found, where these are the analysis.
    #[serde(skip_serializing_if = "Option::is_none")]
    modes: Option<usize>,
    /// How many load factors of buckling are found, where these are the analysis.
    #[serde(skip_serializing_if = "Option::is_none")]
    load_factors: Option<usize>,
    criteria: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    fields: Option<fields::Expected>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    advised: Vec<Advised>,
    warnings: Vec<String>,
    /// What only the stiffness tells.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    not_looked_at: Vec<&'static str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    keys: Vec<Explained>,
}

/// A region of a plate whose regions differ in their heights.
#[derive(Serialize)]
struct RegionSize {
    name: String,
    quads: usize,
    plies: usize,
    /// Heights of its faces.
    z_mm: [f64; 2],
    layers: usize,
}

impl RegionSize {
    fn all(model: &Model) -> Vec<Self> {
        let plate = &model.plate;
        let of = |(region, (name, laminate)): (usize, (&String, &Laminate))| {
            let z = laminate.boundaries();
            Self {
                name: name.clone(),
                quads: (0..plate.plane.quads.len()).filter(|quad| plate.region(*quad) == region).count(),
                plies: laminate.plies.len(),
                z_mm: [z[0], z[z.len() - 1]].map(|z| z * 1e3),
                layers: laminate.layers.len(),
            }
        };
        model.region_names.iter().zip(&model.laminates).enumerate().map(of).collect()
    }
}

/// "`patch`: 16 plies in 3 layers of cells, z from -1.04 mm to 1.04 mm, over 24 of the mesh".
impl Display for RegionSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, quads, plies, z_mm, layers } = self;
        let [low, high] = z_mm.map(|z| Dimension::LENGTH.of(z * 1e-3));
        write!(
            f,
            "`{name}`: {plies} plies in {layers} layers of cells, z from {low} to {high}, over {quads} of the mesh"
        )
    }
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct MarchDocument {
    #[serde(skip_serializing_if = "Option::is_none")]
    static_stiffness_N_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lowest_frequency_Hz: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    highest_frequency_Hz: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unknowns_marched: Option<usize>,
    steps: u64,
    step_s: f64,
    end_s: f64,
    integrator: String,
    /// Longest stable step; absent where there is no limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    longest_step_s: Option<f64>,
}

impl MarchDocument {
    /// With `sizes` where these are known.
    fn new(impact: &Impact, sizes: Option<&Sizes>) -> Self {
        let spec = &impact.spec.march;
        let (steps, step_s) = spec.steps();
        Self {
            static_stiffness_N_m: sizes.map(|sizes| sizes.static_stiffness),
            lowest_frequency_Hz: sizes.and_then(|sizes| sizes.lowest_frequency),
            highest_frequency_Hz: sizes.and_then(|sizes| sizes.highest_frequency),
            unknowns_marched: sizes.map(|sizes| sizes.marched),
            steps,
            step_s,
            end_s: spec.end.value,
            integrator: spec.integrator.name.value.clone(),
            longest_step_s: sizes.map(|sizes| sizes.longest_step).filter(|step| step.is_finite()),
        }
    }

    fn lines(&self) -> Vec<Line> {
        let [step, end] = [self.step_s, self.end_s].map(|time| Dimension::TIME.of(time));
        let steps = format!("{} steps of {step} to {end} with {}", self.steps, self.integrator);
        let (Some(stiffness), Some(unknowns)) = (self.static_stiffness_N_m, self.unknowns_marched) else {
            return vec![("march", steps)];
        };
        let known = [("lowest excited", self.lowest_frequency_Hz), ("highest", self.highest_frequency_Hz)];
        let known: Vec<_> =
            known.iter().filter_map(|(name, f)| Some(format!("{name} {}", Dimension::FREQUENCY.of((*f)?)))).collect();
        let stable = match self.longest_step_s {
            Some(step) => format!("stable up to {}", Dimension::TIME.of(step)),
            None => "no stability limit".to_owned(),
        };
        let stiffness = Dimension::FORCE.of(stiffness * 1e-3);
        vec![
            ("contact", format!("static stiffness of the plate {stiffness}/mm")),
            ("frequency", if known.is_empty() { "the march needs none".into() } else { known.join(", ") }),
            ("march", format!("{unknowns} unknowns, {steps} ({stable})")),
        ]
    }
}

/// What is known of a model before it is computed.
struct Found {
    memory: Option<MemoryEstimate>,
    substructures: Option<Substructures>,
    /// Of a march.
    sizes: Option<Sizes>,
    /// Of the stiffness of a plate at rest.
    condition: Option<f64>,
}

impl Found {
    fn without_stiffness(model: &Model) -> Result<Self, Error> {
        let memory = assembled::expected_memory(model)?;
        Ok(Self { memory, substructures: None, sizes: None, condition: None })
    }

    fn with_stiffness(model: &Model) -> Result<Self, Error> {
        if let Plan::Impact(_) = &model.plan {
            let sizes = impact::prepare(model, NonZeroUsize::MIN)?.sizes;
            let (memory, substructures) = (Some(sizes.memory), sizes.substructures);
            return Ok(Self { memory, substructures, sizes: Some(sizes), condition: None });
        }
        let counters = &mut Counters::default();
        let mut assembled = match &model.plan {
            Plan::Buckling { .. } => assembled::elastic(model, false, NonZeroUsize::MIN, counters)?,
            _ => assembled::structure(model, true, NonZeroUsize::MIN, counters)?,
        };
        let condition = if model.held { Some(assembled.structure.condition()?) } else { None };
        Ok(Self { memory: Some(assembled.memory), substructures: assembled.substructures(), sizes: None, condition })
    }
}

/// What only the stiffness of `model` tells.
fn unseen(model: &Model) -> Vec<&'static str> {
    let decided = !model.effects.undecided() && model.grown.is_none();
    let advised = Some("which effects the advisor turns on").filter(|_| !decided);
    let of_plan: &[_] = match &model.plan {
        Plan::Impact(impact) if impact.integrator.limit() == StepLimit::None => &["frequencies"],
        Plan::Impact(_) => &["frequencies", "the longest stable step"],
        Plan::Static { .. } | Plan::Modes { .. } | Plan::Buckling { .. } => &["the condition of the stiffness"],
    };
    let loaded = model.effects.edges().is_some() && !matches!(model.plan, Plan::Buckling { .. });
    let buckles = Some("whether the preload buckles it").filter(|_| loaded);
    ["whether the supports hold the plate"]
        .into_iter()
        .chain(buckles)
        .chain(advised)
        .chain(of_plan.iter().copied())
        .collect()
}

fn sizes(registry: &Registry, arguments: &Arguments, console: &Console) -> Result<Checked, Error> {
    let scene = arguments.scene.read()?;
    let keys = if arguments.explain {
        scene::explain(&scene.source, &|kind| registry.choices(kind), &registry.effect_keys())?
    } else {
        vec![]
    };
    let mut model = Model::new(scene, registry)?;
    let found = if arguments.full {
        model = advise::decided(model, NonZeroUsize::MIN)?;
        Found::with_stiffness(&model).inspect_err(|_| console.warn(&model.warnings))?
    } else {
        Found::without_stiffness(&model).inspect_err(|_| console.warn(&model.warnings))?
    };
    let Found { memory, substructures, sizes, condition } = found;
    let march = match &model.plan {
        Plan::Impact(impact) => Some(MarchDocument::new(impact, sizes.as_ref())),
        _ => None,
    };
    let (modes, load_factors) = match &model.plan {
        Plan::Modes { count } => (Some(*count), None),
        Plan::Buckling { count } => (None, Some(*count)),
        _ => (None, None),
    };
    let asked = model.output.fields.as_ref();
    let frames = march.as_ref().map_or(modes.or(load_factors).unwrap_or(1), |march| {
        impact::frames(asked, asked.and_then(|asked| asked.every), (march.steps, march.step_s)).len()
    });
    let not_looked_at = if arguments.full { Vec::new() } else { unseen(&model) };
    let plane = &model.plate.plane;
    let coarse = advise::expect_coarse_cells(&model);
    let at_rest = arguments.full && sizes.is_none() && !model.between.is_empty();
    let softer = at_rest.then(|| SOFTER.to_owned());
    Ok(Checked {
        title: model.origin.title.clone(),
        shape: plane.name_of_cells(),
        quads: plane.quads.len(),
        nodes: plane.points.len(),
        groups: plane.groups.keys().cloned().collect(),
        symmetry: model.plate.symmetry().name(),
        plies: model.laminate.plies.len(),
        thickness_mm: model.laminate.thickness() * 1e3,
        layers: model.plate.layers(),
        regions: RegionSize::all(&model),
        unknowns: model.constraints.ndof(),
        unknowns_before_constraints: model.plate.ndof(),
        redundant_equations: model.constraints.redundant.len(),
        supports: if arguments.explain { model.supports.clone() } else { Vec::new() },
        memory_MB: memory.as_ref().map(|memory| memory.bytes() * 1e-6),
        memory,
        substructures,
        march,
        condition,
        modes,
        load_factors,
        criteria: model.criteria.iter().map(|(name, _)| name.clone()).collect(),
        left_out: model.left_out.clone(),
        fields: fields::expected(&model, frames)?,
        advised: Advised::of(&model, |_| None),
        warnings: (condition.and_then(warn_of_condition).into_iter())
            .chain(sizes.and_then(|sizes| sizes.softness).map(warn_of_softness))
            .chain(softer)
            .chain(coarse)
            .chain(model.warnings)
            .collect(),
        not_looked_at,
        keys,
    })
}

const SOFTER: &str = "supports or couples fix displacements at nodes, between which the plate moves; a run says how much softer it is for that";

type Line = (&'static str, String);

impl Checked {
    fn text(&self) -> String {
        let Self { shape, quads, nodes, plies, thickness_mm, layers, unknowns, .. } = self;
        let thickness = Dimension::LENGTH.of(thickness_mm * 1e-3);
        let redundant = match self.redundant_equations {
            0 => String::new(),
            n => format!(" ({n} redundant equations)"),
        };
        let mut lines: Vec<Line> = vec![
            (
                "mesh",
                format!(
                    "{quads} {shape}, {nodes} nodes, groups {}{}",
                    self.groups.join(", "),
                    append_symmetry(self.symmetry)
                ),
            ),
            ("plate", format!("{plies} plies, {thickness}, {layers} layers of cells")),
            ("unknowns", format!("{unknowns} of {} after constraints{redundant}", self.unknowns_before_constraints)),
        ];
        lines.splice(2..2, self.regions.iter().map(|region| ("region", region.to_string())));
        lines.splice(1..1, self.left_out.iter().map(|cells| ("left out", cells.clone())));
        lines.extend(self.memory.as_ref().map(|memory| {
            let megabytes = memory.bytes() * 1e-6;
            ("memory", format!("about {megabytes:.0} MB at the peak: {memory}"))
        }));
        lines.extend(self.supports.iter().map(|support| ("support", support.clone())));
        lines.extend(self.substructures.map(|parts| ("divided", parts.to_string())));
        lines.extend(self.march.iter().flat_map(MarchDocument::lines));
        lines.extend(self.condition.map(|condition| ("stiffness", describe_condition(condition))));
        if self.march.is_none() {
            let modes = self.modes.map(|count| format!("the {count} lowest modes"));
            let buckling = self.load_factors.map(|count| format!("buckling, {count} load factors"));
            let analysis = modes.or(buckling).unwrap_or_else(|| "static".to_owned());
            lines.push(("analysis", analysis));
        }
        lines.push(("damage", if self.criteria.is_empty() { "off".into() } else { self.criteria.join(", ") }));
        lines.extend(self.fields.map(|fields| ("fields", fields.to_string())));
        lines.extend(self.advised.iter().map(|advised| ("advised", advised.to_string())));
        lines.extend(self.warnings.iter().map(|warning| ("warning", warning.clone())));
        if !self.not_looked_at.is_empty() {
            lines.push(("not seen", format!("{}; `fem check --full` looks at it", self.not_looked_at.join(", "))));
        }
        let lines: String = lines.iter().map(|(what, text)| format!("  {what:<9} {text}\n")).collect();
        format!("{}\n{lines}  the scene is valid\n{}", self.title, format_explained(&self.keys))
    }
}

/// Keys under the outermost tables that they stand in, each material on its own.
fn format_explained(keys: &[Explained]) -> String {
    let mut text = String::new();
    let mut heading = "";
    for key in keys {
        let own = |rest: &str| rest.find('.').map(|at| key.key.len() - rest.len() + at);
        let end = match key.key.strip_prefix("materials.") {
            Some(rest) => own(rest),
            None => own(&key.key),
        };
        let (table, name) = end.map_or(("", key.key.as_str()), |at| (&key.key[..at], &key.key[at + 1..]));
        if table != heading {
            heading = table;
            let _ = writeln!(text, "\n[{table}]");
        } else if text.is_empty() {
            text.push('\n');
        }
        let value = format!("{name} = {}", key.value);
        let _ = writeln!(text, "{value:<44} {:<22} {}", key.from, key.about);
    }
    text
}
