//! LaRC05, three-dimensional.

use super::action_plane::{Signs, Tractions, maximise};
use super::larc::{ALPHA0, Friction, Turned, alpha0_from, turned};
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
    index_of_shears((t, f.st - f.eta_t * n), (l, m.strengths.s12() - f.eta_l * n), n, m)
}

/// I of each shear beside its strength, and of σn.
#[inline]
fn index_of_shears(across: (f64, f64), along: (f64, f64), n: f64, m: &Material) -> f64 {
    // Tension beyond strength/friction leaves nothing against any shear: the formula itself would fall again.
    let slip = |(shear, strength): (f64, f64)| match shear {
        0.0 => 0.0,
        _ if strength <= 0.0 => f64::INFINITY,
        _ => shear / strength,
    };
    let (across, along) = (slip(across), slip(along));
    let opening = macaulay(n / m.strengths.yt());
    across * across + along * along + opening * opening
}

/// What [`index`] does not exceed under σn and shears of at most these sizes: it grows with all three until no strength is left.
fn most(n: f64, t: f64, l: f64, f: &Friction, m: &Material) -> f64 {
    /// Strength, over that without σn, below which rounding could make it none.
    const SPENT: f64 = 1e-6;
    let left = |strength: f64, eta: f64| if strength - eta * n > SPENT * strength { strength - eta * n } else { 0.0 };
    index_of_shears((t, left(f.st, f.eta_t)), (l, left(m.strengths.s12(), f.eta_l)), n, m)
}

impl Larc05 {
    /// What [`Self::kinking`] does not exceed where σ11 lies in `s11`, under what acts on planes about the fibres.
    fn most_kinked(s11: Interval, planes: &Tractions, f: &Friction, m: &Material) -> f64 {
        let shear = Interval { low: 0.0, high: planes.along };
        let Some(phi) = f.misalignments(s11, planes.normal, shear, m) else { return f64::INFINITY };
        let Turned { normal, shear, sin } = Turned::of(s11, planes.normal, shear, phi);
        let across = planes.across + planes.along * sin.magnitude();
        most(normal.high, across, shear.magnitude(), f, m)
    }

    /// Where σn changes sign the curvature of the index jumps, and maxima may stand close on either side: the search runs
    /// from one such plane to the next.
    fn matrix(s: &Stress6<Ply>, f: &Friction, m: &Material) -> f64 {
        let Signs { principal, half } = Signs::of(s);
        let mut worst = f64::NEG_INFINITY;
        for (start, width) in [(principal - half, 2.0 * half), (principal + half, PI - 2.0 * half)] {
            if width <= 0.0 {
                continue;
            }
            let (sin0, cos0) = start.sin_cos();
            let (_, found) = maximise(width, |sin, cos| {
                let (n, t, l) = tractions(s, sin0 * cos + cos0 * sin, cos0 * cos - sin0 * sin);
                index(n, t, l, f, m)
            });
            if found > worst || found.is_nan() {
                worst = found;
            }
        }
        worst
    }

    fn kinking(s: &Stress6<Ply>, f: &Friction, m: &Material) -> f64 {
        // Where τ12 changes sign so does φ, and the index jumps: the search runs from one such plane to the next, where
        // τ12 = shear sin, τ31 = shear cos of the angle between.
        let shear = s.s12().hypot(s.s31());
        let (sin0, cos0) = if shear > 0.0 { (-s.s12() / shear, s.s31() / shear) } else { (0.0, 1.0) };
        maximise(PI, |sin, cos| {
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

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let f = Friction::new(self.alpha0, m);
        let (planes, s11, half) = (Tractions::of(s), s.s11(), -0.5 * m.strengths.xc());
        let kinked = |low: f64, high: f64| Self::most_kinked(Interval { low, high }, &planes, &f, m);
        out.copy_from_slice(&[
            s11.positive().high / m.strengths.xt(),
            if s11.low <= half { kinked(s11.low, s11.high.min(half)) } else { 0.0 },
            if s11.reaches_negative() && s11.high > half { kinked(s11.low.max(half), s11.high.min(0.0)) } else { 0.0 },
            most(planes.normal.high, planes.across, planes.along, &f, m),
        ]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use fem_core::material::{Elastic, Strengths, Toughnesses};

    /// Maxima at 156.84° and 158.745°, on either side of the plane without σn at 158.704°, which steps of a degree do not
    /// tell from each other. The larger one is that of 360 000 planes.
    #[test]
    fn close_maxima_beside_the_plane_without_normal_stress() {
        let strengths = [
            (Strength::Xt, 500e6),
            (Strength::Xc, 400e6),
            (Strength::Yt, 70176779.57536194),
            (Strength::Yc, 203093736.6503128),
            (Strength::S12, 90339275.99457273),
        ];
        let m = Material {
            name: "any".into(),
            elastic: Elastic::transversely_isotropic(138e9, 11e9, 0.28, 0.40, 5.5e9),
            density: None,
            strengths: strengths.iter().fold(Strengths::default(), |s, (which, v)| s.with(*which, *v)),
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
        };
        let s = Stress6::new([
            0.0,
            -60229299.708229356,
            9180665.906942202,
            15487872.983457291,
            -75468517.60382588,
            -16235859.462406086,
        ]);
        let mut indices = [f64::NAN; 4];
        Larc05::default().indices(&s, &m, &mut indices);
        assert!((indices[3] - 1.1177416746354565).abs() < 1e-9, "{indices:?}");
    }
}
