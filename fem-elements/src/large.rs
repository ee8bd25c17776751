//! Solids whose functions are polynomials in q, under large deflections.
//!
//! At an in-plane point the displacement gradient H is a polynomial in q, so is every function's. What is integrated through
//! the plies are 9 stresses and, for the tangent, 45 moduli A = ∂P/∂H, each times powers of q; the functions come in once per
//! in-plane point, however many plies there are:
//!
//! f(n) = Σ over in-plane points of w |J| G p(n), p(n)\[(d,k)\] = ∫ P\[n\]\[d\] qᵏ dq, P = (I + H) S,
//! K(n,n′) = Σ of w |J| G A(n,n′) Gᵀ, A(n,n′)\[(d,k),(d′,k′)\] = ∫ ∂P\[n\]\[d\]/∂H\[n′\]\[d′\] qᵏ⁺ᵏ′ dq.
//!
//! Where transverse stresses are smooth ([`fem_core::transverse`]), S and W are those of ε̄ for E less the free strains, whose
//! amplitudes tie the plies of a cell at an in-plane point together: nine squares of ∫ rows ∂E/∂H qᵏ dq come to A.

use crate::prism::{BLOCKS, STRAIN_ROW, matrix, multiply};
use crate::transverse::TransverseStresses;
use fem_core::element::{Cell, ElementError, ElementInfo, Part, PlaneMap, Point, Scratch, Slice, positive};
use fem_core::large::green_lagrange;
use fem_core::quadrature::gauss_legendre;
use fem_core::tensor::{Matrix6, apply};
use fem_core::transverse::{AMPLITUDES, Amplitudes, Coupling, SmoothTransverse};
use pulp::{Arch, Simd, WithSimd};

/// Gradients [∂x, ∂y, ∂z] of `F` functions at an in-plane point, polynomials of `K` coefficients in q.
pub(crate) type Gradients<const F: usize, const K: usize> = [[[f64; K]; 3]; F];

/// Displacement gradient at an in-plane point, polynomials in q.
pub(crate) type Polynomial<const K: usize> = [[[f64; K]; 3]; 3];

/// Displacements of a cell at its in-plane points, for elements that sum their functions faster than one by one.
pub(crate) trait Displacements<const K: usize> {
    /// H at an in-plane point, the plane's map there.
    fn gradient(&self, point: usize, plane: &PlaneMap) -> Polynomial<K>;

    /// Adds the forces that do the work of `stresses` on H there.
    fn add(&mut self, point: usize, plane: &PlaneMap, stresses: &Polynomial<K>);
}

/// Strain energy of a cell, J; adds the forces to `displacements`.
pub(crate) fn energy<const K: usize>(
    info: &ElementInfo,
    stresses: TransverseStresses,
    cell: &Cell<'_>,
    displacements: &mut impl Displacements<K>,
) -> Result<f64, ElementError> {
    let layer = Layer::new(info, cell, stresses);
    let mut energy = 0.0;
    for (point, (r, s, w)) in info.plane_points().enumerate() {
        let plane = cell.plane(r, s);
        let dv = positive(plane.det * cell.half_height())? * w;
        let Through { energy: one, mut stresses } = layer.through(&displacements.gradient(point, &plane), None);
        energy += dv * one;
        stresses.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|p| *p *= dv);
        displacements.add(point, &plane, &stresses);
    }
    Ok(energy)
}

/// A solid with the same `F` scalar functions for each displacement component, polynomials of `K` ≤ 4 coefficients in q.
pub(crate) struct Solid<'a, const F: usize, const K: usize> {
    pub(crate) info: &'a ElementInfo,
    /// Fills in the gradients at an in-plane point of the map.
    pub(crate) gradients: &'a dyn Fn(f64, f64, &PlaneMap, &mut Gradients<F, K>),
    /// Unknown of the cell that multiplies a function in a component; none in one that stays zero.
    pub(crate) unknown: fn(usize, usize) -> Option<usize>,
    pub(crate) stresses: TransverseStresses,
}

