//! What a scene says of an impact in terms of a test: energy, tip, window of the frame, and the end with the separation.

use crate::support::{impact_of, strip};
use fem::io::scene::{self, Scene};
use fem::{Model, Plan, scene_mesh};

const PLATE: &str = "title = 'test'\nmesh = { plate = { sides = ['120 mm', '80 mm'], window = ['100 mm', '60 mm'], size = '6 mm' } }\n\
                     materials.tape = { library = 'AS4/3502' }\nmaterials.steel = { library = 'steel' }\n\
                     laminate = { plies = '[0/45/-45/90]2s', material = 'tape', ply_thickness = '0.125 mm', layers = 1 }\n\
                     element = { kind = 'mitc4' }\nfailure = { criteria = ['hashin-1980'] }\neffects = { damage = 'off' }\n\
                     support = [{ group = 'window', kind = 'hinged' }]\n";
const TIP: &str = "diameter = '16 mm', material = 'steel', ";

fn scene(impactor: &str, rest: &str) -> Scene {
    let text = format!("{PLATE}impactor = {{ mass = '2 kg', {impactor}at = {{ group = 'impact' }} }}\n{rest}");
    scene::parse(&text, "scene.toml".as_ref()).unwrap()
}

fn refusal(impactor: &str, rest: &str) -> String {
    let text = format!("{PLATE}impactor = {{ mass = '2 kg', {impactor}at = {{ group = 'impact' }} }}\n{rest}");
    scene::parse(&text, "scene.toml".as_ref()).unwrap_err().to_string()
}

const END: &str = "march = { step = '2 us', end = '6 ms' }\n";

#[test]
fn an_energy_is_a_velocity() {
    let velocity =
        |energy: &str| scene(&format!("{TIP}energy = '{energy}', "), END).impact().unwrap().impactors[0].velocity;
    assert!((velocity("9 J") - 3.0).abs() < 1e-12);
    // The laminate is 2 mm thick.
    assert!((velocity("4.5 J/mm") - 3.0).abs() < 1e-12);
    let said = refusal(&format!("{TIP}energy = '9 J', velocity = '3 m/s', "), END);
    assert!(said.contains("cannot be combined with `velocity`"), "{said}");
    let fall = scene(&format!("{TIP}drop_height = '0.5 m', "), END).impact().unwrap().impactors[0].velocity;
    assert!((0.5 * fall * fall / 9.80665 - 0.5).abs() < 1e-12);
    let said = refusal(&format!("{TIP}drop_height = '1 m', energy = '9 J', "), END);
    assert!(said.contains("cannot be combined with `energy`"), "{said}");
    assert!(refusal(&format!("{TIP}drop_height = '0 m', "), END).contains("positive"));
    let said = refusal(&format!("{TIP}energy = '9 m/s', "), END);
    assert!(said.contains("energy per thickness"), "{said}");
    assert!(refusal(TIP, END).contains("`impactor.velocity` is missing"));
}

/// k = 4/3 sqrt(R)/((1 - nu^2)/E + 1/E3), of steel on AS4/3502.
#[test]
fn a_tip_is_a_contact_law() {
    let scene = scene(&format!("{TIP}velocity = '1 m/s', "), END);
    let law = &scene.impact().unwrap().impactors[0].contact;
    assert_eq!(law.name.value, "hertz");
    let model = Model::new(scene, &fem::Registry::standard()).unwrap();
    let Plan::Impact(impact) = &model.plan else { panic!("an impact") };
    let steel = &fem::io::materials::library("steel").unwrap().material.elastic;
    let tape = &fem::io::materials::library("AS4/3502").unwrap().material.elastic;
    let k = 4.0 / 3.0 * 8e-3_f64.sqrt() / ((1.0 - steel.nu12.powi(2)) / steel.e1 + 1.0 / tape.e3);
    let force = impact.strikes[0].law.force(&Default::default(), 1e-4).force;
    assert!((force / (k * 1e-6) - 1.0).abs() < 1e-9, "{force}");
    let said = refusal("diameter = '16 mm', material = 'tape', velocity = '1 m/s', ", END);
    assert!(said.contains("`tape` is not isotropic"), "{said}");
    let said = refusal(
        &format!("{TIP}velocity = '1 m/s', "),
        &format!("{END}contact = {{ law = 'hertz', k = '1e9 N/m^1.5' }}\n"),
    );
    assert!(said.contains("there is a `contact`"), "{said}");
    assert!(refusal("diameter = '16 mm', velocity = '1 m/s', ", END).contains("`impactor.material` is missing"));
    let said = refusal(&format!("{TIP}tip_radius = '20 mm', velocity = '1 m/s', "), END);
    assert!(said.contains("is not twice the `tip_radius`"), "{said}");
}

