//! Constraints and masters (records E and F), or governors.

use super::reader::Reader;
use super::record::{Record, Stated};
use super::source::{DeckError, DeckPlace, Fault};

/// A degree of freedom that follows others: u = Σ factor · other, nothing where it is fixed.
#[derive(Debug, Clone, PartialEq)]
pub struct Relation {
    /// The one that follows.
    pub dof: usize,
    /// Others and factors; they were free when the relation was stated, and may follow others since.
    pub terms: Vec<(usize, f64)>,
}

/// What may move: degrees of freedom count node by node, `directions` each.
#[derive(Debug, Clone, PartialEq)]
pub struct Freedom {
    /// Labels of the degrees of freedom of a node.
    pub directions: Vec<String>,
    /// Numbers of the nodes, ascending.
    pub nodes: Vec<u32>,
    /// Constraints, in the order of input.
    pub relations: Vec<Relation>,
    /// Masters or governors, in their order.
    pub kept: Vec<usize>,
    /// Where each of them is named.
    pub places: Vec<DeckPlace>,
    /// Where their number stands.
    pub count: DeckPlace,
}

impl Freedom {
    /// Number of degrees of freedom.
    pub fn ndof(&self) -> usize {
        self.nodes.len() * self.directions.len()
    }

    /// Node and label of a degree of freedom, such as `12 U30`.
    pub fn name(&self, dof: usize) -> String {
        let per_node = self.directions.len();
        format!("{} {}", self.nodes[dof / per_node], self.directions[dof % per_node])
    }

    /// The same as a phrase.
    pub fn phrase(&self, dof: usize) -> String {
        let per_node = self.directions.len();
        format!("{} of node {}", self.directions[dof % per_node], self.nodes[dof / per_node])
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    Free,
    Constrained,
    Kept,
}

/// Which things are named.
#[derive(Debug)]
struct Target {
    /// `None` for all nodes.
    node: Option<usize>,
    /// `None` for all directions.
    direction: Option<usize>,
}

struct Parser<'r, 'a> {
    reader: &'r mut Reader<'a>,
    freedom: Freedom,
    states: Vec<State>,
    /// "master" or "governor".
    kind: &'static str,
}

/// Names of the records that say what is kept.
pub(super) struct Kept {
    pub(super) kind: &'static str,
    pub(super) count: &'static str,
}

/// Constraints and what is kept of the nodes `nodes` (ascending) with `directions` each.
pub(super) fn read(
    reader: &mut Reader<'_>,
    nodes: Vec<u32>,
    directions: Vec<String>,
    kept: &Kept,
) -> Result<Freedom, DeckError> {
    let states = vec![State::Free; nodes.len() * directions.len()];
    let freedom =
        Freedom { directions, nodes, relations: Vec::new(), kept: Vec::new(), places: Vec::new(), count: 0..0 };
    let mut parser = Parser { reader, freedom, states, kind: kept.kind };
    parser.fixed()?;
    parser.sets()?;
    parser.equations()?;
    parser.kept(kept.count)?;
    Ok(parser.freedom)
}

/// The degree of freedom that a record of NODE, DIR names.
pub(super) fn single(freedom: &Freedom, record: &Record<'_>) -> Result<usize, DeckError> {
    let node = node_of(&freedom.nodes, record, &record.node(0, 1)?)?;
    let direction = direction_of(&freedom.directions, record, 1)?;
    Ok(node * freedom.directions.len() + direction)
}

fn node_of(nodes: &[u32], record: &Record<'_>, number: &Stated<u32>) -> Result<usize, DeckError> {
    nodes.binary_search(&number.value).or_else(|_| {
        let help = format!("there are {} nodes, from {} to {}", nodes.len(), nodes[0], nodes[nodes.len() - 1]);
        record.error(0, Fault::NoSuchNode, format!("there is no node {}", number.value), help)
    })
}

fn direction_of(directions: &[String], record: &Record<'_>, item: usize) -> Result<usize, DeckError> {
    let label = label(record.text(item));
    directions.iter().position(|known| *known == label).map_or_else(
        || {
            let found =
                if label.is_empty() { "DIR is missing".to_owned() } else { format!("DIR `{label}` is unknown") };
            record.error(item, Fault::BadDirection, found, format!("one of {} belongs there", directions.join(" ")))
        },
        Ok,
    )
}

/// A label without quotes, in capitals.
fn label(text: &str) -> String {
    let quoted = |q: char| text.strip_prefix(q).and_then(|text| text.strip_suffix(q));
    quoted('\'').or_else(|| quoted('"')).unwrap_or(text).trim().to_ascii_uppercase()
}

impl Parser<'_, '_> {
    /// NODE and DIR, 0 and ALL where they are allowed.
    fn target(&self, record: &Record<'_>, any_node: bool, any_direction: bool) -> Result<Target, DeckError> {
        let number = record.node(0, u32::from(!any_node))?;
        let node = if number.value == 0 { None } else { Some(node_of(&self.freedom.nodes, record, &number)?) };
        let all = any_direction && label(record.text(1)) == "ALL";
        let direction = if all { None } else { Some(direction_of(&self.freedom.directions, record, 1)?) };
        Ok(Target { node, direction })
    }

    fn dof(&self, node: usize, direction: usize) -> usize {
        node * self.freedom.directions.len() + direction
    }

