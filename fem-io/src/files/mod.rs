//! The folder of a run's results.

mod error;
mod manifest;

pub use error::FileError;
pub(crate) use error::{failed, unread};

use crate::bytes::{self, Links};
use manifest::{Manifest, Mark, Marked};
use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tracing::info;

/// The folder, in a folder of results, in which this program keeps what is not a result.
const KEEPING: &str = ".fem";
const LOCK: &str = "lock";
const PARTIAL: &str = ".partial";

/// A folder that one run at a time writes into; every file in it appears whole or not at all.
///
/// The folder is locked until the value is dropped or the process ends, however it ends. A folder `.fem` in it holds the lock,
/// the files that are not complete yet, and a list of all that was written by names and contents. What is not on that list is
/// somebody else's, and neither replaced nor removed. No link is followed, in the folder or to it from within.
#[derive(Debug)]
pub struct OutputDir {
    path: PathBuf,
    _lock: Lock,
    manifest: Manifest,
}

/// A file that is locked, held and not read.
#[derive(Debug)]
struct Lock(File);

impl Drop for Lock {
    fn drop(&mut self) {
        // Closed alone, it would stay locked as long as a process that another thread is starting has a copy of it.
        let _ = self.0.unlock();
    }
}

impl OutputDir {
    /// Makes the folder with its parents, locks it and removes what a killed run has left half written.
    ///
    /// # Errors
    /// A path that is a file, a folder that may not be made or written, another run in the folder, and
    /// [`FileError::Foreign`]: files that no run has left there, unless runs have left theirs as well. Files whose names begin
    /// with a dot count for nothing.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        if !is_own(&path)
            && let Some(file) = foreign(&path)
        {
            return Err(FileError::Foreign { path, file });
        }
        Self::open(path)
    }

    /// As [`OutputDir::create`], of a folder that may hold files of others: they are left alone.
    ///
    /// # Errors
    /// As [`OutputDir::create`], but for [`FileError::Foreign`].
    pub fn open(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        let made = if path.exists() && !path.is_dir() {
            Err(io::ErrorKind::NotADirectory.into())
        } else {
            fs::create_dir_all(&path)
        };
        made.map_err(failed("create the folder", &path))?;
        let keeping = path.join(KEEPING);
        match fs::create_dir(&keeping) {
            Err(_) if is_folder(&keeping) => {}
            Err(_) if keeping.symlink_metadata().is_ok() => {
                return Err(FileError::NotAFile { path: keeping, what: "a link or a file" });
            }
            made => made.map_err(failed("create the folder", &keeping))?,
        }
        let lock = lock(&path, &keeping.join(LOCK))?;
        for entry in fs::read_dir(&keeping).map_err(failed("read the folder", &keeping))? {
            let entry = entry.map_err(failed("read the folder", &keeping))?;
            if entry.file_name().to_string_lossy().ends_with(PARTIAL) {
                fs::remove_file(entry.path()).map_err(failed("remove", &entry.path()))?;
            }
        }
        let manifest = Manifest::open(&path, &keeping)?;
        Ok(Self { path, _lock: lock, manifest })
    }

    /// The folder `name` in this one, with a lock and a list of its own.
    ///
    /// # Errors
    /// As [`OutputDir::create`], and a link of that name.
    pub fn folder(&self, name: &str) -> Result<Self, FileError> {
        let path = self.path.join(name);
        if path.is_symlink() {
            return Err(FileError::NotAFile { path, what: "a link" });
        }
        Self::create(path)
    }

    /// What is written from now on is of a run that supersedes earlier ones.
    pub fn begin_run(&self) {
        self.manifest.begin_run();
    }

    /// Removes what earlier runs have left and this one has not written again: it would be taken for a result of this one.
    /// What was changed since is not theirs any more and stays.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn remove_older(&self) -> Result<(), FileError> {
        for name in self.manifest.superseded() {
            let path = self.path.join(&name);
            if self.wrote(&name) {
                fs::remove_file(&path).map_err(failed("remove", &path))?;
            }
        }
        Ok(())
    }

    /// Takes a file that an earlier run has left for one of this run, whatever is on the list: for one that says itself what
    /// it is.
    ///
    /// # Errors
    /// A file that cannot be read, a full disk.
    pub fn adopt(&self, name: &str) -> Result<(), FileError> {
        let path = self.path.join(name);
        let mark = Mark::of(&path).map_err(unread(&path))?;
        self.manifest.enter(name, mark, true)
    }

    /// Whether files of these names can be written, for a run that would else have been in vain.
    ///
    /// # Errors
    /// [`FileError::Taken`] for the first one that is there and that no run has left.
    pub fn claim(&self, names: &[&str]) -> Result<(), FileError> {
        let taken = |name: &&&str| self.path.join(name).symlink_metadata().is_ok() && !self.wrote(name);
        match names.iter().find(taken) {
            Some(name) => Err(FileError::Taken { path: self.path.join(name) }),
            None => Ok(()),
        }
    }

    /// Whether the file of that name is as a run has left it.
    fn wrote(&self, name: &str) -> bool {
        self.manifest.wrote(name, &self.path.join(name))
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the file `name` by `fill`, replacing one that a run has left.
    ///
    /// The content goes to a partial file, which takes the name only once it is complete and on disk.
    ///
    /// # Errors
    /// A name with a folder or a control character in it or a leading dot; a file of that name that no run has left; whatever
    /// `fill` or the system reports, e.g. a full disk. The partial file is removed and an older file of that name is
    /// untouched.
    pub fn write(&self, name: &str, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
        self.place(name, fill, true)
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
        self.place(name, fill, false)
    }

    fn place(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        lasting: bool,
    ) -> Result<(), FileError> {
        if !is_plain(name) {
            return Err(FileError::Name { name: name.to_owned() });
        }
        self.claim(&[name])?;
        let whole = self.path.join(name);
        let partial = self.path.join(KEEPING).join(format!("{name}{PARTIAL}"));
        let failed = failed("write", &whole);
        let write = || {
            let mut out = BufWriter::new(Marked::new(File::create_new(&partial)?));
            fill(&mut out)?;
            out.flush()?;
            if lasting {
                out.get_ref().inner().sync_all()?;
            }
            Ok(out.get_ref().mark())
        };
        let written = write().map_err(&failed).and_then(|mark| {
            self.manifest.enter(name, mark, lasting)?;
            fs::rename(&partial, &whole).map_err(&failed)
        });
        written.inspect_err(|_| {
            // The first error is the one to report; a partial file that cannot be removed goes at the next run.
            let _ = fs::remove_file(&partial);
        })?;
        info!(file = %whole.display(), "written");
        Ok(())
    }
}

