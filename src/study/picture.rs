//! A study as pictures.

use super::axes::AxisKind;
use super::ladder::Rung;
use super::plan::TOGETHER;
use super::report::{Report, Row};
use crate::error::Error;
use fem_io::files::OutputDir;
use fem_io::plot::{self, LinePlot, PlotError, Series, Style};

/// Errors whose cheapest run is named in a picture.
const NAMED: [f64; 3] = [0.1, 0.01, 1e-3];

/// Axes of so many runs that they have a name of their own in pictures; the other ways share one.
const OF_THEIR_OWN: [&str; 2] = ["reductions", "integrators"];
const OTHERS: &str = "other ways";

/// Draws errors over processor time: `work-precision` of all quantities, `work-precision-QUANTITY` of each, and
/// `ladders`, what each ladder alone leaves; as SVG and PNG. A picture that would show nothing is left out.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_pictures(dir: &OutputDir, report: &Report) -> Result<(), Error> {
    let all: Vec<usize> = (0..report.asked.len()).collect();
    let what = if all.len() == 1 { report.asked[0].as_str() } else { "all quantities" };
    draw(dir, "work-precision", &work_precision(report, what, &all))?;
    if all.len() > 1 {
        for (q, quantity) in report.asked.iter().enumerate() {
            let name =
                format!("work-precision-{}", quantity.replace(|c: char| c.is_control() || " /|\\".contains(c), "-"));
            draw(dir, &name, &work_precision(report, quantity, &[q]))?;
        }
    }
    draw(dir, "ladders", &ladders(report))
}

fn draw(dir: &OutputDir, name: &str, plot: &LinePlot) -> Result<(), Error> {
    let picture = match plot::line_plot(plot) {
        Err(PlotError::Empty { .. }) => return Ok(()),
        drawn => drawn?,
    };
    Ok(picture.write(dir, name)?)
}

/// The largest error of `quantities` over time: ladders and joint runs as lines, other ways as dots.
fn work_precision(report: &Report, what: &str, quantities: &[usize]) -> LinePlot {
    let error = |row: &Row| {
        let each = quantities.iter().map(|q| row.errors.get(*q).copied().flatten());
        each.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::max)
    };
    let point = |row: &Row| Some((row.result.as_ref().ok()?.total(), error(row)?));
    let series = |label: &str, style: Style, of: &dyn Fn(&Row) -> bool| {
        let points = report.rows.iter().filter(|row| of(row)).filter_map(point).collect();
        Series { label: label.to_owned(), points, style }
    };
    let mut all: Vec<Series> = Vec::new();
    for ladder in &report.ladders {
        let row = |rung: &Rung| report.row_of(&ladder.axis, &rung.level);
        let points = ladder.levels.iter().filter_map(row).filter_map(point).collect();
        all.push(Series { label: ladder.axis.clone(), points, style: Style::Joined });
    }
    all.push(series(TOGETHER, Style::Joined, &|row| row.axis == TOGETHER));
    for name in OF_THEIR_OWN {
        all.push(series(name, Style::Dots, &|row| row.axis == name));
    }
    let other = |row: &Row| row.kind == AxisKind::Ways && !OF_THEIR_OWN.contains(&row.axis.as_str());
    all.push(series(OTHERS, Style::Dots, &|row| other(row) && !row.level.setting.is_empty()));

    // By seconds, as the picture shows them.
    let mut front: Vec<(f64, f64)> = report.rows.iter().filter(|row| row.is_candidate()).filter_map(point).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best = f64::INFINITY;
    front.retain(|point| {
        let better = point.1 < best;
        best = best.min(point.1);
        better
    });
    let mut named: Vec<(f64, f64, String)> = Vec::new();
    for row in NAMED.into_iter().filter_map(|target| report.cheapest(quantities, target)) {
        if let Some((t, e)) = point(row).filter(|_| named.iter().all(|other| other.2 != row.level.label)) {
            named.push((t, e, row.level.label.clone()));
        }
    }
    plot::work_precision(&report.title, what, all, &front, &named)
}

/// What each ladder alone leaves of all quantities that converge, over time.
fn ladders(report: &Report) -> LinePlot {
    let sure = report.convergent();
    let what = match &sure[..] {
        [one] => one.as_str(),
        some if some.len() < report.asked.len() => "what converges",
        _ => "all quantities",
    };
    let point = |axis: &str, rung: &Rung| {
        let record = report.row_of(axis, &rung.level)?.result.as_ref().ok()?;
        Some((record.total(), rung.worst(&sure)))
    };
    let series = report.ladders.iter().map(|ladder| Series {
        label: ladder.axis.clone(),
        points: ladder.levels.iter().filter_map(|rung| point(&ladder.axis, rung)).collect(),
        style: Style::Joined,
    });
    plot::work_precision(&report.title, &format!("{what}, each ladder alone"), series.collect(), &[], &[])
}
