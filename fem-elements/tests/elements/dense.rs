//! Small models with dense matrices, for the tests of elements.

use fem_core::dof::Dof;
use fem_core::domain::Corners;
use fem_core::element::{Cell, Element, Part, Scratch, Slice, Stack, form};
use fem_core::material::Elastic;
use fem_core::mesh::PlaneMesh;
use fem_core::plate::{Plate, ZDerivatives};
use fem_core::tensor::rotate_stiffness;
use fem_core::testkit::Provided;
use nalgebra::{DMatrix, DVector};

/// A quadrilateral without a right angle or parallel edges, about 2 mm wide.
pub(crate) const CROOKED: [[f64; 2]; 4] = [[0.1e-3, -0.2e-3], [2.3e-3, 0.3e-3], [1.9e-3, 1.8e-3], [-0.3e-3, 1.4e-3]];

/// Carbon and epoxy.
pub(crate) fn carbon() -> Elastic {
    Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9)
}

/// Pagano's ply, without units.
pub(crate) fn pagano() -> Elastic {
    let (nu, g) = (0.25, 0.5);
    Elastic { e1: 25.0, e2: 1.0, e3: 1.0, nu12: nu, nu13: nu, nu23: nu, g12: g, g13: g, g23: 0.2 }
}

/// Plies of the given angles (degrees) and relative thicknesses from the bottom up; densities 1 and 1.5 in turn.
pub(crate) fn stack(elastic: &Elastic, plies: &[(f64, f64)]) -> Stack {
    let total: f64 = plies.iter().map(|p| p.1).sum();
    let c = elastic.stiffness();
    let mut below = 0.0;
    let slices = plies.iter().enumerate().map(|(i, (angle, thickness))| {
        let q = [below, below + thickness].map(|t| 2.0 * t / total - 1.0);
        below += thickness;
        Slice { q, c: rotate_stiffness(&c, angle.to_radians()), density: 1.0 + 0.5 * (i % 2) as f64, free: [0.0; 6] }
    });
    Stack::new(slices.collect())
}

/// Plies of one thickness and density 1.
pub(crate) fn even(elastic: &Elastic, angles: &[f64]) -> Stack {
    let mut slices = stack(elastic, &angles.iter().map(|a| (*a, 1.0)).collect::<Vec<_>>()).slices;
    slices.iter_mut().for_each(|s| s.density = 1.0);
    Stack::new(slices)
}

pub(crate) fn stiffness(element: &dyn Element, cell: &Cell<'_>) -> DMatrix<f64> {
    let n = element.info().ndof();
    let mut k = DMatrix::repeat(n, n, f64::NAN);
    element.stiffness(cell, &mut Scratch::default(), k.as_mut_slice()).unwrap();
    k
}

pub(crate) fn mass(element: &dyn Element, cell: &Cell<'_>) -> DMatrix<f64> {
    let n = element.info().ndof();
    let mut m = DMatrix::repeat(n, n, f64::NAN);
    element.mass(cell, &mut Scratch::default(), m.as_mut_slice()).unwrap();
    m
}

/// Largest difference relative to sqrt(aᵢᵢ aⱼⱼ) of the second matrix.
pub(crate) fn difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    let scale = b.diagonal().map(f64::sqrt);
    (a - b).component_div(&(&scale * scale.transpose())).amax()
}

/// Checks the overrides of an element against the provided methods.
pub(crate) fn check_overrides(element: &dyn Element, cell: &Cell<'_>) {
    let plain = Provided(element);
    let k = difference(&stiffness(element, cell), &stiffness(&plain, cell));
    assert!(k < 1e-12, "stiffness {k:e}");
    let m = difference(&mass(element, cell), &mass(&plain, cell));
    assert!(m < 1e-12, "mass {m:e}");
    let parts: Vec<Part> = (cell.stack.slices.iter().enumerate())
        .flat_map(|(slice, s)| [s.q, [s.q[1]; 2]].map(|q| Part { slice, q }))
        .collect();
    let strains = |element: &dyn Element| {
        let mut b = vec![f64::NAN; 6 * element.info().ndof() * parts.len()];
        element.mean_strains(cell, &parts, element.info().plane(), &mut Scratch::default(), &mut b).unwrap();
        DVector::from_vec(b)
    };
    let (got, want) = (strains(element), strains(&plain));
    let error = (&got - &want).amax() / want.amax();
    assert!(error < 1e-12, "mean strains {error:e}");
}

