//! Nodes and elements: the cell of LAMCEL (records D.1) and the substructure of LAMSUB (D.2).

mod placing;
mod tiling;

use super::laminate::DeckLaminate;
use super::reader::Reader;
use super::record::Stated;
use super::source::{DeckError, Fault};
use placing::{Card, Placing};
use std::ops::Range;
use tiling::Ground;

/// Most nodes of a piece, so that no deck asks for more memory than it is worth.
const MOST_NODES: usize = 100_000;

/// A node of a piece.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Its number.
    pub number: u32,
    /// Its position.
    pub at: [f64; 3],
    /// Turn of its axes about +Z from X, degrees; its unknowns are components and derivatives in these axes.
    pub beta: f64,
}

/// An element of a piece.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementCard {
    /// Its plies, from 0.
    pub plies: Range<usize>,
    /// Its corners as indices of nodes: of a section (x-,z-) (x+,z-) (x+,z+) (x-,z+), of a solid the bottom face
    /// anticlockwise, then the top face.
    pub nodes: Vec<usize>,
    /// Corners of its plane, anticlockwise.
    pub plane: [[f64; 2]; 4],
}

/// The nodes, by their numbers, and elements of a piece.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DeckPiece {
    /// The nodes.
    pub nodes: Vec<Node>,
    /// The elements.
    pub elements: Vec<ElementCard>,
}

const CORNERS: [&str; 8] = ["NODE(1)", "NODE(2)", "NODE(3)", "NODE(4)", "NODE(5)", "NODE(6)", "NODE(7)", "NODE(8)"];

/// The cell of LAMCEL.
pub(super) fn cell(reader: &mut Reader<'_>, laminate: &DeckLaminate, section: bool) -> Result<DeckPiece, DeckError> {
    let corners = if section { 4 } else { 8 };
    let z = laminate.heights();
    let mut placing = Placing::default();
    for number in 1..=reader.count("NE", 1)?.value {
        let record = reader.record(&["ELEN", "EWID", "IPLYB", "IPLYT"])?;
        let length = record.positive(0, Fault::Geometry)?;
        let width = match record.real(1)? {
            0.0 if section => 1.0,
            _ => record.positive(1, Fault::Geometry)?,
        };
        let plies = laminate.plies.len();
        let top_place = record.item_place(3);
        let bottom = record.number(2, plies, Fault::NoSuchPly, "plies")?.value;
        let top = record.number(3, plies, Fault::NoSuchPly, "plies")?.value;
        if top < bottom {
            return reader.error(
                &top_place,
                Fault::NoSuchPly,
                format!("IPLYT {top} lies below IPLYB {bottom}"),
                "plies count from the bottom up",
            );
        }
        let record = reader.record(&CORNERS)?;
        if record.items() != corners {
            return reader.error(
                record.place(),
                Fault::ElementNodes,
                format!("{} nodes, {corners} belong to an element", record.items()),
                if section { "(x-,z-) (x+,z-) (x+,z+) (x-,z+)" } else { "the bottom face anticlockwise, then the top" },
            );
        }
        let nodes: Vec<Stated<u32>> = (0..corners).map(|i| record.node(i, 1)).collect::<Result<_, _>>()?;
        if let Some(i) = (0..corners).find(|i| nodes[..*i].iter().any(|other| other.value == nodes[*i].value)) {
            return record.error(
                i,
                Fault::ElementNodes,
                format!("node {} stands twice in the element", nodes[i].value),
                "the corners of an element are different nodes",
            );
        }
        let heights = [z[bottom - 1], z[top]];
        let nodes = nodes.into_iter().map(|node| node.value).collect();
        let card = Card {
            number,
            plies: bottom - 1..top,
            nodes,
            size: [length, width],
            heights,
            place: record.place().clone(),
        };
        placing.add(reader, card)?;
    }
    placing.finish(reader)
}

