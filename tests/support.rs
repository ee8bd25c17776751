//! Runs the command on variations of the examples.

use fem::io::plot::{self, Style};
use fem::io::scene::{self, Scene, Setting};
use fem::job::{self, Finished, Found, ImpactFound, Options};
use fem::{Error, Model, Registry};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A scene and its mesh in `plate/` of a folder of their own, which is the working folder of the command.
pub(crate) struct Case {
    folder: TempDir,
    scene: String,
    mesh: Vec<u8>,
}

impl Case {
    /// An example as it is.
    pub(crate) fn example(name: &str) -> Self {
        let example = root().join("examples").join(name);
        Self {
            folder: tempfile::tempdir().unwrap(),
            scene: whole(&fs::read_to_string(example.join("scene.toml")).unwrap()),
            mesh: fs::read(example.join("plate.msh")).unwrap(),
        }
    }

    /// The same with another text in the scene.
    pub(crate) fn scene(mut self, from: &str, to: &str) -> Self {
        self.scene = replaced(&self.scene, from, to);
        self
    }

    /// The same mesh with another scene.
    pub(crate) fn text(mut self, scene: &str) -> Self {
        self.scene = scene.to_owned();
        self
    }

    /// The same with more lines at the end of the scene.
    pub(crate) fn append(mut self, lines: &str) -> Self {
        self.scene.push_str(lines);
        self
    }

    /// The same with another text in the mesh.
    pub(crate) fn mesh(mut self, from: &str, to: &str) -> Self {
        self.mesh = replaced(std::str::from_utf8(&self.mesh).unwrap(), from, to).into_bytes();
        self
    }

    /// The same with another mesh.
    pub(crate) fn mesh_bytes(mut self, mesh: impl Into<Vec<u8>>) -> Self {
        self.mesh = mesh.into();
        self
    }

    /// The same with a mesh of `tests/data/mesh`.
    pub(crate) fn mesh_file(self, name: &str) -> Self {
        let mesh = fs::read(root().join("tests/data/mesh").join(name)).unwrap();
        self.mesh_bytes(mesh)
    }

    /// The working folder.
    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Path of the scene from the working folder, for commands run without [`Case::fem`].
    pub(crate) fn write(&self) -> &'static str {
        let plate = self.folder().join("plate");
        fs::create_dir_all(&plate).unwrap();
        fs::write(plate.join("plate.msh"), &self.mesh).unwrap();
        fs::write(plate.join("scene.toml"), &self.scene).unwrap();
        "plate/scene.toml"
    }

    /// Runs `fem COMMAND plate/scene.toml OPTIONS`.
    pub(crate) fn fem(&self, command: &str, options: &[&str]) -> Done {
        let scene = self.write();
        fem(self.folder(), &[&[command, scene], options].concat())
    }

    /// Starts `fem run plate/scene.toml OPTIONS` and does not wait for it. It hears all signals, also where the tests were
    /// started in the background of a script, whose Ctrl-C is ignored by all that descends from it.
    pub(crate) fn spawn(&self, options: &[&str]) -> Child {
        let scene = self.write();
        let fem = env!("CARGO_BIN_EXE_fem");
        let mut command = Command::new(if cfg!(target_os = "linux") { "env" } else { fem });
        if cfg!(target_os = "linux") {
            command.args(["--default-signal=INT,TERM,HUP", fem]);
        }
        command
            .args([&["run", scene], options].concat())
            .current_dir(self.folder())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    }

    /// Waits until the checkpoint in `out` is another one than `before`; `false` if the run ends first.
    pub(crate) fn new_checkpoint(&self, run: &mut Child, before: &Option<Vec<u8>>) -> bool {
        let path = self.folder().join("out/checkpoint.bin");
        let started = Instant::now();
        while started.elapsed() < Duration::from_secs(120) {
            if run.try_wait().unwrap().is_some() {
                return false;
            }
            if let Ok(now) = fs::read(&path)
                && Some(&now) != before.as_ref()
            {
                return true;
            }
            std::thread::sleep(Duration::from_micros(300));
        }
        panic!("no checkpoint within two minutes");
    }

    /// Files that two folders of results do not have in common, but for what the machine has to say, `cost.json`.
    pub(crate) fn differing(&self, a: &str, b: &str) -> Vec<String> {
        let read = |folder: &str, name: &str| fs::read(self.folder().join(folder).join(name)).ok();
        let mut names = [self.names(a), self.names(b)].concat();
        names.sort();
        names.dedup();
        names.retain(|name| if name == "cost.json" { false } else { read(a, name) != read(b, name) });
        names
    }

    /// Names in a folder below the working folder, sorted; none where it does not exist.
    pub(crate) fn names(&self, folder: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.folder().join(folder)) else { return Vec::new() };
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// A text file below the working folder.
    pub(crate) fn read(&self, file: &str) -> String {
        fs::read_to_string(self.folder().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
    }

    /// `summary.json` of a folder of results.
    pub(crate) fn summary(&self, results: &str) -> Value {
        serde_json::from_str(&self.read(&format!("{results}/summary.json"))).unwrap()
    }

    /// A table of a folder of results: its header and its rows.
    pub(crate) fn table(&self, file: &str) -> (Vec<String>, Vec<Vec<String>>) {
        let text = self.read(file);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let row = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
        let header = row(reader.headers().unwrap());
        (header, reader.records().map(|r| row(&r.unwrap())).collect())
    }
}

/// A scene without its symmetry and what is said of it: tests go on to change what symmetry asks for.
pub(crate) fn whole(scene: &str) -> String {
    let lines = scene.split_inclusive('\n');
    lines.filter(|line| !line.starts_with("symmetry = ") && !line.contains("half a turn")).collect()
}

