//! The bytes of a file that may come from anyone: of a regular file alone, and no more of them than such a file needs.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Whether a link is as good as the file that it leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Links {
    /// It is: the user has named it.
    Follow,
    /// It is not: it lies in a folder that may be somebody else's.
    Refuse,
}

/// Why a file is not read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ReadError {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("it is {0}, and only files are read")]
    NotAFile(&'static str),
    #[error("it is longer than {0} bytes, more than such a file ever needs")]
    TooLong(u64),
}

/// Opens a file without waiting for anyone: a pipe, a device or a folder is refused before a byte of it is read.
pub(crate) fn open(path: &Path, links: Links) -> Result<File, ReadError> {
    let file = options(links).read(true).open(path).map_err(|cause| match links {
        Links::Refuse if path.is_symlink() => ReadError::NotAFile("a link"),
        _ => ReadError::Io(cause),
    })?;
    let is = file.metadata()?;
    match () {
        () if is.is_file() => Ok(file),
        () if is.is_dir() => Err(ReadError::NotAFile("a folder")),
        () => Err(ReadError::NotAFile("a pipe or a device")),
    }
}

/// All bytes of a file, `limit` at most.
pub(crate) fn read(path: &Path, limit: u64, links: Links) -> Result<Vec<u8>, ReadError> {
    let file = open(path, links)?;
    if file.metadata()?.len() > limit {
        return Err(ReadError::TooLong(limit));
    }
    let mut bytes = Vec::new();
    // Files of the kernel have no length.
    file.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit { Err(ReadError::TooLong(limit)) } else { Ok(bytes) }
}

/// Options to open a file by which a pipe does not wait, and a link is not followed unless it may be.
pub(crate) fn options(links: Links) -> std::fs::OpenOptions {
    let mut options = File::options();
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        let no_follow = if links == Links::Refuse { libc::O_NOFOLLOW } else { 0 };
        options.custom_flags(libc::O_NONBLOCK | no_follow);
    }
    #[cfg(not(unix))]
    let _ = links;
    options
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_or_too_long_is_refused_at_once() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("file"), "12345").unwrap();
        symlink("file", path("link")).unwrap();
        symlink("/dev/zero", path("zero")).unwrap();
        std::fs::File::create(path("huge")).unwrap().set_len(1 << 40).unwrap();
        let said = |name: &str, links| match read(&path(name), 5, links) {
            Ok(bytes) => String::from_utf8(bytes).unwrap(),
            Err(why) => why.to_string(),
        };
        for links in [Links::Follow, Links::Refuse] {
            assert_eq!(said("file", links), "12345");
            assert!(said("", links).contains("a folder"));
            assert!(said("huge", links).contains("longer than 5 bytes"));
            assert!(said("absent", links).contains("No such file"));
        }
        assert_eq!(said("link", Links::Follow), "12345");
        assert!(said("zero", Links::Follow).contains("a device"));
        for link in ["link", "zero"] {
            assert!(said(link, Links::Refuse).contains("a link"), "{}", said(link, Links::Refuse));
        }
        // Without a length, and longer than it says.
        assert!(read(Path::new("/proc/self/status"), 5, Links::Follow).is_err());
    }
}
