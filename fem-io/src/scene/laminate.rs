//! The laminate: plies from the bottom up and the element layers that hold them.

use super::material;
use super::plugin::PluginSpec;
use crate::document::keys::{Form, Keys, key};
use crate::document::reader::{Reader, SceneValue};
use crate::document::source::{Located, Place, SceneError};
use crate::document::tree::Node;
use fem_core::in_situ::Confined;
use fem_core::laminate::{LaminaPly, Laminate};
use fem_core::layup::{self, LayupPly};
use fem_core::material::{Material, Strength};
use fem_core::plugin::{Dimension, unknown_key};
use std::path::Path;

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
        "layers of cells, or how many plies each holds, from the bottom up; if left out two, or one of a shell",
    ),
    key(
        "ply",
        Form::Named(&Form::Table(PLY_KEYS)),
        r#"{ core = { thickness = "5 mm" } }"#,
        "types of ply, for `plies` such as \"[0/90{core}]s\"",
    ),
    key(
        "align",
        Form::Words(&["bottom", "middle", "top"]),
        r#""bottom""#,
        "what lies as high as in the laminate of the rest of the plate, where thickness differs",
    ),
    key(
        "offset",
        Form::Quantity(Dimension::LENGTH),
        r#""0.52 mm""#,
        "instead of `align`: height of the mid-plane above that of the rest of the plate",
    ),
    key("interface", Form::Text, r#""resin""#, "material between the plies, for criteria that look there"),
    key(
        "strengths",
        Form::Words(&["given", "in-situ"]),
        r#""in-situ""#,
        "Yt and S12 of its plies: those of the material, or what plies of other angles beside them raise these to",
    )
    .default(r#""given""#),
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
    /// Where the scene asks for strengths in situ.
    in_situ: Option<Place>,
}

impl LaminateSpec {
    /// Whether its plies have their strengths in situ.
    pub fn is_in_situ(&self) -> bool {
        self.in_situ.is_some()
    }

    /// What results call the part of the plate.
    pub fn name(&self) -> &str {
        self.group.as_ref().map_or("rest", |group| &group.value)
    }
}

/// Heights that differ by less than this fraction of the thickness are one.
const SAME_HEIGHT: f64 = 1e-9;

/// A laminate, and what says where it lies.
type Placed = (LaminateSpec, Option<Located<Lies>>);

/// Where a laminate lies beside that of the rest of the plate.
#[derive(Debug, Clone, Copy)]
enum Lies {
    Bottom,
    Middle,
    Top,
    /// Height of its mid-plane above the other, m.
    At(f64),
}

impl Lies {
    /// z of the mid-plane, m, of a laminate of this thickness beside one of thickness `datum` around z = 0.
    fn middle(self, thickness: f64, datum: f64) -> f64 {
        let middle = match self {
            Self::Bottom => 0.5 * (thickness - datum),
            Self::Middle => 0.0,
            Self::Top => 0.5 * (datum - thickness),
            Self::At(height) => height,
        };
        if middle.abs() <= SAME_HEIGHT * thickness.max(datum) { 0.0 } else { middle }
    }
}

fn read_lies(table: &Reader<'_>) -> Result<Option<Located<Lies>>, SceneError> {
    let align = table.optional("align");
    if let (Some(_), Some(field)) = (&align, table.optional("offset")) {
        return Err(field.error("`align` and `offset` both say where the laminate lies", "keep one of them"));
    }
    if let Some(field) = align {
        let all = [("bottom", Lies::Bottom), ("middle", Lies::Middle), ("top", Lies::Top)];
        return Ok(Some(field.at(field.choice(&all)?)));
    }
    table.optional("offset").map(|field| Ok(field.at(Lies::At(field.quantity(Dimension::LENGTH)?)))).transpose()
}

/// Gives laminates their heights: those of the rest of the plate, or the first where all have groups, lie around z = 0.
fn place(all: &mut [Placed], fields: &[&SceneValue<'_>]) -> Result<(), SceneError> {
    let datum = all.iter().position(|(spec, _)| spec.group.is_none()).unwrap_or(0);
    if all[datum].1.is_some() {
        let which = if all[datum].0.group.is_none() { "the rest of the plate" } else { "the first region" };
        let message = format!("heights count from the mid-plane of this laminate, that of {which}");
        let help = "leave `align` and `offset` out here: they say where the other laminates lie";
        return Err(fields[datum].error(message, help));
    }
    let thickness = all[datum].0.laminate.value.thickness();
    for (number, (spec, lies)) in all.iter_mut().enumerate().filter(|(number, _)| *number != datum) {
        let own = spec.laminate.value.thickness();
        if lies.is_none() && (own - thickness).abs() > SAME_HEIGHT * own.max(thickness) {
            let (first, second) = (datum.min(number), datum.max(number));
            let [a, b] = if number < datum { [own, thickness] } else { [thickness, own] }.map(|h| h * 1e3);
            let message = format!(
                "laminates {} and {} are {a:.6} and {b:.6} mm thick, and nothing says how one lies beside the other",
                first + 1,
                second + 1
            );
            let help = "write align = \"bottom\", \"middle\" or \"top\", what both have at one height, or `offset`";
            return Err(fields[number].error(message, help));
        }
        spec.laminate.value.middle = lies.as_ref().map_or(Lies::Middle, |lies| lies.value).middle(own, thickness);
    }
    Ok(())
}

/// The laminates, one table or a list of them, and the material of the resin between plies if one is named.
pub(super) fn read_all(
    field: &SceneValue<'_>,
    materials: &[Located<Material>],
) -> Result<(Vec<LaminateSpec>, Option<Located<usize>>), SceneError> {
    let list = if matches!(field.node(), Node::List(_)) { field.list()? } else { Vec::new() };
    let fields: Vec<&SceneValue<'_>> = if list.is_empty() { vec![field] } else { list.iter().collect() };
    let (mut all, mut interface) = (Vec::<Placed>::new(), None::<Located<usize>>);
    for (number, field) in fields.iter().enumerate() {
        let ((spec, lies), resin) = read(field, materials)?;
        if number > 0 && resin.as_ref().map(|resin| resin.value) != interface.as_ref().map(|resin| resin.value) {
            let message = format!("laminates 1 and {} have different materials between their plies", number + 1);
            return Err(field.error(message, "give all laminates of a plate the same `interface`"));
        }
        if spec.group.is_none() && all.iter().any(|(other, _)| other.group.is_none()) {
            let help = "give all but one a `group`, the name of the physical surface that has these plies";
            return Err(field.error("a second laminate has no `group`", help));
        }
        interface = resin;
        all.push((spec, lies));
    }
    place(&mut all, &fields)?;
    Ok((all.into_iter().map(|(spec, _)| spec).collect(), interface))
}

fn read(
    field: &SceneValue<'_>,
    materials: &[Located<Material>],
) -> Result<(Placed, Option<Located<usize>>), SceneError> {
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
    let laminate = field.at(Laminate { plies, layers, middle: 0.0 });
    let strengths = table.optional("strengths");
    let strengths = strengths.map(|field| Ok((field.choice(&[("given", false), ("in-situ", true)])?, field.place())));
    let in_situ = strengths.transpose()?.filter(|(asked, _)| *asked).map(|(_, place)| place.clone());
    Ok(((LaminateSpec { group, laminate, layered, in_situ }, read_lies(&table)?), interface))
}

/// Gives plies their strengths in situ where their laminates ask for it: materials of their own, which follow the same laws. `given` is the
/// table of materials, whose files are looked for from `folder`.
pub(super) fn strengthen(
    all: &mut [LaminateSpec],
    (materials, laws): (&mut Vec<Located<Material>>, &mut Vec<Option<PluginSpec>>),
    (given, folder): (&SceneValue<'_>, &Path),
) -> Result<(), SceneError> {
    let alphas = material::read_shear(given, folder, laws)?;
    let source = given.source();
    // What has been made of which material, for how thick plies, and where it is.
    let mut made = Vec::<(usize, f64, Confined, usize)>::new();
    for spec in all {
        let Some(place) = &spec.in_situ else { continue };
        let given = spec.laminate.value.clone();
        for (number, ply) in spec.laminate.value.plies.iter_mut().enumerate() {
            let Some(confined) = given.confined(number) else { continue };
            let (of, thick) = (ply.material, given.thickness_of(given.alike(number)));
            let same = |&&(other, t, c, _): &&(usize, f64, Confined, usize)| {
                other == of && c == confined && (t - thick).abs() <= SAME_HEIGHT * thick
            };
            if let Some((.., known)) = made.iter().find(same) {
                ply.material = *known;
                continue;
            }
            let Located { value: material, place: given_at } = materials[of].clone();
            let strong = material.strengths.get(Strength::S12).is_some() && material.elastic.e1 > material.elastic.e2;
            if alphas[of].is_none() && strong {
                let message = format!(
                    "strength S12 in situ needs `shear_alpha` of material `{}`, of its curve gamma12 = tau/G12 + shear_alpha tau^3: \
                     that of a straight one is far too large",
                    material.name
                );
                let help = "give it to the material, as in shear_alpha = \"2.98e-8 1/MPa^3\", or \"0 1/MPa^3\" if its shear is \
                            straight, or leave `strengths` out";
                return Err(source.error_at(place, message, help));
            }
            let alpha = alphas[of].unwrap_or(0.0);
            let strengths = material.in_situ(thick, confined, alpha).map_err(|why| {
                let help = "give it to the material, or leave `strengths` out";
                source.error_at(place, why.to_string(), help)
            })?;
            let faces = if confined == Confined::OnBothFaces { "inner" } else { "outer" };
            let name = format!("{}, {faces} {}", material.name, Dimension::LENGTH.of(thick));
            materials.push(Located { value: Material { name, strengths, ..material }, place: given_at });
            laws.push(laws[of].clone());
            ply.material = materials.len() - 1;
            made.push((of, thick, confined, ply.material));
        }
    }
    Ok(())
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
