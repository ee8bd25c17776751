//! The choice of a solid element between the transverse stresses of its strains and smooth ones.

use crate::hermite::Quartet;
use fem_core::element::{Cell, Stack};
use fem_core::plugin::{ParamError, ParamInfo, Params};
use fem_core::transverse::{ACROSS, Operator, SmoothTransverse};

/// Which transverse stresses a layer of several plies has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TransverseStresses {
    /// Smooth across the plies, as equilibrium wants them ([`fem_core::transverse`]).
    Smooth,
    /// C ε of the element's own strains (the report): they jump from ply to ply, and layers of several plies are too stiff.
    OfStrains,
}

impl TransverseStresses {
    pub(crate) const PARAM: ParamInfo = ParamInfo::word(
        "transverse_stresses",
        "transverse stresses of a layer of several plies",
        &[
            ("smooth", "as equilibrium wants them"),
            ("of-strains", "the report's: they jump, and the layer is too stiff"),
        ],
    );

    /// The choice in a scene.
    pub(crate) fn of(params: &Params) -> Result<Self, ParamError> {
        Ok(match params.word(&Self::PARAM)? {
            "of-strains" => Self::OfStrains,
            _ => Self::Smooth,
        })
    }

    /// Those of a layer, if they are not those of its strains.
    pub(crate) fn in_stack(self, stack: &Stack) -> Option<&SmoothTransverse> {
        stack.transverse.as_ref().filter(|_| self == Self::Smooth)
    }

    /// How the transverse strains in a part of a ply follow from the element's own.
    pub(crate) fn across(self, cell: &Cell<'_>, slice: usize, part: [f64; 2]) -> Option<Across> {
        self.in_stack(cell.stack).map(|transverse| Across(transverse.operator(slice, part)))
    }
}

/// See [`SmoothTransverse::operator`].
pub(crate) struct Across([Operator; 4]);

impl Across {
    /// Replaces the transverse rows of a column of the strain operator; a function's gradient is in these `rows` of the strain.
    pub(crate) fn put(&self, column: &mut [f64], rows: &[usize; 3], gradient: &[Quartet; 3]) {
        let mut across = [0.0; 3];
        for (k, operator) in self.0.iter().enumerate() {
            for (row, polynomial) in rows.iter().zip(gradient) {
                for (sum, factor) in across.iter_mut().zip(operator.column(*row).iter()) {
                    *sum += factor * polynomial[k];
                }
            }
        }
        ACROSS.into_iter().zip(across).for_each(|(row, value)| column[row] = value);
    }
}
