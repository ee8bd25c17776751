//! What a static analysis writes.

use super::{MovedNode, StaticSummary, nodes, path, plans};
use crate::analyses::statics::StaticSolution;
use crate::error::Error;
use crate::model::Model;
use fem_core::profile::ProfilePoint;
use fem_io::files::OutputDir;
use fem_io::plot::{self, Axis, LinePlot, Series, Style};
use fem_io::tables::{self, TableValue};

/// Writes `summary.json`, `displacements.csv`, the path of loads under which interfaces open, and, per profile, `profile-<name>.csv`; unless
/// the scene wants no pictures, those of the profiles, and deflection and stresses in plan.
///
/// # Errors
/// A folder that cannot be written, a number that is not finite, a cell that the element refuses.
pub fn write(dir: &OutputDir, model: &Model, solution: &StaticSolution, summary: &StaticSummary) -> Result<(), Error> {
    tables::write_json(dir, "summary.json", summary)?;
    let nodes = nodes(model, &solution.u);
    let row = |n: &MovedNode| {
        let numbers = n.x.into_iter().chain(n.u).map(TableValue::Number);
        [TableValue::Count(n.tag)].into_iter().chain(numbers).collect()
    };
    let header = ["node", "x_m", "y_m", "z_m", "u_m", "v_m", "w_m"];
    tables::write_columns(dir, "displacements.csv", &header, nodes.iter().map(row))?;
    if model.output.plots {
        plans::write(dir, model, &solution.u)?;
    }
    solution.followed.iter().try_for_each(|followed| path::write(dir, model, followed))?;
    (0..model.profiles.len()).try_for_each(|which| write_profile(dir, model, solution, which))
}

const PROFILE: [&str; 23] = [
    "z_m",
    "ply",
    "angle_deg",
    "u_m",
    "v_m",
    "w_m",
    "sxx_Pa",
    "syy_Pa",
    "szz_Pa",
    "sxy_Pa",
    "syz_Pa",
    "szx_Pa",
    "s1_Pa",
    "s2_Pa",
    "s3_Pa",
    "s12_Pa",
    "s23_Pa",
    "s13_Pa",
    "szz_from",
    "shear_from",
    "szz_strains_Pa",
    "syz_strains_Pa",
    "szx_strains_Pa",
];
const EQUILIBRIUM: [&str; 3] = ["szz_equilibrium_Pa", "syz_equilibrium_Pa", "szx_equilibrium_Pa"];

/// Names of columns, and rows.
pub type ProfileTable = (Vec<&'static str>, Vec<Vec<TableValue<'static>>>);

/// The table of `profile-<name>.csv` of the profile number `which` of `model`.
pub fn profile(model: &Model, solution: &StaticSolution, which: usize) -> ProfileTable {
    let (points, ways) = (&solution.profiles[which], solution.transverse[which]);
    let mut header = PROFILE.to_vec();
    if points.iter().any(|p| p.equilibrium.is_some()) {
        header.extend(EQUILIBRIUM);
    }
    let region = model.profiles[which].profile.quads().next().map_or(0, |quad| model.plate.region(quad));
    let row = |p: &ProfilePoint| {
        let mut row = vec![
            TableValue::Number(p.z),
            TableValue::Count(p.ply as u64 + 1),
            TableValue::Number(model.laminates[region].plies[p.ply].angle_deg),
        ];
        row.extend(p.displacement.into_iter().chain(p.better.0.0).chain(p.better.1.0).map(TableValue::Number));
        row.extend(ways.map(|choice| TableValue::Text(choice.way.name())));
        row.extend(
            [2, 4, 5]
                .map(|k| p.global.0[k])
                .into_iter()
                .chain(p.equilibrium.into_iter().flatten())
                .map(TableValue::Number),
        );
        row
    };
    (header, points.iter().map(row).collect())
}

fn write_profile(dir: &OutputDir, model: &Model, solution: &StaticSolution, which: usize) -> Result<(), Error> {
    let name = &model.profiles[which].line.name.value;
    let (header, rows) = profile(model, solution, which);
    tables::write_columns(dir, &format!("profile-{name}.csv"), &header, rows.into_iter())?;
    let points = &solution.profiles[which];
    if !model.output.plots {
        return Ok(());
    }
    // In-plane and transverse stresses differ by orders of magnitude: a picture each.
    let in_plane = [("\u{3c3}xx", 0), ("\u{3c3}yy", 1), ("\u{3c4}xy", 3)];
    let transverse = [("\u{3c4}zx", 5), ("\u{3c4}yz", 4), ("\u{3c3}zz", 2)];
    for (suffix, components) in [("in-plane", in_plane), ("transverse", transverse)] {
        let series = |(label, k): (&str, usize)| Series {
            label: label.into(),
            points: points.iter().map(|p| (p.better.0.0[k] * 1e-6, p.z * 1e3)).collect(),
            style: Style::Solid,
        };
        let picture = plot::line_plot(&LinePlot {
            title: format!("{}: {name}", model.origin.title),
            x: Axis::linear(format!("Stress, {suffix}"), "MPa"),
            y: Axis::linear("Height", "mm"),
            series: components.map(series).to_vec(),
            marks: Vec::new(),
            doubts: Vec::new(),
        })?;
        picture.write(dir, &format!("profile-{name}-{suffix}"))?;
    }
    Ok(())
}
