//! Regions of a plate, which differ by their plies, and the cells over them.

use super::Plate;
use crate::contracts::element::Stack;
use crate::plates::error::PlateError;
use crate::plates::laminate::SAME_HEIGHT;
use std::ops::Range;

/// Layers of cells over a part of the plane.
#[derive(Debug, Clone)]
pub(super) struct Region {
    /// Heights of the faces of its layers, m.
    faces: Vec<f64>,
    /// The layer of the plate that is its lowest.
    first: usize,
    /// Plies of its layers, from the bottom.
    stacks: Vec<Stack>,
}

impl Region {
    /// # Errors
    /// Another number of stacks than of layers.
    pub(super) fn new(faces: Vec<f64>, stacks: Vec<Stack>) -> Result<Self, PlateError> {
        match faces.len() == stacks.len() + 1 {
            true => Ok(Self { faces, first: 0, stacks }),
            false => Err(PlateError::LayersOfRegion { layers: faces.len().max(1) - 1, of_region: stacks.len() }),
        }
    }

    fn layers(&self) -> Range<usize> {
        self.first..self.first + self.stacks.len()
    }
}

impl Plate {
    /// Gives the cells over `quads` plies of their own, one stack between two of `faces`: a region of the plate. Its faces lie at the
    /// heights of those of all others as far as both reach ([`Laminate::share_levels`](crate::plates::laminate::Laminate::share_levels)),
    /// so that layers side by side have their nodes in common; beyond, they are free. To be done before the plate is folded.
    ///
    /// # Errors
    /// Another number of layers than faces say, a face inside a layer of another region, a shell in several layers, more regions than
    /// can be counted.
    pub fn assign(&mut self, quads: &[u32], faces: Vec<f64>, stacks: Vec<Stack>) -> Result<(), PlateError> {
        if self.info().is_shell() && stacks.len() != 1 {
            return Err(PlateError::LayersOfShell);
        }
        let number = u16::try_from(self.regions.len()).map_err(|_| PlateError::TooManyRegions)?;
        self.regions.push(Region::new(faces, stacks)?);
        quads.iter().for_each(|quad| self.region_of[*quad as usize] = number);
        self.stack_up()?;
        self.number();
        Ok(())
    }

    /// Finds the levels, and where each region lies among them. All laminates of a shell are about one reference surface.
    pub(super) fn stack_up(&mut self) -> Result<(), PlateError> {
        let mut faces: Vec<f64> = Vec::new();
        let all = || self.regions.iter().flat_map(|region| region.faces.iter().copied());
        let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        let same = |a: f64, b: f64| (a - b).abs() <= SAME_HEIGHT * (high - low);
        match self.info().is_shell() {
            true => faces.extend([low, high]),
            false => all().for_each(|z| {
                if !faces.iter().any(|other| same(*other, z)) {
                    faces.push(z);
                }
            }),
        }
        faces.sort_by(f64::total_cmp);
        for (number, region) in self.regions.iter_mut().enumerate().filter(|_| !self.layouts[0].info.is_shell()) {
            region.first = faces.iter().position(|z| same(*z, region.faces[0])).unwrap_or(0);
            let here = faces.get(region.first..region.first + region.faces.len());
            if !here.is_some_and(|here| here.iter().zip(&region.faces).all(|(a, b)| same(*a, *b))) {
                return Err(PlateError::CutLayer { region: number });
            }
        }
        self.levels = match self.pitch {
            1 => faces,
            _ => {
                let middle = |pair: &[f64]| [pair[0], 0.5 * (pair[0] + pair[1])];
                faces.windows(2).flat_map(middle).chain(faces.last().copied()).collect()
            }
        };
        Ok(())
    }

    /// Number of layers of cells, those of all regions.
    pub fn layers(&self) -> usize {
        (self.levels.len() - 1) / self.pitch
    }

    /// Number of layers of cells over a quad.
    pub fn layers_over(&self, quad: usize) -> usize {
        self.region_over(quad).stacks.len()
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        (0..self.plane.quads.len()).map(|quad| self.layers_over(quad)).sum()
    }

    /// The cells.
    pub fn cell_numbers(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        (0..self.plane.quads.len()).flat_map(|quad| self.cells_over(quad))
    }

    /// The cells over a quad, from the bottom.
    pub fn cells_over(&self, quad: usize) -> Range<usize> {
        let layers = self.region_over(quad).layers();
        quad * self.layers() + layers.start..quad * self.layers() + layers.end
    }

    /// The cell over a quad in a layer, counted from the bottom there.
    pub fn cell_over(&self, quad: usize, layer: usize) -> usize {
        self.cells_over(quad).start + layer
    }

    /// Quad and layer of a cell, counted from the bottom there.
    pub fn place(&self, cell: usize) -> (usize, usize) {
        let (quad, layer) = (cell / self.layers(), cell % self.layers());
        (quad, layer - self.region_over(quad).first)
    }

    /// Cells that represent others or themselves alone, ascending, and how many they stand for.
    pub fn kept_cells(&self) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        self.symmetry.quads().flat_map(|(quad, weight)| self.cells_over(quad).map(move |cell| (cell, weight)))
    }

    /// Number of regions, which differ by their plies.
    pub fn regions(&self) -> usize {
        self.regions.len()
    }

    /// Region of a quad: 0 unless [`Plate::assign`] gave it another one.
    pub fn region(&self, quad: usize) -> usize {
        usize::from(self.region_of[quad])
    }

    fn region_over(&self, quad: usize) -> &Region {
        &self.regions[self.region(quad)]
    }

    /// Plies of the layers of a region, from its bottom.
    pub fn stacks(&self, region: usize) -> &[Stack] {
        &self.regions[region].stacks
    }

    /// Plies of a cell.
    pub(super) fn stack(&self, cell: usize) -> &Stack {
        let (quad, layer) = self.place(cell);
        &self.region_over(quad).stacks[layer]
    }

    /// Heights of the lower and the upper face of a cell, m.
    pub fn faces_of(&self, cell: usize) -> [f64; 2] {
        let (quad, layer) = self.place(cell);
        let region = self.region_over(quad);
        match self.info().is_shell() {
            true => [region.faces[0], region.faces[1]],
            false => [layer, layer + 1].map(|face| self.levels[(region.first + face) * self.pitch]),
        }
    }

    /// Heights of the lowest and the highest face of the plies over a quad, m.
    pub fn faces_over(&self, quad: usize) -> [f64; 2] {
        let cells = self.cells_over(quad);
        let at = |cell: usize, end: usize| self.cell(cell).position([0.0, 0.0, self.stack(cell).extent()[end]])[2];
        [at(cells.start, 0), at(cells.end - 1, 1)]
    }

    /// Whether two regions have their faces at the same heights.
    pub fn same_heights(&self, a: usize, b: usize) -> bool {
        let [a, b] = [a, b].map(|region| &self.regions[region].faces);
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| self.same_height(*a, *b))
    }

    /// Whether the faces of the plate have steps.
    pub fn is_stepped(&self) -> bool {
        let first = self.faces_over(0);
        let apart = |faces: [f64; 2]| (0..2).any(|end| !self.same_height(faces[end], first[end]));
        self.regions.len() > 1 && (1..self.plane.quads.len()).any(|quad| apart(self.faces_over(quad)))
    }

    /// Whether two heights are one but for rounding.
    pub fn same_height(&self, a: f64, b: f64) -> bool {
        (a - b).abs() <= 10.0 * SAME_HEIGHT * (self.levels[self.levels.len() - 1] - self.levels[0])
    }
}
