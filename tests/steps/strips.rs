//! Strips of segments of different thickness, mid-planes at one height or faces flush, against beams of first-order shear theory
//! (`stepped_static.csv` and `stepped_frequencies.csv`).

use super::{case, lines, mesh};
use crate::support::{Case, root};
use std::collections::BTreeMap;
use std::fs;

/// What a shell may be off a beam.
const BEAM: f64 = 2e-3;

/// A strip of the reference: which part of it has half or twice the plies of the rest, and how it lies.
struct Strip {
    name: &'static str,
    group: [f64; 2],
    plies: [&'static str; 2],
    align: &'static str,
}

const STRIPS: [Strip; 4] = [
    Strip { name: "symmetric_step", group: [40.0, 100.0], plies: ["[0/90]4s", "[0/90]2s"], align: "middle" },
    Strip { name: "eccentric_step", group: [40.0, 100.0], plies: ["[0/90]4s", "[0/90]2s"], align: "bottom" },
    Strip { name: "symmetric_doubler", group: [35.0, 65.0], plies: ["[0/90]2s", "[0/90]4s"], align: "middle" },
    Strip { name: "eccentric_doubler", group: [35.0, 65.0], plies: ["[0/90]2s", "[0/90]4s"], align: "bottom" },
];

const SECTION: &str = "kind = 'webster-beam', z_derivatives = 'layer-wise'";
const SHELL: &str = "kind = 'mitc4'";

impl Strip {
    /// Half the width of the strip, its lengths times `scale`. Beams know no contraction across, of which a section is free.
    fn case(&self, element: &str, (size, scale): (f64, f64), rest: &str) -> Case {
        let Self { group, plies, align, .. } = self;
        let (layers, nu) = if element == SHELL { (1, 0.0) } else { (2, 0.3) };
        let laminate =
            |plies: &str| format!("plies = '{plies}', material = 'tape', ply_thickness = '0.13 mm', layers = {layers}");
        let text = format!(
            "title = 'a strip with a step'\n{rest}\nmesh = {{ file = 'plate.msh', unit = 'mm' }}\nelement = {{ {element} }}\n\
             effects = {{ damage = 'off' }}\n\
             materials.tape = {{ e1 = '130.3 GPa', e2 = '9.65 GPa', nu12 = {nu}, nu23 = 0.4, g12 = '5.93 GPa', density = '1.58 g/cm^3' }}\n\
             laminate = [{{ {} }}, {{ group = 'other', align = '{align}', {} }}]\n",
            laminate(plies[0]),
            laminate(plies[1])
        );
        let [from, to] = group.map(|x| x * scale);
        let mut ends = vec![from, to, 100.0 * scale];
        ends.dedup();
        let inside = |p: [f64; 2]| (from * 1e-3..to * 1e-3).contains(&p[0]);
        case(&text, mesh(&lines(&ends, size), &[0.0, 5.0], &[("other", &inside)]))
    }

    /// Deflection at x, m, of the node at z = 0, or the nearest.
    fn deflection(&self, element: &str, sizes: (f64, f64), rest: &str, x: f64) -> f64 {
        let case = self.case(element, sizes, &format!("analysis = 'static'\n{rest}"));
        case.fem("run", &["--out", "out"]).good();
        let (header, rows) = case.table("out/displacements.csv");
        let column = |name: &str| header.iter().position(|own| own == name).unwrap();
        let [at_x, at_z, at_w] = ["x_m", "z_m", "w_m"].map(column);
        let number = |row: &Vec<String>, k: usize| row[k].parse::<f64>().unwrap();
        let near = |row: &&Vec<String>| (number(row, at_x) - x).abs() < 1e-9;
        let height = |row: &&Vec<String>| number(row, at_z).abs();
        let row = rows.iter().filter(near).min_by(|a, b| height(a).total_cmp(&height(b))).unwrap();
        number(row, at_w)
    }