/// Eigenvalues of K with unit diagonal, ascending.
pub(crate) fn scaled_spectrum(k: &DMatrix<f64>) -> Vec<f64> {
    let scale = k.diagonal().map(|d| d.sqrt().recip());
    let mut values = k.component_mul(&(&scale * scale.transpose())).symmetric_eigenvalues().as_slice().to_vec();
    values.sort_by(f64::total_cmp);
    values
}

/// Six motions without energy and no seventh.
pub(crate) fn check_rigid_motions(element: &dyn Element, cell: &Cell<'_>) {
    let spectrum = scaled_spectrum(&stiffness(element, cell));
    assert!(spectrum[0] > -1e-12 && spectrum[5] < 1e-12, "{:?}", &spectrum[..7]);
    assert!(spectrum[6] > 1e-6, "{:?}", &spectrum[..7]);
    let model = Model::new(element, PlaneMesh::single(*cell.corners), cell.z.to_vec(), vec![cell.stack.clone()]);
    let length = cell.corners[2][0] - cell.corners[0][0];
    let scale = model.k.diagonal().map(f64::sqrt);
    for motion in 0..6 {
        let motions = |i| model.plate.rigid_motions(i, [1.0 * length, -2.0 * length, 0.5 * length], length)[motion];
        let u = DVector::from_fn(model.plate.ndof(), |i, _| motions(i));
        let size = u.component_mul(&scale).norm();
        let force = (&model.k * u).component_div(&scale).norm();
        assert!(force < 1e-13 * size, "motion {motion}: {:e}", force / size);
    }
}

/// A plate with dense matrices.
pub(crate) struct Model {
    pub(crate) plate: Plate,
    pub(crate) k: DMatrix<f64>,
    pub(crate) m: DMatrix<f64>,
}

impl Model {
    pub(crate) fn new(element: &dyn Element, plane: PlaneMesh, faces: Vec<f64>, stacks: Vec<Stack>) -> Self {
        Self::with(element, plane, (faces, stacks), ZDerivatives::Shared)
    }

    /// The same, whose layers share their z-derivatives or not.
    pub(crate) fn with(
        element: &dyn Element,
        plane: PlaneMesh,
        (faces, stacks): (Vec<f64>, Vec<Stack>),
        z_derivatives: ZDerivatives,
    ) -> Self {
        let plate = Plate::new(plane, faces, stacks, element, z_derivatives).unwrap();
        let n = plate.ndof();
        let mut model = Self { plate, k: DMatrix::zeros(n, n), m: DMatrix::zeros(n, n) };
        let mut dofs = Vec::new();
        for number in 0..model.plate.cells() {
            let cell = model.plate.cell(number);
            let element = form(element, cell.corners.domain());
            let (k, m) = (stiffness(element, &cell), mass(element, &cell));
            model.plate.cell_dofs(number, &mut dofs);
            for (j, dj) in dofs.iter().enumerate() {
                for (i, di) in dofs.iter().enumerate() {
                    model.k[(*di, *dj)] += k[(i, j)];
                    model.m[(*di, *dj)] += m[(i, j)];
                }
            }
        }
        model
    }

    /// Name and position of every unknown.
    pub(crate) fn unknowns(&self) -> Vec<(Dof, [f64; 3])> {
        let place = |i| {
            let (column, level, dof) = self.plate.locate(i);
            let [x, y] = self.plate.columns[column];
            (dof, [x, y, self.plate.levels[level]])
        };
        (0..self.plate.ndof()).map(place).collect()
    }

