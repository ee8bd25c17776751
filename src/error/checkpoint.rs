//! Why a march or a study cannot continue from what an earlier process has saved.

use fem_io::files::FileError;
use miette::Diagnostic;
use std::path::PathBuf;

/// What wrote a checkpoint. The last number changes with what a state holds and with the numbering of its unknowns.
pub(crate) const WRITER: &str = concat!(env!("CARGO_PKG_VERSION"), "+layout.4");

/// Why a march cannot continue from a checkpoint.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
pub enum CheckpointError {
    /// There is no checkpoint.
    #[error("there is no checkpoint in `{}`", folder.display())]
    #[diagnostic(help("run without `--resume` first, or name the folder of the run with `--out`"))]
    Missing {
        /// The folder.
        folder: PathBuf,
    },
    /// It cannot be read, or is not as it was written.
    #[error(transparent)]
    #[diagnostic(help("run without `--resume`: that starts over and replaces the checkpoint"))]
    File(#[from] FileError),
    /// Another version wrote it.
    #[error("the checkpoint in `{}` was written by version {theirs}, this is version {}", folder.display(), WRITER)]
    #[diagnostic(help("continue with version {theirs}, or run without `--resume` to start over"))]
    Version {
        /// The folder.
        folder: PathBuf,
        /// The version.
        theirs: String,
    },
    /// It belongs to another run.
    #[error("the checkpoint in `{}` belongs to another run: {}", folder.display(), differences.join("; "))]
    #[diagnostic(help(
        "restore what differs, or run without `--resume` to start over; the title, the plots and the end of a march \
         may differ, where no effect that is left to `auto` is decided otherwise for it: name it as the run before did"
    ))]
    Differs {
        /// The folder.
        folder: PathBuf,
        /// What differs, in words.
        differences: Vec<String>,
    },
    /// It lies beyond the end.
    #[error("the checkpoint in `{}` is at {at:e} s, beyond `march.end`", folder.display())]
    #[diagnostic(help("set `march.end` to that time or a later one, or run without `--resume` to start over"))]
    Beyond {
        /// The folder.
        folder: PathBuf,
        /// Its time, s.
        at: f64,
    },
}
