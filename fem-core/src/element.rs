//! The contract of an element, and the kernels that any element gets for free.

use crate::dof::Dof;
use crate::quadrature::gauss_legendre;
use crate::tensor::Matrix6;
use dyn_clone::DynClone;
use std::fmt::{self, Debug};

/// What an element says of itself.
#[derive(Debug, Clone, Copy)]
pub struct ElementInfo {
    /// Natural coordinates (r, s, q) of the nodes; q runs through the thickness.
    pub nodes: &'static [[f64; 3]],
    /// Unknowns of every node, in element order.
    pub dofs: &'static [Dof],
    /// Gauss points per in-plane direction that integrate the element well.
    pub in_plane_order: usize,
    /// Gauss points through each ply.
    pub ply_order: usize,
}

impl ElementInfo {
    /// Number of unknowns of a cell.
    pub const fn ndof(&self) -> usize {
        self.nodes.len() * self.dofs.len()
    }
}

/// One ply (or the part of it) inside a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// Natural bounds, −1 ≤ q₀ < q₁ ≤ 1.
    pub q: [f64; 2],
    /// Stiffness in the plate's frame, Pa.
    pub c: Matrix6,
    /// Density, kg/m³.
    pub density: f64,
}

/// The plies of one layer of cells, with their thickness moments (computed once for all cells of the layer).
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    /// Plies from the bottom up; they fill −1 ≤ q ≤ 1.
    pub slices: Vec<Slice>,
    /// Mₘ = ∫ C qᵐ dq, m = 0 … 6.
    pub stiffness_moments: [Matrix6; 7],
    /// ∫ ρ qᵐ dq, m = 0 … 6.
    pub density_moments: [f64; 7],
}

impl Stack {
    /// Computes the moments of `slices`.
    pub fn new(slices: Vec<Slice>) -> Self {
        let mut stiffness_moments = [[[0.0; 6]; 6]; 7];
        let mut density_moments = [0.0; 7];
        for slice in &slices {
            for m in 0..7 {
                let p = m as i32 + 1;
                let moment = (slice.q[1].powi(p) - slice.q[0].powi(p)) / f64::from(p);
                density_moments[m] += slice.density * moment;
                for (row, c) in stiffness_moments[m].iter_mut().zip(&slice.c) {
                    for (a, b) in row.iter_mut().zip(c) {
                        *a += b * moment;
                    }
                }
            }
        }
        Self { slices, stiffness_moments, density_moments }
    }
}

/// A cell as an element sees it.
#[derive(Debug, Clone, Copy)]
pub struct Cell<'a> {
    /// Node positions, m, in the order of [`ElementInfo::nodes`].
    pub x: &'a [[f64; 3]],
    /// Its plies.
    pub stack: &'a Stack,
}

/// Work arrays of one thread: handed out by size, kept between cells.
#[derive(Debug, Default)]
pub struct Scratch {
    buffers: Vec<Vec<f64>>,
}

impl Scratch {
    /// `N` zeroed arrays of the given sizes; allocates only when one grows.
    pub fn arrays<const N: usize>(&mut self, sizes: [usize; N]) -> [&mut [f64]; N] {
        if self.buffers.len() < N {
            self.buffers.resize_with(N, Vec::new);
        }
        for (buffer, size) in self.buffers.iter_mut().zip(sizes) {
            buffer.clear();
            buffer.resize(size, 0.0);
        }
        let mut all = self.buffers.iter_mut();
        std::array::from_fn(|_| match all.next() {
            Some(buffer) => buffer.as_mut_slice(),
            None => Default::default(),
        })
    }
}

/// A cell that an element cannot take.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementError(pub String);

impl fmt::Display for ElementError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
impl std::error::Error for ElementError {}

/// A finite element.
///
/// Required: the table, the strain operator and the shape functions. All matrices follow from them through the
/// provided methods, which integrate ply by ply; override those only to be faster, never to differ.
/// An element is stateless: one object serves every cell of a model.
///
/// Unknowns of a cell count node by node, `nodes × dofs`; matrices are column-major.
pub trait Element: DynClone + Debug + Send + Sync {
    /// Nodes, unknowns, integration orders.
    fn info(&self) -> &ElementInfo;

    /// Strain operator at natural point `xi`: `b` (6 × ndof) with ε = b u, engineering shears, plate frame.
    ///
    /// Returns the Jacobian determinant |∂x/∂ξ|.
    fn strain_operator(&self, x: &[[f64; 3]], xi: [f64; 3], b: &mut [f64]) -> f64;

    /// Shape functions at `xi`: `n` (3 × ndof) with displacement = n u. Returns |∂x/∂ξ|.
    fn shape(&self, x: &[[f64; 3]], xi: [f64; 3], n: &mut [f64]) -> f64;

    /// Shape functions that carry the inertia; an element with a simplified mass overrides them.
    fn inertia_shape(&self, x: &[[f64; 3]], xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.shape(x, xi, n)
    }

