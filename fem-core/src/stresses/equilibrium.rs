//! Transverse stresses from equilibrium with those in the plane.

use super::around::Neighbour;
use super::field::{Field, Spot};
use crate::contracts::element::ElementError;
use crate::words::quadrature::gauss_legendre;
use nalgebra::{DMatrix, SVector};

/// Terms xⁱ yʲ of a cubic in each direction: without x³y a half-wave of sine over the cells around is 20 % off.
const TERMS: usize = 16;
/// Those without y.
const TERMS_SECTION: usize = 4;

/// Gauss points between two heights of a profile: stresses of a ply are cubic in z at most.
const BETWEEN: usize = 3;

/// Singular values below these shares of the largest are left out, and do not count for a cubic.
const NOTHING: f64 = 1e-10;
const LITTLE: f64 = 1e-6;

/// What a fit misses that goes through all its samples cannot be seen: that of eight cells in a wave, rounded up.
const UNSEEN: f64 = 0.05;

/// Changes of a stress below this share of it are rounding.
const ROUNDING: f64 = 1e-9;
/// Shear below this share of the in-plane stresses is none that matters.
const SLIGHT: f64 = 1e-4;

/// σ₁₁, σ₂₂, σ₁₂ of each term.
type Coefficients = SVector<[f64; 3], TERMS>;

/// Least squares of a cubic in x times a cubic in y around a point.
pub(super) struct Fit<'a> {
    around: &'a [Neighbour],
    /// Cells around × terms, and its pseudo-inverse: rows give coefficients from the samples.
    terms: DMatrix<f64>,
    inverse: DMatrix<f64>,
    size: f64,
    /// Whether the samples tell all terms that there can be.
    pub(super) determined: bool,
}

/// Transverse stresses along a line.
pub(super) struct Balance {
    /// σ₃₃, σ₂₃, σ₃₁ at each height, Pa.
    pub(super) stresses: Vec<[f64; 3]>,
    /// Of the change of the in-plane stresses at the faces over the cells around, the part that the fit misses; less where
    /// hardly any shear comes from it.
    pub(super) misfit: f64,
    /// ∫ σ₃₁ dz and ∫ σ₂₃ dz, N/m.
    pub(super) forces: [f64; 2],
    /// Shear and σ₃₃ that this change makes, Pa.
    pub(super) scale: [f64; 2],
}

impl<'a> Fit<'a> {
    pub(super) fn new(around: &'a [Neighbour], section: bool) -> Self {
        let samples = || around.iter().map(|neighbour| neighbour.centre);
        let size = samples().fold(f64::MIN_POSITIVE, |m, s| m.max(s[0].abs()).max(s[1].abs()));
        let rows: Vec<[f64; TERMS]> = samples()
            .map(|[x, y]| {
                let (x, y) = (x / size, if section { 0.0 } else { y / size });
                std::array::from_fn(|k| x.powi(k as i32 % 4) * y.powi(k as i32 / 4))
            })
            .collect();
        let terms = DMatrix::from_fn(rows.len(), TERMS, |i, j| rows[i][j]);
        let svd = terms.clone().svd(true, true);
        let least = LITTLE * svd.singular_values.max();
        let wanted = if section { TERMS_SECTION } else { TERMS };
        let determined = svd.rank(least) >= wanted;
        // The pseudo-inverse leaves out what the samples cannot tell (y on a section).
        let inverse = svd.pseudo_inverse(NOTHING).unwrap_or_else(|_| DMatrix::zeros(TERMS, rows.len()));
        Self { around, terms, inverse, size, determined }
    }

