//! Solids with twelve unknowns a node: what the report's quadrilateral prism (eqs 16-23) and the wedge have in common.

mod natural;

use crate::hermite::{self, NodeFunctions, Quartet};
use crate::large::{self, Gradients, Solid};
use crate::prism::{BLOCKS, STRAIN_ROW, matrix, mean_powers, multiply};
use crate::transverse::{Across, TransverseStresses};
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use fem_core::cubic_strains::{COEFFICIENTS, CubicStrains};
use fem_core::element::{
    Cell, Element, ElementError, ElementInfo, Part, PlaneMap, Point, Scratch, Slice, Stack, positive,
};
use fem_core::large::LargeDeflection;
use fem_core::plugin::{ParamError, ParamInfo, Params, Role};
use fem_core::tensor::apply;
use fem_core::transverse::ACROSS;
use natural::{Natural, NaturalFields, Table};
use std::fmt::Debug;
use std::ops::Range;

/// (direction d, power k of q) of the terms in the gradient of a function: those of its part even in q, then of its odd
/// part.
const TERMS: [(usize, usize); 11] =
    [(0, 0), (0, 2), (1, 0), (1, 2), (2, 1), (0, 1), (0, 3), (1, 1), (1, 3), (2, 0), (2, 2)];
const HALVES: [Range<usize>; 2] = [0..5, 5..11];

/// With the function of a top node e + o, even plus odd in q, that of the node below is e − o times this: for value, ∂x,
/// ∂y, ∂z.
const BELOW: [f64; 4] = [1.0, 1.0, 1.0, -1.0];

/// The columns of both halves of a matrix with `rows` rows and a column per term.
fn halves(a: &[f64], rows: usize) -> [&[f64]; 2] {
    HALVES.map(|half| &a[half.start * rows..half.end * rows])
}

/// Which shape functions carry the inertia.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mass {
    /// The element's own functions: frequencies converge as fast as deflections.
    Cubic,
    /// Trilinear functions of the translations (the report): derivative unknowns have no inertia, M is singular.
    Linear,
}

impl Mass {
    pub(crate) const PARAM: ParamInfo = ParamInfo::word(
        "mass",
        "functions that carry the inertia",
        &[("cubic", "consistent"), ("linear", "the report's, translations only")],
    )
    .role(Role::Inertia);

    /// The choice in a scene.
    pub(crate) fn of(params: &Params) -> Result<Self, ParamError> {
        Ok(match params.word(&Self::PARAM)? {
            "linear" => Self::Linear,
            _ => Self::Cubic,
        })
    }
}

/// Natural functions of the nodes: what tells one solid of the family from another.
pub(crate) trait Functions: Debug + Clone + Send + Sync + 'static {
    /// The functions of node `i` (value, ∂r, ∂s, ∂q) at an in-plane point.
    fn node_functions(i: usize, r: f64, s: f64) -> NodeFunctions;

    /// The function of node `i` that is 1 there and linear along all edges.
    fn linear(i: usize, r: f64, s: f64) -> Quartet;
}

/// Upright prism with plane, parallel faces, twelve unknowns a node; `F` functions per displacement component, `H` of them of the
/// nodes of one face.
///
/// Unknowns count `12·node + 4·component + m` with m = 0 (value), 1, 2, 3 (derivative along x, y, z); nodes of the bottom face
/// first, then those above them in the same order.
///
/// With polynomials in q the integral through any number of plies is one Hankel matrix of the thickness moments, so the
/// stiffness costs the same for one ply as for a hundred: for components n, n′
///
/// K(n,n′) = Σ over in-plane points of w |J| G H(n,n′) Gᵀ, G: functions × (direction d, power k),
/// H(n,n′)\[(d,k),(d′,k′)\] = M\[k+k′\]\[row(n,d)\]\[row(n′,d′)\],
///
/// with the form (k, k′) of [`fem_core::transverse`] in place of M\[k+k′\] where transverse stresses are smooth.
///
/// Functions of nodes one above the other differ only in the sign of their odd powers of q. The sums run over the even
/// and the odd parts of the functions of one face, 11 terms in all, which halves the work.
#[derive(Debug, Clone)]
pub struct HermiteSolid<const F: usize, const H: usize> {
    pub(crate) info: ElementInfo,
    pub(crate) mass: Mass,
    pub(crate) stresses: TransverseStresses,
    /// The form of the element for triangles, where this is the one for quadrilaterals.
    pub(crate) triangular: Option<Box<HermiteSolid<24, 12>>>,
    table: Table<H>,
}

