//! Plates that come apart on supports that give way, and on those that they lift off.

use super::scenes::{Plate, STRONG, apart, forces};
use crate::support::{impact_of, root};
use fem::analyses::impact::{self, Checkpoint, March, Outcome};
use fem::io::files::OutputDir;
use fem::io::scene;
use fem::job::{self, Found, Options, StaticFound};
use fem::{Model, Registry};
use std::num::NonZeroUsize;

const FULL: &str = "reduction = { method = 'none' }\n";
const REST: &str = "kind = 'rest', at = 'bottom', stiffness = '2e3 N/mm^2'";
const ROLLER: &str = "kind = 'roller', at = 'bottom', stiffness = '2e3 N/mm^2'";

/// One that nothing damages, and the same that could not come apart.
fn pair(hold: &'static str, step_us: f64) -> [Plate; 2] {
    let plate = || Plate { hold, step_us, material: STRONG, velocity: 1.0, end_us: 200, ..Plate::new() };
    [plate(), Plate { effects: "", delamination: String::new(), more: FULL, ..plate() }]
}

fn with_tip(plate: &Plate) -> Outcome {
    let text = plate.text().replace("patch_radius = '3 mm'", "tip_radius = '12 mm'");
    impact_of(scene::parse(&text, &root().join("scene.toml")).unwrap()).unwrap().1.outcome
}

/// Springs are part of K: what does not open is the elastic plate.
#[test]
fn springs_hold_what_may_open() {
    let [growth, elastic] = pair(ROLLER, 1.0).map(|plate| forces(&plate.outcome()));
    assert!(apart(&growth, &elastic) < 1e-9, "{}", apart(&growth, &elastic));
}

/// Springs that let go are a step late where interfaces may open, and exact in every step where none may: both meet as steps become short.
/// Their corners up, both are softer than what is held both ways.
#[test]
fn what_may_open_lifts_off_as_what_may_not() {
    let error = |step| {
        let [growth, elastic] = pair(REST, step).map(|plate| plate.outcome());
        assert!(growth.energy_error < 2e-3, "{step}: {}", growth.energy_error);
        apart(&forces(&growth), &forces(&elastic))
    };
    let [long, short] = [1.0, 0.25].map(error);
    assert!(long < 0.02 && short < 2e-3, "{long} {short}");
    let [held, lifted] = [ROLLER, REST].map(|hold| pair(hold, 1.0)[0].outcome());
    let softer = apart(&forces(&lifted), &forces(&held));
    assert!(long < 0.1 * softer && short < 0.4 * long, "{long} {short} {softer}");
}

/// The same on a support as hard as the plate itself, which it leaves with a rattle.
#[test]
fn it_lifts_off_a_hard_support() {
    let [growth, elastic] = pair("kind = 'rest'", 0.25).map(|plate| forces(&plate.outcome()));
    assert!(apart(&growth, &elastic) < 0.01, "{}", apart(&growth, &elastic));
}

/// Where some springs let go a plate bends, and is stretched, in other shapes. Against Newton's method with the strains of large deflections in
/// all cells: a plate that may open, and one that is reduced.
#[test]
fn what_lifts_off_is_stretched() {
    const SOFT: &str = "kind = 'rest', at = 'bottom', stiffness = '5e2 N/mm^2'";
    const REDUCED: &str = "reduction = { method = 'ritz', vectors = 60 }\n";
    let thin = |effects, delamination: &str, more| Plate {
        effects,
        delamination: delamination.into(),
        more,
        hold: SOFT,
        material: STRONG,
        ply_mm: 0.4,
        mass_kg: 0.5,
        step_us: 0.5,
        end_us: 240,
        ..Plate::new()
    };
    let stretched = |more| forces(&thin("membrane = 'on'", "", more).outcome());
    let (newton, reduced) = (stretched(FULL), stretched(REDUCED));
    let linear = forces(&thin("", "", FULL).outcome());
    let of_layers = "delamination = { penalty = '2e4 N/mm^3' }\n";
    let growth = forces(&thin("delamination = 'growth', membrane = 'on'", of_layers, "").outcome());
    let [far, of_reduced, of_growth] = [&linear, &reduced, &growth].map(|of| apart(of, &newton));
    assert!(far > 0.06 && of_reduced < 0.025 && of_growth < 0.025, "{far} {of_reduced} {of_growth}");
}

