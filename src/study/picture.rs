//! A study as pictures.

use super::axes::AxisKind;
use super::converge::ErrorBar;
use super::ladder::Rung;
use super::plan::TOGETHER;
use super::report::{Report, Row};
use crate::error::Error;
use fem_io::files::OutputDir;
use fem_io::plot::{self, Doubt, LinePlot, PlotError, Series, Style};

/// Errors whose cheapest run is named in a picture.
const NAMED: [f64; 3] = [0.1, 0.01, 1e-3];

/// Axes of so many runs that they have a name of their own in pictures; the other ways share one.
const OF_THEIR_OWN: [(&str, &str); 2] = [("reductions", "other reductions"), ("integrators", "other integrators")];

/// A run in a picture: its time and error.
type Point = (f64, ErrorBar);

/// Draws errors over processor time: `work-precision` of all quantities, `work-precision-QUANTITY` of each, and
/// `ladders`, what each ladder alone leaves; as SVG and PNG. A picture that would show nothing is left out.
///
/// # Errors
/// A folder that cannot be written.
pub(super) fn write_pictures(dir: &OutputDir, report: &Report) -> Result<(), Error> {
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

/// A curve of `points`, those of them left open that are not known.
fn add(label: &str, style: Style, points: Vec<Point>, series: &mut Vec<Series>, doubts: &mut Vec<Doubt>) {
    let open = points.iter().filter(|(_, e)| !e.is_known());
    doubts.extend(open.map(|(x, e)| Doubt { series: label.to_owned(), x: *x, y: e.error, most: e.most() }));
    let points = points.iter().map(|(t, e)| (*t, e.error)).collect();
    series.push(Series { label: label.to_owned(), points, style });
}

/// The largest error of `quantities` over time: ladders and joint runs as lines, other ways as dots.
fn work_precision(report: &Report, what: &str, quantities: &[usize]) -> LinePlot {
    let estimate = |row: &Row| Some((row.result.as_ref().ok()?.total(), row.worst_of(quantities)?));
    let point = |row: &Row| estimate(row).map(|(t, e)| (t, e.error));
    let (mut all, mut doubts) = (Vec::new(), Vec::new());
    for ladder in &report.ladders {
        let row = |rung: &Rung| report.row_of(&ladder.axis, &rung.level);
        let points = ladder.levels.iter().filter_map(row).filter_map(estimate).collect();
        add(&format!("{} alone", ladder.axis), Style::Joined, points, &mut all, &mut doubts);
    }
    let mut some = |label: &str, style: Style, of: &dyn Fn(&Row) -> bool| {
        let points = report.rows.iter().filter(|row| of(row)).filter_map(estimate).collect();
        add(label, style, points, &mut all, &mut doubts);
    };
    some("all ladders together", Style::Joined, &|row| row.axis == TOGETHER);
    for (axis, label) in OF_THEIR_OWN {
        some(label, Style::Dots, &|row| row.axis == axis);
    }
    let other = |row: &&Row| {
        let own = OF_THEIR_OWN.iter().any(|(axis, _)| row.axis == *axis) || row.level.setting.is_empty();
        row.kind == AxisKind::Ways && !own
    };
    let mut names: Vec<&str> = report.rows.iter().filter(other).map(|row| row.axis.as_str()).collect();
    names.dedup();
    some(&format!("other {}", names.join(", ")), Style::Dots, &|row| other(&row));

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
    plot::work_precision(&report.title, what, all, doubts, &front, &named)
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
        Some((record.total(), rung.worst(&sure)?))
    };
    let (mut all, mut doubts) = (Vec::new(), Vec::new());
    for ladder in &report.ladders {
        let points = ladder.levels.iter().filter_map(|rung| point(&ladder.axis, rung)).collect();
        add(&ladder.axis, Style::Joined, points, &mut all, &mut doubts);
    }
    plot::work_precision(&report.title, &format!("{what}, each ladder alone"), all, doubts, &[], &[])
}