    /// One degree of freedom that must be free.
    fn free(&self, place: &DeckPlace, dof: usize) -> Result<(), DeckError> {
        if self.states[dof] != State::Constrained {
            return Ok(());
        }
        let found = format!("{} is constrained already", self.freedom.phrase(dof));
        let help = "what is fixed, follows in a set or is eliminated by an equation may not appear again";
        self.reader.error(place, Fault::Constrained, found, help)
    }

    fn bind(&mut self, dof: usize, terms: Vec<(usize, f64)>) {
        self.states[dof] = State::Constrained;
        self.freedom.relations.push(Relation { dof, terms });
    }

    fn fixed(&mut self) -> Result<(), DeckError> {
        for _ in 0..self.reader.count("NZDF", 0)?.value {
            let record = self.reader.record(&["NODE", "DIR"])?;
            let Target { node, direction } = self.target(&record, true, false)?;
            let Some(direction) = direction else { continue };
            match node {
                Some(node) => {
                    let dof = self.dof(node, direction);
                    self.free(record.place(), dof)?;
                    self.bind(dof, Vec::new());
                }
                None => {
                    for dof in (0..self.freedom.nodes.len()).map(|node| self.dof(node, direction)).collect::<Vec<_>>() {
                        if self.states[dof] == State::Free {
                            self.bind(dof, Vec::new());
                        }
                    }
                }
            }
        }
        Ok(())
    }

    fn sets(&mut self) -> Result<(), DeckError> {
        for _ in 0..self.reader.count("NCS", 0)?.value {
            let record = self.reader.record(&["NIS", "DIR"])?;
            let count = record.count(0, 2)?;
            let direction = direction_of(&self.freedom.directions, &record, 1)?;
            let (mut set, per_node) = (Vec::new(), self.freedom.directions.len());
            let (nodes, states, freedom) = (&self.freedom.nodes, &self.states, &self.freedom);
            let mut seen = std::collections::BTreeSet::new();
            self.reader.list(&count, "nodes of a coupled set", |reader, number| {
                let Ok(node) = nodes.binary_search(&number.value) else {
                    let found = format!("there is no node {}", number.value);
                    return reader.error(&number.place, Fault::NoSuchNode, found, "name nodes of the model");
                };
                let dof = node * per_node + direction;
                if !seen.insert(dof) {
                    let found = format!("node {} stands twice in the set", number.value);
                    return reader.error(&number.place, Fault::Twice, found, "name each node once");
                }
                if states[dof] == State::Constrained {
                    let found = format!("{} is constrained already", freedom.phrase(dof));
                    let help = "what follows others may not appear again; the first of a set may lead another one";
                    return reader.error(&number.place, Fault::Constrained, found, help);
                }
                set.push(dof);
                Ok(())
            })?;
            for follower in &set[1..] {
                self.bind(*follower, vec![(set[0], 1.0)]);
            }
        }
        Ok(())
    }

    fn equations(&mut self) -> Result<(), DeckError> {
        for _ in 0..self.reader.count("NCE", 0)?.value {
            let count = self.reader.count("NTE", 2)?.value;
            let mut terms: Vec<(usize, f64)> = Vec::new();
            for term in 0..count {
                let record = self.reader.record(&["NODE", "DIR", "VALUE"])?;
                let dof = single(&self.freedom, &record)?;
                self.free(record.place(), dof)?;
                let value = record.real(2)?;
                if term == 0 && value == 0.0 {
                    let help = "V1 d1 = V2 d2 + V3 d3 + ...: d1 is eliminated; what is left out is 0";
                    return record.error(2, Fault::ZeroFactor, "the factor of the first term is zero", help);
                }
                if term > 0 && dof == terms[0].0 {
                    let found = format!("{} stands on both sides of the equation", self.freedom.phrase(dof));
                    return record.error(0, Fault::Twice, found, "V1 d1 = V2 d2 + ...: name d1 once");
                }
                terms.push((dof, value));
            }
            let (first, factor) = terms.remove(0);
            self.bind(first, terms.into_iter().map(|(dof, value)| (dof, value / factor)).collect());
        }
        Ok(())
    }

    fn kept(&mut self, field: &'static str) -> Result<(), DeckError> {
        let count = self.reader.count(field, 1)?;
        self.freedom.count = count.place;
        for _ in 0..count.value {
            let record = self.reader.record(&["NODE", "DIR"])?;
            let target = self.target(&record, true, true)?;
            if let Target { node: Some(node), direction: Some(direction) } = target {
                let dof = self.dof(node, direction);
                self.free(record.place(), dof)?;
                if self.states[dof] == State::Kept {
                    let found = format!("{} is a {} already", self.freedom.phrase(dof), self.kind);
                    return self.reader.error(record.place(), Fault::Twice, found, "name each once");
                }
                self.keep(dof, record.place());
                continue;
            }
            let range = |one: Option<usize>, all: usize| one.map_or(0..all, |one| one..one + 1);
            for node in range(target.node, self.freedom.nodes.len()) {
                for direction in range(target.direction, self.freedom.directions.len()) {
                    let dof = self.dof(node, direction);
                    if self.states[dof] == State::Free {
                        self.keep(dof, record.place());
                    }
                }
            }
        }
        if self.freedom.kept.is_empty() {
            let found = format!("nothing is left that could be a {}", self.kind);
            return self.reader.error(&self.freedom.count.clone(), Fault::Constrained, found, "free some of it");
        }
        Ok(())
    }

    fn keep(&mut self, dof: usize, place: &DeckPlace) {
        self.states[dof] = State::Kept;
        self.freedom.kept.push(dof);
        self.freedom.places.push(place.clone());
    }
}
