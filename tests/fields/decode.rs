//! Files of VTK, read by other means than they are written with.

use flate2::read::ZlibDecoder;
use roxmltree::{Document, Node};
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// A grid as a file holds it.
pub(super) struct Vtu {
    pub(super) version: String,
    pub(super) points: usize,
    pub(super) cells: usize,
    arrays: Vec<Array>,
}

pub(super) struct Array {
    section: String,
    pub(super) name: String,
    pub(super) kind: String,
    pub(super) component_names: Vec<String>,
    pub(super) values: Vec<f64>,
}

impl Vtu {
    #[track_caller]
    pub(super) fn read(path: &Path) -> Self {
        let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
        let appended = bytes[at..].strip_suffix(b"\n</AppendedData>\n</VTKFile>\n").unwrap();
        let text = String::from_utf8(bytes[..at].to_vec()).unwrap() + "</AppendedData></VTKFile>";
        let document = Document::parse(&text).unwrap();
        let root = document.root_element();
        for (key, value) in [
            ("type", "UnstructuredGrid"),
            ("byte_order", "LittleEndian"),
            ("header_type", "UInt64"),
            ("compressor", "vtkZLibDataCompressor"),
        ] {
            assert_eq!(root.attribute(key), Some(value));
        }
        let piece = document.descendants().find(|n| n.has_tag_name("Piece")).unwrap();
        let number = |key: &str| piece.attribute(key).unwrap().parse().unwrap();
        let mut end = 0;
        let arrays = document.descendants().filter(|n| n.has_tag_name("DataArray"));
        let arrays: Vec<Array> = arrays.map(|node| array(node, appended, &mut end)).collect();
        assert_eq!(end, appended.len(), "every byte belongs to an array");
        let version = root.attribute("version").unwrap().to_owned();
        Self { version, points: number("NumberOfPoints"), cells: number("NumberOfCells"), arrays }
    }

    #[track_caller]
    pub(super) fn array(&self, section: &str, name: &str) -> &Array {
        let found = self.arrays.iter().find(|a| a.section == section && a.name == name);
        found.unwrap_or_else(|| panic!("no {section} {name} among {:?}", self.names(section)))
    }

    /// Values as `N` components of each point or cell.
    #[track_caller]
    pub(super) fn tuples<const N: usize>(&self, section: &str, name: &str) -> &[[f64; N]] {
        let (tuples, rest) = self.array(section, name).values.as_chunks();
        assert!(rest.is_empty());
        tuples
    }

    #[track_caller]
    pub(super) fn points(&self, name: &str) -> &[[f64; 3]] {
        self.tuples("PointData", name)
    }

    #[track_caller]
    pub(super) fn cells(&self, name: &str) -> &[f64] {
        &self.array("CellData", name).values
    }

    pub(super) fn positions(&self) -> &[[f64; 3]] {
        self.tuples("Points", "Points")
    }

    /// Points of each cell.
    pub(super) fn connectivity(&self) -> Vec<Vec<usize>> {
        let all = &self.array("Cells", "connectivity").values;
        let mut start = 0;
        let ends = self.array("Cells", "offsets").values.iter();
        ends.map(|end| {
            all[std::mem::replace(&mut start, *end as usize)..*end as usize].iter().map(|p| *p as usize).collect()
        })
        .collect()
    }

    pub(super) fn names(&self, section: &str) -> Vec<&str> {
        self.arrays.iter().filter(|a| a.section == section).map(|a| a.name.as_str()).collect()
    }
}

fn array(node: Node<'_, '_>, appended: &[u8], end: &mut usize) -> Array {
    let attribute = |key: &str| node.attribute(key).unwrap_or_default().to_owned();
    assert_eq!((attribute("format").as_str(), attribute("offset")), ("appended", end.to_string()));
    let header = |k: usize| u64::from_le_bytes(appended[*end + 8 * k..][..8].try_into().unwrap()) as usize;
    let (blocks, size, last) = (header(0), header(1), header(2));
    let mut at = *end + 8 * (3 + blocks);
    let mut bytes = Vec::new();
    for block in 0..blocks {
        let packed = &appended[at..at + header(3 + block)];
        let before = bytes.len();
        ZlibDecoder::new(packed).read_to_end(&mut bytes).unwrap();
        let wanted = if block + 1 == blocks && last > 0 { last } else { size };
        assert_eq!(bytes.len() - before, wanted);
        at += packed.len();
    }
    *end = at;
    let kind = attribute("type");
    let values = match kind.as_str() {
        "Float64" => numbers(&bytes, f64::from_le_bytes),
        "Float32" => numbers(&bytes, |b| f64::from(f32::from_le_bytes(b))),
        "Int64" => numbers(&bytes, |b| i64::from_le_bytes(b) as f64),
        "Int32" => numbers(&bytes, |b| f64::from(i32::from_le_bytes(b))),
        "UInt8" => numbers(&bytes, |[b]: [u8; 1]| f64::from(b)),
        other => panic!("{other}"),
    };
    let component_names = (0..9).map_while(|k| node.attribute(format!("ComponentName{k}").as_str()).map(str::to_owned));
    let section = node.parent().unwrap().tag_name().name().to_owned();
    Array { section, name: attribute("Name"), kind, component_names: component_names.collect(), values }
}

fn numbers<const N: usize>(bytes: &[u8], number: fn([u8; N]) -> f64) -> Vec<f64> {
    let (numbers, rest) = bytes.as_chunks();
    assert!(rest.is_empty());
    numbers.iter().map(|b| number(*b)).collect()
}

/// Times and files of a series.
#[track_caller]
pub(super) fn collection(path: &Path) -> Vec<(f64, PathBuf)> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let document = Document::parse(&text).unwrap();
    assert_eq!(document.root_element().attribute("type"), Some("Collection"));
    let sets = document.descendants().filter(|n| n.has_tag_name("DataSet"));
    let set = |n: Node<'_, '_>| {
        let file = path.with_file_name(n.attribute("file").unwrap());
        (n.attribute("timestep").unwrap().parse().unwrap(), file)
    };
    sets.map(set).collect()
}
