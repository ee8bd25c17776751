//! Plates that stiffen as they deflect.

use super::TOLERANCE;
use crate::case::{Case, Room};
use crate::support::root;
use fem::analyses::impact::{self, Outcome, Prepared};
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

pub(super) fn cases() -> Vec<Case> {
    let time = Room::Time;
    vec![
        time.case(
            "large deflections in implicit steps",
            "reduced and full plates, [0/90]s, [0/90], [0_2/90/45]; w/h of 1.5 to 9; steps of 2 to 10 us",
            "energy error",
            1e-3,
            implicit,
        ),
        time.case(
            "large deflections in long implicit steps",
            "the same plates, w/h of 0.5 and 1.7; steps of 50 us, a fourteenth of the lowest period",
            "energy error",
            TOLERANCE,
            long_steps,
        ),
        time.case(
            "energy-conserving: large deflections",
            "reduced and full plates, [0/90]s, [0_2/90/45]; w/h of 1.5 to 9; steps of 2 to 50 us",
            "energy error",
            1e-10,
            conserving,
        ),
        time.case(
            "large deflections in explicit steps",
            "central-difference, rk4; 0.9 of the limit of the plate at rest; w/h of 1.5 to 4",
            "energy error",
            1e-3,
            explicit,
        ),
        time.case(
            "reduced symmetric plate that stiffens",
            "[0/90]s; w/h of 0.7, 1.5, 3.6",
            "error of the deflection against the full plate (L2)",
            1e-2,
            || reduced(&[SYMMETRIC]),
        ),
        time.case(
            "reduced unsymmetric plate that stiffens",
            "[0/90], [0_2/90/45]; w/h of 0.8, 1.8, 3.9",
            "error of the deflection against the full plate (L2)",
            2e-2,
            || reduced(&[CROSSED, MIXED]),
        ),
        time.case(
            "deflections too small to stiffen",
            "velocities of 1e-6, 1e-4, 1e-3 m/s; reduced and full",
            "change of the force by membrane stiffening (L2)",
            1e-5,
            small,
        ),
    ]
}

struct Plate {
    plies: &'static str,
    ply_mm: f64,
    velocity: f64,
    reduction: &'static str,
    integrator: &'static str,
    step_us: f64,
    membrane: &'static str,
}

const FULL: &str = "method = 'none'";
const RITZ: &str = "method = 'ritz', vectors = 60";

const SYMMETRIC: Plate = Plate {
    plies: "[0/90]s",
    ply_mm: 0.25,
    velocity: 2.5,
    reduction: RITZ,
    integrator: "newmark",
    step_us: 4.0,
    membrane: "on",
};
const CROSSED: Plate = Plate { plies: "[0/90]", ply_mm: 0.5, ..SYMMETRIC };
const MIXED: Plate = Plate { plies: "[0_2/90/45]", ..SYMMETRIC };

impl Plate {
    /// `look` at the scene as it is prepared for.
    fn with<T>(&self, look: impl FnOnce(Prepared<'_>) -> T) -> T {
        let Self { plies, ply_mm, velocity, reduction, integrator, step_us, membrane } = self;
        let edge = |side: &str| format!("[[support]]\ngroup = '{side}'\nat = 'all'\nfix = ['U10', 'U20', 'U30']\n");
        let text = format!(
            "title = 'large'\nmesh = {{ rectangle = ['60 mm', '40 mm'], cells = [12, 8] }}\nelement = {{ kind = 'mitc4' }}\n\
             impactor = {{ mass = '0.2 kg', velocity = '{velocity} m/s', patch_radius = '4 mm', at = {{ x = '30 mm', y = '20 mm' }} }}\n\
             contact = {{ law = 'hertz', k = '1e4 N/mm^1.5' }}\neffects = {{ damage = 'off', membrane = '{membrane}' }}\n\
             reduction = {{ {reduction} }}\nmarch = {{ integrator = '{integrator}', step = '{step_us} us', end = '1.2 ms' }}\n\
             laminate = {{ plies = '{plies}', material = 'tape', ply_thickness = '{ply_mm} mm', layers = 1 }}\n\
             [materials.tape]\nlibrary = 'AS4/3502'\n{}",
            ["x-min", "x-max", "y-min", "y-max"].map(edge).concat()
        );
        let model =
            Model::new(scene::parse(&text, &root().join("scene.toml")).unwrap(), &Registry::standard()).unwrap();
        look(impact::prepare(&model, NonZeroUsize::MIN).unwrap())
    }

    fn march(&self) -> Outcome {
        self.with(|prepared| impact::march(prepared, |_| {}).unwrap())
    }

    /// Error of the energy of a march that gets to its end.
    fn energy_error(&self) -> f64 {
        let outcome = self.march();
        assert_eq!(outcome.stopped, None);
        outcome.energy_error
    }
}

fn worst(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |worst, value| if value > worst || value.is_nan() { value } else { worst })
}

