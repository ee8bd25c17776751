//! TRADYR: new analysis and restart.

use super::freedom::{self, Freedom, Kept};
use super::reader::Reader;
use super::record::{Record, Stated};
use super::source::{DeckError, Fault};
use super::{Deck, KnownResults};
use fem_core::dof::Dof;
use std::collections::{BTreeMap, BTreeSet};

/// Most degrees of freedom of a node.
const MOST_DOFS: usize = 12;

/// How an analysis goes on in time, and what it prints.
#[derive(Debug, Clone, PartialEq)]
pub struct MarchCard {
    /// TITLE.
    pub title: String,
    /// NCHECK.
    pub analyse: bool,
    /// INTALG: order of the Runge-Kutta scheme.
    pub order: usize,
    /// NTSTEP.
    pub steps: usize,
    /// NPRINT: steps between print steps.
    pub every: usize,
    /// NAME1, where print steps are kept.
    pub set: Option<String>,
    /// IDPRNT, IVPRNT, IAPRNT: displacements, velocities, accelerations are printed.
    pub prints: [bool; 3],
    /// DELTA.
    pub step: Stated<f64>,
}

/// Matrices that stand in a place of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// NAME2.
    pub name: Stated<String>,
    /// Its nodes, as indices of the nodes of the model.
    pub nodes: Vec<usize>,
}

/// Impactor and contact.
#[derive(Debug, Clone, PartialEq)]
pub struct ImpactorCard {
    /// MIMP.
    pub mass: f64,
    /// K of q = K Δᴺ.
    pub k: f64,
    /// N.
    pub n: f64,
    /// M, exponent of unloading.
    pub m: f64,
    /// I, exponent of the dent.
    pub i: f64,
    /// C, indentation from which on a dent remains.
    pub c: f64,
    /// U0.
    pub position: f64,
    /// V0, not zero.
    pub velocity: f64,
}

/// A model of pieces that is struck.
#[derive(Debug, Clone, PartialEq)]
pub struct ImpactDeck {
    /// How it goes on in time.
    pub march: MarchCard,
    /// The pieces.
    pub substructures: Vec<Placed>,
    /// Nodes, constraints, governors.
    pub freedom: Freedom,
    /// The struck degree of freedom, one of the governors.
    pub struck: usize,
    /// What strikes it.
    pub impactor: ImpactorCard,
}

pub(super) fn read(reader: &mut Reader<'_>, results: &dyn KnownResults) -> Result<Deck, DeckError> {
    let title = reader.title()?;
    let record = reader.record(&["NCHECK", "NRSTRT", "NDOF"])?;
    let analyse = record.choice(0, 0..=1)? == 1;
    let restart = record.choice(1, 0..=1)? == 1;
    let per_node = if restart { 0 } else { record.choice(2, 1..=MOST_DOFS)? };
    if restart && results.restart() == Some(false) {
        let help = "run a deck with NRSTRT 0 first, in the same project";
        return record.error(1, Fault::NoRestart, "there is no analysis to go on with", help);
    }
    let march = march(reader, title, analyse)?;
    if restart {
        return Ok(Deck::Restart(march));
    }
    let labels = labels(per_node);
    let (substructures, nodes) = substructures(reader, &march, per_node, results)?;
    let freedom = freedom::read(reader, nodes, labels, &Kept { kind: "governor", count: "NGDF" })?;
    let record = reader.record(&["NODE", "DIR"])?;
    let struck = freedom::single(&freedom, &record)?;
    if !freedom.kept.contains(&struck) {
        return record.error(
            0,
            Fault::NotAGovernor,
            format!("{} is struck and is no governor", freedom.phrase(struck)),
            "name it among the governors",
        );
    }
    let impactor = impactor(reader)?;
    Ok(Deck::Impact(ImpactDeck { march, substructures, freedom, struck, impactor }))
}

fn march(reader: &mut Reader<'_>, title: String, analyse: bool) -> Result<MarchCard, DeckError> {
    let record = reader.record(&["INTALG", "NTSTEP", "NPRINT", "NPSAVE"])?;
    let order = record.choice(0, 1..=4)?;
    let (steps, every, save) = (record.count(1, 1)?.value, record.count(2, 1)?.value, record.prints(3)?);
    let record = reader.record(&["IDPRNT", "IVPRNT", "IAPRNT"])?;
    let prints = [record.prints(0)?, record.prints(1)?, record.prints(2)?];
    let record = reader.record(&["DELTA"])?;
    let step = Stated { value: record.positive(0, Fault::Step)?, place: record.item_place(0) };
    let set = if save { Some(reader.name("NAME1")?.value) } else { None };
    Ok(MarchCard { title, analyse, order, steps, every, set, prints, step })
}

