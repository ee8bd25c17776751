//! Many cases as a page.

use crate::error::Error;
use crate::output::report::standalone;
use fem_io::files::OutputDir;
use fem_io::tables::TableValue;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The page of a sweep or a map.
const PAGE: &str = "report.html";
/// Most cases of a page, which holds all of them at once, and cases beyond which a sweep keeps no histories.
pub(crate) const MOST: usize = 2000;

/// Cases as a page shows them.
pub(crate) struct CasesPage<'a> {
    pub(crate) title: &'a str,
    pub(crate) columns: &'a [String],
    /// A line for each case.
    pub(crate) rows: Vec<Vec<TableValue<'a>>>,
    /// Of each its force over time, N and s; none where it is not known.
    pub(crate) histories: Vec<&'a [[f32; 2]]>,
    /// How many of the columns after the first are numbers that vary.
    pub(crate) varied: usize,
    /// Pictures as SVG.
    pub(crate) pictures: Vec<String>,
}

impl CasesPage<'_> {
    /// Writes [`PAGE`]: the pictures, a chart of any columns, the force of the case that is pointed at, the table, which sorts. Of more
    /// than [`MOST`] cases there is none.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub(crate) fn write(&self, dir: &OutputDir) -> Result<(), Error> {
        if self.rows.len() > MOST || self.rows.is_empty() {
            return Ok(());
        }
        let value = |value: &TableValue<'_>| match value {
            TableValue::Number(number) => json!(number),
            TableValue::Index(index) if index.is_finite() => json!(index),
            TableValue::Index(_) => json!("inf"),
            TableValue::Count(count) => json!(count),
            TableValue::Text(text) => json!(text),
        };
        let rows: Vec<Value> = self.rows.iter().map(|row| row.iter().map(value).collect()).collect();
        let data = json!({
            "columns": self.columns, "rows": rows, "histories": self.histories, "varied": self.varied,
        });
        let mut body = include_str!("page.html").to_owned();
        for picture in &self.pictures {
            let _ = writeln!(body, "<figure><div class=\"drawing\">{picture}</div></figure>");
        }
        body.push_str("<div class=\"scroll\" tabindex=\"0\"><table id=\"table\"></table></div>\n");
        let page = standalone(self.title, &body, include_str!("page.js"), &data);
        Ok(dir.write(PAGE, |out| out.write_all(page.as_bytes()))?)
    }
}