#[allow(private_bounds)]
impl<const F: usize, const H: usize> HermiteSolid<F, H>
where
    Self: Functions,
{
    /// With smooth transverse stresses.
    pub(crate) fn of(info: ElementInfo, mass: Mass, triangular: Option<HermiteSolid<24, 12>>) -> Self {
        let triangular = triangular.map(Box::new);
        Self { table: Table::new::<F>(info.plane()), info, mass, stresses: TransverseStresses::Smooth, triangular }
    }

    /// The same with these transverse stresses; [`TransverseStresses::Smooth`] if nothing is said.
    #[must_use]
    pub fn with_transverse_stresses(self, stresses: TransverseStresses) -> Self {
        let triangular = self.triangular.map(|wedge| Box::new(HermiteSolid { stresses, ..*wedge }));
        Self { stresses, triangular, ..self }
    }

    /// The functions of node `i` that carry its inertia, derivatives natural.
    pub(crate) fn inertia_functions(mass: Mass, i: usize, r: f64, s: f64) -> [Quartet; 4] {
        match mass {
            Mass::Cubic => Self::node_functions(i, r, s).n,
            Mass::Linear => [Self::linear(i, r, s), [0.0; 4], [0.0; 4], [0.0; 4]],
        }
    }

    fn jacobians(&self, cell: &Cell<'_>) -> Jacobians {
        let mut jacobians = [[[0.0; 2]; 2]; 4];
        for (jacobian, [r, s, _]) in jacobians.iter_mut().zip(&self.info.nodes[..H / 4]) {
            *jacobian = cell.plane(*r, *s).jacobian;
        }
        jacobians
    }

    /// Calls `each(function, [∂x, ∂y, ∂z])` for the functions of `nodes` at an in-plane point, derivatives as polynomials in q.
    fn gradients(
        cell: &Cell<'_>,
        jacobians: &Jacobians,
        nodes: Range<usize>,
        r: f64,
        s: f64,
        plane: &PlaneMap,
        mut each: impl FnMut(usize, [Quartet; 3]),
    ) {
        let h = cell.half_height();
        for node in nodes {
            let (natural, jacobian) = (Self::node_functions(node, r, s), &jacobians[node % (H / 4)]);
            let [n, n_r, n_s] = [natural.n, natural.n_r, natural.n_s].map(|f| to_global(jacobian, h, &f));
            for m in 0..4 {
                let by = |d: usize| -> Quartet {
                    std::array::from_fn(|k| plane.inverse[0][d] * n_r[m][k] + plane.inverse[1][d] * n_s[m][k])
                };
                each(4 * node + m, [by(0), by(1), hermite::derivative(&n[m]).map(|c| c / h)]);
            }
        }
    }

    fn shape_of(&self, cell: &Cell<'_>, functions: Mass, [r, s, q]: [f64; 3], n: &mut [f64]) -> f64 {
        let (h, jacobians) = (cell.half_height(), self.jacobians(cell));
        n.fill(0.0);
        for node in 0..H / 2 {
            let functions = Self::inertia_functions(functions, node, r, s);
            for (m, f) in to_global(&jacobians[node % (H / 4)], h, &functions).iter().enumerate() {
                for component in 0..3 {
                    n[3 * column(component, 4 * node + m) + component] = hermite::at(f, q);
                }
            }
        }
        cell.plane(r, s).det * h
    }
}

/// `[[x,r  y,r], [x,s  y,s]]` at each node of a face; a triangle leaves the last idle.
type Jacobians = [[[f64; 2]; 2]; 4];

/// Turns natural-derivative functions of a node into those of its global derivatives: f,r = x,r f,x + y,r f,y at the
/// node (eq. 20).
pub(crate) fn to_global([[x_r, y_r], [x_s, y_s]]: &[[f64; 2]; 2], half_height: f64, f: &[Quartet; 4]) -> [Quartet; 4] {
    let mut out = *f;
    for k in 0..4 {
        out[1][k] = f[1][k] * x_r + f[2][k] * x_s;
        out[2][k] = f[1][k] * y_r + f[2][k] * y_s;
        out[3][k] = f[3][k] * half_height;
    }
    out
}

/// Column of a function of a component in the cell's unknowns.
pub(crate) const fn column(component: usize, function: usize) -> usize {
    12 * (function / 4) + 4 * component + function % 4
}

