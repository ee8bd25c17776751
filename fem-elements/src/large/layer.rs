//! The plies of a cell at in-plane points: energy, stresses and moduli integrated through them.

use super::Polynomial;
use crate::prism::STRAIN_ROW;
use crate::transverse::TransverseStresses;
use fem_core::element::{Cell, ElementInfo, Slice};
use fem_core::quadrature::gauss_legendre;
use fem_core::tensor::{Matrix6, apply};
use fem_core::transverse::{AMPLITUDES, Coupling, SmoothTransverse};
use pulp::{Arch, Simd, WithSimd};

/// Powers of q that a product of two polynomials has: 2 K − 1 for K = 4.
pub(crate) const POWERS: usize = 7;

/// Pairs of components of H, each once.
const PAIRS: usize = 45;

/// Displacement gradients of `L` points or fields side by side: vector instructions take them together.
pub(crate) type Polynomials<const K: usize, const L: usize> = [[[[f64; L]; K]; 3]; 3];

/// Strains of as many, polynomials in q.
pub(crate) type Strains<const L: usize> = [[[f64; L]; POWERS]; 6];

/// What the tangent is made of at an in-plane point.
pub(super) struct Moduli<const K: usize> {
    /// ∫ A qᵏ dq, pairs of components of H by columns of the upper triangle.
    powers: [[f64; PAIRS]; POWERS],
    /// ∫ rows ∂E/∂H qᵏ dq for each of nine amplitudes, where transverse stresses are smooth.
    rows: Option<Box<[[[f64; K]; 9]; AMPLITUDES]>>,
}

impl<const K: usize> Moduli<K> {
    /// A of the coefficients i and j of the components a and b of H.
    pub(super) fn at(&self, (a, i): (usize, usize), (b, j): (usize, usize)) -> f64 {
        let (low, high) = (a.min(b), a.max(b));
        let squares = self.rows.iter().flat_map(|rows| rows.iter()).map(|row| row[a][i] * row[b][j]);
        self.powers[i + j][high * (high + 1) / 2 + low] + squares.sum::<f64>()
    }
}

/// The plies of a cell.
pub(super) struct Layer<'a> {
    info: &'a ElementInfo,
    slices: &'a [Slice],
    /// Smooth transverse stresses, and their amplitudes of the free strains.
    transverse: Option<(&'a SmoothTransverse, [f64; AMPLITUDES])>,
}

impl<'a> Layer<'a> {
    pub(super) fn new(info: &'a ElementInfo, cell: &Cell<'a>, stresses: TransverseStresses) -> Self {
        let slices = &cell.stack.slices;
        let transverse =
            stresses.in_stack(cell.stack).map(|all| (all, all.amplitudes_of(slices.iter().map(|slice| slice.free))));
        Self { info, slices, transverse }
    }

    /// Amplitudes of strains less those that are free.
    #[inline(always)]
    fn amplitudes<const L: usize>(
        &self,
        strains: &Strains<L>,
    ) -> Option<(&'a SmoothTransverse, [[f64; L]; AMPLITUDES])> {
        let (all, free) = self.transverse.as_ref()?;
        let mut a = all.amplitudes(strains);
        a.iter_mut().zip(free).for_each(|(a, free)| a.iter_mut().for_each(|a| *a -= free));
        Some((all, a))
    }

    /// S of strains at q of the ply `number`, whose free strains are taken off; strains become those that are felt, ε̄.
    #[inline(always)]
    fn stresses<const L: usize>(
        &self,
        (number, q): (usize, f64),
        smooth: Option<&(&SmoothTransverse, [[f64; L]; AMPLITUDES])>,
        strain: &mut [[f64; L]; 6],
    ) -> [[f64; L]; 6] {
        let slice = &self.slices[number];
        strain.iter_mut().zip(&slice.free).for_each(|(e, free)| e.iter_mut().for_each(|e| *e -= free));
        match smooth {
            None => product(&slice.c, strain),
            Some((all, a)) => {
                let across = all.assume(number, [q, q], a, strain);
                all.stress(number, &across, strain)
            }
        }
    }

    /// Gauss points of the plies: the ply, q and the weight.
    fn points(&self) -> impl Iterator<Item = (usize, f64, f64)> {
        let points = gauss_legendre(self.info.ply_order);
        self.slices.iter().enumerate().flat_map(move |(number, slice)| {
            let (middle, half) = (0.5 * (slice.q[0] + slice.q[1]), 0.5 * (slice.q[1] - slice.q[0]));
            points.iter().map(move |(t, w)| (number, middle + half * t, w * half))
        })
    }

