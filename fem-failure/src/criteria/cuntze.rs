//! Cuntze's failure mode concept, three-dimensional and plane.

use super::action_plane::Tractions;
use super::plane_stress::OutOfPlane;
use crate::prelude::*;
use crate::terms;

/// Efforts of the five modes and their interaction.
const MODES: &[&str] =
    &["fibre tension", "fibre compression", "matrix tension", "matrix compression", "matrix shear", "interaction"];

/// Negative efforts count as none; the last mode is (Σ effortᵐ)^(1/m).
fn interact(efforts: [f64; 5], exponent: f64) -> [Terms; 6] {
    let e = efforts.map(macaulay);
    // Relative to the largest, so that no power overflows or underflows; NaN comes through.
    let largest = e.iter().fold(0.0_f64, |a, &b| if b <= a { a } else { b });
    let total = if largest > 0.0 {
        largest * e.iter().map(|e| (e / largest).powf(exponent)).sum::<f64>().powf(1.0 / exponent)
    } else {
        largest
    };
    [e[0], e[1], e[2], e[3], e[4], total].map(Terms::linear)
}

/// Cuntze's failure mode concept for a transversely isotropic ply.
///
/// ```text
/// I2 = σ22 + σ33, I3 = σ31² + σ12², I4 = (σ22 − σ33)² + 4 σ23², I5 = (σ22 − σ33)(σ31² − σ12²) − 4 σ23 σ31 σ12
/// fibre tension       σ11/Xt
/// fibre compression   −σ11/Xc
/// matrix tension      (I2 + √I4)/(2 Yt)
/// matrix compression  [(b23 − 1) I2 + b23 √I4]/Yc
/// matrix shear        ∛[I3^1.5 + b12 (I2 I3 − I5)]/S12
/// interaction         (Σ effortᵐ)^(1/m)
/// ```
///
/// Negative efforts count as 0. All are of degree 1; the interaction, never below a single effort, governs, so that a
/// uniaxial strength is met at a reserve factor of 0.95 to 1. b12 and b23 stand for friction and belong to the
/// material; the defaults b12 = 0.1, b23 = 1.09 and m = 3.1 are Cuntze's typical values.
#[derive(Debug, Clone, Copy)]
pub struct Cuntze {
    /// Interaction exponent.
    pub m: f64,
    /// Friction in matrix shear.
    pub b12: f64,
    /// Friction in matrix compression.
    pub b23: f64,
}

impl Default for Cuntze {
    fn default() -> Self {
        Self { m: M.default_number(), b12: B12.default_number(), b23: B23.default_number() }
    }
}

impl Cuntze {
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 6] {
        let r = &m.strengths;
        let (difference, i2) = (s.s22() - s.s33(), s.s22() + s.s33());
        let i3 = s.s31() * s.s31() + s.s12() * s.s12();
        let root4 = difference.hypot(2.0 * s.s23());
        let i5 = difference * (s.s31() * s.s31() - s.s12() * s.s12()) - 4.0 * s.s23() * s.s31() * s.s12();
        interact(
            [
                s.s11() / r.xt(),
                -s.s11() / r.xc(),
                (i2 + root4) / (2.0 * r.yt()),
                ((self.b23 - 1.0) * i2 + self.b23 * root4) / r.yc(),
                (i3 * i3.sqrt() + self.b12 * (i2 * i3 - i5)).cbrt() / r.s12(),
            ],
            self.m,
        )
    }
}

impl FailureCriterion for Cuntze {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: MODES,
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12],
            invariant_about_fibre: true,
        };
        &INFO
    }

    from_terms!();

    /// I2 I3 − I5 is 2 I3 times σn on the plane of the whole shear along the fibre.
    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let r = &m.strengths;
        let Tractions { normal, across, along } = Tractions::of(s);
        let sum = (s.s22() + s.s33()).high;
        let opened = normal.positive().high;
        let efforts = [
            s.s11().positive().high / r.xt(),
            -s.s11().negative().low / r.xc(),
            opened / r.yt(),
            ((self.b23 - 1.0) * sum + 2.0 * self.b23 * across) / r.yc(),
            (along * along * (along + 2.0 * self.b12 * opened)).cbrt() / r.s12(),
        ];
        terms::indices(interact(efforts, self.m), out);
    }
}

