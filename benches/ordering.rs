//! Entries and work of the factor in the order of nested dissection and in that of minimum degree on the unknowns, by faer:
//! `cargo bench --bench ordering`.
//!
//! Three plates, each in 1 to 16 layers of cells, with their supports: case 1 of the report, a plate twice as long as wide, and
//! one whose cells grow from the impact. Entries are those of a factor without zeros; `stored` is what ours keeps, zeros of its
//! dense fronts included. Of the times to order the least of three counts.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use faer::Side;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{CholeskySymbolicParams, SymmetricOrdering, factorize_symbolic_cholesky};
use fem::core::assembly::{Pattern, Symbolic, elimination_order, pattern};
use fem::io::scene;
use fem::{Model, Registry};
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// The example whose plate, mesh and supports are replaced.
const EXAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/as4-3502-16ply-50mm/scene.toml");

const LONG: &[(&str, &str)] = &[
    ("{ file = \"plate.msh\", unit = \"mm\" }", "{ rectangle = [\"100 mm\", \"50 mm\"], cells = [28, 14] }"),
    ("symmetry = \"half-turn\"", ""),
    ("group = \"support\"", "group = \"x-min\""),
    ("{ group = \"impact\" }", "{ x = \"50 mm\", y = \"25 mm\" }"),
];
const GRADED: &[(&str, &str)] = &[
    (
        "{ file = \"plate.msh\", unit = \"mm\" }",
        "{ plate = { sides = [\"100 mm\", \"80 mm\"], size = \"1.5 mm\", edge_size = \"8 mm\" } }",
    ),
    ("symmetry = \"half-turn\"", ""),
    ("group = \"support\"", "group = \"edge\""),
];

fn main() {
    println!("| plate | layers | unknowns | entries, millions | stored | by AMD | GFLOP | by AMD | order, s |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for (name, edits) in [("case 1", &[][..]), ("2 : 1", LONG), ("graded", GRADED)] {
        for layers in [1, 2, 4, 8, 16] {
            row(name, edits, layers);
        }
    }
}

fn row(name: &str, edits: &[(&str, &str)], layers: usize) {
    let mut text = std::fs::read_to_string(EXAMPLE).unwrap();
    let thickness = format!("layers = {:?}", vec![16 / layers; layers]);
    let bottom = ("at = \"mid-plane\"", if layers == 1 { "at = \"bottom\"" } else { "at = \"mid-plane\"" });
    for (from, to) in edits.iter().copied().chain([("layers = [8, 8]", thickness.as_str()), bottom]) {
        assert!(text.contains(from), "no `{from}`");
        text = text.replace(from, to);
    }
    let model = Model::new(scene::parse(&text, Path::new(EXAMPLE)).unwrap(), &Registry::standard()).unwrap();
    let order = least(|| elimination_order(&model.plate));
    let pattern = Arc::new(pattern(&model.plate, &model.constraints));
    let n = pattern.ndof();
    let own: Vec<usize> = (0..n).collect();
    let ([entries, flops], [amd, amd_flops]) = (
        counts(&pattern, SymmetricOrdering::Custom(PermRef::new_checked(&own, &own, n))),
        counts(&pattern, SymmetricOrdering::Amd),
    );
    let stored = Symbolic::new(pattern).unwrap().entries();
    println!(
        "| {name} | {layers} | {n} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} | {order:.4} |",
        entries * 1e-6,
        stored as f64 * 1e-6,
        amd * 1e-6,
        flops * 1e-9,
        amd_flops * 1e-9
    );
}

/// Entries of the factor without zeros, and additions and multiplications that make it.
fn counts(pattern: &Pattern, order: SymmetricOrdering<'_, usize>) -> [f64; 2] {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
        ..Default::default()
    };
    let symbolic = factorize_symbolic_cholesky(pattern.symbolic(), Side::Lower, order, params).unwrap();
    let faer::sparse::linalg::cholesky::SymbolicCholeskyRaw::Simplicial(raw) = symbolic.raw() else { unreachable!() };
    let columns = raw.col_ptr().windows(2).map(|pair| (pair[1] - pair[0]) as f64);
    columns.fold([0.0; 2], |[entries, flops], count| [entries + count, flops + count * count])
}

fn least<T>(mut work: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    };
    (0..3).map(once).fold(f64::INFINITY, f64::min)
}
