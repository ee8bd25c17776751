//! A march that is stopped and resumed finds what it finds in one piece.

use crate::support::{Case, Done, OFTEN, fem, strip, watched};
use fem::analyses::impact::{self, Checkpoint, March, Outcome, Prepared};
use fem::io::{checkpoint, files::OutputDir, scene};
use fem::{Model, Registry};
use std::fs;
use std::num::NonZeroUsize;
use std::process::Command;
use std::time::Duration;

/// Compares all files of two folders of results but what the machine has to say, `cost.json`.
#[track_caller]
fn same(case: &Case, a: &str, b: &str) {
    let names = case.names(a);
    assert!(names.len() >= 6 && names.contains(&"checkpoint.bin".to_owned()), "{names:?}");
    assert_eq!(case.differing(a, b), [""; 0]);
}

#[test]
fn killed_at_any_moment_and_resumed() {
    let case = watched().scene("end = \"20 us\"", "end = \"600 us\"").append(OFTEN);
    let mut arguments = vec!["--out", "out"];
    let (mut kills, mut before) = (0, None);
    for delay in 0..6 {
        let mut run = case.spawn(&arguments);
        if !case.new_checkpoint(&mut run, &before) {
            break;
        }
        // Somewhere in a step, in a write, between two renames.
        std::thread::sleep(Duration::from_micros(2700 * delay));
        run.kill().unwrap();
        run.wait().unwrap();
        // Whole, old or new.
        let path = case.folder().join("out/checkpoint.bin");
        checkpoint::read(&path).unwrap();
        before = Some(fs::read(path).unwrap());
        arguments = vec!["--out", "out", "--resume"];
        kills += 1;
    }
    assert!(kills >= 2, "{kills} kills");
    let case = case.scene(OFTEN, "");
    case.fem("run", &["--out", "straight"]).good();
    case.fem("run", &["--out", "out", "--resume"]).good();
    same(&case, "straight", "out");
    // Once more: there is nothing left to march, and the files are the same.
    case.fem("run", &["--out", "out", "--resume"]).good();
    same(&case, "straight", "out");
}

#[cfg(unix)]
#[test]
fn signals_stop_a_march_after_a_checkpoint() {
    let case = watched().scene("end = \"20 us\"", "end = \"2 ms\"").append(OFTEN);
    let mut arguments = vec!["--out", "out"];
    let mut before = None;
    for (signal, status) in [("-TERM", 143), ("-INT", 130)] {
        let mut run = case.spawn(&arguments);
        assert!(case.new_checkpoint(&mut run, &before), "the march lasts");
        let killed = Command::new("kill").args([signal, &run.id().to_string()]).status().unwrap();
        assert!(killed.success());
        let done = run.wait_with_output().unwrap();
        assert_eq!(done.status.code(), Some(status));
        let said = String::from_utf8(done.stderr).unwrap();
        assert!(said.contains("Stopped by a signal at") && said.trim_end().ends_with("--out out --resume"), "{said}");
        assert_eq!(case.names("out"), [".fem", "checkpoint.bin"]);
        before = Some(fs::read(case.folder().join("out/checkpoint.bin")).unwrap());
        arguments = vec!["--out", "out", "--resume"];
    }
    let case = case.scene(OFTEN, "");
    case.fem("run", &arguments).good();
    case.fem("run", &["--out", "straight"]).good();
    same(&case, "straight", "out");
}

#[test]
fn a_later_end_goes_on_from_a_finished_run() {
    // Ends between two rows and two samples: what closes the shorter run is not in the longer one.
    let until = |end: &str| watched().scene("end = \"20 us\"", &format!("end = \"{end}\""));
    let long = until("61.5 us");
    long.fem("run", &["--out", "straight"]).good();
    let short = until("20.5 us");
    short.fem("run", &["--out", "out"]).good();
    fs::rename(short.folder().join("out"), long.folder().join("out")).unwrap();
    long.fem("run", &["--out", "out", "--resume"]).good();
    same(&long, "straight", "out");
}

#[test]
fn rows_of_the_history_stay_as_far_apart_as_they_were() {
    let until = |end: &str| strip().scene("end = \"20 us\"", &format!("step = \"0.5 us\"\nend = \"{end}\""));
    let (short, long) = (until("0.5 ms"), until("1.5 ms"));
    short.fem("run", &["--out", "out"]).good();
    fs::rename(short.folder().join("out"), long.folder().join("out")).unwrap();
    long.fem("run", &["--out", "out", "--resume"]).good();
    // One row per step, where a run of 3000 steps would write every other one.
    assert_eq!(long.table("out/history.csv").1.len(), 3001);
}

#[test]
fn a_march_that_stopped_is_stopped_when_resumed() {
    let leaks = strip().scene("end = \"20 us\"", "step = \"1 ms\"\nend = \"10 ms\"");
    let no_index = "criteria = [{ name = \"expression\", expression = \"0.5 * sqrt(1 - abs(s1) / (100*kPa))\" }]";
    let no_index = strip().scene("criteria = [\"hashin-report\", \"octahedral\"]", no_index);
    for (case, why) in [(leaks, "energy error"), (no_index, "has no index")] {
        assert_eq!(case.fem("run", &["--out", "straight"]).status, 1);
        assert_eq!(case.fem("run", &["--out", "out"]).status, 1);
        let done = case.fem("run", &["--out", "out", "--resume"]);
        assert!(done.status == 1 && done.stdout.contains("STOPPED") && done.stdout.contains(why), "{done:#?}");
        same(&case, "straight", "out");
    }
}

