//! An array of a file, compressed.

use super::escape;
use crate::files::FileError;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use simd_adler32::adler32;
use std::io::{self, Write};

/// Bytes that are compressed together.
const BLOCK: usize = 1 << 16;

/// Named values of a grid, compressed as they are written.
#[derive(Debug, Clone)]
pub struct Array {
    name: String,
    kind: &'static str,
    tuples: usize,
    components: Vec<String>,
    /// Header and compressed blocks.
    encoded: Vec<u8>,
    /// The first value that is not finite, and its position.
    refused: Option<(usize, f64)>,
}

impl Array {
    /// Real numbers in single precision, `components` for each point or cell.
    pub fn reals(name: impl Into<String>, components: usize, values: &[f64]) -> Self {
        let mut bytes = Vec::with_capacity(size_of::<f32>() * values.len());
        values.iter().for_each(|value| bytes.extend_from_slice(&(*value as f32).to_le_bytes()));
        let refused = values.iter().position(|value| !(*value as f32).is_finite()).map(|at| (at, values[at]));
        Self { refused, ..Self::new(name, "Float32", components, values.len(), encode(&bytes, stored)) }
    }

    /// Real numbers in double precision.
    pub fn precise(name: impl Into<String>, components: usize, values: &[f64]) -> Self {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let refused = values.iter().position(|value| !value.is_finite()).map(|at| (at, values[at]));
        Self { refused, ..Self::new(name, "Float64", components, values.len(), encode(&bytes, deflate)) }
    }

    /// Real numbers in single precision; not a number where there is none, which readers leave out and paint in a colour of its own.
    pub fn where_known(name: impl Into<String>, values: &[Option<f64>]) -> Self {
        let mut bytes = Vec::with_capacity(size_of::<f32>() * values.len());
        let single = values.iter().map(|value| value.map_or(f32::NAN, |value| value as f32));
        single.for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
        let infinite = |value: &Option<f64>| value.is_some_and(|value| !(value as f32).is_finite());
        let refused = values.iter().position(infinite).map(|at| (at, values[at].unwrap_or(f64::NAN)));
        Self { refused, ..Self::new(name, "Float32", 1, values.len(), encode(&bytes, deflate)) }
    }

    /// Whole numbers.
    pub fn integers(name: impl Into<String>, values: impl Iterator<Item = i64> + Clone) -> Self {
        let narrow = values.clone().all(|value| i32::try_from(value).is_ok());
        let (kind, bytes): (_, Vec<u8>) = match narrow {
            true => ("Int32", values.flat_map(|value| (value as i32).to_le_bytes()).collect()),
            false => ("Int64", values.flat_map(i64::to_le_bytes).collect()),
        };
        let count = bytes.len() / if narrow { size_of::<i32>() } else { size_of::<i64>() };
        Self::new(name, kind, 1, count, encode(&bytes, deflate))
    }

    pub(super) fn bytes(name: &str, values: &[u8]) -> Self {
        Self::new(name, "UInt8", 1, values.len(), encode(values, deflate))
    }

    fn new(name: impl Into<String>, kind: &'static str, components: usize, values: usize, encoded: Vec<u8>) -> Self {
        let tuples = values / components.max(1);
        let components = vec![String::new(); components];
        Self { name: name.into(), kind, tuples, components, encoded, refused: None }
    }

    /// The same with names for its components.
    #[must_use]
    pub fn with_components(mut self, names: &[&str]) -> Self {
        self.components.iter_mut().zip(names).for_each(|(own, name)| (*name).clone_into(own));
        self
    }

    /// What it takes in a file, bytes.
    pub fn size(&self) -> usize {
        self.encoded.len()
    }

    /// Refuses an array with a value that is not finite, for the file `file`.
    pub(super) fn check(&self, file: &str) -> Result<(), FileError> {
        let Some((at, value)) = self.refused else { return Ok(()) };
        let (row, column) = (at / self.components.len() + 1, self.name.clone());
        Err(FileError::NonFinite { file: file.to_owned(), row, column, value })
    }

