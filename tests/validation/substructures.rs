//! Divided plates against undivided ones.

use super::scene::Side::{Clamped, Free, Supported};
use super::scene::{AS4, Plate, gmsh_grid};
use crate::support::strip;
use fem::analyses::assembled::{self, Assembled, Substructures};
use fem::analyses::impact::Outcome;
use fem::analyses::{impact, modes, statics};
use fem::core::dof::Dof;
use fem::core::functional::Functional;
use fem::core::plugin::{Built, Kind, Params, Value};
use fem::core::structure::Structure;
use fem::io::scene;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

/// Agreement of divided and undivided, relative to the largest of what is compared.
const SAME: f64 = 1e-10;

const ONE: NonZeroUsize = NonZeroUsize::MIN;

/// The same plate, divided.
fn divided(plate: &Plate, substructures: &str) -> Plate {
    let mesh = format!("{}\nsubstructures = {{ {substructures} }}", plate.mesh);
    Plate { mesh, ..plate.clone() }
}

fn assembled(model: &Model) -> Assembled {
    assembled::structure(model, true, ONE, &mut Default::default()).unwrap()
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
}

#[track_caller]
fn assert_close(got: &[f64], want: &[f64], tolerance: f64, what: &str) {
    assert_eq!(got.len(), want.len(), "{what}");
    let worst = got.iter().zip(want).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(worst <= tolerance * largest(want), "{what}: {worst:e} of {:e}", largest(want));
}

/// Displacements, energy and margins of a divided plate are those of the undivided one.
#[track_caller]
fn check(plate: &Plate, substructures: &str) -> Substructures {
    let [whole, parts] = [plate.clone(), divided(plate, substructures)].map(|p| p.model("static"));
    let [a, b] = [&whole, &parts].map(|m| statics::solve(m, ONE).unwrap());
    for group in [0..1, 4..5, 8..9, 1..4, 5..8, 9..12] {
        let of = |u: &[f64]| -> Vec<f64> {
            let kind = |dof: usize| group.clone().any(|k| whole.plate.locate(dof).2 == Dof::SOLID[k]);
            (0..u.len()).filter(|dof| kind(*dof)).map(|dof| u[dof]).collect()
        };
        assert_close(&of(&b.u), &of(&a.u), SAME, &format!("{substructures}, unknowns {group:?}"));
    }
    assert!((a.strain_energy / b.strain_energy - 1.0).abs() < SAME, "{} {}", a.strain_energy, b.strain_energy);
    assert_eq!((a.resultant, a.unknowns), (b.resultant, b.unknowns));
    assert!(b.residual < 1e-6, "{}", b.residual);
    assert!(!a.margins.is_empty() && a.margins.len() == b.margins.len());
    for (a, b) in a.margins.iter().zip(&b.margins) {
        assert!((a.reserve_factor / b.reserve_factor - 1.0).abs() < SAME, "{a:?} {b:?}");
    }
    b.substructures.unwrap()
}

/// 60 x 40 mm under a pressure without symmetry.
fn pressed(layers: Vec<usize>, cells: [usize; 2]) -> Plate {
    held(layers, cells).pressure("1 + 0.3*(x-30)*(y-20)/600 + x/60")
}

/// 60 x 40 mm.
fn held(layers: Vec<usize>, cells: [usize; 2]) -> Plate {
    let material = format!(
        "{AS4}Xt = '1400 MPa'\nXc = '1130 MPa'\nYt = '70 MPa'\nYc = '200 MPa'\n\
         Zt = '70 MPa'\nZc = '200 MPa'\nS12 = '99 MPa'\nS13 = '99 MPa'\nS23 = '60 MPa'\n"
    );
    let mut plate = Plate::new(&material, "[0/45/-45/90]s", 0.25, layers)
        .rectangle([60.0, 40.0], cells)
        .sides([Supported, Clamped, Free, Clamped]);
    plate.more.push_str("[failure]\ncriteria = ['tsai-wu']\n");
    plate
}