/// Powers of q that a product of two polynomials has: 2 K − 1 for K = 4.
const POWERS: usize = 7;

/// Pairs of components of H, each once.
const PAIRS: usize = 45;

/// What the tangent is made of at an in-plane point.
struct Moduli<const K: usize> {
    /// ∫ A qᵏ dq, pairs of components of H by columns of the upper triangle.
    powers: [[f64; PAIRS]; POWERS],
    /// ∫ rows ∂E/∂H qᵏ dq for each of nine amplitudes, where transverse stresses are smooth.
    rows: Option<Box<[[[f64; K]; 9]; AMPLITUDES]>>,
}

impl<const F: usize, const K: usize> Solid<'_, F, K> {
    /// [`fem_core::large::LargeDeflection::internal`]
    pub(crate) fn internal(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, ElementError> {
        let terms = 3 * K;
        let points = self.info.plane_points().count();
        let wanted = tangent.is_some();
        let [g, p, hankel, block] = scratch.arrays(if wanted {
            [F * terms * points, BLOCKS.len() * F * terms * points, BLOCKS.len() * terms * terms, F * F]
        } else {
            [0; 4]
        });
        let mut functions: Gradients<F, K> = [[[0.0; K]; 3]; F];
        let layer = Layer::new(self.info, cell, self.stresses);
        let unknowns = self.unknowns();
        let mut energy = 0.0;
        force.fill(0.0);
        for (point, (r, s, w)) in self.info.plane_points().enumerate() {
            let dv = self.at(cell, r, s, &mut functions)? * w;
            let mut moduli = wanted.then(|| layer.moduli());
            let through = layer.through(&gradient(&functions, &unknowns, u), moduli.as_mut());
            energy += dv * through.energy;
            for (f, gradient) in functions.iter().enumerate() {
                for (n, stresses) in through.stresses.iter().enumerate() {
                    let Some(unknown) = (self.unknown)(n, f) else { continue };
                    let work = gradient.as_flattened().iter().zip(stresses.as_flattened());
                    force[unknown] += dv * work.map(|(g, p)| g * p).sum::<f64>();
                }
            }
            if let Some(moduli) = &moduli {
                let part = &mut g[F * terms * point..F * terms * (point + 1)];
                for (f, gradient) in functions.iter().enumerate() {
                    for (i, value) in gradient.as_flattened().iter().enumerate() {
                        part[F * i + f] = *value;
                    }
                }
                fill_hankel(moduli, dv, hankel);
                for (b, hankel) in hankel.chunks_exact(terms * terms).enumerate() {
                    let at = F * terms * (points * b + point);
                    multiply(&mut p[at..at + F * terms], matrix(part, F), matrix(hankel, terms));
                }
            }
        }
        if let Some(tangent) = tangent {
            self.gather(g, p, block, tangent);
        }
        Ok(energy)
    }

    /// [`fem_core::large::LargeDeflection::geometric_stiffness`]
    pub(crate) fn geometric_stiffness(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        kg: &mut [f64],
    ) -> Result<(), ElementError> {
        let (terms, ndof) = (3 * K, self.info.ndof());
        let [g, p, hankel, one, block] = scratch.arrays([F * terms, F * terms, terms * terms, F * F, F * F]);
        let mut functions: Gradients<F, K> = [[[0.0; K]; 3]; F];
        let layer = Layer::new(self.info, cell, self.stresses);
        let unknowns = self.unknowns();
        for (r, s, w) in self.info.plane_points() {
            let dv = self.at(cell, r, s, &mut functions)? * w;
            let stresses = layer.small_stresses(&gradient(&functions, &unknowns, u));
            for (f, gradient) in functions.iter().enumerate() {
                for (i, value) in gradient.as_flattened().iter().enumerate() {
                    g[F * i + f] = *value;
                }
            }
            for (j, column) in hankel.chunks_exact_mut(terms).enumerate() {
                for (i, value) in column.iter_mut().enumerate() {
                    *value = dv * stresses[i % K + j % K][STRAIN_ROW[i / K][j / K]];
                }
            }
            multiply(p, matrix(g, F), matrix(hankel, terms));
            multiply(one, matrix(p, F), matrix(g, F).transpose());
            block.iter_mut().zip(one.iter()).for_each(|(sum, one)| *sum += one);
        }
        kg.fill(0.0);
        for n in 0..3 {
            for f2 in 0..F {
                for f in 0..F {
                    let (Some(i), Some(j)) = ((self.unknown)(n, f), (self.unknown)(n, f2)) else { continue };
                    // The mean of both triangles: symmetric to the last bit.
                    kg[i + ndof * j] = 0.5 * (block[f + F * f2] + block[f2 + F * f]);
                }
            }
        }
        Ok(())
    }

    /// K = Σ over points of P Gᵀ, block by block.
    fn gather(&self, g: &[f64], p: &[f64], block: &mut [f64], tangent: &mut [f64]) {
        let (g, ndof) = (matrix(g, F), self.info.ndof());
        for ((n, n2), p) in BLOCKS.iter().zip(p.chunks_exact(F * g.ncols())) {
            multiply(block, matrix(p, F), g.transpose());
            for (f2, column) in block.chunks_exact(F).enumerate() {
                for (f, value) in column.iter().enumerate() {
                    let (Some(i), Some(j)) = ((self.unknown)(*n, f), (self.unknown)(*n2, f2)) else { continue };
                    tangent[i + ndof * j] = *value;
                    tangent[j + ndof * i] = *value;
                }
            }
        }
    }

    /// [`fem_core::large::LargeDeflection::large_strain`]
    pub(crate) fn strain(
        &self,
        cell: &Cell<'_>,
        slice: usize,
        [r, s, q]: [f64; 3],
        u: &[f64],
    ) -> Result<[f64; 6], ElementError> {
        let mut functions: Gradients<F, K> = [[[0.0; K]; 3]; F];
        self.at(cell, r, s, &mut functions)?;
        let gradient = gradient(&functions, &self.unknowns(), u);
        let mut strain = green_lagrange(&at(&gradient, q));
        if let Some(transverse) = self.stresses.in_stack(cell.stack) {
            let mut strains = [[0.0; POWERS]; 6];
            add_strains(&gradient, 1.0, &mut strains);
            transverse.assume(slice, [q, q], &transverse.amplitudes(&strains), &mut strain);
        }
        Ok(strain)
    }

    /// [`fem_core::large::LargeDeflection::mean_large_strains`]
    pub(crate) fn mean_strains(
        &self,
        cell: &Cell<'_>,
        (parts, plane): (&[Part], &[Point]),
        u: &[f64],
        strains: &mut [f64],
    ) -> Result<(), ElementError> {
        let mut functions: Gradients<F, K> = [[[0.0; K]; 3]; F];
        let (unknowns, ndof) = (self.unknowns(), self.info.ndof());
        let count = u.len() / ndof;
        let groups: Vec<Vec<[f64; LANES]>> = u.chunks(LANES * ndof).map(|fields| side_by_side(fields, ndof)).collect();
        let mut sums = vec![[[[0.0; LANES]; POWERS]; 6]; groups.len()];
        let mut volume = 0.0;
        for point in plane {
            let dv = self.at(cell, point.at[0], point.at[1], &mut functions)? * point.weight();
            volume += dv;
            for (u, sums) in groups.iter().zip(&mut sums) {
                Arch::new().dispatch(AddStrains { functions: &functions, unknowns: &unknowns, u, dv, sums });
            }
        }
        let of_field =
            |k: usize| sums[k / LANES].map(|powers: [[f64; LANES]; POWERS]| powers.map(|sum| sum[k % LANES] / volume));
        let means: Vec<[[f64; POWERS]; 6]> = (0..count).map(of_field).collect();
        let powers = |Part { q: [low, high], .. }: &Part| -> [f64; POWERS] {
            std::array::from_fn(|k| {
                let p = k as i32 + 1;
                if high > low { (high.powi(p) - low.powi(p)) / (f64::from(p) * (high - low)) } else { low.powi(p - 1) }
            })
        };
        let powers: Vec<[f64; POWERS]> = parts.iter().map(powers).collect();
        for (mean, strains) in means.iter().zip(strains.chunks_exact_mut((6 * parts.len()).max(1))) {
            let transverse =
                self.stresses.in_stack(cell.stack).map(|transverse| (transverse, transverse.amplitudes(mean)));
            for ((Part { slice, q }, powers), strains) in parts.iter().zip(&powers).zip(strains.as_chunks_mut().0) {
                for (strain, mean) in strains.iter_mut().zip(mean) {
                    *strain = mean.iter().zip(powers).map(|(e, q)| e * q).sum::<f64>();
                }
                if let Some((transverse, a)) = &transverse {
                    transverse.assume(*slice, *q, a, strains);
                }
            }
        }
        Ok(())
    }

    /// Gradients of the functions at an in-plane point, and |∂x/∂ξ|.
    fn at(&self, cell: &Cell<'_>, r: f64, s: f64, functions: &mut Gradients<F, K>) -> Result<f64, ElementError> {
        let plane = cell.plane(r, s);
        (self.gradients)(r, s, &plane, functions);
        positive(plane.det * cell.half_height())
    }

    /// Of each function, the unknown that multiplies it in each component.
    fn unknowns(&self) -> Unknowns<F> {
        std::array::from_fn(|f| std::array::from_fn(|n| (self.unknown)(n, f)))
    }
}

