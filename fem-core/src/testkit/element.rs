//! The contract of an element.

use crate::contracts::cubic_strains::{COEFFICIENTS, CubicStrains};
use crate::contracts::element::{Cell, Element, ElementError, ElementInfo, Part, Scratch, Slice, Stack};
use crate::plates::mesh::PlaneMesh;
use crate::plates::plate::{Plate, ZDerivatives};
use crate::words::domain::{Corners, Domain};
use crate::words::material::Elastic;
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::rotate_stiffness;
use nalgebra::{DMatrix, SymmetricEigen};

/// Agreement asked for, relative to √(kᵢᵢ kⱼⱼ) or the largest of what is compared.
const TOLERANCE: f64 = 1e-10;

/// Eigenvalues of the stiffness below this fraction of the largest count as zero.
const ZERO: f64 = 1e-11;

/// What an element can be but for its faults.
///
/// On regular, distorted, slender and tiny cells of one ply and of several:
///
/// * K and M are finite and symmetric, M is semi-definite, and both agree with what the provided methods make of the
///   operators, as do mean strains
/// * as many zero eigenvalues as rigid motions that the unknowns can express, and no force on any of these
/// * linear displacements are reproduced, with their strains; a uniform motion carries the mass of the cell
/// * the corner that is counted first, the axes and the unit of length do not matter
/// * folded, flat and undefined cells are refused; so may be the distorted one, by an element for parallelograms
/// * the form on triangles, if there is one, is such an element too, has the same unknowns, and moves as this one does along a
///   side that both share
///
/// # Errors
/// The first violation, in words.
pub fn check_element(element: &dyn Element) -> Result<(), String> {
    let info = element.info();
    let valid = |n: &[f64; 3]| n.iter().all(|c| [-1.0, 0.0, 1.0].contains(c));
    if info.nodes.is_empty() || info.dofs.is_empty() || !info.nodes.iter().all(valid) {
        return Err("the table needs nodes at natural coordinates -1, 0 or 1, and unknowns".into());
    }
    if info.nodes.iter().enumerate().any(|(i, n)| info.nodes[..i].contains(n)) {
        return Err("two nodes stand at one place".into());
    }
    for (name, corners, z) in cells(info) {
        for (plies, stack) in stacks() {
            let cell = Cell { corners: corners.into(), z, stack: &stack };
            let found = match Matrices::of(element, &cell) {
                Err(_) if name == "distorted" => continue,
                found => found.map_err(|e| format!("{name} cell, {plies}: {e}"))?,
            };
            found.check(element, &cell, name == "regular").map_err(|why| format!("{name} cell, {plies}: {why}"))?;
        }
    }
    frames(element)?;
    refusals(element)?;
    match element.triangular() {
        Some(wedge) => {
            side_by_side(element, wedge)?;
            check_element(wedge).map_err(|why| format!("on triangles: {why}"))
        }
        None => Ok(()),
    }
}

/// A square and a triangle below it move as one along their common side.
fn side_by_side(element: &dyn Element, wedge: &dyn Element) -> Result<(), String> {
    let (upper, lower) = (element.info(), wedge.info());
    if (upper.domain, lower.domain) != (Domain::Quadrilateral, Domain::Triangle) || upper.dofs != lower.dofs {
        return Err("the form on triangles needs an element for quadrilaterals, and its unknowns".into());
    }
    let stack = Stack::new(vec![tape(20.0)]);
    let z = [0.0, 0.4e-3];
    let square = Cell { corners: [[0.0, 0.0], [1e-3, 0.0], [1e-3, 1e-3], [0.0, 1e-3]].into(), z, stack: &stack };
    let triangle = Cell { corners: [[0.0, 0.0], [0.3e-3, -0.8e-3], [1e-3, 0.0]].into(), z, stack: &stack };
    // Anything at the nodes of the side, nothing elsewhere.
    let displacements = |element: &dyn Element, cell: &Cell<'_>| -> Vec<[f64; 3]> {
        let info = element.info();
        let unknown = |(at, k): (&[f64; 3], usize)| match cell.position(*at) {
            [x, y, z] if y.abs() < 1e-12 => (1e3 * x + 1.7e3 * z + 0.9 * k as f64 + 0.4).sin(),
            _ => 0.0,
        };
        let u: Vec<f64> =
            info.nodes.iter().flat_map(|at| (0..info.dofs.len()).map(move |k| unknown((at, k)))).collect();
        let mut shape = vec![0.0; 3 * info.ndof()];
        let points = (0..35).map(|i| [1e-3 * f64::from(i % 7) / 6.0, f64::from(i / 7) / 2.0 - 1.0]);
        let at = |[x, q]: [f64; 2]| {
            let [r, s] = cell.corners.locate([x, 0.0]).unwrap_or(info.domain.centre());
            element.shape(cell, [r, s, q], &mut shape);
            [0, 1, 2].map(|n| shape.chunks_exact(3).zip(&u).map(|(column, u)| column[n] * u).sum())
        };
        points.map(at).collect()
    };
    let (above, below) = (displacements(element, &square), displacements(wedge, &triangle));
    close(above.as_flattened(), below.as_flattened()).map_err(|e| format!("cells of both shapes part by {e:.1e}"))
}

