//! The contract of a failure criterion.

use crate::contracts::failure::{FailureCriterion, Reserve, StressRange, check_material};
use crate::words::material::{Material, Strength};
use crate::words::tensor::{Ply, Stress6};

/// Checks `criterion` on a material that it admits, over a few hundred stresses about the size of the strengths.
///
/// Demanded: a name for every mode, and every mode written, by [`FailureCriterion::indices_many`] as by
/// [`FailureCriterion::indices`]; no failure without stress; a NaN in a component that matters never passes; a reserve
/// factor below which nothing fails, at which its mode does, and that is inversely proportional to the stress from
/// 10⁻²⁰⁰ to 10²⁰⁰; indices that a rotation about the fibre leaves alone, where that is claimed; bounds that no index
/// exceeds. Stresses that the criterion refuses are passed over, but it must take half of those in plane stress.
///
/// # Errors
/// The first violation, with the stress.
pub fn check_criterion(criterion: &dyn FailureCriterion, m: &Material) -> Result<(), String> {
    let info = criterion.info();
    if info.modes.is_empty() {
        return Err("it has no mode".into());
    }
    if let Some(mode) = info.modes.iter().find(|mode| info.modes.iter().filter(|other| other == mode).count() > 1) {
        return Err(format!("two modes are called `{mode}`"));
    }
    check_material(criterion, "under test", m).map_err(|e| e.to_string())?;
    let kit = Kit { criterion, m, modes: info.modes.len() };
    kit.rest()?;

    let states = states(m);
    kit.written(&states)?;
    let taken: Vec<_> = states.iter().filter(|s| kit.indices(s).iter().all(|v| !v.is_nan())).copied().collect();
    let plane = |s: &&Stress6<Ply>| s.0[2] == 0.0 && s.0[4] == 0.0 && s.0[5] == 0.0;
    if 2 * taken.iter().filter(plane).count() < states.iter().filter(plane).count() {
        return Err(format!("it refuses most plane stresses and says that it takes {}", criterion.scope()));
    }
    kit.batch(&taken)?;
    for (at, pair) in (0..).zip(states.windows(2)) {
        kit.bounds(at, &pair[0], &pair[1])?;
    }
    for s in &taken {
        let at = |why: String| format!("{why}, for {s:?}");
        kit.nan(s).map_err(at)?;
        kit.reserve(s).map_err(at)?;
        if info.invariant_about_fibre {
            kit.rotation(s).map_err(at)?;
        }
    }
    Ok(())
}

/// Plane and spatial stresses in turn, after the six uniaxial ones of either sign.
fn states(m: &Material) -> Vec<Stress6<Ply>> {
    let strengths = || Strength::ALL.iter().filter_map(|which| m.strengths.get(*which));
    let (weak, strong) = (strengths().fold(f64::INFINITY, f64::min), strengths().fold(0.0, f64::max));
    let scale = if weak.is_finite() { [strong, weak, weak, weak, weak, weak] } else { [1e-3 * m.elastic.e1; 6] };
    let mut states = Vec::new();
    for i in 0..6 {
        for sign in [1.0, -1.0] {
            let mut s = [0.0; 6];
            s[i] = sign * scale[i];
            states.push(Stress6::new(s));
        }
    }
    let irrationals = [2_f64, 3.0, 5.0, 7.0, 11.0, 13.0].map(f64::sqrt);
    for k in 1..=240_u32 {
        let mut s: [f64; 6] = std::array::from_fn(|i| {
            let weyl = (f64::from(k) * irrationals[i]).fract();
            2.0 * scale[i] * (2.0 * weyl - 1.0)
        });
        if k % 2 == 0 {
            (s[2], s[4], s[5]) = (0.0, 0.0, 0.0);
        }
        states.push(Stress6::new(s));
    }
    states
}

/// The same stress in axes turned by `angle` about the fibre.
fn about_fibre(s: &Stress6<Ply>, angle: f64) -> Stress6<Ply> {
    let (sin, cos) = angle.sin_cos();
    let twice = 2.0 * s.s23() * sin * cos;
    Stress6::new([
        s.s11(),
        s.s22() * cos * cos + s.s33() * sin * sin + twice,
        s.s22() * sin * sin + s.s33() * cos * cos - twice,
        s.s12() * cos + s.s31() * sin,
        (s.s33() - s.s22()) * sin * cos + s.s23() * (cos * cos - sin * sin),
        s.s31() * cos - s.s12() * sin,
    ])
}

struct Kit<'a> {
    criterion: &'a dyn FailureCriterion,
    m: &'a Material,
    modes: usize,
}

