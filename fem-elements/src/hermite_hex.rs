//! The report's solid element on parallelograms: the Jacobian is constant, so the matrices are tables times moments.

use crate::hermite::{self, Quartet};
use crate::hermite_prism::{F, HermitePrism, N};
use crate::hermite_solid::{Functions, Mass, column, to_global};
use crate::prism::{BLOCKS, STRAIN_ROW, matrix, multiply};
use crate::transverse::TransverseStresses;
use fem_core::cubic_strains::CubicStrains;
use fem_core::element::{Cell, Element, ElementError, ElementInfo, Part, PlaneMap, Point, Scratch, positive};
use fem_core::large::LargeDeflection;
use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
use fem_core::quadrature::gauss_legendre;
use std::sync::LazyLock;

/// Powers of q in a product of two cubics.
const POWERS: usize = 7;
/// Pairs of natural directions times powers of q.
const TERMS: usize = 9 * POWERS;

/// [`HermitePrism`] for layers whose quadrilaterals are parallelograms; it refuses others.
///
/// On a parallelogram the derivatives ∂/∂x are constant combinations of ∂/∂r, so the integrals over the natural cube
/// are the same for every cell. They are kept in a table and one matrix product gives the exact stiffness (the tensor
/// representation of Kirby and Logg, 2006), for components n, n′ and functions f, f′ with natural derivatives as unknowns
///
/// K(n,n′)\[f,f′\] = Σ over a, a′, m of T\[f,f′\]\[a,a′,m\] D\[a,a′,m\](n,n′)
///
/// * T = ∫∫ of the coefficient of qᵐ in ∂f/∂ξ\[a\] ∂f′/∂ξ\[a′\] over r and s
/// * D = |J| Σ over d, d′ of ∂ξ\[a\]/∂x\[d\] ∂ξ\[a′\]/∂x\[d′\] Mₘ\[row(n,d)\]\[row(n′,d′)\]
///
/// Half the time of the prism, whose results it gives to rounding.
#[derive(Debug, Clone)]
pub struct HermiteHex {
    prism: HermitePrism,
    mass: Mass,
}

impl HermiteHex {
    /// With the given inertia.
    pub fn new(mass: Mass) -> Self {
        let prism = HermitePrism::of_order(mass, HermitePrism::IN_PLANE_ORDER);
        Self { prism: prism.with_transverse_stresses(TransverseStresses::OfStrains), mass }
    }
}

/// The map of the quadrilateral, the same everywhere to rounding: 1e-12 of its size.
///
/// # Errors
/// Another shape.
fn constant_map(cell: &Cell<'_>) -> Result<PlaneMap, ElementError> {
    let [a, b, c, d] = cell.corners.four();
    let size = (0..2).map(|k| (c[k] - a[k]).abs().max((d[k] - b[k]).abs())).fold(0.0, f64::max);
    if (0..2).all(|k| (a[k] - b[k] + c[k] - d[k]).abs() <= 1e-12 * size) {
        Ok(cell.plane(0.0, 0.0))
    } else {
        Err(ElementError(
            "the quadrilateral is not a parallelogram: use the element `hermite-prism` for this mesh".into(),
        ))
    }
}

/// ∫∫ over r, s of the coefficients of q⁰ … q⁶ in all products of two of the `fields` of two of the 32 functions: one
/// column of A² × 7 per pair of functions.
fn table<const A: usize>(fields: impl Fn(usize, f64, f64) -> [Quartet; A]) -> Vec<f64> {
    let mut table = vec![0.0; F * F * A * A * POWERS];
    let rule = gauss_legendre(HermitePrism::IN_PLANE_ORDER);
    for (&(r, wr), &(s, ws)) in rule.iter().flat_map(|r| rule.iter().map(move |s| (r, s))) {
        let values: [_; F] = std::array::from_fn(|f| fields(f, r, s));
        for (at, column) in table.chunks_exact_mut(A * A * POWERS).enumerate() {
            let (left, right) = (&values[at % F], &values[at / F]);
            for (at, powers) in column.chunks_exact_mut(POWERS).enumerate() {
                for (k, p) in left[at / A].iter().enumerate() {
                    for (k2, p2) in right[at % A].iter().enumerate() {
                        powers[k + k2] += wr * ws * p * p2;
                    }
                }
            }
        }
    }
    table
}

static STIFFNESS: LazyLock<Vec<f64>> = LazyLock::new(|| {
    table(|f, r, s| {
        let (natural, m) = (HermitePrism::node_functions(f / 4, r, s), f % 4);
        [natural.n_r[m], natural.n_s[m], hermite::derivative(&natural.n[m])]
    })
});
static CUBIC_MASS: LazyLock<Vec<f64>> = LazyLock::new(|| mass_table(Mass::Cubic));
static LINEAR_MASS: LazyLock<Vec<f64>> = LazyLock::new(|| mass_table(Mass::Linear));

fn mass_table(mass: Mass) -> Vec<f64> {
    table(|f, r, s| [HermitePrism::inertia_functions(mass, f / 4, r, s)[f % 4]])
}