#[test]
fn statics_of_every_element_are_exact() {
    for (element, layers) in [
        ("kind = 'hermite-prism'", vec![2, 6]),
        ("kind = 'hermite-hex'", vec![4, 4]),
        ("kind = 'hermite-prism', z_derivatives = 'layer-wise'", vec![4, 4]),
        ("kind = 'hex20'", vec![8]),
        ("kind = 'mitc4'", vec![8]),
    ] {
        let plate = pressed(layers.clone(), [6, 4]).element(element);
        for (cells, count) in [("[3, 2]", 4), ("[6, 4]", 1), ("[2, 4]", 3)] {
            let parts = check(&plate, &format!("cells = {cells}"));
            // Equal but for supports on their outlines.
            assert_eq!((parts.count, parts.condensed), (count, 1), "{element} {cells}");
        }
    }
}

#[test]
fn a_beam_of_repeated_cells() {
    let mut plate = pressed(vec![8], [12, 1]).element("kind = 'webster-beam'");
    plate.sides = [Clamped, Supported, Free, Free];
    let parts = check(&plate, "cells = [3, 1]");
    assert_eq!((parts.count, parts.condensed), (4, 1));
}

/// The surface `plate` of a grid, with its parts left and right of `split` cells.
fn two_surfaces(cells: [usize; 2], split: usize, distortion: f64) -> tempfile::TempDir {
    let lines = |n: usize, size: f64| (0..=n).map(|i| size * i as f64 / n as f64).collect::<Vec<f64>>();
    let grid = gmsh_grid(&lines(cells[0], 60.0), &lines(cells[1], 40.0), distortion);
    let text = std::fs::read_to_string(grid.path().join("plate.msh")).unwrap();
    let count = cells[0] * cells[1];
    let (head, quads) = text.split_once(&format!("\n2 5 3 {count}\n")).unwrap();
    let mut head = head.to_owned();
    for (from, to) in [
        ("$PhysicalNames\n6\n", "$PhysicalNames\n8\n"),
        ("2 5 \"plate\"\n", "2 5 \"plate\"\n2 6 \"left\"\n2 7 \"right\"\n"),
        ("$Entities\n1 4 1 0\n", "$Entities\n1 4 2 0\n"),
        ("5 0 0 0 0 0 0 1 5 0\n", "5 0 0 0 0 0 0 2 5 6 0\n6 0 0 0 0 0 0 2 5 7 0\n"),
        ("$Elements\n6 ", "$Elements\n7 "),
    ] {
        assert_eq!(head.matches(from).count(), 1, "{from:?}");
        head = head.replace(from, to);
    }
    let is_left = |line: &(usize, &str)| line.0 % cells[0] < split;
    let lines = quads.lines().take(count).enumerate();
    let (left, right): (Vec<_>, Vec<_>) = lines.partition(is_left);
    let block = |lines: Vec<(usize, &str)>| lines.into_iter().map(|line| format!("{}\n", line.1)).collect::<String>();
    let (l, r) = (left.len(), right.len());
    let text = format!("{head}\n2 5 3 {l}\n{}2 6 3 {r}\n{}$EndElements\n", block(left), block(right));
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("plate.msh"), text).unwrap();
    folder
}

#[test]
fn surfaces_of_a_mesh_and_cells_beside_them() {
    let folder = two_surfaces([6, 4], 4, 0.2);
    let mut plate = pressed(vec![4, 4], [1, 1]);
    plate.mesh = format!("{{ file = '{}', unit = 'mm' }}", folder.path().join("plate.msh").display());
    let parts = check(&plate, "groups = ['left', 'right']");
    assert_eq!((parts.count, parts.condensed), (2, 2));
    let left_alone = check(&plate, "groups = ['left']");
    assert_eq!((left_alone.count, left_alone.condensed), (1, 1));
    assert!(left_alone.masters > parts.masters);
}

/// Supports, ties and chosen masters inside of substructures.
#[test]
fn what_is_special_inside_stays() {
    let mut plate = pressed(vec![4, 4], [1, 1]);
    let folder = two_surfaces([6, 6], 3, 0.0);
    plate.mesh = format!("{{ file = '{}', unit = 'mm' }}", folder.path().join("plate.msh").display());
    let bare = check(&plate, "groups = ['left', 'right']");
    assert_eq!((bare.count, bare.condensed), (2, 1));
    let chosen =
        check(&plate, "groups = ['left', 'right'], masters = [{ group = 'left', at = 'top', dofs = ['U30'] }]");
    assert_eq!((chosen.count, chosen.condensed), (2, 2));
    // 2 x 5 nodes inside.
    assert_eq!(chosen.masters, bare.masters + 10);
    plate.more.push_str("[[couple]]\ngroup = 'right'\nat = 'bottom'\ndofs = ['U11']\n");
    let tied = check(&plate, "groups = ['left', 'right']");
    assert_eq!((tied.count, tied.condensed), (2, 2));
}

