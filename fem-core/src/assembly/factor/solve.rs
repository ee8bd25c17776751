//! Forward and backward substitution, front by front.

use super::analysis::{Front, Tree};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};
use pulp::{Arch, Simd, WithSimd};

/// Columns that the substitution of one right-hand side takes from a panel at a time.
const WIDTH: usize = 4;

/// Fewer right-hand sides than this go through the panels one after the other.
pub(super) const FEW: usize = 4;

/// Right-hand sides that go through the panels together.
pub(super) const BLOCK: usize = 64;

/// `x ← A⁻¹ x`; `local` is room for the largest front.
pub(super) fn single(tree: &Tree, panels: &[f64], x: &mut [f64], local: &mut Vec<f64>) {
    Arch::new().dispatch(Substitution { tree, panels, x, local });
}

struct Substitution<'a> {
    tree: &'a Tree,
    panels: &'a [f64],
    x: &'a mut [f64],
    local: &'a mut Vec<f64>,
}

impl WithSimd for Substitution<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { tree, panels, x, local } = self;
        substitute(tree, panels, x, local);
    }
}

#[inline(always)]
fn substitute(tree: &Tree, panels: &[f64], x: &mut [f64], local: &mut Vec<f64>) {
    for front in &tree.fronts {
        let (unknowns, pivots) = (tree.unknowns(front), front.pivots);
        local.clear();
        local.extend(unknowns[..pivots].iter().map(|u| x[*u as usize]));
        local.resize(unknowns.len(), 0.0);
        forward(panel(front, panels), local, pivots);
        for (u, y) in unknowns[..pivots].iter().zip(&*local) {
            x[*u as usize] = *y;
        }
        for (u, y) in unknowns[pivots..].iter().zip(&local[pivots..]) {
            x[*u as usize] += y;
        }
    }
    for front in tree.fronts.iter().rev() {
        let (unknowns, pivots) = (tree.unknowns(front), front.pivots);
        local.clear();
        local.extend(unknowns.iter().map(|u| x[*u as usize]));
        backward(panel(front, panels), local, pivots);
        for (u, y) in unknowns[..pivots].iter().zip(&*local) {
            x[*u as usize] = *y;
        }
    }
}

fn panel<'a>(front: &Front, panels: &'a [f64]) -> &'a [f64] {
    &panels[front.panel..front.panel + front.size() * front.pivots]
}

/// `y₁ ← L₁₁⁻¹ y₁`, `y₂ ← y₂ − L₂₁ y₁` for the panel of L₁₁ over L₂₁.
#[inline(always)]
fn forward(panel: &[f64], y: &mut [f64], pivots: usize) {
    let size = y.len();
    let mut j = 0;
    while j + WIDTH <= pivots {
        let columns: [&[f64]; WIDTH] = std::array::from_fn(|k| &panel[(j + k) * size + j..(j + k + 1) * size]);
        let (head, tail) = y[j..].split_at_mut(WIDTH);
        for k in 0..WIDTH {
            head[k] /= columns[k][k];
            for i in k + 1..WIDTH {
                head[i] -= columns[k][i] * head[k];
            }
        }
        let [a, b, c, d] = columns.map(|c| &c[WIDTH..]);
        let below = a.iter().zip(b).zip(c).zip(d);
        for (y, (((a, b), c), d)) in tail.iter_mut().zip(below) {
            *y -= (a * head[0] + b * head[1]) + (c * head[2] + d * head[3]);
        }
        j += WIDTH;
    }
    for j in j..pivots {
        let column = &panel[j * size + j..(j + 1) * size];
        let (head, tail) = y[j..].split_at_mut(1);
        head[0] /= column[0];
        for (y, a) in tail.iter_mut().zip(&column[1..]) {
            *y -= a * head[0];
        }
    }
}

