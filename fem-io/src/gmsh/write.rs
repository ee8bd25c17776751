//! Writes meshes as MSH 4.1.

use std::collections::BTreeMap;
use std::io::{self, Write};

use fem_core::domain::Corners;
use fem_core::mesh::PlaneMesh;

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// As text, with as many digits as tell a number from its neighbours.
    Ascii,
    /// As they lie in memory, little-endian.
    Binary,
}

/// Writes a mesh in the format MSH 4.1, which gmsh and `fem_io::meshes::read` take; `unit_metres` is the length of the file's
/// unit (0.001 for mm).
///
/// Groups become physical groups, numbered from 1 in the order of their names. Cells, edges and nodes that belong to
/// the same groups are gathered in an entity. Nodes and cells keep their numbers, edges and points are numbered after
/// the cells. Where sides are bent, all are written with nodes in their middles, numbered after the others. Reading the file gives the mesh again, coordinates to the last bit where the unit has a number for them,
/// if every cell belongs to a group and groups that share edges have them in one order.
///
/// # Errors
/// Whatever `out` reports; numbers of nodes or cells that are 0 or occur twice.
pub fn write(out: &mut dyn Write, mesh: &PlaneMesh, unit_metres: f64, encoding: Encoding) -> io::Result<()> {
    for tags in [&mesh.node_tags, &mesh.quad_tags] {
        let mut sorted = tags.clone();
        sorted.sort_unstable();
        if sorted.first() == Some(&0) || sorted.windows(2).any(|pair| pair[0] == pair[1]) {
            let why = "numbers of nodes or cells are 0 or occur twice: renumber the mesh";
            return Err(io::Error::new(io::ErrorKind::InvalidData, why));
        }
    }
    let mut next = mesh.quad_tags.iter().max().map_or(1, |tag| tag.saturating_add(1));
    let nodes = Nodes::of(mesh);
    let entities: Vec<Entity> = (0..3).flat_map(|dim| entities(dim, elements(&nodes, dim, &mut next))).collect();
    let mut out = Numbers { out, binary: encoding == Encoding::Binary };
    out.text(&format!("$MeshFormat\n4.1 {} 8\n", u8::from(out.binary)))?;
    if out.binary {
        out.ints(&[1])?;
        out.end()?;
    }
    out.text(&format!("$EndMeshFormat\n$PhysicalNames\n{}\n", mesh.groups.len()))?;
    for (number, (name, group)) in (1..).zip(&mesh.groups) {
        out.text(&format!("{} {number} \"{name}\"\n", group.dim))?;
    }
    out.text("$EndPhysicalNames\n")?;
    write_entities(&mut out, &nodes, &entities, unit_metres)?;
    write_nodes(&mut out, &nodes, unit_metres)?;
    write_elements(&mut out, &nodes, &entities)
}

/// The nodes of a mesh, and those in the middles of all sides where any is bent.
struct Nodes<'m> {
    mesh: &'m PlaneMesh,
    /// Number of the node in the middle of each side, counted after the nodes of the mesh.
    middles: BTreeMap<[u32; 2], u32>,
    /// Their positions, m.
    positions: Vec<[f64; 2]>,
    /// Their first number in the file.
    first: u64,
}

impl<'m> Nodes<'m> {
    fn of(mesh: &'m PlaneMesh) -> Self {
        let first = mesh.node_tags.iter().max().map_or(1, |tag| tag.saturating_add(1));
        let mut nodes = Self { mesh, middles: BTreeMap::new(), positions: Vec::new(), first };
        let sides = mesh.quads.iter().flat_map(|quad| quad.sides()).filter(|_| !mesh.bends.is_empty());
        for side in sides.map(|[a, b]| [a.min(b), a.max(b)]) {
            nodes.middles.entry(side).or_insert_with(|| {
                let [p, q] = side.map(|n| mesh.points[n as usize]);
                let bend = mesh.bends.get(&side).copied().unwrap_or_default();
                nodes.positions.push([0, 1].map(|d| 0.5 * (p[d] + q[d]) + bend[d]));
                (mesh.points.len() + nodes.positions.len() - 1) as u32
            });
        }
        nodes
    }

