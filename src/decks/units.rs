//! Names of a deck's units, and what they are in SI units.

use crate::analyses::impact::ContactRecord;
use fem_core::material::{Elastic, Material, Strength, Strengths};
use fem_io::tables::{HistoryRow, ImpactorRow};

/// What the numbers of a deck are called: force, length and time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum UnitSystem {
    NewtonMillimetreSecond,
    NewtonMetreSecond,
    PoundInchSecond,
}

impl UnitSystem {
    /// All of them by the names of the command line.
    pub const ALL: [(&'static str, Self); 3] = [
        ("N-mm-s", Self::NewtonMillimetreSecond),
        ("N-m-s", Self::NewtonMetreSecond),
        ("lbf-in-s", Self::PoundInchSecond),
    ];

    /// Force, length.
    pub(super) fn names(self) -> [&'static str; 2] {
        match self {
            Self::NewtonMillimetreSecond => ["N", "mm"],
            Self::NewtonMetreSecond => ["N", "m"],
            Self::PoundInchSecond => ["lbf", "in"],
        }
    }

    /// Metres per length.
    pub(super) fn metres(self) -> f64 {
        match self {
            Self::NewtonMillimetreSecond => 1e-3,
            Self::NewtonMetreSecond => 1.0,
            Self::PoundInchSecond => 0.0254,
        }
    }
    /// Newtons per force.
    pub(super) fn newtons(self) -> f64 {
        match self {
            Self::NewtonMillimetreSecond | Self::NewtonMetreSecond => 1.0,
            Self::PoundInchSecond => 4.448_221_615_260_5,
        }
    }

    /// Pascals per stress.
    pub(super) fn pascals(self) -> f64 {
        self.newtons() / self.metres().powi(2)
    }

    /// Kilograms per mass, force time² per length.
    pub(super) fn kilograms(self) -> f64 {
        self.newtons() / self.metres()
    }

    /// A material in SI units.
    pub(super) fn material(self, own: &Material) -> Material {
        let (pressure, mut elastic) = (self.pascals(), own.elastic);
        let Elastic { e1, e2, e3, g12, g13, g23, .. } = &mut elastic;
        [e1, e2, e3, g12, g13, g23].into_iter().for_each(|modulus| *modulus *= pressure);
        let strengths = Strength::ALL.iter().fold(Strengths::default(), |all, which| {
            own.strengths.get(*which).map_or(all, |value| all.with(*which, value * pressure))
        });
        let density = own.density.map(|density| density * self.kilograms() / self.metres().powi(3));
        Material { elastic, strengths, density, ..own.clone() }
    }

    /// What a contact was, in SI units.
    pub(super) fn contact(self, own: &ContactRecord) -> ContactRecord {
        let (force, length) = (self.newtons(), self.metres());
        ContactRecord {
            force: (own.force.0 * force, own.force.1),
            power: own.power.map(|power| power * force.powi(2)),
            deepest: own.deepest * length,
            dent: own.dent * length,
            deflection: own.deflection * length,
            growth: own.growth.iter().map(|(t, deflection)| (*t, deflection * length)).collect(),
            ..own.clone()
        }
    }

    /// A row of a history in SI units.
    pub(super) fn row(self, own: &HistoryRow) -> HistoryRow {
        let (force, length, energy) = (self.newtons(), self.metres(), self.newtons() * self.metres());
        let impactor = |i: &ImpactorRow| ImpactorRow {
            contact_force_n: i.contact_force_n * force,
            impactor_displacement_m: i.impactor_displacement_m * length,
            impactor_velocity_m_s: i.impactor_velocity_m_s * length,
            plate_displacement_m: i.plate_displacement_m * length,
        };
        HistoryRow {
            time_s: own.time_s,
            impactors: own.impactors.iter().map(impactor).collect(),
            impactor_kinetic_j: own.impactor_kinetic_j * energy,
            plate_kinetic_j: own.plate_kinetic_j * energy,
            plate_strain_j: own.plate_strain_j * energy,
            contact_stored_j: own.contact_stored_j * energy,
            contact_dissipated_j: own.contact_dissipated_j * energy,
            effects: Vec::new(),
            energy_balance_j: own.energy_balance_j * energy,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pound_of_mass_is_what_it_weighs() {
        // 386.0886 in/s² of standard gravity, 0.45359237 kg in a pound.
        let pound = 1.0 / 386.088_582_677_165_35;
        assert!((UnitSystem::PoundInchSecond.kilograms() * pound / 0.453_592_37 - 1.0).abs() < 1e-14);
        assert!((UnitSystem::PoundInchSecond.pascals() / 6_894.757_293_168_361 - 1.0).abs() < 1e-14);
        assert!((UnitSystem::NewtonMillimetreSecond.kilograms() / 1e3 - 1.0).abs() < 1e-15);
    }
}