/// Unknowns of the cell that multiply each function in each component.
type Unknowns<const F: usize> = [[Option<usize>; 3]; F];

/// Fields that are taken at a time.
const LANES: usize = 4;

/// Unknowns of a cell in fields that stand one after the other, at most [`LANES`]; lanes without a field are zero.
fn side_by_side(fields: &[f64], ndof: usize) -> Vec<[f64; LANES]> {
    let mut out = vec![[0.0; LANES]; ndof];
    for (lane, field) in fields.chunks_exact(ndof).enumerate() {
        out.iter_mut().zip(field).for_each(|(out, u)| out[lane] = *u);
    }
    out
}

/// Adds `dv` E at an in-plane point, as [`add_strains`] does, of several fields `u`.
struct AddStrains<'a, const F: usize, const K: usize> {
    functions: &'a Gradients<F, K>,
    unknowns: &'a Unknowns<F>,
    u: &'a [[f64; LANES]],
    dv: f64,
    sums: &'a mut [[[f64; LANES]; POWERS]; 6],
}

impl<const F: usize, const K: usize> WithSimd for AddStrains<'_, F, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { functions, unknowns, u, dv, sums } = self;
        let mut h = [[[[0.0; LANES]; K]; 3]; 3];
        for (component, h) in h.iter_mut().enumerate() {
            // One component's coefficients stay in registers.
            let mut coefficients = [[[0.0; LANES]; K]; 3];
            for (gradient, unknowns) in functions.iter().zip(unknowns) {
                let Some(unknown) = unknowns[component] else { continue };
                let u = u[unknown];
                for (sum, g) in coefficients.as_flattened_mut().iter_mut().zip(gradient.as_flattened()) {
                    (0..LANES).for_each(|lane| sum[lane] = g.mul_add(u[lane], sum[lane]));
                }
            }
            *h = coefficients;
        }
        for (a, rows) in STRAIN_ROW.iter().enumerate() {
            for (b, row) in rows.iter().enumerate().skip(a) {
                let dv = if a == b { 0.5 * dv } else { dv };
                let mut strain = [[0.0; LANES]; POWERS];
                for (k, strain) in strain.iter_mut().enumerate().take(K) {
                    (0..LANES).for_each(|lane| strain[lane] = h[a][b][k][lane] + h[b][a][k][lane]);
                }
                for component in &h {
                    for (i, x) in component[a].iter().enumerate() {
                        for (j, y) in component[b].iter().enumerate() {
                            let strain = &mut strain[i + j];
                            (0..LANES).for_each(|lane| strain[lane] = x[lane].mul_add(y[lane], strain[lane]));
                        }
                    }
                }
                for (sum, strain) in sums[*row].iter_mut().zip(&strain) {
                    (0..LANES).for_each(|lane| sum[lane] = dv.mul_add(strain[lane], sum[lane]));
                }
            }
        }
    }
}

