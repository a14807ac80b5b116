//! Stand-in for the window in builds without the feature `view`.

use std::ffi::OsString;

use anyhow::{Result, bail};
use clap::Args;

use crate::console::Console;

/// Look at a scene in a window (this build has none)
#[derive(Args)]
#[command(after_help = "Example:
  cargo run --release --features view -- view scenes/sphere.toml")]
pub(crate) struct Arguments {
    /// Scene and options
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    _rest: Vec<OsString>,
}

pub(crate) fn run(_: &Arguments, _: &Console) -> Result<()> {
    bail!(
        "this build has no window; build relievo with its feature \"view\": cargo run --release --features view -- view"
    )
}
