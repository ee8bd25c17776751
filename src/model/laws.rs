//! The laws that plies follow.

use super::builder::{Builder, build};
use crate::registry::{NO_REDUCTION, RegistryError};
use fem_core::element::{Element, Stack};
use fem_core::laminate::Laminate;
use fem_core::laws::{LawsError, PlyLaws};
use fem_core::material::Material;
use fem_core::plate::Plate;
use fem_core::plugin::{Built, Dimension, Kind};
use fem_core::ply_law::PlyLaw;
use fem_io::scene::{Place, PluginSpec, SceneError, Window};

/// Components 33, 23 and 31.
const TRANSVERSE: [usize; 3] = [2, 4, 5];

/// Largest ratio of their stiffnesses among the plies of a layer. Plies of one material at all angles, and of carbon beside glass, are
/// below it and are a hundredth too stiff; the core of a sandwich is far beyond.
const CONTRAST: f64 = 4.0;

impl Builder<'_> {
    /// Whether some plies follow laws.
    pub(super) fn has_laws(&self) -> bool {
        self.scene.plies().any(|ply| self.scene.laws[ply.material].is_some())
    }

    /// Refuses layers of cells across which the stiffness against transverse stresses changes much: plies that follow laws have the
    /// strains of their layer, and a soft core that bends like its faces is far too stiff.
    pub(super) fn check_contrast(&self, stacks: &[Stack]) -> Result<(), SceneError> {
        let layered = stacks.iter().filter(|stack| stack.transverse.is_some());
        let contrast = |stack: &Stack, i: usize| {
            let of = stack.slices.iter().map(|slice| slice.c[i][i]);
            let (low, high) = of.fold((f64::INFINITY, 0.0_f64), |(low, high), c| (low.min(c), high.max(c)));
            high / low
        };
        let largest = layered.flat_map(|stack| TRANSVERSE.map(|i| contrast(stack, i))).fold(1.0, f64::max);
        if largest < CONTRAST {
            return Ok(());
        }
        let message = format!(
            "a layer of cells holds plies of which one is {largest:.0} times as stiff through the thickness as another, and beside \
             plies that follow laws the strains of a layer are smooth"
        );
        let help = "let layers end where stiff plies meet soft ones: `layers = [3, 1, 3]` says how many plies each holds, from the \
                    bottom up; or leave the `law` out";
        Err(self.error(&self.scene.laminates[0].laminate, message, help))
    }

    /// What the user should know of a window that plies with laws do not have.
    pub(super) fn spread_window(&self, plate: &Plate, watched: &[usize]) -> Option<String> {
        let failure = &self.scene.failure;
        let Window::Square(side) = failure.window else { return None };
        let judged = self.has_laws() && !failure.criteria.is_empty();
        let widest = watched.iter().map(|quad| plate.plane.quality(*quad).area.sqrt()).fold(0.0, f64::max);
        (judged && widest > side).then(|| {
            let [side, widest] = [side, widest].map(|length| Dimension::LENGTH.of(length));
            format!(
                "plies follow laws, and their stresses are means over a cell, up to {widest} wide, not over the `failure.window` of {side}: \
                 indices beside stress peaks come out smaller; make cells there as small as the window"
            )
        })
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