/// H at an in-plane point.
#[inline(always)]
fn gradient<const F: usize, const K: usize>(
    functions: &Gradients<F, K>,
    unknowns: &Unknowns<F>,
    u: &[f64],
) -> Polynomial<K> {
    let mut h = [[[0.0; K]; 3]; 3];
    for (gradient, unknowns) in functions.iter().zip(unknowns) {
        for (unknown, h) in unknowns.iter().zip(&mut h) {
            let Some(unknown) = unknown else { continue };
            let u = u[*unknown];
            for (h, g) in h.as_flattened_mut().iter_mut().zip(gradient.as_flattened()) {
                *h += u * g;
            }
        }
    }
    h
}

/// The plies of a cell.
struct Layer<'a> {
    info: &'a ElementInfo,
    slices: &'a [Slice],
    /// Smooth transverse stresses, and their amplitudes of the free strains.
    transverse: Option<(&'a SmoothTransverse, Amplitudes)>,
}

impl<'a> Layer<'a> {
    fn new(info: &'a ElementInfo, cell: &Cell<'a>, stresses: TransverseStresses) -> Self {
        let slices = &cell.stack.slices;
        let transverse =
            stresses.in_stack(cell.stack).map(|all| (all, all.amplitudes_of(slices.iter().map(|slice| slice.free))));
        Self { info, slices, transverse }
    }

