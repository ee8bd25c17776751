//! Folded plates against whole ones.

use super::scene::Side::{Clamped, Free, Supported};
use super::scene::{AS4, Plate, gmsh_grid};
use crate::support::{plate, root, whole};
use fem::analyses::impact::Outcome;
use fem::analyses::{impact, modes, statics};
use fem::core::dof::Dof;
use fem::io::scene;
use fem::{Model, Registry};
use std::num::NonZeroUsize;

/// Agreement of folded and whole, relative to the largest of what is compared.
const SAME: f64 = 1e-10;

/// The same plate, folded.
fn folded(plate: &Plate, symmetry: &str) -> Plate {
    let mesh = format!("{}\nsymmetry = '{symmetry}'", plate.mesh);
    Plate { mesh, ..plate.clone() }
}

/// Displacements, energy and margins of a folded plate are those of the whole, at `share` of its unknowns.
fn check(plate: &Plate, symmetry: &str, share: std::ops::Range<f64>) {
    let [whole, part] = [plate.clone(), folded(plate, symmetry)].map(|p| p.model("static"));
    let [a, b] = [&whole, &part].map(|m| statics::solve(m, NonZeroUsize::MIN).unwrap());
    let of = |k: usize, u: &[f64]| {
        let kind = |(dof, _): &(usize, &f64)| whole.plate.locate(*dof).2 == Dof::SOLID[k];
        u.iter().enumerate().filter(kind).map(|(_, u)| *u).collect::<Vec<f64>>()
    };
    for group in [0..1, 4..5, 8..9, 1..4, 5..8, 9..12] {
        let (ua, ub): (Vec<f64>, Vec<f64>) =
            group.clone().flat_map(|k| of(k, &a.u).into_iter().zip(of(k, &b.u)).collect::<Vec<_>>()).unzip();
        let largest = ua.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let worst = ua.iter().zip(&ub).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(worst <= SAME * largest, "{symmetry}, unknowns {group:?}: {worst:e} of {largest:e}");
    }
    assert!((a.strain_energy / b.strain_energy - 1.0).abs() < SAME, "{} {}", a.strain_energy, b.strain_energy);
    assert_eq!(a.resultant, b.resultant);
    assert!(share.contains(&(b.unknowns as f64 / a.unknowns as f64)), "{} of {}", b.unknowns, a.unknowns);
    assert!(!a.margins.is_empty() && a.margins.len() == b.margins.len());
    for (a, b) in a.margins.iter().zip(&b.margins) {
        assert!((a.reserve_factor / b.reserve_factor - 1.0).abs() < SAME, "{a:?} {b:?}");
        assert_eq!((&a.criterion, &a.mode), (&b.criterion, &b.mode));
    }
}

/// 60 x 40 mm under a pressure that a half-turn keeps and, with `odd` zero, mirrors too.
fn pressed(plies: &str, layers: Vec<usize>, cells: [usize; 2], odd: f64) -> Plate {
    let material = format!(
        "{AS4}Xt = '1400 MPa'\nXc = '1130 MPa'\nYt = '70 MPa'\nYc = '200 MPa'\n\
         Zt = '70 MPa'\nZc = '200 MPa'\nS12 = '99 MPa'\nS13 = '99 MPa'\nS23 = '60 MPa'\n"
    );
    let pressure = format!("1 + ((x-30)/30)^2 + {odd}*(x-30)*(y-20)/600");
    let mut plate = Plate::new(&material, plies, 0.25, layers).rectangle([60.0, 40.0], cells).pressure(&pressure);
    plate.more.push_str("[failure]\ncriteria = ['tsai-wu']\nwindow = '12 mm'\n");
    plate
}

#[test]
fn angle_plies_under_a_half_turn() {
    for (element, layers, share) in [
        ("kind = 'hermite-prism'", vec![2, 6], 0.45..0.56),
        ("kind = 'hermite-hex'", vec![4, 4], 0.45..0.56),
        ("kind = 'hermite-prism', z_derivatives = 'layer-wise'", vec![4, 4], 0.45..0.56),
        ("kind = 'hex20'", vec![8], 0.45..0.56),
        ("kind = 'mitc4'", vec![8], 0.45..0.56),
    ] {
        // Cells that lie on the axis, on both lines through it, and on one.
        for cells in [[5, 3], [4, 4], [5, 4]] {
            let plate = pressed("[0/45/-45/90]s", layers.clone(), cells, 0.7).element(element);
            check(&plate.clone().sides([Supported, Supported, Clamped, Clamped]), "half-turn", share.clone());
        }
    }
}

