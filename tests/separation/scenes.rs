//! Delaminations that grow, as scenes ask for them.

use crate::support::{impact_of, root};
use fem::analyses::delamination::Delaminated;
use fem::analyses::impact::{self, Checkpoint, March, Outcome};
use fem::io::files::OutputDir;
use fem::io::scene;
use fem::{Error, Model, Registry};
use std::f64::consts::PI;
use std::num::NonZeroUsize;

/// Three plies of two kinds, 48 mm by 40 mm, unless said otherwise 3 mm thick and simply supported, under 1 kg.
pub(super) struct Plate {
    pub(super) effects: &'static str,
    pub(super) delamination: String,
    pub(super) symmetry: &'static str,
    pub(super) plies: &'static str,
    pub(super) ply_mm: f64,
    pub(super) material: &'static str,
    pub(super) mass_kg: f64,
    pub(super) velocity: f64,
    pub(super) step_us: f64,
    pub(super) end_us: u32,
    pub(super) hold: &'static str,
    pub(super) more: &'static str,
}

/// Interfaces weak enough to soften over several cells.
const TAPE: &str = "library = 'IM7/8552'\nZt = '20 MPa'\nS13 = '25 MPa'\n";
/// A resin that no impact of these tests damages.
pub(super) const STRONG: &str =
    "library = 'IM7/8552'\nZt = '1 GPa'\nS13 = '1 GPa'\nGIc = '900 kJ/m^2'\nGIIc = '900 kJ/m^2'\n";
const GROWTH: &str = "delamination = 'growth'";
/// What the growth lays over a preset, for a scene without it.
const ALIKE: &str = "reduction = { method = 'none' }\n";

impl Plate {
    pub(super) fn new() -> Self {
        let delamination = "delamination = { penalty = '2e4 N/mm^3' }\n".into();
        Self {
            effects: GROWTH,
            delamination,
            symmetry: "quarter",
            plies: "[0/90/0]",
            ply_mm: 1.0,
            material: TAPE,
            mass_kg: 1.0,
            velocity: 3.0,
            step_us: 1.0,
            end_us: 400,
            hold: "at = 'bottom', fix = ['U30']",
            more: "",
        }
    }

    fn elastic() -> Self {
        Self { effects: "", delamination: String::new(), more: ALIKE, ..Self::new() }
    }

    pub(super) fn text(&self) -> String {
        let Self { effects, delamination, symmetry, plies, ply_mm, material, mass_kg, velocity, .. } = self;
        let Self { step_us, end_us, hold, more, .. } = self;
        let edges =
            ["x-min", "x-max", "y-min", "y-max"].map(|edge| format!("{{ group = '{edge}', {hold} }}")).join(", ");
        format!(
            "title = 'growth'\nmesh = {{ rectangle = ['48 mm', '40 mm'], cells = [12, 10] }}\nsymmetry = '{symmetry}'\n\
             element = {{ kind = 'hermite-prism' }}\neffects = {{ damage = 'off', {effects} }}\n{delamination}\
             support = [{edges}, {{ restrain = 'rigid-motions' }}]\n\
             impactor = {{ mass = '{mass_kg} kg', velocity = '{velocity} m/s', at = {{ x = '24 mm', y = '20 mm' }}, \
             patch_radius = '3 mm' }}\ncontact = {{ law = 'hertz', k = '4e9 N/m^1.5' }}\n\
             march = {{ integrator = {{ name = 'generalized-alpha', rho = 0.5 }}, step = '{step_us} us', end = '{end_us} us' }}\n\
             laminate = {{ plies = '{plies}', material = 'tape', ply_thickness = '{ply_mm} mm', layers = 3 }}\n\
             output = {{ history_every = '4 us' }}\n{more}[materials.tape]\n{material}"
        )
    }

    pub(super) fn model(&self) -> Result<Model, Error> {
        Model::new(scene::parse(&self.text(), &root().join("scene.toml"))?, &Registry::standard())
    }

    pub(super) fn outcome(&self) -> Outcome {
        impact_of(scene::parse(&self.text(), &root().join("scene.toml")).unwrap()).unwrap().1.outcome
    }

    #[track_caller]
    fn refused(&self, words: &[&str]) {
        let error = self.model().map(|_| ()).expect_err("it is refused");
        let report = format!("{:?}", miette::Report::new(error));
        let said: String = report.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        for word in words {
            assert!(said.contains(word), "{word:?} is not in {said}");
        }
    }
}

pub(super) fn forces(outcome: &Outcome) -> Vec<f64> {
    outcome.history.iter().map(|row| row.impactors[0].contact_force_n).collect()
}

/// Root of the sum of squared differences over that of squares.
pub(super) fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let square = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>();
    (square(&mut a.iter().zip(b).map(|(a, b)| a - b)) / square(&mut b.iter().copied())).sqrt()
}

