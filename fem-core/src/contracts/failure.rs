//! The contract of a failure criterion.

use crate::words::interval::Interval;
use crate::words::material::{Material, MaterialError, Strength};
use crate::words::tensor::{Ply, Stress6};
use dyn_clone::DynClone;
use std::fmt::{self, Debug};

/// Where a criterion looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// Mean stress of a ply.
    Ply,
    /// Stress of the resin between two plies.
    Interface,
}

/// How a criterion describes itself.
#[derive(Debug, Clone, Copy)]
pub struct CriterionInfo {
    /// Where it looks.
    pub site: Site,
    /// Names of its failure modes, in the order of the indices.
    pub modes: &'static [&'static str],
    /// Strengths that it requires.
    pub strengths: &'static [Strength],
    /// True when a rotation of the stress about the fibre leaves it unchanged.
    pub invariant_about_fibre: bool,
}

/// The factor by which a stress may grow before a criterion meets failure; 1/factor is the exposure.
///
/// Unlike an index it means the same for every criterion, whatever the degree of its formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reserve {
    /// Smallest R > 0 at which some index of R σ reaches 1; +∞ without such R, NaN for a refused stress.
    pub factor: f64,
    /// The mode that governs: the one that reaches 1 there.
    pub mode: Option<usize>,
}

impl Reserve {
    /// No load factor brings failure.
    pub const UNBOUNDED: Self = Self { factor: f64::INFINITY, mode: None };
}

/// All stresses between two, component by component.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub struct StressRange {
    pub low: Stress6<Ply>,
    pub high: Stress6<Ply>,
}

macro_rules! components {
    ($($name:ident)*) => {
        impl StressRange {$(
            #[inline]
            #[allow(missing_docs)]
            pub fn $name(&self) -> Interval {
                Interval { low: self.low.$name(), high: self.high.$name() }
            }
        )*}
    };
}
components!(s11 s22 s33 s12 s23 s31);

/// A failure criterion: a pure function of the stress in a ply's (or the resin's) own axes.
///
/// ```
/// use fem_core::failure::{CriterionInfo, FailureCriterion, Site};
/// use fem_core::material::{Material, Strength};
/// use fem_core::tensor::{Ply, Stress6};
///
/// #[derive(Debug, Clone)]
/// struct FibreStress;
///
/// impl FailureCriterion for FibreStress {
///     fn info(&self) -> &CriterionInfo {
///         const INFO: CriterionInfo = CriterionInfo {
///             site: Site::Ply,
///             modes: &["fibre tension"],
///             strengths: &[Strength::Xt],
///             invariant_about_fibre: true,
///         };
///         &INFO
///     }
///     fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
///         out[0] = s.s11() / m.strengths.xt();
///     }
/// }
/// ```
pub trait FailureCriterion: DynClone + Debug + Send + Sync {
    /// Modes, site and required constants.
    fn info(&self) -> &CriterionInfo;

    /// One index per mode into `out`: the published left-hand side, 1 at failure, 0 where the mode does not apply, NaN
    /// for a stress outside the criterion's theory ([`FailureCriterion::scope`]).
    ///
    /// `s` is finite and `m` passes [`check_material`]: callers see to both, or call [`assess`].
    fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]);

    /// [`FailureCriterion::indices`] of many states, `modes` numbers each.
    fn indices_many(&self, s: &[Stress6<Ply>], m: &Material, out: &mut [f64]) {
        for (s, out) in s.iter().zip(out.chunks_exact_mut(self.info().modes.len())) {
            self.indices(s, m, out);
        }
    }

    /// What no index of a stress in `s` exceeds but by rounding (a part in 10⁹ is left for that), one per mode into `out`: a
    /// scan passes over what cannot fail. Infinite, as provided, where the criterion cannot say; a finite number says as
    /// well that it refuses no stress in `s`. [`Interval`] makes such bounds of the formulas of the indices.
    fn bounds(&self, s: &StressRange, m: &Material, out: &mut [f64]) {
        let _ = (s, m);
        out.fill(f64::INFINITY);
    }

    /// [`FailureCriterion::bounds`] of many ranges, `modes` numbers each.
    fn bounds_many(&self, s: &[StressRange], m: &Material, out: &mut [f64]) {
        for (s, out) in s.iter().zip(out.chunks_exact_mut(self.info().modes.len())) {
            self.bounds(s, m, out);
        }
    }

    /// The smallest factor that brings `s` to failure, and the mode.
    ///
    /// Provided as [`search_reserve`]; a criterion with a closed form overrides it.
    fn reserve_factor(&self, s: &Stress6<Ply>, m: &Material) -> Reserve {
        search_reserve(|s, out| self.indices(s, m, out), self.info().modes.len(), s, m)
    }

    /// Refuses a material whose constants the criterion cannot use, such as strengths that leave a failure surface
    /// open. That the required strengths are there is [`check_material`]'s business.
    ///
    /// # Errors
    /// The condition that the constants do not meet, with its numbers.
    fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
        let _ = m;
        Ok(())
    }

    /// Which finite stresses the criterion refuses by the index NaN, and what to do about it.
    fn scope(&self) -> &'static str {
        "every finite stress"
    }
}
dyn_clone::clone_trait_object!(FailureCriterion);

