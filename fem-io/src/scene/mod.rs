//! The scene: a TOML file that says what is struck, by what, and how to compute it.
//!
//! Every physical number is a text with its unit, [`crate::units`]. The keys of the scene lie over those of a preset,
//! [`Fidelity`]; plug-ins are named with their parameters and checked by the registry. Whatever is wrong becomes a
//! [`SceneError`] that shows the line.

mod annotate;
mod delamination;
mod effects;
mod explain;
mod fields;
mod laminate;
mod load;
mod material;
mod mesh;
mod path;
mod plugin;
mod root;
mod run;
mod schema;
mod setting;
mod study;
mod substructures;
mod support;
mod sweep;
#[cfg(test)]
mod tests;
mod tip;

pub use crate::document::keys::{Absent, Form, Key, Keys, Plugins, key, words};
pub use crate::document::reader::{Reader, SceneValue};
pub use crate::document::source::{Located, Place, SceneError, SceneSource};
pub use annotate::annotate;
pub use delamination::{DelaminationSpec, StartingDelamination, StartingExtent};
pub use effects::{Damage, Delamination, EFFECT_SETTINGS, EffectSetting, EffectSpec, EffectsSpec};
pub use explain::{Explained, explain};
pub use fields::{FieldCells, FieldSeries, Fields, Region};
pub use laminate::LaminateSpec;
pub use load::{Load, LoadKind, Pressure, ProfileLine};
pub use mesh::{MeshSource, NamedPart, refined_cells};
pub use path::PathSpec;
pub use plugin::PluginSpec;
pub use run::{
    ContactLoad, CriterionSpec, Depth, Failure, ImpactPoint, ImpactSpec, ImpactorSpec, IndexWatch, MarchSpec, Output,
    Window,
};
pub use schema::schema;
pub use setting::{Setting, Written, parse_set, parse_words, rewrite, unit};
pub use study::{OwnAxis, Quantity, Study, parse_share};
pub use substructures::{Parts, SubstructuresSpec};
pub use support::{Couple, EquationSpec, NodeSet, Support, SupportArea, Term, Unknowns};
pub use sweep::{Sampling, SweepSpec, Varied};

use crate::document::source::Origin;
use crate::document::tree::Table;
use crate::materials::LIBRARY;
use fem_core::laminate::LaminaPly;
use fem_core::material::Material;
use fem_core::plate::ZDerivatives;
use fem_core::symmetry::SymmetryGroup;
use root::{ANALYSES, KEYS, Which, Z_DERIVATIVES};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// A scene, read and checked as far as that is possible without its mesh and its plug-ins. SI units.
#[derive(Debug, Clone)]
pub struct Scene {
    /// What it is about.
    pub title: String,
    /// The preset beneath its keys.
    pub fidelity: Fidelity,
    /// Largest relative error of its results that whoever runs it is to raise its settings for.
    pub accuracy: Option<Located<f64>>,
    /// What is computed.
    pub analysis: Analysis,
    /// The mesh.
    pub mesh: MeshSource,
    /// By what plate, supports and loads are symmetric, where only symmetric motions are wanted.
    pub symmetry: Option<Located<SymmetryGroup>>,
    /// Its materials.
    pub materials: Vec<Located<Material>>,
    /// Of each of them, the law that its plies follow, if it is not linear elasticity.
    pub laws: Vec<Option<PluginSpec>>,
    /// The laminates, at least one; all have their layers and plies at the same heights.
    pub laminates: Vec<LaminateSpec>,
    /// Material of the resin between plies, for criteria that look there; counts in `materials`.
    pub interface: Option<Located<usize>>,
    /// The element.
    pub element: PluginSpec,
    /// How layers of elements share the derivatives along z.
    pub z_derivatives: Located<ZDerivatives>,
    /// Supports.
    pub supports: Vec<Support>,
    /// Linear equations between unknowns.
    pub equations: Vec<EquationSpec>,
    /// Sets of nodes that move together.
    pub couples: Vec<Couple>,
    /// The substructures that the plate is divided into, if it is.
    pub substructures: Option<SubstructuresSpec>,
    /// The effects that are simulated.
    pub effects: EffectsSpec,
    /// Which interfaces open, where delaminations grow.
    pub delamination: Option<DelaminationSpec>,
    /// How loads at rest are followed while interfaces open, where it says so.
    pub path: Option<Located<PathSpec>>,
    /// The same scene with delaminations that grow, where it leaves them to the advisor.
    pub grown: Option<Box<Scene>>,
    /// The same impact on a plate that does not come apart, where delaminations grow.
    pub sound: Option<Box<Scene>>,
    /// Lines through the thickness along which stresses are written.
    pub profiles: Vec<ProfileLine>,
    /// Where and when failure is looked for.
    pub failure: Failure,
    /// What is written.
    pub output: Output,
    /// What a study of it varies and looks at.
    pub study: Study,
    /// What a sweep of it varies.
    pub sweep: SweepSpec,
    /// Every value of the scene and of the preset beneath it by the path of its key, `failure.watch[0].ply`, as it is written.
    pub keys: BTreeMap<String, String>,
    /// Its text, for errors that show a place.
    pub source: Arc<SceneSource>,
}

