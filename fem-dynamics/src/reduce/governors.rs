//! The choice of governors.

use super::StaticShapes;
use fem_core::functional::Functional;
use fem_core::plugin::{ParamError, ParamInfo, Params, Role};
use fem_core::reduction::ReductionError;
use fem_core::structure::Structure;
use nalgebra::DMatrix;

/// Candidates per governor among which the elimination chooses.
const POOL: usize = 4;

/// Ratios that differ by less than this fraction are equal, whatever the last bits say.
const EQUAL: f64 = 1e-9;

const COUNT: ParamInfo =
    ParamInfo::count("governors", "deflections kept beside the contacts").default(38.0).role(Role::Size);
const SELECT: ParamInfo = ParamInfo::word(
    "select",
    "which deflections are kept",
    &[("spread", "evenly over the plate"), ("ratio", "those left when the largest k/m are eliminated")],
)
.role(Role::Way);

/// How many governors are kept beside the contacts, and which.
#[derive(Debug, Clone)]
pub(super) struct Governors {
    count: usize,
    ratio: bool,
}

impl Governors {
    pub(super) const PARAMS: [ParamInfo; 2] = [COUNT, SELECT];

    pub(super) fn of(params: &Params) -> Result<Self, ParamError> {
        Ok(Self { count: params.count(&COUNT)?, ratio: params.word(&SELECT)? == "ratio" })
    }

    /// Condenses the structure on the contacts and the governors.
    ///
    /// `spread` takes the first candidates. `ratio` condenses on the first 4 candidates per governor and then eliminates
    /// one after the other the unknown with the largest kᵢᵢ/mᵢᵢ of the matrices condensed so far (Henshell, Ong 1975;
    /// Shah, Raymond 1982): what is left is held least stiffly and carries most. Unknowns without mass are not
    /// candidates, which is to eliminate them first. The published procedure starts from all unknowns; since
    /// elimination in stages gives the same matrices, this is the same procedure after a first stage, which costs a
    /// solve and a product with M per candidate instead of per unknown.
    ///
    /// # Errors
    /// Fewer candidates than governors, or candidates that depend on each other.
    pub(super) fn condense(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        candidates: &[usize],
    ) -> Result<StaticShapes, ReductionError> {
        let kept = |dof: &usize| keep.iter().any(|w| matches!(w.0[..], [(d, _)] if d == *dof));
        let mut free: Vec<usize> = candidates.iter().copied().filter(|d| !kept(d)).collect();
        if self.ratio {
            let inertia = inertia(structure);
            free.retain(|d| inertia[*d] != 0.0);
        }
        if free.len() < self.count {
            let (asked, offered, with_inertia) = (self.count, free.len(), self.ratio);
            return Err(ReductionError::FewGovernors { asked, offered, with_inertia });
        }
        free.truncate(if self.ratio { POOL * self.count } else { self.count });
        let functionals = keep.iter().cloned().chain(free.into_iter().map(Functional::dof)).collect();
        if !self.ratio {
            return StaticShapes::new(structure, functionals);
        }
        // Candidates that follow from others need no elimination.
        let shapes = StaticShapes::of_independent(structure, functionals, keep.len() + self.count)?;
        let (k, m) = shapes.condensed(structure);
        let left = shapes.only(&eliminate(k, m, keep.len(), self.count));
        left.map_err(|dependent| dependent.named(structure))
    }
}

/// M applied to a vector in which no two entries cancel: zero exactly where a row of M is.
fn inertia(structure: &dyn Structure) -> Vec<f64> {
    let x: Vec<f64> = (0..structure.ndof()).map(|i| 1.0 + (i * 7919 % 1009) as f64 / 1009.0).collect();
    let mut y = vec![0.0; x.len()];
    structure.add_mass(1.0, &x, &mut y);
    y
}

/// Eliminates unknowns but the first `held` until `count` others are left; of equal ratios the last one goes.
fn eliminate(mut k: DMatrix<f64>, mut m: DMatrix<f64>, held: usize, count: usize) -> Vec<usize> {
    let mut left: Vec<usize> = (0..k.nrows()).collect();
    while left.len() > held + count {
        let ratio = |i: usize| if m[(i, i)] > 0.0 { k[(i, i)] / m[(i, i)] } else { f64::INFINITY };
        let largest = left[held..].iter().fold(0.0_f64, |a, i| a.max(ratio(*i)));
        let last = left[held..].iter().rposition(|i| ratio(*i) >= largest * (1.0 - EQUAL));
        let out = left.remove(held + last.unwrap_or(0));
        // u_out = tᵀ u of the others.
        let (k_out, m_out) = (k.column(out).into_owned(), m.column(out).into_owned());
        let t = &k_out * (-1.0 / k_out[out]);
        k.ger(1.0, &k_out, &t, 1.0);
        m.ger(1.0, &m_out, &t, 1.0);
        m.ger(1.0, &t, &m_out, 1.0);
        m.ger(m_out[out], &t, &t, 1.0);
    }
    left
}
