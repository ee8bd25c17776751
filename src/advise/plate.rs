//! What the advisor knows of a plate under an impactor.

use super::held::Held;
use super::rim::Rim;
use crate::analyses::assembled::{self, Assembled};
use crate::error::Error;
use crate::model::{Model, Strike};
use fem_core::counters::Counters;
use fem_core::functional::Functional;
use fem_core::structure::Structure;
use std::num::NonZeroUsize;

/// Shear factor of a plate.
const KAPPA: f64 = 5.0 / 6.0;

/// A plate under an impactor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateConstants {
    /// Thickness, m.
    pub thickness: f64,
    /// Mass per area, kg/m².
    pub areal_mass: f64,
    /// D*, N m ([`fem_core::laminate::Laminate::effective_bending_stiffness`]).
    pub bending_stiffness: f64,
    /// Poisson's ratio of D averaged over all directions.
    pub poisson: f64,
    /// κ G h, N/m: G the mean of G13 and G23 over the plies.
    pub shear_stiffness: f64,
    /// Kb: force over deflection under the impactor at rest, N/m, of the model itself.
    pub stiffness: f64,
    /// Mass with which a plate that nothing holds under the impactor withstands its acceleration, kg; infinite of one that is
    /// held.
    pub free_mass: f64,
    /// The preload over the one that buckles it, if one is known.
    pub buckling: Option<f64>,
    /// What supports it.
    pub rim: Rim,
}

impl PlateConstants {
    /// Mass inside the supports, kg.
    pub fn mass(&self) -> f64 {
        self.areal_mass * self.rim.area
    }

    /// A of membrane stiffening; 0 where the supports do not surround the impact.
    pub fn membrane_coefficient(&self) -> f64 {
        self.rim.held.map_or(0.0, |held: Held| held.coefficient_beside(self.buckling))
    }

    /// A (w/h)² at a deflection w.
    pub fn stiffening(&self, deflection: f64) -> f64 {
        self.membrane_coefficient() * (deflection / self.thickness).powi(2)
    }

    pub(super) fn under(model: &Model, strike: &Strike, at_rest: &mut AtRest) -> Result<Self, Error> {
        let Model { laminate, materials, .. } = model;
        let rim = Rim::around(model, strike.centre)
            .ok_or_else(|| Error::NoPlate { element: model.origin.element.clone() })?;
        let d = laminate.bending_stiffness(materials);
        let (sum, mixed) = (d[(0, 0)] + d[(1, 1)], d[(0, 1)]);
        let twist = d[(2, 2)];
        let shear = laminate.plies.iter().map(|ply| {
            let elastic = &materials[ply.material].elastic;
            0.5 * (elastic.g13 + elastic.g23) * ply.thickness
        });
        Ok(Self {
            thickness: laminate.thickness(),
            areal_mass: model.areal_mass,
            bending_stiffness: laminate.effective_bending_stiffness(materials),
            poisson: (sum + 6.0 * mixed - 4.0 * twist) / (3.0 * sum + 2.0 * mixed + 4.0 * twist),
            shear_stiffness: KAPPA * shear.sum::<f64>(),
            stiffness: at_rest.stiffness(model, &strike.contact)?,
            free_mass: at_rest.free_mass(&strike.contact),
            buckling: at_rest.buckling(),
            rim,
        })
    }
}

/// A model at rest, or in the frame that moves with it: its stiffness, factorised.
pub(super) struct AtRest {
    assembled: Assembled,
}

impl AtRest {
    pub(super) fn of(model: &Model, strikes: &[Strike], threads: NonZeroUsize) -> Result<Self, Error> {
        let structure = |inertia: bool| assembled::structure(model, inertia, threads, &mut Counters::default());
        let assembled = structure(false)?;
        let moves = |strike: &Strike| assembled.structure.moves_under(&assembled.functional(&strike.contact));
        let moves = strikes.iter().any(moves);
        Ok(Self { assembled: if moves { structure(true)? } else { assembled } })
    }

    /// 1/Σ (wᵀ R)² over the free motions R of the plate.
    fn free_mass(&self, contact: &Functional) -> f64 {
        let structure = &self.assembled.structure;
        let contact = self.assembled.functional(contact);
        if !structure.moves_under(&contact) {
            return f64::INFINITY;
        }
        let motions = structure.free_motions().chunks_exact(structure.ndof().max(1));
        motions.map(|motion| contact.of(motion).powi(2)).sum::<f64>().recip()
    }

    /// Displacements of all independent unknowns under `load`.
    pub(super) fn displacements(&mut self, load: &[f64]) -> Result<Vec<f64>, Error> {
        let (mut on_masters, own) = self.assembled.load(load);
        self.assembled.structure.solve_shifted(0.0, &mut on_masters, 1)?;
        let mut u = self.assembled.expand(on_masters);
        u.iter_mut().zip(own.iter().flatten()).for_each(|(u, own)| *u += own);
        if u.iter().all(|u| u.is_finite()) { Ok(u) } else { Err(Error::NotFinite("displacement")) }
    }

    /// Force over deflection under a contact, N/m.
    pub(super) fn stiffness(&mut self, model: &Model, contact: &Functional) -> Result<f64, Error> {
        let mut load = vec![0.0; model.constraints.ndof()];
        contact.add_to(1.0, &mut load);
        let u = self.displacements(&load)?;
        Ok(1.0 / load.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>())
    }

    /// The preload over the one that buckles the plate, if one is known.
    pub(super) fn buckling(&self) -> Option<f64> {
        self.assembled.buckling
    }

    pub(super) fn factor_entries(&self) -> usize {
        self.assembled.factor_entries
    }
}
