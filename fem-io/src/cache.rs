//! A folder of what is kept for later runs: files under keys that say what they depend on, none of them trusted.

use crate::checkpoint;
use std::collections::VecDeque;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

/// Beginning and end of the name of each file; between them stands its key, 64 hexadecimal digits.
const BEFORE: &str = "plate-";
const AFTER: &str = ".bin";

/// End of the name of a file that is being written, and the time after which nobody writes it any more.
const UNFINISHED: &str = ".unfinished";
const FORGOTTEN: Duration = Duration::from_secs(3600);

/// A folder with a limit of size, beyond which what was not used for longest goes.
///
/// Nothing in it is needed: what cannot be read, or is not what it should be, is removed, and [`Cache::words`] says so. Several processes may
/// use it at a time; files appear whole.
#[derive(Debug, Clone)]
pub struct Cache {
    folder: PathBuf,
    limit: u64,
    words: Arc<Mutex<Vec<String>>>,
}

/// A file that is kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Where it is.
    pub path: PathBuf,
    /// Its size.
    pub bytes: u64,
    /// When it was last used.
    pub used: SystemTime,
}

impl Cache {
    /// The cache in `folder`, which need not be there yet, of at most so many bytes.
    pub fn new(folder: PathBuf, limit: u64) -> Self {
        Self { folder, limit, words: Arc::default() }
    }

    /// Its folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Most bytes that it keeps.
    pub fn limit(&self) -> u64 {
        self.limit
    }

    /// What is kept under `key`; a file that is damaged goes.
    pub fn get(&self, key: &str) -> Option<Vec<u8>> {
        let path = self.path(key);
        path.symlink_metadata().ok()?;
        match checkpoint::read(&path) {
            Ok(payload) => {
                // Its time says when it was used; where that cannot be written the file only goes earlier.
                let _ =
                    std::fs::File::options().append(true).open(&path).and_then(|f| f.set_modified(SystemTime::now()));
                Some(payload)
            }
            Err(why) => {
                self.refuse(key, &why.to_string());
                None
            }
        }
    }

    /// Removes what is kept under `key`, which is not what it should be.
    pub fn refuse(&self, key: &str, why: &str) {
        let path = self.path(key);
        let _ = std::fs::remove_file(&path);
        self.say(format!("`{}` is not used and removed from the cache: {why}", path.display()));
    }

    /// Keeps `payload` under `key`. What cannot be written is left out.
    pub fn put(&self, key: &str, payload: &[u8]) {
        if payload.len() as u64 > self.limit {
            return;
        }
        if let Err(why) = self.write(key, payload) {
            self.say(format!("nothing is kept in the cache `{}`: {why}", self.folder.display()));
        }
        self.shrink();
    }

