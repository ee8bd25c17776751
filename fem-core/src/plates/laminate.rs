//! Laminates: plies from the bottom up, grouped into layers of cells.

use crate::contracts::element::{Slice, Stack};
use crate::plates::classical::ClassicalLaminate;
use crate::words::material::{Material, MaterialError};
use crate::words::tensor::{apply, rotate_stiffness, strain_rotation};
use nalgebra::Matrix3;

/// One ply.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaminaPly {
    /// Fibre direction, radians from x towards y.
    pub angle: f64,
    /// The same in degrees, as written.
    pub angle_deg: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Index into the materials of the model.
    pub material: usize,
}

/// Plies from the bottom up, and how many of them each layer of cells holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Laminate {
    /// The plies.
    pub plies: Vec<LaminaPly>,
    /// Plies per layer of cells, from the bottom up; the sum is the number of plies.
    pub layers: Vec<usize>,
}

/// Heights that differ by less than this fraction of the thickness are one.
pub(crate) const SAME_HEIGHT: f64 = 1e-9;

/// Difference of two angles, radians, up to which plies are alike.
const ALIKE: f64 = 1e-6;

impl Laminate {
    /// Total thickness, m.
    pub fn thickness(&self) -> f64 {
        self.plies.iter().map(|p| p.thickness).sum()
    }

    /// z of the ply boundaries from the bottom (−h/2) to the top (h/2): one more than plies.
    pub fn boundaries(&self) -> Vec<f64> {
        let h = self.thickness();
        let mut z = -0.5 * h;
        let mut all = Vec::with_capacity(self.plies.len() + 1);
        all.push(z);
        for ply in &self.plies {
            z += ply.thickness;
            // A boundary that is the mid-plane but for rounding is the mid-plane.
            all.push(if z.abs() < SAME_HEIGHT * h { 0.0 } else { z });
        }
        if let Some(top) = all.last_mut() {
            *top = 0.5 * h;
        }
        all
    }

