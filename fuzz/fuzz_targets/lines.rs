//! Meshes of Abaqus and Nastran.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fem_fuzz::limited(fem_fuzz::targets::lines, data));