/// K* = TᵀKT and M* = TᵀMT of the undivided matrices, also where one substructure stands for others.
#[test]
fn condensed_matrices_are_those_of_the_shapes() {
    let plate = held(vec![4, 4], [6, 4]);
    let (whole, parts) = (plate.model("modes"), divided(&plate, "cells = [3, 2]").model("modes"));
    let (whole, parts) = (assembled(&whole), assembled(&parts));
    let (n, m) = (whole.structure.ndof(), parts.structure.ndof());
    let mut unit = vec![0.0; m * m];
    (0..m).for_each(|i| unit[i * (m + 1)] = 1.0);
    let shapes = parts.expand(unit.clone());
    let products = |add: &dyn Fn(&[f64], &mut [f64]), x: &[f64], rows: usize| {
        let mut y = vec![0.0; x.len()];
        add(x, &mut y);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let columns = |y: &[f64]| x.chunks_exact(rows).map(|x| dot(x, y)).collect::<Vec<f64>>();
        y.chunks_exact(rows).flat_map(columns).collect::<Vec<f64>>()
    };
    let scaled = |a: Vec<f64>| -> Vec<f64> {
        let d: Vec<f64> = (0..m).map(|i| a[i * (m + 1)].sqrt()).collect();
        a.iter().enumerate().map(|(at, a)| a / d[at / m] / d[at % m]).collect()
    };
    let k = |s: &dyn Structure, x: &[f64], rows| scaled(products(&|x, y| s.add_stiffness(1.0, x, y), x, rows));
    assert_close(&k(&parts.structure, &unit, m), &k(&whole.structure, &shapes, n), SAME, "stiffness");
    let mass = |s: &dyn Structure, x: &[f64], rows| scaled(products(&|x, y| s.add_mass(1.0, x, y), x, rows));
    assert_close(&mass(&parts.structure, &unit, m), &mass(&whole.structure, &shapes, n), SAME, "mass");
}

/// Where nothing is inside, nothing changes: K and M have the same entries, frequencies are the same.
#[test]
fn without_an_inside_the_plate_is_undivided() {
    let plate = held(vec![4, 4], [6, 4]);
    let one = divided(&plate, "cells = [1, 1]");
    let (a, b) = (assembled(&plate.model("modes")), assembled(&one.model("modes")));
    assert_eq!((a.structure.entries(), a.factor_entries), (b.structure.entries(), b.factor_entries));
    assert_eq!(b.substructures().unwrap(), Substructures { count: 0, condensed: 0, masters: a.structure.ndof() });
    assert_close(&one.frequencies(6), &plate.frequencies(6), SAME, "frequencies");
    check(&pressed(vec![4, 4], [6, 4]), "cells = [1, 1]");
}

/// Fewer masters are a smaller space of shapes: every frequency rises.
#[test]
fn frequencies_come_from_above() {
    let plate = held(vec![4, 4], [8, 8]);
    let mut below = plate.frequencies(6);
    let exact = below.clone();
    for (cells, error) in [("[2, 2]", 1e-3), ("[4, 4]", 2e-2), ("[8, 8]", 1.0)] {
        let omega = divided(&plate, &format!("cells = {cells}")).frequencies(6);
        let first = omega[0] / exact[0] - 1.0;
        assert!(first < error, "{cells}: {first:e}");
        assert!(omega.iter().zip(&below).all(|(a, b)| *a > b * (1.0 + 1e-9)), "{cells}: {omega:?} {below:?}");
        below = omega;
    }
    // Shapes and masses are those of all unknowns.
    let model = divided(&plate, "cells = [2, 2]").model("modes");
    let [a, b] = [plate.model("modes"), model].map(|m| modes::solve(&m, 1, ONE).unwrap());
    assert_eq!(a.modes.shapes.len(), b.modes.shapes.len());
    assert!((a.effective_masses[0][2] / b.effective_masses[0][2] - 1.0).abs() < 1e-3);
    let shapes = [&a, &b].map(|s| s.modes.shapes.iter().map(|x| x.abs()).collect::<Vec<f64>>());
    assert_close(&shapes[1], &shapes[0], 1e-2, "first mode");
}

