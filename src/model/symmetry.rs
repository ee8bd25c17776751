//! What must be symmetric where a scene says so: mesh, plies, criteria, supports, loads, the place of the impact.

use super::NamedCriterion;
use super::builder::Builder;
use fem_core::constraint::Equation;
use fem_core::failure::{FailureCriterion, Site};
use fem_core::laminate::Laminate;
use fem_core::material::Material;
use fem_core::plate::Plate;
use fem_core::symmetry::{Operation, SymmetryGroup};
use fem_core::tensor::{Ply, Stress6};
use fem_io::scene::{ImpactPoint, Located, MeshSource, Place, SceneError};

/// What loads may lack of their symmetry, relative to the largest of their kind: rounding, and points of
/// quadrature on the border of two cells.
const ROUNDING: f64 = 1e-7;

/// Difference of two failure indices that a search for the plane of fracture may leave, relative.
const SAME_INDEX: f64 = 1e-3;

/// Stresses at which a criterion is asked whether it sees a symmetry, Pa; plane ones for those that take no others.
const STRESSES: [[f64; 6]; 6] = [
    [3e8, 2e7, -1e7, 4e7, 3e7, 2e7],
    [-4e8, -5e7, 2e7, 3e7, -2e7, 5e7],
    [1e8, -9e7, 3e7, -6e7, 4e7, -1e7],
    [2e7, 3e7, 4e7, -2e7, -5e7, -3e7],
    [3e8, 2e7, 0.0, 4e7, 0.0, 0.0],
    [-4e8, -5e7, 0.0, -3e7, 0.0, 0.0],
];

