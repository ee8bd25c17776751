//! Delaminations that grow where that is violent, or chatters, or depends on what should not matter.

use crate::case::{Case, Room};
use crate::support::{impact_of, root};
use fem::analyses::impact::Outcome;
use fem::io::scene;

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
    ]
}

const WEAK: &str = "Zt = '20 MPa'\nS13 = '25 MPa'\n";

struct Struck {
    sides: [u32; 2],
    delamination: &'static str,
    material: &'static str,
    velocity: f64,
    march: &'static str,
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
        }
    }

    fn run(&self) -> Outcome {
        let Self { sides: [x, y], delamination, material, velocity, march } = self;
        let edges = ["x-min", "x-max", "y-min", "y-max"]
            .map(|edge| format!("{{ group = '{edge}', at = 'bottom', fix = ['U30'] }}"))
            .join(", ");
        let text = format!(
            "title = 'growth'\nmesh = {{ rectangle = ['{x} mm', '{y} mm'], cells = [{}, {}] }}\nsymmetry = 'quarter'\n\
             element = {{ kind = 'hermite-prism' }}\neffects = {{ damage = 'off', delamination = 'growth' }}\n\
             delamination = {{ penalty = '2e4 N/mm^3', {delamination} }}\n\
             support = [{edges}, {{ restrain = 'rigid-motions' }}]\n\
             impactor = {{ mass = '1 kg', velocity = '{velocity} m/s', at = {{ x = '{} mm', y = '{} mm' }}, \
             patch_radius = '3 mm' }}\ncontact = {{ law = 'hertz', k = '4e9 N/m^1.5' }}\nmarch = {{ {march} }}\n\
             laminate = {{ plies = '[0/90/0]', material = 'tape', ply_thickness = '1 mm' }}\n\
             output = {{ history_every = '4 us' }}\n[materials.tape]\nlibrary = 'IM7/8552'\n{material}",
            x / 4,
            y / 4,
            x / 2,
            y / 2
        );
        impact_of(scene::parse(&text, &root().join("scene.toml")).unwrap()).unwrap().1.outcome
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
