//! Plies that follow a law of their own: Hahn and Tsai's shear, γ = τ/G + α τ³.

use crate::support::{Case, root};
use fem::analyses::impact::{self, Outcome};
use fem::analyses::statics::{self, StaticSolution};
use fem::core::dof::Dof;
use fem::io::scene;
use fem::io::tables::HistoryRow;
use fem::{Error, Model, Registry};
use std::num::NonZeroUsize;

const G: f64 = 5.93e9;
const ALPHA: f64 = 2.44e-26;
const LAW: &str = "law = { name = 'hahn-tsai', alpha = '2.44e-8 1/MPa^3' }\n";
const ELASTIC: &str = "law = { name = 'hahn-tsai', alpha = '2.44e-8 1/MPa^3', unloading = 'elastic' }\n";
const TINY: &str = "law = { name = 'hahn-tsai', alpha = '1e-40 1/MPa^3' }\n";

fn model(scene: &str) -> Result<Model, Error> {
    Model::new(scene::parse(scene, &root().join("scene.toml"))?, &Registry::standard())
}

const FREE: &str = "[{ restrain = 'rigid-motions' }]";
/// Of a patch that neither turns nor shears.
const SLIDING: &str = "[{ group = 'x-min', at = 'all', fix = ['U10'] }, { group = 'y-min', at = 'all', fix = ['U20'] }, \
     { group = 'plate', at = 'bottom', fix = ['U30'] }]";

/// A patch of one ply under forces per length (N/mm) on its sides x-min, x-max, y-min, y-max.
fn patch(law: &str, [element, support]: [&str; 2], angle: &str, sides: [[f64; 2]; 4]) -> (Model, StaticSolution) {
    let loads = ["x-min", "x-max", "y-min", "y-max"].iter().zip(sides).map(|(group, [x, y])| {
        format!("{{ force_per_length = ['{x} N/mm', '{y} N/mm', '0 N/mm'], group = '{group}' }}")
    });
    let loads: Vec<_> = loads.collect();
    let model = model(&format!(
        "title = 'patch'\nanalysis = 'static'\nmesh = {{ rectangle = ['10 mm', '8 mm'], cells = [2, 1] }}\n\
         element = {{ kind = '{element}' }}\neffects = {{ damage = 'onset' }}\nfailure = {{ criteria = ['max-stress'] }}\n\
         support = {support}\nload = [{}]\n\
         laminate = {{ plies = '[{angle}]', material = 'tape', ply_thickness = '1 mm', layers = [1] }}\n\
         [materials.tape]\nlibrary = 'AS4/3502'\n{law}",
        loads.join(", ")
    ));
    let model = model.unwrap();
    let solution = statics::solve(&model, NonZeroUsize::MIN).unwrap();
    (model, solution)
}

/// Displacements of the corners at (0, 0), (10, 0), (0, 8) mm in the plane.
fn corners(model: &Model, solution: &StaticSolution) -> [[f64; 2]; 3] {
    [[0.0, 0.0], [10e-3, 0.0], [0.0, 8e-3]].map(|at| {
        let near = |p: &[f64; 2]| (p[0] - at[0]).hypot(p[1] - at[1]) < 1e-9;
        let column = model.plate.columns.iter().position(near).unwrap();
        [0, 4].map(|n| solution.u[model.plate.dofs_at(column, 0, Dof::SOLID[n]).next().unwrap()])
    })
}

#[test]
fn a_patch_in_pure_shear_follows_the_curve() {
    const VOLUME: f64 = 80e-9;
    let near = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 1e-9, "{got} {want}");
    for tau in [1.0, 40.0, 80.0, 120.0] {
        let pascals = tau * 1e6_f64;
        let shear = pascals / G + ALPHA * pascals.powi(3);
        let lost = VOLUME * 0.75 * ALPHA * pascals.powi(4);
        let work = lost + VOLUME * pascals.powi(2) / (2.0 * G);
        // Along the axes of the ply.
        let sides = [[0.0, -tau], [0.0, tau], [-tau, 0.0], [tau, 0.0]];
        let (plate, found) = patch(LAW, ["hermite-prism", FREE], "0", sides);
        let [o, x, y] = corners(&plate, &found);
        near((x[1] - o[1]) / 10e-3 + (y[0] - o[0]) / 8e-3, shear);
        near(found.strain_energy + found.dissipated.unwrap(), work);
        // The same state in axes turned by 45 degrees: γ₁₂ = ε_yy − ε_xx.
        for element in [["hermite-prism", FREE], ["hex20", SLIDING]] {
            let (plate, found) = patch(LAW, element, "45", [[-tau, 0.0], [tau, 0.0], [0.0, tau], [0.0, -tau]]);
            let [o, x, y] = corners(&plate, &found);
            near((x[0] - o[0]) / 10e-3 - (y[1] - o[1]) / 8e-3, shear);
            near(found.dissipated.unwrap(), lost);
            // S12 = 109 MPa: the margin is that of the law's stress, not of G γ.
            let margin = found.margins.iter().find(|m| m.mode == "shear 12").unwrap();
            near(margin.reserve_factor * tau, 109.0);
        }
    }
}

