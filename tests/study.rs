//! `fem study`: what accuracy costs, counted from a reference that the study proves.

use crate::support::{Case, coming_apart, fem, root, strip};
use fem::core::plugin::Dimension;
use fem::io::units::parse_as;
use std::collections::{BTreeMap, BTreeSet};

/// The rows of study.csv by axis and setting, values by column.
pub(crate) fn rows(case: &Case, folder: &str) -> BTreeMap<(String, String), BTreeMap<String, String>> {
    let (header, rows) = case.table(&format!("{folder}/study.csv"));
    let by_column = |row: Vec<String>| header.iter().cloned().zip(row).collect::<BTreeMap<_, _>>();
    let key = |row: &BTreeMap<String, String>| (row["axis"].clone(), row["setting"].clone());
    rows.into_iter().map(by_column).map(|row| (key(&row), row)).collect()
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column}: {row:?}"))
}

/// A cantilever of 8 cells, marched for a short time.
fn short() -> Case {
    strip().scene("end = \"20 us\"", "end = \"4 us\"").append("[reduction]\nmethod = \"ritz\"\nvectors = 20\n")
}

#[test]
fn reductions_are_judged_by_the_largest() {
    let case = short();
    let done = case.fem("study", &["--axis", "reductions", "--out", "study"]).good();
    let rows = rows(&case, "study");
    let error = |setting: &str| number(&rows[&("reductions".into(), setting.into())], "force-history of its axis");
    // The full model at the step of the scene, and the same space found in another way.
    assert!(error("none") < 5e-3, "{}", error("none"));
    assert!(error("ritz krylov 80") < error("ritz krylov 20"), "{rows:?}");
    let refused = &rows[&("reductions".into(), "guyan 40".into())]["refused"];
    assert!(refused.contains("governors are asked for, but the model offers only"), "{refused}");
    assert!(done.stdout.contains("will run, about"), "{done:#?}");
}

#[test]
fn integrators_are_tried_up_to_their_limits() {
    let case = short();
    case.fem("study", &["--axis", "integrators", "--out", "study"]).good();
    let rows = rows(&case, "study");
    let of = |label: &str| &rows[&("integrators".into(), label.into())];
    let at_limit = number(of("rk4 at its limit"), "step_s");
    for ((_, label), row) in rows.iter().filter(|((axis, label), _)| axis == "integrators" && label.starts_with("rk4"))
    {
        let Ok(step) = parse_as(&label[4..], Dimension::TIME) else { continue };
        assert_eq!(row["refused"].contains("stability limit"), step > at_limit, "{row:?}");
    }
    let limited = rows.keys().filter(|(_, label)| label.ends_with("at its limit")).map(|(_, label)| label.as_str());
    let all = ["central-difference", "rk1", "rk2", "rk3", "rk4"].map(|name| format!("{name} at its limit"));
    assert!(limited.eq(all.iter().map(String::as_str)), "{rows:?}");
}

/// The length of whole steps alone would change nothing, and a study that says so would call the step exact.
#[test]
fn the_tolerance_of_divided_steps_follows_them() {
    let march = "[march]\nintegrator = \"energy-conserving\"\nstep = \"1 us\"\ntolerance = 1e-3";
    let case = short().scene("[march]", march).scene("end = \"4 us\"", "end = \"40 us\"");
    case.fem("study", &["--axis", "step", "--out", "study"]).good();
    let rows = rows(&case, "study");
    let error = |setting: &str| number(&rows[&("joint".into(), setting.into())], "force-history error");
    let errors = ["4 us to 2e-2", "2 us to 4e-3", "1 us to 1e-3", "0.5 us to 3e-4"].map(error);
    assert!(errors.windows(2).all(|pair| pair[1] < 0.7 * pair[0]) && errors[3] > 0.0, "{errors:?}");
}

/// Two studies differ in their seconds alone, and one that goes on runs nothing twice.
#[test]
fn studies_of_one_scene_are_equal() {
    let case = short();
    let arguments = |out| ["--axis", "mesh,reduction,step", "--out", out];
    for out in ["one", "two"] {
        case.fem("study", &arguments(out)).good();
    }
    let stable = |out: &str| {
        let mut rows = rows(&case, out);
        let mut taken = 0.0;
        for row in rows.values_mut() {
            taken += row
                .iter()
                .filter(|(column, _)| column.ends_with("_cpu_s"))
                .filter_map(|(_, s)| s.parse::<f64>().ok())
                .sum::<f64>();
            row.retain(|column, _| !column.ends_with("_cpu_s") && column != "peak_memory_MB");
        }
        (rows, taken)
    };
    let (one, two) = (stable("one"), stable("two"));
    assert_eq!(one.0, two.0);
    // The mesh leaves most: it is climbed to its end, and the step no further than to see that it leaves little.
    let ran = |axis: &str, level: &str| one.0.contains_key(&(axis.to_owned(), level.to_owned()));
    assert!(ran("mesh", "refine 3") && ran("step", "0.2 us") && !ran("step", "50 ns"), "{:?}", one.0.keys());
    let again = case.fem("study", &[&arguments("one")[..], &["--resume"]].concat()).good();
    assert!(again.stdout.contains("runs are there from before"), "{again:#?}");
    assert_eq!(stable("one").1, one.1, "a run was made again");
    // Of another scene there is nothing to go on with.
    let other = case.scene("end = \"4 us\"", "end = \"5 us\"");
    let refused = other.fem("study", &[&arguments("one")[..], &["--resume"]].concat());
    assert!(refused.status == 1 && refused.stderr.contains("`march.end` was \"4 us\" and is \"5 us\""), "{refused:#?}");
}

