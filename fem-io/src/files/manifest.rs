//! What runs have written into a folder, by names and contents.
//!
//! ```text
//! fem-files 1
//! 5d6f2c0a 1204 history.csv
//! run
//! 91b8e7f3 1350 history.csv
//! ```
//!
//! A file is entered once its content is on the disk and before it takes its name, so that at any moment each file of this
//! program in the folder is entered, and a file whose content is not entered is somebody else's. What stands after the last
//! `run` is of the run that wrote last. Entries are appended; what a kill has cut off has no end of line and counts for
//! nothing, for the file that it would have named does not exist yet.

use super::error::{FileError, failed, unread};
use crate::bytes::{self, Links, ReadError};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

const NAME: &str = "manifest";
const HEADER: &str = "fem-files 1";
const RUN: &str = "run";

/// Longest list that is read.
const MAX_BYTES: u64 = 1 << 28;

/// Length and CRC-32 of a file's content.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Mark {
    bytes: u64,
    crc: u32,
}

impl Mark {
    /// Of the file `path`.
    pub(super) fn of(path: &Path) -> Result<Self, ReadError> {
        let mut file = bytes::open(path, Links::Refuse)?;
        let (mut content, mut buffer) = (Marked::new(io::sink()), [0; 1 << 16]);
        loop {
            match file.read(&mut buffer)? {
                0 => return Ok(content.mark()),
                read => content.write_all(&buffer[..read])?,
            }
        }
    }
}

/// A writer that marks what goes through it.
pub(super) struct Marked<W> {
    inner: W,
    bytes: u64,
    crc: crc32fast::Hasher,
}

impl<W> Marked<W> {
    pub(super) fn new(inner: W) -> Self {
        Self { inner, bytes: 0, crc: crc32fast::Hasher::new() }
    }

    pub(super) fn inner(&self) -> &W {
        &self.inner
    }

    pub(super) fn mark(&self) -> Mark {
        Mark { bytes: self.bytes, crc: self.crc.clone().finalize() }
    }
}

impl<W: io::Write> io::Write for Marked<W> {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        let taken = self.inner.write(buffer)?;
        self.crc.update(&buffer[..taken]);
        self.bytes += taken as u64;
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// The contents that a file of each name may have.
type Entries = BTreeMap<String, BTreeSet<Mark>>;

/// What is entered, before the last run and since.
#[derive(Debug, Default)]
struct Entered {
    earlier: Entries,
    current: Entries,
}

impl Entered {
    /// `None` where the text is not one of ours.
    fn parse(text: &str) -> Option<Self> {
        let mut lines = text.split_inclusive('\n').filter_map(|line| line.strip_suffix('\n'));
        if lines.next() != Some(HEADER) {
            return None;
        }
        let mut entered = Self::default();
        for line in lines {
            if line == RUN {
                entered.begin();
            } else if let Some((name, mark)) = entry(line) {
                entered.current.entry(name.to_owned()).or_default().insert(mark);
            }
        }
        Some(entered)
    }

    fn begin(&mut self) {
        for (name, marks) in std::mem::take(&mut self.current) {
            self.earlier.entry(name).or_default().extend(marks);
        }
    }

    fn text(&self) -> String {
        let lines = |entries: &Entries| {
            let each = |(name, marks): (&String, &BTreeSet<Mark>)| {
                marks.iter().map(|mark| line(name, *mark)).collect::<String>()
            };
            entries.iter().map(each).collect::<String>()
        };
        format!("{HEADER}\n{}{RUN}\n{}", lines(&self.earlier), lines(&self.current))
    }

    /// The contents that the file of that name may have.
    fn marks(&self, name: &str) -> impl Iterator<Item = &Mark> {
        [&self.earlier, &self.current].into_iter().filter_map(move |entries| entries.get(name)).flatten()
    }

    /// Names of the files of earlier runs that the last one has not written again.
    fn superseded(&self) -> impl Iterator<Item = &String> {
        self.earlier.keys().filter(|name| !self.current.contains_key(*name))
    }

