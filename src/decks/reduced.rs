//! Parts put together by number, constrained, and condensed on what is kept: pieces on their masters, models on governors.

use fem_core::assembly::{FactorError, Inside, Symmetric, assemble_blocks, block_pattern};
use fem_core::constraint::Constraints;
use fem_io::deck::{DeckError, DeckSource, Fault, Freedom};
use std::num::NonZeroUsize;
use std::sync::Arc;

/// Least pivot of a stiffness whose diagonal is scaled to 1.
const SINGULAR: f64 = 1e-12;

/// Most masters or governors: their matrices are dense.
const MOST_KEPT: usize = 5000;

/// Degrees of freedom of a part with its matrices, both triangles, column-major.
#[derive(Debug)]
pub(super) struct Block<'a> {
    pub(super) dofs: &'a [usize],
    pub(super) k: &'a [f64],
    pub(super) m: &'a [f64],
}

/// Parts on what is kept, and the way from there to all degrees of freedom.
#[derive(Debug)]
pub(super) struct Way {
    constraints: Constraints,
    inside: Inside,
    mass: Symmetric,
    slaves: usize,
}

/// Condenses `blocks` on what `freedom` keeps: constraints by substitution, then slaves statically (eqs 27-32).
///
/// # Errors
/// Slaves that can move without strain; more kept than dense matrices are made for.
pub(super) fn reduce(source: &DeckSource, freedom: &Freedom, blocks: &[Block<'_>]) -> Result<Way, DeckError> {
    if freedom.kept.len() > MOST_KEPT {
        let found = format!("{} degrees of freedom are kept", freedom.kept.len());
        let help = format!("{MOST_KEPT} at most: their matrices are full");
        return Err(source.error(freedom.count.clone(), Fault::TooLarge, found, help));
    }
    let mut kept = vec![false; freedom.ndof()];
    freedom.kept.iter().for_each(|dof| kept[*dof] = true);
    let mut order: Vec<usize> = (0..freedom.ndof()).filter(|dof| !kept[*dof]).collect();
    order.extend(&freedom.kept);
    let at = freedom.count.clone();
    let relations = freedom.relations.iter().map(|r| (r.dof, &r.terms[..]));
    let constraints = Constraints::following(&order, relations)
        .map_err(|why| source.error(at.clone(), Fault::Constrained, why.to_string(), "look at the equations"))?;
    let slaves = constraints.ndof() - freedom.kept.len();
    let pattern = Arc::new(block_pattern(blocks.iter().map(|b| b.dofs), &constraints));
    let k = assemble_blocks(&pattern, blocks.iter().map(|b| (b.dofs, b.k)), &constraints);
    let mass = assemble_blocks(&pattern, blocks.iter().map(|b| (b.dofs, b.m)), &constraints);
    let loose = |column: usize| {
        let near = freedom.phrase(constraints.original(column));
        let found = format!("what is not kept can move without strain, seen at {near}");
        // The last one that is kept is where it is known that no more are.
        let place = freedom.places.last().unwrap_or(&at).clone();
        source.error(place, Fault::Singular, found, "keep or constrain enough to stop every rigid motion")
    };
    let inside = Inside::new(k, slaves, NonZeroUsize::MIN).map_err(|why| match why {
        FactorError::NotPositive { column } => loose(column),
        why => source.error(at.clone(), Fault::TooLarge, why.to_string(), "divide the model into smaller pieces"),
    })?;
    if let Some((column, pivot)) = inside.weakest()
        && !(pivot > SINGULAR)
    {
        return Err(loose(column));
    }
    // Most unknowns are derivatives, which have no inertia.
    Ok(Way { constraints, inside, mass: mass.compact(), slaves })
}

impl Way {
    /// K̂ and M̂ on what is kept, in its order, both triangles, column-major.
    pub(super) fn condensed(&self) -> [Vec<f64>; 2] {
        self.inside.condense(Some(&self.mass))
    }

    /// All degrees of freedom from those that are kept.
    pub(super) fn expand(&self, kept: &[f64]) -> Vec<f64> {
        let mut free = vec![0.0; self.constraints.ndof()];
        free[self.slaves..].copy_from_slice(kept);
        self.inside.follow(&mut free);
        let mut all = vec![0.0; self.constraints.all()];
        self.constraints.expand(&free, &mut all);
        all
    }
}
