//! `cargo +nightly fuzz run stl`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::stl(bytes));