/// Any number of points, laws of plies beside them, a march that is resumed while springs have let go, two threads.
#[test]
fn a_plate_that_has_lifted_off_finds_every_bit_again() {
    let law = "law = { name = 'hahn-tsai', alpha = '2.44e-8 1/MPa^3' }\n";
    let material: &'static str =
        Box::leak(format!("library = 'IM7/8552'\nZt = '20 MPa'\nS13 = '25 MPa'\n{law}").into_boxed_str());
    let plate = Plate { hold: "kind = 'rest'", material, velocity: 5.0, end_us: 300, ..Plate::new() };
    // The whole of the lower face besides.
    let text = plate
        .text()
        .replace("support = [", "support = [{ group = 'plate', kind = 'rest', stiffness = '0.1 N/mm^3' }, ");
    let model = Model::new(scene::parse(&text, &root().join("scene.toml")).unwrap(), &Registry::standard()).unwrap();
    let prepared = |threads| impact::prepare(&model, NonZeroUsize::new(threads).unwrap()).unwrap();
    let straight = impact::march(prepared(1), |_| {}).unwrap();
    assert!(straight.stopped.is_none() && straight.energy_error < 5e-3, "{}", straight.energy_error);
    assert!(straight.delaminated.as_ref().unwrap().projected > 0.0);
    let found = |outcome: &Outcome| (forces(outcome), outcome.delaminated.clone());
    assert!(found(&impact::march(prepared(2), |_| {}).unwrap()) == found(&straight), "two threads");
    let folder = tempfile::tempdir().unwrap();
    let dir = OutputDir::create(folder.path().join("run")).unwrap();
    let mut march = March::start(prepared(1)).unwrap();
    (0..220).for_each(|_| march.advance());
    march.save(&dir).unwrap();
    let mut march = March::resume(prepared(1), Checkpoint::read(dir.path(), &model).unwrap()).unwrap();
    while !march.done() {
        march.advance();
    }
    assert!(found(&march.finish()) == found(&straight), "resumed");
}

/// Without inertia as well.
#[test]
fn tips_press_on_what_lifts_off() {
    let [growth, elastic] = pair(REST, 0.5).map(|plate| with_tip(&plate));
    let [patch, _] = pair(REST, 0.5).map(|plate| plate.outcome());
    let (near, far) = (apart(&forces(&growth), &forces(&elastic)), apart(&forces(&patch), &forces(&elastic)));
    assert!(near < 0.01 && far > 0.02, "{near} {far}");
    assert!(elastic.energy_error < 1e-3 && growth.energy_error < 1e-3, "{}", elastic.energy_error);
    // The quarter that is computed is that of the half, lifted springs and all.
    let whole = Plate { symmetry: "half-turn", ..pair(REST, 0.5).into_iter().nth(1).unwrap() };
    let apart = apart(&forces(&with_tip(&whole)), &forces(&elastic));
    assert!(apart < 1e-6, "{apart}");
    let slow = |effects| Plate {
        effects,
        mass_kg: 400.0,
        velocity: 0.05,
        end_us: 3000,
        step_us: 10.0,
        ..pair(REST, 1.0).into_iter().nth(1).unwrap()
    };
    let [with, without] = ["", "inertia = 'off'"].map(|effects| forces(&with_tip(&slow(effects))));
    let apart = super::scenes::apart(&without, &with);
    assert!(apart < 0.03, "{apart}");
}

/// Two tips on one plate: at one instant each has what the other leaves, and the energy stays.
#[test]
fn two_tips_share_what_lifts_off() {
    let plate = pair(REST, 0.5).into_iter().nth(1).unwrap();
    let one =
        "impactor = { mass = '1 kg', velocity = '1 m/s', at = { x = '24 mm', y = '20 mm' }, patch_radius = '3 mm' }";
    let two = [16, 32].map(|x| {
        format!("{{ mass = '0.5 kg', velocity = '1 m/s', at = {{ x = '{x} mm', y = '20 mm' }}, tip_radius = '12 mm' }}")
    });
    let text = plate.text().replace(one, &format!("impactor = [{}]", two.join(", ")));
    let whole = text.replace("symmetry = 'quarter'\n", "");
    let outcome = impact_of(scene::parse(&whole, &root().join("scene.toml")).unwrap()).unwrap().1.outcome;
    let force = |i: usize| outcome.history.iter().map(|row| row.impactors[i].contact_force_n).collect::<Vec<_>>();
    assert!(apart(&force(0), &force(1)) < 1e-6 && outcome.energy_error < 1e-3, "{}", outcome.energy_error);
    assert!(force(0).into_iter().fold(0.0, f64::max) > 100.0);
}

