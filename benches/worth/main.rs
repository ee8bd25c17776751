//! What statements of accuracy are worth: errors that runs say of themselves against those to finer runs, the worst first:
//! `cargo bench --bench worth`, with parts of names of examples or settings if not all. A Markdown table.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod scenes;

use scenes::{SCENES, Variant, statements};

/// Errors below this are of no interest.
const SMALL: f64 = 1e-3;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let mut all = Vec::new();
    for (name, variants) in SCENES {
        let chosen = |variant: &&Variant| {
            let whole = format!("{name}, {}", variant.0);
            wanted.is_empty() || wanted.iter().any(|word| whole.contains(word.as_str()))
        };
        let mut known = Vec::new();
        for variant in variants.iter().filter(chosen) {
            all.extend(statements((name, *variant), &mut known));
        }
    }
    let worth = |ratio: Option<f64>| ratio.unwrap_or(0.0);
    all.sort_by(|a, b| worth(a.ratio()).total_cmp(&worth(b.ratio())));
    println!("| scene | result | said | true | said over true |\n| --- | --- | --- | --- | --- |");
    for s in all.iter().filter(|s| s.truth > SMALL) {
        let said = s.said.map_or("nothing".to_owned(), |said| format!("{said:.1e}"));
        let ratio = s.ratio().map_or(String::new(), |ratio| format!("{ratio:.2}"));
        println!("| {} | {} | {said} | {:.1e} | {ratio} |", s.scene, s.result, s.truth);
    }
    let judged: Vec<f64> = all.iter().filter(|s| s.truth > SMALL).filter_map(|s| s.ratio()).collect();
    let count = |least: f64| judged.iter().filter(|ratio| **ratio < least).count();
    println!(
        "\n{} results with errors above {SMALL:.0e}: {} said less than half of them, {} less than a fifth, {} nothing; {} smaller errors",
        judged.len(),
        count(0.5),
        count(0.2),
        all.iter().filter(|s| s.truth > SMALL && s.said.is_none()).count(),
        all.iter().filter(|s| s.truth <= SMALL).count(),
    );
}
