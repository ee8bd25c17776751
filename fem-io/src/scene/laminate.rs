//! The laminate: plies from the bottom up and the element layers that hold them.

use super::material;
use crate::document::keys::{Form, Keys, key};
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Located, SceneError};
use crate::document::tree::Node;
use fem_core::laminate::{LaminaPly, Laminate};
use fem_core::layup::{self, LayupPly};
use fem_core::material::Material;
use fem_core::plugin::{Dimension, unknown_key};

pub(super) const KEYS: Keys = &[
    key(
        "group",
        Form::Text,
        r#""reinforced""#,
        "a physical surface that has these plies; the rest of the plate if left out",
    ),
    key("plies", Form::Text, r#""[0/45/-45/90]2s""#, "angles from the bottom up, degrees from x towards y").required(),
    key("material", Form::Text, r#""as4-3502""#, "of all plies without a type of their own: a name of `materials`")
        .required(),
    key("ply_thickness", Form::Quantity(Dimension::LENGTH), r#""0.13208 mm""#, "thickness of a ply").required(),
    key(
        "layers",
        Form::OneOf(&[Form::Count(1), Form::List(&Form::Count(1))]),
        "[8, 8]",
        "layers of cells, or how many plies each holds, from the bottom up; two if left out",
    ),
    key(
        "ply",
        Form::Named(&Form::Table(PLY_KEYS)),
        r#"{ core = { thickness = "5 mm" } }"#,
        "types of ply, for `plies` such as \"[0/90{core}]s\"",
    ),
    key("interface", Form::Text, r#""resin""#, "material between the plies, for criteria that look there"),
];
const PLY_KEYS: Keys = &[
    key("material", Form::Text, r#""foam""#, "a name of `materials`"),
    key("thickness", Form::Quantity(Dimension::LENGTH), r#""5 mm""#, "thickness of such a ply"),
];

/// Material and thickness of a ply type.
#[derive(Clone, Copy)]
struct PlyType {
    material: usize,
    thickness: f64,
}

/// The plies of a plate or of a part of it.
#[derive(Debug, Clone)]
pub struct LaminateSpec {
    /// Physical surface; the rest of the plate if there is none.
    pub group: Option<Located<String>>,
    /// The plies; their materials count in those of the scene.
    pub laminate: Located<Laminate>,
    /// Whether the scene names its layers of cells.
    pub layered: bool,
}

/// The laminates, one table or a list of them, and the material of the resin between plies if one is named.
pub(super) fn read_all(
    field: &SceneValue<'_>,
    materials: &[Located<Material>],
) -> Result<(Vec<LaminateSpec>, Option<Located<usize>>), SceneError> {
    let list = if matches!(field.node(), Node::List(_)) { field.list()? } else { Vec::new() };
    let fields: Vec<&SceneValue<'_>> = if list.is_empty() { vec![field] } else { list.iter().collect() };
    let (mut all, mut interface): (Vec<LaminateSpec>, Option<Located<usize>>) = (Vec::new(), None);
    for (number, field) in fields.iter().enumerate() {
        let (spec, resin) = read(field, materials)?;
        if let Some(first) = all.first() {
            if let Some(why) = first.laminate.value.disagreement(&spec.laminate.value) {
                let message = format!("laminates 1 and {} do not fit together: {why}", number + 1);
                let help = "the faces of all plies must lie at the same heights in all laminates of a plate";
                return Err(field.error(message, help));
            }
            if resin.as_ref().map(|resin| resin.value) != interface.as_ref().map(|resin| resin.value) {
                let message = format!("laminates 1 and {} have different materials between their plies", number + 1);
                return Err(field.error(message, "give all laminates of a plate the same `interface`"));
            }
        }
        if spec.group.is_none() && all.iter().any(|other| other.group.is_none()) {
            let help = "give all but one a `group`, the name of the physical surface that has these plies";
            return Err(field.error("a second laminate has no `group`", help));
        }
        interface = resin;
        all.push(spec);
    }
    Ok((all, interface))
}

fn read(
    field: &SceneValue<'_>,
    materials: &[Located<Material>],
) -> Result<(LaminateSpec, Option<Located<usize>>), SceneError> {
    let table = field.table(KEYS)?;
    let group = table.optional("group").map(|field| Ok(field.at(field.text()?.to_owned()))).transpose()?;
    let common = PlyType {
        material: material::find(&table.required("material")?, materials)?,
        thickness: table.required("ply_thickness")?.positive(Dimension::LENGTH)?,
    };
    let types = ply_types(&table, common, materials)?;
    let layup_field = table.required("plies")?;
    let layup = read_layup(&layup_field)?;
    let plies: Vec<LaminaPly> =
        layup.iter().map(|ply| read_ply(ply, common, &types, &layup_field)).collect::<Result<_, _>>()?;
    let layers = table.optional("layers");
    let layered = layers.is_some();
    let layers = match layers {
        Some(field) => read_layers(&field, plies.len())?,
        None => as_equal_as_possible(plies.len(), plies.len().min(2)),
    };
    let interface = match table.optional("interface") {
        Some(field) => Some(field.at(material::find(&field, materials)?)),
        None => None,
    };
    Ok((LaminateSpec { group, laminate: field.at(Laminate { plies, layers }), layered }, interface))
}

fn read_layup(field: &SceneValue<'_>) -> Result<Vec<LayupPly>, SceneError> {
    let text = field.text()?;
    layup::parse(text)
        .map_err(|e| field.error_within(text, e.at, &e.why, "plies run from the bottom up: [0/45/-45/90]2s"))
}

fn ply_types(
    table: &Reader<'_>,
    common: PlyType,
    materials: &[Located<Material>],
) -> Result<Vec<(String, PlyType)>, SceneError> {
    let Some(field) = table.optional("ply") else { return Ok(Vec::new()) };
    let read = |(label, field): &(&str, SceneValue<'_>)| {
        let table = field.table(PLY_KEYS)?;
        let mut ply = common;
        if let Some(field) = table.optional("material") {
            ply.material = material::find(&field, materials)?;
        }
        if let Some(field) = table.optional("thickness") {
            ply.thickness = field.positive(Dimension::LENGTH)?;
        }
        Ok(((*label).to_owned(), ply))
    };
    field.entries()?.iter().map(read).collect()
}

fn read_ply(
    ply: &LayupPly,
    common: PlyType,
    types: &[(String, PlyType)],
    field: &SceneValue<'_>,
) -> Result<LaminaPly, SceneError> {
    let PlyType { material, thickness } = match &ply.label {
        None => common,
        Some(label) => types.iter().find(|(name, _)| name == label).map(|(_, ply)| *ply).ok_or_else(|| {
            let known = unknown_key(label, types.iter().map(|(name, _)| name.as_str()));
            field.error(
                format!("there is no ply type `{label}`"),
                format!(
                    "`{label}` {known}; define it: laminate.ply.{label} = {{ material = \"...\", thickness = \"...\" }}"
                ),
            )
        })?,
    };
    Ok(LaminaPly { angle_deg: ply.angle_deg, angle: ply.angle_deg.to_radians(), material, thickness })
}

fn read_layers(field: &SceneValue<'_>, plies: usize) -> Result<Vec<usize>, SceneError> {
    if let Node::Number(_) = field.node() {
        let layers = field.count()?;
        if layers > plies {
            return Err(field.error(
                format!("{layers} layers for {plies} plies"),
                "a layer of elements holds whole plies, at least one each",
            ));
        }
        return Ok(as_equal_as_possible(plies, layers));
    }
    let layers = field
        .list()?
        .iter()
        .map(|layer| match layer.node() {
            Node::Number(n) if n.fract() != 0.0 => Err(layer.error(
                format!("{n} plies would put a ply interface inside a layer of elements"),
                "layers hold whole plies: give whole numbers, from the bottom up",
            )),
            _ => layer.count(),
        })
        .collect::<Result<Vec<_>, _>>()?;
    let sum: usize = layers.iter().sum();
    if sum == plies {
        return Ok(layers);
    }
    Err(field.error(
        format!("the layers hold {sum} plies, the laminate has {plies}"),
        format!("give plies per layer of elements from the bottom up, {plies} in all"),
    ))
}

fn as_equal_as_possible(plies: usize, layers: usize) -> Vec<usize> {
    (0..layers).map(|i| (i + 1) * plies / layers - i * plies / layers).collect()
}
