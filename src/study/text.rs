//! A study as people read it.

use super::axes::AxisKind;
use super::converge::{Convergence, ErrorBar};
use super::ladder::Ladder;
use super::plan::StudyPlan;
use super::quantity::FORCE_HISTORY;
use super::record::RunRecord;
use super::report::{Report, Row};
use fem_core::plugin::Dimension;
use std::fmt::{self, Write as _};

/// Characters of a refusal that a table shows.
const WORDS: usize = 72;

/// Levels of an axis beyond which the first and the last stand for all.
const MANY: usize = 8;

/// Errors for which the cheapest run is named.
const TARGETS: [f64; 4] = [0.1, 0.01, 1e-3, 1e-4];

/// What will be run, before it is run.
impl fmt::Display for StudyPlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "  will run, about {} of processor time:", Dimension::TIME.of(self.seconds()))?;
        let mut axes: Vec<&str> = self.runs.iter().map(|run| run.axis.as_str()).collect();
        axes.dedup();
        for axis in axes {
            let runs: Vec<_> = self.runs.iter().filter(|run| run.axis == axis).collect();
            let seconds: f64 = runs.iter().map(|run| run.seconds).sum();
            let labels: Vec<&str> = runs.iter().map(|run| run.level.label.as_str()).collect();
            let labels = match labels[..] {
                [first, .., last] if labels.len() > MANY => format!("{} from {first} to {last}", labels.len()),
                _ => labels.join(", "),
            };
            writeln!(f, "    {axis:<14} {labels} ({})", Dimension::TIME.of(seconds))?;
        }
        if self.further > 0.0 {
            let further = "the next level of the ladder that leaves most a second; then levels of all ladders together";
            writeln!(f, "    {:<14} {further} (up to {})", "further", Dimension::TIME.of(self.further))?;
        }
        let spare: Vec<_> =
            self.spare.iter().map(|run| (run.axis.clone(), run.level.label.clone(), String::new())).collect();
        for (axis, labels, _) in group_by_axis(&spare) {
            writeln!(f, "    if time allows {axis}: {labels}")?;
        }
        for (axis, labels, why) in group_by_axis(&self.left_out) {
            writeln!(f, "    left out       {axis}: {labels}: {why}")?;
        }
        Ok(())
    }
}

/// What was left out, the levels of an axis for one reason together.
fn group_by_axis(left_out: &[(String, String, String)]) -> Vec<(&str, String, String)> {
    let mut groups: Vec<(&str, Vec<&str>, &str)> = Vec::new();
    for (axis, label, why) in left_out {
        match groups.iter_mut().find(|group| group.0 == axis && group.2 == why) {
            Some(group) => group.1.push(label),
            None => groups.push((axis, vec![label], why)),
        }
    }
    let shown = |labels: Vec<&str>| match labels[..] {
        [first, .., last] if labels.len() > MANY => format!("{} from {first} to {last}", labels.len()),
        _ => labels.join(", "),
    };
    groups.into_iter().map(|(axis, labels, why)| (axis, shown(labels), why.chars().take(WORDS).collect())).collect()
}

fn percent(x: f64) -> String {
    match x {
        x if x >= 0.01 => format!("{:.0} %", x * 100.0),
        x => format!("{} %", x * 100.0),
    }
}

/// What a study found, in Markdown: where the error of the scene comes from, the cheapest run for an error, and what is changed by runs
/// that count from the scene as it is.
pub fn text(report: &Report) -> String {
    let mut t = String::new();
    // Writing to a text cannot fail.
    let _ = summary(report, &mut t);
    for kind in kinds(report, true) {
        let _ = table(report, kind, &mut t);
    }
    t
}

/// Every other run of a study, in Markdown.
pub(super) fn tables(report: &Report) -> String {
    let mut t = String::new();
    for kind in kinds(report, false) {
        let _ = table(report, kind, &mut t);
    }
    t
}

/// Kinds of runs that are said at once, which all others follow: those that count from the scene as it is.
fn kinds(report: &Report, at_once: bool) -> impl Iterator<Item = AxisKind> {
    let all = [AxisKind::Ladder, AxisKind::Ways, AxisKind::Problems];
    all.into_iter().filter(move |kind| counts_from_scene(report, *kind) == at_once)
}

/// Whether runs of `kind` are held against the scene as it is: other problems, and all where no ladder was climbed.
fn counts_from_scene(report: &Report, kind: AxisKind) -> bool {
    kind == AxisKind::Problems || report.ladders.is_empty()
}

