//! `$Nodes`.

use super::source::{Source, Version};
use crate::raw::{FilePlace, MeshError, MeshFault, Node, NodeTable, Places as _};

pub(super) fn read(source: &Source<'_>) -> Result<NodeTable, MeshError> {
    let (table, announced) = match source.version {
        Version::V22 => whole(source)?,
        Version::V40 | Version::V41 => in_blocks(source)?,
    };
    if table.len() as u64 != announced {
        let fault = MeshFault::Count { section: "Nodes", announced, found: table.len() };
        return Err(source.error(FilePlace::File, fault));
    }
    NodeTable::checked(source, table)
}

/// Nodes of geometric entities, one after the other.
fn in_blocks(source: &Source<'_>) -> Result<(Vec<Node>, u64), MeshError> {
    let (mut cursor, [blocks, announced, low, high]) = source.begin("Nodes", "node")?;
    let mut table = Vec::with_capacity(source.at_most(announced));
    for block in 1..=blocks {
        let wrong = |what: &'static str| {
            move |at| source.syntax(at, &format!("{what}, in node entity block ({block} of {blocks})"))
        };
        let dim = source.entity(&mut cursor).map_err(wrong("entity dimension or tag"))?.0;
        let parameters = match cursor.int().map_err(wrong("whether nodes are parametric"))? {
            0 => 0,
            _ => dim.clamp(0, 3),
        };
        let count = cursor.size().map_err(wrong("number of nodes"))?;
        let first = table.len();
        let tags_first = source.version == Version::V41;
        for _ in 0..if tags_first { count } else { 0 } {
            let tag = cursor.size().map_err(wrong("node tags"))?;
            table.push(Node { tag, x: [0.0; 3] });
        }
        for i in 0..count as usize {
            if !tags_first {
                table.push(Node { tag: source.tag(&mut cursor).map_err(wrong("node tags"))?, x: [0.0; 3] });
            }
            for x in &mut table[first + i].x {
                *x = cursor.double().map_err(wrong("node coordinates"))?;
            }
            for _ in 0..parameters {
                cursor.double().map_err(wrong("parametric node coordinates"))?;
            }
        }
    }
    cursor.end("$EndNodes").map_err(|at| source.syntax(at, "$EndNodes should stand here"))?;
    let range = high.checked_sub(low).and_then(|n| n.checked_add(1)).unwrap_or(0);
    if source.version == Version::V41 && (low == 0 || range < announced) && table.len() as u64 == announced {
        // What is twice in the file is said first.
        NodeTable::checked(source, table)?;
        let why = "the range of node numbers in the header of $Nodes is too small for its nodes, or holds 0".to_owned();
        return Err(source.error_at(None, MeshFault::Syntax(why)));
    }
    Ok((table, announced))
}

/// The nodes of version 2.2, in one list.
fn whole(source: &Source<'_>) -> Result<(Vec<Node>, u64), MeshError> {
    let (mut cursor, announced) = source.begin_list("Nodes", "nodes")?;
    let mut table = Vec::with_capacity(source.at_most(announced));
    for i in 1..=announced {
        let wrong = |at| source.syntax(at, &format!("number or coordinates of a node ({i} of {announced})"));
        let tag = source.tag(&mut cursor).map_err(wrong)?;
        let x = [cursor.double().map_err(wrong)?, cursor.double().map_err(wrong)?, cursor.double().map_err(wrong)?];
        table.push(Node { tag, x });
    }
    cursor.end("$EndNodes").map_err(|at| source.syntax(at, "$EndNodes should stand here"))?;
    Ok((table, announced))
}
