//! The same plate elsewhere, turned, in other units, in another order.

use crate::case::{Case, Room};
use crate::plates::{SHELL, SOLIDS, jiggled, model, moved, nearest, on, rectangle, shuffled, solve, with_nodes, worst};
use crate::scene::{AS4, Plate, Side};
use fem::analyses::impact;
use fem::core::mesh::PlaneMesh;
use std::fmt::Write as _;
use std::num::NonZeroUsize;

pub(super) fn cases() -> Vec<Case> {
    const ALL: &str = "change of displacements, of stresses along the fibres of every ply and of a contact force";
    vec![
        Room::Space.case(
            "plate far from the origin",
            "moved by 1 to 1e6 of its sizes; every element for cells of any shape",
            ALL,
            1e-6,
            || changed(&[1.0, 1e3, 1e6].map(|by| Frame { shift: by * SIZE[0], ..Frame::default() })),
        ),
        Room::Space.case(
            "solids turned with their fibres",
            "by 0.001 to 180 degrees; every solid for cells of any shape",
            ALL,
            1e-9,
            || changed_of(&SOLIDS, &turned()),
        ),
        Room::Space.case(
            "shell turned with its fibres",
            "by 0.001 to 180 degrees; its shear stiffness belongs to bending about the axes",
            ALL,
            2e-2,
            || changed_of(&[SHELL], &turned()),
        ),
        Room::Space.case(
            "round patch on a turned plate",
            "by 0.001 to 180 degrees; a solid",
            "change of the mean deflection under the pressure of a contact",
            1e-4,
            round_patch,
        ),
        Room::Space.case(
            "unit of length",
            "a plate of 1e-6 to 1e6 times the size; every element for cells of any shape",
            "change of displacements over the size and of stresses along the fibres of every ply",
            1e-9,
            || changed(&[1e-6, 1e-3, 1e3, 1e6].map(|scale| Frame { scale, ..Frame::default() })),
        ),
        Room::Space.case(
            "unit of force",
            "moduli and loads of 1e-9 to 1e9 times the size; every element for cells of any shape",
            "change of displacements and of stresses along the fibres of every ply over that",
            1e-9,
            || changed(&[1e-9, 1e-3, 1e3, 1e9].map(|force| Frame { force, ..Frame::default() })),
        ),
        Room::Space.case(
            "order of nodes and cells",
            "three orders of nodes, of cells and of their corners; every element for cells of any shape",
            ALL,
            1e-9,
            || changed(&[1, 2, 3].map(|order| Frame { order, ..Frame::default() })),
        ),
    ]
}

fn turned() -> [Frame; 6] {
    [1e-3, 17.3, 45.0, 90.0, 123.4, 180.0].map(|degrees| Frame { degrees, ..Frame::default() })
}

/// mm.
const SIZE: [f64; 2] = [40.0, 30.0];

/// How a plate is seen.
#[derive(Debug, Clone, Copy)]
struct Frame {
    shift: f64,
    degrees: f64,
    scale: f64,
    force: f64,
    order: usize,
}

impl Default for Frame {
    fn default() -> Self {
        Self { shift: 0.0, degrees: 0.0, scale: 1.0, force: 1.0, order: 0 }
    }
}

impl Frame {
    fn to(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (s, c) = self.degrees.to_radians().sin_cos();
        [self.scale * (c * x - s * y) + self.shift, self.scale * (s * x + c * y) - 0.5 * self.shift]
    }

    fn mesh(&self) -> PlaneMesh {
        let mesh = moved(jiggled(rectangle(SIZE, [6, 5]), 0.2), |p| self.to(p));
        let struck = nearest(&mesh, self.to([17.0, 12.0]));
        let mesh = with_nodes(mesh, "struck", &[struck]);
        if self.order == 0 { mesh } else { shuffled(&mesh, self.order) }
    }

    /// A laminate, clamped all around; `more` is added.
    fn plate(&self, element: &str, more: &str) -> Plate {
        let turned = |angle: f64| (angle + self.degrees + 180.0).rem_euclid(360.0) - 180.0;
        let plies = [30.0, -45.0, 90.0, 0.0].map(|angle| turned(angle).to_string());
        let layers = if element == SHELL { vec![4] } else { vec![2, 2] };
        let mut plate = Plate::new(&material(self.force), &format!("[{}]", plies.join("/")), 0.5 * self.scale, layers)
            .element(element)
            .sides([Side::Free; 4]);
        for side in ["x-min", "x-max", "y-min", "y-max"] {
            let _ = writeln!(plate.more, "[[support]]\ngroup = '{side}'\nat = 'all'\nfix = ['U10', 'U20', 'U30']");
        }
        plate.more += more;
        plate
    }

