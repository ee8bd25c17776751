//! Elements of a deck: those of the registry, integrated by NORDER points.

use fem_core::element::{Cell, Element, ElementError, ElementInfo, Part, Point, Scratch};
use fem_core::large::LargeDeflection;
use fem_elements::{HermitePrism, Mass, PlaneState, TransverseStresses, WebsterBeam};
use fem_io::deck::PieceKind;

/// The order from which on rectangles are exact; elements do it faster than point by point.
const EXACT: usize = 4;

/// The element of `kind` with `order` Gauss points along each axis of the plane and through each ply.
///
/// # Errors
/// An order that the element does not know.
pub(super) fn element(kind: PieceKind, order: usize) -> Result<Box<dyn Element>, ElementError> {
    let section = |state| WebsterBeam::new(state, Mass::Linear, EXACT).map(|e| Box::new(e) as Box<dyn Element>);
    let exact: Box<dyn Element> = match kind {
        PieceKind::PlaneStress => section(PlaneState::Stress)?,
        PieceKind::PlaneStrain => section(PlaneState::Strain)?,
        PieceKind::Solid => {
            Box::new(HermitePrism::new(Mass::Linear, EXACT)?.with_transverse_stresses(TransverseStresses::OfStrains))
        }
    };
    if order == EXACT {
        return Ok(exact);
    }
    let info = ElementInfo { in_plane_order: order, ply_order: order, ..*exact.info() };
    Ok(Box::new(ByPoints { exact, info }))
}

/// An element whose stiffness is the sum over Gauss points that `info` says; its mass and means stay exact.
#[derive(Debug, Clone)]
struct ByPoints {
    exact: Box<dyn Element>,
    info: ElementInfo,
}

impl Element for ByPoints {
    fn info(&self) -> &ElementInfo {
        &self.info
    }

    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        self.exact.strain_operator(cell, slice, xi, b)
    }

    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.exact.shape(cell, xi, n)
    }

    fn mass(&self, cell: &Cell<'_>, scratch: &mut Scratch, me: &mut [f64]) -> Result<(), ElementError> {
        self.exact.mass(cell, scratch, me)
    }

    fn mean_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        self.exact.mean_strains(cell, parts, plane, scratch, b)
    }

    fn large_deflections(&self) -> Option<&dyn LargeDeflection> {
        self.exact.large_deflections()
    }
}
