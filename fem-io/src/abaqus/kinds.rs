//! Types of elements.

/// What an element of a type is to a plane mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Triangle or quadrilateral: corners, nodes.
    Cell(u8, u8),
    /// Nodes; the second end is the last.
    Edge(u8),
    /// A body.
    Solid,
}

impl Kind {
    /// By the name of the type; none for what is no part of a plate.
    pub(super) fn of(name: &str) -> Option<Self> {
        let name = name.to_ascii_uppercase();
        let after =
            |family: &str| name.strip_prefix(family)?.bytes().next().filter(u8::is_ascii_digit).map(|b| b - b'0');
        if ["C3D", "SC", "CSS", "DC3D"].iter().any(|family| after(family).is_some()) {
            return Some(Self::Solid);
        }
        if name.starts_with("STRI") {
            return Some(Self::Cell(3, if name == "STRI65" { 6 } else { 3 }));
        }
        if ["T2D", "T3D"].iter().any(|family| name.starts_with(family)) {
            return match after(&name[..3]) {
                Some(nodes @ 2..=3) => Some(Self::Edge(nodes)),
                _ => None,
            };
        }
        if after("B").is_some() {
            // The second digit is the order of the functions; cubic beams have two nodes.
            return match name.as_bytes().get(2) {
                Some(b'1' | b'3') => Some(Self::Edge(2)),
                Some(b'2') => Some(Self::Edge(3)),
                _ => None,
            };
        }
        // Axisymmetric and rigid ones: as such meshio writes any triangle or quadrilateral.
        let families = ["S", "CPS", "CPE", "CPEG", "M3D", "SFM3D", "CAX", "R3D"];
        match families.iter().find_map(|family| after(family))? {
            nodes @ (3 | 6) => Some(Self::Cell(3, nodes)),
            nodes @ (4 | 8 | 9) => Some(Self::Cell(4, nodes)),
            _ => None,
        }
    }

    pub(super) fn corners(self) -> u8 {
        match self {
            Self::Cell(corners, _) => corners,
            Self::Edge(_) | Self::Solid => 2,
        }
    }

    pub(super) fn nodes(self) -> usize {
        match self {
            Self::Cell(_, nodes) | Self::Edge(nodes) => nodes.into(),
            Self::Solid => 0,
        }
    }

    /// Where a node of an element belongs, corners first; the middle of a cell nowhere.
    pub(super) fn slot(self, node: usize) -> Option<usize> {
        match (self, node) {
            (Self::Edge(3), 1) => Some(2),
            (Self::Edge(3), 2) => Some(1),
            (_, 0..8) => Some(node),
            _ => None,
        }
    }
}
