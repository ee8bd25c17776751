//! Meshes with some of their cells left out.

use super::{Group, PlaneMesh, Sides};

impl PlaneMesh {
    /// The mesh without the cells that are `gone`, and without the nodes that only these have. A group all of whose cells are gone
    /// becomes the edge along which they met what stays; others keep what is left of them, which may be nothing.
    pub fn without(&self, gone: &[bool]) -> Self {
        let stays = |quad: usize| !gone.get(quad).is_some_and(|gone| *gone);
        let kept: Vec<usize> = (0..self.quads.len()).filter(|quad| stays(*quad)).collect();
        let mut node_of: Vec<Option<u32>> = vec![None; self.points.len()];
        kept.iter().flat_map(|quad| self.quads[*quad]).for_each(|node| node_of[node as usize] = Some(0));
        let nodes: Vec<usize> = (0..node_of.len()).filter(|node| node_of[*node].is_some()).collect();
        (0..).zip(&nodes).for_each(|(new, old)| node_of[*old] = Some(new));
        let mut quad_of: Vec<Option<u32>> = vec![None; self.quads.len()];
        (0..).zip(&kept).for_each(|(new, old)| quad_of[*old] = Some(new));

        let renumbered = |corners: super::Corners<u32>| corners.map(|node| node_of[node as usize].unwrap_or_default());
        let mut mesh = Self {
            points: nodes.iter().map(|node| self.points[*node]).collect(),
            node_tags: nodes.iter().map(|node| self.node_tags[*node]).collect(),
            quads: kept.iter().map(|quad| renumbered(self.quads[*quad])).collect(),
            quad_tags: kept.iter().map(|quad| self.quad_tags[*quad]).collect(),
            ..Self::default()
        };
        let sides = Sides::of(&mesh);
        let side = |ends: &[u32; 2]| {
            let [a, b] = ends.map(|node| node_of[node as usize]);
            let ends = [a?, b?];
            (sides.find(ends).is_some() || sides.opposite(ends).is_some()).then_some(ends)
        };
        let rest = |group: &Group| {
            let quads: Vec<u32> = group.quads.iter().filter_map(|quad| quad_of[*quad as usize]).collect();
            let mut edges: Vec<[u32; 2]> = group.edges.iter().filter_map(side).collect();
            if quads.is_empty() && !group.quads.is_empty() {
                edges = self.rim_of(group).iter().filter_map(side).collect();
            }
            let nodes = group.nodes.iter().filter_map(|node| node_of[*node as usize]).collect();
            Group { dim: group.dim, nodes, edges, quads }
        };
        let groups = self.groups.iter().map(|(name, group)| (name.clone(), rest(group))).collect();
        let bent = self.bends.iter().filter_map(|(ends, bend)| {
            let mut ends = side(ends)?;
            ends.sort_unstable();
            Some((ends, *bend))
        });
        let bends = bent.collect();
        mesh.groups = groups;
        mesh.bends = bends;
        mesh
    }
}
