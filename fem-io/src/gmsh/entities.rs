//! Geometric entities and the physical groups that they belong to.

use mshio::error::MshParserErrorKind;

use super::cursor::Cursor;
use super::source::{Source, Version};
use crate::raw::{FilePlace, MeshError, MeshFault};

/// A point, curve, surface or volume.
#[derive(Debug)]
pub(super) struct Entity {
    pub(super) dim: i32,
    pub(super) tag: i32,
    /// Numbers of its physical groups, negative for reversed orientation.
    pub(super) physical: Vec<i32>,
    /// Whether it is a part of another one, cut by a partition.
    pub(super) part: bool,
}

/// All entities of a file; parts come after the wholes. Version 2.2 has none.
pub(super) fn read(source: &Source<'_>) -> Result<Vec<Entity>, MeshError> {
    let mut all = match source.version {
        Version::V22 => return Ok(Vec::new()),
        Version::V40 => read_older(source)?,
        Version::V41 => read_whole(source)?,
    };
    if let Some(start) = source.section("PartitionedEntities") {
        let mut cursor = source.cursor(start);
        read_parts(&mut cursor, &mut all)
            .and_then(|()| cursor.end("$EndPartitionedEntities"))
            .map_err(|at| source.syntax(at, "a partitioned entity"))?;
    }
    Ok(all)
}

/// `$Entities`, which mshio reads from a file that holds nothing else.
fn read_whole(source: &Source<'_>) -> Result<Vec<Entity>, MeshError> {
    let start =
        source.section("Entities").ok_or_else(|| source.error(FilePlace::File, MeshFault::Missing("Entities")))?;
    let mut file = source.header().to_vec();
    file.extend(b"$Entities\n");
    let before = file.len();
    file.extend(source.until(start, b"$EndEntities"));
    file.extend(b"$EndEntities\n");
    let entities = mshio::parse_msh_bytes(&file).map_err(|error| {
        let rest = error.backtrace.first().map_or(0, |(rest, _)| rest.len());
        let context: Vec<_> = error
            .filter_msh_errors()
            .map(|(_, kind)| match kind {
                MshParserErrorKind::Context(what) => what.to_string(),
                kind => kind.to_string(),
            })
            .collect();
        source.syntax(start + (file.len() - rest).saturating_sub(before), &context.join(", in "))
    })?;
    let entities =
        entities.data.entities.ok_or_else(|| source.error(FilePlace::File, MeshFault::Missing("Entities")))?;
    let entity = |dim, tag, physical| Entity { dim, tag, physical, part: false };
    let points = entities.points.into_iter().map(|e| entity(0, e.tag, e.physical_tags));
    let curves = entities.curves.into_iter().map(|e| entity(1, e.tag, e.physical_tags));
    let surfaces = entities.surfaces.into_iter().map(|e| entity(2, e.tag, e.physical_tags));
    let volumes = entities.volumes.into_iter().map(|e| entity(3, e.tag, e.physical_tags));
    Ok(points.chain(curves).chain(surfaces).chain(volumes).collect())
}

/// `$Entities` of version 4.0, which mshio does not read: points have a box, too.
fn read_older(source: &Source<'_>) -> Result<Vec<Entity>, MeshError> {
    let missing = |section| source.error(FilePlace::File, MeshFault::Missing(section));
    if source.section("PartitionedEntities").is_some() {
        let what = "partitions in MSH 4.0, which are read in 4.1 alone: set Mesh.MshFileVersion = 4.1";
        return Err(source.error(FilePlace::File, MeshFault::Syntax(what.to_owned())));
    }
    let mut cursor = source.cursor(source.section("Entities").ok_or_else(|| missing("Entities"))?);
    let mut all = Vec::new();
    let mut older = || -> Result<(), usize> {
        let counts = [cursor.size()?, cursor.size()?, cursor.size()?, cursor.size()?];
        for (dim, count) in (0..).zip(counts) {
            for _ in 0..count {
                let tag = cursor.int()?;
                for _ in 0..6 {
                    cursor.double()?;
                }
                let physical = ints(&mut cursor)?;
                if dim > 0 {
                    ints(&mut cursor)?;
                }
                all.push(Entity { dim, tag, physical, part: false });
            }
        }
        cursor.end("$EndEntities")
    };
    older().map_err(|at| source.syntax(at, "an entity"))?;
    Ok(all)
}

/// `$PartitionedEntities`, which mshio skips.
fn read_parts(cursor: &mut Cursor<'_>, all: &mut Vec<Entity>) -> Result<(), usize> {
    let _partitions = cursor.size()?;
    for _ in 0..cursor.size()? {
        let _ghost = [cursor.int()?, cursor.int()?];
    }
    let counts = [cursor.size()?, cursor.size()?, cursor.size()?, cursor.size()?];
    for (dim, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = cursor.int()?;
            let _parent = [cursor.int()?, cursor.int()?];
            ints(cursor)?;
            for _ in 0..if dim == 0 { 3 } else { 6 } {
                cursor.double()?;
            }
            let physical = ints(cursor)?;
            if dim > 0 {
                ints(cursor)?;
            }
            all.push(Entity { dim, tag, physical, part: true });
        }
    }
    Ok(())
}

/// Integers after their number.
fn ints(cursor: &mut Cursor<'_>) -> Result<Vec<i32>, usize> {
    let mut ints = Vec::new();
    for _ in 0..cursor.size()? {
        ints.push(cursor.int()?);
    }
    Ok(ints)
}