    /// The XML element that says where its bytes are.
    pub(super) fn element(&self, offset: usize, counted: bool) -> String {
        let mut text = format!(r#"<DataArray type="{}" Name="{}""#, self.kind, escape(&self.name));
        if self.components.len() > 1 {
            text += &format!(r#" NumberOfComponents="{}""#, self.components.len());
        }
        for (number, name) in self.components.iter().enumerate().filter(|(_, name)| !name.is_empty()) {
            text += &format!(r#" ComponentName{number}="{}""#, escape(name));
        }
        if counted {
            text += &format!(r#" NumberOfTuples="{}""#, self.tuples);
        }
        text + &format!(r#" format="appended" offset="{offset}"/>"#)
    }

    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&self.encoded)
    }
}

/// Header and compressed blocks of `bytes`.
fn encode(bytes: &[u8], compressed: fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK).map(compressed).collect();
    let sizes = blocks.iter().map(Vec::len);
    let header = [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().chain(sizes);
    let header: Vec<u8> = header.flat_map(|number| (number as u64).to_le_bytes()).collect();
    [header].into_iter().chain(blocks).collect::<Vec<_>>().concat()
}

fn deflate(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(bytes.len() + 64), Compression::fast());
    // A vector takes all that it is given.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}

/// A stream of zlib (RFC 1950) whose blocks hold the bytes as they are (RFC 1951, 3.2.4): the compressor would clear half a
/// megabyte of its own for each.
fn stored(bytes: &[u8]) -> Vec<u8> {
    let mut stream = Vec::with_capacity(bytes.len() + 16);
    stream.extend_from_slice(&[0x78, 0x01]);
    let mut rest = bytes;
    loop {
        let (block, after) = rest.split_at(rest.len().min(usize::from(u16::MAX)));
        let length = block.len() as u16;
        stream.push(u8::from(after.is_empty()));
        stream.extend_from_slice(&length.to_le_bytes());
        stream.extend_from_slice(&(!length).to_le_bytes());
        stream.extend_from_slice(block);
        if after.is_empty() {
            stream.extend_from_slice(&adler32(&bytes).to_be_bytes());
            return stream;
        }
        rest = after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    #[test]
    fn blocks_are_counted_as_the_format_says() {
        let header = |bytes: usize| {
            let encoded = encode(&vec![7; bytes], deflate);
            let number = |at: usize| u64::from_le_bytes(std::array::from_fn(|k| encoded[8 * at + k]));
            [number(0), number(1), number(2)]
        };
        assert_eq!(header(0), [0, 65536, 0]);
        assert_eq!(header(1), [1, 65536, 1]);
        assert_eq!(header(65536), [1, 65536, 0]);
        assert_eq!(header(65537), [2, 65536, 1]);
    }

    #[test]
    fn stored_bytes_are_a_stream_of_zlib() {
        for count in [0, 1, 65_534, 65_535, 65_536] {
            let bytes: Vec<u8> = (0..count).map(|k: u32| (k % 251) as u8).collect();
            let mut read = Vec::new();
            flate2::read::ZlibDecoder::new(&stored(&bytes)[..]).read_to_end(&mut read).unwrap();
            assert_eq!(read, bytes);
        }
    }

    #[test]
    fn whole_numbers_take_as_little_as_they_need() {
        let kind = |values: &[i64]| Array::integers("n", values.iter().copied()).kind;
        assert_eq!(kind(&[-1, 0, 2_147_483_647]), "Int32");
        assert_eq!(kind(&[0, 2_147_483_648]), "Int64");
    }

    #[test]
    fn a_number_that_is_not_there_is_written_as_none() {
        let array = Array::where_known("onset", &[Some(0.5), None]);
        assert!(array.check("plies-0001.vtu").is_ok());
        let mut bytes = Vec::new();
        let header = 8 * (3 + 1);
        flate2::read::ZlibDecoder::new(&array.encoded[header..]).read_to_end(&mut bytes).unwrap();
        let values: Vec<f32> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
        assert!(values[0] == 0.5 && values[1].is_nan() && values.len() == 2, "{values:?}");
        let error = Array::where_known("onset", &[None, Some(1e39)]).check("plies-0001.vtu").unwrap_err().to_string();
        assert!(error.contains("row 2, column onset"), "{error}");
    }

    #[test]
    fn what_is_not_finite_is_named() {
        for (value, at) in [(f64::NAN, 5), (1e39, 2), (f64::NEG_INFINITY, 0)] {
            let mut values = [0.0; 6];
            values[at] = value;
            let error = Array::reals("stress", 3, &values).check("plies-0001.vtu").unwrap_err().to_string();
            let want = format!("plies-0001.vtu, row {}, column stress: {value} is not a finite number", at / 3 + 1);
            assert_eq!(error, want);
        }
    }
}
