//! A plate's K and M in the hands of faer: its sparse LU and Cholesky for a load at rest, its Arnoldi iteration for the lowest
//! frequency, each beside what `fem` finds. `cargo run --release --example faer`
#![allow(clippy::print_stdout, reason = "a program prints")]

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::solvers::Solve;
use faer::matrix_free::LinOp;
use faer::matrix_free::eigen::{partial_eigen, partial_eigen_scratch};
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, linalg::matmul::sparse_dense_matmul};
use faer::{Accum, Col, ColRef, Mat, MatMut, MatRef, Par, Side, c64};
use fem::analyses::{assembled, modes};
use fem::core::structure::Structure;
use fem::{Model, Registry, io::scene};
use std::error::Error;
use std::f64::consts::TAU;
use std::num::NonZeroUsize;

const PLATE: &str = "
title = 'simply supported square'
analysis = 'modes'
mesh = { rectangle = ['100 mm', '100 mm'], cells = [6, 6] }
materials.tape = { library = 'AS4/3502' }
laminate = { plies = '[0/90]s', material = 'tape', ply_thickness = '0.25 mm', layers = [2, 2] }
support = [
    { group = 'x-min', at = 'all', fix = ['U20', 'U30'] },
    { group = 'x-max', at = 'all', fix = ['U20', 'U30'] },
    { group = 'y-min', at = 'all', fix = ['U10', 'U30'] },
    { group = 'y-max', at = 'all', fix = ['U10', 'U30'] },
]
";

/// A number that faer found, and the same by `fem`.
struct Pair {
    name: &'static str,
    faer: f64,
    fem: f64,
}

/// `y ← K⁻¹ M x`, whose largest eigenvalue is 1/ω² of the lowest frequency.
#[derive(Debug)]
struct Flexibility {
    stiffness: Llt<usize, f64>,
    mass: SparseColMat<usize, f64>,
}

impl LinOp<f64> for Flexibility {
    fn apply_scratch(&self, _: usize, _: Par) -> StackReq {
        StackReq::EMPTY
    }

    fn nrows(&self) -> usize {
        self.mass.nrows()
    }

    fn ncols(&self) -> usize {
        self.mass.ncols()
    }

    fn apply(&self, mut out: MatMut<'_, f64>, x: MatRef<'_, f64>, par: Par, _: &mut MemStack) {
        sparse_dense_matmul(out.as_mut(), Accum::Replace, self.mass.as_ref(), x, 1.0, par);
        self.stiffness.solve_in_place(out);
    }

    fn conj_apply(&self, out: MatMut<'_, f64>, x: MatRef<'_, f64>, par: Par, stack: &mut MemStack) {
        self.apply(out, x, par, stack);
    }
}

// ANCHOR: compare
fn compare() -> Result<Vec<Pair>, Box<dyn Error>> {
    let model = Model::new(scene::parse(PLATE, "plate.toml".as_ref())?, &Registry::standard())?;
    let one = NonZeroUsize::MIN;
    let mut structure = assembled::structure(&model, true, one, &mut Default::default())?.structure;
    let n = structure.ndof();

    // What a load of 1 N on every unknown does.
    let mut fem = vec![1.0; n];
    structure.solve_shifted(0.0, &mut fem, 1)?;
    let work: f64 = fem.iter().sum();

    // `lower` is faer's view of what `fem` holds; LU wants both triangles.
    let (k, m) = structure.matrices();
    let load = Col::<f64>::ones(n);
    let by_lu = k.full()?.sp_lu()?.solve(&load);
    let stiffness = k.lower().sp_cholesky(Side::Lower)?;
    let by_cholesky = stiffness.solve(&load);

    let flexibility = Flexibility { stiffness, mass: m.full()? };
    let (mut shape, mut found) = (Mat::<c64>::zeros(n, 1), [c64::new(0.0, 0.0)]);
    let size = partial_eigen_scratch(&flexibility, 1, Par::Seq, Default::default());
    let mut memory = MemBuffer::new(size);
    let stack = MemStack::new(&mut memory);
    let start = ColRef::from_slice(&fem) * faer::Scale(1.0 / ColRef::from_slice(&fem).norm_l2());
    partial_eigen(shape.as_mut(), &mut found, &flexibility, start.as_ref(), 1e-12, Par::Seq, stack, Default::default());

    let lowest = modes::solve(&model, 1, one)?.modes.omega[0];
    Ok(vec![
        Pair { name: "work of the load by LU, J", faer: by_lu.sum(), fem: work },
        Pair { name: "work of the load by Cholesky, J", faer: by_cholesky.sum(), fem: work },
        Pair { name: "lowest frequency, Hz", faer: found[0].re.sqrt().recip() / TAU, fem: lowest / TAU },
    ])
}
// ANCHOR_END: compare

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:<32} {:>16} {:>16}", "", "faer", "fem");
    for Pair { name, faer, fem } in compare()? {
        println!("{name:<32} {faer:>16.9e} {fem:>16.9e}");
        if !((faer / fem - 1.0).abs() < 1e-8) {
            return Err(format!("{name}: {faer} by faer, {fem} by fem").into());
        }
    }
    Ok(())
}

#[test]
fn faer_and_fem_agree() {
    assert_eq!(main().map_err(|error| error.to_string()), Ok(()));
}