type Shape = (&'static str, Corners<[f64; 2]>, [f64; 2]);

/// Cells to look at, m; a section knows rectangles along x only.
fn cells(info: &ElementInfo) -> Vec<Shape> {
    let rectangle = |a: f64, b: f64| [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]];
    let mut all = vec![
        ("regular", rectangle(1e-3, 1e-3), [-0.5e-3, 0.5e-3]),
        ("slender", rectangle(1.0, 1e-3), [0.0, 1e-3]),
        ("thin", rectangle(1e-3, 1e-3), [2e-3, 2.001e-3]),
        ("tiny", rectangle(2e-9, 1e-9), [0.0, 1e-9]),
    ];
    if !info.is_section() {
        all.push(("distorted", [[1e-3, 1e-3], [3e-3, 1.2e-3], [3.4e-3, 2.9e-3], [0.8e-3, 2.6e-3]], [0.0, 0.7e-3]));
    }
    all.into_iter().map(|(name, corners, z)| (name, part_of(info, corners), z)).collect()
}

/// A cell of the element's domain in a quadrilateral: all of it, or the triangle at its first corner.
fn part_of(info: &ElementInfo, corners: [[f64; 2]; 4]) -> Corners<[f64; 2]> {
    match info.domain {
        Domain::Quadrilateral => corners.into(),
        Domain::Triangle => [corners[0], corners[1], corners[3]].into(),
    }
}

/// Largest distance of a corner from the first, m.
fn extent(cell: &Cell<'_>) -> f64 {
    let [x, y] = cell.corners[0];
    cell.corners.iter().map(|p| (p[0] - x).hypot(p[1] - y)).fold(0.0, f64::max)
}

fn tape(angle_deg: f64) -> Slice {
    let c = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9).stiffness();
    Slice { q: [-1.0, 1.0], c: rotate_stiffness(&c, f64::to_radians(angle_deg)), density: 1575.0, free: [0.0; 6] }
}

/// One ply, and an unsymmetric laminate with a soft layer.
fn stacks() -> [(&'static str, Stack); 2] {
    let soft = Slice { c: Elastic::isotropic(1e9, 0.3).stiffness(), density: 500.0, ..tape(0.0) };
    let parts = [(tape(0.0), -0.5), (tape(45.0), 0.2), (soft, 0.6), (tape(90.0), 1.0)];
    let mut low = -1.0;
    let slices = parts.map(|(slice, high)| {
        let slice = Slice { q: [low, high], ..slice };
        low = high;
        slice
    });
    [("one ply", Stack::new(vec![tape(30.0)])), ("four plies", Stack::new(slices.to_vec()))]
}

/// An element without its overrides: what the provided methods make of its operators.
#[derive(Debug, Clone)]
pub struct Provided<'a>(pub &'a dyn Element);

