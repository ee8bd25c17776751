//! Arrays as NumPy keeps them (format 1.0): `numpy.load`.

use crate::files::{FileError, OutputDir};

/// The header ends at a multiple of this.
const ALIGNED: usize = 64;
/// Magic, version, length of the header.
const PREFIX: usize = 10;

/// Writes `values` as an array of doubles of `shape`, the last index running fastest.
///
/// # Errors
/// As [`OutputDir::write`].
pub fn write(dir: &OutputDir, name: &str, shape: &[usize], values: &[f64]) -> Result<(), FileError> {
    // A tuple of one ends in a comma.
    let shape: String = shape.iter().map(|n| format!("{n},")).collect();
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}");
    let room = (PREFIX + header.len() + 1).next_multiple_of(ALIGNED);
    header.push_str(&" ".repeat(room - PREFIX - header.len() - 1));
    header.push('\n');
    dir.write(name, |out| {
        out.write_all(b"\x93NUMPY\x01\x00")?;
        out.write_all(&(header.len() as u16).to_le_bytes())?;
        out.write_all(header.as_bytes())?;
        values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_has_the_bytes_that_numpy_wants() {
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        write(&dir, "a.npy", &[2, 1], &[1.0, -2.5]).unwrap();
        let bytes = std::fs::read(folder.path().join("a.npy")).unwrap();
        // What numpy 2 writes of np.array([[1.0], [-2.5]]), but for the comma that it leaves out.
        assert_eq!(&bytes[..10], b"\x93NUMPY\x01\x00\x76\x00");
        assert!(bytes[10..].starts_with(b"{'descr': '<f8', 'fortran_order': False, 'shape': (2,1,), }  "));
        assert_eq!((bytes.len(), bytes[127]), (128 + 16, b'\n'));
        assert_eq!(&bytes[128..136], &1.0_f64.to_le_bytes());
    }
}