/// Whether `criterion`, called `name`, can judge a ply or an interface of material `m`.
///
/// # Errors
/// Constants that no solid has, a required strength that is missing, a material that [`FailureCriterion::check`] refuses.
pub fn check_material(criterion: &dyn FailureCriterion, name: &str, m: &Material) -> Result<(), MaterialError> {
    m.check()?;
    let user = format!("criterion `{name}`");
    m.require(criterion.info().strengths, &user)?;
    criterion
        .check(m)
        .map_err(|why| MaterialError { material: m.name.clone(), why: format!("{user} cannot judge it: {why}") })
}

/// A condition that a criterion or a law sets on constants and that they do not meet.
#[derive(Debug, Clone, PartialEq)]
pub struct UnmetCondition {
    /// What is required, `S23 > Yt/2`.
    pub condition: &'static str,
    /// What is wrong without it.
    pub reason: &'static str,
    /// The numbers in it: name, value, unit.
    pub values: Vec<(String, f64, &'static str)>,
}

impl fmt::Display for UnmetCondition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is required: {}", self.condition, self.reason)?;
        for (k, (name, value, unit)) in self.values.iter().enumerate() {
            let (before, blank) = (if k == 0 { "; " } else { ", " }, if unit.is_empty() { "" } else { " " });
            write!(f, "{before}{name} = {value:.6e}{blank}{unit}")?;
        }
        Ok(())
    }
}
impl std::error::Error for UnmetCondition {}

/// What a criterion says of one stress.
#[derive(Debug, Clone, PartialEq)]
pub struct Assessment {
    /// One index per mode.
    pub indices: Vec<f64>,
    /// How far failure is, and by which mode.
    pub reserve: Reserve,
}

/// Why a stress is not assessed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum AssessError {
    /// The stress is infinite or not a number.
    NotFinite(Stress6<Ply>),
    /// The material does not suit the criterion.
    Material(MaterialError),
    /// The stress is outside the criterion's theory.
    Scope(Stress6<Ply>, &'static str),
}

impl fmt::Display for AssessError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AssessError::NotFinite(s) => write!(f, "the stress is not finite: {s:?}"),
            AssessError::Material(e) => write!(f, "{e}"),
            AssessError::Scope(s, scope) => write!(f, "{s:?} cannot be judged; the criterion takes {scope}"),
        }
    }
}
impl std::error::Error for AssessError {}

/// Indices and reserve factor of one stress, with every check that the methods of the trait leave to their caller.
///
/// # Errors
/// Anything for which the criterion has no trustworthy answer.
pub fn assess(
    criterion: &dyn FailureCriterion,
    name: &str,
    s: &Stress6<Ply>,
    m: &Material,
) -> Result<Assessment, AssessError> {
    check_material(criterion, name, m).map_err(AssessError::Material)?;
    if !s.is_finite() {
        return Err(AssessError::NotFinite(*s));
    }
    let mut indices = vec![f64::NAN; criterion.info().modes.len()];
    criterion.indices(s, m, &mut indices);
    let reserve = criterion.reserve_factor(s, m);
    if reserve.factor.is_nan() {
        return Err(AssessError::Scope(*s, criterion.scope()));
    }
    Ok(Assessment { indices, reserve })
}

