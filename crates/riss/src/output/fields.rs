//! Fields for ParaView.

use super::OutputOptions;
use crate::analysis::StaticResult;
use std::io;

/// Names and contents of all field files.
pub fn field_files(result: &StaticResult, options: &OutputOptions) -> io::Result<Vec<(String, Vec<u8>)>> {
    let _ = (result, options);
    Ok(vec![])
}
