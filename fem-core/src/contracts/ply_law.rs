//! The contract of a law of a ply: from strains to stresses, with a memory.

use crate::contracts::failure::UnmetCondition;
use crate::words::energy::Energy;
use crate::words::material::{Material, MaterialError, Strength, Toughness};
use crate::words::tensor::{Matrix6, Ply, Strain6, Stress6};
use dyn_clone::DynClone;
use std::fmt::{self, Debug};
use std::ops::Range;

/// What a law of a ply or an interface says of itself.
#[derive(Debug, Clone, Copy)]
pub struct LawInfo {
    /// Names of its state variables, in their order; all are 0 before anything has happened.
    pub state: &'static [&'static str],
    /// Strengths that it requires of the material.
    pub strengths: &'static [Strength],
    /// Toughnesses that it requires of the material.
    pub toughness: &'static [Toughness],
}

/// What a law may know of the point that it is asked about.
#[derive(Debug, Clone, Copy)]
pub struct LawPoint<'a> {
    /// The material, which has passed [`check_law`].
    pub material: &'a Material,
    /// Its stiffness in its own axes, Pa: [`Elastic::stiffness`](crate::words::material::Elastic::stiffness).
    pub stiffness: &'a Matrix6,
    /// Length over which a crack through the point is smeared, m: the width of its cell. An energy per area over this length
    /// is what the crack takes per volume.
    pub length: f64,
    /// Thickness of the ply and of those about it that are alike, m: cracks through it stand about as far apart. Of an interface 0.
    pub thickness: f64,
    /// Means of [`PlyLaw::quantities`] over the ply in its cell, as many as [`PlyLaw::means`] says, and behind them those of
    /// [`PlyLaw::faces`]; none at a point that is asked about alone.
    pub means: &'a [f64],
}

/// Stress of a ply and where its work has gone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlyResponse {
    /// Stress, Pa.
    pub stress: Stress6<Ply>,
    /// Work done per volume since the beginning, J/m³.
    pub energy: Energy,
}

/// A point at which a law finds no answer; whoever asked may try a smaller step.
#[derive(Debug, Clone, PartialEq)]
pub struct LawError(pub String);

impl fmt::Display for LawError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
impl std::error::Error for LawError {}

/// A law of a ply, σ(ε) with a memory, in the axes of the ply.
///
/// The answer is a pure function of the point, the strain and the state that the last accepted step has left, so that any
/// number of strains may be tried within a step. The state is plain numbers, as many as [`LawInfo::state`] names; whoever
/// marches keeps it, beside the histories of contacts. A state that was taken over at a strain gives the same answer there again.
///
/// In a virgin point (all states 0) the law is linear elasticity for vanishing strains: no stress without strain, and the
/// stiffness of the material as tangent.
///
/// ```
/// use fem_core::energy::Energy;
/// use fem_core::ply_law::{LawError, LawInfo, LawPoint, PlyLaw, PlyResponse};
/// use fem_core::tensor::{Matrix6, Ply, Strain6, stress};
///
/// #[derive(Debug, Clone)]
/// struct LinearElastic;
///
/// impl PlyLaw for LinearElastic {
///     fn info(&self) -> &LawInfo {
///         const INFO: LawInfo = LawInfo { state: &[], strengths: &[], toughness: &[] };
///         &INFO
///     }
///     fn respond(
///         &self,
///         point: &LawPoint<'_>,
///         strain: &Strain6<Ply>,
///         _old: &[f64],
///         _new: &mut [f64],
///         tangent: Option<&mut Matrix6>,
///     ) -> Result<PlyResponse, LawError> {
///         if let Some(tangent) = tangent {
///             *tangent = *point.stiffness;
///         }
///         let stress = stress(point.stiffness, strain);
///         let stored = 0.5 * stress.0.iter().zip(strain.0).map(|(s, e)| s * e).sum::<f64>();
///         Ok(PlyResponse { stress, energy: Energy { stored, dissipated: 0.0 } })
///     }
/// }
/// ```
pub trait PlyLaw: DynClone + Debug + Send + Sync {
    /// State variables and required strengths.
    fn info(&self) -> &LawInfo;

