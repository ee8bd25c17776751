//! A ply whose cracks are smeared over its cell.

mod modes;
mod permanent;
mod solid;
mod solve;
mod split;

use super::hahn_tsai::HahnTsai;
use fem_core::energy::Energy;
use fem_core::failure::UnmetCondition;
use fem_core::material::{Elastic, Strength, Toughness};
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::ply_law::{LawError, LawInfo, LawPoint, PlyLaw, PlyResponse};
use fem_core::tensor::{Matrix6, Ply, Strain6, Stress6};
use modes::{BRITTLE, Fibres, Matrix, Modes, State};
use permanent::{Permanent, Sheared, Yielding};
use solid::{Damage, Solid};
use solve::{Found, released};
use std::ops::Range;

/// Where the shears 12, 23, 13 stand among six components.
const SHEARS: [usize; 3] = [3, 4, 5];

/// Crack-band damage of a ply in four modes: fibres in tension and compression, matrix in tension and compression.
///
/// With a = 1 − d of each normal component's mode by the sign of its stress, A = diag a, and E, O diagonal moduli and
/// off-diagonal compliance:
///
/// ```text
/// h = (I + E O A)⁻¹ E ε,  σ = A h          normal stresses, effective and true; regular at d = 1, continuous through closure
/// t = G (γ − γp),  τ = Π (1 − d) t         shears, with the permanent strain γp of 12 and 13
/// d = max over the history of min(1, (e − 1)/(e (1 − κ)))
/// ```
///
/// The exposures e of h and t are Hashin's of 1980, fibre tension without shear; u = h2 + h3 < 0 is compression of the matrix. κ
/// = L w/e² is the energy at onset over that of the crack: w sums what damage releases, normal stresses over the toughness of
/// the mode (Gft, Gfc, Gmt, Gmc), shears over Gms where the material gives it. So stress falls linearly with strain, and a crack
/// takes its toughness whatever the length L of the cell; between Gmt and Gms by the linear law Gn/Gmt + Gs/Gms = 1.
///
/// With `alpha` a shear along the fibres follows Hahn and Tsai's curve γ = τ/G + α τ³ in effective stresses, as the law
/// `hahn-tsai` does with permanent strain, up to τ = S12; from there on it softens without yielding more.
///
/// Asked with [means](PlyLaw::means), a ply has one damage of its fibres in each cell: e is then √(∫ ⟨±h1⟩² dV/V)/X over the ply in the
/// cell, with the damage of the matrix of before. Cells with smooth displacements cannot open one by one, and points that break by themselves
/// would hold on beside those that have; together they release the same, Σ ½ h1²/E1 V dd, and G times the section by the time the stress is gone.
/// Plies that bend see more at their faces: judged by these ([`CrackBand::faces`]), V is that of all plies of one angle about the ply in its layer
/// of cells, which have nothing between them that would stop a crack, e² that of the mean over the face that sees more, and w stays a mean over V, so that the
/// crack takes G all the same.
///
/// d solves a fixed point, because h depends on it by way of Poisson's ratios: by Newton's method, of which the tangent follows.
/// Energies are integrated at the middle of a step.
///
/// Limits: L is the width of the cell for cracks of every direction. Under shear both damages of the matrix grow where u changes
/// its sign, and the stress jumps there. κ is at most 0.9: mixes with a pressure across the fibres, which may store any energy before
/// they begin, dissipate more than their toughness. The root mean square breaks later than the peak of the stress in a cell. The tangent
/// holds it, as the trait says.
///
/// Where fibres alone break, cells may be as wide as these allow: often millimetres, where a matrix asks for tenths. Cracks across the
/// fibres then take σ11 alone, all shears staying elastic, and cracks of the matrix are left out, with what they would open, soften and
/// take.
///
/// Sources: Hashin, J. Appl. Mech. 47 (1980) 329; Bažant and Oh, Mater. Struct. 16 (1983) 155; Lapczyk and Hurtado, Compos. Part A 38 (2007)
/// 2333; Hahn and Tsai, J. Compos. Mater. 7 (1973) 102.
#[derive(Debug, Clone, Copy)]
pub struct CrackBand {
    /// Hahn and Tsai's α, 1/Pa³, of the permanent shear strain, if there is one.
    pub alpha: Option<f64>,
    /// Which modes break; the matrix may stay elastic.
    pub breaks: Breaks,
    /// Whether the faces of plies of one angle decide when their fibres break, and not the mean over a ply.
    pub faces: bool,
    /// Whether strengths are lowered where the cell is too wide for the toughness; otherwise it is refused.
    pub lower_strengths: bool,
}

