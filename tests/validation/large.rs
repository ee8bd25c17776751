//! Large deflections of plates against von Kármán's theory.

use super::scene::Side::{Clamped, Free, Supported, Symmetric};
use super::scene::{AS4, MeshFile, Plate, Row, Side, gmsh_file, gmsh_grid, isotropic, reference};
use fem::Error;
use fem::analyses::statics::{self, StaticSolution};
use fem::io::scene;
use fem::{Model, Registry};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_4, PI};
use std::num::NonZeroUsize;

/// Deflections.
const DEFLECTION: f64 = 5e-3;
/// Membrane forces.
const MEMBRANE: f64 = 1e-2;

const ON: &str = "[effects]\nmembrane = 'on'";
const MITC4: &str = "kind = 'mitc4'";
const PRISM: &str = "kind = 'hermite-prism', z_derivatives = 'layer-wise'";

/// Side of a square, radius of a circle, mm; the isotropic plates are 1 mm thick. Slopes and shear then change less than
/// what is asked for.
const SIZE: f64 = 400.0;
/// Young's modulus, MPa.
const E: f64 = 70e3;

/// What holds the edges in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
enum InPlane {
    /// Neither displacement.
    Pinned,
    /// No displacement across the edge; along it it is free.
    Straight,
    /// Edges that stay straight without a force on them as a whole.
    Movable,
}

/// Supports of a quarter's edges x-min and y-min.
fn supported(plate: Plate, bending: Side, in_plane: InPlane) -> Plate {
    let side = if in_plane == InPlane::Pinned { bending } else { Free };
    let plate = plate.sides([side, Symmetric, side, Symmetric]);
    let of_edge = |group: &str, across: u8, along: u8| {
        let support =
            |unknowns: &[String]| format!("[[support]]\ngroup = '{group}'\nat = 'mid-plane'\nfix = {unknowns:?}\n");
        let held = [format!("U{across}0"), format!("U{across}{along}")];
        let resting = ["U30".into(), format!("U3{along}"), format!("U{along}3")];
        match in_plane {
            InPlane::Pinned => support(&held),
            InPlane::Straight => support(&[&held[..], &resting[..]].concat()),
            InPlane::Movable => {
                let couple = format!("[[couple]]\ngroup = '{group}'\nat = 'mid-plane'\ndofs = ['U{across}0']\n");
                support(&resting) + &couple
            }
        }
    };
    plate.with(&of_edge("x-min", 1, 2)).with(&of_edge("y-min", 2, 1))
}

