//! The mesh of a scene.

use crate::error::Error;
use fem_core::element::{Element, Tables, form};
use fem_core::mesh::{Group, PlaneMesh};
use fem_core::plugin::unknown_key;
use fem_io::meshes::{self, Examined, FileMesh, MeshError, MeshFault};
use fem_io::scene::{self, Located, MeshSource, NamedPart, Scene, SceneError};

/// The mesh of `scene`, read or built, and refined as the scene says.
///
/// # Errors
/// A file that cannot be read or is not a sound mesh; too many cells; a group to cut along that there is not.
pub fn mesh(scene: &Scene) -> Result<FileMesh, Error> {
    Ok(examined_mesh(scene)?.sound()?)
}

/// As [`mesh`], of cells that need not tile a plate: what is wrong with them comes along.
///
/// # Errors
/// As [`mesh`], but for flaws of the tiling.
pub(crate) fn examined_mesh(scene: &Scene) -> Result<Examined, Error> {
    match &scene.mesh {
        MeshSource::File { file, metres_per_unit, refine, curves, cuts } => {
            let names: Vec<String> = cuts.iter().map(|cut| cut.value.clone()).collect();
            let unreadable = |wrong: MeshError| match wrong.fault {
                MeshFault::Unreadable(_) => {
                    let message = wrong.to_string();
                    Error::from(error(scene, file, message, "`mesh.file` counts from the folder of the scene"))
                }
                _ => wrong.into(),
            };
            let mut examined = meshes::examine(&file.value, *metres_per_unit, &names).map_err(unreadable)?;
            let mesh = &mut examined.read.mesh;
            let edges = || mesh.groups.iter().filter(|(_, group)| group.dim == 1).map(|(name, _)| name.as_str());
            if let Some(cut) = cuts.iter().find(|cut| edges().all(|name| name != cut.value)) {
                let message = format!("the mesh has no group of edges `{}`", cut.value);
                let help = format!("`{}` {}", cut.value, unknown_key(&cut.value, edges()));
                return Err(error(scene, cut, message, &help).into());
            }
            scene::refined_cells(mesh.quads.len(), refine.value)
                .map_err(|why| error(scene, refine, format!("`mesh.refine`: {why}"), "refine less often"))?;
            for _ in 0..refine.value {
                *mesh = mesh.refined(*curves);
            }
            let sound_before = examined.flaws.is_empty() && refine.value > 0;
            if let Some(flaw) = examined.read.mesh.flaws(&names).first().filter(|_| sound_before) {
                let [x, y] = flaw.at.map(|x| x * 1e3);
                let message = format!("curved edges meet others at ({x:.4}, {y:.4}) mm when the mesh is refined");
                let help = "divide the curves there more finely, or write `curves = \"straight\"`";
                return Err(error(scene, refine, message, help).into());
            }
            Ok(examined)
        }
        MeshSource::Rectangle { size, cells, parts } => {
            let [x, y] =
                [0, 1].map(|d| -> Vec<f64> { (0..=cells[d]).map(|i| size[d] * i as f64 / cells[d] as f64).collect() });
            let mut mesh = PlaneMesh::rectangle(&x, &y);
            let mut warnings = Vec::new();
            for NamedPart { name, corners: [low, high] } in parts {
                let group = mesh.within_rectangle(*low, *high);
                if group.nodes.is_empty() {
                    let message = format!("no node of the mesh lies in the group `{}`", name.value);
                    let help = "nodes lie where cells end: choose `mesh.cells` so that one does, or enlarge the group";
                    return Err(error(scene, name, message, help).into());
                }
                for d in 0..2 {
                    let asked = [low[d].max(0.0), high[d].min(size[d])];
                    warnings.extend(shrunk(&mesh, (&name.value, &group), d, (asked, size[d] / cells[d] as f64)));
                }
                mesh.groups.insert(name.value.clone(), group);
            }
            let mut examined = Examined::built(mesh);
            examined.read.warnings = warnings;
            Ok(examined)
        }
        MeshSource::Graded { plate, refine, curves } => {
            let mesh = plate.value.mesh().map_err(|wrong| error(scene, plate, wrong.to_string(), ""))?;
            Ok(Examined::built((0..*refine).fold(mesh, |mesh, _| mesh.refined(*curves))))
        }
    }
}

/// Share of a cell that a group may be smaller than it is asked to be.
const SHRUNK: f64 = 0.01;

/// That the nodes of a group end before it is `asked` to along axis `d`, where cells are so wide.
fn shrunk(mesh: &PlaneMesh, (name, group): (&str, &Group), d: usize, (asked, cell): ([f64; 2], f64)) -> Option<String> {
    let along = group.nodes.iter().map(|node| mesh.points[*node as usize][d]);
    let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let lost = f64::max(low - asked[0], asked[1] - high);
    let axis = ["x", "y"][d];
    // To the nanometre, without zeros behind it.
    let [from, to, low, high] = [asked[0], asked[1], low, high].map(|x| (x * 1e9).round() / 1e6);
    (lost > SHRUNK * cell).then(|| {
        format!(
            "the group `{name}` is to reach from {axis} = {from} to {to} mm, and reaches from {low} to {high} mm, where cells end; with other cells it is another one, so that what is said of the error of the mesh does not hold: let \
             `mesh.cells` end where it does"
        )
    })
}

/// Straightens the bent sides of a mesh where the element cannot stand on them, and says so.
pub(super) fn straighten(mesh: &mut PlaneMesh, element: &dyn Element) -> Option<String> {
    if mesh.bends.is_empty() || mesh.quads.iter().all(|quad| form(element, quad.domain()).takes_bent_sides()) {
        return None;
    }
    let share = |([a, b], bend): (&[u32; 2], &[f64; 2])| {
        let [p, q] = [a, b].map(|n| mesh.points[*n as usize]);
        bend[0].hypot(bend[1]) / (q[0] - p[0]).hypot(q[1] - p[1])
    };
    let (count, most) = (mesh.bends.len(), mesh.bends.iter().map(share).fold(0.0, f64::max));
    mesh.bends.clear();
    Some(format!(
        "{count} sides of cells are bent, by up to {:.2} % of their length, and stay straight, since the element knows no others: use \
         `hex20` or `hermite-prism`",
        100.0 * most
    ))
}

/// What helps where a mesh has cells of a shape that the element does not stand on; nothing where it has none.
pub(super) fn other_shape(mesh: &PlaneMesh, element: &Tables) -> &'static str {
    match mesh.name_of_cells() {
        _ if mesh.quads.iter().all(|quad| element.on(quad.domain()).is_some()) => "",
        "quads" => {
            "give an element for quadrilaterals, for example element = { kind = \"hex20\" }, or a mesh of triangles, which \
             Gmsh makes without Recombine Surface"
        }
        _ => {
            "give an element that also stands on triangles (`fem list elements`), for example element = { kind = \
             \"hermite-prism\" }, or let Gmsh make quadrilaterals: Recombine Surface or Mesh.RecombineAll = 1, and \
             Mesh.SubdivisionAlgorithm = 1 where triangles are left"
        }
    }
}

fn error<T>(scene: &Scene, at: &Located<T>, message: String, help: &str) -> SceneError {
    scene.source.error_at(&at.place, message, help)
}
