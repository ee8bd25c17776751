//! Runs, studies and pages that are killed at any moment, or for which there is no room: whatever lies there afterwards is
//! whole, of one run, and goes on to what an undisturbed one leaves.
#![cfg(unix)]

use crate::study::rows;
use crate::support::{Case, failing, fem, strip, watched};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// `fem ARGUMENTS` of a case, which may write files of so many kilobytes.
fn start(case: &Case, arguments: &[&str], kilobytes: Option<u32>) -> Child {
    let limit = kilobytes.map_or("unlimited".to_owned(), |most| most.to_string());
    let mut command = Command::new("bash");
    command.args(["-c", &format!("trap '' XFSZ; ulimit -f {limit}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_fem")]);
    command.args(arguments).current_dir(case.folder());
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Numbers that look as if they had no order, the same at every call.
struct Random(u64);

impl Random {
    /// Below 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
    }
}

/// What is killed: a command, the folder that it fills, what it is repeated with, and what is compared of the folder.
struct Victim<'a> {
    case: &'a Case,
    first: Vec<&'a str>,
    again: Vec<&'a str>,
    /// Makes the folder ready.
    before: &'a dyn Fn(),
    found: &'a dyn Fn(&str) -> BTreeMap<String, Vec<u8>>,
}

impl Victim<'_> {
    /// Ends the command by a full disk or a kill, `times` times, at moments between the first file that it writes and its
    /// end; each time it is repeated to its end. A kill that came too late is checked and not counted: how long the
    /// command lasts depends on what else the machine does.
    fn kill(&self, times: usize, random: &mut Random) {
        let out = self.case.folder().join("out");
        let run = |arguments: &[&str]| fem(self.case.folder(), arguments);
        let clear = || {
            let _ = fs::remove_dir_all(&out);
            (self.before)();
        };
        clear();
        let (mut lasts, want) = {
            let mut child = start(self.case, &self.first, None);
            let started = self.begins(&mut child, &out);
            assert!(child.wait().unwrap().success(), "{:?}", self.first);
            (started.elapsed(), (self.found)("out"))
        };
        assert!(!want.is_empty());
        let mut ended = 0;
        for k in 0.. {
            if ended == times {
                return;
            }
            assert!(k < 10 * times + 20, "{:?}: {ended} of {k} kills met something that was running", self.first);
            clear();
            let full = k % 8 == 7;
            let kilobytes = full.then(|| (random.share() * 160.0) as u32);
            let mut child = start(self.case, &self.first, kilobytes);
            if !full {
                let started = self.begins(&mut child, &out);
                let until = lasts.mul_f64(random.share());
                while started.elapsed() < until {
                    std::thread::sleep(Duration::from_micros(200));
                    if child.try_wait().unwrap().is_some() {
                        lasts = lasts.min(started.elapsed());
                        break;
                    }
                }
                child.kill().unwrap();
            }
            ended += usize::from(!child.wait().unwrap().success());
            let left = tell(&out);
            // A page of what is there is of one run; none where there is nothing.
            let page = run(&["report", "out"]);
            let none = page.stderr.contains("holds no results");
            assert!(page.status == 0 || none, "{:?}, {k}: {page:#?}\n{left:?}", self.first);
            let arguments = if fem::io::files::is_own(&out) { &self.again } else { &self.first };
            run(arguments).good();
            let found = (self.found)("out");
            let other: Vec<_> =
                want.keys().chain(found.keys()).filter(|name| want.get(*name) != found.get(*name)).collect();
            assert!(other.is_empty(), "{:?}, {k}: {other:?} differ; there was {left:?}", self.first);
        }
    }

    /// Waits for the first trace of the command in its folder, a new list.
    fn begins(&self, child: &mut Child, out: &Path) -> Instant {
        let trace = out.join(".fem/manifest");
        let seen = || trace.metadata().and_then(|is| is.modified()).ok();
        let before = seen();
        while child.try_wait().unwrap().is_none() && seen() == before {
            std::thread::sleep(Duration::from_micros(200));
        }
        Instant::now()
    }
}

/// Names of what lies in a folder.
fn tell(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
}

/// The files of a folder but for the list and what the machine has to say.
fn files(case: &Case, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let names =
        case.names(folder).into_iter().filter(|name| ![".fem", "cost.json", "report.html"].contains(&name.as_str()));
    names.map(|name| (name.clone(), fs::read(case.folder().join(folder).join(name)).unwrap())).collect()
}

/// The table of a study but for its seconds, and the names of all files.
fn studied(case: &Case, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let mut found: BTreeMap<String, Vec<u8>> = case.names(folder).into_iter().map(|name| (name, Vec::new())).collect();
    for (key, mut row) in rows(case, folder) {
        row.retain(|column, _| !column.ends_with("_cpu_s") && column != "peak_memory_MB");
        found.insert(format!("{key:?}"), format!("{row:?}").into_bytes());
    }
    found.remove("report.html");
    found
}

/// So many of each.
struct Kills {
    runs: usize,
    /// Runs that draw, which takes longer than the rest.
    drawn: usize,
    /// Runs into the folder of another scene's.
    over: usize,
    reports: usize,
    studies: usize,
}