    fn place(&self, at: [f64; 2]) -> String {
        let [x, y] = self.to(at);
        format!("at = {{ x = '{x} mm', y = '{y} mm' }}")
    }

    /// Displacements over the size and stresses of plies over that of force, at two places, under a pressure.
    fn at_rest(&self, element: &str) -> [Vec<f64>; 2] {
        let load = format!("[[load]]\npressure = '{} MPa'\n", 0.1 * self.force);
        let profile = |name: &str, at| format!("[[profile]]\nname = '{name}'\n{}\npoints = 2\n", self.place(at));
        let more = [load, profile("a", [16.0, 13.0]), profile("b", [29.0, 20.0])].concat();
        let meshed = on(self.plate(element, &more), &self.mesh());
        let (_, solution) = solve(&meshed.plate.text("static")).unwrap();
        let points = || solution.profiles.iter().flatten();
        let (s, c) = self.degrees.to_radians().sin_cos();
        let back = |[u, v, w]: [f64; 3]| [c * u + s * v, c * v - s * u, w].map(|x| x / self.scale);
        [
            points().flat_map(|p| back(p.displacement)).collect(),
            points().flat_map(|p| p.in_ply.0.map(|s| s / self.force)).collect(),
        ]
    }

    /// An impact; `how` it is spread.
    fn impact(&self, at: &str, how: &str) -> String {
        format!(
            "[impactor]\nmass = '20 g'\nvelocity = '2 m/s'\n{at}\n{how}\n[contact]\nlaw = 'hertz'\n\
             k = '1e9 N/m^1.5'\n[effects]\ndamage = 'off'\n[reduction]\nmethod = 'ritz'\nvectors = 8\n\
             [march]\nintegrator = 'newmark'\nstep = '1 us'\nend = '30 us'\n"
        )
    }

    /// The force of a short impact on a node.
    fn struck(&self, element: &str) -> Vec<f64> {
        let more = self.impact("at = { group = 'struck' }", "load = 'node'");
        let meshed = on(self.plate(element, &more), &self.mesh());
        let model = model(&meshed.plate.text("impact")).unwrap();
        let outcome = impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
        assert_eq!(outcome.stopped, None);
        outcome.history.iter().map(|row| row.contact_force_n()).collect()
    }
}

fn material(force: f64) -> String {
    let mut lines = String::new();
    for line in AS4.lines() {
        let _ = match line.split_once(" GPa'").and_then(|(head, _)| head.split_once(" = '")) {
            Some((name, value)) => writeln!(lines, "{name} = '{} GPa'", force * value.parse::<f64>().unwrap()),
            None => writeln!(lines, "{line}"),
        };
    }
    lines
}

fn round_patch() -> f64 {
    let stiffness = |frame: &Frame| {
        let more = frame.impact(&frame.place([17.0, 12.0]), "patch_radius = '3 mm'");
        let meshed = on(frame.plate(SOLIDS[0], &more), &frame.mesh());
        let model = model(&meshed.plate.text("impact")).unwrap();
        impact::prepare(&model, NonZeroUsize::MIN).unwrap().sizes.static_stiffness
    };
    let plain = stiffness(&Frame::default());
    worst(turned().iter().map(|frame| (stiffness(frame) / plain - 1.0).abs()))
}

fn changed(frames: &[Frame]) -> f64 {
    changed_of(&[SOLIDS[0], SOLIDS[1], SOLIDS[2], SHELL], frames)
}

/// Largest change in any of the frames, relative to the largest value of its kind.
fn changed_of(elements: &[&str], frames: &[Frame]) -> f64 {
    let far =
        |a: &[f64], b: &[f64]| worst(a.iter().zip(b).map(|(a, b)| (a - b).abs())) / worst(b.iter().map(|b| b.abs()));
    let mut all = Vec::new();
    for element in elements {
        let plain = Frame::default();
        let (rest, force) = (plain.at_rest(element), plain.struck(element));
        for frame in frames {
            let now = frame.at_rest(element);
            all.extend([far(&now[0], &rest[0]), far(&now[1], &rest[1])]);
            // What an impactor does depends on units: its contact stays as stiff.
            if (frame.scale, frame.force) == (1.0, 1.0) {
                all.push(far(&frame.struck(element), &force));
            }
        }
    }
    worst(all)
}