    /// All positions with their numbers in the file.
    fn all(&self) -> impl Iterator<Item = (&[f64; 2], u64)> + Clone {
        let own = self.mesh.points.iter().zip(self.mesh.node_tags.iter().copied());
        own.chain(self.positions.iter().zip(self.first..))
    }

    fn position(&self, node: u32) -> [f64; 2] {
        let (node, own) = (node as usize, self.mesh.points.len());
        if node < own { self.mesh.points[node] } else { self.positions[node - own] }
    }

    fn tag(&self, node: u32) -> u64 {
        let own = self.mesh.points.len();
        self.mesh.node_tags.get(node as usize).copied().unwrap_or_else(|| self.first + (node as usize - own) as u64)
    }

    /// The middle of a side, if it has a node.
    fn middle(&self, [a, b]: [u32; 2]) -> Option<u32> {
        self.middles.get(&[a.min(b), a.max(b)]).copied()
    }
}

/// A point, an edge or a cell.
struct Element {
    tag: u64,
    nodes: Vec<u32>,
    /// Numbers of its groups.
    physical: Vec<i32>,
}

/// Elements of one dimension that belong to the same groups.
struct Entity {
    dim: u8,
    /// Number in its dimension.
    tag: i32,
    physical: Vec<i32>,
    elements: Vec<Element>,
}

/// All elements of a dimension; points and edges in the order in which groups name them, numbered from `next` on.
fn elements(all_nodes: &Nodes<'_>, dim: u8, next: &mut u64) -> Vec<Element> {
    let mesh = all_nodes.mesh;
    let middle = |side| all_nodes.middle(side);
    let mut all: Vec<Element> = Vec::new();
    if dim == 2 {
        let cell = |(quad, tag): (&Corners<u32>, &u64)| {
            let nodes = quad.into_iter().copied().chain(quad.sides().filter_map(middle)).collect();
            Element { tag: *tag, nodes, physical: Vec::new() }
        };
        all.extend(mesh.quads.iter().zip(&mesh.quad_tags).map(cell));
    }
    let mut known = BTreeMap::new();
    for (number, group) in (1..).zip(mesh.groups.values()).filter(|(_, group)| group.dim == dim) {
        for quad in &group.quads {
            all[*quad as usize].physical.push(number);
        }
        let points = group.nodes.iter().filter(|_| dim == 0).map(|node| vec![*node]);
        for nodes in points.chain(group.edges.iter().map(|edge| edge.iter().copied().chain(middle(*edge)).collect())) {
            let mut key = nodes.clone();
            key.sort_unstable();
            let element = *known.entry(key).or_insert_with(|| {
                all.push(Element { tag: *next, nodes, physical: Vec::new() });
                *next = next.saturating_add(1);
                all.len() - 1
            });
            all[element].physical.push(number);
        }
    }
    all
}

fn entities(dim: u8, elements: Vec<Element>) -> Vec<Entity> {
    let mut alike: BTreeMap<(Vec<i32>, u64), Vec<Element>> = BTreeMap::new();
    for element in elements {
        // A point of the format has one node, a block of elements one shape.
        let apart = if dim == 0 { element.tag } else { u64::from(element.nodes.len().is_multiple_of(3)) };
        alike.entry((element.physical.clone(), apart)).or_default().push(element);
    }
    let entity = |(tag, ((physical, _), elements))| Entity { dim, tag, physical, elements };
    (1..).zip(alike).map(entity).collect()
}

fn write_entities(out: &mut Numbers<'_>, nodes: &Nodes<'_>, entities: &[Entity], unit_metres: f64) -> io::Result<()> {
    out.text("$Entities\n")?;
    let count = |dim| entities.iter().filter(|entity| entity.dim == dim).count() as u64;
    out.sizes(&[count(0), count(1), count(2), 0])?;
    out.end_line()?;
    for entity in entities {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for node in entity.elements.iter().flat_map(|element| &element.nodes) {
            let [x, y] = nodes.position(*node).map(|x| convert(x, unit_metres));
            for (d, x) in [x, y, 0.0].into_iter().enumerate() {
                bounds[0][d] = bounds[0][d].min(x);
                bounds[1][d] = bounds[1][d].max(x);
            }
        }
        out.ints(&[entity.tag])?;
        out.write_doubles(&bounds.as_flattened()[..if entity.dim == 0 { 3 } else { 6 }])?;
        out.sizes(&[entity.physical.len() as u64])?;
        out.ints(&entity.physical)?;
        // Curves and surfaces do not say what bounds them.
        out.sizes(if entity.dim == 0 { &[] } else { &[0] })?;
        out.end_line()?;
    }
    out.end()?;
    out.text("$EndEntities\n")
}

