//! Extremes and events are those of the steps, whatever a history keeps of them; what mesh, rows and densities must be for them.

use crate::support::{Case, plate, strip};
use serde_json::Value;

/// A cantilever that a light ball strikes and leaves.
fn blow() -> Case {
    strip()
        .scene("mass = \"2.49 kg\"", "mass = \"0.2 g\"")
        .scene("velocity = \"1.56 m/s\"", "velocity = \"20 m/s\"")
        .scene("end = \"20 us\"", "step = \"0.1 us\"\nend = \"100 us\"")
        .scene("criteria = [\"hashin-report\", \"octahedral\"]", WEAK)
}

/// Plies that break along the fibres.
const WEAK: &str =
    "criteria = [\"octahedral\", { name = \"expression\", expression = \"abs(s1) / (50*MPa)\" }]\nevery = \"0.5 us\"";

fn summary(case: &Case) -> Value {
    case.fem("run", &["--out", "out"]).good();
    case.summary("out")
}

fn warned(summary: &Value, words: &str) -> bool {
    summary["warnings"].as_array().unwrap().iter().any(|warning| warning.as_str().unwrap().contains(words))
}

#[test]
fn a_blow_is_what_it_is_whatever_rows_and_end() {
    let said = |case: &Case| {
        let Value::Object(mut summary) = summary(case) else { panic!() };
        let mut impact = summary["impact"].take();
        impact.as_object_mut().unwrap().retain(|key, _| key != "end_time_s" && !key.starts_with("peak_plate"));
        (impact, summary["first_damage"].take(), summary["accuracy"]["energy_error_relative"].take())
    };
    let seldom = "[output]\nhistory_every = \"1 s\"\n";
    let straight = said(&blow());
    let (peak, contact) = (&straight.0["peak_force_N"], &straight.0["contact_time_s"]);
    assert!(peak.as_f64() > Some(500.0) && straight.0["contacts"] == 1, "{straight:?}");
    assert!(straight.1.as_array().is_some_and(|modes| !modes.is_empty()), "{straight:?}");
    assert!(contact.as_f64() > Some(3e-6) && contact.as_f64() < Some(60e-6), "{contact}");
    assert_eq!(said(&blow().append(seldom)), straight);
    let later = said(&blow().scene("end = \"100 us\"", "end = \"700 us\"").append(seldom));
    assert_eq!((later.0, later.1), (straight.0, straight.1));
}

#[test]
fn a_history_that_misses_the_peak_says_so() {
    let words = "`output.history_every` to ";
    assert!(!warned(&summary(&blow()), words));
    let seldom = summary(&blow().append("[output]\nhistory_every = \"20 us\"\n"));
    assert!(warned(&seldom, words), "{seldom:#}");
}

