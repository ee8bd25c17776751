//! Back substitution (records B).

use super::reader::Reader;
use super::source::{DeckError, DeckPlace, Fault};
use super::{KnownResults, Program};

/// Which results of elements are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Prints {
    /// Displacements of all nodes.
    pub displacements: bool,
    /// Stresses in global axes.
    pub global_stress: bool,
    /// Strains in global axes.
    pub global_strain: bool,
    /// Stresses in local axes.
    pub local_stress: bool,
    /// Strains in local axes.
    pub local_strain: bool,
    /// At plies.
    pub plies: bool,
    /// At interfaces.
    pub interfaces: bool,
    /// At the surfaces of the laminate.
    pub surfaces: bool,
}

/// One print step of one substructure.
#[derive(Debug, Clone, PartialEq)]
pub struct Set {
    /// NDISP, from 1.
    pub step: usize,
    /// NSUBS, from 1.
    pub substructure: usize,
    /// What is printed.
    pub prints: Prints,
    /// IELEM, from 1.
    pub elements: Vec<usize>,
}

/// Displacements and stresses of elements at print steps of a displacement set.
#[derive(Debug, Clone, PartialEq)]
pub struct BackSubstitution {
    /// TITLE.
    pub title: String,
    /// NCHECK.
    pub analyse: bool,
    /// LAMCEL or LAMSUB.
    pub program: Program,
    /// NAME1 to NAME5 of the generation, and of the displacement set.
    pub names: [String; 6],
    /// What is asked for.
    pub sets: Vec<Set>,
}

/// What the control records said.
pub(super) struct Control<'a> {
    pub(super) title: String,
    pub(super) analyse: bool,
    pub(super) program: Program,
    pub(super) names: [String; 6],
    pub(super) places: &'a [DeckPlace],
}

const FLAGS: [&str; 8] =
    ["IDPRNT", "NPRINT(1)", "NPRINT(2)", "NPRINT(3)", "NPRINT(4)", "NPRINT(5)", "NPRINT(6)", "NPRINT(7)"];

pub(super) fn read(
    reader: &mut Reader<'_>,
    control: Control<'_>,
    results: &dyn KnownResults,
) -> Result<BackSubstitution, DeckError> {
    let Control { title, analyse, program, names, places } = control;
    let extent = match results.extent(program, &names) {
        Ok(extent) => extent,
        Err((which, why)) => {
            let help =
                "NAME1 to NAME5 are those of one generation by this program, NAME6 is a displacement set of TRADYR";
            return reader.error(&places[which], Fault::NoSuchResult, why, help);
        }
    };
    let most = |of: fn(super::Extent) -> usize| extent.map_or(usize::MAX, of);
    let mut sets = Vec::new();
    while sets.is_empty() || reader.more() {
        let record = reader.record(&["NDISP", "NSUBS"])?;
        let step = record.number(0, most(|e| e.steps), Fault::NoSuchResult, "print steps")?.value;
        let substructure = record.number(1, most(|e| e.substructures), Fault::NoSuchResult, "substructures")?.value;
        if extent.is_some()
            && let Err(why) = results.made_of(&names, substructure)
        {
            return record.error(1, Fault::NoSuchResult, why, "name a substructure that is made of these matrices");
        }
        let record = reader.record(&FLAGS)?;
        let flags = (0..8).map(|i| record.prints(i)).collect::<Result<Vec<_>, _>>()?;
        let prints = Prints {
            displacements: flags[0],
            global_stress: flags[1],
            global_strain: flags[2],
            local_stress: flags[3],
            local_strain: flags[4],
            plies: flags[5],
            interfaces: flags[6],
            surfaces: flags[7],
        };
        let mut elements = Vec::new();
        for _ in 0..reader.count("NEBS", 0)?.value {
            let record = reader.record(&["IELEM"])?;
            elements.push(record.number(0, most(|e| e.elements), Fault::NoSuchElement, "elements")?.value);
        }
        sets.push(Set { step, substructure, prints, elements });
    }
    Ok(BackSubstitution { title, analyse, program, names, sets })
}
