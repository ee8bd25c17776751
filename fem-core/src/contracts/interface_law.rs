//! The contract of a law of an interface: from the opening between two faces to tractions, with a memory.

use crate::contracts::failure::UnmetCondition;
use crate::contracts::ply_law::{LawError, LawInfo, LawPoint};
use crate::words::energy::Energy;
use crate::words::material::Elastic;
use dyn_clone::DynClone;
use std::fmt::Debug;

/// Components across an interface: along its normal (positive where it opens), and the two shears in its plane.
pub type Jump = [f64; 3];

/// Tractions of an interface and where their work has gone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InterfaceResponse {
    /// Tractions, Pa.
    pub traction: Jump,
    /// What comes back of the work done per area, J/m².
    pub stored: f64,
    /// What does not.
    pub dissipated: Sinks,
}

impl InterfaceResponse {
    /// Work done per area since the beginning, J/m².
    pub fn energy(&self) -> Energy {
        Energy { stored: self.stored, dissipated: self.dissipated.total() }
    }
}

/// What an interface has dissipated per area since the beginning, J/m², by where it went; none of them ever falls.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sinks {
    /// Into cracks by its opening, mode I.
    pub opening: f64,
    /// Into cracks by shear, modes II and III.
    pub shear: f64,
    /// Into heat, by faces that slide upon each other.
    pub friction: f64,
}

impl Sinks {
    /// All of it.
    pub fn total(&self) -> f64 {
        self.opening + self.shear + self.friction
    }

    /// With `factor` times `more`.
    #[must_use]
    pub fn plus(self, factor: f64, more: Self) -> Self {
        Self {
            opening: self.opening + factor * more.opening,
            shear: self.shear + factor * more.shear,
            friction: self.friction + factor * more.friction,
        }
    }
}

/// A law of an interface, t(δ) with a memory; δ is the jump of the displacement from the lower face to the upper one.
///
/// The answer is a pure function of the point, the jump and the state that the last accepted step has left, as that of a
/// [`PlyLaw`](crate::contracts::ply_law::PlyLaw); states are kept and taken over alike. A closed virgin interface carries nothing.
pub trait InterfaceLaw: DynClone + Debug + Send + Sync {
    /// State variables and required strengths.
    fn info(&self) -> &LawInfo;

    /// Share of its cohesion that a point with this state has lost: 0 as long as its tractions still grow with the jump, 1 where
    /// nothing holds any more. An interface of a plate is opened around the points that have lost some.
    fn damage(&self, point: &LawPoint<'_>, state: &[f64]) -> f64;

    /// What a point with this state has dissipated: what the [response](Self::respond) says that left the state.
    fn dissipated(&self, state: &[f64]) -> Sinks;

    /// Makes `state`, that of a virgin interface, one in which nothing holds any more, such as in a delamination that is there
    /// from the beginning.
    fn broken(&self, point: &LawPoint<'_>, state: &mut [f64]);

    /// Refuses a point whose constants the law cannot use.
    ///
    /// # Errors
    /// The condition that the point does not meet, with its numbers.
    fn check(&self, _point: &LawPoint<'_>) -> Result<(), UnmetCondition> {
        Ok(())
    }

    /// Lengths over which tractions fall to zero ahead of a crack, m, in modes I and II: what cells must resolve. `arm` is the
    /// solid on either side of the interface, `thickness` the smaller of its depths, m. `None` of a law that does not know.
    fn process_zone(&self, _point: &LawPoint<'_>, _arm: &Elastic, _thickness: f64) -> Option<[f64; 2]> {
        None
    }

    /// The answer to `jump`, m, of an interface with the state `old`; all of the state that the jump leaves goes into `new`.
    ///
    /// The tangent, where it is asked for, is ∂t/∂δ of this very answer, `old` held, Pa/m, `tangent[row][column]`; it need not be
    /// symmetric.
    ///
    /// # Errors
    /// A jump for which the law finds no traction.
    fn respond(
        &self,
        point: &LawPoint<'_>,
        jump: &Jump,
        old: &[f64],
        new: &mut [f64],
        tangent: Option<&mut [Jump; 3]>,
    ) -> Result<InterfaceResponse, LawError>;
}
dyn_clone::clone_trait_object!(InterfaceLaw);