impl Element for Provided<'_> {
    fn info(&self) -> &ElementInfo {
        self.0.info()
    }
    fn strain_operator(&self, cell: &Cell<'_>, slice: usize, xi: [f64; 3], b: &mut [f64]) -> f64 {
        self.0.strain_operator(cell, slice, xi, b)
    }
    fn shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.0.shape(cell, xi, n)
    }
    fn inertia_shape(&self, cell: &Cell<'_>, xi: [f64; 3], n: &mut [f64]) -> f64 {
        self.0.inertia_shape(cell, xi, n)
    }
}

/// Operators of the mean strains in all parts, by way of the coefficients.
fn means_of_cubics(cubic: &dyn CubicStrains, cell: &Cell<'_>, info: &ElementInfo) -> Result<Vec<f64>, ElementError> {
    let mut coefficients = vec![f64::NAN; COEFFICIENTS * info.ndof()];
    cubic.coefficients(cell, info.plane(), &mut coefficients)?;
    let mut means = Vec::new();
    for part in parts(cell.stack) {
        let shares = cubic.shares(cell.stack, &part);
        for column in coefficients.chunks_exact(COEFFICIENTS) {
            means
                .extend(shares.iter().map(|shares| shares.iter().zip(column).map(|(share, c)| share * c).sum::<f64>()));
        }
    }
    Ok(means)
}

struct Matrices {
    n: usize,
    k: Vec<f64>,
    m: Vec<f64>,
    means: Vec<f64>,
}

impl Matrices {
    fn of(element: &dyn Element, cell: &Cell<'_>) -> Result<Self, ElementError> {
        let n = element.info().ndof();
        let parts = parts(cell.stack);
        let (mut k, mut m) = (vec![f64::NAN; n * n], vec![f64::NAN; n * n]);
        let mut means = vec![f64::NAN; 6 * n * parts.len()];
        let mut scratch = Scratch::default();
        element.stiffness(cell, &mut scratch, &mut k)?;
        element.mass(cell, &mut scratch, &mut m)?;
        element.mean_strains(cell, &parts, element.info().plane(), &mut scratch, &mut means)?;
        Ok(Self { n, k, m, means })
    }

    fn check(&self, element: &dyn Element, cell: &Cell<'_>, regular: bool) -> Result<(), String> {
        let n = self.n;
        for (name, matrix) in [("stiffness", &self.k), ("mass", &self.m)] {
            if !matrix.iter().all(|v| v.is_finite()) {
                return Err(format!("the {name} is not finite"));
            }
            same(n, matrix, |i, j| matrix[j + n * i]).map_err(|e| format!("the {name} is not symmetric: {e:.1e}"))?;
        }
        let plain = Matrices::of(&Provided(element), cell).map_err(|e| e.to_string())?;
        for (name, own, provided) in [("stiffness", &self.k, &plain.k), ("mass", &self.m, &plain.m)] {
            same(n, own, |i, j| provided[i + n * j])
                .map_err(|e| format!("the overridden {name} differs from the provided one by {e:.1e}"))?;
        }
        close(&self.means, &plain.means).map_err(|e| format!("overridden mean strains differ by {e:.1e}"))?;
        if let Some(cubic) = element.cubic_strains() {
            let means = means_of_cubics(cubic, cell, element.info()).map_err(|e| e.to_string())?;
            close(&means, &plain.means).map_err(|e| format!("mean strains from coefficients differ by {e:.1e}"))?;
        }
        self.rigid_motions(element, cell, regular)?;
        linear_fields(element, cell)
    }