const IMPACT: &str = "title = 'strike'\nmesh = { rectangle = ['60 mm', '40 mm'], cells = [12, 8] }\n\
     materials.m = { library = 'AS4/3502', Yt = '2 MPa' }\n\
     laminate = { plies = '[0/45/-45/90]s', material = 'm', ply_thickness = '0.25 mm', layers = 2 }\n\
     impactor = { mass = '0.5 kg', velocity = '1 m/s', at = { x = '27 mm', y = '22 mm' } }\n\
     contact = { law = 'hertz', k = '1e5 N/mm^1.5' }\n\
     failure = { criteria = ['hashin-report'] }\n\
     support = [{ group = 'x-min', at = 'all', fix = ['U10', 'U20', 'U30'] }, { group = 'x-max', at = 'all', fix = ['U10', 'U20', 'U30'] }]\n";

const MARCH: &str = "march = { integrator = 'newmark', step = '1 us', end = '0.2 ms' }\n";

fn struck(more: &str) -> Model {
    let scene = scene::parse(&format!("{more}\n{IMPACT}"), "scene.toml".as_ref()).unwrap();
    Model::new(scene, &Registry::standard()).unwrap()
}

fn march(more: &str) -> Outcome {
    let model = struck(more);
    let outcome = impact::march(impact::prepare(&model, ONE).unwrap(), |_| {}).unwrap();
    assert_eq!(outcome.stopped, None);
    outcome
}

/// Two stages of condensation with the same governors are one.
#[test]
fn governors_of_masters_are_governors_of_all() {
    let [whole, parts] = ["", "substructures = { cells = [4, 4] }"].map(|more| struck(&format!("{MARCH}{more}")));
    let fem::Plan::Impact(impact) = &whole.plan else { panic!() };
    let contact = impact.strikes[0].contact.clone();
    let (mut whole_assembled, mut assembled) = (assembled(&whole), assembled(&parts));
    let condensation = assembled.condensation.as_ref().unwrap();
    let governors: Vec<usize> = whole.governors(impact, 2000);
    let (all, masters): (Vec<usize>, Vec<usize>) =
        governors.iter().filter_map(|i| Some((*i, condensation.master(*i)?))).take(20).unzip();
    assert_eq!(all.len(), 20);
    let on_masters: Vec<_> = contact.0.iter().map(|(i, w)| (condensation.master(*i).unwrap(), *w)).collect();
    let params = Params::default().with("governors", Value::Number(20.0));
    let Ok(Built::Reduction(guyan)) = Registry::standard().build(Kind::Reduction, "guyan", &params) else { panic!() };
    let one = guyan.basis(&mut whole_assembled.structure, &[contact], &all).unwrap();
    let two = guyan.basis(&mut assembled.structure, &[Functional(on_masters)], &masters).unwrap();
    let form = |add: &dyn Fn(&[f64], &mut [f64]), basis: &[f64]| -> Vec<f64> {
        let mut image = vec![0.0; basis.len()];
        add(basis, &mut image);
        let n = basis.len() / 21;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        image.chunks_exact(n).flat_map(|y| basis.chunks_exact(n).map(move |x| dot(x, y))).collect()
    };
    let (a, b) = (&whole_assembled.structure, &assembled.structure);
    let [ka, kb] = [form(&|x, y| a.add_stiffness(1.0, x, y), &one), form(&|x, y| b.add_stiffness(1.0, x, y), &two)];
    assert_close(&kb, &ka, 1e-9, "stiffness");
    let [ma, mb] = [form(&|x, y| a.add_mass(1.0, x, y), &one), form(&|x, y| b.add_mass(1.0, x, y), &two)];
    assert_close(&mb, &ma, 1e-9, "mass");
    for (k, (two, one)) in assembled.expand(two).chunks(a.ndof()).zip(one.chunks(a.ndof())).enumerate() {
        assert_close(two, one, 1e-9, &format!("shape {k}"));
    }
}

