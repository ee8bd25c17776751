//! Symmetries of a plate: its symmetric motions at the cost of a half or a quarter.
//!
//! The plate stays whole. Of the nodes and cells that a symmetry maps onto each other one represents all: the unknowns of
//! the others follow from its own ([`Symmetry::equations`]), and its matrix counts as often as there are such cells
//! ([`Symmetry::quads`]). K and M then are those of the whole plate, restricted to symmetric motions; forces, masses and
//! energies are those of the whole.

use crate::plates::constraint::Equation;
use crate::plates::error::{Asymmetry, PlateError};
use crate::plates::plate::Plate;
use crate::words::dof::Dof;
use crate::words::domain::Corners;
use crate::words::tensor::{Global, Matrix6, Stress6};
use std::collections::HashMap;

/// What maps a plate onto itself, about the middle of its bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SymmetryGroup {
    /// A turn by 180 degrees about z.
    HalfTurn,
    /// A mirror on a plane x = const.
    MirrorX,
    /// A mirror on a plane y = const.
    MirrorY,
    /// Both mirrors, and with them the half-turn.
    Quarter,
}

/// Couplings of a stiffness below this fraction of its largest entry are rounding.
const NO_COUPLING: f64 = 1e-9;

impl SymmetryGroup {
    /// All of them by name.
    pub const ALL: [(&'static str, Self); 4] = [
        ("half-turn", Self::HalfTurn),
        ("mirror-x", Self::MirrorX),
        ("mirror-y", Self::MirrorY),
        ("quarter", Self::Quarter),
    ];

    /// Its name.
    pub const fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }

    /// Its operations but for the one that changes nothing.
    pub const fn operations(self) -> &'static [Operation] {
        const TURN: Operation = Operation([-1.0, -1.0, 1.0]);
        const X: Operation = Operation([-1.0, 1.0, 1.0]);
        const Y: Operation = Operation([1.0, -1.0, 1.0]);
        match self {
            Self::HalfTurn => &[TURN],
            Self::MirrorX => &[X],
            Self::MirrorY => &[Y],
            Self::Quarter => &[X, Y, TURN],
        }
    }
}

/// (x, y, z) → (s₁ x, s₂ y, z), each sᵢ one of ±1, x and y counted from the middle of the plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operation([f64; 3]);

/// Axes of the six components of strain and stress.
const COMPONENTS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];

impl Operation {
    /// `Unm` at the image of a point over `Unm` at the point, in a symmetric motion: sₙ sₘ.
    pub fn sign(self, dof: Dof) -> f64 {
        let along = if dof.m() == 0 { 1.0 } else { self.0[dof.m() - 1] };
        self.0[dof.n() - 1] * along
    }

    /// Whether net motions along `axis` (0, 1, 2 = x, y, z) are symmetric.
    pub fn keeps_axis(self, axis: usize) -> bool {
        self.0[axis] > 0.0
    }

    fn component_sign(self, k: usize) -> f64 {
        let [i, j] = COMPONENTS[k];
        self.0[i] * self.0[j]
    }

    /// Whether a material of stiffness `c` (plate's axes) is its own image: no coupling between components that keep and
    /// components that change their sign.
    pub fn keeps_stiffness(self, c: &Matrix6) -> bool {
        let largest = c.iter().flatten().fold(0.0_f64, |m, c| m.max(c.abs()));
        let apart = |i: usize, j: usize| self.component_sign(i) != self.component_sign(j);
        (0..6).all(|i| (0..6).all(|j| !apart(i, j) || c[i][j].abs() <= NO_COUPLING * largest))
    }

    /// The stress at the image of a point.
    pub fn stress(self, stress: &Stress6<Global>) -> Stress6<Global> {
        Stress6::new(std::array::from_fn(|k| self.component_sign(k) * stress.0[k]))
    }

    fn point(self, centre: [f64; 2], p: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|d| centre[d] + self.0[d] * (p[d] - centre[d]))
    }
}

/// How a plate is folded onto a part of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Symmetry {
    group: Option<SymmetryGroup>,
    centre: [f64; 2],
    /// Nodes nearer to each other than this are one, m.
    reach: f64,
    /// Image of each column under each operation.
    images: Vec<(Operation, Vec<u32>)>,
    /// Of each column the one that represents it.
    columns: Vec<u32>,
    /// Of each quad the one that represents it.
    quads: Vec<u32>,
    /// Quads that represent, and how many.
    kept: Vec<(u32, u32)>,
}

