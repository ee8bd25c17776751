//! The contract of a failure criterion.

use crate::material::{Material, Strength};
use crate::tensor::{Ply, Stress6};
use dyn_clone::DynClone;
use std::fmt::Debug;

/// Where a criterion looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// Mean stress of a ply.
    Ply,
    /// Stress of the resin between two plies.
    Interface,
}

/// What a criterion says of itself.
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

    /// One index per mode into `out`: the published left-hand side, 1 at failure, 0 where the mode does not apply.
    ///
    /// `s` is finite and `m` has every strength of [`CriterionInfo::strengths`]: callers see to both.
    fn indices(&self, s: &Stress6<Ply>, m: &Material, out: &mut [f64]);

    /// [`FailureCriterion::indices`] of many states, `modes` numbers each.
    fn indices_many(&self, s: &[Stress6<Ply>], m: &Material, out: &mut [f64]) {
        for (s, out) in s.iter().zip(out.chunks_exact_mut(self.info().modes.len())) {
            self.indices(s, m, out);
        }
    }
}
dyn_clone::clone_trait_object!(FailureCriterion);
