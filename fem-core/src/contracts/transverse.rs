//! Transverse stresses that are smooth across the plies of a layer of cells.
//!
//! Displacements that are polynomials through a layer of several plies have smooth strains, and stresses C ε that jump from ply
//! to ply where equilibrium wants them continuous: the layer is too stiff, by 5 to 15 % of a thick plate's deflection. Here the
//! transverse stresses t = (σ₃₃, σ₂₃, σ₃₁) of a layer are functions of their own (Hellinger and Reissner). With the strains in the
//! plane p = (ε₁₁, ε₂₂, γ₁₂), the transverse ones e = (ε₃₃, γ₂₃, γ₃₁) and a ply's S = C_ee⁻¹, P = S C_ep, Q = C_pp − C_pe S C_ep, the
//! energy per volume is
//!
//! W = ½ pᵀ Q p + max over t of { tᵀ (e + P p) − ½ tᵀ S t },
//!
//! which is ½ εᵀ C ε where t may be anything, and less where t is held to t(q) = Φ(q) a with nine amplitudes a:
//!
//! - σ₃₃ of second degree in q;
//! - (σ₂₃, σ₃₁) = a₀ + F₀(q) a₁ + F₁(q) a₂ with Fₘ = ∫ A qᵐ dq from the lower face, A(α,β) = Q(α,γ,β,γ): what equilibrium makes of
//!   stresses in the plane that are linear in the strains, and these in q. A is the acoustic tensor of a ply, its mean over
//!   the directions of the plane, so that t turns with the axes.
//!
//! The maximum is a linear map of the strains: a = G ∫ Φᵀ (e + P p) dq, G⁻¹ = ∫ Φᵀ S Φ dq. What the plies feel are strains ε̄ with
//! p as it is and ē = S Φ a − P p, whose stresses C ε̄ have the transverse part Φ a; W is ½ ε̄ᵀ C ε̄ integrated through the layer, and
//! ε ↦ ε̄ repeated changes nothing. An element that uses ε̄ in place of ε is a method of assumed strains that costs no more.
//!
//! Limits: stresses that vary through a layer more than quadratically, as under a small patch, take more layers; strains in the
//! plane that zigzag are not there, so that a laminate whose plies of one angle lie far apart within a layer stays a little too
//! stiff.

use crate::contracts::stack::Slice;
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::Matrix6;
use nalgebra::{DMatrix, Matrix2, Matrix3, SMatrix, SVector, Vector6};

/// Rows of the strain 11 22 33 12 23 31 in the plane.
const PLANE: [usize; 3] = [0, 1, 3];
/// Rows of the transverse strains.
pub const ACROSS: [usize; 3] = [2, 4, 5];

/// Amplitudes: three of σ₃₃, then three pairs of the shears.
pub const AMPLITUDES: usize = 9;

/// Powers of q that strains may have: those of a cubic's derivatives, and of their products.
const LINEAR: usize = 4;
const QUADRATIC: usize = 7;

/// Plies whose stiffnesses differ by less of their largest entry are one.
const ALIKE: f64 = 1e-9;

/// Columns of Φ this small beside what they were before the others were taken out of them add nothing but rounding.
const DEPENDENT: f64 = 1e-12;

/// Gauss points through a ply: exact for cubic strains times Φ.
const POINTS: usize = 3;

/// sum += c x, each number by itself.
#[inline(always)]
fn add<const L: usize>(sum: &mut [f64; L], c: f64, x: &[f64; L]) {
    (0..L).for_each(|lane| sum[lane] += c * x[lane]);
}

type Functions = SMatrix<f64, 3, AMPLITUDES>;
/// Something of each amplitude from a strain.
pub type Coupling = SMatrix<f64, AMPLITUDES, 6>;

/// Transverse strains from a strain.
pub type Operator = SMatrix<f64, 3, 6>;

/// See the [module](self).
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothTransverse {
    plies: Vec<Ply>,
    /// G ∫ Φᵀ (e + P p) qᵏ dq of a unit strain.
    gains: [Coupling; QUADRATIC],
    /// W = ½ Σ ε(k)ᵀ form(k, k′) ε(k′) of strains Σ ε(k) qᵏ.
    forms: [[Matrix6; LINEAR]; LINEAR],
    /// A factor of G = root rootᵀ.
    root: SMatrix<f64, AMPLITUDES, AMPLITUDES>,
}