/// Substructures that a fold leaves whole, that it cuts, and of which one is the plate.
#[test]
fn folded_plates_of_substructures() {
    let (prism, solid) = (("kind = 'hermite-prism'", [1, 3]), ("kind = 'hex20'", [2, 2]));
    for ((element, layers), cells, blocks) in
        [(prism, [6, 4], "[3, 2]"), (solid, [6, 4], "[3, 2]"), (prism, [4, 6], "[4, 2]"), (prism, [5, 3], "[5, 3]")]
    {
        let divided = |mut plate: Plate| {
            plate.mesh.push_str(&format!("\nsubstructures = {{ cells = {blocks} }}"));
            plate.element(element).sides([Supported, Supported, Clamped, Clamped])
        };
        let plate = divided(pressed("[0/45/-45/90]", layers.to_vec(), cells, 0.7));
        check(&plate, "half-turn", 0.4..0.65);
        let plate = divided(pressed("[0/90/0/90]", layers.to_vec(), cells, 0.0));
        for (symmetry, share) in [("mirror-x", 0.4..0.65), ("mirror-y", 0.4..0.7), ("quarter", 0.2..0.4)] {
            check(&plate, symmetry, share);
        }
    }
}

#[test]
fn cross_plies_under_mirrors() {
    for element in ["kind = 'hermite-prism'", "kind = 'hex20'", "kind = 'mitc4'"] {
        for cells in [[5, 3], [6, 4], [5, 4]] {
            let layers = if element.contains("mitc4") { vec![4] } else { vec![1, 3] };
            let plate = pressed("[0/90]s", layers, cells, 0.0).element(element).sides([Clamped; 4]);
            check(&plate, "mirror-x", 0.35..0.6);
            check(&plate, "mirror-y", 0.35..0.6);
            check(&plate, "quarter", 0.12..0.4);
        }
    }
}

/// Deflections beyond the thickness.
#[test]
fn large_deflections() {
    let on = "[effects]\nmembrane = 'on'";
    for element in ["kind = 'hermite-prism'", "kind = 'mitc4'"] {
        let layers = if element.contains("mitc4") { vec![4] } else { vec![1, 3] };
        let plate = pressed("[0/90]s", layers, [6, 4], 0.0).element(element).sides([Clamped; 4]).with(on);
        assert!(plate.solve().u.iter().any(|u| u.abs() > 1e-3));
        check(&plate, "quarter", 0.12..0.4);
    }
    let plate = pressed("[0/45/-45/90]s", vec![8], [4, 4], 0.7).element("kind = 'mitc4'").with(on);
    check(&plate.sides([Supported, Supported, Clamped, Clamped]), "half-turn", 0.45..0.56);
}

/// Plies that follow a law: what the images of a cell are stressed by is the image of its stress.
#[test]
fn plies_that_follow_laws() {
    let yielding = |mut plate: Plate| {
        plate.material.push_str("law = { name = 'hahn-tsai', alpha = '2.4e-8 1/MPa^3' }\n");
        plate
    };
    let plate = yielding(pressed("[0/45/-45/90]s", vec![4, 4], [5, 3], 0.7));
    let linear = pressed("[0/45/-45/90]s", vec![4, 4], [5, 3], 0.7).solve().u;
    let most = |u: &[f64]| u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    assert!(most(&plate.solve().u) > 1.001 * most(&linear), "the law acts");
    check(&plate.sides([Supported, Supported, Clamped, Clamped]), "half-turn", 0.45..0.56);
    let plate = yielding(pressed("[0/90]s", vec![2, 2], [6, 4], 0.0)).sides([Clamped; 4]);
    ["mirror-x", "mirror-y", "quarter"].iter().for_each(|symmetry| check(&plate, symmetry, 0.12..0.6));
}