    /// ∫ σ qᵏ dq of small displacements with this gradient.
    fn small_stresses<const K: usize>(&self, gradient: &Polynomial<K>) -> [[f64; 6]; POWERS] {
        let mut strains = [[0.0; POWERS]; 6];
        for (a, rows) in STRAIN_ROW.iter().enumerate() {
            for (b, row) in rows.iter().enumerate() {
                strains[*row].iter_mut().zip(&gradient[a][b]).for_each(|(strain, h)| *strain += h);
            }
        }
        let smooth = self.transverse.as_ref().map(|(all, free)| (*all, all.amplitudes(&strains) - free));
        let mut sum = [[0.0; 6]; POWERS];
        for (number, slice) in self.slices.iter().enumerate() {
            let (middle, half) = (0.5 * (slice.q[0] + slice.q[1]), 0.5 * (slice.q[1] - slice.q[0]));
            for &(t, wt) in gauss_legendre(self.info.ply_order) {
                let (q, mut w) = (middle + half * t, wt * half);
                let mut strain = strains.map(|p| p.iter().rev().fold(0.0, |sum, c| sum * q + c));
                strain.iter_mut().zip(&slice.free).for_each(|(e, free)| *e -= free);
                let stress = match &smooth {
                    None => product(&slice.c, &strain),
                    Some((all, a)) => {
                        all.assume(number, [q, q], a, &mut strain);
                        all.stress(number, q, a, &strain)
                    }
                };
                for sum in &mut sum {
                    sum.iter_mut().zip(&stress).for_each(|(sum, stress)| *sum += w * stress);
                    w *= q;
                }
            }
        }
        sum
    }

    fn moduli<const K: usize>(&self) -> Moduli<K> {
        let rows = self.transverse.as_ref().map(|_| Box::new([[[0.0; K]; 9]; AMPLITUDES]));
        Moduli { powers: [[0.0; PAIRS]; POWERS], rows }
    }

