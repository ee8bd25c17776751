//! Delaminations that grow where that is violent, or chatters, or depends on what should not matter.

use crate::case::{Case, Room};
use crate::support::{impact_of, root};
use fem::analyses::impact::{self, Checkpoint, March, Outcome};
use fem::io::files::OutputDir;
use fem::io::scene::{self, Scene};
use fem::job::{self, Found, Options};
use fem::{Model, Registry};
use std::num::NonZeroUsize;

pub(crate) fn cases() -> Vec<Case> {
    vec![
        Room::Growth.case(
            "a plate that comes apart at once",
            "three plies of IM7/8552 under 8 J, steps of 0.5 us: the whole interface is lost in some 50 us",
            "energy of the impact that is neither in plate nor cracks",
            5e-2,
            apart_at_once,
        ),
        Room::Growth.case(
            "faces that clap",
            "a delamination of 20 mm from the start, struck and left alone, friction 0 and 0.5",
            "growth of the energy over that of the impact",
            1e-3,
            clapping,
        ),
        Room::Growth.case(
            "ratios of toughness",
            "GIc a tenth and a hundred times as large, GIIc ten times",
            "error of the energy, over that of the impact",
            1e-2,
            ratios,
        ),
        Room::Growth.case(
            "when an interface is opened",
            "trigger 0.1, 0.2, 0.3; margin 8 and 12 mm",
            "spread of the energy that is dissipated",
            5e-2,
            openings,
        ),
        Room::Growth.case(
            "two fronts that merge",
            "two delaminations of 10 mm in one interface, 24 mm apart, struck between them until all is one",
            "error of the energy, over that of the impact",
            1e-2,
            merging,
        ),
        Room::Growth.case(
            "a load that is reversed",
            "a delamination of 16 mm, struck from above, then as hard from below while it swings; friction 0 and 0.5",
            "error of the energy, over that of the impacts",
            1e-2,
            reversed,
        ),
        Room::Growth.case(
            "unstable growth at rest",
            "end notched flexure of IM7/8552 cracked over 0.3 of the half span, through its snap-back",
            "work that is neither stored nor dissipated, over the largest",
            5e-3,
            unstable,
        ),
        Room::Growth.case(
            "growth on threads, and resumed",
            "1, 2 and 4 threads; saved and resumed before, in and after the growth",
            "runs whose forces, areas and energies are not the same in every bit",
            0.0,
            alike,
        ),
    ]
}

const WEAK: &str = "Zt = '20 MPa'\nS13 = '25 MPa'\n";

struct Struck {
    sides: [u32; 2],
    delamination: &'static str,
    material: &'static str,
    velocity: f64,
    march: &'static str,
    /// Further impactors.
    others: &'static str,
}

impl Struck {
    /// The plate of the tests of separation.
    fn new() -> Self {
        Self {
            sides: [48, 40],
            delamination: "",
            material: WEAK,
            velocity: 3.0,
            march: "step = '1 us', end = '400 us'",
            others: "",
        }
    }

    fn run(&self) -> Outcome {
        impact_of(self.scene()).unwrap().1.outcome
    }

    fn scene(&self) -> Scene {
        let Self { sides: [x, y], delamination, material, velocity, march, others } = self;
        let edges = ["x-min", "x-max", "y-min", "y-max"]
            .map(|edge| format!("{{ group = '{edge}', at = 'bottom', fix = ['U30'] }}"))
            .join(", ");
        let text = format!(
            "title = 'growth'\nmesh = {{ rectangle = ['{x} mm', '{y} mm'], cells = [{}, {}] }}\nsymmetry = 'quarter'\n\
             element = {{ kind = 'hermite-prism' }}\neffects = {{ damage = 'off', delamination = 'growth' }}\n\
             delamination = {{ penalty = '2e4 N/mm^3', {delamination} }}\n\
             support = [{edges}, {{ restrain = 'rigid-motions' }}]\n\
             impactor = [{{ name = 'first', mass = '1 kg', velocity = '{velocity} m/s', \
             at = {{ x = '{} mm', y = '{} mm' }}, patch_radius = '3 mm' }}{others}]\ncontact = {{ law = 'hertz', k = '4e9 N/m^1.5' }}\nmarch = {{ {march} }}\n\
             laminate = {{ plies = '[0/90/0]', material = 'tape', ply_thickness = '1 mm' }}\n\
             output = {{ history_every = '4 us' }}\n[materials.tape]\nlibrary = 'IM7/8552'\n{material}",
            x / 4,
            y / 4,
            x / 2,
            y / 2
        );
        scene::parse(&text, &root().join("scene.toml")).unwrap()
    }
}

fn dissipated(outcome: &Outcome) -> f64 {
    outcome.delaminated.as_ref().unwrap().dissipated.total()
}

fn apart_at_once() -> f64 {
    let struck = Struck {
        sides: [40, 32],
        material: "",
        velocity: 4.0,
        march: "step = '0.5 us', end = '400 us'",
        ..Struck::new()
    };
    let outcome = struck.run();
    let projected = outcome.delaminated.as_ref().unwrap().projected;
    assert!((projected / 1280e-6 - 1.0).abs() < 1e-9, "{projected}");
    outcome.energy_error
}