/// A plate that nothing holds in its plane: the half-turn leaves one motion to restrain, both mirrors none.
#[test]
fn what_the_symmetry_leaves_free_is_restrained() {
    let ring = |plate: Plate| {
        let mut plate = plate.sides([Free; 4]);
        for group in ["x-min", "x-max", "y-min", "y-max"] {
            plate.more.push_str(&format!("[[support]]\ngroup = '{group}'\nat = 'bottom'\nfix = ['U30']\n"));
        }
        plate
    };
    check(&ring(pressed("[0/45/-45/90]s", vec![4, 4], [6, 4], 0.7)), "half-turn", 0.45..0.56);
    check(&ring(pressed("[0/90]s", vec![2, 2], [6, 4], 0.0)), "quarter", 0.2..0.4);
    let lines = |n: usize, size: f64| (0..=n).map(|i| size * i as f64 / n as f64).collect::<Vec<f64>>();
    let mesh = gmsh_grid(&lines(6, 60.0), &lines(4, 40.0), 0.0);
    let plate = pressed("[0/45/-45/90]s", vec![4, 4], [6, 4], 0.7).on(&mesh);
    check(&ring(plate), "half-turn", 0.45..0.56);
}

/// The modes of a folded plate are those of the whole that are symmetric, all of them.
#[test]
fn symmetric_modes_alone_and_all_of_them() {
    for (plies, symmetry, signs) in [
        ("[0/45/-45/90]s", "half-turn", [-1.0, -1.0]),
        ("[0/90]s", "mirror-x", [-1.0, 1.0]),
        ("[0/90]s", "mirror-y", [1.0, -1.0]),
    ] {
        let layers = if plies.contains("45") { vec![4, 4] } else { vec![2, 2] };
        let plate = Plate::new(AS4, plies, 0.25, layers).rectangle([60.0, 40.0], [6, 5]).sides([Clamped; 4]);
        let model = plate.model("modes");
        let all = modes::solve(&model, 12, NonZeroUsize::MIN).unwrap().modes;
        let level = model.plate.mid_level().unwrap();
        let mut u = vec![0.0; model.plate.ndof()];
        let mut even = |shape: &[f64]| {
            model.constraints.expand(shape, &mut u);
            let w = |column: usize| model.plate.dofs_at(column, level, Dof::SOLID[8]).next().map_or(0.0, |d| u[d]);
            let columns = &model.plate.columns;
            let image = |[x, y]: [f64; 2]| [30e-3 + signs[0] * (x - 30e-3), 20e-3 + signs[1] * (y - 20e-3)];
            let (mut same, mut sum) = (0.0_f64, 0.0_f64);
            for (column, place) in columns.iter().enumerate() {
                let [x, y] = image(*place);
                let other = columns.iter().position(|p| (p[0] - x).hypot(p[1] - y) < 1e-9).unwrap();
                same += w(column) * w(other);
                sum += w(column).powi(2);
            }
            assert!((same.abs() / sum - 1.0).abs() < 1e-6, "a mode is even or odd: {same} of {sum}");
            same > 0.0
        };
        let shapes = all.shapes.chunks_exact(model.constraints.ndof());
        let want: Vec<f64> = all.omega.iter().zip(shapes).filter(|(_, shape)| even(shape)).map(|(w, _)| *w).collect();
        assert!((3..12).contains(&want.len()), "{want:?}");
        let got = folded(&plate, symmetry).frequencies(want.len());
        for (got, want) in got.iter().zip(&want) {
            assert!((got / want - 1.0).abs() < SAME, "{symmetry}: {got} {want}");
        }
    }
}

/// The masses that move with the modes along an axis add up to the same; none moves across a mirror.
#[test]
fn effective_masses_are_those_of_the_whole() {
    let plate = Plate::new(AS4, "[0/90]s", 0.25, vec![2, 2]).rectangle([60.0, 40.0], [4, 4]).sides([Clamped; 4]);
    let solve = |plate: &Plate| modes::solve(&plate.model("modes"), 3, NonZeroUsize::MIN).unwrap().effective_masses;
    let (whole, part) = (solve(&plate), solve(&folded(&plate, "quarter")));
    assert!((whole[0][2] / part[0][2] - 1.0).abs() < 1e-8, "{whole:?} {part:?}");
    assert!(part.iter().all(|m| m[0] == 0.0 && m[1] == 0.0), "{part:?}");
}

/// The first example, changed.
fn impact(edits: &[(&str, &str)]) -> (Model, Outcome) {
    let path = root().join("examples/as4-3502-16ply-50mm/scene.toml");
    let mut text = whole(&std::fs::read_to_string(&path).unwrap());
    for (from, to) in edits {
        assert!(text.contains(from), "no `{from}`");
        text = text.replace(from, to);
    }
    let model = Model::new(scene::parse(&text, &path).unwrap(), &Registry::standard()).unwrap();
    let outcome = impact::march(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), |_| {}).unwrap();
    assert_eq!(outcome.stopped, None);
    (model, outcome)
}

