use anyhow::Result;
use clap::{Args, Command};
use clap_complete::Shell;

use crate::console::print;

/// Print a completion script for a shell
#[derive(Args)]
#[command(after_help = "Examples:
  relievo completions bash > ~/.local/share/bash-completion/completions/relievo
  relievo completions zsh > ~/.zfunc/_relievo
  relievo completions fish > ~/.config/fish/completions/relievo.fish")]
pub(crate) struct Arguments {
    /// The shell
    shell: Shell,
}

/// Prints the script for `command`, the whole command line.
pub(crate) fn run(arguments: &Arguments, mut command: Command) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "relievo", &mut script);
    print(&script)
}