    fn rigid_motions(&self, element: &dyn Element, cell: &Cell<'_>, regular: bool) -> Result<(), String> {
        let (info, n) = (element.info(), self.n);
        let plate = single(cell, *info)?;
        let size = extent(cell);
        let centre = cell.position(info.centre());
        let mut dofs = Vec::new();
        plate.cell_dofs(0, &mut dofs);
        let motions: Vec<[f64; 6]> = dofs.iter().map(|d| plate.rigid_motions(*d, centre, size)).collect();
        let vector = |motion: usize| -> Vec<f64> { motions.iter().map(|m| m[motion]).collect() };
        let mut expressible = 0;
        let mass = mass_of(cell);
        for motion in 0..6 {
            let u = vector(motion);
            if u.iter().all(|u| u.abs() < 1e-9) {
                continue;
            }
            expressible += 1;
            for i in 0..n {
                let (force, size) = (0..n).fold((0.0, 0.0), |(f, s), j| {
                    let term = self.k[i + n * j] * u[j];
                    (f + term, s + f64::abs(term))
                });
                if f64::abs(force) > 1e-8 * size {
                    return Err(format!("rigid motion {motion} meets a force: {force:.1e} of {size:.1e}"));
                }
            }
            let carried: f64 = (0..n * n).map(|k| u[k % n] * self.m[k] * u[k / n]).sum();
            if motion < 3 && (carried / mass - 1.0).abs() > 1e-9 {
                return Err(format!("translation {motion} carries {carried:e} kg of {mass:e}"));
            }
        }
        if !regular {
            return Ok(());
        }
        let zero = |matrix: &[f64]| {
            // Derivative unknowns times a length: all entries of one unit.
            let scale = |i: usize| if info.dofs[i % info.dofs.len()].m() == 0 { 1.0 } else { 1.0 / size };
            let a = DMatrix::from_fn(n, n, |i, j| matrix[i + n * j] * scale(i) * scale(j));
            let eigenvalues = SymmetricEigen::new(a).eigenvalues;
            let largest = eigenvalues.max();
            let count = eigenvalues.iter().filter(|e| e.abs() <= ZERO * largest).count();
            (count, eigenvalues.min() / largest)
        };
        let (zeros, lowest) = zero(&self.k);
        if zeros != expressible || lowest < -ZERO {
            return Err(format!("{zeros} zero eigenvalues of the stiffness for {expressible} rigid motions"));
        }
        match zero(&self.m).1 {
            lowest if lowest < -ZERO => Err(format!("the mass has a negative eigenvalue: {lowest:.1e} of the largest")),
            _ => Ok(()),
        }
    }
}

fn parts(stack: &Stack) -> Vec<Part> {
    let each = |(slice, s): (usize, &Slice)| [Part { slice, q: s.q }, Part { slice, q: [s.q[1], s.q[1]] }];
    stack.slices.iter().enumerate().flat_map(each).collect()
}

fn mass_of(cell: &Cell<'_>) -> f64 {
    cell.corners.area() * cell.half_height() * cell.stack.density_moments[0]
}

/// A plate of this one cell.
fn single(cell: &Cell<'_>, info: ElementInfo) -> Result<Plate, String> {
    let (mesh, stacks) = (PlaneMesh::single(*cell.corners), vec![cell.stack.clone()]);
    Plate::new(mesh, cell.z.to_vec(), stacks, info, ZDerivatives::Shared).map_err(|why| why.to_string())
}

/// The largest difference of two matrices, where it exceeds the tolerance.
fn same(n: usize, a: &[f64], b: impl Fn(usize, usize) -> f64) -> Result<(), f64> {
    let mut worst = 0.0_f64;
    for j in 0..n {
        for i in 0..n {
            let scale = (a[i + n * i] * a[j + n * j]).abs().sqrt().max(f64::MIN_POSITIVE);
            worst = worst.max((a[i + n * j] - b(i, j)).abs() / scale);
        }
    }
    if worst <= TOLERANCE { Ok(()) } else { Err(worst) }
}

fn close(a: &[f64], b: &[f64]) -> Result<(), f64> {
    let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let worst = a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / largest;
    if worst <= TOLERANCE { Ok(()) } else { Err(worst) }
}

/// A displacement field with its gradient: value\[n\], gradient\[n\]\[m\] = ∂uₙ/∂xₘ.
type FieldAt = ([f64; 3], [[f64; 3]; 3]);

/// The unknowns of a cell that follow `field`.
fn interpolate(info: &ElementInfo, cell: &Cell<'_>, field: impl Fn([f64; 3]) -> FieldAt) -> Vec<f64> {
    let node = |at: &[f64; 3]| {
        let (value, gradient) = field(cell.position(*at));
        info.dofs.iter().map(move |d| if d.m() == 0 { value[d.n() - 1] } else { gradient[d.n() - 1][d.m() - 1] })
    };
    info.nodes.iter().flat_map(node).collect()
}

