//! The scene: a TOML file that says what is struck, by what, and how to compute it.
//!
//! Every physical number is a text with its unit, [`crate::units`]. The keys of the scene lie over those of a preset,
//! [`Fidelity`]; plug-ins are named with their parameters and checked by whoever knows them. Whatever is wrong becomes a
//! [`SceneError`] that shows the line.

mod laminate;
pub(crate) mod material;
mod plugin;
pub(crate) mod reader;
mod run;
pub(crate) mod source;
mod support;
#[cfg(test)]
mod tests;
pub(crate) mod tree;

pub use plugin::PluginSpec;
pub use run::{CriterionSpec, Damage, Depth, Failure, ImpactPoint, Impactor, IndexWatch, Load, March, Output, Window};
pub use source::{Located, Place, SceneError, SceneSource};
pub use support::{Couple, Equation, NodeSet, Support, Term};

use crate::units;
use fem_core::laminate::Laminate;
use fem_core::material::Material;
use fem_core::plate::ZDerivatives;
use fem_core::plugin::Dimension;
use reader::{Field, Keys, Reader};
use source::Origin;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tree::Table;

/// A scene, read and checked as far as that is possible without its mesh and its plug-ins. SI units.
#[derive(Debug, Clone)]
pub struct Scene {
    /// What it is about.
    pub title: String,
    /// The preset beneath its keys.
    pub fidelity: Fidelity,
    /// The mesh.
    pub mesh: MeshFile,
    /// Its materials.
    pub materials: Vec<Located<Material>>,
    /// The laminate; its materials count in `materials`.
    pub laminate: Located<Laminate>,
    /// Material of the resin between plies, for criteria that look there; counts in `materials`.
    pub interface: Option<Located<usize>>,
    /// The element.
    pub element: PluginSpec,
    /// How layers of elements share the derivatives along z.
    pub z_derivatives: Located<ZDerivatives>,
    /// Supports.
    pub supports: Vec<Support>,
    /// Linear equations between unknowns.
    pub equations: Vec<Equation>,
    /// Sets of nodes that move together.
    pub couples: Vec<Couple>,
    /// The impactor.
    pub impactor: Impactor,
    /// The contact law.
    pub contact: PluginSpec,
    /// What is done about damage.
    pub damage: Damage,
    /// The reduction; `none` for the full system.
    pub reduction: PluginSpec,
    /// The march in time.
    pub march: March,
    /// Where and when failure is looked for.
    pub failure: Failure,
    /// What is written.
    pub output: Output,
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

/// A mesh file.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshFile {
    /// Its path, resolved against the folder of the scene.
    pub file: Located<PathBuf>,
    /// Size of the file's unit of length, m.
    pub metres_per_unit: f64,
}

