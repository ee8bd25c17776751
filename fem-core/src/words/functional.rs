//! Linear functionals of displacements.

/// A linear functional of the displacements, `d = Σ wᵢ uᵢ`: one dof, or the weighted mean over a contact patch.
///
/// ```
/// use fem_core::functional::Functional;
///
/// // The deflection under a patch that covers two unknowns, and the load of 10 N on that patch: their work agrees.
/// let patch = Functional(vec![(1, 0.25), (2, 0.75)]);
/// let (u, mut load) = ([0.0, 4e-3, 8e-3], [0.0; 3]);
/// patch.add_to(10.0, &mut load);
/// let work: f64 = load.iter().zip(&u).map(|(f, u)| f * u).sum();
/// assert!((patch.of(&u) - 7e-3).abs() < 1e-15 && (work - 10.0 * patch.of(&u)).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Functional(pub Vec<(usize, f64)>);

impl Functional {
    /// A single dof.
    pub fn dof(i: usize) -> Self {
        Self(vec![(i, 1.0)])
    }

    /// The functional's value at `u`.
    pub fn of(&self, u: &[f64]) -> f64 {
        self.0.iter().map(|&(i, w)| w * u[i]).sum()
    }

    /// `y ← y + scale · w`.
    pub fn add_to(&self, scale: f64, y: &mut [f64]) {
        for &(i, w) in &self.0 {
            y[i] += scale * w;
        }
    }
}
