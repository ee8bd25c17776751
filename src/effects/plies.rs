//! Plies that follow laws of their own, which their materials name.

use crate::effect::{Body, Effect, EffectInfo, LedgerColumn, Marched};
use crate::error::Error;
use fem_core::assembly::LawPlate;
use fem_core::laws::PlyLaws;
use fem_core::plugin::Kind;
use fem_core::time::State;
use fem_dynamics::impact::{Energies, ImpactSystem};
use fem_io::scene::{Form, key};

/// Internal forces of plies that follow laws, and what is lost in them.
///
/// A scene asks for it by the `law` of a material and not under `effects`, so that the registry does not have it.
#[derive(Debug, Clone)]
pub struct NonlinearPlies(pub PlyLaws);

impl NonlinearPlies {
    /// Its column.
    pub const LOST: LedgerColumn =
        LedgerColumn { name: "ply_dissipated_J", unit: "J", label: "lost in the plies", counts: true };

    /// Its entry.
    pub const INFO: EffectInfo = EffectInfo {
        key: key("law", Form::PluginName(Kind::PlyLaw), r#""hahn-tsai""#, "law of the plies of a material"),
        source: "",
        columns: &[Self::LOST],
        advice: None,
    };
}

impl Effect for NonlinearPlies {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn on_structure(&mut self, body: &Body<'_>, plate: &mut Marched) -> Result<(), Error> {
        let element = dyn_clone::clone_box(body.element);
        plate.full.follow(LawPlate::new(body.plate, element, body.constraints, self.0.clone()));
        Ok(())
    }

    fn values(&self, _: &ImpactSystem, _: &State, energies: &Energies) -> Vec<f64> {
        vec![energies.plies]
    }
}
