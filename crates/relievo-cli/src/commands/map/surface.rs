//! Options of the verbs that read heights.

use std::path::PathBuf;

use anyhow::Result;
use clap::{Args, ValueEnum};
use relievo_map::{Border, HeightMap, Limits, White, read_height};

use super::batch::Job;
use crate::console::Console;
use crate::scene_args::OUTPUT;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum WrapOrOpen {
    /// The map tiles
    Wrap,
    /// It ends
    Open,
}

impl From<WrapOrOpen> for Border {
    fn from(border: WrapOrOpen) -> Self {
        if border == WrapOrOpen::Wrap { Self::Wrap } else { Self::Open }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum HighOrDeep {
    /// White is high
    High,
    /// White is deep
    Deep,
}

/// Heights, and how high they are.
#[derive(Args)]
pub(crate) struct SurfaceArguments {
    /// A height map, a material's folder, or a folder of materials
    pub(crate) input: PathBuf,
    /// The file to write; for a folder, the folder
    #[arg(long, short, value_name = "OUT", help_heading = OUTPUT)]
    pub(crate) output: PathBuf,
    /// The full range of heights as a fraction of one repeat along u
    #[arg(long, value_name = "S", default_value_t = 0.05, value_parser = number(0.0, 100.0))]
    pub(crate) height_scale: f32,
    /// What lies beyond the border
    #[arg(long, value_name = "KIND", default_value = "wrap")]
    pub(crate) border: WrapOrOpen,
    /// What white means in the height map [default: high, or what a folder's file name says]
    #[arg(long, value_name = "KIND")]
    white: Option<HighOrDeep>,
}

impl SurfaceArguments {
    /// Reads the heights of a job and tells what was noticed.
    pub(crate) fn read(&self, job: &Job, console: &Console) -> Result<HeightMap> {
        let white = match self.white {
            Some(HighOrDeep::High) => White::High,
            Some(HighOrDeep::Deep) => White::Deep,
            None => job.found.as_ref().map_or(White::High, |found| found.height_white),
        };
        let loaded = read_height(&job.input, white, &Limits::default())?;
        loaded.notes.iter().for_each(|note| console.note(note));
        Ok(loaded.map)
    }

    /// What changes the result.
    pub(crate) fn describe(&self) -> String {
        format!("height_scale={} border={:?} white={:?}", self.height_scale, self.border, self.white)
    }
}

/// A number between two others, for `value_parser`.
pub(crate) fn number(min: f32, max: f32) -> impl Fn(&str) -> Result<f32, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.trim().parse::<f32>().ok().filter(|n| (min..=max).contains(n));
        number.ok_or_else(|| format!("expected a number from {min} to {max}"))
    }
}
