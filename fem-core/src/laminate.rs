//! Laminates: plies from the bottom up, grouped into layers of cells.

use crate::element::{Slice, Stack};
use crate::material::{Material, MaterialError};
use crate::tensor::rotate_stiffness;

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
            all.push(if z.abs() < 1e-12 * h { 0.0 } else { z });
        }
        if let Some(top) = all.last_mut() {
            *top = 0.5 * h;
        }
        all
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
                    })
                };
                Ok(Stack::new(range.map(slice).collect::<Result<_, _>>()?))
            })
            .collect()
    }

    /// Mass per area, kg/m².
    ///
    /// # Errors
    /// A ply's material has no density.
    pub fn areal_mass(&self, materials: &[Material]) -> Result<f64, MaterialError> {
        self.plies.iter().map(|p| Ok(p.thickness * materials[p.material].mass_density()?)).sum()
    }
}
