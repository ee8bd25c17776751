//! `fem laminate`.

use super::{Console, Format};
use crate::envelope::criteria;
use crate::model::NamedCriterion;
use crate::registry::Registry;
use clap::Args;
use fem_core::classical::{ClassicalLaminate, PlaneModuli, PlateStrain};
use fem_core::failure::{Site, check_material};
use fem_core::laminate::{LaminaPly, Laminate};
use fem_core::layup;
use fem_core::material::{Material, Strength};
use fem_core::plugin::{Dimension, unknown_key};
use fem_io::scene::{self, Scene};
use fem_io::{materials, units};
use miette::{IntoDiagnostic, miette};
use nalgebra::Matrix3;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// Criterion of the first failure unless another one is asked for.
const CRITERION: &str = "tsai-wu";

/// Share of a stiffness that is rounding.
const NOTHING: f64 = 1e-12;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fem laminate \"[45/0/-45/90]4s\" --material IM7/8552 --ply-thickness \"0.131 mm\" --force 100,0,0\n  \
                  fem laminate coupon/scene.toml --moment 10,0,0"
)]
pub(super) struct Arguments {
    /// The plies from the bottom up, as in a scene, or a scene file (TOML).
    plies: String,
    /// Material of the plies, one of the library.
    #[arg(long, value_name = "MATERIAL")]
    material: Option<String>,
    /// Thickness of a ply with its unit.
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    ply_thickness: Option<f64>,
    /// Forces per length, N11, N22, N12, N/mm.
    #[arg(long, value_name = "N11,N22,N12", value_delimiter = ',', num_args = 1, allow_hyphen_values = true)]
    force: Vec<f64>,
    /// Moments per length, M11, M22, M12, N mm/mm.
    #[arg(long, value_name = "M11,M22,M12", value_delimiter = ',', num_args = 1, allow_hyphen_values = true)]
    moment: Vec<f64>,
    /// Criteria of the first failure, parameters after colons [default: tsai-wu, or those of the scene]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    criteria: Vec<String>,
    #[command(flatten)]
    format: Format,
}

/// A thickness that a ply may have, with its unit, m.
fn length(text: &str) -> Result<f64, String> {
    match units::parse_as(text, Dimension::LENGTH) {
        Ok(length) if (1e-9..=1.0).contains(&length) => Ok(length),
        Ok(_) => Err("must be from 1 nm to 1 m".into()),
        Err(why) => Err(why.to_string()),
    }
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct Moduli {
    Ex_Pa: f64,
    Ey_Pa: f64,
    Gxy_Pa: f64,
    nuxy: f64,
}

impl From<PlaneModuli> for Moduli {
    fn from(PlaneModuli { ex, ey, gxy, nuxy }: PlaneModuli) -> Self {
        Self { Ex_Pa: ex, Ey_Pa: ey, Gxy_Pa: gxy, nuxy }
    }
}

/// Strain of the mid-plane, and curvature.
#[derive(Serialize)]
struct Deformed {
    strain: [f64; 3],
    curvature_1_m: [f64; 3],
}

impl From<PlateStrain> for Deformed {
    fn from(PlateStrain { mid_plane, curvature }: PlateStrain) -> Self {
        Self { strain: mid_plane, curvature_1_m: curvature }
    }
}

/// The ply of least reserve under loads.
#[derive(Serialize)]
struct FirstFailure {
    criterion: String,
    reserve: f64,
    ply: usize,
    angle_deg: f64,
    face: &'static str,
    mode: &'static str,
}

/// What is found; units are in the key names.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct Document {
    plies: usize,
    thickness_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    areal_mass_kg_m2: Option<f64>,
    A_N_m: [[f64; 3]; 3],
    B_N: [[f64; 3]; 3],
    D_N_m: [[f64; 3]; 3],
    /// No coupling of bending and stretching.
    uncoupled: bool,
    /// No coupling of pull and shear.
    balanced: bool,
    /// Larger of D16 and D26 over the root of D11 D22.
    bend_twist: f64,
    in_plane: Moduli,
    flexural: Moduli,
    #[serde(skip_serializing_if = "Option::is_none")]
    per_kelvin: Option<Deformed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    loaded: Option<Deformed>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    strengths_in_situ: Vec<InSitu>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    first_failure: Vec<FirstFailure>,
}

