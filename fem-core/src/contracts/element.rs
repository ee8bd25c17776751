//! The contract of an element, and the kernels that any element gets for free.

use crate::contracts::cubic_strains::CubicStrains;
use crate::contracts::large::LargeDeflection;
use crate::words::dof::Dof;
use crate::words::domain::{Domain, PlaneCell};
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::apply;
use dyn_clone::DynClone;
use std::fmt::{self, Debug};

pub use crate::contracts::stack::{Slice, Stack};
pub use crate::words::domain::{PlaneMap, Point};

/// How an element describes itself.
#[derive(Debug, Clone, Copy)]
pub struct ElementInfo {
    /// Shape of the plane cells that it stands on.
    pub domain: Domain,
    /// Natural coordinates (r, s, q) of the nodes, each −1, 0 or 1; q runs through the thickness.
    ///
    /// Nodes at the same place of neighbouring cells are one node, so that the table alone says how cells connect: corners
    /// at (±1, ±1), middles of edges at (0, ±1) and (±1, 0), or (0, 0) on a triangle's hypotenuse. An element all of whose nodes have s = 0 is the section of a
    /// strip that runs along x, one cell across; its width is that of the strip.
    pub nodes: &'static [[f64; 3]],
    /// Unknowns of every node, in element order.
    pub dofs: &'static [Dof],
    /// In-plane order of quadrature ([`Domain::points`]) that integrates the element well: Gauss points per direction.
    pub in_plane_order: usize,
    /// Gauss points through each ply.
    pub ply_order: usize,
}

impl ElementInfo {
    /// Number of unknowns of a cell.
    pub const fn ndof(&self) -> usize {
        self.nodes.len() * self.dofs.len()
    }

    /// True for the section of a strip: nothing varies along s.
    pub fn is_section(&self) -> bool {
        self.nodes.iter().all(|n| n[1] == 0.0)
    }

    /// True for a plate theory: all nodes at q = 0, so that one cell holds the whole laminate.
    pub fn is_shell(&self) -> bool {
        self.nodes.iter().all(|n| n[2] == 0.0)
    }

    /// Natural coordinates of the middle of a cell.
    pub fn centre(&self) -> [f64; 3] {
        let [r, s] = self.domain.centre();
        [r, s, 0.0]
    }

    /// In-plane quadrature points of the whole cell.
    pub fn plane(&self) -> &'static [Point] {
        let order = self.in_plane_order;
        if self.is_section() { Domain::section_points(order) } else { self.domain.points(order) }
    }

    /// In-plane quadrature points (r, s, weight).
    pub fn plane_points(&self) -> impl Iterator<Item = (f64, f64, f64)> + use<> {
        self.plane().iter().map(|point| (point.at[0], point.at[1], point.weight()))
    }
}

/// A cell: an upright prism over a plane cell, and its plies.
#[derive(Debug, Clone, Copy)]
pub struct Cell<'a> {
    /// The plane cell: its corners, m, anticlockwise from (r, s) = (−1, −1), and its sides.
    pub corners: PlaneCell,
    /// Heights of the lower and upper face, m.
    pub z: [f64; 2],
    /// Its plies.
    pub stack: &'a Stack,
}

impl Cell<'_> {
    /// The map of the plane cell at (r, s).
    pub fn plane(&self, r: f64, s: f64) -> PlaneMap {
        self.corners.plane_map(r, s)
    }

    /// Half the height, ∂z/∂q, m.
    pub fn half_height(&self) -> f64 {
        0.5 * (self.z[1] - self.z[0])
    }

    /// q at the height `z`, m, or at the nearer face.
    pub fn natural_height(&self, z: f64) -> f64 {
        ((z - 0.5 * (self.z[0] + self.z[1])) / self.half_height()).clamp(-1.0, 1.0)
    }

    /// Position of a natural point, m.
    pub fn position(&self, [r, s, q]: [f64; 3]) -> [f64; 3] {
        let [x, y] = self.corners.position([r, s]);
        [x, y, 0.5 * (self.z[0] + self.z[1]) + q * self.half_height()]
    }
}