/// What a reference is held against: a plate under a load of its table, and the units of that.
struct Case {
    file: &'static str,
    /// Column of the load, and of the deflection.
    load: &'static str,
    deflection: &'static str,
    /// Columns of the membrane forces along x and y.
    membrane: [&'static str; 2],
    plate: Box<dyn Fn(f64) -> Plate>,
    /// Of the deflections and of the membrane forces, m and N/m.
    units: [f64; 2],
}

fn isotropic_plate(nu: f64, element: &str) -> Plate {
    let layers = if element == MITC4 { vec![2] } else { vec![1, 1] };
    Plate::new(&isotropic(E * 1e-3, nu, 2.7), "[0_2]", 0.5, layers).element(element)
}

/// A quarter of an isotropic square plate; a plate of solids is half as wide, because wide flat cells
/// are stiff, with cells three times as wide in the middle as at the edge.
fn square(file: &'static str, bending: Side, in_plane: InPlane, element: &'static str, cells: usize) -> Case {
    let (size, grading) = if element == MITC4 { (SIZE, 1.0) } else { (0.5 * SIZE, 3.0) };
    let width = |i: usize| 1.0 + (grading - 1.0) * i as f64 / (cells - 1) as f64;
    let all: f64 = (0..cells).map(width).sum();
    let line: Vec<f64> = (0..=cells).map(|n| 0.5 * size * (0..n).map(width).sum::<f64>() / all).collect();
    let mesh = gmsh_grid(&line, &line, 0.0);
    let plate = move |q: f64| {
        let quarter = isotropic_plate(0.316, element).on(&mesh);
        let loaded = supported(quarter, bending, in_plane).pressure(&format!("{}", q * E / size.powi(4)));
        loaded.probe([0.5 * size; 2]).with(ON)
    };
    let units = [1e-3, E * 1e3 / size.powi(2)];
    Case {
        file,
        load: "q",
        deflection: "w0_over_h",
        membrane: ["Nx_centre", "Ny_centre"],
        plate: Box::new(plate),
        units,
    }
}

/// A quarter of a square plate of eight plies, `scale` times as wide as that of the table.
fn cross_ply(file: &'static str, in_plane: InPlane, cells: usize) -> Case {
    let (scale, side) = (4.0_f64, 100.0);
    let plate = move |q: f64| {
        let half = 0.5 * scale * side;
        let quarter = Plate::new(AS4, "[0/90/0/90]s", 0.13, vec![8]).element(MITC4).rectangle([half; 2], [cells; 2]);
        let loaded = supported(quarter, Supported, in_plane).pressure(&format!("{}", q / scale.powi(4)));
        loaded.probe([half; 2]).with(ON)
    };
    let units = [1.04e-3, 1e3 / scale.powi(2)];
    Case {
        file,
        load: "q",
        deflection: "w0_over_h",
        membrane: ["Nx_centre", "Ny_centre"],
        plate: Box::new(plate),
        units,
    }
}

/// The same under a pressure on the square of 10 mm in its middle, `inside` cells to a quarter of that.
fn patch(outside: usize, inside: usize) -> Case {
    let (scale, half, edge) = (4.0_f64, 37.5, 32.5);
    let line = |from: f64, to: f64, n: usize| (0..n).map(move |i| scale * (from + (to - from) * i as f64 / n as f64));
    let lines: Vec<f64> = line(0.0, edge, outside).chain(line(edge, half, inside)).chain([scale * half]).collect();
    let mesh = gmsh_grid(&lines, &lines, 0.0);
    let plate = move |force: f64| {
        let pressure = force / scale.powi(2) / (10.0 * scale).powi(2);
        let loaded = format!("{pressure}*(x > {})*(y > {})", scale * edge, scale * edge);
        let quarter = Plate::new(AS4, "[0/90/0/90]s", 0.13, vec![8]).element(MITC4).on(&mesh);
        supported(quarter, Supported, InPlane::Pinned).pressure(&loaded).probe([scale * half; 2]).with(ON)
    };
    Case {
        file: "nonlin_square75_ss_pinned_xply8_as4_patch10.csv",
        load: "q",
        deflection: "w0_over_h",
        membrane: ["Nx_centre", "Ny_centre"],
        plate: Box::new(plate),
        units: [1.04e-3, 1e3 / scale.powi(2)],
    }
}

/// A quarter of a circle of radius [`SIZE`]: a square of n × n cells, and n rows of cells from there to the edge.
fn disc(n: usize) -> MeshFile {
    let (mut nodes, mut known) = (Vec::new(), HashMap::new());
    let mut at = |x: [f64; 2]| {
        let key = x.map(|x| (x * 1e6).round() as i64);
        *known.entry(key).or_insert_with(|| {
            nodes.push(x);
            nodes.len()
        })
    };
    let (side, corner) = (0.55 * SIZE, 0.45 * SIZE);
    let share = |i: usize| i as f64 / n as f64;
    // The square's upper right corner is drawn in.
    let inside = |i: usize, j: usize| {
        let (r, s) = (share(i), share(j));
        [r * (side + s * (corner - side)), s * (side + r * (corner - side))]
    };
    let outside = |along: usize, out: usize| {
        let ([x, y], angle) = (inside(n, along), FRAC_PI_4 * share(along));
        let mix = |from: f64, to: f64| from + share(out) * (to - from);
        [mix(x, SIZE * angle.cos()), mix(y, SIZE * angle.sin())]
    };
    let swap = |[x, y]: [f64; 2]| [y, x];
    let mut groups: HashMap<&str, Vec<Vec<usize>>> = HashMap::new();
    for i in 0..n {
        for j in 0..n {
            let cell = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            let quads = groups.entry("plate").or_default();
            quads.push(cell.map(|[i, j]| at(inside(i, j))).to_vec());
            quads.push(cell.map(|[i, j]| at(outside(j, i))).to_vec());
            quads.push([0, 3, 2, 1].map(|k| at(swap(outside(cell[k][1], cell[k][0])))).to_vec());
        }
        let mut edge = |name, ends: [[f64; 2]; 2]| groups.entry(name).or_default().push(ends.map(&mut at).to_vec());
        let arc = [outside(i, n), outside(i + 1, n)];
        edge("arc", arc);
        edge("arc", arc.map(swap));
        for radius in [[inside(i, 0), inside(i + 1, 0)], [outside(0, i), outside(0, i + 1)]] {
            edge("on-x", radius);
            edge("on-y", radius.map(swap));
        }
    }
    let groups: Vec<_> = ["arc", "on-x", "on-y", "plate"].map(|name| (name, groups[name].clone())).into();
    gmsh_file(&nodes, &groups)
}

/// A quarter of a circular plate.
fn circle(file: &'static str, fixed: &'static [&'static str], n: usize) -> Case {
    let mesh = disc(n);
    let plate = move |q: f64| {
        let support =
            |group: &str, fix: &[&str]| format!("[[support]]\ngroup = '{group}'\nat = 'mid-plane'\nfix = {fix:?}\n");
        let quarter = isotropic_plate(0.3, MITC4).sides([Free; 4]).on(&mesh);
        let held = quarter.with(&support("arc", fixed)).with(&support("on-x", &["U20", "U23"]));
        let loaded = held.with(&support("on-y", &["U10", "U13"])).pressure(&format!("{}", q * E / SIZE.powi(4)));
        loaded.probe([0.0; 2]).with(ON)
    };
    // N = σ h
    let units = [1e-3, E * 1e3 / SIZE.powi(2)];
    let membrane = ["s_mem_centre"; 2];
    Case { file, load: "qa4_over_Eh4", deflection: "w0_over_h", membrane, plate: Box::new(plate), units }
}

impl Case {
    /// The plate under the load of a row.
    fn solve(&self, row: &Row) -> StaticSolution {
        (self.plate)(row[self.load]).solve()
    }

    /// Errors of the deflection in the middle and of the larger membrane force there.
    fn errors(&self, row: &Row) -> [f64; 2] {
        let solution = self.solve(row);
        let deflection = -solution.profiles[0][0].displacement[2] / self.units[0] / row[self.deflection];
        let force = |k: usize| solution.resultants[0].membrane[k] / self.units[1] / row[self.membrane[k]] - 1.0;
        let (x, y) = (force(0), force(1));
        [deflection - 1.0, if x.abs() > y.abs() { x } else { y }]
    }

    /// Rows by number from the last.
    #[track_caller]
    fn check(&self, rows: impl IntoIterator<Item = usize>) {
        let table = reference(self.file);
        for row in rows {
            let row = &table[table.len() - 1 - row];
            let [w, n] = self.errors(row);
            assert!(w.abs() < DEFLECTION, "{} at {}: deflection {w:e}", self.file, row[self.load]);
            assert!(n.abs() < MEMBRANE, "{} at {}: membrane force {n:e}", self.file, row[self.load]);
        }
    }
}

const CLAMPED_SQUARE: &str = "nonlin_square_clamped_pinned_iso_nu0p316.csv";
const PINNED_SQUARE: &str = "nonlin_square_ss_pinned_iso_nu0p316.csv";
const CLAMPED: &[&str] = &["U10", "U20", "U30", "U13", "U23"];
const RESTING: &[&str] = &["U10", "U20", "U30"];
const SLIDING: &[&str] = &["U30", "U13", "U23"];

#[test]
fn squares() {
    use InPlane::{Movable, Pinned, Straight};
    square(CLAMPED_SQUARE, Clamped, Pinned, MITC4, 20).check([0, 8]);
    square(PINNED_SQUARE, Supported, Pinned, MITC4, 20).check([0, 16]);
    square("nonlin_square_ss_straight_iso_nu0p316.csv", Supported, Straight, MITC4, 20).check([0, 16]);
    square("nonlin_square_ss_movable_iso_nu0p316.csv", Supported, Movable, MITC4, 20).check([0, 16]);
}

#[test]
fn squares_of_solids() {
    square(CLAMPED_SQUARE, Clamped, InPlane::Pinned, PRISM, 12).check([0]);
}

#[test]
fn circles() {
    circle("nonlin_circ_clamped_immovable_nu0p3.csv", CLAMPED, 12).check([0, 14]);
    circle("nonlin_circ_clamped_movable_nu0p3.csv", SLIDING, 12).check([0, 14]);
    circle("nonlin_circ_ss_immovable_nu0p3.csv", RESTING, 12).check([0, 14]);
}

#[test]
fn cross_plies() {
    cross_ply("nonlin_square100_ss_pinned_xply8_as4.csv", InPlane::Pinned, 20).check([0, 9]);
    cross_ply("nonlin_square100_ss_straight_xply8_as4.csv", InPlane::Straight, 20).check([0, 9]);
    patch(16, 8).check([0, 9]);
}

#[test]
#[ignore = "two minutes: every load of every table"]
fn every_load() {
    use InPlane::{Movable, Pinned, Straight};
    square(CLAMPED_SQUARE, Clamped, Pinned, MITC4, 32).check(0..9);
    square(CLAMPED_SQUARE, Clamped, Pinned, PRISM, 12).check(0..9);
    square(PINNED_SQUARE, Supported, Pinned, MITC4, 32).check(0..20);
    square("nonlin_square_ss_straight_iso_nu0p316.csv", Supported, Straight, MITC4, 32).check(0..20);
    square("nonlin_square_ss_movable_iso_nu0p316.csv", Supported, Movable, MITC4, 32).check(0..20);
    circle("nonlin_circ_clamped_immovable_nu0p3.csv", CLAMPED, 20).check(0..17);
    circle("nonlin_circ_clamped_movable_nu0p3.csv", SLIDING, 20).check(0..17);
    circle("nonlin_circ_ss_immovable_nu0p3.csv", RESTING, 20).check(0..17);
    cross_ply("nonlin_square100_ss_pinned_xply8_as4.csv", Pinned, 32).check(0..10);
    cross_ply("nonlin_square100_ss_straight_xply8_as4.csv", Straight, 32).check(0..10);
    patch(24, 12).check(0..10);
}

/// Each Newton decrement is about the square of the one before, once they are small.
#[test]
fn newtons_method_converges_quadratically() {
    for element in [MITC4, PRISM] {
        let case = square(CLAMPED_SQUARE, Clamped, InPlane::Pinned, element, 6);
        let decrements = case.solve(&reference(case.file)[8]).decrements.unwrap();
        let fast = decrements.windows(2).filter(|d| d[0] < 0.1 && d[1] > 1e-19);
        let mut pairs = 0;
        for pair in fast {
            assert!(pair[1] < 10.0 * pair[0].powi(2), "{decrements:?}");
            pairs += 1;
        }
        assert!(pairs >= 2 && decrements.len() < 15, "{decrements:?}");
    }
}

/// A clamped square without membrane stiffening.
fn linear(element: &str, pressure: f64) -> Plate {
    isotropic_plate(0.3, element).rectangle([50.0; 2], [6; 2]).sides([Clamped; 4]).pressure(&format!("{pressure}"))
}

#[test]
fn switched_off_it_leaves_no_trace() {
    let plain = linear(MITC4, 0.1).solve();
    for with in ["[effects]\nmembrane = 'off'", "[effects]"] {
        let off = linear(MITC4, 0.1).with(with).solve();
        assert!(off.u == plain.u && off.counters == plain.counters && off.decrements.is_none());
    }
    assert!(linear(MITC4, 0.1).with(ON).solve().u != plain.u);
}

#[test]
fn small_loads_bend_a_plate_as_if_it_were_linear() {
    for element in [MITC4, PRISM] {
        let [small, large] = [linear(element, 1e-6), linear(element, 1e-6).with(ON)].map(|plate| plate.solve());
        let scale = small.u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let worst = small.u.iter().zip(&large.u).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(worst < 1e-6 * scale, "{element}: {worst:e} of {scale:e}");
        assert!((large.strain_energy / small.strain_energy - 1.0).abs() < 1e-6, "{element}");
    }
}

/// The elastica: a cantilever under a force at its end that keeps its direction. Deflection and shortening over the length
/// for P L²/E I (Mattiasson, Int. J. Numer. Meth. Eng. 17 (1981) 145-153).
#[test]
fn a_cantilever_bends_to_the_elastica() {
    for element in ["kind = 'webster-beam'", "kind = 'webster-beam', state = 'plane-strain'", PRISM] {
        for (load, deflection, shortening) in [(1.0, 0.30172, 0.05643), (5.0, 0.71379, 0.38763)] {
            let force = load * E / 12.0 / 100.0_f64.powi(2);
            let beam = Plate::new(&isotropic(E * 1e-3, 0.0, 2.7), "[0_2]", 0.5, vec![1, 1]).element(element);
            let solution = beam
                .rectangle([100.0, 2.0], [20, 1])
                .sides([Clamped, Free, Free, Free])
                .load(&format!("force_per_length = ['0 N/mm', '0 N/mm', '{force} N/mm']\ngroup = 'x-max'"))
                .probe([100.0, 0.0])
                .with(ON)
                .solve();
            let [u, _, w] = solution.profiles[0][1].displacement;
            let (w, u) = (w / 0.1 / deflection - 1.0, -u / 0.1 / shortening - 1.0);
            assert!(w.abs() < 1e-3 && u.abs() < 1e-3, "{element} {load}: {w:e} {u:e}");
        }
    }
}

/// Stress on the cells as they are stretched, S = E (λ² − 1)/2 with N = λ S h, in a profile and in a margin.
#[test]
fn margins_and_profiles_have_the_stresses_of_large_strains() {
    let (e, strain) = (1e3, 0.05_f64);
    let (stress, stretch) = (e * strain, (1.0 + 2.0 * strain).sqrt());
    for element in [PRISM, "kind = 'hermite-hex'", "kind = 'hex20'", "kind = 'webster-beam'"] {
        let pull =
            |group: &str, n: f64| format!("force_per_length = ['{n} N/mm', '0 N/mm', '0 N/mm']\ngroup = '{group}'");
        let material = format!("{}Xt = '{} MPa'\n", isotropic(e * 1e-3, 0.0, 1.0), 2.0 * stress);
        let strengths = "Xc = '1 GPa'\nYt = '1 GPa'\nYc = '1 GPa'\nS12 = '1 GPa'\nS23 = '1 GPa'\n";
        let sheet = Plate::new(&(material + strengths), "[0_2]", 0.5, vec![1, 1]).element(element);
        let solution = sheet
            .rectangle([10.0, 5.0], [4, 1])
            .sides([Symmetric, Free, Free, Free])
            .load(&pull("x-max", stretch * stress))
            .probe([6.0, 2.0])
            .with("[failure]\ncriteria = ['max-stress']")
            .with(ON)
            .solve();
        let point = &solution.profiles[0][0];
        assert!((point.global.s11() / (stress * 1e6) - 1.0).abs() < 1e-9, "{element}: {point:?}");
        assert!((solution.resultants[0].membrane[0] / (stress * 1e3) - 1.0).abs() < 1e-9, "{element}");
        assert!((solution.margins[0].reserve_factor - 2.0).abs() < 1e-8, "{element}: {:?}", solution.margins);
        assert!(solution.mesh_error.is_none());
    }
}

/// A simply supported square, pressed along x at its edges: 4 π² D/b² per length (Bryan 1891) is the most that it bears flat.
#[test]
fn a_load_that_buckles_the_plate_is_refused() {
    let critical = 4.0 * PI.powi(2) * E / (12.0 * (1.0 - 0.09)) / 100.0_f64.powi(2);
    let pressed = |share: f64| {
        let push = |sign: f64| format!("['{} N/mm', '0 N/mm', '0 N/mm']", sign * share * critical);
        let plate = isotropic_plate(0.3, MITC4).rectangle([100.0; 2], [16; 2]).sides([Free; 4]);
        let edge = |group: &str, along: u8| {
            format!("[[support]]\ngroup = '{group}'\nat = 'mid-plane'\nfix = ['U30', 'U{along}3']\n")
        };
        let plate = ["x-min", "x-max"].iter().fold(plate, |plate, group| plate.with(&edge(group, 2)));
        let plate = ["y-min", "y-max"].iter().fold(plate, |plate, group| plate.with(&edge(group, 1)));
        let plate = plate.load(&format!("force_per_length = {}\ngroup = 'x-min'", push(1.0)));
        let plate = plate.load(&format!("force_per_length = {}\ngroup = 'x-max'", push(-1.0)));
        statics::solve(&plate.with(ON).model("static"), NonZeroUsize::MIN)
    };
    assert!(pressed(0.98).is_ok());
    let refused = pressed(1.02).unwrap_err();
    assert!(matches!(refused, Error::Equilibrium(_)), "{refused:?}");
    let help = miette::Diagnostic::help(&refused).unwrap().to_string();
    assert!(help.contains("buckles"), "{help}");
}

#[test]
fn stresses_from_equilibrium_are_refused() {
    let text = linear(MITC4, 0.1).profile([20.0; 2], 3).with(ON).text("static");
    let scene = scene::parse(&text, "scene.toml".as_ref()).unwrap();
    let Err(Error::Scene(refused)) = Model::new(scene, &Registry::standard()) else { panic!() };
    assert!(refused.to_string().contains("equilibrium") && refused.remedy().contains("leave"), "{refused}");
}
