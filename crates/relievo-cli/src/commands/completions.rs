use anyhow::Result;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::console::print;

/// Print a completion script for a shell
#[derive(Args)]
#[command(after_help = "Example:\n  relievo completions bash > ~/.local/share/bash-completion/completions/relievo")]
pub(crate) struct Arguments {
    /// Which shell
    shell: Shell,
}

pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut crate::Arguments::command(), "relievo", &mut script);
    print(&script)
}