/// How closely a scene is computed, unless it says otherwise key by key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fidelity {
    /// As AFWAL-TR-87-4117 did.
    Report,
    /// The default: onset times that do not depend on the mesh, at small cost.
    Engineering,
    /// No reduction, finer in time.
    Reference,
}

impl Scene {
    /// The plies of all laminates.
    pub fn plies(&self) -> impl Iterator<Item = &LaminaPly> {
        self.laminates.iter().flat_map(|spec| &spec.laminate.value.plies)
    }

    /// The impact, if it describes one.
    pub fn impact(&self) -> Option<&ImpactSpec> {
        match &self.analysis {
            Analysis::Impact(impact) => Some(impact),
            _ => None,
        }
    }
}

impl Fidelity {
    const ALL: [(&'static str, Self); 3] =
        [("engineering", Self::Engineering), ("report", Self::Report), ("reference", Self::Reference)];

    /// Its name in scenes.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Report => "report",
            Self::Engineering => "engineering",
            Self::Reference => "reference",
        }
    }

    /// Its keys, a TOML text.
    pub const fn preset(self) -> &'static str {
        match self {
            Self::Report => include_str!("presets/report.toml"),
            Self::Engineering => include_str!("presets/engineering.toml"),
            Self::Reference => include_str!("presets/reference.toml"),
        }
    }
}

/// What is computed of a scene.
#[derive(Debug, Clone)]
pub enum Analysis {
    /// The response to an impact.
    Impact(Box<ImpactSpec>),
    /// Displacements and stresses under loads at rest.
    Static(Vec<Load>),
    /// The lowest natural frequencies.
    Modes {
        /// How many.
        count: usize,
    },
    /// The factors on the preload that are nearest to zero and buckle the plate.
    Buckling {
        /// How many.
        count: usize,
    },
}

/// Natural frequencies unless a scene says how many.
pub const DEFAULT_MODES: usize = 10;

/// What delaminations that grow lay over the preset.
const GROWTH: &str = include_str!("presets/growth.toml");

/// What supports from which the plate may lift off lay over it.
const LIFTING: &str = include_str!("presets/lifting.toml");

/// Load factors of buckling unless a scene says how many.
const DEFAULT_FACTORS: usize = 4;

const BUCKLING: Keys =
    &[key("count", Form::Count(1), "4", "how many of the load factors nearest to zero").default("4")];

const MODES: Keys = &[key("count", Form::Count(1), "10", "how many of the lowest modes").default("10")];

