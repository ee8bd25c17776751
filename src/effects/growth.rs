//! Delaminations that grow.

use super::NonlinearPlies;
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
pub struct GrowingDelaminations {
    /// The interfaces.
    pub interfaces: Interfaces,
    /// Whether plies follow laws beside them.
    pub plies: bool,
}

impl GrowingDelaminations {
    /// Its entry.
    pub const INFO: EffectInfo = EffectInfo {
        key: key("delamination", Form::PluginName(Kind::InterfaceLaw), r#""growth""#, "delaminations that grow"),
        source: "",
        columns: &[LOST, ALL, PROJECTED],
        advice: None,
    };

    /// The same beside plies that follow laws.
    pub const WITH_PLIES: EffectInfo =
        EffectInfo { columns: &[LOST, ALL, PROJECTED, NonlinearPlies::LOST], ..Self::INFO };
}

const LOST: LedgerColumn =
    LedgerColumn { name: "interface_dissipated_J", unit: "J", label: "lost in the interfaces", counts: true };
const ALL: LedgerColumn =
    LedgerColumn { name: "delaminated_m2", unit: "m^2", label: "delaminated, all interfaces", counts: false };
const PROJECTED: LedgerColumn =
    LedgerColumn { name: "projected_m2", unit: "m^2", label: "delaminated, projected", counts: false };

impl Effect for GrowingDelaminations {
    fn info(&self) -> &'static EffectInfo {
        if self.plies { &Self::WITH_PLIES } else { &Self::INFO }
    }

    fn values(&self, _: &ImpactSystem, state: &State, energies: &Energies) -> Vec<f64> {
        let points = &state.histories.points[..self.interfaces.states()];
        let all = self.interfaces.lost_area(points, Interfaces::BROKEN).into_values().sum();
        let projected = self.interfaces.projected_area(points, Interfaces::BROKEN);
        let lost = self.interfaces.dissipated(points).total();
        let mut values = vec![lost, all, projected];
        if self.plies {
            values.push(energies.plies - lost);
        }
        values
    }
}
