//! The four modes: when they begin, how far they have gone.

use super::solid::{Damage, Solid};

/// Largest share that the energy stored at onset may have in what a crack takes: at 1 a point would break at once.
pub(super) const BRITTLE: f64 = 0.9;

/// Effective stresses: normal ones, and shears 12, 23, 13.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct State {
    pub(super) h: [f64; 3],
    pub(super) t: [f64; 3],
}

impl State {
    pub(super) fn between(&self, other: &Self, share: f64) -> Self {
        let mix = |a: &[f64; 3], b: &[f64; 3]| std::array::from_fn(|k| a[k] + share * (b[k] - a[k]));
        Self { h: mix(&self.h, &other.h), t: mix(&self.t, &other.t) }
    }

    /// What decides between tension and compression of the matrix.
    pub(super) fn pull(&self) -> f64 {
        self.h[1] + self.h[2]
    }
}

/// Derivatives with respect to h and t.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Slope {
    pub(super) by_h: [f64; 3],
    pub(super) by_t: [f64; 3],
}

/// How the matrix breaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Matrix {
    /// Not at all.
    Sound,
    /// In tension and compression, by cracks of every direction.
    Cracks,
    /// In tension, by cracks along the fibres and through the thickness of the ply.
    Splits,
}

/// Strengths and toughnesses at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Modes {
    pub(super) solid: Solid,
    /// Xt, Xc, Yt, Yc.
    pub(super) strength: [f64; 4],
    /// Shear strengths along and across the fibres.
    pub(super) shear: [f64; 2],
    /// L/G of each mode for normal stresses, and for shears.
    pub(super) soft: [f64; 4],
    pub(super) soft_shear: [f64; 4],
    pub(super) matrix: Matrix,
    /// Share of the shears 12, 23, 13 that cracks of the matrix take at most.
    pub(super) cracked: [f64; 3],
    /// Those of the ply in its cell; none at a point alone.
    pub(super) fibres: Option<Fibres>,
}

/// What decides of the fibres of a cell, where they pull and where they press.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fibres {
    /// Root mean squares of h1.
    pub(super) along: [f64; 2],
    /// Mean square over the volume by that of h1.
    pub(super) even: [f64; 2],
}

impl Fibres {
    /// From mean squares over the volume, and over the faces that decide, if they do.
    pub(super) fn new(means: &[f64]) -> Option<Self> {
        let (volume, decide): (&[f64; 2], &[f64; 2]) = (means.first_chunk()?, means.last_chunk()?);
        let even = |mode: usize| if decide[mode] > 0.0 { volume[mode] / decide[mode] } else { 1.0 };
        Some(Self { along: decide.map(f64::sqrt), even: [even(0), even(1)] })
    }
}

impl Modes {
    /// Whether a mode's damage is one of its cell and not of the point.
    fn of_cell(&self, mode: usize) -> Option<f64> {
        self.fibres.and_then(|fibres| fibres.along.get(mode).copied())
    }

    /// The damage that a point begins a step with: that of before, and of fibres what their cell asks for.
    pub(super) fn begun(&self, before: &Damage) -> Damage {
        std::array::from_fn(|mode| match self.of_cell(mode) {
            Some(_) => self.target(mode, &State::default()).max(before[mode]),
            None => before[mode],
        })
    }

    /// Whether the damage of a mode follows the strain of the point.
    pub(super) fn follows(&self, mode: usize) -> bool {
        self.of_cell(mode).is_none()
    }

    /// The fibre's and the matrix's mode.
    pub(super) fn of(&self, s: &State) -> [usize; 2] {
        let pressed = self.matrix != Matrix::Splits && s.pull() < 0.0;
        [usize::from(s.h[0] < 0.0), 2 + usize::from(pressed)]
    }