/// Reads the scene file `path`.
///
/// # Errors
/// A file that cannot be read, or as [`parse`].
pub fn read(path: &Path) -> Result<Scene, SceneError> {
    parse(&read_text(path)?, path)
}

/// Reads a scene from its text; `path` names it in errors, and its folder is where the mesh file is looked for.
///
/// # Errors
/// Anything that is not a scene: TOML at fault, unknown, missing or contradicting keys, values without unit, of the
/// wrong dimension or out of range. All of these that can be told by themselves, with their places.
pub fn parse(text: &str, path: &Path) -> Result<Scene, SceneError> {
    parse_with(text, path, "")
}

/// Every value of the scene `text` by the path of its key, as it is written there; nothing of its preset.
///
/// # Errors
/// A text that is not TOML.
pub fn keys(text: &str) -> Result<BTreeMap<String, String>, SceneError> {
    let source = Arc::new(SceneSource::new(Path::new("scene"), text, LIBRARY));
    let mut keys = BTreeMap::new();
    Table::parse(text, Origin::Scene, &source)?.flatten("", &mut keys);
    Ok(keys)
}

/// The scene of `source` with the keys of `setting` laid over its own: how studies, sweeps and maps vary it.
///
/// # Errors
/// As [`parse`], and anything that makes no sense in `setting`.
pub fn under(source: &SceneSource, setting: &Setting) -> Result<Scene, SceneError> {
    parse_with(source.text(), source.path(), &setting::text(setting))
}

/// As [`read`], with `keys` and their values in words over those of the scene: [`parse_words`].
///
/// # Errors
/// As [`parse_words`], and a file that cannot be read.
pub fn read_words(path: &Path, keys: &[(String, String)]) -> Result<Scene, SceneError> {
    parse_words(&read_text(path)?, path, keys)
}

fn read_text(path: &Path) -> Result<String, SceneError> {
    crate::document::source::read_text(path).map_err(|why| {
        let message = format!("cannot read the scene `{}`: {why}", path.display());
        Arc::new(SceneSource::new(path, "", LIBRARY))
            .error(message, "name the file of a scene; `fem new FOLDER` writes one to begin with")
    })
}

/// A scene over its preset, its keys known and its values not read yet.
struct Merged {
    table: Table,
    fidelity: Fidelity,
    /// What it says of delamination.
    delamination: Option<Delamination>,
    /// Whether delaminations grow.
    grows: bool,
    source: Arc<SceneSource>,
}

/// Whether delaminations grow, by what a scene says of them.
type Grows = fn(Option<Delamination>) -> bool;

/// What is left to the advisor does not, until he has decided.
const AS_WRITTEN: Grows = |wish| wish == Some(Delamination::Growth);

impl Merged {
    fn new(text: &str, path: &Path, setting: &str, grows: Grows) -> Result<Self, SceneError> {
        let source = Arc::new(SceneSource::new(path, text, LIBRARY).with(
            Origin::Setting,
            "what is set over the scene",
            setting,
        ));
        let own = Table::parse(text, Origin::Scene, &source)?;
        let own = Table::parse(setting, Origin::Setting, &source)?.over(own);
        let fidelity = match Reader::unchecked(&own, KEYS, &source).optional("fidelity") {
            Some(field) => field.choice(&Fidelity::ALL)?,
            None => Fidelity::Engineering,
        };
        let effects = Reader::unchecked(&own, KEYS, &source).optional("effects");
        let delamination = effects.and_then(|field| effects::delamination_in(&field));
        let grows = grows(delamination);
        let name = format!("preset `{}`", fidelity.name());
        let source = Arc::new(SceneSource::clone(&source).with(Origin::Preset, name, fidelity.preset()));
        let supports = Reader::unchecked(&own, KEYS, &source).optional("support");
        let lifts = supports.is_some_and(|field| support::may_lift_off(&field));
        let mut preset = Table::parse(fidelity.preset(), Origin::Preset, &source)?;
        for (_, text) in [(lifts, LIFTING), (grows, GROWTH)].iter().filter(|(holds, _)| *holds) {
            preset = Table::parse(text, Origin::Preset, &source)?.over(preset);
        }
        let table = own.over(preset);
        Ok(Self { table, fidelity, delamination, grows, source })
    }
}

