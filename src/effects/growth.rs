//! Delaminations that grow.

use crate::effect::{Effect, EffectInfo, LedgerColumn};
use fem_core::interfaces::Interfaces;
use fem_core::plugin::Kind;
use fem_core::time::State;
use fem_dynamics::impact::{Energies, ImpactSystem};
use fem_io::scene::{Form, key};

/// What delaminations take, and how large they are.
///
/// A scene asks for them by `effects.delamination`, a setting of every scene, so that the registry does not have them; the plate is
/// another structure with them, not the same with an addition.
#[derive(Debug, Clone)]
pub struct GrowingDelaminations(pub Interfaces);

impl GrowingDelaminations {
    /// Share of its cohesion from which on a point counts as delaminated: all but the rounding of a law that tends to 1.
    pub const BROKEN: f64 = 0.99;

    /// Name of the column of what is lost in the interfaces.
    pub const LOST: &str = "interface_dissipated_J";

    /// Its entry.
    pub const INFO: EffectInfo = EffectInfo {
        key: key("delamination", Form::PluginName(Kind::InterfaceLaw), r#""growth""#, "delaminations that grow"),
        source: "",
        columns: &[
            LedgerColumn { name: Self::LOST, unit: "J", label: "lost in the interfaces", counts: true },
            LedgerColumn { name: "delaminated_m2", unit: "m^2", label: "delaminated, all interfaces", counts: false },
            LedgerColumn { name: "projected_m2", unit: "m^2", label: "delaminated, projected", counts: false },
        ],
        advice: None,
    };
}

impl Effect for GrowingDelaminations {
    fn info(&self) -> &'static EffectInfo {
        &Self::INFO
    }

    fn values(&self, _: &ImpactSystem, state: &State, energies: &Energies) -> Vec<f64> {
        let points = &state.histories.points;
        let all = self.0.lost_area(points, Self::BROKEN).into_values().sum();
        vec![energies.plies, all, self.0.projected_area(points, Self::BROKEN)]
    }
}