fn grown(outcome: &Outcome) -> &Delaminated {
    outcome.delaminated.as_ref().unwrap()
}

#[test]
fn delaminations_take_force_and_energy() {
    let (elastic, open) = (Plate::elastic().outcome(), Plate::new().outcome());
    let peak = |outcome: &Outcome| forces(outcome).into_iter().fold(0.0, f64::max);
    assert!(peak(&open) < 0.9 * peak(&elastic), "{} {}", peak(&open), peak(&elastic));
    let found = grown(&open);
    assert_eq!(found.interfaces.iter().map(|one| one.below).collect::<Vec<_>>(), [1, 2]);
    let sum: f64 = found.interfaces.iter().map(|one| one.area).sum();
    // The projection is not less than the largest and not more than the sum.
    let largest = found.interfaces.iter().map(|one| one.area).fold(0.0, f64::max);
    assert!(largest > 100e-6 && found.projected >= largest && found.projected <= sum, "{found:?}");
    // Nearly all by shear: its toughness times the area, and what the process zones have taken.
    let of_area = found.dissipated.shear / (788.0 * sum);
    assert!((0.9..1.6).contains(&of_area), "{of_area} {:?}", found.dissipated);
    assert!(open.energy_error < 5e-3, "{}", open.energy_error);
    // What is damaged lies around the impact, and the history ends with the areas.
    let row = open.history.last().unwrap();
    assert_eq!((row.effects[1], row.effects[2]), (sum, found.projected));
    assert!((row.effects[0] / found.dissipated.total() - 1.0).abs() < 1e-12);
    let since = found.interfaces.iter().filter_map(|one| one.since).fold(f64::INFINITY, f64::min);
    assert!(since > 20e-6 && since < 400e-6, "{since}");
}

/// A uniform traction pulls the corners of quadratic cells the other way: what acts on the middles of their sides counts as well, and
/// they open in time.
#[test]
fn quadratic_cells_open_as_cubic_ones() {
    let plate = Plate {
        ply_mm: 0.5,
        material: "library = 'IM7/8552'\nZt = '30 MPa'\nS13 = '50 MPa'\n",
        mass_kg: 0.2,
        step_us: 2.0,
        end_us: 700,
        hold: "kind = 'clamped'",
        ..Plate::new()
    };
    let of = |element: &str, symmetry: &str| {
        let text = plate.text().replace("'hermite-prism'", element).replace("symmetry = 'quarter'\n", symmetry);
        let scene = scene::parse(&text, &root().join("scene.toml")).unwrap();
        let model = Model::new(scene, &Registry::standard()).unwrap();
        impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap()
    };
    let [cubic, quadratic] = ["'hermite-prism'", "'hex20'"].map(|element| of(element, "symmetry = 'quarter'\n"));
    assert_eq!((&cubic.stopped, &quadratic.stopped), (&None, &None));
    let ratio = |a: f64, b: f64| a / b - 1.0;
    let [one, other] = [&cubic, &quadratic].map(grown);
    let (area, lost) = (ratio(other.projected, one.projected), ratio(other.dissipated.total(), one.dissipated.total()));
    assert!(area.abs() < 0.25 && lost.abs() < 0.2, "{area} {lost}");
    // What belongs to a corner on a line of symmetry is that of both halves.
    let whole = of("'hex20'", "");
    let same = ratio(grown(&whole).dissipated.total(), other.dissipated.total());
    assert!(same.abs() < 1e-9, "{same:e}");
}

/// A closed interface is rigid: without damage nothing has changed, whichever cells the tractions have opened but for their penalty.
#[test]
fn what_does_not_open_is_the_elastic_plate() {
    let elastic = forces(&Plate { velocity: 0.05, end_us: 160, ..Plate::elastic() }.outcome());
    let closed = Plate { material: STRONG, velocity: 0.05, end_us: 160, ..Plate::new() }.outcome();
    assert_eq!(grown(&closed).cells, []);
    assert!(apart(&forces(&closed), &elastic) < 1e-9, "{}", apart(&forces(&closed), &elastic));
}

#[test]
fn shorter_steps_find_the_same() {
    let [long, short] = ["1 us", "0.5 us"].map(|step| {
        let text = Plate::new().text().replace("step = '1 us'", &format!("step = '{step}'"));
        impact_of(scene::parse(&text, &root().join("scene.toml")).unwrap()).unwrap().1.outcome
    });
    assert!(apart(&forces(&long), &forces(&short)) < 0.05, "{}", apart(&forces(&long), &forces(&short)));
    let [a, b] = [&long, &short].map(|outcome| grown(outcome).projected);
    assert!((a / b - 1.0).abs() < 0.06, "{a} {b}");
    let [a, b] = [&long, &short].map(|outcome| grown(outcome).dissipated.total());
    assert!((a / b - 1.0).abs() < 0.02, "{a} {b}");
    assert!(short.energy_error < 1e-3, "{}", short.energy_error);
}

