//! What the machine gives while a benchmark runs.

use cpu_time::ThreadTime;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use std::hint::black_box;

const SAMPLES: usize = 5;

/// GFLOP/s of a product of two 1024 × 1024 matrices: the best of five.
pub(crate) fn product() -> f64 {
    let a = Mat::<f64>::from_fn(1024, 1024, |i, j| ((i * 7 + j * 13) % 17) as f64);
    let mut c = Mat::<f64>::zeros(1024, 1024);
    let seconds = (0..SAMPLES).map(|_| {
        let start = ThreadTime::now();
        matmul(&mut c, Accum::Replace, &a, &a, 1.0, Par::Seq);
        black_box(&c);
        start.elapsed().as_secs_f64()
    });
    2.0 * 1024_f64.powi(3) / seconds.fold(f64::INFINITY, f64::min) / 1e9
}
