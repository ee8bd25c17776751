//! Loads in the plane of the plate that act before all else.

use super::OFF;
use crate::effect::{
    Body, EdgeLoad, Effect, EffectInfo, EffectPlugin, Exclusion, Facts, Feature, Gripped, Marched, Wish,
};
use crate::error::Error;
use crate::forecast::Demand;
use fem_core::assembly::{Symmetric, add_geometric_stiffness, displacements_at_rest};
use fem_core::plugin::Dimension;
use fem_core::recovery::Recovery;
use fem_io::scene::{Analysis, Form, Keys, SceneError, SceneValue, key};
use std::num::NonZeroUsize;
use std::sync::{Arc, OnceLock};

/// Loads or displacements of edges in the plane of the plate, before supports hold these edges and anything else happens: their
/// stresses stiffen the plate against deflections, or soften it, and are those with which it starts.
///
/// Stresses are those of the linear elastic plate, and displacements count from the plate that they have strained.
#[derive(Debug, Clone)]
pub struct Preload {
    edges: Vec<EdgeLoad>,
    gripped: Option<Arc<Gripped>>,
    /// Displacements of the preload, once they are known.
    displaced: Arc<OnceLock<Vec<f64>>>,
}

/// Force per length.
const LINE: Dimension = Dimension([0.0, 1.0, -2.0, 0.0]);

