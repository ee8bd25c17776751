//! Puck's action-plane criterion, three-dimensional, and what its plane form shares with it.

use super::action_plane::{Signs, Tractions, maximise};
use crate::prelude::*;
use fem_core::plugin::Dimension;
use std::f64::consts::{FRAC_PI_2, PI};

/// Fibre failure in Puck's criteria.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum FibreFailure {
    /// σ11/Xt or −σ11/Xc.
    #[default]
    Simple,
    /// The same with σ11 − (ν12 − ν12f mσf E1/E1f)(σ22 + σ33) for σ11: the stress in the fibres counts, which differs
    /// across the fibre from that in the matrix by mσf.
    Extended {
        /// Young's modulus of the fibres, Pa.
        e1f: f64,
        /// Poisson's ratio of the fibres.
        nu12f: f64,
        /// Magnification mσf: 1.1 for carbon, 1.3 for glass fibres.
        msf: f64,
    },
}

pub(crate) const FIBRE: ParamInfo = ParamInfo::word(
    "fibre",
    "stress by which the fibres fail",
    &[("simple", "s11 alone"), ("extended", "that in the fibres, which takes the three constants below")],
);
pub(crate) const E1F: ParamInfo =
    ParamInfo::quantity("e1f", "Young's modulus of the fibres", Dimension::PRESSURE).above(0.0).optional();
pub(crate) const NU12F: ParamInfo = ParamInfo::number("nu12f", "Poisson's ratio of the fibres").optional();
pub(crate) const MSF: ParamInfo =
    ParamInfo::number("msf", "stress magnification, 1.1 for carbon, 1.3 for glass").optional();

impl FibreFailure {
    fn from_params(params: &Params) -> Result<Self, ParamError> {
        match params.word(&FIBRE)? {
            "extended" => Ok(Self::Extended {
                e1f: params.number(&E1F)?,
                nu12f: params.number(&NU12F)?,
                msf: params.number(&MSF)?,
            }),
            _ => Ok(Self::Simple),
        }
    }

    /// Tension and compression.
    #[inline]
    pub(crate) fn exposures(&self, s: &Stress6<Ply>, m: &Material) -> [f64; 2] {
        let along = match *self {
            Self::Simple => s.s11(),
            Self::Extended { e1f, nu12f, msf } => {
                s.s11() - (m.elastic.nu12 - nu12f * msf * m.elastic.e1 / e1f) * (s.s22() + s.s33())
            }
        };
        if along >= 0.0 { [along / m.strengths.xt(), 0.0] } else { [0.0, -along / m.strengths.xc()] }
    }

    /// What tension and compression do not exceed over a range of stresses.
    #[inline]
    pub(crate) fn bounds(&self, s: &StressRange, m: &Material) -> [f64; 2] {
        let along = match *self {
            Self::Simple => s.s11(),
            Self::Extended { e1f, nu12f, msf } => {
                s.s11() - (s.s22() + s.s33()) * (m.elastic.nu12 - nu12f * msf * m.elastic.e1 / e1f)
            }
        };
        [along.positive().high / m.strengths.xt(), -along.negative().low / m.strengths.xc()]
    }
}

/// The largest factor that [`weakening`] has.
pub(crate) const MOST_WEAKENED: f64 = 2.0;

/// Factor on the inter-fibre exposure `inter` beside the exposure `fibre` of the fibres: single fibres that break early
/// weaken the matrix. 1 up to half of the fibre failure, Puck's ellipse with s = m = 1/2 beyond.
pub(crate) fn weakening(inter: f64, fibre: f64) -> f64 {
    const S: f64 = 0.5;
    const M: f64 = 0.5;
    if fibre == 0.0 || inter == 0.0 {
        return 1.0;
    }
    let c = (inter / fibre).clamp(M, 1.0 / S);
    let a = (1.0 - S) / (1.0 - M * M).sqrt();
    let ca = c * a;
    1.0 / (c * (a * (c * c * (a * a - S * S) + 1.0).sqrt() + S) / (ca * ca + 1.0))
}

/// Puck's inter-fibre failure on the plane of largest exposure, and fibre failure.
///
/// On a plane at θ about the fibre act
///
/// ```text
/// σn  = σ22 c² + σ33 s² + 2 σ23 s c    τnt = (σ33 − σ22) s c + σ23 (c² − s²)    τn1 = σ31 s + σ12 c
/// RA  = Yc/(2 (1 + p23c)),  P = (p23 τnt²/RA + p12 τn1²/S12)/(τnt² + τn1²),  t or c by the sign of σn
/// σn ≥ 0:  fE = √{[(1/Yt − P) σn]² + (τnt/RA)² + (τn1/S12)²} + P σn
/// σn < 0:  fE = √{(P σn)² + (τnt/RA)² + (τn1/S12)²} + P σn
/// ```
///
/// The exposure, the maximum of fE over −90° < θ ≤ 90°, belongs to inter-fibre tension or compression by the sign of σn
/// on that plane ([`Puck::action_plane`]). It is homogeneous of degree 1, 1/exposure is the reserve factor. Only the
/// inclinations of the fracture surface are parameters; the defaults are those recommended for carbon/epoxy by Puck,
/// Kopp and Knops (2002), p12t = 0.35, p12c = 0.30, p23t = p23c = 0.25; for glass/epoxy 0.30, 0.25, 0.20. The search
/// looks at a plane per degree and refines every maximum among them.
#[derive(Debug, Clone, Copy)]
pub struct Puck {
    /// Inclination at σn = 0 towards tension, shear along the fibre.
    pub p12t: f64,
    /// Towards compression, shear along the fibre.
    pub p12c: f64,
    /// Towards tension, shear across the fibre.
    pub p23t: f64,
    /// Towards compression, shear across the fibre.
    pub p23c: f64,
    /// Fibre failure.
    pub fibre: FibreFailure,
    /// Whether a stress along the fibres weakens the matrix.
    pub weakening: bool,
}

