//! Lines between laminates, where strains jump, with elements that have derivatives at their nodes.

use crate::support::{Case, plate};
use fem::core::mesh::{Group, PlaneMesh};
use fem::io::gmsh::{self, Encoding};
use serde_json::Value;
use std::f64::consts::PI;

/// Cells whose centre is `inside` as the group `core`.
fn with_core(mut mesh: PlaneMesh, inside: impl Fn([f64; 2]) -> bool) -> PlaneMesh {
    let centre = |quad: &u32| {
        let corners = mesh.corners(*quad as usize);
        [0, 1].map(|d| corners.iter().map(|p| p[d]).sum::<f64>() / corners.len() as f64)
    };
    let quads: Vec<u32> = (0..mesh.quads.len() as u32).filter(|quad| inside(centre(quad))).collect();
    let mut nodes: Vec<u32> = quads.iter().flat_map(|quad| mesh.quads[*quad as usize]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    mesh.groups.insert("core".into(), Group { dim: 2, nodes, quads, ..Group::default() });
    mesh
}

fn rectangle(sides: [f64; 2], cells: [usize; 2]) -> PlaneMesh {
    let lines = |d: usize| -> Vec<f64> { (0..=cells[d]).map(|i| sides[d] * i as f64 / cells[d] as f64).collect() };
    PlaneMesh::rectangle(&lines(0), &lines(1))
}

/// A static scene of plies of 1 mm, of `soft` and in `core` of `stiff`, which are the modulus in GPa and Poisson's ratio.
fn case(mesh: &PlaneMesh, element: &str, [soft, stiff]: [(f64, f64); 2], more: &str) -> Case {
    let material = |name: &str, (e, nu): (f64, f64)| format!("materials.{name} = {{ e = \"{e} GPa\", nu = {nu} }}");
    let laminate = |name: &str, group: &str| {
        format!("{{ {group}plies = \"[0]\", material = \"{name}\", ply_thickness = \"1 mm\", layers = 1 }}")
    };
    let text = format!(
        "title = \"a seam\"\nanalysis = \"static\"\nmesh = {{ file = \"plate.msh\", unit = \"mm\" }}\nelement = {element}\n\
         effects = {{ damage = \"off\" }}\nlaminate = [{}, {}]\n{}\n{}\n{more}\n",
        laminate("soft", ""),
        laminate("stiff", "group = \"core\", "),
        material("soft", soft),
        material("stiff", stiff),
    );
    let mut file = Vec::new();
    gmsh::write(&mut file, mesh, 1e-3, Encoding::Ascii).unwrap();
    plate().text(&text).mesh_bytes(file)
}

fn summary(case: &Case) -> Value {
    case.fem("run", &["--out", "out"]).good();
    case.summary("out")
}

fn energy(case: &Case) -> f64 {
    summary(case)["strain_energy_J"].as_f64().unwrap()
}

const PRISM: &str = "{ kind = \"hermite-prism\" }";
const CANTILEVER: &str = "support = [{ group = \"x-min\", kind = \"clamped\" }]\nload = [{ pressure = \"1 kPa\" }]";

/// A cantilever of length L and width b under a line load q, stiff up to its middle: U = ∫ M²/2EI + 6/5 V²/2GA dx, M = q (L − x)²/2.
#[test]
fn a_beam_of_two_moduli_is_that_of_timoshenko() {
    let (length, width, h, pressure) = (0.1_f64, 0.02, 1e-3_f64, 1e3);
    let (q, inertia, area) = (pressure * width, width * h.powi(3) / 12.0, width * h);
    let part = |e: f64, from: f64, to: f64| {
        let integral = |n: i32| ((length - from).powi(n) - (length - to).powi(n)) / f64::from(n);
        q * q * integral(5) / (8.0 * e * inertia) + 0.6 * q * q * integral(3) / (0.5 * e * area)
    };
    let want = part(100e9, 0.0, 0.05) + part(10e9, 0.05, length);
    let moduli = [(10.0, 0.0), (100.0, 0.0)];
    let error = |element: &str, cells: [usize; 2]| {
        let mesh = with_core(rectangle([length, width], cells), |[x, _]| x < 0.05);
        energy(&case(&mesh, element, moduli, CANTILEVER)) / want - 1.0
    };
    for (element, across) in [(PRISM, 2), ("{ kind = \"webster-beam\", state = \"plane-stress\" }", 1)] {
        let errors = [4, 8, 16].map(|along| error(element, [along, across]));
        // Strains that are shared at the line: 10, 4 and 1.6 %.
        assert!(errors[0].abs() < 1e-3 && errors[2].abs() < 1e-4, "{element}: {errors:?}");
    }
}

/// The same seen from another side: turned by 30 degrees, so that derivatives along the line are sums of both.
#[test]
fn a_line_may_run_in_any_direction() {
    let straight = with_core(rectangle([0.1, 0.02], [8, 2]), |[x, _]| x < 0.05);
    let mut turned = straight.clone();
    let (s, c) = (PI / 6.0).sin_cos();
    turned.points.iter_mut().for_each(|p| *p = [c * p[0] - s * p[1], s * p[0] + c * p[1]]);
    let moduli = [(10.0, 0.3), (100.0, 0.2)];
    let supports = [
        CANTILEVER.to_owned(),
        // An edge across the line is held between its nodes on both sides.
        CANTILEVER.replace("}]\nload", "}, { group = \"y-min\", kind = \"hinged\", at = \"bottom\" }]\nload"),
        CANTILEVER.replace("}]\nload", "}, { group = \"y-max\", kind = \"simply-supported\" }]\nload"),
    ];
    for support in supports {
        let [one, other] = [&straight, &turned].map(|mesh| energy(&case(mesh, PRISM, moduli, &support)));
        assert!((one / other - 1.0).abs() < 1e-7, "{support}: {one}, turned {other}");
    }
}

/// A square core with its corners, whole, by a quarter, and condensed by blocks that the line goes through.
#[test]
fn symmetries_and_substructures_know_both_sides() {
    let mesh = with_core(rectangle([0.1, 0.08], [10, 8]), |[x, y]| (x - 0.05).abs() < 0.02 && (y - 0.04).abs() < 0.02);
    let edges = "support = [{ group = \"x-min\", kind = \"clamped\" }, { group = \"x-max\", kind = \"clamped\" }, \
                 { group = \"y-min\", kind = \"simply-supported\" }, { group = \"y-max\", kind = \"simply-supported\" }]\n\
                 load = [{ pressure = \"1 kPa\" }]\n";
    let of = |more: &str| energy(&case(&mesh, PRISM, [(10.0, 0.3), (100.0, 0.3)], &format!("{edges}{more}")));
    let whole = of("");
    let mut quarters = mesh.clone();
    let names = ["a", "b", "c", "d"];
    for (name, [right, upper]) in names.iter().zip([[false, false], [true, false], [false, true], [true, true]]) {
        let part = with_core(mesh.clone(), |[x, y]| (x > 0.06) == right && (y > 0.03) == upper);
        quarters.groups.insert((*name).into(), part.groups["core"].clone());
    }
    let condensed = case(
        &quarters,
        PRISM,
        [(10.0, 0.3), (100.0, 0.3)],
        &format!("{edges}substructures = {{ groups = [\"a\", \"b\", \"c\", \"d\"] }}\n"),
    );
    for (name, other) in [("quarter", of("symmetry = \"quarter\"\n")), ("substructures", energy(&condensed))] {
        assert!((other / whole - 1.0).abs() < 1e-7, "{name}: {other}, whole {whole}");
    }
}

/// What crosses the line is of two values there, and an equation would hold one of them.
#[test]
fn an_equation_names_no_derivative_of_two_values() {
    let mesh = with_core(rectangle([0.1, 0.02], [4, 2]), |[x, _]| x < 0.05);
    let of = |x: u32| {
        let tie = format!(
            "equation = [{{ terms = [{{ dof = \"U31\", at = \"top\", group = \"n{x}\", factor = 1.0 }}, \
             {{ dof = \"U13\", at = \"top\", group = \"n{x}\", factor = 1.0 }}] }}]"
        );
        let mut mesh = mesh.clone();
        let node = mesh.points.iter().position(|p| (p[0] - 1e-3 * f64::from(x)).abs() < 1e-9 && p[1] == 0.01).unwrap();
        mesh.groups.insert(format!("n{x}"), Group { dim: 0, nodes: vec![node as u32], ..Group::default() });
        case(&mesh, PRISM, [(10.0, 0.3), (100.0, 0.3)], &format!("{CANTILEVER}\n{tie}")).fem("run", &["--out", "out"])
    };
    let on_line = of(50);
    assert!(on_line.status == 1 && on_line.stderr.contains("is of two values"), "{on_line:?}");
    of(75).good();
}

/// A disc of radius R in `n` sides whose core of radius a is a group: a square of cells, rings to a, rings to R.
fn disc([a, radius]: [f64; 2], n: usize) -> PlaneMesh {
    let k = n / 4;
    let (inner, outer, half) = (n.div_ceil(8), 3 * n / 16, 0.45 * a);
    let mut mesh = rectangle([2.0 * half, 2.0 * half], [k, k]);
    mesh.groups.clear();
    mesh.points.iter_mut().for_each(|p| *p = p.map(|x| x - half));
    let node = |i: usize, j: usize| (j * (k + 1) + i) as u32;
    let mut ring: Vec<u32> = (0..k).map(|i| node(i, 0)).collect();
    ring.extend((0..k).map(|j| node(k, j)));
    ring.extend((0..k).map(|i| node(k - i, k)));
    ring.extend((0..k).map(|j| node(0, k - j)));
    let square: Vec<[f64; 2]> = ring.iter().map(|node| mesh.points[*node as usize]).collect();
    for step in 1..=inner + outer {
        let first = mesh.points.len() as u32;
        let at = |(m, from): (usize, &[f64; 2])| {
            let angle = PI * (2.0 * m as f64 / n as f64 - 0.75);
            let (s, c) = angle.sin_cos();
            match step.checked_sub(inner) {
                Some(beyond) => [c, s].map(|x| x * (a + (radius - a) * beyond as f64 / outer as f64)),
                None => {
                    let t = step as f64 / inner as f64;
                    [(1.0 - t) * from[0] + t * a * c, (1.0 - t) * from[1] + t * a * s]
                }
            }
        };
        mesh.points.extend(square.iter().enumerate().map(at));
        for m in 0..n {
            let next = (m + 1) % n;
            mesh.quads.push([ring[m], first + m as u32, first + next as u32, ring[next]].into());
        }
        ring = (0..n as u32).map(|m| first + m).collect();
    }
    mesh.node_tags = (1..=mesh.points.len() as u64).collect();
    mesh.quad_tags = (1..=mesh.quads.len() as u64).collect();
    let edges = (0..n).map(|m| [ring[m], ring[(m + 1) % n]]).collect();
    mesh.groups.insert("rim".into(), Group { dim: 1, nodes: ring, edges, quads: Vec::new() });
    let all = with_core(mesh.clone(), |_| true).groups["core"].clone();
    mesh.groups.insert("plate".into(), all);
    with_core(mesh, |p| p[0].hypot(p[1]) < a)
}

/// Deflection of the middle of a clamped disc of Kirchhoff's whose core is ten times as stiff, over that of one as soft everywhere.
///
/// φ = w' = p r³/16D + A r + C/r, C = 0 in the core; φ and D (φ' + ν φ/r) are continuous at a, φ(R) = 0.
fn stiffened([a, radius]: [f64; 2], nu: f64) -> f64 {
    // In units of the outer D, p = 16: of the core, of what is around it.
    let d = [10.0, 1.0];
    // A₁ a − A₂ a − C/a = a³ (1/D₂ − 1/D₁); moments, where particular parts are equal; A₂ R + C/R = −R³.
    let m = nalgebra::Matrix3::new(
        a,
        -a,
        -1.0 / a,
        d[0] * (1.0 + nu),
        -d[1] * (1.0 + nu),
        d[1] * (1.0 - nu) / (a * a),
        0.0,
        radius,
        1.0 / radius,
    );
    let right = nalgebra::Vector3::new(a.powi(3) * (1.0 / d[1] - 1.0 / d[0]), 0.0, -radius.powi(3));
    let found = m.lu().solve(&right).unwrap();
    let core = a.powi(4) / (4.0 * d[0]) + found[0] * a * a / 2.0;
    let ring =
        (radius.powi(4) - a.powi(4)) / 4.0 + found[1] * (radius * radius - a * a) / 2.0 + found[2] * (radius / a).ln();
    -(core + ring) / (radius.powi(4) / 4.0)
}

#[test]
fn a_line_may_be_a_circle() {
    let sizes = [0.02, 0.05];
    let want = stiffened(sizes, 0.3);
    let deflection = |n: usize, stiff: f64| {
        let more = "support = [{ group = \"rim\", kind = \"clamped\" }]\nload = [{ pressure = \"1 kPa\" }]";
        let found = summary(&case(&disc(sizes, n), PRISM, [(10.0, 0.3), (stiff, 0.3)], more));
        found["largest_deflection"]["w_m"].as_f64().unwrap().abs()
    };
    // Nodes that are images of each other to some digits, as files have them: a tie of each would hold what jumps.
    let mut rough = disc(sizes, 32);
    let inner = rough.points.iter_mut().filter(|p| p[0].hypot(p[1]) < 0.045);
    for (k, point) in inner.enumerate() {
        point.iter_mut().for_each(|x| *x += 1e-11 * (7.3 * k as f64 + 1e4 * *x).sin());
    }
    let [whole, quarter] = ["", "symmetry = \"quarter\"\n"].map(|symmetry| {
        let more = format!(
            "{symmetry}support = [{{ group = \"rim\", kind = \"clamped\" }}]\nload = [{{ pressure = \"1 kPa\" }}]"
        );
        energy(&case(&rough, PRISM, [(10.0, 0.3), (100.0, 0.3)], &more))
    });
    assert!((quarter / whole - 1.0).abs() < 1e-6, "{quarter}, whole {whole}");
    // Strains that are shared at the line: 2.4 and 1.1 %.
    for (n, bound) in [(32, 1e-2), (64, 4e-3)] {
        let got = deflection(n, 100.0) / deflection(n, 10.0);
        assert!((got / want - 1.0).abs() < bound, "{n} sides: {got}, not {want}");
    }
}