fn implicit() -> f64 {
    let each = [SYMMETRIC, CROSSED, MIXED].into_iter().flat_map(|plate| {
        let runs = [(2.5, 2.0, RITZ), (2.5, 10.0, RITZ), (20.0, 2.0, RITZ), (80.0, 2.0, RITZ), (20.0, 2.0, FULL)];
        runs.map(|(velocity, step_us, reduction)| Plate { velocity, step_us, reduction, ..plate }.energy_error())
    });
    worst(each)
}

fn long_steps() -> f64 {
    let each = [SYMMETRIC, CROSSED, MIXED].into_iter();
    worst(each.flat_map(|plate| [0.5, 2.5].map(|velocity| Plate { velocity, step_us: 50.0, ..plate }.energy_error())))
}

fn conserving() -> f64 {
    let each = [SYMMETRIC, MIXED].into_iter().flat_map(|plate| {
        let runs = [(2.5, 50.0, RITZ), (80.0, 2.0, RITZ), (20.0, 20.0, FULL)];
        let plate = Plate { integrator: "energy-conserving", ..plate };
        runs.map(|(velocity, step_us, reduction)| Plate { velocity, step_us, reduction, ..plate }.energy_error())
    });
    worst(each)
}

fn explicit() -> f64 {
    let each =
        [("central-difference", 2.5), ("central-difference", 15.0), ("rk4", 15.0)].map(|(integrator, velocity)| {
            let plate =
                Plate { integrator, velocity, step_us: 1e-3, reduction: "method = 'ritz', vectors = 12", ..SYMMETRIC };
            let limit = plate.with(|prepared| prepared.sizes.longest_step);
            Plate { step_us: 0.9e6 * limit, ..plate }.energy_error()
        });
    worst(each.into_iter())
}

fn deflections(plate: &Plate) -> Vec<f64> {
    plate.march().history.iter().map(|row| row.impactors[0].plate_displacement_m).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let square = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>();
    (square(&mut a.iter().zip(b).map(|(a, b)| a - b)) / square(&mut b.iter().copied())).sqrt()
}

fn reduced(plates: &[Plate]) -> f64 {
    let each = plates.iter().flat_map(|plate| {
        [0.8, 2.5, 12.0].map(|velocity| {
            let of = |reduction| deflections(&Plate { velocity, reduction, ..*plate });
            apart(&of(RITZ), &of(FULL))
        })
    });
    worst(each)
}

fn small() -> f64 {
    let forces = |velocity, reduction, membrane| -> Vec<f64> {
        let outcome = Plate { velocity, reduction, membrane, ..SYMMETRIC }.march();
        outcome.history.iter().map(HistoryRow::contact_force_n).collect()
    };
    let change = |velocity, reduction| apart(&forces(velocity, reduction, "on"), &forces(velocity, reduction, "off"));
    worst([RITZ, FULL].into_iter().flat_map(|reduction| [1e-6, 1e-4, 1e-3].map(|velocity| change(velocity, reduction))))
}
