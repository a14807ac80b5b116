//! The device with the scene on it: kept in line with the state, drawn, measured, and opened anew if it is lost.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use relievo_gpu::{Gpu, GpuError, Renderer, RendererOptions, Target};
use relievo_map::Grid;

use crate::picture::{Picture, wait};
use crate::state::{Change, State};

pub(crate) struct Stage {
    gpu: Gpu,
    format: wgpu::TextureFormat,
    renderer: Renderer,
    aside: Option<Picture>,
    lost: Report,
    failed: Report,
}

/// What the device told by itself, if anything.
#[derive(Clone, Default)]
struct Report(Arc<Mutex<Option<String>>>);

impl Report {
    fn set(&self, text: String) {
        // The first one is the cause of the others.
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
    }

    fn get(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Stage {
    /// Makes the scene ready on a device, for textures of this format.
    pub(crate) fn new(gpu: Gpu, format: wgpu::TextureFormat, state: &State) -> Result<Self, GpuError> {
        let (lost, failed) = (Report::default(), Report::default());
        let report = lost.clone();
        gpu.device.set_device_lost_callback(move |reason, text| report.set(format!("{reason:?}: {text}")));
        // Without this, wgpu would panic.
        let report = failed.clone();
        gpu.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| report.set(error.to_string())));
        let renderer = renderer(&gpu, format, state)?;
        Ok(Self { gpu, format, renderer, aside: None, lost, failed })
    }

    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// What the renderer draws differently from the CPU.
    pub(crate) fn notes(&self) -> &[String] {
        self.renderer.notes()
    }

    /// Why the device is lost, if it is.
    pub(crate) fn lost(&self) -> Option<String> {
        self.lost.get()
    }

    pub(crate) fn format(&self) -> wgpu::TextureFormat {
        self.format
    }

    /// Takes over what changed.
    pub(crate) fn update(&mut self, state: &State, change: Change) -> Result<(), GpuError> {
        let scene = state.scene();
        if change.scene || change.reliefs {
            self.renderer = renderer(&self.gpu, self.format, state)?;
            return Ok(());
        }
        if change.lights {
            self.renderer.set_lights(&scene.lights)?;
        }
        if change.camera {
            self.renderer.set_camera(&scene.camera)?;
        }
        Ok(())
    }

    /// Draws, waits until it is done, and gives the milliseconds it took.
    pub(crate) fn draw(&mut self, view: &wgpu::TextureView, size: [u32; 2]) -> Result<f64, GpuError> {
        let start = Instant::now();
        self.renderer.draw(&Target { color: view, depth: None, size })?;
        wait(&self.gpu.device)?;
        let wall = start.elapsed().as_secs_f64() * 1e3;
        match self.lost.get().or_else(|| self.failed.get()) {
            Some(text) => Err(GpuError::Device(text)),
            None => Ok(wall),
        }
    }

    /// [`Stage::draw`] where nobody sees it.
    pub(crate) fn draw_aside(&mut self, size: [u32; 2]) -> Result<f64, GpuError> {
        let picture = match self.aside.take() {
            Some(picture) if picture.size() == size => picture,
            _ => Picture::new(&self.gpu.device, size, self.format),
        };
        let drawn = self.draw(&picture.view, size);
        self.aside = Some(picture);
        drawn
    }

    /// The picture that the window shows.
    pub(crate) fn picture(&mut self, size: [u32; 2]) -> Result<Grid<[u8; 3]>, GpuError> {
        self.draw_aside(size)?;
        match &self.aside {
            Some(picture) => picture.read(&self.gpu.device, &self.gpu.queue),
            None => Err(GpuError::Device("there is no picture to read".to_owned())),
        }
    }

    /// Destroys the device, for tests of what happens then.
    pub(crate) fn lose(&self) {
        self.gpu.device.destroy();
    }
}

fn renderer(gpu: &Gpu, format: wgpu::TextureFormat, state: &State) -> Result<Renderer, GpuError> {
    Renderer::new(&gpu.device, &gpu.queue, state.scene(), format, &RendererOptions::default())
}