/// Histories within `rounding` of their peaks, and the same events.
fn compare(symmetry: &str, edits: &[(&str, &str)], rounding: f64) {
    let key = format!("symmetry = '{symmetry}'\nmesh = {{");
    let (whole, a) = impact(edits);
    let (part, b) = impact(&[edits, &[("mesh = {", &key)]].concat());
    let peak = a.history.iter().fold(0.0_f64, |m, r| m.max(r.contact_force_n()));
    let worst = a.history.iter().zip(&b.history).map(|(a, b)| (a.contact_force_n() - b.contact_force_n()).abs());
    let worst = worst.fold(0.0, f64::max);
    assert!(peak > 100.0 && worst <= rounding * peak, "{symmetry}: {worst:e} of {peak}");
    assert_eq!(a.history.len(), b.history.len());
    assert!(!a.events.is_empty() && a.events.len() == b.events.len(), "{} {}", a.events.len(), b.events.len());
    for (a, b) in a.events.iter().zip(&b.events) {
        assert_eq!((&a.criterion, a.mode, a.place), (&b.criterion, b.mode, b.place));
        // Places on a plane of symmetry are judged by strains from both sides of it.
        assert!((a.time / b.time - 1.0).abs() < 20.0 * rounding, "{a:?} {b:?}");
        // Several cells may hold the place.
        let mesh = &whole.plate.plane;
        let at = [a.position[0], a.position[1]];
        let mut holding = (0..mesh.quads.len()).filter(|quad| mesh.corners(*quad).locate(at).is_some());
        assert!(holding.any(|quad| part.plate.symmetry().quad(quad) == b.cell as usize), "{a:?} {b:?}");
    }
    assert!(part.constraints.ndof() as f64 <= 0.56 * whole.constraints.ndof() as f64);
    assert!(2 * b.sites <= a.sites + a.sites / 10, "{} of {}", b.sites, a.sites);
}

const WEAK: (&str, &str) = ("library = \"AS4/3502\"", "library = \"AS4/3502\", Yt = \"2 MPa\"");
const SHORT: (&str, &str) = ("end = \"1 ms\"", "end = \"40 us\"");
const FULL: (&str, &str) = ("[march]", "[reduction]\nmethod = 'none'\n[march]\nintegrator = 'newmark'\nstep = '1 us'");

#[test]
fn an_impact_on_angle_plies_under_a_half_turn() {
    compare("half-turn", &[WEAK, SHORT, FULL], SAME);
}

/// Ritz vectors of whole and folded drift apart: rounding grows from each to the next, within the space that they span.
#[test]
fn a_reduced_impact_differs_by_less_than_its_reduction_costs() {
    compare("half-turn", &[WEAK, SHORT], 2e-3);
}

#[test]
fn an_impact_on_cross_plies_in_a_quarter() {
    compare("quarter", &[WEAK, SHORT, FULL, ("[0/45/-45/90]2s", "[0/90]4s")], SAME);
}

/// The edge of the plate, which is its support, stays a circle, and halves of the plate each other's images.
#[test]
fn a_refined_plate_is_as_symmetric_as_its_mesh() {
    let model = |edits: &[(&str, &str)]| {
        let path = root().join("examples/as4-3502-16ply-50mm/scene.toml");
        let text = edits.iter().fold(std::fs::read_to_string(&path).unwrap(), |text, (from, to)| {
            assert!(text.contains(from), "no `{from}`");
            text.replace(from, to)
        });
        Model::new(scene::parse(&text, &path).unwrap(), &Registry::standard()).unwrap()
    };
    let (coarse, fine) = (model(&[]), model(&[("unit = \"mm\"", "unit = \"mm\", refine = 1")]));
    let mesh = &fine.plate.plane;
    assert_eq!(fine.plate.symmetry().name(), Some("half-turn"));
    assert_eq!(
        (mesh.quads.len(), fine.plate.symmetry().quads().len()),
        (4 * coarse.plate.plane.quads.len(), mesh.quads.len() / 2)
    );
    assert!(fine.warnings.is_empty(), "{:?}", fine.warnings);
    let support = &mesh.groups["support"];
    assert_eq!(support.nodes.len(), 2 * coarse.plate.plane.groups["support"].nodes.len());
    for node in &support.nodes {
        let [x, y] = mesh.points[*node as usize];
        assert!((x.hypot(y) / 25e-3 - 1.0).abs() < 1e-12, "{x} {y}");
    }
    // The boundary has 48 edges; twice as many enclose the area of a regular polygon.
    let polygon = 48.0 * 25e-3_f64.powi(2) * (std::f64::consts::TAU / 96.0).sin();
    assert!((mesh.area() / polygon - 1.0).abs() < 1e-12, "{} {polygon}", mesh.area());
}

