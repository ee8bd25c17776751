//! Displacements of a cell by natural coordinates, where all cells have the same functions.
//!
//! Once the derivatives at the nodes are natural ones, the functions' gradients are a table of the element; the shape of the
//! cell enters in a 2 × 2 matrix per node and per in-plane point. As in the stiffness, the sums run over the even and the odd
//! parts in q of the functions of the upper face.

use super::{BELOW, Functions, HALVES, HermiteSolid, Jacobians, TERMS, column};
use crate::hermite;
use crate::large::{Displacements, Fields, LANES, Polynomial, Polynomials, Strains, add_strains};
use fem_core::element::{PlaneMap, Point};
use pulp::{Arch, Simd, WithSimd};
use std::fmt;

/// Terms of a half; the even one leaves the last zero.
const WIDTH: usize = 6;

/// A number per displacement component; the fourth stays zero, for vector registers hold 2 or 4.
type Components = [f64; 4];

/// A number per component of the even and the odd parts of the functions.
type Parts<const H: usize> = [[Components; H]; 2];

/// Natural gradients of the even and the odd parts at each in-plane point.
#[derive(Clone)]
pub(super) struct Table<const H: usize>(Vec<[[[f64; WIDTH]; H]; 2]>);

/// Thousands of numbers would hide what an element's message is about.
impl<const H: usize> fmt::Debug for Table<H> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Table of {} points", self.0.len())
    }
}

impl<const H: usize> Table<H> {
    pub(super) fn new<const F: usize>(points: &[Point]) -> Self
    where
        HermiteSolid<F, H>: Functions,
    {
        let at = |point: &Point| {
            let [r, s] = point.at;
            let mut parts = [[[0.0; WIDTH]; H]; 2];
            for f in 0..H {
                let (functions, m) = (HermiteSolid::<F, H>::node_functions((H + f) / 4, r, s), f % 4);
                let gradient = [functions.n_r[m], functions.n_s[m], hermite::derivative(&functions.n[m])];
                for (half, part) in HALVES.into_iter().zip(&mut parts) {
                    for ((d, k), value) in TERMS[half].iter().zip(&mut part[f]) {
                        *value = gradient[*d][*k];
                    }
                }
            }
            parts
        };
        Self(points.iter().map(at).collect())
    }
}

/// Displacements of a cell, and the forces conjugate to them.
pub(super) struct Natural<'a, const H: usize> {
    table: &'a Table<H>,
    half_height: f64,
    u: Parts<H>,
    force: Parts<H>,
}

/// The even and the odd parts of displacements.
fn parts<const H: usize>(jacobians: &Jacobians, half_height: f64, u: &[f64]) -> Parts<H> {
    let mut parts = [[Components::default(); H]; 2];
    for (below, jacobian) in jacobians[..H / 4].iter().enumerate() {
        for n in 0..3 {
            // A node stands upright above the one below it: both have the same Jacobian.
            let [low, high] = [4 * below, H + 4 * below].map(|f| {
                let [v, x, y, z] = std::array::from_fn(|m| u[column(n, f + m)]);
                let [[x_r, y_r], [x_s, y_s]] = jacobian;
                [v, x_r * x + y_r * y, x_s * x + y_s * y, half_height * z]
            });
            for m in 0..4 {
                parts[0][4 * below + m][n] = high[m] + BELOW[m] * low[m];
                parts[1][4 * below + m][n] = high[m] - BELOW[m] * low[m];
            }
        }
    }
    parts
}

impl<'a, const H: usize> Natural<'a, H> {
    pub(super) fn new(table: &'a Table<H>, jacobians: &Jacobians, half_height: f64, u: &[f64]) -> Self {
        let u = parts(jacobians, half_height, u);
        Self { table, half_height, u, force: [[Components::default(); H]; 2] }
    }

    /// The transpose of what [`parts`] does to the displacements.
    pub(super) fn force(&self, jacobians: &Jacobians, force: &mut [f64]) {
        for (below, jacobian) in jacobians[..H / 4].iter().enumerate() {
            for n in 0..3 {
                let [even, odd] =
                    [0, 1].map(|half| -> [f64; 4] { std::array::from_fn(|m| self.force[half][4 * below + m][n]) });
                let low = std::array::from_fn(|m| BELOW[m] * (even[m] - odd[m]));
                let high = std::array::from_fn(|m| even[m] + odd[m]);
                for (f, [v, r, s, q]) in [(4 * below, low), (H + 4 * below, high)] {
                    let [[x_r, y_r], [x_s, y_s]] = jacobian;
                    let global = [v, x_r * r + x_s * s, y_r * r + y_s * s, self.half_height * q];
                    for (m, value) in global.into_iter().enumerate() {
                        force[column(n, f + m)] = value;
                    }
                }
            }
        }
    }
}

impl<const H: usize> Displacements<4> for Natural<'_, H> {
    fn gradient(&self, point: usize, plane: &PlaneMap) -> Polynomial<4> {
        Arch::new().dispatch(Gradient { of: self, point, plane })
    }

    fn add(&mut self, point: usize, plane: &PlaneMap, stresses: &Polynomial<4>) {
        Arch::new().dispatch(Add { to: self, point, plane, stresses });
    }
}

/// [`Displacements::gradient`]
struct Gradient<'a, const H: usize> {
    of: &'a Natural<'a, H>,
    point: usize,
    plane: &'a PlaneMap,
}

