use anyhow::Result;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::console::print;

/// Print a completion script for a shell
#[derive(Args)]
#[command(after_help = "Examples:
  relievo completions bash > ~/.local/share/bash-completion/completions/relievo
  relievo completions zsh > ~/.zfunc/_relievo
  relievo completions fish > ~/.config/fish/completions/relievo.fish")]
pub(crate) struct Arguments {
    /// Which shell
    shell: Shell,
}

pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut crate::Arguments::command(), "relievo", &mut script);
    print(&script)
}
