//! Residual stresses of a laminate that has cooled down from its cure.

use crate::plates::laminate::Laminate;
use crate::words::material::{Material, MaterialError};
use crate::words::tensor::{Ply, Stress6, strain_rotation};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// Rows of the tensor order that lie in the plane: 11 22 12.
const PLANE: [usize; 3] = [0, 1, 3];

/// The state of a free laminate after a change of temperature, far from its edges.
///
/// Classical lamination theory: \[A B; B D\] (ε⁰, κ) = ∫ Q̄ ᾱ ΔT (1, z) dz, σ = Q̄ (ε⁰ + z κ − ᾱ ΔT) (Jones, Mechanics of
/// Composite Materials, 2nd ed. (1999), section 4.5). Exact for a free plate but for a border about as wide as the plate is
/// thick; between plies there are no stresses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Strains 11, 22, 12 of the plane z = 0 in the plate's frame.
    pub strain: [f64; 3],
    /// Curvatures 11, 22, 12, 1/m: what an unsymmetric laminate warps by.
    pub curvature: [f64; 3],
    /// Change of temperature, K.
    pub change: f64,
}

impl Residual {
    /// Of a laminate without stresses before its temperature changed by `change`, K.
    ///
    /// # Errors
    /// A material without thermal expansion.
    pub fn new(laminate: &Laminate, materials: &[Material], change: f64) -> Result<Self, MaterialError> {
        let mut stiffness = SMatrix::<f64, 6, 6>::zeros();
        let mut load = SVector::<f64, 6>::zeros();
        for (ply, z) in laminate.plies.iter().zip(laminate.boundaries().windows(2)) {
            let material = &materials[ply.material];
            let turn = in_plane(ply.angle);
            let q = turn.transpose() * material.elastic.plane_stiffness() * turn;
            let free = turn.transpose() * material.elastic.plane_stiffness() * free(material, change)?;
            let moment = |p: i32| (z[1].powi(p) - z[0].powi(p)) / f64::from(p);
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let mut block = stiffness.fixed_view_mut::<3, 3>(3 * i, 3 * j);
                block += q * moment((i + j) as i32 + 1);
            }
            for i in [0, 1] {
                let mut part = load.fixed_rows_mut::<3>(3 * i);
                part += free * moment(i as i32 + 1);
            }
        }
        let found = stiffness.lu().solve(&load).unwrap_or_else(|| SVector::repeat(f64::NAN));
        let part = |from: usize| [found[from], found[from + 1], found[from + 2]];
        Ok(Self { strain: part(0), curvature: part(3), change })
    }

    /// Stress at height `z`, m, of a layer at `angle`, in its own frame, Pa. A layer may be there that the laminate does not
    /// count, such as the resin between two plies.
    ///
    /// # Errors
    /// A material without thermal expansion.
    pub fn stress(&self, material: &Material, angle: f64, z: f64) -> Result<Stress6<Ply>, MaterialError> {
        let strain = Vector3::from(self.strain) + Vector3::from(self.curvature) * z;
        let mechanical = in_plane(angle) * strain - free(material, self.change)?;
        let s = material.elastic.plane_stiffness() * mechanical;
        Ok(Stress6::new([s[0], s[1], 0.0, s[2], 0.0, 0.0]))
    }
}

/// Strains 11, 22, 12 of a ply at `angle` from those of the plate.
fn in_plane(angle: f64) -> Matrix3<f64> {
    let turn = strain_rotation(angle);
    Matrix3::from_fn(|i, j| turn[PLANE[i]][PLANE[j]])
}