#[test]
fn elastic_plies_lose_nothing() {
    let tau = 90.0;
    let shear = [[0.0, -tau], [0.0, tau], [-tau, 0.0], [tau, 0.0]];
    let [(_, kept), (_, lost)] = [ELASTIC, LAW].map(|law| patch(law, ["hermite-prism", FREE], "0", shear));
    assert_eq!(kept.dissipated, Some(0.0));
    assert!((kept.strain_energy / (lost.strain_energy + lost.dissipated.unwrap()) - 1.0).abs() < 1e-9);
    assert!(kept.decrements.unwrap().len() > 2);
}

/// A strip of [±45]s that is struck in its middle.
fn struck(law: &str, more: &str) -> String {
    format!(
        "title = 'laws'\nmesh = {{ rectangle = ['30 mm', '20 mm'], cells = [3, 2] }}\n\
         element = {{ kind = 'hermite-prism' }}\n\
         impactor = {{ mass = '20 g', velocity = '6 m/s', at = {{ x = '15 mm', y = '10 mm' }} }}\n\
         contact = {{ law = 'hertz', k = '1e4 N/mm^1.5' }}\neffects = {{ damage = 'onset' }}\n\
         failure = {{ criteria = ['max-stress'], every = '5 us' }}\nreduction = {{ method = 'none' }}\n\
         march = {{ integrator = 'newmark', step = '2 us', end = '120 us' }}\n\
         laminate = {{ plies = '[45/-45]s', material = 'tape', ply_thickness = '0.25 mm', layers = [4] }}\n{more}{}{}\
         [materials.tape]\nlibrary = 'AS4/3502'\n{law}",
        super::EDGES[0],
        super::EDGES[1],
    )
}

fn run(scene: &str, threads: usize) -> Outcome {
    let model = model(scene).unwrap();
    let threads = NonZeroUsize::new(threads).unwrap();
    let outcome = impact::march(impact::prepare(&model, threads).unwrap(), |_| {}).unwrap();
    assert_eq!(outcome.stopped, None);
    outcome
}

fn forces(outcome: &Outcome) -> impl Iterator<Item = f64> {
    outcome.history.iter().map(super::force)
}

#[test]
fn an_impact_keeps_its_energy_and_loses_some_in_the_plies() {
    let [linear, lawful, elastic] = ["", LAW, ELASTIC].map(|law| run(&struck(law, ""), 1));
    let lost = |outcome: &Outcome| -> Vec<f64> { outcome.history.iter().flat_map(|r| r.effects.clone()).collect() };
    assert!(lost(&linear).is_empty());
    let [of_law, of_elastic] = [lost(&lawful), lost(&elastic)];
    assert!(of_law.windows(2).all(|w| w[1] >= w[0] * (1.0 - 1e-12)) && of_elastic.iter().all(|j| *j == 0.0));
    // 0.36 J strike; a part that shows is lost.
    let share = of_law.last().unwrap() / 0.36;
    assert!((1e-3..0.5).contains(&share), "{share}");
    for outcome in [&linear, &lawful, &elastic] {
        assert!(outcome.energy_error < 2e-3, "{:e}", outcome.energy_error);
    }
    let peak = |outcome: &Outcome| forces(outcome).fold(0.0, f64::max);
    assert!(peak(&lawful) < 0.999 * peak(&linear), "{} {}", peak(&lawful), peak(&linear));
    // Strength in shear is reached later, if at all, since the law's stress is lower.
    let index = |outcome: &Outcome| outcome.peaks.iter().find(|p| p.mode == "shear 12").map(|p| p.index);
    assert!(index(&lawful) < index(&linear), "{:?} {:?}", index(&lawful), index(&linear));
}

#[test]
fn a_tiny_alpha_is_the_linear_plate() {
    // Plies with a law have the stresses of their strains.
    let plain = "{ kind = 'hermite-prism', transverse_stresses = 'of-strains' }";
    let [linear, tiny] = ["", TINY].map(|law| run(&struck(law, "").replace("{ kind = 'hermite-prism' }", plain), 1));
    let most = forces(&linear).fold(0.0, f64::max);
    assert!(forces(&linear).zip(forces(&tiny)).all(|(a, b)| (a - b).abs() < 1e-6 * most));
    let row = |outcome: &Outcome| outcome.history.last().map(|r: &HistoryRow| r.plate_strain_j).unwrap();
    assert!((row(&tiny) / row(&linear) - 1.0).abs() < 1e-5);
}