/// `y₁ ← L₁₁⁻ᵀ (y₁ − L₂₁ᵀ y₂)`.
#[inline(always)]
fn backward(panel: &[f64], y: &mut [f64], pivots: usize) {
    let size = y.len();
    let whole = pivots - pivots % WIDTH;
    for j in (whole..pivots).rev() {
        let column = &panel[j * size + j..(j + 1) * size];
        let [sum] = dots([&column[1..]], &y[j + 1..]);
        y[j] = (y[j] - sum) / column[0];
    }
    for j in (0..whole).step_by(WIDTH).rev() {
        let columns: [&[f64]; WIDTH] = std::array::from_fn(|k| &panel[(j + k) * size + j..(j + k + 1) * size]);
        let (head, tail) = y[j..].split_at_mut(WIDTH);
        let sums = dots(columns.map(|c| &c[WIDTH..]), tail);
        for k in (0..WIDTH).rev() {
            head[k] -= sums[k];
            for i in k + 1..WIDTH {
                head[k] -= columns[k][i] * head[i];
            }
            head[k] /= columns[k][k];
        }
    }
}

/// Products of `columns` with `y`, each summed in four lanes that a vector register holds.
#[inline(always)]
fn dots<const N: usize>(columns: [&[f64]; N], y: &[f64]) -> [f64; N] {
    const LANES: usize = 4;
    let mut sums = [[0.0; LANES]; N];
    let whole = y.len() - y.len() % LANES;
    let mut chunks = columns.map(|c| c[..whole].chunks_exact(LANES));
    for y in y.chunks_exact(LANES) {
        for (sum, chunk) in sums.iter_mut().zip(&mut chunks) {
            let Some(a) = chunk.next() else { continue };
            for l in 0..LANES {
                sum[l] += a[l] * y[l];
            }
        }
    }
    std::array::from_fn(|k| {
        let rest: f64 = columns[k][whole..].iter().zip(&y[whole..]).map(|(a, y)| a * y).sum();
        (sums[k][0] + sums[k][1]) + (sums[k][2] + sums[k][3]) + rest
    })
}

/// `X ← A⁻¹ X` for at most [`BLOCK`] columns of length `n`; `local` is room for the largest front.
pub(super) fn block(tree: &Tree, panels: &[f64], x: &mut [f64], n: usize, local: &mut Vec<f64>) {
    let columns = x.len() / n;
    for front in &tree.fronts {
        let (unknowns, pivots) = (tree.unknowns(front), front.pivots);
        local.clear();
        for x in x.chunks_exact(n) {
            local.extend(unknowns[..pivots].iter().map(|u| x[*u as usize]));
            local.resize(local.len() + front.below(), 0.0);
        }
        let (diagonal, under) = split(front, panels);
        let (mut head, tail) = rows(local, front, columns);
        solve_lower_triangular_in_place(diagonal, head.rb_mut(), Par::Seq);
        matmul(tail, Accum::Replace, under, head.rb(), -1.0, Par::Seq);
        for (x, y) in x.chunks_exact_mut(n).zip(local.chunks_exact(front.size())) {
            for (u, y) in unknowns[..pivots].iter().zip(y) {
                x[*u as usize] = *y;
            }
            for (u, y) in unknowns[pivots..].iter().zip(&y[pivots..]) {
                x[*u as usize] += y;
            }
        }
    }
    for front in tree.fronts.iter().rev() {
        let (unknowns, pivots) = (tree.unknowns(front), front.pivots);
        local.clear();
        for x in x.chunks_exact(n) {
            local.extend(unknowns.iter().map(|u| x[*u as usize]));
        }
        let (diagonal, under) = split(front, panels);
        let (mut head, tail) = rows(local, front, columns);
        matmul(head.rb_mut(), Accum::Add, under.transpose(), tail.rb(), -1.0, Par::Seq);
        solve_upper_triangular_in_place(diagonal.transpose(), head, Par::Seq);
        for (x, y) in x.chunks_exact_mut(n).zip(local.chunks_exact(front.size())) {
            for (u, y) in unknowns[..pivots].iter().zip(y) {
                x[*u as usize] = *y;
            }
        }
    }
}

/// L₁₁ and L₂₁ of a front.
fn split<'a>(front: &Front, panels: &'a [f64]) -> (MatRef<'a, f64>, MatRef<'a, f64>) {
    MatRef::from_column_major_slice(panel(front, panels), front.size(), front.pivots).split_at_row(front.pivots)
}

/// The right-hand sides of a front at its pivots and below.
fn rows<'a>(local: &'a mut [f64], front: &Front, columns: usize) -> (MatMut<'a, f64>, MatMut<'a, f64>) {
    MatMut::from_column_major_slice_mut(local, front.size(), columns).split_at_row_mut(front.pivots)
}
