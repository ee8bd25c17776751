//! A job in memory, in a folder, broken off and gone on with.

use crate::support::{Case, impact_of, plate, read_under, watched};
use fem::job::{self, Finished, Follow, Found, KeptPlate, Options, Results, Task};
use fem::{Error, Registry, cost::Cost, io::scene};
use serde_json::Value;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

fn done(case: &Case, options: &Options, follow: &mut dyn Follow) -> Result<Finished, Error> {
    case.write();
    job::run(&scene::read(&case.folder().join("plate/scene.toml"))?, &Registry::standard(), options, follow)
}

fn into(results: Results) -> Options {
    Options { results, ..Options::default() }
}

/// Breaks a march off at this share, and counts the results that it hears of.
#[derive(Default)]
struct Until {
    share: Option<f64>,
    found: usize,
}

impl Follow for Until {
    fn marched(&mut self, share: f64) -> ControlFlow<()> {
        if self.share.is_some_and(|most| share >= most) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn found(&mut self, found: &Found, _: &Cost) {
        assert!(found.completed());
        self.found += 1;
    }
}

#[test]
fn in_memory_it_finds_what_the_command_writes() {
    let case = watched();
    let Finished { found, folder, .. } = done(&case, &Options::default(), &mut ()).unwrap();
    assert_eq!((folder, case.names(".")), (None, vec!["plate".to_owned()]));
    case.fem("run", &["--out", "out"]).good();
    let text = serde_json::to_string(&found).unwrap();
    assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), case.summary("out"));
    let Found::Impact(found) = found else { panic!("an impact") };
    assert_eq!(case.table("out/history.csv").1.len(), found.outcome.history.len());
}

#[test]
fn broken_off_and_gone_on_with_it_leaves_the_files_of_one_piece() {
    let case = watched();
    let folder = |name: &str| case.folder().join(name);
    let mut follow = Until { share: Some(0.5), found: 0 };
    let error = done(&case, &into(Results::Folder(folder("out"))), &mut follow).unwrap_err();
    let Error::Cancelled { time, share } = error else { panic!("{error}") };
    assert!((share - 0.5).abs() < 0.1 && (time / 20e-6 - share).abs() < 1e-9, "{time} {share}");
    assert_eq!((follow.found, case.names("out")), (0, vec![".fem".to_owned(), "checkpoint.bin".to_owned()]));
    let mut follow = Until::default();
    let finished = done(&case, &into(Results::Resumed(folder("out"))), &mut follow).unwrap();
    assert_eq!((follow.found, finished.folder), (1, Some(folder("out"))));
    case.fem("run", &["--out", "straight"]).good();
    assert_eq!(case.differing("straight", "out"), [""; 0]);
}

#[test]
fn modes_of_any_scene() {
    let case = plate().mesh_file("ascii.msh").scene("group = \"support\"", "group = \"clamped\"");
    let case = case.scene("at = { group = \"impact\" }", "at = { x = \"15 mm\", y = \"5 mm\" }");
    let modes = |results| Options { task: Task::Modes(NonZeroUsize::new(2)), ..into(results) };
    let Found::Modes(found) = done(&case, &modes(Results::InMemory), &mut ()).unwrap().found else { panic!("modes") };
    assert_eq!(found.summary.frequencies_Hz.len(), 2);
    let resumed = done(&case, &modes(Results::Resumed(case.folder().to_owned())), &mut ());
    assert!(matches!(resumed, Err(Error::NotMarched)));
}

#[test]
fn a_plate_that_is_kept_is_struck_as_by_runs_of_their_own() {
    let case = watched().append("[reduction]\nmethod = \"ritz\"\nvectors = 12\n");
    case.write();
    let (path, registry) = (case.folder().join("plate/scene.toml"), Registry::standard());
    let read = |key: &str, value: &str| read_under(&path, &[(key.into(), value.into())].into());
    let plate = KeptPlate::new(&scene::read(&path).unwrap(), &registry, NonZeroUsize::MIN).unwrap();
    let impacts = [("impactor.velocity", "\"1 m/s\""), ("impactor.mass", "\"20 g\""), ("contact.beta", "0.5")];
    let struck = std::thread::scope(|scope| {
        let strike = |(key, value)| plate.impact(&read(key, value), &registry, &mut ()).unwrap();
        impacts.map(|impact| scope.spawn(move || strike(impact))).map(|thread| thread.join().unwrap())
    });
    for ((key, value), struck) in impacts.into_iter().zip(struck) {
        let Found::Impact(found) = struck.found else { panic!("an impact") };
        let (_, own) = impact_of(read(key, value)).unwrap();
        let outcomes = [&found.outcome, &own.outcome];
        let [a, b] =
            outcomes.map(|of| of.history.iter().flat_map(|row| row.values()).map(f64::to_bits).collect::<Vec<_>>());
        assert_eq!(a, b, "{key}");
        let [a, b] = outcomes.map(|of| (&of.events, &of.peaks));
        assert_eq!(a, b, "{key}");
        let [mut a, mut b] = [&found.summary, &own.summary].map(|of| serde_json::to_value(of).unwrap());
        for summary in [&mut a, &mut b] {
            // Estimates of errors need the plate before its reduction.
            summary.as_object_mut().unwrap().remove("accuracy");
        }
        assert_eq!(a, b, "{key}");
    }
    let refused = plate.impact(&read("mesh.refine", "1"), &registry, &mut ()).unwrap_err();
    assert!(matches!(refused, Error::OtherPlate { key } if key == "mesh.refine"));
}
