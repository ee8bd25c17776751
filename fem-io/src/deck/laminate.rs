//! Materials and plies (records C).

use super::reader::Reader;
use super::source::{DeckError, Fault};
use fem_core::laminate::LaminaPly;
use fem_core::material::{Elastic, Material, Strength, Strengths, Toughnesses};

/// Materials and plies of a deck, in its units.
#[derive(Debug, Clone, PartialEq)]
pub struct DeckLaminate {
    /// The materials; strengths of 0 are left out.
    pub materials: Vec<Material>,
    /// The plies from the bottom up.
    pub plies: Vec<LaminaPly>,
    /// Which material stands for interfaces.
    pub interfaces: usize,
}

impl DeckLaminate {
    /// Heights of the ply boundaries, 0 at the bottom.
    pub fn heights(&self) -> Vec<f64> {
        let mut z = vec![0.0];
        for ply in &self.plies {
            z.push(z[z.len() - 1] + ply.thickness);
        }
        z
    }
}

const STRENGTHS: [Strength; 6] = [Strength::Xt, Strength::Xc, Strength::Yt, Strength::Yc, Strength::S12, Strength::S23];

pub(super) fn read(reader: &mut Reader<'_>) -> Result<DeckLaminate, DeckError> {
    let mut materials = Vec::new();
    for number in 1..=reader.count("NMAT", 1)?.value {
        materials.push(material(reader, number)?);
    }
    let record = reader.record(&["NPLY", "IFMAT"])?;
    let count = record.count(0, 1)?.value;
    let interfaces = record.number(1, materials.len(), Fault::NoSuchMaterial, "materials")?.value - 1;
    let mut plies = Vec::new();
    for _ in 0..count {
        let record = reader.record(&["MAT", "T", "THETA"])?;
        let material = record.number(0, materials.len(), Fault::NoSuchMaterial, "materials")?.value - 1;
        let thickness = record.positive(1, Fault::Thickness)?;
        let angle_deg = record.real(2)?;
        plies.push(LaminaPly { angle: angle_deg.to_radians(), angle_deg, thickness, material });
    }
    Ok(DeckLaminate { materials, plies, interfaces })
}

fn material(reader: &mut Reader<'_>, number: usize) -> Result<Material, DeckError> {
    let label = reader.label()?;
    let constants = reader.record(&["E1", "E2", "NU12", "NU23", "G12", "RHO"])?;
    let positive = |i| constants.positive(i, Fault::Material);
    let (e1, e2, nu12, nu23) = (positive(0)?, positive(1)?, constants.real(2)?, constants.real(3)?);
    let elastic = Elastic::transversely_isotropic(e1, e2, nu12, nu23, positive(4)?);
    let density = positive(5)?;
    if let Err(why) = elastic.check() {
        return reader.error(
            constants.place(),
            Fault::Material,
            format!("no solid has these constants: {why}"),
            "|NU23| < 1 and NU12^2 < (E1/E2)(1 - NU23)/2; E3 = E2, NU13 = NU12, G13 = G12, G23 = E2/(2(1 + NU23))",
        );
    }
    let record = reader.record(&["S1T", "S1C", "S2T", "S2C", "S12", "S23"])?;
    let mut strengths = Strengths::default();
    for (i, which) in STRENGTHS.into_iter().enumerate() {
        let value = record.real(i)?;
        if value < 0.0 {
            return record.error(i, Fault::Material, format!("a strength is {value}"), "strengths are magnitudes");
        }
        if value > 0.0 {
            strengths = strengths.with(which, value);
        }
    }
    let name = if label.is_empty() { format!("material {number}") } else { label };
    Ok(Material {
        name,
        elastic,
        density: Some(density),
        strengths,
        toughness: Toughnesses::default(),
        eta: None,
        expansion: None,
    })
}