    /// Forgets files that are gone, and contents of another length than those that are there.
    fn forget_what_is_gone(&mut self, folder: &Path) {
        for entries in [&mut self.earlier, &mut self.current] {
            entries.retain(|name, marks| {
                let Ok(there) = folder.join(name).symlink_metadata() else { return false };
                let left: BTreeSet<Mark> = marks.iter().filter(|mark| mark.bytes == there.len()).copied().collect();
                // A file that was changed still is one of its run.
                if !left.is_empty() {
                    *marks = left;
                }
                true
            });
        }
    }
}

fn line(name: &str, mark: Mark) -> String {
    format!("{:08x} {} {name}\n", mark.crc, mark.bytes)
}

fn entry(line: &str) -> Option<(&str, Mark)> {
    let mut words = line.splitn(3, ' ');
    let crc = u32::from_str_radix(words.next()?, 16).ok()?;
    let bytes = words.next()?.parse().ok()?;
    let name = words.next().filter(|name| super::is_plain(name))?;
    Some((name, Mark { bytes, crc }))
}

/// The list of a folder that is written into.
#[derive(Debug)]
pub(super) struct Manifest {
    path: PathBuf,
    file: File,
    entered: RefCell<Entered>,
    /// Whether the next entry is the first one of a run.
    begins: Cell<bool>,
}

impl Manifest {
    /// The list in `keeping`, of the files in `folder`; an empty one where there is none.
    pub(super) fn open(folder: &Path, keeping: &Path) -> Result<Self, FileError> {
        let mut entered = read(keeping)?.unwrap_or_default();
        entered.forget_what_is_gone(folder);
        let path = keeping.join(NAME);
        let partial = keeping.join(format!("{NAME}.partial"));
        let write = || {
            let mut file = File::create_new(&partial)?;
            file.write_all(entered.text().as_bytes())?;
            file.sync_all()?;
            fs::rename(&partial, &path)?;
            Ok(file)
        };
        let file = write().map_err(|cause| {
            // The first error is the one to report; what is left goes at the next run.
            let _ = fs::remove_file(&partial);
            failed("write", &path)(cause)
        })?;
        Ok(Self { path, file, entered: RefCell::new(entered), begins: Cell::new(false) })
    }

    /// Whatever is entered from now on is of another run than what was before.
    pub(super) fn begin_run(&self) {
        self.begins.set(true);
    }

    /// Enters a file; `lasting` where that must be on the disk.
    pub(super) fn enter(&self, name: &str, mark: Mark, lasting: bool) -> Result<(), FileError> {
        let begins = self.begins.get();
        let text = format!("{}{}", if begins { "run\n" } else { "" }, line(name, mark));
        let append = |mut file: &File| {
            let length = file.metadata()?.len();
            let written =
                file.write_all(text.as_bytes()).and_then(|()| if lasting { file.sync_data() } else { Ok(()) });
            // Half an entry would spoil the next one.
            written.inspect_err(|_| drop(file.set_len(length)))
        };
        append(&self.file).map_err(failed("write", &self.path))?;
        let mut entered = self.entered.borrow_mut();
        if begins {
            entered.begin();
            self.begins.set(false);
        }
        entered.current.entry(name.to_owned()).or_default().insert(mark);
        Ok(())
    }

    /// Whether the file `path` of that name is one that was written into the folder.
    pub(super) fn wrote(&self, name: &str, path: &Path) -> bool {
        let entered = self.entered.borrow();
        // What has another length need not be read, however long it is.
        let Ok(bytes) = path.symlink_metadata().map(|is| is.len()) else { return false };
        entered.marks(name).any(|mark| mark.bytes == bytes)
            && Mark::of(path).is_ok_and(|mark| entered.marks(name).any(|known| *known == mark))
    }

    /// Names of the files of earlier runs that the present one has not written again.
    pub(super) fn superseded(&self) -> Vec<String> {
        self.entered.borrow().superseded().cloned().collect()
    }
}

/// The list in `keeping`; `None` where there is none.
fn read(keeping: &Path) -> Result<Option<Entered>, FileError> {
    let path = keeping.join(NAME);
    match bytes::read(&path, MAX_BYTES, Links::Refuse) {
        Ok(bytes) => Ok(Entered::parse(&String::from_utf8_lossy(&bytes))),
        Err(ReadError::Io(cause)) if cause.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(why) => Err(unread(&path)(why)),
    }
}

/// Names of the files of earlier runs that the last one has not written again; `None` where there is no list.
pub(super) fn superseded(keeping: &Path) -> Result<Option<BTreeSet<String>>, FileError> {
    Ok(read(keeping)?.map(|entered| entered.superseded().cloned().collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_cut_off_or_not_ours_counts_for_nothing() {
        let whole = "fem-files 1\n0000000a 1 a.csv\nrun\n0000000b 2 b c.csv\n";
        let entered = Entered::parse(whole).unwrap();
        assert_eq!(entered.text(), whole);
        assert_eq!(entered.marks("b c.csv").collect::<Vec<_>>(), [&Mark { bytes: 2, crc: 11 }]);
        assert_eq!(entered.superseded().collect::<Vec<_>>(), ["a.csv"]);
        // Cut anywhere, no name is another one than it was.
        for length in 0..whole.len() {
            let Some(entered) = Entered::parse(&whole[..length]) else {
                assert!(length < 12, "{length}");
                continue;
            };
            assert!(
                entered.current.keys().chain(entered.earlier.keys()).all(|name| whole.contains(&format!(" {name}\n")))
            );
        }
        let outside = "fem-files 1\n0000000a 1 ../a\n0000000a 1 /etc/x\n0000000a 1 .bashrc\nnotes.txt\n";
        assert!(Entered::parse(outside).unwrap().current.is_empty());
        assert!(Entered::parse("notes.txt\n").is_none());
    }
}