/// Supports in turned axes on either side of a mirror, which differ by less than anyone measures: one support and its image. The
/// slope that both leave free is not clamped, whether the plate is folded or not.
#[test]
fn turned_axes_that_all_but_are_each_others_image() {
    let deflection = |symmetry: &str, other: &str| {
        let text = format!(
            "title = 'turned'\nanalysis = 'static'\n{symmetry}\nmesh = {{ rectangle = ['40 mm', '20 mm'], cells = [8, 4] }}\n\
             element = {{ kind = 'mitc4' }}\nmaterials.tape = {{ library = 'AS4/3502' }}\n\
             laminate = {{ plies = '[0/90]s', material = 'tape', ply_thickness = '0.25 mm', layers = [4] }}\n\
             support = [\n\
             {{ group = 'x-min', at = 'mid-plane', fix = ['U10', 'U20', 'U30'] }},\n\
             {{ group = 'x-max', at = 'mid-plane', fix = ['U30'] }},\n\
             {{ group = 'y-min', at = 'mid-plane', fix = ['U13'], axes = '30 deg' }},\n\
             {{ group = 'y-max', at = 'mid-plane', fix = ['U13'], axes = '{other}' }},\n]\nload = [{{ pressure = '1 kPa' }}]\n"
        );
        let scene = scene::parse(&text, std::path::Path::new("turned.toml")).unwrap();
        let model = Model::new(&scene, &Registry::standard()).map_err(|e| e.to_string())?;
        Ok::<f64, String>(statics::solve(&model, NonZeroUsize::MIN).unwrap().strain_energy)
    };
    let exact = deflection("", "-30 deg").unwrap();
    for off in ["1", "01", "0001", "0000001", "00000001", "0000000001", "000000000001"] {
        for (symmetry, side) in [("symmetry = 'mirror-y'", "-30"), ("symmetry = 'mirror-y'", "150"), ("", "-30")] {
            let angle = format!("{side}.{off} deg");
            match deflection(symmetry, &angle) {
                Ok(energy) if off.len() > 5 => {
                    assert!((energy / exact - 1.0).abs() < 1e-9, "{symmetry} {angle}: {energy}")
                }
                // Two supports; the whole plate is a little less symmetric.
                Ok(energy) => {
                    assert!(symmetry.is_empty() && (energy / exact - 1.0).abs() < 0.01, "{symmetry} {angle}: {energy}");
                }
                Err(why) => assert!(off.len() <= 5 && why.contains("breaks the symmetry"), "{symmetry} {angle}: {why}"),
            }
        }
    }
}

/// A quarter under tension, two loads that are each other's image: U = σ² V/2E.
#[test]
fn a_load_may_be_the_image_of_another() {
    let case = |loads: &str| {
        plate().text(&format!(
            "title = 'tension'\nanalysis = 'static'\nmesh = {{ rectangle = ['100 mm', '80 mm'], cells = [10, 8] }}\n\
             element = {{ kind = 'hermite-prism' }}\neffects = {{ damage = 'off' }}\nsymmetry = 'quarter'\n\
             support = [{{ restrain = 'rigid-motions' }}]\nload = [{loads}]\nmaterials.m = {{ e = '10 GPa', nu = 0.3 }}\n\
             laminate = {{ plies = '[0]', material = 'm', ply_thickness = '1 mm', layers = 1 }}\n"
        ))
    };
    let one = "{ group = 'x-max', force_per_length = ['20 N/mm', '0 N/mm', '0 N/mm'] }";
    let other = "{ group = 'x-min', force_per_length = ['-20 N/mm', '0 N/mm', '0 N/mm'] }";
    let both = case(&format!("{one}, {other}"));
    both.fem("run", &["--out", "out"]).good();
    let energy = both.summary("out")["strain_energy_J"].as_f64().unwrap();
    assert!((energy / 0.16 - 1.0).abs() < 1e-9, "{energy}");
    let alone = case(one).fem("run", &["--out", "out"]);
    assert!(alone.status == 1 && alone.stderr.contains("the load breaks the symmetry"), "{alone:?}");
}
