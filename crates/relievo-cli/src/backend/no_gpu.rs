//! Stand-in for the GPU backend in builds without the feature `gpu`.

use anyhow::{Result, bail};

use super::draw_job::{DrawJob, Drawn};
use crate::console::Console;

/// No device can be opened.
pub(crate) enum Gpu {}

pub(crate) fn open(_: Option<&str>) -> Result<Gpu> {
    bail!(
        "this build has no GPU backend; build relievo with its feature \"gpu\" (cargo run --release --features gpu -- …), or use \
         --backend cpu"
    )
}

pub(crate) fn open_real() -> Result<Gpu, String> {
    Err("this build has no GPU backend".to_owned())
}

pub(crate) fn bench(gpu: &Gpu) -> Result<relievo_lab::MarchBackend> {
    match *gpu {}
}

pub(crate) fn draw(gpu: &Gpu, _: &DrawJob<'_>, _: &str, _: &Console) -> Result<Drawn> {
    match *gpu {}
}