#[derive(Debug, Clone, PartialEq)]
struct Ply {
    q: [f64; 2],
    compliance: Matrix3<f64>,
    coupling: Matrix3<f64>,
    reduced: Matrix3<f64>,
    /// F₀ and F₁ at the lower face, and A.
    below: [Matrix2<f64>; 2],
    acoustic: Matrix2<f64>,
    /// G ∫ Φᵀ dq over the ply.
    share: SMatrix<f64, AMPLITUDES, 3>,
}

impl Ply {
    /// None where the transverse stiffness has no inverse.
    fn new(slice: &Slice) -> Option<Self> {
        let part = |rows: [usize; 3], columns: [usize; 3]| Matrix3::from_fn(|i, j| slice.c[rows[i]][columns[j]]);
        let compliance = part(ACROSS, ACROSS).try_inverse()?;
        let coupling = compliance * part(ACROSS, PLANE);
        let reduced = part(PLANE, PLANE) - part(PLANE, ACROSS) * coupling;
        let (xx, yy, xy) = (reduced[(0, 0)], reduced[(1, 1)], reduced[(2, 2)]);
        let mixed = reduced[(0, 2)] + reduced[(1, 2)];
        // In the order 23 31 of the shears: y before x.
        let acoustic = Matrix2::new(yy + xy, mixed, mixed, xx + xy);
        let below = [Matrix2::zeros(); 2];
        Some(Self { q: slice.q, compliance, coupling, reduced, below, acoustic, share: SMatrix::zeros() })
    }

    /// F₀ and F₁ at q.
    fn shapes(&self, q: f64) -> [Matrix2<f64>; 2] {
        let low = self.q[0];
        [self.below[0] + self.acoustic * (q - low), self.below[1] + self.acoustic * (0.5 * (q * q - low * low))]
    }

    /// Φ(q)
    fn functions(&self, q: f64) -> Functions {
        let mut phi = Functions::zeros();
        (0..3).for_each(|k| phi[(0, k)] = q.powi(k as i32));
        let [f0, f1] = self.shapes(q);
        for (k, f) in [Matrix2::identity(), f0, f1].iter().enumerate() {
            phi.fixed_view_mut::<2, 2>(1, 3 + 2 * k).copy_from(f);
        }
        phi
    }

    /// Φ(q) a
    #[inline(always)]
    fn stress<const L: usize>(&self, q: f64, a: &[[f64; L]; AMPLITUDES]) -> [[f64; L]; 3] {
        let [f0, f1] = self.shapes(q);
        let mut stress = [a[0], a[3], a[4]];
        add(&mut stress[0], q, &a[1]);
        add(&mut stress[0], q * q, &a[2]);
        for (i, stress) in stress[1..].iter_mut().enumerate() {
            for j in 0..2 {
                add(stress, f0[(i, j)], &a[5 + j]);
                add(stress, f1[(i, j)], &a[7 + j]);
            }
        }
        stress
    }

    /// e + P p of a unit strain.
    fn free(&self) -> Operator {
        let mut free = SMatrix::zeros();
        for (i, row) in ACROSS.into_iter().enumerate() {
            free[(i, row)] = 1.0;
            (0..3).for_each(|j| free[(i, PLANE[j])] = self.coupling[(i, j)]);
        }
        free
    }

    /// Calls `each(q, weight)` at points that integrate over low ≤ q ≤ high.
    fn integrate([low, high]: [f64; 2], points: usize, mut each: impl FnMut(f64, f64)) {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        gauss_legendre(points).iter().for_each(|(t, w)| each(middle + half * t, half * w));
    }
}

