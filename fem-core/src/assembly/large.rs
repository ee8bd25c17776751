//! Internal forces and tangents of a plate under large deflections.

use super::cell_map::CellMap;
use super::{AssemblyError, Symmetric};
use crate::contracts::element::{Element, ElementError, Scratch, form};
use crate::contracts::large::LargeDeflection;
use crate::plates::constraint::Constraints;
use crate::plates::plate::Plate;

/// A plate whose cells take large deflections: f(ũ) = Cᵀ f(C ũ) and its derivative on the pattern of K.
///
/// Cells differ by their displacements, so that none is alike another; of those that a symmetry maps onto each other one
/// counts for all. Nothing is allocated after the first call.
#[derive(Debug, Clone)]
pub struct LargePlate {
    plate: Plate,
    element: Box<dyn Element>,
    constraints: Constraints,
    /// Cells, and how many each stands for, with their unknowns.
    cells: Vec<(usize, f64, CellMap)>,
    /// Stiffness beside that of the cells, if there is some.
    beside: Option<Symmetric>,
    /// Its forces.
    turned: Vec<f64>,
    /// Displacements before elimination.
    all: Vec<f64>,
    work: CellArrays,
    integrated: u64,
}

/// Arrays of a cell.
#[derive(Debug, Clone, Default)]
struct CellArrays {
    u: Vec<f64>,
    force: Vec<f64>,
    tangent: Vec<f64>,
    scratch: Scratch,
}

impl LargePlate {
    /// `None` where the element does not support large deflections.
    pub fn new(plate: &Plate, element: Box<dyn Element>, constraints: &Constraints) -> Option<Self> {
        for domain in plate.plane.quads.iter().map(|quad| quad.domain()) {
            form(&*element, domain).large_deflections()?;
        }
        let cells = plate.kept_cells().map(|(cell, weight)| {
            let mut map = CellMap::default();
            map.set(plate, constraints, cell);
            (cell, weight, map)
        });
        Some(Self {
            cells: cells.collect(),
            plate: plate.clone(),
            element,
            constraints: constraints.clone(),
            beside: None,
            turned: Vec::new(),
            all: vec![0.0; plate.ndof()],
            integrated: 0,
            work: CellArrays::default(),
        })
    }

    /// Gives the plate more stiffness, on the pattern of K: that of springs, or of stresses that are in balance at rest.
    pub fn carry(&mut self, more: &Symmetric) {
        match &mut self.beside {
            Some(beside) => beside.add(1.0, more),
            None => self.beside = Some(more.clone()),
        }
    }

    /// Number of independent unknowns.
    pub fn ndof(&self) -> usize {
        self.constraints.ndof()
    }

    /// Cells that are integrated for each force.
    pub fn cells(&self) -> usize {
        self.cells.len()
    }

    /// Cells integrated so far.
    pub fn integrated(&self) -> u64 {
        self.integrated
    }

    /// Internal force at the independent displacements `u`, and the tangent on the pattern of K where it is asked for; returns
    /// the strain energy, J.
    ///
    /// # Errors
    /// A cell that the element refuses, displacements that are not finite.
    pub fn internal(
        &mut self,
        u: &[f64],
        force: &mut [f64],
        mut tangent: Option<&mut Symmetric>,
    ) -> Result<f64, AssemblyError> {
        let Self { plate, element, constraints, cells, beside, turned, all, work, integrated } = self;
        *integrated += cells.len() as u64;
        constraints.expand(u, all);
        force.fill(0.0);
        if let Some(tangent) = &mut tangent {
            tangent.lower_mut().val_mut().fill(0.0);
        }
        let mut energy = 0.0;
        for (cell, weight, map) in cells {
            let failed = |error| {
                let (quad, layer) = plate.place(*cell);
                AssemblyError { quad_tag: plate.plane.quad_tags[quad], layer, error }
            };
            let element = form(&**element, plate.plane.quads[plate.place(*cell).0].domain());
            let Some(large) = element.large_deflections() else { continue };
            work.resize(element.info().ndof());
            let one = work.integrate(large, plate, *cell, map, all, tangent.is_some()).map_err(failed)?;
            if !one.is_finite() {
                return Err(failed(ElementError("its strain energy is not finite".into())));
            }
            energy += *weight * one;
            map.scatter_vector(&work.force, *weight, force);
            if let Some(tangent) = &mut tangent {
                map.scatter(&work.tangent, *weight, tangent);
            }
        }
        if let Some(beside) = beside {
            turned.clear();
            turned.resize(u.len(), 0.0);
            beside.add_product(1.0, u, turned);
            force.iter_mut().zip(&*turned).for_each(|(force, more)| *force += more);
            energy += 0.5 * u.iter().zip(&*turned).map(|(u, f)| u * f).sum::<f64>();
            tangent.iter_mut().for_each(|tangent| tangent.add(1.0, beside));
        }
        Ok(energy)
    }
}

impl CellArrays {
    fn resize(&mut self, n: usize) {
        self.u.resize(n, 0.0);
        self.force.resize(n, 0.0);
        self.tangent.resize(n * n, 0.0);
    }

    fn integrate(
        &mut self,
        large: &dyn LargeDeflection,
        plate: &Plate,
        cell: usize,
        map: &CellMap,
        all: &[f64],
        tangent: bool,
    ) -> Result<f64, ElementError> {
        let Self { u, force, tangent: matrix, scratch } = self;
        map.gather(all, u);
        large.internal(&plate.cell(cell), u, scratch, force, tangent.then_some(matrix))
    }
}