/// `(s', k)` with s = k s' and k a power of two: 1 while the largest component lies between 2⁻²⁰⁰ and 2²⁰⁰, otherwise
/// such that powers of the components of s' neither overflow nor underflow.
///
/// The division is exact, so that a branch chosen by the sign of a component or of a sum is the one of the stress as
/// given; a component too small to survive it keeps its sign.
pub fn moderate(s: &Stress6<Ply>) -> (Stress6<Ply>, f64) {
    const LIMIT: f64 = f64::from_bits((1023 + 200) << 52);
    let largest = s.0.iter().fold(0.0_f64, |k, c| k.max(c.abs()));
    if largest == 0.0 || (1.0 / LIMIT..=LIMIT).contains(&largest) {
        return (*s, 1.0);
    }
    let k = largest.log2().floor().clamp(-1074.0, 1023.0).exp2();
    let divided = s.0.map(|c| match c / k {
        0.0 if c != 0.0 => f64::MIN_POSITIVE.copysign(c),
        quotient => quotient,
    });
    (Stress6::new(divided), k)
}

/// The reserve factor of any `indices` (a function of the stress that fills `modes` numbers), by search.
///
/// Follows the ray R σ from 10⁻² of the smallest to 10³ of the largest strength of `m` (10⁻⁸ to 10³ of E1 without any) and
/// bisects to the last bit where an index first is 1 or more. Right for indices that jump or fall again; its steps are
/// of 1 % near index 1 and of 10 % far below, so that a shorter excursion above 1 can be missed.
pub fn search_reserve(
    indices: impl Fn(&Stress6<Ply>, &mut [f64]),
    modes: usize,
    s: &Stress6<Ply>,
    m: &Material,
) -> Reserve {
    let (unit, k) = moderate(s);
    let largest = unit.0.iter().fold(0.0_f64, |k, c| k.max(c.abs()));
    if largest == 0.0 {
        return Reserve::UNBOUNDED;
    }
    let given = || Strength::ALL.iter().filter_map(|which| m.strengths.get(*which));
    let weakest = given().min_by(f64::total_cmp).unwrap_or(1e-6 * m.elastic.e1);
    let strongest = given().max_by(f64::total_cmp).unwrap_or(m.elastic.e1);

    let mut out = vec![f64::NAN; modes];
    // The largest index at R and its mode; one that is not a number comes before all.
    let mut worst = |r: f64| {
        indices(&unit.scaled(r), &mut out);
        let rank = |v: f64| if v.is_nan() { f64::INFINITY } else { v };
        let first = (0.0, 0);
        out.iter().enumerate().fold(first, |a, (k, &v)| if rank(v) > rank(a.0) || v.is_nan() { (v, k) } else { a })
    };
    let (mut safe, mut failed) = (0.0, 1e-2 * weakest / largest);
    let mut found = worst(failed);
    while found.0 < 1.0 {
        if failed > 1e3 * strongest / largest {
            // Far beyond all strengths; the stress itself may lie farther still, and must not pass then.
            let own = worst(k);
            if !(k > failed && own.0 >= 1.0) {
                return Reserve::UNBOUNDED;
            }
            (safe, failed, found) = (failed, k, own);
            break;
        }
        safe = failed;
        // As if no index grew faster than R⁴.
        failed *= found.0.powf(-0.25).clamp(1.01, 1.1);
        found = worst(failed);
    }
    loop {
        if found.0.is_nan() {
            return Reserve { factor: f64::NAN, mode: None };
        }
        let middle = safe + 0.5 * (failed - safe);
        if middle <= safe || middle >= failed {
            break;
        }
        match worst(middle) {
            (index, _) if index < 1.0 => safe = middle,
            (index, mode) => (failed, found) = (middle, (index, mode)),
        }
    }
    let factor = failed / k;
    Reserve { factor, mode: factor.is_finite().then_some(found.1) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::material::{Elastic, Strengths, Toughnesses};

    fn material() -> Material {
        Material {
            name: "m".into(),
            elastic: Elastic::isotropic(1e9, 0.3),
            density: None,
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
            strengths: Strengths::default().with(Strength::Xt, 100.0).with(Strength::Yt, 10.0),
        }
    }

    /// Quadratic along the fibre, jumps to 5 at a tenth of Yt across it, refuses shear.
    #[derive(Debug, Clone)]
    struct Odd;
    impl FailureCriterion for Odd {
        fn info(&self) -> &CriterionInfo {
            const INFO: CriterionInfo = CriterionInfo {
                site: Site::Ply,
                modes: &["smooth", "jump"],
                strengths: &[Strength::Xt, Strength::Yt],
                invariant_about_fibre: false,
            };
            &INFO
        }
        fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]) {
            let refused = if s.s12() == 0.0 { 0.0 } else { -f64::NAN };
            out[0] = refused + (s.s11() / m.strengths.xt()).powi(2);
            out[1] = if s.s22() >= 0.1 * m.strengths.yt() { 5.0 } else { 0.0 };
        }
        fn check(&self, m: &Material) -> Result<(), UnmetCondition> {
            let yt = m.strengths.yt();
            let unmet = UnmetCondition { condition: "Yt >= 1", reason: "odd", values: vec![("Yt".into(), yt, "Pa")] };
            if yt < 1.0 { Err(unmet) } else { Ok(()) }
        }
        fn scope(&self) -> &'static str {
            "stresses without shear"
        }
    }

    #[test]
    fn the_search_finds_roots_and_jumps() {
        let reserve = |s| Odd.reserve_factor(&Stress6::new(s), &material());
        let smooth = reserve([-25.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!((smooth.factor - 4.0).abs() < 4e-15 && smooth.mode == Some(0), "{smooth:?}");
        let jump = reserve([1.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(jump, Reserve { factor: 0.25, mode: Some(1) });
        assert_eq!(reserve([0.0; 6]), Reserve::UNBOUNDED);
        assert_eq!(reserve([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]), Reserve::UNBOUNDED);
        assert!(reserve([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]).factor.is_nan());
        let bare = Material { strengths: Strengths::default(), ..material() };
        let steep = search_reserve(|s, out| out[0] = (s.s11() / 3e7).powi(5), 1, &Stress6::new([1e3; 6]), &bare);
        assert!((steep.factor - 3e4).abs() < 1e-10, "{steep:?}");
        for scale in [1e-300, 1e300] {
            let r = reserve([scale, 0.0, 0.0, 0.0, 0.0, 0.0]);
            assert!((r.factor * scale / 100.0 - 1.0).abs() < 1e-14, "{r:?}");
        }
    }

    #[test]
    fn moderation_is_exact_and_keeps_signs() {
        for s in [[3e200, -7e199, 0.0, -0.0, 1e180, 5.0], [-5e-324, 1e-310, 0.0, 0.0, 5e-324, 0.0]] {
            let (unit, k) = moderate(&Stress6::new(s));
            assert!(unit.0.iter().all(|c| c.abs() < 2.0) && unit.0.iter().any(|c| c.abs() >= 0.5), "{unit:?} {k}");
            assert_eq!(unit.0.map(|c| c * k), s);
        }
        let (unit, _) = moderate(&Stress6::new([1e300, -5e-324, -0.0, 0.0, 0.0, 0.0]));
        assert!(unit.s22() < 0.0 && unit.s33() == 0.0);
        let (unit, k) = moderate(&Stress6::new([f64::MAX; 6]));
        assert!(unit.s11() * k == f64::MAX);
    }

    #[test]
    fn assessment_refuses_what_cannot_be_judged() {
        let assess = |s, m: &Material| assess(&Odd, "odd", &Stress6::new(s), m);
        let good = assess([50.0, 0.0, 0.0, 0.0, 0.0, 0.0], &material()).unwrap();
        assert_eq!(good.indices, [0.25, 0.0]);
        assert_eq!(good.reserve.mode, Some(0));
        let nan = assess([f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0], &material()).unwrap_err();
        assert!(matches!(nan, AssessError::NotFinite(_)));
        let shear = assess([0.0, 0.0, 0.0, 1.0, 0.0, 0.0], &material()).unwrap_err();
        assert!(shear.to_string().contains("stresses without shear"));
        let mut weak = material();
        weak.strengths = weak.strengths.with(Strength::Yt, 0.5);
        let error = assess([0.0; 6], &weak).unwrap_err().to_string();
        assert!(error.contains("`odd`") && error.contains("Yt >= 1 is required: odd; Yt = 5.000000e-1 Pa"), "{error}");
        weak.strengths = Strengths::default();
        assert!(assess([0.0; 6], &weak).unwrap_err().to_string().contains("Xt, Yt"));
    }
}