fn summary(report: &Report, t: &mut String) -> fmt::Result {
    let Ok(base) = &report.base().result else { return Ok(()) };
    let ran: f64 = report.made().filter_map(|row| row.result.as_ref().ok()).map(|record| record.total()).sum();
    let reference = &report.rows[report.reference.row];
    writeln!(t, "{}: what accuracy costs\n", report.title)?;
    writeln!(
        t,
        "* {} runs in {} of processor time; the scene as it is takes {}",
        report.made().count(),
        Dimension::TIME.of(ran),
        Dimension::TIME.of(base.total())
    )?;
    if report.reference.row > 0 {
        writeln!(t, "* errors are measured against: {}, extrapolated along each ladder", describe(reference))?;
        let agreement = report.reference.agreement.iter().flatten().copied().reduce(f64::max);
        let verdict = if report.is_proven() { "proven" } else { "NOT proven" };
        match agreement {
            Some(worst) => writeln!(
                t,
                "* reference {verdict}: a level coarser along every ladder changes it by at most {worst:.1e} (asked: {:.1e})",
                report.tolerance
            )?,
            None => writeln!(t, "* reference NOT proven: none is a level coarser along every ladder")?,
        }
    } else {
        writeln!(t, "* no ladder was climbed: what is shown are differences from the scene as it is")?;
    }

    if !report.ladders.is_empty() {
        where_errors_come_from(report, t)?;
    }
    where_time_went(report, t)?;
    if !report.ladders.is_empty() {
        cheapest_runs(report, t)?;
    }

    if !report.notes.is_empty() {
        writeln!(t)?;
    }
    report.notes.iter().try_for_each(|note| writeln!(t, "* note: {note}"))
}

/// The error of the scene as it is, and what each ladder leaves of it.
fn where_errors_come_from(report: &Report, t: &mut String) -> fmt::Result {
    writeln!(t, "\nError of the scene as it is, and where it comes from\n")?;
    let names: Vec<&str> = report.ladders.iter().map(|ladder| ladder.axis.as_str()).collect();
    writeln!(t, "| quantity | error | left in the reference | {} |", names.join(" | "))?;
    writeln!(t, "| --- | --- | --- |{}", " --- |".repeat(names.len()))?;
    for (q, quantity) in report.asked.iter().enumerate() {
        let error = report.base().errors.get(q).copied().flatten();
        let parts: Vec<String> = report.ladders.iter().map(|ladder| format_share(ladder, quantity)).collect();
        let left = figure(report.reference.left.get(q).copied());
        writeln!(t, "| {quantity} | {} | {left} | {} |", figure(error), parts.join(" | "))?;
    }
    Ok(())
}

/// The cheapest run for each of the errors that are named.
fn cheapest_runs(report: &Report, t: &mut String) -> fmt::Result {
    writeln!(t, "\nThe cheapest run for an error\n")?;
    let mut previous = String::new();
    for (quantities, name) in goals(report) {
        for target in TARGETS {
            let Some(row) = report.cheapest(&quantities, target) else { continue };
            let Ok(record) = &row.result else { continue };
            let error = figure(row.worst_of(&quantities));
            let line = format!("{}: {} ({error})", describe(row), Dimension::TIME.of(record.total()));
            if line != previous {
                writeln!(t, "* {} of {name}: {line}", percent(target))?;
            }
            previous = line;
        }
    }
    Ok(())
}

/// Runs and seconds of every axis, what a ladder leaves at its finest level, and why it ends there.
fn where_time_went(report: &Report, t: &mut String) -> fmt::Result {
    writeln!(t, "\nWhere the time went\n")?;
    writeln!(t, "| axis | runs | time | its finest level leaves | not run |")?;
    writeln!(t, "| --- | --- | --- | --- | --- |")?;
    let mut axes: Vec<&str> = Vec::new();
    for row in report.made() {
        if !axes.contains(&row.axis.as_str()) {
            axes.push(&row.axis);
        }
    }
    for axis in axes {
        let each = || report.made().filter(|row| row.axis == axis);
        let time: f64 = each().filter_map(|row| row.result.as_ref().ok()).map(|record| record.total()).sum();
        let ladder = report.ladder(axis);
        let leaves = ladder.and_then(Ladder::leaves).map_or_else(String::new, |limit| {
            let left = match limit.convergence {
                Convergence::Stalls { difference } => ErrorBar { error: difference, bar: f64::INFINITY },
                other => ErrorBar { error: other.left(), bar: other.bar() },
            };
            format!("{} of {}", figure(Some(left)), limit.quantity)
        });
        let end: String = ladder.map_or("", |ladder| &ladder.end).chars().take(2 * WORDS).collect();
        writeln!(t, "| {axis} | {} | {} | {leaves} | {end} |", each().count(), Dimension::TIME.of(time))?;
    }
    Ok(())
}

/// Every quantity by itself, and all together where there are several.
fn goals(report: &Report) -> Vec<(Vec<usize>, &str)> {
    let mut goals: Vec<(Vec<usize>, &str)> =
        report.asked.iter().enumerate().map(|(q, name)| (vec![q], name.as_str())).collect();
    if report.asked.len() > 1 {
        goals.push(((0..report.asked.len()).collect(), "all quantities"));
    }
    goals
}