/// What a resume is refused with, on one line.
#[track_caller]
fn refused(done: &Done, words: &[&str]) {
    assert_eq!((done.status, done.stdout.as_str()), (1, ""), "{done:#?}");
    let said = done.stderr.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    for words in words {
        assert!(said.contains(words), "{words:?} is not in {said}");
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let case = strip();
    refused(&case.fem("run", &["--resume"]), &["there is no checkpoint in `results/plate`", "without `--resume`"]);
    assert_eq!(case.names("."), ["plate"], "a refusal leaves no folder");
    case.fem("run", &["--out", "out"]).good();
    let path = case.folder().join("out/checkpoint.bin");
    let whole = fs::read(&path).unwrap();

    let resume = |other: Case| {
        let out = other.folder().join("out");
        fs::create_dir(&out).unwrap();
        fs::write(out.join("checkpoint.bin"), &whole).unwrap();
        let done = other.fem("run", &["--out", "out", "--resume"]);
        assert!(done.status == 0 || fs::read(out.join("checkpoint.bin")).unwrap() == whole);
        done
    };
    let mass = strip().scene("mass = \"2.49 kg\"", "mass = \"2.5 kg\"");
    let named = "belongs to another run: `impactor.mass` was \"2.49 kg\" and is \"2.5 kg\"";
    refused(&resume(mass), &[named, "run without `--resume`"]);
    let mesh = strip().mesh("$EndElements", "$EndElements\n");
    refused(&resume(mesh), &["`mesh.file` was", "CRC-32"]);
    let preset = strip().scene("title = ", "fidelity = \"reference\"\ntitle = ");
    refused(&resume(preset), &["`fidelity` was left out", "more"]);
    let step = strip().scene("end = \"20 us\"", "end = \"20.05 us\"");
    refused(&resume(step), &["its step was 1e-7 s", "must be a whole number of steps"]);
    let early = strip().scene("end = \"20 us\"", "end = \"10 us\"");
    refused(&resume(early), &["beyond `march.end`", "a later one"]);
    // Nothing that changes a number.
    let title = strip().scene("title = \"", "title = \"Again: ").append("[output]\nplots = false\nmaps = true\n");
    resume(title).good();

    for (at, words) in [(0, "does not begin"), (whole.len() / 2, "its checksum is wrong")] {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        fs::write(&path, bytes).unwrap();
        refused(&case.fem("run", &["--out", "out", "--resume"]), &["is damaged", words, "without `--resume`"]);
    }
    fs::write(&path, &whole[..whole.len() - 1]).unwrap();
    refused(&case.fem("run", &["--out", "out", "--resume"]), &["is damaged", "its length"]);

    fs::write(&path, &whole).unwrap();
    let mut other = checkpoint::read(&path).unwrap();
    assert_eq!(&other[1..6], env!("CARGO_PKG_VERSION").as_bytes());
    other[1] = b'9';
    checkpoint::write(&OutputDir::create(case.folder().join("out")).unwrap(), "checkpoint.bin", &other).unwrap();
    let theirs = format!("was written by version 9{}", &env!("CARGO_PKG_VERSION")[1..]);
    refused(&case.fem("run", &["--out", "out", "--resume"]), &[&theirs, "start over"]);
}

#[test]
fn only_a_march_can_be_resumed() {
    let scene = crate::support::root().join("examples/pagano-0-90-0/scene.toml");
    let folder = tempfile::tempdir().unwrap();
    refused(&fem(folder.path(), &["run", scene.to_str().unwrap(), "--resume"]), &["there is nothing to resume"]);
}

/// What a march found, but for the time that it took.
fn found(outcome: Outcome) -> String {
    format!("{:?}", Outcome { phases: Vec::new(), ..outcome })
}

/// Every integrator, with and without a reduction, saved after every few steps: results and work are those of a march in
/// one piece.
#[test]
fn every_integrator_goes_on_as_if_nothing_had_been() {
    for (integrator, reduction, step) in [
        ("newmark", "ritz", "0.5 us"),
        ("newmark", "none", "0.5 us"),
        ("hht-alpha", "none", "0.5 us"),
        ("generalized-alpha", "none", "0.5 us"),
        ("central-difference", "none", "0.01 us"),
        ("rk4", "none", "0.01 us"),
        ("dormand-prince", "none", "0.1 us"),
        ("energy-conserving", "none", "0.5 us"),
        ("energy-conserving\"\ntolerance = 1e-4\n#\"", "ritz", "2 us"),
        ("energy-conserving\"\ntolerance = 1e-3\n#\"", "none", "2 us"),
    ] {
        let steps = 37.0 * step.trim_end_matches(" us").parse::<f64>().unwrap();
        let case = strip()
            .scene("[march]", &format!("[reduction]\nmethod = \"{reduction}\"\n[march]\nintegrator = \"{integrator}\""))
            .scene("end = \"20 us\"", &format!("step = \"{step}\"\nend = \"{steps} us\""));
        let path = case.folder().join(case.write());
        let model = Model::new(scene::read(&path).unwrap(), &Registry::standard()).unwrap();
        let prepared = || -> Prepared<'_> { impact::prepare(&model, NonZeroUsize::MIN).unwrap() };
        let straight = impact::march(prepared(), |_| {}).unwrap();
        assert!(straight.counters.steps == 37 && straight.stopped.is_none(), "{integrator}: {:?}", straight.stopped);

        let dir = OutputDir::create(case.folder().join("out")).unwrap();
        let mut march = March::start(prepared()).unwrap();
        for steps in [1, 2, 17, 16] {
            for _ in 0..steps {
                march.advance();
            }
            march.save(&dir).unwrap();
            march = March::resume(prepared(), Checkpoint::read(dir.path(), &model).unwrap()).unwrap();
        }
        while !march.done() {
            march.advance();
        }
        assert_eq!(found(march.finish()), found(straight), "{integrator}, {reduction}");
    }
}
