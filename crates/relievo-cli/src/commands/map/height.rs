use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use relievo_map::{DerivativeKernel, IntegrateOptions, Limits, NormalY, normal_to_height, read_normal};
use serde::Serialize;

use super::batch::{self, Reads, VerbTask};
use super::normal::kernel_parser;
use super::output::{MapOutput, UpOrDown};
use super::surface::{WrapOrOpen, by_debug};
use crate::console::Console;
use crate::scene_args::OUTPUT;

/// Make heights from normals
///
/// The heights whose slopes come nearest to those of the normals. Says the height scale that belongs to them.
#[derive(Args, Serialize)]
#[command(after_help = "Examples:
  relievo map height stone_normal.png -o stone_height.png
  relievo map height photo_normal.png -o photo_height.exr --border open --read-normal-y down
  relievo map height materials -o heights")]
pub(crate) struct Arguments {
    /// A normal map, a material's folder, or a folder of materials
    #[serde(skip)]
    input: PathBuf,
    /// The file to write; for a folder, the folder
    #[arg(long, short, value_name = "OUT", help_heading = OUTPUT)]
    #[serde(skip)]
    output: PathBuf,
    /// Surface beyond the border; what does not tile must not be taken as tiling
    #[arg(long, value_name = "KIND", default_value = "wrap")]
    border: WrapOrOpen,
    /// The kernel that the normals were made with
    #[arg(long, value_name = "KERNEL", default_value = "central", value_parser = kernel_parser())]
    #[serde(serialize_with = "by_debug")]
    kernel: DerivativeKernel,
    /// Direction of +Y of the normals that are read [default: up, or what a folder's file name says]
    #[arg(long, value_name = "WAY")]
    read_normal_y: Option<UpOrDown>,
    #[command(flatten)]
    maps: MapOutput,
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    let Arguments { input, output, border, kernel, read_normal_y, maps } = arguments;
    let task = VerbTask::new("height", Reads::Normal, arguments)?;
    batch::run(input, output, &task, console, |job| {
        let found = job.found.as_ref().and_then(|found| found.normal.as_ref()).map(|(_, y)| *y);
        let normal_y: NormalY = read_normal_y.map(Into::into).or(found).unwrap_or_default();
        let loaded = read_normal(&job.input, normal_y, &Limits::default())?;
        loaded.notes.iter().for_each(|note| console.note(note));
        let options = IntegrateOptions { kernel: *kernel, border: (*border).into(), damping: None };
        let made = normal_to_height(&loaded.map, &options);
        let path = maps.path_for(job, "Displacement")?;
        maps.height(&path, &made.map)?;
        console.note(&format!("{}: its height scale is {:.5}", path.display(), made.height_scale));
        Ok(vec![path])
    })
}