/// What a ladder leaves of a quantity at the scene's own level, with its order, or with what would have to be run to know it.
fn format_share(ladder: &Ladder, quantity: &str) -> String {
    let own = ladder.levels.iter().find(|rung| rung.level.setting.is_empty());
    let error = own.and_then(|rung| rung.errors.iter().find(|e| e.0 == quantity)).map(|e| e.1);
    let convergence = ladder.limits.iter().find(|limit| limit.quantity == quantity).map(|limit| limit.convergence);
    let next = || match ladder.end.split_once(':') {
        Some((level, _)) => format!("next: {level}"),
        None => ladder.end.clone(),
    };
    let how = match convergence {
        Some(Convergence::Converges { order, .. }) => format!(", order {order:.1}"),
        Some(Convergence::Stalls { .. }) => format!(", no convergence; {}", next()),
        Some(Convergence::Unknown { .. }) => format!(", order unknown; {}", next()),
        _ => String::new(),
    };
    format!("{}{how}", figure(error))
}

/// An error, and what it may be where that is not known to a third.
fn figure(error: Option<ErrorBar>) -> String {
    match error.filter(|e| e.error.is_finite()) {
        None => "-".to_owned(),
        Some(e) if e.is_known() => format!("{:.1e}", e.error),
        Some(e) if e.bar.is_finite() => format!("{:.1e} to {:.0e}", e.error, e.most()),
        Some(e) => format!("{:.1e} or more", e.error),
    }
}

fn short_percent(x: f64) -> String {
    match x.abs() {
        0.0 => "0 %".to_owned(),
        ..1e-3 => format!("{:.0e} %", 100.0 * x),
        _ => format!("{:.1} %", 100.0 * x),
    }
}

/// What a run changes of the quantity `name`, over that of the scene as it is; of a history the L2 norm of the difference.
fn change(report: &Report, record: &RunRecord, name: &str) -> String {
    let Ok(base) = &report.base().result else { return "-".to_owned() };
    match record.difference(base, name) {
        None => "-".to_owned(),
        Some(change) if change > 0.0 && name != FORCE_HISTORY => format!("+{}", short_percent(change)),
        Some(change) => short_percent(change),
    }
}

/// The settings of a run that cost.
fn describe(row: &Row) -> String {
    let Ok(record) = &row.result else { return row.level.label.clone() };
    let size = &record.size;
    let mut words = vec![format!("cells {}", Dimension::LENGTH.of(size.cell_m))];
    words.push(if size.layers == 1 { "1 layer".into() } else { format!("{} layers", size.layers) });
    if size.step_s > 0.0 {
        words.push(format!("{} unknowns marched", size.marched));
        words.push(format!("step {}", Dimension::TIME.of(size.step_s)));
    }
    if row.kind != AxisKind::Ladder && !row.level.setting.is_empty() {
        words.push(row.level.label.clone());
    }
    words.join(", ")
}

fn table(report: &Report, kind: AxisKind, t: &mut String) -> fmt::Result {
    let rows = || report.rows.iter().filter(move |row| row.kind == kind);
    // The scene as it is, alone, would be held against itself.
    if rows().all(|row| row.level.setting.is_empty()) {
        return Ok(());
    }
    let heading = match kind {
        AxisKind::Ladder => "Ladders",
        AxisKind::Ways => "Other ways",
        AxisKind::Problems => "Other problems: what they change of the scene as it is, which is no error",
    };
    let from_scene = counts_from_scene(report, kind);
    let own = match kind {
        _ if from_scene => "change",
        AxisKind::Ladder => "of its axis",
        _ => "against its judge",
    };
    let each: Vec<&str> = report.asked.iter().map(String::as_str).collect();
    writeln!(t, "\n{heading}\n")?;
    writeln!(t, "| axis | setting | unknowns | {} | worst, {own} | time, s |", each.join(" | "))?;
    writeln!(t, "| --- | --- | --- |{} --- | --- |", " --- |".repeat(each.len()))?;
    for row in rows() {
        let (axis, label) = (&row.axis, &row.level.label);
        let Ok(record) = &row.result else {
            let why = row.result.as_ref().err().map_or("", String::as_str);
            let why: String = why.chars().take(WORDS).collect();
            writeln!(t, "| {axis} | {label} | | {why} |{} | |", " |".repeat(each.len().saturating_sub(1)))?;
            continue;
        };
        let worst = row.own_worst();
        let (each, worst): (Vec<String>, _) = if from_scene {
            let worst = worst.map_or_else(|| "-".to_owned(), |worst| short_percent(worst.error));
            (report.asked.iter().map(|name| change(report, record, name)).collect(), worst)
        } else {
            (row.errors.iter().map(|error| figure(*error)).collect(), figure(worst))
        };
        let unknowns = match record.size.marched {
            0 => record.size.unknowns.to_string(),
            marched => format!("{}, {marched}", record.size.unknowns),
        };
        let best = if row.front && !from_scene { " *" } else { "" };
        writeln!(
            t,
            "| {axis} | {label}{best} | {unknowns} | {} | {} | {:.3} |",
            each.join(" | "),
            worst,
            record.total()
        )?;
    }
    Ok(())
}