    /// Which of its state variables are damages: shares of a stiffness that are lost, from 0 to 1. Fields show their means, under the
    /// names that [`LawInfo::state`] has for them.
    fn damages(&self) -> Range<usize> {
        0..0
    }

    /// Which of its state variables are what its modes have dissipated, J/m³; together all that it dissipates. Summaries tell
    /// them apart, under the names that [`LawInfo::state`] has for them.
    fn sinks(&self) -> Range<usize> {
        0..0
    }

    /// How many quantities it wants the means of over its ply in each cell: what opens in one cell as a whole, as a crack across the
    /// fibres does, must not follow the strains of each point, which cannot do so.
    fn means(&self) -> usize {
        0
    }

    /// Whether the means are those over all plies of one angle about its own, which break as one, and it wants the means over their two faces
    /// as well, of each quantity the larger one: in plies that bend the faces see more than the mean.
    fn faces(&self) -> bool {
        false
    }

    /// Writes the quantities of [`PlyLaw::means`] at a point to `out`; their means come back to it in [`LawPoint::means`].
    fn quantities(&self, _point: &LawPoint<'_>, _strain: &Strain6<Ply>, _old: &[f64], _out: &mut [f64]) {}

    /// Refuses a point whose constants the law cannot use, such as a cell too wide for the energy of a crack. That the
    /// required strengths are there is [`check_law`]'s business.
    ///
    /// # Errors
    /// The condition that the point does not meet, with its numbers.
    fn check(&self, _point: &LawPoint<'_>) -> Result<(), UnmetCondition> {
        Ok(())
    }

    /// What the user should know of a point that the law takes, such as strengths that it lowers in so wide a cell.
    fn warning(&self, _point: &LawPoint<'_>) -> Option<String> {
        None
    }

    /// The answer to `strain` (engineering shears) of a ply with the state `old`; all of the state that the strain leaves goes
    /// into `new`.
    ///
    /// The tangent, where it is asked for, is ∂σ/∂ε of this very answer, `old` and [`LawPoint::means`] held, Pa, `tangent[row][column]`; it need not be symmetric.
    ///
    /// # Errors
    /// A strain for which the law finds no stress.
    fn respond(
        &self,
        point: &LawPoint<'_>,
        strain: &Strain6<Ply>,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut Matrix6>,
    ) -> Result<PlyResponse, LawError>;

    /// The answers to several `strains` of one ply in one cell, as [`PlyLaw::respond`] has them: `old` and `new` hold the states of one point after
    /// the other, `tangents` are asked for where there are any. For laws that find something but once for all of them.
    ///
    /// # Errors
    /// A strain for which the law finds no stress.
    fn respond_all(
        &self,
        point: &LawPoint<'_>,
        strains: &[Strain6<Ply>],
        (old, new): (&[f64], &mut [f64]),
        answers: &mut [PlyResponse],
        tangents: &mut [Matrix6],
    ) -> Result<(), LawError> {
        let count = self.info().state.len();
        let mut tangents = tangents.iter_mut();
        for (i, (strain, answer)) in strains.iter().zip(answers).enumerate() {
            let own = i * count..(i + 1) * count;
            *answer = self.respond(point, strain, &old[own.clone()], &mut new[own], tangents.next())?;
        }
        Ok(())
    }
}
dyn_clone::clone_trait_object!(PlyLaw);

/// Whether the law called `name`, which says `info` of itself, can stand at `point`; `check` is its own opinion.
///
/// # Errors
/// Constants that no solid has, a required strength or toughness that is missing, a point that the law refuses.
pub fn check_law(
    info: &LawInfo,
    name: &str,
    point: &LawPoint<'_>,
    check: Result<(), UnmetCondition>,
) -> Result<(), MaterialError> {
    let material = point.material;
    material.check()?;
    let user = format!("law `{name}`");
    material.require(info.strengths, &user)?;
    material.require_toughness(info.toughness, &user)?;
    check.map_err(|why| MaterialError {
        material: material.name.clone(),
        why: format!("{user} cannot follow it: {why}"),
    })
}
