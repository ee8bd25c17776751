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

mod layer;

use crate::prism::{BLOCKS, STRAIN_ROW, matrix, multiply};
use crate::transverse::TransverseStresses;
use fem_core::element::{Cell, ElementError, ElementInfo, Part, PlaneMap, Point, Scratch, positive};
use fem_core::transverse::SmoothTransverse;
use layer::{Layer, Moduli, POWERS};
pub(crate) use layer::{Polynomials, Strains, add_strains};
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

/// Displacements of a cell in several fields, [`LANES`] of which are taken at a time.
pub(crate) trait Fields {
    /// How often [`LANES`] fields are taken.
    fn groups(&self) -> usize;

    /// Moves to the in-plane point `number`.
    fn go_to(&mut self, number: usize, point: &Point, plane: &PlaneMap);

    /// Adds `dv` E there of a group.
    fn add_strains(&self, group: usize, dv: f64, sums: &mut Strains<LANES>);
}

/// [`fem_core::large::LargeDeflection::mean_large_strains`]
pub(crate) fn mean_strains(
    cell: &Cell<'_>,
    (parts, plane): (&[Part], &[Point]),
    stresses: TransverseStresses,
    fields: &mut impl Fields,
    strains: &mut [f64],
) -> Result<(), ElementError> {
    let mut sums: Vec<Strains<LANES>> = vec![[[[0.0; LANES]; POWERS]; 6]; fields.groups()];
    let mut volume = 0.0;
    for (number, point) in plane.iter().enumerate() {
        let map = cell.plane(point.at[0], point.at[1]);
        let dv = positive(map.det * cell.half_height())? * point.weight();
        volume += dv;
        fields.go_to(number, point, &map);
        sums.iter_mut().enumerate().for_each(|(group, sums)| fields.add_strains(group, dv, sums));
    }
    let powers = |Part { q: [low, high], .. }: &Part| -> [f64; POWERS] {
        std::array::from_fn(|k| {
            let p = k as i32 + 1;
            if high > low { (high.powi(p) - low.powi(p)) / (f64::from(p) * (high - low)) } else { low.powi(p - 1) }
        })
    };
    let powers: Vec<[f64; POWERS]> = parts.iter().map(powers).collect();
    let transverse = stresses.in_stack(cell.stack);
    let size = 6 * parts.len();
    for (mut means, strains) in sums.into_iter().zip(strains.chunks_mut((LANES * size).max(1))) {
        means.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|mean| *mean /= volume);
        Arch::new().dispatch(MeansOfParts { parts, powers: &powers, transverse, means: &means, strains });
    }
    Ok(())
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
    let mut points = info.plane_points().enumerate();
    loop {
        let mut taken = [const { None }; LANES];
        let mut gradients: Polynomials<K, LANES> = [[[[0.0; LANES]; K]; 3]; 3];
        for (lane, taken) in taken.iter_mut().enumerate() {
            let Some((point, (r, s, w))) = points.next() else { break };
            let plane = cell.plane(r, s);
            let dv = positive(plane.det * cell.half_height())? * w;
            let gradient = displacements.gradient(point, &plane);
            let lanes = gradients.as_flattened_mut().as_flattened_mut();
            lanes.iter_mut().zip(gradient.as_flattened().as_flattened()).for_each(|(lanes, h)| lanes[lane] = *h);
            *taken = Some((point, plane, dv));
        }
        if taken[0].is_none() {
            return Ok(energy);
        }
        let through = layer.through(&gradients, None);
        for (lane, (point, plane, dv)) in taken.into_iter().flatten().enumerate() {
            energy += dv * through.energy[lane];
            let stresses = through.stresses.map(|row| row.map(|p| p.map(|p| dv * p[lane])));
            displacements.add(point, &plane, &stresses);
        }
    }
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
            let through = layer.through(&alone(&gradient(&functions, &unknowns, u)), moduli.as_mut());
            energy += dv * through.energy[0];
            for (f, gradient) in functions.iter().enumerate() {
                for (n, stresses) in through.stresses.iter().enumerate() {
                    let Some(unknown) = (self.unknown)(n, f) else { continue };
                    let work = gradient.as_flattened().iter().zip(stresses.as_flattened());
                    force[unknown] += dv * work.map(|(g, [p])| g * p).sum::<f64>();
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
        let mut strains = [[[0.0]; POWERS]; 6];
        add_strains(&alone(&gradient(&functions, &self.unknowns(), u)), 1.0, &mut strains);
        let mut strain = strains.map(|p| [p.iter().rev().fold(0.0, |sum, [c]| sum * q + c)]);
        if let Some(transverse) = self.stresses.in_stack(cell.stack) {
            transverse.assume(slice, [q, q], &transverse.amplitudes(&strains), &mut strain);
        }
        Ok(strain.map(|[e]| e))
    }

    /// [`fem_core::large::LargeDeflection::mean_large_strains`]
    pub(crate) fn mean_strains(
        &self,
        cell: &Cell<'_>,
        over: (&[Part], &[Point]),
        u: &[f64],
        strains: &mut [f64],
    ) -> Result<(), ElementError> {
        let ndof = self.info.ndof();
        let mut fields = FieldsOfSolid {
            gradients: self.gradients,
            functions: [[[0.0; K]; 3]; F],
            unknowns: self.unknowns(),
            groups: u.chunks(LANES * ndof).map(|fields| side_by_side(fields, ndof)).collect(),
        };
        mean_strains(cell, over, self.stresses, &mut fields, strains)
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

/// Fields, or in-plane points, that are taken at a time.
pub(crate) const LANES: usize = 4;

/// Unknowns of a cell in fields that stand one after the other, at most [`LANES`]; lanes without a field are zero.
fn side_by_side(fields: &[f64], ndof: usize) -> Vec<[f64; LANES]> {
    let mut out = vec![[0.0; LANES]; ndof];
    for (lane, field) in fields.chunks_exact(ndof).enumerate() {
        out.iter_mut().zip(field).for_each(|(out, u)| out[lane] = *u);
    }
    out
}

/// [`Solid::mean_strains`]
struct FieldsOfSolid<'a, const F: usize, const K: usize> {
    gradients: &'a dyn Fn(f64, f64, &PlaneMap, &mut Gradients<F, K>),
    functions: Gradients<F, K>,
    unknowns: Unknowns<F>,
    groups: Vec<Vec<[f64; LANES]>>,
}

impl<const F: usize, const K: usize> Fields for FieldsOfSolid<'_, F, K> {
    fn groups(&self) -> usize {
        self.groups.len()
    }

    fn go_to(&mut self, _number: usize, point: &Point, plane: &PlaneMap) {
        (self.gradients)(point.at[0], point.at[1], plane, &mut self.functions);
    }

    fn add_strains(&self, group: usize, dv: f64, sums: &mut Strains<LANES>) {
        let Self { functions, unknowns, groups, .. } = self;
        Arch::new().dispatch(AddStrains { functions, unknowns, u: &groups[group], dv, sums });
    }
}