/// Displacements uₙ = xₘ are reproduced with the strains that the element does not give up for a stress: those across a solid in
/// the mean over its thickness, for its plies may share stresses instead.
fn linear_fields(element: &dyn Element, cell: &Cell<'_>) -> Result<(), String> {
    let info = element.info();
    let (section, shell) = (info.is_section(), info.is_shell());
    // Rows of the strain that the theory keeps, at every place and in the mean, and fields that it can express.
    let (rows, across): (&[usize], &[usize]) = match (section, shell) {
        (true, _) => (&[0], &[2, 5]),
        (_, true) => (&[0, 1, 3], &[]),
        _ => (&[0, 1, 3], &[2, 4, 5]),
    };
    let fits = |n: usize, m: usize| !(section && (n == 1 || m == 1)) && !(shell && (n == 2 || m == 2));
    let (mut b, mut shape) = (vec![0.0; 6 * info.ndof()], vec![0.0; 3 * info.ndof()]);
    let origin = cell.position(info.centre());
    for n in 0..3 {
        for m in 0..3 {
            if !fits(n, m) {
                continue;
            }
            let field = |x: [f64; 3]| {
                let (mut value, mut gradient) = ([0.0; 3], [[0.0; 3]; 3]);
                value[n] = x[m] - origin[m];
                gradient[n][m] = 1.0;
                (value, gradient)
            };
            let u = interpolate(info, cell, field);
            let sum = |operator: &[f64], rows: usize, row: usize| -> f64 {
                operator.chunks_exact(rows).zip(&u).map(|(c, u)| c[row] * u).sum()
            };
            let wanted = [[0, 3, 5], [3, 1, 4], [5, 4, 2]][n][m];
            let judge = |row: usize, got: f64| {
                let want = f64::from(u8::from(row == wanted));
                let why = || format!("u{} = x{}: strain component {row} is {got}, not {want}", n + 1, m + 1);
                if (got - want).abs() > 1e-7 { Err(why()) } else { Ok(()) }
            };
            let [r, s] = [0.37, if section { 0.0 } else { -0.62 }];
            let mut means = [0.0; 6];
            for (slice, Slice { q: [low, high], .. }) in cell.stack.slices.iter().enumerate() {
                for (t, w) in gauss_legendre(info.ply_order) {
                    let half = 0.5 * (high - low);
                    element.strain_operator(cell, slice, [r, s, 0.5 * (low + high) + half * t], &mut b);
                    across.iter().for_each(|row| means[*row] += 0.5 * half * w * sum(&b, 6, *row));
                }
                let xi = [r, s, 0.4 * low + 0.6 * high];
                element.strain_operator(cell, slice, xi, &mut b);
                element.shape(cell, xi, &mut shape);
                rows.iter().try_for_each(|row| judge(*row, sum(&b, 6, *row)))?;
                let (value, _) = field(cell.position(xi));
                let size = cell.half_height().max(extent(cell));
                if (0..3).any(|d| (sum(&shape, 3, d) - value[d]).abs() > 1e-9 * size) {
                    return Err(format!("u{} = x{} is not reproduced", n + 1, m + 1));
                }
            }
            across.iter().try_for_each(|row| judge(*row, means[*row]))?;
        }
    }
    Ok(())
}

/// A quadratic field that no symmetry favours, in the frame turned by `angle` and with lengths times `unit`.
fn wave(angle: f64, unit: f64) -> impl Fn([f64; 3]) -> FieldAt {
    let (s, c) = angle.sin_cos();
    let r = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
    let l = 2e-3;
    move |x| {
        // Back to the frame and unit of the field, its value and gradient there, and forth again.
        let p: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| r[j][i] * x[j]).sum::<f64>() / (unit * l));
        let a = [[0.3, -0.2, 0.5], [0.7, 0.1, -0.4], [-0.6, 0.8, 0.2]];
        let quadratic = |i: usize| 0.3 * p[i] * p[(i + 1) % 3] - 0.2 * p[i] * p[i];
        let value: [f64; 3] = std::array::from_fn(|i| l * ((0..3).map(|j| a[i][j] * p[j]).sum::<f64>() + quadratic(i)));
        let gradient: [[f64; 3]; 3] = std::array::from_fn(|i| {
            let mut row = a[i];
            row[i] += 0.3 * p[(i + 1) % 3] - 0.4 * p[i];
            row[(i + 1) % 3] += 0.3 * p[i];
            row
        });
        let turned = std::array::from_fn(|i| unit * (0..3).map(|j| r[i][j] * value[j]).sum::<f64>());
        let double = |i: usize, j: usize| -> f64 {
            (0..3).map(|k| (0..3).map(|l| r[i][k] * r[j][l] * gradient[k][l]).sum::<f64>()).sum()
        };
        (turned, std::array::from_fn(|i| std::array::from_fn(|j| double(i, j))))
    }
}