const KEYS: Keys = &[
    ("title", r#""16 plies, 2.49 kg at 1.56 m/s""#),
    ("fidelity", r#""engineering""#),
    ("mesh", r#"{ file = "plate.msh", unit = "mm" }"#),
    ("materials", r#"{ as4-3502 = { library = "AS4/3502" } }"#),
    ("laminate", r#"{ plies = "[0/45/-45/90]2s", material = "as4-3502", ply_thickness = "0.13208 mm" }"#),
    ("element", r#"{ kind = "hermite-prism" }"#),
    ("support", r#"[{ group = "support", at = "mid-plane", fix = ["U30"] }, { restrain = "rigid-motions" }]"#),
    ("equation", r#"[{ terms = [{ group = "a", at = "top", dof = "U10", factor = 1.0 }] }]"#),
    ("couple", r#"[{ group = "edge", at = "all", dofs = ["U30"] }]"#),
    ("impactor", r#"{ mass = "2.49 kg", velocity = "1.56 m/s", at = { group = "impact" } }"#),
    ("contact", r#"{ law = "sun-yang", k = "1.07e5 N/mm^1.5", n = 1.5, m = 2.5, critical = "0.08 mm", beta = 0.4 }"#),
    ("effects", r#"{ damage = "onset" }"#),
    ("reduction", r#"{ method = "craig-bampton", modes = 40 }"#),
    ("march", r#"{ integrator = "newmark", step = "0.5 us", end = "1 ms" }"#),
    ("failure", r#"{ criteria = ["hashin-report"] }"#),
    ("output", "{ plots = true }"),
];
const MESH: Keys = &[("file", r#""plate.msh""#), ("unit", r#""mm""#)];

/// Reads the scene file `path`.
///
/// # Errors
/// A file that cannot be read, or as [`parse`].
pub fn read(path: &Path) -> Result<Scene, SceneError> {
    let text = source::read_text(path).map_err(|why| {
        let message = format!("cannot read the scene `{}`: {why}", path.display());
        Arc::new(SceneSource::new(path, "")).error(message, "")
    })?;
    parse(&text, path)
}

/// Reads a scene from its text; `path` names it in errors, and its folder is where the mesh file is looked for.
///
/// # Errors
/// Anything that is no scene: TOML at fault, unknown, missing or contradicting keys, values without unit, of the wrong
/// dimension or out of range. The first of these, with its place.
pub fn parse(text: &str, path: &Path) -> Result<Scene, SceneError> {
    let source = Arc::new(SceneSource::new(path, text));
    let own = Table::parse(text, Origin::Scene, &source)?;
    let fidelity = match Reader::root(&own, KEYS, &source)?.optional("fidelity") {
        Some(field) => field.choice(&Fidelity::ALL)?,
        None => Fidelity::Engineering,
    };
    let name = format!("preset `{}`", fidelity.name());
    let source = Arc::new(SceneSource::clone(&source).with(Origin::Preset, name, fidelity.preset()));
    let merged = own.over(Table::parse(fidelity.preset(), Origin::Preset, &source)?);
    let root = Reader::root(&merged, KEYS, &source)?;

    let folder = path.parent().unwrap_or(Path::new(""));
    let materials = material::read_all(&root.required("materials")?, folder)?;
    let (laminate, interface) = laminate::read(&root.required("laminate")?, &materials)?;
    let element = root.required("element")?;
    let damage = root.optional("effects").map_or(Ok(Damage::Onset), |field| run::read_effects(&field))?;
    Ok(Scene {
        title: root.required("title")?.text()?.to_owned(),
        fidelity,
        mesh: read_mesh(&root.required("mesh")?, path)?,
        materials,
        laminate,
        interface,
        z_derivatives: read_z_derivatives(&element)?,
        element: PluginSpec::read(&element, "kind", &["z_derivatives"])?,
        supports: support::read_all(&root.required("support")?)?,
        equations: root.optional("equation").map_or(Ok(Vec::new()), |field| support::read_equations(&field))?,
        couples: root.optional("couple").map_or(Ok(Vec::new()), |field| support::read_couples(&field))?,
        impactor: run::read_impactor(&root.required("impactor")?)?,
        contact: PluginSpec::read(&root.required("contact")?, "law", &[])?,
        damage,
        reduction: PluginSpec::read(&root.required("reduction")?, "method", &[])?,
        march: run::read_march(&root.required("march")?)?,
        failure: run::read_failure(&root.required("failure")?, damage)?,
        output: root.optional("output").map_or(Ok(Output::default()), |field| run::read_output(&field))?,
        source,
    })
}

fn read_mesh(field: &Field<'_>, scene: &Path) -> Result<MeshFile, SceneError> {
    let table = field.table(MESH)?;
    let file = table.required("file")?;
    let path = scene.parent().unwrap_or(Path::new("")).join(file.text()?);
    let unit = table.required("unit")?;
    let metres_per_unit = units::parse_as(&format!("1 {}", unit.text()?), Dimension::LENGTH)
        .map_err(|_| unit.error("must be a unit of length", "write the unit of the file's coordinates: mm, m, in"))?;
    Ok(MeshFile { file: file.at(path), metres_per_unit })
}

/// `shared` where neither scene nor preset says.
fn read_z_derivatives(element: &Field<'_>) -> Result<Located<ZDerivatives>, SceneError> {
    const WORDS: [(&str, ZDerivatives); 2] =
        [("shared", ZDerivatives::Shared), ("layer-wise", ZDerivatives::LayerWise)];
    match element.entries()?.iter().find(|(key, _)| *key == "z_derivatives") {
        Some((_, field)) => Ok(field.at(field.choice(&WORDS)?)),
        None => Ok(element.at(ZDerivatives::Shared)),
    }
}
