//! Stresses of elements whose strains are cubic through the height of a cell.

use super::{Recovery, Station, points};
use crate::contracts::cubic_strains::{COEFFICIENTS, CubicStrains};
use crate::contracts::element::ElementError;
use crate::contracts::stack::Stack;
use crate::plates::plate::Plate;
use crate::words::tensor::apply;
use nalgebra::{DMatrixView, DMatrixViewMut, Dyn};

impl Recovery {
    /// [`Recovery::stresses`] from the coefficients of the strains: those of the cells over each source, their mean over each window,
    /// and by one product the stresses at all stations of a layer. `elements` are those of the sources.
    pub(super) fn stresses_of_cubics(
        &self,
        plate: &Plate,
        elements: &[&dyn CubicStrains],
        u: &[f64],
        fields: usize,
        out: &mut [f64],
    ) -> Result<(), ElementError> {
        let Some(element) = elements.first() else { return Ok(()) };
        let size = COEFFICIENTS * fields;
        let (firsts, coefficients) = self.coefficients(plate, elements, u, fields)?;
        let of_region =
            |(region, stations): (usize, &Vec<Station>)| operators(stations, plate.stacks(region), *element);
        let operators: Vec<_> = self.regions.iter().enumerate().map(of_region).collect();
        let apart = (Dyn(1), Dyn(6 * self.sites()));
        let mut mean = vec![0.0; size];
        for ((window, region), start) in self.windows.iter().zip(&self.region_of).zip(&self.starts) {
            let mut row = 6 * start;
            for (layer, operator) in operators[*region].iter().enumerate() {
                mean.fill(0.0);
                for (source, share) in window {
                    let of_source = &coefficients[(firsts[*source] + layer) * size..];
                    mean.iter_mut().zip(of_source).for_each(|(mean, c)| *mean += share * c);
                }
                let rows = operator.len() / COEFFICIENTS;
                let (operator, mean) = (view(operator, rows), view(&mean, COEFFICIENTS));
                let shape = (Dyn(rows), Dyn(fields));
                DMatrixViewMut::from_slice_with_strides_generic(&mut out[row..], shape.0, shape.1, apart.0, apart.1)
                    .gemm(1.0, &operator, &mean, 0.0);
                row += rows;
            }
        }
        Ok(())
    }

    /// Of each source the number of cells before it; coefficients of all cells over the sources, [`COEFFICIENTS`] × fields of each.
    fn coefficients(
        &self,
        plate: &Plate,
        elements: &[&dyn CubicStrains],
        u: &[f64],
        fields: usize,
    ) -> Result<(Vec<usize>, Vec<f64>), ElementError> {
        let (mut firsts, mut cells) = (Vec::new(), 0);
        for source in &self.sources {
            firsts.push(cells);
            cells += plate.cells_over(source.quad).len();
        }
        let mut coefficients = vec![0.0; COEFFICIENTS * fields * cells];
        let mut rest = coefficients.chunks_exact_mut((COEFFICIENTS * fields).max(1));
        let (mut operator, mut dofs, mut local) = (Vec::new(), Vec::new(), Vec::new());
        for (source, element) in self.sources.iter().zip(elements) {
            let info = plate.info_of(source.quad);
            let plane = points(info, *source);
            operator.resize(COEFFICIENTS * info.ndof(), 0.0);
            for (number, of_cell) in plate.cells_over(source.quad).zip(&mut rest) {
                element.coefficients(&plate.cell(number), &plane, &mut operator)?;
                plate.cell_dofs(number, &mut dofs);
                local.clear();
                local.extend(u.chunks_exact(plate.ndof()).flat_map(|u| dofs.iter().map(|dof| u[*dof])));
                let (operator, local) = (view(&operator, COEFFICIENTS), view(&local, dofs.len()));
                DMatrixViewMut::from_slice(of_cell, COEFFICIENTS, fields).gemm(1.0, &operator, &local, 0.0);
            }
        }
        Ok((firsts, coefficients))
    }
}

/// So many `rows`, column-major.
fn view(a: &[f64], rows: usize) -> DMatrixView<'_, f64> {
    DMatrixView::from_slice(a, rows, a.len() / rows.max(1))
}

/// Of each layer the stresses at its stations, on their axes, of the coefficients of its strains.
fn operators(stations: &[Station], stacks: &[Stack], element: &dyn CubicStrains) -> Vec<Vec<f64>> {
    let of_layer = |stations: &[Station]| {
        let rows = 6 * stations.len();
        let mut operator = vec![0.0; rows * COEFFICIENTS];
        for (at, station) in stations.iter().enumerate() {
            for (part, weight) in station.parts() {
                let shares = element.shares(&stacks[station.layer], &part);
                for (column, stresses) in operator.chunks_exact_mut(rows).enumerate() {
                    let stress = apply(&station.to_stress, &shares.map(|shares| weight * shares[column]));
                    stresses[6 * at..].iter_mut().zip(stress).for_each(|(sum, stress)| *sum += stress);
                }
            }
        }
        operator
    };
    stations.chunk_by(|a, b| a.layer == b.layer).map(of_layer).collect()
}