/// Governors named one by one, by the places that the rule finds, are the same governors; others are not.
#[test]
fn governors_that_are_named_are_those_that_govern() {
    let key = |more: &str| {
        format!(
            "{MARCH}substructures = {{ cells = [2, 2] }}\nreduction = {{ method = 'guyan', governors = 5{more} }}\n"
        )
    };
    let coarse = |more: &str| {
        let text = format!("{more}\n{IMPACT}").replace("[12, 8]", "[6, 4]");
        Model::new(scene::parse(&text, "scene.toml".as_ref()).unwrap(), &Registry::standard()).unwrap()
    };
    let coarse_march = |more: &str| impact::march(impact::prepare(&coarse(more), ONE).unwrap(), |_| {}).unwrap();
    let model = coarse(&key(""));
    let fem::Plan::Impact(impact) = &model.plan else { panic!() };
    let assembled = assembled(&model);
    let condensation = assembled.condensation.as_ref().unwrap();
    let chosen = model.governors(impact, 2000).into_iter().filter(|i| condensation.master(*i).is_some()).take(5);
    let named = |i: usize| {
        let (column, _, _) = model.plate.locate(model.constraints.original(i));
        let [x, y] = model.plate.columns[column];
        format!("{{ x = '{x:?} m', y = '{y:?} m', at = 'mid-plane', dofs = ['U30'] }}")
    };
    let mut places: Vec<String> = chosen.map(named).collect();
    let force = |o: &Outcome| o.history.iter().map(|r| r.contact_force_n()).collect::<Vec<f64>>();
    let by_rule = force(&coarse_march(&key("")));
    let by_name = |places: &[String]| force(&coarse_march(&key(&format!(", keep = [{}]", places.join(", ")))));
    assert_eq!(by_name(&places), by_rule);
    assert_eq!(by_name(&places[..2]), by_rule, "the rule goes on from those that are named");
    places.reverse();
    assert_close(&by_name(&places), &by_rule, 1e-7, "in another order");
    let elsewhere = "{ x = '20 mm', y = '10 mm', at = 'top', dofs = ['U30', 'U31'] }";
    let off: Vec<f64> = by_name(&[elsewhere.into()]).iter().zip(&by_rule).map(|(a, b)| a - b).collect();
    assert!(largest(&off) > 1e-4 * largest(&by_rule), "{}", largest(&off));
}

#[test]
fn governors_that_cannot_be_named_are_refused() {
    let refused = |reduction: &str| {
        let text = format!("{MARCH}reduction = {{ {reduction} }}\n{IMPACT}").replace("[12, 8]", "[6, 4]");
        let scene = scene::parse(&text, "scene.toml".as_ref()).unwrap();
        format!("{:?}", miette::Report::new(Model::new(scene, &Registry::standard()).unwrap_err()))
    };
    let keep = |at: &str| format!("keep = [{{ {at}, at = 'mid-plane', dofs = ['U30'] }}]");
    let middle = keep("x = '30 mm', y = '20 mm'");
    for (reduction, words) in [
        (format!("method = 'ritz', vectors = 9, {middle}"), "`ritz` keeps no governors"),
        (format!("method = 'guyan', governors = 9, select = 'ratio', {middle}"), "to be selected by their ratios"),
        (
            format!("method = 'guyan', governors = 9, {}", keep("x = '31 mm', y = '20 mm'")),
            "no node of the mesh lies at (31.000000,",
        ),
        (format!("method = 'guyan', governors = 9, {}", keep("x = '60 mm', y = '20 mm'")), "it cannot govern"),
        (format!("method = 'guyan', governors = 2, {}", keep("group = 'y-min'")), "`governors` keeps 2"),
    ] {
        let said = refused(&reduction);
        assert!(said.contains(words), "{reduction}: {said}");
    }
}

