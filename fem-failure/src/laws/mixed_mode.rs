//! When an interface under a mixed mode begins to soften and when it has broken.

use fem_core::interface_law::Jump;

/// Largest share that the energy stored at onset may have in twice the toughness: a point at 1 would break at once.
pub(super) const BRITTLE: f64 = 0.9;

/// How onset and toughness lie between those of modes I and II.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MixedMode {
    /// G = GI + (GII − GI) Bᵑ with the material's η.
    BenzeggaghKenane,
    /// G = (((1−B)/GI)ᵃ + (B/GII)ᵃ)^(−1/a) with this exponent a.
    Power(f64),
}

/// Constants of a bilinear law, SI.
#[derive(Debug, Clone, Copy)]
pub(super) struct Envelope {
    /// Kn, Ks.
    pub(super) penalty: [f64; 2],
    /// X²/K of either mode: twice the energy at onset.
    pub(super) onset: [f64; 2],
    /// 2 G of either mode.
    pub(super) end: [f64; 2],
    pub(super) criterion: MixedMode,
    pub(super) eta: f64,
    /// Shear strength, and how much of a pressure is added to it.
    pub(super) shear: f64,
    pub(super) strengthening: f64,
}

/// What a jump asks for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demand {
    /// λ/o, how far it is beyond onset, and f/(f − o).
    ratio: f64,
    scale: f64,
    /// ∂d/∂δ.
    pub(super) slope: Jump,
}

impl Demand {
    /// The damage, from −∞ to beyond 1.
    pub(super) fn damage(&self) -> f64 {
        self.scale * (1.0 - 1.0 / self.ratio)
    }

    /// Negative where the damage is below `level`, and all but linear along a line of jumps.
    fn beyond(&self, level: f64) -> f64 {
        self.ratio * (1.0 - level / self.scale) - 1.0
    }
}

impl Envelope {
    /// 2 Y by mode: energies of the sound interface that damage releases.
    pub(super) fn energies(&self, jump: &Jump) -> [f64; 2] {
        let [n, s, t] = *jump;
        let [kn, ks] = self.penalty;
        // Not `max`, which a NaN would pass.
        let open = if n < 0.0 { 0.0 } else { n };
        [kn * open * open, ks * (s * s + t * t)]
    }

    pub(super) fn pressure(&self, jump: &Jump) -> f64 {
        if jump[0] < 0.0 { -self.penalty[0] * jump[0] } else { 0.0 }
    }

    /// Whether the damage of a jump may be as large as `known`: a bound that takes no power.
    pub(super) fn may_reach(&self, jump: &Jump, known: f64) -> bool {
        let [open, sheared] = self.energies(jump);
        let energy = open + sheared;
        let least = self.onset[0].min(self.onset[1]);
        let scales = [0, 1].map(|k| self.end[k] / (self.end[k] - self.onset[k]));
        // What is no number is no reason to stop.
        !(energy <= least || scales[0].max(scales[1]) * (1.0 - (least / energy).sqrt()) < known)
    }

    /// Damage and its derivative.
    pub(super) fn demand(&self, jump: &Jump) -> Demand {
        let [open, sheared] = self.energies(jump);
        let energy = open + sheared;
        if energy == 0.0 {
            return Demand { ratio: 0.0, scale: 1.0, slope: [0.0; 3] };
        }
        if jump[0] < 0.0 { self.closed(jump, sheared) } else { self.open(jump, sheared / energy, energy) }
    }

    /// Onset at B = 1, with a shear strength that the pressure raises.
    fn closed(&self, jump: &Jump, energy: f64) -> Demand {
        let [kn, ks] = self.penalty;
        let end = self.end[1];
        let raised = self.shear + self.strengthening * self.pressure(jump);
        let (onset, rise) = match raised * raised / ks {
            onset if onset > BRITTLE * end => (BRITTLE * end, 0.0),
            onset => (onset, -2.0 * raised * self.strengthening * kn / ks),
        };
        let ratio = (energy / onset).sqrt();
        let scale = end / (end - onset);
        let by_energy = scale / (2.0 * ratio * energy);
        let by_onset = scale * scale * (1.0 - 1.0 / ratio) / end - scale / (2.0 * ratio * onset);
        let [_, s, t] = *jump;
        Demand { ratio, scale, slope: [by_onset * rise, by_energy * 2.0 * ks * s, by_energy * 2.0 * ks * t] }
    }