/// Locks a folder by the file `path` in it.
fn lock(folder: &Path, path: &Path) -> Result<Lock, FileError> {
    let lock = bytes::options(Links::Refuse).create(true).truncate(false).read(true).write(true).open(path);
    let lock = match lock {
        Ok(lock) if lock.metadata().is_ok_and(|is| is.is_file()) => lock,
        Err(cause) if path.symlink_metadata().map_or(true, |is| is.is_file()) => {
            return Err(failed("create", path)(cause));
        }
        _ => return Err(FileError::NotAFile { path: path.to_owned(), what: "a link, a pipe or a folder" }),
    };
    lock.try_lock().map_err(|e| match e {
        TryLockError::WouldBlock => FileError::Locked { path: folder.to_owned() },
        TryLockError::Error(cause) => failed("lock", path)(cause),
    })?;
    Ok(Lock(lock))
}

/// Names of the files in `folder` of runs that a later one supersedes, which has not written them again: it was stopped.
///
/// # Errors
/// A list that cannot be read.
pub fn superseded(folder: &Path) -> Result<BTreeSet<String>, FileError> {
    Ok(manifest::superseded(&folder.join(KEEPING))?.unwrap_or_default())
}

/// Whether runs of this program write into `folder`.
pub fn is_own(folder: &Path) -> bool {
    is_folder(&folder.join(KEEPING)) && matches!(manifest::superseded(&folder.join(KEEPING)), Ok(Some(_)))
}

