//! Time and memory of reading a mesh: `cargo bench -p fem-io --bench mesh -- FILE.msh`.
//!
//! Without a file it writes a square of 447 x 447 cells, ASCII and binary, and reads each in a process of its own, because
//! the peak of memory is that of a process. Processor time; the fastest of seven samples counts.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use fem_io::gmsh;
use std::path::Path;

fn main() {
    let files: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    for file in files {
        measure(Path::new(&file));
    }
}

fn measure(file: &Path) {
    let mut least = f64::INFINITY;
    for _ in 0..7 {
        let start = std::time::Instant::now();
        let read = gmsh::read(file, 1e-3).unwrap();
        least = least.min(start.elapsed().as_secs_f64());
        std::hint::black_box(read);
    }
    println!("{} {:.3} s, {:.0} MB", file.display(), least, peak_memory());
}

fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kb| kb.parse().ok()).map_or(f64::NAN, |kb: f64| kb * 1024.0 / 1e6)
}
