//! Laminates: plies from the bottom up, grouped into layers of cells.

use crate::contracts::element::{Slice, Stack};
use crate::plates::classical::ClassicalLaminate;
use crate::words::in_situ::Confined;
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
    /// z of its mid-plane, m: not 0 where regions of a plate are of different thickness and their mid-planes lie at different heights.
    pub middle: f64,
}

/// A face of layers of cells that lies inside a ply.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutPly {
    /// The laminate of the ply.
    pub laminate: usize,
    /// The ply, counted from its bottom.
    pub ply: usize,
    /// The laminate whose layers end there.
    pub by: usize,
    /// Thickness of the ply below and above the face, m.
    pub parts: [f64; 2],
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

    /// z of the ply boundaries from the bottom (−h/2 from the mid-plane) to the top (h/2): one more than plies.
    pub fn boundaries(&self) -> Vec<f64> {
        let h = self.thickness();
        let mut z = self.middle - 0.5 * h;
        let mut all = Vec::with_capacity(self.plies.len() + 1);
        all.push(z);
        for ply in &self.plies {
            z += ply.thickness;
            // A boundary that is the mid-plane but for rounding is the mid-plane.
            all.push(if z.abs() < SAME_HEIGHT * h { 0.0 } else { z });
        }
        if let Some(top) = all.last_mut() {
            let z = self.middle + 0.5 * h;
            *top = if z.abs() < SAME_HEIGHT * h { 0.0 } else { z };
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

    /// First and one past the last of a ply and those about it that are alike.
    pub fn alike(&self, ply: usize) -> std::ops::Range<usize> {
        let first = self.unlike().take_while(|below| *below <= ply).last().unwrap_or(0);
        let end = self.unlike().find(|below| *below > ply).unwrap_or(self.plies.len());
        first..end
    }

    /// Thickness of some plies, m.
    pub fn thickness_of(&self, plies: std::ops::Range<usize>) -> f64 {
        self.plies[plies].iter().map(|ply| ply.thickness).sum()
    }

    /// On how many faces a ply, with those about it that are alike, has others; nothing of a laminate of one angle.
    pub fn confined(&self, ply: usize) -> Option<Confined> {
        let (below, above) = (self.unlike().any(|below| below <= ply), self.unlike().any(|below| below > ply));
        match (below, above) {
            (false, false) => None,
            (true, true) => Some(Confined::OnBothFaces),
            _ => Some(Confined::OnOneFace),
        }
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
        self.stacks_between(&self.levels(), materials)
    }

    /// The same in cells whose faces lie at the heights `levels`, one more than layers: plies need not fill the cells of a shell.
    ///
    /// # Errors
    /// A ply's material has no density.
    pub fn stacks_between(&self, levels: &[f64], materials: &[Material]) -> Result<Vec<Stack>, MaterialError> {
        let z = self.boundaries();
        (0..self.layers.len())
            .map(|layer| {
                let (low, high) = (levels[layer], levels[layer + 1]);
                let range = self.plies_of(layer);
                let (first, end) = (range.start, range.end);
                let q = |i: usize| match i {
                    i if i == first && z[i] == low => -1.0,
                    i if i == end && z[i] == high => 1.0,
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
    /// let d = Laminate { plies: vec![ply], layers: vec![1], middle: 0.0 }.bending_stiffness(&[sheet]);
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

    /// Heights about z = 0 between which a shell holds the laminate: its reference surface is in the middle, wherever the plies lie.
    pub fn about_reference(&self) -> [f64; 2] {
        let z = self.boundaries();
        let reach = z[0].abs().max(z[z.len() - 1].abs());
        [-reach, reach]
    }

    /// Divides layers of `laminates` where those of others end, so that in regions side by side layers have their faces at the same
    /// heights as far as both reach.
    ///
    /// # Errors
    /// A face that lies inside a ply.
    pub fn share_levels(laminates: &mut [Self]) -> Result<(), CutPly> {
        let thickest = laminates.iter().map(Self::thickness).fold(0.0, f64::max);
        let same = |a: f64, b: f64| (a - b).abs() <= SAME_HEIGHT * thickest;
        let levels: Vec<Vec<f64>> = laminates.iter().map(Self::levels).collect();
        for (number, laminate) in laminates.iter_mut().enumerate() {
            let z = laminate.boundaries();
            let mut ends = vec![false; z.len()];
            let mut at = 0;
            laminate.layers.iter().for_each(|plies| {
                at += plies;
                ends[at] = true;
            });
            let of_others =
                levels.iter().enumerate().flat_map(|(by, levels)| levels.iter().map(move |level| (by, *level)));
            for (by, level) in of_others {
                if level < z[0] || level > z[z.len() - 1] || same(level, z[0]) || same(level, z[z.len() - 1]) {
                    continue;
                }
                let above = z.partition_point(|z| *z < level);
                match [above - 1, above].into_iter().find(|face| same(z[*face], level)) {
                    Some(face) => ends[face] = true,
                    None => {
                        let parts = [level - z[above - 1], z[above] - level];
                        return Err(CutPly { laminate: number, ply: above - 1, by, parts });
                    }
                }
            }
            let faces: Vec<usize> = (1..ends.len()).filter(|face| ends[*face]).collect();
            let starts = std::iter::once(&0).chain(&faces);
            laminate.layers = faces.iter().zip(starts).map(|(end, start)| end - start).collect();
        }
        Ok(())
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
        Laminate { plies: angles.iter().map(ply).collect(), layers: vec![angles.len()], middle: 0.0 }
    }

    #[test]
    fn alike_plies_are_one_thick_ply() {
        let plate = laminate(&[0.0, 0.0, 45.0, 90.0, 90.0, -90.0, 0.0]);
        let found: Vec<f64> = (0..7).map(|ply| 1e3 * plate.thickness_of(plate.alike(ply))).collect();
        let want = [2.0, 2.0, 1.0, 3.0, 3.0, 3.0, 1.0];
        assert!(found.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
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

    #[test]
    fn layers_are_divided_where_those_of_others_end() {
        let plies = |n: usize, layers: &[usize], middle: f64| Laminate {
            layers: layers.to_vec(),
            middle,
            ..laminate(&vec![0.0; n])
        };
        // Eight plies of 1 mm, and four of them that go on at the bottom.
        let mut both = [plies(8, &[3, 5], 0.0), plies(4, &[2, 2], -2e-3)];
        Laminate::share_levels(&mut both).unwrap();
        assert_eq!((&both[0].layers[..], &both[1].layers[..]), (&[2, 1, 1, 4][..], &[2, 1, 1][..]));
        assert_eq!(both[1].levels(), [-4e-3, -2e-3, -1e-3, 0.0]);
        // A face half a ply up cuts that ply.
        let cut = Laminate::share_levels(&mut [plies(8, &[8], 0.0), plies(4, &[4], 0.5e-3)]).unwrap_err();
        assert_eq!((cut.laminate, cut.ply, cut.by), (0, 2, 1));
        cut.parts.iter().for_each(|part| assert!((part - 0.5e-3).abs() < 1e-12));
        // Alike, nothing is divided.
        let mut alike = [plies(4, &[1, 3], 0.0), plies(4, &[1, 3], 0.0)];
        Laminate::share_levels(&mut alike).unwrap();
        assert_eq!(alike[0].layers, [1, 3]);
    }

    #[test]
    fn a_laminate_off_the_reference_bends_as_it_does_on_it() {
        let m = [material(Elastic::isotropic(70e9, 0.3))];
        let (on, off) = (laminate(&[0.0, 0.0]), Laminate { middle: 3e-3, ..laminate(&[0.0, 0.0]) });
        assert!(ClassicalLaminate::new(&off, &m).is_uncoupled());
        assert_eq!(off.about_reference(), [-4e-3, 4e-3]);
        let [d, also] = [on, off].map(|laminate| laminate.bending_stiffness(&m)[(0, 0)]);
        assert!((d / also - 1.0).abs() < 1e-12);
    }
}
