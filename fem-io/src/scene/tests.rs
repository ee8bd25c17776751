use super::*;
use crate::document::keys;
use fem_core::laminate::LaminaPly;
use fem_core::material::{Strength, Toughness};
use fem_core::mesh::{Curves, Graded, Outline};
use fem_core::plugin::Value;
use fem_core::support::Levels;
use miette::{GraphicalReportHandler, GraphicalTheme};
use proptest::prelude::*;

fn mesh_file(scene: &Scene) -> &Path {
    match &scene.mesh {
        MeshSource::File { file, .. } => &file.value,
        other => panic!("{other:?}"),
    }
}

/// The scene that the refusals below spoil one line at a time.
const GOOD: &str = r#"title = "16 plies, 50 mm circular support, 2.49 kg at 1.56 m/s"
mesh = { file = "plate.msh", unit = "mm" }
materials.as4-3502 = { library = "AS4/3502" }
materials.resin = { library = "3502 resin", S12 = "55 MPa" }
materials.foam = { e = "70 MPa", nu = 0.3, density = "52 kg/m^3" }

support = [
  { group = "support", at = "mid-plane", fix = ["U30"] },
  { group = "edge", at = "all", fix = ["U10", "U31"], axes = "30 deg" },
  { restrain = "rigid-motions" },
]
impactor = { mass = "2.49 kg", velocity = "1.56 m/s", at = { group = "impact" } }
contact = { law = "sun-yang", k = "1.07e5 N/mm^1.5", n = 1.5, m = 2.5, critical = "0.08 mm", beta = 0.4, knots = [1, "2 mm"] }
march = { integrator = { name = "newmark", beta = 0.3 }, end = "1 ms" }
failure = { criteria = ["hashin-report", { name = "octahedral", strict = true }], radius = "10 mm" }
output = { history_every = "2 us", plots = false, maps = true }

[laminate]
plies = "[0/45/-45/90{core}]2s"
material = "as4-3502"
ply_thickness = "0.13208 mm"
layers = [8, 8]
ply.core = { material = "foam", thickness = "1 mm" }
interface = "resin"

[[equation]]
terms = [
  { group = "a", at = "top", dof = "U30", factor = 1 },
  { group = "b", at = "bottom", dof = "U31", factor = "-2 mm" },
]

[[couple]]
group = "edge"
at = "all"
dofs = ["U30"]
"#;

fn read_good(text: &str) -> Scene {
    parse(text, Path::new("cases/plate/scene.toml")).unwrap_or_else(|e| panic!("{}", rendered(&e)))
}

fn rendered(error: &SceneError) -> String {
    let mut out = String::new();
    GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor())
        .with_width(120)
        .render_report(&mut out, error)
        .unwrap();
    out
}

/// The good scene with `from` replaced.
fn spoilt(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    GOOD.replacen(from, to, 1)
}

