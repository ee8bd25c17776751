//! Supports that hold a plate otherwise than their names say.

use super::builder::Builder;
use fem_core::hold::SupportKind;
use fem_core::plate::Plate;
use fem_core::support::Levels;
use fem_io::scene::{Located, SceneError, Support, SupportArea};
use std::collections::BTreeMap;

/// Nodes that two hinges have in common without a line of both: the corner where edges meet.
const CORNER: usize = 1;

/// A support by its name, and its height.
type Named<'a> = (&'a Located<SupportArea>, Levels);

impl Builder<'_> {
    /// Warns of hinges above each other, and of clamps of a single node.
    pub(super) fn locked(&self, plate: &Plate) -> Result<Vec<String>, SceneError> {
        let mut hinges: BTreeMap<u32, Vec<Named<'_>>> = BTreeMap::new();
        let mut warnings = Vec::new();
        for support in &self.scene.supports {
            let Support::Kind { area, kind, levels, stiffness: None, .. } = support else { continue };
            if !matches!(kind, SupportKind::Hinged | SupportKind::Clamped) {
                continue;
            }
            let columns = plate.columns_of_group(&self.area(plate, area)?);
            if *kind == SupportKind::Hinged {
                columns.iter().for_each(|column| hinges.entry(*column).or_default().push((area, *levels)));
            } else if columns.len() == 1 && !plate.info().is_section() {
                warnings.push(format!(
                    "{} is clamped at a single node: the smaller the cells there, the less it holds; clamp a disc as large as \
                     what grips the plate, over several nodes",
                    area.value
                ));
            }
        }
        let mut shared: BTreeMap<[String; 2], usize> = BTreeMap::new();
        for at in hinges.values() {
            for (i, (below, level)) in at.iter().enumerate() {
                for (above, _) in at[i + 1..].iter().filter(|(_, other)| other != level) {
                    *shared.entry([below, above].map(|area| area.value.to_string())).or_default() += 1;
                }
            }
        }
        warnings.extend(shared.into_iter().filter(|(_, nodes)| *nodes > CORNER).map(|([one, other], _)| {
            let of = if one == other { one } else { format!("{one} and {other}") };
            format!(
                "the hinges of {of} hold the plate at two heights of one place: it does not turn there, as if it were clamped; \
                 keep one of them, or write kind = \"clamped\""
            )
        }));
        Ok(warnings)
    }
}
