//! The estimated error of a mesh against the difference from a much finer one.

use super::scene::{AS4, Cells, PAGANO, Plate, QUARTER, Side, gmsh_cells};
use crate::support::{fem, root};
use fem::analyses::statics;
use fem::core::element::form;
use fem::core::estimate::mesh_errors;
use fem::core::quadrature::gauss_legendre;
use fem::io::scene;
use fem::{Model, Registry};
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::ops::Range;

/// A model under loads at rest and its displacements.
struct Solved {
    model: Model,
    u: Vec<f64>,
}

impl Solved {
    fn of(model: Model) -> Self {
        let u = statics::solve(&model, NonZeroUsize::MIN).unwrap().u;
        Self { model, u }
    }

    fn estimate(&self) -> f64 {
        mesh_errors(&self.model.plate, &*self.model.element, &self.model.constraints, &self.u).unwrap().unwrap()[0]
    }

    /// Strain in a ply of a cell.
    fn strain(&self, cell: usize, slice: usize, xi: [f64; 3]) -> ([f64; 6], f64) {
        let domain = self.model.plate.cell(cell).corners.domain();
        let (element, mut dofs) = (form(&*self.model.element, domain), Vec::new());
        let mut b = vec![0.0; 6 * element.info().ndof()];
        let jacobian = element.strain_operator(&self.model.plate.cell(cell), slice, xi, &mut b);
        self.model.plate.cell_dofs(cell, &mut dofs);
        let mut strain = [0.0; 6];
        for (dof, column) in dofs.iter().zip(b.chunks_exact(6)) {
            strain.iter_mut().zip(column).for_each(|(e, b)| *e += b * self.u[*dof]);
        }
        (strain, jacobian)
    }

    /// Energy norm of the difference from a solution on a finer mesh, over its own; cell for cell of this mesh 4^`times` of
    /// that one.
    fn distance(&self, fine: &Self, times: usize) -> f64 {
        let plate = &self.model.plate;
        // A built-in square of cells row by row, or a file whose cells are divided.
        let nx = plate.plane.quads.len().isqrt();
        let parent = |quad: usize| match &self.model.origin.mesh {
            None => ((quad / (nx << times)) >> times) * nx + ((quad % (nx << times)) >> times),
            Some(_) => quad >> (2 * times),
        };
        let (mut all, mut between) = (0.0, 0.0);
        for cell in 0..fine.model.plate.cells() {
            let (quad, layer) = fine.model.plate.place(cell);
            let coarse = parent(quad);
            for point in fine.model.plate.plane.quads[quad].domain().points(3) {
                let ([r, s], [wr, ws]) = (point.at, point.factors);
                let [x, y, _] = fine.model.plate.cell(cell).position([r, s, 0.0]);
                let [cr, cs] = plate.plane.corners(coarse).locate([x, y]).unwrap();
                for (number, slice) in plate.stacks(0)[layer].slices.iter().enumerate() {
                    let (middle, half) = (0.5 * (slice.q[0] + slice.q[1]), 0.5 * (slice.q[1] - slice.q[0]));
                    for &(t, wt) in gauss_legendre(if half < 0.2 { 1 } else { 2 }) {
                        let q = middle + half * t;
                        let (strain, jacobian) = fine.strain(cell, number, [r, s, q]);
                        let (own, _) = self.strain(coarse * plate.layers() + layer, number, [cr, cs, q]);
                        let difference = std::array::from_fn(|c| strain[c] - own[c]);
                        let energy = |e: &[f64; 6]| -> f64 {
                            let row = |row: &[f64; 6]| row.iter().zip(e).map(|(c, e)| c * e).sum::<f64>();
                            slice.c.iter().zip(e).map(|(c, e)| e * row(c)).sum()
                        };
                        let dv = jacobian * wr * ws * wt * half;
                        all += dv * energy(&strain);
                        between += dv * energy(&difference);
                    }
                }
            }
        }
        (between / all).sqrt()
    }
}

fn pagano(element: &str, layers: Vec<usize>, cells: usize) -> Solved {
    let wave = PI / 10.0;
    let plate = Plate::new(PAGANO, "[0/90/0]", 1.0 / 3.0, layers).rectangle([5.0; 2], [cells; 2]).element(element);
    Solved::of(plate.pressure(&format!("-sin({wave}*x)*sin({wave}*y)")).sides(QUARTER).model("static"))
}

const SOLIDS: [&str; 2] = ["z_derivatives = 'layer-wise'", "kind = 'hex20'"];
const SHELL: &str = "kind = 'mitc4'";

/// Estimate over error on meshes that deserve the name; four cells are too few to see a curve by.
const HONEST: Range<f64> = 0.8..1.35;
const FOUR_CELLS: Range<f64> = 0.6..1.1;

#[track_caller]
fn honest(range: &Range<f64>, coarse: &Solved, fine: &Solved, times: usize, what: &str) {
    let (estimate, error) = (coarse.estimate(), coarse.distance(fine, times));
    assert!(range.contains(&(estimate / error)), "{what}: estimate {estimate}, error {error}: {}", estimate / error);
}