fn write_nodes(out: &mut Numbers<'_>, nodes: &Nodes<'_>, unit_metres: f64) -> io::Result<()> {
    out.text("$Nodes\n")?;
    let count = nodes.all().count() as u64;
    let [low, high] = range(nodes.all().map(|(_, tag)| tag));
    out.sizes(&[1, count, low, high])?;
    out.end_line()?;
    // All on the first surface.
    out.ints(&[2, 1, 0])?;
    out.sizes(&[count])?;
    out.end_line()?;
    for (_, tag) in nodes.all() {
        out.sizes(&[tag])?;
        out.end_line()?;
    }
    for ([x, y], _) in nodes.all() {
        out.write_doubles(&[convert(*x, unit_metres), convert(*y, unit_metres), 0.0])?;
        out.end_line()?;
    }
    out.end()?;
    out.text("$EndNodes\n")
}

fn write_elements(out: &mut Numbers<'_>, nodes: &Nodes<'_>, entities: &[Entity]) -> io::Result<()> {
    out.text("$Elements\n")?;
    let all = || entities.iter().flat_map(|entity| &entity.elements);
    let [low, high] = range(all().map(|element| element.tag));
    out.sizes(&[entities.len() as u64, all().count() as u64, low, high])?;
    out.end_line()?;
    for entity in entities {
        // Numbers of the shapes of a point, edges, triangles and quadrilaterals.
        let shape = match (entity.dim, entity.elements.first().map_or(0, |element| element.nodes.len())) {
            (1, 2) => 1,
            (1, _) => 8,
            (2, 3) => 2,
            (2, 6) => 9,
            (2, 8) => 16,
            (2, _) => 3,
            _ => 15,
        };
        out.ints(&[i32::from(entity.dim), entity.tag, shape])?;
        out.sizes(&[entity.elements.len() as u64])?;
        out.end_line()?;
        for element in &entity.elements {
            out.sizes(&[element.tag])?;
            for node in &element.nodes {
                out.sizes(&[nodes.tag(*node)])?;
            }
            out.end_line()?;
        }
    }
    out.end()?;
    out.text("$EndElements\n")
}

fn range(tags: impl Iterator<Item = u64> + Clone) -> [u64; 2] {
    [tags.clone().min(), tags.max()].map(|tag| tag.unwrap_or(1))
}

/// A length in the file's unit: the number that is read as that length again, if one of the three nearest is.
fn convert(metres: f64, unit_metres: f64) -> f64 {
    let near = metres / unit_metres;
    [near, near.next_down(), near.next_up()].into_iter().find(|x| x * unit_metres == metres).unwrap_or(near)
}

/// Numbers as text, separated by spaces, or binary.
struct Numbers<'w> {
    out: &'w mut dyn Write,
    binary: bool,
}

impl Numbers<'_> {
    fn text(&mut self, text: &str) -> io::Result<()> {
        self.out.write_all(text.as_bytes())
    }

    fn sizes(&mut self, numbers: &[u64]) -> io::Result<()> {
        numbers
            .iter()
            .try_for_each(|n| if self.binary { self.out.write_all(&n.to_le_bytes()) } else { write!(self.out, "{n} ") })
    }

    fn ints(&mut self, numbers: &[i32]) -> io::Result<()> {
        numbers
            .iter()
            .try_for_each(|n| if self.binary { self.out.write_all(&n.to_le_bytes()) } else { write!(self.out, "{n} ") })
    }

    fn write_doubles(&mut self, numbers: &[f64]) -> io::Result<()> {
        numbers.iter().try_for_each(|x| {
            if self.binary { self.out.write_all(&x.to_le_bytes()) } else { write!(self.out, "{x:?} ") }
        })
    }

    /// Ends a line of text.
    fn end_line(&mut self) -> io::Result<()> {
        if self.binary { Ok(()) } else { self.text("\n") }
    }

    /// Ends a row of binary numbers.
    fn end(&mut self) -> io::Result<()> {
        if self.binary { self.text("\n") } else { Ok(()) }
    }
}