/// Strains of a function with this gradient in each component; `at` takes the value of a polynomial.
fn put_strains(
    b: &mut [f64],
    f: usize,
    gradient: &[Quartet; 3],
    across: &Option<Across>,
    at: impl Fn(&Quartet) -> f64,
) {
    let values = gradient.each_ref().map(at);
    for (component, rows) in STRAIN_ROW.iter().enumerate() {
        let column = &mut b[6 * column(component, f)..][..6];
        rows.iter().zip(values).for_each(|(row, value)| column[*row] = value);
        if let Some(across) = across {
            across.put(column, rows, gradient);
        }
    }
}

impl<const F: usize, const H: usize> Element for HermiteSolid<F, H>
where
    Self: Functions,
{
    fn info(&self) -> &ElementInfo {
        &self.info
    }

    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, [r, s, q]: [f64; 3], b: &mut [f64]) -> f64 {
        let plane = cell.plane(r, s);
        let across = self.stresses.across(cell, slice, [q, q]);
        b.fill(0.0);
        Self::gradients(cell, &self.jacobians(cell), 0..H / 2, r, s, &plane, |f, g| {
            put_strains(b, f, &g, &across, |g| hermite::at(g, q));
        });
        plane.det * cell.half_height()
    }

    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.shape_of(cell, Mass::Cubic, xi, n)
    }

    fn inertia_shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.shape_of(cell, self.mass, xi, n)
    }

    fn stiffness(&self, cell: &Cell<'_>, scratch: &mut Scratch, ke: &mut [f64]) -> Result<(), ElementError> {
        let points = self.info.plane().len();
        let rows = H * points;
        let columns = TERMS.len() * BLOCKS.len();
        let [g, weighted, hankel, p, parts] = scratch.arrays([
            rows * TERMS.len(),
            rows * TERMS.len(),
            TERMS.len() * columns,
            2 * rows * columns,
            4 * H * H,
        ]);
        let jacobians = self.jacobians(cell);
        // G: H × (11 · points), the point running fastest among the columns.
        for (point, (r, s, w)) in self.info.plane_points().enumerate() {
            let plane = cell.plane(r, s);
            let dv = positive(plane.det * cell.half_height())? * w;
            Self::gradients(cell, &jacobians, H / 4..H / 2, r, s, &plane, |f, gradient| {
                for (term, (d, k)) in TERMS.iter().enumerate() {
                    let at = (term * points + point) * H + f - H;
                    g[at] = gradient[*d][*k];
                    weighted[at] = dv * gradient[*d][*k];
                }
            });
        }
        let transverse = self.stresses.in_stack(cell.stack);
        // [H(1,1) | H(1,2) | ...]: 11 × 66.
        for (column, hankel) in hankel.chunks_exact_mut(TERMS.len()).enumerate() {
            let (n, n2) = BLOCKS[column / TERMS.len()];
            let (d2, k2) = TERMS[column % TERMS.len()];
            for (h, (d, k)) in hankel.iter_mut().zip(&TERMS) {
                let moment = transverse.map_or(&cell.stack.stiffness_moments[k + k2], |t| t.form(*k, k2));
                *h = moment[STRAIN_ROW[n][*d]][STRAIN_ROW[n2][d2]];
            }
        }
        // P = G H of the even halves and of the odd ones, with (function, point) as rows.
        let hankel = MatRef::from_column_major_slice(hankel, TERMS.len(), columns);
        for ((half, g), p) in HALVES.iter().zip(halves(weighted, rows)).zip(p.chunks_exact_mut(rows * columns)) {
            let g = MatRef::from_column_major_slice(g, rows, half.len());
            let p = MatMut::from_column_major_slice_mut(p, rows, columns);
            matmul(p, Accum::Replace, g, hankel.subrows(half.start, half.len()), 1.0, Par::Seq);
        }
        for (b, (n, n2)) in BLOCKS.iter().enumerate() {
            // Read again, each block of P is H × (11 · points).
            let blocks = p.chunks_exact(rows * columns).map(|p| &p[b * rows * TERMS.len()..][..rows * TERMS.len()]);
            let pairs = blocks.flat_map(|p| halves(p, rows).into_iter().zip(halves(g, rows)));
            for ((p, g), part) in pairs.zip(parts.chunks_exact_mut(H * H)) {
                let [p, g] = [p, g].map(|a| MatRef::from_column_major_slice(a, H, a.len() / H));
                let part = MatMut::from_column_major_slice_mut(part, H, H);
                matmul(part, Accum::Replace, p, g.transpose(), 1.0, Par::Seq);
            }
            let mut put = |f: usize, f2: usize, value: f64| {
                ke[column(*n, f) + 3 * F * column(*n2, f2)] = value;
                ke[column(*n2, f2) + 3 * F * column(*n, f)] = value;
            };
            for at in 0..H * H {
                let (f, f2) = (at % H, at / H);
                let [ee, eo, oe, oo] = [0, 1, 2, 3].map(|part| parts[part * H * H + at]);
                let (sign, sign2) = (BELOW[f % 4], BELOW[f2 % 4]);
                put(f, f2, sign * sign2 * (ee - eo - oe + oo));
                put(f + H, f2, sign2 * (ee - eo + oe - oo));
                put(f, f2 + H, sign * (ee + eo - oe - oo));
                put(f + H, f2 + H, ee + eo + oe + oo);
            }
        }
        Ok(())
    }

    fn mass(&self, cell: &Cell<'_>, scratch: &mut Scratch, me: &mut [f64]) -> Result<(), ElementError> {
        let points = self.info.plane().len();
        let (jacobians, h) = (self.jacobians(cell), cell.half_height());
        let [n, weighted, hankel, p, block] =
            scratch.arrays([F * 4 * points, F * 4 * points, 16, F * 4 * points, F * F]);
        for (point, (r, s, w)) in self.info.plane_points().enumerate() {
            let dv = positive(cell.plane(r, s).det * h)? * w;
            for node in 0..H / 2 {
                let functions = Self::inertia_functions(self.mass, node, r, s);
                for (m, f) in to_global(&jacobians[node % (H / 4)], h, &functions).iter().enumerate() {
                    for (k, value) in f.iter().enumerate() {
                        let at = (k * points + point) * F + 4 * node + m;
                        n[at] = *value;
                        weighted[at] = dv * value;
                    }
                }
            }
        }
        for (i, h) in hankel.iter_mut().enumerate() {
            *h = cell.stack.density_moments[i % 4 + i / 4];
        }
        multiply(p, matrix(weighted, F * points), matrix(hankel, 4));
        let p = MatRef::from_column_major_slice(p, F, 4 * points);
        let n = MatRef::from_column_major_slice(n, F, 4 * points);
        matmul(MatMut::from_column_major_slice_mut(block, F, F), Accum::Replace, p, n.transpose(), 1.0, Par::Seq);
        me.fill(0.0);
        for component in 0..3 {
            for f2 in 0..F {
                for f in 0..F {
                    // The sum of both triangles: symmetric to the last bit.
                    me[column(component, f) + 3 * F * column(component, f2)] =
                        0.5 * (block[f + F * f2] + block[f2 + F * f]);
                }
            }
        }
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
        let [coefficients] = scratch.arrays([COEFFICIENTS * 3 * F]);
        self.coefficients(cell, plane, coefficients)?;
        for (part, b) in parts.iter().zip(b.chunks_exact_mut(18 * F)) {
            let shares = self.shares(cell.stack, part);
            for (column, coefficients) in b.chunks_exact_mut(6).zip(coefficients.chunks_exact(COEFFICIENTS)) {
                for (strain, shares) in column.iter_mut().zip(&shares) {
                    *strain = shares.iter().zip(coefficients).map(|(share, c)| share * c).sum();
                }
            }
        }
        Ok(())
    }

    fn held_stress(&self, stack: &Stack, part: &Part) -> [f64; 6] {
        let Slice { c, free, .. } = &stack.slices[part.slice];
        let mut strain = free.map(|e| [e]);
        if let Some(transverse) = self.stresses.in_stack(stack) {
            let a = transverse.amplitudes_of(stack.slices.iter().map(|slice| slice.free));
            transverse.assume(part.slice, part.q, &a.map(|a| [a]), &mut strain);
        }
        apply(c, &strain.map(|[e]| e)).map(|s| -s)
    }

    fn triangular(&self) -> Option<&dyn Element> {
        self.triangular.as_deref().map(|wedge| wedge as &dyn Element)
    }

    fn takes_bent_sides(&self) -> bool {
        true
    }

    fn cubic_strains(&self) -> Option<&dyn CubicStrains> {
        Some(self)
    }

    fn large_deflections(&self) -> Option<&dyn LargeDeflection> {
        Some(self)
    }
}

