//! `riss man` and `riss completions`: what shells and manual pages know of the program.

use crate::{Cli, DONE, STOPPED, results};
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use std::io;
use std::path::PathBuf;

/// Arguments of `riss completions`.
#[derive(Args)]
#[command(after_help = "Examples:\n  riss completions bash > ~/.local/share/bash-completion/completions/riss\n  \
    riss completions fish > ~/.config/fish/completions/riss.fish\n  riss completions zsh > ~/.zfunc/_riss")]
pub struct CompletionsArguments {
    /// Shell that is to complete commands
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Arguments of `riss man`.
#[derive(Args)]
#[command(after_help = "Examples:\n  riss man | man -l -\n  riss man ~/.local/share/man/man1")]
pub struct ManArguments {
    /// Folder for the pages of all commands [default: print the page of riss]
    pub dir: Option<PathBuf>,
}

/// Prints the completions for a shell.
pub fn completions(arguments: &CompletionsArguments) -> u8 {
    let mut script = vec![];
    clap_complete::generate(arguments.shell, &mut Cli::command(), "riss", &mut script);
    crate::print(&String::from_utf8_lossy(&script));
    DONE
}

/// Prints the manual page, or writes those of all commands; returns the exit code.
pub fn man(arguments: &ManArguments) -> u8 {
    let written = match &arguments.dir {
        None => print_page(),
        Some(dir) => std::fs::create_dir_all(dir)
            .and_then(|()| clap_mangen::generate_to(Cli::command().disable_help_subcommand(true), dir))
            .map(|()| crate::print(&format!("wrote riss.1 and a page for each command to {}\n", dir.display()))),
    };
    match written {
        Ok(()) => DONE,
        Err(e) => {
            eprintln!("error: cannot write the manual: {}", results::reason(&e));
            STOPPED
        }
    }
}

fn print_page() -> io::Result<()> {
    let mut page = vec![];
    Man::new(Cli::command()).render(&mut page)?;
    crate::print(&String::from_utf8_lossy(&page));
    Ok(())
}