    fn frequencies(&self, supports: &str) -> Vec<f64> {
        let case = self.case(SHELL, (1.0, 1.0), &format!("analysis = 'modes'\nmodes.count = 3\n{supports}"));
        case.fem("run", &["--out", "out"]).good();
        let (header, rows) = case.table("out/modes.csv");
        let column = header.iter().position(|name| name == "frequency_Hz").unwrap();
        rows.iter().map(|row| row[column].parse().unwrap()).collect()
    }
}

/// Motions that are even across the strip: those of a beam.
const EVEN: &str = "{ group = 'y-min', kind = 'symmetry' }";
const CLAMPED: &str = "{ group = 'x-min', kind = 'clamped' }";
const CLAMPED_TOO: &str = "{ group = 'x-max', kind = 'clamped' }";
const PINNED: &str = "{ group = 'x-min', at = 'mid-plane', fix = ['U10', 'U30'] }";
const ROLLER: &str = "{ group = 'x-max', at = 'mid-plane', fix = ['U30'] }";
const TIP: &str = "load = [{ group = 'x-max', force_per_length = ['0 N/mm', '0 N/mm', '0.1 N/mm'] }]";
const UNIFORM: &str = "load = [{ pressure = '100 Pa', face = 'bottom' }]";

fn supports(all: &[&str]) -> String {
    format!("support = [{}]", all.join(", "))
}

fn rows(file: &str) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(root().join("tests/data/damage").join(file)).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let of = |row: csv::StringRecord| header.iter().map(str::to_owned).zip(row.iter().map(str::to_owned)).collect();
    reader.records().map(|row| of(row.unwrap())).collect()
}

/// Numbers of a column of the beams of first-order shear theory.
fn reference(file: &str, column: &str, keys: [&str; 2], more: Option<&str>) -> Vec<f64> {
    let chosen = |row: &&BTreeMap<String, String>| {
        let load = more.is_none_or(|load| row["load"] == load);
        row["case"] == keys[0] && row["theory"] == "Timoshenko" && row["supports"] == keys[1] && load
    };
    rows(file).iter().filter(chosen).map(|row| row[column].parse().unwrap()).collect()
}

#[track_caller]
fn near(got: f64, want: f64, tolerance: f64, what: &str) {
    assert!((got / want - 1.0).abs() < tolerance, "{what}: {got}, not {want} ({:.2e})", got / want - 1.0);
}

#[test]
fn shells_with_steps_bend_as_beams_do() {
    let tip = format!("{}\n{TIP}", supports(&[CLAMPED, EVEN]));
    let middle = format!("{}\n{UNIFORM}", supports(&[CLAMPED, CLAMPED_TOO, EVEN]));
    for strip in &STRIPS {
        for (column, held, load, rest, x) in [
            ("w_end", "clamped-free", "tip_transverse", &tip, 0.1),
            ("w_mid", "clamped-clamped", "uniform", &middle, 0.05),
        ] {
            let want = reference("stepped_static.csv", column, [strip.name, held], Some(load))[0];
            near(strip.deflection(SHELL, (1.0, 1.0), rest, x), want, BEAM, &format!("{} {held}", strip.name));
        }
    }
}

#[test]
fn shells_with_steps_vibrate_as_beams_do() {
    for strip in &STRIPS {
        for (held, all) in [("clamped-clamped", [CLAMPED, CLAMPED_TOO]), ("pinned-roller", [PINNED, ROLLER])] {
            let want = reference("stepped_frequencies.csv", "f_Hz", [strip.name, held], None);
            let got = strip.frequencies(&supports(&[all[0], all[1], EVEN]));
            assert_eq!(got.len(), 3);
            got.iter().zip(want).for_each(|(got, want)| near(*got, want, BEAM, &format!("{} {held}", strip.name)));
        }
    }
}

/// Plies that end at a step take up their share of the load over a length of their own, which no beam knows: a solid is softer by a
/// part that stays while the strip grows longer, so that over its deflection it falls with the length.
#[test]
fn solids_with_steps_come_to_beams_as_strips_grow_long() {
    let tip = format!("{}\n{TIP}", supports(&[CLAMPED]));
    for strip in &STRIPS[..2] {
        let excess = [1.0, 4.0].map(|scale: f64| {
            // Timoshenko's strip of two segments, D and S of the reference times the share of the width, 1/2, under 0.5 N.
            let (length, thin) = (0.1 * scale, 0.06 * scale);
            let bending = (length.powi(3) - thin.powi(3)) / (3.0 * 0.609570832) + thin.powi(3) / (3.0 * 0.086799076);
            let want = bending + (length - thin) / 81262.3809524 + thin / 40631.1904762;
            strip.deflection(SECTION, (1.0, scale), &tip, length) / want - 1.0
        });
        assert!(excess[1] > 0.0 && excess[1] < 0.011, "{} {excess:?}", strip.name);
        assert!((excess[0] / excess[1] / 4.0 - 1.0).abs() < 0.1, "{} {excess:?}", strip.name);
    }
}
