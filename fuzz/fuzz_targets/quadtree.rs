//! `cargo +nightly fuzz run quadtree`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::quadtree(bytes));