    /// K u = `load` with u given where `given` says so.
    pub(crate) fn solve(&self, load: &DVector<f64>, given: impl Fn(Dof, [f64; 3]) -> Option<f64>) -> DVector<f64> {
        let given: Vec<_> = self.unknowns().into_iter().map(|(dof, p)| given(dof, p)).collect();
        let free: Vec<usize> = (0..given.len()).filter(|i| given[*i].is_none()).collect();
        let mut u = DVector::from_iterator(given.len(), given.iter().map(|g| g.unwrap_or(0.0)));
        let force = (load - &self.k * &u).select_rows(&free);
        let inner = self.k.select_rows(&free).select_columns(&free);
        let solution = inner.cholesky().unwrap().solve(&force);
        for (i, value) in free.iter().zip(solution.iter()) {
            u[*i] = *value;
        }
        u
    }

    /// Lowest ω of K u = ω² M u with the unknowns fixed that `fixed` names, by inverse iteration.
    pub(crate) fn lowest_frequency(&self, fixed: impl Fn(Dof, [f64; 3]) -> bool) -> f64 {
        let unknowns = self.unknowns();
        let free: Vec<usize> = (0..unknowns.len()).filter(|i| !fixed(unknowns[*i].0, unknowns[*i].1)).collect();
        let part = |a: &DMatrix<f64>| a.select_rows(&free).select_columns(&free);
        let (k, m) = (part(&self.k).cholesky().unwrap(), part(&self.m));
        let mut u = DVector::repeat(free.len(), 1.0);
        let mut square = f64::INFINITY;
        loop {
            let mu = &m * &u;
            let next = k.solve(&mu);
            let estimate = next.dot(&mu) / next.dot(&(&m * &next));
            if (estimate - square).abs() < 1e-12 * estimate {
                return estimate.sqrt();
            }
            square = estimate;
            u = next.normalize();
        }
    }
}

/// `nx` × `ny` cells on (0, 1) × (0, 1), mapped.
pub(crate) fn grid(nx: usize, ny: usize, mut map: impl FnMut(f64, f64) -> [f64; 2]) -> PlaneMesh {
    let mut mesh = PlaneMesh::default();
    for j in 0..=ny {
        mesh.points.extend((0..=nx).map(|i| map(i as f64 / nx as f64, j as f64 / ny as f64)));
    }
    for j in 0..ny {
        mesh.quads.extend((0..nx).map(|i| {
            let first = j * (nx + 1) + i;
            Corners::from([first, first + 1, first + nx + 2, first + nx + 1].map(|v| v as u32))
        }));
    }
    mesh
}

/// Five quadrilaterals: a crooked one inside the unit square.
pub(crate) fn patch() -> PlaneMesh {
    PlaneMesh {
        points: vec![
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
            [0.27, 0.21],
            [0.74, 0.34],
            [0.67, 0.72],
            [0.31, 0.63],
        ],
        quads: vec![
            [0, 1, 5, 4].into(),
            [1, 2, 6, 5].into(),
            [2, 3, 7, 6].into(),
            [3, 0, 4, 7].into(),
            [4, 5, 6, 7].into(),
        ],
        ..Default::default()
    }
}

/// Support of a quarter of a plate on 0 ≤ x ≤ a/2, 0 ≤ y ≤ b/2, symmetric about x = 0 and y = 0, simply supported at the
/// other edges.
pub(crate) fn quarter_support([a, b]: [f64; 2]) -> impl Fn(Dof, [f64; 3]) -> bool {
    move |dof, [x, y, _]| {
        let along = |end: f64, v: f64| (v - end).abs() < 1e-9 * end;
        match dof.n() {
            1 => x == 0.0 || along(0.5 * b, y),
            2 => y == 0.0 || along(0.5 * a, x),
            _ => along(0.5 * a, x) || along(0.5 * b, y),
        }
    }
}