/// Strengths of plies that lie together, of one material and angle.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct InSitu {
    first_ply: usize,
    last_ply: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    Yt_MPa: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    S12_MPa: Option<f64>,
}

pub(super) fn laminate(registry: &Registry, arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let scene = Path::new(&arguments.plies).is_file().then(|| scene::read(arguments.plies.as_ref())).transpose()?;
    let (laminate, materials, in_situ) = match &scene {
        Some(scene) => of_scene(scene, arguments)?,
        None => of_layup(arguments)?,
    };
    let plate = ClassicalLaminate::new(&laminate, &materials);
    let [force, moment] =
        [("force", &arguments.force), ("moment", &arguments.moment)].map(|(name, given)| three(name, given));
    let (force, moment) = (force?.map(|n| n * 1e3), moment?);
    let loaded = (force != [0.0; 3] || moment != [0.0; 3]).then(|| plate.strain(force, moment));
    let first_failure = match &loaded {
        Some(strain) => {
            let asked = match (&arguments.criteria[..], &scene) {
                ([], None) => vec![CRITERION.to_owned()],
                (asked, _) => asked.to_vec(),
            };
            let criteria = criteria(registry, &asked, scene.as_ref())?;
            let of_plies = criteria.iter().filter(|(_, criterion)| criterion.info().site == Site::Ply);
            of_plies
                .map(|named| first(named, &plate, (&laminate, &materials), strain))
                .collect::<miette::Result<_>>()?
        }
        None => Vec::new(),
    };
    let found = Document {
        plies: laminate.plies.len(),
        thickness_m: laminate.thickness(),
        areal_mass_kg_m2: laminate.areal_mass(&materials).ok(),
        A_N_m: plate.membrane.transpose().into(),
        B_N: plate.coupling.transpose().into(),
        D_N_m: plate.bending.transpose().into(),
        uncoupled: plate.is_uncoupled(),
        balanced: plate.is_balanced(),
        bend_twist: plate.bend_twist(),
        in_plane: plate.in_plane().into(),
        flexural: plate.flexural().into(),
        per_kelvin: plate.thermal_strain(&laminate, &materials).ok().map(Into::into),
        loaded: loaded.map(Into::into),
        strengths_in_situ: if in_situ { strengths(&laminate, &materials) } else { Vec::new() },
        first_failure,
    };
    if let Some(scene) = &scene {
        console.warn(&left_out(scene, found.loaded.is_some()));
    }
    console.show(arguments.format, &found, || found.text(&plate))?;
    Ok(ExitCode::SUCCESS)
}

/// What a scene has that is not shown.
fn left_out(scene: &Scene, loaded: bool) -> Vec<String> {
    let regions = scene.laminates.len() - 1;
    let others = (regions > 0).then(|| {
        format!("this is the laminate of the plate apart from its regions: {regions} more of the scene are left out")
    });
    let cured = loaded && scene.effects.named.iter().any(|effect| effect.name() == "cure");
    let cure = cured.then(|| "the first failure leaves out the residual stresses of `effects.cure`".to_owned());
    others.into_iter().chain(cure).collect()
}

/// Of all plies, those that are alike together.
fn strengths(laminate: &Laminate, materials: &[Material]) -> Vec<InSitu> {
    let ends: Vec<usize> = laminate.unlike().chain([laminate.plies.len()]).collect();
    let of = |(first, end): (usize, &usize)| {
        let given =
            |which| materials[laminate.plies[first].material].strengths.get(which).map(|pascals| pascals * 1e-6);
        InSitu { first_ply: first + 1, last_ply: *end, Yt_MPa: given(Strength::Yt), S12_MPa: given(Strength::S12) }
    };
    std::iter::once(0).chain(ends.iter().copied()).zip(&ends).map(of).collect()
}

