//! `riss schema`.

use clap::{Args, ValueEnum};

/// Arguments of `riss schema`.
#[derive(Args)]
pub struct SchemaArguments {
    /// Method whose cases are described; both methods in the plane read the same keys
    #[arg(long, value_enum, default_value_t = SchemaMethod::ElementFreeGalerkin)]
    method: SchemaMethod,
}

/// What the key `method` of a case may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SchemaMethod {
    ElementFreeGalerkin,
    CrackingParticles,
    Collocation,
}

/// Prints the JSON Schema of the case file.
pub fn print(arguments: &SchemaArguments) -> u8 {
    let schema = match arguments.method {
        SchemaMethod::ElementFreeGalerkin | SchemaMethod::CrackingParticles => riss::case::json_schema(),
        SchemaMethod::Collocation => riss::case::solid_json_schema(),
    };
    crate::print(&format!("{schema:#}\n"));
    crate::DONE
}
