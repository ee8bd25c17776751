//! What a mesh holds and how good its cells are.

use fem_core::domain;
use fem_core::mesh::{Group, PlaneMesh};
use serde::Serialize;
use std::fmt::Write as _;

/// A mesh in numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeshSummary {
    /// Number of nodes.
    pub nodes: usize,
    /// What the cells are called.
    #[serde(skip)]
    pub shape: &'static str,
    /// Number of cells.
    pub quads: usize,
    /// Sum of the areas of cells, m².
    pub area_m2: f64,
    /// Lower and upper corner of the bounding box, m.
    pub bounds_m: [[f64; 2]; 2],
    /// Shortest and longest edge of a cell, m.
    pub edges_m: [f64; 2],
    /// Shapes of the cells.
    pub quality: Quality,
    /// Groups by name.
    pub groups: Vec<GroupSummary>,
    /// What the reader of the file thinks the user should know.
    pub warnings: Vec<String>,
}

/// Shapes of cells.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quality {
    /// Smallest sine of an inner angle: 1 for rectangles.
    pub scaled_jacobian: Measure,
    /// Largest inner angle, degrees.
    pub largest_angle_deg: Measure,
    /// Longest over shortest edge.
    pub aspect: Measure,
}

/// A measure over all cells.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measure {
    /// Of the worst cell.
    pub worst: f64,
    /// Mean over the cells.
    pub mean: f64,
    /// Number of the worst cell in the mesh file.
    pub cell: u64,
    /// Its middle, m.
    pub at_m: [f64; 2],
}

/// A group of a mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupSummary {
    /// Its name.
    pub name: String,
    /// 0 nodes, 1 edges, 2 cells.
    pub dim: u8,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of edges of a group of dimension 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edges: Option<usize>,
    /// Length of its edges, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_m: Option<f64>,
    /// Number of cells of a group of dimension 2.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quads: Option<usize>,
    /// Area of its cells, m².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub area_m2: Option<f64>,
}

impl MeshSummary {
    /// Of a mesh with at least one cell.
    pub fn new(mesh: &PlaneMesh, warnings: Vec<String>) -> Self {
        let qualities: Vec<domain::CellQuality> = (0..mesh.quads.len()).map(|q| mesh.quality(q)).collect();
        let measure = |value: fn(&domain::CellQuality) -> f64, sense: f64| Measure::new(mesh, &qualities, value, sense);
        let (low, high) = mesh.bounds();
        let edges = mesh.quads.iter().flat_map(|q| q.sides().map(|side| length(mesh, side)));
        Self {
            nodes: mesh.points.len(),
            shape: mesh.name_of_cells(),
            quads: mesh.quads.len(),
            area_m2: mesh.area(),
            bounds_m: [low, high],
            edges_m: edges.fold([f64::INFINITY, 0.0], |[low, high], l| [low.min(l), high.max(l)]),
            quality: Quality {
                scaled_jacobian: measure(|q| q.scaled_jacobian, -1.0),
                largest_angle_deg: measure(|q| q.largest_angle.to_degrees(), 1.0),
                aspect: measure(|q| q.aspect, 1.0),
            },
            groups: mesh.groups.iter().map(|(name, group)| GroupSummary::new(mesh, name, group)).collect(),
            warnings,
        }
    }

    /// For people, lengths in `unit`, which is `metres` long.
    pub fn text(&self, unit: &str, metres: f64) -> String {
        let short = |x: f64| number(x / metres);
        let area = |x: f64| format!("{} {unit}2", number(x / metres / metres));
        let [[x0, y0], [x1, y1]] = self.bounds_m.map(|corner| corner.map(short));
        let [shortest, longest] = self.edges_m.map(short);
        let mut lines = vec![
            ("mesh", format!("{} {}, {} nodes, area {}", self.quads, self.shape, self.nodes, area(self.area_m2))),
            ("bounds", format!("x {x0} to {x1}, y {y0} to {y1} {unit}")),
            ("cells", format!("edges {shortest} to {longest} {unit}")),
        ];
        let Quality { scaled_jacobian, largest_angle_deg, aspect } = &self.quality;
        let measures =
            [("scaled Jacobian", scaled_jacobian), ("inner angle, degrees", largest_angle_deg), ("aspect", aspect)];
        for (k, (name, m)) in measures.into_iter().enumerate() {
            let [x, y] = m.at_m.map(short);
            let at = format!("cell {} at {x}, {y} {unit}", m.cell);
            let line = format!("{name:<21} {} at worst ({at}), {} in the mean", number(m.worst), number(m.mean));
            lines.push((if k == 0 { "quality" } else { "" }, line));
        }
        let widest = self.groups.iter().map(|g| g.name.chars().count()).max().unwrap_or(0);
        for (k, group) in self.groups.iter().enumerate() {
            let mut line = format!("{:<widest$}  ", group.name);
            // Nothing is lost: a text takes whatever is written.
            let _ = match (group.edges.zip(group.length_m), group.quads.zip(group.area_m2)) {
                (Some((n, l)), _) => write!(line, "{n} edges, {} nodes, length {} {unit}", group.nodes, short(l)),
                (_, Some((n, a))) => write!(line, "{n} {}, {} nodes, area {}", self.shape, group.nodes, area(a)),
                _ if group.nodes == 1 => write!(line, "1 node"),
                _ => write!(line, "{} nodes", group.nodes),
            };
            lines.push((if k == 0 { "groups" } else { "" }, line));
        }
        lines.extend(self.warnings.iter().map(|warning| ("warning", warning.clone())));
        lines.iter().map(|(what, text)| format!("  {what:<9} {text}\n")).collect()
    }
}

impl Measure {
    /// The worst is the largest of `sense` times the values.
    fn new(
        mesh: &PlaneMesh,
        qualities: &[domain::CellQuality],
        value: fn(&domain::CellQuality) -> f64,
        sense: f64,
    ) -> Self {
        let values = || qualities.iter().map(value);
        let (mut worst, mut quad) = (f64::NAN, 0);
        for (i, value) in values().enumerate() {
            if !(sense * value <= sense * worst) {
                (worst, quad) = (value, i);
            }
        }
        let corners = mesh.corners(quad);
        Self {
            worst,
            mean: values().sum::<f64>() / qualities.len() as f64,
            cell: mesh.quad_tags[quad],
            at_m: [0, 1].map(|d| corners.iter().map(|p| p[d]).sum::<f64>() / corners.len() as f64),
        }
    }
}

impl GroupSummary {
    fn new(mesh: &PlaneMesh, name: &str, group: &Group) -> Self {
        let (edges, quads) = (group.dim == 1, group.dim == 2);
        let area = || group.quads.iter().map(|q| mesh.quality(*q as usize).area).sum();
        Self {
            name: name.to_owned(),
            dim: group.dim,
            nodes: group.nodes.len(),
            edges: edges.then_some(group.edges.len()),
            length_m: edges.then(|| group.edges.iter().map(|edge| length(mesh, *edge)).sum()),
            quads: quads.then_some(group.quads.len()),
            area_m2: quads.then(area),
        }
    }
}

fn length(mesh: &PlaneMesh, edge: [u32; 2]) -> f64 {
    let [a, b] = edge.map(|n| mesh.points[n as usize]);
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// Five significant digits, no zeros behind the point.
fn number(x: f64) -> String {
    let digits = if x == 0.0 { 0 } else { 4 - x.abs().log10().floor() as i32 };
    let text = format!("{x:.*}", digits.clamp(0, 12) as usize);
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
