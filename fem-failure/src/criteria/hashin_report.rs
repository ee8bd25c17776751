//! Hashin's criterion as AFWAL-TR-87-4117 uses it.

use super::hashin_1980::check_transverse_tension;
use crate::prelude::*;

/// Sign of σ22 σ33 in the tensile matrix mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Product {
    /// σ23² − σ22 σ33, Hashin's: unchanged by a rotation about the fibre.
    #[default]
    Minus,
    /// σ23² + σ22 σ33, as eq. (40) is printed.
    Plus,
}

/// AFWAL-TR-87-4117, eqs. (38)-(41).
///
/// ```text
/// fibre tension       σ11 ≥ 0        (σ11/Xt)² + (σ12² + σ31²)/S12²
/// fibre compression   σ11 < 0        (σ11/Xc)²
/// matrix tension      σ22 + σ33 ≥ 0  ((σ22 + σ33)/Yt)² + (σ23² − σ22 σ33)/S23² + (σ12² + σ31²)/S12²
/// matrix compression  σ22 + σ33 < 0  [((σ22 − σ33)/2)² + σ23²]/S23² + (σ12² + σ31²)/S12²
/// ```
///
/// The report calls the last mode shear failure. It has no linear term and no Yc, so that a uniaxial compression across
/// the fibres fails at 2 S23; Hashin's own form (`hashin-1980`) is the same only for a material with Yc = 2 S23. The
/// report prints a plus before σ22 σ33, which is neither Hashin's nor invariant about the fibre: [`Product`] chooses.
#[derive(Debug, Clone, Copy, Default)]
pub struct HashinReport {
    /// Sign of σ22 σ33 in the tensile matrix mode.
    pub product: Product,
}

/// One over strengths, of shears over their squares: many bounds are made of them.
struct Inverses {
    xt: f64,
    xc: f64,
    yt: f64,
    s12: f64,
    s23: f64,
}

impl Inverses {
    fn of(m: &Material) -> Self {
        let r = &m.strengths;
        let [xt, xc, yt] = [r.xt(), r.xc(), r.yt()].map(f64::recip);
        let [s12, s23] = [r.s12(), r.s23()].map(|strength| (strength * strength).recip());
        Self { xt, xc, yt, s12, s23 }
    }
}

impl HashinReport {
    const fn describe(invariant_about_fibre: bool) -> CriterionInfo {
        CriterionInfo {
            site: Site::Ply,
            modes: &["fibre tension", "fibre compression", "matrix tension", "matrix compression"],
            strengths: &[Strength::Xt, Strength::Xc, Strength::Yt, Strength::S12, Strength::S23],
            invariant_about_fibre,
        }
    }

    #[inline]
    fn bound(&self, s: &StressRange, inverses: &Inverses, out: &mut [f64]) {
        let product = match self.product {
            Product::Minus => s.s22() * s.s33() * -1.0,
            Product::Plus => s.s22() * s.s33(),
        };
        let along = (s.s12().squared() + s.s31().squared()).high * inverses.s12;
        let across = s.s23().squared();
        let (sum, half) = (s.s22() + s.s33(), (s.s22() - s.s33()) * 0.5);
        out.copy_from_slice(&[
            when(s.s11().reaches_positive(), (s.s11().positive().high * inverses.xt).powi(2) + along),
            when(s.s11().reaches_negative(), (s.s11().low * inverses.xc).powi(2)),
            when(
                sum.reaches_positive(),
                (sum.positive().high * inverses.yt).powi(2) + (across + product).high * inverses.s23 + along,
            ),
            when(sum.reaches_negative(), (half.squared() + across).high * inverses.s23 + along),
        ]);
    }

    #[inline]
    fn terms(&self, s: &Stress6<Ply>, m: &Material) -> [Terms; 4] {
        let r = &m.strengths;
        let product = match self.product {
            Product::Minus => -s.s22() * s.s33(),
            Product::Plus => s.s22() * s.s33(),
        };
        let along = (s.s12() * s.s12() + s.s31() * s.s31()) / (r.s12() * r.s12());
        let (across, s23) = (s.s23() * s.s23(), r.s23() * r.s23());
        let (sum, half) = (s.s22() + s.s33(), 0.5 * (s.s22() - s.s33()));
        let (fibre, opening) = (s.s11() >= 0.0, sum >= 0.0);
        [
            Terms::quadratic((s.s11() / r.xt()).powi(2) + along).when(fibre),
            Terms::quadratic((s.s11() / r.xc()).powi(2)).when(!fibre),
            Terms::quadratic((sum / r.yt()).powi(2) + (across + product) / s23 + along).when(opening),
            Terms::quadratic((half * half + across) / s23 + along).when(!opening),
        ]
    }
}

impl FailureCriterion for HashinReport {
    fn info(&self) -> &CriterionInfo {
        const MINUS: CriterionInfo = HashinReport::describe(true);
        const PLUS: CriterionInfo = HashinReport::describe(false);
        match self.product {
            Product::Minus => &MINUS,
            Product::Plus => &PLUS,
        }
    }

