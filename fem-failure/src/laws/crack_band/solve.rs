//! The damage that a strain leaves, its tangent and what it releases.

use super::SHEARS;
use super::modes::{Modes, Slope, State, damage_at, exposure_at};
use super::solid::{Damage, Effective, Matrix3, invert, multiply};
use fem_core::tensor::Matrix6;

/// Iterations of Newton's method, and of those that only let damage grow and so must end.
const NEWTON: usize = 50;
const GROWING: usize = 200;
/// How often the matrix may turn from tension to compression or back before both of its modes are taken.
const TURNS: usize = 3;
/// Error of a damage.
const EXACT: f64 = 1e-13;

/// A mode whose damage follows the strain: what is wanted of it with its derivatives, and ∂h by its damage.
#[derive(Debug, Clone, Copy)]
struct Follows {
    mode: usize,
    target: f64,
    slope: Slope,
    moves: [f64; 3],
}

/// A damage with the effective stresses that ask for it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub(super) damage: Damage,
    pub(super) effective: Effective,
    t: [f64; 3],
    /// The modes whose damage follows the strain: one of the fibres, one or both of the matrix.
    follows: [Option<Follows>; 3],
}

impl Found {
    /// Solves d = max(d of before, target(h(d), t)); what fibres have lost comes with `before` where it is one of their cell.
    pub(super) fn new(modes: &Modes, strain: &[f64; 3], t: [f64; 3], before: &Damage, stiffness: &Matrix6) -> Self {
        if *before == [0.0; 4] {
            let effective = modes.solid.sound(strain, stiffness);
            let state = State { h: effective.h, t };
            if modes.of(&state).iter().all(|mode| modes.exposure(*mode, &state) <= 1.0) {
                return Self { damage: *before, effective, t, follows: [None; 3] };
            }
        }
        let mut found = Self::at(modes, strain, t, *before, before, stiffness, false);
        let mut turns = 0;
        for iteration in 0..NEWTON + GROWING {
            let wanted = found.wanted(before);
            let missed = (0..4).fold(0.0_f64, |m, k| m.max((wanted[k] - found.damage[k]).abs()));
            // What is no number ends here too.
            if !(missed > EXACT) {
                break;
            }
            let damage = if iteration < NEWTON {
                found.improved(&wanted, before)
            } else {
                std::array::from_fn(|k| wanted[k].max(found.damage[k]))
            };
            let next = Self::at(modes, strain, t, damage, before, stiffness, turns >= TURNS);
            turns += usize::from(modes.of(&next.state())[1] != modes.of(&found.state())[1]);
            found = next;
        }
        found
    }

    fn at(
        modes: &Modes,
        strain: &[f64; 3],
        t: [f64; 3],
        damage: Damage,
        before: &Damage,
        stiffness: &Matrix6,
        both: bool,
    ) -> Self {
        let effective = modes.solid.effective(strain, &damage, stiffness);
        let state = State { h: effective.h, t };
        let [fibre, matrix] = modes.of(&state);
        let follows = [Some(fibre), Some(matrix), both.then_some(5 - matrix)].map(|mode| {
            let mode = mode.filter(|mode| modes.follows(*mode))?;
            let target = if before[mode] < 1.0 { modes.target(mode, &state) } else { 0.0 };
            // A point that has just been damaged is taken to go on.
            (target >= before[mode] - EXACT && target > 0.0).then(|| Follows {
                mode,
                target,
                slope: modes.target_slope(mode, &state),
                moves: effective.slope(&modes.solid, mode),
            })
        });
        Self { damage, effective, t, follows }
    }

    pub(super) fn state(&self) -> State {
        State { h: self.effective.h, t: self.t }
    }

    fn wanted(&self, before: &Damage) -> Damage {
        let mut wanted = *before;
        for one in self.follows.iter().flatten() {
            wanted[one.mode] = one.target.max(before[one.mode]);
        }
        wanted
    }

    /// (I − ∂target/∂d)⁻¹ of the modes that follow.
    fn through(&self) -> Matrix3 {
        let slope = |k: usize, l: usize| match (&self.follows[k], &self.follows[l]) {
            (Some(one), Some(other)) => (0..3).map(|i| one.slope.by_h[i] * other.moves[i]).sum(),
            _ => 0.0,
        };
        invert(&std::array::from_fn(|k| std::array::from_fn(|l| if k == l { 1.0 } else { 0.0 } - slope(k, l))))
    }