/// A part of a cell: q₀ ≤ q ≤ q₁ within one of its plies, or the face q₀ = q₁ of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Which slice of the stack.
    pub slice: usize,
    /// Its natural bounds.
    pub q: [f64; 2],
}

/// Work arrays of one thread: handed out by size, kept between cells.
#[derive(Debug, Clone, Default)]
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

    /// Strain operator in the ply `slice` at natural point `xi`: `b` (6 × ndof) with ε = b u, engineering shears, plate frame.
    ///
    /// The ply matters to theories that give up a strain for a known stress: with σ₃₃ = 0 the strain ε₃₃ follows from
    /// the others and the ply's stiffness, and bᵀ C b is then the reduced stiffness.
    ///
    /// Returns the Jacobian determinant |∂x/∂ξ|.
    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64;

    /// Shape functions at `xi`: `n` (3 × ndof) with displacement = n u. Returns |∂x/∂ξ|.
    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64;

    /// Shape functions that carry the inertia; an element with a simplified mass overrides them.
    fn inertia_shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.shape(cell, xi, n)
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
            let dv = positive(self.strain_operator(cell, slice, xi, b))? * w;
            for (cb, b) in cb.chunks_exact_mut(6).zip(b.chunks_exact(6)) {
                for (cb, row) in cb.iter_mut().zip(&cell.stack.slices[slice].c) {
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
            let dm = positive(self.inertia_shape(cell, xi, shape))? * w * cell.stack.slices[slice].density;
            for (a, b) in weighted.iter_mut().zip(shape.iter()) {
                *a = dm * b;
            }
            add_product(me, shape, weighted, 3, n);
            Ok(())
        })
    }

    /// Mean stress of a part of a layer in a cell at rest, or its value on a face, plate's frame, Pa: −C ε₀ of the ply's free
    /// strain; a theory that gives up a strain for a stress that it knows lets that strain go. The stress of displacements u is
    /// C b u on top of it.
    fn held_stress(&self, stack: &Stack, part: &Part) -> [f64; 6] {
        let Slice { c, free, .. } = &stack.slices[part.slice];
        apply(c, free).map(|s| -s)
    }

    /// Force `f` (ndof) = Σ over plies ∫ bᵀ C ε₀ dV by which free strains move the cell. Returns what energy the cell has when
    /// it is held against them, Σ ∫ ½ ε₀ C ε₀ dV, J.
    ///
    /// # Errors
    /// A Jacobian that is not positive at a Gauss point.
    fn free_force(&self, cell: &Cell<'_>, scratch: &mut Scratch, f: &mut [f64]) -> Result<f64, ElementError> {
        let [b] = scratch.arrays([6 * self.info().ndof()]);
        let mut energy = 0.0;
        f.fill(0.0);
        integrate(self.info(), cell.stack, |slice, xi, w| {
            let dv = positive(self.strain_operator(cell, slice, xi, b))? * w;
            let ply = &cell.stack.slices[slice];
            let held = self.held_stress(cell.stack, &Part { slice, q: [xi[2]; 2] });
            for (f, b) in f.iter_mut().zip(b.chunks_exact(6)) {
                *f -= dv * b.iter().zip(held).map(|(b, s)| b * s).sum::<f64>();
            }
            energy -= 0.5 * dv * ply.free.iter().zip(held).map(|(e, s)| e * s).sum::<f64>();
            Ok(())
        })?;
        Ok(energy)
    }

    /// Mean-strain operators `b` (6 × ndof each, one after the other) of parts of the cell: (1/V) ∫ B dV (report eq. 12),
    /// or the area mean of a face (eq. 14); in the plane over the points `plane`, those of the [whole](ElementInfo::plane) cell or a
    /// single one.
    ///
    /// # Errors
    /// A Jacobian that is not positive at a Gauss point.
    fn mean_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        scratch: &mut Scratch,
        b: &mut [f64],
    ) -> Result<(), ElementError> {
        let info = self.info();
        let n = 6 * info.ndof();
        let [point] = scratch.arrays([n]);
        for (Part { slice, q: [low, high] }, b) in parts.iter().zip(b.chunks_exact_mut(n)) {
            b.fill(0.0);
            let mut volume = 0.0;
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            for &(t, wt) in gauss_legendre(if half > 0.0 { info.ply_order } else { 1 }) {
                for at in plane {
                    let xi = [at.at[0], at.at[1], middle + half * t];
                    let dv = positive(self.strain_operator(cell, *slice, xi, point))? * at.weight() * wt;
                    volume += dv;
                    for (b, p) in b.iter_mut().zip(point.iter()) {
                        *b += dv * p;
                    }
                }
            }
            for b in b {
                *b /= volume;
            }
        }
        Ok(())
    }

    /// The form on triangles of an element for quadrilaterals, where it has one: the same unknowns at nodes of the same heights, and
    /// along a side the same functions, so that both stand side by side in a mesh.
    fn triangular(&self) -> Option<&dyn Element> {
        None
    }

    /// Whether the element may stand on cells with bent sides ([`PlaneCell`]): its functions hold all quadratics in r and s, and so
    /// all linear displacements of x and y there.
    fn takes_bent_sides(&self) -> bool {
        false
    }

    /// The strains of an element for which they are cubic through the height of a cell, where it offers them: means over the parts of
    /// many plies are then quicker to take than by [`Element::mean_strains`].
    fn cubic_strains(&self) -> Option<&dyn CubicStrains> {
        None
    }

    /// The element under large deflections, where it knows them.
    fn large_deflections(&self) -> Option<&dyn LargeDeflection> {
        None
    }
}
dyn_clone::clone_trait_object!(Element);

