//! What a scene says and nothing would follow from: refused, or warned of with a number.

use crate::support::{Case, fem, plate, strip};

/// A plate of solids, whose unknowns are displacements alone.
fn case(support_and_load: &str) -> Case {
    plate().text(&format!(
        r#"
title = "overlooked"
analysis = "static"
mesh = {{ rectangle = ["40 mm", "20 mm"], cells = [4, 2] }}
element = {{ kind = "hex20" }}
materials.tape = {{ library = "AS4/3502" }}
laminate = {{ plies = "[0/90]s", material = "tape", ply_thickness = "0.25 mm", layers = [2, 2] }}
output = {{ plots = false }}
{support_and_load}
"#
    ))
}

/// What `fem check` says, without line breaks.
fn said(case: &Case, status: i32) -> String {
    let scene = case.write();
    let done = fem(case.folder(), &["check", scene]);
    assert_eq!(done.status, status, "{done:?}");
    let all = format!("{} {}", done.stdout, done.stderr);
    all.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

#[track_caller]
fn holds(said: &str, words: &[&str]) {
    for words in words {
        assert!(said.contains(words), "{words:?} is not in {said}");
    }
}

const CLAMPED: &str = r#"support = [{ group = "x-min", at = "all", fix = ["U10", "U20", "U30"] }]"#;

#[test]
fn supports_of_unknowns_that_the_element_lacks() {
    let slopes = case(
        r#"support = [{ group = "x-min", at = "mid-plane", fix = ["U10", "U20", "U30", "U13", "U31"] },
            { group = "x-max", at = "mid-plane", fix = ["U30"] }]
load = [{ pressure = "1 kPa" }]"#,
    );
    holds(&said(&slopes, 0), &["2 of 5 unknowns in the support of `x-min` are not of this element", "U13, U31"]);
    assert!(
        !said(&case(&format!("{CLAMPED}\nload = [{{ pressure = \"1 kPa\" }}]")), 0).contains("are not of this element")
    );
    let tied = |couple: &str| case(&format!("{CLAMPED}\nload = [{{ pressure = \"1 kPa\" }}]\ncouple = [{couple}]"));
    holds(
        &said(&tied(r#"{ group = "x-max", at = "top", dofs = ["U31"] }"#), 1),
        &["the couple of `x-max` ties nothing", "unknowns that the element has"],
    );
    holds(
        &said(&tied(r#"{ group = "x-max", at = "top", dofs = ["U30", "U31"] }"#), 0),
        &["1 of 2 unknowns in the couple of `x-max`", "U31"],
    );
}

#[test]
fn loads_on_what_is_held() {
    let loaded = |load: &str| case(&format!("{CLAMPED}\nload = [{load}]"));
    let on_edge = r#"{ force_per_length = ["0 N/mm", "0 N/mm", "-1 N/mm"], group = "x-min" }"#;
    let held = loaded(on_edge);
    holds(&said(&held, 1), &["the supports take all of the load", "force_per_length"]);
    // One of two loads, an edge of which a part is held, and a load that is nothing at all.
    for load in [
        &*format!("{on_edge}, {{ pressure = \"1 kPa\" }}"),
        r#"{ force_per_length = ["0 N/mm", "0 N/mm", "-1 N/mm"], group = "y-min" }"#,
        r#"{ pressure = "0 Pa" }"#,
    ] {
        said(&loaded(load), 0);
    }
}

/// A quarter of a plate, struck at the corner that is its middle, by a node; and a cantilever struck at its tip.
#[test]
fn parts_of_a_plate_made_by_hand() {
    let struck = |support: &str| {
        let case = plate().text(&format!(
            r#"
title = "a quarter"
mesh = {{ rectangle = ["20 mm", "20 mm"], cells = [4, 4] }}
element = {{ kind = "mitc4" }}
materials.tape = {{ library = "AS4/3502" }}
laminate = {{ plies = "[0/90]s", material = "tape", ply_thickness = "0.25 mm", layers = [4] }}
support = [{support}]
impactor = {{ mass = "1 kg", velocity = "1 m/s", at = {{ x = "0 mm", y = "0 mm" }}, load = "node" }}
contact = {{ law = "hertz", k = "1e4 N/mm^1.5" }}
march = {{ integrator = "newmark", step = "1 us", end = "0.1 ms" }}
effects = {{ damage = "off" }}
output = {{ plots = false }}
"#
        ));
        said(&case, 0)
    };
    let far = r#"{ group = "x-max", at = "mid-plane", fix = ["U10", "U20", "U30", "U13", "U23"] }"#;
    let x = r#"{ group = "x-min", at = "mid-plane", fix = ["U10", "U13"] }"#;
    let y = r#"{ group = "y-min", at = "mid-plane", fix = ["U20", "U23"] }"#;
    let quarter = struck(&format!("{far}, {x}, {y}"));
    holds(&quarter, &["hold U10 and U20 as in a quarter of a symmetric plate", "must have a quarter of the mass"]);
    holds(&struck(&format!("{far}, {x}")), &["hold U10 as in a half of a symmetric plate"]);
    assert!(!struck(far).contains("symmetric plate"));
}

/// Both sides that meet in a corner hold it along one direction each.
#[test]
fn supports_in_all_but_the_same_axes() {
    let beside = |fix: &str, axes: &str| {
        let text = case(&format!(
            r#"support = [{{ group = "x-max", at = "all", fix = ["U10", "U20", "U30"] }},
            {{ group = "y-min", at = "all", fix = ["U10"], axes = "30 deg" }},
            {{ group = "x-min", at = "all", fix = {fix}, axes = "{axes} deg" }}]
load = [{{ pressure = "1 kPa" }}]"#
        ));
        said(&text, 0)
    };
    let words =
        ["the supports of `y-min` and `x-min` hold", "at (0.0000, 0.0000) mm", "in both directions", "the same `axes`"];
    for (fix, axes, off) in [
        (r#"["U10"]"#, "30.00001", "1.00e-5 degrees"),
        (r#"["U10", "U30"]"#, "30.9", "9.00e-1 degrees"),
        (r#"["U10"]"#, "-150.01", "1.00e-2 degrees"),
        (r#"["U20"]"#, "-60.01", "1.00e-2 degrees"),
    ] {
        let said = beside(fix, axes);
        holds(&said, &words);
        holds(&said, &[off]);
    }
    for (fix, axes) in [
        (r#"["U10"]"#, "30"),
        (r#"["U10"]"#, "30.000001"),
        (r#"["U10"]"#, "35"),
        (r#"["U20"]"#, "30.5"),
        (r#"["U10", "U20"]"#, "30.5"),
        (r#"["U30"]"#, "30.5"),
    ] {
        assert!(!beside(fix, axes).contains("in both directions"), "{fix} {axes}");
    }
}

/// A quarter made by hand: beyond its cut edges windows have no cells.
#[test]
fn windows_that_are_cut_off_at_a_plane_of_symmetry() {
    let with = |window: &str, cut: &str| {
        let text = case(&format!(
            r#"failure = {{ criteria = ["hashin-report"], window = {window} }}
support = [{{ group = "x-min", at = "all", fix = ["U10", "U20", "U30"] }},
            {{ group = "x-max", at = "all", fix = {cut} }}]
load = [{{ pressure = "1 kPa" }}]"#
        ));
        said(&text, 0)
    };
    let quarter = r#"["U10"]"#;
    holds(&with("\"25 mm\"", quarter), &["at 2 cells near an edge", "of 25 mm is cut off", "window = \"element\""]);
    for (window, cut) in [("\"element\"", quarter), ("\"9 mm\"", quarter), ("\"25 mm\"", r#"["U10", "U30"]"#)] {
        assert!(!with(window, cut).contains("is cut off"), "{window} {cut}");
    }
}

/// One index for all of the plate is none of any place.
#[test]
fn a_window_larger_than_the_plate() {
    let text = case(
        r#"failure = { criteria = ["hashin-report"], window = "200 mm" }
support = [{ group = "x-min", at = "all", fix = ["U10", "U20", "U30"] }]
load = [{ pressure = "1 kPa" }]"#,
    );
    holds(&said(&text, 1), &["`failure.window` of 200 mm is wider than the plate is long", "\"element\""]);
}

/// The axes of a plate say nothing of its plies.
#[test]
fn interfaces_stronger_along_x_than_along_y() {
    let with = |moduli: &str, s23: &str| {
        let text = case(&format!(
            r#"materials.resin = {{ density = "1.3 g/cm^3", {moduli}, Zt = "60 MPa", S13 = "90 MPa", S23 = "{s23}" }}
failure = {{ criteria = ["quadratic-stress"], window = "element" }}
support = [{{ group = "x-min", at = "all", fix = ["U10", "U20", "U30"] }}]
load = [{{ pressure = "1 kPa" }}]"#
        ));
        said(&text.scene("layers = [2, 2] }", "layers = [2, 2], interface = \"resin\" }"), 0)
    };
    let isotropic = r#"e = "4 GPa", nu = 0.3"#;
    let weak = with(isotropic, "60 MPa");
    holds(&weak, &["`quadratic-stress` judges", "S13 of 90 MPa and an S23 of 60 MPa", "give both the same"]);
    assert!(!with(isotropic, "90 MPa").contains("hang on how the plate lies"));
    // Nor do they know its moduli; those along z are the same for all of them.
    let tape = |e2: &str, g23: &str| {
        format!(
            r#"e1 = "9 GPa", e2 = "{e2}", e3 = "5 GPa", nu12 = 0.3, nu13 = 0.3, nu23 = 0.3, g12 = "3 GPa", g13 = "3 GPa", g23 = "{g23}""#
        )
    };
    for (e2, g23) in [("5 GPa", "3 GPa"), ("9 GPa", "2 GPa")] {
        holds(&with(&tape(e2, g23), "90 MPa"), &["whose moduli along x and y of the plate differ", "name a resin"]);
    }
    assert!(!with(&tape("9 GPa", "3 GPa"), "90 MPa").contains("moduli along x"));
}

/// Loads at rest have no history.
#[test]
fn what_is_written_over_time() {
    for key in ["history_every = \"1 us\"", "maps = true"] {
        let text = case(
            r#"support = [{ group = "x-min", at = "all", fix = ["U10", "U20", "U30"] }]
load = [{ pressure = "1 kPa" }]"#,
        )
        .scene("plots = false", &format!("plots = false, {key}"));
        let name = key.split(' ').next().unwrap();
        holds(&said(&text, 1), &[&format!("output.{name}"), "needs an impact"]);
    }
    let looks = case(&format!("{CLAMPED}\nload = [{{ pressure = \"1 kPa\" }}]\nfailure = {{ every = \"1 us\" }}"));
    holds(&said(&looks, 1), &["`failure.every`: needs an impact"]);
}

/// Linear theory lets a cantilever deflect by any multiple of its length.
#[test]
fn slopes_that_are_not_small() {
    let bent = |load: f64, more: &str| {
        let load =
            format!("load = [{{ force_per_length = [\"0 N/mm\", \"0 N/mm\", \"{load} N/mm\"], group = \"x-max\" }}]");
        let case = case(&format!("{CLAMPED}\n{load}\n{more}"));
        case.fem("run", &["--out", "out"]).good();
        let summary = case.summary("out");
        let warned = summary["warnings"].to_string().contains("slopes are not small");
        (summary["largest_deflection"]["w_m"].as_f64().unwrap() / 40e-3, warned)
    };
    let (one, warned) = bent(1e-3, "");
    assert!(!warned);
    for (share, expected) in [(0.14, false), (0.16, true), (5.0, true)] {
        let (w, warned) = bent(1e-3 * share / one, "");
        assert!((w / share - 1.0).abs() < 1e-6 && warned == expected, "{share}: {w} {warned}");
    }
    let (w, warned) = bent(1e-3 * 0.4 / one, "effects = { membrane = \"on\" }");
    assert!((0.2..0.39).contains(&w) && !warned, "{w}");
}

/// A shell has one layer without being asked, and a force on a circle says what it lacks.
#[test]
fn what_is_left_out() {
    let with = |circle: &str| {
        case(&format!(
            r#"support = [{{ group = "x-min", kind = "clamped" }}]
load = [{{ force = "10 N", at = {{ x = "20 mm", y = "10 mm" }}{circle} }}]"#
        ))
        .scene("hex20", "mitc4")
        .scene(", layers = [2, 2]", "")
    };
    assert!(said(&with(", patch_radius = \"3 mm\""), 0).contains("model"));
    holds(&said(&with(""), 1), &["`load[0].patch_radius` is missing", "patch_radius = \"3 mm\""]);
}

/// The force across of a profile is that of its shear: of a cantilever with a force at its end, that force, whatever the element.
#[test]
fn forces_across_are_those_of_statics() {
    for element in ["hex20", "hermite-prism", "mitc4"] {
        let case = case(
            "support = [{ group = \"x-min\", kind = \"clamped\" }]\n\
             load = [{ force_per_length = [\"0 N/mm\", \"0 N/mm\", \"0.5 N/mm\"], group = \"x-max\" }]\n\
             profile = [{ name = \"p\", at = { x = \"22.5 mm\", y = \"10 mm\" } }, { name = \"q\", at = { x = \"20 mm\", y = \"10 mm\" } }]",
        )
        .scene("cells = [4, 2]", "cells = [16, 4]")
        .scene("library = \"AS4/3502\"", "e = \"70 GPa\", nu = 0.0, density = \"2.7 g/cm^3\"")
        .scene("plies = \"[0/90]s\"", "plies = \"[0_4]\"")
        .scene("layers = [2, 2]", if element == "mitc4" { "layers = 1" } else { "layers = [2, 2]" })
        .scene("kind = \"hex20\"", &format!("kind = \"{element}\""));
        case.fem("run", &["--out", "out"]).good();
        for profile in case.summary("out")["profiles"].as_array().unwrap() {
            let across = profile["Q_N_per_m"][0].as_f64().unwrap();
            assert!((across.abs() / 500.0 - 1.0).abs() < 0.02, "{element}: {profile:#}");
        }
    }
}

/// A shell is held by displacements in its plane where it has nodes, and turned by those elsewhere.
#[test]
fn displacements_at_heights_where_a_shell_has_no_nodes() {
    let shell = |more: &str| {
        let groups = "cells = [4, 2], groups = { tip = { x = \"40 mm\", y = \"0 mm\" } }";
        let shell =
            case(more).scene("hex20", "mitc4").scene("layers = [2, 2]", "layers = 1").scene("cells = [4, 2]", groups);
        move |status| said(&shell, status)
    };
    let clamped = r#"support = [{ group = "x-min", kind = "clamped" }"#;
    let pressed = "load = [{ pressure = \"1 kPa\" }]";
    for more in [
        format!("{clamped}, {{ group = \"x-max\", kind = \"hinged\", at = \"bottom\" }}]\n{pressed}"),
        format!("{clamped}, {{ group = \"x-max\", fix = [\"U10\"], at = \"top\" }}]\n{pressed}"),
        format!("{clamped}]\n{pressed}\ncouple = [{{ group = \"x-max\", at = \"bottom\", dofs = [\"U10\"] }}]"),
        format!(
            "{clamped}]\n{pressed}\nequation = [{{ terms = [{{ group = \"tip\", at = \"top\", dof = \"U10\", factor = 1.0 }}, \
             {{ group = \"tip\", at = \"bottom\", dof = \"U10\", factor = -1.0 }}] }}]"
        ),
        format!("{clamped}]\nload = [{{ force = [\"1 N\", \"0 N\", \"0 N\"], group = \"tip\", at = \"top\" }}]"),
    ] {
        let said = shell(&more)(1);
        holds(
            &said,
            &["`mitc4` has nodes in its mid-plane alone, where U10 is not what it is at", "at = \"mid-plane\""],
        );
    }
    for support in [
        r#"{ group = "x-max", kind = "hinged" }"#,
        r#"{ group = "x-max", kind = "simply-supported" }"#,
        r#"{ group = "x-max", kind = "roller", at = "bottom" }"#,
        r#"{ group = "x-max", fix = ["U10", "U13"], at = "all" }"#,
        r#"{ group = "x-max", fix = ["U10"], at = "all" }, { group = "x-max", fix = ["U13"], at = "all" }"#,
        r#"{ group = "x-max", fix = ["U30"], at = "top" }"#,
    ] {
        assert!(!shell(&format!("{clamped}, {support}]\n{pressed}"))(0).contains("may turn"), "{support}");
    }
    // At all heights there is one node.
    for more in [
        format!("{clamped}, {{ group = \"x-max\", fix = [\"U30\", \"U10\"], at = \"all\" }}]\n{pressed}"),
        format!("{clamped}]\n{pressed}\ncouple = [{{ group = \"x-max\", at = \"all\", dofs = [\"U10\"] }}]"),
    ] {
        holds(
            &shell(&more)(0),
            &["of `x-max` at all heights holds U10 there, and the section may turn", "hold U13 as well"],
        );
    }
}

#[test]
fn damage_without_criteria() {
    let loaded = |more: &str| said(&case(&format!("{CLAMPED}\nload = [{{ pressure = \"1 kPa\" }}]\n{more}")), 0);
    holds(&loaded("effects = { damage = \"onset\" }"), &["no criterion is named: damage is not looked for"]);
    for more in ["", "effects = { damage = \"onset\" }\nfailure = { criteria = [\"hashin-1980\"] }"] {
        assert!(!loaded(more).contains("not looked for"), "{more}");
    }
}

/// Elements with derivatives at their nodes keep strains continuous where they should jump: at a line that is clamped.
#[test]
fn strains_that_jump() {
    let checked = |element: &str, support: &str| {
        let groups =
            "cells = [4, 2], groups = { a = { x = [\"0 mm\", \"20 mm\"] }, l = { x = [\"20 mm\", \"20 mm\"] } }";
        let text = format!("support = [{{ {support}, kind = \"clamped\" }}]\nload = [{{ pressure = \"1 kPa\" }}]");
        said(&case(&text).scene("hex20", element).scene("cells = [4, 2]", groups), 0)
    };
    let line = "group = \"l\"";
    holds(&checked("hermite-prism", line), &["`l`, clamped, lies inside the plate, where strains jump", "\"hex20\""]);
    assert!(!checked("hex20", line).contains("strains jump"));
    // Cells do not, for they are left out.
    assert!(!checked("hermite-prism", "group = \"a\"").contains("strains jump"));
}

/// A group that ends between nodes is smaller than it was asked to be, and another one on other cells.
#[test]
fn groups_that_end_within_cells() {
    let strip = |to: &str| {
        let load = format!("{CLAMPED}\nload = [{{ pressure = \"1 kPa\", group = \"s\" }}]");
        let groups = format!("cells = [4, 2], groups = {{ s = {{ x = [\"0 mm\", \"{to}\"] }} }}");
        said(&case(&load).scene("cells = [4, 2]", &groups), 0)
    };
    holds(&strip("26 mm"), &["the group `s` is to reach from x = 0 to 26 mm, and reaches from 0 to 20 mm"]);
    holds(&strip("19.9999 mm"), &["to 19.9999 mm, and reaches from 0 to 10 mm"]);
    for to in ["20 mm", "20.01 mm", "50 mm"] {
        assert!(!strip(to).contains("is to reach"), "{to}");
    }
}

/// Between coupled nodes an edge of cubic elements moves as it does between fixed ones.
#[test]
fn couples_that_hold_an_edge_at_its_nodes_alone() {
    let softer = |more: &str| {
        let text = case(&format!("{more}\nload = [{{ pressure = \"1 kPa\" }}]"));
        let said = text.scene("hex20", "hermite-prism").fem("run", &["--out", "out"]).good().stdout;
        said.split_once(" % softer").and_then(|(before, _)| before.rsplit(' ').next().map(str::to_owned))
    };
    let clamped = r#"{ group = "x-min", kind = "clamped" }"#;
    let fixed = softer(&format!("support = [{clamped}, {{ group = \"x-max\", at = \"all\", fix = [\"U10\"] }}]"));
    let coupled = "couple = [{ group = \"x-max\", at = \"all\", dofs = [\"U10\"] }]";
    assert!(fixed.is_some());
    assert_eq!(softer(&format!("support = [{clamped}]\n{coupled}")), fixed);
    let clean =
        format!("support = [{clamped}, {{ group = \"x-max\", at = \"all\", fix = [\"U12\", \"U13\"] }}]\n{coupled}");
    assert_eq!(softer(&clean), None);
}

#[test]
fn strengths_in_another_unit() {
    let weak = case(&format!("{CLAMPED}\nload = [{{ pressure = \"1 kPa\" }}]"));
    let weak = weak.scene("library = \"AS4/3502\"", "library = \"AS4/3502\", Yt = \"60 mPa\"");
    holds(&said(&weak, 0), &["material `tape`: Yt = 0.06 Pa is none of a solid"]);
}

#[test]
fn an_expansion_without_its_e_6() {
    let expands = |alpha: &str| {
        let library = format!("library = \"AS4/3502\", alpha1 = \"-0.5e-6 1/K\", alpha2 = \"{alpha} 1/K\"");
        said(
            &case(&format!("{CLAMPED}\nload = [{{ pressure = \"1 kPa\" }}]")).scene("library = \"AS4/3502\"", &library),
            0,
        )
    };
    holds(&expands("28"), &["material `tape`: a thermal expansion of 28 1/K is none of a solid"]);
    assert!(!expands("28e-6").contains("expansion"));
}

/// Plies of one angle are one thick ply where they are of one material.
#[test]
fn one_material_under_two_names() {
    let named = |plies: &str, other: &str| {
        let tapes = format!(
            "materials.tape = {{ library = \"AS4/3502\" }}\nmaterials.other = {{ library = \"AS4/3502\"{other} }}"
        );
        let clamped = case(&format!("{CLAMPED}\nload = [{{ pressure = \"1 kPa\" }}]"));
        let clamped = clamped.scene("materials.tape = { library = \"AS4/3502\" }", &tapes);
        let plies = format!("plies = \"{plies}\", ply = {{ b = {{ material = \"other\" }} }}");
        said(&clamped.scene("plies = \"[0/90]s\"", &plies), 0)
    };
    const SAME: &str = "materials `tape` and `other` have the same constants";
    holds(&named("[0/90/90{b}/0]", ""), &[SAME, "give both one name"]);
    const YIELDS: &str = ", law = { name = \"hahn-tsai\", alpha = \"2e-8 1/MPa^3\" }";
    for (plies, other) in [("[0/90/0{b}/90]", ""), ("[0/90/90{b}/0]", ", Yt = \"50 MPa\""), ("[0/90/90{b}/0]", YIELDS)]
    {
        assert!(!named(plies, other).contains(SAME), "{plies} {other}");
    }
}

/// A clamped plate that is cooled in its frame, or pressed along an edge, computed for small displacements: what is left out, against the deflection
/// that a plate without that has under a small pressure.
#[test]
fn stresses_in_the_plane_of_a_linear_plate() {
    let framed = |load: &str, cure: &str| {
        format!(
            "title = 'framed'\nanalysis = 'static'\nmesh = {{ rectangle = ['100 mm', '100 mm'], cells = [16, 16] }}\nelement = {{ kind = 'mitc4' }}\n\
             laminate = {{ plies = '[0]', material = 'al', ply_thickness = '1 mm' }}\noutput = {{ plots = false }}\n\
             support = [{}]\n{load}\n{cure}\n\
             [materials.al]\ne = '70 GPa'\nnu = 0.3\nalpha = '23e-6 1/K'\n",
            ["x-min", "x-max", "y-min", "y-max"]
                .map(|edge| format!("{{ group = '{edge}', kind = 'clamped' }}"))
                .join(", ")
        )
    };
    const PRESSED: &str = "load = [{ pressure = '10 Pa' }]";
    let share = |text: &str| {
        let case = plate().text(text);
        let deflection = |set: &str| {
            case.fem("run", &["--out", "out", "--set", set]).good();
            let summary = case.summary("out");
            let said = summary["warnings"].to_string();
            (summary["largest_deflection"]["w_m"].as_f64().unwrap(), said)
        };
        let ((linear, said), (true_one, stiffened)) =
            (deflection("effects.membrane=off"), deflection("effects.membrane=on"));
        assert!(!stiffened.contains("stiffness against this deflection"), "{stiffened}");
        let percent = said.split("would ").nth(1).map(|rest| {
            let sign = if rest.starts_with("take") { 1.0 } else { -1.0 };
            sign * rest.split(" some ").nth(1).unwrap().split(' ').next().unwrap().parse::<f64>().unwrap()
        });
        (percent, 100.0 * (1.0 - linear / true_one))
    };
    for by in [-20, -5, 5] {
        let (said, left_out) = share(&framed(PRESSED, &format!("effects = {{ cure = '{by} K' }}")));
        let said = said.unwrap_or_default();
        assert!((said - left_out).abs() < 0.1 * left_out.abs(), "{by} K: {said} and {left_out}");
    }
    assert_eq!(share(&framed(PRESSED, "")).0, None);
    // Solids, which loads shorten by far more than they deflect.
    let along = "{ group = 'x-min', force_per_length = ['10 N/mm', '0 N/mm', '0 N/mm'] }, \
                 { group = 'x-max', force_per_length = ['-10 N/mm', '0 N/mm', '0 N/mm'] }";
    let solid =
        framed(&format!("load = [{{ pressure = '10 Pa' }}, {along}]"), "").replace("'mitc4'", "'hermite-prism'");
    let solid = solid
        .replace("'clamped'", "'simply-supported'")
        .replace("support = [", "support = [{ restrain = 'rigid-motions' }, ");
    let (said, left_out) = share(&solid.replace("[16, 16]", "[8, 8]"));
    let said = said.unwrap_or_default();
    assert!((said - left_out).abs() < 0.1 * left_out, "{said} and {left_out}");
    // Shear, which adds to the stiffness along one diagonal what it takes along the other: in second order alone.
    let sheared = |load: &str, n: f64| {
        let along = |edge: &str, along: usize, n: f64| {
            let mut force = [0.0; 3];
            force[along] = n;
            format!("{{ group = '{edge}', force_per_length = {:?} }}", force.map(|f| format!("{f} N/mm")))
        };
        let edges = [along("x-min", 1, -n), along("x-max", 1, n), along("y-min", 0, -n), along("y-max", 0, n)];
        let text = framed(&format!("load = [{load} {}]", edges.join(", ")), "");
        text.replace("'clamped'", "'roller'").replace("support = [", "support = [{ restrain = 'rigid-motions' }, ")
    };
    for n in [20.0, 30.0] {
        let (said, left_out) = share(&sheared("{ pressure = '10 Pa' },", n));
        let said = said.unwrap_or_default();
        assert!((said - left_out).abs() < 0.1 * left_out, "{n} N/mm: {said} and {left_out}");
        // By itself it deflects nothing.
        assert_eq!(share(&sheared("", n)).0, None);
    }
    // Nor does weight along the plate, for which a solid swells and shrinks.
    let hung = framed("load = [{ gravity = ['9.81 km/s^2', '0 m/s^2', '0 m/s^2'] }]", "");
    let hung = hung.replace("'mitc4'", "'hermite-prism'").replace("[16, 16]", "[4, 4]") + "density = '2.7 g/cm^3'\n";
    assert_eq!(share(&hung).0, None);
    // Plies that lie unsymmetrically deflect as they are pulled.
    let pulled = framed(
        "load = [{ group = 'x-min', force_per_length = ['-0.5 N/mm', '0 N/mm', '0 N/mm'] }, { group = 'x-max', force_per_length = ['0.5 N/mm', '0 N/mm', '0 N/mm'] }]",
        "",
    );
    let pulled = pulled
        .replace("'[0]'", "'[0/90]'")
        .replace("'1 mm'", "'0.5 mm'")
        .replace("e = '70 GPa'\nnu = 0.3\nalpha = '23e-6 1/K'", "library = 'AS4/3502'")
        .replace(
            "{ group = 'y-min', kind = 'clamped' }, { group = 'y-max', kind = 'clamped' }",
            "{ restrain = 'rigid-motions' }",
        )
        .replace("'clamped'", "'roller'");
    let (said, left_out) = share(&pulled);
    let said = said.unwrap_or_default();
    assert!((said - left_out).abs() < 0.1 * left_out.abs(), "{said} and {left_out}");
    // Heated without a load it does not deflect, and yet it buckles: at 5.30 π² D/a² (Timoshenko and Gere), in these cells some 2 % above.
    let said = plate().text(&framed("", "effects = { cure = '40 K' }")).fem("run", &["--out", "out"]).good().stdout;
    let (pressed, critical) =
        (70e6 * 23e-6 * 40.0 / 0.7, 5.30 * std::f64::consts::PI.powi(2) * 70.0 / (12.0 * 0.91) / 0.01);
    let part: f64 = said.split(" of them buckle it").next().unwrap().rsplit(' ').next().unwrap().parse().unwrap();
    assert!((0.99..1.05).contains(&(part * pressed / critical)), "{part} and {}", critical / pressed);
}

/// Damping that stops the plate like honey, and cooling that no ply survives.
#[test]
fn sizes_of_effects_that_no_laminate_has() {
    let cautions = |damping: &str| {
        let case = strip().scene("mass = \"2.49 kg\"", "mass = \"0.1 g\"");
        let effects = format!("[effects]\ndamping = {{ {damping} }}\n");
        case.append(&effects).fem("run", &["--out", "out"]).good().stdout
    };
    holds(
        &cautions("mass = \"1e6 1/s\""),
        &["`effects.damping` damps the lowest mode of the plate by", "times what is critical"],
    );
    holds(&cautions("stiffness = \"1 s\""), &["`effects.damping` damps the lowest mode of the plate by"]);
    for small in ["mass = \"30 1/s\"", "stiffness = \"2e-8 s\"", "ratio = 0.02"] {
        assert!(!cautions(small).contains("`effects.damping`"), "{small}");
    }
    let cooled = |by: &str| {
        let expands = "materials.tape = { library = \"AS4/3502\", alpha1 = \"-0.5e-6 1/K\", alpha2 = \"28e-6 1/K\" }";
        case(&format!("{CLAMPED}\neffects = {{ cure = \"{by}\" }}"))
            .scene("materials.tape = { library = \"AS4/3502\" }", expands)
    };
    holds(&said(&cooled("-1e6 K"), 1), &["no ply keeps its stiffness over a change of -1000000 K", "at most 3000 K"]);
    said(&cooled("-150 K"), 0);
}

/// What acts on nodes that are left out because they are clamped acts on nothing.
#[test]
fn loads_and_terms_on_clamped_cells() {
    let clamped = |more: &str| {
        let groups = "cells = [4, 2], groups = { a = { x = [\"0 mm\", \"20 mm\"] }, p = { x = [\"0 mm\", \"0 mm\"], y = [\"10 mm\", \"10 mm\"] } }";
        let text = format!("support = [{{ group = \"a\", kind = \"clamped\" }}]\n{more}");
        case(&text).scene("cells = [4, 2]", groups)
    };
    let force = "load = [{ force = [\"0 N\", \"0 N\", \"1 N\"], group = \"p\", at = \"top\" }]";
    holds(&said(&clamped(force), 1), &["a force acts at one node, and `p` has none that can move"]);
    let along = "load = [{ force_per_length = [\"0 N/mm\", \"0 N/mm\", \"1 N/mm\"], group = \"x-min\" }]";
    holds(&said(&clamped(along), 1), &["the group has no edges that can move"]);
    let pressure = "load = [{ pressure = \"1 kPa\", group = \"a\" }]";
    holds(&said(&clamped(pressure), 1), &["the group has no cells that can move"]);
    holds(&said(&clamped("load = [{ pressure = \"1 kPa\" }]"), 0), &["left out 4 cells of `a`, which do not move"]);
}
