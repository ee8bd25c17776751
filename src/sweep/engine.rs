//! Schedulers that run the parts of a sweep on other machines.
//!
//! None of them is told more than a command line to run so many times, each with a number: what is done and what is missing the
//! folders of the parts say.

use crate::error::Error;
use std::io::{BufRead, BufReader, ErrorKind};
use std::ops::ControlFlow;
use std::path::Path;
use std::process::{Command, Stdio};

/// A scheduler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Engine {
    /// Slurm, by an array of jobs.
    Slurm,
    /// HyperQueue, by an array of tasks.
    HyperQueue,
}

impl Engine {
    /// All, by the names that the command line uses.
    pub const ALL: [(&'static str, Self); 2] = [("slurm", Self::Slurm), ("hyperqueue", Self::HyperQueue)];

    /// The variable that says its number to each.
    pub fn number(self) -> &'static str {
        match self {
            Self::Slurm => "SLURM_ARRAY_TASK_ID",
            Self::HyperQueue => "HQ_TASK_ID",
        }
    }

    /// Runs `line`, a command line of a shell, once for each of `numbers`, with further `options` of the scheduler, and waits for all of them;
    /// what they say goes to files in `folder`. What becomes of each is for the caller to see. `follow` is heard now and then, and may
    /// break the array off.
    ///
    /// # Errors
    /// A scheduler that is not installed, or takes no jobs.
    pub fn run(
        self,
        line: &str,
        numbers: &[usize],
        options: &[String],
        folder: &Path,
        follow: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<(), Error> {
        let refused = |why: String, help: &str| Error::Sweep { message: why, help: help.to_owned() };
        let mut command = self.submission(line, numbers, options, folder);
        let program = command.get_program().to_string_lossy().into_owned();
        let mut child =
            command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().map_err(|why| match why.kind() {
                ErrorKind::NotFound => refused(format!("there is no `{program}` on this machine"), self.remedy()),
                _ => refused(format!("`{program}` cannot be started: {why}"), self.remedy()),
            })?;
        // The scheduler names the array at once, and ends when all of it has.
        let mut name = String::new();
        if let Some(out) = child.stdout.take() {
            let _ = BufReader::new(out).read_line(&mut name);
        }
        let name = name.split([';', '\n']).next().unwrap_or_default().trim().to_owned();
        let mut broken = false;
        let status = loop {
            match child.try_wait() {
                Ok(Some(status)) => break status,
                Err(why) => {
                    return Err(refused(format!("`{program}` is lost: {why}"), "gather what is there: --gather"));
                }
                Ok(None) => std::thread::sleep(super::PATIENCE),
            }
            if !broken && follow().is_break() {
                broken = true;
                self.cancel(&name);
            }
        };
        // A part whose cases failed has the same status as one that was lost, but no array is there without a name.
        match name.is_empty() {
            true => Err(refused(format!("`{program}` took no jobs: {status}"), "see what it said above")),
            false => Ok(()),
        }
    }

    fn submission(self, line: &str, numbers: &[usize], options: &[String], folder: &Path) -> Command {
        let numbers = numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(",");
        let log = |mark: &str| folder.join(format!("{}{mark}.log", super::PART)).display().to_string();
        match self {
            Self::Slurm => {
                let mut command = Command::new("sbatch");
                command.args(["--wait", "--parsable", "--job-name=fem-sweep", "--requeue", "--open-mode=append"]);
                command.arg(format!("--array={numbers}")).arg(format!("--output={}", log("%a")));
                command.args(options).arg("--wrap").arg(line);
                command
            }
            Self::HyperQueue => {
                let mut command = Command::new("hq");
                command.args(["--output-mode", "quiet", "submit", "--wait", "--name", "fem-sweep"]);
                command.args(["--array", &numbers, "--stdout", &log("%{TASK_ID}"), "--stderr", &log("%{TASK_ID}")]);
                command.args(options).args(["--", "sh", "-c", line]);
                command
            }
        }
    }

    /// Takes an array back; one that has ended meanwhile has nothing to take.
    fn cancel(self, name: &str) {
        let words: &[&str] = match self {
            Self::Slurm => &["scancel", name],
            Self::HyperQueue => &["hq", "job", "cancel", name],
        };
        let _ = Command::new(words[0]).args(&words[1..]).stdout(Stdio::null()).status();
    }

    fn remedy(self) -> &'static str {
        match self {
            Self::Slurm => {
                "install Slurm's commands (on Debian `apt install slurm-client`), or run the sweep where jobs are submitted"
            }
            Self::HyperQueue => {
                "put `hq` of https://github.com/It4innovations/hyperqueue/releases on the path, and start `hq server start` and a worker"
            }
        }
    }
}
