//! Materials of a scene: constants, over those of the library or of a file of the user's if one of them is named.

use super::plugin::PluginSpec;
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Located, Origin, SceneError, SceneSource, read_text};
use crate::document::tree::Table;
use crate::materials;
use crate::materials::constants::{KEYS, from_constants};
use crate::units::{self, SHEAR_ALPHA};
use fem_core::material::Material;
use fem_core::plugin::Value;
use std::path::Path;
use std::sync::Arc;

/// All materials of the table `materials`; files are looked for from `folder`.
pub(super) fn read_all(field: &SceneValue<'_>, folder: &Path) -> Result<Vec<Located<Material>>, SceneError> {
    field.entries()?.iter().map(|(name, field)| Ok(field.at(read(name, field, folder)?))).collect()
}

/// The laws that they name, material by material.
pub(super) fn read_laws(field: &SceneValue<'_>) -> Result<Vec<Option<PluginSpec>>, SceneError> {
    let law = |(_, field): &(&str, SceneValue<'_>)| {
        field.table(KEYS)?.optional("law").map(|law| PluginSpec::read_or_name(&law, &[])).transpose()
    };
    field.entries()?.iter().map(law).collect()
}

/// α of their shear, γ12 = τ/G12 + α τ³, 1/Pa³, material by material: that of the law if it has one, or of the material.
pub(super) fn read_shear(
    field: &SceneValue<'_>,
    folder: &Path,
    laws: &[Option<PluginSpec>],
) -> Result<Vec<Option<f64>>, SceneError> {
    let read = |((_, field), law): (&(&str, SceneValue<'_>), &Option<PluginSpec>)| {
        if let Some(Value::Text(text)) = law.as_ref().and_then(|law| law.params.get("alpha")) {
            return Ok(units::parse_as(text, SHEAR_ALPHA).ok());
        }
        let own = field.table(KEYS)?;
        let Some((merged, source)) = whole(field, folder)? else { return shear(&own) };
        shear(&own.of(&merged, KEYS, &source)?)
    };
    field.entries()?.iter().zip(laws).map(read).collect()
}

fn shear(table: &Reader<'_>) -> Result<Option<f64>, SceneError> {
    let Some(field) = table.optional("shear_alpha") else { return Ok(None) };
    match field.quantity(SHEAR_ALPHA)? {
        alpha if alpha >= 0.0 => Ok(Some(alpha)),
        _ => Err(field.error("is below 0: the shear would stiffen", "a curve that is straight has 0")),
    }
}

/// Position of the material that `field` names.
pub(super) fn find(field: &SceneValue<'_>, materials: &[Located<Material>]) -> Result<usize, SceneError> {
    field.word(materials.iter().map(|m| m.value.name.as_str()))
}

fn read(name: &str, field: &SceneValue<'_>, folder: &Path) -> Result<Material, SceneError> {
    let own = field.table(KEYS)?;
    match whole(field, folder)? {
        None => from_constants(name, &own),
        Some((merged, source)) => from_constants(name, &own.of(&merged, KEYS, &source)?),
    }
}

/// A material with the constants of the library or of the file that it names beneath its own, if it names one, and the
/// texts that they stand in.
pub(super) fn whole(field: &SceneValue<'_>, folder: &Path) -> Result<Option<(Table, Arc<SceneSource>)>, SceneError> {
    let own = field.table(KEYS)?;
    let over = |below: &Table| Ok::<_, SceneError>(field.any_table()?.clone().over(below.clone()));
    match (own.optional("library"), own.optional("file"), own.optional("name")) {
        (Some(_), Some(stray), _) => Err(stray.error("cannot be combined with `library`", "leave one of the two out")),
        (_, None, Some(stray)) => Err(stray.error("means nothing without `file`", "add the file or leave it out")),
        (None, None, None) => Ok(None),
        (Some(library), None, None) => {
            let known = &materials::all()[library.word(materials::names())?];
            Ok(Some((over(&known.table)?, Arc::clone(field.source()))))
        }
        (None, Some(file), _) => {
            let path = folder.join(file.text()?);
            let text = read_text(&path).map_err(|why| {
                file.error(format!("cannot read `{}`: {why}", path.display()), "it counts from the folder of the scene")
            })?;
            let source = SceneSource::clone(field.source()).with(Origin::Library, path.display(), &text);
            let source = Arc::new(source);
            let given = materials::parse(&text, &source)?;
            let which = own.required("name")?.word(given.iter().map(|m| m.material.name.as_str()))?;
            Ok(Some((over(&given[which].table)?, source)))
        }
    }
}
