//! Classical laminate theory: thin plates whose normals stay straight and normal, plies in plane stress.

use crate::plates::laminate::Laminate;
use crate::words::material::{Material, MaterialError};
use crate::words::tensor::{Ply, Stress6, apply, rotate_stiffness, strain_rotation};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Components 11, 22, 12 among 11, 22, 33, 12, 23, 31.
const PLANE: [usize; 3] = [0, 1, 3];

/// Share of what would be without it below which a coupling is rounding.
const NOTHING: f64 = 1e-9;

/// Stiffnesses of a laminate in the axes of the plate, z from its mid-plane upwards, components 11, 22, 12 with engineering shear.
///
/// N = A ε + B κ, M = B ε + D κ with (A, B, D) = Σ Q ∫ (1, z, z²) dz and κ = −(w,₁₁, w,₂₂, 2 w,₁₂). Q is a ply's stiffness without σ33.
///
/// Limits: no transverse shear, no displacement beyond the linear ones, no stress at free edges.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassicalLaminate {
    /// A, N/m.
    pub membrane: Matrix3<f64>,
    /// B, N.
    pub coupling: Matrix3<f64>,
    /// D, N m.
    pub bending: Matrix3<f64>,
    /// Thickness, m.
    pub thickness: f64,
    /// Of each ply from the bottom: Q in the axes of the plate, Pa.
    stiffnesses: Vec<Matrix3<f64>>,
    /// z of the faces of the plies, m.
    boundaries: Vec<f64>,
    angles: Vec<f64>,
}

/// Young's moduli along x and y, shear modulus, Pa, and Poisson's ratio of a plate of one material that would be as stiff.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub struct PlaneModuli {
    pub ex: f64,
    pub ey: f64,
    pub gxy: f64,
    pub nuxy: f64,
}

/// What loads make of a laminate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateStrain {
    /// Strains of the mid-plane, 11, 22, 12.
    pub mid_plane: [f64; 3],
    /// Curvatures κ, 1/m.
    pub curvature: [f64; 3],
}

impl ClassicalLaminate {
    /// Of these plies, whose materials pass [`Material::check`].
    pub fn new(laminate: &Laminate, materials: &[Material]) -> Self {
        let boundaries: Vec<f64> = laminate.boundaries().into_iter().map(|z| z - laminate.middle).collect();
        let [mut membrane, mut coupling, mut bending] = [Matrix3::zeros(); 3];
        let mut stiffnesses = Vec::new();
        for (ply, z) in laminate.plies.iter().zip(boundaries.windows(2)) {
            let c = rotate_stiffness(&materials[ply.material].elastic.stiffness(), ply.angle);
            let q = Matrix3::from_fn(|i, j| {
                let (i, j) = (PLANE[i], PLANE[j]);
                c[i][j] - c[i][2] * c[2][j] / c[2][2]
            });
            membrane += q * (z[1] - z[0]);
            coupling += q * (0.5 * (z[1].powi(2) - z[0].powi(2)));
            bending += q * ((z[1].powi(3) - z[0].powi(3)) / 3.0);
            stiffnesses.push(q);
        }
        let angles = laminate.plies.iter().map(|ply| ply.angle).collect();
        Self { membrane, coupling, bending, thickness: laminate.thickness(), stiffnesses, boundaries, angles }
    }

    /// Whether B is zero: bending and stretching are two things.
    pub fn is_uncoupled(&self) -> bool {
        self.coupling.amax() <= NOTHING * self.membrane.amax() * self.thickness
    }

    /// Whether A16 and A26 are zero: a pull does not shear.
    pub fn is_balanced(&self) -> bool {
        self.membrane[(0, 2)].abs().max(self.membrane[(1, 2)].abs()) <= NOTHING * self.membrane.amax()
    }

