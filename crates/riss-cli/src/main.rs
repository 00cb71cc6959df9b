//! The riss program: `run`, `check`, `compare`, `converge`, `report`, `export`, `shape`, `schema`, `new`, `import`,
//! `cases`, `selftest`, `completions`, `man`.

/// Like that of the standard library, which panics where stderr takes nothing: a full disk, a reader that has gone away.
macro_rules! eprintln {
    ($($words:tt)*) => {{
        use std::io::Write;
        let _ = writeln!(std::io::stderr().lock(), $($words)*);
    }};
}

mod batch;
mod cases;
mod check;
mod claim;
mod compare;
mod converge;
mod desktop;
mod diagnostics;
mod export;
mod grow;
mod import;
mod interrupt;
mod load_curve;
mod log;
mod manual;
mod memory;
mod new;
mod plane_loading;
mod progress;
mod report;
mod results;
mod resume;
mod run;
mod schema;
mod selftest;
mod shape;
mod solid;
mod solid_compare;
mod solid_converge;
mod solid_grow;
mod solid_loading;
mod sweep;
mod table;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Done.
const DONE: u8 = 0;
/// The analysis failed or stopped early, or its results could not be written.
const STOPPED: u8 = 1;
/// The case or the command line is wrong.
const BAD_CASE: u8 = 2;
/// Two runs differ by more than was allowed.
const DIFFERENT: u8 = 3;

/// Cracks in solids with meshfree methods: stress intensity factors, J, T-stress and crack growth of a case file.
#[derive(Parser)]
#[command(
    name = "riss",
    version,
    after_help = "Examples:\n  riss new case.toml\n  riss run case.toml --open\n  riss cases\n  riss COMMAND --help\n\n\
        Exit codes: 0 done, 1 the analysis failed or stopped early, 2 bad case or usage, 3 compared runs differ."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Runs a case and writes its results
    Run(run::RunArguments),
    /// Reads and checks a case without running it
    Check(check::CheckArguments),
    /// Says how far the cracks, stress intensity factors and load curves of two runs are apart
    Compare(compare::CompareArguments),
    /// Solves on coarser and finer nodes and says where K goes, and how fast
    Converge(converge::ConvergeArguments),
    /// Makes report.html again from a folder of results
    Report(report::ReportArguments),
    /// Writes the cracks or their stress intensity factors for another program
    Export(export::ExportArguments),
    /// Draws the weight and the shape function of a node
    Shape(shape::ShapeArguments),
    /// Prints the JSON Schema of the case file
    #[command(after_help = "Examples:\n  riss schema > riss.schema.json\n  \
        riss schema --method collocation > riss-solid.schema.json")]
    Schema(schema::SchemaArguments),
    /// Writes a commented case to start from
    #[command(after_help = "Examples:\n  riss new\n  riss new plate.toml")]
    New {
        /// File to write; an existing one is left alone
        #[arg(default_value = "case.toml")]
        file: PathBuf,
    },
    /// Prints a case with the body, material, supports and loads of an Abaqus or CalculiX input file
    Import(import::ImportArguments),
    /// Lists the gallery of ready cases, or copies one
    Cases(cases::CasesArguments),
    /// Runs documented cases and compares them with their references
    Selftest(selftest::SelftestArguments),
    /// Prints the script that completes commands in a shell
    Completions(manual::CompletionsArguments),
    /// Prints the manual page
    Man(manual::ManArguments),
}

fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|panic| eprintln!("{}", bug(&panic.to_string()))));
    let code = match Cli::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Converge(arguments) => converge::run(&arguments),
        Command::Report(arguments) => report::write(&arguments),
        Command::Export(arguments) => export::export(&arguments),
        Command::Shape(arguments) => shape::shape(&arguments),
        Command::Schema(arguments) => schema::print(&arguments),
        Command::New { file } => new::write(&file),
        Command::Import(arguments) => import::import(&arguments),
        Command::Cases(arguments) => cases::cases(&arguments),
        Command::Selftest(arguments) => selftest::run(&arguments),
        Command::Completions(arguments) => manual::completions(&arguments),
        Command::Man(arguments) => manual::man(&arguments),
    };
    ExitCode::from(code)
}

/// Says why there is no result, also in the log; returns the exit code.
fn fail(message: &str) -> u8 {
    tracing::error!("{message}");
    eprintln!("error: {message}");
    STOPPED
}

/// What a user is told when the program itself fails; the exit code is then 101.
fn bug(panic: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("error: this is a bug in riss {version}, not in your case; please report it with the case file\n{panic}")
}

/// Prints to stdout; a reader that has gone away, such as `head`, is no error.
fn print(text: &str) {
    use std::io::Write;
    let _ = std::io::stdout().lock().write_all(text.as_bytes());
}
