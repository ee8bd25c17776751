//! Readers under any input, in bounded memory.

pub mod targets;

use cap::Cap;
use std::alloc::System;

#[global_allocator]
static MEMORY: Cap<System> = Cap::new(System, usize::MAX);

/// What any input may ask for, bytes.
const FREE: usize = 64 << 20;
/// What each byte of an input may ask for besides.
const PER_BYTE: usize = 100;

/// Runs `target`, and aborts where it asks for more memory than `data` can be worth.
pub fn limited(target: fn(&[u8]), data: &[u8]) {
    limit(MEMORY.allocated() + FREE + PER_BYTE * data.len());
    target(data);
    limit(usize::MAX);
}

fn limit(bytes: usize) {
    assert!(MEMORY.set_limit(bytes).is_ok(), "more than {bytes} bytes are in use");
}