impl SmoothTransverse {
    /// None where all plies are of one stiffness, or a stiffness has no inverse.
    pub fn new(slices: &[Slice]) -> Option<Self> {
        let (first, rest) = slices.split_first()?;
        let largest = first.c.as_flattened().iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        let alike = |a: &Matrix6| {
            let pairs = a.as_flattened().iter().zip(first.c.as_flattened());
            pairs.into_iter().all(|(a, b)| (a - b).abs() <= ALIKE * largest)
        };
        if rest.iter().all(|slice| alike(&slice.c)) {
            return None;
        }
        let mut plies = slices.iter().map(Ply::new).collect::<Option<Vec<_>>>()?;
        shape(&mut plies);
        let root = root(&plies)?;
        let gather = root * root.transpose();
        let mut couplings = [Coupling::zeros(); QUADRATIC];
        for ply in &mut plies {
            let free = ply.free();
            let mut share = SMatrix::zeros();
            Ply::integrate(ply.q, POINTS + 2, |q, w| {
                let phi = ply.functions(q).transpose();
                share += phi * w;
                let mut power = w;
                for coupling in &mut couplings {
                    *coupling += phi * free * power;
                    power *= q;
                }
            });
            ply.share = gather * share;
        }
        let forms = forms(&plies, &couplings.each_ref().map(|c| root.transpose() * c));
        Some(Self { gains: couplings.map(|c| gather * c), plies, forms, root })
    }

    /// The form of the coefficients of qᵏ and qᵏ′ of the strains, k and k′ below four.
    pub fn form(&self, k: usize, k2: usize) -> &Matrix6 {
        &self.forms[k][k2]
    }

    /// Transverse rows of ε̄, its mean over `part` of the ply `slice` or its value where both bounds are one, from the
    /// coefficients ε(k) of strains Σ ε(k) qᵏ: ē = Σ operator\[k\] ε(k).
    pub fn operator(&self, slice: usize, part: [f64; 2]) -> [Operator; LINEAR] {
        let ply = &self.plies[slice];
        let mut rows = [SMatrix::zeros(); LINEAR];
        let mut add = |q: f64, weight: f64| {
            let stress = ply.compliance * ply.functions(q);
            let mut power = 1.0;
            for (rows, gain) in rows.iter_mut().zip(&self.gains) {
                *rows += stress * gain * weight;
                for (j, column) in PLANE.into_iter().enumerate() {
                    (0..3).for_each(|i| rows[(i, column)] -= weight * power * ply.coupling[(i, j)]);
                }
                power *= q;
            }
        };
        match part {
            [low, high] if high > low => Ply::integrate(part, POINTS, |q, w| add(q, w / (high - low))),
            [q, _] => add(q, 1.0),
        }
        rows
    }

    /// Amplitudes a of strains Σ `strains`\[·\]\[k\] qᵏ, of `L` side by side.
    #[inline(always)]
    pub fn amplitudes<const L: usize>(&self, strains: &[[[f64; L]; QUADRATIC]; 6]) -> [[f64; L]; AMPLITUDES] {
        let mut a = [[0.0; L]; AMPLITUDES];
        for (k, gain) in self.gains.iter().enumerate() {
            for (row, strain) in strains.iter().enumerate() {
                for (i, a) in a.iter_mut().enumerate() {
                    add(a, gain[(i, row)], &strain[k]);
                }
            }
        }
        a
    }

    /// Amplitudes of strains that are constant in each ply.
    pub fn amplitudes_of(&self, strains: impl Iterator<Item = [f64; 6]>) -> [f64; AMPLITUDES] {
        let each = self.plies.iter().zip(strains);
        let sum: SVector<f64, AMPLITUDES> =
            each.map(|(ply, strain)| ply.share * (ply.free() * Vector6::from(strain))).sum();
        sum.into()
    }

    /// Replaces the transverse rows of strains by those of ε̄, and gives the transverse stresses Φ a: of means over `part` of a ply, or
    /// of values where both bounds are one. `L` are taken side by side.
    #[inline(always)]
    pub fn assume<const L: usize>(
        &self,
        slice: usize,
        part: [f64; 2],
        a: &[[f64; L]; AMPLITUDES],
        strain: &mut [[f64; L]; 6],
    ) -> [[f64; L]; 3] {
        let ply = &self.plies[slice];
        let stress = match part {
            [low, high] if high > low => {
                let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
                let mut mean = [[0.0; L]; 3];
                for (t, w) in gauss_legendre(POINTS) {
                    let stress = ply.stress(middle + half * t, a);
                    mean.iter_mut().zip(&stress).for_each(|(mean, stress)| add(mean, 0.5 * w, stress));
                }
                mean
            }
            [q, _] => ply.stress(q, a),
        };
        let plane = PLANE.map(|row| strain[row]);
        for (i, row) in ACROSS.into_iter().enumerate() {
            let mut across = [0.0; L];
            for j in 0..3 {
                add(&mut across, ply.compliance[(i, j)], &stress[j]);
                add(&mut across, -ply.coupling[(i, j)], &plane[j]);
            }
            strain[row] = across;
        }
        stress
    }

