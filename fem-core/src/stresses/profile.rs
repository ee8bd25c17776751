//! Stresses along a line through the thickness.

use crate::contracts::element::ElementError;
use crate::plates::plate::Plate;
use crate::stresses::field::{Field, Spot};
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::{Global, Ply, Strain6, Stress6};
use nalgebra::{DMatrix, SVector};
use std::collections::HashSet;

/// State at a height of a profile. Interfaces appear twice, once per ply.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfilePoint {
    /// Ply, counted from the bottom.
    pub ply: usize,
    /// Height, m.
    pub z: f64,
    /// Displacement, m.
    pub displacement: [f64; 3],
    /// Stress in the plate's frame, Pa.
    pub global: Stress6<Global>,
    /// Stress in the ply's frame, Pa.
    pub in_ply: Stress6<Ply>,
    /// σ₃₃, σ₂₃, σ₃₁ of the plate's frame from equilibrium with the in-plane stresses, Pa.
    pub equilibrium: Option<[f64; 3]>,
}

/// Forces and moments per length of what is cut along the lines x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resultants {
    /// ∫ σ dz of the components 11, 22, 12, N/m.
    pub membrane: [f64; 3],
    /// ∫ σ z dz of the same, z from the middle of the thickness, N.
    pub bending: [f64; 3],
    /// ∫ τ dz of the components 31, 23, N/m.
    pub shear: [f64; 2],
}

/// A line through the thickness at a point of the plane.
#[derive(Debug, Clone)]
pub struct Profile {
    /// Quads that meet at the point, with its natural coordinates in each.
    places: Vec<(usize, [f64; 2])>,
    /// Quads around it, for derivatives.
    around: Vec<usize>,
    point: [f64; 2],
}

/// Cells around a point whose stresses are differentiated: four deep from an edge, and all there are in a small mesh.
const AROUND: usize = 30;
const AROUND_SECTION: usize = 6;

/// Terms xⁱ yʲ of a cubic in each direction: without x³y a half-wave of sine over the cells around is 20 % off.
const TERMS: usize = 16;

/// Gauss points between two heights of a profile: stresses of a ply are cubic in z at most.
const BETWEEN: usize = 3;

/// Gauss points through a ply for resultants: large strains of cubic displacements are of sixth degree in z.
const PLY_POINTS: usize = 4;

impl Profile {
    /// The line at `point`; `None` outside the plate. Where regions of different plies meet it is in the one of the first cell
    /// that holds the point.
    pub fn at(plate: &Plate, point: [f64; 2]) -> Option<Self> {
        let quads = &plate.plane.quads;
        let place = |q: usize| Some((q, plate.plane.corners(q).locate(point)?));
        let mut places: Vec<(usize, [f64; 2])> = (0..quads.len()).filter_map(place).collect();
        let region = plate.region(places.first()?.0);
        places.retain(|(quad, _)| plate.region(*quad) == region);
        let mut around: Vec<usize> = places.iter().map(|p| p.0).collect();
        let wanted = if plate.info().is_section() { AROUND_SECTION } else { AROUND };
        let own = || (0..quads.len()).filter(|q| plate.region(*q) == region);
        while around.len() < wanted {
            let vertices: HashSet<u32> = around.iter().flat_map(|q| quads[*q]).collect();
            let ring: Vec<usize> = own().filter(|q| quads[*q].iter().any(|v| vertices.contains(v))).collect();
            if ring.len() == around.len() {
                break;
            }
            around = ring;
        }
        Some(Self { places, around, point })
    }

    /// The quads that meet at the point.
    pub fn quads(&self) -> impl ExactSizeIterator<Item = usize> {
        self.places.iter().map(|p| p.0)
    }

    /// The state of `field` at `points` heights of every ply, its faces included: means over the cells that meet at the
    /// point.
    ///
    /// With `equilibrium`, transverse stresses are also integrated from the bottom face, where the pressure is
    /// `bottom` (Pa, pressing):
    ///
    /// τ(z) = −∫ (∂σ₁₁/∂x + ∂σ₁₂/∂y) dz, likewise along y;  σ₃₃(z) = −p − ∫ (∂τ₁₃/∂x + ∂τ₂₃/∂y) dz
    ///
    /// The in-plane derivatives are those of a bicubic fitted to the stresses in the centres of the cells around the point,
    /// where the parts of a displacement that an element interpolates linearly have their best slopes. What τ misses at
    /// the stress-free top is taken off linearly.
    ///
    /// # Errors
    /// A cell that the element refuses.
    pub fn sample(
        &self,
        field: &Field<'_>,
        points: usize,
        equilibrium: Option<f64>,
    ) -> Result<Vec<ProfilePoint>, ElementError> {
        let laminate = field.laminate(self.places[0].0);
        let z = laminate.boundaries();
        let mut all = Vec::new();
        for (ply, lamina) in laminate.plies.iter().enumerate() {
            for i in 0..points.max(2) {
                let share = i as f64 / (points.max(2) - 1) as f64;
                let height = z[ply] + share * (z[ply + 1] - z[ply]);
                let (global, displacement) = self.mean(field, ply, height)?;
                let in_ply = global.to_ply(lamina.angle);
                all.push(ProfilePoint { ply, z: height, displacement, global, in_ply, equilibrium: None });
            }
        }
        if let Some(bottom) = equilibrium {
            self.integrate(field, bottom, &mut all)?;
        }
        Ok(all)
    }