    fn open(&self, jump: &Jump, mix: f64, energy: f64) -> Demand {
        let [kn, ks] = self.penalty;
        let [(onset, onset_slope), (end, end_slope)] = self.between(mix);
        let ratio = (energy / onset).sqrt();
        let rest = end - onset;
        let scale = end / rest;
        let by_energy = scale / (2.0 * ratio * energy);
        let by_mix = (1.0 - 1.0 / ratio) * (end * onset_slope - onset * end_slope) / (rest * rest)
            - scale * onset_slope / (2.0 * ratio * onset);
        let [n, s, t] = *jump;
        // ∂B/∂δ = (1−B) ∂e/∂s / e along the shears, −B ∂e/∂n / e along the normal.
        let normal = 2.0 * kn * (by_energy - by_mix * mix / energy);
        let shear = 2.0 * ks * (by_energy + by_mix * (1.0 - mix) / energy);
        Demand { ratio, scale, slope: [normal * n, shear * s, shear * t] }
    }

    /// Onset and end at a mix B, with their derivatives.
    fn between(&self, mix: f64) -> [(f64, f64); 2] {
        let pairs = [self.onset, self.end];
        match self.criterion {
            MixedMode::BenzeggaghKenane => {
                let power = mix.powf(self.eta);
                // At B = 0 nothing changes the mix to first order.
                let slope = if mix > 0.0 { self.eta * power / mix } else { 0.0 };
                pairs.map(|[i, ii]| (i + (ii - i) * power, (ii - i) * slope))
            }
            MixedMode::Power(a) => {
                let [[first, first_slope], [second, second_slope]] = [1.0 - mix, mix]
                    .map(|part| if a == 1.0 { [part, 1.0] } else { [part.powf(a), a * part.powf(a - 1.0)] });
                pairs.map(|[i, ii]| {
                    let [i, ii] = if a == 1.0 { [1.0 / i, 1.0 / ii] } else { [i.powf(-a), ii.powf(-a)] };
                    let sum = first * i + second * ii;
                    let value = if a == 1.0 { 1.0 / sum } else { sum.powf(-1.0 / a) };
                    (value, -value / (a * sum) * (second_slope * ii - first_slope * i))
                })
            }
        }
    }

    /// Energy that damage releases by mode on a straight way between two jumps, ∫ Y dd from the damage `old` on. `slipped` is how
    /// far the faces of a new crack slide at once, squared: all of the shear unless friction holds them.
    ///
    /// Exact on a ray; three Gauss points where the mix changes.
    pub(super) fn released(&self, from: &Jump, to: &Jump, old: f64, slipped: impl Fn(&Jump, f64) -> f64) -> [f64; 2] {
        let at = |share: f64| -> Jump { std::array::from_fn(|k| from[k] + share * (to[k] - from[k])) };
        let crossing = |level: f64| first_crossing(|share| self.demand(&at(share)).beyond(level));
        let start = crossing(old);
        let end = if self.demand(to).beyond(1.0) > 0.0 { crossing(1.0) } else { 1.0 };
        let mut released = [0.0; 2];
        for (x, w) in [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)] {
            let jump = at(start + 0.5 * (1.0 + x) * (end - start));
            let demand = self.demand(&jump);
            let rate: f64 = (0..3).map(|k| demand.slope[k] * (to[k] - from[k])).sum();
            let weight = w / 18.0 * (end - start) * 0.5 * rate;
            released[0] += weight * self.energies(&jump)[0];
            released[1] += weight * self.penalty[1] * slipped(&jump, demand.damage());
        }
        released.map(|v| v.max(0.0))
    }
}

/// Where a function that is positive at 1 becomes so between 0 and 1: regula falsi of Illinois, which one step ends on a line.
fn first_crossing(f: impl Fn(f64) -> f64) -> f64 {
    let (mut below, mut above) = ((0.0, f(0.0)), (1.0, f(1.0)));
    if !(below.1 < 0.0 && above.1 > 0.0) {
        return 0.0;
    }
    let mut last = 0.0;
    for _ in 0..60 {
        let share = below.0 + (above.0 - below.0) * below.1 / (below.1 - above.1);
        let value = f(share);
        if value.abs() < 1e-13 || above.0 - below.0 < 1e-15 {
            return share;
        }
        let (moved, kept) = if value < 0.0 { (&mut below, &mut above) } else { (&mut above, &mut below) };
        *moved = (share, value);
        if value * last > 0.0 {
            kept.1 *= 0.5;
        }
        last = value;
    }
    above.0
}
