//! Webster's beam element: the section x-z of a strip (report eqs 1-15).

use crate::hermite::{self, NodeFunctions};
use crate::hermite_solid::Mass;
use crate::large::{Gradients, Solid};
use crate::transverse::TransverseStresses;
use fem_core::dof::Dof;
use fem_core::domain::Domain;
use fem_core::element::{Cell, Element, ElementError, ElementInfo, Part, PlaneMap, Point, Scratch, Stack};
use fem_core::large::LargeDeflection;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo, Role};
use fem_core::quadrature::MAX_POINTS;
use fem_core::tensor::{Matrix6, apply};

/// Anticlockwise in the section, from the left of the bottom face.
const NODES: [[f64; 3]; 4] = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]];

/// U10 U11 U13 U30 U31 U33.
const DOFS: [Dof; 6] = [Dof::SOLID[0], Dof::SOLID[1], Dof::SOLID[3], Dof::SOLID[8], Dof::SOLID[9], Dof::SOLID[11]];

/// Which of the functions value, ∂r, ∂s, ∂q belong to the three unknowns of a component.
const FUNCTIONS: [usize; 3] = [0, 1, 3];

/// Components of strain in the section, and those across it.
const WITHIN: [usize; 3] = [0, 2, 5];
const ACROSS: [usize; 3] = [1, 3, 4];

/// What holds across the strip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlaneState {
    /// σ₂₂ = σ₁₂ = σ₂₃ = 0: a narrow strip, free at its sides.
    Stress,
    /// ε₂₂ = γ₁₂ = γ₂₃ = 0: a strip out of a wide plate in cylindrical bending.
    Strain,
}

/// Four-node section of a strip with six unknowns a node, any number of plies through one cell.
///
/// ```text
///   4-----3     q
///   |     |     |
///   1-----2     o--- r
/// ```
///
/// Unknowns count `6·node + 3·component + m` with component x, z and m = 0 (value), 1, 2 (derivative along x, z). The
/// shape functions are those of the solid element at the face s = sᵢ, where (19) is (3). Complete cubics in x and z are
/// reproduced. The cells are rectangles of the strip's width along x.
///
/// Under plane stress the strains across the section follow, ply by ply, from the stresses that vanish; they jump from
/// ply to ply and the stiffness is the condensed one.
#[derive(Debug, Clone)]
pub struct WebsterBeam {
    info: ElementInfo,
    state: PlaneState,
    mass: Mass,
}

impl WebsterBeam {
    /// In-plane order 4 is exact.
    pub const IN_PLANE_ORDER: usize = 4;

    /// # Errors
    /// In-plane orders below 3, which leave zero-energy modes, and above [`MAX_POINTS`].
    pub fn new(state: PlaneState, mass: Mass, in_plane_order: usize) -> Result<Self, ElementError> {
        if !(3..=MAX_POINTS).contains(&in_plane_order) {
            return Err(ElementError(format!(
                "in-plane order {in_plane_order}: at least 3 Gauss points along x are needed (2 leave 4 zero-energy \
                 modes), at most {MAX_POINTS} are offered"
            )));
        }
        Ok(Self {
            info: ElementInfo {
                domain: Domain::Quadrilateral,
                nodes: &NODES,
                dofs: &DOFS,
                in_plane_order,
                ply_order: 4,
            },
            state,
            mass,
        })
    }
}

/// The 3-D functions of a node of the section, which lies in their face s = 1.
fn functions([ri, _, qi]: [f64; 3], r: f64) -> NodeFunctions {
    hermite::node_functions([ri, 1.0, qi], r, 1.0)
}

/// Gauss-Jordan elimination of the strains across the section from σ(across) = 0: rows `ACROSS` then hold A with
/// ε(across) = −A ε(within), rows `WITHIN` the condensed stiffness.
fn eliminate(mut c: Matrix6) -> Matrix6 {
    for k in ACROSS {
        let pivot = c[k][k];
        let row = c[k].map(|v| v / pivot);
        for (i, other) in c.iter_mut().enumerate() {
            let factor = other[k];
            for (v, pivot_row) in other.iter_mut().zip(&row) {
                *v = if i == k { *pivot_row } else { *v - factor * pivot_row };
            }
        }
    }
    c
}

