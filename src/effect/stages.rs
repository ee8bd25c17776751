//! What effects change on the way from matrices to a system that is marched.

use fem_core::assembly::SparseStructure;
use fem_core::constraint::Constraints;
use fem_core::functional::Functional;
use fem_core::springs::SupportSpring;
use fem_dynamics::reduce::{Companions, MembranePlate, Reduced};
use fem_io::scene::Located;

/// What is computed of a plate: linear and with inertia, unless effects change it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nature {
    /// Whether the plate has inertia; without it, it is at rest under the contact forces at every instant.
    pub inertia: bool,
    /// Whether deflections are large: strains are not linear in them.
    pub large: bool,
    /// Whether there are strains without loads.
    pub strained: bool,
    /// Acceleration of the impactors towards the plate, m/s².
    pub pull: f64,
}

impl Default for Nature {
    fn default() -> Self {
        Self { inertia: true, large: false, strained: false, pull: 0.0 }
    }
}

/// A plate that is marched, before impactors are coupled to it.
#[derive(Debug)]
pub struct Marched {
    /// The plate before its reduction.
    pub full: SparseStructure,
    /// In fewer coordinates, where it is reduced.
    pub reduced: Option<Reduced>,
    /// The reduced plate as its deflections stretch it, and what it does beside its modes.
    pub stretched: Option<(MembranePlate, Companions)>,
    /// Where impactors strike, each place once.
    pub contacts: Vec<Functional>,
    /// The springs that it lies on.
    pub springs: Vec<SupportSpring>,
}

/// What acts on an edge in the plane before all else.
#[derive(Debug, Clone)]
pub struct EdgeLoad {
    /// A group of edges.
    pub group: Located<String>,
    /// Force per length along the normal, which points out of the plate, N/m.
    pub force: f64,
    /// Force per length along the edge, anticlockwise round the plate, N/m.
    pub shear: f64,
    /// Displacement along the normal, m, where it is prescribed.
    pub displacement: Option<f64>,
}

/// A plate as it is held and loaded while [`EdgeLoad`]s act.
#[derive(Debug, Clone)]
pub struct Gripped {
    /// Supports, prescribed displacements and other equations, eliminated.
    pub constraints: Constraints,
    /// Nodal forces, one per unknown before elimination.
    pub forces: Vec<f64>,
}
