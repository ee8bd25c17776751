//! Masses that are singular, governors that depend on each other.

use crate::case::{Case, Room};
use crate::plates::{SOLIDS, model, nearest, on, said, with_nodes, worst};
use crate::scene::{AS4, Plate, Side, isotropic};
use fem::analyses::{assembled, impact, modes};
use fem::core::counters::Counters;
use fem::core::mesh::PlaneMesh;
use fem::core::plugin::{Built, Kind, Params, Value};
use fem::core::structure::Structure;
use fem::dynamics::reduce::Reduced;
use fem::{Model, NO_REDUCTION, Registry};
use std::fmt::Write as _;
use std::num::NonZeroUsize;

pub(super) fn cases() -> Vec<Case> {
    vec![
        Room::Algebra.case(
            "singular mass in impacts",
            "the linear mass; every reduction and integrator of the registry",
            "change of the impulse that the unreduced plate with the same mass gives, where the scene is not refused, nor stopped, by name",
            5e-2,
            impacts,
        )
        .long(),
        Room::Algebra.case(
            "singular mass in natural modes",
            "the linear mass of every element that has one, 1 to 12 modes",
            "change of the lowest frequency, with the regular mass",
            5e-2,
            natural_modes,
        ),
        Room::Algebra.case(
            "governors that depend on each other",
            "one twice, and two 1e-3 to 1e-8 of the plate apart; guyan and irs, by distance and by ratio",
            "choices that neither give the lowest frequency to 5 % nor are refused by the name of a governor",
            0.0,
            governors,
        ),
    ]
}

const SIDE: f64 = 20.0;
const LINEAR: &str = "kind = 'hermite-prism', mass = 'linear'";

fn clamped(element: &str) -> Plate {
    let mut plate = Plate::new(AS4, "[0/90]s", 0.25, vec![2, 2]).element(element).sides([Side::Free; 4]);
    for side in ["x-min", "x-max", "y-min", "y-max"] {
        let _ = writeln!(plate.more, "[[support]]\ngroup = '{side}'\nat = 'all'\nfix = ['U10', 'U20', 'U30']");
    }
    plate
}

/// The momentum that an impactor hands over, or why not.
fn impulse(reduction: &str, integrator: &str) -> Result<f64, String> {
    let mut plate = clamped(LINEAR).rectangle([SIDE; 2], [8; 2]);
    let _ = writeln!(
        plate.more,
        "[impactor]\nmass = '5 g'\nvelocity = '2 m/s'\nat = {{ x = '9 mm', y = '11 mm' }}\npatch_radius = '3 mm'\n[contact]\n\
         law = 'hertz'\nk = '1e8 N/m^1.5'\n[effects]\ndamage = 'off'\n[reduction]\nmethod = '{reduction}'\n\
         [march]\nintegrator = '{integrator}'\nstep = '0.5 us'\nend = '60 us'"
    );
    let model = model(&plate.text("impact")).unwrap();
    let prepared = impact::prepare(&model, NonZeroUsize::MIN).map_err(|e| said(&e))?;
    let outcome = impact::march(prepared, |_| {}).map_err(|e| said(&e))?;
    match outcome.stopped {
        Some(why) => Err(why),
        None => Ok(2.0 - outcome.history[outcome.history.len() - 1].impactors[0].impactor_velocity_m_s),
    }
}

fn names(kind: Kind) -> Vec<&'static str> {
    Registry::standard().list(kind).map(|info| info.name).collect()
}

fn impacts() -> f64 {
    let full = impulse(NO_REDUCTION, "newmark").unwrap();
    let mut all = Vec::new();
    for reduction in names(Kind::Reduction).into_iter().chain([NO_REDUCTION]) {
        for integrator in names(Kind::Integrator) {
            match impulse(reduction, integrator) {
                Ok(impulse) => all.push((impulse / full - 1.0).abs()),
                Err(why) => {
                    let limit = why.contains("stability limit");
                    let mass = why.contains("singular") && why.contains("has no inertia");
                    let energy = why.contains("the energy error is") && why.contains("shorten `march.step`");
                    assert!(limit || mass || energy, "{reduction}, {integrator}: {why}");
                }
            }
        }
    }
    worst(all)
}