impl Symmetry {
    /// None: every column and every quad represents itself.
    pub(crate) fn none(columns: usize, quads: usize) -> Self {
        Self {
            group: None,
            centre: [0.0; 2],
            reach: 0.0,
            images: Vec::new(),
            columns: (0..columns as u32).collect(),
            quads: (0..quads as u32).collect(),
            kept: (0..quads as u32).map(|q| (q, 1)).collect(),
        }
    }

    /// Of the part over `quads`, which represent all that they do in the whole, with so many columns.
    pub(crate) fn part(&self, columns: usize, quads: &[u32]) -> Self {
        let sizes: HashMap<u32, u32> = self.kept.iter().copied().collect();
        let kept = quads.iter().zip(0..).map(|(quad, own)| (own, sizes.get(quad).copied().unwrap_or(1)));
        Self { kept: kept.collect(), ..Self::none(columns, quads.len()) }
    }

    /// Folds `plate` by `group`.
    ///
    /// # Errors
    /// A node or a cell without an image.
    pub(crate) fn of(group: SymmetryGroup, plate: &Plate) -> Result<Self, PlateError> {
        let (low, high) = plate.plane.bounds();
        let centre = [0, 1].map(|d| 0.5 * (low[d] + high[d]));
        let reach = plate.plane.reach();
        let operations = || group.operations().iter().copied();
        let places = Places::of(plate, reach);
        let refused = |at: Asymmetry| PlateError::Asymmetric { symmetry: group.name(), centre, at };
        let images: Vec<_> =
            operations().map(|o| Ok((o, places.images(o, centre)?))).collect::<Result<_, _>>().map_err(refused)?;
        let cells = images.iter().map(|(_, images)| quad_images(plate, images));
        let cells: Vec<_> = cells.collect::<Result<_, _>>().map_err(refused)?;

        // The part that is kept lies at large y, and at large x: as compact as it can be.
        let rank = |p: [f64; 2]| [1, 0].map(|d| ((p[d] - centre[d]) / reach).round() as i64);
        let column_ranks: Vec<_> = plate.columns.iter().map(|p| rank(*p)).collect();
        let quad_ranks: Vec<_> =
            (0..plate.plane.quads.len()).map(|q| rank(plate.plane.corners(q).centroid())).collect();
        let columns = representatives(&column_ranks, images.iter().map(|(_, i)| &i[..]));
        let quads = representatives(&quad_ranks, cells.iter().map(|i| &i[..]));
        let mut sizes = vec![0; quads.len()];
        quads.iter().for_each(|q| sizes[*q as usize] += 1);
        let kept = sizes.into_iter().enumerate().filter(|(_, size)| *size > 0).map(|(q, size)| (q as u32, size));
        Ok(Self { group: Some(group), centre, reach, images, columns, kept: kept.collect(), quads })
    }

