//! What a model keeps of its scene.

use fem_io::scene::{Fidelity, LaminateSpec, MeshSource, Scene, SceneSource};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// What to do about a material without a density.
pub(super) const DENSITY: &str = "add its `density`, for example: density = \"1.58 g/cm^3\"";

/// Where a model comes from: what heads its results, shows places in messages, and tells one scene from another.
#[derive(Debug, Clone)]
pub struct Origin {
    /// What the scene is about.
    pub title: String,
    /// The preset beneath its keys.
    pub fidelity: Fidelity,
    /// The name of the element.
    pub element: String,
    /// Its text, for errors that show a place.
    pub source: Arc<SceneSource>,
    /// Every value of the scene and its preset by the path of its key, as it is written.
    pub keys: BTreeMap<String, String>,
    /// Whether plies have strengths in situ, which follow from those of their materials.
    pub in_situ: bool,
    /// The file of the mesh, if there is one.
    pub mesh: Option<PathBuf>,
}

impl Origin {
    pub(super) fn of(scene: &Scene) -> Self {
        Self {
            title: scene.title.clone(),
            fidelity: scene.fidelity,
            element: scene.element.name.value.clone(),
            source: Arc::clone(&scene.source),
            keys: scene.keys.clone(),
            in_situ: scene.laminates.iter().any(LaminateSpec::is_in_situ),
            mesh: match &scene.mesh {
                MeshSource::File { file, .. } => Some(file.value.clone()),
                _ => None,
            },
        }
    }
}