#[test]
fn threads_change_no_bit() {
    let bits = |threads| -> Vec<u64> { forces(&run(&struck(LAW, ""), threads)).map(f64::to_bits).collect() };
    assert_eq!(bits(1), bits(2));
}

#[test]
fn a_resumed_march_is_the_same() {
    let scene = struck(LAW, "output = { fields = { every = '20 us' } }\n");
    let short = Case::example("as4-3502-16ply-50mm").text(&scene.replace("120 us", "22 us"));
    short.fem("run", &["--out", "out"]).good();
    let long = short.scene("22 us", "60 us");
    long.fem("run", &["--out", "out", "--resume"]).good();
    long.fem("run", &["--out", "straight"]).good();
    assert_eq!(long.differing("straight", "out"), [""; 0]);
    let other = long.scene("2.44e-8", "2.45e-8").fem("run", &["--out", "out", "--resume"]);
    assert!(
        other.status != 0 && other.stderr.contains("`materials.tape.law.alpha` had different constants"),
        "{}",
        other.stderr
    );
}

#[test]
fn what_knows_linear_plies_only_is_refused() {
    let refused = |scene: String, want: &str| {
        let error = model(&scene).unwrap_err();
        let said = format!("{error:?}");
        assert!(said.contains(want), "{want}: {said}");
    };
    let plain = struck(LAW, "");
    let effects = |more: &str| plain.replace("damage = 'onset'", &format!("damage = 'onset', {more}"));
    refused(plain.replace("'none'", "'ritz', vectors = 20"), "march the full plate");
    refused(effects("membrane = 'on'"), "membrane stiffening");
    refused(effects("membrane = 'auto'"), "membrane stiffening");
    refused(effects("inertia = 'off'"), "static responses");
    refused(effects("gravity = '9.81 m/s^2'"), "the sag is that");
    refused(plain.replace("'newmark'", "'rk4'"), "implicit integrator");
    refused(plain.replace("kind = 'hermite-prism'", "kind = 'mitc4'").replace("[4]", "1"), "choose a solid element");
    refused(plain.replace("hahn-tsai", "hahn-tsay"), "did you mean `hahn-tsai`");
    refused(plain.replace("2.44e-8 1/MPa^3", "2.44e-8 1/MPa"), "alpha");
}

#[test]
fn mean_forces_of_a_step_do_the_work_that_the_energies_say() {
    for law in [LAW, ELASTIC] {
        for (step, bound) in [("2 us", 1e-9), ("10 us", 1e-9)] {
            let march = format!("integrator = 'energy-conserving', step = '{step}'");
            let scene = struck(law, "").replace("integrator = 'newmark', step = '2 us'", &march);
            assert!(scene.contains(&march));
            let outcome = run(&scene, 1);
            assert!(outcome.energy_error < bound, "{law}, {step}: {:e}", outcome.energy_error);
            let lost = outcome.history.iter().flat_map(|row| &row.effects).fold(0.0_f64, |a, b| a.max(*b));
            assert_eq!(lost > 1e-4, law == LAW, "{law}, {step}: {lost:e}");
        }
    }
}

/// A plate of cells 10 mm wide and its toughnesses, pulled by 1 N/mm.
fn wide(more: &str) -> Result<Model, Error> {
    pulled(more, 1.0)
}

fn pulled(more: &str, by: f64) -> Result<Model, Error> {
    model(&format!(
        "title = 'wide'\nanalysis = 'static'\nmesh = {{ rectangle = ['20 mm', '10 mm'], cells = [2, 1] }}\n\
         element = {{ kind = 'hermite-prism' }}\neffects = {{ damage = 'off' }}\nsupport = {FREE}\n\
         load = [{{ force_per_length = ['{by} N/mm', '0 N/mm', '0 N/mm'], group = 'x-max' }}, \
         {{ force_per_length = ['-{by} N/mm', '0 N/mm', '0 N/mm'], group = 'x-min' }}]\n\
         laminate = {{ plies = '[0]', material = 'tape', ply_thickness = '1 mm', layers = [1] }}\n\
         [materials.tape]\nlibrary = 'AS4/3502'\nlaw = {{ name = 'crack-band'{more} }}\n\
         Gft = '80 N/mm'\nGfc = '100 N/mm'\nGmt = '0.28 N/mm'\nGmc = '1.3 N/mm'\nGms = '0.8 N/mm'\n"
    ))
}

