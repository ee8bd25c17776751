//! Supports that fix values at nodes and leave the plate free between them, against supports that hold the face.

use super::scene::{AS4, Plate, Side};

/// A square of 16 plies, clamped, under a pressure.
fn plate(ratio: f64, cells: usize) -> Plate {
    let side = ratio * 2.08;
    Plate::new(AS4, "[0/90/0/90/0/90/0/90]s", 0.13, vec![8, 8])
        .rectangle([side; 2], [cells; 2])
        .sides([Side::Clamped; 4])
        .load("pressure = '1 MPa'")
}

/// The same, held in values alone.
fn values(text: &str) -> String {
    let mut kept = String::new();
    for line in text.lines() {
        let fix = line.starts_with("fix = ").then_some("fix = ['U10', 'U20', 'U30']");
        kept.push_str(fix.unwrap_or(line));
        kept.push('\n');
    }
    kept
}

/// What is said is what the other supports find, to a twentieth of it.
#[test]
fn what_is_free_between_nodes_is_said_with_its_number() {
    for (ratio, cells) in [(10.0, 4), (4.0, 4), (10.0, 8)] {
        let plate = plate(ratio, cells);
        let held = plate.solve();
        assert_eq!(held.softness, None);
        let scene = fem::io::scene::parse(&values(&plate.text("static")), "scene.toml".as_ref()).unwrap();
        let model = fem::Model::new(scene, &fem::Registry::standard()).unwrap();
        let free = fem::analyses::statics::solve(&model, std::num::NonZeroUsize::MIN).unwrap();
        let actual = 1.0 - held.strain_energy / free.strain_energy;
        let said = free.softness.unwrap();
        assert!(actual > 0.02 && (said / actual - 1.0).abs() < 0.05, "{ratio} {cells}: {said} {actual}");
    }
}

/// So is a section, whose nodes stand between two vertices.
#[test]
fn a_section_says_it_as_well() {
    let plate = plate(4.0, 1).element("kind = 'webster-beam', state = 'plane-strain'").rectangle([8.32, 1.0], [8, 1]);
    let held = plate.sides([Side::Clamped, Side::Free, Side::Free, Side::Free]);
    let text = values(&held.text("static")).replace("'U10', 'U20', 'U30'", "'U10', 'U30'");
    let scene = fem::io::scene::parse(&text, "scene.toml".as_ref()).unwrap();
    let model = fem::Model::new(scene, &fem::Registry::standard()).unwrap();
    let free = fem::analyses::statics::solve(&model, std::num::NonZeroUsize::MIN).unwrap();
    let actual = 1.0 - held.solve().strain_energy / free.strain_energy;
    let said = free.softness.unwrap();
    assert!(actual > 0.02 && (said / actual - 1.0).abs() < 0.05, "{said} {actual}");
}

/// Whatever solves for rest: small loads on a plate of the same layers, whose interfaces are closed.
#[test]
fn every_way_to_rest_says_it() {
    let solve = |effects: &str, law: &str, support: &str, path: &str| {
        let text = format!(
            "title = 'plate'\nanalysis = 'static'\nmesh = {{ rectangle = ['9 mm', '6 mm'], cells = [3, 2] }}\n\
             element = {{ kind = 'hermite-prism' }}\neffects = {{ damage = 'off', {effects} }}\n{path}\
             laminate = {{ plies = '[0/90]', material = 'tape', ply_thickness = '1 mm', layers = [1, 1] }}\n\
             support = [{{ group = 'x-min', at = 'all', fix = ['U10', 'U20', 'U30'] }}{support}]\n\
             load = [{{ pressure = '1 Pa' }}]\n[materials.tape]\nlibrary = 'AS4/3502'\nZt = '64 MPa'\nS13 = '109 MPa'\nS23 = '60 MPa'\nGIc = '0.2 N/mm'\nGIIc = '0.6 N/mm'\neta = 1.5\n{law}"
        );
        let scene = fem::io::scene::parse(&text, "scene.toml".as_ref()).unwrap();
        let model = fem::Model::new(scene, &fem::Registry::standard()).unwrap();
        fem::analyses::statics::solve(&model, std::num::NonZeroUsize::MIN).unwrap().softness.unwrap()
    };
    let linear = solve("", "", "", "");
    let path = "delamination = { penalty = '1e5 N/mm^3' }\n\
                path = { until = '1e-9 mm', step = '1 J' }\n";
    let ways = [
        solve("membrane = 'on'", "", "", ""),
        solve("", "law = { name = 'hahn-tsai', alpha = '2.44e-8 1/MPa^3' }", "", ""),
        solve("", "", ", { group = 'x-max', kind = 'rest', stiffness = '1e-6 N/mm^2' }", ""),
        solve("delamination = 'growth'", "", "", path),
    ];
    assert!(linear > 0.02 && ways.iter().all(|way| (way / linear - 1.0).abs() < 0.02), "{linear}: {ways:?}");
}

/// So are modes and load factors, whose stiffness is that of the loads that would hold the plate in their shapes.
#[test]
fn modes_and_buckling_say_it_as_well() {
    let plate = |analysis: &str, supports: &str| {
        let preload = match analysis {
            "buckling" => {
                "effects.preload = [{ group = 'x-min', force = '-1 N/mm' }, { group = 'x-max', force = '-1 N/mm' }]"
            }
            _ => "",
        };
        let sides = ["x-min", "x-max", "y-min", "y-max"]
            .map(|side| format!("{{ group = '{side}', {supports}, at = 'bottom' }}"));
        let text = format!(
            "title = 'plate'\nanalysis = '{analysis}'\n{analysis}.count = 1\nmesh = {{ rectangle = ['100 mm', '100 mm'], cells = [2, 2] }}\n\
             laminate = {{ plies = '[0/0]', material = 'm', ply_thickness = '2 mm', layers = [2] }}\n{preload}\n\
             support = [{}, {{ group = 'y-min', kind = 'hinged', at = 'bottom' }}]\n[materials.m]\n{AS4}",
            sides.join(", ")
        );
        let scene = fem::io::scene::parse(&text, "scene.toml".as_ref()).unwrap();
        fem::Model::new(scene, &fem::Registry::standard()).unwrap()
    };
    let threads = std::num::NonZeroUsize::MIN;
    let [held, free] = ["kind = 'roller'", "fix = ['U30']"].map(|supports| {
        let modes = fem::analyses::modes::solve(&plate("modes", supports), 1, threads).unwrap();
        let buckling = fem::analyses::buckling::solve(&plate("buckling", supports), 1, threads).unwrap();
        [(modes.modes.omega[0].powi(2), modes.softness), (buckling.buckling.factors[0], buckling.softness)]
    });
    for ((held, none), (free, said)) in held.into_iter().zip(free) {
        let (actual, said) = (1.0 - free / held, said.unwrap());
        assert_eq!(none, None);
        assert!(actual > 0.015 && (said / actual - 1.0).abs() < 0.2, "{said} {actual}");
    }
}