/// A thin plate, held in its plane all around, that deflects by its thickness and no interface of which is damaged.
pub(super) fn stretched(effects: &'static str, more: &'static str) -> Plate {
    Plate {
        effects,
        more,
        material: STRONG,
        ply_mm: 0.4,
        mass_kg: 0.1,
        velocity: 5.0,
        end_us: 250,
        hold: "at = 'all', fix = ['U10', 'U20', 'U30']",
        ..Plate::new()
    }
}

/// Against Newton's method with the strains of large deflections in all cells.
#[test]
fn deflections_stretch_what_may_delaminate() {
    let closed = |effects| Plate { delamination: String::new(), ..stretched(effects, ALIKE) }.outcome();
    let (linear, newton) = (forces(&closed("")), forces(&closed("membrane = 'on'")));
    let growth = stretched("delamination = 'growth', membrane = 'on'", "").outcome();
    assert_eq!(grown(&growth).cells, []);
    let (far, near) = (apart(&linear, &newton), apart(&forces(&growth), &newton));
    assert!(far > 0.2 && near < 0.015, "{far} {near}");
    assert!(growth.energy_error < 1e-3, "{}", growth.energy_error);
}

/// A plate that half a turn maps onto itself is free to turn; one with two mirrors is not. Both find the same.
#[test]
fn a_plate_that_is_free_to_turn_is_stretched_alike() {
    let plate = |symmetry| Plate { symmetry, end_us: 120, ..stretched("delamination = 'growth', membrane = 'on'", "") };
    let [held, free] = ["quarter", "half-turn"].map(|symmetry| forces(&plate(symmetry).outcome()));
    assert!(apart(&free, &held) < 1e-4, "{}", apart(&free, &held));
}

/// Tension that bends a plate is not known to its modes, nor one whose deflections no step follows.
#[test]
fn a_plate_that_its_modes_do_not_stretch_is_refused() {
    let plate = || Plate { effects: "delamination = 'growth', membrane = 'on'", ..Plate::new() };
    let refused = |plate: Plate, words: &str| {
        let model = plate.model().unwrap();
        let error = impact::prepare(&model, NonZeroUsize::MIN).map(|_| ()).expect_err("it is refused");
        let report = format!("{:?}", miette::Report::new(error));
        assert!(report.contains(words), "{report}");
    };
    refused(Plate { plies: "[0/0/90]", ..plate() }, "its tension would bend this plate");
    for step_us in [25.0, 400.0] {
        refused(Plate { step_us, ..plate() }, "the step is too long for the deflections");
    }
}

#[test]
fn threads_and_restarts_change_no_bit() {
    let effects = "delamination = 'growth', membrane = 'on'";
    let model = Plate { effects, ..Plate::new() }.model().unwrap();
    let prepared = |threads| impact::prepare(&model, NonZeroUsize::new(threads).unwrap()).unwrap();
    let straight = impact::march(prepared(1), |_| {}).unwrap();
    let found = |outcome: &Outcome| (forces(outcome), outcome.delaminated.clone(), outcome.history.clone());
    assert!(!grown(&straight).cells.is_empty() && straight.stopped.is_none(), "{:?}", straight.stopped);
    assert!(found(&impact::march(prepared(2), |_| {}).unwrap()) == found(&straight), "two threads");

    let folder = std::env::temp_dir().join(format!("fem-growth-{}", std::process::id()));
    let dir = OutputDir::create(folder.clone()).unwrap();
    let mut march = March::start(prepared(1)).unwrap();
    // Before anything has opened, in the middle of the growth, after it.
    for steps in [3, 280, 60] {
        (0..steps).for_each(|_| march.advance());
        march.save(&dir).unwrap();
        march = March::resume(prepared(1), Checkpoint::read(dir.path(), &model).unwrap()).unwrap();
    }
    while !march.done() {
        march.advance();
    }
    let resumed = march.finish();
    std::fs::remove_dir_all(folder).unwrap();
    assert!(found(&resumed) == found(&straight), "resumed");
}

