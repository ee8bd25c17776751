//! `fem completions` and `fem man`: what shells and `man` know of the command line.

use super::{Arguments as CommandLine, Console};
use clap::{Args, Command, CommandFactory as _};
use clap_complete::Shell;
use clap_mangen::Man;
use fem_io::files::OutputDir;
use miette::IntoDiagnostic;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
#[command(after_help = "For bash: fem completions bash > ~/.local/share/bash-completion/completions/fem")]
pub(super) struct CompletionsArguments {
    /// The shell.
    shell: Shell,
}

pub(super) fn completions(arguments: &CompletionsArguments, console: &Console) -> miette::Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut CommandLine::command(), "fem", &mut script);
    console.write_bytes(&script);
    Ok(ExitCode::SUCCESS)
}

#[derive(Debug, Args)]
#[command(after_help = "To read the pages: fem man | man -l -\n\
                        To install them:   fem man --out ~/.local/share/man/man1")]
pub(super) struct ManArguments {
    /// Folder into which a page per command is written [default: the page of fem on standard output]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn man(arguments: &ManArguments, console: &Console) -> miette::Result<ExitCode> {
    let mut command = CommandLine::command();
    command.build();
    match &arguments.out {
        None => console.write_bytes(&page(&command)?),
        Some(folder) => {
            let dir = OutputDir::open(folder).into_diagnostic()?;
            let own = command.get_subcommands().filter(|command| command.get_name() != "help");
            for command in std::iter::once(&command).chain(own) {
                // `fem run` has the page fem-run.1.
                let name = command.get_display_name().unwrap_or("fem");
                let page = page(command)?;
                dir.write(&format!("{name}.1"), |out| out.write_all(&page)).into_diagnostic()?;
            }
            console.print(&format!("  pages     {}\n", dir.path().display()));
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn page(command: &Command) -> miette::Result<Vec<u8>> {
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page).into_diagnostic()?;
    Ok(page)
}