const M: ParamInfo =
    ParamInfo::number("m", "interaction exponent; the default is typical").at_least(1.0).at_most(10.0).default(3.1);
const B12: ParamInfo = ParamInfo::number("b12", "friction in matrix shear; the default is typical")
    .at_least(0.05)
    .at_most(0.3)
    .default(0.1);
const B23: ParamInfo = ParamInfo::number("b23", "friction in matrix compression; the default is typical")
    .at_least(1.0)
    .at_most(1.6)
    .default(1.09);
const MU: ParamInfo =
    ParamInfo::number("mu", "friction in matrix shear; the default is typical").at_least(0.0).at_most(0.5).default(0.1);

impl Plugin for Cuntze {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "cuntze",
        summary: "failure mode concept: five invariant modes and their interaction, three-dimensional",
        source: "Cuntze, Compos. Sci. Technol. 66 (2006) 1081",
        params: &[M, B12, B23],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self {
            m: params.number(&M)?,
            b12: params.number(&B12)?,
            b23: params.number(&B23)?,
        })))
    }
}

/// Cuntze's failure mode concept in plane stress.
///
/// ```text
/// σ11/Xt, −σ11/Xc, σ22/Yt, −σ22/Yc, (|σ12| + μ σ22)/S12 and their interaction, as in `cuntze`
/// ```
///
/// The friction stands in the numerator: σ12/(S12 − μ σ22) would not be proportional to the load. Without σ12 there is no
/// shear to help or hinder, and the effort of that mode is 0.
#[derive(Debug, Clone, Copy)]
pub struct Cuntze2d {
    /// Interaction exponent.
    pub m: f64,
    /// Friction in matrix shear.
    pub mu: f64,
    /// Treatment of the other three stresses.
    pub out_of_plane: OutOfPlane,
}

impl Default for Cuntze2d {
    fn default() -> Self {
        Self { m: M.default_number(), mu: MU.default_number(), out_of_plane: OutOfPlane::default() }
    }
}

impl Cuntze2d {
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 6] {
        if !self.out_of_plane.admits(s) {
            return [Terms::REFUSED; 6];
        }
        let r = &m.strengths;
        let shear = if s.s12() == 0.0 { 0.0 } else { (s.s12().abs() + self.mu * s.s22()) / r.s12() };
        let (along, across) = (s.s11(), s.s22());
        interact([along / r.xt(), -along / r.xc(), across / r.yt(), -across / r.yc(), shear], self.m)
    }
}

impl FailureCriterion for Cuntze2d {
    fn info(&self) -> &CriterionInfo {
        const INFO: CriterionInfo = CriterionInfo {
            site: Site::Ply,
            modes: MODES,
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12],
            invariant_about_fibre: false,
        };
        &INFO
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        if !self.out_of_plane.admits_all(s) {
            return out.fill(f64::INFINITY);
        }
        let (r, along, across) = (&m.strengths, s.s11(), s.s22());
        let efforts = [
            along.positive().high / r.xt(),
            -along.negative().low / r.xc(),
            across.positive().high / r.yt(),
            -across.negative().low / r.yc(),
            (s.s12().magnitude() + self.mu * across.high) / r.s12(),
        ];
        terms::indices(interact(efforts, self.m), out);
    }

    fn scope(&self) -> &'static str {
        self.out_of_plane.scope()
    }
}

impl Plugin for Cuntze2d {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "cuntze-2d",
        summary: "failure mode concept in plane stress: five modes and their interaction",
        source: "Cuntze and Freund, Compos. Sci. Technol. 64 (2004) 343",
        params: &[M, MU, OutOfPlane::PARAM],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Criterion(Box::new(Self {
            m: params.number(&M)?,
            mu: params.number(&MU)?,
            out_of_plane: OutOfPlane::from_params(params)?,
        })))
    }
}