    /// ∫ σ qᵏ dq of small displacements with this gradient.
    pub(super) fn small_stresses<const K: usize>(&self, gradient: &Polynomial<K>) -> [[f64; 6]; POWERS] {
        let mut strains = [[[0.0]; POWERS]; 6];
        for (a, rows) in STRAIN_ROW.iter().enumerate() {
            for (b, row) in rows.iter().enumerate() {
                strains[*row].iter_mut().zip(&gradient[a][b]).for_each(|([strain], h)| *strain += h);
            }
        }
        let smooth = self.amplitudes(&strains);
        let mut sum = [[0.0; 6]; POWERS];
        for (number, q, mut w) in self.points() {
            let mut strain = strains.map(|p| [p.iter().rev().fold(0.0, |sum, [c]| sum * q + c)]);
            let stress = self.stresses((number, q), smooth.as_ref(), &mut strain);
            for sum in &mut sum {
                sum.iter_mut().zip(&stress).for_each(|(sum, [stress])| *sum += w * stress);
                w *= q;
            }
        }
        sum
    }

    pub(super) fn moduli<const K: usize>(&self) -> Moduli<K> {
        let rows = self.transverse.as_ref().map(|_| Box::new([[[0.0; K]; 9]; AMPLITUDES]));
        Moduli { powers: [[0.0; PAIRS]; POWERS], rows }
    }

    /// Integrates through the plies at `L` in-plane points; adds to `moduli`, where they are asked for, those of the first.
    pub(super) fn through<const K: usize, const L: usize>(
        &self,
        gradients: &Polynomials<K, L>,
        moduli: Option<&mut Moduli<K>>,
    ) -> Integrals<K, L> {
        Arch::new().dispatch(Through { layer: self, gradients, moduli })
    }
}

/// C ε. C is symmetric.
#[inline(always)]
fn product<const L: usize>(c: &Matrix6, strain: &[[f64; L]; 6]) -> [[f64; L]; 6] {
    let mut stress = [[0.0; L]; 6];
    for (stress, row) in stress.iter_mut().zip(c) {
        for (c, e) in row.iter().zip(strain) {
            (0..L).for_each(|lane| stress[lane] += c * e[lane]);
        }
    }
    stress
}

/// Integrals through the plies at in-plane points.
pub(super) struct Integrals<const K: usize, const L: usize> {
    /// ∫ ½ (E − ε₀)ᵀ C (E − ε₀) dq
    pub(super) energy: [f64; L],
    /// ∫ P qᵏ dq
    pub(super) stresses: Polynomials<K, L>,
}

/// [`Layer::through`]
struct Through<'a, const K: usize, const L: usize> {
    layer: &'a Layer<'a>,
    gradients: &'a Polynomials<K, L>,
    moduli: Option<&'a mut Moduli<K>>,
}

impl<const K: usize, const L: usize> WithSimd for Through<'_, K, L> {
    type Output = Integrals<K, L>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Integrals<K, L> {
        let Self { layer, gradients, mut moduli } = self;
        let mut sum = Integrals { energy: [0.0; L], stresses: [[[[0.0; L]; K]; 3]; 3] };
        let mut smooth = None;
        if layer.transverse.is_some() {
            let mut strains = [[[0.0; L]; POWERS]; 6];
            add_strains(gradients, 1.0, &mut strains);
            smooth = layer.amplitudes(&strains);
        }
        for (number, q, w) in layer.points() {
            let mut h = [[[0.0_f64; L]; 3]; 3];
            for (h, p) in h.as_flattened_mut().iter_mut().zip(gradients.as_flattened()) {
                for c in p.iter().rev() {
                    (0..L).for_each(|lane| h[lane] = h[lane].mul_add(q, c[lane]));
                }
            }
            let mut strain = green_lagrange(&h);
            let stress = layer.stresses((number, q), smooth.as_ref(), &mut strain);
            sum.add(&h, &strain, &stress, q, w);
            if let Some(moduli) = &mut moduli {
                let rows = smooth.as_ref().map(|(all, _)| (all.reduced(number), all.rows(number, q)));
                let (c, rows) = rows.unzip();
                let c = c.as_ref().unwrap_or(&layer.slices[number].c);
                add_moduli(moduli, &h.map(|row| row.map(|h| h[0])), (c, rows), &stress.map(|s| s[0]), q, w);
            }
        }
        sum
    }
}

/// E of displacement gradients, [`fem_core::large::green_lagrange`] side by side.
#[inline(always)]
fn green_lagrange<const L: usize>(h: &[[[f64; L]; 3]; 3]) -> [[f64; L]; 6] {
    let mut strain = [[0.0; L]; 6];
    for (a, rows) in STRAIN_ROW.iter().enumerate() {
        for (b, row) in rows.iter().enumerate().skip(a) {
            let strain = &mut strain[*row];
            (0..L).for_each(|lane| strain[lane] = h[a][b][lane] + h[b][a][lane]);
            for component in h {
                (0..L).for_each(|lane| strain[lane] = component[a][lane].mul_add(component[b][lane], strain[lane]));
            }
            if a == b {
                strain.iter_mut().for_each(|e| *e *= 0.5);
            }
        }
    }
    strain
}

