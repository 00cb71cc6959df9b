//! `cargo +nightly fuzz run case_file`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::case_file(bytes));