/// The substructure of LAMSUB.
pub(super) fn substructure(reader: &mut Reader<'_>, laminate: &DeckLaminate) -> Result<DeckPiece, DeckError> {
    let layers = layers(reader, laminate)?;
    let columns = columns(reader)?;
    let count = (layers.len() + 1) * columns.len();
    if count > MOST_NODES {
        return reader.error(
            &columns[0].1,
            Fault::TooLarge,
            format!("{} layers over {} columns make {count} nodes", layers.len(), columns.len()),
            format!("{MOST_NODES} at most: divide the model into more substructures"),
        );
    }
    let z = laminate.heights();
    let levels: Vec<f64> = std::iter::once(0.0).chain(layers.iter().map(|layer| z[layer.end])).collect();
    let mut piece = DeckPiece::default();
    for (n, ([x, y, beta], _)) in columns.iter().enumerate() {
        for (level, z) in levels.iter().enumerate() {
            let number = (levels.len() * n + level + 1) as u32;
            piece.nodes.push(Node { number, at: [*x, *y, *z], beta: *beta });
        }
    }
    let mut used = vec![false; columns.len()];
    let mut stacks = Vec::new();
    for _ in 0..reader.count("NS", 1)?.value {
        let record = reader.record(&["NCOL(1)", "NCOL(2)", "NCOL(3)", "NCOL(4)"])?;
        let mut stack = [0; 4];
        for (i, column) in stack.iter_mut().enumerate() {
            *column = record.number(i, columns.len(), Fault::NoSuchColumn, "columns")?.value - 1;
            used[*column] = true;
        }
        let twice = (0..4).any(|i| stack[..i].contains(&stack[i]));
        let corner = |i: usize| columns[stack[i % 4]].0;
        let turn = |i: usize| {
            let ([ax, ay, _], [bx, by, _], [cx, cy, _]) = (corner(i), corner(i + 1), corner(i + 2));
            (bx - ax) * (cy - by) - (by - ay) * (cx - bx)
        };
        let clockwise = (0..4).all(|i| turn(i) < 0.0);
        if twice || !(clockwise || (0..4).all(|i| turn(i) > 0.0)) {
            return reader.error(
                record.place(),
                Fault::Geometry,
                format!("the columns {} make no convex quadrilateral", stack.map(|c| (c + 1).to_string()).join(", ")),
                "name the four columns in turn, counter-clockwise seen from +Z",
            );
        }
        if clockwise {
            stack.swap(1, 3);
            reader.warn(record.place(), "the stack runs clockwise seen from +Z and was turned round");
        }
        stacks.push((stack, record.place().clone()));
        let plane = stack.map(|c| [columns[c].0[0], columns[c].0[1]]);
        for (level, plies) in layers.iter().enumerate() {
            let face = |up: usize| stack.map(|c| levels.len() * c + level + up);
            let nodes = [face(0), face(1)].concat();
            piece.elements.push(ElementCard { plies: plies.clone(), nodes, plane });
        }
    }
    if let Some(lonely) = used.iter().position(|used| !used) {
        return reader.error(
            &columns[lonely].1,
            Fault::NotConnected,
            format!("column {} belongs to no stack", lonely + 1),
            "leave it out, or name it in a stack",
        );
    }
    let columns = columns.iter().map(|([x, y, _], place)| ([*x, *y], place)).collect();
    Ground { columns, stacks }.check(reader)?;
    Ok(piece)
}

/// The plies of each layer of elements.
fn layers(reader: &mut Reader<'_>, laminate: &DeckLaminate) -> Result<Vec<Range<usize>>, DeckError> {
    let plies = laminate.plies.len();
    let count = reader.count("NLAYER", 1)?;
    let (mut layers, mut next, mut place) = (Vec::new(), 1, count.place);
    for _ in 0..count.value {
        let record = reader.record(&["IPLYB", "IPLYT"])?;
        let bottom = record.number(0, plies, Fault::Layers, "plies")?.value;
        if bottom != next {
            let help = format!("{next} belongs there: layers follow each other without a gap");
            return record.error(0, Fault::Layers, format!("IPLYB is {bottom}, {next} follows"), help);
        }
        let top = record.number(1, plies, Fault::Layers, "plies")?.value;
        if top < bottom {
            let help = "plies count from the bottom up";
            return record.error(1, Fault::Layers, format!("IPLYT {top} lies below IPLYB {bottom}"), help);
        }
        layers.push(bottom - 1..top);
        (next, place) = (top + 1, record.place().clone());
    }
    if next != plies + 1 {
        let found = format!("the layers end at ply {} of {plies}", next - 1);
        return reader.error(&place, Fault::Layers, found, format!("the last one ends at ply {plies}"));
    }
    Ok(layers)
}

/// X, Y, BETA of each column, with its place.
type Column = ([f64; 3], std::ops::Range<usize>);

fn columns(reader: &mut Reader<'_>) -> Result<Vec<Column>, DeckError> {
    let count = reader.count("NC", 4)?;
    let mut found = std::collections::BTreeMap::new();
    for _ in 0..count.value {
        let record = reader.record(&["NCOL", "X", "Y", "BETA"])?;
        let number = record.number(0, count.value, Fault::NoSuchColumn, "columns")?.value;
        let column = ([record.real(1)?, record.real(2)?, record.real(3)?], record.place().clone());
        if found.insert(number, column).is_some() {
            let help = "each column is defined once";
            return record.error(0, Fault::Twice, format!("column {number} is defined twice"), help);
        }
    }
    // As many different numbers from 1 to their count as there are: all of them.
    Ok(found.into_values().collect())
}