fn natural_modes() -> f64 {
    let with_mass = names(Kind::Element)
        .into_iter()
        .filter(|name| Registry::standard().param(Kind::Element, name, "mass").is_some());
    worst(with_mass.flat_map(|kind| {
        let section = kind == "webster-beam";
        [1, 4, 12].map(|count| {
            let omega = |mass: &str| {
                let mut plate = Plate::new(&isotropic(70.0, 0.3, 2.7), "[0_2]", 0.5, vec![1, 1]);
                plate = plate.element(&format!("kind = '{kind}', mass = '{mass}'")).sides(match section {
                    true => [Side::Clamped, Side::Free, Side::Free, Side::Free],
                    false => [Side::Clamped, Side::Clamped, Side::Clamped, Side::Clamped],
                });
                let cells = if section { [24, 1] } else { [8, 8] };
                plate.rectangle([SIDE, if section { 1.0 } else { SIDE }], cells).frequencies(count)
            };
            let (linear, cubic) = (omega("linear"), omega("cubic"));
            // Its functions are linear in every cell: higher modes are as far off as a mesh of such cells lets them be.
            assert!(linear.iter().all(|omega| omega.is_finite() && *omega > 0.0), "{kind}: {linear:?}");
            (linear[0] / cubic[0] - 1.0).abs()
        })
    }))
}

/// The lowest frequency that a reduction on these governors gives, or why not.
fn lowest(model: &Model, method: &str, select: &str, candidates: &[usize]) -> Result<f64, String> {
    let mut params = Params::default();
    params.insert("governors", Value::Number(candidates.len() as f64));
    params.insert("select", Value::Text(select.into()));
    let Ok(Built::Reduction(reduction)) = Registry::standard().build(Kind::Reduction, method, &params) else {
        panic!("{method}")
    };
    let mut assembled = assembled::structure(model, true, NonZeroUsize::MIN, &mut Counters::default()).unwrap();
    let structure: &mut dyn Structure = &mut assembled.structure;
    let basis = reduction.basis(structure, &[], candidates).map_err(|e| e.to_string())?;
    let reduced = Reduced::project(structure, &basis).map_err(|e| e.to_string())?;
    Ok(reduced.modal.frequencies().next().unwrap())
}

fn governors() -> f64 {
    let mut wrong = 0;
    for apart in [0.0, 1e-3, 1e-5, 1e-7, 1e-8] {
        let lines = [0.0, 0.25, 0.5, 0.5 + if apart > 0.0 { apart } else { 0.1 }, 0.75, 1.0].map(|x| x * SIDE);
        let mesh = with_nodes(PlaneMesh::rectangle(&lines, &lines), "o", &[0]);
        let meshed = on(clamped(SOLIDS[0]), &mesh);
        let model = model(&meshed.plate.text("modes")).unwrap();
        let exact = modes::solve(&model, 1, NonZeroUsize::MIN).unwrap().modes.omega[0];
        let level = model.plate.mid_level().unwrap();
        let deflection = |at: [f64; 2]| {
            let node = nearest(&mesh, at.map(|x| x * SIDE)) as usize;
            let dof = model.plate.dofs_at(node, level, fem::core::dof::Dof::new(3, 0).unwrap()).next().unwrap();
            (model.constraints.position(dof).unwrap(), model.plate.describe(dof))
        };
        let (middle, beside) = (deflection([0.5; 2]), deflection([0.5 + apart, 0.5]));
        let around = [0.25, 0.5, 0.75].map(|x| [0.25, 0.5, 0.75].map(|y| [x, y]));
        let others = around.into_iter().flatten().map(|at| deflection(at).0).filter(|dof| *dof != middle.0);
        let candidates: Vec<usize> = others.chain([middle.0, beside.0]).collect();
        for method in ["guyan", "irs"] {
            for select in ["spread", "ratio"] {
                let right = match lowest(&model, method, select, &candidates) {
                    Ok(omega) => (omega / exact - 1.0).abs() < 0.05,
                    Err(why) => why.contains(&beside.1),
                };
                wrong += usize::from(!right);
            }
        }
    }
    wrong as f64
}
