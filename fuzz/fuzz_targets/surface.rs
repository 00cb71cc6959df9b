//! `cargo +nightly fuzz run surface`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| riss_fuzz::surface(bytes));