impl<const F: usize, const H: usize> CubicStrains for HermiteSolid<F, H>
where
    Self: Functions,
{
    fn coefficients(&self, cell: &Cell<'_>, plane: &[Point], b: &mut [f64]) -> Result<(), ElementError> {
        let (mut means, mut area) = ([[[0.0; 4]; 3]; F], 0.0);
        let jacobians = self.jacobians(cell);
        for point in plane {
            let [r, s] = point.at;
            let plane = cell.plane(r, s);
            let da = positive(plane.det * cell.half_height())? * point.weight();
            area += da;
            Self::gradients(cell, &jacobians, 0..H / 2, r, s, &plane, |f, gradient| {
                for (mean, value) in means[f].as_flattened_mut().iter_mut().zip(gradient.as_flattened()) {
                    *mean += da * value;
                }
            });
        }
        b.fill(0.0);
        for (f, gradient) in means.iter().enumerate() {
            for (component, rows) in STRAIN_ROW.iter().enumerate() {
                let powers = b[COEFFICIENTS * column(component, f)..][..COEFFICIENTS].chunks_exact_mut(6);
                for (k, strains) in powers.enumerate() {
                    rows.iter().zip(gradient).for_each(|(row, polynomial)| strains[*row] = polynomial[k] / area);
                }
            }
        }
        Ok(())
    }

    fn shares(&self, stack: &Stack, Part { slice, q: [low, high] }: &Part) -> [[f64; COEFFICIENTS]; 6] {
        let powers: Quartet = mean_powers(*low, *high);
        let mut shares = [[0.0; COEFFICIENTS]; 6];
        for (row, shares) in shares.iter_mut().enumerate() {
            powers.iter().enumerate().for_each(|(k, mean)| shares[6 * k + row] = *mean);
        }
        if let Some(transverse) = self.stresses.in_stack(stack) {
            for (k, operator) in transverse.operator(*slice, [*low, *high]).iter().enumerate() {
                for (i, row) in ACROSS.into_iter().enumerate() {
                    (0..6).for_each(|strain| shares[row][6 * k + strain] = operator[(i, strain)]);
                }
            }
        }
        shares
    }
}

