//! `cargo +nightly fuzz run expression`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::expression(bytes));
