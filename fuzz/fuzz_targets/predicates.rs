//! `cargo +nightly fuzz run predicates`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::predicates(bytes));