/// The laminate of the plate apart from regions of their own, its materials, and whether its plies have their strengths in situ.
fn of_scene(scene: &Scene, arguments: &Arguments) -> miette::Result<(Laminate, Vec<Material>, bool)> {
    if arguments.material.is_some() || arguments.ply_thickness.is_some() {
        return Err(miette!(
            help = "leave them out, or give plies: \"[0/90]s\"",
            "a scene has materials and thicknesses of its own"
        ));
    }
    let spec = scene.laminates.iter().find(|spec| spec.group.is_none()).unwrap_or(&scene.laminates[0]);
    let materials = scene.materials.iter().map(|material| material.value.clone()).collect();
    Ok((spec.laminate.value.clone(), materials, spec.is_in_situ()))
}

fn of_layup(arguments: &Arguments) -> miette::Result<(Laminate, Vec<Material>, bool)> {
    let text = &arguments.plies;
    let plies = layup::parse(text).map_err(|wrong| {
        miette!(
            help = "plies run from the bottom up: \"[0/45/-45/90]2s\"; or name a scene that exists",
            "`{text}`: {}",
            wrong.why
        )
    })?;
    let (Some(name), Some(thickness)) = (&arguments.material, arguments.ply_thickness) else {
        let help = "for example: --material IM7/8552 --ply-thickness \"0.131 mm\"";
        return Err(miette!(help = help, "plies need a material and a thickness"));
    };
    let material = materials::library(name).ok_or_else(|| {
        miette!(
            help = format!("`{name}` {}", unknown_key(name, materials::names())),
            "the library has no material `{name}`"
        )
    })?;
    if let Some(label) = plies.iter().find_map(|ply| ply.label.as_ref()) {
        return Err(miette!(help = "write them in a scene", "ply types, here `{label}`, are those of a scene"));
    }
    let ply = |angle_deg: f64| LaminaPly { angle: angle_deg.to_radians(), angle_deg, thickness, material: 0 };
    let plies: Vec<_> = plies.iter().map(|of_layup| ply(of_layup.angle_deg)).collect();
    let layers = vec![plies.len()];
    Ok((Laminate { plies, layers, middle: 0.0 }, vec![material.material.clone()], false))
}

/// Three components; none are three zeros.
fn three(name: &str, given: &[f64]) -> miette::Result<[f64; 3]> {
    match *given {
        [] => Ok([0.0; 3]),
        [a, b, c] if [a, b, c].iter().all(|x| x.is_finite()) => Ok([a, b, c]),
        _ => Err(miette!(
            help = format!("for example: --{name} 100,0,0"),
            "`--{name}` takes three numbers, along 11, 22 and 12"
        )),
    }
}

/// The ply with the least factor by which the loads may grow.
fn first(
    (name, criterion): &NamedCriterion,
    plate: &ClassicalLaminate,
    (laminate, materials): (&Laminate, &[Material]),
    strain: &PlateStrain,
) -> miette::Result<FirstFailure> {
    let mut least: Option<FirstFailure> = None;
    for (k, ply) in laminate.plies.iter().enumerate() {
        let material = &materials[ply.material];
        check_material(&**criterion, name, material).into_diagnostic()?;
        for (face, stress) in ["lower", "upper"].into_iter().zip(plate.stresses(k, strain)) {
            let reserve = criterion.reserve_factor(&stress, material);
            if least.as_ref().is_none_or(|other| reserve.factor < other.reserve) {
                least = Some(FirstFailure {
                    criterion: name.clone(),
                    reserve: reserve.factor,
                    ply: k + 1,
                    angle_deg: ply.angle_deg,
                    face,
                    mode: reserve.mode.map_or("nothing", |mode| criterion.info().modes[mode]),
                });
            }
        }
    }
    least.ok_or_else(|| miette!("the laminate has no plies"))
}

