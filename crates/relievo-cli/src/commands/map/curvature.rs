use anyhow::Result;
use clap::Args;
use relievo_map::curvature;
use serde::Serialize;

use super::batch::{self, Reads, VerbTask};
use super::output::MapOutput;
use super::surface::SurfaceArguments;
use crate::console::Console;
use crate::scene_args::number;

/// Make curvature from heights: grey flat, white edges, black grooves
#[derive(Args, Serialize)]
#[command(after_help = "Examples:
  relievo map curvature stone_height.png -o stone_curvature.png --height-scale 0.05
  relievo map curvature materials -o more_maps --sharpest 0.02")]
pub(crate) struct Arguments {
    #[command(flatten)]
    surface: SurfaceArguments,
    /// A ridge that is round with this radius, or sharper, is white; as a fraction of a repeat
    #[arg(long, value_name = "R", default_value_t = 0.01, value_parser = number(0.0, 10.0))]
    sharpest: f32,
    #[command(flatten)]
    maps: MapOutput,
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let Arguments { surface, sharpest, maps } = arguments;
    let task = VerbTask::new("curvature", Reads::Height, arguments)?;
    batch::run(&surface.input, &surface.output, &task, console, |job| {
        let height = surface.read(job, console)?;
        let path = maps.path_for(job, "Curvature")?;
        maps.scalar(&path, &curvature(&height, surface.height_scale, *sharpest, surface.border.into()))?;
        Ok(vec![path])
    })
}