fn is_folder(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|is| is.is_dir())
}

/// A file of somebody else's.
fn foreign(folder: &Path) -> Option<String> {
    let names = fs::read_dir(folder).ok()?.filter_map(|entry| Some(entry.ok()?.file_name()));
    names.map(|name| name.to_string_lossy().into_owned()).filter(|name| !name.starts_with('.')).min()
}

/// Whether a name has no folder and no control character in it, and no leading dot.
fn is_plain(name: &str) -> bool {
    Path::new(name).file_name().is_some_and(|n| n == name) && !name.starts_with('.') && !name.contains(char::is_control)
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
        let partial = out.path().join(".fem/x.csv.partial");
        for text in ["first", "second"] {
            out.write("x.csv", |w| {
                assert!(partial.exists());
                w.write_all(text.as_bytes())
            })
            .unwrap();
            assert_eq!(fs::read_to_string(out.path().join("x.csv")).unwrap(), text);
        }
        assert_eq!(names(out.path()), [".fem", "x.csv"]);
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
        assert_eq!(names(folder.path()), [".fem", "x.csv"]);
    }

    #[test]
    fn one_run_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let first = OutputDir::create(folder.path()).unwrap();
        assert!(matches!(OutputDir::create(folder.path()), Err(FileError::Locked { .. })));
        drop(first);
        OutputDir::create(folder.path()).unwrap();
    }

    /// As a process has a copy of the lock between its start and its program.
    #[test]
    fn a_folder_is_free_while_somebody_has_a_copy_of_its_lock() {
        let folder = tempfile::tempdir().unwrap();
        let held = OutputDir::create(folder.path()).unwrap();
        let _copy = held._lock.0.try_clone().unwrap();
        drop(held);
        OutputDir::create(folder.path()).unwrap();
    }

    #[test]
    fn partial_files_of_a_killed_run_go_and_other_files_stay() {
        let folder = tempfile::tempdir().unwrap();
        drop(OutputDir::create(folder.path()).unwrap());
        for name in [".my-download.partial", "mine.partial", "history.csv", ".fem/history.csv.partial"] {
            fs::write(folder.path().join(name), "x").unwrap();
        }
        let out = OutputDir::create(folder.path()).unwrap();
        assert_eq!(names(folder.path()), [".fem", ".my-download.partial", "history.csv", "mine.partial"]);
        assert_eq!(names(&folder.path().join(".fem")), ["lock", "manifest"]);
        assert!(matches!(out.write("history.csv", |_| Ok(())), Err(FileError::Taken { .. })));
        assert!(matches!(out.claim(&["absent", "mine.partial"]), Err(FileError::Taken { .. })));
        assert_eq!(fs::read_to_string(folder.path().join("history.csv")).unwrap(), "x");
    }

    #[test]
    fn a_run_supersedes_what_earlier_ones_have_left_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let run = |files: &[&str]| {
            let out = OutputDir::create(folder.path()).unwrap();
            out.begin_run();
            files.iter().for_each(|name| out.write(name, |w| w.write_all(name.as_bytes())).unwrap());
            out
        };
        let older = || superseded(folder.path()).unwrap().into_iter().collect::<Vec<_>>();
        run(&["a.csv", "b.svg", "c.svg"]).remove_older().unwrap();
        fs::write(folder.path().join("mine.txt"), "x").unwrap();
        OutputDir::open(folder.path()).unwrap().write("page.html", |_| Ok(())).unwrap();
        assert_eq!(names(folder.path()), [".fem", "a.csv", "b.svg", "c.svg", "mine.txt", "page.html"]);
        assert_eq!(older(), [""; 0]);
        // One that is stopped takes nothing away, and what it has not written is not of its run.
        drop(run(&["d.bin"]));
        assert_eq!((names(folder.path()).len(), older().join(" ")), (7, "a.csv b.svg c.svg page.html".to_owned()));
        // What the user has changed is the user's.
        fs::write(folder.path().join("c.svg"), "mine").unwrap();
        run(&["a.csv", "d.bin"]).remove_older().unwrap();
        assert_eq!(names(folder.path()), [".fem", "a.csv", "c.svg", "d.bin", "mine.txt"]);
        // What another run has left is taken for one of this by name.
        let out = run(&[]);
        out.adopt("d.bin").unwrap();
        out.remove_older().unwrap();
        assert_eq!(names(folder.path()), [".fem", "c.svg", "d.bin", "mine.txt"]);
    }

    /// A list tells a run which files are its own, and nothing that it may do to others.
    #[test]
    fn a_list_that_lies_does_no_harm() {
        let lists =
            ["notes.txt\n", "fem-files 1\n00000000 1 notes.txt\nrun\n", "fem-files 1\n00000000 4 notes.txt\nrun\n"];
        for list in lists {
            let folder = tempfile::tempdir().unwrap();
            let mine = folder.path().join("notes.txt");
            drop(OutputDir::open(folder.path()).unwrap());
            fs::write(&mine, "mine").unwrap();
            fs::write(folder.path().join(".fem/manifest"), list).unwrap();
            let out = OutputDir::open(folder.path()).unwrap();
            out.begin_run();
            out.write("a.csv", |_| Ok(())).unwrap();
            out.remove_older().unwrap();
            assert!(matches!(out.write("notes.txt", |_| Ok(())), Err(FileError::Taken { .. })), "{list}");
            assert_eq!(fs::read_to_string(&mine).unwrap(), "mine");
        }
    }

    #[test]
    fn a_folder_of_somebody_else_is_refused_and_left_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(".hidden"), "x").unwrap();
        drop(OutputDir::create(folder.path().join("new")).unwrap());
        let error = OutputDir::create(folder.path()).unwrap_err().to_string();
        assert!(error.contains("holds `new`") && error.contains("choose another folder"), "{error}");
        assert_eq!(names(folder.path()), [".hidden", "new"]);
        let out = OutputDir::open(folder.path()).unwrap();
        assert!(out.folder("fields").unwrap().folder("x").is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn no_link_is_followed() {
        use std::os::unix::fs::symlink;
        let outside = tempfile::tempdir().unwrap();
        let precious = outside.path().join("precious");
        fs::write(&precious, "x").unwrap();
        let fresh = || {
            let folder = tempfile::tempdir().unwrap();
            drop(OutputDir::create(folder.path()).unwrap());
            folder
        };
        for name in ["", "/lock", "/manifest"] {
            for kind in 0..3 {
                let folder = fresh();
                let path = folder.path().join(format!(".fem{name}"));
                if path.is_dir() {
                    fs::remove_dir_all(&path).unwrap()
                } else {
                    fs::remove_file(&path).unwrap()
                }
                let target = [outside.path(), &precious, Path::new("/dev/zero")][kind];
                symlink(target, &path).unwrap();
                let error = OutputDir::create(folder.path()).unwrap_err();
                assert!(matches!(error, FileError::NotAFile { .. }), "{name} {kind}: {error}");
            }
        }
        let folder = fresh();
        let out = OutputDir::create(folder.path()).unwrap();
        symlink(outside.path().join("precious"), folder.path().join("a.csv")).unwrap();
        symlink(outside.path().join("absent"), folder.path().join("b.csv")).unwrap();
        symlink(outside.path(), folder.path().join("fields")).unwrap();
        for name in ["a.csv", "b.csv"] {
            assert!(matches!(out.write(name, |_| Ok(())), Err(FileError::Taken { .. })), "{name}");
        }
        assert!(matches!(out.folder("fields"), Err(FileError::NotAFile { .. })));
        assert_eq!(names(outside.path()), ["precious"]);
        assert_eq!(fs::read_to_string(outside.path().join("precious")).unwrap(), "x");
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
        for name in ["", ".", "..", "../x", "a/b", "/x", "x/", ".fem", "a\nb"] {
            assert!(matches!(out.write(name, |_| Ok(())), Err(FileError::Name { .. })), "{name}");
        }
        assert_eq!(names(folder.path()), [".fem"]);
    }
}
