//! The `relievo` command: thin, each subcommand a file. What it can do lives in the library crates.
//!
//! Exit codes: 0 done, 1 failed, 2 wrong usage.

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

mod aov;
mod backend;
mod commands;
mod console;
mod memory;
mod outputs;
#[cfg(all(unix, not(target_vendor = "apple"), feature = "gpu"))]
mod runtime_folder;
mod scene_args;
mod stats;

use commands::{compare, completions, devices, lab, map, render, tune, view};
use console::{Console, WrongUsage};

/// Gives flat polygons real depth: draws relief with every technique from plain parallax to exact, and measures each
/// against the truth.
#[derive(Parser)]
#[command(name = "relievo", version, propagate_version = true, arg_required_else_help = true)]
#[command(after_help = "Examples:
  relievo render -o wall.png                   draw the built-in brick wall
  relievo compare --heat hits -o sheet.png     judge every technique on it
  relievo tune make:cobbles --max-error 1      find the cheapest that is good enough
  relievo map make --list                      name the materials that can be made
  relievo view                                 look at it in a window
  relievo help render                          all options of a command

Exit codes: 0 done, 1 failed, 2 wrong usage.")]
struct Arguments {
    /// Print errors only: no notes, no progress
    #[arg(long, short, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Render(render::Arguments),
    Compare(compare::Arguments),
    Lab(lab::Arguments),
    Tune(tune::Arguments),
    Devices(devices::Arguments),
    View(view::Arguments),
    Map(map::Arguments),
    Completions(completions::Arguments),
}

#[cfg(all(unix, not(target_vendor = "apple"), feature = "gpu"))]
impl Command {
    /// True if the machine's GPU adapters may be looked for.
    fn lists_adapters(&self) -> bool {
        !matches!(self, Self::Compare(_) | Self::Map(_) | Self::Completions(_))
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let console = Console::new(arguments.quiet);
    #[cfg(all(unix, not(target_vendor = "apple"), feature = "gpu"))]
    if arguments.command.lists_adapters() {
        runtime_folder::ensure();
    }
    let result = match &arguments.command {
        Command::Render(arguments) => render::run(arguments, &console),
        Command::Compare(arguments) => compare::run(arguments, &console),
        Command::Lab(arguments) => lab::run(arguments, &console),
        Command::Tune(arguments) => tune::run(arguments, &console),
        Command::Devices(arguments) => devices::run(arguments, &console),
        Command::View(arguments) => view::run(arguments, &console),
        Command::Map(arguments) => map::run(arguments, &console),
        Command::Completions(arguments) => completions::run(arguments, Arguments::command()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console.error(&error);
            if error.is::<WrongUsage>() { ExitCode::from(2) } else { ExitCode::FAILURE }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
