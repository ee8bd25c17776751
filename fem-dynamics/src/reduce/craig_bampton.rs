//! Craig-Bampton reduction.

use super::{StaticShapes, krylov};
use fem_core::plugin::{Built, Kind, ParamError, ParamInfo, Params, Plugin, PluginInfo};
use fem_core::reduction::{Functional, Reduction, ReductionError};
use fem_core::structure::Structure;

/// Static shapes of the contacts plus the lowest modes with the contacts held: exact static flexibility at the contact,
/// which is what the force history hangs on.
///
/// Of the held modes only those that a contact force can excite are found, because the Krylov space starts from the
/// contacts' own shapes: on a symmetric plate under a central impact that doubles the frequency that a given number of
/// modes reaches.
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
        let shapes = StaticShapes::new(structure, keep)?;
        let mut basis = shapes.shapes();
        // A x = K⁻¹ M x with the contacts held.
        let n = structure.ndof();
        let mut image = vec![0.0; n];
        let held = |structure: &mut dyn Structure, x: &mut [f64]| -> Result<(), ReductionError> {
            let columns = x.len() / n;
            for x in x.chunks_exact_mut(n) {
                image.fill(0.0);
                structure.add_mass(1.0, x, &mut image);
                x.copy_from_slice(&image);
            }
            structure.solve_shifted(0.0, x, columns).map_err(|e| ReductionError(e.0))?;
            x.chunks_exact_mut(n).for_each(|x| shapes.hold(keep, x));
            Ok(())
        };
        basis.extend(krylov::lowest_modes(structure, held, &shapes.shapes(), self.modes)?);
        Ok(basis)
    }
}

impl Plugin for CraigBampton {
    const INFO: PluginInfo = PluginInfo {
        kind: Kind::Reduction,
        name: "craig-bampton",
        summary: "contact shapes plus modes with the contact held; exact static flexibility at the contact",
        source: "Craig, Bampton 1968",
        params: &[ParamInfo { name: "modes", doc: "modes with the contact held; default 40" }],
    };

    fn build(params: &Params) -> Result<Built, ParamError> {
        Ok(Built::Reduction(Box::new(Self { modes: params.count("modes", 0, Some(40))? })))
    }
}