/// The form of an element for cells of a shape; the element itself where it has none.
pub fn form(element: &dyn Element, domain: Domain) -> &dyn Element {
    let forms = [Some(element), element.triangular()];
    forms.into_iter().flatten().find(|form| form.info().domain == domain).unwrap_or(element)
}

/// The tables of an element on the shapes of cells that it takes.
#[derive(Debug, Clone, Copy)]
pub struct Tables {
    /// Of the element itself.
    pub own: ElementInfo,
    /// Of its form on triangles.
    pub triangular: Option<ElementInfo>,
}

impl Tables {
    /// The table for cells of a shape.
    pub fn on(&self, domain: Domain) -> Option<&ElementInfo> {
        [Some(&self.own), self.triangular.as_ref()].into_iter().flatten().find(|info| info.domain == domain)
    }

    /// What the element stands on: "quadrilaterals and triangles".
    pub fn cells(&self) -> &'static str {
        match [Domain::Quadrilateral, Domain::Triangle].map(|domain| self.on(domain).is_some()) {
            [true, true] => "quadrilaterals and triangles",
            [_, false] => "quadrilaterals",
            [false, _] => "triangles",
        }
    }
}

impl From<ElementInfo> for Tables {
    fn from(own: ElementInfo) -> Self {
        Self { own, triangular: None }
    }
}

impl From<&dyn Element> for Tables {
    fn from(element: &dyn Element) -> Self {
        Self { own: *element.info(), triangular: element.triangular().map(|form| *form.info()) }
    }
}

/// Ply-wise Gauss points of a cell, each with its slice and its weight (without the Jacobian).
fn integrate(
    info: &ElementInfo,
    stack: &Stack,
    mut at: impl FnMut(usize, [f64; 3], f64) -> Result<(), ElementError>,
) -> Result<(), ElementError> {
    for (number, slice) in stack.slices.iter().enumerate() {
        let (middle, half) = (0.5 * (slice.q[0] + slice.q[1]), 0.5 * (slice.q[1] - slice.q[0]));
        for &(t, wt) in gauss_legendre(info.ply_order) {
            for (r, s, w) in info.plane_points() {
                at(number, [r, s, middle + half * t], w * wt * half)?;
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
pub(crate) fn add_product(k: &mut [f64], a: &[f64], b: &[f64], rows: usize, n: usize) {
    for (j, bj) in b.chunks_exact(rows).enumerate() {
        let column = &mut k[j * n..(j + 1) * n];
        for (k, ai) in column.iter_mut().zip(a.chunks_exact(rows)) {
            *k += ai.iter().zip(bj).map(|(a, b)| a * b).sum::<f64>();
        }
    }
}