/// U10 U11 U13 U30 U31 U33 of six, all of the solid's of twelve, otherwise numbers.
fn labels(per_node: usize) -> Vec<String> {
    let section = |dof: &&Dof| dof.n() != 2 && dof.m() != 2;
    match per_node {
        6 => Dof::SOLID.iter().filter(section).map(Dof::to_string).collect(),
        12 => Dof::SOLID.iter().map(Dof::to_string).collect(),
        _ => (1..=per_node).map(|k| format!("U{k:02}")).collect(),
    }
}

/// The pieces, and the nodes of the model, ascending.
fn substructures(
    reader: &mut Reader<'_>,
    march: &MarchCard,
    per_node: usize,
    results: &dyn KnownResults,
) -> Result<(Vec<Placed>, Vec<u32>), DeckError> {
    let (mut pieces, mut numbers) = (Vec::new(), BTreeSet::new());
    for _ in 0..reader.count("NE", 1)?.value {
        let name = reader.name("NAME2")?;
        let masters = match results.masters(&name.value) {
            Ok(masters) => masters,
            Err(why) if !march.analyse => {
                reader.warn(&name.place, &format!("{why}: its masters were not counted"));
                None
            }
            Err(why) => {
                let help = "name the NAME6 of a generation, and run that first";
                return reader.error(&name.place, Fault::NoSuchResult, why, help);
            }
        };
        let count = reader.count("NNE", 1)?;
        let (mut own, mut seen) = (Vec::new(), BTreeSet::new());
        reader.list(&count, "nodes of a substructure", |reader, node| {
            if !seen.insert(node.value) {
                let found = format!("node {} stands twice in the substructure", node.value);
                return reader.error(&node.place, Fault::Twice, found, "its nodes are different ones");
            }
            own.push(node.value);
            Ok(())
        })?;
        if let Some(masters) = masters
            && count.value.checked_mul(per_node) != Some(masters)
        {
            return reader.error(
                &count.place,
                Fault::Masters,
                format!(
                    "{} nodes of {per_node} degrees of freedom do not make the {masters} masters of `{}`",
                    count.value, name.value
                ),
                "NNE times NDOF is the number of masters",
            );
        }
        numbers.extend(&own);
        pieces.push((name, own));
    }
    let index: BTreeMap<u32, usize> = numbers.iter().enumerate().map(|(i, number)| (*number, i)).collect();
    let place = |(name, own): (_, Vec<u32>)| Placed { name, nodes: own.iter().map(|node| index[node]).collect() };
    Ok((pieces.into_iter().map(place).collect(), numbers.into_iter().collect()))
}

fn impactor(reader: &mut Reader<'_>) -> Result<ImpactorCard, DeckError> {
    let record = reader.record(&["MIMP", "K", "N", "M", "I", "C"])?;
    let mass = record.positive(0, Fault::Impact)?;
    let k = record.positive(1, Fault::Impact)?;
    let exponent = |i: usize, least: f64| in_range(&record, i, least..=f64::MAX);
    let (n, m) = (exponent(2, 1.0)?, exponent(3, 1.0)?);
    let i = in_range(&record, 4, 0.0..=1.0)?;
    let c = record.real(5)?;
    if !(c > 0.0 || i == 0.0 && c == 0.0) {
        let help = "what is left out is 0; only I = 0 leaves no dent and needs no C";
        return record.error(5, Fault::Impact, format!("C is {c}, it must be above zero"), help);
    }
    if m < n {
        let text = format!("M {m} is below N {n}: unloading gives back more than loading took");
        reader.warn(record.place(), &text);
    }
    let record = reader.record(&["U0", "V0"])?;
    let (position, velocity) = (record.real(0)?, record.real(1)?);
    if velocity == 0.0 {
        let help = "V0 above zero strikes along DIR, below zero against it; what is left out is 0";
        return record.error(1, Fault::Impact, "V0 is zero: the impactor has no side to strike from", help);
    }
    Ok(ImpactorCard { mass, k, n, m, i, c, position, velocity })
}

fn in_range(record: &Record<'_>, i: usize, range: std::ops::RangeInclusive<f64>) -> Result<f64, DeckError> {
    let value = record.real(i)?;
    if range.contains(&value) {
        return Ok(value);
    }
    let (low, high) = (range.start(), range.end());
    let belongs = if *high == f64::MAX { format!("{low} or more") } else { format!("{low} to {high}") };
    let field = ["MIMP", "K", "N", "M", "I", "C"][i];
    let help = format!("{belongs} belongs there; what is left out is 0");
    record.error(i, Fault::Impact, format!("{field} is {value}"), help)
}
