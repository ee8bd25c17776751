//! What laws of plies and of interfaces have in common: answers along paths.

use crate::contracts::plugin::Dimension;
use crate::contracts::ply_law::{LawError, LawInfo};
use crate::words::material::{Elastic, Material, Strength, Strengths, Toughness, Toughnesses};

/// Units in which a law must say the same as in those of SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Unit of length, m.
    pub length: f64,
    /// Unit of mass, kg.
    pub mass: f64,
    /// Unit of time, s.
    pub time: f64,
}

impl Units {
    /// Metre, kilogram, second.
    pub const SI: Self = Self { length: 1.0, mass: 1.0, time: 1.0 };
    pub(super) const ODD: Self = Self { length: 0.0254, mass: 0.45, time: 3e-3 };

    /// The number that `value` (SI, of dimension `dimension`) has in these units.
    pub fn number(&self, value: f64, dimension: Dimension) -> f64 {
        let Dimension([length, mass, time, _]) = dimension;
        value / (self.length.powf(length) * self.mass.powf(mass) * self.time.powf(time))
    }

    pub(super) fn material(&self, m: &Material) -> Material {
        let pressure = |v| self.number(v, Dimension::PRESSURE);
        let Elastic { e1, e2, e3, g12, g13, g23, .. } = m.elastic;
        let [e1, e2, e3, g12, g13, g23] = [e1, e2, e3, g12, g13, g23].map(pressure);
        let given = Strength::ALL.iter().filter_map(|which| Some((*which, pressure(m.strengths.get(*which)?))));
        let energy = |v| self.number(v, Dimension::TOUGHNESS);
        let tough = Toughness::ALL.iter().filter_map(|which| Some((*which, energy(m.toughness.get(*which)?))));
        Material {
            elastic: Elastic { e1, e2, e3, g12, g13, g23, ..m.elastic },
            density: m.density.map(|v| self.number(v, Dimension::DENSITY)),
            toughness: tough.fold(Toughnesses::default(), |all, (which, v)| all.with(which, v)),
            strengths: given.fold(Strengths::default(), |all, (which, v)| all.with(which, v)),
            ..m.clone()
        }
    }
}

/// What a law of `N` components says: stress and energies, state and tangent into its arguments.
pub(super) type Respond<'a, const N: usize> =
    &'a dyn Fn(&[f64; N], &[f64], &mut [f64], Option<&mut [[f64; N]; N]>) -> Result<Answer<N>, LawError>;

/// Stress at a place of a path, and the energy stored and dissipated in each of up to three sinks.
pub(super) type Answer<const N: usize> = ([f64; N], [f64; 4]);

/// Steps between two turns of a path.
const STEPS: u32 = 100;
/// Paths with all components, and turns of each.
const MIXED: u32 = 6;
const TURNS: u32 = 5;
/// Deviations that are allowed: of the energies (they are integrated along steps), of what is the same but for rounding.
const BALANCE: f64 = 1e-3;
const ROUNDING: f64 = 1e-9;

/// A law at a point, and how far it is strained.
pub(super) struct Subject<'a, const N: usize> {
    pub(super) info: &'a LawInfo,
    pub(super) largest: [f64; N],
    pub(super) respond: Respond<'a, N>,
    /// Whether it is a cell of one point, with means that move with the strain: no tangent is that of the point then, and the means
    /// need not be the same once a state is taken over.
    pub(super) cell: bool,
}

