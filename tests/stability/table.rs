//! `docs/stability.md`: its table against what was measured.

use crate::case::{Case, Measured, Room};
use crate::support::root;
use std::fmt::Write;
use std::fs;

const FILE: &str = "docs/stability.md";
const HEAD: &str = "| case | varied | measured | bound | worst | seconds |\n| --- | --- | --- | --- | --- | --- |\n";
const BEGIN: &str =
    "<!-- Written by `UPDATE_STABILITY=1 cargo test --release --test stability -- --include-ignored`. -->\n";
const END: &str = "<!-- End of what is written. -->\n";

/// Compares the table with what was measured, or writes it anew. Cases that did not run keep their row.
///
/// When it is written, a figure stays while the measured one rounds to it or to a neighbour, a rounding error within decades, a
/// time within a factor of 4; when it is compared, figures that are no worse stay as well, and times say nothing: no table
/// changes by the noise of a machine.
pub(crate) fn compare(cases: &[Case], measured: &[Measured]) -> Result<(), String> {
    let path = root().join(FILE);
    let text = fs::read_to_string(&path).map_err(|e| format!("{FILE}: {e}"))?;
    let marked = text.split_once(BEGIN).and_then(|(head, rest)| Some((head, rest.split_once(END)?)));
    let Some((head, (old, tail))) = marked else { return Err(format!("{FILE}: no place for the table")) };
    let update = std::env::var_os("UPDATE_STABILITY").is_some();
    let new = table(cases, measured, old, update);
    if new == old {
        return Ok(());
    }
    if update {
        return fs::write(&path, [head, BEGIN, &new, END, tail].concat()).map_err(|e| format!("{FILE}: {e}"));
    }
    let differ = new.lines().filter(|line| !old.contains(line)).collect::<Vec<_>>().join("\n");
    Err(format!("{FILE} is not what was measured; write it anew with UPDATE_STABILITY=1. Now:\n{differ}"))
}

fn table(cases: &[Case], measured: &[Measured], old: &str, update: bool) -> String {
    let mut text = String::new();
    for room in Room::ALL {
        let rows: Vec<_> = cases.iter().filter(|case| case.room == room).collect();
        if rows.is_empty() {
            continue;
        }
        write!(text, "\n## {}\n\n{HEAD}", room.title()).unwrap();
        for case in rows {
            let before = old.lines().map(cells).find(|cells| cells.first() == Some(&case.name));
            let shown = |k: usize| before.as_ref().and_then(|cells| cells.get(k)).copied().unwrap_or_default();
            let (worst, seconds) = match measured.iter().find(|m| m.name == case.name) {
                Some(m) => (
                    if near(shown(4), m.worst, update) { shown(4).to_owned() } else { figure(m.worst) },
                    if close(shown(5), m.seconds) || (!update && before.is_some()) {
                        shown(5).to_owned()
                    } else {
                        time(m.seconds)
                    },
                ),
                None => (shown(4).to_owned(), shown(5).to_owned()),
            };
            let Case { name, varied, measure, bound, .. } = case;
            let bound = if *bound < 1e-2 && *bound > 0.0 { format!("{bound:e}") } else { format!("{bound}") };
            writeln!(text, "| {name} | {varied} | {measure} | {bound} | {worst} | {seconds} |").unwrap();
        }
    }
    text.push('\n');
    text
}

fn cells(line: &str) -> Vec<&str> {
    line.trim_matches('|').split('|').map(str::trim).collect()
}

/// A bound or a worst value: what is rounding error by its decade, the rest with two digits.
fn figure(value: f64) -> String {
    match value {
        v if v.fract() == 0.0 && v < 1e6 => format!("{v}"),
        v if v < ROUNDING => format!("1e{}", v.log10().ceil()),
        v if (1e-2..1e4).contains(&v) => format!("{}", format!("{v:.1e}").parse::<f64>().unwrap()),
        v => format!("{v:.1e}"),
    }
}

/// Values below are rounding errors, of which the decade is all that other machines agree on.
const ROUNDING: f64 = 1e-8;

/// Whether a figure may stay. When the table is compared, a better one is no difference: rounding is not the same everywhere.
fn near(shown: &str, value: f64, update: bool) -> bool {
    let Ok(shown) = shown.parse::<f64>() else { return false };
    let (small, least) = (value < ROUNDING, if update { 0.94 } else { 0.0 });
    let most = if small { 10.0 } else { 1.06 };
    value == shown || (if small && update { 1e-2 } else { least }..=most).contains(&(value / shown))
}

fn time(seconds: f64) -> String {
    if seconds < 0.1 { "< 0.1".into() } else { format!("{}", format!("{seconds:.0e}").parse::<f64>().unwrap()) }
}

fn close(shown: &str, seconds: f64) -> bool {
    match shown.parse::<f64>() {
        Ok(shown) => (0.25..=4.0).contains(&(seconds / shown)),
        Err(_) => shown == "< 0.1" && seconds < 0.4,
    }
}
