//! LaRC03, plane stress.

use super::action_plane::maximise;
use super::larc::{ALPHA0, Friction, Turned, alpha0_from, turned};
use super::plane_stress::OutOfPlane;
use crate::prelude::*;

/// LaRC03 for a ply in plane stress, with σ22m, σ12m in the frame of the misaligned fibres.
///
/// ```text
/// fibre tension       σ11 ≥ 0            (σ11 − ν12 σ22)/Xt
/// fibre compression   σ11 < 0, σ22m < 0  ⟨|σ12m| + ηL σ22m⟩/S12
///                     σ11 < 0, σ22m ≥ 0  M(σ22m, σ12m)
/// matrix tension      σ22 ≥ 0            M(σ22, σ12)
/// matrix compression  σ22 < 0            C(σ22, σ12), for σ11 < −Yc C(σ22m, σ12m)
/// M(σ, τ) = (1 − g) σ/Yt + g (σ/Yt)² + (τ/S12)²
/// C(σ, τ) = max over 0 ≤ α ≤ α0 of (⟨−σ cos α (sin α − ηT cos α)⟩/ST)² + (⟨cos α (|τ| + ηL σ cos α)⟩/S12)²
/// misalignment φ = [|σ12| + (G12 − Xc) φc]/(G12 + σ11 − σ22); without a positive denominator the index is +∞
/// ```
///
/// ST, ηT, ηL and φc follow from α0, Yc, S12 and Xc. g = GIc/GIIc; by default it is estimated from moduli and strengths,
/// 1.12² (Λ22/Λ44)(Yt/S12)² with Λ22 = 2 (1/E2 − ν21²/E1), Λ44 = 1/G12. Yt and S12 are taken as the in-situ strengths of
/// the ply. φ depends on the load: no closed form of the reserve factor.
#[derive(Debug, Clone, Copy)]
pub struct Larc03 {
    /// Fracture angle under transverse compression, radians.
    pub alpha0: f64,
    /// g = GIc/GIIc, if measured.
    pub toughness_ratio: Option<f64>,
    /// Treatment of the other three stresses.
    pub out_of_plane: OutOfPlane,
}

impl Default for Larc03 {
    fn default() -> Self {
        Self {
            alpha0: ALPHA0.default_number().to_radians(),
            toughness_ratio: None,
            out_of_plane: OutOfPlane::default(),
        }
    }
}

impl Larc03 {
    fn toughness_ratio(&self, m: &Material) -> f64 {
        self.toughness_ratio.unwrap_or_else(|| {
            let (e, r) = (&m.elastic, &m.strengths);
            let nu21 = e.nu12 * e.e2 / e.e1;
            let l22 = 2.0 * (1.0 / e.e2 - nu21 * nu21 / e.e1);
            (1.12 * r.yt() / r.s12()).powi(2) * l22 * e.g12
        })
    }

    fn matrix_tension(&self, s22: f64, s12: f64, m: &Material) -> f64 {
        let (g, y) = (self.toughness_ratio(m), s22 / m.strengths.yt());
        (1.0 - g) * y + g * y * y + (s12 / m.strengths.s12()).powi(2)
    }

    /// What M does not exceed up to σ ≥ 0 and |τ|.
    fn most_in_tension(&self, normal: f64, shear: f64, m: &Material) -> f64 {
        let (g, y) = (self.toughness_ratio(m), normal / m.strengths.yt());
        (1.0 - g).max(0.0) * y + g * y * y + (shear / m.strengths.s12()).powi(2)
    }

    /// What C does not exceed over a range of σ, up to |τ|: across the fibre planes at α0 carry least, and a pressure only helps along it.
    fn most_in_compression(normal: Interval, shear: f64, f: &Friction, m: &Material) -> f64 {
        const ROUNDING: f64 = 1e-12;
        let across = normal.negative().low / m.strengths.yc();
        let along = (shear + f.eta_l * normal.positive().high) / m.strengths.s12();
        (1.0 + ROUNDING) * (across * across + along * along)
    }

    fn matrix_compression(&self, s22: f64, s12: f64, f: &Friction, m: &Material) -> f64 {
        let index = |sin: f64, cos: f64| {
            let across = macaulay(-s22 * cos * (sin - f.eta_t * cos) / f.st);
            let along = macaulay(cos * (s12.abs() + f.eta_l * s22 * cos) / m.strengths.s12());
            across * across + along * along
        };
        maximise(self.alpha0, index).1
    }
}