impl Default for Puck {
    fn default() -> Self {
        Self {
            p12t: P12T.default_number(),
            p12c: P12C.default_number(),
            p23t: P23T.default_number(),
            p23c: P23C.default_number(),
            fibre: FibreFailure::Simple,
            weakening: false,
        }
    }
}

/// Stresses on a plane that contains the fibre, at the angle with sine `s` and cosine `c`: σn, τnt, τn1.
#[inline]
pub(crate) fn tractions(t: &Stress6<Ply>, s: f64, c: f64) -> (f64, f64, f64) {
    (
        t.s22() * c * c + t.s33() * s * s + 2.0 * t.s23() * s * c,
        (t.s33() - t.s22()) * s * c + t.s23() * (c * c - s * s),
        t.s31() * s + t.s12() * c,
    )
}

/// A plane with its exposure; `opens` where σn ≥ 0.
struct WorstPlane {
    angle: f64,
    exposure: f64,
    opens: bool,
}

impl Puck {
    /// The plane of largest inter-fibre exposure: its angle θ from the ply's plane about the fibre, radians, and the
    /// exposure, without weakening; −90° < θ ≤ 90°. Of equal planes any.
    pub fn action_plane(&self, s: &Stress6<Ply>, m: &Material) -> (f64, f64) {
        let worst = self.worst_plane(s, m);
        (worst.angle - PI * (worst.angle / PI - 0.5).ceil(), worst.exposure)
    }

    /// fE has a kink where σn changes sign and may have a maximum right on either side of it, and on either side of a plane
    /// without τnt, where P changes fast: the search runs from one of these planes to the next.
    fn worst_plane(&self, s: &Stress6<Ply>, m: &Material) -> WorstPlane {
        let r = &m.strengths;
        let (yt, s12, ra) = (1.0 / r.yt(), 1.0 / r.s12(), 2.0 * (1.0 + self.p23c) / r.yc());
        let square = |v: f64| v * v;
        let Signs { principal, half } = Signs::of(s);
        let mut worst = WorstPlane { angle: principal, exposure: f64::NEG_INFINITY, opens: true };
        for (start, width, opens) in [
            (principal - half, half, true),
            (principal, half, true),
            (principal + half, FRAC_PI_2 - half, false),
            (principal + FRAC_PI_2, FRAC_PI_2 - half, false),
        ] {
            if width <= 0.0 {
                continue;
            }
            let (sin0, cos0) = start.sin_cos();
            let (angle, exposure) = maximise(width, |sin, cos| {
                let (n, t, l) = tractions(s, sin0 * cos + cos0 * sin, cos0 * cos - sin0 * sin);
                let (t, l) = (t * t, l * l);
                let (p23, p12) = if opens { (self.p23t, self.p12t) } else { (self.p23c, self.p12c) };
                let shear = t + l;
                let p = if shear > 0.0 { (p23 * ra * t + p12 * s12 * l) / shear } else { 0.0 };
                let normal = if opens { (yt - p) * n } else { p * n };
                (square(normal) + t * square(ra) + l * square(s12)).sqrt() + p * n
            });
            if exposure > worst.exposure || exposure.is_nan() {
                worst = WorstPlane { angle: start + angle, exposure, opens };
            }
        }
        worst
    }

    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 4] {
        let [tension, compression] = self.fibre.exposures(s, m);
        let WorstPlane { exposure: mut inter, opens, .. } = self.worst_plane(s, m);
        if self.weakening {
            inter *= weakening(inter, tension.max(compression));
        }
        [
            Terms::linear(tension),
            Terms::linear(compression),
            Terms::linear(inter).when(opens),
            Terms::linear(inter).when(!opens),
        ]
    }
}

