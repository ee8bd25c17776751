//! What stresses in the plane do to a plate that is computed for small displacements.

use super::assembled::{self, Assembled};
use super::statics::dof_of;
use crate::error::Error;
use crate::model::{Model, Plan};
use fem_core::assembly::{Symmetric, add_geometric_stiffness};
use fem_core::structure::Structure;

/// Share of the stiffness from which on the user should know of what a linear plate leaves out.
const WORTH: f64 = 0.02;

/// Deflection over the largest displacement below which the plate is taken not to deflect.
const FLAT: f64 = 1e-6;

/// What stresses in the plane do, and a linear plate leaves out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stressed {
    /// Share of its stiffness against this deflection that they take, negative where they add to it; `None` where it does not deflect,
    /// and where they buckle it.
    pub takes: Option<f64>,
    /// Part of them that buckles the plate, where that is not more than all.
    pub buckles: Option<f64>,
}

/// [`Stressed`] of the displacements `u`.
///
/// With the geometric stiffness G of the stresses there and the deflections w alone, those with G are (1 + K⁻¹ G)⁻¹ w. Where w is
/// largest their series has the terms w, −K⁻¹ G w, .., relative to w the moments 1, m₁, m₂, m₃, of which the continued fraction is
/// 1 − w/w′ = α₁ + β²/(1 − α₂), α₁ = m₁, β² = m₂ − m₁², β² α₂ = m₃ − 2 m₁ m₂ + m₁³. α₂ is held between the shares of the loads that
/// buckle the plate to either side, beyond which there is no w′.
///
/// # Errors
/// A stiffness that cannot be factorised.
pub(super) fn stressed(model: &Model, assembled: &mut Assembled, u: &[f64]) -> Result<Option<Stressed>, Error> {
    let Model { plate, element, constraints, plan, effects, .. } = model;
    let along = |dof: usize| [1, 2].map(dof_of).contains(&plate.locate(dof).2);
    let pulled =
        matches!(plan, Plan::Static { forces, .. } if (0..).zip(forces).any(|(dof, f)| *f != 0.0 && along(dof)));
    let nature = effects.nature();
    let told = nature.large || assembled.condensation.is_some() || element.large_deflections().is_none();
    if told || !(pulled || nature.strained) {
        return Ok(None);
    }
    let mut all = vec![0.0; plate.ndof()];
    constraints.expand(u, &mut all);
    let structure = &mut assembled.structure;
    let mut geometric = Symmetric::zero(structure.matrices().0.pattern().clone());
    // Of a mesh with triangles, one form of the element may know no large deflections.
    if add_geometric_stiffness(plate, &**element, constraints, &all, &mut geometric).is_err() {
        return Ok(None);
    }
    let factors = assembled::factors(structure, &geometric, assembled::FACTORS).map(|found| found.factors);
    let factors: Vec<f64> = factors.unwrap_or_default().into_iter().filter(|factor| factor.is_finite()).collect();
    let buckles = factors.iter().copied().filter(|factor| *factor > 0.0).min_by(f64::total_cmp);
    let buckles = buckles.filter(|factor| *factor <= 1.0);
    let takes = match largest_deflection(model, &all).filter(|_| buckles.is_none()) {
        None => None,
        Some(at) => {
            let deflects = |i: usize| plate.locate(constraints.original(i)).2.n() == 3;
            let mut term: Vec<f64> = u.iter().enumerate().map(|(i, u)| if deflects(i) { *u } else { 0.0 }).collect();
            let (independent, _) = constraints.row(at);
            let there = |x: &[f64]| independent.iter().map(|(i, c)| c * x[*i]).sum::<f64>();
            let w = there(&term);
            let mut moments = [0.0; 3];
            for moment in &mut moments {
                let mut next = vec![0.0; term.len()];
                geometric.add_product(-1.0, &term, &mut next);
                structure.solve_shifted(0.0, &mut next, 1)?;
                term = next;
                *moment = there(&term) / w;
            }
            let shares = factors.iter().map(|factor| 1.0 / factor);
            let bounds = shares.fold([0.0, 0.0], |[low, high], share| [f64::min(low, share), f64::max(high, share)]);
            Some(share(moments, bounds))
        }
    };
    let takes = takes.filter(|share| share.abs() > WORTH);
    Ok((takes.is_some() || buckles.is_some()).then_some(Stressed { takes, buckles }))
}

/// The continued fraction of the moments, with α₂ between two shares, of which the larger is below one.
fn share([m1, m2, m3]: [f64; 3], [low, high]: [f64; 2]) -> f64 {
    let square = m2 - m1 * m1;
    // Nothing is left beside the first term.
    if square.abs() <= 1e-12 * m1 * m1 {
        return m1;
    }
    let second = ((m3 - 2.0 * m1 * m2 + m1.powi(3)) / square).clamp(low, high);
    m1 + square / (1.0 - second)
}

/// The unknown of the largest deflection: `None` where none is worth its name beside other displacements. Over the height a solid
/// may swell, which is no deflection.
fn largest_deflection(model: &Model, all: &[f64]) -> Option<usize> {
    let plate = &model.plate;
    let unknowns =
        |column: usize| (0..plate.levels.len()).flat_map(move |level| plate.dofs_at(column, level, dof_of(3)));
    let mean = |column: usize| {
        let (count, sum) = unknowns(column).fold((0_u32, 0.0), |(count, sum), dof| (count + 1, sum + all[dof]));
        (sum / f64::from(count.max(1))).abs()
    };
    let translates = |dof: usize| [1, 2, 3].map(dof_of).contains(&plate.locate(dof).2);
    let largest = (0..all.len()).filter(|dof| translates(*dof)).map(|dof| all[dof].abs()).fold(0.0, f64::max);
    let column = (0..plate.columns.len()).max_by(|a, b| mean(*a).total_cmp(&mean(*b)))?;
    let there = unknowns(column).max_by(|a, b| all[*a].abs().total_cmp(&all[*b].abs()))?;
    (mean(column) > FLAT * largest).then_some(there)
}

#[cfg(test)]
mod tests {
    use super::share;

    /// Deflections of two shapes in which the plate buckles, for which it is exact; they may well be of different signs.
    #[test]
    fn two_shapes_are_exact() {
        for [(weight, of_one), (other, of_other)] in
            [[(0.7, 0.3), (0.3, -0.2)], [(0.5, 0.6), (0.5, -0.6)], [(1.0, 0.4), (0.0, 0.1)], [(1.3, 0.5), (-0.3, -0.4)]]
        {
            let moment = |k: i32| weight * f64::powi(of_one, k) + other * f64::powi(of_other, k);
            let want = 1.0 - 1.0 / (weight / (1.0 - of_one) + other / (1.0 - of_other));
            let got = share([1, 2, 3].map(moment), [-1.0, 0.9]);
            assert!((got - want).abs() < 1e-12, "{got} {want}");
        }
    }
}