impl FailureCriterion for Larc03 {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["fibre tension", "fibre compression", "matrix tension", "matrix compression"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12],
            invariant_about_fibre: false,
        };
        &INFO
    }

    fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
        if !self.out_of_plane.admits(s) {
            return out.fill(f64::NAN);
        }
        out.fill(0.0);
        let f = Friction::new(self.alpha0, m);
        let (s11, s22, s12) = (s.s11(), s.s22(), s.s12().abs());
        let misaligned = f.misalignment(s11, s22, s12, m).map(|turn| turned(s11, s22, s12, turn));
        if s11 >= 0.0 {
            out[0] = (s11 - m.elastic.nu12 * s22) / m.strengths.xt();
        } else {
            out[1] = match misaligned {
                None => f64::INFINITY,
                Some((n, t)) if n < 0.0 => macaulay((t.abs() + f.eta_l * n) / m.strengths.s12()),
                Some((n, t)) => self.matrix_tension(n, t, m),
            };
        }
        if s22 >= 0.0 {
            out[2] = self.matrix_tension(s22, s12, m);
        } else if s11 >= -m.strengths.yc() {
            out[3] = self.matrix_compression(s22, s12, &f, m);
        } else {
            out[3] = misaligned.map_or(f64::INFINITY, |(n, t)| self.matrix_compression(n, t, &f, m));
        }
    }

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        if !self.out_of_plane.admits_all(s) {
            return out.fill(f64::INFINITY);
        }
        let f = Friction::new(self.alpha0, m);
        let (s11, s22, shear) = (s.s11(), s.s22(), s.s12().magnitude());
        let turned = |s11: Interval| {
            let shear = Interval { low: 0.0, high: shear };
            f.misalignments(s11, s22, shear, m).map(|phi| Turned::of(s11, s22, shear, phi))
        };
        let kinked = turned(s11.negative()).map_or(f64::INFINITY, |Turned { normal, shear, .. }| {
            let (s12, shear) = (m.strengths.s12(), shear.magnitude());
            let pressed = when(normal.reaches_negative(), (shear + f.eta_l * normal.negative().high) / s12);
            let opened = when(normal.reaches_positive(), self.most_in_tension(normal.positive().high, shear, m));
            f64::max(pressed, opened)
        });
        let straight = Self::most_in_compression(s22.negative(), shear, &f, m);
        let bent = || {
            let in_compression =
                |turned: Turned| Self::most_in_compression(turned.normal, turned.shear.magnitude(), &f, m);
            turned(s11.negative()).map_or(f64::INFINITY, in_compression)
        };
        let crushed = if s11.low < -m.strengths.yc() { f64::max(straight, bent()) } else { straight };
        let tension = (s11.positive() - s22 * m.elastic.nu12).high / m.strengths.xt();
        out.copy_from_slice(&[
            when(s11.reaches_positive(), tension),
            when(s11.reaches_negative(), kinked),
            when(s22.reaches_positive(), self.most_in_tension(s22.positive().high, shear, m)),
            when(s22.reaches_negative(), crushed),
        ]);
    }

    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        Friction::new(self.alpha0, m).check(m)
    }

    fn scope(&self) -> &'static str {
        self.out_of_plane.scope()
    }
}

const TOUGHNESS_RATIO: ParamInfo =
    ParamInfo::number("toughness_ratio", "GIc/GIIc; where it is left out, estimated from moduli and strengths")
        .at_least(0.0)
        .at_most(1.0)
        .optional();

impl Plugin for Larc03 {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "larc03",
        summary: "fibre kinking, matrix cracking on a plane and by toughness, in plane stress",
        source: "Davila and Camanho, NASA/TM-2003-212663",
        params: &[ALPHA0, TOUGHNESS_RATIO, OutOfPlane::PARAM],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let toughness_ratio = params.has(&TOUGHNESS_RATIO).then(|| params.number(&TOUGHNESS_RATIO)).transpose()?;
        let alpha0 = alpha0_from(params)?;
        Ok(Built::Criterion(Box::new(Self { alpha0, toughness_ratio, out_of_plane: OutOfPlane::from_params(params)? })))
    }
}
