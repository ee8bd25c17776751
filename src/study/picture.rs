//! A study as pictures.

use super::plan::TOGETHER;
use super::report::{Report, Row};
use crate::error::Error;
use fem_io::files::OutputDir;
use fem_io::plot::{self, PlotError};

/// Errors whose cheapest run is named in a picture.
const NAMED: [f64; 3] = [0.1, 0.01, 1e-3];

/// Draws errors over processor time: `work-precision` of everything asked, `work-precision-QUANTITY` of each, and `axes`,
/// what each axis alone leaves; as SVG and PNG. A picture that would show nothing is left out.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_pictures(dir: &OutputDir, report: &Report) -> Result<(), Error> {
    let all: Vec<usize> = (0..report.asked.len()).collect();
    let what = if all.len() == 1 { report.asked[0].as_str() } else { "everything asked" };
    draw(dir, report, "work-precision", what, &all, |row| row.worst())?;
    if all.len() > 1 {
        for (q, quantity) in report.asked.iter().enumerate() {
            let name = format!("work-precision-{}", quantity.replace([' ', '/', '|'], "-"));
            draw(dir, report, &name, quantity, &[q], |row| row.errors.get(q).copied().flatten())?;
        }
    }
    draw(dir, report, "axes", &format!("{what}, each axis alone"), &[], |row| {
        Some(row).filter(|row| row.axis != TOGETHER).and_then(Row::own_worst)
    })
}

fn draw(
    dir: &OutputDir,
    report: &Report,
    name: &str,
    what: &str,
    quantities: &[usize],
    error: impl Fn(&Row) -> Option<f64>,
) -> Result<(), Error> {
    let mut axes: Vec<&str> = Vec::new();
    for row in &report.rows {
        if !axes.contains(&row.axis.as_str()) {
            axes.push(&row.axis);
        }
    }
    let point = |row: &Row| Some((row.result.as_ref().ok()?.total(), error(row)?));
    let series: Vec<(String, Vec<(f64, f64)>)> = axes
        .iter()
        .map(|axis| {
            let mut points: Vec<(f64, f64)> =
                report.rows.iter().filter(|r| r.axis == *axis).filter_map(point).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            ((*axis).to_owned(), points)
        })
        .collect();
    let (mut front, mut named) = (Vec::new(), Vec::new());
    if !quantities.is_empty() {
        front = pareto(report, &error);
        for target in NAMED {
            let row = report.cheapest(quantities, target);
            if let Some((row, (t, e))) = row.and_then(|row| Some((row, point(row)?)))
                && !named.iter().any(|(_, _, label): &(f64, f64, String)| *label == row.level.label)
            {
                named.push((t, e, row.level.label.clone()));
            }
        }
    }
    let drawn = plot::line_plot(&plot::work_precision(&report.title, what, &series, &front, &named));
    let picture = match drawn {
        Err(PlotError::Empty { .. }) => return Ok(()),
        drawn => drawn?,
    };
    dir.write(&format!("{name}.svg"), |w| w.write_all(picture.svg.as_bytes()))?;
    dir.write(&format!("{name}.png"), |w| w.write_all(&picture.png))?;
    Ok(())
}

/// The runs that no faster one beats, by seconds.
fn pareto(report: &Report, error: &impl Fn(&Row) -> Option<f64>) -> Vec<(f64, f64)> {
    let rows = report.rows.iter().filter(|row| row.competes());
    let mut points: Vec<(f64, f64)> =
        rows.filter_map(|row| Some((row.result.as_ref().ok()?.total(), error(row)?))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best = f64::INFINITY;
    points.retain(|point| {
        let better = point.1 < best;
        best = best.min(point.1);
        better
    });
    points
}
