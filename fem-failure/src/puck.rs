//! Puck's action-plane criterion, three-dimensional, and what its plane form shares with it.

use crate::action_plane::{Angles, maximise};
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

impl FibreFailure {
    pub(crate) const PARAMS: [ParamInfo; 4] = [
        ParamInfo { name: "fibre", doc: "fibre failure by s11 alone, \"simple\" (default), or \"extended\"" },
        ParamInfo { name: "e1f", doc: "Young's modulus of the fibres, pressure; required by \"extended\"" },
        ParamInfo { name: "nu12f", doc: "Poisson's ratio of the fibres; required by \"extended\"" },
        ParamInfo { name: "msf", doc: "stress magnification, 1.1 carbon, 1.3 glass; required by \"extended\"" },
    ];

    fn from_params(params: &Params) -> Result<Self, ParamError> {
        match params.choice("fibre", &["simple", "extended"])? {
            "extended" => Ok(Self::Extended {
                e1f: params.positive("e1f", Dimension::PRESSURE, None)?,
                nu12f: params.number("nu12f", None)?,
                msf: params.number("msf", None)?,
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
}

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
/// looks at 180 planes and refines every maximum among them.
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
        Self { p12t: 0.35, p12c: 0.30, p23t: 0.25, p23c: 0.25, fibre: FibreFailure::Simple, weakening: false }
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

impl Puck {
    /// The plane of largest inter-fibre exposure: its angle θ from the ply's plane about the fibre, radians, and the
    /// exposure, without weakening; −90° < θ ≤ 90°. Of equal planes any.
    pub fn action_plane(&self, s: &Stress6<Ply>, m: &Material) -> (f64, f64) {
        let r = &m.strengths;
        let (yt, s12, ra) = (1.0 / r.yt(), 1.0 / r.s12(), 2.0 * (1.0 + self.p23c) / r.yc());
        let square = |v: f64| v * v;
        let (angle, exposure) = maximise(Angles::HalfTurn, |sin, cos| {
            let (n, t, l) = tractions(s, sin, cos);
            let (t, l) = (t * t, l * l);
            let (p23, p12) = if n >= 0.0 { (self.p23t, self.p12t) } else { (self.p23c, self.p12c) };
            let shear = t + l;
            let p = if shear > 0.0 { (p23 * ra * t + p12 * s12 * l) / shear } else { 0.0 };
            let normal = if n >= 0.0 { (yt - p) * n } else { p * n };
            (square(normal) + t * square(ra) + l * square(s12)).sqrt() + p * n
        });
        (if angle > FRAC_PI_2 { angle - PI } else { angle }, exposure)
    }

    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 4] {
        let [tension, compression] = self.fibre.exposures(s, m);
        let (angle, mut inter) = self.action_plane(s, m);
        if self.weakening {
            inter *= weakening(inter, tension.max(compression));
        }
        let opens = tractions(s, angle.sin(), angle.cos()).0 >= 0.0;
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

    fn check(&self, m: &Material) -> Result<(), String> {
        let r = &m.strengths;
        let ra = r.yc() / (2.0 * (1.0 + self.p23c));
        for (name, slope) in [("p12t Yt/S12", self.p12t * r.yt() / r.s12()), ("p23t Yt/RA", self.p23t * r.yt() / ra)] {
            if slope >= 1.0 {
                return Err(format!("{name} < 1 is required for a convex fracture surface, got {slope:.6}"));
            }
        }
        Ok(())
    }
}

pub(crate) const WEAKENING: ParamInfo = ParamInfo {
    name: "weakening",
    doc: "whether stress along the fibres weakens the matrix: \"off\" (default) or \"on\"",
};

/// `fibre` and `weakening` of either form.
pub(crate) fn common_params(params: &Params) -> Result<(FibreFailure, bool), ParamError> {
    Ok((FibreFailure::from_params(params)?, params.choice("weakening", &["off", "on"])? == "on"))
}

impl Plugin for Puck {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "puck",
        summary: "inter-fibre failure on the action plane, fibre failure, three-dimensional",
        source: "Puck and Schuermann, Compos. Sci. Technol. 58 (1998) 1045 and 62 (2002) 1633; VDI 2014 Part 3",
        params: &[
            ParamInfo { name: "p12t", doc: "inclination, tension, shear 12; 0.35 (carbon, recommended) by default" },
            ParamInfo { name: "p12c", doc: "inclination, compression, shear 12; 0.30 by default" },
            ParamInfo { name: "p23t", doc: "inclination, tension, shear 23; 0.25 by default" },
            ParamInfo { name: "p23c", doc: "inclination, compression, shear 23; 0.25 by default" },
            FibreFailure::PARAMS[0],
            FibreFailure::PARAMS[1],
            FibreFailure::PARAMS[2],
            FibreFailure::PARAMS[3],
            WEAKENING,
        ],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let (fibre, weakening) = common_params(params)?;
        Ok(Built::Criterion(Box::new(Self {
            p12t: number_in(params, "p12t", 0.0..=1.0, 0.35)?,
            p12c: number_in(params, "p12c", 0.0..=1.0, 0.30)?,
            p23t: number_in(params, "p23t", 0.0..=1.0, 0.25)?,
            p23c: number_in(params, "p23c", 0.0..=1.0, 0.25)?,
            fibre,
            weakening,
        })))
    }
}
