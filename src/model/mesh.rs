//! The mesh of a scene.

use crate::error::Error;
use fem_core::domain::Domain;
use fem_core::mesh::PlaneMesh;
use fem_io::gmsh::{self, GmshMesh, MeshFault};
use fem_io::scene::{self, Located, MeshSource, Scene, SceneError};

/// The mesh of `scene`, read or built, and refined as the scene says.
///
/// # Errors
/// A file that cannot be read or is not a sound mesh; too many cells.
pub fn mesh(scene: &Scene) -> Result<GmshMesh, Error> {
    let built = |mesh| GmshMesh { mesh, warnings: Vec::new() };
    match &scene.mesh {
        MeshSource::File { file, metres_per_unit, refine, curves } => {
            let mut read = gmsh::read(&file.value, *metres_per_unit).map_err(|wrong| match wrong.fault {
                MeshFault::Unreadable(_) => {
                    let message = wrong.to_string();
                    Error::from(error(scene, file, message, "`mesh.file` counts from the folder of the scene"))
                }
                _ => wrong.into(),
            })?;
            scene::refined_cells(read.mesh.quads.len(), refine.value)
                .map_err(|why| error(scene, refine, format!("`mesh.refine`: {why}"), "refine less often"))?;
            read.mesh = (0..refine.value).fold(read.mesh, |mesh, _| mesh.refined(*curves));
            Ok(read)
        }
        MeshSource::Rectangle { size, cells } => {
            let [x, y] =
                [0, 1].map(|d| -> Vec<f64> { (0..=cells[d]).map(|i| size[d] * i as f64 / cells[d] as f64).collect() });
            Ok(built(PlaneMesh::rectangle(&x, &y)))
        }
        MeshSource::Graded { plate, refine, curves } => {
            let mesh = plate.value.mesh().map_err(|wrong| error(scene, plate, wrong.to_string(), ""))?;
            Ok(built((0..*refine).fold(mesh, |mesh, _| mesh.refined(*curves))))
        }
    }
}

/// What helps where a mesh has cells of another shape than the element's; nothing where it has not.
pub(super) fn other_shape(mesh: &PlaneMesh, domain: Domain) -> &'static str {
    match (mesh.name_of_cells(), domain) {
        ("triangles", Domain::Quadrilateral) => {
            "give an element for triangles, for example element = { kind = \"wedge15\" }, or let Gmsh make quadrilaterals: \
             Recombine Surface or Mesh.RecombineAll = 1, and Mesh.SubdivisionAlgorithm = 1 where triangles are left"
        }
        ("quads", Domain::Triangle) => {
            "give an element for quadrilaterals, for example element = { kind = \"hex20\" }, or a mesh of triangles, which \
             Gmsh makes without Recombine Surface"
        }
        ("cells", _) => {
            "meshes of quadrilaterals and triangles are not supported yet: use Recombine Surface or Mesh.RecombineAll = 1, \
             and Mesh.SubdivisionAlgorithm = 1 where triangles are left"
        }
        _ => "",
    }
}

fn error<T>(scene: &Scene, at: &Located<T>, message: String, help: &str) -> SceneError {
    scene.source.error_at(&at.place, message, help)
}