    /// How much of its strength a mode has used: 1 at onset, of degree 1 in the stresses.
    pub(super) fn exposure(&self, mode: usize, s: &State) -> f64 {
        if let Some(along) = self.of_cell(mode) {
            return along / self.strength[mode];
        }
        match mode {
            0 => s.h[0] / self.strength[0],
            1 => -s.h[0] / self.strength[1],
            _ if self.matrix == Matrix::Sound => 0.0,
            _ if self.matrix == Matrix::Splits => {
                let pull = s.h[1].max(0.0) / self.strength[2];
                let [along, across] = self.shear;
                let used =
                    if mode == 2 { pull * pull + (s.t[0] / along).powi(2) + (s.t[1] / across).powi(2) } else { 0.0 };
                used.sqrt()
            }
            2 => {
                let pull = s.pull() / self.strength[2];
                (pull * pull + self.shears(s)).sqrt()
            }
            _ => {
                let (b, root) = self.pressed(s);
                // Nothing where there is no root.
                if root > -b { 0.5 * (b + root) } else { 0.0 }
            }
        }
    }

    /// What shears of the matrix, along and across the fibres, have used of their strengths, squared.
    fn shears(&self, s: &State) -> f64 {
        let ([_, h2, h3], [t12, t23, t13], [along, across]) = (s.h, s.t, self.shear);
        (t12 * t12 + t13 * t13) / (along * along) + (t23 * t23 - h2 * h3) / (across * across)
    }

    /// b and √(b² + 4a) of the exposure under compression.
    fn pressed(&self, s: &State) -> (f64, f64) {
        let (u, st) = (s.pull(), self.shear[1]);
        let (half, ratio) = (u / (2.0 * st), self.strength[3] / (2.0 * st));
        let b = (ratio * ratio - 1.0) * u / self.strength[3];
        (b, (b * b + 4.0 * (half * half + self.shears(s))).sqrt())
    }

    /// The derivatives of an exposure with respect to h and t; `e` is the exposure.
    fn slope(&self, mode: usize, s: &State, e: f64) -> Slope {
        if mode < 2 {
            let sign = if mode == 0 { 1.0 } else { -1.0 };
            return Slope { by_h: [sign / self.strength[mode], 0.0, 0.0], by_t: [0.0; 3] };
        }
        let ([_, h2, h3], [t12, t23, t13], u) = (s.h, s.t, s.pull());
        let [along, across] = self.shear.map(|s| 1.0 / (s * s));
        if self.matrix == Matrix::Splits {
            let by_pull = h2.max(0.0) / (self.strength[2] * self.strength[2] * e);
            return Slope { by_h: [0.0, by_pull, 0.0], by_t: [t12 * along / e, t23 * across / e, 0.0] };
        }
        // Of half the squares of shears, and of the pull.
        let (of_shears, of_pull) = if mode == 2 {
            (1.0 / e, u / (self.strength[2] * self.strength[2] * e))
        } else {
            let (b, root) = self.pressed(s);
            let by_u = (0.25 * across * self.strength[3] * self.strength[3] - 1.0) / self.strength[3];
            (2.0 / root, 0.5 * by_u * (1.0 + b / root) + 0.5 * u * across / root)
        };
        Slope {
            by_h: [0.0, of_pull - 0.5 * of_shears * h3 * across, of_pull - 0.5 * of_shears * h2 * across],
            by_t: [t12 * along, t23 * across, t13 * along].map(|v| of_shears * v),
        }
    }

    /// The energy that a mode's crack releases, undamaged: of normal stresses, and of shears; J/m³.
    pub(super) fn released(&self, mode: usize, s: &State) -> [f64; 2] {
        let normal = |i: usize| {
            let of_mode = if compresses(mode) { s.h[i] < 0.0 } else { s.h[i] > 0.0 };
            if of_mode { self.solid.opened[i] * 0.5 * s.h[i] * s.h[i] / self.solid.e[i] } else { 0.0 }
        };
        if mode < 2 {
            return [normal(0), 0.0];
        }
        [normal(1) + normal(2), self.relieved(s, &self.cracked)]
    }

