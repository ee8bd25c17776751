//! The report's solid element: a quadrilateral prism with twelve unknowns a node (eqs 16-23).

use crate::hermite::{self, CORNERS, NodeFunctions, Quartet};
use crate::hermite_solid::{Functions, HermiteSolid, Mass};
use crate::hermite_wedge::HermiteWedge;
use crate::transverse::TransverseStresses;
use fem_core::dof::Dof;
use fem_core::domain::Domain;
use fem_core::element::{ElementError, ElementInfo};
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo, Role};
use fem_core::quadrature::MAX_POINTS;

/// Functions of a cell per displacement component: 8 nodes × (value, ∂x, ∂y, ∂z).
pub(crate) const F: usize = 32;
/// Unknowns of a cell.
pub(crate) const N: usize = 96;

/// Quadrilateral prism with plane, parallel faces and upright edges; on triangles it is the [`HermiteWedge`].
///
/// Nodes as in [`CORNERS`]. Reproduces complete cubics on parallelograms; on general quadrilaterals {1, x, y} × {1, z, z², z³}.
pub type HermitePrism = HermiteSolid<32, 16>;

impl Functions for HermitePrism {
    fn node_functions(i: usize, r: f64, s: f64) -> NodeFunctions {
        hermite::node_functions(CORNERS[i], r, s)
    }

    fn linear(i: usize, r: f64, s: f64) -> Quartet {
        hermite::trilinear(CORNERS[i], r, s)
    }
}

impl HermitePrism {
    /// In-plane order 4 is exact on parallelograms and triangles.
    pub const IN_PLANE_ORDER: usize = 4;

    /// # Errors
    /// In-plane orders below 3, which leave zero-energy modes, and above [`MAX_POINTS`].
    pub fn new(mass: Mass, in_plane_order: usize) -> Result<Self, ElementError> {
        if !(3..=MAX_POINTS).contains(&in_plane_order) {
            return Err(ElementError(format!(
                "in-plane order {in_plane_order}: at least 3 Gauss points a direction are needed (2 leave 25 zero-energy \
                 modes), at most {MAX_POINTS} are offered"
            )));
        }
        Ok(Self::of_order(mass, in_plane_order))
    }

    pub(crate) fn of_order(mass: Mass, in_plane_order: usize) -> Self {
        let info = ElementInfo {
            domain: Domain::Quadrilateral,
            nodes: &CORNERS,
            dofs: &Dof::SOLID,
            in_plane_order,
            ply_order: 4,
        };
        Self::of(info, mass, Some(HermiteWedge::of_order(mass, in_plane_order)))
    }
}

const ORDER: ParamInfo = ParamInfo::count("in_plane_order", "Gauss points per in-plane direction")
    .at_least(3.0)
    .at_most(MAX_POINTS as f64)
    .default(HermitePrism::IN_PLANE_ORDER as f64)
    .role(Role::Quadrature);

impl Plugin for HermitePrism {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Element,
        name: "hermite-prism",
        summary: "prism on quadrilaterals and wedge on triangles, 12 unknowns a node, any number of plies through one cell",
        source: "AFWAL-TR-87-4117, eqs 16-23; on triangles Bazeley, Cheung, Irons and Zienkiewicz (1965)",
        params: &[Mass::PARAM, ORDER, TransverseStresses::PARAM],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let built = Self::new(Mass::of(params)?, params.count(&ORDER)?)
            .map_err(|e| ParamError::new(ORDER.name, e.to_string()))?;
        Ok(Built::Element(Box::new(built.with_transverse_stresses(TransverseStresses::of(params)?))))
    }
}