    fn write(&self, key: &str, payload: &[u8]) -> io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        let own = self.folder.join(format!("{BEFORE}{key}-{}{UNFINISHED}", std::process::id()));
        let written =
            std::fs::write(&own, checkpoint::frame(payload)).and_then(|()| std::fs::rename(&own, self.path(key)));
        written.inspect_err(|_| {
            let _ = std::fs::remove_file(&own);
        })
    }

    /// What is kept, the longest unused first.
    pub fn entries(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = self.files().into_iter().filter(|(_, whole)| *whole).map(|(e, _)| e).collect();
        entries.sort_by(|a, b| a.used.cmp(&b.used).then_with(|| a.path.cmp(&b.path)));
        entries
    }

    /// Removes all that is kept; returns how many files and bytes that were.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn clear(&self) -> io::Result<(usize, u64)> {
        let files = self.files();
        for (entry, _) in &files {
            std::fs::remove_file(&entry.path)?;
        }
        Ok((files.len(), files.iter().map(|(entry, _)| entry.bytes).sum()))
    }

    /// What there was to say since the last time, for people.
    pub fn words(&self) -> Vec<String> {
        std::mem::take(&mut *self.words.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn say(&self, what: String) {
        self.words.lock().unwrap_or_else(PoisonError::into_inner).push(what);
    }

    fn path(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{BEFORE}{key}{AFTER}"))
    }

    /// Own files, and whether each is whole; what is being written only once it is forgotten.
    fn files(&self) -> Vec<(Entry, bool)> {
        let hex = |text: &str| text.len() == 64 && text.bytes().all(|b| b.is_ascii_hexdigit());
        let own = |entry: std::fs::DirEntry| {
            let name = entry.file_name().into_string().ok()?;
            let rest = name.strip_prefix(BEFORE)?;
            let whole = rest.strip_suffix(AFTER).is_some_and(hex);
            let unfinished = rest.ends_with(UNFINISHED) && rest.get(..64).is_some_and(hex);
            let is = entry.metadata().ok()?;
            let used = is.modified().ok()?;
            let forgotten = unfinished && used.elapsed().is_ok_and(|age| age > FORGOTTEN);
            (whole || forgotten).then(|| (Entry { path: entry.path(), bytes: is.len(), used }, whole))
        };
        std::fs::read_dir(&self.folder).into_iter().flatten().flatten().filter_map(own).collect()
    }

    /// Removes what was not used for longest until the rest is within the limit.
    fn shrink(&self) {
        for (entry, _) in self.files().into_iter().filter(|(_, whole)| !whole) {
            let _ = std::fs::remove_file(entry.path);
        }
        let mut entries = VecDeque::from(self.entries());
        let mut total: u64 = entries.iter().map(|entry| entry.bytes).sum();
        while let Some(oldest) = entries.pop_front().filter(|_| total > self.limit) {
            let _ = std::fs::remove_file(&oldest.path);
            total -= oldest.bytes;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn key(k: u8) -> String {
        format!("{k:064x}")
    }

    #[test]
    fn what_is_kept_comes_back_until_others_need_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path().join("new/folder"), 300);
        assert_eq!((cache.get(&key(1)), cache.entries(), cache.words()), (None, Vec::new(), Vec::new()));
        // Each takes 24 bytes more.
        for k in 1..=2 {
            cache.put(&key(k), &[k; 100]);
        }
        let old = |k: u8, hours: u64| {
            let file = fs::File::options().append(true).open(cache.path(&key(k))).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(3600 * hours)).unwrap();
        };
        old(1, 2);
        old(2, 1);
        assert_eq!(cache.get(&key(1)), Some(vec![1; 100]));
        fs::write(cache.folder().join("notes.txt"), "somebody's").unwrap();
        cache.put(&key(3), &[3; 100]);
        assert_eq!(cache.get(&key(2)), None, "the longest unused goes");
        assert!(cache.get(&key(1)).is_some() && cache.get(&key(3)).is_some());
        cache.put(&key(4), &[4; 301]);
        assert_eq!(cache.get(&key(4)), None);
        assert_eq!(cache.clear().unwrap(), (2, 248));
        assert_eq!((cache.entries().len(), cache.words().len()), (0, 0));
        assert!(cache.folder().join("notes.txt").exists(), "what is not its own stays");
    }

    #[test]
    fn damage_is_seen_said_and_removed() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path().to_owned(), 1 << 20);
        cache.put(&key(1), b"some bytes");
        let path = cache.path(&key(1));
        let mut bytes = fs::read(&path).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(&path, bytes).unwrap();
        assert_eq!(cache.get(&key(1)), None);
        assert!(cache.words()[0].contains("checksum"));
        assert!(!path.exists() && cache.words().is_empty());
        // A folder that takes nothing.
        let nowhere = Cache::new(path.join("below"), 1 << 20);
        fs::write(&path, "a file").unwrap();
        nowhere.put(&key(1), b"x");
        assert_eq!((nowhere.get(&key(1)), nowhere.words().len()), (None, 1));
    }
}
