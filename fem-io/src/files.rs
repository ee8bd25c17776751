//! The folder of a run's results.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use tracing::info;

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
    /// A file of the user's where one of a run's would go.
    #[error(
        "`{}` was not written by a run into this folder and would be overwritten: choose another folder",
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

const LOCK: &str = ".lock";
const PARTIAL: &str = ".partial";

/// A folder that one run at a time writes into; every file in it appears whole or not at all.
///
/// The folder is locked until the value is dropped or the process ends, however it ends. The file `.lock` that carries the
/// lock stays behind: removing it could free the folder for two later runs at once. It holds the names of what runs have
/// left in the folder, so that a later one can take away what it replaces ([`OutputDir::remove_older`]) and nothing else.
#[derive(Debug)]
pub struct OutputDir {
    path: PathBuf,
    lock: File,
    /// What earlier runs have left.
    earlier: BTreeSet<String>,
    /// What was written since.
    written: RefCell<BTreeSet<String>>,
}

impl OutputDir {
    /// Makes the folder with its parents, locks it and removes partial files that a killed run left there.
    ///
    /// # Errors
    /// A path that is a file, a folder that may not be made or written, another run in the folder.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        let made = if path.exists() && !path.is_dir() {
            Err(io::ErrorKind::NotADirectory.into())
        } else {
            fs::create_dir_all(&path)
        };
        made.map_err(failed("create the folder", &path))?;

        let lock_path = path.join(LOCK);
        let lock = File::options()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .open(&lock_path)
            .map_err(failed("create", &lock_path))?;
        lock.try_lock().map_err(|e| match e {
            TryLockError::WouldBlock => FileError::Locked { path: path.clone() },
            TryLockError::Error(cause) => failed("lock", &lock_path)(cause),
        })?;

        for entry in fs::read_dir(&path).map_err(failed("read the folder", &path))? {
            let entry = entry.map_err(failed("read the folder", &path))?;
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if name.starts_with('.') && name.ends_with(PARTIAL) {
                fs::remove_file(entry.path()).map_err(failed("remove", &entry.path()))?;
            }
        }
        // What is not a list of names tells of no files.
        let names = io::read_to_string(&lock).unwrap_or_default();
        let earlier = names.lines().filter(|name| is_plain(name)).map(str::to_owned).collect();
        Ok(Self { path, lock, earlier, written: RefCell::default() })
    }

    /// Removes what earlier runs have left and this one has not written again: it would be taken for a result of this one.
    ///
    /// # Errors
    /// A file that cannot be removed, a full disk.
    pub fn remove_older(&self) -> Result<(), FileError> {
        let written = self.written.borrow();
        for name in self.earlier.difference(&written) {
            let path = self.path.join(name);
            match fs::remove_file(&path) {
                Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(failed("remove", &path)(cause)),
                _ => {}
            }
        }
        self.write_names(&written)
    }

    /// Leaves word of what was written, for a run that supersedes it.
    ///
    /// # Errors
    /// A full disk.
    pub fn add(&self) -> Result<(), FileError> {
        self.write_names(&(&self.earlier | &*self.written.borrow()))
    }

    fn write_names(&self, names: &BTreeSet<String>) -> Result<(), FileError> {
        let text: String = names.iter().flat_map(|name| [name, "\n"]).collect();
        let write = |mut lock: &File| {
            lock.rewind()?;
            lock.set_len(0)?;
            lock.write_all(text.as_bytes())
        };
        write(&self.lock).map_err(failed("write", &self.path.join(LOCK)))
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the file `name` by `fill`, replacing an older one.
    ///
    /// The content goes to a partial file beside it, which takes the name only once it is complete and on disk.
    ///
    /// # Errors
    /// A name with a folder in it or a leading dot; whatever `fill` or the system reports, e.g. a full disk. The
    /// partial file is removed and an older file of that name is untouched.
    pub fn write(&self, name: &str, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
        self.place(name, fill, File::sync_all)
    }

    /// As [`OutputDir::write`], without waiting for the disk: a process that is killed leaves the file whole or not
    /// at all, a machine that loses its power may not. For files of which there are many.
    ///
    /// # Errors
    /// As [`OutputDir::write`].
    pub fn write_unsynced(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), FileError> {
        self.place(name, fill, |_| Ok(()))
    }

    fn place(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        settle: impl FnOnce(&File) -> io::Result<()>,
    ) -> Result<(), FileError> {
        if !is_plain(name) {
            return Err(FileError::Name { name: name.to_owned() });
        }
        let whole = self.path.join(name);
        let partial = self.path.join(format!(".{name}{PARTIAL}"));
        let file = File::create_new(&partial).map_err(failed("write", &whole))?;
        let mut out = BufWriter::new(file);
        let settled = || {
            fill(&mut out)?;
            out.flush()?;
            settle(out.get_ref())?;
            out.get_ref().metadata().map(|about| about.len())
        };
        let bytes = settled().and_then(|bytes| fs::rename(&partial, &whole).map(|()| bytes));
        let bytes = bytes.map_err(|cause| {
            // The first error is the one to report; a partial file that cannot be removed goes at the next run.
            let _ = fs::remove_file(&partial);
            failed("write", &whole)(cause)
        })?;
        self.written.borrow_mut().insert(name.to_owned());
        info!(file = %whole.display(), bytes, "written");
        Ok(())
    }
}

