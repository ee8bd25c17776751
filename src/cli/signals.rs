//! Signals that ask a run to end.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Signals that are caught. SIGHUP where the system tells whether it is to be ignored.
#[cfg(target_os = "linux")]
const HEARD: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
#[cfg(not(target_os = "linux"))]
const HEARD: [i32; 2] = [SIGINT, SIGTERM];

/// Catches the first Ctrl-C, SIGTERM or SIGHUP (a terminal that closes); a second one ends the process as if nobody
/// listened. What the process was told to ignore, as `nohup` does, stays ignored.
#[derive(Debug, Default)]
pub(super) struct Signals {
    received: Arc<AtomicUsize>,
}

impl Signals {
    /// Listens from now on. Where the system refuses, a signal does what it does by default.
    pub(super) fn listen() -> Self {
        let signals = Self::default();
        let heard = Arc::new(AtomicBool::new(false));
        for signal in HEARD.into_iter().filter(|signal| !ignored(*signal)) {
            // In this order: the first signal finds `heard` false.
            let _ = flag::register_conditional_default(signal, Arc::clone(&heard))
                .and_then(|_| flag::register(signal, Arc::clone(&heard)))
                .and_then(|_| flag::register_usize(signal, Arc::clone(&signals.received), signal as usize));
        }
        signals
    }

    /// Number of the signal, if there was one.
    pub(super) fn received(&self) -> Option<u8> {
        u8::try_from(self.received.load(Ordering::Relaxed)).ok().filter(|signal| *signal != 0)
    }
}

/// Whether the process was started with `signal` ignored; `false` where the system does not tell.
fn ignored(signal: i32) -> bool {
    let mask = || {
        let status = std::fs::read_to_string("/proc/self/status").ok()?;
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
        u64::from_str_radix(mask.trim(), 16).ok()
    };
    mask().is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}
