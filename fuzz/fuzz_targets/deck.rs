//! Decks of LAMCEL, LAMSUB and TRADYR.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fem_fuzz::limited(fem_fuzz::targets::deck, data));
