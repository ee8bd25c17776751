//! Reference tables.

use std::collections::BTreeMap;
use std::path::Path;

/// A row by column name; nothing where the table has no number.
pub(super) type Row = BTreeMap<String, f64>;

/// The paths of a table, in rows.
pub(super) fn paths(name: &str) -> BTreeMap<String, Vec<Row>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/damage").join(name);
    let unpacked = flate2::read::GzDecoder::new(std::fs::File::open(file).unwrap());
    let mut paths = BTreeMap::<String, Vec<Row>>::new();
    for row in csv::Reader::from_reader(unpacked).deserialize::<BTreeMap<String, String>>() {
        let row = row.unwrap();
        let numbers = row.iter().filter_map(|(name, text)| Some((name.clone(), text.parse().ok()?)));
        paths.entry(row["path"].clone()).or_default().push(numbers.collect());
    }
    paths
}

/// The numbers of some columns.
pub(super) fn columns<const N: usize>(row: &Row, names: [&str; N]) -> [f64; N] {
    names.map(|name| row[name])
}