impl<const H: usize> WithSimd for Gradient<'_, H> {
    type Output = Polynomial<4>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Polynomial<4> {
        let Self { of, point, plane } = self;
        let mut natural = [[[0.0; 4]; 3]; 3];
        for ((half, table), u) in HALVES.into_iter().zip(&of.table.0[point]).zip(&of.u) {
            let mut sums = [Components::default(); WIDTH];
            for (gradient, u) in table.iter().zip(u) {
                for (sum, g) in sums.iter_mut().zip(gradient) {
                    (0..4).for_each(|n| sum[n] = g.mul_add(u[n], sum[n]));
                }
            }
            for ((d, k), sum) in TERMS[half].iter().zip(&sums) {
                for (natural, sum) in natural.iter_mut().zip(sum) {
                    natural[*d][*k] = *sum;
                }
            }
        }
        let inverse = &plane.inverse;
        natural.map(|[r, s, q]| {
            let by = |d: usize| std::array::from_fn(|k| inverse[0][d] * r[k] + inverse[1][d] * s[k]);
            [by(0), by(1), q.map(|c| c / of.half_height)]
        })
    }
}

/// [`Displacements::add`]
struct Add<'a, 'b, const H: usize> {
    to: &'a mut Natural<'b, H>,
    point: usize,
    plane: &'a PlaneMap,
    stresses: &'a Polynomial<4>,
}

impl<const H: usize> WithSimd for Add<'_, '_, H> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { to, point, plane, stresses } = self;
        let inverse = &plane.inverse;
        let natural: Polynomial<4> = stresses.map(|[x, y, z]| {
            let along = |d: usize| std::array::from_fn(|k| inverse[d][0] * x[k] + inverse[d][1] * y[k]);
            [along(0), along(1), z.map(|p| p / to.half_height)]
        });
        for ((half, table), force) in HALVES.into_iter().zip(&to.table.0[point]).zip(&mut to.force) {
            let mut terms = [Components::default(); WIDTH];
            for ((d, k), term) in TERMS[half].iter().zip(&mut terms) {
                for (term, natural) in term.iter_mut().zip(&natural) {
                    *term = natural[*d][*k];
                }
            }
            for (gradient, force) in table.iter().zip(force) {
                for (term, g) in terms.iter().zip(gradient) {
                    (0..4).for_each(|n| force[n] = g.mul_add(term[n], force[n]));
                }
            }
        }
    }
}

/// Displacements of a cell in several fields, side by side.
pub(super) struct NaturalFields<'a, const H: usize> {
    table: &'a Table<H>,
    half_height: f64,
    groups: Vec<[[[[f64; LANES]; 3]; H]; 2]>,
    at: usize,
    inverse: [[f64; 2]; 2],
}

impl<'a, const H: usize> NaturalFields<'a, H> {
    /// Of the displacements `u`, field by field, at the points of `table`.
    pub(super) fn new(table: &'a Table<H>, jacobians: &Jacobians, half_height: f64, u: &[f64]) -> Self {
        let ndof = 6 * H;
        let group = |fields: &[f64]| {
            let mut group = [[[[0.0; LANES]; 3]; H]; 2];
            for (lane, u) in fields.chunks_exact(ndof).enumerate() {
                let parts: Parts<H> = parts(jacobians, half_height, u);
                for (group, u) in group.as_flattened_mut().iter_mut().zip(parts.as_flattened()) {
                    group.iter_mut().zip(u).for_each(|(lanes, u)| lanes[lane] = *u);
                }
            }
            group
        };
        Self { table, half_height, groups: u.chunks(LANES * ndof).map(group).collect(), at: 0, inverse: [[0.0; 2]; 2] }
    }
}

impl<const H: usize> Fields for NaturalFields<'_, H> {
    fn groups(&self) -> usize {
        self.groups.len()
    }

    fn go_to(&mut self, number: usize, _point: &Point, plane: &PlaneMap) {
        self.at = number;
        self.inverse = plane.inverse;
    }

    fn add_strains(&self, group: usize, dv: f64, sums: &mut Strains<LANES>) {
        let Self { table, half_height, groups, at, inverse } = self;
        let (table, u) = (&table.0[*at], &groups[group]);
        Arch::new().dispatch(AddStrains { table, u, half_height: *half_height, inverse, dv, sums });
    }
}

/// [`Fields::add_strains`]
struct AddStrains<'a, const H: usize> {
    table: &'a [[[f64; WIDTH]; H]; 2],
    u: &'a [[[[f64; LANES]; 3]; H]; 2],
    half_height: f64,
    inverse: &'a [[f64; 2]; 2],
    dv: f64,
    sums: &'a mut Strains<LANES>,
}

impl<const H: usize> WithSimd for AddStrains<'_, H> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { table, u, half_height, inverse, dv, sums } = self;
        let mut h: Polynomials<4, LANES> = [[[[0.0; LANES]; 4]; 3]; 3];
        for (n, h) in h.iter_mut().enumerate() {
            let mut natural = [[[0.0; LANES]; 4]; 3];
            for ((half, table), u) in HALVES.into_iter().zip(table).zip(u) {
                // One component's terms of a half stay in registers.
                let mut terms = [[0.0; LANES]; WIDTH];
                for (gradient, u) in table.iter().zip(u) {
                    for (term, g) in terms.iter_mut().zip(gradient) {
                        (0..LANES).for_each(|lane| term[lane] = g.mul_add(u[n][lane], term[lane]));
                    }
                }
                TERMS[half].iter().zip(&terms).for_each(|((d, k), term)| natural[*d][*k] = *term);
            }
            let [r, s, q] = natural;
            for k in 0..4 {
                for lane in 0..LANES {
                    for d in 0..2 {
                        h[d][k][lane] = inverse[0][d] * r[k][lane] + inverse[1][d] * s[k][lane];
                    }
                    h[2][k][lane] = q[k][lane] / half_height;
                }
            }
        }
        add_strains(&h, dv, sums);
    }
}
