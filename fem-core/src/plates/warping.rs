//! What a plate theory leaves out: normals that warp resist being warped differently from place to place.

use crate::plates::laminate::Laminate;
use crate::words::material::Material;
use crate::words::quadrature::gauss_legendre;
use crate::words::tensor::rotate_stiffness;
use std::f64::consts::PI;

/// How much first-order shear deformation by equilibrium overestimates the deflection of a simply supported square of this
/// `side`, m, relative; about.
///
/// With plies alike in all directions, Q = U₁ (Tsai and Pagano's invariant) and 1/G the mean of both transverse shears, equilibrium
/// makes shear strains f V/G of a transverse force V, f(z) = −∫ Q z dz/D from the bottom up and z from the neutral plane; the energy
/// is that of H = 1/∫ f²/G dz. The normal warps by φ γ, φ′ = H f/G − 1, where φ stretches and bends nothing on the whole. Its
/// stiffness, left out, is D_w = ∫ Q φ² dz, and a wave k² = 2 π²/side² of the deflection meets H + D_w k² in place of H:
///
/// w = q/(D k⁴) (1 + D k²/(H + D_w k²)).
///
/// Of a homogeneous plate D_w is D/84; of thick faces on a soft core it is the bending of the faces by themselves.
pub fn shell_excess(laminate: &Laminate, materials: &[Material], side: f64) -> f64 {
    let faces = laminate.boundaries();
    let plies = || {
        laminate.plies.iter().zip(faces.windows(2)).map(|(ply, z)| {
            let elastic = &materials[ply.material].elastic;
            let c = rotate_stiffness(&elastic.stiffness(), ply.angle);
            let q = |i: usize, j: usize| c[i][j] - c[i][2] * c[2][j] / c[2][2];
            let u1 = (3.0 * (q(0, 0) + q(1, 1)) + 2.0 * q(0, 1) + 4.0 * q(3, 3)) / 8.0;
            (u1, 0.5 * (1.0 / elastic.g13 + 1.0 / elastic.g23), z[0], z[1])
        })
    };
    let sum = |of: &dyn Fn(f64) -> f64| plies().map(|(q, _, low, high)| q * (of(high) - of(low))).sum::<f64>();
    let stretch = sum(&|z| z);
    let middle = sum(&|z| 0.5 * z * z) / stretch;
    let bending = sum(&|z| (z - middle).powi(3) / 3.0);
    // Ply by ply from the bottom up: f and ∫ f/G, of unit H; means of f²/G, and of the warp and its products.
    let (mut f, mut warp) = (0.0, 0.0);
    let (mut compliance, mut samples) = (0.0, Vec::new());
    for (q, s, low, high) in plies() {
        let shear = |z: f64| f - q * 0.5 * ((z - middle).powi(2) - (low - middle).powi(2)) / bending;
        let between = |a: f64, b: f64, of: &dyn Fn(f64) -> f64| -> f64 {
            let half = 0.5 * (b - a);
            gauss_legendre(3).iter().map(|(t, w)| half * w * of(0.5 * (a + b) + half * t)).sum()
        };
        compliance += between(low, high, &|z| s * shear(z).powi(2));
        let half = 0.5 * (high - low);
        for (t, w) in gauss_legendre(4) {
            let z = 0.5 * (low + high) + half * t;
            samples.push((q * half * w, z - middle, warp + between(low, z, &|z| s * shear(z))));
        }
        warp += between(low, high, &|z| s * shear(z));
        f = shear(high);
    }
    let stiffness = 1.0 / compliance;
    // φ = H ∫ f/G − z without its parts that stretch and bend.
    let mean =
        |of: &dyn Fn(f64, f64) -> f64| samples.iter().map(|(q, z, w)| q * of(*z, stiffness * w - z)).sum::<f64>();
    let (shift, turn) = (mean(&|_, phi| phi) / stretch, mean(&|z, phi| z * phi) / bending);
    let warping = mean(&|z, phi| (phi - shift - turn * z).powi(2));
    let k2 = 2.0 * (PI / side).powi(2);
    let [shell, solid] = [stiffness, stiffness + warping * k2].map(|h| 1.0 + bending * k2 / h);
    shell / solid - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plates::laminate::LaminaPly;
    use crate::words::material::{Elastic, Strengths, Toughnesses};

    fn sheet(elastic: Elastic) -> Material {
        Material {
            name: "m".into(),
            elastic,
            density: None,
            strengths: Strengths::default(),
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
        }
    }

    fn plies(thickness: &[f64]) -> Laminate {
        let ply = |(material, t): (usize, &f64)| LaminaPly { angle: 0.3, angle_deg: 0.0, thickness: *t, material };
        Laminate { plies: thickness.iter().enumerate().map(ply).collect(), layers: vec![thickness.len()], middle: 0.0 }
    }

    /// φ = z/4 − 5 z³/(3 h²) of a homogeneous plate: ∫ φ² dz = h³/(12 · 84).
    #[test]
    fn a_homogeneous_plate() {
        let (e, nu, h, a) = (70e9, 0.3, 2e-3, 8e-3);
        let steel = sheet(Elastic::isotropic(e, nu));
        let (d, shear) = (e * h * h * h / 12.0 / (1.0 - nu * nu), 5.0 / 6.0 * e / 2.6 * h);
        let k2 = 2.0 * (PI / a).powi(2);
        let want = (1.0 + d * k2 / shear) / (1.0 + d * k2 / (shear + d / 84.0 * k2)) - 1.0;
        for parts in [vec![h], vec![0.3 * h, 0.5 * h, 0.2 * h]] {
            let all = vec![steel.clone(); parts.len()];
            let got = shell_excess(&plies(&parts), &all, a);
            assert!((got / want - 1.0).abs() < 1e-9, "{got} {want}");
        }
    }

    /// Thick faces on a core that hardly shears bend by themselves: two plates, in place of a shear stiffness of nothing.
    #[test]
    fn faces_on_a_soft_core() {
        let (face, core, a) = (1e-3, 4e-3, 20e-3);
        let materials = [
            sheet(Elastic::isotropic(70e9, 0.3)),
            sheet(Elastic::isotropic(1e6, 0.3)),
            sheet(Elastic::isotropic(70e9, 0.3)),
        ];
        let excess = shell_excess(&plies(&[face, core, face]), &materials, a);
        let q = 70e9 / (1.0 - 0.09);
        let (own, k2) = (2.0 * q * face.powi(3) / 12.0, 2.0 * (PI / a).powi(2));
        // Sandwich theory: G (c + t)²/c.
        let shear = 1e6 / 2.6 * (core + face).powi(2) / core;
        assert!((excess / (own * k2 / shear) - 1.0).abs() < 0.05, "{excess} {}", own * k2 / shear);
    }
}