    /// Newton's next damage.
    fn improved(&self, wanted: &Damage, before: &Damage) -> Damage {
        let right = self.follows.map(|one| one.map_or(0.0, |one| wanted[one.mode] - self.damage[one.mode]));
        let steps = multiply(&self.through(), &right);
        let mut next = *wanted;
        for (one, step) in self.follows.iter().zip(steps) {
            if let Some(Follows { mode, .. }) = *one {
                next[mode] = (self.damage[mode] + step).clamp(before[mode], 1.0);
            }
        }
        next
    }

    /// ∂σ/∂ε; `left` is what all damages leave of each shear, `sheared` the tangent of the effective shears 12 and 13.
    pub(super) fn tangent(&self, modes: &Modes, left: &[f64; 3], sheared: &[[f64; 2]; 2]) -> Matrix6 {
        let Effective { h, by, left: normal, inverse } = self.effective;
        let solid = &modes.solid;
        let (mut tangent, through) = ([[0.0; 6]; 6], self.through());
        let takes: [[f64; 3]; 4] = std::array::from_fn(|mode| modes.takes(&self.damage, mode));
        for j in 0..6 {
            // Effective stresses at a fixed damage.
            let mut direct: [f64; 3] = if j < 3 { inverse.map(|row| row[j] * solid.e[j]) } else { [0.0; 3] };
            let shears = match j {
                3 => [sheared[0][0], 0.0, sheared[1][0]],
                4 => [0.0, solid.g[1], 0.0],
                5 => [sheared[0][1], 0.0, sheared[1][1]],
                _ => [0.0; 3],
            };
            let right = self.follows.map(|one| {
                let by = |Follows { slope, .. }: Follows| {
                    (0..3).map(|i| slope.by_h[i] * direct[i] + slope.by_t[i] * shears[i]).sum()
                };
                one.map_or(0.0, by)
            });
            let grown = multiply(&through, &right);
            let mut damaged = [0.0; 4];
            for (one, grown) in self.follows.iter().zip(grown) {
                if let Some(Follows { mode, moves, .. }) = one {
                    damaged[*mode] = grown;
                    (0..3).for_each(|i| direct[i] += moves[i] * grown);
                }
            }
            for i in 0..3 {
                tangent[i][j] = normal[i] * direct[i] - solid.opened[i] * h[i] * damaged[by[i]];
            }
            for (k, row) in SHEARS.into_iter().enumerate() {
                let lost: f64 = (0..4).map(|mode| damaged[mode] * takes[mode][k]).sum();
                tangent[row][j] = left[k] * shears[k] - self.t[k] * lost;
            }
        }
        tangent
    }
}

/// Energy that the damage of each mode releases between two states, ∫ Y dd, J/m³.
///
/// Y = y e² with the mix of the stresses half-way, and e from that of the old damage to that of the new one: exact for one mode at a
/// fixed mix. What fibres of a cell lose as one is released by the stresses at the end, which those of the cell are a mean of: exact in
/// the sum over the cell. Where the matrix turns from tension to compression or back, its other damage begins at once, at the exposure there.
pub(super) fn released(modes: &Modes, damage: [&Damage; 2], states: [&State; 2]) -> [f64; 4] {
    let [old, new] = damage;
    let [before, after] = states;
    let middle: Damage = std::array::from_fn(|k| 0.5 * (old[k] + new[k]));
    let mut sums = [0.0; 4];
    for mode in (0..4).filter(|k| new[*k] > old[*k]) {
        let turned = mode > 1 && modes.of(before)[1] != mode;
        let half = before.between(after, 0.5);
        let state = if modes.follows(mode) && modes.exposure(mode, &half) > 0.0 { half } else { *after };
        let energy = |state: &State, e: f64| {
            let [normal, _] = modes.released(mode, state);
            (normal + modes.relieved(state, &modes.takes(&middle, mode))) / (e * e)
        };
        let e = modes.exposure(mode, &state);
        let (kappa, y) = (modes.brittleness(mode, &state, e), energy(&state, e));
        let mut from = old[mode];
        if turned && before.pull() != 0.0 {
            let share = before.pull() / (before.pull() - after.pull());
            let turn = before.between(after, if (0.0..=1.0).contains(&share) { share } else { 1.0 });
            let begun = modes.exposure(mode, &turn);
            let jumped = if begun > 1.0 { damage_at(begun, kappa).min(new[mode]) } else { 0.0 };
            if jumped > from {
                sums[mode] += y * e * e * (jumped - from);
                from = jumped;
            }
        }
        let [first, last] = [from, new[mode]].map(|d| exposure_at(d, kappa));
        sums[mode] += y / (1.0 - kappa) * (last - first);
    }
    sums
}
