//! `relievo map`: making maps and turning one into another. Each verb is a file.

use anyhow::Result;
use clap::{Args, Subcommand};

use crate::console::Console;

mod ao;
mod batch;
mod bent;
mod curvature;
mod edit;
mod from_photo;
mod height;
mod job;
mod make;
mod normal;
mod output;
mod paint;
mod pictures;
mod surface;

/// Make maps from nothing and from other maps
///
/// Verbs that read maps take one file, one material's folder, or a folder of materials. With a folder they note in a
/// manifest what is done, and a second run does only what is left.
#[derive(Args)]
#[command(
    arg_required_else_help = true,
    after_help = "Examples:
  relievo map make cobbles -o cobbles
  relievo map from-photo wall.jpg -o wall --preset brick
  relievo map edit height8.png deband blur=0.002 -o height16.png
  relievo map paint cracks.svg --on ground_height.png -o cracked.png --depth -0.4
  relievo map normal stone_height.png -o stone_normal.png --height-scale 0.05
  relievo map height stone_normal.png -o stone_height.png
  relievo map ao materials -o more_maps"
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    Make(make::Arguments),
    FromPhoto(from_photo::Arguments),
    Edit(edit::Arguments),
    Paint(paint::Arguments),
    Normal(normal::Arguments),
    Height(height::Arguments),
    Ao(ao::Arguments),
    Bent(bent::Arguments),
    Curvature(curvature::Arguments),
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    match &arguments.verb {
        Verb::Make(arguments) => make::run(arguments, console),
        Verb::FromPhoto(arguments) => from_photo::run(arguments, console),
        Verb::Edit(arguments) => edit::run(arguments, console),
        Verb::Paint(arguments) => paint::run(arguments, console),
        Verb::Normal(arguments) => normal::run(arguments, console),
        Verb::Height(arguments) => height::run(arguments, console),
        Verb::Ao(arguments) => ao::run(arguments, console),
        Verb::Bent(arguments) => bent::run(arguments, console),
        Verb::Curvature(arguments) => curvature::run(arguments, console),
    }
}
