//! LaRC05, three-dimensional.

use super::action_plane::{Angles, maximise};
use super::larc::{ALPHA0, Friction, alpha0_from, turned};
use super::puck::tractions;
use crate::prelude::*;
use std::f64::consts::PI;

/// LaRC05: matrix failure on the worst plane, kinking and splitting of misaligned fibres in the worst plane about them.
///
/// ```text
/// I(σn, τT, τL) = [τT/(ST − ηT σn)]² + [τL/(S12 − ηL σn)]² + (⟨σn⟩/Yt)²
/// fibre tension    σ11 ≥ 0             σ11/Xt
/// fibre kinking    σ11 ≤ −Xc/2         max over ψ of I(σ22m, τ23m, τ12m)
/// fibre splitting  −Xc/2 < σ11 < 0     the same
/// matrix                               max over α of I(σn, τT, τL)
/// ```
///
/// σn, τT, τL act on the plane at α about the fibre. m marks the frame of fibres turned within the plane at ψ by
/// φ = [|τ12| + (G12 − Xc) φc]/(G12 + σ11 − σ22), signed as τ12; without a positive denominator, or with shear on a
/// plane where tension leaves no strength against it, the index is +∞. ST, ηT, ηL and φc follow from α0, Yc, S12 and
/// Xc. Yt and S12 are taken as the in-situ strengths of the ply. Where ST is low, uniaxial tension Yt gives a little
/// more than 1. φ depends on the load: no closed form of the reserve factor.
#[derive(Debug, Clone, Copy)]
pub struct Larc05 {
    /// Fracture angle under transverse compression, radians.
    pub alpha0: f64,
}

impl Default for Larc05 {
    fn default() -> Self {
        Self { alpha0: ALPHA0.default_number().to_radians() }
    }
}

#[inline]
fn index(n: f64, t: f64, l: f64, f: &Friction, m: &Material) -> f64 {
    // Tension beyond strength/friction leaves nothing against any shear: the formula itself would fall again.
    let slip = |shear: f64, strength: f64| match shear {
        0.0 => 0.0,
        _ if strength <= 0.0 => f64::INFINITY,
        _ => shear / strength,
    };
    let (across, along) = (slip(t, f.st - f.eta_t * n), slip(l, m.strengths.s12() - f.eta_l * n));
    let opening = macaulay(n / m.strengths.yt());
    across * across + along * along + opening * opening
}

impl Larc05 {
    fn matrix(s: &Stress6<Ply>, f: &Friction, m: &Material) -> f64 {
        maximise(Angles::HalfTurn, |sin, cos| {
            let (n, t, l) = tractions(s, sin, cos);
            index(n, t, l, f, m)
        })
        .1
    }

    fn kinking(s: &Stress6<Ply>, f: &Friction, m: &Material) -> f64 {
        // Where τ12 changes sign so does φ, and the index jumps: the search runs from one such plane to the next, where
        // τ12 = shear sin, τ31 = shear cos of the angle between.
        let shear = s.s12().hypot(s.s31());
        let (sin0, cos0) = if shear > 0.0 { (-s.s12() / shear, s.s31() / shear) } else { (0.0, 1.0) };
        maximise(Angles::UpTo(PI), |sin, cos| {
            let (n, t, _) = tractions(s, sin0 * cos + cos0 * sin, cos0 * cos - sin0 * sin);
            let (t12, t31) = (shear * sin.max(0.0), shear * cos);
            match f.misalignment(s.s11(), n, t12, m) {
                None => f64::INFINITY,
                Some(turn) => {
                    let (nm, t12m) = turned(s.s11(), n, t12, turn);
                    index(nm, t * turn.1 - t31 * turn.0, t12m, f, m)
                }
            }
        })
        .1
    }
}

impl FailureCriterion for Larc05 {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: &["fibre tension", "fibre kinking", "fibre splitting", "matrix"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12],
            invariant_about_fibre: true,
        };
        &INFO
    }

    fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
        out.fill(0.0);
        let f = Friction::new(self.alpha0, m);
        if s.s11() >= 0.0 {
            out[0] = s.s11() / m.strengths.xt();
        } else if s.s11() <= -0.5 * m.strengths.xc() {
            out[1] = Self::kinking(s, &f, m);
        } else {
            out[2] = Self::kinking(s, &f, m);
        }
        out[3] = Self::matrix(s, &f, m);
    }

    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        Friction::new(self.alpha0, m).check(m)
    }
}

impl Plugin for Larc05 {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "larc05",
        summary: "matrix failure on the worst plane, fibre kinking and splitting, three-dimensional",
        source: "Pinho, Darvizeh, Robinson, Schuecker and Camanho, J. Compos. Mater. 46 (2012) 2313",
        params: &[ALPHA0],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self { alpha0: alpha0_from(params)? })))
    }
}
