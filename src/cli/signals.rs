//! Signals that ask a run to end.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Hears the first Ctrl-C or SIGTERM; a second one ends the process as if nobody listened.
#[derive(Debug, Default)]
pub(super) struct Signals {
    received: Arc<AtomicUsize>,
}

impl Signals {
    /// Listens from now on. Where the system refuses, a signal does what it does by default.
    pub(super) fn heed() -> Self {
        let signals = Self::default();
        let heard = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
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
