//! Craig-Bampton reduction.

use super::{EXCITED, StaticShapes, columns, solve};
use crate::lanczos::Lanczos;
use fem_core::functional::Functional;
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo, Role};
use fem_core::reduction::{Reduction, ReductionError};
use fem_core::structure::{SolveError, Structure};

/// Static shapes of the contacts plus the lowest modes with the contacts held: exact static flexibility at the contact,
/// which is what the force history hangs on.
///
/// Of the held modes only those that a contact force can excite are found, because the Krylov space starts from the
/// contacts' own shapes: on a symmetric plate under a central impact that doubles the frequency that a given number of
/// modes reaches. No more modes than unknowns are sought.
#[derive(Debug, Clone)]
pub struct CraigBampton {
    modes: usize,
}

impl Reduction for CraigBampton {
    fn basis(
        &self,
        structure: &mut dyn Structure,
        keep: &[Functional],
        _: &[usize],
    ) -> Result<Vec<f64>, ReductionError> {
        let modes = columns(structure, self.modes, keep.len())?;
        let shapes = StaticShapes::new(structure, keep.to_vec())?;
        let mut basis = shapes.shapes();
        // The inverse stiffness with the contacts held.
        let held = |structure: &mut dyn Structure, x: &mut [f64]| -> Result<(), SolveError> {
            let n = structure.ndof();
            solve(structure, x)?;
            x.chunks_exact_mut(n).for_each(|x| shapes.hold(x));
            Ok(())
        };
        if modes > 0 {
            let space = Lanczos::excited(structure, held, &basis)?;
            basis.extend(space.lowest(modes, EXCITED)?.1);
        }
        Ok(basis)
    }
}

const MODES: ParamInfo = ParamInfo::count("modes", "modes with the contact held").default(40.0).role(Role::Size);

impl Plugin for CraigBampton {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Reduction,
        name: "craig-bampton",
        summary: "contact shapes plus modes with the contact held; exact static flexibility at the contact",
        source: "Craig, Bampton 1968",
        params: &[MODES],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Reduction(Box::new(Self { modes: params.count(&MODES)? })))
    }
}
