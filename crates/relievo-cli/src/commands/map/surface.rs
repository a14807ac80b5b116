//! Options of the verbs that read heights.

use std::fmt::Debug;
use std::path::PathBuf;

use anyhow::Result;
use clap::{Args, ValueEnum};
use relievo_map::{Border, HeightMap, Limits, White, read_height};
use serde::{Serialize, Serializer};

use super::job::MapJob;
use crate::console::Console;
use crate::scene_args::{OUTPUT, number};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
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

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
pub(crate) enum HighOrDeep {
    /// White is high
    High,
    /// White is deep
    Deep,
}

/// Heights, and how high they are.
#[derive(Args, Serialize)]
pub(crate) struct SurfaceArguments {
    /// A height map, a material's folder, or a folder of materials
    #[serde(skip)]
    pub(crate) input: PathBuf,
    /// The file to write; for a folder, the folder
    #[arg(long, short, value_name = "OUT", help_heading = OUTPUT)]
    #[serde(skip)]
    pub(crate) output: PathBuf,
    /// The full range of heights as a fraction of one repeat along u
    #[arg(long, value_name = "S", default_value_t = 0.05, value_parser = number(0.0, 100.0))]
    pub(crate) height_scale: f32,
    /// Surface beyond the border
    #[arg(long, value_name = "KIND", default_value = "wrap")]
    pub(crate) border: WrapOrOpen,
    /// Meaning of white in the height map [default: high, or what a folder's file name says]
    #[arg(long, value_name = "KIND")]
    white: Option<HighOrDeep>,
}

impl SurfaceArguments {
    /// Reads the heights of a job and prints its notes.
    pub(crate) fn read(&self, job: &MapJob, console: &Console) -> Result<HeightMap> {
        let white = match self.white {
            Some(HighOrDeep::High) => White::High,
            Some(HighOrDeep::Deep) => White::Deep,
            None => job.found.as_ref().map_or(White::High, |found| found.height_white),
        };
        let loaded = read_height(&job.input, white, &Limits::default())?;
        loaded.notes.iter().for_each(|note| console.note(note));
        Ok(loaded.map)
    }
}

/// Serialises an option of another crate by its `Debug` form, for the journal.
pub(crate) fn by_debug<T: Debug, S: Serializer>(option: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&format_args!("{option:?}"))
}
