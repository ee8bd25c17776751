//! Decks of LAMCEL, LAMSUB and TRADYR against the results of an independent interpreter (`tests/data/decks`).

mod blown;
mod case1;
mod malformed;
mod mutated;
mod project;
mod tiling;

use crate::support::root;
use fem::decks::{self, DeckOptions, Project};
use fem::io::deck::{DeckSource, Program};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What of the tables is asked for, of the largest value of a column or of a deck.
const MATRICES: f64 = 1e-9;
const HISTORY: f64 = 1e-7;
const STRESSES: f64 = 1e-8;

pub(crate) fn folder(example: &str) -> PathBuf {
    root().join("tests/data/decks").join(example)
}

pub(crate) fn program(name: &str) -> Program {
    match name {
        "lamcel" => Program::Lamcel,
        "lamsub" => Program::Lamsub,
        _ => Program::Tradyr,
    }
}

/// Runs a deck in the project of `results`.
pub(crate) fn run(deck: &Path, program: Program, results: &Path) -> Result<decks::DeckOutcome, fem::Error> {
    decks::run(&DeckSource::read(deck)?, program, &mut Project::open(results)?, &DeckOptions::default())
}

/// A table: its header and rows by key columns.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let text = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
        Self {
            header: text(reader.headers().unwrap()),
            rows: reader.records().map(|record| text(&record.unwrap())).collect(),
        }
    }

    fn column(&self, name: &str) -> usize {
        self.header
            .iter()
            .position(|column| column == name)
            .unwrap_or_else(|| panic!("no column {name}: {:?}", self.header))
    }

    fn by(&self, keys: &[&str]) -> BTreeMap<Vec<String>, &Vec<String>> {
        let columns: Vec<usize> = keys.iter().map(|key| self.column(key)).collect();
        self.rows.iter().map(|row| (columns.iter().map(|c| row[*c].clone()).collect(), row)).collect()
    }
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("`{text}` is no number"))
}

/// Largest difference of the columns of `want` from those of `got`, of the largest value of the column, or of all of `values`
/// where `together`; rows are found by `keys`.
fn compare(got: &Table, want: &Table, keys: &[&str], together: bool, most: f64, what: &str) {
    let rows = got.by(keys);
    let values: Vec<usize> = (0..want.header.len()).filter(|c| !keys.contains(&want.header[*c].as_str())).collect();
    let pairs = |c: usize| {
        let own = got.column(&want.header[c]);
        let rows = &rows;
        want.by(keys)
            .into_iter()
            .filter(move |(_, row)| !row[c].is_empty())
            .map(move |(key, row)| {
                let found = rows.get(&key).unwrap_or_else(|| panic!("{what}: no row {key:?}"));
                (number(&found[own]), number(&row[c]))
            })
            .collect::<Vec<_>>()
    };
    let size = |pairs: &[(f64, f64)]| pairs.iter().fold(0.0_f64, |m, (_, want)| m.max(want.abs()));
    let all: Vec<_> = values.iter().map(|c| (&want.header[*c], pairs(*c))).collect();
    let largest = all.iter().fold(0.0_f64, |m, (_, pairs)| m.max(size(pairs)));
    for (column, pairs) in &all {
        let scale = if together { largest } else { size(pairs) };
        let worst = pairs.iter().fold(0.0_f64, |m, (got, want)| m.max((got - want).abs()));
        assert!(worst <= most * scale, "{what}, {column}: off by {:.2e} of {scale:.3e}", worst / scale);
    }
}