/// Whether a name has no folder in it and no leading dot.
fn is_plain(name: &str) -> bool {
    Path::new(name).file_name().is_some_and(|n| n == name) && !name.starts_with('.')
}

pub(crate) fn failed(action: &'static str, path: &Path) -> impl Fn(io::Error) -> FileError {
    move |cause| FileError::Io { action, path: path.to_owned(), cause }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_appears_whole_and_replaces_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputDir::create(folder.path().join("a/b")).unwrap();
        let partial = out.path().join(".x.csv.partial");
        for text in ["first", "second"] {
            out.write("x.csv", |w| {
                assert!(partial.exists());
                w.write_all(text.as_bytes())
            })
            .unwrap();
            assert_eq!(fs::read_to_string(out.path().join("x.csv")).unwrap(), text);
        }
        assert_eq!(names(out.path()), [".lock", "x.csv"]);
    }

    #[test]
    fn a_failed_write_keeps_the_old_file_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputDir::create(folder.path()).unwrap();
        out.write("x.csv", |w| w.write_all(b"old")).unwrap();
        let error = out
            .write("x.csv", |w| {
                w.write_all(b"half")?;
                Err(io::ErrorKind::StorageFull.into())
            })
            .unwrap_err()
            .to_string();
        assert!(error.contains("x.csv") && error.contains("free some space"), "{error}");
        assert_eq!(fs::read_to_string(folder.path().join("x.csv")).unwrap(), "old");
        assert_eq!(names(folder.path()), [".lock", "x.csv"]);
    }

    #[test]
    fn one_run_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let first = OutputDir::create(folder.path()).unwrap();
        assert!(matches!(OutputDir::create(folder.path()), Err(FileError::Locked { .. })));
        drop(first);
        OutputDir::create(folder.path()).unwrap();
    }

    #[test]
    fn partial_files_of_a_killed_run_go_and_other_files_stay() {
        let folder = tempfile::tempdir().unwrap();
        for name in [".history.csv.partial", "mine.partial", "history.csv"] {
            fs::write(folder.path().join(name), "x").unwrap();
        }
        let _out = OutputDir::create(folder.path()).unwrap();
        assert_eq!(names(folder.path()), [".lock", "history.csv", "mine.partial"]);
    }

    #[test]
    fn a_run_supersedes_what_earlier_ones_have_left_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let run = |files: &[&str]| {
            let out = OutputDir::create(folder.path()).unwrap();
            files.iter().for_each(|name| out.write(name, |_| Ok(())).unwrap());
            out
        };
        fs::write(folder.path().join("mine.txt"), "x").unwrap();
        run(&["a.csv", "b.svg"]).remove_older().unwrap();
        run(&["page.html"]).add().unwrap();
        assert_eq!(names(folder.path()), [".lock", "a.csv", "b.svg", "mine.txt", "page.html"]);
        // One that is stopped takes nothing away.
        drop(run(&["c.bin"]));
        assert_eq!(names(folder.path()).len(), 6);
        run(&["a.csv", "c.bin"]).remove_older().unwrap();
        assert_eq!(names(folder.path()), [".lock", "a.csv", "c.bin", "mine.txt"]);
        // Names that lead elsewhere are none.
        let outside = tempfile::NamedTempFile::new().unwrap();
        fs::write(folder.path().join(".lock"), format!("{}\n../x\n", outside.path().display())).unwrap();
        run(&["a.csv"]).remove_older().unwrap();
        assert!(outside.path().exists());
    }

    #[test]
    fn a_file_in_the_way_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("taken");
        fs::write(&file, "").unwrap();
        for path in [file.clone(), file.join("below")] {
            let error = OutputDir::create(&path).unwrap_err().to_string();
            assert!(error.contains(&*path.to_string_lossy()) && error.contains("choose a folder"), "{error}");
        }
    }

    #[test]
    fn names_stay_inside_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputDir::create(folder.path()).unwrap();
        for name in ["", ".", "..", "../x", "a/b", "/x", "x/", ".lock"] {
            assert!(matches!(out.write(name, |_| Ok(())), Err(FileError::Name { .. })), "{name}");
        }
        assert_eq!(names(folder.path()), [".lock"]);
    }
}
