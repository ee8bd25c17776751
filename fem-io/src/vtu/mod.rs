//! Unstructured grids as VTK reads them: one `.vtu` file per time, and a `.pvd` file that puts them in order.
//!
//! | part of a `.vtu` file | how it is written |
//! | --- | --- |
//! | numbers | appended raw behind the XML, little-endian, in blocks of 64 KiB that are zlib streams each |
//! | headers | `UInt64`: number of blocks, size of a block, size of the last one if it is shorter, compressed sizes |
//! | coordinates | `Float64`, because plies are thin and a plate may lie far from its origin |
//! | other reals | `Float32`: seven digits, half the size; stored, because they hardly compress (a tenth), unless most are missing |
//! | whole numbers | `Int32` where all fit, `Int64` otherwise |
//!
//! Files of Lagrange cells are of version 2.2, in which the edges of these cells have their present order; all others
//! are of version 1.0, which every reader knows. Equal contents make equal bytes.

mod array;
mod collection;
mod lagrange;

pub use array::Array;
pub use collection::{Member, write_collection};
pub use lagrange::{lagrange_hexahedron, quadratic_wedge};

use crate::files::{FileError, OutputDir};
use std::io::{self, Write};

const ENCODING: &str = r#"header_type="UInt64" compressor="vtkZLibDataCompressor""#;

/// What the cells of a grid are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Four points, anticlockwise.
    Quad,
    /// Four points anticlockwise seen from above, and the four above them.
    Hexahedron,
    /// Three points, anticlockwise.
    Triangle,
    /// Three points anticlockwise seen from above, and the three above them.
    Wedge,
    /// Four points and the middles of its sides, anticlockwise each, and its own.
    BiquadraticQuad,
    /// Three points and the middles of its sides, anticlockwise each.
    QuadraticTriangle,
    /// 15 points in the order of [`quadratic_wedge`].
    QuadraticWedge,
    /// (n + 1)³ points in the order of [`lagrange_hexahedron`], n the order.
    Lagrange(usize),
}

impl Shape {
    const fn points(self) -> usize {
        match self {
            Self::Quad => 4,
            Self::Hexahedron => 8,
            Self::Triangle => 3,
            Self::Wedge => 6,
            Self::BiquadraticQuad => 9,
            Self::QuadraticTriangle => 6,
            Self::QuadraticWedge => 15,
            Self::Lagrange(order) => (order + 1).pow(3),
        }
    }

    /// Its number in VTK.
    const fn id(self) -> u8 {
        match self {
            Self::Quad => 9,
            Self::Hexahedron => 12,
            Self::Triangle => 5,
            Self::Wedge => 13,
            Self::BiquadraticQuad => 28,
            Self::QuadraticTriangle => 22,
            Self::QuadraticWedge => 26,
            Self::Lagrange(_) => 72,
        }
    }

    const fn version(self) -> &'static str {
        match self {
            Self::Lagrange(_) => "2.2",
            _ => "1.0",
        }
    }
}

/// Points and cells, compressed once for all files that they appear in.
#[derive(Debug, Clone)]
pub struct Grid {
    version: &'static str,
    points: usize,
    cells: usize,
    positions: Array,
    topology: [Array; 3],
}

/// What a file says beside its grid.
#[derive(Debug, Clone, Copy, Default)]
pub struct Contents<'a> {
    /// Of the file as a whole.
    pub field: &'a [Array],
    /// At the points.
    pub points: &'a [Array],
    /// In the cells.
    pub cells: &'a [Array],
    /// In the cells as well: what does not change from file to file.
    pub fixed: &'a [Array],
}

impl Grid {
    /// A grid of points, m, and cells of these shapes, the numbers of whose points follow each other.
    pub fn new(points: &[[f64; 3]], shapes: &[Shape], cells: &[u32]) -> Self {
        let offsets = shapes.iter().scan(0, |end, shape| {
            *end += shape.points() as i64;
            Some(*end)
        });
        let types: Vec<u8> = shapes.iter().map(|shape| shape.id()).collect();
        Self {
            // The later version reads all that the earlier one does.
            version: shapes.iter().map(|shape| shape.version()).max().unwrap_or("1.0"),
            points: points.len(),
            cells: shapes.len(),
            positions: Array::precise("Points", 3, points.as_flattened()),
            topology: [
                Array::integers("connectivity", cells.iter().map(|point| i64::from(*point))),
                Array::integers("offsets", offsets),
                Array::bytes("types", &types),
            ],
        }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// What the grid takes in a file, bytes.
    pub fn size(&self) -> usize {
        self.positions.size() + self.topology.iter().map(Array::size).sum::<usize>()
    }

    /// Writes the file `name`, which ends in `.vtu`.
    ///
    /// # Errors
    /// A value that is not finite in single precision, and as [`OutputDir::write_unsynced`].
    pub fn write(&self, dir: &OutputDir, name: &str, contents: Contents<'_>) -> Result<(), FileError> {
        let Contents { field, points, cells, fixed } = contents;
        let written = || [field, points, cells, fixed].into_iter().flatten();
        for array in written().chain([&self.positions]) {
            array.check(name)?;
        }
        dir.write_unsynced(name, |out| {
            let mut appended = Appended::default();
            let version = self.version;
            writeln!(out, r#"<?xml version="1.0"?>"#)?;
            writeln!(
                out,
                r#"<VTKFile type="UnstructuredGrid" version="{version}" byte_order="LittleEndian" {ENCODING}>"#
            )?;
            writeln!(out, "<UnstructuredGrid>")?;
            appended.section(out, "FieldData", field.iter())?;
            writeln!(out, r#"<Piece NumberOfPoints="{}" NumberOfCells="{}">"#, self.points, self.cells)?;
            appended.section(out, "PointData", points.iter())?;
            appended.section(out, "CellData", fixed.iter().chain(cells))?;
            appended.section(out, "Points", [&self.positions].into_iter())?;
            appended.section(out, "Cells", self.topology.iter())?;
            writeln!(out, "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">")?;
            out.write_all(b"_")?;
            appended.arrays.iter().try_for_each(|array| array.write(out))?;
            writeln!(out, "\n</AppendedData>\n</VTKFile>")
        })
    }
}

/// Arrays in the order of their bytes behind the XML.
#[derive(Default)]
struct Appended<'a> {
    arrays: Vec<&'a Array>,
    offset: usize,
}

impl<'a> Appended<'a> {
    fn section(&mut self, out: &mut dyn Write, tag: &str, arrays: impl Iterator<Item = &'a Array>) -> io::Result<()> {
        writeln!(out, "<{tag}>")?;
        for array in arrays {
            writeln!(out, "{}", array.element(self.offset, tag == "FieldData"))?;
            self.offset += array.size();
            self.arrays.push(array);
        }
        writeln!(out, "</{tag}>")
    }
}

/// `text` as the value of an attribute; characters that XML does not have become spaces.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}
