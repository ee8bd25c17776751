//! Sets of nodes, elements and sides become groups.
//!
//! A set of nodes along sides of cells becomes a group of edges, as a physical curve of gmsh is: what holds along an edge knows
//! its direction then.

use std::collections::{BTreeMap, BTreeSet};

use super::error::MeshError;
use super::gathered::{Card, Gathered, Members, Mention, Place, SetList};
use super::{Element, NodeTable, Raw};

/// Sets within sets.
const MAX_DEPTH: usize = 64;

/// Groups as they are given out.
#[derive(Debug, Default)]
pub(super) struct Sets {
    /// Sets of names; the first is empty.
    pub(super) lists: Vec<Vec<String>>,
    /// Which of them each element belongs to.
    pub(super) of_elements: Vec<u32>,
    points: Vec<Element<[u32; 1]>>,
    edges: Vec<Element<[u32; 2]>>,
    warnings: Vec<String>,
}

/// What a name stands for.
#[derive(Debug, Default)]
struct Named {
    name: String,
    nodes: BTreeSet<u32>,
    edges: BTreeSet<[u32; 2]>,
    /// Elements on edges and cells, by their places in the list.
    lines: BTreeSet<u32>,
    cells: BTreeSet<u32>,
}

impl Sets {
    pub(super) fn of(nodes: &NodeTable, gathered: &Gathered, sets: &SetList) -> Result<Self, MeshError> {
        let elements = &gathered.elements;
        let mut resolver = Resolver { nodes, gathered, sets, known: BTreeMap::new() };
        let corner = |node: u64| nodes.index(node);
        let mut named: BTreeMap<String, Named> = BTreeMap::new();
        for ((of, key), (name, mentions)) in sets.iter().filter(|((of, key), _)| gathered.shows(*of, key)) {
            let (of, members) = match of {
                Members::Either => resolver.either(key, mentions)?,
                of => (*of, resolver.resolve(*of, key, 0)?),
            };
            let entry = named.entry(key.clone()).or_insert_with(|| Named { name: name.clone(), ..Named::default() });
            for member in members {
                let card = || &elements[member as usize];
                match of {
                    Members::Nodes | Members::Either => drop(entry.nodes.insert(member)),
                    Members::Elements if card().corners == 2 => drop(entry.lines.insert(member)),
                    Members::Elements => drop(entry.cells.insert(member)),
                    Members::Sides(side) => {
                        let ends = side_of(card(), side).map(|ends| ends.map(corner));
                        if let Some([Some(a), Some(b)]) = ends {
                            entry.edges.insert([a.min(b), a.max(b)]);
                        }
                    }
                }
            }
        }
        let sides = Sides::of(nodes, elements);
        let mut out = Self { lists: vec![Vec::new()], ..Self::default() };
        let mut of_elements: Vec<Vec<u32>> = vec![Vec::new(); elements.len()];
        let mut next = elements.last().map_or(1, |card| card.tag.saturating_add(1));
        for entry in named.into_values() {
            out.hand_out(entry, nodes, elements, &sides, &mut of_elements, &mut next);
        }
        let mut known: BTreeMap<Vec<u32>, u32> = [(Vec::new(), 0)].into();
        out.of_elements = of_elements
            .into_iter()
            .map(|names| {
                *known.entry(names).or_insert_with_key(|names| {
                    let list = names.iter().flat_map(|set| out.lists[*set as usize].clone()).collect();
                    out.lists.push(list);
                    out.lists.len() as u32 - 1
                })
            })
            .collect();
        Ok(out)
    }

    /// What lies on nodes and edges, and what there is to say.
    pub(super) fn into_points_and_edges(self, raw: &mut Raw) {
        raw.points.extend(self.points);
        raw.edges.extend(self.edges);
        raw.warnings.extend(self.warnings);
    }