impl<const K: usize, const L: usize> Integrals<K, L> {
    /// Adds points with the strains E − ε₀, or ε̄ in their place, and S.
    #[inline(always)]
    fn add(&mut self, h: &[[[f64; L]; 3]; 3], strain: &[[f64; L]; 6], stress: &[[f64; L]; 6], q: f64, w: f64) {
        for (e, s) in strain.iter().zip(stress) {
            (0..L).for_each(|lane| self.energy[lane] = (0.5 * w * e[lane]).mul_add(s[lane], self.energy[lane]));
        }
        for (n, (row, stresses)) in h.iter().zip(&mut self.stresses).enumerate() {
            for (rows, sum) in STRAIN_ROW.iter().zip(stresses) {
                // (I + H) S
                let mut p = stress[rows[n]];
                for (h, row) in row.iter().zip(rows) {
                    (0..L).for_each(|lane| p[lane] = h[lane].mul_add(stress[*row][lane], p[lane]));
                }
                let mut weight = w;
                for sum in sum {
                    (0..L).for_each(|lane| sum[lane] = weight.mul_add(p[lane], sum[lane]));
                    weight *= q;
                }
            }
        }
    }
}

/// I + H
fn deformation(h: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut f = *h;
    (0..3).for_each(|i| f[i][i] += 1.0);
    f
}

/// Adds w qᵏ ∂P/∂H of a ply with the stiffness `c` and, where there are some, the rows of its transverse stresses.
fn add_moduli<const K: usize>(
    moduli: &mut Moduli<K>,
    h: &[[f64; 3]; 3],
    (c, rows): (&Matrix6, Option<Coupling>),
    stress: &[f64; 6],
    q: f64,
    w: f64,
) {
    let f = deformation(h);
    // ∂E/∂H: column 3 n + d has F[n][e] in the row of (d, e), once for normal strains as for engineering shears.
    let mut by = [[0.0; 6]; 9];
    for (at, column) in by.iter_mut().enumerate() {
        for e in 0..3 {
            column[STRAIN_ROW[at % 3][e]] += f[at / 3][e];
        }
    }
    let cby = by.map(|column| apply(c, &column));
    let mut pairs = [0.0; PAIRS];
    let mut at = 0;
    for (j, cb) in cby.iter().enumerate() {
        for (i, b) in by[..=j].iter().enumerate() {
            let geometric = if i / 3 == j / 3 { stress[STRAIN_ROW[i % 3][j % 3]] } else { 0.0 };
            pairs[at] = w * (b.iter().zip(cb).map(|(b, c)| b * c).sum::<f64>() + geometric);
            at += 1;
        }
    }
    if let (Some(sums), Some(rows)) = (&mut moduli.rows, rows) {
        for (sums, row) in sums.iter_mut().zip(rows.row_iter()) {
            for (sums, column) in sums.iter_mut().zip(&by) {
                let mut value = w * row.iter().zip(column).map(|(a, b)| a * b).sum::<f64>();
                for sum in sums {
                    *sum += value;
                    value *= q;
                }
            }
        }
    }
    let mut power = 1.0;
    for moduli in &mut moduli.powers[..2 * K - 1] {
        for (sum, pair) in moduli.iter_mut().zip(&pairs) {
            *sum += power * pair;
        }
        power *= q;
    }
}

/// Adds `dv` E of displacement gradients, polynomials in q of twice the degree.
#[inline(always)]
pub(crate) fn add_strains<const K: usize, const L: usize>(h: &Polynomials<K, L>, dv: f64, sums: &mut Strains<L>) {
    for (a, rows) in STRAIN_ROW.iter().enumerate() {
        for (b, row) in rows.iter().enumerate().skip(a) {
            // Normal strains have half of the sum, engineering shears all of it.
            let dv = if a == b { 0.5 * dv } else { dv };
            let mut strain = [[0.0; L]; POWERS];
            for (k, strain) in strain.iter_mut().enumerate().take(K) {
                (0..L).for_each(|lane| strain[lane] = h[a][b][k][lane] + h[b][a][k][lane]);
            }
            for component in h {
                for (i, x) in component[a].iter().enumerate() {
                    for (j, y) in component[b].iter().enumerate() {
                        let strain = &mut strain[i + j];
                        (0..L).for_each(|lane| strain[lane] = x[lane].mul_add(y[lane], strain[lane]));
                    }
                }
            }
            for (sum, strain) in sums[*row].iter_mut().zip(&strain) {
                (0..L).for_each(|lane| sum[lane] = dv.mul_add(strain[lane], sum[lane]));
            }
        }
    }
}
