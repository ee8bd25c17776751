//! The modal view of a march: what each mode of the reduced plate does (report eq. 43).

use fem_core::time::State;
use fem_dynamics::impact::ImpactSystem;
use fem_dynamics::reduce::Modal;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Least share of a mode in the static deflection; with less, the impact hardly excites it.
const EXCITED: f64 = 1e-3;

/// The lowest modes that the impact excites, over time.
///
/// The deflection under the impactor is the sum over all modes of Cᵢ(t) = φᵢ qᵢ(t), with qᵢ the coordinate of mode i at unit
/// modal mass and φᵢ its deflection there: whatever the length of the mode, Cᵢ is its part of the deflection, in m.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalHistory {
    /// The modes, by frequency.
    pub modes: Vec<ModeShare>,
    /// Cᵢ, m: one per mode for every row of the history.
    pub coordinates: Vec<f64>,
}

/// What one mode takes of the response.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(missing_docs, non_snake_case)]
pub struct ModeShare {
    pub frequency_Hz: f64,
    /// Its part of the deflection under a force at rest, φᵢ²/ωᵢ² of the sum over all modes.
    pub static_share: f64,
    /// Its part of the plate's strain energy, both averaged over time.
    pub strain_share: f64,
    /// The same of the kinetic energy.
    pub kinetic_share: f64,
    /// Largest |Cᵢ| of all steps.
    pub largest_m: f64,
}

/// Follows modes of a march.
#[derive(Debug)]
pub(super) struct ModalView {
    modes: Vec<Mode>,
    record: Record,
}

#[derive(Debug)]
struct Mode {
    /// Its number in the state.
    number: usize,
    omega: f64,
    /// Deflection under the impactor.
    phi: f64,
    static_share: f64,
}

/// What a modal view has seen.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Record {
    coordinates: Vec<f64>,
    /// Largest |Cᵢ|, m.
    largest: Vec<f64>,
    /// Sums over the steps of twice the strain and the kinetic energy of each mode, J.
    strain: Vec<f64>,
    kinetic: Vec<f64>,
    /// The same, once, of the plate.
    plate: [f64; 2],
}

impl ModalView {
    /// Follows the `count` lowest modes of `modal` that a contact of the weights `load` excites, if there are any.
    pub(super) fn new(modal: &Modal, load: &[f64], count: usize) -> Option<Self> {
        let all =
            || modal.frequencies().zip(load).enumerate().filter(|(_, (omega, _))| *omega > 0.0 && omega.is_finite());
        let flexibility = |omega: f64, phi: f64| (phi / omega).powi(2);
        let total: f64 = all().map(|(_, (omega, phi))| flexibility(omega, *phi)).sum();
        let mode = |(number, (omega, phi)): (usize, (f64, &f64))| Mode {
            number,
            omega,
            phi: *phi,
            static_share: flexibility(omega, *phi) / total,
        };
        let modes: Vec<Mode> = all().map(mode).filter(|mode| mode.static_share >= EXCITED).take(count).collect();
        let zeros = vec![0.0; modes.len()];
        let record = Record { largest: zeros.clone(), strain: zeros.clone(), kinetic: zeros, ..Record::default() };
        (!modes.is_empty()).then_some(Self { modes, record })
    }

    /// Takes a step.
    pub(super) fn step(&mut self, state: &State) {
        for (mode, largest) in self.modes.iter().zip(&mut self.record.largest) {
            *largest = largest.max((mode.phi * state.u[mode.number]).abs());
        }
    }

    /// Takes a row.
    pub(super) fn row(&mut self, state: &State) {
        self.record.coordinates.extend(self.modes.iter().map(|mode| mode.phi * state.u[mode.number]));
    }

    /// Takes the energies of the modes beside strain and kinetic energy of the `plate`, J, with a weight.
    pub(super) fn weigh(&mut self, state: &State, weight: f64, plate: [f64; 2]) {
        let Record { strain, kinetic, plate: sums, .. } = &mut self.record;
        for ((mode, strain), kinetic) in self.modes.iter().zip(strain).zip(kinetic) {
            let (q, rate) = (state.u[mode.number], state.v[mode.number]);
            *strain += weight * (mode.omega * q).powi(2);
            *kinetic += weight * (rate * rate);
        }
        sums.iter_mut().zip(plate).for_each(|(sum, energy)| *sum += weight * energy);
    }

    pub(super) fn record(&self) -> &Record {
        &self.record
    }

    /// Continues from what a view of the same modes has seen in so many rows; `false` where `record` is of another size.
    pub(super) fn resume(&mut self, record: Record, rows: usize) -> bool {
        let n = self.modes.len();
        let fits = record.coordinates.len() == n * rows
            && [&record.largest, &record.strain, &record.kinetic].iter().all(|each| each.len() == n);
        if fits {
            self.record = record;
        }
        fits
    }

    /// What was seen.
    pub(super) fn finish(self) -> ModalHistory {
        let Record { coordinates, largest, strain: of_strain, kinetic: of_kinetic, plate: [strain, kinetic] } =
            self.record;
        // Where a quotient of sums has no meaning, nothing has moved.
        let share = |twice: f64, total: f64| if total > 0.0 { 0.5 * twice / total } else { 0.0 };
        let modes = self.modes.iter().enumerate().map(|(i, mode)| ModeShare {
            frequency_Hz: mode.omega / TAU,
            static_share: mode.static_share,
            strain_share: share(of_strain[i], strain),
            kinetic_share: share(of_kinetic[i], kinetic),
            largest_m: largest[i],
        });
        ModalHistory { modes: modes.collect(), coordinates }
    }
}

/// The load of the impactor in modal coordinates, one weight per mode.
pub(super) fn load(system: &ImpactSystem) -> Vec<f64> {
    let mut load = vec![0.0; system.structure().ndof()];
    for (mode, weight) in &system.impactors()[0].load {
        load[*mode] += weight;
    }
    load
}