/// What of a ply breaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breaks {
    /// Fibres and matrix.
    All,
    /// Fibres; the matrix never cracks.
    Fibres,
    /// Fibres, and the matrix by cracks along them and through the thickness of the ply.
    Splits,
}

/// What each mode has dissipated, and after them yielding, J/m³.
type Lost = [f64; 5];
const YIELDING: usize = 4;

/// What the law remembers.
#[derive(Debug, Clone, Copy)]
struct Memory {
    damage: Damage,
    lost: Lost,
    /// Effective stresses at the last accepted strain.
    state: State,
    permanent: Permanent,
}

impl Memory {
    const NAMES: &[&str] = &[
        "fibre tension",
        "fibre compression",
        "matrix tension",
        "matrix compression",
        "lost by fibre tension",
        "lost by fibre compression",
        "lost by matrix tension",
        "lost by matrix compression",
        "lost by yielding",
        "last effective 11",
        "last effective 22",
        "last effective 33",
        "last effective 12",
        "last effective 23",
        "last effective 13",
        "permanent shear strain 12",
        "permanent shear strain 13",
        "its length",
    ];
    /// Without a permanent strain.
    const ELASTIC: usize = 15;
    const DAMAGES: Range<usize> = 0..4;
    const SINKS: Range<usize> = 4..9;

    fn read(state: &[f64]) -> Self {
        let at = |k: usize| state.get(k).copied().unwrap_or(0.0);
        Self {
            damage: std::array::from_fn(at),
            lost: std::array::from_fn(|k| at(4 + k)),
            state: State { h: [at(9), at(10), at(11)], t: [at(12), at(13), at(14)] },
            permanent: Permanent { left: [at(15), at(16)], way: at(17) },
        }
    }

    fn write(&self, state: &mut [f64]) {
        let Self { damage, lost, state: State { h, t }, permanent: Permanent { left, way } } = *self;
        let all = damage.into_iter().chain(lost).chain(h).chain(t).chain(left).chain([way]);
        state.iter_mut().zip(all).for_each(|(to, from)| *to = from);
    }
}

/// Shares of the normal stresses and of the shears 12, 23, 13 that damage takes at most.
type Shares = ([f64; 3], [f64; 3]);