fn parse_with(text: &str, path: &Path, setting: &str) -> Result<Scene, SceneError> {
    let read = |merged: &Merged| {
        read_merged(merged, path).map_err(|first| {
            let faults = Reader::unchecked(&merged.table, KEYS, &merged.source).faults();
            first.with(faults)
        })
    };
    let merged = Merged::new(text, path, setting, AS_WRITTEN)?;
    let scene = read(&merged)?;
    let other = |grows: Grows| read(&Merged::new(text, path, setting, grows)?);
    let impact = scene.impact().is_some();
    match merged.delamination {
        Some(Delamination::Auto) => {
            let sound = impact.then(|| Box::new(scene.clone()));
            let grown = Scene { sound, ..other(|_| true)? };
            Ok(Scene { grown: Some(Box::new(grown)), ..scene })
        }
        Some(Delamination::Growth) if impact => {
            // Marched as one that comes apart, for which it stands, and linear elastic.
            let sound = read(&Merged { grows: false, ..merged })?;
            let laws = vec![None; sound.laws.len()];
            Ok(Scene { sound: Some(Box::new(Scene { laws, ..sound })), ..scene })
        }
        _ => Ok(scene),
    }
}

fn read_merged(merged: &Merged, file: &Path) -> Result<Scene, SceneError> {
    let Merged { table: merged, fidelity, delamination, grows, source } = merged;
    let root = Reader::root(merged, KEYS, source)?;
    let mut keys = BTreeMap::new();
    merged.flatten("", &mut keys);

    let folder = file.parent().unwrap_or(Path::new(""));
    let given = root.required("materials")?;
    let mut materials = material::read_all(&given, folder)?;
    let mut laws = material::read_laws(&given)?;
    let (mut laminates, interface) = laminate::read_all(&root.required("laminate")?, &materials)?;
    laminate::strengthen(&mut laminates, (&mut materials, &mut laws), (&given, folder))?;
    let element = root.required("element")?;
    let effects = root.optional("effects").map_or(Ok(EffectsSpec::default()), |field| effects::read(&field))?;
    let analysis = read_analysis(&root, &tip::Struck { materials: &materials, laminates: &laminates })?;
    let in_time = matches!(analysis, Analysis::Impact(_));
    let march = match &analysis {
        Analysis::Impact(impact) => Some(&impact.march),
        _ => None,
    };
    let onset = effects.damage == Damage::Onset;
    Ok(Scene {
        title: root.required("title")?.text()?.to_owned(),
        fidelity: *fidelity,
        accuracy: root.optional("accuracy").map(|field| study::read_accuracy(&field)).transpose()?,
        mesh: mesh::read(&root.required("mesh")?, file)?,
        symmetry: match root.optional("symmetry") {
            Some(field) => Some(field.at(field.choice(&SymmetryGroup::ALL)?)),
            None => None,
        },
        materials,
        laws,
        laminates,
        interface,
        z_derivatives: read_z_derivatives(&element)?,
        element: PluginSpec::read(&element, "kind", &["z_derivatives"])?,
        supports: match (&analysis, root.optional("support")) {
            // A free plate has modes too.
            (Analysis::Modes { .. }, None) => Vec::new(),
            _ => support::read_all(&root.required("support")?)?,
        },
        equations: root.optional("equation").map_or(Ok(Vec::new()), |field| support::read_equations(&field))?,
        couples: root.optional("couple").map_or(Ok(Vec::new()), |field| support::read_couples(&field))?,
        substructures: root.optional("substructures").map(|field| substructures::read(&field)).transpose()?,
        failure: run::read_failure(&root.required("failure")?, onset && in_time, in_time)?,
        output: root.optional("output").map_or(Ok(Output::default()), |field| run::read_output(&field, march))?,
        delamination: match root.optional("delamination") {
            Some(field) if *grows => Some(delamination::read(&field)?),
            Some(_) if matches!(delamination, Some(Delamination::Auto | Delamination::Growth)) => None,
            Some(field) => {
                let help = "set effects = { delamination = \"growth\" }, or leave the table out";
                return Err(field.error("means nothing where delaminations do not grow", help));
            }
            None => None,
        },
        path: match root.optional("path") {
            Some(field) if *grows => Some(field.at(path::read(&field)?)),
            Some(field) => {
                let help = "set effects = { delamination = \"growth\" }, or leave the table out";
                return Err(
                    field.error("is that of loads at rest while delaminations grow, which they do not here", help)
                );
            }
            None => None,
        },
        grown: None,
        sound: None,
        analysis,
        effects,
        profiles: root.optional("profile").map_or(Ok(Vec::new()), |field| load::read_profiles(&field))?,
        study: root.optional("study").map_or(Ok(Study::default()), |field| study::read(&field))?,
        sweep: root.optional("sweep").map_or(Ok(SweepSpec::default()), |field| sweep::read(&field))?,
        keys,
        source: Arc::clone(source),
    })
}