    /// What damages leave of each shear.
    pub(super) fn shears_left(&self, damage: &Damage) -> [f64; 3] {
        match self.matrix {
            Matrix::Sound => [1.0; 3],
            Matrix::Cracks => [damage.iter().map(|d| 1.0 - d).product(); 3],
            Matrix::Splits => self.cracked.map(|share| 1.0 - share * damage[2]),
        }
    }

    /// What the damage of a mode takes of each shear, by its amount.
    pub(super) fn takes(&self, damage: &Damage, mode: usize) -> [f64; 3] {
        match self.matrix {
            Matrix::Cracks => [(0..4).filter(|k| *k != mode).map(|k| 1.0 - damage[k]).product(); 3],
            Matrix::Splits if mode == 2 => self.cracked,
            _ => [0.0; 3],
        }
    }

    /// Energy of shares of the effective shears, J/m³.
    pub(super) fn relieved(&self, s: &State, shares: &[f64; 3]) -> f64 {
        (0..3).map(|k| shares[k] * 0.5 * s.t[k] * s.t[k] / self.solid.g[k]).sum()
    }

    /// κ: energy at onset over that of the crack, by the mix of the stresses.
    pub(super) fn brittleness(&self, mode: usize, s: &State, exposure: f64) -> f64 {
        if let Some(even) = self.fibres.and_then(|fibres| fibres.even.get(mode).copied()) {
            return (self.soft[mode] * even * 0.5 * self.strength[mode].powi(2) / self.solid.e[0]).min(BRITTLE);
        }
        let [normal, sheared] = self.released(mode, s);
        let kappa = (self.soft[mode] * normal + self.soft_shear[mode] * sheared) / (exposure * exposure);
        if kappa > BRITTLE { BRITTLE } else { kappa }
    }

    /// Damage that a mode's stresses ask for, from 0 at onset to 1 at e = 1/κ.
    pub(super) fn target(&self, mode: usize, s: &State) -> f64 {
        let e = self.exposure(mode, s);
        if e <= 1.0 {
            return 0.0;
        }
        let reach = damage_at(e, self.brittleness(mode, s, e));
        if reach > 1.0 { 1.0 } else { reach }
    }

    /// The derivatives of a target.
    pub(super) fn target_slope(&self, mode: usize, s: &State) -> Slope {
        let e = self.exposure(mode, s);
        let kappa = self.brittleness(mode, s, e);
        let reach = damage_at(e, kappa);
        if reach >= 1.0 {
            return Slope::default();
        }
        let Slope { mut by_h, mut by_t } = self.slope(mode, s, e);
        // ∂κ = κ (∂w/w − 2 ∂e/e), none at the bound.
        let (by_kappa, mut by_e) = (reach / (1.0 - kappa), 1.0 / (e * e * (1.0 - kappa)));
        let bounded = kappa >= BRITTLE;
        if !bounded {
            by_e -= 2.0 * by_kappa * kappa / e;
        }
        by_h.iter_mut().chain(&mut by_t).for_each(|slope| *slope *= by_e);
        if !bounded {
            let over = by_kappa / (e * e);
            for i in if mode < 2 { 0..1 } else { 1..3 } {
                if (s.h[i] < 0.0) == compresses(mode) {
                    by_h[i] += over * self.solid.opened[i] * self.soft[mode] * s.h[i] / self.solid.e[i];
                }
            }
            if mode >= 2 {
                let soft = over * self.soft_shear[mode];
                for (k, by) in by_t.iter_mut().enumerate() {
                    *by += soft * self.cracked[k] * s.t[k] / self.solid.g[k];
                }
            }
        }
        Slope { by_h, by_t }
    }
}

/// Whether a mode is one of compression.
fn compresses(mode: usize) -> bool {
    mode % 2 == 1
}

/// Damage at an exposure.
pub(super) fn damage_at(exposure: f64, kappa: f64) -> f64 {
    (exposure - 1.0) / (exposure * (1.0 - kappa))
}

/// Exposure at which a damage is reached.
pub(super) fn exposure_at(damage: f64, kappa: f64) -> f64 {
    1.0 / (1.0 - damage * (1.0 - kappa))
}