#[allow(private_bounds)]
impl<const F: usize, const H: usize> HermiteSolid<F, H>
where
    Self: Functions,
{
    fn solid<T>(&self, cell: &Cell<'_>, with: impl FnOnce(&Solid<'_, F, 4>) -> T) -> T {
        let jacobians = self.jacobians(cell);
        let fill = |r: f64, s: f64, plane: &PlaneMap, out: &mut Gradients<F, 4>| {
            Self::gradients(cell, &jacobians, 0..H / 2, r, s, plane, |f, gradient| out[f] = gradient);
        };
        with(&Solid { info: &self.info, gradients: &fill, unknown: |n, f| Some(column(n, f)), stresses: self.stresses })
    }
}

impl<const F: usize, const H: usize> LargeDeflection for HermiteSolid<F, H>
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
        let Some(tangent) = tangent else {
            let jacobians = self.jacobians(cell);
            let mut natural = Natural::new(&self.table, &jacobians, cell.half_height(), u);
            let energy = large::energy(&self.info, self.stresses, cell, &mut natural)?;
            natural.force(&jacobians, force);
            return Ok(energy);
        };
        self.solid(cell, |solid| solid.internal(cell, u, scratch, force, Some(tangent)))
    }

    fn geometric_stiffness(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        kg: &mut [f64],
    ) -> Result<(), ElementError> {
        self.solid(cell, |solid| solid.geometric_stiffness(cell, u, scratch, kg))
    }

    fn large_strain(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], u: &[f64]) -> Result<[f64; 6], ElementError> {
        self.solid(cell, |solid| solid.strain(cell, slice, xi, u))
    }

    fn mean_large_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        u: &[f64],
        strains: &mut [f64],
    ) -> Result<(), ElementError> {
        let own = if plane == self.info.plane() { None } else { Some(Table::new::<F>(plane)) };
        let table = own.as_ref().unwrap_or(&self.table);
        let mut fields = NaturalFields::new(table, &self.jacobians(cell), cell.half_height(), u);
        large::mean_strains(cell, (parts, plane), self.stresses, &mut fields, strains)
    }
}