    /// Name of the symmetry, if there is one.
    pub fn name(&self) -> Option<&'static str> {
        self.group.map(SymmetryGroup::name)
    }

    /// Its operations but for the one that changes nothing.
    pub fn operations(&self) -> impl Iterator<Item = Operation> {
        self.images.iter().map(|(o, _)| *o)
    }

    /// The column that represents `column`.
    pub fn column(&self, column: u32) -> u32 {
        self.columns[column as usize]
    }

    /// The quad that represents `quad`.
    pub fn quad(&self, quad: usize) -> usize {
        self.quads[quad] as usize
    }

    /// The operation that makes `quad` of the one that represents it; `None` where that is itself.
    pub fn operation(&self, plate: &Plate, quad: usize) -> Option<Operation> {
        let kept = self.quad(quad);
        let [from, to] = [kept, quad].map(|quad| plate.plane.corners(quad).centroid());
        let there = |o: &Operation| {
            let [x, y] = o.point(self.centre, from);
            (x - to[0]).hypot(y - to[1]) <= self.reach
        };
        if kept == quad { None } else { self.operations().find(there) }
    }

    /// Where the point `p` of the quad that represents `quad` lies in `quad`.
    pub fn image(&self, plate: &Plate, quad: usize, p: [f64; 2]) -> [f64; 2] {
        self.operation(plate, quad).map_or(p, |o| o.point(self.centre, p))
    }

    /// Quads that represent others or themselves alone, ascending, and how many they stand for.
    pub fn quads(&self) -> impl ExactSizeIterator<Item = (usize, f64)> + Clone {
        self.kept.iter().map(|(quad, size)| (*quad as usize, f64::from(*size)))
    }

    /// Whether no other column stands for this one.
    pub(crate) fn represents_itself(&self, column: usize) -> bool {
        self.columns[column] as usize == column
    }

    /// Whether every operation leaves the point where it is.
    pub fn keeps(&self, point: [f64; 2]) -> bool {
        self.operations().all(|o| {
            let [x, y] = o.point(self.centre, point);
            (x - point[0]).hypot(y - point[1]) <= self.reach
        })
    }

    /// The images of an unknown, with the factors that make them of its value.
    pub fn images(&self, plate: &Plate, dof: usize) -> impl Iterator<Item = (usize, f64)> {
        let (column, _, name) = plate.locate(dof);
        let at = |column: usize| plate.dofs_of_column(column).start;
        self.images.iter().map(move |(o, images)| (at(images[column] as usize) + dof - at(column), o.sign(name)))
    }

    /// What makes a motion symmetric: the unknowns of every column by those of the one that represents it, and zero what
    /// changes its sign in a column that is its own image.
    pub fn equations(&self, plate: &Plate) -> Vec<Equation> {
        let Some(name) = self.name() else { return Vec::new() };
        let origin = || format!("the symmetry `{name}`");
        let mut equations = Vec::new();
        for column in 0..plate.columns.len() {
            let keeper = self.columns[column] as usize;
            let (own, other) = (plate.dofs_of_column(column), plate.dofs_of_column(keeper));
            let from_keeper = self.images.iter().filter(|(_, images)| images[keeper] as usize == column);
            if keeper == column {
                let odd = |dof: &usize| from_keeper.clone().any(|(o, _)| o.sign(plate.locate(*dof).2) < 0.0);
                equations.extend(own.filter(odd).map(|dof| Equation::fix(dof, origin())));
            } else if let Some((o, _)) = from_keeper.clone().next() {
                equations.extend(own.zip(other).map(|(dof, kept)| Equation {
                    terms: vec![(dof, 1.0), (kept, -o.sign(plate.locate(dof).2))],
                    value: 0.0,
                    origin: origin(),
                    holds: true,
                }));
            }
        }
        equations
    }
}

/// Of each thing, of rank `ranks`, the one of highest rank among itself and its images, the first of equals.
fn representatives<'a>(ranks: &[[i64; 2]], images: impl Iterator<Item = &'a [u32]> + Clone) -> Vec<u32> {
    let orbit = |i: u32| std::iter::once(i).chain(images.clone().map(move |images| images[i as usize]));
    let best = |i: u32| orbit(i).max_by_key(|k| (ranks[*k as usize], std::cmp::Reverse(*k))).unwrap_or(i);
    (0..ranks.len() as u32).map(best).collect()
}

/// The columns of a plate by where they are.
struct Places<'a> {
    plate: &'a Plate,
    reach: f64,
    bins: HashMap<[i64; 2], u32>,
}

impl<'a> Places<'a> {
    fn of(plate: &'a Plate, reach: f64) -> Self {
        let mut places = Self { plate, reach, bins: HashMap::new() };
        places.bins = (0..plate.columns.len()).map(|c| (places.bin(plate.columns[c]), c as u32)).collect();
        places
    }

    fn bin(&self, p: [f64; 2]) -> [i64; 2] {
        p.map(|x| (0.25 * x / self.reach).floor() as i64)
    }

    fn at(&self, p: [f64; 2]) -> Option<u32> {
        let [i, j] = self.bin(p);
        let bins = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
        let near = |c: &u32| {
            let q = self.plate.columns[*c as usize];
            (q[0] - p[0]).hypot(q[1] - p[1]) <= self.reach
        };
        bins.filter_map(|bin| self.bins.get(&bin).copied()).find(near)
    }

    /// Image of each column with unknowns; the others, where nothing is their image, are their own.
    fn images(&self, operation: Operation, centre: [f64; 2]) -> Result<Vec<u32>, Asymmetry> {
        let plate = self.plate;
        let (name, at) = (|c: usize| plate.describe_column(c), |c: usize| plate.columns[c]);
        let unknowns = |c: usize| plate.dofs_of_column(c).len();
        let image = |c: usize| match self.at(operation.point(centre, plate.columns[c])) {
            Some(image) if unknowns(image as usize) == unknowns(c) => Ok(image),
            Some(image) => {
                let (image, image_at) = (name(image as usize), at(image as usize));
                Err(Asymmetry::Unknowns { image, image_at, name: name(c), at: at(c) })
            }
            None if unknowns(c) == 0 => Ok(c as u32),
            None => Err(Asymmetry::Node { name: name(c), at: at(c) }),
        };
        (0..plate.columns.len()).map(image).collect()
    }
}