impl FailureCriterion for Puck {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["fibre tension", "fibre compression", "inter-fibre tension", "inter-fibre compression"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12],
            invariant_about_fibre: true,
        };
        &INFO
    }

    from_terms!();

    /// fE grows with σn, with P where σn > 0, and with the shears, which at σn < 0 are all that it has.
    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let r = &m.strengths;
        let (yt, s12, ra) = (1.0 / r.yt(), 1.0 / r.s12(), 2.0 * (1.0 + self.p23c) / r.yc());
        let Tractions { normal, across, along } = Tractions::of(s);
        let shear = (across * ra).hypot(along * s12);
        let (p, n) = (f64::max(self.p23t * ra, self.p12t * s12), normal.positive().high);
        let most = if self.weakening { MOST_WEAKENED } else { 1.0 };
        let [tension, compression] = self.fibre.bounds(s, m);
        out.copy_from_slice(&[
            tension,
            compression,
            when(normal.reaches_positive(), most * (((yt - p) * n).hypot(shear) + p * n)),
            when(normal.reaches_negative(), most * shear),
        ]);
    }

    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        let r = &m.strengths;
        let ra = r.yc() / (2.0 * (1.0 + self.p23c));
        check_slope("p12t Yt/S12 < 1", self.p12t * r.yt() / r.s12())?;
        check_slope("p23t Yt/RA < 1", self.p23t * r.yt() / ra)
    }
}

/// Refuses a fracture surface whose slope makes it concave.
pub(crate) fn check_slope(condition: &'static str, slope: f64) -> Result<(), UnmetCondition> {
    if slope < 1.0 {
        return Ok(());
    }
    let reason = "otherwise the fracture surface is not convex";
    Err(UnmetCondition { condition, reason, values: vec![(condition.trim_end_matches(" < 1").into(), slope, "")] })
}

pub(crate) const WEAKENING: ParamInfo = ParamInfo::word(
    "weakening",
    "whether fibre stress above half of their failure weakens the matrix",
    &[("off", ""), ("on", "")],
);

/// `fibre` and `weakening` of either form.
pub(crate) fn read_common_params(params: &Params) -> Result<(FibreFailure, bool), ParamError> {
    Ok((FibreFailure::from_params(params)?, params.word(&WEAKENING)? == "on"))
}

const P12T: ParamInfo = ParamInfo::number("p12t", "inclination, tension, shear 12; recommended for carbon")
    .at_least(0.0)
    .at_most(1.0)
    .default(0.35);
const P12C: ParamInfo =
    ParamInfo::number("p12c", "inclination, compression, shear 12").at_least(0.0).at_most(1.0).default(0.30);
const P23T: ParamInfo =
    ParamInfo::number("p23t", "inclination, tension, shear 23").at_least(0.0).at_most(1.0).default(0.25);
const P23C: ParamInfo =
    ParamInfo::number("p23c", "inclination, compression, shear 23").at_least(0.0).at_most(1.0).default(0.25);

impl Plugin for Puck {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "puck",
        summary: "inter-fibre failure on the action plane, fibre failure, three-dimensional",
        source: "Puck and Schuermann, Compos. Sci. Technol. 58 (1998) 1045 and 62 (2002) 1633; VDI 2014 Part 3",
        params: &[P12T, P12C, P23T, P23C, FIBRE, E1F, NU12F, MSF, WEAKENING],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let (fibre, weakening) = read_common_params(params)?;
        Ok(Built::Criterion(Box::new(Self {
            p12t: params.number(&P12T)?,
            p12c: params.number(&P12C)?,
            p23t: params.number(&P23T)?,
            p23c: params.number(&P23C)?,
            fibre,
            weakening,
        })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fem_core::material::{Elastic, Strengths, Toughnesses};

    /// Maxima on either side of the plane without σn, 1.5° apart, which steps of a degree do not tell from each other. The
    /// larger one, from eight million planes, is 1.0522654434445535.
    #[test]
    fn close_maxima_beside_the_plane_without_normal_stress() {
        let strengths = [(Strength::Yt, 64e6), (Strength::Yc, 170e6), (Strength::S12, 100e6)];
        let m = Material {
            name: "IM6/934".into(),
            elastic: Elastic::transversely_isotropic(165e9, 9e9, 0.33, 0.40, 5.2e9),
            density: None,
            strengths: strengths.iter().fold(Strengths::default(), |s, (which, v)| s.with(*which, *v)),
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
        };
        let [s22, s33, s12, s23, s31]: [f64; 5] =
            [12795262.767671375, -75097312.64209768, -80818910.33112697, -38818093.091686025, 29823934.232466854];
        for k in 0..180 {
            let turn = f64::from(k).to_radians();
            let (sin, cos) = turn.sin_cos();
            let twice = 2.0 * s23 * sin * cos;
            let turned = Stress6::new([
                0.0,
                s22 * cos * cos + s33 * sin * sin + twice,
                s22 * sin * sin + s33 * cos * cos - twice,
                s12 * cos + s31 * sin,
                (s33 - s22) * sin * cos + s23 * (cos * cos - sin * sin),
                s31 * cos - s12 * sin,
            ]);
            let (angle, exposure) = Puck::default().action_plane(&turned, &m);
            assert!((exposure - 1.0522654434445535).abs() < 1e-12, "turned by {k}°: {exposure} at {angle}");
            assert!(angle > -FRAC_PI_2 && angle <= FRAC_PI_2, "{angle}");
            let off = (angle + turn - 8.816625_f64.to_radians()) / PI;
            assert!((off - off.round()).abs() < 1e-6, "turned by {k}°: at {angle}");
        }
    }
}