/// Where an impactor strikes is not known before the mesh is: what the plies say must be the same everywhere.
#[test]
fn what_the_struck_plies_say_is_one_thing() {
    let refusal = |other: &str, impactor: &str| {
        let regions = format!(
            "laminate = [{{ group = 'impact', align = 'bottom', {other}, layers = 1 }}, {{ plies = '[0/45/-45/90]2s', "
        );
        let plate = PLATE
            .replace("laminate = { plies = '[0/45/-45/90]2s', ", &regions)
            .replace("layers = 1 }\nelement", "layers = 1 }]\nelement");
        let soft = "materials.soft = { library = 'AS4/3502', e2 = '5 GPa' }\n";
        let text = format!("{plate}{soft}impactor = {{ mass = '2 kg', {impactor}at = {{ group = 'impact' }} }}\n{END}");
        scene::parse(&text, "scene.toml".as_ref()).err().map(|error| error.to_string())
    };
    let (thin, soft) = (
        "plies = '[0/90]s', material = 'tape', ply_thickness = '0.125 mm'",
        "plies = '[0_16]', material = 'soft', ply_thickness = '0.125 mm'",
    );
    let [per_thickness, tip] = [format!("{TIP}energy = '4.5 J/mm', "), format!("{TIP}energy = '9 J', ")];
    assert!(refusal(thin, &per_thickness).unwrap().contains("the laminates of the scene have several"));
    assert_eq!(refusal(thin, &tip), None);
    assert!(refusal(soft, &tip).unwrap().contains("differ in their stiffness across the plies"));
}

#[test]
fn a_window_is_a_group_of_edges() {
    let scene = scene(&format!("{TIP}velocity = '1 m/s', "), END);
    let mesh = scene_mesh(&scene).unwrap().mesh;
    let window = &mesh.groups["window"];
    let length = |[a, b]: &[u32; 2]| {
        let [p, q] = [a, b].map(|node| mesh.points[*node as usize]);
        (p[0] - q[0]).hypot(p[1] - q[1])
    };
    let all: f64 = window.edges.iter().map(length).sum();
    assert!((all - 0.32).abs() < 1e-12, "{all}");
    let at_line = |p: [f64; 2]| p[0].abs() == 0.05 || p[1].abs() == 0.03;
    assert!(window.nodes.iter().all(|node| at_line(mesh.points[*node as usize])));
    let area: f64 = mesh.area();
    assert!((area - 9.6e-3).abs() < 1e-12 && mesh.flaws(&[]).is_empty());
}

/// The march to the separation is that to a later end, as far as it goes.
#[test]
fn a_march_ends_with_the_separation() {
    let impactor = format!("{TIP}energy = '0.5 J', ");
    let (_, whole) = impact_of(scene(&impactor, "march = { step = '2 us', end = '8 ms' }\n")).unwrap();
    let (_, found) =
        impact_of(scene(&impactor, "march = { step = '2 us', end = 'separation', latest = '8 ms' }\n")).unwrap();
    let (whole, found) = (whole.outcome, found.outcome);
    assert_eq!(found.contacts[0].force, whole.contacts[0].force);
    let (last, at_end) = (found.history.last().unwrap(), whole.history.last().unwrap());
    assert!(last.time_s < 0.9 * at_end.time_s, "{} {}", last.time_s, at_end.time_s);
    assert!(last.impactors[0].contact_force_n == 0.0 && last.impactors[0].impactor_velocity_m_s < 0.0);
    // Nothing touches later.
    assert_eq!(found.contacts[0].duration, whole.contacts[0].duration);
    assert_eq!(found.stopped, None);
}

#[test]
fn an_end_is_a_time_or_the_separation() {
    let impactor = format!("{TIP}velocity = '1 m/s', ");
    let said = refusal(&impactor, "march = { step = '2 us', end = '1 ms', latest = '2 ms' }\n");
    assert!(said.contains("is for marches that end with the separation"), "{said}");
    let said = refusal(&impactor, "march = { step = '2 us', end = 'rebound' }\n");
    assert!(said.contains("rebound"), "{said}");
}

#[test]
fn another_end_is_set_over_the_separation() {
    let scene = strip().scene("end = \"20 us\"", "end = \"separation\"\nlatest = \"5 ms\"");
    scene.fem("run", &["--out", "out", "--set", "march.end=20 us"]).good();
    let end = scene.summary("out")["impact"]["end_time_s"].as_f64().unwrap();
    assert!((end / 20e-6 - 1.0).abs() < 1e-9, "{end:e}");
}
