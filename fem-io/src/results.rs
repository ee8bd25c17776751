//! Results that an earlier run has left, read back.

use crate::bytes::{self, Links, ReadError};
use crate::files::{FileError, unread};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::io::ErrorKind;
use std::path::Path;

/// Largest file that is read: more is not a result of a run.
const MAX_BYTES: u64 = 1 << 28;

/// Largest document without a type, and most fields of a table: in memory they are many times as long.
const MAX_DOCUMENT: usize = 1 << 24;
const MAX_FIELDS: usize = 1 << 24;

/// A table as it stands in its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows of as many fields.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// The values of a column, if all of them are finite numbers; else number (from 1) and text of the row that is none.
    ///
    /// # Errors
    /// A field that is not a finite number.
    pub fn numbers(&self, column: usize) -> Result<Vec<f64>, (usize, String)> {
        let number = |(i, row): (usize, &Vec<String>)| {
            let value = row[column].parse::<f64>().ok().filter(|v| v.is_finite());
            value.ok_or_else(|| (i + 1, row[column].clone()))
        };
        self.rows.iter().enumerate().map(number).collect()
    }
}

/// The bytes of a file; `None` where there is none. No link is followed: results may come from anyone.
///
/// # Errors
/// A file that cannot be read, is none or is too long.
pub fn read_bytes(path: &Path) -> Result<Option<Vec<u8>>, FileError> {
    match bytes::read(path, MAX_BYTES, Links::Refuse) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(ReadError::Io(cause)) if cause.kind() == ErrorKind::NotFound => Ok(None),
        Err(why) => Err(unread(path)(why)),
    }
}

/// The text of a file; `None` where there is none.
///
/// # Errors
/// As [`read_bytes`], and text that is not UTF-8.
pub fn read_text(path: &Path) -> Result<Option<String>, FileError> {
    let Some(bytes) = read_bytes(path)? else { return Ok(None) };
    String::from_utf8(bytes).map(Some).map_err(|_| damaged(path, "it is not text".into()))
}

/// Version of the format of results: JSON files say it as `format`, and the tables beside them are of the same. It grows when a
/// key or a column goes or changes its meaning, not when one comes.
pub const FORMAT: u32 = 1;

/// The content of a JSON file; `None` where there is none.
///
/// # Errors
/// As [`read_text`], and JSON that is cut off or not of this kind.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, FileError> {
    let Some(text) = read_text(path)? else { return Ok(None) };
    serde_json::from_str(&text).map(Some).map_err(|why| damaged(path, why.to_string()))
}

/// As [`read_json`], of a document whose form is not known: it is no longer than a summary.
///
/// # Errors
/// As [`read_json`].
pub fn read_document(path: &Path) -> Result<Option<Value>, FileError> {
    let text = read_text(path)?;
    if text.as_ref().is_some_and(|text| text.len() > MAX_DOCUMENT) {
        return Err(damaged(path, format!("it is longer than {MAX_DOCUMENT} bytes")));
    }
    let parsed = text.map(|text| serde_json::from_str(&text)).transpose();
    parsed.map_err(|why| damaged(path, why.to_string()))
}

/// A CSV table; `None` where there is none.
///
/// # Errors
/// As [`read_text`], rows that are not as long as the header, more fields than any run writes.
pub fn read_table(path: &Path) -> Result<Option<Table>, FileError> {
    let Some(text) = read_text(path)? else { return Ok(None) };
    if text.bytes().filter(|byte| b",\n".contains(byte)).count() > MAX_FIELDS {
        return Err(damaged(path, format!("it has more than {MAX_FIELDS} fields")));
    }
    let no_table = |why: csv::Error| damaged(path, why.to_string());
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let fields = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
    let header = fields(reader.headers().map_err(no_table)?);
    if header.is_empty() || !text.ends_with('\n') {
        return Err(damaged(path, "it ends before its last line does".into()));
    }
    let rows = reader.records().map(|record| record.map(|record| fields(&record))).collect::<Result<_, _>>();
    Ok(Some(Table { header, rows: rows.map_err(no_table)? }))
}

/// The error that says what is wrong with a file.
pub fn damaged(path: &Path, why: String) -> FileError {
    FileError::Damaged { path: path.to_owned(), why }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_cut_off_is_refused_and_what_is_not_there_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        assert_eq!(read_table(&path).unwrap(), None);
        std::fs::write(&path, "a,b\n1,x\n2.5,y\n").unwrap();
        let table = read_table(&path).unwrap().unwrap();
        assert_eq!((table.header.join(" "), table.numbers(0)), ("a b".into(), Ok(vec![1.0, 2.5])));
        assert_eq!(table.numbers(1), Err((1, "x".to_owned())));
        for (text, words) in
            [("a,b\n1\n", "record 1"), ("a,b\n1,2", "before its last line"), ("", "before its last line")]
        {
            std::fs::write(&path, text).unwrap();
            let error = read_table(&path).unwrap_err().to_string();
            assert!(error.contains("t.csv` is damaged") && error.contains(words), "{error}");
        }
        std::fs::write(&path, "{\"a\": 1").unwrap();
        let error = read_json::<serde_json::Value>(&path).unwrap_err().to_string();
        assert!(error.contains("damaged") && error.contains("EOF"), "{error}");
        // What takes many times its length in memory.
        std::fs::write(&path, ",".repeat(MAX_FIELDS) + "\n").unwrap();
        assert!(read_table(&path).unwrap_err().to_string().contains("more than 16777216 fields"));
        std::fs::write(&path, format!("[{}0]", "0,".repeat(MAX_DOCUMENT / 2))).unwrap();
        assert!(read_document(&path).unwrap_err().to_string().contains("longer than"));
        std::fs::write(&path, [0xff, 0xfe]).unwrap();
        assert!(read_text(&path).unwrap_err().to_string().contains("it is not text"));
    }
}