impl Element for WebsterBeam {
    fn info(&self) -> &ElementInfo {
        &self.info
    }

    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, [r, _, q]: [f64; 3], b: &mut [f64]) -> f64 {
        let plane = cell.plane(r, 0.0);
        let (half_length, half_height) = (plane.jacobian[0][0], cell.half_height());
        let scale = [1.0, half_length, half_height];
        b.fill(0.0);
        for (corner, b) in NODES.iter().zip(b.chunks_exact_mut(6 * DOFS.len())) {
            let natural = functions(*corner, r);
            for (m, function) in FUNCTIONS.iter().enumerate() {
                let by_x = scale[m] * hermite::at(&natural.n_r[*function], q) / half_length;
                let by_z = scale[m] * hermite::at(&hermite::derivative(&natural.n[*function]), q) / half_height;
                let (u, w) = (6 * m, 6 * (3 + m));
                (b[u], b[u + 5]) = (by_x, by_z);
                (b[w + 2], b[w + 5]) = (by_z, by_x);
            }
        }
        self.complete(&cell.stack.slices[slice].c, b);
        plane.det * half_height
    }

    fn shape(&self, cell: &Cell<'_>, [r, _, q]: [f64; 3], n: &mut [f64]) -> f64 {
        let plane = cell.plane(r, 0.0);
        let scale = [1.0, plane.jacobian[0][0], cell.half_height()];
        n.fill(0.0);
        for (corner, n) in NODES.iter().zip(n.chunks_exact_mut(3 * DOFS.len())) {
            let natural = functions(*corner, r);
            for (m, function) in FUNCTIONS.iter().enumerate() {
                let value = scale[m] * hermite::at(&natural.n[*function], q);
                n[3 * m] = value;
                n[3 * (3 + m) + 2] = value;
            }
        }
        plane.det * cell.half_height()
    }

    fn inertia_shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        if self.mass == Mass::Cubic {
            return self.shape(cell, xi, n);
        }
        n.fill(0.0);
        for ([ri, _, qi], n) in NODES.iter().zip(n.chunks_exact_mut(3 * DOFS.len())) {
            let value = hermite::at(&hermite::trilinear([*ri, 1.0, *qi], xi[0], 1.0), xi[2]);
            n[0] = value;
            n[3 * 3 + 2] = value;
        }
        cell.plane(xi[0], 0.0).det * cell.half_height()
    }

    fn held_stress(&self, stack: &Stack, part: &Part) -> [f64; 6] {
        let slice = &stack.slices[part.slice];
        apply(&self.condense(slice.c), &slice.free).map(|s| -s)
    }

    fn large_deflections(&self) -> Option<&dyn LargeDeflection> {
        Some(self)
    }
}

/// Functions of the section, value, ∂x, ∂z at each of four nodes.
const F: usize = 12;

