//! `cargo +nightly fuzz run msh`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::msh(bytes));