#[test]
fn the_error_of_pagano_s_plate() {
    for element in [SOLIDS[0], SOLIDS[1], SHELL] {
        let layers = if element == SHELL { vec![3] } else { vec![1; 3] };
        let [a, b, c, d] = [2, 4, 8, 16].map(|cells| pagano(element, layers.clone(), cells));
        honest(&FOUR_CELLS, &a, &d, 3, element);
        honest(&HONEST, &b, &d, 2, element);
        honest(&HONEST, &c, &d, 1, element);
    }
}

/// On irregular cells a cubic sees a little less.
const OF_TRIANGLES: Range<f64> = 0.75..1.1;

#[test]
fn the_error_of_triangles_and_of_mixed_cells() {
    let wave = PI / 10.0;
    let lines: Vec<f64> = (0..=4).map(|i| 5.0 * f64::from(i) / 4.0).collect();
    for cells in [Cells::Triangles, Cells::Mixed] {
        let file = gmsh_cells(&lines, &lines, 0.1, cells);
        let [coarse, fine] = [0, 2].map(|refine| {
            let mut plate = Plate::new(PAGANO, "[0/90/0]", 1.0 / 3.0, vec![1; 3]).on(&file).element(SOLIDS[0]);
            plate.mesh = plate.mesh.replace(" }", &format!(", refine = {refine} }}"));
            Solved::of(plate.pressure(&format!("-sin({wave}*x)*sin({wave}*y)")).sides(QUARTER).model("static"))
        });
        honest(&OF_TRIANGLES, &coarse, &fine, 2, &format!("{cells:?}"));
    }
}

/// The first example under a load at rest, its boundary a polygon on all meshes.
fn ring(element: &str, layers: &str, refine: usize, symmetry: &str) -> Solved {
    let text = format!(
        "title = 't'\nanalysis = 'static'\nelement = {{ {element} }}\n{symmetry}\n\
         mesh = {{ file = 'plate.msh', unit = 'mm', refine = {refine}, curves = 'straight' }}\nmaterials.m = {{ library = 'AS4/3502' }}\n\
         laminate = {{ plies = '[0/45/-45/90]2s', material = 'm', ply_thickness = '0.13208 mm', layers = {layers} }}\n\
         support = [{{ group = 'support', at = 'mid-plane', fix = ['U30'] }}, {{ restrain = 'rigid-motions' }}]\n\
         load = [{{ force = '1 kN', at = {{ group = 'impact' }}, patch_radius = '3 mm' }}]\n"
    );
    let path = root().join("examples/as4-3502-16ply-50mm/scene.toml");
    Solved::of(Model::new(scene::parse(&text, &path).unwrap(), &Registry::standard()).unwrap())
}

#[test]
fn the_error_of_a_plate_on_a_ring_under_a_patch() {
    for element in [SOLIDS[0], SOLIDS[1], SHELL] {
        let layers = if element == SHELL { "1" } else { "[8, 8]" };
        let [coarse, fine] = [0, 1].map(|n| ring(element, layers, n, "symmetry = 'half-turn'"));
        // The finer mesh is not much finer: the distance from it is a little less than the error.
        honest(&HONEST, &coarse, &fine, 1, element);
        let (folded, whole) = (coarse.estimate(), ring(element, layers, 0, "").estimate());
        assert!((folded / whole - 1.0).abs() < 1e-8, "{element}: {folded} {whole}");
    }
}

#[test]
fn nothing_is_said_where_a_plate_is_one_cell_wide() {
    let strip = |element: &str, cells: [usize; 2]| {
        let sides = [Side::Clamped, Side::Free, Side::Free, Side::Free];
        let plate =
            Plate::new(AS4, "[0/90]s", 0.25, vec![2, 2]).rectangle([20.0, 5.0], cells).element(element).sides(sides);
        let solved = Solved::of(plate.load("pressure = '1 MPa'").model("static"));
        mesh_errors(&solved.model.plate, &*solved.model.element, &solved.model.constraints, &solved.u)
            .unwrap()
            .map(|errors| errors[0])
    };
    assert_eq!(strip(SOLIDS[0], [8, 1]), None);
    assert_eq!(strip("kind = 'webster-beam'", [8, 1]), None);
    assert!(strip(SOLIDS[0], [8, 2]).is_some_and(|error| error > 1e-3 && error < 0.3));
}

#[test]
fn an_example_says_what_the_book_quotes() {
    let folder = tempfile::tempdir().unwrap();
    let scene = root().join("examples/pagano-0-90-0/scene.toml");
    let done = fem(folder.path(), &["run", scene.to_str().unwrap(), "--out", "out"]).good();
    assert!(done.stdout.contains("; mesh about 0.24 % in the energy norm"), "{}", done.stdout);
    let summary: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("out/summary.json")).unwrap()).unwrap();
    let error = summary["mesh_error_relative"].as_f64().unwrap();
    assert!((error - 0.0024).abs() < 5e-5, "{error}");
    let book = std::fs::read_to_string(root().join("docs/book/src/meshes.md")).unwrap();
    assert!(book.contains("0.24 % for `examples/pagano-0-90-0`"), "{book}");
}