    /// Makes the groups of a name: of cells, edges and nodes where it stands for several of them.
    fn hand_out(
        &mut self,
        mut entry: Named,
        nodes: &NodeTable,
        elements: &[Card],
        sides: &Sides,
        of_elements: &mut [Vec<u32>],
        next: &mut u64,
    ) {
        let corners = |set: &BTreeSet<u32>| -> BTreeSet<u32> {
            let of = |card: &Card| card.nodes.into_iter().take(card.corners.into()).filter_map(|n| nodes.index(n));
            set.iter().flat_map(|element| of(&elements[*element as usize])).collect()
        };
        let was_of_nodes = !entry.nodes.is_empty();
        entry.nodes.retain(|node| sides.is_corner(*node));
        let ends = entry.edges.iter().flatten().copied().collect();
        if entry.nodes == corners(&entry.cells) || entry.nodes == corners(&entry.lines) || entry.nodes == ends {
            entry.nodes.clear();
        } else if let Some(edges) =
            sides.along(&entry.nodes).filter(|_| entry.edges.is_empty() && entry.lines.is_empty())
        {
            entry.nodes.clear();
            entry.edges = edges;
        }
        let on_edges = !entry.edges.is_empty() || !entry.lines.is_empty();
        let kinds = [!entry.cells.is_empty(), on_edges, !entry.nodes.is_empty()];
        let name = |kind: &str| {
            if kinds.iter().filter(|there| **there).count() > 1 {
                format!("{}/{kind}", entry.name)
            } else {
                entry.name.clone()
            }
        };
        let names = [name("cells"), name("edges"), name("nodes")];
        match kinds.iter().filter(|there| **there).count() {
            0 => {
                let why = if was_of_nodes { "names no corner of a cell" } else { "has no members" };
                self.warnings.push(format!("the set {:?} {why} and is left out", entry.name));
            }
            1 => {}
            _ => {
                let said: Vec<String> =
                    names.iter().zip(kinds).filter(|(_, there)| *there).map(|(name, _)| format!("{name:?}")).collect();
                self.warnings.push(format!(
                    "the name {:?} stands for sets of several kinds, which become the groups {}",
                    entry.name,
                    said.join(" and ")
                ));
            }
        }
        let [cells, edges, points] = names.map(|name| {
            self.lists.push(vec![name]);
            self.lists.len() as u32 - 1
        });
        entry.cells.iter().for_each(|cell| of_elements[*cell as usize].push(cells));
        entry.lines.iter().for_each(|line| of_elements[*line as usize].push(edges));
        let mut tag = || {
            *next = next.saturating_add(1);
            *next
        };
        self.edges.extend(entry.edges.iter().map(|nodes| Element { tag: tag(), nodes: *nodes, groups: edges }));
        self.points.extend(entry.nodes.iter().map(|node| Element { tag: tag(), nodes: [*node], groups: points }));
    }
}

/// Ends of a side of an element by number.
fn side_of(card: &Card, side: u8) -> Option<[u64; 2]> {
    let (n, i) = (usize::from(card.corners), usize::from(side));
    (i < n && n > 2).then(|| [card.nodes[i], card.nodes[(i + 1) % n]])
}

/// Finds the members of sets.
struct Resolver<'a> {
    nodes: &'a NodeTable,
    gathered: &'a Gathered,
    sets: &'a SetList,
    known: BTreeMap<(Members, &'a str), Vec<u32>>,
}

impl<'a> Resolver<'a> {
    /// Nodes by index, elements by their place in the list; each once.
    fn resolve(&mut self, of: Members, key: &'a str, depth: usize) -> Result<Vec<u32>, MeshError> {
        if let Some(known) = self.known.get(&(of, key)) {
            return Ok(known.clone());
        }
        let (_, mentions) = &self.sets[&(of, key.to_owned())];
        let mut members = Vec::new();
        for (mention, place) in mentions {
            match mention {
                Mention::Set(name) => {
                    let named = (plain(of), name.to_uppercase());
                    let Some(((_, inner), _)) = self.sets.get_key_value(&named) else {
                        let what = format!("there is no set {name:?} of {}", words(of));
                        return Err(self.gathered.wrong(*place, what));
                    };
                    if depth == MAX_DEPTH {
                        let what = format!("the set {name:?} names itself through others, or too many name each other");
                        return Err(self.gathered.wrong(*place, what));
                    }
                    members.extend(self.resolve(plain(of), inner, depth + 1)?);
                }
                numbers => members.extend(self.numbered(of, numbers, *place)?),
            }
        }
        members.sort_unstable();
        members.dedup();
        self.known.insert((of, key), members.clone());
        Ok(members)
    }

    fn numbered(&self, of: Members, mention: &Mention, place: Place) -> Result<Vec<u32>, MeshError> {
        match *mention {
            Mention::Number(tag) => self.find(of, tag).map(|index| vec![index]).ok_or_else(|| {
                let what = format!(
                    "a set names the {} {tag}, which the file does not have",
                    &words(of)[..words(of).len() - 1]
                );
                self.gathered.wrong(place, what)
            }),
            Mention::Range([first, last, step]) => {
                let all: Vec<u32> = self.between(of, first, last, step);
                if all.is_empty() {
                    let what = format!("a set names the {} {first} to {last}, none of which the file has", words(of));
                    return Err(self.gathered.wrong(place, what));
                }
                Ok(all)
            }
            Mention::Set(_) => Ok(Vec::new()),
        }
    }