/// Energy of the field on the cell.
fn energy(element: &dyn Element, cell: &Cell<'_>, field: impl Fn([f64; 3]) -> FieldAt) -> Result<f64, String> {
    let found = Matrices::of(element, cell).map_err(|e| e.to_string())?;
    let (n, u) = (found.n, interpolate(element.info(), cell, field));
    Ok(0.5 * (0..n * n).map(|i| u[i % n] * found.k[i] * u[i / n]).sum::<f64>())
}

/// Neither the unit of length nor the axes nor the first corner matter.
fn frames(element: &dyn Element) -> Result<(), String> {
    let section = element.info().is_section();
    let corners = if section {
        [[0.0, 0.0], [2e-3, 0.0], [2e-3, 1e-3], [0.0, 1e-3]]
    } else {
        [[0.0, 0.0], [2e-3, 0.1e-3], [2.3e-3, 2.0e-3], [0.3e-3, 1.9e-3]]
    };
    let corners = part_of(element.info(), corners);
    let z = [-0.3e-3, 0.3e-3];
    let stack = Stack::new(vec![tape(20.0)]);
    let reference = energy(element, &Cell { corners: corners.into(), z, stack: &stack }, wave(0.0, 1.0))?;
    let agree = |what: &str, got: f64| match (got / reference - 1.0).abs() {
        error if error <= 1e-9 => Ok(()),
        error => Err(format!("{what} changes the energy by {error:.1e}")),
    };
    for unit in [1e-3, 1e3] {
        let scaled =
            Cell { corners: corners.map(|p| p.map(|p| unit * p)).into(), z: z.map(|z| unit * z), stack: &stack };
        agree("the unit of length", energy(element, &scaled, wave(0.0, unit))? / unit.powi(3))?;
    }
    if section {
        return Ok(());
    }
    for turn in 1..corners.len() {
        let mut corners = corners;
        corners.rotate_left(turn);
        agree(
            "the corner counted first",
            energy(element, &Cell { corners: corners.into(), z, stack: &stack }, wave(0.0, 1.0))?,
        )?;
    }
    for degrees in [90.0, 33.0] {
        let angle = f64::to_radians(degrees);
        let (s, c) = angle.sin_cos();
        let turned = Stack::new(vec![tape(20.0 + degrees)]);
        let corners = corners.map(|[x, y]| [c * x - s * y, s * x + c * y]);
        agree(
            "a turn of the axes",
            energy(element, &Cell { corners: corners.into(), z, stack: &turned }, wave(angle, 1.0))?,
        )?;
    }
    Ok(())
}

/// Cells that are none.
fn refusals(element: &dyn Element) -> Result<(), String> {
    let stack = Stack::new(vec![tape(0.0)]);
    let (good, z) = ([[0.0, 0.0], [1e-3, 0.0], [1e-3, 1e-3], [0.0, 1e-3]], [0.0, 1e-3]);
    let good = part_of(element.info(), good);
    let (mut folded, mut undefined) = (good, good);
    folded[1..].reverse();
    undefined[0][0] = f64::NAN;
    for (what, corners, z) in [("folded", folded, z), ("undefined", undefined, z), ("flat", good, [0.0, 0.0])] {
        if Matrices::of(element, &Cell { corners: corners.into(), z, stack: &stack }).is_ok() {
            return Err(format!("a cell that is {what} is not refused"));
        }
    }
    Ok(())
}
