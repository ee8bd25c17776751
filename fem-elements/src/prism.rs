//! Solids whose functions are polynomials in q: their matrices from the thickness moments of the stack.
//!
//! With polynomials in q the integral through any number of plies is one Hankel matrix of moments, so a matrix costs the
//! same for one ply as for a hundred. For components n, n′ and scalar functions f
//!
//! K(n,n′) = Σ over in-plane points of w |J| G H(n,n′) Gᵀ, G: F × 3K (direction d, power k of q),
//! H(n,n′)\[(d,k),(d′,k′)\] = M\[k+k′\]\[row(n,d)\]\[row(n′,d′)\].

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use fem_core::element::{Cell, Element, ElementError, Part, PlaneMap, Point, Scratch, positive};

/// Row of the strain vector (11 22 33 12 23 31) to which ∂u\[component\]/∂\[direction\] belongs.
pub(crate) const STRAIN_ROW: [[usize; 3]; 3] = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];

/// Blocks (component, component) of the symmetric stiffness.
pub(crate) const BLOCKS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// A solid with the same `F` scalar functions for each displacement component, polynomials of `K` ≤ 4 coefficients in q.
pub(crate) trait Prism<const F: usize, const K: usize>: Element {
    /// Coefficients of q⁰, q¹ … of the functions at an in-plane point.
    fn values(&self, cell: &Cell<'_>, r: f64, s: f64) -> [[f64; K]; F];

    /// Calls `each(function, [∂x, ∂y, ∂z])` with the same of their derivatives.
    fn gradients(&self, cell: &Cell<'_>, r: f64, s: f64, plane: &PlaneMap, each: impl FnMut(usize, [[f64; K]; 3]));

    /// Unknown of the cell that multiplies a function in a component.
    fn unknown(component: usize, function: usize) -> usize;
}

/// [`Element::strain_operator`]
pub(crate) fn strain_operator<const F: usize, const K: usize, P: Prism<F, K>>(
    prism: &P,
    cell: &Cell<'_>,
    [r, s, q]: [f64; 3],
    b: &mut [f64],
) -> f64 {
    let plane = cell.plane(r, s);
    b.fill(0.0);
    prism.gradients(cell, r, s, &plane, |f, gradient| {
        for (d, polynomial) in gradient.iter().enumerate() {
            let value = at(polynomial, q);
            for (component, rows) in STRAIN_ROW.iter().enumerate() {
                b[6 * P::unknown(component, f) + rows[d]] = value;
            }
        }
    });
    plane.det * cell.half_height()
}

/// [`Element::shape`]
pub(crate) fn shape<const F: usize, const K: usize, P: Prism<F, K>>(
    prism: &P,
    cell: &Cell<'_>,
    [r, s, q]: [f64; 3],
    n: &mut [f64],
) -> f64 {
    n.fill(0.0);
    for (f, polynomial) in prism.values(cell, r, s).iter().enumerate() {
        for component in 0..3 {
            n[3 * P::unknown(component, f) + component] = at(polynomial, q);
        }
    }
    cell.plane(r, s).det * cell.half_height()
}

/// [`Element::stiffness`]
pub(crate) fn stiffness<const F: usize, const K: usize, P: Prism<F, K>>(
    prism: &P,
    cell: &Cell<'_>,
    scratch: &mut Scratch,
    ke: &mut [f64],
) -> Result<(), ElementError> {
    let points = prism.info().plane_points().count();
    let (dk, ndof) = (3 * K, 3 * F);
    let terms = dk * points;
    let [g, weighted, hankel, p, block] = scratch.arrays([F * terms, F * terms, 6 * dk * dk, 6 * F * terms, F * F]);
    // G: F × (3K · points), the point running fastest among the columns.
    for (point, (r, s, w)) in prism.info().plane_points().enumerate() {
        let plane = cell.plane(r, s);
        let dv = positive(plane.det * cell.half_height())? * w;
        prism.gradients(cell, r, s, &plane, |f, gradient| {
            for (i, value) in gradient.as_flattened().iter().enumerate() {
                let at = (i * points + point) * F + f;
                g[at] = *value;
                weighted[at] = dv * value;
            }
        });
    }
    // [H(1,1) | H(1,2) | ...]: 3K × 18K.
    for (b, (n, n2)) in BLOCKS.iter().enumerate() {
        for (j, column) in hankel[b * dk * dk..(b + 1) * dk * dk].chunks_exact_mut(dk).enumerate() {
            for (i, h) in column.iter_mut().enumerate() {
                let moment = &cell.stack.stiffness_moments[i % K + j % K];
                *h = moment[STRAIN_ROW[*n][i / K]][STRAIN_ROW[*n2][j / K]];
            }
        }
    }
    // P = G H with (function, point) as rows; read again, each block of P is F × (3K · points).
    multiply(p, matrix(weighted, F * points), matrix(hankel, dk));
    let g = matrix(g, F);
    for ((n, n2), p) in BLOCKS.iter().zip(p.chunks_exact(F * terms)) {
        multiply(block, matrix(p, F), g.transpose());
        for (f2, block) in block.chunks_exact(F).enumerate() {
            for (f, value) in block.iter().enumerate() {
                let (i, j) = (P::unknown(*n, f), P::unknown(*n2, f2));
                ke[i + ndof * j] = *value;
                ke[j + ndof * i] = *value;
            }
        }
    }
    Ok(())
}

/// [`Element::mass`] with the element's own functions.
pub(crate) fn mass<const F: usize, const K: usize, P: Prism<F, K>>(
    prism: &P,
    cell: &Cell<'_>,
    scratch: &mut Scratch,
    me: &mut [f64],
) -> Result<(), ElementError> {
    let points = prism.info().plane_points().count();
    let ndof = 3 * F;
    let terms = K * points;
    let [n, weighted, hankel, p, block] = scratch.arrays([F * terms, F * terms, K * K, F * terms, F * F]);
    for (point, (r, s, w)) in prism.info().plane_points().enumerate() {
        let dv = positive(cell.plane(r, s).det * cell.half_height())? * w;
        for (f, polynomial) in prism.values(cell, r, s).iter().enumerate() {
            for (k, value) in polynomial.iter().enumerate() {
                let at = (k * points + point) * F + f;
                n[at] = *value;
                weighted[at] = dv * value;
            }
        }
    }
    for (i, h) in hankel.iter_mut().enumerate() {
        *h = cell.stack.density_moments[i % K + i / K];
    }
    multiply(p, matrix(weighted, F * points), matrix(hankel, K));
    multiply(block, matrix(p, F), matrix(n, F).transpose());
    me.fill(0.0);
    for component in 0..3 {
        for f2 in 0..F {
            for f in 0..F {
                // The mean of both triangles: symmetric to the last bit.
                me[P::unknown(component, f) + ndof * P::unknown(component, f2)] =
                    0.5 * (block[f + F * f2] + block[f2 + F * f]);
            }
        }
    }
    Ok(())
}

/// [`Element::mean_strains`]
pub(crate) fn mean_strains<const F: usize, const K: usize, P: Prism<F, K>>(
    prism: &P,
    cell: &Cell<'_>,
    (parts, plane): (&[Part], &[Point]),
    b: &mut [f64],
) -> Result<(), ElementError> {
    let (mut means, mut area) = ([[[0.0; K]; 3]; F], 0.0);
    for point in plane {
        let [r, s] = point.at;
        let plane = cell.plane(r, s);
        let da = positive(plane.det * cell.half_height())? * point.weight();
        area += da;
        prism.gradients(cell, r, s, &plane, |f, gradient| {
            for (mean, value) in means[f].as_flattened_mut().iter_mut().zip(gradient.as_flattened()) {
                *mean += da * value;
            }
        });
    }
    b.fill(0.0);
    for (Part { q: [low, high], .. }, b) in parts.iter().zip(b.chunks_exact_mut(6 * 3 * F)) {
        // Mean of q⁰, q¹ … over the part, per area.
        let powers: [f64; K] = mean_powers(*low, *high).map(|mean| mean / area);
        for (f, gradient) in means.iter().enumerate() {
            for (d, polynomial) in gradient.iter().enumerate() {
                let value = polynomial.iter().zip(powers).map(|(a, b)| a * b).sum();
                for (component, rows) in STRAIN_ROW.iter().enumerate() {
                    b[6 * P::unknown(component, f) + rows[d]] = value;
                }
            }
        }
    }
    Ok(())
}

/// A polynomial's value at q.
fn at<const K: usize>(p: &[f64; K], q: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * q + c)
}

/// `m` rows, column-major.
pub(crate) fn matrix(a: &[f64], m: usize) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(a, m, a.len() / m)
}

/// Means of q⁰, q¹ … over low ≤ q ≤ high, or their values there where both are one.
pub(crate) fn mean_powers<const K: usize>(low: f64, high: f64) -> [f64; K] {
    std::array::from_fn(|k| {
        let p = k as i32 + 1;
        if high > low { (high.powi(p) - low.powi(p)) / (f64::from(p) * (high - low)) } else { low.powi(k as i32) }
    })
}

/// `out ← a b`
pub(crate) fn multiply(out: &mut [f64], a: MatRef<'_, f64>, b: MatRef<'_, f64>) {
    let out = MatMut::from_column_major_slice_mut(out, a.nrows(), b.ncols());
    matmul(out, Accum::Replace, a, b, 1.0, Par::Seq);
}
