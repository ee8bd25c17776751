//! The laws that plies follow.

use super::builder::{Builder, build};
use crate::registry::{NO_REDUCTION, RegistryError};
use fem_core::element::Element;
use fem_core::laminate::Laminate;
use fem_core::laws::{LawsError, PlyLaws};
use fem_core::material::Material;
use fem_core::plate::Plate;
use fem_core::plugin::{Built, Kind};
use fem_core::ply_law::PlyLaw;
use fem_io::scene::{Place, PluginSpec, SceneError};

impl Builder<'_> {
    /// Whether some plies follow laws.
    pub(super) fn has_laws(&self) -> bool {
        self.scene.plies().any(|ply| self.scene.laws[ply.material].is_some())
    }

    /// The laws of the plies, if some follow one, in the cells of a `zone` or in all.
    pub(super) fn laws(
        &self,
        plate: &Plate,
        laminates: &[Laminate],
        materials: &[Material],
        element: &dyn Element,
        zone: Option<&[u32]>,
    ) -> Result<Option<PlyLaws>, SceneError> {
        let lawful = self.scene.plies().find_map(|ply| self.scene.laws[ply.material].as_ref());
        let laminate = match (laminates, lawful) {
            ([_, _, ..], Some(spec)) => {
                let message = "plies that follow a law are not supported yet in a plate of several laminates";
                let help = "give the plate one laminate, or leave the `law` of the material out";
                return Err(self.error(&spec.name, message, help));
            }
            _ => &laminates[0],
        };
        let built = |spec: &Option<PluginSpec>| {
            let named = |spec: &PluginSpec| Ok((spec.name.value.clone(), self.ply_law(spec)?));
            spec.as_ref().map(named).transpose()
        };
        let laws = self.scene.laws.iter().map(built).collect::<Result<Vec<_>, _>>()?;
        let laws = PlyLaws::new(plate, laminate, materials, &laws, element, zone).map_err(|why| match &why {
            LawsError::Material(error) => {
                let spec = self.scene.laws.iter().zip(materials).find(|(_, m)| m.name == error.material);
                let place = spec.and_then(|(spec, _)| spec.as_ref()).map_or(&Place::TOP, |spec| &spec.name.place);
                self.scene.source.error_at(place, why.to_string(), "")
            }
            _ => {
                let name = &self.scene.element.name;
                let message = format!("plies that follow a law cannot be computed with `{}`: {why}", name.value);
                let help = "choose a solid element such as `hermite-prism`, or leave the `law` of the material out";
                self.error(name, message, help)
            }
        })?;
        if laws.is_some() {
            self.goes_with_laws()?;
        }
        Ok(laws)
    }

    fn ply_law(&self, spec: &PluginSpec) -> Result<Box<dyn PlyLaw>, SceneError> {
        build!(self, spec, PlyLaw)
    }

    /// Refuses what is right for linear elastic plies only; effects say it themselves.
    fn goes_with_laws(&self) -> Result<(), SceneError> {
        const LEAVE: &str = "leave it out, or the `law` of the material";
        let refuse = |place: &Place, message: &str, help: &str| {
            let message = format!("{message}, but plies follow a law");
            Err(self.scene.source.error_at(place, message, help))
        };
        if self.scene.substructures.is_some() {
            return refuse(&Place::TOP, "condensed `substructures` are linear", LEAVE);
        }
        if let Some(line) = self.scene.profiles.first() {
            let message = "stresses along a line through the thickness are those of linear elastic plies";
            return refuse(&line.name.place, message, LEAVE);
        }
        let Some(impact) = self.scene.impact() else { return Ok(()) };
        let reduction = &impact.reduction.name;
        if reduction.value != NO_REDUCTION {
            let help = "march the full plate: reduction = { method = \"none\" }";
            return refuse(&reduction.place, "a reduced plate is linear", help);
        }
        if self.integrator(impact)?.limit().product().is_some() {
            let message = "the stable step of an explicit integrator is that of linear elastic plies";
            let help = "choose an implicit integrator, for example: integrator = \"newmark\"";
            return refuse(&impact.march.integrator.name.place, message, help);
        }
        Ok(())
    }
}
