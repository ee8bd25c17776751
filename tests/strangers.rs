//! Folders that somebody else has filled, by mistake or with intent: nothing outside them changes, nothing of them runs,
//! nothing waits.
#![cfg(unix)]

use crate::support::{Case, Done, failing, fem, strip, watched};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Runs `fem` and takes for endless what lasts longer than a busy machine explains.
fn at_once(folder: &Path, arguments: &[&str]) -> Done {
    let mut child = Command::new(env!("CARGO_BIN_EXE_fem"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let started = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if started.elapsed() > Duration::from_secs(20) {
            child.kill().unwrap();
            panic!("{arguments:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().unwrap();
    Done {
        status: output.status.code().unwrap(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// All that lies below a folder: files with their content, links with what they lead to.
fn tree(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let is = path.symlink_metadata().unwrap();
        if is.is_dir() {
            all.extend(tree(&path));
        }
        let content = match () {
            () if is.is_file() => fs::read(&path).unwrap(),
            () if is.is_symlink() => fs::read_link(&path).unwrap().as_os_str().as_encoded_bytes().to_vec(),
            () => Vec::new(),
        };
        all.insert(path.to_str().unwrap().to_owned(), content);
    }
    all
}

fn pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

/// A finished run in `out`, and a folder beside it with files that nothing may touch.
fn finished() -> Case {
    let case = failing();
    case.fem("run", &["--out", "out"]).good();
    let outside = case.folder().join("outside");
    fs::create_dir(&outside).unwrap();
    fs::write(outside.join("precious"), "precious").unwrap();
    fs::create_dir(outside.join("empty")).unwrap();
    case
}

/// Every file of a run, one after the other, as a link to a file, to a folder, to nothing and to a device, as a pipe and as a
/// file without end, for all that reads and writes the folder.
#[test]
fn links_pipes_devices_and_endless_files() {
    let case = finished();
    let out = case.folder().join("out");
    let names = case.names("out").into_iter().chain([".fem/lock".into(), ".fem/manifest".into(), "fields".into()]);
    // Pictures take longer than the rest.
    let case = case.append("[output]\nplots = false\n");
    let scene = case.write();
    for (i, name) in names.enumerate() {
        let path = out.join(&name);
        let kept = case.folder().join("kept");
        let _ = fs::rename(&path, &kept);
        match i % 6 {
            0 => symlink("../outside/precious", &path).unwrap(),
            1 => symlink("../outside/empty", &path).unwrap(),
            2 => symlink("../outside/absent", &path).unwrap(),
            3 => symlink("/dev/zero", &path).unwrap(),
            4 => pipe(&path),
            _ => fs::File::create(&path).unwrap().set_len(1 << 42).unwrap(),
        }
        let outside = tree(&case.folder().join("outside"));
        let run = &["run", scene, "--out", "out", "--resume"][..5 - (i + i / 6) % 2];
        for arguments in [&["report", "out"][..], run] {
            let done = at_once(case.folder(), arguments);
            let refused = done.status == 1 && done.stderr.contains("out") && !done.stderr.contains("panicked");
            assert!(done.status == 0 || refused, "{name} {arguments:?}: {done:#?}");
            let said = arguments[0] != "report" || done.status == 0 || i % 6 > 3 || done.stderr.contains("is a link");
            assert!(said, "{name}: {done:#?}");
            assert_eq!(tree(&case.folder().join("outside")), outside, "{name} {arguments:?}");
        }
        if path.is_dir() && !path.is_symlink() {
            fs::remove_dir_all(&path).unwrap();
        } else {
            // A run may have removed it as one of an earlier one.
            let _ = fs::remove_file(&path);
        }
        let _ = fs::rename(&kept, &path);
    }
}

/// Results that are not ours: they are named and left as they are, and so is everything beside them.
#[test]
fn what_no_run_has_written_is_neither_replaced_nor_removed() {
    let case = strip().append("[output]\nplots = false\n");
    let scene = case.write();
    let mine = case.folder().join("mine");
    fs::create_dir(&mine).unwrap();
    for name in ["notes.txt", "history.csv", ".my-download.partial"] {
        fs::write(mine.join(name), "mine").unwrap();
    }
    let before = tree(&mine);
    for command in ["run", "modes", "matrices", "study"] {
        let done = case.fem(command, &["--out", "mine"]);
        assert!(done.status == 1 && done.stderr.contains("history.csv"), "{done:#?}");
        assert_eq!(tree(&mine), before, "{command}");
    }
    // Among results, what is not listed or was changed stays.
    case.fem("run", &["--out", "out"]).good();
    let out = case.folder().join("out");
    fs::write(out.join("notes.txt"), "mine").unwrap();
    fs::write(out.join(".my-download.partial"), "mine").unwrap();
    fs::write(out.join("energy.svg"), "mine").unwrap();
    let case = case.scene("plots = false", "plots = true");
    let done = case.fem("run", &["--out", "out"]);
    assert!(done.status == 1 && done.stderr.contains("out/energy.svg"), "{done:#?}");
    fs::remove_file(out.join("energy.svg")).unwrap();
    let case = case.scene("plots = true", "plots = false");
    fs::write(out.join("history.csv"), "mine").unwrap();
    let done = case.fem("run", &["--out", "out"]);
    assert!(done.status == 1 && done.stderr.contains("out/history.csv") && done.stdout.is_empty(), "{done:#?}");
    fs::remove_file(out.join("history.csv")).unwrap();
    case.fem("run", &["--out", "out"]).good();
    for name in ["notes.txt", ".my-download.partial"] {
        assert_eq!(case.read(&format!("out/{name}")), "mine");
    }
    // A scene whose own folder takes the results keeps it, also from a study that writes a better one.
    let text = case.read(scene);
    let done = case.fem("study", &["--out", "plate", "--axis", "step", "--budget", "1s", "--tolerance", "90%"]);
    assert!(done.status == 1 && done.stderr.contains("plate/scene.toml"), "{done:#?}");
    assert_eq!(case.read(scene), text);
}

/// A page of a folder in which every text is a script, every name another, and every picture tries what pictures can.
#[test]
fn scripts_in_every_file_stay_texts() {
    let case = finished();
    let out = case.folder().join("out");
    let evil = "</title></script><script>alert(1)</script><img src=x onerror=alert(2)>\u{1b}[2J";
    let quoted = evil.replace('\u{1b}', "\\u001b");
    for name in ["summary.json", "cost.json", "damage.json"] {
        let text = case.read(&format!("out/{name}"));
        // Every text of the document, but for keys that are read by name.
        let text =
            text.replace("\": \"", &format!("\": \"{quoted}")).replace("\"mode\":\"", &format!("\"mode\":\"{quoted}"));
        fs::write(out.join(name), text).unwrap();
    }
    fs::write(out.join("events.csv"), format!("time_s,{evil}\n0.1,{evil}\n")).unwrap();
    fs::write(out.join("modes.csv"), format!("{evil}\n{evil}\n")).unwrap();
    fs::write(out.join("scene.toml"), evil).unwrap();
    fs::remove_dir_all(out.join(".fem")).unwrap();
    let name = "profile-<img src=x onerror=alert(3)>\u{1b}[2J.svg";
    fs::copy(out.join("energy.svg"), out.join(name)).unwrap();
    let done = at_once(case.folder(), &["report", "out"]).good();
    assert!(!done.stdout.contains('\u{1b}'));
    let page = case.read("out/report.html");
    for script in ["<script>alert", "<img src=x", "<img"] {
        assert!(!page.contains(script), "{script}");
    }
    let policy =
        page.split("http-equiv=\"Content-Security-Policy\" content=\"").nth(1).unwrap().split('"').next().unwrap();
    assert!(policy.starts_with("default-src 'none'") && !policy.contains("unsafe"), "{policy}");
    // Each picture spoilt in turn: single quotes, other elements, other loads.
    let good = case.read("out/energy.svg");
    for (from, to) in [
        ("<rect ", "<rect onload='alert(1)' "),
        ("<title>", "<script>alert(1)</script><title>"),
        ("fill=\"#fff\"", "fill=\"url(http://example.org/x)\""),
        ("</svg>", "<image href='http://example.org/x'/></svg>"),
        ("<title>", "<!DOCTYPE x><title>"),
    ] {
        fs::write(out.join("energy.svg"), good.replacen(from, to, 1)).unwrap();
        let done = at_once(case.folder(), &["report", "out"]);
        assert!(done.status == 1 && done.stderr.contains("energy.svg"), "{to}: {done:#?}");
    }
}

/// What steers a terminal, in the scene, its mesh, the folder's files and their names.
#[test]
fn no_file_steers_the_terminal() {
    let steers =
        |text: &str| text.contains(|c: char| c.is_control() && !"\n\t".contains(c)) || text.contains('\u{202e}');
    let (raw, escaped) = ("\u{1b}[2J\u{7}\u{9b}31m\u{202e}", "\\u001b[2J\\u0007\\u009b31m\\u202e");
    let strip = || strip().append("[output]\nplots = false\n");
    let titled = strip().scene("title = \"", &format!("title = \"{escaped}"));
    let group = strip().scene("group = \"clamped\"", &format!("group = \"{escaped}\""));
    let broken = strip().append(&format!("# {raw}\n[[[\n"));
    let mesh = strip().mesh("\"plate\"", &format!("\"{raw}\""));
    for (case, status) in [(titled, 0), (group, 1), (broken, 1), (mesh, 0)] {
        for command in [&["check"][..], &["run", "-v"], &["mesh"], &["check", "--json"]] {
            let done = case.fem(command[0], &command[1..]);
            assert!(!steers(&done.stdout) && !steers(&done.stderr), "{command:?}: {done:?}");
            assert!(done.status <= status || command[0] == "mesh", "{command:?}: {done:#?}");
        }
    }
    let case = watched();
    case.fem("run", &["--out", "out"]).good();
    for (file, text) in [("history.csv", format!("time_s,a\n{raw},1\n")), ("energy.svg", format!("<{raw}"))] {
        let path = case.folder().join("out").join(file);
        let good = fs::read(&path).unwrap();
        fs::write(&path, text).unwrap();
        let done = fem(case.folder(), &["report", "out"]);
        assert!(done.status == 1 && !steers(&done.stderr), "{done:?}");
        fs::write(&path, good).unwrap();
    }
}

/// Files of the user's own, by mistake something else: said at once, with the file's name.
#[test]
fn scenes_and_meshes_that_are_no_files() {
    let case = strip();
    let scene = case.write();
    let folder = case.folder();
    pipe(&folder.join("pipe.toml"));
    pipe(&folder.join("plate/pipe.msh"));
    fs::create_dir(folder.join("plate/folder.msh")).unwrap();
    symlink("/dev/zero", folder.join("plate/zero.msh")).unwrap();
    fs::File::create(folder.join("plate/huge.msh")).unwrap().set_len(1 << 42).unwrap();
    symlink("plate.msh", folder.join("plate/link.msh")).unwrap();
    for (file, words) in [
        ("pipe.msh", "a pipe or a device"),
        ("folder.msh", "a folder"),
        ("zero.msh", "a pipe or a device"),
        ("huge.msh", "longer than"),
        ("../../absent.msh", "No such file"),
    ] {
        let text = case.read(scene).replace("plate.msh", file);
        fs::write(folder.join("plate/other.toml"), text).unwrap();
        let done = at_once(folder, &["check", "plate/other.toml"]);
        assert!(done.status == 1 && done.stderr.contains(file) && done.stderr.contains(words), "{file}: {done:#?}");
    }
    let text = case.read(scene).replace("plate.msh", "link.msh");
    fs::write(folder.join("plate/other.toml"), text).unwrap();
    at_once(folder, &["check", "plate/other.toml"]).good();
    for scene in ["pipe.toml", "/dev/zero", "plate"] {
        let done = at_once(folder, &["check", scene]);
        assert!(done.status == 1 && done.stderr.contains("only files are read"), "{scene}: {done:#?}");
    }
}
