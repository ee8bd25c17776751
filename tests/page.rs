//! The page that `fem report` makes of a folder of results, and what a run leaves for it.

use crate::support::{Case, failing, fem, plate, root, strip, watched};
use base64::Engine as _;
use serde_json::Value;
use sha2::Digest as _;
use std::fs;
use std::process::Command;

/// The page of the results in `out`.
fn page(case: &Case) -> String {
    let done = fem(case.folder(), &["report", "out"]).good();
    assert_eq!(done.stdout, "  report    out/report.html\n");
    case.read("out/report.html")
}

/// A static analysis, whose mesh is in its scene.
fn pagano() -> String {
    root().join("examples/pagano-0-90-0/scene.toml").to_str().unwrap().to_owned()
}

/// Elements without content.
const VOID: [&str; 6] = ["meta", "input", "img", "br", "hr", "link"];

/// Whether every element of the page ends where it must; texts of scripts and styles count as texts.
fn check_html(page: &str) {
    let mut rest = page.strip_prefix("<!DOCTYPE html>\n").expect("a document type");
    let mut open: Vec<&str> = Vec::new();
    while let Some((_, after)) = rest.split_once('<') {
        let (tag, after) = after.split_once('>').expect("a tag ends");
        rest = after;
        let name = tag.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "</{name}>");
        } else if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
            if name == "script" || name == "style" {
                rest = &rest[rest.find(&format!("</{name}")).expect("a script ends")..];
            }
        }
    }
    assert_eq!(open, [""; 0]);
}

/// What a run does not write would be taken for its own.
#[test]
fn a_later_run_leaves_nothing_of_an_earlier_one() {
    let case = failing();
    case.fem("run", &["--out", "out"]).good();
    page(&case);
    let before = case.names("out");
    assert!(["damage.json", "energy.svg", "report.html"].iter().all(|name| before.iter().any(|n| n == name)));
    let case = case.append("[output]\nplots = false\n");
    case.fem("run", &["--out", "out"]).good();
    let left = [".fem", "checkpoint.bin", "cost.json", "events.csv", "history.csv", "scene.toml", "summary.json"];
    assert_eq!(case.names("out"), left);
}