impl<const N: usize> Subject<'_, N> {
    /// Walks all paths, and their mirror images.
    pub(super) fn check(&self, mirrors: &[[f64; N]]) -> Result<Vec<Answer<N>>, String> {
        self.rest()?;
        self.nan()?;
        let mut all = Vec::new();
        for path in self.paths() {
            let answers = self.walk(&path)?;
            for mirror in mirrors {
                let image: Vec<_> = path.iter().map(|turn| times(turn, mirror)).collect();
                let turned: Vec<_> = self.walk(&image)?.iter().map(|(s, energy)| (times(s, mirror), *energy)).collect();
                same(&answers, &turned)
                    .map_err(|why| format!("the mirror image {mirror:?} of the path {path:?} differs: {why}"))?;
            }
            all.extend(answers);
        }
        let Some(first) = self.paths().next() else { return Ok(all) };
        let again = self.walk(&first)?;
        if again != all[..again.len()] {
            return Err("the law remembers outside its state: a virgin point does not answer as at first".into());
        }
        Ok(all)
    }

    /// The tangent of a virgin point.
    pub(super) fn virgin_tangent(&self) -> Result<[[f64; N]; N], String> {
        let (old, mut new) = self.states();
        let mut tangent = [[f64::NAN; N]; N];
        (self.respond)(&[0.0; N], &old, &mut new, Some(&mut tangent)).map_err(|e| e.to_string())?;
        Ok(tangent)
    }

    fn states(&self) -> (Vec<f64>, Vec<f64>) {
        (vec![0.0; self.info.state.len()], vec![f64::NAN; self.info.state.len()])
    }

    /// Turning points: each component by itself to and fro, then all together.
    fn paths(&self) -> impl Iterator<Item = Vec<[f64; N]>> + use<'_, N> {
        let single = (0..N).map(|i| {
            let turn = |part: f64| std::array::from_fn(|k| if k == i { part * self.largest[i] } else { 0.0 });
            [0.5, 0.1, 1.0, -0.6, 0.3, -1.0, 0.0].map(turn).to_vec()
        });
        let mixed = (0..MIXED).map(|path| {
            let turn = |turn: u32| {
                std::array::from_fn(|k| {
                    let weyl =
                        (f64::from(1 + path * TURNS + turn) * (k as f64 + 2.0 + 0.25 * (k % 3) as f64).sqrt()).fract();
                    self.largest[k] * (2.0 * weyl - 1.0)
                })
            };
            (0..TURNS).map(turn).collect()
        });
        single.chain(mixed)
    }

    fn rest(&self) -> Result<(), String> {
        let (old, mut new) = self.states();
        let (stress, energy) = (self.respond)(&[0.0; N], &old, &mut new, None).map_err(|e| e.to_string())?;
        if stress.iter().any(|s| *s != 0.0) || energy != [0.0; 4] || new != old {
            return Err(format!(
                "a virgin point without strain has the stress {stress:?}, the energies {energy:?} and the state {new:?}"
            ));
        }
        Ok(())
    }

    fn nan(&self) -> Result<(), String> {
        for i in 0..N {
            let (old, mut new) = self.states();
            let mut strain = self.largest.map(|e| 0.1 * e);
            strain[i] = f64::NAN;
            match (self.respond)(&strain, &old, &mut new, None) {
                Ok((stress, _)) if stress.iter().all(|s| s.is_finite()) => {
                    return Err(format!("component {} of the strain is NaN, the stress is {stress:?}", i + 1));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn walk(&self, path: &[[f64; N]]) -> Result<Vec<Answer<N>>, String> {
        let (mut state, _) = self.states();
        let (mut from, mut answers) = ([0.0; N], Vec::new());
        let (mut work, mut most, mut lost, mut worst) = (0.0, 0.0_f64, [0.0_f64; 3], (0.0, String::new()));
        for turn in path {
            let start = from;
            for step in 1..=STEPS {
                let share = f64::from(step) / f64::from(STEPS);
                let strain = std::array::from_fn(|k| start[k] + share * (turn[k] - start[k]));
                let at = |why: String| {
                    format!("{why}; at {strain:?} on the way from {start:?} to {turn:?}, state {state:?}")
                };
                let (answer, new) = self.answer(&strain, &state).map_err(at)?;
                if step % 10 == 5 && !self.cell {
                    self.tangent(&strain, &state, &answer.0).map_err(at)?;
                }
                work += self.work(&from, &strain, &state).map_err(at)?;
                most = most.max(work.abs());
                let [stored, dissipated @ ..] = answer.1;
                let missed = (stored + dissipated.iter().sum::<f64>() - work).abs();
                if missed > worst.0 {
                    worst = (missed, at(format!("energies {:?}, whose sum is not the work {work:e}", answer.1)));
                }
                if stored < -ROUNDING * most || dissipated.iter().zip(lost).any(|(d, l)| *d < l - ROUNDING * most) {
                    return Err(at(format!(
                        "stored energy is negative or dissipated energy falls from {lost:?}: {:?}",
                        answer.1
                    )));
                }
                lost = std::array::from_fn(|k| lost[k].max(dissipated[k]));
                if !self.cell {
                    let (again, _) = self.answer(&strain, &new).map_err(at)?;
                    same(&[answer], &[again])
                        .map_err(|why| at(format!("once its state is taken over the answer changes: {why}")))?;
                }
                answers.push(answer);
                (from, state) = (strain, new);
            }
        }
        // At a kink inside a step the rule for the work is wrong by more than the work so far may allow.
        if worst.0 > BALANCE * most { Err(worst.1) } else { Ok(answers) }
    }

    /// The answer and the state that it leaves, asked twice.
    fn answer(&self, strain: &[f64; N], old: &[f64]) -> Result<(Answer<N>, Vec<f64>), String> {
        let ask = |before: f64| {
            let (mut new, mut tangent) = (vec![before; old.len()], [[before; N]; N]);
            let wanted = (before != 0.0).then_some(&mut tangent);
            let answer = (self.respond)(strain, old, &mut new, wanted).map_err(|e| e.to_string())?;
            Ok::<_, String>((answer, new))
        };
        let (first, second) = (ask(0.0)?, ask(f64::NAN)?);
        let numbers = |((stress, energy), new): &(Answer<N>, Vec<f64>)| -> Vec<u64> {
            stress.iter().chain(energy).chain(new).map(|v| v.to_bits()).collect()
        };
        if let Some(name) = self.info.state.iter().zip(&second.1).find_map(|(name, v)| v.is_nan().then_some(name)) {
            return Err(format!("the state `{name}` is not written or no number"));
        }
        if numbers(&first) != numbers(&second) {
            return Err(format!("asked twice, it answers {first:?} and {second:?}"));
        }
        if !numbers(&first).iter().all(|v| f64::from_bits(*v).is_finite()) {
            return Err(format!("the answer {first:?} is not finite"));
        }
        Ok(first)
    }

    /// The tangent against differences, column by column; at a kink one side is enough.
    fn tangent(&self, strain: &[f64; N], old: &[f64], stress: &[f64; N]) -> Result<(), String> {
        let ask = |strain: &[f64; N]| {
            let (mut new, mut tangent) = (vec![0.0; old.len()], [[f64::NAN; N]; N]);
            let (stress, _) = (self.respond)(strain, old, &mut new, Some(&mut tangent)).map_err(|e| e.to_string())?;
            Ok::<_, String>((stress, tangent))
        };
        let here = ask(strain)?.1;
        let size = stress.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        for column in 0..N {
            let d = 1e-6 * self.largest[column];
            let beside = |sign: f64| {
                let mut moved = *strain;
                moved[column] += sign * d;
                ask(&moved)
            };
            let [(below, t_below), (above, t_above)] = [beside(-1.0)?, beside(1.0)?];
            let largest = here.iter().fold(0.0_f64, |m, row| m.max(row[column].abs()));
            for row in 0..N {
                let t = here[row][column];
                let slopes = [(stress[row] - below[row]) / d, (above[row] - stress[row]) / d];
                let curvature = (t_above[row][column] - t).abs().min((t - t_below[row][column]).abs());
                let allowed = curvature + 1e-11 * size / d + 1e-5 * largest;
                if !slopes.iter().any(|slope| (slope - t).abs() <= allowed) {
                    let place = (row + 1, column + 1);
                    return Err(format!("the tangent {place:?} is {t:e}, but differences give {slopes:?}"));
                }
            }
        }
        Ok(())
    }

    /// ∫ σ dε of a step by three Gauss points.
    fn work(&self, from: &[f64; N], to: &[f64; N], old: &[f64]) -> Result<f64, String> {
        let mut work = 0.0;
        for (t, w) in [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)] {
            let strain = std::array::from_fn(|k| from[k] + 0.5 * (1.0 + t) * (to[k] - from[k]));
            let mut new = vec![0.0; old.len()];
            let (stress, _) = (self.respond)(&strain, old, &mut new, None).map_err(|e| e.to_string())?;
            work += w / 18.0 * stress.iter().zip(from.iter().zip(to)).map(|(s, (a, b))| s * (b - a)).sum::<f64>();
        }
        Ok(work)
    }
}

fn times<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|k| a[k] * b[k])
}