#[test]
fn a_scene_in_full() {
    let scene = read_good(GOOD);
    assert_eq!(scene.title, "16 plies, 50 mm circular support, 2.49 kg at 1.56 m/s");
    assert_eq!(scene.fidelity, Fidelity::Engineering);
    assert_eq!(mesh_file(&scene), Path::new("cases/plate/plate.msh"));
    assert!(matches!(scene.mesh, MeshSource::File { metres_per_unit: 1e-3, .. }));

    let names: Vec<_> = scene.materials.iter().map(|m| m.value.name.as_str()).collect();
    assert_eq!(names, ["as4-3502", "resin", "foam"]);
    let [fibre, resin, foam] = [0, 1, 2].map(|i| &scene.materials[i].value);
    assert_eq!(fibre.elastic.e1, 130.3e9);
    assert_eq!(fibre.strengths.get(Strength::Yt), Some(64e6));
    assert_eq!(resin.strengths.get(Strength::S12), Some(55e6), "the scene lies over the library");
    assert_eq!(resin.strengths.get(Strength::Xt), Some(38e6));
    assert_eq!(foam.strengths.get(Strength::Xt), None);

    let laminate = &scene.laminates[0].laminate.value;
    assert_eq!((laminate.plies.len(), &laminate.layers[..]), (16, &[8, 8][..]));
    assert_eq!(scene.interface.as_ref().map(|i| i.value), Some(1));
    assert_eq!(laminate.plies[0], LaminaPly { angle_deg: 0.0, angle: 0.0, material: 0, thickness: 0.13208e-3 });
    assert_eq!((laminate.plies[3].material, laminate.plies[3].thickness), (2, 1e-3));
    assert_eq!(laminate.plies[3].angle, std::f64::consts::FRAC_PI_2);

    let [
        Support::Fix { nodes, dofs, axes, .. },
        Support::Fix { axes: turned, .. },
        Support::RestrainRigidMotions { .. },
    ] = &scene.supports[..]
    else {
        panic!("{:?}", scene.supports)
    };
    assert_eq!((nodes.group.value.as_str(), nodes.levels), ("support", Levels::MidPlane));
    assert_eq!((dofs[0].to_string().as_str(), *axes), ("U30", 0.0));
    assert!((turned - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
    assert_eq!(scene.equations[0].terms[1].factor, -2e-3);
    assert_eq!((scene.couples[0].nodes.levels, scene.couples[0].dofs.len()), (Levels::All, 1));

    assert_eq!(
        (scene.impact().unwrap().impactors[0].mass, scene.impact().unwrap().impactors[0].velocity),
        (2.49, 1.56)
    );
    assert_eq!(scene.impact().unwrap().impactors[0].at.value, ImpactPoint::Group("impact".into()));
    assert_eq!(scene.impact().unwrap().impactors[0].load.value, ContactLoad::Patch { radius: 3e-3 });
    assert_eq!(scene.impact().unwrap().impactors[0].contact.name.value, "sun-yang");
    let text = |text: &str| Some(Value::Text(text.into()));
    let contact = &scene.impact().unwrap().impactors[0].contact.params;
    assert_eq!(contact.get("k").cloned(), text("1.07e5 N/mm^1.5"), "what a text means only the plug-in knows");
    assert_eq!(
        scene.impact().unwrap().impactors[0].contact.params.get("knots"),
        Some(&Value::List(vec![Value::Number(1.0), Value::Text("2 mm".into())]))
    );
    assert_eq!(scene.impact().unwrap().impactors[0].contact.params.keys().find(|k| *k == "law"), None);

    assert_eq!(scene.impact().unwrap().march.integrator.name.value, "newmark");
    assert_eq!(scene.impact().unwrap().march.integrator.params.get("beta"), Some(&Value::Number(0.3)));
    assert_eq!((scene.impact().unwrap().march.step.value, scene.impact().unwrap().march.end.value), (0.1e-6, 1e-3));
    assert_eq!(scene.failure.criteria[1].plugin.params.get("strict"), Some(&Value::Flag(true)));
    assert_eq!((scene.failure.every, scene.failure.radius), (5e-6, Some(10e-3)));
    assert_eq!(scene.failure.window, Window::Square(2.54e-3));
    assert_eq!(scene.effects.damage, Damage::Onset);
    let output = Output { history_every: Some(2e-6), plots: false, maps: true, ..Output::default() };
    assert_eq!(scene.output, output);
    assert_eq!(
        Output::default(),
        Output { history_every: None, checkpoint_every: 60.0, modes: None, plots: true, maps: false, fields: None }
    );
    assert_eq!(
        (scene.element.name.value.as_str(), scene.z_derivatives.value),
        ("hermite-prism", ZDerivatives::LayerWise)
    );
    assert_eq!(scene.element.params.get("mass"), Some(&Value::Text("cubic".into())));
    assert_eq!(scene.element.params.get("z_derivatives"), None);
    assert_eq!(scene.impact().unwrap().reduction.params.get("vectors"), Some(&Value::Number(60.0)));
}

/// The library is a file like any other.
#[test]
fn a_material_comes_from_a_file_of_ones_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(folder.path().join("mine.toml"), crate::materials::LIBRARY).unwrap();
    let with = |constants: &str| parse(&spoilt("{ library = \"AS4/3502\" }", constants), &path);
    // As text: a strength that nobody gave equals nothing.
    let material = |constants: &str| match with(constants) {
        Ok(scene) => format!("{:?}", scene.materials[0].value),
        Err(e) => panic!("{}", rendered(&e)),
    };
    let named =
        |name| Material { name: "as4-3502".into(), ..crate::materials::library(name).unwrap().material.clone() };
    assert_eq!(material(r#"{ file = "mine.toml", name = "AS4/3502" }"#), format!("{:?}", named("AS4/3502")));
    let tough =
        material(r#"{ file = "mine.toml", name = "E-glass/MY750", density = "2.1 g/cm^3", GIIc = "0.8 N/mm" }"#);
    let want = Material {
        density: Some(2100.0),
        toughness: named("E-glass/MY750").toughness.with(Toughness::GIIc, 800.0),
        ..named("E-glass/MY750")
    };
    assert_eq!(tough, format!("{want:?}"));

    let broken = crate::materials::LIBRARY.replace("\"9.65 GPa\"", "\"9.65 mm\"");
    std::fs::write(folder.path().join("broken.toml"), &broken).unwrap();
    let line = |text: &str, words| 1 + text.lines().position(|line| line.contains(words)).unwrap();
    let scene = line(&spoilt("{ library = \"AS4/3502\" }", "?"), "= ?");
    for (constants, file, line, words) in [
        (r#"{ file = "none.toml", name = "x" }"#, "scene.toml", scene, "cannot read"),
        (r#"{ file = "mine.toml" }"#, "scene.toml", scene, "`materials.as4-3502.name` is missing"),
        (r#"{ file = "mine.toml", name = "AS4/3503" }"#, "scene.toml", scene, "`AS4/3503` is not one of the"),
        (r#"{ name = "AS4/3502" }"#, "scene.toml", scene, "means nothing without `file`"),
        (r#"{ library = "AS4/3502", file = "mine.toml" }"#, "scene.toml", scene, "cannot be combined with `library`"),
        (r#"{ file = "mine.toml", name = "AS4/3502", nu12 = 9 }"#, "scene.toml", scene, "|nu12| < sqrt(E1/E2)"),
        (r#"{ file = "broken.toml", name = "3502 resin" }"#, "broken.toml", line(&broken, "9.65 mm"), "is a length"),
        (
            r#"{ file = "mine.toml", name = "AS4/3502", e = "1 GPa" }"#,
            "mine.toml",
            line(&broken, "130.3"),
            "cannot be combined with e",
        ),
    ] {
        let error = with(constants).expect_err(constants);
        let (name, at) = error.location().unwrap();
        assert!(name.ends_with(file) && at == line && error.to_string().contains(words), "{}", rendered(&error));
        assert!(!error.remedy().is_empty(), "{error}");
    }
}

#[test]
fn criteria_are_told_apart_and_places_are_watched() {
    let scene = read_good(
        &spoilt(
            "radius =",
            "watch = [{ at = { group = \"impact\" }, ply = 16 }, \
         { at = { x = \"1 mm\", y = \"-2 mm\" }, interface = \"3|4\", criterion = \"twin\" }], radius =",
        )
        .replace("{ name = \"octahedral\"", "{ name = \"hashin-report\", as = \"twin\""),
    );
    let criteria: Vec<_> = scene.failure.criteria.iter().map(|c| (&*c.plugin.name.value, &*c.label)).collect();
    assert_eq!(criteria, [("hashin-report", "hashin-report"), ("hashin-report", "twin")]);
    assert_eq!(scene.failure.criteria[1].plugin.params.keys().collect::<Vec<_>>(), ["strict"]);
    let watch: Vec<_> = scene.failure.watch.iter().map(|w| (&w.at.value, w.depth.value, w.criterion)).collect();
    let point = ImpactPoint::Point([1e-3, -2e-3]);
    let group = ImpactPoint::Group("impact".into());
    assert_eq!(watch, [(&group, Depth::Ply(15), None), (&point, Depth::Interface(2), Some(1))]);
}

#[test]
fn a_formula_may_begin_with_a_number() {
    let scene = read_good(&spoilt("strict = true", r#"expression = ["2*s1"], limit = "2 MPa""#));
    let params = &scene.failure.criteria[1].plugin.params;
    assert_eq!(params.get("expression"), Some(&Value::List(vec![Value::Text("2*s1".into())])));
    assert_eq!(params.get("limit"), Some(&Value::Text("2 MPa".into())));
}

#[test]
fn presets_lie_beneath_the_scene() {
    let fidelity = |name: &str| format!("fidelity = \"{name}\"\n{GOOD}");
    let report = read_good(&fidelity("report"));
    assert_eq!(report.impact().unwrap().impactors[0].load.value, ContactLoad::Node);
    assert_eq!((report.failure.window, report.z_derivatives.value), (Window::Element, ZDerivatives::Shared));
    assert_eq!(report.element.params.get("mass"), Some(&Value::Text("linear".into())));
    assert_eq!(report.impact().unwrap().reduction.params.get("governors"), Some(&Value::Number(38.0)));
    assert_eq!(report.impact().unwrap().march.step.value, 50e-9);
    let reference = read_good(&fidelity("reference"));
    assert_eq!(reference.impact().unwrap().reduction.name.value, "none");
    assert_eq!((reference.impact().unwrap().march.step.value, reference.failure.every), (0.25e-6, 1e-6));

    let over = |text: &str| read_good(&format!("{text}\n{}", fidelity("report")));
    assert_eq!(
        over("reduction.governors = 20").impact().unwrap().reduction.params.get("governors"),
        Some(&Value::Number(20.0))
    );
    assert_eq!(
        over("element.z_derivatives = \"layer-wise\"").element.params.get("mass"),
        Some(&Value::Text("linear".into()))
    );
    let beam = read_good(&format!(
        "fidelity = \"report\"\nelement = {{ kind = \"webster-beam\", state = \"plane-strain\" }}\n{GOOD}"
    ));
    assert_eq!(beam.z_derivatives.value, ZDerivatives::LayerWise, "whatever the preset says of its own element");
    let other = over("reduction = { method = \"modal\", modes = 5 }").impact().unwrap().reduction.clone();
    assert_eq!(
        other.params.keys().collect::<Vec<_>>(),
        ["modes"],
        "another plug-in takes no parameters of the preset's"
    );
    let patch = spoilt("at = { group = \"impact\" }", "at = { x = \"1 mm\", y = \"0 mm\" }, patch_radius = \"2 mm\"");
    let patch = read_good(&format!("fidelity = \"report\"\n{patch}"));
    assert_eq!(patch.impact().unwrap().impactors[0].load.value, ContactLoad::Patch { radius: 2e-3 });
    assert_eq!(patch.impact().unwrap().impactors[0].at.value, ImpactPoint::Point([1e-3, 0.0]));
}

#[test]
fn a_mesh_may_be_refined() {
    let mesh = |keys: &str| read_good(&spoilt(r#"file = "plate.msh", unit = "mm""#, keys)).mesh;
    let file = |keys: &str| match mesh(&format!(r#"file = "plate.msh", unit = "mm"{keys}"#)) {
        MeshSource::File { refine, curves, .. } => (refine.value, curves),
        other => panic!("{other:?}"),
    };
    assert_eq!(file(""), (0, Curves::Kept));
    assert_eq!(file(r#", refine = 2"#), (2, Curves::Kept));
    assert_eq!(file(r#", refine = 0, curves = "straight""#), (0, Curves::Straight));
    let rectangle = r#"rectangle = ["10 mm", "20 mm"], cells = [3, 5]"#;
    for (keys, cells) in [("", [3, 5]), (", refine = 0", [3, 5]), (", refine = 2", [12, 20])] {
        assert_eq!(
            mesh(&format!("{rectangle}{keys}")),
            MeshSource::Rectangle { size: [0.01, 0.02], cells, parts: vec![] }
        );
    }
    assert_eq!(refined_cells(15, 9), Ok(3_932_160));
    for (cells, times) in [(16, 9), (1, 11), (1, 31), (1, 32), (1, u32::MAX), (usize::MAX, 0), (usize::MAX, 1)] {
        assert!(refined_cells(cells, times).unwrap_err().to_string().contains("more than 4000000"), "{cells} {times}");
    }
}

#[test]
fn a_mesh_may_be_built_in() {
    let mesh = |keys: &str| spoilt(r#"file = "plate.msh", unit = "mm""#, keys);
    let built = |keys: &str| match read_good(&mesh(keys)).mesh {
        MeshSource::Graded { plate, refine, curves } => (plate.value, refine, curves),
        other => panic!("{other:?}"),
    };
    let disc = Graded {
        outline: Outline::Disc { radius: 0.025 },
        support: None,
        window: None,
        impact: [0.0; 2],
        size: 1e-3,
        edge_size: 3e-3,
    };
    assert_eq!(built(r#"disc = { radius = "25 mm", size = "1 mm" }"#), (disc, 0, Curves::Kept));
    let ringed = r#"{ sides = ["6 cm", "50 mm"], support = "20 mm", impact = ["1 mm", "-2 mm"], size = "1 mm", edge_size = "2 mm" }"#;
    let plate = Graded {
        outline: Outline::Rectangle { sides: [0.06, 0.05] },
        support: Some(0.02),
        window: None,
        impact: [1e-3, -2e-3],
        edge_size: 2e-3,
        ..disc
    };
    let keys = format!("plate = {ringed}, refine = 1, curves = \"straight\"");
    assert_eq!(built(&keys), (plate, 1, Curves::Straight));

    let refused = |keys: &str, words: &[&str]| {
        let error = parse(&mesh(keys), Path::new("scene.toml")).unwrap_err();
        let message = format!("{error}; {}", error.remedy());
        assert!(words.iter().all(|word| message.contains(word)), "{keys}: {message}");
    };
    refused(r#"disc = { radius = "25 mm" }"#, &["`mesh.disc.size` is missing", "size = \"1 mm\""]);
    refused(r#"disc = { radius = "25 mm", size = "1 mm", sides = "1 mm" }"#, &["unknown key `mesh.disc.sides`"]);
    refused(r#"disc = { radius = "25 mm", size = "1 mm" }, unit = "mm""#, &["unknown key `mesh.unit`"]);
    refused(r#"disc = { radius = "25 mm", size = "1" }"#, &["`mesh.disc.size`", "unit"]);
    refused(r#"disc = { radius = "25 mm", size = "-1 mm" }"#, &["`mesh.disc.size`: must be positive"]);
    let far = r#"disc = { radius = "25 mm", size = "1 mm", impact = ["20 mm", "0 mm"] }"#;
    refused(far, &["`mesh.disc.impact`: lies 20 mm from the middle", "15 mm", "fem mesh"]);
    let wide = r#"plate = { sides = ["50 mm", "50 mm"], size = "1 mm", support = "25 mm" }"#;
    refused(wide, &["`mesh.plate.support`", "leave it out"]);
    let fine = r#"disc = { radius = "25 mm", size = "1 um", edge_size = "1 um" }"#;
    refused(fine, &["`mesh.disc.size`", "more than 4000000"]);
    refused(r#"disc = { radius = "25 mm", size = "1 mm" }, refine = 9"#, &["`mesh.refine`", "4000000"]);
}

/// [`GOOD`] with several impactors.
fn several(impactors: &str) -> String {
    let own = r#"impactor = { mass = "2.49 kg", velocity = "1.56 m/s", at = { group = "impact" } }"#;
    format!("{}\n{impactors}", spoilt(own, ""))
}

const TWO: &str = r#"
[[impactor]]
mass = "10 g"
velocity = "3 m/s"
at = { group = "impact" }

[[impactor]]
name = "late"
mass = "20 g"
velocity = "2 m/s"
start = "50 us"
at = { x = "1 mm", y = "2 mm" }
patch_side = "2 mm"
contact = { law = "hertz", k = "1e5 N/mm^1.5" }
"#;

#[test]
fn impactors_may_be_several() {
    let scene = read_good(&several(TWO));
    let [first, late] = &scene.impact().unwrap().impactors[..] else { panic!("{scene:?}") };
    assert_eq!((first.name.as_str(), first.mass, first.velocity, first.start), ("impactor-1", 0.01, 3.0, 0.0));
    assert_eq!((late.name.as_str(), late.mass, late.velocity, late.start), ("late", 0.02, 2.0, 50e-6));
    assert_eq!(first.load.value, ContactLoad::Patch { radius: 3e-3 }, "the preset serves each");
    assert_eq!(late.load.value, ContactLoad::Square { side: 2e-3 });
    assert_eq!((first.contact.name.value.as_str(), late.contact.name.value.as_str()), ("sun-yang", "hertz"));
    assert_eq!(late.contact.params.keys().collect::<Vec<_>>(), ["k"], "its own law alone");
}

#[test]
fn layers_share_the_plies() {
    let layers = |value: &str| read_good(&spoilt("layers = [8, 8]", value)).laminates[0].laminate.value.layers.clone();
    assert_eq!(layers(""), [8, 8]);
    assert_eq!(layers("layers = 1"), [16]);
    assert_eq!(layers("layers = 3"), [5, 5, 6]);
    assert_eq!(layers("layers = [1, 10, 5]"), [1, 10, 5]);
}

#[test]
fn the_root_crate_can_point_at_any_value() {
    let scene = read_good(&spoilt("n = 1.5", "n = 15"));
    let line =
        |place: &Place| scene.source.error_at(place, "m", "").location().map(|(file, line)| (file.to_owned(), line));
    let at = |n| Some(("cases/plate/scene.toml".to_owned(), n));
    assert_eq!(line(&scene.impact().unwrap().impactors[0].contact.name.place), at(13));
    assert_eq!(
        line(scene.impact().unwrap().reduction.place_of("vectors")),
        Some(("preset `engineering`".to_owned(), 5))
    );
    let error = scene.source.error_at(
        scene.impact().unwrap().impactors[0].contact.place_of("n"),
        "`n`: must be 1 to 4, got 15",
        "Hertz: n = 1.5",
    );
    insta::assert_snapshot!(rendered(&error));
    assert_eq!(
        scene.impact().unwrap().impactors[0].contact.place_of("absent"),
        &scene.impact().unwrap().impactors[0].contact.name.place
    );
}

/// Every refusal: line, key and remedy, as people see it.
#[test]
fn refusals() {
    let mut report = String::new();
    for (what, text) in [
        ("impactors of one name", several(&TWO.replace("\"late\"", "\"impactor-1\""))),
        ("an impactor after the end", several(&TWO.replace("50 us", "1 ms"))),
        ("an impactor before the beginning", several(&TWO.replace("50 us", "-1 us"))),
        ("a missing key of one of several", several(&TWO.replace("mass = \"20 g\"", ""))),
        ("no impactor", several("").replace("title =", "impactor = []\ntitle =")),
        ("a bare number where a unit belongs", spoilt("mass = \"2.49 kg\"", "mass = 2.49")),
        ("a text without unit", spoilt("\"2.49 kg\"", "\"2.49\"")),
        ("an unknown unit", spoilt("1.56 m/s\", at", "1.56 m/sec\", at")),
        ("a quantity of another dimension", spoilt("2.49 kg\", v", "2.49 N\", v")),
        ("a unit that does not exist", spoilt("\"2.49 kg\"", "\"2.49 kg^\"")),
        ("zero where positive is needed", spoilt("\"2.49 kg\"", "\"0 kg\"")),
        ("a negative time", spoilt("end = \"1 ms\"", "end = \"-1 ms\"")),
        ("a number out of range", spoilt("\"2.49 kg\"", "\"1e999 kg\"")),
        ("not a number", spoilt("nu = 0.3", "nu = nan")),
        ("a quantity in quotes where a pure number belongs", spoilt("nu = 0.3", "nu = \"0.3\"")),
        ("an accuracy that nothing has", format!("accuracy = 0\n{GOOD}")),
        ("an accuracy beyond all", format!("accuracy = \"100 %\"\n{GOOD}")),
        ("an accuracy of something", format!("accuracy = \"1 N\"\n{GOOD}")),
        ("a study to an impossible tolerance", format!("study = {{ tolerance = 2 }}\n{GOOD}")),
        ("an axis without levels", format!("study = {{ axis = [{{ name = \"n\", levels = [] }}] }}\n{GOOD}")),
        ("a level that sets nothing", format!("study = {{ axis = [{{ name = \"n\", levels = [{{}}] }}] }}\n{GOOD}")),
        (
            "a stress without its height",
            format!("study = {{ quantities = [{{ name = \"s\", profile = \"c\", component = \"sxx\" }}] }}\n{GOOD}"),
        ),
        ("an unknown key at the top", spoilt("output =", "outputs =")),
        ("an unknown key in a table", spoilt("radius = \"10 mm\"", "raduis = \"10 mm\"")),
        ("an unknown key in a list", spoilt("dofs = [\"U30\"]", "dof = [\"U30\"]")),
        ("a missing key", spoilt("mass = \"2.49 kg\", ", "")),
        ("a missing table", spoilt("contact = {", "output.x = {").replace("output = {", "# {")),
        ("a table that only the preset has", spoilt("failure = {", "# {")),
        ("a duplicate key", spoilt("n = 1.5", "n = 1.5, n = 2")),
        ("no TOML", spoilt("title =", "title")),
        ("a wrong type", spoilt("plots = false", "plots = \"no\"")),
        ("a table where a text belongs", spoilt("\"2.49 kg\"", "{ value = 2.49 }")),
        ("a table where a list belongs", spoilt("fix = [\"U30\"]", "fix = \"U30\"")),
        ("an empty list", spoilt("fix = [\"U30\"]", "fix = []")),
        ("an unknown preset", format!("fidelity = \"high\"\n{GOOD}")),
        ("an unknown library material", spoilt("AS4/3502", "AS4/3501")),
        ("an unknown material", spoilt("material = \"as4-3502\"", "material = \"as4\"")),
        ("a material that no solid has", spoilt("nu = 0.3", "nu = 0.5")),
        ("a negative strength", spoilt("55 MPa", "-55 MPa")),
        ("too few constants", spoilt("e = \"70 MPa\", nu", "e1 = \"70 MPa\", nu12")),
        ("constants of two kinds", spoilt("nu = 0.3", "nu = 0.3, e2 = \"1 MPa\"")),
        ("a half-given orthotropy over the library", spoilt("\"AS4/3502\"", "\"AS4/3502\", e3 = \"9 GPa\"")),
        ("a layup that is not closed", spoilt("90{core}]", "90{core}")),
        ("an unknown ply type", spoilt("{core}", "{cure}")),
        ("layers that do not sum up", spoilt("[8, 8]", "[8, 7]")),
        ("a ply interface inside a layer", spoilt("[8, 8]", "[7.5, 8.5]")),
        ("more layers than plies", spoilt("[8, 8]", "17")),
        ("no layer", spoilt("[8, 8]", "0")),
        ("a wrong unknown", spoilt("\"U31\"], axes", "\"U34\"], axes")),
        ("a wrong level", spoilt("mid-plane", "middle")),
        ("a bare angle", spoilt("\"30 deg\"", "30")),
        ("a support of two kinds", spoilt("{ restrain", "{ group = \"support\", restrain")),
        ("an equation of mixed dimensions", spoilt("\"-2 mm\"", "-2")),
        ("a factor of zero", spoilt("factor = 1 ", "factor = 0 ")),
        ("an impact beyond all energies", spoilt("\"1.56 m/s\", at", "\"1e200 m/s\", at")),
        ("an impact without energy", spoilt("\"1.56 m/s\", at", "\"1e-200 m/s\", at")),
        ("two places of impact", spoilt("{ group = \"impact\" }", "{ group = \"impact\", x = \"0 mm\" }")),
        ("half a place of impact", spoilt("{ group = \"impact\" }", "{ x = \"0 mm\" }")),
        ("two loads", spoilt("mass = \"2.49 kg\"", "mass = \"2.49 kg\", load = \"node\", patch_radius = \"3 mm\"")),
        ("a plug-in without name", spoilt("law = \"sun-yang\", ", "")),
        ("a parameter that is a table", spoilt("n = 1.5", "n = { a = 1 }")),
        ("an endless march", spoilt("end = \"1 ms\"", "end = \"1 ms\", step = \"1e-20 s\"")),
        ("a march shorter than its step", spoilt("end = \"1 ms\"", "end = \"1 ns\"")),
        ("a tolerance that no estimate has", spoilt("end = \"1 ms\"", "end = \"1 ms\", tolerance = 0.5")),
        ("an unknown window", spoilt("radius =", "window = \"cell\", radius =")),
        ("two criteria of one name", spoilt("\"octahedral\"", "\"hashin-report\"")),
        ("a watch in no ply", spoilt("radius =", "watch = [{ at = { group = \"impact\" } }], radius =")),
        ("a watch in a ply and beside it", spoilt("radius =", "watch = [{ ply = 1, interface = \"1|2\" }], radius =")),
        ("a watch at no interface", spoilt("radius =", "watch = [{ interface = \"1|3\" }], radius =")),
        (
            "a watch of an unknown criterion",
            spoilt("radius =", "watch = [{ criterion = \"puck\", ply = 1, at = { group = \"impact\" } }], radius ="),
        ),
        ("an effect that does not exist yet", format!("effects = {{ damage = \"progressive\" }}\n{GOOD}")),
        ("a mesh refined by halves", spoilt("unit = \"mm\"", "unit = \"mm\", refine = 0.5")),
        ("a mesh refined backwards", spoilt("unit = \"mm\"", "unit = \"mm\", refine = -1")),
        ("a mesh refined without end", spoilt("unit = \"mm\"", "unit = \"mm\", refine = 1000000000")),
        (
            "too many cells",
            spoilt(
                r#"file = "plate.msh", unit = "mm""#,
                r#"rectangle = ["1 m", "1 m"], cells = [500, 500], refine = 3"#,
            ),
        ),
        (
            "a rectangle with curves",
            spoilt(
                r#"file = "plate.msh", unit = "mm""#,
                r#"rectangle = ["1 m", "1 m"], cells = [5, 5], curves = "kept""#,
            ),
        ),
        ("curves of an unknown kind", spoilt("unit = \"mm\"", "unit = \"mm\", curves = \"round\"")),
        ("a unit of mass for a length", spoilt("unit = \"mm\"", "unit = \"kg\"")),
    ] {
        let error = parse(&text, Path::new("scene.toml")).expect_err(what);
        assert!(error.location().is_some(), "{what}: {error}");
        report += &format!("== {what}\n{}\n", rendered(&error));
    }
    insta::assert_snapshot!(report);
}

#[test]
fn errors_in_a_preset_point_to_the_preset() {
    let text = "reduction = { modes = 4 }";
    let source = Arc::new(SceneSource::default().with(Origin::Preset, "preset `report`", text));
    let preset = Table::parse(text, Origin::Preset, &source).unwrap();
    let root = Reader::root(&preset, KEYS, &source).unwrap();
    let error = PluginSpec::read(&root.required("reduction").unwrap(), "method", &[]).unwrap_err();
    assert_eq!(error.location(), Some(("preset `report`", 1)));
}

#[test]
fn files_that_cannot_be_read() {
    let error = read(Path::new("no/such/scene.toml")).unwrap_err();
    assert!(error.to_string().contains("no/such/scene.toml") && error.location().is_none(), "{error}");
    assert!(rendered(&error).contains("cannot read the scene"));
    for text in ["", "\u{feff}", "# nothing"] {
        let error = parse(text, Path::new("scene.toml")).unwrap_err();
        assert!(rendered(&error).contains("`materials` is missing"), "{text:?}: {}", rendered(&error));
    }
}

/// The cases of the report: thickness of table 5, energies of tables 4 and 6, groups of the meshes.
#[test]
fn the_examples_are_the_cases_of_the_report() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    for (case, plies, millimetres, joules) in [
        ("as4-3502-16ply-50mm", 16, 2.1133, 3.03),
        ("as4-3502-16ply-75mm", 16, 2.1133, 6.13),
        ("as4-3502-8ply-25mm", 8, 1.0566, 3.03),
        ("as4-3502-8ply-50mm", 8, 1.0566, 3.03),
        ("as4-3502-8ply-75mm", 8, 1.0566, 3.03),
        ("im6-934-32ply-drop-weight", 32, 4.1453, 1.92),
        ("im6-934-32ply-large-mass", 32, 4.1453, 3.86),
        ("im6-934-32ply-small-mass", 32, 4.1453, 3.79),
    ] {
        let scene = read(&examples.join(case).join("scene.toml")).unwrap_or_else(|e| panic!("{}", rendered(&e)));
        let laminate = &scene.laminates[0].laminate.value;
        let thickness = laminate.thickness();
        let energy =
            0.5 * scene.impact().unwrap().impactors[0].mass * scene.impact().unwrap().impactors[0].velocity.powi(2);
        assert_eq!((laminate.plies.len(), laminate.layers.len()), (plies, 2), "{case}");
        assert!(laminate.plies.iter().eq(laminate.plies.iter().rev()), "{case} is symmetric");
        assert!((thickness * 1e3 - millimetres).abs() < 1e-4, "{case}: {thickness} m");
        assert!((energy - joules).abs() < 0.005, "{case}: {energy} J");
        assert!(mesh_file(&scene).is_file(), "{case}");
    }
}

proptest! {
    /// Bytes of a scene that is nearly good: cut, doubled, replaced.
    #[test]
    fn no_mutation_panics(edits in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..4_u8), 1..4)) {
        let mut text: Vec<char> = GOOD.chars().collect();
        for (a, b, how) in edits {
            let (i, j) = (a.index(text.len()), b.index(text.len()));
            match how {
                0 => text[i] = text[j],
                1 => text.insert(i, text[j]),
                2 => { text.remove(i); }
                _ => { let end = (i + 20).min(text.len()); text.drain(i..end); }
            }
        }
        let text: String = text.into_iter().collect();
        if let Err(error) = parse(&text, Path::new("scene.toml")) { rendered(&error); }
    }

    #[test]
    fn no_text_panics(text in "\\PC*") {
        if let Err(error) = parse(&text, Path::new("scene.toml")) { rendered(&error); }
    }
}

/// What the tables of keys call a default is what the reader takes.
#[test]
fn defaults_are_those_of_the_reader() {
    let source = parse(GOOD, Path::new("scene.toml")).unwrap().source;
    let given: Setting = explain(&source, &|_| Vec::new(), &[])
        .unwrap()
        .into_iter()
        .filter(|key| key.from == "default" && !key.key.contains('['))
        .map(|key| (key.key, key.value))
        .collect();
    let keys: Vec<&str> = given.keys().map(String::as_str).collect();
    for key in ["analysis", "effects.damage", "impactor.start", "mesh.curves", "output.checkpoint_every"] {
        assert!(keys.contains(&key), "{key} is none of {keys:?}");
    }
    // Everything is the same but for where it stands.
    let shown = |setting: &Setting| {
        let scene = under(&source, setting).unwrap();
        let EffectsSpec { damage, delamination, named } = &scene.effects;
        let effects = format!("{damage:?} {:?} {}", delamination.as_ref().map(|d| d.value), named.len());
        let bare = Scene { effects: EffectsSpec::default(), keys: BTreeMap::new(), source: Arc::default(), ..scene };
        let text = format!("{bare:?}");
        let mut pieces = text.split("Place {");
        let first = pieces.next().unwrap().to_owned();
        pieces.fold(first + &effects, |all, piece| all + piece.split_once('}').unwrap().1)
    };
    assert_eq!(shown(&given), shown(&Setting::new()));
}

/// Every key says in a line what it means, and its example is what it takes.
#[test]
fn keys_are_described() {
    fn visit(keys: keys::Keys, path: &str) {
        for key in keys {
            let path = format!("{path}.{}", key.name);
            assert!(
                !key.about.is_empty() && key.about.len() < 118 && !key.about.contains('\n'),
                "{path}: {}",
                key.about
            );
            let node = schema::value_of(key.example).unwrap_or_else(|| panic!("{path}: {}", key.example));
            assert!(key.form.form_of(&node).fits(&node), "{path} = {}", key.example);
            within(&key.form, &path);
        }
    }
    fn within(form: &keys::Form, path: &str) {
        match form {
            keys::Form::Table(keys) | keys::Form::Plugin(_, _, keys) => visit(keys, path),
            keys::Form::List(form) | keys::Form::Named(form) | keys::Form::Several(_, form) => within(form, path),
            keys::Form::OneOf(forms) => forms.iter().for_each(|form| within(form, path)),
            _ => {}
        }
    }
    visit(KEYS, "");
}