impl WebsterBeam {
    fn solid<T>(&self, cell: &Cell<'_>, with: impl FnOnce(&Solid<'_, F, 4>) -> T) -> T {
        let fill = |r: f64, _: f64, plane: &PlaneMap, out: &mut Gradients<F, 4>| {
            let (half_length, half_height) = (plane.jacobian[0][0], cell.half_height());
            let scale = [1.0, half_length, half_height];
            for (corner, out) in NODES.iter().zip(out.chunks_exact_mut(FUNCTIONS.len())) {
                let natural = functions(*corner, r);
                for ((function, scale), [by_x, _, by_z]) in FUNCTIONS.iter().zip(scale).zip(out) {
                    *by_x = natural.n_r[*function].map(|c| scale / half_length * c);
                    *by_z = hermite::derivative(&natural.n[*function]).map(|c| scale / half_height * c);
                }
            }
        };
        let unknown = |component: usize, f: usize| match component {
            1 => None,
            x_or_z => {
                Some(2 * FUNCTIONS.len() * (f / FUNCTIONS.len()) + x_or_z / 2 * FUNCTIONS.len() + f % FUNCTIONS.len())
            }
        };
        let stresses = TransverseStresses::OfStrains;
        with(&Solid { info: &self.info, gradients: &fill, unknown, stresses })
    }

    /// The stiffness that the section sees: under plane stress that of strains within it, those across it left free.
    fn condense(&self, c: Matrix6) -> Matrix6 {
        if self.state == PlaneState::Strain {
            return c;
        }
        let condensed = eliminate(c);
        let within = |i: usize, j: usize| WITHIN.contains(&i) && WITHIN.contains(&j);
        std::array::from_fn(|i| std::array::from_fn(|j| if within(i, j) { condensed[i][j] } else { 0.0 }))
    }

    /// Fills in what plane stress in a ply of stiffness `c` makes of strains across the section.
    fn complete(&self, c: &Matrix6, strains: &mut [f64]) {
        if self.state == PlaneState::Stress {
            let c = eliminate(*c);
            for e in strains.chunks_exact_mut(6) {
                for k in ACROSS {
                    e[k] = -WITHIN.iter().map(|j| c[k][*j] * e[*j]).sum::<f64>();
                }
            }
        }
    }

    /// A stack with the stiffnesses of the strip.
    fn condensed(&self, stack: &Stack) -> Stack {
        let mut stack = stack.clone();
        stack.slices.iter_mut().for_each(|slice| slice.c = self.condense(slice.c));
        stack
    }
}

impl LargeDeflection for WebsterBeam {
    fn internal(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        force: &mut [f64],
        tangent: Option<&mut [f64]>,
    ) -> Result<f64, ElementError> {
        let stack = self.condensed(cell.stack);
        let cell = Cell { stack: &stack, ..*cell };
        self.solid(&cell, |solid| solid.internal(&cell, u, scratch, force, tangent))
    }

    fn geometric_stiffness(
        &self,
        cell: &Cell<'_>,
        u: &[f64],
        scratch: &mut Scratch,
        kg: &mut [f64],
    ) -> Result<(), ElementError> {
        let stack = self.condensed(cell.stack);
        let cell = Cell { stack: &stack, ..*cell };
        self.solid(&cell, |solid| solid.geometric_stiffness(&cell, u, scratch, kg))
    }

    fn large_strain(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], u: &[f64]) -> Result<[f64; 6], ElementError> {
        let mut strain = self.solid(cell, |solid| solid.strain(cell, 0, xi, u))?;
        self.complete(&cell.stack.slices[slice].c, &mut strain);
        Ok(strain)
    }

    fn mean_large_strains(
        &self,
        cell: &Cell<'_>,
        parts: &[Part],
        plane: &[Point],
        u: &[f64],
        strains: &mut [f64],
    ) -> Result<(), ElementError> {
        self.solid(cell, |solid| solid.mean_strains(cell, (parts, plane), u, strains))?;
        for (part, strain) in parts.iter().cycle().zip(strains.chunks_exact_mut(6)) {
            self.complete(&cell.stack.slices[part.slice].c, strain);
        }
        Ok(())
    }
}

const STATE: ParamInfo = ParamInfo::word(
    "state",
    "across the strip",
    &[("plane-stress", "its sides are free"), ("plane-strain", "no strain")],
);
const ORDER: ParamInfo = ParamInfo::count("in_plane_order", "Gauss points along x")
    .at_least(3.0)
    .at_most(MAX_POINTS as f64)
    .default(WebsterBeam::IN_PLANE_ORDER as f64)
    .role(Role::Quadrature);

impl Plugin for WebsterBeam {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Element,
        name: "webster-beam",
        summary: "section of a strip along x, 6 unknowns a node, any number of plies through one cell",
        source: "Webster, in AFWAL-TR-87-4117, eqs 1-15",
        params: &[STATE, Mass::PARAM, ORDER],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let state = match params.word(&STATE)? {
            "plane-strain" => PlaneState::Strain,
            _ => PlaneState::Stress,
        };
        let built = Self::new(state, Mass::of(params)?, params.count(&ORDER)?);
        Ok(Built::Element(Box::new(built.map_err(|e| ParamError::new(ORDER.name, e.to_string()))?)))
    }
}
