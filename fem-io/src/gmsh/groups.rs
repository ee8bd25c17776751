//! Physical groups: names, and the entities that belong to them.

use std::collections::{BTreeMap, BTreeSet};

use super::entities::Entity;
use super::source::Source;
use crate::raw::{FilePlace, MeshError, MeshFault};

/// Physical groups of a file.
#[derive(Debug)]
pub(super) struct Groups {
    /// Dimension of each named group.
    dims: BTreeMap<String, i32>,
    /// Names by dimension and number.
    names: Names,
    /// Sets of names that an entity belongs to; the first is empty.
    lists: Vec<Vec<String>>,
    /// The place of each set in the list.
    known: BTreeMap<Vec<String>, u32>,
    /// The set of each physical group alone.
    alone: BTreeMap<(i32, u32), u32>,
    /// The set of each entity, by dimension and number.
    entities: BTreeMap<(i32, i32), u32>,
    /// Surfaces that are parts of a partition and belong to groups.
    pub(super) parts: BTreeSet<i32>,
}

impl Groups {
    /// The set of no group.
    pub(super) const NONE: u32 = 0;

    /// A group without a name is called by its number.
    pub(super) fn new(source: &Source<'_>, entities: Vec<Entity>) -> Result<Self, MeshError> {
        let names = physical_names(source)?;
        let mut groups = Self {
            dims: BTreeMap::new(),
            names: Names::new(),
            lists: vec![Vec::new()],
            known: [(Vec::new(), Self::NONE)].into(),
            alone: BTreeMap::new(),
            entities: BTreeMap::new(),
            parts: BTreeSet::new(),
        };
        for ((dim, _), (place, name)) in &names {
            groups.declare(name, *dim).map_err(|fault| source.error(*place, fault))?;
        }
        groups.names = names;
        for Entity { dim, tag: entity, physical: tags, part } in entities {
            let mut of_entity = Vec::with_capacity(tags.len());
            for tag in tags {
                // A negative number means reversed orientation, which the mesh itself already shows.
                of_entity.push(groups.named(source, dim, tag.unsigned_abs())?);
            }
            if part && dim == 2 && !of_entity.is_empty() {
                groups.parts.insert(entity);
            }
            let of_entity = groups.set(of_entity);
            // The elements of a partitioned mesh lie on parts, some of which have the number of a whole.
            if groups.entities.insert((dim, entity), of_entity).is_some() && !part {
                let what = format!("$Entities holds the entity {entity} of dimension {dim}");
                return Err(source.error(FilePlace::File, MeshFault::RepeatedTag(what)));
            }
        }
        Ok(groups)
    }

    /// The set of an entity, none if the file does not know the entity.
    pub(super) fn of(&self, dim: i32, entity: i32) -> Option<u32> {
        self.entities.get(&(dim, entity)).copied()
    }

    /// The set of a physical group alone; 0 is none.
    pub(super) fn of_physical(&mut self, source: &Source<'_>, dim: i32, physical: i32) -> Result<u32, MeshError> {
        let key = (dim, physical.unsigned_abs());
        if let Some(known) = self.alone.get(&key) {
            return Ok(*known);
        }
        let name = if physical == 0 { None } else { Some(self.named(source, key.0, key.1)?) };
        let set = self.set(name.into_iter().collect());
        self.alone.insert(key, set);
        Ok(set)
    }

    /// The set that holds both.
    pub(super) fn joined(&mut self, a: u32, b: u32) -> u32 {
        self.set([a, b].iter().flat_map(|set| self.lists[*set as usize].clone()).collect())
    }

    /// The sets of names, by number.
    pub(super) fn lists(&self) -> &[Vec<String>] {
        &self.lists
    }

    fn set(&mut self, mut names: Vec<String>) -> u32 {
        names.sort_unstable();
        names.dedup();
        *self.known.entry(names).or_insert_with_key(|names| {
            self.lists.push(names.clone());
            self.lists.len() as u32 - 1
        })
    }

    /// Name of a physical group.
    fn named(&mut self, source: &Source<'_>, dim: i32, tag: u32) -> Result<String, MeshError> {
        let name = self.names.get(&(dim, tag)).map_or_else(|| tag.to_string(), |(_, name)| name.clone());
        self.declare(&name, dim).map_err(|fault| source.error(FilePlace::File, fault))?;
        Ok(name)
    }

    /// All names, of groups without elements, too.
    pub(super) fn names(&self) -> impl Iterator<Item = &String> {
        self.dims.keys()
    }

    fn declare(&mut self, name: &str, dim: i32) -> Result<(), MeshFault> {
        let known = *self.dims.entry(name.to_owned()).or_insert(dim);
        if known == dim {
            return Ok(());
        }
        Err(MeshFault::GroupDimensions { name: name.to_owned(), dims: [known, dim] })
    }
}

type Names = BTreeMap<(i32, u32), (FilePlace, String)>;

/// `$PhysicalNames`, which mshio skips: text in binary files, too.
fn physical_names(source: &Source<'_>) -> Result<Names, MeshError> {
    let mut names = Names::new();
    let Some(start) = source.section("PhysicalNames") else {
        return Ok(names);
    };
    let syntax = |line, why: &str| source.error(FilePlace::Line(line), MeshFault::Syntax(why.to_owned()));
    let mut lines = source.lines(start);
    let (first, text) = lines.next().unwrap_or_default();
    let count: u64 = std::str::from_utf8(text)
        .ok()
        .and_then(|t| t.parse().ok())
        .ok_or_else(|| syntax(first, "the number of physical names should stand here"))?;
    for _ in 0..count {
        let (line, text) = lines.next().ok_or_else(|| syntax(first, "fewer physical names than announced"))?;
        let (key, name) = physical_name(text)
            .ok_or_else(|| syntax(line, "a physical name, dimension number \"name\" in UTF-8, should stand here"))?;
        if name.is_empty() {
            continue;
        }
        if names.insert(key, (FilePlace::Line(line), name)).is_some() {
            let what = format!("the physical group {} of dimension {} is named", key.1, key.0);
            return Err(source.error(FilePlace::Line(line), MeshFault::RepeatedTag(what)));
        }
    }
    match lines.next() {
        Some((_, b"$EndPhysicalNames")) => Ok(names),
        _ => Err(syntax(first, "more physical names than announced")),
    }
}

fn physical_name(line: &[u8]) -> Option<((i32, u32), String)> {
    let text = std::str::from_utf8(line).ok()?;
    let (dim, rest) = text.split_once(' ')?;
    let (tag, quoted) = rest.split_once(' ')?;
    let name = quoted.strip_prefix('"')?.strip_suffix('"')?;
    Some(((dim.parse().ok()?, tag.parse().ok()?), name.to_owned()))
}