/// Equal but for rounding, each by the largest number of its kind.
pub(super) fn same<const N: usize>(a: &[Answer<N>], b: &[Answer<N>]) -> Result<(), String> {
    let largest = |of: &dyn Fn(&Answer<N>) -> f64| a.iter().map(of).fold(0.0, f64::max);
    let stress = largest(&|(s, _)| s.iter().fold(0.0, |m, s| m.max(s.abs())));
    let energy = largest(&|(_, e)| e.iter().fold(0.0, |m, e| m.max(e.abs())));
    let differ = |(a, b): &(&Answer<N>, &Answer<N>)| {
        a.0.iter().zip(&b.0).any(|(a, b)| (a - b).abs() > ROUNDING * stress)
            || a.1.iter().zip(&b.1).any(|(a, b)| (a - b).abs() > ROUNDING * energy)
    };
    match a.iter().zip(b).find(differ) {
        Some((a, b)) => Err(format!("{a:?} and {b:?}")),
        None => Ok(()),
    }
}

/// Answers in SI against those in `units`, where energies have the dimension `energy`.
pub(super) fn same_in<const N: usize>(
    units: &Units,
    si: &[Answer<N>],
    theirs: &[Answer<N>],
    energy: Dimension,
) -> Result<(), String> {
    let ours = si.iter().map(|(stress, energies)| {
        (stress.map(|s| units.number(s, Dimension::PRESSURE)), energies.map(|e| units.number(e, energy)))
    });
    same(&ours.collect::<Vec<_>>(), theirs).map_err(|why| format!("in other units it does not say the same: {why}"))
}
