//! Readers that know nothing of this program: PyVista, which is VTK, and meshio.

use super::struck;
use crate::support::root;
use std::ffi::OsString;
use std::io::Write as _;
use std::process::Command;

/// Names an interpreter that has both; the check is then no longer left out.
const PYTHON: &str = "FEM_PYTHON";

#[test]
fn other_readers_find_what_was_written() {
    let named = std::env::var_os(PYTHON);
    let python = named.clone().unwrap_or_else(|| OsString::from("python3"));
    let probe = Command::new(&python).args(["-c", "import pyvista, meshio"]).output();
    if !probe.as_ref().is_ok_and(|probe| probe.status.success()) {
        assert!(named.is_none(), "{PYTHON} names an interpreter without pyvista and meshio: {probe:?}");
        let _ = writeln!(std::io::stderr(), "SKIPPED: python3 has no pyvista and meshio; name one by {PYTHON}");
        return;
    }
    for cells in ["lagrange", "subdivided"] {
        let case = struck(&format!("{{ every = \"5 us\", cells = \"{cells}\" }}\nmaps = true"));
        case.fem("run", &["--out", "out"]).good();
        let done = Command::new(&python)
            .arg(root().join("tests/fields/read_back.py"))
            .args(["out", cells])
            // Cells, layers, plies, volume in mm³, and where the impact is, mm.
            .args(["8", "2", "16", &format!("{}", 30.0 * 10.0 * 16.0 * 0.13208), "15", "5"])
            .current_dir(case.folder())
            .output()
            .unwrap();
        let said = [done.stdout, done.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        assert!(done.status.success() && said[0].contains("all as expected"), "{cells}: {said:?}");
        let drawn = Command::new(&python)
            .args(["out/fields/view.py", "--save", "fields.png"])
            .current_dir(case.folder())
            .output();
        let picture = case.folder().join("fields.png");
        assert!(drawn.as_ref().is_ok_and(|drawn| drawn.status.success()) && picture.exists(), "{cells}: {drawn:?}");
    }
}
