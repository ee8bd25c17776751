//! Supports that hold a plate otherwise than their names say.

use super::builder::Builder;
use fem_core::dof::Dof;
use fem_core::hold::SupportKind;
use fem_core::mesh::{Course, Group};
use fem_core::plate::Plate;
use fem_core::support::Levels;
use fem_io::scene::{SceneError, Support};
use std::collections::{BTreeMap, BTreeSet};

/// Nodes that two supports have in common without a line of both: the corner where edges meet.
const CORNER: usize = 1;

/// Sine of the angle between two directions that are one.
const SAME: f64 = 1e-6;

/// What supports without springs hold of the columns along edges.
#[derive(Default)]
struct Held {
    /// The displacement across the edge at one height, by which supports.
    across: BTreeMap<u32, Vec<(String, Levels)>>,
    /// The same over the height.
    upright: BTreeSet<u32>,
    /// The deflection.
    deflection: BTreeSet<u32>,
}

impl Held {
    /// Takes in a support of `columns`, which holds the deflection, or `across` the edge at those of these columns.
    fn add(&mut self, name: &str, levels: Levels, columns: &[u32], deflection: bool, across: impl Fn(u32) -> bool) {
        if deflection {
            self.deflection.extend(columns);
        }
        for column in columns.iter().filter(|column| across(**column)) {
            match levels {
                Levels::All => _ = self.upright.insert(*column),
                _ => self.across.entry(*column).or_default().push((name.into(), levels)),
            }
        }
    }

    /// Pairs of supports that together clamp what each of them leaves free to turn.
    fn clamped(&self) -> impl Iterator<Item = [String; 2]> {
        // Of each pair the nodes in common, and those of them at which the plate does not deflect.
        let mut shared: BTreeMap<[String; 2], [usize; 2]> = BTreeMap::new();
        for (column, at) in self.across.iter().filter(|(column, _)| !self.upright.contains(column)) {
            for (i, (below, level)) in at.iter().enumerate() {
                for (above, _) in at[i + 1..].iter().filter(|(_, other)| other != level) {
                    let [nodes, held] = shared.entry([below.clone(), above.clone()]).or_default();
                    *nodes += 1;
                    *held += usize::from(self.deflection.contains(column));
                }
            }
        }
        let clamps = |[nodes, held]: &[usize; 2]| nodes == held && *nodes > CORNER;
        shared.into_iter().filter(move |(_, of)| clamps(of)).map(|(pair, _)| pair)
    }
}

impl Builder<'_> {
    /// Warns of supports above each other that clamp, and of clamps of a single node.
    pub(super) fn locked(&self, plate: &Plate) -> Result<Vec<String>, SceneError> {
        let (mut held, mut warnings) = (Held::default(), Vec::new());
        for support in &self.scene.supports {
            match support {
                Support::Kind { area, kind, levels, stiffness: None, .. } => {
                    let columns = plate.columns_of_group(&self.area(plate, area)?);
                    let name = area.value.to_string();
                    if *kind == SupportKind::Clamped && columns.len() == 1 && !plate.info().is_section() {
                        warnings.push(format!(
                            "{name} is clamped at a single node: the smaller the cells there, the less it holds; clamp a disc as \
                             large as what grips the plate, over several nodes"
                        ));
                    }
                    held.add(&name, *levels, &columns, kind.holds(3), |_| kind.holds(2));
                }
                Support::Fix { nodes, dofs, axes, .. } => {
                    let group = self.group(plate, &nodes.group)?;
                    let (name, columns) = (format!("`{}`", nodes.group.value), plate.columns_of_group(group));
                    let courses = plate.plane.courses(&Group { quads: Vec::new(), ..group.clone() });
                    let across = |column: u32| {
                        courses.get(&column).is_some_and(|all| all.iter().any(|course| is_across(dofs, *axes, course)))
                    };
                    held.add(&name, nodes.levels, &columns, holds(dofs, 3), across);
                }
                _ => {}
            }
        }
        warnings.extend(held.clamped().map(|[one, other]| {
            let of = if one == other { one } else { format!("{one} and {other}") };
            format!(
                "the supports of {of} hold the plate at two heights of one place against motion across the edge: it does not turn \
                 there, as if it were clamped; keep one of them, or write kind = \"clamped\""
            )
        }));
        Ok(warnings)
    }
}

/// Whether the displacement along an axis is among `dofs`.
fn holds(dofs: &[Dof], axis: usize) -> bool {
    dofs.iter().any(|dof| (dof.n(), dof.m()) == (axis, 0))
}

/// Whether `dofs` in axes turned by `axes`, radians, hold the displacement across an edge.
fn is_across(dofs: &[Dof], axes: f64, course: &Course) -> bool {
    // The normal in these axes: what has a share in it has to be held.
    let (sine, cosine) = (course.angle - axes).sin_cos();
    (holds(dofs, 1) || sine.abs() < SAME) && (holds(dofs, 2) || cosine.abs() < SAME)
}
