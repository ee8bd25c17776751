//! How the plate is divided into substructures.

use super::support::{self, Unknowns};
use crate::document::keys::{Form, Keys, key};
use crate::document::reader::SceneValue;
use crate::document::source::{Located, SceneError};

/// Parts of the plate that are condensed on their outlines before anything else is done with them.
#[derive(Debug, Clone, PartialEq)]
pub struct SubstructuresSpec {
    /// Which parts.
    pub parts: Parts,
    /// Unknowns that stay beside those on the outlines.
    pub masters: Vec<Unknowns>,
}

/// The parts of a plate.
#[derive(Debug, Clone, PartialEq)]
pub enum Parts {
    /// The cells of each of these groups.
    Groups(Vec<Located<String>>),
    /// Blocks of that many cells along x and y of a built-in mesh.
    Cells(Located<[usize; 2]>),
}

pub(super) const KEYS: Keys = &[
    key("groups", Form::List(&Form::Text), r#"["left", "right"]"#, "groups of cells of the mesh, one per substructure"),
    key(
        "cells",
        Form::Several(2, &Form::Count(1)),
        "[5, 5]",
        "cells of a substructure along x and y of a built-in mesh",
    ),
    key(
        "masters",
        Form::List(&Form::Table(support::UNKNOWNS)),
        r#"[{ group = "line", at = "mid-plane", dofs = ["U30"] }]"#,
        "unknowns that stay beside those on the outlines",
    ),
];

pub(super) fn read(field: &SceneValue<'_>) -> Result<SubstructuresSpec, SceneError> {
    let table = field.table(KEYS)?;
    let parts = match table.either(["groups", "cells"])? {
        [Some(groups), _] => {
            let group = |field: &SceneValue<'_>| Ok(field.at(field.text()?.to_owned()));
            Parts::Groups(groups.list()?.iter().map(group).collect::<Result<_, SceneError>>()?)
        }
        [None, Some(cells)] => Parts::Cells(cells.at(super::mesh::pair(&cells, |field| field.count())?)),
        [None, None] => {
            return Err(
                table.error("the substructures are not named", "give `groups` of the mesh, or `cells` of a block")
            );
        }
    };
    let masters = table
        .optional("masters")
        .map_or(Ok(Vec::new()), |field| field.list()?.iter().map(support::unknowns).collect())?;
    Ok(SubstructuresSpec { parts, masters })
}
