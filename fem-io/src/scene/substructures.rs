//! How the plate is divided into substructures.

use super::reader::{Field, Keys, Reader};
use super::source::{Located, SceneError};
use super::support::{self, NodeSet};
use fem_core::dof::Dof;

/// Parts of the plate that are condensed on their outlines before anything else is done with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Substructures {
    /// Which parts.
    pub parts: Parts,
    /// Unknowns that stay beside those on the outlines.
    pub masters: Vec<Masters>,
}

/// The parts of a plate.
#[derive(Debug, Clone, PartialEq)]
pub enum Parts {
    /// The cells of each of these groups.
    Groups(Vec<Located<String>>),
    /// Blocks of that many cells along x and y of a built-in mesh.
    Cells(Located<[usize; 2]>),
}

/// Unknowns that stay.
#[derive(Debug, Clone, PartialEq)]
pub struct Masters {
    /// Of which nodes.
    pub nodes: NodeSet,
    /// Which unknowns.
    pub dofs: Vec<Dof>,
}

const KEYS: Keys = &[
    ("groups", r#"["left", "right"]"#),
    ("cells", "[5, 5]"),
    ("masters", r#"[{ group = "line", at = "mid-plane", dofs = ["U30"] }]"#),
];
const MASTERS: Keys = &[("group", r#""line""#), ("at", r#""mid-plane""#), ("dofs", r#"["U30"]"#)];

pub(super) fn read(field: &Field<'_>) -> Result<Substructures, SceneError> {
    let table = field.table(KEYS)?;
    let parts = match table.either(["groups", "cells"])? {
        [Some(groups), _] => {
            let group = |field: &Field<'_>| Ok(field.at(field.text()?.to_owned()));
            Parts::Groups(groups.list()?.iter().map(group).collect::<Result<_, SceneError>>()?)
        }
        [None, Some(cells)] => Parts::Cells(cells.at(super::mesh::pair(&cells, |field| field.count())?)),
        [None, None] => {
            return Err(
                table.error("the substructures are not named", "give `groups` of the mesh, or `cells` of a block")
            );
        }
    };
    let masters =
        table.optional("masters").map_or(Ok(Vec::new()), |field| field.list()?.iter().map(masters).collect())?;
    Ok(Substructures { parts, masters })
}

fn masters(field: &Field<'_>) -> Result<Masters, SceneError> {
    let table: Reader<'_> = field.table(MASTERS)?;
    Ok(Masters { nodes: support::nodes(&table)?, dofs: support::dofs(&table.required("dofs")?)? })
}