impl Document {
    fn text(&self, plate: &ClassicalLaminate) -> String {
        let mut text = format!("{} plies, {:.4} mm", self.plies, self.thickness_m * 1e3);
        let _ = match self.areal_mass_kg_m2 {
            Some(mass) => writeln!(text, ", {mass:.4} kg/m^2"),
            None => writeln!(text),
        };
        let bending = match self.uncoupled {
            true => "bending and stretching are apart (B = 0)",
            false => "bending and stretching are coupled (B is not 0)",
        };
        let shear = if self.balanced { "balanced (A16 = A26 = 0)" } else { "not balanced (A16 or A26 is not 0)" };
        let twist = self.bend_twist;
        let _ = writeln!(text, "  kind      {bending}; {shear}; D16 or D26 is {twist:.4} of the root of D11 D22");
        let (size, h) = (plate.membrane.amax(), self.thickness_m);
        text.push_str(&rows("A, N/mm", &plate.membrane, 1e-3, size));
        text.push_str(&rows("B, N", &plate.coupling, 1.0, size * h));
        text.push_str(&rows("D, N mm", &plate.bending, 1e3, size * h * h));
        for (name, Moduli { Ex_Pa, Ey_Pa, Gxy_Pa, nuxy }) in
            [("in plane", &self.in_plane), ("flexural", &self.flexural)]
        {
            let [ex, ey, gxy] = [Ex_Pa, Ey_Pa, Gxy_Pa].map(|modulus| modulus * 1e-9);
            let _ = writeln!(text, "  {name:<9} Ex {ex:.4} GPa, Ey {ey:.4} GPa, Gxy {gxy:.4} GPa, nuxy {nuxy:.4}");
        }
        let deformed = [("per kelvin", &self.per_kelvin), ("loaded", &self.loaded)];
        for (name, Deformed { strain, curvature_1_m }) in
            deformed.into_iter().filter_map(|(name, of)| Some((name, of.as_ref()?)))
        {
            let numbers = |of: &[f64; 3], scale: f64| of.map(|x| format!("{:.4}", x * scale + 0.0)).join(", ");
            let _ = writeln!(
                text,
                "  {name:<9} strains {} e-6, curvatures {} 1/km (11, 22, 12)",
                numbers(strain, 1e6),
                numbers(curvature_1_m, 1e3)
            );
        }
        for InSitu { first_ply, last_ply, Yt_MPa, S12_MPa } in &self.strengths_in_situ {
            let plies = match first_ply == last_ply {
                true => format!("ply {first_ply}"),
                false => format!("plies {first_ply} to {last_ply}"),
            };
            let given = [("Yt", Yt_MPa), ("S12", S12_MPa)].into_iter().filter_map(|(name, of)| Some((name, (*of)?)));
            let given: Vec<_> = given.map(|(name, strength)| format!("{name} {strength:.1} MPa")).collect();
            let _ = writeln!(text, "  in situ   {plies}: {}", given.join(", "));
        }
        for FirstFailure { criterion, reserve, ply, angle_deg, face, mode } in &self.first_failure {
            let _ = writeln!(
                text,
                "  failure   {criterion}: {mode} first, in ply {ply} at {angle_deg} degrees, {face} face, at {reserve:.4} times the loads"
            );
        }
        text
    }
}

/// A matrix in units of 1/`scale`; what is nothing beside `size` is rounding.
fn rows(name: &str, matrix: &Matrix3<f64>, scale: f64, size: f64) -> String {
    let mut text = String::new();
    for i in 0..3 {
        let head = if i == 0 { name } else { "" };
        let value = |j: usize| if matrix[(i, j)].abs() < NOTHING * size { 0.0 } else { matrix[(i, j)] * scale };
        let _ = writeln!(text, "  {head:<9} {:>14.2} {:>14.2} {:>14.2}", value(0), value(1), value(2));
    }
    text
}
