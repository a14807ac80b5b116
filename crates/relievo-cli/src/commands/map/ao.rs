use anyhow::Result;
use clap::Args;
use relievo_map::{HeightMap, OcclusionOptions, ambient_occlusion};
use serde::Serialize;

use super::batch::{self, Reads, VerbTask};
use super::output::MapOutput;
use super::surface::SurfaceArguments;
use crate::console::Console;
use crate::scene_args::{number, whole_number};

/// Make ambient occlusion from heights: white where all of the sky is seen
#[derive(Args, Serialize)]
#[command(after_help = "Examples:
  relievo map ao stone_height.png -o stone_ao.png --height-scale 0.05
  relievo map ao materials -o more_maps --radius 0.05")]
pub(crate) struct Arguments {
    #[command(flatten)]
    surface: SurfaceArguments,
    #[command(flatten)]
    horizon: Horizon,
    #[command(flatten)]
    maps: MapOutput,
}

/// Distance and number of directions of the search for the horizon.
#[derive(Args, Serialize)]
pub(super) struct Horizon {
    /// Radius as a fraction of a repeat: what is farther away hides nothing
    #[arg(long, value_name = "R", default_value_t = 0.11, value_parser = number(0.0, 1.0))]
    radius: f32,
    /// Directions in which the horizon is looked for
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = whole_number(1, 256), allow_negative_numbers = true)]
    directions: u32,
}

impl Horizon {
    pub(super) fn options(&self, surface: &SurfaceArguments) -> OcclusionOptions {
        OcclusionOptions {
            height_scale: surface.height_scale,
            radius: self.radius,
            directions: self.directions,
            border: surface.border.into(),
        }
    }
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let Arguments { surface, horizon, maps } = arguments;
    let task = VerbTask::new("ao", Reads::Height, arguments)?;
    batch::run(&surface.input, &surface.output, &task, console, |job| {
        let height: HeightMap = surface.read(job, console)?;
        let path = maps.path_for(job, "AmbientOcclusion")?;
        maps.scalar(&path, &ambient_occlusion(&height, &horizon.options(surface)))?;
        Ok(vec![path])
    })
}