/// Force, energies and stresses of an impact, with a reduction on the masters and without.
#[test]
fn an_impact_on_substructures() {
    for reduction in ["method = 'none'", "method = 'ritz', vectors = 40"] {
        let key = format!("reduction = {{ {reduction} }}\n{MARCH}");
        let whole = march(&key);
        let parts = march(&format!("{key}substructures = {{ cells = [2, 2] }}\n"));
        assert!(parts.energy_error < 1.2 * whole.energy_error, "{} {}", parts.energy_error, whole.energy_error);
        let force = |o: &Outcome| o.history.iter().map(|r| r.contact_force_n()).collect::<Vec<f64>>();
        assert!(largest(&force(&whole)) > 100.0);
        // What the masses inside lose with their motion of their own: 1.9 % of the peak.
        assert_close(&force(&parts), &force(&whole), 3e-2, reduction);
        assert_eq!(whole.sites, parts.sites);
        assert!(!whole.events.is_empty() && !whole.peaks.is_empty());
        for (a, b) in whole.peaks.iter().zip(&parts.peaks).filter(|(a, _)| a.index > 0.1) {
            assert!((a.index / b.index - 1.0).abs() < 0.05, "{reduction}: {a:?} {b:?}");
        }
        // Nothing inside: all as without substructures.
        if reduction.contains("none") {
            let same = march(&format!("{key}substructures = {{ cells = [1, 1] }}\n"));
            assert_close(&force(&same), &force(&whole), 1e-9, "all are masters");
            assert_eq!(same.events.len(), whole.events.len());
        }
    }
}

/// Blocks that a fold does not cut are condensed as those of the whole plate: forces, and frequencies of symmetric modes, are the
/// same, at a fraction of the masters.
#[test]
fn an_impact_on_folded_substructures() {
    let central = |more: &str| {
        let scene =
            format!("{more}\nsubstructures = {{ cells = [2, 2] }}\n{MARCH}reduction = {{ method = 'none' }}\n{IMPACT}")
                .replace("x = '27 mm', y = '22 mm'", "x = '30 mm', y = '20 mm'")
                .replace("0.2 ms", "0.05 ms");
        let model = Model::new(scene::parse(&scene, "scene.toml".as_ref()).unwrap(), &Registry::standard()).unwrap();
        let prepared = impact::prepare(&model, ONE).unwrap();
        let masters = prepared.sizes.substructures.unwrap().masters;
        (masters, impact::march(prepared, |_| {}).unwrap())
    };
    let ((all, whole), (half, folded)) = (central(""), central("symmetry = 'half-turn'"));
    assert!((0.45..0.6).contains(&(half as f64 / all as f64)), "{half} of {all}");
    let force = |o: &Outcome| o.history.iter().map(|r| r.contact_force_n()).collect::<Vec<f64>>();
    assert!(largest(&force(&whole)) > 20.0);
    assert_close(&force(&folded), &force(&whole), 1e-7, "force");
    assert_eq!(folded.stopped, None);
    for (a, b) in whole.peaks.iter().zip(&folded.peaks) {
        assert!((a.index / b.index - 1.0).abs() < 1e-6, "{a:?} {b:?}");
    }
    let plate = divided(&held(vec![4, 4], [6, 4]).sides([Supported, Supported, Clamped, Clamped]), "cells = [3, 2]");
    let turned = Plate { mesh: format!("{}\nsymmetry = 'half-turn'", plate.mesh), ..plate.clone() };
    let (all, symmetric) = (plate.frequencies(12), turned.frequencies(4));
    for omega in symmetric {
        assert!(all.iter().any(|other| (other / omega - 1.0).abs() < 1e-9), "{omega} of {all:?}");
    }
}

#[test]
fn the_command_says_how_the_plate_is_divided() {
    let scene = divided(&pressed(vec![4, 4], [6, 4]), "cells = [3, 2]").text("static");
    let case = strip().text(&scene);
    let words = "masters of 4 substructures, 1 condensed and 3 reused";
    let checked = case.fem("check", &["--full"]).good().stdout;
    assert!(checked.contains(words), "{checked}");
    let ran = case.fem("run", &["--out", "results"]).good().stdout;
    assert!(ran.contains(words), "{ran}");
    let summary = case.summary("results");
    let parts = &summary["substructures"];
    assert_eq!((parts["count"].as_u64(), parts["condensed"].as_u64()), (Some(4), Some(1)), "{summary}");
    assert!(parts["masters"].as_u64() < summary["unknowns"].as_u64(), "{summary}");
}
