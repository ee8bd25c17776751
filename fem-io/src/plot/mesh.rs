//! A mesh with its groups.

use super::{Axis, Fill, MapCell, MapPlot, Panel, Stroke};
use fem_core::mesh::{Flaw, PlaneMesh};

/// The cells of `mesh` in mm with its groups in colours: edges as lines, nodes as dots, cells filled, unless they are all
/// there are. Crosses mark `impacts`, m, dots and crosses `flaws`, whose kinds have colours behind those of the groups.
///
/// Groups have their colours in the order of their names; those without anything in them are left out.
pub fn mesh_map(title: &str, mesh: &PlaneMesh, impacts: &[[f64; 2]], flaws: &[Flaw]) -> MapPlot {
    let mm = |p: [f64; 2]| p.map(|v| v * 1e3);
    let place = |n: u32| mm(mesh.points[n as usize]);
    let mut fills = vec![Fill::Blank; mesh.quads.len()];
    let mut panel = Panel::default();
    let mut classes = Vec::new();
    for (name, group) in &mesh.groups {
        let k = classes.len();
        match group.dim {
            0 => panel.dots.extend(group.nodes.iter().map(|n| (place(*n), k))),
            1 => panel.lines.extend(
                group
                    .edges
                    .iter()
                    .map(|edge| Stroke { points: mesh.along(*edge).into_iter().map(mm).collect(), class: k }),
            ),
            _ if group.quads.len() == mesh.quads.len() => continue,
            _ => group.quads.iter().for_each(|q| fills[*q as usize] = Fill::Class(k)),
        }
        classes.push(name.clone());
    }
    let cell = |(q, fill): (usize, Fill)| MapCell { corners: mesh.outline(q).into_iter().map(mm).collect(), fill };
    panel.cells = fills.into_iter().enumerate().map(cell).collect();
    for flaw in flaws {
        let name = flaw.kind.name();
        let k = classes.iter().position(|class| class == name).unwrap_or(classes.len());
        if k == classes.len() {
            classes.push(name.to_owned());
        }
        panel.dots.push((mm(flaw.at), k));
    }
    panel.crosses = impacts.iter().copied().chain(flaws.iter().map(|flaw| flaw.at)).map(mm).collect();
    let axis = |label: &str| Axis::linear(label, "mm");
    MapPlot {
        title: title.to_owned(),
        x: axis("x"),
        y: axis("y"),
        rows: Vec::new(),
        equal_aspect: true,
        scale: None,
        classes,
        outlines: Vec::new(),
        panels: vec![panel],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{class_color, map_plot};
    use fem_core::mesh::Group;

    #[test]
    fn groups_are_drawn_by_their_kind() {
        let mut mesh = PlaneMesh::rectangle(&[0.0, 1e-3, 2e-3], &[0.0, 1e-3]);
        mesh.groups.insert("patch".into(), Group { dim: 2, quads: vec![1], ..Group::default() });
        mesh.groups.insert("point".into(), Group { nodes: vec![4], ..Group::default() });
        let map = mesh_map("plate", &mesh, &[[0.5e-3, 0.5e-3]], &[]);
        assert_eq!(map.classes, ["patch", "point", "x-max", "x-min", "y-max", "y-min"]);
        let panel = &map.panels[0];
        assert_eq!((panel.cells[0].fill, panel.cells[1].fill), (Fill::Blank, Fill::Class(0)));
        assert_eq!((&panel.dots[..], &panel.crosses[..]), (&[([1.0, 1.0], 1)][..], &[[0.5, 0.5]][..]));
        // One edge at either end, two along either side.
        let edges = |k: usize| panel.lines.iter().filter(|line| line.class == k).count();
        assert_eq!([2, 3, 4, 5].map(edges), [1, 1, 2, 2]);
        let svg = map_plot(&map).unwrap().svg;
        for words in [">x-min<", ">patch<", &class_color(0), &class_color(5)] {
            assert!(svg.contains(words), "{words}");
        }
        assert!(!svg.contains(">plate</text>\n<text") && map.classes.iter().all(|name| name != "plate"));
    }
}