    fn find(&self, of: Members, tag: u64) -> Option<u32> {
        if plain(of) == Members::Nodes {
            return self.nodes.index(tag);
        }
        self.gathered.elements.binary_search_by_key(&tag, |card| card.tag).ok().map(|at| at as u32)
    }

    /// Those of a range that there are.
    fn between(&self, of: Members, first: u64, last: u64, step: u64) -> Vec<u32> {
        let fits = |tag: u64| (first..=last).contains(&tag) && (tag - first).is_multiple_of(step.max(1));
        if plain(of) == Members::Nodes {
            let low = self.nodes.0.partition_point(|node| node.tag < first);
            let tags = self.nodes.0[low..].iter().map(|node| node.tag).take_while(|tag| *tag <= last);
            return (low as u32..).zip(tags).filter(|(_, tag)| fits(*tag)).map(|(at, _)| at).collect();
        }
        let low = self.gathered.elements.partition_point(|card| card.tag < first);
        let tags = self.gathered.elements[low..].iter().map(|card| card.tag).take_while(|tag| *tag <= last);
        (low as u32..).zip(tags).filter(|(_, tag)| fits(*tag)).map(|(at, _)| at).collect()
    }

    /// Nodes where all numbers are of nodes, elements otherwise.
    fn either(&mut self, key: &'a str, mentions: &[(Mention, Place)]) -> Result<(Members, Vec<u32>), MeshError> {
        let there = |of: Members| mentions.iter().all(|(mention, place)| self.numbered(of, mention, *place).is_ok());
        let of = if !there(Members::Nodes) && there(Members::Elements) { Members::Elements } else { Members::Nodes };
        let mut members = Vec::new();
        for (mention, place) in &self.sets[&(Members::Either, key.to_owned())].1 {
            members.extend(self.numbered(of, mention, *place)?);
        }
        Ok((of, members))
    }
}

/// What sets of sides name.
fn plain(of: Members) -> Members {
    match of {
        Members::Sides(_) => Members::Elements,
        Members::Either => Members::Nodes,
        of => of,
    }
}

fn words(of: Members) -> &'static str {
    match plain(of) {
        Members::Nodes => "nodes",
        _ => "elements",
    }
}

/// Sides of cells, from both of their ends.
struct Sides(Vec<(u32, u32)>);

impl Sides {
    fn of(nodes: &NodeTable, elements: &[Card]) -> Self {
        let mut all = Vec::new();
        for card in elements {
            for side in 0..card.corners {
                if let Some([Some(a), Some(b)]) = side_of(card, side).map(|ends| ends.map(|n| nodes.index(n))) {
                    all.extend([(a, b), (b, a)]);
                }
            }
        }
        all.sort_unstable();
        Self(all)
    }

    /// Sides from a node to others, each as often as there are cells at it.
    fn from(&self, node: u32) -> &[(u32, u32)] {
        let low = self.0.partition_point(|side| side.0 < node);
        let rest = &self.0[low..];
        &rest[..rest.partition_point(|side| side.0 == node)]
    }

    fn is_corner(&self, node: u32) -> bool {
        !self.from(node).is_empty()
    }

    /// The sides between the nodes of a set, where each of them is at one: those on the boundary, or, where these are not enough,
    /// all if no node has more than two.
    fn along(&self, set: &BTreeSet<u32>) -> Option<BTreeSet<[u32; 2]>> {
        let within = |most: usize| -> BTreeSet<[u32; 2]> {
            let of = |node: &u32| {
                let sides = self.from(*node).chunk_by(|a, b| a == b).filter(move |alike| alike.len() <= most);
                sides.map(|alike| alike[0]).filter(|(_, to)| set.contains(to)).map(|(a, b)| [a.min(b), a.max(b)])
            };
            set.iter().flat_map(of).collect()
        };
        let touches_all = |edges: &BTreeSet<[u32; 2]>| {
            let ends: BTreeSet<u32> = edges.iter().flatten().copied().collect();
            ends.len() == set.len()
        };
        let at_most_two = |edges: &BTreeSet<[u32; 2]>| {
            let mut degree: BTreeMap<u32, usize> = BTreeMap::new();
            edges.iter().flatten().for_each(|end| *degree.entry(*end).or_default() += 1);
            degree.values().all(|n| *n <= 2)
        };
        if set.len() < 2 {
            return None;
        }
        let boundary = within(1);
        if touches_all(&boundary) {
            return Some(boundary);
        }
        let all = within(2);
        (touches_all(&all) && at_most_two(&all)).then_some(all)
    }
}
