use anyhow::Result;
use clap::Args;
use relievo_map::bent_normals;
use serde::Serialize;

use super::ao::Horizon;
use super::batch::{self, Reads, VerbTask};
use super::output::MapOutput;
use super::surface::SurfaceArguments;
use crate::console::Console;

/// Make bent normals from heights: the mean direction in which the sky is seen
#[derive(Args, Serialize)]
#[command(after_help = "Examples:
  relievo map bent stone_height.png -o stone_bent.png --height-scale 0.05
  relievo map bent materials -o more_maps")]
pub(crate) struct Arguments {
    #[command(flatten)]
    surface: SurfaceArguments,
    #[command(flatten)]
    horizon: Horizon,
    #[command(flatten)]
    maps: MapOutput,
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let Arguments { surface, horizon, maps } = arguments;
    let task = VerbTask::new("bent", Reads::Height, arguments)?;
    batch::run(&surface.input, &surface.output, &task, console, |job| {
        let height = surface.read(job, console)?;
        let path = maps.path_for(job, "BentNormal")?;
        maps.normal(&path, &bent_normals(&height, &horizon.options(surface)))?;
        Ok(vec![path])
    })
}