    /// Integrates through the plies; adds to `moduli` where they are asked for.
    fn through<const K: usize>(&self, gradient: &Polynomial<K>, mut moduli: Option<&mut Moduli<K>>) -> Through<K> {
        let mut sum = Through { energy: 0.0, stresses: [[[0.0; K]; 3]; 3] };
        let smooth = self.transverse.as_ref().map(|(all, free)| {
            let mut strains = [[0.0; POWERS]; 6];
            add_strains(gradient, 1.0, &mut strains);
            (*all, all.amplitudes(&strains) - free)
        });
        // Power by power, the nine components side by side: vector instructions take them together.
        let coefficients: [[[f64; 3]; 3]; K] = std::array::from_fn(|k| gradient.map(|row| row.map(|p| p[k])));
        for (number, slice) in self.slices.iter().enumerate() {
            let (middle, half) = (0.5 * (slice.q[0] + slice.q[1]), 0.5 * (slice.q[1] - slice.q[0]));
            let reduced = smooth.as_ref().map(|(all, _)| all.reduced(number));
            for &(t, wt) in gauss_legendre(self.info.ply_order) {
                let (q, w) = (middle + half * t, wt * half);
                let mut h = [[0.0; 3]; 3];
                for c in coefficients.iter().rev() {
                    for (h, c) in h.as_flattened_mut().iter_mut().zip(c.as_flattened()) {
                        *h = *h * q + c;
                    }
                }
                let mut strain = green_lagrange(&h);
                strain.iter_mut().zip(&slice.free).for_each(|(e, free)| *e -= free);
                let stress = match &smooth {
                    None => product(&slice.c, &strain),
                    Some((all, a)) => {
                        all.assume(number, [q, q], a, &mut strain);
                        all.stress(number, q, a, &strain)
                    }
                };
                sum.add(&h, &strain, &stress, q, w);
                if let Some(moduli) = &mut moduli {
                    let rows = smooth.as_ref().map(|(all, _)| all.rows(number, q));
                    add_moduli(moduli, &h, (reduced.as_ref().unwrap_or(&slice.c), rows), &stress, q, w);
                }
            }
        }
        sum
    }
}

/// C ε. C is symmetric: its rows, which vector instructions take whole, serve as columns.
#[inline]
fn product(c: &Matrix6, strain: &[f64; 6]) -> [f64; 6] {
    let mut stress = [0.0; 6];
    for (e, column) in strain.iter().zip(c) {
        stress.iter_mut().zip(column).for_each(|(s, c)| *s += e * c);
    }
    stress
}

/// Integrals through the plies at an in-plane point.
struct Through<const K: usize> {
    /// ∫ ½ (E − ε₀)ᵀ C (E − ε₀) dq
    energy: f64,
    /// ∫ P qᵏ dq
    stresses: Polynomial<K>,
}

impl<const K: usize> Through<K> {
    /// Adds a point with the strain E − ε₀, or ε̄ in its place, and S.
    #[inline]
    fn add(&mut self, h: &[[f64; 3]; 3], strain: &[f64; 6], stress: &[f64; 6], q: f64, w: f64) {
        self.energy += 0.5 * w * strain.iter().zip(stress).map(|(e, s)| e * s).sum::<f64>();
        let mut powers = [w; K];
        for k in 1..K {
            powers[k] = powers[k - 1] * q;
        }
        let f = deformation(h);
        for (row, stresses) in f.iter().zip(&mut self.stresses) {
            for (rows, sum) in STRAIN_ROW.iter().zip(stresses) {
                let p = row[0] * stress[rows[0]] + row[1] * stress[rows[1]] + row[2] * stress[rows[2]];
                for (sum, power) in sum.iter_mut().zip(&powers) {
                    *sum += p * power;
                }
            }
        }
    }
}

/// I + H
fn deformation(h: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut f = *h;
    (0..3).for_each(|i| f[i][i] += 1.0);
    f
}