    from_terms!();

    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        self.bound(s, &Inverses::of(m), out);
    }

    fn bounds_many(&self, s: &[StressRange], m: &Material, out: &mut [f64]) {
        let inverses = Inverses::of(m);
        for (s, out) in s.iter().zip(out.chunks_exact_mut(self.info().modes.len())) {
            self.bound(s, &inverses, out);
        }
    }

    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        match self.product {
            Product::Minus => check_transverse_tension(m),
            Product::Plus => Ok(()),
        }
    }
}

const PRODUCT: ParamInfo = ParamInfo::word(
    "product",
    "sign of s22 s33 in the tensile matrix mode",
    &[("minus", "Hashin's"), ("plus", "as the report prints it")],
);

impl Plugin for HashinReport {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Criterion,
        name: "hashin-report",
        summary: "fibre and matrix, tension and compression, without the transverse compressive strength",
        source: "AFWAL-TR-87-4117, eqs. (38)-(41); after Hashin, J. Appl. Mech. 47 (1980) 329",
        params: &[PRODUCT],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        let product = match params.word(&PRODUCT)? {
            "plus" => Product::Plus,
            _ => Product::Minus,
        };
        Ok(Built::Criterion(Box::new(Self { product })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fem_core::material::{Elastic, Strengths, Toughnesses};
    use fem_core::plugin::Value;

    fn as4_3502() -> Material {
        let strengths = [
            (Strength::Xt, 1793e6),
            (Strength::Xc, 1724e6),
            (Strength::Yt, 64e6),
            (Strength::S12, 109e6),
            (Strength::S23, 69e6),
        ];
        Material {
            name: "AS4/3502".into(),
            elastic: Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9),
            density: None,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
            strengths: strengths.iter().fold(Strengths::default(), |s, (which, v)| s.with(*which, *v)),
        }
    }

    fn indices(product: Product, s: [f64; 6]) -> [f64; 4] {
        let mut out = [f64::NAN; 4];
        HashinReport { product }.indices(&Stress6::new(s.map(|c| c * 1e6)), &as4_3502(), &mut out);
        out
    }

    fn near(got: [f64; 4], want: [f64; 4]) {
        assert!(got.iter().zip(want).all(|(g, w)| (g - w).abs() < 1e-14), "{got:?} is not {want:?}");
    }

    #[test]
    fn hand_values() {
        near(indices(Product::Minus, [1793.0, 0.0, 0.0, 0.0, 0.0, 0.0]), [1.0, 0.0, 0.0, 0.0]);
        near(indices(Product::Minus, [-1724.0, 0.0, 0.0, 0.0, 0.0, 0.0]), [0.0, 1.0, 0.0, 0.0]);
        near(indices(Product::Minus, [0.0, 64.0, 0.0, 0.0, 0.0, 0.0]), [0.0, 0.0, 1.0, 0.0]);
        near(indices(Product::Minus, [0.0, -138.0, 0.0, 0.0, 0.0, 0.0]), [0.0, 0.0, 0.0, 1.0]);
        near(indices(Product::Minus, [0.0, 0.0, 0.0, 0.0, 69.0, 0.0]), [0.0, 0.0, 1.0, 0.0]);
        // Shear along the fibre enters both tensile modes; 109² = 65.4² + 87.2².
        near(indices(Product::Minus, [0.0, 0.0, 0.0, 65.4, 0.0, 87.2]), [1.0, 0.0, 1.0, 0.0]);
    }

    #[test]
    fn the_sign_of_the_product_is_a_choice() {
        let s = [0.0, 32.0, 16.0, 0.0, 0.0, 0.0];
        let (square, product) = ((48.0_f64 / 64.0).powi(2), 512.0 / (69.0 * 69.0));
        near(indices(Product::Minus, s), [0.0, 0.0, square - product, 0.0]);
        near(indices(Product::Plus, s), [0.0, 0.0, square + product, 0.0]);
        let built = |value: &str| HashinReport::build(&Params::default().with("product", Value::Text(value.into())));
        assert!(matches!(built("plus"), Ok(Built::Criterion(c)) if !c.info().invariant_about_fibre));
        let why = built("sideways").unwrap_err().why;
        assert!(why.contains("`minus`") && why.contains("or `plus`"), "{why}");
    }

    #[test]
    fn zero_of_either_sign_is_tension() {
        for zero in [0.0, -0.0] {
            let out = indices(Product::Minus, [zero, zero, zero, 109.0, 0.0, 0.0]);
            near(out, [1.0, 0.0, 1.0, 0.0]);
        }
        near(indices(Product::Minus, [-1e-300, -1e-300, 0.0, 109.0, 0.0, 0.0]), [0.0, 0.0, 0.0, 1.0]);
    }
}