#[test]
fn cells_too_wide_for_a_toughness_are_refused_or_lower_strengths_and_say_so() {
    let refused = wide("").unwrap_err().to_string();
    for said in [
        "material `tape`: law `crack-band`",
        "a cell narrower than 1.8 G12 Gms/S12^2",
        "cell = 1.000000e-2 m",
        "lower_strengths",
    ] {
        assert!(refused.contains(said), "{said}: {refused}");
    }
    let lowered = wide(", lower_strengths = true").unwrap();
    let warned = lowered.warnings.iter().filter(|warning| warning.contains("strengths are lowered")).count();
    assert!(
        warned == 1
            && lowered.warnings.iter().any(|w| w.contains("law `crack-band`") && w.contains("Yt from 64.0 to "))
    );
    let missing = model(&struck("law = 'crack-band'\nGft = '80 N/mm'\n", "")).unwrap_err().to_string();
    assert!(missing.contains("needs the toughness Gfc, Gmt, Gmc"), "{missing}");
}

/// A plate of fibres along the pull: Xt is 1793 MPa.
#[test]
fn what_plies_do_not_bear_at_rest_is_no_buckling() {
    let solve = |by: f64| {
        let model = pulled(", lower_strengths = true", by).unwrap();
        statics::solve(&model, NonZeroUsize::MIN)
    };
    assert!(solve(500.0).is_ok());
    let refused = solve(3000.0).unwrap_err();
    assert!(matches!(refused, Error::Softened(_)), "{refused:?}");
    let said = format!("{refused} {}", std::error::Error::source(&refused).unwrap());
    assert!(said.contains("in which the plies bear this load") && !said.contains("buckles"), "{said}");
}

#[test]
fn cells_too_slender_for_a_band_are_warned_of() {
    let slender = |cells: &str| {
        let text = struck(
            "law = { name = 'crack-band', lower_strengths = true }\nGft = '80 N/mm'\nGfc = '100 N/mm'\nGmt = '0.28 N/mm'\nGmc = '1.3 N/mm'\n",
            "",
        );
        let (from, rest) = text.split_once("cells = ").unwrap();
        let (_, to) = rest.split_once(']').unwrap();
        let found = model(&format!("{from}cells = {cells}{to}")).unwrap();
        found.warnings.into_iter().find(|warning| warning.contains("as long as wide"))
    };
    assert_eq!(slender("[20, 12]"), None);
    assert!(slender("[40, 4]").unwrap().contains("law `crack-band`: cells are up to 6.7 times"));
}

/// Plies that follow a law which asks nothing of them, about a core that is a hundred times as soft.
#[test]
fn a_core_beside_plies_that_follow_laws_is_a_layer_of_its_own() {
    let sandwich = |law: &str, layers: &str| {
        let model = model(&format!(
            "title = 'sandwich'\nanalysis = 'static'\nmesh = {{ rectangle = ['60 mm', '60 mm'], cells = [4, 4] }}\n\
             materials = {{ tape = {{ library = 'AS4/3502'{law} }}, core = {{ e = '70 MPa', nu = 0.3 }} }}\n\
             laminate = {{ plies = '[0/90/0{{core}}/90/0]', material = 'tape', ply_thickness = '0.5 mm', layers = {layers}, \
             ply = {{ core = {{ material = 'core', thickness = '5 mm' }} }} }}\nelement = {{ kind = 'hermite-prism' }}\n\
             effects = {{ damage = 'off' }}\nload = [{{ pressure = '1 Pa' }}]\n\
             support = [{{ group = 'x-min', kind = 'simply-supported' }}, {{ group = 'x-max', kind = 'simply-supported' }}, \
             {{ group = 'y-min', kind = 'simply-supported' }}, {{ group = 'y-max', kind = 'simply-supported' }}]\n"
        ))?;
        let solution = statics::solve(&model, NonZeroUsize::MIN)?;
        let deflections = (0..model.plate.columns.len()).flat_map(|c| model.plate.dofs_at(c, 0, Dof::SOLID[8]));
        Ok::<_, Error>(deflections.map(|dof| solution.u[dof].abs()).fold(0.0, f64::max))
    };
    let inert = ", law = { name = 'hahn-tsai', alpha = '1e-20 1/MPa^3' }";
    for layers in ["1", "2"] {
        let refused = sandwich(inert, layers).unwrap_err().to_string();
        assert!(refused.contains("times as stiff through the thickness"), "{refused}");
    }
    let [free, followed] = ["", inert].map(|law| sandwich(law, "[2, 1, 2]").unwrap());
    assert!((followed / free - 1.0).abs() < 1e-3, "{free} {followed}");
}
