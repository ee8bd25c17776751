//! A study as a table: for machines and for people.

use super::Row;
use crate::error::Error;
use fem_io::files::OutputDir;
use fem_io::tables::{self, Field};
use std::fmt::Write as _;

const COLUMNS: [&str; 11] = [
    "axis",
    "setting",
    "unknowns_marched",
    "step_s",
    "force_L2_error",
    "force_peak_error",
    "onset_error_s",
    "onsets_unmatched",
    "setup_cpu_s",
    "march_cpu_s",
    "refused",
];

/// Characters of a refusal that a table shows.
const WORDS: usize = 72;

/// Writes study.csv, whole or not at all.
///
/// # Errors
/// A folder that cannot be written.
pub fn write(dir: &OutputDir, rows: &[Row]) -> Result<(), Error> {
    Ok(tables::write_columns(dir, "study.csv", &COLUMNS, rows.iter().map(line))?)
}

fn line(row: &Row) -> Vec<Field<'_>> {
    let head = [Field::Text(row.axis), Field::Text(&row.setting)].into_iter();
    let f = match &row.figures {
        Ok(figures) => figures,
        Err(why) => return head.chain([Field::Text(""); 8]).chain([Field::Text(why)]).collect(),
    };
    let onset = f.onset_error_s.map_or(Field::Text(""), Field::Number);
    let figures = [
        Field::Count(f.unknowns_marched as u64),
        Field::Number(f.step_s),
        Field::Number(f.force_l2_error),
        Field::Number(f.force_peak_error),
        onset,
        Field::Count(f.onsets_unmatched as u64),
        Field::Number(f.setup_cpu_s),
        Field::Number(f.march_cpu_s),
        Field::Text(""),
    ];
    head.chain(figures).collect()
}

/// The table as people read it, in Markdown.
pub fn text(rows: &[Row]) -> String {
    let mut text = String::from(
        "| setting | unknowns | step, us | force, L2 | peak | onsets, us | setup + march, s |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for row in rows {
        let f = match &row.figures {
            Ok(figures) => figures,
            Err(why) => {
                let why: String = why.chars().take(WORDS).collect();
                let _ = writeln!(text, "| {} | | | {why} | | | |", row.setting);
                continue;
            }
        };
        let onset = f.onset_error_s.map_or_else(|| "-".to_owned(), |s| format!("{:.3}", s * 1e6));
        let unmatched =
            if f.onsets_unmatched > 0 { format!(", {} unmatched", f.onsets_unmatched) } else { String::new() };
        let _ = writeln!(
            text,
            "| {} | {} | {:.4} | {:.1e} | {:+.1e} | {onset}{unmatched} | {:.3} + {:.3} |",
            row.setting,
            f.unknowns_marched,
            f.step_s * 1e6,
            f.force_l2_error,
            f.force_peak_error,
            f.setup_cpu_s,
            f.march_cpu_s
        );
    }
    text
}