    /// Integrates from the bottom up through `heights` (ply, z), m. The pressures on the bottom and the top face, Pa, are known.
    pub(super) fn integrate(
        &self,
        field: &Field<'_>,
        [bottom, top]: [f64; 2],
        heights: &[(usize, f64)],
    ) -> Result<Balance, ElementError> {
        let [(_, low), .., (_, high)] = heights else {
            return Ok(Balance { stresses: Vec::new(), misfit: 0.0, forces: [0.0; 2], scale: [0.0; 2] });
        };
        // Resultants so far: ∫ of the divergence of the in-plane stresses, and of its own divergence.
        let (mut shear, mut second, mut normal, mut forces) = ([0.0; 2], 0.0, -bottom, [0.0; 2]);
        let mut last: Option<(usize, f64)> = None;
        let mut stresses = Vec::with_capacity(heights.len());
        for &(ply, height) in heights {
            if let Some((ply, from)) = last.filter(|l| l.0 == ply) {
                let half = 0.5 * (height - from);
                normal += 2.0 * half * second;
                (0..2).for_each(|k| forces[k] += 2.0 * half * shear[k]);
                for &(t, w) in gauss_legendre(BETWEEN) {
                    let z = from + half * (1.0 + t);
                    let [by_x, by_y, twice] = self.derivatives(field, ply, z)?;
                    shear[0] -= half * w * by_x;
                    shear[1] -= half * w * by_y;
                    second += half * w * twice;
                    // The double integral of `twice`, by parts.
                    normal += half * w * twice * (height - z);
                    forces[0] -= half * w * by_x * (height - z);
                    forces[1] -= half * w * by_y * (height - z);
                }
            }
            last = Some((ply, height));
            stresses.push([normal, shear[1], shear[0]]);
        }
        let missed = normal + top;
        for ([s33, s23, s31], (_, height)) in stresses.iter_mut().zip(heights) {
            let share = (height - low) / (high - low);
            // As σ₃₃ of a plate of one material, so that its slope stays zero at the faces, where no shear is.
            *s33 -= share * share * (3.0 - 2.0 * share) * missed;
            *s23 -= share * shear[1];
            *s31 -= share * shear[0];
        }
        (0..2).for_each(|k| forces[k] -= 0.5 * (high - low) * shear[k]);
        let slope = (high - low) / self.size;
        let (mut misfit, mut scale) = (0.0_f64, [0.0_f64; 2]);
        for (ply, z) in heights.first().into_iter().chain(heights.last()) {
            let (missed, change, all) = self.misfit(field, *ply, *z)?;
            let part = if change > ROUNDING * all { (change * slope / (SLIGHT * all)).min(1.0) } else { 0.0 };
            misfit = misfit.max(part * missed);
            scale = [scale[0].max(change * slope), scale[1].max(change * slope * slope)];
        }
        Ok(Balance { stresses, misfit, forces, scale })
    }

    /// ∂σ₁₁/∂x + ∂σ₁₂/∂y, ∂σ₁₂/∂x + ∂σ₂₂/∂y, and the divergence of the two.
    fn derivatives(&self, field: &Field<'_>, ply: usize, z: f64) -> Result<[f64; 3], ElementError> {
        let coefficients = self.coefficients(&self.samples(field, ply, z)?);
        let [x, y, xx, xy, yy] = [1, 4, 2, 5, 8].map(|k| coefficients[k]);
        let (h, hh) = (self.size, self.size * self.size);
        Ok([(x[0] + y[2]) / h, (x[2] + y[1]) / h, (2.0 * xx[0] + 2.0 * xy[2] + 2.0 * yy[1]) / hh])
    }

    /// The share of the change of the in-plane stresses over the cells that the fit misses, that change and the stresses, Pa: root
    /// mean squares.
    fn misfit(&self, field: &Field<'_>, ply: usize, z: f64) -> Result<(f64, f64, f64), ElementError> {
        let samples = self.samples(field, ply, z)?;
        let coefficients = self.coefficients(&samples);
        let (mut missed, mut change, mut all) = (0.0, 0.0, 0.0);
        for (i, sample) in samples.iter().enumerate() {
            for (k, s) in sample.iter().enumerate() {
                let fitted: f64 = self.terms.row(i).iter().zip(&coefficients).map(|(term, c)| term * c[k]).sum();
                missed += (s - fitted).powi(2);
                change += (s - coefficients[0][k]).powi(2);
                all += s * s;
            }
        }
        let seen = samples.len() > TERMS;
        let share = if seen { (missed / f64::max(change, f64::MIN_POSITIVE)).sqrt() } else { UNSEEN };
        let [change, all] = [change, all].map(|sum: f64| (sum / samples.len() as f64).sqrt());
        Ok((share, change, all))
    }

    /// σ₁₁, σ₂₂, σ₁₂ in the centres of the cells.
    fn samples(&self, field: &Field<'_>, ply: usize, z: f64) -> Result<Vec<[f64; 3]>, ElementError> {
        let sample = |&Neighbour { quad, turned, .. }: &Neighbour| {
            let at = field.plate().info_of(quad).domain.centre();
            let (strain, _) = field.at(Spot { quad, at, ply, z })?;
            let s = field.stress(quad, (ply, z), &strain);
            Ok([s.s11(), s.s22(), turned * s.s12()])
        };
        self.around.iter().map(sample).collect()
    }

    fn coefficients(&self, samples: &[[f64; 3]]) -> Coefficients {
        let mut coefficients = Coefficients::from_element([0.0; 3]);
        for (i, sample) in samples.iter().enumerate() {
            for (c, row) in coefficients.iter_mut().zip(self.inverse.column(i).iter()) {
                for (c, s) in c.iter_mut().zip(sample) {
                    *c += row * s;
                }
            }
        }
        coefficients
    }
}