    /// Forces and moments per length: stresses, as [`Profile::sample`] has them, integrated through every ply exactly.
    ///
    /// # Errors
    /// A cell that the element refuses.
    pub fn resultants(&self, field: &Field<'_>) -> Result<Resultants, ElementError> {
        let mut sum = Resultants { membrane: [0.0; 3], bending: [0.0; 3], shear: [0.0; 2] };
        for (ply, z) in field.laminate(self.places[0].0).boundaries().windows(2).enumerate() {
            let half = 0.5 * (z[1] - z[0]);
            for &(t, w) in gauss_legendre(PLY_POINTS) {
                let height = z[0] + half * (1.0 + t);
                let (s, _) = self.mean(field, ply, height)?;
                for (k, s) in [s.s11(), s.s22(), s.s12()].into_iter().enumerate() {
                    sum.membrane[k] += half * w * s;
                    sum.bending[k] += half * w * s * height;
                }
                sum.shear[0] += half * w * s.s31();
                sum.shear[1] += half * w * s.s23();
            }
        }
        Ok(sum)
    }

    /// Mean stress and displacement over the cells that meet at the point.
    fn mean(&self, field: &Field<'_>, ply: usize, z: f64) -> Result<(Stress6<Global>, [f64; 3]), ElementError> {
        let n = self.places.len() as f64;
        let (mut strain, mut displacement) = ([0.0; 6], [0.0; 3]);
        for &(quad, at) in &self.places {
            let (e, d) = field.at(Spot { quad, at, ply, z })?;
            strain.iter_mut().zip(e.0).for_each(|(m, e)| *m += e / n);
            displacement.iter_mut().zip(d).for_each(|(m, d)| *m += d / n);
        }
        Ok((field.stress(self.places[0].0, ply, &Strain6::new(strain)), displacement))
    }

    /// Fills in the transverse stresses from equilibrium.
    fn integrate(&self, field: &Field<'_>, bottom: f64, all: &mut [ProfilePoint]) -> Result<(), ElementError> {
        let fit = self.fit(field.plate());
        let (low, high) = match all {
            [first, .., last] => (first.z, last.z),
            _ => return Ok(()),
        };
        // Resultants so far: ∫ of the divergence of the in-plane stresses, and of its own divergence.
        let (mut shear, mut second, mut normal) = ([0.0; 2], 0.0, -bottom);
        let mut last: Option<(usize, f64)> = None;
        for point in all.iter_mut() {
            if let Some((ply, from)) = last.filter(|l| l.0 == point.ply) {
                let half = 0.5 * (point.z - from);
                normal += 2.0 * half * second;
                for &(t, w) in gauss_legendre(BETWEEN) {
                    let z = from + half * (1.0 + t);
                    let [by_x, by_y, twice] = self.derivatives(field, &fit, ply, z)?;
                    shear[0] -= half * w * by_x;
                    shear[1] -= half * w * by_y;
                    second += half * w * twice;
                    // The double integral of `twice`, by parts.
                    normal += half * w * twice * (point.z - z);
                }
            }
            last = Some((point.ply, point.z));
            point.equilibrium = Some([normal, shear[1], shear[0]]);
        }
        for point in all {
            let share = (point.z - low) / (high - low);
            if let Some([_, s23, s31]) = &mut point.equilibrium {
                *s23 -= share * shear[1];
                *s31 -= share * shear[0];
            }
        }
        Ok(())
    }

    /// Least squares of a cubic in x times a cubic in y around the point: rows give its coefficients from the samples.
    fn fit(&self, plate: &Plate) -> Fit {
        let section = plate.info().is_section();
        let centre = |quad: &usize| {
            let [x, y, _] = plate.cell(quad * plate.layers()).position(plate.info().centre());
            [x - self.point[0], y - self.point[1]]
        };
        let samples: Vec<[f64; 2]> = self.around.iter().map(centre).collect();
        let size = samples.iter().fold(f64::MIN_POSITIVE, |m, s| m.max(s[0].abs()).max(s[1].abs()));
        let terms = |[x, y]: [f64; 2]| -> [f64; TERMS] {
            let (x, y) = (x / size, if section { 0.0 } else { y / size });
            std::array::from_fn(|k| x.powi(k as i32 % 4) * y.powi(k as i32 / 4))
        };
        let a = DMatrix::from_fn(samples.len(), TERMS, |i, j| terms(samples[i])[j]);
        // The pseudo-inverse leaves out what the samples cannot tell (y on a section).
        let inverse = a.pseudo_inverse(1e-10).unwrap_or_else(|_| DMatrix::zeros(TERMS, samples.len()));
        Fit { inverse, size }
    }

    /// ∂σ₁₁/∂x + ∂σ₁₂/∂y, ∂σ₁₂/∂x + ∂σ₂₂/∂y, and the divergence of the two.
    fn derivatives(&self, field: &Field<'_>, fit: &Fit, ply: usize, z: f64) -> Result<[f64; 3], ElementError> {
        let mut coefficients = SVector::<[f64; 3], TERMS>::from_element([0.0; 3]);
        for (i, &quad) in self.around.iter().enumerate() {
            let (e, _) = field.at(Spot { quad, at: field.plate().info().domain.centre(), ply, z })?;
            let s = field.stress(quad, ply, &e);
            for (c, row) in coefficients.iter_mut().zip(fit.inverse.column(i).iter()) {
                for (c, s) in c.iter_mut().zip([s.0[0], s.0[1], s.0[3]]) {
                    *c += row * s;
                }
            }
        }
        let [x, y, xx, xy, yy] = [1, 4, 2, 5, 8].map(|k| coefficients[k]);
        let (h, hh) = (fit.size, fit.size * fit.size);
        Ok([(x[0] + y[2]) / h, (x[2] + y[1]) / h, (2.0 * xx[0] + 2.0 * xy[2] + 2.0 * yy[1]) / hh])
    }
}

struct Fit {
    /// Terms × cells around.
    inverse: DMatrix<f64>,
    size: f64,
}