    /// Numbers of plies below each interface between plies of different angle or material.
    pub fn unlike(&self) -> impl Iterator<Item = usize> + '_ {
        let differ = |pair: &[LaminaPly]| {
            (pair[0].angle - pair[1].angle).sin().abs() > ALIKE || pair[0].material != pair[1].material
        };
        let pairs = (1..).zip(self.plies.windows(2));
        pairs.filter(move |(_, pair)| differ(pair)).map(|(below, _)| below)
    }

    /// First and one past the last ply of a layer.
    pub fn plies_of(&self, layer: usize) -> std::ops::Range<usize> {
        let first = self.layers[..layer].iter().sum();
        first..first + self.layers[layer]
    }

    /// z of the faces of the layers, from the bottom: one more than layers.
    pub fn levels(&self) -> Vec<f64> {
        let z = self.boundaries();
        let mut ply = 0;
        let mut levels = vec![z[0]];
        for n in &self.layers {
            ply += n;
            levels.push(z[ply]);
        }
        levels
    }

    /// The plies of each layer as its cells see them.
    ///
    /// # Errors
    /// A ply's material has no density.
    pub fn stacks(&self, materials: &[Material]) -> Result<Vec<Stack>, MaterialError> {
        let z = self.boundaries();
        let levels = self.levels();
        (0..self.layers.len())
            .map(|layer| {
                let (low, high) = (levels[layer], levels[layer + 1]);
                let range = self.plies_of(layer);
                let (first, end) = (range.start, range.end);
                let q = |i: usize| match i {
                    i if i == first => -1.0,
                    i if i == end => 1.0,
                    i => 2.0 * (z[i] - low) / (high - low) - 1.0,
                };
                let slice = |i: usize| {
                    let ply = &self.plies[i];
                    let material = &materials[ply.material];
                    Ok(Slice {
                        q: [q(i), q(i + 1)],
                        c: rotate_stiffness(&material.elastic.stiffness(), ply.angle),
                        density: material.mass_density()?,
                        free: [0.0; 6],
                    })
                };
                Ok(Stack::new(range.map(slice).collect::<Result<_, _>>()?))
            })
            .collect()
    }

    /// Gives the plies in `stacks`, those of [`Laminate::stacks`], the free strains of a change of temperature, K.
    ///
    /// # Errors
    /// A ply's material has no thermal expansion.
    pub fn heat(&self, stacks: &mut [Stack], materials: &[Material], change: f64) -> Result<(), MaterialError> {
        for (layer, stack) in stacks.iter_mut().enumerate() {
            for (ply, slice) in self.plies[self.plies_of(layer)].iter().zip(&mut stack.slices) {
                let [a1, a2, a3] = materials[ply.material].thermal_expansion()?.map(|a| a * change);
                slice.free = apply(&strain_rotation(-ply.angle), &[a1, a2, a3, 0.0, 0.0, 0.0]);
            }
        }
        Ok(())
    }

    /// Bending stiffness of classical laminate theory, N·m: moments 11, 22, 12 in the plate's axes per curvature, no force
    /// acting in the plane.
    ///
    /// D − B A⁻¹ B with (A, B, D) = Σ Q ∫ (1, z, z²) dz, where Q is a ply's stiffness without σ33 and B vanishes for
    /// symmetric laminates. Meaningful for materials that pass [`Material::check`].
    ///
    /// ```
    /// use fem_core::laminate::{LaminaPly, Laminate};
    /// use fem_core::material::{Elastic, Material, Strengths, Toughnesses};
    ///
    /// // One isotropic ply: E h³/12 (1 − ν²).
    /// let (e, nu, h) = (70e9, 0.3, 2e-3);
    /// let sheet = Material {
    ///     name: "sheet".into(),
    ///     elastic: Elastic::isotropic(e, nu),
    ///     density: None,
    ///     strengths: Strengths::default(),
    ///     toughness: Toughnesses::default(), eta: None,
    ///     expansion: None,
    /// };
    /// let ply = LaminaPly { angle: 0.0, angle_deg: 0.0, thickness: h, material: 0 };
    /// let d = Laminate { plies: vec![ply], layers: vec![1] }.bending_stiffness(&[sheet]);
    /// assert!((d[(0, 0)] / (e * h.powi(3) / 12.0 / (1.0 - nu * nu)) - 1.0).abs() < 1e-12);
    /// ```
    pub fn bending_stiffness(&self, materials: &[Material]) -> Matrix3<f64> {
        let plate = ClassicalLaminate::new(self, materials);
        let (a, b, d) = (plate.membrane, plate.coupling, plate.bending);
        d - b * a.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN)) * b
    }

    /// D* = √(D11 D22 (η + 1)/2) with η = (D12 + 2 D66)/√(D11 D22), N·m: bending stiffness of the isotropic plate that an
    /// orthotropic one resembles under a force at a point (Olsson 2000). D is [`Laminate::bending_stiffness`], whose D16 and D26
    /// do not count.
    pub fn effective_bending_stiffness(&self, materials: &[Material]) -> f64 {
        let d = self.bending_stiffness(materials);
        let root = (d[(0, 0)] * d[(1, 1)]).sqrt();
        let eta = (d[(0, 1)] + 2.0 * d[(2, 2)]) / root;
        root * (0.5 * (eta + 1.0)).sqrt()
    }

    /// Why a plate cannot have regions of this laminate and of `other`; nothing where it can. All faces of plies and layers must
    /// lie at the same heights, to 1e-9 of the thickness.
    pub fn disagreement(&self, other: &Self) -> Option<String> {
        let [mm, other_mm] = [self, other].map(|laminate| laminate.thickness() * 1e3);
        if (mm - other_mm).abs() > SAME_HEIGHT * mm {
            return Some(format!(
                "they are {mm:.6} and {other_mm:.6} mm thick; steps in thickness are not supported yet"
            ));
        }
        let (plies, others) = (self.plies.len(), other.plies.len());
        if plies != others {
            return Some(format!("they have {plies} and {others} plies"));
        }
        if self.layers != other.layers {
            return Some(format!("their layers of cells hold {:?} and {:?} plies", self.layers, other.layers));
        }
        let (z, others) = (self.boundaries(), other.boundaries());
        let apart = (1..z.len()).find(|k| (z[*k] - others[*k]).abs() * 1e3 > SAME_HEIGHT * mm)?;
        Some(format!("ply {apart} ends at {:.6} and {:.6} mm above the mid-plane", z[apart] * 1e3, others[apart] * 1e3))
    }

    /// Mass per area, kg/m².
    ///
    /// # Errors
    /// A ply's material has no density.
    pub fn areal_mass(&self, materials: &[Material]) -> Result<f64, MaterialError> {
        self.plies.iter().map(|p| Ok(p.thickness * materials[p.material].mass_density()?)).sum()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::words::material::{Elastic, Strengths, Toughnesses};

    fn material(elastic: Elastic) -> Material {
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

    fn laminate(angles: &[f64]) -> Laminate {
        let ply = |angle_deg: &f64| LaminaPly {
            angle: angle_deg.to_radians(),
            angle_deg: *angle_deg,
            thickness: 1e-3,
            material: 0,
        };
        Laminate { plies: angles.iter().map(ply).collect(), layers: vec![angles.len()] }
    }

    #[test]
    fn bending_stiffness_of_known_plates() {
        let close = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 1e-13, "{got}, not {want}");
        // E h³/12(1 − ν²), its ν-th and its (1 − ν)/2-th part.
        let plate = laminate(&[0.0, 0.0]).bending_stiffness(&[material(Elastic::isotropic(70e9, 0.3))]);
        let d = 70e9 * 8e-9 / (12.0 * (1.0 - 0.09));
        close(plate[(0, 0)], d);
        close(plate[(1, 0)], 0.3 * d);
        close(plate[(2, 2)], 0.35 * d);
        close(laminate(&[0.0, 30.0]).effective_bending_stiffness(&[material(Elastic::isotropic(70e9, 0.3))]), d);
        // [0/90], Q11 = 16, Q22 = 1, Q12 = 0 in units of q: A = 17 t q, B11 = −B22 = −15 t² q/2, D = 17 t³ q/3.
        let (e, t): (f64, f64) = (160e9, 1e-3);
        let tape = Elastic::transversely_isotropic(e, e / 16.0, 0.0, 0.0, e / 32.0);
        let unsymmetric = laminate(&[0.0, 90.0]).bending_stiffness(&[material(tape)]);
        let want = t.powi(3) * e / 16.0 * (17.0 / 3.0 - 7.5 * 7.5 / 17.0);
        close(unsymmetric[(0, 0)], want);
        close(unsymmetric[(1, 1)], want);
    }

    #[test]
    fn only_a_mass_needs_a_density() {
        let (plate, m) = (laminate(&[0.0]), [material(Elastic::isotropic(70e9, 0.3))]);
        assert!(plate.bending_stiffness(&m)[(0, 0)] > 0.0);
        assert!(plate.stacks(&m).unwrap_err().to_string().contains("`m`: the mass of the plate needs a density"));
        assert!(plate.areal_mass(&m).is_err());
        let [heavy] = m.map(|m| Material { density: Some(2700.0), ..m });
        assert_eq!(plate.areal_mass(std::slice::from_ref(&heavy)), Ok(2.7));
        assert_eq!(plate.stacks(&[heavy]).unwrap().len(), 1);
    }
}
