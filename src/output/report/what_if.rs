//! Impacts that the page marches by itself, on the reduced plate that it carries.

use crate::analyses::impact::CarriedPlate;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fem_failure::scan::PlyOrInterface;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// What the page marches, or why it cannot.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum WhatIf {
    /// Impacts on a plate.
    Plate(Box<WhatIfPlate>),
    /// Nothing, for a reason.
    Missing {
        /// The reason, a clause.
        why: String,
    },
}

/// A reduced plate, what strikes it and how it is judged, as the page's scripts read it. SI units.
#[derive(Debug, Clone, Serialize)]
pub struct WhatIfPlate {
    /// The impactor of the run.
    pub impact: WhatIfImpact,
    /// The contact law of the run.
    pub law: WhatIfLaw,
    /// The plate.
    #[serde(serialize_with = "carried")]
    pub plate: CarriedPlate,
    /// What judges the places.
    pub criteria: Vec<WhatIfCriterion>,
    /// Names of criteria that the page cannot compute.
    pub unjudged: Vec<String>,
    /// Strengths of each material, Pa, of those that the criteria ask for.
    pub strengths: Vec<(String, BTreeMap<&'static str, f64>)>,
    /// A of membrane stiffening A (w/h)², where supports surround the impact, and h, m.
    pub stretch: Option<(f64, f64)>,
}

/// The impactor and the march: Newmark's method.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct WhatIfImpact {
    pub mass: f64,
    pub velocity: f64,
    pub start: f64,
    pub step: f64,
    pub steps: u64,
    /// Steps between two samples of the stresses.
    pub sample: u64,
    pub until_separation: bool,
    pub beta: f64,
    pub gamma: f64,
}

/// Parameters of a contact law; those of unloading are absent where it is elastic.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct WhatIfLaw {
    pub name: String,
    pub k: f64,
    pub n: f64,
    pub unloading: Option<WhatIfUnloading>,
}

/// How Sun and Yang's law unloads.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct WhatIfUnloading {
    pub m: f64,
    pub critical: f64,
    pub beta: f64,
    pub reload_by_n: bool,
}

/// A criterion.
#[derive(Debug, Clone, Serialize)]
#[allow(missing_docs)]
pub struct WhatIfCriterion {
    /// What results call it.
    pub name: String,
    pub plugin: String,
    /// Sign of σ22 σ33 in Hashin's criterion as the report has it.
    pub plus: bool,
    pub interface: bool,
    pub modes: &'static [&'static str],
}

/// A place that is carried.
#[derive(Serialize)]
struct Place {
    place: String,
    angle_deg: f64,
    at_mm: [f64; 2],
    interface: bool,
    material: u16,
}

/// Numbers of the operator are bytes, little-endian, in base64: as many digits as the program has, and shorter than these.
fn carried<S: Serializer>(plate: &CarriedPlate, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Page<'a> {
        stiffness: &'a [f64],
        mass: &'a [f64],
        damping: &'a [f64],
        load: &'a [f64],
        places: Vec<Place>,
        operator: String,
        residual: &'a [f64],
        watched: usize,
        left: f64,
    }
    let bytes: Vec<u8> = plate.operator.iter().flat_map(|number| number.to_le_bytes()).collect();
    let places = plate.sites.iter().map(|site| Place {
        place: crate::words::name_ply(site.place),
        angle_deg: site.angle.to_degrees().round(),
        at_mm: [site.position[0], site.position[1]].map(|x| (x * 1e6).round() / 1e3),
        interface: matches!(site.place, PlyOrInterface::Interface(_)),
        material: site.material,
    });
    let page = Page {
        stiffness: &plate.stiffness,
        mass: &plate.mass,
        damping: &plate.damping,
        load: &plate.load,
        places: places.collect(),
        operator: STANDARD.encode(bytes),
        residual: &plate.residual,
        watched: plate.watched,
        left: plate.left,
    };
    page.serialize(serializer)
}