#[test]
fn a_scene_names_its_own_axes_and_quantities() {
    let case = short().append(
        "[study]\naxes = [\"step\"]\nquantities = [\"impulse\"]\n\n[[study.axis]]\nname = \"patch\"\nladder = false\n\
         levels = [{ impactor.patch_radius = \"0.5 mm\" }]\n",
    );
    let done = case.fem("study", &["--out", "study", "--tolerance", "10%"]).good();
    let rows = rows(&case, "study");
    let axes: BTreeSet<_> = rows.keys().map(|(axis, _)| axis.as_str()).collect();
    assert_eq!(axes.into_iter().collect::<Vec<_>>(), ["joint", "patch", "scene", "step"]);
    let columns =
        rows.values().next().map(|row| row.keys().filter(|c| c.ends_with(" error")).cloned().collect::<Vec<_>>());
    assert_eq!(columns.unwrap(), ["impulse error"]);
    assert!(done.stdout.contains("is met by"), "{done:#?}");
    // What another problem changes counts from the scene as it is, not from the reference.
    let patch = rows.iter().find(|((axis, _), _)| axis == "patch").unwrap().1;
    let own = number(&rows[&("scene".into(), "as it is".into())], "impulse");
    let change = format!(" {:+.1} % |", 100.0 * (number(patch, "impulse") / own - 1.0));
    let told = done.stdout.lines().find(|line| line.starts_with("| patch |") && line.contains("mm"));
    assert!(told.is_some_and(|line| line.contains(&change)), "{change}: {done:#?}");
    let alone = case.fem("study", &["--axis", "patch", "--out", "alone"]).good().stdout;
    assert!(alone.contains("| patch |") && !alone.contains("cheapest") && !alone.contains("or more"), "{alone}");
    let ways = case.fem("study", &["--axis", "mass,patch", "--out", "ways"]).good().stdout;
    assert!(ways.contains("| mass | ") && !ways.contains("or more"), "{ways}");
    // The scene that it wrote keeps what it promises.
    fem(case.folder(), &["run", "study/scene.toml", "--out", "promised"]).good();
    let impulse = |out: &str| case.summary(out)["impact"]["impulse_N_s"].as_f64().unwrap();
    let exact = number(&rows[&("step".into(), "25 ns".into())], "impulse");
    assert!((impulse("promised") / exact - 1.0).abs() < 0.1);
}

/// What two ladders of three levels say that they leave, held against levels that are ten times finer.
#[test]
fn a_ladder_says_what_it_leaves() {
    let text = std::fs::read_to_string(root().join("tests/data/scenes/study.toml")).unwrap();
    let scene = text.split("[study]").next().unwrap();
    let ladder = |name: &str, levels: [&str; 3]| {
        format!(
            "[[study.axis]]\nname = \"{name}\"\nlevels = [{{ {} }}, {{ {} }}, {{ {} }}]\n",
            levels[0], levels[1], levels[2]
        )
    };
    let text = format!(
        "{scene}[study]\naxes = [\"cells\", \"steps\"]\nquantities = [\"peak-force\", \"impulse\", \"deflection\"]\n{}{}",
        ladder("cells", ["mesh.cells = [6, 4]", "mesh.cells = [12, 8]", "mesh.cells = [24, 16]"]),
        ladder("steps", ["march.step = \"4 us\"", "march.step = \"2 us\"", "march.step = \"1 us\""]),
    );
    let case = strip().text(&text);
    let told = case.fem("study", &["--json", "--out", "study"]).good();
    let told: serde_json::Value = serde_json::from_str(&told.stdout).unwrap();
    let rows = rows(&case, "study");
    for (k, (axis, finest, finer)) in [
        ("cells", "mesh.cells [24, 16]", ("\"40 mm\"], cells = [6, 4]", "\"40 mm\"], cells = [96, 64]")),
        ("steps", "march.step \"1 us\"", ("\"newmark\", step = \"1 us\"", "\"newmark\", step = \"0.1 us\"")),
    ]
    .into_iter()
    .enumerate()
    {
        let exact = strip().text(&text).scene(finer.0, finer.1);
        exact.fem("run", &["--out", "exact"]).good();
        let row = &rows[&(axis.to_owned(), finest.to_owned())];
        let impact = &exact.summary("exact")["impact"];
        for (name, key) in
            [("peak-force", "peak_force_N"), ("impulse", "impulse_N_s"), ("deflection", "peak_plate_displacement_m")]
        {
            let exact = (number(row, name) / impact[key].as_f64().unwrap() - 1.0).abs();
            let ladder = &told["ladders"][k];
            assert_eq!(ladder["axis"], axis);
            let leaves = ladder["leaves"].as_array().unwrap().iter().find(|left| left["quantity"] == name).unwrap();
            // A bar that is not there is infinite.
            let most = leaves["error"].as_f64().zip(leaves["bar"].as_f64()).map_or(f64::INFINITY, |(e, bar)| e + bar);
            assert!(exact <= most, "{axis}, {name}: {exact:e} is left, and not up to {most:e}");
            // Three levels tell no order that another one confirms.
            assert!(leaves["known"] == false && row[&format!("{name} of its axis: known")] == "no", "{leaves}");
        }
    }
}

