use anyhow::Result;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use relievo_map::{DerivativeKernel, height_to_normal};
use serde::Serialize;

use super::batch::{self, Reads, VerbTask};
use super::output::MapOutput;
use super::surface::{SurfaceArguments, by_debug};
use crate::console::Console;

/// Make normals from heights
#[derive(Args, Serialize)]
#[command(after_help = "Examples:
  relievo map normal stone_height.png -o stone_normal.png --height-scale 0.05
  relievo map normal terrain.exr -o terrain_normal.png --border open --kernel scharr --normal-y down
  relievo map normal materials -o normals")]
pub(crate) struct Arguments {
    #[command(flatten)]
    surface: SurfaceArguments,
    /// Measure of slopes: half the difference of the neighbours, or that averaged over three rows
    #[arg(long, value_name = "KERNEL", default_value = "central", value_parser = kernel_parser())]
    #[serde(serialize_with = "by_debug")]
    kernel: DerivativeKernel,
    #[command(flatten)]
    maps: MapOutput,
}

pub(crate) fn kernel_parser() -> impl TypedValueParser<Value = DerivativeKernel> {
    PossibleValuesParser::new(DerivativeKernel::ALL.map(|(name, _)| name)).map(|name| {
        let known = DerivativeKernel::ALL.iter().find(|(known, _)| *known == name);
        known.map_or(DerivativeKernel::Central, |&(_, kernel)| kernel)
    })
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let Arguments { surface, kernel, maps } = arguments;
    let task = VerbTask::new("normal", Reads::Height, arguments)?;
    batch::run(&surface.input, &surface.output, &task, console, |job| {
        let height = surface.read(job, console)?;
        let path = maps.path_for(job, maps.normal_suffix())?;
        maps.normal(&path, &height_to_normal(&height, surface.height_scale, *kernel, surface.border.into()))?;
        Ok(vec![path])
    })
}