    /// (D16 + D26) over √(D11 D22), the larger of the two: how much a bent plate twists.
    pub fn bend_twist(&self) -> f64 {
        let d = &self.bending;
        d[(0, 2)].abs().max(d[(1, 2)].abs()) / (d[(0, 0)] * d[(1, 1)]).sqrt()
    }

    /// Forces, N/m, and moments, N, per length to strains and curvatures; not finite for plies without stiffness.
    fn compliance(&self) -> Matrix6<f64> {
        let mut all = Matrix6::zeros();
        all.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.membrane);
        all.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.coupling);
        all.fixed_view_mut::<3, 3>(3, 0).copy_from(&self.coupling);
        all.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.bending);
        all.try_inverse().unwrap_or_else(|| Matrix6::repeat(f64::NAN))
    }

    /// In-plane moduli, free to bend: Ex = 1/(h a11).
    pub fn in_plane(&self) -> PlaneModuli {
        self.moduli(0, self.thickness)
    }

    /// Flexural moduli, free to stretch: Ex = 12/(h³ d11).
    pub fn flexural(&self) -> PlaneModuli {
        self.moduli(3, self.thickness.powi(3) / 12.0)
    }

    fn moduli(&self, first: usize, size: f64) -> PlaneModuli {
        let s = self.compliance();
        let modulus = |i: usize| 1.0 / (size * s[(first + i, first + i)]);
        let nuxy = -s[(first, first + 1)] / s[(first, first)];
        PlaneModuli { ex: modulus(0), ey: modulus(1), gxy: modulus(2), nuxy }
    }

    /// What forces per length, N/m, and moments per length, N, make of it.
    pub fn strain(&self, forces: [f64; 3], moments: [f64; 3]) -> PlateStrain {
        let [n, m] = [forces, moments];
        let u = self.compliance() * Vector6::new(n[0], n[1], n[2], m[0], m[1], m[2]);
        PlateStrain { mid_plane: [u[0], u[1], u[2]], curvature: [u[3], u[4], u[5]] }
    }

    /// What one kelvin makes of it, nothing holding it.
    ///
    /// # Errors
    /// A ply's material has no thermal expansion.
    pub fn thermal_strain(&self, laminate: &Laminate, materials: &[Material]) -> Result<PlateStrain, MaterialError> {
        let [mut forces, mut moments] = [Vector3::zeros(); 2];
        for ((ply, q), z) in laminate.plies.iter().zip(&self.stiffnesses).zip(self.boundaries.windows(2)) {
            let [a1, a2, a3] = materials[ply.material].thermal_expansion()?;
            let free = apply(&strain_rotation(-ply.angle), &[a1, a2, a3, 0.0, 0.0, 0.0]);
            let stress = q * Vector3::from(PLANE.map(|i| free[i]));
            forces += stress * (z[1] - z[0]);
            moments += stress * (0.5 * (z[1].powi(2) - z[0].powi(2)));
        }
        Ok(self.strain(forces.into(), moments.into()))
    }

    /// Stresses of a ply at its lower and at its upper face, in its own axes, Pa.
    pub fn stresses(&self, ply: usize, strain: &PlateStrain) -> [Stress6<Ply>; 2] {
        [ply, ply + 1].map(|face| {
            let z = self.boundaries[face];
            let e = Vector3::from_fn(|i, _| strain.mid_plane[i] + z * strain.curvature[i]);
            let s = self.stiffnesses[ply] * e;
            Stress6::new([s[0], s[1], 0.0, s[2], 0.0, 0.0]).to_ply(self.angles[ply])
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plates::laminate::LaminaPly;
    use crate::words::material::{Elastic, Strengths, Toughnesses};

    fn material(elastic: Elastic, expansion: f64) -> Material {
        let (strengths, toughness) = (Strengths::default(), Toughnesses::default());
        let expansion = Some([expansion; 3]);
        Material { name: "m".into(), elastic, density: None, strengths, toughness, eta: None, expansion }
    }

    fn laminate(plies: &[(f64, usize)], thickness: f64) -> Laminate {
        let ply = |&(angle_deg, material): &(f64, usize)| LaminaPly {
            angle: f64::to_radians(angle_deg),
            angle_deg,
            thickness,
            material,
        };
        Laminate { plies: plies.iter().map(ply).collect(), layers: vec![plies.len()], middle: 0.0 }
    }

    fn near(got: &[f64], want: &[f64], tolerance: f64) {
        let size = want.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let close = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance * size;
        assert!(got.iter().zip(want).all(close), "{got:?}, not {want:?}");
    }

    /// Kaw, Mechanics of Composite Materials (2006), examples 4.2 and 4.3: graphite/epoxy [0/30/-45], plies of 5 mm, four digits.
    #[test]
    fn a_published_laminate() {
        let tape = material(Elastic::transversely_isotropic(181e9, 10.3e9, 0.28, 0.3, 7.17e9), 0.0);
        let plate = ClassicalLaminate::new(&laminate(&[(0.0, 0), (30.0, 0), (-45.0, 0)], 5e-3), &[tape]);
        let rows = |m: &Matrix3<f64>| [m[(0, 0)], m[(0, 1)], m[(0, 2)], m[(1, 1)], m[(1, 2)], m[(2, 2)]];
        near(&rows(&plate.membrane), &[1.739e9, 3.884e8, 5.663e7, 4.533e8, -1.141e8, 4.525e8], 5e-4);
        near(&rows(&plate.coupling), &[-3.129e6, 9.855e5, -1.072e6, 1.158e6, -1.072e6, 9.855e5], 5e-4);
        near(&rows(&plate.bending), &[3.343e4, 6.461e3, -5.240e3, 9.320e3, -5.596e3, 7.663e3], 5e-4);
        assert!(!plate.is_uncoupled() && !plate.is_balanced());
        let strain = plate.strain([1000.0, 1000.0, 0.0], [0.0; 3]);
        near(&strain.mid_plane, &[3.123e-7, 3.492e-6, -7.598e-7], 1e-3);
        near(&strain.curvature, &[2.971e-5, -3.285e-4, 4.101e-4], 1e-3);
    }

    /// Of isotropic plies: their own moduli; and the strip of two metals, κ = 3 Δα ΔT/(2 h) for equal moduli (Timoshenko 1925).
    #[test]
    fn isotropic_plies() {
        let metal = |expansion| material(Elastic::isotropic(70e9, 0.3), expansion);
        let (plies, metals) = (laminate(&[(20.0, 0), (-60.0, 1)], 1e-3), [metal(1e-5), metal(3e-5)]);
        let plate = ClassicalLaminate::new(&plies, &metals);
        for moduli in [plate.in_plane(), plate.flexural()] {
            near(&[moduli.ex, moduli.ey, moduli.gxy], &[70e9, 70e9, 70e9 / 2.6], 1e-12);
            assert!((moduli.nuxy - 0.3).abs() < 1e-12);
        }
        assert!(plate.is_uncoupled() && plate.is_balanced() && plate.bend_twist() < 1e-12);
        let warm = plate.thermal_strain(&plies, &metals).unwrap();
        near(&warm.mid_plane, &[2e-5, 2e-5, 0.0], 1e-12);
        near(&warm.curvature, &[1.5 * 2e-5 / 2e-3, 1.5 * 2e-5 / 2e-3, 0.0], 1e-12);
        // A moment bends a plate as a beam: σ = 6 M/h² at the faces.
        let [_, top] = plate.stresses(1, &plate.strain([0.0; 3], [1.0, 0.0, 0.0]));
        let [low, _] = plate.stresses(0, &plate.strain([0.0; 3], [1.0, 0.0, 0.0]));
        let along = |s: Stress6<Ply>, angle: f64| s.to_global(f64::to_radians(angle)).s11();
        near(&[along(top, -60.0), along(low, 20.0)], &[1.5e6, -1.5e6], 1e-12);
    }
}
