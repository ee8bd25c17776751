//! Memory, disk, folders and signals that a run meets, on Linux.

use crate::case::{Case, Room};
use crate::support::{self, Done, OFTEN, plate, strip, watched};
use fem::io::files::OutputDir;
use serde_json::Value;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

pub(crate) fn cases() -> Vec<Case> {
    let foreseen = Room::Resources.case(
        "memory that is foreseen",
        "plates of 6000, 12 000 and 47 000 unknowns, reduced and in full",
        "ratio of the estimate of `fem check --full` and the peak of `fem run`, the larger over the smaller",
        1.5,
        memory_foreseen,
    );
    vec![
        foreseen.long(),
        Room::Resources.case(
            "memory that there is not",
            "a plate of a million cells with 4 GB of addresses, one of 4600 with 0.3 GB; run, check, modes",
            "commands that do not refuse with need, memory, parts and remedy",
            0.0,
            memory_that_there_is_not,
        ),
        Room::Resources.case(
            "full disk",
            "files cut at 0 to 32 kB, over the results of an earlier run; run, modes, matrices",
            "commands that do not say so, files neither as before nor whole, files left over",
            0.0,
            full_disk,
        ),
        Room::Resources.case(
            "folders that take no results",
            "a file, a folder below one, a folder of the kernel, a folder in use; run, modes, matrices",
            "commands that do not refuse by the name of the folder with a remedy",
            0.0,
            folders,
        ),
        Room::Resources.case(
            "signals",
            "Ctrl-C, SIGTERM, SIGHUP in a march; Ctrl-C twice; SIGHUP under nohup",
            "runs without their exit status, checkpoint and word on how to go on",
            0.0,
            signals,
        ),
        Room::Resources.case(
            "kill -9",
            "20 kills, half of them 0 to 40 ms after the start, half as long after a checkpoint; each run resumed",
            "files that differ from those of a run in one piece",
            0.0,
            kills,
        ),
        Room::Resources.case(
            "damaged checkpoint",
            "cut at 12 lengths, one bit flipped in 12 bytes",
            "damage that is not refused",
            0.0,
            damaged,
        ),
        Room::Resources.case(
            "standard output that takes nothing",
            "a closed pipe, no output at all, a full disk; list, check, run, envelope, --help",
            "commands that panic or end otherwise than 0 with a closed pipe, than 1 with a full disk",
            0.0,
            no_output,
        ),
    ]
}

/// `fem ARGUMENTS` in `folder` after the words of a shell, `ulimit` or `trap`.
fn shell(folder: &Path, before: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new("bash");
    command
        .args(["-c", &format!("{before}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_fem")])
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null());
    command
}

