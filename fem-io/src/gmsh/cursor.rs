//! Numbers one after the other, as text or binary.

/// Where a number should stand and does not: an offset.
pub(super) type Lacking = usize;

/// A place in a file that moves on with every number read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cursor<'s> {
    bytes: &'s [u8],
    at: usize,
    binary: bool,
}

impl<'s> Cursor<'s> {
    pub(super) fn new(bytes: &'s [u8], at: usize, binary: bool) -> Self {
        Self { bytes, at, binary }
    }

    /// Offset of what comes next.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// A `size_t` of the format.
    pub(super) fn size(&mut self) -> Result<u64, Lacking> {
        if self.binary {
            return self.fixed().map(u64::from_le_bytes);
        }
        let (start, word) = self.word();
        let digit = |n: u64, b: &u8| {
            let digit = b.wrapping_sub(b'0');
            if digit < 10 { n.checked_mul(10)?.checked_add(u64::from(digit)) } else { None }
        };
        if word.is_empty() { Err(start) } else { word.iter().try_fold(0, digit).ok_or(start) }
    }

    /// An `int` of the format.
    pub(super) fn int(&mut self) -> Result<i32, Lacking> {
        if self.binary { self.fixed().map(i32::from_le_bytes) } else { self.text() }
    }

    /// A `double` of the format.
    pub(super) fn double(&mut self) -> Result<f64, Lacking> {
        if self.binary { self.fixed().map(f64::from_le_bytes) } else { self.text() }
    }

    /// Passes the marker at the end of a section.
    pub(super) fn end(&mut self, marker: &str) -> Result<(), Lacking> {
        match self.word() {
            (_, word) if word == marker.as_bytes() => Ok(()),
            (start, _) => Err(start),
        }
    }

    fn text<T: std::str::FromStr>(&mut self) -> Result<T, Lacking> {
        let (start, word) = self.word();
        std::str::from_utf8(word).ok().and_then(|text| text.parse().ok()).ok_or(start)
    }

    fn word(&mut self) -> (usize, &'s [u8]) {
        let rest = &self.bytes[self.at..];
        let before = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
        let rest = &rest[before..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let start = self.at + before;
        self.at = start + length;
        (start, &rest[..length])
    }

    fn fixed<const N: usize>(&mut self) -> Result<[u8; N], Lacking> {
        let (bytes, _) = self.bytes[self.at..].split_first_chunk().ok_or(self.at)?;
        self.at += N;
        Ok(*bytes)
    }
}