/// What gives no word elsewhere: a support so stiff that no step lets go of it, and one that may come apart with the plate.
#[test]
fn supports_that_mislead_are_told() {
    let model = |hold| pair(hold, 1.0)[0].model();
    let warned = |hold| model(hold).unwrap().warnings.iter().any(|text| text.contains("holds them down"));
    assert!(!warned("kind = 'rest'") && !warned("kind = 'roller', at = 'bottom', stiffness = '1e6 N/mm^2'"));
    assert!(warned("kind = 'rest', stiffness = '1e6 N/mm^2'"));
    let refused = format!("{:?}", model("kind = 'roller', stiffness = '5 N/mm^2'").map(|_| ()).unwrap_err());
    assert!(refused.contains("the mid-plane of a plate that may come apart"), "{refused}");
}

/// A plate that comes apart keeps its energy while it lifts off, and shorter steps find the same.
#[test]
fn what_comes_apart_lifts_off() {
    let [long, short] = [1.0, 0.5].map(|step_us| Plate { step_us, hold: "kind = 'rest'", ..Plate::new() }.outcome());
    let held = forces(&Plate::new().outcome());
    let lost = [&long, &short].map(|outcome| outcome.energy_error);
    assert!(lost[0] < 5e-3 && lost[1] < 0.5 * lost[0], "{lost:?}");
    let area = |outcome: &Outcome| outcome.delaminated.as_ref().unwrap().projected;
    assert!(
        area(&short) > 50e-6 && (area(&long) / area(&short) - 1.0).abs() < 0.06,
        "{} {}",
        area(&long),
        area(&short)
    );
    let (step, lifted) = (apart(&forces(&long), &forces(&short)), apart(&held, &forces(&long)));
    assert!(step < 0.05 && lifted > 2.0 * step, "{step} {lifted}");
}

/// A plate on a frame pressed in the middle, its corners up: what is followed through equilibria that might open is what is found at once.
#[test]
fn at_rest_what_may_open_lifts_off_as_what_may_not() {
    let solved = |growth: &str, path: &str| -> Box<StaticFound> {
        let sides =
            ["x-min", "x-max", "y-min", "y-max"].map(|side| format!("{{ group = '{side}', {REST} }}")).join(", ");
        let text = format!(
            "title = 'pressed'\nanalysis = 'static'\nmesh = {{ rectangle = ['48 mm', '40 mm'], cells = [12, 10] }}\n\
             symmetry = 'quarter'\nelement = {{ kind = 'hermite-prism' }}\neffects = {{ damage = 'off'{growth} }}\n\
             laminate = {{ plies = '[0/90/0]', material = 'tape', ply_thickness = '1 mm', layers = 3 }}\n\
             support = [{sides}, {{ restrain = 'rigid-motions' }}]\n\
             load = [{{ force = '1000 N', at = {{ x = '24 mm', y = '20 mm' }}, patch_radius = '3 mm' }}]\n{path}\
             [materials.tape]\n{STRONG}"
        );
        let scene = scene::parse(&text, &root().join("scene.toml")).unwrap();
        match job::run(&scene, &Registry::standard(), &Options::default(), &mut ()).unwrap().found {
            Found::Static(found) => found,
            other => panic!("{other:?}"),
        }
    };
    let at_once = solved("", "");
    let path = "path = { step = '10 mJ', until = '0.2 mm' }\n";
    let followed = solved(", delamination = 'growth'", path);
    let end = *followed.solution.followed.as_ref().unwrap().states.last().unwrap();
    assert!(end.displacement > 0.19e-3 && end.dissipated == 0.0, "{end:?}");
    // Springs without gaps: energies are half of force times displacement, whatever has let go.
    let compliance = 2.0 * at_once.solution.strain_energy / 1000.0_f64.powi(2);
    assert!(
        (end.displacement / end.force / compliance - 1.0).abs() < 1e-6,
        "{} {compliance}",
        end.displacement / end.force
    );
}
