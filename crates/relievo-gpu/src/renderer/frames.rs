//! Frames of a renderer drawn offscreen.

use std::time::Instant;

use super::options::Target;
use super::scene_renderer::Renderer;
use crate::device::{FrameTime, GpuError, Offscreen, Timer, wait};

impl Offscreen {
    /// Draws a frame, with a renderer made for this format. Returns when the work is submitted.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw(&self, renderer: &mut Renderer) -> Result<(), GpuError> {
        renderer.draw(&Target::new(self.view(), self.size()))
    }

    /// Draws a frame and waits until it is done.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn time(&self, renderer: &mut Renderer) -> Result<FrameTime, GpuError> {
        // Nothing of what was submitted before is to be counted.
        wait(&self.device)?;
        let start = Instant::now();
        let timestamps = self.timer.as_ref().map(Timer::timestamps);
        renderer.draw(&Target { timestamps, ..Target::new(self.view(), self.size()) })?;
        wait(&self.device)?;
        let wall = start.elapsed();
        let gpu = self.timer.as_ref().map(|timer| timer.elapsed(&self.device, &self.queue)).transpose()?;
        Ok(FrameTime { gpu, wall })
    }
}