impl Builder<'_> {
    /// Folds the plate as the scene says.
    pub(super) fn fold(
        &self,
        plate: &mut Plate,
        laminates: &[Laminate],
        materials: &[Material],
        criteria: &[NamedCriterion],
    ) -> Result<(), SceneError> {
        let Some(symmetry) = &self.scene.symmetry else { return Ok(()) };
        let name = symmetry.value.name();
        if let MeshSource::File { cuts, .. } = &self.scene.mesh
            && let Some(cut) = cuts.first()
        {
            let message = "a plate with cuts cannot be folded: the nodes on both faces have one place";
            return Err(self.error(cut, message, "leave `symmetry` out"));
        }
        plate.fold(symmetry.value).map_err(|why| {
            self.error(symmetry, why.to_string(), "make the mesh symmetric, node by node, or leave `symmetry` out")
        })?;
        let operations = symmetry.value.operations();
        let layers = || {
            laminates.iter().enumerate().flat_map(|(region, laminate)| {
                let layers = plate.stacks(region).iter().enumerate();
                layers.map(move |(layer, stack)| (laminate, layer, stack))
            })
        };
        for (laminate, layer, stack) in layers() {
            for (ply, slice) in laminate.plies_of(layer).zip(&stack.slices) {
                if !operations.iter().all(|o| o.keeps_stiffness(&slice.c)) {
                    let angle = laminate.plies[ply].angle_deg;
                    let message = format!("ply {} at {angle} degrees breaks the symmetry `{name}`", ply + 1);
                    let help = match symmetry.value {
                        SymmetryGroup::HalfTurn => "leave `symmetry` out",
                        _ => "a mirror needs plies at 0 and 90 degrees; the half-turn takes any",
                    };
                    return Err(self.error(symmetry, message, help));
                }
            }
        }
        for (label, criterion) in criteria {
            if !operations.iter().all(|o| self.is_symmetric(&**criterion, *o, laminates, materials)) {
                let message = format!("criterion `{label}` breaks the symmetry `{name}`");
                let help = "it tells a stress from its image, by the sign of a shear stress; leave `symmetry` out";
                return Err(self.error(symmetry, message, help));
            }
        }
        Ok(())
    }

    /// Whether a criterion has one index for a stress and its image, wherever it looks.
    fn is_symmetric(
        &self,
        criterion: &dyn FailureCriterion,
        operation: Operation,
        laminates: &[Laminate],
        materials: &[Material],
    ) -> bool {
        let modes = criterion.info().modes.len();
        let indices = |stress: &Stress6<Ply>, material: &Material| {
            let mut out = vec![0.0; modes];
            criterion.indices(stress, material, &mut out);
            out
        };
        // A stress out of the criterion's scope has no index, and neither has its image.
        let alike =
            |a: f64, b: f64| a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= SAME_INDEX * a.abs().max(b.abs());
        let same = |angle: f64, material: usize| {
            STRESSES.into_iter().map(Stress6::<Ply>::new).all(|stress| {
                let image = operation.stress(&stress.to_global(angle)).to_ply(angle);
                let [here, there] = [stress, image].map(|stress| indices(&stress, &materials[material]));
                here.into_iter().zip(there).all(|(a, b)| alike(a, b))
            })
        };
        match (criterion.info().site, &self.scene.interface) {
            (Site::Ply, _) => {
                laminates.iter().flat_map(|laminate| &laminate.plies).all(|ply| same(ply.angle, ply.material))
            }
            (Site::Interface, resin) => resin.iter().all(|resin| same(0.0, resin.value)),
        }
    }

    /// Refuses supports whose image they do not imply.
    pub(super) fn symmetric_supports(
        &self,
        plate: &Plate,
        equations: &[Equation],
        places: &[&Place],
    ) -> Result<(), SceneError> {
        let Some(name) = plate.symmetry().name() else { return Ok(()) };
        let alone = self.eliminate(plate, equations, places)?;
        for (equation, place) in equations.iter().zip(places) {
            let images = equation.terms.iter().map(|(dof, factor)| {
                plate.symmetry().images(plate, *dof).map(|(image, sign)| (image, sign * factor)).collect::<Vec<_>>()
            });
            let images: Vec<_> = images.collect();
            for operation in 0..plate.symmetry().operations().count() {
                let image: Vec<_> = images.iter().map(|images| images[operation]).collect();
                if !alone.implies(&image) {
                    let missing = image.first().map_or_else(String::new, |(dof, _)| plate.describe(*dof));
                    let message = format!(
                        "{} breaks the symmetry `{name}`: nothing of that kind holds its image, {missing}",
                        equation.origin
                    );
                    return Err(self.scene.source.error_at(place, message, "support both, or leave `symmetry` out"));
                }
            }
        }
        Ok(())
    }

    /// Refuses an impact that the symmetry moves.
    pub(super) fn symmetric_impact(
        &self,
        plate: &Plate,
        at: &Located<ImpactPoint>,
        centre: [f64; 2],
    ) -> Result<(), SceneError> {
        match plate.symmetry().name() {
            Some(name) if !plate.symmetry().keeps(centre) => {
                let [x, y] = centre.map(|c| c * 1e3);
                let message = format!("an impact at ({x:.6}, {y:.6}) mm breaks the symmetry `{name}`");
                let help = "strike the axis of a half-turn, a point of a mirror's plane; or leave `symmetry` out";
                Err(self.error(at, message, help))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a load that makes `forces`, one per unknown, unsymmetric.
    pub(super) fn symmetric_load(&self, plate: &Plate, forces: &[f64], place: &Place) -> Result<(), SceneError> {
        self.symmetric_forces(plate, "the load breaks", forces, place)
    }

    /// The same of other forces: `what` breaks the symmetry.
    pub(super) fn symmetric_forces(
        &self,
        plate: &Plate,
        what: &str,
        forces: &[f64],
        place: &Place,
    ) -> Result<(), SceneError> {
        let Some(name) = plate.symmetry().name() else { return Ok(()) };
        // Forces and moments have scales of their own.
        let mut largest = [0.0_f64; 2];
        let kind = |dof: usize| usize::from(plate.locate(dof).2.m() > 0);
        for (dof, force) in forces.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            largest[kind(dof)] = largest[kind(dof)].max(force.abs());
        }
        // Moments that are rounding alone have no scale of their own.
        largest[1] = largest[1].max(largest[0] * (plate.levels[plate.levels.len() - 1] - plate.levels[0]));
        for (dof, force) in forces.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            for (image, sign) in plate.symmetry().images(plate, dof) {
                if (forces[image] - sign * force).abs() > ROUNDING * largest[kind(dof)] {
                    let message = format!(
                        "{what} the symmetry `{name}`: there is no image of what acts on {}",
                        plate.describe(dof)
                    );
                    let help = "make it symmetric, or leave `symmetry` out";
                    return Err(self.scene.source.error_at(place, message, help));
                }
            }
        }
        Ok(())
    }
}
