//! Craig-Bampton reduction.

use super::krylov::Krylov;
use super::{StaticShapes, solve};
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
        if self.modes == 0 {
            return Ok(basis);
        }
        let n = structure.ndof();
        // The inverse stiffness with the contacts held.
        let held = |structure: &mut dyn Structure, x: &mut [f64]| -> Result<(), ReductionError> {
            solve(structure, x)?;
            x.chunks_exact_mut(n).for_each(|x| shapes.hold(keep, x));
            Ok(())
        };
        let start = excited(structure, held, &basis)?;
        basis.extend(Krylov::new(structure, held, start)?.lowest_modes(self.modes)?);
        Ok(basis)
    }
}

/// S M applied to the sum of `shapes`: the start of the Krylov space of what they excite.
fn excited(
    structure: &mut dyn Structure,
    inverse: impl Fn(&mut dyn Structure, &mut [f64]) -> Result<(), ReductionError>,
    shapes: &[f64],
) -> Result<Vec<f64>, ReductionError> {
    let mut x = vec![0.0; structure.ndof()];
    for shape in shapes.chunks_exact(structure.ndof()) {
        structure.add_mass(1.0, shape, &mut x);
    }
    inverse(structure, &mut x)?;
    Ok(x)
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