/// A circular plate on a ring.
pub(crate) fn plate() -> Case {
    Case::example("as4-3502-16ply-50mm")
}

/// Three plies of 6 x 6 cells that delaminate under 1 kg at 3 m/s, until `end_us`.
pub(crate) fn coming_apart(end_us: u32) -> Case {
    plate().text(&format!(
        "title = 'growth'\nmesh = {{ rectangle = ['48 mm', '40 mm'], cells = [6, 6] }}\nsymmetry = 'quarter'\n\
         element = {{ kind = 'hermite-prism' }}\neffects = {{ damage = 'off', delamination = 'growth' }}\n\
         support = [{{ group = 'x-min', kind = 'simply-supported' }}, {{ group = 'x-max', kind = 'simply-supported' }}]\n\
         impactor = {{ mass = '1 kg', velocity = '3 m/s', at = {{ x = '24 mm', y = '20 mm' }}, patch_radius = '4 mm' }}\n\
         contact = {{ law = 'hertz', k = '4e9 N/m^1.5' }}\nmarch = {{ step = '1 us', end = '{end_us} us' }}\n\
         laminate = {{ plies = '[0/90/0]', material = 'tape', ply_thickness = '1 mm' }}\n\
         [materials.tape]\nlibrary = 'IM7/8552'\nZt = '20 MPa'\nS13 = '25 MPa'\n"
    ))
}

/// A cantilever of 4 x 2 cells, struck in its middle: a run takes no time.
pub(crate) fn strip() -> Case {
    plate()
        .mesh_file("ascii.msh")
        .scene("group = \"support\"", "group = \"clamped\"")
        .scene("at = \"mid-plane\"", "at = \"all\"")
        .scene("fix = [\"U30\"]", "fix = [\"U10\", \"U20\", \"U30\"]")
        .scene("at = { group = \"impact\" }", "at = { x = \"15 mm\", y = \"5 mm\" }")
        .scene("end = \"1 ms\"", "end = \"20 us\"")
}

/// A checkpoint after every step, which makes a march last.
pub(crate) const OFTEN: &str = "checkpoint_every = \"1 ns\"\n";

/// A strip that is watched at a gauge, with everything that a run can write.
pub(crate) fn watched() -> Case {
    let criteria = "criteria = [\"hashin-report\", \"octahedral\"]";
    let watch = "watch = [{ at = { x = \"15 mm\", y = \"5 mm\" }, ply = 1 }]\nevery = \"1.5 us\"";
    let output = "[output]\nmaps = true\nmodes = 3\nhistory_every = \"1 us\"\n";
    strip().scene(criteria, &format!("{criteria}\n{watch}")).append(output)
}

/// A strip whose plies fail.
pub(crate) fn failing() -> Case {
    strip()
        .scene("end = \"20 us\"", "end = \"100 us\"")
        .scene("library = \"AS4/3502\"", "library = \"AS4/3502\", Yt = \"2 MPa\"")
}

/// The model of a scene with an impact, and what was found of it.
pub(crate) fn impact_of(scene: Scene) -> Result<(Model, ImpactFound), Error> {
    let Finished { model, found, .. } = job::run(&scene, &Registry::standard(), &Options::default(), &mut ())?;
    let Found::Impact(found) = found else { panic!("the scene has no impact") };
    assert_eq!(found.outcome.stopped, None);
    Ok((model, *found))
}

/// What a command left.
#[derive(Debug)]
pub(crate) struct Done {
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Done {
    /// The same, which must have succeeded.
    #[track_caller]
    pub(crate) fn good(self) -> Self {
        assert_eq!(self.status, 0, "{self:#?}");
        self
    }
}

/// The scene in the file `path` with other keys.
#[track_caller]
pub(crate) fn read_under(path: &Path, setting: &Setting) -> Scene {
    scene::under(&scene::read(path).unwrap().source, setting).unwrap()
}

/// Runs `fem` with `arguments` in `folder`.
pub(crate) fn fem(folder: &Path, arguments: &[&str]) -> Done {
    fem_reading(folder, arguments, "")
}

/// The same with `text` on standard input.
pub(crate) fn fem_reading(folder: &Path, arguments: &[&str], text: &str) -> Done {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fem"));
    command.args(arguments).current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut run = command.spawn().unwrap();
    // A command that does not read it closes the pipe.
    let _ = run.stdin.take().unwrap().write_all(text.as_bytes());
    let output = run.wait_with_output().unwrap();
    Done {
        status: output.status.code().expect("ended by a signal"),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Draws contact forces (s, N) of a test for the book, before the reference they are held against, where `UPDATE_BOOK` is set.
pub(crate) fn draw(name: &str, title: &str, ours: &[(f64, f64)], reference: (&str, &[(f64, f64)])) {
    if std::env::var_os("UPDATE_BOOK").is_none() {
        return;
    }
    let (times, forces): (Vec<_>, Vec<_>) = ours.iter().copied().unzip();
    let mut plot = plot::force_history(title, &times, &[("fem", forces)], &[]).unwrap();
    let (times, forces): (Vec<_>, Vec<_>) = reference.1.iter().copied().unzip();
    let theirs = plot::force_history(title, &times, &[(reference.0, forces)], &[]).unwrap();
    assert_eq!((&theirs.x, &theirs.y), (&plot.x, &plot.y), "one unit for both");
    plot.series.extend(theirs.series.into_iter().map(|curve| plot::Series { style: Style::Guide, ..curve }));
    let folder = root().join("docs/book/src/images/validation");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join(format!("{name}.svg")), plot::line_plot(&plot).unwrap().svg).unwrap();
}

/// The repository.
pub(crate) fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// `text` with `to` for `from`, which it must hold once.
fn replaced(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} stands once in {text}");
    text.replace(from, to)
}
