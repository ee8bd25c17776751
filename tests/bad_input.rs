//! What is wrong with a scene, a mesh or a command line is said with file, line, entity and remedy; exit status 1 or 2,
//! nothing on standard output, no result left behind.

use crate::support::{Case, Done, fem, plate, root, strip};
use fem::io::files::OutputDir;
use std::fs;

/// Where a refusal points to.
enum At<'a> {
    /// To the line of the scene that begins with this text.
    Scene(&'a str),
    /// To the line of the mesh that begins with this text.
    Mesh(&'a str),
    /// To the mesh as a whole.
    MeshFile,
}

/// The refusal of `case`, which must point to `at` and hold `words`.
#[track_caller]
fn refusal(case: &Case, at: At<'_>, words: &[&str]) -> String {
    let complaint = complaint(case, case.fem("run", &[]));
    let flat = flat(&complaint);
    let place = match at {
        At::Scene(start) => format!("[plate/scene.toml:{}:", line(&case.read("plate/scene.toml"), start)),
        At::Mesh(start) => format!("plate/plate.msh:{}: ", line(&case.read("plate/plate.msh"), start)),
        At::MeshFile => "plate/plate.msh: ".to_owned(),
    };
    for words in words.iter().chain([&place.as_str()]) {
        assert!(flat.contains(words), "{words:?} is not in {complaint}");
    }
    complaint
}

/// What a refused command said; it must have left everything as it was.
#[track_caller]
fn complaint(case: &Case, done: Done) -> String {
    assert_eq!((done.status, done.stdout.as_str()), (1, ""), "{done:#?}");
    assert_eq!(
        (case.names("."), case.names("plate")),
        (vec!["plate".into()], vec!["plate.msh".into(), "scene.toml".into()])
    );
    done.stderr
}

/// A text without its line breaks and the bars that go with them.
fn flat(text: &str) -> String {
    text.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

/// Number of the one line that begins with `start`.
#[track_caller]
fn line(text: &str, start: &str) -> usize {
    let found: Vec<_> = text.lines().enumerate().filter(|(_, line)| line.starts_with(start)).collect();
    assert_eq!(found.len(), 1, "{start:?} begins one line of {text}");
    found[0].0 + 1
}

/// Keys ahead of the first table of a scene.
fn with_keys(case: Case, keys: &str) -> Case {
    case.scene("mesh = {", &format!("{keys}\nmesh = {{"))
}

mod scene {
    use super::*;

    #[test]
    fn number_without_unit() {
        let case = plate().scene("\"2.49 kg\"", "2.49");
        insta::assert_snapshot!(refusal(&case, At::Scene("mass ="), &["`2.49` is a bare number", "\"2.49 kg\""]));
    }

    #[test]
    fn wrong_unit() {
        let case = plate().scene("\"2.49 kg\"", "\"2.49 N\"");
        refusal(&case, At::Scene("mass ="), &["`2.49 N` is a force, not a mass", "accepted: kg"]);
    }

    #[test]
    fn contact_stiffness_of_another_power() {
        let case = plate().scene("N/mm^1.5", "N/mm^2");
        insta::assert_snapshot!(refusal(&case, At::Scene("k ="), &["contact law `sun-yang`: `k`", "N/m^1.5"]));
    }

    #[test]
    fn unknown_key() {
        let case = plate().scene("ply_thickness", "ply_thicknes");
        let words = ["unknown key `laminate.ply_thicknes`", "did you mean `ply_thickness`?"];
        insta::assert_snapshot!(refusal(&case, At::Scene("ply_thicknes ="), &words));
    }

    #[test]
    fn layers_that_do_not_sum_to_the_plies() {
        let case = plate().scene("[8, 8]", "[8, 7]");
        refusal(&case, At::Scene("layers ="), &["the layers hold 15 plies, the laminate has 16"]);
    }

    #[test]
    fn ply_interface_inside_a_layer() {
        let case = plate().scene("[8, 8]", "[7.5, 8.5]");
        refusal(&case, At::Scene("layers ="), &["7.5 plies would put a ply interface inside a layer", "whole numbers"]);
    }

    #[test]
    fn layers_that_do_not_meet_at_the_mid_plane() {
        let case = plate().scene("[8, 8]", "[4, 12]");
        refusal(&case, At::Scene("group = \"support\""), &["no face between layers lies at the mid-plane", "`layers`"]);
    }

    #[test]
    fn material_that_no_solid_has() {
        let case = plate().scene("library = \"AS4/3502\"", "library = \"AS4/3502\", nu12 = 3.7");
        let words = ["material `as4-3502`", "|nu12| < sqrt(E1/E2) = 3.67", "got nu12 = 3.7"];
        insta::assert_snapshot!(refusal(&case, At::Scene("materials.as4-3502"), &words));
    }

    #[test]
    fn material_without_the_density_that_a_plate_needs() {
        let strengths = ["Xt", "Xc", "Yt", "Yc", "S12", "S23"].map(|name| format!(", {name} = \"90 MPa\"")).concat();
        let light = &format!("e = \"70 GPa\", nu = 0.3{strengths}");
        let case = plate().scene("library = \"AS4/3502\"", light);
        let words = ["material `as4-3502`: the mass of the plate needs a density", "density = \"1.58 g/cm^3\""];
        refusal(&case, At::Scene("materials.as4-3502"), &words);
        let case = case.scene(light, &format!("{light}, density = \"2.7 g/cm^3\""));
        case.fem("check", &[]).good();
    }

    #[test]
    fn absent_file() {
        let case = plate();
        case.write();
        let done = fem(case.folder(), &["run", "plate/scene.tml"]);
        assert!(complaint(&case, done).contains("cannot read the scene `plate/scene.tml`"));
    }

    #[test]
    fn folder_instead_of_a_file() {
        let case = plate();
        case.write();
        assert!(complaint(&case, fem(case.folder(), &["check", "plate"])).contains("cannot read the scene `plate`"));
    }

    #[test]
    fn bytes_that_are_no_text() {
        let case = plate();
        let scene = case.write();
        fs::write(case.folder().join(scene), b"title = \"\xff\xfe\"").unwrap();
        let done = fem(case.folder(), &["run", scene]);
        assert!(complaint(&case, done).contains("UTF-8"));
    }
}

mod groups {
    use super::*;

    #[test]
    fn missing() {
        let case = plate().scene("group = \"support\"", "group = \"suport\"");
        let words = ["the mesh has no group `suport`", "did you mean `support`?", "(known: impact, plate, support)"];
        insta::assert_snapshot!(refusal(&case, At::Scene("group ="), &words));
    }

    #[test]
    fn impact_on_a_curve() {
        let case = plate().scene("{ group = \"impact\" }", "{ group = \"support\" }");
        let words = ["the group `support` (dimension 1) has 48 nodes, a point has one", "physical point"];
        insta::assert_snapshot!(refusal(&case, At::Scene("at = { group"), &words));
    }

    #[test]
    fn impact_on_several_points() {
        let case = strip()
            .scene("{ x = \"15 mm\", y = \"5 mm\" }", "{ group = \"tip\" }")
            .mesh("4 0 10 2 0 ", "4 0 10 2 1 3 ")
            .mesh("3 11 1 11\n", "4 12 1 12\n0 4 15 1\n12 4\n");
        refusal(&case, At::Scene("at = { group"), &["(dimension 0) has 2 nodes"]);
    }

    #[test]
    fn impact_on_no_point() {
        let case = plate().scene("{ group = \"impact\" }", "{ group = \"centre\" }");
        refusal(&case, At::Scene("at = { group"), &["the mesh has no group `centre`"]);
    }

    #[test]
    fn impact_beside_the_plate() {
        let case = strip().scene("x = \"15 mm\"", "x = \"15 in\"");
        let words = ["x, y = 381, 5 mm lies outside the plate", "x runs from 0 mm to 30 mm"];
        refusal(&case, At::Scene("at = { x"), &words);
    }

    #[test]
    fn impact_on_a_place_without_node() {
        let case = strip().scene("x = \"15 mm\"", "x = \"14 mm\"").scene("velocity", "load = \"node\"\nvelocity");
        refusal(&case, At::Scene("at = { x"), &["no node of the mesh lies at the impact point", "patch_radius"]);
    }

    #[test]
    fn impact_on_a_support() {
        let case = strip().scene("x = \"15 mm\"", "x = \"0 mm\"").scene("velocity", "load = \"node\"\nvelocity");
        refusal(&case, At::Scene("at = { x"), &["the supports hold the plate exactly where the impactor strikes"]);
        let beside =
            strip().scene("x = \"15 mm\"", "x = \"0.5 mm\"").scene("velocity", "patch_radius = \"0.4 mm\"\nvelocity");
        refusal(
            &beside,
            At::Scene("at = { x"),
            &["the supports hold the node that takes most of the impact", "divide the cells there"],
        );
    }
}

mod mesh {
    use super::*;

    #[test]
    fn absent() {
        let case = plate().scene("plate.msh", "plte.msh");
        refusal(&case, At::Scene("mesh ="), &["plate/plte.msh: cannot read the file", "folder of the scene"]);
    }

    #[test]
    fn empty() {
        refusal(
            &strip().mesh_bytes(""),
            At::MeshFile,
            &["not a mesh of gmsh, Abaqus or Nastran", "gmsh FILE.geo -2 -format msh41"],
        );
    }

    #[test]
    fn garbage() {
        let garbage: Vec<u8> = (0..4096_u32).map(|i| (i * i * 31 / 7) as u8).collect();
        refusal(&strip().mesh_bytes(garbage), At::MeshFile, &["not a mesh of gmsh, Abaqus or Nastran"]);
    }

    #[test]
    fn truncated() {
        let case = strip();
        let whole = fs::read(root().join("tests/data/mesh/ascii.msh")).unwrap();
        let case = case.mesh_bytes(&whole[..800]);
        let complaint = complaint(&case, case.fem("run", &[]));
        assert!(flat(&complaint).contains("the file is damaged or cut short, save it again from gmsh"), "{complaint}");
    }

    #[test]
    fn triangles() {
        let case = with_keys(strip().mesh_file("triangles.msh"), "element.kind = \"mitc4\"");
        let words = ["is a triangle", "hermite-prism", "Recombine Surface"];
        insta::assert_snapshot!(refusal(&case, At::Scene("element."), &words));
    }

    #[test]
    fn no_physical_groups() {
        let words = ["no physical group holds a cell", "Physical Surface(\"plate\")"];
        refusal(&strip().mesh_file("no-groups.msh"), At::MeshFile, &words);
    }

    #[test]
    fn groups_without_names() {
        let words = ["the mesh has no group `clamped`", "(known: 1, 2, 3)"];
        refusal(&strip().mesh_file("unnamed.msh"), At::Scene("group ="), &words);
    }

    #[test]
    fn coordinate_that_is_no_number() {
        let case = strip().mesh("30 0 2\n0 3", "nan 0 2\n0 3");
        refusal(&case, At::Mesh("nan 0 2"), &["node 2 has the coordinate NaN"]);
    }

    #[test]
    fn count_beyond_all_memory() {
        let case = strip().mesh("9 15 1 15", "9 1000000000000 1 15");
        refusal(&case, At::MeshFile, &["$Nodes announces 1000000000000 entries and holds 15"]);
        let case = strip().mesh("1 1 0 3\n", "1 1 0 1000000000000\n");
        let complaint = complaint(&case, case.fem("run", &[]));
        assert!(flat(&complaint).contains("plate/plate.msh:40: not valid MSH"), "{complaint}");
    }

    #[test]
    fn element_with_a_node_that_is_not_there() {
        let case = strip().mesh("4 1 5 13 12 ", "4 1 5 13 16 ");
        refusal(&case, At::Mesh("4 1 5 13 16"), &["element 4 refers to node 16, which the file does not have"]);
    }

    #[test]
    fn cells_that_are_not_joined() {
        let case = strip().mesh_file("not-joined.msh");
        let complaint = complaint(&case, case.fem("run", &[]));
        assert!(flat(&complaint).contains("nodes 2 and 5 lie at the same point"), "{complaint}");
    }

    /// Such files differ from `ascii.msh` in the order of what they hold, or in what no cell uses.
    #[test]
    fn files_that_look_odd_give_the_same_result() {
        let peak = |case: &Case| {
            case.fem("run", &["--out", "out"]).good();
            case.summary("out")["impact"]["peak_force_N"].as_f64().unwrap()
        };
        let expected = peak(&strip());
        let unused = strip()
            .mesh("9 15 1 15", "9 17 1 17")
            .mesh("2 1 0 3\n13\n14\n15\n", "2 1 0 5\n13\n14\n15\n16\n17\n")
            .mesh("4.999999999994296 2\n", "4.999999999994296 2\n1e3 0 0\n5 5 7\n");
        let mixed = strip().mesh("4 1 5 13 12 ", "4 12 13 5 1 ");
        let named = ["binary.msh", "clockwise.msh", "crlf.msh", "msh22.msh", "msh40.msh", "rcm.msh", "sparse.msh"];
        let named = named.map(|name| (name, strip().mesh_file(name)));
        for (name, case) in named.into_iter().chain([("unused nodes", unused), ("mixed orientation", mixed)]) {
            let peak = peak(&case);
            assert!((peak - expected).abs() < 1e-9 * expected, "{name}: {peak} N, not {expected} N");
        }
    }

    #[test]
    fn warnings() {
        let disk = |file: &str| {
            plate()
                .mesh_file(file)
                .scene("group = \"support\"", "group = \"rim\"")
                .scene("{ group = \"impact\" }", "{ x = \"0 mm\", y = \"0 mm\" }")
        };
        for (case, words) in [
            (
                with_keys(disk("serendipity.msh").scene("layers = [8, 8]", "layers = 1"), "element.kind = \"mitc4\""),
                "8 sides of cells are bent, by up to 9.95 % of their length, and stay straight",
            ),
            (strip().mesh_file("clockwise.msh"), "8 of 8 cells were clockwise (the first is 4) and turned round"),
            (strip().mesh("4 1 5 13 12 ", "4 12 13 5 1 "), "1 of 8 cells was clockwise (the first is 4)"),
            (
                plate().scene("unit = \"mm\"", "unit = \"m\""),
                "the plate is 50 m wide and 2.113 mm thick: is `mesh.unit` the unit of the mesh file?",
            ),
        ] {
            let done = case.fem("check", &[]).good();
            assert!(
                flat(&done.stdout).contains(&format!("warning {words}")) || flat(&done.stdout).contains(words),
                "{done:#?}"
            );
        }
        for (constant, words) in [
            ("density=1575 g/cm^3", "material `as4-3502`: density = 1575000 kg/m^3 is none of a solid"),
            ("e1=130.3e3 GPa", "material `as4-3502`: e1 = 130300 GPa is none of a solid"),
        ] {
            let done = strip().fem("check", &["--set", &format!("materials.as4-3502.{constant}")]).good();
            assert!(flat(&done.stdout).contains(words), "{done:#?}");
        }
    }
}

mod supports {
    use super::*;

    #[test]
    fn rigid_motions_left_free() {
        let case = plate().scene("[[support]]\nrestrain = \"rigid-motions\"\n", "");
        let words = [
            "the supports leave the plate free: translation along x, translation along y, rotation about z",
            "{ restrain = \"rigid-motions\" }",
        ];
        insta::assert_snapshot!(refusal(&case, At::Scene("[[support]]"), &words));
    }

    #[test]
    fn equations_in_a_cycle() {
        let equation = |factor: &str| {
            format!(
                "[[equation]]\nterms = [\n  {{ group = \"tip\", at = \"top\", dof = \"U30\", factor = 1 }},\n  \
                 {{ group = \"tip\", at = \"bottom\", dof = \"U30\", factor = {factor} }},\n]\n"
            )
        };
        let case = strip().append(&equation("-1")).append(&equation("-2"));
        let complaint = complaint(&case, case.fem("run", &[]));
        for words in ["equation 2 and equation 1 form a cycle that only zero satisfies", "plate/scene.toml:"] {
            assert!(flat(&complaint).contains(words), "{complaint}");
        }
        insta::assert_snapshot!(complaint);
    }

    #[test]
    fn equation_at_several_nodes() {
        let terms = "terms = [{ group = \"clamped\", at = \"top\", dof = \"U30\", factor = 1 }]\n";
        let case = strip().append("[[equation]]\n").append(terms);
        refusal(&case, At::Scene("terms ="), &["a term of an equation takes a single node, but `clamped` has more"]);
    }
}

mod symmetry {
    use super::*;

    fn half(case: Case) -> Case {
        with_keys(case, "symmetry = \"half-turn\"")
    }

    /// The refusal of a symmetry that the scene does not have.
    #[track_caller]
    fn broken(case: &Case, at: &str, words: &[&str]) {
        refusal(case, At::Scene(at), &[words, &["leave `symmetry` out"]].concat());
    }

    #[test]
    fn word_that_is_none() {
        let case = with_keys(plate(), "symmetry = \"third-turn\"");
        refusal(&case, At::Scene("symmetry ="), &["`third-turn`", "half-turn, mirror-x, mirror-y, quarter"]);
    }

    #[test]
    fn mesh_without_an_image() {
        let case = half(plate()).mesh("\n2.539999999994706 0 0", "\n2.549 0 0");
        broken(&case, "symmetry =", &["the mesh has no symmetry `half-turn`", "node", "has no image"]);
    }

    #[test]
    fn ply_that_a_mirror_turns() {
        let case = with_keys(plate(), "symmetry = \"quarter\"");
        let words = ["ply 2 at 45 degrees breaks the symmetry `quarter`", "plies at 0 and 90 degrees"];
        refusal(&case, At::Scene("symmetry ="), &words);
    }

    #[test]
    fn impact_off_the_axis() {
        let case = half(plate()).scene("at = { group = \"impact\" }", "at = { x = \"1 mm\", y = \"0 mm\" }");
        broken(&case, "at = { x", &["an impact at (1.000000, 0.000000) mm breaks the symmetry `half-turn`"]);
    }

    #[test]
    fn support_on_one_side() {
        let case = half(strip()).scene("[[support]]\nrestrain = \"rigid-motions\"\n", "");
        let words =
            ["support of `clamped`: U10 at node", "breaks the symmetry `half-turn`", "holds its image, U10 at node"];
        broken(&case, "[[support]]", &words);
    }

    #[test]
    fn load_on_one_side() {
        let load = "[[load]]\nforce = [\"0 N\", \"0 N\", \"-1 N\"]\ngroup = \"tip\"\nat = \"top\"\n";
        let scene = format!(
            "title = \"t\"\nanalysis = \"static\"\nsymmetry = \"half-turn\"\nmesh = {{ file = \"plate.msh\", unit = \"mm\" }}\n\
             materials.m = {{ library = \"AS4/3502\" }}\nlaminate = {{ plies = \"[0/45]s\", material = \"m\", ply_thickness = \"0.1 mm\" }}\n\
             support = [{{ group = \"plate\", at = \"bottom\", fix = [\"U30\"] }}, {{ restrain = \"rigid-motions\" }}]\n{load}"
        );
        let case = strip().text(&scene);
        broken(&case, "[[load]]", &["the load breaks the symmetry `half-turn`", "what acts on U30 at node"]);
    }

    #[test]
    fn criterion_that_sees_the_sign_of_a_shear() {
        let expression = r#"[{ name = "expression", expression = "s23/Yt" }]"#;
        let case = half(plate()).scene("[\"hashin-report\", \"octahedral\"]", expression);
        broken(&case, "symmetry =", &["criterion `expression` breaks the symmetry `half-turn`", "sign of a shear"]);
    }
}

mod marches {
    use super::*;

    #[test]
    fn step_beyond_the_stability_limit() {
        let case = strip().scene("[march]", "[march]\nintegrator = \"rk4\"\nstep = \"10 us\"");
        let words = [
            "the step of 10.0000 us is beyond the stability limit of",
            "the integrator needs omega*dt <= 1.5",
            "highest frequency of plate and contact",
            "`newmark`",
        ];
        // The frequencies of a reduced model depend on rounding in their last digits.
        insta::assert_snapshot!(refusal(&case, At::Scene("step ="), &words).replace(|c: char| c.is_ascii_digit(), "#"));
    }

    #[test]
    fn warnings_come_with_a_refusal_that_they_may_explain() {
        let case = with_keys(strip(), "reduction = { method = \"guyan\", governors = 1000 }");
        let case = case
            .scene("unit = \"mm\"", "unit = \"m\"")
            .scene("x = \"15 mm\", y = \"5 mm\"", "x = \"15 m\", y = \"5 m\"");
        let words = ["Warning: the plate is 30 m wide and 2.113 mm thick", "1000 governors are asked for"];
        refusal(&case, At::Scene("reduction ="), &words);
    }

    #[test]
    fn singular_mass() {
        let case = with_keys(strip(), "element.mass = \"linear\"\nreduction.method = \"none\"")
            .scene("[march]", "[march]\nintegrator = \"rk4\"\nstep = \"0.01 us\"");
        let words =
            ["`rk4` needs the inverse of the mass matrix, which is singular: U1", "has no inertia", "`newmark`"];
        insta::assert_snapshot!(refusal(&case, At::Scene("integrator ="), &words));
    }

    #[test]
    fn run_that_loses_its_energy_stops_and_keeps_what_it_had() {
        let case = strip().scene("end = \"20 us\"", "step = \"1 ms\"\nend = \"10 ms\"");
        let done = case.fem("run", &["--out", "out"]);
        assert_eq!((done.status, done.stderr.as_str()), (1, ""), "{done:#?}");
        let summary = case.summary("out");
        let stopped = summary["stopped"].as_str().unwrap();
        assert!(stopped.contains("energy error") && stopped.contains("shorten `march.step`"), "{stopped}");
        assert!(done.stdout.contains(&format!("STOPPED   {stopped}")), "{done:#?}");
        assert_eq!(summary["completed"], false);
        let (_, rows) = case.table("out/history.csv");
        let end: f64 = rows.last().unwrap()[0].parse().unwrap();
        assert_eq!(summary["impact"]["end_time_s"].as_f64(), Some(end));
        assert!((1..200).contains(&rows.len()), "{} rows", rows.len());
    }

    #[test]
    fn more_governors_than_unknowns() {
        let case = with_keys(strip(), "reduction = { method = \"guyan\", governors = 1000 }");
        refusal(&case, At::Scene("reduction ="), &["1000 governors are asked for, but the model offers only"]);
    }
}

mod failure {
    use super::*;

    #[test]
    fn strength_that_is_not_given() {
        let case = plate().scene("\"octahedral\"]", "\"max-stress-interface\"]");
        let words = ["material `resin`", "criterion `max-stress-interface` needs the strength"];
        insta::assert_snapshot!(refusal(&case, At::Scene("materials.resin"), &words));
    }

    #[test]
    fn interface_without_resin() {
        let case = plate().scene("interface = \"resin\"\n", "");
        let words = ["criterion `octahedral` judges the resin between plies", "`laminate.interface`"];
        refusal(&case, At::Scene("criteria ="), &words);
    }

    #[test]
    fn radius_without_cells() {
        let case = plate().append("radius = \"1 um\"\n");
        refusal(&case, At::Scene("[failure]"), &["no cell has its centre within `failure.radius` of the impact"]);
    }

    #[test]
    fn two_criteria_of_one_name() {
        let case = plate().scene("\"octahedral\"]", "\"hashin-report\"]");
        let words = ["a second criterion is called `hashin-report`", "as = \"hashin-report-2\""];
        refusal(&case, At::Scene("criteria ="), &words);
    }

    #[test]
    fn places_that_cannot_be_watched() {
        let scene = "criteria = [\"hashin-report\", \"octahedral\"]";
        let many = r#"{ at = { group = "impact" }, ply = 1 }, "#.repeat(40);
        for (watch, words) in [
            (r#"{ at = { group = "impact" }, ply = 17 }"#, "the laminate has 16 plies"),
            (r#"{ at = { group = "impact" }, interface = "16|17" }"#, "the laminate has 16 plies"),
            (r#"{ at = { group = "impct" }, ply = 1 }"#, "did you mean `impact`?"),
            (r#"{ at = { x = "1 m", y = "0 mm" }, ply = 1 }"#, "(1000.0000, 0.0000) mm lies in no cell"),
            (r#"{ at = { group = "support" }, ply = 1 }"#, "a point has one"),
            (
                r#"{ at = { group = "impact" }, ply = 1, criterion = "octahedral" }"#,
                "the criterion named here judges no plies",
            ),
            (&many, "asks for 40 histories"),
        ] {
            let case = plate().scene(scene, &format!("{scene}\nwatch = [{watch}]"));
            refusal(&case, At::Scene("watch ="), &[words]);
        }
        let case = plate()
            .scene(scene, "criteria = [\"puck\"]\nwatch = [{ at = { group = \"impact\" }, interface = \"1|2\" }]");
        refusal(&case, At::Scene("watch ="), &["none of the criteria judges interfaces", "watch a `ply`"]);
    }
}

mod plugins {
    use super::*;

    #[test]
    fn unknown_element() {
        let case = with_keys(plate(), "element.kind = \"hermite-brick\"");
        let words = ["there is no element `hermite-brick`", "did you mean `hermite-prism`?"];
        refusal(&case, At::Scene("element."), &words);
    }

    #[test]
    fn unknown_contact_law() {
        let case = plate().scene("\"sun-yang\"", "\"sun-tan\"");
        let words = ["there is no contact law `sun-tan`", "did you mean `sun-yang`?"];
        insta::assert_snapshot!(refusal(&case, At::Scene("law ="), &words));
    }

    #[test]
    fn unknown_integrator() {
        let case = plate().scene("[march]", "[march]\nintegrator = \"newmark-beta\"");
        refusal(
            &case,
            At::Scene("integrator ="),
            &["there is no integrator `newmark-beta`", "did you mean `newmark`?"],
        );
    }

    #[test]
    fn unknown_reduction() {
        let case = with_keys(plate(), "reduction.method = \"guyon\"");
        refusal(&case, At::Scene("reduction."), &["there is no reduction `guyon`", "did you mean `guyan`?", "none"]);
    }

    #[test]
    fn unknown_criterion() {
        let case = plate().scene("\"hashin-report\"", "\"hashin-1981\"");
        let words = ["there is no criterion `hashin-1981`", "did you mean `hashin-1980`?"];
        refusal(&case, At::Scene("criteria ="), &words);
    }

    #[test]
    fn unknown_parameter() {
        let case = plate().scene("beta = 0.4", "betta = 0.4");
        let words = ["contact law `sun-yang`: `betta`: is not known; did you mean `beta`?"];
        refusal(&case, At::Scene("betta ="), &words);
    }

    #[test]
    fn parameter_of_an_unknown_unit() {
        let case = plate().scene("N/mm^1.5", "N/mn^1.5");
        let words = ["contact law `sun-yang`: `k`: unknown unit `mn`", "`mn` is not known"];
        refusal(&case, At::Scene("k ="), &words);
    }

    #[test]
    fn parameter_of_no_reduction() {
        let case = with_keys(plate(), "reduction = { method = \"none\", modes = 3 }");
        refusal(&case, At::Scene("reduction ="), &["`modes` means nothing without a reduction"]);
    }
}

mod contact {
    use super::*;

    #[test]
    fn patch_that_leaves_the_plate() {
        let case = strip().scene("velocity", "patch_radius = \"6 mm\"\nvelocity");
        let words = [
            "the contact patch of radius 6 mm around x, y = 15, 5 mm extends beyond the plate",
            "choose a smaller `impactor.patch_radius`",
            "the plate is 30 mm by 10 mm",
        ];
        insta::assert_snapshot!(refusal(&case, At::Scene("patch_radius ="), &words));
    }

    #[test]
    fn mesh_in_metres_read_as_millimetres() {
        let case = strip().scene("unit = \"mm\"", "unit = \"um\"");
        refusal(
            &case,
            At::Scene("[laminate]"),
            &["30 um wide and 2.113 mm thick", "`mesh.unit`, the unit of the mesh"],
        );
        let case = strip().scene("x = \"15 mm\"", "x = \"45 mm\"");
        refusal(&case, At::Scene("at = { x"), &["lies outside the plate", "if `mesh.unit` is right"]);
    }
}

mod results {
    use super::*;

    #[test]
    fn file_where_the_folder_should_be() {
        let case = strip();
        let complaint = complaint(&case, case.fem("run", &["--out", "plate/plate.msh/results"]));
        for words in ["plate/plate.msh/results", "choose a folder, not a file"] {
            assert!(flat(&complaint).contains(words), "{complaint}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn folder_that_may_not_be_written() {
        use std::os::unix::fs::PermissionsExt;
        let case = strip();
        let locked = case.folder().join("locked");
        fs::create_dir(&locked).unwrap();
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
        if fs::write(locked.join("probe"), "").is_ok() {
            return; // The superuser may write everywhere.
        }
        let done = case.fem("run", &["--out", "locked/results"]);
        assert_eq!((done.status, done.stdout.as_str()), (1, ""), "{done:#?}");
        assert!(flat(&done.stderr).contains("choose a folder that you may write"), "{done:#?}");
    }

    #[test]
    fn folder_in_use() {
        let case = strip();
        let held = OutputDir::create(case.folder().join("out")).unwrap();
        let done = case.fem("run", &["--out", "out"]);
        assert_eq!((done.status, done.stdout.as_str()), (1, ""), "{done:#?}");
        assert!(flat(&done.stderr).contains("another run is writing into `out`: wait for it to end"), "{done:#?}");
        assert_eq!(case.names("out"), [".fem"]);
        drop(held);
        case.fem("run", &["--out", "out"]).good();
    }
}

mod arguments {
    use super::*;

    #[test]
    fn command_lines_that_make_no_sense() {
        let case = strip();
        let scene = case.write();
        for (arguments, words) in [
            (&[][..], "Usage: fem [OPTIONS] <COMMAND>"),
            (&["rnu", scene], "unrecognized subcommand 'rnu'"),
            (&["run"], "<SCENE>"),
            (&["run", scene, "--thread", "2"], "'--threads'"),
            (&["run", scene, "--threads", "0"], "invalid value '0' for '--threads"),
            (&["check", scene, scene], "unexpected argument"),
            (&["list", "criterions"], "criteria"),
        ] {
            let done = fem(case.folder(), arguments);
            assert_eq!((done.status, done.stdout.as_str()), (2, ""), "{arguments:?} {done:#?}");
            assert!(done.stderr.contains(words), "{arguments:?} {done:#?}");
        }
    }
}

mod refinement {
    use super::*;

    #[test]
    fn more_cells_than_anyone_wants() {
        // 8 cells: 4^9 of each are 2 million, 4^10 are 8 million.
        let refined = |times: &str| strip().scene("unit = \"mm\"", &format!("unit = \"mm\", refine = {times}"));
        let words = ["refining 10 times makes more than 4000000 cells of 8", "refine less often"];
        refusal(&refined("10"), At::Scene("mesh ="), &words);
        refusal(
            &refined("1000000000"),
            At::Scene("mesh ="),
            &["refining 1000000000 times makes more than", "refine less often"],
        );
        refusal(&refined("-1"), At::Scene("mesh ="), &["`mesh.refine`: must be a whole number of at least 0"]);
        refusal(&refined("1, curves = \"round\""), At::Scene("mesh ="), &["`mesh.curves`", "known: kept, straight"]);
    }
}

mod substructures {
    use super::*;

    /// A plate of 8 x 6 built-in cells.
    fn divided(substructures: &str) -> Case {
        let scene = format!(
            "title = \"t\"\nanalysis = \"static\"\nsubstructures = {{ {substructures} }}\n\
             mesh = {{ rectangle = [\"40 mm\", \"30 mm\"], cells = [8, 6] }}\n\
             materials.m = {{ library = \"AS4/3502\" }}\nlaminate = {{ plies = \"[0/90]s\", material = \"m\", ply_thickness = \"0.25 mm\" }}\n\
             support = [{{ group = \"x-min\", at = \"all\", fix = [\"U10\", \"U20\", \"U30\"] }}]\nload = [{{ pressure = \"1 MPa\" }}]\n"
        );
        strip().text(&scene)
    }

    #[track_caller]
    fn refused(case: &Case, words: &[&str]) {
        refusal(case, At::Scene("substructures ="), words);
    }

    #[test]
    fn group_that_is_none() {
        refused(&divided("groups = [\"plat\"]"), &["the mesh has no group `plat`", "did you mean `plate`"]);
        refused(&divided("groups = [\"x-max\"]"), &["the group has no cells", "physical surface"]);
    }

    #[test]
    fn groups_with_a_common_cell() {
        refused(
            &divided("groups = [\"plate\", \"plate\"]"),
            &["cell 1 belongs to `plate` too", "without common cells"],
        );
    }

    #[test]
    fn blocks_that_do_not_divide_the_mesh() {
        refused(&divided("cells = [4, 4]"), &["blocks of 4 x 4 cells do not divide a mesh of 8 x 6", "divisors"]);
        refused(&divided("cells = [0, 1]"), &["must be a whole number of at least 1"]);
        refused(&divided("cells = [4]"), &["has 1 values", "give two"]);
    }

    #[test]
    fn blocks_of_a_mesh_of_gmsh() {
        let case = with_keys(strip(), "substructures = { cells = [2, 2] }");
        refused(&case, &["blocks of cells need a built-in mesh", "groups = ["]);
    }

    #[test]
    fn parts_of_no_kind_and_of_two() {
        refused(&divided("masters = []"), &["the substructures are not named", "give `groups`"]);
        refused(&divided("cells = [2, 2], groups = [\"plate\"]"), &["cannot be combined with `groups`"]);
    }

    #[test]
    fn masters_that_are_none() {
        let masters = "masters = [{ group = \"plate\", at = \"top\", dofs = [\"U30\"] }], cells = [4, 3]";
        refused(&divided(&masters.replace("plate", "plat")), &["the mesh has no group `plat`"]);
        refused(&divided(&masters.replace("U30", "W")), &["`W`"]);
        let shell = divided(&masters.replace("U30", "U31")).scene("mesh =", "element = { kind = \"hex20\" }\nmesh =");
        refused(&shell, &["`plate` has none of these unknowns", "the element has none of the unknowns"]);
    }
}