/// The strip fails under the ball, which the criteria are not asked to look at.
#[test]
fn a_blow_between_two_looks_is_seen() {
    let seldom = |every: &str| summary(&blow().scene("every = \"0.5 us\"", &format!("every = \"{every}\"")));
    let (often, never) = (seldom("0.1 us"), seldom("1 s"));
    assert!(warned(&never, "the criteria look every") && !warned(&often, "the criteria look"), "{never:#}");
    // In whole steps of 0.1 us.
    let said = never["warnings"].to_string();
    let us: f64 = said.split("look every ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap().parse().unwrap();
    assert!((10.0 * us - (10.0 * us).round()).abs() < 1e-6, "{said}");
    let index = |summary: &Value| {
        let modes = summary["not_reached"].as_array().unwrap().iter();
        modes.map(|mode| mode["largest_index"].as_f64().unwrap()).fold(0.0, f64::max)
    };
    let first = |summary: &Value| summary["first_damage"][0]["time_s"].as_f64().unwrap();
    assert!((first(&never) / first(&often) - 1.0).abs() < 0.05, "{} {}", first(&never), first(&often));
    assert!((index(&never) / index(&often) - 1.0).abs() < 0.05, "{} {}", index(&never), index(&often));
}

#[test]
fn a_study_needs_no_rows() {
    let step = "[study]\naxes = [\"step\"]\n[output]\nhistory_every = \"1 s\"\n";
    let case = blow().append(step).append("[reduction]\nmethod = \"ritz\"\nvectors = 20\n");
    let done = case.fem("study", &["--out", "study"]).good();
    assert!(!done.stdout.contains("NaN") && !case.read("study/study.csv").contains("NaN"), "{done:#?}");
    let rows = crate::study::rows(&case, "study");
    let ran = || rows.values().filter(|row| row["refused"].is_empty());
    assert!(ran().count() > 3 && ran().all(|row| row["force-history error"].parse::<f64>().is_ok()), "{rows:#?}");
}

/// A ball on a plate of `cells` by `cells` flat shells.
fn struck(cells: usize) -> Case {
    let sides = ["x-min", "x-max", "y-min", "y-max"];
    let supports = sides.map(|side| format!("[[support]]\ngroup = '{side}'\nat = 'all'\nfix = ['U30']\n")).concat();
    strip().text(&format!(
        "title = 'plate'\nmesh = {{ rectangle = ['100 mm', '100 mm'], cells = [{cells}, {cells}] }}\n\
         element = {{ kind = 'mitc4' }}\nsymmetry = 'half-turn'\nmaterials.t = {{ library = 'AS4/3502' }}\n\
         effects = {{ damage = 'off' }}\n\
         [laminate]\nplies = '[0/45/-45/90]2s'\nmaterial = 't'\nply_thickness = '0.13208 mm'\nlayers = 1\n{supports}\
         [[support]]\nrestrain = 'rigid-motions'\n[impactor]\nmass = '1 g'\nvelocity = '10 m/s'\n\
         at = {{ x = '50 mm', y = '50 mm' }}\npatch_radius = '2 mm'\n[contact]\nlaw = 'hertz'\nk = '3.4e9 N/m^1.5'\n\
         [march]\nstep = '0.5 us'\nend = '80 us'\n"
    ))
}

/// What a run and a check say of its cells, in parts of the force, and that force over time.
fn of_cells(case: &Case) -> ([Option<f64>; 2], Vec<f64>) {
    let told = |warnings: &Value| {
        let said =
            warnings.as_array().unwrap().iter().find_map(|w| w.as_str().filter(|w| w.contains("bending wave")))?;
        let percent = said.split("wrong by up to about ").nth(1).unwrap().split(' ').next().unwrap();
        Some(0.01 * percent.parse::<f64>().unwrap())
    };
    let run = told(&summary(case)["warnings"]);
    let check: Value = serde_json::from_str(&case.fem("check", &["--json"]).good().stdout).unwrap();
    let forces = case.table("out/history.csv").1.iter().map(|row| row[1].parse().unwrap()).collect();
    ([run, told(&check["warnings"])], forces)
}

#[test]
fn cells_too_large_for_the_waves_of_a_blow_are_told() {
    let (none, fine) = of_cells(&struck(64));
    assert_eq!(none, [None; 2]);
    for cells in [12, 24] {
        let (told, forces) = of_cells(&struck(cells));
        let square = |of: &dyn Fn(usize) -> f64| (0..fine.len()).map(|k| of(k).powi(2)).sum::<f64>().sqrt();
        let error = square(&|k| forces[k] - fine[k]) / square(&|k| fine[k]);
        assert!(error > 0.05, "{cells}: {error}");
        for told in told {
            let told = told.unwrap();
            assert!((1.0..5.0).contains(&(told / error)), "{cells}: {told} for {error}");
        }
    }
}

#[test]
fn rows_between_steps_are_told_and_those_too_many_are_refused() {
    let rows = |every: &str| blow().append(&format!("[output]\nhistory_every = \"{every}\"\n"));
    let uneven = rows("0.25 us");
    assert!(warned(&summary(&uneven), "`output.history_every` is 0.25 us, no whole number of steps"));
    let times: Vec<f64> = uneven.table("out/history.csv").1.iter().map(|row| row[0].parse().unwrap()).collect();
    // But for the row of the end.
    let even = times[..times.len() - 1].windows(2).all(|pair| (pair[1] - pair[0] - 0.3e-6).abs() < 1e-15);
    assert!(even && times.len() > 300, "{times:?}");
    let many = rows("0.1 us").scene("end = \"100 us\"", "end = \"99 s\"").fem("check", &[]);
    assert!(many.status == 1 && many.stderr.contains("histories"), "{many:#?}");
    assert!(many.stderr.contains("`output.history_every`"), "{many:#?}");
}

#[test]
fn what_rests_without_weight_needs_no_density() {
    let plate = |density: &str, load: &str| {
        strip().text(&format!(
            "title = 'rest'\nanalysis = 'static'\nmesh = {{ rectangle = ['10 mm', '10 mm'], cells = [2, 2] }}\n\
             effects = {{ damage = 'off' }}\nsupport = [{{ group = 'x-min', at = 'all', fix = ['U10', 'U20', 'U30'] }}]\n\
             load = [{{ {load} }}]\nmaterials.m = {{ e1 = '70 GPa', e2 = '70 GPa', e3 = '70 GPa', nu12 = 0.3, nu13 = 0.3, \
             nu23 = 0.3, g12 = '27 GPa', g13 = '27 GPa', g23 = '27 GPa'{density} }}\n\
             laminate = {{ plies = '[0]', material = 'm', ply_thickness = '1 mm', layers = [1] }}\n"
        ))
    };
    let pressure = "pressure = '1 MPa', face = 'top'";
    let light = summary(&plate("", pressure));
    assert_eq!(light, summary(&plate(", density = '2.7 g/cm^3'", pressure)));
    let weight = plate("", "gravity = ['0 m/s^2', '0 m/s^2', '-9.81 m/s^2']");
    for done in
        [weight.fem("run", &[]), plate("", pressure).fem("modes", &[]), plate("", pressure).fem("matrices", &[])]
    {
        assert!(done.status == 1 && done.stderr.contains("the mass of the plate needs a density"), "{done:#?}");
        assert!(done.stderr.contains("materials.m") && done.stderr.contains("add its `density`"), "{done:#?}");
    }
}

/// Of many places the stresses take most: of a reduced plate the operator that makes them, else samples and their strains.
#[test]
fn the_memory_of_stresses_is_foreseen() {
    for reduction in ["{ method = 'ritz', vectors = 60 }", "{ method = 'none' }"] {
        let case = plate().text(&format!(
            "title = 'many places'\nmesh = {{ rectangle = ['60 mm', '60 mm'], cells = [30, 30] }}\nelement = {{ kind = 'mitc4' }}\n\
             materials.tape = {{ library = 'AS4/3502' }}\nmaterials.resin = {{ library = '3502 resin' }}\n\
             laminate = {{ plies = '[0/90]4s', material = 'tape', ply_thickness = '0.13 mm', layers = 1, interface = 'resin' }}\n\
             support = [{{ group = 'x-min', at = 'mid-plane', fix = ['U10', 'U20', 'U30', 'U13', 'U23'] }}]\n\
             impactor = {{ mass = '10 g', velocity = '1 m/s', at = {{ x = '30 mm', y = '30 mm' }} }}\n\
             contact = {{ law = 'hertz', k = '1e8 N/m^1.5' }}\n\
             failure = {{ criteria = ['hashin-report', 'octahedral'], every = '1 us' }}\nreduction = {reduction}\n\
             march = {{ step = '1 us', end = '20 us' }}\noutput = {{ plots = false }}\n"
        ));
        let said = case.fem("check", &["--full"]).good().stdout;
        let line = said.lines().find(|line| line.trim_start().starts_with("memory")).unwrap();
        assert!(line.contains("peak: stresses"), "{line}");
        let estimate: f64 = line.split_whitespace().nth(2).unwrap().parse().unwrap();
        case.fem("run", &["--out", "out"]).good();
        let cost: Value = serde_json::from_str(&case.read("out/cost.json")).unwrap();
        let peak = cost["peak_memory_MB"].as_f64().unwrap();
        assert!((0.75..1.5).contains(&(estimate / peak)), "{line}: {peak}");
    }
}

/// Both sides of closed interfaces are one when it comes to the factor, which takes most.
#[test]
fn the_memory_of_interfaces_that_open_is_foreseen() {
    let case = plate().text(
        "title = 'many interfaces'\nmesh = { rectangle = ['60 mm', '60 mm'], cells = [14, 14] }\nelement = { kind = 'hermite-prism' }\n\
         effects = { damage = 'off', delamination = 'growth' }\nmaterials.tape = { library = 'T700GC/M21' }\n\
         laminate = { plies = '[0/45/90/-45]s', material = 'tape', ply_thickness = '0.25 mm' }\n\
         support = [{ group = 'x-min', at = 'bottom', fix = ['U30', 'U31'] }, { group = 'x-max', at = 'bottom', fix = ['U30', 'U31'] }, \
         { restrain = 'rigid-motions' }]\n\
         impactor = { mass = '1 kg', velocity = '1 m/s', at = { x = '30 mm', y = '30 mm' } }\n\
         contact = { law = 'hertz', k = '1e8 N/m^1.5' }\nmarch = { step = '1 us', end = '3 us' }\noutput = { plots = false }\n",
    );
    let said = case.fem("check", &["--full"]).good().stdout;
    let line = said.lines().find(|line| line.trim_start().starts_with("memory")).unwrap();
    assert!(line.contains("peak: factor"), "{line}");
    let estimate: f64 = line.split_whitespace().nth(2).unwrap().parse().unwrap();
    case.fem("run", &["--out", "out"]).good();
    let cost: Value = serde_json::from_str(&case.read("out/cost.json")).unwrap();
    let peak = cost["peak_memory_MB"].as_f64().unwrap();
    assert!((estimate / peak).max(peak / estimate) < 1.5, "{line}: {peak}");
}

#[test]
fn divided_steps_of_a_full_plate_are_told() {
    let divided = |integrator: &str, method: &str| {
        let march =
            format!("[reduction]\nmethod = \"{method}\"\n[march]\nintegrator = \"{integrator}\"\ntolerance = 1e-2");
        strip().scene("[march]", &march).fem("check", &[]).good()
    };
    for (integrator, method, told) in
        [("newmark", "none", true), ("newmark", "ritz", false), ("dormand-prince", "none", false)]
    {
        let done = divided(integrator, method);
        assert_eq!(
            done.stdout.contains("factorises the full plate: at least 400 times in 200 steps"),
            told,
            "{done:#?}"
        );
    }
}