/// A disc that holds nothing at the start has its area, and makes the plate more compliant.
#[test]
fn a_delamination_at_the_start() {
    let start = "start = [{ interface = 1, at = { x = '24 mm', y = '20 mm' }, radius = '7 mm' }]";
    let delamination = format!("delamination = {{ penalty = '2e4 N/mm^3', {start} }}\n");
    let at_start = Plate { delamination, material: STRONG, velocity: 0.05, end_us: 160, ..Plate::new() };
    let sound = Plate { material: STRONG, velocity: 0.05, end_us: 160, ..Plate::new() };
    let cracked = at_start.outcome();
    let found = grown(&cracked);
    let disc = PI * 49e-6;
    assert!((found.interfaces[0].area / disc - 1.0).abs() < 0.05, "{} {disc}", found.interfaces[0].area);
    assert_eq!((found.interfaces[0].since, found.interfaces[1].area), (Some(0.0), 0.0));
    let stiffness = |plate: &Plate| {
        let model = plate.model().unwrap();
        impact::prepare(&model, NonZeroUsize::MIN).unwrap().sizes.static_stiffness
    };
    let [sound, cracked] = [&sound, &at_start].map(stiffness);
    assert!((0.5..0.95).contains(&(cracked / sound)), "{cracked} {sound}");
}

/// Plies that follow a law: where nothing opens, steps without a tangent find what Newton's do.
#[test]
fn plies_follow_their_law_beside_interfaces() {
    const LAW: &str = "law = { name = 'hahn-tsai', alpha = '2.44e-8 1/MPa^3' }\n";
    let material: &'static str = Box::leak(format!("{STRONG}{LAW}").into_boxed_str());
    let newton = forces(&Plate { material, velocity: 1.0, end_us: 40, ..Plate::elastic() }.outcome());
    let explicit = Plate { material, velocity: 1.0, end_us: 40, ..Plate::new() }.outcome();
    let elastic = forces(&Plate { material: STRONG, velocity: 1.0, end_us: 40, ..Plate::elastic() }.outcome());
    let [from_newton, from_elastic] = [&newton, &elastic].map(|other| apart(&forces(&explicit), other));
    assert!(from_newton < 0.1 * from_elastic && from_newton < 2e-3, "{from_newton} {from_elastic}");
    let lost = |outcome: &Outcome| outcome.history.last().unwrap().effects[3];
    assert!(lost(&explicit) > 0.0, "{}", lost(&explicit));
}

#[test]
fn refusals_help() {
    let of =
        |delamination: &str| Plate { delamination: format!("delamination = {{ {delamination} }}\n"), ..Plate::new() };
    of("interfaces = [3]").refused(&["no interface 3 in a laminate of 3 plies", "1 to 2"]);
    of("radius = '0.1 mm'").refused(&["within `delamination.radius`", "enlarge"]);
    of("points = 40").refused(&["40 points", "16 are the most"]);
    of("trigger = 2").refused(&["not a share", "between 0 and 1"]);
    of("law = 'cohesive'").refused(&["cohesive", "bilinear"]);
    of("interfaces = []").refused(&["the list is empty"]);
    of("start = [{ interface = 1, at = { x = '90 mm', y = '16 mm' }, radius = '5 mm' }]")
        .refused(&["no point of the interface"]);
    of("interfaces = [1], start = [{ interface = 2, at = { x = '24 mm', y = '20 mm' }, radius = '5 mm' }]")
        .refused(&["interface 2 is none of those", "they are 1"]);
    let plate = Plate::new;
    Plate { material: "library = 'AS4/3502'\n", ..plate() }.refused(&["toughness", "GIIc"]);
    Plate { material: "library = 'IM7/8552'\nGIIc = '0 J/m^2'\n", ..plate() }.refused(&["GIIc"]);
    Plate { plies: "[0/0/0]", ..plate() }.refused(&["all plies are alike", "delamination = { interfaces = [4] }"]);
    Plate { effects: "", ..plate() }.refused(&["means nothing where delaminations do not grow"]);
    Plate { effects: "delamination = 'growth', gravity = '9.81 m/s^2'", ..plate() }
        .refused(&["`effects.gravity`", "yet"]);
    Plate { more: "reduction = { method = 'ritz', vectors = 20 }\n", ..plate() }
        .refused(&["reduced plate is linear", "none"]);
    let with = |from: &str, to: &str| {
        let text = plate().text().replace(from, to);
        let read = scene::parse(&text, &root().join("scene.toml")).map_err(Error::from);
        let error = read.and_then(|scene| Model::new(scene, &Registry::standard())).map(|_| ()).expect_err("refused");
        format!("{:?}", miette::Report::new(error)).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let newmark = with("{ name = 'generalized-alpha', rho = 0.5 }", "'newmark'");
    assert!(newmark.contains("keeps high modes") && newmark.contains("rho = 0.5"), "{newmark}");
    let inside = with("layers = 3", "layers = [2, 1]");
    assert!(inside.contains("interface 1 may open and lies inside a layer"), "{inside}");
    let shell = with("kind = 'hermite-prism'", "kind = 'mitc4'");
    assert!(shell.contains("shell holds the whole laminate"), "{shell}");
}
