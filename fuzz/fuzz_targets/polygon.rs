//! `cargo +nightly fuzz run polygon`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::polygon(bytes));