    /// C ε̄ of the strains' rows in the plane and the transverse stresses, of `L` side by side.
    #[inline(always)]
    pub fn stress<const L: usize>(
        &self,
        slice: usize,
        across: &[[f64; L]; 3],
        strain: &[[f64; L]; 6],
    ) -> [[f64; L]; 6] {
        let ply = &self.plies[slice];
        let mut stress = [[0.0; L]; 6];
        for (i, row) in PLANE.into_iter().enumerate() {
            for j in 0..3 {
                add(&mut stress[row], ply.reduced[(i, j)], &strain[PLANE[j]]);
                add(&mut stress[row], ply.coupling[(j, i)], &across[j]);
            }
        }
        ACROSS.into_iter().zip(across).for_each(|(row, across)| stress[row] = *across);
        stress
    }

    /// Q of a ply among zeros.
    pub fn reduced(&self, slice: usize) -> Matrix6 {
        let mut reduced = [[0.0; 6]; 6];
        for (i, row) in PLANE.into_iter().enumerate() {
            for (j, column) in PLANE.into_iter().enumerate() {
                reduced[row][column] = self.plies[slice].reduced[(i, j)];
            }
        }
        reduced
    }

    /// Rows by whose squares a strain at q, with the weight of its point, enters the energy beside Q: W = ½ pᵀ Q p + ½ |Σ rows ε|².
    pub fn rows(&self, slice: usize, q: f64) -> Coupling {
        let ply = &self.plies[slice];
        self.root.tr_mul(&(ply.functions(q).transpose() * ply.free()))
    }
}

/// Fills in F₀ and F₁ of the plies, A relative to its mean so that all functions are of the size of powers of q.
fn shape(plies: &mut [Ply]) {
    let mean: f64 = plies.iter().map(|ply| 0.25 * (ply.q[1] - ply.q[0]) * ply.acoustic.trace()).sum();
    let mut below = [Matrix2::zeros(); 2];
    for ply in plies {
        ply.acoustic /= mean;
        ply.below = below;
        below = ply.shapes(ply.q[1]);
    }
}

/// A factor of G by orthogonal functions: with S = L Lᵀ the samples √w Lᵀ Φ have a triangular factor R, and G = R⁻¹ R⁻ᵀ.
fn root(plies: &[Ply]) -> Option<SMatrix<f64, AMPLITUDES, AMPLITUDES>> {
    let mut samples = DMatrix::zeros(3 * POINTS * plies.len(), AMPLITUDES);
    let mut row = 0;
    for ply in plies {
        let half = ply.compliance.cholesky()?.l().transpose();
        Ply::integrate(ply.q, POINTS, |q, w| {
            samples.fixed_view_mut::<3, AMPLITUDES>(row, 0).copy_from(&(half * ply.functions(q) * w.sqrt()));
            row += 3;
        });
    }
    let sizes: Vec<f64> = samples.column_iter().map(|column| column.norm()).collect();
    samples.column_iter_mut().zip(&sizes).for_each(|(mut column, size)| column /= *size);
    let r = samples.qr().r();
    if (0..AMPLITUDES).any(|k| r[(k, k)].abs() < DEPENDENT) {
        return None;
    }
    let inverse = r.try_inverse()?;
    Some(SMatrix::from_fn(|i, j| inverse[(i, j)] / sizes[i]))
}

/// ∫ Q qᵏ⁺ᵏ′ dq + couplings(k)ᵀ couplings(k′)
fn forms(plies: &[Ply], couplings: &[Coupling; QUADRATIC]) -> [[Matrix6; LINEAR]; LINEAR] {
    std::array::from_fn(|k| {
        std::array::from_fn(|k2| {
            let mut sum = couplings[k].tr_mul(&couplings[k2]);
            for ply in plies {
                let p = (k + k2 + 1) as i32;
                let moment = (ply.q[1].powi(p) - ply.q[0].powi(p)) / f64::from(p);
                for (i, row) in PLANE.into_iter().enumerate() {
                    (0..3).for_each(|j| sum[(row, PLANE[j])] += moment * ply.reduced[(i, j)]);
                }
            }
            std::array::from_fn(|i| std::array::from_fn(|j| sum[(i, j)]))
        })
    })
}