/// Runs all decks of an example and compares whatever is expected of them.
fn example(name: &str) -> TempDir {
    let results = tempfile::tempdir().unwrap();
    let folder = folder(name);
    let expected: Value =
        serde_json::from_slice(&std::fs::read(folder.join("expected/expected.json")).unwrap()).unwrap();
    for (order, facts) in expected["order"].as_array().unwrap().iter().zip(expected["decks"].as_array().unwrap()) {
        let (program_name, deck) = (order[0].as_str().unwrap(), order[1].as_str().unwrap());
        let outcome = run(&folder.join(deck), program(program_name), results.path())
            .unwrap_or_else(|error| panic!("{name}/{deck}: {error}"));
        let counts: BTreeMap<_, _> = outcome.counts.iter().copied().collect();
        for (what, count) in facts["counts"].as_object().into_iter().flatten() {
            let what = what.replace('_', " ");
            assert_eq!(counts.get(what.as_str()).copied(), count.as_u64().map(|n| n as usize), "{name}/{deck}: {what}");
        }
        let stem = deck.strip_suffix(".dat").unwrap();
        let (want, got) = (folder.join("expected"), results.path());
        let tables = |kind: &str| {
            let file = format!("{stem}.{kind}.csv");
            want.join(&file).exists().then(|| (Table::read(&got.join(&file)), Table::read(&want.join(&file))))
        };
        for kind in ["matrices", "governors"] {
            if let Some((got, want)) = tables(kind) {
                compare_matrices(&got, &want, &format!("{name}/{deck} {kind}"));
            }
        }
        if let Some((got, want)) = tables("history") {
            let motion = Table::read(&results.path().join(format!("{stem}.motion.csv")));
            compare_history(&got, &motion, &want, facts, &format!("{name}/{deck} history"));
        }
        if let Some((got, want)) = tables("displacements") {
            compare(
                &got,
                &want,
                &["ndisp", "nsubs", "node", "dir"],
                true,
                STRESSES,
                &format!("{name}/{deck} displacements"),
            );
        }
        if let Some((got, want)) = tables("stress") {
            assert_eq!(got.rows.len(), want.rows.len(), "{name}/{deck}");
            for quantity in ["stress", "strain"] {
                let only = |table: &Table| {
                    let at = table.column("quantity");
                    let rows = table.rows.iter().filter(|row| row[at] == quantity).cloned().collect();
                    Table { header: table.header.clone(), rows }
                };
                let keys = ["ndisp", "nsubs", "element", "where", "which", "axes", "quantity"];
                compare(&only(&got), &only(&want), &keys, true, STRESSES, &format!("{name}/{deck} {quantity}"));
            }
        }
        if let Some((got, want)) = tables("failure") {
            assert_eq!(got.rows.len(), want.rows.len(), "{name}/{deck}");
            let keys = ["ndisp", "nsubs", "element", "where", "which"];
            compare(&got, &want, &keys, true, STRESSES, &format!("{name}/{deck} failure"));
        }
    }
    results
}

/// The lower triangle, or full rows where the table has them.
fn compare_matrices(got: &Table, want: &Table, what: &str) {
    let lower = |table: &Table| -> BTreeMap<(usize, usize), [f64; 2]> {
        let entry = |row: &Vec<String>| {
            let (i, j): (usize, usize) = (row[0].parse().unwrap(), row[1].parse().unwrap());
            ((i.max(j), i.min(j)), [number(&row[2]), number(&row[3])])
        };
        table.rows.iter().map(entry).collect()
    };
    let (got, want) = (lower(got), lower(want));
    for which in 0..2 {
        let size = want.values().fold(0.0_f64, |m, entry| m.max(entry[which].abs()));
        for (at, entry) in &want {
            let off = (got[at][which] - entry[which]).abs() / size;
            assert!(off <= MATRICES, "{what}, {} {at:?}: off by {off:.2e}", ["K", "M"][which]);
        }
    }
}

/// Impactor and contact from the history, all other columns (`u 5 U30`) from the motion, node by node.
fn compare_history(got: &Table, motion: &Table, want: &Table, facts: &Value, what: &str) {
    let own: Vec<usize> = (0..want.header.len()).filter(|c| got.header.contains(&want.header[*c])).collect();
    let table = |columns: &[usize]| Table {
        header: columns.iter().map(|c| want.header[*c].clone()).collect(),
        rows: want.rows.iter().map(|row| columns.iter().map(|c| row[*c].clone()).collect()).collect(),
    };
    // The forces of `a` follow the last bits more than those of others.
    let most = if facts["governor_order"].as_array().is_some_and(|g| g.len() == 10 && g[0] == "5 U30") {
        1e-6
    } else {
        HISTORY
    };
    compare(got, &table(&own), &["print_step"], false, most, what);
    let rows = motion.by(&["print_step", "node", "dir"]);
    for c in (0..want.header.len()).filter(|c| !own.contains(c)) {
        let name: Vec<&str> = want.header[c].split(' ').collect();
        let [quantity, node, dir] = name[..] else { panic!("{what}: {name:?}") };
        let at = motion.column(quantity);
        let size = want.rows.iter().fold(0.0_f64, |m, row| m.max(number(&row[c]).abs()));
        for row in &want.rows {
            let key = vec![row[0].clone(), node.to_owned(), dir.to_owned()];
            let off = (number(&rows[&key][at]) - number(&row[c])).abs() / size;
            assert!(off <= most, "{what}, {name:?} at {}: off by {off:.2e}", row[0]);
        }
    }
}

macro_rules! examples {
    ($($test:ident $name:literal)+) => { $(#[test] fn $test() { drop(example($name)); })+ };
}

examples! {
    a_beam "a-beam-plane-strain"
    b_plate_cells "b-plate-cells"
    c1_quarter_plates_coupled "c1-quarter-plates-coupled"
    c2_quarter_plates_equations "c2-quarter-plates-equations"
    d_restart "d-restart"
    f_data_check "f-data-check"
    h_one_dof_a_node "h-one-dof-a-node"
    i_three_dofs_a_node "i-three-dofs-a-node"
    j_turned_axes "j-turned-axes"
    k_other_spelling "k-other-spelling"
    l_integration_order "l-integration-order"
}