/// Adds `dv` E at an in-plane point, as [`add_strains`] does, of several fields `u`.
struct AddStrains<'a, const F: usize, const K: usize> {
    functions: &'a Gradients<F, K>,
    unknowns: &'a Unknowns<F>,
    u: &'a [[f64; LANES]],
    dv: f64,
    sums: &'a mut Strains<LANES>,
}

impl<const F: usize, const K: usize> WithSimd for AddStrains<'_, F, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { functions, unknowns, u, dv, sums } = self;
        let mut h: Polynomials<K, LANES> = [[[[0.0; LANES]; K]; 3]; 3];
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
        add_strains(&h, dv, sums);
    }
}

/// Means of strains over parts of plies, of several fields.
struct MeansOfParts<'a> {
    parts: &'a [Part],
    /// Means of qᵏ over each part.
    powers: &'a [[f64; POWERS]],
    transverse: Option<&'a SmoothTransverse>,
    means: &'a Strains<LANES>,
    /// Six for each part of each field, one field after the other; there may be fewer than lanes.
    strains: &'a mut [f64],
}

impl WithSimd for MeansOfParts<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { parts, powers, transverse, means, strains } = self;
        let amplitudes = transverse.map(|transverse| transverse.amplitudes(means));
        for (number, (Part { slice, q }, powers)) in parts.iter().zip(powers).enumerate() {
            let mut strain = [[0.0; LANES]; 6];
            for (strain, means) in strain.iter_mut().zip(means) {
                for (mean, q) in means.iter().zip(powers) {
                    (0..LANES).for_each(|lane| strain[lane] += q * mean[lane]);
                }
            }
            if let (Some(transverse), Some(a)) = (transverse, &amplitudes) {
                transverse.assume(*slice, *q, a, &mut strain);
            }
            for (lane, strains) in strains.chunks_exact_mut(6 * parts.len()).enumerate() {
                strains[6 * number..6 * number + 6].iter_mut().zip(&strain).for_each(|(to, from)| *to = from[lane]);
            }
        }
    }
}

/// One polynomial as several.
fn alone<const K: usize>(h: &Polynomial<K>) -> Polynomials<K, 1> {
    h.map(|row| row.map(|p| p.map(|c| [c])))
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

/// dv A(n,n′) of the blocks, each 3 K × 3 K.
fn fill_hankel<const K: usize>(moduli: &Moduli<K>, dv: f64, out: &mut [f64]) {
    let terms = 3 * K;
    for ((n, n2), block) in BLOCKS.iter().zip(out.chunks_exact_mut(terms * terms)) {
        for (j, column) in block.chunks_exact_mut(terms).enumerate() {
            for (i, value) in column.iter_mut().enumerate() {
                *value = dv * moduli.at((3 * n + i / K, i % K), (3 * n2 + j / K, j % K));
            }
        }
    }
}
