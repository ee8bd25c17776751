//! Physical groups: names, and the entities that belong to them.

use std::collections::{BTreeMap, BTreeSet};

use super::entities::Entity;
use super::error::{FilePlace, MeshError, MeshFault};
use super::source::Source;

/// Physical groups of a file.
#[derive(Debug)]
pub(super) struct Groups {
    /// Dimension of each named group.
    dims: BTreeMap<String, i32>,
    /// Names of the groups that each entity, by dimension and number, belongs to.
    entities: BTreeMap<(i32, i32), Vec<String>>,
    /// Surfaces that are parts of a partition and belong to groups.
    pub(super) parts: BTreeSet<i32>,
}

impl Groups {
    /// A group without a name is called by its number.
    pub(super) fn new(source: &Source<'_>, entities: Vec<Entity>) -> Result<Self, MeshError> {
        let names = physical_names(source)?;
        let mut groups = Self { dims: BTreeMap::new(), entities: BTreeMap::new(), parts: BTreeSet::new() };
        for ((dim, _), (place, name)) in &names {
            groups.declare(name, *dim).map_err(|fault| source.error(*place, fault))?;
        }
        for Entity { dim, tag: entity, physical: tags, part } in entities {
            let mut of_entity = Vec::with_capacity(tags.len());
            for tag in tags {
                // A negative number means reversed orientation, which the mesh itself already shows.
                let tag = tag.unsigned_abs();
                let name = names.get(&(dim, tag)).map_or_else(|| tag.to_string(), |(_, name)| name.clone());
                groups.declare(&name, dim).map_err(|fault| source.error(FilePlace::File, fault))?;
                of_entity.push(name);
            }
            of_entity.sort_unstable();
            of_entity.dedup();
            if part && dim == 2 && !of_entity.is_empty() {
                groups.parts.insert(entity);
            }
            // The elements of a partitioned mesh lie on parts, some of which have the number of a whole.
            if groups.entities.insert((dim, entity), of_entity).is_some() && !part {
                let what = format!("$Entities holds the entity {entity} of dimension {dim}");
                return Err(source.error(FilePlace::File, MeshFault::RepeatedTag(what)));
            }
        }
        Ok(groups)
    }

    /// Groups of an entity, none if the file does not know the entity.
    pub(super) fn of(&self, dim: i32, entity: i32) -> Option<&[String]> {
        self.entities.get(&(dim, entity)).map(Vec::as_slice)
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
