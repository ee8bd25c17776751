//! Steps at and beyond their limits, stiff and soft contact, long and short marches.

use crate::case::{Case, Room};
use fem::Registry;
use fem::core::plugin::{Built, Kind, Params};
use fem::core::testkit::{Mode, Modes};
use fem::core::time::{Integrator, StepLimit};

pub(crate) fn cases() -> Vec<Case> {
    vec![Case {
        room: Room::Time,
        name: "just below the limit",
        varied: "every integrator; one oscillator, 1e6 steps of 0.999 of the limit, or of omega dt = 3 without one",
        measure: "largest energy of the second half of the march over that of the first, less 1",
        bound: 2.0,
        long: false,
        worst: below_the_limit,
    }]
}

fn integrators() -> impl Iterator<Item = Box<dyn Integrator>> {
    let registry = Registry::standard();
    let names: Vec<_> = registry.list(Kind::Integrator).map(|info| info.name).collect();
    names.into_iter().map(move |name| match registry.build(Kind::Integrator, name, &Params::default()) {
        Ok(Built::Integrator(integrator)) => integrator,
        other => panic!("{name}: {other:?}"),
    })
}

fn below_the_limit() -> f64 {
    let grown = integrators().map(|mut integrator| {
        let dt = match integrator.limit() {
            StepLimit::OmegaDt(limit) => 0.999 * limit,
            StepLimit::None => 3.0,
        };
        let mut system = Modes::free([Mode::new(1.0, 0.0)]);
        let mut state = system.state();
        state.v[0] = 1.0;
        integrator.start(&mut system, &mut state).unwrap();
        let mut largest = || {
            (0..500_000).fold(0.0_f64, |largest, _| {
                integrator.step(&mut system, &mut state, dt).unwrap();
                largest.max(state.u[0].powi(2) + state.v[0].powi(2))
            })
        };
        let first = largest();
        largest() / first - 1.0
    });
    grown.fold(0.0, f64::max)
}
