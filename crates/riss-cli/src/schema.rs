//! `riss schema`.

/// Prints the JSON Schema of the case file.
pub fn print() -> u8 {
    crate::print(&format!("{:#}\n", riss::case::json_schema()));
    crate::DONE
}