/// Adds w qᵏ ∂P/∂H of a ply with the stiffness `c` and, where there are some, the rows of its transverse stresses.
fn add_moduli<const K: usize>(
    moduli: &mut Moduli<K>,
    h: &[[f64; 3]; 3],
    (c, rows): (&Matrix6, Option<Coupling>),
    stress: &[f64; 6],
    q: f64,
    w: f64,
) {
    let f = deformation(h);
    // ∂E/∂H: column 3 n + d has F[n][e] in the row of (d, e), once for normal strains as for engineering shears.
    let mut by = [[0.0; 6]; 9];
    for (at, column) in by.iter_mut().enumerate() {
        for e in 0..3 {
            column[STRAIN_ROW[at % 3][e]] += f[at / 3][e];
        }
    }
    let cby = by.map(|column| apply(c, &column));
    let mut pairs = [0.0; PAIRS];
    let mut at = 0;
    for (j, cb) in cby.iter().enumerate() {
        for (i, b) in by[..=j].iter().enumerate() {
            let geometric = if i / 3 == j / 3 { stress[STRAIN_ROW[i % 3][j % 3]] } else { 0.0 };
            pairs[at] = w * (b.iter().zip(cb).map(|(b, c)| b * c).sum::<f64>() + geometric);
            at += 1;
        }
    }
    if let (Some(sums), Some(rows)) = (&mut moduli.rows, rows) {
        for (sums, row) in sums.iter_mut().zip(rows.row_iter()) {
            for (sums, column) in sums.iter_mut().zip(&by) {
                let mut value = w * row.iter().zip(column).map(|(a, b)| a * b).sum::<f64>();
                for sum in sums {
                    *sum += value;
                    value *= q;
                }
            }
        }
    }
    let mut power = 1.0;
    for moduli in &mut moduli.powers[..2 * K - 1] {
        for (sum, pair) in moduli.iter_mut().zip(&pairs) {
            *sum += power * pair;
        }
        power *= q;
    }
}

/// dv A(n,n′) of the blocks, each 3 K × 3 K.
fn fill_hankel<const K: usize>(moduli: &Moduli<K>, dv: f64, out: &mut [f64]) {
    let terms = 3 * K;
    for ((n, n2), block) in BLOCKS.iter().zip(out.chunks_exact_mut(terms * terms)) {
        for (j, column) in block.chunks_exact_mut(terms).enumerate() {
            for (i, value) in column.iter_mut().enumerate() {
                let (a, b) = (3 * n + i / K, 3 * n2 + j / K);
                let (low, high) = (a.min(b), a.max(b));
                let squares = moduli.rows.iter().flat_map(|rows| rows.iter()).map(|row| row[a][i % K] * row[b][j % K]);
                *value = dv * (moduli.powers[i % K + j % K][high * (high + 1) / 2 + low] + squares.sum::<f64>());
            }
        }
    }
}

/// Adds `dv` E of a displacement gradient, polynomials in q of twice the degree.
#[inline(always)]
fn add_strains<const K: usize>(h: &Polynomial<K>, dv: f64, strains: &mut [[f64; POWERS]; 6]) {
    for (a, rows) in STRAIN_ROW.iter().enumerate() {
        for (b, row) in rows.iter().enumerate().skip(a) {
            // Normal strains have half of the sum, engineering shears all of it.
            let dv = if a == b { 0.5 * dv } else { dv };
            let strain = &mut strains[*row];
            for (k, (x, y)) in h[a][b].iter().zip(&h[b][a]).enumerate() {
                strain[k] += dv * (x + y);
            }
            for component in h {
                for (i, x) in component[a].iter().enumerate() {
                    for (j, y) in component[b].iter().enumerate() {
                        strain[i + j] += dv * x * y;
                    }
                }
            }
        }
    }
}

/// A displacement gradient at q.
fn at<const K: usize>(gradient: &Polynomial<K>, q: f64) -> [[f64; 3]; 3] {
    gradient.map(|row| row.map(|p| p.iter().rev().fold(0.0, |sum, c| sum * q + c)))
}