/// All parts of a finished impact, in a page that is whole and asks for nothing but itself.
#[test]
fn a_page_has_all_parts_and_needs_nothing_else() {
    let case = failing();
    case.fem("run", &["--out", "out"]).good();
    let page = page(&case);
    check_html(&page);
    assert!(page.len() < 2_000_000, "{}", page.len());
    for part in
        ["pictures", "damage", "events", "results", "cost", "scene", "provenance", "result-model", "result-accuracy"]
    {
        assert!(page.contains(&format!("id=\"{part}\"")), "{part}");
    }
    for picture in ["contact_force", "displacement", "energy", "force_displacement", "damage_map", "damage_section"] {
        assert!(page.contains(&format!("id=\"picture-{picture}\"")), "{picture}");
    }
    let summary = case.summary("out");
    let mode = summary["first_damage"][0]["mode"].as_str().unwrap();
    assert!(page.contains(&format!("<td>{mode}</td>")), "{mode}");
    assert!(page.contains("run plate&#x2f;scene.toml --out out"), "the command");
    assert!(page.contains("peak plate displacement <span") || page.contains("<dt>peak plate displacement</dt>"));
    let links = page.matches("://").count();
    assert_eq!(links, page.matches("http://www.w3.org/2000/svg").count(), "namespaces alone look like addresses");
    // The policy permits the two elements of the page by what stands in them.
    for (element, directive) in [("script", "script-src"), ("style", "style-src")] {
        let content =
            page.split(&format!("<{element}>")).nth(1).unwrap().split(&format!("</{element}>")).next().unwrap();
        let hash = base64::engine::general_purpose::STANDARD.encode(sha2::Sha256::digest(content));
        assert!(page.contains(&format!("{directive} 'sha256-{hash}';")), "{directive}");
    }
    for word in ["unsafe-inline", "src=\"h", "href=\"h", "@import", "url(h", "fetch(", "XMLHttpRequest"] {
        assert!(!page.contains(word), "{word}");
    }

    // The data of the page are those of the files.
    let data = page.split("id=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: Value = serde_json::from_str(data).unwrap();
    let (_, events) = case.table("out/events.csv");
    let number = |text: &str| text.parse::<f64>().unwrap();
    let first = |ply: &str| {
        let times = events.iter().filter(|e| e[4] == ply).map(|e| number(&e[0]));
        times.fold(f64::INFINITY, f64::min)
    };
    let places = data["damage"]["places"].as_array().unwrap();
    assert!(!events.is_empty() && places.len() == 31, "{}", places.len());
    for place in places {
        let time = place["failed"][0][2].as_f64().unwrap_or(f64::INFINITY);
        assert_eq!(time, first(place["ply"].as_str().unwrap()), "{}", place["ply"]);
    }
    let peak = summary["impact"]["peak_force_N"].as_f64().unwrap();
    let forces = data["curves"]["charts"][0]["series"][0]["values"].as_array().unwrap();
    let largest = forces.iter().map(|v| v.as_f64().unwrap()).fold(0.0, f64::max);
    assert!((largest / peak - 1.0).abs() < 1e-5, "{largest} {peak}");

    // A second page of the same folder is the same, and the run keeps its scene.
    assert_eq!(self::page(&case), page);
    assert_eq!(case.read("out/scene.toml"), case.read("plate/scene.toml"));
}

#[test]
fn damage_of_a_folded_plate_is_that_of_the_whole() {
    let criteria = "criteria = [\"hashin-report\", \"octahedral\"]";
    let run = |case: Case| {
        let case = case.scene("end = \"1 ms\"", "end = \"0.5 ms\"").scene(criteria, "criteria = [\"hashin-report\"]");
        case.fem("run", &["--out", "out"]).good();
        serde_json::from_str::<Value>(&case.read("out/damage.json")).unwrap()
    };
    let whole = run(plate());
    let folded = run(plate().scene("unit = \"mm\" }", "unit = \"mm\" }\nsymmetry = \"half-turn\""));
    assert_eq!(whole["judged"], folded["judged"]);
    let failed = |damage: &Value, ply: usize| {
        let mut cells: Vec<u64> =
            damage["places"][ply]["failed"].as_array().unwrap().iter().map(|f| f[0].as_u64().unwrap()).collect();
        cells.sort_unstable();
        cells
    };
    assert!(!failed(&whole, 0).is_empty());
    for ply in 0..16 {
        assert_eq!(failed(&whole, ply), failed(&folded, ply), "ply {}", ply + 1);
    }
}

#[test]
fn what_a_scene_says_is_text_on_the_page() {
    let evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>";
    let case = strip();
    let title = case_title(&case);
    let case = case.scene(&title, evil);
    case.fem("run", &["--out", "out"]).good();
    let page = page(&case);
    check_html(&page);
    assert!(!page.contains("<script>alert") && !page.contains("<img src=x"), "the title is taken for markup");
    assert!(page.contains("&lt;script&gt;alert(1)"), "the title is not there");
}

fn case_title(case: &Case) -> String {
    let scene = case.folder().join(case.write());
    let text = fs::read_to_string(scene).unwrap();
    text.lines().next().unwrap().split('"').nth(1).unwrap().to_owned()
}

#[test]
fn static_and_modal_results_have_pages_without_what_they_lack() {
    let case = strip();
    let scene = pagano();
    fem(case.folder(), &["run", &scene, "--out", "out"]).good();
    let page = page(&case);
    check_html(&page);
    for there in ["id=\"picture-profile-centre-in-plane\"", "id=\"result-largest_deflection\"", "id=\"scene\""] {
        assert!(page.contains(there), "{there}");
    }
    for absent in ["id=\"damage\"", "id=\"events\"", "data-chart"] {
        assert!(
            !page.contains(&format!("<section {absent}")) && !page.contains(&format!("<figure {absent}")),
            "{absent}"
        );
    }
    fem(case.folder(), &["modes", &scene, "--out", "modes", "--count", "3"]).good();
    fem(case.folder(), &["report", "modes"]).good();
    let page = case.read("modes/report.html");
    check_html(&page);
    assert!(page.contains("id=\"modes-table\"") && page.contains("id=\"picture-mode_shapes\""));
    assert!(page.contains("Lowest natural frequency "));
}

/// Runs over each other, with what differs in their scenes, and a force that was measured: that of the first run itself.
#[test]
fn runs_are_compared_with_each_other_and_with_a_measurement() {
    let case = strip();
    case.fem("run", &["--out", "slow"]).good();
    let case = case.scene("\"1.56 m/s\"", "\"2 m/s\"");
    case.fem("run", &["--out", "fast"]).good();
    let (header, rows) = case.table("slow/history.csv");
    let column = |name: &str| header.iter().position(|column| column == name).unwrap();
    let (time, force) = (column("time_s"), column("contact_force_N"));
    let number = |text: &str| text.parse::<f64>().unwrap();
    let lines = rows.iter().map(|row| format!("{:e};{:e}\n", 1e6 * number(&row[time]), 1e-3 * number(&row[force])));
    fs::write(case.folder().join("measured.csv"), "t (us); F (kN)\n".to_owned() + &lines.collect::<String>()).unwrap();

    let report =
        |folders: &[&str]| fem(case.folder(), &[&["report"], folders, &["--measured", "measured.csv"]].concat());
    let done = report(&["slow", "fast"]).good();
    assert_eq!(done.stdout, "  report    slow/comparison.html\n");
    let page = case.read("slow/comparison.html");
    check_html(&page);
    for words in [
        "What differs in their scenes",
        "<td>impactor.velocity</td>",
        "fast: Against what was measured",
        "peak deflection",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let (_, data) = page.split_once("id=\"data\">").unwrap();
    let data: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    let series = |chart: usize| data["curves"]["charts"][chart]["series"].as_array().unwrap();
    let names: Vec<_> = series(0).iter().map(|curve| curve["name"].as_str().unwrap()).collect();
    assert_eq!((names, series(1).len()), (vec!["slow", "fast", "measured"], 2));

    let twice = report(&["slow", "./slow"]);
    assert!(twice.status == 1 && twice.stderr.contains("`./slow` is named twice"), "{twice:#?}");

    report(&["slow"]).good();
    let alone = case.read("slow/report.html");
    let (_, table) = alone.split_once("Against what was measured").unwrap();
    assert_eq!(table.split_once("</table>").unwrap().0.matches(">0 %<").count(), 3, "{table}");
    fs::write(case.folder().join("measured.csv"), "t;F\n0;1\n").unwrap();
    let refused = report(&["slow"]);
    assert!(refused.status == 1 && refused.stderr.contains("has a unit of time"), "{refused:#?}");
}

/// A run that a signal stopped has left a checkpoint; one that stopped by itself all of its results.
#[test]
fn stopped_runs_have_pages_that_say_so() {
    let case = strip();
    case.fem("run", &["--out", "out"]).good();
    for name in case.names("out") {
        if !["checkpoint.bin", ".fem"].contains(&name.as_str()) {
            fs::remove_file(case.folder().join("out").join(name)).unwrap();
        }
    }
    let left = page(&case);
    check_html(&left);
    assert!(left.contains("stopped before its end") && left.contains("--resume") && !left.contains("id=\"results\""));

    let case = failing();
    case.fem("run", &["--out", "out"]).good();
    let mut summary = case.summary("out");
    summary["completed"] = false.into();
    summary["stopped"] = "step 7: the energy grows".into();
    fs::write(case.folder().join("out/summary.json"), summary.to_string()).unwrap();
    assert!(page(&case).contains("The march stopped early; what is shown holds up to then. step 7: the energy grows"));
}

#[test]
fn what_is_no_folder_of_results_or_is_damaged_is_refused_by_name() {
    let case = watched();
    case.fem("run", &["--out", "out"]).good();
    let refused = |folder: &str| {
        let done = fem(case.folder(), &["report", folder]);
        assert_eq!((done.status, done.stdout.as_str()), (1, ""), "{done:?}");
        done.stderr
    };
    for folder in ["plate", "nowhere"] {
        let said = refused(folder);
        assert!(said.contains("holds no results of `fem run`") && said.contains(folder), "{said}");
        assert!(!case.folder().join(folder).join("report.html").exists());
    }
    assert!(!case.folder().join("nowhere").exists(), "a folder was made");
    let spoilt: [(&str, &str, &str); 6] = [
        ("summary.json", "{\"title\": \"cut", "EOF"),
        ("summary.json", "[]", "it has no title"),
        ("history.csv", "time_s,contact_force_N\n0.0,inf\n", "row 1, column contact_force_N"),
        ("events.csv", "time_s,criterion\n0.0\n", "record 1"),
        ("damage.json", "{}", "missing field"),
        ("energy.svg", "<svg xmlns=\"\"><script>1</script></svg>", "was not drawn by"),
    ];
    for (file, text, words) in spoilt {
        let path = case.folder().join("out").join(file);
        let good = fs::read(&path).unwrap();
        fs::write(&path, text).unwrap();
        let said = refused("out");
        assert!(said.contains(file) && said.contains(words), "{file}: {said}");
        fs::write(&path, good).unwrap();
    }
    page(&case);
}

#[test]
fn a_scene_of_somebody_else_is_not_overwritten() {
    let case = strip();
    let scene = case.folder().join(case.write());
    let mine = case.folder().join("mine");
    fs::create_dir(&mine).unwrap();
    fs::write(mine.join("scene.toml"), "mine").unwrap();
    let done = fem(case.folder(), &["run", scene.to_str().unwrap(), "--out", "mine"]);
    assert_eq!(done.status, 1);
    assert!(done.stderr.contains("would be overwritten"), "{done:?}");
    assert_eq!(fs::read_to_string(mine.join("scene.toml")).unwrap(), "mine");
    // Results beside the scene that they are of leave it alone.
    let before = fs::read(&scene).unwrap();
    fem(case.folder(), &["run", scene.to_str().unwrap(), "--out", "plate"]).good();
    assert_eq!(fs::read(&scene).unwrap(), before);
}

#[test]
fn a_picture_that_has_nothing_to_show_is_left_out() {
    let case = strip().append("[effects]\ndamage = \"off\"\n");
    case.fem("run", &["--out", "out"]).good();
    let names = case.names("out");
    assert!(names.contains(&"displacement.svg".to_owned()), "{names:?}");
    for absent in ["damage_map.svg", "damage_section.svg", "damage.json"] {
        assert!(!names.contains(&absent.to_owned()), "{absent}");
    }
    page(&case);
}

/// In a real browser: curves are read and zoomed, the slider colours cells, events are sorted, and nothing is complained of.
#[test]
#[ignore = "needs python3 and Chromium, which .ci/run installs"]
fn pages_work_in_a_browser() {
    let use_it = |case: &Case, file: &str| {
        let page = case.folder().join(file);
        let browser = Command::new("python3").arg(root().join("tests/report/browser.py")).arg(page).output().unwrap();
        assert!(browser.status.success(), "{}", String::from_utf8_lossy(&[browser.stdout, browser.stderr].concat()));
    };
    let case = failing();
    case.fem("run", &["--out", "out"]).good();
    page(&case);
    use_it(&case, "out/report.html");
    let case = strip();
    fem(case.folder(), &["run", &pagano(), "--out", "out"]).good();
    page(&case);
    use_it(&case, "out/report.html");
    fem(case.folder(), &["modes", &pagano(), "--out", "modes"]).good();
    fem(case.folder(), &["report", "modes"]).good();
    use_it(&case, "modes/report.html");
}