fn clapping() -> f64 {
    const START: &str = "start = [{ interface = 1, at = { x = '24 mm', y = '20 mm' }, radius = '10 mm' }], friction = ";
    let grown = |friction: &str| {
        let delamination: &'static str = Box::leak(format!("{START}{friction}").into_boxed_str());
        let march = "step = '2 us', end = '800 us'";
        let outcome = Struck { delamination, velocity: 1.0, march, ..Struck::new() }.run();
        let energy = 0.5;
        outcome.history.iter().map(|row| row.energy_balance_j / energy).fold(0.0, f64::max)
    };
    ["0", "0.5"].map(grown).into_iter().fold(0.0, f64::max)
}

fn ratios() -> f64 {
    const RATIOS: [&str; 3] = [
        "Zt = '6 MPa'\nS13 = '25 MPa'\nGIc = '27 J/m^2'\n",
        "Zt = '20 MPa'\nS13 = '25 MPa'\nGIc = '27 kJ/m^2'\n",
        "Zt = '20 MPa'\nS13 = '25 MPa'\nGIIc = '7.9 kJ/m^2'\n",
    ];
    RATIOS.map(|material| Struck { material, ..Struck::new() }.run().energy_error).into_iter().fold(0.0, f64::max)
}

fn openings() -> f64 {
    const HOW: [&str; 4] = ["trigger = 0.2", "trigger = 0.1", "trigger = 0.3", "trigger = 0.2, margin = '12 mm'"];
    let found = HOW.map(|delamination| dissipated(&Struck { delamination, ..Struck::new() }.run()));
    let [low, high] = [f64::min, f64::max].map(|pick| found.into_iter().reduce(pick).unwrap());
    high / low - 1.0
}

fn merging() -> f64 {
    const START: &str = "start = [{ interface = 1, at = { x = '36 mm', y = '20 mm' }, radius = '5 mm' }, \
                         { interface = 1, at = { x = '12 mm', y = '20 mm' }, radius = '5 mm' }]";
    let outcome = Struck { delamination: START, ..Struck::new() }.run();
    // More than both and the strip between them.
    let projected = outcome.delaminated.as_ref().unwrap().projected;
    assert!(projected > 24e-3 * 10e-3 + 79e-6, "{projected}");
    outcome.energy_error
}

fn reversed() -> f64 {
    const BELOW: &str = ", { name = 'below', mass = '1 kg', velocity = '4 m/s', face = 'bottom', start = '300 us', \
                         at = { x = '24 mm', y = '20 mm' }, patch_radius = '3 mm' }";
    let of = |delamination: &'static str| {
        let outcome = Struck {
            delamination,
            velocity: 4.0,
            others: BELOW,
            march: "step = '0.5 us', end = '900 us'",
            ..Struck::new()
        }
        .run();
        let forces = |i: usize| outcome.history.iter().map(|row| row.impactors[i].contact_force_n).fold(0.0, f64::max);
        assert!(forces(0) > 1e3 && forces(1) > 1e3, "{} {}", forces(0), forces(1));
        let projected = outcome.delaminated.as_ref().unwrap().projected;
        assert!(projected > 2.2e-4, "{projected}");
        outcome.energy_error
    };
    const START: [&str; 2] = [
        "start = [{ interface = 1, at = { x = '24 mm', y = '20 mm' }, radius = '8 mm' }]",
        "start = [{ interface = 1, at = { x = '24 mm', y = '20 mm' }, radius = '8 mm' }], friction = 0.5",
    ];
    START.map(of).into_iter().fold(0.0, f64::max)
}

fn unstable() -> f64 {
    let path = root().join("benches/specimens/enf-short.toml");
    let text = std::fs::read_to_string(&path).unwrap().replace("[\"0 mm\", \"25 mm\"]", "[\"0 mm\", \"15 mm\"]");
    let scene = scene::parse(&text, &path).unwrap();
    let Found::Static(found) = job::run(&scene, &Registry::standard(), &Options::default(), &mut ()).unwrap().found
    else {
        panic!("the scene is at rest")
    };
    let figures = found.summary.path.unwrap();
    assert!(figures.snaps_back && figures.stopped.is_none(), "{:?}", figures.stopped);
    figures.energy_error_relative
}

fn alike() -> f64 {
    let scene = Struck { march: "step = '1 us', end = '300 us'", ..Struck::new() }.scene();
    let model = Model::new(scene, &Registry::standard()).unwrap();
    let prepared = |threads| impact::prepare(&model, NonZeroUsize::new(threads).unwrap()).unwrap();
    let found = |outcome: Outcome| (outcome.forces, outcome.delaminated, outcome.history);
    let straight = found(impact::march(prepared(1), |_| {}).unwrap());
    assert!(!straight.1.as_ref().unwrap().cells.is_empty());
    let mut differ =
        [2, 4].into_iter().filter(|n| found(impact::march(prepared(*n), |_| {}).unwrap()) != straight).count();
    let folder = tempfile::tempdir().unwrap();
    let dir = OutputDir::create(folder.path().join("run")).unwrap();
    let mut march = March::start(prepared(1)).unwrap();
    for steps in [3, 150, 100] {
        (0..steps).for_each(|_| march.advance());
        march.save(&dir).unwrap();
        march = March::resume(prepared(1), Checkpoint::read(dir.path(), &model).unwrap()).unwrap();
    }
    while !march.done() {
        march.advance();
    }
    differ += usize::from(found(march.finish()) != straight);
    differ as f64
}