/// Free strains 11, 22, 12 in the material's axes.
fn free(material: &Material, change: f64) -> Result<Vector3<f64>, MaterialError> {
    let [first, second, _] = material.thermal_expansion()?;
    Ok(Vector3::new(first, second, 0.0) * change)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plates::laminate::LaminaPly;
    use crate::words::material::{Elastic, Strengths, Toughnesses};

    fn material(elastic: Elastic, expansion: [f64; 3]) -> Material {
        let (strengths, expansion) = (Strengths::default(), Some(expansion));
        Material {
            name: "m".into(),
            elastic,
            density: None,
            strengths,
            toughness: Toughnesses::default(),
            eta: None,
            expansion,
        }
    }

    fn laminate(plies: &[(f64, usize)], thickness: f64) -> Laminate {
        let ply = |(angle_deg, material): &(f64, usize)| LaminaPly {
            angle: angle_deg.to_radians(),
            angle_deg: *angle_deg,
            thickness,
            material: *material,
        };
        Laminate { plies: plies.iter().map(ply).collect(), layers: vec![plies.len()], middle: 0.0 }
    }

    /// Timoshenko's bimetal of equal thicknesses, J. Opt. Soc. Am. 11 (1925) 233-255: κ = 24 Δα ΔT / (h (14 + n + 1/n)),
    /// h the whole thickness, n = E₁/E₂; a plate with one Poisson's ratio bends like the strip, to a sphere.
    #[test]
    fn a_bimetal_bends() {
        let [low, high] = [(70e9, 23e-6), (210e9, 12e-6)].map(|(e, a)| material(Elastic::isotropic(e, 0.3), [a; 3]));
        let t = 1e-3;
        let found = Residual::new(&laminate(&[(0.0, 0), (0.0, 1)], t), &[low, high], 100.0).unwrap();
        let n: f64 = 70.0 / 210.0;
        // The lower metal grows more: the plate becomes longer below, κ = ∂ε/∂z < 0.
        let want = -24.0 * (23e-6 - 12e-6) * 100.0 / (2.0 * t * (14.0 + n + 1.0 / n));
        for k in [0, 1] {
            assert!((found.curvature[k] / want - 1.0).abs() < 1e-12, "{found:?}, not {want}");
        }
        assert!(found.curvature[2].abs() < 1e-12 * want.abs());
    }

    /// [0/90]s with ν₁₂ = 0: strain (E₁ α₁ + E₂ α₂) ΔT / (E₁ + E₂) both ways, σ₂ = E₂ (ε − α₂ ΔT), σ₁ = −σ₂.
    #[test]
    fn cross_plies_hold_each_other() {
        let (e1, e2, a1, a2, change) = (140e9, 10e9, -1e-6, 26e-6, -150.0);
        let tape = material(Elastic::transversely_isotropic(e1, e2, 0.0, 0.3, 5e9), [a1, a2, a2]);
        let plies = [(0.0, 0), (90.0, 0), (90.0, 0), (0.0, 0)];
        let found = Residual::new(&laminate(&plies, 1e-4), std::slice::from_ref(&tape), change).unwrap();
        let strain = (e1 * a1 + e2 * a2) / (e1 + e2) * change;
        assert!((found.strain[0] / strain - 1.0).abs() < 1e-13 && (found.strain[1] / strain - 1.0).abs() < 1e-13);
        let across = e2 * (strain - a2 * change);
        for angle in [0.0, 90.0_f64] {
            let s = found.stress(&tape, angle.to_radians(), 0.5e-4).unwrap();
            assert!((s.s22() / across - 1.0).abs() < 1e-12 && (s.s11() / -across - 1.0).abs() < 1e-11, "{s:?}");
        }
        assert!(across > 30e6, "{across:e}");
    }

    /// Any laminate: no force and no moment is left.
    #[test]
    fn residual_stresses_are_in_equilibrium_with_themselves() {
        let tape = material(Elastic::transversely_isotropic(130e9, 9e9, 0.35, 0.4, 6e9), [-1e-6, 26e-6, 26e-6]);
        let laminate = laminate(&[(0.0, 0), (45.0, 0), (90.0, 0), (-30.0, 0)], 1e-4);
        let found = Residual::new(&laminate, std::slice::from_ref(&tape), -100.0).unwrap();
        let mut sums = [0.0; 6];
        for (ply, z) in laminate.plies.iter().zip(laminate.boundaries().windows(2)) {
            // Linear in z: Simpson's rule is exact.
            for (z, w) in [(z[0], 1.0), (0.5 * (z[0] + z[1]), 4.0), (z[1], 1.0)] {
                let s = found.stress(&tape, ply.angle, z).unwrap().to_global(ply.angle);
                for (k, s) in [s.s11(), s.s22(), s.s12()].into_iter().enumerate() {
                    sums[k] += w * s;
                    sums[3 + k] += w * s * z / 1e-4;
                }
            }
        }
        assert!(sums.iter().all(|sum| sum.abs() < 1e-6 * 30e6), "{sums:?}");
    }

    #[test]
    fn a_material_must_say_how_it_expands() {
        let silent = Material { expansion: None, ..material(Elastic::isotropic(1e9, 0.3), [0.0; 3]) };
        let error = Residual::new(&laminate(&[(0.0, 0)], 1e-3), &[silent], 1.0).unwrap_err().to_string();
        assert!(error.contains("`m`") && error.contains("expansion"), "{error}");
    }
}
