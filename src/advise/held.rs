//! How the edge of a plate is held, and what follows from that.

/// How the edge of a plate is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Held {
    /// Its slope across the edge: clamped, else simply supported.
    pub slope: bool,
    /// Its displacement in the plane across the edge: immovable, else movable.
    pub in_plane: bool,
}

impl Held {
    /// A of a circular plate under a central load: Km = A Kb/h², so that the force of a linear plate is wrong by A (w/h)²
    /// (Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells; ν = 0.3).
    pub const fn coefficient(self) -> f64 {
        match (self.slope, self.in_plane) {
            (true, true) => 0.443,
            (true, false) => 0.200,
            (false, true) => 1.430,
            (false, false) => 0.272,
        }
    }

    /// The same beside the share of its buckling load that a plate carries already, if it is one: that takes as much of Kb and nothing of Km.
    pub fn coefficient_beside(self, buckling: Option<f64>) -> f64 {
        self.coefficient() / (1.0 - buckling.unwrap_or(0.0).max(0.0))
    }

    /// Kb of a circle of radius a under a force in its middle, N/m: 16 π D/a², for a simple support times (1 + ν)/(3 + ν).
    pub fn circle_stiffness(self, bending_stiffness: f64, poisson: f64, radius: f64) -> f64 {
        let clamped = 16.0 * std::f64::consts::PI * bending_stiffness / (radius * radius);
        if self.slope { clamped } else { clamped * (1.0 + poisson) / (3.0 + poisson) }
    }

    /// λ² of the third axisymmetric mode of a circle, ω = λ²/a² √(D/m): the third root of J₀ I₁ + J₁ I₀ = 0 where the edge is
    /// clamped, of J₁/J₀ + I₁/I₀ = 2 λ/(1 − ν) where it is supported, ν = 0.3.
    pub(super) const fn third_mode(self) -> f64 {
        if self.slope { 89.104 } else { 74.156 }
    }

    /// In words.
    pub const fn name(self) -> &'static str {
        match (self.slope, self.in_plane) {
            (true, true) => "clamped, immovable in plane",
            (true, false) => "clamped, movable in plane",
            (false, true) => "simply supported, immovable in plane",
            (false, false) => "simply supported, movable in plane",
        }
    }
}
