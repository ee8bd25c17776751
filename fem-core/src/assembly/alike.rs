//! Cells that share one matrix (the report's LAMCEL: a repeated cell is integrated once).

use crate::contracts::element::Stack;
use crate::plates::plate::Plate;
use std::collections::HashMap;

/// Classes of cells of equal shape, orientation and plies.
pub(super) struct Alike {
    /// Start of each class in `cells`, and their number at the end.
    starts: Vec<u32>,
    /// Cells by class, each class in the order of the plate, and how many each stands for.
    cells: Vec<(u32, f64)>,
}

/// Corners of the plane cell as seen from its first corner, the height, and how its sides are bent, in units of `GRAIN` of the
/// cell's size; which stack; and the size itself, as an exponent of 2.
type Shape = ([i64; 7], Option<[[i64; 2]; 4]>, usize, i32);

/// Shapes closer than this fraction of their size are equal: above the rounding of coordinates, far below what shows.
pub(super) const GRAIN: f64 = 1e-11;

impl Alike {
    pub(super) fn of(plate: &Plate) -> Self {
        let all: Vec<&Stack> = (0..plate.regions()).flat_map(|region| plate.stacks(region)).collect();
        let first = |s: &Stack| all.iter().position(|t| *t == s).unwrap_or(0);
        let of_region = |region| plate.stacks(region).iter().map(first).collect();
        let stacks: Vec<Vec<usize>> = (0..plate.regions()).map(of_region).collect();
        let mut numbers: HashMap<Shape, u32> = HashMap::new();
        let mut starts = vec![0];
        let kept = plate.kept_cells();
        let class: Vec<u32> = kept
            .clone()
            .map(|(cell, _)| {
                let number = numbers.len() as u32;
                let class = *numbers.entry(shape(plate, cell, &stacks)).or_insert(number);
                if class == number {
                    starts.push(0);
                }
                starts[class as usize + 1] += 1;
                class
            })
            .collect();
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut cells = vec![(0, 0.0); class.len()];
        for ((cell, weight), class) in kept.zip(class) {
            cells[fill[class as usize] as usize] = (cell as u32, weight);
            fill[class as usize] += 1;
        }
        Self { starts, cells }
    }

    /// Number of classes.
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of cells in all classes.
    pub(super) fn total(&self) -> usize {
        self.cells.len()
    }

    /// Cells of a class, and how many each stands for; never empty.
    pub(super) fn cells(&self, class: usize) -> &[(u32, f64)] {
        &self.cells[self.starts[class] as usize..self.starts[class + 1] as usize]
    }
}

fn shape(plate: &Plate, number: usize, stacks: &[Vec<usize>]) -> Shape {
    let (cell, (quad, layer)) = (plate.cell(number), plate.place(number));
    let p = cell.corners.four();
    let edges: [f64; 6] = std::array::from_fn(|i| p[1 + i / 2][i % 2] - p[0][i % 2]);
    let size = edges.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
    let exponent = size.log2().floor() as i32;
    let grain = f64::from(exponent).exp2() * GRAIN;
    let height = 2.0 * cell.half_height();
    let grains = |i: usize| (edges.get(i).copied().unwrap_or(height) / grain).round() as i64;
    let bends = cell.corners.bends().map(|bends| bends.four().map(|bend| bend.map(|b| (b / grain).round() as i64)));
    (std::array::from_fn(grains), bends, stacks[plate.region(quad)][layer], exponent)
}