/// Keys that an analysis does not use; presets hold them for others.
fn list_unused_keys(analysis: &str) -> &'static [&'static str] {
    match analysis {
        "static" => &["impactor", "contact", "reduction", "march", "modes", "buckling"],
        "modes" => &["impactor", "contact", "reduction", "march", "load", "path", "profile", "buckling"],
        "buckling" => &["impactor", "contact", "reduction", "march", "load", "path", "profile", "modes"],
        _ => &["load", "path", "modes", "buckling", "profile"],
    }
}

fn read_analysis(root: &Reader<'_>, struck: &tip::Struck<'_>) -> Result<Analysis, SceneError> {
    let which = root.optional("analysis").map_or(Ok(Which::Impact), |field| field.choice(&ANALYSES))?;
    let name = ANALYSES[which as usize].0;
    let mut stray = list_unused_keys(name).iter().filter_map(|key| root.optional(key));
    if let Some(field) = stray.find(|field| field.place().origin != Origin::Preset) {
        let help = "leave it out, or choose another `analysis`: impact, static, modes, buckling";
        return Err(field.error(format!("means nothing in the analysis `{name}`"), help));
    }
    Ok(match which {
        // Whether anything else loads the plate is for others to say.
        Which::Static => {
            Analysis::Static(root.optional("load").map_or(Ok(Vec::new()), |field| load::read_all(&field))?)
        }
        Which::Modes => Analysis::Modes { count: read_count(root, "modes", MODES, DEFAULT_MODES)? },
        Which::Buckling => Analysis::Buckling { count: read_count(root, "buckling", BUCKLING, DEFAULT_FACTORS)? },
        Which::Impact => Analysis::Impact(Box::new(run::read_impact(root, struck)?)),
    })
}

/// How many the table `key` asks for.
fn read_count(root: &Reader<'_>, key: &str, keys: Keys, default: usize) -> Result<usize, SceneError> {
    let Some(field) = root.optional(key) else { return Ok(default) };
    field.table(keys)?.optional("count").map_or(Ok(default), |field| field.count())
}

/// `layer-wise` where neither scene nor preset says.
fn read_z_derivatives(element: &SceneValue<'_>) -> Result<Located<ZDerivatives>, SceneError> {
    match element.entries()?.iter().find(|(key, _)| *key == "z_derivatives") {
        Some((_, field)) => Ok(field.at(field.choice(&Z_DERIVATIVES)?)),
        None => Ok(element.at(ZDerivatives::LayerWise)),
    }
}