const KEYS: Keys = &[
    key("group", Form::Text, r#""x-max""#, "edges of the plate, a group of the mesh").required(),
    key("force", Form::Quantity(LINE), r#""-50 N/mm""#, "per length along the normal; tension is positive"),
    key(
        "shear",
        Form::Quantity(LINE),
        r#""20 N/mm""#,
        "force per length along the edge, anticlockwise round the plate",
    ),
    key(
        "displacement",
        Form::Quantity(Dimension::LENGTH),
        r#""-0.1 mm""#,
        "of a straight edge along its normal, instead of `force`; outwards is positive",
    ),
];

impl EffectPlugin for Preload {
    const INFO: EffectInfo = EffectInfo {
        key: key(
            "preload",
            Form::OneOf(&[OFF, Form::List(&Form::Table(KEYS))]),
            r#"[{ group = "x-max", force = "-50 N/mm" }]"#,
            "loads of edges in the plane of the plate before all else; supports hold these edges afterwards",
        )
        .default(r#""off""#),
        source: "Bryan 1891; Timoshenko and Gere 1961",
        columns: &[],
        advice: None,
    };

    fn read(value: &SceneValue<'_>) -> Result<Wish, SceneError> {
        if value.is_text() {
            value.choice(&[("off", ())])?;
            return Ok(Wish::Off);
        }
        let edges = value.list()?.iter().map(read).collect::<Result<_, _>>()?;
        Ok(Wish::On(Box::new(Self { edges, gripped: None, displaced: Arc::default() })))
    }
}

fn read(value: &SceneValue<'_>) -> Result<EdgeLoad, SceneError> {
    let table = value.table(KEYS)?;
    let group = table.required("group")?;
    let quantity = |key, dimension| table.optional(key).map(|field| field.quantity(dimension)).transpose();
    let (force, shear) = (quantity("force", LINE)?, quantity("shear", LINE)?);
    let displacement = quantity("displacement", Dimension::LENGTH)?;
    if force.is_some() && displacement.is_some() {
        return Err(value.error(
            "gives both force and displacement along the normal",
            "keep one of them: the other follows from it",
        ));
    }
    if force.or(shear).or(displacement).is_none() {
        return Err(value.error(
            "does not say how much",
            "give `force`, `shear` or `displacement`; force = \"0 N/mm\" leaves the edge free while others are loaded",
        ));
    }
    let group = group.at(group.text()?.to_owned());
    Ok(EdgeLoad { group, force: force.unwrap_or(0.0), shear: shear.unwrap_or(0.0), displacement })
}

impl Preload {
    /// Displacements of the preload, one per unknown.
    fn displacements(&self, body: &Body<'_>) -> Result<&[f64], Error> {
        if let Some(known) = self.displaced.get() {
            return Ok(known);
        }
        let Some(gripped) = &self.gripped else { return Ok(&[]) };
        let Gripped { constraints, forces } = &**gripped;
        let found = displacements_at_rest(body.plate, body.element, constraints, forces, NonZeroUsize::MIN)?;
        Ok(self.displaced.get_or_init(|| found))
    }
}

impl Effect for Preload {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn excludes(&self) -> &'static [Exclusion] {
        const EXCLUDED: &[Exclusion] = &[
            Exclusion::new(
                Feature::Substructures,
                "the stresses of a preload do not reach the inside of condensed substructures",
                "leave one of `substructures` and `effects.preload` out",
            ),
            Exclusion::new(
                Feature::EccentricSteps,
                "a preload bends a plate whose regions have their mid-planes at different heights, and it is that of a plane plate",
                "write align = \"middle\", or leave `effects.preload` out",
            ),
            Exclusion::new(
                Feature::PlyLaws,
                "a preload is that of linear elastic plies, but plies follow a law",
                "leave it out, or the `law` of the material",
            ),
            Exclusion::new(
                Feature::EquilibriumProfile,
                "`equilibrium` integrates stresses of a plate without a preload",
                "leave `equilibrium` out, or `effects.preload`",
            ),
        ];
        EXCLUDED
    }

    fn check(&self, facts: &Facts<'_>) -> Result<(), SceneError> {
        if facts.element.large_deflections().is_none() {
            return Err(facts.refuse(
                format!("the element `{}` does not carry a preload", facts.scene.element.name.value),
                "use an element that knows large deflections, such as `hermite-prism` or `mitc4`, or leave `preload` out",
            ));
        }
        if matches!(facts.scene.analysis, Analysis::Static(_)) && facts.effects.contains(&"cure") {
            return Err(facts.refuse(
                "at rest, strains of cure would count twice: in the preload and under the loads",
                "leave one of `effects.cure` and `effects.preload` out",
            ));
        }
        Ok(())
    }

    fn memory(&self, body: &Body<'_>, _demand: &Demand) -> f64 {
        // Displacements of the preload, and places of its unknowns among the independent ones.
        5.0 * 8.0 * body.plate.ndof() as f64
    }

    fn edges(&self) -> &[EdgeLoad] {
        &self.edges
    }

    fn on_edges(&mut self, gripped: Gripped) {
        (self.gripped, self.displaced) = (Some(Arc::new(gripped)), Arc::default());
    }

    fn add_geometric(&self, body: &Body<'_>, sum: &mut Symmetric) -> Result<(), Error> {
        let u = self.displacements(body)?;
        Ok(add_geometric_stiffness(body.plate, body.element, body.constraints, u, sum)?)
    }

    /// Large deflections of a full plate have forces of their own; a reduced one has its K.
    fn on_structure(&mut self, body: &Body<'_>, plate: &mut Marched) -> Result<(), Error> {
        if plate.reduced.is_none() {
            let mut geometric = Symmetric::zero(plate.full.matrices().0.pattern().clone());
            self.add_geometric(body, &mut geometric)?;
            plate.full.carry(&geometric);
        }
        Ok(())
    }

    fn displaced(&self, body: &Body<'_>) -> Result<Option<Vec<f64>>, Error> {
        Ok(Some(self.displacements(body)?.to_vec()))
    }

    fn stresses(&self, body: &Body<'_>, recovery: &Recovery) -> Result<Option<Vec<f64>>, Error> {
        let mut stresses = vec![0.0; 6 * recovery.sites()];
        recovery.small_stresses(body.plate, body.element, self.displacements(body)?, 1, &mut stresses)?;
        Ok(Some(stresses))
    }
}