/// A strength, the modulus along it and the toughness that it needs; and what a cell wider than 2 E G/X² breaks.
type Limit = (Strength, &'static str);

const LIMITS: [Limit; 6] = [
    (Strength::Xt, "a cell narrower than 1.8 E1 Gft/Xt^2"),
    (Strength::Xc, "a cell narrower than 1.8 E1 Gfc/Xc^2"),
    (Strength::Yt, "a cell narrower than 1.8 E2 Gmt/Yt^2"),
    (Strength::Yc, "a cell narrower than 1.8 E2 Gmc/Yc^2"),
    (Strength::S12, "a cell narrower than 1.8 G12 Gms/S12^2, with Gmt where Gms is not given"),
    (Strength::S23, "a cell narrower than 1.8 G23 Gms/S23^2, with Gmt where Gms is not given"),
];

impl CrackBand {
    /// Widest cell for each strength of [`LIMITS`], m.
    fn widest(&self, point: &LawPoint<'_>, (opened, cracked): &Shares) -> [f64; 6] {
        let (e, toughness) = (&point.material.elastic, &point.material.toughness);
        let shear = toughness.get(Toughness::Gms).unwrap_or(toughness.gmt());
        let (across, g) = (e.e2.min(e.e3), e.g12.min(e.g13));
        let energies = [
            e.e1 * toughness.gft(),
            e.e1 * toughness.gfc(),
            across * toughness.gmt() / opened[1],
            across * toughness.gmc(),
            g * shear / cracked[0],
            e.g23 * shear / cracked[1],
        ];
        std::array::from_fn(|k| {
            let x = point.material.strengths.get(LIMITS[k].0).unwrap_or(f64::NAN);
            if self.needs(k) { 2.0 * BRITTLE * energies[k] / (x * x) } else { f64::INFINITY }
        })
    }

    /// Length over which a crack of each of [`LIMITS`] is smeared, m.
    fn lengths(&self, point: &LawPoint<'_>) -> [f64; 6] {
        let matrix = if self.breaks == Breaks::Splits { point.thickness.min(point.length) } else { point.length };
        [point.length, point.length, matrix, matrix, matrix, matrix]
    }

    /// Shares of the normal stresses and of the shears 12, 23, 13 that damage takes at most.
    fn shares(&self, e: &Elastic) -> Shares {
        match self.breaks {
            Breaks::All => ([1.0; 3], [1.0; 3]),
            Breaks::Fibres => ([1.0; 3], [0.0; 3]),
            Breaks::Splits => split::shares(e),
        }
    }

    /// Which of [`LIMITS`] there are.
    fn needs(&self, limit: usize) -> bool {
        match self.breaks {
            Breaks::All => true,
            Breaks::Fibres => limit < 2,
            Breaks::Splits => LIMITS[limit].0 != Strength::Yc,
        }
    }

    fn solid(e: &Elastic, opened: [f64; 3]) -> Solid {
        let (c12, c13, c23) = (-e.nu12, -e.nu13, -e.nu23);
        let coupling = [[0.0, c12, c13], [c12 * e.e2 / e.e1, 0.0, c23], [c13 * e.e3 / e.e1, c23 * e.e3 / e.e2, 0.0]];
        Solid { e: [e.e1, e.e2, e.e3], coupling, g: [e.g12, e.g23, e.g13], opened }
    }

    fn modes(&self, point: &LawPoint<'_>) -> Modes {
        let (e, x, toughness) = (&point.material.elastic, &point.material.strengths, &point.material.toughness);
        let (lengths, shares) = (self.lengths(point), self.shares(e));
        let mut strengths = [x.xt(), x.xc(), x.yt(), x.yc(), x.s12(), x.s23()];
        if self.lower_strengths {
            for ((x, widest), length) in strengths.iter_mut().zip(self.widest(point, &shares)).zip(lengths) {
                *x *= (widest / length).min(1.0).sqrt();
            }
        }
        let [xt, xc, yt, yc, sl, st] = strengths;
        let tough = [toughness.gft(), toughness.gfc(), toughness.gmt(), toughness.gmc()];
        let soft = std::array::from_fn(|k| lengths[k] / tough[k]);
        let soft_shear = toughness.get(Toughness::Gms).map_or(soft, |g| [lengths[2] / g; 4]);
        let (opened, cracked) = shares;
        Modes {
            solid: Self::solid(e, opened),
            strength: [xt, xc, yt, yc],
            shear: [sl, st],
            soft,
            soft_shear,
            matrix: match self.breaks {
                Breaks::All => Matrix::Cracks,
                Breaks::Fibres => Matrix::Sound,
                Breaks::Splits => Matrix::Splits,
            },
            cracked,
            fibres: Fibres::new(point.means),
        }
    }

    /// How shears along the fibres yield, if they do.
    fn yielding(&self, modes: &Modes) -> Option<Yielding> {
        let on = self.breaks != Breaks::All;
        self.alpha.map(|alpha| Yielding { alpha, strength: modes.shear[0], on })
    }

    /// Effective shears along the fibres.
    fn sheared(&self, modes: &Modes, old: &Memory, strain: [f64; 2]) -> Sheared {
        let [g, _, g13] = modes.solid.g;
        match self.yielding(modes) {
            Some(yielding) => old.permanent.shear(&yielding, g, strain),
            None => {
                Sheared { t: [g * strain[0], g13 * strain[1]], tangent: [[g, 0.0], [0.0, g13]], left: old.permanent }
            }
        }
    }
}

impl PlyLaw for CrackBand {
    fn info(&self) -> &LawInfo {
        use Strength::{S12, S23, Xc, Xt, Yc, Yt};
        const ALL: LawInfo = LawInfo {
            state: Memory::NAMES.split_at(Memory::ELASTIC).0,
            strengths: &[Xt, Xc, Yt, Yc, S12, S23],
            toughness: &[Toughness::Gft, Toughness::Gfc, Toughness::Gmt, Toughness::Gmc],
        };
        const FIBRES: LawInfo = LawInfo { strengths: &[Xt, Xc], toughness: &[Toughness::Gft, Toughness::Gfc], ..ALL };
        const ALL_PERMANENT: LawInfo = LawInfo { state: Memory::NAMES, ..ALL };
        const FIBRES_PERMANENT: LawInfo = LawInfo { state: Memory::NAMES, strengths: &[Xt, Xc, S12], ..FIBRES };
        const SPLITS: LawInfo = LawInfo {
            strengths: &[Xt, Xc, Yt, S12, S23],
            toughness: &[Toughness::Gft, Toughness::Gfc, Toughness::Gmt],
            ..ALL
        };
        const SPLITS_PERMANENT: LawInfo = LawInfo { state: Memory::NAMES, ..SPLITS };
        match (self.breaks, self.alpha) {
            (Breaks::Splits, None) => &SPLITS,
            (Breaks::Splits, Some(_)) => &SPLITS_PERMANENT,
            (Breaks::All, None) => &ALL,
            (Breaks::All, Some(_)) => &ALL_PERMANENT,
            (Breaks::Fibres, None) => &FIBRES,
            (Breaks::Fibres, Some(_)) => &FIBRES_PERMANENT,
        }
    }

    fn damages(&self) -> Range<usize> {
        Memory::DAMAGES
    }

    fn sinks(&self) -> Range<usize> {
        Memory::SINKS
    }

    fn means(&self) -> usize {
        2
    }

    fn faces(&self) -> bool {
        self.faces
    }

    /// h1², where it pulls and where it presses.
    fn quantities(&self, point: &LawPoint<'_>, strain: &Strain6<Ply>, old: &[f64], out: &mut [f64]) {
        let ([e1, e2, e3, ..], c, damage) = (strain.0, point.stiffness, Memory::read(old).damage);
        let along = if damage == [0.0; 4] {
            c[0][0] * e1 + c[0][1] * e2 + c[0][2] * e3
        } else {
            let elastic = &point.material.elastic;
            Self::solid(elastic, self.shares(elastic).0).effective(&[e1, e2, e3], &damage, c).h[0]
        };
        out.copy_from_slice(&[along.max(0.0).powi(2), along.min(0.0).powi(2)]);
    }

    fn check(&self, point: &LawPoint<'_>) -> Result<(), UnmetCondition> {
        let (x, e) = (&point.material.strengths, &point.material.elastic);
        let unmet = |condition, reason, values: [(&str, f64, &'static str); 2]| {
            let values = values.map(|(name, value, unit)| (name.to_owned(), value, unit)).to_vec();
            Err(UnmetCondition { condition, reason, values })
        };
        if self.breaks == Breaks::All && !(x.s23() > 0.5 * x.yt()) {
            let reason = "tension across the fibres in both directions would never break the matrix";
            return unmet("S23 > Yt/2", reason, [("S23", x.s23(), "Pa"), ("Yt", x.yt(), "Pa")]);
        }
        if self.alpha.is_some() && e.g12 != e.g13 {
            let reason = "the permanent shear strain is one of a material that is isotropic about its fibres";
            return unmet("g12 = g13", reason, [("g12", e.g12, "Pa"), ("g13", e.g13, "Pa")]);
        }
        let widest = self.widest(point, &self.shares(e));
        let lengths = self.lengths(point);
        let room = |k: &usize| widest[*k] / lengths[*k];
        let tightest = (0..widest.len()).min_by(|a, b| room(a).total_cmp(&room(b))).unwrap_or(0);
        if !self.lower_strengths && !(lengths[tightest] <= widest[tightest]) {
            let (what, reason) = if lengths[tightest] < point.length {
                let reason = "splits stand as far apart as plies of one angle are thick, which counts as the cell here: thicker plies \
                              store more before they split than the cracks take; give a larger toughness, or say \
                              lower_strengths = true";
                ("plies", reason)
            } else {
                let reason = "a wider one stores more before it breaks than the crack takes, and snaps back; refine the mesh, \
                              give a larger toughness, or say lower_strengths = true";
                ("cell", reason)
            };
            let values = [(what, lengths[tightest], "m"), ("widest", widest[tightest], "m")];
            return unmet(LIMITS[tightest].1, reason, values);
        }
        Ok(())
    }

    fn warning(&self, point: &LawPoint<'_>) -> Option<String> {
        let (widest, lengths) = (self.widest(point, &self.shares(&point.material.elastic)), self.lengths(point));
        let all = LIMITS.iter().zip(widest).zip(lengths);
        let lowered = all.filter(|((_, widest), length)| self.lower_strengths && length > widest);
        let lowered = lowered.filter_map(|(((which, _), widest), length)| {
            let x = point.material.strengths.get(*which)? * 1e-6;
            Some(format!("{} from {x:.1} to {:.1} MPa", which.name(), x * (widest / length).sqrt()))
        });
        let lowered: Vec<_> = lowered.collect();
        if !lowered.is_empty() {
            return Some(format!(
                "strengths are lowered to what the toughness bears in cells of {:.3} mm: {}; cells of {:.3} mm would need none of it",
                point.length * 1e3,
                lowered.join(", "),
                widest.iter().fold(f64::INFINITY, |m, w| m.min(*w)) * 1e3
            ));
        }
        let unique = Self::unique_compression(point);
        (self.breaks == Breaks::All && self.lengths(point)[3] > unique).then(|| {
            format!(
                "in cells of {:.3} mm the matrix breaks at once where it is compressed across the fibres with its other strains \
                 held; cells of {:.3} mm or a larger Gmc would do without",
                point.length * 1e3,
                unique * 1e3
            )
        })
    }

    fn respond(
        &self,
        point: &LawPoint<'_>,
        strain: &Strain6<Ply>,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut Matrix6>,
    ) -> Result<PlyResponse, LawError> {
        Ok(self.answer(&self.modes(point), point, strain, (old, new), tangent))
    }

    fn respond_all(
        &self,
        point: &LawPoint<'_>,
        strains: &[Strain6<Ply>],
        (old, new): (&[f64], &mut [f64]),
        answers: &mut [PlyResponse],
        tangents: &mut [Matrix6],
    ) -> Result<(), LawError> {
        let (modes, count, mut tangents) = (self.modes(point), self.info().state.len(), tangents.iter_mut());
        let states = old.chunks_exact(count).zip(new.chunks_exact_mut(count));
        for ((strain, answer), states) in strains.iter().zip(answers).zip(states) {
            *answer = self.answer(&modes, point, strain, states, tangents.next());
        }
        Ok(())
    }
}

impl CrackBand {
    fn answer(
        &self,
        modes: &Modes,
        point: &LawPoint<'_>,
        strain: &Strain6<Ply>,
        (old, new): (&[f64], &mut [f64]),
        tangent: Option<&mut Matrix6>,
    ) -> PlyResponse {
        let old = Memory::read(old);
        let e = &strain.0;
        let sheared = self.sheared(modes, &old, [e[3], e[5]]);
        let t = [sheared.t[0], modes.solid.g[1] * e[4], sheared.t[1]];
        let found = Found::new(modes, &[e[0], e[1], e[2]], t, &modes.begun(&old.damage), point.stiffness);
        let (damage, state) = (found.damage, found.state());
        let [left, left_before] = [damage, old.damage].map(|d| modes.shears_left(&d));
        let mut lost = old.lost;
        if damage != old.damage {
            let more = released(modes, [&old.damage, &damage], [&old.state, &state]);
            lost.iter_mut().zip(more).for_each(|(lost, more)| *lost += more);
        }
        if sheared.left.way > old.permanent.way {
            let [before, after] = [old.permanent.way, sheared.left.way]
                .map(|way| self.yielding(modes).map_or(0.0, |yielding| yielding.lost(way)));
            // Shears yield in the proportion of their stresses.
            let [along, _, through] = t.map(|t| t * t);
            let of = |k: usize| 0.5 * (left[k] + left_before[k]);
            lost[YIELDING] += (along * of(0) + through * of(2)) / (along + through) * (after - before);
        }
        let normal: [f64; 3] = std::array::from_fn(|i| found.effective.left[i] * state.h[i]);
        let stored = 0.5 * (0..3).map(|i| normal[i] * e[i]).sum::<f64>();
        let stored = stored + modes.relieved(&state, &left);
        if let Some(tangent) = tangent {
            *tangent =
                if damage == [0.0; 4] { *point.stiffness } else { found.tangent(modes, &left, &sheared.tangent) };
            for (i, row) in [(0, 3), (1, 5)] {
                if damage == [0.0; 4] {
                    tangent[row][3] = sheared.tangent[i][0];
                    tangent[row][5] = sheared.tangent[i][1];
                }
            }
        }
        Memory { damage, lost, state, permanent: sheared.left }.write(new);
        let [t12, t23, t13] = std::array::from_fn(|k| left[k] * t[k]);
        let stress = Stress6::new([normal[0], normal[1], normal[2], t12, t23, t13]);
        PlyResponse { stress, energy: Energy { stored, dissipated: lost.iter().sum() } }
    }

    /// Widest cell in which compression across the fibres has one answer with all other strains held:
    /// κ < (C22 − ρ C23)/E2, ρ = (3r − 1)/(r + 1), r = (Yc/2 S23)².
    fn unique_compression(point: &LawPoint<'_>) -> f64 {
        let (c, material) = (point.stiffness, point.material);
        let yc = material.strengths.yc();
        let r = (0.5 * yc / material.strengths.s23()).powi(2);
        let rho = (3.0 * r - 1.0) / (r + 1.0);
        2.0 * (c[1][1] - rho * c[1][2]) * material.toughness.gmc() / (yc * yc)
    }
}

const ALPHA: ParamInfo = ParamInfo::quantity(
    "alpha",
    "alpha of the permanent shear strain along the fibres, gamma = tau/G12 + alpha tau^3 up to S12, such as \"2.4e-8 1/MPa^3\"; \
     none if left out",
    HahnTsai::ALPHA,
)
.above(0.0)
.optional();
const LOWER: ParamInfo = ParamInfo::flag(
    "lower_strengths",
    "whether strengths are lowered, the toughness kept, where a cell is too wide for them; otherwise it is refused",
);

const BREAKS: ParamInfo = ParamInfo::word(
    "breaks",
    "what breaks",
    &[
        ("all", "fibres and matrix"),
        ("fibres", "fibres, in cells as wide as these allow; the matrix does not crack"),
        (
            "splits",
            "fibres, and the matrix by cracks along them and through their ply, as far apart as plies of one angle are thick",
        ),
    ],
);

const FIBRES: ParamInfo = ParamInfo::word(
    "fibres",
    "which fibres of a cell decide when they break across it",
    &[
        ("mean", "those of a ply in the mean"),
        (
            "faces",
            "those at the faces of the plies of one angle, which break as one; where plies come apart and bend by themselves",
        ),
    ],
);

impl Plugin for CrackBand {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::PlyLaw,
        name: "crack-band",
        summary: "damage in four modes that softens linearly to the toughness of each, with permanent shear strain",
        source: "Hashin 1980; Bazant and Oh 1983; Lapczyk and Hurtado 2007; Hahn and Tsai 1973",
        params: &[BREAKS, FIBRES, ALPHA, LOWER],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let alpha = if params.has(&ALPHA) { Some(params.number(&ALPHA)?) } else { None };
        let breaks = match params.word(&BREAKS)? {
            "fibres" => Breaks::Fibres,
            "splits" => Breaks::Splits,
            _ => Breaks::All,
        };
        let faces = params.word(&FIBRES)? == "faces";
        Ok(Built::PlyLaw(Box::new(Self { alpha, breaks, faces, lower_strengths: params.flag(&LOWER)? })))
    }
}
