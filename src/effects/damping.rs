//! Viscous damping of the plate.

use super::OFF;
use crate::effect::{Body, Effect, EffectInfo, EffectPlugin, Exclusion, Feature, LedgerColumn, Marched, Wish};
use crate::error::Error;
use fem_core::damping::{Damping, Rayleigh};
use fem_core::plugin::Dimension;
use fem_core::time::State;
use fem_dynamics::impact::{Energies, ImpactSystem};
use fem_dynamics::reduce::Reduced;
use fem_io::scene::{Form, Keys, SceneError, SceneValue, key};

/// M ü + C u̇ + K u = f.
#[derive(Debug, Clone)]
pub struct ViscousDamping {
    damping: Damping,
    /// ζ of the lowest mode, where modes are known.
    lowest: Option<f64>,
    /// Time (s) and power lost (W) at the end of the step before; none before t = 0, when the plate rests.
    last: (f64, f64),
    /// Work lost, ∫ u̇ᵀ C u̇ dt by the trapezoidal rule, J.
    work: f64,
}

const KEYS: Keys = &[
    key("mass", Form::Quantity(Dimension::FREQUENCY), r#""30 1/s""#, "factor of the mass matrix"),
    key("stiffness", Form::Quantity(Dimension::TIME), r#""2e-8 s""#, "factor of the stiffness matrix"),
    key("ratio", Form::Number, "0.02", "of every mode to critical damping; needs a reduction to modes"),
];

impl EffectPlugin for ViscousDamping {
    const INFO: EffectInfo = EffectInfo {
        key: key(
            "damping",
            Form::OneOf(&[OFF, Form::Table(KEYS)]),
            r#"{ mass = "30 1/s", stiffness = "2e-8 s" }"#,
            "viscous damping C = mass M + stiffness K, or the same ratio for every mode of a reduced plate",
        )
        .default(r#""off""#),
        source: "Rayleigh 1877",
        columns: &[LedgerColumn { name: "damping_dissipated_J", unit: "J", label: "lost in damping", counts: true }],
        advice: None,
    };

    fn read(value: &SceneValue<'_>) -> Result<Wish, SceneError> {
        if value.is_text() {
            value.choice(&[("off", ())])?;
            return Ok(Wish::Off);
        }
        Ok(Wish::On(Box::new(Self { damping: read(value)?, lowest: None, last: (0.0, 0.0), work: 0.0 })))
    }
}

fn read(value: &SceneValue<'_>) -> Result<Damping, SceneError> {
    let table = value.table(KEYS)?;
    let [proportional, ratio] = match table.optional("mass") {
        Some(_) => table.either(["mass", "ratio"])?,
        None => table.either(["stiffness", "ratio"])?,
    };
    let factor = |key, dimension| table.optional(key).map_or(Ok(0.0), |field| field.positive(dimension));
    match (ratio, proportional) {
        (Some(ratio), _) => match ratio.number()? {
            value if value > 0.0 && value <= 1.0 => Ok(Damping::Ratio(value)),
            value => {
                let message = format!("{value} is not a ratio to critical damping");
                Err(ratio.error(message, "give a number between 0 and 1: ratio = 0.02"))
            }
        },
        (None, Some(_)) => Ok(Damping::Rayleigh(Rayleigh {
            mass: factor("mass", Dimension::FREQUENCY)?,
            stiffness: factor("stiffness", Dimension::TIME)?,
        })),
        (None, None) => Err(value.error(
            "does not say how much",
            "give `mass`, `stiffness` or both, C = mass M + stiffness K, or the `ratio` of every mode: { ratio = 0.02 }",
        )),
    }
}

impl Effect for ViscousDamping {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn excludes(&self) -> &'static [Exclusion] {
        const PROPORTIONAL: &[Exclusion] = &[Exclusion::new(
            Feature::NoImpact,
            "`effects.damping` needs an impact, and this analysis has none",
            "leave it out",
        )];
        const MODAL: &[Exclusion] = &[
            PROPORTIONAL[0],
            Exclusion::new(
                Feature::FullModel,
                "the ratio damps the modes of a reduced plate, and this plate is not reduced",
                "name a reduction, for example: reduction = { method = \"ritz\", vectors = 40 }; or give C = mass M + \
                 stiffness K: damping = { mass = \"30 1/s\", stiffness = \"2e-8 s\" }",
            ),
        ];
        if matches!(self.damping, Damping::Ratio(_)) { MODAL } else { PROPORTIONAL }
    }

    fn on_reduced(&mut self, reduced: &mut Reduced) {
        self.lowest = reduced.modal.lowest_frequency().map(|omega| self.damping.ratio(omega));
        reduced.modal.damp(self.damping);
    }

    fn on_structure(&mut self, _: &Body<'_>, plate: &mut Marched) -> Result<(), Error> {
        if let (None, Damping::Rayleigh(damping)) = (&plate.reduced, self.damping) {
            plate.full.damp(damping);
        }
        Ok(())
    }

    fn quantities(&self, _: &ImpactSystem) -> Vec<(&'static str, f64)> {
        self.lowest.map(|ratio| ("damping_ratio_of_lowest_mode", ratio)).into_iter().collect()
    }

    fn on_step(&mut self, system: &ImpactSystem, state: &State, work: &mut Vec<f64>) {
        let power = system.damping_power(state, work);
        let (before, lost) = self.last;
        self.work += 0.5 * (state.t - before) * (lost + power);
        self.last = (state.t, power);
    }

    fn lost(&self) -> f64 {
        self.work
    }

    fn values(&self, _: &ImpactSystem, _: &State, _: &Energies) -> Vec<f64> {
        vec![self.work]
    }

    fn saved(&self) -> Vec<f64> {
        vec![self.last.0, self.last.1, self.work]
    }

    fn resume(&mut self, saved: &[f64]) -> bool {
        let [time, power, work] = saved else { return false };
        (self.last, self.work) = ((*time, *power), *work);
        true
    }
}
