//! Hahn and Tsai's curve of a ply in shear, γ = τ/G + α τ³.

/// τ at γ of the curve: with k = 2/√(3 α G), τ = k sinh(⅓ arsinh(3 G γ / k)).
pub(super) fn on_curve(alpha: f64, g: f64, strain: f64) -> f64 {
    let k = 2.0 / (3.0 * alpha * g).sqrt();
    k * ((3.0 * g * strain / k).asinh() / 3.0).sinh()
}

/// ∫ τ d(α τ³) up to a length of the permanent strain's way.
pub(super) fn lost(alpha: f64, way: f64) -> f64 {
    0.75 * way * (way / alpha).cbrt()
}
