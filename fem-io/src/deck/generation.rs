//! LAMCEL and LAMSUB: control records (A) and what follows them.

use super::cell::{self, DeckPiece};
use super::freedom::{self, Freedom, Kept};
use super::laminate::{self, DeckLaminate};
use super::reader::Reader;
use super::source::{DeckError, Fault};
use super::{Deck, KnownResults, Program, back};
use fem_core::dof::Dof;

/// What a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum PieceKind {
    PlaneStress,
    PlaneStrain,
    Solid,
}

impl PieceKind {
    /// Unknowns of a node, in their order.
    pub fn dofs(self) -> Vec<Dof> {
        let section = |dof: &Dof| dof.n() != 2 && dof.m() != 2;
        Dof::SOLID.into_iter().filter(|dof| self == Self::Solid || section(dof)).collect()
    }
}

/// A piece to be condensed.
#[derive(Debug, Clone, PartialEq)]
pub struct Generation {
    /// TITLE.
    pub title: String,
    /// NCHECK.
    pub analyse: bool,
    /// LAMCEL or LAMSUB.
    pub program: Program,
    /// NATYPE.
    pub kind: PieceKind,
    /// NORDER: Gauss points along each axis of the plane, and through each ply.
    pub order: usize,
    /// IMPRNT.
    pub print_materials: bool,
    /// NAME1 to NAME6.
    pub names: [String; 6],
    /// Materials and plies.
    pub laminate: DeckLaminate,
    /// Nodes and elements.
    pub piece: DeckPiece,
    /// Constraints and masters.
    pub freedom: Freedom,
}

const NAMES: [&str; 6] = ["NAME1", "NAME2", "NAME3", "NAME4", "NAME5", "NAME6"];

/// The deck after its program is known to be LAMCEL or LAMSUB.
pub(super) fn read(reader: &mut Reader<'_>, program: Program, results: &dyn KnownResults) -> Result<Deck, DeckError> {
    let title = reader.title()?;
    let record = reader.record(&["NCHECK", "NATYPE", "NORDER", "IMPRNT"])?;
    let analyse = record.choice(0, 0..=1)? == 1;
    let cell = program == Program::Lamcel;
    let kind = match record.choice(1, 0..=if cell { 3 } else { 1 })? {
        0 => None,
        1 if cell => Some(PieceKind::PlaneStress),
        2 => Some(PieceKind::PlaneStrain),
        _ => Some(PieceKind::Solid),
    };
    let control = match kind {
        Some(kind) => Some((kind, record.choice(2, 2..=4)?, record.prints(3)?)),
        None => None,
    };
    if let Some((_, order @ 2..=3, _)) = control {
        let text = format!(
            "NORDER {order} integrates with too few points: {}; 4 is exact for rectangles",
            if order == 2 {
                "elements have modes that cost no energy"
            } else {
                "elements of a single ply have a mode that costs hardly any energy"
            }
        );
        reader.warn(record.place(), &text);
    }
    let mut names: Vec<super::Stated<String>> = Vec::new();
    for field in NAMES {
        names.push(reader.name(field)?);
    }
    for (i, name) in names.iter().enumerate() {
        let alike = |other: &super::Stated<String>| other.value.eq_ignore_ascii_case(&name.value);
        if let Some(other) = names[..i].iter().position(alike) {
            // The last of the six is where it is known.
            return reader.error(
                &names[5].place,
                Fault::Twice,
                format!("{} and {} are both `{}`", NAMES[other], NAMES[i], name.value),
                "the six names differ, by more than capitals",
            );
        }
    }
    let places = names.iter().map(|name| name.place.clone()).collect::<Vec<_>>();
    let names: [String; 6] = std::array::from_fn(|i| names[i].value.clone());
    let Some((kind, order, print_materials)) = control else {
        let back = back::read(reader, back::Control { title, analyse, program, names, places: &places }, results)?;
        return Ok(Deck::BackSubstitution(back));
    };
    let laminate = laminate::read(reader)?;
    let piece = match program {
        Program::Lamcel => cell::cell(reader, &laminate, kind != PieceKind::Solid)?,
        _ => cell::substructure(reader, &laminate)?,
    };
    let directions = kind.dofs().iter().map(Dof::to_string).collect();
    let nodes = piece.nodes.iter().map(|node| node.number).collect();
    let freedom = freedom::read(reader, nodes, directions, &Kept { kind: "master", count: "NMDF" })?;
    Ok(Deck::Generation(Generation {
        title,
        analyse,
        program,
        kind,
        order,
        print_materials,
        names,
        laminate,
        piece,
        freedom,
    }))
}
