//! Parts of a sweep that a scheduler runs.

use super::super::signals::Signals;
use super::super::{Console, console};
use super::Arguments;
use crate::sweep::{Engine, Sweep};
use fem_io::files::OutputDir;
use miette::{IntoDiagnostic, miette};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;

/// Parts where nobody says how many.
const PARTS: usize = 16;

/// Rounds one after the other that bring nothing, after which no more are asked for.
const MOST_FRUITLESS: usize = 3;

/// Has `engine` run the parts of `sweep` in the folder `whole` until none lacks a case, or rounds bring nothing.
pub(super) fn run(
    engine: Engine,
    sweep: &Sweep<'_>,
    arguments: &Arguments,
    (scene, whole): (&Path, &Path),
    console: &Console,
    signals: &Signals,
) -> miette::Result<()> {
    let count = arguments.parts.unwrap_or(PARTS).min(sweep.design.count);
    // Made, and found to be one for results.
    drop(OutputDir::open(whole).map_err(crate::error::Error::from)?);
    let parts: Vec<Vec<usize>> = (1..=count).map(|k| sweep.part(Some((k, count)))).collect();
    let line = line(engine, arguments, count, scene, whole)?;
    let mut before = sweep.gather(whole)?.len();
    if before > 0 && !arguments.resume {
        let help = "go on with them by `--resume`, or remove them";
        return Err(miette!(help = help, "`{}` holds parts of this sweep already", whole.display()));
    }
    let mut fruitless = 0;
    loop {
        let done: BTreeSet<usize> = sweep.gather(whole)?.iter().map(|row| row.case - 1).collect();
        let lacks = |k: &usize| parts[k - 1].iter().any(|case| !done.contains(case));
        let lacking: Vec<usize> = (1..=count).filter(lacks).collect();
        if lacking.is_empty() {
            return Ok(());
        }
        console.say(arguments.format, || {
            let missing = sweep.design.count - done.len();
            format!("  engine    {missing} cases to do, in {} parts\n", lacking.len())
        });
        engine.run(&line, &lacking, &arguments.engine_option, whole, &mut || match signals.received() {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        })?;
        if signals.received().is_some() {
            return Ok(());
        }
        let after = sweep.gather(whole)?.len();
        fruitless = if after > before { 0 } else { fruitless + 1 };
        before = after;
        if fruitless == MOST_FRUITLESS {
            let logs = whole.join("part-*.log");
            console::tell(&format!("No part comes back with a case: see the files `{}`\n", logs.display()));
            return Ok(());
        }
    }
}

/// The command line of a part, whose number a variable says.
fn line(engine: Engine, arguments: &Arguments, count: usize, scene: &Path, whole: &Path) -> miette::Result<String> {
    let absolute = |path: &Path| std::path::absolute(path).map(|path| path.display().to_string()).into_diagnostic();
    let program = std::env::current_exe().into_diagnostic()?;
    let mut words = vec![absolute(&program)?, "sweep".into(), absolute(scene)?];
    let Arguments { set, design, samples, seed, correlate, threads, .. } = arguments;
    words.extend(set.iter().map(|(key, value)| format!("--set={key}={value}")));
    words.extend(design.iter().map(|design| format!("--design={design}")));
    words.extend(samples.iter().map(|samples| format!("--samples={samples}")));
    words.extend(seed.iter().map(|seed| format!("--seed={seed}")));
    words.extend(correlate.iter().map(|pair| format!("--correlate={pair}")));
    words.extend(threads.iter().map(|threads| format!("--threads={threads}")));
    words.extend(["--resume".into(), format!("--out={}", absolute(whole)?)]);
    let quoted: Vec<String> = words.iter().map(|word| format!("'{}'", word.replace('\'', r"'\''"))).collect();
    Ok(format!("exec {} --part=\"${}/{count}\"", quoted.join(" "), engine.number()))
}
