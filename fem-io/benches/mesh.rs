//! Time and memory of reading a mesh, and the time to see that its cells tile a plate: `cargo bench -p fem-io --bench mesh [-- FILE.msh ...]`.
//!
//! Without a file, a square of 448 x 448 cells, ASCII and binary, and a strip of as many. Each file is read in a process of its own, because
//! the peak of memory is that of a process; the fastest of seven samples counts.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use cpu_time::ProcessTime;
use fem_core::mesh::PlaneMesh;
use fem_io::gmsh::{self, Encoding};
use fem_io::meshes;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

const ALONE: &str = "--alone";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match &arguments[..] {
        [mode, file] if mode == ALONE => measure(Path::new(file)),
        [] => {
            let folder = tempfile::tempdir().unwrap();
            let line = |cells: u32| -> Vec<f64> { (0..=cells).map(|i| f64::from(i) / 4480.0).collect() };
            let square = PlaneMesh::rectangle(&line(448), &line(448));
            let strip = PlaneMesh::rectangle(&line(448 * 448), &line(1));
            for (name, mesh, encoding) in [
                ("ascii.msh", &square, Encoding::Ascii),
                ("binary.msh", &square, Encoding::Binary),
                ("strip.msh", &strip, Encoding::Binary),
            ] {
                let mut bytes = Vec::new();
                gmsh::write(&mut bytes, mesh, 1e-3, encoding).unwrap();
                std::fs::write(folder.path().join(name), bytes).unwrap();
                alone(&folder.path().join(name));
            }
        }
        files => files.iter().for_each(|file| alone(Path::new(file))),
    }
}

/// Measures in another process.
fn alone(file: &Path) {
    let own = std::env::current_exe().unwrap();
    assert!(Command::new(own).arg(ALONE).arg(file).status().unwrap().success());
}

fn measure(file: &Path) {
    let mut least = [Duration::MAX; 3];
    let mut cells = 0;
    for _ in 0..7 {
        let (processor, wall) = (ProcessTime::now(), Instant::now());
        let mesh = black_box(meshes::read(file, 1e-3).unwrap()).mesh;
        let read = [processor.elapsed(), wall.elapsed()];
        let tiling = ProcessTime::now();
        assert_eq!(black_box(mesh.flaws(&[])), []);
        cells = mesh.quads.len();
        least = [least[0].min(read[0]), least[1].min(read[1]), least[2].min(tiling.elapsed())];
    }
    let [processor, wall, tiling] = least.map(|t| t.as_secs_f64());
    let memory = peak_memory();
    println!(
        "{cells} cells: {processor:.3} s of processor time (tiling {tiling:.3} s), {wall:.3} s, {memory:.0} MB; {}",
        file.display()
    );
}

/// Largest memory that the process has held so far, MB.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kb| kb.parse().ok()).map_or(f64::NAN, |kb: f64| kb * 1024.0 / 1e6)
}
