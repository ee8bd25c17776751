//! Files that are read whole or not at all: a frame with a checksum about bytes that a later run continues from.
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | `fem-ckpt` |
//! | 4 | version of the format |
//! | 8 | length of the payload |
//! | 4 | CRC-32 of the payload |
//! | | payload |
//!
//! Numbers are little-endian.

use crate::bytes::{self, Links};
use crate::files::{FileError, OutputDir, unread};
use std::path::Path;

const MAGIC: &[u8; 8] = b"fem-ckpt";
const VERSION: u32 = 1;
const HEADER: usize = 24;

/// Longest file that is read.
const MAX_BYTES: u64 = 1 << 34;

/// Writes `payload` in its frame to the file `name`.
///
/// # Errors
/// As [`OutputDir::write`].
pub fn write(dir: &OutputDir, name: &str, payload: &[u8]) -> Result<(), FileError> {
    dir.write(name, |out| {
        out.write_all(&header(payload))?;
        out.write_all(payload)
    })
}

/// `payload` in its frame.
pub(crate) fn frame(payload: &[u8]) -> Vec<u8> {
    [&header(payload)[..], payload].concat()
}

fn header(payload: &[u8]) -> Vec<u8> {
    let (length, sum) = ((payload.len() as u64).to_le_bytes(), crc32fast::hash(payload).to_le_bytes());
    [&MAGIC[..], &VERSION.to_le_bytes(), &length, &sum].concat()
}

/// The payload of the file `path`.
///
/// # Errors
/// A file that cannot be read, [`FileError::Damaged`] for one that is not as it was written.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    let mut bytes = bytes::read(path, MAX_BYTES, Links::Refuse).map_err(unread(path))?;
    let damaged = |why: String| FileError::Damaged { path: path.to_owned(), why };
    let part = |from: usize, to: usize| bytes.get(from..to).map(<[u8]>::to_vec).unwrap_or_default();
    if part(0, 8) != MAGIC {
        return Err(damaged("it does not begin with the header of a checkpoint".into()));
    }
    if part(8, 12) != VERSION.to_le_bytes() {
        return Err(damaged(format!("its format is not version {VERSION}, which this program reads")));
    }
    let length = bytes.len().saturating_sub(HEADER);
    if bytes.len() < HEADER || part(12, 20) != (length as u64).to_le_bytes() {
        return Err(damaged(format!("its length is not the one in its header, which {length} bytes follow")));
    }
    let payload = bytes.split_off(HEADER);
    if bytes[20..] != crc32fast::hash(&payload).to_le_bytes() {
        return Err(damaged("its checksum is wrong".into()));
    }
    Ok(payload)
}

/// Length and CRC-32 of a file, by which two versions of it are told apart.
///
/// # Errors
/// A file that cannot be read.
pub fn digest(path: &Path) -> Result<String, FileError> {
    let bytes = bytes::read(path, MAX_BYTES, Links::Follow).map_err(unread(path))?;
    Ok(format!("{} bytes, CRC-32 {:08x}", bytes.len(), crc32fast::hash(&bytes)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_payload_comes_back_and_any_damage_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        let path = dir.path().join("c.bin");
        for payload in [&b""[..], b"some bytes"] {
            let _ = fs::remove_file(&path);
            write(&dir, "c.bin", payload).unwrap();
            assert_eq!(read(&path).unwrap(), payload);
            let whole = fs::read(&path).unwrap();
            let refused = |bytes: &[u8]| {
                fs::write(&path, bytes).unwrap();
                matches!(read(&path), Err(FileError::Damaged { .. }))
            };
            for i in 0..whole.len() {
                let mut bytes = whole.clone();
                bytes[i] ^= 0x10;
                assert!(refused(&bytes), "byte {i}");
                assert!(refused(&whole[..i]), "cut at {i}");
            }
            assert!(refused(&[&whole[..], b"x"].concat()));
        }
    }

    #[test]
    fn a_digest_tells_files_apart() {
        let folder = tempfile::tempdir().unwrap();
        let digest = |text: &str| {
            let path = folder.path().join("mesh");
            fs::write(&path, text).unwrap();
            super::digest(&path).unwrap()
        };
        // The check value of CRC-32/ISO-HDLC.
        assert_eq!(digest("123456789"), "9 bytes, CRC-32 cbf43926");
        assert_ne!(digest("123456788"), digest("123456789"));
    }
}
