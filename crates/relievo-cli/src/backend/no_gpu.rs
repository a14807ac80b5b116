//! Stand-in for the GPU backend in builds without the feature `gpu`.

use anyhow::{Result, bail};

use super::draw_job::{DrawJob, Drawn};
use super::film_job::{Emit, FilmJob};
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

pub(crate) fn name(gpu: &Gpu) -> String {
    match *gpu {}
}

/// No animation can be drawn.
pub(crate) enum GpuFilm<'a> {
    #[allow(dead_code)]
    Never(std::convert::Infallible, std::marker::PhantomData<&'a ()>),
}

impl GpuFilm<'_> {
    pub(crate) fn draw(&mut self, _: &[usize], _: Emit<'_>) -> Result<()> {
        match self {
            Self::Never(never, _) => match *never {},
        }
    }
}

pub(crate) fn film<'a>(gpu: &Gpu, _: &'a FilmJob<'a>, _: &str, _: &Console) -> Result<GpuFilm<'a>> {
    match *gpu {}
}

pub(crate) fn draw(gpu: &Gpu, _: &DrawJob<'_>, _: &str, _: &Console) -> Result<Drawn> {
    match *gpu {}
}