/// What a command left, a signal as the shell counts it.
fn done(output: Output) -> Done {
    Done {
        status: output.status.code().unwrap_or_else(|| 128 + output.status.signal().unwrap()),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Words of an error, without its frame and line breaks.
fn flat(text: &str) -> String {
    text.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

/// Counts what does not hold, and says what.
#[derive(Default)]
struct Wrong(usize);

impl Wrong {
    fn unless(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            eprintln!("{}", what());
            self.0 += 1;
        }
    }

    fn count(self) -> f64 {
        self.0 as f64
    }
}

fn memory_foreseen() -> f64 {
    let full = "[reduction]\nmethod = \"none\"\n[march]";
    let refined =
        |case: support::Case, times: &str| case.scene("unit = \"mm\"", &format!("unit = \"mm\", refine = {times}"));
    let short = |case: support::Case| case.scene("end = \"1 ms\"", "end = \"5 us\"");
    let cases =
        [refined(strip(), "2"), short(plate()), short(plate()).scene("[march]", full), short(refined(plate(), "1"))];
    let ratio = |case: support::Case| {
        let said = case.fem("check", &["--full"]).good().stdout;
        let line = said.lines().find(|line| line.trim_start().starts_with("memory")).unwrap();
        let estimate: f64 = line.split_whitespace().nth(2).unwrap().parse().unwrap();
        case.fem("run", &["--out", "out"]).good();
        let cost: Value = serde_json::from_str(&case.read("out/cost.json")).unwrap();
        let peak = cost["peak_memory_MB"].as_f64().unwrap();
        (estimate / peak).max(peak / estimate)
    };
    cases.into_iter().map(ratio).fold(1.0, f64::max)
}

fn memory_that_there_is_not() -> f64 {
    let mesh = "mesh = { file = \"plate.msh\", unit = \"mm\" }";
    let million = strip()
        .scene(mesh, "mesh = { rectangle = [\"30 mm\", \"10 mm\"], cells = [1000, 1000] }")
        .scene("group = \"clamped\"", "group = \"x-min\"");
    let fine = plate().scene("unit = \"mm\"", "unit = \"mm\", refine = 2");
    let mut wrong = Wrong::default();
    for (case, kilobytes) in [(million, 4_000_000), (fine, 300_000)] {
        let scene = case.write();
        for command in ["run", "check", "modes"] {
            let done =
                done(shell(case.folder(), &format!("ulimit -v {kilobytes}"), &[command, scene]).output().unwrap());
            let said = flat(&done.stderr);
            let words = ["this takes about", "of memory, and", "are free", "stiffness", "fewer cells", "`symmetry`"];
            let refused = done.status == 1 && done.stdout.is_empty() && words.iter().all(|word| said.contains(word));
            wrong.unless(refused, || format!("{command}, {kilobytes} kB: {done:#?}"));
            wrong.unless(case.names(".") == ["plate"], || format!("{command}: it leaves something"));
        }
    }
    wrong.count()
}

fn full_disk() -> f64 {
    let before = strip();
    let now = strip().scene("mass = \"2.49 kg\"", "mass = \"2 kg\"");
    let mut wrong = Wrong::default();
    for command in ["run", "modes", "matrices"] {
        before.fem(command, &["--out", "out"]).good();
        now.fem(command, &["--out", "whole"]).good();
        let names = before.names("out");
        for kilobytes in [0, 1, 4, 32] {
            let out = now.folder().join("out");
            let _ = fs::remove_dir_all(&out);
            for part in ["", ".fem"] {
                fs::create_dir(out.join(part)).unwrap();
                for name in before.names(&format!("out/{part}")).iter().filter(|name| *name != ".fem") {
                    let name = Path::new(part).join(name);
                    fs::copy(before.folder().join("out").join(&name), out.join(&name)).unwrap();
                }
            }
            let scene = now.write();
            let cut = format!("trap '' XFSZ; ulimit -f {kilobytes}");
            let done = done(shell(now.folder(), &cut, &[command, scene, "--out", "out"]).output().unwrap());
            let lists = ["whole/.fem/manifest", "out/.fem/manifest"].map(str::to_owned);
            let files = names.iter().map(|name| format!("whole/{name}")).filter(|name| !name.ends_with(".fem"));
            let fits = lists
                .into_iter()
                .chain(files)
                .all(|file| fs::metadata(now.folder().join(file)).unwrap().len() <= kilobytes << 10);
            let says =
                done.status == 1 && flat(&done.stderr).contains("cannot write `out/") && done.stderr.contains("limit");
            wrong
                .unless(if fits { done.status == 0 } else { says }, || format!("{command}, {kilobytes} kB: {done:#?}"));
            wrong.unless(now.names("out") == names, || format!("{command}, {kilobytes} kB: {:?}", now.names("out")));
            for name in names.iter().filter(|name| ![".fem", "cost.json"].contains(&name.as_str())) {
                let read =
                    |case: &support::Case, folder: &str| fs::read(case.folder().join(folder).join(name)).unwrap();
                let found = read(&now, "out");
                let whole = found == read(&before, "out") || found == read(&now, "whole");
                wrong.unless(whole, || format!("{command}, {kilobytes} kB: {name} is not a whole file"));
            }
        }
        fs::remove_dir_all(before.folder().join("out")).unwrap();
        fs::remove_dir_all(now.folder().join("out")).unwrap();
        fs::remove_dir_all(now.folder().join("whole")).unwrap();
    }
    wrong.count()
}

fn folders() -> f64 {
    let case = strip();
    case.write();
    let _held = OutputDir::create(case.folder().join("held")).unwrap();
    let mut wrong = Wrong::default();
    for command in ["run", "modes", "matrices"] {
        for (folder, remedy) in [
            ("plate/plate.msh", "choose a folder, not a file"),
            ("plate/plate.msh/results", "choose a folder, not a file"),
            // Also the superuser may not write there.
            ("/sys/fem-results", "choose a folder that you may write"),
            ("held", "wait for it to end or choose another folder"),
        ] {
            let done = case.fem(command, &["--out", folder]);
            let said = flat(&done.stderr);
            let refused = done.status == 1 && said.contains(folder) && said.contains(remedy);
            wrong.unless(refused, || format!("{command} into {folder}: {done:#?}"));
        }
    }
    wrong.unless(case.names("held") == [".fem"], || format!("{:?}", case.names("held")));
    wrong.count()
}

fn kill(signal: &str, run: &Child) {
    assert!(Command::new("kill").args([signal, &run.id().to_string()]).status().unwrap().success());
}

/// A march of so many milliseconds, 10 000 steps each.
fn lasting(end: u32) -> support::Case {
    watched().scene("end = \"20 us\"", &format!("end = \"{end} ms\"")).append(OFTEN)
}

fn signals() -> f64 {
    let mut wrong = Wrong::default();
    for (signal, status) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        let case = lasting(1000);
        let mut run = case.spawn(&["--out", "out"]);
        assert!(case.new_checkpoint(&mut run, &None), "the march lasts");
        kill(signal, &run);
        let done = done(run.wait_with_output().unwrap());
        let said = done.stderr.contains("Stopped by a signal at") && done.stderr.trim_end().ends_with("--resume");
        wrong.unless(done.status == status && said, || format!("{signal}: {done:#?}"));
        wrong.unless(case.names("out") == [".fem", "checkpoint.bin"], || format!("{:?}", case.names("out")));
    }
    // Twice: at once, whatever the first one has begun.
    let case = lasting(1000);
    let mut run = case.spawn(&["--out", "out"]);
    assert!(case.new_checkpoint(&mut run, &None), "the march lasts");
    kill("-INT", &run);
    kill("-INT", &run);
    let twice = done(run.wait_with_output().unwrap());
    wrong.unless(twice.status == 130, || format!("twice: {twice:#?}"));
    // A closed terminal means nothing to a run that was told so.
    let case = watched();
    let scene = case.write();
    let nohup = shell(case.folder(), "trap '' HUP", &["run", scene, "--out", "out"]).stdout(Stdio::null()).spawn();
    let mut run = nohup.unwrap();
    let comm = format!("/proc/{}/comm", run.id());
    while fs::read_to_string(&comm).unwrap() != "fem\n" {
        std::thread::sleep(Duration::from_millis(1));
    }
    while run.try_wait().unwrap().is_none() {
        // It may have ended since.
        let _ = Command::new("kill").args(["-HUP", &run.id().to_string()]).stderr(Stdio::null()).status().unwrap();
        std::thread::sleep(Duration::from_millis(5));
    }
    wrong.unless(run.wait().unwrap().code() == Some(0), || "nohup: it does not end well".into());
    wrong.count()
}

fn kills() -> f64 {
    let case = lasting(10);
    let mut random = 1_u64;
    for k in 0..20 {
        let before = fs::read(case.folder().join("out/checkpoint.bin")).ok();
        let resume = before.as_ref().map(|_| "--resume");
        let mut run = case.spawn(&["--out", "out"].into_iter().chain(resume).collect::<Vec<_>>());
        // Every second one anywhere, the others in the march: in a step, in a write, between two renames.
        assert!(k % 2 == 0 || case.new_checkpoint(&mut run, &before), "the march lasts for {k} kills");
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        std::thread::sleep(Duration::from_micros((random >> 33) % 40_000));
        run.kill().unwrap();
        run.wait().unwrap();
    }
    let case = case.scene(OFTEN, "");
    case.fem("run", &["--out", "straight"]).good();
    case.fem("run", &["--out", "out", "--resume"]).good();
    assert!(case.names("out").len() >= 6);
    case.differing("straight", "out").len() as f64
}

fn damaged() -> f64 {
    let case = strip();
    case.fem("run", &["--out", "out"]).good();
    let path = case.folder().join("out/checkpoint.bin");
    let whole = fs::read(&path).unwrap();
    let mut wrong = Wrong::default();
    for k in 0..12 {
        let at = k * whole.len() / 12;
        let mut flipped = whole.clone();
        flipped[at] ^= 1 << (k % 8);
        for bytes in [&whole[..at], &flipped] {
            fs::write(&path, bytes).unwrap();
            let done = case.fem("run", &["--out", "out", "--resume"]);
            let refused = done.status == 1 && flat(&done.stderr).contains("is damaged: it");
            wrong.unless(refused, || format!("{} of {} bytes, {at}: {done:#?}", bytes.len(), whole.len()));
            wrong.unless(fs::read(&path).unwrap() == bytes, || "the damaged file is another one now".into());
        }
    }
    wrong.count()
}

fn no_output() -> f64 {
    let case = strip();
    let scene = case.write();
    let mut commands = vec![vec!["--help"], vec!["check", scene], vec!["run", scene]];
    commands.push(vec!["envelope", "AS4/3502", "--criteria", "tsai-wu", "--out", "envelope"]);
    for what in ["elements", "criteria", "contact-laws", "integrators", "reductions", "materials"] {
        commands.push(vec!["list", what]);
    }
    let mut wrong = Wrong::default();
    for arguments in commands {
        for (before, status) in [("true", 0), ("exec >&-", 0), ("exec >/dev/full", 1)] {
            let mut command = shell(case.folder(), before, &arguments);
            let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
            drop(child.stdout.take());
            let done = done(child.wait_with_output().unwrap());
            // Help is printed by another crate, which takes every end of it for a good one.
            let status = if arguments[0] == "--help" { 0 } else { status };
            let panics = done.stderr.contains("panicked");
            wrong.unless(done.status == status && !panics, || format!("{arguments:?}, {before}: {done:#?}"));
        }
    }
    wrong.count()
}
