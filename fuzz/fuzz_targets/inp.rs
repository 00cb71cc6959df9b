//! `cargo +nightly fuzz run inp`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::inp(bytes));