impl Kit<'_> {
    fn indices(&self, s: &Stress6<Ply>) -> Vec<f64> {
        let mut out = vec![f64::NAN; self.modes];
        self.criterion.indices(s, self.m, &mut out);
        out
    }

    fn fails(&self, s: &Stress6<Ply>) -> bool {
        self.indices(s).iter().any(|v| *v >= 1.0)
    }

    fn rest(&self) -> Result<(), String> {
        for zero in [0.0, -0.0] {
            let s = Stress6::new([zero; 6]);
            let (indices, reserve) = (self.indices(&s), self.criterion.reserve_factor(&s, self.m));
            if !indices.iter().all(|v| *v < 1.0) || reserve != Reserve::UNBOUNDED {
                return Err(format!("without stress the indices are {indices:?}, the reserve is {reserve:?}"));
            }
        }
        Ok(())
    }

    fn written(&self, states: &[Stress6<Ply>]) -> Result<(), String> {
        for s in states {
            let [a, b] = [7.0, 8.0].map(|before| {
                let mut out = vec![before; self.modes];
                self.criterion.indices(s, self.m, &mut out);
                out
            });
            if let Some(k) = (0..self.modes).find(|&k| a[k] == 7.0 && b[k] == 8.0) {
                return Err(format!("mode `{}` is not written for {s:?}", self.criterion.info().modes[k]));
            }
        }
        Ok(())
    }

    fn batch(&self, states: &[Stress6<Ply>]) -> Result<(), String> {
        let mut out = vec![f64::NAN; states.len() * self.modes];
        self.criterion.indices_many(states, self.m, &mut out);
        for (s, many) in states.iter().zip(out.chunks_exact(self.modes)) {
            let one = self.indices(s);
            if many.iter().zip(&one).any(|(a, b)| a.to_bits() != b.to_bits()) {
                return Err(format!("indices_many gives {many:?}, indices {one:?}, for {s:?}"));
            }
        }
        Ok(())
    }

    fn nan(&self, s: &Stress6<Ply>) -> Result<(), String> {
        for i in 0..6 {
            let with = |v: f64| {
                let mut c = s.0;
                c[i] = v;
                self.indices(&Stress6::new(c))
            };
            let matters = with(0.5 * s.0[i]) != with(s.0[i]) || with(-s.0[i]) != with(s.0[i]);
            for nan in [f64::NAN, -f64::NAN] {
                let indices = with(nan);
                if matters && indices.iter().all(|v| *v < 1.0) {
                    return Err(format!("component {i} (order 11 22 33 12 23 31) is NaN and passes with {indices:?}"));
                }
            }
        }
        Ok(())
    }

    fn reserve(&self, s: &Stress6<Ply>) -> Result<(), String> {
        let reserve = self.criterion.reserve_factor(s, self.m);
        if reserve.factor.is_nan() || reserve.factor <= 0.0 || reserve.mode.is_some() != reserve.factor.is_finite() {
            return Err(format!("the reserve is {reserve:?} for the indices {:?}", self.indices(s)));
        }
        let most = reserve.factor.min(1e6);
        for part in [1e-3, 0.1, 0.5, 0.9, 0.99, 1.0 - 1e-9] {
            if self.fails(&s.scaled(part * most)) {
                return Err(format!("{part} of the way to the reserve {reserve:?} it fails already"));
            }
        }
        if let Some(mode) = reserve.mode {
            let beyond = self.indices(&s.scaled(reserve.factor * (1.0 + 1e-9)));
            if beyond[mode] < 1.0 {
                return Err(format!("just beyond the reserve {reserve:?} the indices are {beyond:?}"));
            }
        }
        for factor in [1e-200, 0.3, 1e3, 1e200] {
            let scaled = self.criterion.reserve_factor(&s.scaled(factor), self.m).factor * factor;
            if scaled != reserve.factor && (scaled / reserve.factor - 1.0).abs().max(0.0) > 1e-9 {
                return Err(format!(
                    "{factor:e} times the stress has the reserve {scaled}/{factor:e}, not {reserve:?}"
                ));
            }
        }
        Ok(())
    }

    /// Over ranges from small to large around the way from `from` to `to`, at an eighth of their corners, one after the other as `at` counts,
    /// and at as many places within.
    fn bounds(&self, at: u32, from: &Stress6<Ply>, to: &Stress6<Ply>) -> Result<(), String> {
        for share in [0.0, 0.01, 0.3, 1.0] {
            let other: [f64; 6] = std::array::from_fn(|i| from.0[i] + share * (to.0[i] - from.0[i]));
            let [low, high] = [f64::min, f64::max]
                .map(|least: fn(f64, f64) -> f64| Stress6::new(std::array::from_fn(|i| least(from.0[i], other[i]))));
            let mut most = vec![f64::NAN; self.modes];
            self.criterion.bounds(&StressRange { low, high }, self.m, &mut most);
            if most.iter().all(|most| *most == f64::INFINITY) {
                continue;
            }
            // Corners first, then places within.
            for k in (at % 8..128).step_by(8) {
                let within: [f64; 6] = std::array::from_fn(|i| match k {
                    0..64 if k >> i & 1 == 0 => low.0[i],
                    0..64 => high.0[i],
                    _ => {
                        let weyl = (f64::from(k) * [2_f64, 3.0, 5.0, 7.0, 11.0, 13.0][i].sqrt()).fract();
                        (low.0[i] + weyl * (high.0[i] - low.0[i])).clamp(low.0[i], high.0[i])
                    }
                });
                let s = Stress6::new(within);
                let indices = self.indices(&s);
                let holds =
                    |(index, most): (&f64, &f64)| *most == f64::INFINITY || *index <= *most + 1e-12 * most.abs();
                if !indices.iter().zip(&most).all(holds) {
                    return Err(format!("the bounds {most:?} are below the indices {indices:?}, for {s:?}"));
                }
            }
        }
        Ok(())
    }

    fn rotation(&self, s: &Stress6<Ply>) -> Result<(), String> {
        let straight = self.indices(s);
        let scale = straight.iter().fold(1.0, |a: f64, v| a.max(v.abs()));
        for angle in [0.4, 1.3, 2.2] {
            let turned = self.indices(&about_fibre(s, angle));
            if !straight.iter().zip(&turned).all(|(a, b)| a == b || (a - b).abs() <= 1e-9 * scale) {
                return Err(format!("a rotation of {angle} rad about the fibre turns {straight:?} into {turned:?}"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contracts::failure::{CriterionInfo, Site};
    use crate::words::material::{Elastic, Strengths, Toughnesses};

    /// (σ11/Xt)² and a shear mode, with a fault.
    #[derive(Debug, Clone, Copy, PartialEq)]
    enum Faulty {
        None,
        LosesNan,
        ForgetsAMode,
        FailsAtRest,
        IsNotInvariant,
        OverstatesTheReserve,
        UnderstatesTheReserve,
        OverflowsTheReserve,
        DiffersInBatches,
        RefusesEverything,
        IsBoundTooLow,
    }

    impl FailureCriterion for Faulty {
        fn info(&self) -> &CriterionInfo {
            const INFO: CriterionInfo = CriterionInfo {
                site: Site::Ply,
                modes: &["along", "shear"],
                strengths: &[Strength::Xt, Strength::S12],
                invariant_about_fibre: true,
            };
            &INFO
        }

        fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
            out[0] = (s.s11() / m.strengths.xt()).powi(2);
            let along = match self {
                Self::IsNotInvariant => s.s12() * s.s12(),
                _ => s.s12() * s.s12() + s.s31() * s.s31(),
            };
            let shear = along / m.strengths.s12().powi(2);
            match self {
                Self::LosesNan => out[1] = shear.max(0.0),
                Self::FailsAtRest => out[1] = 1.0 + shear,
                Self::ForgetsAMode if s.s11() < 0.0 => {}
                Self::RefusesEverything if s.s22() != 0.0 => out.fill(f64::NAN),
                _ => out[1] = shear,
            }
        }

        fn indices_many(&self, s: &[Stress6<Ply>], m: &Material, out: &mut [f64]) {
            for (s, out) in s.iter().zip(out.chunks_exact_mut(2)) {
                self.indices(s, m, out);
                out[1] *= if *self == Self::DiffersInBatches { 1.0 + 1e-15 } else { 1.0 };
            }
        }

        fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
            let share = if *self == Self::IsBoundTooLow { 0.99 } else { 1.0 };
            out.fill(f64::INFINITY);
            out[0] = share * s.s11().squared().high / m.strengths.xt().powi(2);
        }

        fn reserve_factor(&self, s: &Stress6<Ply>, m: &Material) -> Reserve {
            let mut out = [0.0; 2];
            let (moderate, k) = crate::contracts::failure::moderate(s);
            let (s, k) = if *self == Self::OverflowsTheReserve { (*s, 1.0) } else { (moderate, k) };
            self.indices(&s, m, &mut out);
            let mode = usize::from(out[1] > out[0]);
            let factor = match self {
                Self::OverstatesTheReserve => 1.01 / out[mode].sqrt(),
                Self::UnderstatesTheReserve => 0.99 / out[mode].sqrt(),
                _ => 1.0 / out[mode].sqrt(),
            } / k;
            if factor.is_finite() { Reserve { factor, mode: Some(mode) } } else { Reserve::UNBOUNDED }
        }
    }

    #[test]
    fn each_fault_is_found() {
        let m = Material {
            name: "m".into(),
            elastic: Elastic::isotropic(1e9, 0.3),
            density: None,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
            strengths: Strengths::default().with(Strength::Xt, 1000.0).with(Strength::S12, 50.0),
        };
        let faults = [
            (Faulty::LosesNan, "is NaN and passes"),
            (Faulty::ForgetsAMode, "mode `shear` is not written"),
            (Faulty::FailsAtRest, "without stress"),
            (Faulty::IsNotInvariant, "rotation"),
            (Faulty::OverstatesTheReserve, "it fails already"),
            (Faulty::UnderstatesTheReserve, "just beyond"),
            (Faulty::OverflowsTheReserve, "times the stress"),
            (Faulty::DiffersInBatches, "indices_many"),
            (Faulty::RefusesEverything, "refuses"),
            (Faulty::IsBoundTooLow, "are below the indices"),
        ];
        assert_eq!(check_criterion(&Faulty::None, &m), Ok(()));
        for (fault, words) in faults {
            let why = check_criterion(&fault, &m).err().unwrap_or_default();
            assert!(why.contains(words), "{fault:?}: {why:?}");
        }
        let bare = Material { strengths: Strengths::default(), ..m };
        assert!(check_criterion(&Faulty::None, &bare).unwrap_err().contains("Xt, S12"));
    }
}
