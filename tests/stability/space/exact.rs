//! Cylindrical bending of a strip of orthotropic layers in plane strain under sin(πx/a), exactly.
//!
//! With u = U cos px, w = W sin px, τ = T cos px, σz = Z sin px elasticity is a linear equation y′ = A y of
//! y = (U, W, T, Z) in each layer (Pagano 1969; Bahar 1975), which the exponential of A solves. T and Z are given at both
//! faces.

use fem::core::material::Elastic;

/// Thickness and the stiffnesses C₁₁, C₁₃, C₃₃, C₅₅ along and across the strip.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layer {
    pub(crate) thickness: f64,
    pub(crate) c: [f64; 4],
}

impl Layer {
    /// Fibres along the strip, or across where `turned`.
    pub(crate) fn new(thickness: f64, material: &Elastic, turned: bool) -> Self {
        let c = material.stiffness();
        let (along, shear) = if turned { (1, 4) } else { (0, 5) };
        Self { thickness, c: [c[along][along], c[along][2], c[2][2], c[shear][shear]] }
    }
}

type Square = [[f64; 4]; 4];

fn product(a: &Square, b: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

/// exp(A t) by scaling, Taylor's series and squaring.
fn exponential(a: &Square, t: f64) -> Square {
    const HALVINGS: i32 = 8;
    let unit: Square = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let step: Square = a.map(|row| row.map(|x| x * t * 0.5_f64.powi(HALVINGS)));
    let (mut sum, mut term) = (unit, unit);
    for k in 1..24 {
        term = product(&term, &step).map(|row| row.map(|x| x / f64::from(k)));
        sum.iter_mut().flatten().zip(term.iter().flatten()).for_each(|(s, t)| *s += t);
    }
    (0..HALVINGS).fold(sum, |x, _| product(&x, &x))
}

/// Amplitudes of w and σx at the bottom and the top of every layer, for σz = 1 at the top; `span` is a.
pub(crate) fn bending(layers: &[Layer], span: f64) -> Vec<[[f64; 2]; 2]> {
    let p = std::f64::consts::PI / span;
    // Stresses count in units of the stiffest layer.
    let unit = layers.iter().fold(0.0_f64, |m, l| m.max(l.c[0]));
    let strip = |l: &Layer| -> Square {
        let [c11, c13, c33, c55] = l.c.map(|c| c / unit);
        [
            [0.0, -p, 1.0 / c55, 0.0],
            [p * c13 / c33, 0.0, 0.0, 1.0 / c33],
            [p * p * (c11 - c13 * c13 / c33), 0.0, 0.0, -p * c13 / c33],
            [0.0, 0.0, p, 0.0],
        ]
    };
    let through: Vec<Square> = layers.iter().map(|l| exponential(&strip(l), l.thickness)).collect();
    let unit_matrix: Square = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let all = through.iter().fold(unit_matrix, |all, layer| product(layer, &all));
    // T = 0 and Z = 1 at the top from U and W at the bottom.
    let [[a, b], [c, d]] = [[all[2][0], all[2][1]], [all[3][0], all[3][1]]];
    let determinant = a * d - b * c;
    let mut y = [-b / unit / determinant, a / unit / determinant, 0.0, 0.0];
    let state = |l: &Layer, y: &[f64; 4]| {
        let [c11, c13, c33, _] = l.c;
        [y[1], -c11 * p * y[0] + c13 * (y[3] * unit + c13 * p * y[0]) / c33]
    };
    let mut found = Vec::new();
    for (layer, through) in layers.iter().zip(&through) {
        let next = std::array::from_fn(|i| (0..4).map(|k| through[i][k] * y[k]).sum());
        found.push([state(layer, &y), state(layer, &next)]);
        y = next;
    }
    found
}
