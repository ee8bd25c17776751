//! What can go wrong with the files of a run.

use crate::bytes::ReadError;
use std::io;
use std::path::{Path, PathBuf};

/// Why results cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system refused.
    #[error("cannot {action} `{}`: {cause}{}", path.display(), remedy(cause))]
    Io {
        /// What was tried.
        action: &'static str,
        /// On which file or folder.
        path: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
    /// Another run writes into the folder.
    #[error("another run is writing into `{}`: wait for it to end or choose another folder", path.display())]
    Locked {
        /// The folder.
        path: PathBuf,
    },
    /// A file that is not as it was written.
    #[error("`{}` is damaged: {why}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What was seen.
        why: String,
    },
    /// A link, a pipe, a device or a folder where a run leaves a file.
    #[error("`{}` is {what}, which no run leaves there: remove it, or choose another folder", path.display())]
    NotAFile {
        /// Where.
        path: PathBuf,
        /// What it is.
        what: &'static str,
    },
    /// A folder with other files than those of runs.
    #[error(
        "`{}` holds `{file}`, which is not of this program and would be overwritten or taken for a result: choose another \
         folder",
        path.display()
    )]
    Foreign {
        /// The folder.
        path: PathBuf,
        /// A file in it.
        file: String,
    },
    /// A file of the user's where one of a run's would go.
    #[error(
        "`{}` was not written by a run into this folder, or was changed since, and would be overwritten: rename it or \
         choose another folder",
        path.display()
    )]
    Taken {
        /// The file.
        path: PathBuf,
    },
    /// A name that leads out of the folder or clashes with its bookkeeping.
    #[error("`{name}` cannot name a result file: use a plain file name that does not begin with a dot")]
    Name {
        /// The name.
        name: String,
    },
    /// NaN or infinity in a table.
    #[error("{file}, row {row}, column {column}: {value} is not a finite number")]
    NonFinite {
        /// Name of the table.
        file: String,
        /// Row, counted from 1 without the header.
        row: usize,
        /// Column.
        column: String,
        /// The value.
        value: f64,
    },
    /// NaN, infinity or an absent value in a JSON file.
    #[error(
        "{file}, `{key}`: not a finite number; a value that is absent on purpose must be left out, not written as null"
    )]
    Null {
        /// Name of the file.
        file: String,
        /// Path to the value, keys and indices separated by dots.
        key: String,
    },
    /// A type that JSON cannot hold.
    #[error("{file}: {cause}")]
    Json {
        /// Name of the file.
        file: String,
        /// What serde_json says.
        cause: serde_json::Error,
    },
}

fn remedy(cause: &io::Error) -> &'static str {
    match cause.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => ": free some space or choose another folder",
        io::ErrorKind::FileTooLarge => ": lift the limit on the size of files (`ulimit -f`) or choose another folder",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => ": choose a folder that you may write",
        io::ErrorKind::NotADirectory => ": choose a folder, not a file",
        _ => "",
    }
}

pub(crate) fn failed(action: &'static str, path: &Path) -> impl Fn(io::Error) -> FileError {
    move |cause| FileError::Io { action, path: path.to_owned(), cause }
}

/// The error that says why the file `path` is not read.
pub(crate) fn unread(path: &Path) -> impl Fn(ReadError) -> FileError {
    move |why| match why {
        ReadError::Io(cause) => failed("read", path)(cause),
        ReadError::NotAFile(what) => FileError::NotAFile { path: path.to_owned(), what },
        ReadError::TooLong(_) => FileError::Damaged { path: path.to_owned(), why: why.to_string() },
    }
}
