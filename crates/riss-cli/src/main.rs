//! The riss program.
fn main() {}
