//! Serendipity solids: three translations a node, quadratic in q.

use crate::large::{Gradients, Solid};
use crate::prism::{self, Prism};
use crate::transverse::TransverseStresses;
use fem_core::dof::Dof;
use fem_core::element::{Cell, Element, ElementError, ElementInfo, Part, PlaneMap, Point, Scratch};
use fem_core::large::LargeDeflection;
use std::fmt::Debug;

/// Translations.
pub(crate) const DOFS: [Dof; 3] = [Dof::SOLID[0], Dof::SOLID[4], Dof::SOLID[8]];

/// Serendipity solid of `F` nodes; sides in the plane may be bent.
#[derive(Debug, Clone)]
pub struct Serendipity<const F: usize> {
    pub(crate) info: ElementInfo,
    /// The form of the element for triangles, where this is the one for quadrilaterals.
    pub(crate) triangular: Option<Box<Serendipity<15>>>,
}

/// What tells one from another.
pub(crate) trait Functions: Debug + Clone + Send + Sync + 'static {
    /// The function of node `i` at an in-plane point and its derivatives along r and s, as coefficients of q⁰ q¹ q².
    fn node_functions(i: usize, r: f64, s: f64) -> [[f64; 3]; 3];
}

impl<const F: usize> Prism<F, 3> for Serendipity<F>
where
    Self: Functions,
{
    fn values(&self, _cell: &Cell<'_>, r: f64, s: f64) -> [[f64; 3]; F] {
        std::array::from_fn(|node| Self::node_functions(node, r, s)[0])
    }

    fn gradients(&self, cell: &Cell<'_>, r: f64, s: f64, plane: &PlaneMap, mut each: impl FnMut(usize, [[f64; 3]; 3])) {
        let h = cell.half_height();
        for f in 0..F {
            let [n, n_r, n_s] = Self::node_functions(f, r, s);
            let by = |d: usize| std::array::from_fn(|k| plane.inverse[0][d] * n_r[k] + plane.inverse[1][d] * n_s[k]);
            each(f, [by(0), by(1), [n[1] / h, 2.0 * n[2] / h, 0.0]]);
        }
    }

    fn unknown(component: usize, function: usize) -> usize {
        3 * function + component
    }
}

impl<const F: usize> Element for Serendipity<F>
where
    Self: Functions,
{
    fn info(&self) -> &ElementInfo {
        &self.info
    }

    fn strain_operator(&self, cell: &Cell<'_>, _slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        prism::strain_operator(self, cell, xi, b)
    }

    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        prism::shape(self, cell, xi, n)
    }

    fn stiffness(&self, cell: &Cell<'_>, scratch: &mut Scratch, ke: &mut [f64]) -> Result<(), ElementError> {
        prism::stiffness(self, cell, scratch, ke)
    }

    fn mass(&self, cell: &Cell<'_>, scratch: &mut Scratch, me: &mut [f64]) -> Result<(), ElementError> {
        prism::mass(self, cell, scratch, me)
    }

    fn mean_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        _scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        prism::mean_strains(self, cell, (parts, plane), b)
    }

    fn triangular(&self) -> Option<&dyn Element> {
        self.triangular.as_deref().map(|wedge| wedge as &dyn Element)
    }

    fn takes_bent_sides(&self) -> bool {
        true
    }

    fn large_deflections(&self) -> Option<&dyn LargeDeflection> {
        Some(self)
    }
}

fn with_solid<const F: usize, T>(
    element: &Serendipity<F>,
    cell: &Cell<'_>,
    with: impl FnOnce(&Solid<'_, F, 3>) -> T,
) -> T
where
    Serendipity<F>: Functions,
{
    let fill = |r: f64, s: f64, plane: &PlaneMap, out: &mut Gradients<F, 3>| {
        element.gradients(cell, r, s, plane, |f, gradient| out[f] = gradient);
    };
    with(&Solid {
        info: &element.info,
        gradients: &fill,
        unknown: |n, f| Some(Serendipity::<F>::unknown(n, f)),
        stresses: TransverseStresses::OfStrains,
    })
}

impl<const F: usize> LargeDeflection for Serendipity<F>
where
    Self: Functions,
{
    fn internal(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, ElementError> {
        with_solid(self, cell, |solid| solid.internal(cell, u, scratch, force, tangent))
    }

    fn geometric_stiffness(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        kg: &mut [f64],
    ) -> Result<(), ElementError> {
        with_solid(self, cell, |solid| solid.geometric_stiffness(cell, u, scratch, kg))
    }

    fn large_strain(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], u: &[f64]) -> Result<[f64; 6], ElementError> {
        with_solid(self, cell, |solid| solid.strain(cell, slice, xi, u))
    }

    fn mean_large_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        u: &[f64],
        strains: &mut [f64],
    ) -> Result<(), ElementError> {
        with_solid(self, cell, |solid| solid.mean_strains(cell, (parts, plane), u, strains))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Hex20, Wedge15};

    fn interpolates<const F: usize>(element: &Serendipity<F>)
    where
        Serendipity<F>: Functions,
    {
        for i in 0..F {
            for (j, [r, s, q]) in element.info.nodes.iter().enumerate() {
                let [c0, c1, c2] = Serendipity::<F>::node_functions(i, *r, *s)[0];
                assert_eq!(c0 + q * (c1 + q * c2), f64::from(u8::from(i == j)), "function {i} at node {j}");
            }
            let (r, s, d) = (0.31, -0.57, 1e-6);
            let [_, by_r, by_s] = Serendipity::<F>::node_functions(i, r, s);
            for k in 0..3 {
                let value = |r, s| Serendipity::<F>::node_functions(i, r, s)[0][k];
                assert!((by_r[k] - (value(r + d, s) - value(r - d, s)) / (2.0 * d)).abs() < 1e-9);
                assert!((by_s[k] - (value(r, s + d) - value(r, s - d)) / (2.0 * d)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn functions_interpolate_and_their_derivatives_are_those_of_the_functions() {
        interpolates(&Hex20::new(Hex20::IN_PLANE_ORDER).unwrap());
        interpolates(&Wedge15::default());
    }
}
