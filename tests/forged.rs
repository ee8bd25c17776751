//! Checkpoints that somebody made: their checksum is right, and what they hold is not.

use crate::support::{Case, failing, watched};
use fem::analyses::impact::{self, Checkpoint, March};
use fem::io::checkpoint;
use fem::io::files::OutputDir;
use fem::io::scene;
use fem::job::{self, Options, Results};
use fem::{Model, Registry};
use std::fs;
use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Numbers by Knuth's linear congruences.
struct Draw(u64);

impl Draw {
    fn next(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}

/// A payload with something else in it: lengths and counts as postcard writes them, numbers that are none, pieces that are
/// missing or there twice.
fn forge(payload: &[u8], draw: &mut Draw) -> Vec<u8> {
    let mut forged = payload.to_vec();
    for _ in 0..=draw.next(3) {
        let at = draw.next(forged.len());
        let end = (at + 8).min(forged.len());
        match draw.next(8) {
            0 | 1 => forged[at] = draw.next(256) as u8,
            2 => forged[at] ^= 1 << draw.next(8),
            3 => drop(forged.splice(at..at + 1, [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01])),
            4 => {
                let number = [f64::NAN, f64::INFINITY, -1e308, 5e-324, 0.0][draw.next(5)];
                forged.splice(at..end, number.to_le_bytes()).for_each(drop);
            }
            5 => forged.truncate(at.max(1)),
            6 => drop(forged.drain(at..end)),
            _ => {
                let twice = forged[at..end].to_vec();
                forged.splice(at..at, twice).for_each(drop);
            }
        }
    }
    forged
}

/// A run, and the same with a later end.
fn case(reduction: &str, of: fn() -> Case, end: &str) -> (Case, Case) {
    let reduced = || of().scene("[march]", &format!("[reduction]\nmethod = \"{reduction}\"\n[march]"));
    (reduced(), reduced().scene(&format!("end = \"{end}\""), "end = \"110 us\""))
}

/// Every one is refused with a word or marched to its end or to a stop.
#[test]
fn no_forged_checkpoint_stops_the_program() {
    let tries = std::env::var("FEM_FORGED").map_or(40, |n| n.parse().unwrap());
    let (mut read, mut marched) = (0, 0);
    for (short, long) in [case("ritz", watched, "20 us"), case("ritz", failing, "100 us")] {
        short.fem("run", &["--out", "out"]).good();
        let payload = checkpoint::read(&short.folder().join("out/checkpoint.bin")).unwrap();
        let path = long.folder().join(long.write());
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.replace("[output]", "[output]\nplots = false")).unwrap();
        let scene = scene::read(&path).unwrap();
        let registry = Registry::standard();
        let model = Model::new(&scene, &registry).unwrap();
        let out = long.folder().join("out");
        let dir = OutputDir::create(&out).unwrap();
        let mut draw = Draw(7);
        for number in 0..tries {
            let forged = forge(&payload, &mut draw);
            checkpoint::write(&dir, "checkpoint.bin", &forged).unwrap();
            let outcome = catch_unwind(AssertUnwindSafe(|| match Checkpoint::read(&out, &model) {
                Err(why) => {
                    assert!(!why.to_string().is_empty());
                    [false, false]
                }
                Ok(kept) => match March::resume(impact::prepare(&model, NonZeroUsize::MIN).unwrap(), kept) {
                    Err(why) => {
                        assert!(!why.to_string().is_empty());
                        [true, false]
                    }
                    Ok(_) => {
                        let resumed = Options { results: Results::Resumed(out.clone()), ..Options::default() };
                        let _ = job::run(&scene, &registry, &resumed, &mut ());
                        [true, true]
                    }
                },
            }));
            let [was_read, was_marched] = outcome.unwrap_or_else(|_| panic!("try {number}"));
            read += usize::from(was_read);
            marched += usize::from(was_marched);
        }
    }
    // Forgeries of all kinds: such as are refused when they are read, by the march, and not at all.
    assert!(marched > 0 && read > marched && read < 2 * tries, "{read} of {tries} read, {marched} marched");
}