    /// Stiffness `ke` (ndof × ndof) = Σ over plies ∫ bᵀ C b dV (report eqs 9, 23).
    ///
    /// # Errors
    /// A Jacobian that is not positive at a Gauss point.
    fn stiffness(&self, cell: &Cell<'_>, scratch: &mut Scratch, ke: &mut [f64]) -> Result<(), ElementError> {
        let n = self.info().ndof();
        let [b, cb] = scratch.arrays([6 * n, 6 * n]);
        ke.fill(0.0);
        integrate(self.info(), cell.stack, |slice, xi, w| {
            let dv = positive(self.strain_operator(cell.x, xi, b))? * w;
            for (cb, b) in cb.chunks_exact_mut(6).zip(b.chunks_exact(6)) {
                for (cb, row) in cb.iter_mut().zip(&slice.c) {
                    *cb = dv * row.iter().zip(b).map(|(c, b)| c * b).sum::<f64>();
                }
            }
            add_product(ke, b, cb, 6, n);
            Ok(())
        })
    }

    /// Mass `me` (ndof × ndof) = Σ over plies ∫ ρ nᵀ n dV (report eq. 11).
    ///
    /// # Errors
    /// A Jacobian that is not positive at a Gauss point.
    fn mass(&self, cell: &Cell<'_>, scratch: &mut Scratch, me: &mut [f64]) -> Result<(), ElementError> {
        let n = self.info().ndof();
        let [shape, weighted] = scratch.arrays([3 * n, 3 * n]);
        me.fill(0.0);
        integrate(self.info(), cell.stack, |slice, xi, w| {
            let dm = positive(self.inertia_shape(cell.x, xi, shape))? * w * slice.density;
            for (a, b) in weighted.iter_mut().zip(shape.iter()) {
                *a = dm * b;
            }
            add_product(me, shape, weighted, 3, n);
            Ok(())
        })
    }

    /// Mean-strain operators `b` (6 × ndof each, one after the other) over parts q₀ ≤ q ≤ q₁ of the cell: (1/V) ∫ B dV for
    /// q₀ < q₁ (report eq. 12), the area mean of the face q₀ for q₀ = q₁ (eq. 14).
    ///
    /// # Errors
    /// A Jacobian that is not positive at a Gauss point.
    fn mean_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[[f64; 2]],
        scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        let info = self.info();
        let n = 6 * info.ndof();
        let [point] = scratch.arrays([n]);
        let plane = gauss_legendre(info.in_plane_order);
        for ([low, high], b) in parts.iter().zip(b.chunks_exact_mut(n)) {
            b.fill(0.0);
            let mut volume = 0.0;
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            for &(t, wt) in gauss_legendre(if half > 0.0 { info.ply_order } else { 1 }) {
                for &(r, wr) in plane {
                    for &(s, ws) in plane {
                        let xi = [r, s, middle + half * t];
                        let dv = positive(self.strain_operator(cell.x, xi, point))? * wr * ws * wt;
                        volume += dv;
                        for (b, p) in b.iter_mut().zip(point.iter()) {
                            *b += dv * p;
                        }
                    }
                }
            }
            for b in b {
                *b /= volume;
            }
        }
        Ok(())
    }
}
dyn_clone::clone_trait_object!(Element);

/// Ply-wise Gauss points of a cell with their weights (without the Jacobian).
fn integrate(
    info: &ElementInfo,
    stack: &Stack,
    mut at: impl FnMut(&Slice, [f64; 3], f64) -> Result<(), ElementError>,
) -> Result<(), ElementError> {
    let plane = gauss_legendre(info.in_plane_order);
    let through = gauss_legendre(info.ply_order);
    for slice in &stack.slices {
        let (middle, half) = (0.5 * (slice.q[0] + slice.q[1]), 0.5 * (slice.q[1] - slice.q[0]));
        for &(t, wt) in through {
            for &(r, wr) in plane {
                for &(s, ws) in plane {
                    at(slice, [r, s, middle + half * t], wr * ws * wt * half)?;
                }
            }
        }
    }
    Ok(())
}

/// The Jacobian determinant if it is positive.
///
/// # Errors
/// Zero, negative or NaN.
pub fn positive(jacobian: f64) -> Result<f64, ElementError> {
    if jacobian > 0.0 {
        Ok(jacobian)
    } else {
        Err(ElementError(format!("the Jacobian determinant is {jacobian:.3e}: the cell is folded or degenerate")))
    }
}

/// `k ← k + aᵀ b`, a and b of `rows × n`, column-major.
fn add_product(k: &mut [f64], a: &[f64], b: &[f64], rows: usize, n: usize) {
    for (j, bj) in b.chunks_exact(rows).enumerate() {
        let column = &mut k[j * n..(j + 1) * n];
        for (k, ai) in column.iter_mut().zip(a.chunks_exact(rows)) {
            *k += ai.iter().zip(bj).map(|(a, b)| a * b).sum::<f64>();
        }
    }
}
