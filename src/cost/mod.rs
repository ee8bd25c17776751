//! What a run costs: time per phase, processor time, memory.

mod attained;
mod memory;

pub(crate) use attained::FURTHER;
pub use attained::{Attained, RaisedPart, Worth};
pub use memory::{forget_peak_memory, peak_memory};
pub(crate) use memory::{how_many_fit, refuse, require};

use cpu_time::ProcessTime;
use fem_core::plugin::Dimension;
use serde::Serialize;
use std::fmt;
use std::num::NonZeroUsize;
use std::time::Instant;
use tracing::{debug, info};

/// What a run cost on its machine, in the process that ended it: all that differs from run to run of one scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct Cost {
    pub format: u32,
    pub threads: usize,
    pub phases: Vec<Phase>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_memory_MB: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub one_level_better: Vec<Better>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy_asked: Option<Attained>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub provenance: Option<Provenance>,
}

/// What it takes to make the run again: the command line, quoted for a shell, the folder it was given in, and the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct Provenance {
    pub command: String,
    pub folder: String,
    pub scene: String,
}

impl Provenance {
    /// Of this process, which computes the scene in the file `scene`.
    pub fn of(scene: &str) -> Self {
        let command: Vec<_> = std::env::args_os().map(|word| quoted(&word.to_string_lossy())).collect();
        let folder = std::env::current_dir().map_or_else(|_| String::new(), |folder| folder.display().to_string());
        Self { command: command.join(" "), folder, scene: scene.to_owned() }
    }
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./=,:+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

impl Cost {
    /// The cost of `phases`, and of the memory so far.
    pub fn new(threads: NonZeroUsize, phases: Vec<Phase>) -> Self {
        for Phase { name, wall_s, cpu_s } in &phases {
            info!(phase = name, wall_s, cpu_s, "done");
        }
        Self {
            format: fem_io::results::FORMAT,
            threads: threads.get(),
            phases,
            peak_memory_MB: peak_memory().map(|b| b as f64 / 1e6),
            one_level_better: Vec::new(),
            accuracy_asked: None,
            provenance: None,
        }
    }
}

/// As people read it.
impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sum = |seconds: fn(&Phase) -> f64| self.phases.iter().map(seconds).sum::<f64>();
        let phases: Vec<String> =
            self.phases.iter().map(|p| format!("{} {}", p.name, Dimension::TIME.of(p.wall_s))).collect();
        let [wall, processor] = [sum(|p| p.wall_s), sum(|p| p.cpu_s)].map(|seconds| Dimension::TIME.of(seconds));
        write!(f, "{wall} wall, {processor} processor: {}", phases.join(", "))?;
        self.peak_memory_MB.map_or(Ok(()), |m| write!(f, "; peak memory {m:.0} MB"))?;
        let better: Vec<String> =
            self.one_level_better.iter().map(|b| format!("{} +{}", b.what, Dimension::TIME.of(b.more_cpu_s))).collect();
        if !better.is_empty() {
            write!(f, "\n  better    would cost: {}", better.join(", "))?;
        }
        self.accuracy_asked.as_ref().map_or(Ok(()), |attained| write!(f, "\n{attained}"))
    }
}

/// A finer setting and its cost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Better {
    /// What is finer.
    pub what: &'static str,
    /// Processor time that it takes in addition, s, as it is expected.
    pub more_cpu_s: f64,
}

/// Cost of one phase of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Phase {
    /// Its name.
    pub name: &'static str,
    /// Wall-clock time, s.
    pub wall_s: f64,
    /// Processor time of all threads, s.
    pub cpu_s: f64,
}

/// A stopwatch that divides a run into phases.
#[derive(Debug)]
pub struct Stopwatch {
    wall: Instant,
    cpu: ProcessTime,
    phases: Vec<Phase>,
}

impl Default for Stopwatch {
    fn default() -> Self {
        Self { wall: Instant::now(), cpu: ProcessTime::now(), phases: Vec::new() }
    }
}

impl Stopwatch {
    /// Ends the present phase; time goes to it if it has been there before.
    pub fn lap(&mut self, name: &'static str) {
        let (wall_s, cpu_s) = (self.wall.elapsed().as_secs_f64(), self.cpu.elapsed().as_secs_f64());
        (self.wall, self.cpu) = (Instant::now(), ProcessTime::now());
        match self.phases.iter_mut().find(|p| p.name == name) {
            Some(phase) => {
                phase.wall_s += wall_s;
                phase.cpu_s += cpu_s;
            }
            None => {
                debug!(phase = name, wall_s, cpu_s, "for the first time");
                self.phases.push(Phase { name, wall_s, cpu_s });
            }
        }
    }

    /// The phases so far.
    pub fn phases(&self) -> &[Phase] {
        &self.phases
    }
}

/// Processor time of this process, s.
pub fn processor_time() -> f64 {
    ProcessTime::now().as_duration().as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_split_or_read_them() {
        let words = ["fem", "--out=a/b.c", "two words", "it's", "$HOME", ""];
        let want = ["fem", "--out=a/b.c", "'two words'", r"'it'\''s'", "'$HOME'", "''"];
        assert_eq!(words.map(quoted), want);
    }
}