/// Delaminations that grow have ladders of their own, and none of what they have chosen.
#[test]
fn of_delaminations_that_grow() {
    let case = coming_apart(250);
    let done = case.fem("study", &["--axis", "layers,reduction,points,margin", "--out", "study"]).good();
    let rows = rows(&case, "study");
    let of = |axis: &str| rows.iter().filter(|((of, _), _)| of == axis).map(|(_, row)| row).collect::<Vec<_>>();
    for axis in ["layers", "reduction"] {
        assert!(of(axis).is_empty() && done.stdout.contains(&format!("the axis `{axis}` is left out")), "{done:#?}");
    }
    let (points, margins) = (of("points"), of("margin"));
    assert_eq!(points.iter().map(|row| &row["setting"][..]).collect::<Vec<_>>(), ["3 x 3 points", "8 x 8 points"]);
    let own = &of("scene")[0];
    let dissipated = |row: &BTreeMap<String, String>| number(row, "dissipated-energy");
    assert!(dissipated(own) > 0.01 && number(own, "absorbed-energy") != 0.0, "{own:?}");
    // Neither more points nor more that is open ahead of damage find another damage, only less well integrated ones do.
    for row in margins.iter().chain(&points[1..]) {
        assert!((dissipated(row) / dissipated(own) - 1.0).abs() < 0.05, "{row:?} {own:?}");
    }
    assert!(done.stdout.contains("dissipated-energy"), "{done:#?}");
}

#[test]
fn what_a_study_does_not_know_is_refused() {
    let case = short();
    let axis = case.fem("study", &["--axis", "mash"]);
    assert!(
        axis.status == 1 && axis.stderr.contains("there is no axis `mash`") && axis.stderr.contains("mesh"),
        "{axis:#?}"
    );
    for name in ["mesh", "a"] {
        let axis = |name: &str| format!("[[study.axis]]\nname = \"{name}\"\nlevels = [{{ march.end = \"1 us\" }}]\n");
        let twice = short().append(&(axis("a") + &axis(name))).fem("study", &[]);
        assert!(twice.status == 1 && twice.stderr.contains(&format!("another axis `{name}`")), "{twice:#?}");
    }
    let own = |name: char| {
        let levels: String = (1..=30).map(|n| format!("{{ reduction.vectors = {n} }}, ")).collect();
        format!("[[study.axis]]\nname = \"{name}\"\nlevels = [{levels}]\n")
    };
    let many = short().append(&['a', 'b', 'c', 'd'].map(own).concat()).fem("study", &["--axis", "a,b,c,d"]);
    assert!(many.status == 1 && many.stderr.contains("have 810000 combinations"), "{many:#?}");
    let case = case.append("[study]\nquantities = [\"peek-force\"]\n");
    let quantity = case.fem("study", &["--axis", "step"]);
    assert!(quantity.status == 1 && quantity.stderr.contains("the scene has no `peek-force`"), "{quantity:#?}");
    assert!(quantity.stderr.contains("peak-force"), "{quantity:#?}");
}

/// Loads at rest and natural modes have an accuracy, too.
#[test]
fn of_other_analyses() {
    let scene = std::fs::read_to_string(root().join("examples/pagano-0-90-0/scene.toml")).unwrap();
    let case = strip().text(&scene.replace("cells = [6, 6]", "cells = [4, 4]"));
    let scene = case.append("[study]\nquantities = [\"deflection\", { name = \"sxx-top\", profile = \"centre\", component = \"sxx\", height = \"0.5 mm\" }]\n");
    let done = scene.fem("study", &["--axis", "mesh", "--budget", "20s", "--out", "study"]).good();
    let rows = rows(&scene, "study");
    let deflection = number(&rows[&("scene".into(), "as it is".into())], "deflection");
    assert!((deflection.abs() * 1e3 / 0.07530 - 1.0).abs() < 1e-3, "{deflection}");
    assert!(done.stdout.contains("order"), "{done:#?}");
}
