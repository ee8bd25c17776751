//! Hard cases: each with a bound, measured, and shown in `docs/stability.md`.
//!
//! The tests run as any others do. `UPDATE_STABILITY=1 cargo test --release --test stability -- --include-ignored`
//! writes the table anew.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stderr)]

mod algebra;
mod case;
mod failure;
mod growth;
mod guards;
mod input;
mod plates;
#[path = "../registry.rs"]
mod registry;
mod resources;
#[path = "../validation/scene.rs"]
#[allow(dead_code, reason = "the other test binary needs the rest")]
mod scene;
mod space;
#[path = "../support.rs"]
#[allow(dead_code, reason = "the other test binary needs the rest")]
mod support;
mod table;
mod time;

use case::{Case, Measured};
use libtest_mimic::{Arguments, Trial};
use std::process::ExitCode;
use std::sync::{Arc, Mutex};

fn main() -> ExitCode {
    let rooms = [
        time::cases(),
        guards::cases(),
        space::cases(),
        algebra::cases(),
        failure::cases(),
        growth::cases(),
        resources::cases(),
        input::cases(),
    ];
    let cases: Vec<Case> = rooms.into_iter().flatten().collect();
    let all: Arc<Mutex<Vec<Measured>>> = Arc::default();
    let trial = |case: &Case| {
        let (case, all) = (*case, all.clone());
        Trial::test(case.title(), move || {
            let measured = case.measure();
            let verdict = case.verdict(&measured);
            all.lock().unwrap().push(measured);
            verdict.map_err(Into::into)
        })
        .with_ignored_flag(case.long)
    };
    let conclusion = libtest_mimic::run(&Arguments::from_args(), cases.iter().map(trial).collect());
    if conclusion.has_failed() {
        return conclusion.exit_code();
    }
    let measured = all.lock().unwrap();
    match table::compare(&cases, &measured) {
        Ok(()) => ExitCode::SUCCESS,
        Err(differences) => {
            eprintln!("{differences}");
            ExitCode::FAILURE
        }
    }
}