/// Image of each quad, by those of its columns.
fn quad_images(plate: &Plate, images: &[u32]) -> Result<Vec<u32>, Asymmetry> {
    let quads = &plate.plane.quads;
    let sorted = |mut vertices: Corners<u32>| {
        vertices.sort_unstable();
        vertices
    };
    let numbers: HashMap<Corners<u32>, u32> = quads.iter().map(|q| sorted(*q)).zip(0..).collect();
    let image = |(quad, vertices): (usize, &Corners<u32>)| {
        let found = numbers.get(&sorted(vertices.map(|v| images[v as usize]))).copied();
        found.filter(|image| plate.region(*image as usize) == plate.region(quad)).ok_or_else(|| {
            let at = plate.plane.corners(quad).centroid();
            Asymmetry::Cell { quad_tag: plate.plane.quad_tags[quad], at }
        })
    };
    quads.iter().enumerate().map(image).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::contracts::element::{ElementInfo, Slice, Stack};
    use crate::plates::mesh::PlaneMesh;
    use crate::plates::plate::ZDerivatives;
    use crate::words::domain::Domain;
    use crate::words::material::Elastic;
    use crate::words::tensor::rotate_stiffness;

    const NODES: [[f64; 3]; 8] = [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ];
    const INFO: ElementInfo = ElementInfo {
        domain: Domain::Quadrilateral,
        nodes: &NODES,
        dofs: &Dof::SOLID,
        in_plane_order: 2,
        ply_order: 2,
    };

    fn tape(angle: f64) -> Matrix6 {
        let tape = Elastic::transversely_isotropic(130e9, 9.6e9, 0.35, 0.4, 5.9e9);
        rotate_stiffness(&tape.stiffness(), angle.to_radians())
    }

    /// A plate from (1, 2) to (7, 6) in two layers, its nodes, cells and corners counted in a disorder of their own.
    fn plate(cells: [usize; 2], disorder: usize) -> Plate {
        let lines = |n: usize, low: f64, high: f64| -> Vec<f64> {
            (0..=n).map(|i| low + (high - low) * i as f64 / n as f64).collect()
        };
        let mesh = PlaneMesh::rectangle(&lines(cells[0], 1.0, 7.0), &lines(cells[1], 2.0, 6.0));
        let shuffled = |n: usize| -> Vec<usize> {
            let mut all: Vec<usize> = (0..n).collect();
            all.sort_by_key(|i| (i * 7919 * disorder) % 1009);
            all
        };
        let nodes = shuffled(mesh.points.len());
        let number = |old: u32| nodes.iter().position(|n| *n == old as usize).unwrap() as u32;
        let mut other = mesh.clone();
        other.points = nodes.iter().map(|n| mesh.points[*n]).collect();
        other.quads = shuffled(mesh.quads.len()).iter().map(|q| mesh.quads[*q].map(number)).collect();
        other.quads.iter_mut().enumerate().for_each(|(i, quad)| quad.rotate_left(i * disorder % 4));
        let stack = || Stack::new(vec![Slice { q: [-1.0, 1.0], c: tape(0.0), density: 1.0, free: [0.0; 6] }]);
        Plate::new(other, vec![-1.0, 0.0, 1.0], vec![stack(), stack()], INFO, ZDerivatives::LayerWise).unwrap()
    }

    /// Unknowns of a motion that is its own image under all operations of `group`, and of one that is not.
    fn motion(plate: &Plate, group: SymmetryGroup, symmetric: bool) -> Vec<f64> {
        // Monomials xᵃ yᵇ z of each displacement; those whose sign an operation changes are left out.
        let value = |dof: usize| {
            let (column, level, name) = plate.locate(dof);
            let [x, y] = [plate.columns[column][0] - 4.0, plate.columns[column][1] - 4.0];
            let z = plate.levels[level] + 0.3;
            let mut sum = 0.0;
            for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
                let sign = |o: &Operation| o.0[name.n() - 1] * o.0[0].powi(a) * o.0[1].powi(b);
                if symmetric && group.operations().iter().any(|o| sign(o) < 0.0) {
                    continue;
                }
                let power = |x: f64, n: i32| if n < 0 { 0.0 } else { x.powi(n) };
                sum += f64::from(1 + a + 3 * b)
                    * match name.m() {
                        1 => f64::from(a) * power(x, a - 1) * y.powi(b) * z,
                        2 => f64::from(b) * x.powi(a) * power(y, b - 1) * z,
                        3 => x.powi(a) * y.powi(b),
                        _ => x.powi(a) * y.powi(b) * z,
                    };
            }
            sum
        };
        (0..plate.ndof()).map(value).collect()
    }

    #[test]
    fn equations_hold_for_symmetric_motions_in_any_numbering() {
        for (name, group) in SymmetryGroup::ALL {
            for cells in [[4, 4], [5, 3], [4, 3]] {
                let mut free = Vec::new();
                for disorder in [0, 1, 5] {
                    let mut plate = plate(cells, disorder);
                    plate.fold(group).unwrap();
                    let equations = plate.symmetry().equations(&plate);
                    let worst = |u: &[f64]| {
                        let rest = |e: &Equation| e.terms.iter().map(|(d, c)| c * u[*d]).sum::<f64>().abs();
                        equations.iter().map(rest).fold(0.0, f64::max)
                    };
                    let (own, other) = (motion(&plate, group, true), motion(&plate, group, false));
                    let largest = own.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
                    assert!(worst(&own) < 1e-12 * largest, "{name} {cells:?} {disorder}: {:e}", worst(&own));
                    assert!(worst(&other) > 1e-3 * largest, "{name} {cells:?} {disorder}");
                    let represented: f64 = plate.symmetry().quads().map(|(_, weight)| weight).sum();
                    assert_eq!(represented as usize, cells[0] * cells[1]);
                    assert_eq!(plate.kept_cells().count(), 2 * plate.symmetry().quads().len());
                    free.push(plate.ndof() - equations.len());
                }
                assert!(free.iter().all(|n| *n == free[0]), "{name} {cells:?}: {free:?}");
            }
        }
        // Of a quarter of 4 x 4 cells 3 x 3 columns; the inner ones have all unknowns, those on the planes fewer.
        let mut quarter = plate([4, 4], 5);
        quarter.fold(SymmetryGroup::Quarter).unwrap();
        assert_eq!(quarter.symmetry().quads().map(|(_, weight)| weight).collect::<Vec<_>>(), [4.0; 4]);
    }

    #[test]
    fn what_has_no_image_is_named() {
        let mut mesh = plate([4, 4], 0).plane;
        mesh.points[6][0] += 1e-3;
        mesh.node_tags[6] = 4711;
        let stack = Stack::new(vec![Slice { q: [-1.0, 1.0], c: tape(0.0), density: 1.0, free: [0.0; 6] }]);
        let fold = |mesh: &PlaneMesh, group| {
            Plate::new(mesh.clone(), vec![0.0, 1.0], vec![stack.clone()], INFO, ZDerivatives::Shared)
                .unwrap()
                .fold(group)
        };
        let why = fold(&mesh, SymmetryGroup::HalfTurn).unwrap_err().to_string();
        assert!(why.contains("node 4711 at (2501.000000, 3000.000000) mm has no image"), "{why}");
        mesh.points[6][0] -= 1e-3;
        fold(&mesh, SymmetryGroup::Quarter).unwrap();
        // A hole on one side.
        mesh.quads.swap_remove(5);
        mesh.quad_tags.swap_remove(5);
        let why = fold(&mesh, SymmetryGroup::MirrorY).unwrap_err().to_string();
        assert!(why.contains("cell 10 at (3250.000000, 4500.000000) mm has no image"), "{why}");
    }

    #[test]
    fn mirrors_need_plies_along_the_axes_and_half_turns_do_not() {
        let keeps = |group: SymmetryGroup, c: &Matrix6| group.operations().iter().all(|o| o.keeps_stiffness(c));
        for angle in [0.0, 90.0, -90.0, 180.0] {
            assert!(SymmetryGroup::ALL.iter().all(|(_, group)| keeps(*group, &tape(angle))), "{angle}");
        }
        for angle in [45.0, 0.001, 89.9] {
            assert!(
                keeps(SymmetryGroup::HalfTurn, &tape(angle)) && !keeps(SymmetryGroup::MirrorX, &tape(angle)),
                "{angle}"
            );
            assert!(
                !keeps(SymmetryGroup::MirrorY, &tape(angle)) && !keeps(SymmetryGroup::Quarter, &tape(angle)),
                "{angle}"
            );
        }
    }
}