impl Kills {
    fn kill(&self) {
        let mut random = Random(1);
        let plain = watched().scene("maps = true", "maps = true\nplots = false");
        let drawn = watched();
        let short = strip().scene("end = \"20 us\"", "end = \"2 us\"").append("[reduction]\nvectors = 10\n");
        let other = failing().append("[output]\nhistory_every = \"1 us\"\n");
        other.fem("run", &["--out", "out"]).good();
        fem(other.folder(), &["report", "out"]).good();
        let scene = [&plain, &drawn, &short].map(Case::write)[0];
        let first = || vec!["run", scene, "--out", "out"];
        let again = || [first(), vec!["--resume"]].concat();
        let copy = |from: &Path, to: &Case| {
            let copied = Command::new("cp").arg("-a").arg(from).arg(to.folder().join("out")).status();
            assert!(copied.unwrap().success());
        };

        let nothing = || ();
        let all = |folder: &str| files(&plain, folder);
        let run = Victim { case: &plain, first: first(), again: again(), before: &nothing, found: &all };
        run.kill(self.runs, &mut random);

        // What another scene has left would be refused by `--resume`, and is superseded without.
        let left = || copy(&other.folder().join("out"), &plain);
        let over = Victim { case: &plain, first: first(), again: first(), before: &left, found: &all };
        over.kill(self.over, &mut random);

        let all = |folder: &str| files(&drawn, folder);
        let run = Victim { case: &drawn, first: first(), again: again(), before: &nothing, found: &all };
        run.kill(self.drawn, &mut random);

        drawn.fem("run", &["--out", "whole"]).good();
        let whole = || copy(&drawn.folder().join("whole"), &drawn);
        let page = |folder: &str| {
            let page = fs::read(drawn.folder().join(folder).join("report.html")).unwrap();
            files(&drawn, folder).into_iter().chain([("report.html".to_owned(), page)]).collect()
        };
        let report = || vec!["report", "out"];
        let report = Victim { case: &drawn, first: report(), again: report(), before: &whole, found: &page };
        report.kill(self.reports, &mut random);

        let study = || vec!["study", scene, "--axis", "step", "--out", "out"];
        let again = [study(), vec!["--resume"]].concat();
        let all = |folder: &str| studied(&short, folder);
        let study = Victim { case: &short, first: study(), again, before: &nothing, found: &all };
        study.kill(self.studies, &mut random);
    }
}

#[test]
fn at_any_moment() {
    Kills { runs: 18, drawn: 2, over: 4, reports: 3, studies: 1 }.kill();
}

#[test]
#[ignore = "a thousand kills take minutes"]
fn a_thousand_times() {
    Kills { runs: 500, drawn: 120, over: 160, reports: 180, studies: 40 }.kill();
}

/// A page never shows pictures of one run beside the numbers of another.
#[test]
fn a_page_is_of_one_run() {
    // Few windows make a checkpoint that is smaller than the pictures, so that a limit can lie between them.
    let criteria = "criteria = [\"hashin-report\", \"octahedral\"]";
    let few = || failing().scene(criteria, &format!("{criteria}\nwindow = \"element\""));
    let short = || few().append("[output]\nhistory_every = \"1 us\"\n");
    let before = short();
    before.fem("run", &["--out", "out"]).good();
    let case = short().scene("mass = \"2.49 kg\"", "mass = \"2 kg\"").scene("title = \"", "title = \"Later: ");
    let scene = case.write();
    let out = case.folder().join("out");
    let whole = start(&case, &["run", scene, "--out", "whole"], None).wait().unwrap();
    assert!(whole.success());
    let mut seen = 0;
    for kilobytes in [48, 88, 120, 132, 134] {
        let _ = fs::remove_dir_all(&out);
        fs::rename(before.folder().join("out"), &out).unwrap();
        let copied = Command::new("cp").args(["-a", "out"]).arg(before.folder()).current_dir(case.folder()).status();
        assert!(copied.unwrap().success());
        let _ = start(&case, &["run", scene, "--out", "out"], Some(kilobytes)).wait().unwrap();
        let page = fem(case.folder(), &["report", "out"]).good();
        assert!(page.stdout.contains("report.html"));
        let page = case.read("out/report.html");
        let shown = |name: &str| page.contains(&format!("id=\"picture-{name}\""));
        let same = |name: &str| {
            let read = |folder: &str| fs::read(case.folder().join(folder).join(name)).ok();
            read("out") == read("whole")
        };
        // `--resume` and the state of the march are the new run's from its first checkpoint on.
        if same("checkpoint.bin") {
            seen += 1;
            for name in ["contact_force", "displacement", "energy", "force_displacement", "damage_map"] {
                assert!(!shown(name) || same(&format!("{name}.svg")), "{kilobytes} kB: an older picture {name}");
            }
            assert!(!page.contains("peak force") || page.contains("<h1>Later: "), "{kilobytes} kB");
        }
    }
    assert!(seen >= 2, "{seen}");
}
