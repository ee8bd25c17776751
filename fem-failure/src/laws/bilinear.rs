//! An interface that softens linearly.

use super::mixed_mode::{BRITTLE, Envelope, MixedMode};
use super::process_zone::process_zone;
use fem_core::failure::UnmetCondition;
use fem_core::interface_law::{InterfaceLaw, InterfaceResponse, Jump, Sinks};
use fem_core::material::{Elastic, Strength, Toughness};
use fem_core::plugin::{Built, Dimension, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::ply_law::{LawError, LawInfo, LawPoint};

/// Difference of damage up to which a point that has just been damaged is taken to go on: its tangent is that of softening.
const SAME: f64 = 1e-9;

/// Bilinear traction and separation, δ the jump, n its normal, ⟨⟩ the positive part.
///
/// ```text
/// e = Kn ⟨δn⟩² + Ks δs²,  B = Ks δs²/e                           energy of the sound interface, and the share of shear in it
/// r = √(e/E),  q = 2G/E                                          E, G: onset and toughness at B, between those of both modes
/// d = max over the history of min(1, q (r − 1)/(r (q − 1)))      E_I = Zt²/Kn, E_II = S13²/Ks; GIc, GIIc
/// t = (1 − d) K δ;  tn = Kn δn where δn < 0
/// ```
///
/// E and G follow the same criterion, Benzeggagh and Kenane's or a power law. At a fixed mix the area under the curve is G
/// whatever Ks; with Ks = Kn (GIc/GIIc)(S13/Zt)², which is taken where none is given, the same d is the same share of G in
/// every mode, so that a changing mix loses no energy either. r = λ/o and q = f/o of Turon's law with a penalty for each mode.
///
/// Faces that are pressed together, p = −Kn δn: shear damages from S13 + η p on, and the damaged share d slides under
/// Coulomb's friction, t = Ks (δ − w) in shear with the slip w of the whole, |Ks (d δ − w)| ≤ μ d p. What a new crack releases
/// counts as shear, less what friction holds; w moves against friction.
///
/// Energies of a step are integrated along the straight line of jumps from the last accepted one.
///
/// Limits: one shear strength, S13, for both directions. Under a pressure the strength ends where E_II would reach 0.9 of
/// 2 GIIc. Toughness does not grow with a pressure.
///
/// Sources: Turon, Camanho, Costa and Dávila, Mech. Mater. 38 (2006) 1072; Turon, Camanho, Costa and Renart, Compos. Struct. 92
/// (2010) 1857; Benzeggagh and Kenane, Compos. Sci. Technol. 56 (1996) 439; Alfano and Sacco, Int. J. Numer. Meth. Eng. 68 (2006) 542.
#[derive(Debug, Clone)]
pub struct Bilinear {
    /// Kn, Pa/m.
    pub penalty: f64,
    /// Ks, Pa/m; consistent with the energies where there is none.
    pub shear_penalty: Option<f64>,
    /// Between the modes.
    pub criterion: MixedMode,
    /// Shear strength gained per pressure, η.
    pub strengthening: f64,
    /// Coefficient of friction, μ.
    pub friction: f64,
}

impl Bilinear {
    /// Force per area and length.
    pub const STIFFNESS: Dimension = Dimension([-2.0, 1.0, -2.0, 0.0]);

    fn envelope(&self, point: &LawPoint<'_>) -> Envelope {
        let material = point.material;
        let (strength, toughness) = (&material.strengths, &material.toughness);
        let (normal, shear) = (strength.zt(), strength.s13());
        let ratio = shear / normal;
        let consistent = || self.penalty * toughness.gic() / toughness.giic() * ratio * ratio;
        let penalty = [self.penalty, self.shear_penalty.unwrap_or_else(consistent)];
        Envelope {
            penalty,
            onset: [normal * normal / penalty[0], shear * shear / penalty[1]],
            end: [2.0 * toughness.gic(), 2.0 * toughness.giic()],
            criterion: self.criterion,
            // `check` has seen to it where it is used.
            eta: material.eta.unwrap_or(1.0),
            shear,
            strengthening: self.strengthening,
        }
    }
}

/// What the law remembers.
#[derive(Debug, Clone, Copy)]
struct Memory {
    damage: f64,
    /// The last accepted jump.
    jump: Jump,
    slip: [f64; 2],
    lost: Sinks,
}

impl Memory {
    const NAMES: &[&str] = &[
        "damage",
        "last opening",
        "last shear s",
        "last shear t",
        "slip s",
        "slip t",
        "lost by opening",
        "lost by shear",
        "lost by friction",
    ];

    fn read(state: &[f64]) -> Self {
        let [damage, n, s, t, slip_s, slip_t, opening, shear, friction] = *state else {
            return Self { damage: 0.0, jump: [0.0; 3], slip: [0.0; 2], lost: Sinks::default() };
        };
        Self { damage, jump: [n, s, t], slip: [slip_s, slip_t], lost: Sinks { opening, shear, friction } }
    }

    fn write(&self, state: &mut [f64]) {
        let Self { damage, jump: [n, s, t], slip, lost } = *self;
        state.copy_from_slice(&[damage, n, s, t, slip[0], slip[1], lost.opening, lost.shear, lost.friction]);
    }
}

/// What friction does on the damaged share.
struct Sliding {
    /// Traction and slip of the whole.
    traction: [f64; 2],
    slip: [f64; 2],
    /// Where the faces slide: direction, and |d δ − w| of a slip that would stay.
    moves: Option<([f64; 2], f64)>,
    lost: f64,
}

impl Bilinear {
    /// Friction at a damage and a jump; without a pressure the damaged share slides freely.
    fn slide(&self, c: &Envelope, old: &Memory, damage: f64, jump: &Jump) -> Sliding {
        let ks = c.penalty[1];
        let shear = [damage * jump[1], damage * jump[2]];
        if !(jump[0] < 0.0 && damage > 0.0 && self.friction > 0.0) {
            return Sliding { traction: [0.0; 2], slip: shear, moves: None, lost: 0.0 };
        }
        let (now, before) = (self.friction * c.pressure(jump), self.friction * c.pressure(&old.jump));
        let limit = damage * now / ks;
        let trial = [shear[0] - old.slip[0], shear[1] - old.slip[1]];
        let size = trial[0].hypot(trial[1]);
        if size <= limit {
            return Sliding { traction: trial.map(|v| ks * v), slip: old.slip, moves: None, lost: 0.0 };
        }
        let direction = trial.map(|v| v / size);
        let slip = [0, 1].map(|k| shear[k] - limit * direction[k]);
        // Where it stuck before, sliding has begun under the smaller pressure, or under what it had to carry then.
        let carried = [1, 2].map(|k| old.damage * old.jump[k] - old.slip[k - 1]);
        let carried = if old.damage > 0.0 { ks * carried[0].hypot(carried[1]) / old.damage } else { 0.0 };
        let begun = if old.jump[0] < 0.0 { carried.max(now.min(before)) } else { 0.0 };
        let lost = 0.5 * (begun + now) * (size - limit);
        Sliding { traction: direction.map(|v| ks * limit * v), slip, moves: Some((direction, size)), lost }
    }
}

impl InterfaceLaw for Bilinear {
    fn info(&self) -> &LawInfo {
        const INFO: LawInfo = LawInfo {
            state: Memory::NAMES,
            strengths: &[Strength::Zt, Strength::S13],
            toughness: &[Toughness::GIc, Toughness::GIIc],
        };
        &INFO
    }

    fn check(&self, point: &LawPoint<'_>) -> Result<(), UnmetCondition> {
        if self.criterion == MixedMode::BenzeggaghKenane && point.material.eta.is_none() {
            return Err(UnmetCondition {
                condition: "eta",
                reason: "it is Benzeggagh and Kenane's exponent, which the material does not give; give it, or choose criterion \
                         = \"power\"",
                values: Vec::new(),
            });
        }
        let c = self.envelope(point);
        for (k, [penalty, strength, toughness]) in [["Kn", "Zt", "GIc"], ["Ks", "S13", "GIIc"]].into_iter().enumerate()
        {
            if !(c.onset[k] <= BRITTLE * c.end[k]) {
                let strengths = [point.material.strengths.zt(), point.material.strengths.s13()];
                return Err(UnmetCondition {
                    condition: "a penalty of strength^2 / (1.8 toughness) at least",
                    reason: "a softer interface would store more than breaking it takes and snap; give a larger penalty",
                    values: vec![
                        (penalty.into(), c.penalty[k], "N/m^3"),
                        ("the least".into(), strengths[k] * strengths[k] / (BRITTLE * c.end[k]), "N/m^3"),
                        (strength.into(), strengths[k], "Pa"),
                        (toughness.into(), 0.5 * c.end[k], "J/m^2"),
                    ],
                });
            }
        }
        Ok(())
    }

    fn damage(&self, _: &LawPoint<'_>, state: &[f64]) -> f64 {
        Memory::read(state).damage
    }

    fn dissipated(&self, state: &[f64]) -> Sinks {
        Memory::read(state).lost
    }

    fn broken(&self, _: &LawPoint<'_>, state: &mut [f64]) {
        Memory { damage: 1.0, ..Memory::read(state) }.write(state);
    }

    fn process_zone(&self, point: &LawPoint<'_>, arm: &Elastic, thickness: f64) -> Option<[f64; 2]> {
        let c = self.envelope(point);
        let strengths = [point.material.strengths.zt(), c.shear];
        Some(process_zone(arm, thickness, c.end.map(|end| 0.5 * end), strengths))
    }

    fn respond(
        &self,
        point: &LawPoint<'_>,
        jump: &Jump,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut [Jump; 3]>,
    ) -> Result<InterfaceResponse, LawError> {
        let (c, old) = (self.envelope(point), Memory::read(old));
        let [kn, ks] = c.penalty;
        let [n, s, t] = *jump;
        let (mut damage, mut slope, mut lost) = (old.damage, [0.0; 3], old.lost);
        if damage < 1.0 && c.may_reach(jump, damage - SAME) {
            let demand = c.demand(jump);
            let wanted = demand.damage();
            if wanted >= damage - SAME && wanted < 1.0 && wanted > 0.0 {
                slope = demand.slope;
            }
            if wanted > damage {
                let [opening, shear] = c.released(&old.jump, jump, damage, |jump, damage| {
                    let [s, t] = self.slide(&c, &old, damage, jump).slip;
                    (s * s + t * t) / (damage * damage)
                });
                lost.opening += opening;
                lost.shear += shear;
                damage = wanted.min(1.0);
            }
        }
        let sound = 1.0 - damage;
        let closed = n < 0.0;
        let rubs = closed && damage > 0.0 && self.friction > 0.0;
        let sliding = self.slide(&c, &old, damage, jump);
        lost.friction += sliding.lost;
        let normal = if closed { kn * n } else { sound * kn * n };
        let traction = [normal, sound * ks * s + sliding.traction[0], sound * ks * t + sliding.traction[1]];
        let [rubbed_s, rubbed_t] = sliding.traction;
        let held = if rubs { (rubbed_s * rubbed_s + rubbed_t * rubbed_t) / (ks * damage) } else { 0.0 };
        let stored = 0.5 * (normal * n + sound * ks * (s * s + t * t) + held);
        if let Some(tangent) = tangent {
            let row = |k: usize, stiffness: f64, force: f64| -> Jump {
                std::array::from_fn(|j| if j == k { stiffness } else { 0.0 } - force * slope[j])
            };
            *tangent = if closed {
                [[kn, 0.0, 0.0], row(1, sound * ks, ks * s), row(2, sound * ks, ks * t)]
            } else {
                [row(0, sound * kn, kn * n), row(1, sound * ks, ks * s), row(2, sound * ks, ks * t)]
            };
            if rubs {
                self.add_friction(&c, &sliding, damage, &slope, jump, tangent);
            }
        }
        Memory { damage, jump: *jump, slip: sliding.slip, lost }.write(new);
        Ok(InterfaceResponse { traction, stored, dissipated: lost })
    }
}

impl Bilinear {
    fn add_friction(
        &self,
        c: &Envelope,
        sliding: &Sliding,
        damage: f64,
        slope: &Jump,
        jump: &Jump,
        tangent: &mut [Jump; 3],
    ) {
        let [kn, ks] = c.penalty;
        // ∂(d δ)/∂δ of a shear.
        let moved = |k: usize, j: usize| slope[j] * jump[k + 1] + if j == k + 1 { damage } else { 0.0 };
        let friction = self.friction * c.pressure(jump);
        let pressed = |j: usize| if j == 0 { -self.friction * kn * damage } else { 0.0 };
        let added = |k: usize, j: usize| match sliding.moves {
            None => ks * moved(k, j),
            Some((direction, size)) => {
                let along = direction[0] * moved(0, j) + direction[1] * moved(1, j);
                let turned = (moved(k, j) - direction[k] * along) / size;
                direction[k] * (friction * slope[j] + pressed(j)) + damage * friction * turned
            }
        };
        for (k, row) in tangent.iter_mut().skip(1).enumerate() {
            row.iter_mut().enumerate().for_each(|(j, entry)| *entry += added(k, j));
        }
    }
}

const PENALTY: ParamInfo =
    ParamInfo::quantity("penalty", "stiffness of the sound interface along its normal", Bilinear::STIFFNESS)
        .above(0.0)
        .default(1e14);
const SHEAR_PENALTY: ParamInfo = ParamInfo::quantity(
    "shear_penalty",
    "stiffness of the sound interface in shear; if left out, penalty (GIc/GIIc)(S13/Zt)^2, with which a changing mix of modes \
     loses no energy",
    Bilinear::STIFFNESS,
)
.above(0.0)
.optional();
const CRITERION: ParamInfo = ParamInfo::word(
    "criterion",
    "onset and toughness between modes I and II",
    &[
        ("benzeggagh-kenane", "with the exponent `eta` of the material"),
        ("power", "(GI/GIc)^exponent + (GII/GIIc)^exponent = 1"),
    ],
);
const EXPONENT: ParamInfo = ParamInfo::number("exponent", "of the power law").at_least(1.0).at_most(10.0).default(1.0);
const STRENGTHENING: ParamInfo =
    ParamInfo::number("strengthening", "shear strength gained per pressure on the interface")
        .at_least(0.0)
        .default(0.0);
const FRICTION: ParamInfo =
    ParamInfo::number("friction", "Coulomb's coefficient, on the damaged share").at_least(0.0).default(0.0);

impl Plugin for Bilinear {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::InterfaceLaw,
        name: "bilinear",
        summary: "linear up to the strength, then linear softening to the toughness of the mix of modes; contact and friction",
        source: "Turon et al. 2006, 2010; Benzeggagh and Kenane 1996; Alfano and Sacco 2006",
        params: &[PENALTY, SHEAR_PENALTY, CRITERION, EXPONENT, STRENGTHENING, FRICTION],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let criterion = match params.word(&CRITERION)? {
            "power" => MixedMode::Power(params.number(&EXPONENT)?),
            word if params.has(&EXPONENT) => {
                return Err(ParamError::new(
                    EXPONENT.name,
                    format!("is of the power law; that of {word} is `eta` of the material"),
                ));
            }
            _ => MixedMode::BenzeggaghKenane,
        };
        let shear_penalty = if params.has(&SHEAR_PENALTY) { Some(params.number(&SHEAR_PENALTY)?) } else { None };
        Ok(Built::InterfaceLaw(Box::new(Self {
            penalty: params.number(&PENALTY)?,
            shear_penalty,
            criterion,
            strengthening: params.number(&STRENGTHENING)?,
            friction: params.number(&FRICTION)?,
        })))
    }
}