/// Turns products of functions with natural derivatives as unknowns into those with global ones, node pair by node pair.
fn scatter(map: &PlaneMap, h: f64, product: impl Fn(usize) -> f64, mut put: impl FnMut(usize, usize, f64)) {
    let transposed = |a: [Quartet; 4]| -> [Quartet; 4] { std::array::from_fn(|i| a.map(|row| row[i])) };
    for (f, f2) in (0..F).step_by(4).flat_map(|f2| (0..F).step_by(4).map(move |f| (f, f2))) {
        let natural = std::array::from_fn(|m2| std::array::from_fn(|m| product(f + m + F * (f2 + m2))));
        let right = to_global(&map.jacobian, h, &natural);
        let both = to_global(&map.jacobian, h, &transposed(right));
        for (m, row) in both.iter().enumerate() {
            for (m2, value) in row.iter().enumerate() {
                put(f + m, f2 + m2, *value);
            }
        }
    }
}

impl Element for HermiteHex {
    fn info(&self) -> &ElementInfo {
        self.prism.info()
    }

    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        self.prism.strain_operator(cell, slice, xi, b)
    }

    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.prism.shape(cell, xi, n)
    }

    fn inertia_shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.prism.inertia_shape(cell, xi, n)
    }

    fn stiffness(&self, cell: &Cell<'_>, scratch: &mut Scratch, ke: &mut [f64]) -> Result<(), ElementError> {
        let map = constant_map(cell)?;
        let h = cell.half_height();
        let volume = positive(map.det * h)?;
        let [r, s] = map.inverse;
        let inverse = [[r[0], r[1], 0.0], [s[0], s[1], 0.0], [0.0, 0.0, 1.0 / h]];
        let [geometry, products] = scratch.arrays([BLOCKS.len() * TERMS, BLOCKS.len() * F * F]);
        for (pair, geometry) in geometry.chunks_exact_mut(BLOCKS.len() * POWERS).enumerate() {
            let (by, by2) = (&inverse[pair / 3], &inverse[pair % 3]);
            for (d, d2) in (0..3).flat_map(|d| (0..3).map(move |d2| (d, d2))) {
                let factor = volume * by[d] * by2[d2];
                // Most are zero: r and s depend on x and y alone, q on z.
                if factor != 0.0 {
                    for (column, moment) in geometry.chunks_exact_mut(BLOCKS.len()).zip(&cell.stack.stiffness_moments) {
                        for (value, (n, n2)) in column.iter_mut().zip(&BLOCKS) {
                            *value += factor * moment[STRAIN_ROW[*n][d]][STRAIN_ROW[*n2][d2]];
                        }
                    }
                }
            }
        }
        multiply(products, matrix(geometry, BLOCKS.len()), matrix(&STIFFNESS[..], TERMS));
        for (b, (n, n2)) in BLOCKS.iter().enumerate() {
            scatter(
                &map,
                h,
                |i| products[BLOCKS.len() * i + b],
                |f, f2, value| {
                    ke[column(*n, f) + N * column(*n2, f2)] = value;
                    ke[column(*n2, f2) + N * column(*n, f)] = value;
                },
            );
        }
        Ok(())
    }

    fn mass(&self, cell: &Cell<'_>, scratch: &mut Scratch, me: &mut [f64]) -> Result<(), ElementError> {
        let map = constant_map(cell)?;
        let h = cell.half_height();
        let volume = positive(map.det * h)?;
        let table = match self.mass {
            Mass::Cubic => &CUBIC_MASS,
            Mass::Linear => &LINEAR_MASS,
        };
        let [products] = scratch.arrays([F * F]);
        for (product, column) in products.iter_mut().zip(table.chunks_exact(POWERS)) {
            *product = volume * column.iter().zip(&cell.stack.density_moments).map(|(t, m)| t * m).sum::<f64>();
        }
        me.fill(0.0);
        scatter(
            &map,
            h,
            |i| products[i],
            |f, f2, value| {
                for component in 0..3 {
                    me[column(component, f) + N * column(component, f2)] = value;
                    me[column(component, f2) + N * column(component, f)] = value;
                }
            },
        );
        Ok(())
    }

    fn mean_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        constant_map(cell)?;
        self.prism.mean_strains(cell, parts, plane, scratch, b)
    }

    fn triangular(&self) -> Option<&dyn Element> {
        self.prism.triangular()
    }

    fn cubic_strains(&self) -> Option<&dyn CubicStrains> {
        self.prism.cubic_strains()
    }

    fn large_deflections(&self) -> Option<&dyn LargeDeflection> {
        Some(&self.prism)
    }
}

impl Plugin for HermiteHex {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Element,
        name: "hermite-hex",
        summary: "the report's solid on rectangles and parallelograms only; refuses other quadrilaterals",
        source: "AFWAL-TR-87-4117, eqs 16-23",
        params: &[Mass::PARAM],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Element(Box::new(Self::new(Mass::of(params)?))))
    }
}
